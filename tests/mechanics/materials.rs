//! The material law against exact solutions, through its public face only.

use rand::{RngExt, SeedableRng, rngs::SmallRng};
use rdsolve::materials::failure::{FactorTable, FailureCriterion};
use rdsolve::materials::{
    Ask, Dissipation, FibreStress, Hardening, MaterialLaw, Overstress, PlaneStress, StressState, Uniaxial, Viscosity,
};
use rdsolve::math::lanes::{LANES, Lanes};

const E: f64 = 200e3;
const NU: f64 = 0.3;
const G: f64 = 0.5 * E / (1.0 + NU);
const YIELD: f64 = 250.0;
/// Yield strain.
const EY: f64 = YIELD / E;

/// The stress at a strain, `dt` after the state in `old`.
fn stress_at<const N: usize, S: StressState<N>>(
    law: &MaterialLaw,
    state: S,
    strain: &[f64; N],
    dt: f64,
    old: &[f64],
) -> [f64; N] {
    law.at_point(state, strain, (dt, old), Ask::Stress).stress
}

/// The stress and its derivative.
fn linearised<const N: usize, S: StressState<N>>(
    law: &MaterialLaw,
    state: S,
    strain: &[f64; N],
    dt: f64,
    old: &[f64],
) -> ([f64; N], [[f64; N]; N]) {
    let answer = law.at_point(state, strain, (dt, old), Ask::Tangent);
    (answer.stress, answer.tangent.unwrap_or_else(|| law.stiffness(state)))
}

/// The stress and what the step dissipates, with the history variables at its end in `new`.
fn advanced<const N: usize, S: StressState<N>>(
    law: &MaterialLaw,
    state: S,
    strain: &[f64; N],
    dt: f64,
    (old, new): (&[f64], &mut [f64]),
) -> ([f64; N], Dissipation) {
    let answer = law.at_point(state, strain, (dt, old), Ask::History(1.0));
    law.remember(state, &answer.new, (old, new), |_| 0);
    (answer.stress, answer.dissipation.map_or_else(Dissipation::default, |spent| spent.lane(0)))
}

/// A point that is led along a path.
struct Point<'a, S> {
    law: &'a MaterialLaw,
    state: S,
    history: Vec<f64>,
    work: Dissipation,
}

