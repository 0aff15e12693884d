//! Curved shells: triangles of six nodes and quadrilaterals of nine, with sides of second degree.
//!
//! Strains have the form of [`super`]: products of second degree in positions and directors, of slopes along the coordinates (r, s): ½
//! x,r·x,r, x,r·d,r, x,r·d and so on. Taken point by point they lock thin curved shells, since a surface of second degree that bends
//! without stretching stretches between its nodes. Membrane and bending strains and transverse shear are therefore sampled at the points
//! without this stretch and interpolated along the same coordinates. This is mixed interpolation of tensorial components, for the
//! quadrilateral by Bucalem & Bathe (Int. J. Numer. Methods Engrg 36, 1993), for the triangle by Lee & Bathe (Comput. Struct. 82, 2004).
//! The strains at these points are the numbers that describe the element: the factors between them and the strain at an integration point
//! are constant.
//!
//! The quadrilateral interpolates only the difference from the mean strain; the mean follows from the displacements. Constant strains are
//! thus exact in elements of any shape, with nodes anywhere on the sides.
//!
//! Drilling of each node is measured against the rotation of the surface there, and resisted little. Directors are interpolated to
//! second degree, so bending needs no correction for chords.

mod block;
mod bubble;
mod geometry;
mod heated;
mod kinematics;
mod quadrilateral;
mod sampling;
mod surface;
mod tangent;
mod triangle;

pub use kinematics::{CurvedQuadrilaterals, CurvedShells, CurvedTriangles};
