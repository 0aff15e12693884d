//! All thresholds of the solution, each with its reason: limits for small and large values, and numbers of trials.
//!
//! Each module belongs to one file of the solution.

// The step and its iteration.

pub mod iteration {
    /// Residual of balanced forces, below which open joints cause the failure.
    pub const BALANCED: f64 = 1e-3;
    /// Factor on the limit of iterations whose corrections are shortened.
    pub const LONGER: usize = 4;
    /// Residual beyond a limit load is the excess load; a larger part of the forces shows lost iterates.
    pub const NEAR_LIMIT: f64 = 0.1;
    /// Iterations of a step with the elastic matrix: the default limit of the initial load method.
    pub const INITIAL_LOADS: usize = 200;
}

pub mod convergence {
    /// Number of residuals without a decrease after which no decrease is expected; rounding alone may halve a single one.
    pub const STAGNANT: usize = 3;
    /// Contraction above which the remaining correction may be only rounding.
    pub const SLOW: f64 = 0.5;
    /// Above this residual, relative to the largest forces, it consists of these forces, and its ratios do not measure the contraction.
    pub const SATURATED: f64 = 0.1;
    /// Ratio to the last residual above which a residual counts as not decreased.
    pub const FALLS: f64 = 0.5;
    /// Safety on the square of the ratio of two corrections, which is the contraction of the residual with an own matrix.
    pub const SECOND_ORDER: f64 = 10.0;
}

pub mod convergence_tolerance {
    /// The least contraction that one step expects of the next: a smaller one was chance.
    pub const LEAST: f64 = 1e-3;
    /// Contraction assumed where none was seen.
    pub const UNKNOWN: f64 = 0.5;
    /// A contraction that was not seen again is trusted less by this factor with every step.
    pub const TRUST: f64 = 1.5;
    /// The tolerance of steps whose own error is not known.
    pub const DIGITS: f64 = 1e-8;
    /// The iteration adds little to the error of the step, for its own is of one sign where matrices are kept.
    pub const PART: f64 = 0.01;
    /// Forces follow the motion: in stiff parts they converge long after the motion, and no step depends on them.
    pub const PART_OF_FORCES: f64 = 0.1;
    /// A thousandth of a twelfth, rounded: errors of one sign add up.
    pub const PART_OF_FIRST: f64 = 1e-4;
    /// Upper limit for all steps: in impacts, at jumps of loads, and for stiff parts that turn far in unresolved steps, larger residual
    /// forces would drive the motion.
    pub const MOST_OF_FIRST: f64 = 1e-5;
    /// The step, in radians of an oscillator, for the check of dissipation.
    pub const DISSIPATION_TURN: f64 = 1.0;
    /// Above the rounding of eigenvalues.
    pub const NO_DISSIPATION: f64 = 1e-9;
}

pub mod progress {
    /// The required residual of yielding models, as a multiple of the tolerance and as an absolute value.
    pub const SURE: [f64; 2] = [1e3, 1e-3];
    /// A load step that converges only to rounding is refused if its residual exceeds the tolerance by this factor.
    pub const UNBALANCED: f64 = 1e3;
}

pub mod correction {
    /// The square of a slenderness: bending amplifies corrections due to rounding of axial forces by it.
    pub const SLENDER: f64 = 1e4;
    /// The largest translation, in parts of the model's length, and the largest rotation, in radians.
    pub const LARGEST: [f64; 2] = [0.05, 0.25];
    /// A step that moves less, in radians or parts of the model's length, is judged by this motion.
    pub const STILL: f64 = 1e-6;
    /// A correction of the size of this part of the positions changes their last digits alone.
    pub const ROUNDING: f64 = 4.0 * f64::EPSILON;
}

pub mod augmentation {
    /// Largest number of equilibria in a step. With a contact spring as soft as the pressed part, each equilibrium halves the penetration,
    /// so this is enough for 1e-30.
    pub const MOST: usize = 100;
}

pub mod projection {
    /// Mass given to a degree of freedom without one, relative to the largest: so it is the one that gives way.
    pub const TRACE: f64 = 1e-9;
}

pub mod joints {
    /// Largest number of corrections of positions in a step.
    pub const MOST_CORRECTIONS: usize = 12;
    /// A gap, relative to positions, that rounding may leave.
    pub const ROUNDING: f64 = 16.0 * f64::EPSILON;
    /// The largest gap, relative to positions, that a joint may have at the end of a step; iteration and projection leave far less.
    pub const LARGEST_GAP: f64 = 1e-9;
    /// Ratio of two principal inertias above which explicit schemes cannot close redundant loops.
    pub const UNLIKE: f64 = 1e11;
    /// Part of a body's largest inertia below which an axis has none.
    pub const NO_INERTIA: f64 = 1e-12;
}

pub mod residual {
    /// Part of the moments, over the model's length, used as scale of forces if they have none, and the reverse.
    pub const OTHER: f64 = 1e-3;
}

pub mod load_steps {
    /// Loads and motions below this part of their maximum count as zero: amplitudes return to zero only to the rounding of their times.
    pub const GONE: f64 = 1e-12;
    /// Forces below this part of the largest so far may be rounding errors of them: a thousand elements leave 1e-10 after unloading.
    pub const FADED: f64 = 1e-6;
    /// Support motion, as a part of the model's length or in radians, that causes stresses a million times larger than rounding.
    pub const SEEN: f64 = 1e-9;
    /// Part of the summed terms above which a residual has no correct digit.
    pub const ROUNDING: f64 = 0.1;
}

// Strategies of the iteration.

pub mod linearized_prediction {
    /// Part of the motion for the difference of the residual; a power of two, so that it can be undone exactly.
    pub const PART: f64 = 1.0 / (1 << 20) as f64;
}

pub mod refresh {
    /// Largest number of equilibria with a fresh matrix at their start, or in every iteration, after a failure of old ones.
    pub const MOST_EAGER: usize = 64;
    /// Contraction above which any matrix is renewed, because the iteration would reach its limit.
    pub const USED_UP: f64 = 0.9;
    /// Contraction above which an old matrix is misleading, because a fresh one pays within two iterations.
    pub const MISLED: f64 = 0.5;
    /// Relative difference of equal steps due to the rounding of their ends.
    pub const SAME_STEP: f64 = 1e-9;
    /// The contraction of the second correction above which the matrix is useless.
    pub const USELESS: f64 = 0.3;
    /// The contraction below which a matrix is useful for corrections of this size.
    pub const USEFUL: f64 = 0.05;
    /// Limit of the next correction, as a part of one that made its matrix useless.
    pub const SHARE: f64 = 0.8;
    /// Growth of this limit per step, so that useless matrices are tried again.
    pub const GROWTH: f64 = 1.02;
}

pub mod anderson {
    /// Number of earlier corrections that are combined.
    pub const DEPTH: usize = 5;
    /// A difference counts where more than this fraction of it is linearly independent of the newer ones.
    pub const NEW: f64 = 1e-6;
}

