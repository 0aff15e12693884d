//! Warnings of a run about its results.

use super::friction_warnings::{ContactThrows, SlipBegins};
use base::names::{short, to_digits};
use base::snapshot::{keep, keep_either};
use std::fmt;
use std::mem::discriminant;

/// A doubt about results, with the object concerned.
#[derive(Debug, Clone, PartialEq)]
pub enum Warning {
    /// Initial velocities do not agree with the joints, and were changed.
    InitialVelocities {
        /// The largest change over the largest velocity.
        change: f64,
    },
    /// The error of steps that follow a tolerance exceeds the requested error.
    StepError {
        /// The requested error, relative to the largest motion.
        asked: f64,
        /// The estimated error; `None` where it could not be found.
        estimate: Option<f64>,
    },
    /// Shorter steps bring runs with events no nearer to each other.
    RunsPart {
        /// The requested error, relative to the largest motion.
        asked: f64,
        /// The difference of the last two runs, likewise.
        difference: f64,
    },
    /// A load step converged only to a residual of rounding.
    Unbalanced {
        /// The residual, relative to the forces.
        residual: f64,
    },
    /// Something is pressed into a surface by more than is seen.
    DeepContact {
        /// The name of the contact.
        name: String,
        /// The largest penetration.
        depth: f64,
        /// The smallest dimension of the touching and the touched bodies.
        size: f64,
    },
    /// Load control has passed a load beyond which the equilibrium is unstable.
    Unstable(Instability),
    /// Like `Unstable`, out of the plane of a plane motion.
    UnstableOutOfPlane(Instability),
    /// Modes of the state grow.
    Grows {
        /// The number of modes that do, of those found.
        modes: usize,
        /// The largest rate.
        rate: f64,
        /// Its mode, from 1.
        fastest: usize,
    },
    /// Omissions of modes, in words.
    Modes(String),
    /// Beams press each other side by side.
    SideBySide {
        /// The name of the contact.
        name: String,
    },
    /// A body touches more others than it remembers.
    Crowded {
        /// The name of the contact.
        name: String,
    },
    /// Something lies inside the surface of a contact when that begins to act.
    BeginsClosed {
        /// The name of the contact.
        name: String,
        /// The penetration.
        depth: f64,
    },
    /// A yielding shell is stretched beyond the range of its strain measure.
    LargeStrain {
        /// The name of the shell.
        name: String,
        /// The membrane strain of largest size, of Green.
        strain: f64,
        /// True where the shell yields by logarithmic strain.
        logarithmic: bool,
    },
    /// A rotation that is fixed alone has drifted.
    RotationDrifts {
        /// The name of the node.
        label: String,
        /// The direction that is fixed.
        direction: &'static str,
        /// The largest drift in radians.
        drift: f64,
    },
    /// Steps that do not resolve a contact throw off a resting body.
    ContactThrows(ContactThrows),
    /// Slip begins again with a velocity that it should not have.
    SlipBegins(SlipBegins),
    /// The critical time step is below the value that mass scaling gave to elements.
    ScaledStep {
        /// The critical time step that elements were given.
        wanted: f64,
        /// The critical time step of the scene.
        longest: f64,
        /// The node that its fastest motion moves most.
        label: String,
        /// The link or contact with most of the stiffness of that motion; empty if there is none.
        cause: String,
    },
}

keep_either!(Warning {
    0 => InitialVelocities { change },
    1 => StepError { asked, estimate },
    2 => Unbalanced { residual },
    3 => DeepContact { name, depth, size },
    4 => Unstable(instability),
    5 => UnstableOutOfPlane(instability),
    6 => Grows { modes, rate, fastest },
    7 => Modes(warnings),
    8 => SideBySide { name },
    9 => BeginsClosed { name, depth },
    10 => LargeStrain { name, strain, logarithmic },
    11 => Crowded { name },
    12 => ScaledStep { wanted, longest, label, cause },
    13 => RotationDrifts { label, direction, drift },
    14 => RunsPart { asked, difference },
    16 => ContactThrows(what),
    15 => SlipBegins(what),
});

/// The time and the mode of an instability.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Instability {
    /// Time of buckling in the first mode, estimated between the ends of a step; the start of the step if it was already unstable.
    pub time: f64,
    /// True where the start of the step was unstable already.
    pub already: bool,
    /// False where loads have no potential or friction slips, and memory does for the symmetric part of the tangent alone: the equilibrium may
    /// be stable yet.
    pub certain: bool,
    /// Number of unstable modes at the end of that step.
    pub modes: usize,
    /// Time at the end of that step.
    pub seen: f64,
    /// The node that the mode moves most, and the direction.
    pub label: String,
    pub direction: &'static str,
    /// The name of the film whose flat elements fold there; empty elsewhere.
    pub film: String,
}

