//! The integration points of a beam, and its shape functions there.

use base::math::quadrature;
use schemars::JsonSchema;
use serde::Deserialize;

/// The largest number of integration points of an element.
pub const MOST_POINTS: usize = 5;

/// The integration rule along the length of an element.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum IntegrationRule {
    /// The most accurate for its number of points, which lie inside.
    #[default]
    Gauss,
    /// With points at the ends of the element, where clamped beams yield first.
    Lobatto,
}

impl IntegrationRule {
    /// The n points on [−1, 1] and their weights.
    pub fn points(self, n: usize) -> (&'static [f64], &'static [f64]) {
        match self {
            IntegrationRule::Gauss => quadrature::gauss(n),
            IntegrationRule::Lobatto => quadrature::lobatto(n),
        }
    }
}

/// Deflection of a beam from the straight line between two nodes at a fraction s of its length. For each node: per transverse displacement,
/// and per rotation and length. `phi` is 12EI/(GA h²), the part of shear (Timoshenko's beam).
pub fn cubic_deflection(s: f64, phi: f64) -> [[f64; 2]; 2] {
    let (r, bulge) = (1.0 - s, s * (1.0 - s) * (1.0 - 2.0 * s));
    let shear = 0.5 * phi * s * r;
    [[bulge, s * r * r + shear], [-bulge, -s * s * r - shear]].map(|of_node| of_node.map(|value| value / (1.0 + phi)))
}

/// The Lagrange polynomials of the N nodes, which are Lobatto points, at the integration points.
#[derive(Debug, Clone)]
pub(super) struct ShapeFunctions<const N: usize> {
    /// N_a at point g: `value[g][a]`.
    pub value: [[f64; N]; MOST_POINTS],
    /// dN_a/dξ at point g: `slope[g][a]`.
    pub slope: [[f64; N]; MOST_POINTS],
    /// Weights of the points, for an integral over ξ.
    pub weight: [f64; MOST_POINTS],
    /// The points ξ, from −1 to 1.
    pub xi: &'static [f64],
}

impl<const N: usize> ShapeFunctions<N> {
    /// Shape functions at the points of a rule with the given weights.
    pub fn new((points, weights): (&'static [f64], &[f64])) -> Self {
        let (nodes, _) = quadrature::lobatto(N);
        let zero = [[0.0; N]; MOST_POINTS];
        let mut shape = ShapeFunctions { value: zero, slope: zero, weight: [0.0; MOST_POINTS], xi: points };
        for (g, (&xi, &w)) in points.iter().zip(weights).enumerate() {
            shape.weight[g] = w;
            for a in 0..N {
                let others = || (0..N).filter(move |&b| b != a);
                let factor = |b: usize| (xi - nodes[b]) / (nodes[a] - nodes[b]);
                shape.value[g][a] = others().map(factor).product();
                shape.slope[g][a] = others()
                    .map(|c| others().filter(|&b| b != c).map(factor).product::<f64>() / (nodes[a] - nodes[c]))
                    .sum();
            }
        }
        shape
    }
}
