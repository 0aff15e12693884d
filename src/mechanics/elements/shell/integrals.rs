//! Integrals of the shape functions over undeformed elements: shares of loads and masses.

use super::interpolation::{Interpolation, Quadrilateral, Triangle};
use super::nodal_vectors::{NodalVectors, sum};
use crate::elements::pressure::{Face, MOST_NODES};
use base::math::Vec3;
use base::math::curved_faces::{self, CurvedFace, NineNodes, SixNodes};
use std::array::from_fn;

/// ∫ N_a dA over an element with its nodes at `x`: the area that belongs to each node, zero beyond them.
pub fn shares(x: &[Vec3]) -> [f64; MOST_NODES] {
    products(x).map(|row| row.iter().sum())
}

/// The part of the area of an element with its nodes at `x` that a lumped mass at each node has. Of curved elements it follows the
/// diagonal of the consistent mass, so that no node is without (Hinton, Rock & Zienkiewicz 1976).
pub fn lumped_shares(x: &[Vec3]) -> [f64; MOST_NODES] {
    if x.len() <= 4 {
        return shares(x);
    }
    let products = products(x);
    let area: f64 = products.iter().flatten().sum();
    let trace: f64 = (0..x.len()).map(|a| products[a][a]).sum();
    from_fn(|a| area / trace * products[a][a])
}

/// ∫ N_a n dA over an element with its nodes at `x`: the forces of a unit pressure along the normal.
pub fn faces(x: &[Vec3]) -> [Vec3; MOST_NODES] {
    fn of<K: Interpolation<N, V, P>, const N: usize, const V: usize, const P: usize>(x: &[Vec3]) -> [Vec3; MOST_NODES] {
        let x: [Vec3; N] = from_fn(|a| x[a]);
        let v = NodalVectors::slopes(&K::SLOPES, &x);
        let normals = K::POINTS.map(|at| {
            let [a, b] = K::slopes(at).map(|s| sum(&s, &v));
            K::AREA / N as f64 * a.cross(&b)
        });
        let face = |a: usize| normals.iter().zip(&K::VALUES).map(|(n, value)| value[a] * n).sum();
        from_fn(|a| if a < N { face(a) } else { Vec3::zeros() })
    }
    match x.len() {
        3 => of::<Triangle, 3, 2, 3>(x),
        4 => of::<Quadrilateral, 4, 3, 6>(x),
        n => {
            let places: [usize; MOST_NODES] = from_fn(|a| a);
            Face::of(&places[..n]).map_or([Vec3::zeros(); MOST_NODES], |face| face.areas(|a| x[a]))
        }
    }
}

/// ∫ N_a N_b dA over an element with its nodes at `x`: the consistent mass matrix for a unit mass per area.
pub fn products(x: &[Vec3]) -> [[f64; MOST_NODES]; MOST_NODES] {
    fn of<K: Interpolation<N, V, P>, const N: usize, const V: usize, const P: usize>(
        x: &[Vec3],
    ) -> [[f64; MOST_NODES]; MOST_NODES] {
        let v = NodalVectors::slopes(&K::SLOPES, &from_fn(|a| x[a]));
        let weights = K::POINTS.map(|at| {
            let [a, b] = K::slopes(at).map(|s| sum(&s, &v));
            K::AREA / N as f64 * a.cross(&b).norm()
        });
        let entry = |a: usize, b: usize| weights.iter().zip(&K::VALUES).map(|(w, value)| w * value[a] * value[b]).sum();
        from_fn(|a| from_fn(|b| if a < N && b < N { entry(a, b) } else { 0.0 }))
    }
    fn curved<F: CurvedFace<N>, const N: usize>(x: &[Vec3]) -> [[f64; MOST_NODES]; MOST_NODES] {
        let products = curved_faces::products::<F, N>(&from_fn(|a| x[a]));
        from_fn(|a| from_fn(|b| if a < N && b < N { products[a][b] } else { 0.0 }))
    }
    match x.len() {
        3 => of::<Triangle, 3, 2, 3>(x),
        4 => of::<Quadrilateral, 4, 3, 6>(x),
        6 => curved::<SixNodes, 6>(x),
        _ => curved::<NineNodes, 9>(x),
    }
}
