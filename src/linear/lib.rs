//! The linear system K x = r of an implicit step, factored thousands of times with one structure.
//!
//! [`Solver::new`] decides order of elimination, fill and place of each number once. [`Solver::factor`] and [`Solver::solve`] then run over
//! flat lists and, on one thread, allocate nothing. There are two factorizations: LU on small dense blocks for small systems and
//! unsymmetric values, and supernodal Cholesky for large symmetric systems. A factor too large for the memory lies in a file. Iterative
//! methods are left out.

#![warn(missing_docs)]

mod block_lu;
mod block_slot;
mod cholesky;
mod dense;
mod dissection;
pub mod eigen;
mod elimination;
mod factor_store;
mod factorization;
mod fronts;
mod graph;
mod indefinite;
mod kernel;
mod memory;
mod packed;
mod panel;
mod pivot;
mod pool;
mod solver;
mod sparse;
mod stats;
mod stops;
mod structure;
mod substitution;
mod tree;
mod triangle;

pub use block_lu::BlockLu;
pub use block_slot::BlockSlot;
pub use cholesky::Cholesky;
pub use elimination::operations;
pub use factorization::Factorization;
pub use memory::{TooLarge, available as available_memory, products as memory_of_products};
pub use pivot::Singular;
pub use solver::Solver;
pub use sparse::Sparse;
pub use stats::Stats;
pub use stops::StopQuery;
pub use structure::Structure;
