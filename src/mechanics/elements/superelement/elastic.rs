//! Elastic and viscous forces of a superelement, and their tangent.
//!
//! With g = K q + C q̇ the virtual work is g·δq, where δu_i = d_i − φ × z_i, δψ_i = T⁻¹(ψ_i) (θ_i − φ), and φ is the turn of the frame. So
//! with m_i = T⁻ᵀ(ψ_i) g_ψ, h = Σ z_i × g_i + m_i and b = G⁻¹ h, the forces are f_i = g_i − ½ b × Y_i and the moments m_i − λ H_iᵀ b.

use super::frame::{FloatingFrame, half_trace_less};
use super::second_order::SecondOrderMemory;
use super::{FloatingElement, Scratch, add_multiple, add_three, multiply, set_three, three};
use crate::elements::block::{Branches, Elements, Force, Mechanics, Moduli, Results, subtract};
use crate::state::{Configuration, Node};
use base::math::rotation::{inverse_tangent, inverse_tangent_change, inverse_tangent_matrix};
use base::math::{Mat3, Vec3, skew};

/// A superelement as a block of one element.
pub struct SuperelementBlock(pub FloatingElement);

impl FloatingElement {
    /// Places the frame.
    pub(super) fn place(&self, nodes: &[Node], frame: &mut FloatingFrame) {
        frame.place(|i| &nodes[self.data.nodes[i]], &self.Y, self.turning);
    }

    /// Writes q.
    pub(super) fn displacements(&self, nodes: &[Node], frame: &FloatingFrame, q: &mut [f64]) {
        for (i, Y) in self.Y.iter().enumerate() {
            set_three(q, 6 * i, &(frame.z[i] - Y));
            set_three(q, 6 * i + 3, &frame.psi[i]);
        }
        self.each_amplitude(|k, i| q[k] = nodes[self.data.nodes[i]].moved(&self.x[i]).x);
    }

    /// Writes velocities along the axes of the frame, and returns the angular velocity of the frame.
    pub(super) fn velocities(&self, nodes: &[Node], frame: &FloatingFrame, w: &mut [f64]) -> Vec3 {
        for i in 0..self.data.interface {
            let node = &nodes[self.data.nodes[i]];
            set_three(w, 6 * i, &frame.R.tr_mul(&node.v));
            set_three(w, 6 * i + 3, &frame.R.tr_mul(&node.omega));
        }
        self.each_amplitude(|k, i| w[k] = nodes[self.data.nodes[i]].v.x);
        self.turn(frame, w)
    }

    /// The turn of the frame in a motion `w` along its axes.
    pub(super) fn turn(&self, frame: &FloatingFrame, w: &[f64]) -> Vec3 {
        frame.turn(&self.Y, self.turning, |i| [three(w, 6 * i), three(w, 6 * i + 3)])
    }

    fn is_viscous(&self) -> bool {
        self.beta > 0.0 || !self.data.damping.is_empty()
    }

    /// Writes q̇.
    fn rates(&self, nodes: &[Node], frame: &FloatingFrame, rates: &mut [f64]) {
        let spin = self.velocities(nodes, frame, rates);
        for i in 0..self.data.interface {
            let [v, w] = [three(rates, 6 * i), three(rates, 6 * i + 3)];
            set_three(rates, 6 * i, &(v - spin.cross(&frame.z[i])));
            set_three(rates, 6 * i + 3, &inverse_tangent(&frame.psi[i], &(w - spin)));
        }
    }

    /// Adds C q̇ and the forces by β of the rates of strain to `g`; `product` is memory.
    fn add_viscous(&self, (q, rates): (&[f64], &[f64]), memory: (&mut [f64], &mut SecondOrderMemory), g: &mut [f64]) {
        let (product, second_order) = memory;
        multiply(&self.data.stiffness, rates, product);
        g.iter_mut().zip(&*product).for_each(|(g, p)| *g += self.beta * p);
        if let Some(terms) = self.data.second_order.as_ref().filter(|_| self.beta > 0.0) {
            terms.add_viscous((q, rates), self.beta, second_order, g);
        }
        if !self.data.damping.is_empty() {
            multiply(&self.data.damping, rates, product);
            g.iter_mut().zip(&*product).for_each(|(g, p)| *g += p);
        }
    }

    /// Writes q as the iterate before and the last correction, which are its rates there, extrapolate it.
    fn extrapolate(&self, before: &[Node], Scratch { frame, q, vectors: [rates, ..], .. }: &mut Scratch) {
        self.place(before, frame);
        self.displacements(before, frame, q);
        self.rates(before, frame, rates);
        q.iter_mut().zip(&*rates).for_each(|(q, rate)| *q += rate);
    }

