//! One HTML file of a folder of results: tables, plots, the moving scene. It opens without a network and holds all it needs:
//! our own style and scripts from the files beside this one, numbers as base64 arrays of Float32.
//!
//! Its size is bounded: histories and grids are thinned, which the page says.

mod data;
mod grids;
mod histories;
pub mod html;
mod marks;
mod numbers;
mod picture;
mod picture_marks;
mod points;
mod result;
mod view;

use super::disk::at;
use super::marks::SceneMarks;
use super::tables::TABLES;
use super::torn::torn_tables;
use base::quantities::{ENERGY, Unit, UnitSystem};
use base::text_file::read_regular;
use data::PageScene;
use histories::History;
use html::escaped;
use numbers::PageNumbers;
pub use picture::View;
use serde::Deserialize;
use serde_json::{Value, json};
use std::fs;
use std::io;
use std::path::Path;

/// The page with marks where the parts go.
const PAGE: &str = include_str!("page.html");
/// The style of the page, also used for the page of a study.
pub const STYLE: &str = include_str!("page.css");
/// The column with the energy that the time integration has dissipated or made.
const BALANCE: &str = "numerical";
const SCRIPTS: [&str; 7] = [
    include_str!("data.js"),
    include_str!("plot.js"),
    include_str!("camera.js"),
    include_str!("scene.js"),
    include_str!("flat.js"),
    include_str!("marks.js"),
    include_str!("main.js"),
];

/// The data of a page or a picture of a folder.
struct Contents {
    result: result::Result,
    histories: Vec<History>,
    scene: Option<PageScene>,
    /// The stages over time, each with its end; empty of a run without stages.
    stages: Vec<(String, f32)>,
    /// Sentences on omitted data.
    notes: Vec<String>,
}

impl Contents {
    fn read(folder: &Path) -> io::Result<Contents> {
        let files = table_files(folder)?;
        let json = result_json(&folder.join("result.json"))?;
        if json.is_null() && files.iter().any(|file| file == "study.csv") {
            return Err(at(folder, io::Error::other("a study, whose page is study.html there")));
        }
        if files.is_empty() && json.is_null() {
            return Err(at(folder, io::Error::other("no results: neither a table nor result.json")));
        }
        let result = result::Result::of(folder, json);
        let mut histories = Vec::new();
        for file in &files {
            histories.extend(History::read(folder, file)?.filter(|history| !history.times.is_empty()));
        }
        let mut notes = torn_tables(folder)?;
        notes.extend(histories.iter().map(History::left_out).filter(|note| !note.is_empty()));
        // Results of an unfinished run, and older ones, have no marks.
        let marks = SceneMarks::deserialize(&result.json["marks"]).unwrap_or_default();
        let mut scene = scene(folder, (&histories, &marks.members), &mut notes)?;
        if let Some(scene) = &mut scene {
            scene.marks.add(marks, &scene.x0);
        }
        let over_time = histories.iter().find(|history| history.over == "time" && history.file != "modes.csv");
        let stages = over_time.map_or(Ok(Vec::new()), |history| histories::stages(folder, &history.file))?;
        Ok(Contents { result, histories, scene, stages, notes })
    }
}

/// The note on a scene from tables alone.
const WITHOUT_FIELDS: &str = "members are straight between their points, and shells and bodies are not drawn. There are no VTU files: \
     `fields = { format = \"vtu\" }` in [output] shows them";

/// The scene of the modes, else of the fields, else of the points; a note names omitted times.
fn scene(
    folder: &Path,
    (histories, members): (&[History], &[[String; 2]]),
    notes: &mut Vec<String>,
) -> io::Result<Option<PageScene>> {
    let scene = match grids::modes(folder)? {
        Some((scene, all)) => {
            let shown = scene.times.last().map_or(0.0, |time| time.floor());
            notes.push(format!(
                "scene: modes 1 to {shown} of {all} swing one after the other; t is the number of the mode and the part of its period"
            ));
            Some(scene)
        }
        None => match grids::scene(folder)? {
            Some(Ok(scene)) if scene.is_seen() => Some(scene),
            Some(Err(reason)) => {
                notes.push(reason);
                points::scene(histories, members)
            }
            _ => {
                let scene = points::scene(histories, members);
                if scene.is_some() {
                    notes.push(format!("scene: {WITHOUT_FIELDS}"));
                }
                scene
            }
        },
    };
    if let Some(scene) = scene.as_ref().filter(|scene| scene.times.len() < scene.all) {
        notes.push(format!("scene: shown are {} of {} times", scene.times.len(), scene.all));
    }
    Ok(scene)
}

/// The picture of a folder at one time, as SVG, and that time.
///
/// # Errors
/// As for [`page`]; the results have nothing to see, or not the time that is asked for.
pub fn scene_picture(folder: &Path, view: &View) -> io::Result<(String, f32)> {
    let Contents { result, scene, .. } = Contents::read(folder)?;
    let none = "no scene: the results have neither field files nor nodes or bodies. Add `fields = { format = \"vtu\" }` to [output] and run again";
    let scene = scene.filter(PageScene::is_seen).ok_or_else(|| at(folder, io::Error::other(none)))?;
    let frame = scene.frame(view.time).map_err(|error| at(folder, io::Error::other(error)))?;
    Ok((picture::draw(&scene, &result, &result.title(folder), frame, view), scene.times[frame]))
}

