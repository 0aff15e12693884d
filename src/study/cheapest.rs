//! The cost of an error on each line, as a range, and ranks: where ranges overlap nothing is ranked.
//!
//! A cost is known as well as its times repeat and as the reference is known. The lower end uses the least times and the smallest errors
//! within the bound of the reference, the upper end the median times and the largest errors.

use super::grid::StudyGrid;
use super::run::{StudyRun, spread};

/// The factor by which the time of a single run may be off on a busy machine, if no setting ran twice.
const ONCE: f64 = 1.5;
/// Where the bound of the reference allows no error at all, this part of the error is taken, for logarithms.
const NEXT_TO_NOTHING: f64 = 1e-3;

/// The cost of an error on one line, interpolated between its runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cheapest {
    /// The index of the line in [`StudyGrid::lines`].
    pub line: usize,
    /// The seconds of the time stepping.
    pub loop_s: f64,
    /// The range of these seconds; infinite at its upper end if the error may be out of reach.
    pub range: [f64; 2],
    /// One more than the number of lines that are cheaper for certain: lines with one rank are equal within noise.
    pub rank: usize,
    /// The seconds of the whole process.
    pub process_s: f64,
    /// The time step or the tolerance.
    pub resolution: f64,
    /// True where the coarsest setting of the grid is better than asked for already.
    pub at_the_top: bool,
}

impl Cheapest {
    /// Whether nothing tells which of the two is cheaper.
    pub fn equals(&self, other: &Cheapest) -> bool {
        self.range[0] <= other.range[1] && other.range[0] <= self.range[1]
    }
}

/// A run as one of the three views of it: as measured, at best, at worst.
#[derive(Clone, Copy)]
struct Seen {
    resolution: f64,
    error: f64,
    loop_s: f64,
    process_s: f64,
}

/// For each error asked for, the lines that come to it, the cheapest first. Costs are interpolated on straight lines between
/// neighbours of log error and log time, and never extrapolated beyond the grid.
pub fn cheapest(grid: &StudyGrid, runs: &[StudyRun], wanted: &[f64]) -> Vec<(f64, Vec<Cheapest>)> {
    let noise = noise(runs);
    let of = |error: f64| {
        let lines = 0..grid.lines.len();
        let cost = |line: usize| {
            let of_line: Vec<&StudyRun> = runs.iter().filter(|run| run.line == line).collect();
            cost(grid.resolutions(line), &of_line, line, error, noise)
        };
        let mut found: Vec<Cheapest> = lines.filter_map(cost).collect();
        found.sort_by(|a, b| a.loop_s.total_cmp(&b.loop_s));
        let ranges: Vec<[f64; 2]> = found.iter().map(|of| of.range).collect();
        for of in &mut found {
            of.rank = 1 + ranges.iter().filter(|range| range[1] < of.range[0]).count();
        }
        (error, found)
    };
    wanted.iter().map(|&error| of(error)).collect()
}

/// The factor by which the time of a single run may be off: the scatter of the repeated runs.
pub fn noise(runs: &[StudyRun]) -> f64 {
    spread(runs).unwrap_or(ONCE)
}

/// The range of the seconds of a run: from the least to the median of its repeats, or of a single run by the `noise` of others.
pub fn seconds_range(run: &StudyRun, noise: f64) -> [f64; 2] {
    match run.times.len() {
        0 | 1 => [run.loop_s / noise, run.loop_s * noise],
        _ => [run.loop_s, run.median_s()],
    }
}

/// The least cost of a line with the wanted error, with its range.
fn cost(resolutions: &[f64], runs: &[&StudyRun], line: usize, wanted: f64, noise: f64) -> Option<Cheapest> {
    let view = |error: &dyn Fn(&StudyRun) -> Option<f64>, loop_s: &dyn Fn(&StudyRun) -> f64| -> Vec<Seen> {
        let seen = runs.iter().filter_map(|run| {
            let (resolution, process_s) = (run.resolution, run.process_s);
            Some(Seen { resolution, error: error(run)?, loop_s: loop_s(run), process_s })
        });
        seen.collect()
    };
    // A bound counts as an error: the true error is at most as large.
    let (best, at_the_top) = least(resolutions, &view(&|run| run.error, &|run| run.loop_s), wanted)?;
    let low = |run: &StudyRun| Some(run.error_range()?[0].max(NEXT_TO_NOTHING * run.error?));
    let low = view(&low, &|run| seconds_range(run, noise)[0]);
    let high = view(&|run| Some(run.error_range()?[1]), &|run| seconds_range(run, noise)[1]);
    let end = |of: Vec<Seen>, none: f64| least(resolutions, &of, wanted).map_or(none, |(seen, _)| seen.loop_s);
    let range = [end(low, best.loop_s).min(best.loop_s), end(high, f64::INFINITY).max(best.loop_s)];
    let Seen { resolution, loop_s, process_s, .. } = best;
    Some(Cheapest { line, loop_s, range, rank: 1, process_s, resolution, at_the_top })
}

