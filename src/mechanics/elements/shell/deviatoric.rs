//! The triangle: constant strain with edges bulging, and strains linear in position from drilling, optimal in bending (Felippa, Comput.
//! Methods Appl. Mech. Engrg 192, 2003: template OPT, its basic part with α = 3/2).

use super::interpolation::{Interpolation, Triangle};
use super::plane_strains::{PlaneStrains, PointStrains};
use super::surface::ElementSurface;
use nalgebra::{Matrix3, SMatrix, Vector2, Vector3};
use std::array::from_fn;

/// Products of slopes.
const P: usize = 3;
/// Numbers of the membrane: products, edges, drilling.
const E: usize = 7;
/// Natural strains of a corner and drilling.
const BETA: [f64; 9] = [1.0, 2.0, 1.0, 0.0, 1.0, -1.0, -1.0, -1.0, -2.0];

/// Length over height above which the varying strains get less stiffness than in the template.
const SLENDER: f64 = 10.0;

/// Mean strain by the bulges of the edges: −α Σ n⊗n L²/12 (θ_a − θ_b)/A.
fn bulges(surface: &ElementSurface<3, 2>, x: &[Vector2<f64>; 3], part: &[f64; 3]) -> Matrix3<f64> {
    Matrix3::from_columns(&from_fn::<_, 3, _>(|e| {
        let [a, b] = Triangle::EDGES[e];
        let along = x[b] - x[a];
        let n = Vector3::new(along.y * along.y, along.x * along.x, -2.0 * along.x * along.y);
        Triangle::sense(e) * (-part[e] / 12.0 / surface.area) * n
    }))
}

/// Drilling of the nodes against the triangle of straight edges, by the bulges of the edges and mean drilling.
fn drilling() -> SMatrix<f64, 3, 4> {
    // Edges 0 → 1, 1 → 2 and 0 → 2: θ₀ − θ₁, θ₁ − θ₂, θ₀ − θ₂; for small rotations the last is the sum of the others.
    let third = 1.0 / 3.0;
    SMatrix::<f64, 3, 4>::new(third, 0.0, third, 1.0, -third, third, 0.0, 1.0, 0.0, -third, -third, 1.0)
}

/// Strain at the middles of the sides by drilling of the nodes.
fn varying(surface: &ElementSurface<3, 2>, x: &[Vector2<f64>; 3], nu: f64) -> [Matrix3<f64>; 3] {
    // Sides 1-0, 2-1, 0-2, in the order of the source, which counts from 1.
    let side: [Vector2<f64>; 3] = from_fn(|k| x[(k + 1) % 3] - x[k]);
    let squared = side.map(|s| s.norm_squared());
    let area = surface.area;
    // From strains along the sides to ε₁, ε₂, γ₁₂: the sides j and k span the strain across the third.
    let T = Matrix3::from_columns(&from_fn::<_, 3, _>(|k| {
        let (p, q) = (side[(k + 1) % 3], -side[(k + 2) % 3]);
        squared[k] / (4.0 * area * area) * Vector3::new(p.y * q.y, p.x * q.x, -(p.y * q.x + p.x * q.y))
    }));
    let b = BETA;
    let Q = |order: [[usize; 3]; 3]| {
        let scale = 2.0 / 3.0 * area;
        Matrix3::from_fn(|row, column| scale * b[order[row][column] - 1] / squared[row])
    };
    let corners = [
        Q([[1, 2, 3], [4, 5, 6], [7, 8, 9]]),
        Q([[9, 7, 8], [3, 1, 2], [6, 4, 5]]),
        Q([[5, 6, 4], [8, 9, 7], [2, 3, 1]]),
    ];
    // Length over height. The drilling stiffness grows with its cube; in slivers its rounding error would exceed the stiffness against
    // strain.
    let slender = 0.5 * squared.into_iter().fold(0.0, f64::max) / area;
    let beta0 = (0.5 * (1.0 - 4.0 * nu * nu)).max(0.01) * (SLENDER / slender).powi(2).min(1.0);
    // ¾ β₀ A of the template is a third of the area times (3/2)² β₀.
    from_fn(|k| 1.5 * beta0.sqrt() * T * (0.5 * (corners[k] + corners[(k + 1) % 3])))
}

impl PlaneStrains<3, 2, P, E> for Triangle {
    fn strains(surface: &ElementSurface<3, 2>, nu: f64, bulge: &[f64; 3]) -> Vec<PointStrains<P, E>> {
        let x = surface.X.map(|x| surface.flat(&x));
        let even = Self::of_products(&surface.points[0].slopes);
        let mut constant = SMatrix::<f64, 3, E>::zeros();
        constant.fixed_columns_mut::<P>(0).copy_from(&even);
        constant.fixed_columns_mut::<3>(P).copy_from(&bulges(surface, &x, bulge));
        if bulge == &[0.0; 3] {
            return vec![PointStrains { membrane: constant, bending: even, weight: surface.area }];
        }
        let drilling = drilling();
        let at = |varying: Matrix3<f64>| {
            let mut membrane = constant;
            let mut of_drilling = membrane.fixed_columns_mut::<4>(P);
            of_drilling += varying * drilling;
            PointStrains { membrane, bending: even, weight: surface.area / 3.0 }
        };
        varying(surface, &x, nu).into_iter().map(at).collect()
    }

    fn drilling(_: &ElementSurface<3, 2>, _: &[f64; 3]) -> [[f64; E]; 2] {
        [from_fn(|i| if i == E - 1 { 1.0 } else { 0.0 }), [0.0; E]]
    }
}
