//! The excitation as a function of time: factors of loads, the fields of gravity and ground acceleration, prescribed
//! motion.

use super::loads::Loading;
use crate::tolerances::excitation::{FARTHEST, TAIL};
use base::math::turn::Turn;
use base::math::{Vec3, rotation};
use base::snapshot::keep;
use mechanics::amplitude::{Amplitude, Jump, Side};
use model::{AnalysisKind, GivenTurn, History, Model, PrescribedMotion, Restraint, StepLength};

/// Displacement, velocity and acceleration of a restrained degree of freedom; angles are in radians. For three rotations prescribed
/// together, `u` is the value in the deck; `v` and `a` are components of the angular velocity and acceleration.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Prescribed {
    /// Displacement or rotation.
    pub u: f64,
    /// Its first derivative in time.
    pub v: f64,
    /// Its second derivative in time.
    pub a: f64,
}

/// The three rotations of a turn and their first and second derivatives.
fn angles(turn: &GivenTurn, of: &[Prescribed]) -> [Vec3; 3] {
    let each = |value: fn(&Prescribed) -> f64| Vec3::from(turn.restraints.map(|i| value(&of[i])));
    [each(|of| of.u), each(|of| of.v), each(|of| of.a)]
}

/// Writes components of three rotations that are given together.
fn set(turn: &GivenTurn, value: impl Fn(usize) -> Prescribed, out: &mut [Prescribed]) {
    turn.restraints.into_iter().enumerate().for_each(|(k, i)| out[i] = value(k));
}

keep!(Prescribed: Default { u, v, a });

/// The functions of time that a model prescribes.
pub struct Excitation<'a> {
    model: &'a Model,
    /// The jumps of each amplitude.
    jumps: Vec<Vec<Jump>>,
    /// Times that differ by less count as equal.
    slack: f64,
    /// Continuations of each amplitude and of each restrained degree of freedom beyond the run along an equilibrium path, because iterates
    /// pass the ends of the run.
    loads: Vec<Extrapolation>,
    motions: Vec<Extrapolation>,
}

/// A function of time, continued as a line beyond the ends of a run.
#[derive(Debug, Clone, Copy)]
struct Extrapolation {
    begin: f64,
    end: f64,
    /// Slope of the function before the beginning. After the end, which only iterates reach, the slope of the chord over the last [`TAIL`]
    /// of the run; the slope itself may be zero there.
    slopes: [f64; 2],
}

impl Extrapolation {
    fn new(begin: f64, end: f64, value: impl Fn(f64) -> f64, rate: impl Fn(f64) -> f64) -> Extrapolation {
        let tail = TAIL * (end - begin);
        Extrapolation { begin, end, slopes: [rate(begin), (value(end) - value(end - tail)) / tail] }
    }

    /// Outside the run, the time of its nearer end and the slope there.
    fn at(&self, t: f64) -> Option<(f64, f64)> {
        match t {
            _ if t < self.begin => Some((self.begin, self.slopes[0])),
            _ if t > self.end => Some((self.end, self.slopes[1])),
            _ => None,
        }
    }

    /// The value of the function within the run, and of the line that continues it outside.
    fn value(&self, t: f64, value: impl Fn(f64) -> f64) -> f64 {
        self.at(t).map_or_else(|| value(t), |(end, slope)| value(end) + slope * (t - end))
    }
}

impl<'a> Excitation<'a> {
    /// The excitation of a model.
    pub fn new(model: &'a Model) -> Self {
        let jumps = model.loading.amplitudes.iter().map(Amplitude::jumps).collect();
        let mut excitation =
            Excitation { model, jumps, slack: 1e-9 * model.analysis.end_time, loads: Vec::new(), motions: Vec::new() };
        if model.analysis.step_length.is_arc_length() {
            // Loads of a stage that a displacement leads pass its end, and no other action does.
            let passes_end = model.analysis.stage.as_ref().is_some_and(|stage| stage.loads_grow)
                && matches!(&model.analysis.step_length, StepLength::ArcLength(path) if path.increment.is_some());
            let end = if passes_end { FARTHEST } else { 1.0 } * model.analysis.end_time;
            // Loads that grow from zero in a stage fall below zero before it, and all others stay.
            let is_staged = model.analysis.stage.is_some();
            let begin = |a: &Amplitude| if is_staged { model.analysis.begin } else { a.begin().min(0.0) };
            let stays = |a: &Amplitude, t: f64| is_staged && a.value(t) != 0.0;
            let rate = |a: &Amplitude, t: f64| if stays(a, t) { 0.0 } else { a.rate(t, Side::After) };
            let loads = model.loading.amplitudes.iter();
            excitation.loads =
                loads.map(|a| Extrapolation::new(begin(a), end, |t| a.value(t), |t| rate(a, t))).collect();
            let beyond = |restraint: &Restraint| {
                let Some(motion) = &restraint.motion else { return Extrapolation::new(0.0, end, |_| 0.0, |_| 0.0) };
                let amplitude = &model.loading.amplitudes[motion.amplitude];
                let given = |t: f64| excitation.given(motion, t, Side::After);
                Extrapolation::new(amplitude.begin().min(0.0), end, |t| given(t).u, |t| given(t).v)
            };
            excitation.motions = model.constraints.restraints.iter().map(beyond).collect();
        }
        excitation
    }

