//! How often tables have rows, and how large they become: as predicted before the run.

use crate::support::{Tables, read, read_deck, tables_of};
use rdsolve::model::{Cadence, Model};
use rdsolve::output::{Files, expected_sizes, settle_cadence, wanted};
use rdsolve::plan::Plan;
use rdsolve::solve::{Outcome, Run};
use rdsolve::system::System;
use std::sync::atomic::AtomicBool;

fn plan(model: &Model) -> Plan {
    Plan::new(model, &System::new(model).expect("a system"), 1)
}

/// Statics, dynamics, plane and space, bodies, beams, shells, contacts, constitutive histories, fields. Numbers have sixteen or
/// seventeen digits, or few; which of them stay zero is guessed from what moves. Grids are predicted without
/// compression, which saves a third to a half of large ones. Arrays below 4 kB are stored, and the
/// forecast of their grids is right to 5 %; of three grids of a short run 2.6 are counted.
#[test]
fn tables_become_as_large_as_predicted() {
    for (name, end) in [
        ("first", 0.05),
        ("heavy_top", 0.2),
        ("right_angle_cantilever", 3.0),
        ("viscoplastic_rod", 2e-3),
        ("spin_up", 4.0),
        ("block_on_incline", 1.0),
        ("tutorial/plate.toml", 0.2),
        ("tossed_cylinder", 1.0),
        ("two_bodies_on_springs", 1.0),
    ] {
        let model = read(name, &[format!("analysis.end_time={end}"), "expect=[]".to_owned()]);
        let sizes = expected_sizes(&model, &plan(&model)).unwrap();
        let sum = |fields: bool| {
            sizes.iter().filter(|(file, _)| (*file == "fields") == fields).map(|(_, size)| size).sum::<f64>()
        };
        let tables = tables_of(&model);
        for (predicted, written, bounds) in
            [(sum(false), tables.bytes(false), 0.8..1.25), (sum(true), tables.bytes(true), 0.85..2.5)]
        {
            let ratio = predicted / written as f64;
            assert!(written == 0 || bounds.contains(&ratio), "{name}: {predicted} predicted, {written} written");
        }
    }
}

const ON_A_SPRING: &str = r#"
[[bodies]]
name = "ball"
center = [0.0, 0.0, 0.0]
mass = 1.0
inertia = [1.0, 1.0, 1.0]
velocity = [1.0, 0.3, 0.2]

[[links]]
name = "spring"
from = { ground = [-1.0, 0.0, 0.0] }
to = { body = "ball" }
stiffness = 100.0
damping = 1.0
"#;

fn on_a_spring(analysis: &str, more: &str) -> Model {
    read_deck(&format!("[analysis]\nkind = \"dynamic\"\n{analysis}\n{ON_A_SPRING}\n{more}"))
}

/// Where the deck leaves it open: every step of a short run; of a long one no more than 20 MB, at times that are whole numbers of
/// steps; with automatic steps those that are far enough apart.
#[test]
fn large_tables_have_fewer_rows_by_default() {
    let settled = |analysis: &str, more: &str| {
        let mut model = on_a_spring(analysis, more);
        let plan = plan(&model);
        settle_cadence(&mut model, &plan);
        let size: f64 = expected_sizes(&model, &plan).into_iter().flatten().map(|(_, size)| size).sum();
        (model.output.cadence, size)
    };
    let (cadence, size) = settled("end_time = 1.0\ntime_step = 1e-3", "");
    assert!(cadence == Cadence::Steps(1) && size > 0.5e6, "{cadence:?} {size}");
    let (cadence, size) = settled("end_time = 1e3\ntime_step = 1e-3", "");
    assert!(cadence == Cadence::Steps(50) && (8e6..20e6).contains(&size), "{cadence:?} {size}");
    // What is asked for is written.
    let (cadence, size) = settled("end_time = 1e3\ntime_step = 1e-3", "[output]\nevery = 1");
    assert!(cadence == Cadence::Steps(1) && size > 500e6, "{cadence:?} {size}");
    let (cadence, _) = settled("end_time = 1e3\ntime_step = 1e-3", "[output]\ninterval = 0.5");
    assert_eq!(cadence, Cadence::Interval(0.5));
    let (cadence, size) = settled("end_time = 1e3\ntime_step = \"auto\"", "");
    assert!(matches!(cadence, Cadence::Apart(_)) && size < 20.1e6, "{cadence:?} {size}");
}

