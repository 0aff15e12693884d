use std::process::ExitCode;

use clap::Parser;
use rdsolve::command::{Cli, execute};

fn main() -> ExitCode {
    execute(Cli::parse()).into()
}
