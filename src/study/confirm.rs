//! Compares a reference with the limit of a scheme of another family.

use super::confirmation::{Confirmation, Difference};
use super::grid::StudyGrid;
use super::history;
use super::reference::{Reference, in_time};
use super::run::StudyRun;

/// Compares a reference with what lines of another family tend to. They confirm or contradict it: where the two are farther apart than
/// both bounds allow, the bound of the reference grows to their difference.
pub fn confirm(reference: &mut Reference, grid: &StudyGrid, runs: &[StudyRun]) {
    let (Some(family), Some((values, bound))) = (reference.family, &reference.in_time) else { return };
    let best = grid.lines.iter().map(|line| line.rank()).fold([f64::MIN; 3], |a, b| if b > a { b } else { a });
    let others = grid.lines.iter().enumerate().filter(|(_, line)| line.rank() == best && line.family != family);
    let limits = others.filter_map(|(index, line)| Some((line, in_time(grid, runs, index)?)));
    let nearest = limits.min_by(|(_, (a, _)), (_, (b, _))| a.error_bound.total_cmp(&b.error_bound));
    let Some((line, (limit, count))) = nearest else { return };
    let apart = history::error(&limit.q, values, count, |_| true);
    let of = Difference { label: line.label.clone(), apart, allowed: bound + limit.error_bound };
    reference.confirmation = match apart > of.allowed {
        true => {
            reference.error_bound = reference.error_bound.max(apart);
            Confirmation::Disagrees(of)
        }
        false => Confirmation::Agrees(of),
    };
}

#[cfg(test)]
mod tests {
    use super::super::family::Family;
    use super::super::lines::StudyLine;
    use super::super::reference::extrapolate;
    use super::*;

    /// The confirmation between two families with errors of second order, whose limits differ by a factor.
    fn confirmed(factor: f64) -> Reference {
        let other = StudyLine { family: Family::Composite, scheme: "bathe".to_owned(), ..StudyLine::plain("bathe") };
        let steps = vec![0.04, 0.02, 0.01];
        let grid = StudyGrid::of_steps(vec![StudyLine::plain("newmark"), other], steps.clone(), 1.0, 25);
        let run = |line: usize, dt: f64| {
            let size = if line == 0 { 1.0 } else { factor } * (1.0 + dt * dt);
            let history = (0..=25).map(|k| size * (0.2 * f64::from(k)).sin()).collect();
            let mut run = StudyRun::made_up(line, dt, 1.0, None, history);
            run.measured.steps = (1.0 / dt).round() as u64;
            run
        };
        let runs: Vec<StudyRun> =
            [0, 1].into_iter().flat_map(|line| steps.iter().map(move |&dt| run(line, dt))).collect();
        let mut reference = extrapolate(&grid, &runs, &[]).unwrap();
        confirm(&mut reference, &grid, &runs);
        reference
    }

    #[test]
    fn another_family_confirms_or_contradicts() {
        assert!(matches!(confirmed(1.0).confirmation, Confirmation::Agrees(_)));
        let reference = confirmed(1.01);
        let Confirmation::Disagrees(of) = &reference.confirmation else { panic!("{:?}", reference.confirmation) };
        // A hundredth of a vibration of this root mean square, and the bound holds it.
        let square = (0..=25).map(|k| (0.2 * f64::from(k)).sin().powi(2)).sum::<f64>() / 26.0;
        assert!((of.apart / (0.01 * square.sqrt()) - 1.0).abs() < 0.05 && reference.error_bound >= of.apart, "{of:?}");
    }
}
