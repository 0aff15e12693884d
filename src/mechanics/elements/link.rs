//! Springs and dampers between two points: a force N(δ) + D(δ̇) along the line of the points or along a fixed direction.

use super::block::{Branches, Elements, FailureCause, Force, Mechanics, Moduli, Results, subtract};
use super::damper::Damper;
use super::link_failure::{self, LinkFailure, has_failed};
use super::memories::places;
use crate::materials::{Dissipation, FAILED_STIFFNESS};
use crate::state::{Configuration, Node, elongation, stretch};
use base::math::Vec3;
use std::ops::Range;

/// The force N over the elongation δ; tension and elongation are positive.
#[derive(Debug, Clone, PartialEq)]
pub enum LinkLaw {
    /// N = k δ + preload.
    Linear {
        /// k, force per length.
        stiffness: f64,
        /// The force at δ = 0.
        preload: f64,
    },
    /// Linear between the points (δ, N); the end slopes continue beyond them.
    Table {
        /// The points (δ, N), at least two, δ rising.
        points: Vec<[f64; 2]>,
    },
    /// N = k (δ + gap) for δ ≤ −gap, else zero. A link that just touches is closed, because only a closed link can carry pressure.
    CompressionOnly {
        /// k, force per length.
        stiffness: f64,
        /// Shortening of the link at closing.
        gap: f64,
    },
    /// N = k (δ − gap) for δ ≥ gap, else zero.
    TensionOnly {
        /// k, force per length.
        stiffness: f64,
        /// Elongation of the link at closing.
        gap: f64,
    },
}

impl LinkLaw {
    /// N and dN/dδ.
    #[inline]
    pub fn force(&self, delta: f64) -> (f64, f64) {
        match self {
            LinkLaw::Linear { stiffness, preload } => (stiffness * delta + preload, *stiffness),
            LinkLaw::CompressionOnly { stiffness, gap } if delta <= -gap => (stiffness * (delta + gap), *stiffness),
            LinkLaw::TensionOnly { stiffness, gap } if delta >= *gap => (stiffness * (delta - gap), *stiffness),
            LinkLaw::CompressionOnly { .. } | LinkLaw::TensionOnly { .. } => (0.0, 0.0),
            LinkLaw::Table { points } => {
                let i = points.partition_point(|p| p[0] <= delta).clamp(1, points.len() - 1);
                let [[x0, y0], [x1, y1]] = [points[i - 1], points[i]];
                let slope = (y1 - y0) / (x1 - x0);
                (y0 + slope * (delta - x0), slope)
            }
        }
    }

    /// Number of elongations with a jump of dN/dδ.
    pub fn kinks(&self) -> usize {
        match self {
            LinkLaw::Linear { .. } => 0,
            LinkLaw::CompressionOnly { .. } | LinkLaw::TensionOnly { .. } => 1,
            LinkLaw::Table { points } => points.len() - 2,
        }
    }

    /// Number of them below an elongation.
    pub fn branch(&self, delta: f64) -> usize {
        match self {
            LinkLaw::Linear { .. } => 0,
            LinkLaw::CompressionOnly { gap, .. } => usize::from(delta > -gap),
            LinkLaw::TensionOnly { gap, .. } => usize::from(delta >= *gap),
            LinkLaw::Table { points } => points[1..points.len() - 1].partition_point(|point| point[0] <= delta),
        }
    }

    /// ∫ N dδ from 0 to δ.
    pub fn energy(&self, delta: f64) -> f64 {
        match self {
            LinkLaw::Linear { stiffness, preload } => (0.5 * stiffness * delta + preload) * delta,
            LinkLaw::CompressionOnly { stiffness, gap } => 0.5 * stiffness * (delta + gap).min(0.0).powi(2),
            LinkLaw::TensionOnly { stiffness, gap } => 0.5 * stiffness * (delta - gap).max(0.0).powi(2),
            LinkLaw::Table { points } => {
                // Trapezoids between 0, the points of the table and δ are exact.
                let (low, high) = (delta.min(0.0), delta.max(0.0));
                let (mut at, mut sum) = (low, 0.0);
                for x in points.iter().map(|p| p[0]).filter(|x| (low..high).contains(x)).chain([high]) {
                    sum += 0.5 * (self.force(at).0 + self.force(x).0) * (x - at);
                    at = x;
                }
                if delta < 0.0 { -sum } else { sum }
            }
        }
    }

