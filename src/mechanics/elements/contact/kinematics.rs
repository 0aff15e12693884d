//! The position and motion of points relative to a surface.

use super::history::{PairMemory, of_points, width};
use super::law::ContactLaw;
use super::nearest_corner::NearestCorner;
use super::point::{ContactPoint, MOST_NODES};
use super::surface::Surface;
use super::surfaces::kind::ClosestPoint;
use crate::state::Node;
use base::math::rotation::{log, renormalise};
use base::math::{Mat3, Vec3};
use nalgebra::Quaternion;
use std::sync::Arc;

/// Points with equally many nodes against one surface.
pub struct Contacts {
    /// The contact law.
    pub(super) law: ContactLaw,
    /// The surface, in the frame of the node that carries it.
    pub(super) surface: Surface,
    /// The node that carries the surface.
    pub(super) carrier: usize,
    /// The points.
    pub(super) points: Vec<ContactPoint>,
    /// Nodes of each point, then the carrier.
    pub(super) nodes: Vec<[usize; MOST_NODES + 1]>,
    /// Nodes that carry a point.
    pub(super) count: usize,
    /// Friction turns nodes: their rotations belong to the history.
    pub(super) rolls: bool,
    /// The corners of the carrier that touch the faces of the points' nodes.
    pub(super) corners: Option<Arc<dyn NearestCorner>>,
}

/// A point against the surface at an instant.
pub(super) struct ContactKinematics {
    /// Rotation of the carrier.
    pub R: Mat3,
    /// x − x_s, global components.
    pub d: Vec3,
    /// R ṗ: the velocity relative to the surface, global components.
    pub w: Vec3,
    /// The point in the frame of the carrier.
    pub p: Vec3,
    /// The closest point of the surface.
    pub closest: ClosestPoint,
    /// Distance of the ball around the point from the surface, negative inside.
    pub gap: f64,
}

impl ContactKinematics {
    /// Approach speed δ̇.
    pub fn rate(&self) -> f64 {
        -(self.R * self.closest.n).dot(&self.w)
    }
}

impl Contacts {
    /// `points` have equally many nodes, one or more.
    pub fn new(law: ContactLaw, surface: Surface, carrier: usize, points: Vec<ContactPoint>) -> Self {
        let count = points.first().map_or(1, |point| point.count);
        let rolls = law.friction > 0.0 && points.iter().any(|point| point.rolling_radius > 0.0);
        let nodes = points
            .iter()
            .map(|point| {
                let mut nodes = [carrier; MOST_NODES + 1];
                nodes[..count].copy_from_slice(point.nodes());
                nodes
            })
            .collect();
        Contacts { law, surface, carrier, points, nodes, count, rolls, corners: None }
    }

    /// Makes the points press only where they are deeper in the carrier than its corners are in the faces of these points.
    pub fn beside(self, corners: Arc<dyn NearestCorner>) -> Self {
        Contacts { corners: Some(corners), ..self }
    }

    /// Number of history variables of a point.
    pub(super) fn width(&self) -> usize {
        width(&self.law, of_points(if self.rolls { self.count } else { 0 }))
    }

    /// The memory of point `e` in the history of the block, which must not be empty.
    #[inline]
    pub(super) fn memory<'a>(&self, e: usize, history: &'a [f64]) -> PairMemory<'a> {
        let width = self.width();
        PairMemory(&history[e * width..(e + 1) * width])
    }

    /// Position and velocity relative to the carrier, global components.
    #[inline]
    pub(super) fn relative(&self, point: &ContactPoint, nodes: &[Node]) -> (Vec3, Vec3) {
        let carrier = &nodes[self.carrier];
        let (mut d, mut v) = (Vec3::zeros(), Vec3::zeros());
        for (node, weight) in point.parts() {
            d += weight * nodes[node].relative_position(carrier);
            v += weight * nodes[node].v;
        }
        (d, v - carrier.v - carrier.omega.cross(&d))
    }

    /// The gap of a point, its place, and the rates of closing and sliding.
    #[inline]
    pub(super) fn kinematics(&self, point: &ContactPoint, nodes: &[Node]) -> ContactKinematics {
        let (d, w) = self.relative(point, nodes);
        let R = nodes[self.carrier].R();
        let p = R.tr_mul(&d);
        let closest = self.surface.closest_point(&p);
        ContactKinematics { R, d, w, p, gap: closest.distance - point.radius, closest }
    }

    /// Rotation of a node relative to the surface.
    pub(super) fn relative_rotation(&self, node: usize, nodes: &[Node]) -> Quaternion<f64> {
        nodes[self.carrier].rotation.conjugate() * nodes[node].rotation
    }

    /// Rotation vector of the k-th node of a point relative to the surface, from the remembered rotation to the present one.
    pub(super) fn rotation_since(&self, point: &ContactPoint, k: usize, old: PairMemory, nodes: &[Node]) -> Vec3 {
        log(&renormalise(&(self.relative_rotation(point.nodes[k], nodes) * old.rotation(k).conjugate())))
    }

    /// A lower bound of the distance from the surface to a place at `d` from the carrier; exact for planes.
    pub(super) fn least_distance(&self, d: &Vec3, nodes: &[Node]) -> f64 {
        let reach = self.reach();
        if reach.is_finite() { d.norm() - reach } else { self.surface.distance(&nodes[self.carrier].R().tr_mul(d)) }
    }

    /// A distance from the carrier beyond which nothing touches.
    pub(super) fn reach(&self) -> f64 {
        self.surface.center.norm() + self.surface.reach()
    }
}
