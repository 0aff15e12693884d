//! The map of a patch of shells from (s, t) ∈ [0, 1]² to a plane, a cylinder or a sphere.

use crate::places::nodes::Nodes;
use crate::report::{Owner, Report};
use crate::values::vec3_or_zero;
use base::diagnostic::{At, Span};
use base::math::{Mat3, Vec3};
use base::names::{joined, short};
use deck::shells as words;
use deck::words::{Maybe, Table};
use std::f64::consts::{PI, TAU};

/// Largest distance of a corner from a sphere, relative to its radius: corners typed with four digits.
const ROUND: f64 = 1e-3;

/// A patch's map from (s, t) ∈ [0, 1]², corners at (0, 0), (1, 0), (1, 1), (0, 1).
pub struct Map {
    kind: Coordinates,
    center: Vec3,
    /// The columns are e₁, e₂ and the axis.
    axes: Mat3,
    /// Coordinates of the corners; between them they are bilinear.
    corners: [Vec3; 4],
    /// Distances of the corners from the centre, for a patch that is pushed out; between them they are bilinear too.
    radii: [f64; 4],
}

#[derive(Clone, Copy, PartialEq)]
enum Coordinates {
    Straight,
    /// (r, φ, z)
    Cylinder,
    /// (r, longitude, latitude)
    Sphere,
    /// Straight, then pushed out to the radius.
    Pushed,
}

impl Map {
    /// `None` where a corner has no coordinates, or the patch would go all the way round.
    fn new(kind: Coordinates, center: Vec3, axis: &Vec3, corners: [Vec3; 4]) -> Option<Map> {
        // Any axes across: the one that is the farthest from the axis leads.
        let far = Vec3::ith(axis.iamin(), 1.0);
        let e2 = axis.cross(&far).normalize();
        let axes = Mat3::from_columns(&[e2.cross(axis), e2, *axis]);
        let radii = corners.map(|x| (x - center).norm());
        let size = radii.into_iter().fold(0.0, f64::max);
        let mut map = Map { kind, center, axes, corners, radii };
        let mut last: Option<f64> = None;
        for corner in &mut map.corners {
            let y = axes.tr_mul(&(*corner - center));
            let across = y.x.hypot(y.y);
            let mut angle = y.y.atan2(y.x);
            match kind {
                Coordinates::Straight => continue,
                Coordinates::Pushed if y.norm() > 1e-9 * size => continue,
                Coordinates::Cylinder | Coordinates::Sphere if across > 1e-9 * size => {}
                _ => return None,
            }
            // The shortest way round from the corner before.
            if let Some(last) = last {
                angle += ((last - angle) / TAU).round() * TAU;
            }
            last = Some(angle);
            *corner = match kind {
                Coordinates::Cylinder => Vec3::new(across, angle, y.z),
                _ => Vec3::new(y.norm(), angle, y.z.atan2(across)),
            };
        }
        let closes = (map.corners[3].y - map.corners[0].y).abs() < PI;
        (closes || matches!(kind, Coordinates::Straight | Coordinates::Pushed)).then_some(map)
    }

    /// Position, and its derivatives by s and t.
    pub fn at(&self, s: f64, t: f64) -> [Vec3; 3] {
        let [a, b, c, d] = &self.corners;
        let value = (1.0 - t) * ((1.0 - s) * a + s * b) + t * ((1.0 - s) * d + s * c);
        let slopes = [(1.0 - t) * (b - a) + t * (c - d), (1.0 - s) * (d - a) + s * (c - b)];
        let turn = |r: f64, z: f64, y: Vec3| self.axes * Vec3::new(r * y.x, r * y.y, z);
        match self.kind {
            Coordinates::Straight => [value, slopes[0], slopes[1]],
            Coordinates::Cylinder => {
                let (sin, cos) = value.y.sin_cos();
                let (out, round) = (Vec3::new(cos, sin, 0.0), Vec3::new(-sin, cos, 0.0));
                let x = self.center + turn(value.x, value.z, out);
                let [by_s, by_t] = slopes.map(|d| turn(d.x, d.z, out) + turn(value.x * d.y, 0.0, round));
                [x, by_s, by_t]
            }
            Coordinates::Sphere => {
                let ((sin, cos), (up, across)) = (value.y.sin_cos(), value.z.sin_cos());
                let out = self.axes * Vec3::new(across * cos, across * sin, up);
                let round = self.axes * Vec3::new(-across * sin, across * cos, 0.0);
                let north = self.axes * Vec3::new(-up * cos, -up * sin, across);
                let [by_s, by_t] = slopes.map(|d| d.x * out + value.x * (d.y * round + d.z * north));
                [self.center + value.x * out, by_s, by_t]
            }
            Coordinates::Pushed => {
                let [a, b, c, d] = self.radii;
                let r = (1.0 - t) * ((1.0 - s) * a + s * b) + t * ((1.0 - s) * d + s * c);
                let by = [(1.0 - t) * (b - a) + t * (c - d), (1.0 - s) * (d - a) + s * (c - b)];
                let y = value - self.center;
                let (length, n) = (y.norm(), y.normalize());
                let [by_s, by_t] = [0, 1].map(|i| by[i] * n + r / length * (slopes[i] - slopes[i].dot(&n) * n));
                [self.center + r * n, by_s, by_t]
            }
        }
    }

