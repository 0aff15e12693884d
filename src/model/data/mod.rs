//! The model as plain data, written by the build and read by all later stages.

mod analysis;
mod bar;
mod beam;
mod case;
mod constraints;
mod contact;
mod displacement_target;
mod expect;
mod initial_motion;
mod integrals;
pub mod lattice;
mod link;
mod loading;
mod model;
mod modes;
mod moving_frame;
mod node;
mod output;
mod part;
mod part_answers;
mod reduction;
mod response;
mod shell;
mod stage;
mod step_length;
mod study;
mod superelement;

pub use analysis::{Analysis, AnalysisKind, ElementMasses, Iteration, Solution};
pub use bar::Bar;
pub use beam::{Beam, BeamElement, SectionAt, VariedElement};
pub use case::{CaseActor, CaseTerm, Envelope, LoadCase, LoadCases, YieldLimit};
pub use constraints::{
    Constraints, DependentNode, GivenTurn, JOINT_MAGNITUDES, Joint, JointCoordinate, JointDrive, JointEffort,
    JointOrigin, PrescribedMotion, Restraint,
};
pub use contact::{CarriedSurface, Contact, FacetSurface, TouchedSurface};
pub use deck::analysis::{Gyroscopic, Method, Update};
pub use deck::output::{ContactRows, SectionPlaces};
pub use deck::part_table::MassKind;
pub use deck::parts::{PartIndex, PartKind};
pub use deck::supports::History;
pub use displacement_target::DisplacementTarget;
pub use expect::{Expect, ExpectAt, OverFrequencies, ResponseOf, Tolerance, When};
pub use initial_motion::{GivenVelocity, InitialMotion, PlaceFactor};
pub use integrals::MassIntegrals;
pub use link::{Link, LinkKind, set_coordinate_equations};
pub use loading::{
    BaseAcceleration, Centrifugal, Damping, Load, LoadOrigin, LoadedCoordinate, Loading, NodalDamping, OwnDamping,
    Pressure, RotationAxis, TurningMasses,
};
pub use model::{MeshFile, Model, Origin, RecordFile, Rigid, SectionFacts};
pub use modes::{ModeExtent, ModesAsked};
pub use moving_frame::{MovingFrame, MovingFrames};
pub use node::{Body, DIRECTIONS, Mass, Node};
pub use output::{BETWEEN_SETS, Cadence, Drift, ENVELOPE_ENDS, FieldFiles, FieldFormat, Output, round_up};
pub use part::{Part, PartType, quantities_of};
pub use part_answers::{Drawing, LineElement, LinearSpring, NodalAction, NodeWeights};
pub use reduction::{EQUAL_MODES, ReducedPart, Reduction};
pub use response::{AroundResonances, ResponseAsked, ResponseMethod};
pub use shell::{Shell, ShellElement};
pub use stage::{Actors, RunStage, Stop, StopQuantity};
pub use step_length::{ArcLength, ERROR_TOLERANCE, FEWEST_STEPS, FIRST_STEP, SAFE, SAFE_WHERE_STRUCK, StepLength};
pub use study::{Choice, Quantity, Study};
pub use superelement::Superelement;
