//! Complex modes (K + s C + s² M) φ = 0 with damping and the gyroscopic moments of bodies that spin; K need not be symmetric.
//!
//! With z = (φ, s φ) the roots nearest to a shift σ are the largest eigenvalues 1/(s − σ) of
//!   φ' = −(K + σ C + σ² M)⁻¹ (C φ + M (s φ + σ φ)),   (s φ)' = φ + σ φ',
//! a real operator for a real shift (F. Tisseur & K. Meerbergen, SIAM Rev. 43 (2001)). The shift is positive, where lasting and decaying
//! motions have no root, so motions without stiffness are no exception.

use super::fault::ModesFault;
use super::gyroscopic::Gyroscopic;
use super::linearized::Linearized;
use super::modal::{fewer, lowest_square, natural_pairs};
use super::mode::ModeKind;
use super::mode::{EigenMode, Modes};
use super::pencil::{Pencil, weights};
use super::shape::Shapes;
use crate::system::assembly::Assembly;
use crate::tolerances::damped::{DOUBTFUL, GROWS, INFINITE, SPLIT, TOLERANCE, UP_TO, WIDTH, ZERO};
use crate::tolerances::modal::LOW;
use base::math::Vec6;
use linear::eigen::{Arnoldi, Complex, ComplexPair, Operator};
use linear::{Solver, Sparse};
use model::ModeExtent;
use std::f64::consts::TAU;

/// The range of the search for roots.
#[derive(Clone, Copy)]
struct Near {
    /// The shift σ.
    shift: f64,
    /// Roots up to this size are zero.
    zero: f64,
}

/// The operator of a shift.
struct Quadratic<'q, 'a> {
    pencil: &'q mut Pencil<'a>,
    damping: &'q Sparse,
    shift: f64,
    /// Weights of motions, and the squared frequency that weights velocities.
    diagonal: Vec<f64>,
    square: f64,
    scratch: Vec<f64>,
}

impl Operator for Quadratic<'_, '_> {
    fn dimension(&self) -> usize {
        2 * self.diagonal.len()
    }

    fn apply(&mut self, z: &[f64], out: &mut [f64]) {
        let n = self.diagonal.len();
        let ((x, y), (new_x, new_y)) = (z.split_at(n), out.split_at_mut(n));
        self.scratch.iter_mut().zip(x).zip(y).for_each(|((sum, x), y)| *sum = y + self.shift * x);
        self.pencil.mass.multiply(&self.scratch, new_x);
        self.damping.multiply(x, &mut self.scratch);
        new_x.iter_mut().zip(&self.scratch).for_each(|(b, c)| *b = -(*b + c));
        self.pencil.solve(new_x);
        new_y.iter_mut().zip(x).zip(&*new_x).for_each(|((y, x), new)| *y = x + self.shift * new);
    }

    fn is_stopped(&self) -> bool {
        self.pencil.at.is_stopped()
    }

    fn weigh(&self, z: &[f64], out: &mut [f64]) {
        let n = self.diagonal.len();
        for i in 0..n {
            out[i] = self.diagonal[i] * z[i];
            out[n + i] = self.diagonal[i] / self.square * z[n + i];
        }
    }
}

