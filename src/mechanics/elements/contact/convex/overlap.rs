//! The solid that two polyhedra have in common: its faces, volume and moments.
//!
//! The one is cut by the planes of the other, one after the other, and closed by a polygon where it was cut. Neighbouring faces share their
//! corners to the last bit. The solid thus stays closed even where coplanar faces are rounded.

use super::pose::PolyhedronPose;
use super::two_cylinders::PrismOutline;
use base::math::polyhedron::{Polyhedron, SolidMoments};
use base::math::{Mat3, Vec3};

/// A face of the common solid.
#[derive(Clone, Copy)]
pub struct ClippedFace<const CORNERS: usize> {
    corners: [Vec3; CORNERS],
    count: usize,
    /// Unit normal, outward.
    pub normal: Vec3,
    /// True for a face of the one solid, whose motion the derivative is for.
    pub moves: bool,
}

/// The faces of the common solid, with room for so many of so many corners.
pub struct Faces<const CORNERS: usize, const MOST: usize> {
    list: [ClippedFace<CORNERS>; MOST],
    count: usize,
}

/// The faces in the frame with axes in the columns of `T`, about `origin`; `None` if they exceed the room.
pub fn faces<const CORNERS: usize, const MOST: usize>(
    pose: &PolyhedronPose,
    T: &Mat3,
    origin: &Vec3,
) -> Option<Faces<CORNERS, MOST>> {
    let back = T.transpose();
    let mut faces = Faces::of(pose.own, &(back * (pose.y - origin)), &(back * pose.Q))?;
    let center = -(back * origin);
    for face in pose.other.faces() {
        let out = back * face.normal;
        faces.cut(&out, out.dot(&center) + face.offset)?;
    }
    Some(faces)
}

impl<const CORNERS: usize, const MOST: usize> Faces<CORNERS, MOST> {
    /// The faces of a polyhedron. They are made of its corners, so that neighbours share theirs to the last bit.
    pub fn of(shape: &Polyhedron, center: &Vec3, axes: &Mat3) -> Option<Self> {
        if shape.faces().len() > MOST || shape.faces().iter().any(|face| face.corners.len() > CORNERS) {
            return None;
        }
        let empty = ClippedFace { corners: [Vec3::zeros(); CORNERS], count: 0, normal: Vec3::zeros(), moves: false };
        let mut faces = Faces { list: [empty; MOST], count: shape.faces().len() };
        for (face, from) in faces.list.iter_mut().zip(shape.faces()) {
            for (corner, &k) in face.corners.iter_mut().zip(&from.corners) {
                *corner = center + axes * shape.corners()[k];
            }
            (face.count, face.normal, face.moves) = (from.corners.len(), axes * from.normal, true);
        }
        Some(faces)
    }

    /// The faces of a prism along the third of its `axes`, by its outline.
    pub fn of_prism(outline: &PrismOutline, half: f64, center: &Vec3, axes: &Mat3) -> Option<Self> {
        let count = outline.count;
        if count + 2 > MOST || count > CORNERS {
            return None;
        }
        let empty = ClippedFace { corners: [Vec3::zeros(); CORNERS], count: 0, normal: Vec3::zeros(), moves: true };
        let mut faces = Faces { list: [empty; MOST], count: count + 2 };
        let (up, place) = (axes.column(2).into_owned(), |k: usize| center + axes * outline.corners[k]);
        for k in 0..count {
            let [a, b] = [k, (k + 1) % count].map(place);
            let face = &mut faces.list[k];
            face.corners[..4].copy_from_slice(&[a - half * up, b - half * up, b + half * up, a + half * up]);
            (face.count, face.normal) = (4, axes * outline.normals[k]);
            faces.list[count].corners[k] = a + half * up;
            faces.list[count + 1].corners[count - 1 - k] = a - half * up;
        }
        for (end, normal) in [(count, up), (count + 1, -up)] {
            (faces.list[end].count, faces.list[end].normal) = (count, normal);
        }
        Some(faces)
    }

    /// Keeps the part below the plane n · x = `at`, and closes it there; `None` if the room is too small.
    pub fn cut(&mut self, n: &Vec3, at: f64) -> Option<()> {
        let mut edges = [[Vec3::zeros(); 2]; MOST];
        let (mut cuts, mut kept, mut has_room) = (0, 0, true);
        for place in 0..self.count {
            if kept < place {
                self.list[kept] = self.list[place];
            }
            let face = &mut self.list[kept];
            has_room &= face.cut(n, at, &mut |edge| {
                if let Some(room) = edges.get_mut(cuts) {
                    *room = edge;
                }
                cuts += 1;
            });
            if face.count >= 3 {
                kept += 1;
            }
        }
        self.count = kept;
        let edges = edges.get(..cuts).filter(|_| has_room)?;
        self.close(edges, n)
    }