#[test]
fn fields_come_to_200_files_by_default() {
    let fields = |analysis: &str, fields: &str| {
        on_a_spring(analysis, &format!("[output]\nfields = {fields}")).output.fields.map(|files| files.cadence)
    };
    let open = "{ format = \"vtu\" }";
    assert_eq!(fields("end_time = 1.0\ntime_step = 5e-3", open), Some(Cadence::Steps(1)));
    assert_eq!(fields("end_time = 1.0\ntime_step = 1e-4", open), Some(Cadence::Steps(50)));
    assert_eq!(fields("end_time = 1.0\ntime_step = \"auto\"", open), Some(Cadence::Apart(5e-3)));
    let all = "{ format = \"vtu\", every = 1 }";
    assert_eq!(fields("end_time = 1.0\ntime_step = 1e-4", all), Some(Cadence::Steps(1)));
}

/// Rows of automatic steps lie as far apart as said, and no farther than a step more.
#[test]
fn rows_of_automatic_steps_keep_their_distance() {
    let mut model =
        on_a_spring("end_time = 1.0\ntime_step = \"auto\"", "[integrator]\nscheme = \"central-difference\"");
    let times = |model: &Model| -> Vec<f64> {
        tables_of(model).rows("energy.csv").iter().map(|row| row.number("time")).collect()
    };
    let longest = times(&model).windows(2).map(|two| two[1] - two[0]).fold(0.0, f64::max);
    model.output.cadence = Cadence::Apart(0.2);
    let times = times(&model);
    assert!(times[0] == 0.0 && (times[times.len() - 1] - 1.0).abs() < 1e-12);
    for two in times[..times.len() - 1].windows(2) {
        let apart = two[1] - two[0];
        assert!(apart > 0.2 * (1.0 - 1e-6) && apart < 0.2 + longest, "{times:?}");
    }
}

/// A row of steps.csv tells of all steps since the one before, cut steps too: the columns add up to the counts of the run.
#[test]
fn costs_add_up_whatever_the_cadence() {
    let sums = |cadence: Cadence| {
        let mut model = read(
            "bouncing_ball",
            &["analysis.end_time=0.5".into(), "analysis.time_step=5e-3".into(), "expect=[]".into()],
        );
        model.output.cadence = cadence;
        let (system, stop) = (System::new(&model).unwrap(), AtomicBool::new(false));
        let (plan, folder) = (Plan::new(&model, &system, 1), tempfile::tempdir().unwrap());
        let mut files = Files::open(folder.path(), &model).unwrap();
        let mut run = Run::new(&model, &system, &plan, wanted(&model), &stop).unwrap();
        let (outcome, _) = run.run(&mut files);
        assert!(matches!(outcome, Outcome::Done), "{outcome:?}");
        files.finish().unwrap();
        let tables = Tables::of(folder);
        let rows = tables.rows("steps.csv");
        let sum = |column: &str| rows.iter().map(|row| row.number(column)).sum::<f64>() as usize;
        let counts = run.counts();
        assert_eq!((sum("iterations"), sum("cuts")), (counts.iterations, counts.cuts));
        let residual = rows.iter().map(|row| row.number("residual")).fold(0.0, f64::max);
        assert_eq!(rows.len() + 1, tables.rows("energy.csv").len());
        (rows.len(), residual, counts.steps)
    };
    let (all, of_all, steps) = sums(Cadence::Steps(1));
    assert_eq!(all, steps);
    let (few, of_few, _) = sums(Cadence::Steps(17));
    assert_eq!((few, of_few), (steps.div_ceil(17), of_all));
}

