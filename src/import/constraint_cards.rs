//! Constraints: rigid bodies, couplings, constraints of several points, equations.

use crate::file_content::{DistributingCard, EquationCard, OpenCoupling, PointsCard, RigidCard, TieCard};
use crate::importer::Importer;
use crate::keyword_block::KeywordBlock;
use crate::scopes::NamedTarget;
use base::text_file::cards::{Data, name_in};
use std::collections::BTreeMap;

/// `*RIGID BODY`.
pub fn rigid_body(im: &mut Importer, block: &KeywordBlock) {
    let (keyword, line) = (&block.keyword, block.keyword.line);
    let node = |name: &str| keyword.value(name).map(|name| NamedTarget { is_set: false, ..im.set_target(name, line) });
    let Some(reference) = node("REFNODE") else { return im.refuse(line, "*RIGID BODY needs REF NODE=") };
    let sets = |names: &[&str]| -> Vec<NamedTarget> {
        names.iter().filter_map(|name| keyword.value(name)).map(|name| im.set_target(name, line)).collect()
    };
    let first = ["NSET", "TIENSET", "ELSET", "PINNSET"].iter().find_map(|name| keyword.value(name));
    let card = RigidCard {
        line,
        name: first.unwrap_or("body").to_owned(),
        rotations: node("ROTNODE"),
        surface: None,
        tied: sets(&["NSET", "TIENSET"]),
        pinned: sets(&["PINNSET"]),
        cells: sets(&["ELSET"]),
        reference,
        degrees: Vec::new(),
        is_coupling: false,
    };
    im.constraints.rigid.push(card);
}

/// `*COUPLING`.
pub fn coupling(im: &mut Importer, block: &KeywordBlock) {
    let (keyword, line) = (&block.keyword, block.keyword.line);
    im.constraints.open = None;
    let (Some(reference), Some(surface_name)) = (keyword.value("REFNODE"), keyword.value("SURFACE")) else {
        return im.refuse(line, "*COUPLING needs REF NODE= and SURFACE=");
    };
    let reference = NamedTarget { is_set: false, ..im.set_target(reference, line) };
    let name = keyword.value("CONSTRAINTNAME").unwrap_or(surface_name).to_owned();
    let surface = im.set_target(surface_name, line);
    im.constraints.open = Some(OpenCoupling { line, name, reference, surface, is_turned: keyword.has("ORIENTATION") });
}

/// `*KINEMATIC` below a coupling.
pub fn kinematic(im: &mut Importer, block: &KeywordBlock) {
    let Some(open) = im.constraints.open.take() else { return };
    let degrees = degrees(im, block, 0);
    let OpenCoupling { line, name, reference, surface, is_turned } = open;
    if is_turned && !degrees.is_empty() {
        return im.refuse(line, "the axes of a coupling are the global ones in rdsolve");
    }
    let card = RigidCard {
        line,
        name,
        reference,
        rotations: None,
        tied: Vec::new(),
        surface: Some(surface),
        pinned: Vec::new(),
        cells: Vec::new(),
        degrees,
        is_coupling: true,
    };
    im.constraints.rigid.push(card);
}

/// `*DISTRIBUTING` below a coupling.
pub fn distributing(im: &mut Importer, block: &KeywordBlock) {
    let Some(open) = im.constraints.open.take() else { return };
    let line = block.keyword.line;
    if block.keyword.value("WEIGHTINGMETHOD").is_some_and(|way| !way.eq_ignore_ascii_case("UNIFORM")) {
        return im.refuse(line, "the nodes of a distributing coupling have the same weight here");
    }
    let degrees = degrees(im, block, 0);
    let OpenCoupling { line, reference, surface, is_turned, .. } = open;
    if is_turned && !degrees.is_empty() {
        return im.refuse(line, "the axes of a coupling are the global ones in rdsolve");
    }
    im.constraints.distributing.push(DistributingCard {
        line,
        reference: Some(reference),
        cells: None,
        surface: Some(surface),
        nodes: Vec::new(),
        degrees,
    });
}

/// `*DISTRIBUTING COUPLING` of older files: a set with one element at the reference node, then nodes and weights.
pub fn distributing_coupling(im: &mut Importer, block: &KeywordBlock) {
    let line = block.keyword.line;
    let Some(set) = block.keyword.value("ELSET") else {
        return im.refuse(line, "*DISTRIBUTING COUPLING needs ELSET=");
    };
    let cells = Some(im.set_target(set, line));
    let lines = block.data.iter().filter(|data| data.filled() > 0);
    let nodes = lines.map(|data| (im.target(&data.words[0]), im.number_at(data, 1).unwrap_or(1.0))).collect();
    im.constraints.distributing.push(DistributingCard {
        line,
        reference: None,
        cells,
        surface: None,
        nodes,
        degrees: Vec::new(),
    });
}

