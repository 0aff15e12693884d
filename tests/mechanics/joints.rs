//! Joints: their equations against differences, what they hold and what they leave free, against elimination, and over time.

use crate::support::{self, error, node, position, read, reference, run_to_the_end, slope};
use rdsolve::constraints::joint::{ConstraintEquation, rotations};
use rdsolve::diagnostic::Source;
use rdsolve::linear::Factorization;
use rdsolve::math::{Mat3, Vec3, Vec6, rotation};
use rdsolve::model::{self, Model};
use rdsolve::plan::Plan;
use rdsolve::solve::{Failure, Frame, Outcome};
use rdsolve::state::Node;
use rdsolve::system::System;
use rdsolve::system::energy::Energy;
use std::cell::RefCell;

/// Numbers from −1 to 1 that are the same in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> Vec3 {
        Vec3::from_fn(|_, _| self.next())
    }

    fn node(&mut self) -> Node {
        let q = rotation::exp(&(3.0 * self.vector()));
        Node {
            rotation: q,
            v: self.vector(),
            omega: self.vector(),
            a: self.vector(),
            alpha: self.vector(),
            ..Node::at_rest(self.vector())
        }
    }
}

fn one_of_each() -> Vec<ConstraintEquation> {
    let axes = Mat3::from_columns(&[Vec3::new(0.6, 0.8, 0.0), Vec3::new(-0.8, 0.6, 0.0), Vec3::z()]);
    let mut rows = vec![
        ConstraintEquation::GlobalAxis { axis: 1, at: 0.2 },
        ConstraintEquation::BodyAxis { e: Vec3::new(0.36, 0.48, 0.8), at: -0.1 },
        ConstraintEquation::Distance { length: 0.7 },
    ];
    rows.extend(rotations([false, true, true], &axes));
    rows.extend(rotations([true, false, false], &axes));
    rows
}

/// A node moved by a small displacement and spin.
fn moved(node: &Node, by: &Vec6) -> Node {
    let (u, theta) = (by.fixed_rows::<3>(0).into_owned(), by.fixed_rows::<3>(3).into_owned());
    Node { x: node.x + u, rotation: rotation::exp(&theta) * node.rotation, ..*node }
}

#[test]
fn gradients_and_stiffnesses_are_those_of_differences() {
    let mut random = Random(3);
    // Central differences of numbers near 1 with h = 1e-5: truncation h² and rounding 1e-16/h, 1e-10 and 1e-11.
    let (h, tolerance) = (1e-5, 2e-9);
    for row in one_of_each() {
        for _ in 0..20 {
            let nodes = [random.node(), random.node()];
            let lambda = random.next();
            let G = row.gradient(&nodes[0], &nodes[1]);
            let mut K = [[0.0; 12]; 12];
            row.stiffness(&nodes[0], &nodes[1], lambda, |i, j, block| {
                for r in 0..3 {
                    for c in 0..3 {
                        K[3 * i + r][3 * j + c] += block[(r, c)];
                    }
                }
            });
            for j in 0..12 {
                let at = |sign: f64| {
                    let mut by = Vec6::zeros();
                    by[j % 6] = sign * h;
                    let mut now = nodes;
                    now[j / 6] = moved(&nodes[j / 6], &by);
                    now
                };
                let [[a1, b1], [a0, b0]] = [at(1.0), at(-1.0)];
                let slope = (row.gap(&a1, &b1)[0] - row.gap(&a0, &b0)[0]) / (2.0 * h);
                assert!((slope - G[j / 6][j % 6]).abs() < tolerance, "{row:?}: gradient {j}");
                let [G1, G0] = [row.gradient(&a1, &b1), row.gradient(&a0, &b0)];
                for i in 0..12 {
                    let exact = lambda * (G1[i / 6][i % 6] - G0[i / 6][i % 6]) / (2.0 * h);
                    assert!((K[i][j] - exact).abs() < tolerance, "{row:?}: stiffness {i}, {j}: {} {exact}", K[i][j]);
                }
            }
        }
    }
}

#[test]
fn rates_of_gaps_are_those_of_differences() {
    let mut random = Random(5);
    let (h, tolerance) = (1e-4, 1e-6); // second differences: h² of third derivatives near 10, rounding 1e-16/h² = 1e-8
    for row in one_of_each() {
        for _ in 0..20 {
            let nodes = [random.node(), random.node()];
            let at = |t: f64| {
                let [a, b] = nodes.map(|n| {
                    // Constant accelerations: a rotation vector ω t + α t²/2 has those rates at t = 0.
                    let theta = n.omega * t + n.alpha * (0.5 * t * t);
                    let x = n.x + n.v * t + n.a * (0.5 * t * t);
                    Node { x, rotation: rotation::exp(&theta) * n.rotation, ..n }
                });
                row.gap(&a, &b)[0]
            };
            let [_, rate, second] = row.gap(&nodes[0], &nodes[1]);
            let (before, now, after) = (at(-h), at(0.0), at(h));
            assert!(((after - before) / (2.0 * h) - rate).abs() < tolerance, "{row:?}");
            assert!(((after - 2.0 * now + before) / (h * h) - second).abs() < 20.0 * tolerance, "{row:?}");
        }
    }
}

