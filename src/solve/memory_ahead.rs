//! Memory of a run after its construction: its state, and matrices of some analyses.

use super::run::Run;
use crate::modes::complex_solver;
use crate::system::assembly::Assembly;
use base::math::Vec6;
use linear::{Solver, TooLarge};
use mechanics::state::Node;
use model::{AnalysisKind, ModeExtent, ResponseMethod};

/// Number of stored modes assumed if all modes below a frequency are wanted.
const MODES_UP_TO: usize = 50;

/// Matrices that a run will need, without numbers. Their memory is taken, but not touched.
pub type MatricesAhead = Vec<(Solver, Option<Assembly>)>;

impl Run<'_> {
    /// The bytes of the state that steps move on, and of the vectors of modes.
    pub fn state_bytes(&self) -> f64 {
        let cx = &self.context;
        let nodes = cx.model.nodes.len();
        let numbers = cx.system.history + cx.system.multipliers() + cx.model.constraints.restraints.len();
        let state = (size_of::<Node>() + 2 * size_of::<Vec6>()) * nodes + size_of::<f64>() * numbers;
        let of_extent = |extent: &ModeExtent| match extent {
            ModeExtent::Count(count) => *count,
            ModeExtent::UpTo(_) => MODES_UP_TO,
        };
        let modes = match &cx.model.analysis.kind {
            AnalysisKind::Dynamic | AnalysisKind::Static => 0,
            AnalysisKind::Modal(asked) => of_extent(&asked.extent),
            AnalysisKind::Buckling(count) => *count,
            AnalysisKind::Response(asked) => of_extent(&asked.extent),
        };
        // A search keeps each vector and the product of the mass with it.
        (state + 2 * size_of::<f64>() * modes * cx.plan.dofs.unknowns()) as f64
    }

    /// Number of later matrices in memory at once: a new one with room for other contact pairs is made beside the old one.
    pub fn copies_ahead(&self) -> f64 {
        if self.context.system.wandering_groups().next().is_some() { 2.0 } else { 1.0 }
    }

    /// The matrices that the run creates later, in the size for the model at rest: with room for contact pairs, and the matrices of modes
    /// and responses.
    ///
    /// # Errors
    /// The memory does not hold them.
    pub fn matrices_ahead(&self) -> Result<MatricesAhead, TooLarge> {
        let cx = &self.context;
        let mut all = MatricesAhead::new();
        if !cx.plan.explicit && cx.system.wandering_groups().next().is_some() {
            let partners = cx.system.partners(&self.workspace.trial.nodes);
            let (solver, assembly) = cx.plan.build_with(cx.system, &partners)?;
            all.push((solver, Some(assembly)));
        }
        if matches!(cx.model.analysis.kind, AnalysisKind::Dynamic | AnalysisKind::Static) {
            return Ok(all);
        }
        if !self.solver().is_symmetric() {
            let (solver, assembly) = cx.plan.build_symmetric(cx.system)?;
            all.push((solver, Some(assembly)));
        }
        if let AnalysisKind::Response(asked) = &cx.model.analysis.kind
            && asked.method == ResponseMethod::Direct
        {
            all.push((complex_solver(&cx.plan.structure)?, None));
        }
        Ok(all)
    }
}
