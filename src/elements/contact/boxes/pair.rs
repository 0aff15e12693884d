//! Boxes on bodies against a box on another body or on the ground: where they lie, and the force between them.

use super::depth::{Depth, SHALLOW, depth};
use super::memory::Memory;
use super::pose::BoxPose;
use super::rubbing::{Rubbing, rubbing};
use crate::elements::contact::history::{self, PointHistory};
use crate::elements::contact::law::ContactLaw;
use crate::elements::contact::restitution::{Loss, NormalForce, normal_force};
use crate::elements::contact::surface::Surface;
use crate::math::{Mat3, Mat6, Vec3, Vec6, stack};
use crate::state::{Configuration, Node};

/// A face that lies on another acts as the four corners it has.
const POINTS: f64 = 4.0;

/// Depth, as a part of their size, at which boxes are taken to rest on each other that were drawn face to face.
const RESTING: f64 = 1e-6;

/// A box that touches another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TouchingBox {
    /// The node of its body, at its centre; its edges lie along the axes of the body.
    pub node: usize,
    /// Half its edges.
    pub half: Vec3,
}

/// Boxes against one box.
pub struct BoxPairs {
    /// The law, for the whole of a face.
    pub(super) law: ContactLaw,
    /// The node that carries the other box.
    pub(super) carrier: usize,
    /// The centre of that box from its node, in the frame of the node.
    pub(super) center: Vec3,
    /// The axes of that box (columns), in the frame of the node.
    pub(super) axes: Mat3,
    /// Half the edges of that box.
    pub(super) half: Vec3,
    /// The boxes that touch it.
    pub(in crate::elements::contact) boxes: Vec<TouchingBox>,
    /// The node of each of these, then the carrier.
    pub(super) nodes: Vec<[usize; 2]>,
}

/// A pair of boxes at an instant. E is the frame of the box that is touched: its columns are its axes, global components.
pub(in crate::elements::contact) struct PairKinematics {
    /// The frame of the box that is touched.
    pub E: Mat3,
    /// Position of the one body less that of the carrier, global components.
    pub d: Vec3,
    /// The position of the one box relative to the other, in E.
    pub pose: BoxPose,
    /// Velocity of the one body relative to the frame E that moves with the carrier, and relative angular velocity, in E.
    pub rates: Vec6,
}

/// The force of a pair at an instant.
pub(in crate::elements::contact) struct PairForce {
    /// The depth D with its derivatives.
    pub depth: Depth,
    /// Ḋ, per time.
    pub rate: f64,
    /// The normal force.
    pub normal: NormalForce,
    /// The friction; `None` where there is none.
    pub rubbing: Option<Rubbing>,
    /// Force and moment on the one body at its node, in E.
    pub W: Vec6,
}

impl BoxPairs {
    /// `None` where the surface is no box. The stiffness and damping of `law` are those of a corner.
    pub fn new(law: ContactLaw, surface: &Surface, carrier: usize, boxes: Vec<TouchingBox>) -> Option<Self> {
        let loss = match law.loss {
            Loss::Damping(c) => Loss::Damping(POINTS * c),
            other => other,
        };
        let nodes = boxes.iter().map(|one| [one.node, carrier]).collect();
        let law = ContactLaw { stiffness: POINTS * law.stiffness, loss, ..law };
        Some(BoxPairs {
            law,
            carrier,
            center: surface.center,
            axes: surface.axes,
            half: surface.as_box()?,
            boxes,
            nodes,
        })
    }

    /// Where the boxes of a pair are to each other, and how they move.
    pub(super) fn kinematics(&self, e: usize, nodes: &[Node]) -> PairKinematics {
        let (one, carrier) = (&nodes[self.boxes[e].node], &nodes[self.carrier]);
        let d = one.relative_position(carrier);
        let R = carrier.R();
        let E = R * self.axes;
        let w = one.v - carrier.v - carrier.omega.cross(&d);
        let rates = stack(&E.tr_mul(&w), &E.tr_mul(&(one.omega - carrier.omega)));
        let y = self.axes.tr_mul(&(R.tr_mul(&d) - self.center));
        let pose = BoxPose { y, Q: E.tr_mul(&one.R()), own: self.boxes[e].half, other: self.half };
        PairKinematics { E, d, pose, rates }
    }

    /// The force of a pair; `None` where it is apart.
    pub(super) fn force(&self, at: &PairKinematics, old: PointHistory) -> Option<PairForce> {
        let depth = depth(&at.pose, self.law.touching)?;
        let rate = depth.g.dot(&at.rates);
        let speed = match old.is_known() {
            true if old.gap() <= 0.0 => old.impact_speed().max(rate),
            true => old.rate().max(rate),
            false => rate,
        };
        let law = &self.law;
        let normal = normal_force(law.stiffness, &law.loss, depth.D, rate, speed);
        let mut W = -normal.force * depth.g;
        let rubs = law.friction > 0.0 && old.is_known();
        let rubbing = rubs.then(|| rubbing(law, &at.pose, &depth, normal.force, &Memory::read(old))).flatten();
        if let Some(rubbing) = &rubbing {
            W += rubbing.W;
        }
        Some(PairForce { depth, rate, normal, rubbing, W })
    }

    /// Derivatives of the force W by the motion (u, ψ) at fixed rates, and by the rates.
    ///
    /// The first are central differences: the solid that the boxes have in common has exact moments and first derivatives, and
    /// differences over a small part of its thickness are exact to some 1e-8, which no formula in closed form would better by much.
    pub(super) fn derivatives(&self, at: &PairKinematics, acting: &PairForce, old: PointHistory) -> [Mat6; 2] {
        let (g, normal) = (&acting.depth.g, &acting.normal);
        let mut by_rates = -normal.by_rate * g * g.transpose();
        if let Some(rubbing) = &acting.rubbing {
            by_rates += normal.by_rate * rubbing.by_N * g.transpose();
        }
        let size = at.pose.size();
        // Boxes that only begin to touch, or are about to part, have the stiffness of the normal force alone.
        let stiffness = || -normal.by_depth * g * g.transpose();
        let (mut at, mut D) = (PairKinematics { ..*at }, acting.depth.D);
        if D < 2.0 * SHALLOW * size {
            if self.law.dynamic {
                return [stiffness(), by_rates];
            }
            // In statics nothing else may hold a box that was put on another: it has the stiffness of one that rests there.
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
        [by_motion, by_rates]
    }

    /// The kinematics of a pair and its force; `None` where it is apart or known to be far.
    pub(in crate::elements::contact) fn touch(
        &self,
        e: usize,
        now: &Configuration,
    ) -> Option<(PairKinematics, PairForce)> {
        let old = self.history(e, now.history);
        if now.dt < old.safe_time() {
            return None;
        }
        let at = self.kinematics(e, now.nodes);
        let force = self.force(&at, old)?;
        Some((at, force))
    }

    /// The number of history variables of a pair.
    pub(super) fn width(&self) -> usize {
        if self.law.friction > 0.0 { super::memory::WIDTH } else { history::FRICTION_FORCE }
    }

    /// The history of a pair, as a part of that of the block.
    pub(in crate::elements::contact) fn history<'a>(&self, e: usize, history: &'a [f64]) -> PointHistory<'a> {
        PointHistory::new(&history[e * self.width()..(e + 1) * self.width()])
    }
}
