//! Mass scaling: the step that elements are given, what it adds to their masses, and what comes of that.

use super::scenes::{AUTO, dynamic};
use super::{balance_of, scene};
use crate::support::{node, run_to_the_end, tables_of};
use nalgebra::{DMatrix, DVector};
use rdsolve::integrators::default_scheme;
use rdsolve::linear::Sparse;
use rdsolve::model::{Model, Solution};
use rdsolve::modes::SceneMatrices;
use rdsolve::plan::Plan;
use rdsolve::system::{ScaledPart, System};
use std::f64::consts::PI;

/// Steel: √(E/ρ) = 5000, as if it did not contract across.
const STEEL: &str =
    "[materials.steel]\nmodel = \"elastic\"\nyoungs_modulus = 200e9\npoisson_ratio = 0.0\ndensity = 8000.0\n";
const SPEED: f64 = 5000.0;
const DENSITY: f64 = 8000.0;
const OFF: &str = "mass_scaling = \"off\"\n";
/// Length of the elements of a bar, and of the one among them that is a twentieth as long.
const ELEMENT: f64 = 0.05;
const SLIVER: f64 = 0.0025;
const AREA: f64 = 1e-4;
const MODULUS: f64 = 200e9;

/// The head of a deck with mass scaling, or without.
fn head(end_time: f64, time_step: impl std::fmt::Display, scaled: Option<f64>) -> String {
    let key = scaled.map_or("mass_scaling = \"off\"\n".to_owned(), |step| format!("mass_scaling_step = {step}\n"));
    dynamic(end_time, time_step, "central-difference") + &key + STEEL + "[output]\nevery = 1\n"
}

/// A bar of elements along x, with a sliver among them: its ends are p0, p1, ...
fn lengths(before: usize, after: usize) -> Vec<f64> {
    [vec![ELEMENT; before], vec![SLIVER], vec![ELEMENT; after]].concat()
}

fn bar(lengths: &[f64]) -> String {
    let mut text = "[points]\n".to_owned();
    let mut x = 0.0;
    for (k, length) in std::iter::once(&0.0).chain(lengths).enumerate() {
        x += length;
        text += &format!("p{k} = [{x}, 0.0, 0.0]\n");
    }
    let points: Vec<String> = (0..=lengths.len()).map(|k| format!("\"p{k}\"")).collect();
    text + &format!("[[bars]]\nname = \"bar\"\npath = [{}]\nmaterial = \"steel\"\narea = {AREA}\n", points.join(", "))
}

/// Squares of frequencies, ascending, and modes of the same bar clamped at p0, with `factor` times the mass of its sliver: a chain of masses.
fn chain(lengths: &[f64], factor: f64) -> (DVector<f64>, DMatrix<f64>) {
    let n = lengths.len();
    let (mut K, mut masses) = (DMatrix::<f64>::zeros(n + 1, n + 1), vec![0.0; n + 1]);
    for (e, length) in lengths.iter().enumerate() {
        let k = MODULUS * AREA / length;
        for (i, j, k) in [(0, 0, k), (1, 1, k), (0, 1, -k), (1, 0, -k)] {
            K[(e + i, e + j)] += k;
        }
        let mass = DENSITY * AREA * length * if *length == SLIVER { factor } else { 1.0 };
        [0, 1].into_iter().for_each(|i| masses[e + i] += 0.5 * mass);
    }
    let S: DMatrix<f64> = DMatrix::from_fn(n, n, |i, j| K[(i + 1, j + 1)] / (masses[i + 1] * masses[j + 1]).sqrt());
    let found = S.symmetric_eigen();
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&a, &b| found.eigenvalues[a].total_cmp(&found.eigenvalues[b]));
    let values = DVector::from_fn(n, |k, _| found.eigenvalues[order[k]]);
    let mode = |i: usize, k: usize| found.eigenvectors[(i, order[k])] / masses[i + 1].sqrt();
    (values, DMatrix::from_fn(n, n, mode))
}

const CLAMP: &str = "[[supports]]\nat = \"p0\"\nfix = \"all\"\n";

fn struck(node: usize, velocity: f64) -> String {
    format!("[[initial]]\nat = \"p{node}\"\nvelocity = [{velocity:e}, 0.0, 0.0]\n")
}

