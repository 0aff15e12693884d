//! `*MODEL CHANGE`: contact pairs, springs, dampers, gaps and connectors that come and go by step.

use crate::build::Build;
use crate::contact_cards::UNKNOWN_PAIR;
use crate::contact_content::{ContactCard, ModelChange};
use crate::element_types::ElementUse;
use crate::file_content::StepCard;
use crate::importer::Importer;
use crate::joints;
use crate::keyword_block::KeywordBlock;
use crate::scopes::NamedTarget;
use crate::step_cards::NO_STEP;
use crate::timeline::Timeline;

/// How an added spring along a line differs.
const LINE_HAS_STRAIN: &str = "an added spring has no force at its length in the mesh, as with ADD=WITH STRAIN: `free_length` of its [[links]] gives another";
/// How an added joint differs.
const JOINT_HAS_NO_STRAIN: &str = "an added joint holds its ends as the step finds them, as with ADD=STRAIN FREE";
/// Why springs along axes do not come without strain.
const AXES_HAVE_STRAIN: &str =
    "springs along axes have no force where the mesh has their ends: give ADD=WITH STRAIN, or a SPRINGA";

/// `*MODEL CHANGE`.
pub fn model_change(im: &mut Importer, block: &KeywordBlock) {
    let (keyword, line) = (&block.keyword, block.keyword.line);
    let is_pair = match keyword.value("TYPE").unwrap_or("ELEMENT").to_ascii_uppercase().as_str() {
        "ELEMENT" => false,
        kind if kind.starts_with("CONTACT") => true,
        _ => return im.refuse(line, "TYPE is CONTACT PAIR or ELEMENT"),
    };
    if keyword.has("MECHSTRAINTORESIDUAL") {
        return im.refuse(line, "MECHSTRAINTORESIDUAL is not translated: strains stay strains");
    }
    let (is_added, is_removed) = (keyword.has("ADD"), keyword.has("REMOVE"));
    if keyword.has("ACTIVATE") && !is_added && !is_removed {
        return im.ignore(line, "ACTIVATE prepares changes in a restarted run");
    }
    if is_added == is_removed {
        return im.refuse(line, "*MODEL CHANGE needs ADD or REMOVE");
    }
    if !im.steps.is_open {
        return im.refuse(line, NO_STEP);
    }
    let has_strain = keyword.value("ADD").is_some_and(|how| how.to_ascii_uppercase().starts_with("WITH"));
    for data in block.data.iter().filter(|data| data.filled() > 0) {
        let mut targets: Vec<NamedTarget> = data.words[..data.filled()].iter().map(|word| im.target(word)).collect();
        if let ([one], true) = (&targets[..], is_pair) {
            targets.push(one.clone());
        }
        im.steps.at_hand().changes.push(ModelChange { line: data.line, targets, is_pair, is_added, has_strain });
    }
}

/// Finds the steps of contact pairs and elements. Refuses parts, which act in all stages.
pub fn find(build: &mut Build) {
    let changes: Vec<(usize, ModelChange)> = build.im.steps.list.iter().enumerate().flat_map(of_step).collect();
    for (step, change) in changes {
        let known = |card: &ContactCard| change.is_of_pair(&card.surfaces);
        match change.is_pair {
            true if build.im.constraints.contacts.pairs.iter().any(known) => {}
            true => build.im.refuse(change.line, UNKNOWN_PAIR),
            false => elements(build, step, &change),
        }
    }
}

fn of_step((step, card): (usize, &StepCard)) -> Vec<(usize, ModelChange)> {
    card.changes.iter().map(|change| (step, change.clone())).collect()
}

/// Notes the elements that come or go in a step.
fn elements(build: &mut Build, step: usize, change: &ModelChange) {
    let cells: Vec<usize> = change.targets.iter().flat_map(|target| build.cells(target)).collect();
    for at in cells {
        let cell = &build.mesh.cells[at];
        if !build.im.scopes.types[cell.kind].becomes.is_between_nodes() {
            let why = format!(
                "element {} acts in all stages: springs, dampers, gaps, connectors and contact pairs alone come and go",
                cell.id
            );
            return build.im.refuse(change.line, &why);
        }
        let steps = build.im.steps.list.len();
        let acts = build.timeline.acting.entry(at).or_insert_with(|| vec![true; steps]);
        let comes = change.is_added && !acts[step];
        acts[step..].fill(change.is_added);
        if comes {
            judge_added(build, at, change);
        }
    }
}

/// Judges the place where an added element has no force: that of the mesh, or the current one.
fn judge_added(build: &mut Build, at: usize, change: &ModelChange) {
    let becomes = build.im.scopes.types[build.mesh.cells[at].kind].becomes;
    let connection = joints::connection_of(build, at).filter(|_| becomes == ElementUse::Connector);
    let is_joint = connection.as_deref().is_some_and(joints::is_joint);
    let is_along_line = becomes == ElementUse::AxialSpring || connection.as_deref() == Some("AXIAL");
    let is_along_axes = matches!(becomes, ElementUse::GroundSpring | ElementUse::DirectedSpring | ElementUse::JointC);
    match change.has_strain {
        true if is_joint => build.im.change(change.line, JOINT_HAS_NO_STRAIN),
        false if is_along_line => build.im.change(change.line, LINE_HAS_STRAIN),
        false if is_along_axes || connection.is_some() && !is_joint => build.im.refuse(change.line, AXES_HAVE_STRAIN),
        _ => {}
    }
}

impl Timeline {
    /// The stages of an element; `None` for all.
    pub fn stages_of_cell(&self, cell: usize) -> Option<Vec<String>> {
        let acts = self.acting.get(&cell)?;
        self.stages_where(|step| acts[step])
    }

    /// The stages of a contact pair; `None` for all.
    pub fn stages_of_pair(&self, steps: &[StepCard], pair: &[NamedTarget; 2]) -> Option<Vec<String>> {
        let last = |step: usize| {
            let mut changes = steps[..=step].iter().flat_map(|card| &card.changes);
            changes.rfind(|change| change.is_of_pair(pair)).is_none_or(|change| change.is_added)
        };
        self.stages_where(last)
    }

    fn stages_where(&self, acts: impl Fn(usize) -> bool) -> Option<Vec<String>> {
        let acting: Vec<String> =
            self.stages.iter().filter(|stage| acts(stage.step)).map(|stage| stage.name.clone()).collect();
        (acting.len() < self.stages.len()).then_some(acting)
    }
}
