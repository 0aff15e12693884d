//! Concrete that softens by energies: the lengths over which they may spread.

use crate::data::BeamElement;
use crate::part_context::PartContext;
use crate::report::Owner;
use base::names::short;
use mechanics::elements::beam::{FibreGroup, FibreModel};
use mechanics::materials::uniaxial::UniaxialLaw;

/// Reports concrete whose energy of softening is too small for the length that an integration point stands for.
pub(super) fn check_lengths(
    owner: &Owner,
    yielding: &FibreModel,
    (elements, order): (&[BeamElement], usize),
    cx: &mut PartContext,
) -> Option<()> {
    let longest = |group: &FibreGroup| match &group.law {
        UniaxialLaw::Concrete(model) => model.longest(),
        _ => f64::INFINITY,
    };
    let longest = yielding.groups.iter().map(longest).fold(f64::INFINITY, f64::min);
    let length = |element: &BeamElement| {
        let [start, end] = element.ends(order).map(|node| cx.nodes.x(node));
        (end - start).norm()
    };
    let weights = yielding.rule.points(yielding.points).1;
    let part = 0.5 * weights.iter().copied().fold(0.0, f64::max);
    let most = elements.iter().map(length).fold(0.0, f64::max);
    // At the limit the line of softening is vertical.
    if part * most < 0.99 * longest {
        return Some(());
    }
    let message = format!(
        "{}: an integration point stands for a length of {}, over which the energy of softening of its concrete is below the elastic energy",
        owner.what,
        short(part * most)
    );
    let hint = format!(
        "take elements no longer than {}, or give `crushing_strain` and `tension_softening_modulus`",
        short(0.9 * longest / part)
    );
    cx.report.error_with(owner.span, message, hint)
}
