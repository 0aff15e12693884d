//! The extreme set: variants of the decks in decks/extreme, compared with each other as numbers. (`tests/decks/values.rs` holds the decks to
//! the values they carry.)

use crate::support::{self, node, read, run_to_the_end};
use rdsolve::diagnostic::Source;
use rdsolve::math::Vec3;
use rdsolve::model::{Cadence, Model};
use std::process::Command;
use std::time::{Duration, Instant};

fn owned(sets: &[&str]) -> Vec<String> {
    sets.iter().map(|set| (*set).to_owned()).collect()
}

/// A deck with entries overridden, and without the values it carries.
fn variant(deck: &str, sets: &[&str]) -> Model {
    read(deck, &[owned(sets), owned(&["expect=[]"])].concat())
}

/// Displacement, rotation and velocity of every node at every output time.
fn histories(model: &Model) -> Vec<Vec<f64>> {
    let probe = |frame: &rdsolve::solve::Frame| {
        let nodes = frame.state.nodes.iter().zip(&frame.model.nodes);
        let row = |(now, start): (&rdsolve::state::Node, &rdsolve::model::Node)| {
            let turn = rdsolve::math::rotation::log(&now.rotation);
            [now.moved(&start.x), turn, now.v].map(<[f64; 3]>::from).concat()
        };
        nodes.flat_map(row).collect()
    };
    run_to_the_end(model, &mut { probe }).rows
}

/// Largest difference over the largest entry of the first.
fn difference(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    assert_eq!((a.len(), a[0].len()), (b.len(), b[0].len()));
    let largest = a.iter().flatten().fold(0.0f64, |largest, x| largest.max(x.abs()));
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / largest
}

fn short(numbers: &[f64]) -> String {
    numbers.iter().map(|x| format!("{x:.2e}")).collect::<Vec<_>>().join(", ")
}

/// The table of `decks/extreme/stiff_spring_chain`: a2 in the first five steps, at its most and least in 200, and the last step in
/// which it is beyond 1.6.
#[test]
fn overshoot_of_every_scheme_on_the_stiff_chain() {
    let table: [(&str, [f64; 7], usize); 9] = [
        ("{scheme=\"wilson-theta\"}", [13.802, -19.619, 15.804, -15.509, 9.7732, 15.804, -19.619], 17),
        ("{scheme=\"newmark\"}", [18.034, -37.834, 54.274, -75.335, 90.961, 3138.1, -3148.2], 200),
        ("{scheme=\"newmark\",gamma=0.6}", [14.904, -25.848, 29.543, -34.86, 32.775, 32.775, -35.017], 37),
        ("{scheme=\"hht-alpha\"}", [17.219, -33.749, 43.904, -56.069, 60.553, 75.768, -75.641], 95),
        ("{scheme=\"hht-alpha\",alpha=-0.3}", [15.245, -24.443, 22.503, -21.311, 13.617, 22.503, -24.443], 15),
        ("{scheme=\"generalized-alpha\"}", [17.529, -35.021, 46.273, -58.912, 62.948, 68.88, -70.566], 46),
        (
            "{scheme=\"generalized-alpha\",spectral_radius=0.5}",
            [15.217, -24.314, 22.225, -20.903, 13.141, 22.225, -24.314],
            10,
        ),
        (
            "{scheme=\"generalized-alpha\",spectral_radius=0.0}",
            [9.0172, -5.3912, -1.2377, -1.4714, -1.5612, 9.0172, -5.3912],
            2,
        ),
        ("{scheme=\"bathe\"}", [-22.579, -0.70627, -1.049, -1.2876, -1.3993, 1.3993, -22.579], 1),
    ];
    for (scheme, expected, last) in table {
        let sets = [&format!("integrator={scheme}"), "iteration.tolerance=1e-12"];
        let model = variant("extreme/stiff_spring_chain", &sets);
        let m2 = node(&model, "m2");
        // By Newmark's method the stiff mode rings on with more energy than there was, and the run may fail at its end.
        let a: Vec<f64> = support::run(&model, &mut |frame| vec![frame.state.nodes[m2].a.x]).rows.concat();
        let (most, least) =
            (a[1..].iter().copied().fold(f64::MIN, f64::max), a.iter().copied().fold(f64::MAX, f64::min));
        let got = [a[1], a[2], a[3], a[4], a[5], most, least];
        println!("{scheme:52} {got:9.5?} {}", a.iter().rposition(|a| a.abs() > 1.6).unwrap_or(0));
        for (got, exact) in got.iter().zip(expected) {
            // Five digits are printed.
            assert!((got / exact - 1.0).abs() < 5e-5, "{scheme}: {got} for {exact}");
        }
        assert_eq!(a.iter().rposition(|a| a.abs() > 1.6), Some(last), "{scheme}");
    }
}

