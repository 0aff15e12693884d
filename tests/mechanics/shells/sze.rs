//! Every row of the tables of Sze, Liu & Lo (Finite Elem. Anal. Des. 40, 2004) on the published meshes, on the same with nodes
//! moved at random by a fifth of an element, and on both cut into triangles.
//!
//! The tables are solutions by other elements on these meshes, with an error of their own. The error of a row is that of
//! its displacements over the largest of their column or, where the path turns, the distance of its point from the path in
//! the plane of load and displacements, each over its largest value.

use super::benchmarks::{annulus, check, fix, hemisphere, load, pinched_cylinder, point, read, semi_cylinder, shell};
use super::sze_tables::{ANNULUS, CYLINDER, HEMISPHERE, MOMENT, ROOF, SEMI_CYLINDER, SHEAR, THIN_ROOF};
use crate::support;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rdsolve::math::Vec3;
use rdsolve::model::{Model, Shell};
use rdsolve::plan::Plan;
use rdsolve::solve::{Frame, Observer, Outcome, Run};
use rdsolve::system::System;
use std::io;
use std::sync::atomic::AtomicBool;

/// The undeformed surface by two coordinates.
struct Chart {
    /// Coordinates of a point.
    of: fn(&Vec3) -> [f64; 2],
    /// Point and normal.
    at: fn([f64; 2]) -> (Vec3, Vec3),
    /// Size of an element.
    size: [f64; 2],
    /// Whether nodes inside move along each coordinate, and those at the edges along it.
    moves: [bool; 2],
    edges_move: bool,
}

impl Chart {
    /// Moves nodes at random by up to a fifth of an element along each coordinate.
    fn shuffle(&self, model: &mut Model, seed: u64) {
        let mut rng = StdRng::seed_from_u64(seed);
        let places: Vec<[f64; 2]> = model.nodes.iter().map(|node| (self.of)(&node.x)).collect();
        let ends = [0, 1].map(|i| {
            let all = places.iter().map(|place| place[i]);
            [all.clone().fold(f64::INFINITY, f64::min), all.fold(f64::NEG_INFINITY, f64::max)]
        });
        let mut normals = vec![Vec3::zeros(); places.len()];
        for ((node, place), normal) in model.nodes.iter_mut().zip(&places).zip(&mut normals) {
            let at_end = [0, 1].map(|i| ends[i].iter().any(|end| (end - place[i]).abs() < 1e-6 * self.size[i]));
            let shift = [0, 1].map(|i| 0.2 * self.size[i] * rng.random_range(-1.0..1.0));
            let free = [0, 1].map(|i| self.moves[i] && !at_end[i] && (self.edges_move || !at_end[1 - i]));
            let moved = [0, 1].map(|i| if free[i] { place[i] + shift[i] } else { place[i] });
            let (x, n) = (self.at)(moved);
            if free.contains(&true) {
                node.x = x;
            }
            *normal = n;
        }
        for element in model.each_mut::<Shell>().flat_map(|shell| &mut shell.elements) {
            for a in 0..4 {
                let new = normals[element.nodes[a]];
                let flips = new.dot(&element.normals[a]) < 0.0;
                element.normals[a] = if flips { -new } else { new };
            }
        }
    }
}

fn flat(size: [f64; 2]) -> Chart {
    // Strips of one element across have no nodes inside: those on their sides move along them.
    Chart {
        of: |x| [x.x, x.y],
        at: |[u, v]| (Vec3::new(u, v, 0.0), Vec3::z()),
        size,
        moves: [true, false],
        edges_move: true,
    }
}

/// About the axis y, angle from z.
fn cylinder<const RADIUS_MM: usize>(size: [f64; 2]) -> Chart {
    Chart {
        of: |x| [x.x.atan2(x.z), x.y],
        at: |[angle, y]| {
            let (sin, cos) = angle.sin_cos();
            let r = RADIUS_MM as f64 * 1e-3;
            (Vec3::new(r * sin, y, r * cos), Vec3::new(sin, 0.0, cos))
        },
        size,
        moves: [true; 2],
        edges_move: false,
    }
}

fn ring(size: [f64; 2]) -> Chart {
    Chart {
        // The slit is at angle zero: the last edge has a full turn.
        of: |x| [x.x.hypot(x.y), x.y.atan2(x.x).rem_euclid(std::f64::consts::TAU)],
        at: |[r, angle]| (Vec3::new(r * angle.cos(), r * angle.sin(), 0.0), Vec3::z()),
        size,
        moves: [true; 2],
        edges_move: false,
    }
}

