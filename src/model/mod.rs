//! What the deck means: nodes, bodies, elements, links, constraints, loads, as plain data in deck order.
//! Built once from the deck, never changed; everything downstream borrows it.

mod amplitudes;
mod analysis;
mod attachments;
mod axes;
mod bars;
mod beams;
mod bodies;
mod build;
mod check;
mod contact_points;
mod contact_surface;
mod contacts;
mod control;
mod ends;
mod environment;
mod expects;
mod groups;
mod initial;
mod joints;
mod links;
mod loads;
mod masses;
mod materials;
mod merge_diagnostics;
mod mesh_file;
mod names;
mod nearest_nodes;
mod node_places;
mod nodes;
mod output;
mod part;
mod part_context;
mod parts;
mod passages;
mod patch;
mod paths;
mod place;
mod report;
mod rigid;
mod scene;
mod sections;
mod shells;
mod slivers;
mod spot;
mod spread_loads;
mod step_length;
pub mod study;
mod supports;
mod surface_map;
mod units;
mod unused;
mod usage;
mod values;

pub use crate::deck::analysis::{AnalysisKind, Gyroscopic, Method, Update};
pub use crate::deck::beams::MassKind;
pub use crate::deck::supports::History;
pub use build::{build, read};
pub use mesh_file::Input;
pub use part::{
    Bar, Beam, BeamElement, Contact, Drawing, Link, LinkKind, Part, PartKind, PartType, Shell, ShellElement,
};
pub use step_length::{ArcLength, ERROR_TOLERANCE, StepLength, may_stiffen, stable_fraction};
pub use study::Study;

use crate::amplitude::Amplitude;
use crate::constraints::joint::Row;
use crate::elements::pressure::Face;
use crate::integrators::Scheme;
use crate::math::{Mat3, Vec3};
use crate::sections::Stiffness;
use std::sync::Arc;

/// A scene, checked and ready to be planned.
#[derive(Debug, Clone)]
pub struct Model {
    pub title: String,
    /// Label of the unit system, for output only.
    pub units: Option<String>,
    pub analysis: Analysis,
    pub scheme: Arc<dyn Scheme>,
    pub iteration: Iteration,
    pub nodes: Vec<Node>,
    pub bodies: Vec<Body>,
    pub masses: Vec<Mass>,
    /// Section stiffnesses and inertias, shared by the elements that name them.
    pub stiffnesses: Vec<Stiffness>,
    /// Beams, then bars, shells, links and contacts, each kind in deck order: the order of numbering, assembly and rows.
    pub parts: Vec<Part>,
    /// Nodes tied to other nodes, each at most once, in no particular order.
    pub riders: Vec<Rider>,
    pub joints: Vec<Joint>,
    /// Degrees of freedom whose motion is given, each at most once, sorted by node and direction.
    pub held: Vec<Held>,
    pub amplitudes: Vec<Amplitude>,
    pub loads: Vec<Load>,
    pub pressures: Vec<Pressure>,
    pub gravity: Vec3,
    pub base_accelerations: Vec<BaseAcceleration>,
    pub damping: Damping,
    pub expects: Vec<Expect>,
    /// Bodies that parts make up, whose elements have left the model.
    pub rigid: Vec<Rigid>,
    /// The file that the deck names.
    pub mesh: Option<MeshFile>,
    pub output: Output,
    /// What `rdsolve study` goes over.
    pub study: Option<Study>,
}

/// What a body is made of.
#[derive(Debug, Clone)]
pub struct Rigid {
    /// Index into [`Model::bodies`].
    pub body: usize,
    /// "shell `roof`".
    pub parts: Vec<String>,
    /// Elements left out.
    pub elements: usize,
}

#[derive(Debug, Clone)]
pub struct MeshFile {
    /// As messages name it.
    pub path: String,
    /// SHA-256 of its bytes.
    pub digest: [u8; 32],
    /// In the file.
    pub nodes: usize,
    pub elements: usize,
    /// Of these, in parts of the deck.
    pub used: usize,
}