/// Finds the complex modes of the model up to an extent.
///
/// # Errors
/// The reason why there are none.
pub fn damped_modes(
    at: &Linearized,
    extent: ModeExtent,
    linear: (&mut Solver, &mut Assembly),
) -> Result<Modes, ModesFault> {
    let gyroscopic = Gyroscopic::of(at);
    let (near, free, natural) = {
        let mut pencil = Pencil::new(*at, (&mut *linear.0, &mut *linear.1));
        if pencil.mass.is_zero() {
            return Err(ModesFault::NoMass);
        }
        let (square, free) = lowest_square(&mut pencil)?;
        let shift = square.sqrt();
        let rounding = if free { Shapes::new(&pencil).rounding(&pencil).sqrt() } else { 0.0 };
        let near = Near { shift, zero: (ZERO * shift).max(SPLIT * rounding) };
        let has_potential = at.has_potential();
        let free = if free && has_potential { Some(free_modes(&mut pencil, near)?) } else { None };
        (near, free, pencil.factorizations)
    };
    let unsymmetric = gyroscopic.acts() || !at.has_potential();
    let mut own = unsymmetric.then(|| at.unsymmetric_solver()).transpose()?;
    let mut pencil = match &mut own {
        Some((solver, assembly)) => Pencil::new(*at, (solver, assembly)),
        None => Pencil::new(*at, linear),
    };
    let shapes = Shapes::new(&pencil);
    let pairs = allowed(&mut pencil, &gyroscopic, near, extent)?;
    let mut list =
        roots(&pairs, near).map(|(root, pair)| shapes.complex(&pencil, root, pair)).collect::<Vec<EigenMode>>();
    if let Some(free) = free {
        list.retain(|mode| mode.root != [0.0; 2]);
        list.extend(free);
    }
    list.sort_by(|a, b| size(a.root).total_cmp(&size(b.root)));
    match extent {
        ModeExtent::Count(count) => list.truncate(count),
        ModeExtent::UpTo(frequency) => list.retain(|mode| mode.frequency() <= frequency),
    }
    let mut warnings = gyroscopic.warnings.clone();
    if let (found, ModeExtent::Count(count)) = (list.len(), extent)
        && found < count
    {
        warnings.push(fewer(found, count));
    }
    if near.zero > DOUBTFUL * near.shift {
        warnings
            .push(format!(
                "roots below {:.3e} Hz are rounding error, and are written as zero. Replace the stiffest parts by rigid bodies to resolve them",
                near.zero / TAU
            ));
    }
    list.iter_mut().for_each(|mode| mode.whirl = gyroscopic.whirl(at, mode));
    let unstable = list.iter().filter(|mode| mode.root[0] > GROWS * size(mode.root)).count();
    let (factorizations, solves) = (natural + pencil.factorizations, pencil.solves);
    let (kind, masses) = (ModeKind::Natural, shapes.masses);
    Ok(Modes { kind, list, masses, unstable, factorizations, solves, warnings, ..Modes::default() })
}

/// The motions without stiffness. Each is a root at zero, whatever its damping. The roots are multiple. With too few vectors a Krylov space
/// contains only some of them.
fn free_modes(pencil: &mut Pencil, near: Near) -> Result<Vec<EigenMode>, ModesFault> {
    let up_to = near.zero.max(LOW.sqrt() * near.shift);
    let pairs = natural_pairs(pencil, ModeExtent::UpTo(up_to / TAU))?;
    let modes = Shapes::new(pencil).natural(pencil, &pairs).into_iter();
    let is_free = |mode: &EigenMode| size(mode.root) <= near.zero;
    let as_complex = |mode: EigenMode| {
        let quadrature = vec![Vec6::zeros(); mode.shape.len()];
        EigenMode { root: [0.0; 2], quadrature, modal_mass: 0.0, lost: None, ..mode }
    };
    Ok(modes.filter(is_free).map(as_complex).collect())
}

/// The wanted number of eigenvalues, without infinite ones and those of motions that joints restrain. Where these take the places of others
/// the search is for more.
fn allowed(
    pencil: &mut Pencil,
    gyroscopic: &Gyroscopic,
    near: Near,
    extent: ModeExtent,
) -> Result<Vec<ComplexPair>, ModesFault> {
    let mut asked = extent;
    loop {
        let mut pairs = nearest(pencil, gyroscopic, near, asked)?;
        let (found, unknowns) = (pairs.len(), pencil.at.unknowns());
        let largest = pairs.iter().map(|pair| size(pair.theta)).fold(0.0, f64::max);
        pairs.retain(|pair| {
            size(pair.theta) > INFINITE * largest
                && pencil.allows(&[&pair.real[..unknowns], &pair.imaginary[..unknowns]])
        });
        let listed = roots(&pairs, near).count();
        match (extent, asked) {
            (ModeExtent::Count(count), ModeExtent::Count(so_far)) if listed < count && so_far <= count + found => {
                asked = ModeExtent::Count(so_far + count - listed);
            }
            _ => return Ok(pairs),
        }
    }
}

