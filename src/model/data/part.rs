//! The parts of a scene that resist: beams, bars, shells, links and contacts. What other rooms ask of any part is answered here,
//! so that one more kind is a variant of [`Part`] and the answers that the compiler then misses.

use super::node::Node;
use crate::deck::beams::MassKind;
use crate::elements::beam;
use crate::elements::contact::{self, ContactPoint, Surface};
use crate::elements::link::LinkLaw;
use crate::elements::shell::{self, Plate};
use crate::materials;
use crate::math::{Mat3, Vec3};
use crate::sections::Stiffness;

/// A part of the scene; [`super::Model::parts`] lists them kind by kind in the order of the variants.
#[derive(Debug, Clone)]
pub enum Part {
    Beam(Beam),
    Bar(Bar),
    Shell(Shell),
    Link(Link),
    Contact(Contact),
}

/// The kinds of parts, in the order in which they are numbered, assembled and written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum PartKind {
    Beam,
    Bar,
    Shell,
    Link,
    Contact,
}

/// A line of nodes, cut into elements with one or more inner nodes.
#[derive(Debug, Clone)]
pub struct Beam {
    pub name: String,
    /// Degree of the interpolation: an element has `order + 1` nodes.
    pub order: usize,
    pub mass: MassKind,
    /// Keep the rotary inertia of the section.
    pub rotary_inertia: bool,
    /// `None`: the material is elastic.
    pub yielding: Option<beam::FibreModel>,
    pub elements: Vec<BeamElement>,
}

#[derive(Debug, Clone)]
pub struct BeamElement {
    /// From one end to the other; the first `order + 1` are used. Inner nodes lie at the Lobatto points of a straight line.
    pub nodes: [usize; 5],
    /// Columns: section axes x (along the beam), y, z in global components at t = 0.
    pub frame: Mat3,
    /// Index into [`super::Model::stiffnesses`].
    pub section: usize,
}

/// A line of nodes, each two of them joined by an element that resists stretching alone.
#[derive(Debug, Clone)]
pub struct Bar {
    pub name: String,
    /// E A, force per unit strain.
    pub axial_stiffness: f64,
    pub mass_per_length: f64,
    pub mass: MassKind,
    pub tension_only: bool,
    /// Length without force over that at t = 0.
    pub free: f64,
    /// `None`: the material is elastic.
    pub yielding: Option<materials::MaterialLaw>,
    pub elements: Vec<[usize; 2]>,
}

/// A surface of triangles or of quadrilaterals. A part of the deck that has both is two shells of the same name, one after the
/// other.
#[derive(Debug, Clone)]
pub struct Shell {
    pub name: String,
    pub plate: Plate,
    pub density: f64,
    pub mass: MassKind,
    /// `None`: the material is elastic.
    pub yielding: Option<shell::LayerModel>,
    /// Axis 1 of results: laid into the surface, element by element.
    pub axis: Vec3,
    /// Corners of each element: 3 or 4.
    pub corners: usize,
    pub elements: Vec<ShellElement>,
    /// The number of each element in the deck's part, which is this shell and its neighbour of the same name. Empty where the
    /// shell is the whole part: they count from 0.
    pub numbers: Vec<u32>,
}

impl Shell {
    /// An element's number in the deck's part.
    pub fn number(&self, element: usize) -> usize {
        self.numbers.get(element).map_or(element, |&number| number as usize)
    }
}

#[derive(Debug, Clone)]
pub struct ShellElement {
    /// Counter-clockwise about the normals; of a triangle the first three are used.
    pub nodes: [usize; 4],
    /// Unit normals of the surface at the nodes, at t = 0.
    pub normals: [Vec3; 4],
}

/// A spring, damper or bushing between two nodes.
#[derive(Debug, Clone)]
pub struct Link {
    pub name: String,
    /// Nodes at `from` and `to`: dependent nodes of a node or body, the node itself, or a restrained node for the ground.
    pub ends: [usize; 2],
    pub kind: LinkKind,
}

#[derive(Debug, Clone)]
pub enum LinkKind {
    /// Force along the line of the ends, or along a fixed global unit vector.
    Line {
        law: LinkLaw,
        damping: f64,
        direction: Option<Vec3>,
        /// Length (along the line) at which the law's elongation is zero; along `direction`: the initial projection
        /// counts as zero elongation unless a free length is given.
        free_length: f64,
    },
    /// Six components in the frame of the first end; `axes` (columns, global at t = 0).
    Bushing { stiffness: [f64; 6], damping: [f64; 6], axes: Mat3 },
}

