//! Predicts the sizes of tables before a run, and chooses the times of their rows if the deck does not.

use super::extent::{Extent, Rows};
use super::table::TableKind;
use super::tables::TABLES;
use super::{fields, frd};
use base::names::amount;
use model::{Cadence, FieldFiles, FieldFormat, Model, StepLength};
use solve::plan::Plan;

/// The number of bytes of a number with its comma: most have sixteen or seventeen digits.
const NUMBER: usize = 19;
/// The number of bytes of a number that stays zero: `,0.0`.
const ZERO: usize = 4;
/// The number of bytes of a count with its comma.
const COUNT: usize = 2;
/// The number of bytes of the time with its comma.
const TIME: usize = 15;
/// The number of bytes of the step at the start of a row.
const STEP: usize = 5;
/// The size in bytes up to which tables may grow if the deck does not choose the times of their rows.
const MOST: f64 = 20e6;
/// The minimum number of times, even in larger tables, because charts need as many.
const FEWEST: f64 = 200.0;
/// The maximum number of times of a large explicit run: a row costs about half a step.
const EXPLICIT: f64 = 2000.0;
/// The number of elements of a large explicit run.
const LARGE: usize = 1000;
/// The number of bytes below which tables and fields, taken together, need no list of the largest.
const SMALL: f64 = 10e6;

/// The number of bytes of the rows of a table.
fn bytes(kind: &TableKind, model: &Model, rows: &Rows) -> usize {
    let columns = || kind.columns_of(model);
    let (keys, columns) = (columns().filter(|column| column.is_key()).count(), columns().count());
    // Every key has a comma and, if it is not a name, a digit or two; step and time are not keys.
    let fixed = STEP + TIME + keys * COUNT;
    let zeros = (rows.rows * columns.saturating_sub(keys + 2)).saturating_sub(rows.numbers);
    rows.rows * fixed + rows.letters + rows.numbers * NUMBER + zeros * ZERO
}

/// Chooses the times of tables where the deck does not: all steps, unless the tables become large or take much of the run.
pub fn settle_cadence(model: &mut Model, plan: &Plan) {
    if model.output.cadence_is_open {
        let once: usize = sizes(model, plan).iter().map(|(_, size)| size).sum();
        let elements: usize =
            model.parts.iter().filter(|part| part.kind().is_deformable()).map(|part| part.elements()).sum();
        let most = if plan.explicit && elements >= LARGE { EXPLICIT } else { f64::INFINITY };
        let times = (MOST / once.max(1) as f64).max(FEWEST).min(most);
        model.output.cadence = Cadence::at_most(times, model.analysis.duration(), &model.analysis.step_length);
    }
}

/// The number of bytes of one time in each table.
fn sizes(model: &Model, plan: &Plan) -> Vec<(&'static str, usize)> {
    let extent = Extent::new(model, plan);
    let wanted = TABLES.iter().filter(|kind| (kind.wanted)(model));
    wanted.map(|kind| (kind.file, bytes(kind, model, &(kind.extent)(&extent)))).collect()
}

/// The approximate number of bytes of each table in a whole run, and of all grids of the fields; `None` if the number of steps is unknown.
/// With automatic steps that are longer than the time between rows it is less.
pub fn expected_sizes(model: &Model, plan: &Plan) -> Option<Vec<(&'static str, f64)>> {
    let times = times(model, model.output.cadence)?;
    let mut all: Vec<_> = sizes(model, plan).into_iter().map(|(file, size)| (file, size as f64 * times)).collect();
    if let Some(FieldFiles { cadence, format }) = model.output.fields {
        let bytes = if format == FieldFormat::Frd { frd::bytes(model) } else { fields::bytes(model) };
        all.push(("fields", self::times(model, cadence)? * bytes as f64));
    }
    Some(all)
}

/// The expected sizes in words: "about 157 MB in all (nodes.csv 120 MB, energy.csv 30 MB)".
pub fn size_in_words(model: &Model, plan: &Plan) -> String {
    let Some(mut all) = expected_sizes(model, plan) else {
        let once: usize = sizes(model, plan).iter().map(|(_, size)| size).sum();
        return format!("about {} of tables at each of these times", amount(once as f64));
    };
    let total: f64 = all.iter().map(|(_, size)| size).sum();
    // Automatic steps may be longer than the time between rows.
    let most = if matches!(model.output.cadence, Cadence::Apart(_)) { "at most about" } else { "about" };
    let mut words = format!("{most} {} in all", amount(total));
    if total > SMALL {
        all.sort_by(|a, b| b.1.total_cmp(&a.1));
        let large = all.iter().filter(|(_, size)| *size >= 0.05 * total);
        let large: Vec<String> = large.map(|(file, size)| format!("{file} {}", amount(*size))).collect();
        words += &format!(" ({})", large.join(", "));
    }
    words
}

/// The number of times of a cadence; `None` if the deck leaves it open.
fn times(model: &Model, cadence: Cadence) -> Option<f64> {
    let end = model.analysis.duration();
    match (cadence, &model.analysis.step_length) {
        (_, StepLength::ArcLength(_)) => None,
        (Cadence::Interval(apart) | Cadence::Apart(apart), _) => Some(end / apart + 1.0),
        (Cadence::Steps(every), StepLength::Fixed { step }) => Some(end / step / every.max(1) as f64 + 1.0),
        (Cadence::Steps(_), _) => None,
    }
}
