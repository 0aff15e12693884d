//! `[[contacts]]`: surfaces, the points in contact with them, and the laws.

pub mod coarse_faces;
pub mod faces;
pub mod friction;
pub mod law;
pub mod lines;
pub mod mesh_edges;
pub mod method;
pub mod opposite;
pub mod points;
pub mod sight;
pub mod stiffness;
pub mod surface;

use crate::contacts::faces::{is_of_facets, read_facets};
use crate::contacts::law::LawReader;
use crate::contacts::method::is_augmented;
use crate::contacts::opposite::Opposite;
use crate::contacts::points::{Finder, OnConvex};
use crate::contacts::surface::read_surface;
use crate::data::{Body, CarriedSurface, Contact, FacetSurface, Joint, Mass, TouchedSurface};
use crate::places::nodes::Topology;
use crate::report::{Owner, Report};
use crate::scene::Scene;
use crate::values::keys;
use base::math::Vec3;
use base::names::short;
use deck::contacts as words;
use mechanics::elements::contact::restitution;
use mechanics::elements::contact::{
    ContactPoint, ConvexBody, Facet, FacetTouchers, Surface, SurfaceShape, Toucher, convex, least_gap, pair_gap,
};
use mechanics::state::Node;
use std::cell::Cell;
use std::collections::{BTreeSet, HashMap};

/// Reads `[[contacts]]`, after all constraints: nodes that depend on the surface's own body do not touch it, and
/// restrained nodes have no mass.
pub fn contacts<'d>(
    scene: &Scene<'d>,
    masses: &[Mass],
    joints: &[Joint],
    gravity: Vec3,
    topology: &mut Topology,
    report: &mut Report<'d>,
) -> Vec<Contact> {
    if scene.deck.contacts.is_empty() {
        return Vec::new();
    }
    let at_nodes = masses_at_nodes(scene, masses, topology);
    let mut point_masses = HashMap::new();
    masses.iter().for_each(|mass| *point_masses.entry(mass.node).or_insert(0.0) += mass.mass);
    let setting = LawSetting {
        scene,
        point_masses: &point_masses,
        joints,
        at_nodes: &at_nodes,
        gravity,
        extent: Cell::new((0, 0.0)),
    };
    let mut contacts = Vec::new();
    for (index, contact) in scene.deck.contacts.iter().enumerate() {
        let (name, owner) = report.named(("contact", "contacts", index), contact.name.as_ref(), &contact.span);
        let of = if is_of_facets(contact) { of_facets } else { of_shape };
        contacts.extend(of(&setting, &owner, &name, contact, topology, report));
    }
    contacts
}

/// The data shared by the laws of all contacts.
struct LawSetting<'a, 'd> {
    scene: &'a Scene<'d>,
    point_masses: &'a HashMap<usize, f64>,
    joints: &'a [Joint],
    at_nodes: &'a [f64],
    gravity: Vec3,
    /// The number of nodes so far, and their extent.
    extent: Cell<(usize, f64)>,
}

impl LawSetting<'_, '_> {
    /// The extent of the scene from its first node; each node is looked at once.
    fn extent(&self, topology: &Topology) -> f64 {
        let (count, known) = self.extent.get();
        let first = topology.x(0);
        let extent = topology.list[count..].iter().map(|node| (node.x - first).norm()).fold(known, f64::max);
        self.extent.set((topology.list.len(), extent));
        extent
    }
}

