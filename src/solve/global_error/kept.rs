//! The motion of a run at a few times, for the comparison of runs with different steps.

use crate::control::{COMPARISONS, comparison_time};
use crate::frame::Frame;
use crate::step::size::{ModelSize, Size};
use crate::tolerances::global_error::SATURATED;
use crate::tolerances::trace::{EVENTFUL, FEWEST, MOST_NODES, OWN_ESTIMATE, SLOPE, TELLING, USUAL_STEPS};
use base::math::Vec3;
use base::snapshot::keep;
use nalgebra::Quaternion;

/// The data of a trace; the list of step ends grows with the run.
#[derive(Debug, Clone, Default)]
pub struct Kept {
    /// Displacements of the compared nodes, one time after the other.
    pub displacements: Vec<Vec3>,
    /// Rotations of the bodies, likewise.
    pub rotations: Vec<Quaternion<f64>>,
    /// Velocities and angular velocities of the bodies, likewise, in models of rigid bodies only, unless `accuracy` does not count them.
    pub velocities: Vec<[Vec3; 2]>,
    /// Number of times so far.
    pub times: usize,
    /// The ends of all steps, the first at t = 0.
    pub ends: Vec<f64>,
    /// The error of a step is proportional to this power of its length.
    pub power: i32,
    /// The lasting errors of these steps by their own estimate, as lengths; 0 where there is none.
    pub errors: Vec<f64>,
    /// The longest step.
    pub longest: f64,
    /// The times between which runs are compared.
    pub between: [f64; 2],
    /// True where the run has met events.
    pub met_events: bool,
    /// The tolerance of the steps of a pilot run.
    pub tolerance: f64,
}

keep!(Kept: Default { displacements, rotations, velocities, times, ends, power, errors, longest, between, met_events, tolerance });

impl Kept {
    /// Keeps the motion where a time of comparison is reached.
    pub(super) fn look(&mut self, frame: &Frame) {
        let Frame { model, state, .. } = frame;
        let stride = model.nodes.len().div_ceil(MOST_NODES).max(1);
        if self.displacements.capacity() == 0 {
            self.ends.reserve(USUAL_STEPS);
            self.errors.reserve(USUAL_STEPS);
            self.displacements.reserve_exact(COMPARISONS * model.nodes.len().div_ceil(stride));
            self.rotations.reserve_exact(COMPARISONS * model.bodies.len());
            self.velocities.reserve_exact(COMPARISONS * model.bodies.len());
        }
        let ends = self.between;
        if self.times == COMPARISONS || state.time < comparison_time(self.times + 1, ends) - 1e-9 * ends[1] {
            return;
        }
        // Drives of joints may have angles in place of displacements, and have no error.
        let numbers: Vec<usize> = model.number_nodes().collect();
        let compared = state.nodes.iter().zip(&model.nodes).enumerate().step_by(stride);
        let compared = compared.filter(|(node, _)| !numbers.contains(node));
        self.displacements.extend(compared.map(|(_, (node, start))| node.moved(&start.x)));
        let bodies = || model.bodies.iter().map(|body| &state.nodes[body.node]);
        self.rotations.extend(bodies().map(|node| node.rotation));
        // Where elastic parts vibrate or contacts stop bodies, velocities are far less certain than positions. `accuracy` does not count them.
        let counts = model.analysis.accuracy.is_none() || !model.expects.is_empty();
        if counts && !model.parts.iter().any(|part| part.mass_kind().is_some() || part.kind().is_unilateral()) {
            self.velocities.extend(bodies().map(|node| [node.v, node.omega]));
        }
        self.times += 1;
    }

    /// Records whether the run has met events.
    pub fn with_events(self, met_events: bool) -> Kept {
        Kept { met_events, ..self }
    }

    /// The ratio of the error of another run to the error of this one, from the steps that the runs do not share. The error of a step with
    /// an event is at best proportional to its length, so the ratio of both lengths limits the ratio of both errors.
    pub fn apart(&self, other: &Kept) -> f64 {
        let [own, theirs] = self.own_steps(other);
        let apart = self.least_apart(other, own.apart(&theirs));
        if self.meets_events(other) { apart.min(own.lengths_apart(&theirs)).min(EVENTFUL) } else { apart }
    }

    /// The ratio of the error of a run with steps twice as long to the error of this one, at most.
    pub(super) fn most_apart(&self) -> f64 {
        let apart = 2_f64.powf(f64::from(self.power - 1) * SLOPE);
        if self.met_events { apart.min(EVENTFUL) } else { apart }
    }

