//! Outlines and holes of the polygons of a section: one list of corners, rings of them, and what is wrong with them.
//!
//! Corners closer than [`SAME`] are one, and a corner that lies on an edge of another ring becomes a corner of that ring. After that, two
//! edges cross or have nothing but ends in common. A polygon lies left of its edges, outlines being counter-clockwise and holes clockwise.

use base::names::short;
use std::collections::{BTreeMap, BTreeSet};

/// Distance of corners that are one, over the size of the section: coordinates have six digits or more.
const SAME: f64 = 1e-6;

/// Largest number of corners; edges are compared with each other.
const MOST_CORNERS: usize = 5000;

/// A ring of corners, by their numbers.
pub(super) type Ring = Vec<usize>;

/// A polygon of the deck.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PolygonPoints {
    /// The outline, then the holes.
    pub rings: Vec<Vec<[f64; 2]>>,
}

/// The polygons of a section with corners in common.
#[derive(Debug)]
pub(super) struct Outlines {
    /// All corners.
    pub corners: Vec<[f64; 2]>,
    /// For each polygon its outline, then its holes.
    pub rings: Vec<Vec<Ring>>,
}

/// What is wrong with a polygon, by its number from 0, and what to do.
#[derive(Debug)]
pub(super) struct OutlineFault {
    /// The polygon.
    pub polygon: usize,
    /// What is wrong, after "polygon 2 ".
    pub message: String,
    /// What to change.
    pub hint: &'static str,
}

/// Returns a fault, for `return fault(…)`.
fn fault<T>(polygon: usize, message: impl Into<String>, hint: &'static str) -> Result<T, OutlineFault> {
    Err(OutlineFault { polygon, message: message.into(), hint })
}

impl Outlines {
    /// Joins the corners of polygons and checks them.
    ///
    /// # Errors
    /// An outline without area or that crosses itself, a hole outside of its outline, polygons that overlap.
    pub fn new(polygons: &[PolygonPoints]) -> Result<Outlines, OutlineFault> {
        let rings = || polygons.iter().flat_map(|polygon| &polygon.rings);
        if let Some(polygon) = polygons.iter().position(|polygon| polygon.rings.iter().any(|ring| ring.len() < 3)) {
            return fault(polygon, "has an outline or a hole of less than three corners", "give three corners or more");
        }
        if rings().map(Vec::len).sum::<usize>() > MOST_CORNERS {
            let message = format!("and the others have more than {MOST_CORNERS} corners");
            return fault(0, message, "leave out corners: straight edges between fewer of them are as good");
        }
        let size = size(rings().flatten());
        let mut outlines = Outlines { corners: Vec::new(), rings: Vec::new() };
        for polygon in polygons {
            let numbered = polygon.rings.iter().map(|ring| outlines.number(ring, SAME * size)).collect();
            outlines.rings.push(numbered);
        }
        outlines.split_edges(SAME * size);
        for polygon in 0..outlines.rings.len() {
            outlines.check_rings(polygon, size)?;
        }
        outlines.check_crossings()?;
        outlines.check_sides()?;
        outlines.check_holes()?;
        outlines.check_overlaps()?;
        Ok(outlines)
    }

    /// The numbers of the corners of a ring; a corner that repeats the one before, or the first at the end, is left out.
    fn number(&mut self, ring: &[[f64; 2]], near: f64) -> Ring {
        let mut numbers: Ring = Vec::new();
        for &at in ring {
            let known = self.corners.iter().position(|other| distance(*other, at) <= near);
            let number = known.unwrap_or_else(|| {
                self.corners.push(at);
                self.corners.len() - 1
            });
            if numbers.last() != Some(&number) {
                numbers.push(number);
            }
        }
        if numbers.len() > 1 && numbers.first() == numbers.last() {
            numbers.pop();
        }
        numbers
    }

