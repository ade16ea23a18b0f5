//! Generators of synthetic measurements with a known, independent physics; depends on no crate of the product.
