//! The response by natural modes.
//!
//! The modes found respond with their inertia and with Ĉ = ΦᵀCΦ, which may be full. All others respond as springs with the first inertia
//! term (mode acceleration and its next term; R. R. Craig & A. J. Kurdila, Fundamentals of Structural Dynamics (2006), chapter 11). Local
//! dampers add motions to these modes ([`super::damped_rest`]). With the shift s, for which K − sM is factorized, and the projection P off
//! the modes found,
//!   x = Σ φ q + P (r + (ω² − s) S M r),   r = S f,   S = (K − s M)⁻¹.
//! Moving supports move the model statically by S; forces of inertia and damping remain. The damping ratio of modes refers to motions
//! relative to the static motion with the supports. Inertia forces of that motion are computed by S with a relative error s/λ.

use super::super::fault::ModesFault;
use super::super::gyroscopic::Gyroscopic;
use super::super::linearized::Linearized;
use super::super::modal::{left_out, natural_pairs};
use super::super::mode::Modes;
use super::super::pencil::Pencil;
use super::super::shape::Shapes;
use super::super::steady::{Response, ResponseProgress};
use super::damped_rest::{RestMotion, dot, rest_motions};
use super::excitation::{C64, HarmonicExcitation};
use super::frequencies::frequencies;
use super::look_up::look_up;
use super::matrices::Matrices;
use super::resonance::resonances_in_words;
use crate::modes::mode::ModeKind;
use crate::system::assembly::Assembly;
use crate::tolerances::modal_response::{COUPLED, NEAR, NOTHING_LEFT, UNDRIVEN, ZERO};
use base::math::Vec6;
use base::names::short;
use linear::{Solver, Sparse};
use model::{ModeExtent, ResponseAsked};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::TAU;

/// A mode: λ = ω² and φ of modal mass 1.
type Pair = (f64, Vec<f64>);

/// Finds the response.
///
/// # Errors
/// The reason why there is none.
pub fn response(
    at: &Linearized,
    asked: &ResponseAsked,
    linear: (&mut Solver, &mut Assembly),
    progress: &mut ResponseProgress,
) -> Result<Modes, ModesFault> {
    let mut pencil = Pencil::new(*at, linear);
    if pencil.mass.is_zero() {
        return Err(ModesFault::NoMass);
    }
    let excitation = HarmonicExcitation::of(&pencil, false)?;
    if excitation.is_nothing() {
        return Err(ModesFault::NothingExcites);
    }
    let extent = at.model.analysis.extent();
    let pairs = natural_pairs(&mut pencil, extent)?;
    let shapes = Shapes::new(&pencil);
    let list = shapes.natural(&pencil, &pairs);
    let natural: Vec<f64> = list.iter().map(|mode| mode.frequency()).collect();
    let all = frequencies(asked, &natural);
    let highest = all.last().copied().unwrap_or_default();
    let gyroscopic = Gyroscopic::of(at);
    let matrices = Matrices::of(&mut pencil, &gyroscopic);
    let shift = shift(&mut pencil, &pairs)?;
    let rest = if gyroscopic.acts() {
        Vec::new()
    } else {
        rest_motions(&mut pencil, &matrices, &pairs, |at, x| remove_modes(at, &pairs, x))
    };
    let mut space = Space::new((&pairs, &rest), &matrices.C, asked.damping_ratio, shift);
    let parts = space.parts(&mut pencil, &excitation, &matrices);
    let mut response = Response::of(at, std::mem::take(&mut progress.so_far.rows));
    let motion = Motion::new(&pencil, &space, &parts, &excitation, &response.nodes);
    let known = response.rows.len().min(all.len());
    for &frequency in &all[known..] {
        if let Err(stopped) = look_up(at, response.rows.len() > known, &mut *progress.pauses) {
            progress.so_far.rows = response.rows;
            return Err(stopped);
        }
        let (row, mode) = motion.at(&space, &parts, &excitation, frequency);
        response.add(frequency, row);
        progress.so_far.resonances.extend(mode.map(|mode| (frequency, Some(mode))));
    }
    let truncated = truncation((&natural, extent), pencil.at.unknowns(), highest, gyroscopic.acts());
    let mut warnings = gyroscopic.warnings;
    warnings.extend(resonances_in_words(&progress.so_far.resonances));
    warnings.extend(truncated);
    warnings.extend(left_out(at).into_iter().filter(|_| !at.has_potential()));
    let unstable = list.iter().filter(|mode| mode.root[0] > 0.0).count();
    let (factorizations, solves) = (pencil.factorizations, pencil.solves);
    let (kind, masses, response) = (ModeKind::Natural, shapes.masses, Some(response));
    Ok(Modes { kind, list, masses, unstable, factorizations, solves, warnings, response, ..Modes::default() })
}