    /// Writes q, g and the forces f along the axes of the frame; returns b. With an iterate before, q is extrapolated from there.
    fn local_forces(&self, nodes: &[Node], before: Option<&[Node]>, scratch: &mut Scratch) -> Vec3 {
        if let Some(before) = before {
            self.extrapolate(before, scratch);
        }
        let Scratch { frame, q, vectors: [g, f, rates, product, ..], second_order, .. } = scratch;
        self.place(nodes, frame);
        if before.is_none() {
            self.displacements(nodes, frame, q);
        }
        multiply(&self.data.stiffness, q, g);
        if let Some(terms) = &self.data.second_order {
            terms.add_forces(q, second_order, g);
        }
        if self.is_viscous() {
            self.rates(nodes, frame, rates);
            self.add_viscous((q, rates), (product, second_order), g);
        }
        f.copy_from_slice(g);
        let mut h = Vec3::zeros();
        for i in 0..self.data.interface {
            let m = inverse_tangent(&-frame.psi[i], &three(g, 6 * i + 3));
            h += frame.z[i].cross(&three(g, 6 * i)) + m;
            set_three(f, 6 * i + 3, &m);
        }
        let b = frame.inverse * h;
        self.add_turning(frame, &-b, f);
        b
    }

    /// Adds the forces by which a moment G c turns the frame: c·φ G = Σ f·d + m·θ.
    pub(super) fn add_turning(&self, frame: &FloatingFrame, c: &Vec3, f: &mut [f64]) {
        for (i, Y) in self.Y.iter().enumerate() {
            add_three(f, 6 * i, &(0.5 * c.cross(Y)));
            add_three(f, 6 * i + 3, &(self.turning * frame.H[i].tr_mul(c)));
        }
    }

    /// Subtracts forces along the axes of the frame from those of the nodes.
    pub(super) fn subtract(&self, frame: &FloatingFrame, f: &[f64], F: &mut [Force]) {
        for i in 0..self.data.interface {
            let F = &mut F[self.data.nodes[i]];
            subtract(F, 0, &(frame.R * three(f, 6 * i)));
            subtract(F, 3, &(frame.R * three(f, 6 * i + 3)));
        }
        self.each_amplitude(|k, i| F[self.data.nodes[i]][0] -= f[k]);
    }

    /// Calls `visit` with each amplitude's degree of freedom and its node among those of the superelement.
    pub(super) fn each_amplitude(&self, mut visit: impl FnMut(usize, usize)) {
        (self.placed()..self.size()).for_each(|k| visit(k, k - 5 * self.data.interface));
    }

    /// Writes the transpose of (K + rate (C + β K)) diag(1, T⁻¹(ψ)): a row for each motion of the nodes in a frame that stays, with the
    /// derivatives of g. K and C are symmetric.
    fn local_stiffness(&self, rate: f64, Scratch { q, matrix: A, inverses, second_order, .. }: &mut Scratch) {
        let (size, factor) = (self.size(), 1.0 + rate * self.beta);
        A.iter_mut().zip(&*self.data.stiffness).for_each(|(a, k)| *a = factor * k);
        A.iter_mut().zip(&*self.data.damping).for_each(|(a, c)| *a += rate * c);
        if let Some(terms) = &self.data.second_order {
            terms.add_stiffness(q, factor, second_order, A);
        }
        for (rows, inverse) in A.chunks_mut(6 * size).zip(&*inverses) {
            let [x, y, z] = three_rows(&mut rows[3 * size..], size);
            for ((x, y), z) in x.iter_mut().zip(y).zip(z) {
                let turned = inverse.tr_mul(&Vec3::new(*x, *y, *z));
                (*x, *y, *z) = (turned.x, turned.y, turned.z);
            }
        }
    }

    /// Writes the change of g where the frame turns by φ, and the nodes stay.
    fn turned_forces(&self, frame: &FloatingFrame, A: &[f64], phi: &Vec3, change: &mut [f64]) {
        change.fill(0.0);
        let mut subtract =
            |k: usize, moved: f64| add_multiple(change, -moved, &A[k * self.size()..(k + 1) * self.size()]);
        for (i, z) in frame.z.iter().enumerate() {
            let moved = phi.cross(z);
            (0..3).for_each(|k| subtract(6 * i + k, moved[k]));
            (0..3).for_each(|k| subtract(6 * i + 3 + k, phi[k]));
        }
    }

