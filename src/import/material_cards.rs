//! Materials: `*MATERIAL` and the keywords below it.

use crate::deck_text::{DeckTable, inline, list, number, vector};
use crate::file_content::MaterialCard;
use crate::importer::Importer;
use crate::keyword_block::KeywordBlock;
use base::text_file::Word;

/// `*MATERIAL`.
pub fn material(im: &mut Importer, block: &KeywordBlock) {
    let name = block.keyword.value("NAME").unwrap_or("material").to_owned();
    im.materials.list.push(MaterialCard { name, line: block.keyword.line, ..MaterialCard::default() });
}

/// The material being read; refuses a line without one.
fn at_hand<'m>(im: &'m mut Importer, line: usize) -> Option<&'m mut MaterialCard> {
    if im.materials.list.is_empty() {
        im.refuse(line, "no *MATERIAL stands before this line");
    }
    im.materials.list.last_mut()
}

/// The temperature at the start, if the file gives one to all.
pub fn start_temperature(blocks: &[KeywordBlock]) -> Option<f64> {
    let is_heat = |block: &&KeywordBlock| {
        let kind = block.keyword.value("TYPE").unwrap_or_default();
        block.keyword.key() == "INITIALCONDITIONS" && kind.eq_ignore_ascii_case("TEMPERATURE")
    };
    let lines = blocks.iter().filter(is_heat).flat_map(|block| &block.data);
    let mut values = lines.filter_map(|data| data.words.get(1)?.fortran_number());
    let first = values.next()?;
    values.all(|value| value == first).then_some(first)
}

/// The values of a row, whose temperature stands behind so many of them: those at the start, linear between rows.
fn row_at_start(im: &mut Importer, block: &KeywordBlock, count: usize) -> Vec<f64> {
    let rows: Vec<Vec<f64>> = block.data.iter().map(|data| im.numbers(data)).collect();
    let at = |row: &Vec<f64>| row.get(count).copied().unwrap_or(0.0);
    if rows.len() < 2 {
        return rows.into_iter().next().unwrap_or_default();
    }
    let Some(start) = im.materials.start_temperature else {
        im.change(block.keyword.line, "values that depend on temperature: those of the first row are taken");
        return rows.into_iter().next().unwrap_or_default();
    };
    let how = format!("values that depend on temperature: those at {start} are taken, where all begins");
    im.change(block.keyword.line, &how);
    let after = rows.partition_point(|row| at(row) <= start);
    match (after.checked_sub(1).map(|last| &rows[last]), rows.get(after)) {
        (Some(a), Some(b)) => {
            let share = (start - at(a)) / (at(b) - at(a));
            a.iter().zip(b).map(|(a, b)| a + share * (b - a)).collect()
        }
        (a, b) => a.or(b).cloned().unwrap_or_default(),
    }
}

/// `*ELASTIC`.
pub fn elastic(im: &mut Importer, block: &KeywordBlock) {
    let line = block.keyword.line;
    if let Some(kind) = block.keyword.value("TYPE")
        && !"ISOTROPIC".starts_with(&kind.to_ascii_uppercase())
    {
        return im.refuse(line, "rdsolve has isotropic elastic materials alone");
    }
    let values = row_at_start(im, block, 2);
    let [Some(&modulus), ratio] = [values.first(), values.get(1)] else {
        return im.refuse(line, "*ELASTIC needs Young's modulus");
    };
    let elastic = [modulus, ratio.copied().unwrap_or(0.0)];
    if let Some(material) = at_hand(im, line) {
        material.elastic = Some(elastic);
    }
}

/// `*PLASTIC`.
pub fn plastic(im: &mut Importer, block: &KeywordBlock) {
    let line = block.keyword.line;
    let hardening = block.keyword.value("HARDENING").unwrap_or("ISOTROPIC").to_ascii_uppercase();
    let is_kinematic = "KINEMATIC".starts_with(&hardening);
    if !is_kinematic && !"ISOTROPIC".starts_with(&hardening) {
        return im.refuse(line, "hardening is isotropic or kinematic in rdsolve; other laws are not translated");
    }
    let rows: Vec<Vec<f64>> = block.data.iter().map(|data| im.numbers(data)).collect();
    let at = |row: &[f64], i: usize| row.get(i).copied().unwrap_or(0.0);
    let first = rows.first().map_or(0.0, |row| at(row, 2));
    let plastic: Vec<[f64; 2]> =
        rows.iter().filter(|row| at(row, 2) == first).map(|row| [at(row, 0), at(row, 1)]).collect();
    if plastic.len() < rows.len() {
        im.change(line, "values that depend on temperature: those of the first temperature are taken");
    }
    if let Some(material) = at_hand(im, line) {
        (material.plastic, material.is_kinematic) = (plastic, is_kinematic);
    }
}