fn sphere(size: [f64; 2]) -> Chart {
    Chart {
        of: |x| [x.y.atan2(x.x), x.z.atan2(x.x.hypot(x.y))],
        at: |[along, up]| {
            let n = Vec3::new(up.cos() * along.cos(), up.cos() * along.sin(), up.sin());
            (10.0 * n, n)
        },
        size,
        moves: [true; 2],
        edges_move: false,
    }
}

/// Load and displacements after every accepted step.
struct Path<'a> {
    of: &'a dyn Fn(&Frame) -> Vec<f64>,
    rows: Vec<Vec<f64>>,
}

impl Observer for Path<'_> {
    fn on_step(&mut self, frame: &Frame) -> io::Result<()> {
        self.rows.push((self.of)(frame));
        Ok(())
    }

    fn restart(&mut self, _: &Model) -> io::Result<()> {
        self.rows.clear();
        Ok(())
    }
}

/// Rows of load and displacements `at` named points, on every step; None where the run fails.
fn follow(model: &Model, at: &[(&str, usize, f64)], held: Option<(&str, f64)>) -> Option<Vec<Vec<f64>>> {
    let places: Vec<(usize, usize, f64, f64)> = at
        .iter()
        .map(|&(label, dof, sign)| {
            let node = support::node(model, label);
            (node, dof, sign, model.nodes[node].x[dof])
        })
        .collect();
    let held = held.map(|(label, scale)| {
        let node = support::node(model, label);
        (model.constraints.restraints.iter().position(|h| h.node == node && h.dof == 2).unwrap(), scale)
    });
    let of = |frame: &Frame| {
        let load = held.map_or(frame.state.time, |(held, scale)| -frame.reactions[held] / scale);
        let u = places.iter().map(|&(node, dof, sign, x)| sign * (frame.state.nodes[node].x[dof] - x));
        std::iter::once(load).chain(u).collect()
    };
    let system = System::new(model).expect("a system");
    let plan = Plan::new(model, &system, 1);
    let stop = AtomicBool::new(false);
    let mut path = Path { of: &of, rows: Vec::new() };
    let mut run = Run::new(model, &system, &plan, rdsolve::output::wanted(model), &stop).unwrap();
    let began = std::time::Instant::now();
    let (outcome, _) = run.run(&mut path);
    println!("{}: {} rows, {:?}, {:.1} s", model.title, path.rows.len(), run.counts(), began.elapsed().as_secs_f64());
    if !matches!(outcome, Outcome::Done) {
        println!("{}: {outcome:?} at {:?}", model.title, path.rows.last());
        return None;
    }
    Some(path.rows)
}

/// Largest of each column.
fn scales<const C: usize>(table: &[[f64; C]]) -> [f64; C] {
    std::array::from_fn(|i| table.iter().fold(0.0, |most, row| f64::max(most, row[i].abs())))
}

/// Error of the worst row, and its load: between rows of the path by straight lines in the load.
fn by_load<const C: usize>(path: &[Vec<f64>], table: &[[f64; C]]) -> [f64; 2] {
    let scale = scales(table);
    let error = |row: &[f64; C]| {
        let after = path.iter().position(|at| at[0] > row[0] - 1e-9).expect("a load that was reached");
        assert!((path[after][0] - row[0]).abs() < 1e-6, "no step ends at {}", row[0]);
        (1..C).map(|i| (path[after][i] - row[i]).abs() / scale[i]).fold(0.0, f64::max)
    };
    table.iter().map(|row| [error(row), row[0]]).max_by(|a, b| a[0].total_cmp(&b[0])).unwrap()
}

/// Distance from the path of the row farthest from it, and its load.
fn by_path<const C: usize>(path: &[Vec<f64>], table: &[[f64; C]]) -> [f64; 2] {
    let scale = scales(table);
    let distance = |row: &[f64; C]| {
        let part = |a: &[f64], b: &[f64]| {
            let e: Vec<f64> = (0..C).map(|i| (b[i] - a[i]) / scale[i]).collect();
            let r: Vec<f64> = (0..C).map(|i| (row[i] - a[i]) / scale[i]).collect();
            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let t = (dot(&r, &e) / dot(&e, &e).max(1e-30)).clamp(0.0, 1.0);
            r.iter().zip(&e).map(|(r, e)| (r - t * e).powi(2)).sum::<f64>().sqrt()
        };
        path.windows(2).map(|pair| part(&pair[0], &pair[1])).fold(f64::INFINITY, f64::min)
    };
    // Beyond the full load no path goes.
    let kept = table.iter().filter(|row| row[0].abs() <= 1.0);
    kept.map(|row| [distance(row), row[0]]).max_by(|a, b| a[0].total_cmp(&b[0])).unwrap()
}

