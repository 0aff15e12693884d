//! The failures of steps, with the names of the parts concerned.

use super::no_convergence::NoConvergence;
use super::warning::Instability;
use crate::modes::ModesFault;
use crate::plan::Plan;
use crate::system::System;
use base::names::{short, to_digits};
use base::snapshot::{keep, keep_either};
use model::{DIRECTIONS, Model};
use std::fmt;

/// A failed step.
#[derive(Debug, Clone, PartialEq)]
pub enum Failure {
    /// Nothing resists at this degree of freedom: a pivot vanishes, or a motion strains no element.
    Singular {
        /// The name of the node or joint.
        label: String,
        /// The name of the degree of freedom or constraint.
        direction: &'static str,
        /// A part there that would resist, but is open or slack: its name in quotes, and the gap of a contact.
        open: Option<String>,
        /// True for the first matrix of a run that nothing has moved yet: shorter steps do not help.
        at_start: bool,
        /// The part that yields most, in words.
        yielded: Option<String>,
    },
    /// A massless direction without restraint at a node.
    MasslessDirection {
        /// The name of the node.
        label: String,
        /// True where the direction is the axis of a rotation.
        rotation: bool,
        /// The unit vector of the direction, global components.
        direction: [f64; 3],
        /// True if compression there pushes the node away.
        buckles: bool,
        /// A part there that would hold it, but is open or slack, likewise.
        open: Option<String>,
    },
    /// The iteration did not converge.
    NotConverged {
        /// The number of iterations.
        iterations: usize,
        /// The evidence of the cause in the last step.
        cause: Box<NoConvergence>,
        /// The part that has opened or gone slack last, while it is, by its name in quotes.
        open: Option<String>,
        /// True where something may slip, and the matrix is the symmetric part of the tangent.
        lacks_slip: bool,
        /// The part that yields most, in words.
        yielded: Option<String>,
        /// The largest residual forces.
        largest: Vec<NamedResidual>,
    },
    /// Joints could not be closed at the end of a step.
    ConstraintsViolated {
        /// The largest gaps.
        largest: Vec<NamedResidual>,
        /// Smallest and largest principal inertia with their bodies, if rounding cannot resolve their ratio; otherwise empty.
        inertias: Vec<NamedResidual>,
    },
    /// One step of the deck, or several in a row, needed too many substeps.
    TooManySubsteps {
        /// The number of steps of the deck.
        steps: usize,
        /// The number of substeps that they took.
        substeps: usize,
        /// The length of the last substep.
        dt: f64,
        /// The failure of the last cutback.
        cause: Box<Failure>,
    },
    /// No equilibrium lies on the arc of a step.
    NoEquilibriumOnArc {
        /// The largest residual forces.
        largest: Vec<NamedResidual>,
    },
    /// No load or prescribed motion changes with the time, so nothing leads on along the path.
    NoLoadIncrement {
        /// The current time.
        time: f64,
    },
    /// A path did not end within the steps that it was given.
    TooManySteps {
        /// The number of these steps.
        steps: usize,
    },
    /// A path in steps shorter than the first leads nowhere.
    PathCreeps {
        /// The number of these steps.
        steps: usize,
        /// The displacement before them.
        from: f64,
        /// The displacement after them.
        to: f64,
    },
    /// A step would take a point through a surface, or into an impact that it does not resolve.
    ContactNotResolved {
        /// The name of the contact.
        name: String,
    },
    /// A contact with multipliers is not closed to its tolerance.
    ContactNotClosed {
        /// The name of the contact.
        name: String,
        /// Its penetration or slip error over the tolerance.
        out: f64,
    },
    /// The ends of a bushing have turned against each other by half a turn.
    BushingTurnedOver {
        /// The name of the bushing.
        name: String,
    },
    /// The ends of a bushing turn against each other by so much in a step that full turns are not told from none.
    BushingTurnsTooFar {
        /// The name of the bushing.
        name: String,
        /// The length of the step.
        dt: f64,
    },
    /// A rotation that a support gives beside a free one is no longer known.
    GivenRotationLost {
        /// The name of the node.
        label: String,
    },
    /// A step of central differences is longer than the critical time step.
    Unstable {
        /// The length of the step.
        dt: f64,
        /// The critical time step.
        longest: f64,
        /// True where steps find their own length.
        automatic: bool,
    },
    /// The time integration has generated so much energy that the motion is lost.
    EnergyGrowth {
        /// The energy generated, as a multiple of the available energy.
        ratio: f64,
        /// The word of the scheme; `None` for central differences.
        scheme: Option<String>,
        /// The key of the deck that shortens the steps.
        shortens: String,
        /// The time of the last check with a kept balance of energy.
        kept_until: f64,
    },
    /// A step of an explicit scheme rotates something too far.
    RotationTooLarge {
        /// The length of the step.
        dt: f64,
    },
    /// A load step turns a node too far.
    LoadStepTurns {
        /// The name of the node.
        label: String,
        /// The angle of its rotation in the step, in radians.
        angle: f64,
    },
    /// A step of a motion turns a node of a shell too far against its element.
    NodeTurns {
        /// The name of the node.
        label: String,
        /// The angle of its rotation in the step against the mean of the element, in radians.
        angle: f64,
    },
    /// An element has passed through zero length or area, or has turned over.
    TurnedOver {
        /// The name of its part.
        name: String,
    },
    /// The work of a load step differs from the stored and dissipated energy: its ends do not lie on one path of equilibria.
    EquilibriumJumps {
        /// The name of the node that moves most.
        label: String,
        /// The direction of its motion.
        direction: &'static str,
        /// The work of the loads in the step.
        work: f64,
        /// The energy stored and dissipated in the step.
        stored: f64,
        /// A contact without friction, on which parts may slide.
        smooth: Option<String>,
    },
    /// A load step ends on an unstable branch; a shorter one may not.
    UnstableStep,
    /// The path of equilibria becomes unstable.
    Buckles(Instability),
    /// The error of a step exceeds the allowed error.
    ErrorTooLarge {
        /// The length of the step.
        dt: f64,
    },
    /// A prescribed joint coordinate goes beyond the reach of the linkage.
    OutOfReach {
        /// The name of the joint.
        name: String,
        /// The prescribed change of the coordinate at the last step.
        position: f64,
        /// The force of the drive over the largest other force.
        times: f64,
    },
    /// A stage by displacement control has led its loads below zero, and another stage is to follow.
    TimeWentBack {
        /// The begin of the stage, in time.
        begin: f64,
        /// The end of the stage, in time.
        end: f64,
    },
    /// There are no modes about the state.
    Modes(ModesFault),
    /// The motion left the range of numbers.
    NotFinite {
        /// The largest residual forces, or those that are no numbers.
        largest: Vec<NamedResidual>,
    },
    /// A signal has ended a step that would have been the first, or took too long.
    Stopped,
}

