//! The rectangle.

use super::dimensions::positive;
use super::fibres::Fibre;
use super::section::{Section, saint_venant};
use super::section_shape::{CrossSection, MakeSection, SHEAR_FACTOR, SectionKind, SectionShape};
use super::stresses::{SectionOutline, StressPoint};
use base::math::quadrature::kinked;
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
        SHEAR_FACTOR,
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
    fn section(&self, nu: f64) -> Result<Section, String> {
        rectangle(self.width, self.height, nu)
    }

    fn default_fibres(&self, first: Option<usize>) -> Result<[usize; 2], String> {
        Ok(first.map_or([12; 2], |n| [n; 2]))
    }

    fn lay_fibres(&self, counts: [usize; 2], _: &Section) -> Result<Vec<Fibre>, String> {
        Ok(rectangle_fibres(self.width, self.height, counts))
    }

    fn outline(&self, nu: f64, section: &Section) -> Option<SectionOutline> {
        Some(SectionOutline::Points(rectangle_points(self.width, self.height, nu, section)))
    }

    fn depth(&self, [y, z]: [f64; 2]) -> Option<f64> {
        Some((0.5 * self.width - y.abs()).min(0.5 * self.height - z.abs()))
    }

    fn cover_and_core(&self, cover: f64, [along_y, along_z]: [usize; 2]) -> Option<[Vec<Fibre>; 2]> {
        let (width, height) = (self.width - 2.0 * cover, self.height - 2.0 * cover);
        if width.min(height) <= 0.0 {
            return None;
        }
        let block = |size: [f64; 2], counts: [usize; 2], at: [f64; 2]| {
            let fibres = rectangle_fibres(size[0], size[1], counts).into_iter();
            fibres.map(move |f| Fibre { y: f.y + at[0], z: f.z + at[1], shear: [[0.0; 3]; 2], ..f })
        };
        let mut strips = Vec::new();
        for side in [-0.5, 0.5] {
            strips.extend(block([self.width, cover], [along_y, 2], [0.0, side * (height + cover)]));
            strips.extend(block([cover, height], [2, along_z], [side * (width + cover), 0.0]));
        }
        Some([strips, block([width, height], [along_y, along_z], [0.0; 2]).collect()])
    }

    fn half_depth(&self) -> f64 {
        0.5 * self.width.min(self.height)
    }
}

/// Solid rectangle of a material of Poisson's ratio `nu`.
pub fn rectangle(width: f64, height: f64, nu: f64) -> Result<Section, String> {
    positive(&[("width", width), ("height", height)])?;
    let area = width * height;
    let shear = |across: f64, along: f64| area / (1.2 + saint_venant(nu) * anticlastic(across / along));
    Ok(Section {
        area,
        Iy: area * height * height / 12.0,
        Iz: area * width * width / 12.0,
        Iyz: 0.0,
        torsion: rectangle_torsion(width.max(height), width.min(height)),
        shear: [shear(height, width), shear(width, height), 0.0],
        shear_center: [0.0; 2],
    })
}

/// C in the shear flexibility 6/5 + (ν/(1 + ν))² C of a rectangle; `r` is its width over its depth along the force.
///
/// C = A/I² ∫|∇φ|² dA is the energy of the shear stress from anticlastic bending, ∇²φ = −y with φ = 0 at the edge (F. Gruttmann and W.
/// Wagner, 2001, Comput. Mech. 27, 199-207). Series across and along the force give, with k = (m + ½)π, C = r⁴ (1/5 − 18 r/π⁵ Σ
/// tanh(nπ/r)/n⁵) = r² − 558 ζ(5)/π⁵ r + 6/5 − 18 r Σ 2/((e^(2kr) − 1) k⁵); the error after five terms is 1e-16 on either side of 1.
fn anticlastic(r: f64) -> f64 {
    if r <= 1.0 {
        let rest: f64 =
            [1.0, 2.0, 3.0, 4.0, 5.0].map(|n: f64| 2.0 / (n.powi(5) * ((2.0 * n * PI / r).exp() + 1.0))).iter().sum();
        return r.powi(4) * (0.2 - 18.0 * r / PI.powi(5) * (ZETA_5 - rest));
    }
    let rest: f64 = [0.5, 1.5, 2.5, 3.5, 4.5]
        .map(|m| m * PI)
        .map(|k: f64| 2.0 / (((2.0 * k * r).exp() - 1.0) * k.powi(5)))
        .iter()
        .sum();
    r * r - 558.0 * ZETA_5 / PI.powi(5) * r + 1.2 - 18.0 * r * rest
}

