//! Steps: the procedure of each, and the supports and loads that begin in it.

use crate::dialect::Dialect;
use crate::file_content::{ForceLine, RotatingNodes, SpreadLine, StepCard, StepProcedure, SupportLine};
use crate::importer::Importer;
use crate::keyword_block::KeywordBlock;
use crate::temperatures;
use base::math::Vec3;
use base::text_file::cards::{Data, Keyword, name_in};

/// Why a line that acts in a step is refused outside of all steps.
pub const NO_STEP: &str = "no *STEP is open at this line";

/// `*STEP`.
pub fn step(im: &mut Importer, block: &KeywordBlock) {
    let (keyword, line) = (&block.keyword, block.keyword.line);
    let number = im.steps.list.len() + 1;
    let is_yes =
        |name: &str| keyword.has(name) && !keyword.value(name).is_some_and(|value| value.eq_ignore_ascii_case("NO"));
    let is_perturbation = is_yes("PERTURBATION");
    // Both programs keep large displacements on until a step ends them.
    let before = im.steps.list.iter().rev().find(|step| !step.is_perturbation).and_then(|step| step.nonlinear);
    let nonlinear = if keyword.has("NLGEOM") { Some(is_yes("NLGEOM")) } else { before.filter(|_| !is_perturbation) };
    let jumps = keyword.value("AMPLITUDE").map(|word| word.eq_ignore_ascii_case("STEP"));
    im.steps.is_open = true;
    im.steps.list.push(StepCard {
        line,
        name: keyword.value("NAME").map_or_else(|| format!("step_{number}"), str::to_owned),
        nonlinear,
        is_perturbation,
        jumps,
        ..StepCard::default()
    });
}

/// `*END STEP`.
pub fn end_step(im: &mut Importer, _: &KeywordBlock) {
    im.steps.is_open = false;
}

/// Sets the procedure of the step being read.
pub fn set(im: &mut Importer, line: usize, procedure: StepProcedure) {
    if !im.steps.is_open {
        return im.refuse(line, NO_STEP);
    }
    im.steps.at_hand().procedure = Some((procedure, line));
}

/// Step and duration on the first line of data.
fn times(im: &mut Importer, block: &KeywordBlock) -> [Option<f64>; 2] {
    let mut read = |at: usize| block.data.first().and_then(|data| im.number_at(data, at)).filter(|time| *time > 0.0);
    [read(0), read(1)]
}

/// `*STATIC`.
pub fn statics(im: &mut Importer, block: &KeywordBlock) {
    let line = block.keyword.line;
    let [step, duration] = times(im, block);
    let duration = duration.unwrap_or(1.0);
    if block.keyword.has("STABILIZE") {
        im.change(line, "nothing is stabilized by dampers; rdsolve halves load steps that do not converge");
    }
    let is_riks = block.keyword.has("RIKS");
    if is_riks {
        end_of_riks(im, block);
    }
    let step = step.unwrap_or(duration).min(duration);
    set(im, line, StepProcedure::Static { step, duration, is_riks });
}

/// Says where a run of the arc-length method ends in rdsolve; refuses another end.
fn end_of_riks(im: &mut Importer, block: &KeywordBlock) {
    let data = block.data.first();
    let mut read = |at: usize| data.and_then(|data| im.number_at(data, at));
    let [factor, node] = [read(4), read(5)];
    let line = data.map_or(block.keyword.line, |data| data.line);
    match (factor, node) {
        (_, Some(_)) => im.refuse(line, "an end at a displacement is not translated: give the deck `stop`"),
        (Some(1.0), None) => {}
        (Some(_), None) => {
            im.refuse(line, "the run ends where the loads have their values: multiply them by this factor, and give 1")
        }
        (None, None) => im.change(line, "the run ends where the loads have their values"),
    }
}

