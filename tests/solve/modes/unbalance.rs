//! The response to an unbalance, whose spin follows the frequency: against closed forms, an independent finite-element model, and decks at one spin.

use super::response::motion;
use super::{head, modes, outcome};
use crate::support::{decks, node, read_deck, read_stages};
use nalgebra::Complex;
use rdsolve::diagnostic::Source;
use rdsolve::solve::Outcome;
use std::f64::consts::TAU;

type C64 = Complex<f64>;

/// An unbalance of 2e-6 under 60° of a disc on a shaft without mass. It turns forward, whatever the sense of the spin and its size in the deck:
/// (k₁₁ − m ω² + iωc) w + k₁₂ φ = U ω², k₁₂ w + (k₂₂ + (J_p − J_t) ω²) φ = 0 (J. P. Den Hartog, Mechanical Vibrations, 6.11). Shear adds 5e-7 to a flexibility.
#[test]
fn overhung_disc() {
    let (length, h, m, jt, jp, c) = (0.8f64, 1e-3f64, 2e-3, 2e-6, 4e-6, 4e-4);
    let ei = 210e9 * h.powi(4) / 12.0;
    let k = [12.0 * ei / length.powi(3), -6.0 * ei / length.powi(2), 4.0 * ei / length];
    for spin in [-7.0, 200.0f64] {
        let text = head("kind = \"frequency-response\"\nfrequencies = [0.0, 0.5, 2.0, 3.0, 10.0, 25.0]", h, h)
            + &format!(
                "[points]\na = [0.0, 0.0, 0.0]\nb = [{length:?}, 0.0, 0.0]\n[[beams]]\nname = \"shaft\"\npath = [\"a\", \"b\"]\nelements = 1\n\
                 material = \"steel\"\nsection = \"s\"\norientation = [0.0, 1.0, 0.0]\nmass = \"none\"\n[[bodies]]\nname = \"disc\"\n\
                 center = [{length:?}, 0.0, 0.0]\nmass = {m:?}\ninertia = [{jp:?}, {jt:?}, {jt:?}]\nangular_velocity = [{spin:?}, 0.0, 0.0]\n\
                 [[attachments]]\nbody = \"disc\"\nnodes = [\"b\"]\ndofs = [\"ux\", \"uy\", \"uz\", \"ry\", \"rz\"]\n\
                 [[supports]]\nat = \"a\"\nfix = \"all\"\n[[damping.nodal]]\nat = \"disc\"\ntranslation = {c:?}\n\
                 [[loads]]\nat = \"disc\"\nunbalance = [0.0, {:?}, {:?}]\n",
                1e-6,
                1e-6 * 3f64.sqrt()
            );
        let exact = |omega: f64| {
            let slope = k[2] + (jp - jt) * omega * omega;
            let across = C64::new(k[0] - m * omega * omega, c * omega);
            2e-6 * omega * omega * slope / (across * slope - k[1] * k[1])
        };
        let found = modes(&text);
        let disc = node(&read_deck(&text), "disc");
        let both = motion(&found, disc, 1).into_iter().zip(motion(&found, disc, 2));
        for ((frequency, y), (_, z)) in both {
            let w = exact(TAU * frequency);
            // cos(ωt ± 60°) along y, and a quarter of a turn behind or ahead along z.
            let turn = C64::from_polar(1.0, std::f64::consts::FRAC_PI_3 * spin.signum());
            let off = (y - w * turn).norm().max((z + C64::i() * spin.signum() * w * turn).norm());
            println!("spin {spin}, {frequency}: {off:e} of {:e}", w.norm());
            assert!(off <= 1e-4 * w.norm(), "spin {spin}, {frequency}: {y} {z} {w}");
        }
    }
}

/// A rigid rotor in an oil film whose cross-coupled stiffness q = 100 Ω grows with the speed: z = U Ω²/(k − i q + iΩc − m Ω²). The matrices of bearings are those of
/// the frequency, and not of the 800 rad/s of the deck.
#[test]
fn rotor_in_an_oil_film() {
    let deck = std::fs::read_to_string(decks().join("oil_whirl/deck.toml")).unwrap();
    let scene = deck.split_once("[[bodies]]").and_then(|(_, rest)| rest.split_once("# ---- expected")).unwrap().0;
    let text = format!(
        "[analysis]\nkind = \"frequency-response\"\nfrequencies = [20.0, 50.0, 60.0, 100.0]\n[[loads]]\nat = \"rotor\"\nunbalance = [0.0, 3e-4, 0.0]\n[[bodies]]{scene}"
    );
    let found = modes(&text);
    let rotor = node(&read_deck(&text), "rotor");
    for (frequency, y) in motion(&found, rotor, 1) {
        let w = TAU * frequency;
        let exact = 3e-4 * w * w / C64::new(1e6 - 10.0 * w * w, 200.0 * w - 100.0 * w);
        assert!((y - exact).norm() < 1e-9 * exact.norm(), "{frequency}: {y} {exact}");
    }
}

