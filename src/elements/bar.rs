//! Bar or cable: a straight two-node element that only resists stretching, N = A σ(ε) with ε = (l − L)/L.

use super::link::{Law as LinkLaw, Link, Links};
use super::{ElementBlock, Force, Moduli, subtract};
use crate::materials::{Bar, Dissipation, Law};
use crate::math::{Mat3, Vec3};
use crate::state::{Configuration, Node, elongation, stretch};

/// An elastic bar is a line spring of stiffness EA/L, L its length without force, `free` times that at t = 0; `damping` is the
/// factor of stiffness-proportional damping (time).
pub fn links(
    elements: &[[usize; 2]],
    axial_stiffness: f64,
    tension_only: bool,
    free: f64,
    x: &[Vec3],
    damping: f64,
) -> Links {
    let link = |&nodes: &[usize; 2]| {
        let start = nodes.map(|node| x[node]);
        let length = free * (start[1] - start[0]).norm();
        let stiffness = axial_stiffness / length;
        let law = match tension_only {
            true => LinkLaw::TensionOnly { stiffness, gap: 0.0 },
            false => LinkLaw::Linear { stiffness, preload: 0.0 },
        };
        Link::new(nodes, law, damping * stiffness, None, length, start)
    };
    Links(elements.iter().map(link).collect())
}

/// Bars whose material yields. A bar that only takes tension goes slack where its elastic strain would be compressive, and
/// keeps the length to which it has yielded.
pub struct YieldingBars {
    elements: Vec<Element>,
    area: f64,
    law: Law,
    tension_only: bool,
    /// Factor of stiffness-proportional damping (time).
    damping: f64,
    /// Numbers a bar remembers.
    memory: usize,
}

struct Element {
    nodes: [usize; 2],
    /// Where they lay at t = 0.
    start: [Vec3; 2],
    /// Length without force.
    free: f64,
}

struct Stretch {
    /// Unit vector from the first node to the second.
    e: Vec3,
    length: f64,
    strain: f64,
    strain_rate: f64,
    /// Relative velocity.
    dv: Vec3,
}

impl YieldingBars {
    /// `x`: initial positions of all nodes; `free`: length without force over that at t = 0.
    pub fn new(
        elements: &[[usize; 2]],
        axial_stiffness: f64,
        law: &Law,
        tension_only: bool,
        free: f64,
        x: &[Vec3],
        damping: f64,
    ) -> Self {
        let element = |&nodes: &[usize; 2]| {
            let start = nodes.map(|node| x[node]);
            Element { nodes, start, free: free * (start[1] - start[0]).norm() }
        };
        YieldingBars {
            elements: elements.iter().map(element).collect(),
            area: axial_stiffness / law.elastic().E,
            law: law.clone(),
            tension_only,
            damping,
            memory: law.history(Bar),
        }
    }

    fn stretch(&self, e: usize, nodes: &[Node]) -> Stretch {
        let Element { nodes: ends, start, free } = &self.elements[e];
        let [a, b] = ends.map(|node| &nodes[node]);
        let (dx, dv) = (b.relative_position(a), b.v - a.v);
        let (length, before) = (dx.norm(), start[1] - start[0]);
        let more = elongation(&before, before.norm(), &stretch(a, b, start), length);
        // Points that have met leave the direction open: no force until they part.
        let e = if length > 0.0 { dx / length } else { Vec3::zeros() };
        Stretch { e, length, strain: ((before.norm() - free) + more) / free, strain_rate: e.dot(&dv) / free, dv }
    }

    fn share(&self, e: usize) -> std::ops::Range<usize> {
        e * self.memory..(e + 1) * self.memory
    }

    /// Nothing pulls: the elastic strain is compressive in a bar that only takes tension.
    fn is_slack(&self, strain: f64, past: &[f64]) -> bool {
        self.tension_only && self.law.stress(Bar, &[strain], 0.0, past)[0] <= 0.0 && strain <= past[0]
    }

