//! The scene as a whole.

use super::analysis::{Analysis, Solution};
use super::case::LoadCases;
use super::constraints::Constraints;
use super::expect::Expect;
use super::loading::{Damping, Loading};
use super::node::{Body, Mass, Node};
use super::output::Output;
use super::part::{Part, PartType};
use super::reduction::Reduction;
use super::step_length::{SAFE, SAFE_WHERE_STRUCK};
use super::study::Study;
use deck::parts::PartKind;
use mechanics::sections::{SectionStresses, Stiffness};

/// Largest number of constraint equations of joints, which explicit schemes solve by a dense matrix.
const EQUATIONS: usize = 60;

/// A scene, checked and ready to be planned.
#[derive(Debug, Clone)]
pub struct Model {
    /// Title of the scene.
    pub title: String,
    /// The analysis.
    pub analysis: Analysis,
    /// The scheme and the iteration.
    pub solution: Solution,
    /// The nodes; all other data refer to them by index.
    pub nodes: Vec<Node>,
    /// Rigid bodies.
    pub bodies: Vec<Body>,
    /// Point masses.
    pub masses: Vec<Mass>,
    /// Section stiffnesses and inertias, shared by the elements that name them.
    pub stiffnesses: Vec<Stiffness>,
    /// What stresses of these sections follow from, in their order; `None` of a section that does not say where its area is.
    pub stresses: Vec<Option<SectionStresses>>,
    /// Beams, then bars, shells, links and contacts, each kind in deck order: the order of numbering, assembly and rows.
    pub parts: Vec<Part>,
    /// Parts that deform by a few shapes.
    pub reductions: Vec<Reduction>,
    /// Rigid links, joints and restraints.
    pub constraints: Constraints,
    /// Loads and amplitudes.
    pub loading: Loading,
    /// What a linear analysis is solved for.
    pub cases: LoadCases,
    /// Rayleigh and nodal damping.
    pub damping: Damping,
    /// Expected values.
    pub expects: Vec<Expect>,
    /// The mesh file, and bodies made of parts.
    pub origin: Origin,
    /// The output of the run.
    pub output: Output,
    /// The variants that `rdsolve study` runs.
    pub study: Option<Study>,
}

impl Model {
    /// Adds a part after those of its kind and returns its place in [`Model::parts`]. Places of parts of later kinds move up.
    pub fn add(&mut self, part: impl Into<Part>) -> usize {
        let part = part.into();
        let place = self.parts.partition_point(|other| other.kind() <= part.kind());
        self.parts.insert(place, part);
        place
    }

    /// The reduction of a part, by its index in [`Model::parts`].
    pub fn reduction(&self, part: usize) -> Option<&Reduction> {
        self.reductions.iter().find(|reduction| reduction.parts.contains(&part))
    }

    /// The nodes whose displacement along x is a number rather than a way in space.
    pub fn number_nodes(&self) -> impl Iterator<Item = usize> {
        (0..self.nodes.len()).filter(|&node| self.nodes[node].is_number)
    }

    /// The parts of one type, in deck order: `model.each::<Shell>()`.
    pub fn each<T: PartType + 'static>(&self) -> impl Iterator<Item = &T> {
        self.parts.iter().filter_map(T::of)
    }

    /// The parts of one type, in deck order, to be changed.
    pub fn each_mut<T: PartType + 'static>(&mut self) -> impl Iterator<Item = &mut T> {
        self.parts.iter_mut().filter_map(T::of_mut)
    }

    /// Number of parts of a kind.
    pub fn count(&self, kind: PartKind) -> usize {
        self.parts.iter().filter(|part| part.kind() == kind).count()
    }

    /// True where there are parts of a kind.
    pub fn has(&self, kind: PartKind) -> bool {
        self.count(kind) > 0
    }

    /// True where any part has sections with forces and moments.
    pub fn has_sections(&self) -> bool {
        self.parts.iter().any(|part| part.kind().has_sections())
    }

    /// True where any part is a surface.
    pub fn has_surfaces(&self) -> bool {
        self.parts.iter().any(|part| part.kind().is_surface())
    }

    /// True where the material of any part yields.
    pub fn yields(&self) -> bool {
        self.parts.iter().any(|part| part.yields())
    }

    /// True where a part may suddenly resist more than at the current configuration.
    pub fn may_stiffen(&self) -> bool {
        self.parts.iter().any(|part| part.may_stiffen())
    }

    /// True where the dense matrix of the joints costs explicit schemes little.
    pub fn has_few_joint_equations(&self) -> bool {
        self.constraints.joints.iter().map(|joint| joint.equations.len()).sum::<usize>() <= EQUATIONS
    }

    /// The part of the critical time step that automatic steps of central differences take.
    pub fn stable_fraction(&self) -> f64 {
        if self.may_stiffen() { SAFE_WHERE_STRUCK } else { SAFE }
    }
}

/// The origin of parts that the model no longer holds as the deck has them.
#[derive(Debug, Clone, Default)]
pub struct Origin {
    /// The mesh file that the deck names.
    pub mesh: Option<MeshFile>,
    /// The files of records that amplitudes name.
    pub records: Vec<RecordFile>,
    /// Bodies made of parts, whose elements have left the model.
    pub rigid: Vec<Rigid>,
    /// Sections of polygons that beams use, in the order of the beams.
    pub sections: Vec<SectionFacts>,
}

/// Numbers of a section that finite elements of the section gave.
#[derive(Debug, Clone)]
pub struct SectionFacts {
    /// Its name.
    pub name: String,
    /// The material of the beam, of polygons without one of their own.
    pub material: Option<String>,
    /// Number of triangles.
    pub triangles: usize,
    /// Area.
    pub area: f64,
    /// Centroid, where each area counts by its Young's modulus, in the coordinates of the polygons.
    pub centroid: [f64; 2],
    /// Shear centre in the coordinates of the polygons.
    pub shear_center: [f64; 2],
    /// Stiffness and mass about the centroid.
    pub stiffness: Stiffness,
}

/// The file of a record.
#[derive(Debug, Clone)]
pub struct RecordFile {
    /// Path as messages name it.
    pub path: String,
    /// SHA-256 of its bytes.
    pub digest: [u8; 32],
}

/// The parts that a body is made of.
#[derive(Debug, Clone)]
pub struct Rigid {
    /// Index into [`Model::bodies`].
    pub body: usize,
    /// The parts, in words like "shell `roof`".
    pub parts: Vec<String>,
    /// Number of their elements, which are omitted.
    pub elements: usize,
}

/// The mesh file that the deck names.
#[derive(Debug, Clone)]
pub struct MeshFile {
    /// Path as messages name it.
    pub path: String,
    /// SHA-256 of its bytes.
    pub digest: [u8; 32],
    /// Number of nodes in the file.
    pub nodes: usize,
    /// Number of elements in the file.
    pub elements: usize,
    /// Number of elements in parts of the deck.
    pub used: usize,
}