    /// Closes the solid by the polygon of these edges, or by triangles if rounding has torn it or its corners exceed the room.
    fn close(&mut self, edges: &[[Vec3; 2]], n: &Vec3) -> Option<()> {
        let Some(first) = edges.iter().find(|[a, b]| a != b) else { return Some(()) };
        let face = self.list.get_mut(self.count)?;
        (face.count, face.normal, face.moves) = (0, *n, false);
        let (mut at, mut left) = (first[0], edges.iter().filter(|[a, b]| a != b).count());
        // Each corner begins one edge: a polygon is whole where it comes back to its start with the last of them.
        while left > 0 && face.count < CORNERS {
            let Some(next) = edges.iter().find(|[a, b]| a != b && *a == at) else { break };
            face.corners[face.count] = at;
            face.count += 1;
            (at, left) = (next[1], left - 1);
            if at == first[0] {
                break;
            }
        }
        if left == 0 && at == first[0] {
            self.count += usize::from(face.count >= 3);
            return Some(());
        }
        let first = first[0];
        for [a, b] in edges.iter().filter(|[a, b]| a != b && *a != first && *b != first) {
            let face = self.list.get_mut(self.count)?;
            face.corners[..3].copy_from_slice(&[first, *a, *b]);
            (face.count, face.normal, face.moves) = (3, *n, false);
            self.count += 1;
        }
        Some(())
    }
}

impl<const CORNERS: usize> ClippedFace<CORNERS> {
    /// Its corners, counter-clockwise about the normal.
    pub fn corners(&self) -> &[Vec3] {
        &self.corners[..self.count]
    }

    /// Keeps the part below the plane n · x = `at`; calls `edge` with each edge of the cut, in the sense of the closing face. False where
    /// there is no room for its corners.
    fn cut(&mut self, n: &Vec3, at: f64, edge: &mut dyn FnMut([Vec3; 2])) -> bool {
        let mut above = [0.0; CORNERS];
        for (above, corner) in above.iter_mut().zip(&self.corners[..self.count]) {
            *above = n.dot(corner) - at;
        }
        let is_in = |i: usize| above[i] <= 0.0;
        if (0..self.count).all(is_in) {
            return true;
        }
        if !(0..self.count).any(is_in) {
            self.count = 0;
            return true;
        }
        let old = self.corners;
        // From the inner end to the outer one, on both faces that share the edge: the point is the same to the last bit.
        let crossing = |inner: usize, outer: usize| {
            old[inner] + above[inner] / (above[inner] - above[outer]) * (old[outer] - old[inner])
        };
        let (mut count, mut left, mut back) = (0, None, None);
        for i in 0..self.count {
            let next = (i + 1) % self.count;
            if is_in(i) {
                self.push(&mut count, old[i]);
            }
            if is_in(i) && !is_in(next) {
                let out = crossing(i, next);
                self.push(&mut count, out);
                left = Some(out);
            } else if !is_in(i) && is_in(next) {
                let inside = crossing(next, i);
                self.push(&mut count, inside);
                match left.take() {
                    Some(out) => edge([inside, out]),
                    None => back = Some(inside),
                }
            }
        }
        if let (Some(inside), Some(out)) = (back, left) {
            edge([inside, out]);
        }
        self.count = count.min(CORNERS);
        count <= CORNERS
    }

    fn push(&mut self, count: &mut usize, corner: Vec3) {
        if let Some(room) = self.corners.get_mut(*count) {
            *room = corner;
        }
        *count += 1;
    }

    /// The triangles about its first corner that make it up.
    fn triangles(&self) -> impl Iterator<Item = [Vec3; 3]> + '_ {
        (1..self.count.max(2) - 1).map(|k| [self.corners[0], self.corners[k], self.corners[k + 1]])
    }

    /// The integrals of q dS and q x dS over the face, exact for q of the second degree.
    pub fn integral(&self, q: &impl Fn(&Vec3) -> f64) -> (f64, Vec3) {
        let (mut sum, mut first) = (0.0, Vec3::zeros());
        for [a, b, c] in self.triangles() {
            let area = 0.5 * (b - a).cross(&(c - a)).dot(&self.normal);
            // The rule of four points, of the third degree (P. C. Hammer and A. H. Stroud, 1956).
            let middle = (a + b + c) / 3.0;
            let mut take = |x: Vec3, weight: f64| {
                let share = weight * area * q(&x);
                sum += share;
                first += share * x;
            };
            take(middle, -27.0 / 48.0);
            [a, b, c].into_iter().for_each(|corner| take(0.6 * middle + 0.4 * corner, 25.0 / 48.0));
        }
        (sum, first)
    }
}

impl<const CORNERS: usize, const MOST: usize> Faces<CORNERS, MOST> {
    /// The faces of the solid.
    pub fn iter(&self) -> impl Iterator<Item = &ClippedFace<CORNERS>> {
        self.list[..self.count].iter()
    }

    /// Volume, centre and variance; `None` where there is no volume.
    pub fn moments(&self) -> Option<SolidMoments> {
        let corners = || self.iter().flat_map(|face| &face.corners[..face.count]);
        let middle: Vec3 = corners().sum::<Vec3>() / corners().count().max(1) as f64;
        SolidMoments::of(self.iter().flat_map(ClippedFace::triangles), &middle)
    }
}
