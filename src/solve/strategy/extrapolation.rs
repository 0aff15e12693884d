//! The iterate whose stresses are extrapolated to the current one, see [`Configuration::previous`](mechanics::state::Configuration).

use crate::context::Context;
use crate::step::correct::Correction;
use crate::step::trial::TrialMotion;
use base::math::{Vec6, angular, linear};
use base::snapshot::keep;
use mechanics::state::Node;
use model::StepLength;

/// The previous iterate, and the iterate before the last equilibrium, used for predictions. It is allocated once, where elements turn.
pub struct StressExtrapolation {
    last: Iterate,
    of_equilibrium: Iterate,
    corrections: Vec<Vec6>,
    /// False where the iteration has gone astray by it.
    trusted: bool,
}

keep!(StressExtrapolation { last, of_equilibrium, corrections, trusted });

/// Motion with a correction in place of its velocities.
#[derive(Clone)]
struct Iterate {
    nodes: Vec<Node>,
    known: bool,
}

keep!(Iterate { nodes, known });

impl StressExtrapolation {
    /// Room for the iterates of a model with error-controlled steps. Extrapolation converges from farther away, but may find an equilibrium
    /// off the current motion. Only the error estimate of the step detects this, so load steps and steps of given length do without. Models
    /// with a constant tangent need no extrapolation, nor do shells, whose matrices are reused.
    pub fn new(cx: &Context) -> StressExtrapolation {
        let judged = cx.is_dynamic() && matches!(cx.model.analysis.step_length, StepLength::ErrorControlled { .. });
        let used = judged && !cx.plan.linear && !cx.model.has_surfaces();
        let count = if used { cx.model.nodes.len() } else { 0 };
        let nodes = cx.model.nodes.iter().take(count).map(|node| Node::at_rest(node.x)).collect();
        let last = Iterate { nodes, known: false };
        StressExtrapolation {
            of_equilibrium: last.clone(),
            last,
            corrections: vec![Vec6::zeros(); count],
            trusted: true,
        }
    }

    /// Discards the iterates of a failed step.
    pub fn forget(&mut self) {
        (self.last.known, self.of_equilibrium.known, self.trusted) = (false, false, true);
    }

    /// Goes back to the last equilibrium, as the iteration goes back to its prediction.
    pub fn restart(&mut self) {
        self.last.known = false;
    }

    /// Gives up extrapolation until the next equilibrium; returns false where there was none. Near limit points the extrapolated stresses
    /// grow from correction to correction.
    pub fn mistrust(&mut self) -> bool {
        self.nodes().is_some() && std::mem::replace(&mut self.trusted, false)
    }

    /// Takes the iterate before as the one that led to an equilibrium.
    pub fn arrive(&mut self) {
        self.trusted = true;
        if std::mem::take(&mut self.last.known) {
            std::mem::swap(&mut self.last, &mut self.of_equilibrium);
            self.of_equilibrium.known = true;
        }
    }

    /// The iterate before, with the correction in place of its velocities.
    pub fn nodes(&self) -> Option<&[Node]> {
        let known = [&self.last, &self.of_equilibrium].into_iter().find(|iterate| iterate.known);
        known.filter(|_| self.trusted).map(|iterate| &iterate.nodes[..])
    }

    /// Keeps the trial motion and the current correction before it is added.
    pub fn keep(&mut self, cx: &Context, trial: &TrialMotion, correction: &Correction) {
        if self.corrections.is_empty() {
            return;
        }
        for &node in &cx.independent_nodes {
            self.corrections[node] = correction.of(cx.plan.dofs.of(node));
        }
        cx.system.project(&trial.nodes, &mut self.corrections);
        for ((node, now), correction) in self.last.nodes.iter_mut().zip(&trial.nodes).zip(&self.corrections) {
            *node = *now;
            (node.v, node.omega) = (linear(correction), angular(correction));
        }
        self.last.known = true;
    }
}