    /// The force with a damper and a factor `beta` on the stiffness. A one-sided link has no force when open, and its damper never changes the sign of the force.
    #[inline]
    fn damped_force(&self, delta: f64, rate: f64, damper: &Damper, beta: f64) -> LinkForce {
        let (elastic, stiffness) = self.force(delta);
        // A table may fall; its damper must not drive it.
        let beside = beta * stiffness.max(0.0);
        let (resisting, slope) = damper.force(rate);
        let (damped, damping) = (resisting + beside * rate, slope + beside);
        let open = LinkForce { force: 0.0, elastic, stiffness: 0.0, damping: 0.0 };
        match self {
            LinkLaw::CompressionOnly { .. } if stiffness == 0.0 || elastic + damped > 0.0 => open,
            LinkLaw::TensionOnly { .. } if stiffness == 0.0 || elastic + damped < 0.0 => open,
            _ => LinkForce { force: elastic + damped, elastic, stiffness, damping },
        }
    }
}

/// Writes the matrix of two nodes between which `k` acts.
pub(super) fn set_pair(k: &base::math::Mat3, K: &mut [f64]) {
    for i in 0..3 {
        for j in 0..3 {
            K[6 * i + j] = k[(i, j)];
            K[6 * i + 3 + j] = -k[(i, j)];
            K[6 * (3 + i) + j] = -k[(i, j)];
            K[6 * (3 + i) + 3 + j] = k[(i, j)];
        }
    }
}

/// Writes the matrix of two nodes with the stiffness `k` between them, and of a third node whose displacement along x adds `taken` times
/// itself to the elongation. The force has the derivative `axial` by that, and `by_end` by the position of the second node; it acts along `e`.
fn set_taken_up(k: &base::math::Mat3, (axial, taken): (f64, f64), (e, by_end): (&Vec3, &Vec3), K: &mut [f64]) {
    K.fill(0.0);
    for i in 0..3 {
        for j in 0..3 {
            for (row, column, sign) in [(0, 0, 1.0), (0, 3, -1.0), (3, 0, -1.0), (3, 3, 1.0)] {
                K[9 * (row + i) + column + j] = sign * k[(i, j)];
            }
        }
        for (row, sign) in [(0, -1.0), (3, 1.0)] {
            K[9 * (row + i) + 6] = sign * (taken * axial) * e[i];
            K[9 * 6 + row + i] = sign * taken * by_end[i];
        }
    }
    K[9 * 6 + 6] = taken * (taken * axial);
}

/// The force of a link and its derivatives.
struct LinkForce {
    force: f64,
    /// The part of the spring.
    elastic: f64,
    /// ∂force/∂δ.
    stiffness: f64,
    /// ∂force/∂δ̇.
    damping: f64,
}

/// One link between two nodes.
#[derive(Debug, Clone)]
pub struct Link {
    /// The two nodes.
    pub nodes: [usize; 2],
    /// The force as a function of the elongation.
    pub law: LinkLaw,
    /// The force against the rate of elongation.
    pub damper: Damper,
    /// Rayleigh's factor on the stiffness (time).
    beta: f64,
    /// A unit vector fixed in space along which the link acts; none for the line of the nodes.
    pub direction: Option<Vec3>,
    /// Failure force; `None` without failure.
    failure: Option<LinkFailure>,
    /// With pretension or a temperature: its nodes, with the node whose displacement along x is taken up.
    take_up: Option<[usize; 3]>,
    /// Length taken up per displacement of that node, and its position at t = 0.
    taken: f64,
    number: Vec3,
    /// Positions of its nodes at t = 0.
    start: [Vec3; 2],
    /// The vector from the first to the second then.
    span: Vec3,
    /// Length at t = 0, or its projection on `direction`.
    initial_length: f64,
    /// Elongation at t = 0.
    initial_elongation: f64,
}

/// The line of a link and its elongation.
pub(super) struct LinkAxis {
    /// Unit vector from the first node to the second, or the fixed direction.
    pub e: Vec3,
    /// Distance of the nodes along it.
    pub length: f64,
    /// δ.
    pub delta: f64,
    /// δ̇.
    pub rate: f64,
    /// Velocity of the second node less that of the first.
    pub dv: Vec3,
}

