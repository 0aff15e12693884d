//! Matrices and their factors.

mod factor_store;
mod factorizations;
