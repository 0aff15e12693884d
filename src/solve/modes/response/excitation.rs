//! Excitation of a response: harmonic loads and support motions.

use super::super::fault::ModesFault;
use super::super::gyroscopic::Gyroscopic;
use super::super::linearized::Linearized;
use super::super::pencil::Pencil;
use super::matrices::Matrices;
use crate::system::assembly::Assembly;
use crate::system::{Excitation, Forces, Loading, Side};
use base::math::{Vec3, Vec6, angular, linear, stack};
use linear::{Factorization, Solver};
use model::{History, Load, Model};
use nalgebra::Complex;

/// A complex number.
pub type C64 = Complex<f64>;

/// The excitation of a response.
pub struct HarmonicExcitation {
    /// Forces on the unknowns of nodes, each with its complex factor.
    pub loads: Vec<(C64, Vec<f64>)>,
    /// Motions of supports.
    pub motions: Vec<SupportMotion>,
}

/// A motion of supports, of one phase and with one sort of amplitudes.
pub struct SupportMotion {
    factor: C64,
    history: History,
    /// Motions of all nodes: supports and rigidly attached nodes; zero elsewhere.
    pub moved: Vec<Vec6>,
    /// Changes of the gaps of joints.
    pub gaps: Vec<f64>,
    /// K u, C u and M u in the rows of the unknowns of nodes.
    pub forces: [Vec<f64>; 3],
}

impl SupportMotion {
    /// Displacement factor at an angular frequency: 1/iω for a velocity, −1/ω² for an acceleration.
    pub fn factor(&self, omega: f64) -> C64 {
        match self.history {
            History::Displacement => self.factor,
            History::Velocity => self.factor / C64::new(0.0, omega),
            History::Acceleration => -self.factor / (omega * omega),
        }
    }
}

impl HarmonicExcitation {
    /// The excitation of a model, where `pencil` is about the state.
    ///
    /// # Errors
    /// There is no memory.
    pub fn of(pencil: &Pencil, unsymmetric: bool) -> Result<HarmonicExcitation, ModesFault> {
        let loads = [C64::new(1.0, 0.0), C64::new(0.0, 1.0)].map(|factor| (factor, forces(pencil, factor)));
        let loads = loads.into_iter().filter(|(_, force)| force.iter().any(|f| *f != 0.0)).collect();
        Ok(HarmonicExcitation { loads, motions: motions(&pencil.at, unsymmetric)? })
    }

    /// True where nothing of it can move anything.
    pub fn is_nothing(&self) -> bool {
        let moves = |motion: &SupportMotion| motion.moved.iter().any(|motion| *motion != Vec6::zeros());
        self.loads.is_empty() && !self.motions.iter().any(moves)
    }
}

/// Part of an amplitude with this factor, 1 or i; 0 if it is not harmonic.
fn part(model: &Model, amplitude: Option<usize>, factor: C64) -> f64 {
    let phase = amplitude.and_then(|i| model.loading.amplitudes[i].harmonic_phase());
    phase.map_or(0.0, |phase| if factor.re > 0.0 { phase.cos() } else { phase.sin() })
}

/// The forces of this factor.
fn forces(pencil: &Pencil, factor: C64) -> Vec<f64> {
    let (at, model) = (&pencil.at, pencil.at.model);
    let part = |amplitude: Option<usize>| part(model, amplitude, factor);
    let loading = &model.loading;
    let ground = |field: Vec3, base: &model::BaseAcceleration| field - part(Some(base.amplitude)) * base.direction;
    let gravity = part(loading.gravity_amplitude) * loading.gravity;
    let square = |load: &Load| if load.is_unbalance() { at.state.nodes[load.node].omega.norm_squared() } else { 1.0 };
    let harmonic = Loading {
        factors: loading.nodal.iter().map(|load| square(load) * part(load.amplitude)).collect(),
        pressures: loading.pressures.iter().map(|load| load.pressure * part(load.amplitude)).collect(),
        squares: vec![0.0; loading.centrifugal.len()],
        field: loading.base_accelerations.iter().fold(gravity, ground),
    };
    let mut forces = Forces::new(at.system, pencil.nodes.len());
    at.system.external(&pencil.nodes, &harmonic, &mut forces);
    at.plan.dofs.nodal_dofs().iter().map(|&(node, dof)| forces.on_nodes[node][dof]).collect()
}

