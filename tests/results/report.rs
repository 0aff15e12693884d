//! The page of `rdsolve report`: whole, of one piece, and nothing in it is taken for markup.

use crate::support;
use assert_cmd::Command;
use base64::prelude::{BASE64_STANDARD, Engine};
use rdsolve::model::Cadence;
use rdsolve::output::report::page as page_of;
use serde_json::Value;
use std::fs;
use std::io::Read;
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
    assert_eq!((page.matches("<script").count(), page.matches("</script>").count()), (3, 3));
    assert!(page.starts_with("<!DOCTYPE html>") && page.trim_end().ends_with("</html>"));
}

/// What the page's script reads, with the bytes of its numbers.
pub fn data(page: &str) -> (Value, Vec<u8>) {
    let json = |id: &str| -> Value {
        let begin = page.split_once(&format!("id=\"{id}\">")).unwrap().1;
        serde_json::from_str(begin.split_once("</script>").unwrap().0).unwrap()
    };
    let packed = BASE64_STANDARD.decode(json("packed").as_str().unwrap()).unwrap();
    let mut bytes = Vec::new();
    flate2::read::ZlibDecoder::new(&packed[..]).read_to_end(&mut bytes).unwrap();
    (json("data"), bytes)
}

/// Rows of numbers as the page reads them.
pub fn floats(bytes: &[u8], from: &Value) -> Vec<f32> {
    let [place, count, width] = [0, 1, 2].map(|k| from[k].as_u64().unwrap() as usize);
    let (mut found, mut at) = (vec![0.0; count], place);
    for column in 0..width {
        for number in found[column.min(count)..].iter_mut().step_by(width) {
            *number = f32::from_be_bytes([0, 1, 2, 3].map(|byte| bytes[at + byte * count]));
            at += 1;
        }
    }
    found
}

fn places(base64: &Value) -> Vec<u32> {
    let bytes = BASE64_STANDARD.decode(base64.as_str().unwrap()).unwrap();
    bytes.as_chunks().0.iter().map(|&four| u32::from_le_bytes(four)).collect()
}

/// The places of rows of marks: a point of the scene and the way from there.
fn marked(rows: &Value, x0: &[f32]) -> Vec<[f64; 3]> {
    let place = |row: &Value| {
        let number = |k: usize| row[k].as_f64().unwrap();
        [0, 1, 2].map(|k| f64::from(x0[3 * number(0) as usize + k]) + number(1 + k))
    };
    rows.as_array().unwrap().iter().map(place).collect()
}

