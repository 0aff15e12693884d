//! Capsules and cylinders on faces of a shell, which they meet by their ends or rims, and by their surface the nodes of the faces: whether an edge of the mesh
//! may pass between all of these.

use super::points::Finder;
use crate::deck::contacts as words;
use crate::diagnostic::At;
use crate::math::Vec3;
use crate::math::convex::{ConvexShape, Spherocylinder};
use crate::model::places::place::Place;
use crate::model::report::Owner;
use crate::names::short;

/// Warns of each capsule and cylinder in `with` that is narrower than its own openings and those of the mesh of `part`, whose faces are these, half as
/// thick as given. On a flat sheet nothing passes where a contact of its free edges sees to its border.
pub fn warn_of_long_solids<'d>(
    finder: &mut Finder<'_, 'd>,
    owner: &Owner<'d>,
    contact: &'d words::Contact,
    part: &At<String>,
    (elements, half): (&[Vec<usize>], f64),
) {
    /// Decks have some digits only.
    const DIGITS: f64 = 1e-6;
    let x = |node: usize| finder.topology.x(node);
    let sides = |nodes: &Vec<usize>| -> f64 {
        let corners = if matches!(nodes.len(), 3 | 6) { 3 } else { 4 };
        let corners = corners.min(nodes.len());
        (0..corners).map(|k| (x(nodes[k]) - x(nodes[(k + 1) % corners])).norm()).fold(0.0, f64::max)
    };
    let longest = elements.iter().map(sides).fold(0.0, f64::max);
    let places: Vec<Vec3> = elements.iter().flatten().map(|&node| x(node)).collect();
    if has_contact_of_edges(finder, &part.value) && is_flat(&places) {
        return;
    }
    let names = contact.with.iter().flat_map(|list| &list.values);
    let leaves = names.filter_map(|at| finder.scene.names.place(at)).flat_map(|place| finder.scene.names.leaves(place));
    let bodies: Vec<usize> =
        leaves.filter_map(|leaf| if let Place::Body(body) = leaf { Some(body) } else { None }).collect();
    let between = contact.points.as_ref().map_or(0, |at| at.value);
    for body in bodies {
        let is_drawn = finder.scene.deck.bodies.get(body).is_some_and(|body| body.shape.is_some());
        let body = &finder.scene.bodies[body];
        let given = contact.radius.as_ref().map(|at| at.value);
        let Some((kind, length, radius)) = body.shape.as_convex().and_then(|shape| long_solid(&shape, given)) else {
            continue;
        };
        let width = 2.0 * (radius + half);
        let opening = length / (between + 1) as f64;
        if !is_drawn || opening.min(longest) <= width * (1.0 + DIGITS) || width <= 0.0 {
            continue;
        }
        let message = format!(
            "{} sees the side of {kind} `{}` by nodes of `{}` that are up to {} apart: an edge between these may pass into it, {} wide with \
             the thickness",
            owner.what,
            body.name,
            part.value,
            short(longest),
            short(width)
        );
        let points = (length / width - DIGITS).ceil() - 1.0;
        let border = format!("surface = {{ part = \"{}\", edges = true }}", part.value);
        let hint = format!(
            "give `points` = {points} or more, or a finer mesh; the border of a flat sheet is a contact of its own, {border}"
        );
        finder.report.warn(owner.span, message, hint);
    }
}

/// What a solid is called, its length and its radius, where it has such; a radius that the contact gives is that of the ends of a capsule, and of points of
/// rims.
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

/// True for places of one plane.
fn is_flat(places: &[Vec3]) -> bool {
    let Some(first) = places.first() else { return true };
    let farthest = |measure: &dyn Fn(&Vec3) -> f64| places.iter().max_by(|a, b| measure(a).total_cmp(&measure(b)));
    let Some(u) = farthest(&|x| (x - first).norm()).map(|x| x - first) else { return true };
    let Some(v) = farthest(&|x| (x - first).cross(&u).norm()).map(|x| x - first) else { return true };
    let Some(n) = u.cross(&v).try_normalize(0.0) else { return true };
    places.iter().all(|x| (x - first).dot(&n).abs() <= 1e-6 * u.norm())
}
