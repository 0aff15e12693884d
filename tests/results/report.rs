//! The page of `rdsolve report`: whole, of one piece, and nothing in it is taken for markup.

use crate::support;
use assert_cmd::Command;
use base64::prelude::{BASE64_STANDARD, Engine};
use rdsolve::model::Cadence;
use rdsolve::output::report::page as page_of;
use serde_json::Value;
use std::fs;
use std::path::Path;

const PLATE: &str = r#"
title = "A plate <script>alert('x')</script> & co"
[analysis]
kind = "static"
end_time = 1.0
time_step = 0.25
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
[[shells]]
name = "plate"
corners = ["a", "b", "c", "d"]
elements = [2, 3]
material = "steel"
thickness = 0.01
[[supports]]
at = ["a", "d"]
fix = "all"
[[loads]]
at = "b"
force = [0.0, 0.0, -10.0]
[[expect]]
at = "b"
quantity = "uz"
time = 1.0
value = -1.0
tolerance = 1e-3
source = "<b>made up</b>"
"#;
const FIELDS: &str = "[output]\nfields = { format = \"vtu\", every = 1 }\nsections = true\n";
const BALL: &str = r#"
[analysis]
kind = "dynamic"
end_time = 1.0
time_step = 0.01
[[bodies]]
name = "ball"
center = [0.0, 0.0, 0.0]
mass = 1.0
velocity = [1.0, 0.0, 0.0]
shape = { kind = "sphere", radius = 0.1 }
"#;

fn rdsolve(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::cargo_bin("rdsolve").unwrap().current_dir(folder).args(arguments).assert()
}

/// Runs a deck into `x.out` with this exit code and makes its page.
fn page(deck: &str, code: i32) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("x.toml"), deck).unwrap();
    rdsolve(folder.path(), &["x.toml", "--quiet"]).code(code);
    rdsolve(folder.path(), &["report", "x.out"]).code(0);
    let text = fs::read_to_string(folder.path().join("x.html")).unwrap();
    sound(&text);
    (folder, text)
}

/// Of one piece: nothing from elsewhere, nothing left to fill in, as many scripts as we wrote.
fn sound(page: &str) {
    for word in ["http:", "https:", "src=", "@import", "url(", "{{"] {
        assert!(!page.contains(word), "{word}");
    }
    assert_eq!((page.matches("<script").count(), page.matches("</script>").count()), (2, 2));
    assert!(page.starts_with("<!DOCTYPE html>") && page.trim_end().ends_with("</html>"));
}

/// What the page's script reads.
pub fn data(page: &str) -> Value {
    let begin = page.split_once("id=\"data\">").unwrap().1;
    serde_json::from_str(begin.split_once("</script>").unwrap().0).unwrap()
}

pub fn floats(base64: &Value) -> Vec<f32> {
    let bytes = BASE64_STANDARD.decode(base64.as_str().unwrap()).unwrap();
    bytes.as_chunks().0.iter().map(|&four| f32::from_le_bytes(four)).collect()
}

#[test]
fn shells_with_fields_move_and_names_are_only_names() {
    let (folder, page) = page(&format!("{PLATE}{FIELDS}"), 5);
    assert!(page.contains("A plate &lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt; &amp; co"));
    assert!(page.contains("&lt;b&gt;made up&lt;/b&gt;") && page.contains("MISSED"));
    assert!(page.contains("expectation-missed") && page.contains("1 of 1 expected values missed"));
    // The deck is that of the run to the last byte, so its text is there; plan and counts too.
    assert!(page.contains("[materials.steel]") && page.contains("<h2>Plan</h2>") && page.contains("factorizations"));

    let data = data(&page);
    let scene = &data["scene"];
    let (x0, u, times) = (floats(&scene["x0"]), floats(&scene["u"]), floats(&scene["times"]));
    assert_eq!((x0.len(), u.len()), (3 * 12, 5 * 3 * 12));
    assert_eq!(times, [0.0, 0.25, 0.5, 0.75, 1.0]);
    let names: Vec<&str> = scene["fields"].as_array().unwrap().iter().map(|f| f["name"].as_str().unwrap()).collect();
    assert!(names.contains(&"von_mises_top") && names.contains(&"von_mises_bottom"), "{names:?}");
    assert!(scene["fields"].as_array().unwrap().iter().all(|field| floats(&field["values"]).len() == 5 * 6));

    // Numbers of the tables, as they are there.
    let table = |name: &str| data["histories"].as_array().unwrap().iter().find(|t| t["file"] == name).unwrap().clone();
    let nodes = table("nodes.csv");
    assert_eq!(nodes["names"], serde_json::json!(["a", "b", "c", "d"]));
    let (columns, values) = (nodes["columns"].as_array().unwrap(), floats(&nodes["values"]));
    let uz = columns.iter().position(|column| column == "uz").unwrap();
    // At the fifth time, of the second of four nodes.
    let last = values[(4 * 4 + 1) * columns.len() + uz];
    let csv = fs::read_to_string(folder.path().join("x.out/nodes.csv")).unwrap();
    let row = csv.lines().rfind(|line| line.contains(",b,")).unwrap();
    let place = csv.lines().next().unwrap().split(',').position(|column| column == "uz").unwrap();
    assert_eq!(last, row.split(',').nth(place).unwrap().parse::<f64>().unwrap() as f32);
    // The corner that is loaded moves as far in the scene: of the points at (1, 0, 0), the one.
    let corner = (0..12).find(|p| x0[3 * p..3 * p + 3] == [1.0, 0.0, 0.0]).unwrap();
    assert_eq!(u[4 * 36 + 3 * corner + 2], last);
    assert_eq!(table("shells.csv")["names"].as_array().unwrap().len(), 6);
}

