//! Concrete under normal stress: a parabola and a line in compression after Kent and Park, linear softening in tension, and the unloading of
//! Yassin, as Concrete02 of OpenSees has them.
//!
//! The strength f is reached at the strain ε₀ = 2 f/E. The stress in first compression is f (2 ε/ε₀ − (ε/ε₀)²) up to there. Then it falls
//! along a line to the residual strength at the crushing strain, and stays. Confinement raises strength and crushing strain (D. C. Kent and R. Park, J. Struct. Div. ASCE
//! 97 (1971) 1969-1990; B. D. Scott, R. Park and M. J. N. Priestley, ACI J. 79 (1982) 13-27).
//!
//! Unloading has the slope E until it meets the line of slope e/2 through the plastic strain ε_p. Reloading has the slope E until it meets the
//! line of slope e through ε_p and the point of largest compression. All lines of slope e meet at one point of the line of slope E (M. H. M.
//! Yassin, dissertation, Berkeley 1994). Tension begins at ε_p. It is elastic until the tensile strength, softens along a line, and unloads
//! towards ε_p.
//!
//! Omitted: rate, and the loss of tensile strength by crushing. Along a step the strain runs straight, so the answer does not depend on its
//! length.

use super::work::work;

/// How the end of a line of softening is given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Softening {
    /// The magnitude of the strain there.
    Strain(f64),
    /// The energy per area that softening dissipates; the strain follows from the length over which it spreads.
    Energy(f64),
}

/// Concrete as the deck describes it. All numbers are magnitudes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConcreteModel {
    /// E, the slope at zero strain.
    pub modulus: f64,
    /// f, the compressive strength.
    pub strength: f64,
    /// The compressive stress after crushing.
    pub residual: f64,
    /// The end of softening in compression.
    pub crushing: Softening,
    /// The tensile strength.
    pub tensile_strength: f64,
    /// The end of softening in tension.
    pub cracking: Softening,
    /// λ: the slope of unloading at the crushing strain over E.
    pub unloading_ratio: f64,
}

impl ConcreteModel {
    /// ε₀.
    pub fn strain_at_strength(&self) -> f64 {
        2.0 * self.strength / self.modulus
    }

    /// The longest lengths over which crushing and cracking may spread: for longer ones the energy of softening is below the elastic energy.
    /// Infinite where strains are given.
    pub fn longest(&self) -> [f64; 2] {
        let ConcreteModel { modulus: E, strength: f, residual: r, tensile_strength: f_t, .. } = *self;
        let crushing = match self.crushing {
            Softening::Energy(energy) if f > r => energy * E / (0.5 * (f + r) * (f - r)),
            _ => f64::INFINITY,
        };
        let cracking = match self.cracking {
            Softening::Energy(energy) if f_t > 0.0 => 2.0 * energy * E / (f_t * f_t),
            _ => f64::INFINITY,
        };
        [crushing, cracking]
    }

    /// The law at a point with this `length` of the beam, below [`ConcreteModel::longest`].
    ///
    /// The energy of crushing is the area below the line of softening and the elastic unloading from its end (J. Coleman and E. Spacone, J.
    /// Struct. Eng. 127 (2001) 1257-1265): G = ½ (f + r) (ε_u − ε₀ + (f − r)/E) L. The energy of cracking is ½ f_t ε_t L.
    pub fn of_length(&self, length: f64) -> Concrete {
        let ConcreteModel { modulus: E, strength: f, residual: r, tensile_strength: f_t, .. } = *self;
        let peak = self.strain_at_strength();
        let crushing_strain = match self.crushing {
            Softening::Strain(strain) => strain,
            Softening::Energy(energy) => peak + 2.0 * energy / ((f + r) * length) - (f - r) / E,
        };
        let cracking_strain = match self.cracking {
            Softening::Strain(strain) => strain,
            Softening::Energy(energy) => 2.0 * energy / (f_t * length),
        };
        // With less, unloading from the crushing strain would end in tension.
        let ratio = self.unloading_ratio.max(r / (E * crushing_strain));
        Concrete {
            modulus: E,
            strength: f,
            peak,
            residual: r,
            crushing_strain,
            tensile_strength: f_t,
            cracking_strain,
            focus: (ratio * E * crushing_strain - r) / (E * (1.0 - ratio)),
        }
    }
}

/// Concrete at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Concrete {
    modulus: f64,
    strength: f64,
    /// ε₀.
    peak: f64,
    residual: f64,
    crushing_strain: f64,
    tensile_strength: f64,
    cracking_strain: f64,
    /// The strain, in tension, at which all lines of slope e meet the line of slope E.
    focus: f64,
}

/// The history of a point. All are zero at the start.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ConcreteState {
    /// Strain.
    pub strain: f64,
    /// Stress.
    pub stress: f64,
    /// The largest compressive strain so far, 0 or less.
    pub crushed: f64,
    /// The largest strain in tension so far, from the plastic strain.
    pub opened: f64,
}

/// The number of history variables.
pub const VARIABLES: usize = 4;

/// Unloading from the point of largest compression.
struct Unloading {
    /// e.
    slope: f64,
    /// The strain and stress of largest compression.
    from: [f64; 2],
    /// ε_p.
    plastic: f64,
}

