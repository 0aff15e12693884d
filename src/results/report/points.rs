//! The moving scene where there are no grids: nodes and bodies as points, nodes numbered in a row (`beam[1]`, `beam[2]`) joined
//! by lines.

use super::data::PageScene;
use super::histories::History;
use std::collections::HashMap;

/// The largest number of times that are shown.
const TIMES: usize = 150;

/// The scene of nodes.csv and bodies.csv, with lines between the names of `members`; `None` where there is neither table.
pub fn scene(histories: &[History], members: &[[String; 2]]) -> Option<PageScene> {
    let find = |file: &str| histories.iter().find(|history| history.file == file && history.line(0, "x").is_some());
    let tables: Vec<&History> = ["nodes.csv", "bodies.csv"].into_iter().filter_map(find).collect();
    let first = *tables.first()?;
    let every = first.times.len().div_ceil(TIMES).max(1);
    let shown: Vec<usize> =
        (0..first.times.len()).filter(|t| t.is_multiple_of(every) || t + 1 == first.times.len()).collect();
    let mut scene =
        PageScene { times: shown.iter().map(|&t| first.times[t]).collect(), all: first.all[0], ..PageScene::default() };
    let mut paths: Vec<Vec<[f32; 3]>> = Vec::new();
    for table in tables {
        // Tables of one run have the same times, except that of a killed run one may lack the last.
        for (name, label) in table.names.iter().enumerate() {
            let Some(lines) = ["x", "y", "z"].into_iter().map(|c| table.line(name, c)).collect::<Option<Vec<_>>>()
            else {
                continue;
            };
            let at =
                |t: usize| [0, 1, 2].map(|i| lines[i].get(t).copied().filter(|x| x.is_finite()).unwrap_or(f32::NAN));
            let mut last = [0.0; 3];
            let path = shown.iter().map(|&t| {
                if at(t).iter().all(|x| x.is_finite()) {
                    last = at(t);
                }
                last
            });
            paths.push(path.collect());
            scene.labels.push(label.clone());
        }
    }
    scene.x0 = paths.iter().filter_map(|path| path.first()).flatten().copied().collect();
    for t in 0..shown.len() {
        for path in &paths {
            scene.u.extend((0..3).map(|i| path[t][i] - path[0][i]));
        }
    }
    let numbered: Vec<Option<(&str, usize)>> = scene.labels.iter().map(|label| series(label)).collect();
    let follows = |i: &usize| match (numbered[*i], numbered[i + 1]) {
        (Some((a, m)), Some((b, n))) => a == b && m + 1 == n,
        _ => false,
    };
    let rows = (0..numbered.len().saturating_sub(1)).filter(follows).map(|i| [i, i + 1]);
    let places: HashMap<&str, usize> = scene.labels.iter().map(String::as_str).zip(0..).collect();
    let at = |name: &String| places.get(name.as_str()).copied();
    let lines: Vec<[usize; 2]> = rows.chain(members.iter().filter_map(|[a, b]| Some([at(a)?, at(b)?]))).collect();
    for line in lines {
        scene.lines.extend(line.map(|point| point as u32));
        scene.line_cells.push(scene.kinds.len() as u32);
        scene.kinds.push(0);
    }
    Some(scene)
}

/// The name and the number of a numbered node: `beam` and 3 of `beam[3]`.
fn series(label: &str) -> Option<(&str, usize)> {
    let (name, number) = label.strip_suffix(']')?.rsplit_once('[')?;
    Some((name, number.parse().ok()?))
}