/// A part of a million times the stiffness against the rigid one: the difference falls with the stiffness, to what the step makes
/// of the rotation of a rigid body and of straight lines between nodes.
#[test]
fn stiff_is_rigid() {
    let of = |set: &str| {
        let model = variant("extreme/rigid_by_stiffness", &[set, "analysis.time_step=2.5e-4"]);
        let end = node(&model, "end");
        run_to_the_end(&model, &mut |frame| support::position(&frame.state.nodes[end]).to_vec()).rows
    };
    let rigid = of("beams.bar.rigid=true");
    let differences = [1.0, 1e-6, 1e-7].map(|factor| {
        let stiff = of(&format!("materials.stiff.youngs_modulus={:e}", 2.1e17 * factor));
        difference(&rigid, &stiff)
    });
    println!("bar of 2.1e17, 2.1e11, 2.1e10 Pa beside the rigid one: {}", short(&differences));
    let [stiff, steel, softer] = differences;
    // Both are off by the error of their step, the same but for where it is made; the rest is the bending under its own weight.
    assert!(stiff < 1e-6, "{stiff}");
    assert!(10.0 * stiff < steel && (3.0..30.0).contains(&(softer / steel)), "{differences:?}");
}

/// Scenes moved by 1.7e6 in an oblique direction, where coordinates have ten digits behind the point: the same displacements but for
/// what rounding does to the shape, 1e-10 of lengths near 1, times how much of a difference a difference of shape makes.
#[test]
fn far_from_the_origin_everything_is_the_same() {
    let scenes: [(&str, &[&str], f64); 7] = [
        ("extreme/far_from_origin", &["points={clamp=[0.0,0.0,0.0],tip=[1.0,0.0,0.0]}"], 1e-8),
        ("right_angle_cantilever", &["analysis.end_time=3.0"], 1e-7),
        ("block_on_cantilever", &["analysis.end_time=0.5"], 1e-7),
        ("two_bodies_on_springs", &["analysis.end_time=1.0"], 1e-7),
        ("heavy_top/pivot", &["analysis.end_time=0.1"], 1e-6),
        ("extreme/stiff_pendulum", &["analysis.end_time=4.0"], 1e-6),
        ("block_on_incline", &["analysis.end_time=1.0"], 1e-6),
    ];
    for (deck, sets, tolerance) in scenes {
        let near = variant(deck, sets);
        let mut far = near.clone();
        for node in &mut far.nodes {
            node.x += Vec3::new(1e6, -1e6, 1e6);
        }
        let off = difference(&histories(&near), &histories(&far));
        println!("{deck:30} {off:.1e}");
        assert!(off < tolerance, "{deck}: {off}");
    }
}