/// `*KINEMATIC COUPLING` of older files.
pub fn kinematic_coupling(im: &mut Importer, block: &KeywordBlock) {
    let line = block.keyword.line;
    let Some(reference) = block.keyword.value("REFNODE") else {
        return im.refuse(line, "*KINEMATIC COUPLING needs REF NODE=");
    };
    let reference = NamedTarget { is_set: false, ..im.set_target(reference, line) };
    let lines = || block.data.iter().filter(|data| data.filled() > 0);
    let tied: Vec<NamedTarget> = lines().map(|data| im.target(&data.words[0])).collect();
    let mut of_sets: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for (data, set) in lines().zip(&tied) {
        let here = degrees_of(im, data, 1);
        of_sets.entry(set.name.to_lowercase()).or_default().extend(if here.is_empty() {
            (0..6).collect()
        } else {
            here
        });
    }
    let mut of_sets = of_sets.into_values().map(sorted);
    let degrees = of_sets.next().unwrap_or_default();
    if of_sets.any(|other| other != degrees) {
        im.refuse(
            line,
            "the nodes of a coupling go with it along the same degrees of freedom here: give all sets the same",
        );
    }
    let name = format!("coupling_{}", reference.name);
    let (pinned, cells) = (Vec::new(), Vec::new());
    im.constraints.rigid.push(RigidCard {
        line,
        name,
        reference,
        rotations: None,
        tied,
        surface: None,
        pinned,
        cells,
        degrees,
        is_coupling: true,
    });
}

/// First and last degree of freedom on each line, from a field on; none is all.
fn degrees(im: &mut Importer, block: &KeywordBlock, from: usize) -> Vec<usize> {
    sorted(block.data.iter().flat_map(|data| degrees_of(im, data, from)).collect())
}

/// First and last degree of freedom on a line, from a field on; none where it has no such field.
fn degrees_of(im: &mut Importer, data: &Data, from: usize) -> Vec<usize> {
    if data.filled() <= from {
        return Vec::new();
    }
    let first = im.id(data, from).unwrap_or(1) as usize;
    let last = if data.filled() > from + 1 { im.id(data, from + 1).unwrap_or(1) as usize } else { first };
    (first..=last.min(6)).filter(|dof| *dof > 0).map(|dof| dof - 1).collect()
}

/// Each degree of freedom once; an empty list means all.
fn sorted(mut degrees: Vec<usize>) -> Vec<usize> {
    degrees.sort_unstable();
    degrees.dedup();
    if degrees.len() == 6 { Vec::new() } else { degrees }
}

/// `*MPC`.
pub fn points(im: &mut Importer, block: &KeywordBlock) {
    for data in block.data.iter().filter(|data| data.filled() > 0) {
        let Some(kind) = data.words.first().map(name_in) else { continue };
        let nodes = data.words[1..data.filled()].iter().map(|word| im.target(word)).collect();
        im.constraints.points.push(PointsCard { line: data.line, kind: kind.to_ascii_uppercase(), nodes });
    }
    if im.dialect.is_none() && im.constraints.points.iter().any(|card| ["BEAM", "LINK"].contains(&card.kind.as_str())) {
        im.refuse(
            block.keyword.line,
            "BEAM is a rigid beam in Abaqus and a rod of fixed length in CalculiX: say --from abaqus or --from calculix",
        );
    }
}

/// `*TIE`.
pub fn tie(im: &mut Importer, block: &KeywordBlock) {
    let (keyword, line) = (&block.keyword, block.keyword.line);
    let tolerance = match keyword.value("POSITIONTOLERANCE").map(str::parse) {
        None => None,
        Some(Ok(tolerance)) => Some(tolerance),
        Some(Err(_)) => return im.refuse(line, "POSITION TOLERANCE must be a number"),
    };
    if ["CYCLICSYMMETRY", "MULTISTAGE", "FLUIDSTRUCTURE"].iter().any(|word| keyword.has(word)) {
        return im.refuse(line, "rdsolve has no cyclic symmetry");
    }
    for data in block.data.iter().filter(|data| data.filled() > 0) {
        let [slave, master, ..] = &data.words[..] else {
            return im.refuse(data.line, "*TIE needs two surfaces on a line");
        };
        let card = TieCard {
            line: data.line,
            name: keyword.value("NAME").unwrap_or("tie").to_owned(),
            surfaces: [slave, master].map(|word| im.target(word)),
            tolerance,
            is_hinge: keyword.has("NOROTATION"),
            is_adjusted: !keyword.value("ADJUST").is_some_and(|word| word.eq_ignore_ascii_case("NO")),
        };
        im.constraints.ties.push(card);
    }
}

/// `*EQUATION`: the number of terms, then four on a line.
pub fn equations(im: &mut Importer, block: &KeywordBlock) {
    let mut lines = block.data.iter();
    while let Some(head) = lines.next() {
        let Some(count) = im.id(head, 0) else { return };
        let mut terms = Vec::new();
        while terms.len() < count as usize {
            let Some(data) = lines.next() else { return im.refuse(head.line, "this equation lacks terms") };
            for at in (0..data.filled()).step_by(3) {
                let Some(dof) = im.id(data, at + 1) else { return };
                if !(1..=6).contains(&dof) {
                    return im.refuse(data.line, "a degree of freedom of an equation is one of 1 to 6");
                }
                let factor = im.number_at(data, at + 2).unwrap_or(0.0);
                terms.push((im.target(&data.words[at]), dof as usize - 1, factor));
            }
        }
        im.constraints.equations.push(EquationCard { line: head.line, terms });
    }
}
