//! Compares a reference with what a scheme of another family tends to.

use super::confirmation::{Confirmation, Difference};
use super::grid::StudyGrid;
use super::history;
use super::reference::{Reference, in_time};
use super::run::StudyRun;

/// Compares a reference with what lines of another family tend to. The bound of its error grows to the difference from the line
/// that was to confirm it. Lines of the grid confirm or contradict, but say no more than their own steps allow.
pub fn confirm(reference: &mut Reference, grid: &StudyGrid, runs: &[StudyRun]) {
    let (values, bound) = match &reference.in_time {
        Some((values, bound)) => (values, *bound),
        None => (&reference.values, reference.error_bound),
    };
    let lines = || grid.lines.iter().enumerate();
    let best = lines()
        .filter(|(_, line)| !line.confirms)
        .map(|(_, line)| line.rank())
        .fold([f64::MIN; 3], |a, b| if b > a { b } else { a });
    let asked = lines().any(|(_, line)| line.confirms);
    let others = lines().filter(|(_, line)| line.rank() == best && line.confirms == asked);
    let others = others.filter(|(_, line)| reference.family.is_some_and(|family| family != line.family) || asked);
    let limits = others.filter_map(|(index, line)| Some((line, in_time(grid, runs, index)?)));
    let nearest = limits.min_by(|(_, (a, _)), (_, (b, _))| a.error_bound.total_cmp(&b.error_bound));
    let Some((line, (limit, count))) = nearest else {
        if let Some((_, line)) = lines().find(|(_, line)| line.confirms) {
            reference.confirmation = Confirmation::Failed(line.label.clone());
        }
        return;
    };
    let apart = history::error(&limit.q, values, count, |_| true);
    let of = Difference { label: line.label.clone(), apart, allowed: bound + limit.error_bound };
    if asked || apart > of.allowed {
        reference.error_bound = reference.error_bound.max(apart);
    }
    reference.confirmation = match apart > of.allowed {
        true => Confirmation::Disagrees(of),
        false => Confirmation::Agrees(of),
    };
}
