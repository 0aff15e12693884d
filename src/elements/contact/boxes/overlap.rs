//! The solid that two boxes have in common: its faces, volume and moments.
//!
//! The one box is cut by the planes of the other, one after the other, and closed where it was cut. Neighbouring faces share their
//! corners to the last bit, so that the solid stays closed whatever rounding makes of faces that lie in one plane.

use super::pose::{BoxPose, corner};
use crate::math::{Mat3, Vec3};

/// Most corners of a face: four, and one for each of six planes that clip it.
const CORNERS: usize = 12;
/// Most faces: those of a box, and triangles that close it at six planes.
const MOST: usize = 48;

/// A face of the common solid.
#[derive(Clone, Copy)]
pub struct ClippedFace {
    corners: [Vec3; CORNERS],
    count: usize,
    /// Unit normal, outward.
    pub normal: Vec3,
    /// True where it is a face of the one box, which moves.
    pub moves: bool,
}

/// The faces of the common solid.
pub struct Faces {
    list: [ClippedFace; MOST],
    count: usize,
}

/// Volume, centre, and variance of positions about it.
pub struct Moments {
    /// The volume.
    pub volume: f64,
    /// The centre.
    pub mean: Vec3,
    /// The mean of the products of positions about the centre.
    pub variance: Mat3,
}

/// The faces in the frame whose axes are the columns of `T`, about `origin`.
pub fn faces(pose: &BoxPose, T: &Mat3, origin: &Vec3) -> Faces {
    let back = T.transpose();
    let mut faces = Faces::of_box(&(back * (pose.y - origin)), &(back * pose.Q), &pose.own);
    let center = -(back * origin);
    for k in 0..3 {
        for side in [1.0, -1.0] {
            let out = side * back.column(k);
            faces.cut(&out, out.dot(&center) + pose.other[k]);
        }
    }
    faces
}

impl Faces {
    /// The faces of a box. They are made of its eight corners, so that neighbours share theirs to the last bit.
    fn of_box(center: &Vec3, axes: &Mat3, half: &Vec3) -> Faces {
        let corners: [Vec3; 8] = std::array::from_fn(|k| center + axes * corner(k).component_mul(half));
        let empty = ClippedFace { corners: [Vec3::zeros(); CORNERS], count: 0, normal: Vec3::zeros(), moves: false };
        let mut faces = Faces { list: [empty; MOST], count: 6 };
        for k in 0..3 {
            let (i, j) = (1 << ((k + 1) % 3), 1 << ((k + 2) % 3));
            // Counter-clockwise about the axis, and about its opposite.
            let (high, low) = (1 << k, 0);
            let around = [[high | i | j, high | j, high, high | i], [low | i | j, low | i, low, low | j]];
            for (side, around) in around.into_iter().enumerate() {
                let face = &mut faces.list[2 * k + side];
                around.iter().enumerate().for_each(|(place, &k)| face.corners[place] = corners[k]);
                face.count = 4;
                face.normal = if side == 0 { axes.column(k).into_owned() } else { -axes.column(k) };
                face.moves = true;
            }
        }
        faces
    }

    /// Keeps what lies below the plane n · x = `at`, and closes it there.
    fn cut(&mut self, n: &Vec3, at: f64) {
        let mut edges = [[Vec3::zeros(); 2]; MOST];
        let (mut cuts, mut kept) = (0, 0);
        for place in 0..self.count {
            let mut face = self.list[place];
            face.cut(n, at, &mut |edge| {
                if cuts < MOST {
                    edges[cuts] = edge;
                    cuts += 1;
                }
            });
            if face.count >= 3 {
                self.list[kept] = face;
                kept += 1;
            }
        }
        self.count = kept;
        let first = edges[0][0];
        for [a, b] in edges[..cuts].iter().filter(|[a, b]| a != b && *a != first && *b != first) {
            if self.count < MOST {
                let face = &mut self.list[self.count];
                face.corners[..3].copy_from_slice(&[first, *a, *b]);
                (face.count, face.normal, face.moves) = (3, *n, false);
                self.count += 1;
            }
        }
    }
}

impl ClippedFace {
    /// Keeps what lies below the plane n · x = `at`; tells of each edge that the plane then needs, as it goes around there.
    fn cut(&mut self, n: &Vec3, at: f64, edge: &mut dyn FnMut([Vec3; 2])) {
        let old = self.corners;
        let mut above = [0.0; CORNERS];
        for (above, corner) in above.iter_mut().zip(&old[..self.count]) {
            *above = n.dot(corner) - at;
        }
        let is_in = |i: usize| above[i] <= 0.0;
        if (0..self.count).all(is_in) {
            return;
        }
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
        self.count = count;
    }

    fn push(&mut self, count: &mut usize, corner: Vec3) {
        if *count < CORNERS {
            self.corners[*count] = corner;
            *count += 1;
        }
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

impl Faces {
    /// The faces of the solid.
    pub fn iter(&self) -> impl Iterator<Item = &ClippedFace> {
        self.list[..self.count].iter()
    }

    /// Sums over the tetrahedra between a point in the middle and the triangles of the faces; `None` where there is no volume. About
    /// a point that is far from a thin solid, the squares of its thickness would be lost.
    pub fn moments(&self) -> Option<Moments> {
        let corners = || self.iter().flat_map(|face| &face.corners[..face.count]);
        let middle: Vec3 = corners().sum::<Vec3>() / corners().count().max(1) as f64;
        let (mut volume, mut first, mut second) = (0.0, Vec3::zeros(), Mat3::zeros());
        for triangle in self.iter().flat_map(ClippedFace::triangles) {
            let [a, b, c] = triangle.map(|x| x - middle);
            let part = a.dot(&b.cross(&c)) / 6.0;
            let sum = a + b + c;
            volume += part;
            first += part / 4.0 * sum;
            second += part / 20.0 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
        }
        let mean = first / volume;
        let variance = second / volume - mean * mean.transpose();
        (volume > 0.0).then_some(Moments { volume, mean: middle + mean, variance })
    }
}
