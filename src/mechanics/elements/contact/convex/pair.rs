//! Two convex solids on two bodies, or on a body and the ground: where they lie, and the force between them.

use super::depth::Depth;
use super::memory::Memory;
use super::pose::{ConvexPose, LeastAxis};
use super::rubbing::{Rubbing, rubbing};
use super::touch::{SHALLOW, depth_along};
use crate::elements::contact::friction::slips;
use crate::elements::contact::history::{self, PairMemory};
use crate::elements::contact::law::ContactLaw;
use crate::elements::contact::pair_block::{PairAction, PairSide};
use crate::elements::contact::restitution::{Loss, NormalForce};
use crate::elements::contact::surface::Surface;
use crate::elements::contact::surfaces::SurfaceShape;
use crate::state::{Configuration, Node};
use base::math::convex::ConvexShape;
use base::math::{Mat3, Mat6, Vec3, Vec6, angular, linear, stack};

/// A face that lies on another acts as the four corners it has.
const POINTS: f64 = 4.0;

/// Assumed depth of solids resting on each other, relative to their size, where they are drawn face to face.
const RESTING: f64 = 1e-6;

/// A convex solid on a body, which touches others.
#[derive(Debug, Clone, PartialEq)]
pub struct ConvexBody {
    /// The node of its body, at its centre.
    pub node: usize,
    /// The shape, in the axes of the body.
    pub shape: ConvexShape,
}

/// A convex solid that is touched.
#[derive(Debug, Clone, PartialEq)]
pub struct CarriedConvex {
    /// The node that carries it.
    pub node: usize,
    /// Its centre from the node, in the frame of the node.
    pub center: Vec3,
    /// Its axes (columns), in the frame of the node.
    pub axes: Mat3,
    /// The shape, in these axes.
    pub shape: ConvexShape,
}

impl CarriedConvex {
    /// The convex solid of a surface, for bodies within `reach`; `None` for a surface without one.
    pub fn of_surface(surface: &Surface, node: usize, reach: f64) -> Option<Self> {
        let half_space = || matches!(surface.shape, SurfaceShape::Plane(_)).then(|| ConvexShape::half_space(reach));
        let shape = surface.as_convex().or_else(half_space)?;
        Some(CarriedConvex { node, center: surface.center, axes: surface.axes, shape })
    }

    /// A touching solid in the role of the touched one.
    pub fn of_body(one: &ConvexBody) -> Self {
        CarriedConvex { node: one.node, center: Vec3::zeros(), axes: Mat3::identity(), shape: one.shape.clone() }
    }
}

/// The law for the whole of a face, of that for a corner.
pub(super) fn law_of_faces(law: ContactLaw) -> ContactLaw {
    let loss = match law.loss {
        Loss::Damping(c) => Loss::Damping(POINTS * c),
        other => other,
    };
    ContactLaw { stiffness: POINTS * law.stiffness, loss, ..law }
}

/// The number of history variables of a pair.
pub(super) fn width(law: &ContactLaw) -> usize {
    history::width(law, super::memory::OWN_NUMBERS)
}

/// Two convex solids and the law between them.
#[derive(Clone, Copy)]
pub(in crate::elements::contact) struct ConvexPair<'a> {
    /// The law, for the whole of a face.
    pub law: &'a ContactLaw,
    /// The one that touches.
    pub one: &'a ConvexBody,
    /// The one that is touched.
    pub other: &'a CarriedConvex,
}

impl ConvexPair<'_> {
    /// The tangential stiffness: with a sphere the stiffness of a point, as in the normal direction.
    fn tangential_stiffness(&self) -> f64 {
        let is_point = self.one.shape.is_sphere() || self.other.shape.is_sphere();
        self.law.stiffness / if is_point { POINTS } else { 1.0 }
    }
}

/// A pair at an instant. E is the frame of the one that is touched: its columns are its axes, global components.
#[derive(Clone, Copy)]
pub(in crate::elements::contact) struct PairKinematics<'a> {
    /// The frame of the one that is touched.
    pub E: Mat3,
    /// Position of the one body less that of the carrier, global components.
    pub d: Vec3,
    /// The position of the one relative to the other, in E.
    pub pose: ConvexPose<'a>,
    /// Velocity of the one body relative to the frame E that moves with the carrier, and relative angular velocity, in E.
    pub rates: Vec6,
}

impl PairKinematics<'_> {
    /// Force and moment on the one body, global components.
    pub fn global(&self, W: &Vec6) -> (Vec3, Vec3) {
        (self.E * linear(W), self.E * angular(W))
    }
}

/// The force of a pair at an instant.
pub(in crate::elements::contact) struct PairForce {
    /// The depth D with its derivatives.
    pub depth: Depth,
    /// Starting depth of the spring.
    pub inset: f64,
    /// Ḋ, per time.
    pub rate: f64,
    /// The normal force.
    pub normal: NormalForce,
    /// The friction; `None` where there is none.
    pub rubbing: Option<Rubbing>,
    /// Force and moment on the one body at its node, in E.
    pub W: Vec6,
}

impl<'a> ConvexPair<'a> {
    /// True where the balls about two bodies do not meet on straight ways from `start` to `end`. False if a ball is not at a node.
    pub fn balls_miss(&self, start: &[Node], end: &[Node]) -> bool {
        let is_ball = !matches!(self.other.shape, ConvexShape::HalfSpace(_)) && self.other.center == Vec3::zeros();
        let between = |nodes: &[Node]| nodes[self.one.node].relative_position(&nodes[self.other.node]);
        let from = between(start);
        is_ball && from.norm() - (between(end) - from).norm() > self.one.shape.reach() + self.other.shape.reach()
    }

