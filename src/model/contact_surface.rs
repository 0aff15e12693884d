//! The surface of `[[contacts]]` in the frame of the node that carries it.

use super::axes::axes;
use super::nodes::Topology;
use super::report::{Owner, Report};
use super::scene::Scene;
use super::values::{span, vec3};
use crate::deck::contacts as words;
use crate::deck::words::Table;
use crate::diagnostic::{At, Span};
use crate::elements::contact::{Shape, Surface};
use crate::math::{Mat3, Vec3};

/// The node that carries a surface, and the surface in its frame.
pub(super) fn read_surface<'d>(
    name: &str,
    table: &'d At<Table<words::Surface>>,
    scene: &Scene<'d>,
    topology: &mut Topology,
    report: &mut Report<'d>,
) -> Option<(usize, Surface)> {
    let owner = Owner::new(format!("the surface of contact `{name}`"), &table.span);
    let word = report.require(&owner, "shape", &table.shape)?.value;
    let keys = [
        ("point", span(&table.point)),
        ("normal", span(&table.normal)),
        ("center", span(&table.center)),
        ("size", span(&table.size)),
        ("axes", span(&table.axes)),
        ("radius", span(&table.radius)),
        ("axis", span(&table.axis)),
        ("length", span(&table.length)),
        ("ends", span(&table.ends)),
    ];
    let (what, taken): (_, &[&str]) = match word {
        words::Shape::Plane => ("a plane", &["point", "normal"]),
        words::Shape::Box => ("a box", &["center", "size", "axes"]),
        words::Shape::Sphere => ("a sphere", &["center", "radius"]),
        words::Shape::Cylinder => ("a cylinder", &["center", "radius", "axis", "length"]),
        words::Shape::Capsule => ("a capsule", &["ends", "radius"]),
    };
    let unused: Vec<(&str, Option<&Span>)> = keys.into_iter().filter(|(key, _)| !taken.contains(key)).collect();
    report.reject_unused(what, &unused);
    let body = match &table.body {
        Some(name) => Some(scene.names.body(name, report)?),
        None if report.is_spoiled(owner.span, "body") => return None,
        None => None,
    };
    let body = body.map(|body| scene.bodies[body].node);
    let center = match (word, &table.center, body) {
        (words::Shape::Plane, ..) => report.require(&owner, "point", &table.point).map(|point| vec3(point)),
        (words::Shape::Capsule, ..) => None,
        (_, None, Some(body)) if !report.is_spoiled(owner.span, "center") => Some(topology.x(body)),
        (_, center, _) => report.require(&owner, "center", center).map(|center| vec3(center)),
    };
    let (center, axes, shape) = match word {
        words::Shape::Plane => {
            let normal = report.require(&owner, "normal", &table.normal).and_then(|n| report.unit("normal", n));
            (center?, along(&normal?), Shape::Plane)
        }
        words::Shape::Box => {
            let size = report.require(&owner, "size", &table.size)?;
            if size.value.0.iter().any(|&edge| edge <= 0.0) {
                return report.error(&size.span, "the edges of a box must be above zero");
            }
            let axes = match &table.axes {
                Some(table) => axes(table, report)?,
                None if report.is_spoiled(owner.span, "axes") => return None,
                None => Mat3::identity(),
            };
            (center?, axes, Shape::Box { half: size.value.0.map(|edge| 0.5 * edge) })
        }
        words::Shape::Sphere => {
            let radius = report.require_positive(&owner, "radius", &table.radius);
            (center?, Mat3::identity(), Shape::Sphere { radius: radius? })
        }
        words::Shape::Cylinder => {
            let radius = report.require_positive(&owner, "radius", &table.radius);
            let length = report.require_positive(&owner, "length", &table.length);
            let axis = report.require(&owner, "axis", &table.axis).and_then(|axis| report.unit("axis", axis));
            (center?, along(&axis?), Shape::Cylinder { radius: radius?, half: 0.5 * length? })
        }
        words::Shape::Capsule => {
            let radius = report.require_positive(&owner, "radius", &table.radius);
            let ends = report.require(&owner, "ends", &table.ends)?;
            let [a, b] = ends.value.as_slice() else {
                return report.error(&ends.span, "`ends` takes two points");
            };
            let (a, b) = (vec3(a), vec3(b));
            let Some(axis) = (b - a).try_normalize(0.0) else {
                return report.error_with(&ends.span, "the ends of a capsule lie at one place", "that is a sphere");
            };
            (0.5 * (a + b), along(&axis), Shape::Capsule { radius: radius?, half: 0.5 * (b - a).norm() })
        }
    };
    let node = match body {
        Some(node) => node,
        None => {
            let node = topology.add(format!("{name}.surface"), false, center);
            (0..6).for_each(|dof| topology.restrain(node, dof, None));
            node
        }
    };
    Some((node, Surface { center: center - topology.x(node), axes, shape }))
}

/// A frame whose third axis is given.
pub(super) fn along(axis: &Vec3) -> Mat3 {
    let x = axis.cross(&Vec3::ith(axis.iamin(), 1.0)).normalize();
    Mat3::from_columns(&[x, axis.cross(&x), *axis])
}
