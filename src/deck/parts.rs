//! The parts of a deck in one view: beams, bars, shells, superelements, links and contacts, whatever table they come from. The table of a part, in the
//! file of its kind, describes the part before it is read.

use super::Deck;
use super::part_table::PartTable;
use super::words::Table;
use base::diagnostic::{At, Span};

/// Kinds of parts, in the order of reading, numbering, assembly and output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum PartKind {
    /// A line of elements that stretch, shear, bend and twist.
    Beam,
    /// Bars or cables: straight elements with an axial force only.
    Bar,
    /// A surface of triangles and quadrilaterals that stretch, shear and bend.
    Shell,
    /// A part by its matrices.
    Superelement,
    /// A spring, damper or bushing between two points.
    Link,
    /// Points, or boxes, against a surface.
    Contact,
}

/// A part by its kind and the index of its table among those of that kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PartIndex {
    /// Kind, which identifies the list of tables.
    pub kind: PartKind,
    /// Its index among the tables of that kind.
    pub index: usize,
}

/// A part of a deck, whatever its kind.
#[derive(Clone, Copy)]
pub struct DeckPart<'d> {
    /// Which part of the deck it is.
    pub at: PartIndex,
    /// Where its table stands.
    pub span: &'d Span,
    /// Table with the properties that depend on the kind.
    pub table: &'d dyn PartTable,
}

impl<'d> DeckPart<'d> {
    /// Name of the part or of its group, used in the rest of the deck.
    pub fn name(&self) -> Option<&'d At<String>> {
        self.table.name().or(self.table.group())
    }

    /// True where the rest of the deck knows it by this name.
    pub fn is_named(&self, name: &str) -> bool {
        self.name().is_some_and(|own| own.value == name)
    }

    /// Its name, or the path of its table for a part without one.
    pub fn label(&self) -> String {
        self.name().map_or_else(|| self.table_path(), |name| name.value.clone())
    }

    /// `beams.0`, as overrides name it.
    pub fn table_path(&self) -> String {
        format!("{}.{}", self.at.kind.table(), self.at.index)
    }

    /// "shell `roof`".
    pub fn title(&self) -> String {
        format!("{} `{}`", self.at.kind.word(), self.name().map_or("", |name| name.as_str()))
    }

    /// True if the part is a rigid body.
    pub fn is_rigid(&self) -> bool {
        self.table.rigid() == Some(true)
    }

    /// Where the deck names it, or its table.
    pub fn place(&self) -> &'d Span {
        self.name().map_or(self.span, |name| &name.span)
    }
}

impl PartKind {
    /// All kinds in their order.
    pub const ALL: [PartKind; 6] =
        [PartKind::Beam, PartKind::Bar, PartKind::Shell, PartKind::Superelement, PartKind::Link, PartKind::Contact];

    /// The word for one part, in files and messages.
    pub fn word(self) -> &'static str {
        match self {
            PartKind::Beam => "beam",
            PartKind::Bar => "bar",
            PartKind::Shell => "shell",
            PartKind::Superelement => "superelement",
            PartKind::Link => "link",
            PartKind::Contact => "contact",
        }
    }

    /// The key of its tables in the deck.
    pub fn table(self) -> &'static str {
        match self {
            PartKind::Beam => "beams",
            PartKind::Bar => "bars",
            PartKind::Shell => "shells",
            PartKind::Superelement => "superelements",
            PartKind::Link => "links",
            PartKind::Contact => "contacts",
        }
    }

    /// Singular and plural of the counted unit: elements of material, or the parts.
    pub fn counted_as(self) -> [&'static str; 2] {
        match self {
            PartKind::Beam => ["beam element", "beam elements"],
            PartKind::Bar => ["bar element", "bar elements"],
            PartKind::Shell => ["shell element", "shell elements"],
            PartKind::Superelement => ["superelement", "superelements"],
            PartKind::Link => ["link", "links"],
            PartKind::Contact => ["contact", "contacts"],
        }
    }

    /// The number of directions across the part in which its temperature may vary.
    pub fn gradients(self) -> usize {
        match self {
            PartKind::Beam => 2,
            PartKind::Shell => 1,
            PartKind::Bar | PartKind::Superelement | PartKind::Link | PartKind::Contact => 0,
        }
    }

    /// True for parts with nodes and elements of material, which have mass, strain energy and may yield.
    pub fn is_deformable(self) -> bool {
        match self {
            PartKind::Beam | PartKind::Bar | PartKind::Shell | PartKind::Superelement => true,
            PartKind::Link | PartKind::Contact => false,
        }
    }

    /// True for parts whose elements have sections with forces and moments.
    pub fn has_sections(self) -> bool {
        self == PartKind::Beam
    }

    /// True for parts whose elements are faces: they take loads per area, and per length along edges.
    pub fn is_surface(self) -> bool {
        self == PartKind::Shell
    }

    /// True for parts whose elements are lines with a section.
    pub fn is_line(self) -> bool {
        matches!(self, PartKind::Beam | PartKind::Bar)
    }

    /// True for parts that are linear in a frame that moves with them.
    pub fn is_floating(self) -> bool {
        self == PartKind::Superelement
    }

    /// True for parts whose elements act while they are closed and are left out otherwise: unilateral constraints.
    #[inline]
    pub fn is_unilateral(self) -> bool {
        self == PartKind::Contact
    }

    /// False for parts drawn with their carrier.
    pub fn is_drawn(self) -> bool {
        self != PartKind::Contact
    }

    /// True if nodes of the part accept attachments.
    pub fn takes_attachments(self) -> bool {
        self == PartKind::Beam
    }
}

impl Deck {
    /// All parts, kind by kind in the order of [`PartKind::ALL`].
    pub fn parts(&self) -> impl Iterator<Item = DeckPart<'_>> {
        let of_kind = move |kind| (0..).map_while(move |index| self.part(PartIndex { kind, index }));
        PartKind::ALL.into_iter().flat_map(of_kind)
    }

    /// The names that an entry of a list of parts stands for: those of a set, or its own.
    pub fn members<'d>(&'d self, entry: &'d At<String>) -> Vec<&'d At<String>> {
        let set = self.sets.0.iter().find(|(set, _)| set.value == entry.value);
        set.map_or_else(|| vec![entry], |(_, set)| set.values.iter().collect())
    }

    /// A part by its index; `None` beyond the last of its kind.
    pub fn part(&self, at: PartIndex) -> Option<DeckPart<'_>> {
        match at.kind {
            PartKind::Beam => view(at, &self.beams),
            PartKind::Bar => view(at, &self.bars),
            PartKind::Shell => view(at, &self.shells),
            PartKind::Superelement => view(at, &self.superelements),
            PartKind::Link => view(at, &self.links),
            PartKind::Contact => view(at, &self.contacts),
        }
    }
}

fn view<T: PartTable>(at: PartIndex, tables: &[At<Table<T>>]) -> Option<DeckPart<'_>> {
    let table = tables.get(at.index)?;
    Some(DeckPart { at, span: &table.span, table: &*table.value })
}
