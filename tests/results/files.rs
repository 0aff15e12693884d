//! The files of the output folder, read back.

use crate::scene;
use crate::support::grid::Grid;
use rdsolve::model::{Cadence, Expect, ExpectAt, FieldFiles, FieldFormat, Model, PartIndex, PartKind, Tolerance, When};
use rdsolve::output::collected::{Collected, CollectedWhen, collect};
use rdsolve::output::expect::{Expectations, quantities};
use rdsolve::output::{Files, RunKeeps, TABLES};
use rdsolve::solve::Observer;
use std::fs;
use std::path::Path;

/// Shows steps `from..=to` of ten to an observer.
fn show(observer: &mut dyn Observer, model: &Model, from: usize, to: usize) {
    for step in from..=to {
        let state = scene::state(model, step as f64 / 10.0);
        let extras = scene::Extras::at(state.time);
        observer.on_step(&extras.frame(model, &state, step)).unwrap();
    }
}

fn run(dir: &Path, model: &Model) {
    let mut files = Files::open(dir, model).unwrap();
    show(&mut files, model, 0, 10);
    files.finish().unwrap();
}

fn table(dir: &Path, name: &str) -> (Vec<String>, Vec<Vec<String>>) {
    let mut reader = csv::Reader::from_path(dir.join(name)).unwrap();
    let header = reader.headers().unwrap().iter().map(String::from).collect();
    (header, reader.records().map(|row| row.unwrap().iter().map(String::from).collect()).collect())
}

#[test]
fn headers_are_those_of_the_interface() {
    let dir = tempfile::tempdir().unwrap();
    run(dir.path(), &scene::model());
    for (name, header) in [
        ("nodes.csv", "step,time,node,x,y,z,ux,uy,uz,rx,ry,rz,vx,vy,vz,wx,wy,wz,ax,ay,az,alphax,alphay,alphaz"),
        ("bodies.csv", "step,time,body,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz,ax,ay,az,alphax,alphay,alphaz"),
        (
            "energy.csv",
            "step,time,kinetic,strain,plastic,viscoplastic,damping,links,contact,friction,impact,external,numerical,mechanical,px,py,pz,lx,ly,lz",
        ),
        ("links.csv", "step,time,link,elongation,rate,force,fx,fy,fz,mx,my,mz"),
        ("contacts.csv", "step,time,contact,touching,slipping,gap,fx,fy,fz,mx,my,mz"),
        ("contact_pairs.csv", "step,time,contact,surface,with,touching,fx,fy,fz,mx,my,mz"),
        ("reactions.csv", "step,time,node,direction,value"),
        (
            "sections.csv",
            "step,time,beam,element,point,s,N,Vy,Vz,T,My,Mz,plastic_strain,sigma_max,sigma_min,tau_max,von_mises",
        ),
        ("steps.csv", "step,time,dt,iterations,refactorizations,residual,cuts"),
    ] {
        let text = fs::read_to_string(dir.path().join(name)).unwrap();
        assert_eq!(text.lines().next(), Some(header), "{name}");
        assert!(text.ends_with('\n') && !text.contains("NaN") && !text.contains("inf"), "{name}");
    }
}

