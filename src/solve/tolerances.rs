//! All thresholds of the solution, each with its reason: what is small, what is large, how often something is tried.
//!
//! A module for each file that asks.

// The step and its iteration.

pub mod iteration {
    /// Residual below which forces balance, so that open joints are to blame.
    pub const BALANCED: f64 = 1e-3;
    /// By how much longer an iteration may be whose corrections are shortened.
    pub const LONGER: usize = 4;
    /// Residual beyond a limit load is the excess load; a larger part of the forces shows lost iterates.
    pub const NEAR_LIMIT: f64 = 0.1;
}

pub mod convergence {
    /// Number of residuals that have not fallen after which none will; rounding halves one by chance.
    pub const STAGNANT: usize = 3;
    /// Contraction from which only rounding may be left to correct.
    pub const SLOW: f64 = 0.5;
    /// Part of the last residual above which a residual counts as one that has not fallen.
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
    /// Forces follow the motion: those of stiff parts are far from it long before the motion is, and no step builds on them.
    pub const PART_OF_FORCES: f64 = 0.1;
    /// A thousandth of a twelfth, rounded: errors of one sign add up.
    pub const PART_OF_FIRST: f64 = 1e-4;
    /// Whatever the error of the step: an impact, a load that jumps, or stiff parts that turn far in steps which do not resolve them, where
    /// what is left would drive them.
    pub const MOST_OF_FIRST: f64 = 1e-5;
    /// The step, in radians of an oscillator, for which dissipation is looked at.
    pub const DISSIPATION_TURN: f64 = 1.0;
    /// Above the rounding of eigenvalues.
    pub const NO_DISSIPATION: f64 = 1e-9;
}

pub mod progress {
    /// The residual, as a multiple of the tolerance and as it is, that must be met where material yields.
    pub const SURE: [f64; 2] = [1e3, 1e-3];
    /// A load step that ends at rounding with a residual larger than the tolerance by this factor is not what was asked for.
    pub const UNBALANCED: f64 = 1e3;
}

pub mod correction {
    /// The square of a slenderness, by which bending answers rounding of axial forces with larger corrections.
    pub const SLENDER: f64 = 1e4;
    /// The largest translation, in parts of the model's length, and the largest rotation, in radians.
    pub const LARGEST: [f64; 2] = [0.05, 0.25];
    /// A step that moves less, in radians or parts of the model's length, is judged by this motion.
    pub const STILL: f64 = 1e-6;
    /// A correction of the size of this part of the positions changes their last digits alone.
    pub const ROUNDING: f64 = 4.0 * f64::EPSILON;
}

pub mod augmentation {
    /// Equilibria of a step after which it is given up. One leaves a half where the spring is as soft as what it presses: enough for 1e-30.
    pub const MOST: usize = 100;
}

pub mod projection {
    /// Mass given to a degree of freedom without one, relative to the largest: so it is the one that gives way.
    pub const TRACE: f64 = 1e-9;
}

pub mod joints {
    /// Largest number of corrections of positions before the step is given up.
    pub const MOST_CORRECTIONS: usize = 12;
    /// A gap, relative to positions, that rounding may leave.
    pub const ROUNDING: f64 = 16.0 * f64::EPSILON;
    /// The largest gap, relative to positions, that a joint may have at the end of a step; iteration and projection leave far less.
    pub const LARGEST_GAP: f64 = 1e-9;
    /// Ratio of two principal inertias from which redundant loops do not close with explicit schemes.
    pub const UNLIKE: f64 = 1e11;
    /// Part of a body's largest inertia below which an axis has none.
    pub const NO_INERTIA: f64 = 1e-12;
}

pub mod residual {
    /// Part of the moments, over the model's length, by which forces are measured that have no scale of their own, and the reverse.
    pub const OTHER: f64 = 1e-3;
}

pub mod load_steps {
    /// Loads and motions below this part of the largest so far are those of a structure that has been let go: amplitudes come back to zero
    /// with the rounding of their times.
    pub const GONE: f64 = 1e-12;
    /// Supports that have moved by more than this part of the model's length, or in radians, stress what they deform a million times more than
    /// rounding does.
    pub const SEEN: f64 = 1e-9;
    /// A residual above this part of the forces that it is summed from leaves no digit of them.
    pub const ROUNDING: f64 = 0.1;
}