/// What flies a million lengths away keeps its digits on the way.
#[test]
fn a_long_flight_leaves_strains_alone() {
    let still = variant("flying_beam", &["analysis.end_time=2.5", "iteration.tolerance=1e-12"]);
    let mut flying = still.clone();
    for node in &mut flying.nodes {
        node.v += Vec3::new(4e5, -1e5, 0.0);
    }
    let shape = |model: &Model| {
        let rows = run_to_the_end(model, &mut |frame| {
            let first = &frame.state.nodes[0];
            frame.state.nodes.iter().flat_map(|node| <[f64; 3]>::from(node.relative_position(first))).collect()
        });
        rows.rows
    };
    let (still, flying) = (shape(&still), shape(&flying));
    let off = difference(&still, &flying);
    println!("after a million lengths: {off:.1e}");
    // Velocities of 4e5 have ten digits behind the point, and there are 200 steps.
    assert!(off < 1e-9, "{off}");
}

/// Zero loads: exactly nothing, one iteration a step, in motion and at rest.
#[test]
fn nothing_comes_of_nothing() {
    for kind in ["dynamic", "static"] {
        for scheme in ["wilson-theta", "newmark", "hht-alpha", "generalized-alpha", "bathe", "esdirk3"] {
            let (kind, scheme) = (format!("analysis.kind=\"{kind}\""), format!("integrator.scheme=\"{scheme}\""));
            let model = variant("extreme/zero_loads", &[&kind, &scheme]);
            let done = run_to_the_end(&model, &mut |frame| {
                let nodes = frame.state.nodes.iter().zip(&frame.model.nodes);
                let moved = |(now, start): (&rdsolve::state::Node, &rdsolve::model::Node)| {
                    [now.x - start.x, now.low, now.v, now.omega, now.a, now.alpha].map(|v| v.amax())
                };
                nodes.flat_map(moved).chain(frame.reactions.iter().copied()).collect()
            });
            assert!(done.rows.iter().flatten().all(|&x| x == 0.0), "{kind}, {scheme}");
            let stages = match (kind.contains("dynamic"), scheme.contains("bathe"), scheme.contains("esdirk3")) {
                (true, true, _) => 2,
                (true, _, true) => 4,
                _ => 1,
            };
            assert_eq!(done.counts.iterations, stages * done.counts.steps, "{kind}, {scheme}");
        }
    }
}

/// Steps from 1e-4 to 1e4 of the smallest period of `decks/extreme/time_steps`, with every scheme.
#[test]
fn any_time_step() {
    let period = 2.745_852_663_818_867_6;
    let schemes = [
        ("{scheme=\"wilson-theta\"}", 5.0, true),
        ("{scheme=\"newmark\"}", 2.0, false),
        ("{scheme=\"hht-alpha\",alpha=-0.3}", 4.0, true),
        ("{scheme=\"generalized-alpha\",spectral_radius=0.5}", 4.0, true),
        ("{scheme=\"bathe\"}", 1.0, true),
        ("{scheme=\"esdirk3\"}", 1.0, true),
    ];
    println!(
        "{:52} error of 1.25 after one period, steps of 1e-4, 1e-3, 1e-2 of it; after 100 of 10, 100, 1e4; peak",
        "scheme"
    );
    for (scheme, constant, damps) in schemes {
        let of = |part: f64, steps: usize| {
            let sets = [
                format!("integrator={scheme}"),
                format!("analysis.time_step={:e}", part * period),
                format!("analysis.end_time={:e}", part * period * steps as f64),
                "iteration.tolerance=1e-12".to_owned(),
                "expect=[]".to_owned(),
            ];
            let mut model = read("extreme/time_steps", &sets);
            if part < 0.1 {
                model.output.cadence = Cadence::Steps(steps);
            }
            let ends = ["first", "second"].map(|name| node(&model, name));
            let done = run_to_the_end(&model, &mut |frame| {
                ends.map(|end| frame.state.nodes[end].moved(&frame.model.nodes[end].x).x).to_vec()
            });
            assert_eq!(done.counts.cuts, 0, "{scheme} at {part}");
            done.rows
        };
        let errors = [(1e-4, 10_000), (1e-3, 1000), (1e-2, 100)].map(|(part, steps)| {
            let row = of(part, steps).pop().expect("the last row");
            let exact = two_masses(period);
            (row[0] - exact[0]).abs().max((row[1] - exact[1]).abs())
        });
        let (mut far, mut peak) = ([0.0f64; 3], [0.0f64; 3]);
        for ((far, peak), part) in far.iter_mut().zip(&mut peak).zip([1e1, 1e2, 1e4]) {
            let rows = of(part, 100);
            *peak = rows.iter().map(|row| row[1].abs()).fold(0.0, f64::max);
            let row = rows.last().expect("a row");
            *far = (row[0] - 0.25).abs().max((row[1] - 1.25).abs());
        }
        println!("{scheme:52} {}; {}; {}", short(&errors), short(&far), short(&peak));
        for (error, part) in errors.iter().zip([1e-4f64, 1e-3, 1e-2]) {
            // Second order, with the constant of the scheme (a period late by as many parts of (2π Δt/T)²); rounding is 1e-12.
            assert!(*error < constant * 3.0 * part.powi(2) + 1e-11, "{scheme} at {part}: {error}");
        }
        for (peak, part) in peak.iter().zip([1e1, 1e2, 1e4]) {
            // Wilson-theta takes the first acceleration over a step that it means nothing for; the others swing about their rest at
            // the most, at 1.25.
            let wilson = scheme.contains("wilson");
            let allowed = if wilson { 1.0 * part * part..1.2 * part * part } else { 1.24..2.5 * (1.0 + 1e-12) };
            assert!(allowed.contains(peak), "{scheme} at {part}: {peak}");
        }
        if damps {
            // The slowest to damp leaves 0.78 a step, and began with 1e8.
            assert!(far.iter().all(|far| *far < 1e-2), "{scheme}: {far:?}");
        }
    }
}