pub mod line_search {
    /// The least and the largest factor on a correction by the secant, since the work is not linear along it.
    pub const SECANT: [f64; 2] = [0.1, 0.9];
    /// Largest fraction of the work of the residual that may be left after a correction.
    pub const LEFT: f64 = 0.8;
    /// Largest number of times that a correction is shortened.
    pub const TRIES: usize = 5;
}

pub mod rotated_matrix {
    /// An angle φ changes the matrix of a tree by about φ² EA L²/EI relative to its bending stiffness; below this value the contraction is
    /// not affected.
    pub const NEGLIGIBLE: f64 = 1e-3;
    /// A model that needs fewer matrices than this needs no rotated ones.
    pub const MANY: usize = 8;
}

pub mod beam_trees {
    /// `EA L²/EI`, the square of a slenderness, above which a tree is rotated. Stockier beams stretch almost as easily as they bend, and an
    /// old matrix errs more by moved masses than by rotations. Measured: flying beams of 2000 and 10,000 become slower, and models above
    /// 1.3e5 need a half to a third of the time.
    pub const SLENDER: f64 = 1e5;
}

pub mod stabilization {
    /// Limit of a first correction with springs, as a part of the model's length or in radians. Hanging parts hardly move in it; others
    /// would jump to their hanging position, which is not on a path of equilibria.
    pub const IN_PLACE: f64 = 0.05;
    /// Stiffness of a mode, as a part of the springs, above which it is stable without them. Redundant joints are closed only to 1e-7, and
    /// their forces do work in the gaps.
    pub const HELD: f64 = 1e-5;
    /// And part of the terms that this stiffness is summed from: a thousand times their rounding.
    pub const ROUNDING: f64 = 1e-13;
}

pub mod arc_length_constraint {
    /// Part of the run over which prescribed motion is differentiated; its error only slows the iteration.
    pub const DIFFERENCE: f64 = 1e-6;
    /// A motion smaller than this fraction of the step before does not show a direction.
    pub const SHORT: f64 = 1e-6;
}

// Guards.

pub mod mechanism {
    /// A mode may be a mechanism if the elements store less than this part of the summed energy terms: some hundred times the rounding of
    /// the matrix. Thin shells of 100 x 100 elements, thickness 1e-4 of the side, store 1e-13.
    pub const ENERGY: f64 = 1e-14;
    /// And it is one where forces on no element exceed this part of their terms. The mode has rounding errors, amplified by the condition
    /// of the other modes; a cantilever of 1000 elements, each hardly bent, has 1e-4.
    pub const FORCE: f64 = 1e-6;
    /// Motions below this part of the largest are taken for rounding of the mode.
    pub const MOVING: f64 = 1e-4;
    /// Inverse iterations before the first look: at a ratio of stiffnesses of 1e6 they leave 1e-18 of other modes in a mechanism. Most
    /// structures resist then, and need no more.
    pub const FIRST_ITERATIONS: usize = 3;
}

pub mod mode {
    /// Relative rounding difference of entries of a mode that are equal by symmetry.
    pub const EQUAL: f64 = 1e-6;
    /// Number of inverse iterations. Each amplifies the softest mode by the ratio of the next stiffness to its stiffness. The ratio is at
    /// least 1e6 at a singularity, and at least 2 if modes buckle one after the other.
    pub const ITERATIONS: usize = 6;
    /// A mode consists of rotations if its largest translation is below this part of a rotation times the model's length, as for an element
    /// turning about its axis.
    pub const ROTATIONAL: f64 = 1e-3;
}

pub mod massless {
    /// A pivot below this part of the diagonal is rounding of cancelling terms, with a margin of some thousand. A chain with so little
    /// tension has strains below 1e-12.
    pub const ROUNDING: f64 = 1e-12;
    /// Largest number of degrees of freedom of nodes that are checked together; in larger clusters each node is checked separately.
    pub const MOST: usize = 60;
    /// Components of a direction below this part of the largest are not said.
    pub const SMALL: f64 = 1e-6;
}

pub mod jump {
    /// The lever, as a part of the model's length, over which a rotation is compared with translations.
    pub const LEVER: f64 = 1e-3;
    /// Largest rotation of a node in a load step, in radians. Below it the chord of a turning element keeps a clearly positive component
    /// along its old direction. The rotation vector of the step then gives the work of moments.
    pub const LARGEST_TURN: f64 = 1.25;
    /// Largest rotation of a node of a shell against the mean of its element in a dynamic step, in radians; resolved steps bend elements
    /// less.
    pub const LARGEST_TWIST: f64 = 0.5;
    /// Work within this part of all work done, for either sign, is not missed: a step has its own error, and equilibrium its tolerance.
    pub const ACCURACY: f64 = 1e-3;
    /// Largest departure of the work of loads that grow by Δf from the work of their mean, as a part of `½ |Δf| |Δq|`. For forces
    /// proportional to the n-th power of displacements it is `(n − 1)/(n + 1)`: zero in a linear step, one half for the cubic force of a
    /// slack string. It decreases with the step if a gap closes or a structure yields. It is nearly one, or more, if the equilibrium jumps.
    pub const CURVED: f64 = 0.6;
    /// Part of `½ |Δf| |Δq|` above which a step is in doubt and taken in two halves. It is halved again, until the path is smooth or
    /// clearly jumps, if the first half misses more than half of the work. In a jump one of the halves misses all of the work.
    pub const DOUBTFUL: f64 = 0.2;
    /// The work of forces along this part of the model's length is rounding, and so is the work of moments along this angle.
    pub const NOTHING: f64 = 1e-12;
    /// Motions below this part of the model's length are no jumps; their energy may be rounding.
    pub const STILL: f64 = 1e-6;
}

pub mod stability_tangent {
    /// Number of bisections for the load at the first negative eigenvalue: 1e-5 of the step.
    pub const BISECTIONS: usize = 17;
    /// Number of points in a step with an evaluated determinant, because two modes that buckle one after the other do not change its sign.
    pub const SCANS: usize = 16;
    /// Turn of a node in a step, in radians, above which the interpolated tangents K₀ + θ (K₁ − K₀) are unsuitable for determinants.
    /// Half-way their error is an eighth of its square, relative to the stiffest terms, and slender parts bend a thousand times more easily
    /// than they stretch.
    pub const TURNS: f64 = 0.05;
    /// A negative eigenvalue below this part of the diagonal is rounding; a thousand elements in bending have 1e-12.
    pub const ROUNDING: f64 = 1e-14;
}

pub mod stability {
    /// Part of the deck's step below which steps to an unstable branch are not cut again. A strut with a lateral load of 1e-6 of its
    /// buckling load bends away within 1e-4 of it.
    pub const SHORTEST: f64 = 1.0 / 4096.0;
}

pub mod out_of_plane {
    /// Largest number of parts that may turn about their own axes, each restrained by a spring.
    pub const MOST_HELD: usize = 8;
}

