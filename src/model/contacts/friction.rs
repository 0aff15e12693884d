//! Checks of the coefficients of friction that a contact gives.

use crate::report::{Owner, Report};
use base::names::short;
use deck::contacts as words;
use deck::words::NumberOrTable;

/// A coefficient of friction beyond those of rubber on dry concrete and of clean metals in air.
const LARGE: f64 = 2.0;

/// Checks the coefficients of friction; two of them need `has_inertia`, an analysis that knows slip speeds.
pub fn check<'d>(owner: &Owner<'d>, contact: &'d words::Contact, has_inertia: bool, report: &mut Report<'d>) {
    let Some(friction) = &contact.friction else { return };
    let table = match &friction.value {
        NumberOrTable::Number(mu) => {
            if *mu < 0.0 {
                report.error::<()>(&friction.span, "`friction` must not be negative".to_owned());
            }
            return;
        }
        NumberOrTable::Table(table) => table,
    };
    let of = Owner::new(format!("`friction` of {}", owner.what), &friction.span);
    let sticking = report.require_positive(&of, "static", &table.sticking);
    let kinetic = report.require(&of, "kinetic", &table.kinetic).map(|at| at.value);
    if table.decay.is_some() {
        report.require_positive(&of, "decay", &table.decay);
    }
    if let (Some(sticking), Some(kinetic), Some(at)) = (sticking, kinetic, &table.kinetic)
        && !(0.0..=sticking).contains(&kinetic)
    {
        let message = format!("`kinetic` of {}, {}, does not lie between 0 and `static`", owner.what, short(kinetic));
        let hint = format!("a contact that slips has the smaller coefficient: give {} or less", short(sticking));
        report.error_with::<()>(&at.span, message, hint);
    }
    if !has_inertia && let Some(mu) = sticking {
        let message =
            format!("{} has two coefficients of friction, and a static analysis has no slip speed", owner.what);
        let hint = format!("give one coefficient, {} while nothing slips", short(mu));
        report.error_with::<()>(&friction.span, message, hint);
    }
}

/// Warns of a coefficient of friction that hardly any pair of materials has.
pub fn check_size<'d>(contact: &'d words::Contact, report: &mut Report<'d>) {
    let sticking = contact.coefficients().sticking;
    if let Some(friction) = contact.friction.as_ref().filter(|_| sticking > LARGE) {
        let message = format!("a `friction` of {} is larger than that of most pairs of materials", short(sticking));
        report.warn(
            &friction.span,
            message,
            "give a coefficient such as 0.2, or join what must not slip by `[[ties]]`",
        );
    }
}