// Strategies of the iteration.

pub mod linearized_prediction {
    /// Part of the motion by which the residual is differentiated; a power of two, so that it is taken back exactly.
    pub const PART: f64 = 1.0 / (1 << 20) as f64;
}

pub mod refresh {
    /// Largest number of steps that begin with a fresh matrix because old ones have misled.
    pub const MOST_EAGER: usize = 64;
    /// Contraction from which any matrix is renewed: the iteration would take its limit.
    pub const USED_UP: f64 = 0.9;
    /// Contraction from which an old matrix has misled: a fresh one pays within two iterations.
    pub const MISLED: f64 = 0.5;
    /// Part of a step by which equal steps differ: by the rounding of their ends.
    pub const SAME_STEP: f64 = 1e-9;
    /// The contraction from which the second correction shows that the matrix was of no more use.
    pub const USELESS: f64 = 0.3;
    /// The contraction up to which a matrix serves corrections of this size well.
    pub const USEFUL: f64 = 0.05;
    /// Part of a correction that made its matrix useless, up to which the next one is kept.
    pub const SHARE: f64 = 0.8;
    /// What was useless once is tried again by and by.
    pub const GROWTH: f64 = 1.02;
}

pub mod anderson {
    /// Number of earlier corrections that are combined.
    pub const DEPTH: usize = 5;
    /// A difference counts where more than this fraction of it is linearly independent of the newer ones.
    pub const NEW: f64 = 1e-6;
}

pub mod line_search {
    /// The least and the largest part of a correction that the secant leaves: the work along it is no straight line.
    pub const SECANT: [f64; 2] = [0.1, 0.9];
    /// Largest fraction of the work of the residual that may be left after a correction.
    pub const LEFT: f64 = 0.8;
    /// Largest number of times that a correction is shortened.
    pub const TRIES: usize = 5;
}

pub mod rotated_matrix {
    /// An angle φ spoils the matrix of a tree by about φ² EA L²/EI beside what bends it; below this the contraction does not show it.
    pub const NEGLIGIBLE: f64 = 1e-3;
    /// A scene that needs fewer matrices than this has none that grow old.
    pub const MANY: usize = 8;
}

pub mod beam_trees {
    /// EA L²/EI, the square of a slenderness, from which on a tree counts. Stockier beams stretch hardly less easily than they bend:
    /// an old matrix errs more by the masses that have moved than by what has turned (measured on flying beams of 2000 and 10,000,
    /// which lose, and on scenes from 1.3e5 on, which need a half to a third of the time).
    pub const SLENDER: f64 = 1e5;
}

pub mod stabilization {
    /// Part of the model's length, or of a radian, by which a first correction may move what springs hold. What hangs already hardly moves; what
    /// moves further would jump to where it hangs, which is no path of equilibria.
    pub const IN_PLACE: f64 = 0.05;
    /// Part of the springs above which a mode has a stiffness of its own. Joints are closed to 1e-7 where equations are redundant, and what they
    /// carry works in what is open.
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
    /// A mode may be a mechanism where the elements store less than this part of the terms that their energy is summed from: some hundred
    /// times the rounding of the matrix. Thin shells of 100 x 100 elements, thickness 1e-4 of the side, store 1e-13.
    pub const ENERGY: f64 = 1e-14;
    /// And it is one where forces on no element exceed this part of their terms. The mode has rounding of its own, amplified by the condition
    /// of what is not the mechanism; a cantilever of 1000 elements, which hardly bends any of them, leaves 1e-4.
    pub const FORCE: f64 = 1e-6;
    /// Motions below this part of the largest are taken for rounding of the mode.
    pub const MOVING: f64 = 1e-4;
}

pub mod mode {
    /// Part by which entries of a mode that are equal by symmetry differ by rounding.
    pub const EQUAL: f64 = 1e-6;
    /// Number of inverse iterations. Each multiplies the share of the softest mode by the ratio of the next stiffness to its own, which is
    /// 1e6 and more at a singularity, and 2 at least where one mode buckles before the next.
    pub const ITERATIONS: usize = 6;
    /// A mode is one of rotations where its largest translation is below this part of a rotation times the model's length: an element
    /// that only turns about its own axis.
    pub const ROTATIONAL: f64 = 1e-3;
}