/// `*DYNAMIC`.
pub fn dynamic(im: &mut Importer, block: &KeywordBlock) {
    let (keyword, line) = (&block.keyword, block.keyword.line);
    let is_explicit = keyword.has("EXPLICIT");
    let [first, second] = times(im, block);
    let has_direct = keyword.has("DIRECT");
    // In Abaqus/Explicit the first field is the time step, blank as a rule.
    let (step, duration) = (first.filter(|_| has_direct), second);
    let Some(duration) = duration.or(first.filter(|_| !is_explicit)) else {
        return im.refuse(line, "*DYNAMIC needs the time step and the duration on the line below");
    };
    let alpha = match keyword.value("ALPHA") {
        None => -0.05,
        Some(text) => match text.parse() {
            Ok(alpha) => alpha,
            Err(_) => return im.refuse(line, "ALPHA must be a number"),
        },
    };
    if keyword.has("APPLICATION") {
        im.change(line, "APPLICATION chooses further settings, which are not those of rdsolve");
    }
    set(im, line, StepProcedure::Dynamic { step, duration, alpha, is_explicit, mass_scaling: None });
}

/// `*FIXED MASS SCALING` of all elements up to a time step.
pub fn fixed_mass_scaling(im: &mut Importer, block: &KeywordBlock) {
    let (keyword, line) = (&block.keyword, block.keyword.line);
    let kind = keyword.value("TYPE").unwrap_or("BELOW MIN").to_ascii_uppercase().replace(' ', "");
    let step = keyword.value("DT").and_then(|text| text.parse::<f64>().ok()).filter(|step| *step > 0.0);
    let Some(step) = step.filter(|_| kind == "BELOWMIN" && !keyword.has("ELSET") && !keyword.has("FACTOR")) else {
        let why = "mass scaling is translated of all elements, with DT and TYPE=BELOW MIN; give `mass_scaling_step` of [integrator]";
        return im.refuse(line, why);
    };
    match &mut im.steps.at_hand().procedure {
        Some((StepProcedure::Dynamic { is_explicit: true, mass_scaling, .. }, _)) => *mass_scaling = Some(step),
        _ => return im.refuse(line, "mass scaling belongs to a step of *DYNAMIC, EXPLICIT"),
    }
    im.change(line, "elements get rotary inertia first, and mass where that is not enough");
}

/// In CalculiX explicit steps are linear by default, as others are.
pub fn settle_nonlinearity(im: &mut Importer) {
    let is_calculix = im.dialect == Some(Dialect::Calculix);
    im.steps.list.iter_mut().filter(|_| is_calculix).for_each(|step| {
        step.nonlinear.get_or_insert(false);
    });
}

/// Carries scaled masses on to later explicit steps. Refuses steps in time of a file that have other masses, for a deck has one set.
pub fn carry_scaled_masses(im: &mut Importer) {
    let mut first: Option<Option<f64>> = None;
    let mut unlike = Vec::new();
    for step in &mut im.steps.list {
        let Some((StepProcedure::Dynamic { is_explicit, mass_scaling, .. }, line)) = &mut step.procedure else {
            continue;
        };
        if *is_explicit && mass_scaling.is_none() {
            *mass_scaling = first.flatten();
        }
        if *first.get_or_insert(*mass_scaling) != *mass_scaling {
            unlike.push(*line);
        }
    }
    for line in unlike {
        im.refuse(
            line,
            "masses are scaled from the first step in time on, alike in all: give *FIXED MASS SCALING there",
        );
    }
}

/// `*MODAL DYNAMIC`.
pub fn modal_dynamic(im: &mut Importer, block: &KeywordBlock) {
    let [first, second] = times(im, block);
    let Some(duration) = second else { return im.refuse(block.keyword.line, "*MODAL DYNAMIC needs the duration") };
    im.change(block.keyword.line, "all motions take part, not only the modes computed before");
    let moves = |step: &StepCard| matches!(step.procedure, Some((StepProcedure::Dynamic { .. }, _)));
    if !block.keyword.has("CONTINUE") && im.steps.list.iter().any(moves) {
        im.change(
            block.keyword.line,
            "the motion of the step before goes on; without CONTINUE the other program begins at rest",
        );
    }
    set(
        im,
        block.keyword.line,
        StepProcedure::Dynamic { step: first, duration, alpha: 0.0, is_explicit: false, mass_scaling: None },
    );
    // Modes are linear whatever the step before is.
    im.steps.at_hand().nonlinear = Some(false);
}

