//! A column of one table over a column of another, as force over displacement.

use super::disk::at;
use super::table::{BETWEEN_SETS, CASE, SET, STAGE, names_subject};
use super::table_reader::{TableReader, fields, number, text};
use model::ENVELOPE_ENDS;
use serde::ser::{Serialize, SerializeMap, Serializer};
use std::borrow::Cow;
use std::io;
use std::ops::Range;
use std::path::Path;
use std::str::FromStr;

/// Changes of x below this part of its largest value are rounding, as of a node beside which all loads balance.
const ROUNDING: f64 = 1e-9;

/// A column of the rows of some names, summed: `nodes.csv:tip:ux`; with `-` in front its negative. Reactions have a component as column,
/// such as `reactions.csv:*:fx`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CurveAxis {
    /// The whole word.
    pub word: String,
    is_negative: bool,
    file: String,
    /// The name of the rows, in which `*` stands for anything; empty for rows about the whole scene.
    name: String,
    column: String,
}

/// The table of reactions, ...
pub const REACTIONS: &str = "reactions.csv";
/// ... and its column of values, one row for each direction.
pub const REACTION: &str = "value";
/// The components of force and moment of its rows.
pub const REACTION_COMPONENTS: [&str; 6] = ["fx", "fy", "fz", "mx", "my", "mz"];

/// The direction of the rows of [`REACTIONS`] that hold a component of force or moment: "ux" for "fx".
pub fn reaction_direction(component: &str) -> Option<&'static str> {
    let place = REACTION_COMPONENTS.iter().position(|word| *word == component)?;
    Some(["ux", "uy", "uz", "rx", "ry", "rz"][place])
}

impl FromStr for CurveAxis {
    type Err = String;

    fn from_str(word: &str) -> Result<CurveAxis, String> {
        let (is_negative, rest) = match word.strip_prefix('-') {
            Some(rest) => (true, rest),
            None => (false, word),
        };
        let parsed = rest.split_once(':').and_then(|(file, rest)| {
            let (name, column) = rest.rsplit_once(':').unwrap_or(("", rest));
            let is_whole = file.ends_with(".csv") && !column.is_empty();
            is_whole.then(|| (file.to_owned(), name.to_owned(), column.to_owned()))
        });
        let (file, name, column) =
            parsed.ok_or("write FILE:NAME:COLUMN, such as `nodes.csv:tip:ux`, or FILE:COLUMN")?;
        let (name, column) = match reaction_direction(&column).filter(|_| file == REACTIONS) {
            Some(direction) => (format!("{name} {direction}").trim_start().to_owned(), REACTION.to_owned()),
            None => (name, column),
        };
        Ok(CurveAxis { word: word.to_owned(), is_negative, file, name, column })
    }
}

/// A curve over the rows of the tables.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Curve {
    /// The stages; empty in a deck without stages.
    pub stage: Vec<String>,
    /// The quantity over which the rows go: "time", "frequency" or "speed".
    pub over: String,
    /// Its values.
    pub at: Vec<f64>,
    /// The values of the first axis.
    pub x: Vec<f64>,
    /// The values of the second axis.
    pub y: Vec<f64>,
    /// The largest value of the first axis over all stages.
    scale: f64,
}

impl Serialize for Curve {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut all = serializer.serialize_map(None)?;
        if !self.stage.is_empty() {
            all.serialize_entry("stage", &self.stage)?;
        }
        all.serialize_entry(&self.over, &self.at)?;
        all.serialize_entry("x", &self.x)?;
        all.serialize_entry("y", &self.y)?;
        all.end()
    }
}

/// The marks of a curve in one stage.
#[derive(Debug, Clone, PartialEq)]
pub struct CurveMarks {
    /// The stage; empty in a deck without stages.
    pub stage: String,
    /// The places of the points with the largest and the least y, and of the last point.
    pub extremes: [usize; 3],
    /// dy/dx of the first step with a change of x; `None` without any.
    pub first_slope: Option<f64>,
    /// ∫ y dx by trapezoids.
    pub work: f64,
}

