//! The numbers of a contact law, from the deck and the masses that meet.

use crate::contacts::method;
use crate::contacts::opposite::Opposite;
use crate::contacts::stiffness::{Bounds, ChosenStiffness, Meets};
use crate::data::{Body, SAFE_WHERE_STRUCK, StepLength};
use crate::places::nodes::Topology;
use crate::procedure::scaled_masses::{KEY, is_central};
use crate::report::{Owner, Report};
use crate::scene::Scene;
use base::math::Vec3;
use base::names::{short, to_digits};
use deck::contacts as words;
use mechanics::elements::contact::restitution::{self, Loss};
use mechanics::elements::contact::{ContactLaw, ContactPoint, ConvexBody, MOST_NODES, TouchKind};
use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

/// Fraction of 1/√(k/m) for one step of an impact: an impact then needs nine steps or more.
const RESOLUTION: f64 = 0.5;
/// Steps of an impact of a light body on a deformable part, in automatic explicit steps. The steps that close and open the contact cause the error,
/// up to (ω Δt)²/4 of the energy: a hundredth.
const RESOLUTION_OF_LIGHT: f64 = 0.2;
/// Gap, as a part of the size of the scene, that counts as closed in statics: the rounding of positions.
const TOUCHING: f64 = 1e-12;
/// Number of steps for an impact where steps are not cut, as in the chapter on contact stiffness.
const STEPS: f64 = 10.0;
/// Number of implicit steps for an impact of the lightest node on a heavy body. The node loses its own energy within a step. The body slows down
/// over many steps.
const STEPS_OF_NODE: f64 = 1.0;
/// Effective mass over that of the lightest node for a heavy body: it has a hundred times the mass of the node, whose energy is then not seen.
const HEAVY: f64 = 10.0;
/// Part of a step that an impact of the lightest node may last: below that forces at the ends of steps are several times too large.
const TOO_SHORT: f64 = 0.5;
/// Number of explicit steps for an impact of the lightest node: a sheet that lands flat with all nodes then keeps 95 % of its energy.
const EXPLICIT_STEPS: f64 = 5.0;

/// Reads the numbers of a contact law.
pub struct LawReader<'a, 'd> {
    /// The scene so far.
    pub scene: &'a Scene<'d>,
    /// The sum of the point masses of the deck at nodes that have some.
    pub point_masses: &'a HashMap<usize, f64>,
    /// For each node the mass that it moves.
    pub at_nodes: &'a [f64],
    /// The acceleration of gravity, global.
    pub gravity: Vec3,
    /// The extent of the scene from its first node.
    pub extent: f64,
    /// The nodes and how they are connected.
    pub topology: &'a Topology,
}

/// The masses that points meet.
struct Other {
    /// The largest.
    mass: f64,
    /// The least.
    least: f64,
    /// The largest that nothing holds.
    free: f64,
    /// True where there are bodies, point masses and the ground alone.
    rigid: bool,
}

/// The masses that meet at the points of a contact.
struct Meeting {
    /// The largest effective mass in an impact.
    mean: f64,
    /// The least such mass, with the rotation of bodies.
    least: f64,
    /// True where only bodies and point masses are in contact.
    rigid: bool,
    /// True where a free body is far heavier than a node of a deformable part that it may meet.
    heavy: bool,
    /// True where a free body is lighter than a node of a deformable part that it may meet. The impact is then faster than any mode of the part.
    light: bool,
}

impl Meeting {
    /// True where a body meets nodes so light that only the body is slowed down over several steps.
    fn is_heavy(&self) -> bool {
        !self.light && self.heavy
    }
}

