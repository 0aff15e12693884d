//! The response by the equations themselves: (K + iωC − ω²M) x = f is solved at each frequency.

use super::super::fault::ModesFault;
use super::super::gyroscopic::Gyroscopic;
use super::super::linearized::Linearized;
use super::super::modal::{natural_frequencies, natural_pairs};
use super::super::mode::Modes;
use super::super::pencil::Pencil;
use super::super::shape::Shapes;
use super::super::speeds::critical_frequencies;
use super::super::steady::{Response, ResponseProgress, ResponseRow, ResponseSoFar};
use super::dynamic_stiffness::DynamicStiffness;
use super::excitation::{C64, HarmonicExcitation};
use super::frequencies::frequencies;
use super::look_up::look_up;
use super::matrices::Matrices;
use super::resonance::resonances_in_words;
use crate::modes::mode::ModeKind;
use crate::system::assembly::Assembly;
use crate::tolerances::direct_response::{
    ASIDE, BESIDE_RESONANCE, BEYOND, CLOSINGS, DOUBTFUL, LARGE, NEXT_TO_ZERO, SAME, SAME_FREQUENCY,
};
use base::math::Vec6;
use base::names::short;
use linear::{Solver, Sparse};
use model::{ModeExtent, ResponseAsked};
use std::f64::consts::TAU;

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
    let mut found = Modes { kind: ModeKind::Natural, ..Modes::default() };
    let speed = at.model.loading.unbalanced_node().map(|node| at.state.nodes[node].omega.norm());
    let natural = match (asked.resonances, speed) {
        (Some(around), Some(spin)) => {
            critical_frequencies(at, (around.range, spin), (&mut *linear.0, &mut *linear.1), &mut found)?
        }
        (Some(around), None) => natural_frequencies(at, around.range[1], (&mut *linear.0, &mut *linear.1), &mut found)?,
        (None, _) => Vec::new(),
    };
    let all = frequencies(asked, &natural);
    let gyroscopic = Gyroscopic::of(at);
    let unsymmetric = gyroscopic.acts() || !at.has_potential();
    let mut own = unsymmetric.then(|| at.unsymmetric_solver()).transpose()?;
    let mut pencil = match &mut own {
        Some((solver, assembly)) => Pencil::new(*at, (solver, assembly)),
        None => Pencil::new(*at, linear),
    };
    let excitation = HarmonicExcitation::of(&pencil, unsymmetric)?;
    if excitation.is_nothing() {
        return Err(ModesFault::NothingExcites);
    }
    // The shift is close to zero, where parts supported only by joints have no vanishing pivot.
    let shift = -NEXT_TO_ZERO * pencil.least_ratio();
    let unstable = !unsymmetric && is_unstable(&mut pencil, shift);
    let matrices = Matrices::of(&mut pencil, &gyroscopic);
    let highest = TAU * all.last().copied().unwrap_or(0.0);
    let joints = pencil.joints_at((BEYOND * highest).powi(2));
    let mut stiffness = DynamicStiffness::new(&at.plan.structure)?;
    stiffness.set(&matrices, &joints);
    let mut direct = Direct { pencil, excitation, stiffness, joints, speed, so_far: &mut *progress.so_far, natural };
    let mut response = Response::of(at, std::mem::take(&mut direct.so_far.rows));
    if let Err(stopped) = direct.find(at, &all, &mut *progress.pauses, &mut response) {
        direct.so_far.rows = response.rows;
        return Err(stopped);
    }
    found.factorizations += all.len();
    found.solves += all.len();
    found.warnings.extend(gyroscopic.warnings);
    found.warnings.extend(unjudged(at));
    if unstable {
        found.warnings.push("the state is unstable, so no steady motion about it lasts. Add damping or stiffness, or compute the motion with `kind = \"dynamic\"`"
                .to_owned());
    }
    found.warnings.extend(direct.warnings());
    found.response = Some(response);
    Ok(found)
}

/// True where the lowest mode grows. If equations of joints are redundant, rounding may determine signs of pivots below the shift.
fn is_unstable(pencil: &mut Pencil, shift: f64) -> bool {
    pencil.factor(shift).is_ok_and(|below| below > 0)
        && natural_pairs(pencil, ModeExtent::Count(1)).map_or(true, |pairs| {
            let shapes = Shapes::new(pencil);
            shapes.natural(pencil, &pairs).iter().any(|mode| mode.root[0] > 0.0)
        })
}

