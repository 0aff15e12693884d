//! The mesh edges that a long body may lie across: border edges and convex folds.

use base::math::Vec3;
use std::collections::BTreeMap;

/// An edge between two corners of faces.
pub struct MeshEdge {
    /// Its ends.
    pub ends: [Vec3; 2],
    /// The unit normal on the side of the long body, away from the faces at a fold; zero where more than two faces meet.
    pub normal: Vec3,
    /// The sine of half the fold angle toward the normal; 1 at the border.
    pub rise: f64,
    /// True for an edge of one face alone.
    pub is_border: bool,
}

impl MeshEdge {
    /// Its length.
    pub fn length(&self) -> f64 {
        (self.ends[1] - self.ends[0]).norm()
    }

    /// The distance of a place, seen along the normal.
    pub fn distance(&self, place: &Vec3) -> f64 {
        let flat = |v: Vec3| v - self.normal.dot(&v) * self.normal;
        let (along, from) = (flat(self.ends[1] - self.ends[0]), flat(place - self.ends[0]));
        let part = if along.norm_squared() > 0.0 { from.dot(&along) / along.norm_squared() } else { 0.0 };
        (from - part.clamp(0.0, 1.0) * along).norm()
    }

    /// Largest depth of a straight body in the edge before its ends, `apart` from each other, touch the faces on both sides. `seen_from` is
    /// a place on its side. The border stops it nowhere.
    pub fn sink(&self, seen_from: &Vec3, apart: f64) -> f64 {
        match self.is_border {
            true => f64::INFINITY,
            false if self.normal.dot(&(seen_from - self.ends[0])) < 0.0 => 0.0,
            false => 0.5 * apart * self.rise,
        }
    }
}

/// The edges of faces by the places of their corners, in the order of their nodes.
pub fn mesh_edges(faces: &[Vec<usize>], x: impl Fn(usize) -> Vec3) -> Vec<MeshEdge> {
    let mut sides: BTreeMap<[usize; 2], Vec<Vec3>> = BTreeMap::new();
    for face in faces {
        let center = face.iter().map(|&node| x(node)).sum::<Vec3>() / face.len() as f64;
        for (k, &a) in face.iter().enumerate() {
            let b = face[(k + 1) % face.len()];
            let (from, along) = (center - x(a), x(b) - x(a));
            let inward = from - from.dot(&along) / along.norm_squared() * along;
            if let Some(inward) = inward.try_normalize(0.0) {
                sides.entry([a.min(b), a.max(b)]).or_default().push(inward);
            }
        }
    }
    let edge = |(nodes, inward): (&[usize; 2], &Vec<Vec3>)| {
        let ends = nodes.map(&x);
        let (normal, rise, is_border) = match inward[..] {
            [one] => (one.cross(&(ends[1] - ends[0])).normalize(), 1.0, true),
            [one, other] => {
                let out = -0.5 * (one + other);
                (out.try_normalize(0.0).unwrap_or_default(), out.norm(), false)
            }
            _ => (Vec3::zeros(), 1.0, false),
        };
        MeshEdge { ends, normal, rise, is_border }
    };
    sides.iter().map(edge).collect()
}
