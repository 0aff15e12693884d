//! The edges of a mesh of faces over which something long may lie: those of the border, and folds that bulge.

use base::math::Vec3;
use std::collections::BTreeMap;

/// An edge between two corners of faces.
pub struct MeshEdge {
    /// Its ends.
    pub ends: [Vec3; 2],
    /// The normal of what lies there, of unit length, away from the faces at a fold; zero where more than two faces meet.
    pub normal: Vec3,
    /// The sine of half the angle by which the faces are folded towards the normal; 1 at the border.
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

    /// How deep something straight may sink into the edge before its ends, so far apart, touch the faces on either side of it; `seen_from` is
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A roof of two squares, the ridge along y at the height given, with eaves at x = ±1.
    fn roof(height: f64) -> Vec<MeshEdge> {
        let places = [-1.0, 0.0, 1.0].map(|x: f64| [x, if x == 0.0 { height } else { 0.0 }]);
        let x = |node: usize| Vec3::new(places[node % 3][0], (node / 3) as f64, places[node % 3][1]);
        mesh_edges(&[vec![0, 1, 4, 3], vec![1, 2, 5, 4]], x)
    }

    /// A straight thing two long whose ends touch either slope of a roof at 45° lies 1/√2 below its ridge; from below nothing lies over it, nor on a
    /// flat sheet.
    #[test]
    fn folds_bulge_to_one_side() {
        let fold = |height: f64| roof(height).into_iter().find(|edge| !edge.is_border).unwrap();
        let (above, below) = (Vec3::new(0.0, 0.5, 3.0), Vec3::new(0.0, 0.5, -3.0));
        assert!((fold(1.0).sink(&above, 2.0) - 0.5f64.sqrt()).abs() < 1e-15);
        assert_eq!(fold(1.0).sink(&below, 2.0), 0.0);
        assert_eq!((fold(-1.0).sink(&above, 2.0), fold(-1.0).sink(&below, 2.0) > 0.7), (0.0, true));
        assert!(fold(0.0).sink(&above, 2.0) < 1e-15 && fold(0.0).sink(&below, 2.0) < 1e-15);
    }

    /// The border is six of seven edges, and something above the eaves is as far from them as it is along the slope.
    #[test]
    fn borders_are_edges_of_one_face() {
        let edges = roof(0.0);
        assert_eq!((edges.len(), edges.iter().filter(|edge| edge.is_border).count()), (7, 6));
        let place = Vec3::new(0.75, 0.5, 9.0);
        let nearest = edges.iter().filter(|edge| edge.is_border).map(|edge| edge.distance(&place));
        assert_eq!(nearest.fold(f64::INFINITY, f64::min), 0.25);
    }
}
