//! Transverse shear forces of three-node triangles, by equilibrium of their moments.
//!
//! The edges of these elements bend, and twisting moments at the edges that turn into forces at the corners cannot be told, in one element,
//! from shear forces. The contributions of all elements at a node cancel, though. The remaining balance of moments is
//!   Q_a ∑ A/3 = −∑ A M·∇L_a,
//! over the elements at node a, with their mean moments M and areas A, and L_a linear. It is the weak form of Q = ∇·M, and converges with
//! order 1.2 to 1.5 in the element size, whereas Q of single elements does not converge. Elements have the mean of their nodes.
//!
//! Nodes with other moments are omitted: elements of other parts or other directors, supports, loads. Elements use the mean of their other
//! nodes, and keep their Q if there are none.

use super::shells::ShellState;
use crate::tolerances::shell_shear::SAME;
use base::math::Vec3;
use mechanics::elements::shell::result_axes;
use model::{Joint, Load, Model, PartType, Shell};

/// The balance of moments at a node.
#[derive(Debug, Clone, Copy)]
struct NodalMoments {
    /// −∑ A M·∇L, in the surface at t = 0; global components.
    force: Vec3,
    /// ∑ A/3.
    area: f64,
    /// The part of its elements, by its place in the model.
    part: usize,
    /// Director at t = 0.
    normal: Vec3,
    /// False if other moments act at the node.
    is_free: bool,
}

/// Balances of moments at nodes. The buffer is kept from one time to the next.
#[derive(Debug, Clone, Default)]
pub struct ShearBalance {
    nodes: Vec<NodalMoments>,
}

/// The undeformed element: its area, the gradients of L, and the axes of its results.
struct FlatTriangle {
    area: f64,
    gradients: [Vec3; 3],
    axes: [Vec3; 2],
}

impl FlatTriangle {
    fn new(model: &Model, nodes: &[usize], axis: &Vec3) -> FlatTriangle {
        let x = |a: usize| model.nodes[nodes[a % 3]].x;
        let twice = (x(1) - x(0)).cross(&(x(2) - x(0)));
        let normal = twice.normalize();
        let gradients = [0, 1, 2].map(|a| normal.cross(&(x(a + 2) - x(a + 1))) / twice.norm());
        FlatTriangle { area: 0.5 * twice.norm(), gradients, axes: result_axes(axis, &normal) }
    }
}

impl ShearBalance {
    /// Replaces Q of all triangles of order 1 among `states`, which are all elements of all shells.
    pub fn apply(&mut self, model: &Model, states: &mut [ShellState]) {
        let shells = || model.parts.iter().filter_map(Shell::of);
        if !shells().any(|shell| shell.size() == 3) {
            return;
        }
        self.find_free(model);
        for of_part in states.chunk_by(|a, b| a.part == b.part) {
            let Some(shell) = triangles(model, of_part) else { continue };
            for (state, element) in of_part.iter().zip(&shell.elements) {
                let facet = FlatTriangle::new(model, &element.nodes, &shell.axis);
                let ([t1, t2], [m11, m22, m12]) = (facet.axes, state.at.M);
                for (&node, gradient) in element.nodes.iter().zip(&facet.gradients) {
                    let [g1, g2] = [t1.dot(gradient), t2.dot(gradient)];
                    let balance = &mut self.nodes[node];
                    balance.force -= facet.area * ((m11 * g1 + m12 * g2) * t1 + (m12 * g1 + m22 * g2) * t2);
                    balance.area += facet.area / 3.0;
                }
            }
        }
        for of_part in states.chunk_by_mut(|a, b| a.part == b.part) {
            let Some(shell) = triangles(model, of_part) else { continue };
            for (state, element) in of_part.iter_mut().zip(&shell.elements) {
                let free = || element.nodes[..3].iter().map(|&node| &self.nodes[node]).filter(|b| b.is_free);
                let count = free().count();
                if count > 0 {
                    let mean = free().map(|b| b.force / b.area).sum::<Vec3>() / count as f64;
                    state.at.Q = FlatTriangle::new(model, &element.nodes, &shell.axis).axes.map(|t| t.dot(&mean));
                }
            }
        }
    }

    /// Clears the balances, and finds the nodes where only moments of elements of one part act.
    fn find_free(&mut self, model: &Model) {
        let none =
            NodalMoments { force: Vec3::zeros(), area: 0.0, part: usize::MAX, normal: Vec3::zeros(), is_free: true };
        self.nodes.clear();
        self.nodes.resize(model.nodes.len(), none);
        // Contacts push without moments.
        let with_moments = model.parts.iter().enumerate().filter(|(_, part)| !part.kind().is_unilateral());
        for (index, part) in with_moments {
            for element in 0..part.elements() {
                for (k, &node) in part.nodes(element).iter().enumerate() {
                    let normal = part.normals(element).get(k).copied().unwrap_or_default();
                    let balance = &mut self.nodes[node];
                    if balance.part == usize::MAX {
                        (balance.part, balance.normal) = (index, normal);
                    } else if balance.part != index || balance.normal.dot(&normal) < SAME {
                        balance.is_free = false;
                    }
                }
            }
        }
        let constraints = &model.constraints;
        for held in constraints.restraints.iter().filter(|held| held.dof >= 3) {
            // Held against turning about its director a node bends freely.
            let balance = &mut self.nodes[held.node];
            balance.is_free &= balance.normal[held.dof - 3].abs() >= SAME;
        }
        let attached = constraints.dependents.iter().flat_map(|dependent| [dependent.node, dependent.master]);
        let joined = constraints.joints.iter().flat_map(Joint::all_ends);
        let with_moments = |load: &&Load| load.moment_counts && load.moment != Vec3::zeros();
        let loaded = model.loading.nodal.iter().filter(with_moments).map(|load| load.node);
        let bodies = model.bodies.iter().map(|body| body.node);
        for node in attached.chain(joined).chain(loaded).chain(bodies) {
            self.nodes[node].is_free = false;
        }
    }
}

/// The shell of these states, where they are all of a shell of triangles of order 1.
fn triangles<'a>(model: &'a Model, states: &[ShellState]) -> Option<&'a Shell> {
    let shell = Shell::of(&model.parts[states.first()?.part])?;
    (shell.size() == 3 && shell.elements.len() == states.len()).then_some(shell)
}