fn from_text(text: &str) -> Model {
    let source = Source::new("deck.toml", text, &[]);
    let (model, problems) = model::read(&source);
    model
        .unwrap_or_else(|| panic!("{}", problems.iter().map(|p| p.draw(&source, false)).collect::<Vec<_>>().join("\n")))
}

/// A run that watches the gaps of all joints, in positions, velocities and accelerations.
struct Watched {
    rows: Vec<Vec<f64>>,
    gaps: [f64; 3],
    energies: Vec<Energy>,
}

fn watch(model: &Model, probe: impl Fn(&Frame) -> Vec<f64>) -> Watched {
    let system = System::new(model).expect("a system");
    let mut buffer = vec![0.0; system.multipliers()];
    let state = RefCell::new(([0.0f64; 3], Vec::new()));
    let done = run_to_the_end(model, &mut |frame| {
        let (gaps, energies) = &mut *state.borrow_mut();
        for (derivative, gap) in gaps.iter_mut().enumerate() {
            system.gaps(&frame.state.nodes, derivative, &mut buffer);
            *gap = gap.max(system.largest_gap(&buffer, 1.0));
        }
        energies.extend(frame.derived.energy);
        probe(frame)
    });
    let (gaps, energies) = state.into_inner();
    Watched { rows: done.rows, gaps, energies }
}

/// Two bodies that fly freely, joined at (0.5, 0.1, 0), and spin.
fn pair(joint: &str) -> String {
    format!(
        r#"
[analysis]
kind = "dynamic"
end_time = 2.0
time_step = 0.002

[iteration]
tolerance = 1e-12

[[bodies]]
name = "a"
center = [0.0, 0.0, 0.0]
mass = 2.0
inertia = [0.2, 0.3, 0.4]
velocity = [0.3, 0.0, 0.1]
angular_velocity = [0.5, -1.0, 2.0]

[[bodies]]
name = "b"
center = [1.0, 0.2, 0.1]
mass = 1.0
inertia = [0.05, 0.1, 0.12]
angular_velocity = [1.0, 0.5, -1.5]

[[joints]]
name = "joint"
{joint}
"#
    )
}

const MEET: &str = "from = { body = \"a\", point = [0.5, 0.1, 0.0] }\nto = { body = \"b\" }\n";

#[test]
fn each_kind_holds_what_it_says_and_leaves_the_rest() {
    let kinds = [
        ("ball", "", MEET, 3),
        ("hinge", "axis = [0.6, 0.0, 0.8]", MEET, 5),
        ("slider", "axis = [0.6, 0.0, 0.8]", MEET, 5),
        ("cylinder", "axis = [0.6, 0.0, 0.8]", MEET, 4),
        ("universal", "axis = [0.6, 0.0, 0.8]\ncross_axis = [0.0, 1.0, 0.0]", MEET, 4),
        ("screw", "axis = [0.6, 0.0, 0.8]\nlead = 0.2", MEET, 5),
        ("planar", "axis = [0.6, 0.0, 0.8]", MEET, 3),
        ("in-line", "axis = [0.6, 0.0, 0.8]", MEET, 2),
        ("in-plane", "axis = [0.6, 0.0, 0.8]", MEET, 1),
        ("fixed", "", MEET, 6),
        ("distance", "", "from = { body = \"a\" }\nto = { body = \"b\" }\n", 1),
    ];
    for (kind, axes, ends, rows) in kinds {
        let model = from_text(&pair(&format!("kind = \"{kind}\"\n{axes}\n{ends}")));
        let [a, b] = ["a", "b"].map(|name| node(&model, name));
        let ends = model.constraints.joints[0].ends;
        let seen = watch(&model, |frame| {
            let n = &frame.state.nodes;
            // Relative motion as the first body sees it: of the joint's ends, and of the frames.
            let d = n[ends[1]].R().tr_mul(&(n[ends[0]].x - n[ends[1]].x));
            let R = n[b].R().tr_mul(&n[a].R());
            let turn = rotation::log(&(n[b].rotation.conjugate() * n[a].rotation));
            [d.x, d.y, d.z, turn.x, turn.y, turn.z, R.trace()].to_vec()
        });
        assert_eq!(model.constraints.joints[0].equations.len(), rows, "{kind}");
        // Gaps at rounding of lengths near 1; of rates what a step makes a gap of that size of.
        assert!(seen.gaps[0] < 1e-14, "{kind}: {:?}", seen.gaps);
        assert!(seen.gaps[1] < 1e-14 / 0.002 && seen.gaps[2] < 1e-14 / 0.002_f64.powi(2), "{kind}: {:?}", seen.gaps);
        // Inner forces keep the momentum: p exactly, L and the energy with the order of the scheme.
        let (first, last) = (&seen.energies[0], seen.energies.last().expect("a row"));
        assert!((last.p - first.p).norm() < 1e-12 * first.p.norm(), "{kind}: p");
        let spin = (last.l - first.l).norm() / first.l.norm();
        let energy = (last.mechanical / first.mechanical - 1.0).abs();
        println!(
            "{kind:10} gaps {:.1e} {:.1e} {:.1e}  L {spin:.1e}  energy {energy:.1e}",
            seen.gaps[0], seen.gaps[1], seen.gaps[2]
        );
        assert!(spin < 1e-4 && energy < 1e-4, "{kind}: L {spin}, energy {energy}"); // (ω dt)² over 1000 steps
        // What is free has moved.
        let end = seen.rows.last().expect("a row");
        let slid = Vec3::new(end[0], end[1], end[2]).norm();
        let turned = Vec3::new(end[3], end[4], end[5]).norm();
        let (slides, turns) = match kind {
            "slider" => (true, false),
            "cylinder" | "screw" | "planar" | "in-line" | "in-plane" => (true, true),
            "fixed" => (false, false),
            "distance" => (true, true),
            _ => (false, true),
        };
        assert_eq!(slid > 1e-3, slides, "{kind}: {slid}");
        assert_eq!(turned > 1e-3, turns, "{kind}: {turned}");
        let axis = Vec3::new(0.6, 0.0, 0.8);
        let (slid, turned) = (Vec3::new(end[0], end[1], end[2]), Vec3::new(end[3], end[4], end[5]));
        let held = match kind {
            "planar" => slid.dot(&axis).abs().max(turned.cross(&axis).norm()),
            "in-line" => slid.cross(&axis).norm(),
            "in-plane" => slid.dot(&axis).abs(),
            _ => 0.0,
        };
        assert!(held < 1e-12, "{kind}: {held}"); // rounding of lengths and angles near 1
    }
}