#[derive(Debug, Clone)]
pub struct Analysis {
    pub kind: AnalysisKind,
    pub end_time: f64,
    pub step_length: StepLength,
    /// A step is never cut below this.
    pub least_step: f64,
    /// Leave out-of-plane motion out of the unknowns where nothing can cause it.
    pub plane: bool,
}

impl Analysis {
    /// The length of step that samples and studies are planned with: that of fixed steps, or else about that of the first.
    pub fn nominal_step(&self) -> f64 {
        match &self.step_length {
            StepLength::Fixed { step } => *step,
            StepLength::ErrorControlled { first, .. } => *first,
            StepLength::StabilityLimited { .. } => step_length::FIRST_STEP * self.end_time,
            StepLength::ArcLength(arc) => arc.first,
        }
    }
}

/// A displacement on its way through a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passage {
    pub node: usize,
    /// 0..3: ux, uy, uz.
    pub dof: usize,
    pub value: f64,
    /// Which time it does so, from 1.
    pub pass: usize,
    /// Where the deck names the direction: first byte, and the one after the last.
    pub place: [usize; 2],
}

#[derive(Debug, Clone)]
pub struct Iteration {
    pub method: Method,
    pub update: Update,
    pub gyroscopic: Gyroscopic,
    /// Relative, on residual and increment.
    pub tolerance: f64,
    /// Iterations in a step before it is cut.
    pub limit: usize,
}

/// A point that moves. Its rotation is measured from the undeformed state, so it starts at the identity.
#[derive(Debug, Clone)]
pub struct Node {
    /// The deck's name, or one made from it: `portal[3]`, `bumper.from`.
    pub label: String,
    /// True for points named in the deck and for bodies.
    pub named: bool,
    pub x: Vec3,
    /// Initial velocity and angular velocity, global components.
    pub v: Vec3,
    pub omega: Vec3,
    /// Where the deck names it, or the part that it belongs to: first byte, and the one after the last.
    pub place: Option<[usize; 2]>,
}

/// A rigid body: a node at its centre of mass, with mass and inertia.
#[derive(Debug, Clone)]
pub struct Body {
    pub name: String,
    pub node: usize,
    pub mass: f64,
    /// About the centre, body axes = global axes at t = 0.
    pub inertia: Mat3,
    /// For drawing: what the deck said, or the cuboid of the same inertia.
    pub shape: Shape,
}

/// Body-fixed shape around the centre of mass; axes of the body.
#[derive(Debug, Clone)]
pub enum Shape {
    /// Full edge lengths along `axes` (columns: the shape's axes in body components).
    Box {
        size: [f64; 3],
        axes: Mat3,
    },
    Sphere {
        radius: f64,
    },
    /// Along `axis`; `inner_radius` 0 for a solid cylinder.
    Cylinder {
        radius: f64,
        inner_radius: f64,
        length: f64,
        axis: Vec3,
    },
    /// Faces of three or four corners, lines of two, as indices into points about the centre of mass.
    Faces {
        points: Vec<Vec3>,
        faces: Vec<Vec<usize>>,
    },
}

/// A point mass (with optional rotary inertia, global axes at t = 0).
#[derive(Debug, Clone)]
pub struct Mass {
    pub node: usize,
    pub mass: f64,
    pub inertia: Mat3,
}

/// A node constrained to another in some of its directions (45)-(48).
#[derive(Debug, Clone)]
pub struct Rider {
    pub node: usize,
    pub master: usize,
    /// ux, uy, uz, rx, ry, rz: which are taken from the master.
    pub dofs: [bool; 6],
    /// Where the deck attaches it: first byte, and the one after the last.
    pub place: Option<[usize; 2]>,
}