/// `*DENSITY`.
pub fn density(im: &mut Importer, block: &KeywordBlock) {
    let density = row_at_start(im, block, 1).first().copied();
    if let Some(material) = at_hand(im, block.keyword.line) {
        material.density = density;
    }
}

/// `*NO COMPRESSION`: bars of this material take tension alone.
pub fn no_compression(im: &mut Importer, block: &KeywordBlock) {
    if let Some(material) = at_hand(im, block.keyword.line) {
        material.no_compression = Some(block.keyword.line);
    }
}

/// `*EXPANSION`.
pub fn expansion(im: &mut Importer, block: &KeywordBlock) {
    let line = block.keyword.line;
    let is_other = |kind: &str| !"ISOTROPIC".starts_with(&kind.to_ascii_uppercase());
    if block.keyword.value("TYPE").is_some_and(is_other) {
        return im.refuse(line, "rdsolve has isotropic expansion alone");
    }
    let expansion = block.data.first().and_then(|data| im.number_at(data, 0)).map(|factor| (factor, line));
    let rows = block.data.len();
    if let Some(material) = at_hand(im, line) {
        material.expansion = expansion;
        material.has_expansions = rows > 1;
    }
}

/// `*DAMPING`.
pub fn damping(im: &mut Importer, block: &KeywordBlock) {
    let line = block.keyword.line;
    let mut read = |name: &str| match block.keyword.value(name) {
        None => 0.0,
        Some(text) => {
            let number = Word { bytes: text.as_bytes(), column: 0, line }.fortran_number();
            number.filter(|number| number.is_finite() && *number >= 0.0).unwrap_or_else(|| {
                im.refuse(line, &format!("{name} must be a number, 0 or more"));
                0.0
            })
        }
    };
    let damping = [read("ALPHA"), read("BETA")];
    if [read("STRUCTURAL"), read("COMPOSITE")] != [0.0; 2] {
        im.refuse(line, "rdsolve damps by ALPHA and BETA alone: no structural damping, and none of modes");
    }
    if let Some(material) = at_hand(im, line) {
        material.damping = Some(damping).filter(|damping| *damping != [0.0; 2]);
    }
}

/// `*RATE DEPENDENT`.
pub fn rate_dependent(im: &mut Importer, block: &KeywordBlock) {
    let line = block.keyword.line;
    let kind: String = block.keyword.value("TYPE").unwrap_or("POWERLAW").to_ascii_uppercase();
    if !"POWERLAW".starts_with(&kind) {
        return im.refuse(line, "of the laws of rate dependence rdsolve has POWER LAW, by rate and exponent");
    }
    let values = row_at_start(im, block, 2);
    let [rate, exponent] = [0, 1].map(|at| values.get(at).copied().unwrap_or(1.0));
    if let Some(material) = at_hand(im, line) {
        material.rate = Some([rate, exponent]);
    }
}

/// Says what becomes of coefficients of expansion.
pub fn say_expansions(im: &mut Importer) {
    let is_heated = im.is_heated();
    for material in im.materials.list.clone() {
        let Some((_, line)) = material.expansion else { continue };
        if !is_heated {
            im.ignore(line, "no temperature changes");
        } else if material.has_expansions {
            im.change(line, "values that depend on temperature: those of the first row are taken");
        }
    }
    if !is_heated {
        let lines: Vec<usize> = im.steps.first_temperatures.iter().map(|line| line.line).collect();
        lines.into_iter().for_each(|line| im.ignore(line, "no temperature changes"));
    }
}

/// The table of a material, under a name.
pub fn table(material: &MaterialCard, name: &str, is_heated: bool) -> DeckTable {
    let model = match (&material.plastic[..], material.rate) {
        ([], _) => "elastic",
        (_, None) => "elastic-plastic",
        (_, Some(_)) => "elastic-viscoplastic",
    };
    let [modulus, ratio] = material.elastic.unwrap_or([0.0; 2]);
    let mut table = DeckTable::named("materials", name, material.line)
        .text("model", model)
        .number("youngs_modulus", modulus)
        .number("poisson_ratio", ratio);
    if let Some(density) = material.density {
        table = table.number("density", density);
    }
    if let Some((expansion, _)) = material.expansion.filter(|_| is_heated) {
        table = table.number("expansion", expansion);
    }
    match &material.plastic[..] {
        [] => return table,
        [[stress, _]] => table = table.number("yield_stress", *stress),
        rows => table = table.value("hardening", list(rows.iter().map(|[stress, strain]| vector(&[*strain, *stress])))),
    }
    if material.is_kinematic {
        table = table.number("kinematic_share", 1.0);
    }
    if let Some([rate, exponent]) = material.rate {
        let keys = [("law", "\"power\"".to_owned()), ("rate", number(rate)), ("exponent", number(exponent))];
        table = table.value("viscosity", inline(&keys));
    }
    table
}