impl ConcreteState {
    /// The state from its history variables.
    pub fn of(history: &[f64]) -> ConcreteState {
        let &[strain, stress, crushed, opened, ..] = history else { return ConcreteState::default() };
        ConcreteState { strain, stress, crushed, opened }
    }

    /// The history variables.
    pub fn history(&self) -> [f64; VARIABLES] {
        [self.strain, self.stress, self.crushed, self.opened]
    }
}

impl Concrete {
    /// Stress and slope in first compression at a strain of 0 or less.
    fn compression(&self, strain: f64) -> [f64; 2] {
        let x = -strain;
        if x <= self.peak {
            let part = x / self.peak;
            return [-self.strength * part * (2.0 - part), self.modulus * (1.0 - part)];
        }
        if x < self.crushing_strain {
            let slope = (self.residual - self.strength) / (self.crushing_strain - self.peak);
            return [-self.strength - slope * (x - self.peak), slope];
        }
        [-self.residual, 0.0]
    }

    /// Stress and slope in first tension at a strain from the plastic strain on.
    fn tension(&self, strain: f64) -> [f64; 2] {
        let first = self.tensile_strength / self.modulus;
        if strain <= first {
            return [self.modulus * strain, self.modulus];
        }
        if strain < self.cracking_strain {
            let slope = -self.tensile_strength / (self.cracking_strain - first);
            return [self.tensile_strength + slope * (strain - first), slope];
        }
        [0.0; 2]
    }

    /// Unloading from the largest compression `crushed`.
    fn unloading(&self, crushed: f64) -> Unloading {
        let stress = self.compression(crushed)[0];
        let slope =
            if crushed < 0.0 { (stress - self.modulus * self.focus) / (crushed - self.focus) } else { self.modulus };
        // Without residual strength and slope, crushed concrete unloads towards the focus of all lines.
        let plastic = if slope > 0.0 { crushed - stress / slope } else { self.focus };
        Unloading { slope, from: [crushed, stress], plastic }
    }

    /// Where a step starts between the two lines of unloading: tension ends at the plastic strain without stress.
    fn start(from: &ConcreteState, unloading: &Unloading) -> [f64; 2] {
        if from.strain > unloading.plastic { [unloading.plastic, 0.0] } else { [from.strain, from.stress] }
    }

    /// The state at `strain` on a straight way from `from`, and its slope.
    pub fn moved(&self, from: &ConcreteState, strain: f64) -> (ConcreteState, f64) {
        if strain < from.crushed {
            let [stress, slope] = self.compression(strain);
            return (ConcreteState { strain, stress, crushed: strain, ..*from }, slope);
        }
        let unloading = self.unloading(from.crushed);
        let at = |[stress, slope]: [f64; 2]| (ConcreteState { strain, stress, ..*from }, slope);
        let open = strain - unloading.plastic;
        if open <= 0.0 {
            let [x, s] = Concrete::start(from, &unloading);
            let elastic = s + self.modulus * (strain - x);
            let least = unloading.from[1] + unloading.slope * (strain - unloading.from[0]);
            let most = 0.5 * unloading.slope * open;
            return at(match elastic {
                _ if elastic <= least => [least, unloading.slope],
                _ if elastic >= most => [most, 0.5 * unloading.slope],
                _ => [elastic, self.modulus],
            });
        }
        if open <= from.opened {
            let secant = self.tension(from.opened)[0] / from.opened;
            return at([secant * open, secant]);
        }
        let (state, slope) = at(self.tension(open));
        (ConcreteState { opened: open, ..state }, slope)
    }

    /// The energy per volume that unloading returns.
    pub fn energy(&self, at: &ConcreteState) -> f64 {
        let unloading = self.unloading(at.crushed);
        let half = 0.5 * unloading.slope;
        let open = at.strain - unloading.plastic;
        if open >= 0.0 {
            return 0.5 * at.stress * open;
        }
        // Unloading with the slope E ends where σ + E (x − ε) = ½ e (x − ε_p).
        let way = (half * open - at.stress) / (self.modulus - half);
        let stress = half * (open + way);
        -0.5 * ((at.stress + stress) * way + stress * -(open + way))
    }

    /// The energy per volume dissipated on the way between two states: the work less the change of the energy.
    pub fn dissipated(&self, from: &ConcreteState, to: &ConcreteState) -> f64 {
        let unloading = self.unloading(from.crushed);
        let [x, s] = Concrete::start(from, &unloading);
        let meets =
            |slope: f64, through: [f64; 2]| x + (through[1] + slope * (x - through[0]) - s) / (self.modulus - slope);
        let plastic = unloading.plastic;
        let stops = [
            from.crushed,
            -self.peak,
            -self.crushing_strain,
            meets(unloading.slope, unloading.from),
            meets(0.5 * unloading.slope, [plastic, 0.0]),
            plastic,
            plastic + from.opened,
            plastic + self.tensile_strength / self.modulus,
            plastic + self.cracking_strain,
        ];
        let work = work([from.strain, to.strain], stops, |strain| self.moved(from, strain).0.stress);
        work - (self.energy(to) - self.energy(from))
    }

    /// The plastic strain of crushing, 0 or more.
    pub fn crushed(&self, at: &ConcreteState) -> f64 {
        -self.unloading(at.crushed).plastic
    }
}
