//! Normals of a surface of triangles and quadrilaterals at their nodes.
//!
//! At a node, elements form one smooth side if they share an edge and the angle between their normals is below [`FOLD`]. Each side has one
//! normal: the mean of its elements' normals at the node, weighted by their angles there (Thürmer & Wüthrich 1998). It does not depend on
//! the division of faces. An element of the other orientation counts with the other sign and has the opposite normal.

use base::math::{Vec3, curved_faces};
use std::f64::consts::{PI, TAU};

/// The fold angle between neighbours, in degrees: the 12 faces of a coarse cylinder are smooth, plates meeting at a larger angle are not.
pub const FOLD: f64 = 31.0;

/// Unit normals at the corners of each face, and the number of edges between neighbours of different orientation. About its normal the
/// corners of a face are counter-clockwise. `faces`: indices into `x`, three or four corners each, or six, eight or nine nodes with sides
/// of second degree; each node has a normal. N is the largest number of nodes, or 9 if some have eight; the ninth normal is at the middle.
pub fn normals<'a, const N: usize>(
    x: &[Vec3],
    faces: impl Iterator<Item = &'a [u32]> + Clone,
) -> (Vec<[Vec3; N]>, usize) {
    let mut corners: Vec<Corner> = Vec::new();
    for (face, nodes) in faces.clone().enumerate() {
        match nodes.len() {
            3 | 4 => corners.extend(Corner::of(x, face, nodes)),
            _ => corners.extend(Corner::of_curved(x, face, nodes)),
        }
    }
    // The corners at a node are starts[node]..starts[node + 1] of `order`.
    let mut starts = vec![0u32; x.len() + 1];
    corners.iter().for_each(|corner| starts[corner.node as usize + 1] += 1);
    for node in 0..x.len() {
        starts[node + 1] += starts[node];
    }
    let (mut order, mut next) = (vec![0u32; corners.len()], starts.clone());
    for (at, corner) in corners.iter().enumerate() {
        let place = &mut next[corner.node as usize];
        order[*place as usize] = at as u32;
        *place += 1;
    }
    let middle = |nodes: &[u32]| {
        let mut normals = [Vec3::zeros(); N];
        if nodes.len() == 8 {
            let [r, s] = curved_faces::tangents_of(8, &|a| x[nodes[a] as usize])[8];
            normals[8] = r.cross(&s).normalize();
        }
        normals
    };
    let mut normals: Vec<[Vec3; N]> = faces.map(middle).collect();
    let (mut against, mut sides) = (0, Sides::default());
    for node in 0..x.len() {
        let round = &order[starts[node] as usize..starts[node + 1] as usize];
        against += sides.join(node as u32, round, &corners);
        sides.write(round, &corners, &mut normals);
    }
    (normals, against)
}

/// One corner of a face.
struct Corner {
    node: u32,
    face: u32,
    place: usize,
    /// The corners before and after it on the boundary of the face.
    sides: [u32; 2],
    /// Unit normal of the whole face.
    face_normal: Vec3,
    /// Unit normal at this corner.
    normal: Vec3,
    /// Angle between the sides, radians.
    angle: f64,
}

impl Corner {
    fn of<'a>(x: &'a [Vec3], face: usize, nodes: &'a [u32]) -> impl Iterator<Item = Corner> + 'a {
        let n = nodes.len();
        let at = move |i: usize| x[nodes[i % n] as usize];
        let spans = move |i: usize| (at(i + 1) - at(i), at(i + n - 1) - at(i));
        let whole: Vec3 = (0..n).map(|i| spans(i).0.cross(&spans(i).1)).sum();
        let face_normal = whole.normalize();
        (0..n).map(move |place| {
            let (ahead, back) = spans(place);
            let cross = ahead.cross(&back);
            Corner {
                node: nodes[place],
                face: face as u32,
                place,
                sides: [nodes[(place + n - 1) % n], nodes[(place + 1) % n]],
                face_normal,
                normal: cross.normalize(),
                angle: cross.norm().atan2(ahead.dot(&back)),
            }
        })
    }
}

