//! study.csv: a row for each run.

use super::cells::{field, float, maybe};
use super::found::Found;
use super::order::local;
use super::run::StudyRun;

/// The columns, behind which the errors of the quantities stand.
const COLUMNS: [&str; 29] = [
    "run",
    "scheme",
    "method",
    "iteration_tolerance",
    "mesh",
    "beam_order",
    "unknowns",
    "time_step",
    "error_tolerance",
    "status",
    "error",
    "resolved",
    "order",
    "reference_error",
    "loop_s",
    "loop_median_s",
    "process_s",
    "repeats",
    "steps",
    "iterations",
    "factorizations",
    "cuts",
    "other_runs",
    "other_steps",
    "other_iterations",
    "other_factorizations",
    "estimate",
    "folder",
    "reason",
];

/// The text of study.csv.
pub fn table(found: &Found) -> String {
    let mut header: Vec<String> = COLUMNS.map(String::from).to_vec();
    header.extend(found.quantities.iter().map(|quantity| field(&format!("error:{}", quantity.word()))));
    let mut text = header.join(",") + "\n";
    let mut before: Option<&StudyRun> = None;
    for (index, run) in found.runs.iter().enumerate() {
        let line = &found.grid.lines[run.line];
        let order = local(before.filter(|before| before.line == run.line), run);
        before = Some(run);
        let count = |number: u64| if run.measured.steps > 0 { number.to_string() } else { String::new() };
        let m = &run.measured;
        let other = |number: u64| if line.automatic { count(number) } else { String::new() };
        let resolved = run.error.map_or("", |_| if run.resolved { "1" } else { "0" });
        let mut row = vec![
            (index + 1).to_string(),
            field(&line.scheme),
            line.method.clone(),
            float(line.iteration_tolerance),
            float(line.mesh),
            line.beam_order.map_or(String::new(), |order| order.to_string()),
            count(m.unknowns),
            if line.automatic { String::new() } else { float(run.resolution) },
            if line.automatic { float(run.resolution) } else { String::new() },
            run.status.word().to_owned(),
            maybe(run.error),
            resolved.to_owned(),
            maybe(order),
            maybe(found.reference.as_ref().ok().map(|reference| reference.error_bound).filter(|bound| *bound > 0.0)),
            if m.steps > 0 { maybe(Some(run.loop_s)) } else { String::new() },
            if m.steps > 0 { maybe(Some(run.median_s())) } else { String::new() },
            maybe(Some(run.process_s)),
            run.times.len().to_string(),
            count(m.steps),
            count(m.iterations),
            count(m.factorizations),
            count(m.cuts),
            other(m.other_runs),
            other(m.other_steps),
            other(m.other_iterations),
            other(m.other_factorizations),
            maybe(m.estimate),
            run.folder.clone(),
            field(&run.reason),
        ];
        row.extend((0..found.quantities.len()).map(|i| maybe(run.errors.get(i).copied())));
        text += &(row.join(",") + "\n");
    }
    text
}
