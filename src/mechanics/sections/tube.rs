//! The circular tube; with a hole of any size it lies between the full circle and the thin tube.

use super::dimensions::positive;
use super::fibres::Fibre;
use super::section::{Section, saint_venant};
use super::section_shape::{CrossSection, MakeSection, SHEAR_FACTOR, SectionKind, SectionShape, check_walls};
use super::stresses::SectionOutline;
use base::math::quadrature::pairs;
use base::words::kinds::{Form, Given, Key};
use std::f64::consts::{PI, TAU};

/// The shape's word, keys and maker.
pub static KIND: SectionKind = SectionKind {
    word: "tube",
    aliases: &[],
    guesses: &["pipe", "chs", "hollow-circle", "ring"],
    about: "A circular tube.",
    keys: &[
        Key { name: "radius", form: Form::Number, about: "Outer radius, above 0." },
        Key { name: "diameter", form: Form::Number, about: "Outer diameter, above 0, instead of `radius`." },
        Key { name: "thickness", form: Form::Numbers, about: "Thickness of the wall, above 0, at most the radius." },
        Key {
            name: "fibres",
            form: Form::Counts,
            about: "Fibres around, at least 4, and through the wall, even numbers, where the material yields. Default: [20, 2]; from half the radius on [20, 4].",
        },
        SHEAR_FACTOR,
    ],
    make: MakeSection { read, takes_material: |_| true },
};

fn read(given: &mut Given, _: bool) -> Option<CrossSection> {
    check_walls(given, 1)?;
    let radius = outer_radius(given, "tube");
    let thickness = *given.require("thickness")?.first()?;
    Some(CrossSection::Shape(Box::new(Tube { radius: radius?, thickness })))
}

/// Reads `radius`, or half of `diameter`, of the round `shape`.
pub(super) fn outer_radius(given: &mut Given, shape: &str) -> Option<f64> {
    match (given.has("radius"), given.has("diameter")) {
        (true, true) => given.error("diameter", format!("a {shape} takes `radius` or `diameter`, not both")),
        (false, true) => given.positive("diameter").map(|diameter| 0.5 * diameter),
        _ => given.require_positive("radius"),
    }
}

/// A circular tube, or a full circle.
#[derive(Debug, Clone, PartialEq)]
pub struct Tube {
    /// The outer radius.
    pub radius: f64,
    /// Wall thickness.
    pub thickness: f64,
}

impl SectionShape for Tube {
    fn section(&self, nu: f64) -> Result<Section, String> {
        tube(self.radius, self.thickness, nu)
    }

    fn default_fibres(&self, _: Option<usize>) -> Result<[usize; 2], String> {
        Ok([20, if self.thickness < 0.5 * self.radius { 2 } else { 4 }])
    }

    fn lay_fibres(&self, counts: [usize; 2], section: &Section) -> Result<Vec<Fibre>, String> {
        if counts[0] < 4 {
            return Err("a round section needs at least 4 fibres around".into());
        }
        Ok(tube_fibres(self.radius, self.radius - self.thickness, section.shear[0], counts))
    }

    fn outline(&self, nu: f64, _: &Section) -> Option<SectionOutline> {
        Some(SectionOutline::Circle { outer: self.radius, inner: self.radius - self.thickness, nu })
    }

    fn depth(&self, [y, z]: [f64; 2]) -> Option<f64> {
        let outside = self.radius - y.hypot(z);
        // A full circle has no surface inside.
        Some(if self.thickness < self.radius { outside.min(self.thickness - outside) } else { outside })
    }

    fn cover_and_core(&self, cover: f64, [around, through]: [usize; 2]) -> Option<[Vec<Fibre>; 2]> {
        let core = self.radius - cover;
        if self.thickness < self.radius || core <= 0.0 {
            return None;
        }
        let ring = |outer: f64, inner: f64, through: usize| {
            let fibres = tube_fibres(outer, inner, 0.0, [around, through]).into_iter();
            fibres.map(|fibre| Fibre { shear: [[0.0; 3]; 2], ..fibre }).collect()
        };
        Some([ring(self.radius, core, 2), ring(core, 0.0, through)])
    }

    fn half_depth(&self) -> f64 {
        self.radius
    }
}