    /// True where this run or another has met events.
    pub fn meets_events(&self, other: &Kept) -> bool {
        self.met_events || other.met_events
    }

    /// The steps that this run does not share with another one, and the reverse.
    fn own_steps(&self, other: &Kept) -> [Steps; 2] {
        [own_steps(self, &other.ends), own_steps(other, &self.ends)]
    }

    /// The ratio of the errors so far of a pilot run and this one, without events.
    pub(super) fn apart_so_far(&self, pilot: &Kept) -> f64 {
        self.least_apart(pilot, self.apart_since(pilot, self.between[0]))
    }

    /// The ratio of the errors that another run and this one have made since this time.
    pub(super) fn apart_since(&self, other: &Kept, from: f64) -> f64 {
        let end = self.end();
        self.steps_between(from, end).apart(&other.steps_between(from, end))
    }

    /// The ratio of the errors over intervals between times of comparison, at most `whole`. Errors of all intervals add up and grow until the
    /// end, so those of the first one count most. Sums over the whole run would hide that its steps are hardly shorter. They also count
    /// intervals with long steps, whose errors may matter less than errors of later, shorter steps, so the least ratio from any time on counts.
    fn least_apart(&self, other: &Kept, whole: f64) -> f64 {
        let end = self.end();
        let begins = (1..=COMPARISONS).rev().map(|k| comparison_time(k, self.between)).chain([self.between[0]]);
        let (mut errors, mut least, mut to) = (0.0, whole, end);
        for from in begins.filter(|from| *from < end) {
            let [own, theirs] = [self, other].map(|run| run.steps_between(from, to));
            // An interval within one step joins the one before.
            if own.count.min(theirs.count) > 0 {
                errors += ((end - from).powi(2) - (end - to).powi(2)) / own.apart(&theirs);
                least = least.min((end - from).powi(2) / errors);
                to = from;
            }
        }
        least
    }

    fn steps_between(&self, from: f64, to: f64) -> Steps {
        let [first, last] = [from, to].map(|time| self.ends.partition_point(|end| *end <= time + 1e-9 * to.abs()));
        let mut steps = Steps::new(self.power);
        (first.max(1)..(last + 1).min(self.ends.len())).for_each(|end| steps.add(self, end));
        steps
    }

    /// True where the steps of another run are enough longer to tell the error of this one.
    pub fn is_told_by(&self, other: &Kept) -> bool {
        !self.has_steps_of(other) && self.apart(other) > TELLING
    }

    /// True if most steps equal those of the other run, because something other than the tolerance limits them.
    pub fn has_steps_of(&self, other: &Kept) -> bool {
        2 * own_steps(self, &other.ends).count < self.steps()
    }

    /// True if all times of comparison were reached.
    pub fn is_whole(&self) -> bool {
        self.times == COMPARISONS
    }

    /// The time at its end.
    pub fn end(&self) -> f64 {
        self.ends.last().copied().unwrap_or_default()
    }

    /// The number of steps.
    pub fn steps(&self) -> usize {
        self.ends.len().saturating_sub(1)
    }

    /// The longest step.
    pub fn longest(&self) -> f64 {
        self.longest
    }

    /// The difference of two runs relative to their largest motion: the root mean square over the times of the largest value over nodes and
    /// bodies. Displacements, rotations and velocities of bodies each refer to their largest value; `size` relates translations
    /// and rotations. Motions of rounding do not differ. Infinite where a stage has stopped before there was enough to compare.
    pub fn difference(&self, other: &Kept, size: ModelSize) -> f64 {
        match self.times.min(other.times) {
            times if times < FEWEST => f64::INFINITY,
            times => self.difference_over(other, size, times),
        }
    }

    /// True if two runs have nothing in common: they differ too much over three quarters of the times. Later the difference may no longer grow
    /// with the error of the worse run, but still shows it to a fifth.
    pub fn has_lost(&self, other: &Kept, size: ModelSize) -> bool {
        let times = 3 * self.times.min(other.times) / 4;
        times > 0 && self.difference_over(other, size, times) > SATURATED
    }

