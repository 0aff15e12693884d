//! Families of schemes. Two schemes of a family may share an error; a scheme of another family is an independent answer.

use mechanics::integrators::{Scheme, Stepping};

/// A family of schemes: those whose steps are made alike.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// Equilibrium once a step: Newmark's and its kin.
    OneStage,
    /// Two stages, the second by backward differences.
    Composite,
    /// Diagonally implicit Runge-Kutta.
    DiagonallyImplicit,
    /// Central differences.
    Verlet,
    /// Explicit Runge-Kutta.
    RungeKutta,
}

impl Family {
    /// The family that a scheme belongs to.
    pub fn of(scheme: &dyn Scheme) -> Family {
        match scheme.stepping() {
            Stepping::OneStage => Family::OneStage,
            Stepping::Composite(_) => Family::Composite,
            Stepping::DiagonallyImplicit(_) => Family::DiagonallyImplicit,
            Stepping::Verlet => Family::Verlet,
            Stepping::RungeKutta(_) => Family::RungeKutta,
        }
    }

    /// True where the motion inside automatic steps is known, so that these do not end at output times.
    pub fn looks_inside(self) -> bool {
        matches!(self, Family::DiagonallyImplicit | Family::RungeKutta)
    }
}
