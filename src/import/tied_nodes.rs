//! Constraints on nodes: local axes, equations, couplings that spread forces.

use base::math::{Mat3, Vec3};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// A component of an axis that is zero but for rounding.
const ROUNDING: f64 = 1e-14;

/// Axes at the nodes of a set.
#[derive(Debug, Clone, Copy)]
pub enum NodalAxes {
    /// The same at all nodes: local 1, and a vector in the plane of 1 and 2.
    Rectangular([Vec3; 2]),
    /// Radial, tangential and axial: two points of the axis.
    Cylindrical([Vec3; 2]),
    /// Radial, along the parallel, along the meridian towards the pole: the centre, and a point of the polar axis.
    Spherical([Vec3; 2]),
}

impl NodalAxes {
    /// The axes at a place, as columns; `None` where they have no direction there.
    pub fn at(&self, x: &Vec3) -> Option<Mat3> {
        let columns = |first: Vec3, third: Vec3| {
            let (first, third) = (first.try_normalize(0.0)?, third.try_normalize(0.0)?);
            Some(
                Mat3::from_columns(&[first, third.cross(&first), third])
                    .map(|c| if c.abs() < ROUNDING { 0.0 } else { c }),
            )
        };
        match self {
            NodalAxes::Rectangular([first, plane]) => columns(*first, first.cross(plane)),
            NodalAxes::Cylindrical([a, b]) => {
                let along = (b - a).try_normalize(0.0)?;
                let out = x - a - along * along.dot(&(x - a));
                columns(if out.norm() > ROUNDING * (x - a).norm() { out } else { Vec3::zeros() }, along)
            }
            NodalAxes::Spherical([a, b]) => {
                let out = (x - a).try_normalize(0.0)?;
                let pole = b - a;
                columns(out, pole - out * out.dot(&pole))
            }
        }
    }
}

/// A linear equation of single nodes.
pub struct NodalEquation {
    /// Its line.
    pub line: usize,
    /// Node, degree of freedom along global axes, factor.
    pub terms: Vec<(u64, usize, f64)>,
}

/// Nodes of a distributing coupling.
pub struct DistributedNodes {
    /// The line.
    pub line: usize,
    /// The nodes and their weights, which add up to 1.
    pub weights: BTreeMap<u64, f64>,
    /// The degrees of freedom that it couples.
    pub degrees: [bool; 6],
}

/// The constraints on nodes.
#[derive(Default)]
pub struct TiedNodes {
    /// Sets of shell elements that nodes are tied to, by their names in the deck.
    pub faces: BTreeMap<String, Vec<u64>>,
    /// Beams that pre-tension sections cut.
    pub cuts: Vec<Cut>,
    /// Nodes that bushings join.
    pub bushed: BTreeSet<u64>,
    /// Axes at nodes that have their own, as columns.
    pub axes: HashMap<u64, Mat3>,
    /// Equations that no joint says.
    pub equations: Vec<NodalEquation>,
    /// Nodes of distributing couplings, by their reference node.
    pub distributed: HashMap<u64, DistributedNodes>,
}

/// A cut through a beam.
#[derive(Debug, Clone)]
pub struct Cut {
    /// The line of its section.
    pub line: usize,
    /// The pre-tension node.
    pub node: u64,
    /// The node that stays with the rest, and the new end of the beam.
    pub ends: [u64; 2],
    /// The normal, out of the beam.
    pub axis: Vec3,
    /// 1, or −1 where the normal of the file points into the beam: what tightens then pushes.
    pub sense: f64,
}
