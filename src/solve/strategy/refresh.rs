//! Decides when the matrix is renewed.

use crate::context::Context;
use crate::step::convergence::Judgement;
use crate::tolerances::refresh::{GROWTH, MISLED, MOST_EAGER, SAME_STEP, SHARE, USED_UP, USEFUL, USELESS};
use base::snapshot::keep;
use mechanics::elements::Moduli;
use model::{Iteration, Method, Update};

/// The rule for renewing the matrix. It uses only counts and contraction, never the clock, so a deck always gives the same path.
#[derive(Debug, Clone)]
pub struct Refresh {
    method: Method,
    update: Update,
    /// Cost of a fresh matrix in iterations.
    cost: f64,
    /// True if corrections tell when a fresh matrix pays. Load steps are few; matrices of bodies alone lack gyroscopic terms, so fresh ones
    /// contract no faster.
    pub learns: bool,
    /// Step length of the current matrix; `None` if there is none, or it has proved useless.
    dt: Option<f64>,
    wanted: bool,
    /// Iterations of the step that formed the matrix, and the iterations beyond this number since.
    baseline: Option<usize>,
    excess: usize,
    /// Number of steps still to start with a fresh matrix, and the number to ask for when an old one misleads next.
    eager: usize,
    next_eager: usize,
    /// Size of a correction beyond which its matrix is useless afterwards, as observed so far.
    stale_beyond: f64,
    /// Size of the first correction of the current iteration, if its matrix was formed for it.
    first: Option<f64>,
    /// Number of equilibria that still get a fresh matrix in every iteration, the current one included. The second is the number to ask for
    /// at the next failure.
    required: usize,
    next_required: usize,
    /// True where the step gets the elastic matrix, since tangents have failed.
    elastic_required: bool,
}

keep!(Refresh {
    dt, wanted, baseline, excess, eager, next_eager, stale_beyond, first, required, next_required, elastic_required,
 } without { method, update, cost, learns });

/// The advice after a correction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Advice {
    /// The iteration continues.
    GoOn,
    /// The old matrix has misled: the iteration goes back to the prediction with a fresh one.
    Restart,
}

impl Refresh {
    /// Method and update of a run; the analysis decides if the deck does not.
    pub fn rule(cx: &Context) -> (Method, Update) {
        let Context { model, system, .. } = *cx;
        let Iteration { method, update, .. } = model.solution.iteration;
        // Load steps are long and few, and no mass steadies an old matrix; along a path an old one misleads.
        if model.analysis.step_length.is_arc_length() {
            return (Method::TangentStiffness, Update::Iteration);
        }
        let mixes = system.yields() && method != Method::TangentStiffness;
        match (model.analysis.is_dynamic(), update) {
            (false, Update::Auto) if !mixes => (method, Update::Iteration),
            (_, update) => (method, update),
        }
    }

    /// The rule of the deck; a linear scene never needs a new matrix.
    pub fn new(cx: &Context) -> Self {
        let (method, update) = Refresh::rule(cx);
        let update = if cx.plan.linear { Update::Never } else { update };
        let is_deformable = || cx.system.groups.iter().any(|group| group.kind.is_deformable());
        Refresh {
            method,
            update,
            cost: cx.plan.refresh_cost,
            learns: cx.is_dynamic() && update == Update::Auto && method != Method::InitialLoad && is_deformable(),
            dt: None,
            wanted: false,
            baseline: None,
            excess: 0,
            eager: 0,
            next_eager: 1,
            stale_beyond: f64::INFINITY,
            first: None,
            required: 0,
            next_required: 1,
            elastic_required: false,
        }
    }

    /// The moduli with which the matrix is formed.
    pub fn moduli(&self) -> Moduli {
        match self.method {
            _ if self.elastic_required => Moduli::Elastic,
            Method::InitialLoad if self.required == 0 => Moduli::Elastic,
            _ => Moduli::Algorithmic,
        }
    }

    /// True where the matrix is to be formed before the next solution; `iteration` counts from 0.
    pub fn due(&self, iteration: usize, dt: f64) -> bool {
        // Steps of equal length differ by the rounding of their ends.
        if self.wanted || self.required > 0 || self.dt.is_none_or(|of| (of - dt).abs() > SAME_STEP * dt) {
            return true;
        }
        match self.update {
            Update::Iteration => true,
            Update::Step => iteration == 0,
            Update::Auto => iteration == 0 && self.eager > 0,
            Update::Never => false,
        }
    }