/// Supports, loads and joints stand where the deck has them, a body's beside the points of the scene; beams have their section; stages their ends. Points
/// of pages have seven digits.
#[test]
fn supports_loads_joints_sections_and_stages_are_marked() {
    let deck = r#"
[[stages]]
name = "weight"
kind = "static"
duration = 1.0
time_step = 0.5
[[stages]]
name = "push"
kind = "static"
duration = 2.0
time_step = 1.0
[materials]
steel = { model = "elastic", youngs_modulus = 210e9, poisson_ratio = 0.3, density = 7850.0 }
[sections]
pipe = { shape = "tube", diameter = 0.2, thickness = 0.01 }
bar = { shape = "rectangle", width = 0.1, height = 0.3 }
[points]
a = [1.0, 0.0, 0.0]
b = [1.0, 0.0, 2.0]
c = [4.0, 0.0, 2.0]
[[beams]]
name = "post"
path = ["a", "b"]
elements = 2
material = "steel"
section = "pipe"
orientation = [0.0, 1.0, 0.0]
[[beams]]
name = "arm"
path = ["b", "c"]
elements = 1
material = "steel"
section = "bar"
orientation = [0.0, 1.0, 0.0]
[[bodies]]
name = "weight"
center = [4.5, 0.0, 2.0]
mass = 10.0
shape = { kind = "box", size = [0.2, 0.2, 0.2] }
[[joints]]
name = "hinge"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
from = { node = "c" }
to = { body = "weight" }
stiffness = 1e5
[[supports]]
at = "a"
fix = "all"
[[supports]]
at = "b"
fix = ["uy"]
[[loads]]
at = "weight"
force = [0.0, 0.0, -30.0]
[[loads]]
at = "c"
moment = [0.0, 4.0, 0.0]
stages = ["push"]
[output]
fields = { format = "vtu", every = 1 }
"#;
    let (folder, page) = page(deck, 0);
    let (data, bytes) = data(&page);
    assert_eq!(data["stages"], serde_json::json!([["weight", 1.0], ["push", 3.0]]));
    let (scene, x0) = (&data["scene"], floats(&bytes, &data["scene"]["x0"]));
    let marks = &scene["marks"];
    let near = |found: &[[f64; 3]], wanted: &[[f64; 3]]| {
        found.len() == wanted.len()
            && found.iter().flatten().zip(wanted.iter().flatten()).all(|(a, b)| (a - b).abs() < 1e-6)
    };
    let supports = marked(&marks["supports"], &x0);
    assert!(near(&supports, &[[1.0, 0.0, 0.0], [1.0, 0.0, 2.0]]), "{supports:?}");
    assert_eq!([0, 1].map(|k| marks["supports"][k][4].as_f64().unwrap()), [63.0, 2.0]);
    let loads = marked(&marks["loads"], &x0);
    assert!(near(&loads, &[[4.0, 0.0, 2.0], [4.5, 0.0, 2.0]]), "{loads:?}");
    assert_eq!([marks["loads"][0][8].as_f64(), marks["loads"][1][6].as_f64()], [Some(4.0), Some(-30.0)]);
    let joints = marked(&marks["joints"], &x0);
    assert!(near(&joints, &[[4.0, 0.0, 2.0]]), "{joints:?}");
    let sizes = serde_json::json!([{ "radius": 0.1 }, { "y": [-0.05, 0.05], "z": [-0.15, 0.15] }]);
    assert_eq!(marks["sections"], sizes);
    let of_cells = BASE64_STANDARD.decode(marks["cellSections"].as_str().unwrap()).unwrap();
    assert_eq!(of_cells[..3], [1, 1, 2]);
    assert!(of_cells[3..].iter().all(|section| *section == 0));
    // The y axis of the post is that of the deck.
    assert_eq!(floats(&bytes, &marks["sectionY"])[..3], [0.0, 1.0, 0.0]);

    // The boundary has a row of each stage, which a pivot by stage tells apart.
    let table = fs::read_to_string(folder.path().join("x.out/energy.csv")).unwrap();
    let rows: Vec<Vec<&str>> = table.lines().map(|row| row.split(',').take(3).collect()).collect();
    assert_eq!(rows[0], ["step", "time", "stage"]);
    assert_eq!([&rows[3], &rows[4]], [&["2", "1.0", "weight"], &["2", "1.0", "push"]]);

    rdsolve(folder.path(), &["report", "x.out", "--picture"]).code(0);
    let picture = fs::read_to_string(folder.path().join("x.svg")).unwrap();
    let count = |class: &str| picture.matches(&format!("class=\"{class}\"")).count();
    assert_eq!(["h", "a", "j"].map(count), [2, 2, 1]);
    // Every line is one of a beam, and wider than those without a section.
    let lines = count("l");
    assert!(lines > 1 && picture.matches("stroke-linecap:butt").count() == lines);
}

#[test]
fn shells_with_fields_move_and_names_are_only_names() {
    let (folder, page) = page(&format!("{PLATE}{FIELDS}"), 5);
    assert!(page.contains("A plate &lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt; &amp; co"));
    assert!(page.contains("&lt;b&gt;made up&lt;/b&gt;") && page.contains("MISSED"));
    assert!(page.contains("expectation-missed") && page.contains("1 of 1 expected values missed"));
    // The deck is that of the run to the last byte, so its text is there; plan and counts too.
    assert!(page.contains("[materials.steel]") && page.contains("<h2>Plan</h2>") && page.contains("factorizations"));

    let (data, bytes) = data(&page);
    let scene = &data["scene"];
    let (x0, u, times) = (floats(&bytes, &scene["x0"]), floats(&bytes, &scene["u"]), floats(&bytes, &scene["times"]));
    assert_eq!((x0.len(), u.len()), (3 * 12, 5 * 3 * 12));
    assert_eq!(times, [0.0, 0.25, 0.5, 0.75, 1.0]);
    let names: Vec<&str> = scene["fields"].as_array().unwrap().iter().map(|f| f["name"].as_str().unwrap()).collect();
    assert!(names.contains(&"von_mises_top") && names.contains(&"von_mises_bottom"), "{names:?}");
    assert!(scene["fields"].as_array().unwrap().iter().all(|field| floats(&bytes, &field["values"]).len() == 5 * 6));

    // Numbers of the tables, as they are there.
    let table = |name: &str| data["histories"].as_array().unwrap().iter().find(|t| t["file"] == name).unwrap().clone();
    let nodes = table("nodes.csv");
    assert_eq!(nodes["names"], serde_json::json!(["a", "b", "c", "d"]));
    let (columns, values) = (nodes["columns"].as_array().unwrap(), floats(&bytes, &nodes["values"]));
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
    let (data, bytes) = data(&page);
    let scene = &data["scene"];
    assert_eq!(scene["labels"], serde_json::json!(["ball"]));
    let u = floats(&bytes, &scene["u"]);
    // A free body moves at its speed; Float32 keeps seven digits.
    assert!((u[u.len() - 3] - 1.0).abs() < 1e-6, "{u:?}");
    // 101 times are all there.
    assert!(!page.contains("shown are"));
}

