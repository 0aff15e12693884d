//! Stresses beyond the yield stress of materials, which stay elastic in a linear analysis.

use crate::derived::{Derived, Wanted};
use crate::system::judges_stresses;
use crate::warning::Warnings;
use base::math::{Mat3, Vec3};
use model::{Model, YieldLimit};

/// The results from which stresses are known.
pub fn needs(model: &Model) -> Wanted {
    match model.cases.yield_limits.is_empty() {
        true if judges_stresses(model) => Wanted::SECTIONS,
        true => Wanted::NOTHING,
        false => Wanted::SECTIONS | Wanted::SHELLS | Wanted::BARS,
    }
}

/// Warns of the part whose stress is farthest beyond its yield stress.
pub fn warn_beyond_yield(model: &Model, derived: &Derived, warnings: &mut Warnings) {
    let mut bars = derived.bars.iter();
    for part in 0..model.parts.len() {
        let is_of_bars = model.parts[part].kind().is_line() && !model.parts[part].kind().has_sections();
        let forces = bars.by_ref().take(if is_of_bars { model.parts[part].elements() } else { 0 });
        let largest = forces.fold(0.0f64, |largest, force| largest.max(force.abs()));
        let Some(limit) = model.cases.yield_limits.iter().find(|limit| limit.part == part) else { continue };
        let own = derived.shells.iter().filter(|state| state.part == part);
        let of_shells = own.map(|state| state.von_mises()).fold(0.0, f64::max);
        let in_bars = if limit.area > 0.0 { largest / limit.area } else { 0.0 };
        let stress = in_bars.max(of_shells).max(largest_in_fibres(model, limit, derived));
        if stress > limit.stress {
            warnings.beyond_yield(model.parts[part].name(), stress, limit.stress);
        }
    }
}

/// The largest normal stress in the fibres of a part.
fn largest_in_fibres(model: &Model, limit: &YieldLimit, derived: &Derived) -> f64 {
    let solve = |of: &Mat3, by: Vec3| of.try_inverse().map_or_else(Vec3::zeros, |inverse| inverse * by);
    let mut largest = 0.0f64;
    for point in derived.sections.iter().filter(|point| point.part == limit.part) {
        let Some(section) = limit.sections.get(point.element).map(|&section| &model.stiffnesses[section]) else {
            continue;
        };
        let [n, vy, vz, t, my, mz] = point.at.forces;
        let strain = solve(&section.N, Vec3::new(n, vy, vz)).x;
        let curvature = solve(&section.M, Vec3::new(t, my, mz));
        for [y, z] in &limit.fibres {
            let stress = limit.modulus * (strain + z * curvature.y - y * curvature.z);
            largest = largest.max(stress.abs());
        }
    }
    largest
}