/// Error from modes that were not found, in words, where it may be visible.
fn truncation((natural, extent): (&[f64], ModeExtent), unknowns: usize, highest: f64, spins: bool) -> Option<String> {
    let (last, all) = match extent {
        ModeExtent::UpTo(frequency) => (frequency, false),
        // If fewer modes than wanted were found, there are no others.
        ModeExtent::Count(count) => (natural.last().copied().unwrap_or_default(), natural.len() < count),
    };
    if all || natural.len() >= unknowns || !(spins || highest > NEAR * last) {
        return None;
    }
    let what = if spins { "gyroscopic moments and damping" } else { "damping" };
    Some(format!(
        "the modes found reach up to frequency {}; the response of all others is static, without {what}. Give `up_to` = {}, or `method` = \
         \"direct\"",
        short(last),
        short(2.0 * last.max(highest))
    ))
}

/// Factorises at a shift: zero where nothing moves without stiffness, else below zero.
fn shift(pencil: &mut Pencil, pairs: &[Pair]) -> Result<f64, ModesFault> {
    let largest = pairs.iter().map(|(lambda, _)| lambda.abs()).fold(0.0, f64::max);
    let stiff = pairs.iter().all(|(lambda, _)| *lambda > ZERO * largest);
    let lowest = pairs.iter().map(|(lambda, _)| *lambda).find(|lambda| *lambda > ZERO * largest);
    let scale = lowest.unwrap_or_else(|| pencil.least_ratio());
    let mut row = 0;
    for shift in [0.0, -scale, -1.7 * scale].into_iter().skip(usize::from(!stiff)) {
        match pencil.factor(shift) {
            Ok(_) => return Ok(shift),
            Err(at) => row = at,
        }
    }
    Err(pencil.singular(row))
}

/// The space of the modes found.
struct Space<'p> {
    pairs: &'p [Pair],
    /// Motions that their dampers cause besides, numbered after them.
    rest: &'p [RestMotion],
    /// Ĉ with the damping ratio of modes.
    damping: DMatrix<f64>,
    /// True where Ĉ is diagonal to rounding.
    diagonal: bool,
    shift: f64,
    /// By mode, the damping by its ratio times s/λ; 0 for motions without stiffness, which have no ratio.
    carried: Vec<f64>,
}

/// A force whose response is known but for a factor at each frequency.
struct Part {
    /// The forces on the modes.
    modal: Vec<f64>,
    /// Response of all other modes: P r, and P S M r.
    rest: [Vec<f64>; 2],
}

/// The forces of an excitation: of loads, then of inertia and of damping for each motion of supports, with the motion that follows these.
struct Parts {
    loads: Vec<Part>,
    supports: Vec<(Vec<f64>, Part, Part)>,
}

