//! `rdsolve check deck.toml`: read, validate, print the plan; run nothing.

use super::{DeckArgs, Exit, complain, load, show};
use crate::plan::Plan;
use crate::system::System;

pub(super) fn check(args: &DeckArgs) -> Result<(), Exit> {
    let loaded = load(&args.deck, &args.sets)?;
    show(&loaded.warnings, &loaded.source);
    let system = System::new(&loaded.model).map_err(|error| {
        complain(&error);
        Exit::Internal
    })?;
    let plan = Plan::new(&loaded.model, &system, 1);
    let (solver, _) = plan.build(&system);
    let text = plan.explain(&loaded.model, &system);
    super::print(&format!("{}: no errors\n{text}{:<12}{}\n", loaded.source.path, "  factor", solver.describe()))
}
