//! Watches slip under friction that begins again after rest. The exact slip begins with zero velocity, but the spring of friction releases
//! with the velocity F/√(k m) and the step adds h F/m. The following slip is too long by this velocity times its duration. Models without
//! friction are not watched.

use super::context::Context;
use super::friction_warnings::SlipBegins;
use super::throws::Throw;
use super::warning::Warning;
use crate::system::{FrictionPlace, friction_places, law_of, slip};
use crate::tolerances::slip_watch::{LEFT, OF_LENGTH, OF_STRETCH, SEEN};
use base::math::Vec3;
use base::snapshot::keep;
use mechanics::elements::slip::Slip;
use mechanics::state::State;
use model::StepLength;

/// The springs of friction of a scene.
#[derive(Default)]
pub struct SlipWatch {
    springs: Vec<Spring>,
    throws: Vec<Throw>,
}

keep!(SlipWatch { springs, throws });

/// The distance above which slip is a visible motion of the model; springs of friction stretch by `stick` before they slip.
fn visible(cx: &Context, stick: f64) -> f64 {
    (OF_LENGTH * cx.length).max(OF_STRETCH * stick)
}

/// A spring of friction, with its accumulated slip.
#[derive(Default)]
struct Spring {
    group: usize,
    element: usize,
    /// True if the bodies touched at the end of the last step.
    touched: bool,
    /// True once it has come to rest since it slipped last: slip that follows begins with speed zero.
    rests: bool,
    /// Its force at the end of the last step, the largest so far, and the force per stretch.
    pull: f64,
    limit: f64,
    stiffness: f64,
    phase: Phase,
    /// The sum of the slip, and its largest distance from the start.
    way: [f64; 3],
    farthest: f64,
    /// The sum of the errors of phases, and how large it was at most.
    error: [f64; 3],
    largest: f64,
}

keep!(Spring: Default { group, element, touched, rests, pull, limit, stiffness, phase, way, farthest, error, largest });

/// Slip in one direction.
#[derive(Default, Clone)]
struct Phase {
    /// A vector along it; zero where nothing slips.
    direction: [f64; 3],
    /// True where it began at rest.
    counts: bool,
    /// Its steps, up to three, the length and speed of the last, and the length of the first.
    steps: usize,
    last: [f64; 2],
    first: f64,
    /// Its duration and its way.
    duration: f64,
    length: f64,
    /// The speed with which it began.
    speed: f64,
    /// Its error so far.
    error: f64,
}

keep!(Phase: Default { direction, counts, steps, last, first, duration, length, speed, error });

impl SlipWatch {
    /// Watches the springs of friction of a dynamic model.
    pub fn new(cx: &Context) -> SlipWatch {
        let rubbing = if cx.is_dynamic() { friction_places(cx.system) } else { Vec::new() };
        let throws = Throw::of_contacts(cx, &rubbing);
        let spring = |FrictionPlace { group, element }| Spring { group, element, ..Spring::default() };
        SlipWatch { springs: rubbing.into_iter().map(spring).collect(), throws }
    }

    /// Records a step of length `dt` to this state, from the history `before`.
    #[inline]
    pub fn note(&mut self, cx: &Context, before: &[f64], state: &State, dt: f64) {
        for spring in &mut self.springs {
            let at = FrictionPlace { group: spring.group, element: spring.element };
            let slip = slip(cx.system, at, [before, &state.history], dt);
            spring.follow(&slip, dt);
            if let Some(throw) = self.throws.iter_mut().find(|throw| throw.group == spring.group) {
                throw.meet(&slip, spring.touched);
            }
            spring.touched = slip.touches;
        }
        self.throws.iter_mut().for_each(|throw| throw.end_step(dt));
    }