keep!(Instability: Default { time, already, certain, modes, seen, label, direction, film });

/// The message of an error of the steps above the requested one.
fn step_error(asked: f64, estimate: Option<f64>) -> String {
    let asked = short(asked);
    match estimate.map(short) {
        Some(estimate) => format!(
            "the steps leave an error of about {estimate} of the largest motion, more than the {asked} of `error_tolerance`: the motion \
             magnifies errors of single steps. Ask for less error, or take the results as one motion of many"
        ),
        None => format!(
            "whether the error is below the {asked} of `error_tolerance` is not known: the run with longer steps that would tell did not come \
             to its end. Compare with a run at a smaller `error_tolerance`"
        ),
    }
}

/// The message of a load step that ends with a residual of rounding.
fn unbalanced(residual: f64) -> String {
    format!(
        "a load step ends with unbalanced forces of {} of the largest: displacements are so small, or \
         stiffnesses so far apart, that rounding hides what is missing, and reactions and stresses are no better; \
         larger loads, or stiffnesses nearer to each other, keep their digits",
        short(residual)
    )
}

/// The message of runs with events that do not converge to each other.
fn runs_part(asked: f64, difference: f64) -> String {
    format!(
        "two runs differ by {} of the largest motion, and shorter steps have brought them no nearer to each other. Events such as impacts or \
         slip magnify small errors here. No error bars are given, and the error may exceed the {} of `error_tolerance`: take the results \
         as one motion of many, or end the run before the events (`end_time`)",
        short(difference),
        short(asked)
    )
}

/// The message of a shell with large strain; the stress conjugate to Green's strain makes forces wrong by the square of the stretch.
fn large_strain(shell: &str, strain: f64, logarithmic: bool) -> String {
    let square = (1.0 + 2.0 * strain).max(0.0);
    if logarithmic {
        return format!(
            "shell `{shell}` is brought to {} of its length somewhere: the series for its logarithmic strain is for 0.75 to 1.34, and the \
             forces of what yields there are off by more than a hundredth. Such strains are beyond what shells compute",
            to_digits(square.sqrt(), 3)
        );
    }
    let wrong = 100.0 * (square - 1.0).abs();
    format!(
        "shell `{shell}` is {} to {} of its length somewhere: where it yields in its surface its forces are too {} there by some {} %, for \
         strains are taken as small. Give it `strain = \"logarithmic\"`",
        if strain > 0.0 { "stretched" } else { "pressed" },
        to_digits(square.sqrt(), 3),
        if strain > 0.0 { "large" } else { "small" },
        to_digits(wrong, 2)
    )
}

/// The message of a drift of a single fixed rotation.
fn drifted(node: &str, direction: &str, drift: f64) -> String {
    format!(
        "{direction} of `{node}` is fixed alone and has drifted to {} radians: such a rotation is a component of each step's rotation vector, and \
         `{node}` turns about other axes too. Give its support `rotation = \"vector\"`, which keeps the total at zero",
        to_digits(drift, 2)
    )
}

/// The message of corrected initial velocities; `change` is relative to the largest velocity.
fn corrected(change: f64) -> String {
    let part = short(change);
    format!("initial velocities violate the joints: they were corrected by up to {part} of the largest velocity")
}

/// The message of a contact with an initial penetration.
fn begins_closed(contact: &str, depth: f64) -> String {
    format!(
        "contact `{contact}` begins closed in this stage: something lies {} inside the surface where the stages before have left it, and is \
         thrown out by energy that nothing has brought. Place what strikes farther away, or let the contact act from earlier on",
        short(depth)
    )
}

/// The message of a body that touches more others than its history can hold.
fn crowded(contact: &str) -> String {
    format!(
        "contact `{contact}`: a body touches more than 32 others at once that are as large as it is or larger. Those beyond press it all the \
         same, but without friction, and what an impact gives back is not that of the deck. Give them contacts of two: \
         surface = {{ body = ... }} with the others in `with`"
    )
}

/// The message of a critical time step below the value given to elements.
fn scaled_step([wanted, longest]: [f64; 2], label: &str, cause: &str) -> String {
    let cause = match cause {
        "" => "elements have become shorter or stiffer, or have no mass where they are attached, or dampers are stiff"
            .to_owned(),
        name => format!("`{name}` asks for it"),
    };
    format!(
        "the critical time step is {}, below the {} of `mass_scaling_step`, which bounds that of elements alone: {cause}, in a motion of `{label}` \
         most of all. A `mass_scaling_step` of that adds less mass and loses no time",
        short(longest),
        short(wanted)
    )
}

