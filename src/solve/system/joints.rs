//! Joints in the equation of motion: their forces, the violations of their constraint equations, their part of the matrix
//! (57). With f the residual without them the iteration solves
//!   [K + GᵀsG  Gᵀs ] [δq]   [ f − Gᵀλ ]
//!   [sG        −ε s] [δμ] = [−s(1+ε)c ],   δλ = s (δμ − c),
//! which is Newton's equation for `f = Gᵀλ`, `c = 0` with the penalty s for a unit of λ. The second equation, times `sGᵀ`, is added to the
//! first. This changes only the elimination, whose pivots then do not vanish. O. A. Bauchau, A. Epple & C. L. Bottasso, J. Comput.
//! Nonlinear Dyn. 4 (2009). Redundant equations share the load with the least norm because of ε; each iteration reduces a gap to the
//! fraction ε.

use super::equations::{Forces, System};
use super::multipliers::Multipliers;
use super::penalties::{self, Diagonals, INDEFINITE};
use super::scale::Scale;
use super::tangent_weights::TangentWeights;
use base::math::{Mat6, Vec3, Vec6, angular, linear};
use mechanics::constraints::joint::{ConstraintEquation, Joint, MOST_ENDS, MOST_EQUATIONS};
use mechanics::state::Node;

/// Largest size of a joint's matrix: six degrees of freedom for each of its ends, then its multipliers. A joint with a node shared by gears
/// has two ends.
const MOST_WIDTH: usize = 6 * MOST_ENDS + MOST_EQUATIONS;

/// Size of a joint's matrix.
pub(super) fn width(joint: &Joint) -> usize {
    6 * joint.matrix_nodes().count() + MOST_EQUATIONS
}

/// Force and moment that the constraint equations of a joint exert on its first node, global components.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointState {
    /// Force.
    pub f: Vec3,
    /// Moment.
    pub m: Vec3,
    /// Force or moment of the drive along the coordinate on the second node; zero without a drive.
    pub drive: f64,
}

impl System {
    /// Number of constraint equations of all joints.
    pub fn multipliers(&self) -> usize {
        self.joints.iter().map(|joint| joint.equations.len()).sum()
    }

    /// Each joint with the number of its first constraint equation.
    pub fn numbered(&self) -> impl Iterator<Item = (&Joint, usize)> {
        self.joints.iter().scan(0, |next, joint| {
            let first = *next;
            *next += joint.equations.len();
            Some((joint, first))
        })
    }

    /// Subtracts the constraint forces Gᵀλ and writes the gaps.
    pub(super) fn subtract_joint_forces(&self, nodes: &[Node], forces: &mut Forces, scale: &mut Scale) {
        let Forces { multipliers, on_nodes: F, .. } = forces;
        let mut room = [Vec6::zeros(); MOST_ENDS];
        for (joint, first) in self.numbered() {
            for k in 0..joint.equations.len() {
                multipliers.gaps[first + k] = joint.gap(k, nodes)[0];
                let lambda = multipliers.values[first + k];
                if lambda == 0.0 {
                    continue;
                }
                for (node, G) in joint.ends().zip(joint.gradient(k, nodes, &mut room)) {
                    let pull = lambda * G;
                    scale.include(&pull.data.0);
                    F[node].iter_mut().zip(&pull).for_each(|(f, pull)| *f -= pull);
                }
            }
            if let Some(drive) = &joint.drive {
                // The equation holds the coordinate less the displacement of the drive times the ratio.
                let push = drive.ratio * multipliers.values[first + joint.equations.len() - 1];
                if drive.is_free {
                    scale.include(&[[push, 0.0, 0.0, 0.0, 0.0, 0.0]]);
                }
                F[drive.node][0] += push;
            }
        }
    }

    /// Writes the constraint forces −Gᵀλ alone, transferred to the masters.
    pub fn joint_forces(&self, nodes: &[Node], forces: &mut Forces) {
        forces.on_nodes.fill([0.0; 6]);
        self.subtract_joint_forces(nodes, forces, &mut Scale::default());
        self.transfer_to_masters(nodes, forces);
    }

    /// Returns for each node whether its translations have mass and its rotations have inertia.
    pub fn has_mass(&self, nodes: usize) -> Vec<[bool; 2]> {
        let mut has_mass = vec![[false; 2]; nodes];
        self.inertias.iter().for_each(|inertia| has_mass[inertia.node] = [inertia.mass > 0.0, inertia.rotary]);
        for node in self.consistent.iter().flat_map(|mass| &mass.nodes) {
            has_mass[*node][0] = true;
        }
        for (node, [moves, turns]) in self.floating().iter().flat_map(|mass| mass.element.massive_nodes()) {
            has_mass[node][0] |= moves;
            has_mass[node][1] |= turns;
        }
        for dependent in self.rigid_links.iter().rev() {
            let [moves, turns] = has_mass[dependent.node];
            has_mass[dependent.master][0] |= moves && dependent.dofs[..3].contains(&true);
            has_mass[dependent.master][1] |= turns && dependent.dofs[3..].contains(&true);
        }
        has_mass
    }

    /// Writes the gaps of the joints (`derivative` 0) or their first or second derivative in time.
    pub fn gaps(&self, nodes: &[Node], derivative: usize, gaps: &mut [f64]) {
        for (joint, first) in self.numbered() {
            for k in 0..joint.equations.len() {
                gaps[first + k] = joint.gap(k, nodes)[derivative];
            }
        }
    }

    /// Writes the changes of the gaps for small motions (u, θ) of all nodes, dependent nodes included.
    pub fn gaps_of_motion(&self, nodes: &[Node], motions: &[Vec6], gaps: &mut [f64]) {
        for (joint, first) in self.numbered() {
            for k in 0..joint.equations.len() {
                gaps[first + k] = joint.opening(k, nodes, motions);
            }
        }
    }