/// Two nodes held together by multipliers (57).
#[derive(Debug, Clone)]
pub struct Joint {
    pub name: String,
    /// Nodes at `from` and `to`: riders on a node or body, the node itself, or a held node for the ground.
    pub ends: [usize; 2],
    pub rows: Vec<Row>,
    /// It holds a node that rides elsewhere to its support, whose reactions say what it carries.
    pub supports: bool,
}

/// A direction of a node whose motion is given.
#[derive(Debug, Clone)]
pub struct Held {
    pub node: usize,
    /// 0..6: ux, uy, uz, rx, ry, rz.
    pub dof: usize,
    /// `None`: at rest.
    pub motion: Option<Motion>,
}

#[derive(Debug, Clone)]
pub struct Motion {
    pub amplitude: usize,
    pub scale: f64,
    pub history: History,
}

#[derive(Debug, Clone)]
pub struct Load {
    pub node: usize,
    pub force: Vec3,
    pub moment: Vec3,
    /// Turns with its node.
    pub follower: bool,
    pub amplitude: Option<usize>,
}

/// Pressure on faces as they are at the moment, against their normals.
#[derive(Debug, Clone)]
pub struct Pressure {
    pub faces: Vec<Face>,
    pub pressure: f64,
    pub amplitude: Option<usize>,
}

/// Acceleration of the ground, felt by every mass as −M a; displacements are then relative to the ground.
#[derive(Debug, Clone)]
pub struct BaseAcceleration {
    pub direction: Vec3,
    pub amplitude: usize,
}

#[derive(Debug, Clone, Default)]
pub struct Damping {
    /// Rayleigh: C = mass_factor M + stiffness_factor K. The stiffness part acts on strain rates of beams and bars.
    pub mass_factor: f64,
    pub stiffness_factor: f64,
    pub nodal: Vec<NodalDamping>,
}

#[derive(Debug, Clone)]
pub struct NodalDamping {
    pub node: usize,
    /// Force per velocity, moment per angular velocity.
    pub translation: f64,
    pub rotation: f64,
}

/// A value that the run must reach.
#[derive(Debug, Clone)]
pub struct Expect {
    pub at: ExpectAt,
    pub quantity: String,
    pub when: When,
    pub value: f64,
    pub tolerance: Tolerance,
    pub source: String,
    /// As written in the deck, for the message.
    pub label: String,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ExpectAt {
    /// The time, which follows where the path is followed by arc length.
    Analysis,
    Node(usize),
    /// Columns of energy.csv.
    Energy,
    /// Columns of links.csv, by place among the links.
    Link(usize),
    /// Force and moment on the first end of a joint.
    Joint(usize),
    /// Columns of contacts.csv, and the size of the force, by place among the contacts.
    Contact(usize),
    /// Largest values over the shells from one place in [`Model::parts`] to before another: of von Mises stress and plastic strain.
    Shells(usize, usize),
    /// The largest plastic strain of elements, from one to before another, counted through all beams, then all bars.
    Elements(usize, usize),
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum When {
    /// With arc-length: the first time the load comes to it, from below.
    Time(f64),
    /// With arc-length alone.
    Passing(Passage),
    Max,
    Min,
    /// Greatest absolute value.
    Abs,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tolerance {
    Relative(f64),
    Absolute(f64),
    /// The value is a bound.
    AtLeast,
    AtMost,
}

#[derive(Debug, Clone)]
pub struct Output {
    /// Nodes whose histories go to nodes.csv, in deck order (bodies are not among them).
    pub nodes: Vec<usize>,
    pub cadence: Cadence,
    pub energy: bool,
    pub links: bool,
    pub contacts: bool,
    pub reactions: bool,
    pub sections: bool,
    pub layers: bool,
    pub parts: bool,
    /// Steps between two field files; `None`: no fields.
    pub fields: Option<usize>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cadence {
    /// Every so many accepted steps.
    Steps(usize),
    /// At multiples of this time; steps land on them.
    Interval(f64),
}

pub const DIRECTIONS: [&str; 6] = ["ux", "uy", "uz", "rx", "ry", "rz"];
