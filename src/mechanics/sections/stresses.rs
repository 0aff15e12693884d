//! Stresses in the section of an elastic beam from its resultants, at the points of the section where they are extreme.
//!
//! Normal stress is linear over the section. Shear stress is Saint-Venant's in rectangles and tubes, with Poisson's ratio, and the flow along
//! middle lines in walls. Warping that is held, fillets and the places of loads are left out, as in the stiffness of the beam.

use super::section::Section;
use base::math::{Mat3, Vec3};
use nalgebra::{Matrix2, Vector2};
use std::f64::consts::{PI, TAU};

/// Stresses are compared at so many points of a circle, counted from the direction of bending and again from that of the shear force.
/// The largest value lies half a step away at most, so a cosine loses 0.1 % at most.
const AROUND: usize = 72;

/// The shape and stiffness of a section, for stresses from its resultants.
#[derive(Debug, Clone, PartialEq)]
pub struct SectionStresses {
    area: f64,
    /// Gradient of the normal stress along (y, z) from (M_y, M_z).
    bending: Matrix2<f64>,
    shear_center: [f64; 2],
    /// Centroid (y, z) from the axis of the beam.
    centroid: [f64; 2],
    outline: SectionOutline,
    /// Where normal stress is that of several materials.
    fibres: Option<ElasticFibres>,
}

/// Fibres of several materials.
#[derive(Debug, Clone, PartialEq)]
struct ElasticFibres {
    /// Strains (Γ₁, κ₂, κ₃) from (N, M_y, M_z).
    compliance: Mat3,
    /// Coordinates y and z, and Young's modulus.
    fibres: Vec<[f64; 3]>,
}

impl ElasticFibres {
    /// Extremes of the normal stresses E (Γ₁ + z κ₂ − y κ₃).
    fn extremes(&self, resultants: Vec3) -> BeamStresses {
        let strain = self.compliance * resultants;
        let mut found = BeamStresses::default();
        for [y, z, E] in &self.fibres {
            found.include(E * (strain.x + z * strain.y - y * strain.z), &[]);
        }
        found
    }
}

/// The points of a section with possibly extreme stresses.
#[derive(Debug, Clone, PartialEq)]
pub enum SectionOutline {
    /// Points of polygons and walls.
    Points(Vec<StressPoint>),
    /// All points of a circular tube.
    Circle {
        /// Outer radius.
        outer: f64,
        /// Inner radius; 0 of a solid round.
        inner: f64,
        /// Poisson's ratio.
        nu: f64,
    },
}

/// A point of a section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StressPoint {
    /// Coordinates (y, z) from the centroid.
    pub at: [f64; 2],
    /// The number of its wall; 0 in a full shape.
    pub wall: usize,
    /// Young's modulus over that of the area and moments of the section.
    pub modulus: f64,
    /// Two components of the shear stress, each for a unit V_y, a unit V_z, both through the shear centre, and a unit torsional moment.
    pub shear: [[f64; 3]; 2],
}

/// Extreme stresses of a section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeamStresses {
    /// Largest and smallest normal stress, largest shear stress, largest von Mises stress.
    pub values: [f64; 4],
}

impl Default for BeamStresses {
    fn default() -> Self {
        BeamStresses { values: [f64::NEG_INFINITY, f64::INFINITY, 0.0, 0.0] }
    }
}

impl BeamStresses {
    /// Takes account of the normal stress and the components of the shear stress at a point.
    pub fn include(&mut self, sigma: f64, tau: &[f64]) {
        let square: f64 = tau.iter().map(|tau| tau * tau).sum();
        let [most, least, shear, mises] = self.values;
        let own = (sigma * sigma + 3.0 * square).sqrt();
        self.values = [most.max(sigma), least.min(sigma), shear.max(square.sqrt()), mises.max(own)];
    }
}

