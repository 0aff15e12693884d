//! A shape, from which follow the section as a whole and its fibres.

use super::fibres::{Fibre, calibrated};
use super::{Section, closed, open, solid};

/// Lengths as the constructors of [`Section`] take them.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    Rectangle { width: f64, height: f64 },
    Tube { radius: f64, thickness: f64 },
    Box { width: f64, height: f64, web: f64, flange: f64 },
    I { height: f64, top_width: f64, bottom_width: f64, web: f64, top_flange: f64, bottom_flange: f64 },
    C { height: f64, width: f64, web: f64, flange: f64 },
    L { height: f64, width: f64, vertical: f64, horizontal: f64 },
    General { area: f64, moments: [f64; 2], Iyz: f64, torsion: f64, shear_areas: [f64; 2] },
}

impl Shape {
    pub fn section(&self) -> Result<Section, String> {
        match *self {
            Shape::Rectangle { width, height } => Section::rectangle(width, height),
            Shape::Tube { radius, thickness } => Section::tube(radius, thickness),
            Shape::Box { width, height, web, flange } => Section::box_(width, height, web, flange),
            Shape::I { height, top_width, bottom_width, web, top_flange, bottom_flange } => {
                Section::i(height, top_width, bottom_width, web, top_flange, bottom_flange)
            }
            Shape::C { height, width, web, flange } => Section::c(height, width, web, flange),
            Shape::L { height, width, vertical, horizontal } => Section::l(height, width, vertical, horizontal),
            Shape::General { area, moments, Iyz, torsion, shear_areas } => {
                Section::general(area, moments, Iyz, torsion, shear_areas)
            }
        }
    }

    /// The section's fibres. `counts`, even numbers, may be left out: `[]`, `[first]` or `[first, second]`.
    ///
    /// | Shape | first | second | default | worst error in M(κ) |
    /// |---|---|---|---|---|
    /// | rectangle | along y (and z, if alone) | along z | 12, 12 | 0.6 % |
    /// | tube | around | through the wall | 20, 2; from t = R/2 on 4 | 0.8 % |
    /// | box | along the longest wall | through each | 8, 2 | 1.1 % |
    /// | i, l | " | " | 8, 4 | 1.2 % |
    /// | c | " | " | 12, 4 | 0.8 % |
    ///
    /// Errors are for an ideally plastic material up to 20 times the curvature of first yield, about y, z and an axis between,
    /// in units of the greatest moment. Open walls need four through the thickness for their plastic torque: two give 15 % more.
    ///
    /// Errors: as `section`; counts that are odd or too few; a general section.
    pub fn fibres(&self, counts: &[usize]) -> Result<Vec<Fibre>, String> {
        let section = self.section()?;
        let default = match *self {
            Shape::Rectangle { .. } => counts.first().map_or([12; 2], |&n| [n; 2]),
            Shape::Tube { radius, thickness } => [20, if thickness < 0.5 * radius { 2 } else { 4 }],
            Shape::Box { .. } => [8, 2],
            Shape::I { .. } | Shape::L { .. } => [8, 4],
            Shape::C { .. } => [12, 4],
            Shape::General { .. } => {
                return Err("a general section has no fibres: it says how much area there is, not where".into());
            }
        };
        let counts = match *counts {
            [] => default,
            [first] => [first, default[1]],
            [first, second] => [first, second],
            _ => return Err(format!("{} numbers of fibres are given, but a section takes two at most", counts.len())),
        };
        if let Some(n) = counts.iter().find(|&&n| n == 0 || n % 2 == 1) {
            return Err(format!("the number of fibres is {n}, but must be even, as they lie in pairs"));
        }
        let fibres = match *self {
            Shape::Rectangle { width, height } => solid::rectangle_fibres(width, height, counts),
            Shape::Tube { radius, thickness } => {
                if counts[0] < 4 {
                    return Err("a tube needs at least 4 fibres around".into());
                }
                solid::tube_fibres(radius, radius - thickness, section.shear[0], counts)
            }
            Shape::Box { width, height, web, flange } => closed::cell(width, height, web, flange)?.fibres(counts),
            Shape::I { height, top_width, bottom_width, web, top_flange, bottom_flange } => {
                open::i(height, top_width, bottom_width, web, top_flange, bottom_flange)?.fibres(counts)
            }
            Shape::C { height, width, web, flange } => open::c(height, width, web, flange)?.fibres(counts),
            Shape::L { height, width, vertical, horizontal } => {
                open::l(height, width, vertical, horizontal)?.fibres(counts)
            }
            Shape::General { .. } => Vec::new(),
        };
        calibrated(fibres, &section).ok_or_else(|| "these fibres cannot carry shear and torsion; take more".into())
    }
}
