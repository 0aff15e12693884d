//! Laws of normal stress beside OpenSees, beside integrations in small steps, and with their slopes and energies.

use super::concrete::ConcreteState;
use super::menegotto_pinto::{SAME, SteelState};
use super::*;
use rand::{RngExt, SeedableRng, rngs::SmallRng};

/// The concrete of `scripts/concrete_fibres.py`.
const CONCRETE: ConcreteModel = ConcreteModel {
    modulus: 30e9,
    strength: 30e6,
    residual: 6e6,
    crushing: Softening::Strain(0.006),
    tensile_strength: 2.5e6,
    cracking: Softening::Strain(2.5e6 / 30e9 + 2.5e6 / 2e9),
    unloading_ratio: 0.1,
};

/// The steel of `scripts/concrete_fibres.py`.
const STEEL: MenegottoPinto = MenegottoPinto {
    modulus: 200e9,
    yield_stress: 500e6,
    hardening_ratio: 0.01,
    curvature: [20.0, 0.925, 0.15],
    isotropic: [0.0, 1.0, 0.0, 1.0],
};

const HARDENING: MenegottoPinto = MenegottoPinto { isotropic: [0.05, 4.0, 0.03, 5.0], ..STEEL };

/// Stresses at the turns of a path of strains by OpenSees 3.7.1: strain, stress in Pa to 0.1.
const CONCRETE02: [[f64; 2]; 13] = [
    [-0.001, -22500000.0],
    [-0.0002, -1326923.1],
    [-0.0015, -28125000.0],
    [0.0006, 1104857.6],
    [-0.003, -24000000.0],
    [-0.0021, -7122580.6],
    [-0.0026, -19664516.1],
    [-0.0005, 404241.0],
    [0.001, 0.0],
    [-0.005, -12000000.0],
    [-0.001, 0.0],
    [-0.008, -6000000.0],
    [0.0, 0.0],
];
const STEEL02: [[f64; 3]; 8] = [
    [0.004, 502997952.8, 502997952.8],
    [-0.001, -373453301.3, -380051344.7],
    [0.003, 391331666.3, 390501185.0],
    [-0.008, -510562966.3, -520673911.9],
    [0.01, 497751472.8, 505259538.6],
    [0.002, -349022550.8, -360815138.0],
    [0.012, 502067139.0, 512528414.4],
    [-0.012, -497041638.3, -519675697.3],
];

/// The laws with numbers of a point, and a scale of their strains and stresses.
fn laws() -> Vec<(PointLaw, f64, f64)> {
    let soft = ConcreteModel { residual: 0.0, tensile_strength: 0.0, cracking: Softening::Strain(0.0), ..CONCRETE };
    let confined = ConcreteModel { residual: 27e6, crushing: Softening::Strain(0.004), ..CONCRETE };
    let concrete = |model: &ConcreteModel| (PointLaw::Concrete(model.of_length(1.0)), 0.004, 30e6);
    let steel = |law| (PointLaw::MenegottoPinto(law), 0.008, 500e6);
    let brittle = ConcreteModel { unloading_ratio: 0.0, ..soft };
    vec![concrete(&CONCRETE), concrete(&soft), concrete(&brittle), concrete(&confined), steel(STEEL), steel(HARDENING)]
}

/// A path of strains with turns at random places.
fn random_path(scale: f64, turns: usize, seed: u64) -> Vec<f64> {
    let mut random = SmallRng::seed_from_u64(seed);
    (0..turns).map(|_| scale * random.random_range(-1.0..0.7)).collect()
}

/// The values of OpenSees are rounded to 0.1 Pa. Its tension begins in the step that passes the plastic strain: with its 2000 steps the stress at
/// 0.0006 differs by 1e-9.
#[test]
fn paths_are_those_of_concrete02_and_steel02() {
    let law = CONCRETE.of_length(1.0);
    let mut state = ConcreteState::default();
    for [strain, stress] in CONCRETE02 {
        state = law.moved(&state, strain).0;
        assert!((state.stress - stress).abs() < 0.2, "{strain}: {} for {stress}", state.stress);
    }
    for (law, column) in [(STEEL, 1), (HARDENING, 2)] {
        let mut state = SteelState::default();
        for row in STEEL02 {
            state = law.moved(&state, row[0]).0;
            assert!((state.stress - row[column]).abs() < 0.2, "{}: {} for {}", row[0], state.stress, row[column]);
        }
    }
}

