//! Sections with rounded corners: rolled I sections with root radii, and rectangular hollow sections.

use super::dimensions::{rectangles, smaller};
use super::fibres::Fibre;
use super::hollow_box::HollowBox;
use super::i::I;
use super::l::L;
use super::section::Section;
use super::section_shape::SectionShape;
use super::stresses::Outline;
use std::f64::consts::PI;

/// The area between a square corner and the quarter circle that touches its sides.
#[derive(Debug, Clone, Copy)]
struct Corner {
    area: f64,
    /// Distance of its centroid from both sides.
    arm: f64,
    /// Second moment about its centroid, parallel to a side.
    moment: f64,
    /// Product moment about its centroid, of a corner that opens towards y and z alike.
    product: f64,
}

impl Corner {
    fn new(radius: f64) -> Corner {
        let area = (1.0 - 0.25 * PI) * radius * radius;
        let arm = radius * (10.0 - 3.0 * PI) / (3.0 * (4.0 - PI));
        // The square less the quarter of a circle, about a side.
        let centroid = radius * (1.0 - 4.0 / (3.0 * PI));
        let of_circle = radius.powi(4) * (PI / 16.0 - 4.0 / (9.0 * PI)) + 0.25 * PI * (radius * centroid).powi(2);
        let moment = radius.powi(4) / 3.0 - of_circle - area * arm * arm;
        let product = radius.powi(4) * (19.0 / 24.0 - 0.25 * PI) - area * arm * arm;
        Corner { area, arm, moment, product }
    }

    /// Adds four corners at (±y, ±z) with a sign.
    fn add(&self, sign: f64, [y, z]: [f64; 2], section: &mut Section) {
        section.area += 4.0 * sign * self.area;
        section.Iy += 4.0 * sign * (self.moment + self.area * z * z);
        section.Iz += 4.0 * sign * (self.moment + self.area * y * y);
    }
}

/// A rolled I section: equal flanges with radii at the root of the web.
#[derive(Debug, Clone, PartialEq)]
pub struct RolledI {
    /// The plates.
    pub plates: I,
    /// Radius between web and flanges.
    pub root_radius: f64,
}

impl RolledI {
    /// The corner at each root, and the place of one.
    fn roots(&self) -> (Corner, [f64; 2]) {
        let corner = Corner::new(self.root_radius);
        let I { height, web, top_flange, .. } = self.plates;
        (corner, [0.5 * web + corner.arm, 0.5 * height - top_flange - corner.arm])
    }

    /// Saint-Venant torsion constant: flanges, web, and the bulges where they meet, by the circle that fits there (El Darwish & Johnston 1965).
    fn torsion(&self) -> f64 {
        let I { height, top_width: width, web, top_flange: flange, .. } = self.plates;
        let r = self.root_radius;
        let circle = ((r + 0.5 * web).powi(2) + (r + flange).powi(2) - r * r) / (2.0 * r + flange);
        let bulge = web / flange * (0.145 + 0.1 * r / flange) * circle.powi(4);
        2.0 / 3.0 * (width - 0.63 * flange) * flange.powi(3) + (height - 2.0 * flange) * web.powi(3) / 3.0 + 2.0 * bulge
    }
}

impl SectionShape for RolledI {
    fn section(&self, nu: f64) -> Result<Section, String> {
        let I { height, top_width, bottom_width, web, top_flange, bottom_flange } = self.plates;
        if top_width != bottom_width || top_flange != bottom_flange {
            return Err("`root_radius` needs equal flanges".to_owned());
        }
        let mut section = self.plates.section(nu)?;
        let room = (0.5 * (top_width - web)).min(0.5 * height - top_flange);
        smaller(("root_radius", self.root_radius), ("the room beside the web", room), "it must be less than")?;
        let (corner, place) = self.roots();
        corner.add(1.0, place, &mut section);
        Ok(Section { torsion: self.torsion(), ..section })
    }

    fn default_fibres(&self, share: Option<usize>) -> Result<[usize; 2], String> {
        self.plates.default_fibres(share)
    }

