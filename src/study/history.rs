//! The quantities of a run at the sample times are read from its tables; errors are differences of them.

use base::math::{Mat3, Vec3, rotation};
use model::Model;
use model::study::{Quantity, Study};
use nalgebra::Quaternion;
use results::at;
use results::table_reader::{TableReader, fields, number, text};
use std::collections::HashMap;
use std::io;
use std::path::Path;

/// The quantities asked for, or the displacements of all named points and bodies that a run of the deck writes.
pub fn quantities(model: &Model, study: &Study) -> Vec<Quantity> {
    if !study.quantities.is_empty() {
        return study.quantities.clone();
    }
    let nodes = model.output.nodes.iter().map(|&node| &model.nodes[node]).filter(|node| node.named);
    let nodes = nodes.map(|node| (node.label.clone(), false));
    let bodies = model.bodies.iter().map(|body| (body.name.clone(), true));
    let of = |(label, body): (String, bool)| {
        ["ux", "uy", "uz"].map(|column| Quantity { name: label.clone(), label: label.clone(), body, column })
    };
    nodes.chain(bodies).flat_map(of).collect()
}

/// A row of nodes.csv or bodies.csv.
struct Moment<'a> {
    numbers: &'a [f64],
    /// The places of the columns by their names.
    column: &'a HashMap<String, usize>,
    /// The position of the same node or body at t = 0.
    start: Vec3,
}

impl Moment<'_> {
    /// The number in a column; NaN where there is none.
    fn get(&self, name: &str) -> f64 {
        self.column.get(name).and_then(|&i| self.numbers.get(i)).copied().unwrap_or(f64::NAN)
    }

    fn vector(&self, names: [&str; 3]) -> Vec3 {
        Vec3::from(names.map(|name| self.get(name)))
    }

    /// The rotation from the undeformed state.
    fn R(&self) -> Mat3 {
        let q = if self.column.contains_key("qw") {
            Quaternion::new(self.get("qw"), self.get("qx"), self.get("qy"), self.get("qz"))
        } else {
            rotation::exp(&self.vector(["rx", "ry", "rz"]))
        };
        rotation::matrix(&q)
    }

    /// A quantity: a column, or a number computed from columns: displacements of a body, its angular velocity in body axes (`body_wx`),
    /// components of a rotation matrix (`r11`).
    fn value(&self, quantity: &Quantity) -> f64 {
        let word = quantity.column;
        let digit = |at: usize| usize::from(word.as_bytes()[at] - b'1');
        match word {
            "body_wx" | "body_wy" | "body_wz" => {
                let omega = self.R().tr_mul(&self.vector(["wx", "wy", "wz"]));
                omega[usize::from(word.as_bytes()[6] - b'x')]
            }
            "ux" | "uy" | "uz" if quantity.body => {
                let axis = usize::from(word.as_bytes()[1] - b'x');
                self.get(["x", "y", "z"][axis]) - self.start[axis]
            }
            _ if word.len() == 3 && word.starts_with('r') => self.R()[(digit(1), digit(2))],
            _ => self.get(word),
        }
    }
}

/// The values at the sample times one after the other, each time all quantities.
///
/// # Errors
/// A table cannot be read, or a value is missing; the error names it.
pub fn read(folder: &Path, quantities: &[Quantity], samples: usize, end: f64) -> io::Result<Vec<f64>> {
    let count = quantities.len();
    let mut values = vec![f64::NAN; (samples + 1) * count];
    for (file, body) in [("nodes.csv", false), ("bodies.csv", true)] {
        if quantities.iter().any(|quantity| quantity.body == body) {
            read_table(&folder.join(file), quantities, body, samples, end, &mut values)?;
        }
    }
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(values),
        Some(first) => {
            let (sample, quantity) = (first / count, quantities[first % count].word());
            let time = end * sample as f64 / samples as f64;
            let text = format!("no finite value of {quantity} at t = {time}");
            Err(at(folder, io::Error::new(io::ErrorKind::InvalidData, text)))
        }
    }
}

