//! `time_step = "auto"`: the error lands where it was asked for, at about the cost of the best step of one length.

use crate::support::{Done, error, node, read, run_to_the_end};
use rdsolve::diagnostic::Source;
use rdsolve::model::{self, Model};
use rdsolve::solve::Frame;

type Probe = dyn Fn(&Model, &Frame) -> Vec<f64>;

/// A scene with steps of one length, in 200 intervals.
struct Scene {
    deck: &'static str,
    end: f64,
    sets: &'static [&'static str],
    probe: Box<Probe>,
    /// Rows at the start that do not count.
    skip: usize,
}

impl Scene {
    fn run(&self, step: &str) -> Done {
        let mut sets: Vec<String> = self.sets.iter().map(|set| (*set).to_owned()).collect();
        let end = self.end;
        sets.extend([
            "expect=[]".to_owned(),
            format!("analysis.end_time={end:?}"),
            format!("output.interval={:?}", end / 200.0),
            step.to_owned(),
        ]);
        let model = read(self.deck, &sets);
        run_to_the_end(&model, &mut |frame| (self.probe)(&model, frame))
    }

    fn fixed(&self, division: usize) -> Done {
        self.run(&format!("analysis.time_step={:?}", self.end / 200.0 / division as f64))
    }

    fn automatic(&self, tolerance: f64) -> Done {
        self.run(&format!(
            "analysis={{kind=\"dynamic\",end_time={:?},time_step=\"auto\",error_tolerance={tolerance}}}",
            self.end
        ))
    }

    /// Asserts that errors are at most twice those asked for, and not smaller by more than the factor `below`; prints what they cost.
    fn check(&self, name: &str, reference: &[Vec<f64>], tolerances: &[f64], below: f64) -> Vec<(f64, usize)> {
        let of = |done: &Done| (error(&done.rows, reference, self.skip), done.counts.iterations);
        tolerances
            .iter()
            .map(|&tolerance| {
                let (e, iterations) = of(&self.automatic(tolerance));
                println!("{name} asked for {tolerance:e}: {e:.2e} in {iterations} iterations");
                assert!(
                    e < 2.0 * tolerance && below * e > tolerance,
                    "{name}: {e:e} where {tolerance:e} was asked for"
                );
                (e, iterations)
            })
            .collect()
    }

    /// Asserts that runs of automatic steps, (error, iterations), cost at most `most` times equal steps with the same error. Between two
    /// of these a straight line of the logarithms is followed.
    fn check_cost(
        &self,
        name: &str,
        reference: &[Vec<f64>],
        divisions: &[usize],
        (found, most): (&[(f64, usize)], f64),
    ) {
        let of = |&division: &usize| {
            let done = self.fixed(division);
            (error(&done.rows, reference, self.skip), done.counts.iterations)
        };
        let ladder: Vec<(f64, usize)> = divisions.iter().map(of).collect();
        println!("{name}, equal steps: {ladder:?}");
        for &(e, iterations) in found {
            let pair = ladder.windows(2).find(|pair| e >= pair[1].0).unwrap_or(&ladder[ladder.len() - 2..]);
            let ((e0, i0), (e1, i1)) = (pair[0], pair[1]);
            let part = (e0 / e).ln() / (e0 / e1).ln();
            let fixed = (i0 as f64).ln() + part * (i1 as f64 / i0 as f64).ln();
            let cost = iterations as f64 / fixed.exp();
            println!("{name}: {cost:.2} times the iterations of equal steps");
            assert!(cost < most, "{name}: {cost}");
        }
    }
}

fn displacement(of: &'static str, axis: usize) -> impl Fn(&Model, &Frame) -> f64 {
    move |model, frame| {
        let node = node(model, of);
        frame.state.nodes[node].x[axis] - model.nodes[node].x[axis]
    }
}

/// A beam at large rotations, kicked; the error is one of phase and grows all the time. The cost is that of equal steps with
/// the same error: between two fixed steps of second order it follows a straight line of the logarithms.
#[test]
fn right_angle_cantilever() {
    let [elbow, tip] = ["elbow", "tip"].map(|of| displacement(of, 2));
    let scene = Scene {
        deck: "right_angle_cantilever",
        end: 30.0,
        sets: &["beams.legs.order=3"],
        probe: Box::new(move |model, frame| vec![elbow(model, frame), tip(model, frame)]),
        skip: 0,
    };
    let reference = scene.fixed(32).rows;
    let found = scene.check("B1", &reference, &[1e-2, 1e-3], 5.0);
    scene.check_cost("B1", &reference, &[2, 4, 8], (&found, 1.5));
}