/// Support motions with their forces on the unknowns: columns of the matrices of a plan in which prescribed degrees of freedom are
/// unknowns.
fn motions(at: &Linearized, unsymmetric: bool) -> Result<Vec<SupportMotion>, ModesFault> {
    let model = at.model;
    let mut all: Vec<SupportMotion> = Vec::new();
    let mut prescribed = Vec::new();
    for restraint in &model.constraints.restraints {
        let Some(motion) = &restraint.motion else { continue };
        if model.loading.amplitudes[motion.amplitude].harmonic_phase().is_none() {
            continue;
        }
        prescribed.push((restraint.node, restraint.dof));
        for factor in [C64::new(1.0, 0.0), C64::new(0.0, 1.0)] {
            let u = motion.scale * part(model, Some(motion.amplitude), factor);
            if u == 0.0 {
                continue;
            }
            let is_alike = |known: &SupportMotion| known.factor == factor && known.history == motion.history;
            let place = all.iter().position(is_alike).unwrap_or(all.len());
            if place == all.len() {
                let moved = vec![Vec6::zeros(); model.nodes.len()];
                let (gaps, forces) = (vec![0.0; at.system.multipliers()], Default::default());
                all.push(SupportMotion { factor, history: motion.history, moved, gaps, forces });
            }
            all[place].moved[restraint.node][restraint.dof] = u;
        }
    }
    if all.is_empty() {
        return Ok(all);
    }
    turn_together(at, &mut all, &mut prescribed);
    let plan = at.plan.with_prescribed(at.system, &prescribed);
    let at = Linearized { plan: &plan, ..*at };
    let kind = if unsymmetric { Factorization::BlockLu } else { Factorization::Cholesky };
    let mut solver = Solver::new(&plan.structure, kind, 1)?;
    let mut assembly = Assembly::new(at.system, &plan.dofs, &solver, 1);
    let mut pencil = Pencil::new(at, (&mut solver, &mut assembly));
    let matrices = Matrices::of(&mut pencil, &Gyroscopic::of(&at));
    let nodes = &pencil.nodes;
    let mut own = vec![true; at.unknowns()];
    prescribed.iter().filter_map(|&(node, dof)| plan.dofs.row(node, dof)).for_each(|row| own[row] = false);
    for motion in &mut all {
        let mut u = vec![0.0; at.unknowns()];
        plan.dofs.each_node().iter().zip(&motion.moved).for_each(|(rows, moved)| rows.scatter(moved, &mut u));
        motion.forces = [&matrices.K, &matrices.C, &matrices.M].map(|matrix| {
            let mut force = vec![0.0; u.len()];
            matrix.multiply(&u, &mut force);
            force.into_iter().zip(&own).filter(|(_, own)| **own).map(|(force, _)| force).collect()
        });
        at.system.project(nodes, &mut motion.moved);
        // Masses are damped relative to frames moved by supports, so motion with a frame is not damped.
        if at.system.mass_damping().has_frames() {
            let mut drag = Forces::new(at.system, nodes.len());
            at.system.drag_of(nodes, &at.system.mass_damping().carry(nodes, &motion.moved), &mut drag);
            let rows = plan.dofs.nodal_dofs().iter().zip(&own).filter(|(_, own)| **own).map(|(at, _)| *at);
            let forces = motion.forces[1].iter_mut().zip(rows);
            forces.for_each(|(force, (node, dof))| *force -= drag.on_nodes[node][dof]);
        }
        at.system.gaps_of_motion(nodes, &motion.moved, &mut motion.gaps);
    }
    Ok(all)
}

/// Converts changes of rotations prescribed together into the spin at the rotation of the state.
fn turn_together(at: &Linearized, all: &mut [SupportMotion], prescribed: &mut Vec<(usize, usize)>) {
    let constraints = &at.model.constraints;
    let mut given = Vec::new();
    Excitation::new(at.model).prescribed(at.state.time, Side::Before, &mut given);
    for turn in &constraints.turns {
        let node = constraints.restraints[turn.restraints[0]].node;
        let u = Vec3::from(turn.restraints.map(|i| given[i].u));
        for motion in all.iter_mut().filter(|motion| angular(&motion.moved[node]) != Vec3::zeros()) {
            let change = &motion.moved[node];
            let spin = turn.angles.turn(&[u, angular(change), Vec3::zeros()]).omega;
            motion.moved[node] = stack(&linear(change), &spin);
            prescribed.extend((3..6).map(|dof| (node, dof)));
        }
    }
}
