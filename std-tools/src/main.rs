//! The command `sig`.

fn main() {}
