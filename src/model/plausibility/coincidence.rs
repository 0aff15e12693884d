//! The tolerance for coincident places, and the elements of parts as segments and faces.

use crate::data::PartIndex;
use crate::places::nodes::Topology;
use crate::scene::Scene;
use base::math::Vec3;
use base::math::curved_faces::facets;

/// Places are the same within this part of the median length of an element, ...
const OF_ELEMENT: f64 = 1e-4;
/// ... within what six digits of a coordinate leave of the size of the scene, ...
const OF_SCENE: f64 = 2e-6;
/// ... and never within more than this part of the shortest element.
const OF_SHORTEST: f64 = 0.05;

/// The nodes of every element with its part; of a curved face those of the flat ones that cover it.
pub fn pieces(scene: &Scene) -> Vec<(PartIndex, Vec<usize>)> {
    let entries = scene.parts.entries().filter(|(at, _)| at.kind.is_deformable());
    let flat = |at: PartIndex, nodes: Vec<usize>| match nodes.len() {
        n @ (6 | 9) if at.kind.is_surface() => {
            facets(n).iter().map(|facet| facet.iter().map(|&k| nodes[k]).collect()).collect()
        }
        _ => vec![nodes],
    };
    entries
        .flat_map(|(at, _)| {
            scene.parts.elements(at).into_iter().flat_map(move |nodes| flat(at, nodes)).map(move |nodes| (at, nodes))
        })
        .collect()
}

/// Within which places count as one, and the size of cells for elements.
pub struct Coincidence {
    pub same: f64,
    pub cell: f64,
    pub origin: Vec3,
}

impl Coincidence {
    /// `None` for a scene without extent.
    pub fn new(pieces: &[(PartIndex, Vec<usize>)], topology: &Topology) -> Option<Coincidence> {
        let x = |node: usize| topology.x(node);
        let mut lengths: Vec<f64> = pieces
            .iter()
            .flat_map(|(_, nodes)| nodes.windows(2).map(|pair| (x(pair[1]) - x(pair[0])).norm()))
            .collect();
        let origin = topology.list.first()?.x;
        let (low, high) = topology.list.iter().fold((origin, origin), |(low, high), n| (low.inf(&n.x), high.sup(&n.x)));
        let size = (high - low).amax();
        if size.is_nan() || size <= 0.0 {
            return None;
        }
        if lengths.is_empty() {
            return Some(Coincidence { same: OF_SCENE * size, cell: size, origin: low });
        }
        let middle = lengths.len() / 2;
        let median = *lengths.select_nth_unstable_by(middle, f64::total_cmp).1;
        let shortest = lengths.iter().copied().fold(f64::INFINITY, f64::min);
        let mean = lengths.iter().sum::<f64>() / lengths.len() as f64;
        let same = (OF_ELEMENT * median).max(OF_SCENE * size).min(OF_SHORTEST * shortest);
        (same > 0.0).then_some(Coincidence { same, cell: 1.5 * median.max(mean), origin: low })
    }
}

/// The corners of an element: the inner nodes of a beam's lie on the line of its ends.
pub fn corners(part: PartIndex, nodes: &[usize]) -> Vec<usize> {
    if part.kind.is_surface() { nodes.to_vec() } else { vec![nodes[0], nodes[nodes.len() - 1]] }
}

/// True where a place lies on a segment or a face of three or four corners.
pub fn lies_on(at: &Vec3, corners: &[Vec3], reach: f64) -> bool {
    match *corners {
        [a, b, c, d] => lies_on_simplex(at, &[a, b, c], reach) || lies_on_simplex(at, &[a, c, d], reach),
        _ => lies_on_simplex(at, corners, reach),
    }
}

/// True where a place lies on a segment or a triangle.
fn lies_on_simplex(at: &Vec3, simplex: &[Vec3], reach: f64) -> bool {
    /// Tolerance of the edges of a triangle for rounding, relative to its size.
    const EDGE: f64 = 1e-6;
    let from = at - simplex[0];
    match simplex {
        [a, b] => {
            let along = b - a;
            let s = from.dot(&along) / along.norm_squared();
            (0.0..=1.0).contains(&s) && (from - s * along).norm() <= reach
        }
        [a, b, c] => {
            let (u, v) = (b - a, c - a);
            let normal = u.cross(&v);
            let double = normal.norm_squared();
            let (s, t) = (from.cross(&v).dot(&normal) / double, u.cross(&from).dot(&normal) / double);
            s >= -EDGE && t >= -EDGE && s + t <= 1.0 + EDGE && from.dot(&normal).abs() <= reach * double.sqrt()
        }
        _ => false,
    }
}
