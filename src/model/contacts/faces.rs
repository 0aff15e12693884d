//! Contacts of faces of shells, of beams by their radius, and of balls among themselves.

use crate::contacts::coarse_faces::warn_of_long_solids;
use crate::contacts::points::{Finder, SurfaceLines};
use crate::data::{CarriedSurface, Contact, FacetSurface, TouchedSurface};
use crate::places::place::Place;
use crate::report::{Owner, Report};
use crate::scene::Scene;
use crate::values::{keys, span};
use base::diagnostic::At;
use base::math::curved_faces;
use deck::contacts as words;
use deck::parts::PartIndex;
use deck::words::kinds::OneOf;
use mechanics::elements::contact::{ContactPoint, ConvexBody, Facet, FacetTouchers, Surface, SurfaceShape, Toucher};
use mechanics::solids::Touching;

/// The word for a shell that touches itself.
pub const ITSELF: &str = "itself";

/// True where a contact is one of faces, or of balls among themselves.
pub fn is_of_facets(contact: &words::Contact) -> bool {
    contact.among.is_some() || contact.surface.as_ref().is_some_and(|table| table.part.is_some())
}

/// The contact as far as its law does not matter; its size is that of the law's reader.
pub fn read_facets<'d>(
    finder: &mut Finder<'_, 'd>,
    owner: &Owner<'d>,
    name: &str,
    contact: &'d words::Contact,
) -> Option<Contact> {
    if finder.scene.analysis.has_modes() {
        let hint = "leave it out with `stages`, or rest what touches on supports";
        return finder.report.error_with(owner.span, "modes do not know contacts of faces or balls", hint);
    }
    let (surface, points) = match (&contact.among, &contact.surface) {
        (Some(among), _) => balls(finder, owner, contact, among)?,
        (None, Some(table)) => faces(finder, owner, contact, table)?,
        (None, None) => return None,
    };
    let touchers = std::mem::take(&mut finder.sight.touchers);
    let surface = TouchedSurface::Facets(surface);
    let (law, chosen, joined, convex) = (None, None, Vec::new(), std::mem::take(&mut finder.convex));
    Some(Contact { name: name.to_owned(), surface, points, convex, joined, touchers, law, size: 0.0, chosen })
}

/// The faces of a part and the points that touch them.
fn faces<'d>(
    finder: &mut Finder<'_, 'd>,
    owner: &Owner<'d>,
    contact: &'d words::Contact,
    table: &'d At<OneOf<words::Surface>>,
) -> Option<(FacetSurface, Vec<ContactPoint>)> {
    let part = table.part.as_ref()?;
    let Sides { place, surface, half, lines } = sides(finder, contact, table)?;
    let scene = finder.scene;
    let is_line = lines != SurfaceLines::None;
    let is_of_edges = lines == SurfaceLines::FreeEdges;
    let elements = if is_of_edges { finder.free_edges(surface) } else { scene.parts.elements(surface) };
    let facets = facets_of(&elements, half, is_line);
    if facets.is_empty() && is_of_edges && !scene.parts.elements(surface).is_empty() {
        let message = format!("`{}` is closed and has no free edges", part.value);
        return finder.report.error_with(&part.span, message, "remove `edges`");
    }
    if facets.is_empty() {
        // The part has no faces because of errors already reported.
        return None;
    }
    let names = finder.report.require_nodes(owner, "with", &contact.with)?;
    let (touchers, solids, corners, back) = (FacetTouchers::Others, Vec::new(), Vec::new(), Vec::new());
    let mut faces = FacetSurface { part: part.value.clone(), facets, is_of_edges, touchers, solids, corners, back };
    if names.values.iter().any(|at| at.value == ITSELF) {
        if let [_, _, ..] = names.values[..] {
            let hint = "add a separate contact for the others that touch it";
            return finder.report.error_with(&names.span, "`itself` stands alone in `with`", hint);
        }
        finder.report.reject_unused("a part that touches itself", &keys!(contact; points));
        faces.touchers = FacetTouchers::Itself;
        let radius = contact.radius.as_ref().map_or(half, |at| at.value);
        if is_line {
            let lines = finder.lines_at(&elements, radius, contact);
            return Some((faces, lines));
        }
        let points = finder.points_at(&own_nodes(&faces.facets), radius, contact);
        return Some((faces, points));
    }
    if let Some(at) = names.values.iter().find(|at| scene.names.place(&at.value) == Some(place)) {
        let message = format!("`{}` is the part whose surface it would touch", at.value);
        let hint = format!("for a part that touches itself, give with = \"{ITSELF}\"");
        return finder.report.error_with(&at.span, message, hint);
    }
    // Nodes attached to the body of rigid faces do not touch these.
    let root = finder.topology.root(faces.facets[0].nodes[0]);
    let is_rigid = faces.facets.iter().flat_map(Facet::nodes).all(|&node| finder.topology.root(node) == root);
    finder.on_lines = lines;
    let points = finder.touching(owner, contact, is_rigid.then_some(root))?;
    faces.solids = solids_of(scene, &names.values, contact.radius.as_ref().map_or(0.0, |at| at.value), is_line);
    if !is_line {
        faces.corners = corners_of(&faces.solids, &points, finder);
        warn_of_long_solids(finder, owner, contact, part, (&elements, half));
    }
    if !faces.solids.is_empty() {
        faces.back = finder.points_at(&own_nodes(&faces.facets), half, contact);
    }
    Some((faces, points))
}