/// A step gives what a hundred pieces of it give, to rounding: the answer does not depend on the length of steps.
#[test]
fn steps_of_any_length_agree() {
    for (law, scale, size) in laws() {
        let mut whole = vec![0.0; law.variables()];
        let mut pieces = whole.clone();
        let mut start = 0.0;
        for strain in random_path(scale, 300, 7) {
            let (old, mut spent) = (whole.clone(), 0.0);
            let once = law.advance(strain, (0.0, &old), 1.0, &mut whole).plastic;
            for k in 1..=100 {
                let (old, to) = (pieces.clone(), start + (strain - start) * f64::from(k) / 100.0);
                spent += law.advance(to, (0.0, &old), 1.0, &mut pieces).plastic;
            }
            let stress = |history: &[f64]| law.respond(strain, (0.0, history))[0];
            assert!((stress(&whole) - stress(&pieces)).abs() < 1e-9 * size, "{law:?} to {strain}");
            // The curve of steel is no polynomial: three points on each side of its knee err by some 1e-3 of a step of the whole path.
            let bound = if matches!(law, PointLaw::Concrete(_)) { 1e-12 } else { 1e-2 };
            assert!((once - spent).abs() < bound * size * scale, "{law:?} to {strain}: {once} {spent}");
            start = strain;
        }
    }
}

/// Concrete follows the elastic slope in small steps, and its stress is kept between two lines with a common point that is found anew. Steel
/// follows the derivative of its curve in steps of fourth order. The error of these steps is 1e-6 of the strength.
#[test]
fn random_paths_are_those_of_an_integration_in_small_steps() {
    let path = random_path(0.004, 200, 11);
    let (law, mut state) = (CONCRETE.of_length(1.0), ConcreteState::default());
    let [E, f, r, u, f_t, soft]: [f64; 6] = [30e9, 30e6, 6e6, 0.006, 2.5e6, 2e9];
    let (mut x, mut s, mut most, mut wide) = (0.0, 0.0, 0.0f64, 0.0f64);
    for strain in &path {
        state = law.moved(&state, *strain).0;
        let step = (strain - x) / 4000.0;
        for _ in 0..4000 {
            let before = -x;
            x += step;
            // Compression counts as positive here.
            let backbone = |c: f64| {
                let e0 = 2.0 * f / E;
                if c < e0 { E * c - E * c * c / (2.0 * e0) } else { (f + (r - f) * (c - e0) / (u - e0)).max(r) }
            };
            // The line of slope λE through the end of crushing meets the line of slope E at c = −focus.
            let focus = (0.1 * E * u - r) / (0.9 * E);
            let slope = if most > 0.0 { (backbone(most) + E * focus) / (most + focus) } else { E };
            let plastic = most - backbone(most) / slope;
            let c = -x;
            if c >= plastic {
                let (from, stress) = if before < plastic { (plastic, 0.0) } else { (before, s) };
                s = if c > most {
                    backbone(c)
                } else {
                    (stress + E * (c - from)).clamp(0.5 * slope * (c - plastic), slope * (c - plastic))
                };
                most = most.max(c);
                continue;
            }
            let tension = |w: f64| if w < f_t / E { E * w } else { (f_t - soft * (w - f_t / E)).max(0.0) };
            let open = plastic - c;
            wide = wide.max(open);
            s = -tension(wide) * open / wide;
        }
        assert!((state.stress + s).abs() < 1e-6 * f, "{strain}: {} {}", state.stress, -s);
    }
    let (mut state, mut stress, mut from) = (SteelState::default(), 0.0f64, 0.0f64);
    let (mut reversal, mut meeting, mut R, mut before) = ([0.0; 2], [0.0; 2], 20.0, 0.0);
    let [E, b, fy]: [f64; 3] = [200e9, 0.01, 500e6];
    let mut range = [-fy / E, fy / E];
    for strain in random_path(0.008, 60, 3) {
        state = STEEL.moved(&state, strain).0;
        let side = (strain - from).signum();
        if side != before {
            range = [range[0].min(from), range[1].max(from)];
            reversal = [from, stress];
            // s + E (x − e) = side f_y + b E (x − side ε_y).
            let x = (side * fy * (1.0 - b) - stress + E * from) / (E * (1.0 - b));
            meeting = [x, stress + E * (x - from)];
            let xi = (range[usize::from(side > 0.0)] - x).abs() / (fy / E);
            R = 20.0 * (1.0 - 0.925 * xi / (0.15 + xi));
            before = side;
        }
        let slope = |x: f64| {
            let part = ((x - reversal[0]) / (meeting[0] - reversal[0])).abs();
            E * (b + (1.0 - b) * (1.0 + part.powf(R)).powf(-1.0 - 1.0 / R))
        };
        let h = (strain - from) / 2000.0;
        for k in 0..2000 {
            let x = from + h * f64::from(k);
            stress += h / 6.0 * (slope(x) + 4.0 * slope(x + 0.5 * h) + slope(x + h));
        }
        assert!((state.stress - stress).abs() < 1e-6 * fy, "{strain}: {} {stress}", state.stress);
        from = strain;
    }
}

