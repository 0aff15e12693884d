//! Functions of time for loads and prescribed motions, with exact derivatives and integrals.
