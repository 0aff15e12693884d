//! Supports that shake differently, against an integration of the same equations here.

use crate::support::{read_deck, tables_of};

const MASS: f64 = 100.0;
/// Stiffness and damping of the links left, between and right of two masses.
const LINKS: [[f64; 2]; 3] = [[1e5, 200.0], [6e4, 0.0], [2e5, 300.0]];
/// Angular frequencies: an acceleration sin(w t) on the left, a displacement 0.02 sin²(w t) on the right.
const W: [f64; 2] = [14.0, 3.5];

fn deck() -> String {
    let link = |(name, from, to): (&str, &str, &str), [k, c]: [f64; 2]| {
        format!(
            "[[links]]\nname = \"{name}\"\nfrom = {{ node = \"{from}\" }}\nto = {{ node = \"{to}\" }}\ndirection = [1.0, 0.0, 0.0]\n\
             stiffness = {k:?}\ndamping = {c:?}\n"
        )
    };
    let ends = [("left", "a", "m"), ("middle", "m", "n"), ("right", "n", "b")];
    let links: String = ends.into_iter().zip(LINKS).map(|(ends, values)| link(ends, values)).collect();
    format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = 1.0\ntime_step = 0.0005\n[integrator]\nscheme = \"newmark\"\n[output]\nevery = 100\n\
         [points]\na = [0.0, 0.0, 0.0]\nm = [1.0, 0.0, 0.0]\nn = [2.0, 0.0, 0.0]\nb = [3.0, 0.0, 0.0]\n[[masses]]\nat = [\"m\", \"n\"]\n\
         mass = {MASS:?}\n{links}[[supports]]\nat = [\"m\", \"n\"]\nfix = [\"uy\", \"uz\"]\n[[supports]]\nat = \"a\"\nfix = [\"uy\", \"uz\"]\n\
         motion = {{ ux = {{ amplitude = \"first\", history = \"acceleration\" }} }}\n[[supports]]\nat = \"b\"\nfix = [\"uy\", \"uz\"]\n\
         motion = {{ ux = {{ amplitude = \"second\", scale = 0.02 }} }}\n[amplitudes.first]\nkind = \"sine\"\nangular_frequency = {:?}\n\
         [amplitudes.second]\nkind = \"sine-squared\"\nangular_frequency = {:?}\n",
        W[0], W[1]
    )
}

/// Displacements and velocities of both masses at multiples of 0.05, by the classical Runge-Kutta method with steps of 1e-4: (ω h)⁵ of the
/// fastest mode, ω = 55, is 5e-12.
fn integrated() -> Vec<[f64; 4]> {
    // A support at rest that begins to accelerate by sin(w t): u = t/w − sin(w t)/w².
    let left = |t: f64| [t / W[0] - (W[0] * t).sin() / (W[0] * W[0]), (1.0 - (W[0] * t).cos()) / W[0]];
    let right = |t: f64| [0.02 * (W[1] * t).sin().powi(2), 0.02 * W[1] * (2.0 * W[1] * t).sin()];
    let rates = |t: f64, [x, v, y, w]: [f64; 4]| {
        let force = |link: usize, stretch: f64, rate: f64| LINKS[link][0] * stretch + LINKS[link][1] * rate;
        let ([a, da], [b, db]) = (left(t), right(t));
        let forces = [force(0, x - a, v - da), force(1, y - x, w - v), force(2, b - y, db - w)];
        [v, (forces[1] - forces[0]) / MASS, w, (forces[2] - forces[1]) / MASS]
    };
    let h = 1e-4;
    let along = |s: [f64; 4], k: [f64; 4], f: f64| std::array::from_fn(|i| s[i] + f * k[i]);
    let (mut state, mut all) = ([0.0; 4], vec![[0.0; 4]]);
    for step in 0..10_000 {
        let t = f64::from(step) * h;
        let k1 = rates(t, state);
        let k2 = rates(t + 0.5 * h, along(state, k1, 0.5 * h));
        let k3 = rates(t + 0.5 * h, along(state, k2, 0.5 * h));
        let k4 = rates(t + h, along(state, k3, h));
        state = std::array::from_fn(|i| state[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
        if (step + 1) % 500 == 0 {
            all.push(state);
        }
    }
    all
}

/// Newmark's trapezoidal rule errs by (ω Δt)²/12 of the phase, 6e-5 of a mode at ω = 55 over its radians: 1e-5 of the largest displacement
/// where the slower mode prevails.
#[test]
fn supports_that_shake_differently_move_masses_as_their_equations_do() {
    let rows = tables_of(&read_deck(&deck())).rows("nodes.csv");
    let exact = integrated();
    let largest = exact.iter().map(|state| state[0].abs().max(state[2].abs())).fold(0.0, f64::max);
    let mut compared = 0;
    for (node, place) in [("m", 0), ("n", 2)] {
        for row in rows.iter().filter(|row| row.text("node") == node) {
            let wanted = exact[(row.number("time") / 0.05).round() as usize][place];
            let found = row.number("ux");
            assert!((found - wanted).abs() < 2e-5 * largest, "{node} at {}: {found} for {wanted}", row.number("time"));
            compared += 1;
        }
    }
    assert_eq!(compared, 42);
}