#[test]
fn the_heavy_top_on_its_pivot_is_of_second_order() {
    let exact = reference("heavy_top/pivot");
    let mut points = Vec::new();
    for dt in [1e-3, 5e-4, 2.5e-4, 1.25e-4] {
        let sets =
            [format!("analysis.time_step={dt}"), "output.interval=0.01".into(), "iteration.tolerance=1e-11".into()];
        let mut model = read("heavy_top/pivot", &sets);
        model.expects.clear();
        let top = node(&model, "top");
        let seen = watch(&model, |frame| position(&frame.state.nodes[top]).to_vec());
        let error = error(&seen.rows, &exact, 0);
        println!("dt {dt:e}: error {error:.2e}, gaps {:?}", seen.gaps);
        assert!(seen.gaps[0] < 1e-13, "{:?}", seen.gaps);
        points.push((dt, error));
    }
    let order = slope(&points);
    println!("slope {order:.2}");
    assert!((1.9..2.7).contains(&order), "order {order}"); // the first rungs fall faster: 0.15 rad a step
}

/// Five bodies on balls, hanging from the ground and thrown aside.
fn chain(dt: f64) -> Model {
    let mut text = format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = 1.0\ntime_step = {dt}\n[iteration]\ntolerance = 1e-12\n\
         [environment]\ngravity = [0.0, 0.0, -9.81]\n[output]\ninterval = 0.1\n"
    );
    for i in 0..5 {
        let x = f64::from(i);
        text += &format!(
            "[[bodies]]\nname = \"b{i}\"\ncenter = [{}, 0.0, 0.0]\nmass = 1.0\ninertia = [0.02, 0.09, 0.1]\n\
             angular_velocity = [0.0, {}, 0.0]\nvelocity = [0.0, 0.0, {}]\n",
            x + 0.5,
            if i == 0 { 1.0 } else { 0.0 },
            // One turns about the ground, the others go along.
            if i == 0 { -0.5 } else { -1.0 },
        );
        let to = if i == 0 { "{ ground = [0.0, 0.0, 0.0] }".into() } else { format!("{{ body = \"b{}\" }}", i - 1) };
        text += &format!(
            "[[joints]]\nname = \"j{i}\"\nkind = \"ball\"\nfrom = {{ body = \"b{i}\", point = [{x}, 0.0, 0.0] }}\nto = {to}\n"
        );
    }
    from_text(&text)
}