impl Corner {
    /// The nodes of a face with sides of second degree; between neighbours its normal at the node counts, as the face is curved.
    fn of_curved<'a>(x: &'a [Vec3], face: usize, nodes: &'a [u32]) -> impl Iterator<Item = Corner> + 'a {
        let at = move |i: usize| x[nodes[i] as usize];
        let tangents = curved_faces::tangents_of(nodes.len(), &at);
        let round: Vec<usize> = curved_faces::ring(nodes.len()).collect();
        let corners = round.len() / 2;
        (0..nodes.len()).map(move |place| {
            let [r, s] = &tangents[place];
            let normal = r.cross(s).normalize();
            // The middle has no neighbours but itself.
            let (mut sides, mut angle) = ([nodes[place]; 2], TAU);
            if let Some(k) = round.iter().position(|&other| other == place) {
                let n = round.len();
                let [back, ahead] = [round[(k + n - 1) % n], round[(k + 1) % n]];
                sides = [nodes[back], nodes[ahead]];
                let (along, against) = (at(ahead) - at(place), at(back) - at(place));
                angle = if place < corners { along.cross(&against).norm().atan2(along.dot(&against)) } else { PI };
            }
            Corner { node: nodes[place], face: face as u32, place, sides, face_normal: normal, normal, angle }
        })
    }
}

/// Corners around one node, joined to smooth sides by a union-find structure.
#[derive(Default)]
struct Sides {
    /// Another corner of the same side for each corner, itself for the first, and the relative orientation, ±1.
    parent: Vec<(usize, f64)>,
    /// The edges at the node: (node at the other end, corner, outgoing).
    edges: Vec<(u32, usize, bool)>,
    /// The sum of normals of each side, at its first corner.
    sums: Vec<Vec3>,
}

impl Sides {
    /// The first corner of the side of `corner`, and the relative orientation.
    fn root(&self, mut corner: usize) -> (usize, f64) {
        let mut sense = 1.0;
        while self.parent[corner].0 != corner {
            sense *= self.parent[corner].1;
            corner = self.parent[corner].0;
        }
        (corner, sense)
    }

    /// Joins the corners around a node over its edges; returns the number of edges to higher nodes that both faces run through in
    /// the same direction.
    fn join(&mut self, node: u32, round: &[u32], corners: &[Corner]) -> usize {
        let least = FOLD.to_radians().cos();
        self.parent.clear();
        self.parent.extend((0..round.len()).map(|at| (at, 1.0)));
        self.edges.clear();
        for (at, &corner) in round.iter().enumerate() {
            let [back, ahead] = corners[corner as usize].sides;
            self.edges.extend([(back, at, false), (ahead, at, true)]);
        }
        self.edges.sort_unstable();
        let mut against = 0;
        let edges = std::mem::take(&mut self.edges);
        for run in edges.chunk_by(|a, b| a.0 == b.0) {
            // Neighbours of one orientation run through their common edge in opposite directions.
            against += usize::from(run.len() == 2 && run[0].2 == run[1].2 && node < run[0].0);
            // Where more than two faces meet, each joins its continuations; only the last eight are compared.
            for (i, a) in run.iter().enumerate().skip(1) {
                for b in &run[i.saturating_sub(8)..i] {
                    let sense = if a.2 == b.2 { -1.0 } else { 1.0 };
                    let of = |at: usize| &corners[round[at] as usize].face_normal;
                    if sense * of(a.1).dot(of(b.1)) < least {
                        continue;
                    }
                    let ((first, s), (second, t)) = (self.root(a.1), self.root(b.1));
                    let (low, high) = (first.min(second), first.max(second));
                    if low != high {
                        self.parent[high] = (low, s * t * sense);
                    }
                }
            }
        }
        self.edges = edges;
        against
    }

    /// Writes the mean normal of each side to its corners.
    fn write<const N: usize>(&mut self, round: &[u32], corners: &[Corner], normals: &mut [[Vec3; N]]) {
        self.sums.clear();
        self.sums.resize(round.len(), Vec3::zeros());
        for (at, &corner) in round.iter().enumerate() {
            let (root, sense) = self.root(at);
            let corner = &corners[corner as usize];
            self.sums[root] += sense * corner.angle * corner.normal;
        }
        for (at, &corner) in round.iter().enumerate() {
            let (root, sense) = self.root(at);
            let corner = &corners[corner as usize];
            // A side whose normals cancel has no mean; its faces keep their own.
            let mean = (sense * self.sums[root]).try_normalize(1e-9);
            normals[corner.face as usize][corner.place] = mean.unwrap_or(corner.normal);
        }
    }
}
