//! The critical time step of a single element, and the mass that raises it to a wanted value. The fastest mode of a model is no faster than
//! the fastest mode of an element with its lumped mass (B. M. Irons, G. Treharne, A bound theorem in eigenvalues and its practical
//! applications, Proc. 3rd Conf. Matrix Methods Struct. Mech., 1971): for all φ, φᵀKφ = Σ φᵀKₑφ ≤ max κₑ Σ φᵀMₑφ.
//!
//! Thin elements are fast because their sections have little rotary inertia, κ = k G A/ρI, however long they are. Rotary inertia is raised
//! first, because it adds no mass. The limit is a radius of gyration of h/√8, with h the distance of neighbouring nodes across the axis of the
//! turn (T. J. R. Hughes, M. Cohen, M. Haroun, Nucl. Engrg Des. 46 (1978), 203-222). In a wave of length λ along h its error is of the order (h/λ)², like the
//! error of the mesh. If the element is still too fast, mass and rotary inertia are multiplied by one factor.

use super::parts::{LumpedElement, NodalShare, NodeSpacing};
use crate::tolerances::element_stability::{BISECTIONS, GYRATION, NONE, OF_USE};
use base::math::{Mat3, Vec3, skew};
use nalgebra::{DMatrix, Dyn, linalg::Cholesky};

/// The scaling of the masses of an element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElementScaling {
    /// The factor on mass and rotary inertia, 1 or more.
    pub factor: f64,
    /// The least squared radii of gyration of rotary inertia before that factor, as a tensor in global components: aᵀ g a about the
    /// principal axis a.
    pub gyration: Mat3,
}

impl ElementScaling {
    /// Masses as they are.
    pub const KEPT: ElementScaling =
        ElementScaling { factor: 1.0, gyration: Mat3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0) };

    /// The scaled share of an element at a node.
    pub fn of(&self, share: &NodalShare) -> (f64, Mat3) {
        match share.turns {
            true => (self.factor * share.mass, self.factor * raised(&share.J0, &(self.gyration * share.mass))),
            false => (self.factor * share.mass, share.J0),
        }
    }
}

/// An inertia tensor with principal moments of at least aᵀ `least` a, those that are zero aside.
fn raised(J0: &Mat3, least: &Mat3) -> Mat3 {
    let (axes, moments) = principal(J0, least);
    let least = about(&axes, least);
    let is_low = |i: usize| moments[i] > 0.0 && moments[i] < least[i];
    if !(0..3).any(is_low) {
        return *J0;
    }
    let moments = moments.zip_map(&least, |moment, least| if moment > 0.0 { moment.max(least) } else { 0.0 });
    axes * Mat3::from_diagonal(&moments) * axes.transpose()
}

/// aᵀ S a of each axis.
fn about(axes: &Mat3, S: &Mat3) -> Vec3 {
    Vec3::from_fn(|i, _| axes.column(i).dot(&(S * axes.column(i))))
}

/// Principal axes (columns) and moments of an inertia tensor; moments that are rounding are zero. If all axes are principal, the axes of
/// `S` are used.
fn principal(J0: &Mat3, S: &Mat3) -> (Mat3, Vec3) {
    if *J0 == Mat3::identity() * J0[(0, 0)] {
        return (S.symmetric_eigen().eigenvectors, J0.diagonal());
    }
    let found = J0.symmetric_eigen();
    let none = NONE * found.eigenvalues.amax();
    (found.eigenvectors, found.eigenvalues.map(|moment| if moment > none { moment } else { 0.0 }))
}

/// The scaling that limits the squared frequencies of an element to `limit`. `K` is its stiffness, row-major; `spacing` are the squares of
/// the distances of its neighbouring nodes ([`super::parts::Assembled::spacing`]). A direction without mass counts as restrained.
pub fn scaling(K: &[f64], (element, spacing): (&LumpedElement, &NodeSpacing), limit: f64) -> ElementScaling {
    let modes = ElementModes::new(K, element, spacing);
    let condensed = modes.condensed(limit);
    let are_slow =
        |part: Option<f64>| condensed.as_ref().is_some_and(|condensed| modes.are_slow(condensed, part, limit));
    if are_slow(None) {
        return ElementScaling::KEPT;
    }
    if are_slow(Some(1.0)) {
        let [mut low, mut high] = [0.0, 1.0];
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            *(if are_slow(Some(middle)) { &mut high } else { &mut low }) = middle;
        }
        return ElementScaling { factor: 1.0, gyration: gyration(spacing, high) };
    }
    match modes.heaviest(limit) {
        (factor, true) => ElementScaling { factor, gyration: gyration(spacing, 1.0) },
        (factor, false) => ElementScaling { factor, ..ElementScaling::KEPT },
    }
}

/// The least squared radii of gyration: all of the most about the normal of a shell, and this part of the most for turns that bend.
fn gyration(spacing: &NodeSpacing, part: f64) -> Mat3 {
    GYRATION * (spacing.drilling + part * spacing.bending)
}

/// The factor on the mass of an element that [`scaling`] gives it.
pub fn factor(K: &[f64], (element, spacing): (&LumpedElement, &NodeSpacing), limit: f64) -> f64 {
    let modes = ElementModes::new(K, element, spacing);
    if [Some(1.0), None].into_iter().any(|part| modes.is_slow(part, limit)) { 1.0 } else { modes.heaviest(limit).0 }
}

