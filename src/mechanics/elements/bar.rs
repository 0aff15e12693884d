//! Bar or cable: a straight two-node element with an axial force only, N = A σ(ε) with ε = (l − L)/L, L the length without
//! force.

use super::block::{Branches, Elements, Force, Mechanics, Moduli, Results, subtract};
use super::damper::Damper;
use super::heat::{Heat, HeatNodes};
use super::link::{Link, LinkLaw, Links};
use crate::materials::{Ask, Dissipation, FAILED_STIFFNESS, MaterialLaw, PointResponse, Uniaxial};
use crate::state::{Configuration, Node, elongation, stretch};
use base::math::{Mat3, Vec3};

/// Elastic bars as springs of stiffness EA/L along the line of their nodes. L is `free` times the length at t = 0, and
/// grows by `heat`. `x`: positions of all
/// nodes at t = 0; `damping`: factor of stiffness-proportional damping (time).
pub fn elastic_bars(
    elements: &[[usize; 2]],
    axial_stiffness: f64,
    tension_only: bool,
    (free, heat): (f64, &Heat),
    x: &[Vec3],
    damping: f64,
) -> Links {
    let link = |(e, &nodes): (usize, &[usize; 2])| {
        let start = nodes.map(|node| x[node]);
        let length = free * (start[1] - start[0]).norm();
        let stiffness = axial_stiffness / length;
        let law = match tension_only {
            true => LinkLaw::TensionOnly { stiffness, gap: 0.0 },
            false => LinkLaw::Linear { stiffness, preload: 0.0 },
        };
        let link = Link::new(nodes, law, Damper::linear(damping * stiffness), None, length, start);
        match heat.numbers[0] {
            Some(node) => link.heated(node, x[node], heat.factor(e) * length / heat.length),
            None => link,
        }
    };
    Links::new(elements.iter().enumerate().map(link).collect())
}

/// Bars whose material yields. A tension-only bar goes slack where its elastic strain would be compressive, and keeps its
/// plastic elongation.
pub struct YieldingBars {
    elements: Vec<BarElement>,
    area: f64,
    law: MaterialLaw,
    tension_only: bool,
    /// Factor of stiffness-proportional damping (time).
    damping: f64,
    /// The number of history variables of a bar.
    variables: usize,
    /// Temperatures; `None` where nothing heats the bars.
    heat: Option<HeatNodes>,
}

/// One bar.
struct BarElement {
    nodes: [usize; 2],
    /// Positions of the nodes at t = 0.
    start: [Vec3; 2],
    /// Length without force.
    free: f64,
}

/// Length and strain of a bar, with their rates.
struct BarStrain {
    /// Unit vector from the first node to the second.
    e: Vec3,
    length: f64,
    strain: f64,
    strain_rate: f64,
    /// Velocity of the second node less that of the first.
    dv: Vec3,
}

impl YieldingBars {
    /// `x`: positions of all nodes at t = 0. `free`: length without force over that at t = 0, which `heat` changes. `damping`: factor of stiffness-proportional
    /// damping (time).
    pub fn new(
        elements: &[[usize; 2]],
        (axial_stiffness, law): (f64, &MaterialLaw),
        tension_only: bool,
        (free, heat): (f64, &Heat),
        x: &[Vec3],
        damping: f64,
    ) -> Self {
        let element = |&nodes: &[usize; 2]| {
            let start = nodes.map(|node| x[node]);
            BarElement { nodes, start, free: free * (start[1] - start[0]).norm() }
        };
        YieldingBars {
            elements: elements.iter().map(element).collect(),
            area: axial_stiffness / law.elastic().E,
            law: law.clone(),
            tension_only,
            damping,
            variables: law.history(Uniaxial),
            heat: HeatNodes::new(heat, elements.iter().map(|nodes| &nodes[..]), x),
        }
    }

    fn strain(&self, bar: usize, nodes: &[Node]) -> BarStrain {
        let BarElement { nodes: ends, start, free } = &self.elements[bar];
        let [a, b] = ends.map(|node| &nodes[node]);
        let (dx, dv) = (b.relative_position(a), b.v - a.v);
        let (length, before) = (dx.norm(), start[1] - start[0]);
        let more = elongation(&before, before.norm(), &stretch(a, b, start), length);
        // Coincident points define no direction: there is no force until they separate.
        let e = if length > 0.0 { dx / length } else { Vec3::zeros() };
        let grown = self.heat.as_ref().map_or(0.0, |heat| heat.factor(bar) * heat.strain(nodes)[0]);
        let strain = ((before.norm() - free) + more) / free - grown;
        BarStrain { e, length, strain, strain_rate: e.dot(&dv) / free, dv }
    }

