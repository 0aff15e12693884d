//! A triangle with six nodes of a cross section whose warping is unknown.
//!
//! A point (y, z) of the section moves by the motion of the section and by the warping u in three directions. Its strains
//! (ε_xx, γ_xy, γ_xz, ε_yy, ε_zz, γ_yz) are Z ψ + B u + S u′, where ψ = (Γ, κ) and u′ is the rate of u along the beam. V. Giavotto et al., Anisotropic
//! beam theory and applications, Computers & Structures 16 (1983) 403-413; J. P. Blasques, User's manual for BECAS, DTU Wind Energy 2012.

use base::math::{Mat3, Mat6, Vec6};
use nalgebra::SMatrix;

/// Warping of the six nodes: along x, y and z of each.
pub type NodalWarping = SMatrix<f64, 18, 1>;

/// Strains from the warping of the nodes.
type StrainMatrix = SMatrix<f64, 6, 18>;

/// Points and weights of a rule of degree 4 (D. A. Dunavant, Int. J. Numer. Meth. Engng 21 (1985) 1129-1148): place and share of three points each.
const RULE: [(f64, f64); 2] = [(0.4459484909159649, 0.22338158967801147), (0.09157621350977074, 0.10995174365532187)];

/// A triangle of one material. Its nodes are the corners, counter-clockwise, and the middles of the edges from corners 0, 1 and 2.
#[derive(Debug, Clone)]
pub struct SectionTriangle {
    /// Corners (y, z).
    pub corners: [[f64; 2]; 3],
    /// Stresses from strains, in the order of the strains.
    pub elasticity: Mat6,
}

/// The motion of a section and of the six nodes of a triangle.
#[derive(Debug, Clone, Copy)]
pub struct WarpedState {
    /// Strains and curvatures of the beam, (Γ, κ).
    pub strain: Vec6,
    /// Warping u.
    pub warping: NodalWarping,
    /// Its rate u′ along the beam.
    pub rate: NodalWarping,
}

/// What a point contributes to integrals over the section.
struct StrainPoint {
    /// Area of the point.
    area: f64,
    /// Strains from the motion of the section.
    Z: Mat6,
    /// Strains from warping.
    B: StrainMatrix,
    /// Strains from the rate of warping.
    S: StrainMatrix,
}

/// Returns the stresses of an isotropic material from the strains of [`SectionTriangle`].
pub fn isotropic(E: f64, nu: f64) -> Mat6 {
    let G = 0.5 * E / (1.0 + nu);
    let lambda = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
    let mut Q = Mat6::from_diagonal(&Vec6::new(2.0 * G, G, G, 2.0 * G, 2.0 * G, G));
    for (i, j) in [0, 3, 4].into_iter().flat_map(|i| [0, 3, 4].map(|j| (i, j))) {
        Q[(i, j)] += lambda;
    }
    Q
}

/// An orthotropic material: axis 1 along fibres, 2 across them in the layer, 3 through it.
#[derive(Debug, Clone, Copy)]
pub struct Lamina {
    /// Young's moduli along 1, 2 and 3.
    pub moduli: [f64; 3],
    /// Shear moduli of 12, 13 and 23.
    pub shear_moduli: [f64; 3],
    /// Poisson's ratios of 12, 13 and 23: the strain along the second axis over that along the first, where stress acts along the first.
    pub ratios: [f64; 3],
}

/// The pairs of axes of the six strains.
const PAIRS: [[usize; 2]; 6] = [[0, 0], [0, 1], [0, 2], [1, 1], [2, 2], [1, 2]];

impl Lamina {
    /// Returns the stresses from the strains of [`SectionTriangle`], where the columns of `axes` are the material's axes; `None` where the energy of
    /// some strain is not positive.
    pub fn elasticity(&self, axes: &Mat3) -> Option<Mat6> {
        let Lamina { moduli: [E1, E2, E3], shear_moduli: [G12, G13, G23], ratios: [nu12, nu13, nu23] } = *self;
        let mut flexibility =
            Mat6::from_diagonal(&Vec6::new(1.0 / E1, 1.0 / G12, 1.0 / G13, 1.0 / E2, 1.0 / E3, 1.0 / G23));
        for (i, j, value) in [(0, 3, -nu12 / E1), (0, 4, -nu13 / E1), (3, 4, -nu23 / E2)] {
            (flexibility[(i, j)], flexibility[(j, i)]) = (value, value);
        }
        // Numbers are scaled to E1, as Cholesky's pivots have units.
        let own = (flexibility * E1).cholesky()?.inverse() * E1;
        let turned = Mat6::from_fn(|row, column| {
            let ([i, j], [k, l]) = (PAIRS[row], PAIRS[column]);
            let product = |k: usize, l: usize| axes[(k, i)] * axes[(l, j)];
            match (i == j, k == l) {
                (true, _) => product(k, l),
                (false, true) => 2.0 * product(k, k),
                (false, false) => product(k, l) + product(l, k),
            }
        });
        Some(turned.transpose() * own * turned)
    }
}