/// Steel that yields under a blow. The reference has 51,200 equal steps: errors of longer ones do not fall in
/// order, since the block leaves the knee a little earlier or later.
#[test]
fn portal_and_block() {
    let (knee, block) = (displacement("knee_left", 0), displacement("block", 0));
    let scene = Scene {
        deck: "portal_and_block",
        end: 0.3,
        sets: &["beams.portal.elements=4"],
        probe: Box::new(move |model, frame| vec![knee(model, frame), block(model, frame) - 0.5]),
        skip: 0,
    };
    let reference = scene.fixed(256).rows;
    let found = scene.check("C4", &reference, &[3e-3, 1e-3], 30.0);
    // Steps in which steel yields or the block touches are cut, so that the error told holds: 1.2 and 2.4.
    scene.check_cost("C4", &reference, &[2, 3, 4, 6, 8], (&found, 2.7));
}

/// Two masses on springs that do not know of each other, set going: one of period 1 and amplitude 1, one of period 1/20 and
/// amplitude `fast`.
fn pair(fast: f64, tolerance: f64) -> (f64, usize) {
    let omega = [1.0, 20.0].map(|frequency| std::f64::consts::TAU * frequency);
    let mass = |name: &str, i: usize, amplitude: f64| {
        let (k, v) = (omega[i] * omega[i], amplitude * omega[i]);
        format!(
            r#"
            [[masses]]
            at = "{name}"
            mass = 1.0
            [[links]]
            name = "spring of {name}"
            from = {{ ground = [0.0, {i}.0, 0.0] }}
            to = {{ node = "{name}" }}
            stiffness = {k}
            direction = [1.0, 0.0, 0.0]
            [[supports]]
            at = "{name}"
            fix = ["uy", "uz"]
            [[initial]]
            at = "{name}"
            velocity = [{v}, 0.0, 0.0]
            "#
        )
    };
    let deck = format!(
        r#"
        integrator = {{ scheme = "newmark" }}
        analysis = {{ kind = "dynamic", end_time = 20.0, time_step = "auto", error_tolerance = {tolerance} }}
        points = {{ slow = [1.0, 0.0, 0.0], fast = [1.0, 1.0, 0.0] }}
        {}{}"#,
        mass("slow", 0, 1.0),
        mass("fast", 1, fast)
    );
    let model = small(&deck);
    let nodes = ["slow", "fast"].map(|name| node(&model, name));
    let done = run_to_the_end(&model, &mut |frame| {
        let t = frame.state.time;
        let off = |i: usize, amplitude: f64| frame.state.nodes[nodes[i]].x.x - 1.0 - amplitude * (omega[i] * t).sin();
        vec![off(0, 1.0), off(1, fast)]
    });
    let of = |i: usize| (done.rows.iter().map(|row| row[i].powi(2)).sum::<f64>() / done.rows.len() as f64).sqrt();
    (of(0).max(of(1)), done.counts.iterations)
}

/// A vibration is never wrong by more than about its amplitude: one of half of what is asked for is not followed, though each of its
/// periods has ten steps and its phase is lost; one of five times that is followed until it errs by what is asked for.
#[test]
fn small_vibrations_are_not_followed() {
    let tolerance = 1e-2;
    let (alone, least) = pair(0.0, tolerance);
    let (with, iterations) = pair(0.5 * tolerance, tolerance);
    println!("alone {alone:.2e} in {least}, with a small vibration {with:.2e} in {iterations}");
    // Out of phase an oscillation is wrong by √2 times its root mean square at most: by its amplitude.
    assert!(alone < 2.0 * tolerance && with < 2.0 * tolerance, "{alone:e} {with:e}");
    // Followed, it would take ten times as many; steps after its start are short until it is known to go on like that, and what it adds to
    // the error may have the run made again.
    assert!(iterations <= 4 * least, "{iterations} for {least}");
    let (followed, more) = pair(5.0 * tolerance, tolerance);
    println!("with a larger one {followed:.2e} in {more}");
    // Left alone it would be wrong by its amplitude, five times the tolerance.
    assert!(followed < 3.0 * tolerance && more > 2 * least, "{followed:e} in {more}");
}