fn parts(model: &Model) -> Vec<ScaledPart> {
    System::new(model).unwrap().mass_scaling().expect("mass scaling").parts.clone()
}

/// L⁻¹ K L⁻ᵀ of a scene with M = L Lᵀ, the masses that its explicit scheme has.
fn squares(model: &Model) -> DMatrix<f64> {
    let system = System::new(model).unwrap();
    let implicit = Model { solution: Solution { scheme: default_scheme(), ..model.solution.clone() }, ..model.clone() };
    let plan = Plan::new(&implicit, &system, 1);
    let matrices = SceneMatrices::of(&implicit, &system, &plan).unwrap();
    let full = |of: &Sparse| -> DMatrix<f64> {
        let mut full = DMatrix::zeros(of.rows(), of.rows());
        of.entries().for_each(|(i, j, value)| full[(i, j)] += value);
        0.5 * (&full + full.transpose())
    };
    dense::by_masses(&full(&matrices.stiffness), full(&matrices.mass))
}

/// All squares of frequencies of a scene with the masses that its explicit scheme has, ascending.
pub(super) fn spectrum(model: &Model) -> Vec<f64> {
    dense::eigenvalues(&squares(model))
}

/// An element of a twentieth of the length asks for a twentieth of the step; it is given (Δt c/L)² times its mass, and steps are 0.8 of the
/// limit of the chain of masses that this makes.
#[test]
fn the_step_rises_as_the_mass_of_a_sliver_has_it() {
    let lengths = lengths(12, 8);
    let own = SLIVER / SPEED;
    let mut steps = Vec::new();
    for ratio in [None, Some(5.0), Some(10.0)] {
        let scaled = ratio.map(|ratio| ratio * own);
        let model = scene(&(head(5e-4, AUTO, scaled) + &bar(&lengths) + CLAMP + &struck(21, 1.0)), &[]);
        let factor = ratio.map_or(1.0, |ratio: f64| ratio * ratio);
        if ratio.is_some() {
            let told = &parts(&model)[0];
            let added = (factor - 1.0) * DENSITY * AREA * SLIVER;
            // Rounding of an eigenvalue.
            assert!((told.added / added - 1.0).abs() < 1e-12, "{told:?}");
            assert_eq!((told.heavier, told.rotary, told.elements), (1, 0, 21));
        }
        let done = run_to_the_end(&model, &mut |frame| vec![frame.dt]);
        let limit = 2.0 / chain(&lengths, factor).0.max().sqrt();
        let step = done.rows[1][0];
        println!("{ratio:?}: {} steps, the first {:.4} of 0.8 of the limit", done.counts.steps, step / (0.8 * limit));
        // A whole number of steps; power iteration leaves half a per cent.
        assert!((0.99..1.006).contains(&(step / (0.8 * limit))), "{step} {limit}");
        assert!(scaled.is_none_or(|scaled| limit >= scaled), "{limit}: elements bound the scene");
        steps.push(done.counts.steps as f64);
    }
    // The sliver alone would ask for a fifth and a tenth; half the mass of its neighbours stands at its nodes besides.
    assert!(steps[0] > 1.4 * steps[1] && steps[1] > 1.5 * steps[2], "{steps:?}");
}

