//! Relaxation of corrections for material with history: a too long correction is shortened, and if the matrix is not the derivative,
//! corrections are combined with earlier ones.

use crate::context::Context;
use crate::step::correct::Correction;
use crate::step::residual::Residual;
use crate::step::size::Size;
use crate::step::trial::TrialMotion;
use crate::strategy::anderson::Anderson;
use crate::strategy::line_search::LineSearch;
use crate::system::Multipliers;
use base::snapshot::keep;
use model::Method;

/// The corrections of a step so far. It is allocated once.
pub struct Relaxation {
    line_search: LineSearch,
    /// Acceleration where the matrix is not the derivative because material yields.
    anderson: Option<Anderson>,
}

keep!(Relaxation { line_search, anderson });

impl Relaxation {
    /// The relaxation of a scene; `None` where nothing has a history, and along a path of given arc length.
    pub fn new(cx: &Context, method: Method) -> Option<Relaxation> {
        let Context { model, plan, system, length, .. } = *cx;
        if system.history == 0 || model.analysis.step_length.is_arc_length() {
            return None;
        }
        let weights = plan.dofs.nodal_dofs().iter().map(|&(_, dof)| if dof < 3 { 1.0 } else { length });
        // Gaps stand in place of multipliers.
        let gaps = system
            .joints
            .iter()
            .flat_map(|joint| &joint.equations)
            .map(|row| if row.is_rotational() { length } else { 1.0 });
        let mixes = system.yields() && method != Method::TangentStiffness;
        Some(Relaxation {
            line_search: LineSearch::new(
                [plan.dofs.nodal_dofs().len(), model.nodes.len(), system.multipliers()],
                model.parts.iter().any(|part| part.kind().is_unilateral()),
            ),
            anderson: mixes.then(|| Anderson::new(weights.chain(gaps))),
        })
    }

    /// Forgets earlier corrections.
    pub fn forget(&mut self) {
        self.line_search.forget();
        self.forget_combined();
    }

    fn forget_combined(&mut self) {
        if let Some(anderson) = &mut self.anderson {
            anderson.forget();
        }
    }

    /// Shortens the last correction if the residual after it, of relative `size`, shows that it went too far; returns whether it did.
    pub fn shorten(
        &mut self,
        cx: &Context,
        residual: &Residual,
        size: f64,
        trial: &mut TrialMotion,
        multipliers: &mut Multipliers,
    ) -> bool {
        let values = &mut multipliers.values;
        let shortened = self.line_search.shorten(residual.of_nodes(cx), size, &mut trial.increments, values);
        if shortened {
            // The shortened correction is no longer the one that was combined.
            self.forget_combined();
        }
        shortened
    }

    /// Keeps the residual, of this relative `size`, before the system is solved.
    pub fn keep_residual(&mut self, cx: &Context, residual: &Residual, size: f64, multipliers: &Multipliers) {
        self.line_search.keep_residual(residual.of_nodes(cx), &multipliers.gaps, size);
    }

    /// Combines a correction with earlier ones, and keeps it. Returns its size before: a combined one may be small by chance, the plain one
    /// tells how far there is to go.
    #[inline(never)]
    pub fn combine(
        &mut self,
        cx: &Context,
        correction: &mut Correction,
        trial: &TrialMotion,
        multipliers: &Multipliers,
    ) -> Size {
        let plain = correction.size(cx);
        if let Some(anderson) = &mut self.anderson {
            anderson.mix(&mut correction.values);
        }
        self.line_search.keep_correction(correction.of_nodes(cx), &trial.increments, &multipliers.values);
        plain
    }
}
