//! `[[links]]`: their ends and laws.

pub mod foundation;
pub mod hysteretic;
pub mod isolator;
pub mod line_keys;
pub mod matrices;
pub mod pretension;

use crate::data::{Link, LinkKind, Load, OwnDamping};
use crate::links::foundation::foundations;
use crate::links::line_keys::{dashpot, of_lines};
use crate::links::matrices::bearing;
use crate::links::pretension::pretension;
use crate::own_damping::of_link;
use crate::places::axes::axes;
use crate::places::ends::EndTable;
use crate::places::nodes::Nodes;
use crate::report::{Owner, Report};
use crate::scene::Scene;
use crate::values::keys;
use base::diagnostic::At;
use base::math::Mat3;
use deck::links as words;
use deck::words::{Maybe, Numbers, Table};
use mechanics::constraints::joint::ConstraintEquation;
use mechanics::elements::coordinate_law::CoordinateLaw;
use mechanics::elements::damper::Damper;
use mechanics::elements::link::LinkLaw;
use mechanics::elements::link_failure::LinkFailure;

/// The links of a model: those of the deck, then those along coordinates of joints.
#[derive(Default)]
pub struct ModelLinks {
    /// All of them.
    pub list: Vec<Link>,
    /// The forces that pretension links.
    pub pulls: Vec<Load>,
}

impl ModelLinks {
    /// Adds a link along the coordinate of a joint; returns its index.
    pub fn add_to_coordinate(
        &mut self,
        joint: &str,
        ends: [usize; 2],
        (lock, law): (ConstraintEquation, CoordinateLaw),
        own_damping: OwnDamping,
    ) -> usize {
        let kind = LinkKind::Joint { lock, law };
        self.list.push(Link { name: joint.to_owned(), ends, kind, own_damping, failure: None, take_up: None });
        self.list.len() - 1
    }
}

/// Reads `[[links]]`, and adds the nodes at their ends.
pub fn links<'d>(scene: &Scene<'d>, nodes: &mut Nodes, report: &mut Report<'d>) -> ModelLinks {
    let mut links = ModelLinks::default();
    for (index, link) in scene.deck.links.iter().enumerate() {
        let (name, owner) = report.named(("link", "links", index), link.name.as_ref(), &link.span);
        let isolates = isolator::is_one(link);
        let rotations = link.bushing.is_some() || link.matrices.is_some() || isolates;
        let mut end = |key, end| {
            let end = EndTable { owner: &owner, key, end, label: format!("{name}.{key}"), rotations, default: None };
            end.node(scene, nodes, report)
        };
        let (from, to) = (end("from", &link.from), end("to", &link.to));
        let ends = from.zip(to).map(|(from, to)| [from, to]);
        let (damper, own_damping) = of_link(&link.damping, report);
        let kind = match (&link.bushing, &link.matrices) {
            (_, Some(list)) => bearing(&owner, link, list, report),
            (Some(_), None) => bushing(link, report),
            (None, None) if isolates => isolator::isolator(&owner, link, report),
            (None, None) => line(&owner, link, (ends, damper), nodes, report),
        };
        if let Some([from, to]) = ends
            && from == to
        {
            let message = format!("{} joins `{}` to itself", owner.what, nodes.label(from));
            report.error_with::<()>(owner.span, message, "name another node or body in `to`");
        }
        let failure = link.failure.as_ref().and_then(|table| failure(table, rotations, report));
        let pretension = pretension(&owner, link, kind.as_ref(), scene, report);
        if let (Some(ends), Some(kind)) = (ends, kind) {
            let take_up = pretension.map(|pretension| {
                let node = nodes.add_number(format!("{name}.take_up"), ends[0]);
                match pretension.pull(node) {
                    Some(pull) => links.pulls.push(pull),
                    None => nodes.restrain(node, 0, None),
                }
                node
            });
            links.list.push(Link { name, ends, kind, own_damping, failure, take_up });
        }
    }
    links.list.extend(foundations(scene, nodes, report));
    links
}

fn line<'d>(
    owner: &Owner<'d>,
    link: &'d words::Link,
    (ends, damper): (Option<[usize; 2]>, Damper),
    nodes: &Nodes,
    report: &mut Report<'d>,
) -> Option<LinkKind> {
    let unused = keys!(link; bushing_damping, axes);
    report.reject_unused("a link without `bushing`", &unused);
    report.reject_unused("a link that is no isolator", &isolator::keys(link));
    let path = hysteretic::law(owner, link, report);
    let law = match path {
        hysteretic::GivenLaw::None => law(owner, link, report),
        _ => None,
    };
    let free_length = link.free_length.as_ref().map(|length| length.value);
    let direction = match &link.direction {
        Some(direction) => Some(report.unit("direction", direction)?),
        None if report.is_spoiled(owner.span, "direction") => return None,
        None => {
            report.not_negative("free_length", &link.free_length, 0.0);
            None
        }
    };
    let arm = ends.map(|[from, to]| nodes.x(to) - nodes.x(from))?;
    let initial = match direction {
        Some(direction) => direction.dot(&arm),
        None if arm.norm() == 0.0 => {
            let message = format!("the ends of {} lie at the same place, so there is no line between them", owner.what);
            return report.error_with(owner.span, message, "give it a `direction`, from `from` to `to`");
        }
        None => arm.norm(),
    };
    let free_length = free_length.unwrap_or(initial);
    if let hysteretic::GivenLaw::Law(law) = path {
        return Some(LinkKind::Hysteretic { law, damper, direction, free_length });
    }
    Some(LinkKind::Line { law: law?, damper, direction, free_length })
}

