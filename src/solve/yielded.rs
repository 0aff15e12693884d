//! The part that yields most, if a load step finds no equilibrium: without hardening it has no stiffness left.

use crate::context::Context;
use crate::failure::Failure;
use crate::system::Group;
use base::names::to_digits;
use mechanics::state::State;

/// Adds the part to the failure of a load step from this state, where a lost stiffness may be the cause.
pub fn explained(cx: &Context, state: &State, mut failure: Failure) -> Failure {
    if let Some(yielded) = failure.yielded_mut().filter(|_| !cx.is_dynamic()) {
        *yielded = most_yielded(cx, state);
    }
    failure
}

/// The part with the largest plastic strain, in words; `None` where nothing has yielded.
fn most_yielded(cx: &Context, state: &State) -> Option<String> {
    let now = state.configuration();
    let strain = |group: &Group| {
        let history = group.configuration(&now).history;
        (0..group.block.len()).map(|e| group.block.plastic_strain(e, history)).fold(0.0, f64::max)
    };
    let deformable = cx.system.shown_groups().filter(|group| group.kind.is_deformable());
    let all = deformable.map(|group| (strain(group), &cx.model.parts[group.part]));
    let (strain, part) = all.filter(|(strain, _)| *strain > 0.0).max_by(|a, b| a.0.total_cmp(&b.0))?;
    let (kind, name, strain) = (part.kind().word(), part.name(), to_digits(strain, 2));
    Some(format!("{kind} `{name}` yields most, to a plastic strain of {strain}"))
}