impl SectionStresses {
    /// Stresses of a section with these points.
    pub fn new(section: &Section, outline: SectionOutline) -> SectionStresses {
        let Section { area, Iy, Iz, Iyz, shear_center, .. } = *section;
        // (M_y, M_z) = E [I_y −I_yz; −I_yz I_z] (κ₂, κ₃), and σ = E (z κ₂ − y κ₃).
        let det = Iy * Iz - Iyz * Iyz;
        let bending = Matrix2::new(-Iyz, -Iy, Iz, Iyz) / det;
        SectionStresses { area, bending, shear_center, centroid: [0.0; 2], outline, fibres: None }
    }

    /// Returns the section with normal stresses in these fibres: their y, z and Young's modulus. `stiffness` is that of all against (Γ₁, κ₂, κ₃);
    /// `None` where it has no inverse.
    pub fn of_fibres(self, stiffness: &Mat3, fibres: Vec<[f64; 3]>) -> Option<SectionStresses> {
        let compliance = stiffness.try_inverse()?;
        Some(SectionStresses { fibres: Some(ElasticFibres { compliance, fibres }), ..self })
    }

    /// Returns the section with its centroid at (y, z) from the axis of the beam.
    pub fn beside(self, centroid: [f64; 2]) -> SectionStresses {
        SectionStresses { centroid, ..self }
    }

    /// The centroid (y, z) from the axis of the beam.
    pub fn centroid(&self) -> [f64; 2] {
        self.centroid
    }

    /// The area.
    pub fn area(&self) -> f64 {
        self.area
    }

    /// The points of possibly extreme stresses.
    pub fn outline(&self) -> &SectionOutline {
        &self.outline
    }

    /// Extreme stresses under N, V_y, V_z, T, M_y, M_z about the axis of the beam.
    pub fn extremes(&self, &[N, Vy, Vz, T, My, Mz]: &[f64; 6]) -> BeamStresses {
        let [y, z] = self.centroid;
        let (T, My, Mz) = (T - (y * Vz - z * Vy), My - z * N, Mz + y * N);
        let slope = self.bending * Vector2::new(My, Mz);
        let [ys, zs] = self.shear_center;
        let twist = T - (ys * Vz - zs * Vy);
        let sigma = |y: f64, z: f64| N / self.area + slope.x * y + slope.y * z;
        let mut found = BeamStresses::default();
        match self.outline {
            SectionOutline::Points(ref points) => {
                for StressPoint { at: [y, z], modulus, shear, .. } in points {
                    found.include(modulus * sigma(*y, *z), &shear.map(|s| s[0] * Vy + s[1] * Vz + s[2] * twist));
                }
            }
            SectionOutline::Circle { outer, inner, nu } => {
                let force = Vector2::new(Vy, Vz);
                for begin in [slope, force].map(|of| of.y.atan2(of.x)) {
                    for k in 0..AROUND {
                        let (sin, cos) = (begin + TAU * k as f64 / AROUND as f64).sin_cos();
                        for r in if inner > 0.0 { [outer, inner] } else { [outer, 0.0] } {
                            let (y, z) = (r * cos, r * sin);
                            let tau =
                                edge_shear([outer, inner], nu, [y, z], force) + twist_of([outer, inner], twist, [y, z]);
                            found.include(sigma(y, z), &[tau.x, tau.y]);
                        }
                    }
                }
            }
        }
        let Some(fibres) = &self.fibres else { return found };
        // Shear is that of the shape, apart from the fibres.
        let [most, least, _, mises] = fibres.extremes(Vec3::new(N, My, Mz)).values;
        BeamStresses { values: [most, least, found.values[2], mises] }
    }
}

/// Shear stress of a torsional moment in a circular tube.
fn twist_of([outer, inner]: [f64; 2], twist: f64, [y, z]: [f64; 2]) -> Vector2<f64> {
    let polar = 0.25 * TAU * (outer.powi(4) - inner.powi(4));
    Vector2::new(-z, y) * (twist / polar)
}

