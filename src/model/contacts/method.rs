//! How a contact keeps things apart: by springs alone, or by multipliers besides, which leave no depth.

use crate::report::{Owner, Report};
use crate::scene::Scene;
use crate::values::{keys, span};
use base::diagnostic::Span;
use base::names::short;
use deck::contacts::{Contact, ContactMethod};

/// The default tolerance of the depth, relative to the size of the touching bodies: the tolerance of equilibria.
const LEFT: f64 = 1e-8;
/// The least that a tolerance may be, as a part of the largest coordinates: some digits above their rounding.
const LEAST: f64 = 1e-14;

/// True where a contact has multipliers.
pub fn is_augmented(contact: &Contact) -> bool {
    contact.method.as_ref().is_some_and(|at| at.value == ContactMethod::AugmentedLagrangian)
}

/// The largest tolerance, relative to the size of the touching bodies.
const MOST: f64 = 1e-4;

/// Checks the keys of the method, and returns the tolerance of the depth; `None` for springs alone. `by_points` is true for contact by
/// points. `size` is the size of the touching bodies, `extent` the extent of the model.
pub fn tolerance(
    scene: &Scene,
    owner: &Owner,
    contact: &Contact,
    by_points: bool,
    (size, extent): (f64, f64),
    report: &mut Report,
) -> Option<f64> {
    let given = &contact.penetration_tolerance;
    let Some(at) = contact.method.as_ref().filter(|_| is_augmented(contact)) else {
        report.reject_unused("`method = \"penalty\"`", &[("penetration_tolerance", span(given))]);
        return None;
    };
    check_analysis(scene, &at.span, report);
    if !by_points {
        let message = format!(
            "{} has no multipliers: it is one of faces, or of boxes, hulls and capsules on each other, and not of points",
            owner.what
        );
        let hint = "points, nodes of parts and spheres have them on any shape, bodies on planes and cylinders";
        report.error_with::<()>(&at.span, message, hint);
    }
    let keys = keys!(contact; restitution, damping);
    report.reject_unused("`method = \"augmented-lagrangian\"`, which is of load steps", &keys);
    let given = match given {
        Some(given) if given.value <= LEAST * extent || !given.value.is_finite() => {
            let message = format!(
                "`penetration_tolerance` must be above {}, the rounding error of positions",
                short(LEAST * extent)
            );
            report.error(&given.span, message)
        }
        Some(given) if size > 0.0 && given.value > MOST * size => {
            let message = format!(
                "`penetration_tolerance` must be at most {}, a ten-thousandth of the smallest touching body: rdsolve would take the work lost in \
                 a larger depth for a jump of the equilibrium",
                short(MOST * size)
            );
            report.error(&given.span, message)
        }
        Some(given) => Some(given.value),
        None => None,
    };
    Some(given.unwrap_or((LEFT * size).max(10.0 * LEAST * extent)))
}

/// Refuses analyses that are no load steps.
fn check_analysis(scene: &Scene, place: &Span, report: &mut Report) {
    let analysis = &scene.analysis;
    if !analysis.is_static() {
        let message = "`method = \"augmented-lagrangian\"` is of load steps: impacts, and modes, are those of springs";
        let hint = match scene.stage {
            Some(_) => "name the static stages in `stages` of this contact, or leave `method` out",
            None => "leave `method` out, or make the analysis `static`",
        };
        report.error_with::<()>(place, message, hint);
    }
}