    fn lay_fibres(&self, counts: [usize; 2], section: &Section) -> Result<Vec<Fibre>, String> {
        let mut fibres = self.plates.lay_fibres(counts, section)?;
        let (Corner { area, .. }, [y, z]) = self.roots();
        let root = |[a, b]: [f64; 2]| Fibre { area, y: a * y, z: b * z, shear: [[0.0; 3]; 2] };
        fibres.extend([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]].map(root));
        Ok(fibres)
    }

    fn outline(&self, nu: f64, section: &Section) -> Option<Outline> {
        self.plates.outline(nu, section)
    }

    fn half_depth(&self) -> f64 {
        self.plates.half_depth()
    }
}

/// A rolled angle of one thickness: a radius between the legs, and half of it at the inner edges of their ends (EN 10056-1).
#[derive(Debug, Clone, PartialEq)]
pub struct RolledL {
    /// The legs with sharp corners.
    pub legs: L,
    /// Radius between the legs.
    pub root_radius: f64,
}

impl RolledL {
    /// The corners with their sign and the place of their centroids, from the outer edges: the root, and what both ends lack.
    fn corners(&self) -> [(f64, Corner, [f64; 2]); 3] {
        let L { height, width, vertical: t, .. } = self.legs;
        let (root, toe) = (Corner::new(self.root_radius), Corner::new(0.5 * self.root_radius));
        [
            (1.0, root, [t + root.arm; 2]),
            (-1.0, toe, [t - toe.arm, height - toe.arm]),
            (-1.0, toe, [width - toe.arm, t - toe.arm]),
        ]
    }

    /// The centroid of the sharp legs from the outer edges, and the shift of that of the rounded ones from there.
    fn centroids(&self) -> [[f64; 2]; 2] {
        let L { height, width, vertical: t, .. } = self.legs;
        let plates = [([0.5 * t, 0.5 * height], t, height), ([0.5 * (width + t), 0.5 * t], width - t, t)];
        let (area, sharp, _) = rectangles(&plates);
        let corners = self.corners();
        let whole = area + corners.iter().map(|(sign, corner, _)| sign * corner.area).sum::<f64>();
        let shift = [0, 1].map(|axis| {
            let moment = |(sign, corner, at): &(f64, Corner, [f64; 2])| sign * corner.area * (at[axis] - sharp[axis]);
            corners.iter().map(moment).sum::<f64>() / whole
        });
        [sharp, shift]
    }
}

impl SectionShape for RolledL {
    fn section(&self, nu: f64) -> Result<Section, String> {
        let L { height, width, vertical, horizontal } = self.legs;
        if vertical != horizontal {
            return Err("`root_radius` needs legs of one thickness".to_owned());
        }
        let mut section = self.legs.section(nu)?;
        smaller(
            ("root_radius", self.root_radius),
            ("the shorter leg", width.min(height) - vertical),
            "it must be less than",
        )?;
        smaller(("root_radius", 0.5 * self.root_radius), ("thickness", vertical), "half of it must be less than")?;
        let [sharp, [y0, z0]] = self.centroids();
        for (sign, corner, at) in self.corners() {
            let (y, z) = (at[0] - sharp[0], at[1] - sharp[1]);
            section.area += sign * corner.area;
            section.Iy += sign * (corner.moment + corner.area * z * z);
            section.Iz += sign * (corner.moment + corner.area * y * y);
            section.Iyz += sign * (corner.product + corner.area * y * z);
        }
        section.Iy -= section.area * z0 * z0;
        section.Iz -= section.area * y0 * y0;
        section.Iyz -= section.area * y0 * z0;
        let [ys, zs] = section.shear_center;
        Ok(Section { shear_center: [ys - y0, zs - z0], ..section })
    }

    fn default_fibres(&self, share: Option<usize>) -> Result<[usize; 2], String> {
        self.legs.default_fibres(share)
    }