/// The first mode of a clamped bar swings with the frequency of the chain of masses, which is lower than that of the true bar by the
/// part that the added mass has in the energy of the mode: ω′ = ω/√(1 + 2 μ sin²(π x/2 L)), with μ the share of mass that is added.
#[test]
fn added_mass_lowers_the_first_frequency_as_it_should() {
    let lengths = lengths(12, 8);
    let (length, ratio) = (lengths.iter().sum::<f64>(), 3.0);
    let factor = ratio * ratio;
    let (values, modes) = chain(&lengths, factor);
    let (omega, unscaled) = (values[0].sqrt(), chain(&lengths, 1.0).0[0].sqrt());
    let share = (factor - 1.0) * SLIVER / length;
    let weight = (0.5 * PI * (12.0 * ELEMENT + 0.5 * SLIVER) / length).sin().powi(2);
    let predicted = (1.0 + 2.0 * share * weight).sqrt().recip();
    println!("{:.5} of the frequency, {predicted:.5} predicted, mass + {:.2} %", omega / unscaled, 100.0 * share);
    // The shape of the mode changes by the share, its frequency by the square of that.
    assert!((omega / unscaled - predicted).abs() < share * share, "{omega} {unscaled}");
    let swing = |scaled: Option<f64>| {
        let tip = modes[(20, 0)];
        let moves: String = (0..21).map(|k| struck(k + 1, 1e-3 * modes[(k, 0)] / tip)).collect();
        let step = ratio * SLIVER / SPEED;
        let end = 5.0 * 2.0 * PI / omega;
        let time_step = if scaled.is_some() { step } else { 0.8 * SLIVER / SPEED };
        let model = scene(&(head(end, time_step, scaled.map(|_| step)) + &bar(&lengths) + CLAMP + &moves), &[]);
        let (at, start) = (node(&model, "p21"), length);
        run_to_the_end(&model, &mut |frame| vec![frame.state.time, 1e3 * omega * (frame.state.nodes[at].x.x - start)])
            .rows
    };
    let worst = |rows: &[Vec<f64>], omega: f64| {
        let off = |row: &Vec<f64>| (row[1] - (omega * row[0]).sin()).abs();
        rows.iter().map(off).fold(0.0, f64::max)
    };
    let scaled = worst(&swing(Some(1.0)), omega);
    let reference = worst(&swing(None), omega);
    println!(
        "five periods: {scaled:.1e} off the closed form; without mass scaling the motion is {reference:.3} off it"
    );
    // Central differences shorten periods by (ω Δt)²/24, ω Δt = 0.012.
    let turn = 10.0 * PI;
    assert!(scaled < turn * (omega * ratio * SLIVER / SPEED).powi(2) / 20.0, "{scaled}");
    // The two motions part by no more than their phases do.
    assert!(reference < 1.05 * turn * (1.0 / predicted - 1.0), "{reference}");
}

/// A free bar that is struck at its sliver: momentum is that of the mass with what is added, and energy is kept.
#[test]
fn momentum_and_energy_of_the_larger_mass_are_kept() {
    let lengths = lengths(6, 4);
    let (own, ratio) = (SLIVER / SPEED, 6.0);
    let text = head(2e-4, 0.9 * ratio * own, Some(ratio * own)) + &bar(&lengths) + &struck(6, 3.0);
    let model = scene(&text, &[]);
    let expected = 3.0 * 0.5 * DENSITY * AREA * (ELEMENT + ratio * ratio * SLIVER);
    let rows = run_to_the_end(&model, &mut |frame| vec![frame.derived.energy.unwrap().p.x]).rows;
    // Rounding of a hundred steps.
    assert!(rows.iter().all(|row| (row[0] / expected - 1.0).abs() < 1e-11), "{expected} {:?}", rows.last());
    let balance = balance_of(&model);
    println!("{balance:?}");
    // Equal steps of a linear scene keep the energy of central differences but for rounding.
    assert!(balance.generated.max(balance.dissipated) < 1e-10 * balance.available, "{balance:?}");
}

/// Weight is that of the true mass: what falls freely gains the momentum m g t, with the larger mass, and the balance of energy is closed.
#[test]
fn added_mass_has_no_weight() {
    let lengths = lengths(6, 4);
    let (own, ratio, g) = (SLIVER / SPEED, 6.0, 9.81);
    let gravity = format!("[environment]\ngravity = [-{g}, 0.0, 0.0]\n");
    let text = head(2e-4, 0.9 * ratio * own, Some(ratio * own)) + &bar(&lengths) + &gravity;
    let model = scene(&text, &[]);
    let mass: f64 = lengths.iter().map(|length| DENSITY * AREA * length).sum();
    let row = |frame: &rdsolve::solve::Frame| vec![frame.state.time, frame.derived.energy.unwrap().p.x];
    for row in run_to_the_end(&model, &mut { row }).rows {
        // Rounding of a hundred steps.
        assert!((row[1] + mass * g * row[0]).abs() < 1e-11 * mass * g * 2e-4, "{row:?}");
    }
    let balance = balance_of(&model);
    // The same; the work of weight is summed step by step.
    assert!(balance.generated.max(balance.dissipated) < 1e-10 * balance.peak, "{balance:?}");
    assert!(System::new(&model).unwrap().inertias.iter().any(|inertia| inertia.mass > inertia.weighing));
    let explained = {
        let system = System::new(&model).unwrap();
        rdsolve::plan::explain::explain(&Plan::new(&model, &system, 1), &model, &system).to_string()
    };
    assert!(explained.contains("falling bodies fall slower"), "{explained}");
}