pub mod contacts {
    /// Visible penetration, as a part of the size of the touching body, for a stiffness chosen by rdsolve: five times the intended one.
    pub const SEEN: f64 = 0.05;
    /// Limit for a stiffness in the deck, which may describe a soft tyre or buffer: beyond its centre a body has no side left.
    pub const MEANT: f64 = 0.5;
    /// Number of implicit and of explicit steps for an impact where steps are not cut, as in the choice of stiffnesses.
    pub const STEPS_OF_IMPACT: [f64; 2] = [10.0, 5.0];
    /// Limit for faces and for balls among each other: their size is the penetration between touching centres.
    pub const TO_THE_MIDDLE: f64 = 0.5;
    /// Penetration at the beginning, as a part of the size of the touching body: the value used to choose stiffnesses.
    pub const BEGINS_CLOSED: f64 = 1e-3;
    /// Penetration at rest, as a part of the size of a body: the value used to choose stiffnesses.
    pub const SUNK: f64 = 1e-3;
}

pub mod strain {
    /// Strain with forces wrong by a tenth: the stress conjugate to Green's strain makes them too large by twice the strain.
    pub const LARGE: f64 = 0.05;
    /// Limits for the truncated series of logarithmic strain: at stretches of 1.34 and 0.75 forces are wrong by a hundredth.
    pub const LARGE_LOGARITHMIC: [f64; 2] = [-0.22, 0.4];
    /// Elastic strain of a beam beyond that of metals, wood, concrete and fibres; loads in N for kN give 0.1 and more.
    pub const BEYOND_ELASTIC: f64 = 0.1;
    /// Modulus in Pa below that of these: rubber, rope and foam stay elastic beyond.
    pub const SOFT: f64 = 1e9;
    /// Error of displacements by rotations in the frame of a superelement or a reduced part.
    pub const BENT: f64 = 0.003;
    /// Number of checks of strains in a run: plastic strains do not disappear.
    pub const LOOKS: f64 = 100.0;
}

pub mod drift {
    /// The drift, in radians, that causes a warning.
    pub const NOTICED: f64 = 1e-3;
    /// Number of checks of rotations in a run.
    pub const LOOKS: f64 = 100.0;
}

pub mod energy_growth {
    /// Generated energy, as a multiple of the available energy, above which a run is lost and ends.
    pub const FAR: f64 = 100.0;
    /// Kinetic energy at the end of a run by other schemes, beyond the available energy and as a multiple of it, above which the run fails. A
    /// sudden start leaves a multiple of 3 in unresolved modes for some steps.
    pub const LOST: f64 = 10.0;
    /// Part of the available energy that steps may generate with sound results.
    pub const SOUND: f64 = 0.02;
}

// Control of the step length.

pub mod fixed {
    /// Largest number of halvings of a step; the deck's least step may stop earlier.
    pub const MOST_HALVINGS: u32 = 40;
    /// Largest number of substeps of a step, without contacts and with them. Without contacts, consecutive steps that are
    /// each cut into more than `MANY` substeps count together.
    pub const MOST_SUBSTEPS: [usize; 2] = [1024, 4096];
    /// Number of substeps in a step above which consecutive steps count together.
    pub const MANY: usize = 32;
    /// Halvings of a step whose corrections are shortened.
    pub const CAREFUL_HALVINGS: u32 = 6;
}

pub mod embedded_error {
    /// Safety factor on the length that would just meet the tolerance.
    pub const SAFETY: f64 = 0.9;
    /// Least and largest ratio of a step to the one before.
    pub const GROWTH: [f64; 2] = [0.2, 5.0];
    /// Least number of steps of a run. With 30 to 50 steps a body that tumbles five times and its comparison run erred alike: the estimate was 7 to
    /// 60 times too low.
    pub const FEWEST: f64 = 100.0;
    /// The longest rotation of a step, in radians, at the largest angular velocity of the step before. The comparison run of order 8, whose steps
    /// are 1.3 times as long, stays below the limit of a rotation vector, [`super::explicit_runge_kutta::FARTHEST`].
    pub const TURN: f64 = 2.2;
    /// The largest velocity times this fraction of the run counts as displacement, for at the start there is none.
    pub const GLANCE: f64 = 1e-3;
}

pub mod error_controlled {
    /// A step is taken back where its error exceeds this multiple of its allowance and of recent errors: an event has
    /// occurred.
    pub const TOO_MUCH: f64 = 4.0;
    /// Safety factor on the length that would just meet the tolerance.
    pub const SAFETY: f64 = 0.9;
    /// Steps grow only where they may by this factor, and by no more than two, since a new length costs a new matrix.
    pub const WORTH: f64 = 1.4;
    /// Errors oscillate with the motion, and their sum counts, so lengths follow a mean over this fraction of the run, ...
    pub const SPAN: f64 = 0.05;
    /// ... with at least this weight of the last step.
    pub const WEIGHT: f64 = 0.002;
    /// Fraction of the sum of all errors that remains at the end. Steady growth to 1 of an oscillation has a root mean square of 1/√6 over
    /// a run; errors partly cancel, as the models B1, C4 and X1 show.
    pub const MEAN: f64 = 0.3;
    /// This fraction of the damping by Runge-Kutta schemes, which cancels less.
    pub const MEAN_OF_STAGES: f64 = 0.6;
    /// Least number of steps of a run.
    pub const FEWEST: f64 = 50.0;
    /// Lengths of the trial steps that measure the motion ahead when motion begins, as fractions of the run; the first are
    /// short, for the sake of impacts. They have no common divisor, lest all of them end where a vibration passes through
    /// zero.
    pub const TRIALS: [f64; 6] = [1.7e-4, 7.1e-4, 2.9e-3, 0.011, 0.037, 0.053];
    /// An estimate reduced below this fraction by two filters belongs to unresolved motion with a period of at most four steps. A third
    /// filter shows other motion by more than the root of this fraction.
    pub const RESOLVED: f64 = 0.3;
    /// Number of filters that remove such motion, and keep most of a mode with ten steps a period.
    pub const FILTERS: usize = 8;
    /// Unresolved motion is left to the numerical damping of the scheme while its amplitude is below this multiple of the
    /// tolerance: shorter steps would only prolong it.
    pub const SLIGHT: f64 = 2.0;
}

pub mod out_of_reach {
    /// Force of a drive over the largest other force on a node, above which the links lie in one line: to a third of a degree. Levers and gears
    /// of machines stay below a hundred.
    pub const MOST: f64 = 200.0;
}

pub mod context {
    /// Motion, in parts of the model's length, that rounding of forces in equilibrium causes. The arm of a loader at rest accelerates by 1e-10 of
    /// gravity, and a step moves it by 1e-13 of its length. A run adds a hundred such steps.
    pub const FORCES: f64 = 1e-11;
    /// This motion in parts of the largest coordinate, whose last digits are rounding.
    pub const POSITIONS: f64 = 100.0 * f64::EPSILON;
}

pub mod error_measure {
    /// Fraction of a run after which the motion so far is reference enough.
    pub const AHEAD: f64 = 0.2;
    /// Motion of one kind below this fraction of the other, over the model's length, is rounding.
    pub const TRACE: f64 = 1e-6;
}

