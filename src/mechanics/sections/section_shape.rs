//! The registry entry of a section shape, and the trait of all shapes.

use super::fibres::{Fibre, calibrated};
use super::section::{Section, Stiffness};
use super::stresses::{SectionOutline, SectionStresses};
use base::names::short;
use base::words::kinds::{Form, Given, Key, Kind, Values};
use std::fmt;

/// A shape that the deck can name.
pub type SectionKind = Kind<MakeSection>;

/// The readers of the keys of a section.
#[derive(Debug)]
pub struct MakeSection {
    /// Reads the keys; the flag is true where a beam needs the section's mass. Returns `None` where a key is wrong.
    pub read: fn(&mut Given, bool) -> Option<CrossSection>,
    /// True where a beam of a section with these keys has a material.
    pub takes_material: fn(&Values) -> bool,
}

/// The section that a table `[sections.x]` describes.
pub enum CrossSection {
    /// A shape; stiffness and mass follow from it and a material.
    Shape(Box<dyn SectionShape>),
    /// Stiffnesses and masses per length, as given.
    Stiffness(Box<Stiffness>),
    /// Polygons, which stand in a list of their own.
    Polygons {
        /// Place (y, z) of the beam's axis; `None` for the centroid.
        axis: Option<[f64; 2]>,
        /// Longest edge of a triangle; `None` for that by the shape.
        mesh_size: Option<f64>,
    },
}

/// The shape of a section: from it follow the section as a whole and its fibres.
pub trait SectionShape: fmt::Debug {
    /// Areas and moments; shear areas of full shapes depend on Poisson's ratio. Errors: dimensions that do not go together.
    fn section(&self, nu: f64) -> Result<Section, String>;

    /// The default numbers of fibres; `first` is given where the deck gives only the first number.
    fn default_fibres(&self, first: Option<usize>) -> Result<[usize; 2], String>;

    /// Fibres whose shear modes are not yet scaled to the section.
    fn lay_fibres(&self, counts: [usize; 2], section: &Section) -> Result<Vec<Fibre>, String>;

    /// The points of `section`, which is that of the shape, at which stresses may be extreme; `None` of a section that does not say where its
    /// area is.
    fn outline(&self, nu: f64, section: &Section) -> Option<SectionOutline>;

    /// What stresses of `section`, which is that of the shape, follow from; `None` as for [`SectionShape::outline`].
    fn stresses(&self, nu: f64, section: &Section) -> Option<SectionStresses> {
        Some(SectionStresses::new(section, self.outline(nu, section)?))
    }

    /// The distance of a place (y, z) within the shape from its surface, below 0 outside; `None` of shapes that hold no bars.
    fn depth(&self, _at: [f64; 2]) -> Option<f64> {
        None
    }

    /// Fibres of a cover of this thickness and of the core within it, without modes for shear. `None` if the shape takes no core, or the
    /// cover fills it.
    fn cover_and_core(&self, _cover: f64, _counts: [usize; 2]) -> Option<[Vec<Fibre>; 2]> {
        None
    }

    /// Half its smaller side, or its radius: the contact radius of a beam.
    fn half_depth(&self) -> f64;

    /// The fibres of `section`, the section of this shape. `counts`, even numbers, may be left out: `[]`, `[first]` or `[first, second]`.
    ///
    /// | Shape | first | second | default | worst error in M(κ) |
    /// |---|---|---|---|---|
    /// | rectangle | along y (and z, if alone) | along z | 12, 12 | 0.47 % |
    /// | tube | around | through the wall | 20, 2; from t = R/2 on 4 | 0.8 % |
    /// | box | along the longest wall | through each | 8, 2 | 1.1 % |
    /// | i, l | " | " | 8, 4 | 1.2 % |
    /// | c | " | " | 12, 4 | 0.8 % |
    ///
    /// Errors are for an ideally plastic material up to 20 times the curvature of first yield, about y, z and an axis between, relative to
    /// the greatest moment. Open walls need four through the thickness for their plastic torque: two give 15 % more.
    ///
    /// Errors: counts that are odd or too few; a general section.
    fn fibres(&self, counts: &[usize], section: &Section) -> Result<Vec<Fibre>, String> {
        let fibres = self.lay_fibres(self.counts(counts)?, section)?;
        calibrated(fibres, section).ok_or_else(|| "these fibres cannot carry shear and torsion; take more".into())
    }

    /// The numbers of fibres along both directions; see [`SectionShape::fibres`].
    fn counts(&self, counts: &[usize]) -> Result<[usize; 2], String> {
        let default = self.default_fibres(counts.first().copied())?;
        let counts = match *counts {
            [] => default,
            [first] => [first, default[1]],
            [first, second] => [first, second],
            _ => {
                return Err(format!(
                    "{} numbers of fibres are given, but a section can have two at most",
                    counts.len()
                ));
            }
        };
        if let Some(n) = counts.iter().find(|&&n| n == 0 || n % 2 == 1) {
            return Err(format!("the number of fibres is {n}, but must be even, as they lie in pairs"));
        }
        Ok(counts)
    }
}

/// The key with which shapes take another shear area than their own.
pub const SHEAR_FACTOR: Key = Key {
    name: "shear_factor",
    form: Form::Numbers,
    about: "Shear area over area, above 0, at most 1: one number, or [for forces along y, along z]. Default: that of the elastic shear stress.",
};

/// Reads `shear_factor`: of the forces along y and along z, where it is written.
pub fn shear_factor(given: &mut Given) -> Option<[f64; 2]> {
    let key = SHEAR_FACTOR.name;
    let factors = match *given.numbers(key) {
        [] if !given.has(key) => return None,
        [both] => [both; 2],
        [y, z] => [y, z],
        ref other => {
            let message = format!("`{key}` has {} values here; give one, or two for y and z", other.len());
            return given.error(key, message);
        }
    };
    if factors.iter().any(|&factor| factor <= 0.0) {
        return given.error_with(key, format!("`{key}` must be above zero"), "5/6, 0.8333, is common for rectangles");
    }
    if let Some(&large) = factors.iter().find(|&&factor| factor > 1.0) {
        let message = format!("`{key}` is {}, but no shear area is larger than the area", short(large));
        return given.error_with(
            key,
            message,
            format!("it is the inverse of the flexibility: take {}", short(1.0 / large)),
        );
    }
    Some(factors)
}

/// Reports a `thickness` with more values than walls, or with a value that is not above zero.
pub fn check_walls(given: &mut Given, most: usize) -> Option<()> {
    let walls = given.numbers("thickness");
    if given.has("thickness") && !(1..=most).contains(&walls.len()) {
        return given.error("thickness", format!("`thickness` has {} values here; it takes {most}", walls.len()));
    }
    if walls.iter().any(|&wall| wall <= 0.0) {
        return given.error("thickness", "`thickness` must be above zero");
    }
    Some(())
}

/// One value for both flanges, or one for each.
pub fn pair(given: &mut Given, [both, top, bottom]: [&str; 3]) -> Option<[f64; 2]> {
    if given.has(both) {
        for key in [top, bottom] {
            if given.has(key) {
                given.error::<()>(key, format!("`{key}` does not apply to a section with `{both}`"));
            }
        }
        return given.positive(both).map(|value| [value, value]);
    }
    if !given.has(top) && !given.has(bottom) {
        given.require(both)?;
    }
    let (top, bottom) = (given.require_positive(top), given.require_positive(bottom));
    Some([top?, bottom?])
}
