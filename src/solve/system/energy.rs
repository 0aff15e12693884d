//! The energies and momenta of a state.

use super::equations::System;
use super::inertia::ConsistentMass;
use super::parts::{Storage, storage};
use super::thread_partition;
use crate::tolerances::energy::{GONE, NOTHING_HAPPENS, OF_PEAK, ROUNDING};
use base::math::Vec3;
use base::snapshot::{Keep, Snapshot, keep};
use mechanics::state::{Configuration, Node, State};
use model::{Load, Loading, Model, Part};

/// Energies and momenta at the end of a step: the columns of energy.csv.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Energy {
    /// Kinetic energy.
    pub kinetic: f64,
    /// Elastic energy of beams, bars and shells, with the energy stored by kinematic hardening.
    pub strain: f64,
    /// Energy dissipated so far by plastic flow.
    pub plastic: f64,
    /// Energy dissipated so far by viscoplastic overstress.
    pub viscoplastic: f64,
    /// Energy dissipated so far by dampers, nodal and Rayleigh damping.
    pub damping: f64,
    /// Elastic energy of links.
    pub links: f64,
    /// Work done so far by loads, gravity and prescribed motion.
    pub external: f64,
    /// Algorithmic dissipation, the remainder of the balance: initial energy + external − dissipated − stored.
    pub numerical: f64,
    /// Mechanical energy: kinetic + strain + links + contact.
    pub mechanical: f64,
    /// Linear momentum.
    pub p: Vec3,
    /// Angular momentum about the origin.
    pub l: Vec3,
    /// Elastic energy of contacts.
    pub contact: f64,
    /// Energy dissipated so far by friction.
    pub friction: f64,
    /// Energy dissipated so far in impacts.
    pub impact: f64,
    /// Energy that failed elements and links had stored.
    pub eroded: f64,
    /// Offset of the energies of velocity Verlet, [`mechanics::state::Work::verlet_energy_offset`]. It is not a column.
    pub verlet_energy_offset: f64,
}

impl Energy {
    /// Energies and momenta of a state. `initial` is the mechanical energy at t = 0, the reference of the balance; `None` at t = 0.
    pub fn of(system: &System, state: &State, initial: Option<f64>, threads: usize) -> Energy {
        let (nodes, now, work) = (&state.nodes, state.configuration(), state.work);
        let stored = |column: Storage| -> f64 {
            thread_partition::sum(&system.groups, system.uses_threads(threads), &|group| match storage(group.kind)
                == column
            {
                true => group.block.energy(&group.configuration(&now)),
                false => 0.0,
            })
        };
        let strain = stored(Storage::Strain) + work.material.stored;
        let links = stored(Storage::Links);
        let contact = if system.has_contacts() { stored(Storage::Contacts) } else { 0.0 };
        let (kinetic, p, l) = if system.dynamic { motion(system, nodes) } else { (0.0, Vec3::zeros(), Vec3::zeros()) };
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
                - work.material.eroded
                - mechanical,
            mechanical,
            p,
            l,
            contact,
            friction: work.material.friction,
            impact: work.material.impact,
            eroded: work.material.eroded,
            verlet_energy_offset: work.verlet_energy_offset,
        }
    }

    /// Algorithmic dissipation without the inherent energy oscillation of velocity Verlet. In linear motion it conserves ½ vᵀMv + ½ uᵀKu −
    /// ⅛ Δt² aᵀMa, so the energy at a step oscillates by the last term. The amplitude factor is 1/(1 − (ωΔt/2)²), nearly three at 0.8 of
    /// the stability limit.
    pub fn numerical_dissipation(&self) -> f64 {
        self.numerical + self.verlet_energy_offset
    }
}

/// The energy of motions below the resolution of positions. It sums the work of weight and full loads along a small part of the largest
/// coordinate, and the kinetic energy of velocities that cover this distance.
pub fn work_of_rounding(system: &System, loading: &Loading, nodes: &[Node], duration: f64) -> f64 {
    let reach = nodes.iter().map(|node| node.x.amax()).fold(0.0, f64::max);
    let of_inertias = system.inertias.iter().map(|inertia| inertia.mass).sum::<f64>();
    let of_floating = system.floating().iter().map(|mass| mass.element.total_mass()).sum::<f64>();
    let mass = of_inertias + of_floating + system.consistent.iter().flat_map(|mass| &mass.m).sum::<f64>();
    let of_load = |load: &Load| load.force.norm() * reach + load.moment.norm();
    let of_loads = mass * loading.gravity.norm() * reach + loading.nodal.iter().map(of_load).sum::<f64>();
    let speed = if duration > 0.0 { ROUNDING * reach / duration } else { 0.0 };
    ROUNDING * of_loads + 0.5 * mass * speed * speed
}

