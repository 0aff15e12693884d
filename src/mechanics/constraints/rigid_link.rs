//! A node rigidly attached to a master node, in all or some of its six degrees of freedom (45)-(58).
//!
//! The arm follows the finite rotation of the master exactly, S = R_d S₀, so a rigid link keeps its length. Elimination is x_b = x_d + S,
//! v_b = v_d + ω×S, a_b = a_d + α×S + ω×(ω×S), and Dᵀ transfers forces. Unconstrained degrees of freedom belong to the node. Components are
//! global.

use crate::state::{Increment, Node};
use base::math::rotation::change;
use base::math::{Mat3, Mat6, Vec3, skew};

/// A dependent node and its master.
#[derive(Debug, Clone)]
pub struct RigidLink {
    /// The dependent node.
    pub node: usize,
    /// The node that it depends on.
    pub master: usize,
    /// The first in the chain of masters that is not itself dependent in all degrees of freedom: both have the same
    /// rotation in a step.
    turner: usize,
    /// Vector from master to node in the undeformed state.
    pub S0: Vec3,
    /// Positions of master and node in the undeformed state.
    start: [Vec3; 2],
    /// True for each degree of freedom that follows the master.
    pub dofs: [bool; 6],
    /// True where all six do.
    pub rigid: bool,
}

impl RigidLink {
    /// Links `node` to `master` in the degrees of freedom `dofs`; `x` are the initial positions of all nodes.
    pub fn new(node: usize, master: usize, x: &[Vec3], dofs: [bool; 6]) -> Self {
        let start = [x[master], x[node]];
        let rigid = dofs == [true; 6];
        RigidLink { node, master, turner: master, S0: start[1] - start[0], start, dofs, rigid }
    }

    /// The arm S = R_d S₀, global components.
    #[inline]
    pub fn arm(&self, master: &Node) -> Vec3 {
        self.S0 + change(&master.rotation, &self.S0)
    }

    /// Sets the dependent part of the node's motion from its master. `start` is the node at the start of the step; its
    /// free degrees of freedom have been advanced with its increment already. Where all six depend on the master, the
    /// increment is not written: nobody reads it.
    #[inline]
    pub fn move_with_master(&self, nodes: &mut [Node], increments: &mut [Increment], start: &Node) {
        let master = &nodes[self.master];
        let Node { rotation: q, omega, alpha, .. } = *master;
        // Displacements keep digits that positions lose: u_b = u_d + (R_d − 1) S₀.
        let turned = change(&q, &self.S0);
        let [u, low] = master.parts(&self.start[0]);
        let S = self.S0 + turned;
        let omega_S = omega.cross(&S);
        // (45), (46) with g = ω×(ω×S) (49)
        let v = master.v + omega_S;
        let a = master.a + alpha.cross(&S) + omega.cross(&omega_S);
        if self.rigid {
            let node = &mut nodes[self.node];
            node.place(&self.start[1], &(low + turned), &u);
            (node.rotation, node.v, node.omega, node.a, node.alpha) = (q, v, omega, a, alpha);
            return;
        }
        let mut placed = *master;
        placed.place(&self.start[1], &(low + turned), &u);
        let u = placed.relative_position(start);
        // The rotation vector of a node with free rotations has components of both nodes, and advances like that of other nodes.
        let turn = increments[self.turner];
        let own = &mut increments[self.node];
        for i in 0..3 {
            if self.dofs[i] {
                own.q[i] = u[i];
                own.d[i] = v[i];
                own.dd[i] = a[i];
            }
            if self.dofs[3 + i] {
                own.q[3 + i] = turn.q[3 + i];
                own.d[3 + i] = turn.d[3 + i];
                own.dd[3 + i] = turn.dd[3 + i];
            }
        }
        let own = *own;
        nodes[self.node].advance(start, &own, base::math::rotation::RotationUpdate::Exponential);
        // Positions are written once more, without the rounding of start + (x − start).
        for i in (0..3).filter(|&i| self.dofs[i]) {
            nodes[self.node].x[i] = placed.x[i];
            nodes[self.node].low[i] = placed.low[i];
        }
    }

    /// Transfers the force on the dependent degrees of freedom to the master: F_d += Dᵀ F_b.
    #[inline]
    pub fn transfer_to_masters(&self, nodes: &[Node], F: &mut [[f64; 6]]) {
        let mut f = F[self.node];
        if self.rigid {
            F[self.node] = [0.0; 6];
        } else {
            for i in 0..6 {
                *(if self.dofs[i] { &mut F[self.node][i] } else { &mut f[i] }) = 0.0;
            }
        }
        let S = self.arm(&nodes[self.master]);
        let moment = S.cross(&Vec3::new(f[0], f[1], f[2]));
        let F = &mut F[self.master];
        for i in 0..3 {
            F[i] += f[i];
            F[3 + i] += moment[i] + f[3 + i];
        }
    }

    /// The constraint matrix D (48), which gives rates of the node from rates of the master; rows of free degrees of
    /// freedom are zero.
    pub fn D(&self, nodes: &[Node]) -> Mat6 {
        let mut D = Mat6::identity();
        D.fixed_view_mut::<3, 3>(0, 3).copy_from(&-skew(&self.arm(&nodes[self.master])));
        for i in (0..6).filter(|&i| !self.dofs[i]) {
            D.row_mut(i).fill(0.0);
        }
        D
    }

    /// Derivative of the moment S×f of a force `f` on the node with respect to the rotation of the master, at fixed
    /// `f`.
    pub fn arm_stiffness(&self, nodes: &[Node], f: &Vec3) -> Mat3 {
        let kept = Vec3::from_fn(|i, _| if self.dofs[i] { f[i] } else { 0.0 });
        skew(&kept) * skew(&self.arm(&nodes[self.master]))
    }
}

/// Sorts rigid links so that every master precedes its dependent nodes; `None` for a cycle.
pub fn sorted(mut links: Vec<RigidLink>, nodes: usize) -> Option<Vec<RigidLink>> {
    let mut waiting = vec![false; nodes];
    for a in &links {
        waiting[a.node] = true;
    }
    let mut done: Vec<RigidLink> = Vec::with_capacity(links.len());
    let mut turner: Vec<usize> = (0..nodes).collect();
    while !links.is_empty() {
        let before = done.len();
        let (ready, rest): (Vec<_>, Vec<_>) = links.into_iter().partition(|a| !waiting[a.master]);
        for mut a in ready {
            waiting[a.node] = false;
            a.turner = turner[a.master];
            if a.rigid {
                turner[a.node] = a.turner;
            }
            done.push(a);
        }
        links = rest;
        if done.len() == before && !links.is_empty() {
            return None;
        }
    }
    Some(done)
}