fn strip(kind: &str, length: f64, n: usize, load: &str) -> String {
    let mut body = String::from("[points]\n");
    for (name, x) in [("a", [0.0, 0.0]), ("b", [length, 0.0]), ("c", [length, 1.0]), ("d", [0.0, 1.0])] {
        body += &point(name, [x[0], x[1], 0.0]);
    }
    body += &shell("strip", "a b c d", [n, 1], kind, "");
    body += &fix("strip.edge4", "ux uy uz rx ry rz");
    super::benchmarks::deck("strip", 20, [1.2e6, 0.0, 0.1], &(body + load))
}

fn roof(kind: &str, n: usize, h: f64) -> String {
    let (s, c) = 0.1f64.sin_cos();
    let mut body = String::from("[points]\n");
    body += &point("crown", [0.0, 0.0, 2540.0]);
    body += &point("end_crown", [0.0, 254.0, 2540.0]);
    body += &point("end", [2540.0 * s, 254.0, 2540.0 * c]);
    body += &point("edge", [2540.0 * s, 0.0, 2540.0 * c]);
    body += &shell("roof", "crown end_crown end edge", [n, n], kind, "kind = \"cylinder\", axis = [0.0, 1.0, 0.0]");
    body += &fix("roof.edge1", "ux ry rz");
    body += &fix("roof.edge4", "uy rx rz");
    body += &fix("roof.edge3", "ux uy uz");
    body += &load("crown", "force", [0.0, 0.0, -750.0]);
    super::benchmarks::deck("roof", 40, [3102.75, 0.3, h], &body)
        .replace("kind = \"static\"", "kind = \"static\"\ncontrol = \"arc-length\"\ngrowth = 1.0")
}

/// The eight problems: error of the worst row of a table, and the load there, on the published mesh times `finer`, and the path. None where
/// the run fails.
pub fn row(name: &str, kind: &str, seed: Option<u64>, finer: usize) -> Option<([f64; 2], Vec<Vec<f64>>)> {
    use std::f64::consts::{FRAC_PI_2, TAU};
    let n = |published: usize| published * finer;
    let up = 72f64.to_radians();
    let per = |length: f64, elements: usize| length / elements as f64;
    let (text, chart) = match name {
        "shear" => (
            strip(kind, 10.0, n(16), "[[loads]]\nat = \"strip.edge2\"\nforce_per_length = [0.0, 0.0, 4.0]\n"),
            flat([per(10.0, n(16)), 1.0]),
        ),
        "moment" => (
            strip(kind, 12.0, n(16), "[[loads]]\nat = [\"b\", \"c\"]\nmoment = [0.0, -26.179938779914945, 0.0]\n"),
            flat([per(12.0, n(16)), 1.0]),
        ),
        "annulus" => (annulus(kind, n(10), n(80)), ring([per(4.0, n(10)), per(TAU, n(80))])),
        "hemisphere" => (hemisphere(kind, n(16), 0.04, 200.0, 20), sphere([per(FRAC_PI_2, n(16)), per(up, n(16))])),
        "cylinder" => (
            pinched_cylinder(kind, n(40), 240).replace("force = [0.0, 0.0, -3000.0]", "force = [0.0, 0.0, 0.0]")
                + "[[supports]]\nat = \"crown\"\nmotion = { uz = { amplitude = \"down\", scale = -84.0 } }\n\
                   [amplitudes.down]\nkind = \"ramp\"\nend = 1.0\n",
            cylinder::<100_000>([per(FRAC_PI_2, n(40)), per(100.0, n(40))]),
        ),
        "semi-cylinder" => {
            (semi_cylinder(kind, n(40), 40), cylinder::<101_600>([per(FRAC_PI_2, n(40)), per(304.8, n(40))]))
        }
        "roof" => (roof(kind, n(16), 12.7), cylinder::<2_540_000>([per(0.1, n(16)), per(254.0, n(16))])),
        "thin roof" => (roof(kind, n(16), 6.35), cylinder::<2_540_000>([per(0.1, n(16)), per(254.0, n(16))])),
        _ => panic!("no row {name}"),
    };
    let mut model = read(&text);
    model.title = format!("{name} {kind} {seed:?}");
    if let Some(seed) = seed {
        chart.shuffle(&mut model, seed);
    }
    model.output.reactions = name == "cylinder";
    let (at, held): (&[(&str, usize, f64)], _) = match name {
        "shear" | "moment" => (&[("b", 0, -1.0), ("b", 2, 1.0)], None),
        "annulus" => (&[("i4", 2, 1.0), ("o4", 2, 1.0)], None),
        "hemisphere" => (&[("b", 1, 1.0), ("a", 0, -1.0)], None),
        "cylinder" => (&[("crown", 2, -1.0), ("side", 0, 1.0)], Some(("crown", 3000.0))),
        _ => (&[("crown", 2, -1.0)], None),
    };
    let path = follow(&model, at, held)?;
    let worst = match name {
        "shear" => by_load(&path, &SHEAR),
        "moment" => by_load(&path, &MOMENT),
        "annulus" => by_load(&path, &ANNULUS),
        "hemisphere" => by_load(&path, &HEMISPHERE),
        "semi-cylinder" => by_load(&path, &SEMI_CYLINDER),
        "cylinder" => by_path(&path, &CYLINDER),
        "roof" => by_path(&path, &ROOF),
        _ => by_path(&path, &THIN_ROOF),
    };
    Some((worst, path))
}

