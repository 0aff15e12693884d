//! A cylinder against a polyhedron, and against what stands for one: a half space, or the prism around another cylinder.
//!
//! The depth is that of two polyhedra ([`super::volume`]), of what the two have in common, which plane faces and the round side bound. By
//! Gauss' theorem for vectors along the axis, to which the round side adds nothing, its moments are sums over the plane faces alone; and
//! so is ∂D, by a motion of the polyhedron.
//!
//! The prism around another cylinder turns about that one's axis so that the middle of a side faces the first one's centre. So neither resists a
//! spin of the other about its own axis; what turning the prism changes belongs to ∂D.

use super::bore::Bore;
use super::depth::Depth;
use super::overlap::{ClippedFace, Faces};
use super::pose::{ConvexPose, LeastAxis};
use super::segment::{SegmentPlace, nearest_place};
use super::volume::Measure;
use crate::math::convex::ConvexShape;
use crate::math::cylinder::RoundCylinder;
use crate::math::polyhedron::{Polyhedron, SolidMoments};
use crate::math::{Mat3, Vec3, stack};

/// Corners of faces, and faces, of what a cylinder has in common with a box, and with most hulls.
const FEW: (usize, usize) = (12, 16);
/// The same of others.
const MANY: (usize, usize) = (40, 128);
/// Points of the rule over all faces.
const POINTS: usize = 640;
/// Beside the axis of a cylinder, nearer than this part of its radius, what faces its prism turns it by less than it goes about.
const CORE: f64 = 0.05;

/// A cylinder and a polyhedron, in the axes of the cylinder.
pub(super) struct CylinderPose<'a> {
    cylinder: &'a RoundCylinder,
    polyhedron: &'a Polyhedron,
    /// Centre of the polyhedron.
    y: Vec3,
    /// Columns: axes of the polyhedron.
    Q: Mat3,
    /// Columns: the axes of the cylinder in those of the pose.
    axes: Mat3,
    /// The centre of the cylinder there.
    center: Vec3,
    /// The centre of the polyhedron there.
    origin: Vec3,
    /// True where the one is the cylinder.
    is_own: bool,
    /// The other, where that is a cylinder too.
    facing: Option<&'a RoundCylinder>,
}

/// A point of the rule on a face.
#[derive(Clone, Copy)]
struct Sample {
    x: Vec3,
    area: f64,
    /// The normal of the face along the axis.
    along: f64,
    /// The number of the face.
    face: usize,
}

impl<'a> CylinderPose<'a> {
    /// `None` where neither is a cylinder, or one of the two round about a segment.
    pub fn of(pose: &ConvexPose<'a>) -> Option<Self> {
        let zero = Vec3::zeros();
        match (pose.own, pose.other) {
            (ConvexShape::Cylinder(own), ConvexShape::Polyhedron(other)) => {
                Some(Self::of_own(pose, own, (other, zero, Mat3::identity())))
            }
            (ConvexShape::Cylinder(own), ConvexShape::HalfSpace(cube)) => {
                let depth = cube.half().map_or(0.0, |half| half.z);
                let below = Vec3::new(pose.y.x, pose.y.y, -depth);
                Some(Self::of_own(pose, own, (cube, below, Mat3::identity())))
            }
            (ConvexShape::Cylinder(own), ConvexShape::Cylinder(other)) => {
                let across = other.axes().tr_mul(&pose.y);
                let (sine, cosine) = across.y.atan2(across.x).sin_cos();
                let turn = Mat3::new(cosine, -sine, 0.0, sine, cosine, 0.0, 0.0, 0.0, 1.0);
                let facing = Some(&**other);
                let of_prism = Self::of_own(pose, own, (other.prism(), zero, other.axes() * turn));
                Some(CylinderPose { facing, ..of_prism })
            }
            (ConvexShape::Polyhedron(own), ConvexShape::Cylinder(other)) => {
                let axes = *other.axes();
                let (y, Q) = (axes.tr_mul(&pose.y), axes.tr_mul(&pose.Q));
                let (center, origin, is_own, facing) = (zero, pose.y, false, None);
                Some(CylinderPose { cylinder: other, polyhedron: own, y, Q, axes, center, origin, is_own, facing })
            }
            _ => None,
        }
    }

