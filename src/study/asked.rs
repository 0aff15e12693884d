//! Requested and reached errors of automatic steps: for each scheme the slope of reached over requested error, the largest ratio, and the
//! scatter of the ratios.

use super::grid::StudyGrid;
use super::run::{RunStatus, StudyRun};
use super::section::StudySection;
use base::names::short;

/// A run with automatic steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AskedRun {
    /// The error tolerance.
    pub asked: f64,
    /// The error; where it is not `resolved`, a bound of it.
    pub reached: f64,
    /// True if the error clearly exceeds the error of the reference.
    pub resolved: bool,
    /// The error that the run itself says it has.
    pub estimate: Option<f64>,
}

/// The automatic steps of a line.
#[derive(Debug, Clone, PartialEq)]
pub struct Asked {
    /// The index of the line in [`StudyGrid::lines`].
    pub line: usize,
    /// The runs that came to their end, the largest tolerance first.
    pub runs: Vec<AskedRun>,
    /// The slope of ln reached over ln asked, by least squares over resolved runs: 1 where errors follow the tolerance.
    pub slope: Option<f64>,
    /// The largest ratio of reached to asked, with bounds of errors for errors.
    pub largest: f64,
    /// The geometric mean of the ratios of resolved runs.
    pub mean: Option<f64>,
    /// The geometric standard deviation of these ratios: their scatter about the mean as a factor.
    pub spread: Option<f64>,
}

/// Requested and reached errors of the automatic lines of a grid.
pub fn asked(grid: &StudyGrid, runs: &[StudyRun]) -> Vec<Asked> {
    let lines = (0..grid.lines.len()).filter(|&line| grid.lines[line].automatic);
    let of = |line: usize| {
        let done = runs.iter().filter(|run| run.line == line && run.status == RunStatus::Done);
        let run = |run: &StudyRun| {
            let reached = run.error.filter(|error| *error > 0.0)?;
            Some(AskedRun { asked: run.resolution, reached, resolved: run.resolved, estimate: run.measured.estimate })
        };
        over(line, done.filter_map(run).collect())
    };
    lines.filter_map(of).collect()
}

/// The slope and the spread of runs; `None` where there are none.
fn over(line: usize, runs: Vec<AskedRun>) -> Option<Asked> {
    let largest = runs.iter().map(|run| run.reached / run.asked).reduce(f64::max)?;
    let logs: Vec<(f64, f64)> =
        runs.iter().filter(|run| run.resolved).map(|run| (run.asked.ln(), run.reached.ln())).collect();
    let n = logs.len() as f64;
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(&|p| p.0), mean(&|p| p.1));
    let wide = mean(&|p| (p.0 - x).powi(2));
    let slope = (logs.len() > 1 && wide > 0.0).then(|| mean(&|p| (p.0 - x) * (p.1 - y)) / wide);
    let scatter = mean(&|p| (p.1 - p.0 - (y - x)).powi(2)) * n / (n - 1.0);
    let spread = (logs.len() > 1).then(|| scatter.sqrt().exp());
    Some(Asked { line, runs, slope, largest, mean: (!logs.is_empty()).then(|| (y - x).exp()), spread })
}

/// The table of asked and reached errors, and a sentence on each line.
pub fn section(grid: &StudyGrid, asked: &[Asked]) -> StudySection {
    let (mut rows, mut notes) = (Vec::new(), Vec::new());
    for of in asked {
        let label = &grid.lines[of.line].label;
        for run in &of.runs {
            let bound = if run.resolved { "" } else { "<= " };
            rows.push(vec![
                label.clone(),
                short(run.asked),
                format!("{bound}{:.2e}", run.reached),
                format!("{bound}{:.2}", run.reached / run.asked),
                run.estimate.map_or(String::new(), |estimate| format!("{estimate:.2e}")),
            ]);
        }
        let slope = of.slope.map_or("no slope".to_owned(), |slope| format!("reached ~ asked^{slope:.2}"));
        let scatter = match (of.mean, of.spread) {
            (Some(mean), Some(spread)) => format!(", {mean:.2} in the mean, scattering by a factor of {spread:.2}"),
            _ => String::new(),
        };
        let resolved = of.runs.iter().filter(|run| run.resolved).count();
        notes.push(format!(
            "{label}: {slope}; reached/asked at most {:.2}{scatter} ({resolved} of {} runs resolved)",
            of.largest,
            of.runs.len()
        ));
    }
    let head = vec!["setting", "asked", "reached", "reached/asked", "estimated by the run"];
    StudySection { title: "Asked and reached", head, rows, notes }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn runs(of: impl Fn(f64) -> f64) -> Vec<AskedRun> {
        let run = |k: i32| {
            let asked = 10f64.powf(-0.25 * f64::from(k));
            AskedRun { asked, reached: of(asked), resolved: true, estimate: None }
        };
        (4..=16).map(run).collect()
    }

    #[test]
    fn a_power_law_has_its_slope_and_no_more_spread_than_it_makes() {
        // Errors that follow the tolerance: all ratios are 0.4.
        let even = over(0, runs(|asked| 0.4 * asked)).unwrap();
        let near = |found: Option<f64>, expected: f64| (found.unwrap() / expected - 1.0).abs() < 1e-10;
        assert!(near(even.slope, 1.0) && near(even.mean, 0.4) && near(even.spread, 1.0), "{even:?}");
        assert!((even.largest - 0.4).abs() < 1e-12);
        // Errors that fall with the square root: the ratio grows from 1 at 1e-1 to 10^1.5 at 1e-4; ln of it steps by ln(10)/8.
        let slow = over(0, runs(|asked| (0.1 * asked).sqrt())).unwrap();
        let variance = (0..13).map(|k| ((f64::from(k) - 6.0) * 10f64.ln() / 8.0).powi(2)).sum::<f64>() / 12.0;
        assert!(near(slow.slope, 0.5) && near(slow.spread, variance.sqrt().exp()), "{slow:?}");
        assert!((slow.largest / 10f64.powf(1.5) - 1.0).abs() < 1e-10, "{slow:?}");
    }

    #[test]
    fn bounds_count_for_the_largest_ratio_alone() {
        let mut some = runs(|asked| asked);
        some[12] = AskedRun { reached: 7.0 * some[12].asked, resolved: false, ..some[12] };
        let found = over(0, some).unwrap();
        assert!((found.largest - 7.0).abs() < 1e-12 && (found.spread.unwrap() - 1.0).abs() < 1e-12, "{found:?}");
        assert_eq!(over(0, Vec::new()), None);
        let one = over(0, runs(|asked| asked)[..1].to_vec()).unwrap();
        assert!(one.slope.is_none() && one.spread.is_none() && one.mean.is_some());
    }
}
