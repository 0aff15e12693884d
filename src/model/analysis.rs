//! `[analysis]`, `[integrator]`, `[iteration]`.

use super::build::{Builder, Owner, chosen, span};
use super::step_length::{ERROR_TOLERANCE, FIRST_STEP, stable_fraction};
use super::{Analysis, AnalysisKind, MassKind, Method, StepLength};
use crate::deck::analysis as deck;
use crate::deck::read::ROOT;
use crate::deck::words::{Maybe, NumberOrAuto};
use crate::diagnostic::{At, Diagnostic, Span};
use crate::integrators::wilson_theta::STABLE_THETA;
use crate::integrators::{
    Bathe, CentralDifference, GeneralizedAlpha, RungeKutta, Scheme, WilsonTheta, hht_alpha, newmark,
};
use crate::names::short;

/// A step is halved at most so many times, unless the deck says otherwise.
const HALVINGS: i32 = 20;
/// More steps are a slip of the keyboard.
const MOST_STEPS: f64 = 1e9;
/// Steps of a run whose error is to be τ are about so many over τ^(1/p), p the order of the scheme.
const STEPS: f64 = 20.0;

impl<'d> Builder<'d> {
    pub fn analysis(&mut self) {
        match &self.deck.analysis {
            Some(analysis) => self.times(&analysis.value, &analysis.span),
            None if self.is_spoiled(&ROOT, "analysis") => {}
            None => {
                let example = "[analysis]\nkind = \"dynamic\"\nend_time = 1.0\ntime_step = 1e-3";
                self.problems.push(Diagnostic::error("the deck has no table `[analysis]`").hint(example));
            }
        }
        if let Some(integrator) = &self.deck.integrator {
            self.scheme(integrator);
        }
        self.can_follow_error();
        if let (StepLength::ErrorControlled { tolerance, .. }, Some(analysis)) =
            (&self.model.analysis.step_length, &self.deck.analysis)
            && let Some(at) = &analysis.value.error_tolerance
        {
            let (tolerance, scheme) = (*tolerance, self.model.scheme.clone());
            self.can_be_kept("error_tolerance", tolerance, &scheme, &at.span);
        }
        if self.model.analysis.step_length.is_automatic() && matches!(self.model.scheme, Scheme::CentralDifference(_)) {
            let fraction = stable_fraction(&self.model);
            self.model.analysis.step_length = StepLength::StabilityLimited { fraction };
        }
        if let Some(iteration) = &self.deck.iteration {
            self.iteration(iteration);
        }
    }

    fn times(&mut self, analysis: &'d deck::Analysis, span: &'d std::ops::Range<usize>) {
        let owner = Owner { what: "`[analysis]`".to_owned(), span };
        let kind = self.need(&owner, "kind", &analysis.kind).map(|kind| kind.value).unwrap_or_default();
        let end_time = self.need_positive(&owner, "end_time", &analysis.end_time);
        let (time_step, error_tolerance) = self.time_step(&owner, analysis, kind);
        let least_step = self.positive("least_step", &analysis.least_step);
        if let (Some(end), Some(step), Some(at)) = (end_time, time_step, &analysis.time_step)
            && step > end
        {
            self.error::<()>(&at.span, format!("`time_step` is longer than the run, which ends at {end}"));
        }
        if let (Some(end), Some(step), Some(at)) = (end_time, time_step, &analysis.time_step)
            && end / step > MOST_STEPS
        {
            let message = format!("`time_step` asks for {:.1e} steps", end / step);
            self.error_with::<()>(&at.span, message, format!("at most {MOST_STEPS:.0e} are taken to be meant"));
        }
        if let (Some(least), Some(step), Some(at)) = (least_step, time_step, &analysis.least_step)
            && least > step
        {
            self.error::<()>(&at.span, format!("`least_step` is above `time_step`, which is {step}"));
        }
        if let (Some(least), Some(end), Some(_), Some(at)) =
            (least_step, end_time, error_tolerance, &analysis.least_step)
            && least > FIRST_STEP * end
        {
            let longest = short(FIRST_STEP * end);
            self.error::<()>(&at.span, format!("`least_step` is above the first automatic step, which is {longest}"));
        }
        let end_time = end_time.unwrap_or(f64::MAX);
        let (step_length, least) = match error_tolerance {
            Some(tolerance) => {
                (StepLength::ErrorControlled { tolerance, first: FIRST_STEP * end_time }, end_time / MOST_STEPS)
            }
            None => {
                let step = time_step.unwrap_or(1.0);
                (StepLength::Fixed { step }, step * 0.5_f64.powi(HALVINGS))
            }
        };
        self.model.analysis = Analysis {
            kind,
            end_time,
            step_length,
            least_step: least_step.unwrap_or(least),
            plane: analysis.plane.as_ref().is_none_or(|plane| plane.value == deck::Plane::Auto),
        };
    }

