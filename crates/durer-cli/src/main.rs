//! The `durer` command.
fn main() {}
