//! Steps of Runge-Kutta schemes by the error estimate of their embedded schemes.

use super::adaptive::StepController;
use super::tolerance::{EventLimit, FollowTolerance};
use crate::context::Context;
use crate::explicit::RungeKuttaStepper;
use crate::failure::Failure;
use crate::jumps;
use crate::report::StepReport;
use crate::step::size::Size;
use crate::system::kinks::has_kinks;
use crate::tolerances::embedded_error::{FEWEST, GLANCE, GROWTH, SAFETY, TURN};
use crate::workspace::Workspace;
use base::snapshot::keep;
use mechanics::state::State;

/// Leads a Runge-Kutta scheme by the error of its steps.
pub struct EmbeddedErrorController {
    stepper: Box<RungeKuttaStepper>,
    /// Error of displacements allowed for the whole run, relative to the largest displacement.
    tolerance: f64,
    /// Value in the deck.
    asked: f64,
    /// Length of the next step.
    next: f64,
    /// Largest displacement and rotation so far.
    motion: Size,
    /// Length of the first step of a run, the longest allowed, and the longest at the tolerance of the deck.
    first: f64,
    longest: f64,
    most: f64,
    /// The longest rotation of a step.
    turn: f64,
    /// State at the start of the step, and the largest motion up to there.
    start: State,
    motion_at_start: Size,
    /// The state at a time inside the step.
    inside: State,
    events: EventLimit,
}

keep!(EmbeddedErrorController {
    stepper, tolerance, next, motion, longest, turn, start, inside, events
} without { asked, first, most, motion_at_start });

impl EmbeddedErrorController {
    /// A controller with this tolerance and first step.
    pub fn new(cx: &Context, stepper: Box<RungeKuttaStepper>, tolerance: f64, first: f64) -> EmbeddedErrorController {
        let most = if stepper.looks_inside() { cx.model.analysis.duration() / FEWEST } else { f64::INFINITY };
        EmbeddedErrorController {
            stepper,
            tolerance,
            asked: tolerance,
            next: first,
            motion: cx.size().least_motion(tolerance),
            first,
            longest: most,
            most,
            turn: TURN,
            start: State::default(),
            motion_at_start: Size::default(),
            inside: State::default(),
            events: EventLimit::default(),
        }
    }

    /// True where the motion inside steps is known.
    pub fn looks_inside(&self) -> bool {
        self.stepper.looks_inside()
    }

    /// Judges the trial motion of a step of `dt` and chooses the next length. Returns the largest motion including it, and the
    /// error as a length.
    ///
    /// # Errors
    /// [`Failure::ErrorTooLarge`] where this one was too long.
    fn judge(&mut self, cx: &Context, ws: &Workspace, dt: f64) -> Result<(Size, f64), Failure> {
        let end_time = cx.model.analysis.duration();
        let mut motion = self.motion;
        let (mut speed, mut spin) = (0.0f64, 0.0f64);
        for &node in cx.independent_nodes.iter().filter(|node| !cx.numbers.contains(node)) {
            let (now, first) = (&ws.trial.nodes[node], &cx.model.nodes[node]);
            motion.translation = motion.translation.max((now.x - first.x).norm());
            motion.rotation = motion.rotation.max(2.0 * now.rotation.imag().norm());
            speed = speed.max(now.v.norm());
            spin = spin.max(now.omega.norm());
        }
        let ahead = GLANCE * end_time;
        let translation = motion.translation.max(ahead * speed);
        let rotation = motion.rotation.max(ahead * spin).max(translation / cx.length);
        let error = self.stepper.error(cx, dt);
        let part = |error: f64, of: f64| if error == 0.0 { 0.0 } else { error / of };
        let error = part(error.translation, translation).max(part(error.rotation, rotation));
        let length = error * translation.max(rotation * cx.length);
        // Errors of steps add up: each may use the share of the tolerance that its length has of the run.
        let ratio = error * end_time / (dt * self.tolerance);
        let [least, most] = GROWTH;
        let factor = (SAFETY * ratio.powf(-1.0 / (self.stepper.error_order() - 1.0))).clamp(least, most);
        self.next = (dt * if factor.is_nan() { least } else { factor }).min(self.turn / spin);
        if ratio > 1.0 || ratio.is_nan() {
            self.next = self.next.min(SAFETY * dt);
            return Err(Failure::ErrorTooLarge { dt });
        }
        Ok((motion, length))
    }
}

impl FollowTolerance for EmbeddedErrorController {
    fn follow(&mut self, _: &Context, tolerance: f64, longest: Option<f64>) {
        // A trial has a longer first step too, otherwise both runs would share its effects.
        let longer = (tolerance / self.asked).powf(1.0 / self.stepper.error_order()).clamp(1.0, 2.0);
        (self.tolerance, self.next) = (tolerance, self.first * longer);
        (self.longest, self.turn) = (longest.unwrap_or(self.most), TURN * longer);
        self.events = EventLimit::default();
    }
}

impl StepController for EmbeddedErrorController {
    fn restart(&mut self, _: &Context, _: &mut Workspace, state: &mut State) {
        self.start.clone_from(state);
        self.inside.clone_from(state);
    }

    fn release(&mut self, cx: &Context, ws: &mut Workspace, state: &mut State, dt: f64) -> Result<(), Failure> {
        jumps::release(cx, ws, state, dt)
    }

    fn propose(&mut self, cx: &Context, _: &mut Workspace, _: &State, _: f64) -> Result<f64, Failure> {
        // The length does not fall below the least step: if that fails too, its failure says why.
        Ok(self.next.min(self.longest).max(cx.model.analysis.least_step))
    }

    fn step(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &mut State,
        to: f64,
        _: f64,
    ) -> Result<Option<StepReport>, Failure> {
        let dt = to - state.time;
        self.stepper.evaluate_stages(cx, ws, state, to)?;
        let (motion, error) = self.judge(cx, ws, dt)?;
        self.start.copy_from(state);
        self.motion_at_start = self.motion;
        let report = self.stepper.accept(cx, ws, state, to)?;
        if has_kinks(cx.system) {
            if self.events.is_passed(cx, [&self.start, state], self.tolerance) {
                state.copy_from(&self.start);
                self.next = 0.5 * dt;
                return Err(Failure::ErrorTooLarge { dt });
            }
            self.events.accept([&self.start, state]);
        }
        // A step refused by contacts or joints has not moved anything, so its motion is no reference for errors.
        self.motion = motion;
        Ok(Some(StepReport { error, ..report }))
    }

    fn cut_back(&mut self, dt: f64) {
        self.next = 0.5 * dt;
    }

    fn go_on_with(&mut self, tolerance: f64) {
        // A next step as long as before would be refused. After a rise the length grows with the steps.
        let order = self.stepper.error_order() - 1.0;
        self.next *= (tolerance / self.tolerance).powf(1.0 / order).min(1.0);
        self.tolerance = tolerance;
    }

    fn look_inside(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        end: &State,
        time: f64,
    ) -> Result<Option<(&State, StepReport)>, Failure> {
        let report = self.stepper.look_inside(cx, ws, (&self.start, end), (&mut self.inside, time))?;
        Ok(report.map(|report| (&self.inside, report)))
    }

    fn take_back(&mut self, state: &mut State) {
        state.copy_from(&self.start);
        self.motion = self.motion_at_start;
    }
}
