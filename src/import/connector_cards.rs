//! Connectors: `*CONNECTOR SECTION`, behaviours, motions and loads.

use crate::file_content::{ConnectorBehavior, ConnectorDrive, ConnectorSection};
use crate::importer::Importer;
use crate::keyword_block::KeywordBlock;
use crate::step_cards;
use base::text_file::cards::name_in;

/// `*CONNECTOR SECTION`.
pub fn section(im: &mut Importer, block: &KeywordBlock) {
    let (keyword, line) = (&block.keyword, block.keyword.line);
    let Some(set) = keyword.value("ELSET") else { return im.refuse(line, "*CONNECTOR SECTION needs ELSET=") };
    let names = |at: usize| -> Vec<String> {
        let words =
            block.data.get(at).map(|data| data.words.iter().map(name_in).collect::<Vec<_>>()).unwrap_or_default();
        words.into_iter().filter(|word| !word.is_empty()).collect()
    };
    let kinds: Vec<String> = names(0).into_iter().map(|kind| kind.to_ascii_uppercase()).collect();
    if kinds.is_empty() {
        return im.refuse(line, "*CONNECTOR SECTION needs a type of connection on the line below");
    }
    let orientation = names(1).into_iter().next();
    let behavior = keyword.value("BEHAVIOR").map(str::to_lowercase);
    im.connectors.sections.push(ConnectorSection {
        line,
        target: im.set_target(set, line),
        kinds,
        orientation,
        behavior,
    });
}

/// `*CONNECTOR BEHAVIOR`.
pub fn behavior(im: &mut Importer, block: &KeywordBlock) {
    let name = block.keyword.value("NAME").unwrap_or_default().to_lowercase();
    im.connectors.behaviors.push(ConnectorBehavior { name, ..ConnectorBehavior::default() });
}

/// The component that a behaviour is about, from 0 to 5.
fn component(im: &mut Importer, block: &KeywordBlock) -> Option<usize> {
    let component = block.keyword.value("COMPONENT").and_then(|text| text.parse::<usize>().ok());
    let component = component.and_then(|component| component.checked_sub(1)).filter(|component| *component < 6);
    if component.is_none() || block.keyword.has("NONLINEAR") {
        im.refuse(block.keyword.line, "of behaviours those that are linear, with COMPONENT= of 1 to 6, are translated");
        return None;
    }
    component
}

/// `*CONNECTOR ELASTICITY`.
pub fn elasticity(im: &mut Importer, block: &KeywordBlock) {
    let Some(component) = component(im, block) else { return };
    let value = block.data.first().and_then(|data| im.number_at(data, 0));
    if let Some(behavior) = im.connectors.behaviors.last_mut() {
        behavior.stiffness[component] = value;
    }
}

/// `*CONNECTOR DAMPING`.
pub fn damping(im: &mut Importer, block: &KeywordBlock) {
    let Some(component) = component(im, block) else { return };
    let value = block.data.first().and_then(|data| im.number_at(data, 0));
    if let Some(behavior) = im.connectors.behaviors.last_mut() {
        behavior.damping[component] = value;
    }
}

/// `*CONNECTOR STOP`.
pub fn stop(im: &mut Importer, block: &KeywordBlock) {
    let Some(component) = component(im, block) else { return };
    let Some([low, high]) = block.data.first().map(|data| [im.number_at(data, 0), im.number_at(data, 1)]) else {
        return;
    };
    let (Some(low), Some(high)) = (low, high) else {
        return im.refuse(block.keyword.line, "a stop needs its lower and its upper limit");
    };
    if let Some(behavior) = im.connectors.behaviors.last_mut() {
        behavior.stops[component] = Some([low, high]);
    }
}

/// `*CONNECTOR MOTION`.
pub fn motion(im: &mut Importer, block: &KeywordBlock) {
    let quantity = match block.keyword.value("TYPE").map(str::to_ascii_uppercase).as_deref() {
        None | Some("DISPLACEMENT") => "position",
        Some("VELOCITY") => "velocity",
        Some("ACCELERATION") => "acceleration",
        Some(_) => return im.refuse(block.keyword.line, "TYPE is DISPLACEMENT, VELOCITY or ACCELERATION"),
    };
    drive(im, block, Some(quantity));
}

/// `*CONNECTOR LOAD`.
pub fn load(im: &mut Importer, block: &KeywordBlock) {
    drive(im, block, None);
}

fn drive(im: &mut Importer, block: &KeywordBlock, quantity: Option<&'static str>) {
    if step_cards::is_new(block) && im.steps.list.len() > 1 {
        return im.refuse(block.keyword.line, "what drives a connector acts in all steps: OP=NEW ends nothing");
    }
    let amplitude = block.keyword.value("AMPLITUDE").map(str::to_owned);
    for data in &block.data {
        let Some(component) = im.id(data, 1).and_then(|component| (component as usize).checked_sub(1)) else {
            continue;
        };
        if component > 5 {
            im.refuse(data.line, "a component of a connector is one of 1 to 6");
            continue;
        }
        let value = im.number_at(data, 2).unwrap_or(0.0);
        let target = im.target(&data.words[0]);
        let amplitude = amplitude.clone();
        im.connectors.drives.push(ConnectorDrive { line: data.line, target, component, value, amplitude, quantity });
    }
}
