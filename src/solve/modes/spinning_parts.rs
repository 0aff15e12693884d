//! Superelements and reduced parts that spin about an axis of symmetry, as matrices of small motions.
//!
//! Amplitudes η belong to shapes φ that turn with the part. Shapes that lie still in space have constant matrices. Their amplitudes are
//! ξ = exp(A Ω t) η, with e × φ_l = Σ φ_k A_kl. At this instant η = ξ, η̇ = ξ̇ − Ω A ξ and η̈ = ξ̈ − 2 Ω A ξ̇ + Ω² A² ξ.

use super::linearized::Linearized;
use crate::system::FloatingMass;
use crate::tolerances::gyroscopic::{ROUND, SAG};
use base::math::{Mat3, Mat6, Vec3, skew};
use mechanics::elements::superelement::SuperelementData;
use model::ReducedPart;
use nalgebra::DMatrix;

/// The matrices of a part, of rates and of motions, over six directions of each of its nodes.
pub struct SpinningPart {
    nodes: Vec<usize>,
    matrices: [DMatrix<f64>; 2],
    /// Its angular momentum about the first of its nodes.
    pub momentum: Vec3,
    /// Terms that it lacks, in words.
    pub warning: Option<String>,
}

/// A node of a part that spins.
pub fn first_spinning(at: &Linearized) -> Option<usize> {
    at.system.floating_nodes().find(|&node| at.spins(&at.state.nodes[node].omega))
}

/// The parts that spin in a state.
pub fn spinning_parts(at: &Linearized) -> Vec<SpinningPart> {
    let spins = |of: &&FloatingMass| at.spins(&at.state.nodes[of.element.nodes()[0]].omega);
    at.system.floating().iter().filter(spins).map(|of| SpinningPart::new(at, of)).collect()
}

impl SpinningPart {
    fn new(at: &Linearized, of: &FloatingMass) -> SpinningPart {
        let (nodes, own) = (&at.state.nodes, of.element.nodes());
        let first = &nodes[own[0]];
        let made =
            at.model.reductions.iter().filter_map(|of| of.made.as_deref()).find(|made| made.matrices.nodes == own);
        let count = own.iter().filter(|&&node| at.model.nodes[node].is_number).count();
        let interface = &own[..own.len() - count];
        let arms = |of: &dyn Fn(usize) -> usize| -> Vec<Vec3> {
            interface.iter().map(|&node| at.model.nodes[of(node)].x - at.model.nodes[own[0]].x).collect()
        };
        let (own_arms, root_arms) = (arms(&|node| node), arms(&|node| at.root(node).0));
        let length = own_arms.iter().chain(&root_arms).map(Vec3::norm).fold(0.0, f64::max);
        // The line of the nodes at t = 0 is the axis of a shaft that sags.
        let spin = first.R().tr_mul(&first.omega.normalize());
        let line = own_arms.iter().max_by(|a, b| a.norm().total_cmp(&b.norm())).and_then(|arm| arm.try_normalize(0.0));
        let line = line.map(|line| line * line.dot(&spin).signum());
        let axis = line.filter(|line| line.cross(&spin).norm() <= SAG).unwrap_or(spin);
        let is_near = |arms: &[Vec3]| arms.iter().all(|arm| arm.cross(&axis).norm() <= ROUND * length);
        let is_on_axis = is_near(&own_arms);
        let turn = match made {
            Some(made) => turn_of_shapes(made, &axis),
            None => (count == 0).then(|| DMatrix::zeros(0, 0)),
        };
        let turn = turn.filter(|turn| is_round(of.element.data(), &axis, turn));
        let label = &at.model.nodes[own[0]].label;
        let warning = if turn.is_none() || !is_on_axis {
            Some(format!(
                "`{label}` spins with a part by its matrices that is not symmetric about this axis: modes are those of the current instant. Use a beam with equal \
                 stiffness about both axes and its nodes on the axis, or compute the motion with `kind = \"dynamic\"`"
            ))
        } else if !is_near(&root_arms) {
            Some(format!(
                "`{label}` spins beside the axis of the body that carries it: modes omit the gyroscopic and centrifugal forces of its path. Compute the motion \
                 with `kind = \"dynamic\"`"
            ))
        } else {
            None
        };
        let turn = turn.unwrap_or_else(|| DMatrix::zeros(count, count)) * -first.omega.norm();
        let (_, p, l) = of.motion(nodes);
        let matrices = of.spin_derivatives(nodes, &turn, &|| at.is_stopped());
        SpinningPart { nodes: own.to_vec(), matrices, momentum: l - first.x.cross(&p), warning }
    }

    /// Hands the matrices between two nodes to `visit`.
    pub fn visit(&self, visit: &mut dyn FnMut([usize; 2], &[Mat6; 2])) {
        for (i, &row) in self.nodes.iter().enumerate() {
            for (j, &column) in self.nodes.iter().enumerate() {
                visit(
                    [row, column],
                    &self.matrices.each_ref().map(|of| of.fixed_view::<6, 6>(6 * i, 6 * j).into_owned()),
                );
            }
        }
    }
}

/// A, by least squares over the inner nodes; `None` where turned shapes are not among the shapes.
fn turn_of_shapes(made: &ReducedPart, axis: &Vec3) -> Option<DMatrix<f64>> {
    let size = made.matrices.size();
    let rows = made.shapes.len() / size;
    let all = DMatrix::from_column_slice(rows, size, &made.shapes);
    let shapes = all.columns(size - made.matrices.amplitudes(), made.matrices.amplitudes());
    let turned = DMatrix::from_fn(rows, shapes.ncols(), |row, k| {
        let at = row - row % 3;
        axis.cross(&Vec3::new(shapes[(at, k)], shapes[(at + 1, k)], shapes[(at + 2, k)]))[row % 3]
    });
    let turn = shapes.tr_mul(&shapes).cholesky()?.solve(&shapes.tr_mul(&turned));
    let left = &turned - shapes * &turn;
    (left.amax() <= ROUND * shapes.amax()).then_some(turn)
}

/// True where a turn about the axis changes neither the stiffness nor the mass.
fn is_round(of: &SuperelementData, axis: &Vec3, turn: &DMatrix<f64>) -> bool {
    let size = of.size();
    let placed = size - turn.nrows();
    let mut of_all = DMatrix::zeros(size, size);
    (0..placed / 3).for_each(|i| of_all.fixed_view_mut::<3, 3>(3 * i, 3 * i).copy_from(&(skew(axis) as Mat3)));
    of_all.view_mut((placed, placed), turn.shape()).copy_from(turn);
    let is_same = |of: &[f64]| {
        let of = DMatrix::from_row_slice(size, size, of);
        // Entries of stretching do not hide those of bending.
        let scale = of.diagonal().map(|own| if own > 0.0 { 1.0 / own.sqrt() } else { 0.0 });
        let change = &of * &of_all + of_all.tr_mul(&of);
        let scaled = DMatrix::from_fn(size, size, |i, j| change[(i, j)] * scale[i] * scale[j]);
        scaled.amax() <= ROUND
    };
    is_same(&of.stiffness) && is_same(&of.mass)
}
