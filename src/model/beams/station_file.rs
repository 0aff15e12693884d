//! Sections by station from a file of BeamDyn: its blade file, or its primary file, which names that and adds the twist.
//!
//! BeamDyn has z along the blade and orders matrices by forces along x, y, z and moments about x, y, z. Its x lies here along local y, and its y along
//! local z. Its twist turns about −z, in degrees; key points tell it, here linear between them by the length of their chords.

use crate::data::RecordFile;
use base::diagnostic::{At, Diagnostic};
use base::math::Mat6;
use base::text_file::read_regular;
use deck::Deck;
use mechanics::sections::{Stiffness, from_matrices};
use sha2::{Digest, Sha256};
use std::path::Path;

/// The stations of a file.
pub struct GivenStations {
    /// The stations, rising from 0 to 1.
    pub list: Vec<FileStation>,
    /// The files, for the model to remember.
    pub files: Vec<RecordFile>,
}

/// A station of a file.
pub struct FileStation {
    /// Place as a part of the length.
    pub at: f64,
    /// Stiffness and mass.
    pub stiffness: Stiffness,
    /// Angle of the axes of the section about local x.
    pub twist: f64,
}

/// The remedy for a refused file.
const REMEDY: &str =
    "name a blade file or a primary file of BeamDyn, relative to the deck's folder, or give `stations`";

/// Stations this near to each other are one.
const SAME: f64 = 1e-9;

/// Reads the files of stations of all beams, in their order, from the deck's folder; `None` for those without, or with errors.
pub fn load_stations(deck: &Deck, folder: &Path) -> (Vec<Option<GivenStations>>, Vec<Diagnostic>) {
    let mut problems = Vec::new();
    let mut load = |file: &At<String>| match read(file, folder, &mut problems) {
        Ok(stations) => Some(stations),
        Err(message) => {
            problems.push(Diagnostic::error(message).at(&file.span).hint(REMEDY));
            None
        }
    };
    let all = deck.beams.iter().map(|beam| beam.station_file.as_ref().and_then(&mut load)).collect();
    (all, problems)
}

fn read(file: &At<String>, folder: &Path, problems: &mut Vec<Diagnostic>) -> Result<GivenStations, String> {
    let mut files = Vec::new();
    let first = text(&folder.join(&file.value), &mut files)?;
    let (blade, key_points) = match primary(&first)? {
        None => (first, None),
        Some(Primary { key_points, blade }) => {
            let own = folder.join(&file.value);
            (text(&own.parent().unwrap_or(folder).join(blade), &mut files)?, Some(key_points))
        }
    };
    let stations = sections(&blade)?;
    if blade.lines().any(|line| line.contains("damp_type") && !line.trim_start().starts_with('0')) {
        let message = format!("the damping in `{}` is not used", blade.path);
        let hint = "give `damping = { beta = ... }` to the beam, with the factor of its bending";
        problems.push(Diagnostic::warning(message).at(&file.span).hint(hint));
    }
    let list = match key_points {
        None => stations.into_iter().map(|(at, stiffness)| FileStation { at, stiffness, twist: 0.0 }).collect(),
        Some(points) => with_twist(&stations, &twists(&points)),
    };
    Ok(GivenStations { list, files })
}

/// A file and its text.
struct FileText {
    path: String,
    text: String,
}

impl FileText {
    fn lines(&self) -> impl Iterator<Item = &str> {
        self.text.lines()
    }

    /// The first word of the line with this name behind it.
    fn value(&self, name: &str) -> Option<&str> {
        self.lines().find(|line| line.split_whitespace().nth(1) == Some(name))?.split_whitespace().next()
    }

    fn count(&self, name: &str) -> Result<usize, String> {
        let word = self.value(name).ok_or_else(|| format!("`{}` has no line `{name}`", self.path))?;
        word.parse().map_err(|_| format!("`{}`: `{name}` is `{word}`, not a whole number", self.path))
    }

    /// The numbers of the lines after the one with these words, in small letters, and after `more` others, until one holds no number.
    fn numbers_after(&self, words: &str, more: usize) -> Result<Vec<f64>, String> {
        let mut lines = (1..).zip(self.lines()).skip_while(|(_, line)| !line.to_ascii_lowercase().contains(words));
        lines.next().ok_or_else(|| format!("`{}` has no line with `{words}`", self.path))?;
        let mut numbers = Vec::new();
        for (number, line) in lines.skip(more) {
            if line.trim_start().starts_with("---") {
                break;
            }
            for word in line.split_whitespace() {
                let value: Result<f64, _> = word.replace(['d', 'D'], "e").parse();
                match value.ok().filter(|value| value.is_finite()) {
                    Some(value) => numbers.push(value),
                    None => return Err(format!("`{}`, line {number}: `{word}` is no number", self.path)),
                }
            }
        }
        Ok(numbers)
    }
}

