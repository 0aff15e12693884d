//! Deck → model, with all errors reported together. Each table is read after the tables it depends on.

use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::sync::Arc;

use super::amplitudes::amplitudes;
use super::attachments::attachments;
use super::bars::bars;
use super::beams::beams;
use super::beams::mass_nodes::add_mass_nodes;
use super::beams::station_file::{GivenStations, load_stations};
use super::bodies::bodies;
use super::cases::cases;
use super::contacts::contacts;
use super::contacts::points::connect_touching_points;
use super::data::{
    Analysis, ArcLength, Cadence, Constraints, Contact, Damping, ElementMasses, Expect, FieldFiles, Iteration, Joint,
    Load, LoadCases, Mass, MeshFile, Model, Origin, Part, RecordFile, Rigid, RunStage, Solution, StepLength, Study,
};
use super::environment::{AccelerationFields, damping, environment, gravity};
use super::equations::equations;
use super::expects::{expects, summed_reactions};
use super::groups::Groups;
use super::initial::initial;
use super::joints::coordinate::Joints;
use super::joints::{check_joints, joints, released};
use super::links::{ModelLinks, links};
use super::loads::temperature::temperatures;
use super::loads::unbalance::unbalances;
use super::loads::{Loads, loads};
use super::masses::masses;
use super::materials::materials;
use super::merge_diagnostics::merge_diagnostics;
use super::mesh_file::{Input, MeshNodes};
use super::motion_curves::motion_curves;
use super::moving_frames::moving_frames;
use super::names::Names;
use super::output::{Selection, output, supported_sets, write_all_nodes};
use super::part_context::PartContext;
use super::parts::Parts;
use super::places::nodes::{Nodes, Topology};
use super::plausibility::all_held::check_all_held;
use super::plausibility::amplitude_ends::check_amplitude_ends;
use super::plausibility::angles::check_angles;
use super::plausibility::cyclic_hardening::check_cyclic_hardening;
use super::plausibility::loose::check_loose;
use super::plausibility::node_places::place_nodes;
use super::plausibility::parts_at_rest::check_parts_at_rest;
use super::plausibility::proportions::check_proportions;
use super::plausibility::scaled_loads::check_scaled_loads;
use super::plausibility::slivers::check_slivers;
use super::plausibility::sudden_weight::check_sudden_weight;
use super::plausibility::ties::Ties;
use super::plausibility::units::check_units;
use super::plausibility::unjoined::check_unjoined;
use super::plausibility::unseen_record::check_unseen_records;
use super::plausibility::unused::drop_unused;
use super::plausibility::upward::check_upward;
use super::plausibility::{check_content, check_static, check_use};
use super::procedure::choose_scheme::choose_scheme;
use super::procedure::control::{control, path_iteration};
use super::procedure::linear::{check_linear, make_elastic};
use super::procedure::mass_scaling::check_mass_scaling;
use super::procedure::modes::{check_modal, hold_at_start, refuse_power_dampers};
use super::procedure::response::{add_expected, check_harmonic, note_tables_of_state};
use super::procedure::scaled_masses::masses as element_masses;
use super::procedure::stops::{self, NamedActors};
use super::procedure::study::study;
use super::procedure::{analysis, check_explicit};
use super::records::{Record, load_records};
use super::reduced::{reductions, share_interfaces};
use super::report::Report;
use super::rigid::rigid_bodies;
use super::scene::Scene;
use super::sections::Sections;
use super::shells::chords::check_chords;
use super::shells::edges::{bulges, least_bulges, set_bulges};
use super::shells::shells;
use super::stages::{self, CurrentStage, StageSequence};
use super::superelements::files::{GivenMatrices, load_matrices};
use super::superelements::superelements;
use super::supports::given_rotations::{TurnedNode, given_turns};
use super::supports::supports;
use super::ties::ties;
use super::values::vec3;
use base::diagnostic::{Diagnostic, Source};
use deck::read::ROOT;
use deck::{Deck, DeckRead};
use mechanics::amplitude::Amplitude;
use mechanics::elements::contact::ContactLaw;
use mechanics::integrators::{Scheme, Stepping};

