//! Shape functions, edges and integration points of the two shapes of shell elements.

/// The interpolation of an element with N nodes, V vectors for the slopes of the surface and P products of two of them.
pub trait Interpolation<const N: usize, const V: usize, const P: usize>: Send + Sync + Sized {
    /// The vectors v_i = Σ SLOPES[i][a] x_a.
    const SLOPES: [[f64; N]; V];
    /// Which slopes are multiplied.
    const PAIRS: [[usize; 2]; P];
    /// The ends of the edges with shear sampled at their middles, in the direction of the coordinate along them.
    const EDGES: [[usize; 2]; N];
    /// Integration points (ξ, η): as many as nodes, of equal weight.
    const POINTS: [[f64; 2]; N];
    /// Shape functions at the integration points.
    const VALUES: [[f64; N]; N];
    /// Area of the domain of (ξ, η).
    const AREA: f64;
    /// The factor α of the additional shear flexibility from bending within an element of a curved surface. The factor on the strain of an
    /// edge is h/√(h² + α ℓ²), with ℓ its length, at most the width of the element across it (Lyly, Stenberg & Vihinen 1993; MacNeal 1978
    /// for beams). Without it distorted coarse meshes of thin quadrilaterals lock. Flat surfaces need none, and constant shear stays exact
    /// there. The factor scales with x²/(1 + x²), x the turn of the surface along an edge times its length over the thickness.
    const FLEXIBILITY: f64;
    /// Edges bend between their nodes instead, see [`super::edge_bubbles`].
    const EDGES_BEND: bool;
    /// The fraction of the bulge of an edge in the strain: 1, or the optimum of the triangle in bending. Elements that share an edge take
    /// the same.
    const BULGE: f64;
    /// The point (ξ, η) whose tangents give the axes of the plane.
    const CENTRE: [f64; 2];
    /// S of [`super::arc`]: a 24th of the squared spans of the element in (ξ, η).
    const ARC: [[f64; 2]; 2];
    /// Where the surface is curved, stretch of the membrane is measured along arcs, see [`super::camber`].
    const CAMBERED: bool;
    /// The difference between the metric of the surface and ½ x,ξ·x,ξ, ½ x,η·x,η and ½ x,ξ·x,η, by the curvatures b_ξξ, b_ηη and b_ξη
    /// (x,α·d,β). Zero unless `CAMBERED`.
    fn camber(_: [f64; 3]) -> [f64; 3] {
        [0.0; 3]
    }
    /// The sign of θ_a − θ_b along an edge a → b that is taken the other way round the element.
    #[inline(always)]
    fn sense(edge: usize) -> f64 {
        let [a, b] = Self::EDGES[edge];
        if b == (a + 1) % N { 1.0 } else { -1.0 }
    }
    /// The coefficients of the v_i in x,ξ and x,η.
    fn slopes(at: [f64; 2]) -> [[f64; V]; 2];
    /// The coefficients of the shear strains of the edges in those along ξ and η. That of an edge is x,along·d, with the whole
    /// edge for x,along.
    fn shear(at: [f64; 2]) -> [[f64; N]; 2];
}

/// Bilinear interpolation: x,ξ = v₀ + η v₂ and x,η = v₁ + ξ v₂.
pub struct Quadrilateral;

/// Linear interpolation.
pub struct Triangle;

const GAUSS: f64 = 0.577_350_269_189_625_8;
/// Shape functions at a Gauss point: of the nearest node, the opposite one, the two beside.
const NEAR: f64 = 0.25 * (1.0 + GAUSS) * (1.0 + GAUSS);
const FAR: f64 = 0.25 * (1.0 - GAUSS) * (1.0 - GAUSS);
const SIDE: f64 = 0.25 * (1.0 - GAUSS * GAUSS);

