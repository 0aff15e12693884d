//! The content of a file, before sets and instances are resolved.

use crate::contact_content::{ContactCards, ModelChange};
use crate::material_table::MaterialTable;
use crate::scopes::NamedTarget;
use crate::tied_nodes::NodalAxes;
use crate::time_formula::TimeFormula;
use base::math::Vec3;

/// A material as the file has it.
#[derive(Debug, Clone, Default)]
pub struct MaterialCard {
    /// Its name.
    pub name: String,
    /// Its line.
    pub line: usize,
    /// Young's modulus and Poisson's ratio.
    pub elastic: Option<[f64; 2]>,
    /// Stress and plastic strain.
    pub plastic: Vec<[f64; 2]>,
    /// True where the hardening is kinematic.
    pub is_kinematic: bool,
    /// Density.
    pub density: Option<f64>,
    /// Rayleigh's alpha and beta.
    pub damping: Option<[f64; 2]>,
    /// Rate and exponent of an overstress.
    pub rate: Option<[f64; 2]>,
    /// Coefficient of thermal expansion, and its line.
    pub expansion: Option<(f64, usize)>,
    /// Values that depend on temperature.
    pub tables: Vec<MaterialTable>,
    /// The line of `*NO COMPRESSION`, for bars under tension alone.
    pub no_compression: Option<usize>,
}

/// The materials of a file.
#[derive(Debug, Default)]
pub struct MaterialCards {
    /// The materials; the last one is still being read.
    pub list: Vec<MaterialCard>,
}

impl MaterialCards {
    /// The material of a name, the last where there are several.
    pub fn find(&self, name: &str) -> Option<&MaterialCard> {
        self.list.iter().rfind(|material| material.name.to_lowercase() == name.to_lowercase())
    }
}

/// A section as the file has it.
#[derive(Debug, Clone)]
pub struct SectionCard {
    /// Its line.
    pub line: usize,
    /// Its elements.
    pub target: NamedTarget,
    /// The name of its material.
    pub material: String,
    /// What it is.
    pub what: SectionOf,
    /// The name of a system of axes.
    pub orientation: Option<String>,
}