#[test]
fn rows_are_the_frames_to_the_last_bit() {
    let dir = tempfile::tempdir().unwrap();
    let model = scene::model();
    run(dir.path(), &model);
    let (header, rows) = table(dir.path(), "nodes.csv");
    assert_eq!(rows.len(), 6 * 2, "six due steps, two nodes");
    for (i, row) in rows.iter().enumerate() {
        let step = 2 * (i / 2);
        let node = model.output.nodes[i % 2];
        let state = scene::state(&model, step as f64 / 10.0);
        let now = &state.nodes[node];
        assert_eq!(row[..3], [step.to_string(), format!("{:?}", state.time), model.nodes[node].label.clone()]);
        let value = |name: &str| row[header.iter().position(|h| h == name).unwrap()].parse::<f64>().unwrap();
        for (names, vector) in [
            (["x", "y", "z"], now.x),
            (["ux", "uy", "uz"], now.x - model.nodes[node].x),
            (["vx", "vy", "vz"], now.v),
            (["wx", "wy", "wz"], now.omega),
            (["ax", "ay", "az"], now.a),
            (["alphax", "alphay", "alphaz"], now.alpha),
        ] {
            assert!((0..3).all(|k| value(names[k]).to_bits() == vector[k].to_bits()), "{names:?} at step {step}");
        }
        let angle = ["rx", "ry", "rz"].map(value).iter().map(|r| r * r).sum::<f64>().sqrt();
        assert!(angle <= std::f64::consts::PI * (1.0 + 1e-15), "principal rotation vector");
    }
    let (header, rows) = table(dir.path(), "bodies.csv");
    let qw = header.iter().position(|name| name == "qw").unwrap();
    assert_eq!(rows.len(), 6 * 4);
    assert!(rows.iter().all(|row| row[qw].parse::<f64>().unwrap() >= 0.0));
    let steps: Vec<(String, String)> =
        table(dir.path(), "steps.csv").1.iter().map(|row| (row[0].clone(), row[3].clone())).collect();
    // Every second step is due; each took three iterations.
    let six = |step: &str| (step.to_owned(), "6".to_owned());
    assert_eq!(steps, ["2", "4", "6", "8", "10"].map(six));
    assert_eq!(table(dir.path(), "reactions.csv").1[1][2..], ["node[0]", "rz", "-1.0"]);
    assert_eq!(table(dir.path(), "sections.csv").1[1][2..6], ["fore & aft", "0", "1", "0.5"]);
    assert_eq!(table(dir.path(), "links.csv").1[0][2..6], ["bumper", "0.1", "-1.0", "7.0"]);
    assert_eq!(table(dir.path(), "contacts.csv").1[0][2..6], ["seat", "2", "1", "-0.001"]);
    let pairs = table(dir.path(), "contact_pairs.csv").1;
    assert_eq!(pairs[0][2..6], ["seat", "arm", "body 0", "1"]);
    assert_eq!(pairs[1][2..6], ["seat", "arm", "body 1", "2"]);
    assert_eq!(pairs.len(), 6 * 2);
}

/// The numbers that a search finds in the rows of a run that is interrupted are those that it reads in the files of a whole run: every column, by
/// the first key of each row and by all of them, at the peaks and at a time. Without files the folder is not even made.
#[test]
fn collected_numbers_are_those_of_the_files() {
    let dir = tempfile::tempdir().unwrap();
    let model = scene::model();
    run(dir.path(), &model);
    let mut wanted = Vec::new();
    for kind in TABLES.iter().filter(|kind| dir.path().join(kind.file).exists()) {
        let (header, rows) = table(dir.path(), kind.file);
        let is_key = |place: &usize| kind.columns().any(|column| column.is_key() && column.name == header[*place]);
        let keys: Vec<usize> = (0..header.len()).filter(is_key).collect();
        let mut subjects: Vec<String> = rows
            .iter()
            .flat_map(|row| {
                [keys.iter().take(1), keys.iter().take(9)]
                    .map(|keys| keys.map(|&key| row[key].as_str()).collect::<Vec<_>>().join(" "))
            })
            .collect();
        subjects.sort();
        subjects.dedup();
        let at = subjects.iter().map(|at| if kind.file == "energy.csv" { "energy" } else { at.as_str() });
        for (at, quantity) in at.flat_map(|at| {
            header.iter().chain([&"fx".to_owned()]).map(move |column| (at, column.clone())).collect::<Vec<_>>()
        }) {
            for when in [
                CollectedWhen::Max,
                CollectedWhen::Min,
                CollectedWhen::Abs,
                CollectedWhen::End,
                CollectedWhen::Time(0.4),
            ] {
                let (name, at, quantity) = (String::new(), at.to_owned(), quantity.clone());
                wanted.push(Collected { name, at, quantity, stage: None, when });
            }
        }
    }
    let read = collect(dir.path(), &wanted, &[]).unwrap();
    let found = read.iter().flatten().count();
    assert!(found > 1000 && found < wanted.len(), "{found} of {}", wanted.len());
    let none = dir.path().join("none");
    let keeps = RunKeeps { files: false, numbers: &wanted };
    let mut files = Files::waiting(&none, keeps).begin(&model).unwrap();
    show(&mut files, &model, 0, 4);
    let mark = files.mark().unwrap();
    show(&mut files, &model, 5, 7);
    let mut files = Files::waiting(&none, keeps);
    files.go_on(&model, mark).unwrap();
    show(&mut files, &model, 5, 10);
    files.finish().unwrap();
    for ((wanted, read), found) in wanted.iter().zip(&read).zip(files.numbers()) {
        // Peaks of the run are those of all steps, of which some have no row.
        let agree = match (&wanted.when, *read, found) {
            (CollectedWhen::Max, Some(read), Some(found)) => found >= read,
            (CollectedWhen::Min, Some(read), Some(found)) => found <= read,
            (CollectedWhen::Abs, Some(read), Some(found)) => found.abs() >= read.abs(),
            (_, read, found) => read.map(f64::to_bits) == found.map(f64::to_bits),
        };
        assert!(agree, "{wanted:?}: {read:?}, {found:?}");
    }
    assert!(!none.exists());
}