impl<'a, S: Copy> Point<'a, S> {
    fn new<const N: usize>(law: &'a MaterialLaw, state: S) -> Self
    where
        S: StressState<N>,
    {
        Point { law, state, history: vec![0.0; law.history(state)], work: Dissipation::default() }
    }

    fn to<const N: usize>(&mut self, strain: [f64; N], dt: f64) -> [f64; N]
    where
        S: StressState<N>,
    {
        let mut new = vec![f64::NAN; self.history.len()];
        let (stress, work) = advanced(self.law, self.state, &strain, dt, (&self.history, &mut new));
        assert_eq!(stress, stress_at(self.law, self.state, &strain, dt, &self.history));
        assert_eq!(stress, linearised(self.law, self.state, &strain, dt, &self.history).0);
        self.history = new;
        self.work.plastic += work.plastic;
        self.work.viscous += work.viscous;
        self.work.stored += work.stored;
        stress
    }

    /// The strain whose component `i` gives a stress there, the others given; Newton with the law's own tangent.
    fn solve<const N: usize>(&self, mut strain: [f64; N], i: usize, stress: f64, dt: f64) -> [f64; N]
    where
        S: StressState<N>,
    {
        for _ in 0..50 {
            let (sigma, C) = linearised(self.law, self.state, &strain, dt, &self.history);
            strain[i] += (stress - sigma[i]) / C[i][i];
        }
        strain
    }
}

fn linear(modulus: f64) -> Hardening {
    Hardening::Linear { yield_stress: YIELD, modulus }
}

/// Concave, then convex, then flat.
fn table() -> Hardening {
    Hardening::table(vec![[0.0, 250.0], [0.002, 270.0], [0.01, 300.0], [0.02, 300.0], [0.05, 450.0], [0.1, 500.0]])
        .unwrap()
}

fn hardenings() -> [Hardening; 4] {
    [linear(0.0), linear(2e3), linear(1e5), table()]
}

fn overstresses() -> Vec<Overstress> {
    let power = |exponent| Overstress::Power { exponent };
    vec![Overstress::Linear, Overstress::Exponential, power(1.0), power(2.5), power(5.0), power(50.0)]
}

fn power(fluidity: f64, exponent: f64) -> Option<Viscosity> {
    Some(Viscosity { fluidity, overstress: Overstress::Power { exponent } })
}

/// Every hardening with every kinematic share, rate independent and with every overstress function at a fluidity.
fn laws(fluidity: f64) -> Vec<(MaterialLaw, Hardening, f64, Option<Viscosity>)> {
    let mut viscosities = vec![None];
    viscosities.extend(overstresses().into_iter().map(|overstress| Some(Viscosity { fluidity, overstress })));
    let mut all = Vec::new();
    for hardening in hardenings() {
        for share in [0.0, 0.4, 1.0] {
            for viscosity in &viscosities {
                let law = MaterialLaw::new(E, NU, hardening.clone(), share, *viscosity);
                all.push((law, hardening.clone(), share, *viscosity));
            }
        }
    }
    all
}

fn yield_stress(hardening: &Hardening, p: f64) -> f64 {
    hardening.initial() + hardening.rise(p).0
}

/// The equivalent stress and its derivative, the direction of plastic flow, from the textbook's components.
trait Mises<const N: usize>: StressState<N> {
    fn compliance(sigma: &[f64; N]) -> [f64; N];
    fn mises(sigma: &[f64; N]) -> f64;
    fn flow(sigma: &[f64; N]) -> [f64; N];
}

impl Mises<1> for Uniaxial {
    fn compliance([s]: &[f64; 1]) -> [f64; 1] {
        [s / E]
    }
    fn mises([s]: &[f64; 1]) -> f64 {
        s.abs()
    }
    fn flow([s]: &[f64; 1]) -> [f64; 1] {
        [s.signum()]
    }
}

impl Mises<3> for FibreStress {
    fn compliance([s, y, z]: &[f64; 3]) -> [f64; 3] {
        [s / E, y / G, z / G]
    }
    fn mises([s, y, z]: &[f64; 3]) -> f64 {
        (s * s + 3.0 * (y * y + z * z)).sqrt()
    }
    fn flow(sigma: &[f64; 3]) -> [f64; 3] {
        let rho = Self::mises(sigma);
        [sigma[0] / rho, 3.0 * sigma[1] / rho, 3.0 * sigma[2] / rho]
    }
}

impl Mises<3> for PlaneStress {
    fn compliance([x, y, xy]: &[f64; 3]) -> [f64; 3] {
        [(x - NU * y) / E, (y - NU * x) / E, xy / G]
    }
    fn mises([x, y, xy]: &[f64; 3]) -> f64 {
        (x * x - x * y + y * y + 3.0 * xy * xy).sqrt()
    }
    fn flow(sigma: &[f64; 3]) -> [f64; 3] {
        let rho = Self::mises(sigma);
        let [x, y, xy] = sigma;
        [(x - 0.5 * y) / rho, (y - 0.5 * x) / rho, 3.0 * xy / rho]
    }
}

fn close(a: f64, b: f64, tolerance: f64, what: &str) {
    assert!((a - b).abs() <= tolerance, "{what}: {a} for {b}");
}

/// The slope of log error against log step between neighbours that halve the step.
fn orders(errors: &[f64]) -> Vec<f64> {
    errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect()
}

fn random<const N: usize>(rng: &mut SmallRng, size: f64) -> [f64; N] {
    std::array::from_fn(|_| size * rng.random_range(-1.0..1.0))
}

// Rate independent.

/// Without viscosity a radial path has a closed form in the accumulated plastic strain p for any hardening: between two
/// reversals σ = X ± i n̂ with i = σ_Y0 + (1 − β)(σ_Y(p) − σ_Y0), X = X_n ± β (σ_Y(p) − σ_Y(p_n)) n̂ and
/// εᵖ = εᵖ_n ± (p − p_n) ∂ρ/∂σ(n̂). Backward Euler is exact on it, whatever the step.
fn radial<const N: usize, S: Mises<N>>(state: S) {
    let mut rng = SmallRng::seed_from_u64(3);
    for hardening in hardenings() {
        for share in [0.0, 0.4, 1.0] {
            for _ in 0..20 {
                let law = MaterialLaw::new(E, NU, hardening.clone(), share, None);
                let direction: [f64; N] = random(&mut rng, 1.0);
                let unit = direction.map(|d| d / S::mises(&direction));
                let (mut X, mut plastic, mut p, mut sign) = (0.0, 0.0, 0.0, 1.0);
                let mut point = Point::new(&law, state);
                let mut expected = Dissipation::default();
                for to in [0.0, 0.001, 0.0013, 0.015, 0.0151, 0.04, 0.09, 0.3] {
                    let (from, at) = (yield_stress(&hardening, p), yield_stress(&hardening, to));
                    let shifted = X + sign * share * (at - from);
                    plastic += sign * (to - p);
                    expected.stored += 0.5 * (X + shifted) * sign * (to - p);
                    let i = YIELD + (1.0 - share) * (at - YIELD);
                    expected.plastic += 0.5 * (to - p) * (i + YIELD + (1.0 - share) * (from - YIELD));
                    (X, p) = (shifted, to);
                    let stress = unit.map(|u| (X + sign * i) * u);
                    let (elastic, flow) = (S::compliance(&stress), S::flow(&unit));
                    let got = point.to(std::array::from_fn(|j| elastic[j] + plastic * flow[j]), 0.0);
                    // Strains up to 200 yield strains lose that many units in the last place of the stress.
                    let rounding = 1e-12 * at;
                    (0..N).for_each(|j| close(got[j], stress[j], rounding, "stress"));
                    close(law.accumulated(state, &point.history), p, rounding / E, "accumulated plastic strain");
                    sign = -sign;
                }
                // A step ends where the next one turns back, so each is one trapezoid of the work, as in `advance`.
                close(point.work.plastic, expected.plastic, 1e-11 * expected.plastic, "plastic work");
                close(point.work.stored, expected.stored, 1e-11 * expected.plastic, "stored energy");
            }
        }
    }
}

#[test]
fn radial_and_cyclic_paths_are_exact_in_any_step() {
    radial(Uniaxial);
    radial(FibreStress);
    radial(PlaneStress);
}

/// One bar in three dresses, along a path of random steps: only rounding may differ.
#[test]
fn a_fibre_without_shear_and_a_layer_under_one_stress_are_a_bar() {
    let mut rng = SmallRng::seed_from_u64(4);
    for (law, ..) in laws(0.3) {
        let (mut bar, mut fibre, mut layer) =
            (Point::new(&law, Uniaxial), Point::new(&law, FibreStress), Point::new(&law, PlaneStress));
        for _ in 0..30 {
            let strain = 10.0 * EY * rng.random_range(-1.0..1.0);
            let dt = rng.random_range(0.0..0.1);
            let [sigma] = bar.to([strain], dt);
            let of_fibre = fibre.to([strain, 0.0, 0.0], dt);
            let of_layer = layer.to([strain, -NU * sigma / E - 0.5 * bar.history[0], 0.0], dt);
            let rounding = 1e-11 * YIELD;
            close(of_fibre[0], sigma, rounding, "fibre");
            assert_eq!(of_fibre[1..], [0.0, 0.0]);
            close(of_layer[0], sigma, rounding, "layer");
            close(of_layer[1], 0.0, rounding, "layer across");
            assert_eq!(of_layer[2], 0.0);
        }
    }
}

/// The wall of a thin tube under axial force and torque: as a fibre, and as a layer free of hoop stress.
#[test]
fn a_fibre_is_a_layer_free_of_stress_across() {
    let mut rng = SmallRng::seed_from_u64(5);
    for (law, ..) in laws(0.3) {
        let (mut fibre, mut layer) = (Point::new(&law, FibreStress), Point::new(&law, PlaneStress));
        let mut across = 0.0;
        for _ in 0..30 {
            let [axial, shear] = random(&mut rng, 5.0 * EY);
            let dt = rng.random_range(0.0..0.1);
            let strain = layer.solve([axial, across, shear], 1, 0.0, dt);
            across = strain[1];
            let [sigma, tau, _] = fibre.to([axial, shear, 0.0], dt);
            let of_layer = layer.to(strain, dt);
            // Newton leaves a hoop stress of some units in the last place.
            let rounding = 1e-10 * YIELD;
            close(of_layer[0], sigma, rounding, "axial");
            close(of_layer[1], 0.0, rounding, "hoop");
            close(of_layer[2], tau, rounding, "shear");
            close(layer.history[3], fibre.history[3], rounding / E, "accumulated plastic strain");
        }
    }
}

/// Perfectly plastic tube, drawn to yield, then twisted at constant length. With σ = σ_Y cos θ and √3 τ = σ_Y sin θ the flow
/// rule integrates to γ(θ) = σ_Y (1/(√3 G) − √3/E) sin θ + √3 (σ_Y/E) artanh sin θ; for 3G = E, √3 τ/σ_Y = tanh(E γ/(√3 σ_Y)).
#[test]
fn a_twisted_tube_converges_to_its_closed_form() {
    let law = MaterialLaw::new(E, NU, linear(0.0), 0.0, None);
    let root = 3f64.sqrt();
    let s = 0.9f64;
    let twist = YIELD * (1.0 / (root * G) - root / E) * s + root * EY * s.atanh();
    let exact = [YIELD * (1.0 - s * s).sqrt(), YIELD * s / root];
    let run = |steps: usize| {
        let (mut fibre, mut layer) = (Point::new(&law, FibreStress), Point::new(&law, PlaneStress));
        fibre.to([EY, 0.0, 0.0], 0.0);
        layer.to([EY, -NU * EY, 0.0], 0.0);
        let (mut sigma, mut strain) = ([0.0; 3], [EY, -NU * EY, 0.0]);
        for n in 1..=steps {
            let gamma = twist * n as f64 / steps as f64;
            sigma = fibre.to([EY, gamma, 0.0], 0.0);
            strain = layer.solve([EY, strain[1], gamma], 1, 0.0, 0.0);
            let of_layer = layer.to(strain, 0.0);
            close(of_layer[0], sigma[0], 1e-9 * YIELD, "axial");
            close(of_layer[2], sigma[1], 1e-9 * YIELD, "shear");
        }
        ((sigma[0] - exact[0]).abs() + (sigma[1] - exact[1]).abs()) / YIELD
    };
    let errors = [100, 200, 400, 800, 1600].map(run);
    // First order: halving the step halves the error, up to its own square.
    assert!(errors[4] < 2e-4 && orders(&errors).iter().all(|o| (o - 1.0).abs() < 0.02), "{errors:?}");
    // Two Richardson steps take h and h² away and leave h³.
    let first: Vec<f64> = errors.windows(2).map(|e| 2.0 * e[1] - e[0]).collect();
    let second: Vec<f64> = first.windows(2).map(|e| (4.0 * e[1] - e[0]) / 3.0).collect();
    assert!(second.iter().all(|e| e.abs() < 1e-6) && second[2].abs() < 1e-8, "{second:?}");
}

// Tangent.

/// Derivative by differences of fourth order, and whether they stay clear of kinks: the same side of the yield surface, the
/// same line of the table.
fn differences<const N: usize, S: StressState<N>>(
    law: &MaterialLaw,
    state: S,
    strain: &[f64; N],
    dt: f64,
    old: &[f64],
    h: f64,
) -> Option<[[f64; N]; N]> {
    let line = |p: f64| [0.002, 0.01, 0.02, 0.05, 0.1].iter().filter(|knot| p >= **knot).count();
    let at = |j: usize, step: f64| {
        let (mut moved, mut new) = (*strain, old.to_vec());
        moved[j] += step;
        let stress = advanced(law, state, &moved, dt, (old, &mut new)).0;
        (stress, (new[N] > old[N], line(new[N])))
    };
    let mut C = [[0.0; N]; N];
    for j in 0..N {
        let points = [2.0, 1.0, -1.0, -2.0].map(|n| at(j, n * h));
        if points.iter().any(|p| p.1 != points[0].1) {
            return None;
        }
        for i in 0..N {
            let [a, b, c, d] = points.map(|p| p.0[i]);
            C[i][j] = (8.0 * (b - c) - (a - d)) / (12.0 * h);
        }
    }
    Some(C)
}

/// Greatest error of the tangent relative to E.
fn tangent_error<const N: usize, S: StressState<N>>(state: S) -> f64 {
    let mut rng = SmallRng::seed_from_u64(6);
    let (mut worst, mut compared, mut skipped) = (0f64, 0, 0);
    for (law, ..) in laws(0.3) {
        for _ in 0..40 {
            let mut point = Point::new(&law, state);
            for _ in 0..rng.random_range(0..4) {
                point.to(random(&mut rng, 6.0 * EY), 10f64.powf(rng.random_range(-4.0..2.0)));
            }
            let size = EY * 10f64.powf(rng.random_range(-0.5..2.0));
            let (strain, dt) = (random(&mut rng, size), 10f64.powf(rng.random_range(-4.0..2.0)));
            let (_, C) = linearised(&law, state, &strain, dt, &point.history);
            match differences(&law, state, &strain, dt, &point.history, 1e-4 * EY) {
                None => skipped += 1,
                Some(D) => {
                    compared += 1;
                    for i in 0..N {
                        for j in 0..N {
                            worst = worst.max((C[i][j] - D[i][j]).abs() / E);
                            assert!((C[i][j] - C[j][i]).abs() <= 1e-15 * E, "{C:?}");
                        }
                    }
                }
            }
        }
    }
    assert!(compared > 20 * skipped, "{compared} compared, {skipped} skipped");
    worst
}

/// Differences over h = 1e-4 yield strains: 1e-14 of a stress of up to 100 yield stresses is 1e-10 of E h or more, and what
/// is left out, (h/ε_Y)⁴ times a fifth derivative that is large beside the onset of viscous flow, is as small.
#[test]
fn tangents_are_the_derivatives() {
    let errors = [tangent_error(Uniaxial), tangent_error(FibreStress), tangent_error(PlaneStress)];
    assert!(errors.iter().all(|e| *e < 1e-9), "{errors:?}");
}

// Viscous: closed forms with v = σ/σ_Y − 1 for a bar whose yield surface keeps its size.

/// Relative errors with 100, 200, … 1600 steps over a time fall in first order, to below `last`.
fn first_order(last: f64, exact: f64, run: impl Fn(usize) -> f64) {
    let errors = [100, 200, 400, 800, 1600].map(|steps| (run(steps) / exact - 1.0).abs());
    assert!(errors[4] < last && orders(&errors).iter().all(|o| (o - 1.0).abs() < 0.03), "{errors:?}");
}

/// v = (E ε̇/((E + H) γ)) (1 − exp(−(E + H) γ t/σ_Y)) from yield on, H all kinematic.
#[test]
fn a_bar_drawn_at_constant_rate_approaches_its_overstress() {
    let (rate, gamma) = (2.0, 0.5);
    for H in [0.0, 0.1 * E] {
        let law = MaterialLaw::new(E, NU, linear(H), 1.0, power(gamma, 1.0));
        let time = 1.5 * YIELD / (E * gamma);
        let v = E * rate / ((E + H) * gamma) * (1.0 - (-(E + H) * gamma * time / YIELD).exp());
        let plastic = EY + rate * time - (YIELD * (1.0 + v)) / E;
        // σ = X + σ_Y (1 + v) with X = H εᵖ:  E (ε − εᵖ) = H εᵖ + σ_Y (1 + v).
        let plastic = plastic * E / (E + H);
        first_order(2e-4, H * plastic + YIELD * (1.0 + v), |steps| {
            let mut bar = Point::new(&law, Uniaxial);
            let dt = time / steps as f64;
            bar.to([EY], EY / rate);
            (1..=steps).fold(0.0, |_, n| bar.to([EY + rate * dt * n as f64], dt)[0])
        });
    }
}

/// Long after yield σ = σ_Y (1 + (ε̇/γ)^(1/n)): the end of any discretisation, so exact but for rounding.
#[test]
fn the_steady_stress_is_that_of_the_rate() {
    for exponent in 1..=50 {
        let n = f64::from(exponent);
        for ratio in [1e-6, 1e-3, 1.0, 1e3, 1e6] {
            let law = MaterialLaw::new(E, NU, linear(0.0), 0.0, power(1.0, n));
            let mut bar = Point::new(&law, Uniaxial);
            let exact = YIELD * (1.0 + f64::powf(ratio, 1.0 / n));
            let step = exact / E;
            let sigma = (1..=60).fold(0.0, |_, k| bar.to([step * f64::from(k)], step / ratio)[0]);
            close(sigma, exact, 1e-12 * exact, &format!("n = {n} at {ratio} γ"));
        }
    }
}

/// Mild steel, D = 40.4 per second and q = 5; the digits of the usual table.
#[test]
fn mild_steel_follows_cowper_and_symonds() {
    let table = [
        (1e-3, 1.11987),
        (1e-2, 1.18999),
        (0.1, 1.30111),
        (1.0, 1.47723),
        (10.0, 1.75635),
        (40.4, 2.0),
        (100.0, 2.19874),
    ];
    let beyond = [(1000.0, 2.89987), (1e4, 1.0 + (1e4f64 / 40.4).powf(0.2))];
    let law = MaterialLaw::new(E, NU, linear(0.0), 0.0, power(40.4, 5.0));
    for (rate, ratio) in table.into_iter().chain(beyond) {
        let mut bar = Point::new(&law, Uniaxial);
        let sigma = (1..=60).fold(0.0, |_, k| bar.to([0.005 * f64::from(k)], 0.005 / rate)[0]);
        close(sigma / YIELD, ratio, 5.1e-6, &format!("at {rate} per second"));
    }
}

/// Overstress left at time t of v₀ = 1.5 at fixed strain, with dv/dt = −(c γ/σ_Y) φ(v).
fn relaxed(overstress: Overstress, s: f64) -> f64 {
    let v0 = 1.5f64;
    match overstress {
        Overstress::Power { exponent: n } if n != 1.0 => (v0.powf(1.0 - n) + (n - 1.0) * s).powf(-1.0 / (n - 1.0)),
        Overstress::Linear | Overstress::Power { .. } => v0 * (-s).exp(),
        // 1 − e⁻ᵛ decays exponentially.
        Overstress::Exponential => -(-(1.0 - (-v0).exp()) * (-s).exp()).ln_1p(),
    }
}

fn relaxation<const N: usize, S: Mises<N>>(state: S, unit: [f64; N], c: f64) {
    let gamma = 0.5;
    for overstress in overstresses().into_iter().filter(|o| *o != Overstress::Power { exponent: 50.0 }) {
        let law = MaterialLaw::new(E, NU, linear(0.0), 0.0, Some(Viscosity { fluidity: gamma, overstress }));
        let strain = S::compliance(&unit.map(|u| 2.5 * YIELD * u / S::mises(&unit)));
        let time = 0.8 * YIELD / (c * gamma);
        first_order(5e-4, 1.0 + relaxed(overstress, 0.8), |steps| {
            let mut point = Point::new(&law, state);
            // At once, so elastic.
            close(S::mises(&point.to(strain, 0.0)), 2.5 * YIELD, 1e-12 * YIELD, "jump");
            (0..steps).fold(0.0, |_, _| S::mises(&point.to(strain, time / steps as f64)) / YIELD)
        });
    }
}

#[test]
fn overstress_relaxes_as_its_function_says() {
    relaxation(Uniaxial, [-1.0], E);
    relaxation(FibreStress, [1.0, 0.0, 0.0], E);
    relaxation(FibreStress, [0.0, 0.6, -0.8], 3.0 * G);
    relaxation(PlaneStress, [1.0, -1.0, 0.5], 3.0 * G);
    relaxation(PlaneStress, [1.0, 1.0, 0.0], E / (2.0 * (1.0 - NU)));
}

/// ε = σ/E + γ vⁿ t: the rate is constant, so any step is exact.
#[test]
fn a_bar_creeps_at_constant_rate() {
    for n in [1.0, 2.5, 5.0] {
        let (gamma, stress) = (0.3, 1.4 * YIELD);
        let law = MaterialLaw::new(E, NU, linear(0.0), 0.0, power(gamma, n));
        let mut bar = Point::new(&law, Uniaxial);
        bar.to([stress / E], 0.0);
        let mut strain = [stress / E];
        for _ in 0..5 {
            strain = bar.solve(strain, 0, stress, 0.01);
            bar.to(strain, 0.01);
        }
        // v = 0.4 carries 1e-13 of the stress into n/0.4 times as much of the rate.
        close(strain[0], stress / E + gamma * f64::powf(0.4, n) * 0.05, 1e-12, "strain");
    }
}

/// A bar at rest gives its elastic energy to plastic and viscous work and to the back stress, in every step: stresses vary in
/// proportion to strains over a step that begins in flow, and trapezoids are exact.
#[test]
fn relaxation_turns_elastic_energy_into_work() {
    for overstress in overstresses() {
        let law = MaterialLaw::new(E, NU, linear(1e4), 0.4, Some(Viscosity { fluidity: 0.5, overstress }));
        let mut bar = Point::new(&law, Uniaxial);
        let strain = [2.5 * EY];
        bar.to(strain, 0.0);
        let before = law.elastic_energy(Uniaxial, &strain, &bar.history);
        close(before, 0.5 * E * strain[0] * strain[0], 1e-12 * before, "elastic energy");
        for _ in 0..7 {
            bar.to(strain, 5e-4);
            let Dissipation { plastic, viscous, stored, .. } = bar.work;
            let after = law.elastic_energy(Uniaxial, &strain, &bar.history);
            close(plastic + viscous + stored, before - after, 1e-12 * before, "work");
            assert!(plastic > 0.0 && viscous > 0.0 && stored > 0.0);
        }
    }
}

/// γ → 0 and Δt = 0 leave the elastic stress, γ → ∞ the rate-independent one up to the overstress of its plastic strain.
#[test]
fn without_and_with_endless_fluidity_viscosity_vanishes() {
    let mut rng = SmallRng::seed_from_u64(7);
    for exponent in 1..=50 {
        let n = f64::from(exponent);
        for hardening in hardenings() {
            let law = |viscosity| MaterialLaw::new(E, NU, hardening.clone(), 0.4, viscosity);
            let strain: [f64; 3] = random(&mut rng, 20.0 * EY);
            let old = [0.0; 8];
            let plastic = stress_at(&law(None), PlaneStress, &strain, 1.0, &old);
            let elastic = MaterialLaw::new(E, NU, linear(f64::INFINITY), 0.0, None);
            let elastic = linearised(&elastic, PlaneStress, &strain, 1.0, &[0.0; 4]);
            for (gamma, dt) in [(1e-300, 1.0), (1.0, 0.0), (0.0, 1.0), (1e-150, 1e-150)] {
                let got = linearised(&law(power(gamma, n)), PlaneStress, &strain, dt, &old);
                (0..3).for_each(|i| close(got.0[i], elastic.0[i], 1e-12 * YIELD, "elastic"));
                (0..9).for_each(|i| close(got.1[i / 3][i % 3], elastic.1[i / 3][i % 3], 1e-12 * E, "elastic tangent"));
            }
            for (gamma, dt) in [(1e100, 1.0), (1e300, 1.0), (1e300, 1e300)] {
                let got = stress_at(&law(power(gamma, n)), PlaneStress, &strain, dt, &old);
                // Stresses move by no more than twice the radius, which a plastic strain below 1 raises by γΔt^(−1/n).
                let v = f64::powf(gamma, -1.0 / n);
                (0..3).for_each(|i| close(got[i], plastic[i], 2.0 * YIELD * (2.0 * v + 1e-13), "plastic"));
            }
        }
    }
}

// Any input.

fn any_hardening(rng: &mut SmallRng) -> Hardening {
    if rng.random_bool(0.5) {
        return linear(if rng.random_bool(0.3) { 0.0 } else { E * 10f64.powf(rng.random_range(-4.0..1.0)) });
    }
    let mut points = vec![[0.0, YIELD]];
    for _ in 0..rng.random_range(1..20) {
        let [p, y] = points[points.len() - 1];
        let step = 10f64.powf(rng.random_range(-5.0..0.0));
        let slope = if rng.random_bool(0.2) { 0.0 } else { E * 10f64.powf(rng.random_range(-4.0..1.0)) };
        points.push([p + step, y + slope * step]);
    }
    Hardening::table(points).unwrap()
}

fn any_viscosity(rng: &mut SmallRng) -> Option<Viscosity> {
    let overstress = match rng.random_range(0..5) {
        0 | 1 => return None,
        2 => Overstress::Linear,
        3 => Overstress::Exponential,
        _ => Overstress::Power { exponent: f64::from(rng.random_range(1..=50)) },
    };
    Some(Viscosity { fluidity: 10f64.powf(rng.random_range(-300.0..300.0)), overstress })
}

/// From a random state, by a random step: the new state is a number, on the yield surface or inside it, Δλ is what the
/// overstress asks for, and what is dissipated is not negative.
fn any_step<const N: usize, S: Mises<N>>(state: S, rng: &mut SmallRng) {
    let (hardening, share) = (any_hardening(rng), [0.0, 0.4, 1.0][rng.random_range(0..3)]);
    let viscosity = any_viscosity(rng);
    let law = MaterialLaw::new(E, NU, hardening.clone(), share, viscosity);
    let mut old = vec![0.0; law.history(state)];
    for decades in [1.0, 6.0] {
        let size = EY * 10f64.powf(rng.random_range(-1.0..decades));
        let strain: [f64; N] = random(rng, size);
        let mut new = vec![f64::NAN; old.len()];
        let (stress, work) = advanced(&law, state, &strain, 1.0, (&old, &mut new));
        let (_, C) = linearised(&law, state, &strain, 1.0, &old);
        let at = format!("{law:?} at {strain:?} from {old:?}: {stress:?}, {new:?}");
        assert!(C.iter().flatten().chain(&stress).chain(&new).all(|x| x.is_finite()), "{at}");

        let back = if share > 0.0 { std::array::from_fn(|i| new[N + 1 + i]) } else { [0.0; N] };
        let relative: [f64; N] = std::array::from_fn(|i| stress[i] - back[i]);
        let radius = YIELD + (1.0 - share) * (yield_stress(&hardening, new[N]) - YIELD);
        let v = if viscosity.is_some() { new[new.len() - 1] } else { 0.0 };
        let (rho, R) = (S::mises(&relative), radius * (1.0 + v));
        let multiplier = new[N] - old[N];
        // Back stresses greater than the radius hide it in their rounding, and exponential overstress in the hundreds
        // multiplies that of v by as much, times the slope of the hardening.
        let change = viscosity.map_or(0.0, |y| y.fluidity * y.overstress.phi(v).1);
        let last_digit = 1e-15 * (1.0 + v) * (E + hardening.rise(new[N]).1) * change;
        let scale = R + S::mises(&back) * 1e-4 + last_digit * 1e10;
        if multiplier > 0.0 || v > 0.0 {
            close(rho, R, 1e-10 * scale, &at);
        } else {
            assert!(rho <= R + 1e-10 * scale, "{at}");
        }
        if let Some(Viscosity { fluidity, overstress }) = viscosity {
            // Δλ and γΔt φ(v) may differ by what rounds off in the stress and in ε̄ᵖ.
            let asked = fluidity * overstress.phi(v).0;
            close(E * multiplier, E * asked, 1e-10 * (E * multiplier + scale + E * old[N] * 1e-5), &at);
        }
        let dissipation: f64 = (0..N).map(|i| relative[i] * (new[i] - old[i])).sum();
        // Plastic strains differ by a few units in their last place where nothing flows.
        let rounding = 1e-14 * R * (multiplier + old[N]);
        assert!(work.plastic >= 0.0 && work.viscous >= 0.0 && dissipation >= -rounding, "{at}");
        // The stress and the plastic strain each have the error of the yield condition.
        close(dissipation, R * multiplier, 3e-10 * scale * (multiplier + old[N] + EY), &at);
        old = new;
    }
}

/// A layer drawn in small steps until it fails: in shear, where the triaxiality is 0, and evenly both ways, where it is 2/3.
#[test]
fn a_layer_fails_by_its_triaxiality() {
    let table = FactorTable::new(vec![[0.0, 2.0], [1.0 / 3.0, 1.0], [2.0 / 3.0, 0.5]]).expect("a table");
    let failure = FailureCriterion { strain: 0.05, triaxiality: Some(table), rate: None };
    for share in [0.0, 0.5] {
        let law = MaterialLaw::new(E, NU, linear(1e3), share, None).failing_at(failure.clone());
        for (unit, factor) in [([0.0, 0.0, 1.0], 2.0), ([1.0, 1.0, 0.0], 0.5), ([-1.0, -1.0, 0.0], 2.0)] {
            let part = 1e-5;
            let mut old = vec![0.0; law.history(PlaneStress)];
            let mut new = old.clone();
            let mut steps = 0;
            while !law.has_failed(PlaneStress, &old) {
                steps += 1;
                let strain = unit.map(|u: f64| u * part * f64::from(steps));
                advanced(&law, PlaneStress, &strain, 1.0, (&old, &mut new));
                old.copy_from_slice(&new);
            }
            // A step adds at most twice its strain.
            let (found, wanted) = (law.accumulated(PlaneStress, &old), factor * failure.strain);
            assert!((0.0..2.0 * part).contains(&(found - wanted)), "{unit:?}: {found} for {wanted}");
        }
    }
}

#[test]
fn any_step_from_any_state_has_an_answer() {
    let mut rng = SmallRng::seed_from_u64(8);
    for _ in 0..40_000 {
        any_step(Uniaxial, &mut rng);
        any_step(FibreStress, &mut rng);
        any_step(PlaneStress, &mut rng);
    }
}

#[test]
fn no_number_is_too_large_and_no_strain_loops() {
    let mut rng = SmallRng::seed_from_u64(9);
    for (law, ..) in laws(0.3) {
        let old = vec![0.0; law.history(PlaneStress)];
        for size in [1e3 * EY, 1e6 * EY, 1e100, 1e200, 1e300] {
            let strain: [f64; 3] = random(&mut rng, size);
            let (stress, C) = linearised(&law, PlaneStress, &strain, 0.1, &old);
            assert!(
                stress.iter().chain(C.iter().flatten()).all(|x| x.is_finite()),
                "{law:?} at {strain:?}: {stress:?}, {C:?}"
            );
        }
        for strain in [[f64::NAN, 0.0, 0.0], [f64::INFINITY, 0.0, 1.0], [1e-3, 0.0, f64::NEG_INFINITY]] {
            let mut new = old.clone();
            let (stress, _) = advanced(&law, PlaneStress, &strain, 0.1, (&old, &mut new));
            assert!(stress.iter().any(|s| !s.is_finite()), "{law:?} at {strain:?}: {stress:?}");
        }
    }
}

/// Eight points side by side, from histories of earlier steps, below yield and far beyond: stress, tangent, history and dissipation have the
/// bits of one point. So have stress and tangent where squares of stresses are out of range.
fn eight_are_one_eight_times<const N: usize, S: StressState<N>>(law: &MaterialLaw, state: S, rng: &mut SmallRng) {
    let size = law.history(state);
    let mut old = vec![0.0; LANES * size];
    for step in 0..40 {
        let scale = EY * [0.01, 1.0, 10.0, 1e3, 1e160][step % if step < 32 { 4 } else { 5 }];
        let strain: [[f64; LANES]; N] = std::array::from_fn(|_| random(rng, scale));
        let history = law.recall::<Lanes, N, S>(state, &old, |lane| lane * size);
        let respond = |ask| law.respond(state, &strain.map(Lanes::new), (0.1, &history), ask);
        let (tangent, end) = (respond(Ask::Tangent), respond(Ask::History(0.7)));
        let (mut new, mut alone) = (old.clone(), old.clone());
        law.remember(state, &end.new, (&old, &mut new), |lane| lane * size);
        for lane in 0..LANES {
            let own = lane * size..(lane + 1) * size;
            let at = |ask| law.at_point(state, &strain.map(|of| of[lane]), (0.1, &old[own.clone()]), ask);
            let (one, last) = (at(Ask::Tangent), at(Ask::History(0.7)));
            law.remember(state, &last.new, (&old[own.clone()], &mut alone[own]), |_| 0);
            assert_eq!(tangent.stress.map(|of| of.to_array()[lane]), one.stress, "{law:?} {scale:e}");
            assert_eq!(end.stress.map(|of| of.to_array()[lane]), last.stress, "{law:?} {scale:e}");
            let C = tangent.tangent.map(|C| C.map(|row| row.map(|of| of.to_array()[lane])));
            let elastic = || law.stiffness(state);
            assert_eq!(C.unwrap_or_else(elastic), one.tangent.unwrap_or_else(elastic), "{law:?} {scale:e}");
            if scale > 1.0 {
                continue; // work is out of range
            }
            let spent = |of: Option<Dissipation>| of.unwrap_or_default();
            assert_eq!(
                spent(end.dissipation.map(|of| of.lane(lane))),
                spent(last.dissipation.map(|of| of.lane(0))),
                "{law:?} {scale:e}"
            );
        }
        if scale < 1.0 {
            assert_eq!(new, alone, "{law:?} {scale:e}");
            old = new;
        }
    }
}

#[test]
fn points_side_by_side_have_the_bits_of_one() {
    let mut rng = SmallRng::seed_from_u64(10);
    let by_stress = FailureCriterion {
        strain: 0.05,
        triaxiality: FactorTable::new(vec![[0.0, 2.0], [1.0 / 3.0, 1.0]]).ok(),
        rate: FactorTable::new(vec![[0.0, 1.0], [10.0, 2.0]]).ok(),
    };
    for (law, ..) in laws(0.3) {
        for failure in [None, Some(FailureCriterion::at(0.05)), Some(by_stress.clone())] {
            let law = failure.map_or(law.clone(), |failure| law.clone().failing_at(failure));
            eight_are_one_eight_times(&law, PlaneStress, &mut rng);
            eight_are_one_eight_times(&law, FibreStress, &mut rng);
            eight_are_one_eight_times(&law, Uniaxial, &mut rng);
        }
    }
}
