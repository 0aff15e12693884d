//! `[[bodies]]`: mass, inertia and shape of rigid bodies, or their parts.

use super::data::Body;
use super::places::nodes::Nodes;
use super::report::{Owner, Report};
use super::values::{keys, vec3, vec3_or_zero};
use base::diagnostic::{At, Span};
use base::math::{Mat3, Vec3};
use base::names::{nearest, short};
use deck::Deck;
use deck::bodies as words;
use deck::parts::PartIndex;
use deck::stages::{Stage, StageKind};
use deck::words::kinds::OneOf;
use deck::words::{Names, Table};
use mechanics::solids::element_faces::ElementFaces;
use mechanics::solids::{Solid, SolidShape, drawn_by_inertia};
use std::collections::HashMap;
use std::sync::Arc;

/// Round-off in a principal moment, relative to the largest.
const ROUND_OFF: f64 = 1e-9;

/// Round-off of a principal moment that is zero, relative to the largest.
const NO_INERTIA: f64 = 1e-12;

/// Bodies of the deck, then rigid parts without a body in the deck.
#[derive(Default)]
pub(super) struct Bodies<'d> {
    /// The bodies.
    pub list: Vec<Body>,
    /// The body of each part with `rigid = true`.
    pub body_of: HashMap<PartIndex, usize>,
    /// Bodies with the mass of parts: the body, its parts, and their place in the deck.
    pub of_parts: Vec<(usize, Vec<PartIndex>, &'d Span)>,
}

/// Makes a body and a node for each `[[bodies]]`, also for those with errors since others refer to them, then for each part with
/// `rigid = true`. Nothing in statics depends on mass but weight, so that a body may then have none.
pub(super) fn bodies<'d>(deck: &'d Deck, has_inertia: bool, nodes: &mut Nodes, report: &mut Report<'d>) -> Bodies<'d> {
    let mut bodies = Bodies::default();
    let weighs = deck.environment.as_ref().is_some_and(|of| of.gravity.is_some())
        || deck.loads.iter().any(|load| load.centrifugal.is_some());
    let with_mass = if deck.stages.is_empty() { has_inertia } else { deck.stages.iter().any(has_inertia_in) };
    for (index, body) in deck.bodies.iter().enumerate() {
        let (label, owner) = report.named(("body", "bodies", index), body.name.as_ref(), &body.span);
        let sound =
            if body.parts.is_some() { None } else { mass_properties(&owner, body, (with_mass, weighs), report) };
        let center = match (&body.parts, &body.center, sound.as_ref().and_then(|sound| sound.center)) {
            (Some(_), ..) => Vec3::zeros(),
            (None, None, Some(center)) => center,
            // Where a shape of points has errors, it would have told the centre.
            (None, None, None) if is_of_points(body) => Vec3::zeros(),
            (None, given, _) => report.require(&owner, "center", given).map_or_else(Vec3::zeros, |center| vec3(center)),
        };
        let index = bodies.add(label, center, nodes);
        let node = &mut nodes.list[bodies.list[index].node];
        (node.v, node.omega) = (vec3_or_zero(&body.velocity), vec3_or_zero(&body.angular_velocity));
        if let Some(list) = &body.parts {
            let unused = keys!(body; center, mass, inertia, shape);
            report.reject_unused("a body with `parts`", &unused);
            bodies.take_parts(index, deck, list, report);
        } else {
            let made = &mut bodies.list[index];
            match sound {
                Some(sound) => (made.mass, made.inertia, made.shape) = (sound.mass, sound.inertia, sound.shape),
                None => (made.mass, made.inertia) = (1.0, Mat3::identity()),
            }
        }
    }
    bodies.add_rigid_parts(deck, nodes);
    bodies
}

impl<'d> Bodies<'d> {
    /// A body without mass.
    fn add(&mut self, label: String, center: Vec3, nodes: &mut Nodes) -> usize {
        let node = nodes.add(label.clone(), true, center);
        nodes.connect(node, true);
        let shape = Arc::new(ElementFaces::default());
        self.list.push(Body { name: label, node, mass: 0.0, inertia: Mat3::zeros(), shape });
        self.list.len() - 1
    }

