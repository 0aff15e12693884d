//! The rotation vector φ = log(R_a R_bᵀ) from a second node b to a first node a, components along global axes.
//!
//! With the spins of both nodes φ̇ = T⁻¹(φ) ω_a − T⁻ᵀ(φ) ω_b. A turn Q of both nodes turns φ with them. The weighted mean of φ over several
//! second nodes is zero where R_a is their mean on the rotation group: the mean does not depend on axes, and its moments are in equilibrium.
//! (M. Moakher, SIAM J. Matrix Anal. Appl. 24 (2002).)

use crate::state::Node;
use base::math::{Mat3, Vec3, Vec6, rotation, stack};

fn vector(a: &Node, b: &Node) -> Vec3 {
    rotation::log(&(a.rotation * b.rotation.conjugate()))
}

/// φ with its first two derivatives in time.
pub fn value(a: &Node, b: &Node) -> [Vec3; 3] {
    let phi = vector(a, b);
    let turn = a.R() * b.R().transpose();
    let carried = turn * b.omega;
    let spin = a.omega - carried;
    let acceleration = a.alpha - turn * b.alpha - spin.cross(&carried);
    let (rate, second) = rotation::vector_rates(&phi, &spin, &acceleration);
    [phi, rate, second]
}

/// The gradient of a component of φ by positions and rotations of both nodes.
pub fn gradient(a: &Node, b: &Node, axis: usize) -> [Vec6; 2] {
    let T_inv = rotation::inverse_tangent_matrix(&vector(a, b));
    let [of_a, of_b] = [T_inv.row(axis).transpose(), T_inv.column(axis).into_owned()];
    [stack(&Vec3::zeros(), &of_a), stack(&Vec3::zeros(), &-of_b)]
}

/// Adds the second derivative of φ·m by the rotations, in the blocks of [`super::joint::ConstraintEquation::stiffness`].
pub fn stiffness(a: &Node, b: &Node, m: &Vec3, add: &mut impl FnMut(usize, usize, Mat3)) {
    let phi = vector(a, b);
    let T_inv = rotation::inverse_tangent_matrix(&phi);
    // The moments T⁻ᵀ(φ) m on a and −T⁻¹(φ) m = −T⁻ᵀ(−φ) m on b.
    let [of_a, of_b] = [phi, -phi].map(|phi| rotation::inverse_tangent_transpose_derivative(&phi, m));
    add(1, 1, of_a * T_inv);
    add(1, 3, -of_a * T_inv.transpose());
    add(3, 1, of_b * T_inv);
    add(3, 3, -of_b * T_inv.transpose());
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::math::angular;

    fn turned(start: Vec3, spin: &Vec3) -> Node {
        Node { rotation: rotation::exp(spin) * rotation::exp(&start), ..Node::at_rest(Vec3::zeros()) }
    }

    const STARTS: [Vec3; 2] = [Vec3::new(0.9, -0.7, 0.4), Vec3::new(-0.3, 0.5, 0.8)];

    #[test]
    fn gradient_stiffness_and_rates_are_derivatives() {
        // Central differences: h² is 1e-8.
        let (h, m) = (1e-4, Vec3::new(0.7, -1.1, 0.6));
        let at = |spins: [Vec3; 2]| std::array::from_fn::<Node, 2, _>(|k| turned(STARTS[k], &spins[k]));
        let moments = |[a, b]: [Node; 2]| {
            let of = |end: usize| -> Vec3 { (0..3).map(|axis| m[axis] * angular(&gradient(&a, &b, axis)[end])).sum() };
            [of(0), of(1)]
        };
        let [a, b] = at([Vec3::zeros(); 2]);
        let mut K = [[Mat3::zeros(); 2]; 2];
        stiffness(&a, &b, &m, &mut |i, j, block| K[i / 2][j / 2] += block);
        for end in 0..2 {
            for i in 0..3 {
                let moved = |h: f64| {
                    let mut spins = [Vec3::zeros(); 2];
                    spins[end][i] = h;
                    at(spins)
                };
                let [back, ahead] = [moved(-h), moved(h)];
                let slope = (vector(&ahead[0], &ahead[1]) - vector(&back[0], &back[1])).dot(&m) / (2.0 * h);
                assert!((slope - moments(at([Vec3::zeros(); 2]))[end][i]).abs() < 1e-7, "{end} {i}");
                let (back, ahead) = (moments(back), moments(ahead));
                for row in 0..2 {
                    let change = (ahead[row] - back[row]) / (2.0 * h);
                    assert!((K[row][end].column(i) - change).amax() < 1e-6, "{row} {end} {i}");
                }
            }
        }
        let omegas = [Vec3::new(0.3, 0.8, -0.5), Vec3::new(-0.6, 0.2, 0.9)];
        let spinning = |t: f64| {
            let [a, b] = at(omegas.map(|omega| t * omega));
            [Node { omega: omegas[0], ..a }, Node { omega: omegas[1], ..b }]
        };
        let of = |t: f64| value(&spinning(t)[0], &spinning(t)[1]);
        let [_, rate, second] = of(0.0);
        assert!((rate - (of(h)[0] - of(-h)[0]) / (2.0 * h)).amax() < 1e-7);
        assert!((second - (of(h)[1] - of(-h)[1]) / (2.0 * h)).amax() < 1e-7);
    }

    #[test]
    fn a_turn_of_both_nodes_turns_the_vector() {
        let [a, b] = STARTS.map(|start| turned(start, &Vec3::zeros()));
        let by = Vec3::new(1.9, -0.8, 2.1);
        let [c, d] = STARTS.map(|start| turned(start, &by));
        // Rounding of quaternions.
        assert!((rotation::matrix(&rotation::exp(&by)) * vector(&a, &b) - vector(&c, &d)).amax() < 1e-15 * 8.0);
    }
}
