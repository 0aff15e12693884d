//! Seismic isolators: friction pendulums and rubber with a lead core.

use super::line_keys::dashpot;
use crate::data::LinkKind;
use crate::places::axes::axes;
use crate::report::{Owner, Report};
use crate::values::keys;
use base::diagnostic::Span;
use deck::links as words;
use deck::words::NumberOrTable;
use mechanics::elements::isolator::{IsolatorLaw, SlidingFriction};

/// The keys of isolators alone.
pub fn keys(link: &words::Link) -> [(&'static str, Option<&Span>); 3] {
    keys!(link; axial_stiffness, radius, friction)
}

/// True for a link that is an isolator by its law.
pub fn is_one(link: &words::Link) -> bool {
    let law = link.law.as_ref().map(|law| law.value);
    matches!(law, Some(words::LinkLaw::FrictionPendulum | words::LinkLaw::LeadRubber))
}

/// An isolator; a link of another law has no such kind.
pub fn isolator<'d>(owner: &Owner<'d>, link: &'d words::Link, report: &mut Report<'d>) -> Option<LinkKind> {
    let is_pendulum = link.law.as_ref().is_some_and(|law| law.value == words::LinkLaw::FrictionPendulum);
    let what = if is_pendulum { "the law \"friction-pendulum\"" } else { "the law \"lead-rubber\"" };
    let others = keys!(
        link; gap, preload, points, failure, backbone, hardening, exponent, unloading, strength_loss, stiffness_loss, deterioration, pinching,
        free_length, direction, bushing_damping
    );
    report.reject_unused(what, &others);
    if let Some(place) = dashpot(link) {
        let hint = "put a link with a `bushing` of zeros and `bushing_damping` beside it";
        report.error_with::<()>(place, format!("`viscous` damping does not apply to {what}"), hint);
    }
    if let (Some(NumberOrTable::Table(table)), true) = (link.damping.as_ref().map(|given| &given.value), is_pendulum)
        && let Some(beta) = &table.beta
    {
        let hint = "the stiffness of a slider only holds it to its dish: leave it out";
        report.error_with::<()>(&beta.span, format!("`beta` does not apply to {what}"), hint);
    }
    let stiffness = report.require_positive(owner, "stiffness", &link.stiffness);
    let axial_stiffness = report.require_positive(owner, "axial_stiffness", &link.axial_stiffness);
    let law = if is_pendulum { pendulum(owner, link, report) } else { rubber(owner, link, stiffness, report) };
    let axes = match &link.axes {
        Some(table) => axes(table, report),
        None if report.is_spoiled(owner.span, "axes") => None,
        None => {
            let hint = "such as [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]: first the direction from `from`, which holds the dish, to `to`";
            report.error_with(owner.span, format!("{} needs `axes`", owner.what), hint)
        }
    };
    Some(LinkKind::Isolator { law: law?, stiffness: stiffness?, axial_stiffness: axial_stiffness?, axes: axes? })
}

fn pendulum<'d>(owner: &Owner<'d>, link: &'d words::Link, report: &mut Report<'d>) -> Option<IsolatorLaw> {
    report.reject_unused("the law \"friction-pendulum\"", &keys!(link; yield_force, post_yield_stiffness));
    let radius = report.require_positive(owner, "radius", &link.radius);
    let friction = match &report.require(owner, "friction", &link.friction)?.value {
        NumberOrTable::Number(_) => {
            let given = link.friction.as_ref()?;
            let value = match given.value {
                NumberOrTable::Number(mu) if mu >= 0.0 => Some(mu),
                _ => report.error(&given.span, "`friction` must not be negative"),
            };
            value.map(|mu| SlidingFriction { slow: mu, fast: mu, rate: 0.0 })
        }
        NumberOrTable::Table(table) => {
            let place = &link.friction.as_ref()?.span;
            let owner = Owner::new("`friction`", place);
            report.require(&owner, "slow", &table.slow);
            report.require(&owner, "fast", &table.fast);
            let [slow, fast] =
                [("slow", &table.slow), ("fast", &table.fast)].map(|(key, mu)| report.not_negative(key, mu, 0.0));
            report.require_positive(&owner, "rate", &table.rate).map(|rate| SlidingFriction { slow, fast, rate })
        }
    };
    Some(IsolatorLaw::Pendulum { radius: radius?, friction: friction? })
}

fn rubber<'d>(
    owner: &Owner<'d>,
    link: &'d words::Link,
    stiffness: Option<f64>,
    report: &mut Report<'d>,
) -> Option<IsolatorLaw> {
    report.reject_unused("the law \"lead-rubber\"", &keys!(link; radius, friction));
    let yield_force = report.require_positive(owner, "yield_force", &link.yield_force);
    let post_yield_stiffness = report.require_positive(owner, "post_yield_stiffness", &link.post_yield_stiffness);
    let post_yield_stiffness = super::hysteretic::below_stiffness(link, post_yield_stiffness?, stiffness?, report)?;
    Some(IsolatorLaw::Rubber { yield_force: yield_force?, post_yield_stiffness })
}