    /// The length of the steps, or the error that it follows.
    fn time_step(
        &mut self,
        owner: &Owner,
        analysis: &'d deck::Analysis,
        kind: AnalysisKind,
    ) -> (Option<f64>, Option<f64>) {
        let Some(at) = self.need(owner, "time_step", &analysis.time_step) else { return (None, None) };
        let tolerance = &analysis.error_tolerance;
        match at.value {
            NumberOrAuto::Number(step) => {
                self.stray("a `time_step` that is a number", &[("error_tolerance", span(tolerance))]);
                (self.positive("time_step", &Some(At { value: step, span: at.span.clone() })), None)
            }
            NumberOrAuto::Auto if kind == AnalysisKind::Static => {
                let hint = "load steps have no error in time: give a number";
                self.error_with::<()>(&at.span, "`time_step` is \"auto\" in a static analysis", hint);
                (None, None)
            }
            NumberOrAuto::Auto => {
                if let Some(at) = tolerance
                    && !(at.value > 0.0 && at.value < 1.0)
                {
                    let hint = "it is relative to the largest displacement";
                    self.error_with::<()>(&at.span, "`error_tolerance` must lie between 0 and 1", hint);
                }
                (None, Some(tolerance.as_ref().map_or(ERROR_TOLERANCE, |at| at.value)))
            }
        }
    }

    /// What an error is estimated by holds for schemes of second order.
    fn can_follow_error(&mut self) {
        if self.model.analysis.step_length.is_automatic()
            && let Scheme::Newmark(GeneralizedAlpha { gamma, .. }) = self.model.scheme
            && gamma != 0.5
            && let Some(at) = self.deck.analysis.as_ref().and_then(|analysis| analysis.value.time_step.as_ref())
        {
            let message = format!("`time_step` is \"auto\", but Newmark with gamma = {gamma} is of first order");
            self.error_with::<()>(&at.span, message, "leave gamma at 0.5, or use \"generalized-alpha\"");
        }
    }

    /// Each step rounds, and shorter ones are more: beyond ε n = τ, n = 20/τ^(1/p), the sum may be more than the tolerance. (A mass on
    /// a spring ends at 7e-11, whatever is asked of a scheme of second order.)
    pub(super) fn can_be_kept(&mut self, key: &str, tolerance: f64, scheme: &Scheme, place: &Span) {
        let order = scheme.order() as f64;
        let least = (STEPS * f64::EPSILON).powf(order / (order + 1.0));
        if tolerance > 0.0 && tolerance < least {
            let message = format!("`{key}` is below what the digits of numbers hold with \"{}\"", scheme.word());
            let hint = format!("rounding of so many steps may add up to more than {least:.0e}");
            self.warn(place, message, hint);
        }
    }