    /// The rule inside a completed step: the current matrix is reused, whatever the deck requires.
    pub fn inside(&self) -> Refresh {
        let update = if self.update == Update::Never { Update::Never } else { Update::Auto };
        Refresh { update, eager: 0, wanted: false, ..self.clone() }
    }

    /// Records a new matrix for this step length.
    pub fn done(&mut self, dt: f64) {
        self.dt = Some(dt);
        self.baseline = None;
        self.excess = 0;
        self.wanted = false;
    }

    /// Records a correction of this size, the `count`-th of its iteration. A long correction turns slender parts so far that the earlier
    /// matrix no longer contracts; observed contractions set the limit of this size.
    pub fn note(&mut self, count: usize, fresh: bool, size: f64, judgement: &Judgement) {
        if self.update != Update::Auto || self.moduli() == Moduli::Elastic {
            return;
        }
        if count == 1 {
            self.stale_beyond *= GROWTH;
            self.first = fresh.then_some(size).filter(|_| size <= self.stale_beyond);
            self.wanted |= fresh && size > self.stale_beyond;
        } else if let Some(first) = self.first.take() {
            let contraction = self.contraction(judgement);
            if contraction > USELESS {
                self.stale_beyond = self.stale_beyond.min(SHARE * first);
            } else if contraction < USEFUL {
                self.stale_beyond = self.stale_beyond.max(first);
            }
        }
    }

    /// The contraction by which the matrix is judged.
    fn contraction(&self, judgement: &Judgement) -> f64 {
        if self.learns { judgement.of_matrix } else { judgement.contraction }
    }

    /// Judges the matrix after a correction that was compared with another of the same step. `fresh`: the matrix was
    /// formed in this step.
    pub fn advise(&mut self, fresh: bool, judgement: &Judgement) -> Advice {
        let contraction = self.contraction(judgement);
        // An elastic matrix contracts slowly where material yields, and a new one would not be faster.
        let patient = self.update == Update::Never || self.moduli() == Moduli::Elastic;
        if patient && (contraction < 1.0 || fresh) {
            return Advice::GoOn;
        }
        if !fresh && contraction > MISLED && self.required == 0 {
            self.wanted = true;
            ask_again(&mut self.eager, &mut self.next_eager);
            return Advice::Restart;
        }
        let pays = self.update == Update::Auto && judgement.remaining(self.learns) > 1.0 + self.cost;
        self.wanted = contraction > USED_UP || pays;
        Advice::GoOn
    }

    /// Counts an accepted step. Renewing a matrix pays once its excess iterations over a fresh one cost as much as the renewal.
    pub fn accepted(&mut self, iterations: usize) {
        let baseline = *self.baseline.get_or_insert(iterations);
        self.excess += iterations.saturating_sub(baseline);
        self.wanted = self.update == Update::Auto && self.excess as f64 >= self.cost;
        count_down(&mut self.eager, &mut self.next_eager);
        count_down(&mut self.required, &mut self.next_required);
    }

    /// Discards an elastic matrix at the end of the step that asked for it.
    pub fn end_step(&mut self) {
        if std::mem::take(&mut self.elastic_required) {
            self.dt = None;
        }
    }

    /// Discards the matrix after a failed step, because it belongs to a rejected motion.
    pub fn rejected(&mut self) {
        self.dt = None;
        self.elastic_required = false;
    }

    /// Asks, after a step that did not converge, for a fresh matrix in every iteration. Returns false if it was required already.
    pub fn require_fresh_matrix(&mut self) -> bool {
        let more = self.required == 0 && !self.elastic_required && matches!(self.update, Update::Auto | Update::Step);
        if more {
            ask_again(&mut self.required, &mut self.next_required);
        }
        more
    }

    /// Asks, after tangents did not converge either, for the elastic matrix. Returns false if this was required already, or the deck names
    /// a method.
    pub fn require_elastic_matrix(&mut self) -> bool {
        let more = !self.elastic_required && self.method == Method::Auto;
        if more {
            (self.elastic_required, self.required, self.wanted) = (true, 0, true);
        }
        more
    }
}

/// Asks for help in this and the following steps, in twice as many as the last time.
fn ask_again(steps: &mut usize, next: &mut usize) {
    *steps = *next;
    *next = (2 * *next).min(MOST_EAGER);
}

/// Counts a step with help. After a step without need, the next call for help covers half as many steps.
fn count_down(steps: &mut usize, next: &mut usize) {
    if *steps > 0 {
        *steps -= 1;
    } else {
        *next = 1.max(*next / 2);
    }
}
