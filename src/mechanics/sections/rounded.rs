//! Rounded corners of rolled and hollow sections.

use super::section::Section;
use std::f64::consts::PI;

/// The area between a square corner and the quarter circle that touches its sides.
#[derive(Debug, Clone, Copy)]
pub(super) struct Corner {
    /// The area.
    pub area: f64,
    /// Distance of its centroid from both sides.
    pub arm: f64,
    /// Second moment about its centroid, parallel to a side.
    pub moment: f64,
    /// Product moment about its centroid, of a corner that opens towards y and z alike.
    pub product: f64,
}

impl Corner {
    /// The corner of a circle of this radius.
    pub fn new(radius: f64) -> Corner {
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
    pub fn add(&self, sign: f64, [y, z]: [f64; 2], section: &mut Section) {
        section.area += 4.0 * sign * self.area;
        section.Iy += 4.0 * sign * (self.moment + self.area * z * z);
        section.Iz += 4.0 * sign * (self.moment + self.area * y * y);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sections::SectionShape;
    use crate::sections::hollow_box::{HollowBox, RoundedBox};
    use crate::sections::i::{I, RolledI};
    use crate::sections::l::{L, RolledL};
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