impl Curve {
    /// Reads a curve from a folder of results.
    ///
    /// # Errors
    /// A table cannot be read, has no such column or names, or has several rows of one name at one time. Both tables have rows at other times. The error
    /// names the table.
    pub fn read(folder: &Path, [x, y]: [&CurveAxis; 2]) -> io::Result<Curve> {
        let (x_points, y_points) = (x.read(folder)?, y.read(folder)?);
        if (&x_points.over, &x_points.at, &x_points.stage) != (&y_points.over, &y_points.at, &y_points.stage) {
            let [a, b] = [&x_points.over, &y_points.over];
            let rows = if a == b { format!("at other {a}s") } else { format!("over {a} and over {b}") };
            let why = format!("{} and {} have rows {rows}, so neither goes over the other", x.file, y.file);
            return Err(at(folder, io::Error::other(why)));
        }
        let Points { stage, over, at, value: x } = x_points;
        let scale = x.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        Ok(Curve { stage, over, at, x, y: y_points.value, scale })
    }

    /// The curve in one stage; empty without such a stage.
    pub fn in_stage(&self, stage: &str) -> Curve {
        let is_of = |place: &usize| self.stage.get(*place).is_some_and(|own| own == stage);
        let places: Vec<usize> = (0..self.at.len()).filter(is_of).collect();
        let take = |of: &[f64]| places.iter().map(|&place| of[place]).collect();
        Curve {
            stage: vec![stage.to_owned(); places.len()],
            over: self.over.clone(),
            at: take(&self.at),
            x: take(&self.x),
            y: take(&self.y),
            scale: self.scale,
        }
    }

    /// The marks of each stage.
    pub fn marks(&self) -> Vec<CurveMarks> {
        let count = self.at.len();
        let begins = (0..count).filter(|&k| k == 0 || self.stage.get(k) != self.stage.get(k - 1));
        let mut begins: Vec<usize> = begins.collect();
        begins.extend((count > 0).then_some(count));
        begins.windows(2).map(|ends| self.marks_of(ends[0]..ends[1])).collect()
    }

    /// The marks of some points, at least one.
    fn marks_of(&self, points: Range<usize>) -> CurveMarks {
        let by = |a: &usize, b: &usize| self.y[*a].total_cmp(&self.y[*b]);
        let [first, last] = [points.start, points.end - 1];
        let [most, least] = [points.clone().max_by(by), points.clone().min_by(by)].map(|place| place.unwrap_or(first));
        let second = points.clone().find(|&k| (self.x[k] - self.x[first]).abs() > ROUNDING * self.scale);
        let pairs = self.x[points.clone()].windows(2).zip(self.y[points].windows(2));
        CurveMarks {
            stage: self.stage.get(first).cloned().unwrap_or_default(),
            extremes: [most, least, last],
            first_slope: second.map(|k| (self.y[k] - self.y[first]) / (self.x[k] - self.x[first])),
            work: pairs.map(|(x, y)| 0.5 * (x[1] - x[0]) * (y[0] + y[1])).sum(),
        }
    }
}

/// The rows of an axis, one for each row of output.
#[derive(Debug, Default)]
struct Points {
    stage: Vec<String>,
    over: String,
    at: Vec<f64>,
    value: Vec<f64>,
}

