//! Partition of large scenes into groups of elements that several threads compute. The partition rests on the scene
//! alone and sums keep their order, so results do not depend on the number of threads.

use super::group::Group;
use mechanics::elements::Force;
use mechanics::materials::Dissipation;
use mechanics::state::Configuration;
use std::ops::{AddAssign, Range};

/// Largest number of elements in a group.
pub(super) const MOST_IN_GROUP: usize = 512;
/// Least number of elements for several threads.
const WORTH_THREADS: usize = 1024;
/// Largest number of partitions; each needs its own array of forces.
const MOST_PARTITIONS: usize = 16;

/// Groups whose forces are summed in a separate array.
#[derive(Debug, Clone)]
pub struct Partition {
    groups: Range<usize>,
    /// The ranges of nodes on which they act.
    pub(super) nodes: Vec<Range<usize>>,
    /// Forces by node. [`run_partitions`] writes them.
    pub(super) F: Vec<Force>,
}

/// True where the elements are many enough for several threads.
pub(super) fn is_large(groups: &[Group]) -> bool {
    groups.iter().map(|group| group.block.len()).sum::<usize>() >= WORTH_THREADS
}

/// Partitions the groups of a large scene; a small scene has none.
pub(super) fn partition(groups: &[Group]) -> Vec<Partition> {
    if !is_large(groups) {
        return Vec::new();
    }
    let count = groups.len().min(MOST_PARTITIONS);
    let bound = |k: usize| k * groups.len() / count;
    (0..count).map(|k| part(groups, bound(k)..bound(k + 1))).collect()
}

fn part(all: &[Group], groups: Range<usize>) -> Partition {
    let of = |group: &Group| {
        let own = (0..group.block.len()).flat_map(|e| group.block.nodes(e));
        own.chain(group.further_nodes()[0]).copied().collect::<Vec<_>>()
    };
    let mut touched: Vec<usize> = all[groups.clone()].iter().flat_map(of).collect();
    touched.sort_unstable();
    touched.dedup();
    let nodes = touched.chunk_by(|a, b| a + 1 == *b).map(|run| run[0]..run[run.len() - 1] + 1).collect();
    Partition { groups, nodes, F: vec![[0.0; 6]; touched.last().map_or(0, |last| last + 1)] }
}

/// The memory for the history variables of a contiguous range of groups, and for the dissipation of each group.
pub(super) struct GroupMemory<'a> {
    /// History variables of these groups.
    pub history: &'a mut [f64],
    /// Dissipation by group.
    pub spent: &'a mut [Dissipation],
}

impl GroupMemory<'_> {
    /// The memories of the groups before the one at `middle` and of the others.
    fn split(self, groups: &[Group], middle: usize) -> [Self; 2] {
        let at = groups[middle].history.start - groups[0].history.start;
        let (history, spent) = (self.history.split_at_mut(at), self.spent.split_at_mut(middle));
        [GroupMemory { history: history.0, spent: spent.0 }, GroupMemory { history: history.1, spent: spent.1 }]
    }
}

/// Subtracts the internal forces of groups from `F`, and writes their history where there is a memory.
pub(super) fn run(groups: &[Group], now: &Configuration, memory: Option<GroupMemory>, F: &mut [Force]) {
    let Some(GroupMemory { mut history, spent }) = memory else {
        return groups.iter().for_each(|group| group.block.subtract_forces(&group.configuration(now), F));
    };
    for (group, spent) in groups.iter().zip(spent) {
        let (own, rest) = history.split_at_mut(group.history.len());
        history = rest;
        let now = group.configuration(now);
        if own.is_empty() {
            group.block.subtract_forces(&now, F);
            *spent = Dissipation::default();
        } else {
            *spent = group.block.advance(&now, F, own);
        }
    }
}

/// Writes the forces of partitions, which belong to `groups`, and their history.
pub(super) fn run_partitions(
    parts: &mut [Partition],
    groups: &[Group],
    now: &Configuration,
    memory: Option<GroupMemory>,
    threads: bool,
) {
    match parts {
        [] => {}
        [part] => {
            part.nodes.iter().for_each(|run| part.F[run.clone()].fill([0.0; 6]));
            run(groups, now, memory, &mut part.F);
        }
        _ => {
            let (left, right) = parts.split_at_mut(parts.len() / 2);
            let middle = right[0].groups.start - left[0].groups.start;
            let (first, second) = groups.split_at(middle);
            let [a, b] = match memory.map(|memory| memory.split(groups, middle)) {
                Some(halves) => halves.map(Some),
                None => [None, None],
            };
            both(
                threads,
                || run_partitions(left, first, now, a, threads),
                || run_partitions(right, second, now, b, threads),
            );
        }
    }
}

/// Sums the dissipation of groups in the order of [`sum`].
pub(super) fn sum_spent(spent: &[Dissipation]) -> Dissipation {
    match spent {
        [] => Dissipation::default(),
        [one] => *one,
        _ => {
            let (left, right) = spent.split_at(spent.len() / 2);
            let mut sum = sum_spent(left);
            sum += sum_spent(right);
            sum
        }
    }
}

/// Sums over groups by recursive halving, which keeps the order of additions for any number of threads.
pub(super) fn sum<T>(groups: &[Group], threads: bool, of: &(impl Fn(&Group) -> T + Sync)) -> T
where
    T: Default + AddAssign + Send,
{
    match groups {
        [] => T::default(),
        [group] => of(group),
        _ => {
            let (left, right) = groups.split_at(groups.len() / 2);
            let (mut sum, right) = both(threads, || sum(left, threads, of), || sum(right, threads, of));
            sum += right;
            sum
        }
    }
}

/// Sums over groups like [`sum`]; `of` also receives the group's range of `history`, which covers all `groups`.
pub(super) fn sum_with<T>(
    groups: &[Group],
    history: &mut [f64],
    threads: bool,
    of: &(impl Fn(&Group, &mut [f64]) -> T + Sync),
) -> T
where
    T: Default + AddAssign + Send,
{
    match groups {
        [] => T::default(),
        [group] => of(group, history),
        _ => {
            let (left, right) = groups.split_at(groups.len() / 2);
            let (of_left, of_right) = history.split_at_mut(right[0].history.start - left[0].history.start);
            let (mut sum, right) =
                both(threads, || sum_with(left, of_left, threads, of), || sum_with(right, of_right, threads, of));
            sum += right;
            sum
        }
    }
}

pub(super) fn both<A: Send, B: Send>(
    threads: bool,
    a: impl FnOnce() -> A + Send,
    b: impl FnOnce() -> B + Send,
) -> (A, B) {
    if threads { rayon::join(a, b) } else { (a(), b()) }
}