/// A top at 150 rad/s: α turns and hardly changes, and what errs is the rotation vector within a step. Errors of velocities last, and
/// those of places grow with them: the error of the run is known by a second one alone, and the run is made again.
#[test]
fn spinning_top() {
    let [x, y, z] = [0, 1, 2].map(|axis| displacement("top", axis));
    let scene = Scene {
        deck: "heavy_top/pivot",
        end: 2.0,
        sets: &[],
        probe: Box::new(move |model, frame| vec![x(model, frame), y(model, frame), z(model, frame)]),
        skip: 0,
    };
    // The samples ask for more steps than the error.
    scene.check("top", &scene.fixed(64).rows, &[1e-3, 1e-4], 1e4);
}

/// What no step resolves is left alone: a spring of 1e7 at rest beside one of 1. The fastest period is 2e-3, that of the motion
/// 5; the first ten samples hold the way from a start that does not fit.
#[test]
fn stiff_spring_chain() {
    for (scheme, sets) in [("wilson-theta", &[][..]), ("bathe", &["integrator={scheme=\"bathe\"}"][..])] {
        let [u2, u3] = ["m2", "m3"].map(|of| displacement(of, 0));
        let scene = Scene {
            deck: "extreme/stiff_spring_chain",
            end: 52.36,
            sets,
            probe: Box::new(move |model, frame| vec![u2(model, frame), u3(model, frame)]),
            skip: 10,
        };
        let reference = scene.fixed(64).rows;
        let found = scene.check(&format!("X1 {scheme}"), &reference, &[1e-2, 1e-3, 1e-4], 30.0);
        scene.check_cost("X1", &reference, &[2, 4, 8, 16, 32], (&found, 1.5));
        // Steps of the fastest period would be 26,000, of one iteration each at least, in two stages with Bathe's scheme.
        assert!(found[2].1 < 20_000, "{found:?}");
    }
}

fn small(deck: &str) -> Model {
    let source = Source::new("deck.toml", deck, &[]);
    let (model, problems) = model::read(&source);
    model.unwrap_or_else(|| panic!("{problems:?}"))
}

const HIT: &str = r#"
    [analysis]
    kind = "dynamic"
    end_time = 1.0
    time_step = "auto"
    [points]
    p = [0.0, 0.0, 0.0]
    [[masses]]
    at = "p"
    mass = 2.0
    [[loads]]
    at = "p"
    force = [0.0, 0.0, 1.0]
    amplitude = "hit"
    [amplitudes.hit]
    kind = "table"
    points = [[0.5, 0.0], [0.5005, 1000.0], [0.501, 0.0]]
"#;

/// A blow of a thousandth of the run, while all is at rest: it is not stepped over. Its impulse is 0.5 N s; the force is piecewise linear, for
/// which the impulse of the scheme's linear acceleration is exact.
#[test]
fn no_blow_is_missed() {
    let model = small(HIT);
    let p = node(&model, "p");
    let done = run_to_the_end(&model, &mut |frame| vec![frame.state.nodes[p].v.z]);
    let v = done.rows.last().expect("rows")[0];
    assert!((v - 0.25).abs() < 1e-2 * 0.25, "{v}");
}

/// Nothing moves: as few steps as there may be.
#[test]
fn rest_is_cheap() {
    let mut model = small(HIT);
    model.loading.nodal.clear();
    let done = run_to_the_end(&model, &mut |frame| vec![frame.state.nodes[0].x.z]);
    // Fifty, and sixteen times at which runs are compared.
    assert!(done.counts.steps <= 66 && done.rows.iter().all(|row| row[0] == 0.0), "{:?}", done.counts);
}