/// Forces at the ends of beams balance the support, with the inertia of what is added.
#[test]
fn forces_at_ends_of_beams_hold_what_is_added() {
    let text = head(2e-4, 2e-6, Some(4e-6))
        .replace("every = 1", "every = 1\nsections = { at = \"ends\" }\nreactions = true")
        + "[sections.square]\nshape = \"rectangle\"\nwidth = 0.05\nheight = 0.05\n[points]\nfoot = [0.0, 0.0, 0.0]\nnear = [0.005, 0.0, 0.0]\n\
           tip = [1.0, 0.0, 0.0]\n[[beams]]\nname = \"beam\"\npath = [\"foot\", \"near\", \"tip\"]\nelements = [1, 8]\nmaterial = \"steel\"\n\
           section = \"square\"\norientation = [0.0, 1.0, 0.0]\n[[supports]]\nat = \"foot\"\nfix = \"all\"\n[[loads]]\nat = \"tip\"\n\
           force = [1e4, 0.0, 0.0]\n";
    let model = scene(&text, &[]);
    assert_eq!(parts(&model)[0].heavier, 1);
    let tables = tables_of(&model);
    let (sections, reactions) = (tables.rows("sections.csv"), tables.rows("reactions.csv"));
    let first: Vec<f64> = sections.iter().filter(|row| row.number("s") == 0.0).map(|row| row.number("N")).collect();
    let held: Vec<f64> =
        reactions.iter().filter(|row| row.text("direction") == "ux").map(|row| row.number("value")).collect();
    assert!(first.len() == held.len() && first.len() > 50, "{} {}", first.len(), held.len());
    // Rounding of forces of 1e4.
    assert!(first.iter().zip(&held).all(|(n, r)| (n + r).abs() < 1e-7), "{first:?}\n{held:?}");
    assert!(held.iter().any(|r| r.abs() > 1e3));
}

/// Three patches of eight elements along x, of which the middle one is a row of slivers.
fn panel(thickness: f64, scaled: Option<f64>) -> String {
    let (low, high) = (0.2, 0.21);
    let mut text = head(1e-3, AUTO, scaled) + "[points]\n";
    for (k, y) in [0.0, low, high, high + 0.2].into_iter().enumerate() {
        text += &format!("a{k} = [0.0, {y}, 0.0]\nb{k} = [0.8, {y}, 0.0]\n");
    }
    for (k, (name, rows)) in [("low", 2), ("slivers", 1), ("high", 2)].into_iter().enumerate() {
        let l = k + 1;
        text += &format!(
            "[[shells]]\nname = \"{name}\"\nmaterial = \"steel\"\nthickness = {thickness}\n\
             corners = [\"a{k}\", \"b{k}\", \"b{l}\", \"a{l}\"]\nelements = [8, {rows}]\n"
        );
    }
    text + "[[initial]]\nat = \"slivers\"\nvelocity = [0.0, 1.0, 0.0]\n"
}