    /// A column of the tangent, along the axes of the frame: replaces the change `df` of g in a small motion by that of the forces.
    fn column(
        &self,
        (frame, inverses): (&FloatingFrame, &[Mat3]),
        [g, f]: [&Vec<f64>; 2],
        (moved, b): (&Moved, &Vec3),
        df: &mut [f64],
    ) {
        let (mut dh, mut dS) = (Vec3::zeros(), Mat3::zeros());
        for (i, Y) in self.Y.iter().enumerate() {
            let mut dm = inverses[i].tr_mul(&three(df, 6 * i + 3));
            if moved.moves(i) {
                let ([du, e], psi) = (moved.relative(frame, i), &frame.psi[i]);
                dm += inverse_tangent_change(&-psi, &-inverse_tangent(psi, &e), &three(g, 6 * i + 3));
                dh += du.cross(&three(g, 6 * i));
                dS += du * Y.transpose() + self.turning * (skew(&e) * frame.E[i]);
            }
            dh += frame.z[i].cross(&three(df, 6 * i)) + dm;
            set_three(df, 6 * i + 3, &dm);
        }
        let db = frame.inverse * (dh - half_trace_less(&dS) * b);
        self.add_turning(frame, &-db, df);
        for i in (0..self.data.interface).filter(|&i| moved.moves(i)) {
            let dH = half_trace_less(&(skew(&moved.relative(frame, i)[1]) * frame.E[i]));
            add_three(df, 6 * i + 3, &(-self.turning * dH.tr_mul(b)));
            for at in [6 * i, 6 * i + 3] {
                add_three(df, at, &moved.phi.cross(&three(f, at)));
            }
        }
    }

    /// Writes a matrix along the axes of the frame as one of the nodes, times `factor`. Each row of `local` is a column of the tangent, and
    /// `K` is row-major over six degrees of freedom of each node.
    pub(super) fn turned(&self, R: &Mat3, local: &[f64], factor: f64, K: &mut [f64]) {
        let (size, placed, width) = (self.size(), self.placed(), 6 * self.data.nodes.len());
        let at = |k: usize| if k < placed { k } else { placed + 6 * (k - placed) };
        K.fill(0.0);
        for column in (0..placed).step_by(3) {
            let entry = |row: usize, k: usize| local[(column + k) * size + row];
            for row in (0..placed).step_by(3) {
                let block = R * Mat3::from_fn(|i, k| factor * entry(row + i, k)) * R.transpose();
                (0..3).for_each(|i| {
                    let start = (row + i) * width + column;
                    (0..3).for_each(|k| K[start + k] = block[(i, k)]);
                });
            }
            for row in placed..size {
                let turned = R * Vec3::from_fn(|k, _| factor * entry(row, k));
                set_three(K, at(row) * width + column, &turned);
            }
        }
        for column in placed..size {
            let entries = &local[column * size..(column + 1) * size];
            for row in (0..placed).step_by(3) {
                let turned = R * three(entries, row);
                (0..3).for_each(|k| K[(row + k) * width + at(column)] = factor * turned[k]);
            }
            (placed..size).for_each(|row| K[at(row) * width + at(column)] = factor * entries[row]);
        }
    }

    /// Calls `visit` with each degree of freedom that it acts on, as a unit motion along the axes of the frame.
    pub(super) fn each_motion(&self, frame: &FloatingFrame, mut visit: impl FnMut(&Moved)) {
        self.each_dof(|dof, node, direction| {
            let is_placed = node < self.data.interface;
            if is_placed && direction > 2 && !self.data.turns {
                return;
            }
            let axis = Vec3::ith(direction % 3, 1.0);
            let phi = match (is_placed, direction < 3) {
                (false, _) => Vec3::zeros(),
                (true, true) => frame.inverse * (0.5 * self.Y[node].cross(&axis)),
                (true, false) => frame.inverse * (self.turning * (frame.H[node] * axis)),
            };
            visit(&Moved { dof, node, direction, phi });
        });
    }
}

/// Three rows of a row-major matrix.
fn three_rows(rows: &mut [f64], size: usize) -> [&mut [f64]; 3] {
    let (x, rest) = rows.split_at_mut(size);
    let (y, rest) = rest.split_at_mut(size);
    [x, y, &mut rest[..size]]
}

/// A unit motion of one degree of freedom along the axes of the frame.
pub struct Moved {
    pub dof: usize,
    pub node: usize,
    pub direction: usize,
    /// The turn of the frame.
    pub phi: Vec3,
}

impl Moved {
    /// True where a node moves relative to the frame.
    fn moves(&self, node: usize) -> bool {
        node == self.node || self.phi != Vec3::zeros()
    }