/// The elements of a section.
#[derive(Debug, Clone, PartialEq)]
pub enum SectionOf {
    /// Of beams: keys of a table of `[sections]`, and the direction of the first axis.
    Beam {
        /// Keys of the table and their values.
        keys: Vec<(&'static str, SectionValue)>,
        /// The direction of the first axis.
        n1: Vec3,
        /// How far the axis lies off the nodes, along the first and the second axis of the section.
        offset: [f64; 2],
    },
    /// Of shells.
    Shell {
        /// The thickness; `None` where nodes have their own.
        thickness: Option<f64>,
        /// Points through the thickness.
        points: Option<u64>,
        /// How far the nodes lie off the middle surface, along the normal, over the thickness.
        offset: f64,
    },
    /// Of bars: the area. Solids are refused by their type.
    Bar(f64),
}

/// A value of a section.
#[derive(Debug, Clone, PartialEq)]
pub enum SectionValue {
    /// A word.
    Word(&'static str),
    /// A number.
    Number(f64),
    /// Several numbers.
    Numbers(Vec<f64>),
}

/// What a property is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PropertyOf {
    /// Masses.
    Mass,
    /// Moments of inertia.
    Inertia,
    /// Springs.
    Spring,
    /// Dampers.
    Damper,
    /// Gaps.
    Gap,
    /// Springs and dampers along local axes: a row of stiffnesses, a row of damping.
    Joint,
}

/// A property as the file has it.
#[derive(Debug, Clone)]
pub struct PropertyCard {
    /// What it is.
    pub of: PropertyOf,
    /// Its line.
    pub line: usize,
    /// Its elements.
    pub target: NamedTarget,
    /// True for a force by elongation.
    pub is_nonlinear: bool,
    /// The name of a system of axes.
    pub orientation: Option<String>,
    /// The rows below, blank lines left out by the reader of lines.
    pub rows: Vec<Vec<f64>>,
    /// True where a first row has nothing but whole numbers, the degrees of freedom.
    pub has_degrees: bool,
}

/// A body that nodes are attached to.
#[derive(Debug, Clone)]
pub struct RigidCard {
    /// Its line.
    pub line: usize,
    /// Its name in the deck.
    pub name: String,
    /// The reference node.
    pub reference: NamedTarget,
    /// The node whose displacements are the rotations of the body, in CalculiX.
    pub rotations: Option<NamedTarget>,
    /// Nodes that go with it in all directions.
    pub tied: Vec<NamedTarget>,
    /// The surface of a coupling, whose nodes go with it too.
    pub surface: Option<NamedTarget>,
    /// Nodes whose translations alone go with it.
    pub pinned: Vec<NamedTarget>,
    /// Elements that are part of it.
    pub cells: Vec<NamedTarget>,
    /// Degrees of freedom of a coupling, from 0 to 5; all where it is empty.
    pub degrees: Vec<usize>,
    /// True for a coupling, which has no mass.
    pub is_coupling: bool,
}

/// A constraint of several points.
#[derive(Debug, Clone)]
pub struct PointsCard {
    /// Its line.
    pub line: usize,
    /// Its kind in capitals.
    pub kind: String,
    /// Its nodes.
    pub nodes: Vec<NamedTarget>,
}

/// A linear equation between degrees of freedom.
#[derive(Debug, Clone)]
pub struct EquationCard {
    /// Its line.
    pub line: usize,
    /// Node, degree of freedom from 0 to 5, coefficient.
    pub terms: Vec<(NamedTarget, usize, f64)>,
}

/// A coupling that spreads the forces at a node over others.
#[derive(Debug, Clone)]
pub struct DistributingCard {
    /// Its line.
    pub line: usize,
    /// The reference node, ...
    pub reference: Option<NamedTarget>,
    /// ... or the set with one element there.
    pub cells: Option<NamedTarget>,
    /// The surface whose nodes have the same weight, ...
    pub surface: Option<NamedTarget>,
    /// ... or nodes and their weights.
    pub nodes: Vec<(NamedTarget, f64)>,
    /// Degrees of freedom of the reference node, from 0 to 5; all where it is empty.
    pub degrees: Vec<usize>,
}

/// A coupling whose kind stands on a later line.
#[derive(Debug, Clone)]
pub struct OpenCoupling {
    /// Its line.
    pub line: usize,
    /// Its name in the deck.
    pub name: String,
    /// The reference node.
    pub reference: NamedTarget,
    /// Its surface.
    pub surface: NamedTarget,
    /// True where its degrees of freedom are along other axes than the global ones.
    pub is_turned: bool,
}

/// A pre-tension section of a beam.
#[derive(Debug, Clone)]
pub struct PretensionCard {
    /// Its line.
    pub line: usize,
    /// The beam.
    pub element: NamedTarget,
    /// The node whose first degree of freedom is that of the section.
    pub node: NamedTarget,
    /// The normal of the section; `None` along the beam.
    pub normal: Option<Vec3>,
    /// True where the normal turns with the beam.
    pub is_follower: bool,
}

/// All constraints of a file.
#[derive(Debug, Default)]
pub struct ConstraintCards {
    /// Bodies and couplings.
    pub rigid: Vec<RigidCard>,
    /// `*MPC`.
    pub points: Vec<PointsCard>,
    /// `*EQUATION`.
    pub equations: Vec<EquationCard>,
    /// `*TRANSFORM`: nodes, and the axes there.
    pub transforms: Vec<(NamedTarget, NodalAxes)>,
    /// `*TIE`.
    pub ties: Vec<TieCard>,
    /// Couplings that spread forces.
    pub distributing: Vec<DistributingCard>,
    /// Pre-tension sections.
    pub pretensions: Vec<PretensionCard>,
    /// Contacts.
    pub contacts: ContactCards,
    /// The coupling at hand.
    pub open: Option<OpenCoupling>,
}

/// Two surfaces that are tied.
#[derive(Debug, Clone)]
pub struct TieCard {
    /// Its line.
    pub line: usize,
    /// Its name.
    pub name: String,
    /// The surface whose nodes are tied, and the one that they are tied to.
    pub surfaces: [NamedTarget; 2],
    /// The distance of the tie.
    pub tolerance: Option<f64>,
    /// True where translations alone are tied.
    pub is_hinge: bool,
    /// True where the other program moves tied nodes onto the faces.
    pub is_adjusted: bool,
}

/// A connector section.
#[derive(Debug, Clone)]
pub struct ConnectorSection {
    /// Its line.
    pub line: usize,
    /// Its elements.
    pub target: NamedTarget,
    /// Its types in capitals: HINGE, or CARTESIAN and CARDAN.
    pub kinds: Vec<String>,
    /// The name of its axes at the first node.
    pub orientation: Option<String>,
    /// The name of its behaviour.
    pub behavior: Option<String>,
}

/// The laws along the components of a connector, by component from 0 to 5.
#[derive(Debug, Clone, Default)]
pub struct ConnectorBehavior {
    /// Its name in small letters.
    pub name: String,
    /// Stiffness.
    pub stiffness: [Option<f64>; 6],
    /// Damping.
    pub damping: [Option<f64>; 6],
    /// Least and greatest coordinate.
    pub stops: [Option<[f64; 2]>; 6],
}

/// A motion or a load of connectors in a step.
#[derive(Debug, Clone)]
pub struct ConnectorDrive {
    /// Its line.
    pub line: usize,
    /// Its elements.
    pub target: NamedTarget,
    /// The component, from 0 to 5.
    pub component: usize,
    /// The value.
    pub value: f64,
    /// The name of an amplitude.
    pub amplitude: Option<String>,
    /// "position", "velocity" or "acceleration"; `None` for a load.
    pub quantity: Option<&'static str>,
}

/// All connectors of a file.
#[derive(Debug, Default)]
pub struct ConnectorCards {
    /// Sections.
    pub sections: Vec<ConnectorSection>,
    /// Behaviours; the last one is still being read.
    pub behaviors: Vec<ConnectorBehavior>,
    /// Motions and loads.
    pub drives: Vec<ConnectorDrive>,
}

/// A function of time as the file has it.
#[derive(Debug, Clone, Default)]
pub struct AmplitudeCard {
    /// Its name.
    pub name: String,
    /// Its line.
    pub line: usize,
    /// Times and values; none with a formula.
    pub points: Vec<[f64; 2]>,
    /// A formula instead of times and values.
    pub formula: Option<TimeFormula>,
    /// True where times count from the start of the run.
    pub is_total: bool,
    /// The phase in degrees of a steady motion, which has no times.
    pub harmonic: Option<f64>,
}

impl AmplitudeCard {
    /// The value at a time.
    pub fn at(&self, t: f64) -> f64 {
        if let Some(formula) = &self.formula {
            return formula.at(t);
        }
        let after = self.points.partition_point(|point| point[0] <= t);
        match (after.checked_sub(1).map(|at| self.points[at]), self.points.get(after)) {
            (None, first) => first.map_or(0.0, |first| first[1]),
            (Some(last), None) => last[1],
            (Some(a), Some(b)) => a[1] + (b[1] - a[1]) * (t - a[0]) / (b[0] - a[0]),
        }
    }

