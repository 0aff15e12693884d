//! Rayleigh's α: forces −α M v on masses, v relative to the frame that the supports of a structure move.

use super::inertia::{ConsistentMass, Inertia};
use base::math::{Mat3, Vec3, Vec6, angular, linear, skew, stack};
use mechanics::elements::{Force, subtract};
use mechanics::state::Node;
use model::{Model, MovingFrame, MovingFrames};

/// The damping of masses.
#[derive(Debug, Clone, Default)]
pub struct MassDamping {
    /// α of masses without a separate factor, per time.
    pub alpha: f64,
    acts: bool,
    frames: MovingFrames,
}

impl MassDamping {
    /// The damping of a model.
    pub fn of(model: &Model) -> MassDamping {
        let alpha = model.damping.mass_factor;
        let own = |part: &model::Part| part.mass_kind().and(part.own_damping().alpha).unwrap_or(0.0) > 0.0;
        let acts = alpha > 0.0 || model.parts.iter().any(own);
        MassDamping { alpha, acts, frames: model.damping.frames.clone() }
    }

    /// True where any mass is damped.
    #[inline]
    pub fn acts(&self) -> bool {
        self.acts
    }

    /// The linear and angular velocity of the moving frame at a node.
    #[inline]
    pub fn carried(&self, node: usize, nodes: &[Node]) -> [Vec3; 2] {
        match self.frames.of(node) {
            None => [Vec3::zeros(); 2],
            Some(frame) => carried(frame, nodes, &nodes[node].x),
        }
    }

    /// The velocities of a node relative to its frame.
    #[inline]
    pub fn relative(&self, node: usize, nodes: &[Node]) -> [Vec3; 2] {
        let own = [nodes[node].v, nodes[node].omega];
        match self.frames.of(node) {
            None => own,
            Some(frame) => {
                let [v, omega] = carried(frame, nodes, &nodes[node].x);
                [own[0] - v, own[1] - omega]
            }
        }
    }

    /// Subtracts the force and the moment on the inertia of a node from `f`.
    #[inline]
    pub fn add(&self, inertia: &Inertia, nodes: &[Node], f: &mut Force) {
        let [v, omega] = self.relative(inertia.node, nodes);
        let (mass, J) = inertia.drag(&nodes[inertia.node], self.alpha);
        subtract(f, 0, &(mass * v));
        if let Some(J) = J {
            subtract(f, 3, &(J * omega));
        }
    }

    /// The derivative of the force on a mass by its place, with the sign of a stiffness, where its frame turns.
    pub fn by_place(&self, inertia: &Inertia, nodes: &[Node]) -> Option<Mat3> {
        self.frames.of(inertia.node)?.rotation?;
        let [_, omega] = self.carried(inertia.node, nodes);
        Some(-inertia.drag(&nodes[inertia.node], self.alpha).0 * skew(&omega))
    }

    /// The power dissipated by damping in the motion relative to the frames, and the power put in by the moving frames.
    pub fn powers(&self, (inertias, masses): (&[Inertia], &[ConsistentMass]), nodes: &[Node]) -> [f64; 2] {
        let mut sums = [0.0; 2];
        if !self.acts {
            return sums;
        }
        for inertia in inertias {
            let node = inertia.node;
            let ([v, omega], [v0, omega0]) = (self.relative(node, nodes), self.carried(node, nodes));
            let (mass, J) = inertia.drag(&nodes[node], self.alpha);
            sums[0] += mass * v.norm_squared();
            sums[1] -= mass * v.dot(&v0);
            if let Some(J) = J {
                let moment = J * omega;
                sums[0] += omega.dot(&moment);
                sums[1] -= omega0.dot(&moment);
            }
        }
        for mass in masses {
            for (a, b, m) in mass.pairs() {
                let force = mass.alpha * m * self.relative(b, nodes)[0];
                sums[0] += self.relative(a, nodes)[0].dot(&force);
                sums[1] -= self.carried(a, nodes)[0].dot(&force);
            }
        }
        sums
    }

    /// True where any frame moves.
    pub fn has_frames(&self) -> bool {
        !self.frames.is_empty()
    }

    /// Writes the small motions of the frames at all nodes, from the motions of all nodes.
    pub fn carry(&self, nodes: &[Node], moved: &[Vec6]) -> Vec<Vec6> {
        let at = |node: usize| nodes[node].x;
        let of = |node: usize| [linear(&moved[node]), angular(&moved[node])];
        let carried = |node: usize| {
            let frame = self.frames.of(node)?;
            let [v, omega] = frame.velocity(of, at, &nodes[node].x);
            Some(stack(&v, &omega))
        };
        (0..nodes.len()).map(|node| carried(node).unwrap_or_else(Vec6::zeros)).collect()
    }
}

#[inline]
fn carried(frame: &MovingFrame, nodes: &[Node], x: &Vec3) -> [Vec3; 2] {
    frame.velocity(|node| [nodes[node].v, nodes[node].omega], |node| nodes[node].x, x)
}