fn law<'d>(owner: &Owner<'d>, link: &'d words::Link, report: &mut Report<'d>) -> Option<LinkLaw> {
    let law = match &link.law {
        Some(law) => law.value,
        None if report.is_spoiled(owner.span, "law") => return None,
        None => words::LinkLaw::Linear,
    };
    let [stiffness, gap] = keys!(link; stiffness, gap);
    let [preload, points] = keys!(link; preload, points);
    match law {
        words::LinkLaw::Linear => {
            report.reject_unused("the law \"linear\"", &[gap, points]);
            if dashpot(link).is_none() {
                report.require(owner, "stiffness", &link.stiffness)?;
            }
            let stiffness = report.not_negative("stiffness", &link.stiffness, 0.0);
            Some(LinkLaw::Linear { stiffness, preload: link.preload.as_ref().map_or(0.0, |force| force.value) })
        }
        words::LinkLaw::Table => {
            report.reject_unused("the law \"table\"", &[stiffness, gap, preload]);
            let points = report.require(owner, "points", &link.points)?;
            report.rising("points", "elongation", points).map(|points| LinkLaw::Table { points })
        }
        // Read before.
        words::LinkLaw::Yielding
        | words::LinkLaw::BoucWen
        | words::LinkLaw::IbarraMedinaKrawinkler
        | words::LinkLaw::Pinching
        | words::LinkLaw::FrictionPendulum
        | words::LinkLaw::LeadRubber => None,
        words::LinkLaw::CompressionOnly | words::LinkLaw::TensionOnly => {
            let one_sided = "a law that acts one way only";
            report.reject_unused(one_sided, &[preload, points]);
            let stiffness = report.require_positive(owner, "stiffness", &link.stiffness);
            let gap = report.not_negative("gap", &link.gap, 0.0);
            let stiffness = stiffness?;
            Some(match law {
                words::LinkLaw::CompressionOnly => LinkLaw::CompressionOnly { stiffness, gap },
                _ => LinkLaw::TensionOnly { stiffness, gap },
            })
        }
    }
}

fn bushing<'d>(link: &'d words::Link, report: &mut Report<'d>) -> Option<LinkKind> {
    report.reject_unused("a bushing", &of_lines(link));
    let stiffness = six("bushing", &link.bushing, report);
    let damping = six("bushing_damping", &link.bushing_damping, report);
    let axes = match &link.axes {
        Some(table) => axes(table, report)?,
        None => Mat3::identity(),
    };
    Some(LinkKind::Bushing { stiffness: stiffness?, damping: damping?, axes })
}

/// The forces of a link at failure. Along a line there is no shear.
fn failure<'d>(
    At { value: table, span }: &'d At<Table<words::Failure>>,
    is_bushing: bool,
    report: &mut Report<'d>,
) -> Option<LinkFailure> {
    let [normal, shear] = [("normal", &table.normal), ("shear", &table.shear)]
        .map(|(key, force)| if force.is_some() { report.positive(key, force) } else { Some(f64::INFINITY) });
    if let (Some(shear), false) = (&table.shear, is_bushing) {
        let message = "`shear` of `failure` does not apply to a link without `bushing`: its force lies along the line of its ends";
        return report.error_with(
            &shear.span,
            message,
            "give a `bushing`, which resists along three axes; the first one is normal",
        );
    }
    if table.normal.is_none() && table.shear.is_none() {
        return report.error(span, "`failure` needs `normal`, `shear` or both");
    }
    let exponents = table.exponents.as_ref().map_or([2.0; 2], |exponents| exponents.0);
    if let Some(given) = &table.exponents
        && exponents.iter().any(|&exponent| exponent <= 0.0)
    {
        return report.error(&given.span, "the `exponents` of `failure` must be above 0");
    }
    Some(LinkFailure { normal: normal?, shear: shear?, exponents })
}

fn six(key: &str, values: &Maybe<Numbers<6>>, report: &mut Report) -> Option<[f64; 6]> {
    match values {
        Some(values) if values.0.iter().any(|&value| value < 0.0) => {
            report.error(&values.span, format!("the values of `{key}` must not be negative"))
        }
        Some(values) => Some(values.0),
        None => Some([0.0; 6]),
    }
}