/// Displacements of both masses at a time: the modes of K φ = ω² φ, started at −u_static.
fn two_masses(t: f64) -> [f64; 2] {
    let rest = [0.25, 1.25];
    let mut u = rest;
    for root in [-1.0, 1.0] {
        let square: f64 = 3.0 + root * 5.0f64.sqrt();
        let shape = [1.0, 5.0 - square];
        let share = (shape[0] * rest[0] + shape[1] * rest[1]) / (1.0 + shape[1] * shape[1]);
        for i in 0..2 {
            u[i] -= share * shape[i] * (square.sqrt() * t).cos();
        }
    }
    u
}

/// Rows of nodes.csv and bodies.csv that two sizes of a scene should share.
#[test]
fn a_scene_in_micrometres_is_that_in_kilometres() {
    let rows = |deck: &str, size: f64| -> Vec<Vec<f64>> {
        let mut rows = histories(&variant(deck, &[]));
        for row in &mut rows {
            for node in row.chunks_exact_mut(9) {
                node[..3].iter_mut().for_each(|u| *u /= size);
            }
        }
        rows
    };
    let off = difference(&rows("extreme/in_micrometres", 1e-4), &rows("extreme/in_kilometres", 1e5));
    println!("micrometres and kilometres differ by {off:.1e}");
    // Numbers of the decks are rounded: 1e-16, times 1e3 over an impact and 200 steps of material that yields.
    assert!(off < 1e-9, "{off}");
}

/// All numbers of a deck for a scene so many times as large, of the same materials.
fn enlarge(key: &str, value: &mut toml::Value, size: f64) {
    let factor = match key {
        "end_time" | "time_step" | "interval" => size,
        "width" | "height" | "thickness" | "radius" | "center" | "point" | "stiffness" => size,
        // Only points have names in this deck that hold numbers.
        "clamp" | "tip" | "edge_1" | "edge_2" => size,
        "rate" => 1.0 / size,
        "force" => size.powi(2),
        "mass" => size.powi(3),
        "inertia" => size.powi(5),
        _ => 1.0,
    };
    match value {
        toml::Value::Float(number) => *number *= factor,
        toml::Value::Array(list) => list.iter_mut().for_each(|entry| enlarge(key, entry, size)),
        toml::Value::Table(table) => table.iter_mut().for_each(|(key, value)| enlarge(key, value, size)),
        _ => {}
    }
}

