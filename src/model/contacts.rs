//! `[[contacts]]`: surfaces, the points that touch them, and what acts there.

use super::contact_faces::{is_of_facets, read_facets};
use super::contact_law::LawReader;
use super::contact_opposite::Opposite;
use super::contact_points::Finder;
use super::contact_surface::read_surface;
use super::data::{CarriedSurface, Contact, Mass, TouchedSurface};
use super::nodes::Topology;
use super::report::{Owner, Report};
use super::scene::Scene;
use super::sight::Sight;
use super::values::span;
use crate::deck::contacts as words;
use crate::elements::contact::boxes::BoxPose;
use crate::elements::contact::restitution;
use crate::elements::contact::{ContactPoint, FacetTouchers, Surface, TouchingBox};
use crate::math::Vec3;
use crate::names::short;

/// Reads `[[contacts]]`, after all constraints: nodes that depend on the surface's own body do not touch it, and
/// restrained nodes have no mass.
pub(super) fn contacts<'d>(
    scene: &Scene<'d>,
    masses: &[Mass],
    gravity: Vec3,
    topology: &mut Topology,
    report: &mut Report<'d>,
) -> Vec<Contact> {
    if scene.deck.contacts.is_empty() {
        return Vec::new();
    }
    let at_nodes = masses_at_nodes(scene, masses, topology);
    let mut contacts = Vec::new();
    for (index, contact) in scene.deck.contacts.iter().enumerate() {
        let name = contact.name.as_ref().map_or_else(|| format!("contacts.{index}"), |name| name.value.clone());
        let owner = Owner::new(format!("contact `{name}`"), &contact.span);
        report.require(&owner, "name", &contact.name);
        if is_of_facets(contact) {
            let setting = LawSetting { scene, masses, at_nodes: &at_nodes, gravity };
            contacts.extend(of_facets(&setting, &owner, &name, contact, topology, report));
            continue;
        }
        let surface = report.require(&owner, "surface", &contact.surface);
        let surface = surface.and_then(|table| read_surface(&name, table, scene, topology, report));
        let carrier = surface.as_ref().map(|(node, _)| *node);
        let on_box = surface.as_ref().and_then(|(node, surface)| surface.as_box().map(|_| *node));
        let mut finder =
            Finder { scene, topology, report, on_box, on_lines: false, boxes: Vec::new(), sight: Sight::default() };
        let points = finder.touching(&owner, &name, contact, carrier);
        let (boxes, sight) = (finder.boxes, finder.sight);
        let is_zone = is_zone(&owner, contact, report);
        let (Some((node, surface)), Some(points), Some(is_zone)) = (surface, points, is_zone) else { continue };
        sight.check(&owner, contact.points.as_ref().map(|at| at.value), &surface, report);
        let (mut law, mut chosen) = (None, None);
        let chooser = LawReader { scene, masses, at_nodes: &at_nodes, gravity, topology: &*topology };
        let opposite = Opposite::Shape(node, &surface);
        let size = chooser.size(opposite, (&points, &boxes));
        if !is_zone {
            let found = chooser.contact_law(&owner, contact, opposite, (&points, &boxes), report);
            let Some((found, reason)) = found else { continue };
            let at_rest = chooser.depth_at_rest(opposite, (&points, &boxes), found.stiffness);
            topology.connect(node, true);
            points.iter().flat_map(ContactPoint::nodes).for_each(|&node| topology.connect(node, false));
            boxes.iter().for_each(|one| topology.connect(one.node, true));
            check_start(&owner, (node, &surface), (&points, &boxes), at_rest, topology, report);
            (law, chosen) = (Some(found), reason);
        }
        let surface = TouchedSurface::Shape(CarriedSurface { node, surface });
        contacts.push(Contact { name, surface, points, boxes, touchers: sight.touchers, law, size, chosen });
    }
    contacts
}

/// What the laws of all contacts depend on.
struct LawSetting<'a, 'd> {
    scene: &'a Scene<'d>,
    masses: &'a [Mass],
    at_nodes: &'a [f64],
    gravity: Vec3,
}

