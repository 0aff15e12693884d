//! Warning for parts without a connection to any support.

use crate::data::{AnalysisKind, Body, Contact, Model, Part, TouchedSurface};
use crate::report::Report;

/// Warns of parts at rest that have no connection to supported ones, and no load. In statics the matrix is singular there; in dynamics they fall
/// or stand still. Where nothing is supported, all of them are free on purpose, unless they deform and fall into the void.
pub fn check_loose(model: &Model, report: &mut Report) {
    let is_static = model.analysis.kind == AnalysisKind::Static;
    if !is_static && model.analysis.kind != AnalysisKind::Dynamic {
        return;
    }
    let falls = model.loading.gravity.norm() > 0.0;
    let place = |node: usize| model.nodes[node].place.map_or(0..0, |[from, to]| from..to);
    let mut groups = Groups::new(model);
    let ground = groups.of(model.nodes.len());
    let mut is_free = vec![true; model.nodes.len() + 1];
    for (node, data) in model.nodes.iter().enumerate() {
        if data.v.norm() + data.omega.norm() > 0.0 || data.given.iter().any(Option::is_some) {
            is_free[groups.of(node)] = false;
        }
    }
    model.loading.nodal.iter().for_each(|load| is_free[groups.of(load.node)] = false);
    model.loading.pressures.iter().flat_map(|load| &load.faces).flat_map(|face| face.nodes()).for_each(|&node| {
        is_free[groups.of(node)] = false;
    });
    if is_static {
        // A load does not hold a part, and bodies that wait for a later stage are left out of the equations.
        is_free.fill(true);
    }
    let deformable = model.parts.iter().filter(|part| part.kind().is_deformable() && part.elements() > 0);
    let parts = deformable.filter_map(|part| Some((part.name(), *part.nodes(0).first()?)));
    let bodies = model.bodies.iter().map(|body| (body.name.as_str(), body.node));
    let masses = model.masses.iter().map(|mass| (model.nodes[mass.node].label.as_str(), mass.node));
    let all: Vec<(&str, usize)> = parts.chain(bodies.chain(masses).filter(|_| !is_static)).collect();
    if !all.iter().any(|(_, node)| groups.of(*node) == ground) {
        return tell_of_all_free(model, all.first(), (is_static, falls), report);
    }
    note_alike(model, &all, (&mut groups, ground), report);
    for (name, node) in all {
        let group = groups.of(node);
        if group == ground || !std::mem::take(&mut is_free[group]) {
            continue;
        }
        let does = match is_static {
            true => "has no static equilibrium",
            false if falls => "falls freely",
            false => "stands still",
        };
        let message = format!("nothing joins `{name}` to the parts that supports hold: it {does}");
        let hint = "name a point of it in another part, or join it by `[[joints]]`, `[[ties]]`, `[[attachments]]`, `[[links]]` or `[[contacts]]`";
        report.warn(&place(node), message, hint);
    }
}

/// Tells that nothing holds the `first` part or any other. A deck that means this gets no message.
fn tell_of_all_free(
    model: &Model,
    first: Option<&(&str, usize)>,
    (is_static, falls): (bool, bool),
    report: &mut Report,
) {
    let Some((name, node)) = first else { return };
    let place = model.nodes[*node].place.map_or(0..0, |[from, to]| from..to);
    let is_still = model.nodes.iter().all(|node| node.v.norm() + node.omega.norm() == 0.0);
    let lands = model.parts.iter().any(|part| !part.touched_nodes().is_empty());
    let deforms = model.parts.iter().any(|part| part.kind().is_deformable());
    let is_meant = lands || !(is_static || falls && is_still && model.loading.nodal.is_empty());
    if !is_meant && deforms {
        let does = if is_static { "there is no static equilibrium" } else { "all of them fall freely" };
        let message = format!("no support, joint or contact holds `{name}` or any other part: {does}");
        report.warn(&place, message, "add `[[supports]]`");
    } else if falls && !is_static && !lands_on_ground(model) {
        let message = format!(
            "no support, joint or contact holds `{name}` or any other part to the ground: all of them fall freely"
        );
        report.note(&place, message, "add `[[supports]]`, if that is not meant");
    } else if !falls && deforms && is_still && !lands && pushes_at_end(model) {
        let message = format!("no support, joint or contact holds `{name}` or any other part against the loads");
        report.note(&place, message, "add `[[supports]]`, if it is not meant to fly");
    }
}

