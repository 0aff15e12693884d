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
        /// The stiffness of the contact, one that keeps the penetration small, and the fixed step that this needs; 0 where the present
        /// one will do.
        stiffness: [f64; 3],
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
    /// A superelement or a reduced part is bent too far for its matrices.
    Bent {
        /// Its name.
        name: String,
        /// True for a reduced part.
        reduced: bool,
        /// True where its forces are linear in its frame.
        linear: bool,
        /// The largest rotation of a node in its frame, in radians.
        turn: f64,
    },
    /// Something turns too far for a linear analysis.
    LargeRotation {
        /// The name of the node.
        label: String,
        /// The largest rotation in radians.
        turn: f64,
    },
    /// A material that stays elastic in a linear analysis is stressed beyond its yield stress.
    BeyondYield {
        /// The name of the part.
        name: String,
        /// The largest stress in it.
        stress: f64,
        /// Its yield stress.
        limit: f64,
    },
    /// An elastic beam is strained as no material can be.
    BeyondElastic {
        /// The name of the beam.
        name: String,
        /// The largest normal stress.
        stress: f64,
        /// Its strain.
        strain: f64,
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
    3 => DeepContact { name, depth, size, stiffness },
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
    20 => LargeRotation { label, turn },
    21 => BeyondYield { name, stress, limit },
    22 => Bent { name, reduced, linear, turn },
    23 => BeyondElastic { name, stress, strain },
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
    /// The node that the mode moves most.
    pub label: String,
    /// The direction of that motion, such as "uy".
    pub direction: &'static str,
    /// The name of the film whose flat elements fold there; empty elsewhere.
    pub film: String,
}

keep!(Instability: Default { time, already, certain, modes, seen, label, direction, film });

/// The message of an error of the steps above the requested one.
fn step_error(asked: f64, estimate: Option<f64>) -> String {
    match estimate {
        Some(estimate) => format!(
            "the error of the time steps is about {} of the largest motion, more than `error_tolerance` = {}: this motion amplifies the \
             errors of single steps. Raise `error_tolerance` to {} if that is accurate enough, or end the run earlier (`end_time`)",
            short(estimate),
            short(asked),
            rounded_up(estimate)
        ),
        None => format!(
            "the error of the time steps is unknown, because the comparison run with longer steps did not reach the end. It may exceed \
             `error_tolerance` = {}. Run again with `error_tolerance` = {} and compare the results",
            short(asked),
            short(0.1 * asked)
        ),
    }
}

/// A number rounded up to one digit.
fn rounded_up(number: f64) -> String {
    let unit = 10f64.powf(number.log10().floor());
    to_digits((number / unit).ceil() * unit, 1)
}

/// The message of a load step that ends with a residual of rounding.
fn unbalanced(residual: f64) -> String {
    format!(
        "a load step ends with a residual of {} of the largest force, which is rounding error. Reactions and stresses have the same relative \
         error. Raise the loads, or lower the largest stiffness until it is less than 1e8 times the smallest",
        short(residual)
    )
}

/// The message of runs with events that do not converge to each other.
fn runs_part(asked: f64, difference: f64) -> String {
    format!(
        "two runs with different steps differ by {} of the largest motion, and shorter steps do not reduce the difference. Events such as \
         impacts or slip amplify small errors here. The results have no error bars, and their error may exceed `error_tolerance` = {}. End \
         the run before these events (`end_time`), or compare several runs",
        short(difference),
        short(asked)
    )
}

/// The message of a shell with large strain; the stress conjugate to Green's strain makes forces wrong by the square of the stretch.
fn large_strain(shell: &str, strain: f64, logarithmic: bool) -> String {
    let square = (1.0 + 2.0 * strain).max(0.0);
    let stretch = to_digits(square.sqrt(), 3);
    if logarithmic {
        return format!(
            "shell `{shell}` has a stretch of {stretch}. Its logarithmic strain is a series for stretches from 0.75 to 1.34, and forces of \
             yielding material have an error of more than 1 % beyond. Lower the loads, or thicken the shell there"
        );
    }
    let wrong = 100.0 * (square - 1.0).abs();
    format!(
        "shell `{shell}` has a stretch of {stretch}. Its strains are taken as small, so forces of yielding material are too {} there by about \
         {} %. Give it `strain = \"logarithmic\"`",
        if strain > 0.0 { "large" } else { "small" },
        to_digits(wrong, 2)
    )
}

