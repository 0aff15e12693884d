//! Bending, transverse shear and rank of elements of any shape, down to a thousandth as wide as long; the membrane stands in
//! [`super::membrane`].

use super::membrane::{Sheet, shape};
use crate::support::blocks::stiffness;
use dense::part;
use nalgebra::DVector;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rdsolve::elements::shell::{DRILLING, Plate};
use std::array::from_fn;

/// Four quadrilaterals round one in a convex quadrilateral of random shape, squeezed by `thin`; or their triangles.
fn patch(rng: &mut StdRng, triangles: bool, thin: f64) -> Sheet {
    let quads = [[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7], [4, 5, 6, 7]];
    loop {
        let mut x = shape(rng, 4, thin);
        // By weights of the corners, so that the squeeze changes nothing.
        for k in 0..4 {
            let weights: [f64; 4] = from_fn(|a| if a == k { 0.6 } else { 0.2 } + rng.random_range(-0.1..0.1));
            let sum: f64 = weights.iter().sum();
            let inner = (0..4).map(|a| weights[a] / sum * x[a]).sum();
            x.push(inner);
        }
        let turn = |q: &[usize; 4], k: usize| {
            let at = |i: usize| x[q[(k + i) % 4]];
            (at(1) - at(0)).cross(&(at(2) - at(1))).z
        };
        if quads.iter().all(|q| (0..4).all(|k| turn(q, k) > 0.01 * thin)) {
            let cut = |&[a, b, c, d]: &[usize; 4]| match triangles {
                true => vec![vec![a, b, c], vec![a, c, d]],
                false => vec![vec![a, b, c, d]],
            };
            return Sheet::flat(x, quads.iter().flat_map(cut).collect());
        }
    }
}

/// Displacements out of the plane of a sheet: w and its rotations (w,y, −w,x), or w with none, by node.
fn lifted(sheet: &Sheet, of: impl Fn(f64, f64) -> [f64; 3]) -> DVector<f64> {
    let rows = sheet.x.iter().flat_map(|x| {
        let [w, along, across] = of(x.x, x.y);
        [0.0, 0.0, w, across, -along, 0.0]
    });
    DVector::from_iterator(6 * sheet.x.len(), rows)
}

/// Even curvature with the normals that belong to it: nodes inside are in balance, and the energy is exact. Transverse shear that is even:
/// in quadrilaterals, whose edges do not bend, the energy is exact too. Bounds: rounding of the stiffness, which of slivers is that of
/// shear over their width, against what bends.
#[test]
fn even_bending_in_any_shape() {
    let mut rng = StdRng::seed_from_u64(41);
    for triangles in [false, true] {
        let (mut residual, mut bending, mut shear) = ([0.0f64; 2], [0.0f64; 2], 0.0f64);
        for _ in 0..1000 {
            let thin = 10f64.powf(-rng.random_range(0.0..3.0));
            let sheet = patch(&mut rng, triangles, thin);
            let h = 10f64.powf(-rng.random_range(0.0..2.0));
            let plate = Plate { thickness: h, E: 1.0, nu: 0.3, drilling: DRILLING };
            let K = stiffness(&*sheet.block(&plate), &sheet.rest());
            let area: f64 = 0.5 * (sheet.x[2] - sheet.x[0]).cross(&(sheet.x[3] - sheet.x[1])).z;
            let [a, b, c, p, q]: [f64; 5] = from_fn(|_| rng.random_range(-1.0..1.0));
            let bent = lifted(&sheet, |x, y| [0.5 * (a * x * x + b * y * y) + c * x * y, a * x + c * y, b * y + c * x]);
            let D = h.powi(3) / 12.0 / 0.91;
            let wanted = 0.5 * D * (a * a + b * b + 0.6 * a * b + 1.4 * c * c) * area;
            let F = &K * &bent;
            let inside = (24..48).map(|i| F[i].abs()).fold(0.0, f64::max);
            let moments = D * (a.abs() + b.abs() + c.abs());
            let error = (0.5 * bent.dot(&F) / wanted - 1.0).abs();
            // By how much shear over the width is stiffer than what bends.
            let rounding = (thin / h).powi(2).max(1.0) / thin.powi(2);
            residual = [residual[0].max(inside / K.amax()), residual[1].max(inside / moments / rounding)];
            bending = [bending[0].max(error), bending[1].max(error / rounding)];
            let even = lifted(&sheet, |x, y| [p * x + q * y, 0.0, 0.0]);
            let wanted = 0.5 * 5.0 / 6.0 / 2.6 * h * (p * p + q * q) * area;
            shear = shear.max((0.5 * even.dot(&(&K * &even)) / wanted - 1.0).abs());
        }
        println!("triangles {triangles}: residual {residual:?}, bending {bending:?}, shear {shear:.1e}");
        // Found are 1.3e-12 and, in triangles, 5e-17; of the energy 3e-10 and 3e-14 by that rounding.
        let [of_stiffness, of_rounding] = if triangles { [1e-14, 1e-12] } else { [1e-10, 1e-8] };
        assert!(residual[0] < of_stiffness && residual[1] < of_rounding, "{residual:?}");
        assert!(bending[1] < of_rounding && (triangles || shear < 1e-8), "{bending:?} {shear}");
    }
}

/// Three rigid motions out of the plane and no more. With every unknown by its own stiffness, what bends is as weak as the square of the thickness
/// and of the width, of quadrilaterals as its fourth power.
#[test]
fn rank_of_any_shape() {
    let mut rng = StdRng::seed_from_u64(43);
    for corners in [3, 4] {
        let (mut zero, mut weakest) = (0.0f64, f64::INFINITY);
        for _ in 0..1000 {
            let thin = 10f64.powf(-rng.random_range(0.0..3.0));
            let h = 10f64.powf(-rng.random_range(0.0..2.0));
            let sheet = Sheet::flat(shape(&mut rng, corners, thin), vec![(0..corners).collect()]);
            let plate = Plate { thickness: h, E: 1.0, nu: 0.3, drilling: DRILLING };
            let K = stiffness(&*sheet.block(&plate), &sheet.rest());
            let out: Vec<usize> = (0..6 * corners).filter(|i| [2, 3, 4].contains(&(i % 6))).collect();
            let K = part(&K, &out);
            let values = dense::eigenvalues(&dense::scaled(&K));
            zero = zero.max(values[2].abs().max(values[0].abs()));
            weakest = weakest.min(values[3] / (h * h * thin.powi(2 * corners as i32 - 4)).min(1.0));
        }
        println!("{corners}: zero {zero:e}, weakest {weakest:e}");
        assert!(zero < 1e-11 && weakest > 1e-3, "{zero} {weakest}");
    }
}