    /// Notes which parts make up a body of the deck.
    fn take_parts(&mut self, index: usize, deck: &'d Deck, list: &'d At<Names>, report: &mut Report<'d>) {
        let parts: Vec<PartIndex> = list.values.iter().filter_map(|name| find_part(deck, name, report)).collect();
        for (k, part) in parts.iter().enumerate() {
            if parts[..k].contains(part) || self.of_parts.iter().any(|(_, others, _)| others.contains(part)) {
                let what = title(deck, *part);
                report.error::<()>(&list.span, format!("{what} is listed in two bodies, or twice in one"));
            }
        }
        if list.values.is_empty() {
            report.error::<()>(&list.span, "`parts` is empty");
        }
        self.of_parts.push((index, parts, &list.span));
    }

    /// A body for each part with `rigid = true`; its mass is known when the part is.
    fn add_rigid_parts(&mut self, deck: &'d Deck, nodes: &mut Nodes) {
        for part in deck.parts().filter(|part| part.is_rigid()) {
            let body = self.add(part.label(), Vec3::zeros(), nodes);
            self.body_of.insert(part.at, body);
            self.of_parts.push((body, vec![part.at], part.span));
        }
    }
}

/// A part by name, before names have places.
fn find_part(deck: &Deck, name: &At<String>, report: &mut Report) -> Option<PartIndex> {
    let parts = || deck.parts().filter(|part| part.at.kind.is_line() || part.at.kind.is_surface());
    if let Some(part) = parts().find(|part| part.is_named(name)) {
        if part.is_rigid() {
            let message = format!("`{}` has `rigid = true`, so it is a separate body", name.value);
            let hint = "remove its `rigid`, or attach it to this body with `[[attachments]]`";
            return report.error_with(&name.span, message, hint);
        }
        return Some(part.at);
    }
    let message = format!("no shell, beam or bar is named `{}`", name.value);
    match nearest(name, parts().filter_map(|part| part.name()).map(|name| name.as_str())) {
        Some(near) => report.error_with(&name.span, message, format!("did you mean `{near}`?")),
        None => report.error_with(&name.span, message, "name a part of the deck"),
    }
}

/// "shell `roof`".
pub(super) fn title(deck: &Deck, part: PartIndex) -> String {
    deck.part(part).map_or_else(String::new, |part| part.title())
}

/// True for a body whose shape defines its position.
fn is_of_points(body: &words::Body) -> bool {
    let kind = body.shape.as_ref().and_then(|shape| shape.kind.as_ref());
    kind.is_some_and(|kind| kind.value.takes("points") || kind.value.takes("ends"))
}

/// True for a stage in which masses matter.
fn has_inertia_in(stage: &At<Table<Stage>>) -> bool {
    let kind = stage.kind.as_ref().map(|kind| kind.value);
    !matches!(kind, Some(StageKind::Static | StageKind::Buckling))
}

/// Mass, inertia and shape of a body.
struct MassProperties {
    mass: f64,
    inertia: Mat3,
    shape: Arc<dyn SolidShape>,
    /// The centre of mass, if the shape defines it.
    center: Option<Vec3>,
}

