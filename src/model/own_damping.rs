//! `damping` of parts, links and joints.

use super::data::OwnDamping;
use super::report::Report;
use super::values::keys;
use base::diagnostic::At;
use deck::part_damping::{PartDamping, SpringDamping};
use deck::words::{Maybe, NumberOrTable, Table};
use mechanics::elements::damper::Damper;

/// The Rayleigh factors of a part that the deck gives it.
pub fn of_part(table: &Option<At<Table<PartDamping>>>, report: &mut Report) -> OwnDamping {
    let Some(table) = table else { return OwnDamping::default() };
    if table.alpha.is_none() && table.beta.is_none() && !report.is_any_spoiled(&table.span) {
        report.error_with::<()>(&table.span, "`damping` is empty", "give it `alpha`, `beta` or both");
    }
    OwnDamping { alpha: factor("alpha", &table.alpha, report), beta: factor("beta", &table.beta, report) }
}

/// The damper of a link along its line, and the Rayleigh factor that the deck gives its spring.
pub fn of_link(given: &Maybe<NumberOrTable<Table<SpringDamping>>>, report: &mut Report) -> (Damper, OwnDamping) {
    let (coefficient, own) = of_spring("a link", given, report);
    (given.as_ref().and_then(|given| power(given, coefficient, report)).unwrap_or(Damper::linear(coefficient)), own)
}

/// The damper along the coordinate of a joint, and the Rayleigh factor that the deck gives its spring.
pub fn of_joint(given: &Maybe<NumberOrTable<Table<SpringDamping>>>, report: &mut Report) -> (f64, OwnDamping) {
    if let Some(NumberOrTable::Table(table)) = given.as_ref().map(|given| &given.value) {
        for (key, place) in keys!(table; exponent, slow) {
            if let Some(place) = place {
                let message = format!("`{key}` does not apply to a joint, whose damper is linear");
                report.error_with::<()>(
                    place,
                    message,
                    "a `[[links]]` between the two parts has dampers with exponents",
                );
            }
        }
    }
    of_spring("a joint", given, report)
}

/// A damper with an exponent other than 1.
fn power(given: &At<NumberOrTable<Table<SpringDamping>>>, coefficient: f64, report: &mut Report) -> Option<Damper> {
    /// Beyond it a force of air or water, of exponent 2, has long been passed.
    const MOST: f64 = 4.0;
    let NumberOrTable::Table(table) = &given.value else { return None };
    let Some(exponent) = &table.exponent else {
        if let Some(slow) = &table.slow {
            report.error_with::<()>(&slow.span, "`slow` needs an `exponent`", "a linear damper is linear at any rate");
        }
        return None;
    };
    if table.viscous.is_none() && !report.is_spoiled(&given.span, "viscous") {
        let hint = "`viscous` is the force at the rate 1";
        report.error_with::<()>(&exponent.span, "`exponent` needs `viscous`", hint);
    }
    if !(exponent.value > 0.0 && exponent.value <= MOST) {
        let hint = "fluid dampers have 0.2 to 1, drag has 2, and friction is a joint's";
        let message = format!("`exponent` must be above 0, and at most {MOST}");
        return report.error_with(&exponent.span, message, hint);
    }
    let slow = report.not_negative("slow", &table.slow, 0.0);
    if exponent.value < 1.0 && slow == 0.0 && !report.is_any_spoiled(&given.span) {
        let place = table.slow.as_ref().map_or(&exponent.span, |slow| &slow.span);
        let message = "an `exponent` below 1 needs `slow` above 0: at rest the slope of the force would be infinite";
        let hint = "give a thousandth of the largest rate: the force then errs by less than 1e-6 there, and by less than a third at `slow`";
        return report.error_with(place, message, hint);
    }
    Some(Damper { coefficient, exponent: exponent.value, slow })
}

/// The coefficient of the damper of a link or of a joint's coordinate, and the Rayleigh factor that the deck gives its spring.
fn of_spring(what: &str, given: &Maybe<NumberOrTable<Table<SpringDamping>>>, report: &mut Report) -> (f64, OwnDamping) {
    let Some(given) = given else { return (0.0, OwnDamping::default()) };
    let table = match &given.value {
        NumberOrTable::Number(value) => {
            let value = Some(At { value: *value, span: given.span.clone() });
            return (report.not_negative("damping", &value, 0.0), OwnDamping::default());
        }
        NumberOrTable::Table(table) => table,
    };
    if let Some(alpha) = &table.alpha {
        let message = format!("`alpha` does not apply to {what}, which has no mass");
        report.error_with::<()>(&alpha.span, message, "`beta` damps its spring");
    }
    if table.alpha.is_none() && table.beta.is_none() && table.viscous.is_none() && !report.is_any_spoiled(&given.span) {
        report.error_with::<()>(&given.span, "`damping` is empty", "give it `beta`, `viscous` or both");
    }
    let own = OwnDamping { alpha: None, beta: factor("beta", &table.beta, report) };
    (report.not_negative("viscous", &table.viscous, 0.0), own)
}

fn factor(key: &str, value: &Maybe<f64>, report: &mut Report) -> Option<f64> {
    value.as_ref().map(|_| report.not_negative(key, value, 0.0))
}