/// The message of a drift of a single fixed rotation.
fn drifted(node: &str, direction: &str, drift: f64) -> String {
    format!(
        "{direction} of `{node}` is fixed alone and has drifted to {} radians. A single fixed rotation is a component of the rotation vector of \
         each step, and `{node}` rotates about other axes too. Give its support `rotation = \"vector\"`, which keeps the total at zero",
        to_digits(drift, 2)
    )
}

/// The message of corrected initial velocities; `change` is relative to the largest velocity.
fn corrected(change: f64) -> String {
    format!(
        "initial velocities violate the joints by {} of the largest velocity. The run begins with the nearest velocities that satisfy them, \
         listed in nodes.csv and bodies.csv at t = 0. Give these velocities in the deck",
        short(change)
    )
}

/// The message of a contact with a visible penetration.
fn deep_contact(contact: &str, depth: f64, size: f64, [now, enough, step]: [f64; 3]) -> String {
    let step = match step > 0.0 {
        true => format!(", with a `time_step` of {} or less", to_digits(step, 2)),
        false => String::new(),
    };
    format!(
        "contact `{contact}`: the penetration of {} is {} % of the smallest dimension of the touching bodies. The time and the place of touch \
         have errors of this size. Give `stiffness` = {} (now {}){step}",
        short(depth),
        to_digits(100.0 * depth / size, 2),
        to_digits(enough, 2),
        to_digits(now, 3)
    )
}

/// The message of a contact with an initial penetration.
fn begins_closed(contact: &str, depth: f64) -> String {
    format!(
        "contact `{contact}` begins closed in this stage, with a penetration of {}. The penetration will throw the body out and add energy. Let \
         the contact act from an earlier stage on (`stages`), or move the body away by {}",
        short(depth),
        rounded_up(depth)
    )
}

/// The message of a body that touches more others than its history can hold.
fn crowded(contact: &str) -> String {
    format!(
        "contact `{contact}`: a body touches more than 32 other bodies of its size or larger at once. Further ones act without friction and \
         without `restitution`. Give this body a separate contact: surface = {{ body = ... }} with the others in `with`"
    )
}

/// The message of a critical time step below the value given to elements.
fn scaled_step([wanted, longest]: [f64; 2], label: &str, cause: &str) -> String {
    let cause = match cause {
        "" => "Elements have become shorter or stiffer, have no mass at an attachment, or dampers are stiff".to_owned(),
        name => format!("`{name}` limits it"),
    };
    format!(
        "the critical time step is {}, below `mass_scaling_step` = {}, which scales elements alone. {cause}; the limiting motion moves `{label}` \
         most. Give `mass_scaling_step` = {}: less mass is added, and the run is as fast",
        short(longest),
        short(wanted),
        short(longest)
    )
}

/// The message of beams that press each other side by side.
fn side_by_side(contact: &str) -> String {
    format!(
        "contact `{contact}`: beams, bars or edges press each other side by side. Each pair of elements touches in one point, which jumps along \
         the common length, so forces and energies are wrong with any step. List a set of the nodes of one of them in `with`: they touch as \
         points"
    )
}

/// The message of an equilibrium beyond a bifurcation or a limit load.
fn unstable(found: &Instability) -> String {
    let Instability { time, already, certain, modes, seen, label, direction, .. } = found;
    format!(
        "the equilibrium {} unstable {} t = {} on: the structure buckles. The mode moves `{label}` most, in direction {direction}. The tangent has \
         negative eigenvalues: {modes}, at t = {}. Later results are not valid. Add a load of a thousandth of the others at `{label}` in direction \
         {direction}, and give `control` = \"arc-length\" where the load falls",
        if *certain { "is" } else { "may be" },
        if *already { "already from" } else { "from" },
        short(*time),
        short(*seen)
    )
}

/// The message of buckling out of the plane of a plane motion.
fn unstable_out_of_plane(found: &Instability) -> String {
    let Instability { time, already, certain, modes, seen, label, direction, .. } = found;
    format!(
        "the structure {} out of its plane at t = {}{}. The mode moves `{label}` most, in direction {direction}. The tangent out of the plane has \
         negative eigenvalues: {modes}, at t = {}. Later results are valid only if the real structure is held in its plane. Fix {direction} of \
         `{label}` if it is, or else add a load of a thousandth of the others there",
        if *certain { "buckles" } else { "may buckle" },
        short(*time),
        if *already { " or before" } else { "" },
        short(*seen)
    )
}

/// The message of modes that grow.
fn grows(modes: usize, rate: f64, fastest: usize) -> String {
    format!(
        "the state is unstable: mode {fastest} grows with rate {} ({modes} of the modes found grow). A disturbance then multiplies by 2.7 within \
         a time of {}. Add `damping` or stiffness to what this mode moves, or follow the growth with `kind = \"dynamic\"`",
        to_digits(rate, 4),
        to_digits(1.0 / rate, 2)
    )
}