    /// The warning of the contact that throws off a resting body, if the slide meanwhile is visible.
    pub fn throws(&self, cx: &Context) -> Option<Warning> {
        let stick =
            |group: usize| self.springs.iter().filter(|of| of.group == group).map(Spring::stick).fold(0.0, f64::max);
        let seen = self.throws.iter().filter(|throw| throw.slid > visible(cx, stick(throw.group)));
        seen.max_by(|a, b| a.slid.total_cmp(&b.slid))?.warning(cx)
    }

    /// The warning of the contact or joint whose slip has the largest error, in parts of the largest slip.
    pub fn warning(&self, cx: &Context) -> Option<Warning> {
        let part = |spring: &Spring| spring.largest / spring.farthest;
        let seen = self.springs.iter().filter(|spring| spring.is_seen(cx) && part(spring) > SEEN);
        let worst = seen.max_by(|a, b| part(a).total_cmp(&part(b)))?;
        let group = &cx.system.groups[worst.group];
        let of = group.part_of(worst.element, cx.model);
        let factor = part(worst) / LEFT;
        let contact = law_of(cx.model, group).map(|(_, law)| law);
        let step = Some(cx.model.analysis.nominal_step())
            .filter(|_| matches!(cx.model.analysis.step_length, StepLength::Fixed { .. }));
        Some(Warning::SlipBegins(SlipBegins {
            name: of.name().to_owned(),
            error: worst.largest,
            farthest: worst.farthest,
            stiffness: contact.map(|law| [law.stiffness, law.stiffness * factor * factor]),
            stick: contact.is_none().then(|| worst.stick() / (factor * factor)),
            step: step.map(|step| step / factor),
        }))
    }
}

impl Spring {
    /// True if its slip is a visible motion of the model, and not settling or a small yielding.
    fn is_seen(&self, cx: &Context) -> bool {
        self.farthest > visible(cx, self.stick())
    }

    /// Its largest stretch before slip.
    fn stick(&self) -> f64 {
        if self.stiffness > 0.0 { self.limit / self.stiffness } else { 0.0 }
    }

    fn follow(&mut self, slip: &Slip, dt: f64) {
        let before = self.pull;
        if slip.stiffness > 0.0 {
            (self.stiffness, self.pull, self.limit) = (slip.stiffness, slip.pull, self.limit.max(slip.pull));
        }
        if !slip.touches {
            (self.rests, self.phase) = (false, Phase::default());
            return;
        }
        let length = slip.way.norm();
        if length == 0.0 {
            // The spring relaxes: the body has come to rest meanwhile.
            self.rests |= slip.pull < before;
            return;
        }
        let direction = Vec3::from(self.phase.direction);
        if self.rests || direction.dot(&slip.way) <= 0.0 {
            let counts = self.rests || direction != Vec3::zeros();
            (self.phase, self.rests) = (Phase { counts, ..Phase::default() }, false);
        }
        self.phase.direction = slip.way.into();
        let way = Vec3::from(self.way) + slip.way;
        (self.way, self.farthest) = (way.into(), self.farthest.max(way.norm()));
        let error = Vec3::from(self.error) + self.phase.follow(length, dt) / length * slip.way;
        (self.error, self.largest) = (error.into(), self.largest.max(error.norm()));
    }
}

impl Phase {
    /// Records a step that slips by `length`; returns the growth of the error of the phase. The speed at its beginning follows from its
    /// second and third step, since the first may slip in part.
    fn follow(&mut self, length: f64, dt: f64) -> f64 {
        let speed = length / dt;
        self.steps = (self.steps + 1).min(4);
        self.duration += dt;
        self.length += length;
        let [of, before] = self.last;
        if self.steps == 3 && self.counts {
            let slope = (speed - before) / (0.5 * (of + dt));
            self.speed = (before - slope * 0.5 * (self.first + of)).clamp(0.0, before);
        }
        if self.steps == 1 {
            self.first = dt;
        }
        self.last = [dt, speed];
        let error = (self.speed * self.duration).min(self.length);
        error - std::mem::replace(&mut self.error, error)
    }
}