/// An interrupted run, resumed from a checkpoint that lies before its last rows, ends in the same bytes.
#[test]
fn a_resumed_run_leaves_the_same_files() {
    let [whole, resumed] = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
    let mut model = scene::model();
    model.output.fields = Some(FieldFiles { cadence: Cadence::Steps(3), format: FieldFormat::Vtu });
    run(whole.path(), &model);
    let mut files = Files::open(resumed.path(), &model).unwrap();
    show(&mut files, &model, 0, 4);
    let mark = files.mark().unwrap();
    show(&mut files, &model, 5, 7);
    files.finish().unwrap();
    let mut files = Files::waiting(resumed.path(), RunKeeps::FILES);
    files.go_on(&model, mark).unwrap();
    show(&mut files, &model, 5, 10);
    files.finish().unwrap();
    let mut names: Vec<_> = fs::read_dir(whole.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names.len(), 10 + 3 + 5, "ten tables, names, the list, that of files, grids of steps 0 3 6 9 10");
    for name in names {
        let [a, b] = [&whole, &resumed].map(|dir| fs::read(dir.path().join(&name)).unwrap());
        assert!(a == b, "{name:?}");
    }
}

#[test]
fn only_what_is_asked_for_is_written() {
    let dir = tempfile::tempdir().unwrap();
    let mut model = scene::model();
    model.bodies.clear();
    let output = &mut model.output;
    output.nodes.clear();
    (output.energy, output.links, output.reactions, output.sections) = (false, false, false, None);
    output.contacts = None;
    run(dir.path(), &model);
    let names: Vec<_> = fs::read_dir(dir.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(names, ["steps.csv"]);
}

#[test]
fn a_folder_that_cannot_be_made_is_named() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("file");
    fs::write(&file, "").unwrap();
    let error = Files::open(&file.join("out"), &scene::model()).err().unwrap();
    assert!(error.to_string().contains("file/out: "), "{error}");
}

/// Content of the array of a name, after its length.
/// Every opened element is closed in order.
fn well_formed(xml: &str) -> bool {
    let mut open = Vec::new();
    for tag in xml.split('<').skip(1).filter_map(|rest| rest.split_once('>')).map(|(tag, _)| tag) {
        if tag.starts_with('?') || tag.ends_with('/') {
            continue;
        }
        match tag.strip_prefix('/') {
            Some(name) if open.pop() != Some(name) => return false,
            Some(_) => {}
            None => open.push(tag.split(' ').next().unwrap_or_default()),
        }
    }
    open.is_empty()
}

#[test]
fn grids_hold_together() {
    let dir = tempfile::tempdir().unwrap();
    let mut model = scene::model();
    model.output.fields = Some(FieldFiles { cadence: Cadence::Steps(4), format: FieldFormat::Vtu });
    run(dir.path(), &model);
    let list = fs::read_to_string(dir.path().join("fields.pvd")).unwrap();
    assert!(well_formed(&list));
    for (time, step) in [("0", 0), ("0.4", 4), ("0.8", 8), ("1", 10)] {
        assert!(list.contains(&format!("timestep=\"{time}\" part=\"0\" file=\"fields_{step:06}.vtu\"")), "{list}");
    }
    let grid = Grid::read(&dir.path().join("fields_000004.vtu"));
    assert!(well_formed(&grid.xml));
    let state = scene::state(&model, 0.4);
    let points = grid.numbers("Points");
    let (offsets, connectivity) = (grid.indices("offsets"), grid.indices("connectivity"));
    let (types, parts) = (grid.array("types"), grid.indices("part"));
    let (count, cells) = (points.len() / 3, types.len());
    assert!(grid.xml.contains(&format!("<Piece NumberOfPoints=\"{count}\" NumberOfCells=\"{cells}\">")));
    for name in ["displacement", "velocity", "rotation", "frame_x", "frame_y", "frame_z"] {
        assert_eq!(grid.numbers(name).len(), points.len(), "{name}");
    }
    assert_eq!(grid.numbers("TimeValue"), [state.time]);
    assert!(offsets.is_sorted() && *offsets.last().unwrap() == connectivity.len() && offsets.len() == cells);
    assert!(connectivity.iter().all(|point| *point < count) && parts.len() == cells);
    // The cubic element: ends first, then inner nodes; its points are the nodes 0 to 3.
    assert_eq!((&connectivity[..4], &types[..4], offsets[0]), (&[0, 3, 1, 2][..], &[68, 3, 3, 3][..], 4));
    assert_eq!(points[3..6], *state.nodes[1].x.as_slice());
    assert_eq!((parts[0], parts[1], parts[3], parts[4]), (0, 1, 2, 3), "beams, bar, link");
    assert_eq!(table(dir.path(), "fields.csv").1[1], ["1", "beam", "fore & aft"]);
    // A corner of the box moves as part of it: x = X + R S, v = v₀ + ω×RS; the bound is a few roundings of sums of size 10.
    let corner = connectivity[offsets[4]];
    assert_eq!(types[5], 12);
    let (body, arm) = (&state.nodes[6], rdsolve::math::Vec3::new(-0.5, -0.25, -0.1));
    let expected = body.x + body.R() * arm;
    let velocity = body.v + body.omega.cross(&(body.R() * arm));
    let velocities = grid.numbers("velocity");
    for k in 0..3 {
        assert!((points[3 * corner + k] - expected[k]).abs() < 1e-14);
        assert!((velocities[3 * corner + k] - velocity[k]).abs() < 1e-14);
    }
}