/// A contact with a shape.
fn of_shape<'d>(
    setting: &LawSetting<'_, 'd>,
    owner: &Owner<'d>,
    name: &str,
    contact: &'d words::Contact,
    topology: &mut Topology,
    report: &mut Report<'d>,
) -> Option<Contact> {
    let &LawSetting { scene, point_masses, at_nodes, gravity, .. } = setting;
    let surface = report.require(owner, "surface", &contact.surface);
    let surface = surface.and_then(|table| read_surface(name, table, scene, topology, report));
    let carrier = surface.as_ref().map(|(node, _)| *node);
    let by_points = is_augmented(contact);
    let on_convex = surface.as_ref().and_then(|(node, surface)| in_full(*node, surface, by_points));
    let mut finder = Finder { on_convex, ..Finder::new(scene, topology, report) };
    let points = finder.touching(owner, contact, carrier);
    let (solids, mut sight) = (finder.convex, finder.sight);
    let is_carried_by_tube =
        |node: usize| Body::at(&scene.bodies, node).is_some_and(|body| scene.bodies[body].shape.has_hole());
    let is_tube = |(node, surface): &(usize, Surface)| {
        matches!(surface.shape, SurfaceShape::Cylinder(_)) && is_carried_by_tube(*node)
    };
    sight.touchers.extend(surface.as_ref().is_some_and(is_tube).then_some(Toucher::Tube));
    let is_zone = is_zone(owner, contact, setting.scene.analysis.has_inertia(), report);
    let (Some((node, surface)), Some(points), Some(is_zone)) = (surface, points, is_zone) else { return None };
    let between = contact.points.as_ref().map(|at| at.value);
    sight.check(owner, (between, by_points), &surface, report);
    let (mut law, mut chosen) = (None, None);
    let extent = setting.extent(topology);
    let chooser = LawReader { scene, point_masses, at_nodes, gravity, extent, topology: &*topology };
    let opposite = Opposite::Shape(node, &surface);
    let size = chooser.size(opposite, (&points, &solids));
    if !is_zone {
        let (found, reason) = chooser.contact_law(owner, contact, opposite, (&points, &solids), report)?;
        let at_rest = chooser.depth_at_rest(opposite, (&points, &solids), found.stiffness);
        topology.connect(node, true);
        points.iter().flat_map(ContactPoint::nodes).for_each(|&node| topology.connect(node, false));
        solids.iter().for_each(|one| topology.connect(one.node, true));
        check_start(owner, (node, &surface), (&points, &solids), at_rest, topology, report);
        (law, chosen) = (Some(found), reason);
    }
    let surface = TouchedSurface::Shape(CarriedSurface { node, surface });
    Some(Contact {
        name: name.to_owned(),
        surface,
        points,
        convex: solids,
        joined: Vec::new(),
        touchers: sight.touchers,
        law,
        size,
        chosen,
    })
}

/// For a surface that solids touch with their full shape: its node, and whether only cylinders do. Multipliers act at points, so planes
/// and cylinders then have contact by points.
fn in_full(node: usize, surface: &Surface, by_points: bool) -> Option<OnConvex> {
    let (is_plane, is_cylinder) =
        (matches!(surface.shape, SurfaceShape::Plane(_)), matches!(surface.shape, SurfaceShape::Cylinder(_)));
    let is_convex = is_plane || surface.as_convex().is_some();
    let is_seen = is_convex && !(by_points && (is_plane || is_cylinder));
    is_seen.then_some(OnConvex { carrier: node, cylinders_alone: is_plane })
}