    /// Widens the matrix of a bar by the rows and columns of its temperature.
    fn widen(&self, e: usize, now: &Configuration, K: &mut [f64]) {
        let Some(heat) = &self.heat else { return };
        let at = self.strain(e, now.nodes);
        let modulus = self.tension(&at, now.dt, &now.history[self.history_range(e)], Moduli::Elastic).modulus;
        let factor = heat.factor(e);
        let force = factor * self.area * modulus * at.e;
        heat.widen(3, K, |_, column| {
            column[..3].copy_from_slice(force.as_slice());
            column[3..].copy_from_slice((-force).as_slice());
            [-factor * factor * self.area * modulus * self.elements[e].free, 0.0, 0.0]
        });
    }

    /// The range of the history of the group that bar `e` has.
    fn history_range(&self, e: usize) -> std::ops::Range<usize> {
        e * self.variables..(e + 1) * self.variables
    }

    /// True if a tension-only bar would be in elastic compression, so it has no force.
    fn is_slack(&self, strain: f64, old: &[f64]) -> bool {
        self.tension_only
            && self.law.at_point(Uniaxial, &[strain], (0.0, old), Ask::Stress).stress[0] < 0.0
            && strain <= old[0]
    }

    /// The axial force and its derivatives.
    fn tension(&self, at: &BarStrain, dt: f64, old: &[f64], moduli: Moduli) -> Tension {
        if self.is_slack(at.strain, old) {
            return Tension::default();
        }
        if self.law.has_failed(Uniaxial, old) {
            return Tension { modulus: FAILED_STIFFNESS * self.law.elastic().E, ..Tension::default() };
        }
        let PointResponse { stress: [stress], tangent, .. } =
            self.law.at_point(Uniaxial, &[at.strain], (dt, old), Ask::Tangent);
        let viscosity = self.damping * self.law.elastic().E;
        let damping = viscosity * at.strain_rate;
        if self.tension_only && stress + damping < 0.0 {
            // Damping cancels the force of the material at most: the bar does not push.
            return Tension { material: self.area * stress, damping: -self.area * stress, ..Tension::default() };
        }
        let modulus = tangent.filter(|_| moduli != Moduli::Elastic).map_or(self.law.elastic().E, |[[modulus]]| modulus);
        Tension { material: self.area * stress, damping: self.area * damping, modulus, viscosity }
    }
}

/// Axial force of a bar.
#[derive(Default)]
struct Tension {
    /// Force of the material.
    material: f64,
    /// Force of damping.
    damping: f64,
    /// ∂stress/∂strain.
    modulus: f64,
    /// ∂stress/∂(strain rate).
    viscosity: f64,
}

impl Elements for YieldingBars {
    fn len(&self) -> usize {
        self.elements.len()
    }

    fn nodes(&self, e: usize) -> &[usize] {
        self.heat.as_ref().map_or(&self.elements[e].nodes, |heat| heat.nodes(e))
    }

    fn dofs(&self) -> usize {
        3
    }
}

impl Mechanics for YieldingBars {
    fn is_damped(&self) -> bool {
        self.damping > 0.0
    }