/// The mass of the whole scene that has weight, and its center at t = 0; `None` of a scene without any.
pub fn mass_and_center(system: &System, nodes: &[model::Node]) -> Option<(f64, Vec3)> {
    let lumped = system.inertias.iter().map(|inertia| (inertia.weighing, inertia.node));
    let consistent = system.consistent.iter().flat_map(ConsistentMass::pairs).map(|(node, _, mass)| (mass, node));
    let placed = lumped.chain(consistent).map(|(mass, node)| (mass, nodes[node].x));
    let floating = system.floating().iter().map(|mass| (mass.element.total_mass(), mass.element.center()));
    let sum = |(mass, moment): (f64, Vec3), (own, x): (f64, Vec3)| (mass + own, moment + own * x);
    let (mass, moment) = placed.chain(floating).fold((0.0, Vec3::zeros()), sum);
    (mass > 0.0).then(|| (mass, moment / mass))
}

/// The kinetic energy of a motion.
pub fn kinetic_energy(system: &System, nodes: &[Node]) -> f64 {
    motion(system, nodes).0
}

/// Kinetic energy, linear momentum, and angular momentum about the origin.
fn motion(system: &System, nodes: &[Node]) -> (f64, Vec3, Vec3) {
    let mut kinetic = 0.0;
    let (mut p, mut l) = (Vec3::zeros(), Vec3::zeros());
    for inertia in &system.inertias {
        let node = &nodes[inertia.node];
        kinetic += inertia.kinetic_energy(node);
        let momentum = inertia.mass * node.v;
        p += momentum;
        l += node.x.cross(&momentum);
        if inertia.rotary {
            l += inertia.spin(node);
        }
    }
    for mass in &system.consistent {
        kinetic += mass.kinetic_energy(nodes);
        let (dp, dl) = mass.momentum(nodes);
        p += dp;
        l += dl;
    }
    for mass in system.floating() {
        let (own, dp, dl) = mass.motion(nodes);
        kinetic += own;
        p += dp;
        l += dl;
    }
    (kinetic, p, l)
}

/// The largest departures from the balance of energy over a run.
#[derive(Debug, Clone, Copy, Default)]
pub struct Balance {
    /// Largest algorithmic dissipation so far.
    pub dissipated: f64,
    /// Largest energy growth so far.
    pub generated: f64,
    /// Largest energy of any form so far.
    pub peak: f64,
    /// Initial energy plus the largest external work and the largest release from preloads: the motion cannot have
    /// more.
    pub available: f64,
    /// Energy dissipated by plastic flow.
    pub plastic: f64,
    /// Energy dissipated by dampers, nodal and Rayleigh damping.
    pub damping: f64,
    /// Largest excess of mechanical energy over the available energy, which the time integration certainly has added.
    pub raised: f64,
    /// The possible energy of rounding errors, see [`work_of_rounding`]; smaller departures cause no warning.
    pub rounding: f64,
    /// Missing energy of earlier stages, and the work done in them.
    before: [f64; 2],
    start: Option<f64>,
    external: f64,
    released: f64,
    lost: f64,
    /// The energy exchanged by the motion: kinetic energy before numerical losses, stored energy, external work.
    exchanged: [Range; 3],
}

keep!(Balance {
    dissipated,
    generated,
    peak,
    available,
    plastic,
    damping,
    raised,
    rounding,
    before,
    start,
    external,
    released,
    lost,
    exchanged
});

/// The least and the largest value so far.
#[derive(Debug, Clone, Copy, Default)]
struct Range(Option<[f64; 2]>);

impl Keep for Range {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        self.0.keep(snapshot);
    }
}

impl Range {
    fn update(&mut self, value: f64) {
        let [low, high] = self.0.unwrap_or([value; 2]);
        self.0 = Some([low.min(value), high.max(value)]);
    }