#[test]
fn a_chain_of_balls_is_of_second_order() {
    let run = |dt: f64| {
        let model = chain(dt);
        let bodies: Vec<usize> = (0..5).map(|i| node(&model, &format!("b{i}"))).collect();
        let seen = watch(&model, |frame| bodies.iter().flat_map(|&b| position(&frame.state.nodes[b])).collect());
        assert!(seen.gaps[0] < 1e-13, "{:?}", seen.gaps);
        seen.rows
    };
    let exact = run(1e-4);
    let points: Vec<(f64, f64)> = [4e-3, 2e-3, 1e-3].map(|dt| (dt, error(&run(dt), &exact, 0))).to_vec();
    let order = slope(&points);
    println!("{points:?} slope {order:.2}");
    // The reference has 1/100 of the last error.
    assert!((1.85..2.2).contains(&order), "order {order}");
}

/// Overrides that make all attachments of a deck multipliers.
fn by_multipliers(name: &str, sets: &[&str]) -> Vec<String> {
    let text = std::fs::read_to_string(support::decks().join(name).join("deck.toml")).expect("a deck");
    let count = text.matches("[[attachments]]").count();
    assert!(count > 0, "{name} attaches nothing");
    let methods = (0..count).map(|i| format!("attachments.{i}.method=\"multipliers\""));
    sets.iter().map(|set| (*set).to_owned()).chain(methods).collect()
}

/// All positions of what the deck writes, at all output times, by elimination and by multipliers.
fn both(name: &str, sets: &[&str]) -> f64 {
    let own: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    let [one, other] = [own, by_multipliers(name, sets)].map(|sets| {
        let mut model = read(name, &sets);
        model.expects.clear();
        let nodes: Vec<usize> = model.output.nodes.iter().copied().chain(model.bodies.iter().map(|b| b.node)).collect();
        let start: Vec<Vec3> = nodes.iter().map(|&n| model.nodes[n].x).collect();
        run_to_the_end(&model, &mut |frame| {
            let moved = nodes.iter().zip(&start).map(|(&n, x)| frame.state.nodes[n].x - x);
            moved.flat_map(|u| [u.x, u.y, u.z]).collect()
        })
        .rows
    });
    error(&other, &one, 0)
}

#[test]
fn statics_by_elimination_and_by_multipliers_agree() {
    let scene = r#"
[analysis]
kind = "static"
end_time = 1.0
time_step = 0.25
[iteration]
tolerance = 1e-10
[materials.steel]
model = "elastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
density = 7850.0
[sections.square]
shape = "rectangle"
width = 0.02
height = 0.02
[points]
foot = [0.0, 0.0, 0.0]
top = [0.0, 0.0, 1.0]
other = [2.0, 0.3, 0.0]
head = [2.0, 0.3, 1.0]
eye = [1.0, 0.5, 1.5]
[[beams]]
name = "left"
path = ["foot", "top"]
elements = 4
material = "steel"
section = "square"
orientation = [0.0, 1.0, 0.0]
[[beams]]
name = "right"
path = ["other", "head"]
elements = 4
material = "steel"
section = "square"
orientation = [0.0, 1.0, 0.0]
[[bodies]]
name = "roof"
center = [1.0, 0.2, 1.1]
mass = 10.0
inertia = [1.0, 1.0, 1.0]
[[attachments]]
body = "roof"
nodes = ["top", "eye"]
METHOD
[[attachments]]
body = "roof"
nodes = ["head"]
METHOD
[[supports]]
at = ["foot", "other"]
fix = "all"
[[loads]]
at = "eye"
force = [3000.0, 1000.0, -500.0]
"#;
    let [one, other] = ["", "method = \"multipliers\""].map(|method| {
        let model = from_text(&scene.replace("METHOD", method));
        let nodes = ["top", "head", "eye", "roof"].map(|name| node(&model, name));
        let start = nodes.map(|n| model.nodes[n].x);
        let seen = watch(&model, |frame| {
            nodes.iter().zip(&start).flat_map(|(&n, x)| <[f64; 3]>::from(frame.state.nodes[n].x - x)).collect()
        });
        assert!(seen.gaps[0] < 1e-9, "{:?}", seen.gaps); // the step ends where corrections are below the tolerance
        seen.rows
    });
    let moved = other.last().expect("a row").iter().fold(0.0f64, |m, u| m.max(u.abs()));
    let error = error(&other, &one, 1);
    println!("static: {error:.1e} of {moved:.3}");
    assert!(moved > 0.05, "it moves by a twentieth of its height: {moved}");
    assert!(error < 1e-8, "{error}"); // the tolerance of the iteration, over its contraction
}

/// In motion a node that rides has the accelerations of its master by elimination and its own by multipliers, both of second order:
/// the difference falls with dt².
#[test]
fn motions_by_elimination_and_by_multipliers_agree_to_second_order() {
    for (name, sets, steps) in [
        ("block_on_cantilever", &["output.interval=0.01"][..], [2e-4, 1e-4, 5e-5]),
        ("heavy_top", &["output.interval=0.01"][..], [2e-4, 1e-4, 5e-5]),
    ] {
        let points: Vec<(f64, f64)> = steps
            .iter()
            .map(|dt| {
                let dt_word = format!("analysis.time_step={dt}");
                let sets: Vec<&str> =
                    sets.iter().copied().chain([dt_word.as_str(), "iteration.tolerance=1e-11"]).collect();
                (*dt, both(name, &sets))
            })
            .collect();
        println!("{name}: {points:?} slope {:.2}", slope(&points));
        let last = points.last().expect("a rung").1;
        // Next to nothing where what rides has no mass; else the error of the scheme.
        assert!(last < 1e-9 || slope(&points) > 1.5 && last < 1e-3, "{name}: {points:?}");
    }
}

