//! Paths of equilibria by arc length: limit points, snap-through and snap-back.

use crate::support::truss::{TRUSS, behind_spring};
use crate::support::{self, Done, node, read_deck as read};
use rdsolve::model::Model;
use rdsolve::solve::{Frame, Outcome};

/// Runs a deck to its end; a row is the time, then the displacements asked for. The start is left out.
fn follow(model: &Model, at: &[(&str, usize)]) -> Done {
    let places: Vec<(usize, usize)> = at.iter().map(|&(label, dof)| (node(model, label), dof)).collect();
    let mut done = support::run(model, &mut |frame: &Frame| {
        let u = |&(node, dof): &(usize, usize)| frame.state.nodes[node].x[dof] - frame.model.nodes[node].x[dof];
        std::iter::once(frame.state.time).chain(places.iter().map(u)).collect()
    });
    done.rows.remove(0);
    let (c, n) = (done.counts, done.unknowns);
    println!(
        "{}: {n} unknowns, {} steps, {} iterations, {} cuts, {:.3} s, {:?}",
        model.title, c.steps, c.iterations, c.cuts, done.seconds, done.outcome
    );
    done
}

fn follow_to_the_end(model: &Model, at: &[(&str, usize)]) -> Done {
    let done = follow(model, at);
    assert!(matches!(done.outcome, Outcome::Done), "{:?}", done.outcome);
    done
}

/// Where the rows turn in their first column.
fn turns(rows: &[Vec<f64>]) -> usize {
    rows.windows(3).filter(|r| (r[1][0] - r[0][0]) * (r[2][0] - r[1][0]) < 0.0).count()
}

/// A path by arc length; time is the load on the crown of the truss.
const PATH: &str = r#"
title = "truss"
[analysis]
kind = "static"
control = "arc-length"
end_time = 60.0
time_step = 5.0
"#;

const ON_CROWN: &str = r#"
[[loads]]
at = "crown"
force = [0.0, 0.0, -60.0]
"#;

/// P(w) of the truss: 2 EA (L − l)/L (h − w)/l.
fn truss(w: f64) -> f64 {
    let (L, z): (f64, f64) = (1.25f64.sqrt(), 0.5 - w);
    let l = (1.0 + z * z).sqrt();
    2000.0 * (L - l) / L * z / l
}

#[test]
fn truss_snaps_through() {
    let model = read(&format!("{PATH}{TRUSS}{ON_CROWN}"));
    let done = follow_to_the_end(&model, &[("crown", 2), ("crown", 0)]);
    let rows = &done.rows;
    for row in rows {
        assert!((row[0] - truss(-row[1])).abs() < 1e-8 * 60.0 && row[2].abs() < 1e-12, "{row:?}");
    }
    assert_eq!(rows.last().unwrap()[0], 60.0);
    assert_eq!(turns(rows), 2);
}

#[test]
fn truss_behind_a_spring_snaps_back() {
    let load = ON_CROWN.replace("crown", "hand");
    let deck = format!("{PATH}{}{load}", behind_spring(40.0));
    let done = follow_to_the_end(&read(&deck), &[("crown", 2), ("hand", 2)]);
    let rows = &done.rows;
    for row in rows {
        let p = truss(-row[1]);
        assert!((row[0] - p).abs() < 1e-8 * 60.0 && (-row[2] + row[1] - p / 40.0).abs() < 1e-8, "{row:?}");
    }
    // The hand goes back as the load does.
    assert!(rows.windows(2).any(|r| r[1][2] > r[0][2] + 0.01 && r[1][0] < r[0][0]));
    assert_eq!(turns(rows), 2);
}

/// Part of the way from a line of straight pieces to a point along each axis, in units of that axis.
fn miss(rows: &[Vec<f64>], point: &[f64], scale: [f64; 2]) -> [f64; 2] {
    let mut best = (f64::INFINITY, [0.0; 2]);
    for pair in rows.windows(2) {
        let of = |a: &[f64], b: &[f64]| [(b[0] - a[0]) / scale[0], (b[1] - a[1]) / scale[1]];
        let (d, p) = (of(&pair[0], &pair[1]), of(&pair[0], point));
        let s = ((d[0] * p[0] + d[1] * p[1]) / (d[0] * d[0] + d[1] * d[1])).clamp(0.0, 1.0);
        let rest = [p[0] - s * d[0], p[1] - s * d[1]];
        let size = rest[0].hypot(rest[1]);
        if size < best.0 {
            best = (size, rest);
        }
    }
    best.1
}

