//! A part by its matrices: stiffness, mass and damping of a few nodes and of modal amplitudes, in large motion.
//!
//! A frame moves with the nodes of the interface (`frame`). In it displacements u, rotations ψ = log Rᵀ R_i and amplitudes η are small: the
//! energy ½ qᵀ K q with q = (u, ψ, η) makes forces that are objective (`elastic`); reduced parts have terms of higher order (`second_order`). The kinetic energy is that of the velocities in the axes of
//! the frame, with the mean motion of the mass apart (`inertia`).

mod center;
mod elastic;
mod frame;
mod inertia;
mod inertia_change;
mod integrals;
mod mass_matrix;
mod recovery;
mod second_order;
mod vectors;

pub use elastic::SuperelementBlock;
pub use integrals::{InertiaIntegrals, ModalMass, NodalMass, RIGID_LOADS, products};
pub use recovery::InnerNodes;
pub use second_order::{Product, SecondOrder};
pub use vectors::dot;

use crate::state::Node;
use base::math::{Mat3, Vec3, skew};
use frame::{FloatingFrame, axial};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use vectors::{add_multiple, add_three, multiply, set_three, three};

/// The nodes and matrices of a superelement. Matrices are square and row-major, over six degrees of freedom of each node and the amplitudes.
#[derive(Debug, Clone, PartialEq)]
pub struct SuperelementData {
    /// The nodes of the interface, then a node for each amplitude, whose displacement along x the amplitude is.
    pub nodes: Vec<usize>,
    /// The number of nodes of the interface.
    pub interface: usize,
    /// True where it acts on rotations. Otherwise their rows and columns are zero.
    pub turns: bool,
    /// Stiffness, global components at t = 0.
    pub stiffness: Arc<[f64]>,
    /// Mass; empty for a superelement without mass.
    pub mass: Arc<[f64]>,
    /// Damping; empty without.
    pub damping: Arc<[f64]>,
    /// Terms of second order of a reduced part; `None` for an energy that is ½ qᵀ K q.
    pub second_order: Option<Arc<SecondOrder>>,
}

impl SuperelementData {
    /// The number of amplitudes.
    pub fn amplitudes(&self) -> usize {
        self.nodes.len() - self.interface
    }

    /// The number of degrees of freedom.
    pub fn size(&self) -> usize {
        5 * self.interface + self.nodes.len()
    }
}

/// A superelement with all that is computed before the run.
#[derive(Debug)]
pub struct FloatingElement {
    data: SuperelementData,
    /// Positions of its nodes at t = 0.
    x: Vec<Vec3>,
    /// Positions of the nodes of the interface relative to their mean, at t = 0.
    Y: Vec<Vec3>,
    /// Weight of a rotation beside displacements in the frame, length squared.
    turning: f64,
    /// Rayleigh's β.
    beta: f64,
    mass: Option<MassProperties>,
    scratch: Mutex<Scratch>,
}

/// Weights of rates and accelerations in the tangent, and Rayleigh's α.
#[derive(Debug, Clone, Copy)]
pub struct FloatingWeights {
    /// ∂v/∂x.
    pub rate: f64,
    /// ∂a/∂x.
    pub acceleration: f64,
    /// Rayleigh's α.
    pub alpha: f64,
    /// True for the whole derivative with gyroscopic terms, which is not symmetric.
    pub gyroscopic: bool,
}

/// The mass of the whole and its parts.
#[derive(Debug, Clone)]
struct MassProperties {
    /// The mass.
    total: f64,
    /// The centre of mass relative to the mean of the nodes, at t = 0.
    center: Vec3,
    /// The momentum by velocities, divided by the mass: three rows.
    share: [Vec<f64>; 3],
    /// M without the motion of the centre of mass.
    rest: Vec<f64>,
}

/// Memory of an evaluation.
#[derive(Debug, Clone, Default)]
struct Scratch {
    frame: FloatingFrame,
    /// q.
    q: Vec<f64>,
    /// Vectors of its size.
    vectors: [Vec<f64>; 8],
    /// A matrix of its size.
    matrix: Vec<f64>,
    /// T⁻¹(ψ) of the nodes of the interface.
    inverses: Vec<Mat3>,
    /// Memory of the terms of second order.
    second_order: second_order::SecondOrderMemory,
}

impl FloatingElement {
    /// A superelement on nodes at `x`, with Rayleigh's β on its stiffness.
    pub fn new(data: SuperelementData, x: &[Vec3], beta: f64) -> FloatingElement {
        let x: Vec<Vec3> = data.nodes.iter().map(|&node| x[node]).collect();
        let n = data.interface;
        let mean = x[..n].iter().sum::<Vec3>() / n as f64;
        let Y: Vec<Vec3> = x[..n].iter().map(|x| x - mean).collect();
        let spread: f64 = Y.iter().map(|Y| Y.norm_squared()).sum();
        let turning = match (data.turns, spread > 0.0) {
            (false, _) => 0.0,
            // The chord of two nodes and the mean of their rotations count alike.
            (true, true) => 0.5 * spread / n as f64,
            (true, false) => 1.0,
        };
        let size = data.size();
        let scratch = Scratch {
            frame: FloatingFrame::new(n),
            q: vec![0.0; size],
            vectors: std::array::from_fn(|_| vec![0.0; size]),
            matrix: vec![0.0; size * size],
            inverses: vec![Mat3::identity(); n],
            second_order: data.second_order.as_deref().map(second_order::SecondOrderMemory::new).unwrap_or_default(),
        };
        let mass = (!data.mass.is_empty()).then(|| MassProperties::of(&data.mass, n, &Y));
        FloatingElement { data, x, Y, turning, beta, mass, scratch: Mutex::new(scratch) }
    }

