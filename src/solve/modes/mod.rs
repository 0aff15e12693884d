//! Small motions about a state: natural modes, buckling loads and the frequency response of the scene linearized there.
//!
//! [`find`] computes modes or the response of a state under the loads that hold it. It knows neither files nor the history of the state.
//! The matrices come from the assembly of steps: K with K(σ), follower loads, joints and contacts, M as in the motion. A Krylov space of
//! the factorized matrix gives the eigenvalues. The signs of its pivots give their number (Sylvester's law of inertia), so none is missed.

mod alike;
mod buckling;
mod damped;
mod damping_modes;
mod fault;
mod gyroscopic;
mod inertia_shapes;
mod linearized;
mod link_forces;
mod matrices;
mod modal;
mod mode;
mod own_nodes;
mod pencil;
mod reduction;
mod response;
mod rest;
mod second_order;
mod shape;
mod shares;
mod speed_modes;
mod speeds;
mod spinning_parts;
mod steady;

pub use damping_modes::find_damped;
pub use fault::ModesFault;
pub use linearized::Linearized;
pub use matrices::SceneMatrices;
pub use mode::{EigenMode, ModeKind, Modes, Share};
pub use reduction::reduce;
pub use response::complex_solver;
pub use rest::{multipliers_at_rest, own_stiffnesses};
pub use speed_modes::{CriticalSpeed, SpeedMode, SpeedModes, Whirl};
pub use steady::{Response, ResponseProgress, ResponseRow, ResponseSoFar};

use crate::system::assembly::Assembly;
use linear::Solver;
use model::AnalysisKind;

/// Finds the modes of the model about a state. The solver and its assembly are overwritten where the solver is symmetric.
///
/// # Errors
/// The reason why there are none; [`ModesFault::Stopped`] where the search is to pause or to end.
pub fn find(
    at: &Linearized,
    linear: (&mut Solver, &mut Assembly),
    progress: ResponseProgress,
) -> Result<Modes, ModesFault> {
    if !at.model.analysis.has_modes() {
        return Ok(Modes::default());
    }
    let mut modes = if linear.0.is_symmetric() {
        find_with(at, linear, progress)?
    } else {
        let (mut solver, mut assembly) = at.symmetric_solver()?;
        find_with(at, (&mut solver, &mut assembly), progress)?
    };
    if at.system.has_sliders() {
        modes.warnings.push(
            "friction pendulums are taken as stuck, with their `stiffness`. Give `friction = 0.0` for the motion on the dish".to_owned(),
        );
    }
    Ok(modes)
}

fn find_with(
    at: &Linearized,
    linear: (&mut Solver, &mut Assembly),
    progress: ResponseProgress,
) -> Result<Modes, ModesFault> {
    match &at.model.analysis.kind {
        AnalysisKind::Dynamic | AnalysisKind::Static => Ok(Modes::default()),
        AnalysisKind::Modal(asked) if asked.damped => {
            let modes = damped::damped_modes(at, asked.extent, (&mut *linear.0, &mut *linear.1))?;
            if asked.speeds.is_empty() { Ok(modes) } else { speeds::over_speeds(at, &asked.speeds, modes, linear) }
        }
        AnalysisKind::Modal(_) => modal::natural_modes(at, linear),
        AnalysisKind::Buckling(_) => buckling::buckling_modes(at, linear),
        AnalysisKind::Response(asked) => response::find_response(at, asked, linear, progress),
    }
}