/// Rows of numbers beside a deck.
fn table(name: &str) -> Vec<Vec<f64>> {
    let mut reader = csv::Reader::from_path(support::decks().join(name).join("reference.csv")).unwrap();
    reader.records().map(|row| row.unwrap().iter().map(|text| text.parse().unwrap()).collect()).collect()
}

/// Each row of the tables against the curve of small steps; loads over Pmax, deflections over the largest.
#[test]
fn hinged_roofs_follow_their_tables() {
    for (name, largest, turns_of_load) in [("hinged_roof", 29.374, 2), ("hinged_roof/thin", 38.45, 2)] {
        let coarse = follow_to_the_end(&support::read(name, &[]), &[("crown", 2)]);
        assert!(coarse.counts.steps < 60, "{} steps", coarse.counts.steps);
        let fine = follow_to_the_end(&support::read(name, &["analysis.growth=1.0".into()]), &[("crown", 2)]);
        let rows: Vec<Vec<f64>> =
            std::iter::once(vec![0.0, 0.0]).chain(fine.rows.iter().map(|row| vec![row[0], -row[1]])).collect();
        assert_eq!(turns(&rows), turns_of_load, "{name}");
        let mut worst = 0.0f64;
        for point in table(name).iter().filter(|point| point[0] < 1.0) {
            let [p, w] = miss(&rows, point, [1.0, largest]);
            println!("{name} P {:7.4} W {:7.3}: off by {p:+.4} of Pmax, {w:+.4} of Wmax", point[0], point[1]);
            worst = worst.max(p.hypot(w));
        }
        println!("{name}: worst {worst:.4}");
        assert!(worst < 0.012, "{name}: {worst}");
    }
}

#[test]
fn lees_frame() {
    let fine = ["analysis.growth=1.0".to_string(), "analysis.time_step=0.02".to_string()];
    let done = follow_to_the_end(&support::read("lees_frame", &[]), &[("load", 0), ("load", 1)]);
    assert!(done.counts.steps < 400);
    let done = follow_to_the_end(&support::read("lees_frame", &fine), &[("load", 1), ("load", 0)]);
    let of = |k: usize| -> Vec<Vec<f64>> { done.rows.iter().map(|r| vec![r[0], r[k]]).collect() };
    let (down, across) = (of(1), of(2));
    let path = [
        [0.6988, 0.703, 5.955],
        [1.2702, 4.248, 17.529],
        [1.5599, 9.401, 28.401],
        [1.7537, 16.093, 38.255],
        [1.8517, 24.658, 46.972],
        [1.7451, 39.765, 56.143],
        [1.5085, 51.229, 59.785],
        [1.1457, 63.083, 60.979],
        [0.5555, 74.480, 57.812],
        [-0.6640, 83.102, 51.441],
        [-0.9330, 91.355, 60.066],
        [-0.6808, 94.359, 71.536],
        [-0.1741, 91.373, 83.032],
        [0.3312, 88.251, 88.116],
    ];
    for [p, u, v] in path {
        let off = [miss(&down, &[p, -v], [2.0, 100.0]), miss(&across, &[p, u], [2.0, 100.0])];
        println!("P {p}: {off:?}");
        // Half the last digits of the table, and what straight lines between the steps leave.
        assert!(off.iter().all(|[p, u]| p.hypot(*u) < 7e-5), "at P = {p}: {off:?}");
    }
    let turning: Vec<f64> =
        down.windows(3).filter(|r| (r[1][0] - r[0][0]) * (r[2][0] - r[1][0]) < 0.0).map(|r| r[1][0]).collect();
    println!("limit points {turning:?}");
    // The reference has its extremes where its steps are: at v = 48.826, where the deck finds the same load, it is 1.2e-5
    // below the limit point.
    assert!((turning[0] - 1.855673).abs() < 2e-6 && (turning[1] + 0.941442).abs() < 1e-5, "{turning:?}");
}

/// Stress of a bar with linear hardening along a way of strains, from its own formulas: σ = E (ε − εᵖ), |σ| ≤ σ_Y + H ε̄ᵖ.
struct Plastic {
    strain: f64,
    accumulated: f64,
}

impl Plastic {
    const E: f64 = 1000.0;
    const H: f64 = 50.0;
    const Y: f64 = 20.0;

    fn stress(&mut self, strain: f64) -> f64 {
        let trial = Self::E * (strain - self.strain);
        let over = trial.abs() - Self::Y - Self::H * self.accumulated;
        let flow = (over / (Self::E + Self::H)).max(0.0);
        self.strain += flow.copysign(trial);
        self.accumulated += flow;
        Self::E * (strain - self.strain)
    }
}

