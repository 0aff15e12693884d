//! The penalty stiffness chosen by the program: by material and size of the bodies, by weight and by speed. Long steps
//! lower it. Short steps keep it, so that results converge with the step.

use crate::contacts::opposite::Opposite;
use crate::data::Body;
use crate::places::nodes::Topology;
use crate::scene::Scene;
use crate::values::{vec3, vec3_or_zero};
use base::math::Vec3;
use base::names::short;
use deck::Deck;
use mechanics::elements::contact::ContactPoint;
use std::collections::HashSet;

/// Depth under weight on one point, relative to the size of the bodies: invisible.
const SUNK: f64 = 1e-3;
/// Depth under weight, relative to the size of the bodies, that is seen.
const SEEN: f64 = 0.05;
/// The part of the size that an impact presses in: it is over before anything has turned, and steps can follow it.
const STRUCK: f64 = 1e-2;

/// The part of the way to the middle of a sheet that a body may press in when it strikes.
const INTO_SHEET: f64 = 0.75;

/// The largest stiffness that steps follow, and the least that holds a body off.
pub struct Bounds {
    /// The stiffness with which an impact of the lightest node lasts a number of steps.
    pub most: f64,
    /// That number in words.
    pub steps: &'static str,
    /// The stiffness below which a body sinks in, and the reason in words.
    pub least: (f64, String),
}

/// A penalty stiffness that the program has chosen.
pub struct ChosenStiffness {
    /// The force of a point per depth.
    pub stiffness: f64,
    /// The stiffness that the bodies call for, which a fixed step may not bear.
    pub called_for: f64,
    /// The reason for the choice, in words.
    pub reason: String,
    /// True if only the duration of the run was available for the choice.
    pub rests_on_time: bool,
}

impl ChosenStiffness {
    fn new(stiffness: f64, reason: String, rests_on_time: bool) -> ChosenStiffness {
        ChosenStiffness { stiffness, called_for: stiffness, reason, rests_on_time }
    }

    /// The same, lowered to the largest stiffness that steps follow, but not below the one that holds a body off.
    pub fn within(self, bounds: Bounds) -> ChosenStiffness {
        let Bounds { most, steps, least: (least, held) } = bounds;
        if self.stiffness <= most.max(least) {
            return self;
        }
        let why = if most < least { held } else { format!("an impact of the lightest node lasts {steps}") };
        let reason = format!("{why}; {} calls for {}", self.reason, short(self.stiffness));
        ChosenStiffness { stiffness: most.max(least), reason, ..self }
    }
}

/// The things that meet in a contact.
pub struct Meets<'a, 'd> {
    /// The scene so far.
    pub scene: &'a Scene<'d>,
    /// The nodes and how they are connected.
    pub topology: &'a Topology,
    /// The magnitude of gravity.
    pub gravity: f64,
    /// The side opposite to the points.
    pub opposite: Opposite<'a>,
    /// The points.
    pub points: &'a [ContactPoint],
}

impl Meets<'_, '_> {
    /// The stiffness for the effective mass: the largest by material, weight and speed.
    pub fn stiffness(&self, mass: f64) -> ChosenStiffness {
        let (size, speed) = (self.size(), self.speed());
        let mut choices = Vec::new();
        match self.softest_part() {
            Some((stiffness, part)) => {
                choices.push((stiffness, format!("E A over the length of an element of `{part}`")))
            }
            None if speed > 0.0 => {
                let depth = format!("an impact at {} presses {} in", short(speed), short(STRUCK * size));
                choices.push((mass * (speed / (STRUCK * size)).powi(2), depth));
            }
            None => {}
        }
        if self.gravity > 0.0 {
            let depth = format!("a weight of {} presses {} in", short(mass * self.gravity), short(SUNK * size));
            choices.push((mass * self.gravity / (SUNK * size), depth));
        }
        if choices.is_empty() {
            choices.extend(self.under_loads(mass));
        }
        let rests_on_time = choices.is_empty();
        if rests_on_time {
            let pace = self.extent() / self.duration();
            let reason = format!(
                "nothing moves at t = 0; at {}, the scene in the run, {} deep",
                short(pace),
                short(STRUCK * size)
            );
            choices.push((mass * (pace / (STRUCK * size)).powi(2), reason));
        }
        let largest = choices.into_iter().max_by(|a, b| a.0.total_cmp(&b.0));
        let (stiffness, reason) = largest.unwrap_or_default();
        ChosenStiffness::new(stiffness, reason, rests_on_time)
    }