/// A contact of faces, or of balls among themselves.
fn of_facets<'d>(
    setting: &LawSetting<'_, 'd>,
    owner: &Owner<'d>,
    name: &str,
    contact: &'d words::Contact,
    topology: &mut Topology,
    report: &mut Report<'d>,
) -> Option<Contact> {
    let &LawSetting { scene, masses, at_nodes, gravity } = setting;
    let mut finder =
        Finder { scene, topology, report, on_box: None, on_lines: false, boxes: Vec::new(), sight: Sight::default() };
    let found = read_facets(&mut finder, owner, name, contact);
    let is_zone = is_zone(owner, contact, report);
    let (mut found, is_zone) = (found?, is_zone?);
    let TouchedSurface::Facets(faces) = &found.surface else { return None };
    let least = faces.facets.iter().map(|facet| facet.half).fold(f64::INFINITY, f64::min);
    let radius = found.points.iter().map(|point| point.radius).fold(f64::INFINITY, f64::min);
    // What is pressed in by so much is in the middle.
    found.size = least + radius;
    if is_zone {
        return Some(found);
    }
    let chooser = LawReader { scene, masses, at_nodes, gravity, topology: &*topology };
    let (opposite, touching) = (Opposite::Facets(&faces.facets), (&found.points[..], &found.boxes[..]));
    let (law, reason) = chooser.contact_law(owner, contact, opposite, touching, report)?;
    let at_rest = chooser.depth_at_rest(opposite, touching, law.stiffness);
    if faces.touchers != FacetTouchers::Itself {
        warn_closed(owner, opposite.gap(&found.points, topology), topology.x(opposite.node()).norm(), at_rest, report);
    }
    opposite.nodes().into_iter().for_each(|node| topology.connect(node, true));
    found.points.iter().flat_map(ContactPoint::nodes).for_each(|&node| topology.connect(node, false));
    faces.boxes.iter().for_each(|carried| topology.connect(carried.node, true));
    (found.law, found.chosen) = (Some(law), reason);
    Some(found)
}

/// The mass at each node, and at what it depends on.
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
fn is_zone(owner: &Owner, contact: &words::Contact, report: &mut Report) -> Option<bool> {
    let mark = report.mark();
    report.not_negative("stiffness", &contact.stiffness, 1.0);
    report.not_negative("damping", &contact.damping, 0.0);
    report.not_negative("friction", &contact.friction, 0.0);
    let is_zone = contact.stiffness.as_ref().is_some_and(|at| at.value == 0.0);
    if is_zone {
        let keys = [
            ("restitution", span(&contact.restitution)),
            ("damping", span(&contact.damping)),
            ("friction", span(&contact.friction)),
        ];
        report.reject_unused("a clearance monitor, a contact of stiffness 0 where nothing acts", &keys);
    }
    if let Some(at) = &contact.restitution {
        if !(restitution::LEAST..=1.0).contains(&at.value) {
            let message = format!("`restitution` lies between {} and 1", restitution::LEAST);
            report.error_with::<()>(&at.span, message, "for restitution 0 give `damping`");
        }
        if let Some(damping) = &contact.damping {
            report.error::<()>(&damping.span, format!("{} takes `restitution` or `damping`, not both", owner.what));
        }
    }
    report.is_clean_since(mark).then_some(is_zone)
}

/// Warns of points that begin deeper inside a surface than weight on one point holds them, `at_rest`: they are pushed
/// out by an impact.
fn check_start(
    owner: &Owner,
    (node, surface): (usize, &Surface),
    (points, boxes): (&[ContactPoint], &[TouchingBox]),
    at_rest: f64,
    topology: &Topology,
    report: &mut Report,
) {
    let center = topology.x(node);
    let gap = |point: &ContactPoint| {
        let x: Vec3 = point.nodes().iter().zip(point.weights).map(|(&node, w)| w * topology.x(node)).sum();
        surface.distance(&(x - center)) - point.radius
    };
    let of_box = |one: &TouchingBox| pose_at_start(one, center, surface, topology).distance();
    let least = points.iter().map(gap).chain(boxes.iter().map(of_box)).fold(f64::INFINITY, f64::min);
    let nodes = points.iter().map(|point| point.nodes[0]).chain(boxes.iter().map(|one| one.node));
    let size = nodes.map(|node| topology.x(node).norm()).fold(center.norm(), f64::max);
    warn_closed(owner, least, size, at_rest, report);
}

/// Warns where the least gap at t = 0 is deeper than weight holds things; `size` is that of coordinates.
fn warn_closed(owner: &Owner, least: f64, size: f64, at_rest: f64, report: &mut Report) {
    // Decks have some digits only.
    if least < -1e-6 * size && -least > 1.001 * at_rest {
        let message = format!("{} begins closed: something lies {} inside the surface", owner.what, short(-least));
        let hint = match at_rest {
            depth if depth > 0.0 => {
                format!("it is pushed out at t = 0; at rest its weight holds it {} inside", short(depth))
            }
            _ => "it is pushed out at t = 0".to_owned(),
        };
        report.warn(owner.span, message, hint);
    }
}

/// A box against the surface of a contact at t = 0, when bodies are not yet turned.
fn pose_at_start(one: &TouchingBox, center: Vec3, surface: &Surface, topology: &Topology) -> BoxPose {
    let y = surface.axes.tr_mul(&(topology.x(one.node) - center - surface.center));
    BoxPose { y, Q: surface.axes.transpose(), own: one.half, other: surface.as_box().unwrap_or_else(Vec3::zeros) }
}