/// The truss of steel: its bars yield before the limit load of the elastic one, unload where it passes its feet, and yield in
/// tension.
#[test]
fn yielding_truss_collapses() {
    let material = r#"
[materials.steel]
model = "elastic-plastic"
youngs_modulus = 1000.0
poisson_ratio = 0.3
yield_stress = 20.0
hardening_modulus = 50.0
"#;
    let deck = format!("{PATH}{TRUSS}{ON_CROWN}{material}")
        .replace("axial_stiffness = 1000.0\nmass_per_length = 0.0", "material = \"steel\"\narea = 1.0")
        .replace("time_step = 5.0", "time_step = 2.0\ngrowth = 2.0");
    let done = follow_to_the_end(&read(&deck), &[("crown", 2)]);
    let rows = &done.rows;
    let length = 1.25f64.sqrt();
    let at = |w: f64| (1.0 + (0.5 - w).powi(2)).sqrt();
    let load = |stress: f64, w: f64| -2.0 * stress * (0.5 - w) / at(w);
    let (mut steps, mut fine, mut from) =
        (Plastic { strain: 0.0, accumulated: 0.0 }, Plastic { strain: 0.0, accumulated: 0.0 }, 0.0);
    let mut way = 0.0f64;
    for row in rows {
        let w = -row[1];
        let exact = load(steps.stress((at(w) - length) / length), w);
        assert!((row[0] - exact).abs() < 1e-8 * 60.0, "{row:?} {exact}");
        let mut stress = 0.0;
        for k in 1..=1000 {
            let w = from + (w - from) * k as f64 / 1000.0;
            stress = fine.stress((at(w) - length) / length);
        }
        way = way.max((w - from).abs());
        // Where the bars are shortest a step ends up to half its way off: the strain missed there is plastic.
        let missed = 2.0 * Plastic::E * 0.25 * way * way / (2.0 * length);
        assert!((row[0] - load(stress, w)).abs() < missed, "{row:?} {}", load(stress, w));
        from = w;
    }
    assert!(steps.accumulated > 0.05 && turns(rows) >= 2, "{} {}", steps.accumulated, turns(rows));
    let peak = rows.iter().map(|r| r[0]).take(rows.len() - 1).fold(0.0, f64::max);
    println!("peak {peak}, plastic strain {}", steps.accumulated);
}

/// A steel column under a small force across: its load falls once it yields. By arc length, and driven by its shortening,
/// where the load is a reaction: equations of their own for the same path.
#[test]
fn yielding_column_softens() {
    let column = |analysis: &str, more: &str| {
        format!(
            r#"
title = "column"
[analysis]
kind = "static"
{analysis}
[materials.steel]
model = "elastic-plastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
yield_stress = 275e6
hardening_modulus = 1e9
[sections.square]
shape = "rectangle"
width = 0.05
height = 0.05
fibres = [2, 12]
[points]
foot = [0.0, 0.0, 0.0]
head = [0.0, 0.0, 2.0]
[[beams]]
name = "column"
path = ["foot", "head"]
elements = 6
material = "steel"
section = "square"
orientation = [0.0, 1.0, 0.0]
shear_yields = false
[[supports]]
at = "foot"
fix = "all"
[[loads]]
at = "head"
force = [500.0, 0.0, 0.0]
amplitude = "dead"
[amplitudes.dead]
kind = "constant"
{more}
"#
        )
    };
    let path = column(
        "control = \"arc-length\"\nend_time = 1.0\ntime_step = 0.05\ngrowth = 20.0\n\
         stop = { at = \"head\", quantity = \"uz\", value = -0.3 }",
        "[[loads]]\nat = \"head\"\nforce = [0.0, 0.0, -1e5]",
    );
    let done = follow_to_the_end(&read(&path), &[("head", 2)]);
    let driven = column(
        "end_time = 1.0\ntime_step = 0.0025",
        "[[supports]]\nat = \"head\"\nmotion = { uz = { amplitude = \"down\", scale = -0.3 } }\n\
         [amplitudes.down]\nkind = \"sine-squared\"\nangular_frequency = 1.5707963267948966\n[output]\nreactions = true",
    );
    let model = read(&driven);
    let (head, held) =
        (node(&model, "head"), model.constraints.restraints.iter().position(|held| held.motion.is_some()).unwrap());
    let curve = support::run_to_the_end(&model, &mut |frame: &Frame| {
        vec![-frame.reactions[held] / 1e5, frame.state.nodes[head].x[2] - 2.0]
    });
    println!("driven: {} steps, {} iterations", curve.counts.steps, curve.counts.iterations);
    let largest = done.rows.iter().map(|r| r[0]).fold(0.0, f64::max);
    for row in &done.rows {
        let [p, u] = miss(&curve.rows, row, [largest, 0.3]);
        println!("{row:?} {p:e} {u:e}");
    }
    assert!(largest > 2.0 * done.rows.last().unwrap()[0], "{largest}");
    for row in &done.rows {
        let [p, u] = miss(&curve.rows, row, [largest, 0.3]);
        // Straight lines between 400 steps.
        assert!(p.hypot(u) < 2e-3, "{row:?} {p} {u}");
    }
}