impl LawReader<'_, '_> {
    /// The law, and the reason for its stiffness if the program has chosen it.
    pub fn contact_law(
        &self,
        owner: &Owner,
        contact: &words::Contact,
        opposite: Opposite,
        touching: (&[ContactPoint], &[ConvexBody]),
        report: &mut Report,
    ) -> Option<(ContactLaw, Option<String>)> {
        if report.is_spoiled(owner.span, "stiffness") {
            return None;
        }
        let (points, levers) = with_convex(touching);
        let meeting = self.meeting(opposite, &points, &levers);
        let chosen = match &contact.stiffness {
            Some(_) => None,
            None => match self.chosen_stiffness(&meeting, opposite, &points) {
                Ok(chosen) => Some(chosen),
                Err(hint) => return report.error_with(owner.span, format!("{} needs `stiffness`", owner.what), hint),
            },
        };
        let given = contact.stiffness.as_ref().map(|at| at.value);
        let stiffness = given.or(chosen.as_ref().map(|chosen| chosen.stiffness))?;
        let sizes = (self.size(opposite, touching), self.extent);
        let by_points = touching.1.is_empty() && !matches!(opposite, Opposite::Facets(_));
        let tolerance = method::tolerance(self.scene, owner, contact, by_points, sizes, report);
        if let Some(chosen) = chosen.as_ref().filter(|_| tolerance.is_none()) {
            self.check_step(owner, &meeting, chosen, report);
            if chosen.rests_on_time {
                let message = format!(
                    "nothing in the deck says how fast or how hard {} is met, so its `stiffness` of {} rests on `end_time` alone",
                    owner.what,
                    short(stiffness)
                );
                report.warn(owner.span, message, "give `stiffness`: mass times the square of speed over depth");
            }
        }
        let law = ContactLaw { tolerance, ..self.law(contact, &meeting, stiffness) };
        Some((law, chosen.map(|chosen| chosen.reason)))
    }

    fn law(&self, contact: &words::Contact, meeting: &Meeting, stiffness: f64) -> ContactLaw {
        let dynamic = self.scene.analysis.is_dynamic();
        let mass = if meeting.least.is_finite() { meeting.least } else { meeting.mean };
        let frequency = if mass > 0.0 { (stiffness / mass).sqrt() } else { f64::INFINITY };
        let extent = self.extent;
        // An approach that sinks in no deeper than the weight does is no impact. Where there is no weight, a trace of length.
        let floor = (self.gravity.norm() / frequency).max(if mass > 0.0 { 1e-7 * extent * frequency } else { 0.0 });
        let loss = match (&contact.restitution, &contact.damping) {
            (Some(at), _) if at.value == 0.0 => Loss::Whole { floor },
            (Some(at), _) if at.value < 1.0 => Loss::Restitution { number: restitution::number(at.value), floor },
            (_, Some(at)) if at.value > 0.0 => Loss::Damping(at.value),
            _ => Loss::None,
        };
        let words::Coefficients { sticking, kinetic, decay } = contact.coefficients();
        let light = meeting.light && !meeting.rigid && self.finds_explicit_steps();
        let resolved = dynamic && (meeting.rigid || light) && frequency.is_finite();
        let resolution = if light { RESOLUTION_OF_LIGHT } else { RESOLUTION };
        // An impact with restitution 0 stops in half of the time.
        let resolution = if matches!(loss, Loss::Whole { .. }) { 0.5 * resolution } else { resolution };
        ContactLaw {
            stiffness,
            loss,
            friction: sticking,
            kinetic,
            decay,
            floor,
            resolution: if resolved { resolution / frequency } else { f64::INFINITY },
            duration: TAU / frequency,
            near: 0.01 * extent,
            touching: if dynamic { 0.0 } else { TOUCHING * extent },
            tolerance: None,
            dynamic,
        }
    }

    /// Warns of fixed steps that are too long for an impact. Explicit ones then have lowered the stiffness; in implicit ones a node comes and goes
    /// within a part of a step.
    fn check_step(&self, owner: &Owner, meeting: &Meeting, chosen: &ChosenStiffness, report: &mut Report) {
        let StepLength::Fixed { step } = self.scene.analysis.step_length else { return };
        let ChosenStiffness { stiffness, called_for, .. } = *chosen;
        let is_explicit = self.is_explicit();
        let has_less = is_explicit && stiffness < called_for;
        let impact = PI * (meeting.least / if has_less { called_for } else { stiffness }).sqrt();
        let (enough, seen) = match is_explicit {
            true => (impact / EXPLICIT_STEPS, 1.0),
            false if meeting.is_heavy() => (impact / STEPS_OF_NODE, TOO_SHORT),
            false => (impact / STEPS, 1.0),
        };
        if !self.scene.analysis.is_dynamic() || meeting.rigid || !impact.is_finite() || seen * step <= enough {
            return;
        }
        let message = match has_less {
            true => format!(
                "`time_step` allows {} a stiffness of {}, but its bodies call for {}: the penetration is up to {} times as deep",
                owner.what,
                short(stiffness),
                short(called_for),
                to_digits((called_for / stiffness).sqrt(), 2)
            ),
            false => format!(
                "the step is too long for the stiffness chosen for {}, {}: an impact of one node lasts {}",
                owner.what,
                short(stiffness),
                short(impact)
            ),
        };
        report.warn(owner.span, message, format!("give a `time_step` of {} or less", short(enough)));
    }