/// For each solid, the numbers of the points at its corners.
fn corners_of(solids: &[CarriedSurface], points: &[ContactPoint], finder: &Finder) -> Vec<Vec<usize>> {
    let root = |node: usize| finder.topology.root(node);
    let is_corner =
        |point: &ContactPoint, node: usize| point.count == 1 && !point.is_line() && root(point.nodes[0]) == root(node);
    let of = |node: usize| (0..points.len()).filter(|&e| is_corner(&points[e], node)).collect();
    solids.iter().map(|carried| of(carried.node)).collect()
}

/// The facets of elements by their nodes, half as thick as given: lines from node to node, or faces.
fn facets_of(elements: &[Vec<usize>], half: f64, is_line: bool) -> Vec<Facet> {
    let facet = |nodes: &[usize], corners: &[usize]| {
        let corners: Vec<usize> = corners.iter().map(|&k| nodes[k]).collect();
        Facet::new(&corners, half)
    };
    let of_element = |nodes: &Vec<usize>| -> Vec<Facet> {
        match is_line {
            true => nodes.windows(2).map(|ends| Facet::new(ends, half)).collect(),
            false => curved_faces::facets(nodes.len()).iter().map(|corners| facet(nodes, corners)).collect(),
        }
    };
    elements.iter().flat_map(of_element).collect()
}

/// The part that is a surface.
struct Sides {
    place: Place,
    surface: PartIndex,
    /// Half its thickness, or its radius.
    half: f64,
    /// The lines in the surface.
    lines: SurfaceLines,
}

/// Finds the part that is a surface, and how thick it is.
fn sides<'d>(
    finder: &mut Finder<'_, 'd>,
    contact: &'d words::Contact,
    table: &'d At<OneOf<words::Surface>>,
) -> Option<Sides> {
    let part = table.part.as_ref()?;
    let what = "a surface that is a part";
    finder.report.reject_unused(what, &[("shape", span(&table.kind)), ("body", span(&table.body))]);
    let scene = finder.scene;
    let place = scene.names.find(part, finder.report)?;
    let (surface, line) = (scene.names.surface_of(place), scene.names.line_of(place));
    let Some(surface) = surface.or(line) else {
        let message = format!("`{}` is {}, and has no surface", part.value, place.kind());
        let hint = "a surface is a `part` that is a shell, a beam or a bar, or a `shape`";
        return finder.report.error_with(&part.span, message, hint);
    };
    let lines = lines_of_surface(part, table, line.is_some(), finder.report)?;
    let radius_place = table.values.place("radius").filter(|_| lines != SurfaceLines::None);
    for place in table.values.places().filter(|&place| Some(place) != radius_place) {
        finder.report.error::<()>(place, "this is a dimension of shapes, and does not apply to a part");
    }
    let half = match radius_place {
        Some(_) => table.values.numbers("radius").first().copied().unwrap_or(0.0),
        None => finder.contact_radius(surface),
    };
    if lines != SurfaceLines::None && half <= 0.0 {
        let edges = if lines == SurfaceLines::FreeEdges { ", edges = true" } else { "" };
        let hint = format!("surface = {{ part = \"{}\"{edges}, radius = ... }}", part.value);
        let message = match radius_place {
            Some(_) => "`radius` must be above zero".to_owned(),
            None => format!("`{}` is {} without a radius", part.value, Place::Part(surface).kind()),
        };
        return finder.report.error_with(radius_place.unwrap_or(&part.span), message, hint);
    }
    let friction = contact.friction.as_ref().filter(|_| contact.coefficients().sticking > 0.0);
    if let Some(friction) = friction.filter(|_| line.is_some() && !surface.kind.has_sections()) {
        let hint = "make it a beam, or let a beam be the surface and name the bar in `with`";
        let message = "nothing rubs on a bar, which has no rotations to take a moment";
        return finder.report.error_with(&friction.span, message, hint);
    }
    Some(Sides { place, surface, half, lines })
}

