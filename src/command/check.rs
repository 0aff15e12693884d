//! `rdsolve check deck.toml`.

use super::{DeckArgs, Exit, load, show};

pub(super) fn check(args: &DeckArgs) -> Result<(), Exit> {
    let loaded = load(&args.deck, &args.sets)?;
    show(&loaded.warnings, &loaded.source);
    super::print(&format!("{}: no errors\n", loaded.source.path))
}
