//! Amplitudes from files: records of motions and forces.

use assert_cmd::Command;
use std::fs;
use std::path::Path;

/// A mass on a spring, in a deck whose amplitude is to follow.
const OSCILLATOR: &str = r#"
[analysis]
kind = "dynamic"
end_time = 2.0
time_step = 0.005
[integrator]
scheme = "newmark"
[[bodies]]
name = "mass"
center = [1.0, 0.0, 0.0]
mass = 2.0
inertia = [1.0, 1.0, 1.0]
[[links]]
name = "spring"
from = { ground = [0.0, 0.0, 0.0] }
to = { body = "mass" }
stiffness = 500.0
[[supports]]
at = "mass"
fix = ["uy", "uz", "rx", "ry", "rz"]
"#;
const SHAKEN: &str = "[environment]\nbase_acceleration = [{ direction = [1.0, 0.0, 0.0], amplitude = \"quake\" }]\n";

/// Writes deck and record into a folder and runs the deck; the exit code and what was said on standard error.
fn run(folder: &Path, deck: &str, record: &str, out: &str) -> (i32, String) {
    fs::write(folder.join("deck.toml"), deck).unwrap();
    fs::write(folder.join("record.csv"), record).unwrap();
    let mut command = Command::cargo_bin("rdsolve").unwrap();
    let output = command.current_dir(folder).args(["deck.toml", "-o", out, "--overwrite"]).output().unwrap();
    (output.status.code().unwrap(), String::from_utf8_lossy(&output.stderr).into_owned())
}

fn rows(folder: &Path, out: &str, column: &str) -> Vec<f64> {
    let mut reader = csv::Reader::from_path(folder.join(out).join("bodies.csv")).unwrap();
    let place = reader.headers().unwrap().iter().position(|name| name == column).unwrap();
    reader.records().map(|row| row.unwrap()[place].parse().unwrap()).collect()
}

fn pulse(k: usize) -> f64 {
    (0.03 * k as f64).sin() * (-0.01 * k as f64).exp()
}

/// A record of a file is the same function as its points in the deck, whatever separates its columns: the same bytes.
#[test]
fn a_record_is_its_points() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let points: Vec<String> = (0..=400).map(|k| format!("[{}, {}]", 0.005 * k as f64, 9.81 * pulse(k))).collect();
    let inline = format!("[amplitudes.quake]\nkind = \"table\"\npoints = [{}]\n", points.join(", "));
    assert_eq!(run(folder, &format!("{OSCILLATOR}{SHAKEN}{inline}"), "", "inline").0, 0);
    let wanted = fs::read(folder.join("inline/bodies.csv")).unwrap();
    let lines = |separator: &str| -> String {
        (0..=400).map(|k| format!("{}{separator}x{separator}{}\n", 0.005 * k as f64, pulse(k))).collect()
    };
    let alone: String = (0..=400).map(|k| format!("{}\n", pulse(k))).collect();
    for (record, keys) in [
        (format!("time,station,acceleration\n{}", lines(",")), "columns = [\"time\", \"acceleration\"]"),
        (format!("# g\n{}", lines("  ")), "columns = [1, 3]"),
        (lines(";"), "columns = [1, 3]"),
        (alone, "time_step = 0.005"),
    ] {
        let amplitude = format!("[amplitudes.quake]\nkind = \"table\"\nfile = \"record.csv\"\nscale = 9.81\n{keys}\n");
        let (code, said) = run(folder, &format!("{OSCILLATOR}{SHAKEN}{amplitude}"), &record, "file");
        assert_eq!(code, 0, "{said}");
        assert_eq!(fs::read(folder.join("file/bodies.csv")).unwrap(), wanted, "{keys}");
    }
}