/// The cheapest point of a line with the wanted error, and whether it is the coarsest setting.
fn least(resolutions: &[f64], runs: &[Seen], wanted: f64) -> Option<(Seen, bool)> {
    let reached = runs.iter().filter(|run| run.error <= wanted);
    let mut best = *reached.min_by(|a, b| a.loop_s.total_cmp(&b.loop_s))?;
    let mut at_the_top = resolutions.first() == Some(&best.resolution);
    for pair in runs.windows(2) {
        let [coarse, fine] = pair else { continue };
        let neighbours = resolutions.windows(2).any(|pair| pair == [coarse.resolution, fine.resolution]);
        if !(neighbours && coarse.error > wanted && fine.error < wanted && fine.error > 0.0) {
            continue;
        }
        let part = (coarse.error / wanted).ln() / (coarse.error / fine.error).ln();
        let between = |of: fn(&Seen) -> f64| (of(coarse).ln() + part * (of(fine).ln() - of(coarse).ln())).exp();
        let loop_s = between(|run| run.loop_s);
        if loop_s < best.loop_s {
            let (process_s, resolution) = (between(|run| run.process_s), between(|run| run.resolution));
            (best, at_the_top) = (Seen { resolution, error: wanted, loop_s, process_s }, false);
        }
    }
    Some((best, at_the_top))
}

#[cfg(test)]
mod tests {
    use super::super::lines::StudyLine;
    use super::*;

    const STEPS: [f64; 4] = [0.08, 0.04, 0.02, 0.01];

    /// Runs of three lines of second order, whose repeats take these seconds at the longest step.
    fn runs(times: [&[f64]; 3], bound: f64) -> (StudyGrid, Vec<StudyRun>) {
        let lines = ["a", "b", "c"].map(StudyLine::plain).to_vec();
        let grid = StudyGrid::of_steps(lines, STEPS.to_vec(), 1.0, 10);
        let mut runs = Vec::new();
        for (line, times) in times.iter().enumerate() {
            for step in STEPS {
                let part = STEPS[0] / step;
                let least = times.iter().fold(f64::MAX, |least, time| least.min(*time)) * part;
                let mut run = StudyRun::made_up(line, step, least, Some(step * step), Vec::new());
                run.times = times.iter().map(|time| time * part).collect();
                run.error_bound = bound;
                runs.push(run);
            }
        }
        (grid, runs)
    }

    fn ranks(times: [&[f64]; 3], bound: f64) -> Vec<(usize, usize)> {
        let (grid, runs) = runs(times, bound);
        cheapest(&grid, &runs, &[4e-4])[0].1.iter().map(|of| (of.line, of.rank)).collect()
    }

    #[test]
    fn times_that_overlap_are_not_ranked() {
        // From the least to the median: a 1.0 to 1.2, b 1.1 to 1.3, c 2.0 to 2.1.
        let apart: [&[f64]; 3] = [&[1.0, 1.2, 1.4], &[1.1, 1.3, 1.9], &[2.0, 2.1, 2.2]];
        assert_eq!(ranks(apart, 0.0), [(0, 1), (1, 1), (2, 3)]);
        // Repeats with little scatter distinguish the settings.
        let alike: [&[f64]; 3] = [&[1.0, 1.01, 1.02], &[1.1, 1.11, 1.12], &[0.9, 0.9, 0.91]];
        assert_eq!(ranks(alike, 0.0), [(2, 1), (0, 2), (1, 3)]);
        // Single runs say nothing below a factor of ONCE both ways.
        assert_eq!(ranks([&[1.0], &[2.0], &[2.4]], 0.0), [(0, 1), (1, 1), (2, 2)]);
    }

    #[test]
    fn errors_that_are_not_known_are_not_ranked() {
        // A bound of a quarter of the error wanted: of second order, it moves the step by an eighth or so, and so the time.
        let close: [&[f64]; 3] = [&[1.0, 1.0], &[1.05, 1.05], &[3.0, 3.0]];
        assert_eq!(ranks(close, 0.0), [(0, 1), (1, 2), (2, 3)]);
        assert_eq!(ranks(close, 1e-4), [(0, 1), (1, 1), (2, 3)]);
        let (grid, runs) = runs(close, 1e-4);
        let of = cheapest(&grid, &runs, &[4e-4])[0].1[0];
        // Wanted is 4e-4, which is reached at 0.02, 4 s. With 1e-4 more the cost is that at an error of 3e-4, on the line between (5e-4, 4
        // s) and (2e-4, 8 s) in logarithms. With 1e-4 less it lies between (15e-4, 2 s) and (3e-4, 4 s).
        let at = |above: f64, below: f64, from: f64| from * 2f64.powf((above / 4e-4).ln() / (above / below).ln());
        assert!((of.range[1] / at(5e-4, 2e-4, 4.0) - 1.0).abs() < 1e-12, "{of:?}");
        assert!((of.range[0] / at(15e-4, 3e-4, 2.0) - 1.0).abs() < 1e-12, "{of:?}");
        assert!((of.loop_s - 4.0).abs() < 1e-12 && !of.at_the_top);
    }

    #[test]
    fn a_line_that_may_not_reach_the_error_has_no_upper_end() {
        let (grid, runs) = runs([&[1.0, 1.0]; 3], 5e-5);
        let of = cheapest(&grid, &runs, &[1e-4])[0].1[0];
        // Powers are rounded.
        assert!((of.loop_s - 8.0).abs() < 1e-12 && (of.resolution - 0.01).abs() < 1e-12, "{of:?}");
        assert_eq!(of.range[1], f64::INFINITY);
        assert!(cheapest(&grid, &runs, &[1e-5])[0].1.is_empty());
    }
}