/// A peak is that of all steps, not of those that have rows: of energies, forces of links, reactions of joints.
#[test]
fn peaks_between_rows_are_seen() {
    let peaks = |every: usize| {
        let quantities = [("spring", "force"), ("spring", "elongation"), ("energy", "links"), ("arm", "fx")];
        let expects: String = quantities
            .map(|(at, quantity)| {
                format!("[[expect]]\nat = \"{at}\"\nquantity = \"{quantity}\"\npeak = \"abs\"\nvalue = 1.0\ntolerance = 1e3\nsource = \"none\"\n")
            })
            .concat();
        let joint = "[[bodies]]\nname = \"rider\"\ncenter = [0.0, 0.0, 1.0]\nmass = 0.1\ninertia = [0.1, 0.1, 0.1]\n\
             [[joints]]\nname = \"arm\"\nkind = \"spherical\"\nfrom = { body = \"rider\", point = [0.0, 0.0, 0.0] }\nto = { body = \"ball\" }\n";
        let output = format!("[output]\nevery = {every}\n");
        let model = on_a_spring("end_time = 1.0\ntime_step = 5e-3", &format!("{joint}{output}{expects}"));
        let verdicts = crate::support::run(&model, &mut |_| Vec::new()).verdicts;
        verdicts.into_iter().map(|verdict| verdict.value.unwrap()).collect::<Vec<f64>>()
    };
    let (all, few) = (peaks(1), peaks(1000));
    assert!(all.iter().all(|value| value.abs() > 0.05), "{all:?}");
    assert_eq!(all, few);
}

/// A run that fails between two rows leaves the last state that it reached.
#[test]
fn tables_of_a_run_that_fails_end_where_it_does() {
    let truss = |every: usize| {
        read_deck(&format!(
            "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 0.01\nleast_step = 1e-3\n\
             [materials.steel]\nmodel = \"elastic\"\nE = 210e9\nnu = 0.3\ndensity = 7850.0\n\
             [points]\nleft = [-1.0, 0.0, 0.0]\ncrown = [0.0, 0.0, 0.05]\nright = [1.0, 0.0, 0.0]\n\
             [[bars]]\nname = \"rafters\"\npath = [\"left\", \"crown\", \"right\"]\nmaterial = \"steel\"\narea = 1e-4\n\
             [[supports]]\nat = [\"left\", \"right\"]\nfix = \"translations\"\n\
             [[supports]]\nat = \"crown\"\nfix = [\"uy\"]\n\
             [[loads]]\nat = \"crown\"\nforce = [0.0, 0.0, -20e3]\namplitude = \"up\"\n\
             [amplitudes.up]\nkind = \"ramp\"\nstart = 0.0\nend = 1.0\n[output]\nevery = {every}\n"
        ))
    };
    let last = |every: usize| {
        let model = truss(every);
        let (system, stop) = (System::new(&model).unwrap(), AtomicBool::new(false));
        let (plan, folder) = (Plan::new(&model, &system, 1), tempfile::tempdir().unwrap());
        let mut files = Files::open(folder.path(), &model).unwrap();
        let (outcome, _) = Run::new(&model, &system, &plan, wanted(&model), &stop).unwrap().run(&mut files);
        files.finish().unwrap();
        let Outcome::Failed { time, .. } = outcome else { panic!("{outcome:?}") };
        let tables = Tables::of(folder);
        for file in ["nodes.csv", "energy.csv", "steps.csv"] {
            let rows = tables.rows(file);
            assert_eq!(rows.last().unwrap().number("time"), time, "{file} with {every} steps a row");
        }
        let rows = tables.rows("nodes.csv");
        let crown = rows.iter().rfind(|row| row.text("node") == "crown").unwrap();
        (time, crown.number("uz"), rows.len())
    };
    let (all, few) = (last(1), last(1000));
    // The limit load of this truss is 2 EA h³/(3√3 l³) = 1.01 kN, a twentieth of the load.
    assert!(all.0 > 0.048 && all.0 < 0.052, "{all:?}");
    assert_eq!((all.0, all.1), (few.0, few.1));
    assert_eq!(few.2, 2 * 3, "rows at t = 0 and at the end");
}
