//! `rdsolve completions SHELL` and `rdsolve man`: what shells and `man` read, made from the command line itself.

use super::console::{complain, print};
use super::exit::Exit;
use clap::Args;
use clap_complete::Shell;

#[derive(Debug, Args)]
pub struct CompletionsArgs {
    /// The shell that reads the output
    #[arg(value_enum)]
    shell: Shell,
}

/// Prints a completion script for this command line on standard output.
///
/// # Errors
/// [`Exit::InputOutput`] where standard output cannot be written.
pub fn completions(args: &CompletionsArgs, mut cli: clap::Command) -> Result<(), Exit> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut cli, "rdsolve", &mut script);
    print(&String::from_utf8_lossy(&script))
}

/// Prints the manual page of this command line on standard output.
///
/// # Errors
/// [`Exit::InputOutput`] where standard output cannot be written.
pub fn man(cli: clap::Command) -> Result<(), Exit> {
    let mut page = Vec::new();
    clap_mangen::Man::new(cli).render(&mut page).map_err(|error| {
        complain(&format!("cannot write the manual page: {error}"));
        Exit::InputOutput
    })?;
    print(&String::from_utf8_lossy(&page))
}