keep_either!(Failure {
    0 => NoLoadIncrement { time },
    1 => Singular { label, direction, open, at_start, yielded },
    2 => MasslessDirection { label, rotation, direction, buckles, open },
    3 => NotConverged { iterations, cause, open, lacks_slip, yielded, largest },
    4 => ConstraintsViolated { largest, inertias },
    5 => TooManySubsteps { steps, substeps, dt, cause },
    6 => NoEquilibriumOnArc { largest },
    7 => TooManySteps { steps },
    8 => ContactNotResolved { name },
    9 => BushingTurnedOver { name },
    10 => BushingTurnsTooFar { name, dt },
    11 => Unstable { dt, longest, automatic },
    12 => EnergyGrowth { ratio, scheme, shortens, kept_until },
    13 => RotationTooLarge { dt },
    14 => LoadStepTurns { label, angle },
    15 => TurnedOver { name },
    16 => EquilibriumJumps { label, direction, work, stored, smooth },
    17 => ErrorTooLarge { dt },
    18 => Modes(fault),
    19 => NotFinite { largest },
    20 => Stopped,
    21 => ContactNotClosed { name, out },
    22 => NodeTurns { label, angle },
    23 => UnstableStep,
    24 => Buckles(instability),
    25 => GivenRotationLost { label },
    26 => PathCreeps { steps, from, to },
    27 => OutOfReach { name, position, times },
    28 => TimeWentBack { begin, end },
});

/// A residual force, or a gap, with its name.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct NamedResidual {
    /// Name of the node or joint.
    pub label: String,
    /// Name of the degree of freedom or constraint.
    pub direction: &'static str,
    /// Its residual or gap.
    pub residual: f64,
}

keep!(NamedResidual: Default { label, direction, residual });

impl Failure {
    /// A vanishing pivot by its row, with the open part there, and whether the motion has not begun.
    pub(super) fn singular(
        model: &Model,
        plan: &Plan,
        system: &System,
        row: usize,
        (open, at_start): (Option<String>, bool),
    ) -> Failure {
        let (label, direction) = name(model, plan, system, row);
        Failure::Singular { label, direction, open, at_start, yielded: None }
    }