/// The files that a deck names.
#[derive(Clone, Copy)]
struct Files<'d> {
    /// Its mesh.
    input: Option<&'d Input>,
    /// The records of its amplitudes.
    records: &'d [Option<Record>],
    /// The matrices of its superelements.
    matrices: &'d [Option<GivenMatrices>],
    /// The sections of its beams by station.
    stations: &'d [Option<GivenStations>],
}

impl Files<'_> {
    /// The files of records, matrices and stations, for the model to remember.
    fn origins(&self) -> Vec<RecordFile> {
        let matrices = self.matrices.iter().flatten().flat_map(|given| &given.files).cloned();
        let stations = self.stations.iter().flatten().flat_map(|given| &given.files).cloned();
        self.records.iter().flatten().map(Record::origin).chain(matrices).chain(stations).collect()
    }
}

/// Reads a deck and builds its model; everything there is to say about it, in the order of the deck. Of a deck with stages it is the model
/// of the first.
pub fn read(source: &Source) -> (Option<Model>, Vec<Diagnostic>) {
    let (models, problems) = read_stages(source);
    (models.into_iter().next(), problems)
}

/// Reads a deck and builds the model of each of its stages (one without stages); diagnostics are in the order of the deck.
pub fn read_stages(source: &Source) -> (Vec<Model>, Vec<Diagnostic>) {
    build_read(deck::read(source), source)
}

/// As [`read_stages`], of the deck that has been read from the source.
pub fn build_read(deck: DeckRead, source: &Source) -> (Vec<Model>, Vec<Diagnostic>) {
    read_from(deck, source, (&[], None))
}

/// Rebuilds the model of the next stage, after stages with an early end at the times `reached`. Data independent of times are those of the
/// `planned` model.
///
/// # Errors
/// The deck, or one of its files, has changed.
pub fn replan(source: &Source, reached: &[f64], planned: &Model) -> Result<Model, String> {
    let (models, said) = read_from(deck::read(source), source, (reached, Some(planned)));
    let mut model = models.into_iter().next().ok_or_else(|| {
        said.into_iter()
            .find(Diagnostic::is_error)
            .map_or_else(|| "there is none".to_owned(), |problem| problem.message)
    })?;
    model.analysis.plane = planned.analysis.plane;
    // Amplitudes beyond the modes that were found are no unknowns.
    for node in model.reductions.iter().flat_map(|of| &of.amplitudes) {
        model.nodes[*node].is_number = planned.nodes[*node].is_number;
    }
    model.reductions.clone_from(&planned.reductions);
    let known: HashMap<&str, &Contact> = planned.each::<Contact>().map(|known| (known.name.as_str(), known)).collect();
    for contact in model.each_mut::<Contact>() {
        if let Some(known) = known.get(contact.name.as_str()) {
            (contact.law, contact.chosen) = (known.law, known.chosen.clone());
        }
    }
    Ok(model)
}

