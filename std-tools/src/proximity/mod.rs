//! Which points are near each other.

pub(crate) mod lanes;
