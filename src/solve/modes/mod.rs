//! Small motions about a state: natural modes, buckling loads and the frequency response of the scene linearized there.
//!
//! [`find`] takes a state and the loads that hold it in equilibrium and gives modes or the response; it knows nothing of files or of how the state
//! came about. The matrices are those of a step, from the same assembly: K with K(σ), loads that follow, joints and contacts as
//! they are, M as the program moves masses. Eigenvalues come from a Krylov space of the factorised matrix, and the signs of its
//! pivots tell how many there are (Sylvester's law of inertia), so that none is missed.

mod buckling;
mod damped;
mod fault;
mod gyroscopic;
mod linearized;
mod matrices;
mod modal;
mod mode;
mod pencil;
mod response;
mod rest;
mod shape;
mod shares;
mod steady;

pub use fault::ModesFault;
pub use linearized::Linearized;
pub use matrices::SceneMatrices;
pub use mode::{EigenMode, ModeKind, Modes, Share};
pub use response::complex_solver;
pub use rest::{multipliers_at_rest, own_stiffnesses};
pub use steady::{Response, ResponseRow, ResponseSoFar, Search};

use crate::system::assembly::Assembly;
use linear::Solver;
use model::AnalysisKind;

/// Finds the modes that the model asks for about a state. The solver and its assembly are overwritten where the solver is symmetric.
///
/// # Errors
/// The reason why there are none; [`ModesFault::Stopped`] where the search is to pause or to end.
pub fn find(at: &Linearized, linear: (&mut Solver, &mut Assembly), search: Search) -> Result<Modes, ModesFault> {
    if !at.model.analysis.has_modes() {
        return Ok(Modes::default());
    }
    if linear.0.is_symmetric() {
        return find_with(at, linear, search);
    }
    let (mut solver, mut assembly) = at.symmetric_solver()?;
    find_with(at, (&mut solver, &mut assembly), search)
}

fn find_with(at: &Linearized, linear: (&mut Solver, &mut Assembly), search: Search) -> Result<Modes, ModesFault> {
    match &at.model.analysis.kind {
        AnalysisKind::Dynamic | AnalysisKind::Static => Ok(Modes::default()),
        AnalysisKind::Modal(asked) if asked.damped => damped::damped_modes(at, linear),
        AnalysisKind::Modal(_) => modal::natural_modes(at, linear),
        AnalysisKind::Buckling(_) => buckling::buckling_modes(at, linear),
        AnalysisKind::Response(asked) => response::find_response(at, asked, linear, search),
    }
}
