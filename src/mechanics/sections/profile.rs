//! Thin-walled shapes as walls and plates: the walls' middle lines carry the shear flow, the plates are the area.
//!
//! Areas and moments are those of the drawn rectangles with sharp corners; shear follows the middle lines. Torsion is Σ b t³/3 over middle
//! lines less 0.105 t⁴ for each free end (El Darwish & Johnston 1965, J. Struct. Div. ASCE 91(ST1), 203-227; 0.21 t⁴ is the exact loss of a
//! narrow rectangle's two ends). The bulge where walls meet is left out, and so are fillets: the constant is up to 3 % low for sharp
//! corners.

use super::dimensions::rectangles;
use super::fibres::Fibre;
use super::section::Section;
use super::section_shape::SectionShape;
use super::stresses::{SectionOutline, StressPoint};
use super::wall::{Wall, flow_at, shear};
use base::math::quadrature::pairs;
use nalgebra::Vector2;
use std::fmt;

/// Straight walls, each with the rectangle it fills; the rectangles lie side by side.
pub struct Profile {
    /// Ends of the middle lines.
    pub points: Vec<[f64; 2]>,
    /// The walls.
    pub walls: Vec<Wall>,
    /// For each wall (y, z) of its rectangle's centre, its width and its height.
    pub plates: Vec<([f64; 2], f64, f64)>,
    /// The walls close one cell; otherwise they form a tree.
    pub cell: bool,
    /// Saint-Venant torsion constant.
    pub torsion: f64,
}

impl Profile {
    /// The geometry of the section as a whole.
    pub fn section(&self) -> Section {
        let (area, center, [Iy, Iz, Iyz]) = rectangles(&self.plates);
        let shear = shear(&self.points, &self.walls, self.cell);
        Section {
            area,
            Iy,
            Iz,
            Iyz,
            torsion: self.torsion,
            shear: shear.areas,
            shear_center: [shear.center[0] - center[0], shear.center[1] - center[1]],
        }
    }

    /// Fibres along the longest wall, and through the thickness of each; other walls have their share by length, of four at
    /// least. Shear modes are about the shear centre: the flow of each unit strain, and the linear stress of a twisted strip.
    pub fn fibres(&self, [along, through]: [usize; 2]) -> Vec<Fibre> {
        let (_, center, _) = rectangles(&self.plates);
        let shear = shear(&self.points, &self.walls, self.cell);
        let [yy, zz, yz] = shear.areas;
        let ends = |wall: &Wall| wall.ends.map(|i| Vector2::from(self.points[i]));
        let length = |wall: &Wall| (ends(wall)[1] - ends(wall)[0]).norm();
        let longest = self.walls.iter().map(length).fold(0.0, f64::max);
        let mut fibres = Vec::new();
        for (k, (wall, &(middle, width, height))) in self.walls.iter().zip(&self.plates).enumerate() {
            let from = ends(wall)[0];
            let (t, length) = (wall.thickness, length(wall));
            let e = (ends(wall)[1] - from) / length;
            let n = Vector2::new(-e.y, e.x);
            let long = if e.x == 0.0 { height } else { width };
            // Rounded up to whole pairs, but not by round-off.
            let share = 2 * (0.5 * along as f64 * length / longest - 1e-9).ceil() as usize;
            for (x, w) in pairs(share.max(along.min(4))) {
                for (x_n, w_n) in pairs(through) {
                    let at = Vector2::from(middle) + 0.5 * long * x * e;
                    // The plate may be longer than the middle line, in a corner; the flow there is that of the line's
                    // end.
                    let s = ((at - from).dot(&e) / length).clamp(0.0, 1.0);
                    let [q_y, q_z] = [0, 1].map(|force| flow_at(shear.flows[force][k], s));
                    let offset = 0.5 * t * x_n;
                    let place = at + offset * n - Vector2::from(center);
                    let modes =
                        [(yy * q_y + yz * q_z) / t, (yz * q_y + zz * q_z) / t, shear.circulation / t - 2.0 * offset];
                    let area = 0.25 * w * w_n * long * t;
                    fibres.push(Fibre { area, y: place.x, z: place.y, shear: [modes, [0.0; 3]] });
                }
            }
        }
        fibres
    }

