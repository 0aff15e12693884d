//! The differences between load steps and time steps in the equilibrium iteration.

use crate::context::Context;
use crate::tolerances::progress::UNBALANCED;
use crate::workspace::Workspace;
use mechanics::integrators::{Coefficients, load_steps};

/// Steps of load, or steps of time.
pub trait Regime {
    /// The relation between displacements and their rates in a step of one stage.
    fn coefficients(&self, cx: &Context, dt: f64) -> Coefficients;

    /// Records the loads and prescribed motion of a step that begins.
    fn begin(&self, _cx: &Context, _ws: &mut Workspace) {}

    /// True if this residual is small enough for a step that ends at rounding, with this tolerance of the deck.
    fn is_precise(&self, _ws: &Workspace, _residual: f64, _tolerance: f64) -> bool {
        true
    }

    /// True where loads are given and the path may end before them.
    fn has_load_control(&self, _cx: &Context) -> bool {
        false
    }
}

/// Steps of time.
pub struct TimeSteps;

impl Regime for TimeSteps {
    fn coefficients(&self, cx: &Context, dt: f64) -> Coefficients {
        cx.model.solution.scheme.coefficients(dt)
    }
}

/// Steps of load in statics.
pub struct LoadStepping;

impl Regime for LoadStepping {
    fn coefficients(&self, _: &Context, _: f64) -> Coefficients {
        load_steps::coefficients()
    }

    fn begin(&self, cx: &Context, ws: &mut Workspace) {
        ws.load_steps.peak.begin_step(&ws.loads.instant, &ws.prescribed.end, cx.length);
    }

    /// Corrections below the digits of positions still matter to a motion that is small itself: a load step waits for its forces.
    fn is_precise(&self, ws: &Workspace, residual: f64, tolerance: f64) -> bool {
        residual <= UNBALANCED * tolerance || ws.load_steps.peak.is_unstressed(residual)
    }

    fn has_load_control(&self, cx: &Context) -> bool {
        !cx.model.analysis.step_length.is_arc_length()
    }
}

/// The regime of an analysis.
pub fn regime(cx: &Context) -> &'static dyn Regime {
    if cx.is_dynamic() { &TimeSteps } else { &LoadStepping }
}
