//! Coupling of bulging edges with bending.
//!
//! The bulge of an edge is a difference of the drilling of its ends. Drilling of a node turns its director along the surface. Where the
//! surface is curved, this changes the curvature like the bulges of the edges do. So the in-plane strain t of the bulges enters the
//! curvature K as K + sym(t K). Without it bending moments work on drilling: a moment at the end nodes of a strip turns them by turns, and
//! the more the finer the mesh is.
//!
//! With b_e the bulges t = Σ b_e G_e, G_e the mean of the strain that each makes. The moments M act on the curvature as M + sym(t M), and
//! on a bulge as G_e : sym(K M). With bending measured by chords this is left out, so that strains stay of second degree.

use super::in_plane::product;
use base::math::lanes::{LANES, Lanes, lanes};
use std::array::from_fn;

/// G of each edge as 11, 22 and 12 of a symmetric tensor.
#[derive(Clone, Copy)]
pub struct RolledEdges<const N: usize>(pub [[Lanes; 3]; N]);

/// sym(A B) of symmetric tensors, as 11, 22 and 12.
#[inline(always)]
fn symmetric_product(A: &[Lanes; 3], B: &[Lanes; 3]) -> [Lanes; 3] {
    let (mixed, across) = (A[2] * B[2], (A[0] + A[1]) * B[2] + A[2] * (B[0] + B[1]));
    [A[0] * B[0] + mixed, A[1] * B[1] + mixed, Lanes::splat(0.5) * across]
}

/// The numbers of bending as a tensor; the third number is twice the mixed curvature.
#[inline(always)]
fn tensor([a, b, twice]: [Lanes; 3]) -> [Lanes; 3] {
    [a, b, Lanes::splat(0.5) * twice]
}

/// The numbers of bending of a tensor.
#[inline(always)]
fn numbers([a, b, mixed]: [Lanes; 3]) -> [Lanes; 3] {
    [a, b, mixed + mixed]
}

impl<const N: usize> RolledEdges<N> {
    /// `strain`: G of an edge of each element; `None` where all are zero.
    pub fn new(strain: impl Fn(usize, usize) -> [f64; 3]) -> Option<Self> {
        let bulges = (0..LANES).any(|lane| (0..N).any(|e| strain(lane, e) != [0.0; 3]));
        bulges.then(|| RolledEdges(from_fn(|e| from_fn(|i| lanes(|lane| strain(lane, e)[i])))))
    }

    /// Strain by the bulges.
    #[inline(always)]
    pub fn strain(&self, bulges: &[Lanes; N]) -> [Lanes; 3] {
        from_fn(|i| product(&from_fn(|e| self.0[e][i]), bulges))
    }

    /// The change of the first numbers of bending by the strain `t`.
    #[inline(always)]
    pub fn curvature(&self, t: &[Lanes; 3], bending: [Lanes; 3]) -> [Lanes; 3] {
        numbers(symmetric_product(t, &tensor(bending)))
    }

    /// The change of the stress of the first numbers of bending, from their stress M and the strain `t`.
    #[inline(always)]
    pub fn moments(&self, t: &[Lanes; 3], M: &[Lanes; 3]) -> [Lanes; 3] {
        symmetric_product(t, M)
    }

    /// The stress of the bulges by M.
    #[inline(always)]
    pub fn stress(&self, bending: [Lanes; 3], M: &[Lanes; 3]) -> [Lanes; N] {
        let [a, b, mixed] = symmetric_product(&tensor(bending), M);
        self.0.map(|G| G[0] * a + G[1] * b + G[2] * (mixed + mixed))
    }

    /// The change of the first numbers of bending per bulge of each edge.
    #[inline(always)]
    pub fn by_bulges(&self, bending: [Lanes; 3]) -> [[Lanes; 3]; N] {
        self.0.map(|G| numbers(symmetric_product(&G, &tensor(bending))))
    }

    /// The second derivatives of M's work by each bulge and the first numbers of bending.
    #[inline(always)]
    pub fn mixed(&self, M: &[Lanes; 3]) -> [[Lanes; 3]; N] {
        self.0.map(|G| symmetric_product(&G, M))
    }
}
