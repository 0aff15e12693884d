//! What must hold for whole scenes, whatever they are made of: the matrix is the derivative of the residual, answers turn
//! with the scene, what is conserved stays, and one scene described in two ways has one answer.

pub mod scene;

mod balance;
mod energy;
mod equivalence;
mod every_scheme;
mod motion;
mod objectivity;
mod omission;
mod rejection;
mod shells;
mod spinning;
mod tangent;