/// A rotor of two discs on bearings of two stiffnesses.
fn two_discs(speed: f64, frequencies: &str, loads: &str) -> String {
    let spin = format!("angular_velocity = [{speed:?}, 0.0, 0.0]");
    let disc = |name: &str, x: f64, radius: f64, length: f64| {
        format!(
            "[[bodies]]\nname = \"{name}\"\ncenter = [{x:?}, 0.0, 0.0]\n{spin}\n\
             shape = {{ kind = \"cylinder\", radius = {radius:?}, length = {length:?}, axis = [1.0, 0.0, 0.0], density = 7850.0 }}\n\
             [[attachments]]\nbody = \"{name}\"\nnodes = \"at_{name}\"\n"
        )
    };
    let bearing = |name: &str, x: f64| {
        format!(
            "[[links]]\nname = \"bearing_{name}\"\nfrom = {{ ground = [{x:?}, 0.0, 0.0] }}\nto = {{ node = \"{name}\" }}\naxes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]\n\
             matrices = [{{ stiffness = [[2e7, 0.0], [0.0, 1e7]], damping = [[500.0, 0.0], [0.0, 500.0]] }}]\n"
        )
    };
    format!(
        "[analysis]\nkind = \"frequency-response\"\nfrequencies = {frequencies}\n[materials.steel]\nmodel = \"elastic\"\nyoungs_modulus = 210e9\npoisson_ratio = 0.3\n\
         density = 7850.0\n[sections.shaft]\nshape = \"tube\"\nradius = 0.02\nthickness = 0.02\n[points]\nleft = [0.0, 0.0, 0.0]\nat_first = [0.3, 0.0, 0.0]\n\
         at_second = [0.7, 0.0, 0.0]\nright = [1.0, 0.0, 0.0]\n[[beams]]\nname = \"shaft\"\npath = [\"left\", \"at_first\", \"at_second\", \"right\"]\nelements = 3\norder = 3\n\
         material = \"steel\"\nsection = \"shaft\"\norientation = [0.0, 1.0, 0.0]\n[[initial]]\nat = \"shaft\"\n{spin}\n[[supports]]\nat = \"left\"\nfix = [\"ux\"]\n"
    ) + &disc("first", 0.3, 0.12, 0.03)
        + &disc("second", 0.7, 0.16, 0.04)
        + &bearing("left", 0.0)
        + &bearing("right", 1.0)
        + loads
}

/// Amplitudes of a model of 80 Timoshenko elements with cubic shapes and gyroscopic matrices (H. D. Nelson, J. Mech. Design 102 (1980)), solved apart, for 1e-4 kg m
/// in the second disc: along y and z at the second, then the first disc. 40 elements change their last two digits.
const INDEPENDENT: [(f64, [f64; 4]); 5] = [
    (100.0, [7.60642825e-7, 8.09945546e-7, 6.47402785e-7, 6.86659889e-7]),
    (150.0, [2.71812645e-6, 3.02466211e-6, 2.39024106e-6, 2.65828926e-6]),
    (400.0, [2.93162192e-6, 2.83680170e-6, 4.06058640e-6, 4.11685405e-6]),
    (1000.0, [5.01410235e-6, 4.75753228e-6, 3.01041581e-6, 2.64988239e-6]),
    (1200.0, [4.28949297e-6, 4.15746558e-6, 1.55264323e-6, 1.38187041e-6]),
];

