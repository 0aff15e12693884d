//! Materials: `*MATERIAL` and the keywords below it.

use crate::deck_text::{DeckTable, inline, list, number, vector};
use crate::file_content::MaterialCard;
use crate::flat_mesh::FlatMesh;
use crate::importer::Importer;
use crate::keyword_block::KeywordBlock;
use crate::material_starts;
use crate::material_table::{MaterialTable, MaterialValue};
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

/// Reads a table of values into the material at hand.
fn read(im: &mut Importer, block: &KeywordBlock, what: MaterialValue) {
    let lines = block.data.iter().filter(|data| data.filled() > 0);
    let table = MaterialTable::new(block.keyword.line, what, lines.map(|data| im.numbers(data)));
    if let Some(material) = at_hand(im, block.keyword.line) {
        material.take(table);
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
    if block.data.iter().all(|data| data.filled() == 0) {
        return im.refuse(line, "*ELASTIC needs Young's modulus");
    }
    read(im, block, MaterialValue::Elastic);
}

/// `*PLASTIC`.
pub fn plastic(im: &mut Importer, block: &KeywordBlock) {
    let line = block.keyword.line;
    let hardening = block.keyword.value("HARDENING").unwrap_or("ISOTROPIC").to_ascii_uppercase();
    let is_kinematic = "KINEMATIC".starts_with(&hardening);
    if !is_kinematic && !"ISOTROPIC".starts_with(&hardening) {
        return im.refuse(line, "hardening is isotropic or kinematic in rdsolve; other laws are not translated");
    }
    read(im, block, MaterialValue::Plastic);
    if let Some(material) = im.materials.list.last_mut() {
        material.is_kinematic = is_kinematic;
    }
}

/// `*DENSITY`.
pub fn density(im: &mut Importer, block: &KeywordBlock) {
    read(im, block, MaterialValue::Density);
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
    read(im, block, MaterialValue::Expansion);
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
    read(im, block, MaterialValue::Rate);
}

/// Takes the values of materials at the start, and says what becomes of temperatures and of coefficients of expansion.
pub fn say_temperatures(im: &mut Importer, mesh: &FlatMesh) {
    let chosen = material_starts::take_start(im, mesh);
    if im.is_heated() {
        return;
    }
    let expansions: Vec<usize> = im.materials.list.iter().filter_map(|material| Some(material.expansion?.1)).collect();
    expansions.into_iter().for_each(|line| im.ignore(line, "no temperature changes"));
    let lines: Vec<usize> = im.steps.first_temperatures.iter().map(|line| line.line).collect();
    for line in lines {
        match chosen.contains(&line) {
            true => im.change(line, "it chooses values of materials alone, for no temperature changes"),
            false => im.ignore(line, "no temperature changes"),
        }
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
