//! `[[bodies]]` and `[[masses]]`: mass, inertia and shape of what is rigid.

use std::f64::consts::PI;

use super::build::{Builder, Owner, span, vec3, vec3_or_zero};
use super::places::{Place, Reach};
use super::{Body, Mass, Shape};
use crate::deck::bodies as deck;
use crate::deck::words::Table;
use crate::diagnostic::{At, Span};
use crate::math::{Mat3, Vec3};
use crate::names::short;

/// Round-off in a principal moment, relative to the largest.
const ROUND_OFF: f64 = 1e-9;

/// Shape, and per unit of mass: inertia; volume.
struct Solid {
    shape: Shape,
    inertia: Mat3,
    volume: f64,
}

impl<'d> Builder<'d> {
    /// One body and one node for each of the deck, also for those with errors: others refer to them.
    pub fn bodies(&mut self) {
        for body in &self.deck.bodies {
            let index = self.model.bodies.len();
            let label = body.name.as_ref().map_or_else(|| format!("bodies.{index}"), |name| name.value.clone());
            let owner = Owner { what: format!("body `{label}`"), span: &body.span };
            if let Some(parts) = &body.parts {
                let strays = [
                    ("center", span(&body.center)),
                    ("mass", span(&body.mass)),
                    ("inertia", span(&body.inertia)),
                    ("shape", span(&body.shape)),
                ];
                self.stray("a body that parts make up", &strays);
                if let Some(name) = self.need(&owner, "name", &body.name) {
                    self.name(name, Place::Body(index));
                }
                self.body_of_parts(label, body, &parts.span);
                continue;
            }
            let center = self.need(&owner, "center", &body.center).map_or_else(Vec3::zeros, |center| vec3(center));
            let node = self.node(label.clone(), true, center);
            self.touch(node, true);
            self.model.nodes[node].v = vec3_or_zero(&body.velocity);
            self.model.nodes[node].omega = vec3_or_zero(&body.angular_velocity);
            if let Some(name) = self.need(&owner, "name", &body.name) {
                self.name(name, Place::Body(index));
            }
            let (mass, inertia, shape) =
                self.mass_properties(&owner, body).unwrap_or((1.0, Mat3::identity(), Shape::Sphere { radius: 1.0 }));
            self.model.bodies.push(Body { name: label, node, mass, inertia, shape });
        }
        self.rigid_parts();
    }

    fn mass_properties(&mut self, owner: &Owner<'d>, body: &'d deck::Body) -> Option<(f64, Mat3, Shape)> {
        let solid = match &body.shape {
            Some(shape) => Some(self.solid(shape, &owner.what)?),
            None => None,
        };
        let density = body.shape.as_ref().and_then(|shape| shape.density.as_ref());
        let mass = match (&body.mass, density, &solid) {
            (Some(mass), Some(density), _) => {
                let message = format!("{} has a mass and a density", owner.what);
                return self.error_with(&density.span, message, format!("the mass is given as {}", mass.value));
            }
            (None, Some(_), Some(solid)) => {
                let density = &body.shape.as_ref()?.density;
                self.positive("density", density)? * solid.volume
            }
            (None, None, Some(_)) if !self.is_spoiled(owner.span, "mass") => {
                let message = format!("{} needs `mass`, or a density in its shape", owner.what);
                return self.error(owner.span, message);
            }
            _ => self.need_positive(owner, "mass", &body.mass)?,
        };
        if let Some(values) = &body.inertia {
            let inertia = self.inertia(values)?;
            let shape = solid.map_or_else(|| cuboid(mass, &inertia), |solid| solid.shape);
            return Some((mass, inertia, shape));
        }
        match solid {
            Some(solid) => Some((mass, solid.inertia * mass, solid.shape)),
            None if self.is_spoiled(owner.span, "inertia") || self.is_spoiled(owner.span, "shape") => None,
            None => {
                let message = format!("{} needs `inertia` or `shape`", owner.what);
                self.error_with(owner.span, message, "a mass without inertia goes into [[masses]], on a point")
            }
        }
    }

