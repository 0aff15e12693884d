//! A body that rigid parts make up is drawn as their elements are, and touches with their nodes.

use super::kind::{SolidShape, Touching};
use super::outline::{Outline, OutlineCell};
use base::math::Vec3;

/// Faces of three or four corners, lines of two, as indices into points about the centre of mass.
#[derive(Debug, Clone, Default)]
pub struct ElementFaces {
    /// Corners, in body axes.
    pub points: Vec<Vec3>,
    /// The corners of each face.
    pub faces: Vec<Vec<usize>>,
}

impl SolidShape for ElementFaces {
    fn outline(&self) -> Outline {
        let cells = self.faces.iter().cloned().map(OutlineCell::Face).collect();
        Outline { points: self.points.clone(), cells }
    }

    fn touching(&self, _: usize) -> Touching {
        Touching::Nodes
    }
}
