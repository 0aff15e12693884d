//! The words of the deck, as written: one file per family of tables, every value with its place.
//!
//! Every key is optional here. The code that uses a key reports if it is missing, so a missing key is one more diagnostic instead of the
//! end of reading.

#![warn(missing_docs)]

pub mod actuators;
pub mod aliases;
pub mod amplitudes;
pub mod analysis;
pub mod attachments;
pub mod bars;
pub mod beams;
pub mod bodies;
pub mod cases;
pub mod contacts;
pub mod drifts;
pub mod environment;
pub mod equations;
pub mod expect;
mod hints;
pub mod hysteresis;
pub mod initial;
pub mod joints;
mod lengths;
pub mod links;
pub mod loads;
pub mod materials;
pub mod mesh;
pub mod number_slips;
pub mod output;
pub mod part_damping;
pub mod part_sets;
pub mod part_table;
pub mod parts;
mod profile_sizes;
mod profiles;
pub mod read;
pub mod sections;
pub mod set;
pub mod shells;
pub mod stages;
pub mod study;
pub mod superelements;
pub mod supports;
mod tables;
pub mod ties;
mod value;

pub use base::words;
pub use hints::{kinds_with, missing as remedy_of_missing};
pub use read::{DeckRead, ParsedText, read};

use schemars::JsonSchema;
use serde::Deserialize;

use base::diagnostic::{At, Span};
use words::kinds::OneOf;
use words::{Maybe, Named, Names, Table, Vector};

