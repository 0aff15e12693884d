//! Files of a room import each other in one direction only, a `mod.rs` and its children included. What a file re-exports
//! belongs to the file that defines it.

use super::ratchet::{Known, compare};
use super::source::Source;
use std::collections::{BTreeMap, BTreeSet};

type Edges = BTreeMap<usize, BTreeMap<usize, BTreeSet<String>>>;

/// Rooms with circles, and how many files stand in them.
const KNOWN: Known = &[];

pub fn files_of_a_room_import_in_one_direction(source: &Source) {
    let mut edges: Edges = (0..source.files.len()).map(|file| (file, source.uses(file))).collect();
    let count: usize = edges.values().map(BTreeMap::len).sum();
    assert!(count > 400, "{count} imports between files");
    for (&file, used) in &mut edges {
        used.retain(|&other, _| source.files[other].room() == source.files[file].room());
    }
    let mut found = BTreeMap::new();
    for circle in circles(&edges) {
        let name = |file: usize| source.files[file].path.as_str();
        println!("circle of {}:", circle.len());
        for &file in &circle {
            for (other, names) in edges[&file].iter().filter(|(other, _)| circle.contains(other)) {
                let names: Vec<&str> = names.iter().map(String::as_str).collect();
                println!("    {} uses {} of {}", name(file), names.join(", "), name(*other));
            }
        }
        *found.entry(source.files[circle[0]].room().to_string()).or_insert(0) += circle.len();
    }
    compare("files in circles of a room", KNOWN, &found);
}

/// Groups of files that reach each other, by the reachability of each.
fn circles(edges: &Edges) -> Vec<Vec<usize>> {
    let reached: BTreeMap<usize, BTreeSet<usize>> = edges
        .keys()
        .map(|&start| {
            let (mut seen, mut open) = (BTreeSet::new(), vec![start]);
            while let Some(file) = open.pop() {
                open.extend(edges[&file].keys().filter(|&&other| seen.insert(other)));
            }
            (start, seen)
        })
        .collect();
    let mut circles = Vec::new();
    let mut done = BTreeSet::<usize>::new();
    for (&file, others) in &reached {
        if others.contains(&file) && !done.contains(&file) {
            let circle: Vec<usize> = others.iter().copied().filter(|other| reached[other].contains(&file)).collect();
            done.extend(&circle);
            circles.push(circle);
        }
    }
    circles
}
