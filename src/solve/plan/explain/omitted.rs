//! The omissions in words: degrees of freedom, constraint equations, terms of the equation of motion, and why.

use crate::plan::Plan;
use crate::plan::dof_status::DofStatus;
use crate::system::System;
use model::{MassKind, Model};
use std::ops::Range;

/// One line for each kind of omission.
pub fn list(plan: &Plan, model: &Model, system: &System) -> Vec<String> {
    let mut lines = degrees_of_freedom(plan, system);
    if !model.constraints.joints.is_empty() {
        let all: usize = model.constraints.joints.iter().map(|joint| joint.equations.len()).sum();
        let kept = system.multipliers();
        if all > kept {
            let equations = if all - kept == 1 { "equation" } else { "equations" };
            lines.push(format!("{} constraint {equations} of joints: out of the plane of the motion", all - kept));
        }
    }
    lines.extend(terms(plan, model, system).into_iter().map(str::to_owned));
    if model.output.nodes.is_empty() {
        let why = "no node is named; `[output] nodes` can be \"all\", sets or groups of the mesh";
        lines.push(format!("nodes.csv: {why}"));
    }
    lines
}

/// The degrees of freedom that are no unknowns, counted by reason.
fn degrees_of_freedom(plan: &Plan, system: &System) -> Vec<String> {
    let axis = ["x", "y", "z"][system.plane.unwrap_or(0)];
    let plane =
        format!("degrees of freedom out of the plane normal to {axis}: the scene is plane, nothing excites them");
    let reasons: [(DofStatus, Range<usize>, &str); 7] = [
        (DofStatus::Restrained, 0..6, "restrained or prescribed degrees of freedom"),
        (
            DofStatus::Dependent,
            0..6,
            "degrees of freedom of dependent nodes: eliminated at element level, the nodes being rigidly attached",
        ),
        (DofStatus::Unused, 0..3, "translations without element or mass"),
        (DofStatus::Unused, 3..6, "rotations without element or rotary inertia"),
        (DofStatus::Inactive, 0..6, "inactive degrees of freedom: free masses that nothing sets in motion"),
        (DofStatus::Plane, 0..6, &plane),
        (
            DofStatus::Reduced,
            0..6,
            "degrees of freedom inside of reduced parts: they follow from the interface and the modes",
        ),
    ];
    let counted = reasons.into_iter().map(|(why, dofs, what)| (plan.count(why, dofs), what));
    let line = |(count, what): (usize, &str)| match count {
        1 => format!("1 {}", what.replacen("degrees of freedom", "degree of freedom", 1)),
        _ => format!("{count} {what}"),
    };
    counted.filter(|(count, _)| *count > 0).map(line).collect()
}

/// The terms of the equation of motion that this scene does without.
fn terms(plan: &Plan, model: &Model, system: &System) -> Vec<&'static str> {
    let kinds = || model.parts.iter().filter_map(|part| part.mass_kind());
    let deformable = kinds().next().is_some();
    let mut out = Vec::new();
    if model.analysis.has_modes() {
        if model.analysis.response().is_some() && !system.is_damped() {
            out.push("damping: none is given");
        } else if !model.analysis.damps_modes() && system.is_damped() {
            out.push("damping: `damped = true` takes it into modes");
        }
    } else if model.analysis.is_static() {
        out.push("inertia and damping: the analysis is static");
    } else {
        out.extend(gyroscopic(plan, model, system));
        if !system.is_damped() {
            out.push("damping: none is given");
        }
    }
    if !deformable {
        out.push("element stiffness: there are bodies, links and joints only");
    }
    if model.analysis.has_inertia() {
        if deformable && kinds().all(|kind| kind != MassKind::Consistent) {
            out.push("off-diagonal mass terms: masses are lumped");
        }
        if kinds().any(|kind| kind == MassKind::FreeNodes) {
            out.push("masses of deformable parts at nodes attached to bodies: `mass = \"free-nodes\"`");
        }
        if kinds().any(|kind| kind == MassKind::None) {
            out.push("masses of deformable parts: `mass = \"none\"`");
        }
    }
    if !system.yields() {
        out.push("history at integration points: all materials are elastic");
    }
    out
}

fn gyroscopic(plan: &Plan, model: &Model, system: &System) -> Option<&'static str> {
    let has_rotary = system.inertias.iter().any(|i| {
        i.rotary
            && (3..6).any(|dof| {
                plan.is_unknown(i.node, dof) || model.constraints.dependents.iter().any(|r| r.node == i.node)
            })
    });
    match has_rotary {
        false => Some("gyroscopic terms: no rotary inertia is in rotation"),
        true if plan.count(DofStatus::Plane, 0..6) > 0 => Some("gyroscopic terms: rotation about one axis only"),
        true => None,
    }
}