/// `*FREQUENCY`.
pub fn frequency(im: &mut Importer, block: &KeywordBlock) {
    modes(im, block, false);
}

/// `*COMPLEX FREQUENCY`.
pub fn complex_frequency(im: &mut Importer, block: &KeywordBlock) {
    if block.keyword.has("CORIOLIS") {
        return im.refuse(block.keyword.line, "rotating frames are not translated");
    }
    modes(im, block, true);
}

fn modes(im: &mut Importer, block: &KeywordBlock, is_complex: bool) {
    let count = block.data.first().and_then(|data| data.words.first()).and_then(|word| word.whole());
    let mut at = |at: usize| block.data.first().and_then(|data| im.number_at(data, at)).filter(|x| *x > 0.0);
    let [from, up_to] = [at(1), at(2)];
    if from.is_some() && !is_complex {
        im.change(block.keyword.line, "modes below the lower frequency are computed as well");
    }
    let up_to = if is_complex { None } else { up_to };
    set(im, block.keyword.line, StepProcedure::Frequency { count, up_to, is_complex });
}

/// `*BUCKLE`.
pub fn buckle(im: &mut Importer, block: &KeywordBlock) {
    let count = block.data.first().and_then(|data| data.words.first()).and_then(|word| word.whole()).unwrap_or(1);
    set(im, block.keyword.line, StepProcedure::Buckle { count });
}

/// True where entries of earlier steps end; those of one step add up.
pub fn is_new(block: &KeywordBlock) -> bool {
    block.keyword.value("OP").is_some_and(|op| op.eq_ignore_ascii_case("NEW"))
}

/// True for a keyword with the imaginary part of a load.
pub fn is_imaginary(keyword: &Keyword) -> bool {
    keyword.has("IMAGINARY") || keyword.value("LOADCASE") == Some("2")
}

/// Degrees of freedom by the words of `*BOUNDARY`.
const WORDS: [(&str, &[usize]); 10] = [
    ("ENCASTRE", &[0, 1, 2, 3, 4, 5]),
    ("PINNED", &[0, 1, 2]),
    ("XSYMM", &[0, 4, 5]),
    ("YSYMM", &[1, 3, 5]),
    ("ZSYMM", &[2, 3, 4]),
    ("XASYMM", &[1, 2, 3]),
    ("YASYMM", &[0, 2, 4]),
    ("ZASYMM", &[0, 1, 5]),
    ("NOWARP", &[]),
    ("NOOVAL", &[]),
];

/// `*BOUNDARY`.
pub fn boundary(im: &mut Importer, block: &KeywordBlock) {
    let (keyword, line) = (&block.keyword, block.keyword.line);
    let history = match keyword.value("TYPE").map(str::to_ascii_uppercase).as_deref() {
        None | Some("DISPLACEMENT") => "displacement",
        Some("VELOCITY") => "velocity",
        Some("ACCELERATION") => "acceleration",
        Some(_) => return im.refuse(line, "TYPE is DISPLACEMENT, VELOCITY or ACCELERATION"),
    };
    if is_new(block) {
        im.steps.at_hand().new_supports = true;
    }
    let is_imaginary = is_imaginary(keyword);
    let amplitude = keyword.value("AMPLITUDE").map(str::to_owned);
    let is_fixed = keyword.has("FIXED");
    for data in block.data.iter().filter(|data| data.filled() > 0) {
        let Some((degrees, value)) = directions(im, data) else { continue };
        let (target, amplitude) = (im.target(&data.words[0]), amplitude.clone());
        let support =
            SupportLine { line: data.line, target, degrees, value, amplitude, history, is_imaginary, is_fixed };
        im.steps.at_hand().supports.push(support);
    }
}