    /// The points with the extreme stresses; `section` is that of the profile. They lie on both faces of each wall: at the ends of its plate and
    /// of its middle line, in its middle, and at the extremes of the shear flow.
    pub fn outline(&self, section: &Section) -> SectionOutline {
        let (_, center, _) = rectangles(&self.plates);
        let shear = shear(&self.points, &self.walls, self.cell);
        let mut points = Vec::new();
        for (k, (wall, &(middle, width, height))) in self.walls.iter().zip(&self.plates).enumerate() {
            let [from, to] = wall.ends.map(|i| Vector2::from(self.points[i]));
            let (t, length) = (wall.thickness, (to - from).norm());
            let e = (to - from) / length;
            let long = if e.x == 0.0 { height } else { width };
            let plate = (Vector2::from(middle) - from).dot(&e) / length;
            let reach = 0.5 * long / length;
            let turns = [0, 1].map(|force| {
                let [_, c1, c2] = shear.flows[force][k];
                -0.5 * c1 / c2
            });
            let inside = turns.into_iter().filter(|s| *s > 0.0 && *s < 1.0);
            for s in [plate - reach, 0.0, 0.5, 1.0, plate + reach].into_iter().chain(inside) {
                // The plate may be longer than the middle line, in a corner, or shorter.
                let s = s.clamp(plate - reach, plate + reach);
                let flows = [0, 1].map(|force| flow_at(shear.flows[force][k], s.clamp(0.0, 1.0)) / t);
                for offset in [0.5 * t, -0.5 * t] {
                    let at = from + s * length * e + offset * Vector2::new(-e.y, e.x) - Vector2::from(center);
                    let twist = (shear.circulation / t - 2.0 * offset) / section.torsion;
                    let shear = [[flows[0], flows[1], twist], [0.0; 3]];
                    points.push(StressPoint { at: at.into(), wall: k, modulus: 1.0, shear });
                }
            }
        }
        SectionOutline::Points(points)
    }
}

/// A shape of straight walls with sharp corners: the section follows from its profile.
pub trait Walled: fmt::Debug {
    /// The default numbers of fibres: along the longest wall, and through the thickness of each.
    const FIBRES: [usize; 2];

    /// The walls. Errors: dimensions that do not go together.
    fn profile(&self) -> Result<Profile, String>;

    /// The largest sizes along y and z.
    fn sides(&self) -> [f64; 2];
}

impl<T: Walled> SectionShape for T {
    fn section(&self, _: f64) -> Result<Section, String> {
        Ok(self.profile()?.section())
    }

    fn default_fibres(&self, _: Option<usize>) -> Result<[usize; 2], String> {
        Ok(T::FIBRES)
    }

    fn lay_fibres(&self, counts: [usize; 2], _: &Section) -> Result<Vec<Fibre>, String> {
        Ok(self.profile()?.fibres(counts))
    }

    fn outline(&self, _: f64, section: &Section) -> Option<SectionOutline> {
        Some(self.profile().ok()?.outline(section))
    }

    fn half_depth(&self) -> f64 {
        let [width, height] = self.sides();
        0.5 * width.min(height)
    }
}

/// A profile of open walls, each with its plate; `free` lists the thickness at each free end.
pub fn thin(
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
    use crate::sections::tests::{angle, channel, i_section};

    /// Against Prandtl's problem on the sharp-cornered shapes, solved by finite differences (five points, two grids and their
    /// extrapolation; the same program gives the square's 0.140577). The missing part is the bulge at the junctions.
    #[test]
    fn torsion_is_slightly_low() {
        for (section, exact) in [
            (angle(100.0, 100.0, 10.0, 10.0), 61_940.0),
            (angle(100.0, 100.0, 20.0, 20.0), 457_700.0),
            (channel(200.0, 76.0, 8.0, 12.0), 111_170.0),
            (i_section(200.0, [100.0; 2], 6.0, [8.0; 2]), 46_877.0),
            (i_section(300.0, [100.0; 2], 10.0, [20.0; 2]), 571_750.0),
        ] {
            let torsion = section.unwrap().torsion;
            assert!(torsion < exact && torsion > 0.97 * exact, "{torsion} for {exact}");
        }
    }

    #[test]
    fn nonsense_is_named() {
        assert_eq!(
            channel(0.2, 0.075, 0.08, 0.01).unwrap_err(),
            "`web_thickness` is 0.08, but the web must leave a flange: less than width = 0.075"
        );
        assert!(
            i_section(0.2, [0.1; 2], 0.01, [0.12, 0.1]).unwrap_err().contains("both together must be less than height")
        );
        assert!(angle(0.1, 0.1, 0.09, 0.09).unwrap_err().contains("not thin-walled"));
        assert!(angle(0.1, f64::INFINITY, 0.09, 0.01).unwrap_err().starts_with("`width` is inf"));
    }
}
