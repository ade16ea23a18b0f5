//! Rotating blade finite elements: the 15-dof beam element, rotating modes, finite elements in time.
