//! Results go back: fields.frd by columns, as its readers take it.

use super::deck;
use assert_cmd::Command;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// A block of values: its name, the kind and the value of its time or mode, and numbers by node.
struct FrdBlock {
    name: String,
    kind: u32,
    value: f64,
    rows: BTreeMap<u64, Vec<f64>>,
}

/// What a file holds: nodes, elements with their types, blocks.
#[derive(Default)]
struct FrdText {
    nodes: BTreeMap<u64, Vec<f64>>,
    elements: Vec<(u32, Vec<u64>)>,
    blocks: Vec<FrdBlock>,
}

impl FrdText {
    fn last(&self, name: &str) -> &FrdBlock {
        self.blocks.iter().rfind(|block| block.name == name).unwrap_or_else(|| panic!("no block {name}"))
    }
}

fn column<T: std::str::FromStr>(line: &str, first: usize, width: usize) -> T {
    let text = line.get(first..(first + width).min(line.len())).unwrap_or_default().trim();
    text.parse().unwrap_or_else(|_| panic!("`{text}` in `{line}`"))
}

/// Numbers in columns of twelve behind the number of a node.
fn row(line: &str) -> (u64, Vec<f64>) {
    let count = (line.len() - 13) / 12;
    (column(line, 3, 10), (0..count).map(|k| column(line, 13 + 12 * k, 12)).collect())
}

fn read(path: &Path) -> FrdText {
    let text = std::fs::read_to_string(path).unwrap();
    let mut file = FrdText::default();
    let (mut place, mut head) = (' ', (0, 0.0));
    assert!(text.starts_with("    1C") && text.ends_with("\n 9999\n") && text.matches("\n 9999\n").count() == 1);
    for line in text.lines() {
        match (line.get(..3).unwrap_or_default(), place) {
            _ if line.starts_with("    2C") => place = 'n',
            _ if line.starts_with("    3C") => place = 'e',
            _ if line.starts_with("  100CL") => head = (column(line, 56, 2), column(line, 12, 12)),
            (" -4", _) => {
                place = 'b';
                let name = line[5..13].trim().to_owned();
                file.blocks.push(FrdBlock { name, kind: head.0, value: head.1, rows: BTreeMap::new() });
            }
            (" -3", _) => place = ' ',
            (" -1", 'n') => drop(file.nodes.insert(row(line).0, row(line).1)),
            (" -1", 'e') => file.elements.push((column(line, 13, 5), Vec::new())),
            (" -2", 'e') => {
                let nodes = (0..(line.len() - 3) / 10).map(|k| column(line, 3 + 10 * k, 10)).collect();
                file.elements.last_mut().unwrap().1 = nodes;
            }
            (" -1", 'b') => drop(file.blocks.last_mut().unwrap().rows.insert(row(line).0, row(line).1)),
            _ => {}
        }
    }
    file
}

/// Runs a file of another program in one go; returns the folder of the run.
fn results(name: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.inp"), deck(name)).unwrap();
    let arguments =
        ["a.inp", "--quiet", "--set", "output.fields={ format = \"frd\" }", "--set", "output.nodes=\"all\""];
    let done = Command::cargo_bin("rdsolve").unwrap().current_dir(folder.path()).args(arguments).output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    folder
}

/// The displacements of the last row of nodes.csv by the number of the node.
fn last_rows(folder: &Path) -> BTreeMap<u64, [f64; 3]> {
    let mut table = csv::Reader::from_path(folder.join("nodes.csv")).unwrap();
    let head = table.headers().unwrap().clone();
    let at = |name: &str| head.iter().position(|other| other == name).unwrap();
    let (node, places) = (at("node"), ["ux", "uy", "uz"].map(at));
    let rows = table.records().map(Result::unwrap).filter_map(|row| {
        let number = row[node].strip_prefix("mesh.")?.parse().ok()?;
        Some((number, places.map(|place| row[place].parse().unwrap())))
    });
    rows.collect()
}

/// A file that is imported and run gives back, in columns, the displacements of nodes.csv to five digits, at nodes with the numbers
/// that they had.
#[test]
fn displacements_come_back() {
    for (name, kinds) in [("beam_pipe", vec![11]), ("plate_s4", vec![9]), ("rigid_edge", vec![9, 11])] {
        let folder = results(name);
        let out = folder.path().join("a.out");
        let file = read(&out.join("fields.frd"));
        let wanted = last_rows(&out);
        let last = file.last("DISP");
        let largest = wanted.values().flatten().fold(0.0, |a: f64, b| a.max(b.abs()));
        assert!(last.kind == 0 && largest > 0.0, "{name}");
        for (node, moved) in &wanted {
            for (a, b) in moved.iter().zip(&last.rows[node]) {
                // Six digits are written, so that half of the sixth is lost.
                assert!((a - b).abs() <= 5e-6 * largest, "{name}, node {node}: {b} for {a}");
            }
        }
        let found: BTreeSet<u32> = file.elements.iter().map(|element| element.0).collect();
        assert_eq!(found.into_iter().collect::<Vec<_>>(), kinds, "{name}");
        assert!(file.elements.iter().flat_map(|element| &element.1).all(|node| file.nodes.contains_key(node)));
        assert_eq!(last.rows.len(), file.nodes.len());
    }
}

