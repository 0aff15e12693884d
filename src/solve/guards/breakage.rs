//! Elements and links that fail in a run and exert no force afterwards.

use crate::context::Context;
use crate::system::System;
use base::math::Vec3;
use base::names::short;
use base::snapshot::keep;
use mechanics::elements::FailureCause;
use mechanics::state::State;

/// An element or a link that has failed.
#[derive(Debug, Clone, PartialEq)]
pub struct Broken {
    /// The failed element of a part, or the failed link.
    pub what: String,
    /// Why it failed.
    pub reason: String,
    /// The mean position of its nodes, global components.
    pub place: Vec3,
}

/// All elements and links that have failed so far. Models without possible failures are not watched.
#[derive(Default)]
pub struct Breakage {
    /// Indices of the groups whose elements may fail.
    groups: Vec<usize>,
    /// True for each of their elements that has failed.
    failed: Vec<bool>,
    /// Elements and links that failed in the last step.
    new: Vec<Broken>,
}

keep!(Breakage { groups, failed } without { new });

/// The cause of a failure in words.
fn reason(cause: FailureCause) -> String {
    match cause {
        FailureCause::PlasticStrain(strain) => format!("its plastic strain is {}", short(strain)),
        FailureCause::Forces { normal, shear } => {
            format!("normal force {}, shear force {}", short(normal), short(shear))
        }
    }
}

impl Breakage {
    /// Records the failures from before the run or the stage.
    pub fn begin(&mut self, system: &System, state: &State) {
        self.groups = (0..system.groups.len()).filter(|&group| system.groups[group].block.can_fail()).collect();
        self.failed.clear();
        for group in self.groups.iter().map(|&group| &system.groups[group]) {
            let history = &state.history[group.history.clone()];
            self.failed.extend((0..group.block.len()).map(|e| group.block.has_failed(e, history)));
        }
    }

    /// Finds the failures of an accepted step.
    pub fn look(&mut self, cx: &Context, state: &State) {
        self.new.clear();
        let mut failed = self.failed.iter_mut();
        for group in self.groups.iter().map(|&group| &cx.system.groups[group]) {
            let history = &state.history[group.history.clone()];
            for (e, failed) in (0..group.block.len()).zip(&mut failed) {
                if *failed || !group.block.has_failed(e, history) {
                    continue;
                }
                *failed = true;
                let part = group.part_of(e, cx.model);
                let what = match group.kind.is_deformable() {
                    true => format!("element {} of `{}`", group.first + e, part.name()),
                    false => format!("link `{}`", part.name()),
                };
                let nodes = group.block.nodes(e);
                let place = nodes.iter().map(|&node| state.nodes[node].x).sum::<Vec3>() / nodes.len() as f64;
                self.new.push(Broken { what, reason: reason(group.block.failure_cause(e, history)), place });
            }
        }
    }

    /// The elements and links that failed in the last step.
    pub fn new_ones(&self) -> &[Broken] {
        &self.new
    }

    /// The number of failed elements and links; `None` if none can fail.
    pub fn count(&self) -> Option<usize> {
        (!self.groups.is_empty()).then(|| self.failed.iter().filter(|failed| **failed).count())
    }
}