/// True if a load acts to the end. A load for a throw ends before.
fn pushes_at_end(model: &Model) -> bool {
    let at_end = |index: usize| model.loading.amplitudes[index].value(model.analysis.end_time);
    model.loading.nodal.iter().any(|load| load.amplitude.is_none_or(|index| at_end(index) != 0.0))
}

/// Notes parts with the initial velocity of other parts, if only the others are joined to the ground.
fn note_alike(model: &Model, all: &[(&str, usize)], (groups, ground): (&mut Groups, usize), report: &mut Report) {
    let v = |node: usize| model.nodes[node].v;
    let (held, others): (Vec<_>, Vec<_>) = all.iter().partition(|(_, node)| groups.of(*node) == ground);
    let alike = |node: usize| v(node).norm() > 0.0 && held.iter().any(|(_, other)| v(*other) == v(node));
    let mut told = Vec::new();
    for (name, node) in others.into_iter().filter(|(_, node)| alike(*node)) {
        let group = groups.of(node);
        if told.contains(&group) {
            continue;
        }
        told.push(group);
        let place = model.nodes[node].place.map_or(0..0, |[from, to]| from..to);
        let message = format!("`{name}` starts with the velocity of other parts, and nothing joins it to them");
        report.note(
            &place,
            message,
            "join it by `[[attachments]]`, `[[joints]]` or `[[contacts]]`, if it belongs to them",
        );
    }
}

/// True where a contact has a surface on the ground.
fn lands_on_ground(model: &Model) -> bool {
    model.each::<Contact>().any(|contact| match &contact.surface {
        TouchedSurface::Shape(carried) => Body::at(&model.bodies, carried.node).is_none(),
        TouchedSurface::Facets(_) => false,
    })
}

/// True where supports hold each deformable part and each body, though all contacts are open: gravity then has an equilibrium.
pub fn holds_all(model: &Model) -> bool {
    let mut groups = Groups::joined_by(model, |part| !matches!(part, Part::Contact(_)));
    let ground = groups.of(model.nodes.len());
    let parts = model.parts.iter().filter(|part| part.kind().is_deformable() && part.elements() > 0);
    let mut nodes =
        parts.filter_map(|part| part.nodes(0).first().copied()).chain(model.bodies.iter().map(|body| body.node));
    nodes.all(|node| groups.of(node) == ground)
}

/// The nodes that elements, joints, attachments, links and contacts join, and the ground as one more node behind the last.
struct Groups {
    towards: Vec<usize>,
}

impl Groups {
    fn new(model: &Model) -> Groups {
        Groups::joined_by(model, |_| true)
    }

    /// The groups by those parts alone that `joins` selects.
    fn joined_by(model: &Model, joins: impl Fn(&Part) -> bool) -> Groups {
        let count = model.nodes.len();
        let mut groups = Groups { towards: (0..=count).collect() };
        for part in model.parts.iter().filter(|part| joins(part)) {
            let touched = part.touched_nodes();
            let carrier = touched.first().copied();
            for element in 0..part.elements() {
                let nodes = part.nodes(element).iter().chain(&carrier);
                nodes.for_each(|&node| groups.join(part.nodes(element)[0], node));
            }
            carrier.iter().for_each(|&first| touched.iter().for_each(|&node| groups.join(first, node)));
        }
        let constraints = &model.constraints;
        constraints.dependents.iter().for_each(|dependent| groups.join(dependent.node, dependent.master));
        constraints.joints.iter().for_each(|joint| joint.all_ends().for_each(|end| groups.join(joint.ends[0], end)));
        constraints.restraints.iter().for_each(|restraint| groups.join(restraint.node, count));
        // A damper holds nothing at rest.
        let dampers = model.damping.nodal.iter().filter(|_| model.analysis.kind == AnalysisKind::Dynamic);
        dampers.for_each(|damper| groups.join(damper.node, count));
        groups
    }

    fn join(&mut self, a: usize, b: usize) {
        let [a, b] = [self.of(a), self.of(b)];
        self.towards[a.max(b)] = a.min(b);
    }

    fn of(&mut self, mut node: usize) -> usize {
        while self.towards[node] != node {
            self.towards[node] = self.towards[self.towards[node]];
            node = self.towards[node];
        }
        node
    }
}
