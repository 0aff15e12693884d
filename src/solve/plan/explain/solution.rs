//! The solution of a step in words: the iteration, the matrix, and when the matrix is renewed.

use super::explanation::Explanation;
use crate::plan::Plan;
use crate::system::System;
use linear::Factorization;
use model::{Gyroscopic, Method, Model, Update};

/// Adds lines about the iteration and the matrix.
pub fn explain(text: &mut Explanation, plan: &Plan, model: &Model, system: &System) {
    if plan.explicit {
        plan.explain_masses(system).into_iter().for_each(|what| text.add("matrix", what));
        return;
    }
    if system.yields() {
        text.add("iteration", iteration(model));
    }
    text.add("matrix", matrix(plan, model, system));
    text.add("  formed", formed(plan, model, system));
}

fn iteration(model: &Model) -> &'static str {
    match model.solution.iteration.method {
        _ if model.analysis.step_length.is_arc_length() => {
            "tangent stiffness (Newton): arc length needs the path's tangent"
        }
        Method::TangentStiffness => "tangent stiffness (Newton), consistent with the stress update",
        Method::InitialLoad => {
            "initial stiffness (initial load method): elastic matrix, plastic stress on the right-hand side"
        }
        Method::Auto => "modified Newton with Anderson acceleration: the tangent is reused while it converges",
    }
}

fn matrix(plan: &Plan, model: &Model, system: &System) -> &'static str {
    match plan.kind {
        Factorization::Cholesky if model.analysis.is_linear() && system.multipliers() > 0 => {
            "stiffness at t = 0, sparse L D Lᵀ because of the multipliers"
        }
        Factorization::Cholesky if model.analysis.is_linear() => "stiffness at t = 0, sparse Cholesky",
        Factorization::BlockLu if model.solution.iteration.gyroscopic == Gyroscopic::Right => {
            "tangent without gyroscopic terms (these are in the residual), sparse LU by nodal blocks"
        }
        Factorization::BlockLu => "consistent unsymmetric tangent, sparse LU by nodal blocks",
        Factorization::Cholesky if system.multipliers() > 0 => {
            "symmetric part of the tangent, sparse L D Lᵀ because of the multipliers; the residual is exact"
        }
        Factorization::Cholesky => "symmetric part of the tangent, sparse Cholesky; the residual is exact",
    }
}

fn formed(plan: &Plan, model: &Model, system: &System) -> &'static str {
    let mixes = system.yields() && model.solution.iteration.method != Method::TangentStiffness;
    match (plan.linear, model.solution.iteration.update) {
        _ if model.analysis.is_linear() => "once, for all loads",
        _ if model.analysis.step_length.is_arc_length() => "in every iteration: arc length needs the path's tangent",
        (true, _) => "once per step length: the scene is linear",
        (_, Update::Iteration) => "in every iteration",
        (_, Update::Auto) if !model.analysis.is_dynamic() && !mixes => {
            "in every iteration: load steps are long and few"
        }
        (_, Update::Step) => "once per step",
        (_, Update::Auto) => "when convergence slows down",
        (_, Update::Never) => "once, in the first step",
    }
}