    /// Where the two are to each other, and how they move.
    pub fn kinematics(&self, nodes: &[Node]) -> PairKinematics<'a> {
        let (one, carrier) = (&nodes[self.one.node], &nodes[self.other.node]);
        let d = one.relative_position(carrier);
        let R = carrier.R();
        let E = R * self.other.axes;
        let w = one.v - carrier.v - carrier.omega.cross(&d);
        let rates = stack(&E.tr_mul(&w), &E.tr_mul(&(one.omega - carrier.omega)));
        let y = self.other.axes.tr_mul(&(R.tr_mul(&d) - self.other.center));
        let pose = ConvexPose { y, Q: E.tr_mul(&one.R()), own: &self.one.shape, other: &self.other.shape };
        PairKinematics { E, d, pose, rates }
    }

    /// The force; `None` where the two are apart.
    pub fn force(&self, at: &PairKinematics, old: PairMemory) -> Option<PairForce> {
        self.force_along(&at.pose.least_axis_within(self.law.touching), at, old)
    }

    /// The force by the axis of the largest gap; `None` where the two are apart.
    pub fn force_along(&self, least: &LeastAxis, at: &PairKinematics, old: PairMemory) -> Option<PairForce> {
        let depth = depth_along(&at.pose, least, self.law.touching)?;
        let rate = depth.g.dot(&at.rates);
        let law = self.law;
        let inset = old.inset(law);
        let normal = law.press(depth.D - inset, inset, rate, old);
        let mut W = -normal.force * depth.g;
        let rubs = law.friction > 0.0 && old.is_known();
        let rubbing = rubs
            .then(|| {
                let memory = Memory::read(old);
                let mu = law.friction_at(old.slip_speed());
                rubbing((self.tangential_stiffness(), mu), &at.pose, &depth, normal.force, &memory)
            })
            .flatten();
        if let Some(rubbing) = &rubbing {
            W += rubbing.W;
        }
        Some(PairForce { depth, inset, rate, normal, rubbing, W })
    }

    /// Derivatives of the force W by the motion (u, ψ) at fixed rates, and by the rates.
    ///
    /// The first are central differences. Moments and first derivatives of the common solid are exact, so differences over a small part of
    /// its thickness are accurate to 1e-8.
    pub fn derivatives(&self, at: &PairKinematics, acting: &PairForce, old: PairMemory) -> [Mat6; 2] {
        let (g, normal) = (&acting.depth.g, &acting.normal);
        let mut by_rates = -normal.by_rate * g * g.transpose();
        if let Some(rubbing) = &acting.rubbing {
            by_rates += normal.by_rate * rubbing.by_N * g.transpose();
        }
        let size = at.pose.size();
        // A pair that only begins to touch, or is about to part, has the stiffness of the normal force alone.
        let stiffness = || -normal.by_depth * g * g.transpose();
        let (mut at, mut D) = (*at, acting.depth.D);
        if D < 2.0 * SHALLOW * size {
            if self.law.dynamic {
                return [stiffness(), by_rates];
            }
            // In statics this contact may be the only support of a body, so it has the stiffness of a body at rest.
            at.pose = at.pose.pushed_in(&at.pose.least_axis(), RESTING * size);
            D = RESTING * size;
        }
        let h = (1e-4 * D).max(1e-10 * size);
        let mut by_motion = Mat6::zeros();
        for k in 0..6 {
            let step = if k < 3 { h } else { h / size };
            let moved = |step: f64| {
                let pose = at.pose.moved(k, step);
                self.force(&PairKinematics { pose, ..at }, old).map(|force| force.W)
            };
            let (Some(ahead), Some(behind)) = (moved(step), moved(-step)) else { return [stiffness(), by_rates] };
            by_motion.set_column(k, &((ahead - behind) / (2.0 * step)));
        }
        if let (ConvexShape::Cylinder(shape), None) = (&self.one.shape, &acting.rubbing) {
            // Spinning about its own axis changes nothing, where differences leave rounding.
            let axis = at.pose.Q * shape.axes().column(2);
            let spin = stack(&Vec3::zeros(), &axis);
            by_motion -= by_motion * spin * spin.transpose();
        }
        [by_motion, by_rates]
    }

    /// The kinematics and the force; `None` where the two are apart or known to be far.
    pub fn touch(&self, old: PairMemory, now: &Configuration) -> Option<(PairKinematics<'a>, PairForce)> {
        if now.dt < old.safe_time() {
            return None;
        }
        let at = self.kinematics(now.nodes);
        let force = self.force(&at, old)?;
        Some((at, force))
    }

    /// The forces of the pair on its nodes.
    pub fn action(&self, at: &PairKinematics, acting: &PairForce) -> PairAction<'a> {
        let (F, m) = at.global(&acting.W);
        let k = self.law.stiffness;
        let [pull, limit] = acting.rubbing.as_ref().map_or([0.0; 2], |rubbing| [rubbing.pull, rubbing.limit]);
        PairAction {
            sides: [PairSide::of_node(&self.one.node), PairSide::of_node(&self.other.node)],
            F,
            M: [m, -(m + at.d.cross(&F))],
            arm: Vec3::zeros(),
            less: None,
            stored: 0.5 * k * (acting.depth.D - acting.inset).max(0.0).powi(2) + 0.5 * pull * pull / k,
            slips: slips(pull, limit),
        }
    }
}
