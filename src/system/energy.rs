//! Energies and momenta of a state.

use super::equations::System;
use super::thread_partition;
use crate::math::Vec3;
use crate::model::{Model, Part, PartKind};
use crate::state::{Configuration, State};

/// The columns of energy.csv.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Energy {
    pub kinetic: f64,
    /// Elastic energy of beams and bars, and what kinematic hardening keeps.
    pub strain: f64,
    /// Dissipated so far by plastic flow.
    pub plastic: f64,
    /// Dissipated so far by viscous flow.
    pub viscoplastic: f64,
    /// Dissipated so far by dampers, nodal and Rayleigh damping.
    pub damping: f64,
    /// Stored in links.
    pub links: f64,
    /// Work of loads, gravity and prescribed motion so far.
    pub external: f64,
    /// What the time integration has taken: initial energy + external − dissipated − stored.
    pub numerical: f64,
    /// kinetic + strain + links + contact.
    pub mechanical: f64,
    /// Linear momentum.
    pub p: Vec3,
    /// Angular momentum about the origin.
    pub l: Vec3,
    /// Stored in contacts.
    pub contact: f64,
    /// Dissipated so far by friction.
    pub friction: f64,
    /// Dissipated so far in impacts.
    pub impact: f64,
    /// [`crate::state::Work::verlet_energy_offset`]. Not a column.
    pub verlet_energy_offset: f64,
}

impl Energy {
    /// What the time integration has taken: `numerical` but for what swings with the motion. Velocity Verlet keeps
    /// ½ vᵀMv + ½ uᵀKu − ⅛ Δt² aᵀMa of linear motion, so energies at a step swing by the last of these: by up to
    /// 1/(1 − (ωΔt/2)²), which is nearly three at 0.8 of the limit.
    pub fn numerical_dissipation(&self) -> f64 {
        self.numerical + self.verlet_energy_offset
    }
}

/// What the time integration has made of energies, over a run.
#[derive(Debug, Clone, Copy, Default)]
pub struct Balance {
    /// The most that it took, and that it made.
    pub dissipated: f64,
    pub generated: f64,
    /// The most energy there was.
    pub peak: f64,
    /// What there was at the start, and the most that was put in or let go since: no more can move.
    pub available: f64,
    /// Dissipated by plastic flow.
    pub plastic: f64,
    start: Option<f64>,
    external: f64,
    released: f64,
}

impl Balance {
    /// The work of what acts from outside, which is known in every step: energies are summed at some only, and by then it may have
    /// been given back.
    pub fn update_work(&mut self, external: f64) {
        self.external = self.external.max(external.abs());
        self.peak = self.peak.max(external.abs());
    }

    pub fn update(&mut self, energy: &Energy) {
        let stored = energy.strain + energy.links + energy.contact;
        let sizes = energy.strain.abs() + energy.links.abs() + energy.contact.abs();
        let start = *self.start.get_or_insert(energy.kinetic + stored.abs());
        self.update_work(energy.external);
        // Less than nothing is stored where preloads give way.
        self.released = self.released.max(-stored);
        self.available = start + self.external + self.released;
        self.plastic = energy.plastic;
        let dissipated = energy.numerical_dissipation();
        self.dissipated = self.dissipated.max(dissipated);
        // A mode beyond the limit of stability may keep what central differences keep, and grow: then what moves tells.
        self.generated = self.generated.max(-dissipated).max(energy.kinetic - self.available);
        // Where the total is zero by chance, or external work, the motion is not.
        self.peak = self.peak.max(energy.mechanical.abs()).max(energy.kinetic).max(sizes);
    }
}

/// Elastic energy of a part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PartEnergy {
    /// Place in [`Model::parts`]; of a shell with triangles and quadrilaterals that of the first of the two.
    pub part: usize,
    pub strain: f64,
}

impl PartEnergy {
    pub fn of<'m>(&self, model: &'m Model) -> &'m Part {
        &model.parts[self.part]
    }
}

impl System {
    /// Elastic energy of each beam, bar and shell, in deck order; without what kinematic hardening keeps.
    pub fn part_energies(&self, model: &Model, now: &Configuration, parts: &mut Vec<PartEnergy>) {
        for group in self.groups.iter().filter(|group| group.kind.is_deformable()) {
            let energy = group.block.energy(&group.share(now));
            let part = &model.parts[group.part];
            match parts.last_mut() {
                Some(last) if last.of(model).is_one_with(part) => last.strain += energy,
                _ => parts.push(PartEnergy { part: group.part, strain: energy }),
            }
        }
    }

    /// `initial`: the total at t = 0, against which the balance is drawn.
    pub fn energy(&self, state: &State, initial: Option<f64>, threads: usize) -> Energy {
        let (nodes, now, work) = (&state.nodes, state.configuration(), state.work);
        let stored = |of: &(dyn Fn(PartKind) -> bool + Sync)| -> f64 {
            thread_partition::sum(&self.groups, self.splits(threads), &|group| match of(group.kind) {
                true => group.block.energy(&group.share(&now)),
                false => 0.0,
            })
        };
        let strain = stored(&PartKind::is_deformable) + work.material.stored;
        let links = stored(&|kind| kind == PartKind::Link);
        let contact = if self.has_contacts() { stored(&|kind| kind == PartKind::Contact) } else { 0.0 };
        let mut kinetic = 0.0;
        let (mut p, mut l) = (Vec3::zeros(), Vec3::zeros());
        for inertia in &self.inertias {
            let node = &nodes[inertia.node];
            kinetic += inertia.kinetic_energy(node);
            let momentum = inertia.mass * node.v;
            p += momentum;
            l += node.x.cross(&momentum);
            if inertia.rotary {
                l += inertia.J(node) * node.omega;
            }
        }
        for mass in &self.consistent {
            kinetic += mass.kinetic_energy(nodes);
            let (dp, dl) = mass.momentum(nodes);
            p += dp;
            l += dl;
        }
        if !self.dynamic {
            (kinetic, p, l) = (0.0, Vec3::zeros(), Vec3::zeros());
        }
        let mechanical = kinetic + strain + links + contact;
        Energy {
            kinetic,
            strain,
            plastic: work.material.plastic,
            viscoplastic: work.material.viscous,
            damping: work.damping,
            links,
            external: work.external,
            numerical: initial.unwrap_or(mechanical) + work.external
                - work.damping
                - work.material.plastic
                - work.material.viscous
                - work.material.friction
                - work.material.impact
                - mechanical,
            mechanical,
            p,
            l,
            contact,
            friction: work.material.friction,
            impact: work.material.impact,
            verlet_energy_offset: work.verlet_energy_offset,
        }
    }
}
