//! The part of a plane face that lies in a circular cylinder, by points of a quadrature rule.
//!
//! Lines and arcs of an ellipse bound it. Cones from one apex over short pieces of these fill it: Gauss' rule along a piece, and the rule
//! for the weight r from the apex outward. Polynomials of third degree are exact over straight pieces, and exact to rounding over quarter
//! arcs.

use super::overlap::{ClippedFace, MOST_CORNERS};
use base::math::Vec3;
use base::math::quadrature::gauss;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Lines that come no deeper into the cylinder than by the square root of this, as a part of the radius, pass it by. All arcs then are a
/// little shorter than a whole turn, and longer than none.
const GRAZING: f64 = 1e-14;
/// Turns within this of none or of a whole one are rounding.
const ROUNDING: f64 = 1e-7;
/// A face along the axis to this meets the cylinder in straight lines.
const STRAIGHT: f64 = 1e-9;
/// Points of the rule along arcs.
const ALONG_ARCS: usize = 8;

/// A circular cylinder without ends along the third axis.
pub(super) struct Bore {
    radius: f64,
    /// The origin of the coordinates, from the axis; its third component does not matter.
    origin: Vec3,
    /// The square of its distance from the axis, less that of the radius.
    excess: f64,
}

impl Bore {
    /// A bore with a radius, in coordinates about `origin`, given from the axis.
    pub fn new(radius: f64, origin: &Vec3) -> Self {
        let rho = origin.x.hypot(origin.y);
        Bore { radius, origin: *origin, excess: (rho - radius) * (rho + radius) }
    }

    /// The square of the distance from the axis, less that of the radius.
    fn excess(&self, x: &Vec3) -> f64 {
        x.x * (2.0 * self.origin.x + x.x) + x.y * (2.0 * self.origin.y + x.y) + self.excess
    }

    /// The part of a segment that lies inside, from 0 to 1.
    fn span(&self, from: &Vec3, to: &Vec3) -> Option<[f64; 2]> {
        let way = to - from;
        let squared = way.x * way.x + way.y * way.y;
        if squared <= 1e-26 * way.norm_squared() {
            return (self.excess(from) < 0.0).then_some([0.0, 1.0]);
        }
        let s = -((self.origin.x + from.x) * way.x + (self.origin.y + from.y) * way.y) / squared;
        let excess = self.excess(&(from + s * way));
        if excess >= -GRAZING * self.radius * self.radius {
            return None;
        }
        let half = (-excess / squared).sqrt();
        let (from, to) = ((s - half).max(0.0), (s + half).min(1.0));
        (from < to).then_some([from, to])
    }

    /// Calls `act` with points around the part of a face inside: the ends of its straight pieces, or the centre of a whole ellipse.
    pub fn each_corner(&self, face: ClippedFace, mut act: impl FnMut(Vec3)) {
        let mut room = [Vec3::zeros(); MOST_CORNERS];
        let (corners, mut is_cut) = (&*copied(face, &mut room), false);
        for (from, to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
            if let Some(span) = self.span(from, to) {
                is_cut = true;
                span.into_iter().for_each(|s| act(from + s * (to - from)));
            }
        }
        if !is_cut && let Some(center) = self.center_of_whole(corners, &face.normal) {
            act(center);
        }
    }

    /// Calls `act` with the points of the rule and their areas, over the part of a face inside.
    pub fn each_point(&self, face: ClippedFace, mut act: impl FnMut(Vec3, f64)) {
        let (mut room, normal) = ([Vec3::zeros(); MOST_CORNERS], face.normal);
        let corners = copied(face, &mut room);
        let area = twice_area(corners, &normal);
        // Rounding may turn a face that is hardly wider than a line round; its area then is negative.
        if area < 0.0 {
            corners.reverse();
        }
        let sign = if area < 0.0 { -1.0 } else { 1.0 };
        let mut act = |x: Vec3, area: f64| act(x, sign * area);
        let corners = &*corners;
        let mut pieces = [[Vec3::zeros(); 2]; MOST_CORNERS];
        let mut count = 0;
        for (k, from) in corners.iter().enumerate() {
            let to = &corners[(k + 1) % corners.len()];
            let Some([a, b]) = self.span(from, to) else { continue };
            let at = |s: f64| if s == 1.0 { *to } else { from + s * (to - from) };
            pieces[count] = [at(a), at(b)];
            count += 1;
        }
        let Some([first, _]) = pieces[..count].first().copied() else {
            return self.whole(corners, &normal, &mut act);
        };
        for (k, [from, to]) in pieces[..count].iter().enumerate() {
            let cone = Cone { apex: first, normal };
            let half = 0.5 * (to - from);
            for (x, weight) in gauss(2).0.iter().zip(gauss(2).1) {
                cone.each_point(&(from + half * (1.0 + x)), &(half * *weight), &mut act);
            }
            let next = pieces[(k + 1) % count][0];
            if next != *to {
                self.arc(&cone, to, &next, &mut act);
            }
        }
    }