/// A deck of rdsolve: one scene and how to compute it. Units are SI or any consistent set.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Deck {
    /// Description of the model in one line.
    pub title: Maybe<String>,
    /// System of units: it labels output and turns on warnings about implausible values. Nothing is converted.
    pub units: Maybe<output::Units>,
    /// Kind, duration and steps of the analysis. A deck with `[[stages]]` has stages instead; this table may then hold common values.
    pub analysis: Maybe<Table<analysis::Analysis>>,
    /// Sequence of analyses.
    #[serde(default)]
    pub stages: Vec<At<Table<stages::Stage>>>,
    /// The time integration scheme.
    pub integrator: Maybe<OneOf<analysis::Integrator>>,
    /// How the nonlinear equations of each step are solved.
    pub iteration: Maybe<Table<analysis::Iteration>>,
    /// Materials by name.
    #[serde(default)]
    pub materials: Named<OneOf<materials::Material>>,
    /// Cross sections of beams by name.
    #[serde(default)]
    pub sections: Named<OneOf<sections::Section>>,
    /// Points by name, [x, y, z] at t = 0 in global coordinates; every one becomes a node.
    #[serde(default)]
    pub points: Named<Vector>,
    /// A mesh from a file.
    pub mesh: Maybe<Table<mesh::Mesh>>,
    /// Lists of names under one name: points, bodies, beams, bars, shells and their edges, groups of the mesh, other sets.
    #[serde(default)]
    pub sets: Named<Names>,
    /// Beams: shear-flexible, geometrically exact, elastic or yielding.
    #[serde(default)]
    pub beams: Vec<At<Table<beams::Beam>>>,
    /// Bars and cables: axial force alone.
    #[serde(default)]
    pub bars: Vec<At<Table<bars::Bar>>>,
    /// Shells: patches of triangles or quadrilaterals.
    #[serde(default)]
    pub shells: Vec<At<Table<shells::Shell>>>,
    /// Superelements: parts by matrices from files.
    #[serde(default)]
    pub superelements: Vec<At<Table<superelements::Superelement>>>,
    /// Beams and shells that are reduced together.
    #[serde(default, rename = "parts")]
    pub part_sets: Vec<At<Table<part_sets::PartSet>>>,
    /// Rigid bodies.
    #[serde(default)]
    pub bodies: Vec<At<Table<bodies::Body>>>,
    /// Point masses.
    #[serde(default)]
    pub masses: Vec<At<Table<bodies::Mass>>>,
    /// Nodes rigidly attached to bodies or beams.
    #[serde(default)]
    pub attachments: Vec<At<Table<attachments::Attachment>>>,
    /// Nodes tied to faces or nodes beside them.
    #[serde(default)]
    pub ties: Vec<At<Table<ties::Tie>>>,
    /// Restrained and prescribed degrees of freedom.
    #[serde(default)]
    pub supports: Vec<At<Table<supports::Support>>>,
    /// Joints between bodies or points: spherical, revolute, prismatic and others.
    #[serde(default)]
    pub joints: Vec<At<OneOf<joints::Joint>>>,
    /// Links whose length is driven. Reading makes joints of the kind "actuator" of them.
    #[serde(default)]
    pub actuators: Vec<At<Table<actuators::Actuator>>>,
    /// Springs, dampers, gaps and bushings between two points.
    #[serde(default)]
    pub links: Vec<At<Table<links::Link>>>,
    /// Unilateral contact with friction and impact between points and surfaces.
    #[serde(default)]
    pub contacts: Vec<At<Table<contacts::Contact>>>,
    /// Linear equations between displacements.
    #[serde(default)]
    pub equations: Vec<At<Table<equations::Equation>>>,
    /// Forces, moments and distributed loads.
    #[serde(default)]
    pub loads: Vec<At<Table<loads::Load>>>,
    /// Load cases of a linear analysis.
    #[serde(default)]
    pub load_cases: Vec<At<Table<cases::LoadCase>>>,
    /// Combinations of load cases.
    #[serde(default)]
    pub combinations: Vec<At<Table<cases::Combination>>>,
    /// Envelopes of results over load cases and combinations.
    #[serde(default)]
    pub envelopes: Vec<At<Table<cases::Envelope>>>,
    /// Functions of time by name, for loads and prescribed motion.
    #[serde(default)]
    pub amplitudes: Named<Table<amplitudes::Amplitude>>,
    /// Gravity and accelerations of the ground.
    pub environment: Maybe<Table<environment::Environment>>,
    /// Velocities at t = 0.
    #[serde(default)]
    pub initial: Vec<At<Table<initial::Initial>>>,
    /// Rayleigh damping, and dampers to the ground.
    pub damping: Maybe<Table<environment::Damping>>,
    /// Values that the run must reach; a miss ends it with exit code 5.
    #[serde(default)]
    pub expect: Vec<At<Table<expect::Expect>>>,
    /// Relative displacements of two points, as the drift of a storey.
    #[serde(default)]
    pub drifts: Vec<At<Table<drifts::Drift>>>,
    /// Which results are written, and how often.
    pub output: Maybe<Table<output::Output>>,
    /// Settings of `rdsolve study`; a run ignores them.
    pub study: Maybe<Table<study::Study>>,
    /// Entries that are written but could not be read: not missing, and already reported.
    #[serde(skip)]
    pub spoiled: Vec<Spoiled>,
}

impl Deck {
    /// The tables that may be limited to stages: supports, joints, links, contacts, then loads. What is carried over from one stage to the
    /// next comes with its name.
    pub fn staged(&self) -> Vec<(Option<&At<String>>, &Maybe<words::Names>)> {
        let mut all: Vec<(Option<&At<String>>, &Maybe<words::Names>)> = Vec::new();
        all.extend(self.supports.iter().map(|table| (None, &table.stages)));
        all.extend(self.joints.iter().map(|table| (table.name.as_ref(), &table.stages)));
        all.extend(self.links.iter().map(|table| (table.name.as_ref(), &table.stages)));
        all.extend(self.contacts.iter().map(|table| (table.name.as_ref(), &table.stages)));
        all.extend(self.loads.iter().map(|table| (None, &table.stages)));
        all.extend(self.environment.iter().map(|table| (None, &table.gravity_stages)));
        all
    }
}

/// An entry taken out of its table because it is wrong.
#[derive(Debug, Clone, PartialEq)]
pub struct Spoiled {
    /// Where its table stands; `None`: somewhere, the text being no TOML there.
    pub table: Option<Span>,
    /// The key of the entry.
    pub key: String,
}