impl SectionTriangle {
    /// The area.
    pub fn area(&self) -> f64 {
        let [[ay, az], [by, bz], [cy, cz]] = self.corners;
        0.5 * ((by - ay) * (cz - az) - (cy - ay) * (bz - az))
    }

    /// Stiffness of the warping against itself, of the warping against ψ, and of ψ against itself: ∫ BᵀQB, ∫ BᵀQZ, ∫ ZᵀQZ.
    pub fn stiffness(&self) -> (SMatrix<f64, 18, 18>, SMatrix<f64, 18, 6>, Mat6) {
        let (mut E, mut R, mut A) = (SMatrix::zeros(), SMatrix::zeros(), Mat6::zeros());
        for point in self.points() {
            let stress = point.area * self.elasticity;
            let (of_warping, of_motion) = (stress * point.B, stress * point.Z);
            E += point.B.transpose() * of_warping;
            R += point.B.transpose() * of_motion;
            A += point.Z.transpose() * of_motion;
        }
        (E, R, A)
    }

    /// Forces on the nodes and on ψ where the strains ψ′ and the warping u′ grow along the beam: ∫ SᵀQ(Zψ′ + Bu′) − BᵀQSu′ and ∫ ZᵀQSu′. `growth`
    /// holds ψ′ as its strain and u′ as its warping.
    pub fn forces_of_growth(&self, growth: &WarpedState) -> (NodalWarping, Vec6) {
        let (mut nodal, mut whole) = (NodalWarping::zeros(), Vec6::zeros());
        for point in self.points() {
            let stress = point.area * self.elasticity;
            let ahead = stress * (point.Z * growth.strain + point.B * growth.warping);
            let own = stress * (point.S * growth.warping);
            nodal += point.S.transpose() * ahead - point.B.transpose() * own;
            whole += point.Z.transpose() * own;
        }
        (nodal, whole)
    }

    /// Twice the energy per length that each pair of states shares: ∫ εᵢᵀ Q εⱼ.
    pub fn shared_energy(&self, states: &[WarpedState; 6]) -> Mat6 {
        let mut shared = Mat6::zeros();
        for point in self.points() {
            let strains = Mat6::from_columns(&states.map(|state| point.strain(&state)));
            shared += point.area * strains.transpose() * self.elasticity * strains;
        }
        shared
    }

    /// Stresses in a state at a corner.
    pub fn stress_at(&self, corner: usize, state: &WarpedState) -> Vec6 {
        let mut place = [0.0; 3];
        place[corner] = 1.0;
        self.elasticity * self.at(place, 0.0).strain(state)
    }

    /// Integrals of 1, y, z, y², z², y z over the triangle.
    pub fn moments(&self) -> Vec6 {
        let mut sum = Vec6::zeros();
        for point in self.points() {
            let [y, z] = [-point.Z[(0, 5)], point.Z[(0, 4)]];
            sum += point.area * Vec6::new(1.0, y, z, y * y, z * z, y * z);
        }
        sum
    }

    fn points(&self) -> impl Iterator<Item = StrainPoint> {
        let area = self.area();
        RULE.into_iter().flat_map(move |(a, weight)| {
            let places = [[1.0 - 2.0 * a, a, a], [a, 1.0 - 2.0 * a, a], [a, a, 1.0 - 2.0 * a]];
            places.map(|place| self.at(place, weight * area))
        })
    }

    /// The operators at area coordinates.
    fn at(&self, L: [f64; 3], area: f64) -> StrainPoint {
        let (corners, twice) = (&self.corners, 2.0 * self.area());
        let slopes = [0, 1, 2].map(|i| {
            let ([ay, az], [by, bz]) = (corners[(i + 1) % 3], corners[(i + 2) % 3]);
            [(az - bz) / twice, (by - ay) / twice]
        });
        let [y, z] = [0, 1].map(|axis| (0..3).map(|i| L[i] * corners[i][axis]).sum::<f64>());
        let mut Z = Mat6::zeros();
        Z.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
        (Z[(0, 4)], Z[(0, 5)], Z[(1, 3)], Z[(2, 3)]) = (z, -y, -z, y);
        let (mut B, mut S) = (StrainMatrix::zeros(), StrainMatrix::zeros());
        for node in 0..6 {
            let (i, j) = (node % 3, (node + 1) % 3);
            let (N, slope) = match node {
                0..3 => (L[i] * (2.0 * L[i] - 1.0), slopes[i].map(|slope| (4.0 * L[i] - 1.0) * slope)),
                _ => (4.0 * L[i] * L[j], [0, 1].map(|axis| 4.0 * (L[i] * slopes[j][axis] + L[j] * slopes[i][axis]))),
            };
            let [dy, dz] = slope;
            let x = 3 * node;
            (S[(0, x)], S[(1, x + 1)], S[(2, x + 2)]) = (N, N, N);
            (B[(1, x)], B[(2, x)]) = (dy, dz);
            (B[(3, x + 1)], B[(4, x + 2)], B[(5, x + 1)], B[(5, x + 2)]) = (dy, dz, dz, dy);
        }
        StrainPoint { area, Z, B, S }
    }
}