impl CurveAxis {
    /// The values, summed over all rows of the same stage, step and time, and of the same frequency or speed in tables over these.
    fn read(&self, folder: &Path) -> io::Result<Points> {
        let path = folder.join(&self.file);
        let mut rows = TableReader::open(&path)?;
        let place = |rows: &TableReader, name: &str| rows.column(name).ok_or_else(|| no_column(rows, &path, name));
        let (time_at, place_of_value) = (place(&rows, "time")?, place(&rows, &self.column)?);
        let over_at = rows.abscissa().unwrap_or(time_at);
        let [step_at, stage_at, set_at] = ["step", STAGE, SET].map(|name| rows.column(name));
        let width = rows.header.len();
        let keys: Vec<usize> = (0..width).filter(|&key| rows.is_key(key) && names_subject(&rows.header[key])).collect();
        // The load case stands before the subject.
        let first = keys.iter().take_while(|&&key| rows.header[key] == CASE).count();
        let (mut points, mut found) = (Points { over: rows.header[over_at].clone(), ..Points::default() }, 0);
        let (mut before, mut has_own) = (None, false);
        let sign = if self.is_negative { -1.0 } else { 1.0 };
        let mut ragged = None;
        while let Some(row) = rows.next_row()? {
            let row: Vec<&[u8]> = fields(row).collect();
            if row.len() != width {
                ragged = Some(row.len());
                break;
            }
            let (stage, over) = (stage_at.map(|stage| text(row[stage])), number(row[over_at]));
            let now = (step_at.map(|step| number(row[step]).to_bits()), number(row[time_at]), over);
            if before != Some(now) || points.stage.last().map(String::as_str) != stage.as_deref() {
                (before, has_own) = (Some(now), false);
                points.at.push(over);
                points.value.push(0.0);
                points.stage.extend(stage.map(Cow::into_owned));
            }
            let words: Vec<_> = keys.iter().map(|&key| text(row[key])).collect();
            let is_meant = |subject: &str| {
                let all = words.iter().enumerate().map(|(k, word)| if k == first { subject } else { word.as_ref() });
                matches(&self.name, &all.collect::<Vec<_>>().join(" "))
            };
            // Extremes of several nodes have no sum: they may be of different cases.
            let of_envelope =
                keys[..first].iter().any(|&key| ENVELOPE_ENDS.iter().any(|end| text(row[key]).ends_with(end)));
            let names = set_at.filter(|_| !of_envelope).map(|set| text(row[set])).unwrap_or_default();
            let is_own = is_meant(words.get(first).map_or("", Cow::as_ref));
            if is_own && std::mem::replace(&mut has_own, true) && !self.name.contains('*') {
                let why =
                    format!("several rows are of `{}` at {} {over}; `*` in a name sums rows", self.name, points.over);
                return Err(at(&path, io::Error::other(why)));
            }
            if is_own || names.split(BETWEEN_SETS).filter(|set| !set.is_empty()).any(is_meant) {
                found += 1;
                if let Some(sum) = points.value.last_mut() {
                    *sum += sign * number(row[place_of_value]);
                }
            }
        }
        if let Some(count) = ragged {
            return Err(rows.ragged(count));
        }
        if found > 0 { Ok(points) } else { Err(self.no_row(&path, keys.is_empty())) }
    }

    /// The error on rows that are missing.
    fn no_row(&self, path: &Path, of_scene: bool) -> io::Error {
        let why = match of_scene {
            true => "its rows are about the whole scene: write FILE:COLUMN".to_owned(),
            false => format!("no row is about `{}`", self.name),
        };
        at(path, io::Error::other(why))
    }
}

/// The error on a column that is missing.
fn no_column(rows: &TableReader, path: &Path, name: &str) -> io::Error {
    let why = format!("there is no column `{name}`; the columns are {}", rows.header.join(", "));
    at(path, io::Error::other(why))
}