pub mod arc_length {
    /// Desired number of iterations of a step, the first being the prediction: more make it too long for its cost, fewer too short. Frames of
    /// slender beams take a third fewer iterations in all than with five; with eight roofs leave their path.
    pub const DESIRED: f64 = 6.0;
    /// The desired iterations where material yields. Fibres that begin to yield or unload cost iterations in steps of any length.
    /// With six, frames of perfectly plastic columns need thousands of steps.
    pub const DESIRED_WITH_HISTORY: f64 = 12.0;
    /// Largest ratio of a step to the one before, and of the one before to it.
    pub const CHANGE: f64 = 2.0;
    /// Cosine of the angle between steps below which they grow no more.
    pub const STRAIGHT: f64 = 0.8;
    /// Cosine below which a step may have left the path and is tried at half the length. The number of trials is limited, since paths have
    /// kinks at first yield for all step lengths.
    pub const BENT: f64 = 0.2;
    /// Number of times that a step is tried at half the length because the path bends.
    pub const TRIES: usize = 3;
    /// Number of iterations beyond which the first step is tried at half the load.
    pub const HARD: usize = 12;
    /// Largest number of steps of a path, unless the deck gives another.
    pub const MOST_STEPS: usize = 100_000;
    /// Part of the displacement that counts as progress of a path.
    pub const CREEPS: f64 = 1e-3;
    /// Number of steps without progress after which a path creeps: of steps shorter than the first, and of others. A fine path needs some
    /// hundreds to turn.
    pub const CREEPING_STEPS: [usize; 2] = [200, 2000];
    /// A step ends at the value of a controlled displacement if it passes this value by more than this part of the last step: well above rounding.
    pub const PASSES: f64 = 1e-3;
    /// Number of targets tried in a step before it is cut: they may lie in another order than straight lines suggest.
    pub const MOST_TARGETS: usize = 8;
}

pub mod stability_limited {
    /// Largest growth from step to step: growth is slow, since each change of the step generates or dissipates energy.
    pub const GROWTH: f64 = 1.2;
}

pub mod end_at_stop {
    /// Steps that are tried at most: by then the interval is at rounding.
    pub const TRIED: usize = 60;
}

pub mod tolerance {
    /// Longest step with an event inside, in units of the run times the root of the tolerance. The error of such a step is
    /// proportional to the square of its length. A step of a twentieth of the duration of a contact then has an error below a tenth of the
    /// tolerance.
    pub const LONGEST_WITH_EVENT: f64 = 0.01;
}

// Explicit schemes.

pub mod stiffening {
    /// Below this fraction of the limit, by approximate inertias, the quotient is not computed.
    pub const QUICK: f64 = 0.05;
    /// The quotient of a growing mode, slightly above the value of a mode at the limit.
    pub const LIMIT: f64 = 4.1;
}

pub mod scaled_step {
    /// Differences of residuals leave seven digits of the limit.
    pub const ROUNDING: f64 = 1e-4;
    /// Part of the stiffness of a mode above which one link or contact causes its high frequency.
    pub const MOST: f64 = 0.5;
}

pub mod critical_step {
    /// Number of power iterations at the start, and when the limit is measured again: one residual each, two with damping.
    pub const AT_FIRST: usize = 60;
    /// Number of power iterations when the limit is measured again: the mode of the last time leads.
    pub const AGAIN: usize = 3;
    /// Relative change from one iteration to the next that ends them.
    pub const SETTLED: f64 = 1e-4;
    /// Largest rotation of a body in a step, in radians: no stiffness limits tops and mechanisms. The error θ²/24 of the
    /// angle that central differences have in an oscillation is 6.5e-4 in a full turn.
    pub const TURN: f64 = 0.05;
    /// A limit longer by this factor belongs to another mode.
    pub const LONGER: f64 = 1.05;
    /// A limit shorter by this factor counts as a cutback.
    pub const SHORTER: f64 = 0.95;
    /// The displacement for differences of residuals, over the model's length. Over the length of an element it is a strain, which must not
    /// make steel yield: with a thousand elements it is 2e-6. Positions in two parts leave seven digits of it.
    pub const SMALL: f64 = 1e-9;
    /// Factor on the square of the frequency, which power iteration approaches from below.
    pub const BELOW: f64 = 1.1;
}

pub mod explicit_runge_kutta {
    /// Square of the longest rotation vector of a step: T⁻¹ is singular at a full turn.
    pub const FARTHEST: f64 = 9.0;
}

// Start, stages and ends of a run.

pub mod start {
    /// The largest change of initial velocities, relative to the largest velocity, that joints may require without a word: a deck gives
    /// its numbers with some digits only.
    pub const DIGITS: f64 = 1e-5;
    /// The part of the size of the model that counts as no motion over a whole run.
    pub const NOWHERE: f64 = 1e-9;
    /// A factor on masses that reduces accelerations below rounding.
    pub const FIXED: f64 = 1e20;
}

pub mod initial_transient {
    /// Motions by such an acceleration in a step, as parts of the model's length and in radians, that stretch slender parts only a little.
    pub const LARGE: f64 = 1e-3;
    /// Relative difference of an acceleration from the acceleration of an implicit step, above which the step does not resolve it. Above
    /// this difference from the value before a jump it counts as jumping.
    pub const UNRESOLVED: f64 = 0.5;
}

pub mod handover {
    /// Points that are nearer than this part of the size of their coordinates are at one place.
    pub const MEETING: f64 = 1e-9;
    /// The part of the largest force that an equilibrium may leave out of balance.
    pub const LEFT: f64 = 1e-6;
}

pub mod stop_watch {
    /// Part of the value within which a shortened step of given length has reached it.
    pub const MET: f64 = 1e-8;
}

pub mod global_error {
    /// Part of the time between comparisons below which a stage stops too early for an estimate of its error.
    pub const EARLY: f64 = 0.4;
    /// The part of it for the stop of such a stage in the next run.
    pub const IN_TIME: f64 = 0.8;
    /// Largest number of runs, the comparison run aside.
    pub const MOST_RUNS: usize = 4;
    /// Largest number of runs that end early because of a predicted error.
    pub const MOST_EARLY: usize = 2;
    /// Part of the requested error that a second run, or the rest of a run with a lower tolerance, aims at.
    pub const AIM: f64 = 0.6;
    /// Multiple of the requested error that is still accepted.
    pub const WITHIN: f64 = 1.5;
    /// Ratio of the tolerances of the comparison run and the run: for a scheme of third order its steps are twice as long.
    pub const LOOSER: f64 = 8.0;
    /// Least and largest ratio of the tolerances of two runs in a row. Estimates from far apart are too large. With a least ratio of 0.01 runs
    /// erred by a tenth of the request, and took two to three times the iterations. Estimates of ten times the request and more lower the least ratio to the
    /// root of the one wanted: a hub with blades then keeps 1e-4, with 0.73 of it in place of 2.4.
    pub const CHANGE: [f64; 2] = [0.25, 0.5];
    /// Least and largest ratio of the tolerances after a run that has ended early. Later parts of the next run make up for one that is too strict. With a least ratio of 0.1 a hub with blades
    /// needs a fifth more iterations at 1e-3, and four other scenes differ by 1 % at most.
    pub const CHANGE_EARLY: [f64; 2] = [0.03, 0.5];
    /// Least and largest ratio for runs with events.
    pub const CHANGE_WITH_EVENTS: [f64; 2] = [0.01, 0.5];
    /// Ratio to the steps of the run before above which a run is aborted: its motion cannot be resolved.
    pub const MOST_LONGER: usize = 30;
    /// A comparison run with more than twice the steps of its run plus this number is aborted: its longer steps do not follow the motion.
    pub const FEW: usize = 100;
    /// Ratio of the tolerances where two runs have nothing in common.
    pub const LOST: f64 = 0.03;
    /// The difference of two runs that have nothing in common, relative to the motion.
    pub const SATURATED: f64 = 0.3;
    /// Ratio of the errors of a pilot run and a run above which a comparison run tells the error better.
    pub const FAR_APART: f64 = 30.0;
    /// Largest ratio of the tolerances of the first run and its pilot run in a scene with kinks. Steps are two thirds as long by a scheme of third
    /// order, and both runs tell an error.
    pub const STRICTER: f64 = 0.3;
}

