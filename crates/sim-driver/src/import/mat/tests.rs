//! MAT files: see below.