    /// The centre of the ellipse, if all of the ellipse lies in the face.
    fn center_of_whole(&self, corners: &[Vec3], normal: &Vec3) -> Option<Vec3> {
        let corner = corners.first().filter(|_| normal.z.abs() > STRAIGHT)?;
        let mut center = Vec3::new(-self.origin.x, -self.origin.y, corner.z);
        center.z += normal.dot(&(corner - center)) / normal.z;
        // A face that rounding reduced to a line or a point has no inside.
        let doubled = twice_area(corners, normal).abs();
        if doubled * normal.z.abs() < TAU * self.radius * self.radius {
            return None;
        }
        let is_within = |(a, b): (&Vec3, &Vec3)| (b - a).cross(&(center - a)).dot(normal) >= 0.0;
        corners.iter().zip(corners.iter().cycle().skip(1)).all(is_within).then_some(center)
    }

    /// The whole of the ellipse.
    fn whole(&self, corners: &[Vec3], normal: &Vec3, act: &mut impl FnMut(Vec3, f64)) {
        let Some(center) = self.center_of_whole(corners, normal) else { return };
        let mut start = center + Vec3::new(self.radius, 0.0, 0.0);
        start.z -= normal.x / normal.z * self.radius;
        self.turn(&Cone { apex: center, normal: *normal }, &start, 0.0, TAU.copysign(normal.z), act);
    }

    /// The arc from one point to another, counter-clockwise about the normal.
    fn arc(&self, cone: &Cone, from: &Vec3, to: &Vec3, act: &mut impl FnMut(Vec3, f64)) {
        let angle = |x: &Vec3| (self.origin.y + x.y).atan2(self.origin.x + x.x);
        let side = 1f64.copysign(cone.normal.z);
        let turn = (side * (angle(to) - angle(from))).rem_euclid(TAU);
        let is_straight = cone.normal.z.abs() <= STRAIGHT || !(ROUNDING..=TAU - ROUNDING).contains(&turn);
        if is_straight {
            let half = 0.5 * (to - from);
            for (x, weight) in gauss(2).0.iter().zip(gauss(2).1) {
                cone.each_point(&(from + half * (1.0 + x)), &(half * *weight), act);
            }
            return;
        }
        self.turn(cone, from, angle(from), side * turn, act);
    }

    /// The arc that begins at a point of this angle, and goes on by a turn.
    fn turn(&self, cone: &Cone, from: &Vec3, start: f64, turn: f64, act: &mut impl FnMut(Vec3, f64)) {
        let (points, weights) = gauss(ALONG_ARCS);
        let n = &cone.normal;
        let pieces = (turn.abs() / FRAC_PI_2).ceil().max(1.0);
        let half = 0.5 * turn / pieces;
        for piece in 0..pieces as usize {
            for (x, weight) in points.iter().zip(weights) {
                let ahead = half * ((2 * piece + 1) as f64 + x);
                let (sine, cosine) = (start + ahead).sin_cos();
                let (between_sine, between_cosine) = (start + 0.5 * ahead).sin_cos();
                let chord = 2.0 * self.radius * (0.5 * ahead).sin();
                // Along the axis as the plane of the face goes.
                let in_face = |x: f64, y: f64| Vec3::new(x, y, -(n.x * x + n.y * y) / n.z);
                let way = in_face(-chord * between_sine, chord * between_cosine);
                let along = in_face(-self.radius * sine, self.radius * cosine);
                cone.each_point(&(from + way), &(half * *weight * along), act);
            }
        }
    }
}

/// The corners of a face in a row.
fn copied<'r>(face: ClippedFace, room: &'r mut [Vec3; MOST_CORNERS]) -> &'r mut [Vec3] {
    let mut count = 0;
    for (room, corner) in room.iter_mut().zip(face.corners()) {
        *room = corner;
        count += 1;
    }
    &mut room[..count]
}

/// Twice the area of a polygon, below zero where it goes clockwise about the normal.
fn twice_area(corners: &[Vec3], normal: &Vec3) -> f64 {
    let from_first = |k: usize| corners[k] - corners[0];
    (2..corners.len()).map(|k| from_first(k - 1).cross(&from_first(k)).dot(normal)).sum()
}

/// The cones of a face.
struct Cone {
    apex: Vec3,
    normal: Vec3,
}

impl Cone {
    /// The two points between the apex and a place of the boundary, `along` which a piece of it runs.
    fn each_point(&self, place: &Vec3, along: &Vec3, act: &mut impl FnMut(Vec3, f64)) {
        /// Points and weights of ∫₀¹ f(r) r dr, exact for f of the third degree.
        const OUTWARD: [(f64, f64); 2] =
            [(0.355_051_025_721_682_2, 0.181_958_618_256_022_8), (0.844_948_974_278_317_8, 0.318_041_381_743_977_2)];
        let out = place - self.apex;
        let area = out.cross(along).dot(&self.normal);
        if area != 0.0 {
            OUTWARD.iter().for_each(|(r, weight)| act(self.apex + *r * out, weight * area));
        }
    }
}
