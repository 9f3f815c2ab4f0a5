//! Oracles: slow, obvious implementations of the definitions.
