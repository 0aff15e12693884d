//! The steady motion that harmonic loads and motions of supports cause about a state: amplitude and phase at each frequency.
//!
//! Every motion is the real part of a complex one times exp(iωt). [`direct`] solves (K + iωC − ω²M) x = f at each frequency; [`modal`] uses
//! natural modes.

mod between;
mod damped_rest;
mod direct;
mod dynamic_stiffness;
mod excitation;
mod frequencies;
mod look_up;
mod matrices;
mod modal;
mod resonance;

pub use dynamic_stiffness::complex_solver;

use super::fault::ModesFault;
use super::linearized::Linearized;
use super::mode::Modes;
use super::steady::ResponseProgress;
use crate::system::assembly::Assembly;
use linear::Solver;
use model::{ResponseAsked, ResponseMethod};

/// Finds the response of a model about a state. The solver is symmetric; it and its assembly are overwritten.
///
/// # Errors
/// The reason why there is none.
pub fn find_response(
    at: &Linearized,
    asked: &ResponseAsked,
    linear: (&mut Solver, &mut Assembly),
    mut progress: ResponseProgress,
) -> Result<Modes, ModesFault> {
    let mut found = match asked.method {
        ResponseMethod::Direct => direct::response(at, asked, linear, &mut progress),
        ResponseMethod::Modal => modal::response(at, asked, linear, &mut progress),
    }?;
    found.warnings.extend(found.response.as_ref().and_then(|response| between::missed_in_words(&response.rows)));
    Ok(found)
}