/// A contact of faces, or of bodies among themselves.
fn of_facets<'d>(
    setting: &LawSetting<'_, 'd>,
    owner: &Owner<'d>,
    name: &str,
    contact: &'d words::Contact,
    topology: &mut Topology,
    report: &mut Report<'d>,
) -> Option<Contact> {
    let &LawSetting { scene, point_masses, joints, at_nodes, gravity, .. } = setting;
    let mut finder = Finder::new(scene, topology, report);
    let found = read_facets(&mut finder, owner, name, contact);
    let is_zone = is_zone(owner, contact, scene.analysis.has_inertia(), report);
    let (mut found, is_zone) = (found?, is_zone?);
    found.joined = joined(&found.convex, joints, topology);
    let TouchedSurface::Facets(faces) = &found.surface else { return None };
    // Boxes and hulls among others are as stiff and as heavy as the balls within.
    let within = found.convex.iter().map(|one| Facet::ball(one.node, 0.5 * one.shape.least(), 0.0));
    let facets: Vec<Facet> = faces.facets.iter().cloned().chain(within).collect();
    let least = facets.iter().map(|facet| facet.half).fold(f64::INFINITY, f64::min);
    let radii = found.points.iter().map(|point| point.radius);
    let radius = radii.chain(found.convex.iter().map(|one| 0.5 * one.shape.least())).fold(f64::INFINITY, f64::min);
    // At this depth a body is in the middle of the sheet.
    found.size = least + radius;
    if is_zone {
        return Some(found);
    }
    let extent = setting.extent(topology);
    let chooser = LawReader { scene, point_masses, at_nodes, gravity, extent, topology: &*topology };
    let (opposite, touching) = (Opposite::Facets(&facets), (&found.points[..], &found.convex[..]));
    let (law, reason) = chooser.contact_law(owner, contact, opposite, touching, report)?;
    let at_rest = chooser.depth_at_rest(opposite, touching, law.stiffness);
    if faces.touchers != FacetTouchers::Itself {
        let size = topology.x(opposite.node()).norm().max(found.size);
        warn_closed(owner, gap_at_start(&found, faces, topology), size, at_rest, report);
    }
    opposite.nodes().into_iter().for_each(|node| topology.connect(node, true));
    found.points.iter().flat_map(ContactPoint::nodes).for_each(|&node| topology.connect(node, false));
    faces.solids.iter().for_each(|carried| topology.connect(carried.node, true));
    (found.law, found.chosen) = (Some(law), reason);
    Some(found)
}

/// The pairs of convex solids, by number, connected by joints or in one body.
fn joined(convex: &[ConvexBody], joints: &[Joint], topology: &Topology) -> Vec<[usize; 2]> {
    let place: HashMap<usize, usize> = convex.iter().enumerate().map(|(k, one)| (topology.root(one.node), k)).collect();
    let of_root = |node: usize| place.get(&topology.root(node)).copied();
    let by_joints = joints.iter().filter_map(|joint| Some([of_root(joint.ends[0])?, of_root(joint.ends[1])?]));
    let same = convex.iter().enumerate().filter_map(|(k, one)| Some([k, of_root(one.node)?]));
    let pairs = by_joints.chain(same).filter(|[a, b]| a != b).map(|[a, b]| [a.min(b), a.max(b)]);
    pairs.collect::<BTreeSet<_>>().into_iter().collect()
}

/// The least gap of points from facets, or of balls and convex solids among themselves, at t = 0.
fn gap_at_start(found: &Contact, faces: &FacetSurface, topology: &Topology) -> f64 {
    let nodes: Vec<Node> = topology.list.iter().map(|node| Node::at_rest(node.x)).collect();
    let of_points = Opposite::Facets(&faces.facets).gap(&found.points, topology);
    let of_convex = convex::heap_gap(if faces.part.is_empty() { &found.convex } else { &[] }, &found.joined, &nodes);
    let balls = if faces.part.is_empty() { &faces.back[..] } else { &[] };
    let on_solids = faces.solids.iter().map(|carried| least_gap(&carried.surface, carried.node, balls, &nodes));
    on_solids.fold(of_points.min(of_convex), f64::min)
}

/// The mass at each node, added to its master's.
fn masses_at_nodes(scene: &Scene, masses: &[Mass], topology: &Topology) -> Vec<f64> {
    let mut at = vec![0.0; topology.list.len()];
    scene.bodies.iter().for_each(|body| at[body.node] += body.mass);
    masses.iter().for_each(|mass| at[mass.node] += mass.mass);
    for part in &scene.parts.list {
        for element in 0..part.elements() {
            let of = part.nodes(element);
            let mass = part.element_mass(element, &topology.list, &scene.parts.stiffnesses);
            of.iter().for_each(|&node| at[node] += mass / of.len() as f64);
        }
    }
    for node in 0..at.len() {
        let root = topology.root(node);
        if root != node {
            at[root] += at[node];
        }
    }
    at
}