/// Driven by the motion of its far end the spring jumps as well: the time is that motion.
#[test]
fn a_held_motion_leads_on_as_loads_do() {
    let driven = r#"
[[supports]]
at = "hand"
motion = { uz = { amplitude = "down", scale = -1.0 } }
[amplitudes.down]
kind = "table"
points = [[-10.0, -10.0], [10.0, 10.0]]
"#;
    let deck = format!("{PATH}{}{driven}", behind_spring(40.0))
        .replace("end_time = 60.0\ntime_step = 5.0", "end_time = 2.6\ntime_step = 0.2");
    let done = follow_to_the_end(&read(&deck), &[("crown", 2), ("hand", 2)]);
    for row in &done.rows {
        let exact = -row[1] + truss(-row[1]) / 40.0;
        // Positions are of the size of one.
        assert!((row[0] - exact).abs() < 1e-8 && (row[2] + row[0]).abs() < 1e-15 * 4.0, "{row:?} {exact}");
    }
    assert_eq!(turns(&done.rows), 2);
}

/// What is there from the start acts before the path begins.
#[test]
fn loads_that_begin_at_once_are_settled_first() {
    let dead = r#"
[[loads]]
at = "crown"
force = [0.0, 0.0, -10.0]
amplitude = "dead"
[amplitudes.dead]
kind = "constant"
"#;
    let done = follow_to_the_end(&read(&format!("{PATH}{TRUSS}{ON_CROWN}{dead}")), &[("crown", 2)]);
    for row in &done.rows {
        assert!((row[0] + 10.0 - truss(-row[1])).abs() < 1e-8 * 60.0, "{row:?}");
    }
    assert_eq!(turns(&done.rows), 2);
}

/// A follower along a path that never turns: what steps of given loads find.
#[test]
fn followers_and_weight_end_where_load_steps_end() {
    let text = r#"
title = "cantilever"
[analysis]
kind = "static"
control = "arc-length"
end_time = 1.0
time_step = 0.1
[sections.strip]
shape = "general"
axial_stiffness = 1e5
shear_stiffness = [1e5, 1e5]
torsional_stiffness = 100.0
bending_stiffness = [100.0, 100.0]
mass_per_length = 0.5
inertia_per_length = [1e-3, 5e-4, 5e-4]
[points]
clamp = [0.0, 0.0, 0.0]
tip = [10.0, 0.0, 0.0]
[[beams]]
name = "strip"
path = ["clamp", "tip"]
elements = 8
section = "strip"
orientation = [0.0, 1.0, 0.0]
[[supports]]
at = "clamp"
fix = "all"
[[loads]]
at = "tip"
force = [0.0, 5.0, 1.0]
moment = [0.0, 0.0, 3.0]
follower = true
[environment]
gravity = [0.0, -1.0, 0.5]
"#;
    let places = [("tip", 0), ("tip", 1), ("tip", 2)];
    let path = follow_to_the_end(&read(text), &places);
    let steps = follow_to_the_end(&read(&text.replace("arc-length", "time")), &places);
    let (a, b) = (path.rows.last().unwrap(), steps.rows.last().unwrap());
    assert_eq!(a[0], b[0]);
    // The tolerance of the iteration, on a motion of the size of the beam.
    assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-7), "{a:?} {b:?}");
}