fn mass_properties<'d>(
    owner: &Owner<'d>,
    body: &'d words::Body,
    (with_mass, weighs): (bool, bool),
    report: &mut Report<'d>,
) -> Option<MassProperties> {
    let solid = match &body.shape {
        Some(shape) => Some(read_solid(shape, &owner.what, report)?),
        None => None,
    };
    let density = body.shape.as_ref().and_then(|shape| shape.density.as_ref());
    let mass = match (&body.mass, density, &solid) {
        (Some(mass), Some(density), _) => {
            let message = format!("{} has both a mass and a density", owner.what);
            return report.error_with(
                &density.span,
                message,
                format!("remove one of them: the mass is given as {}", mass.value),
            );
        }
        (None, Some(_), Some(solid)) => {
            let density = &body.shape.as_ref()?.density;
            report.positive("density", density)? * solid.volume
        }
        (None, None, _) if !with_mass && weighs && !report.is_spoiled(owner.span, "mass") => {
            let message = format!("gravity acts, and {} has no `mass`", owner.what);
            return report.error_with(owner.span, message, "give it its mass, or `mass = 0.0` if it has no weight");
        }
        (None, None, _) if !with_mass && !report.is_spoiled(owner.span, "mass") => 0.0,
        (Some(mass), ..) if !with_mass && mass.value == 0.0 => 0.0,
        (None, None, None) if !report.is_spoiled(owner.span, "mass") => {
            let message = format!("{} needs `mass`", owner.what);
            return report.error_with(owner.span, message, "only in statics and buckling a body may have none");
        }
        (None, None, Some(_)) if !report.is_spoiled(owner.span, "mass") => {
            let message = format!("{} needs `mass`, or a density in its shape", owner.what);
            return report.error(owner.span, message);
        }
        _ => report.require_positive(owner, "mass", &body.mass)?,
    };
    let center = solid.as_ref().and_then(|solid| solid.center);
    if let Some(values) = &body.inertia {
        let inertia = read_inertia(values, report)?;
        let shape = solid.map_or_else(|| drawn_by_inertia(mass, &inertia), |solid| solid.shape);
        return Some(MassProperties { mass, inertia, shape, center });
    }
    match solid {
        Some(solid) => Some(MassProperties { mass, inertia: solid.inertia * mass, shape: solid.shape, center }),
        None if !with_mass && body.inertia.is_none() && !report.is_any_spoiled(owner.span) => {
            let shape = Arc::new(ElementFaces::default());
            Some(MassProperties { mass, inertia: Mat3::zeros(), shape, center })
        }
        None if report.is_spoiled(owner.span, "inertia") || report.is_spoiled(owner.span, "shape") => None,
        None => {
            let message = format!("{} needs `inertia` or `shape`", owner.what);
            report.error_with(owner.span, message, "a mass without inertia goes into [[masses]], on a point")
        }
    }
}

/// Converts three or six values to a matrix; it must be the inertia of a real body.
pub(super) fn read_inertia(values: &At<Vec<f64>>, report: &mut Report) -> Option<Mat3> {
    let [xx, yy, zz, xy, yz, zx] = match values.as_slice() {
        &[xx, yy, zz] => [xx, yy, zz, 0.0, 0.0, 0.0],
        &[xx, yy, zz, xy, yz, zx] => [xx, yy, zz, xy, yz, zx],
        other => {
            let message = format!("`inertia` has {} values", other.len());
            return report.error_with(&values.span, message, "three: xx, yy, zz; or six: xx, yy, zz, xy, yz, zx");
        }
    };
    let inertia = Mat3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz);
    let mut moments = inertia.symmetric_eigenvalues();
    moments.as_mut_slice().sort_by(f64::total_cmp);
    if moments[0] < -NO_INERTIA * moments[2] || moments[1] <= 0.0 {
        let message = "`inertia` must have two positive principal moments, and no negative one";
        return report.error_with(&values.span, message, format!("the smallest is {}", short(moments[0])));
    }
    if moments[2] > (moments[0] + moments[1]) * (1.0 + ROUND_OFF) {
        let [a, b, c] = [0, 1, 2].map(|i| short(moments[i]));
        let message = "no body has this inertia: a principal moment is larger than the sum of the other two";
        return report.error_with(&values.span, message, format!("{c} > {a} + {b}"));
    }
    Some(inertia)
}

fn read_solid<'d>(shape: &'d At<OneOf<words::BodyShape>>, body: &str, report: &mut Report<'d>) -> Option<Solid> {
    let owner = Owner::new(format!("the shape of {body}"), &shape.span);
    let kind = report.require(&owner, "kind", &shape.kind)?.value;
    report.read(&owner, &format!("a {}", kind.word), &shape.values, kind, kind.make)
}
