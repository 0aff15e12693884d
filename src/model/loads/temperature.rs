//! `[[loads]]` that heat parts: the strain that causes no stress, as the displacement of nodes whose motion is given.

use crate::data::{Actors, AnalysisKind, History, PrescribedMotion};
use crate::loads::is_temperature;
use crate::loads::nodal_temperature::{NodalTemperatures, check_nodes, nodal_temperatures};
use crate::places::nodes::Topology;
use crate::places::place::Place;
use crate::report::{Owner, Report};
use crate::scene::Scene;
use crate::values::keys;
use base::diagnostic::At;
use base::math::Vec3;
use deck::Deck;
use deck::loads as words;
use deck::parts::PartIndex;
use deck::words::Table;
use mechanics::amplitude::Amplitude;

/// The names of the three strains, by their places in [`mechanics::elements::heat::Heat::numbers`].
const NAMES: [&str; 3] = ["temperature", "temperature_gradient", "temperature_gradient along z"];

/// Reads the loads that heat parts. They act as given motions, which the loads with names are added to `actors` by.
pub fn temperatures<'d>(
    scene: &mut Scene<'d>,
    amplitudes: &mut Vec<Amplitude>,
    topology: &mut Topology,
    actors: &mut Vec<(&'d At<String>, Actors)>,
    report: &mut Report<'d>,
) {
    for load in scene.deck.loads.iter().filter(|load| is_temperature(load)) {
        let owner = Owner::new("`[[loads]]`", &load.span);
        let unused = keys!(load; at, force, total_force, moment, distance, force_per_length, local, projected, profile, force_per_area, pressure, centrifugal, follower);
        report.reject_unused("a load that heats parts", &unused);
        if scene.stage.is_some_and(|stage| !stage.stays(&load.stages)) {
            let hint = "name all later stages too, and let the `amplitude` go back to zero";
            report.error_with::<()>(&load.span, "a temperature does not end with a stage", hint);
        }
        if let Some(at) = load.amplitude.as_ref().filter(|_| is_factored(scene, load)) {
            let message = "a temperature whose factor a buckling analysis finds takes no `amplitude`";
            report.error_with::<()>(&at.span, message, "remove it: factors are multiples of `temperature`");
        }
        // A gradient may bend a beam in any direction.
        scene.analysis.plane &= load.temperature_gradient.is_none();
        let amplitude = amplitude(scene, load, amplitudes, report);
        let Some(names) = report.require(&owner, "part", &load.part) else { continue };
        let (mut motions, mut heated) = (Vec::new(), Vec::new());
        for name in &names.values {
            let Some(place) = scene.names.find(name, report) else { continue };
            for part in parts(scene, place, name, report) {
                heated.push(part);
                let field = nodal_temperatures(scene, load, part, topology, report);
                let numbers = heat(scene, (load, name), (part, field.as_ref()), topology, report);
                if let (Some(numbers), Some(amplitude)) = (numbers, amplitude) {
                    motions.extend(add(scene, (part, name), (amplitude, &numbers), topology, report));
                    if let Some(field) = field {
                        field.give(&mut scene.parts, part);
                    }
                }
            }
        }
        check_nodes(scene, load, &heated, topology, report);
        if let Some(name) = &load.name {
            let are_new = scene.stage.is_some_and(|stage| stage.is_new(&load.stages));
            actors.push((name, Actors { motions, are_new, ..Actors::default() }));
        }
    }
}

/// True where a buckling analysis finds its factor.
fn is_factored(scene: &Scene, load: &words::Load) -> bool {
    match scene.stage {
        Some(stage) => stage.buckles() && stage.is_new(&load.stages),
        None => matches!(scene.analysis.kind, AnalysisKind::Buckling(_)),
    }
}

/// The index of the amplitude of a load; one without a name in a deck without stages is added.
fn amplitude<'d>(
    scene: &Scene<'d>,
    load: &'d words::Load,
    amplitudes: &mut Vec<Amplitude>,
    report: &mut Report<'d>,
) -> Option<usize> {
    if load.amplitude.is_some() || scene.stage.is_some() {
        return super::amplitude(scene, load, report);
    }
    // Modes are those of the state with the whole load, and buckling factors are multiples of it.
    amplitudes.push(match scene.analysis.is_dynamic() || scene.analysis.has_modes() {
        true => Amplitude::Constant,
        false => Amplitude::Ramp { start: 0.0, end: scene.analysis.end_time },
    });
    Some(amplitudes.len() - 1)
}

/// The deformable parts that a name means.
fn parts<'d>(scene: &Scene<'d>, place: Place, name: &At<String>, report: &mut Report<'d>) -> Vec<PartIndex> {
    let leaves = if let Place::Set(_) = place { scene.names.leaves(place) } else { vec![place] };
    let part = |leaf: &Place| match leaf {
        Place::Part(part) if part.kind.is_line() || part.kind.is_surface() => Some(*part),
        leaf => scene.names.surface_of(*leaf),
    };
    let is_rigid = |part: PartIndex| scene.deck.part(part).is_some_and(|part| part.is_rigid());
    let found: Vec<PartIndex> = leaves.iter().filter_map(part).filter(|part| !is_rigid(*part)).collect();
    if found.len() < leaves.len() || leaves.is_empty() {
        let message =
            format!("a temperature acts on whole beams, bars and shells, and `{}` is {}", name.value, place.kind());
        let hint = "name parts that deform; a part may be made of each group of the mesh";
        report.error_with::<()>(&name.span, message, hint);
    }
    found
}

