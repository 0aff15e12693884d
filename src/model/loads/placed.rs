//! Forces and moments at a place on a beam between its nodes: shares of the nodes of the element, as its interpolation has them.

use crate::data::{Beam, Load, LoadOrigin, Node, Part, PartType};
use crate::loads::per_length::is_chain;
use crate::places::nodes::Topology;
use crate::places::place::Place;
use crate::report::{Owner, Report};
use crate::scene::Scene;
use crate::values::{flag, keys, vec3_or_zero};
use base::diagnostic::At;
use base::math::quadrature::lobatto;
use base::names::short;
use deck::loads as words;
use deck::words::Table;

/// A place beyond the end of a beam by less than this part of its length is its end.
const ROUNDING: f64 = 1e-9;

/// Reads a load with `distance`.
pub fn placed_load<'d>(
    scene: &Scene<'d>,
    load: &'d At<Table<words::Load>>,
    amplitude: Option<usize>,
    topology: &Topology,
    report: &mut Report<'d>,
) -> Vec<Load> {
    let owner = Owner::new("`[[loads]]`", &load.span);
    report.reject_unused("a load at a place on a beam", &keys!(load; at, total_force, projected, profile));
    if load.force.is_none() && load.moment.is_none() {
        report.error_with::<()>(owner.span, "this load is empty", "give it `force` or `moment`");
    }
    if let Some(at) = load.follower.as_ref().filter(|_| flag(&load.follower, false)) {
        report.error_with::<()>(&at.span, "only loads at nodes follow", "divide the beam, and name the point in `at`");
    }
    let distance = report.not_negative("distance", &load.distance, 0.0);
    let (force, moment) = (vec3_or_zero(&load.force), vec3_or_zero(&load.moment));
    let mut loads = Vec::new();
    let Some(names) = report.require_nodes(&owner, "part", &load.part) else { return loads };
    for name in &names.values {
        let Some(place) = scene.names.find(name, report) else { continue };
        let index = match place {
            Place::Part(part) if scene.parts.entry(part).is_some_and(|entry| entry.rigid_elements.is_some()) => {
                let message = format!("`{}` belongs to a rigid body, which has no `distance`", name.value);
                report.error_with::<()>(&name.span, message, "name a point of the body in `at`");
                continue;
            }
            Place::Part(part) if part.kind.has_sections() => scene.parts.entry(part).map(|entry| entry.range.start),
            _ => {
                let message = format!("`distance` is one along a beam, and `{}` is {}", name.value, place.kind());
                report.error_with::<()>(&name.span, message, "name an entry of [[beams]], or remove `distance`");
                continue;
            }
        };
        let beam = index.and_then(|index| Some((index, Beam::of(scene.parts.list.get(index)?)?)));
        let Some((part, beam)) = beam.filter(|(_, beam)| !beam.elements.is_empty()) else { continue };
        if let Some((message, hint)) = unfit(beam, &scene.parts.list[part], &name.value) {
            report.error_with::<()>(&name.span, message, hint);
            continue;
        }
        match shares(beam, distance, &topology.list) {
            Ok((element, shares)) => loads.extend(shares.into_iter().map(|(node, share)| Load {
                node,
                force: force * share,
                moment: moment * share,
                follower: false,
                amplitude,
                origin: Some(LoadOrigin::Element(part, element)),
                moment_counts: true,
            })),
            Err(length) => {
                let place = load.distance.as_ref().map_or(owner.span, |at| &at.span);
                let message = format!("`distance` lies beyond beam `{}`, which is {} long", name.value, short(length));
                report.error_with::<()>(place, message, format!("give {} or less", short(length)));
            }
        }
    }
    loads
}

/// The reason why a place on a beam has no shares of nodes, and the remedy. A concentrated load bends an element by cubic functions, which
/// elements of lower order lack.
fn unfit(beam: &Beam, part: &Part, name: &str) -> Option<(String, &'static str)> {
    if !is_chain(part) {
        let message = format!("`distance` goes along a line, and the elements of `{name}` do not follow each other");
        return Some((message, "order the segments of the group from end to end, or name a node in `at`"));
    }
    let message = || format!("`distance` needs elements of order 3 or 4, and `{name}` has order {}", beam.order);
    (beam.order < 3)
        .then(|| (message(), "give the beam `order = 3`, or divide its path there and name the point in `at`"))
}

/// The element at a distance from the start of a beam, and the share of each of its nodes in what acts there; the length of the beam where it
/// is shorter.
fn shares(beam: &Beam, distance: f64, nodes: &[Node]) -> Result<(usize, Vec<(usize, f64)>), f64> {
    let length = |element: usize| {
        let ids = &beam.elements[element].nodes;
        (nodes[ids[beam.order]].x - nodes[ids[0]].x).norm()
    };
    let whole: f64 = (0..beam.elements.len()).map(length).sum();
    if distance > whole * (1.0 + ROUNDING) {
        return Err(whole);
    }
    let (mut element, mut begin) = (0, 0.0);
    while element + 1 < beam.elements.len() && begin + length(element) < distance {
        begin += length(element);
        element += 1;
    }
    let xi = (2.0 * (distance - begin) / length(element) - 1.0).clamp(-1.0, 1.0);
    let (places, _) = lobatto(beam.order + 1);
    let share = |i: usize| {
        let others = places.iter().enumerate().filter(|(j, _)| *j != i);
        others.map(|(_, other)| (xi - other) / (places[i] - other)).product()
    };
    Ok((element, (0..=beam.order).map(|i| (beam.elements[element].nodes[i], share(i))).collect()))
}