/// Powers of two round nothing, so what differs has been decided by a size. In smaller scenes nothing is; in larger ones no more
/// than the last digits of the first steps.
#[test]
fn scenes_of_a_power_of_two_are_one() {
    let text = std::fs::read_to_string("decks/extreme/in_micrometres/deck.toml").unwrap();
    let rows = |size: f64| -> Vec<Vec<f64>> {
        let mut deck: toml::Table = toml::from_str(&text).unwrap();
        deck.iter_mut().for_each(|(key, value)| enlarge(key, value, size));
        let source = Source::new("deck.toml", deck.to_string(), &owned(&["expect=[]"]));
        let (model, problems) = rdsolve::model::read(&source);
        let mut rows = histories(&model.unwrap_or_else(|| panic!("{problems:?}")));
        for node in rows.iter_mut().flat_map(|row| row.chunks_exact_mut(9)) {
            node[..3].iter_mut().for_each(|u| *u /= size);
        }
        rows
    };
    let as_it_is = rows(1.0);
    for power in [-29, -11, 8] {
        let scaled = rows(2f64.powi(power));
        let largest = |k: usize| as_it_is.iter().map(|row| row[k].abs()).fold(0.0, f64::max);
        let off = scaled.iter().zip(&as_it_is).flat_map(|(a, b)| a.iter().zip(b).enumerate());
        let off = off.map(|(k, (a, b))| (a - b).abs() / largest(k).max(f64::MIN_POSITIVE)).fold(0.0, f64::max);
        println!("2^{power}: {off:e}");
        assert!(rows(2f64.powi(power)) == as_it_is, "2^{power}: {off:e}");
    }
    for power in [9, 13, 30, 40] {
        let off = difference(&rows(2f64.powi(power)), &as_it_is);
        println!("2^{power}: {off:.1e}");
        // 1e-16, times what an impact and 200 steps of material that yields make of it; 1.3e-11 was measured.
        assert!(off < 1e-9, "2^{power}: {off}");
    }
}

/// Perzyna between its limits: exponents from 1 to 50, rates from 1e-300 to 1e300; never a NaN, never beyond the limits, and what
/// flows more easily has flowed more.
#[test]
fn viscosity_lies_between_elasticity_and_plasticity() {
    let plastic = 8.663366336633664e-3;
    for law in ["linear", "exponential", "power"] {
        let exponents: &[f64] = if law == "power" { &[1.0, 2.0, 5.0, 10.0, 20.0, 50.0] } else { &[1.0] };
        for exponent in exponents {
            let mut last = 0.0;
            for rate in [1e-300, 1e-100, 1e-30, 1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e9, 1e30, 1e100, 1e300] {
                let exponent = if law == "power" { format!(",exponent={exponent:?}") } else { String::new() };
                let set = format!("materials.fast_linear.viscosity={{law=\"{law}\",rate={rate:e}{exponent}}}");
                let model = read("extreme/viscosity_limits", std::slice::from_ref(&set));
                let done = run_to_the_end(&model, &mut |_| Vec::new());
                let verdict = done.verdicts.iter().find(|verdict| verdict.label.contains(" fast_linear "));
                let flowed = verdict.and_then(|verdict| verdict.value).expect("the plastic strain of the bar");
                assert!(
                    flowed >= last * (1.0 - 1e-10) && flowed <= plastic * (1.0 + 1e-9),
                    "{set}: {flowed:e} after {last:e}"
                );
                last = flowed;
            }
            assert!(last > plastic * (1.0 - 3e-3), "{law} {exponent}: {last:e}");
        }
    }
}