    fn factor(&self, amplitude: usize, t: f64, side: Side) -> f64 {
        match self.loads.get(amplitude) {
            Some(beyond) => beyond.value(t, |t| self.within(amplitude, t, side)),
            None => self.within(amplitude, t, side),
        }
    }

    fn within(&self, amplitude: usize, t: f64, side: Side) -> f64 {
        match self.jumps[amplitude].iter().find(|jump| (jump.time - t).abs() <= self.slack) {
            Some(jump) if side == Side::Before => jump.before,
            Some(jump) => jump.after,
            None => self.model.loading.amplitudes[amplitude].value(t),
        }
    }

    /// Factor of a load without an amplitude: constant in dynamics, growing linearly over a static analysis.
    fn plain_factor(&self, t: f64) -> f64 {
        match self.model.analysis.is_dynamic() {
            true => 1.0,
            false => t / self.model.analysis.end_time,
        }
    }

    /// The factor of a load with this amplitude, or without one, at time `t`; at a jump that of `side`.
    pub fn factor_of(&self, amplitude: Option<usize>, t: f64, side: Side) -> f64 {
        match amplitude {
            Some(i) => self.factor(i, t, side),
            None => self.plain_factor(t),
        }
    }

    /// Writes the loads at time `t` into `loading`; at a jump the values on this `side`.
    pub fn loading(&self, t: f64, side: Side, loading: &mut Loading) {
        loading.factors.clear();
        let factor = |amplitude: Option<usize>| self.factor_of(amplitude, t, side);
        loading.factors.extend(self.model.loading.nodal.iter().map(|load| factor(load.amplitude)));
        loading.pressures.clear();
        let pressures = self.model.loading.pressures.iter();
        loading.pressures.extend(pressures.map(|load| load.pressure * factor(load.amplitude)));
        loading.squares.clear();
        let turning = self.model.loading.centrifugal.iter();
        loading.squares.extend(turning.map(|load| (load.speed * factor(load.amplitude)).powi(2)));
        loading.field = factor(self.model.loading.gravity_amplitude) * self.model.loading.gravity;
        for base in &self.model.loading.base_accelerations {
            loading.field -= self.factor(base.amplitude, t, side) * base.direction;
        }
    }

    /// The time of the first change of a load or prescribed motion in a static analysis; infinite if nothing changes.
    pub fn begin(&self) -> f64 {
        let model = self.model;
        let rest = |amplitude: Option<usize>| amplitude.map_or(0.0, |i| model.loading.amplitudes[i].rest());
        let moves = |motion: &PrescribedMotion| match motion.history {
            History::Displacement => rest(Some(motion.amplitude)),
            // A constant velocity changes the position all the same.
            History::Velocity | History::Acceleration => 0.0,
        };
        let loads = model.loading.nodal.iter().map(|load| rest(load.amplitude));
        let pressures = model.loading.pressures.iter().map(|load| rest(load.amplitude));
        let turning = model.loading.centrifugal.iter().map(|load| rest(load.amplitude));
        let base_accelerations = model.loading.base_accelerations.iter().map(|base| rest(Some(base.amplitude)));
        let motions = model.constraints.restraints.iter().filter_map(|restraint| restraint.motion.as_ref()).map(moves);
        let is_heavy = model.loading.gravity != Vec3::zeros();
        let gravity = if is_heavy { rest(model.loading.gravity_amplitude) } else { f64::INFINITY };
        loads.chain(pressures).chain(turning).chain(base_accelerations).chain(motions).fold(gravity, f64::min)
    }