/// A sheet of rectangles 0.1 × 0.1 with a row of 0.1 × 0.01. Their fastest motion stretches them across, by the displacements v of both long
/// sides and by drilling rotations θ, whose side bulges by a θ/6 in the mean: κ = 4 E/ρ b² (1 + a²/36 r²), with r² = a²/8 the square of
/// the radius of gyration that they are given first. Somewhat faster still they shear across, κ = k G (4/b² + 1/r²) with r² = b²/8 about
/// their long side and k G = 5 E/12. The rest is given as mass.
#[test]
fn a_row_of_slivers_in_a_sheet_by_hand() {
    let (a, b, h, step) = (0.1, 0.01, 1e-3, 6e-6);
    let model = scene(&panel(h, Some(step)), &[]);
    let told = parts(&model);
    let names: Vec<&str> = told.iter().map(|part| part.name.as_str()).collect();
    assert_eq!(names, ["low", "slivers", "high"]);
    let (stretches, shears) = (1.0 + 8.0 / 36.0, 5.0 / 4.0);
    let factor = (step * SPEED / b).powi(2) * f64::max(stretches, shears);
    let added = 8.0 * (factor - 1.0) * DENSITY * h * a * b;
    println!("{:.5} of {factor:.5}", told[1].factor);
    // What holds drilling rotations at their nodes, and bending, add 1e-4.
    assert!((told[1].added / added - 1.0).abs() < 3e-4, "{:?} {added}", told[1]);
    assert_eq!((told[1].heavier, told[1].elements), (8, 8));
    for part in [&told[0], &told[2]] {
        // Thin squares are slow enough by rotary inertia alone.
        assert_eq!((part.heavier, part.rotary, part.elements, part.added), (0, 16, 16, 0.0), "{part:?}");
        assert!((part.mass / (0.8 * 0.2 * h * DENSITY) - 1.0).abs() < 1e-12);
    }
    let mass = 0.8 * 0.41 * h * DENSITY;
    let system = System::new(&model).unwrap();
    let scaling = system.mass_scaling().unwrap();
    assert!((scaling.mass / mass - 1.0).abs() < 1e-12 && (scaling.added() / added - 1.0).abs() < 3e-4);
    let warning = rdsolve::plan::explain::much_mass_added(&system).expect("a warning");
    assert!(warning.message.contains("`slivers`"), "{}", warning.message);
    let lines = rdsolve::plan::explain::mass_added(scaling);
    assert!(lines[1].1.contains("`slivers`") && lines.last().unwrap().1.contains("inertia of 40 of 40"), "{lines:?}");
}

/// No frequency of a scene exceeds that which its elements are given, in thin sheets and thick ones, and steps are as long as they say.
#[test]
fn elements_bound_the_frequencies_of_a_sheet() {
    for (thickness, step) in [(1e-3, 2e-6), (1e-3, 8e-6), (0.02, 8e-6), (0.1, 2e-5)] {
        let limit = |scaled: Option<f64>| 2.0 / spectrum(&scene(&panel(thickness, scaled), &[])).last().unwrap().sqrt();
        let (model, own, limit) = (scene(&panel(thickness, Some(step)), &[]), limit(None), limit(Some(step)));
        println!(
            "{thickness} {step:e}: critical time step {:.3} of it, {:.1} times the own",
            limit / step,
            limit / own
        );
        assert!((1.0..1.6).contains(&(limit / step)), "{limit} {step}");
        let first = run_to_the_end(&model, &mut |frame| vec![frame.dt]).rows[1][0];
        // Power iteration leaves half a per cent, and steps are a whole number.
        assert!((0.97..1.006).contains(&(first / (0.8 * limit))), "{first} {limit}");
    }
}

/// Rotary inertia alone makes a thin strip seven times as slow in its fastest motion, and lowers its first frequency by what it has in the
/// energy of that mode: ω² ~ 1/(1 + r² ∫w′²/∫w²), 4.648/L² for a cantilever.
#[test]
fn rotary_inertia_changes_slow_bending_by_little() {
    let length = 1.0_f64;
    let strip = |scaled: Option<f64>| {
        let text = head(1e-3, AUTO, scaled)
            + "[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\nc = [1.0, 0.1, 0.0]\nd = [0.0, 0.1, 0.0]\n[[shells]]\nname = \"strip\"\n\
               material = \"steel\"\nthickness = 0.01\ncorners = [\"a\", \"b\", \"c\", \"d\"]\nelements = [10, 1]\n[[supports]]\n\
               at = \"strip.edge4\"\nfix = \"all\"\n";
        scene(&text, &[])
    };
    let (plain, scaled) = (strip(None), strip(Some(1.5e-5)));
    let told = &parts(&scaled)[0];
    assert_eq!((told.heavier, told.rotary, told.added), (0, 10, 0.0), "{told:?}");
    let [of_plain, of_scaled] = [&plain, &scaled].map(spectrum);
    let [slow, fast] = [of_plain.last().unwrap() / of_scaled.last().unwrap(), of_scaled[0] / of_plain[0]];
    let system = System::new(&scaled).unwrap();
    let inner = system.inertias.iter().map(|inertia| inertia.J0[(1, 1)] / inertia.mass).fold(0.0, f64::max);
    let turning = |square: f64| 1.0 + square * 4.648 / (length * length);
    let predicted = turning(0.01_f64.powi(2) / 12.0) / turning(inner);
    println!("fastest: {:.1} times slower; first: {fast:.6}, predicted {predicted:.6}", slow.sqrt());
    assert!(slow > 50.0, "{slow}");
    // What the mesh of ten elements makes of the integrals, 2 % of the change.
    assert!(((1.0 - fast) / (1.0 - predicted) - 1.0).abs() < 0.05, "{fast} {predicted}");
    assert!(1.0 - fast < 0.01);
}