    /// The bounds that steps set to the stiffness; `None` where steps are cut. Implicit ones set some where a heavy body strikes a part with a
    /// thickness, in decks without stages: a contact keeps its stiffness through all of them.
    fn bounds(&self, meeting: &Meeting, meets: &Meets) -> Option<Bounds> {
        let (count, steps, step, least) = match self.scene.analysis.step_length {
            _ if meeting.rigid || !meeting.least.is_finite() => return None,
            _ if self.is_explicit() => {
                (EXPLICIT_STEPS, "five explicit steps", self.step_ahead()?, meets.least_under_weight(meeting.mean))
            }
            StepLength::Fixed { step }
                if self.scene.analysis.is_dynamic() && self.scene.stage.is_none() && meeting.is_heavy() =>
            {
                (STEPS_OF_NODE, "one step", step, meets.least_in_impact(meeting.mean)?)
            }
            _ => return None,
        };
        Some(Bounds { most: meeting.least * (PI / (count * step)).powi(2), steps, least })
    }

    fn is_explicit(&self) -> bool {
        self.scene.deck.integrator.as_ref().is_some_and(is_central)
    }

    /// True for central differences whose steps follow the critical one.
    fn finds_explicit_steps(&self) -> bool {
        self.is_explicit() && !matches!(self.scene.analysis.step_length, StepLength::Fixed { .. })
    }

    /// The fixed step, or the automatic one of central differences where membranes and bars limit it.
    fn step_ahead(&self) -> Option<f64> {
        if let StepLength::Fixed { step } = self.scene.analysis.step_length {
            return Some(step);
        }
        let parts = &self.scene.parts;
        let of_elements = parts.list.iter().flat_map(|part| {
            (0..part.elements()).filter_map(|element| {
                let stiffness = part.stretching(element, &self.topology.list, &parts.stiffnesses)?;
                let mass = part.element_mass(element, &self.topology.list, &parts.stiffnesses);
                let at_node = mass / part.nodes(element).len() as f64;
                // Exact for a bar of two nodes, ω² = 2 k/m.
                (mass > 0.0).then(|| (2.0 * at_node / stiffness).sqrt())
            })
        });
        let critical = of_elements.reduce(f64::min)?;
        let scaled = self.scene.deck.integrator.as_ref().and_then(|at| at.values.numbers(KEY).first().copied());
        Some(SAFE_WHERE_STRUCK * critical.max(scaled.unwrap_or(0.0)))
    }

    /// The smallest dimension of the touching and touched bodies.
    pub fn size(&self, opposite: Opposite, touching: (&[ContactPoint], &[ConvexBody])) -> f64 {
        let (points, _) = with_convex(touching);
        self.meets(opposite, &points).size_of_bodies()
    }