/// Ground accelerations from a record at 2001 points against the closed form of a resonant sine: straight lines between points are wrong
/// by (Δt ω)²/12 = 2e-6 of the force; the trapezoidal rule by (Δt ω)²/12 of the phase, 2e-5 · ω t = 8e-4.
#[test]
fn a_record_shakes_as_its_function_does() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let w = (500.0_f64 / 2.0).sqrt();
    let record: String = (0..=2000).map(|k| format!("{},{}\n", k as f64 * 1e-3, (w * k as f64 * 1e-3).sin())).collect();
    let amplitude = "[amplitudes.quake]\nkind = \"table\"\nfile = \"record.csv\"\nafter = \"hold\"\n";
    let deck = format!("{OSCILLATOR}{SHAKEN}{amplitude}").replace("0.005", "0.001");
    assert_eq!(run(folder, &deck, &record, "out").0, 0);
    // ẍ + ω² x = −sin ωt from rest: x = (ωt cos ωt − sin ωt)/(2ω²).
    let x = rows(folder, "out", "x");
    let exact = |t: f64| 1.0 + (w * t * (w * t).cos() - (w * t).sin()) / (2.0 * w * w);
    let worst = x.iter().enumerate().map(|(k, x)| (x - exact(k as f64 * 1e-3)).abs()).fold(0.0, f64::max);
    let largest = 2.0 / (2.0 * w);
    assert!(worst < 1e-3 * largest && worst > 0.0, "{worst:e} of {largest:e}");
}

/// A prescribed acceleration is integrated exactly between the points: the displacement of a constant acceleration is ½ a t².
#[test]
fn a_recorded_acceleration_moves_a_support() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let deck = r#"
[analysis]
kind = "dynamic"
end_time = 2.0
time_step = 0.01
[[bodies]]
name = "mass"
center = [1.0, 0.0, 0.0]
mass = 2.0
inertia = [1.0, 1.0, 1.0]
[[supports]]
at = "mass"
fix = ["uy", "uz", "rx", "ry", "rz"]
[[supports]]
at = "mass"
motion = { ux = { amplitude = "drive", history = "acceleration" } }
[amplitudes.drive]
kind = "table"
file = "record.csv"
shift = 0.5
before = "zero"
after = "hold"
"#;
    let record: String = (0..=300_000).map(|k| format!("{} 3.0\n", k as f64 * 1e-5)).collect();
    let (code, said) = run(folder, deck, &record, "out");
    assert_eq!(code, 0, "{said}");
    let x = rows(folder, "out", "x");
    let end = 1.0 + 0.5 * 3.0 * 1.5 * 1.5;
    assert!((x[x.len() - 1] - end).abs() < 1e-12 * end, "{}", x[x.len() - 1] - end);
}

/// Gravity comes on by its amplitude: in statics it is the weight at the end, and half of it on half of the way; in dynamics nothing
/// bounces where it comes on slowly.
#[test]
fn gravity_comes_on_by_its_amplitude() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let heavy = "[environment]\ngravity = [-9.81, 0.0, 0.0]\ngravity_amplitude = \"on\"\n[amplitudes.on]\nkind = \"ramp\"\nend = 1.0\n";
    let deck = format!("{OSCILLATOR}{heavy}");
    let sunk = 2.0 * 9.81 / 500.0;
    let statics = deck
        .replace("\"dynamic\"", "\"static\"")
        .replace("[integrator]\nscheme = \"newmark\"\n", "")
        .replace("0.005", "0.25");
    assert_eq!(run(folder, &statics, "", "statics").0, 0);
    let x = rows(folder, "statics", "x");
    for (k, x) in x.iter().enumerate() {
        let exact = 1.0 - sunk * (0.25 * k as f64).min(1.0);
        assert!((x - exact).abs() < 1e-9, "{k}: {x} {exact}");
    }
    assert_eq!(run(folder, &deck, "", "dynamics").0, 0);
    // What a ramp of length T leaves vibrating is at the most 2/(ω T) of the static displacement: 0.13 here.
    let x = rows(folder, "dynamics", "x");
    let bounce = x[200..].iter().map(|x| (x - 1.0 + sunk).abs()).fold(0.0, f64::max);
    assert!(bounce < 0.13 * sunk && bounce > 1e-6 * sunk, "{bounce:e} of {sunk:e}");
}

