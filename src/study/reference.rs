//! The reference of all errors: a file, or the limit of the finest runs.
//!
//! Without a file, each line of settings is extrapolated to a time step of zero (Richardson) from its two finest runs: q* = q + (q −
//! q')/(rᵖ − 1). The order p is the measured order of the three finest, or the nearest whole number. A whole order with one coarser
//! resolution gives an independent answer; the difference is a generous bound of the error of q*. Of an order that is not whole, the whole
//! ones on both sides give the bound. Over several meshes the limits in time are extrapolated in the same way. The line with the least
//! bound is taken, and its bound raised where another line's limit lies farther off than both bounds allow.
//!
//! The step of a run is the mean of its actual steps. Requested steps may have been cut to the limit of stability or to the sampling
//! interval, and runs with equal steps do not show their error.

use super::confirmation::Confirmation;
use super::family::Family;
use super::grid::StudyGrid;
use super::history;
use super::limit::{Limit, limit};
use super::lines::StudyLine;
use super::reference_file::GivenReference;
use super::run::{RunStatus, StudyRun};
use model::study::Quantity;

/// Mean steps count as equally long up to this ratio. It is less than the ratio of a halving, and more than the rounding to whole steps.
const ALIKE: f64 = 1.05;
/// The values that errors are measured against.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// The values at the sample times one after the other, each time all quantities.
    pub values: Vec<f64>,
    /// A bound of its error, relative as errors are; 0 for a file, with unknown error.
    pub error_bound: f64,
    /// Where it comes from, in words.
    pub source: String,
    /// The limit in the time step alone, on the finest mesh, and a bound of its error; `None` for a file.
    pub in_time: Option<(Vec<f64>, f64)>,
    /// The family of the schemes that it comes from; `None` for a file.
    pub family: Option<Family>,
    /// Its judgement by another family.
    pub confirmation: Confirmation,
}

impl From<GivenReference> for Reference {
    fn from(given: GivenReference) -> Self {
        Reference {
            values: given.values,
            error_bound: 0.0,
            source: given.source,
            in_time: None,
            family: None,
            confirmation: Confirmation::None,
        }
    }
}

/// The mean steps of the runs of a line, coarse to fine, each shorter than the one before. Runs that the critical time step or the
/// interval between samples has made alike are one run: the last of them counts.
fn distinct<'a>(runs: impl DoubleEndedIterator<Item = &'a StudyRun>, end_time: f64) -> Vec<(f64, &'a StudyRun)> {
    let mut kept: Vec<(f64, &StudyRun)> = Vec::new();
    for run in runs.rev().filter(|run| run.measured.steps > 0) {
        let h = end_time / run.measured.steps as f64;
        if kept.last().is_none_or(|(finer, _)| h > ALIKE * finer) {
            kept.push((h, run));
        }
    }
    kept.reverse();
    kept
}

/// Why there is nothing to extrapolate.
fn nothing(grid: &StudyGrid, runs: &[StudyRun]) -> String {
    let ended = |line: usize| runs.iter().filter(move |run| run.line == line && run.status == RunStatus::Done).count();
    let resolutions = |line: usize| grid.resolutions(line).len();
    let lines = || 0..grid.lines.len();
    if lines().any(|line| ended(line) > 1) {
        "no two runs of a line differ: steps are as long as samples or stability allow".to_owned()
    } else if lines().all(|line| ended(line) == resolutions(line)) {
        "each line has one run: take two time steps or more".to_owned()
    } else {
        "too few runs came to their end".to_owned()
    }
}

/// The message about quantities that are zero throughout.
fn at_rest(quantities: &[Quantity]) -> String {
    let turns = quantities.iter().find(|quantity| quantity.body && quantity.column.starts_with('u'));
    let hint = turns.map(|body| format!("; a body that turns: `quantities = [\"{}.body_wx\"]`", body.name));
    format!("nothing moves of what errors are measured on{}", hint.unwrap_or_default())
}

