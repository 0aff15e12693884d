//! Springs along a line whose force depends on their past, by one of the laws of [`super::path_law`].

use super::block::{Branches, Elements, Force, Mechanics, Moduli, Results, subtract};
use super::link::{Link, set_pair};
use super::memories::places;
pub use super::path_law::PathLaw;
use super::slider::CoordinateState;
use crate::materials::Dissipation;
use crate::state::{Configuration, Node};
use base::math::Mat3;
use std::ops::Range;

/// Force, slope and stored energy at an elongation.
fn at(law: &PathLaw, x: f64, memory: &[f64]) -> CoordinateState {
    let mut state = CoordinateState::at(x, 0.0);
    law.add(memory, &mut state);
    state
}

/// One such link. A link without stiffness gives its line and its damper.
#[derive(Debug, Clone)]
pub struct HystereticLink {
    /// Ends, line and damper.
    pub link: Link,
    /// The force.
    pub law: PathLaw,
    /// Force per rate of elongation beside the damper, by Rayleigh's factor on the stiffness.
    pub beside: f64,
}

impl HystereticLink {
    /// The force of the dampers and its derivative by the rate.
    fn damping(&self, rate: f64) -> (f64, f64) {
        let (force, slope) = self.link.damper.force(rate);
        (force + self.beside * rate, slope + self.beside)
    }

    /// Elongation, its rate, and the force with damper; tension is positive. `memory`: its history variables.
    pub fn state(&self, nodes: &[Node], memory: &[f64]) -> (f64, f64, f64) {
        let line = self.link.line(nodes);
        (line.delta, line.rate, at(&self.law, line.delta, memory).effort + self.damping(line.rate).0)
    }
}

/// A group of such links.
pub struct HystereticLinks {
    links: Vec<HystereticLink>,
    memories: Vec<Range<usize>>,
}

impl HystereticLinks {
    /// A group of these links.
    pub fn new(links: Vec<HystereticLink>) -> HystereticLinks {
        let memories = places(links.iter().map(|link| link.law.memory()));
        HystereticLinks { links, memories }
    }

    fn with_memory<'a>(&'a self, history: &'a [f64]) -> impl Iterator<Item = (&'a HystereticLink, &'a [f64])> {
        self.links.iter().zip(&self.memories).map(|(link, memory)| (link, remembered(memory, history)))
    }
}

/// The history variables of a link; none before the first step.
fn remembered<'a>(memory: &Range<usize>, history: &'a [f64]) -> &'a [f64] {
    history.get(memory.clone()).unwrap_or(&[])
}

impl Elements for HystereticLinks {
    fn len(&self) -> usize {
        self.links.len()
    }

    fn nodes(&self, e: usize) -> &[usize] {
        &self.links[e].link.nodes
    }

    fn dofs(&self) -> usize {
        3
    }

    fn fixed_direction(&self, e: usize) -> Option<base::math::Vec3> {
        self.links[e].link.direction
    }
}

impl Mechanics for HystereticLinks {
    fn history(&self) -> usize {
        self.memories.last().map_or(0, |last| last.end)
    }

    fn is_damped(&self) -> bool {
        self.links.iter().any(|of| of.link.damper.coefficient > 0.0 || of.beside > 0.0)
    }

    fn damps_most_at_rest(&self) -> bool {
        self.links.iter().any(|of| of.link.damper.is_steepest_at_rest())
    }

    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]) {
        for (of, memory) in self.with_memory(now.history) {
            let line = of.link.line(now.nodes);
            let f = (at(&of.law, line.delta, memory).effort + of.damping(line.rate).0) * line.e;
            subtract(&mut F[of.link.nodes[0]], 0, &-f);
            subtract(&mut F[of.link.nodes[1]], 0, &f);
        }
    }

    fn tangent(&self, e: usize, now: &Configuration, rate_weight: f64, moduli: Moduli, K: &mut [f64]) {
        let of = &self.links[e];
        let line = of.link.line(now.nodes);
        let state = at(&of.law, line.delta, remembered(&self.memories[e], now.history));
        let slope = if moduli == Moduli::Elastic { of.law.stiffness() } else { state.by_q };
        let (damping, c) = of.damping(line.rate);
        let along = line.e * line.e.transpose();
        let mut k = (slope + rate_weight * c) * along;
        if of.link.direction.is_none() && line.length > 0.0 {
            let across = (Mat3::identity() - along) / line.length;
            k += (state.effort + damping) * across + c * line.e * (across * line.dv).transpose();
        }
        set_pair(&k, K);
    }

    fn update_history(&self, now: &Configuration, part: f64, new: &mut [f64]) -> Dissipation {
        new.copy_from_slice(now.history);
        let mut lost = Dissipation::default();
        for (of, memory) in self.links.iter().zip(&self.memories) {
            lost.plastic += of.law.follow(of.link.line(now.nodes).delta, part, &mut new[memory.clone()]);
        }
        lost
    }
}

impl Results for HystereticLinks {
    fn axial_force(&self, e: usize, now: &Configuration) -> Option<f64> {
        Some(self.links[e].state(now.nodes, remembered(&self.memories[e], now.history)).2)
    }

    fn energy(&self, now: &Configuration) -> f64 {
        self.with_memory(now.history)
            .map(|(of, memory)| at(&of.law, of.link.line(now.nodes).delta, memory).energy)
            .sum()
    }

    fn damping_power(&self, now: &Configuration) -> f64 {
        let power = |of: &HystereticLink| {
            let rate = of.link.line(now.nodes).rate;
            of.damping(rate).0 * rate
        };
        self.links.iter().map(power).sum()
    }
}

impl Branches for HystereticLinks {
    fn has_kinks(&self) -> bool {
        true
    }

    fn is_turned_over(&self, e: usize, before: &[Node], now: &[Node]) -> bool {
        let link = &self.links[e].link;
        link.direction.is_none() && link.line(before).e.dot(&link.line(now).e) < 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::damper::Damper;
    use crate::elements::hysteresis::Hysteresis;
    use crate::elements::link::LinkLaw;
    use base::math::Vec3;

    /// One end passes the other: along the line of the ends the link is reversed, along a fixed direction it is not.
    #[test]
    fn a_link_that_passes_through_itself_is_turned_over() {
        let law = PathLaw::Backbone(Hysteresis::new(&[[0.1, 1.0]], 0.0).expect("a backbone"));
        for (direction, reversed) in [(None, true), (Some(Vec3::x()), false)] {
            let none = LinkLaw::Linear { stiffness: 0.0, preload: 0.0 };
            let link = Link::new([0, 1], none, Damper::linear(0.0), direction, 1.0, [Vec3::zeros(), Vec3::x()]);
            let block = HystereticLinks::new(vec![HystereticLink { link, law, beside: 0.0 }]);
            let at = |x: f64| [0.0, x].map(|x| Node::at_rest(Vec3::new(x, 0.0, 0.0)));
            assert!(!block.is_turned_over(0, &at(1.0), &at(0.2)));
            assert_eq!(block.is_turned_over(0, &at(0.2), &at(-0.2)), reversed);
        }
    }
}
