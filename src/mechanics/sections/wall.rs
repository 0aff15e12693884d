//! Shear flow in thin walls: the flow of a shear force along the middle lines of a section of straight walls.
//!
//! The flow of Jourawski gives the shear areas (by its energy) and the shear centre (by its moment). Reference: Kollbrunner
//! & Basler, Torsion in Structures, 1969. Left out: warping stiffness; the beams of this program have no unknown for it.

use base::math::quadrature::gauss;
use nalgebra::{Matrix2, Vector2};

type Point = Vector2<f64>;

/// A straight wall between two points (by index).
#[derive(Clone, Copy)]
pub struct Wall {
    /// Indices of its end points.
    pub ends: [usize; 2],
    /// Thickness.
    pub thickness: f64,
}

/// Answer to shear: areas [yy, zz, yz] and the shear centre, in the axes of the points.
pub struct Shear {
    /// Shear areas yy, zz and yz.
    pub areas: [f64; 3],
    /// Shear centre (y, z).
    pub center: [f64; 2],
    /// Shear flows of a unit force along y and along z, both through the shear centre.
    pub flows: [Flow; 2],
    /// Round the cell, for a unit twist and a unit shear modulus (Bredt); 0 without a cell.
    pub circulation: f64,
}

/// Flow in each wall, positive from its first end to its second: q(s) = c₀ + c₁ s + c₂ s², s from 0 to 1.
pub type Flow = Vec<[f64; 3]>;

/// q(s) of one wall.
pub fn flow_at([c0, c1, c2]: [f64; 3], s: f64) -> f64 {
    c0 + s * (c1 + s * c2)
}

/// Shear areas and shear centre of walls that form a tree, or of one cell.
///
/// Walls run so that whatever flows into a wall's first end has been listed before it: from the free ends inwards. A cell is
/// cut at the first point and closed by the flow that keeps it from twisting.
pub fn shear(points: &[[f64; 2]], walls: &[Wall], cell: bool) -> Shear {
    let section = Middle::of(points, walls);
    let mut flows = [section.flow(Vector2::x()), section.flow(Vector2::y())];
    let mut circulation = 0.0;
    if cell {
        // ∮ q/t ds = 0; Bredt: ∮ q/t ds = 2 A_m G κ₁
        let flexibility: f64 = section.lines.iter().map(|line| line.length / line.thickness).sum();
        for flow in &mut flows {
            let twist: f64 = section.integrate(|line, i, s| flow_at(flow[i], s) / line.thickness);
            flow.iter_mut().for_each(|q| q[0] -= twist / flexibility);
        }
        circulation = section.integrate(|line, _, _| line.arm) / flexibility;
    }
    // Energy of unit forces i and j: F = ∫ q_i q_j / t ds; the shear areas are its inverse.
    let q = |i: usize, k: usize, s: f64| flow_at(flows[i][k], s);
    let F = |i: usize, j: usize| section.integrate(|line, k, s| q(i, k, s) * q(j, k, s) / line.thickness);
    let (yy, zz, yz) = (F(0, 0), F(1, 1), F(0, 1));
    let det = yy * zz - yz * yz;
    // A unit force along z has the moment y_s about the centroid, one along y the moment −z_s.
    let moment = |i: usize| section.integrate(|line, k, s| q(i, k, s) * line.arm);
    let center = section.center + Vector2::new(moment(1), -moment(0));
    Shear { areas: [zz / det, yy / det, -yz / det], center: center.into(), flows, circulation }
}

/// The middle lines about their own centroid.
struct Middle {
    lines: Vec<Line>,
    center: Point,
    /// ∫ t [y², yz; yz, z²] ds.
    moments: Matrix2<f64>,
    points: usize,
}

struct Line {
    from: Point,
    direction: Point,
    length: f64,
    thickness: f64,
    ends: [usize; 2],
    /// The moment of a unit flow about the centroid.
    arm: f64,
}

impl Middle {
    fn of(points: &[[f64; 2]], walls: &[Wall]) -> Middle {
        let ends = |wall: &Wall| wall.ends.map(|i| Point::from(points[i]));
        let (mut area, mut first) = (0.0, Point::zeros());
        for wall in walls {
            let [a, b] = ends(wall);
            let part = (b - a).norm() * wall.thickness;
            area += part;
            first += 0.5 * part * (a + b);
        }
        let center = first / area;
        let mut moments = Matrix2::zeros();
        let lines = walls
            .iter()
            .map(|wall| {
                let [a, b] = ends(wall).map(|p| p - center);
                let (along, middle) = (b - a, 0.5 * (a + b));
                let length = along.norm();
                let part = wall.thickness * length;
                moments += part * (middle * middle.transpose() + along * along.transpose() / 12.0);
                Line {
                    from: a,
                    direction: along,
                    length,
                    thickness: wall.thickness,
                    ends: wall.ends,
                    arm: a.perp(&along) / length,
                }
            })
            .collect();
        Middle { lines, center, moments, points: points.len() }
    }

