//! Loads per length and per area, and gravity.

use crate::build::Build;
use crate::deck_text::{DeckTable, inline, number, vector};
use crate::dialect::Dialect;
use crate::edge_loads::{self, keeps_direction};
use crate::element_types::ElementUse;
use crate::file_content::SpreadLine;
use crate::loads::{in_time, lines_of, refuse_two_laws};
use crate::part_piece::PartPiece;
use crate::scopes::NamedTarget;
use crate::timeline::{GivenValue, InStep, TimeLaw, histories};
use base::math::Vec3;
use std::collections::{BTreeMap, BTreeSet};

/// The key of a load: surface or elements, their name, kind, direction as text.
type SpreadKey = (bool, NamedTarget, String, String);

fn key(line: &SpreadLine) -> SpreadKey {
    let target = NamedTarget { line: 0, name: line.target.name.to_lowercase(), ..line.target.clone() };
    let rest = format!("{:?} {}", line.values.get(1..).unwrap_or_default(), line.is_imaginary);
    (line.is_surface, target, line.kind.clone(), rest)
}

fn value_of(line: &SpreadLine) -> GivenValue {
    let value = line.values.first().copied().unwrap_or(0.0);
    GivenValue { value, amplitude: line.amplitude.clone(), line: line.line }
}

/// Adds all distributed loads.
pub fn spread_loads(build: &mut Build) {
    (0..build.im.steps.list.len()).for_each(|step| join_gravity(build, step));
    for step in build.im.steps.list.clone() {
        let all = step.spread.iter().map(|line| (format!("{:?}", key(line)), value_of(line)));
        refuse_two_laws(build, all);
    }
    refuse_overlaps(build);
    let given = |lines: &[SpreadLine]| -> Vec<(SpreadKey, GivenValue)> {
        let mut sum: BTreeMap<SpreadKey, GivenValue> = BTreeMap::new();
        for line in lines {
            let one = value_of(line);
            sum.entry(key(line)).and_modify(|other| other.value += one.value).or_insert(one);
        }
        sum.into_iter().collect()
    };
    let steps = &build.im.steps.list;
    // The last one stays, and stands first in the file.
    let last_first = steps.iter().rev().flat_map(|step| step.spread.iter().rev());
    let lines: BTreeMap<SpreadKey, SpreadLine> = last_first.map(|line| (key(line), line.clone())).collect();
    let all = histories(&build.timeline, steps, Vec::new(), |step| given(&step.spread), |step| step.new_spread);
    let own: Vec<_> = build
        .stages_with_own_loads()
        .into_iter()
        .flat_map(|(stage, step)| {
            given(&build.im.steps.list[step].spread).into_iter().map(move |one| (stage.clone(), one))
        })
        .collect();
    for (of, history) in all {
        let at = lines_of(&history);
        let law = build.law(&history, false);
        if let Some(line) = lines.get(&of) {
            one(build, line, &law, (&at, &history));
        }
    }
    for (stage, (of, given)) in own {
        let law = build.law_in(&stage, &given);
        if let Some(line) = lines.get(&of) {
            one(build, line, &law, (&[given.line], &[]));
        }
    }
}

/// Joins the gravity of several sets. They must lie apart, and hold everything with mass together.
fn join_gravity(build: &mut Build, step: usize) {
    let is_gravity = |line: &SpreadLine| line.kind == "GRAV" && !line.is_surface;
    let lines: Vec<SpreadLine> =
        build.im.steps.list[step].spread.iter().filter(|line| is_gravity(line)).cloned().collect();
    let [first, others @ ..] = &lines[..] else { return };
    let law = |line: &SpreadLine| (line.values.clone(), line.amplitude.clone(), line.is_imaginary);
    if others.is_empty() || lines.iter().any(|line| law(line) != law(first) || line.target.name.is_empty()) {
        return;
    }
    let mut cells = BTreeSet::new();
    let lie_apart = lines.iter().all(|line| build.cells(&line.target).into_iter().all(|cell| cells.insert(cell)));
    if !lie_apart || has_mass_beside(build, &cells) {
        return;
    }
    let spread = &mut build.im.steps.list[step].spread;
    spread.retain(|line| !is_gravity(line) || line.line == first.line);
    spread.iter_mut().filter(|line| is_gravity(line)).for_each(|line| line.target.name.clear());
    for other in others {
        build.im.ignore(other.line, &format!("the gravity of line {} acts on all sets", first.line));
    }
}