    /// The displacement and the rotation of a node.
    pub fn of(&self, node: usize) -> [Vec3; 2] {
        let mut motion = [Vec3::zeros(); 2];
        if node == self.node {
            motion[self.direction / 3][self.direction % 3] = 1.0;
        }
        motion
    }

    /// The displacement of the mean of this number of nodes.
    pub fn mean(&self, nodes: usize) -> Vec3 {
        let is_placed = self.node < nodes && self.direction < 3;
        if is_placed { Vec3::ith(self.direction, 1.0 / nodes as f64) } else { Vec3::zeros() }
    }

    /// The displacement and the rotation relative to the frame, for a node of the interface.
    pub fn relative(&self, frame: &FloatingFrame, node: usize) -> [Vec3; 2] {
        let [d, theta] = self.of(node);
        [d - self.phi.cross(&frame.z[node]), theta - self.phi]
    }
}

impl Elements for SuperelementBlock {
    fn len(&self) -> usize {
        1
    }

    fn nodes(&self, _: usize) -> &[usize] {
        &self.0.data.nodes
    }

    fn dofs(&self) -> usize {
        6
    }

    fn is_rotational(&self, _: usize, node: usize) -> bool {
        self.0.data.turns && node < self.0.data.interface
    }
}

impl Mechanics for SuperelementBlock {
    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]) {
        let scratch = &mut *self.0.scratch();
        self.0.local_forces(now.nodes, None, scratch);
        self.0.subtract(&scratch.frame, &scratch.vectors[1], F);
    }

    fn tangent(&self, _: usize, now: &Configuration, rate_weight: f64, _: Moduli, K: &mut [f64]) {
        let of = &self.0;
        let scratch = &mut *of.scratch();
        let b = of.local_forces(now.nodes, now.previous, scratch);
        let of_nodes = scratch.inverses.iter_mut().zip(&scratch.frame.psi);
        of_nodes.for_each(|(inverse, psi)| *inverse = inverse_tangent_matrix(psi));
        of.local_stiffness(rate_weight, scratch);
        let Scratch { frame, vectors: [g, f, turns @ .., _, _, _], matrix, inverses, .. } = scratch;
        let (size, at) = (of.size(), (&*frame, &inverses[..]));
        for (axis, df) in turns.iter_mut().enumerate() {
            let phi = Vec3::ith(axis, 1.0);
            of.turned_forces(frame, matrix, &phi, df);
            of.column(at, [g, f], (&Moved { dof: size, node: usize::MAX, direction: 0, phi }, &b), df);
        }
        of.each_motion(frame, |moved| {
            let df = &mut matrix[moved.dof * size..(moved.dof + 1) * size];
            of.column(at, [g, f], (&Moved { phi: Vec3::zeros(), ..*moved }, &b), df);
            turns.iter().zip(&moved.phi).for_each(|(turn, phi)| add_multiple(df, *phi, turn));
        });
        of.turned(&frame.R, matrix, 1.0, K);
    }

    fn is_damped(&self) -> bool {
        self.0.is_viscous()
    }
}

impl Results for SuperelementBlock {
    fn energy(&self, now: &Configuration) -> f64 {
        let of = &self.0;
        let Scratch { frame, q, vectors: [g, ..], second_order, .. } = &mut *of.scratch();
        of.place(now.nodes, frame);
        of.displacements(now.nodes, frame, q);
        multiply(&of.data.stiffness, q, g);
        let higher = of.data.second_order.as_ref().map_or(0.0, |terms| terms.energy(q, second_order));
        0.5 * q.iter().zip(&*g).map(|(q, g)| q * g).sum::<f64>() + higher
    }

    fn local_rotation(&self, now: &Configuration) -> f64 {
        let scratch = &mut *self.0.scratch();
        self.0.place(now.nodes, &mut scratch.frame);
        scratch.frame.psi.iter().map(|psi| psi.norm()).filter(|_| self.0.data.turns).fold(0.0, f64::max)
    }

    fn damping_power(&self, now: &Configuration) -> f64 {
        let of = &self.0;
        if !of.is_viscous() {
            return 0.0;
        }
        let Scratch { frame, q, vectors: [g, _, rates, product, ..], second_order, .. } = &mut *of.scratch();
        of.place(now.nodes, frame);
        of.displacements(now.nodes, frame, q);
        of.rates(now.nodes, frame, rates);
        g.fill(0.0);
        of.add_viscous((q, rates), (product, second_order), g);
        rates.iter().zip(&*g).map(|(rate, g)| rate * g).sum()
    }
}

impl Branches for SuperelementBlock {}
