//! Natural modes K φ = ω² M φ, the lowest first.
//!
//! Lanczos' method on (K − σM)⁻¹M finds the eigenvalues nearest to the shift σ below all of them. The shift is zero if K is positive
//! definite, otherwise negative, so motions without stiffness are found like all others. The number of modes is the number of negative
//! pivots of K − sM with s just above the last mode (T. Ericsson & A. Ruhe, Math. Comp. 35 (1980)); if one is missing, the search continues
//! with new vectors.

use super::fault::ModesFault;
use super::linearized::Linearized;
use super::mode::ModeKind;
use super::mode::{EigenMode, Modes};
use super::pencil::Pencil;
use super::shape::Shapes;
use super::spinning_parts::first_spinning;
use crate::system::assembly::Assembly;
use crate::tolerances::gyroscopic::ACROSS;
use crate::tolerances::modal::{
    APART, FAR_APART, FITS, LOW, MOST, NEAR, NEXT_TO, PROBE, ROUNDING, SEARCHES, SHIFTS, TOLERANCE, WIDTH,
};
use base::names::short;
use linear::Solver;
use linear::eigen::{Converged, EigenPair, Lanczos};
use model::ModeExtent;
use std::f64::consts::TAU;

/// Finds the natural modes of the model.
///
/// # Errors
/// The reason why there are none, or why some are missing.
pub fn natural_modes(at: &Linearized, linear: (&mut Solver, &mut Assembly)) -> Result<Modes, ModesFault> {
    let mut pencil = Pencil::new(*at, linear);
    if pencil.mass.is_zero() {
        return Err(ModesFault::NoMass);
    }
    let extent = at.model.analysis.extent();
    let pairs = natural_pairs(&mut pencil, extent)?;
    let shapes = Shapes::new(&pencil);
    let list = shapes.natural(&pencil, &pairs);
    let unstable = list.iter().filter(|mode| mode.root[0] > 0.0).count();
    let (factorizations, solves) = (pencil.factorizations, pencil.solves);
    let kind = ModeKind::Natural;
    let mut warnings = left_out(at);
    warnings.extend(without_coriolis(at, &list));
    warnings.extend(far_apart(&list));
    match (list.len(), extent) {
        (0, ModeExtent::UpTo(frequency)) => warnings.push(format!(
            "no mode lies below `up_to` = {frequency}, so the list is empty. Give `up_to` = {}",
            10.0 * frequency
        )),
        (found, ModeExtent::Count(count)) if found < count => {
            warnings.push(fewer(found, count));
        }
        _ => {}
    }
    Ok(Modes { kind, list, masses: shapes.masses, unstable, factorizations, solves, warnings, ..Modes::default() })
}

/// Natural frequencies up to a value, without zeros; the cost is counted.
///
/// # Errors
/// As for [`natural_modes`].
pub(super) fn natural_frequencies(
    at: &Linearized,
    up_to: f64,
    linear: (&mut Solver, &mut Assembly),
    counts: &mut Modes,
) -> Result<Vec<f64>, ModesFault> {
    let mut pencil = Pencil::new(*at, linear);
    if pencil.mass.is_zero() {
        return Err(ModesFault::NoMass);
    }
    let pairs = natural_pairs(&mut pencil, ModeExtent::UpTo(up_to))?;
    counts.factorizations += pencil.factorizations;
    counts.solves += pencil.solves;
    let shapes = Shapes::new(&pencil);
    Ok(shapes.natural(&pencil, &pairs).iter().map(EigenMode::frequency).filter(|frequency| *frequency > 0.0).collect())
}

/// The eigenvalues λ = ω², ascending, with vectors of modal mass 1, of the modes that joints allow.
///
/// # Errors
/// The reason why there are none, or why some are missing.
pub(super) fn natural_pairs(pencil: &mut Pencil, extent: ModeExtent) -> Result<Vec<(f64, Vec<f64>)>, ModesFault> {
    let goal = match extent {
        ModeExtent::Count(count) => Goal { wanted: count, below: None },
        ModeExtent::UpTo(frequency) => {
            let below = (TAU * frequency).powi(2);
            let there = count_below(pencil, below)?;
            if there > MOST {
                return Err(ModesFault::TooMany { there, most: MOST });
            }
            Goal { wanted: there, below: Some(below) }
        }
    };
    let mut pairs = match goal.wanted {
        0 => Vec::new(),
        _ => complete(pencil, goal)?,
    };
    // The shapes fit into the memory that the count has left.
    pencil.solver.rest();
    pairs.retain(|(_, vector)| pencil.allows(&[vector.as_slice()]));
    Ok(pairs)
}

/// The warning of a model with fewer modes than wanted.
pub(super) fn fewer(found: usize, count: usize) -> String {
    format!(
        "the scene has {found} modes, fewer than `modes` = {count}: all are listed. Give `modes` = {found}, or a finer mesh"
    )
}