/// Enters the quantities of the table of bodies or of nodes into `values`.
fn read_table(
    path: &Path,
    quantities: &[Quantity],
    body: bool,
    samples: usize,
    end: f64,
    values: &mut [f64],
) -> io::Result<()> {
    let mut of: HashMap<&str, Vec<usize>> = HashMap::new();
    for (i, quantity) in quantities.iter().enumerate().filter(|(_, quantity)| quantity.body == body) {
        of.entry(&quantity.label).or_default().push(i);
    }
    let mut rows = TableReader::open(path)?;
    let column: HashMap<String, usize> = rows.header.iter().enumerate().map(|(i, name)| (name.clone(), i)).collect();
    let columns = (rows.column("time"), rows.column(if body { "body" } else { "node" }));
    let (Some(time_at), Some(name_at)) = columns else {
        return Err(at(path, io::Error::new(io::ErrorKind::InvalidData, "not a table of this program")));
    };
    let mut starts: HashMap<String, Vec3> = HashMap::new();
    let mut numbers = Vec::new();
    while let Some(row) = rows.next_row()? {
        let mut name = String::new();
        numbers.clear();
        for (i, field) in fields(row).enumerate() {
            if i == name_at {
                name = text(field).into_owned();
            }
            numbers.push(number(field));
        }
        let Some(wanted) = of.get(name.as_str()) else { continue };
        let time = numbers.get(time_at).copied().unwrap_or(f64::NAN);
        let place = time / end * samples as f64;
        if (place - place.round()).abs() > 1e-6 || place < -0.5 || place > samples as f64 + 0.5 {
            continue;
        }
        let mut moment = Moment { numbers: &numbers, column: &column, start: Vec3::zeros() };
        let here = moment.vector(["x", "y", "z"]);
        moment.start = *starts.entry(name).or_insert(here);
        for &i in wanted {
            values[place.round() as usize * quantities.len() + i] = moment.value(&quantities[i]);
        }
    }
    Ok(())
}

/// The error √(mean |q − q_ref|²) / max |q_ref| over all times. Each time has `count` quantities; `of` selects the compared ones.
pub fn error(q: &[f64], reference: &[f64], count: usize, of: impl Fn(usize) -> bool) -> f64 {
    let (mut sum, mut largest) = (0.0, 0.0f64);
    for (row, exact) in q.chunks(count).zip(reference.chunks(count)) {
        let mut size = 0.0;
        for i in (0..count).filter(|&i| of(i)) {
            sum += (row[i] - exact[i]).powi(2);
            size += exact[i].powi(2);
        }
        largest = largest.max(size);
    }
    (sum / (reference.len() / count) as f64 / largest).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quantity(column: &'static str, body: bool) -> Quantity {
        Quantity { name: "a".into(), label: "a".into(), body, column }
    }

    #[test]
    fn quantities_of_a_body_are_those_of_its_motion() {
        let names = ["x", "y", "z", "qw", "qx", "qy", "qz", "wx", "wy", "wz"];
        let column: HashMap<String, usize> = names.iter().enumerate().map(|(i, name)| (name.to_string(), i)).collect();
        // The body has made a quarter turn about z, so that its x is global y.
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let numbers = [1.0, 2.0, 3.0, half, 0.0, 0.0, half, 0.0, 5.0, 7.0];
        let moment = Moment { numbers: &numbers, column: &column, start: Vec3::new(0.5, 2.0, 1.0) };
        let value = |word| moment.value(&quantity(word, true));
        assert_eq!([value("ux"), value("uy"), value("uz"), value("x"), value("wy")], [0.5, 0.0, 2.0, 1.0, 5.0]);
        let omega = [value("body_wx"), value("body_wy"), value("body_wz")];
        // The matrix is made of products of rounded square roots of a half.
        let near = |a: f64, b: f64| (a - b).abs() < 1e-14;
        assert!(near(omega[0], 5.0) && near(omega[1], 0.0) && near(omega[2], 7.0), "{omega:?}");
        assert!(near(value("r21"), 1.0) && near(value("r12"), -1.0) && near(value("r33"), 1.0));
    }

    #[test]
    fn an_error_is_relative_to_the_largest_value() {
        let reference = [0.0, 0.0, 3.0, 4.0];
        let q = [0.1, 0.0, 3.0, 4.1];
        // The error is √((0.01 + 0.01)/2)/5 up to round-off.
        assert!((error(&q, &reference, 2, |_| true) - 0.02).abs() < 1e-15);
        assert!((error(&q, &reference, 2, |i| i == 0) - (0.01f64 / 2.0).sqrt() / 3.0).abs() < 1e-15);
    }
}
