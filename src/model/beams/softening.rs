//! Concrete that softens by energies: the lengths over which they may spread.

use crate::data::BeamElement;
use crate::part_context::PartContext;
use crate::report::Owner;
use base::diagnostic::At;
use base::names::short;
use mechanics::elements::beam::FibreModel;
use mechanics::materials::uniaxial::{Softening, UniaxialLaw};

/// Reports concrete with too little energy of softening for the length of the beam at an integration point. `materials` are those of the
/// beam and of the core of its section, in the order of the groups of fibres.
pub(super) fn check_lengths(
    owner: &Owner,
    (yielding, materials): (&FibreModel, [Option<&At<String>>; 2]),
    (elements, order): (&[BeamElement], usize),
    cx: &mut PartContext,
) -> Option<()> {
    let length = |element: &BeamElement| {
        let [start, end] = element.ends(order).map(|node| cx.nodes.x(node));
        (end - start).norm()
    };
    let weights = yielding.rule.points(yielding.points).1;
    let part = 0.5 * weights.iter().copied().fold(0.0, f64::max);
    let most = part * elements.iter().map(length).fold(0.0, f64::max);
    let mut sound = true;
    for (group, material) in yielding.groups.iter().zip(materials.into_iter().flatten()) {
        let UniaxialLaw::Concrete(concrete) = &group.law else { continue };
        let keys = [("crushing_energy", "crushing_strain"), ("fracture_energy", "tension_softening_modulus")];
        let energies = [concrete.crushing, concrete.cracking].into_iter().zip(concrete.longest());
        for ((key, other), (energy, longest)) in keys.into_iter().zip(energies) {
            let Softening::Energy(energy) = energy else { continue };
            // At the limit the line of softening is vertical.
            if most < 0.99 * longest {
                continue;
            }
            let message = format!(
                "{}: `{key}` of material `{}` is {}, but an integration point stands for a length of {}, whose elastic energy is {}",
                owner.what,
                material.value,
                short(energy),
                short(most),
                short(energy * most / longest),
            );
            let hint = format!(
                "take elements no longer than {}, more `points`, or give `{other}`",
                short(0.9 * longest / part)
            );
            cx.report.error_with::<()>(owner.span, message, hint);
            sound = false;
        }
    }
    sound.then_some(())
}
