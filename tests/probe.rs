#![allow(non_snake_case)]
//! scratch
use rdsolve::amplitude::Amplitude;
use rdsolve::integrators::*;
use rdsolve::math::*;
use rdsolve::model::*;
use rdsolve::plan::Plan;
use rdsolve::sections::Stiffness;
use rdsolve::solve::*;
use rdsolve::system::System;
use std::sync::atomic::AtomicBool;

fn base(end: f64, dt: f64, interval: f64) -> Model {
    Model {
        title: "".into(),
        units: None,
        analysis: Analysis {
            kind: Kind::Dynamic,
            end_time: end,
            time_step: dt,
            least_step: dt * 1e-6,
            plane: std::env::var("NOPLANE").is_err(),
        },
        scheme: Scheme::WilsonTheta(WilsonTheta { theta: 1.4, rotation: RotationUpdate::Exponential }),
        iteration: Iteration {
            update: match std::env::var("UPD").as_deref() {
                Ok("it") => Update::Iteration,
                Ok("step") => Update::Step,
                Ok("never") => Update::Never,
                _ => Update::Auto,
            },
            tolerance: std::env::var("TOL").ok().and_then(|s| s.parse().ok()).unwrap_or(1e-8),
            limit: 30,
        },
        nodes: vec![],
        bodies: vec![],
        masses: vec![],
        stiffnesses: vec![],
        beams: vec![],
        bars: vec![],
        links: vec![],
        riders: vec![],
        held: vec![],
        amplitudes: vec![],
        loads: vec![],
        gravity: Vec3::zeros(),
        base_accelerations: vec![],
        damping: Damping::default(),
        expects: vec![],
        output: Output {
            nodes: vec![],
            cadence: Cadence::Interval(interval),
            energy: std::env::var("EN").is_ok(),
            links: false,
            reactions: false,
            sections: false,
            fields: None,
        },
    }
}
fn node(m: &mut Model, x: [f64; 3]) -> usize {
    m.nodes.push(Node {
        label: format!("n{}", m.nodes.len()),
        named: true,
        x: Vec3::from(x),
        v: Vec3::zeros(),
        omega: Vec3::zeros(),
    });
    m.nodes.len() - 1
}
fn stiff(EA: f64, GAy: f64, GAz: f64, GJ: f64, EIy: f64, EIz: f64, rho: f64, j: [f64; 3]) -> Stiffness {
    Stiffness {
        N: Mat3::from_diagonal(&Vec3::new(EA, GAy, GAz)),
        M: Mat3::from_diagonal(&Vec3::new(GJ, EIy, EIz)),
        NM: Mat3::zeros(),
        mass_per_length: rho,
        inertia_per_length: Mat3::from_diagonal(&Vec3::from(j)),
    }
}
fn beam(m: &mut Model, a: usize, b: usize, n: usize, order: usize, y: [f64; 3]) {
    let (xa, xb) = (m.nodes[a].x, m.nodes[b].x);
    let e1 = (xb - xa).normalize();
    let y = Vec3::from(y);
    let e3 = e1.cross(&y).normalize();
    let e2 = e3.cross(&e1);
    let frame = Mat3::from_columns(&[e1, e2, e3]);
    let lob = rdsolve::math::quadrature::lobatto(order + 1).0;
    let mut elements = vec![];
    let mut prev = a;
    for e in 0..n {
        let mut nodes = [0usize; 5];
        nodes[0] = prev;
        for k in 1..=order {
            let s = (e as f64 + 0.5 + 0.5 * lob[k]) / n as f64;
            nodes[k] = if e == n - 1 && k == order {
                b
            } else {
                let p = xa + (xb - xa) * s;
                node(m, [p.x, p.y, p.z])
            };
        }
        prev = nodes[order];
        elements.push(BeamElement { nodes, frame, section: m.stiffnesses.len() - 1 });
    }
    let mass = if std::env::var("CONS").is_ok() { MassKind::Consistent } else { MassKind::Lumped };
    m.beams.push(Beam { name: "b".into(), order, mass, rotary_inertia: true, elements });
}
fn fix(m: &mut Model, n: usize, dofs: &[usize]) {
    for &dof in dofs {
        m.held.push(Held { node: n, dof, motion: None });
    }
}
fn body(m: &mut Model, x: [f64; 3], mass: f64, J: [f64; 3]) -> usize {
    let n = node(m, x);
    m.bodies.push(Body {
        name: format!("b{n}"),
        node: n,
        mass,
        inertia: Mat3::from_diagonal(&Vec3::from(J)),
        shape: Shape::Sphere { radius: 1.0 },
    });
    n
}
struct Rec<'a> {
    get: Box<dyn Fn(&rdsolve::state::State) -> Vec<f64> + 'a>,
    rows: Vec<Vec<f64>>,
    e: Vec<f64>,
}
impl Observer for Rec<'_> {
    fn see(&mut self, f: &Frame) -> std::io::Result<()> {
        if f.due {
            self.rows.push((self.get)(f.state));
            if let Some(e) = f.energy {
                self.e.push(e.numerical);
            }
        }
        Ok(())
    }
}
fn run(m: &Model, name: &str, file: &str, label: &str, get: impl Fn(&rdsolve::state::State) -> Vec<f64>) -> f64 {
    let s = System::new(m).unwrap();
    let plan = Plan::new(m, &s, 1);
    let stop = AtomicBool::new(false);
    let mut best = f64::INFINITY;
    let mut err = 0.0;
    let mut c = Counts::default();
    let reps = std::env::var("REPS").ok().and_then(|s| s.parse().ok()).unwrap_or(1);
    let mut last = String::new();
    for _ in 0..reps {
        let mut rec = Rec { get: Box::new(&get), rows: vec![], e: vec![] };
        let mut r = Run::new(m, &s, &plan, Wanted { energy: m.output.energy, ..Default::default() }, &stop);
        let t0 = std::time::Instant::now();
        let (out, _) = r.run(&mut rec);
        best = f64::min(best, (t0.elapsed() - r.observing).as_secs_f64());
        c = r.counts;
        if let Outcome::Failed { time, failure } = &out {
            println!("FAILED {time} {failure}");
        }
        let csv = std::fs::read_to_string(format!("/work/shared/scenes/ref/{file}.csv")).unwrap();
        let reference: Vec<Vec<f64>> =
            csv.lines().skip(1).map(|l| l.split(',').skip(1).map(|x| x.parse().unwrap()).collect()).collect();
        let mut sum = 0.0;
        let mut max = 0.0f64;
        let mut n = 0;
        let skip = if file == "X1" { 10 } else { 0 };
        for (a, b) in rec.rows.iter().zip(&reference).skip(skip) {
            sum += a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
            n += 1;
            max = max.max(b.iter().map(|x| x * x).sum::<f64>().sqrt());
        }
        err = (sum / n as f64).sqrt() / max;
        if rec.rows.len() != reference.len() {
            last = format!("rows {} of {}", rec.rows.len(), reference.len());
        }
        if let Some(e) = rec.e.last() {
            last += &format!(" numerical {e:.3e}");
        }
    }
    println!(
        "{name:4} {label:30} unknowns {:4} e {err:.3e} loop {:8.5} s  steps {} it {:.2} fact {} us/it {:.2} us/step {:.2} {last}",
        plan.unknowns,
        best,
        c.steps,
        c.iterations as f64 / c.steps as f64,
        c.factorizations,
        best * 1e6 / c.iterations as f64,
        best * 1e6 / c.steps as f64
    );
    if std::env::var("PLAN").is_ok() {
        println!("{}", plan.explain(m, &s));
    }
    err
}
fn dts(grid: f64) -> Vec<f64> {
    let list = std::env::var("DIV").unwrap_or("1,2,4,8".into());
    list.split(',').map(|d| grid / d.parse::<f64>().unwrap()).collect()
}
fn meshes() -> Vec<(usize, usize)> {
    std::env::var("MESH")
        .unwrap_or("2x2,4x2,2x3,4x3".into())
        .split(',')
        .map(|s| {
            let (a, b) = s.split_once('x').unwrap();
            (a.parse().unwrap(), b.parse().unwrap())
        })
        .collect()
}
fn xyz(n: &rdsolve::state::Node) -> Vec<f64> {
    vec![n.x.x, n.x.y, n.x.z]
}