/// Modes hidden by rounding, in words.
pub(super) fn far_apart(list: &[EigenMode]) -> Vec<String> {
    let mut warnings = Vec::new();
    let lost: Vec<f64> = list.iter().filter_map(|mode| mode.lost).collect();
    if let Some(largest) = lost.iter().copied().reduce(f64::max) {
        warnings.push(format!(
            "{} of the frequencies written as 0 have stiffnesses below the rounding error of stiffer parts: the frequencies lie between 0 and {}. \
             Replace the stiffest parts by rigid bodies (`[[bodies]]` with `parts`)",
            lost.len(),
            short(largest)
        ));
    }
    let squares = || list.iter().map(|mode| mode.angular_frequency().powi(2)).filter(|square| *square > 0.0);
    let (least, largest) = (squares().fold(f64::INFINITY, f64::min), squares().fold(0.0, f64::max));
    if largest > FAR_APART * least {
        warnings.push(format!(
            "frequencies from {} to {} are so far apart that the highest have few digits, and some may be missing. Give `up_to` = {}",
            short(least.sqrt() / TAU),
            short(largest.sqrt() / TAU),
            short((0.9 * FAR_APART * least).sqrt() / TAU)
        ));
    }
    warnings
}

/// Terms neglected by modes without damping, in words.
pub(super) fn left_out(at: &Linearized) -> Vec<String> {
    let mut warnings = Vec::new();
    if !at.has_potential() {
        warnings.push(
            "follower loads, moments about axes fixed in space, and links with unsymmetric matrices have no potential: modes use the symmetric part of their stiffness. Give \
             `damped = true`, which uses all of it and finds flutter"
                .to_owned(),
        );
    }
    let spins = |node: usize| at.spins(&at.model.nodes[node].omega);
    let body = at.system.inertias.iter().find(|inertia| inertia.rotary && spins(inertia.node));
    if let Some(node) = body.map(|body| body.node).or_else(|| first_spinning(at)) {
        warnings.push(format!(
            "`{}` spins, and modes omit its gyroscopic moments. Give `damped = true`, which includes them",
            at.model.nodes[node].label
        ));
    }
    warnings
}

/// The modes whose motion across the axis of a centrifugal load feels Coriolis forces, in words.
fn without_coriolis(at: &Linearized, list: &[EigenMode]) -> Option<String> {
    let turning = || at.system.centrifugal().iter().zip(&at.loading.squares).filter(|(_, square)| **square > 0.0);
    let feels = |mode: &&EigenMode| {
        turning().map(|(load, _)| load.energy_across(&at.state.nodes, &mode.shape)).sum::<f64>()
            > ACROSS * mode.modal_mass
    };
    let first = list.iter().find(feels)?;
    let count = list.iter().filter(feels).count();
    Some(format!(
        "{count} of the modes, first that of {} Hz, move masses across the axis of the centrifugal load, and modes omit their Coriolis forces. Give \
         `damped = true`, which includes them",
        short(first.frequency())
    ))
}

/// An estimate of the lowest ω² that is not zero, and whether others are, or next to it.
///
/// # Errors
/// The matrix is singular whatever the shift.
pub(super) fn lowest_square(pencil: &mut Pencil) -> Result<(f64, bool), ModesFault> {
    let mut lanczos = settle(pencil)?;
    let thetas = lanczos.probe(pencil, PROBE);
    let shift = pencil.shift;
    let values = || thetas.iter().filter(|theta| **theta > 0.0).map(|theta| shift + 1.0 / theta);
    let least = LOW * shift.abs();
    let square = values().find(|lambda| *lambda > least).unwrap_or(if least > 0.0 { shift.abs() } else { 1.0 });
    Ok((square, values().any(|lambda| lambda <= least)))
}

/// The modes that are to be found.
#[derive(Clone, Copy)]
struct Goal {
    wanted: usize,
    /// Upper bound of the eigenvalues, if one was given.
    below: Option<f64>,
}

/// Number of eigenvalues below `s`, which moves slightly if it meets one.
fn count_below(pencil: &mut Pencil, s: f64) -> Result<usize, ModesFault> {
    let mut row = 0;
    for moved in [1.0, 1.0 + 1e-9, 1.0 + NEAR] {
        pencil.at.check_stop()?;
        match pencil.count_below(s * moved) {
            Ok(count) => return Ok(count),
            Err(at) => row = at,
        }
    }
    Err(pencil.singular(row))
}