impl<'p> Space<'p> {
    fn new((pairs, rest): (&'p [Pair], &'p [RestMotion]), C: &Sparse, ratio: f64, shift: f64) -> Space<'p> {
        let shapes: Vec<&Vec<f64>> = pairs.iter().map(|(_, phi)| phi).chain(rest.iter().map(|of| &of.shape)).collect();
        let squares = pairs.iter().map(|(lambda, _)| *lambda).chain(rest.iter().map(|of| of.stiffness * of.mass));
        let m = shapes.len();
        let mut damping = DMatrix::zeros(m, m);
        for (j, (phi, square)) in shapes.iter().zip(squares).enumerate() {
            let mut product = vec![0.0; phi.len()];
            C.multiply(phi, &mut product);
            for (i, other) in shapes.iter().enumerate() {
                damping[(i, j)] = dot(other, &product);
            }
            damping[(j, j)] += 2.0 * ratio * square.max(0.0).sqrt();
        }
        let largest = damping.amax();
        let beside = |i: usize, j: usize| if i == j { 0.0 } else { damping[(i, j)].abs() };
        let coupled = (0..m).flat_map(|i| (0..m).map(move |j| (i, j))).any(|(i, j)| beside(i, j) > COUPLED * largest);
        let stiffest = pairs.iter().map(|(lambda, _)| lambda.abs()).fold(0.0, f64::max);
        let stiff = |lambda: f64| lambda > ZERO * stiffest;
        let carried =
            pairs.iter().map(|(lambda, _)| if stiff(*lambda) { 2.0 * ratio * shift / lambda.sqrt() } else { 0.0 });
        // The further effect of dampers has its own mass and is not carried.
        let carried = carried.chain(rest.iter().map(|_| 0.0)).collect();
        Space { pairs, rest, damping, diagonal: !coupled, shift, carried }
    }

    /// The response to a force: its modal parts, and the static and the first inertia term of the rest.
    fn part(&mut self, pencil: &mut Pencil, force: &[f64]) -> Part {
        let modal = self.shapes().map(|phi| dot(phi, force)).collect();
        let mut first = force.to_vec();
        pencil.solve(&mut first);
        self.remove(pencil, force, &mut first);
        let mut inertia = vec![0.0; first.len()];
        pencil.mass.multiply(&first, &mut inertia);
        let mut second = inertia.clone();
        pencil.solve(&mut second);
        self.remove(pencil, &inertia, &mut second);
        Part { modal, rest: [first, second] }
    }

    /// The modes, then the motions besides.
    fn shapes(&self) -> impl Iterator<Item = &Vec<f64>> {
        self.pairs.iter().map(|(_, phi)| phi).chain(self.rest.iter().map(|of| &of.shape))
    }

    /// Projects the modes and further motions out of the response S g to a force g.
    fn remove(&self, pencil: &Pencil, force: &[f64], x: &mut [f64]) {
        remove_modes(pencil, self.pairs, x);
        for RestMotion { shape, stiffness, mass } in self.rest {
            let part = dot(shape, force) / (stiffness - self.shift * mass);
            x.iter_mut().zip(shape).for_each(|(x, shape)| *x -= part * shape);
        }
    }

    fn parts(&mut self, pencil: &mut Pencil, excitation: &HarmonicExcitation, matrices: &Matrices) -> Parts {
        let loads = excitation.loads.iter().map(|(_, force)| self.part(pencil, force)).collect();
        let mut supports = Vec::new();
        for motion in &excitation.motions {
            let [K, C, M] = &motion.forces;
            let mut x: Vec<f64> = K.iter().zip(M).map(|(k, m)| self.shift * m - k).collect();
            pencil.follow(&mut x, &motion.moved);
            let with = |matrix: &Sparse, of_supports: &[f64]| {
                let mut force = vec![0.0; x.len()];
                matrix.multiply(&x, &mut force);
                force.iter_mut().zip(of_supports).for_each(|(force, more)| *force += more);
                force
            };
            let (inertia, damping) = (with(&matrices.M, M), with(&matrices.C, C));
            let parts = (self.part(pencil, &inertia), self.part(pencil, &damping));
            supports.push((x, parts.0, parts.1));
        }
        Parts { loads, supports }
    }

    /// Dynamic stiffness of a motion at the square of an angular frequency.
    fn stiffness(&self, i: usize, square: f64) -> f64 {
        match i.checked_sub(self.pairs.len()) {
            None => self.pairs[i].0 - square,
            Some(k) => self.rest[k].stiffness - square * self.rest[k].mass,
        }
    }

    /// The factors of the modes for these forces on them.
    fn coordinates(&self, omega: f64, forces: DVector<C64>) -> DVector<C64> {
        let square = omega * omega;
        let entry = |i: usize, j: usize| {
            let stiffness = if i == j { self.stiffness(i, square) } else { 0.0 };
            C64::new(stiffness, omega * self.damping[(i, j)])
        };
        if self.diagonal {
            return DVector::from_iterator(forces.len(), forces.iter().enumerate().map(|(i, f)| f / entry(i, i)));
        }
        let m = forces.len();
        let none = forces.map(|_| C64::new(f64::INFINITY, 0.0));
        DMatrix::from_fn(m, m, entry).lu().solve(&forces).unwrap_or(none)
    }

    /// The mode, from 0, that these forces drive at its own frequency with nothing to limit it, if there is one.
    fn resonance(&self, omega: f64, forces: &DVector<C64>) -> Option<usize> {
        let square = omega * omega;
        let largest = forces.camax();
        let is_free = |i: usize| {
            let left = C64::new(self.pairs[i].0 - square, omega * self.damping[(i, i)]).norm();
            square > 0.0 && left < NOTHING_LEFT * square && forces[i].norm() > UNDRIVEN * largest
        };
        (0..self.pairs.len()).find(|&i| is_free(i))
    }
}

