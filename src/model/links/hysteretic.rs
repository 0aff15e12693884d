//! Laws of links whose force depends on their past.

use crate::report::{Owner, Report};
use crate::values::keys;
use base::diagnostic::{At, Span};
use deck::hysteresis::Deterioration;
use deck::links as words;
use deck::words::Table;
use mechanics::elements::bouc_wen::BoucWen;
use mechanics::elements::deteriorating::Deteriorating;
use mechanics::elements::hysteresis::Hysteresis;
use mechanics::elements::hysteretic_link::PathLaw;
use mechanics::elements::isotropic::Isotropic;
use mechanics::elements::pinching::{Pinching, Reloading};

/// What the deck gives.
#[derive(Clone, Copy)]
pub enum GivenLaw {
    /// Another law, or none.
    None,
    /// A law with errors, which are reported.
    Wrong,
    /// A law.
    Law(PathLaw),
}

/// The keys of these laws alone.
pub fn keys(link: &words::Link) -> Vec<(&'static str, Option<&Span>)> {
    let yielding = keys!(
        link; yield_force, post_yield_stiffness, backbone, hardening, exponent, unloading, strength_loss, stiffness_loss, deterioration, pinching
    );
    yielding.into_iter().collect()
}

/// The law of a link that yields; other laws have none of its keys.
pub fn law<'d>(owner: &Owner<'d>, link: &'d words::Link, report: &mut Report<'d>) -> GivenLaw {
    let found = match link.law.as_ref().map(|law| law.value) {
        Some(words::LinkLaw::Yielding) => yielding(owner, link, report),
        Some(words::LinkLaw::BoucWen) => bouc_wen(owner, link, report),
        Some(words::LinkLaw::IbarraMedinaKrawinkler) => ibarra_medina_krawinkler(owner, link, report),
        Some(words::LinkLaw::Pinching) => pinched(owner, link, report),
        _ => {
            report.reject_unused("a link whose law has no hysteresis", &keys(link));
            return GivenLaw::None;
        }
    };
    found.map_or(GivenLaw::Wrong, GivenLaw::Law)
}

/// Stiffness, the slope beyond yielding and the yield force.
fn elastic_and_yield<'d>(owner: &Owner<'d>, link: &'d words::Link, report: &mut Report<'d>) -> Option<[f64; 3]> {
    let stiffness = report.require_positive(owner, "stiffness", &link.stiffness);
    let force = report.require_positive(owner, "yield_force", &link.yield_force);
    let after = report.not_negative("post_yield_stiffness", &link.post_yield_stiffness, 0.0);
    let (stiffness, force) = (stiffness?, force?);
    Some([stiffness, below_stiffness(link, after, stiffness, report)?, force])
}

/// The slope beyond yielding, which must be below the stiffness.
pub fn below_stiffness<'d>(link: &'d words::Link, after: f64, stiffness: f64, report: &mut Report<'d>) -> Option<f64> {
    if let (Some(given), false) = (&link.post_yield_stiffness, after < stiffness) {
        let hint = "give a part of it, such as a tenth";
        return report.error_with(&given.span, "`post_yield_stiffness` must be below `stiffness`", hint);
    }
    Some(after)
}

fn yielding<'d>(owner: &Owner<'d>, link: &'d words::Link, report: &mut Report<'d>) -> Option<PathLaw> {
    let others = keys!(link; gap, preload, points, failure, exponent, unloading, strength_loss, stiffness_loss, deterioration, pinching);
    report.reject_unused("the law \"yielding\"", &others);
    let (points, after, place) = match &link.backbone {
        Some(backbone) => {
            report
                .reject_unused("a link with a `backbone`", &keys!(link; stiffness, yield_force, post_yield_stiffness));
            (backbone.value.iter().map(|point| point.value.0).collect(), 0.0, &backbone.span)
        }
        None => {
            let [stiffness, after, force] = elastic_and_yield(owner, link, report)?;
            (vec![[force / stiffness, force]], after, owner.span)
        }
    };
    let made = match link.hardening.as_ref().map(|hardening| hardening.value) {
        Some(words::LinkHardening::Isotropic) => Isotropic::new(&points, after).map(PathLaw::Isotropic),
        _ => Hysteresis::new(&points, after).map(PathLaw::Backbone),
    };
    match made {
        Ok(law) => Some(law),
        Err(reason) => {
            let hint = "give points such as [[0.01, 1e4], [0.05, 1.2e4]]";
            report.error_with(place, format!("the backbone of {}: {reason}", owner.what), hint)
        }
    }
}

fn ibarra_medina_krawinkler<'d>(owner: &Owner<'d>, link: &'d words::Link, report: &mut Report<'d>) -> Option<PathLaw> {
    let others = keys!(
        link; gap, preload, points, failure, backbone, hardening, exponent, unloading, strength_loss, stiffness_loss,
        pinching
    );
    report.reject_unused("the law \"ibarra-medina-krawinkler\"", &others);
    let given = elastic_and_yield(owner, link, report);
    let table = report.require(owner, "deterioration", &link.deterioration)?;
    deteriorating(given?, table, report)
}