    /// The same with times from here on.
    pub fn seen_from(&self, now: f64) -> AmplitudeCard {
        let mut card = self.clone();
        card.points.iter_mut().for_each(|point| point[0] -= now);
        card.formula = self.formula.as_ref().map(|formula| formula.seen_from(now));
        card
    }

    /// The corners in time of a step of this length, from 0 to its end.
    pub fn corners(&self, duration: f64) -> Vec<f64> {
        let mut times = match &self.formula {
            Some(formula) => formula.times(duration),
            None => self.points.iter().map(|point| point[0]).collect(),
        };
        times.retain(|t| *t > 0.0 && *t < duration);
        times.extend([0.0, duration]);
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }
}

/// What a step computes.
#[derive(Debug, Clone, PartialEq)]
pub enum StepProcedure {
    /// Load steps: the first, and the length of the step.
    Static { step: f64, duration: f64, is_riks: bool },
    /// Motion in time.
    Dynamic { step: Option<f64>, duration: f64, alpha: f64, is_explicit: bool, mass_scaling: Option<f64> },
    /// Natural modes: number, highest frequency, complex.
    Frequency { count: Option<u64>, up_to: Option<f64>, is_complex: bool },
    /// Buckling factors.
    Buckle { count: u64 },
    /// Steady motion under harmonic loads.
    Response(ResponseCard),
}

/// The frequencies of a steady motion, and how it is found.
#[derive(Debug, Clone, PartialEq)]
pub struct ResponseCard {
    /// The lowest and the highest frequency.
    pub range: [f64; 2],
    /// So many of them.
    pub points: u64,
    /// True where they are spaced by equal factors.
    pub is_logarithmic: bool,
    /// True where they are gathered about natural frequencies.
    pub is_gathered: bool,
    /// True where the equations are solved at each frequency, false where modes add up.
    pub is_direct: bool,
    /// The number of modes, or the highest of their frequencies.
    pub modes: (Option<u64>, Option<f64>),
}

/// Damping by modes in a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DampingOfModes {
    /// The damping ratio of all modes.
    Ratio(f64),
    /// Rayleigh's alpha and beta.
    Rayleigh([f64; 2]),
}