/// The motions of the nodes wanted that the two parts of [`Part::rest`] are.
type Rest = [Vec<Vec6>; 2];

/// The motions of the nodes wanted, of modes and of all other parts.
struct Motion {
    modes: Vec<Vec<Vec6>>,
    loads: Vec<Rest>,
    /// Static motion with each support, then the responses to its inertia and damping.
    supports: Vec<(Vec<Vec6>, [Rest; 2])>,
}

impl Motion {
    fn new(pencil: &Pencil, space: &Space, parts: &Parts, excitation: &HarmonicExcitation, nodes: &[usize]) -> Motion {
        let at = pencil.at;
        let of = |x: &Vec<f64>| -> Vec<Vec6> {
            let all = at.motions(&pencil.nodes, x);
            nodes.iter().map(|&node| all[node]).collect()
        };
        let rest = |part: &Part| part.rest.each_ref().map(&of);
        let supports = parts.supports.iter().zip(&excitation.motions).map(|((x, inertia, damping), motion)| {
            let mut moved = of(x);
            moved.iter_mut().zip(nodes).for_each(|(moved, &node)| *moved += motion.moved[node]);
            (moved, [rest(inertia), rest(damping)])
        });
        Motion {
            modes: space.shapes().map(of).collect(),
            loads: parts.loads.iter().map(rest).collect(),
            supports: supports.collect(),
        }
    }

    /// The motions at a frequency, complex. Without a limit the motions are not finite, and the mode is returned, counted from 0.
    fn at(
        &self,
        space: &Space,
        parts: &Parts,
        excitation: &HarmonicExcitation,
        frequency: f64,
    ) -> (Vec<[C64; 6]>, Option<usize>) {
        let omega = TAU * frequency;
        let beyond = omega * omega - space.shift;
        let mut forces = DVector::from_element(space.shapes().count(), C64::new(0.0, 0.0));
        let mut sum: Vec<[C64; 6]> = Vec::new();
        let mut carried = Vec::new();
        let mut add = |factor: C64, moved: &[Vec6]| {
            sum.resize(moved.len(), [C64::new(0.0, 0.0); 6]);
            for (sum, moved) in sum.iter_mut().zip(moved) {
                sum.iter_mut().zip(moved.iter()).for_each(|(sum, moved)| *sum += factor * moved);
            }
        };
        let mut act =
            |factor: C64, part: &Part, [first, second]: &[Vec<Vec6>; 2], add: &mut dyn FnMut(C64, &[Vec6])| {
                forces.iter_mut().zip(&part.modal).for_each(|(sum, force)| *sum += factor * force);
                add(factor, first);
                add(factor * beyond, second);
            };
        for (((factor, _), part), rest) in excitation.loads.iter().zip(&parts.loads).zip(&self.loads) {
            act(*factor, part, rest, &mut add);
        }
        for ((motion, (_, inertia, damping)), (moved, rest)) in
            excitation.motions.iter().zip(&parts.supports).zip(&self.supports)
        {
            let factor = motion.factor(omega);
            add(factor, moved);
            act(factor * beyond, inertia, &rest[0], &mut add);
            act(factor * C64::new(0.0, -omega), damping, &rest[1], &mut add);
            carried.push((factor * C64::new(0.0, -omega), inertia));
        }
        for (factor, inertia) in carried {
            let each = forces.iter_mut().zip(&space.carried).zip(&inertia.modal);
            each.for_each(|((sum, carried), inertia)| *sum += factor * *carried * *inertia);
        }
        if let Some(mode) = space.resonance(omega, &forces) {
            sum.iter_mut().for_each(|sum| sum.fill(C64::new(f64::INFINITY, f64::INFINITY)));
            return (sum, Some(mode));
        }
        let q = space.coordinates(omega, forces);
        self.modes.iter().zip(q.iter()).for_each(|(mode, q)| add(*q, mode));
        (sum, None)
    }
}

/// Removes the modes found from a motion.
fn remove_modes(pencil: &Pencil, pairs: &[Pair], x: &mut [f64]) {
    let mut product = vec![0.0; x.len()];
    pencil.mass.multiply(x, &mut product);
    for (_, phi) in pairs {
        let part = dot(phi, &product);
        x.iter_mut().zip(phi).for_each(|(x, phi)| *x -= part * phi);
    }
}