/// The message of beams that press each other side by side.
fn side_by_side(contact: &str) -> String {
    format!(
        "contact `{contact}`: beams, bars or edges press each other side by side. Each pair of elements touches in one point, which jumps from \
         end to end of where they are alongside: forces are rough, and energies wrong, whatever the step. Name a set of the nodes of one of them \
         in `with`, which touch as points"
    )
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Warning::Unstable(Instability { time, already, certain, modes, seen, label, direction, .. }) => write!(
                f,
                "the equilibrium {} unstable {} t = {} on, where the structure buckles: the mode moves `{label}` most, in \
                 direction {direction} (negative eigenvalues of the tangent: {modes}, at t = {}). What follows is not what a \
                 structure does; follow the path that buckles by a small load or an offset in that direction, with `control` = \
                 \"arc-length\" where the load falls",
                if *certain { "is" } else { "may be" },
                if *already { "already from" } else { "from" },
                short(*time),
                short(*seen)
            ),
            Warning::UnstableOutOfPlane(Instability {
                time, already, certain, modes, seen, label, direction, ..
            }) => {
                write!(
                    f,
                    "the structure {} out of its plane at t = {}{}: the mode moves `{label}` most, in direction {direction} \
                 (negative eigenvalues of the tangent out of the plane: {modes}, at t = {}). What follows holds only where \
                 something keeps it in its plane; give a small load or an offset in that direction to follow the motion out of \
                 it, or hold it there",
                    if *certain { "buckles" } else { "may buckle" },
                    short(*time),
                    if *already { " or before" } else { "" },
                    short(*seen)
                )
            }
            Warning::Unbalanced { residual } => f.write_str(&unbalanced(*residual)),
            Warning::DeepContact { name, depth, size } => write!(
                f,
                "contact `{name}` is pressed in by up to {}, {} % of the smallest dimension of what meets there: bodies are in each \
                 other, and where and when they meet is no better than that; give it a larger `stiffness`",
                short(*depth),
                to_digits(100.0 * depth / size, 2)
            ),
            Warning::Grows { modes, rate, fastest } => write!(
                f,
                "the state is unstable: mode {fastest} grows with rate {} ({modes} of the modes found grow)",
                to_digits(*rate, 4)
            ),
            Warning::Modes(warnings) => f.write_str(warnings),
            Warning::RotationDrifts { label, direction, drift } => f.write_str(&drifted(label, direction, *drift)),
            Warning::LargeStrain { name, strain, logarithmic } => {
                f.write_str(&large_strain(name, *strain, *logarithmic))
            }
            Warning::SideBySide { name } => f.write_str(&side_by_side(name)),
            Warning::ContactThrows(what) => write!(f, "{what}"),
            Warning::SlipBegins(what) => write!(f, "{what}"),
            Warning::Crowded { name } => f.write_str(&crowded(name)),
            Warning::ScaledStep { wanted, longest, label, cause } => {
                f.write_str(&scaled_step([*wanted, *longest], label, cause))
            }
            Warning::BeginsClosed { name, depth } => f.write_str(&begins_closed(name, *depth)),
            Warning::StepError { asked, estimate } => f.write_str(&step_error(*asked, *estimate)),
            Warning::RunsPart { asked, difference } => f.write_str(&runs_part(*asked, *difference)),
            Warning::InitialVelocities { change } => f.write_str(&corrected(*change)),
        }
    }
}

/// The warnings of a run, only the first of each kind.
#[derive(Debug, Clone, Default)]
pub struct Warnings {
    warnings: Vec<Warning>,
    remarks: Vec<Remark>,
    /// For central differences, the sums of (ω Δt)² v² and of v² by modes over all steps, which show whether steps resolve the motion.
    pub(super) resisted: [f64; 2],
}

keep!(Warnings: Default { warnings, remarks, resisted });

impl Warnings {
    /// Adds a warning, unless there is one of its kind already.
    pub fn add(&mut self, warning: Warning) {
        if self.warnings.iter().all(|known| discriminant(known) != discriminant(&warning)) {
            self.warnings.push(warning);
        }
    }

    /// True where one of a kind is known.
    pub fn knows(&self, is_of_kind: impl Fn(&Warning) -> bool) -> bool {
        self.warnings.iter().any(is_of_kind)
    }