/// All spins follow the frequency: the response is that of the independent model, and to rounding that of decks which have the spin of each frequency with the
/// forces written out.
#[test]
fn rotor_of_two_discs() {
    let frequencies: Vec<f64> = INDEPENDENT.iter().map(|(speed, _)| speed / TAU).collect();
    let text =
        two_discs(100.0, &format!("{frequencies:?}"), "[[loads]]\nat = \"second\"\nunbalance = [0.0, 1e-4, 0.0]\n");
    let model = read_deck(&text);
    let [first, second] = ["first", "second"].map(|name| node(&model, name));
    let found = modes(&text);
    let mut largest = 0.0f64;
    for (row, (speed, amplitudes)) in INDEPENDENT.iter().enumerate() {
        let force = 1e-4 * speed * speed;
        let written = format!(
            "[[loads]]\nat = \"second\"\nforce = [0.0, {force:?}, 0.0]\namplitude = \"cos\"\n[[loads]]\nat = \"second\"\nforce = [0.0, 0.0, {force:?}]\n\
             amplitude = \"sin\"\n[amplitudes.cos]\nkind = \"harmonic\"\n[amplitudes.sin]\nkind = \"harmonic\"\nphase_degrees = -90.0\n"
        );
        let one = modes(&two_discs(*speed, &format!("{:?}", speed / TAU), &written));
        for (k, amplitude) in amplitudes.iter().enumerate() {
            let (node, dof) = ([second, first][k / 2], 1 + k % 2);
            let (ours, same) = (motion(&found, node, dof)[row].1, motion(&one, node, dof)[0].1);
            // Relative to the largest at this speed: beside it, a disc may stand near a node of the motion.
            let greatest = amplitudes.iter().fold(0.0, |most: f64, x| most.max(*x));
            largest = largest.max((ours.norm() - amplitude).abs() / greatest);
            println!(
                "{speed} {k}: {:e}, by its own deck {:e}",
                ours.norm() / amplitude - 1.0,
                (ours - same).norm() / same.norm()
            );
            assert!((ours - same).norm() < 1e-9 * same.norm(), "{speed} {k}: {ours} {same}");
        }
    }
    // Three elements a segment, and discs whose mass sits in one node as there.
    assert!(largest < 5e-3, "{largest}");
}

/// An unbalance beside a stage that leads to the state: harmonic in the response, and nothing in statics.
#[test]
fn in_a_stage() {
    let load = "[[loads]]\nat = \"second\"\nunbalance = [0.0, 1e-4, 0.0]\n";
    let text = two_discs(100.0, "[20.0]", load);
    let alone = modes(&text);
    let stages = "[[stages]]\nname = \"weight\"\nkind = \"static\"\nduration = 1.0\ntime_step = 1.0\n[[stages]]\nname = \"run\"\nkind = \"frequency-response\"\nfrequencies = [20.0]\n";
    let scene = text.split_once("[materials").unwrap().1;
    let models = read_stages(&Source::new("deck.toml", format!("{stages}[materials{scene}"), &[]));
    assert_eq!(models.len(), 2);
    assert_eq!(models[0].loading.unbalanced_node(), None);
    let (ended, staged) = outcome(&models[1]);
    assert!(matches!(ended, Outcome::Done), "{ended:?}");
    let second = node(&models[1], "second");
    let [a, b] = [&alone, &staged.unwrap()].map(|found| motion(found, second, 1)[0].1);
    assert!((a - b).norm() < 1e-9 * a.norm(), "{a} {b}");
}

/// `around_resonances` resolves the critical speeds of bending that a modal analysis finds; a grid across them has a warning that names one of them.
#[test]
fn critical_speeds_are_resolved() {
    let load = "[[loads]]\nat = \"second\"\nunbalance = [0.0, 1e-4, 0.0]\n";
    let deck = |more: &str| two_discs(100.0, &format!("{{ from = 5.0, to = 105.0, steps = 21{more} }}"), load);
    let grid = modes(&deck(""));
    let said: Vec<&String> = grid.warnings.iter().filter(|said| said.contains("a resonance lies between")).collect();
    let found = modes(&deck(", around_resonances = 3"));
    let modal = deck("").replace(
        "kind = \"frequency-response\"\nfrequencies = { from = 5.0, to = 105.0, steps = 21 }",
        "kind = \"modal\"\ndamped = true\nmodes = 6\nspeeds = { to = 700.0, steps = 8 }",
    );
    let modal = modes(modal.strip_suffix(load).unwrap());
    let bends = modal.critical_speeds.iter().filter(|of| of.mode.whirl.is_none_or(|whirl| !whirl.is_along));
    let critical: Vec<f64> = bends.map(|of| of.speed / TAU).collect();
    let critical: Vec<f64> = critical.into_iter().filter(|f| (5.0..105.0).contains(f)).collect();
    println!("{critical:?} {said:?}");
    assert!(critical.len() >= 2 && said.len() == 1, "{critical:?} {said:?}");
    let rows = &found.response.as_ref().unwrap().rows;
    for f in &critical {
        // Both searches end within 1e-10 of the speed.
        assert!(rows.iter().any(|row| (row.frequency / f - 1.0).abs() < 1e-9), "{f}");
    }
    assert!(!found.warnings.iter().any(|said| said.contains("lies between")), "{:?}", found.warnings);
}
