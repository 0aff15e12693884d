//! The solid that two polyhedra have in common: its faces, volume and moments.
//!
//! The one is cut by the planes of the other, one after the other, and closed by a polygon where it was cut. Faces name their corners by
//! number, so that neighbours share them. The solid thus stays closed even where coplanar faces are rounded.

use super::pose::PolyhedronPose;
use super::two_cylinders::PrismOutline;
use base::math::polyhedron::{Polyhedron, SolidMoments};
use base::math::{Mat3, Vec3};

/// Most corners of a face.
pub const MOST_CORNERS: usize = 64;

/// A face by the numbers of its corners, counter-clockwise about the normal.
#[derive(Clone, Copy)]
struct NumberedFace {
    corners: [u8; MOST_CORNERS],
    count: usize,
    normal: Vec3,
    moves: bool,
}

/// A face of the common solid.
#[derive(Clone, Copy)]
pub struct ClippedFace<'a> {
    points: &'a [Vec3],
    numbers: &'a [u8],
    /// Unit normal, outward.
    pub normal: Vec3,
    /// True for a face of the one solid, whose motion the derivative is for.
    pub moves: bool,
}

/// The faces of the common solid, with room for so many of so many points in all.
pub struct Faces<const FACES: usize, const POINTS: usize> {
    points: [Vec3; POINTS],
    /// The number of points so far, those that were cut off among them.
    used: usize,
    list: [NumberedFace; FACES],
    count: usize,
}

/// The faces in the frame with axes in the columns of `T`, about `origin`; `None` if they exceed the room.
pub fn faces<const FACES: usize, const POINTS: usize>(
    pose: &PolyhedronPose,
    T: &Mat3,
    origin: &Vec3,
) -> Option<Faces<FACES, POINTS>> {
    let back = T.transpose();
    let mut faces = Faces::of(pose.own, &(back * (pose.y - origin)), &(back * pose.Q))?;
    let center = -(back * origin);
    for face in pose.other.faces() {
        let out = back * face.normal;
        faces.cut(&out, out.dot(&center) + face.offset)?;
    }
    Some(faces)
}

impl NumberedFace {
    fn new(normal: Vec3, moves: bool) -> Self {
        NumberedFace { corners: [0; MOST_CORNERS], count: 0, normal, moves }
    }

    fn numbers(&self) -> &[u8] {
        &self.corners[..self.count]
    }

    /// The two ends of each edge.
    fn edges(&self) -> impl Iterator<Item = (u8, u8)> + '_ {
        let next = |i: usize| if i + 1 == self.count { 0 } else { i + 1 };
        (0..self.count).map(move |i| (self.corners[i], self.corners[next(i)]))
    }

    /// Adds a corner; `None` if there is no room.
    fn push(&mut self, corner: u8) -> Option<()> {
        *self.corners.get_mut(self.count)? = corner;
        self.count += 1;
        Some(())
    }
}

/// A cut by a plane under way.
struct Cut<const POINTS: usize> {
    /// How high each point lies above the plane.
    above: [f64; POINTS],
    /// The number of the first point in the plane, and the inner and the outer end of the edge of each.
    first: usize,
    ends: [[u8; 2]; MOST_CORNERS],
    /// The corner of the closing polygon after each of its corners.
    next: [u8; POINTS],
}

impl<const POINTS: usize> Cut<POINTS> {
    fn keeps(&self, corner: u8) -> bool {
        self.above[usize::from(corner)] <= 0.0
    }
}

impl<const FACES: usize, const POINTS: usize> Faces<FACES, POINTS> {
    /// No faces yet, and no points.
    fn new() -> Self {
        let list = [NumberedFace::new(Vec3::zeros(), true); FACES];
        Faces { points: [Vec3::zeros(); POINTS], used: 0, list, count: 0 }
    }

    /// The faces of a polyhedron.
    pub fn of(shape: &Polyhedron, center: &Vec3, axes: &Mat3) -> Option<Self> {
        let mut faces = Faces::new();
        for corner in shape.corners() {
            faces.add_point(center + axes * corner)?;
        }
        for face in shape.faces() {
            let new = faces.add_face(axes * face.normal, true)?;
            face.corners.iter().try_for_each(|&k| new.push(k as u8))?;
        }
        Some(faces)
    }

    /// The faces of a prism along the third of its `axes`, by its outline.
    pub fn of_prism(outline: &PrismOutline, half: f64, center: &Vec3, axes: &Mat3) -> Option<Self> {
        let mut faces = Faces::new();
        let (count, up) = (outline.count, axes.column(2).into_owned());
        for corner in &outline.corners[..count] {
            let place = center + axes * corner;
            faces.add_point(place - half * up)?;
            faces.add_point(place + half * up)?;
        }
        let (low, high) = (|k: usize| 2 * k as u8, |k: usize| 2 * k as u8 + 1);
        for k in 0..count {
            let (next, side) = ((k + 1) % count, faces.add_face(axes * outline.normals[k], true)?);
            [low(k), low(next), high(next), high(k)].into_iter().try_for_each(|corner| side.push(corner))?;
        }
        let top = faces.add_face(up, true)?;
        (0..count).try_for_each(|k| top.push(high(k)))?;
        let bottom = faces.add_face(-up, true)?;
        (0..count).rev().try_for_each(|k| bottom.push(low(k)))?;
        Some(faces)
    }

    fn add_point(&mut self, x: Vec3) -> Option<u8> {
        let number = u8::try_from(self.used).ok()?;
        *self.points.get_mut(self.used)? = x;
        self.used += 1;
        Some(number)
    }