#[test]
fn b1() {
    for (n, order) in meshes() {
        for dt in dts(0.15) {
            let mut m = base(30.0, dt, 0.15);
            let (o, e, t) = (node(&mut m, [0., 0., 0.]), node(&mut m, [10., 0., 0.]), node(&mut m, [10., 10., 0.]));
            m.stiffnesses.push(stiff(1e6, 1e6, 1e6, 1e3, 1e3, 1e3, 1.0, [20., 10., 10.]));
            beam(&mut m, o, e, n, order, [0., 1., 0.]);
            beam(&mut m, e, t, n, order, [-1., 0., 0.]);
            fix(&mut m, o, &[0, 1, 2, 3, 4, 5]);
            m.amplitudes.push(Amplitude::Table { points: vec![[0., 0.], [1., 50.], [2., 0.]] });
            m.loads.push(Load {
                node: e,
                force: Vec3::new(0., 0., 1.),
                moment: Vec3::zeros(),
                follower: false,
                amplitude: Some(0),
            });
            run(&m, "B1", "B1", &format!("n {n} order {order} dt {dt:.5}"), |s| vec![s.nodes[e].x.z, s.nodes[t].x.z]);
        }
    }
}
#[test]
fn b2() {
    for (n, order) in meshes() {
        for dt in dts(0.05) {
            let mut m = base(10.0, dt, 0.05);
            let (a, mid, b) = (node(&mut m, [6., 0., 0.]), node(&mut m, [3., 4., 0.]), node(&mut m, [0., 8., 0.]));
            m.stiffnesses.push(stiff(1e4, 1e4, 1e4, 500., 500., 500., 1.0, [10., 10., 10.]));
            beam(&mut m, a, mid, n, order, [0., 0., 1.]);
            beam(&mut m, mid, b, n, order, [0., 0., 1.]);
            m.amplitudes.push(Amplitude::Table { points: vec![[0., 0.], [2.5, 200.], [5., 0.]] });
            m.loads.push(Load {
                node: a,
                force: Vec3::new(0.1, 0., 0.),
                moment: Vec3::new(0., -0.5, -1.),
                follower: false,
                amplitude: Some(0),
            });
            run(&m, "B2", "B2", &format!("n 2*{n} order {order} dt {dt:.5}"), |s| {
                [a, mid, b].iter().flat_map(|&i| xyz(&s.nodes[i])).collect()
            });
        }
    }
}
#[test]
fn c1() {
    for (n, order) in meshes() {
        for dt in dts(0.01) {
            let mut m = base(2.0, dt, 0.01);
            let (o, t) = (node(&mut m, [0., 0., 0.]), node(&mut m, [1., 0., 0.]));
            let (rho, iy, iz) = (7850.0, 0.03 * 0.005f64.powi(3) / 12.0, 0.005 * 0.03f64.powi(3) / 12.0);
            m.stiffnesses.push(stiff(
                3.15e7,
                1.009615e7,
                1.009615e7,
                90.35639,
                65.625,
                2362.5,
                1.1775,
                [rho * (iy + iz), rho * iy, rho * iz],
            ));
            beam(&mut m, o, t, n, order, [0., 1., 0.]);
            fix(&mut m, o, &[0, 1, 2, 3, 4, 5]);
            let b = body(&mut m, [1.1, 0.05, 0.], 2.0, [0.02, 0.01, 0.015]);
            m.riders.push(Rider { node: t, master: b, dofs: [true; 6] });
            m.gravity = Vec3::new(0., 0., -9.81);
            run(&m, "C1", "C1", &format!("n {n} order {order} dt {dt:.5}"), |s| {
                [b, t].iter().flat_map(|&i| xyz(&s.nodes[i])).collect()
            });
        }
    }
}
#[test]
fn c2() {
    for (n, order) in meshes() {
        for dt in dts(0.015) {
            let mut m = base(3.0, dt, 0.015);
            let hub = body(&mut m, [0., 0., 0.], 5.0, [0.05, 0.05, 0.1]);
            let p: Vec<usize> = [0.2, 2.2, -0.2, -2.2].iter().map(|&x| node(&mut m, [x, 0., 0.])).collect();
            let (rho, iy, iz) = (2700.0, 0.004 * 0.04f64.powi(3) / 12.0, 0.04 * 0.004f64.powi(3) / 12.0);
            m.stiffnesses.push(stiff(
                1.12e7,
                3.508772e6,
                3.508772e6,
                21.04084,
                1493.333,
                14.93333,
                0.432,
                [rho * (iy + iz), rho * iy, rho * iz],
            ));
            beam(&mut m, p[0], p[1], n, order, [0., 1., 0.]);
            beam(&mut m, p[2], p[3], n, order, [0., 1., 0.]);
            fix(&mut m, hub, &[0, 1, 2, 3, 4]);
            for i in [0, 2] {
                m.riders.push(Rider { node: p[i], master: hub, dofs: [true; 6] });
            }
            m.amplitudes.push(Amplitude::SineSquared { angular_frequency: std::f64::consts::PI, start: 0.0, end: 1.0 });
            m.loads.push(Load {
                node: hub,
                force: Vec3::zeros(),
                moment: Vec3::new(0., 0., 60.),
                follower: false,
                amplitude: Some(0),
            });
            let angle = std::cell::RefCell::new(0.0f64);
            run(&m, "C2", "C2", &format!("n {n} order {order} dt {dt:.5}"), |s| {
                let mut a = angle.borrow_mut();
                if s.time == 0.0 {
                    *a = 0.0
                }
                let q = s.nodes[hub].q;
                let z = 2.0 * q.k.atan2(q.w);
                *a = z + ((*a - z) / (2.0 * std::f64::consts::PI)).round() * 2.0 * std::f64::consts::PI;
                vec![*a, s.nodes[p[1]].x.x, s.nodes[p[1]].x.y, s.nodes[p[3]].x.x, s.nodes[p[3]].x.y]
            });
        }
    }
}
#[test]
fn r1() {
    for dt in dts(0.25) {
        let mut m = base(50.0, dt, 0.25);
        let b = body(&mut m, [0., 0., 0.], 1.0, [1., 2., 3.]);
        m.nodes[b].omega = Vec3::new(0.01, 1., 0.01);
        run(&m, "R1", "R1", &format!("dt {dt:.5}"), |s| {
            let n = &s.nodes[b];
            let R = n.R();
            let w = R.tr_mul(&n.omega);
            w.iter().chain(R.iter()).copied().collect()
        });
    }
}
#[test]
fn r3() {
    for dt in dts(0.025) {
        let mut m = base(5.0, dt, 0.025);
        let a = body(&mut m, [0., 0., 0.], 100.0, [8., 12., 15.]);
        let b = body(&mut m, [1., 0., 0.], 10.0, [0.2, 0.3, 0.4]);
        m.nodes[a].omega = Vec3::new(0.5, 0., 2.);
        m.nodes[b].omega = Vec3::new(0., 3., -1.);
        m.nodes[b].v = Vec3::new(1., 0.5, 0.);
        for (p, q) in [
            ([0.4, 0.2, 0.1], [0.8, 0.1, 0.05]),
            ([0.4, -0.2, 0.1], [0.8, -0.1, 0.05]),
            ([0.4, 0., -0.2], [0.8, 0., -0.1]),
        ] {
            let (p, q) = (node(&mut m, p), node(&mut m, q));
            m.riders.push(Rider { node: p, master: a, dofs: [true; 6] });
            m.riders.push(Rider { node: q, master: b, dofs: [true; 6] });
            let free = (m.nodes[p].x - m.nodes[q].x).norm();
            m.links.push(Link {
                name: "l".into(),
                ends: [p, q],
                kind: LinkKind::Line {
                    law: rdsolve::elements::link::Law::Linear { stiffness: 2e4, preload: 0.0 },
                    damping: 50.0,
                    direction: None,
                    free_length: free,
                },
            });
        }
        run(&m, "R3", "R3", &format!("dt {dt:.5}"), |s| {
            let w = |i: usize| {
                let n = &s.nodes[i];
                n.R().tr_mul(&n.omega)
            };
            xyz(&s.nodes[a])
                .into_iter()
                .chain(xyz(&s.nodes[b]))
                .chain(w(a).iter().copied())
                .chain(w(b).iter().copied())
                .collect()
        });
    }
}
#[test]
fn x1() {
    for dt in dts(0.261799387799149) {
        let mut m = base(20.0 * std::f64::consts::PI / 1.2, dt, 20.0 * std::f64::consts::PI / 1.2 / 200.0);
        let p: Vec<usize> = (0..3).map(|i| node(&mut m, [i as f64, 0., 0.])).collect();
        for (i, k) in [(0, 1e7), (1, 1.0)] {
            m.links.push(Link {
                name: "l".into(),
                ends: [p[i], p[i + 1]],
                kind: LinkKind::Line {
                    law: rdsolve::elements::link::Law::Linear { stiffness: k, preload: 0.0 },
                    damping: 0.0,
                    direction: Some(Vec3::new(1., 0., 0.)),
                    free_length: 1.0,
                },
            });
            m.masses.push(Mass { node: p[i + 1], mass: 1.0, inertia: Mat3::zeros() });
        }
        m.amplitudes.push(Amplitude::Sine { angular_frequency: 1.2, phase: 0.0, start: 0.0, end: 1e9 });
        m.held.push(Held {
            node: p[0],
            dof: 0,
            motion: Some(Motion { amplitude: 0, scale: 1.0, history: History::Displacement }),
        });
        fix(&mut m, p[0], &[1, 2, 3, 4, 5]);
        run(&m, "X1", "X1", &format!("dt {dt:.5}"), |s| {
            let n = &s.nodes;
            if std::env::var("SHOW").is_ok() {
                println!("{} v2 {} a2 {} u3 {}", s.time, n[1].v.x, n[1].a.x, n[2].x.x - 2.0);
            }
            vec![n[1].x.x - 1.0, n[2].x.x - 2.0, n[1].v.x, n[2].v.x, n[1].a.x, n[2].a.x]
        });
    }
}
#[test]
fn x2() {
    for dt in dts(0.2066761) {
        let mut m = base(41.33522, dt, if std::env::var("SHOW").is_ok() { dt } else { 0.2066761 });
        let p: Vec<usize> = [0.0, 3.0443].iter().map(|&x| node(&mut m, [x, 0., 0.])).collect();
        m.bars.push(Bar {
            name: "bar".into(),
            axial_stiffness: 1e10,
            mass_per_length: 0.0,
            mass: MassKind::None,
            tension_only: false,
            elements: vec![[0, 1]],
        });
        m.masses.push(Mass { node: p[1], mass: 3.0, inertia: Mat3::zeros() });
        fix(&mut m, p[0], &[0, 1, 2, 3, 4, 5]);
        m.gravity = Vec3::new(0., 0., -9.8);
        run(&m, "X2", "X2", &format!("dt {dt:.5}"), |s| {
            if std::env::var("SHOW").is_ok() {
                let n = &s.nodes[p[1]];
                println!(
                    "{} {:?} l {} v {:?} a {:?}",
                    s.time,
                    n.x.as_slice(),
                    n.x.norm() / 3.0443 - 1.0,
                    n.v.as_slice(),
                    n.a.as_slice()
                );
            }
            vec![s.nodes[p[1]].x.x, s.nodes[p[1]].x.z]
        });
    }
}