/// The largest square of a frequency of an element if it exceeds `limit`, with rotary inertia raised by this part of the most.
pub fn fastest(
    K: &[f64],
    (element, spacing): (&LumpedElement, &NodeSpacing),
    part: Option<f64>,
    limit: f64,
) -> Option<f64> {
    let modes = ElementModes::new(K, element, spacing);
    (!modes.is_slow(part, limit)).then(|| modes.fastest(part))
}

/// Stiffness and masses of an element in the directions with mass: translations, and principal axes of rotation.
struct ElementModes {
    K: DMatrix<f64>,
    /// Mass or moment of inertia in each direction, and for a rotation the moments that it may be raised to: about the normal of a shell,
    /// and by turns that bend.
    masses: Vec<(f64, Option<[f64; 2]>)>,
}

impl ElementModes {
    fn new(K: &[f64], element: &LumpedElement, spacing: &NodeSpacing) -> ElementModes {
        let n = K.len().isqrt();
        let dofs = n / element.0.len();
        let mut axes = DMatrix::zeros(n, n);
        let mut all = Vec::with_capacity(n);
        for (a, share) in element.0.iter().enumerate() {
            let (turned, moments) = principal(&share.J0, &gyration(spacing, 1.0));
            let of = |S: &Mat3| GYRATION * share.mass * about(&turned, S);
            let (drilling, bending) = (of(&spacing.drilling), of(&spacing.bending));
            for i in 0..3 {
                axes[(dofs * a + i, dofs * a + i)] = 1.0;
            }
            all.extend([(share.mass, None); 3]);
            if dofs == 6 && share.turns {
                axes.view_mut((dofs * a + 3, dofs * a + 3), (3, 3)).copy_from(&turned);
                if share.arm != Vec3::zeros() {
                    // Turning about the centre of mass moves the node of the element.
                    axes.view_mut((dofs * a, dofs * a + 3), (3, 3)).copy_from(&(skew(&share.arm) * turned));
                }
                all.extend((0..3).map(|i| (moments[i], Some([drilling[i], bending[i]]))));
            } else if dofs == 6 {
                // What turns with a body turns slowly.
                all.extend([(0.0, Some([0.0; 2])); 3]);
            }
        }
        let K = DMatrix::from_row_slice(n, n, K);
        let K = axes.tr_mul(&(0.5 * (&K + K.transpose()))) * axes;
        let kept: Vec<usize> = (0..n).filter(|&i| all[i].0 > 0.0).collect();
        ElementModes { K: K.select_rows(&kept).select_columns(&kept), masses: kept.iter().map(|&i| all[i]).collect() }
    }

    /// The mass in a direction where rotary inertia is raised, by this part of the largest for turns that bend; `None`: as it is.
    fn mass(&self, i: usize, part: Option<f64>) -> f64 {
        match (self.masses[i], part) {
            ((moment, Some([drilling, bending])), Some(part)) => moment.max(drilling + part * bending),
            ((mass, _), _) => mass,
        }
    }

    /// The factor on the masses of an element that is too fast, and true if rotary inertia is raised besides.
    fn heaviest(&self, limit: f64) -> (f64, bool) {
        let [plain, raised] = [None, Some(1.0)].map(|part| self.fastest(part));
        let is_of_use = raised < (1.0 - OF_USE) * plain;
        (if is_of_use { raised } else { plain } / limit, is_of_use)
    }

    /// True if no squared frequency exceeds the limit.
    fn is_slow(&self, part: Option<f64>, limit: f64) -> bool {
        self.condensed(limit).is_some_and(|condensed| self.are_slow(&condensed, part, limit))
    }

    /// The largest square of a frequency.
    fn fastest(&self, part: Option<f64>) -> f64 {
        let roots: Vec<f64> = (0..self.masses.len()).map(|i| self.mass(i, part).sqrt()).collect();
        let K = DMatrix::from_fn(roots.len(), roots.len(), |i, j| self.K[(i, j)] / (roots[i] * roots[j]));
        K.symmetric_eigenvalues().max()
    }

    /// The stiffness of rotations with the response of translations at κ = `limit`: K_rr + K_rt (κ M_t − K_tt)⁻¹ K_tr. `None` if
    /// translations alone exceed the limit.
    fn condensed(&self, limit: f64) -> Option<DMatrix<f64>> {
        let (turns, moves): (Vec<usize>, Vec<usize>) =
            (0..self.masses.len()).partition(|&i| self.masses[i].1.is_some());
        let block = |a: &[usize], b: &[usize]| DMatrix::from_fn(a.len(), b.len(), |i, j| self.K[(a[i], b[j])]);
        let across = block(&moves, &turns);
        let answer = self.rest(&block(&moves, &moves), &moves, None, limit)?.solve(&across);
        Some(block(&turns, &turns) + across.tr_mul(&answer))
    }

    /// True if no squared frequency exceeds the limit: κ M − K is positive definite, and so is its Schur complement from `condensed`.
    fn are_slow(&self, condensed: &DMatrix<f64>, part: Option<f64>, limit: f64) -> bool {
        let turns: Vec<usize> = (0..self.masses.len()).filter(|&i| self.masses[i].1.is_some()).collect();
        self.rest(condensed, &turns, part, limit).is_some()
    }

    /// The Cholesky factor of κ M − K in some of the directions; `None` if it is not positive definite.
    fn rest(&self, K: &DMatrix<f64>, of: &[usize], part: Option<f64>, limit: f64) -> Option<Cholesky<f64, Dyn>> {
        let mut rest = -K;
        of.iter().enumerate().for_each(|(i, &of)| rest[(i, i)] += limit * self.mass(of, part));
        Cholesky::new(rest)
    }
}