/// A support on a line of `*BOUNDARY`.
#[derive(Debug, Clone)]
pub struct SupportLine {
    /// Its line.
    pub line: usize,
    /// Its nodes.
    pub target: NamedTarget,
    /// Degrees of freedom, from 0 to 5.
    pub degrees: Vec<usize>,
    /// The value.
    pub value: f64,
    /// The name of an amplitude.
    pub amplitude: Option<String>,
    /// "displacement", "velocity" or "acceleration".
    pub history: &'static str,
    /// True for the imaginary part of a steady motion.
    pub is_imaginary: bool,
    /// True where it holds the position reached so far.
    pub is_fixed: bool,
}

/// A force on a line of `*CLOAD`.
#[derive(Debug, Clone)]
pub struct ForceLine {
    /// Its line.
    pub line: usize,
    /// Its nodes.
    pub target: NamedTarget,
    /// Degree of freedom, from 0 to 5.
    pub degree: usize,
    /// The value.
    pub value: f64,
    /// The name of an amplitude.
    pub amplitude: Option<String>,
    /// True where it turns with its node.
    pub is_follower: bool,
    /// True for the imaginary part of a steady motion.
    pub is_imaginary: bool,
}

/// A temperature on a line of `*TEMPERATURE` or of initial conditions.
#[derive(Debug, Clone)]
pub struct TemperatureLine {
    /// Its line.
    pub line: usize,
    /// Its nodes.
    pub target: NamedTarget,
    /// The temperature, and its gradients along the first and the second axis of the section.
    pub values: [f64; 3],
    /// The name of an amplitude.
    pub amplitude: Option<String>,
}

/// A distributed load on a line of `*DLOAD` or `*DSLOAD`.
#[derive(Debug, Clone)]
pub struct SpreadLine {
    /// Its line.
    pub line: usize,
    /// Its elements, or its surface.
    pub target: NamedTarget,
    /// True where the target is a surface.
    pub is_surface: bool,
    /// Its kind in capitals: P, PX, GRAV.
    pub kind: String,
    /// Magnitude, then further numbers.
    pub values: Vec<f64>,
    /// True for the imaginary part of a steady motion.
    pub is_imaginary: bool,
    /// True where it keeps its direction at large displacements.
    pub is_fixed: bool,
    /// The name of an amplitude.
    pub amplitude: Option<String>,
}

impl SpreadLine {
    /// True for a load along edges of shells.
    pub fn is_on_edges(&self) -> bool {
        self.kind.starts_with("ED")
    }
}

/// The output requested by a step.
#[derive(Debug, Clone, Copy, Default)]
pub struct Requests {
    /// Displacements and velocities.
    pub nodes: bool,
    /// Reactions.
    pub reactions: bool,
    /// Stress resultants.
    pub sections: bool,
    /// Files of the deformed shape.
    pub fields: bool,
}

