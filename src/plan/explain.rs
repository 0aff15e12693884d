//! The plan in words, for `rdsolve check` and the log.

use super::Plan;
use crate::elements::beam::IntegrationRule;
use crate::elements::contact::Shape;
use crate::linear::Factorization;
use crate::model::{
    AnalysisKind, Bar, Beam, Contact, DIRECTIONS, Gyroscopic, MassKind, MeshFile, Method, Model, Part, PartKind,
    PartType, Shell, StepLength, Update,
};
use crate::names::{joined, short};
use std::fmt::Write;

/// What touches what, and how.
fn contact_in_words(model: &Model, contact: &Contact) -> String {
    let shape = match contact.surface.shape {
        Shape::Plane => "a plane",
        Shape::Box { .. } => "a box",
        Shape::Sphere { .. } => "a sphere",
        Shape::Cylinder { .. } => "a cylinder",
        Shape::Capsule { .. } => "a capsule",
    };
    let carrier = model.bodies.iter().find(|body| body.node == contact.node);
    let on = carrier.map_or("the ground".to_string(), |body| format!("body `{}`", body.name));
    let (name, count) = (&contact.name, contact.points.len());
    let points = if count == 1 { "point" } else { "points" };
    let mut text = format!("`{name}`: {count} {points} against {shape} on {on}");
    let radius = contact.points.iter().map(|point| point.radius).fold(0.0, f64::max);
    if radius > 0.0 {
        let _ = write!(text, ", radius {}", short(radius));
    }
    let Some(law) = &contact.law else { return text + "; a zone: nothing acts, the gap is watched" };
    let chosen = if contact.chosen { ", chosen: an impact lasts 20 steps" } else { "" };
    let _ = write!(text, "; {} of force per depth{chosen}", short(law.stiffness));
    if law.resolution < f64::INFINITY {
        let _ = write!(text, "; impacts in steps that reach {} ahead at most", short(law.resolution));
    }
    text
}