    /// The map of a patch of the deck, whose corners are three or four nodes.
    pub fn read<'d>(
        owner: &Owner<'d>,
        surface: &'d Maybe<Table<words::PatchSurface>>,
        corners: &[usize],
        nodes: &Nodes,
        report: &mut Report<'d>,
    ) -> Option<Map> {
        let (mut kind, mut center, mut axis) = (Coordinates::Straight, Vec3::zeros(), Vec3::z());
        let mut place = owner.span;
        if let Some(surface) = surface {
            (kind, axis) = read_surface(surface, report)?;
            center = vec3_or_zero(&surface.center);
            place = &surface.span;
        } else if report.is_spoiled(owner.span, "surface") {
            return None;
        }
        if matches!(kind, Coordinates::Sphere | Coordinates::Pushed) {
            on_a_sphere(place, center, corners, nodes, report)?;
        }
        let x = |i: usize| nodes.x(corners[i]);
        let three = corners.len() == 3;
        // Three corners: a corner beyond the third edge makes the coordinates linear.
        let fourth = if three { x(2) } else { x(3) };
        let mut map = match Map::new(kind, center, &axis, [x(0), x(1), x(2), fourth]) {
            Some(map) => map,
            None => {
                let message = "the corners do not fit this surface";
                return report.error_with(
                    place,
                    message,
                    "a corner lies on the axis, or the patch goes all the way round it",
                );
            }
        };
        if three {
            let [a, b, c, _] = map.corners;
            map.corners = [a, b, b + c - a, c];
            let [a, b, c, _] = map.radii;
            map.radii = [a, b, b + c - a, c];
        }
        Some(map)
    }
}

/// Reports corners of a sphere at different distances from its centre.
fn on_a_sphere(place: &Span, center: Vec3, corners: &[usize], nodes: &Nodes, report: &mut Report) -> Option<()> {
    let distances: Vec<f64> = corners.iter().map(|&corner| (nodes.x(corner) - center).norm()).collect();
    let (least, most) = distances.iter().fold((f64::INFINITY, 0.0f64), |(a, b), &r| (a.min(r), b.max(r)));
    if most - least <= ROUND * most {
        return Some(());
    }
    let of = corners.iter().zip(&distances);
    let list: Vec<String> = of.map(|(&corner, &r)| format!("`{}` {}", nodes.label(corner), short(r))).collect();
    let words: Vec<&str> = list.iter().map(String::as_str).collect();
    let message = "the corners of a sphere must lie at the same distance from its `center`";
    report.error_with(place, message, format!("distances: {}", joined(&words)))
}

fn read_surface<'d>(
    surface: &'d At<Table<words::PatchSurface>>,
    report: &mut Report<'d>,
) -> Option<(Coordinates, Vec3)> {
    let owner = Owner::new("`surface`", &surface.span);
    match (report.require(&owner, "kind", &surface.kind)?.value, &surface.axis) {
        (words::SurfaceKind::Sphere, None) => Some((Coordinates::Pushed, Vec3::z())),
        (words::SurfaceKind::Sphere, Some(axis)) => Some((Coordinates::Sphere, report.unit("axis", axis)?)),
        (words::SurfaceKind::Cylinder, _) => {
            let axis = report.require(&owner, "axis", &surface.axis)?;
            Some((Coordinates::Cylinder, report.unit("axis", axis)?))
        }
    }
}