/// Circular tube; a thickness equal to the radius is a solid round.
///
/// Shear areas have the energy of Saint-Venant's shear stress, of Poisson's ratio `nu`. At ν = 0 their factor is that of Cowper 1966
/// (J. Appl. Mech. 33, 335-340), 6/7 when solid and 1/2 when thin.
pub fn tube(outer_radius: f64, thickness: f64, nu: f64) -> Result<Section, String> {
    positive(&[("radius", outer_radius), ("thickness", thickness)])?;
    if thickness > outer_radius {
        return Err(format!(
            "`thickness` is {thickness}, but a wall cannot be thicker than radius = {outer_radius} (a solid round)"
        ));
    }
    let inner_radius = outer_radius - thickness;
    let squares = outer_radius * outer_radius + inner_radius * inner_radius;
    let area = PI * thickness * (outer_radius + inner_radius);
    let I = 0.25 * area * squares;
    // 1/k = (7 (1 + m²)² + 20 m²)/(6 (1 + m²)²) + (ν/(1 + ν))²/6 ((1 − m²)/(1 + m²))², m = inner/outer radius.
    let m2 = (inner_radius / outer_radius).powi(2);
    let a = (1.0 + m2).powi(2);
    let shear = 6.0 * a / (7.0 * a + 20.0 * m2 + saint_venant(nu) * (1.0 - m2).powi(2)) * area;
    Ok(Section { area, Iy: I, Iz: I, Iyz: 0.0, torsion: 2.0 * I, shear: [shear, shear, 0.0], shear_center: [0.0; 2] })
}