    /// Fibres of the sharp legs with the area of the rounded ones, about their own centroid.
    fn lay_fibres(&self, counts: [usize; 2], section: &Section) -> Result<Vec<Fibre>, String> {
        let mut fibres = self.legs.lay_fibres(counts, section)?;
        let whole: f64 = fibres.iter().map(|fibre| fibre.area).sum();
        fibres.iter_mut().for_each(|fibre| fibre.area *= section.area / whole);
        Ok(fibres)
    }

    fn outline(&self, nu: f64, section: &Section) -> Option<Outline> {
        let [_, [y0, z0]] = self.centroids();
        let Outline::Points(mut points) = self.legs.outline(nu, section)? else { return None };
        points.iter_mut().for_each(|point| point.at = [point.at[0] - y0, point.at[1] - z0]);
        Some(Outline::Points(points))
    }

    fn half_depth(&self) -> f64 {
        self.legs.half_depth()
    }
}

/// A rectangular hollow section of one thickness with rounded corners.
#[derive(Debug, Clone, PartialEq)]
pub struct RoundedBox {
    /// The section with sharp corners.
    pub sharp: HollowBox,
    /// Radii of the corners outside and inside.
    pub radii: [f64; 2],
}

impl SectionShape for RoundedBox {
    fn section(&self, nu: f64) -> Result<Section, String> {
        let HollowBox { width, height, web: t, flange } = self.sharp;
        if t != flange {
            return Err("`corner_radii` need walls of one thickness".to_owned());
        }
        let mut section = self.sharp.section(nu)?;
        let [outer, inner] = self.radii;
        smaller(
            ("corner_radii", outer),
            ("half of the smaller side", 0.5 * width.min(height)),
            "they must be less than",
        )?;
        smaller(
            ("corner_radii", inner),
            ("half of the hollow", 0.5 * width.min(height) - t),
            "they must be less than",
        )?;
        for (sign, radius, wall) in [(-1.0, outer, 0.0), (1.0, inner, t)] {
            let corner = Corner::new(radius);
            let place = [width, height].map(|side| 0.5 * side - wall - corner.arm);
            corner.add(sign, place, &mut section);
        }
        // Bredt's cell and the wall's own part over the rounded middle line (EN 10210-2, annex A).
        let (radius, missing) = (0.5 * (outer + inner), 4.0 - PI);
        let length = 2.0 * (width + height - 2.0 * t) - 2.0 * radius * missing;
        let enclosed = (width - t) * (height - t) - radius * radius * missing;
        let torsion = t.powi(3) * length / 3.0 + 4.0 * enclosed * enclosed * t / length;
        Ok(Section { torsion, ..section })
    }

    fn default_fibres(&self, share: Option<usize>) -> Result<[usize; 2], String> {
        self.sharp.default_fibres(share)
    }

    /// Fibres of the section with sharp corners, with the area of this one.
    fn lay_fibres(&self, counts: [usize; 2], section: &Section) -> Result<Vec<Fibre>, String> {
        let mut fibres = self.sharp.lay_fibres(counts, section)?;
        let whole: f64 = fibres.iter().map(|fibre| fibre.area).sum();
        fibres.iter_mut().for_each(|fibre| fibre.area *= section.area / whole);
        Ok(fibres)
    }

    fn outline(&self, nu: f64, section: &Section) -> Option<Outline> {
        self.sharp.outline(nu, section)
    }