/// The modes wanted by their eigenvalues λ = ω², ascending, with vectors of modal mass 1.
fn complete(pencil: &mut Pencil, Goal { wanted, below }: Goal) -> Result<Vec<(f64, Vec<f64>)>, ModesFault> {
    let mut lanczos = settle(pencil)?;
    pencil.solver.rest();
    let shift = pencil.shift;
    let mut goal = wanted;
    for _ in 0..SEARCHES {
        let limit = lanczos.applications + 40 * goal + 400;
        let converged = lanczos.converge(pencil, goal, TOLERANCE, limit);
        let Converged { thetas, next } = converged.ok_or_else(|| pencil.not_converged(goal))?;
        let value = |theta: f64| shift + 1.0 / theta;
        let found: Vec<f64> = thetas.into_iter().map(value).collect();
        let last = found.iter().copied().fold(shift, f64::max);
        let missing = match (below, next.map(value)) {
            (Some(below), _) => wanted - found.iter().filter(|lambda| **lambda <= below).count().min(wanted),
            // Modes of equal frequency are counted together.
            (None, Some(next)) if next - last <= 1e-4 * (last - shift) => {
                goal += 1;
                continue;
            }
            (None, next) => {
                // The space is the largest thing beside the factor.
                lanczos.narrow();
                let above = next.map_or(0.5 * (last - shift), |next| 0.1 * (next - last));
                let there = count_below(pencil, last + above)?;
                let missing = there.saturating_sub(found.len());
                if missing > 0 {
                    pencil.factor(shift).map_err(|row| pencil.singular(row))?;
                }
                missing
            }
        };
        goal = found.len() + missing;
        // Unexpanded vectors may contain the same part as new vectors.
        if missing == 0 || !lanczos.start(pencil, missing) && lanczos.is_expanded() {
            let mut pairs = sorted(lanczos.into_pairs(), shift, wanted);
            pairs.retain(|(lambda, _)| below.is_none_or(|below| *lambda <= below * (1.0 + NEAR)));
            return Ok(pairs);
        }
    }
    Err(ModesFault::Missed { found: wanted, there: goal })
}

fn sorted(pairs: Vec<EigenPair>, shift: f64, wanted: usize) -> Vec<(f64, Vec<f64>)> {
    let value = |theta: f64| {
        let lambda = shift + 1.0 / theta;
        // The sum rounds.
        if lambda.abs() <= ROUNDING * shift.abs() { 0.0 } else { lambda }
    };
    let mut all: Vec<(f64, Vec<f64>)> = pairs.into_iter().map(|pair| (value(pair.theta), pair.vector)).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all.truncate(wanted);
    all
}

/// Factorises at a shift below all eigenvalues, near the first that is not zero, and begins the iteration there.
fn settle(pencil: &mut Pencil) -> Result<Lanczos, ModesFault> {
    let threads = pencil.at.plan.threads > 1;
    let mut shift = 0.0;
    let mut row = 0;
    for _ in 0..SHIFTS {
        pencil.at.check_stop()?;
        match pencil.factor(shift) {
            Ok(0) => {}
            // Some eigenvalues lie below the shift, or K is singular.
            judged => {
                row = judged.err().unwrap_or(row);
                shift = if shift < 0.0 { 16.0 * shift } else { -1e-6 * pencil.least_ratio() };
                continue;
            }
        }
        let mut lanczos = Lanczos::new(pencil, WIDTH, threads);
        let thetas = lanczos.probe(pencil, PROBE);
        if shift == 0.0 && (thetas.len() < PROBE || thetas[0] < 0.0) && is_drowned(pencil, &thetas) {
            shift = -1e-6 * pencil.least_ratio();
            continue;
        }
        match better_shift(shift, &thetas) {
            Some(better) if better != shift => shift = better,
            _ => return Ok(lanczos),
        }
    }
    Err(pencil.singular(row))
}

/// True if the largest value 1/λ belongs to a motion resisted by rounding alone, beside which others are lost. Rounding may make it
/// negative where the pivots are not.
fn is_drowned(pencil: &Pencil, thetas: &[f64]) -> bool {
    let rounding = Shapes::new(pencil).rounding(pencil);
    thetas.first().is_none_or(|theta| *theta < 0.0 || 1.0 / theta <= NEXT_TO * rounding)
}

/// A better shift for these first estimates of 1/(λ − σ), largest first; `None` if the current shift suffices.
fn better_shift(shift: f64, thetas: &[f64]) -> Option<f64> {
    let values: Vec<f64> = thetas.iter().filter(|theta| **theta > 0.0).map(|theta| shift + 1.0 / theta).collect();
    if shift == 0.0 {
        // The first motion with stiffness follows a wide gap.
        let gap = values.windows(2).position(|pair| pair[1] > APART * pair[0].abs())?;
        return Some(-values[gap + 1]);
    }
    let elastic = values.iter().copied().find(|lambda| lambda.abs() > LOW * shift.abs())?;
    if elastic < 0.0 {
        return None;
    }
    let ratio = elastic / shift.abs();
    (!(FITS[0]..=FITS[1]).contains(&ratio)).then_some(-elastic)
}