    /// Tension, of which the first part is the material's, and ∂/∂strain, ∂/∂(strain rate).
    fn tension(&self, at: &Stretch, since: f64, past: &[f64], moduli: Moduli) -> Tension {
        if self.is_slack(at.strain, past) {
            return Tension::default();
        }
        let ([stress], [[modulus]]) = self.law.stress_and_tangent(Bar, &[at.strain], since, past);
        let viscosity = self.damping * self.law.elastic().E;
        let damping = viscosity * at.strain_rate;
        if self.tension_only && stress + damping < 0.0 {
            // Damping takes what the material gives and no more: the bar does not push.
            return Tension { material: self.area * stress, damping: -self.area * stress, ..Tension::default() };
        }
        let modulus = if moduli == Moduli::Elastic { self.law.elastic().E } else { modulus };
        Tension { material: self.area * stress, damping: self.area * damping, modulus, viscosity }
    }
}

#[derive(Default)]
struct Tension {
    material: f64,
    damping: f64,
    modulus: f64,
    viscosity: f64,
}

impl ElementBlock for YieldingBars {
    fn len(&self) -> usize {
        self.elements.len()
    }

    fn nodes(&self, e: usize) -> &[usize] {
        &self.elements[e].nodes
    }

    fn dofs(&self) -> usize {
        3
    }

    fn is_damped(&self) -> bool {
        self.damping > 0.0
    }

    fn history(&self) -> usize {
        self.memory * self.elements.len()
    }

    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]) {
        for (e, Element { nodes: [a, b], .. }) in self.elements.iter().enumerate() {
            let at = self.stretch(e, now.nodes);
            let tension = self.tension(&at, now.dt, &now.history[self.share(e)], Moduli::Algorithmic);
            let f = (tension.material + tension.damping) * at.e;
            subtract(&mut F[*a], 0, &-f);
            subtract(&mut F[*b], 0, &f);
        }
    }

    fn tangent(&self, e: usize, now: &Configuration, rate_weight: f64, moduli: Moduli, K: &mut [f64]) {
        let at = self.stretch(e, now.nodes);
        let free = self.elements[e].free;
        let tension = self.tension(&at, now.dt, &now.history[self.share(e)], moduli);
        let along = at.e * at.e.transpose();
        let mut k = self.area / free * (tension.modulus + rate_weight * tension.viscosity) * along;
        if at.length > 0.0 {
            let across = (Mat3::identity() - along) / at.length;
            let force = tension.material + tension.damping;
            k += force * across + (self.area / free * tension.viscosity) * at.e * (across * at.dv).transpose();
        }
        for i in 0..3 {
            for j in 0..3 {
                K[6 * i + j] = k[(i, j)];
                K[6 * i + 3 + j] = -k[(i, j)];
                K[6 * (3 + i) + j] = -k[(i, j)];
                K[6 * (3 + i) + 3 + j] = k[(i, j)];
            }
        }
    }

    fn update_history(&self, now: &Configuration, part: f64, history: &mut [f64]) -> Dissipation {
        let mut sum = Dissipation::default();
        for (e, new) in history.chunks_exact_mut(self.memory).enumerate() {
            let at = self.stretch(e, now.nodes);
            let past = &now.history[self.share(e)];
            // A slack bar rests at its plastic strain.
            let strain = if self.is_slack(at.strain, past) { past[0] } else { at.strain };
            let (_, spent) = self.law.advance(Bar, &[strain], (now.dt, part), past, new);
            sum += spent * (self.area * self.elements[e].free);
        }
        sum
    }

    fn energy(&self, now: &Configuration) -> f64 {
        let energy = |e: usize| {
            let (at, past) = (self.stretch(e, now.nodes), &now.history[self.share(e)]);
            let slack = self.is_slack(at.strain, past);
            let density = if slack { 0.0 } else { self.law.elastic_energy(Bar, &[at.strain], past) };
            self.area * self.elements[e].free * density
        };
        (0..self.len()).map(energy).sum()
    }

    fn damping_power(&self, now: &Configuration) -> f64 {
        let power = |e: usize| {
            let at = self.stretch(e, now.nodes);
            let past = &now.history[self.share(e)];
            self.tension(&at, now.dt, past, Moduli::Algorithmic).damping * at.strain_rate * self.elements[e].free
        };
        if self.damping > 0.0 { (0..self.len()).map(power).sum() } else { 0.0 }
    }

    fn plastic_strain(&self, e: usize, past: &[f64]) -> f64 {
        self.law.accumulated(Bar, &past[self.share(e)])
    }
}