    fn half_depth(&self) -> f64 {
        self.sharp.half_depth()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sections::tests::close;

    /// A square less its four rounded corners is a circle.
    #[test]
    fn four_corners_leave_a_circle() {
        let r = 0.7_f64;
        let mut section = Section {
            area: 4.0 * r * r,
            Iy: 4.0 / 3.0 * r.powi(4),
            Iz: 4.0 / 3.0 * r.powi(4),
            Iyz: 0.0,
            torsion: 0.0,
            shear: [0.0; 3],
            shear_center: [0.0; 2],
        };
        let corner = Corner::new(r);
        corner.add(-1.0, [r - corner.arm; 2], &mut section);
        close(section.area, PI * r * r, 1e-14);
        close(section.Iy, 0.25 * PI * r.powi(4), 1e-13);
        close(section.Iz, 0.25 * PI * r.powi(4), 1e-13);
    }

    /// EN 10210-2 lists for SHS 100 x 5 18.7 cm², 279 cm⁴ and I_t = 439 cm⁴, for RHS 200 x 100 x 8 44.8 cm², 2234 cm⁴, 739 cm⁴ and 1804 cm⁴, in
    /// three or four digits; fibres have the area.
    #[test]
    fn hollow_sections_of_the_standard() {
        for (height, width, t, known) in
            [(100.0, 100.0, 5.0, [18.7, 279.0, 279.0, 439.0]), (200.0, 100.0, 8.0, [44.8, 2234.0, 739.0, 1804.0])]
        {
            let shape = RoundedBox { sharp: HollowBox { width, height, web: t, flange: t }, radii: [1.5 * t, t] };
            let section = shape.section(0.3).unwrap();
            let found = [section.area / 1e2, section.Iy / 1e4, section.Iz / 1e4, section.torsion / 1e4];
            found.into_iter().zip(known).for_each(|(found, known)| close(found, known, 2.7e-3));
            let fibres = shape.lay_fibres([8, 2], &section).unwrap();
            close(fibres.iter().map(|fibre| fibre.area).sum(), section.area, 1e-14);
        }
    }

    /// EN 10056-1, L 100 x 100 x 10: 19.2 cm², 177 cm⁴, principal moments 280 and 73.0 cm⁴, centroid at 2.82 cm.
    #[test]
    fn equal_angle_of_the_standard() {
        let legs = L { height: 100.0, width: 100.0, vertical: 10.0, horizontal: 10.0 };
        let shape = RolledL { legs, root_radius: 12.0 };
        let section = shape.section(0.3).unwrap();
        let principal = [section.Iy - section.Iyz, section.Iy + section.Iyz];
        let found = [section.area / 1e2, section.Iy / 1e4, section.Iz / 1e4, principal[0] / 1e4, principal[1] / 1e4];
        found.into_iter().zip([19.2, 177.0, 177.0, 280.0, 73.0]).for_each(|(found, known)| close(found, known, 2.5e-3));
        let [sharp, shift] = shape.centroids();
        close(sharp[0] + shift[0], 28.2, 2e-3);
        // The shear centre stays at the corner of the middle lines.
        close(section.shear_center[0], 5.0 - sharp[0] - shift[0], 1e-12);
    }

    /// I_t of IPE 200, HE 300 B and HE 200 A in the tables of rolling mills: 6.98, 185 and 20.98 cm⁴.
    #[test]
    fn torsion_of_rolled_sections() {
        for ([height, width, web, flange, root_radius], known) in [
            ([200.0, 100.0, 5.6, 8.5, 12.0], 6.98),
            ([300.0, 300.0, 11.0, 19.0, 27.0], 185.0),
            ([190.0, 200.0, 6.5, 10.0, 18.0], 20.98),
        ] {
            let plates =
                I { height, top_width: width, bottom_width: width, web, top_flange: flange, bottom_flange: flange };
            let shape = RolledI { plates, root_radius };
            let section = shape.section(0.3).unwrap();
            close(section.torsion / 1e4, known, 1e-3);
            let fibres = shape.lay_fibres([8, 4], &section).unwrap();
            close(fibres.iter().map(|fibre| fibre.area).sum(), section.area, 1e-13);
            let second: f64 = fibres.iter().map(|fibre| fibre.area * fibre.z * fibre.z).sum();
            // Fibres lack their own moments, of which those of the roots are the larger part.
            close(second, section.Iy, 3e-3);
        }
        let plates =
            I { height: 200.0, top_width: 100.0, bottom_width: 90.0, web: 5.6, top_flange: 8.5, bottom_flange: 8.5 };
        assert!(RolledI { plates, root_radius: 12.0 }.section(0.3).unwrap_err().contains("equal flanges"));
    }
}
