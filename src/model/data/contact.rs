//! Contacts: points against a surface.

use super::part_answers::PartAnswers;
use base::quantities::{CONTACT, CONTACT_FORCE, Column};
use mechanics::elements::contact::{ContactLaw, ContactPoint, ConvexBody, Facet, FacetTouchers, Surface, Toucher};
use std::collections::BTreeSet;

/// Points against a surface.
#[derive(Debug, Clone)]
pub struct Contact {
    /// The deck's name.
    pub name: String,
    /// The surface that is touched.
    pub surface: TouchedSurface,
    /// The points.
    pub points: Vec<ContactPoint>,
    /// Boxes, hulls, cylinders and capsules that touch the convex surface or each other with their full shape.
    pub convex: Vec<ConvexBody>,
    /// The pairs of these, by number in ascending order, that do not touch each other: a joint holds them together.
    pub joined: Vec<[usize; 2]>,
    /// The shapes of the touching bodies; `check` lists the parts ignored in contact.
    pub touchers: BTreeSet<Toucher>,
    /// The contact law; `None` for a clearance monitor, which exerts no force.
    pub law: Option<ContactLaw>,
    /// The smallest dimension of the touching and touched bodies, the scale of depths. For faces and for balls among themselves, the
    /// distance of their middles at touch.
    pub size: f64,
    /// The reason for the stiffness, if the program has chosen it.
    pub chosen: Option<String>,
}

/// The touched surface.
#[derive(Debug, Clone)]
pub enum TouchedSurface {
    /// A shape.
    Shape(CarriedSurface),
    /// Faces of a shell, or balls among themselves.
    Facets(FacetSurface),
}

/// A shape and the node that carries it: a body's, or a restrained one for the ground.
#[derive(Debug, Clone)]
pub struct CarriedSurface {
    /// The node.
    pub node: usize,
    /// The surface, in the frame of that node.
    pub surface: Surface,
}

/// A surface of facets.
#[derive(Debug, Clone)]
pub struct FacetSurface {
    /// The deck's name of the part; empty for balls among themselves.
    pub part: String,
    /// The facets.
    pub facets: Vec<Facet>,
    /// True where these are the free edges of a shell in place of its faces.
    pub is_of_edges: bool,
    /// The bodies that touch the facets.
    pub touchers: FacetTouchers,
    /// The boxes, hulls, cylinders and capsules whose surface the nodes of the facets touch.
    pub solids: Vec<CarriedSurface>,
    /// For each of these, the numbers of the points at its corners.
    pub corners: Vec<Vec<usize>>,
    /// The nodes of the facets, where there are such bodies.
    pub back: Vec<ContactPoint>,
}

impl FacetSurface {
    /// True for contact between two sides, with a resultant of forces; false for self-contact and for bodies among themselves.
    pub fn has_sides(&self) -> bool {
        matches!(self.touchers, FacetTouchers::Others)
    }
}

impl Contact {
    /// True for faces of a shell, and for balls among themselves.
    pub fn has_facets(&self) -> bool {
        matches!(self.surface, TouchedSurface::Facets(_))
    }

    /// True where multipliers keep things apart.
    pub fn has_multipliers(&self) -> bool {
        self.law.is_some_and(|law| law.tolerance.is_some())
    }

    /// A node of the surface with each node of the points, one pair after the other.
    pub fn pairs(&self) -> impl Iterator<Item = [usize; 2]> {
        let node = match &self.surface {
            TouchedSurface::Shape(carried) => carried.node,
            TouchedSurface::Facets(faces) => faces.facets.first().map_or(0, |facet| facet.nodes[0]),
        };
        self.points.iter().flat_map(|point| point.nodes()).map(move |&other| [node, other])
    }
}

impl Contact {
    /// The quantities for `[[expect]]`.
    pub(super) const QUANTITIES: &'static [&'static [Column]] = &[&CONTACT, &[CONTACT_FORCE]];
}

impl PartAnswers for Contact {
    fn has_damped_stiffness(&self) -> bool {
        false
    }

    fn name(&self) -> &str {
        &self.name
    }

    fn elements(&self) -> usize {
        self.points.len() + self.convex.len()
    }

    fn nodes(&self, element: usize) -> &[usize] {
        match element.checked_sub(self.points.len()) {
            Some(of_convex) => std::slice::from_ref(&self.convex[of_convex].node),
            None => self.points[element].nodes(),
        }
    }

    fn visit_nodes(&mut self, visit: &mut dyn FnMut(&mut usize)) {
        match &mut self.surface {
            TouchedSurface::Shape(carried) => visit(&mut carried.node),
            TouchedSurface::Facets(faces) => {
                faces.facets.iter_mut().flat_map(|facet| &mut facet.nodes).for_each(&mut *visit);
                faces.solids.iter_mut().for_each(|carried| visit(&mut carried.node));
                faces.back.iter_mut().for_each(|point| visit(&mut point.nodes[0]));
            }
        }
        self.points.iter_mut().flat_map(|point| &mut point.nodes[..point.count]).for_each(&mut *visit);
        self.convex.iter_mut().for_each(|one| visit(&mut one.node));
    }

    fn touched_nodes(&self) -> Vec<usize> {
        match &self.surface {
            TouchedSurface::Shape(carried) => vec![carried.node],
            TouchedSurface::Facets(faces) => {
                let of_facets = faces.facets.iter().flat_map(|facet| facet.nodes);
                of_facets.chain(faces.solids.iter().map(|carried| carried.node)).collect()
            }
        }
    }

    fn may_stiffen(&self) -> bool {
        true
    }
}