/// Runs a deck and returns its folder, to draw pictures of it.
fn results(deck: &str, code: i32) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("x.toml"), deck).unwrap();
    rdsolve(folder.path(), &["run", "x.toml", "-o", "x.out", "--quiet"]).code(code);
    folder
}

fn picture(folder: &Path, options: &[&str]) -> String {
    rdsolve(folder, &[&["report", "x.out", "--picture", "--quiet", "--overwrite"], options].concat()).code(0);
    fs::read_to_string(folder.join("x.svg")).unwrap()
}

/// The points of the paths with a word in their tag, in pixels: four steps are one.
fn points(picture: &str, word: &str) -> Vec<[f64; 2]> {
    let mut found = Vec::new();
    for tag in picture.split('<').filter(|tag| tag.starts_with("path") && tag.contains(word)) {
        let steps = tag.split_once(" d=\"").unwrap().1.split('"').next().unwrap().replace('-', " -");
        let numbers = steps.split(|c: char| c.is_alphabetic() || c == ' ').filter_map(|text| text.parse::<f64>().ok());
        let mut at = [0.0; 2];
        for step in numbers.collect::<Vec<_>>().as_chunks::<2>().0 {
            at = [at[0] + step[0] / 4.0, at[1] + step[1] / 4.0];
            found.push(at);
        }
    }
    found
}

fn extent(points: &[[f64; 2]], k: usize) -> f64 {
    let all = || points.iter().map(|point| point[k]);
    all().fold(f64::MIN, f64::max) - all().fold(f64::MAX, f64::min)
}

/// The plate lies in the plane of x and y, and is seen from above: six faces, none behind another, at the scale of the bar.
#[test]
fn a_picture_shows_a_plate_at_its_scale_and_names_are_only_names() {
    let folder = results(&format!("{PLATE}{FIELDS}"), 5);
    let picture = picture(folder.path(), &["--width", "400"]);
    assert!(picture.starts_with("<svg ") && picture.contains("viewBox=\"0 0 400 300\""));
    assert!(picture.contains("A plate &lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt; &amp; co"));
    for text in ["von Mises (force/length²)", ">t = 1<", "prefers-color-scheme:dark"] {
        assert!(picture.contains(text), "{text}");
    }
    let bar = picture.split_once("class=\"s\"").unwrap().1;
    let pixels: f64 = bar.split_once("v4h-").unwrap().1.split('v').next().unwrap().parse().unwrap();
    let length: f64 = bar.split_once("\"end\">").unwrap().1.split(' ').next().unwrap().parse().unwrap();
    let faces = points(&picture, "color=");
    for k in 0..2 {
        // Coordinates are whole quarters of a pixel; the bar is written to a tenth.
        let side = extent(&faces, k) * length / pixels;
        assert!((side - 1.0).abs() < 0.01, "a side of 1 is drawn {side} long");
    }
    let fills = picture.split_once("<g class=\"f").unwrap().1.split_once("</g>").unwrap().0;
    assert_eq!(fills.matches('z').count(), 6);
}

/// Of a box three faces are seen, and its start is dashed.
#[test]
fn a_picture_hides_what_lies_behind() {
    let shape = "shape = { kind = \"box\", size = [0.1, 0.2, 0.3] }\n[output]\nfields = { format = \"vtu\" }\n";
    let folder = results(&BALL.replace("shape = { kind = \"sphere\", radius = 0.1 }", shape), 0);
    let picture = picture(folder.path(), &["--time", "0.5"]);
    let fills = picture.split_once("<g class=\"f").unwrap().1.split_once("</g>").unwrap().0;
    assert_eq!(fills.matches('z').count(), 3);
    assert!(picture.contains(">t = 0.5<") && !points(&picture, "class=\"g\"").is_empty());
}

