//! `[sections.x]`: one flat table for all shapes; which keys a shape takes is checked when the model is built.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::{Maybe, Numbers, OneOrMany, Vector};

/// The cross section of a beam, in its local axes: width along y, height along z.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Section {
    #[schemars(required)]
    pub shape: Maybe<Shape>,
    /// Length along local y: rectangle, box, c, l, i.
    pub width: Maybe<f64>,
    /// Length along local z: rectangle, box, i, c, l.
    pub height: Maybe<f64>,
    /// Outer radius: tube.
    pub radius: Maybe<f64>,
    /// Outer diameter, instead of the radius: tube.
    pub diameter: Maybe<f64>,
    /// Wall of a tube (equal to the radius: solid), of a box (one value, or the walls normal to y and those normal to z),
    /// of an l (one value, or the upright leg and the flat leg).
    pub thickness: Maybe<OneOrMany<f64>>,
    /// Width of the upper flange, if the flanges differ: i.
    pub top_width: Maybe<f64>,
    /// Width of the lower flange, if the flanges differ: i.
    pub bottom_width: Maybe<f64>,
    /// i, c.
    pub web_thickness: Maybe<f64>,
    /// Both flanges: i, c.
    pub flange_thickness: Maybe<f64>,
    /// Upper flange, if the flanges differ: i.
    pub top_flange_thickness: Maybe<f64>,
    /// Lower flange, if the flanges differ: i.
    pub bottom_flange_thickness: Maybe<f64>,
    /// Fibres where the material yields, one or two numbers: rectangle [along y, along z], tube [around, through the wall],
    /// box, i, c, l [along each wall, through it].
    pub fibres: Maybe<OneOrMany<u64>>,
    /// general.
    pub area: Maybe<f64>,
    /// Second moments of area [about y, about z]: general.
    pub moments: Maybe<Numbers<2>>,
    /// Product moment of area, default 0: general.
    pub product_moment: Maybe<f64>,
    /// Torsion constant: general.
    pub torsion_constant: Maybe<f64>,
    /// Shear areas [for forces along y, along z]: general.
    pub shear_areas: Maybe<Numbers<2>>,
    /// E A, force: general, instead of area and moments.
    pub axial_stiffness: Maybe<f64>,
    /// [along y, along z], force: general.
    pub shear_stiffness: Maybe<Numbers<2>>,
    /// Force times length squared: general.
    pub torsional_stiffness: Maybe<f64>,
    /// [about y, about z], force times length squared: general.
    pub bending_stiffness: Maybe<Numbers<2>>,
    /// General, with the stiffnesses.
    pub mass_per_length: Maybe<f64>,
    /// Rotary inertia [about x, y, z], mass times length: general, with the stiffnesses.
    pub inertia_per_length: Maybe<Vector>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Shape {
    Rectangle,
    Tube,
    Box,
    I,
    C,
    L,
    /// Areas and moments, or stiffnesses and masses per length themselves.
    General,
}