    pub(super) fn scheme(&mut self, integrator: &'d deck::Integrator) {
        let rotation = chosen(&integrator.rotation_update);
        let word = integrator.scheme.as_ref().map_or(deck::Scheme::WilsonTheta, |scheme| scheme.value);
        let keys = [
            ("theta", &integrator.theta, deck::Scheme::WilsonTheta),
            ("gamma", &integrator.gamma, deck::Scheme::Newmark),
            ("beta", &integrator.beta, deck::Scheme::Newmark),
            ("alpha", &integrator.alpha, deck::Scheme::HhtAlpha),
            ("spectral_radius", &integrator.spectral_radius, deck::Scheme::GeneralizedAlpha),
            ("split", &integrator.split, deck::Scheme::Bathe),
        ];
        let strays = keys.iter().filter(|(.., of)| *of != word).map(|(key, value, _)| (*key, span(value)));
        let mut strays: Vec<_> = strays.collect();
        if word == deck::Scheme::RungeKutta {
            strays.push(("rotation_update", span(&integrator.rotation_update)));
        } else {
            strays.push(("order", span(&integrator.order)));
        }
        self.model.scheme = match word {
            deck::Scheme::WilsonTheta => {
                let theta = self.theta(integrator);
                Scheme::WilsonTheta(WilsonTheta { theta, rotation })
            }
            deck::Scheme::Newmark => {
                let (gamma, beta) = self.newmark(integrator);
                Scheme::Newmark(newmark(gamma, beta, rotation))
            }
            deck::Scheme::HhtAlpha => {
                let alpha = self.between("alpha", &integrator.alpha, [-1.0 / 3.0, 0.0], -0.05);
                Scheme::HhtAlpha(hht_alpha(alpha, rotation))
            }
            deck::Scheme::GeneralizedAlpha => {
                let radius = self.between("spectral_radius", &integrator.spectral_radius, [0.0, 1.0], 0.8);
                Scheme::GeneralizedAlpha(GeneralizedAlpha::new(radius, rotation))
            }
            deck::Scheme::Bathe => {
                let split = self.between("split", &integrator.split, [0.05, 0.95], 2.0 - 2.0_f64.sqrt());
                Scheme::Bathe(Bathe { split, rotation })
            }
            deck::Scheme::CentralDifference => Scheme::CentralDifference(CentralDifference { rotation }),
            deck::Scheme::RungeKutta => Scheme::RungeKutta(self.runge_kutta(integrator)),
        };
        self.stray(&format!("the scheme \"{}\"", self.model.scheme.word()), &strays);
    }

    fn theta(&mut self, integrator: &deck::Integrator) -> f64 {
        let theta = integrator.theta.as_ref().map_or(1.4, |theta| theta.value);
        if let Some(at) = &integrator.theta {
            if theta < 1.0 {
                self.error::<()>(&at.span, "`theta` must be at least 1");
            } else if theta < STABLE_THETA {
                let limit = format!("below {STABLE_THETA} long steps may grow without bound");
                self.warn(&at.span, format!("Wilson-theta with theta = {theta} is not unconditionally stable"), limit);
            }
        }
        theta
    }

    /// γ and β; what is not second order or not unconditionally stable is said.
    fn newmark(&mut self, integrator: &deck::Integrator) -> (f64, f64) {
        let gamma = integrator.gamma.as_ref().map_or(0.5, |gamma| gamma.value);
        let beta = integrator.beta.as_ref().map_or(0.25 * (gamma + 0.5).powi(2), |beta| beta.value);
        if let Some(at) = &integrator.gamma {
            if gamma < 0.5 {
                self.error_with::<()>(&at.span, "`gamma` must be at least 0.5", "below, every motion grows");
            } else if gamma > 0.5 {
                let text = format!("Newmark with gamma = {gamma} is of first order");
                self.warn(&at.span, text, "\"generalized-alpha\" damps as well and is of second order");
            }
        }
        if let Some(at) = &integrator.beta {
            if beta <= 0.0 {
                self.error_with::<()>(&at.span, "`beta` must be above zero", "at zero the scheme is explicit");
            } else if 2.0 * beta < gamma {
                let text = format!("Newmark with beta = {beta} is not unconditionally stable");
                self.warn(&at.span, text, format!("below {} long steps may grow without bound", 0.5 * gamma));
            }
        }
        (gamma, beta)
    }

