//! The critical time step of central differences in `check`: the element that governs it, and what mass scaling would give.

use base::names::to_digits;
use mechanics::integrators::Stepping;
use model::Model;
use solve::system::{GoverningElement, System, added_at, governing};

/// The multiples of the critical time step whose mass is told.
const MULTIPLES: [f64; 3] = [2.0, 5.0, 10.0];

/// The critical time step of the elements, and the element that governs it.
pub fn limit_of_steps(model: &Model, system: &System) -> Option<(&'static str, String)> {
    let found = governor(model, system)?;
    let part = &model.parts[found.part];
    let x = |node: &usize| model.nodes[*node].x;
    let nodes = part.nodes(found.element);
    let center = nodes.iter().map(x).sum::<base::math::Vec3>() / nodes.len() as f64;
    let at: Vec<String> = center.iter().map(|value| to_digits(*value, 3)).collect();
    let what = format!(
        "{} is the critical time step of elements, that of element {} of {} `{}` at ({})",
        to_digits(found.step, 3),
        found.element + 1,
        part.kind().word(),
        part.name(),
        at.join(", ")
    );
    Some(("step", what))
}

/// The masses that `mass_scaling_step` would add for longer steps, a line for each. After one that more than doubles the mass there are no others.
pub fn offers(model: &Model, system: &System) -> Vec<(&'static str, String)> {
    let Some(found) = governor(model, system) else { return Vec::new() };
    let mass: f64 = system.inertias.iter().map(|inertia| inertia.weighing).sum();
    let offers = MULTIPLES.map(|multiple| (multiple, added_at(model, &system.groups, multiple * found.step)));
    let bearable = offers.iter().take_while(|(_, added)| *added < mass).count();
    let line = |(k, (multiple, added)): (usize, (f64, f64))| {
        let step = multiple * found.step;
        let what = format!(
            "`mass_scaling_step` = {}, {multiple} times the step, would add {}, {} % of the mass of the scene",
            to_digits(step, 3),
            to_digits(added, 3),
            to_digits(100.0 * added / mass, 3)
        );
        (if k == 0 { "longer" } else { "" }, what)
    };
    offers.into_iter().take(bearable + 1).enumerate().map(line).collect()
}

/// The element with the shortest critical time step, where central differences move the scene.
pub fn governor(model: &Model, system: &System) -> Option<GoverningElement> {
    let is_governed = model.analysis.is_dynamic() && matches!(model.solution.scheme.stepping(), Stepping::Verlet);
    is_governed.then(|| governing(model, &system.groups, system.mass_scaling().is_some())).flatten()
}
