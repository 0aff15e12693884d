//! `stop` of `[[stages]]`: what ends a stage before its time.

use crate::data::{Actors, DIRECTIONS, RunStage, Stop, StopQuantity};
use crate::places::place::Place;
use crate::report::{Owner, Report};
use crate::scene::Scene;
use crate::stages::CurrentStage;
use crate::values::{flag, keys};
use base::diagnostic::At;
use base::names::short;
use deck::stages as words;
use deck::words::Table;
use std::f64::consts::PI;

/// The loads and motions that a deck names.
pub type NamedActors<'d> = Vec<(&'d At<String>, Actors)>;

/// The stage of the model with its stop condition; `None` for a deck without stages.
pub fn stage<'d>(scene: &Scene<'d>, actors: NamedActors<'d>, report: &mut Report<'d>) -> Option<RunStage> {
    let current = scene.stage?;
    let actors = joined(actors, report);
    let stop = current.table().stop.as_ref().and_then(|table| stop(&current, table, scene, &actors, report));
    let (name, count) = (current.name().to_owned(), current.count());
    Some(RunStage {
        name,
        index: current.index,
        count,
        goes_on: current.goes_on(),
        loads_alone_change: current.loads_alone_change(),
        follows_motion: current.follows_motion(),
        holds_back: false,
        own_amplitude: current.amplitude_of_stage(),
        loads_grow: scene.deck.loads.iter().any(|load| load.amplitude.is_none() && current.is_pulled(&load.stages)),
        stop,
    })
}

/// One entry for each name; a load and a support must not share one.
fn joined<'d>(actors: NamedActors<'d>, report: &mut Report<'d>) -> NamedActors<'d> {
    let mut names: NamedActors = Vec::new();
    for (name, of) in actors {
        if names.iter().any(|(other, _)| other.value == name.value) {
            report.error_with::<()>(
                &name.span,
                format!("two loads or supports have the name `{}`", name.value),
                "rename one of them",
            );
        } else {
            names.push((name, of));
        }
    }
    names
}

fn stop<'d>(
    current: &CurrentStage<'d>,
    at: &'d At<Table<words::Stop>>,
    scene: &Scene<'d>,
    actors: &NamedActors<'d>,
    report: &mut Report<'d>,
) -> Option<Stop> {
    let owner = Owner::new(format!("`stop` of stage `{}`", current.name()), &at.span);
    let table: &'d words::Stop = &at.value;
    let [of_node, of_load] = [keys!(table; at, quantity, value), keys!(table; load, work, force)];
    if table.time.is_some() {
        report.reject_unused("a stop at a time", &[&of_node[..], &of_load, &keys!(table; required)].concat());
        return None;
    }
    if table.load.is_some() {
        report.reject_unused("a stop by a load", &of_node);
        return by_load(&owner, table, actors, report);
    }
    if table.at.is_none() && !report.is_any_spoiled(&at.span) {
        let hint = "such as { at = \"crown\", quantity = \"uz\", value = -0.1 } or { load = \"ram\", work = 4375.0 }";
        return report.error_with(owner.span, format!("{} says nothing", owner.what), hint);
    }
    report.reject_unused("a stop by a displacement", &of_load);
    let name = report.require(&owner, "at", &table.at);
    let quantity = report.require(&owner, "quantity", &table.quantity);
    let value = report.require(&owner, "value", &table.value);
    let name = name?;
    let node = match scene.place_or_node(name) {
        Some(Place::Point(node)) => node,
        Some(Place::Body(body)) => scene.names.body_node(body),
        Some(place) => {
            let message = format!("{} takes a point or body, and `{}` is {}", owner.what, name.value, place.kind());
            return report.error(&name.span, message);
        }
        None => return scene.names.unknown("point or body", name, || scene.names.known(|_| true), report),
    };
    let (dof, at, value) = (quantity?.value as usize, &value?.span, value?.value);
    if dof >= 3 && value.abs() >= PI {
        let message = format!("{} of {} does not come to {}", DIRECTIONS[dof], name.value, short(value));
        return report.error_with(at, message, "it is a component of the rotation vector, which is shorter than π");
    }
    let label = format!("{} of {}", DIRECTIONS[dof], name.value);
    let required = flag(&table.required, true);
    Some(Stop { quantity: StopQuantity::Displacement([node, dof]), value, label, required })
}

fn by_load<'d>(
    owner: &Owner<'d>,
    table: &'d words::Stop,
    actors: &NamedActors<'d>,
    report: &mut Report<'d>,
) -> Option<Stop> {
    let name = table.load.as_ref()?;
    let known = actors.iter().map(|(name, _)| name.as_str());
    let Some((_, found)) = actors.iter().find(|(other, _)| other.value == name.value) else {
        return report.unknown("load of this stage, or support with a motion,", name, known);
    };
    let required = flag(&table.required, true);
    match (&table.work, &table.force) {
        (Some(_), Some(force)) => report.error(&force.span, format!("{} has `work` or `force`, not both", owner.what)),
        (Some(work), None) if work.value == 0.0 => report.error(&work.span, "`work` must not be 0"),
        (Some(work), None) => {
            let label = format!("the work of {}", name.value);
            Some(Stop { quantity: StopQuantity::Work(found.clone()), value: work.value, label, required })
        }
        (None, Some(_)) => {
            let value = report.positive("force", &table.force)?;
            let label = format!("the force of {}", name.value);
            Some(Stop { quantity: StopQuantity::Force(found.clone()), value, label, required })
        }
        (None, None) => report.error(owner.span, format!("{} needs `work` or `force`", owner.what)),
    }
}