/// Points against a surface.
#[derive(Debug, Clone)]
pub struct Contact {
    pub name: String,
    /// The node that carries the surface: a body's, or a restrained one for the ground.
    pub node: usize,
    /// In the frame of that node.
    pub surface: Surface,
    pub points: Vec<ContactPoint>,
    /// `None`: a clearance monitor, nothing acts.
    pub law: Option<contact::ContactLaw>,
    /// The deck left the stiffness open.
    pub chosen: bool,
}

/// How an element is drawn.
pub enum Drawing<'p> {
    /// A curve from the first node to the last; `axes` (columns, global at t = 0) are the section's.
    Curve { nodes: &'p [usize], axes: Mat3 },
    /// A face of three or four corners.
    Face { corners: &'p [usize] },
}

impl PartKind {
    /// In the order of [`super::Model::parts`].
    pub const ALL: [PartKind; 5] = [PartKind::Beam, PartKind::Bar, PartKind::Shell, PartKind::Link, PartKind::Contact];

    /// The word for one part, in files and messages.
    pub fn word(self) -> &'static str {
        match self {
            PartKind::Beam => "beam",
            PartKind::Bar => "bar",
            PartKind::Shell => "shell",
            PartKind::Link => "link",
            PartKind::Contact => "contact",
        }
    }

    /// The words for one and for several of what [`Part::counted`] counts.
    pub fn counted_as(self) -> [&'static str; 2] {
        match self {
            PartKind::Beam => ["beam element", "beam elements"],
            PartKind::Bar => ["bar element", "bar elements"],
            PartKind::Shell => ["shell element", "shell elements"],
            PartKind::Link => ["link", "links"],
            PartKind::Contact => ["contact", "contacts"],
        }
    }

    /// True for parts with elements of material, which have mass, strain energy and may yield.
    pub fn is_deformable(self) -> bool {
        match self {
            PartKind::Beam | PartKind::Bar | PartKind::Shell => true,
            PartKind::Link | PartKind::Contact => false,
        }
    }
}

impl Part {
    pub fn kind(&self) -> PartKind {
        match self {
            Part::Beam(_) => PartKind::Beam,
            Part::Bar(_) => PartKind::Bar,
            Part::Shell(_) => PartKind::Shell,
            Part::Link(_) => PartKind::Link,
            Part::Contact(_) => PartKind::Contact,
        }
    }

    /// The deck's name of the part.
    pub fn name(&self) -> &str {
        match self {
            Part::Beam(part) => &part.name,
            Part::Bar(part) => &part.name,
            Part::Shell(part) => &part.name,
            Part::Link(part) => &part.name,
            Part::Contact(part) => &part.name,
        }
    }

    /// True where the two are one part of the deck: a shell of triangles and one of quadrilaterals.
    pub fn is_one_with(&self, other: &Part) -> bool {
        self.kind() == other.kind() && self.name() == other.name()
    }

    /// Number of elements; a link is one, and so is each point of a contact.
    pub fn elements(&self) -> usize {
        match self {
            Part::Beam(part) => part.elements.len(),
            Part::Bar(part) => part.elements.len(),
            Part::Shell(part) => part.elements.len(),
            Part::Link(_) => 1,
            Part::Contact(part) => part.points.len(),
        }
    }

    /// What the log and `check` count of the part: its elements, or the part itself where it has none of its own.
    pub fn counted(&self) -> usize {
        if self.kind().is_deformable() { self.elements() } else { 1 }
    }

    /// Nodes of an element of a deformable part, ends of a link, points of a contact without the node that carries the surface.
    pub fn nodes(&self, element: usize) -> &[usize] {
        match self {
            Part::Beam(part) => &part.elements[element].nodes[..=part.order],
            Part::Bar(part) => &part.elements[element],
            Part::Shell(part) => &part.elements[element].nodes[..part.corners],
            Part::Link(part) => &part.ends,
            Part::Contact(part) => part.points[element].nodes(),
        }
    }