/// Shear stress (τ_y, τ_z) of a shear force (V_y, V_z) at a point (y, z) of a circular tube, solid where the inner radius is 0 (A. E. H. Love,
/// A Treatise on the Mathematical Theory of Elasticity, §§ 229-231).
fn edge_shear([a, b]: [f64; 2], nu: f64, [y, z]: [f64; 2], force: Vector2<f64>) -> Vector2<f64> {
    let size = force.norm();
    if size == 0.0 {
        return Vector2::zeros();
    }
    // p along the force, q across it.
    let e = force / size;
    let across = Vector2::new(-e.y, e.x);
    let (p, q) = (e.dot(&Vector2::new(y, z)), across.dot(&Vector2::new(y, z)));
    let (a2, b2, r2) = (a * a, b * b, p * p + q * q);
    let k = 0.75 + 0.5 * nu;
    // The pole of the hole, if there is one.
    let [hole_p, hole_q] = if b2 == 0.0 {
        [0.0; 2]
    } else {
        [a2 * b2 * (1.0 / r2 - 2.0 * p * p / (r2 * r2)), -2.0 * a2 * b2 * p * q / (r2 * r2)]
    };
    let chi_p = -k * (a2 + b2 + hole_p) + 0.75 * (p * p - q * q);
    let chi_q = -k * hole_q - 1.5 * p * q;
    let factor = -size / (2.0 * (1.0 + nu) * 0.25 * PI * (a2 * a2 - b2 * b2));
    let along = factor * (chi_p + 0.5 * nu * p * p + (1.0 - 0.5 * nu) * q * q);
    let sideways = factor * (chi_q + (2.0 + nu) * p * q);
    along * e + sideways * across
}

#[cfg(test)]
mod tests {
    use crate::sections::SectionShape;
    use crate::sections::c::C;
    use crate::sections::hollow_box::HollowBox;
    use crate::sections::i::I;
    use crate::sections::l::L;
    use crate::sections::rectangle::Rectangle;
    use crate::sections::tests::close;
    use crate::sections::tube::Tube;
    use std::f64::consts::PI;

    fn extremes(shape: &dyn SectionShape, nu: f64, forces: [f64; 6]) -> [f64; 4] {
        shape.stresses(nu, &shape.section(nu).unwrap()).unwrap().extremes(&forces).values
    }

    /// An eccentric force on a rectangle: N/A ± 6 N e/(b h²) in both directions at once.
    #[test]
    fn eccentric_force_on_a_rectangle() {
        let (b, h, n, y, z) = (0.2, 0.3, 50.0, 0.03, -0.04);
        let [most, least, tau, mises] =
            extremes(&Rectangle { width: b, height: h }, 0.3, [n, 0.0, 0.0, 0.0, n * z, -n * y]);
        let (a, both) = (b * h, 6.0 * n * (y / (b * b * h) + 0.04 / (b * h * h)));
        close(most, n / a + both, 1e-14);
        close(least, n / a - both, 1e-14);
        assert_eq!(tau, 0.0);
        close(mises, most, 1e-14);
    }

    /// Largest shear stress over 3/2 V/A at ν = 1/4, at the centre and at the middle of the sides along the force. Three digits of
    /// Timoshenko & Goodier, Theory of Elasticity, art. 122.
    #[test]
    fn shear_of_a_rectangle_is_saint_venants() {
        for (depth, centre, side) in
            [(2.0, 0.983, 1.033), (1.0, 0.940, 1.126), (0.5, 0.856, 1.396), (0.25, 0.805, 1.988)]
        {
            let [at_centre, at_side] = crate::sections::rectangle::flexure(depth, 1.0, 0.25);
            assert!(
                (at_centre / 1.5 - centre).abs() < 6e-4 && (at_side / 1.5 - side).abs() < 6e-4,
                "{depth} {at_centre} {at_side}"
            );
            let along_z = extremes(&Rectangle { width: 1.0, height: depth }, 0.25, [0.0, 0.0, 2.0, 0.0, 0.0, 0.0]);
            close(along_z[2], 2.0 * at_side / depth, 1e-14);
            close(along_z[3], 3.0_f64.sqrt() * along_z[2], 1e-14);
            let along_y = extremes(&Rectangle { width: depth, height: 1.0 }, 0.25, [0.0, -2.0, 0.0, 0.0, 0.0, 0.0]);
            close(along_y[2], along_z[2], 1e-14);
        }
    }

