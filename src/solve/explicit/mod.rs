//! Explicit steps: accelerations follow from the forces with the mass alone; no stiffness matrix is formed.

mod accelerations;
mod central_difference;
mod critical_step;
mod dense_projection;
mod inner_product;
mod inside_step;
mod node_loops;
mod node_sums;
mod runge_kutta;
mod scaled_step;
mod stiffening;

pub use central_difference::CentralDifferenceStepper;
pub use runge_kutta::RungeKuttaStepper;