/// Degrees of freedom and the value on a line of `*BOUNDARY`.
fn directions(im: &mut Importer, data: &Data) -> Option<(Vec<usize>, f64)> {
    let Some(second) = data.words.get(1) else {
        im.refuse(data.line, "this line needs a degree of freedom");
        return None;
    };
    let word = name_in(second).to_ascii_uppercase();
    if let Some((_, degrees)) = WORDS.iter().find(|(known, _)| *known == word) {
        return Some((degrees.to_vec(), 0.0));
    }
    let first = im.id(data, 1)?;
    let blank = data.words.get(2).is_none_or(|word| word.bytes.is_empty());
    let last = if blank { first } else { im.id(data, 2)? };
    if first == 0 || last < first || last > 6 {
        let about = match first {
            7.. => "rdsolve has the degrees of freedom 1 to 6 alone: no warping, pressure or temperature",
            _ => "first and last degree of freedom must count upwards from 1 to 6",
        };
        im.refuse_at(second, about);
        return None;
    }
    let value = im.number_at(data, 3).unwrap_or(0.0);
    Some(((first as usize - 1..last as usize).collect(), value))
}

/// `*CLOAD`.
pub fn forces(im: &mut Importer, block: &KeywordBlock) {
    let keyword = &block.keyword;
    let is_imaginary = is_imaginary(keyword);
    if !im.steps.is_open {
        return im.refuse(keyword.line, NO_STEP);
    }
    if is_new(block) {
        im.steps.at_hand().new_forces = true;
    }
    let amplitude = keyword.value("AMPLITUDE").map(str::to_owned);
    let is_follower = keyword.has("FOLLOWER");
    for data in block.data.iter().filter(|data| data.filled() > 0) {
        let Some(degree) = im.id(data, 1) else { continue };
        if !(1..=6).contains(&degree) {
            im.refuse(data.line, "rdsolve has forces along the degrees of freedom 1 to 6 alone");
            continue;
        }
        let value = im.number_at(data, 2).unwrap_or(0.0);
        let (target, amplitude) = (im.target(&data.words[0]), amplitude.clone());
        let degree = degree as usize - 1;
        let force = ForceLine { line: data.line, target, degree, value, amplitude, is_follower, is_imaginary };
        im.steps.at_hand().forces.push(force);
    }
}

/// `*DLOAD`.
pub fn element_loads(im: &mut Importer, block: &KeywordBlock) {
    spread(im, block, false);
}

/// `*DSLOAD`.
pub fn surface_loads(im: &mut Importer, block: &KeywordBlock) {
    spread(im, block, true);
}

fn spread(im: &mut Importer, block: &KeywordBlock, is_surface: bool) {
    if !im.steps.is_open {
        return im.refuse(block.keyword.line, NO_STEP);
    }
    if is_new(block) {
        im.steps.at_hand().new_spread = true;
    }
    let amplitude = block.keyword.value("AMPLITUDE").map(str::to_owned);
    let is_imaginary = is_imaginary(&block.keyword);
    let is_fixed = block.keyword.value("FOLLOWER").is_some_and(|word| word.eq_ignore_ascii_case("NO"));
    for data in block.data.iter().filter(|data| data.filled() > 0) {
        let Some(kind) = data.words.get(1).map(name_in) else {
            im.refuse(data.line, "this line needs the kind of the load");
            continue;
        };
        let values = (2..data.filled()).map(|at| im.number_at(data, at).unwrap_or(0.0)).collect();
        let (target, amplitude, kind) = (im.target(&data.words[0]), amplitude.clone(), kind.to_ascii_uppercase());
        let load = SpreadLine { line: data.line, target, is_surface, kind, values, is_imaginary, is_fixed, amplitude };
        im.steps.at_hand().spread.push(load);
    }
}

