//! The `rubscope` program: parse, dispatch, exit status.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(rubscope::cli::main(std::env::args_os()))
}
