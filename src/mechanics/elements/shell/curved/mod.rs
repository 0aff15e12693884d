//! Curved shells: triangles of six nodes and quadrilaterals of nine, with sides of second degree.
//!
//! Strains are those of [`super`], of second degree in positions and directors, by slopes along the coordinates (r, s) of the
//! element: ½ x,r·x,r, x,r·d,r, x,r·d and so on. Taken point by point they lock thin curved shells, since a surface of second
//! degree that bends without stretching stretches between its nodes. Membrane and bending strains and transverse shear are
//! therefore taken where that stretch is none, and interpolated between these points along the same coordinates: mixed
//! interpolation of tensorial components, for the quadrilateral by Bucalem & Bathe (Int. J. Numer. Methods Engrg 36, 1993), for the
//! triangle by Lee & Bathe (Comput. Struct. 82, 2004). The strains at these points are the numbers that describe the element: the
//! factors between them and the strain at an integration point are constant.
//!
//! What is interpolated of the quadrilateral is the difference to the mean strain, and the mean is that of the displacements: so
//! even strains are exact in elements of any shape, wherever the nodes stand on the sides.
//!
//! Drilling of each node is measured against the rotation of the surface there, and resisted little. Directors are interpolated to
//! second degree, so bending needs no correction for chords.

mod block;
mod bubble;
mod geometry;
mod kinematics;
mod quadrilateral;
mod sampling;
mod surface;
mod tangent;
mod triangle;

pub use kinematics::{CurvedQuadrilaterals, CurvedShells, CurvedTriangles};