    fn add_face(&mut self, normal: Vec3, moves: bool) -> Option<&mut NumberedFace> {
        let face = self.list.get_mut(self.count)?;
        *face = NumberedFace::new(normal, moves);
        self.count += 1;
        Some(face)
    }

    /// Keeps the part below the plane n · x = `at`, and closes it there; `None` if the room is too small.
    pub fn cut(&mut self, n: &Vec3, at: f64) -> Option<()> {
        if self.used + self.count > POINTS {
            self.forget_points();
        }
        let mut cut = Cut { above: [0.0; POINTS], first: self.used, ends: [[0; 2]; MOST_CORNERS], next: [0; POINTS] };
        for (above, x) in cut.above.iter_mut().zip(&self.points[..self.used]) {
            *above = n.dot(x) - at;
        }
        if (0..self.used).all(|k| cut.keeps(k as u8)) {
            return Some(());
        }
        let mut kept = 0;
        for place in 0..self.count {
            let face = self.list[place];
            let inside = face.numbers().iter().filter(|&&corner| cut.keeps(corner)).count();
            if inside > 0 {
                self.list[kept] = if inside < face.count { self.cut_face(&face, &mut cut)? } else { face };
                kept += 1;
            }
        }
        self.count = kept;
        self.close(n, &cut)
    }

    /// The part of a face below the plane.
    fn cut_face(&mut self, face: &NumberedFace, cut: &mut Cut<POINTS>) -> Option<NumberedFace> {
        let mut left = NumberedFace::new(face.normal, face.moves);
        for (corner, following) in face.edges() {
            if cut.keeps(corner) {
                left.push(corner)?;
            }
            match [corner, following].map(|end| cut.keeps(end)) {
                [true, false] => left.push(self.crossing([corner, following], cut)?)?,
                [false, true] => left.push(self.crossing([following, corner], cut)?)?,
                _ => {}
            }
        }
        // The closing polygon has the edges in the plane the other way round.
        let in_plane = left.edges().filter(|(a, b)| usize::from(*a.min(b)) >= cut.first);
        in_plane.for_each(|(a, b)| cut.next[usize::from(b)] = a);
        Some(left)
    }

    /// The number of the point where the plane meets an edge; both faces at the edge share it.
    fn crossing(&mut self, ends: [u8; 2], cut: &mut Cut<POINTS>) -> Option<u8> {
        let made = self.used - cut.first;
        if let Some(known) = cut.ends[..made].iter().position(|known| *known == ends) {
            return Some((cut.first + known) as u8);
        }
        *cut.ends.get_mut(made)? = ends;
        let [inner, outer] = ends.map(usize::from);
        let part = cut.above[inner] / (cut.above[inner] - cut.above[outer]);
        self.add_point(self.points[inner] + part * (self.points[outer] - self.points[inner]))
    }

    /// Closes the solid by polygons of the points in the plane.
    fn close(&mut self, n: &Vec3, cut: &Cut<POINTS>) -> Option<()> {
        let mut is_done = [false; POINTS];
        for start in cut.first..self.used {
            if is_done[start] {
                continue;
            }
            let face = self.add_face(*n, false)?;
            let mut at = start;
            while !is_done[at] {
                is_done[at] = true;
                face.push(at as u8)?;
                at = usize::from(cut.next[at]);
            }
            // Two faces that share two corners close each other.
            self.count -= usize::from(face.count < 3);
        }
        Some(())
    }

    /// Numbers anew the points that faces still have.
    fn forget_points(&mut self) {
        let (mut numbers, mut kept) = ([None; POINTS], 0);
        let points = self.points;
        for face in &mut self.list[..self.count] {
            for corner in &mut face.corners[..face.count] {
                let old = usize::from(*corner);
                *corner = *numbers[old].get_or_insert_with(|| {
                    self.points[kept] = points[old];
                    kept += 1;
                    (kept - 1) as u8
                });
            }
        }
        self.used = kept;
    }
}

impl<'a> ClippedFace<'a> {
    /// Its corners, counter-clockwise about the normal.
    pub fn corners(self) -> impl Iterator<Item = Vec3> + 'a {
        self.numbers.iter().map(|&k| self.points[usize::from(k)])
    }

    /// The triangles about its first corner that make it up.
    fn triangles(self) -> impl Iterator<Item = [Vec3; 3]> + 'a {
        let corner = move |k: usize| self.points[usize::from(self.numbers[k])];
        (1..self.numbers.len().max(2) - 1).map(move |k| [corner(0), corner(k), corner(k + 1)])
    }

    /// The integrals of q dS and q x dS over the face, exact for q of the second degree.
    pub fn integral(self, q: &impl Fn(&Vec3) -> f64) -> (f64, Vec3) {
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

impl<const FACES: usize, const POINTS: usize> Faces<FACES, POINTS> {
    /// The faces of the solid.
    pub fn iter(&self) -> impl Iterator<Item = ClippedFace<'_>> {
        self.list[..self.count].iter().map(|face| {
            let (points, numbers) = (&self.points[..], face.numbers());
            ClippedFace { points, numbers, normal: face.normal, moves: face.moves }
        })
    }

    /// Volume, centre and variance; `None` where there is no volume.
    pub fn moments(&self) -> Option<SolidMoments> {
        let (mut sum, mut count) = (Vec3::zeros(), 0);
        for face in self.iter() {
            face.corners().for_each(|x| sum += x);
            count += face.numbers.len();
        }
        let middle = sum / count.max(1) as f64;
        SolidMoments::of(self.iter().flat_map(ClippedFace::triangles), &middle)
    }
}