/// A boom on a cylinder, with a payload that hangs from it in equilibrium until the cylinder begins to move at t = 1.
const ARM: &str = r#"
    environment = { gravity = [0.0, 0.0, -9.81] }
    bodies = [
        { name = "boom", center = [1.25, 0.0, 1.0], shape = { kind = "box", size = [2.5, 0.12, 0.25], density = 1500.0 } },
        { name = "payload", center = [2.5, 0.0, -0.6], mass = 860.0, shape = { kind = "box", size = [0.8, 0.8, 0.8] } },
    ]
    actuators = [{ name = "cylinder", from = { ground = [0.4, 0.0, 0.1] }, to = { body = "boom", point = [1.2, 0.0, 0.9] }, motion = { position = 0.3, amplitude = "stroke" } }]
    [[joints]]
    name = "A"
    kind = "revolute"
    axis = [0.0, 1.0, 0.0]
    from = { ground = [0.0, 0.0, 1.0] }
    to = { body = "boom" }
    [[joints]]
    name = "B"
    kind = "revolute"
    axis = [0.0, 1.0, 0.0]
    from = { body = "boom", point = [2.5, 0.0, 1.0] }
    to = { body = "payload" }
    [amplitudes.stroke]
    kind = "table"
    interpolation = "monotone"
    points = [[0.0, 0.0], [1.0, 0.0], [2.0, 1.0]]
"#;

/// A mechanism rests until it is driven: rounding moves it by 1e-16 of its size meanwhile, and this is no motion that errors are relative to.
/// Afterwards it moves as with short steps of one length.
#[test]
fn a_mechanism_at_rest_is_no_motion() {
    let analysis = |end: f64, keys: &str| format!("analysis = {{ kind = \"dynamic\", end_time = {end:?}, {keys} }}\n");
    let run = |end: f64, keys: &str, scheme: &str| {
        let model = small(&format!(
            "{}integrator = {{ scheme = \"{scheme}\" }}\noutput = {{ interval = 0.1 }}\n{ARM}",
            analysis(end, keys)
        ));
        let nodes = ["boom", "payload"].map(|name| node(&model, name));
        run_to_the_end(&model, &mut |frame| {
            nodes
                .iter()
                .flat_map(|&node| [0, 2].map(|axis| frame.state.nodes[node].x[axis] - model.nodes[node].x[axis]))
                .collect()
        })
    };
    let reference = run(3.0, "time_step = 0.001", "esdirk3").rows;
    for scheme in ["generalized-alpha", "bathe", "esdirk3"] {
        let done = run(3.0, "time_step = \"auto\", error_tolerance = 1e-3", scheme);
        let e = error(&done.rows, &reference, 0);
        println!("{scheme}: {e:.2e} in {} steps", done.counts.steps);
        assert!(e < 2e-3, "{scheme}: {e:e}");
        // It rests to the end: the longest steps there are, and nothing is said about an error.
        let rest = run(1.0, "time_step = \"auto\", error_tolerance = 1e-3", scheme);
        assert!(rest.counts.steps <= 100, "{scheme}: {:?}", rest.counts);
        assert!(rest.step_error.and_then(|error| error.estimate) == Some(0.0), "{scheme}: {:?}", rest.step_error);
    }
}

/// A mass rests on a spring under its weight, to the last digits, and is pushed at t = 1: F/k (1 − cos ωt) from then on.
#[test]
fn a_body_at_rest_is_pushed() {
    let deck = r#"
        analysis = { kind = "dynamic", end_time = 3.0, time_step = "auto", error_tolerance = 1e-3 }
        environment = { gravity = [0.0, 0.0, -9.81] }
        points = { p = [0.3, 0.1, 0.7] }
        masses = [{ at = "p", mass = 3.0 }]
        supports = [{ at = "p", fix = ["ux", "uy"] }]
        links = [{ name = "s", from = { ground = [0.3, 0.1, 0.0] }, to = { node = "p" }, stiffness = 300.0, free_length = 0.7981 }]
        loads = [{ at = "p", force = [0.0, 0.0, 6.0], amplitude = "push" }]
        amplitudes.push = { kind = "step", start = 1.0 }
    "#;
    let model = small(deck);
    let p = node(&model, "p");
    let done = run_to_the_end(&model, &mut |frame| {
        let (u, t) = (frame.state.nodes[p].x.z - 0.7, frame.state.time);
        let exact = if t < 1.0 { 0.0 } else { 0.02 * (1.0 - (10.0 * (t - 1.0)).cos()) };
        vec![u - exact]
    });
    let worst = done.rows.iter().map(|row| row[0].abs()).fold(0.0, f64::max) / 0.04;
    println!("{worst:.2e} in {} steps", done.counts.steps);
    assert!(worst < 3e-3, "{worst:e}");
}