    /// The stiffness with which weight presses in by a twentieth of the size, where it begins to be seen.
    pub fn least_under_weight(&self, mass: f64) -> (f64, String) {
        let depth = SEEN * self.size();
        let weight = mass * self.gravity;
        (weight / depth, format!("a weight of {} presses {} in", short(weight), short(depth)))
    }

    /// The stiffness with which a body that strikes a part with a thickness stays away from its middle; `None` without such an impact.
    pub fn least_in_impact(&self, mass: f64) -> Option<(f64, String)> {
        let radius = self.points.iter().map(|point| point.radius).fold(f64::INFINITY, f64::min);
        let (depth, speed) = (INTO_SHEET * (radius + self.opposite.half()), self.speed());
        let in_impact = mass * (speed / depth).powi(2);
        let reason = format!("an impact at {} presses {} in", short(speed), short(depth));
        let under_weight = self.least_under_weight(mass);
        let least = if in_impact < under_weight.0 { under_weight } else { (in_impact, reason) };
        (depth > 0.0 && in_impact > 0.0).then_some(least)
    }

    /// The stiffness of load steps: by material, or by weight and loads on the effective mass. With multipliers it does not affect the
    /// result. `None` where the deck says nothing of these.
    pub fn stiffness_under_loads(&self, mass: f64) -> Option<ChosenStiffness> {
        if let Some((stiffness, part)) = self.softest_part() {
            let reason = format!("E A over the length of an element of `{part}`");
            return Some(ChosenStiffness::new(stiffness, reason, false));
        }
        self.under_loads(mass).map(|(stiffness, reason)| ChosenStiffness::new(stiffness, reason, false))
    }

    /// The stiffness with which the weight of a mass and all loads press in by a thousandth of the size.
    fn under_loads(&self, mass: f64) -> Option<(f64, String)> {
        let forces = self.whole_deck().loads.iter().filter_map(|load| load.force.as_ref());
        let force = mass * self.gravity + forces.map(|at| vec3(at).norm()).sum::<f64>();
        let depth = SUNK * self.size();
        let reason = format!("weight and loads of {} press {} in", short(force), short(depth));
        (force > 0.0).then(|| (force / depth, reason))
    }

    /// The least stiffness over the deformable parts in contact, each by its stiffest touching element, with the name of the part. The
    /// spring of a contact then gives way by no more than the mesh does anyway: a softer one would delay a blow by more than an element.
    fn softest_part(&self) -> Option<(f64, &str)> {
        let mut touching: HashSet<usize> = self.points.iter().flat_map(ContactPoint::nodes).copied().collect();
        if let Opposite::Facets(_) = self.opposite {
            touching.extend(self.opposite.nodes());
        }
        let (nodes, stiffnesses) = (&self.topology.list, &self.scene.parts.stiffnesses);
        let softest = |touches: &dyn Fn(&[usize]) -> bool| {
            let stiffest = |part: &crate::data::Part| {
                let elements = (0..part.elements()).filter(|&element| touches(part.nodes(element)));
                elements.filter_map(|element| part.stretching(element, nodes, stiffnesses)).reduce(f64::max)
            };
            let all = self.scene.parts.list.iter().filter_map(|part| Some((stiffest(part)?, part.name())));
            all.min_by(|a, b| a.0.total_cmp(&b.0))
        };
        // Elements with only some touching nodes do not count, unless no element touches with all of its nodes.
        let whole = softest(&|nodes| nodes.iter().all(|node| touching.contains(node)));
        whole.or_else(|| softest(&|nodes| nodes.iter().any(|node| touching.contains(node))))
    }

    /// The smallest dimension of touching and touched bodies; the extent of the model if neither has one. Parts count for nothing: a sheet
    /// may be pressed in by more than its thickness and is still on its side.
    pub fn size_of_bodies(&self) -> f64 {
        let parts = &self.scene.parts.list;
        let nodes = parts.iter().flat_map(|part| (0..part.elements()).flat_map(|element| part.nodes(element)));
        let of_parts: HashSet<usize> = nodes.copied().collect();
        self.smallest(|point| !point.nodes().iter().any(|node| of_parts.contains(node)))
    }