pub mod trace {
    /// Largest number of nodes that are compared; of more nodes every second, third, ... is.
    pub const MOST_NODES: usize = 20_000;
    /// Errors of steps add up to less than their sum: they fall at least with this power of it.
    pub const SLOPE: f64 = 0.8;
    /// Largest factor between the ratio of two errors and its estimate by the steps. In the reference scenes both differ by 1.7 at most. If one run
    /// damps vibrations away that the other keeps, they differ by 4.6 to 13.
    pub const OWN_ESTIMATE: f64 = 2.0;
    /// Number of step ends with reserved memory; unused memory costs nothing.
    pub const USUAL_STEPS: usize = 1 << 16;
    /// Largest ratio of the errors of two runs with events, even if the steps of one are more than twice as long: events come one at a time.
    pub const EVENTFUL: f64 = 2.0;
    /// Runs with nearly equal steps are no measure of each other.
    pub const TELLING: f64 = 1.1;
    /// Least number of times, since both runs may agree by chance at one of them.
    pub const FEWEST: usize = 3;
}

pub mod look_ahead {
    /// Number of the time of the first prediction of the error of a whole run, a quarter of all.
    pub const PREDICTED_AT: usize = 4;
    /// Number of the time when a prediction may end the run. The difference to a pilot run that damps vibrations away grows until then.
    pub const JUDGED_AT: usize = 6;
    /// Predicted error, as a multiple of the error asked for, that ends a run early. With 2 three of 16 runs of beams took 20 to 42 % more iterations.
    pub const FUTILE: f64 = 4.0;
    /// The same before [`JUDGED_AT`]. If no run ends so early, a hub with blades needs half as many iterations again at 1e-3. With a value of 2 a block on
    /// a cantilever needs twice as many.
    pub const FUTILE_EARLY: f64 = 6.0;
    /// Least factor between two tolerances of a run, for steps two thirds as long by a scheme of third order. A rest that needs a smaller one takes
    /// this one, if the error then stays within the accepted one. Otherwise the steps so far have made the error, which no later steps undo. With 0.1 five
    /// scenes need a tenth more iterations in the mean, and 2.7 times as many at the worst.
    pub const LOWEST: f64 = 0.25;
    /// Largest power of time that errors are believed to follow. A constant error of accelerations becomes an error of positions with the
    /// square of time; the rest is for motion that speeds up. Chosen, not measured.
    pub const FASTEST: f64 = 2.5;
    /// Least factor between two tolerances that is worth the matrix of another step. Steps of a scheme of third order become 1.14 times as long.
    pub const WORTH: f64 = 1.5;
    /// Largest ratio of a tolerance to the error asked for. Steps of a scheme of third order are then 1.6 times as long, so one wrong prediction
    /// hardly loses the motion. With 16 a snap-through needs 5 % fewer iterations of its last run at 1e-3, and 3 % more at 1e-2.
    pub const MOST: f64 = 4.0;
    /// Least ratio a of the errors of the pilot run and the run after a rise. If it is 10 % too large there, the error told, D/(a - 1), is 20 % too
    /// small; with a smaller ratio it would be worse.
    pub const NEAREST: f64 = 1.8;
}

pub mod modes_at_end {
    /// Residual of an equilibrium, as a part of the forces; a state at rest by time integration has some.
    pub const BALANCED: f64 = 1e-3;
    /// Forces that move nothing by more than this part of the largest coordinate are rounding. If no load acts, so are forces below this
    /// part of all loads.
    pub const ROUNDING: f64 = 1e-12;
}

// Plan.

pub mod mass_scaling {
    /// Largest number of named errors; more are counted.
    pub const MOST: usize = 5;
}

pub mod explained_shells {
    /// Largest errors of the moment of a yielding rectangle, in per cent of the plastic moment, up to so many layers. The three are for first
    /// bending, for cycles of one amplitude, and for changing amplitudes; docs/limits.md lists them.
    pub const MOMENT_OFF: [(usize, [f64; 3]); 3] =
        [(7, [5.5, 13.0, 14.0]), (11, [1.0, 2.9, 5.5]), (15, [0.5, 1.3, 2.4])];
    /// Layers for cycles, with errors of 0.33, 0.9 and 2.1 %.
    pub const CYCLES_WANT: usize = 16;
}

pub mod redundant_constraints {
    /// An equation is redundant where less than this fraction of its gradient is linearly independent of earlier ones.
    pub const NEW: f64 = 1e-8;
    /// Largest number of operations for the search; larger sets of joints are not searched.
    pub const MOST: f64 = 5e7;
    /// Extent of a scene, relative to its distance from the origin, that rounding may have made.
    pub const ROUNDING: f64 = 1e-9;
}

pub mod threads {
    /// Least number of nodes for several threads in loops over nodes.
    pub const NODES_WORTH_THREADS: usize = 2048;
}

pub mod savings {
    /// Ratios below this are not worth a line.
    pub const WORTH: f64 = 1.05;
}

pub mod row_gaps {
    /// Largest difference between the displacement of two rows and that by their velocities, over the sum of both. A sine with five rows a period
    /// has 0.07, one with four 0.12 and one with three 0.25. Rows then miss its peaks by up to 0.2, 0.3 and 0.5.
    pub const STRAIGHT: f64 = 0.1;
    /// Part of the rows that do so. A blow in one of them is no motion between rows.
    pub const MOST_UNRESOLVED: f64 = 0.4;
    /// Amplitude of a motion between rows, over the size of the whole motion, that is seen in tables.
    pub const SEEN: f64 = 0.03;
    /// Largest such share; a sine has 0.5. Motions that grow without end have more, and other warnings.
    pub const MOST: f64 = 2.0;
    /// Rows in a period that show a motion. Blows beside a motion raise its accelerations alone, and the period then comes out longer.
    pub const MOST_ROWS: f64 = 5.0;
    /// Smallest number of rows that are judged.
    pub const ENOUGH_ROWS: usize = 8;
}

pub mod explained_quantities {
    /// A sum of loads, or a coordinate of the center of mass, below this part of the largest is rounding: sums of thousands of terms keep 12 digits.
    pub const ROUNDING: f64 = 1e-9;
}

