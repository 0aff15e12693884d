//! A cylinder against a polyhedron or its equivalent: a half space, or the prism of another cylinder.
//!
//! The depth is defined as for two polyhedra ([`super::volume`]), by the common solid, bounded by plane faces and the round side. By Gauss'
//! theorem for vectors along the axis the round side adds nothing. The moments, and ∂D by a motion of the polyhedron, are therefore sums
//! over the plane faces alone. The prism of another cylinder ([`super::two_cylinders`]) goes along with the contact, and nothing acts about
//! its axis.

use super::bore::Bore;
use super::depth::Depth;
use super::overlap::Faces;
use super::pose::{ConvexPose, LeastAxis};
use super::rim::out_of_rim;
use super::segment::{SegmentPlace, nearest_place};
use super::two_cylinders::TwoCylinders;
use super::volume::Measure;
use base::math::convex::ConvexShape;
use base::math::cylinder::RoundCylinder;
use base::math::polyhedron::{Polyhedron, SolidMoments};
use base::math::{Mat3, Vec3, angular, linear, stack};

/// Most faces, and room for points, of the solid common to a cylinder and a box, most hulls, or the side of another cylinder.
const FEW: (usize, usize) = (28, 96);
/// Room for other pairs.
const MANY: (usize, usize) = (128, 255);

/// A cylinder and something else, in the axes of the cylinder.
pub(super) struct CylinderPose<'a> {
    cylinder: &'a RoundCylinder,
    against: Against<'a>,
    /// Centre of the other.
    y: Vec3,
    /// Columns: axes of the other; a cylinder lies along the third.
    Q: Mat3,
    /// Columns: the axes of the cylinder in those of the pose.
    axes: Mat3,
    /// The centre of the cylinder there.
    center: Vec3,
    /// The centre of the other there.
    origin: Vec3,
    /// True where the one is the cylinder.
    is_own: bool,
}