    /// Torsion of rectangles: τ = T/(k a b²), k = J/(a b³) / (1 − 8/π² Σ 1/(n² cosh(nπa/2b))) with odd n (Timoshenko & Goodier, art. 109), to five
    /// digits.
    #[test]
    fn torsion_of_a_rectangle() {
        for (width, height, k) in [(1.0, 1.0, 0.20817), (2.0, 1.0, 0.24588), (1.0, 10.0, 0.31233)] {
            let [.., tau, _] = extremes(&Rectangle { width, height }, 0.3, [0.0, 0.0, 0.0, 3.0, 0.0, 0.0]);
            let (long, thin) = (f64::max(width, height), f64::min(width, height));
            close(tau, 3.0 / (k * long * thin * thin), 5e-5);
        }
    }

    /// Rounds: T R/J, M R/I in any direction, (3 + 2ν)/(8(1 + ν)) V R²/I at the centre of a solid one, and 2 V/A in a thin tube.
    #[test]
    fn stresses_of_rounds() {
        let (r, nu) = (0.4_f64, 0.3);
        let I = PI * r.powi(4) / 4.0;
        let solid = Tube { radius: r, thickness: r };
        let [most, least, tau, _] = extremes(&solid, nu, [0.0, 0.0, 0.0, 7.0, 3.0, -4.0]);
        close(most, 5.0 * r / I, 1e-14);
        close(least, -5.0 * r / I, 1e-14);
        close(tau, 7.0 * r / (2.0 * I), 1e-14);
        let [.., tau, _] = extremes(&solid, nu, [0.0, 3.0, 4.0, 0.0, 0.0, 0.0]);
        close(tau, (3.0 + 2.0 * nu) / (8.0 * (1.0 + nu)) * 5.0 * r * r / I, 1e-13);
        let thin = Tube { radius: r, thickness: 1e-4 * r };
        let area = thin.section(nu).unwrap().area;
        // The wall's share is its thickness over the radius.
        close(extremes(&thin, nu, [0.0, 0.0, 5.0, 0.0, 0.0, 0.0])[2], 10.0 / area, 1e-3);
        // No shear stress crosses the surfaces.
        for (inner, x) in [(0.1, 0.4), (0.1, 0.1)] {
            let (sin, cos) = 0.7_f64.sin_cos();
            let tau = super::edge_shear([0.4, inner], nu, [x * cos, x * sin], [1.0, 2.0].into());
            assert!((tau.x * cos + tau.y * sin).abs() < 1e-13 * tau.norm(), "{inner}");
        }
    }

    /// Bending and torsion of a round: √(σ² + 3 τ²) where both are largest.
    #[test]
    fn von_mises_of_a_shaft() {
        let (r, m, t) = (0.05_f64, 600.0_f64, 900.0_f64);
        let I = PI * r.powi(4) / 4.0;
        let [.., mises] = extremes(&Tube { radius: r, thickness: r }, 0.3, [0.0, 0.0, 0.0, t, m, 0.0]);
        close(mises, ((m * r / I).powi(2) + 3.0 * (t * r / (2.0 * I)).powi(2)).sqrt(), 1e-14);
    }

    /// V Q/(I t) in the middle of the web of an I, with Q and I of its rectangles. Middle lines err by the square of the depth of the
    /// flanges over that of the section, here 0.2 %.
    #[test]
    fn shear_of_an_i_is_that_of_its_static_moment() {
        let (h, b, w, f) = (200.0, 100.0, 5.6, 8.5);
        let shape = I { height: h, top_width: b, bottom_width: b, web: w, top_flange: f, bottom_flange: f };
        let section = shape.section(0.3).unwrap();
        let inside = h - 2.0 * f;
        let Q = b * f * 0.5 * (h - f) + w * inside * inside / 8.0;
        let [most, least, tau, _] = extremes(&shape, 0.3, [0.0, 0.0, 1000.0, 0.0, 0.0, 0.0]);
        close(tau, 1000.0 * Q / (section.Iy * w), 5e-3);
        assert_eq!((most, least), (0.0, 0.0));
        // Bending about both axes meets in a corner; torsion is T t/J at the thickest wall.
        let [most, least, ..] = extremes(&shape, 0.3, [0.0, 0.0, 0.0, 0.0, 30.0, -20.0]);
        let corner = 30.0 * 0.5 * h / section.Iy + 20.0 * 0.5 * b / section.Iz;
        close(most, corner, 1e-13);
        close(least, -corner, 1e-13);
        close(extremes(&shape, 0.3, [0.0, 0.0, 0.0, 9.0, 0.0, 0.0])[2], 9.0 * f / section.torsion, 1e-13);
    }