#[test]
fn a_four_bar_linkage_turns_a_hundred_times_and_stays_closed() {
    let model = read("four_bar", &[]);
    let crank = node(&model, "crank");
    let turns = RefCell::new((0.0, 0.0));
    let seen = watch(&model, |frame| {
        let knee = frame.state.nodes[crank].x;
        let angle = f64::atan2(knee.y, knee.x);
        let (turned, last): &mut (f64, f64) = &mut turns.borrow_mut();
        let change = angle - *last;
        *turned += change - (change / std::f64::consts::TAU).round() * std::f64::consts::TAU;
        *last = angle;
        vec![]
    });
    let turned = turns.borrow().0.abs() / std::f64::consts::TAU;
    let (first, last) = (seen.energies[0].mechanical, seen.energies.last().expect("a row").mechanical);
    println!("{turned:.1} turns, gaps {:?}, energy {:.2e}", seen.gaps, last / first - 1.0);
    assert!(turned > 100.0, "{turned}");
    assert!(seen.gaps[0] < 1e-12, "{:?}", seen.gaps); // positions of 4 m, to rounding
    // As in the deck: the dissipation of the scheme.
    assert!((last / first - 1.0).abs() < 0.04, "{}", last / first - 1.0);
    // Rows of the loop that say nothing new: two turns and one translation.
    let system = System::new(&model).expect("a system");
    let plan = Plan::new(&model, &system, 1);
    assert_eq!(
        plan.redundant_constraints.as_deref().map(<[usize]>::len),
        Some(3),
        "{:?}",
        rdsolve::plan::explain::redundant_constraints(&plan, &model, &system)
    );
}

/// Where all nodes lie at one place, what the mean of their coordinates rounds to is no length.
#[test]
fn a_driven_screw_at_one_place_has_six_independent_equations() {
    let model = crate::support::read_deck(
        "analysis = { kind = \"static\", end_time = 1.0, time_step = 0.5 }\namplitudes.r = { kind = \"ramp\", end = 1.0 }\n\
         bodies = [{ name = \"b\", center = [0.2, 0.0, 0.1], mass = 1.0, inertia = [1.0, 1.0, 1.0] }]\n\
         [[joints]]\nname = \"j\"\nkind = \"screw\"\nfrom = { ground = [0.2, 0.0, 0.1] }\nto = { body = \"b\" }\naxis = [0.0, 0.0, 1.0]\n\
         lead = 0.3\nmotion = { position = 0.5, amplitude = \"r\" }\n",
    );
    let system = System::new(&model).expect("a system");
    assert_eq!(Plan::new(&model, &system, 1).redundant_constraints.as_deref(), Some(&[][..]));
}

/// Reactions that equations leave open are told of what the deck has: of the support of a point, or the attachment, and of its directions.
#[test]
fn redundant_reactions_are_those_of_supports_and_attachments() {
    let told = |more: &str| {
        let model = crate::support::read_deck(&format!(
            "analysis = {{ kind = \"static\", end_time = 1.0, time_step = 0.5 }}\npoints = {{ p = [0.0, 0.0, 0.0], q = [1.0, 0.0, 0.5] }}\n\
             [[bodies]]\nname = \"b\"\ncenter = [0.5, 0.5, 0.0]\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n\
             [[attachments]]\nbody = \"b\"\nnodes = [\"p\", \"q\"]\n{more}"
        ));
        let system = System::new(&model).expect("a system");
        rdsolve::plan::explain::redundant_constraints(&Plan::new(&model, &system, 1), &model, &system).join("; ")
    };
    let clamped = told("[[supports]]\nat = [\"p\", \"q\"]\nfix = \"all\"\n");
    assert!(clamped.starts_with("the support of `q`: ux, uy, uz, rz, rx and ry are redundant"), "{clamped}");
    let hinged =
        told("[[supports]]\nat = [\"p\", \"q\"]\nfix = \"translations\"\n[[supports]]\nat = \"p\"\nfix = [\"ry\"]\n");
    assert!(hinged.contains("the support of `q`: ") && !hinged.contains("joint"), "{hinged}");
    let second = "[[bodies]]\nname = \"c\"\ncenter = [0.5, -0.5, 0.0]\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n\
                  [[attachments]]\nbody = \"c\"\nnodes = [\"p\", \"q\"]\n";
    let twice = told(second);
    assert!(twice.starts_with("the attachment of `q`: ux, uy, uz, rz, rx and ry are redundant"), "{twice}");
}