impl Link {
    /// `free_length`: length, or its projection on `direction`, at zero elongation; `start`: positions of the nodes at t = 0.
    pub fn new(
        nodes: [usize; 2],
        law: LinkLaw,
        damper: Damper,
        direction: Option<Vec3>,
        free_length: f64,
        start: [Vec3; 2],
    ) -> Self {
        let span = start[1] - start[0];
        let initial_length = direction.map_or_else(|| span.norm(), |d| d.dot(&span));
        let elongation = initial_length - free_length;
        // Rounding of coordinates must not open a touching link.
        let touching = match law {
            LinkLaw::CompressionOnly { gap, .. } => Some(-gap),
            LinkLaw::TensionOnly { gap, .. } => Some(gap),
            _ => None,
        };
        let rounding = 1e-12 * initial_length.abs().max(free_length.abs());
        let initial_elongation = touching.filter(|at| (elongation - at).abs() <= rounding).unwrap_or(elongation);
        let (beta, failure, take_up, taken) = (0.0, None, None, 1.0);
        Link {
            nodes,
            law,
            damper,
            beta,
            direction,
            failure,
            take_up,
            taken,
            number: start[0],
            start,
            span,
            initial_length,
            initial_elongation,
        }
    }

    /// Returns the link with a factor on its stiffness, a time, for damping beside its damper.
    pub fn damped_by(self, beta: f64) -> Link {
        Link { beta, ..self }
    }

    /// True where its force depends on the rate.
    fn is_damped(&self) -> bool {
        self.damper.coefficient > 0.0
            || (self.beta > 0.0 && !matches!(self.law, LinkLaw::Linear { stiffness: 0.0, .. }))
    }

    /// Returns the link with a node for take-up: its displacement along x adds to the elongation of the ends.
    pub fn taken_up(self, node: Option<usize>) -> Link {
        let [a, b] = self.nodes;
        Link { take_up: node.map(|node| [a, b, node]), ..self }
    }

    /// Returns the link with the number of its temperature, see [`super::heat`]: a node, which lay at `number`, whose displacement adds
    /// `growth` times itself to the length without force.
    pub fn heated(self, node: usize, number: Vec3, growth: f64) -> Link {
        Link { taken: -growth, number, ..self.taken_up(Some(node)) }
    }

    /// True for a link with take-up by a node.
    pub fn is_taken_up(&self) -> bool {
        self.take_up.is_some()
    }

    #[inline]
    pub(super) fn line(&self, nodes: &[Node]) -> LinkAxis {
        let [a, b] = self.nodes.map(|n| &nodes[n]);
        let (dx, dv) = (b.relative_position(a), b.v - a.v);
        // Displacements have more digits than positions, so the elongation is computed from them.
        let u = stretch(a, b, &self.start);
        let (e, length, more) = match self.direction {
            Some(d) => (d, d.dot(&dx), d.dot(&u)),
            None => {
                let length = dx.norm();
                // Coincident points define no direction: there is no force until they separate.
                let e = if length > 0.0 { dx / length } else { Vec3::zeros() };
                (e, length, elongation(&self.span, self.initial_length, &u, length))
            }
        };
        let (mut delta, mut rate) = (self.initial_elongation + more, e.dot(&dv));
        if let Some([.., node]) = self.take_up {
            delta += self.taken * nodes[node].moved(&self.number).x;
            rate += self.taken * nodes[node].v.x;
        }
        LinkAxis { e, length, delta, rate, dv }
    }

    /// Elongation including the length taken up, its rate, and the force with damper; tension is positive. `memory`: its history variables.
    pub fn state(&self, nodes: &[Node], memory: &[f64]) -> (f64, f64, f64) {
        let line = self.line(nodes);
        (line.delta, line.rate, self.force(&line, memory).force)
    }

    /// Returns the link with `failure`.
    pub fn failing(self, failure: Option<LinkFailure>) -> Link {
        Link { failure, ..self }
    }

    /// The number of its history variables.
    pub fn memory(&self) -> usize {
        if self.failure.is_some() { link_failure::MEMORY } else { 0 }
    }

    /// The force at an elongation, none where the link has failed.
    #[inline]
    fn force(&self, line: &LinkAxis, memory: &[f64]) -> LinkForce {
        let acting = self.law.damped_force(line.delta, line.rate, &self.damper, self.beta);
        match has_failed(memory) {
            true => {
                LinkForce { force: 0.0, elastic: 0.0, stiffness: FAILED_STIFFNESS * acting.stiffness, damping: 0.0 }
            }
            false => acting,
        }
    }

