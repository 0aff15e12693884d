//! The rectangle.

use super::dimensions::positive;
use super::fibres::{Fibre, pairs};
use super::section::Section;
use super::section_shape::{CrossSection, MakeSection, SectionKind, SectionShape};
use base::words::kinds::{Form, Given, Key};
use std::f64::consts::PI;

/// The shape's word, keys and maker.
pub static KIND: SectionKind = SectionKind {
    word: "rectangle",
    aliases: &[],
    guesses: &["rect", "solid", "rectangular", "square"],
    about: "A solid rectangle.",
    keys: &[
        Key { name: "width", form: Form::Number, about: "Length along local y, above 0." },
        Key { name: "height", form: Form::Number, about: "Length along local z, above 0." },
        Key {
            name: "fibres",
            form: Form::Counts,
            about: "Fibres along y and along z, even numbers, where the material yields; one number holds for both. Default: [12, 12].",
        },
    ],
    make: MakeSection { read, takes_material: |_| true },
};

fn read(given: &mut Given, _: bool) -> Option<CrossSection> {
    let (width, height) = (given.require_positive("width"), given.require_positive("height"));
    Some(CrossSection::Shape(Box::new(Rectangle { width: width?, height: height? })))
}

/// A solid rectangle.
#[derive(Debug, Clone, PartialEq)]
pub struct Rectangle {
    /// Width along y.
    pub width: f64,
    /// Height along z.
    pub height: f64,
}

impl SectionShape for Rectangle {
    fn section(&self) -> Result<Section, String> {
        rectangle(self.width, self.height)
    }

    fn default_fibres(&self, first: Option<usize>) -> Result<[usize; 2], String> {
        Ok(first.map_or([12; 2], |n| [n; 2]))
    }

    fn lay_fibres(&self, counts: [usize; 2], _: &Section) -> Result<Vec<Fibre>, String> {
        Ok(rectangle_fibres(self.width, self.height, counts))
    }

    fn half_depth(&self) -> f64 {
        0.5 * self.width.min(self.height)
    }
}

/// Solid rectangle.
pub fn rectangle(width: f64, height: f64) -> Result<Section, String> {
    positive(&[("width", width), ("height", height)])?;
    let area = width * height;
    Ok(Section {
        area,
        Iy: area * height * height / 12.0,
        Iz: area * width * width / 12.0,
        Iyz: 0.0,
        torsion: rectangle_torsion(width.max(height), width.min(height)),
        shear: [5.0 / 6.0 * area, 5.0 / 6.0 * area, 0.0],
        shear_center: [0.0; 2],
    })
}

/// J = a b³/3 (1 − 192/π⁵ (b/a) Σ_{n odd} tanh(nπa/2b)/n⁵), a ≥ b (Timoshenko & Goodier, Theory of Elasticity, art. 109).
/// With tanh x = 1 − 2/(e²ˣ + 1) and Σ_{n odd} n⁻⁵ = 31/32 ζ(5) the rest falls like e^(−nπ): five terms leave 1e-17.
fn rectangle_torsion(a: f64, b: f64) -> f64 {
    const ZETA_5: f64 = 1.036_927_755_143_37;
    let rest: f64 =
        [1.0, 3.0, 5.0, 7.0, 9.0].map(|n: f64| 2.0 / (n.powi(5) * ((n * PI * a / b).exp() + 1.0))).iter().sum();
    a * b.powi(3) / 3.0 * (1.0 - 192.0 / PI.powi(5) * (b / a) * (31.0 / 32.0 * ZETA_5 - rest))
}

/// Fibres along y and z. Shear is the parabola of ν = 0, 5/4 (1 − ζ²), which no fibre at the edges feels; twist is
/// Saint-Venant's.
pub(super) fn rectangle_fibres(width: f64, height: f64, [along_y, along_z]: [usize; 2]) -> Vec<Fibre> {
    let parabola = |x: f64| 1.25 * (1.0 - x * x);
    let mut fibres = Vec::new();
    for (x, w_y) in pairs(along_y) {
        for (x_z, w_z) in pairs(along_z) {
            let (y, z) = (0.5 * width * x, 0.5 * height * x_z);
            let [t_y, t_z] = rectangle_twist(width, height, y, z);
            let shear = [[parabola(x), 0.0, t_y], [0.0, parabola(x_z), t_z]];
            fibres.push(Fibre { area: 0.25 * w_y * w_z * width * height, y, z, shear });
        }
    }
    fibres
}

/// (∂φ/∂z, −∂φ/∂y) of Prandtl's function, ∇²φ = −2 (Timoshenko & Goodier, art. 109): with c across the rectangle, |c| < b,
/// and p along it, |p| < a, φ = b² − c² − 32 b²/π³ Σ_{n odd} (−1)^((n−1)/2) n⁻³ cosh(kp)/cosh(ka) cos(kc), k = nπ/2b.
fn rectangle_twist(width: f64, height: f64, y: f64, z: f64) -> [f64; 2] {
    let flat = width >= height;
    let (a, b, p, c) = if flat { (width, height, y, z) } else { (height, width, z, y) };
    let (a, b) = (0.5 * a, 0.5 * b);
    let (mut along, mut across) = (0.0, -2.0 * c);
    // Inside, the terms fall like exp(−k (a − |p|)); at the very edge the rest is 0.3 % of the greatest stress.
    for i in 0..64 {
        let n = f64::from(2 * i + 1);
        let k = 0.5 * n * PI / b;
        let factor = 16.0 * b / (PI * n).powi(2) * if i % 2 == 0 { 1.0 } else { -1.0 };
        let (near, far) = ((k * (p.abs() - a)).exp(), (-k * (p.abs() + a)).exp());
        let end = 1.0 + (-2.0 * k * a).exp();
        across += factor * (near + far) / end * (k * c).sin();
        along -= factor * (near - far) / end * p.signum() * (k * c).cos();
    }
    if flat { [across, -along] } else { [along, -across] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sections::tests::close;

    #[test]
    fn rectangle_torsion_matches_the_tables() {
        // Six digits are quoted in the scenes' conventions.
        close(rectangle_torsion(1.0, 1.0), 0.140577, 5e-7 / 0.14);
        // Timoshenko & Goodier, table of art. 109: k₁ = J/(a b³), three digits.
        for (ratio, k) in
            [(1.2, 0.166), (1.5, 0.196), (2.0, 0.229), (2.5, 0.249), (3.0, 0.263), (5.0, 0.291), (10.0, 0.312)]
        {
            assert!((rectangle_torsion(ratio, 1.0) / ratio - k).abs() < 6e-4, "a/b = {ratio}");
        }
        // The series as printed, summed until its tail (n⁻⁴/8 at n = 4001) is below 1e-15.
        let (a, b) = (1.3, 1.0);
        let sum: f64 = (0..2000).map(|i| f64::from(2 * i + 1)).map(|n| (0.5 * n * PI * a / b).tanh() / n.powi(5)).sum();
        close(rectangle_torsion(a, b), a * b.powi(3) / 3.0 * (1.0 - 192.0 / PI.powi(5) * b / a * sum), 1e-14);
    }

    #[test]
    fn nonsense_is_named() {
        assert_eq!(rectangle(0.0, 1.0).unwrap_err(), "`width` is 0, but must be a positive number");
        assert_eq!(rectangle(1.0, f64::NAN).unwrap_err(), "`height` is NaN, but must be a positive number");
    }
}
