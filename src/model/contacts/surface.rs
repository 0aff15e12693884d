//! The surface of `[[contacts]]` in the frame of the node that carries it.

use crate::places::nodes::Topology;
use crate::report::{Owner, Report};
use crate::scene::Scene;
use base::diagnostic::At;
use base::math::Vec3;
use base::math::convex::{ConvexShape, Spherocylinder};
use deck::contacts as words;
use deck::words::kinds::OneOf;
use mechanics::elements::contact::Surface;
use mechanics::solids::Touching;

/// The node that carries a surface, and the surface in its frame.
pub fn read_surface<'d>(
    name: &str,
    table: &'d At<OneOf<words::Surface>>,
    scene: &Scene<'d>,
    topology: &mut Topology,
    report: &mut Report<'d>,
) -> Option<(usize, Surface)> {
    let owner = Owner::new(format!("the surface of contact `{name}`"), &table.span);
    if let Some(edges) = &table.edges {
        let message = "`edges` is of a surface that is the `part` of a shell";
        return report.error_with(&edges.span, message, "remove `edges`, or name a `part`");
    }
    if let (None, Some(body), false) = (&table.kind, &table.body, report.is_spoiled(owner.span, "shape")) {
        return shape_of_body(body, table, scene, report);
    }
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

/// The surface of a body by the shape that it has itself.
fn shape_of_body<'d>(
    name: &'d At<String>,
    table: &'d At<OneOf<words::Surface>>,
    scene: &Scene<'d>,
    report: &mut Report<'d>,
) -> Option<(usize, Surface)> {
    let index = scene.names.body(name, report)?;
    let body = &scene.bodies[index];
    for place in table.values.places() {
        report.error::<()>(
            place,
            "this is a dimension of shapes: give `shape`, or leave it out for the shape of the body",
        );
    }
    let is_drawn = scene.deck.bodies.get(index).is_some_and(|body| body.shape.is_some());
    let surface = match body.shape.touching(0) {
        _ if !is_drawn => None,
        Touching::Ball(radius) => {
            let sphere = ConvexShape::Spherocylinder(Spherocylinder { half: Vec3::zeros(), radius });
            Some(Surface::of_convex(&sphere, 0.0))
        }
        Touching::Points { .. } | Touching::Nodes => {
            body.shape.as_convex().map(|shape| Surface::of_convex(&shape, 0.0))
        }
    };
    let Some(surface) = surface else {
        let message = format!(
            "body `{}` is no box, hull, cylinder, capsule or sphere whose surface others could touch",
            name.value
        );
        return report.error_with(&name.span, message, "give the surface a `shape`");
    };
    Some((body.node, surface))
}
