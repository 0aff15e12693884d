//! Ends a stage early at a value of a displacement, or of the work or force of a load.

use super::context::Context;
use super::workspace::Workspace;
use crate::step::load_steps::LoadSteps;
use crate::system::{Loading, Prescribed, Side};
use crate::tolerances::stop_watch::MET;
use base::math::{Vec3, rotation};
use base::snapshot::keep;
use mechanics::elements::Force;
use mechanics::state::State;
use model::{Actors, Stop, StopQuantity};

/// Watches the quantity whose value ends the stage.
pub struct StopWatch {
    stop: Stop,
    /// The restraints whose motion does work, by index in the model's list.
    moved: Vec<usize>,
    /// The sign of the value less the quantity, 0 until the quantity has left an initial value, and the largest magnitude of both.
    side: f64,
    size: f64,
    /// Work up to the beginning of the current step.
    work: f64,
    reached: bool,
    /// The state and the load steps at the beginning of the current step.
    before: State,
    load_steps: LoadSteps,
    buffers: Buffers,
}

keep!(StopWatch { side, size, work, reached, before, load_steps, buffers } without { stop, moved });

/// Loads and motions at the ends of a step, and forces on nodes.
#[derive(Default)]
struct Buffers {
    loads: [Loading; 2],
    motions: [Vec<Prescribed>; 2],
    /// The increments of prescribed motions in the step.
    moved: Vec<Prescribed>,
    forces: Vec<Force>,
    /// The balanced part of the loads at the beginning of the stage; empty if there is none.
    held: Loading,
}

keep!(Buffers { loads, motions, moved, forces, held });

impl Buffers {
    /// In a static stage after another one, finds the balanced part of new loads and of loads that jump at its beginning.
    fn hold_back(&mut self, cx: &Context, actors: &Actors) {
        let begin = cx.model.analysis.begin;
        if cx.is_dynamic() || begin == 0.0 {
            return;
        }
        let [before, held] = [&mut self.loads[0], &mut self.held];
        cx.excitation.loading(begin, Side::Before, before);
        cx.excitation.loading(begin, Side::After, held);
        if !actors.are_new {
            held.factors.iter_mut().zip(&before.factors).for_each(|(held, before)| *held -= before);
            held.pressures.iter_mut().zip(&before.pressures).for_each(|(held, before)| *held -= before);
            held.squares.iter_mut().zip(&before.squares).for_each(|(held, before)| *held -= before);
        }
    }
}

/// Subtracts the balanced part of the loads at a time, which fades to zero over the stage.
fn take_held(cx: &Context, held: &Loading, time: f64, loads: &mut Loading) {
    let left = (cx.model.analysis.end_time - time) / cx.model.analysis.duration();
    loads.factors.iter_mut().zip(&held.factors).for_each(|(load, held)| *load -= left * held);
    loads.pressures.iter_mut().zip(&held.pressures).for_each(|(load, held)| *load -= left * held);
    loads.squares.iter_mut().zip(&held.squares).for_each(|(load, held)| *load -= left * held);
}

impl StopWatch {
    /// The watch of a stage; `None` where only time ends it.
    pub fn new(cx: &Context) -> Option<StopWatch> {
        let stop = cx.model.analysis.stage.as_ref()?.stop.clone()?;
        let moved = match &stop.quantity {
            StopQuantity::Displacement(_) => Vec::new(),
            StopQuantity::Work(Actors { motions, .. }) | StopQuantity::Force(Actors { motions, .. }) => {
                let restraints = cx.model.constraints.restraints.iter().enumerate();
                restraints.filter(|(_, of)| motions.contains(&[of.node, of.dof])).map(|(index, _)| index).collect()
            }
        };
        Some(StopWatch {
            stop,
            moved,
            side: 1.0,
            size: 0.0,
            work: 0.0,
            reached: false,
            before: State::default(),
            load_steps: LoadSteps::default(),
            buffers: Buffers::default(),
        })
    }

    /// True once the value has been reached.
    pub fn is_reached(&self) -> bool {
        self.reached
    }

    /// Recalls how a run has ended.
    pub fn recall(&mut self, reached: bool) {
        self.reached = reached;
    }

    /// Begins with the state at the beginning of the stage.
    pub fn begin(&mut self, cx: &Context, ws: &Workspace, state: &State) {
        (self.work, self.reached) = (0.0, false);
        self.before = state.clone();
        self.load_steps = ws.load_steps.clone();
        if let StopQuantity::Work(actors) | StopQuantity::Force(actors) = &self.stop.quantity {
            self.buffers.hold_back(cx, actors);
        }
        let rest = self.stop.value - self.quantity(cx, state);
        self.size = self.stop.value.abs();
        self.take_side(rest);
    }