    /// An unresisted motion, by the node and degree of freedom with the largest motion.
    pub(super) fn mechanism(
        model: &Model,
        (node, dof): (usize, usize),
        open: Option<String>,
        at_start: bool,
    ) -> Failure {
        let label = model.nodes[node].label.clone();
        Failure::Singular { label, direction: DIRECTIONS[dof], open, at_start, yielded: None }
    }
}

/// The name of an unknown: its node and degree of freedom, or its joint and constraint.
fn name(model: &Model, plan: &Plan, system: &System, row: usize) -> (String, &'static str) {
    match plan.dofs.nodal_dofs().get(row) {
        Some(&(node, dof)) => (model.nodes[node].label.clone(), DIRECTIONS[dof]),
        None => multiplier(model, system, row - plan.dofs.nodal_dofs().len()),
    }
}

fn multiplier(model: &Model, system: &System, number: usize) -> (String, &'static str) {
    system
        .row(number)
        .map_or((String::new(), ""), |(joint, row)| (model.constraints.joints[joint].name.clone(), row.word()))
}

/// The five largest by name.
fn sorted(values: &[f64], name: impl Fn(usize) -> (String, &'static str)) -> Vec<NamedResidual> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    let size = |i: usize| if values[i].is_nan() { f64::INFINITY } else { values[i].abs() };
    order.sort_by(|&a, &b| size(b).total_cmp(&size(a)));
    let largest = |&i: &usize| {
        let (label, direction) = name(i);
        NamedResidual { label, direction, residual: values[i] }
    };
    order.iter().take(5).map(largest).collect()
}

/// The five largest residuals by name.
pub(super) fn largest(model: &Model, plan: &Plan, residual: &[f64]) -> Vec<NamedResidual> {
    sorted(&residual[..plan.dofs.nodal_dofs().len()], |row| {
        let (node, dof) = plan.dofs.nodal_dofs()[row];
        (model.nodes[node].label.clone(), DIRECTIONS[dof])
    })
}

/// The five widest gaps of joints by name.
pub(super) fn gaps(model: &Model, system: &System, gaps: &[f64]) -> Vec<NamedResidual> {
    let mut widest = sorted(gaps, |number| multiplier(model, system, number));
    widest.retain(|gap| gap.residual != 0.0);
    widest
}

/// The message on a lost motion, with the remedy for the scheme.
fn energy_growth(ratio: f64, scheme: Option<&str>, shortens: &str) -> String {
    match scheme {
        None => format!(
            "energy growth: central differences have generated {ratio:.1e} times the available energy, because their steps are too long for this \
             motion. Give half of `{shortens}`, or an implicit scheme"
        ),
        Some(scheme) => {
            let dissipates = "`scheme = \"bathe\"`, which dissipates motions that steps do not resolve, and ";
            let other = if scheme == "bathe" { "" } else { dissipates };
            format!(
                "energy growth: `{scheme}` has generated {ratio:.1e} times the available energy, and the motion is lost. Give {other}a tenth of \
                 `{shortens}`"
            )
        }
    }
}

/// The message of a stage whose loads have changed their sign before another stage.
fn time_went_back([begin, end]: [String; 2]) -> String {
    format!(
        "the loads of this stage act against its `stop`, so that the time, which is their factor, went back from {begin} to {end}: no stage can \
         follow. Give these loads the other sign"
    )
}

/// The message of a singular matrix, with a part there that is open or slack.
fn singular(label: &str, direction: &str, [open, yielded]: [Option<&str>; 2]) -> String {
    if let (None, Some(part)) = (open, yielded) {
        return format!(
            "the system is singular at `{label}` in direction {direction}: {part}. The load has passed the limit load, a support is missing, or the \
             structure buckles. Give a hardening, smaller loads, a support, or `kind = \"dynamic\"` to follow the motion"
        );
    }
    let remedy = open.map_or_else(
        || {
            "Add a support or a soft spring there; give cables pretension (`free_length`), or compute a mechanism with `kind = \"dynamic\"`"
                .to_owned()
        },
        |name| format!("{name} is open or slack there: close it, or hold the node by a soft spring until it closes"),
    );
    format!(
        "the system is singular at `{label}` in direction {direction}: nothing resists motion there, because a support is missing, a mechanism \
         moves, or the structure buckles. {remedy}"
    )
}

/// The message of a load step between two paths of equilibria. `smooth` is a contact without friction.
fn jumps((label, direction): (&str, &str), [work, stored]: [f64; 2], smooth: Option<&str>) -> String {
    let slides = smooth.map_or_else(String::new, |contact| {
        format!(". Contact `{contact}` has no `friction`: give it some where it should hold")
    });
    format!(
        "the equilibrium jumps by snap-through, buckling or a mechanism: loads do {work:.3e} of work in a step that stores and dissipates \
         {stored:.3e}, however short the step is. `{label}` moves most, in direction {direction}{slides}. Follow the path with `control` = \
         \"arc-length\", or the motion with `kind = \"dynamic\"`"
    )
}

/// The message of an unrestrained massless direction.
fn massless(label: &str, rotation: bool, direction: &[f64; 3], buckles: bool, open: Option<&str>) -> String {
    let what = if rotation { "inertia" } else { "mass" };
    let [x, y, z] = direction.map(|component| to_digits(component, 3));
    let there = if rotation { "rotation about" } else { "direction" };
    let why = match (buckles, open) {
        (true, _) => "compression pushes it away".to_owned(),
        (false, None) => "nothing holds it".to_owned(),
        (false, Some(name)) => format!("nothing holds it, because {name} is open or slack"),
    };
    format!(
        "`{label}` has no {what}, and in {there} ({x}, {y}, {z}) {why}: its motion is not determined. Give it {what} (`[[masses]]`), or add a \
         support there"
    )
}

/// The message where joints cannot be closed; the smallest and the largest inertia if their ratio is the cause.
fn constraints_violated(inertias: &[NamedResidual]) -> String {
    let [least, most] = inertias else {
        return "joints cannot be closed at the end of the step: prescribed motions or joints contradict each other, or the step is too long. \
                Halve `time_step`; if the gaps stay, remove one of the joints or motions listed. The widest gaps are"
            .to_owned();
    };
    format!(
        "joints cannot be closed at the end of the step: the principal inertias of `{}`, {}, and of `{}`, {}, are {:.0e} times apart, \
         which rounding does not resolve. Take `scheme = \"esdirk3\"`, or give `{}` an inertia of {} about each axis; the widest gaps are",
        least.label,
        short(least.residual),
        most.label,
        short(most.residual),
        most.residual / least.residual,
        least.label,
        short(1e-10 * most.residual)
    )
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.message())?;
        let (Failure::NotConverged { largest, .. }
        | Failure::ConstraintsViolated { largest, .. }
        | Failure::NoEquilibriumOnArc { largest }
        | Failure::NotFinite { largest }) = self
        else {
            return Ok(());
        };
        largest.iter().try_for_each(|l| match l.residual.is_finite() {
            true => write!(f, "\n  {} {}: {:.3e}", l.label, l.direction, l.residual),
            false => write!(f, "\n  {} {}: not finite", l.label, l.direction),
        })
    }
}

