//! Displacements that a path is to land on, but which the plan leaves out: they stay zero.

use super::Plan;
use super::place::DofStatus;
use crate::diagnostic::Diagnostic;
use crate::model::{ArcLength, DIRECTIONS, Model, Passage, StepLength, When};

impl Plan {
    /// An error for each `stop` and each `when` of the model that no motion can come to, with its place in the deck.
    pub fn unreachable_targets(&self, model: &Model) -> Vec<Diagnostic> {
        let stop = match &model.analysis.step_length {
            StepLength::ArcLength(ArcLength { stop: Some(stop), .. }) => Some(stop),
            _ => None,
        };
        let expected = model.expects.iter().filter_map(|expect| match &expect.when {
            When::Passing(passage) => Some(passage),
            _ => None,
        });
        let passages = stop.into_iter().chain(expected);
        passages.filter_map(|passage| self.why_unreachable(model, passage)).collect()
    }

    fn why_unreachable(&self, model: &Model, passage: &Passage) -> Option<Diagnostic> {
        let &Passage { node, dof, place: [start, end], .. } = passage;
        let why = match self.nodes[node][dof] {
            // What rides moves with its master, which the deck allows or not.
            DofStatus::Unknown | DofStatus::Dependent => return None,
            DofStatus::Restrained => "a support gives it",
            DofStatus::Nothing => "nothing acts on it",
            DofStatus::Inactive => "nothing sets it moving",
            DofStatus::Plane => "the scene is plane, and this is normal to it",
        };
        let message = format!("{} of `{}` never changes: {why}", DIRECTIONS[dof], model.nodes[node].label);
        Some(Diagnostic::error(message).at(&(start..end)).hint("name a displacement that is an unknown"))
    }
}