    /// Calls `visit` with every node that the part names, so that nodes can be numbered anew.
    pub fn visit_nodes(&mut self, visit: &mut impl FnMut(&mut usize)) {
        match self {
            Part::Beam(part) => {
                let order = part.order;
                part.elements.iter_mut().flat_map(|e| &mut e.nodes[..=order]).for_each(visit);
            }
            Part::Bar(part) => part.elements.iter_mut().flatten().for_each(visit),
            Part::Shell(part) => part.elements.iter_mut().flat_map(|e| &mut e.nodes).for_each(visit),
            Part::Link(part) => part.ends.iter_mut().for_each(visit),
            Part::Contact(part) => {
                visit(&mut part.node);
                part.points.iter_mut().flat_map(|point| &mut point.nodes[..point.count]).for_each(visit);
            }
        }
    }

    /// True where the material of the part yields.
    pub fn yields(&self) -> bool {
        match self {
            Part::Beam(part) => part.yielding.is_some(),
            Part::Bar(part) => part.yielding.is_some(),
            Part::Shell(part) => part.yielding.is_some(),
            Part::Link(_) | Part::Contact(_) => false,
        }
    }

    /// True where the part may resist more than it does as it lies, all at once.
    pub fn may_stiffen(&self) -> bool {
        match self {
            Part::Beam(_) | Part::Bar(_) | Part::Shell(_) => false,
            Part::Link(part) => {
                matches!(&part.kind, LinkKind::Line { law, .. } if !matches!(law, LinkLaw::Linear { .. }))
            }
            Part::Contact(_) => true,
        }
    }

    /// True where the part may store less energy than none, because it gives way under a preload or by its table.
    pub fn may_release(&self) -> bool {
        let releases = |law: &LinkLaw| matches!(law, LinkLaw::Table { .. }) || law.force(0.0).0 != 0.0;
        match self {
            Part::Link(part) => matches!(&part.kind, LinkKind::Line { law, .. } if releases(law)),
            Part::Beam(_) | Part::Bar(_) | Part::Shell(_) | Part::Contact(_) => false,
        }
    }

    /// How the mass of the part is spread; `None` for a part without mass of its own.
    pub fn mass_kind(&self) -> Option<MassKind> {
        match self {
            Part::Beam(part) => Some(part.mass),
            Part::Bar(part) => Some(part.mass),
            Part::Shell(part) => Some(part.mass),
            Part::Link(_) | Part::Contact(_) => None,
        }
    }

    /// The mass of an element at t = 0, whether or not the deck asks to keep it.
    pub fn element_mass(&self, element: usize, nodes: &[Node], stiffnesses: &[Stiffness]) -> f64 {
        let length = |a: usize, b: usize| (nodes[a].x - nodes[b].x).norm();
        let of = self.nodes(element);
        match self {
            Part::Beam(part) => {
                stiffnesses[part.elements[element].section].mass_per_length * length(of[0], of[part.order])
            }
            Part::Bar(part) => part.mass_per_length * length(of[0], of[1]),
            Part::Shell(part) => {
                let x = |k: usize| nodes[of[k]].x;
                let twice = (1..of.len() - 1).map(|k| (x(k) - x(0)).cross(&(x(k + 1) - x(0))).norm()).sum::<f64>();
                part.density * part.plate.thickness * (0.5 * twice)
            }
            Part::Link(_) | Part::Contact(_) => 0.0,
        }
    }

    /// How an element is drawn; `None` for a contact, whose surface and points are drawn with what carries them.
    pub fn drawing(&self, element: usize) -> Option<Drawing<'_>> {
        let nodes = self.nodes(element);
        match self {
            Part::Beam(part) => Some(Drawing::Curve { nodes, axes: part.elements[element].frame }),
            Part::Bar(_) | Part::Link(_) => Some(Drawing::Curve { nodes, axes: Mat3::identity() }),
            Part::Shell(_) => Some(Drawing::Face { corners: nodes }),
            Part::Contact(_) => None,
        }
    }
}

/// One of the types that [`Part`] holds.
pub trait PartType: Into<Part> {
    fn of(part: &Part) -> Option<&Self>;
    fn of_mut(part: &mut Part) -> Option<&mut Self>;
}

macro_rules! part_types {
    ($($Type:ident)*) => {$(
        impl From<$Type> for Part {
            fn from(part: $Type) -> Part {
                Part::$Type(part)
            }
        }

        impl PartType for $Type {
            fn of(part: &Part) -> Option<&$Type> {
                if let Part::$Type(part) = part { Some(part) } else { None }
            }

            fn of_mut(part: &mut Part) -> Option<&mut $Type> {
                if let Part::$Type(part) = part { Some(part) } else { None }
            }
        }
    )*};
}

part_types! { Beam Bar Shell Link Contact }