/// The models of all stages, or of the next one, planned otherwise, after some that have ended at these times.
fn read_from(
    (deck, mut problems): DeckRead,
    source: &Source,
    stages: (&[f64], Option<&Model>),
) -> (Vec<Model>, Vec<Diagnostic>) {
    let folder = Path::new(&source.path).parent().unwrap_or(Path::new(""));
    let (input, mut said) = deck.as_ref().map_or((None, Vec::new()), |deck| Input::load(deck, folder));
    let (records, of_records) = deck.as_ref().map_or((Vec::new(), Vec::new()), |deck| load_records(deck, folder));
    said.extend(of_records);
    let (matrices, of_matrices) = deck.as_ref().map_or((Vec::new(), Vec::new()), |deck| load_matrices(deck, folder));
    said.extend(of_matrices);
    let (stations, of_stations) = deck.as_ref().map_or((Vec::new(), Vec::new()), |deck| load_stations(deck, folder));
    said.extend(of_stations);
    let files = Files { input: input.as_ref(), records: &records, matrices: &matrices, stations: &stations };
    let (mut models, more) = match &deck {
        Some(deck) if !deck.stages.is_empty() => build_stages(deck, stages, files),
        Some(deck) => {
            let (model, said) = build(deck, files);
            (model.into_iter().collect(), said)
        }
        None => (Vec::new(), Vec::new()),
    };
    problems.extend(said);
    if problems.iter().any(Diagnostic::is_error) {
        models.clear();
    }
    problems.extend(more);
    problems.sort_by_key(|problem| problem.place.as_ref().map_or(usize::MAX, |place| place.start));
    (models, problems)
}

/// Builds the models of all stages of a deck, or only of the next one with `planned` as its model so far. After errors there are none.
fn build_stages(
    deck: &Deck,
    (reached, planned): (&[f64], Option<&Model>),
    files: Files,
) -> (Vec<Model>, Vec<Diagnostic>) {
    let mut report = Report::new(deck);
    let mut sequence = StageSequence::new(deck, reached, &mut report);
    stages::check(&sequence, &mut report);
    if let Some(planned) = planned {
        sequence.bulges = bulges(planned);
    }
    let (mut models, mut said) = each_stage(&sequence, reached.len(), files);
    if planned.is_none()
        && let Some(least) = least_bulges(&models)
    {
        sequence.bulges = least;
        (models, said) = each_stage(&sequence, 0, files);
    }
    if let Some(Model { loading, .. }) = models.first() {
        check_amplitude_ends(deck, &loading.amplitudes, sequence.end(), &mut report);
    }
    let mut problems = report.into_problems();
    problems.extend(stages::merge(said));
    if problems.iter().any(Diagnostic::is_error) {
        models.clear();
    }
    share_contact_laws(&mut models);
    share_interfaces(&mut models);
    (models, problems)
}

/// The models of all stages, or of the next one after `ended` stages, with the diagnostics of each.
fn each_stage(sequence: &StageSequence, ended: usize, files: Files) -> (Vec<Model>, Vec<(String, Vec<Diagnostic>)>) {
    let count = if ended == 0 { usize::MAX } else { 1 };
    let built = CurrentStage::all(sequence).skip(ended).take(count).map(|stage| {
        let (own, expected) = stage.deck();
        let mut report = Report::new(&own);
        let mut built = model(&own, Some(stage), files, &mut report);
        for expect in &mut built.expects {
            expect.index = expected.get(expect.index).copied().unwrap_or_default();
        }
        (built, (stage.name().to_owned(), merge_diagnostics(report.into_problems())))
    });
    built.unzip()
}

/// Gives a contact the same stiffness in all stages, the largest of them; otherwise bodies at rest on it would sink or rise between stages.
fn share_contact_laws(models: &mut [Model]) {
    let chosen = models.iter().flat_map(|model| model.each::<Contact>()).filter(|contact| contact.chosen.is_some());
    let mut laws: HashMap<String, (Option<ContactLaw>, Option<String>)> = HashMap::new();
    for contact in chosen {
        let stiffness = |law: &Option<ContactLaw>| law.as_ref().map_or(0.0, |law| law.stiffness);
        match laws.get(&contact.name) {
            Some((known, _)) if stiffness(known) >= stiffness(&contact.law) => {}
            _ => drop(laws.insert(contact.name.clone(), (contact.law, contact.chosen.clone()))),
        }
    }
    for contact in models.iter_mut().flat_map(|model| model.each_mut::<Contact>()) {
        if let Some(known) = laws.get(&contact.name) {
            (contact.law, contact.chosen) = known.clone();
        }
    }
}

