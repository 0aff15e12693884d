//! Contact pairs and their laws: `*CONTACT PAIR`, `*SURFACE INTERACTION`, `*FRICTION`, `*SURFACE BEHAVIOR`.

use crate::contact_content::{ContactCard, InteractionCard, ModelChange};
use crate::importer::Importer;
use crate::keyword_block::KeywordBlock;
use crate::scopes::NamedTarget;
use crate::step_cards::NO_STEP;

/// The reason against a change of a pair that no `*CONTACT PAIR` has.
pub const UNKNOWN_PAIR: &str = "no *CONTACT PAIR joins these two surfaces in this order";

/// `*SURFACE INTERACTION`.
pub fn interaction(im: &mut Importer, block: &KeywordBlock) {
    let Some(name) = block.keyword.value("NAME").map(str::to_lowercase) else {
        return im.refuse(block.keyword.line, "*SURFACE INTERACTION needs NAME=");
    };
    im.constraints.contacts.interactions.push(InteractionCard { name, friction: None });
}

/// `*FRICTION`: a coefficient, or with EXPONENTIAL DECAY two and their decay.
pub fn friction(im: &mut Importer, block: &KeywordBlock) {
    let line = block.keyword.line;
    if block.keyword.has("ROUGH") || block.keyword.has("TAUMAX") {
        return im.refuse(line, "friction is Coulomb's in rdsolve, without ROUGH and TAUMAX: give a coefficient");
    }
    let values = block.data.first().map(|data| im.numbers(data)).unwrap_or_default();
    if block.data.len() > 1 {
        im.change(line, "friction that depends on pressure or temperature: the first row is taken");
    }
    let at = |i: usize| values.get(i).copied().unwrap_or(0.0);
    let friction = match block.keyword.has("EXPONENTIALDECAY") {
        true => [at(0), at(1), at(2)],
        false => [at(0), at(0), 0.0],
    };
    let [first, second, decay] = friction;
    if !(first.is_finite() && 0.0 <= second && second <= first && (0.0..f64::INFINITY).contains(&decay)) {
        let why = "coefficients of friction are 0 or more, the one while it slips is at most the one while it sticks, and so is the decay 0 or more";
        return im.refuse(line, why);
    }
    match im.constraints.contacts.interactions.last_mut() {
        Some(law) => law.friction = Some((friction, line)).filter(|_| first > 0.0),
        None => im.refuse(line, "no *SURFACE INTERACTION stands before this line"),
    }
}

/// `*SURFACE BEHAVIOR`: pressure over penetration, which rdsolve chooses.
pub fn behavior(im: &mut Importer, block: &KeywordBlock) {
    let line = block.keyword.line;
    let kind = block.keyword.value("PRESSURE-OVERCLOSURE").unwrap_or("HARD").to_ascii_uppercase();
    if block.keyword.has("NOSEPARATION") || kind == "TIED" {
        return im.refuse(line, "contact opens again in rdsolve: give *TIE for surfaces that stay together");
    }
    if kind != "HARD" {
        let how = "rdsolve chooses the stiffness of contact, as `check` tells; give `stiffness`, a force per penetration of each node, where this one matters";
        im.change(line, how);
    }
}

/// `*CONTACT PAIR`: lines of two surfaces.
pub fn pair(im: &mut Importer, block: &KeywordBlock) {
    let (keyword, line) = (&block.keyword, block.keyword.line);
    if keyword.has("TIED") {
        return im.refuse(line, "contact opens again in rdsolve: give *TIE for surfaces that stay together");
    }
    if keyword.has("ADJUST") {
        im.change(line, "nodes keep their places: ADJUST moves none");
    }
    if keyword.has("SMALLSLIDING") {
        im.change(line, "surfaces slide without limit; SMALL SLIDING keeps the planes of contact of the start");
    }
    let is_deleted = keyword.value("OP").is_some_and(|op| op.eq_ignore_ascii_case("DELETE"));
    let Some(interaction) = keyword.value("INTERACTION").or(is_deleted.then_some("")).map(str::to_lowercase) else {
        return im.refuse(line, "*CONTACT PAIR needs INTERACTION=");
    };
    let of_surfaces = keyword.value("TYPE").is_some_and(|kind| kind.to_ascii_uppercase().starts_with("SURFACE"));
    if keyword.has("NOTHICKNESS") {
        im.change(line, "shells touch with half their thickness");
    }
    let is_thin = !of_surfaces && !keyword.has("SMALLSLIDING") && !keyword.has("NOTHICKNESS");
    for data in block.data.iter().filter(|data| data.filled() > 0) {
        let targets: Vec<NamedTarget> = data.words[..data.filled().min(2)].iter().map(|word| im.target(word)).collect();
        let surfaces = match &targets[..] {
            [slave, master] => [slave.clone(), master.clone()],
            _ => [targets[0].clone(), targets[0].clone()],
        };
        enter(im, data.line, surfaces, (interaction.clone(), is_thin), is_deleted);
    }
}

/// Adds a pair, or notes that a step has it or not. A pair has one card, which its changes are about: named again it comes back.
fn enter(
    im: &mut Importer,
    line: usize,
    surfaces: [NamedTarget; 2],
    (interaction, is_thin): (String, bool),
    is_deleted: bool,
) {
    let change = |is_added| ModelChange::of_pair(line, surfaces.to_vec(), is_added);
    let [ends, comes] = [change(false), change(true)];
    let known = im.constraints.contacts.pairs.iter().find(|card| comes.is_of_pair(&card.surfaces));
    let known = known.map(|card| (card.line, card.interaction == interaction && card.is_thin == is_thin));
    let is_in_step = im.steps.is_open;
    match known {
        _ if !is_in_step && (is_deleted || !im.steps.list.is_empty()) => im.refuse(line, NO_STEP),
        None if is_deleted => im.refuse(line, UNKNOWN_PAIR),
        Some(_) if is_deleted => im.steps.at_hand().changes.push(ends),
        Some((_, true)) if is_in_step => im.steps.at_hand().changes.push(comes),
        Some((first, _)) => {
            let why =
                format!("line {first} names this pair already: a pair has one *CONTACT PAIR, the same in all steps");
            im.refuse(line, &why);
        }
        None => {
            if im.steps.list.len() > 1 {
                // A pair of a later step is away before.
                im.steps.list[0].changes.push(ends);
                im.steps.at_hand().changes.push(comes);
            }
            im.constraints.contacts.pairs.push(ContactCard { line, interaction, surfaces, is_thin });
        }
    }
}
