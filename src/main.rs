use std::process::ExitCode;

use rdsolve::command::{Exit, execute, parse};

fn main() -> ExitCode {
    // The panic itself has been shown.
    let done = std::panic::catch_unwind(|| parse().map_or_else(|exit| exit, execute));
    done.unwrap_or(Exit::Internal).into()
}