/// The model the deck describes, with the mesh and the records it names, and everything there is to say about it. `None` if any of that is
/// an error.
fn build(deck: &Deck, files: Files) -> (Option<Model>, Vec<Diagnostic>) {
    let mut report = Report::new(deck);
    if !report.is_spoiled(&ROOT, "stages") {
        stages::check_names(deck, &mut report);
    }
    let model = model(deck, None, files, &mut report);
    let sound = !report.has_errors();
    if sound {
        check_loose(&model, &mut report);
        check_parts_at_rest(&model, &mut report);
    }
    (sound.then_some(model), merge_diagnostics(report.into_problems()))
}

fn model<'d>(deck: &'d Deck, stage: Option<CurrentStage<'d>>, files: Files<'d>, report: &mut Report<'d>) -> Model {
    let procedure = analysis(deck, stage, report);
    let amplitudes = amplitudes(deck, stage, files.records, report);
    let Ground { mut scene, nodes, amplitudes, groups, rigid } =
        ground(deck, (stage, procedure.analysis), (files, amplitudes), report);
    let (mut joined, efforts) = connect(&scene, nodes, amplitudes, report);
    let acting = act(&mut scene, &mut joined, efforts, report);
    let asked = ask(&scene, &procedure.scheme, acting.actors, &joined, report);
    check_scaled_loads(&scene, asked.arc_length.as_ref(), (&acting.loads.nodal, &joined.topology), report);
    let masses = match stage {
        Some(stage) => stage.sequence.masses(),
        None => element_masses(deck.integrator.as_ref()),
    };
    let masses = masses.unwrap_or(ElementMasses::OfSections);
    let mesh = check(&scene, (&procedure.scheme, masses), groups, &joined, report);
    let JoinedNodes { masses: point_masses, links, joints, amplitudes, mut topology } = joined;
    let contacts = acting.contacts;
    let linked = links.list.iter().map(|link| link.ends).chain(contacts.iter().flat_map(|contact| contact.pairs()));
    check_sound(&scene, &amplitudes, &topology, Ties::new(&topology, &joints, linked), report);
    place_nodes(&scene.names, &scene.parts, &mut topology);
    let (sets, sums) = named_reactions(&scene, &asked, &topology);
    let targets = std::mem::take(&mut topology.targets);
    let (nodes, dependents, restraints) = topology.into_parts();
    let mut analysis = Analysis { stage: asked.stage, ..scene.analysis };
    add_expected(&mut analysis, &asked.expects);
    let (analysis, iteration) = with_arc_length(deck, analysis, procedure.iteration, asked.arc_length);
    let links = links.list.into_iter().map(Part::from);
    let model = Model {
        title: deck.title.as_ref().map(|title| title.value.clone()).unwrap_or_default(),
        analysis,
        solution: Solution { scheme: procedure.scheme, choice: None, masses, iteration },
        nodes,
        bodies: scene.bodies,
        masses: point_masses,
        stiffnesses: scene.parts.stiffnesses,
        stresses: scene.parts.stresses,
        parts: scene.parts.list.into_iter().chain(links).chain(contacts.into_iter().map(Part::from)).collect(),
        reductions: Vec::new(),
        constraints: Constraints {
            turns: given_turns(&acting.turned, &restraints),
            dependents,
            joints,
            restraints,
            targets,
            ties: tie_names(deck),
            sets,
            sums,
        },
        loading: acting.fields.with(amplitudes, acting.loads),
        cases: asked.cases,
        damping: acting.damping,
        expects: asked.expects,
        origin: Origin { mesh, records: files.origins(), rigid, sections: scene.parts.sections },
        output: asked.selection.output,
        study: asked.study,
    };
    finish(model, asked.selection.all_nodes, deck, report)
}