/// The worst row of a table in per cent of its largest value, on the published mesh and with moved nodes (of the hemisphere the worse of two draws):
/// quadrilaterals, then triangles. Asked for are 1 on regular quadrilaterals and 2 elsewhere. The table of the hemisphere itself is 0.6 off the limit of fine meshes.
/// Returns the paths of both kinds on the published mesh. Nodes of the large meshes move if `RDSOLVE_LONG` is set.
fn is_met(name: &str, bounds: [f64; 4]) -> [Vec<Vec<f64>>; 2] {
    let mut regular = Vec::new();
    let moved = match name {
        "shear" | "moment" => &[Some(1)][..],
        _ if std::env::var_os("RDSOLVE_LONG").is_none() => &[],
        "hemisphere" => &[Some(1), Some(2)],
        _ => &[Some(1)],
    };
    let cases = ["quadrilateral", "triangle"].into_iter().flat_map(|kind| [(kind, &[None][..]), (kind, moved)]);
    let found: Vec<f64> = cases
        .map(|(kind, draws)| {
            let worst = |seed: &Option<u64>| {
                let ([error, _], path) = row(name, kind, *seed, 1).expect("the end of the path");
                if seed.is_none() {
                    regular.push(path);
                }
                100.0 * error
            };
            draws.iter().map(worst).fold(0.0, f64::max)
        })
        .collect();
    println!("{name}: {found:.2?} %");
    assert!(found.iter().zip(bounds).all(|(error, bound)| *error < bound), "{name}: {found:?} %, not {bounds:?}");
    regular.try_into().expect("two kinds")
}

/// Compares a path with rows of a table, load and displacements, each within a part of itself.
fn is_close(name: &str, path: &[Vec<f64>], rows: &[&[f64]], tolerance: f64) {
    for row in rows {
        let at = path.iter().find(|at| (at[0] - row[0]).abs() < 1e-6).expect("a load that was reached");
        at.iter().zip(*row).skip(1).for_each(|(found, wanted)| check(name, *found, *wanted, tolerance));
    }
}

#[test]
fn every_row_of_cantilevers() {
    is_met("shear", [0.2, 0.2, 0.2, 0.2]);
    is_met("moment", [0.2, 0.5, 0.2, 0.5]);
}

#[test]
fn every_row_of_the_annulus() {
    let [quadrilaterals, triangles] = is_met("annulus", [1.0, 1.0, 1.5, 2.0]);
    // The table is of these meshes too and itself not converged.
    let rows: [&[f64]; 3] = [&[0.25, 7.602, 10.288], &[0.5, 10.468, 13.768], &[1.0, 13.891, 17.528]];
    is_close("quadrilaterals", &quadrilaterals, &rows, 0.01);
    is_close("triangles", &triangles, &rows, 0.05);
}

#[test]
fn every_row_of_the_hemisphere() {
    is_met("hemisphere", [0.8, 2.0, 2.1, 2.1]);
}

#[test]
fn every_row_of_the_semi_cylinder() {
    let [quadrilaterals, triangles] = is_met("semi-cylinder", [1.0, 1.0, 1.0, 1.0]);
    let rows: [&[f64]; 4] = [&[0.1, 16.100], &[0.25, 48.537], &[0.5, 132.653], &[1.0, 171.505]];
    is_close("quadrilaterals", &quadrilaterals, &rows, 0.012);
    is_close("triangles", &triangles, &rows, 0.02);
}

#[test]
fn every_row_of_roofs() {
    is_met("roof", [1.0, 1.0, 1.0, 1.0]);
    is_met("thin roof", [1.0, 1.0, 1.0, 1.0]);
}
