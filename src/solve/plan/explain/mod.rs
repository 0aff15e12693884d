//! The plan in words, for `rdsolve check`, the log and result.json: computed items, omissions and reasons.

mod analysis;
mod bars;
mod beams;
mod contacts;
mod damping;
mod explanation;
mod links;
mod mass_scaling;
mod omitted;
mod quantities;
mod redundant;
mod response;
mod scene;
mod shells;
mod solution;
mod spin;
mod threads;

pub use explanation::Explanation;
pub use mass_scaling::{mass_added, much_mass_added};
pub use redundant::redundant_constraints;

use super::Plan;
use crate::system::System;
use linear::Solver;
use model::Model;

/// The plan in words without the costs, which take a while to count.
pub fn explain(plan: &Plan, model: &Model, system: &System) -> Explanation {
    let mut text = Explanation::default();
    analysis::explain(&mut text, model);
    spin::explain(&mut text, model);
    scene::explain(&mut text, plan, model, system);
    quantities::explain(&mut text, model, system);
    damping::explain(&mut text, model);
    mass_scaling::explain(&mut text, model, system);
    solution::explain(&mut text, plan, model, system);
    threads::explain(&mut text, plan, system);
    text.omitted = omitted::list(plan, model, system);
    text.notes.extend(redundant_constraints(plan, model, system));
    text.notes.extend(scene::plane_modes(model, system));
    text
}

/// The plan in words, with the factorization and the operations that the omissions avoid.
pub fn explain_costs(plan: &Plan, model: &Model, system: &System, solver: &Solver) -> Explanation {
    let mut text = explain(plan, model, system);
    if !plan.explicit || plan.masses(system).is_none() {
        text.add("factor", solver.describe());
    }
    text.avoided = plan.savings(model, system);
    text
}
