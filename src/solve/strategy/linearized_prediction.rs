//! The residual of a prediction where material yields and supports move in statics. It is linearized in their motion: they alone would
//! strain the elements beside them beyond yield, and the matrix of such a state leads nowhere.

use crate::context::Context;
use crate::step::evaluate::evaluate;
use crate::step::trial::Step;
use crate::system::Prescribed;
use crate::tolerances::linearized_prediction::PART;
use crate::workspace::Workspace;

/// Room for the residual at a small distance from a prediction, for its derivative.
pub struct LinearizedPrediction(Vec<f64>);

impl LinearizedPrediction {
    /// The strategy of a scene; `None` where no material yields, and in dynamics.
    pub fn new(cx: &Context) -> Option<LinearizedPrediction> {
        let differentiates = cx.system.yields() && !cx.is_dynamic();
        differentiates.then(|| LinearizedPrediction(vec![0.0; cx.plan.dofs.unknowns()]))
    }

    /// Writes the residual. Returns its relative size; `None` where no support moves and nothing is written.
    pub fn evaluate(&mut self, cx: &Context, ws: &mut Workspace, step: &Step) -> Option<f64> {
        if ws.prescribed.instant.iter().all(|given| given.u == 0.0) {
            return None;
        }
        let scale = |given: &mut [Prescribed], factor: f64| given.iter_mut().for_each(|given| given.u *= factor);
        scale(&mut ws.prescribed.instant, PART);
        let size = evaluate(cx, ws, step);
        self.0.copy_from_slice(&ws.residual.values);
        scale(&mut ws.prescribed.instant, -1.0);
        evaluate(cx, ws, step);
        scale(&mut ws.prescribed.instant, -1.0 / PART);
        for (r, ahead) in ws.residual.values.iter_mut().zip(&self.0) {
            *r = 0.5 * (*r + ahead) + 0.5 / PART * (ahead - *r);
        }
        Some(size)
    }
}
