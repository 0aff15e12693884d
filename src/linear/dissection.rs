//! Nested dissection by coordinates: each part is cut across the axis with the smallest separator. The separator is the set of groups of
//! one side that couple with the other, and is eliminated last. On nets of shells, and meshes that fill space, this is close to graph
//! partitioning at a hundredth of its time; on frames minimum degree is better. A. George, SIAM J. Numer. Anal. 10 (1973).

use super::graph::Graph;

/// Parts of so few groups are not cut: minimum degree would not order them better by much.
const SMALLEST: usize = 12;
/// A cut may leave this part of the groups on its smaller side, where it can follow a gap between coordinates.
const BALANCE: f64 = 0.4;

/// The order of all groups, multipliers last.
pub(super) fn dissect(graph: &Graph, positions: &[[f64; 3]]) -> Vec<usize> {
    let placed = graph.groups() - graph.multipliers;
    let mut groups: Vec<usize> = (0..placed).collect();
    let mut order = vec![usize::MAX; placed];
    // Current part of each group.
    let mut part = vec![0; placed];
    let mut parts = vec![(0, placed)];
    let mut next = 1;
    while let Some((begin, end)) = parts.pop() {
        let own = &mut groups[begin..end];
        if own.len() <= SMALLEST {
            order[begin..end].copy_from_slice(own);
            continue;
        }
        let sides = [next, next + 1];
        next += 2;
        let (left, right) = cut(graph, positions, own, &mut part, sides);
        // The separator comes last.
        order[begin + left + right..end].copy_from_slice(&own[left + right..]);
        parts.push((begin, begin + left));
        parts.push((begin + left, begin + left + right));
    }
    order.extend(placed..graph.groups());
    order
}

/// Sorts groups into two parts and what separates them; returns the sizes of the parts. The groups of the parts are marked as members of
/// `sides`.
fn cut(
    graph: &Graph,
    positions: &[[f64; 3]],
    groups: &mut [usize],
    part: &mut [usize],
    sides: [usize; 2],
) -> (usize, usize) {
    let whole = part[groups[0]];
    let mut best = (usize::MAX, 0, 0);
    for axis in long_axes(groups, positions) {
        sort(groups, positions, axis);
        let at = middle(groups, positions, axis);
        groups[at..].iter().for_each(|&g| part[g] = sides[1]);
        let across = groups[..at].iter().filter(|&&g| couples(graph, g, part, sides[1])).count();
        groups[at..].iter().for_each(|&g| part[g] = whole);
        best = best.min((across, axis, at));
    }
    let (across, axis, at) = best;
    sort(groups, positions, axis);
    groups[at..].iter().for_each(|&g| part[g] = sides[1]);
    // The separator goes behind both parts, all in the order of the axis.
    let (separator, mut sorted): (Vec<usize>, Vec<usize>) =
        groups[..at].iter().partition(|&&g| couples(graph, g, part, sides[1]));
    sorted.iter().for_each(|&g| part[g] = sides[0]);
    separator.iter().for_each(|&g| part[g] = usize::MAX);
    sorted.extend(&groups[at..]);
    sorted.extend(&separator);
    groups.copy_from_slice(&sorted);
    (at - across, groups.len() - at)
}

/// The axes along which a part is at least half as long as along its longest.
fn long_axes(groups: &[usize], positions: &[[f64; 3]]) -> impl Iterator<Item = usize> + use<> {
    let length = [0, 1, 2].map(|axis| {
        let ends =
            groups.iter().map(|&g| positions[g][axis]).fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
        ends.1 - ends.0
    });
    let longest = length.iter().copied().fold(0.0, f64::max);
    (0..3).filter(move |&axis| length[axis] >= 0.5 * longest)
}

fn sort(groups: &mut [usize], positions: &[[f64; 3]], axis: usize) {
    let key = |g: usize| (positions[g][axis], g);
    groups.sort_unstable_by(|&g, &h| key(g).0.total_cmp(&key(h).0).then(g.cmp(&h)));
}

/// Cut position of sorted groups: the widest gap near the middle, which follows a row of nodes.
fn middle(groups: &[usize], positions: &[[f64; 3]], axis: usize) -> usize {
    let count = groups.len();
    let half = count / 2;
    let reach = half - ((BALANCE * count as f64) as usize).clamp(1, half);
    let gap = |at: usize| positions[groups[at]][axis] - positions[groups[at - 1]][axis];
    let widest = (half - reach..=half + reach).map(gap).fold(0.0, f64::max);
    let near = |at: &usize| at.abs_diff(half);
    (half - reach..=half + reach).filter(|&at| gap(at) >= 0.5 * widest).min_by_key(near).unwrap_or(half)
}

fn couples(graph: &Graph, g: usize, part: &[usize], with: usize) -> bool {
    graph.neighbours(g).iter().any(|&h| part.get(h as usize) == Some(&with))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::Structure;

    /// A net of quadrilaterals: every group comes once, and separators are straight lines, the last of them across the middle.
    #[test]
    fn a_square_net_is_cut_along_its_lines() {
        const N: usize = 33;
        let number = |x: usize, y: usize| x * N + y;
        let corners = |x: usize, y: usize| vec![number(x, y), number(x + 1, y), number(x, y + 1), number(x + 1, y + 1)];
        let cells = (0..N - 1).flat_map(|x| (0..N - 1).map(move |y| (x, y)));
        let structure = Structure {
            sizes: vec![6; N * N],
            connectivity: cells.map(|(x, y)| corners(x, y)).collect(),
            multipliers: 0,
            positions: (0..N * N).map(|g| [(g / N) as f64, (g % N) as f64, 0.0]).collect(),
        };
        let graph = Graph::new(&structure);
        let order = dissect(&graph, &graph.positions);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert!(sorted.iter().copied().eq(0..N * N));
        let last = &order[N * N - N..];
        assert!(last.iter().all(|&g| g / N == last[0] / N) && (12..20).contains(&(last[0] / N)), "{last:?}");
    }
}
