//! The surface of `[[contacts]]` in the frame of the node that carries it.

use super::nodes::Topology;
use super::report::{Owner, Report};
use super::scene::Scene;
use crate::deck::contacts as words;
use crate::deck::words::kinds::OneOf;
use crate::diagnostic::At;
use crate::elements::contact::Surface;

/// The node that carries a surface, and the surface in its frame.
pub(super) fn read_surface<'d>(
    name: &str,
    table: &'d At<OneOf<words::Surface>>,
    scene: &Scene<'d>,
    topology: &mut Topology,
    report: &mut Report<'d>,
) -> Option<(usize, Surface)> {
    let owner = Owner::new(format!("the surface of contact `{name}`"), &table.span);
    let kind = report.require(&owner, "shape", &table.kind)?.value;
    let body = match &table.body {
        Some(name) => scene.names.body(name, report).map(|body| Some(scene.bodies[body].node)),
        None if report.is_spoiled(owner.span, "body") => None,
        None => Some(None),
    };
    let center = body.flatten().map(|body| topology.x(body));
    let what = format!("a {}", kind.word);
    let placed = report.read(&owner, &what, &table.values, kind, |given| (kind.make)(given, center));
    let (body, placed) = (body?, placed?);
    let node = body.unwrap_or_else(|| {
        let node = topology.add(format!("{name}.surface"), false, placed.center);
        (0..6).for_each(|dof| topology.restrain(node, dof, None));
        node
    });
    Some((node, Surface { center: placed.center - topology.x(node), axes: placed.axes, shape: placed.shape }))
}
