//! `rdsolve init KIND`: a commented deck that runs, to begin with.

use super::console::print;
use super::exit::Exit;
use clap::{Args, ValueEnum};

#[derive(Debug, Args)]
pub struct InitArgs {
    /// The subject of the deck
    #[arg(value_enum, default_value_t = DeckKind::Frame)]
    kind: DeckKind,
}

/// A kind of deck.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum DeckKind {
    /// A portal frame of steel that may yield, pulled and let go
    Frame,
    /// A slider-crank with a motor and a flexible rod
    Mechanism,
    /// A steel panel under pressure
    #[value(name = "shell")]
    Panel,
    /// A ball that falls on a cantilever and bounces
    Impact,
}

impl DeckKind {
    /// The text of the deck.
    pub fn text(self) -> &'static str {
        match self {
            DeckKind::Frame => include_str!("init/frame.toml"),
            DeckKind::Mechanism => include_str!("init/mechanism.toml"),
            DeckKind::Panel => include_str!("init/shell.toml"),
            DeckKind::Impact => include_str!("init/impact.toml"),
        }
    }
}

/// Prints a deck on standard output: `rdsolve init frame > deck.toml`.
///
/// # Errors
/// [`Exit::InputOutput`] where standard output cannot be written.
pub fn init(args: &InitArgs) -> Result<(), Exit> {
    print(args.kind.text())
}