pub mod massless {
    /// A pivot below this part of the diagonal is rounding of the terms that cancel in it, some thousand times over: a chain that is
    /// pulled so little has strains below 1e-12.
    pub const ROUNDING: f64 = 1e-12;
    /// Degrees of freedom of nodes that are looked at together; of more, each node is looked at by itself.
    pub const MOST: usize = 60;
    /// Components of a direction below this part of the largest are not said.
    pub const SMALL: f64 = 1e-6;
}

pub mod jump {
    /// The lever, as a part of the model's length, over which a rotation is compared with translations.
    pub const LEVER: f64 = 1e-3;
    /// Largest rotation of a node in a load step, in radians. Below it the chord of a turning element keeps a positive part along its old
    /// direction with room to spare, and the work of moments follows from the rotation vector of the step alone.
    pub const LARGEST_TURN: f64 = 1.25;
    /// Largest rotation of a node of a shell against the mean of its element in a step of a motion, in radians: a step that is resolved bends no element so far.
    pub const LARGEST_TWIST: f64 = 0.5;
    /// Work within this part of all work done, for either sign, is not missed: a step has its own error, and equilibrium its tolerance.
    pub const ACCURACY: f64 = 1e-3;
    /// Part of ½ |Δf| |Δq| by which the work of loads that grow by Δf may depart from that of their mean. Where forces grow with the n-th power
    /// of displacements it is (n − 1)/(n + 1): nothing in a linear step, one half for a slack string, which is cubic. Where a gap closes, or a
    /// structure yields, it is more in a long step and less in a shorter one; where the equilibrium jumps it is nearly all, or more.
    pub const CURVED: f64 = 0.6;
    /// Part of ½ |Δf| |Δq| that is in doubt: the step is taken in two halves, and where what is missed in the first is not half of it or less,
    /// in their halves, until the path is smooth or plainly jumps. A jump leaves its loss in one half.
    pub const DOUBTFUL: f64 = 0.2;
    /// The work of forces along this part of the model's length is rounding, as is that of moments along this angle.
    pub const NOTHING: f64 = 1e-12;
    /// Motions below this part of the model's length are no jumps; their energy may be rounding.
    pub const STILL: f64 = 1e-6;
}

pub mod stability_tangent {
    /// Number of bisections for the load at which the first eigenvalue is negative: 1e-5 of the step.
    pub const BISECTIONS: usize = 17;
    /// Number of points in a step at which a determinant is looked at: two modes that buckle one after the other leave its sign.
    pub const SCANS: usize = 16;
    /// Turn of a node in a step, in radians, above which the tangents between the ends of the step, K₀ + θ (K₁ − K₀), say nothing of a
    /// determinant: half-way they are wrong by an eighth of its square, as part of what is stiffest, and slender parts bend a thousand times
    /// more easily than they stretch.
    pub const TURNS: f64 = 0.05;
    /// An eigenvalue that is negative by less than this part of the diagonal is rounding; that of a thousand elements in bending is 1e-12.
    pub const ROUNDING: f64 = 1e-14;
}

pub mod stability {
    /// Part of a step of the deck below which one that ends on an unstable branch is not cut again. A strut with a lateral load of 1e-6 of its
    /// buckling load bends away within 1e-4 of it.
    pub const SHORTEST: f64 = 1.0 / 4096.0;
}

pub mod out_of_plane {
    /// Largest number of parts that may turn about their own axes, each held by a spring.
    pub const MOST_HELD: usize = 8;
}

pub mod contacts {
    /// Of the size of what touches, where the program has chosen the stiffness: five times what it chose it for.
    pub const SEEN: f64 = 0.05;
    /// The same where the deck gives it and may mean something soft, a tyre or a buffer: what is in to its middle has no side left.
    pub const MEANT: f64 = 0.5;
    /// The same of faces and of balls among themselves, whose size is the depth at which their middles meet.
    pub const TO_THE_MIDDLE: f64 = 0.5;
    /// Of the size of what touches: the depth by which stiffnesses are chosen.
    pub const BEGINS_CLOSED: f64 = 1e-3;
    /// Part of the size of a body by which it sinks in at rest: the depth by which stiffnesses are chosen.
    pub const SUNK: f64 = 1e-3;
}