/// Refuses a load on elements that had one of its kind under another name in an earlier step: whether they add up is not sure.
fn refuse_overlaps(build: &mut Build) {
    let (mut keys, mut known) = (BTreeSet::new(), BTreeSet::new());
    for step in build.im.steps.list.clone() {
        if step.new_spread {
            (keys, known) = (BTreeSet::new(), BTreeSet::new());
        }
        let mut here = Vec::new();
        for line in step.spread.iter().filter(|line| !line.is_surface && line.kind != "GRAV") {
            let key = key(line);
            let of_cell = |cell: usize| (key.2.clone(), key.3.clone(), cell);
            let cells: Vec<_> = build.cells(&line.target).into_iter().map(of_cell).collect();
            if !keys.contains(&key) && cells.iter().any(|cell| known.contains(cell)) {
                build.im.refuse(
                    line.line,
                    "an earlier step has this load on some of these elements: name the same set in both",
                );
            }
            here.push((key, cells));
        }
        for (key, cells) in here {
            keys.insert(key);
            known.extend(cells);
        }
    }
}

/// Adds one load.
fn one(build: &mut Build, line: &SpreadLine, law: &TimeLaw, (lines, history): (&[usize], &[InStep])) {
    if law.scale == 0.0 {
        return;
    }
    if line.kind == "GRAV" {
        return gravity(build, line, law, (lines, history));
    }
    if line.kind == "CENTRIF" && !line.is_surface {
        return rotation(build, line, law, (lines, history));
    }
    if line.kind == "CORIO" && build.timeline.stages.iter().all(|stage| !stage.is_dynamic && stage.duration > 0.0) {
        return build.im.ignore(line.line, "nothing moves in a static step, and no Coriolis force acts");
    }
    if line.is_on_edges() {
        return edge_loads::edges(build, line, law, lines);
    }
    if line.is_surface {
        return surface(build, line, law, lines);
    }
    let pieces = pieces(build, &line.target, line.line);
    for piece in pieces {
        let table = DeckTable::new("loads", 0).with_lines(lines.iter().copied());
        let of_piece = if piece.is_beam || piece.is_bar { Some(()) } else { None };
        let table = table.names("part", &piece.names);
        let unit = |at: usize| {
            let mut x = [0.0; 3];
            x[at] = law.scale;
            x
        };
        let size = piece.size;
        let direction = |last: u8| usize::from(last.wrapping_sub(b'X')).min(2);
        let table = match (line.kind.as_bytes(), of_piece) {
            (b"P", None) => pressure(build, table, -law.scale),
            ([b'P', last @ b'X'..=b'Z'], Some(())) => table.numbers("force_per_length", &unit(direction(*last))),
            ([b'B', last @ b'X'..=b'Z'], Some(())) if size > 0.0 => {
                table.numbers("force_per_length", &unit(direction(*last)).map(|x| x * size))
            }
            ([b'B', last @ b'X'..=b'Z'], None) => {
                table.numbers("force_per_area", &unit(direction(*last)).map(|x| x * size))
            }
            (b"P1" | b"P2", Some(())) if piece.is_beam => {
                let axis = usize::from(line.kind.ends_with('2'));
                let width = match width(build, &piece, axis) {
                    Ok(width) => width,
                    Err(why) => return build.im.refuse(line.line, why),
                };
                let mut local = [0.0; 3];
                local[1 + axis] = law.scale * width;
                table.numbers("local", &local)
            }
            _ => {
                build.im.refuse(line.line, &reason(&line.kind));
                return;
            }
        };
        build.deck.add(in_time(table, Some(law)));
    }
}

/// Why a kind of load is not translated.
fn reason(kind: &str) -> String {
    match kind {
        "CORIO" => "rdsolve has no rotating frame: compute the motion with the parts turning".to_owned(),
        "ROTA" => "rdsolve has no load by an angular acceleration: compute the motion of the parts".to_owned(),
        "CENT" => "CENT is the density times the square of a speed: give CENTRIF, without the density".to_owned(),
        "NEWTON" => "bodies do not attract each other in rdsolve".to_owned(),
        _ => format!("loads of kind {kind} are not translated"),
    }
}

