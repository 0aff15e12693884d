//! Contacts in the equation of motion: their blocks.

use super::assembled::{Assembled, NumberedPairs, Setting, pieces};
use crate::system::plane::MotionPlane;
use crate::tolerances::plane::SMALL;
use mechanics::elements::contact::{
    ContactLaw, ContactPoint, Contacts, ConvexHeap, ConvexPairs, FacetContacts, MOST_NODES, SurfaceShape, TouchKind,
};
use mechanics::sections::Stiffness;
use model::{CarriedSurface, Contact, FacetSurface, TouchedSurface};
use std::sync::Arc;

impl Assembled for Contact {
    /// The blocks of points with equally many nodes, with the number of the first point among those; none for a clearance
    /// monitor.
    fn pairs(&self, setting: &Setting) -> Vec<NumberedPairs> {
        let Some(law) = self.law else { return Vec::new() };
        let carried = match &self.surface {
            TouchedSurface::Shape(carried) => carried,
            TouchedSurface::Facets(faces) => {
                let mut blocks = facet_blocks(law, faces, &self.points, setting);
                if !self.convex.is_empty() {
                    blocks.push((
                        Box::new(ConvexHeap::new(law, self.convex.clone(), self.joined.clone())),
                        self.points.len(),
                    ));
                }
                return blocks;
            }
        };
        let mut blocks: Vec<NumberedPairs> = Vec::new();
        for count in 1..=MOST_NODES {
            let points: Vec<ContactPoint> = self.points.iter().filter(|point| point.count == count).cloned().collect();
            for piece in pieces(points.len()) {
                let block = Contacts::new(law, carried.surface.clone(), carried.node, points[piece.clone()].to_vec());
                blocks.push((Box::new(block), piece.start));
            }
        }
        for piece in pieces(self.convex.len()) {
            let convex = self.convex[piece.clone()].to_vec();
            let pairs = ConvexPairs::new(law, &carried.surface, carried.node, convex);
            blocks.extend(pairs.map(|pairs| (Box::new(pairs) as _, self.points.len() + piece.start)));
        }
        blocks
    }

    fn stays_in(&self, plane: &MotionPlane, _: &[Stiffness]) -> bool {
        let TouchedSurface::Shape(CarriedSurface { surface, .. }) = &self.surface else { return false };
        let center = surface.center[plane.normal].abs();
        // Two solids that are symmetric about the plane push each other along it.
        if self.convex.iter().any(|one| !one.shape.is_symmetric(plane.normal)) {
            return false;
        }
        let has_points = !self.points.is_empty() || self.convex.is_empty();
        let is_symmetric = match surface.shape {
            SurfaceShape::Hull(_) => false,
            SurfaceShape::Plane(_) => surface.keeps(plane.normal),
            _ => surface.axes.row(plane.normal).iter().any(|x| x.abs() > 1.0 - 1e-12),
        };
        center <= SMALL * plane.size
            && (!has_points || surface.keeps(plane.normal))
            && (self.convex.is_empty() || is_symmetric)
    }
}

/// The blocks of points with equally many nodes against facets. Each block searches its neighbours itself, so the blocks are not divided.
/// Nodes of the facets against boxes and hulls come after them.
fn facet_blocks(
    law: ContactLaw,
    faces: &FacetSurface,
    points: &[ContactPoint],
    setting: &Setting,
) -> Vec<NumberedPairs> {
    let mut blocks: Vec<NumberedPairs> = Vec::new();
    let of_points = (1..=MOST_NODES).map(|count| (count, TouchKind::Point));
    for (count, extent) in of_points.chain([(2, TouchKind::Line), (2, TouchKind::Edge)]) {
        let is_alike = |point: &&ContactPoint| point.count == count && point.extent == extent;
        let points: Vec<ContactPoint> = points.iter().filter(is_alike).cloned().collect();
        if !points.is_empty() {
            let block = FacetContacts::new(law, faces.touchers, points, faces.facets.clone(), setting.x);
            blocks.push((Box::new(block), 0));
        }
    }
    for (k, carried) in faces.solids.iter().enumerate() {
        let corners = faces.corners.get(k).filter(|corners| !corners.is_empty()).map(|corners| {
            let corners = corners.iter().map(|&e| points[e].clone()).collect();
            Arc::new(FacetContacts::new(law, faces.touchers, corners, faces.facets.clone(), setting.x))
        });
        for piece in pieces(faces.back.len()) {
            let points = faces.back[piece.clone()].to_vec();
            let block = Contacts::new(law, carried.surface.clone(), carried.node, points);
            let block = match &corners {
                Some(corners) => block.beside(corners.clone()),
                None => block,
            };
            blocks.push((Box::new(block), piece.start));
        }
    }
    blocks
}
