//! Sections by station from files of BeamDyn: the numbers of the same beam in the deck, and refusals with their place.

use crate::mesh::Folder;
use crate::support::{node, position, read_deck, run_to_the_end};

/// By forces along x, y, z and moments about them, z along the blade.
const STIFFNESS: [[f64; 6]; 6] = [
    [4e4, 0.0, 0.0, 0.0, 0.0, 90.0],
    [0.0, 3e4, 0.0, 0.0, 0.0, -70.0],
    [0.0, 0.0, 2e5, 300.0, -200.0, 0.0],
    [0.0, 0.0, 300.0, 80.0, 4.0, 6.0],
    [0.0, 0.0, -200.0, 4.0, 120.0, 3.0],
    [90.0, -70.0, 0.0, 6.0, 3.0, 60.0],
];

/// A mass of 2 at x = 0.1, y = -0.05.
const MASS: [[f64; 6]; 6] = [
    [2.0, 0.0, 0.0, 0.0, 0.0, 0.1],
    [0.0, 2.0, 0.0, 0.0, 0.0, 0.2],
    [0.0, 0.0, 2.0, -0.1, -0.2, 0.0],
    [0.0, 0.0, -0.1, 0.045, 0.01, 0.0],
    [0.0, 0.0, -0.2, 0.01, 0.07, 0.0],
    [0.1, 0.2, 0.0, 0.0, 0.0, 0.115],
];

fn scaled(rows: &[[f64; 6]; 6], factor: f64) -> [[f64; 6]; 6] {
    rows.map(|row| row.map(|value| factor * value))
}

/// A blade file whose tip has half of all.
fn blade() -> String {
    let rows = |rows: &[[f64; 6]; 6]| {
        rows.iter().map(|row| row.map(|value| format!("{value:.16E}")).join("  ") + "\n").collect::<String>()
    };
    let station = |at: f64, factor: f64| {
        format!("  {at:.6}\n{}\n{}\n", rows(&scaled(&STIFFNESS, factor)), rows(&scaled(&MASS, factor)))
    };
    format!(
        " ------- BEAMDYN V1.00.* INDIVIDUAL BLADE INPUT FILE --------------------------\n A blade of two stations\n\
         ---------------------- BLADE PARAMETERS --------------------------------------\n2   station_total    - Number of stations\n\
         0   damp_type        - Damping type\n  ---------------------- DAMPING COEFFICIENT ------------------------------------\n\
         mu1  mu2  mu3  mu4  mu5  mu6\n(-)  (-)  (-)  (-)  (-)  (-)\n1E-3  1E-3  1E-3  1E-3  1E-3  1E-3\n\
         ---------------------- DISTRIBUTED PROPERTIES ---------------------------------\n{}{}",
        station(0.0, 1.0),
        station(1.0, 0.5)
    )
}

const PRIMARY: &str = "--------- BEAMDYN INPUT FILE -----\nA blade\n---------------------- GEOMETRY PARAMETER -----\n\
    1   member_total    - Total number of members (-)\n3   kp_total   - Total number of key points (-)\n1  3   - Member number; Number of key points\n\
    kp_xr  kp_yr  kp_zr  initial_twist\n(m)  (m)  (m)  (deg)\n0.0 0.0 0.0 0.0\n0.0 0.0 1.5 9.0\n0.0 0.0 2.0 30.0\n\
    ---------------------- MESH PARAMETER -----\n\"blade.dat\"    BldFile - Name of the file\n";

/// The rows of the deck: x along the beam.
fn turned(rows: &[[f64; 6]; 6]) -> [[f64; 6]; 6] {
    let places = [2, 0, 1, 5, 3, 4];
    places.map(|i| places.map(|j| rows[i][j]))
}

fn deck(keys: &str) -> String {
    format!(
        "analysis = {{ kind = \"dynamic\", end_time = 0.1, time_step = 1e-3 }}\npoints = {{ a = [0.0, 0.0, 0.0], b = [0.0, 0.0, 2.0] }}\n\
         beams = [{{ name = \"blade\", path = [\"a\", \"b\"], elements = 4, orientation = [1.0, 0.0, 0.0], {keys} }}]\n\
         supports = [{{ at = \"a\", fix = \"all\" }}]\nloads = [{{ at = \"b\", force = [9.0, 13.0, 5.0] }}]\n"
    )
}