    fn width(&self) -> f64 {
        self.0.map_or(0.0, |[low, high]| high - low)
    }
}

impl Balance {
    /// A balance of a stage before which so much has been missed, and so much work done.
    pub fn after(missed: f64, external: f64) -> Balance {
        Balance { before: [missed, external], ..Balance::default() }
    }

    /// True if dampers explain the missing energy and the motion has gained none. Their work is summed from the power at the ends of steps,
    /// which is too much if they stop a motion within a step.
    pub fn is_work_of_dampers(&self, missing: f64) -> bool {
        missing <= self.damping && self.raised < 0.5 * missing
    }

    /// Records the external work of a step. Energies are summed at some steps only, and by then the work may have been given back.
    pub fn update_work(&mut self, external: f64) {
        let external = external - self.before[1];
        self.external = self.external.max(external.abs());
        self.peak = self.peak.max(external.abs());
    }

    /// The reference energy for losses: the largest energy that has changed its form, or entered or left as work. A rigid motion at
    /// constant speed has nothing of it, or it would hide that a vibration dies away. If the loss exceeds all energy that has changed its
    /// form, the steady motion itself loses energy, and the total energy is the reference.
    pub fn motion(&self) -> f64 {
        let exchanged = self.exchanged.iter().map(Range::width).fold(0.0, f64::max);
        if self.lost > GONE * exchanged { self.peak } else { exchanged.max(OF_PEAK * self.peak) }
    }

    /// The missing work of a static analysis against its stored and dissipated energy, and the reference energy: the largest work, or the
    /// largest change of stored energy.
    pub fn missed_in_statics(&self) -> (f64, f64) {
        (self.lost, self.external.max(self.exchanged[1].width()).max(NOTHING_HAPPENS * self.peak).max(self.rounding))
    }

    /// Algorithmic dissipation up to now. In the middle of an impact it may have been larger: schemes that take equilibrium
    /// between the ends of steps give some of it back.
    pub fn lost(&self) -> f64 {
        self.lost
    }

    /// Records the energies of a step.
    pub fn update(&mut self, energy: &Energy) {
        let stored = energy.strain + energy.links + energy.contact;
        let sizes = energy.strain.abs() + energy.links.abs() + energy.contact.abs();
        let start = *self.start.get_or_insert(energy.kinetic + stored.abs());
        self.update_work(energy.external);
        // The stored energy is negative where preloads are released.
        self.released = self.released.max(-stored);
        self.available = start + self.external + self.released;
        self.plastic = energy.plastic;
        self.damping = energy.damping;
        self.raised = self.raised.max(energy.mechanical - self.available);
        let dissipated = energy.numerical_dissipation() - self.before[0];
        (self.dissipated, self.lost) = (self.dissipated.max(dissipated), dissipated);
        // A mode beyond the stability limit may conserve the energy of central differences and still grow: then the
        // kinetic energy shows it.
        self.generated = self.generated.max(-dissipated).max(energy.kinetic - self.available);
        for (range, value) in
            self.exchanged.iter_mut().zip([energy.kinetic + dissipated, stored, energy.external - self.before[1]])
        {
            range.update(value);
        }
        // The sum may vanish by chance while its terms do not.
        self.peak = self.peak.max(energy.mechanical.abs()).max(energy.kinetic).max(sizes);
    }
}

/// The elastic energy of a part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PartEnergy {
    /// The part's index in [`Model::parts`]; for a shell with triangles and quadrilaterals the index of the first of the two.
    pub part: usize,
    /// Elastic energy.
    pub strain: f64,
}

impl PartEnergy {
    /// The part itself.
    pub fn of<'m>(&self, model: &'m Model) -> &'m Part {
        &model.parts[self.part]
    }
}

/// Writes the elastic energy of each beam, bar and shell in deck order, without the energy stored by kinematic
/// hardening.
pub fn part_energies(system: &System, model: &Model, now: &Configuration, parts: &mut Vec<PartEnergy>) {
    for group in system.groups.iter().filter(|group| group.kind.is_deformable()) {
        let energy = group.block.energy(&group.configuration(now));
        let part = &model.parts[group.part];
        match parts.last_mut() {
            Some(last) if last.of(model).is_one_with(part) => last.strain += energy,
            _ => parts.push(PartEnergy { part: group.part, strain: energy }),
        }
    }
}