#[test]
fn without_fields_bodies_and_nodes_are_points() {
    let (_, page) = page(BALL, 0);
    let data = data(&page);
    let scene = &data["scene"];
    assert_eq!(scene["labels"], serde_json::json!(["ball"]));
    let u = floats(&scene["u"]);
    // A free body moves at its speed; Float32 keeps seven digits.
    assert!((u[u.len() - 3] - 1.0).abs() < 1e-6, "{u:?}");
    // 101 times are all there.
    assert!(!page.contains("shown are"));
}

#[test]
fn a_table_alone_is_enough_and_an_unfinished_run_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let results = folder.path().join("killed");
    fs::create_dir(&results).unwrap();
    fs::write(results.join("energy.csv"), "step,time,kinetic,mechanical\n0,0.0,1.0,1.0\n1,0.1,2.0,2.0\n2,0.").unwrap();
    let done = rdsolve(folder.path(), &["report", "killed", "-o", "page.html"]).code(0);
    assert!(String::from_utf8(done.get_output().stdout.clone()).unwrap().starts_with("page.html, "));
    let page = fs::read_to_string(folder.path().join("page.html")).unwrap();
    sound(&page);
    assert!(page.contains("unfinished"));
    let data = data(&page);
    assert!(data["scene"].is_null());
    assert_eq!(floats(&data["histories"][0]["times"]), [0.0, 0.1]);
}

#[test]
fn a_failed_run_has_its_reason() {
    let root = tempfile::tempdir().unwrap();
    let results = root.path().join("r");
    fs::create_dir(&results).unwrap();
    fs::write(
        results.join("result.json"),
        r#"{ "status": "not-converged", "reason": "at t = 0.5: <no> equilibrium" }"#,
    )
    .unwrap();
    rdsolve(root.path(), &["report", "r", "--quiet"]).code(0);
    let page = fs::read_to_string(root.path().join("r.html")).unwrap();
    sound(&page);
    assert!(page.contains("not-converged") && page.contains("at t = 0.5: &lt;no&gt; equilibrium"));
}

#[test]
fn nothing_is_overwritten_unasked_and_nothing_is_made_of_nothing() {
    let root = tempfile::tempdir().unwrap();
    let said = |arguments: &[&str], code| {
        String::from_utf8(rdsolve(root.path(), arguments).code(code).get_output().stderr.clone()).unwrap()
    };
    assert!(said(&["report", "none"], 6).contains("none"));
    fs::create_dir(root.path().join("empty")).unwrap();
    assert!(said(&["report", "empty"], 6).contains("no results"));
    assert!(!root.path().join("empty.html").exists());
    fs::create_dir(root.path().join("r")).unwrap();
    fs::write(root.path().join("r/result.json"), "{}").unwrap();
    fs::write(root.path().join("r.html"), "kept").unwrap();
    assert!(said(&["report", "r"], 2).contains("--overwrite"));
    assert_eq!(fs::read_to_string(root.path().join("r.html")).unwrap(), "kept");
    said(&["report", "r", "--overwrite"], 0);
    assert!(fs::read_to_string(root.path().join("r.html")).unwrap().starts_with("<!DOCTYPE"));
    // A folder is no file, and a grid that is none of ours is named.
    said(&["report", "r", "-o", "empty", "--overwrite"], 6);
    fs::write(root.path().join("r/fields.pvd"), "<DataSet timestep=\"0\" part=\"0\" file=\"f.vtu\"/>\n").unwrap();
    fs::write(root.path().join("r/f.vtu"), "<VTKFile/>").unwrap();
    assert!(said(&["report", "r", "--overwrite"], 6).contains("f.vtu: this grid has not"));
    // Names of grids stay in the folder.
    fs::write(root.path().join("r/fields.pvd"), "<DataSet timestep=\"0\" part=\"0\" file=\"../x\"/>\n").unwrap();
    said(&["report", "r", "--overwrite"], 0);
}

