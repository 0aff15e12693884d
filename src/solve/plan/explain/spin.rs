//! The spin of bodies and nodes at t = 0 in words, where complex modes and responses depend on it.

use super::explanation::Explanation;
use super::quantities::{along, symbol};
use crate::tolerances::spin_in_words::ALIKE;
use base::math::Vec3;
use base::names::{joined, short};
use base::quantities::{Unit, UnitSystem};
use model::{Body, Model};

/// Spins that are listed one by one.
const LISTED: usize = 6;

/// The bodies of one spin, and the number of all other nodes that have it.
struct Group<'m> {
    omega: Vec3,
    bodies: Vec<&'m str>,
    others: usize,
}

/// Adds a line for each spin, with its course over speeds or frequencies.
pub fn explain(text: &mut Explanation, model: &Model) {
    if !model.analysis.damps_modes() {
        return;
    }
    let of_speed = symbol(Unit::AngularVelocity, model.output.units.as_deref().and_then(UnitSystem::find));
    let reference = model.loading.unbalanced_node().map(|node| model.nodes[node].omega.norm());
    let course = match model.analysis.speeds() {
        [first, .., last] => {
            format!("; all in proportion from {} to {}{of_speed} of the fastest", short(*first), short(*last))
        }
        _ if reference.is_none() && model.analysis.response().is_some() => " at all frequencies".to_owned(),
        _ => String::new(),
    };
    let groups = groups(model);
    for Group { omega, bodies, others } in groups.iter().take(LISTED) {
        let speed = omega.norm();
        let at = match reference {
            Some(reference) => format!("{} times the angular frequency", short(speed / reference)),
            None => format!("{}{of_speed}", short(speed)),
        };
        let others = match others {
            0 => None,
            1 => Some("1 node".to_owned()),
            _ => Some(format!("{others} nodes")),
        };
        let names: Vec<&str> = bodies.iter().copied().chain(others.as_deref()).collect();
        text.add("spin", format!("{}: {at} about {}{course}", joined(&names), along(&(omega / speed))));
    }
    if let Some(more) = groups.len().checked_sub(LISTED).filter(|more| *more > 0) {
        text.add("spin", format!("and {more} more angular velocities"));
    }
}

/// The spins in the order of the nodes.
fn groups(model: &Model) -> Vec<Group<'_>> {
    let mut groups: Vec<Group> = Vec::new();
    for (index, node) in model.nodes.iter().enumerate().filter(|(_, node)| node.omega != Vec3::zeros()) {
        let is_alike = |group: &Group| (group.omega - node.omega).norm() <= ALIKE * node.omega.norm();
        let place = groups.iter().position(is_alike).unwrap_or_else(|| {
            groups.push(Group { omega: node.omega, bodies: Vec::new(), others: 0 });
            groups.len() - 1
        });
        match Body::at(&model.bodies, index) {
            Some(body) => groups[place].bodies.push(&model.bodies[body].name),
            None => groups[place].others += 1,
        }
    }
    groups
}