impl Warning {
    /// The time after which results are not valid; `None` for other warnings than a certainly unstable equilibrium.
    pub fn unstable_from(&self) -> Option<f64> {
        match self {
            Warning::Unstable(Instability { certain: true, time, .. }) => Some(*time),
            _ => None,
        }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&match self {
            Warning::Unstable(found) => unstable(found),
            Warning::UnstableOutOfPlane(found) => unstable_out_of_plane(found),
            Warning::Unbalanced { residual } => unbalanced(*residual),
            Warning::DeepContact { name, depth, size, stiffness } => deep_contact(name, *depth, *size, *stiffness),
            Warning::Grows { modes, rate, fastest } => grows(*modes, *rate, *fastest),
            Warning::Modes(warnings) => warnings.clone(),
            Warning::RotationDrifts { label, direction, drift } => drifted(label, direction, *drift),
            Warning::LargeRotation { label, turn } => large_rotation(label, *turn),
            Warning::BeyondYield { name, stress, limit } => beyond_yield(name, *stress, *limit),
            Warning::BeyondElastic { name, stress, strain } => beyond_elastic(name, *stress, *strain),
            Warning::Bent { name, reduced, linear, turn } => bent(name, [*reduced, *linear], *turn),
            Warning::LargeStrain { name, strain, logarithmic } => large_strain(name, *strain, *logarithmic),
            Warning::SideBySide { name } => side_by_side(name),
            Warning::ContactThrows(found) => found.to_string(),
            Warning::SlipBegins(found) => found.to_string(),
            Warning::Crowded { name } => crowded(name),
            Warning::ScaledStep { wanted, longest, label, cause } => scaled_step([*wanted, *longest], label, cause),
            Warning::BeginsClosed { name, depth } => begins_closed(name, *depth),
            Warning::StepError { asked, estimate } => step_error(*asked, *estimate),
            Warning::RunsPart { asked, difference } => runs_part(*asked, *difference),
            Warning::InitialVelocities { change } => corrected(*change),
        })
    }
}

/// The message of a rotation too large for a linear analysis.
fn large_rotation(label: &str, turn: f64) -> String {
    format!(
        "node `{label}` rotates by {} rad, but a linear analysis takes rotations as infinitesimal: displacements are valid for smaller loads only. \
         Give `geometry = \"finite\"`, or reduce the loads",
        to_digits(turn, 2)
    )
}

/// The error of displacements in a part that turns in its frame by so many radians.
pub fn bending_error(linear: bool, turn: f64) -> f64 {
    if linear { turn * turn / 3.0 } else { turn.powi(4) / 5.0 }
}

/// The message of a superelement or a reduced part that is bent too far.
fn bent(name: &str, [reduced, linear]: [bool; 2], turn: f64) -> String {
    let [what, remedy] = match reduced {
        false => ["superelement", "Replace it by several superelements, or by `[[beams]]` or `[[shells]]`"],
        true => {
            ["reduced part", "Give a beam `pieces`, replace a shell by several reduced parts, or leave `reduced` out"]
        }
    };
    let why = match linear {
        true => "Its matrices take them as infinitesimal",
        false => "Its energy ends with the terms of third order",
    };
    format!(
        "{what} `{name}` deforms by rotations of {} rad in its frame. {why}, so displacements there are wrong by about {} %. {remedy}",
        to_digits(turn, 2),
        to_digits(100.0 * bending_error(linear, turn), 1)
    )
}

/// The message of an elastic beam strained as no material can be.
fn beyond_elastic(name: &str, stress: f64, strain: f64) -> String {
    format!(
        "the stress in `{name}` reaches {}, a strain of {} %: few materials stay elastic so far. Look at the units of loads and sections, N for \
         kN or mm for m, or give it `model` = \"elastic-plastic\"",
        to_digits(stress, 3),
        to_digits(100.0 * strain, 2)
    )
}

/// The message of a stress beyond yield.
fn beyond_yield(name: &str, stress: f64, limit: f64) -> String {
    format!(
        "the stress in `{name}` reaches {}, {} times its yield stress of {}, but a linear analysis keeps materials elastic: the structure is \
         softer in fact. Give `geometry = \"finite\"` so that it yields",
        to_digits(stress, 3),
        to_digits(stress / limit, 3),
        to_digits(limit, 3)
    )
}