impl Failure {
    /// True if a shorter step would fail in the same way: after a signal, on an unstable path, and for contact multipliers, which converge
    /// at the same rate in all steps.
    pub fn is_final(&self) -> bool {
        matches!(self, Failure::Stopped | Failure::ContactNotClosed { .. } | Failure::Buckles(_))
    }

    /// True if the refused equilibrium shows that the matrix of its iteration is misleading.
    pub fn blames_matrix(&self) -> bool {
        matches!(self, Failure::ConstraintsViolated { .. } | Failure::UnstableStep | Failure::Buckles(_))
    }

    /// The part that yields most, of failures by a lost stiffness.
    pub(super) fn yielded_mut(&mut self) -> Option<&mut Option<String>> {
        match self {
            Failure::Singular { yielded, .. } => Some(yielded),
            Failure::NotConverged { cause, yielded, .. } => cause.at_limit.then_some(yielded),
            Failure::TooManySubsteps { cause, .. } => cause.yielded_mut(),
            _ => None,
        }
    }

    /// True if memory is short.
    pub fn is_of_memory(&self) -> bool {
        matches!(self, Failure::Modes(ModesFault::TooLarge(_)))
    }

    /// The end time of valid results, if it differs from the time of the failure.
    pub fn valid_until(&self) -> Option<f64> {
        match self {
            Failure::EnergyGrowth { kept_until, .. } => Some(*kept_until),
            _ => None,
        }
    }