    /// Its nodes and matrices.
    pub fn data(&self) -> &SuperelementData {
        &self.data
    }

    /// The nodes of the interface, then those of the amplitudes.
    pub fn nodes(&self) -> &[usize] {
        &self.data.nodes
    }

    /// True where the elastic forces are linear in the frame.
    pub fn is_linear(&self) -> bool {
        self.data.second_order.is_none()
    }

    /// Takes from a small motion at t = 0 the rigid motion of the frame that follows it.
    pub fn relative_to_frame(&self, motion: &mut [f64]) {
        let Scratch { frame, .. } = &mut *self.scratch();
        let rest: Vec<Node> = self.x.iter().map(|x| Node::at_rest(*x)).collect();
        frame.place(|i| &rest[i], &self.Y, self.turning);
        let phi = self.turn(frame, motion);
        let mean = (0..self.data.interface).map(|i| three(motion, 6 * i)).sum::<Vec3>() / self.data.interface as f64;
        for (i, Y) in self.Y.iter().enumerate() {
            add_three(motion, 6 * i, &-(mean + phi.cross(Y)));
            add_three(motion, 6 * i + 3, &-phi);
        }
    }

    /// The mass of the whole.
    pub fn total_mass(&self) -> f64 {
        self.mass.as_ref().map_or(0.0, |mass| mass.total)
    }

    /// The nodes with mass: whether their translations have any, or the amplitude has, and whether their rotations have.
    pub fn massive_nodes(&self) -> impl Iterator<Item = (usize, [bool; 2])> {
        let (size, placed) = (self.size(), self.placed());
        let is_massive = move |dof: usize| self.data.mass.get(dof * (size + 1)).is_some_and(|m| *m > 0.0);
        self.data.nodes.iter().enumerate().map(move |(i, &node)| match i < self.data.interface {
            true => (node, [0, 3].map(|at| (0..3).any(|axis| is_massive(6 * i + at + axis)))),
            false => (node, [is_massive(placed + i - self.data.interface), false]),
        })
    }

    /// The centre of mass at t = 0.
    pub fn center(&self) -> Vec3 {
        let own = self.mass.as_ref().map_or_else(Vec3::zeros, |mass| mass.center);
        self.x[0] - self.Y[0] + own
    }

    fn size(&self) -> usize {
        self.data.size()
    }

    /// The number of degrees of freedom of the nodes of the interface.
    fn placed(&self) -> usize {
        6 * self.data.interface
    }

    fn scratch(&self) -> MutexGuard<'_, Scratch> {
        self.scratch.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Calls `visit` with each degree of freedom, its node among those of the superelement, and its direction there.
    fn each_dof(&self, mut visit: impl FnMut(usize, usize, usize)) {
        let placed = self.placed();
        (0..placed).for_each(|k| visit(k, k / 6, k % 6));
        (placed..self.size()).for_each(|k| visit(k, k - 5 * self.data.interface, 0));
    }
}

impl MassProperties {
    /// The parts of a node in the motion of the centre: by its displacement and by its rotation.
    fn of_node(&self, i: usize) -> [Mat3; 2] {
        [0, 3].map(|at| Mat3::from_fn(|row, column| self.share[row][6 * i + at + column]))
    }

    /// The part of an amplitude.
    fn of_amplitude(&self, k: usize) -> Vec3 {
        Vec3::from_fn(|row, _| self.share[row][k])
    }

    fn of(M: &[f64], interface: usize, Y: &[Vec3]) -> MassProperties {
        let size = M.len().isqrt();
        // The rows of momentum are the sums of the rows of translations.
        let momentum: [Vec<f64>; 3] = std::array::from_fn(|axis| {
            (0..size).map(|column| (0..interface).map(|i| M[(6 * i + axis) * size + column]).sum()).collect()
        });
        let along = |axis: usize| (0..interface).map(|i| momentum[axis][6 * i + axis]).sum::<f64>();
        let total = (along(0) + along(1) + along(2)) / 3.0;
        let share = momentum.map(|row| row.into_iter().map(|entry| entry / total).collect::<Vec<f64>>());
        // Under a rotation φ about the mean of the nodes the centre C moves by φ × C.
        let turned = Mat3::from_fn(|row, column| {
            let of_node = |i: usize| {
                let moved = -skew(&Y[i]);
                let by_place: f64 = (0..3).map(|k| share[row][6 * i + k] * moved[(k, column)]).sum();
                by_place + share[row][6 * i + 3 + column]
            };
            (0..interface).map(of_node).sum()
        });
        let center = -axial(&turned);
        let mut rest = M.to_vec();
        for i in 0..size {
            for j in 0..size {
                rest[i * size + j] -= total * share.iter().map(|row| row[i] * row[j]).sum::<f64>();
            }
        }
        MassProperties { total, center, share, rest }
    }
}
