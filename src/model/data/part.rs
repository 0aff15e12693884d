//! The parts of a scene that resist: beams, bars, shells, links and contacts. What other rooms ask of any part is listed here and
//! answered by each kind in its own file: one more kind is that file, and a variant with the lines that the compiler then misses.

use super::bar::Bar;
use super::beam::Beam;
use super::contact::Contact;
use super::integrals::MassIntegrals;
use super::link::Link;
use super::loading::OwnDamping;
use super::node::Node;
use super::part_answers::{Drawing, LineElement, LinearSpring, NodeWeights, PartAnswers};
use super::shell::Shell;
use base::math::Vec3;
use base::quantities::Column;
use deck::part_table::MassKind;
use deck::parts::PartKind;
use mechanics::sections::Stiffness;

/// A part of the scene; [`super::Model::parts`] lists them kind by kind in the order of the variants.
#[derive(Debug, Clone)]
pub enum Part {
    /// A line of elements that stretch, shear, bend and twist.
    Beam(Beam),
    /// Bars or cables: straight elements with an axial force only.
    Bar(Bar),
    /// A surface of elements that stretch, shear and bend; a shell of the deck with two shapes of elements makes two.
    Shell(Shell),
    /// A spring, damper or bushing between two nodes.
    Link(Link),
    /// Points, or boxes, against a surface.
    Contact(Contact),
}

/// Hands a question to the kind of a part.
macro_rules! ask {
    ($part:expr, $question:ident $($argument:expr),*) => {
        match $part {
            Part::Beam(part) => part.$question($($argument),*),
            Part::Bar(part) => part.$question($($argument),*),
            Part::Shell(part) => part.$question($($argument),*),
            Part::Link(part) => part.$question($($argument),*),
            Part::Contact(part) => part.$question($($argument),*),
        }
    };
}

impl Part {
    /// The kind of the part, by which rooms tell parts apart without their data.
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
        ask!(self, name)
    }

    /// True where the two are one part of the deck: a shell of triangles and one of quadrilaterals.
    pub fn is_one_with(&self, other: &Part) -> bool {
        self.kind() == other.kind() && self.name() == other.name()
    }

    /// True for a part that stands in a table of its own; false for what acts along a joint.
    pub fn is_listed(&self) -> bool {
        ask!(self, is_listed)
    }

    /// Number of elements; a link is one, and so is each point and each box of a contact.
    pub fn elements(&self) -> usize {
        ask!(self, elements)
    }

    /// What the log and `check` count of the part: its elements, or the part itself where it has none of its own.
    pub fn counted(&self) -> usize {
        if self.kind().is_deformable() { self.elements() } else { 1 }
    }

    /// Nodes of an element of a deformable part, ends of a link, points of a contact without the node that carries the surface.
    pub fn nodes(&self, element: usize) -> &[usize] {
        ask!(self, nodes element)
    }

    /// Calls `visit` with every node that the part names, so that nodes can be numbered anew.
    pub fn visit_nodes(&mut self, visit: &mut impl FnMut(&mut usize)) {
        ask!(self, visit_nodes visit);
    }

    /// True where the material of the part yields.
    pub fn yields(&self) -> bool {
        ask!(self, yields)
    }

    /// True where the part may resist more than it does as it lies, all at once.
    pub fn may_stiffen(&self) -> bool {
        ask!(self, may_stiffen)
    }

    /// True where the part may store less energy than none, because it gives way under a preload or by its table.
    pub fn may_release(&self) -> bool {
        ask!(self, may_release)
    }

    /// Rayleigh factors that the deck gives the part by itself.
    pub fn own_damping(&self) -> OwnDamping {
        ask!(self, own_damping)
    }

    /// True for a part with an elastic stiffness on which Rayleigh's β acts.
    pub fn has_damped_stiffness(&self) -> bool {
        ask!(self, has_damped_stiffness)
    }

    /// How the mass of the part is spread; `None` for a part without mass of its own.
    pub fn mass_kind(&self) -> Option<MassKind> {
        ask!(self, mass_kind)
    }

    /// The mass of an element at t = 0, whether or not the deck asks to keep it.
    pub fn element_mass(&self, element: usize, nodes: &[Node], stiffnesses: &[Stiffness]) -> f64 {
        ask!(self, element_mass element, nodes, stiffnesses)
    }

    /// An element of this length as a load along it sees it; `None` for what has no length.
    pub fn line(&self, element: usize, length: f64, stiffnesses: &[Stiffness]) -> Option<LineElement> {
        ask!(self, line element, length, stiffnesses)
    }

    /// The part as a linear spring along a line; `None` for all that is not just that.
    pub fn linear_spring(&self) -> Option<LinearSpring> {
        ask!(self, linear_spring)
    }

    /// The stiffness of an element against stretching at t = 0: E A over its length, E times the thickness of a shell; `None` for what has
    /// none.
    pub fn stretching(&self, element: usize, nodes: &[Node], stiffnesses: &[Stiffness]) -> Option<f64> {
        ask!(self, stretching element, nodes, stiffnesses)
    }

    /// The smaller and the larger depth of a cross-section: of a shell its thickness, of a beam those of the rectangle with the
    /// axial and bending stiffness of its first element; `None` for what has none.
    pub fn depths(&self, stiffnesses: &[Stiffness]) -> Option<[f64; 2]> {
        ask!(self, depths stiffnesses)
    }

    /// How an element is drawn; `None` for a contact, whose surface and points are drawn with what carries them.
    pub fn drawing(&self, element: usize) -> Option<Drawing<'_>> {
        ask!(self, drawing element)
    }

    /// Unit normals at the nodes of an element of a surface, at t = 0; none for other parts.
    pub fn normals(&self, element: usize) -> &[Vec3] {
        ask!(self, normals element)
    }

    /// So many places between each two neighbouring nodes, and within faces, each once: there the part may be touched too.
    pub fn places_between(&self, count: usize) -> Vec<NodeWeights> {
        ask!(self, places_between count)
    }

    /// Moves the elements of the part into integrals over them, positions by `x`, because the part is rigid. Returns the nodes of
    /// each as it is drawn.
    pub fn take_out(
        &mut self,
        stiffnesses: &[Stiffness],
        x: &dyn Fn(usize) -> Vec3,
        sums: &mut MassIntegrals,
    ) -> Vec<Vec<usize>> {
        ask!(self, take_out stiffnesses, x, sums)
    }
}

/// The quantities that `[[expect]]` may ask of a part of this kind; plastic strain, where its material yields.
pub fn quantities_of(kind: PartKind) -> Vec<Column> {
    let quantities = match kind {
        PartKind::Beam => Beam::QUANTITIES,
        PartKind::Bar => Bar::QUANTITIES,
        PartKind::Shell => Shell::QUANTITIES,
        PartKind::Link => Link::QUANTITIES,
        PartKind::Contact => Contact::QUANTITIES,
    };
    quantities.concat()
}

/// One of the types that [`Part`] holds.
pub trait PartType: Into<Part> {
    /// The part as this type; `None` where it is of another kind.
    fn of(part: &Part) -> Option<&Self>;
    /// The same, to be changed.
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