    /// Bredt: T/(2 A_m t) in the thinnest wall of a box, and the linear part of the wall, whose share of the torque follows from J.
    #[test]
    fn torsion_of_a_box_is_bredts() {
        let shape = HollowBox { width: 60.0, height: 100.0, web: 1.0, flange: 1.5 };
        let [.., tau, _] = extremes(&shape, 0.3, [0.0, 0.0, 0.0, 500.0, 0.0, 0.0]);
        let enclosed = 59.0 * 98.5;
        let bredt = 500.0 / (2.0 * enclosed * 1.0);
        // The faces of the wall add G κ t = T t/J.
        let J = shape.section(0.3).unwrap().torsion;
        assert!(tau > bredt && tau < 1.001 * (bredt + 500.0 * 1.0 / J), "{tau} {bredt}");
        // Two webs share the force: nearly V/(2 h t).
        let [.., tau, _] = extremes(&shape, 0.3, [0.0, 0.0, 100.0, 0.0, 0.0, 0.0]);
        assert!(tau > 100.0 / (2.0 * 98.5) && tau < 1.25 * 100.0 / (2.0 * 98.5), "{tau}");
    }

    /// A force through the shear centre twists neither a channel nor an angle, and one through the centroid does.
    #[test]
    fn torsion_counts_about_the_shear_centre() {
        let channel = C { height: 200.0, width: 75.0, web: 8.5, flange: 11.5 };
        let section = channel.section(0.3).unwrap();
        let [y, _] = section.shear_center;
        let [.., through_shear_centre, _] = extremes(&channel, 0.3, [0.0, 0.0, 1e3, 1e3 * y, 0.0, 0.0]);
        let [.., through_centroid, _] = extremes(&channel, 0.3, [0.0, 0.0, 1e3, 0.0, 0.0, 0.0]);
        // Torsion is largest in the thicker flanges, and adds to their shear flow.
        let twist = (1e3 * y).abs() * 11.5 / section.torsion;
        assert!(through_centroid > twist && through_centroid < through_shear_centre + twist, "{through_centroid}");
        assert!(through_shear_centre < 1.2 * 1e3 / (8.5 * 188.5), "{through_shear_centre}");
        // Bending of an angle about its leg is oblique: σ = E (z κ₂ − y κ₃) with both curvatures.
        let angle = L { height: 100.0, width: 60.0, vertical: 8.0, horizontal: 8.0 };
        let s = angle.section(0.3).unwrap();
        let [most, least, ..] = extremes(&angle, 0.3, [0.0, 0.0, 0.0, 0.0, 1e5, 0.0]);
        let det = s.Iy * s.Iz - s.Iyz * s.Iyz;
        let sigma = |y: f64, z: f64| 1e5 * (s.Iz * z - s.Iyz * y) / det;
        // The heel, from the centroid of both legs.
        let area = 8.0 * 100.0 + 52.0 * 8.0;
        let heel = [-(800.0 * 4.0 + 416.0 * 34.0) / area, -(800.0 * 50.0 + 416.0 * 4.0) / area];
        let corners = [[0.0, 0.0], [8.0, 0.0], [0.0, 100.0], [8.0, 100.0], [60.0, 0.0], [60.0, 8.0]];
        let all = corners.map(|[y, z]| sigma(heel[0] + y, heel[1] + z));
        close(most, all.into_iter().fold(f64::NEG_INFINITY, f64::max), 1e-13);
        close(least, all.into_iter().fold(f64::INFINITY, f64::min), 1e-13);
    }
}