/// Whether a name is that of a pattern in which `*` stands for anything.
fn matches(pattern: &str, name: &str) -> bool {
    match pattern.split_once('*') {
        None => pattern == name,
        Some((head, rest)) => name.strip_prefix(head).is_some_and(|name| {
            (0..=name.len()).filter(|&from| name.is_char_boundary(from)).any(|from| matches(rest, &name[from..]))
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Force over displacement of two supports: sums by pattern, a sign, and the work of the curve by hand.
    #[test]
    fn columns_of_two_tables_make_a_curve() {
        let dir = tempfile::tempdir().unwrap();
        std::fs::write(
            dir.path().join("nodes.csv"),
            "step,time,node,ux\n0,0.0,a,9.0\n0,0.0,tip,0.0\n1,0.5,a,9.0\n1,0.5,tip,1.0\n2,1.0,a,9.0\n2,1.0,tip,3.0\n",
        )
        .unwrap();
        let text = "step,time,node,direction,value\n0,0.0,a,ux,0.0\n0,0.0,b,ux,0.0\n0,0.0,b,uy,7.0\n1,0.5,a,ux,-2.0\n1,0.5,b,ux,-3.0\n\
                    1,0.5,b,uy,7.0\n2,1.0,a,ux,-2.0\n2,1.0,b,ux,-4.0\n2,1.0,b,uy,7.0\n";
        std::fs::write(dir.path().join("reactions.csv"), text).unwrap();
        let axis = |word: &str| word.parse::<CurveAxis>().unwrap();
        let [x, y] = [axis("nodes.csv:tip:ux"), axis("-reactions.csv:* ux:value")];
        let curve = Curve::read(dir.path(), [&x, &y]).unwrap();
        assert_eq!((&curve.x, &curve.y), (&vec![0.0, 1.0, 3.0], &vec![0.0, 5.0, 6.0]));
        let marks = curve.marks();
        assert_eq!((marks.len(), marks[0].work, marks[0].first_slope), (1, 2.5 + 11.0, Some(5.0)));
        // A component of force selects the rows of its direction.
        assert_eq!(Curve::read(dir.path(), [&x, &axis("-reactions.csv:*:fx")]).unwrap(), curve);
        assert_eq!(Curve::read(dir.path(), [&x, &axis("reactions.csv:b:fy")]).unwrap().y, [7.0; 3]);
        let error = |x: &str| Curve::read(dir.path(), [&axis(x), &y]).unwrap_err().to_string();
        assert!(error("nodes.csv:tip:uz").contains("no column `uz`"));
        assert!(error("nodes.csv:top:ux").contains("no row is about `top`"));
        assert!(error("nodes.csv:ux").contains("no row is about ``"));
        std::fs::write(dir.path().join("steps.csv"), "step,time,iterations\n0,0.0,1\n").unwrap();
        assert!(error("steps.csv:iterations").contains("other times"));
        // Rows at one time go over the frequency, and rows of one name are no sum.
        let text = "step,time,frequency,node,ux\n0,1.0,5.0,a,0.1\n0,1.0,5.0,b,0.7\n0,1.0,6.0,a,0.3\n0,1.0,6.0,b,0.7\n";
        std::fs::write(dir.path().join("response.csv"), text).unwrap();
        let [over, ux] = ["response.csv:a:frequency", "response.csv:a:ux"].map(axis);
        let curve = Curve::read(dir.path(), [&over, &ux]).unwrap();
        assert_eq!((&*curve.over, &curve.at, &curve.y), ("frequency", &vec![5.0, 6.0], &vec![0.1, 0.3]));
        assert_eq!(serde_json::to_string(&curve).unwrap(), r#"{"frequency":[5.0,6.0],"x":[5.0,6.0],"y":[0.1,0.3]}"#);
        assert!(error("response.csv:a:ux").contains("over frequency and over time"));
        std::fs::write(dir.path().join("contacts.csv"), "step,time,contact,fx\n0,0.0,a,1.0\n0,0.0,a,2.0\n").unwrap();
        assert!(error("contacts.csv:a:fx").contains("several rows are of `a` at time 0"));
        assert!("nodes.csv".parse::<CurveAxis>().is_err() && "nodes:tip:ux".parse::<CurveAxis>().is_err());
        // The end of a stage and the begin of the next are two points, and a change by rounding has no slope.
        let text =
            "step,time,stage,node,ux\n0,0.0,weight,a,0.0\n1,1.0,weight,a,1e-18\n1,1.0,push,a,1e-18\n2,2.0,push,a,0.5\n";
        std::fs::write(dir.path().join("nodes.csv"), text).unwrap();
        let x = axis("nodes.csv:a:ux");
        let curve = Curve::read(dir.path(), [&x, &axis("-nodes.csv:*:ux")]).unwrap();
        assert_eq!(curve.x, [0.0, 1e-18, 1e-18, 0.5]);
        let stages: Vec<_> = curve.marks().into_iter().map(|of| (of.stage, of.extremes, of.first_slope)).collect();
        assert_eq!(stages, [("weight".into(), [0, 1, 1], None), ("push".into(), [2, 3, 3], Some(-1.0))]);
        let weight = curve.in_stage("weight");
        assert_eq!((weight.at.len(), weight.marks()[0].first_slope), (2, None));
        assert!(curve.in_stage("pull").marks().is_empty());
        for (pattern, name, is) in [("*", "", true), ("a*c", "abc", true), ("a*c", "ab", false), ("*b*", "abc", true)] {
            assert_eq!(matches(pattern, name), is, "{pattern} {name}");
        }
    }
}