impl StrainPoint {
    fn strain(&self, state: &WarpedState) -> Vec6 {
        self.Z * state.strain + self.B * state.warping + self.S * state.rate
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle() -> SectionTriangle {
        SectionTriangle { corners: [[0.2, -0.1], [1.3, 0.3], [0.4, 0.9]], elasticity: isotropic(3.0, 0.3) }
    }

    /// Motions of the section as a rigid body, as warping, are without strain; the rates of warping of a section that shears are its shear.
    #[test]
    fn rigid_motions_of_the_section_are_without_strain() {
        let triangle = triangle();
        let [a, b, c] = triangle.corners;
        let middle = |p: [f64; 2], q: [f64; 2]| [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])];
        let nodes = [a, b, c, middle(a, b), middle(b, c), middle(c, a)];
        let warping = |of: &dyn Fn([f64; 2]) -> [f64; 3]| NodalWarping::from_iterator(nodes.into_iter().flat_map(of));
        let zero = NodalWarping::zeros();
        type Field<'f> = &'f dyn Fn([f64; 2]) -> [f64; 3];
        let rigid: [Field; 4] =
            [&|_| [1.0, 0.0, 0.0], &|_| [0.0, 1.0, 0.0], &|_| [0.0, 0.0, 1.0], &|[y, z]| [0.0, -z, y]];
        let tilted: [(Field, usize); 2] = [(&|[y, _]| [-y, 0.0, 0.0], 1), (&|[_, z]| [-z, 0.0, 0.0], 2)];
        for point in triangle.points() {
            for of in rigid {
                let state = WarpedState { strain: Vec6::zeros(), warping: warping(of), rate: zero };
                assert!(point.strain(&state).amax() < 1e-14, "rounding");
            }
            for (of, shear) in tilted {
                let state = WarpedState { strain: Vec6::ith(shear, 1.0), warping: warping(of), rate: zero };
                assert!(point.strain(&state).amax() < 1e-14, "rounding: a tilt undoes the shear");
            }
            let state = WarpedState { strain: Vec6::zeros(), warping: zero, rate: warping(rigid[3]) };
            let twisted = WarpedState { strain: Vec6::ith(3, 1.0), warping: zero, rate: zero };
            assert!(
                (point.strain(&state) - point.strain(&twisted)).amax() < 1e-14,
                "rounding: a rate of rotation is a twist"
            );
        }
    }

    /// A lamina of equal axes is isotropic in any direction, and one whose fibres turn by a right angle changes its moduli.
    #[test]
    fn laminae_turn_with_their_axes() {
        let (E, nu) = (3.0, 0.3);
        let same = Lamina { moduli: [E; 3], shear_moduli: [0.5 * E / (1.0 + nu); 3], ratios: [nu; 3] };
        let axes = *nalgebra::Rotation3::from_euler_angles(0.3, -0.7, 1.1).matrix();
        let turned = same.elasticity(&axes).expect("a positive energy");
        assert!((turned - isotropic(E, nu)).amax() < 1e-14, "rounding");
        let fibres = Lamina { moduli: [20.0, 2.0, 2.0], shear_moduli: [1.0, 1.5, 0.7], ratios: [0.3, 0.3, 0.4] };
        let across = Mat3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
        let S = fibres.elasticity(&across).and_then(|Q| Q.try_inverse()).expect("an inverse");
        let exact = [(0, 0, 0.5), (3, 3, 0.05), (0, 3, -0.015), (1, 1, 1.0), (2, 2, 1.0 / 0.7), (5, 5, 1.0 / 1.5)];
        assert!(exact.iter().all(|&(i, j, value)| (S[(i, j)] - value).abs() < 1e-14), "rounding: {S}");
    }

    /// The closed forms of moments of a triangle about its centroid and the parallel axes.
    #[test]
    fn moments_are_those_of_a_triangle() {
        let triangle = triangle();
        let [p, q, r] = triangle.corners;
        let A = triangle.area();
        let mean = [0, 1].map(|k| (p[k] + q[k] + r[k]) / 3.0);
        let second =
            |i: usize, j: usize| A / 12.0 * (p[i] * p[j] + q[i] * q[j] + r[i] * r[j] + 9.0 * mean[i] * mean[j]);
        let exact = Vec6::new(A, A * mean[0], A * mean[1], second(0, 0), second(1, 1), second(0, 1));
        assert!((triangle.moments() - exact).amax() < 1e-15, "rounding");
    }
}