/// A held strain that moves to and fro by rounding changes nothing, wherever the steel has been: the path goes on as if it had not moved.
#[test]
fn rounding_is_no_reversal() {
    for (law, scale, size) in laws() {
        let (mut calm, mut shaken) = (vec![0.0; law.variables()], vec![0.0; law.variables()]);
        let go = |strain: f64, history: &mut [f64]| {
            let old = history.to_vec();
            law.advance(strain, (0.0, &old), 1.0, history);
        };
        for strain in random_path(scale, 200, 4) {
            go(strain, &mut calm);
            go(strain, &mut shaken);
            for held in [strain.next_down(), strain, strain.next_up(), strain, strain.next_down(), strain] {
                go(held, &mut shaken);
            }
            let [a, b] = [&calm, &shaken].map(|history| law.respond(0.5 * strain, (0.0, history))[0]);
            assert!((a - b).abs() < 1e-9 * size, "{law:?} at {strain}: {a} {b}");
        }
    }
}

/// Strains that oscillate within the error of the iteration do not change the path of steel.
#[test]
fn noise_of_the_iteration_is_no_reversal() {
    let law = PointLaw::MenegottoPinto(STEEL);
    let noise = 0.9 * SAME * STEEL.yield_stress / STEEL.modulus;
    let stress = |noise: f64| {
        let mut history = vec![0.0; law.variables()];
        for strain in [0.01, -0.01, -0.002, -0.002 - noise, -0.002 + noise, -0.002] {
            let old = history.clone();
            law.advance(strain, (0.0, &old), 1.0, &mut history);
        }
        law.respond(0.0, (0.0, &history))[0]
    };
    // The noise ends further along the curve, which has at most the slope of Young's modulus.
    assert!((stress(noise) - stress(0.0)).abs() < SAME * STEEL.yield_stress);
    assert!((stress(3.0 * noise) - stress(0.0)).abs() > 0.1 * STEEL.yield_stress);
}

/// Slopes against central differences at random states; where the path bends within the difference, one side agrees.
#[test]
fn slopes_are_those_of_stresses() {
    for (law, scale, size) in laws() {
        let mut history = vec![0.0; law.variables()];
        for (at, probe) in random_path(scale, 400, 5).into_iter().zip(random_path(scale, 400, 6)) {
            let old = history.clone();
            law.advance(at, (0.0, &old), 1.0, &mut history);
            let stress = |strain: f64| law.respond(strain, (0.0, &history))[0];
            let (h, slope) = (1e-7 * scale, law.respond(probe, (0.0, &history))[1]);
            let sides = [1.0, -1.0].map(|side| (stress(probe + side * h) - stress(probe)) / (side * h));
            // The second derivative over h, and the rounding of the stress over h.
            let bound = 1e-5 * size / scale;
            let near = sides.iter().any(|side| (side - slope).abs() < bound);
            assert!(near, "{law:?} at {probe}: {slope} for {sides:?}");
        }
    }
}

