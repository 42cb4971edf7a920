//! The `durer` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    durer_cli::main()
}