pub mod strain {
    /// Strain from which forces are off by a tenth: stress conjugate to Green's strain makes them twice the strain too large.
    pub const LARGE: f64 = 0.05;
    /// The same with logarithmic strain, whose series ends: a stretch to 1.34 or to 0.75, where forces begin to be off by a hundredth.
    pub const LARGE_LOGARITHMIC: [f64; 2] = [-0.22, 0.4];
    /// How often in a run strains are looked at: plastic ones do not go away.
    pub const LOOKS: f64 = 100.0;
}

pub mod drift {
    /// The drift, in radians, from which it is told.
    pub const NOTICED: f64 = 1e-3;
    /// How often in a run rotations are looked at.
    pub const LOOKS: f64 = 100.0;
}

pub mod energy_growth {
    /// Energy that steps generate, as a multiple of that available, from which a run is lost and ends.
    pub const FAR: f64 = 100.0;
    /// Part of the available energy that steps may have generated where results are still sound.
    pub const SOUND: f64 = 0.02;
}

// Control of the step length.

pub mod fixed {
    /// Largest number of halvings of a step; the deck's least step may stop earlier.
    pub const MOST_HALVINGS: u32 = 40;
    /// Largest number of substeps of a step, without contacts and with them. Without contacts, consecutive steps that are
    /// each cut into more than `MANY` substeps count together.
    pub const MOST_SUBSTEPS: [usize; 2] = [1024, 4096];
    /// Substeps of a step from which consecutive steps count together.
    pub const MANY: usize = 32;
    /// Halvings of a step whose corrections are shortened.
    pub const CAREFUL_HALVINGS: u32 = 6;
}

pub mod embedded_error {
    /// Safety factor on the length that would just meet the tolerance.
    pub const SAFETY: f64 = 0.9;
    /// Least and largest ratio of a step to the one before.
    pub const GROWTH: [f64; 2] = [0.2, 5.0];
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
    /// ... in which the last step has at least this weight.
    pub const WEIGHT: f64 = 0.002;
    /// Fraction of the sum of all errors that remains at the end: steady growth to 1 of an oscillation has a root mean
    /// square of 1/√6 over a run; a little less, since errors partly cancel, as the scenes B1, C4 and X1 show.
    pub const MEAN: f64 = 0.3;
    /// The same for Runge-Kutta schemes, whose errors damp the motion in the main: they cancel less.
    pub const MEAN_OF_STAGES: f64 = 0.6;
    /// Least number of steps of a run.
    pub const FEWEST: f64 = 50.0;
    /// Lengths of the trial steps that measure the motion ahead when motion begins, as fractions of the run; the first are
    /// short, for the sake of impacts. They have no common divisor, lest all of them end where a vibration passes through
    /// zero.
    pub const TRIALS: [f64; 6] = [1.7e-4, 7.1e-4, 2.9e-3, 0.011, 0.037, 0.053];
    /// An estimate that two filters reduce below this fraction is that of unresolved motion, with a period of four steps or
    /// less; unless other motion leaves more than the root of it after a third filter.
    pub const RESOLVED: f64 = 0.3;
    /// Number of filters that remove such motion, and keep most of a mode with ten steps a period.
    pub const FILTERS: usize = 8;
    /// Unresolved motion is left to the numerical damping of the scheme while its amplitude is below this multiple of the
    /// tolerance: shorter steps would only prolong it.
    pub const SLIGHT: f64 = 2.0;
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
    /// Largest ratio of a step to the one before, and of the one before to it.
    pub const CHANGE: f64 = 2.0;
    /// Cosine of the angle between steps below which they grow no more.
    pub const STRAIGHT: f64 = 0.8;
    /// Cosine below which a step may have left the path for another and is tried at half the length; but only so many
    /// times, for where material begins to yield a path has kinks that no step is too short for.
    pub const BENT: f64 = 0.2;
    /// Number of times that a step is tried at half the length because the path bends.
    pub const TRIES: usize = 3;
    /// Number of iterations beyond which the first step is tried at half the load.
    pub const HARD: usize = 12;
    /// Largest number of steps of a path, unless the deck asks for another.
    pub const MOST_STEPS: usize = 100_000;
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
    /// Steps in which an event falls are no longer than this part of the run, times the root of the tolerance. What such a step errs by goes with
    /// the square of its length; a step of a twentieth of what opens and closes again then errs by less than a tenth of the tolerance.
    pub const LONGEST_WITH_EVENT: f64 = 0.01;
}

