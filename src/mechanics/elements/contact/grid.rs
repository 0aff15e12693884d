//! A uniform grid of boxes in plain arrays: it finds the boxes near a box in a time proportional to their number.

use base::math::Vec3;

/// Number of cells above which a box is looked at in every query.
const MOST_CELLS: f64 = 512.0;

/// A box along the global axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct GridBox {
    /// Least coordinates.
    pub low: Vec3,
    /// Largest coordinates.
    pub high: Vec3,
}

impl GridBox {
    /// The box around some points.
    pub fn around(points: impl Iterator<Item = Vec3>) -> GridBox {
        let nothing = GridBox { low: Vec3::repeat(f64::INFINITY), high: Vec3::repeat(f64::NEG_INFINITY) };
        points.fold(nothing, |all, x| GridBox { low: all.low.inf(&x), high: all.high.sup(&x) })
    }

    /// The box with a margin.
    pub fn wider(&self, by: f64) -> GridBox {
        GridBox { low: self.low.add_scalar(-by), high: self.high.add_scalar(by) }
    }

    fn meets(&self, other: &GridBox) -> bool {
        (0..3).all(|i| self.low[i] <= other.high[i] && other.low[i] <= self.high[i])
    }
}

/// Boxes, sorted into cells of equal size. Cells share buckets by a hash, so that memory grows with the boxes alone.
#[derive(Debug, Default)]
pub(super) struct BoxGrid {
    size: f64,
    boxes: Vec<GridBox>,
    /// The start of each bucket in `entries`, and the end of the last.
    starts: Vec<u32>,
    entries: Vec<u32>,
    /// Boxes that span too many cells.
    large: Vec<u32>,
}

impl BoxGrid {
    /// Sorts these boxes anew into cells of this size. Allocates where they have become more alone.
    pub fn rebuild(&mut self, size: f64, boxes: impl Iterator<Item = GridBox>) {
        self.size = size;
        self.boxes.clear();
        self.boxes.extend(boxes);
        self.large.clear();
        let buckets = (2 * self.boxes.len()).next_power_of_two().max(16);
        self.starts.clear();
        self.starts.resize(buckets + 1, 0);
        for (id, extent) in self.boxes.iter().enumerate() {
            match cells(self.size, extent) {
                Some(cells) => cells.for_each(|cell| self.starts[bucket(cell, buckets) + 1] += 1),
                None => self.large.push(id as u32),
            }
        }
        for k in 0..buckets {
            self.starts[k + 1] += self.starts[k];
        }
        self.entries.clear();
        self.entries.resize(self.starts[buckets] as usize, 0);
        // Filled from behind, so that the starts end as starts.
        for (id, extent) in self.boxes.iter().enumerate().rev() {
            for cell in cells(self.size, extent).into_iter().flatten() {
                let end = &mut self.starts[bucket(cell, buckets) + 1];
                *end -= 1;
                self.entries[*end as usize] = id as u32;
            }
        }
        // Each end has become the start of its bucket: they move one down.
        self.starts.rotate_left(1);
        self.starts[buckets] = self.entries.len() as u32;
    }

    /// Adds the numbers of all boxes that meet a box to a list, in ascending order, each once.
    pub fn query(&self, extent: &GridBox, found: &mut Vec<u32>) {
        let from = found.len();
        let meets = |id: &u32| self.boxes[*id as usize].meets(extent);
        match cells(self.size, extent) {
            Some(cells) => {
                found.extend(self.large.iter().copied().filter(|id| meets(id)));
                let buckets = self.starts.len() - 1;
                for cell in cells {
                    let k = bucket(cell, buckets);
                    let own = &self.entries[self.starts[k] as usize..self.starts[k + 1] as usize];
                    found.extend(own.iter().copied().filter(|id| meets(id)));
                }
            }
            None => found.extend((0..self.boxes.len() as u32).filter(|id| meets(id))),
        }
        found[from..].sort_unstable();
        let mut kept = from;
        for k in from..found.len() {
            if kept == from || found[kept - 1] != found[k] {
                found[kept] = found[k];
                kept += 1;
            }
        }
        found.truncate(kept);
    }
}

/// The cells that a box meets; `None` above [`MOST_CELLS`].
fn cells(size: f64, extent: &GridBox) -> Option<impl Iterator<Item = [i64; 3]>> {
    let low = extent.low.map(|x| (x / size).floor());
    let high = extent.high.map(|x| (x / size).floor());
    let count: f64 = (high - low).add_scalar(1.0).product();
    if count > MOST_CELLS || count.is_nan() {
        return None;
    }
    let [from, to] = [low, high].map(|x| [x.x as i64, x.y as i64, x.z as i64]);
    let rows = move |i: i64| (from[1]..=to[1]).flat_map(move |j| (from[2]..=to[2]).map(move |k| [i, j, k]));
    Some((from[0]..=to[0]).flat_map(rows))
}

/// The bucket of a cell; `buckets` is a power of two.
fn bucket([i, j, k]: [i64; 3], buckets: usize) -> usize {
    let mut hash = (i as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    hash = (hash.rotate_left(23) ^ j as u64).wrapping_mul(0xC2B2_AE3D_27D4_EB4F);
    hash = (hash.rotate_left(23) ^ k as u64).wrapping_mul(0x1656_67B1_9E37_79F9);
    (hash ^ (hash >> 29)) as usize & (buckets - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::rngs::StdRng;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn no_box_is_missed() {
        let mut rng = StdRng::seed_from_u64(3);
        let mut grid = BoxGrid::default();
        let mut found = Vec::new();
        for round in 0..20 {
            let mut boxes = Vec::new();
            for _ in 0..(10 + 30 * round) {
                let x = Vec3::from_fn(|_, _| rng.random_range(-5.0..5.0));
                let most = if rng.random_range(0..20) == 0 { 6.0 } else { 0.4 };
                let half = Vec3::from_fn(|_, _| rng.random_range(0.0..most));
                boxes.push(GridBox { low: x - half, high: x + half });
            }
            grid.rebuild(0.5, boxes.iter().copied());
            for k in 0..boxes.len() {
                found.clear();
                grid.query(&boxes[k], &mut found);
                let all: Vec<u32> = (0..boxes.len()).filter(|&j| boxes[j].meets(&boxes[k])).map(|j| j as u32).collect();
                assert_eq!(found, all);
            }
        }
    }
}
