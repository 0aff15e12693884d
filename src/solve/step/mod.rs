//! A step: residual, tangent, solution and correction until equilibrium is found, then its end, which the state becomes.

pub mod accept;
pub mod commit;
pub mod composite;
pub mod convergence;
pub mod convergence_tolerance;
pub mod correct;
pub mod equilibrium;
pub mod evaluate;
pub mod implicit;
pub mod load_steps;
pub mod newton;
pub mod predict;
pub mod progress;
pub mod projection;
pub mod regime;
pub mod residual;
pub mod runge_kutta;
pub mod size;
pub mod tangent;
pub mod trial;
pub mod work;