fn text(path: &Path, files: &mut Vec<RecordFile>) -> Result<FileText, String> {
    let name = path.display().to_string();
    let bytes = read_regular(path).map_err(|error| format!("cannot read the stations `{name}`: {error}"))?;
    let text = String::from_utf8_lossy(&bytes).into_owned();
    files.push(RecordFile { path: name.clone(), digest: Sha256::digest(&bytes).into() });
    Ok(FileText { path: name, text })
}

/// A primary file.
struct Primary<'t> {
    /// x, y, z and twist in degrees.
    key_points: Vec<[f64; 4]>,
    /// The blade file.
    blade: &'t str,
}

/// Reads a primary file; `None` of a file without key points.
fn primary(file: &FileText) -> Result<Option<Primary<'_>>, String> {
    if file.value("kp_total").is_none() {
        return Ok(None);
    }
    let (members, count) = (file.count("member_total")?, file.count("kp_total")?);
    if members != 1 {
        return Err(format!("`{}` has {members} members; a beam takes one", file.path));
    }
    let numbers = file.numbers_after("kp_xr", 1)?;
    if numbers.len() != 4 * count || count < 2 {
        return Err(format!("`{}` has {} numbers for {count} key points of four", file.path, numbers.len()));
    }
    let quoted = |line: &str| line.split(['"', '\'']).nth(1).map(str::len);
    let line = file.lines().find(|line| line.contains("BldFile"));
    let line = line.ok_or_else(|| format!("`{}` has no line `BldFile`", file.path))?;
    let blade = match quoted(line) {
        Some(_) => line.split(['"', '\'']).nth(1).unwrap_or_default(),
        None => line.split_whitespace().next().unwrap_or_default(),
    };
    let key_points = numbers.chunks_exact(4).map(|of| [of[0], of[1], of[2], of[3]]).collect();
    Ok(Some(Primary { key_points, blade }))
}

/// Places and twists of key points.
fn twists(points: &[[f64; 4]]) -> Vec<[f64; 2]> {
    let chord = |pair: &[[f64; 4]]| (0..3).map(|i| (pair[1][i] - pair[0][i]).powi(2)).sum::<f64>().sqrt();
    let whole: f64 = points.windows(2).map(chord).sum();
    let (mut so_far, mut places) = (0.0, vec![0.0]);
    for pair in points.windows(2) {
        so_far += chord(pair);
        places.push(so_far / whole);
    }
    places.into_iter().zip(points).map(|(at, point)| [at, -point[3].to_radians()]).collect()
}

/// Stations at all places of sections and of twists.
fn with_twist(sections: &[(f64, Stiffness)], twists: &[[f64; 2]]) -> Vec<FileStation> {
    let mut places: Vec<f64> = sections.iter().map(|(at, _)| *at).chain(twists.iter().map(|[at, _]| *at)).collect();
    places.sort_by(f64::total_cmp);
    places.dedup_by(|a, b| *a - *b < SAME);
    let made = |at: f64| {
        let next = sections.partition_point(|(other, _)| *other <= at).clamp(1, sections.len() - 1);
        let ((a, from), (b, to)) = (&sections[next - 1], &sections[next]);
        let k = twists.partition_point(|[other, _]| *other <= at).clamp(1, twists.len() - 1);
        let ([c, start], [d, end]) = (twists[k - 1], twists[k]);
        let twist = start + (at - c) / (d - c) * (end - start);
        FileStation { at, stiffness: from.toward(to, (at - a) / (b - a)), twist }
    };
    places.into_iter().map(made).collect()
}

/// The numbers of a station: its place and two matrices.
const NUMBERS: usize = 1 + 2 * 36;

/// Reads a blade file.
fn sections(file: &FileText) -> Result<Vec<(f64, Stiffness)>, String> {
    let count = file.count("station_total")?;
    let numbers = file.numbers_after("distributed properties", 0)?;
    if numbers.len() != NUMBERS * count || count < 2 {
        let message = format!("`{}` has {} numbers for {count} stations of {NUMBERS}", file.path, numbers.len());
        return Err(message + "; two stations or more have each its place, six rows of stiffness and six of mass");
    }
    let stations = numbers.chunks_exact(NUMBERS).map(|numbers| {
        let [stiffness, mass] = [1, 37].map(|first| in_local_axes(&numbers[first..first + 36]));
        let section = from_matrices(&stiffness, &mass);
        let section = section.map_err(|reason| format!("`{}`, station {}: {reason}", file.path, numbers[0]))?;
        Ok((numbers[0], section))
    });
    let stations: Vec<(f64, Stiffness)> = stations.collect::<Result<_, String>>()?;
    let rises = stations.windows(2).all(|pair| pair[0].0 < pair[1].0);
    if !rises || stations[0].0 != 0.0 || stations[count - 1].0 != 1.0 {
        return Err(format!("the stations of `{}` do not rise from 0 to 1", file.path));
    }
    Ok(stations)
}

/// A matrix of BeamDyn by local axes.
fn in_local_axes(rows: &[f64]) -> Mat6 {
    const PLACES: [usize; 6] = [2, 0, 1, 5, 3, 4];
    Mat6::from_fn(|i, j| rows[6 * PLACES[i] + PLACES[j]])
}