/// The names of ties in their order; empty for one without a name.
fn tie_names(deck: &Deck) -> Vec<String> {
    deck.ties.iter().map(|tie| tie.name.as_ref().map_or_else(String::new, |at| at.value.clone())).collect()
}

/// The nodes with all that connects them.
struct JoinedNodes {
    masses: Vec<Mass>,
    links: ModelLinks,
    joints: Vec<Joint>,
    amplitudes: Vec<Amplitude>,
    topology: Topology,
}

/// Reads the tables that connect nodes, and the efforts of motors in joints.
fn connect<'d>(
    scene: &Scene<'d>,
    mut nodes: Nodes,
    mut amplitudes: Vec<Amplitude>,
    report: &mut Report<'d>,
) -> (JoinedNodes, Vec<Load>) {
    let masses = masses(scene, &mut nodes, report);
    let mut links = links(scene, &mut nodes, report);
    let Joints { list: mut joints, efforts } = joints(scene, &mut links, &mut amplitudes, &mut nodes, report);
    joints.extend(attachments(scene, &mut nodes, report));
    joints.extend(ties(scene, &mut nodes, report));
    joints.extend(scene.parts.releases.iter().map(released));
    connect_touching_points(scene, &mut nodes);
    (JoinedNodes { masses, links, joints, amplitudes, topology: Topology::new(nodes, report) }, efforts)
}

/// Loads, supports, contacts and damping of the model.
struct Acting<'d> {
    fields: AccelerationFields,
    actors: NamedActors<'d>,
    turned: Vec<TurnedNode>,
    contacts: Vec<Contact>,
    loads: Loads,
    damping: Damping,
}

/// Reads the tables that act on nodes. Contacts connect points on which loads may act.
fn act<'d>(scene: &mut Scene<'d>, joined: &mut JoinedNodes, efforts: Vec<Load>, report: &mut Report<'d>) -> Acting<'d> {
    let JoinedNodes { masses, links, joints, amplitudes, topology } = joined;
    let fields = environment(scene.deck, scene.stage, report);
    scene.analysis.plane &= !equations(scene, (topology, joints), report);
    let (mut actors, turned) = supports(scene, amplitudes, (topology, joints), report);
    temperatures(scene, amplitudes, topology, &mut actors, report);
    set_bulges(&mut scene.parts.list, topology, scene.stage.map_or(&[], |stage| &stage.sequence.bulges));
    let contacts = contacts(scene, masses, joints, gravity(scene.deck), topology, report);
    let efforts = [&efforts[..], &links.pulls[..]].concat();
    let mut loads = loads(scene, (efforts, &masses[..]), amplitudes, topology, &mut actors, report);
    let damping = damping(scene, topology, report);
    initial(scene, amplitudes, topology, report);
    loads.nodal.extend(unbalances(scene, amplitudes, topology, report));
    Acting { fields, actors, turned, contacts, loads, damping }
}

/// The requested computation and output.
struct Questions {
    stage: Option<RunStage>,
    arc_length: Option<ArcLength>,
    expects: Vec<Expect>,
    selection: Selection,
    study: Option<Study>,
    cases: LoadCases,
}

/// Reads the tables for computation and output.
fn ask<'d>(
    scene: &Scene<'d>,
    scheme: &Arc<dyn Scheme>,
    actors: NamedActors<'d>,
    joined: &JoinedNodes,
    report: &mut Report<'d>,
) -> Questions {
    let topology = &joined.topology;
    let cases = cases(scene, &actors, report);
    let stage = stops::stage(scene, actors, report);
    let arc_length = control(scene, &joined.amplitudes, topology, report);
    let expects = expects(scene, topology, arc_length.is_some(), &cases, report);
    let selection = output(scene, &topology.list, arc_length.is_some(), report);
    let study = study(scene, scheme, &topology.list, report);
    Questions { stage, arc_length, expects, selection, study, cases }
}