/// Properties that cannot be judged for loads without a potential, in words.
fn unjudged(at: &Linearized) -> Option<String> {
    (!at.has_potential()).then(|| {
        "follower loads, moments about axes fixed in space, and links with unsymmetric matrices have no potential: the steady motion does not last if they cause flutter. Check \
         the stability of the state with `kind = \"modal\"` and `damped = true`"
            .to_owned()
    })
}

/// True for motions beside a frequency that agree within many times the difference of the frequencies; across a resonance they are
/// opposite.
fn agree([before, after]: [&[Vec<Vec6>; 2]; 2]) -> bool {
    let pairs = || before.iter().flatten().zip(after.iter().flatten());
    let largest = pairs().map(|(a, b)| a.amax().max(b.amax())).fold(0.0, f64::max);
    pairs().all(|(a, b)| (a - b).amax() <= SAME * largest)
}

/// A direct solution under way.
struct Direct<'a> {
    pencil: Pencil<'a>,
    excitation: HarmonicExcitation,
    stiffness: DynamicStiffness,
    /// The equations of joints.
    joints: Sparse,
    /// The spin of the state that is the angular frequency; `None` if spins do not follow it.
    speed: Option<f64>,
    so_far: &'a mut ResponseSoFar,
    /// Natural frequencies, or those of critical speeds, where they are known.
    natural: Vec<f64>,
}

