//! Checks whether a step is short enough for the contacts that it meets.

use crate::context::Context;
use crate::failure::Failure;
use crate::guards::guard::{Guard, Taken};
use crate::step::trial::Step;
use crate::tolerances::contacts::{BEGINS_CLOSED, MEANT, SEEN, STEPS_OF_IMPACT, SUNK, TO_THE_MIDDLE};
use crate::warning::{Warning, Warnings};
use crate::workspace::Workspace;
use mechanics::elements::contact::ContactLaw;
use mechanics::materials::Dissipation;
use mechanics::state::{Configuration, Node, State};
use model::{Contact, Model, PartType, StepLength};
use std::ops::Range;

/// Refuses steps too long for their contacts, and records penetrations.
pub struct ContactGuard;

impl Guard for ContactGuard {
    fn before_step(&mut self, cx: &Context, step: &Step) -> Result<(), Failure> {
        check_length(cx, step.state, step.ahead())
    }

    fn at_equilibrium(&mut self, cx: &Context, ws: &Workspace, step: &Step) -> Result<(), Failure> {
        check_passage(cx, &ws.trial.nodes, step.state, step.ahead())
    }

    fn at_end(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        step: &Step,
        _dissipated: &Dissipation,
    ) -> Result<(), Failure> {
        // Elsewhere the end is the instant of equilibrium.
        if step.stage.scheme.instant == 1.0 {
            return Ok(());
        }
        check_passage(cx, &ws.end.nodes, step.state, step.dt())
    }

    fn after_step(&mut self, cx: &Context, ws: &mut Workspace, taken: &Taken) {
        note_depth(cx, &mut ws.warnings, taken.state);
    }
}

/// Checks a step that reaches `ahead` before it is computed: steps during an impact must resolve it.
///
/// # Errors
/// [`Failure::ContactNotResolved`] where the step is too long for a contact.
pub fn check_length(cx: &Context, state: &State, ahead: f64) -> Result<(), Failure> {
    if !cx.system.has_contacts() {
        return Ok(());
    }
    cx.system.unresolved_impact(state, ahead).map_or(Ok(()), |contact| Err(too_long(cx, contact)))
}

/// Checks the motion found at `ahead` of the state: no point may have passed through a surface.
///
/// # Errors
/// [`Failure::ContactNotResolved`] where something has.
pub fn check_passage(cx: &Context, nodes: &[Node], state: &State, ahead: f64) -> Result<(), Failure> {
    if !cx.system.has_contacts() {
        return Ok(());
    }
    let now = Configuration { nodes, history: &state.history, dt: ahead, previous: None };
    cx.system.missed_contact(&state.nodes, &now).map_or(Ok(()), |contact| Err(too_long(cx, contact)))
}

/// Records the penetration of contacts at the end of a step, and warns if it is visible.
fn note_depth(cx: &Context, warnings: &mut Warnings, state: &State) {
    let name = |part: usize| cx.model.parts[part].name().to_owned();
    if !warnings.knows(|known| matches!(known, Warning::SideBySide { .. }))
        && let Some(part) = cx.system.side_by_side(state)
    {
        warnings.add(Warning::SideBySide { name: name(part) });
    }
    if !warnings.knows(|known| matches!(known, Warning::Crowded { .. }))
        && let Some(part) = cx.system.crowded(state)
    {
        warnings.add(Warning::Crowded { name: name(part) });
    }
    cx.system.note_touched(state, &mut warnings.touched);
    for (group, gap) in cx.system.last_gaps(state) {
        let Some(contact) = Contact::of(&cx.model.parts[group.part]).filter(|contact| gap < -SEEN * contact.size)
        else {
            continue;
        };
        let limit = match contact.chosen {
            _ if contact.has_facets() => TO_THE_MIDDLE,
            Some(_) => SEEN,
            None => MEANT,
        };
        if -gap > limit * contact.size {
            let now = contact.law.as_ref().map_or(0.0, |law| law.stiffness);
            // The penetration of an impact falls with the root of the stiffness.
            let enough = now * (2.0 * gap / (limit * contact.size)).powi(2);
            let step = contact.law.as_ref().map_or(0.0, |law| step_for(law, enough, cx.model));
            warnings.deepen(&contact.name, (-gap, contact.size), [now, enough, step]);
        }
    }
}

/// The fixed step that resolves an impact with another stiffness; 0 where steps are cut, are automatic, or are short enough.
fn step_for(law: &ContactLaw, stiffness: f64, model: &Model) -> f64 {
    let StepLength::Fixed { step } = model.analysis.step_length else { return 0.0 };
    let steps = STEPS_OF_IMPACT[usize::from(model.solution.scheme.is_explicit())];
    // Half of the longest duration, which goes with the root of the stiffness.
    let needed = 0.5 * law.duration * (law.stiffness / stiffness).sqrt() / steps;
    if law.resolution.is_infinite() && needed < step { needed } else { 0.0 }
}

/// Warns if a new contact of a dynamic stage begins with a penetration, which throws the body out with unphysical energy. `fresh` are the
/// ranges of the history that earlier stages did not have.
pub fn warn_of_closed(cx: &Context, ws: &mut Workspace, state: &State, fresh: &[Range<usize>]) {
    if !cx.is_dynamic() || !cx.system.has_contacts() {
        return;
    }
    for (group, gap) in cx.system.last_gaps(state) {
        let is_fresh = fresh.iter().any(|range| range.contains(&group.history.start));
        let contact = Contact::of(&cx.model.parts[group.part]).filter(|contact| gap < -BEGINS_CLOSED * contact.size);
        if let Some(contact) = contact.filter(|contact| is_fresh && contact.law.is_some()) {
            ws.warnings.add(Warning::BeginsClosed { name: contact.name.clone(), depth: -gap });
        }
    }
}

/// A negligible energy for bodies at rest on each other: their weight times a thousandth of their size, the penetration used to choose
/// stiffnesses. Zero without contacts or weight.
pub fn settling_energy(model: &Model) -> f64 {
    let acting = model.each::<Contact>().filter(|contact| contact.law.is_some());
    let size = acting.map(|contact| contact.size).fold(f64::INFINITY, f64::min);
    let mass: f64 = model.bodies.iter().map(|body| body.mass).sum();
    if size.is_finite() { SUNK * size * mass * model.loading.gravity.norm() } else { 0.0 }
}

fn too_long(cx: &Context, contact: usize) -> Failure {
    Failure::ContactNotResolved { name: cx.model.parts[contact].name().to_owned() }
}