/// The sets of supported nodes by their labels, and the labels of nodes whose reactions are summed.
fn named_reactions(
    scene: &Scene,
    asked: &Questions,
    topology: &Topology,
) -> (HashMap<String, String>, Vec<HashSet<String>>) {
    let sets = supported_sets(&asked.selection, scene, &topology.list);
    (sets, summed_reactions(scene, &asked.expects, topology))
}

/// Checks a scene without errors for suspicious input.
fn check_sound(scene: &Scene, amplitudes: &[Amplitude], topology: &Topology, ties: Ties, report: &mut Report) {
    if report.has_errors() {
        return;
    }
    // A later stage may release the restraints of this one.
    if scene.stage.is_none() {
        check_all_held(scene.deck, topology, report);
    }
    // With several stages the amplitudes cover all of them.
    if scene.stage.is_none() && !scene.analysis.has_modes() {
        check_amplitude_ends(scene.deck, amplitudes, scene.analysis.end_time, report);
    }
    check_unjoined(scene, topology, ties, report);
    check_proportions(scene, topology, report);
}

/// The scene that all other tables refer to: nodes with names, bodies, and the deformable parts between them.
struct Ground<'d> {
    scene: Scene<'d>,
    nodes: Nodes,
    groups: Groups<'d>,
    rigid: Vec<Rigid>,
    amplitudes: Vec<Amplitude>,
}

fn ground<'d>(
    deck: &'d Deck,
    (stage, analysis): (Option<CurrentStage<'d>>, Analysis),
    (files, mut amplitudes): (Files<'d>, Vec<Amplitude>),
    report: &mut Report<'d>,
) -> Ground<'d> {
    let motion_curves = motion_curves(deck, stage, &analysis, &mut amplitudes, report);
    let mut nodes = Nodes::default();
    points(deck, &mut nodes);
    let bodies = bodies(deck, analysis.has_inertia(), &mut nodes, report);
    let mesh = MeshNodes::add(deck, files.input, &mut nodes, report);
    let names = Names::declare(deck, &bodies, mesh, report);
    let materials = materials(deck, analysis.has_inertia(), report);
    let mut context = PartContext {
        deck,
        names: &names,
        materials: &materials,
        sections: Sections::new(deck, &materials),
        station_files: files.stations,
        groups: Groups::new(mesh),
        nodes: &mut nodes,
        parts: Parts::default(),
        report: &mut *report,
    };
    context.parts.foresee(deck, context.report);
    beams(&mut context);
    bars(&mut context);
    shells(&mut context);
    superelements(files.matrices, &mut context);
    let PartContext { groups, mut parts, sections, .. } = context;
    (parts.stiffnesses, parts.stresses, parts.sections) = (sections.stiffnesses, sections.stresses, sections.facts);
    let (bodies, rigid) = rigid_bodies(deck, analysis.has_inertia(), bodies, &mut parts, &mut nodes, report);
    debug_assert!(bodies.is_sorted_by_key(|body| body.node), "`Body::at` searches in this order");
    let scene = Scene { deck, stage, analysis, names, bodies, parts, motion_curves };
    Ground { scene, nodes, groups, rigid, amplitudes }
}

/// Makes a node for each of `[points]`; they are the first nodes of all.
fn points(deck: &Deck, nodes: &mut Nodes) {
    for (name, x) in &deck.points.0 {
        nodes.add(name.value.clone(), true, vec3(x));
    }
}