/// What is wrong with a record is an error of the deck: exit code 3, with the file, the line and the column.
#[test]
fn bad_records_are_errors_with_their_place() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (keys, record, said) in [
        ("file = \"none.csv\"", "", &["cannot read the record `none.csv`", "relative to the deck's folder"][..]),
        ("file = \".\"", "", &["it is a folder"]),
        ("file = \"record.csv\"", "0,1\n1,x\n", &["`x` is not a finite number", "record.csv:2:3"]),
        ("file = \"record.csv\"", "0,1\n1,2\n0.5,2\n", &["the time falls: 0.5 comes after 1", "record.csv:3:1"]),
        ("file = \"record.csv\"", "0,1\n1,\n", &["there is a gap", "record.csv:2"]),
        ("file = \"record.csv\"\ncolumns = [\"t\", \"b\"]", "t,a\n0,1\n1,2\n", &["there is no column `b`"]),
        ("file = \"record.csv\"\ntime_step = 0.0", "0\n1\n", &["`time_step` must be above 0"]),
        (
            "file = \"record.csv\"\npoints = [[0.0, 1.0], [1.0, 2.0]]",
            "0,1\n1,2\n",
            &["`points` does not apply to a table from a file"],
        ),
        (
            "points = [[0.0, 1.0], [1.0, 2.0]]\ncolumns = [1, 2]",
            "",
            &["`columns` does not apply to a table without a file"],
        ),
        ("columns = [0]\nfile = \"record.csv\"", "0,1\n1,2\n", &["the name of a column or its number from 1"]),
        ("columns = 1.5\nfile = \"record.csv\"", "0,1\n1,2\n", &["by name or by number from 1"]),
    ] {
        let deck = format!("{OSCILLATOR}{SHAKEN}[amplitudes.quake]\nkind = \"table\"\n{keys}\n");
        let (code, found) = run(folder, &deck, record, "out");
        assert_eq!(code, 3, "{keys}: {found}");
        said.iter().for_each(|said| assert!(found.contains(said), "{keys}: {found}"));
    }
    let deck = format!("{OSCILLATOR}[environment]\ngravity_amplitude = \"on\"\n[amplitudes.on]\nkind = \"constant\"\n");
    let (code, found) = run(folder, &deck, "", "out");
    assert!(code == 3 && found.contains("`gravity_amplitude` needs `gravity`"), "{found}");
    let sine =
        format!("{OSCILLATOR}{SHAKEN}[amplitudes.quake]\nkind = \"sine\"\nfrequency = 1.0\nfile = \"record.csv\"\n");
    let (code, found) = run(folder, &sine, "", "out");
    assert!(code == 3 && found.contains("`file` does not apply to a sine"), "{found}");
}

/// A record of a data base: its values in g, row by row, at the step of its header. The same bytes as from columns.
#[test]
fn a_record_of_a_data_base_is_read_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let values: Vec<String> = (0..=400).map(|k| format!("{:15.7E}", pulse(k))).collect();
    let rows: String = values.chunks(5).map(|row| row.concat() + "\n").collect();
    let at2 =
        format!("DATA BASE\nSomewhere\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS=    401, DT=   .0050 SEC\n{rows}");
    fs::write(folder.join("RSN6_180.AT2"), &at2).unwrap();
    let deck = |keys: &str| format!("{OSCILLATOR}{SHAKEN}[amplitudes.quake]\nkind = \"table\"\n{keys}\nscale = 9.81\n");
    let columns = deck("file = \"record.csv\"\ntime_step = 0.005");
    assert_eq!(run(folder, &columns, &values.join("\n"), "columns"), (0, String::new()));
    let found = run(folder, &deck("file = \"RSN6_180.AT2\""), "", "at2");
    assert_eq!(found, (0, String::new()));
    let bodies = |out: &str| fs::read(folder.join(out).join("bodies.csv")).unwrap();
    assert!(bodies("columns") == bodies("at2"));
    // What does not go with the header, what is missing, and where the file is wrong.
    for (keys, spoil, said) in [
        ("time_step = 0.01", "", &["`time_step` is 0.01, and the header says 0.005", "RSN6_180.AT2:4"][..]),
        ("columns = [1, 2]", "", &["the time falls", "RSN6_180.AT2:"]),
        ("", "NPTS=    402", &["there are 401 values, and NPTS = 402 says more", "RSN6_180.AT2:85"]),
        ("", "NPTS=    400", &["there are more values than NPTS = 400", "RSN6_180.AT2:85:3"]),
        ("", "NPTS=   none", &["NPTS is the number of values, 2 or more, not `NONE`", "RSN6_180.AT2:4"]),
        ("", "COUNT=    401", &["no line says `NPTS= .., DT= ..`", "`rows = true` and `time_step`"]),
    ] {
        let text = if spoil.is_empty() { at2.clone() } else { at2.replace("NPTS=    401", spoil) };
        fs::write(folder.join("RSN6_180.AT2"), text).unwrap();
        let (code, found) = run(folder, &deck(&format!("file = \"RSN6_180.AT2\"\n{keys}")), "", "out");
        assert_eq!(code, 3, "{keys}{spoil}: {found}");
        said.iter().for_each(|said| assert!(found.contains(said), "{keys}{spoil}: {found}"));
    }
    // The same values by the other name, by another dress of the header, and without it.
    let filtered = at2.replace("UNITS OF G", "UNITS OF G. FILTER POINTS: HP=0.1 Hz LP=40.0 Hz");
    for (file, text, keys) in [
        ("RSN6_180.AT2", filtered.clone(), ""),
        ("quake.txt", filtered, ""),
        ("quake.txt", rows.clone(), "rows = true\ntime_step = 0.005"),
        ("RSN6_180.AT2", rows, "rows = true\ntime_step = 0.005"),
        ("quake.csv", values.chunks(7).map(|row| row.join(",") + ",\n").collect(), "rows = true\ntime_step = 0.005"),
        ("quake.txt", at2.replace("NPTS=    401, DT=   .0050 SEC", "DT= 5.0D-3 SEC, NPTS= 401"), "time_step = 0.005"),
    ] {
        fs::write(folder.join(file), text).unwrap();
        let found = run(folder, &deck(&format!("file = \"{file}\"\n{keys}")), "", "at2");
        assert_eq!(found, (0, String::new()), "{file} {keys}");
        assert!(bodies("columns") == bodies("at2"), "{file} {keys}");
    }
}