    /// The smallest dimension of the touching and touched sides; the extent of the model if neither has one.
    fn size(&self) -> f64 {
        self.smallest(|_| true)
    }

    /// The smallest dimension over the points that count.
    fn smallest(&self, counts: impl Fn(&ContactPoint) -> bool) -> f64 {
        let body = |point: &ContactPoint| {
            let root = self.topology.root(point.nodes[0]);
            let body = &self.scene.bodies[Body::at(&self.scene.bodies, root)?];
            let points = body.shape.outline().points;
            let width = |i: usize| {
                let side = points.iter().map(|p| p[i]);
                side.clone().fold(f64::NEG_INFINITY, f64::max) - side.fold(f64::INFINITY, f64::min)
            };
            Some((0..3).map(width).fold(f64::INFINITY, f64::min)).filter(|width| *width > 0.0)
        };
        let of_point = |point: &ContactPoint| match point.radius {
            radius if radius > 0.0 => 2.0 * radius,
            _ => body(point).unwrap_or(f64::INFINITY),
        };
        let points = self.points.iter().filter(|point| counts(point)).map(of_point).fold(f64::INFINITY, f64::min);
        let size = points.min(self.opposite.least());
        if size.is_finite() { size } else { self.extent() }
    }

    /// The largest extent of the scene; of one point, a length of one.
    fn extent(&self) -> f64 {
        let first = self.topology.x(0);
        let extent = self.topology.list.iter().map(|node| (node.x - first).norm()).fold(0.0, f64::max);
        if extent > 0.0 { extent } else { 1.0 }
    }

    /// The duration of the run, over all stages, so that stages have one stiffness.
    fn duration(&self) -> f64 {
        match self.scene.stage {
            Some(stage) => stage.sequence.end(),
            None => self.scene.analysis.duration(),
        }
    }

    /// The deck with the tables of all stages.
    fn whole_deck(&self) -> &Deck {
        self.scene.stage.map_or(self.scene.deck, |stage| stage.sequence.whole)
    }

    /// The initial velocity and angular velocity of a node in the deck, in any stage.
    fn begins_with(&self, node: usize) -> [Vec3; 2] {
        let of_body = Body::at(&self.scene.bodies, node);
        match of_body.and_then(|index| self.whole_deck().bodies.get(index)) {
            Some(body) if self.scene.stage.is_some() => [&body.velocity, &body.angular_velocity].map(vec3_or_zero),
            _ => {
                let node = &self.topology.list[node];
                [node.v, node.omega]
            }
        }
    }

    /// The speed of the impact to come, as far as the deck says: velocities at t = 0, and the fall through the gap.
    fn speed(&self) -> f64 {
        let carrier = self.opposite.node();
        let velocity = |x: &Vec3, node: usize| {
            let root = self.topology.root(node);
            let [v, omega] = self.begins_with(root);
            v + omega.cross(&(x - self.topology.list[root].x))
        };
        let mut fastest = 0.0f64;
        for point in self.points {
            let parts = || point.nodes().iter().zip(point.weights);
            let x: Vec3 = parts().map(|(&node, w)| w * self.topology.x(node)).sum();
            let v: Vec3 = parts().map(|(&node, w)| w * velocity(&x, node)).sum();
            fastest = fastest.max((v - velocity(&x, carrier)).norm());
        }
        let gap = self.opposite.gap(self.points, self.topology);
        let fall = if gap.is_finite() { 2.0 * self.gravity * gap.max(0.0) } else { 0.0 };
        let thrown = fastest + self.given_speed();
        (thrown * thrown + fall).sqrt()
    }

    /// The largest velocity that tables of initial motion give.
    fn given_speed(&self) -> f64 {
        let of = |table: &deck::initial::Initial| {
            let v = table.velocity.as_ref().map_or(0.0, |at| vec3(at).norm());
            let spin = table.angular_velocity.as_ref().map_or(0.0, |at| vec3(at).norm());
            v + table.normal_velocity.as_ref().map_or(0.0, |at| at.value.abs()) + spin * self.size()
        };
        self.whole_deck().initial.iter().map(|table| of(table)).fold(0.0, f64::max)
    }
}
