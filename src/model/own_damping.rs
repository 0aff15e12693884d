//! `damping` of parts, links and joints.

use super::data::OwnDamping;
use super::report::Report;
use base::diagnostic::At;
use deck::part_damping::{PartDamping, SpringDamping};
use deck::words::{Maybe, NumberOrTable, Table};

/// The Rayleigh factors of a part that the deck gives it.
pub fn of_part(table: &Option<At<Table<PartDamping>>>, report: &mut Report) -> OwnDamping {
    let Some(table) = table else { return OwnDamping::default() };
    if table.alpha.is_none() && table.beta.is_none() && !report.is_any_spoiled(&table.span) {
        report.error_with::<()>(&table.span, "`damping` is empty", "give it `alpha`, `beta` or both");
    }
    OwnDamping { alpha: factor("alpha", &table.alpha, report), beta: factor("beta", &table.beta, report) }
}

/// The damper of a link or of a joint's coordinate, and the Rayleigh factors that the deck gives its spring.
pub fn of_spring(
    what: &str,
    given: &Maybe<NumberOrTable<Table<SpringDamping>>>,
    report: &mut Report,
) -> (f64, OwnDamping) {
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
