//! Functions of time: `*AMPLITUDE`.

use crate::file_content::AmplitudeCard;
use crate::importer::Importer;
use crate::keyword_block::KeywordBlock;
use crate::time_formula::TimeFormula;

/// Number of points of smooth steps.
const POINTS: usize = 200;

/// `*AMPLITUDE`.
pub fn amplitude(im: &mut Importer, block: &KeywordBlock) {
    let (keyword, line) = (&block.keyword, block.keyword.line);
    let Some(name) = keyword.value("NAME") else { return im.refuse(line, "*AMPLITUDE needs NAME=") };
    let name = name.to_owned();
    let rows: Vec<Vec<f64>> = block.data.iter().map(|data| im.numbers(data)).collect();
    let kind = keyword.value("DEFINITION").unwrap_or("TABULAR").to_ascii_uppercase();
    let is_total = keyword.value("TIME").is_some_and(|time| time.to_ascii_uppercase().starts_with("TOTAL"));
    if keyword.value("VALUE").is_some_and(|value| value.to_ascii_uppercase().starts_with("ABS")) {
        return im.refuse(line, "VALUE=ABSOLUTE is not translated: give values over the magnitude of the load");
    }
    // TIME alone is no abbreviation of TIME DELAY.
    let is_delay = |name: &str| name != "TIMEDELAY" || keyword.value(name) != keyword.value("TIME");
    let mut read = |name: &str| match keyword.value(name).filter(|_| is_delay(name)) {
        None => Some(0.0),
        Some(text) => text.parse::<f64>().ok().or_else(|| {
            im.refuse(line, &format!("{name} must be a number"));
            None
        }),
    };
    let (Some(shift), Some(delay), Some(scale), Some(interval)) =
        (read("SHIFTX"), read("TIMEDELAY"), read("SHIFTY"), read("FIXEDINTERVAL"))
    else {
        return;
    };
    let all: Vec<f64> = rows.iter().flatten().copied().collect();
    let mut card = AmplitudeCard { name, line, is_total, ..AmplitudeCard::default() };
    if let Some(read) = TimeFormula::reader(&kind) {
        let Some(formula) = read(&all) else {
            return im.refuse(line, &format!("DEFINITION={kind} has not the numbers of its formula"));
        };
        if [shift, delay, scale] != [0.0; 3] {
            return im.refuse(line, "an amplitude by formula is not shifted: give its own start and constant");
        }
        card.formula = Some(formula);
        return im.amplitudes.push(card);
    }
    match &kind[..] {
        kind if "TABULAR".starts_with(kind) => {
            card.points = all.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect()
        }
        "EQUALLYSPACED" if interval > 0.0 => {
            card.points = (0..).zip(&all).map(|(k, value)| [f64::from(k) * interval, *value]).collect();
        }
        "SMOOTHSTEP" => {
            card.points = smooth_steps(&all);
            im.change(line, "a smooth step is a table of points");
        }
        _ => return im.refuse(line, &format!("DEFINITION={kind} is not translated; give a table of times and values")),
    }
    for point in &mut card.points {
        point[0] += shift + delay;
        point[1] += scale;
    }
    let increase = card.points.windows(2).all(|pair| pair[0][0] < pair[1][0]);
    if card.points.is_empty() || !increase {
        return im.refuse(line, "times of an amplitude must increase");
    }
    im.amplitudes.push(card);
}

/// Steps of fifth degree between the points.
fn smooth_steps(values: &[f64]) -> Vec<[f64; 2]> {
    let corners: Vec<[f64; 2]> = values.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
    let each = (POINTS / corners.len().max(2)).max(8);
    let mut points = Vec::new();
    for pair in corners.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        points.extend((0..each).map(|k| {
            let x = k as f64 / each as f64;
            let rise = x * x * x * (10.0 - 15.0 * x + 6.0 * x * x);
            [from[0] + (to[0] - from[0]) * x, from[1] + (to[1] - from[1]) * rise]
        }));
    }
    points.extend(corners.last());
    points
}
