//! Builds the deck and its mesh from the content of the file: all families of tables, one after the other.

use crate::build::Build;
use crate::deck_text::{DeckTable, DeckText};
use crate::flat_mesh::FlatMesh;
use crate::importer::Importer;
use crate::tied_nodes::TiedNodes;
use crate::timeline::Timeline;
use crate::{
    base_motion, bodies, contacts, distributing, equations, harmonics, joints, linear, links, loads, material_cards,
    mesh_text, model_changes, nodal_axes, output, parts, pretension, property_cards, single_loads, spread_loads,
    stage_text, step_cards, supports, surface_ties, temperatures, ties,
};
use std::collections::{BTreeSet, HashMap};

/// The text of the deck and of the mesh.
pub struct BuiltDeck {
    /// The deck below its head.
    pub deck: DeckText,
    /// The mesh.
    pub mesh: String,
}

/// Builds the deck.
pub fn build(im: &mut Importer, mesh_file: &str) -> BuiltDeck {
    im.scopes.place_parts();
    let (mesh, faults) = FlatMesh::new(&im.scopes);
    faults.iter().for_each(|(line, why)| im.refuse(*line, why));
    loads::drop_those_of_modes(im);
    single_loads::join(im, &mesh);
    harmonics::prepare(im);
    step_cards::settle_nonlinearity(im);
    linear::end_loads_before_perturbations(im);
    step_cards::carry_scaled_masses(im);
    material_cards::say_temperatures(im, &mesh);
    property_cards::refuse_turned_axes(im);
    let timeline = Timeline::new(im);
    let mut build = Build {
        im,
        mesh,
        deck: DeckText::default(),
        timeline,
        pieces: Vec::new(),
        piece_of: HashMap::new(),
        groups: Default::default(),
        turned: HashMap::new(),
        body_of: HashMap::new(),
        rotating: BTreeSet::new(),
        parts_of_bodies: BTreeSet::new(),
        weighed: BTreeSet::new(),
        turning: BTreeSet::new(),
        tied: TiedNodes::default(),
        has_gravity: false,
        amplitudes: Default::default(),
    };
    build.tied.axes = nodal_axes::of_nodes(&mut build);
    ties::merge(&mut build);
    pretension::cut(&mut build);
    build.groups_of_file();
    build.deck.add(DeckTable::new("mesh", 0).text("file", mesh_file));
    stage_text::stages(&mut build);
    model_changes::find(&mut build);
    refuse_modes_alone(&mut build);
    parts::parts(&mut build);
    bodies::bodies(&mut build);
    distributing::couplings(&mut build);
    links::masses(&mut build);
    links::links(&mut build);
    joints::connectors(&mut build);
    ties::joints(&mut build);
    pretension::joints(&mut build);
    surface_ties::surface_ties(&mut build);
    contacts::contacts(&mut build);
    equations::equations(&mut build);
    supports::supports(&mut build);
    loads::loads(&mut build);
    base_motion::accelerations(&mut build);
    spread_loads::spread_loads(&mut build);
    temperatures::heat(&mut build);
    loads::velocities(&mut build);
    output::output(&mut build);
    let mesh = mesh_text::mesh(&build);
    BuiltDeck { deck: build.deck, mesh }
}

/// Refuses several steps of modes without a step that advances time: nothing could lead to their states.
fn refuse_modes_alone(build: &mut Build) {
    let stages = &build.timeline.stages;
    if let [_, second, ..] = &stages[..]
        && stages.iter().all(|stage| stage.duration == 0.0)
    {
        let line = build.im.steps.list[second.step].line;
        build.im.refuse(line, "modes in several steps need a step of statics before them: give each step a file");
    }
}