    /// The message without the list of the largest residuals or gaps: the event and the remedy.
    fn message(&self) -> String {
        match self {
            Failure::Singular { label, direction, open, yielded, .. } => {
                singular(label, direction, [open.as_deref(), yielded.as_deref()])
            }
            Failure::MasslessDirection { label, rotation, direction, buckles, open } => {
                massless(label, *rotation, direction, *buckles, open.as_deref())
            }
            Failure::NotConverged { iterations, cause, open, lacks_slip, yielded, largest } => {
                let worst = largest.first().map(|worst| (&*worst.label, worst.direction, worst.residual));
                cause.message(*iterations, [open.as_deref(), yielded.as_deref()], *lacks_slip, worst)
            }
            Failure::Modes(fault) => fault.to_string(),
            Failure::Stopped => {
                "a signal stopped the run in step 1, before its first result. Start the run again".to_owned()
            }
            Failure::NotFinite { .. } => {
                "the motion is not finite: loads are too large, or stiffnesses too small, for numbers of 1e308. Look \
                for wrong units in loads, masses and materials; the largest unbalanced forces are"
                    .to_owned()
            }
            Failure::ConstraintsViolated { inertias, .. } => constraints_violated(inertias),
            Failure::OutOfReach { name, position, times } => format!(
                "`{name}` prescribes a `position` beyond the reach of the linkage: near {} its force is {} times the largest other force, for the links \
                 come to lie in one line. Give a position nearer to zero than {}, or move the ends of `{name}`",
                to_digits(*position, 4),
                to_digits(*times, 2),
                to_digits(*position, 4)
            ),
            Failure::ContactNotResolved { .. } | Failure::ContactNotClosed { .. } => self.message_of_contact(),
            Failure::BushingTurnedOver { .. }
            | Failure::BushingTurnsTooFar { .. }
            | Failure::GivenRotationLost { .. } => self.message_of_rotation(),
            Failure::NoEquilibriumOnArc { .. }
            | Failure::NoLoadIncrement { .. }
            | Failure::TimeWentBack { .. }
            | Failure::TooManySteps { .. }
            | Failure::PathCreeps { .. }
            | Failure::LoadStepTurns { .. }
            | Failure::NodeTurns { .. }
            | Failure::TurnedOver { .. }
            | Failure::UnstableStep
            | Failure::Buckles(_)
            | Failure::EquilibriumJumps { .. } => self.message_of_path(),
            _ => self.message_of_length(),
        }
    }

    /// The message where a rotation is no longer defined.
    fn message_of_rotation(&self) -> String {
        match self {
            Failure::BushingTurnedOver { name } => format!(
                "the ends of bushing `{name}` have rotated against each other by half a turn, where its moments are not defined. Give it a \
                 larger rotational stiffness, or make the stiffness about the axis of rotation differ from the other two"
            ),
            Failure::BushingTurnsTooFar { name, dt } => format!(
                "in a step of {dt:.3e} the ends of bushing `{name}` rotate against each other by more than 2 radians, so full turns cannot be \
                 counted. Give `time_step` = {}",
                short(0.25 * dt)
            ),
            Failure::GivenRotationLost { label } => format!(
                "the rotations that a support prescribes at `{label}` beside a free one are no longer defined. The rotation vector is near half a \
                 turn, or the middle angle of its sequence near 90 degrees. Give the support a `rotation` that begins or ends with the free axis, \
                 such as \"zyx\" for a free rz"
            ),
            _ => String::new(),
        }
    }

    /// The message where a contact is not resolved.
    fn message_of_contact(&self) -> String {
        match self {
            Failure::ContactNotResolved { name } => format!(
                "the step is too long for contact `{name}`: a point would pass through the surface, or an impact is not resolved. Give a tenth \
                 of `time_step`; if that does not help, give ten times its `stiffness`"
            ),
            Failure::ContactNotClosed { name, out } => format!(
                "contact `{name}` still misses its `penetration_tolerance` by a factor of {out:.1e} after a hundred equilibria: its `stiffness` is \
                 far below that of the bodies. Give ten times its `stiffness`, or a larger `penetration_tolerance`"
            ),
            _ => String::new(),
        }
    }