/// The width of the side that a pressure of CalculiX acts on; 1 for a force per length of Abaqus.
fn width(build: &Build, piece: &PartPiece, axis: usize) -> Result<f64, &'static str> {
    match (build.im.dialect, piece.sides) {
        (Some(Dialect::Abaqus), _) => Ok(1.0),
        (Some(Dialect::Calculix), Some(sides)) => Ok(sides[1 - axis]),
        (Some(Dialect::Calculix), None) => Err("the width that this pressure acts on is known of rectangles alone"),
        (None, _) => Err("P1 and P2 are forces per length in Abaqus and pressures on a side in CalculiX: say --from \
                          abaqus or --from calculix"),
    }
}

fn pressure(build: &Build, table: DeckTable, value: f64) -> DeckTable {
    let table = table.number("pressure", value);
    let is_nonlinear = build.im.steps.list.iter().any(|step| step.is_nonlinear());
    if is_nonlinear { table.value("follower", "true") } else { table }
}

/// Parts that lie in a set of elements.
fn pieces(build: &mut Build, target: &NamedTarget, line: usize) -> Vec<PartPiece> {
    let cells: BTreeSet<usize> = build.cells(&NamedTarget { line, ..target.clone() }).into_iter().collect();
    let touched: BTreeSet<usize> = cells.iter().filter_map(|cell| build.piece_of.get(cell).copied()).collect();
    let touched = touched.into_iter().map(|at| &build.pieces[at]);
    let inside: Vec<PartPiece> = touched.filter(|piece| piece.cells.is_subset(&cells)).cloned().collect();
    if inside.is_empty() && !cells.is_empty() && !build.im.is_incomplete() {
        build.im.refuse(line, "this load acts on elements that are no beams, bars or shells of the deck");
    }
    let covered: BTreeSet<usize> = inside.iter().flat_map(|piece| piece.cells.iter().copied()).collect();
    if let Some(at) = cells.difference(&covered).next().filter(|_| !build.im.is_incomplete()) {
        let id = build.mesh.cells[*at].id;
        build.im.refuse(line, &format!("this load acts on element {id}, which is no beam, bar or shell of the deck"));
    }
    inside
}

/// A load on a surface.
fn surface(build: &mut Build, line: &SpreadLine, law: &TimeLaw, lines: &[usize]) {
    let found = build.im.scopes.surface(&line.target);
    let Some(found) = found else {
        return build.im.refuse(line.line, &format!("no surface is named `{}`", line.target.name));
    };
    for (set, side) in found {
        let is_face = ["SPOS", "SNEG", ""].contains(&&side[..]);
        if !is_face || !["P", "TRVEC"].contains(&&line.kind[..]) {
            let about = format!(
                "rdsolve has no {} on {side}: give P or TRVEC on SPOS or SNEG, or a load along edges",
                line.kind
            );
            return build.im.refuse(line.line, &about);
        }
        let sense = if side == "SNEG" { -1.0 } else { 1.0 };
        for piece in pieces(build, &set, line.line) {
            let table = DeckTable::new("loads", 0).with_lines(lines.iter().copied()).names("part", &piece.names);
            let table = match line.kind == "P" {
                true => pressure(build, table, sense * law.scale),
                false => match traction(build, line) {
                    Some(direction) => table.numbers("force_per_area", (direction * law.scale).as_slice()),
                    None => return,
                },
            };
            build.deck.add(in_time(table, Some(law)));
        }
    }
}

/// The direction of a traction, which keeps it; refuses one without.
fn traction(build: &mut Build, line: &SpreadLine) -> Option<Vec3> {
    let of = |at: usize| line.values.get(at).copied().unwrap_or(0.0);
    let direction = Vec3::new(of(1), of(2), of(3)).try_normalize(0.0);
    if direction.is_none() {
        build.im.refuse(line.line, "TRVEC needs a direction behind its magnitude");
    }
    keeps_direction(build, line);
    direction
}