/// A load applied at once to one mass on a spring: 1 − cos ωt. Wilson-theta in long steps would overshoot that by far, which must not be
/// taken for the size of the motion. What errs is the phase, steadily.
#[test]
fn sudden_loads() {
    for (scheme, period) in [("wilson-theta", 1.0), ("wilson-theta", 0.1), ("newmark", 0.1), ("bathe", 0.05)] {
        let omega = std::f64::consts::TAU / period;
        let deck = format!(
            r#"
            integrator = {{ scheme = "{scheme}" }}
            analysis = {{ kind = "dynamic", end_time = 10.0, time_step = "auto", error_tolerance = 1e-3 }}
            points = {{ p = [1.0, 0.0, 0.0] }}
            masses = [{{ at = "p", mass = 1.0 }}]
            links = [{{ name = "s", from = {{ ground = [0.0, 0.0, 0.0] }}, to = {{ node = "p" }}, stiffness = {k}, direction = [1.0, 0.0, 0.0] }}]
            supports = [{{ at = "p", fix = ["uy", "uz"] }}]
            loads = [{{ at = "p", force = [{k}, 0.0, 0.0] }}]
            "#,
            k = omega * omega
        );
        let model = small(&deck);
        let p = node(&model, "p");
        let done = run_to_the_end(&model, &mut |frame| {
            let (u, t) = (frame.state.nodes[p].x.x - 1.0, frame.state.time);
            vec![u, 1.0 - (omega * t).cos()]
        });
        // Every step is seen; the mean is over steps of nearly one length.
        let sum: f64 = done.rows.iter().map(|row| (row[0] - row[1]).powi(2)).sum();
        let e = (sum / done.rows.len() as f64).sqrt() / 2.0;
        println!("{scheme}, period {period}: {e:.2e} in {} steps", done.counts.steps);
        assert!(e < 2e-3 && e > 3e-5, "{scheme}, period {period}: {e:e}");
    }
}

/// The scheme for automatic steps where the deck names none, on scenes of every kind: twice the error asked for is not passed, and the
/// run's own estimate is no less than a third of the truth.
#[test]
fn errors_are_those_asked_for() {
    type Columns = Box<dyn Fn(&Model) -> Vec<(usize, usize)>>;
    let of = |names: &'static [(&'static str, usize)]| -> Columns {
        Box::new(move |model| names.iter().map(|&(name, axis)| (node(model, name), axis)).collect())
    };
    let scenes: [(&str, f64, usize, Columns); 5] = [
        ("two_bodies_on_springs", 5.0, 400, of(&[("a", 0), ("a", 1), ("b", 0), ("b", 2)])),
        ("heavy_top/pivot", 2.0, 1000, of(&[("top", 0), ("top", 1), ("top", 2)])),
        ("right_angle_cantilever", 12.0, 128, of(&[("elbow", 2), ("tip", 2)])),
        ("block_on_cantilever", 1.0, 100, of(&[("block", 0), ("block", 2), ("tip", 2)])),
        // With 32 steps the reference would err by 8e-6, more than the run.
        ("extreme/stiff_spring_chain", 52.36, 128, of(&[("m2", 0), ("m3", 0)])),
    ];
    for (deck, end, finest, columns) in scenes {
        let run = |step: &str| {
            let sets = [
                "expect=[]".to_owned(),
                "integrator={scheme=\"esdirk3\"}".to_owned(),
                format!("output.interval={:?}", end / 20.0),
                format!("analysis={{kind=\"dynamic\",end_time={end:?},{step}}}"),
            ];
            let model = read(deck, &sets);
            let columns = columns(&model);
            run_to_the_end(&model, &mut |frame| {
                columns
                    .iter()
                    .map(|&(node, axis)| frame.state.nodes[node].x[axis] - model.nodes[node].x[axis])
                    .collect()
            })
        };
        let reference = run(&format!("time_step={:?}", end / 20.0 / finest as f64)).rows;
        for tolerance in [1e-2, 1e-3, 1e-4] {
            let done = run(&format!("time_step=\"auto\",error_tolerance={tolerance}"));
            let (e, estimate) = (error(&done.rows, &reference, 0), done.step_error.and_then(|error| error.estimate));
            println!(
                "{deck} asked for {tolerance:e}: {e:.2e}, estimated {estimate:?}, {} iterations",
                done.counts.iterations
            );
            assert!(e < 2.0 * tolerance, "{deck}: {e:e} where {tolerance:e} was asked for");
            assert!(estimate.is_some_and(|estimate| 3.0 * estimate > e), "{deck}: {estimate:?} for {e:e}");
        }
    }
}