#[test]
fn hinges_that_say_the_same_share_the_weight() {
    // A door on three hinges in a line: 15 rows, 5 of them new.
    let hinge = |name: &str, z: f64| {
        format!(
            "[[joints]]\nname = \"{name}\"\nkind = \"hinge\"\naxis = [0.0, 0.0, 1.0]\nfrom = {{ body = \"door\", point = [0.0, 0.0, {z}] }}\nto = {{ ground = [0.0, 0.0, {z}] }}\n"
        )
    };
    let text = format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = 1.0\ntime_step = 0.01\n[environment]\ngravity = [0.0, 0.0, -10.0]\n\
         [output]\nreactions = true\n\
         [[bodies]]\nname = \"door\"\ncenter = [0.5, 0.0, 1.0]\nmass = 30.0\ninertia = [10.0, 12.0, 3.0]\n\
         angular_velocity = [0.0, 0.0, 1.0]\nvelocity = [0.0, 0.5, 0.0]\n{}{}{}",
        hinge("low", 0.2),
        hinge("middle", 1.0),
        hinge("high", 1.8)
    );
    let text = text
        + "[[expect]]\nat = \"middle\"\nquantity = \"fz\"\ntime = 1.0\nvalue = 100.0\ntolerance = 1e-4\nsource = \"a third\"\n";
    let model = from_text(&text);
    let system = System::new(&model).expect("a system");
    let plan = Plan::new(&model, &system, 1);
    assert_eq!(
        plan.redundant_constraints.as_deref().map(<[usize]>::len),
        Some(10),
        "{:?}",
        rdsolve::plan::explain::redundant_constraints(&plan, &model, &system)
    );
    assert!(support::run(&model, &mut |_| vec![]).verdicts[0].passed);
    let seen = watch(&model, |frame| frame.derived.joints.iter().flat_map(|j| [j.f.x, j.f.y, j.f.z, j.m.y]).collect());
    println!("{:?}\n{:?}", seen.rows[0], seen.rows.last());
    // Increments are least in norm, not the whole: as the door turns they let the shares differ by parts of 1e-5 or so.
    let rounding = 1e-4 * 300.0;
    for row in &seen.rows {
        assert!((0..3).all(|k| (row[4 * k + 2] - 100.0).abs() < rounding), "a third of the weight each: {row:?}");
    }
    // The moment of the weight about the pin, 150 N m, is held by forces at the ends and by turns.
    let start = &seen.rows[0];
    let moment = 0.8 * (start[8] - start[0]) + start[3] + start[7] + start[11];
    assert!((moment.abs() - 150.0).abs() < rounding, "{moment}");
}

#[test]
fn the_gyroscopic_term_stands_on_either_side() {
    let ends = ["left", "right"].map(|side| {
        let sets = [format!("iteration.gyroscopic=\"{side}\""), "iteration.tolerance=1e-12".into()];
        let mut model = read("heavy_top/pivot", &sets);
        model.expects.clear();
        let top = node(&model, "top");
        let done = run_to_the_end(&model, &mut |frame| position(&frame.state.nodes[top]).to_vec());
        (done.rows.last().expect("a row").clone(), done.counts.iterations)
    });
    let [(left, few), (right, many)] = &ends;
    println!("left {few} iterations, right {many}");
    for (a, b) in left.iter().zip(right) {
        assert!((a - b).abs() < 1e-9, "{a} {b}"); // 400 steps of 1e-12 each
    }
}

#[test]
fn a_large_system_takes_multipliers() {
    // Two sheets that meet edge to edge, each edge node of one held to a body, those of the other to another, the bodies joined.
    let text = |joint: &str| {
        format!(
            r#"
[analysis]
kind = "static"
end_time = 1.0
time_step = 0.5
[iteration]
tolerance = 1e-10
[materials.steel]
model = "elastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
density = 7850.0
[points]
a = [0.0, 0.0, 0.0]
b = [1.0, 0.0, 0.0]
c = [1.0, 1.0, 0.0]
d = [0.0, 1.0, 0.0]
e = [2.0, 0.0, 0.0]
f = [2.0, 1.0, 0.0]
g = [1.2, 0.0, 0.0]
h = [1.2, 1.0, 0.0]
[[shells]]
name = "left"
corners = ["a", "b", "c", "d"]
elements = [16, 16]
thickness = 0.01
material = "steel"
[[shells]]
name = "right"
corners = ["g", "e", "f", "h"]
elements = [16, 16]
thickness = 0.01
material = "steel"
[[bodies]]
name = "strip"
center = [1.1, 0.5, 0.0]
mass = 1.0
inertia = [1.0, 1.0, 1.0]
[[attachments]]
body = "strip"
nodes = "left.edge2"
[[attachments]]
body = "strip"
nodes = "right.edge4"
{joint}
[[supports]]
at = "left.edge4"
fix = "all"
[[loads]]
at = ["e", "f"]
force = [0.0, 0.0, 200.0]
"#
        )
    };
    let [one, other] = ["", "method = \"multipliers\""].map(|method| {
        let model = from_text(&text(method));
        let system = System::new(&model).expect("a system");
        assert_eq!(Plan::new(&model, &system, 1).kind, Factorization::Cholesky);
        let corner = node(&model, "e");
        let done = run_to_the_end(&model, &mut |frame| position(&frame.state.nodes[corner]).to_vec());
        println!("{} iterations", done.counts.iterations);
        done.rows.last().expect("a row").clone()
    });
    println!("{one:?} {other:?}");
    assert!(one[2] > 0.01, "{one:?}");
    for (a, b) in one.iter().zip(&other) {
        assert!((a - b).abs() < 1e-9, "{a} {b}"); // the tolerance of the iteration on a metre
    }
}