/// Gravity acts on everything.
fn gravity(build: &mut Build, line: &SpreadLine, law: &TimeLaw, (lines, history): (&[usize], &[InStep])) {
    let of = |at: usize| line.values.get(at).copied().unwrap_or(0.0);
    let Some(direction) = Vec3::new(of(1), of(2), of(3)).try_normalize(0.0) else {
        return build.im.refuse(line.line, "GRAV needs the direction behind its magnitude");
    };
    let cells = cells_of(build, line);
    if has_mass_beside(build, &cells) {
        let why = "gravity acts on everything in rdsolve, and this set does not hold all that has mass";
        return build.im.refuse(line.line, why);
    }
    if build.has_gravity {
        return build.im.refuse(line.line, "gravity has one direction and one amplitude in rdsolve");
    }
    build.has_gravity = true;
    let stages = law.stages.clone();
    let law = if stages.is_some() && law.amplitude.is_some() { build.law_as_table(history) } else { law.clone() };
    let g = direction * law.scale;
    let table = DeckTable::new("environment", 0).with_lines(lines.iter().copied()).numbers("gravity", g.as_slice());
    let table = match &law.amplitude {
        Some(name) => table.text("gravity_amplitude", name),
        None => table,
    };
    build.deck.add(match &stages {
        Some(stages) => table.names("gravity_stages", stages),
        None => table,
    });
}

/// The elements of a load; all for one without a target.
fn cells_of(build: &mut Build, line: &SpreadLine) -> BTreeSet<usize> {
    match line.target.name.is_empty() {
        true => (0..build.mesh.cells.len()).collect(),
        false => build.cells(&line.target).into_iter().collect(),
    }
}

/// True if mass lies outside these elements.
fn has_mass_beside(build: &Build, cells: &BTreeSet<usize>) -> bool {
    let is_beside = |at: &usize| !cells.contains(at);
    let mut heavy = build.pieces.iter().filter(|piece| piece.density > 0.0);
    point_masses(build).iter().any(is_beside) || heavy.any(|piece| !piece.cells.is_subset(cells))
}

/// Elements that are point masses.
fn point_masses(build: &Build) -> Vec<usize> {
    let is_mass = |at: &usize| build.im.scopes.types[build.mesh.cells[*at].kind].becomes == ElementUse::PointMass;
    (0..build.mesh.cells.len()).filter(is_mass).collect()
}

/// Centrifugal forces. The file has the square of the angular velocity, whose root the deck has.
fn rotation(build: &mut Build, line: &SpreadLine, law: &TimeLaw, (lines, history): (&[usize], &[InStep])) {
    let of = |at: usize| line.values.get(at).copied().unwrap_or(0.0);
    let (about, axis) = ([of(1), of(2), of(3)], Vec3::new(of(4), of(5), of(6)));
    let Some(axis) = axis.try_normalize(0.0) else {
        return build.im.refuse(line.line, "CENTRIF needs a point of the axis and its direction behind its magnitude");
    };
    let is_named = history.iter().any(|state| matches!(state, InStep::Begins(given) if given.amplitude.is_some()));
    if is_named || build.timeline.stages.iter().any(|stage| stage.is_dynamic) {
        let why = "CENTRIF acts in static steps and modes, without AMPLITUDE: that of the deck scales the speed, not its square";
        return build.im.refuse(line.line, why);
    }
    let law = match law.amplitude {
        None if law.scale >= 0.0 => Some(TimeLaw { scale: law.scale.sqrt(), ..law.clone() }),
        None => None,
        Some(_) => build.law_of_roots(history),
    };
    let Some(law) = law else {
        return build.im.refuse(line.line, "the magnitude of CENTRIF is the square of an angular velocity");
    };
    let mut keys = vec![("axis", vector(axis.as_slice())), ("speed", number(law.scale))];
    if about != [0.0; 3] {
        keys.push(("about", vector(&about)));
    }
    let mut table = DeckTable::new("loads", 0).with_lines(lines.iter().copied());
    let cells = cells_of(build, line);
    if has_mass_beside(build, &cells) {
        let cells: BTreeSet<usize> = build.cells(&line.target).into_iter().collect();
        let inside = build.pieces.iter().filter(|piece| piece.cells.is_subset(&cells));
        let mut names: Vec<String> = inside.flat_map(|piece| piece.names.clone()).collect();
        let masses = point_masses(build).into_iter().filter(|at| cells.contains(at));
        names.extend(masses.map(|at| format!("mesh.{}", build.mesh.cells[at].nodes[0])));
        table = table.names("part", &names);
    }
    build.deck.add(in_time(table.value("centrifugal", inline(&keys)), Some(&law)));
}