#[test]
fn steps_land_where_values_are_expected() {
    let more = r#"
[[expect]]
at = "analysis"
quantity = "time"
when = { at = "crown", quantity = "uz", value = -0.3 }
value = 0.0
absolute_tolerance = 100.0
[[expect]]
at = "crown"
quantity = "uz"
when = { at = "crown", quantity = "uz", value = -0.31 }
value = -0.31
tolerance = 1e-12
[[expect]]
at = "crown"
quantity = "uz"
time = 20.0
value = -0.0666
tolerance = 0.01
[[expect]]
at = "crown"
quantity = "uz"
when = { at = "crown", quantity = "uz", value = -0.3, pass = 2 }
value = 0.0
absolute_tolerance = 1.0
"#;
    let deck = format!("{PATH}{TRUSS}{ON_CROWN}{more}")
        .replace("time_step = 5.0", "time_step = 5.0\nstop = { at = \"crown\", quantity = \"uz\", value = -0.8 }");
    let done = follow_to_the_end(&read(&deck), &[("crown", 2)]);
    let verdicts = &done.verdicts;
    let limit = verdicts[0].value.unwrap();
    assert!((limit - truss(0.3)).abs() < 1e-8 * 60.0, "{limit}");
    assert!(verdicts[1].passed, "{verdicts:?}");
    assert!((truss(-verdicts[2].value.unwrap()) - 20.0).abs() < 1e-8 * 60.0, "{verdicts:?}");
    assert_eq!(verdicts[2].time, Some(20.0));
    assert_eq!(verdicts[3].reason.as_deref(), Some("the path never came there"));
    assert!((done.rows.last().unwrap()[1] + 0.8).abs() < 1e-15);
    // As many steps as asked for.
    let deck = format!("{PATH}{TRUSS}{ON_CROWN}").replace("time_step = 5.0", "time_step = 5.0\nsteps = 4");
    assert_eq!(follow_to_the_end(&read(&deck), &[("crown", 2)]).counts.steps, 4);
}

/// A path that ends in the middle: the load comes to rest at t = 20, before the limit load.
#[test]
fn a_load_that_stays_leads_nowhere() {
    let dead = "[[loads]]\nat = \"crown\"\nforce = [0.0, 0.0, -20.0]\namplitude = \"short\"\n[amplitudes.short]\n\
                kind = \"ramp\"\nend = 20.0\n";
    let done = follow(&read(&format!("{PATH}{TRUSS}{dead}")), &[("crown", 2)]);
    let Outcome::Failed { failure, time } = &done.outcome else { panic!("{:?}", done.outcome) };
    assert!(failure.to_string().contains("no load or prescribed motion changes at t = "), "{failure}");
    assert!((time - 20.0).abs() < 0.01, "{time}");
}

/// The end of a run may be where its loads come to rest: the step that passes it goes on beyond. The amplitude is the load.
#[test]
fn a_path_ends_where_its_amplitude_ends() {
    use std::f64::consts::FRAC_PI_2;
    let w = FRAC_PI_2 / 60.0;
    // Before the start amplitudes go on along their slopes there; that of sin² is zero, so its load stays below the limit.
    #[allow(clippy::type_complexity)]
    let amplitudes: [(f64, String, fn(f64) -> f64); 4] = [
        (60.0, "kind = \"ramp\"\nend = 60.0".into(), |t| t / 60.0),
        (60.0, "kind = \"table\"\npoints = [[0.0, 0.0], [60.0, 1.0]]".into(), |t| t / 60.0),
        (60.0, format!("kind = \"sine\"\nangular_frequency = {w}\nend = 120.0"), |t| {
            let phase = FRAC_PI_2 * t / 60.0;
            if t < 0.0 { phase } else { phase.sin() }
        }),
        (30.0, format!("kind = \"sine-squared\"\nangular_frequency = {w}"), |t| (FRAC_PI_2 * t / 60.0).sin().powi(2)),
    ];
    for (force, amplitude, factor) in amplitudes {
        let load = ON_CROWN.replace("60.0", &format!("{force:?}"));
        let deck = format!("{PATH}{TRUSS}{load}amplitude = \"grows\"\n[amplitudes.grows]\n{amplitude}\n");
        let done = follow_to_the_end(&read(&deck), &[("crown", 2)]);
        assert_eq!(done.rows.last().unwrap()[0], 60.0, "{amplitude}");
        for row in &done.rows {
            assert!((force * factor(row[0]) - truss(-row[1])).abs() < 1e-8 * 60.0, "{amplitude} {row:?}");
        }
    }
}

/// The same for a motion.
#[test]
fn a_held_motion_may_end_with_the_run() {
    let driven = r#"
[[supports]]
at = "hand"
motion = { uz = { amplitude = "down", scale = -2.0 } }
[amplitudes.down]
kind = "ramp"
end = 2.0
"#;
    let deck = format!("{PATH}{}{driven}", behind_spring(4.0))
        .replace("end_time = 60.0\ntime_step = 5.0", "end_time = 2.0\ntime_step = 0.05")
        .replace("axial_stiffness = 1000.0", "axial_stiffness = 40.0");
    let done = follow_to_the_end(&read(&deck), &[("crown", 2), ("hand", 2)]);
    assert_eq!(done.rows.last().unwrap()[0], 2.0);
    for row in &done.rows {
        let exact = -row[1] + truss(-row[1]) * 40.0 / 1000.0 / 4.0;
        // Positions are of the size of one.
        assert!((row[0] - exact).abs() < 1e-8 && (row[2] + row[0]).abs() < 1e-15 * 4.0, "{row:?} {exact}");
    }
}