    /// Writes the rates of the loads at time `t` into `loading`; at a kink those to its right.
    pub fn rates(&self, t: f64, loading: &mut Loading) {
        let plain = match self.model.analysis.is_dynamic() {
            true => 0.0,
            false => 1.0 / self.model.analysis.end_time,
        };
        let beyond = |i: usize| self.loads.get(i).and_then(|beyond| beyond.at(t));
        let rate = |i: usize| {
            beyond(i).map_or_else(|| self.model.loading.amplitudes[i].rate(t, Side::After), |(_, slope)| slope)
        };
        loading.factors.clear();
        loading.factors.extend(self.model.loading.nodal.iter().map(|load| load.amplitude.map_or(plain, rate)));
        loading.pressures.clear();
        let pressures = self.model.loading.pressures.iter();
        loading.pressures.extend(pressures.map(|load| load.pressure * load.amplitude.map_or(plain, rate)));
        loading.squares.clear();
        let turning = self.model.loading.centrifugal.iter();
        loading.squares.extend(turning.map(|load| {
            let factor = self.factor_of(load.amplitude, t, Side::After);
            2.0 * load.speed.powi(2) * factor * load.amplitude.map_or(plain, rate)
        }));
        loading.field = self.model.loading.gravity_amplitude.map_or(plain, rate) * self.model.loading.gravity;
        for base in &self.model.loading.base_accelerations {
            loading.field -= rate(base.amplitude) * base.direction;
        }
    }

    /// Writes the prescribed motion at time `t` into `out`, in the order of the model's restraints; at jumps of velocities and
    /// accelerations the values on this `side`. A static analysis has displacements but no rates, or dampers would act in it.
    pub fn prescribed(&self, t: f64, side: Side, out: &mut Vec<Prescribed>) {
        let dynamic = self.model.analysis.kind == AnalysisKind::Dynamic;
        out.clear();
        out.extend(self.model.constraints.restraints.iter().enumerate().map(
            |(i, restraint)| match &restraint.motion {
                None => Prescribed::default(),
                Some(motion) => {
                    let given = |t: f64| self.given(motion, t, side);
                    match self.motions.get(i) {
                        Some(beyond) => Prescribed { u: beyond.value(t, |t| given(t).u), ..Prescribed::default() },
                        None if dynamic => given(t),
                        None => Prescribed { u: given(t).u, ..Prescribed::default() },
                    }
                }
            },
        ));
        for turn in self.turns() {
            let given = angles(turn, out);
            let Turn { omega, alpha, .. } = turn.angles.turn(&given);
            set(turn, |k| Prescribed { u: given[0][k], v: omega[k], a: alpha[k] }, out);
        }
    }

    /// The rotations that are given by three numbers together.
    pub fn turns(&self) -> &[GivenTurn] {
        &self.model.constraints.turns
    }

    /// True for a restraint of a rotation that is given together with two others.
    pub fn is_turned(&self, restraint: usize) -> bool {
        self.turns().iter().any(|turn| turn.restraints.contains(&restraint))
    }

    /// Writes the increments of the prescribed motion between two times into `out`, with the rates at the later time. Rotations prescribed
    /// together become the rotation vector of the step.
    pub fn moved(&self, from: &[Prescribed], to: &[Prescribed], out: &mut Vec<Prescribed>) {
        out.clear();
        out.extend(from.iter().zip(to).map(|(from, to)| Prescribed { u: to.u - from.u, ..*to }));
        for turn in self.turns() {
            let ([before, ..], [after, omega, alpha]) = (angles(turn, from), angles(turn, to));
            let [before, after] = [before, after].map(|u| turn.angles.rotation(&u));
            let q = rotation::log(&(after * before.conjugate()));
            let (d, dd) = rotation::vector_rates(&q, &omega, &alpha);
            set(turn, |k| Prescribed { u: q[k], v: d[k], a: dd[k] }, out);
        }
    }

    /// A prescribed motion at a time within the run.
    fn given(&self, motion: &PrescribedMotion, t: f64, side: Side) -> Prescribed {
        let amplitude = &self.model.loading.amplitudes[motion.amplitude];
        let value = || self.within(motion.amplitude, t, side);
        let kink = amplitude.snapped(t, self.slack);
        let (u, v, a) = match motion.history {
            History::Displacement => {
                (amplitude.value(t), amplitude.rate(kink, side), amplitude.second_rate(kink, side))
            }
            History::Velocity => (amplitude.integral(t), value(), amplitude.rate(kink, side)),
            History::Acceleration => (amplitude.double_integral(t), amplitude.integral(t), value()),
        };
        Prescribed { u: motion.scale * u, v: motion.scale * v, a: motion.scale * a }
    }
}

/// Interpolates loads within a step: y ← a + s (b − a).
pub fn between(a: &Loading, b: &Loading, s: f64, y: &mut Loading) {
    let mix = |a: &[f64], b: &[f64], y: &mut Vec<f64>| {
        y.clear();
        y.extend(a.iter().zip(b).map(|(a, b)| a + s * (b - a)));
    };
    mix(&a.factors, &b.factors, &mut y.factors);
    mix(&a.pressures, &b.pressures, &mut y.pressures);
    mix(&a.squares, &b.squares, &mut y.squares);
    y.field = lerp(&a.field, &b.field, s);
}

fn lerp(a: &Vec3, b: &Vec3, s: f64) -> Vec3 {
    a + s * (b - a)
}