/// The remedies that a file row by row is told of both work, and a column that is part of a sequence is asked about.
#[test]
fn several_values_a_line_are_rows_or_columns() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let deck = |keys: &str| {
        let amplitude = "[amplitudes.quake]\nkind = \"table\"\nfile = \"record.csv\"\nafter = \"zero\"\n";
        format!("{OSCILLATOR}{SHAKEN}{amplitude}{keys}\n")
    };
    let values: Vec<String> = (0..=400).map(|k| format!("{:.6}", pulse(k))).collect();
    let rows: String = values.chunks(5).map(|row| row.join(" ") + "\n").collect();
    for keys in ["time_step = 0.005", ""] {
        let (code, found) = run(folder, &deck(keys), &rows, "out");
        assert!(code == 3 && found.contains("a line has 5 values: `columns` says"), "{found}");
        assert!(found.contains("`rows = true`") && found.contains("record.csv:1"), "{found}");
    }
    let (code, found) = run(folder, &deck("rows = true\ntime_step = 0.005"), &rows, "out");
    assert_eq!((code, found.as_str()), (0, ""));
    let (code, found) = run(folder, &deck("columns = 1\ntime_step = 0.005"), &rows, "out");
    assert!(code == 0 && found.contains("look like one sequence") && found.contains("`rows = true`"), "{found}");
    let meant = run(folder, &deck("columns = 1\nrows = false\ntime_step = 0.005"), &rows, "out");
    assert_eq!(meant, (0, String::new()));
    for (keys, said) in [
        ("rows = true", "the file does not say how far apart its values are"),
        ("rows = true\ncolumns = 1\ntime_step = 0.005", "`columns` does not apply to a file that is read row by row"),
        ("rows = true\ntime_step = -1.0", "`time_step` must be above 0"),
    ] {
        let (code, found) = run(folder, &deck(keys), &rows, "out");
        assert!(code == 3 && found.contains(said), "{keys}: {found}");
    }
}