// Explicit schemes.

pub mod stiffening {
    /// Below this fraction of the limit, by approximate inertias, the quotient is not computed.
    pub const QUICK: f64 = 0.05;
    /// What tells that a mode grows, a little above the value of one at the limit.
    pub const LIMIT: f64 = 4.1;
}

pub mod scaled_step {
    /// Differences of residuals leave seven digits of the limit.
    pub const ROUNDING: f64 = 1e-4;
    /// Part of the stiffness of a mode from which one link or contact is what makes it fast.
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
    /// A limit longer by this factor is that of another mode.
    pub const LONGER: f64 = 1.05;
    /// A limit shorter by this factor counts as a cutback.
    pub const SHORTER: f64 = 0.95;
    /// The displacement by which residuals are differenced, over the model's length. Over the length of an element it is a
    /// strain, which must not make steel yield: with a thousand elements it is 2e-6. Positions in two parts leave seven
    /// digits of it.
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
    /// The part of the size of the scene that counts as no way over a whole run.
    pub const NOWHERE: f64 = 1e-9;
    /// A mass this many times larger leaves an acceleration below rounding.
    pub const FIXED: f64 = 1e20;
}

pub mod initial_transient {
    /// Motions by such an acceleration in a step, as parts of the model's length and in radians, that rotations of slender parts may have
    /// without stretching what they should only bend.
    pub const LARGE: f64 = 1e-3;
    /// Part of an acceleration by which that of an implicit step differs where the step does not resolve it, and that before a jump where it jumps.
    pub const UNRESOLVED: f64 = 0.5;
}

pub mod handover {
    /// Points that are nearer than this part of the size of their coordinates are at one place.
    pub const MEETING: f64 = 1e-9;
    /// The part of the largest force that an equilibrium may leave out of balance.
    pub const LEFT: f64 = 1e-6;
}

pub mod stop_watch {
    /// Part of the value within which it is met by a step of given length, which is shortened to end there.
    pub const MET: f64 = 1e-8;
}

pub mod search {
    /// The part of the time between comparisons in which a stage must come to its stop for its error to be told.
    pub const EARLY: f64 = 0.4;
    /// The part of it in which a stage that has stopped too early is to stop in the next run.
    pub const IN_TIME: f64 = 0.8;
}

pub mod trials {
    /// Largest number of runs, the trial aside.
    pub const MOST_RUNS: usize = 4;
    /// Part of the error asked for that a second run aims at.
    pub const AIM: f64 = 0.6;
    /// An error of up to this multiple of what was asked for passes.
    pub const WITHIN: f64 = 1.5;
    /// Ratio of the tolerances of the trial and the run: for a scheme of third order its steps are twice as long.
    pub const LOOSER: f64 = 8.0;
    /// Least and largest ratio of the tolerances of two runs in a row.
    pub const CHANGE: [f64; 2] = [0.01, 0.5];
    /// A run of more than so many times the steps of the one before is given up: what it would follow no step was to resolve.
    pub const MOST_LONGER: usize = 30;
    /// A trial of more than twice the steps of its run and so many is given up: its longer steps do not follow the motion.
    pub const FEW: usize = 100;
    /// Ratio of the tolerances where two runs have nothing in common.
    pub const LOST: f64 = 0.03;
    /// The difference of two runs that have nothing in common, relative to the motion.
    pub const SATURATED: f64 = 0.3;
}

pub mod trace {
    /// Largest number of nodes that are compared; of more nodes every second, third, ... is.
    pub const MOST_NODES: usize = 20_000;
    /// Errors of steps add up to less than their sum: they fall at least with this power of it.
    pub const SLOPE: f64 = 0.8;
    /// Number of steps for whose ends there is room from the first step on; memory that is not touched costs nothing.
    pub const USUAL_STEPS: usize = 1 << 16;
    /// The factor between the errors of two runs that have met events, at most: that of steps twice as long, in which events leave errors of first
    /// order.
    pub const EVENTFUL: f64 = 2.0;
    /// Runs of nearly the same steps tell nothing of each other.
    pub const TELLING: f64 = 1.1;
    /// Times at least: one of them may be that at which both happen to agree.
    pub const FEWEST: usize = 3;
}