/// The first step begins where loads do; they stay below the limit, for they cannot be less than nothing.
#[test]
fn loads_may_begin_late() {
    for begin in ["0.2", "0.3"] {
        let late = format!(
            "amplitude = \"late\"\n[amplitudes.late]\nkind = \"ramp\"\nstart = {begin}\nend = 1.3\n[[expect]]\nat = \"analysis\"\nquantity = \"time\"\ntime = 0.1\nvalue = 0.1\ntolerance = 1e-12\n"
        );
        let deck = format!("{PATH}{TRUSS}{ON_CROWN}{late}")
            .replace("-60.0", "-30.0")
            .replace("end_time = 60.0\ntime_step = 5.0", "end_time = 1.3\ntime_step = 0.1");
        let done = follow_to_the_end(&read(&deck), &[("crown", 2)]);
        assert!(done.verdicts[0].passed);
        let begin: f64 = begin.parse().unwrap();
        for row in &done.rows {
            let load = 30.0 * (row[0] - begin).max(0.0) / (1.3 - begin);
            assert!((load - truss(-row[1])).abs() < 1e-8 * 60.0, "{row:?}");
        }
        assert!(done.counts.steps < 60, "{}", done.counts.steps);
    }
}

/// Whatever ends a run, its last step is told.
#[test]
fn the_last_step_is_told() {
    let stop = "stop = { at = \"crown\", quantity = \"uz\", value = -0.3 }";
    for more in ["", "steps = 4", stop] {
        let deck = format!("{PATH}{TRUSS}{ON_CROWN}").replace("time_step = 5.0", &format!("time_step = 5.0\n{more}"));
        for deck in [
            deck.clone(),
            // Half of the load stays below the limit, 38.4.
            deck.replace(more, "")
                .replace("arc-length", "time")
                .replace("end_time = 60.0", "end_time = 5.0")
                .replace("-60.0", "-30.0"),
        ] {
            let done = support::run_to_the_end(&read(&deck), &mut |frame: &Frame| vec![f64::from(frame.last)]);
            let (last, before) = done.rows.split_last().unwrap();
            assert!(last[0] == 1.0 && before.iter().all(|row| row[0] == 0.0), "{more}");
        }
    }
}

#[test]
fn more_steps_than_usual_may_be_asked_for() {
    let deck =
        format!("{PATH}{TRUSS}{ON_CROWN}").replace("time_step = 5.0", "time_step = 1e-5\nsteps = 100001\ngrowth = 1.0");
    assert_eq!(follow_to_the_end(&read(&deck), &[("crown", 2)]).counts.steps, 100_001);
}

/// A shallow arch; its limit lies near t = 0.014.
const ARCH: &str = r#"
title = "arch"
[analysis]
kind = "static"
control = "arc-length"
end_time = 1.0
time_step = STEP
stop = { at = "crown", quantity = "uz", value = -0.18 }
[materials.steel]
model = "elastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
[sections.s]
shape = "rectangle"
width = 0.03
height = 0.01
[points]
l = [-1.0, 0.0, 0.0]
q1 = [-0.5, 0.0, 0.075]
crown = [0.0, 0.0, 0.1]
q2 = [0.5, 0.0, 0.075]
r = [1.0, 0.0, 0.0]
[[beams]]
name = "arch"
path = ["l", "q1", "crown", "q2", "r"]
elements = 4
order = 2
material = "steel"
section = "s"
orientation = [0.0, 1.0, 0.0]
[[supports]]
at = ["l", "r"]
fix = "translations"
[[supports]]
at = ["l", "r"]
fix = ["rx", "rz"]
[[loads]]
at = "crown"
force = [0.0, 0.0, -100e3]
"#;

/// A first step beyond the limit point would land on another branch: it is cut, and the end is that of small steps. Both stand at
/// the same displacement; the rest is the tolerance of the iteration.
#[test]
fn a_first_step_beyond_the_limit_is_cut() {
    let end = |step: &str| {
        let done = follow_to_the_end(&read(&ARCH.replace("STEP", step)), &[("crown", 2)]);
        assert!((done.rows.last().unwrap()[1] + 0.18).abs() < 1e-12);
        (done.rows.last().unwrap()[0], done.rows.iter().map(|row| row[0]).fold(0.0, f64::max), done.counts.cuts)
    };
    let (slow, limit, none) = end("0.001");
    assert!(none == 0 && limit < 0.02);
    for step in ["0.05", "0.2"] {
        let (long, _, cuts) = end(step);
        assert!(cuts > 0 && (long - slow).abs() < 1e-8 * slow.abs(), "{long} {slow}");
    }
}

