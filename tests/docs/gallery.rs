//! docs/gallery.md: every deck with its picture, which scripts/gallery.py draws.

use super::{keep, read, root};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Most bytes of a picture and of all pictures.
const MOST: [u64; 2] = [16_000, 700_000];
/// Pictures in a row of the page.
const ROW: usize = 3;

fn decks(folder: &Path, found: &mut Vec<PathBuf>) {
    for path in fs::read_dir(folder).expect("decks/").map(|entry| entry.unwrap().path()) {
        match path.is_dir() {
            true => decks(&path, found),
            false => found.extend(path.extension().is_some_and(|e| e == "toml").then_some(path)),
        }
    }
}

/// The name of a deck: its folder below decks/, or its file where a folder holds several.
fn name(path: &Path) -> String {
    let below = path.strip_prefix(root().join("decks")).unwrap().to_str().unwrap().to_owned();
    below.strip_suffix("/deck.toml").or(below.strip_suffix(".toml")).unwrap().to_owned()
}

fn cell(path: &Path) -> String {
    let (name, text) = (name(path), read(path));
    let title = text.lines().find_map(|line| line.strip_prefix("title = \"")?.strip_suffix('"')).unwrap_or_default();
    let deck = path.strip_prefix(root()).unwrap().to_str().unwrap();
    format!("![{title}, deformed](gallery/{name}.svg)<br>[{name}](../{deck})<br>{title}")
}

fn page() -> String {
    let mut all = Vec::new();
    decks(&root().join("decks"), &mut all);
    all.sort_by_key(|path| name(path));
    let mut text = read(&root().join("docs/gallery.md")).split("\n## ").next().unwrap().to_owned();
    let folders = ["tutorial/", "published/", "extreme/"];
    let groups = [
        ("Tutorial", Some(folders[0])),
        ("Problems with a solution or a measurement", None),
        ("Published problems", Some(folders[1])),
        ("Extreme numbers", Some(folders[2])),
    ];
    for (title, folder) in groups {
        let holds = |path: &Path| folders.into_iter().find(|&folder| name(path).starts_with(folder)) == folder;
        let cells: Vec<String> = all.iter().filter(|path| holds(path)).map(|path| cell(path)).collect();
        text += &format!("\n## {title}\n\n| | | |\n|---|---|---|\n");
        for row in cells.chunks(ROW) {
            text += &format!("| {} |\n", row.join(" | "));
        }
    }
    text
}

#[test]
fn the_gallery_shows_every_deck() {
    keep("docs/gallery.md", &page());
}

#[test]
fn the_pictures_of_the_gallery_are_there_and_small() {
    let (mut all, mut sum) = (Vec::new(), 0);
    decks(&root().join("decks"), &mut all);
    for path in &all {
        let picture = root().join("docs/gallery").join(format!("{}.svg", name(path)));
        let text = fs::read_to_string(&picture)
            .unwrap_or_else(|e| panic!("{}: {e}; scripts/gallery.py draws it", picture.display()));
        assert!(text.starts_with("<svg ") && text.contains("prefers-color-scheme:dark"), "{}", picture.display());
        assert!(text.len() as u64 <= MOST[0], "{} has {} bytes", picture.display(), text.len());
        let names = text.split("class=\"").skip(1).flat_map(|rest| rest.split('"').next().unwrap().split(' '));
        // The rules before those of dark paper are those of the classes in use.
        let (rules, _) = text.split_once("@media").unwrap();
        let ruled = rules.split('}').filter_map(|rule| rule.trim_start_matches(|c| c != '.').split(['{', ' ']).next());
        let ruled: BTreeSet<&str> =
            ruled.filter_map(|rule| rule.strip_prefix('.')).filter(|name| name.len() == 1).collect();
        let used: BTreeSet<&str> = names.chain(["s"]).collect();
        assert_eq!(used, ruled, "{}", picture.display());
        sum += text.len() as u64;
    }
    assert!(sum <= MOST[1], "{sum} bytes of pictures");
}