impl Plan {
    /// Lines of plain text: what will be computed, what is left out and why.
    pub fn explain(&self, model: &Model, system: &crate::system::System) -> String {
        let mut text = String::new();
        let mut line = |label: &str, what: String| {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{label:<12}{what}");
        };
        let analysis = &model.analysis;
        let steps = (analysis.end_time / analysis.nominal_step() - 1e-9).ceil().max(1.0);
        match analysis.kind {
            AnalysisKind::Static => match &analysis.step_length {
                StepLength::ArcLength(control) => {
                    let end = match control.stop {
                        None => String::new(),
                        Some(stop) => {
                            let (node, direction) = (&model.nodes[stop.node].label, DIRECTIONS[stop.dof]);
                            format!(", or {direction} of {node} = {}", stop.value)
                        }
                    };
                    let to = format!("to t = {}{end}", analysis.end_time);
                    line("analysis", format!("static, by arc length {to}, the first step {} of t", control.first));
                }
                _ => line("analysis", format!("static, {steps} load steps")),
            },
            AnalysisKind::Dynamic => {
                let time = match &analysis.step_length {
                    StepLength::StabilityLimited { fraction } => {
                        format!("in steps of {fraction} of the longest that is stable")
                    }
                    StepLength::ErrorControlled { tolerance, .. } => {
                        format!("in steps that follow their error, {tolerance} in all")
                    }
                    _ => format!("in {steps} steps of {}", analysis.nominal_step()),
                };
                line("analysis", format!("dynamic, to t = {} {time}, {}", analysis.end_time, model.scheme.in_words()));
                if let Some(note) = model.scheme.note() {
                    line("  note", note.to_string());
                }
            }
        }
        let parts = PartKind::ALL.map(|kind| {
            let of_kind = model.parts.iter().filter(|part| part.kind() == kind);
            (of_kind.map(Part::counted).sum(), kind.counted_as())
        });
        let before = [(model.nodes.len(), ["node", "nodes"]), (model.bodies.len(), ["body", "bodies"])];
        let after =
            [(model.riders.len(), ["attached node", "attached nodes"]), (model.joints.len(), ["joint", "joints"])];
        let parts: Vec<String> = [&before[..], &parts, &after]
            .into_iter()
            .flatten()
            .filter(|(count, _)| *count > 0)
            .map(|(count, [one, more])| format!("{count} {}", if *count == 1 { one } else { more }))
            .collect();
        line("model", parts.join(", "));
        if let Some(mesh) = &model.mesh {
            let MeshFile { path, nodes, elements, used, .. } = mesh;
            line("mesh", format!("`{path}`: {nodes} nodes, {elements} elements, {used} of them in parts"));
        }
        for rigid in &model.rigid {
            let body = &model.bodies[rigid.body];
            let words: Vec<&str> = rigid.parts.iter().map(String::as_str).collect();
            line("rigid", format!("{} as body `{}`, mass {}", joined(&words), body.name, short(body.mass)));
            line("  left out", format!("its {} elements and the nodes that nothing else needs", rigid.elements));
        }
        line("unknowns", self.unknowns.to_string());
        for omission in &self.omissions {
            line("  left out", format!("{} {}", omission.count, omission.what));
        }
        for what in self.unneeded(model, system) {
            line("  left out", what.to_string());
        }
        if !model.joints.is_empty() {
            let all: usize = model.joints.iter().map(|joint| joint.rows.len()).sum();
            let kept = system.multipliers();
            line("joints", format!("{kept} multipliers (57), joints closed at the end of each step"));
            if all > kept {
                line("  left out", format!("{} rows out of the plane of the motion", all - kept));
            }
            for text in self.repeated(model, system) {
                line("  repeated", text);
            }
        }
        for beam in model.each::<Beam>() {
            let Some(yielding) = &beam.yielding else { continue };
            let (fibres, points) = (yielding.fibres.len(), yielding.points);
            let rule = if yielding.rule == IntegrationRule::Gauss { "Gauss" } else { "Lobatto" };
            let shear =
                if yielding.shear { "yield under normal and shear stress" } else { "yield under normal stress alone" };
            line(
                "yields",
                format!("beam `{}`: {fibres} fibres at {points} {rule} points an element, {shear}", beam.name),
            );
            if system.merges_fibres(beam) {
                line("  left out", "fibres beside one another: the motion is plane, they strain alike".to_string());
            }
        }
        for bar in model.each::<Bar>().filter(|bar| bar.yielding.is_some()) {
            line("yields", format!("bar `{}`", bar.name));
        }
        for part in model.parts.chunk_by(Part::is_one_with) {
            let Some(shell) = Shell::of(&part[0]) else { continue };
            let Some(yielding) = &shell.yielding else { continue };
            let what = format!("{} layers, yield under membrane stress; transverse shear elastic", yielding.layers);
            line("yields", format!("shell `{}`: {what}", shell.name));
        }
        for contact in model.each::<Contact>() {
            line("contact", contact_in_words(model, contact));
        }
        let along = analysis.step_length.is_arc_length();
        if system.yields() && !self.explicit {
            let method = match model.iteration.method {
                _ if along => "tangent stiffness: along a path nothing else tells where it goes",
                Method::TangentStiffness => "tangent stiffness: the matrix is the derivative of the stress",
                Method::InitialLoad => {
                    "initial load: the matrix is elastic, plastic stress stands on the right-hand side (11)"
                }
                Method::Auto => "auto: a matrix is kept while corrections mixed with earlier ones contract well enough",
            };
            line("method", method.to_string());
        }
        if self.explicit {
            self.explain_masses(system).into_iter().for_each(|what| line("matrix", what));
            return text;
        }
        let matrix = match self.kind {
            Factorization::BlockLu if model.iteration.gyroscopic == Gyroscopic::Right => {
                "gyroscopic term on the right, sparse LU by blocks of nodes; the residual stays exact"
            }
            Factorization::BlockLu => "exact unsymmetric tangent, sparse LU by blocks of nodes",
            Factorization::Cholesky if system.multipliers() > 0 => {
                "symmetric part of the tangent, sparse L D Lᵀ for the multipliers; the residual stays exact"
            }
            Factorization::Cholesky => "symmetric part of the tangent, sparse Cholesky; the residual stays exact",
        };
        line("matrix", matrix.to_string());
        let mixes = system.yields() && model.iteration.method != Method::TangentStiffness;
        let update = match (self.linear, model.iteration.update) {
            _ if along => "in every iteration: a step needs the path's direction at hand",
            (true, _) => "once per length of step: the scene is linear",
            (_, Update::Iteration) => "in every iteration",
            (_, Update::Auto) if analysis.kind == AnalysisKind::Static && !mixes => {
                "in every iteration: load steps are long and few"
            }
            (_, Update::Step) => "once a step",
            (_, Update::Auto) => "when convergence slows",
            (_, Update::Never) => "never after the first",
        };
        line("  refreshed", update.to_string());
        text
    }