/// The limit that the runs of a grid tend to.
///
/// # Errors
/// The limit is not known; the error says why, in words.
pub fn extrapolate(grid: &StudyGrid, runs: &[StudyRun], quantities: &[Quantity]) -> Result<Reference, String> {
    let candidates = candidates(grid, runs);
    let of = |(_, time, mesh): &(usize, Limit, Option<Limit>)| mesh.clone().unwrap_or_else(|| time.clone());
    let Some(best) = candidates.iter().min_by(|a, b| of(a).error_bound.total_cmp(&of(b).error_bound)) else {
        return Err(nothing(grid, runs));
    };
    let limit = of(best);
    if limit.q.iter().all(|value| *value == 0.0) {
        return Err(at_rest(quantities));
    }
    if !limit.error_bound.is_finite() {
        return Err("the runs are too far apart to tell a limit".to_owned());
    }
    let count = limit.q.len() / (grid.samples + 1);
    let apart = |other: &Limit| history::error(&other.q, &limit.q, count, |_| true) - other.error_bound;
    let error_bound = candidates.iter().map(|other| apart(&of(other))).fold(limit.error_bound, f64::max);
    let order = |limit: &Limit, what: &str| match limit.order {
        Some(order) => format!("extrapolated in the {what} at order {}", base::names::short(order)),
        None => format!("not extrapolated in the {what}"),
    };
    let mut source = format!("the finest runs of {}, {}", grid.lines[best.0].label, order(&best.1, "time step"));
    if let Some(mesh) = &best.2 {
        source += &format!(" and {}", order(mesh, "mesh"));
    }
    let in_time = Some((best.1.q.clone(), best.1.error_bound));
    let family = Some(grid.lines[best.0].family);
    Ok(Reference { values: limit.q, error_bound, source, in_time, family, confirmation: Confirmation::None })
}

/// The lines on the best mesh with a limit, each with the limit in the time step and the limit in the mesh too.
fn candidates(grid: &StudyGrid, runs: &[StudyRun]) -> Vec<(usize, Limit, Option<Limit>)> {
    let ended = runs.iter().filter(|run| run.status == RunStatus::Done);
    // Of several meshes, degrees and tolerances the best are extrapolated.
    let ranks = ended.map(|run| grid.lines[run.line].rank());
    let finest = ranks.fold([f64::MIN; 3], |best, of| if of > best { of } else { best });
    let lines = grid.lines.iter().enumerate().filter(|(_, line)| line.rank() == finest);
    let mut candidates: Vec<_> =
        lines.filter_map(|(index, _)| over_meshes(grid, runs, index).map(|(time, mesh)| (index, time, mesh))).collect();
    // Automatic steps differ from resolution to resolution in more than their length.
    if candidates.iter().any(|(line, ..)| !grid.lines[*line].automatic) {
        candidates.retain(|(line, ..)| !grid.lines[*line].automatic);
    }
    candidates
}

/// The limit of a line in the time step.
pub fn in_time(grid: &StudyGrid, runs: &[StudyRun], line: usize) -> Option<(Limit, usize)> {
    let done = runs.iter().filter(|run| run.line == line && run.status == RunStatus::Done);
    let (h, q): (Vec<f64>, Vec<&[f64]>) =
        distinct(done, grid.end_time).iter().map(|(h, run)| (*h, run.history.as_slice())).unzip();
    let count = q.first()?.len() / (grid.samples + 1);
    limit(&h, &q, count, grid.lines[line].order).map(|limit| (limit, count))
}

/// The limit of a line in the time step, and the limit of it and its coarser meshes in both time step and mesh.
fn over_meshes(grid: &StudyGrid, runs: &[StudyRun], index: usize) -> Option<(Limit, Option<Limit>)> {
    let line = &grid.lines[index];
    let of_line = |index: usize| in_time(grid, runs, index);
    let (time, count) = of_line(index)?;
    let same = |other: &StudyLine| other.is_like(line) && other.beam_order == line.beam_order;
    let meshes = grid.lines.iter().enumerate().filter(|(_, other)| same(other));
    let mut meshes: Vec<(f64, Limit)> =
        meshes.filter_map(|(i, other)| Some((1.0 / other.mesh, of_line(i)?.0))).collect();
    meshes.sort_by(|a, b| b.0.total_cmp(&a.0));
    if meshes.len() < 2 {
        return Some((time, None));
    }
    let (h, q): (Vec<f64>, Vec<&[f64]>) = meshes.iter().map(|(h, limit)| (*h, limit.q.as_slice())).unzip();
    let mut mesh = limit(&h, &q, count, f64::INFINITY)?;
    let in_time = meshes.iter().rev().take(2).map(|(_, limit)| limit.error_bound).fold(0.0, f64::max);
    mesh.error_bound += mesh.growth * in_time;
    Some((time, Some(mesh)))
}