/// Steps of equal displacement: the load at the end of each is that of the closed form, also where it falls. Residuals are 1e-8 of the load.
#[test]
fn truss_is_pushed_by_its_displacement() {
    let moved =
        "control = \"displacement\"\nstop = { at = \"crown\", quantity = \"uz\", value = -0.8 }\nincrement = 0.02\n";
    let head = PATH.replace("control = \"arc-length\"\nend_time = 60.0\ntime_step = 5.0\n", moved);
    let done = follow_to_the_end(&read(&format!("{head}{TRUSS}{ON_CROWN}")), &[("crown", 2)]);
    assert_eq!(done.rows.len(), 40);
    for (k, row) in (1..).zip(&done.rows) {
        assert!((row[1] + 0.02 * f64::from(k)).abs() < 1e-9, "{k}: {row:?}");
        assert!((60.0 * row[0] - truss(-row[1])).abs() < 1e-5, "{k}: {row:?}");
    }
    assert_eq!(turns(&done.rows), 2);
}

/// Weight first, then a path to a displacement, then rest: the path ends at the load of the closed form, which stays in the stages after it, also
/// where one of them ends as planned. Loads that a displacement leads grow beyond their value, and a prescribed motion stops at its own.
#[test]
fn stages_follow_paths() {
    const ASIDE: &str = "[[bars]]\nname = \"strut\"\npath = [\"left\", \"aside\"]\naxial_stiffness = 1.0\nmass_per_length = 0.0\n\
                         [[supports]]\nat = \"aside\"\nfix = [\"ux\"]\n\
                         [[supports]]\nat = \"aside\"\nmotion = { uz = { to = 0.01 } }\n\
                         stages = [\"push\", \"rest\", \"end\"]\n";
    let stage =
        |name: &str, keys: &str| format!("[[stages]]\nname = \"{name}\"\nkind = \"static\"\nduration = 1.0\n{keys}\n");
    let stop = "stop = { at = \"crown\", quantity = \"uz\", value = -0.1 }";
    let expect = |at: &str, quantity: &str, stage: &str, value: f64| {
        format!(
            "[[expect]]\nat = \"{at}\"\nquantity = \"{quantity}\"\nstage = \"{stage}\"\nvalue = {value:?}\nabsolute_tolerance = 1e-7\n"
        )
    };
    let (moved, arc) = ("control = \"displacement\"\nincrement = 0.02", "control = \"arc-length\"\ntime_step = 0.05");
    // The path ends between 1.3 and 2 with loads of 60, and behind 2 with 6; the rest then ends as planned at 2.1.
    let early = "stop = { time = 2.1 }\n";
    let beside = "aside = [-1.0, 0.0, -5.0]\n";
    for (control, force, early) in [(moved, 60.0, early), (arc, 60.0, early), (moved, 6.0, "")] {
        let deck = stage("weight", "time_step = 0.5")
            + &stage("push", &format!("{control}\n{stop}"))
            + &stage("rest", &format!("time_step = 0.5\n{early}"))
            + &stage("end", "time_step = 0.5")
            + &TRUSS
                .replace("crown = [", &format!("{beside}crown = ["))
                .replace("[[bars]]", &format!("{ASIDE}[[bars]]"))
            + "[[loads]]\nat = \"crown\"\nforce = [0.0, 0.0, -10.0]\n"
            + &format!(
                "[[loads]]\nat = \"crown\"\nforce = [0.0, 0.0, -{force:?}]\nstages = [\"push\", \"rest\", \"end\"]\n"
            )
            + &expect("crown", "uz", "push", -0.1)
            + &expect("aside", "uz", "push", if force == 6.0 { 0.01 } else { 0.01 * (truss(0.1) - 10.0) / force })
            + &expect("crown", "uz", "end", -0.1)
            + &expect("analysis", "time", "push", 1.0 + (truss(0.1) - 10.0) / force)
            + &expect("crown", "uz", "rest", -0.1);
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("d.toml"), deck).unwrap();
        let mut command = assert_cmd::Command::cargo_bin("rdsolve").unwrap();
        command.current_dir(folder.path()).args(["d.toml", "--quiet"]).assert().code(0);
    }
}