    /// Puts corners that lie on an edge into its ring.
    fn split_edges(&mut self, near: f64) {
        for ring in self.rings.iter_mut().flatten() {
            let mut split = Vec::new();
            for (a, b) in edges(ring) {
                let (from, to) = (self.corners[a], self.corners[b]);
                let length = distance(from, to);
                let mut on: Vec<(f64, usize)> = Vec::new();
                for (number, &at) in self.corners.iter().enumerate().filter(|(number, _)| *number != a && *number != b)
                {
                    let along = dot(minus(at, from), minus(to, from)) / length;
                    if (twice_area(from, to, at) / length).abs() <= near && along > 0.0 && along < length {
                        on.push((along, number));
                    }
                }
                on.sort_by(|a, b| a.0.total_cmp(&b.0));
                split.push(a);
                split.extend(on.into_iter().map(|(_, number)| number));
            }
            *ring = split;
        }
    }

    /// Checks that rings enclose an area and meet no corner twice, and lets outlines run counter-clockwise, holes clockwise.
    fn check_rings(&mut self, polygon: usize, size: f64) -> Result<(), OutlineFault> {
        for (place, ring) in self.rings[polygon].iter_mut().enumerate() {
            let what = if place == 0 { "an outline" } else { "a hole" };
            let first = ring.first().map_or([0.0; 2], |&first| self.corners[first]);
            let twice: f64 = edges(ring).map(|(a, b)| twice_area(first, self.corners[a], self.corners[b])).sum();
            if ring.len() < 3 || twice.abs() <= SAME * size * size {
                let message = format!("has {what} without area");
                return fault(polygon, message, "give the corners in order round the area");
            }
            let mut seen = BTreeSet::new();
            if let Some(&corner) = ring.iter().find(|&&corner| !seen.insert(corner)) {
                let message = format!("has {what} that passes the corner {} twice", place_of(self.corners[corner]));
                return fault(polygon, message, "give two polygons, or the inner one as a hole");
            }
            if (twice > 0.0) != (place == 0) {
                ring.reverse();
            }
        }
        Ok(())
    }

    /// All edges in their directions, with their polygons.
    fn directed(&self) -> impl Iterator<Item = (usize, (usize, usize))> {
        let polygons = self.rings.iter().enumerate();
        polygons.flat_map(|(polygon, rings)| rings.iter().flat_map(|ring| edges(ring)).map(move |edge| (polygon, edge)))
    }

    fn check_crossings(&self) -> Result<(), OutlineFault> {
        let all: Vec<(usize, (usize, usize))> = self.directed().collect();
        for (number, &(polygon, (a, b))) in all.iter().enumerate() {
            let [p, q] = [self.corners[a], self.corners[b]];
            for &(other, (c, d)) in &all[..number] {
                let [r, s] = [self.corners[c], self.corners[d]];
                let is_apart = (0..2).any(|k| p[k].max(q[k]) < r[k].min(s[k]) || r[k].max(s[k]) < p[k].min(q[k]));
                if is_apart || [a, b].iter().any(|end| [c, d].contains(end)) {
                    continue;
                }
                let opposite = |u, v, w, x| twice_area(u, v, w) * twice_area(u, v, x) < 0.0;
                if opposite(p, q, r, s) && opposite(r, s, p, q) {
                    let of = if other == polygon { "itself".to_owned() } else { format!("polygon {}", other + 1) };
                    let message = format!("crosses {of} at the edge from {} to {}", place_of(p), place_of(q));
                    return fault(polygon, message, "give corners in order; polygons may touch and not overlap");
                }
            }
        }
        Ok(())
    }

    /// Checks that no two polygons lie on one side of an edge, and that the rings of a polygon share none.
    fn check_sides(&self) -> Result<(), OutlineFault> {
        let mut sides: BTreeMap<(usize, usize), usize> = BTreeMap::new();
        for (polygon, rings) in self.rings.iter().enumerate() {
            let outline: BTreeSet<(usize, usize)> = edges(&rings[0]).map(undirected).collect();
            let mut own = BTreeSet::new();
            for (a, b) in rings.iter().flat_map(|ring| edges(ring)) {
                let edge = || format!("{} to {}", place_of(self.corners[a]), place_of(self.corners[b]));
                let is_repeated = !own.insert(undirected((a, b)));
                if is_repeated && outline.contains(&undirected((a, b))) {
                    let message = format!("has a hole along its outline, from {}", edge());
                    return fault(polygon, message, "lead the outline round the hole");
                }
                if is_repeated {
                    let message = format!("has two holes along one edge, from {}", edge());
                    return fault(polygon, message, "give them as one hole; other polygons may fill parts of it");
                }
                if let Some(other) = sides.insert((a, b), polygon) {
                    let message = format!("overlaps polygon {} at the edge from {}", other + 1, edge());
                    return fault(polygon, message, OVERLAP);
                }
            }
        }
        Ok(())
    }