pub mod explained_mass_scaling {
    /// Mass added by mass scaling, as a share of a part, that causes a warning. Spread over the part it lowers frequencies by 2.4 %, in a
    /// few elements at the end of a cantilever by 8 %. Guides to crash analysis use this limit for each part.
    pub const MUCH: f64 = 0.05;
}

// Small motions.

pub mod rest {
    /// Largest residual force relative to the largest terms.
    pub const UNBALANCED: f64 = 1e-12;
    /// Largest motion that forces may cause in a model at rest, relative to its size.
    pub const STILL: f64 = 1e-9;
}

pub mod linearized {
    /// Angle, in radians over the time of the analysis, below which a spin is rounding.
    pub const ROUNDING: f64 = 1e-12;
}

pub mod modal {
    /// Length of the residual of S φ = θ φ, relative to θ; eigenvalues have an error of its square over the distance to the next.
    pub const TOLERANCE: f64 = 1e-9;
    /// Starting vectors: pairs of equal frequencies, which symmetry makes, are found together.
    pub const WIDTH: usize = 2;
    /// Most modes that are computed at once.
    pub const MOST: usize = 2000;
    /// Searches for modes that the pivots show and the iteration has not found.
    pub const SEARCHES: usize = 8;
    /// Part of the shift below which an eigenvalue is rounding.
    pub const ROUNDING: f64 = 1e-14;
    /// Expansions after which a shift is judged.
    pub const PROBE: usize = 12;
    /// Part of a shift below which an eigenvalue is zero, or next to it.
    pub const LOW: f64 = 1e-4;
    /// Relative shift of the bound for the number of modes if it meets an eigenvalue.
    pub const NEAR: f64 = 1e-7;
    /// Shifts that are tried.
    pub const SHIFTS: usize = 30;
    /// A shift within these multiples of the lowest frequency squared that is not zero serves as well as any other.
    pub const FITS: [f64; 2] = [0.03, 1e3];
    /// Eigenvalues smaller than others by this factor count as zero: with a shift at zero the others would lose too many of sixteen digits.
    pub const APART: f64 = 1e5;
    /// Squares of frequencies that lie farther apart lose digits.
    pub const FAR_APART: f64 = 1e12;
    /// Times the rounding of rigid motions.
    pub const NEXT_TO: f64 = 1e4;
}

pub mod buckling {
    /// Length of residuals relative to their eigenvalues.
    pub const TOLERANCE: f64 = 1e-9;
    /// Vectors that the Krylov space grows by at once.
    pub const WIDTH: usize = 2;
    /// Step of the first differences, as a displacement relative to the size of the scene and a rotation.
    pub const SMALL: f64 = 1e-4;
    /// Step of the final differences, as such a motion at most, and as a part of the lowest factor. A rotation θ stretches and shears a
    /// part of slenderness s by s² θ² of the load's effect, which differences of second order would keep. Differences of sixth order keep
    /// s² θ⁶, with a rounding error of 1e-15 s²/θ.
    pub const STEP: f64 = 3e-3;
    /// Factors farther from zero than the nearest by the inverse of this are rounding.
    pub const FARTHEST: f64 = 1e-8;
    /// Number of equal factors found one by one before the search ends.
    pub const CLUSTER: usize = 200;
    /// Largest motion, measured as for [`STEP`], for the check of slack bars.
    pub const MODERATE: f64 = 0.05;
    /// Searches for factors that pivots show and the iteration has not found.
    pub const SEARCHES: usize = 8;
}

pub mod shares {
    /// Energy of a part above this part of its terms without signs is no rounding, ...
    pub const CLEAR: f64 = 1e-6;
    /// ... unless the motions are rounding: the square of their ratio to the largest motion.
    pub const STILL: f64 = 1e-16;
}

pub mod damped {
    /// Length of residuals relative to eigenvalues.
    pub const TOLERANCE: f64 = 1e-11;
    /// Starting vectors: pairs of equal roots are found together.
    pub const WIDTH: usize = 2;
    /// Roots below this part of the shift are zero. Motions without stiffness have double roots, which rounding splits by the square root
    /// of its size.
    pub const ZERO: f64 = 3e-6;
    /// If motions have no stiffness, roots below this multiple of the rounding of rigid-body stiffness belong to them.
    pub const SPLIT: f64 = 4.0;
    /// Limit of roots counted as zero, as a part of the shift, above which other roots may be among them.
    pub const DOUBTFUL: f64 = 0.1;
    /// A root grows where its real part is larger than this part of it.
    pub const GROWS: f64 = 1e-7;
    /// Roots farther from the shift than the nearest root by the inverse of this are infinite: they belong to motions restrained by joints,
    /// or without mass.
    pub const INFINITE: f64 = 1e-10;
    /// Number of modes with room if a frequency is given.
    pub const UP_TO: usize = 100;
}

pub mod speeds {
    /// Difference of a frequency from the speed, relative to it, that ends the search for a critical speed: roots have eleven digits.
    pub const CLOSE: f64 = 1e-10;
    /// A larger difference at the end of the search is a jump of the frequency.
    pub const CONTINUOUS: f64 = 1e-6;
    /// Orbits with a smaller sense are lines to the eye.
    pub const PLANAR: f64 = 0.01;
    /// Most steps of a search; halving alone reaches the tolerance in 34.
    pub const MOST_STEPS: usize = 60;
    /// Number of speeds in a search for critical speeds. Between two of them a frequency meets the speed once: it grows slower than the speed, and forward
    /// whirl of flat discs meets it nowhere.
    pub const IN_RANGE: usize = 9;
}

pub mod shape {
    /// Stiffness times motion rounds to this part of the sum of its terms without signs; an eigenvalue below it is zero.
    pub const ROUNDING: f64 = 2e-15;
    /// Displacements below this part of the rotations times the size of the scene are rounding.
    pub const STILL: f64 = 1e-7;
}

pub mod spin_in_words {
    /// Relative difference of two spins in one group.
    pub const ALIKE: f64 = 1e-9;
}

pub mod gyroscopic {
    /// Kinetic energy across the axis of the spin, as a part of that along and about it, below which it is rounding.
    pub const ORBIT: f64 = 1e-10;
    /// Small motion for differences of forces: its square, and rounding over it, are below 1e-7.
    pub const STEP: f64 = 1e-4;
    /// Difference of the shapes of a round part and those turned about its axis, as a part of these: rounding of pairs of modes.
    pub const ROUND: f64 = 1e-6;
    /// Largest sine of the angle between the spin and an axis of symmetry of a part that spins about this axis. Shafts sag by less.
    pub const SAG: f64 = 0.01;
    /// An asymmetry below this part is rounding.
    pub const SYMMETRIC: f64 = 1e-9;
    /// Part of a mode's kinetic energy across the axis of a rotation below which its Coriolis forces change the frequency by no more than such a part.
    pub const ACROSS: f64 = 1e-3;
    /// Least difference between the spins of the ends of an element, as a part of the faster one, that is no rounding of given numbers.
    pub const UNEVEN: f64 = 1e-3;
}