/// ζ(5) = Σ n⁻⁵.
const ZETA_5: f64 = 1.036_927_755_143_37;

/// J = a b³/3 (1 − 192/π⁵ (b/a) Σ_{n odd} tanh(nπa/2b)/n⁵), a ≥ b (Timoshenko & Goodier, Theory of Elasticity, art. 109).
/// With tanh x = 1 − 2/(e²ˣ + 1) and Σ_{n odd} n⁻⁵ = 31/32 ζ(5) the rest falls like e^(−nπ): five terms leave 1e-17.
fn rectangle_torsion(a: f64, b: f64) -> f64 {
    let rest: f64 =
        [1.0, 3.0, 5.0, 7.0, 9.0].map(|n: f64| 2.0 / (n.powi(5) * ((n * PI * a / b).exp() + 1.0))).iter().sum();
    a * b.powi(3) / 3.0 * (1.0 - 192.0 / PI.powi(5) * (b / a) * (31.0 / 32.0 * ZETA_5 - rest))
}

/// Corners, middles of the sides and the centre: normal stress is extreme in corners, shear stress in the middles, or in the centre.
fn rectangle_points(width: f64, height: f64, nu: f64, section: &Section) -> Vec<StressPoint> {
    let (y, z) = (0.5 * width, 0.5 * height);
    let along_y = flexure(width, height, nu).map(|tau| tau / section.area);
    let along_z = flexure(height, width, nu).map(|tau| tau / section.area);
    let corner = |at: [f64; 2]| StressPoint { at, wall: 0, modulus: 1.0, shear: [[0.0; 3]; 2] };
    let mut points: Vec<StressPoint> = [[y, z], [-y, z], [-y, -z], [y, -z]].map(corner).into();
    for side in [1.0, -1.0] {
        let [_, twist] = rectangle_twist(width, height, side * y, 0.0);
        let shear = [[0.0; 3], [0.0, along_z[1], twist / section.torsion]];
        points.push(StressPoint { at: [side * y, 0.0], wall: 0, modulus: 1.0, shear });
        let [twist, _] = rectangle_twist(width, height, 0.0, side * z);
        let shear = [[along_y[1], 0.0, twist / section.torsion], [0.0; 3]];
        points.push(StressPoint { at: [0.0, side * z], wall: 0, modulus: 1.0, shear });
    }
    points.push(StressPoint {
        at: [0.0; 2],
        wall: 0,
        modulus: 1.0,
        shear: [[along_y[0], 0.0, 0.0], [0.0, along_z[0], 0.0]],
    });
    points
}

/// Shear stress times area over the shear force in a rectangle, at two places: the centre, and the middle of the sides along the force. These
/// sides are `depth` long and `width` apart.
///
/// τ = (a² − x²)/2I + ∂φ/∂y, with ∇²φ = ν/(1 + ν) y/I and φ = 0 at the edge (Timoshenko & Goodier, art. 122). φ is a sine series along y; its
/// part without cosh x has a closed sum.
pub(super) fn flexure(depth: f64, width: f64, nu: f64) -> [f64; 2] {
    let (a, b) = (0.5 * depth, 0.5 * width);
    let decay = PI * a / b;
    let terms = (1..=MOST_TERMS).map(f64::from).take_while(|n| n * decay < 40.0);
    let sums = terms.fold([0.0; 2], |[centre, side], n| {
        let term = 1.0 / (n * n * (n * decay).cosh());
        [centre + if n % 2.0 == 1.0 { term } else { -term }, side - term]
    });
    let lateral = |square: f64, sum: f64| b * b * (1.0 / 6.0 - 0.5 * square - 2.0 / (PI * PI) * sum);
    // A/I = 3/a².
    let share = nu / (1.0 + nu);
    [(0.0, sums[0]), (1.0, sums[1])].map(|(square, sum)| 3.0 / (a * a) * (0.5 * a * a - share * lateral(square, sum)))
}

/// Terms of the series of a strip a thousand times as wide as deep.
const MOST_TERMS: u32 = 10_000;

/// Fibres along y and z. Shear is the parabola of ν = 0, 5/4 (1 − ζ²), zero at the edges; [`super::fibres::calibrated`] scales it to the
/// shear area. Twist is Saint-Venant's.
pub(super) fn rectangle_fibres(width: f64, height: f64, [along_y, along_z]: [usize; 2]) -> Vec<Fibre> {
    let parabola = |x: f64| 1.25 * (1.0 - x * x);
    let mut fibres = Vec::new();
    let across = kinked(along_z);
    for (x, w_y) in kinked(along_y) {
        for &(x_z, w_z) in &across {
            let (y, z) = (0.5 * width * x, 0.5 * height * x_z);
            let [t_y, t_z] = rectangle_twist(width, height, y, z);
            let shear = [[parabola(x), 0.0, t_y], [0.0, parabola(x_z), t_z]];
            fibres.push(Fibre { area: 0.25 * w_y * w_z * width * height, y, z, shear });
        }
    }
    fibres
}

