//! `[[loads]]` with `centrifugal`: the force on masses in a frame that turns steadily.

use crate::data::{AnalysisKind, Centrifugal, Mass, MassKind, Part, RotationAxis, TurningMasses};
use crate::places::nodes::Topology;
use crate::places::place::Place;
use crate::procedure::response::{is_harmonic, is_synchronous};
use crate::report::{Owner, Report};
use crate::scene::Scene;
use crate::values::{keys, vec3_or_zero};
use base::diagnostic::At;
use deck::loads as words;
use deck::words::Table;
use mechanics::amplitude::Amplitude;

/// A centrifugal load, with the point masses of the scene; `None` after errors.
pub fn centrifugal_load<'d>(
    scene: &Scene<'d>,
    (load, rotation): (&'d At<Table<words::Load>>, &'d At<Table<words::SteadyRotation>>),
    (amplitude, amplitudes): (Option<usize>, &[Amplitude]),
    (masses, topology): (&[Mass], &Topology),
    report: &mut Report<'d>,
) -> Option<Centrifugal> {
    let owner = Owner::new("`centrifugal`", &rotation.span);
    let unused = keys!(load; at, force, total_force, moment, distance, force_per_length, local, projected, profile, force_per_area, pressure, follower);
    report.reject_unused("a centrifugal load", &unused);
    let speed = report.require(&owner, "speed", &rotation.speed);
    let axis = report.require(&owner, "axis", &rotation.axis).and_then(|axis| report.unit("axis", axis));
    check_analysis(scene, load, report);
    if is_harmonic(amplitudes, amplitude) {
        let hint = "give an amplitude whose value at t = 0 is the speed of the state, or none";
        report.error_with::<()>(&rotation.span, "a centrifugal load has no harmonic amplitude", hint);
    }
    let of = match &load.part {
        Some(names) => named(scene, &names.values, masses, report),
        None => all(scene, (rotation, masses), report),
    };
    if topology.is_complete() && !report.has_errors() && mass(scene, &of, masses, topology) == 0.0 {
        let hint = "give materials a `density`, or add `[[masses]]` or bodies; parts with `mass = \"none\"` have none";
        report.error_with::<()>(&rotation.span, "a centrifugal load acts on masses, and there are none", hint);
    }
    let through = vec3_or_zero(&rotation.about);
    Some(Centrifugal { of, axis: RotationAxis { direction: axis?, through }, speed: speed?.value, amplitude })
}

/// Refuses a load where inertia forces of the motion itself are computed, and beside speeds that it does not follow.
fn check_analysis(scene: &Scene, load: &At<Table<words::Load>>, report: &mut Report) {
    let scales = match &scene.analysis.kind {
        AnalysisKind::Response(_) if is_synchronous(scene.deck) => Some("unbalance"),
        _ => (!scene.analysis.speeds().is_empty()).then_some("speeds"),
    };
    if let Some(key) = scales {
        let hint = format!("leave out `{key}`, and run the deck at each `speed`: `rdsolve sweep` does");
        let message = format!("`{key}` scales the spin of bodies, not a centrifugal load");
        report.error_with::<()>(&load.span, message, hint);
    }
    if scene.analysis.kind != AnalysisKind::Dynamic {
        return;
    }
    let hint = match scene.stage {
        Some(_) => {
            "name the static stages in `stages` of the load; in dynamic ones, let a support with a `motion` turn the parts"
        }
        None => {
            "leave it out, and let a support with a `motion` turn the parts; or compute the state with `kind = \"static\"`"
        }
    };
    report.error_with::<()>(
        &load.span,
        "a centrifugal load in dynamics: it has no Coriolis forces, and motions have their inertia forces already",
        hint,
    );
}

/// All masses. The matrices of a superelement are not those of a rotating frame.
fn all<'d>(
    scene: &Scene<'d>,
    (rotation, masses): (&'d At<Table<words::SteadyRotation>>, &[Mass]),
    report: &mut Report<'d>,
) -> TurningMasses {
    if let Some(of) = scene.deck.superelements.first() {
        let name = of.name.as_ref().map_or("", |name| name.as_str());
        let hint = "name the other parts and bodies in `part` of the load, or let a support with a `motion` turn all in dynamics";
        report.error_with::<()>(
            &rotation.span,
            format!("a centrifugal load does not act on superelement `{name}`"),
            hint,
        );
    }
    TurningMasses {
        parts: (0..scene.parts.list.len()).collect(),
        bodies: (0..scene.bodies.len()).collect(),
        masses: (0..masses.len()).collect(),
    }
}

/// The masses of the named parts, bodies and points.
fn named<'d>(scene: &Scene<'d>, names: &[At<String>], masses: &[Mass], report: &mut Report<'d>) -> TurningMasses {
    let mut of = TurningMasses::default();
    for name in names {
        let Some(place) = scene.names.find(name, report) else { continue };
        for leaf in scene.names.leaves(place) {
            let part = scene.names.surface_of(leaf).or_else(|| scene.names.line_of(leaf));
            match (leaf, part.and_then(|part| scene.parts.entry(part))) {
                (Place::Body(body), _) => of.bodies.push(body),
                (Place::Point(node), _) => {
                    of.masses.extend((0..masses.len()).filter(|&mass| masses[mass].node == node))
                }
                (_, Some(entry)) => of.parts.extend(entry.range.clone()),
                _ => {
                    let message = format!("a centrifugal load acts on masses, and `{}` is {}", name.value, leaf.kind());
                    report.error_with::<()>(
                        &name.span,
                        message,
                        "name parts, bodies, or points that have `[[masses]]`",
                    );
                }
            }
        }
    }
    for list in [&mut of.parts, &mut of.bodies, &mut of.masses] {
        list.sort_unstable();
        list.dedup();
    }
    of
}

/// The sum of the masses.
fn mass(scene: &Scene, of: &TurningMasses, masses: &[Mass], topology: &Topology) -> f64 {
    let stiffnesses = &scene.parts.stiffnesses;
    let of_part = |part: &Part| {
        let has_mass = part.mass_kind().is_some_and(|kind| kind != MassKind::None);
        let elements = 0..if has_mass { part.elements() } else { 0 };
        elements.map(|element| part.element_mass(element, &topology.list, stiffnesses)).sum::<f64>()
    };
    of.parts.iter().map(|&part| of_part(&scene.parts.list[part])).sum::<f64>()
        + of.bodies.iter().map(|&body| scene.bodies[body].mass).sum::<f64>()
        + of.masses.iter().map(|&mass| masses[mass].mass).sum::<f64>()
}
