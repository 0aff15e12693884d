//! The times and displacements that steps along a path must hit.

use crate::context::Context;
use crate::workspace::Workspace;
use base::snapshot::{Keep, Snapshot, keep};
use mechanics::state::State;
use model::{ArcLength, DisplacementTarget, Model, When};

/// A time or displacement that a step must hit.
pub struct Target {
    /// The quantity.
    pub quantity: TargetQuantity,
    /// Its value.
    pub value: f64,
    /// Number of passages still to come; the last of them counts.
    passes: usize,
    /// Side of the value on which the path lies: −1, 1, or 0 before it has left the value.
    side: f64,
    /// True where the path ends at it.
    pub ends: bool,
    /// Indices, in the model's list, of the expectations due at it.
    pub expects: Vec<usize>,
}

keep!(Target { passes, side } without { quantity, value, ends, expects });

/// The quantity that reaches a value.
#[derive(Clone, Copy, PartialEq)]
pub enum TargetQuantity {
    Time,
    Displacement { node: usize, dof: usize },
}

/// All targets of a path.
pub struct Targets(pub Vec<Target>);

impl Keep for Targets {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        self.0.keep(snapshot);
    }
}

impl Targets {
    /// The end of the path, its `stop`, and the expectations along it.
    pub fn new(model: &Model, path: &ArcLength) -> Self {
        let mut all = Targets(Vec::new());
        // Loads that a displacement leads have no last value; other actions of a stage have one.
        if path.increment.is_none() || model.analysis.stage.as_ref().is_some_and(|stage| !stage.loads_grow) {
            all.add(TargetQuantity::Time, model.analysis.end_time, 1).ends = true;
        }
        if let Some(stop) = path.stop {
            all.add(TargetQuantity::Displacement { node: stop.node, dof: stop.dof }, stop.value, stop.pass).ends = true;
        }
        for (index, expect) in model.expects.iter().enumerate() {
            match expect.when {
                When::Time(time) if time > 0.0 => all.add(TargetQuantity::Time, time, 1).expects.push(index),
                When::Target(at) => {
                    let quantity = TargetQuantity::Displacement { node: at.node, dof: at.dof };
                    all.add(quantity, at.value, at.pass).expects.push(index);
                }
                _ => {}
            }
        }
        all
    }

    /// Adds a target, unless the same one is there already.
    fn add(&mut self, quantity: TargetQuantity, value: f64, passes: usize) -> &mut Target {
        let same = |t: &Target| t.quantity == quantity && t.value == value && t.passes == passes;
        let index = self.0.iter().position(same).unwrap_or_else(|| {
            self.0.push(Target { quantity, value, passes, side: 0.0, ends: false, expects: Vec::new() });
            self.0.len() - 1
        });
        &mut self.0[index]
    }

    /// Records the side of each target on which the path starts.
    pub fn start(&mut self, cx: &Context, ws: &Workspace, state: &State) {
        for target in &mut self.0 {
            let (from, _) = target.ends_of_motion(cx, ws, state, state.time);
            target.side = if from == target.value { 0.0 } else { (from - target.value).signum() };
        }
    }

    /// The index of the target, other than `but`, that the motion from `state` passes first, and the fraction of the motion up to it.
    pub fn first_passed(
        &self,
        cx: &Context,
        ws: &Workspace,
        state: &State,
        to: f64,
        but: Option<usize>,
    ) -> Option<(usize, f64)> {
        let part = |target: &Target| {
            let (from, end) = target.ends_of_motion(cx, ws, state, to);
            let over = |x: f64| target.side * (x - target.value);
            let passed = target.passes == 1 && over(from) > 0.0 && over(end) <= 0.0;
            passed.then(|| (target.value - from) / (end - from))
        };
        let others = self.0.iter().enumerate().filter(|(i, _)| Some(*i) != but);
        let passed = others.filter_map(|(i, target)| part(target).map(|part| (i, part)));
        passed.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Counts the targets that the accepted motion passes. It passes `reached` by definition, whatever rounding says.
    pub fn pass(&mut self, cx: &Context, ws: &Workspace, state: &State, to: f64, reached: Option<usize>) {
        for (i, target) in self.0.iter_mut().enumerate() {
            let (_, end) = target.ends_of_motion(cx, ws, state, to);
            let side = match reached == Some(i) {
                true => -target.side,
                false if end == target.value => target.side,
                false => (end - target.value).signum(),
            };
            if target.side * side < 0.0 {
                target.passes = target.passes.saturating_sub(1);
            }
            target.side = side;
        }
    }

    /// True where a step ended at this target.
    pub fn is_stop(&self, stop: &DisplacementTarget, reached: Option<usize>) -> bool {
        let quantity = TargetQuantity::Displacement { node: stop.node, dof: stop.dof };
        reached.is_some_and(|i| self.0[i].ends && self.0[i].quantity == quantity)
    }
}

impl Target {
    /// The quantity at both ends of the motion found from `state` to the time `to`.
    pub fn ends_of_motion(&self, cx: &Context, ws: &Workspace, state: &State, to: f64) -> (f64, f64) {
        match self.quantity {
            TargetQuantity::Time => (state.time, to),
            TargetQuantity::Displacement { node, dof } => {
                let start = &state.nodes[node];
                let from = start.moved(&cx.model.nodes[node].x)[dof];
                // Dependent nodes have no increment.
                let moves = cx.independent_nodes.binary_search(&node).is_ok();
                let way = if moves {
                    ws.trial.increments[node].q[dof]
                } else {
                    ws.trial.nodes[node].relative_position(start)[dof]
                };
                (from, from + way)
            }
        }
    }
}
