//! Points in cubic cells of space: those near a place are found without looking at all.

use base::math::Vec3;
use std::collections::HashMap;

/// Points sorted by grid cell.
pub struct Cells {
    size: f64,
    origin: Vec3,
    points: HashMap<[i64; 3], Vec<usize>>,
}

impl Cells {
    /// Cells of this size, above 0, with numbered points.
    pub fn new(size: f64, origin: Vec3, points: impl Iterator<Item = (usize, Vec3)>) -> Self {
        let mut cells = Cells { size, origin, points: HashMap::new() };
        for (point, x) in points {
            cells.points.entry(cells.cell(&x)).or_default().push(point);
        }
        cells
    }

    fn cell(&self, x: &Vec3) -> [i64; 3] {
        ((x - self.origin) / self.size).map(f64::floor).map(|i| i as i64).into()
    }

    /// Calls `visit` with the points of all cells that a box meets.
    pub fn visit_box(&self, low: &Vec3, high: &Vec3, visit: &mut impl FnMut(usize)) {
        let (low, high) = (self.cell(low), self.cell(high));
        for i in low[0]..=high[0] {
            for j in low[1]..=high[1] {
                for k in low[2]..=high[2] {
                    self.points.get(&[i, j, k]).into_iter().flatten().for_each(|&point| visit(point));
                }
            }
        }
    }

    /// Calls `visit` with points that may lie within `reach` of a segment or a face of three or four corners, some of them more than once.
    /// Large ones are cut first, so that their boxes hold few cells.
    pub fn visit_along(&self, corners: &[Vec3], reach: f64, visit: &mut impl FnMut(usize)) {
        if self.visit_if_small(corners, reach, visit) {
            return;
        }
        match corners {
            [a, b, c, d] => [[*a, *b, *c], [*a, *c, *d]].iter().for_each(|half| self.visit_halves(half, reach, visit)),
            _ => self.visit_halves(corners, reach, visit),
        }
    }

    /// Halves a segment or triangle at the middle of its longest side until its pieces are small.
    fn visit_halves(&self, corners: &[Vec3], reach: f64, visit: &mut impl FnMut(usize)) {
        /// Number of halvings that reduces any length to rounding.
        const HALVINGS: usize = 60;
        let mut pieces = vec![(corners.to_vec(), 0)];
        while let Some((corners, halvings)) = pieces.pop() {
            if self.visit_if_small(&corners, reach, visit) || halvings == HALVINGS {
                continue;
            }
            let n = corners.len();
            let sides = (0..n).flat_map(|a| (a + 1..n).map(move |b| (a, b)));
            let length = |&(a, b): &(usize, usize)| (corners[a] - corners[b]).norm();
            let Some((a, b)) = sides.max_by(|p, q| length(p).total_cmp(&length(q))) else { continue };
            let middle = 0.5 * (corners[a] + corners[b]);
            for end in [a, b] {
                let mut half = corners.clone();
                half[end] = middle;
                pieces.push((half, halvings + 1));
            }
        }
    }

    /// Visits the box of corners where it holds few cells, and tells whether it does.
    fn visit_if_small(&self, corners: &[Vec3], reach: f64, visit: &mut impl FnMut(usize)) -> bool {
        /// Cells along an axis.
        const CELLS: f64 = 3.0;
        let (mut low, mut high) = (corners[0], corners[0]);
        corners.iter().for_each(|x| (low, high) = (low.inf(x), high.sup(x)));
        let small = (high - low).amax() <= CELLS * self.size;
        if small {
            let margin = Vec3::repeat(reach);
            self.visit_box(&(low - margin), &(high + margin), visit);
        }
        small
    }
}