/// A step, or the lines before the first step.
#[derive(Debug, Clone, Default)]
pub struct StepCard {
    /// Its line.
    pub line: usize,
    /// Its name.
    pub name: String,
    /// True with large displacements, false without; `None` where neither this step nor one before says so.
    pub nonlinear: Option<bool>,
    /// True for a perturbation of the state before.
    pub is_perturbation: bool,
    /// True or false where loads without an amplitude jump or ramp against the custom of the procedure.
    pub jumps: Option<bool>,
    /// Its procedure, with the line.
    pub procedure: Option<(StepProcedure, usize)>,
    /// Its supports.
    pub supports: Vec<SupportLine>,
    /// True where earlier supports end.
    pub new_supports: bool,
    /// Its forces.
    pub forces: Vec<ForceLine>,
    /// True where earlier forces end.
    pub new_forces: bool,
    /// Its distributed loads.
    pub spread: Vec<SpreadLine>,
    /// True where earlier distributed loads end.
    pub new_spread: bool,
    /// Its temperatures.
    pub temperatures: Vec<TemperatureLine>,
    /// True where earlier temperatures end.
    pub new_temperatures: bool,
    /// Contact pairs and elements that come or go.
    pub changes: Vec<ModelChange>,
    /// Damping by modes, its line, and the last mode with it, counted without gaps from the first.
    pub damping: Option<(DampingOfModes, usize, u64)>,
}

impl StepCard {
    /// True for a step that advances time.
    pub fn advances_time(&self) -> bool {
        matches!(self.procedure, Some((StepProcedure::Static { .. } | StepProcedure::Dynamic { .. }, _)))
    }

    /// True for a step that advances time at large displacements; later modes are about its final state.
    pub fn is_large(&self) -> bool {
        self.is_nonlinear() && self.advances_time()
    }

    /// True with large displacements, as explicit steps of Abaqus are by default.
    pub fn is_nonlinear(&self) -> bool {
        let is_explicit = matches!(self.procedure, Some((StepProcedure::Dynamic { is_explicit: true, .. }, _)));
        self.nonlinear.unwrap_or(is_explicit)
    }

    /// True where something in it follows an amplitude.
    pub fn has_amplitude(&self) -> bool {
        let supports = self.supports.iter().any(|line| line.amplitude.is_some());
        supports
            || self.forces.iter().any(|line| line.amplitude.is_some())
            || self.spread.iter().any(|line| line.amplitude.is_some())
            || self.temperatures.iter().any(|line| line.amplitude.is_some())
    }
}

/// The acceleration of the ground in a step.
#[derive(Debug, Clone)]
pub struct BaseMotion {
    /// Its line.
    pub line: usize,
    /// The line of its step.
    pub step: usize,
    /// The global axis, 0 to 2.
    pub axis: usize,
    /// The name of its amplitude.
    pub amplitude: String,
    /// The factor of the amplitude.
    pub scale: f64,
    /// True for the imaginary part of a steady motion.
    pub is_imaginary: bool,
}

/// A rigid motion of nodes at the start.
#[derive(Debug, Clone)]
pub struct RotatingNodes {
    /// Its line.
    pub line: usize,
    /// The nodes.
    pub nodes: NamedTarget,
    /// The velocity of the point `about`.
    pub velocity: Vec3,
    /// The angular velocity.
    pub spin: Vec3,
    /// A point of the axis.
    pub about: Vec3,
}

/// All steps of a file.
#[derive(Debug, Default)]
pub struct StepCards {
    /// The lines before the first step.
    pub before: StepCard,
    /// The steps.
    pub list: Vec<StepCard>,
    /// True between `*STEP` and `*END STEP`.
    pub is_open: bool,
    /// Accelerations of the ground.
    pub base_motions: Vec<BaseMotion>,
    /// Temperatures at the start.
    pub first_temperatures: Vec<TemperatureLine>,
    /// The output requested by all steps.
    pub requests: Requests,
    /// Velocities at the start: line, nodes, degree of freedom from 0 to 5, value.
    pub velocities: Vec<(usize, NamedTarget, usize, f64)>,
    /// Rigid motions at the start.
    pub rotations: Vec<RotatingNodes>,
}

impl StepCards {
    /// The step being read, or the lines before the first step.
    pub fn at_hand(&mut self) -> &mut StepCard {
        match self.list.last_mut() {
            Some(step) if self.is_open => step,
            _ => &mut self.before,
        }
    }
}
