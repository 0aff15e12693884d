//! Loads that steps along a path scale. Gravity beside other loads looks permanent, and so do loads across the controlled displacement.

use crate::data::{ArcLength, DIRECTIONS, Load};
use crate::environment::gravity;
use crate::places::nodes::Topology;
use crate::report::Report;
use crate::scene::Scene;
use crate::stages::CurrentStage;
use crate::values::vec3_or_zero;
use base::diagnostic::At;
use base::math::Vec3;
use base::names::quoted;
use deck::analysis::Control;
use deck::environment::Environment;
use deck::loads::Load as LoadWords;
use deck::words::{Maybe, Names, Table};

/// Part of the loads across the path below which the loads along it are an imperfection, which starts the buckling of a column.
const IMPERFECTION: f64 = 0.01;

/// The remedy, after the key of the amplitude.
const REMEDY: &str =
    "an amplitude of `kind = \"constant\"` if it is permanent, of `kind = \"ramp\"` if it is meant to grow";

/// Warns of gravity that grows with other loads along a path, and of loads across the displacement of displacement control that grow with
/// those along it. An amplitude says that it is meant.
pub fn check_scaled_loads(
    scene: &Scene,
    path: Option<&ArcLength>,
    (nodal, topology): (&[Load], &Topology),
    report: &mut Report,
) {
    let control = scene.deck.analysis.as_ref().and_then(|analysis| analysis.control.as_ref());
    let (Some(path), Some(control)) = (path, control) else { return };
    if control.value == Control::Displacement && !may_grow(scene) {
        let message =
            "nothing grows here: displacement control scales the loads that begin with it, and there are none";
        let hint = match scene.stage {
            Some(stage) => {
                format!("add a load with `stages = [\"{}\"]`: loads of earlier stages keep their values", stage.name())
            }
            None => "add `[[loads]]`".to_owned(),
        };
        report.error_with::<()>(&control.span, message, hint);
        return;
    }
    let own = scene.stage.map(|stage| stage.amplitude_of_loads());
    let acts = |load: &Load| load.coordinate().is_none() && !topology.list[load.node].is_number;
    let is_scaled = |load: &&Load| load.amplitude == own && acts(load) && load.force != Vec3::zeros();
    let scaled: Vec<&Load> = nodal.iter().filter(is_scaled).collect();
    if scaled.is_empty() {
        return;
    }
    let environment = scene.deck.environment.as_ref();
    let grows =
        |at: &&At<Table<Environment>>| at.gravity_amplitude.is_none() && is_new(scene.stage, &at.gravity_stages);
    let given = environment.filter(grows).and_then(|environment| environment.gravity.as_ref());
    if let Some(at) = given.filter(|_| gravity(scene.deck) != Vec3::zeros()) {
        let message = "gravity grows in proportion to the loads: at half of the loads only half of the weight acts";
        report.warn(&at.span, message, format!("give `gravity_amplitude`, {REMEDY}"));
    }
    if let (Control::Displacement, Some(stop)) = (control.value, path.stop) {
        check_across(scene, stop.dof, &scaled, report);
    }
}

/// True if a load or a motion first acts here, or has an amplitude.
fn may_grow(scene: &Scene) -> bool {
    let deck = scene.deck;
    let environment = deck.environment.as_ref().is_some_and(|at| {
        !at.base_acceleration.is_empty() || at.gravity_amplitude.is_some() || is_new(scene.stage, &at.gravity_stages)
    });
    deck.loads.iter().any(|load| load.amplitude.is_some() || is_new(scene.stage, &load.stages))
        || environment
        || deck.supports.iter().any(|support| support.motion.is_some())
        || deck.joints.iter().any(|joint| joint.motion.is_some() || joint.effort.is_some())
        || deck.links.iter().any(|link| link.pretension.is_some())
        || !deck.actuators.is_empty()
}

/// True of loads with these `stages` that first act in this stage.
fn is_new(stage: Option<CurrentStage>, stages: &Maybe<Names>) -> bool {
    stage.is_none_or(|stage| stage.is_pulled(stages))
}

/// Warns of loads across the direction that is moved, if there are more than an imperfection along it.
fn check_across(scene: &Scene, dof: usize, scaled: &[&Load], report: &mut Report) {
    let along: f64 = scaled.iter().map(|load| load.force[dof].abs()).sum();
    let across: f64 = scaled.iter().filter(|load| load.force[dof] == 0.0).map(|load| load.force.norm()).sum();
    if along <= IMPERFECTION * across {
        return;
    }
    let is_across = |load: &&At<Table<LoadWords>>| {
        let forces = [&load.force, &load.total_force, &load.force_per_length, &load.force_per_area].map(vec3_or_zero);
        let sum = forces.iter().sum::<Vec3>();
        load.amplitude.is_none() && is_new(scene.stage, &load.stages) && sum != Vec3::zeros() && sum[dof] == 0.0
    };
    let permanent: Vec<&At<Table<LoadWords>>> = scene.deck.loads.iter().filter(is_across).collect();
    let Some(first) = permanent.first() else { return };
    let names = permanent.iter().flat_map(|load| load.at.iter().chain(&load.part)).flat_map(|names| &names.values);
    let mut names: Vec<&str> = names.map(|name| name.value.as_str()).collect();
    names.dedup();
    let message = format!(
        "the steps move {}, and loads across it, on {}, grow in proportion to those along it",
        DIRECTIONS[dof],
        quoted(names)
    );
    report.warn(&first.span, message, format!("give `amplitude`, {REMEDY}"));
}