pub mod modes_at_end {
    /// Part of the forces that an equilibrium may leave out of balance; a state that rests by time integration leaves some.
    pub const BALANCED: f64 = 1e-3;
    /// What moves nothing by more than this part of the largest coordinate, against its own stiffness, is rounding, as is this part of all loads
    /// where nothing acts.
    pub const ROUNDING: f64 = 1e-12;
}

// Plan.

pub mod mass_scaling {
    /// Largest number of named errors; more are counted.
    pub const MOST: usize = 5;
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
    /// Number of nodes from which several threads pay in the loops over nodes.
    pub const NODES_WORTH_THREADS: usize = 2048;
}

pub mod savings {
    /// Ratios below this are not worth a line.
    pub const WORTH: f64 = 1.05;
}

pub mod explained_mass_scaling {
    /// Share of the mass of a part from which what is added is warned of: where it is spread, frequencies fall by 2.4 %; in a few elements at the
    /// end of a cantilever it is 8 %. Guides to crash analysis draw the line there too, for each part.
    pub const MUCH: f64 = 0.05;
}

// Small motions.

pub mod rest {
    /// What is left of forces relative to their largest terms.
    pub const UNBALANCED: f64 = 1e-12;
    /// A motion that forces would cause, relative to the size of the scene, in which it still rests.
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
    /// By what part the eigenvalue up to which modes are counted moves where it meets one.
    pub const NEAR: f64 = 1e-7;
    /// Shifts that are tried.
    pub const SHIFTS: usize = 30;
    /// A shift within these multiples of the lowest frequency squared that is not zero serves as well as any other.
    pub const FITS: [f64; 2] = [0.03, 1e3];
    /// Eigenvalues that are smaller than others by such a factor are zero, or next to it: with a shift at zero the others would have no more digits than
    /// what is left of sixteen.
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
    /// Step of the final differences, as such a motion at most, and as a part of the lowest factor. The cube of a rotation θ stretches and
    /// shears a part of slenderness s by s² θ² of what the load does, which differences of second order would keep: those of sixth order
    /// leave s² θ⁶, and rounding 1e-15 s²/θ.
    pub const STEP: f64 = 3e-3;
    /// Factors farther from zero than the nearest by the inverse of this are rounding.
    pub const FARTHEST: f64 = 1e-8;
    /// Factors of equal size that are taken one by one before the search is given up.
    pub const CLUSTER: usize = 200;
    /// Largest motion, as that of [`STEP`], up to which bars are judged to be slack.
    pub const MODERATE: f64 = 0.05;
    /// Searches for factors that pivots show and the iteration has not found.
    pub const SEARCHES: usize = 8;
}

pub mod shares {
    /// Energy of a part above this part of its terms without signs is no rounding, ...
    pub const CLEAR: f64 = 1e-6;
    /// ... unless its motions are: this is the square of what they are of the largest anywhere.
    pub const STILL: f64 = 1e-16;
}

pub mod damped {
    /// Length of residuals relative to eigenvalues.
    pub const TOLERANCE: f64 = 1e-11;
    /// Starting vectors: pairs of equal roots are found together.
    pub const WIDTH: usize = 2;
    /// Roots below this part of the shift are zero: those of motions without stiffness are double, and rounding splits a double root by
    /// the square root of its size.
    pub const ZERO: f64 = 3e-6;
    /// Where motions have no stiffness, roots below this multiple of what the stiffness of rigid motions rounds to are theirs.
    pub const SPLIT: f64 = 4.0;
    /// Part of the shift from which roots that count as zero may be others.
    pub const DOUBTFUL: f64 = 0.1;
    /// A root grows where its real part is larger than this part of it.
    pub const GROWS: f64 = 1e-7;
    /// Roots whose distance from the shift is larger than that of the nearest by the inverse of this are at infinity: motions that joints forbid,
    /// or without mass, have such.
    pub const INFINITE: f64 = 1e-10;
    /// Modes for which there is room where a frequency is given.
    pub const UP_TO: usize = 100;
}