/// A record whose header names a unit is not converted: where nothing else does, or where the factor is that of another unit, it is said.
#[test]
fn units_of_records_are_compared_with_the_deck() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let record = |kind: &str, unit: &str| {
        let values: String = (0..=400).map(|k| format!("{:.6}\n", pulse(k))).collect();
        format!("A\nB\n{kind} TIME SERIES IN UNITS OF {unit}\nNPTS= 401, DT= .005 SEC\n{values}")
    };
    let g = record("ACCELERATION", "G");
    let velocity = record("VELOCITY", "CM/S");
    let displacement = record("DISPLACEMENT", "CM");
    let moved = |history: &str| {
        format!(
            "[points]\np = [5.0, 0.0, 0.0]\n[[masses]]\nat = \"p\"\nmass = 1.0\n[[supports]]\nat = \"p\"\nfix = [\"uy\", \"uz\"]\n\
             motion = {{ ux = {{ amplitude = \"quake\"{history} }} }}\n"
        )
    };
    let (si, mm) = ("units = \"SI\"\n", "units = \"mm-t-s\"\n");
    let bare =
        |peak: f64| (0..=400).map(|k| format!("{:.6},{:.6}\n", 0.005 * k as f64, peak * pulse(k))).collect::<String>();
    // The peak of the pulse is 0.585.
    let [weak, strong] = [bare(1.0), bare(100.0)];
    let scaled = SHAKEN.replace("\"quake\" }", "\"quake\", scale = 9.81 }");
    let cases: [(&str, &str, &str, &str, Option<&str>); 30] = [
        (si, &scaled, "scale = 9.81", &g, Some("the scale 9.81 does so once more")),
        (si, &scaled, "unit = \"g\"", &g, Some("its unit converts it to the units SI")),
        (si, &scaled, "unit = \"g\"\nscale = 1.5", &g, Some("its unit converts it to the units SI")),
        (si, SHAKEN, "unit = \"g\"\nscale = 1.5", &g, None),
        (si, SHAKEN, "", &weak, Some("note: the record `record.csv` names no unit")),
        (si, SHAKEN, "", &bare(0.1), Some("warning: the record `record.csv` names no unit")),
        (si, SHAKEN, "", &bare(0.1), Some("`scale = 1.0` says that it is in the units of the deck")),
        (si, SHAKEN, "scale = 1.0", &bare(0.1), None),
        (si, SHAKEN, "", &strong, Some("names no unit")),
        (si, SHAKEN, "", &bare(5.0), None),
        (si, SHAKEN, "unit = \"m/s2\"", &weak, None),
        ("", SHAKEN, "", &g, Some("is in G, and its numbers are taken as they are")),
        ("", SHAKEN, "scale = 1.0", &g, None),
        (si, SHAKEN, "", &g, Some("`scale = 9.807`")),
        (si, SHAKEN, "scale = 9.81", &g, None),
        (si, SHAKEN, "scale = 30.0", &g, None),
        (si, SHAKEN, "scale = 2.0", &g, Some("the scale is 2: it acts at 0.204 of its strength")),
        (si, SHAKEN, "scale = 1.0", &g, None),
        (si, SHAKEN, "scale = 9810.0", &g, Some("the scale is 9810")),
        (mm, SHAKEN, "scale = 9.81", &g, Some("`scale = 9807`")),
        (mm, SHAKEN, "scale = 9810.0", &g, None),
        (si, SHAKEN, "", &record("ACCELERATION", "cm/sec**2"), Some("`scale = 0.01`")),
        (si, SHAKEN, "scale = 9.81", &record("ACCELERATION", "GAL"), Some("the scale is 9.81")),
        (
            si,
            SHAKEN,
            "scale = 0.01",
            &displacement,
            Some("has displacements in CM, and the ground takes it for accelerations"),
        ),
        (si, &moved(""), "scale = 9.81", &g, Some("`history = \"acceleration\"`")),
        (si, &moved(", history = \"acceleration\""), "", &g, Some("its values are converted to the units SI")),
        (
            si,
            &moved(", history = \"velocity\", scale = 0.01"),
            "",
            &velocity,
            Some("the scale 0.01 converts the record from CM/S"),
        ),
        (si, &moved(", history = \"velocity\""), "", &velocity, Some("is in CM/S")),
        (si, &moved(", history = \"acceleration\", scale = 0.01"), "", &velocity, Some("`history = \"velocity\"`")),
        ("", SHAKEN, "", &record("ACCELERATION", "COUNTS"), Some("is in COUNTS, and its numbers are taken")),
    ];
    for (label, used, keys, record, said) in cases {
        let amplitude =
            format!("[amplitudes.quake]\nkind = \"table\"\nfile = \"record.csv\"\nafter = \"zero\"\n{keys}\n");
        let (code, found) = run(folder, &format!("{label}{OSCILLATOR}{used}{amplitude}"), record, "out");
        // Another quantity than that of the motion is refused.
        let is_other = said.is_some_and(|said| said.contains("takes it for") || said.starts_with("`history"));
        assert_eq!(code, if is_other { 3 } else { 0 }, "{found}");
        match said {
            Some(said) => assert!(found.contains(said), "{label}{keys}{used}: {found}"),
            None => assert!(!found.contains("record.csv"), "{label}{keys}{used}: {found}"),
        }
    }
}