    /// The difference over the first times alone.
    pub(super) fn difference_over(&self, other: &Kept, size: ModelSize, times: usize) -> f64 {
        let motion = self.motion().max(other.motion());
        if !size.is_seen(motion) {
            return 0.0;
        }
        let relevant = |Size { translation, rotation }: Size| {
            (translation.max(1e-6 * rotation * size.length), rotation.max(translation / size.length))
        };
        let (displacement, rotation) = relevant(motion);
        let (speed, spin) = relevant(self.speed().max(other.speed()));
        let relative = |difference: f64, of: f64| if difference == 0.0 { 0.0 } else { difference / of };
        let at = |time: usize| {
            let moved =
                self.displacements_at(time).iter().zip(other.displacements_at(time)).map(|(a, b)| (a - b).norm());
            let turned = self.rotations_at(time).iter().zip(other.rotations_at(time));
            let turned = turned.map(|(a, b)| angle(&(b * a.conjugate())));
            let moved = relative(moved.fold(0.0, f64::max), displacement);
            let at_rates = self.velocities_at(time).iter().zip(other.velocities_at(time));
            let rates = at_rates.map(|([v, w], [v_other, w_other])| {
                relative((v - v_other).norm(), speed).max(relative((w - w_other).norm(), spin))
            });
            moved.max(relative(turned.fold(0.0, f64::max), rotation)).max(rates.fold(0.0, f64::max))
        };
        ((0..times).map(|time| at(time).powi(2)).sum::<f64>() / times as f64).sqrt()
    }

    fn displacements_at(&self, time: usize) -> &[Vec3] {
        let count = self.displacements.len() / self.times;
        &self.displacements[time * count..(time + 1) * count]
    }

    fn rotations_at(&self, time: usize) -> &[Quaternion<f64>] {
        let count = self.rotations.len() / self.times;
        &self.rotations[time * count..(time + 1) * count]
    }

    fn velocities_at(&self, time: usize) -> &[[Vec3; 2]] {
        let count = self.velocities.len() / self.times;
        &self.velocities[time * count..(time + 1) * count]
    }

    /// The largest velocity and the largest angular velocity of a body.
    fn speed(&self) -> Size {
        let largest = |of: usize| self.velocities.iter().map(|rates| rates[of].norm()).fold(0.0, f64::max);
        Size { translation: largest(0), rotation: largest(1) }
    }

    /// The largest displacement of a node and the largest rotation of a body.
    fn motion(&self) -> Size {
        let translation = self.displacements.iter().map(|u| u.norm()).fold(0.0, f64::max);
        Size { translation, rotation: self.rotations.iter().map(angle).fold(0.0, f64::max) }
    }
}

/// The steps of a run that another one, with these ends, has not gone.
fn own_steps(run: &Kept, other: &[f64]) -> Steps {
    let mut own = Steps::new(run.power);
    let mut at = 0;
    for (k, step) in run.ends.windows(2).enumerate() {
        let rounding = 1e-9 * (step[1] - step[0]);
        while other.get(at).is_some_and(|time| *time < step[0] - rounding) {
            at += 1;
        }
        let is = |place: usize, time: f64| other.get(place).is_some_and(|end| (end - time).abs() <= rounding);
        if !(is(at, step[0]) && is(at + 1, step[1])) {
            own.add(run, k + 1);
        }
    }
    own
}

/// Sums over steps of a run.
struct Steps {
    count: usize,
    power: i32,
    time: f64,
    /// Of the power of their lengths that errors follow, and of their errors by their own estimate.
    left: f64,
    estimated: f64,
}

impl Steps {
    fn new(power: i32) -> Steps {
        Steps { count: 0, power, time: 0.0, left: 0.0, estimated: 0.0 }
    }

    /// Adds the step to this end.
    fn add(&mut self, run: &Kept, end: usize) {
        let length = run.ends[end] - run.ends[end - 1];
        self.count += 1;
        self.time += length;
        self.left += length.powi(self.power);
        self.estimated += run.errors.get(end).copied().unwrap_or_default();
    }

    /// The ratio of the errors of other steps to those of these. Long steps that damp vibrations away err by their amplitude, whatever the length,
    /// and their own estimates show it.
    fn apart(&self, other: &Steps) -> f64 {
        let estimated = other.estimated / other.time / (self.estimated / self.time);
        let apart = self.sums_apart(other).powf(SLOPE);
        if estimated.is_finite() {
            apart.min(OWN_ESTIMATE * estimated).max(self.lengths_apart(other).min(apart))
        } else {
            apart
        }
    }

    /// The ratio of the lengths of other steps to those of these.
    fn lengths_apart(&self, other: &Steps) -> f64 {
        self.sums_apart(other).powf(1.0 / f64::from((self.power - 1).max(1)))
    }

    /// The ratio of the sums of the power of lengths, per unit of time.
    fn sums_apart(&self, other: &Steps) -> f64 {
        if self.left > 0.0 { other.left / other.time / (self.left / self.time) } else { 1.0 }
    }
}

/// The angle of a rotation, in radians, up to π.
fn angle(rotation: &Quaternion<f64>) -> f64 {
    2.0 * rotation.imag().norm().atan2(rotation.w.abs())
}
