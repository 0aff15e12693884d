//! Open thin-walled shapes: I, C, L.
//!
//! Areas and moments are those of the drawn rectangles, corners sharp; shear follows the middle lines; torsion is
//! Σ b t³/3 over middle lines less 0.105 t⁴ for each free end (El Darwish & Johnston 1965, J. Struct. Div. ASCE 91(ST1),
//! 203-227; 0.21 t⁴ is the exact loss of a narrow rectangle's two ends). The bulge where walls meet is left out, and so are
//! fillets: the constant is up to 3 % low for sharp corners.

use super::profile::Profile;
use super::wall::Wall;
use super::{Section, positive, smaller};

impl Section {
    /// I section: web along z on the axis y = 0, flanges of any two sizes; also a T in the limit of a small flange.
    pub fn i(
        height: f64,
        width_top: f64,
        width_bottom: f64,
        web: f64,
        flange_top: f64,
        flange_bottom: f64,
    ) -> Result<Section, String> {
        Ok(i(height, width_top, width_bottom, web, flange_top, flange_bottom)?.section())
    }

    /// Channel: web along z at the side of −y, flanges pointing to +y.
    pub fn c(height: f64, width: f64, web: f64, flange: f64) -> Result<Section, String> {
        Ok(c(height, width, web, flange)?.section())
    }

    /// Angle: corner at −y, −z; one leg of thickness `vertical` up along z, one of thickness `horizontal` out along y.
    pub fn l(height: f64, width: f64, vertical: f64, horizontal: f64) -> Result<Section, String> {
        Ok(l(height, width, vertical, horizontal)?.section())
    }
}

/// Walls of [`Section::i`], flanges in halves from their free ends to the web.
pub fn i(
    height: f64,
    width_top: f64,
    width_bottom: f64,
    web: f64,
    flange_top: f64,
    flange_bottom: f64,
) -> Result<Profile, String> {
    positive(&[
        ("height", height),
        ("width", width_top),
        ("width", width_bottom),
        ("web_thickness", web),
        ("flange_thickness", flange_top),
        ("flange_thickness", flange_bottom),
    ])?;
    smaller(("web_thickness", web), ("width", width_top.min(width_bottom)), "the flanges must be wider than the web:")?;
    let clear = height - flange_top - flange_bottom;
    smaller(("flange_thickness", flange_top + flange_bottom), ("height", height), "both together must be less than")?;
    let (top, bottom) = (0.5 * (height - flange_top), 0.5 * (flange_bottom - height));
    let (a, b) = (0.5 * width_top, 0.5 * width_bottom);
    let points = vec![[-a, top], [a, top], [0.0, top], [-b, bottom], [b, bottom], [0.0, bottom]];
    let walls = [(0, 2, flange_top), (1, 2, flange_top), (2, 5, web), (3, 5, flange_bottom), (4, 5, flange_bottom)];
    let plates = vec![
        ([-0.5 * a, top], a, flange_top),
        ([0.5 * a, top], a, flange_top),
        ([0.0, 0.5 * (flange_bottom - flange_top)], web, clear),
        ([-0.5 * b, bottom], b, flange_bottom),
        ([0.5 * b, bottom], b, flange_bottom),
    ];
    thin(points, &walls, plates, &[flange_top, flange_top, flange_bottom, flange_bottom])
}

/// Walls of [`Section::c`]; the web takes the corners.
pub fn c(height: f64, width: f64, web: f64, flange: f64) -> Result<Profile, String> {
    positive(&[("height", height), ("width", width), ("web_thickness", web), ("flange_thickness", flange)])?;
    smaller(("web_thickness", web), ("width", width), "the web must leave a flange: less than")?;
    smaller(("flange_thickness", flange), ("height/2", 0.5 * height), "two flanges must leave a web: less than")?;
    let (out, z) = (0.5 * (width + web), 0.5 * (height - flange));
    let plates =
        vec![([out, z], width - web, flange), ([0.5 * web, 0.0], web, height), ([out, -z], width - web, flange)];
    let points = vec![[width, z], [0.5 * web, z], [0.5 * web, -z], [width, -z]];
    let walls = [(0, 1, flange), (1, 2, web), (3, 2, flange)];
    thin(points, &walls, plates, &[flange, flange])
}