    /// Finds the side of the value that the quantity is on; 0 if they are equal.
    fn take_side(&mut self, rest: f64) {
        self.size = self.size.max(rest.abs());
        self.side = if self.is_met(rest) { 0.0 } else { rest.signum() };
    }

    /// Checks a completed step: `None` if the value is not reached, otherwise the remaining distance.
    pub fn passed(&mut self, cx: &Context, state: &State) -> Option<f64> {
        let rest = self.stop.value - self.quantity(cx, state);
        if self.side == 0.0 || self.leaves_branch(state) {
            self.take_side(rest);
        } else if self.side * rest <= 0.0 || self.is_met(rest) {
            return Some(self.side * rest);
        }
        self.accept(cx, state, false);
        None
    }

    /// True if a rotation vector has changed to its equivalent in the opposite direction, which passes no value.
    fn leaves_branch(&self, state: &State) -> bool {
        let StopQuantity::Displacement([node, 3..6]) = self.stop.quantity else { return false };
        let [before, now] = [&self.before, state].map(|of| rotation::log(&of.nodes[node].rotation));
        (now - before).norm() > std::f64::consts::PI
    }

    /// Keeps the state at the beginning of a step.
    pub fn note(&mut self, ws: &Workspace, state: &State) {
        self.before.copy_from(state);
        self.load_steps.copy_from(&ws.load_steps);
    }

    /// Returns to the beginning of the step.
    pub fn go_back(&self, ws: &mut Workspace, state: &mut State) {
        state.copy_from(&self.before);
        ws.load_steps.copy_from(&self.load_steps);
    }

    /// The distance to the value at the beginning of the step.
    pub fn left_before(&mut self, cx: &Context) -> f64 {
        if let StopQuantity::Work(_) = self.stop.quantity {
            return self.side * (self.stop.value - self.work);
        }
        // The quantity of a state needs none before it.
        let before = std::mem::take(&mut self.before);
        let left = self.left(cx, &before);
        self.before = before;
        left
    }

    /// The distance to the value in a state of the current step; negative beyond the value.
    pub fn left(&mut self, cx: &Context, state: &State) -> f64 {
        self.side * (self.stop.value - self.quantity(cx, state))
    }

    /// True if this distance is negligible.
    pub fn is_met(&self, left: f64) -> bool {
        left.abs() <= MET * self.size
    }

    /// Records a completed step; with `reached` it is the last.
    pub fn accept(&mut self, cx: &Context, state: &State, reached: bool) {
        if let StopQuantity::Work(_) = self.stop.quantity {
            self.work = self.quantity(cx, state);
        }
        self.reached = reached;
    }

    fn quantity(&mut self, cx: &Context, state: &State) -> f64 {
        let StopWatch { stop, moved, before, work, buffers, .. } = self;
        match &stop.quantity {
            StopQuantity::Displacement([node, dof]) => {
                let (now, start) = (&state.nodes[*node], &cx.model.nodes[*node].x);
                if *dof < 3 { now.moved(start)[*dof] } else { rotation::log(&now.rotation)[*dof - 3] }
            }
            StopQuantity::Work(actors) => {
                let Buffers { loads: [l0, l1], motions: [m0, m1], moved: by, held, .. } = buffers;
                for (time, side, loads, motions) in
                    [(before.time, Side::After, &mut *l0, &mut *m0), (state.time, Side::Before, &mut *l1, &mut *m1)]
                {
                    cx.excitation.loading(time, side, loads);
                    take_held(cx, held, time, loads);
                    cx.excitation.prescribed(time, side, motions);
                }
                let mut sum = *work;
                cx.system.add_load_work(actors, (&before.nodes, l0), (&state.nodes, l1), &mut sum);
                cx.excitation.moved(m0, m1, by);
                let of_motion = |&i: &usize| 0.5 * (before.reactions[i] + state.reactions[i]) * by[i].u;
                sum + moved.iter().map(of_motion).sum::<f64>()
            }
            StopQuantity::Force(actors) => {
                let loads = &mut buffers.loads[1];
                // At the beginning of the stage, loads of the previous stage do not count.
                let side = if state.time > cx.model.analysis.begin { Side::Before } else { Side::After };
                cx.excitation.loading(state.time, side, loads);
                take_held(cx, &buffers.held, state.time, loads);
                let mut sum = cx.system.load_force(actors, &state.nodes, loads, &mut buffers.forces);
                for &i in moved.iter() {
                    let dof = cx.model.constraints.restraints[i].dof;
                    if dof < 3 {
                        sum += state.reactions[i] * Vec3::ith(dof, 1.0);
                    }
                }
                sum.norm()
            }
        }
    }
}
