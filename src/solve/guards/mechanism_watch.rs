//! The watch for mechanisms in statics: it searches the first matrix of a run, and each matrix after an element has opened.

use crate::context::Context;
use crate::failure::Failure;
use crate::guards::mechanism;
use crate::strategy::stabilization::HeldByForces;
use crate::system::{Prescribed, TangentWeights};
use base::snapshot::keep;
use linear::Solver;
use mechanics::state::{Configuration, State};

/// The known state of open parts.
pub struct MechanismWatch {
    /// False in dynamics, where masses resist every motion.
    is_due: bool,
    /// The number of elements that were open when a matrix was last searched; none before the first of the run.
    searched: Option<usize>,
    /// The part that has opened or gone slack last.
    opened: Option<String>,
}

keep!(MechanismWatch { searched, opened } without { is_due });

/// The open elements when a matrix is formed.
#[derive(Clone, Copy)]
pub struct Openings {
    /// The number of elements that neither push nor pull.
    count: usize,
    /// True if the openings may have created a mechanism.
    suspect: bool,
    /// True before the first motion: shorter steps then do not change the restraints.
    at_start: bool,
}

impl Openings {
    /// True where an element neither pushes nor pulls.
    pub fn any(&self) -> bool {
        self.count > 0
    }
}

impl MechanismWatch {
    /// A watch that has seen nothing yet.
    pub fn new(cx: &Context) -> MechanismWatch {
        MechanismWatch { is_due: !cx.is_dynamic(), searched: None, opened: None }
    }

    /// Counts the open elements `now`, in a step from `state`.
    pub fn look(&mut self, cx: &Context, state: &State, prescribed: &[Prescribed], now: &Configuration) -> Openings {
        // An element that lifts off or goes slack may create a mechanism.
        let count = if self.is_due { mechanism::open_elements(cx.system, now) } else { 0 };
        match self.searched {
            Some(known) if count > known => {
                // If no part was open before, it may have opened at the end of the last step.
                let before = (known > 0).then(|| state.configuration());
                self.opened = mechanism::opened_part(cx.model, cx.system, before.as_ref(), now).or(self.opened.take());
            }
            Some(known) if count < known => self.opened = None,
            _ => {}
        }
        Openings {
            count,
            suspect: self.is_due && self.searched.is_none_or(|known| count > known),
            at_start: self.searched.is_none() && state.time == 0.0 && prescribed.iter().all(|given| given.u == 0.0),
        }
    }

    /// Searches a factorized matrix with these weights for mechanisms, when due. Forces of joints count where they are given.
    ///
    /// # Errors
    /// [`Failure::Singular`] where there is one.
    pub fn search(
        &mut self,
        cx: &Context,
        solver: &mut Solver,
        now: &Configuration,
        weights: (TangentWeights, Option<&HeldByForces>),
        openings: Openings,
    ) -> Result<(), Failure> {
        if openings.suspect {
            let mechanism = mechanism::find(cx.system, &cx.plan.dofs, solver, now, weights, cx.length);
            if let Some(place) = mechanism {
                let open = mechanism::open_part(cx.model, cx.system, now, place.0).or_else(|| self.opened.clone());
                return Err(Failure::mechanism(cx.model, place, open, openings.at_start));
            }
        }
        if openings.suspect || self.searched.is_some() {
            self.searched = Some(openings.count);
        }
        Ok(())
    }

    /// The failure of a matrix that has no pivot in this row.
    pub fn singular(&self, cx: &Context, now: &Configuration, row: usize, openings: Openings) -> Failure {
        let place = cx.plan.dofs.nodal_dofs().get(row);
        let open = place.and_then(|&(node, _)| mechanism::open_part(cx.model, cx.system, now, node));
        let open = open.or_else(|| self.opened.clone());
        Failure::singular(cx.model, cx.plan, cx.system, row, (open, openings.at_start))
    }

    /// The name of the part that has opened or gone slack last, in quotes.
    pub fn opened(&self) -> Option<String> {
        self.opened.clone()
    }
}