/// With `units` a record in g is converted as by its scale, to the last bit; `scale = 1.0` in the amplitude leaves it alone.
#[test]
fn records_are_converted_to_the_units_of_the_deck() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let values: String = (0..=400).map(|k| format!("{:.6}\n", pulse(k))).collect();
    let record = format!("A\nB\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 401, DT= .005 SEC\n{values}");
    let scaled = SHAKEN.replace("\"quake\" }", "\"quake\", scale = 2.0 }");
    let motion = |units: &str, used: &str, keys: &str| {
        let amplitude =
            format!("[amplitudes.quake]\nkind = \"table\"\nfile = \"record.csv\"\nafter = \"zero\"\n{keys}\n");
        assert_eq!(run(folder, &format!("{units}{OSCILLATOR}{used}{amplitude}"), &record, "out").0, 0);
        rows(folder, "out", "x")
    };
    let (si, mm) = ("units = \"SI\"\n", "units = \"mm-t-s\"\n");
    assert_eq!(motion(si, SHAKEN, ""), motion(si, SHAKEN, "scale = 9.80665"));
    assert_eq!(motion(mm, SHAKEN, ""), motion(mm, SHAKEN, "scale = 9806.65"));
    assert_eq!(motion(si, SHAKEN, "scale = 1.0"), motion("", SHAKEN, "scale = 1.0"));
    // A scale of the motion is a factor on the whole record, unless it is the factor between the units.
    assert_eq!(motion(si, &scaled, ""), motion(si, &scaled, "unit = \"g\""));
    assert_eq!(motion(si, SHAKEN, ""), motion(si, &scaled.replace("2.0", "1.0"), ""));
    assert_eq!(motion(si, SHAKEN, ""), motion("", &scaled.replace("2.0", "9.80665"), ""));
    assert_eq!(motion(si, SHAKEN, ""), motion(si, &scaled.replace("2.0", "9.80665"), ""));
    // 9.9 is no way to write it: the record is converted, and then 9.9 times as strong.
    let strong = scaled.replace("2.0", "9.9");
    assert_eq!(motion(si, &strong, ""), motion(si, &strong, "unit = \"g\""));
}

/// The hash of a run is that of its records too: other numbers, another hash.
#[test]
fn a_record_is_part_of_the_hash() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let deck =
        format!("{OSCILLATOR}{SHAKEN}[amplitudes.quake]\nkind = \"table\"\nfile = \"record.csv\"\nafter = \"zero\"\n");
    let hash = |record: &str| {
        assert_eq!(run(folder, &deck, record, "out").0, 0);
        let text = fs::read(folder.join("out/result.json")).unwrap();
        serde_json::from_slice::<serde_json::Value>(&text).unwrap()["deck_hash"].as_str().unwrap().to_owned()
    };
    assert_ne!(hash("0,1\n1,2\n"), hash("0,1\n1,3\n"));
    assert_eq!(hash("0,1\n1,2\n"), hash("0,1\n1,2\n"));
}

