//! A node that rides on another, in all or some of its six directions, at the end of a rigid arm (45)-(58).
//!
//! The arm follows the finite rotation of its master exactly, S = R_d S₀, so a rigid link keeps its length. Elimination
//! is x_b = x_d + S, v_b = v_d + ω×S, a_b = a_d + α×S + ω×(ω×S); forces go the other way by Dᵀ. Directions that are not
//! constrained remain the node's own. Components are global.

use crate::math::rotation::change;
use crate::math::{Mat3, Mat6, Vec3, Vec6, bottom, join, skew, top};
use crate::state::{Increment, Node};

/// A node on its master.
#[derive(Debug, Clone)]
pub struct Attachment {
    pub node: usize,
    pub master: usize,
    /// From master to node in the undeformed state.
    pub S0: Vec3,
    /// Where master and node lay then.
    start: [Vec3; 2],
    /// Directions taken from the master.
    pub dofs: [bool; 6],
    /// All six are.
    pub rigid: bool,
}

impl Attachment {
    /// `x`: initial positions of all nodes.
    pub fn new(node: usize, master: usize, x: &[Vec3], dofs: [bool; 6]) -> Self {
        let start = [x[master], x[node]];
        Attachment { node, master, S0: start[1] - start[0], start, dofs, rigid: dofs == [true; 6] }
    }

    #[inline]
    pub fn arm(&self, master: &Node) -> Vec3 {
        master.R() * self.S0
    }

    /// Sets the constrained part of the node's motion from its master. `start` is the node at the start of the step;
    /// the free directions have been advanced with `increment` already.
    #[inline]
    pub fn follow(&self, nodes: &mut [Node], increments: &mut [Increment], start: &Node) {
        let master = nodes[self.master];
        let S = self.arm(&master);
        let omega_S = master.omega.cross(&S);
        // (45), (46) with g = ω×(ω×S) (49)
        let mut placed = Node { v: master.v + omega_S, ..master };
        // By displacements, whose digits the position does not have: u_b = u_d + (R_d − 1) S₀.
        let [u, low] = master.parts(&self.start[0]);
        placed.place(&self.start[1], &(low + change(&master.q, &self.S0)), &u);
        let u = placed.seen_from(start);
        let a = master.a + master.alpha.cross(&S) + master.omega.cross(&omega_S);
        if self.rigid {
            nodes[self.node] = Node { a, ..placed };
            let turn = &increments[self.master];
            increments[self.node] = Increment {
                q: join(&u, &bottom(&turn.q)),
                d: join(&placed.v, &bottom(&turn.d)),
                dd: join(&a, &bottom(&turn.dd)),
            };
            return;
        }
        // The rotation of a node with some directions of its own is put together from components of the step's rotation
        // vector, then advanced like any other.
        let turn = increments[self.master];
        let own = &mut increments[self.node];
        for i in 0..3 {
            if self.dofs[i] {
                own.q[i] = u[i];
                own.d[i] = placed.v[i];
                own.dd[i] = a[i];
            }
            if self.dofs[3 + i] {
                own.q[3 + i] = turn.q[3 + i];
                own.d[3 + i] = turn.d[3 + i];
                own.dd[3 + i] = turn.dd[3 + i];
            }
        }
        let own = *own;
        nodes[self.node].advance(start, &own, crate::math::rotation::RotationUpdate::Exponential);
        // Positions once more, without the rounding of start + (x − start).
        for i in (0..3).filter(|&i| self.dofs[i]) {
            nodes[self.node].x[i] = placed.x[i];
            nodes[self.node].low[i] = placed.low[i];
        }
    }

    /// Hands the force on the constrained directions over to the master: F_d += Dᵀ F_b.
    #[inline]
    pub fn lift(&self, nodes: &[Node], F: &mut [[f64; 6]]) {
        let S = self.arm(&nodes[self.master]);
        let mut f = Vec6::from(F[self.node]);
        for i in 0..6 {
            if self.dofs[i] {
                F[self.node][i] = 0.0;
            } else {
                f[i] = 0.0;
            }
        }
        let moment = S.cross(&top(&f)) + bottom(&f);
        for i in 0..3 {
            F[self.master][i] += f[i];
            F[self.master][3 + i] += moment[i];
        }
    }

    /// The constrained rows of D (48): rates of the node from rates of the master.
    pub fn D(&self, nodes: &[Node]) -> Mat6 {
        let mut D = Mat6::identity();
        D.fixed_view_mut::<3, 3>(0, 3).copy_from(&-skew(&self.arm(&nodes[self.master])));
        for i in (0..6).filter(|&i| !self.dofs[i]) {
            D.row_mut(i).fill(0.0);
        }
        D
    }

    /// Derivative of the moment S×f of a force on the node with respect to the rotation of the master, at fixed f.
    pub fn arm_stiffness(&self, nodes: &[Node], f: &Vec3) -> Mat3 {
        let kept = Vec3::from_fn(|i, _| if self.dofs[i] { f[i] } else { 0.0 });
        skew(&kept) * skew(&self.arm(&nodes[self.master]))
    }
}

/// Attachments in an order in which every master comes before its riders; `None` where there is a cycle.
pub fn sorted(mut attachments: Vec<Attachment>, nodes: usize) -> Option<Vec<Attachment>> {
    let mut waiting = vec![false; nodes];
    for a in &attachments {
        waiting[a.node] = true;
    }
    let mut done = Vec::with_capacity(attachments.len());
    while !attachments.is_empty() {
        let before = done.len();
        let (ready, rest): (Vec<_>, Vec<_>) = attachments.into_iter().partition(|a| !waiting[a.master]);
        for a in &ready {
            waiting[a.node] = false;
        }
        done.extend(ready);
        attachments = rest;
        if done.len() == before && !attachments.is_empty() {
            return None;
        }
    }
    Some(done)
}