/// Checks the whole for suspicious input; returns the record of the mesh.
fn check(
    scene: &Scene,
    (scheme, masses): (&Arc<dyn Scheme>, ElementMasses),
    groups: Groups,
    JoinedNodes { joints, amplitudes, topology, .. }: &JoinedNodes,
    report: &mut Report,
) -> Option<MeshFile> {
    let (deck, analysis, parts) = (scene.deck, &scene.analysis, &scene.parts);
    check_content(deck, report);
    // A part left out by an error may have been the only one to use it.
    if deck.spoiled.is_empty() && !report.has_errors() {
        check_use(scene.stage.map_or(deck, |stage| stage.sequence.whole), topology, report);
        check_joints(scene, joints, amplitudes, topology, report);
    }
    let mesh = groups.finish(deck, &scene.names, report);
    check_slivers(deck, parts, topology, report);
    check_chords(deck, parts, topology, report);
    check_harmonic(deck, scene.stage.map_or(deck, |stage| stage.sequence.whole), report);
    if analysis.has_modes() {
        check_modal(deck, report);
        note_tables_of_state(deck, report);
        if analysis.damps_modes() {
            refuse_power_dampers(deck, report);
        }
    } else if analysis.is_static() {
        check_static(deck, report);
    }
    if analysis.is_linear() {
        check_linear(deck, report);
    }
    check_explicit(deck, analysis, &**scheme, &parts.list, report);
    if analysis.is_dynamic() {
        check_mass_scaling(scene, masses, report);
    }
    check_units(deck, report);
    check_angles(deck, report);
    check_sudden_weight(deck, report);
    check_cyclic_hardening(deck, amplitudes, report);
    check_unseen_records(scene, &**scheme, amplitudes, report);
    check_upward(deck, report);
    mesh
}

/// Replaces the time steps by arc-length steps if the deck asks for them.
/// Tolerance of the iteration along paths of parts that yield. Fibres that begin to yield or unload from iteration to iteration leave residuals of
/// 1e-6 of the forces; a smaller tolerance cuts arcs until none yields anew in a step.
const TOLERANCE_OF_YIELDING_PATHS: f64 = 1e-5;

fn with_arc_length(
    deck: &Deck,
    analysis: Analysis,
    iteration: Iteration,
    arc_length: Option<ArcLength>,
) -> (Analysis, Iteration) {
    match arc_length {
        None => (analysis, iteration),
        Some(arc_length) => {
            let step_length = StepLength::ArcLength(arc_length);
            (Analysis { step_length, ..analysis }, path_iteration(deck, iteration))
        }
    }
}

/// Completes the model with data of the whole: the scheme of automatic steps, stable steps, unused nodes, and the list of nodes.
fn finish<'d>(mut model: Model, all_nodes: bool, deck: &'d Deck, report: &mut Report<'d>) -> Model {
    if deck.integrator.is_none() && matches!(model.analysis.step_length, StepLength::ErrorControlled { .. }) {
        model.solution.scheme = choose_scheme(&model);
        model.solution.choice = Some("chosen for automatic steps".to_owned());
    }
    if model.analysis.step_length.is_automatic() && matches!(model.solution.scheme.stepping(), Stepping::Verlet) {
        model.analysis.step_length = StepLength::StabilityLimited { fraction: model.stable_fraction() };
    }
    let has_tolerance = deck.iteration.as_ref().is_some_and(|iteration| iteration.tolerance.is_some());
    if model.analysis.step_length.is_arc_length() && model.yields() && !has_tolerance {
        model.solution.iteration.tolerance = TOLERANCE_OF_YIELDING_PATHS;
    }
    if model.analysis.has_modes() && model.analysis.stage.is_none() {
        hold_at_start(&mut model);
        // Times of a motion would cut load steps that lead to the state.
        model.output.cadence = Cadence::Steps(1);
        model.output.fields = model.output.fields.map(|files| FieldFiles { cadence: Cadence::Steps(1), ..files });
    }
    if model.analysis.is_linear() {
        make_elastic(&mut model);
    }
    drop_unused(&mut model);
    if !report.has_errors() {
        reductions(&mut model, deck, report);
    }
    if all_nodes {
        write_all_nodes(&mut model);
    }
    add_mass_nodes(&mut model, deck, report);
    if model.analysis.has_inertia() && !report.has_errors() {
        model.damping.frames = moving_frames(&model, deck, report);
    }
    model
}