/// A record of the ground begins with the first dynamic stage, and nothing of it acts before: the motion is that of the record at t = 0,
/// later by the stages before. `shift` counts from t = 0 as ever. The record begins with 0.3, which must not act as a static load.
#[test]
fn a_record_begins_with_the_motion() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let record: String = (0..=400).map(|k| format!("{}\n", 0.3 + pulse(k))).collect();
    let amplitude =
        "[amplitudes.quake]\nkind = \"table\"\nfile = \"record.csv\"\ntime_step = 0.005\nafter = \"zero\"\n";
    let alone = format!("{OSCILLATOR}{SHAKEN}{amplitude}");
    assert_eq!(run(folder, &alone, &record, "alone"), (0, String::new()));
    let one = "[analysis]\nkind = \"dynamic\"\nend_time = 2.0\ntime_step = 0.005\n";
    let stages = "[[stages]]\nname = \"weight\"\nkind = \"static\"\nduration = 1.0\ntime_step = 0.5\n[[stages]]\nname = \"quake\"\n\
                  kind = \"dynamic\"\nduration = 2.0\ntime_step = 0.005\n";
    let staged = alone.replace(one, stages);
    assert_ne!(staged, alone);
    let (code, found) = run(folder, &staged, &record, "staged");
    assert!(code == 0 && found.contains("begins at t = 1, with stage `quake`"), "{found}");
    let (alone, after) = (rows(folder, "alone", "x"), rows(folder, "staged", "x"));
    // Three rows of the static stage; the last is the first of the motion.
    let after = &after[after.len() - alone.len()..];
    let largest = alone.iter().map(|x| (x - 1.0).abs()).fold(0.0, f64::max);
    for (k, (before, after)) in alone.iter().zip(after).enumerate() {
        // Rounding of times near 3, against a motion that turns in 0.1: 1e-14.
        assert!((before - after).abs() < 1e-9 * largest, "{k}: {before} {after}");
    }
    let shifted = staged.replace("after = \"zero\"", "after = \"zero\"\nshift = 0.0");
    assert_eq!(run(folder, &shifted, &record, "shifted").0, 0);
    // Times that do not begin at 0 are those of the run, and so is a record that a load shares.
    let timed: String =
        record.lines().enumerate().map(|(k, value)| format!("{},{value}\n", 1.0 + 0.005 * k as f64)).collect();
    let absolute = staged.replace("time_step = 0.005\nafter", "before = \"zero\"\nafter");
    assert_eq!(run(folder, &absolute, &timed, "absolute"), (0, String::new()));
    let found = rows(folder, "absolute", "x");
    let largest_error =
        found[found.len() - alone.len()..].iter().zip(&alone).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(largest_error < 1e-9 * largest, "{largest_error}");
    let shared = format!("{staged}[[loads]]\nat = \"mass\"\nforce = [0.0, 0.0, 1.0]\namplitude = \"quake\"\n");
    let (_, found) = run(folder, &shared, &record, "shared");
    assert!(!found.contains("with stage `quake`"), "{found}");
    let pushed = rows(folder, "shifted", "x")[2] - 1.0;
    // The static displacement m a/k of the value at t = 1.
    let exact = -2.0 * (0.3 + pulse(200)) / 500.0;
    assert!((pushed - exact).abs() < 1e-9 * exact.abs(), "{pushed} {exact}");
}

/// With `unit` a scale is a factor on the whole record, whatever the header says of it, and files without a header are converted.
#[test]
fn a_unit_leaves_the_scale_to_be_a_factor() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let values: String = (0..=400).map(|k| format!("{:.6}\n", pulse(k))).collect();
    let at2 = format!("A\nB\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 401, DT= .005 SEC\n{values}");
    let deck = |head: &str, keys: &str| {
        format!(
            "{head}{OSCILLATOR}{SHAKEN}[amplitudes.quake]\nkind = \"table\"\nfile = \"record.csv\"\nafter = \"zero\"\n{keys}\n"
        )
    };
    let si = "units = \"SI\"\n";
    assert_eq!(run(folder, &deck(si, "scale = 14.709975"), &at2, "by_hand"), (0, String::new()));
    let wanted = rows(folder, "by_hand", "x");
    for (keys, record) in
        [("unit = \"g\"\nscale = 1.5", &at2), ("unit = \"g\"\nscale = 1.5\ntime_step = 0.005", &values)]
    {
        assert_eq!(run(folder, &deck(si, keys), record, "out"), (0, String::new()), "{keys}");
        let found = rows(folder, "out", "x");
        // 1.5 · 9.80665 in one product or two.
        assert!(wanted.iter().zip(&found).all(|(a, b)| (a - b).abs() < 1e-13), "{keys}");
    }
    for (head, keys, said) in [
        ("", "unit = \"g\"", "`unit` converts a record to the units of the deck"),
        (si, "unit = \"furlong\"", "`furlong` is no unit of a motion"),
        (
            si,
            "unit = \"g\"\n[amplitudes.load]\nkind = \"table\"\nfile = \"record.csv\"\nunit = \"g\"",
            "amplitude `load` gives none",
        ),
        (si, "unit = \"cm/s2\"", "the header of the file says G"),
    ] {
        let (code, found) = run(folder, &deck(head, keys), &at2, "out");
        assert!(code == 3 && found.contains(said), "{keys}: {found}");
    }
    let (code, found) = run(folder, &deck(si, "scale = 1.5"), &at2, "out");
    assert!(code == 0 && found.contains("`unit = \"g\"`"), "{found}");
}

