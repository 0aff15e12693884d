//! Load steps with contacts that end without penetration: the equilibrium is found repeatedly, each time with the last contact forces as
//! multipliers, until no penetration exceeds its tolerance.

use crate::context::Context;
use crate::failure::Failure;
use crate::tolerances::augmentation::MOST;
use crate::workspace::Workspace;
use mechanics::state::{Configuration, State};

/// The update of the multipliers of contacts.
pub struct Augmentation {
    /// The history at the start of the step, restored if the step fails.
    start: Vec<f64>,
    /// The history to be, while it is written.
    next: Vec<f64>,
}

impl Augmentation {
    /// `None` where no contact has multipliers.
    pub fn of(cx: &Context) -> Option<Augmentation> {
        let any = !cx.is_dynamic() && cx.system.has_contact_multipliers();
        any.then(|| Augmentation { start: vec![0.0; cx.system.history], next: vec![0.0; cx.system.history] })
    }

    /// Begins a step at a state.
    pub fn begin(&mut self, state: &State) {
        self.start.copy_from_slice(&state.history);
    }

    /// Gives a state back the history that it began the step with.
    pub fn take_back(&mut self, state: &mut State) {
        state.history.copy_from_slice(&self.start);
    }

    /// Writes the contact forces of the equilibrium number `count` at the time `to` as multipliers to the history of `state`. Returns
    /// false, without changes, if no penetration exceeds its tolerance.
    ///
    /// # Errors
    /// [`Failure::ContactNotClosed`] if the limit of equilibria is reached.
    pub fn augment(
        &mut self,
        cx: &Context,
        ws: &Workspace,
        state: &mut State,
        to: f64,
        count: usize,
    ) -> Result<bool, Failure> {
        let now =
            Configuration { nodes: &ws.trial.nodes, history: &state.history, dt: to - state.time, previous: None };
        self.next.copy_from_slice(&state.history);
        let (out, part) = cx.system.augment_contacts(&state.nodes, &now, &mut self.next);
        if out <= 1.0 {
            return Ok(false);
        }
        if count > MOST {
            return Err(Failure::ContactNotClosed { name: cx.model.parts[part].name().to_owned(), out });
        }
        std::mem::swap(&mut state.history, &mut self.next);
        Ok(true)
    }
}