/// The wanted number of eigenvalues 1/(s − σ) of the roots nearest to the shift.
fn nearest(
    pencil: &mut Pencil,
    gyroscopic: &Gyroscopic,
    near: Near,
    extent: ModeExtent,
) -> Result<Vec<ComplexPair>, ModesFault> {
    let shift = near.shift;
    let (unknowns, threads) = (pencil.at.unknowns(), pencil.at.plan.threads > 1);
    let (plain, with_rates) = (pencil.matrix(weights(0.0, 0.0)), pencil.matrix(weights(1.0, 0.0)));
    let of_bodies = Sparse::from_entries(unknowns, |visit| gyroscopic.damping(visit));
    let damping = Sparse::sum(&[(1.0, &with_rates), (-1.0, &plain), (1.0, &of_bodies)]);
    pencil.factor_quadratic(shift, gyroscopic).map_err(|row| pencil.singular(row))?;
    let square = shift * shift;
    let diagonal = |row: usize| {
        let of = |matrix: &Sparse| {
            matrix.row(row).filter(|(column, _)| *column == row).map(|(_, value)| value).sum::<f64>().abs()
        };
        (of(&plain) + square * of(&pencil.mass)).max(f64::MIN_POSITIVE)
    };
    let diagonal: Vec<f64> = (0..unknowns).map(diagonal).collect();
    let scratch = vec![0.0; unknowns];
    let mut operator = Quadratic { pencil, damping: &damping, shift, diagonal, square, scratch };
    let wanted = if let ModeExtent::Count(count) = extent { count } else { UP_TO };
    let most = 12 * wanted + 240;
    let mut arnoldi = Arnoldi::new(&mut operator, WIDTH, threads);
    let enough = |thetas: &[Complex]| enough(thetas, near, extent);
    let converged = arnoldi.converge(&mut operator, TOLERANCE, most, enough);
    converged.ok_or_else(|| operator.pencil.not_converged(wanted))
}

fn size(root: Complex) -> f64 {
    root[0].hypot(root[1])
}

/// s = σ + 1/θ.
fn root(theta: Complex, Near { shift, zero }: Near) -> Complex {
    let square = theta[0] * theta[0] + theta[1] * theta[1];
    let s = [shift + theta[0] / square, -theta[1] / square];
    if size(s) <= zero { [0.0; 2] } else { s }
}

/// Modes of some roots: the upper one of two conjugate roots, and one for the double root of a motion without stiffness.
fn roots(pairs: &[ComplexPair], near: Near) -> impl Iterator<Item = (Complex, &ComplexPair)> {
    let mut zeros = 0;
    pairs.iter().filter_map(move |pair| {
        let s = root(pair.theta, near);
        if s == [0.0; 2] {
            zeros += 1;
            return (zeros % 2 == 1).then_some((s, pair));
        }
        // A root on the real axis, to the digits of a double root, does not oscillate.
        let s = if s[1].abs() <= 1e-9 * s[0].abs() { [s[0], 0.0] } else { s };
        (s[1] >= 0.0).then_some((s, pair))
    })
}

/// Number of roots, nearest to the shift first, that include all modes wanted; `None` if there are too few.
fn enough(thetas: &[Complex], near: Near, extent: ModeExtent) -> Option<usize> {
    let all: Vec<Complex> = thetas.iter().map(|theta| root(*theta, near)).collect();
    let distance = |theta: &Complex| 1.0 / size(*theta);
    let reached = thetas.last().map_or(0.0, distance);
    // Within this distance of zero every root is nearer to the shift than the farthest root found.
    let radius = reached - near.shift;
    let there = all.iter().filter(|s| size(**s) <= radius);
    match extent {
        ModeExtent::Count(count) => {
            let zeros = there.clone().filter(|s| **s == [0.0; 2]).count();
            let others = there.filter(|s| size(**s) > 0.0 && s[1] >= 0.0).count();
            (zeros.div_ceil(2) + others >= count).then_some(thetas.len())
        }
        ModeExtent::UpTo(frequency) => (radius >= TAU * frequency).then_some(thetas.len()),
    }
}
