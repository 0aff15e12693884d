//! Eigenpairs of large operators by Krylov spaces: Lanczos' method for those that are symmetric in the metric of a mass or
//! stiffness matrix, Arnoldi's for all others. The operators are inverses behind a factorisation, so that the eigenvalues
//! nearest to its shift come first.

mod arnoldi;
mod basis;
mod dense;
mod lanczos;

pub use arnoldi::{Arnoldi, ComplexPair, Operator};
pub use dense::Complex;
pub use lanczos::{Converged, EigenPair, Lanczos, SymmetricOperator};
