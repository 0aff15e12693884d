//! `[[contacts]]`: surfaces, the points that touch them, and what acts there.

use super::contact_points::Finder;
use super::contact_surface::read_surface;
use super::data::{AnalysisKind, Contact, Mass, StepLength};
use super::nodes::Topology;
use super::report::{Owner, Report};
use super::scene::Scene;
use super::values::span;
use crate::deck::contacts as words;
use crate::elements::contact::restitution::{self, Loss};
use crate::elements::contact::{ContactLaw, ContactPoint, Surface};
use crate::math::Vec3;
use crate::names::short;
use std::f64::consts::{PI, TAU};

/// Number of steps that an impact lasts where the program chooses the stiffness.
const STEPS: f64 = 20.0;
/// Fraction of 1/√(k/m) that a step of an impact may reach ahead: an impact then takes nine steps or more.
const RESOLUTION: f64 = 0.5;

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
        let surface = report.require(&owner, "surface", &contact.surface);
        let surface = surface.and_then(|table| read_surface(&name, table, scene, topology, report));
        let carrier = surface.as_ref().map(|(node, _)| *node);
        let points = Finder { scene, topology, report }.touching(&owner, &name, contact, carrier);
        let is_zone = is_zone(&owner, contact, report);
        let (Some((node, surface)), Some(points), Some(is_zone)) = (surface, points, is_zone) else { continue };
        let mut law = None;
        if !is_zone {
            let chooser = LawReader { scene, masses, at_nodes: &at_nodes, gravity, topology: &*topology };
            let Some(found) = chooser.contact_law(&owner, contact, node, &points, report) else { continue };
            let at_rest = chooser.depth_at_rest(node, &points, found.stiffness);
            topology.connect(node, true);
            points.iter().flat_map(ContactPoint::nodes).for_each(|&node| topology.connect(node, false));
            check_start(&owner, node, &surface, &points, at_rest, topology, report);
            law = Some(found);
        }
        let chosen = law.is_some() && contact.stiffness.is_none();
        contacts.push(Contact { name, node, surface, points, law, chosen });
    }
    contacts
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

struct LawReader<'a, 'd> {
    scene: &'a Scene<'d>,
    /// Point masses of the deck.
    masses: &'a [Mass],
    /// For each node the mass that it moves.
    at_nodes: &'a [f64],
    gravity: Vec3,
    topology: &'a Topology,
}

/// The masses that meet at the points of a contact.
struct Meeting {
    /// The largest mass that takes part in an impact.
    mean: f64,
    /// The least such mass, with the rotation of bodies.
    least: f64,
    /// True where only bodies and point masses are in contact.
    rigid: bool,
}

impl LawReader<'_, '_> {
    fn contact_law(
        &self,
        owner: &Owner,
        contact: &words::Contact,
        carrier: usize,
        points: &[ContactPoint],
        report: &mut Report,
    ) -> Option<ContactLaw> {
        if report.is_spoiled(owner.span, "stiffness") {
            return None;
        }
        let dynamic = self.scene.analysis.kind == AnalysisKind::Dynamic;
        let meeting = self.meeting(carrier, points);
        let stiffness = match &contact.stiffness {
            Some(at) => at.value,
            None => match self.chosen_stiffness(&meeting) {
                Ok(stiffness) => stiffness,
                Err(hint) => return report.error_with(owner.span, format!("{} needs `stiffness`", owner.what), hint),
            },
        };
        let mass = if meeting.least.is_finite() { meeting.least } else { meeting.mean };
        let frequency = if mass > 0.0 { (stiffness / mass).sqrt() } else { f64::INFINITY };
        let first = self.topology.x(0);
        let extent = self.topology.list.iter().map(|node| (node.x - first).norm()).fold(0.0, f64::max);
        // An approach that sinks in no deeper than the weight does is no impact. Where there is no weight, a trace of length.
        let floor = (self.gravity.norm() / frequency).max(if mass > 0.0 { 1e-7 * extent * frequency } else { 0.0 });
        let loss = match (&contact.restitution, &contact.damping) {
            (Some(at), _) if at.value < 1.0 => Loss::Restitution { number: restitution::number(at.value), floor },
            (_, Some(at)) if at.value > 0.0 => Loss::Damping(at.value),
            _ => Loss::None,
        };
        let resolved = dynamic && meeting.rigid && frequency.is_finite();
        Some(ContactLaw {
            stiffness,
            loss,
            friction: contact.friction.as_ref().map_or(0.0, |at| at.value),
            floor,
            resolution: if resolved { RESOLUTION / frequency } else { f64::INFINITY },
            duration: TAU / frequency,
            near: 0.01 * extent,
            dynamic,
        })
    }

