//! Loads beside the weight of the scene and the strength of the beams under them: forces of kN given in N, and the other way round.

use super::quantities::{acting_force, acts, symbol, times};
use crate::system::energy::mass_and_center;
use crate::system::{Excitation, Side, System};
use crate::tolerances::explained_quantities::{BEYOND_YIELD, NO_LOAD};
use crate::tolerances::strain::{BEYOND_ELASTIC, SOFT};
use base::diagnostic::Diagnostic;
use base::names::{short, to_digits};
use base::quantities::{Unit, UnitSystem};
use model::{Beam, Model, PartType};
use std::collections::BTreeMap;

/// Warns, in decks with units, of loads that vanish beside the weight, and of a force that no beam at its node carries.
pub fn implausible_loads(model: &Model, system: &System) -> Vec<Diagnostic> {
    let Some(units) = model.output.units.as_deref().and_then(UnitSystem::find) else { return Vec::new() };
    // Loads of modes and responses have any size, as have those that arc-length steps scale.
    if model.analysis.has_modes() || model.analysis.step_length.is_arc_length() {
        return Vec::new();
    }
    let (excitation, times) = (Excitation::new(model), times(model));
    let peak = |amplitude: Option<usize>| {
        times.iter().map(|&time| excitation.factor_of(amplitude, time, Side::After).abs()).fold(0.0, f64::max)
    };
    let peaks: Vec<f64> = (0..model.loading.amplitudes.len()).map(|amplitude| peak(Some(amplitude))).collect();
    let plain = peak(None);
    let largest = |amplitude: Option<usize>| amplitude.map_or(plain, |amplitude| peaks[amplitude]);
    too_small(model, system, acting_force(model, &largest), units)
        .into_iter()
        .chain(too_large(model, &largest, units))
        .collect()
}

/// Warns of loads that vanish beside the weight, unless something else moves the scene.
fn too_small(model: &Model, system: &System, sum: f64, units: &UnitSystem) -> Option<Diagnostic> {
    let weight = mass_and_center(system, &model.nodes)?.0 * model.loading.gravity.norm();
    let moves = model.constraints.restraints.iter().any(|held| held.motion.is_some())
        || !model.loading.base_accelerations.is_empty()
        || model.nodes.iter().any(|node| node.v.norm() > 0.0 || node.omega.norm() > 0.0);
    if sum == 0.0 || sum > NO_LOAD * weight || moves {
        return None;
    }
    let force = symbol(Unit::Force, Some(units));
    let message = format!(
        "the loads sum to {}{force}, {} times the weight of {}{force}: they have no effect beside it",
        short(sum),
        to_digits(sum / weight, 2),
        short(weight)
    );
    let hint = format!(
        "forces are in{force} in the units {}: a load of {} thousand{force} is {}",
        units.name,
        short(sum),
        short(1e3 * sum)
    );
    Some(Diagnostic::warning(message).hint(hint))
}

/// Warns of the force that exceeds most what the beams at its node carry along their axes.
fn too_large(model: &Model, largest: &impl Fn(Option<usize>) -> f64, units: &UnitSystem) -> Option<Diagnostic> {
    let mut forces: BTreeMap<usize, f64> = BTreeMap::new();
    for load in model.loading.nodal.iter().filter(|load| acts(model, load)) {
        *forces.entry(load.node).or_default() += load.force.norm() * largest(load.amplitude);
    }
    let mut carried: BTreeMap<usize, Option<[f64; 2]>> = forces.keys().map(|node| (*node, Some([0.0; 2]))).collect();
    let softest = SOFT / units.pascals();
    for part in &model.parts {
        for (element, node) in (0..part.elements()).flat_map(|e| part.nodes(e).iter().map(move |node| (e, node))) {
            let Some(sum) = carried.get_mut(node) else { continue };
            // Shells, links and soft beams carry forces of any size.
            let more = Beam::of(part).and_then(|beam| strength(model, beam, element, softest));
            *sum = sum.zip(more).map(|(sum, more)| [sum[0] + more[0], sum[1] + more[1]]);
        }
    }
    let beyond = |(node, force): (usize, f64)| {
        let [strength, most] = carried[&node].filter(|of| of[0] > 0.0)?;
        (force > most).then_some((node, force, force / strength))
    };
    let (node, force, times) = forces.into_iter().filter_map(beyond).max_by(|a, b| a.2.total_cmp(&b.2))?;
    let symbol = symbol(Unit::Force, Some(units));
    let message = format!(
        "the force of {}{symbol} at `{}` is {} times what the beams there carry along their axes",
        short(force),
        model.nodes[node].label,
        to_digits(times, 2)
    );
    let hint = format!("forces are in{symbol} in the units {}: is it {}?", units.name, short(1e-3 * force));
    Some(Diagnostic::warning(message).hint(hint))
}

/// The axial force of an element at yield, or at a strain of a thousandth where it stays elastic, and the force beyond which no beam of
/// that kind goes. `None` of soft materials, and of sections that do not say where their area is.
fn strength(model: &Model, beam: &Beam, element: usize, softest: f64) -> Option<[f64; 2]> {
    let section = beam.elements[element].section;
    let stiffness = model.stiffnesses[section].N[(0, 0)];
    if let Some(yielding) = &beam.yielding {
        let (law, _) = yielding.plastic()?;
        let force = stiffness * law.initial_yield() / law.elastic().E;
        return Some([force, BEYOND_YIELD * force]);
    }
    let modulus = stiffness / model.stresses[section].as_ref()?.area();
    (modulus >= softest).then_some([1e-3 * stiffness, BEYOND_ELASTIC * stiffness])
}