    /// Adds the penetration of a contact, or keeps it if it is relatively deeper than the known one.
    pub fn deepen(&mut self, contact: &str, depth: f64, size: f64) {
        let known = self.warnings.iter_mut().find_map(|known| match known {
            Warning::DeepContact { name, depth, size } => Some((name, depth, size)),
            _ => None,
        });
        match known {
            None => self.warnings.push(Warning::DeepContact { name: contact.to_owned(), depth, size }),
            Some((name, old, of)) if depth / size > *old / *of => {
                contact.clone_into(name);
                (*old, *of) = (depth, size);
            }
            Some(_) => {}
        }
    }

    /// Adds the strain of a shell, logarithmic or not, or keeps it if it is larger than the known one.
    pub fn stretch(&mut self, shell: &str, (strain, logarithmic): (f64, bool)) {
        let known = self.warnings.iter_mut().find_map(|known| match known {
            Warning::LargeStrain { name, strain, logarithmic } => Some((name, strain, logarithmic)),
            _ => None,
        });
        match known {
            None => self.warnings.push(Warning::LargeStrain { name: shell.to_owned(), strain, logarithmic }),
            Some((name, old, of)) if strain.abs() > old.abs() => {
                shell.clone_into(name);
                (*old, *of) = (strain, logarithmic);
            }
            Some(_) => {}
        }
    }

    /// Adds the drift of a rotation, or keeps it if it is larger than the known one.
    pub fn drift(&mut self, node: &str, fixed: &'static str, size: f64) {
        let known = self.warnings.iter_mut().find_map(|known| match known {
            Warning::RotationDrifts { label, direction, drift } => Some((label, direction, drift)),
            _ => None,
        });
        match known {
            None => {
                let (label, direction, drift) = (node.to_owned(), fixed, size);
                self.warnings.push(Warning::RotationDrifts { label, direction, drift });
            }
            Some((label, direction, drift)) if size > *drift => {
                node.clone_into(label);
                (*direction, *drift) = (fixed, size);
            }
            Some(_) => {}
        }
    }

    /// Adds a warning, if there is one.
    pub fn extend(&mut self, warning: Option<Warning>) {
        if let Some(warning) = warning {
            self.add(warning);
        }
    }

    /// Adds a remark, unless it was made already.
    pub fn remark(&mut self, remark: Remark) {
        if !self.remarks.contains(&remark) {
            self.remarks.push(remark);
        }
    }

    /// The remarks in order of occurrence.
    pub fn remarks(&self) -> &[Remark] {
        &self.remarks
    }

    /// The warnings in order of occurrence.
    pub fn iter(&self) -> impl Iterator<Item = &Warning> {
        self.warnings.iter()
    }
}

/// Limits of checks, or slow algorithms, which a run reports in its log; they do not question results.
#[derive(Debug, Clone, PartialEq)]
pub enum Remark {
    /// Nothing restrains motion out of the plane at these places at t = 0: buckling is judged as if supports did.
    JudgedAsHeld {
        /// Nodes and directions.
        places: Vec<(String, &'static str)>,
    },
    /// Hardly anything holds the scene in its plane: buckling out of it is not judged.
    NotHeld {
        /// An unrestrained node, and the direction.
        place: (String, &'static str),
    },
    /// A plane scene has joints: buckling out of it is not judged.
    Jointed,
    /// Something slips along a path of given arc length: its stability is not judged.
    Slipping,
    /// The factor of the matrix lies in a file; where, in words.
    FactorInFile(String),
}

keep_either!(Remark {
    0 => JudgedAsHeld { places },
    1 => NotHeld { place },
    2 => Jointed,
    3 => Slipping,
    4 => FactorInFile(place),
});

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Remark::JudgedAsHeld { places } => {
                let place = |(label, direction): &(String, &str)| format!("`{label}` in direction {direction}");
                let places: Vec<String> = places.iter().map(place).collect();
                write!(
                    f,
                    "motion out of the plane is not held: buckling out of it is judged as if a support held {}",
                    places.join(", ")
                )
            }
            Remark::NotHeld { place: (label, direction) } => write!(
                f,
                "motion out of the plane is not held at `{label}` in direction {direction}: buckling out of it is not judged"
            ),
            Remark::Jointed => {
                f.write_str(
                    "whether the scene falls or buckles out of its plane is not judged where there are joints: `plane` = \"off\" judges it",
                )
            }
            Remark::FactorInFile(place) => f.write_str(place),
            Remark::Slipping => f.write_str(
                "friction slips along the path: whether equilibria are stable is not judged there; load steps judge it",
            ),
        }
    }
}