fn moved(model: &rdsolve::model::Model) -> Vec<Vec<f64>> {
    let at = node(model, "b");
    run_to_the_end(model, &mut |frame| position(&frame.state.nodes[at]).to_vec()).rows
}

fn near(a: &[Vec<f64>], b: &[Vec<f64>]) {
    let off = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let [first, last] = [&a[0], &a[a.len() - 1]];
    let size = first.iter().zip(last).map(|(first, last)| (first - last).abs()).fold(0.0, f64::max);
    // The tolerance of the iteration.
    assert!(off < 1e-8 && size > 1e-3, "{off:e} of {size}");
}

/// A blade file is the general section of its rows, turned to local axes; the primary file adds the twist about −z.
#[test]
fn files_of_beamdyn_are_the_sections_of_the_deck() {
    let sections: String = [("root", 1.0), ("tip", 0.5)]
        .map(|(name, factor)| {
            let [stiffness, mass] = [&STIFFNESS, &MASS].map(|rows| turned(&scaled(rows, factor)));
            format!("sections.{name} = {{ shape = \"general\", stiffness = {stiffness:?}, mass = {mass:?} }}\n")
        })
        .concat();
    let folder = Folder::with(&[("blade.dat", &blade()), ("primary.dat", PRIMARY)]);
    for (file, stations) in [
        ("blade.dat", "{ at = 0.0, section = \"root\" }, { at = 1.0, section = \"tip\" }".to_owned()),
        ("primary.dat", {
            let [middle, end] = [9.0f64, 30.0].map(|degrees| -degrees.to_radians());
            format!(
                "{{ at = 0.0, section = \"root\" }}, {{ at = 0.75, section = \"mid\", twist = {middle:?} }}, {{ at = 1.0, section = \"tip\", twist = {end:?} }}"
            )
        }),
    ] {
        let [stiffness, mass] = [&STIFFNESS, &MASS].map(|rows| turned(&scaled(rows, 0.625)));
        let middle = format!("sections.mid = {{ shape = \"general\", stiffness = {stiffness:?}, mass = {mass:?} }}\n");
        let middle = if file == "primary.dat" { middle } else { String::new() };
        let of_deck = moved(&read_deck(&(deck(&format!("stations = [{stations}]")) + &sections + &middle)));
        near(&moved(&folder.model(&deck(&format!("station_file = \"{file}\"")))), &of_deck);
    }
}

#[test]
fn wrong_files_are_refused_with_their_place() {
    let told = |text: &str| {
        let folder = Folder::with(&[("blade.dat", text)]);
        folder.read(&deck("station_file = \"blade.dat\"")).1
    };
    let sound = blade();
    assert_eq!(told(&sound), "");
    for (text, message) in [
        (sound.replace("2   station_total", "3   station_total"), "has 146 numbers for 3 stations of 73"),
        (sound.replace("  1.000000\n", "  0.900000\n"), "do not rise from 0 to 1"),
        (sound.replace("4.0000000000000000E4 ", "-4.0E4 "), "`stiffness` is not positive definite"),
        (sound.replace("4.0000000000000000E4 ", "four "), "`four` is no number"),
        (sound.replace("station_total", "stations"), "has no line `station_total`"),
        (sound.replace("0   damp_type", "1   damp_type"), "the damping in"),
    ] {
        let said = told(&text);
        assert!(said.contains(message), "{message}\n{said}");
    }
    let missing = Folder::with(&[]).read(&deck("station_file = \"blade.dat\"")).1;
    assert!(missing.contains("cannot read the stations"), "{missing}");
    let both = Folder::with(&[("blade.dat", &sound)]).read(&deck("station_file = \"blade.dat\", section = \"x\"")).1;
    assert!(both.contains("`section` does not apply to a beam with `station_file`"), "{both}");
}