    fn meets<'a>(&'a self, opposite: Opposite<'a>, points: &'a [ContactPoint]) -> Meets<'a, 'a> {
        Meets { scene: self.scene, topology: self.topology, gravity: self.gravity.norm(), opposite, points }
    }

    /// The penetration under gravity, where the largest mass in contact rests on one point.
    pub fn depth_at_rest(&self, opposite: Opposite, touching: (&[ContactPoint], &[ConvexBody]), stiffness: f64) -> f64 {
        let (points, levers) = with_convex(touching);
        self.gravity.norm() * self.meeting(opposite, &points, &levers).mean / stiffness
    }

    /// The stiffness by the touching bodies, or the reason for having none.
    fn chosen_stiffness(
        &self,
        meeting: &Meeting,
        opposite: Opposite,
        points: &[ContactPoint],
    ) -> Result<ChosenStiffness, &'static str> {
        let meets = self.meets(opposite, points);
        if !self.scene.analysis.has_inertia() {
            return meets
                .stiffness_under_loads(meeting.mean)
                .ok_or("no material, weight or load tells it: give the force over the penetration allowed");
        }
        if meeting.mean <= 0.0 {
            return Err("nothing that touches has a mass to choose it by");
        }
        let chosen = meets.stiffness(meeting.mean);
        Ok(match self.bounds(meeting, &meets) {
            Some(bounds) => chosen.within(bounds),
            None => chosen,
        })
    }

    /// The mass that resists a motion of a node. Dependent nodes have the mass of their masters.
    fn mass(&self, node: usize) -> f64 {
        let root = self.topology.root(node);
        let restrained = (0..3).all(|dof| self.topology.restraint(root, dof).is_some());
        if restrained { f64::INFINITY } else { self.at_nodes.get(root).copied().unwrap_or(0.0) }
    }

    fn meeting(&self, opposite: Opposite, points: &[ContactPoint], levers: &[f64]) -> Meeting {
        let Other { mass: other, least: least_other, free: free_other, rigid: other_is_rigid } = self.other(opposite);
        let (mut mean, mut least, mut rigid) = (0.0f64, f64::INFINITY, other_is_rigid);
        let (mut light, mut heavy) = (false, false);
        for (point, &lever) in points.iter().zip(levers) {
            let own: f64 = point.nodes().iter().zip(point.weights).map(|(&node, w)| w.abs() * self.mass(node)).sum();
            let reduced = 1.0 / (1.0 / own + 1.0 / other);
            let is_body = point.nodes().iter().all(|&node| self.is_lump(self.topology.root(node)));
            light |= match (is_body, other_is_rigid) {
                (true, false) => own < free_other,
                (false, true) => own.is_finite() && other < own,
                _ => false,
            };
            rigid &= is_body || point.nodes().iter().all(|&node| self.is_weighted(self.topology.root(node)));
            // In an impact of a body on a deformable part, the effective mass exceeds that of the node.
            let taken = if is_body == other_is_rigid || !other.is_finite() { reduced } else { (own * other).sqrt() };
            // Alike masses on the ground differ by the mesh alone.
            heavy |= is_body != other_is_rigid
                && taken.is_finite()
                && other.is_finite()
                && taken > HEAVY * own.min(least_other);
            mean = mean.max(if taken.is_finite() { taken } else { 0.0 });
            let reduced = 1.0 / (1.0 / own + 1.0 / least_other);
            least = if reduced > 0.0 { least.min(1.0 / (1.0 / reduced + self.ease(point, lever))) } else { least };
        }
        Meeting { mean, least, rigid, light, heavy }
    }

    /// The mass opposite to the points.
    fn other(&self, opposite: Opposite) -> Other {
        let Opposite::Facets(_) = opposite else {
            let carrier = opposite.node();
            let on_ground = Body::at(&self.scene.bodies, carrier).is_none();
            let mass = if on_ground { f64::INFINITY } else { self.mass(carrier) };
            return Other { mass, least: mass, free: mass, rigid: true };
        };
        let nodes = opposite.nodes();
        let masses = || nodes.iter().map(|&node| self.mass(node));
        let rigid = nodes.iter().all(|&node| {
            let root = self.topology.root(node);
            self.is_lump(root) || self.is_weighted(root)
        });
        Other {
            mass: masses().fold(0.0, f64::max),
            least: masses().fold(f64::INFINITY, f64::min),
            free: masses().filter(|mass| mass.is_finite()).fold(0.0, f64::max),
            rigid,
        }
    }

    /// True where point masses are more than half of the mass at a node.
    fn is_weighted(&self, node: usize) -> bool {
        let own = self.point_masses.get(&node).copied().unwrap_or(0.0);
        own > 0.5 * self.at_nodes.get(node).copied().unwrap_or(0.0)
    }

    /// The compliance r²/J from the rotation of a body, at a point or at a lever from it.
    fn ease(&self, point: &ContactPoint, lever: f64) -> f64 {
        let root = self.topology.root(point.nodes[0]);
        Body::at(&self.scene.bodies, root).map_or(0.0, |body| {
            let body = &self.scene.bodies[body];
            let r = (self.topology.x(point.nodes[0]) - self.topology.x(root)).norm() + lever;
            if body.inertia.trace() > 0.0 { 3.0 * r * r / body.inertia.trace() } else { 0.0 }
        })
    }

    /// True for the node of a body or a point mass that belongs to no deformable part.
    fn is_lump(&self, node: usize) -> bool {
        Body::at(&self.scene.bodies, node).is_some()
            || self.point_masses.contains_key(&node) && !self.scene.parts.has_node(node)
    }
}

/// Points, with a ball within each box or hull for that itself, and how far beyond the point it may be touched.
fn with_convex((points, convex): (&[ContactPoint], &[ConvexBody])) -> (Vec<ContactPoint>, Vec<f64>) {
    let ball = |one: &ConvexBody| {
        let (nodes, mut weights) = ([one.node; MOST_NODES], [0.0; MOST_NODES]);
        weights[0] = 1.0;
        ContactPoint {
            nodes,
            weights,
            count: 1,
            radius: 0.5 * one.shape.least(),
            rolling_radius: 0.0,
            extent: TouchKind::Point,
        }
    };
    let levers = points.iter().map(|_| 0.0).chain(convex.iter().map(|one| one.shape.reach())).collect();
    (points.iter().cloned().chain(convex.iter().map(ball)).collect(), levers)
}