    /// Three or six values → matrix, which must be that of a real body.
    fn inertia(&mut self, values: &At<Vec<f64>>) -> Option<Mat3> {
        let [xx, yy, zz, xy, yz, zx] = match values.as_slice() {
            &[xx, yy, zz] => [xx, yy, zz, 0.0, 0.0, 0.0],
            &[xx, yy, zz, xy, yz, zx] => [xx, yy, zz, xy, yz, zx],
            other => {
                let message = format!("`inertia` has {} values", other.len());
                return self.error_with(&values.span, message, "three: xx, yy, zz; or six: xx, yy, zz, xy, yz, zx");
            }
        };
        let inertia = Mat3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz);
        let mut moments = inertia.symmetric_eigenvalues();
        moments.as_mut_slice().sort_by(f64::total_cmp);
        if moments[0] <= 0.0 {
            let message = "`inertia` must have three positive principal moments";
            return self.error_with(&values.span, message, format!("the smallest is {}", short(moments[0])));
        }
        if moments[2] > (moments[0] + moments[1]) * (1.0 + ROUND_OFF) {
            let [a, b, c] = [0, 1, 2].map(|i| short(moments[i]));
            let message = "no body has this inertia: a principal moment is larger than the sum of the other two";
            return self.error_with(&values.span, message, format!("{c} > {a} + {b}"));
        }
        Some(inertia)
    }

    fn solid(&mut self, shape: &'d At<Table<deck::Shape>>, body: &str) -> Option<Solid> {
        let owner = Owner { what: format!("the shape of {body}"), span: &shape.span };
        let kind = self.need(&owner, "kind", &shape.kind)?.value;
        let keys = [
            ("size", span(&shape.size)),
            ("radius", span(&shape.radius)),
            ("inner_radius", span(&shape.inner_radius)),
            ("thickness", span(&shape.thickness)),
            ("length", span(&shape.length)),
            ("axis", span(&shape.axis)),
        ];
        let (what, taken): (_, &[&str]) = match kind {
            deck::ShapeKind::Box => ("a box", &["size"]),
            deck::ShapeKind::Cylinder => ("a cylinder", &["radius", "inner_radius", "length", "axis"]),
            deck::ShapeKind::Sphere => ("a sphere", &["radius"]),
            deck::ShapeKind::Tube => ("a tube", &["radius", "inner_radius", "thickness", "length", "axis"]),
        };
        let stray: Vec<(&str, Option<&Span>)> = keys.into_iter().filter(|(key, _)| !taken.contains(key)).collect();
        self.stray(what, &stray);
        match kind {
            deck::ShapeKind::Box => {
                let size = self.need(&owner, "size", &shape.size)?;
                let [a, b, c] = size.value.0;
                if !(a > 0.0 && b > 0.0 && c > 0.0) {
                    return self.error(&size.span, "the edges of a box must be above zero");
                }
                let inertia = Vec3::new(b * b + c * c, c * c + a * a, a * a + b * b) / 12.0;
                let shape = Shape::Box { size: [a, b, c], axes: Mat3::identity() };
                Some(Solid { shape, inertia: Mat3::from_diagonal(&inertia), volume: a * b * c })
            }
            deck::ShapeKind::Sphere => {
                let r = self.need_positive(&owner, "radius", &shape.radius)?;
                let inertia = Mat3::identity() * (0.4 * r * r);
                Some(Solid { shape: Shape::Sphere { radius: r }, inertia, volume: 4.0 / 3.0 * PI * r * r * r })
            }
            deck::ShapeKind::Cylinder | deck::ShapeKind::Tube => {
                let radius = self.need_positive(&owner, "radius", &shape.radius);
                let length = self.need_positive(&owner, "length", &shape.length);
                let axis = self.need(&owner, "axis", &shape.axis).and_then(|axis| self.unit("axis", axis));
                let (radius, length, axis) = (radius?, length?, axis?);
                let inner_radius = self.inner_radius(&owner, shape, kind, radius)?;
                let squares = radius * radius + inner_radius * inner_radius;
                let (along, across) = (squares / 2.0, squares / 4.0 + length * length / 12.0);
                let inertia = Mat3::identity() * across + axis * axis.transpose() * (along - across);
                let volume = PI * (radius - inner_radius) * (radius + inner_radius) * length;
                Some(Solid { shape: Shape::Cylinder { radius, inner_radius, length, axis }, inertia, volume })
            }
        }
    }

    fn inner_radius(
        &mut self,
        owner: &Owner<'d>,
        shape: &deck::Shape,
        kind: deck::ShapeKind,
        radius: f64,
    ) -> Option<f64> {
        let (inner, place) = match (&shape.inner_radius, &shape.thickness) {
            (Some(_), Some(thickness)) => {
                return self.error(&thickness.span, "a tube takes `thickness` or `inner_radius`, not both");
            }
            (Some(inner), None) => (self.not_negative("inner_radius", &shape.inner_radius, 0.0), &inner.span),
            (None, Some(thickness)) => (radius - self.positive("thickness", &shape.thickness)?, &thickness.span),
            (None, None) if kind == deck::ShapeKind::Cylinder => return Some(0.0),
            (None, None) => {
                return self.error(owner.span, format!("{} needs `thickness` or `inner_radius`", owner.what));
            }
        };
        if inner >= radius || inner < 0.0 {
            return self.error(place, format!("the wall does not fit into the radius, {radius}"));
        }
        Some(inner)
    }

    pub fn masses(&mut self) {
        for mass in &self.deck.masses {
            let owner = Owner { what: "`[[masses]]`".to_owned(), span: &mass.span };
            let spots = self.spots(&owner, "at", &mass.at, Reach::Nodes);
            let value = self.need_positive(&owner, "mass", &mass.mass);
            let inertia = match &mass.inertia {
                Some(values) => self.inertia(values),
                None => Some(Mat3::zeros()),
            };
            let (Some(value), Some(inertia)) = (value, inertia) else { continue };
            for spot in spots {
                self.touch(spot.node, mass.inertia.is_some());
                self.model.masses.push(Mass { node: spot.node, mass: value, inertia });
            }
        }
    }
}

/// The homogeneous cuboid of a mass and inertia: I_i = m/12 (s_j² + s_k²).
fn cuboid(mass: f64, inertia: &Mat3) -> Shape {
    let eigen = inertia.symmetric_eigen();
    let moments = eigen.eigenvalues;
    let edge = |i: usize| (6.0 * (moments.sum() - 2.0 * moments[i]).max(0.0) / mass).sqrt();
    let mut axes = eigen.eigenvectors;
    if axes.determinant() < 0.0 {
        axes.set_column(2, &-axes.column(2).into_owned());
    }
    Shape::Box { size: [edge(0), edge(1), edge(2)], axes }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cuboid_of_a_box_is_the_box() {
        let (m, [a, b, c]) = (12.0, [1.0, 2.0, 3.0]);
        let inertia = Mat3::from_diagonal(&Vec3::new(b * b + c * c, c * c + a * a, a * a + b * b));
        let Shape::Box { size, axes } = cuboid(m, &inertia) else { panic!("not a box") };
        let mut edges = size;
        edges.sort_by(f64::total_cmp);
        // Square roots of numbers of order one.
        assert!(edges.iter().zip([a, b, c]).all(|(got, edge)| (got - edge).abs() < 1e-14), "{edges:?}");
        assert!((axes.determinant() - 1.0).abs() < 1e-14);
    }
}
