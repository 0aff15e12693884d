//! The sum of the nodal forces of partitions and inertias, in chunks of nodes shared by several threads. Each node gets the same terms in
//! the same order whatever the chunks are.

use super::inertia::Inertia;
use super::scale::Scale;
use super::thread_partition::{Partition, both};
use mechanics::elements::Force;
use std::ops::Range;

/// Number of nodes in a chunk.
const NODES: usize = 512;

/// A range of nodes, with the contributions to their forces.
#[derive(Debug, Clone)]
pub(super) struct SumChunk {
    nodes: Range<usize>,
    /// The range of inertias, which are in ascending order of nodes.
    inertias: Range<usize>,
    /// Partitions with the ranges of these nodes on which they act.
    parts: Vec<(usize, Range<usize>)>,
}

/// The chunks of `nodes` nodes; none where there are no partitions.
pub(super) fn chunks(partitions: &[Partition], inertias: &[Inertia], nodes: usize) -> Vec<SumChunk> {
    if partitions.is_empty() {
        return Vec::new();
    }
    let chunk = |first: usize| {
        let end = (first + NODES).min(nodes);
        let of = |(part, partition): (usize, &Partition)| {
            let within = partition.nodes.iter().map(|run| run.start.max(first)..run.end.min(end));
            within.filter(|run| !run.is_empty()).map(|run| (part, run)).collect::<Vec<_>>()
        };
        SumChunk {
            nodes: first..end,
            inertias: inertias.partition_point(|i| i.node < first)..inertias.partition_point(|i| i.node < end),
            parts: partitions.iter().enumerate().flat_map(of).collect(),
        }
    };
    (0..nodes).step_by(NODES).map(chunk).collect()
}

/// Writes the forces of all partitions into `F`, whose entries are the nodes of `chunks`. Then `add` adds the forces of `inertias`: it
/// receives the inertias of a chunk, its forces and their first node.
pub(super) fn sum<A>(
    chunks: &[SumChunk],
    partitions: &[Partition],
    (inertias, add): (&[Inertia], &A),
    threads: bool,
    F: &mut [Force],
) -> Scale
where
    A: Fn(&[Inertia], (&mut [Force], usize), &mut Scale) + Sync,
{
    match chunks {
        [] => Scale::default(),
        [chunk] => {
            F.fill([0.0; 6]);
            let first = chunk.nodes.start;
            for (part, run) in &chunk.parts {
                let here = F[run.start - first..run.end - first].as_flattened_mut();
                let more = partitions[*part].F[run.clone()].as_flattened();
                here.iter_mut().zip(more).for_each(|(sum, f)| *sum += f);
            }
            let mut scale = Scale::default();
            scale.include(F);
            add(&inertias[chunk.inertias.clone()], (F, first), &mut scale);
            scale
        }
        _ => {
            let (left, right) = chunks.split_at(chunks.len() / 2);
            let (first, second) = F.split_at_mut(right[0].nodes.start - left[0].nodes.start);
            let (left, right) = both(
                threads,
                || sum(left, partitions, (inertias, add), threads, first),
                || sum(right, partitions, (inertias, add), threads, second),
            );
            left.or_larger(&right)
        }
    }
}
