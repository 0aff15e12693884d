//! The guards of a model, as listed in its plan.

use crate::context::Context;
use crate::failure::Failure;
use crate::guards::contacts::ContactGuard;
use crate::guards::drift::DriftGuard;
use crate::guards::guard::Guard;
use crate::guards::joints::JointGuard;
use crate::guards::jump::{JumpGuard, TwistGuard};
use crate::guards::links::LinkGuard;
use crate::guards::massless::MasslessNodes;
use crate::guards::stability::Stability;
use crate::guards::strain::StrainGuard;
use crate::plan::GuardKind;
use base::snapshot::{Keep, Snapshot};
use linear::TooLarge;

/// The guards of a model, in the order of their checks.
pub struct Guards(Vec<Box<dyn Guard>>);

impl Guards {
    /// Creates the guards listed in the plan.
    ///
    /// # Errors
    /// There is no memory for the matrices of the guard of stability.
    pub fn of(cx: &Context) -> Result<Guards, TooLarge> {
        let make = |kind: &GuardKind| -> Result<Box<dyn Guard>, TooLarge> {
            Ok(match kind {
                GuardKind::Contacts => Box::new(ContactGuard),
                GuardKind::Massless => Box::new(MasslessNodes::new(cx)),
                GuardKind::Joints => Box::new(JointGuard),
                GuardKind::Links => Box::new(LinkGuard),
                GuardKind::Jump => Box::new(JumpGuard),
                GuardKind::Twist => Box::new(TwistGuard),
                GuardKind::Strain => Box::new(StrainGuard::default()),
                GuardKind::Drift => Box::new(DriftGuard),
                GuardKind::Stability => Box::new(Stability::new(cx)?),
            })
        };
        cx.plan.guards.iter().map(make).collect::<Result<_, _>>().map(Guards)
    }

    /// Asks one after the other, up to the first that refuses the step.
    ///
    /// # Errors
    /// Why the step is refused.
    pub fn ask(&mut self, mut at: impl FnMut(&mut dyn Guard) -> Result<(), Failure>) -> Result<(), Failure> {
        self.0.iter_mut().try_for_each(|guard| at(guard.as_mut()))
    }

    /// Calls all guards.
    pub fn tell(&mut self, mut of: impl FnMut(&mut dyn Guard)) {
        self.0.iter_mut().for_each(|guard| of(guard.as_mut()));
    }
}

impl Keep for Guards {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        self.0.iter_mut().for_each(|guard| guard.keep(snapshot));
    }
}
