//! docs/results.md: every column of every table of results, from their registry, and the arrays of the fields.

use super::{cell, keep, rdsolve, read, root, with_generated};
use crate::support::grid::Grid;
use rdsolve::output::TABLES;
use rdsolve::quantities::{Column, STEP, TIME};
use serde_json::Value;
use std::fmt::Write;

fn results_reference() -> String {
    let mut text = format!(
        "\nEvery table begins with two columns. `step` is the {}. `time` is the {}.\n",
        STEP.meaning, TIME.meaning
    );
    for table in TABLES {
        let _ = write!(text, "\n### {}\n\n{}\n\n", table.file, table.about);
        text += "| column | meaning | unit | axes | positive |\n|---|---|---|---|---|\n";
        let columns: Vec<Column> = table.columns().skip(2).collect();
        // Components of a vector share a row.
        for like in columns.chunk_by(|a, b| (a.meaning, a.unit, a.axes, a.sign) == (b.meaning, b.unit, b.axes, b.sign))
        {
            let names: Vec<String> = like.iter().map(|column| format!("`{}`", column.name)).collect();
            let c = like[0];
            let _ =
                writeln!(text, "| {} | {} | {} | {} | {} |", names.join(" "), cell(c.meaning), c.unit, c.axes, c.sign);
        }
    }
    text + "\n"
}

#[test]
fn the_results_reference_is_the_registry() {
    let page = read(&root().join("docs/results.md"));
    keep("docs/results.md", &with_generated(&page, &results_reference()));
}

/// The arrays of the fields that two decks of the tutorial write stand in the page.
#[test]
fn the_results_reference_names_the_arrays_of_fields() {
    let folder = tempfile::tempdir().unwrap();
    let page = read(&root().join("docs/results.md"));
    for deck in ["plate", "cab"] {
        let (path, out) = (format!("decks/tutorial/{deck}.toml"), folder.path().join(deck));
        let short = ["--set", "analysis.end_time=0.05", "--set", "expect=[]", "--set", "output.fields.every=1000000"];
        rdsolve(&[&[&path, "-o", out.to_str().unwrap(), "--quiet"][..], &short].concat()).assert().code(0);
        let grid = Grid::read(&out.join("fields_000000.vtu")).xml;
        let data = ["<PointData>", "<CellData>"]
            .map(|section| grid.split_once(section).unwrap().1.split_once("Data>").unwrap().0);
        for name in data.iter().flat_map(|section| section.split("Name=\"").skip(1)) {
            let name = name.split('"').next().unwrap();
            assert!(page.contains(&format!("`{name}`")), "docs/results.md does not say what `{name}` of the fields is");
        }
    }
}

/// So do the keys of result.json.
#[test]
fn the_results_reference_names_the_keys_of_the_result() {
    let folder = tempfile::tempdir().unwrap();
    let page = read(&root().join("docs/results.md"));
    let out = folder.path().join("out");
    rdsolve(&["decks/tutorial/block_on_beam.toml", "-o", out.to_str().unwrap(), "--quiet"]).assert().code(0);
    let result: Value = serde_json::from_str(&read(&out.join("result.json"))).unwrap();
    let inner = ["sizes", "counts", "timings"].map(|key| &result[key]);
    let objects = inner.into_iter().chain([&result, &result["expectations"][0]]);
    for key in objects.flat_map(|object| object.as_object().unwrap().keys()) {
        assert!(page.contains(&format!("`{key}`")), "docs/results.md does not say what `{key}` of result.json is");
    }
}