/// A body without fields is a disc; displacements can be magnified, and what makes no picture is refused with its cause.
#[test]
fn a_picture_of_points_and_its_options() {
    let folder = results(BALL, 0);
    let shown = picture(folder.path(), &["--magnify", "2.5"]);
    assert!(shown.contains("<circle") && shown.contains("t = 1, displacements × 2.5"));
    let refused = |options: &[&str], code| {
        let done = rdsolve(folder.path(), &[&["report", "x.out", "-o", "y.svg"], options].concat()).code(code);
        String::from_utf8(done.get_output().stderr.clone()).unwrap()
    };
    assert!(refused(&["--picture", "--time", "2"], 6).contains("no time 2: they go from 0 to 1"));
    assert!(refused(&["--picture", "--magnify", "0"], 2).contains("a number above 0"));
    assert!(refused(&["--time", "1"], 2).contains("--picture"));
    fs::remove_file(folder.path().join("x.out/bodies.csv")).unwrap();
    assert!(refused(&["--picture"], 6).contains("format = \"vtu\""));
    assert!(!folder.path().join("y.svg").exists());
}

/// Without `units`, labels have words such as `length`.
#[test]
fn axes_and_legends_have_the_units_of_the_deck() {
    let (folder, page) = page(&format!("units = \"mm-t-s\"\n{BALL}"), 0);
    for label in ["time (s)", "x (mm)", "vx (mm/s)", "kinetic (mJ)"] {
        assert!(page.contains(label), "{label}");
    }
    let picture = picture(folder.path(), &[]);
    assert!(picture.contains(">t = 1 s<") && picture.contains(" (mm)<"));
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
    let (data, bytes) = data(&page);
    assert!(data["scene"].is_null());
    assert_eq!(floats(&bytes, &data["histories"][0]["times"]), [0.0, 0.1]);
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
        let (data, bytes) = data(&page);
        for history in data["histories"].as_array().unwrap() {
            drawable(&name, history, &bytes, folder.path());
        }
        moves(&name, &data["scene"], &bytes);
        pages += 1;
    }
    assert!(pages > 50, "{pages}");
}

/// A history is as long as its table, has the numbers of its last row, and is not blank where the table is not.
fn drawable(deck: &str, history: &Value, bytes: &[u8], folder: &Path) {
    let file = history["file"].as_str().unwrap();
    let mut reader = csv::Reader::from_path(folder.join(file)).unwrap();
    let header: Vec<String> = reader.headers().unwrap().iter().map(String::from).collect();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    let (columns, names) = (history["columns"].as_array().unwrap(), history["names"].as_array().unwrap());
    let (times, values) = (floats(bytes, &history["times"]), floats(bytes, &history["values"]));
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
fn moves(deck: &str, scene: &Value, bytes: &[u8]) {
    if scene.is_null() {
        return;
    }
    let (times, x0, u) = (floats(bytes, &scene["times"]), floats(bytes, &scene["x0"]), floats(bytes, &scene["u"]));
    assert!(!times.is_empty() && !x0.is_empty() && x0.len().is_multiple_of(3), "{deck}");
    assert_eq!(u.len(), times.len() * x0.len(), "{deck}");
    assert!(x0.iter().chain(&u).chain(&times).all(|number| number.is_finite()), "{deck}");
    let cells = BASE64_STANDARD.decode(scene["kinds"].as_str().unwrap()).unwrap().len();
    for (key, per, of) in [("triangles", 3, "triangleCells"), ("lines", 2, "lineCells"), ("edges", 2, "")] {
        let points = places(&scene[key]);
        assert!(points.iter().all(|&point| (point as usize) < x0.len() / 3), "{deck}: {key}");
        if !of.is_empty() {
            let of = places(&scene[of]);
            assert!(of.len() == points.len() / per && of.iter().all(|&cell| (cell as usize) < cells), "{deck}: {key}");
        }
    }
    for field in scene["fields"].as_array().unwrap() {
        let values = floats(bytes, &field["values"]);
        assert_eq!(values.len(), times.len() * cells, "{deck}: {}", field["name"]);
        assert!(values.iter().all(|value| value.is_finite()), "{deck}: {}", field["name"]);
    }
}