impl Interpolation<4, 3, 6> for Quadrilateral {
    const SLOPES: [[f64; 4]; 3] = [[-0.25, 0.25, 0.25, -0.25], [-0.25, -0.25, 0.25, 0.25], [0.25, -0.25, 0.25, -0.25]];
    const PAIRS: [[usize; 2]; 6] = [[0, 0], [1, 1], [0, 1], [0, 2], [1, 2], [2, 2]];
    const EDGES: [[usize; 2]; 4] = [[0, 1], [1, 2], [3, 2], [0, 3]];
    const POINTS: [[f64; 2]; 4] = [[-GAUSS, -GAUSS], [GAUSS, -GAUSS], [GAUSS, GAUSS], [-GAUSS, GAUSS]];
    const VALUES: [[f64; 4]; 4] =
        [[NEAR, SIDE, FAR, SIDE], [SIDE, NEAR, SIDE, FAR], [FAR, SIDE, NEAR, SIDE], [SIDE, FAR, SIDE, NEAR]];
    const AREA: f64 = 4.0;
    const FLEXIBILITY: f64 = 0.1;
    const EDGES_BEND: bool = false;
    const BULGE: f64 = 1.0;
    const CENTRE: [f64; 2] = [0.0, 0.0];
    const ARC: [[f64; 2]; 2] = [[1.0 / 6.0, 0.0], [0.0, 1.0 / 6.0]];
    const CAMBERED: bool = false;

    fn slopes([xi, eta]: [f64; 2]) -> [[f64; 3]; 2] {
        [[1.0, 0.0, eta], [0.0, 1.0, xi]]
    }

    fn shear([xi, eta]: [f64; 2]) -> [[f64; 4]; 2] {
        // An edge spans two units of ξ or η.
        let (below, above, left, right) =
            (0.25 * (1.0 - eta), 0.25 * (1.0 + eta), 0.25 * (1.0 - xi), 0.25 * (1.0 + xi));
        [[below, 0.0, above, 0.0], [0.0, right, 0.0, left]]
    }
}

impl Interpolation<3, 2, 3> for Triangle {
    const SLOPES: [[f64; 3]; 2] = [[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]];
    const PAIRS: [[usize; 2]; 3] = [[0, 0], [1, 1], [0, 1]];
    const EDGES: [[usize; 2]; 3] = [[0, 1], [1, 2], [0, 2]];
    /// The middles of the sides 0-1, 1-2 and 2-0.
    const POINTS: [[f64; 2]; 3] = [[0.5, 0.0], [0.5, 0.5], [0.0, 0.5]];
    const VALUES: [[f64; 3]; 3] = [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5]];
    const AREA: f64 = 0.5;
    const FLEXIBILITY: f64 = 0.0;
    const EDGES_BEND: bool = true;
    /// The factor α of Felippa's template.
    const BULGE: f64 = 1.5;
    const CENTRE: [f64; 2] = [1.0 / 3.0, 1.0 / 3.0];
    /// The value is half the sum of e eᵀ/24 over the edges e, which prefers no corner.
    const ARC: [[f64; 2]; 2] = [[1.0 / 24.0, -1.0 / 48.0], [-1.0 / 48.0, 1.0 / 24.0]];
    const CAMBERED: bool = true;

    fn slopes(_: [f64; 2]) -> [[f64; 2]; 2] {
        [[1.0, 0.0], [0.0, 1.0]]
    }

    fn camber([a, b, c]: [f64; 3]) -> [f64; 3] {
        // An arc over the chord e has the squared length e² + b_ee²/12: of the three sides.
        let [first, last, third] = [a, b, a + b - 2.0 * c].map(|b| b * b / 24.0);
        [first, last, 0.5 * (first + last - third)]
    }

    fn shear([xi, eta]: [f64; 2]) -> [[f64; 3]; 2] {
        // γ_ξ = e₀ + c η, γ_η = e₂ − c ξ with c = e₂ − e₀ − e₁ (Lee & Bathe 2004).
        [[1.0 - eta, -eta, eta], [xi, xi, 1.0 - xi]]
    }
}
