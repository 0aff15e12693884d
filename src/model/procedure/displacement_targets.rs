//! Target displacements, for `stop` of `[analysis]` and `when` of `[[expect]]`.

use crate::data::DisplacementTarget;
use crate::places::nodes::Topology;
use crate::places::place::Place;
use crate::report::{Owner, Report};
use crate::scene::Scene;
use crate::values::flag;
use base::diagnostic::At;
use deck::analysis as words;
use deck::words::Table;

/// Reads a target displacement for the end of a step; it must be an unknown.
pub fn displacement_target<'d>(
    what: &str,
    target: &'d At<Table<words::DisplacementTarget>>,
    scene: &Scene<'d>,
    topology: &Topology,
    report: &mut Report<'d>,
) -> Option<DisplacementTarget> {
    let owner = Owner::new(what, &target.span);
    let table: &'d words::DisplacementTarget = &target.value;
    let name = report.require(&owner, "at", &table.at);
    let quantity = report.require(&owner, "quantity", &table.quantity);
    let value = report.require(&owner, "value", &table.value);
    let pass = report.count("pass", &table.pass, 1);
    let name = name?;
    let node = match scene.place_or_node(name) {
        Some(Place::Point(node)) => node,
        Some(Place::Body(body)) => scene.names.body_node(body),
        Some(place) => {
            let message = format!("{what} takes a point or body, and `{}` is {}", name.value, place.kind());
            return report.error(&name.span, message);
        }
        None => return scene.names.unknown("point or body", name, || scene.names.known(|_| true), report),
    };
    let (quantity, value) = (quantity?, value?);
    let (dof, word) = match quantity.value {
        words::Displacement::Ux => (0, "ux"),
        words::Displacement::Uy => (1, "uy"),
        words::Displacement::Uz => (2, "uz"),
    };
    if let Some(master) = topology.master_in(node, dof) {
        let master = topology.label(master);
        let message = format!("`{}` moves with `{master}`", name.value);
        return report.error_with(&name.span, message, format!("{what} needs an independent node: name `{master}`"));
    }
    if topology.restraint(node, dof).is_some() {
        let message = format!("{word} of `{}` is prescribed by a support", name.value);
        return report.error_with(&quantity.span, message, "name a direction that is free");
    }
    if topology.is_complete() && !topology.is_taken(node, dof) {
        let message = format!("nothing acts on `{}` in direction {word}", name.value);
        return report.error_with(&quantity.span, message, format!("{what} needs a displacement that is an unknown"));
    }
    if value.value == 0.0 {
        return report.error_with(
            &value.span,
            format!("{word} is zero at the start already"),
            "give a value that it reaches later",
        );
    }
    let place = [quantity.span.start, quantity.span.end];
    let required = flag(&table.required, true);
    Some(DisplacementTarget { node, dof, value: value.value, pass, required, place })
}