/// The law of Ibarra, Medina and Krawinkler by stiffness, slope beyond yielding and yield force.
pub fn deteriorating<'d>(
    [stiffness, post_yield_stiffness, yield_force]: [f64; 3],
    At { value: table, span: place }: &'d At<Table<Deterioration>>,
    report: &mut Report<'d>,
) -> Option<PathLaw> {
    let owner = Owner::new("`deterioration`", place);
    let capping = report.require_positive(&owner, "capping", &table.capping);
    let post_capping = report.require_positive(&owner, "post_capping", &table.post_capping);
    let residual = report.not_negative("residual", &table.residual, 0.0);
    if let (Some(given), true) = (&table.residual, residual >= 1.0) {
        report.error_with::<()>(&given.span, "`residual` must be below 1", "it is a part of the yield force");
    }
    let mut or_none = |key: &str, value: &deck::words::Maybe<f64>| match value {
        Some(_) => report.positive(key, value),
        None => Some(f64::INFINITY),
    };
    let ultimate = or_none("ultimate", &table.ultimate);
    let capacities = [("strength", &table.strength), ("softening", &table.softening), ("unloading", &table.unloading)]
        .map(|(key, value)| or_none(key, value).map(|capacity| capacity * yield_force));
    let exponent = match &table.exponent {
        Some(given) if !(0.5..=2.0).contains(&given.value) => {
            report.error_with(&given.span, "`exponent` lies out of its range", "from 0.5 to 2")
        }
        given => Some(given.as_ref().map_or(1.0, |given| given.value)),
    };
    let [strength, softening, unloading] = capacities;
    let capacities = [strength?, softening?, unloading?];
    Some(PathLaw::Deteriorating(Deteriorating {
        stiffness,
        yield_force,
        post_yield_stiffness,
        capping: capping?,
        post_capping: post_capping?,
        residual: residual * yield_force,
        ultimate: ultimate?,
        capacities,
        exponent: exponent?,
    }))
}

fn pinched<'d>(owner: &Owner<'d>, link: &'d words::Link, report: &mut Report<'d>) -> Option<PathLaw> {
    let others = keys!(
        link; gap, preload, points, failure, stiffness, yield_force, post_yield_stiffness, hardening, exponent, unloading,
        strength_loss, stiffness_loss, deterioration
    );
    report.reject_unused("the law \"pinching\"", &others);
    let backbone = report.require(owner, "backbone", &link.backbone);
    let table = report.require(owner, "pinching", &link.pinching)?;
    let backbone = backbone?;
    let points: Vec<[f64; 2]> = backbone.value.iter().map(|point| point.value.0).collect();
    pinching(owner, (&points, &backbone.span), table, report)
}

/// A law that pinches, by its backbone.
pub fn pinching<'d>(
    owner: &Owner<'d>,
    (points, place): (&[[f64; 2]], &'d Span),
    At { value: table, .. }: &'d At<Table<deck::hysteresis::Pinching>>,
    report: &mut Report<'d>,
) -> Option<PathLaw> {
    let mut part = |key: &str, value: &deck::words::Maybe<f64>| match value {
        Some(given) if !(given.value > 0.0 && given.value <= 1.0) => {
            report.error_with(&given.span, format!("`{key}` lies out of its range"), "above 0, and at most 1")
        }
        given => Some(given.as_ref().map_or(1.0, |given| given.value)),
    };
    let [force, elongation] = [part("force", &table.force), part("elongation", &table.elongation)];
    let damage = [("ductility", &table.ductility), ("energy", &table.energy)]
        .map(|(key, value)| report.not_negative(key, value, 0.0));
    let unloading = report.not_negative("unloading", &table.unloading, 0.0);
    let reloading = Reloading { force: force?, elongation: elongation?, damage, unloading };
    match Pinching::new(points, reloading) {
        Ok(law) => Some(PathLaw::Pinching(law)),
        Err(reason) => {
            let hint = "give points such as [[0.01, 1e4], [0.05, 1.2e4], [0.1, 6e3]]";
            report.error_with(place, format!("the backbone of {}: {reason}", owner.what), hint)
        }
    }
}

fn bouc_wen<'d>(owner: &Owner<'d>, link: &'d words::Link, report: &mut Report<'d>) -> Option<PathLaw> {
    report.reject_unused(
        "the law \"bouc-wen\"",
        &keys!(link; gap, preload, points, failure, backbone, hardening, deterioration, pinching),
    );
    let given = elastic_and_yield(owner, link, report);
    let mut within = |key: &str, value: &deck::words::Maybe<f64>, [low, high]: [f64; 2], default: f64| match value {
        Some(given) if !(low..=high).contains(&given.value) => {
            let hint = format!("from {low} to {high}");
            report.error_with::<f64>(&given.span, format!("`{key}` lies out of its range"), hint)
        }
        given => Some(given.as_ref().map_or(default, |given| given.value)),
    };
    let exponent = within("exponent", &link.exponent, [1.0, 100.0], 2.0);
    let bulge = within("unloading", &link.unloading, [0.5, 1.0], 0.5);
    let losses = [("strength_loss", &link.strength_loss), ("stiffness_loss", &link.stiffness_loss)]
        .map(|(key, loss)| within(key, loss, [0.0, 1e3], 0.0));
    let [stiffness, post_yield_stiffness, yield_force] = given?;
    let losses = [losses[0]?, losses[1]?];
    Some(PathLaw::BoucWen(BoucWen {
        stiffness,
        post_yield_stiffness,
        yield_force,
        exponent: exponent?,
        bulge: bulge?,
        losses,
    }))
}