/// A shaft twists and spins with the inertia of its section, whatever its bending is given: the first frequency of torsion is that of the
/// unscaled one, and so is the energy of its spin.
#[test]
fn a_shaft_keeps_its_inertia_about_its_axis() {
    let shaft = |order: usize, scaled: Option<f64>, more: &str| {
        let text = head(1e-5, AUTO, scaled)
            + &format!(
                "energy = true\n[sections.round]\nshape = \"tube\"\nradius = 0.002\nthickness = 0.002\n\
                 [points]\na = [0.0, 0.0, 0.0]\nb = [0.6, 0.8, 0.0]\n[[beams]]\nname = \"shaft\"\npath = [\"a\", \"b\"]\nelements = 7\n\
                 order = {order}\nsection = \"round\"\nmaterial = \"steel\"\norientation = [0.0, 0.0, 1.0]\n{more}"
            );
        scene(&text, &["analysis.plane=off"])
    };
    let held = "[[supports]]\nat = \"a\"\nfix = \"all\"\n";
    let spins = "[[initial]]\nat = \"shaft\"\nangular_velocity = [60.0, 80.0, 0.0]\n";
    for (order, step) in [(1, 9e-6), (3, 4e-6)] {
        let [plain, scaled] = [None, Some(step)].map(|scaled| shaft(order, scaled, held));
        let told = &parts(&scaled)[0];
        assert!(told.heavier == 0 && (order == 1 || told.rotary == 7), "{told:?}");
        // Torsion at √(G/ρ)/4L, G = E/2.
        let first = (0.5 * PI * (0.5f64).sqrt() * SPEED).powi(2);
        let torsion = |model: &Model| {
            // Modes of bending are 18 % apart there.
            spectrum(model).into_iter().min_by(|a, b| (a - first).abs().total_cmp(&(b - first).abs())).expect("a mode")
        };
        let [own, with] = [&plain, &scaled].map(torsion);
        // Seven elements of first order are 0.2 % off; scaling changes rounding alone.
        assert!((own / first - 1.0).abs() < 0.01 && (with / own - 1.0).abs() < 1e-9, "{order}: {own} {with} {first}");
        let spin = |scaled: Option<f64>| {
            let model = shaft(order, scaled, spins);
            run_to_the_end(&model, &mut |frame| vec![frame.derived.energy.expect("energies").kinetic]).rows[0][0]
        };
        let polar = 0.5 * DENSITY * PI * 0.002f64.powi(4);
        let [own, with] = [None, Some(step)].map(spin);
        // The inertia of order 1 about the axis has a part of its own, which keeps it off zero.
        assert!((with / own - 1.0).abs() < 1e-12, "{order}: {own} {with}");
        assert!(order == 1 || (own / (0.5 * polar * 1e4) - 1.0).abs() < 1e-9, "{order}: {own}");
    }
}

/// Rectangles twice and four times as long as wide, bent along their longer and along their shorter side: a wave ten elements long is
/// slower by 1 − 1/√(1 + r²k²) at the most, r² = h²/8, k = 2π/10h.
#[test]
fn waves_of_ten_elements_are_slower_by_little() {
    let strip = |[length, width]: [f64; 2], thickness: f64, scaled: Option<f64>| {
        let text = head(1e-4, AUTO, scaled)
            + &format!(
                "[points]\na = [0.0, 0.0, 0.0]\nb = [{length:?}, 0.0, 0.0]\nc = [{length:?}, {width:?}, 0.0]\nd = [0.0, {width:?}, 0.0]\n\
                 [[shells]]\nname = \"strip\"\nmaterial = \"steel\"\nthickness = {thickness:?}\ncorners = [\"a\", \"b\", \"c\", \"d\"]\n\
                 elements = [5, 1]\n[[supports]]\nat = [\"strip.edge2\", \"strip.edge4\"]\nfix = \"translations\"\n\
                 [[supports]]\nat = \"strip\"\nfix = [\"ux\", \"uy\", \"rx\", \"rz\"]\n"
            );
        scene(&text, &[])
    };
    let slower = 1.0 - (1.0 + (2.0 * PI / 10.0).powi(2) / 8.0).sqrt().recip();
    // Half a wave over five elements of 0.05, beside 0.05, 0.1, 0.2 and 0.0125.
    for (width, step) in [(0.05, 6e-6), (0.1, 6e-6), (0.2, 6e-6), (0.0125, 2e-6)] {
        let thickness = 0.001;
        let [plain, scaled] = [None, Some(step)].map(|scaled| strip([0.25, width], thickness, scaled));
        let told = &parts(&scaled)[0];
        let [own, with] = [&plain, &scaled].map(|model| spectrum(model)[0].sqrt());
        println!("{width}: {:.5} of {slower:.5}, {told:?}", 1.0 - with / own);
        assert!(told.rotary == 5 && told.heavier == 0, "{told:?}");
        // The mesh has its own part of second order.
        assert!((0.0..1.02 * slower).contains(&(1.0 - with / own)), "{width}: {own} {with}");
    }
}