    /// The one, a cylinder, against a polyhedron with its centre and axes.
    fn of_own(
        pose: &ConvexPose,
        cylinder: &'a RoundCylinder,
        (polyhedron, origin, of_polyhedron): (&'a Polyhedron, Vec3, Mat3),
    ) -> Self {
        let axes = pose.Q * cylinder.axes();
        let (y, Q) = (axes.tr_mul(&(origin - pose.y)), axes.tr_mul(&of_polyhedron));
        CylinderPose { cylinder, polyhedron, y, Q, axes, center: pose.y, origin, is_own: true, facing: None }
    }

    /// The axis of the largest gap. Of a cylinder and a polyhedron that is normal to a face of the latter or to an end of the cylinder, or
    /// leads from the cylinder to the nearest point of an edge.
    pub fn least_axis(&self) -> LeastAxis {
        let size = self.cylinder.reach() + self.polyhedron.reach();
        let mut best = LeastAxis { axis: Vec3::z(), gap: f64::NEG_INFINITY };
        let mut look = |axis: Vec3, gap: f64| {
            // Rounding does not choose between axes that are as good.
            if gap > best.gap + 1e-9 * size {
                best = LeastAxis { axis, gap };
            }
        };
        let reach = |axis: &Vec3| self.cylinder.radius() * axis.x.hypot(axis.y) + self.cylinder.half() * axis.z.abs();
        for face in self.polyhedron.faces() {
            let axis = self.Q * face.normal;
            look(axis, -reach(&axis) - axis.dot(&self.y) - face.offset);
        }
        let gap =
            |axis: &Vec3| -reach(axis) - axis.dot(&(self.y + self.Q * self.polyhedron.farthest(&self.Q.tr_mul(axis))));
        for axis in [Vec3::z(), -Vec3::z()] {
            look(axis, gap(&axis));
        }
        let mut least = f64::INFINITY;
        for edge in self.polyhedron.edges() {
            let [a, b] = edge.ends.map(|k| self.y + self.Q * self.polyhedron.corners()[k]);
            let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
            let at = |s: f64| {
                let (d, n) = self.cylinder.distance_in_axes(&(middle + s * half));
                SegmentPlace { s, d, n }
            };
            if at(0.0).d - half.norm() > least.max(0.0) {
                continue;
            }
            let nearest = nearest_place(&half, at);
            least = least.min(nearest.d);
            let axis = -nearest.n;
            look(axis, gap(&axis));
            if let Some(out) = self.out_of_rim(&(middle + nearest.s * half), &half).filter(|_| nearest.d < 0.0) {
                look(-out, gap(&-out));
            }
        }
        let axis = self.axes * best.axis;
        LeastAxis { axis: if self.is_own { axis } else { -axis }, gap: best.gap }
    }

    /// The direction across an edge that goes `along` through a point within the cylinder, and across its rim, in which the way out is least; `None` where
    /// the edge leaves by the side or by an end.
    fn out_of_rim(&self, x: &Vec3, along: &Vec3) -> Option<Vec3> {
        let e = along.normalize();
        let out = Vec3::new(x.x, x.y, 0.0).try_normalize(0.0)?;
        let end = Vec3::z() * 1f64.copysign(x.z);
        let (rise, away) = (end.dot(&e), out.dot(&e));
        if rise * away >= 0.0 {
            return None;
        }
        let mut n = ((rise * out - away * end) * rise.signum()).normalize();
        // Newton's method for the largest n · x less how far the cylinder reaches along n.
        for _ in 0..4 {
            let turned = e.cross(&n);
            let over = x - self.cylinder.farthest_in_axes(&n);
            let around = Vec3::new(-n.y, n.x, 0.0).dot(&turned);
            let bend = -over.dot(&n) - self.cylinder.radius() * around * around / n.x.hypot(n.y).powi(3);
            if bend.is_nan() || bend >= 0.0 {
                break;
            }
            let (sine, cosine) = (-over.dot(&turned) / bend).sin_cos();
            n = cosine * n + sine * turned;
        }
        Some(n)
    }

    /// The depth of two that overlap along an axis toward the one; `None` where rounding leaves nothing of what they have in common.
    pub fn depth(&self, axis: &Vec3) -> Option<Depth> {
        let out = self.axes.tr_mul(axis);
        let origin = self.cylinder.farthest_in_axes(&if self.is_own { -out } else { out });
        let few = self.by_moments::<{ FEW.0 }, { FEW.1 }>(&origin);
        few.or_else(|| self.by_moments::<{ MANY.0 }, { MANY.1 }>(&origin)).flatten()
    }

    /// The same in coordinates about an origin, with room for so many faces; `None` where that is too little.
    fn by_moments<const CORNERS: usize, const FACES: usize>(&self, origin: &Vec3) -> Option<Option<Depth>> {
        let half = self.cylinder.half();
        let mut faces = Faces::<CORNERS, FACES>::of(self.polyhedron, &(self.y - origin), &self.Q)?;
        faces.cut(&Vec3::z(), half - origin.z)?;
        faces.cut(&-Vec3::z(), half + origin.z)?;
        let bore = Bore::new(self.cylinder.radius(), origin);
        let nothing = Sample { x: Vec3::zeros(), area: 0.0, along: 0.0, face: 0 };
        let (mut samples, mut count) = ([nothing; POINTS], 0);
        for (number, face) in faces.iter().enumerate() {
            bore.each_point(face, |x, area| {
                if let Some(sample) = samples.get_mut(count) {
                    *sample = Sample { x, area, along: face.normal.z, face: number };
                }
                count += 1;
            });
        }
        let samples = samples.get(..count)?;
        let normals = |sample: &Sample| -> Option<&ClippedFace<CORNERS>> {
            faces.iter().nth(sample.face).filter(|face| face.moves)
        };
        Some(self.of_samples(samples, origin, |sample| normals(sample).map(|face| face.normal)))
    }

    /// The depth by the points of all faces; `moving` tells the normal of those of the polyhedron.
    fn of_samples(&self, samples: &[Sample], origin: &Vec3, moving: impl Fn(&Sample) -> Option<Vec3>) -> Option<Depth> {
        let measure = Measure::of(&moments(samples)?)?;
        // Force and moment about the centre of the cylinder, in its axes, for a motion of the polyhedron.
        let (mut force, mut moment) = (Vec3::zeros(), Vec3::zeros());
        for sample in samples {
            let Some(normal) = moving(sample) else { continue };
            let share = sample.area * measure.growth(&sample.x) * normal;
            force += share;
            moment += (sample.x + origin).cross(&share);
        }
        let (force, moment) = (self.axes * force, self.axes * moment);
        let mut g = match self.is_own {
            true => -stack(&force, &moment),
            false => stack(&force, &(moment + (self.center - self.origin).cross(&force))),
        };
        if let Some(facing) = self.facing {
            let axis = facing.axes().column(2).into_owned();
            let away = self.center - axis.dot(&self.center) * axis;
            // By a turn of the prism alone: as by the opposite one of all else.
            let by_turn = -axis.dot(&(-moment - self.center.cross(&force)));
            let core = CORE * facing.radius();
            let by_y = by_turn / away.norm_squared().max(core * core) * axis.cross(&away);
            g += stack(&by_y, &Vec3::zeros());
        }
        let c = self.center + self.axes * (origin + measure.mean);
        let D = measure.D;
        D.is_finite().then_some(Depth { D, g, c, lever: measure.lever })
    }
}

/// Volume, centre and variance of the solid whose plane faces have these points; `None` where there is no volume.
fn moments(samples: &[Sample]) -> Option<SolidMoments> {
    let middle = samples.iter().map(|sample| sample.x).sum::<Vec3>() / samples.len().max(1) as f64;
    let (mut volume, mut first, mut second) = (0.0, Vec3::zeros(), Mat3::zeros());
    for Sample { x, area, along, .. } in samples {
        let x = x - middle;
        // ∫ f dV is the sum of ∫f dz n_z dA.
        let part = area * along * x.z;
        volume += part;
        first += part * Vec3::new(x.x, x.y, 0.5 * x.z);
        let (xz, yz) = (0.5 * x.x * x.z, 0.5 * x.y * x.z);
        let zz = x.z * x.z / 3.0;
        second += part * Mat3::new(x.x * x.x, x.x * x.y, xz, x.x * x.y, x.y * x.y, yz, xz, yz, zz);
    }
    let mean = first / volume;
    let variance = second / volume - mean * mean.transpose();
    (volume > 0.0).then_some(SolidMoments { volume, mean: middle + mean, variance })
}