    /// Flow of a shear force: q′ = −t (g·r), with g from the equilibrium ∫ q dr = force.
    fn flow(&self, force: Vector2<f64>) -> Flow {
        let g = self.moments.try_inverse().unwrap_or_else(Matrix2::zeros) * force;
        let mut arriving = vec![0.0; self.points];
        let mut flow = Vec::with_capacity(self.lines.len());
        for line in &self.lines {
            let slope = line.thickness * line.length;
            let q = [arriving[line.ends[0]], -slope * g.dot(&line.from), -0.5 * slope * g.dot(&line.direction)];
            arriving[line.ends[1]] += flow_at(q, 1.0);
            flow.push(q);
        }
        flow
    }

    /// ∫ f ds over all lines; `f` gets the line, its index and s from 0 to 1. Three Gauss points: exact for the square of a
    /// flow, of degree four.
    fn integrate(&self, f: impl Fn(&Line, usize, f64) -> f64) -> f64 {
        let (points, weights) = gauss(3);
        let on = |(i, line): (usize, &Line)| -> f64 {
            let rule = points.iter().zip(weights);
            rule.map(|(x, w)| 0.5 * line.length * w * f(line, i, 0.5 * (1.0 + x))).sum()
        };
        self.lines.iter().enumerate().map(on).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sections::tests::close;

    /// One upright wall: the parabola of shear stress gives 5/6 (exact); a second wall keeps the section from being a line.
    #[test]
    fn a_plus_has_five_sixths_of_each_wall() {
        let points = [[-1.0, 0.0], [1.0, 0.0], [0.0, -2.0], [0.0, 2.0], [0.0, 0.0]];
        let wall = |a, b, thickness| Wall { ends: [a, b], thickness };
        let walls = [wall(0, 4, 0.1), wall(1, 4, 0.1), wall(2, 4, 0.05), wall(3, 4, 0.05)];
        let shear = shear(&points, &walls, false);
        close(shear.areas[0], 5.0 / 6.0 * 0.2, 1e-14);
        close(shear.areas[1], 5.0 / 6.0 * 0.2, 1e-14);
        assert!(shear.areas[2].abs() < 1e-16 && shear.center[0].abs() + shear.center[1].abs() < 1e-15);
    }

    /// A ring of n walls tends to the circular tube, shear factor 1/2, with an error of order (π/n)².
    #[test]
    fn a_ring_has_shear_factor_one_half() {
        let n = 400;
        let angle = |i: usize| std::f64::consts::TAU * i as f64 / n as f64;
        let points: Vec<[f64; 2]> = (0..=n).map(|i| [3.0 + angle(i).cos(), 1.0 + angle(i).sin()]).collect();
        let walls: Vec<Wall> = (0..n).map(|i| Wall { ends: [i, i + 1], thickness: 0.01 }).collect();
        let shear = shear(&points, &walls, true);
        let half = 0.5 * std::f64::consts::TAU * 0.01;
        close(shear.areas[0], half, 1e-4);
        close(shear.areas[1], half, 1e-4);
        close(shear.center[0], 3.0, 1e-12);
        close(shear.center[1], 1.0, 1e-12);
    }

    /// A slit ring has its shear centre on the side away from the slit, 2R from the centre (Timoshenko, Strength of Materials II, art. 54).
    /// The error of the polygon is (π/n)².
    #[test]
    fn a_slit_ring_has_its_shear_center_outside() {
        let n = 400;
        let angle = |i: usize| std::f64::consts::TAU * i as f64 / n as f64;
        let points: Vec<[f64; 2]> = (0..=n).map(|i| [angle(i).cos(), angle(i).sin()]).collect();
        let walls: Vec<Wall> = (0..n).map(|i| Wall { ends: [i, i + 1], thickness: 0.01 }).collect();
        let shear = shear(&points, &walls, false);
        close(shear.center[0], -2.0, 1e-4);
        assert!(shear.center[1].abs() < 1e-12);
    }
}
