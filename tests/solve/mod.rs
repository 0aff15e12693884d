//! Parts of steps by themselves.

mod anderson;
mod central_difference;
mod dependents;
mod element_stability;
mod load_steps;
mod schur_factor;
mod trials;
mod turning;