/// The linear law without hardening against its solution σ₀ [1 + ε̇/γ (1 − exp(−E γ (t − t_y)/σ0))], for steps from 1e-8 to 1e8
/// of the time of relaxation σ₀/Eγ.
#[test]
fn steps_of_any_length_beside_the_time_of_relaxation() {
    let (E, yield_stress, strain_rate, area) = (2e11, 2.5e8, 0.01, 1e-4);
    for k in -8..=8 {
        // Steps are 0.05.
        let ratio = 10f64.powi(k);
        let rate = ratio / 0.05 * yield_stress / E;
        let sets = [
            format!("materials.fast_linear.viscosity={{law=\"linear\",rate={rate:e}}}"),
            "materials.fast_linear.hardening_modulus=0.0".to_owned(),
            "output.reactions=true".to_owned(),
        ];
        let mut model = read("extreme/viscosity_limits", &sets);
        model.expects.clear();
        let end = node(&model, "end_fast_linear");
        let done = run_to_the_end(&model, &mut |frame| {
            let held = frame.model.constraints.restraints.iter().position(|held| held.node == end && held.dof == 0);
            vec![held.map_or(0.0, |i| frame.reactions[i])]
        });
        let over = done.rows.last().expect("a row")[0] / (area * yield_stress) - 1.0;
        let since = 1.0 - yield_stress / (E * strain_rate);
        let exact = strain_rate / rate * (1.0 - (-E * rate * since / yield_stress).exp());
        println!("steps of 1e{k} of the time of relaxation: overstress {over:.6e}, exact {exact:.6e}");
        // First order in the step while it is short, and the steady state where it is long. The return to the yield surface ends
        // within 1e-10 of the yield stress.
        assert!((over - exact).abs() < ratio.min(1.0 / ratio) * exact + 1e-10, "{k}: {over:e} for {exact:e}");
    }
}

/// Patch tests with slivers and with quadrilaterals of one corner of nearly 180 degrees: constant strain is exact, up to the digits
/// that rounding of displacements leaves at a condition of the square of the aspect.
#[test]
fn slivers_pass_the_patch_test() {
    let worst = |sets: &[String], strained: &[&str]| {
        let mut model = read("extreme/slivers", sets);
        model.expects.clear();
        let nodes: Vec<usize> = strained.iter().map(|name| node(&model, name)).collect();
        let done = run_to_the_end(&model, &mut |frame| {
            let off = |&i: &usize| {
                let start = frame.model.nodes[i].x;
                let (x, y) = (start.x, start.y);
                let u = frame.state.nodes[i].moved(&start);
                let field = frame.state.time * 1e-3 * Vec3::new(x + 0.5 * y, y + 0.5 * x, 0.0);
                (u - field).amax() / 1e-3
            };
            vec![nodes.iter().map(off).fold(0.0, f64::max)]
        });
        done.rows.last().expect("a row")[0]
    };
    for (aspect, allowed) in [(1e1, 1e-11), (1e2, 1e-11), (1e3, 1e-10), (1e4, 1e-9), (1e5, 1e-8), (1e6, 1e-7)] {
        let sets = [format!("points.s_s=[0.5, {:?}, 0.0]", 0.5 + 0.4 / aspect)];
        let off = worst(&sets, &["s_p", "s_q", "s_s"]);
        println!("aspect {aspect:e}: {off:.1e}");
        assert!(off < allowed, "aspect {aspect}: {off:e}");
    }
    for angle in [170.0, 179.0, 179.9, 179.99, 179.9999, 179.99999] {
        let depth = 0.25 * ((180.0f64 - angle) / 2.0).to_radians().tan();
        let off = worst(&[format!("points.q_m=[2.5, {:?}, 0.0]", 0.5 - depth)], &["q_l", "q_m", "q_r", "q_t"]);
        println!("angle {angle}: {off:.1e}");
        assert!(off < 1e-11, "angle {angle}: {off:e}");
    }
    // From 180 degrees on there is no such element.
    for (y, words) in [("0.5", "has no area near one of its corners"), ("0.5001", "folds back on itself")] {
        let warnings = support::warnings("extreme/slivers", &[format!("points.q_m=[2.5, {y}, 0.0]")]);
        assert!(warnings.contains(&format!("shell `q_0` {words}")), "{warnings:?}");
    }
}