/// The page of a folder.
///
/// # Errors
/// The folder holds no results, or a file in it cannot be read; the error names it.
pub fn page(folder: &Path) -> io::Result<String> {
    let Contents { result, histories, scene, stages, notes } = Contents::read(folder)?;
    let title = result.title(folder);
    let (units, mut numbers) = (result.units(), PageNumbers::default());
    let history = |history: &History| history.json(&result, &mut numbers);
    let histories_json: Vec<Value> = histories.iter().map(history).collect();
    let all = json!({
        "histories": histories_json,
        "stages": stages,
        "scene": scene.as_ref().map(|scene| scene.json(&result, &mut numbers)),
    });
    let notes: String = notes.iter().map(|note| format!("<li>{}</li>\n", escaped(note))).collect();
    let notes = if notes.is_empty() { notes } else { format!("<ul class=\"note\">{notes}</ul>\n") };
    let scripts = SCRIPTS.concat();
    let parts = [
        ("{{title}}", escaped(&title)),
        ("{{style}}", STYLE.to_owned()),
        ("{{status}}", result.status()),
        ("{{expectations}}", result.expectations()),
        ("{{energy}}", energy(&histories, units)),
        ("{{notes}}", notes),
        ("{{numbers}}", result.numbers()),
        ("{{texts}}", result.texts()),
        ("{{data}}", html::data("data", &all) + &html::data("packed", &numbers.packed()?.into())),
        ("{{script}}", scripts),
    ];
    Ok(filled(PAGE, &parts))
}

/// Replaces the marks of a text in one pass, so that marks inside inserted text stay as they are.
fn filled(page: &str, parts: &[(&str, String)]) -> String {
    let mut out = String::with_capacity(page.len() + parts.iter().map(|(_, text)| text.len()).sum::<usize>());
    let mut rest = page;
    while let Some(at) = rest.find("{{") {
        out.push_str(&rest[..at]);
        rest = &rest[at..];
        match parts.iter().find(|(mark, _)| rest.starts_with(mark)) {
            Some((mark, text)) => {
                out.push_str(text);
                rest = &rest[mark.len()..];
            }
            None => {
                out.push_str("{{");
                rest = &rest[2..];
            }
        }
    }
    out + rest
}

/// A table of the energies at the start, at the end and at their largest, and a sentence on the energy balance.
fn energy(histories: &[History], units: Option<&UnitSystem>) -> String {
    let has_balance = |history: &&History| history.columns.iter().any(|name| name == BALANCE);
    let Some(history) = histories.iter().find(has_balance) else { return String::new() };
    let is_energy = |name: &&String| ENERGY.iter().any(|known| known.unit == Unit::Energy && known.name == *name);
    let number = |value: f32| base::names::short(f64::from(value));
    let mut largest = 0.0_f32;
    let mut lost = 0.0_f32;
    let mut rows = Vec::new();
    for name in history.columns.iter().filter(is_energy) {
        let Some(line) = history.line(0, name) else { continue };
        let most = line.iter().filter(|value| value.is_finite()).fold(0.0_f32, |most, value| most.max(value.abs()));
        if name == BALANCE {
            lost = most
        } else {
            largest = largest.max(most)
        }
        let (Some(&first), Some(&last)) = (line.first(), line.last()) else { continue };
        if most > 0.0 {
            rows.push(vec![name.clone(), number(first), number(last), number(most)]);
        }
    }
    let part = if largest > 0.0 { format!("{:.2} %", 100.0 * lost / largest) } else { "0".into() };
    let head = format!("energy ({})", Unit::Energy.text(units));
    let table = html::table(&[&head, "first", "last", "largest in size"], &rows);
    format!(
        "{table}<p class=\"note\">Energy balance: the algorithmic dissipation (`numerical`, the remainder of the balance) is at most {part} of the largest \
         energy, at the times shown.</p>\n"
    )
}

/// The tables of a folder, in the order of [`TABLES`].
fn table_files(folder: &Path) -> io::Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).map_err(|e| at(folder, e))? {
        let name = entry.map_err(|e| at(folder, e))?.file_name();
        names.extend(name.to_str().filter(|name| name.ends_with(".csv")).map(String::from));
    }
    let place = |name: &str| TABLES.iter().position(|table| table.file == name).unwrap_or(TABLES.len());
    names.sort_by_key(|name| (place(name), name.clone()));
    Ok(names)
}

/// The object in result.json; null where there is no such file.
fn result_json(path: &Path) -> io::Result<Value> {
    match read_regular(path) {
        Err(e) if e.kind() == io::ErrorKind::NotFound => Ok(Value::Null),
        read => serde_json::from_slice(&read.map_err(|e| at(path, e))?).map_err(|e| at(path, e.into())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_within_parts_stay() {
        let parts = [("{{a}}", "{{b}}".to_string()), ("{{b}}", "2".to_string())];
        assert_eq!(filled("{{a}} {{c}} {{b}}{{", &parts), "{{b}} {{c}} 2{{");
    }

    #[test]
    fn the_page_asks_for_nothing_from_elsewhere() {
        for text in [PAGE, STYLE].iter().chain(&SCRIPTS) {
            for word in ["http:", "https:", "src=", "@import", "url(", "fetch(", "XMLHttpRequest", "import("] {
                assert!(!text.contains(word), "{word}");
            }
            assert!(!text.contains("</script>") || *text == PAGE);
        }
    }
}