/// A frame of two storeys under weight, whose columns and beams yield without hardening: its load falls while the roof moves on.
const FRAME: &str = r#"
[analysis]
kind = "static"
control = "arc-length"
end_time = 1.0
time_step = 0.02
stop = { at = "roof", quantity = "ux", value = 0.3 }
growth = 5.0
[materials.steel]
model = "elastic-plastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
yield_stress = 235e6
[sections.col]
shape = "i"
height = 0.2
width = 0.2
web_thickness = 0.009
flange_thickness = 0.015
[sections.beam]
shape = "i"
height = 0.3
width = 0.15
web_thickness = 0.007
flange_thickness = 0.0107
[points]
a = [0.0, 0.0, 0.0]
b = [0.0, 0.0, 4.0]
c = [6.0, 0.0, 4.0]
d = [6.0, 0.0, 0.0]
roof = [0.0, 0.0, 8.0]
e = [6.0, 0.0, 8.0]
[[beams]]
name = "left"
path = ["a", "b", "roof"]
elements = 8
material = "steel"
section = "col"
orientation = [1.0, 0.0, 0.0]
[[beams]]
name = "right"
path = ["d", "c", "e"]
elements = 8
material = "steel"
section = "col"
orientation = [1.0, 0.0, 0.0]
[[beams]]
name = "floor"
path = ["b", "c"]
elements = 8
material = "steel"
section = "beam"
orientation = [0.0, 1.0, 0.0]
[[beams]]
name = "top"
path = ["roof", "e"]
elements = 8
material = "steel"
section = "beam"
orientation = [0.0, 1.0, 0.0]
[[supports]]
at = ["a", "d"]
fix = "all"
[[loads]]
at = ["b", "c", "roof", "e"]
force = [0.0, 0.0, -300e3]
amplitude = "g"
[amplitudes.g]
kind = "constant"
[[loads]]
at = "roof"
force = [200e3, 0.0, 0.0]
[[loads]]
at = "b"
force = [100e3, 0.0, 0.0]
"#;

/// Fibres that begin to yield or unload cost iterations in steps of any length. Steps that followed them came to 0.284 in 3000.
#[test]
fn frame_without_hardening_does_not_creep() {
    let model = read(FRAME);
    assert_eq!(model.solution.iteration.tolerance, 1e-5);
    let done = follow_to_the_end(&model, &[("roof", 0)]);
    let last = done.rows.last().unwrap();
    assert!((last[1] - 0.3).abs() < 1e-9 && done.counts.steps < 200, "{last:?}");
    // By displacement the same path: loads at one displacement differ by the curvature of the chord over a step.
    let moved = FRAME.replace("arc-length\"\nend_time = 1.0\ntime_step = 0.02", "displacement\"\nincrement = 0.01");
    let moved = follow_to_the_end(&read(&moved.replace("growth = 5.0\n", "")), &[("roof", 0)]);
    assert!((moved.rows.last().unwrap()[0] - last[0]).abs() < 1e-3, "{last:?} {:?}", moved.rows.last());
}

/// A bar that yields with hardly any hardening lets the load creep on, and with it the elastic bar whose displacement is to end the path: by the
/// ratio of the moduli, 1e-6, a step.
#[test]
fn a_path_that_leads_nowhere_ends() {
    let text = "[analysis]\nkind = \"static\"\ncontrol = \"arc-length\"\nend_time = 1.0\ntime_step = 0.1\ngrowth = 1.0\n\
                stop = { at = \"r\", quantity = \"ux\", value = 0.0015 }\n[materials.weak]\nmodel = \"elastic-plastic\"\n\
                youngs_modulus = 1e3\npoisson_ratio = 0.3\nyield_stress = 1.0\nhardening_modulus = 1e-3\n[points]\na = [0.0, 0.0, 0.0]\n\
                p = [1.0, 0.0, 0.0]\nq = [0.0, 1.0, 0.0]\nr = [1.0, 1.0, 0.0]\n[[bars]]\nname = \"weak\"\npath = [\"a\", \"p\"]\narea = 1.0\n\
                material = \"weak\"\n[[bars]]\nname = \"strong\"\npath = [\"q\", \"r\"]\naxial_stiffness = 1e3\n[[supports]]\n\
                at = [\"a\", \"q\"]\nfix = \"translations\"\n[[supports]]\nat = [\"p\", \"r\"]\nfix = [\"uy\", \"uz\"]\n\
                [[loads]]\nat = [\"p\", \"r\"]\nforce = [2.0, 0.0, 0.0]\n";
    let done = follow(&read(text), &[("r", 0)]);
    let Outcome::Failed { failure, .. } = &done.outcome else { panic!("{:?}", done.outcome) };
    assert!(
        failure.to_string().contains("the path creeps: in 2000 steps the displacement has gone from 0.001"),
        "{failure}"
    );
    assert!(failure.to_string().contains("`control` = \"displacement\""), "{failure}");
}