/// A strip pulled along a direction of its own, of quadrilaterals and a triangle at its end; beside a bar, whose cell comes first.
const SHELLS: &str = r#"
[analysis]
kind = "static"
end_time = 1.0
time_step = 0.5

[materials.m]
model = "elastic"
youngs_modulus = 1e6
poisson_ratio = 0.0

[points]
a = [0.0, 0.0, 0.0]
b = [0.0, 2.0, 0.0]
c = [-1.0, 2.0, 0.0]
d = [-1.0, 0.0, 0.0]
e = [-0.5, 3.0, 0.0]

[[bars]]
name = "bar"
path = ["b", "e"]
material = "m"
area = 1e-6

[[shells]]
name = "strip"
corners = ["a", "b", "c", "d"]
elements = [2, 1]
thickness = 0.1
material = "m"
axis = [0.0, 1.0, 0.0]

[[shells]]
name = "tip"
corners = ["b", "e", "c"]
elements = 1
thickness = 0.1
material = "m"

[[supports]]
at = "strip.edge4"
fix = "all"

[[loads]]
at = ["b", "c"]
force = [0.0, 0.5, 0.0]

[[expect]]
at = "strip"
quantity = "von_mises"
time = 1.0
value = 10.0
tolerance = 2e-2
source = "force over section, less what the tip and the bar take; forces at corners, without the moments of an even load"

[output]
every = 2
sections = true
layers = true
fields = { format = "vtu", every = 1 }
"#;