/// (∂φ/∂z, −∂φ/∂y) of Prandtl's function, ∇²φ = −2 (Timoshenko & Goodier, art. 109). With c across the rectangle, |c| < b, and p along it,
/// |p| < a, φ = b² − c² − 32 b²/π³ Σ_{n odd} (−1)^((n−1)/2) n⁻³ cosh(kp)/cosh(ka) cos(kc), k = nπ/2b.
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

    /// ∫φ y dA of ∇²φ = −y on |y| < a, |z| < b with φ = 0 at the edge, by five-point differences on n × n cells and conjugate gradients.
    fn torsion_like_energy(a: f64, b: f64, n: usize) -> f64 {
        let (h_y, h_z) = (2.0 * a / n as f64, 2.0 * b / n as f64);
        let (w_y, w_z) = (1.0 / (h_y * h_y), 1.0 / (h_z * h_z));
        let inner = |i: usize, j: usize| (1..n).contains(&i) && (1..n).contains(&j);
        let at = |i: usize, j: usize| i * (n + 1) + j;
        let all = || (0..=n).flat_map(|i| (0..=n).map(move |j| (i, j))).filter(|&(i, j)| inner(i, j));
        let apply = |x: &[f64]| {
            let mut out = vec![0.0; x.len()];
            for (i, j) in all() {
                out[at(i, j)] = w_y * (2.0 * x[at(i, j)] - x[at(i - 1, j)] - x[at(i + 1, j)])
                    + w_z * (2.0 * x[at(i, j)] - x[at(i, j - 1)] - x[at(i, j + 1)]);
            }
            out
        };
        let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
        let mut load = vec![0.0; (n + 1) * (n + 1)];
        all().for_each(|(i, j)| load[at(i, j)] = h_y * i as f64 - a);
        let (mut x, mut r) = (vec![0.0; load.len()], load.clone());
        let mut p = r.clone();
        let start = dot(&r, &r);
        while dot(&r, &r) > 1e-24 * start {
            let Ap = apply(&p);
            let before = dot(&r, &r);
            let alpha = before / dot(&p, &Ap);
            x.iter_mut().zip(&p).for_each(|(x, p)| *x += alpha * p);
            r.iter_mut().zip(&Ap).for_each(|(r, Ap)| *r -= alpha * Ap);
            let beta = dot(&r, &r) / before;
            p.iter_mut().zip(&r).for_each(|(p, r)| *p = r + beta * *p);
        }
        dot(&x, &load) * h_y * h_z
    }

    /// Both series against finite differences on two grids. Their extrapolation has an error of h⁴ ln h, up to 1e-4, because y is not zero
    /// in the corners.
    #[test]
    fn anticlastic_shear_by_finite_differences() {
        for r in [0.5, 0.9, 1.1, 2.0, 4.0] {
            let by = |n| torsion_like_energy(r, 1.0, n) * (4.0 * r) / (4.0 / 3.0 * r).powi(2);
            close(anticlastic(r), (4.0 * by(64) - by(32)) / 3.0, 1e-4);
        }
    }

    /// The series agree where they meet, to the round-off of terms of 2; and factors of Gruttmann & Wagner 2001 for ν = 0.25, two digits.
    #[test]
    fn shear_areas_of_rectangles() {
        close(anticlastic(1.0), anticlastic(1.0 + 1e-15), 1e-13);
        for (ratio, factor) in [(2.0, 0.80), (4.0, 0.63)] {
            let section = rectangle(ratio, 1.0, 0.25).unwrap();
            assert!((section.shear[1] / section.area - factor).abs() < 5e-3, "{ratio}: {section:?}");
            close(rectangle(1.0, ratio, 0.25).unwrap().shear[0], section.shear[1], 1e-15);
        }
        for ratio in [0.01, 1.0, 100.0] {
            let section = rectangle(ratio, 1.0, 0.0).unwrap();
            close(section.shear[1], 5.0 / 6.0 * section.area, 1e-15);
        }
    }

    #[test]
    fn nonsense_is_named() {
        assert_eq!(rectangle(0.0, 1.0, 0.3).unwrap_err(), "`width` is 0, but must be a positive number");
        assert_eq!(rectangle(1.0, f64::NAN, 0.3).unwrap_err(), "`height` is NaN, but must be a positive number");
    }
}