    /// The message where a path of equilibria cannot be followed.
    fn message_of_path(&self) -> String {
        match self {
            Failure::NoLoadIncrement { time } => format!(
                "no load or prescribed motion changes at t = {}, so the path of `control` = \"arc-length\" has no direction. Give a load an \
                 `amplitude` that changes there, or remove `control`",
                short(*time)
            ),
            Failure::TimeWentBack { begin, end } => time_went_back([*begin, *end].map(short)),
            Failure::LoadStepTurns { label, angle } => format!(
                "a load step rotates `{label}` by {angle:.1} radians, and shorter steps do not help: the equilibrium jumps, by a mechanism or \
                 snap-through. Add a support there, or compute the motion with `kind = \"dynamic\"`"
            ),
            Failure::NodeTurns { label, angle } => format!(
                "a step rotates `{label}` by {angle:.1} radians against the rest of its shell element: the iteration has found another \
                 equilibrium than that of the motion. Give a tenth of `time_step`"
            ),
            Failure::TurnedOver { name } => format!(
                "an element of `{name}` is turned over or compressed to zero length, so its stress is not defined. It has collapsed under the \
                 loads, or the step jumped to another equilibrium. Give `control` = \"arc-length\", or `kind = \"dynamic\"` with smaller loads"
            ),
            Failure::EquilibriumJumps { label, direction, work, stored, smooth } => {
                jumps((label.as_str(), *direction), [*work, *stored], smooth.as_deref())
            }
            Failure::UnstableStep => "the load step ends on an unstable branch of equilibria: the structure buckles, and `least_step` \
                keeps steps from following the path. Give a hundredth of `least_step`"
                .to_owned(),
            Failure::Buckles(Instability { time, modes, label, direction, film, .. }) if !film.is_empty() => format!(
                "the equilibrium is unstable from t = {} on: flat elements of the film `{film}` fold at `{label}`, in direction {direction}; the \
                 tangent has negative eigenvalues: {modes}. Give the shell `order = 2` and half as many elements a side, which bend there",
                short(*time)
            ),
            Failure::Buckles(Instability { time, modes, label, direction, .. }) => format!(
                "the equilibrium is unstable from t = {} on: the structure buckles. The mode moves `{label}` most, in direction {direction}; the \
                 tangent has negative eigenvalues: {modes}. Load steps stay on the unstable path, however short they are. Add a load of a \
                 thousandth of the others there, or an offset of a thousandth of the length. Where the load falls beyond, give `control` = \
                 \"arc-length\" or `kind = \"dynamic\"` too",
                short(*time)
            ),
            Failure::PathCreeps { steps, from, to } => format!(
                "the path creeps: in {steps} steps the displacement has gone from {} to {}. Where parts yield \
                 without hardening, hinges open and close in every step: give the material a hardening modulus of a hundredth of its \
                 `youngs_modulus`, `tolerance` = 1e-4 in `[iteration]`, or `control` = \"displacement\"",
                to_digits(*from, 5),
                to_digits(*to, 5)
            ),
            Failure::TooManySteps { steps } => format!(
                "the path reached neither `end_time` nor `stop` in {steps} steps. Give `steps` = {} to follow it further",
                10 * steps
            ),
            _ => "the path of equilibria bends too sharply for the shortest step. Give a hundredth of `least_step`; the largest unbalanced \
                forces are"
                .to_owned(),
        }
    }

    /// The message where steps are too long or too many.
    fn message_of_length(&self) -> String {
        match self {
            Failure::TooManySubsteps { steps, substeps, dt, cause } => {
                let steps =
                    if *steps == 1 { "the step was".to_owned() } else { format!("the last {steps} steps were") };
                format!(
                    "{steps} cut into {substeps} substeps, the last of {dt:.1e}, without reaching the end: the loads are too large or `time_step` is \
                     too long for this motion. Give a tenth of `time_step` or of the loads. The cause of the last cutback: {cause}"
                )
            }
            Failure::Unstable { dt, longest, automatic } => {
                let remedy = match automatic {
                    true => format!("`least_step` = {}, smaller loads", short(0.5 * longest)),
                    false => {
                        format!("`time_step` = {} or \"auto\", and no `least_step` above it", short(0.9 * longest))
                    }
                };
                format!(
                    "a step of {dt:.3e} is too long for central differences: the critical time step (stability limit) is {longest:.3e}. Give \
                     {remedy}, or an implicit scheme"
                )
            }
            Failure::EnergyGrowth { ratio, scheme, shortens, .. } => energy_growth(*ratio, scheme.as_deref(), shortens),
            Failure::RotationTooLarge { dt } => format!(
                "in a step of {dt:.3e} a node rotates by more than 3 radians, which explicit schemes do not resolve. Give `time_step` = {}",
                short(0.1 * dt)
            ),
            Failure::ErrorTooLarge { dt } => format!(
                "the error of a step of {dt:.3e} exceeds `error_tolerance`, however short the steps are: a load or motion jumps there. Give ten times \
                 `error_tolerance`, or an `amplitude` without the jump"
            ),
            _ => String::new(),
        }
    }
}