    /// Unit vector from the first node to the second, or the fixed direction; global components.
    pub fn axis(&self, nodes: &[Node]) -> Vec3 {
        self.line(nodes).e
    }
}

/// A group of links, and of elastic bars, which are links of stiffness EA/L.
pub struct Links {
    links: Vec<Link>,
    /// The history variables of each; none where no link has any.
    memories: Vec<Range<usize>>,
}

impl Links {
    /// A group of these links.
    pub fn new(links: Vec<Link>) -> Links {
        let remembers = links.iter().any(|link| link.memory() > 0);
        let memories = if remembers { places(links.iter().map(Link::memory)) } else { Vec::new() };
        Links { links, memories }
    }

    /// Each link with its history variables.
    #[inline]
    fn with_memory<'a>(&'a self, history: &'a [f64]) -> impl Iterator<Item = (&'a Link, &'a [f64])> {
        self.links.iter().enumerate().map(|(e, link)| (link, self.memory(e, history)))
    }

    /// The history variables of a link.
    #[inline]
    fn memory<'a>(&self, e: usize, history: &'a [f64]) -> &'a [f64] {
        // Where nothing is remembered yet nothing has failed.
        self.memories.get(e).and_then(|range| history.get(range.clone())).unwrap_or(&[])
    }
}

impl Elements for Links {
    fn len(&self) -> usize {
        self.links.len()
    }

    fn nodes(&self, e: usize) -> &[usize] {
        let link = &self.links[e];
        link.take_up.as_ref().map_or(&link.nodes[..], |nodes| nodes)
    }

    fn dofs(&self) -> usize {
        3
    }

    fn fixed_direction(&self, e: usize) -> Option<Vec3> {
        self.links[e].direction
    }
}

impl Mechanics for Links {
    fn is_linear(&self) -> bool {
        self.memories.is_empty()
            && self.links.iter().all(|link| {
                link.direction.is_some() && matches!(link.law, LinkLaw::Linear { .. }) && link.damper.is_linear()
            })
    }

    fn is_damped(&self) -> bool {
        self.links.iter().any(Link::is_damped)
    }

    fn damps_most_at_rest(&self) -> bool {
        self.links.iter().any(|link| link.damper.is_steepest_at_rest())
    }

    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]) {
        for (link, memory) in self.with_memory(now.history) {
            let line = link.line(now.nodes);
            let force = link.force(&line, memory).force;
            let f = force * line.e;
            subtract(&mut F[link.nodes[0]], 0, &-f);
            subtract(&mut F[link.nodes[1]], 0, &f);
            if let Some([.., node]) = link.take_up {
                F[node][0] -= link.taken * force;
            }
        }
    }

    fn tangent(&self, e: usize, now: &Configuration, rate_weight: f64, _: Moduli, K: &mut [f64]) {
        let link = &self.links[e];
        let line = link.line(now.nodes);
        let r = link.force(&line, self.memory(e, now.history));
        let along = line.e * line.e.transpose();
        let axial = r.stiffness + rate_weight * r.damping;
        let mut k = axial * along;
        let mut by_end = axial * line.e;
        if link.direction.is_none() && line.length > 0.0 {
            let across = (base::math::Mat3::identity() - along) / line.length;
            k += r.force * across + r.damping * line.e * (across * line.dv).transpose();
            by_end += r.damping * across * line.dv;
        }
        match link.is_taken_up() {
            true => set_taken_up(&k, (axial, link.taken), (&line.e, &by_end), K),
            false => set_pair(&k, K),
        }
    }

    fn stressed_tangent(&self, e: usize, now: &Configuration, stressed: &[Node], K: &mut [f64]) {
        let link = &self.links[e];
        let line = link.line(now.nodes);
        if has_failed(self.memory(e, now.history)) {
            return self.tangent(e, now, 0.0, Moduli::Elastic, K);
        }
        let axial = link.law.force(line.delta).1;
        let mut k = axial * line.e * line.e.transpose();
        if link.direction.is_none() && line.length > 0.0 {
            let across = (base::math::Mat3::identity() - line.e * line.e.transpose()) / line.length;
            k += link.law.force(link.line(stressed).delta).0 * across;
        }
        match link.is_taken_up() {
            true => set_taken_up(&k, (axial, link.taken), (&line.e, &(axial * line.e)), K),
            false => set_pair(&k, K),
        }
    }

    fn history(&self) -> usize {
        self.memories.last().map_or(0, |last| last.end)
    }

    fn update_history(&self, now: &Configuration, _: f64, new: &mut [f64]) -> Dissipation {
        new.copy_from_slice(now.history);
        let mut lost = Dissipation::default();
        for (link, memory) in self.links.iter().zip(&self.memories) {
            let memory = &mut new[memory.clone()];
            let Some(failure) = link.failure.filter(|_| !has_failed(memory)) else { continue };
            let line = link.line(now.nodes);
            let force = link.force(&line, memory).force;
            if failure.is_reached(force, 0.0) {
                memory.copy_from_slice(&[force, 0.0]);
                lost.eroded += link.law.energy(line.delta);
            }
        }
        lost
    }
}