    /// The penetration under gravity, where the largest mass in contact rests on one point.
    fn depth_at_rest(&self, carrier: usize, points: &[ContactPoint], stiffness: f64) -> f64 {
        self.gravity.norm() * self.meeting(carrier, points).mean / stiffness
    }

    /// The stiffness with which an impact lasts some steps, or why none can be chosen.
    fn chosen_stiffness(&self, meeting: &Meeting) -> Result<f64, &'static str> {
        if self.scene.analysis.kind != AnalysisKind::Dynamic {
            return Err(
                "in a static analysis nothing says how stiff it should be: give force over the penetration that may be",
            );
        }
        if meeting.mean <= 0.0 {
            return Err("nothing that touches has a mass to choose it by");
        }
        match self.scene.analysis.step_length {
            StepLength::Fixed { step } => Ok(meeting.mean * (PI / (STEPS * step)).powi(2)),
            _ => Err(
                "an automatic time step gives no length to choose it by: m (pi / T)^2 makes impacts of a mass m last T",
            ),
        }
    }

    /// The mass that resists a motion of a node. Dependent nodes have that of what they depend on.
    fn mass(&self, node: usize) -> f64 {
        let root = self.topology.root(node);
        let restrained = (0..3).all(|dof| self.topology.restraint(root, dof).is_some());
        if restrained { f64::INFINITY } else { self.at_nodes.get(root).copied().unwrap_or(0.0) }
    }

    fn meeting(&self, carrier: usize, points: &[ContactPoint]) -> Meeting {
        let on_ground = !self.scene.bodies.iter().any(|body| body.node == carrier);
        let other = if on_ground { f64::INFINITY } else { self.mass(carrier) };
        let (mut mean, mut least, mut rigid) = (0.0f64, f64::INFINITY, true);
        for point in points {
            let own: f64 = point.nodes().iter().zip(point.weights).map(|(&node, w)| w.abs() * self.mass(node)).sum();
            let reduced = 1.0 / (1.0 / own + 1.0 / other);
            let is_body = point.nodes().iter().all(|&node| self.is_lump(self.topology.root(node)));
            rigid &= is_body || point.nodes().iter().all(|&node| self.is_weighted(self.topology.root(node)));
            // More than the node's own mass takes part in an impact of a body on a deformable part.
            let taken = if is_body || !other.is_finite() { reduced } else { (own * other).sqrt() };
            mean = mean.max(if taken.is_finite() { taken } else { 0.0 });
            least = if reduced > 0.0 { least.min(1.0 / (1.0 / reduced + self.ease(point))) } else { least };
        }
        Meeting { mean, least, rigid }
    }

    /// True where point masses are more than half of the mass at a node.
    fn is_weighted(&self, node: usize) -> bool {
        let own: f64 = self.masses.iter().filter(|mass| mass.node == node).map(|mass| mass.mass).sum();
        own > 0.5 * self.at_nodes.get(node).copied().unwrap_or(0.0)
    }

    /// The compliance r²/J by which a body is easier to move at a point than at its centre.
    fn ease(&self, point: &ContactPoint) -> f64 {
        let root = self.topology.root(point.nodes[0]);
        let body = self.scene.bodies.iter().find(|body| body.node == root);
        body.map_or(0.0, |body| {
            let r = self.topology.x(point.nodes[0]) - self.topology.x(root);
            if body.inertia.trace() > 0.0 { 3.0 * r.norm_squared() / body.inertia.trace() } else { 0.0 }
        })
    }

    /// True for the node of a body or a point mass that belongs to no deformable part.
    fn is_lump(&self, node: usize) -> bool {
        self.scene.bodies.iter().any(|body| body.node == node)
            || self.masses.iter().any(|mass| mass.node == node) && !self.scene.parts.has_node(node)
    }
}

/// Warns of points that begin deeper inside a surface than weight on one point holds them, `at_rest`: they are pushed
/// out by an impact.
fn check_start(
    owner: &Owner,
    node: usize,
    surface: &Surface,
    points: &[ContactPoint],
    at_rest: f64,
    topology: &Topology,
    report: &mut Report,
) {
    let center = topology.x(node);
    let gap = |point: &ContactPoint| {
        let x: Vec3 = point.nodes().iter().zip(point.weights).map(|(&node, w)| w * topology.x(node)).sum();
        surface.distance(&(x - center)) - point.radius
    };
    let least = points.iter().map(gap).fold(f64::INFINITY, f64::min);
    let size = points.iter().map(|point| topology.x(point.nodes[0]).norm()).fold(center.norm(), f64::max);
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
