//! What ends a stage before its time: a displacement, or the work or the force of a load, that comes to a value.

use super::context::Context;
use super::load_steps::LoadSteps;
use super::workspace::Workspace;
use crate::elements::Force;
use crate::math::{Vec3, rotation};
use crate::model::{Actors, Stop, StopQuantity};
use crate::state::State;
use crate::system::{Loading, Prescribed, Side};

/// Part of the value within which it is met by a step of given length, which is shortened to end there.
const MET: f64 = 1e-8;

/// Watches the quantity at a value of which the stage ends.
pub struct StopWatch {
    stop: Stop,
    /// The restraints whose motion does work, by index in the model's list.
    moved: Vec<usize>,
    /// Of the value less the quantity at the beginning: its sign, and the larger of both.
    side: f64,
    size: f64,
    /// Work up to the beginning of the step at hand.
    work: f64,
    reached: bool,
    /// The state and the load steps at the beginning of the step at hand.
    before: State,
    load_steps: LoadSteps,
    buffers: Buffers,
}

/// Loads and motions at the ends of a step, and forces on nodes.
#[derive(Default)]
struct Buffers {
    loads: [Loading; 2],
    motions: [Vec<Prescribed>; 2],
    forces: Vec<Force>,
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

    /// Begins with the state at the beginning of the stage.
    pub fn begin(&mut self, cx: &Context, ws: &Workspace, state: &State) {
        (self.work, self.reached) = (0.0, false);
        self.before = state.clone();
        self.load_steps = ws.load_steps.clone();
        let left = self.stop.value - self.quantity(cx, state);
        self.side = if left < 0.0 { -1.0 } else { 1.0 };
        self.size = left.abs().max(self.stop.value.abs());
    }

    /// Keeps the state at the beginning of a step.
    pub fn note(&mut self, ws: &Workspace, state: &State) {
        self.before.copy_from(state);
        self.load_steps = ws.load_steps.clone();
    }

    /// Returns to the beginning of the step.
    pub fn go_back(&self, ws: &mut Workspace, state: &mut State) {
        state.copy_from(&self.before);
        ws.load_steps = self.load_steps.clone();
    }

    /// What is left to the value at the beginning of the step.
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

    /// What is left to the value in a state between which and the beginning of the step nothing has been taken account of; negative beyond it.
    pub fn left(&mut self, cx: &Context, state: &State) -> f64 {
        self.side * (self.stop.value - self.quantity(cx, state))
    }

    /// True where this is as good as nothing.
    pub fn is_met(&self, left: f64) -> bool {
        left.abs() <= MET * self.size
    }

    /// Takes account of a step that has been taken; with `reached` it is the last.
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
                let Buffers { loads: [l0, l1], motions: [m0, m1], .. } = buffers;
                for (time, side, loads, motions) in
                    [(before.time, Side::After, &mut *l0, &mut *m0), (state.time, Side::Before, &mut *l1, &mut *m1)]
                {
                    cx.excitation.loading(time, side, loads);
                    cx.excitation.prescribed(time, motions);
                }
                let mut sum = *work;
                let which = (actors.nodal.clone(), actors.pressures.clone());
                cx.system.add_load_work(which, (&before.nodes, l0), (&state.nodes, l1), &mut sum);
                let of_motion = |&i: &usize| 0.5 * (before.reactions[i] + state.reactions[i]) * (m1[i].u - m0[i].u);
                sum + moved.iter().map(of_motion).sum::<f64>()
            }
            StopQuantity::Force(actors) => {
                let loads = &mut buffers.loads[1];
                cx.excitation.loading(state.time, Side::Before, loads);
                let which = (actors.nodal.clone(), actors.pressures.clone());
                let mut sum = cx.system.load_force(which, &state.nodes, loads, &mut buffers.forces);
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