/// The lines of a part used as a surface; only shells have `edges`.
fn lines_of_surface(
    part: &At<String>,
    table: &At<OneOf<words::Surface>>,
    is_line: bool,
    report: &mut Report,
) -> Option<SurfaceLines> {
    let edges = table.edges.as_ref().filter(|at| at.value);
    match (is_line, edges) {
        (true, Some(edges)) => {
            let message = format!("`edges` is of shells, and `{}` is none: it is round as a whole", part.value);
            report.error_with(&edges.span, message, "leave `edges` out")
        }
        (true, None) => Some(SurfaceLines::Axes),
        (false, Some(_)) => Some(SurfaceLines::FreeEdges),
        (false, None) => Some(SurfaceLines::None),
    }
}

/// The surfaces of all boxes, hulls, cylinders and capsules in a list; against lines without capsules, which are lines themselves there.
fn solids_of(scene: &Scene, names: &[At<String>], inflated: f64, lines: bool) -> Vec<CarriedSurface> {
    let places = names.iter().filter_map(|at| scene.names.place(&at.value));
    let leaves = places.flat_map(|place| scene.names.leaves(place));
    let bodies = leaves.filter_map(|place| if let Place::Body(body) = place { Some(body) } else { None });
    let solids = bodies.filter_map(|body| solid_of(scene, body, inflated));
    solids.filter(|carried| !lines || !matches!(carried.surface.shape, SurfaceShape::Capsule(_))).collect()
}

/// All nodes of facets, each once.
fn own_nodes(facets: &[Facet]) -> Vec<usize> {
    let mut nodes: Vec<usize> = facets.iter().flat_map(Facet::nodes).copied().collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// The surface of a body that is drawn as a box, a hull, a cylinder or a capsule.
fn solid_of(scene: &Scene, body: usize, inflated: f64) -> Option<CarriedSurface> {
    scene.deck.bodies.get(body)?.shape.as_ref()?;
    let body = &scene.bodies[body];
    let surface = Surface::of_convex(&body.shape.as_convex()?, inflated);
    Some(CarriedSurface { node: body.node, surface })
}

/// Balls, boxes, hulls, cylinders and capsules among themselves.
fn balls<'d>(
    finder: &mut Finder<'_, 'd>,
    owner: &Owner<'d>,
    contact: &'d words::Contact,
    among: &'d At<deck::words::Names>,
) -> Option<(FacetSurface, Vec<ContactPoint>)> {
    let what = "a contact of bodies `among` themselves";
    let keys = keys!(contact; surface, with, points);
    finder.report.reject_unused(what, &keys);
    let given = contact.radius.as_ref().map(|_| finder.report.not_negative("radius", &contact.radius, 0.0));
    let Members { mut balls, mut convex, has_tubes } = members(finder, among, given)?;
    finder.sight.touchers.extend(has_tubes.then_some(Toucher::Tube));
    balls.sort_unstable_by_key(|(node, _)| *node);
    balls.dedup_by_key(|(node, _)| *node);
    convex.sort_unstable_by_key(|one| one.node);
    convex.dedup_by_key(|one| one.node);
    if balls.len() + convex.len() < 2 {
        let message = format!("{} has fewer than two bodies or balls `among` which anything could touch", owner.what);
        return finder.report.error_with(&among.span, message, "name another body with a `shape`");
    }
    finder.convex = convex;
    finder.inflate(given.unwrap_or(0.0), contact)?;
    let mut points = Vec::new();
    for &(node, radius) in &balls {
        points.extend(finder.points_at(&[node], radius, contact));
    }
    let facet = |point: &ContactPoint| Facet::ball(point.nodes[0], point.radius, point.rolling_radius);
    let facets = points.iter().map(facet).collect();
    let touchers = FacetTouchers::Among;
    let carried = |one: &ConvexBody| CarriedSurface { node: one.node, surface: Surface::of_convex(&one.shape, 0.0) };
    let solids = if points.is_empty() { Vec::new() } else { finder.convex.iter().map(carried).collect() };
    let back = if solids.is_empty() { Vec::new() } else { points.clone() };
    Some((
        FacetSurface { part: String::new(), facets, is_of_edges: false, touchers, solids, corners: Vec::new(), back },
        points,
    ))
}