/// Scenes by their text after an opening that all share.
fn scene(kind: &str, end_time: f64, time_step: f64, rest: &str) -> String {
    format!(
        "[analysis]\nkind = \"{kind}\"\nend_time = {end_time}\ntime_step = {time_step}\nplane = \"off\"\n\
         [iteration]\ntolerance = 1e-10\n{rest}"
    )
}

const DRIVEN: &str = r#"
[points]
p = [0.5, 0.0, 0.0]
[amplitudes.push]
kind = "sine-squared"
angular_frequency = 3.0
end = 100.0
[[bodies]]
name = "a"
center = [0.0, 0.0, 0.0]
mass = 2.0
inertia = [0.2, 0.2, 0.2]
[[attachments]]
body = "a"
nodes = ["p"]
[[supports]]
at = "p"
fix = ["uy", "uz", "rx", "ry", "rz"]
motion = { ux = { amplitude = "push", scale = 0.1 } }
[output]
reactions = true
interval = 0.25
"#;

/// u = 0.1 sin²(3t): the support carries m ü = 2 · 0.1 · 18 cos 6t, whatever the step; and the work it does is the kinetic energy.
#[test]
fn a_driven_joint_carries_the_inertia() {
    for dt in [0.01, 0.001] {
        let model = from_text(&scene("dynamic", 1.0, dt, DRIVEN));
        let place = model.constraints.restraints.iter().position(|held| held.motion.is_some()).expect("a motion");
        let seen = watch(&model, |frame| vec![frame.state.time, frame.reactions[place]]);
        for (row, energy) in seen.rows.iter().zip(&seen.energies).skip(1) {
            let exact = 2.0 * 0.1 * 18.0 * (6.0 * row[0]).cos();
            // Carried from t + θΔt to t + Δt on a straight line: Δt² of the second derivative, 36·3.6.
            assert!((row[1] - exact).abs() < 130.0 * dt * dt, "{row:?}: {exact} at dt {dt}");
            let kinetic = 0.5 * 2.0 * (0.3 * (6.0 * row[0]).sin()).powi(2);
            assert!((energy.kinetic - kinetic).abs() < 1e-12, "{} {kinetic}", energy.kinetic);
            assert!((energy.external - kinetic).abs() < 10.0 * dt * dt, "{} {kinetic}", energy.external);
        }
    }
}

/// A rigid body whose two ends are to be at distances that it does not have.
#[test]
fn joints_that_contradict_each_other_are_no_result() {
    let rest = r#"
[points]
p = [0.0, 0.0, 0.0]
q = [1.0, 0.0, 0.0]
[amplitudes.ramp]
kind = "table"
points = [[0.0, 0.0], [1.0, 0.1]]
[[bodies]]
name = "a"
center = [0.5, 0.0, 0.0]
mass = 2.0
inertia = [0.2, 0.3, 0.4]
[[attachments]]
body = "a"
nodes = ["p", "q"]
[[supports]]
at = "p"
fix = "all"
[[supports]]
at = "q"
motion = { ux = { amplitude = "ramp" } }
"#;
    for kind in ["static", "dynamic"] {
        let model = from_text(&scene(kind, 1.0, 0.5, rest));
        match support::run(&model, &mut |_| vec![]).outcome {
            Outcome::Failed { failure: Failure::ConstraintsViolated { largest, .. }, .. } => {
                println!("{kind}: {largest:?}");
                assert!(!largest.is_empty() && largest.iter().all(|gap| gap.residual != 0.0), "{kind}: {largest:?}");
            }
            other => panic!("{kind}: {other:?}"),
        }
    }
}