/// Concrete gives back no more than was put in, on any way.
#[test]
fn nothing_comes_from_nothing() {
    for (law, scale, size) in laws() {
        let mut history = vec![0.0; law.variables()];
        for strain in random_path(scale, 2000, 9) {
            let old = history.clone();
            let spent = law.advance(strain, (0.0, &old), 1.0, &mut history).plastic;
            assert!(
                spent > -1e-12 * size * scale || !matches!(law, PointLaw::Concrete(_)),
                "{law:?} to {strain}: {spent}"
            );
        }
    }
}

/// Steel spends energy on each closed loop: about 4 f_y (a − ε_y) of an amplitude a of several yield strains, and at least half of it for a
/// round knee.
#[test]
fn closed_loops_of_steel_spend_energy() {
    let [yield_strain, f_y] = [2.5e-3, 500e6];
    for steel in [STEEL, HARDENING] {
        let law = PointLaw::MenegottoPinto(steel);
        for (mean, amplitude) in [(0.0, 2.0), (0.0, 4.0), (3.0, 2.0), (-3.0, 3.0), (1.0, 8.0)] {
            let mut history = vec![0.0; law.variables()];
            let mut go = |to: f64| {
                let old = history.clone();
                law.advance((mean + to) * yield_strain, (0.0, &old), 1.0, &mut history).plastic
            };
            go(amplitude);
            for turn in 0..5 {
                let spent = go(-amplitude) + go(amplitude);
                let about = 4.0 * f_y * (amplitude - 1.0) * yield_strain;
                assert!(spent > 0.5 * about && spent < 2.0 * about, "{mean} {amplitude} {turn}: {spent} of {about}");
            }
        }
    }
}

/// A history that is written part of the way is that of a step to this place.
#[test]
fn part_of_a_step_is_a_shorter_step() {
    for (law, scale, size) in laws() {
        let (mut history, mut from) = (vec![0.0; law.variables()], 0.0);
        for strain in random_path(scale, 100, 10) {
            let old = history.clone();
            let mut short = old.clone();
            let a = law.advance(strain, (0.0, &old), 0.25, &mut history).plastic;
            from += 0.25 * (strain - from);
            let b = law.advance(from, (0.0, &old), 1.0, &mut short).plastic;
            // The place itself is rounded alike in both.
            assert_eq!(history, short, "{law:?} to {strain}");
            assert!((a - b).abs() <= 1e-12 * size * scale, "{law:?} to {strain}: {a} {b}");
        }
    }
}

/// The dissipation of crushing and of cracking per area is the energy that the deck gives, whatever the length. The energy of crushing supposes
/// unloading of slope E; that of the law is softer, so its dissipation differs by up to 2 %.
#[test]
fn softening_dissipates_its_energy() {
    let model = ConcreteModel { crushing: Softening::Energy(30e3), cracking: Softening::Energy(100.0), ..CONCRETE };
    for length in [0.1, 0.3, 0.5] {
        assert!(model.longest().iter().all(|&longest| length < longest));
        let law = model.of_length(length);
        let start = ConcreteState::default();
        let spent = |strain: f64| law.dissipated(&start, &law.moved(&start, strain).0) * length;
        assert!((spent(0.1) / 100.0 - 1.0).abs() < 1e-12, "{length}: {}", spent(0.1));
        let peak = law.moved(&start, -model.strain_at_strength()).0;
        let line = |x: f64| law.moved(&start, x).0.stress;
        let mut end = peak.strain;
        while line(end) < -6e6 * (1.0 + 1e-9) {
            end -= 1e-7;
        }
        let crushed = law.dissipated(&peak, &law.moved(&peak, end).0) * length;
        assert!((crushed / 30e3 - 1.0).abs() < 0.02, "{length}: {crushed}");
    }
}