pub mod shape {
    /// Stiffness times motion rounds to this part of the sum of its terms without signs; an eigenvalue below it is zero.
    pub const ROUNDING: f64 = 2e-15;
    /// Displacements below this part of the rotations times the size of the scene are rounding.
    pub const STILL: f64 = 1e-7;
}

pub mod gyroscopic {
    /// An asymmetry below this part is rounding.
    pub const SYMMETRIC: f64 = 1e-9;
}

pub mod pencil {
    /// Gaps of a motion relative to its size from which it is one that joints forbid; those of others are rounding.
    pub const FORBIDDEN: f64 = 1e-6;
    /// Ratio of stiffness to mass, relative to the largest, that rounding leaves where nothing resists.
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
    /// Of the highest mode: what answers as a spring is then at least twice as fast, and wrong by a tenth at most.
    pub const NEAR: f64 = 0.5;
    /// Part of the stiffness of a mode below which inertia and damping leave none of it: natural frequencies are known to this.
    pub const NOTHING_LEFT: f64 = 1e-8;
    /// Part of all forces below which rounding alone drives a mode.
    pub const UNDRIVEN: f64 = 1e-9;
}

pub mod direct_response {
    /// What is left of the equations from which a solution is in doubt.
    pub const DOUBTFUL: f64 = 1e-8;
    /// Penalties of joints are those of the stiffness and of the inertia at this multiple of the highest frequency, which no inertia below
    /// it cancels.
    pub const BEYOND: f64 = 2.0;
    /// Part of the least ratio of stiffness and inertia below which a motion without stiffness counts as one.
    pub const NEXT_TO_ZERO: f64 = 1e-6;
    /// Solutions after which gaps of joints, of which each leaves a small part, have closed.
    pub const CLOSINGS: usize = 3;
    /// Part of the largest motion by which motions beside a frequency may differ where nothing resonates.
    pub const SAME: f64 = 1e-4;
    /// Part of a frequency by which it is left on either side where its own equations cannot be solved.
    pub const ASIDE: f64 = 1e-9;
    /// Part of a frequency by which a natural one may differ to be the same.
    pub const SAME_FREQUENCY: f64 = 1e-6;
    /// The ratio to the least motion from which one is looked at.
    pub const LARGE: f64 = 1e6;
    /// Part of a frequency by which it is left, and the part of the motion that remains there at a resonance without damping.
    pub const BESIDE_RESONANCE: [f64; 2] = [1e-6, 0.02];
}

pub mod damped_rest {
    /// Parts of the stiffness of a mode below which what its damping force moves besides counts for nothing.
    pub const SMALL: f64 = 1e-9;
    /// A motion of which this part of its size is left beside those before it is one of them.
    pub const ALIKE: f64 = 1e-6;
    /// How often the damping forces of such motions are answered in turn.
    pub const ROUNDS: usize = 2;
}

pub mod dynamic_stiffness {
    /// Unknowns of a group.
    pub const MOST: usize = 3;
    /// What may be left of a right-hand side, relative to its largest entry.
    pub const LEFT: f64 = 1e-14;
    /// A part of a solution that is beyond what is read of it.
    pub const NEGLIGIBLE: f64 = 1e-6;
    /// Refinements of a solution.
    pub const REFINEMENTS: usize = 4;
}

// The system of equations.

pub mod turning_body {
    /// The part of the largest principal inertia that rounding leaves where there is none.
    pub const NEGLIGIBLE: f64 = 1e-12;
    /// The part of the largest principal inertia by which rounding may make it exceed the sum of the two others, or differ from them.
    pub const ROUNDING: f64 = 1e-9;
    /// The part of the largest principal inertia below which an axis follows the momentum in space in part only.
    pub const THIN: f64 = 0.1;
    /// How often a rate is put into the acceleration that it depends on: each time the error shrinks by a third of the turn of a step.
    pub const PASSES: usize = 2;
}

pub mod free_rotation {
    /// Part of the largest inertia that counts as none: about such an axis there is no momentum.
    pub const NEGLIGIBLE: f64 = 1e-12;
}