    fn check_holes(&self) -> Result<(), OutlineFault> {
        for (polygon, rings) in self.rings.iter().enumerate() {
            for (place, hole) in rings.iter().enumerate().skip(1) {
                let others = rings.iter().enumerate().filter(|(other, _)| *other != place);
                // Rings share no edge here, so that each edge lies within another ring or beside it.
                let around = others.filter(|(other, ring)| {
                    let within = |edge| self.is_inside(self.middle(edge), &[ring.as_slice()]);
                    if *other == 0 { edges(hole).all(within) } else { edges(hole).any(within) }
                });
                let around: Vec<usize> = around.map(|(k, _)| k).collect();
                if around != [0] {
                    let message = format!(
                        "has a hole at {} {}",
                        place_of(self.corners[hole[0]]),
                        if around.first() == Some(&0) { "within another hole" } else { "outside of its outline" }
                    );
                    return fault(polygon, message, "give each hole within the outline and beside the others");
                }
            }
        }
        Ok(())
    }

    /// Checks that no edge of a polygon lies within another: edges cross none, so that polygons which overlap have such an edge or share all.
    fn check_overlaps(&self) -> Result<(), OutlineFault> {
        for (polygon, (a, b)) in self.directed() {
            let middle = self.middle((a, b));
            for (other, rings) in self.rings.iter().enumerate().filter(|(other, _)| *other != polygon) {
                let rings: Vec<&[usize]> = rings.iter().map(Vec::as_slice).collect();
                let is_shared = || rings.iter().flat_map(|ring| edges(ring)).any(|edge| edge == (b, a));
                if self.is_inside(middle, &rings) && !is_shared() {
                    let edge = format!("{} to {}", place_of(self.corners[a]), place_of(self.corners[b]));
                    return fault(polygon, format!("overlaps polygon {} at the edge from {edge}", other + 1), OVERLAP);
                }
            }
        }
        Ok(())
    }

    /// The middle of an edge.
    fn middle(&self, (a, b): (usize, usize)) -> [f64; 2] {
        [0, 1].map(|k| 0.5 * (self.corners[a][k] + self.corners[b][k]))
    }

    /// True where a place lies within an odd number of rings, by the crossings of a ray towards +y.
    pub fn is_inside(&self, [y, z]: [f64; 2], rings: &[&[usize]]) -> bool {
        let crossings = rings.iter().flat_map(|ring| edges(ring)).filter(|&(a, b)| {
            let ([ay, az], [by, bz]) = (self.corners[a], self.corners[b]);
            (az > z) != (bz > z) && ay + (z - az) / (bz - az) * (by - ay) > y
        });
        crossings.count() % 2 == 1
    }
}

/// The remedy of polygons that overlap.
const OVERLAP: &str = "polygons may touch and not overlap: give the outer one a hole where the inner one lies";

/// The ends of an edge, the smaller number first.
pub(super) fn undirected((a, b): (usize, usize)) -> (usize, usize) {
    (a.min(b), a.max(b))
}

/// The edges of a ring.
pub(super) fn edges(ring: &[usize]) -> impl Iterator<Item = (usize, usize)> + '_ {
    (0..ring.len()).map(move |k| (ring[k], ring[(k + 1) % ring.len()]))
}

/// The diagonal of the box around points.
pub(super) fn size<'p>(points: impl Iterator<Item = &'p [f64; 2]>) -> f64 {
    let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for point in points {
        for k in 0..2 {
            range[k] = [range[k][0].min(point[k]), range[k][1].max(point[k])];
        }
    }
    (range[0][1] - range[0][0]).hypot(range[1][1] - range[1][0])
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Twice the area of the triangle, positive where it is counter-clockwise.
fn twice_area(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    cross(minus(b, a), minus(c, a))
}

/// The distance of two points.
pub(super) fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// A place in words.
fn place_of([y, z]: [f64; 2]) -> String {
    format!("[{}, {}]", short(y), short(z))
}