/// Checks the keys of the force; returns true for a clearance monitor, which exerts none.
fn is_zone<'d>(
    owner: &Owner<'d>,
    contact: &'d words::Contact,
    has_inertia: bool,
    report: &mut Report<'d>,
) -> Option<bool> {
    let mark = report.mark();
    report.not_negative("stiffness", &contact.stiffness, 1.0);
    report.not_negative("damping", &contact.damping, 0.0);
    friction::check(owner, contact, has_inertia, report);
    let is_zone = contact.stiffness.as_ref().is_some_and(|at| at.value == 0.0);
    if is_zone {
        let keys = keys!(contact; method, penetration_tolerance, restitution, damping, friction);
        report.reject_unused("a clearance monitor, a contact of stiffness 0 where nothing acts", &keys);
    }
    if let Some(at) = &contact.restitution {
        if at.value != 0.0 && !(restitution::LEAST..=1.0).contains(&at.value) {
            let message = format!("`restitution` is 0, or lies between {} and 1", restitution::LEAST);
            report.error_with::<()>(&at.span, message, "give 0 where nothing is to rebound");
        }
        if let Some(damping) = &contact.damping {
            report.error::<()>(&damping.span, format!("{} takes `restitution` or `damping`, not both", owner.what));
        }
    }
    let is_clean = report.is_clean_since(mark);
    friction::check_size(contact, report);
    is_clean.then_some(is_zone)
}

/// Warns of points that begin deeper inside a surface than weight on one point holds them, `at_rest`: they are pushed
/// out by an impact.
fn check_start(
    owner: &Owner,
    (node, surface): (usize, &Surface),
    (points, solids): (&[ContactPoint], &[ConvexBody]),
    at_rest: f64,
    topology: &Topology,
    report: &mut Report,
) {
    let center = topology.x(node);
    let distance = |point: &ContactPoint| {
        let x: Vec3 = point.nodes().iter().zip(point.weights).map(|(&node, w)| w * topology.x(node)).sum();
        surface.distance(&(x - center))
    };
    let gap = |point: &ContactPoint| distance(point) - point.radius;
    let own = std::iter::once(node).chain(solids.iter().map(|one| one.node));
    let own: Vec<Node> = own.map(|node| Node::at_rest(topology.x(node))).collect();
    let solids_there: Vec<ConvexBody> =
        solids.iter().enumerate().map(|(k, one)| ConvexBody { node: 1 + k, ..one.clone() }).collect();
    let of_convex = pair_gap(surface, 0, &solids_there, &own);
    let least = points.iter().map(gap).fold(of_convex, f64::min);
    let nodes = points.iter().map(|point| point.nodes[0]).chain(solids.iter().map(|one| one.node));
    let size = nodes.map(|node| topology.x(node).norm()).fold(center.norm(), f64::max);
    let outermost = solids.iter().map(|one| surface.distance(&(topology.x(one.node) - center)));
    let outermost = points.iter().map(distance).chain(outermost).fold(f64::NEG_INFINITY, f64::max);
    // A point at its depth at rest, or a trace too low, stands on the right side.
    let is_behind = -outermost > (1.001 * at_rest).max(1e-3 * size);
    if matches!(surface.shape, SurfaceShape::Plane(_)) && is_behind {
        let message =
            format!("{} begins closed: everything lies behind the plane, up to {} deep", owner.what, short(-least));
        report.warn(owner.span, message, "its normal points away from what should land on it: turn it round");
        return;
    }
    warn_closed(owner, least, size, at_rest, report);
}

/// Warns where the least gap at t = 0 is below the depth at rest under gravity; `size` is the magnitude of coordinates.
fn warn_closed(owner: &Owner, least: f64, size: f64, at_rest: f64, report: &mut Report) {
    // Decks have some digits only.
    if least < -1e-6 * size && -least > 1.001 * at_rest {
        let message = format!("{} begins closed: something lies {} inside the surface", owner.what, short(-least));
        let hint = match at_rest {
            depth if depth > 0.0 => {
                let far = short(-least - depth);
                format!(
                    "move it out by {far}, or it is pushed out at t = 0; at rest its weight holds it {} inside",
                    short(depth)
                )
            }
            _ => format!("move it out by {}, or it is pushed out at t = 0", short(-least)),
        };
        report.warn(owner.span, message, hint);
    }
}