pub mod masses {
    /// An entry counts as zero below this fraction of what it was before others were subtracted from it.
    pub const NEGLIGIBLE: f64 = 1e-12;
    /// Number of corrections of the velocities of a node with restrained degrees of freedom.
    pub const CORRECTIONS: usize = 2;
}

pub mod energy {
    /// Some thousand times the rounding of a position, which steps add up.
    pub const ROUNDING: f64 = 1e-12;
    /// Of the largest energy, at least: a steady motion that keeps its speed to 3e-5 is as good as the results are.
    pub const OF_PEAK: f64 = 3e-3;
    /// Times what has changed its form: a vibration that no step resolves is gone before its energy was stored once.
    pub const GONE: f64 = 5.0;
    /// Of the largest energy: what is less is rounding of it, in a stage in which nothing happens.
    pub const NOTHING_HAPPENS: f64 = 1e-9;
}

pub mod scale {
    /// Part of a length at which forces make moments: where only forces act, moments are rounding of them.
    pub const ARM: f64 = 1e-2;
}

pub mod shell_shear {
    /// Directors whose cosine is below this meet at a fold.
    pub const SAME: f64 = 1.0 - 1e-9;
}

pub mod multipliers {
    /// ε regularizes redundant constraint equations: rounding in a redundant equation is amplified by 1/ε, and an iteration
    /// leaves the fraction ε of a gap.
    pub const REGULARIZATION: f64 = 1e-7;
    /// ε where no equation is redundant. What an iteration leaves of gaps that go smoothly over a chain of N joints is ε/(ε + (π/2N)²): with
    /// the other ε two thousand joints would leave a tenth, twenty thousand nearly all.
    pub const REGULARIZATION_OF_TREES: f64 = 1e-11;
}

pub mod plane {
    /// A number counts as zero below this fraction of the entries beside it.
    pub const SMALL: f64 = 1e-12;
}

pub mod excitation {
    /// Fraction of a run over which the slope beyond its end is taken.
    pub const TAIL: f64 = 0.01;
}

pub mod penalties {
    /// Ratio of masses or stiffnesses up to which a gap shrinks by 1e-3 or better in an iteration.
    pub const MODERATE: f64 = 1e4;
    /// Forces of joints whose factor is this part of the largest are rounding: such a joint bears nothing. And so are forces that are this part of
    /// what a gap as large as the scene, or a turn of one, would be answered with.
    pub const NOTHING: f64 = 1e-12;
    /// A moment of a joint that is this part of its force along the scene gives no measure of its stiffness, whatever the iteration has made of it.
    pub const FAINT: f64 = 1e-6;
    /// The least ratio of the penalty factor of a joint to the stiffness that its own forces have, by which the two together are positive: arms
    /// and directions make less of the factor.
    pub const FIRM: f64 = 100.0;
}

pub mod constraint_schur {
    /// An entry counts as zero below this fraction of the largest in its equation.
    pub const NEGLIGIBLE: f64 = 1e-12;
}

pub mod independent_rows {
    /// An equation is redundant where less than this fraction of its gradient is linearly independent of others.
    pub const NEW: f64 = 1e-8;
}

pub mod element_stability {
    /// Largest square of the radius of gyration that is given to elements, over that of the distance of their nodes.
    pub const GYRATION: f64 = 1.0 / 8.0;
    /// Moments of inertia below this part of the largest are none.
    pub const NONE: f64 = 1e-12;
    /// Bisections of the part of the largest squares of radii: what is too much is 2⁻¹⁶ of these.
    pub const BISECTIONS: usize = 16;
    /// Rotary inertia that lowers the square of the fastest frequency by less than this part of it is not given where mass has to be: it would
    /// slow what bends for next to nothing.
    pub const OF_USE: f64 = 0.02;
}

pub mod slip_watch {
    /// Part of the scene's length from which slip is a motion of the scene.
    pub const OF_LENGTH: f64 = 1e-3;
    /// Multiple of the stretch of a spring of friction from which slip is a motion of the scene.
    pub const OF_STRETCH: f64 = 10.0;
    /// Error, as a part of the largest slip, that a warning reports.
    pub const SEEN: f64 = 0.02;
    /// Error, as a part of the largest slip, that the remedy of the warning leaves.
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