/// Fibres around and through the wall. The shear of Γ₃ is the gradient of ψ = f(r) sin φ with ∇²ψ = −z A_s/I and free surfaces. This is
/// Saint-Venant's flexure at ν = 0; its energy gives Cowper's factor. Twist is r along the circle.
pub(super) fn tube_fibres(outer: f64, inner: f64, shear_area: f64, [around, through]: [usize; 2]) -> Vec<Fibre> {
    let (R2, r2) = (outer * outer, inner * inner);
    let factor = shear_area / (0.25 * PI * (R2 * R2 - r2 * r2));
    let mut fibres = Vec::new();
    for (x, w) in pairs(through) {
        let r = 0.5 * (outer + inner + x * (outer - inner));
        let square = r * r;
        // f′ vanishes at both radii.
        let slope = 0.375 * factor * (R2 + r2 - R2 * r2 / square - square);
        let ratio = 0.375 * factor * (R2 + r2 + R2 * r2 / square - square / 3.0); // f/r
        let area = 0.5 * w * (outer - inner) * r * TAU / around as f64;
        for i in 0..around {
            let (sin, cos) = ((i as f64 + 0.5) * TAU / around as f64).sin_cos();
            let mixed = (slope - ratio) * sin * cos;
            let shear = [
                [slope * cos * cos + ratio * sin * sin, mixed, -r * sin],
                [mixed, slope * sin * sin + ratio * cos * cos, r * cos],
            ];
            fibres.push(Fibre { area, y: r * cos, z: r * sin, shear });
        }
    }
    fibres
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sections::tests::close;

    /// The tube between its limits: exact differences of full circles, all to round-off.
    #[test]
    fn thick_tube_is_a_circle_less_a_circle() {
        let (outer, inner): (f64, f64) = (0.05, 0.02);
        let thick = tube(outer, outer - inner, 0.3).unwrap();
        close(thick.area, PI * (outer.powi(2) - inner.powi(2)), 1e-14);
        close(thick.Iy, PI / 4.0 * (outer.powi(4) - inner.powi(4)), 1e-14);
        close(thick.torsion, PI / 2.0 * (outer.powi(4) - inner.powi(4)), 1e-14);
        let round = tube(outer, outer, 0.0).unwrap();
        close(round.shear[0], 6.0 / 7.0 * round.area, 1e-15);
        close(round.Iz, PI / 4.0 * outer.powi(4), 1e-15);
    }

    /// Cover and core of a round have the areas and moments of a ring and a circle; no tube and no round within its cover has a core.
    #[test]
    fn cover_and_core_of_a_round() {
        let (R, r): (f64, f64) = (0.25, 0.21);
        let round = Tube { radius: R, thickness: R };
        let [cover, core] = round.cover_and_core(R - r, [16, 6]).unwrap();
        for (fibres, [outer, inner]) in [(cover, [R, r]), (core, [r, 0.0])] {
            let sum = |of: &dyn Fn(&Fibre) -> f64| fibres.iter().map(|f| f.area * of(f)).sum::<f64>();
            let I = PI / 4.0 * (outer.powi(4) - inner.powi(4));
            // Sums of a hundred fibres round to less.
            close(sum(&|_| 1.0), PI * (outer * outer - inner * inner), 1e-13);
            close(sum(&|f| f.y * f.y), I, 1e-13);
            close(sum(&|f| f.z * f.z), I, 1e-13);
            assert!(sum(&|f| f.y * f.z).abs().max(sum(&|f| f.y).abs()) < 1e-13 * R.powi(3));
            assert!(fibres.iter().all(|f| f.y.hypot(f.z) < outer && f.y.hypot(f.z) > inner));
        }
        assert!(round.cover_and_core(R, [16, 6]).is_none());
        assert!(Tube { radius: R, thickness: 0.1 }.cover_and_core(0.04, [16, 6]).is_none());
    }

    /// The depth below the nearer surface; a round has none inside.
    #[test]
    fn depth_of_rounds_and_tubes() {
        let depth = |thickness: f64, at: [f64; 2]| Tube { radius: 0.25, thickness }.depth(at).unwrap();
        for (thickness, at, exact) in [
            (0.25, [0.0, 0.0], 0.25),
            (0.25, [0.12, -0.16], 0.05),
            (0.1, [0.12, -0.16], 0.05),
            (0.1, [0.0, 0.17], 0.02),
            (0.1, [0.0, 0.1], -0.05),
            (0.1, [0.3, 0.0], -0.05),
        ] {
            // Differences of numbers of size 0.25.
            assert!((depth(thickness, at) - exact).abs() < 1e-15, "{thickness} {at:?}");
        }
    }

    /// Corrections are of the order t/R = 1e-6 squared for the shear factor, and first order for the moments about R.
    #[test]
    fn thin_tube_has_shear_factor_one_half() {
        let (R, t) = (1.0, 1e-6);
        let tube = tube(R, t, 0.3).unwrap();
        close(tube.shear[1], 0.5 * tube.area, 1e-11);
        close(tube.area, 2.0 * PI * R * t, 1e-6);
        close(tube.torsion, 2.0 * PI * R.powi(3) * t, 2e-6);
    }

    /// The energy of the stress itself, by midpoints in r and φ: Saint-Venant's flexure of the full circle (Timoshenko & Goodier, art.
    /// 122), and of the thick tube by its stress functions. ∫|τ|² dA A/Q² has an error of the square of the step, 1e-6.
    #[test]
    fn shear_areas_have_the_energy_of_the_stress() {
        for nu in [0.0, 0.3, 0.5] {
            let circle = |y: f64, z: f64| {
                let up =
                    (3.0 + 2.0 * nu) / (8.0 * (1.0 + nu)) * (1.0 - z * z - (1.0 - 2.0 * nu) / (3.0 + 2.0 * nu) * y * y);
                [-(1.0 + 2.0 * nu) / (4.0 * (1.0 + nu)) * y * z, up]
            };
            close(factor(0.0, circle), tube(1.0, 1.0, nu).unwrap().shear[0] / PI, 2e-6);
            let m: f64 = 0.6;
            let (sum, product) = (1.0 + m * m, m * m);
            // ∇ψ with ψ = f(r) sin θ, ∇²ψ = −z, and the curl of φ = g(r) cos θ, ∇²φ = −y, g = 0 at both radii.
            let thick = |y: f64, z: f64| {
                let (r, sin, cos) = (y.hypot(z), z / y.hypot(z), y / y.hypot(z));
                let r2 = r * r;
                let (df, f) = (0.375 * (sum - product / r2 - r2), 0.375 * (sum + product / r2 - r2 / 3.0));
                let (g, dg) = ((sum - r2 - product / r2) / 8.0, (sum - 3.0 * r2 + product / r2) / 8.0);
                let share = nu / (1.0 + nu);
                [
                    (df - f) * sin * cos + share * (dg - g) * sin * cos,
                    df * sin * sin + f * cos * cos - share * (dg * cos * cos + g * sin * sin),
                ]
            };
            let section = tube(1.0, 1.0 - m, nu).unwrap();
            close(factor(m, thick), section.shear[0] / section.area, 2e-6);
        }
    }

    /// Q²/(A ∫|τ|² dA) of a stress along y and along z on a tube of outer radius 1.
    fn factor(inner: f64, stress: impl Fn(f64, f64) -> [f64; 2]) -> f64 {
        let n = 600;
        let step = (1.0 - inner) / n as f64;
        let (mut area, mut force, mut energy) = (0.0, 0.0, 0.0);
        for i in 0..n {
            let r = inner + (i as f64 + 0.5) * step;
            for j in 0..64 {
                let (sin, cos) = (TAU * (j as f64 + 0.5) / 64.0).sin_cos();
                let [along_y, along_z] = stress(r * cos, r * sin);
                let part = r * step * TAU / 64.0;
                area += part;
                force += part * along_z;
                energy += part * (along_y * along_y + along_z * along_z);
            }
        }
        force * force / (area * energy)
    }

    #[test]
    fn nonsense_is_named() {
        assert!(tube(0.1, 0.2, 0.3).unwrap_err().starts_with("`thickness` is 0.2, but a wall cannot be thicker"));
    }
}
