//! `rdsolve check deck.toml`: read, validate, print the plan; run nothing.

use super::arguments::DeckArgs;
use super::console::{print, show};
use super::exit::Exit;
use super::load::{load, plan, too_large};
use super::signals::EndAtOnce;
use crate::output::listed;
use crate::plan::explain::explain_costs;

/// Prints the plan of a deck, with what it costs, on standard output; diagnostics go to standard error.
///
/// # Errors
/// The deck is invalid or cannot be read, or its matrix does not fit into memory; the reason has been shown.
pub fn check(args: &DeckArgs) -> Result<(), Exit> {
    let _checking = EndAtOnce::on_signals();
    let mut loaded = load(&args.deck, &args.sets, Vec::new())?;
    show(&loaded.warnings, &loaded.source);
    let (system, plan, warnings) = plan(&mut loaded, 1)?;
    show(&warnings, &loaded.source);
    let (solver, _) = plan.build(&system).map_err(too_large)?;
    let mut text = explain_costs(&plan, &loaded.model, &system, &solver);
    text.computed.push(("output", listed(&loaded.model, &plan)));
    print(&format!("{}: no errors\n{text}", loaded.source.path))
}
