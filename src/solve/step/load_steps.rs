//! The data that load steps of a static analysis pass to later ones: the largest loads and forces so far, and their works.
//!
//! Once the loads are back at zero, the remaining forces of an elastic structure are rounding errors. The residual is then measured by the
//! largest earlier forces.

use crate::sudden_loads::SuddenLoads;
use crate::system::{Loading, Prescribed, Scale};
use crate::tolerances::load_steps::{FADED, GONE, ROUNDING, SEEN};
use base::snapshot::keep;

/// The largest of each kind so far.
#[derive(Debug, Clone, Copy, Default)]
pub struct Peak {
    /// Gravity, the factors of loads, pressures, prescribed displacements and rotations.
    acting: [f64; 5],
    /// The terms that forces are summed from.
    pub forces: Scale,
    /// Those of equilibria whose forces have digits; a residual of exactly zero may be one of no forces.
    firm: Scale,
    /// The forces of the residual evaluated last.
    last: Scale,
    /// True if all loads and prescribed displacements have gone in the current step.
    released: bool,
    /// True if no loads act in the current step, and the supports are either unmoved or moved far enough to cause visible stresses.
    unloaded: bool,
    /// True if the last equilibrium had only forces of rounding size.
    pub unstressed: bool,
    /// True once an equilibrium had others.
    pub stressed: bool,
}

keep!(Peak { acting, forces, firm, last, released, unloaded, unstressed, stressed });

/// The data that load steps pass to later ones.
#[derive(Debug, Clone, Default)]
pub struct LoadSteps {
    /// Time and stored energy at the end of the last one.
    pub stored: Option<(f64, f64)>,
    /// Start time of the last load step that was refused for its work, and the missing work.
    pub doubtful: Option<(f64, f64)>,
    /// The largest loads and forces so far.
    pub peak: Peak,
    /// The works of loads and supports.
    pub works: Works,
    /// The loads that the current step introduces gradually.
    pub sudden: Option<SuddenLoads>,
    /// True where no step was short enough to leave the unstressed state: corrections are shortened then.
    pub careful: bool,
}

keep!(LoadSteps: Default { stored, doubtful, peak, works, sudden, careful });

impl LoadSteps {
    /// Copies the data of another step; nothing is allocated if both have sudden loads.
    pub fn copy_from(&mut self, other: &LoadSteps) {
        let LoadSteps { stored, doubtful, peak, works, sudden, careful } = other;
        (self.stored, self.doubtful, self.peak, self.works, self.careful) =
            (*stored, *doubtful, *peak, *works, *careful);
        match (&mut self.sudden, sudden) {
            (Some(own), Some(sudden)) => own.copy_from(sudden),
            (own, sudden) => own.clone_from(sudden),
        }
    }
}

/// The works of loads and of supports in the load steps of a static analysis.
#[derive(Debug, Clone, Copy, Default)]
pub struct Works {
    loads: f64,
    supports: f64,
    /// The largest sum of their magnitudes; supports and loads may cancel each other.
    pub largest: f64,
    /// The sum of the works of single loads and supports in all steps, without signs; works that cancel count twice.
    pub gross: f64,
    /// Upper bound of the work of suddenly applied loads before equilibrium was reached.
    pub sudden: f64,
}

keep!(Works { loads, supports, largest, gross, sudden });

impl Works {
    /// Adds the works of a step, and the sum of their terms without signs.
    pub fn add(&mut self, [loads, supports]: [f64; 2], gross: f64) {
        self.gross += gross;
        self.loads += loads;
        self.supports += supports;
        self.largest = self.largest.max(self.loads.abs() + self.supports.abs());
    }
}

impl Peak {
    /// Records the loads and prescribed displacements at the end of a load step; `length` is the length of the model.
    pub fn begin_step(&mut self, loads: &Loading, prescribed: &[Prescribed], length: f64) {
        let largest = |values: &[f64]| values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        let moved = prescribed.iter().fold(0.0, |most: f64, given| most.max(given.u.abs()));
        let [factors, pressures, squares] =
            [&loads.factors, &loads.pressures, &loads.squares].map(|values| largest(values));
        let acting = [loads.field.amax(), factors, pressures, squares, moved];
        let gone: [bool; 5] = std::array::from_fn(|i| acting[i] <= GONE * self.acting[i]);
        self.released = gone == [true; 5];
        self.unloaded = gone[..4] == [true; 4] && (moved == 0.0 || moved > SEEN * length);
        self.acting.iter_mut().zip(acting).for_each(|(most, now)| *most = most.max(now));
    }

    /// The reference forces of a residual whose own forces are `scale`.
    pub fn scale(&mut self, scale: Scale) -> Scale {
        self.last = scale;
        match self.released {
            true => larger(scale, self.forces),
            false => scale,
        }
    }

    /// True if an equilibrium with this residual has only forces of rounding size: nothing acts yet, or the supports move the whole
    /// structure as a rigid body. Forces that are not far below those of an earlier equilibrium have digits, and must balance.
    pub fn is_unstressed(&self, residual: f64) -> bool {
        let has_faded = |now: f64, most: f64| most == 0.0 || now <= FADED * most;
        let faded = has_faded(self.last.force, self.firm.force) && has_faded(self.last.moment, self.firm.moment);
        self.unloaded && residual > ROUNDING && faded
    }

    /// Keeps the forces of an equilibrium.
    pub fn keep(&mut self, residual: f64) {
        self.unstressed = self.is_unstressed(residual);
        self.stressed |= !self.unstressed;
        if !self.unstressed && residual > 0.0 {
            self.firm = larger(self.firm, self.last);
        }
        self.forces = larger(self.forces, self.last);
    }
}

fn larger(a: Scale, b: Scale) -> Scale {
    Scale { force: a.force.max(b.force), moment: a.moment.max(b.moment) }
}