    /// What joints hold more than once, a line for each joint.
    pub fn repeated(&self, model: &Model, system: &crate::system::System) -> Vec<String> {
        let Some(repeated) = &self.repeated else {
            return vec!["too many joints to look for what is held more than once".to_string()];
        };
        let mut lines: Vec<(usize, Vec<&str>)> = Vec::new();
        for (joint, row) in repeated.iter().filter_map(|&number| system.row(number)) {
            match lines.last_mut().filter(|(last, _)| *last == joint) {
                Some((_, words)) => words.push(row.word()),
                None => lines.push((joint, vec![row.word()])),
            }
        }
        let line = |(joint, words): (usize, Vec<&str>)| {
            let name = &model.joints[joint].name;
            format!("joint `{name}`, {}: others hold it too, they share what they carry", joined(&words))
        };
        lines.into_iter().map(line).collect()
    }

    /// Terms of the equation of motion that this scene does without.
    fn unneeded(&self, model: &Model, system: &crate::system::System) -> Vec<&'static str> {
        let kinds = || model.parts.iter().filter_map(Part::mass_kind);
        let deformable = kinds().next().is_some();
        let static_analysis = model.analysis.kind == AnalysisKind::Static;
        let turning = system.inertias.iter().any(|i| {
            i.rotary && (3..6).any(|dof| self.is_unknown(i.node, dof) || model.riders.iter().any(|r| r.node == i.node))
        });
        let plane = self.omissions.iter().any(|o| o.what.contains("plane"));
        let mut out = Vec::new();
        if static_analysis {
            out.push("inertia and damping: static");
        } else {
            if !turning {
                out.push("gyroscopic term C(r): no rotary inertia turns");
            } else if plane {
                out.push("gyroscopic term C(r): rotation about one axis only");
            }
            if !system.is_damped() {
                out.push("damping: none is given, simplification (2)");
            }
        }
        if !deformable {
            out.push("stiffness of elements: bodies, links and joints are all there is");
        } else if model.bodies.is_empty() && model.riders.is_empty() {
            out.push("constraint map (58): nothing rides on a body or node");
        }
        if !static_analysis {
            if deformable && kinds().all(|kind| kind != MassKind::Consistent) {
                out.push("masses beside the diagonal: they are lumped, the paper's simplification (1)");
            }
            if kinds().any(|kind| kind == MassKind::FreeNodes) {
                out.push("masses of deformable parts at nodes attached to bodies, simplification (3): `mass = \"free-nodes\"`");
            }
            if kinds().any(|kind| kind == MassKind::None) {
                out.push("masses of deformable parts, simplification (4): `mass = \"none\"`");
            }
        }
        if !system.yields() {
            out.push("history of material points: all materials are elastic");
        }
        out
    }
}