pub mod pencil {
    /// Gap of a motion relative to its size above which joints restrain the motion; smaller gaps are rounding.
    pub const FORBIDDEN: f64 = 1e-6;
    /// Ratio of stiffness to mass, relative to the largest, that is rounding in unresisted motions.
    pub const ROUNDING: f64 = 1e-12;
}

pub mod frequencies {
    /// The nearest of the frequencies around a natural one, relative to it; the others lie farther by equal factors, up to [`FAR`].
    pub const NEAR: f64 = 1e-3;
    /// The farthest of the frequencies around a natural one, relative to it.
    pub const FAR: f64 = 0.1;
}

pub mod modal_response {
    /// Eigenvalues below this part of the largest found count as zero.
    pub const ZERO: f64 = 1e-6;
    /// Terms of damping between modes below this part of the largest couple nothing.
    pub const COUPLED: f64 = 1e-12;
    /// Results are good up to this part of the highest frequency found. A missing mode is then at least twice as fast, and wrong by a
    /// tenth at most.
    pub const NEAR: f64 = 0.5;
    /// Part of the stiffness of a mode below which inertia and damping leave none of it: natural frequencies are known to this.
    pub const NOTHING_LEFT: f64 = 1e-8;
    /// Part of all forces below which rounding alone drives a mode.
    pub const UNDRIVEN: f64 = 1e-9;
}

pub mod response_between {
    /// Part of the largest motion below which a component is rounding.
    pub const ROUNDING: f64 = 1e-6;
    /// Ratio of a peak to the motions beside it above which it counts as missed: rows as far apart as the peak is wide show 0.9 of it.
    pub const HIGHER: f64 = 2.0;
    /// Ratio above which nothing limits the peak: a damping of 1e-8 with frequencies a hundredth apart.
    pub const UNLIMITED: f64 = 1e6;
}

pub mod direct_response {
    /// Residual of the equations above which a solution is in doubt.
    pub const DOUBTFUL: f64 = 1e-8;
    /// Penalties of joints use the stiffness and the inertia at this multiple of the highest frequency, so no inertia at lower frequencies
    /// cancels them.
    pub const BEYOND: f64 = 2.0;
    /// Part of the least ratio of stiffness and inertia below which a motion without stiffness counts as one.
    pub const NEXT_TO_ZERO: f64 = 1e-6;
    /// Number of solutions that close the gaps of joints; each reduces them to a small part.
    pub const CLOSINGS: usize = 3;
    /// Relative difference of the motions on both sides of a frequency that is allowed without resonance.
    pub const SAME: f64 = 1e-4;
    /// Relative shift of a frequency to both sides if its equations cannot be solved.
    pub const ASIDE: f64 = 1e-9;
    /// Relative difference below which a natural frequency equals a given one.
    pub const SAME_FREQUENCY: f64 = 1e-6;
    /// Ratio to the least motion above which a motion is checked for resonance.
    pub const LARGE: f64 = 1e6;
    /// Relative shift of a frequency, and the part of the motion that remains there in a resonance without damping.
    pub const BESIDE_RESONANCE: [f64; 2] = [1e-6, 0.02];
}

pub mod damped_rest {
    /// Static response to the damping force of a mode, as a part of the stiffness of the mode, below which it is neglected.
    pub const SMALL: f64 = 1e-9;
    /// A motion depends on earlier ones if less than this part of it is independent.
    pub const ALIKE: f64 = 1e-6;
    /// Number of times that the damping forces of such motions are applied.
    pub const ROUNDS: usize = 2;
}

pub mod dynamic_stiffness {
    /// Unknowns of a group.
    pub const MOST: usize = 3;
    /// Residual of a right-hand side, relative to its largest entry, that ends refinement.
    pub const LEFT: f64 = 1e-14;
    /// Change of a solution below the accuracy of results.
    pub const NEGLIGIBLE: f64 = 1e-6;
    /// Refinements of a solution.
    pub const REFINEMENTS: usize = 4;
}

// The system of equations.

pub mod turning_body {
    /// The rounding of a zero inertia, as a part of the largest principal inertia.
    pub const NEGLIGIBLE: f64 = 1e-12;
    /// The rounding of the largest principal inertia relative to the sum of the two others, and of differences between equal ones.
    pub const ROUNDING: f64 = 1e-9;
    /// The part of the largest principal inertia below which an axis follows the momentum in space in part only.
    pub const THIN: f64 = 0.1;
    /// Number of passes between a rate and the acceleration that depends on it: each reduces the error by a third of the turn of a step.
    pub const PASSES: usize = 2;
}

pub mod thin_axes {
    /// Least inertia relative to the largest. At this ratio the error of the iteration turns a hung rod with 6 rad/s by 5e-4 of its spin too much.
    /// At 1e-9 it is 1 %, and at 1e-10 runs lose a free rod.
    pub const LEAST: f64 = 1e-8;
    /// Distance of a point from the axis, over the radius of gyration, that decimals of a deck leave.
    pub const ON_AXIS: f64 = 1e-9;
    /// Rounding of an inertia of zero, relative to the largest inertia.
    pub const ROUNDING: f64 = 1e-12;
}

pub mod free_rotation {
    /// Part of the largest inertia that counts as none: about such an axis there is no momentum.
    pub const NEGLIGIBLE: f64 = 1e-12;
}

pub mod masses {
    /// Ratio to an entry before subtractions below which the remainder counts as zero.
    pub const NEGLIGIBLE: f64 = 1e-12;
    /// Number of corrections of the velocities of a node with restrained degrees of freedom.
    pub const CORRECTIONS: usize = 2;
}

pub mod energy {
    /// Some thousand times the rounding of a position, which steps add up.
    pub const ROUNDING: f64 = 1e-12;
    /// Least reference energy, as a part of the largest energy: errors of the other results exceed a loss of 3e-5 of the speed.
    pub const OF_PEAK: f64 = 3e-3;
    /// Multiple of the exchanged energy: an unresolved vibration dissipates before its energy was stored once.
    pub const GONE: f64 = 5.0;
    /// Part of the largest energy that is rounding in a stage without motion.
    pub const NOTHING_HAPPENS: f64 = 1e-9;
}

pub mod scale {
    /// Arm of forces, as a part of a length, for the scale of moments: if only forces act, moments are rounding of them.
    pub const ARM: f64 = 1e-2;
}

pub mod shell_shear {
    /// Directors whose cosine is below this meet at a fold.
    pub const SAME: f64 = 1.0 - 1e-9;
}

pub mod multipliers {
    /// ε regularizes redundant constraint equations: it amplifies rounding in a redundant equation by 1/ε, and each iteration reduces a gap
    /// to the fraction ε.
    pub const REGULARIZATION: f64 = 1e-7;
    /// ε where no equation is redundant. In a chain of N joints an iteration reduces smooth gaps to the fraction ε/(ε + (π/2N)²). With the
    /// other ε a tenth remains for two thousand joints, and nearly all for twenty thousand.
    pub const REGULARIZATION_OF_TREES: f64 = 1e-11;
}

pub mod plane {
    /// A number counts as zero below this fraction of the entries beside it.
    pub const SMALL: f64 = 1e-12;
}