/// Walls of [`Section::l`]; the upright leg takes the corner.
pub fn l(height: f64, width: f64, vertical: f64, horizontal: f64) -> Result<Profile, String> {
    positive(&[("height", height), ("width", width), ("thickness", vertical), ("thickness", horizontal)])?;
    smaller(("thickness", vertical), ("width", width), "the upright leg must leave a flat one: less than")?;
    smaller(("thickness", horizontal), ("height", height), "the flat leg must leave an upright one: less than")?;
    let (y, z) = (0.5 * vertical, 0.5 * horizontal);
    let plates =
        vec![([y, 0.5 * height], vertical, height), ([0.5 * (width + vertical), z], width - vertical, horizontal)];
    let points = vec![[y, height], [y, z], [width, z]];
    let walls = [(0, 1, vertical), (1, 2, horizontal)];
    thin(points, &walls, plates, &[vertical, horizontal])
}

/// A profile of open walls, each with its plate; `free` lists the thickness at each free end.
fn thin(
    points: Vec<[f64; 2]>,
    walls: &[(usize, usize, f64)],
    plates: Vec<([f64; 2], f64, f64)>,
    free: &[f64],
) -> Result<Profile, String> {
    let length = |a: usize, b: usize| (points[a][0] - points[b][0]).hypot(points[a][1] - points[b][1]);
    if let Some(&(a, b, t)) = walls.iter().find(|&&(a, b, t)| length(a, b) < t) {
        let length = length(a, b);
        return Err(format!(
            "a wall of thickness {t} is only {length} long, which is not thin-walled; use shape = \"general\""
        ));
    }
    let strips: f64 = walls.iter().map(|&(a, b, t)| length(a, b) * t.powi(3) / 3.0).sum();
    let ends: f64 = free.iter().map(|t| 0.105 * t.powi(4)).sum();
    let walls = walls.iter().map(|&(a, b, thickness)| Wall { ends: [a, b], thickness }).collect();
    Ok(Profile { points, walls, plates, cell: false, torsion: strips - ends })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sections::{rectangles, tests::close};

    /// Textbook formula, middle-line dimensions: e = 3 b² t_f / (6 b t_f + h t_w) outside the web (Timoshenko, Strength of
    /// Materials II, art. 53). The flow is integrated exactly, so only round-off remains.
    #[test]
    fn channel_shear_center_is_behind_the_web() {
        let (height, width, web, flange) = (0.2, 0.075, 0.0085, 0.0115);
        let c = Section::c(height, width, web, flange).unwrap();
        let (b, h) = (width - 0.5 * web, height - flange);
        let e = 3.0 * b * b * flange / (6.0 * b * flange + h * web);
        let area = height * web + 2.0 * (width - web) * flange;
        let centroid = (0.5 * height * web * web + (width - web) * flange * (width + web)) / area;
        close(c.area, area, 1e-14);
        close(c.shear_center[0], 0.5 * web - e - centroid, 1e-12);
        assert!(c.shear_center[1].abs() < 1e-15 && c.Iyz.abs() < 1e-15 * c.Iy && c.shear[2].abs() < 1e-12 * c.area);
    }

    /// Each leg's flow runs through the corner of the middle lines, so does its resultant.
    #[test]
    fn angle_shear_center_is_the_corner() {
        let l = Section::l(0.12, 0.08, 0.01, 0.008).unwrap();
        let (_, center, _) = rectangles(&[([0.005, 0.06], 0.01, 0.12), ([0.045, 0.004], 0.07, 0.008)]);
        close(l.shear_center[0], 0.005 - center[0], 1e-12);
        close(l.shear_center[1], 0.004 - center[1], 1e-12);
        assert!(l.Iyz < 0.0, "the legs fill the second and fourth quadrants");
    }

    /// Symmetry about the bisector: both the moments and the shear areas have their principal axes at 45°.
    /// EN 10056-1, L 100×100×10: A = 19.2 cm², I = 177 cm⁴, centroid at 2.82 cm; its rounded toes take up to 2 % off
    /// both.
    #[test]
    fn equal_angle_has_axes_at_45_degrees() {
        let l = Section::l(0.1, 0.1, 0.01, 0.01).unwrap();
        close(l.Iy, l.Iz, 1e-14);
        close(l.shear[0], l.shear[1], 1e-12);
        close(l.Iy, 177e-8, 0.02);
        close(l.area, 19.2e-4, 0.011);
        close(0.005 - l.shear_center[0], 2.82e-2, 0.02);
        assert!(l.shear[2] != 0.0 && l.Iyz != 0.0);
    }

    /// Shear centre on the web, where the flanges' lateral bending balances: from the top, h I_bottom/(I_top + I_bottom).
    #[test]
    fn unequal_flanges_share_shear_by_their_moments() {
        let i = Section::i(0.3, 0.2, 0.1, 0.008, 0.012, 0.015).unwrap();
        let (top, bottom) = (0.012 * 0.2f64.powi(3), 0.015 * 0.1f64.powi(3));
        let h = 0.3 - 0.5 * (0.012 + 0.015);
        let (_, center, _) =
            rectangles(&[([0.0, 0.144], 0.2, 0.012), ([0.0, 0.0015], 0.008, 0.273), ([0.0, -0.1425], 0.1, 0.015)]);
        close(i.shear_center[1], 0.144 - h * bottom / (top + bottom) - center[1], 1e-12);
        assert!(i.shear_center[0].abs() < 1e-15);
    }

    /// IPE 200 (EN 10365: A = 28.5 cm², I_y = 1943 cm⁴, I_z = 142 cm⁴, I_t = 6.98 cm⁴) has fillets of radius 12 mm; their area
    /// 4 r² (1 − π/4) is added here, the rest of their effect stays within the bounds. Torsion lives from its fillets.
    #[test]
    fn ipe_200_near_the_standard() {
        let i = Section::i(0.2, 0.1, 0.1, 0.0056, 0.0085, 0.0085).unwrap();
        close(i.area + 4.0 * 0.012f64.powi(2) * (1.0 - std::f64::consts::FRAC_PI_4), 28.5e-4, 0.002);
        close(i.Iz, 142e-8, 0.005);
        assert!(i.Iy < 1943e-8 && i.Iy > 0.94 * 1943e-8);
        assert!(i.torsion < 6.98e-8 && i.torsion > 0.6 * 6.98e-8);
        // The web carries nearly all: its middle-line area, less what the parabola takes.
        let web = 0.0056 * (0.2 - 0.0085);
        assert!(i.shear[1] < web && i.shear[1] > 0.9 * web);
        close(i.shear[0], 5.0 / 6.0 * 2.0 * 0.1 * 0.0085, 0.001);
    }

    /// Against Prandtl's problem on the sharp-cornered shapes, solved by finite differences (five points, two grids and their
    /// extrapolation; the same program gives the square's 0.140577). The junctions' bulge is what is missing.
    #[test]
    fn torsion_is_slightly_low() {
        for (section, exact) in [
            (Section::l(100.0, 100.0, 10.0, 10.0), 61_940.0),
            (Section::l(100.0, 100.0, 20.0, 20.0), 457_700.0),
            (Section::c(200.0, 76.0, 8.0, 12.0), 111_170.0),
            (Section::i(200.0, 100.0, 100.0, 6.0, 8.0, 8.0), 46_877.0),
            (Section::i(300.0, 100.0, 100.0, 10.0, 20.0, 20.0), 571_750.0),
        ] {
            let torsion = section.unwrap().torsion;
            assert!(torsion < exact && torsion > 0.97 * exact, "{torsion} for {exact}");
        }
    }

    #[test]
    fn nonsense_is_named() {
        assert_eq!(
            Section::c(0.2, 0.075, 0.08, 0.01).unwrap_err(),
            "`web_thickness` is 0.08, but the web must leave a flange: less than width = 0.075"
        );
        assert!(
            Section::i(0.2, 0.1, 0.1, 0.01, 0.12, 0.1).unwrap_err().contains("both together must be less than height")
        );
        assert!(Section::l(0.1, 0.1, 0.09, 0.09).unwrap_err().contains("not thin-walled"));
        assert!(Section::l(0.1, f64::INFINITY, 0.09, 0.01).unwrap_err().starts_with("`width` is inf"));
    }
}