/// The bodies in contact among themselves.
#[derive(Default)]
struct Members {
    /// Nodes and radii of balls.
    balls: Vec<(usize, f64)>,
    /// Boxes, hulls, cylinders and capsules.
    convex: Vec<ConvexBody>,
    /// True where some of these cylinders have a hole.
    has_tubes: bool,
}

/// True for a body with an unreadable shape; the error is already reported.
fn is_unread(scene: &Scene, place: Place) -> bool {
    let Place::Body(body) = place else { return false };
    let has_shape = scene.deck.bodies.get(body).is_some_and(|body| body.shape.is_some());
    has_shape && matches!(scene.bodies[body].shape.touching(0), Touching::Nodes)
}

/// The bodies and points in a list; `None` if an entry is neither.
fn members<'d>(finder: &mut Finder<'_, 'd>, among: &'d At<deck::words::Names>, given: Option<f64>) -> Option<Members> {
    let (scene, report) = (finder.scene, &mut *finder.report);
    let (mut members, mut sound) = (Members::default(), true);
    for at in &among.values {
        let place = scene.names.find(at, report)?;
        for leaf in scene.names.leaves(place) {
            if let Some(one) = convex_of(scene, leaf) {
                members.convex.push(one);
                members.has_tubes |= has_hole(scene, leaf);
                continue;
            }
            let radius = given.or_else(|| radius_of(scene, leaf)).filter(|radius| *radius > 0.0);
            let nodes = match leaf {
                Place::Body(body) => vec![scene.bodies.get(body)?.node],
                Place::Part(_) | Place::Edge(..) | Place::Joint(_) | Place::Drift(_) => Vec::new(),
                _ => scene.nodes_of(leaf),
            };
            match radius {
                Some(radius) if !nodes.is_empty() => members.balls.extend(nodes.into_iter().map(|node| (node, radius))),
                _ if is_unread(scene, leaf) => {
                    sound = false;
                    break;
                }
                _ => {
                    refuse_ball(report, at, leaf, nodes.is_empty());
                    sound = false;
                    break;
                }
            }
        }
    }
    sound.then_some(members)
}

/// A body that is drawn as a box, a hull, a cylinder or a capsule.
fn convex_of(scene: &Scene, place: Place) -> Option<ConvexBody> {
    let Place::Body(body) = place else { return None };
    scene.deck.bodies.get(body)?.shape.as_ref()?;
    let body = &scene.bodies[body];
    Some(ConvexBody { node: body.node, shape: body.shape.as_convex()? })
}

/// True for a body with a hole right through.
fn has_hole(scene: &Scene, place: Place) -> bool {
    matches!(place, Place::Body(body) if scene.bodies.get(body).is_some_and(|body| body.shape.has_hole()))
}

/// The radius of a body that is drawn as a sphere.
fn radius_of(scene: &Scene, place: Place) -> Option<f64> {
    let Place::Body(body) = place else { return None };
    scene.deck.bodies.get(body)?.shape.as_ref()?;
    match scene.bodies[body].shape.touching(0) {
        Touching::Ball(radius) => Some(radius),
        Touching::Nodes | Touching::Points { .. } => None,
    }
}

fn refuse_ball(report: &mut Report, at: &At<String>, leaf: Place, has_no_nodes: bool) {
    let name = &at.value;
    match has_no_nodes {
        true => {
            let message =
                format!("`among` can be bodies, points and sets of them, and `{name}` is or holds {}", leaf.kind());
            report.error::<()>(&at.span, message);
        }
        false => {
            let message = format!("`{name}` is or holds {} without a radius", leaf.kind());
            report.error_with::<()>(
                &at.span,
                message,
                "draw bodies as spheres, boxes, hulls, cylinders or capsules, or give `radius`",
            );
        }
    }
}