pub mod excitation {
    /// Fraction of a run over which the slope beyond its end is taken.
    pub const TAIL: f64 = 0.01;
    /// How far loads may pass the end of a stage under displacement control, in its end time.
    pub const FARTHEST: f64 = 1e6;
}

pub mod penalties {
    /// Ratio of masses or stiffnesses below which an iteration reduces a gap to 1e-3 or less.
    pub const MODERATE: f64 = 1e4;
    /// Factor of a joint, as a part of the largest, below which its forces are rounding. Also the limit for forces relative to the reaction
    /// to a gap of the size of the model, or to a rotation of one radian.
    pub const NOTHING: f64 = 1e-12;
    /// Part of the largest stiffness below which another one stems from rounding alone.
    pub const UNFELT: f64 = NOTHING * NOTHING;
    /// A moment of a joint that is this part of its force along the scene gives no measure of its stiffness, whatever the iteration has made of it.
    pub const FAINT: f64 = 1e-6;
    /// Least ratio of the penalty factor of a joint to the stiffness of its forces. Their sum is then positive, although arms and
    /// directions reduce the effect of the factor.
    pub const FIRM: f64 = 100.0;
}

pub mod constraint_schur {
    /// An entry counts as zero below this fraction of the largest in its equation.
    pub const NEGLIGIBLE: f64 = 1e-12;
}

pub mod linear_statics {
    /// Rotation, or relative displacement over distance, in the longest step of differences. Along a straight motion slender parts stretch: with
    /// S = A L²/I the error is 0.1 S (TURN/3)⁶ in frames, and that of rounding S ε/TURN. Their sum is least near here, 2e-14 S.
    pub const TURN: f64 = 0.02;
    /// Factors of the steps on either side.
    pub const STEPS: [f64; 3] = [1.0, 2.0, 3.0];
    /// Weights of the first derivative, odd, over the step.
    pub const FIRST: [f64; 3] = [3.0 / 4.0, -3.0 / 20.0, 1.0 / 60.0];
    /// Weights of the second derivative, even, over the square of the step; the function is zero in the middle.
    pub const SECOND: [f64; 3] = [3.0 / 2.0, -3.0 / 20.0, 1.0 / 90.0];
    /// A linear analysis is doubtful from this rotation on, in radians: its cosine departs from 1 by half a percent.
    pub const LARGE_ROTATION: f64 = 0.1;
}

pub mod independent_rows {
    /// An equation is redundant where less than this fraction of its gradient is linearly independent of others.
    pub const NEW: f64 = 1e-8;
    /// Redundant equations are found at every evaluation in groups of at most so many: some ten million operations.
    pub const MOST: usize = 256;
}

pub mod element_stability {
    /// Largest squared radius of gyration for rotary inertia, over the squared distance of the nodes.
    pub const GYRATION: f64 = 1.0 / 8.0;
    /// Moments of inertia below this part of the largest are none.
    pub const NONE: f64 = 1e-12;
    /// Number of bisections for the part of the largest squared radii: the excess is 2⁻¹⁶ of them.
    pub const BISECTIONS: usize = 16;
    /// Relative distance between the step given to elements and the longest possible by rotary inertia alone: rounding of eigenvalues.
    pub const BORDER: f64 = 1e-6;
    /// Least relative reduction of the largest squared frequency by rotary inertia. Below it only mass is added, because rotary inertia
    /// would slow bending without benefit.
    pub const OF_USE: f64 = 0.02;
}

pub mod slip_watch {
    /// Part of the model's length above which slip is a visible motion.
    pub const OF_LENGTH: f64 = 1e-3;
    /// Multiple of the stretch of a spring of friction above which slip is a visible motion.
    pub const OF_STRETCH: f64 = 10.0;
    /// Error, as a part of the largest slip, that a warning reports.
    pub const SEEN: f64 = 0.02;
    /// Error, as a part of the largest slip, with the remedy of the warning.
    pub const LEFT: f64 = 0.01;
}

pub mod throws {
    /// Largest number of steps of an unresolved contact; a resolved one lasts longer.
    pub const BRIEF: usize = 3;
    /// Ratio of speeds after and before an unresolved contact; an elastic one returns its speed.
    pub const FASTER: f64 = 2.0;
    /// Periods of its springs after which a touching body rests.
    pub const PERIODS: f64 = 4.0;
    /// Steps after which a touching body rests.
    pub const STEPS: f64 = 10.0;
}

pub mod second_order {
    /// Most unknowns of interface and modes of a reduced part with terms of second order. Each tangent costs the square of their number for each coordinate.
    pub const LARGEST: usize = 100;
    /// The softest coordinates, whose products count. Stiffer ones stay small.
    pub const SOFT: usize = 20;
    /// Stiffness of a mechanism as a part of the largest: rounding. Beams without shear, a thousand times as long as thick, bend with 1e-10.
    pub const MECHANISM: f64 = 1e-12;
    /// Weight of a translation over the extent beside a slope: rigid motions are far from all others.
    pub const TRANSLATION: f64 = 0.1;
    /// Slopes of the states that give the terms. The next terms of even order are smaller by the square of this, and 10,000 times as large for beams
    /// without shear. Their rounding is 1e-5.
    pub const SLOPE: f64 = 2e-4;
    /// Terms of less weight at equal energies, as a part of the largest: rounding, and what nobody sees.
    pub const LEAST: f64 = 1e-6;
}

pub mod reduction {
    /// Difference between the initial velocity of an inner node and that of the static shapes, as a part of the largest. Shapes of
    /// ill-conditioned parts have 1e-8.
    pub const CARRIED: f64 = 1e-6;
    /// Difference of matrices of parts that are alike, as a part of the entry of the diagonal or the mass: rounding of their places.
    pub const ALIKE: f64 = 1e-10;
    /// Most unknowns of an interface: with 500 modes each of twelve matrices over both has 50 MB.
    pub const MOST: usize = 2000;
    /// Difference of two squared frequencies of a pair, as a part of these: rounding.
    pub const PAIR: f64 = 1e-8;
    /// An inertia load below this part of the largest is rounding of places.
    pub const UNLOADED: f64 = 1e-9;
    /// Eigenvalue of the energies of inertia loads below which a combination of them has no shape. Loads that differ by rotary inertia share one.
    pub const REPEATED: f64 = 1e-6;
    /// Least missing part of the energy of an inertia load for a static shape. Stretching has more beside bending; a beam of 2000 elements has
    /// rounding of 1e-15 there.
    pub const LACKING: f64 = 1e-9;
    /// Unknowns of an interface that are few, even if they are more than the unknowns inside.
    pub const FEW: usize = 300;
}

pub mod weak_axis {
    /// Largest torsional stiffness of an open section, over its lesser bending stiffness; of an I it is 0.03, of a flat bar 1.5.
    pub const OPEN: f64 = 0.2;
    /// Least ratio of both bending stiffnesses of a section that is meant to stand.
    pub const STRONG: f64 = 3.0;
    /// Largest sine of the slope of a horizontal beam.
    pub const LEVEL: f64 = 0.1;
}
