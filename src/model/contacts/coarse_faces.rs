//! Detects mesh edges missed by contact of capsules and cylinders on faces of a shell. Only their ends or rims touch the faces, and only
//! nodes touch their surface.

use super::mesh_edges::{MeshEdge, mesh_edges};
use super::points::Finder;
use super::sight::MOST_POINTS;
use crate::places::place::Place;
use crate::report::Owner;
use crate::values::vec3_or_zero;
use base::diagnostic::At;
use base::math::Vec3;
use base::math::convex::{ConvexShape, Spherocylinder};
use base::names::short;
use deck::contacts as words;

/// Decks have some digits only.
const DIGITS: f64 = 1e-6;
/// Depth into a fold without a warning, relative to the radius of the solid: meshes of curved surfaces are no more accurate.
const SHALLOW: f64 = 0.05;

/// Warns of each capsule and cylinder in `with` that may cross an edge of the mesh of `part` undetected. Such an edge is longer than the
/// solid is wide, belongs to the border or to a fold, and lies within reach of the solid. The faces are these, half as thick as given.
pub fn warn_of_long_solids<'d>(
    finder: &mut Finder<'_, 'd>,
    owner: &Owner<'d>,
    contact: &'d words::Contact,
    part: &At<String>,
    (elements, half): (&[Vec<usize>], f64),
) {
    let corners = |nodes: &Vec<usize>| {
        let count = if matches!(nodes.len(), 3 | 6) { 3 } else { 4 };
        nodes[..count.min(nodes.len())].to_vec()
    };
    let faces: Vec<Vec<usize>> = elements.iter().map(corners).collect();
    let mut edges = mesh_edges(&faces, |node| finder.topology.x(node));
    if has_contact_of_edges(finder, &part.value) {
        edges.retain(|edge| !edge.is_border);
    }
    let names = contact.with.iter().flat_map(|list| &list.values);
    let leaves = names.filter_map(|at| finder.scene.names.place(at)).flat_map(|place| finder.scene.names.leaves(place));
    let bodies: Vec<usize> =
        leaves.filter_map(|leaf| if let Place::Body(body) = leaf { Some(body) } else { None }).collect();
    let between = contact.points.as_ref().map_or(0, |at| at.value);
    for index in bodies {
        let is_drawn = finder.scene.deck.bodies.get(index).is_some_and(|body| body.shape.is_some());
        let body = &finder.scene.bodies[index];
        let given = contact.radius.as_ref().map(|at| at.value);
        let Some((kind, length, radius)) = body.shape.as_convex().and_then(|shape| long_solid(&shape, given)) else {
            continue;
        };
        let width = 2.0 * (radius + half);
        let opening = length / (between + 1) as f64;
        if !is_drawn || opening <= width * (1.0 + DIGITS) || width <= 0.0 {
            continue;
        }
        let center = finder.topology.x(body.node);
        let may_cross = |edge: &&MeshEdge| {
            edge.length() > width * (1.0 + DIGITS)
                && edge.sink(&center, opening) > SHALLOW * radius
                && edge.distance(&center) <= 0.5 * length + radius + way_of(finder, index, &edge.normal)
        };
        let longest = edges.iter().filter(may_cross).map(MeshEdge::length).fold(0.0, f64::max);
        if longest == 0.0 {
            continue;
        }
        let message = format!(
            "{} sees the side of {kind} `{}` by nodes of `{}` that are up to {} apart: an edge between these may enter it. The edge is {} wide \
             with the thickness",
            owner.what,
            body.name,
            part.value,
            short(longest),
            short(width)
        );
        let points = (length / width - DIGITS).ceil() - 1.0;
        let border = format!("surface = {{ part = \"{}\", edges = true }}", part.value);
        let points =
            if points <= MOST_POINTS as f64 { format!("`points` = {points} or more, or ") } else { String::new() };
        let hint = format!("give {points}a finer mesh; the border of a flat sheet needs a separate contact, {border}");
        finder.report.warn(owner.span, message, hint);
    }
}

/// The displacement of a body across `normal` by its velocity and gravity alone; infinite if anything else may move it.
fn way_of(finder: &Finder, index: usize, normal: &Vec3) -> f64 {
    let (scene, deck) = (finder.scene, finder.scene.deck);
    let Some(body) = deck.bodies.get(index) else { return f64::INFINITY };
    let name = &scene.bodies[index].name;
    let supports = deck.supports.iter().filter_map(|support| support.at.as_ref());
    let loads = deck.loads.iter().filter_map(|load| load.at.as_ref());
    let is_named = supports.chain(loads).flat_map(|list| &list.values).any(|at| at.value == *name);
    let is_shaken = deck.environment.as_ref().is_some_and(|at| !at.value.base_acceleration.is_empty());
    let is_held = !deck.joints.is_empty() || !deck.links.is_empty();
    if is_named || is_shaken || is_held || scene.stage.is_some() || !scene.analysis.has_inertia() {
        return f64::INFINITY;
    }
    let along = |v: Vec3| (v - normal.dot(&v) * normal).norm();
    let gravity = deck.environment.as_ref().map_or(Vec3::zeros(), |at| vec3_or_zero(&at.value.gravity));
    let time = scene.analysis.end_time - scene.analysis.begin;
    along(vec3_or_zero(&body.velocity)) * time + 0.5 * along(gravity) * time * time
}

/// Name, length and radius of a long solid. A radius given by the contact applies to the ends of a capsule and to points on rims.
fn long_solid(shape: &ConvexShape, given: Option<f64>) -> Option<(&'static str, f64, f64)> {
    match shape {
        ConvexShape::Spherocylinder(Spherocylinder { half, radius }) => {
            Some(("capsule", 2.0 * half.norm(), given.unwrap_or(*radius)))
        }
        ConvexShape::Cylinder(shape) => Some(("cylinder", 2.0 * shape.half(), shape.radius() + given.unwrap_or(0.0))),
        ConvexShape::Polyhedron(_) | ConvexShape::HalfSpace(_) => None,
    }
}

/// True where the free edges of a part are the surface of a contact.
fn has_contact_of_edges(finder: &Finder, part: &str) -> bool {
    let mut surfaces = finder.scene.deck.contacts.iter().filter_map(|contact| contact.surface.as_ref());
    surfaces.any(|table| {
        table.edges.as_ref().is_some_and(|at| at.value) && table.part.as_ref().is_some_and(|at| at.value == part)
    })
}