/// Where something else asks for a shorter step, the run names it: what has most of the stiffness of that motion, and not what just hangs
/// there.
#[test]
fn what_bounds_the_step_besides_elements_is_named() {
    let link = "[[links]]\nname = \"spring\"\nfrom = { ground = [3.0, 0.0, 0.0] }\nto = { node = \"p11\" }\nstiffness = 1e11\n";
    let text = head(1e-4, AUTO, Some(4e-6)) + &bar(&lengths(6, 4)) + CLAMP + &struck(6, 1.0);
    let warnings_of = |text: &str| {
        let of_scaling = |warning: &String| warning.contains("mass_scaling_step");
        run_to_the_end(&scene(text, &[]), &mut |_| Vec::new())
            .warnings
            .into_iter()
            .filter(of_scaling)
            .collect::<Vec<_>>()
    };
    assert_eq!(warnings_of(&text), Vec::<String>::new());
    let weak = link.replace("spring", "thread").replace("1e11", "1.0");
    let bound = text.clone() + &weak + link;
    let found = warnings_of(&bound);
    assert!(found.len() == 1 && found[0].contains("`spring` limits it") && found[0].contains("`p11`"), "{found:?}");
    // What it proposes does.
    let step = found[0].split("Give `mass_scaling_step` = ").nth(1).and_then(|rest| rest.split(':').next()).unwrap();
    assert_eq!(
        warnings_of(&bound.replace("mass_scaling_step = 0.000004", &format!("mass_scaling_step = {step}"))),
        Vec::<String>::new()
    );
}

/// Elements that bear the step keep their masses, to the last bit, and so does a deck that asks for nothing.
#[test]
fn what_bears_the_step_keeps_its_mass() {
    let text = |scaled: Option<f64>| head(1e-4, 4e-7, scaled) + &bar(&lengths(6, 4)) + CLAMP + &struck(6, 1.0);
    let run = |scaled: Option<f64>| {
        let model = scene(&text(scaled), &[]);
        let at = node(&model, "p11");
        run_to_the_end(&model, &mut |frame| vec![frame.state.nodes[at].x.x, frame.state.nodes[at].a.x]).rows
    };
    assert!(run(None) == run(Some(0.999 * SLIVER / SPEED)));
    assert!(run(None) != run(Some(1.1 * SLIVER / SPEED)));
}

/// Damping in proportion to mass and stiffness shortens steps; masses are raised by what it takes with it.
#[test]
fn damping_is_counted() {
    let (lengths, step) = (lengths(6, 4), 3e-6);
    for (alpha, beta) in [(2e4, 0.0), (0.0, 1e-7), (2e4, 1e-7)] {
        let damping = format!("[damping]\nmass_factor = {alpha}\nstiffness_factor = {beta}\n");
        // Weight moves the bar gently: a blow at one node is motion in the fastest modes, which no step follows.
        let weight = "[environment]\ngravity = [9.81, 0.0, 0.0]\n";
        let text = head(1e-3, AUTO, Some(step)) + &bar(&lengths) + CLAMP + weight + &damping;
        let model = scene(&text, &[]);
        // ¼ κ Δt² + (α + β κ) Δt = 1 with κ = 4 c²/f L².
        let factor = (2.0 * SPEED / SLIVER).powi(2) * step * (0.25 * step + beta) / (1.0 - alpha * step);
        let told = &parts(&model)[0];
        assert!((told.factor / factor - 1.0).abs() < 1e-12, "{told:?} {factor}");
        let done = run_to_the_end(&model, &mut |frame| vec![frame.dt]);
        let first = done.rows[1][0];
        println!("{alpha} {beta}: factor {factor:.2}, first step {:.3} of it", first / step);
        // The sliver is bound by its neighbours besides, which are slower.
        assert!((0.8 * 0.99..1.2).contains(&(first / step)), "{first}");
    }
}

