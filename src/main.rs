use std::process::ExitCode;

use rdsolve::command::{execute, parse};

fn main() -> ExitCode {
    parse().map_or_else(|exit| exit, execute).into()
}