/// A strip 0.1 wide and 0.01 thick that a moment of 10 bends: stress 6 M/(b h²) on its upper side, and the strain of Hooke's law.
/// Poisson's ratio is zero. At rotations of 6e-3 the moment is constant along the strip.
#[test]
fn stresses_of_shells_come_back() {
    let folder = results("rigid_edge");
    let file = read(&folder.path().join("a.out/fields.frd"));
    let (stress, strain) = (file.last("STRESS"), file.last("TOSTRAIN"));
    for node in 1..=33 {
        let [stress, strain] = [stress, strain].map(|block| block.rows[&node][0].abs());
        assert!((stress / 6e6 - 1.0).abs() < 1e-4, "node {node}: {stress}");
        // The turn of the axes, 6e-3, counts by its square.
        assert!((strain * 2.1e11 / stress - 1.0).abs() < 1e-4, "node {node}: {strain}");
    }
}

/// Load cases follow each other by their numbers, each a step with displacements of its own.
#[test]
fn load_cases_come_one_by_one() {
    let folder = tempfile::tempdir().unwrap();
    let deck = "[analysis]\nkind = \"static\"\ngeometry = \"linear\"\nend_time = 1.0\ntime_step = 1.0\n[materials.m]\nmodel = \"elastic\"\n\
                youngs_modulus = 1e9\npoisson_ratio = 0.0\n[sections.s]\nshape = \"rectangle\"\nwidth = 0.1\nheight = 0.1\n\
                [points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n[[beams]]\nname = \"rod\"\npath = [\"a\", \"b\"]\nelements = 1\n\
                material = \"m\"\nsection = \"s\"\norientation = [0.0, 1.0, 0.0]\n[[supports]]\nat = \"a\"\nfix = \"all\"\n\
                [[loads]]\nname = \"pull\"\nat = \"b\"\nforce = [10.0, 0.0, 0.0]\n\
                [[load_cases]]\nname = \"once\"\nloads = [\"pull\"]\n[[load_cases]]\nname = \"twice\"\nloads = [\"pull\"]\nfactors = [2.0]\n\
                [[combinations]]\nname = \"both\"\ncases = [\"once\", \"twice\"]\n[output]\nfields = { format = \"frd\" }\n";
    std::fs::write(folder.path().join("a.toml"), deck).unwrap();
    let done = Command::cargo_bin("rdsolve").unwrap().current_dir(folder.path()).args(["a.toml", "--quiet"]).output();
    let done = done.unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let file = read(&folder.path().join("a.out/fields.frd"));
    let found: Vec<f64> = file.blocks.iter().filter(|block| block.name == "DISP").map(|block| block.value).collect();
    assert_eq!(found, [1.0, 2.0, 3.0]);
    // F L/(E A) of 1e-6, 2e-6 and their sum.
    let moved = file.blocks.iter().filter(|block| block.name == "DISP");
    for (block, wanted) in moved.zip([1e-6, 2e-6, 3e-6]) {
        let most = block.rows.values().map(|row| row[0]).fold(0.0, f64::max);
        assert!((most / wanted - 1.0).abs() < 1e-5, "{most:e} for {wanted:e}");
    }
}

/// Modes come with their frequencies, each with a shape whose largest displacement or rotation is 1.
#[test]
fn modes_come_back() {
    let folder = results("hinge");
    let out = folder.path().join("a.out");
    let file = read(&out.join("fields.frd"));
    let mut table = csv::Reader::from_path(out.join("modes.csv")).unwrap();
    let at = table.headers().unwrap().iter().position(|name| name == "frequency").unwrap();
    let frequencies: Vec<f64> = table.records().map(|row| row.unwrap()[at].parse().unwrap()).collect();
    let modes: Vec<&FrdBlock> = file.blocks.iter().filter(|block| block.kind == 2).collect();
    assert!(!modes.is_empty() && modes.len() == frequencies.len());
    for (mode, frequency) in modes.iter().zip(frequencies) {
        assert!((mode.value / frequency - 1.0).abs() <= 5e-6, "{} for {frequency}", mode.value);
        assert_eq!(mode.rows.len(), file.nodes.len());
    }
}