impl Direct<'_> {
    /// Solves the equations at the frequencies that are not known yet, and finds the resonances.
    ///
    /// # Errors
    /// [`ModesFault::Stopped`] where a signal or a checkpoint is due; the rows so far are in `response`.
    fn find(
        &mut self,
        at: &Linearized,
        all: &[f64],
        pauses: &mut dyn FnMut() -> bool,
        response: &mut Response,
    ) -> Result<(), ModesFault> {
        let known = response.rows.len().min(all.len());
        for frequency in &all[known..] {
            look_up(at, response.rows.len() > known, pauses)?;
            self.solve(*frequency, response)?;
        }
        self.find_resonances(response)
    }

    /// Adds the motion at a frequency.
    fn solve(&mut self, frequency: f64, response: &mut Response) -> Result<(), ModesFault> {
        let mut found = self.motions(frequency)?;
        if found.is_none() {
            // A part that would resonate alone makes a pivot vanish, but the whole may not.
            let sides = [self.motions(frequency * (1.0 - ASIDE))?, self.motions(frequency * (1.0 + ASIDE))?];
            if let [Some(before), Some(after)] = sides {
                found = agree([&before, &after]).then_some(before);
            }
        }
        if self.speed.is_some() {
            response.renew_links(&self.pencil.at);
        }
        match found {
            Some([real, imaginary]) => response.keep(frequency, [&real, &imaginary]),
            None => {
                self.note(frequency);
                let infinite = vec![Vec6::repeat(f64::INFINITY); self.pencil.nodes.len()];
                response.keep(frequency, [&infinite, &infinite]);
            }
        }
        Ok(())
    }

    /// Records a frequency of unlimited motion.
    fn note(&mut self, frequency: f64) {
        let mode = self.natural.iter().position(|natural| (natural - frequency).abs() <= SAME_FREQUENCY * frequency);
        self.so_far.resonances.push((frequency, mode));
    }

    /// Looks for resonances that are very large instead of infinite due to rounding. Their motion decreases within a smaller fraction of
    /// the frequency than with any real damping.
    ///
    /// # Errors
    /// [`ModesFault::Stopped`] where a signal ends the search.
    fn find_resonances(&mut self, response: &mut Response) -> Result<(), ModesFault> {
        let motions: Vec<f64> = response.rows.iter().map(ResponseRow::largest).collect();
        let least = motions.iter().copied().filter(|motion| *motion > 0.0).fold(f64::INFINITY, f64::min);
        for (place, motion) in motions.into_iter().enumerate() {
            let frequency = response.rows[place].frequency;
            if !motion.is_finite() || motion <= LARGE * least {
                continue;
            }
            self.pencil.at.check_stop()?;
            let Some([real, imaginary]) = self.motions(frequency * (1.0 + BESIDE_RESONANCE[0]))? else { continue };
            let mut beside = Response { nodes: response.nodes.clone(), ..Response::default() };
            beside.keep(frequency, [&real, &imaginary]);
            if beside.rows[0].largest() < BESIDE_RESONANCE[1] * motion {
                self.note(frequency);
                response.rows[place].set_unlimited();
            }
        }
        Ok(())
    }

    /// Forms the matrices and the excitation at an angular frequency where spins follow it: gyroscopic moments and the matrices of bearings change.
    fn spin(&mut self, omega: f64) -> Result<(), ModesFault> {
        let Some(speed) = self.speed else { return Ok(()) };
        let state = self.pencil.at.spun(omega / speed);
        let mut pencil = self.pencil.about(&state);
        self.excitation = HarmonicExcitation::of(&pencil, true)?;
        let gyroscopic = Gyroscopic::of(&pencil.at);
        self.stiffness.set(&Matrices::of(&mut pencil, &gyroscopic), &self.joints);
        Ok(())
    }

    /// The motions of all nodes at a frequency, real and imaginary parts; `None` where the equations are singular.
    ///
    /// # Errors
    /// There is no memory.
    fn motions(&mut self, frequency: f64) -> Result<Option<[Vec<Vec6>; 2]>, ModesFault> {
        let omega = TAU * frequency;
        self.spin(omega)?;
        let at = self.pencil.at;
        if self.excitation.is_nothing() {
            // An unbalance at rest has no force, whatever moves without stiffness.
            return Ok(Some([0, 1].map(|_| vec![Vec6::zeros(); self.pencil.nodes.len()])));
        }
        if !self.stiffness.factor(omega) {
            return Ok(None);
        }
        let n = at.unknowns();
        let mut f = vec![C64::new(0.0, 0.0); at.plan.dofs.unknowns()];
        for (factor, force) in &self.excitation.loads {
            f.iter_mut().zip(force).for_each(|(f, force)| *f += factor * force);
        }
        let weights = [C64::new(1.0, 0.0), C64::new(0.0, omega), C64::new(-omega * omega, 0.0)];
        for motion in &self.excitation.motions {
            let factor = motion.factor(omega);
            for (weight, force) in weights.iter().zip(&motion.forces) {
                f.iter_mut().zip(force).for_each(|(f, force)| *f -= factor * weight * force);
            }
        }
        let mut sum = vec![C64::new(0.0, 0.0); n];
        let mut x = vec![C64::new(0.0, 0.0); f.len()];
        let mut motions = self.driven(omega);
        for closing in 0..CLOSINGS {
            self.pencil.close_gaps(&motions, |tail, [real, imaginary]| f[n + tail] = C64::new(real, imaginary));
            let left = self.stiffness.solve(&f, &mut x);
            if closing == 0 && left > self.so_far.worst.0 {
                self.so_far.worst = (left, frequency);
            }
            sum.iter_mut().zip(&x).for_each(|(sum, x)| *sum += x);
            motions = self.driven(omega);
            let parts = [sum.iter().map(|x| x.re).collect::<Vec<_>>(), sum.iter().map(|x| x.im).collect()];
            for (motions, part) in motions.iter_mut().zip(parts) {
                let more = at.motions(&self.pencil.nodes, &part);
                motions.iter_mut().zip(more).for_each(|(motion, more)| *motion += more);
            }
            if n == f.len() {
                break;
            }
            f[..n].fill(C64::new(0.0, 0.0));
        }
        Ok(Some(motions))
    }

    /// The motions of all nodes that supports prescribe, real and imaginary parts.
    fn driven(&self, omega: f64) -> [Vec<Vec6>; 2] {
        let mut motions = [0, 1].map(|_| vec![Vec6::zeros(); self.pencil.nodes.len()]);
        for motion in &self.excitation.motions {
            let factor = motion.factor(omega);
            for (motions, factor) in motions.iter_mut().zip([factor.re, factor.im]) {
                motions.iter_mut().zip(&motion.moved).for_each(|(sum, moved)| *sum += factor * moved);
            }
        }
        motions
    }

    /// Warnings about the response, in words.
    fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        warnings.extend(resonances_in_words(&self.so_far.resonances));
        if self.so_far.worst.0 > DOUBTFUL {
            let (left, frequency) = self.so_far.worst;
            warnings.push(format!(
                "at frequency {} the equations are nearly singular, and amplitudes there have an error of {left:.1e}. Add damping (`damping`), or remove \
                 this frequency",
                short(frequency)
            ));
        }
        warnings
    }
}
