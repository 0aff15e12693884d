//! phase.csv: the errors of all runs over time, split into phase and amplitude ([`split`]), over the whole run and over eighths of
//! it, so that it shows how a phase grows.

use super::cells::{field, float, maybe};
use super::grid::StudyGrid;
use super::phase_fit::{Split, split};
use super::reference::Reference;
use super::run::{RunStatus, StudyRun};
use super::section::StudySection;
use model::study::Quantity;

/// The number of parts of a run that are split apart, besides the whole.
const PARTS: usize = 8;
/// The columns of phase.csv.
const HEAD: &str = "run,quantity,from,to,shift,factor,error,phase,amplitude,rest\n";

/// The error of a quantity of a run from one time to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Phase {
    /// The index of the run.
    pub run: usize,
    /// The index of the quantity.
    pub quantity: usize,
    /// From this time ...
    pub from: f64,
    /// ... to this one.
    pub to: f64,
    /// Its parts; errors relative to the largest value of the quantity in the whole run.
    pub split: Split,
}

/// The splits of all runs, of each quantity first the whole.
pub fn phases(grid: &StudyGrid, runs: &[StudyRun], reference: &Reference, count: usize) -> Vec<Phase> {
    let times = grid.samples + 1;
    let interval = grid.end_time / grid.samples as f64;
    let column = |values: &[f64], k: usize| -> Vec<f64> { (0..times).map(|i| values[i * count + k]).collect() };
    let mut found = Vec::new();
    let done = runs.iter().enumerate().filter(|(_, run)| run.status == RunStatus::Done && run.error.is_some());
    for (index, run) in done {
        for quantity in 0..count {
            let (q, r) = (column(&run.history, quantity), column(&reference.values, quantity));
            let largest = r.iter().fold(0.0f64, |most, value| most.max(value.abs()));
            let parts = (0..PARTS).map(|k| [k * grid.samples / PARTS, (k + 1) * grid.samples / PARTS]);
            for [first, last] in std::iter::once([0, grid.samples]).chain(parts) {
                let Some(of) = split(&q[first..=last], &r[first..=last], interval) else { continue };
                let part = |error: f64| error / largest;
                let split = Split {
                    error: part(of.error),
                    phase: part(of.phase),
                    amplitude: part(of.amplitude),
                    rest: part(of.rest),
                    ..of
                };
                let (from, to) = (first as f64 * interval, last as f64 * interval);
                found.push(Phase { run: index, quantity, from, to, split });
            }
        }
    }
    found
}

/// The text of phase.csv.
pub fn table(phases: &[Phase], quantities: &[Quantity]) -> String {
    let mut out = HEAD.to_owned();
    for Phase { run, quantity, from, to, split } in phases {
        let numbers = [split.factor, split.error, split.phase, split.amplitude, split.rest].map(float).join(",");
        let (name, shift) = (field(&quantities[*quantity].word()), maybe(split.shift));
        out += &format!("{},{name},{},{},{shift},{numbers}\n", run + 1, float(*from), float(*to));
    }
    out
}

/// Of each line the run with the least resolved error, and of it the quantity that errs most.
pub fn section(grid: &StudyGrid, runs: &[StudyRun], phases: &[Phase], quantities: &[Quantity]) -> StudySection {
    let mut rows = Vec::new();
    for (index, line) in grid.lines.iter().enumerate() {
        let of_line = runs.iter().enumerate().filter(|(_, run)| run.line == index && run.resolved);
        let Some((best, run)) =
            of_line.min_by(|(_, a), (_, b)| a.error.partial_cmp(&b.error).unwrap_or(std::cmp::Ordering::Equal))
        else {
            continue;
        };
        let whole =
            phases.iter().filter(|phase| phase.run == best && phase.from == 0.0 && phase.to > 0.5 * grid.end_time);
        let Some(of) = whole.max_by(|a, b| a.split.error.total_cmp(&b.split.error)) else { continue };
        let s = &of.split;
        let percent = |part: f64| format!("{part:.1e}");
        rows.push(vec![
            line.label.clone(),
            line.resolution(run.resolution),
            quantities[of.quantity].word(),
            percent(s.error),
            s.shift.map_or(String::new(), |shift| format!("{shift:.2e}")),
            format!("{:.6}", s.factor),
            percent(s.phase),
            percent(s.amplitude),
            percent(s.rest),
        ]);
    }
    let head = vec!["setting", "time step", "quantity", "error", "late by", "factor", "phase", "amplitude", "left"];
    StudySection { title: "Phase and amplitude", head, rows, notes: Vec::new() }
}

#[cfg(test)]
mod tests {
    use super::super::lines::StudyLine;
    use super::*;

    #[test]
    fn a_phase_that_grows_shows_in_the_parts_of_a_run() {
        // A vibration that is slow by one part in a thousand, twice as large in the second quantity: late by t/1000.
        let grid = StudyGrid::of_steps(vec![StudyLine::plain("newmark")], vec![0.01], 4.0, 400);
        let times = (0..=400).map(|k| 0.01 * f64::from(k));
        let values =
            |slow: f64| times.clone().flat_map(move |t| [(6.0 * slow * t).sin(), 2.0 * (5.0 * slow * t).cos()]);
        let (history, exact): (Vec<f64>, Vec<f64>) = (values(0.999).collect(), values(1.0).collect());
        let run = StudyRun::made_up(0, 0.01, 1.0, Some(1e-3), history);
        let found = phases(&grid, &[run], &Reference::of_values(exact), 2);
        assert_eq!(found.len(), 2 * 9);
        for phase in found.iter().filter(|phase| phase.to - phase.from < 1.0) {
            // In its middle a part is late by that; the rest of the change of phase stays within 0.25 ms.
            let late = 1e-3 * 0.5 * (phase.from + phase.to);
            assert!((phase.split.shift.unwrap() - late).abs() < 2e-4, "{phase:?}");
            assert!((phase.split.factor - 1.0).abs() < 1e-2, "{phase:?}");
        }
        assert!(found.iter().all(|phase| phase.split.rest <= phase.split.error * 1.01), "{found:?}");
    }
}