/// A header in seconds shakes a deck of milliseconds as the same points in its units do: 1 m/s² is 1e-3 mm/ms².
#[test]
fn times_of_a_header_are_converted_to_the_units_of_the_deck() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let values: String = (0..=400).map(|k| format!("{:.6}\n", pulse(k))).collect();
    let peer = format!("A\nB\nACCELERATION TIME SERIES IN UNITS OF CM/SEC2\nNPTS= 401, DT= .005 SEC\n{values}");
    let deck = |keys: &str| {
        let oscillator = OSCILLATOR.replace("end_time = 2.0\ntime_step = 0.005", "end_time = 2000.0\ntime_step = 5.0");
        let oscillator = oscillator.replace("stiffness = 500.0", "stiffness = 500.0e-6");
        let amplitude = "[amplitudes.quake]\nkind = \"table\"\nfile = \"record.csv\"\nafter = \"zero\"\n";
        format!("units = \"mm-kg-ms\"\n{oscillator}{SHAKEN}{amplitude}{keys}\n")
    };
    let (code, said) = run(folder, &deck(""), &peer, "header");
    let note = "note: the times of the record `record.csv` are in seconds, and are converted to the units mm-kg-ms";
    assert!(code == 0 && said.contains(note), "{said}");
    let (code, said) = run(folder, &deck("time_step = 5.0\nscale = 1e-5"), &values, "by_hand");
    assert!(code == 0 && !said.contains("times"), "{said}");
    let [header, by_hand] = ["header", "by_hand"].map(|out| rows(folder, out, "x"));
    let most = by_hand.iter().map(|x| (x - 1.0).abs()).fold(0.0, f64::max);
    // The factors of times and values round.
    assert!(most > 0.0 && header.iter().zip(&by_hand).all(|(a, b)| (a - b).abs() < 1e-12 * most.max(1.0)), "{most}");
    let (code, said) = run(folder, &deck("time_step = 0.005"), &peer, "out");
    assert!(code == 3 && said.contains("the header says 0.005 s, in the unit of the deck 5:"), "{said}");
    let columns: String = (0..=400).map(|k| format!("{},{:.6}\n", 5 * k, pulse(k))).collect();
    let (code, said) = run(folder, &deck("scale = 1e-5"), &format!("t [ticks],a\n{columns}"), "out");
    assert!(code == 0 && said.contains("warning: `ticks`, beside the times of the record"), "{said}");
}

/// A record that ends at less than a thousandth of its peak has faded: no warning that its last value is held.
#[test]
fn a_record_of_the_ground_ends_at_zero() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let deck =
        |keys: &str| format!("{OSCILLATOR}{SHAKEN}[amplitudes.quake]\nkind = \"table\"\nfile = \"record.csv\"\n{keys}");
    let motion = |keys: &str, end: &str| {
        let (code, found) = run(folder, &deck(keys), &format!("0,0\n0.5,1\n1.0,0.5\n{end}"), "out");
        assert!(code == 0 && !found.contains("holds its last value"), "{found}");
        rows(folder, "out", "x")
    };
    // As if the next value were zero; a deck may still ask for another end.
    assert_eq!(motion("", ""), motion("", "1.5,0\n"));
    assert_eq!(motion("after = \"hold\"\n", ""), motion("", "100,0.5\n"));
    assert_ne!(motion("", ""), motion("after = \"hold\"\n", ""));
}

/// Steps longer than the distance of the points of a record are warned of where they miss a part of it, and the remedy ends that. A smooth record
/// loses nothing, and neither do steps as long as its own.
#[test]
fn steps_that_miss_a_part_of_the_record_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let said = |frequency: f64, step: f64| {
        let record: String = (0..=200)
            .map(|k| 0.01 * f64::from(k))
            .map(|t| format!("{t},{}\n", (frequency * std::f64::consts::TAU * t).sin()))
            .collect();
        let deck = OSCILLATOR.replace("time_step = 0.005", &format!("time_step = {step:?}"));
        assert!(deck.contains(&format!("time_step = {step:?}")), "{deck}");
        let (code, said) = run(
            folder,
            &format!("{deck}{SHAKEN}[amplitudes.quake]\nkind = \"table\"\nfile = \"record.csv\"\n"),
            &record,
            "out",
        );
        assert_eq!(code, 0, "{said}");
        said.lines().find(|line| line.contains("a step of")).map(str::to_owned)
    };
    // Five samples a period miss 1 + (2 + cos 72°)/3 − 4 (1 − cos 72°)/1.2566² = 0.019 of a sine, and less of its 25 points.
    let told = said(4.0, 0.05).unwrap();
    assert!(told.contains("a step of 0.05 samples the record") && told.contains("about 0.01 apart: 1.8 %"), "{told}");
    assert_eq!(said(4.0, 0.01), None);
    assert_eq!(said(0.5, 0.05), None);
}