/// Every deck for some steps, its files in a folder, and the page of that folder: each chart can be drawn from what it carries.
#[test]
fn the_page_of_every_deck_shows_its_tables() {
    /// Times, which is enough for all tables and fields to have some rows.
    const STEPS: usize = 2;
    let mut pages = 0;
    for name in support::deck_names() {
        let mut model = support::read(&name, &[]);
        let output = &mut model.output;
        (output.cadence, output.energy) = (Cadence::Steps(1), true);
        (output.links, output.contacts, output.reactions, output.sections, output.parts) = (
            true,
            Some(rdsolve::model::ContactRows::Contacts),
            true,
            Some(rdsolve::model::SectionPlaces::Points),
            true,
        );
        let folder = tempfile::tempdir().unwrap();
        support::write(&model, folder.path(), STEPS);
        let page = page_of(folder.path()).unwrap_or_else(|error| panic!("{name}: {error}"));
        sound(&page);
        let data = data(&page);
        for history in data["histories"].as_array().unwrap() {
            drawable(&name, history, folder.path());
        }
        moves(&name, &data["scene"]);
        pages += 1;
    }
    assert!(pages > 50, "{pages}");
}

/// A history is as long as its table, has the numbers of its last row, and is not blank where the table is not.
fn drawable(deck: &str, history: &Value, folder: &Path) {
    let file = history["file"].as_str().unwrap();
    let mut reader = csv::Reader::from_path(folder.join(file)).unwrap();
    let header: Vec<String> = reader.headers().unwrap().iter().map(String::from).collect();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    let (columns, names) = (history["columns"].as_array().unwrap(), history["names"].as_array().unwrap());
    let (times, values) = (floats(&history["times"]), floats(&history["values"]));
    assert!(times.iter().all(|time| time.is_finite()), "{deck}: {file}");
    assert_eq!(values.len(), times.len() * names.len() * columns.len(), "{deck}: {file}");
    let mut written: Vec<&str> = rows.iter().map(|row| &row[1]).collect();
    written.dedup();
    assert_eq!(written.len(), times.len(), "{deck}: times of {file}");
    for key in ["kinds", "labels"] {
        assert_eq!(history[key].as_array().unwrap().len(), columns.len(), "{deck}: {file}");
    }
    for (place, column) in columns.iter().enumerate() {
        let column = column.as_str().unwrap();
        let at = header.iter().position(|other| other == column).unwrap();
        let numbers = rows.iter().filter(|row| row[at].parse::<f64>().is_ok_and(f64::is_finite)).count();
        let shown = values.iter().skip(place).step_by(columns.len()).filter(|value| value.is_finite()).count();
        // Of too many names some are left out, so there may be fewer; but all numbers or gaps alike.
        let all = names.len() * times.len() == rows.len();
        assert!(
            if all { shown == numbers } else { (shown > 0) == (numbers > 0) },
            "{deck}: {file}: {column}: {shown} of {numbers}"
        );
    }
    let last = &rows.last().unwrap();
    if names.len() * times.len() == rows.len() {
        let of_last = &values[values.len() - columns.len()..];
        for (column, &value) in columns.iter().zip(of_last) {
            let at = header.iter().position(|other| other == column.as_str().unwrap()).unwrap();
            let wanted = last[at].parse::<f64>().map_or(f32::NAN, |number| number as f32);
            assert!(
                value.to_bits() == wanted.to_bits() || value.is_nan() && wanted.is_nan(),
                "{deck}: {file}: {column}"
            );
        }
    }
}

/// A scene has a place for each point at each time, and its cells name points that are there.
fn moves(deck: &str, scene: &Value) {
    if scene.is_null() {
        return;
    }
    let (times, x0, u) = (floats(&scene["times"]), floats(&scene["x0"]), floats(&scene["u"]));
    assert!(!times.is_empty() && !x0.is_empty() && x0.len().is_multiple_of(3), "{deck}");
    assert_eq!(u.len(), times.len() * x0.len(), "{deck}");
    assert!(x0.iter().chain(&u).chain(&times).all(|number| number.is_finite()), "{deck}");
    let cells = BASE64_STANDARD.decode(scene["kinds"].as_str().unwrap()).unwrap().len();
    let places = |key: &str| floats(&scene[key]).into_iter().map(f32::to_bits).collect::<Vec<u32>>();
    for (key, per, of) in [("triangles", 3, "triangleCells"), ("lines", 2, "lineCells"), ("edges", 2, "")] {
        let points = places(key);
        assert!(points.iter().all(|&point| (point as usize) < x0.len() / 3), "{deck}: {key}");
        if !of.is_empty() {
            let of = places(of);
            assert!(of.len() == points.len() / per && of.iter().all(|&cell| (cell as usize) < cells), "{deck}: {key}");
        }
    }
    for field in scene["fields"].as_array().unwrap() {
        let values = floats(&field["values"]);
        assert_eq!(values.len(), times.len() * cells, "{deck}: {}", field["name"]);
        assert!(values.iter().all(|value| value.is_finite()), "{deck}: {}", field["name"]);
    }
}
