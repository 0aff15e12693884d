//! Thin-walled shapes as walls and plates: the walls' middle lines carry the shear flow, the plates are the area.

use super::fibres::{Fibre, pairs};
use super::wall::{Wall, flow_at, shear};
use super::{Section, rectangles};
use nalgebra::Vector2;

/// Straight walls, each with the rectangle it fills; the rectangles lie side by side.
pub struct Profile {
    /// Ends of the middle lines.
    pub points: Vec<[f64; 2]>,
    pub walls: Vec<Wall>,
    /// Of each wall: (y, z) of the rectangle's centre, its width, its height.
    pub plates: Vec<([f64; 2], f64, f64)>,
    /// The walls close one cell; otherwise they form a tree.
    pub cell: bool,
    /// Saint-Venant torsion constant.
    pub torsion: f64,
}

impl Profile {
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
                    // Where the plate is longer than the middle line, in a corner, the flow is that of the line's end.
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
}
