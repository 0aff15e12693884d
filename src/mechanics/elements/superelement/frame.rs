//! The floating frame: the rotation R that fits positions and rotations of the nodes best. It makes tr RᵀB largest, with
//! B = Σ (x_i − x̄) Y_iᵀ + λ Σ R_i, so that S = RᵀB is symmetric. A small motion (d_i, θ_i) of the nodes, along the axes of the frame, turns
//! it by φ = G⁻¹ Σ (½ Y_i × d_i + λ H_i θ_i), with G = ½ (tr S − S), H_i = ½ (tr E_i − E_i) and E_i = RᵀR_i.

use crate::state::Node;
use base::math::{Mat3, Vec3, rotation};
use nalgebra::{Matrix4, Quaternion};

/// The frame at an instant, and the nodes in it.
#[derive(Debug, Clone)]
pub struct FloatingFrame {
    /// Its rotation since t = 0.
    pub R: Mat3,
    /// G⁻¹.
    pub inverse: Mat3,
    /// Positions relative to the mean of the nodes.
    pub z: Vec<Vec3>,
    /// Rotations E_i.
    pub E: Vec<Mat3>,
    /// H_i.
    pub H: Vec<Mat3>,
    /// Their rotation vectors.
    pub psi: Vec<Vec3>,
}

impl Default for FloatingFrame {
    fn default() -> FloatingFrame {
        FloatingFrame::new(0)
    }
}

/// Newton iterations to the rotation. They converge quadratically from within a quarter turn.
const ITERATIONS: usize = 12;

/// A turn whose square is below rounding.
const SMALL: f64 = 1e-9;

impl FloatingFrame {
    /// A frame of this number of nodes.
    pub fn new(nodes: usize) -> FloatingFrame {
        let I = Mat3::identity();
        let zero = vec![Vec3::zeros(); nodes];
        FloatingFrame { R: I, inverse: I, z: zero.clone(), E: vec![I; nodes], H: vec![I; nodes], psi: zero }
    }

    /// Places the frame. `Y` are the positions of the nodes at t = 0, and `turning` is λ.
    pub fn place<'n>(&mut self, node: impl Fn(usize) -> &'n Node, Y: &[Vec3], turning: f64) {
        let n = Y.len() as f64;
        let first = node(0);
        let mean = (0..Y.len()).map(|i| node(i).relative_position(first)).sum::<Vec3>() / n;
        let mut B = Mat3::zeros();
        for (i, Y) in Y.iter().enumerate() {
            let node = node(i);
            self.z[i] = node.relative_position(first) - mean;
            self.E[i] = node.R();
            B += self.z[i] * Y.transpose() + turning * self.E[i];
        }
        let start = if turning > 0.0 { first.R() } else { best(&B) };
        let found = fit(&B, start).or_else(|| fit(&B, best(&B)));
        // Without a frame there are no forces, and the step fails.
        (self.R, self.inverse) = found.unwrap_or((start, Mat3::from_element(f64::NAN)));
        for i in 0..Y.len() {
            self.z[i] = self.R.tr_mul(&self.z[i]);
            self.E[i] = self.R.tr_mul(&self.E[i]);
            self.H[i] = half_trace_less(&self.E[i]);
            self.psi[i] = rotation::log(&quaternion(&self.E[i]));
        }
    }

    /// The turn of the frame in a motion of the nodes, all along the axes of the frame.
    pub fn turn(&self, Y: &[Vec3], turning: f64, motion: impl Fn(usize) -> [Vec3; 2]) -> Vec3 {
        let of_node = |(i, Y): (usize, &Vec3)| {
            let [d, theta] = motion(i);
            0.5 * Y.cross(&d) + turning * (self.H[i] * theta)
        };
        self.inverse * Y.iter().enumerate().map(of_node).sum::<Vec3>()
    }
}

/// The vector of the skew part of a matrix.
pub fn axial(A: &Mat3) -> Vec3 {
    0.5 * Vec3::new(A[(2, 1)] - A[(1, 2)], A[(0, 2)] - A[(2, 0)], A[(1, 0)] - A[(0, 1)])
}

/// ½ (tr A − A).
pub fn half_trace_less(A: &Mat3) -> Mat3 {
    0.5 * (Mat3::from_diagonal_element(A.trace()) - A)
}

/// The rotation near `R` with RᵀB symmetric, and G⁻¹; `None` where the iteration ends elsewhere than at the best.
fn fit(B: &Mat3, mut R: Mat3) -> Option<(Mat3, Mat3)> {
    for _ in 0..ITERATIONS {
        let (phi, _) = correction(B, &R)?;
        R *= rotation::matrix(&rotation::exp(&phi));
        if phi.norm() <= SMALL {
            return Some((R, correction(B, &R)?.1));
        }
    }
    None
}

/// The turn that makes RᵀB symmetric, but for its square, and G⁻¹; `None` where G is not positive.
fn correction(B: &Mat3, R: &Mat3) -> Option<(Vec3, Mat3)> {
    let S = R.tr_mul(B);
    let G = half_trace_less(&(0.5 * (S + S.transpose())));
    let inverse = G.cholesky()?.inverse();
    Some((inverse * axial(&S), inverse))
}

/// The rotation with the largest tr RᵀB, by the largest eigenvalue of a form of unit quaternions.
fn best(B: &Mat3) -> Mat3 {
    if !B.iter().all(|entry| entry.is_finite()) {
        return Mat3::identity();
    }
    let v = 2.0 * axial(B);
    let mut form = Matrix4::zeros();
    form[(0, 0)] = B.trace();
    let rest = B + B.transpose() - Mat3::from_diagonal_element(B.trace());
    form.fixed_view_mut::<3, 3>(1, 1).copy_from(&rest);
    for k in 0..3 {
        (form[(0, 1 + k)], form[(1 + k, 0)]) = (v[k], v[k]);
    }
    let eigen = form.symmetric_eigen();
    let of = eigen.eigenvectors.column(eigen.eigenvalues.imax());
    rotation::matrix(&Quaternion::new(of[0], of[1], of[2], of[3]))
}

/// The unit quaternion of a rotation matrix, from its largest component.
pub(super) fn quaternion(E: &Mat3) -> Quaternion<f64> {
    let t = E.trace();
    let squares = [1.0 + t, 1.0 + 2.0 * E[(0, 0)] - t, 1.0 + 2.0 * E[(1, 1)] - t, 1.0 + 2.0 * E[(2, 2)] - t];
    let v = 2.0 * axial(E);
    let sum = |i: usize, j: usize| E[(i, j)] + E[(j, i)];
    let largest = (1..4).fold(0, |largest, k| if squares[k] > squares[largest] { k } else { largest });
    let q = match largest {
        0 => Quaternion::new(squares[0], v.x, v.y, v.z),
        1 => Quaternion::new(v.x, squares[1], sum(0, 1), sum(0, 2)),
        2 => Quaternion::new(v.y, sum(0, 1), squares[2], sum(1, 2)),
        _ => Quaternion::new(v.z, sum(0, 2), sum(1, 2), squares[3]),
    };
    q / q.norm()
}