/// A body on a pivot that a rotational spring holds, driven at an arm: nothing but rotation resists, a force row must see that.
#[test]
fn rows_are_weighed_by_what_resists_them() {
    let rest = r#"
[points]
p = [1.0, 0.0, 0.0]
[amplitudes.ramp]
kind = "sine-squared"
angular_frequency = 3.0
end = 100.0
[[bodies]]
name = "a"
center = [0.0, 0.0, 0.0]
mass = 2.0
inertia = [1e3, 1e3, 1e3]
[[supports]]
at = "a"
fix = ["ux", "uy", "uz", "rx", "ry"]
[[attachments]]
body = "a"
nodes = ["p"]
[[supports]]
at = "p"
motion = { uy = { amplitude = "ramp", scale = 0.1 } }
[[links]]
name = "spring"
from = { body = "a" }
to = { ground = [0.0, 0.0, 0.0] }
bushing = [1.0, 1.0, 1.0, 1e9, 1e9, 1e9]
[output]
interval = 0.1
"#;
    for kind in ["static", "dynamic"] {
        let model = from_text(&scene(kind, 1.0, 0.01, rest));
        let p = node(&model, "p");
        let seen = run_to_the_end(&model, &mut |frame| vec![frame.state.time, frame.state.nodes[p].x.y]);
        println!("{kind}: {:?}", seen.counts);
        assert!(seen.counts.iterations < 8 * 100, "{kind}: {:?}", seen.counts);
        for row in &seen.rows {
            let exact = 0.1 * (3.0 * row[0]).sin().powi(2);
            assert!((row[1] - exact).abs() < 1e-10, "{kind}: {row:?} for {exact}");
        }
    }
}

#[test]
fn what_rides_may_be_supported_in_some_rotations() {
    let rest = |fix: &str| {
        format!(
            r#"
[points]
p = [0.0, 0.0, 0.0]
[[bodies]]
name = "a"
center = [0.5, 0.1, 0.0]
mass = 2.0
inertia = [0.2, 0.3, 0.4]
angular_velocity = [1.0, 2.0, 0.5]
[[attachments]]
body = "a"
nodes = ["p"]
[[supports]]
at = "p"
fix = {fix}
"#
        )
    };
    for (fix, rows) in [("[\"rx\"]", 1), ("[\"rx\", \"ry\"]", 2), ("[\"ux\", \"rx\", \"ry\", \"rz\"]", 4)] {
        let model = from_text(&scene("dynamic", 1.0, 0.01, &rest(fix)));
        let seen = watch(&model, |_| vec![]);
        assert_eq!(model.constraints.joints[0].equations.len(), rows);
        assert!(seen.gaps[0] < 1e-14, "{fix}: {:?}", seen.gaps);
    }
}

/// Rounding of positions grows with them: what travels far from where it started is measured by where it is.
#[test]
fn joints_hold_far_from_where_they_started() {
    let fast = "velocity = [7500.0, 3000.0, 100.0]\n";
    let text = pair(&format!("kind = \"ball\"\n{MEET}"))
        .replace("end_time = 2.0", "end_time = 20.0")
        .replace("time_step = 0.002", "time_step = 0.01")
        .replace("velocity = [0.3, 0.0, 0.1]\n", fast)
        .replace("inertia = [0.05, 0.1, 0.12]\n", &format!("inertia = [0.05, 0.1, 0.12]\n{fast}"));
    let model = from_text(&text);
    let seen = watch(&model, |_| vec![]);
    assert!(seen.gaps[0] < 1e-9, "{:?}", seen.gaps); // 150 km away the last digit of a position is 3e-11
}

/// Consistent masses count in the norm in which joints are closed: nothing is pushed off against what has no mass.
#[test]
fn closing_keeps_the_momentum_of_consistent_masses() {
    let rest = |mass: &str| {
        format!(
            r#"
[materials.steel]
model = "elastic"
youngs_modulus = 2e9
poisson_ratio = 0.3
density = 7850.0
[sections.square]
shape = "rectangle"
width = 0.02
height = 0.02
[points]
p = [0.0, 0.0, 0.0]
q = [1.0, 0.0, 0.0]
[[beams]]
name = "rod"
path = ["p", "q"]
elements = 3
material = "steel"
section = "square"
orientation = [0.0, 1.0, 0.0]
mass = "{mass}"
[[bodies]]
name = "a"
center = [1.3, 0.2, 0.0]
mass = 2.0
inertia = [0.02, 0.03, 0.04]
velocity = [0.0, 1.0, 0.5]
angular_velocity = [1.0, 2.0, 0.5]
[[joints]]
name = "pin"
kind = "ball"
from = {{ node = "q" }}
to = {{ body = "a" }}
"#
        )
    };
    for mass in ["lumped", "consistent"] {
        let seen = watch(&from_text(&scene("dynamic", 0.2, 1e-3, &rest(mass))), |_| vec![]);
        let (first, last) = (&seen.energies[0], seen.energies.last().expect("a row"));
        let drift = (last.p - first.p).norm() / first.p.norm();
        println!("{mass}: {drift:.1e}");
        assert!(drift < 1e-9, "{mass}: {drift}"); // 200 steps of an iteration to 1e-10
    }
}