/// From the command to the files and back: faces, cell data, tables of the same numbers; also where a grid falls on no row.
#[test]
fn shells_are_drawn_with_what_they_feel() {
    let dir = tempfile::tempdir().unwrap();
    let (deck, out) = (dir.path().join("deck.toml"), dir.path().join("out"));
    fs::write(&deck, SHELLS).unwrap();
    let mut run = std::process::Command::new(env!("CARGO_BIN_EXE_rdsolve"));
    let run = run.args(["run", "--quiet", "-o"]).args([&out, &deck]).output().unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let (header, rows) = table(&out, "shells.csv");
    assert_eq!(
        header.join(","),
        "step,time,shell,element,N11,N22,N12,M11,M22,M12,Q1,Q2,von_mises_bottom,von_mises_top,plastic_strain"
    );
    assert_eq!(rows.len(), 2 * 3, "t = 0 and the end, three elements");
    assert_eq!((rows[4][2].as_str(), rows[4][3].as_str(), rows[5][2].as_str()), ("strip", "1", "tip"));
    let (header, layers) = table(&out, "layers.csv");
    assert_eq!(header.join(","), "step,time,shell,element,layer,z,s11,s22,s12,von_mises,plastic_strain");
    assert_eq!(layers.len(), 2 * 3 * 2, "and two surfaces each");
    assert_eq!((layers[6][4].as_str(), layers[6][5].as_str(), layers[7][5].as_str()), ("0", "-0.05", "0.05"));

    let grid_of = |step: usize| Grid::read(&out.join(format!("fields_{step:06}.vtu")));
    let grid = grid_of(2);
    assert!(well_formed(&grid.xml) && well_formed(&grid_of(1).xml));
    assert_eq!(grid.array("types"), [3, 9, 9, 5], "a line, two quadrilaterals, a triangle");
    assert_eq!(grid.indices("offsets"), [2, 6, 10, 13]);
    assert_eq!(grid.indices("part"), [0, 1, 1, 2]);
    // Points of a face go round as the corners do.
    let (points, corners) = (grid.numbers("Points"), grid.indices("connectivity"));
    let x = |k: usize| [points[3 * corners[k]], points[3 * corners[k] + 1]];
    for first in [2, 6, 10] {
        let [a, b, c] = [x(first), x(first + 1), x(first + 2)];
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        assert!((area - 1.0).abs() < 1e-4, "{area}: halves of the strip's elements, the tip"); // strains are 1e-5
    }
    let value = |row: usize, column: usize| rows[3 + row][column].parse::<f64>().unwrap();
    for (name, from, width) in [
        ("membrane_force", 4, 3),
        ("bending_moment", 7, 3),
        ("shear_force", 10, 2),
        ("von_mises_bottom", 12, 1),
        ("von_mises_top", 13, 1),
    ] {
        let found = grid.numbers(name);
        assert_eq!(found.len(), 4 * width, "{name}");
        assert!(found[..width].iter().all(|v| *v == 0.0), "{name}: the bar has none");
        for row in 0..3 {
            for k in 0..width {
                assert_eq!(found[width * (row + 1) + k].to_bits(), value(row, from + k).to_bits(), "{name}");
            }
        }
    }
    // Axis 1 of the strip is y by the deck, of the tip x; half of the force at half of the way, where no table has a row.
    let axes = grid.numbers("axis_1");
    assert!((axes[4] - 1.0).abs() < 1e-6 && (axes[9] - 1.0).abs() < 1e-6, "{axes:?}");
    let half = grid_of(1).numbers("membrane_force");
    assert!((value(0, 4) - 1.0).abs() < 2e-3 && (half[3] - 0.5).abs() < 1e-3, "{} {}", value(0, 4), half[3]);
}

fn expect(at: ExpectAt, quantity: &str, when: When, value: f64, tolerance: Tolerance) -> Expect {
    let (quantity, source) = (quantity.to_string(), "by hand".to_string());
    Expect { index: 0, at, quantity, when, value, tolerance, source, label: "it".into() }
}

#[test]
fn expectations_are_judged() {
    let mut model = scene::model();
    let link = PartIndex { kind: PartKind::Link, index: 0 };
    let (node, relative, absolute) = (ExpectAt::Node(2), Tolerance::Relative, Tolerance::Absolute);
    // ux = sin 3t peaks at t = 0.5 among the steps; a due frame has an even step.
    let peak = 1.5f64.sin();
    model.expects = vec![
        expect(node, "ux", When::Max, peak, relative(1e-12)),
        expect(node, "ux", When::Time(0.3), 0.9f64.sin(), absolute(1e-12)),
        expect(node, "uy", When::Abs, 2.0f64.cos() - 1.0, relative(1e-12)),
        expect(node, "qw", When::Time(0.2), 0.5f64.cos(), relative(1e-12)),
        expect(ExpectAt::Energy, "kinetic", When::Max, 1.0, relative(1e-12)),
        expect(ExpectAt::Part(link), "elongation", When::Min, -0.9, relative(1e-12)),
        expect(node, "uz", When::Time(0.0), 0.0, relative(0.1)),
        expect(node, "ux", When::Max, 1.0, relative(1e-3)),
        expect(node, "ux", When::Time(0.35), 1.0, relative(1.0)),
        expect(node, "kinetic", When::Max, 1.0, relative(1.0)),
    ];
    let mut expectations = Expectations::new(&model);
    show(&mut expectations, &model, 0, 10);
    let verdicts = expectations.verdicts();
    assert!(verdicts[..7].iter().all(|v| v.passed && v.reason.is_none()), "{verdicts:#?}");
    assert!(verdicts[7..].iter().all(|v| !v.passed && v.reason.is_some()), "{verdicts:#?}");
    assert_eq!(verdicts[0].time, Some(0.5));
    assert!((verdicts[7].error.unwrap() - (1.0 - peak)).abs() < 1e-15, "relative error of an expected 1");
    assert_eq!(verdicts[8].reason.as_deref(), Some("the run has no step at time 0.35"));
    assert_eq!(verdicts[9].reason.as_deref(), Some("there is no quantity `kinetic` here"));
    assert!(quantities(node).contains(&"qz") && quantities(ExpectAt::Part(link)).contains(&"rate"));
}