    fn runge_kutta(&mut self, integrator: &deck::Integrator) -> RungeKutta {
        let order = integrator.order.as_ref().map_or(8, |order| order.value);
        let scheme = usize::try_from(order).ok().and_then(RungeKutta::of_order);
        if let (None, Some(at)) = (&scheme, &integrator.order) {
            self.error_with::<()>(&at.span, format!("there is no Runge-Kutta scheme of order {order}"), "5 or 8");
        }
        scheme.unwrap_or_default()
    }

    /// Whether the scheme at hand, named there, goes with the materials.
    pub(super) fn check_yielding(&mut self, scheme: &Span) {
        let model = &self.model;
        if model.yields() && matches!(model.scheme, Scheme::RungeKutta(_)) {
            let hint = "material that yields remembers the way it came: \"central-difference\" follows it, and implicit schemes do";
            self.error_with::<()>(scheme, "\"runge-kutta\" does not go with material that yields", hint);
        }
    }

    /// What an explicit scheme cannot do, once all parts are known.
    pub(super) fn check_explicit(&mut self) {
        let deck = self.deck;
        let Some(at) = deck.integrator.as_ref().and_then(|integrator| integrator.scheme.as_ref()) else { return };
        if self.model.analysis.kind == AnalysisKind::Static || !self.model.scheme.is_explicit() {
            return;
        }
        if let StepLength::StabilityLimited { .. } = self.model.analysis.step_length {
            // Now that links and contacts are known.
            let fraction = stable_fraction(&self.model);
            self.model.analysis.step_length = StepLength::StabilityLimited { fraction };
        }
        self.check_yielding(&at.span);
        let model = &self.model;
        if model.parts.iter().any(|part| part.mass_kind() == Some(MassKind::Consistent)) {
            let hint = "mass = \"lumped\" needs no matrix at all";
            self.warn(&at.span, "consistent masses are factorised at every evaluation of an explicit scheme", hint);
        }
        if let (Scheme::CentralDifference(_), Some(tolerance)) =
            (&self.model.scheme, deck.analysis.as_ref().and_then(|analysis| analysis.value.error_tolerance.as_ref()))
        {
            let hint = "its steps are as long as is stable";
            self.error_with::<()>(
                &tolerance.span,
                "`error_tolerance` means nothing for the scheme \"central-difference\"",
                hint,
            );
        }
    }

    fn between(&mut self, key: &str, value: &Maybe<f64>, [low, high]: [f64; 2], default: f64) -> f64 {
        match value {
            Some(at) if !(low..=high).contains(&at.value) => {
                let range = format!("from {} to {}", short(low), short(high));
                self.error_with::<()>(&at.span, format!("`{key}` lies out of its range"), range);
                default
            }
            Some(at) => at.value,
            None => default,
        }
    }

    fn iteration(&mut self, iteration: &deck::Iteration) {
        if let Some(at) = &iteration.tolerance
            && !(at.value > 0.0 && at.value < 1.0)
        {
            self.error_with::<()>(&at.span, "`tolerance` must lie between 0 and 1", "it is relative");
        }
        let method: Method = chosen(&iteration.method);
        // An elastic matrix converges slowly while material yields, at little cost per iteration.
        let default = if method == Method::InitialLoad { 10 } else { 1 } * self.model.iteration.limit;
        let limit = self.count("limit", &iteration.limit, default);
        let own = &mut self.model.iteration;
        own.method = method;
        own.limit = limit;
        own.tolerance = iteration.tolerance.as_ref().map_or(own.tolerance, |at| at.value);
        own.gyroscopic = chosen(&iteration.gyroscopic);
        own.update = chosen(&iteration.update);
    }
}