/// A deck of a thin beam on two hinges, 32 elements long, and of a thin plate on hinges all round.
fn thin(key: &str, time_step: &str, order: usize) -> [String; 2] {
    let head = dynamic(1e-3, time_step, "central-difference") + key + STEEL + "[output]\nevery = 1\n[points]\n";
    let beam = format!(
        "a = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n[sections.flat]\nshape = \"rectangle\"\nwidth = 0.01\nheight = 0.002\n[[beams]]\n\
         name = \"beam\"\npath = [\"a\", \"b\"]\nelements = {}\norder = {order}\nmaterial = \"steel\"\nsection = \"flat\"\n\
         orientation = [0.0, 1.0, 0.0]\n[[supports]]\nat = [\"a\", \"b\"]\nfix = [\"ux\", \"uy\", \"uz\", \"rx\", \"rz\"]\n",
        32 / order
    );
    let plate = format!(
        "a = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\nc = [1.0, 1.0, 0.0]\nd = [0.0, 1.0, 0.0]\n[[shells]]\nname = \"plate\"\n\
         corners = [\"a\", \"b\", \"c\", \"d\"]\nelements = {}\norder = {}\nthickness = 0.005\nmaterial = \"steel\"\n[[supports]]\n\
         at = [\"plate.edge1\", \"plate.edge2\", \"plate.edge3\", \"plate.edge4\"]\nfix = \"translations\"\n[[supports]]\nat = \"plate\"\n\
         fix = [\"ux\", \"uy\", \"rz\"]\n",
        16 / order.min(2),
        order.min(2)
    );
    [head.clone() + &beam, head + &plate]
}

/// Thickness does not set the step of thin beams and plates, and low modes keep their closed forms: n²π² √(EI/ρA)/L² of the beam, 2π² √(D/ρh)/L²
/// of the plate.
#[test]
fn thin_parts_take_steps_of_their_length_by_default() {
    for order in [1, 2] {
        for (which, gain) in [(0, 1.4), (1, 6.0)] {
            let model = |key: &str| scene(&thin(key, AUTO, order)[which], &["analysis.plane=off"]);
            let (own, raised) = (dense::highest(&squares(&model(OFF))), spectrum(&model("")));
            let told = &parts(&model(""))[0];
            assert_eq!((told.heavier, told.added, told.rotary), (0, 0.0, told.elements), "{told:?}");
            let longer = (own / raised.last().unwrap()).sqrt();
            let step = System::new(&model("")).unwrap().mass_scaling().unwrap().critical_step;
            let limit = 2.0 / raised.last().unwrap().sqrt();
            println!(
                "order {order}, {which}: the step is {longer:.1} times as long, {:.3} of what is told",
                limit / step
            );
            assert!(longer > gain, "{order} {which}: {longer}");
            // No mode of a scene is faster than that of an element alone.
            assert!(limit >= step && limit < 1.6 * step, "{limit} {step}");
            let radius = |h: f64| SPEED * h / 12f64.sqrt();
            let exact: Vec<f64> = match which {
                0 => (1..=3).map(|n| (n as f64 * PI).powi(2) * radius(0.002)).collect(),
                _ => vec![2.0 * PI * PI * radius(0.005)],
            };
            // Most is due to r² k²/2 with r² = h²/8, h the distance of nodes: 0.5 % of the third mode of the beam, 1 % of that of the plate.
            for (n, exact) in exact.iter().enumerate() {
                let found = raised[n].sqrt() / exact - 1.0;
                println!("  mode {}: {:+.3} %", n + 1, 100.0 * found);
                assert!(found.abs() < 0.012, "{order} {which} {n}: {found}");
            }
        }
    }
}