/// `*INITIAL CONDITIONS`.
pub fn initial_conditions(im: &mut Importer, block: &KeywordBlock) {
    let line = block.keyword.line;
    match block.keyword.value("TYPE").unwrap_or_default().to_ascii_uppercase().replace(' ', "").as_str() {
        "ROTATINGVELOCITY" => rotations(im, block),
        "VELOCITY" => {
            for data in block.data.iter().filter(|data| data.filled() > 0) {
                let Some(degree) = im.id(data, 1).filter(|degree| (1..=6).contains(degree)) else { continue };
                let (value, target) = (im.number_at(data, 2).unwrap_or(0.0), im.target(&data.words[0]));
                im.steps.velocities.push((data.line, target, degree as usize - 1, value));
            }
        }
        "TEMPERATURE" => temperatures::initial(im, block),
        "DISPLACEMENT" => {
            let moved = block.data.iter().any(|data| im.number_at(data, 2).is_some_and(|value| value != 0.0));
            match moved {
                true => im.refuse(line, "displacements at the start are not translated: move the nodes of the mesh"),
                false => im.ignore(line, "all displacements at the start are zero"),
            }
        }
        kind => im.refuse(line, &format!("initial conditions of TYPE={kind} are not translated")),
    }
}

/// Rigid motions at the start, on two lines each: nodes, angular velocity and velocity; two points of the axis.
fn rotations(im: &mut Importer, block: &KeywordBlock) {
    let lines: Vec<&Data> = block.data.iter().filter(|data| data.filled() > 0).collect();
    for pair in lines.chunks(2) {
        let [first, second] = pair else {
            return im.refuse(pair[0].line, "a rotating velocity needs two points of its axis on the next line");
        };
        let mut vector = |data: &Data, at: usize| -> Vec3 {
            Vec3::from_fn(|i, _| if at + i < data.filled() { im.number_at(data, at + i).unwrap_or(0.0) } else { 0.0 })
        };
        let (velocity, about, end) = (vector(first, 2), vector(second, 0), vector(second, 3));
        let rate = im.number_at(first, 1).unwrap_or(0.0);
        let Some(axis) = (end - about).try_normalize(0.0) else {
            im.refuse(second.line, "the two points of this axis are one");
            continue;
        };
        let nodes = im.target(&first.words[0]);
        im.steps.rotations.push(RotatingNodes { line: first.line, nodes, velocity, spin: rate * axis, about });
    }
}

/// `*NODE PRINT`, `*NODE FILE`, `*NODE OUTPUT`.
pub fn node_output(im: &mut Importer, block: &KeywordBlock) {
    let words: Vec<String> =
        block.data.iter().flat_map(|data| &data.words).map(|word| name_in(word).to_ascii_uppercase()).collect();
    let requests = &mut im.steps.requests;
    requests.nodes |= words.iter().any(|word| word.starts_with(['U', 'V', 'A']));
    requests.reactions |= words.iter().any(|word| word.starts_with("RF"));
    requests.fields |= block.keyword.key() != "NODEPRINT";
}

/// `*EL PRINT`, `*EL FILE`, `*ELEMENT OUTPUT`, `*SECTION PRINT`.
pub fn element_output(im: &mut Importer, block: &KeywordBlock) {
    let words: Vec<String> =
        block.data.iter().flat_map(|data| &data.words).map(|word| name_in(word).to_ascii_uppercase()).collect();
    im.steps.requests.sections |= words.iter().any(|word| word.starts_with('S') || word.starts_with("PEEQ"));
}

/// `*OUTPUT`.
pub fn output(im: &mut Importer, block: &KeywordBlock) {
    let keyword = &block.keyword;
    let preselect = keyword
        .value("VARIABLE")
        .is_some_and(|word| ["PRESELECT", "ALL"].contains(&word.to_ascii_uppercase().as_str()));
    let requests = &mut im.steps.requests;
    requests.fields |= keyword.has("FIELD");
    requests.nodes |= preselect || keyword.has("FIELD");
    requests.reactions |= preselect;
    requests.sections |= preselect;
}

/// `*HEADING`.
pub fn heading(im: &mut Importer, block: &KeywordBlock) {
    // PrePoMax has its own remarks there.
    if let Some(data) = block.data.iter().find(|data| !data.words[0].bytes.starts_with(b"Hash:")) {
        im.title = data.words.iter().map(|word| word.text()).collect::<Vec<_>>().join(", ");
    }
}