    fn history(&self) -> usize {
        self.variables * self.elements.len()
    }

    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]) {
        for (e, BarElement { nodes: [a, b], .. }) in self.elements.iter().enumerate() {
            let at = self.strain(e, now.nodes);
            let tension = self.tension(&at, now.dt, &now.history[self.history_range(e)], Moduli::Algorithmic);
            let f = (tension.material + tension.damping) * at.e;
            subtract(&mut F[*a], 0, &-f);
            subtract(&mut F[*b], 0, &f);
            if let Some(heat) = &self.heat {
                let work = heat.factor(e) * tension.material * self.elements[e].free;
                heat.subtract_forces(&[work, 0.0, 0.0], F);
            }
        }
    }

    fn tangent(&self, e: usize, now: &Configuration, rate_weight: f64, moduli: Moduli, K: &mut [f64]) {
        let at = self.strain(e, now.nodes);
        let free = self.elements[e].free;
        let tension = self.tension(&at, now.dt, &now.history[self.history_range(e)], moduli);
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
        self.widen(e, now, K);
    }

    fn stressed_tangent(&self, e: usize, now: &Configuration, stressed: &[Node], K: &mut [f64]) {
        let history = &now.history[self.history_range(e)];
        let (at, there) = (self.strain(e, now.nodes), self.strain(e, stressed));
        let along = at.e * at.e.transpose();
        let modulus = self.tension(&at, now.dt, history, Moduli::Elastic).modulus;
        let force = self.tension(&there, now.dt, history, Moduli::Elastic).material;
        let mut k = self.area / self.elements[e].free * modulus * along;
        if at.length > 0.0 {
            k += force / at.length * (Mat3::identity() - along);
        }
        for i in 0..3 {
            for j in 0..3 {
                K[6 * i + j] = k[(i, j)];
                K[6 * i + 3 + j] = -k[(i, j)];
                K[6 * (3 + i) + j] = -k[(i, j)];
                K[6 * (3 + i) + 3 + j] = k[(i, j)];
            }
        }
        self.widen(e, now, K);
    }

    fn update_history(&self, now: &Configuration, part: f64, new: &mut [f64]) -> Dissipation {
        let mut sum = Dissipation::default();
        for (e, new) in new.chunks_exact_mut(self.variables).enumerate() {
            let at = self.strain(e, now.nodes);
            let old = &now.history[self.history_range(e)];
            // The strain of a slack bar is its plastic strain.
            let strain = if self.is_slack(at.strain, old) { old[0] } else { at.strain };
            let answer = self.law.at_point(Uniaxial, &[strain], (now.dt, old), Ask::History(part));
            self.law.remember(Uniaxial, &answer.new, (old, new), |_| 0);
            sum += answer.dissipation.map_or(Dissipation::default(), |spent| spent.lane(0))
                * (self.area * self.elements[e].free);
        }
        sum
    }
}

impl Results for YieldingBars {
    fn axial_force(&self, e: usize, now: &Configuration) -> Option<f64> {
        let old = now.history.get(self.history_range(e))?;
        let tension = self.tension(&self.strain(e, now.nodes), now.dt, old, Moduli::Algorithmic);
        Some(tension.material + tension.damping)
    }

    fn energy(&self, now: &Configuration) -> f64 {
        let energy = |e: usize| {
            let (at, old) = (self.strain(e, now.nodes), &now.history[self.history_range(e)]);
            let slack = self.is_slack(at.strain, old);
            let density = if slack { 0.0 } else { self.law.elastic_energy(Uniaxial, &[at.strain], old) };
            self.area * self.elements[e].free * density
        };
        (0..self.len()).map(energy).sum()
    }

    fn damping_power(&self, now: &Configuration) -> f64 {
        let power = |e: usize| {
            let at = self.strain(e, now.nodes);
            let old = &now.history[self.history_range(e)];
            self.tension(&at, now.dt, old, Moduli::Algorithmic).damping * at.strain_rate * self.elements[e].free
        };
        if self.damping > 0.0 { (0..self.len()).map(power).sum() } else { 0.0 }
    }

    fn plastic_strain(&self, e: usize, history: &[f64]) -> f64 {
        self.law.accumulated(Uniaxial, &history[self.history_range(e)])
    }

    fn can_fail(&self) -> bool {
        self.law.can_fail()
    }

    fn has_failed(&self, e: usize, history: &[f64]) -> bool {
        self.law.has_failed(Uniaxial, &history[self.history_range(e)])
    }
}

impl Branches for YieldingBars {
    fn is_inactive(&self, e: usize, now: &Configuration) -> bool {
        self.is_slack(self.strain(e, now.nodes).strain, &now.history[self.history_range(e)])
    }

    fn has_kinks(&self) -> bool {
        self.tension_only
    }

    fn branches(&self, now: &Configuration) -> usize {
        if self.tension_only { (0..self.len()).filter(|&e| self.is_inactive(e, now)).count() } else { 0 }
    }

    fn is_turned_over(&self, e: usize, before: &[Node], now: &[Node]) -> bool {
        !self.tension_only && self.strain(e, before).e.dot(&self.strain(e, now).e) < 0.0
    }
}