/// The solid touched by a cylinder.
#[derive(Clone, Copy)]
enum Against<'a> {
    Polyhedron(&'a Polyhedron),
    Cylinder(&'a RoundCylinder),
}

impl<'a> CylinderPose<'a> {
    /// `None` without a cylinder, or where one of the two is round about a segment.
    pub fn of(pose: &ConvexPose<'a>) -> Option<Self> {
        let zero = Vec3::zeros();
        match (pose.own, pose.other) {
            (ConvexShape::Cylinder(own), ConvexShape::Polyhedron(other)) => {
                Some(Self::of_own(pose, own, (Against::Polyhedron(other), zero, Mat3::identity())))
            }
            (ConvexShape::Cylinder(own), ConvexShape::HalfSpace(cube)) => {
                let depth = cube.half().map_or(0.0, |half| half.z);
                let below = Vec3::new(pose.y.x, pose.y.y, -depth);
                Some(Self::of_own(pose, own, (Against::Polyhedron(cube), below, Mat3::identity())))
            }
            // The prism replaces the thinner cylinder: its side curves as much as the common solid is narrow.
            (ConvexShape::Cylinder(own), ConvexShape::Cylinder(other)) if own.radius() < other.radius() => {
                let axes = *other.axes();
                let (y, Q) = (axes.tr_mul(&pose.y), axes.tr_mul(&(pose.Q * own.axes())));
                let (against, center, origin) = (Against::Cylinder(own), zero, pose.y);
                Some(CylinderPose { cylinder: other, against, y, Q, axes, center, origin, is_own: false })
            }
            (ConvexShape::Cylinder(own), ConvexShape::Cylinder(other)) => {
                Some(Self::of_own(pose, own, (Against::Cylinder(other), zero, *other.axes())))
            }
            (ConvexShape::Polyhedron(own), ConvexShape::Cylinder(other)) => {
                let axes = *other.axes();
                let (y, Q) = (axes.tr_mul(&pose.y), axes.tr_mul(&pose.Q));
                let (against, center, origin) = (Against::Polyhedron(own), zero, pose.y);
                Some(CylinderPose { cylinder: other, against, y, Q, axes, center, origin, is_own: false })
            }
            _ => None,
        }
    }

    /// The one, a cylinder, against something with its centre and axes.
    fn of_own(
        pose: &ConvexPose<'a>,
        cylinder: &'a RoundCylinder,
        (against, origin, of_other): (Against<'a>, Vec3, Mat3),
    ) -> Self {
        let axes = pose.Q * cylinder.axes();
        let (y, Q) = (axes.tr_mul(&(origin - pose.y)), axes.tr_mul(&of_other));
        CylinderPose { cylinder, against, y, Q, axes, center: pose.y, origin, is_own: true }
    }

    /// The axis of the largest gap.
    pub fn least_axis(&self) -> LeastAxis {
        let least = match self.against {
            Against::Polyhedron(polyhedron) => self.least_axis_of(polyhedron),
            Against::Cylinder(other) => self.two(other).least_axis(),
        };
        let axis = self.axes * least.axis;
        LeastAxis { axis: if self.is_own { axis } else { -axis }, gap: least.gap }
    }

    fn two(&self, other: &'a RoundCylinder) -> TwoCylinders<'a> {
        TwoCylinders { one: self.cylinder, other, y: self.y, Q: self.Q }
    }

    /// Candidates against a polyhedron: normals of its faces and of the ends of the cylinder, and directions from the cylinder to the
    /// nearest points of edges. In the axes of the cylinder, and toward it.
    fn least_axis_of(&self, polyhedron: &Polyhedron) -> LeastAxis {
        let size = self.cylinder.reach() + polyhedron.reach();
        let mut best = LeastAxis { axis: Vec3::z(), gap: f64::NEG_INFINITY };
        let mut look = |axis: Vec3, gap: f64| {
            // Rounding does not choose between axes that are as good.
            if gap > best.gap + 1e-9 * size {
                best = LeastAxis { axis, gap };
            }
        };
        for face in polyhedron.faces() {
            let axis = self.Q * face.normal;
            look(axis, -self.cylinder.reach_along(&axis) - axis.dot(&self.y) - face.offset);
        }
        let gap = |axis: &Vec3| {
            -self.cylinder.reach_along(axis) - axis.dot(&(self.y + self.Q * polyhedron.farthest(&self.Q.tr_mul(axis))))
        };
        for axis in [Vec3::z(), -Vec3::z()] {
            look(axis, gap(&axis));
        }
        let mut least = f64::INFINITY;
        for edge in polyhedron.edges() {
            let [a, b] = edge.ends.map(|k| self.y + self.Q * polyhedron.corners()[k]);
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
            if let Some(out) =
                out_of_rim(self.cylinder, &(middle + nearest.s * half), &half).filter(|_| nearest.d < 0.0)
            {
                look(-out, gap(&-out));
            }
        }
        best
    }

    /// The depth of two overlapping solids along an axis toward the one; `None` where the common solid vanishes by rounding.
    pub fn depth(&self, axis: &Vec3) -> Option<Depth> {
        // Toward the cylinder, which is the one of two cylinders.
        let toward = self.axes.tr_mul(axis) * if self.is_own { 1.0 } else { -1.0 };
        let origin = self.cylinder.farthest_in_axes(&-toward);
        let few = self.by_moments::<{ FEW.0 }, { FEW.1 }>((&origin, &toward));
        few.or_else(|| self.by_moments::<{ MANY.0 }, { MANY.1 }>((&origin, &toward))).flatten()
    }

    /// The depth along this axis, in coordinates about an origin, with room for FACES and POINTS; `None` if that is too small.
    fn by_moments<const FACES: usize, const POINTS: usize>(
        &self,
        (origin, along): (&Vec3, &Vec3),
    ) -> Option<Option<Depth>> {
        let half = self.cylinder.half();
        let (y, Q) = (self.y - origin, &self.Q);
        let (mut faces, goes_along) = match self.against {
            Against::Polyhedron(polyhedron) => (Faces::<FACES, POINTS>::of(polyhedron, &y, Q)?, false),
            Against::Cylinder(other) => {
                let outline = self.two(other).outline(along);
                (Faces::of_prism(&outline, other.half(), &y, Q)?, !outline.is_fixed)
            }
        };
        faces.cut(&Vec3::z(), half - origin.z)?;
        faces.cut(&-Vec3::z(), half + origin.z)?;
        let mut found = self.of_faces(&faces, origin);
        if let Some(depth) = found.as_mut().filter(|_| goes_along) {
            // Nothing turns that of the prism about its axis.
            let axis = self.axes * Q.column(2);
            let of_other = if self.is_own { self.center.cross(&linear(&depth.g)) } else { Vec3::zeros() };
            let about = axis.dot(&(angular(&depth.g) + of_other));
            depth.g -= stack(&Vec3::zeros(), &(about * axis));
        }
        Some(found)
    }

    /// The depth by the plane faces of the common solid.
    fn of_faces<const FACES: usize, const POINTS: usize>(
        &self,
        faces: &Faces<FACES, POINTS>,
        origin: &Vec3,
    ) -> Option<Depth> {
        let bore = Bore::new(self.cylinder.radius(), origin);
        let (mut middle, mut count) = (Vec3::zeros(), 0.0);
        faces.iter().for_each(|face| {
            bore.each_corner(face, |x| (middle, count) = (middle + x, count + 1.0));
        });
        let mut sums = MomentSums::about(middle / f64::max(count, 1.0));
        faces.iter().for_each(|face| bore.each_point(face, |x, area| sums.add(&x, area * face.normal.z)));
        let measure = Measure::of(&sums.moments()?)?;
        // Force and moment about the centre of the cylinder, in its axes, for a motion of the other.
        let (mut force, mut moment) = (Vec3::zeros(), Vec3::zeros());
        for face in faces.iter().filter(|face| face.moves) {
            bore.each_point(face, |x, area| {
                let share = area * measure.growth(&x) * face.normal;
                force += share;
                moment += (x + origin).cross(&share);
            });
        }
        let (force, moment) = (self.axes * force, self.axes * moment);
        let g = match self.is_own {
            true => -stack(&force, &moment),
            false => stack(&force, &(moment + (self.center - self.origin).cross(&force))),
        };
        let (c, D) = (self.center + self.axes * (origin + measure.mean), measure.D);
        D.is_finite().then_some(Depth { D, g, c, lever: measure.lever })
    }
}

/// Sums over the points of plane faces that give the moments of the solid between them.
struct MomentSums {
    middle: Vec3,
    volume: f64,
    first: Vec3,
    second: Mat3,
}

impl MomentSums {
    /// Starts the sums about a point near the solid.
    fn about(middle: Vec3) -> Self {
        MomentSums { middle, volume: 0.0, first: Vec3::zeros(), second: Mat3::zeros() }
    }

    /// Adds a point with its area across the axis, negative where the face looks down: ∫ f dV is the sum of ∫ f dz over these.
    fn add(&mut self, x: &Vec3, area: f64) {
        let x = x - self.middle;
        let part = area * x.z;
        self.volume += part;
        self.first += part * Vec3::new(x.x, x.y, 0.5 * x.z);
        let (xz, yz) = (0.5 * x.x * x.z, 0.5 * x.y * x.z);
        let zz = x.z * x.z / 3.0;
        self.second += part * Mat3::new(x.x * x.x, x.x * x.y, xz, x.x * x.y, x.y * x.y, yz, xz, yz, zz);
    }

    /// Volume, centre and variance; `None` where there is no volume.
    fn moments(&self) -> Option<SolidMoments> {
        let volume = self.volume;
        let mean = self.first / volume;
        let variance = self.second / volume - mean * mean.transpose();
        (volume > 0.0).then_some(SolidMoments { volume, mean: self.middle + mean, variance })
    }
}