impl Results for Links {
    fn axial_force(&self, e: usize, now: &Configuration) -> Option<f64> {
        let link = &self.links[e];
        Some(link.force(&link.line(now.nodes), self.memory(e, now.history)).force)
    }

    fn energy(&self, now: &Configuration) -> f64 {
        let whole = self.with_memory(now.history).filter(|(_, memory)| !has_failed(memory));
        whole.map(|(link, _)| link.law.energy(link.line(now.nodes).delta)).sum()
    }

    fn damping_power(&self, now: &Configuration) -> f64 {
        let power = |(link, memory): (&Link, &[f64])| {
            let line = link.line(now.nodes);
            let r = link.force(&line, memory);
            (r.force - r.elastic) * line.rate
        };
        self.with_memory(now.history).filter(|(link, _)| link.is_damped()).map(power).sum()
    }

    fn can_fail(&self) -> bool {
        !self.memories.is_empty()
    }

    fn has_failed(&self, e: usize, history: &[f64]) -> bool {
        has_failed(self.memory(e, history))
    }

    fn failure_cause(&self, e: usize, history: &[f64]) -> FailureCause {
        link_failure::cause(self.memory(e, history))
    }
}

impl Branches for Links {
    fn is_inactive(&self, e: usize, now: &Configuration) -> bool {
        let link = &self.links[e];
        let one_sided = matches!(link.law, LinkLaw::CompressionOnly { .. } | LinkLaw::TensionOnly { .. });
        one_sided && link.law.force(link.line(now.nodes).delta).1 == 0.0
    }

    fn has_kinks(&self) -> bool {
        self.links.iter().any(|link| link.failure.is_some() || link.law.kinks() > 0)
    }

    fn branches(&self, now: &Configuration) -> usize {
        self.links.iter().map(|link| link.law.branch(link.line(now.nodes).delta)).sum()
    }

    fn is_turned_over(&self, e: usize, before: &[Node], now: &[Node]) -> bool {
        let link = &self.links[e];
        let line = link.line(now);
        // A link that pulls at every length, or is slack, may pass through itself.
        let pushes = link.law.force(line.delta - line.length).0 < 0.0;
        link.direction.is_none() && pushes && link.line(before).e.dot(&line.e) < 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energy_is_the_integral_of_the_force() {
        let laws = [
            LinkLaw::Linear { stiffness: 3.0, preload: -0.4 },
            LinkLaw::Table { points: vec![[-1.0, -5.0], [0.2, 0.1], [0.5, 3.0]] },
            LinkLaw::CompressionOnly { stiffness: 2.0, gap: 0.1 },
            LinkLaw::TensionOnly { stiffness: 2.0, gap: 0.1 },
        ];
        for law in &laws {
            for delta in [-2.0, -0.3, -0.05, 0.0, 0.05, 0.3, 2.0] {
                // The laws are straight between kinks: 4000 midpoints leave at most one cell per kink, 1e-6 of the energy.
                let n = 4000;
                let h = delta / n as f64;
                let sum: f64 = (0..n).map(|i| law.force((i as f64 + 0.5) * h).0 * h).sum();
                assert!((law.energy(delta) - sum).abs() < 1e-5, "{law:?} at {delta}");
            }
        }
    }

    #[test]
    fn one_sided_links_never_pull_the_wrong_way() {
        let bumper = LinkLaw::CompressionOnly { stiffness: 10.0, gap: 0.0 };
        assert_eq!(bumper.damped_force(0.1, -1.0, &Damper::linear(5.0), 0.0).force, 0.0);
        assert_eq!(bumper.damped_force(-0.1, 1.0, &Damper::linear(5.0), 0.0).force, 0.0);
        assert_eq!(bumper.damped_force(-0.1, -1.0, &Damper::linear(5.0), 0.0).force, -6.0);
    }
}
