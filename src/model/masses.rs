//! `[[masses]]`: point masses.

use super::bodies::read_inertia;
use super::data::Mass;
use super::places::nodes::Nodes;
use super::report::{Owner, Report};
use super::scene::{Reach, Scene};
use base::math::Mat3;

/// Reads `[[masses]]`: point masses on nodes.
pub(super) fn masses<'d>(scene: &Scene<'d>, nodes: &mut Nodes, report: &mut Report<'d>) -> Vec<Mass> {
    let mut masses = Vec::new();
    for table in &scene.deck.masses {
        let owner = Owner::new("`[[masses]]`", &table.span);
        let spots = scene.spots(&owner, "at", &table.at, Reach::Nodes, report);
        let mass = report.require_positive(&owner, "mass", &table.mass);
        let inertia = match &table.inertia {
            Some(values) => read_inertia(values, report),
            None => Some(Mat3::zeros()),
        };
        let (Some(mass), Some(inertia)) = (mass, inertia) else { continue };
        for spot in spots {
            nodes.connect(spot.node, table.inertia.is_some());
            masses.push(Mass { node: spot.node, mass, inertia });
        }
    }
    masses
}