/// The axis of the needle has a hundredth of its angular momentum. Errors of the rotation fall with the square of the step, down to what 10,000
/// and more steps add up of the iteration's tolerance of 1e-12.
#[test]
fn a_needle_spins() {
    let exact = [0.8827444972254422, 0.04418573450609401, -0.02335675531724422, 0.46718758059842375];
    for scheme in ["wilson-theta", "newmark", "hht-alpha", "generalized-alpha", "bathe", "esdirk3"] {
        let errors = [1e-4, 5e-5, 2.5e-5].map(|dt| {
            let sets = [format!("integrator.scheme=\"{scheme}\""), format!("analysis.time_step={dt:e}")];
            let mut model = read("extreme/needle", &sets);
            model.expects.clear();
            let needle = node(&model, "needle");
            let rows = run_to_the_end(&model, &mut |frame| {
                let q = frame.state.nodes[needle].rotation;
                vec![q.w, q.i, q.j, q.k]
            });
            let last = rows.rows.last().expect("a row").clone();
            let sign = last[0].signum();
            last.iter().zip(exact).map(|(q, exact)| (sign * q - exact).abs()).fold(0.0, f64::max)
        });
        println!("{scheme:20} {}", short(&errors));
        let falls = |from: f64, to: f64| to < (0.3 * from).max(1e-8);
        assert!(falls(errors[0], errors[1]) && falls(errors[1], errors[2]), "{scheme}: {errors:?}");
    }
}

/// Loads a million times what a scene is made for: exit code 4, names, whole files of numbers, and soon.
#[test]
fn overloads_end_soon_and_say_where() {
    let force = |at: &str, f: &str| format!("loads=[{{at=\"{at}\",force=[{f}]}}]");
    let scenes: [(&str, Vec<String>, &str); 5] = [
        ("extreme/overloaded", vec![], "strip["),
        ("extreme/overloaded_in_motion", vec![], "beam["),
        ("clamped_beam_step_load", vec![force("middle", "0.0,0.0,320e6")], "["),
        ("block_on_cantilever", vec!["environment.gravity=[0.0,0.0,-9.81e6]".to_owned()], "beam["),
        (
            "pinched_hemisphere",
            vec![force("pushed", "-2e8,0.0,0.0"), "shells.cap.elements=[4,4]".to_owned(), "expect=[]".to_owned()],
            "cap[",
        ),
    ];
    for (deck, sets, name) in &scenes {
        let dir = tempfile::tempdir().expect("a folder");
        let out = dir.path().join("out");
        let mut command = Command::new(env!("CARGO_BIN_EXE_rdsolve"));
        command.arg(support::decks().join(deck).join("deck.toml")).args(["--quiet", "--threads", "1", "-o"]).arg(&out);
        sets.iter().for_each(|set| _ = command.args(["--set", set]));
        let began = Instant::now();
        let ended = command.output().expect("the program");
        let said = String::from_utf8(ended.stderr).expect("text");
        println!("{deck:30} {:.2} s: {}", began.elapsed().as_secs_f64(), said.lines().next().unwrap_or_default());
        assert_eq!(ended.status.code(), Some(4), "{deck}: {said}");
        assert!(said.contains("error: at t = ") && said.contains(name), "{deck}: {said}");
        // Seconds, on a machine that does other things as well.
        assert!(began.elapsed() < Duration::from_secs(20), "{deck}");
        let mut rows = csv::Reader::from_path(out.join("nodes.csv")).expect("a table");
        let mut numbers = rows.records().flat_map(|row| {
            let row = row.expect("a row");
            row.iter().skip(3).map(|field| field.parse::<f64>().expect("a number")).collect::<Vec<_>>()
        });
        assert!(numbers.all(f64::is_finite), "{deck}");
    }
}