    /// The largest gap relative to its reference: `reach`, the size of positions, for lengths, and 1 for angles.
    pub fn largest_gap(&self, gaps: &[f64], reach: f64) -> f64 {
        let rows = self.joints.iter().flat_map(|joint| &joint.equations);
        let relative =
            |(row, gap): (&ConstraintEquation, &f64)| if row.is_rotational() { gap.abs() } else { gap.abs() / reach };
        rows.zip(gaps).map(relative).fold(0.0, |largest, gap| if gap > largest || gap.is_nan() { gap } else { largest })
    }

    /// The joint and the constraint equation of a multiplier.
    pub fn row(&self, multiplier: usize) -> Option<(usize, &ConstraintEquation)> {
        let of = |(j, (joint, first)): (usize, (&_, usize))| {
            let joint: &Joint = joint;
            (first + joint.equations.len() > multiplier).then_some((j, first))
        };
        let (j, first) = self.numbered().enumerate().find_map(of)?;
        Some((j, &self.joints[j].equations[multiplier - first]))
    }

    /// Writes the force and moment of each joint on its first node, in the order of the model's list.
    pub fn joint_states(&self, nodes: &[Node], values: &[f64], out: &mut Vec<JointState>) {
        out.clear();
        let mut room = [Vec6::zeros(); MOST_ENDS];
        out.extend(self.numbered().map(|(joint, first)| {
            let [mut f, mut m] = [Vec3::zeros(); 2];
            for (k, lambda) in (0..joint.equations.len()).zip(&values[first..]) {
                let G = joint.gradient(k, nodes, &mut room)[0];
                f -= *lambda * linear(&G);
                m -= *lambda * angular(&G);
            }
            let drive = joint.drive.map_or(0.0, |_| -values[first + joint.equations.len() - 1]);
            JointState { f, m, drive }
        }));
    }
}

/// Adds the derivative of the force of a constraint equation to the matrix `K` of its joint, with `width` columns.
fn add_stiffness((joint, number): (&Joint, usize), nodes: &[Node], lambda: f64, (K, width): (&mut [f64], usize)) {
    joint.stiffness(number, nodes, lambda, |i, j, block| {
        for r in 0..3 {
            for c in 0..3 {
                K[(3 * i + r) * width + 3 * j + c] += block[(r, c)];
            }
        }
    });
}

/// Forms the derivative of the forces of each joint, as [`tangents`] does the whole matrix, and hands it to `add` with its number.
pub(super) fn stiffnesses(
    system: &System,
    nodes: &[Node],
    multipliers: &Multipliers,
    mut add: impl FnMut(usize, &mut [f64]),
) {
    let mut K = [0.0; MOST_WIDTH * MOST_WIDTH];
    for (j, (joint, first)) in system.numbered().enumerate() {
        let width = width(joint);
        let K = &mut K[..width * width];
        K.fill(0.0);
        for (k, &lambda) in (0..joint.equations.len()).zip(&multipliers.values[first..]) {
            add_stiffness((joint, k), nodes, lambda, (K, width));
        }
        add(j, K);
    }
}

/// Forms the matrix of each joint, row-major over its nodes and its multipliers, and hands it to `add` with its number. `projections` map
/// the nodes to independent nodes; with `weights.stiffness` the matrix holds the derivative of the joint's forces.
pub(super) fn tangents(
    system: &System,
    nodes: &[Node],
    (diagonals, projections): (&mut Diagonals, &[Vec<Mat6>]),
    multipliers: &mut Multipliers,
    weights: TangentWeights,
    values: &mut [f64],
    mut add: impl FnMut(usize, &mut [f64], &mut [f64]),
) {
    let at_rest = weights.acceleration == 0.0;
    penalties::set(system, nodes, (&mut *diagonals, projections), multipliers, values, at_rest);
    if weights.acceleration < 0.0 {
        multipliers.penalties.iter_mut().for_each(|s| *s *= INDEFINITE);
    }
    let mut K = [0.0; MOST_WIDTH * MOST_WIDTH];
    let mut room = [Vec6::zeros(); MOST_ENDS];
    let mut first = 0;
    for (j, joint) in system.joints.iter().enumerate() {
        let width = width(joint);
        let (K, own) = (&mut K[..width * width], width - MOST_EQUATIONS);
        K.fill(0.0);
        for k in 0..joint.equations.len() {
            let (s, lambda) = (multipliers.penalties[first + k], multipliers.values[first + k]);
            if weights.stiffness {
                add_stiffness((joint, k), nodes, lambda, (K, width));
            }
            let of_ends = joint.gradient(k, nodes, &mut room);
            let mut components = [0.0; 6 * MOST_ENDS];
            components.chunks_exact_mut(6).zip(of_ends).for_each(|(to, G)| to.copy_from_slice(G.as_slice()));
            let G = &components[..6 * of_ends.len()];
            for (i, Gi) in G.iter().enumerate() {
                for (j, Gj) in G.iter().enumerate() {
                    K[i * width + j] += s * Gi * Gj;
                }
                K[i * width + own + k] = s * Gi;
                K[(own + k) * width + i] = s * Gi;
            }
            if let Some(drive) = joint.shared().filter(|_| joint.is_driven(k)) {
                let g = -drive.ratio;
                for (i, G) in G.iter().enumerate() {
                    K[i * width + 12] += s * G * g;
                    K[12 * width + i] += s * g * G;
                }
                K[12 * width + 12] += s * g * g;
                K[12 * width + own + k] = s * g;
                K[(own + k) * width + 12] = s * g;
            }
            K[(own + k) * (width + 1)] = -system.regularization() * s;
        }
        add(j, K, values);
        first += joint.equations.len();
    }
}