/// The warnings of a run, only the first of each kind.
#[derive(Debug, Clone, Default)]
pub struct Warnings {
    warnings: Vec<Warning>,
    remarks: Vec<Remark>,
    /// The contacts that have touched, by their indices in [`model::Model::parts`].
    pub(super) touched: Vec<usize>,
    /// For central differences, the sums of (ω Δt)² v² and of v² by modes over all steps, which show whether steps resolve the motion.
    pub(super) resisted: [f64; 2],
}

keep!(Warnings: Default { warnings, remarks, touched, resisted });

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

    /// Adds the penetration of a contact of this size and with these stiffnesses, or keeps it if it is relatively deeper than the known one.
    pub fn deepen(&mut self, contact: &str, (depth, size): (f64, f64), stiffness: [f64; 3]) {
        let known = self.warnings.iter_mut().find(|known| matches!(known, Warning::DeepContact { .. }));
        let found = || Warning::DeepContact { name: contact.to_owned(), depth, size, stiffness };
        match known {
            None => self.warnings.push(found()),
            Some(known) => {
                if let Warning::DeepContact { depth: old, size: of, .. } = known
                    && depth / size > *old / *of
                {
                    *known = found();
                }
            }
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

    /// Adds the largest rotation of a linear analysis, or keeps it where it is larger than the one known.
    pub fn large_rotation(&mut self, node: &str, largest: f64) {
        let known = self.warnings.iter_mut().find_map(|known| match known {
            Warning::LargeRotation { label, turn } => Some((label, turn)),
            _ => None,
        });
        match known {
            None => self.warnings.push(Warning::LargeRotation { label: node.to_owned(), turn: largest }),
            Some((label, turn)) if largest > *turn => {
                node.clone_into(label);
                *turn = largest;
            }
            Some(_) => {}
        }
    }

    /// Adds a superelement or a reduced part with this rotation in its frame. Only the largest error is kept.
    pub fn bend(&mut self, name: &str, [reduced, linear]: [bool; 2], turn: f64) {
        let known = self.warnings.iter().position(|known| matches!(known, Warning::Bent { .. }));
        if let Some(Warning::Bent { linear: other, turn: known, .. }) = known.map(|at| &self.warnings[at])
            && bending_error(linear, turn) <= bending_error(*other, *known)
        {
            return;
        }
        let found = Warning::Bent { name: name.to_owned(), reduced, linear, turn };
        match known {
            Some(at) => self.warnings[at] = found,
            None => self.warnings.push(found),
        }
    }

    /// Adds the stress and the strain of an elastic beam, or keeps them where they are larger than those known.
    pub fn beyond_elastic(&mut self, beam: &str, [stress, strain]: [f64; 2]) {
        let found = Warning::BeyondElastic { name: beam.to_owned(), stress, strain };
        match self.warnings.iter_mut().find(|known| matches!(known, Warning::BeyondElastic { .. })) {
            Some(Warning::BeyondElastic { strain: known, .. }) if strain <= *known => {}
            Some(known) => *known = found,
            None => self.warnings.push(found),
        }
    }

    /// Adds a stress beyond yield, or keeps it where it is farther beyond than the one known.
    pub fn beyond_yield(&mut self, part: &str, largest: f64, bound: f64) {
        let known = self.warnings.iter_mut().find_map(|known| match known {
            Warning::BeyondYield { name, stress, limit } => Some((name, stress, limit)),
            _ => None,
        });
        match known {
            None => {
                let (name, stress, limit) = (part.to_owned(), largest, bound);
                self.warnings.push(Warning::BeyondYield { name, stress, limit });
            }
            Some((name, stress, limit)) if largest / bound > *stress / *limit => {
                part.clone_into(name);
                (*stress, *limit) = (largest, bound);
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
                    "no support restrains motion out of the plane. The check for buckling out of it assumes supports at {}. Add these supports \
                     if the real structure has them",
                    places.join(", ")
                )
            }
            Remark::NotHeld { place: (label, direction) } => write!(
                f,
                "`{label}` is not restrained in direction {direction}, out of the plane of the model. Buckling out of the plane is not checked. \
                 Add supports out of the plane to have it checked"
            ),
            Remark::Jointed => f.write_str(
                "buckling out of the plane is not checked in models with joints. Give `plane` = \"off\" in [analysis] to compute it in space",
            ),
            Remark::FactorInFile(place) => f.write_str(place),
            Remark::Slipping => f.write_str(
                "stability is not checked on a path of `control` = \"arc-length\" while friction slips. Use load steps (`control` = \"time\") to \
                 have it checked",
            ),
        }
    }
}
