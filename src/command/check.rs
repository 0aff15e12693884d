//! `rdsolve check deck.toml`: read, validate, print the plan; run nothing.

use super::{DeckArgs, Exit, doubts, load, no_room, planned, show};

pub(super) fn check(args: &DeckArgs) -> Result<(), Exit> {
    let loaded = load(&args.deck, &args.sets)?;
    show(&loaded.warnings, &loaded.source);
    let (system, plan) = planned(&loaded, 1)?;
    show(&doubts(&plan, &loaded.model, &system), &loaded.source);
    let (solver, _) = plan.build(&system).map_err(no_room)?;
    let mut text = plan.explain(&loaded.model, &system);
    if !plan.explicit || plan.masses(&system).is_none() {
        text += &format!("{:<12}{}\n", "  factor", solver.describe());
    }
    for saving in plan.savings(&loaded.model, &system) {
        text += &format!("{:<12}{saving}\n", "saved");
    }
    super::print(&format!("{}: no errors\n{text}", loaded.source.path))
}