/// True where a polygon of a section of a beam has a material of its own: its strain in heat may differ from that beside it.
fn has_polygons_of_materials(deck: &Deck, beam: usize) -> bool {
    let beam = &deck.beams[beam];
    let stations = beam.stations.iter().flat_map(|stations| &stations.value);
    let sections = stations.filter_map(|station| station.section.as_ref()).chain(beam.section.as_ref());
    let polygons = sections
        .filter_map(|name| deck.sections.position(name.as_str()))
        .filter_map(|index| deck.sections.0[index].1.polygons.as_ref());
    polygons.flat_map(|polygons| &polygons.value).any(|polygon| polygon.material.is_some() || polygon.lamina.is_some())
}

/// The displacements of the numbers of a part, and its length last.
fn heat<'d>(
    scene: &Scene<'d>,
    (load, name): (&'d Table<words::Load>, &At<String>),
    (part, field): (PartIndex, Option<&NodalTemperatures>),
    topology: &Topology,
    report: &mut Report<'d>,
) -> Option<[f64; 4]> {
    let table = scene.deck.part(part)?;
    if part.kind.has_sections() && has_polygons_of_materials(scene.deck, part.index) {
        let message =
            format!("a temperature acts on `{}`, whose section has polygons with materials of their own", name.value);
        return report.error_with(&name.span, message, "give the beam the one `material` of all polygons");
    }
    let material = table.table.material().and_then(|name| scene.deck.materials.position(name.as_str()));
    let expansion = material.and_then(|index| scene.deck.materials.0[index].1.expansion.as_ref());
    let Some(expansion) = expansion else {
        let message = format!("a temperature acts on `{}`, whose material has no `expansion`", name.value);
        let hint = "give the material one, such as 1.2e-5 for steel, per unit of temperature";
        return report.error_with(&name.span, message, hint);
    };
    let wanted = part.kind.gradients();
    let gradient = load.temperature_gradient.as_ref();
    if let Some(at) = gradient.filter(|at| at.values.len() != wanted) {
        let message = format!("`temperature_gradient` of {} has {} values", table.title(), at.values.len());
        let hint = match wanted {
            2 => "give [along y, along z] of the section, temperature per length",
            1 => "give one number, temperature per length along the normal",
            _ => "leave it out: a bar does not bend",
        };
        return report.error_with(&at.span, message, hint);
    }
    let length = length(scene, part, topology);
    let along = |k: usize| gradient.and_then(|at| at.values.get(k)).map_or(0.0, |value| value.value);
    let uniform = load.temperature.as_ref().map_or(0.0, |at| at.value);
    let temperature = field.map_or(uniform, |field| field.largest);
    let [a, b, c] = [temperature, along(0), along(1)].map(|value| expansion.value * value * length);
    Some([a, b, c, length])
}

/// Adds the nodes of the numbers of a part, with their motion by this amplitude. Returns those that move.
fn add<'d>(
    scene: &mut Scene<'d>,
    (part, name): (PartIndex, &At<String>),
    (amplitude, [numbers @ .., length]): (usize, &[f64; 4]),
    topology: &mut Topology,
    report: &mut Report<'d>,
) -> Vec<[usize; 2]> {
    let mut motions = Vec::new();
    let range = scene.parts.entry(part).map_or(0..0, |entry| entry.range.clone());
    for (of, &scale) in numbers.iter().enumerate().filter(|(_, scale)| **scale != 0.0) {
        let Some(first) = scene.parts.list[range.clone()].iter().find(|part| part.elements() > 0) else { continue };
        let label = format!("{}.{}", first.name(), NAMES[of]);
        let node = topology.add_number(label, first.nodes(0)[0]);
        topology.connect(node, false);
        topology.restrain(node, 0, Some(PrescribedMotion { amplitude, scale, history: History::Displacement }));
        motions.push([node, 0]);
        for heat in scene.parts.list[range.clone()].iter_mut().filter_map(|part| part.heat_mut()) {
            heat.length = *length;
            if heat.numbers[of].replace(node).is_some() {
                let message =
                    format!("two loads give `{}` a `{}`", name.value, NAMES[of].split(' ').next().unwrap_or(""));
                let hint = "give one load, whose amplitude is the sum of both";
                report.error_with::<()>(&name.span, message, hint);
                return motions;
            }
        }
    }
    motions
}

/// A length of a part: that of the box around its nodes.
fn length(scene: &Scene, part: PartIndex, topology: &Topology) -> f64 {
    let parts = scene.parts.of(part).iter();
    let nodes = parts.flat_map(|part| (0..part.elements()).flat_map(|element| part.nodes(element).to_vec()));
    let mut corners = [Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY)];
    for node in nodes {
        let x = topology.x(node);
        corners = [corners[0].inf(&x), corners[1].sup(&x)];
    }
    (corners[1] - corners[0]).norm()
}
