//! Full shapes: rectangle and circle; the circle with a hole of any size lies between the full one and the thin tube.

use super::fibres::{Fibre, pairs};
use super::{Section, positive};
use std::f64::consts::{PI, TAU};

impl Section {
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

    /// Circular tube; a thickness equal to the radius is a solid round.
    ///
    /// Shear factor: Cowper 1966 (J. Appl. Mech. 33, 335-340) for the hollow circle at ν = 0, as the section knows no
    /// material: 6/7 when solid, 1/2 when thin.
    pub fn tube(outer_radius: f64, thickness: f64) -> Result<Section, String> {
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
        // k = 6 (1 + m²)² / (7 (1 + m²)² + 20 m²), m = inner/outer radius.
        let m2 = (inner_radius / outer_radius).powi(2);
        let a = (1.0 + m2).powi(2);
        let shear = 6.0 * a / (7.0 * a + 20.0 * m2) * area;
        Ok(Section {
            area,
            Iy: I,
            Iz: I,
            Iyz: 0.0,
            torsion: 2.0 * I,
            shear: [shear, shear, 0.0],
            shear_center: [0.0; 2],
        })
    }
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
pub fn rectangle_fibres(width: f64, height: f64, [along_y, along_z]: [usize; 2]) -> Vec<Fibre> {
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

/// Fibres around and through the wall. The shear of Γ₃ is the gradient of ψ = f(r) sin φ with ∇²ψ = −z A_s/I and free
/// surfaces, Saint-Venant's flexure at ν = 0, whose energy gives Cowper's factor; twist is r along the circle.
pub fn tube_fibres(outer: f64, inner: f64, shear_area: f64, [around, through]: [usize; 2]) -> Vec<Fibre> {
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

    /// The tube between its limits: exact differences of full circles, all to round-off.
    #[test]
    fn thick_tube_is_a_circle_less_a_circle() {
        let (outer, inner): (f64, f64) = (0.05, 0.02);
        let tube = Section::tube(outer, outer - inner).unwrap();
        close(tube.area, PI * (outer.powi(2) - inner.powi(2)), 1e-14);
        close(tube.Iy, PI / 4.0 * (outer.powi(4) - inner.powi(4)), 1e-14);
        close(tube.torsion, PI / 2.0 * (outer.powi(4) - inner.powi(4)), 1e-14);
        let round = Section::tube(outer, outer).unwrap();
        close(round.shear[0], 6.0 / 7.0 * round.area, 1e-15);
        close(round.Iz, PI / 4.0 * outer.powi(4), 1e-15);
    }

    /// Corrections are of the order t/R = 1e-6 squared for the shear factor, and first order for the moments about R.
    #[test]
    fn thin_tube_has_shear_factor_one_half() {
        let (R, t) = (1.0, 1e-6);
        let tube = Section::tube(R, t).unwrap();
        close(tube.shear[1], 0.5 * tube.area, 1e-11);
        close(tube.area, 2.0 * PI * R * t, 1e-6);
        close(tube.torsion, 2.0 * PI * R.powi(3) * t, 2e-6);
    }

    #[test]
    fn nonsense_is_named() {
        assert_eq!(Section::rectangle(0.0, 1.0).unwrap_err(), "`width` is 0, but must be a positive number");
        assert_eq!(Section::rectangle(1.0, f64::NAN).unwrap_err(), "`height` is NaN, but must be a positive number");
        assert!(Section::tube(0.1, 0.2).unwrap_err().starts_with("`thickness` is 0.2, but a wall cannot be thicker"));
    }
}
