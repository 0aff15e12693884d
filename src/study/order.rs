//! The order of a line of runs, where it has one.

use super::grid::StudyGrid;
use super::run::{RunStatus, StudyRun};

/// Local orders that differ by no more than this are of one slope.
const SLOPE: f64 = 0.3;
/// A local order below this is no convergence to speak of.
const LEAST: f64 = 0.4;

/// The order of a line over the time steps of its steady slope.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Order {
    /// The slope of log error against log time step (or log tolerance), by least squares.
    pub order: f64,
    /// The number of runs that it is fitted to.
    pub runs: usize,
    /// The longest time step (or largest tolerance) of these runs.
    pub from: f64,
    /// The shortest time step (or least tolerance) of these runs.
    pub to: f64,
    /// The error below which shorter steps gain little, if the line reaches it.
    pub floor: Option<f64>,
}

/// The order of each line; or in words why it has none.
pub fn orders(grid: &StudyGrid, runs: &[StudyRun]) -> Vec<Result<Order, &'static str>> {
    let of = |line| {
        let of_line: Vec<&StudyRun> = runs.iter().filter(|run| run.line == line).collect();
        over(grid.resolutions(line), &of_line)
    };
    (0..grid.lines.len()).map(of).collect()
}

/// The order over settings next to each other: one that failed, or was not come to, parts the line.
fn over(resolutions: &[f64], runs: &[&StudyRun]) -> Result<Order, &'static str> {
    let run = |resolution: &f64| runs.iter().find(|run| run.resolution == *resolution && run.status == RunStatus::Done);
    // Only errors well above that of the reference are known well enough.
    let point = |resolution: &f64| {
        let run = run(resolution).filter(|run| run.resolved)?;
        Some((run.resolution.ln(), run.error.filter(|error| *error > 0.0)?.ln()))
    };
    let points: Vec<Option<(f64, f64)>> = resolutions.iter().map(point).collect();
    // Of the longest stretches without a gap the last counts, since it has the finer steps.
    let stretches = points.split(Option::is_none).map(|of| of.iter().copied().flatten().collect::<Vec<_>>());
    let best = stretches.filter_map(|points| order(&points)).max_by_key(|order| order.runs);
    let in_a_row = || resolutions.windows(2).any(|pair| pair.iter().all(|resolution| run(resolution).is_some()));
    best.ok_or_else(|| match resolutions.iter().all(|resolution| run(resolution).is_some()) || in_a_row() {
        true => "no steady order",
        false => "no order: no two settings next to each other came to their end",
    })
}

/// The order of points (ln h, ln e), h falling; `None` where no two neighbours have one slope.
fn order(points: &[(f64, f64)]) -> Option<Order> {
    let slopes: Vec<f64> = points.windows(2).map(|pair| (pair[0].1 - pair[1].1) / (pair[0].0 - pair[1].0)).collect();
    // The longest stretch of steady slope is looked for; of stretches of one length, the one with the finer steps.
    let mut best: Option<(usize, usize)> = None;
    for first in 0..slopes.len() {
        let mut last = first;
        let steady = |last: usize| {
            let part = &slopes[first..=last];
            let (low, high) = part.iter().fold((f64::MAX, f64::MIN), |(l, h), s| (l.min(*s), h.max(*s)));
            low >= LEAST && high - low <= SLOPE
        };
        while last < slopes.len() && steady(last) {
            last += 1;
        }
        if last > first && best.is_none_or(|(from, to)| last - first >= to - from) {
            best = Some((first, last));
        }
    }
    let (first, last) = best?;
    let used = &points[first..=last];
    let slope = slope(used);
    // Slopes that fall to less than half come from something else than the step.
    let floor = slopes[last..].iter().all(|s| *s < 0.5 * slope) && last < slopes.len();
    let errors = points[last..].iter().map(|point| point.1.exp());
    let floor = floor.then(|| errors.fold(f64::MAX, f64::min));
    let step = |point: Option<&(f64, f64)>| point.map_or(f64::NAN, |point| point.0.exp());
    Some(Order { order: slope, runs: used.len(), from: step(used.first()), to: step(used.last()), floor })
}

/// The slope of the straight line through points, by least squares.
fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(&|p| p.0), mean(&|p| p.1));
    mean(&|p| (p.0 - x) * (p.1 - y)) / mean(&|p| (p.0 - x).powi(2))
}

/// The order between a run and the one before it on its line.
pub fn local(before: Option<&StudyRun>, run: &StudyRun) -> Option<f64> {
    let before = before.filter(|before| before.resolved && run.resolved)?;
    let (above, below) = (before.error?, run.error?);
    let order = (above / below).ln() / (before.resolution / run.resolution).ln();
    order.is_finite().then_some(order)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(errors: &[f64]) -> Vec<(f64, f64)> {
        errors.iter().enumerate().map(|(k, e)| (0.5_f64.powi(k as i32).ln(), e.ln())).collect()
    }

    #[test]
    fn the_order_is_that_of_the_steady_slope() {
        let exact: Vec<f64> = (0..5).map(|k| 0.25_f64.powi(k)).collect();
        let found = order(&line(&exact)).unwrap();
        assert!((found.order - 2.0).abs() < 1e-12 && found.runs == 5 && found.floor.is_none(), "{found:?}");
        // The first steps are too coarse, and the last come to a floor.
        let bent = [1.0, 0.9, 0.25, 0.0625, 0.0156, 0.012, 0.0119];
        let found = order(&line(&bent)).unwrap();
        assert!((found.order - 2.0).abs() < 0.08 && found.runs == 4, "{found:?}");
        assert_eq!((found.from, found.to), (0.5, 0.0625));
        assert!((found.floor.unwrap() - 0.0119).abs() < 1e-9);
        assert_eq!(order(&line(&[1.0, 1.1, 0.95])), None);
        assert_eq!(order(&line(&[1.0])), None);
    }

    #[test]
    fn settings_that_failed_part_a_line() {
        let resolutions = [0.08, 0.04, 0.02, 0.01, 0.005];
        let run = |resolution: f64, status| StudyRun {
            status,
            resolved: status == RunStatus::Done,
            ..StudyRun::made_up(
                0,
                resolution,
                1.0,
                (status == RunStatus::Done).then_some(resolution * resolution),
                Vec::new(),
            )
        };
        let of = |words: &str| {
            let status = |word| if word == 'd' { RunStatus::Done } else { RunStatus::NotConverged };
            // Settings behind the last word were never run.
            let runs: Vec<StudyRun> = resolutions
                .iter()
                .zip(words.chars())
                .map(|(&resolution, word)| run(resolution, status(word)))
                .collect();
            over(&resolutions, &runs.iter().collect::<Vec<_>>()).map(|order| (order.runs, order.from, order.to))
        };
        let (near, exact) = (|a: f64, b: f64| (a / b - 1.0).abs() < 1e-12, of("ddddd").unwrap());
        assert!(exact.0 == 5 && near(exact.1, 0.08) && near(exact.2, 0.005), "{exact:?}");
        // Errors of the first and the third setting say nothing about the errors between them.
        let none = Err("no order: no two settings next to each other came to their end");
        assert_eq!([of("dndnd"), of("d"), of("nndn"), of("")], [none; 4]);
        let parted = of("ddndd").unwrap();
        assert!(parted.0 == 2 && near(parted.1, 0.01) && near(parted.2, 0.005), "{parted:?}");
        let cut = of("ddd").unwrap();
        assert!(cut.0 == 3 && near(cut.2, 0.02), "{cut:?}");
    }
}
