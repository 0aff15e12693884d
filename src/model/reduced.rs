//! `reduced` of beams and shells, one by one or as `[[parts]]`: their interface with the rest of the scene, and the scenes that are refused.
//!
//! Points of the deck belong to the interface. So do nodes of other parts, bodies, joints, supports, point loads, dampers and stops. Spread loads
//! and weight act on inner nodes by the shapes. Outputs and expected values follow from these as well.

mod connected;

use super::data::{AnalysisKind, Beam, EQUAL_MODES, LoadOrigin, Model, Node, OwnDamping, Part, PartType, Reduction};
use super::plausibility::unused::visit_actors;
use super::report::Report;
use base::diagnostic::{At, Span};
use base::math::{Mat3, Vec3};
use deck::Deck;
use deck::part_table::{MassKind, ReducedTable};
use deck::parts::{DeckPart, PartKind};
use deck::words::{NumberOrTable, Table};
use mechanics::elements::superelement::RIGID_LOADS;
use std::collections::BTreeSet;
use std::ops::Range;

/// Modes where the deck gives a frequency alone.
const MODES: usize = 20;
/// Most modes of a part: their matrices are full.
const MOST: usize = 500;

/// Parts of the deck that are reduced together, one or several.
struct Asked<'d> {
    /// The deck's name.
    name: String,
    /// In words, like "shell `roof`".
    title: String,
    parts: Vec<DeckPart<'d>>,
    extent: &'d At<NumberOrTable<Table<ReducedTable>>>,
}

/// Lists the reduced parts of a model, with a node for each amplitude.
pub(super) fn reductions<'d>(model: &mut Model, deck: &'d Deck, report: &mut Report<'d>) {
    let of_part = |part: DeckPart<'d>| {
        let extent = part.table.reduced()?;
        Some(Asked { name: part.label(), title: part.title(), parts: vec![part], extent })
    };
    let mut asked: Vec<Asked> = deck.parts().filter_map(of_part).collect();
    for index in 0..deck.part_sets.len() {
        if let Some(set) = part_set(deck, index, &asked, report) {
            asked.push(set);
        }
    }
    if asked.is_empty() {
        return;
    }
    let acting = acting_nodes(model);
    for asked in asked {
        let made = reductions_of(model, &asked, &acting, report);
        model.reductions.extend(made.into_iter().flatten());
    }
}

/// The parts of an entry of `[[parts]]`; `others` are reduced already.
fn part_set<'d>(deck: &'d Deck, index: usize, others: &[Asked], report: &mut Report<'d>) -> Option<Asked<'d>> {
    let table = &deck.part_sets[index];
    let (name, owner) = report.named(("parts", "parts", index), table.name.as_ref(), &table.span);
    let (list, extent) =
        (report.require(&owner, "parts", &table.parts), report.require(&owner, "reduced", &table.reduced));
    let (list, extent) = (list?, extent?);
    let mut parts: Vec<DeckPart> = Vec::new();
    for member in &list.values {
        for name in deck.members(member) {
            let part = member_part(deck, name, report)?;
            let is_other = |other: &DeckPart| other.at == part.at;
            if parts.iter().chain(others.iter().flat_map(|other| &other.parts)).any(is_other) {
                let message = format!("{} is reduced twice", part.title());
                let hint = "name it in one of `[[parts]]`, once, and leave `reduced` out of the part itself";
                return report.error_with(&name.span, message, hint);
            }
            parts.push(part);
        }
    }
    if parts.is_empty() {
        return report.error_with(&list.span, format!("{} has no parts", owner.what), "name beams or shells");
    }
    let title = format!("parts `{name}`");
    Some(Asked { name: name.to_string(), title, parts, extent })
}

/// A beam or shell by its name.
fn member_part<'d>(deck: &'d Deck, name: &At<String>, report: &mut Report<'d>) -> Option<DeckPart<'d>> {
    let parts = || deck.parts().filter(|part| part.at.kind.has_sections() || part.at.kind.is_surface());
    if let Some(part) = parts().find(|part| part.is_named(name)) {
        return Some(part);
    }
    let known: Vec<&str> = parts().filter_map(|part| part.name()).map(|name| name.as_str()).collect();
    report.unknown("beam or shell", name, known.into_iter())
}

/// The points of the deck, and the nodes of bodies, constraints, point loads, dampers and stops.
fn acting_nodes(model: &mut Model) -> BTreeSet<usize> {
    let mut nodes = BTreeSet::new();
    visit_actors(model, &mut |node| {
        nodes.insert(*node);
    });
    // Users look at the points of the deck.
    nodes.extend((0..model.nodes.len()).filter(|&node| model.nodes[node].named));
    let constraints = &model.constraints;
    nodes.extend(constraints.dependents.iter().flat_map(|dependent| [dependent.node, dependent.master]));
    let spread = |origin: &Option<LoadOrigin>| matches!(origin, Some(LoadOrigin::Element(..) | LoadOrigin::Spread));
    nodes
        .extend(model.loading.nodal.iter().filter(|load| load.follower || !spread(&load.origin)).map(|load| load.node));
    nodes
}

/// The reductions of parts of the deck: one, or one for each piece of a beam.
fn reductions_of(
    model: &mut Model,
    of: &Asked,
    acting: &BTreeSet<usize>,
    report: &mut Report,
) -> Option<Vec<Reduction>> {
    let extent = Extent::new(of.extent, report)?;
    let mut parts: Vec<usize> = Vec::new();
    for part in &of.parts {
        let is_own = |other: &Part| other.kind() == part.at.kind && other.name() == part.label();
        let own: Vec<usize> = (0..model.parts.len()).filter(|&index| is_own(&model.parts[index])).collect();
        refuse(model, part, &own, &of.extent.span, report)?;
        parts.extend(own);
    }
    parts.sort_unstable();
    refuse_apart(model, of, &parts, report)?;
    let pieces = pieces(model, of, (&parts, extent.pieces), report)?;
    pieces.into_iter().map(|piece| reduction(model, of, (&extent, piece), acting, report)).collect()
}

/// Whole parts, or pieces of a beam.
fn pieces(model: &Model, of: &Asked, (parts, count): (&[usize], usize), report: &mut Report) -> Option<Vec<Reduction>> {
    let piece = |elements: Option<Range<usize>>| Reduction {
        name: of.name.clone(),
        title: of.title.clone(),
        parts: parts.to_vec(),
        elements,
        interface: Vec::new(),
        carried: Vec::new(),
        inner: Vec::new(),
        amplitudes: Vec::new(),
        modes: 0,
        up_to: None,
        geometric: true,
        damping: OwnDamping::default(),
        place: [of.extent.span.start, of.extent.span.end],
        made: None,
    };
    if count == 1 {
        return Some(vec![piece(None)]);
    }
    let is_path = matches!(&of.parts[..], [part] if part.at.kind == PartKind::Beam && part.table.group().is_none());
    let all = parts.iter().map(|&part| model.parts[part].elements()).sum::<usize>();
    let (message, hint) = match is_path {
        false => (
            format!("{} cannot be cut into `pieces`", of.title),
            "`pieces` divide a beam along a `path`. Leave `pieces` out, or give each part a `reduced` of its own",
        ),
        true if count > all => (
            format!("{} has {all} elements, and {count} pieces need one each at least", of.title),
            "give it more `elements`, or fewer `pieces`",
        ),
        true => {
            let of_piece = |k: usize| piece(Some(k * all / count..(k + 1) * all / count));
            return Some((0..count).map(of_piece).collect());
        }
    };
    report.error_with(&of.extent.span, message, hint)
}

/// Completes a reduction by its nodes.
fn reduction(
    model: &mut Model,
    of: &Asked,
    (extent, piece): (&Extent, Reduction),
    acting: &BTreeSet<usize>,
    report: &mut Report,
) -> Option<Reduction> {
    let asked = of.extent;
    let nodes_of = |part: &Part| -> Vec<usize> {
        (0..part.elements()).flat_map(|element| part.nodes(element).to_vec()).chain(part.touched_nodes()).collect()
    };
    let own = piece.own_parts(&model.parts);
    let nodes: BTreeSet<usize> = own.iter().flat_map(nodes_of).collect();
    let others = (0..model.parts.len()).filter(|index| !piece.parts.contains(index));
    let mut shared: BTreeSet<usize> = others.flat_map(|index| nodes_of(&model.parts[index])).collect();
    if let Some(elements) = &piece.elements {
        let beam = &model.parts[piece.parts[0]];
        let other = (0..beam.elements()).filter(|element| !elements.contains(element));
        shared.extend(other.flat_map(|element| beam.nodes(element).to_vec()));
    }
    let is_interface = |node: &&usize| acting.contains(node) || shared.contains(node);
    let mut interface: Vec<usize> = nodes.iter().filter(is_interface).copied().collect();
    if interface.is_empty() {
        interface.extend(middle_node(model, &nodes));
    }
    // Stages of other interfaces have as many amplitudes; those beyond the modes are left out with the matrices.
    let most = 6 * nodes.len();
    let inner: Vec<usize> = nodes.into_iter().filter(|node| interface.binary_search(node).is_err()).collect();
    if inner.is_empty() && piece.elements.is_some() {
        let message = format!("a piece of {} has no nodes inside", piece.title);
        return report.error_with(&asked.span, message, "give fewer `pieces`, or the beam more `elements`");
    }
    if inner.is_empty() {
        let title = &piece.title;
        let message = format!(
            "`reduced` leaves nothing out of {title}: supports, links, loads or other parts act on each of its nodes"
        );
        return report.error_with(&asked.span, message, "give it more `elements`, or leave `reduced` out");
    }
    let damping = one_damping(model, of, (&piece.parts, &inner), report)?;
    let label = match &piece.elements {
        Some(elements) => format!("{}, elements {} to {}", of.name, elements.start + 1, elements.end),
        None => of.name.clone(),
    };
    let amplitudes = amplitudes(model, &label, interface[0], (extent.modes + EQUAL_MODES + RIGID_LOADS).min(most));
    let Extent { modes, up_to, geometric, .. } = *extent;
    let (interface, carried) = carried_by_bodies(model, interface);
    Some(Reduction {
        interface,
        carried,
        inner,
        amplitudes,
        modes: modes.min(most),
        up_to,
        geometric,
        damping,
        ..piece
    })
}

/// The node nearest to the middle of a free part, with which its frame moves.
fn middle_node(model: &Model, nodes: &BTreeSet<usize>) -> Option<usize> {
    let x = |node: &usize| model.nodes[*node].x;
    let middle = nodes.iter().map(x).sum::<Vec3>() / nodes.len() as f64;
    let away = |node: &usize| (x(node) - middle).norm();
    nodes.iter().copied().min_by(|a, b| away(a).total_cmp(&away(b)))
}

/// Puts the node of a body in place of nodes of the interface that are rigidly attached to it, two or more. Returns the interface, and these nodes
/// with the places of the bodies' nodes in it. Stages may attach other nodes, so their interfaces stay.
fn carried_by_bodies(model: &Model, interface: Vec<usize>) -> (Vec<usize>, Vec<(usize, usize)>) {
    if model.analysis.stage.is_some() {
        return (interface, Vec::new());
    }
    let dependents = &model.constraints.dependents;
    let is_attached = |node: usize| dependents.iter().any(|other| other.node == node);
    let master = |node: &usize| {
        let own = dependents.iter().find(|dependent| dependent.node == *node && dependent.dofs == [true; 6])?;
        (!is_attached(own.master) && !interface.contains(&own.master)).then_some(own.master)
    };
    let masters: Vec<Option<usize>> = interface.iter().map(master).collect();
    let is_shared = |of: usize| masters.iter().filter(|other| **other == Some(of)).count() > 1;
    let masters: Vec<Option<usize>> = masters.iter().map(|of| of.filter(|of| is_shared(*of))).collect();
    let kept: BTreeSet<usize> = interface.iter().zip(&masters).map(|(node, of)| of.unwrap_or(*node)).collect();
    let kept: Vec<usize> = kept.into_iter().collect();
    let place = |of: usize| kept.partition_point(|node| *node < of);
    let carried = interface.iter().zip(&masters).filter_map(|(node, of)| Some((*node, place((*of)?)))).collect();
    (kept, carried)
}

/// Refuses parts that no elements join: they have one frame.
fn refuse_apart(model: &Model, of: &Asked, parts: &[usize], report: &mut Report) -> Option<()> {
    let (asked, title) = (of.extent, &of.title);
    if let Some([a, b]) = connected::apart(model, parts) {
        let [a, b] = [a, b].map(|node| &model.nodes[node].label);
        let message = format!(
            "{title} is in several pieces: no element leads from `{a}` to `{b}`, and its shapes have one frame"
        );
        return report.error_with(
            &asked.span,
            message,
            "reduce them one by one: give each piece a `reduced` of its own",
        );
    }
    Some(())
}

/// The damping of the parts, which have one; a pressure that turns with them is refused.
fn one_damping(
    model: &Model,
    of: &Asked,
    (parts, inner): (&[usize], &[usize]),
    report: &mut Report,
) -> Option<OwnDamping> {
    let (asked, title) = (of.extent, &of.title);
    if inner
        .iter()
        .any(|node| model.loading.pressures.iter().flat_map(|load| &load.faces).any(|face| face.nodes().contains(node)))
    {
        let message = format!("a pressure turns with the surface of {title}, and its reduced shapes do not");
        return report.error_with(
            &asked.span,
            message,
            "leave `follower` out of the load, or `reduced` out of the part",
        );
    }
    let damping = model.parts[*parts.first()?].own_damping();
    if parts.iter().any(|&part| model.parts[part].own_damping() != damping) {
        let message = format!("{title} have different `damping`, and their shapes have one");
        return report.error_with(&asked.span, message, "give them one `damping`, or reduce them one by one");
    }
    Some(damping)
}

/// The modes and the form of a reduced part in the deck.
struct Extent {
    modes: usize,
    /// The highest frequency.
    up_to: Option<f64>,
    /// Pieces of a beam.
    pieces: usize,
    /// True with terms of second order.
    geometric: bool,
}

impl Extent {
    fn new(asked: &At<NumberOrTable<Table<ReducedTable>>>, report: &mut Report) -> Option<Extent> {
        let mut of = Extent { modes: MODES, up_to: None, pieces: 1, geometric: true };
        let mut modes = MODES as f64;
        match &asked.value {
            NumberOrTable::Number(number) => modes = *number,
            NumberOrTable::Table(table) => {
                of.up_to = report.positive("up_to", &table.up_to);
                let has_numbers = table.modes.is_some() || table.up_to.is_some() || table.pieces.is_some();
                let is_empty = !has_numbers && table.geometric_stiffness.is_none();
                if is_empty && !report.is_any_spoiled(&asked.span) {
                    let hint = "give it `modes`, such as { modes = 20 }, `up_to` or `pieces`";
                    return report.error_with(&asked.span, "`reduced` asks for nothing", hint);
                }
                modes = table.modes.as_ref().map_or(modes, |modes| modes.value as f64);
                of.geometric = table.geometric_stiffness.as_ref().is_none_or(|asked| asked.value);
                if let Some(pieces) = &table.pieces {
                    of.pieces = pieces.value as usize;
                    if of.pieces == 0 {
                        return report.error_with(&pieces.span, "`pieces` is 0", "give 1 or more");
                    }
                }
            }
        }
        if modes < 0.0 || modes.fract() != 0.0 || modes > MOST as f64 {
            let message = format!("`reduced` needs a whole number of modes from 0 to {MOST}");
            let hint = "20 suffice for most parts; 0 keeps the static shapes alone";
            return report.error_with(&asked.span, message, hint);
        }
        Some(Extent { modes: modes as usize, ..of })
    }
}

/// Refuses what shapes of small displacements do not have.
fn refuse(model: &Model, part: &DeckPart, parts: &[usize], place: &Span, report: &mut Report) -> Option<()> {
    let title = part.title();
    let own = || parts.iter().map(|&index| &model.parts[index]);
    let is_turning = || model.loading.centrifugal.iter().any(|load| load.of.parts.iter().any(|of| parts.contains(of)));
    let faults: [(bool, String, &str); 7] = [
        (
            part.is_rigid(),
            format!("{title} is `rigid` and `reduced`"),
            "keep one of the two: `rigid` has no deformation, `reduced` a few shapes of it",
        ),
        (
            own().any(|part| part.yields()),
            format!("the material of {title} yields, and reduced shapes are elastic"),
            "give it a material without `yield_stress`, or leave `reduced` out",
        ),
        (
            own().filter_map(|part| part.heat()).any(|heat| heat.numbers.iter().any(Option::is_some)),
            format!("{title} is heated, and reduced shapes have no temperature"),
            "leave `reduced` out, or the `temperature`",
        ),
        (
            own().any(|part| part.mass_kind() == Some(MassKind::FreeNodes)),
            format!("`mass = \"free-nodes\"` does not apply to {title}, which is reduced"),
            "give `mass` = \"lumped\" or \"consistent\"",
        ),
        (
            own().filter_map(Beam::of).any(|beam| has_mass_beside_the_axis(model, beam)),
            format!("the mass of {title} lies beside its nodes, and reduced shapes have none there"),
            "leave `reduced` out, or the section's `offset`, and put the centre of its mass on the axis",
        ),
        (
            model.analysis.kind != AnalysisKind::Static && is_turning(),
            format!("a centrifugal load acts on {title}, which is reduced, in statics alone"),
            "leave `reduced` out: its modes would lack the stiffness of the load",
        ),
        (
            model.analysis.is_dynamic() && model.solution.scheme.is_explicit(),
            format!("explicit schemes do not take {title}, which is reduced: its masses are coupled"),
            "give an implicit scheme, such as `scheme` = \"generalized-alpha\"",
        ),
    ];
    if let Some((_, message, hint)) = faults.into_iter().find(|(is_so, ..)| *is_so) {
        return report.error_with(place, message, hint);
    }
    // A part with errors has no elements.
    (!parts.is_empty()).then_some(())
}

/// True where a section of a beam has its mass beside the axis.
fn has_mass_beside_the_axis(model: &Model, beam: &Beam) -> bool {
    let is_beside = |section: usize| model.stiffnesses[section].mass_arm(&Mat3::identity()).is_some();
    beam.mass != MassKind::None && beam.sections().any(is_beside)
}

/// A node for each amplitude.
fn amplitudes(model: &mut Model, of: &str, near: usize, modes: usize) -> Vec<usize> {
    let x = model.nodes[near].x;
    let first = model.nodes.len();
    model.nodes.extend((1..=modes).map(|mode| {
        let label = format!("{of}, mode {mode}");
        let (v, omega) = Default::default();
        Node { label, named: false, is_number: true, x, v, omega, given: [None, None], place: None }
    }));
    (first..model.nodes.len()).collect()
}

/// Gives reduced parts the same interface in all stages: whatever any of them needs.
pub(super) fn share_interfaces(models: &mut [Model]) {
    let mut shared: Vec<BTreeSet<usize>> = Vec::new();
    for reduction in models.iter().flat_map(|model| model.reductions.iter().enumerate()) {
        let (index, of) = reduction;
        if shared.len() <= index {
            shared.push(BTreeSet::new());
        }
        shared[index].extend(&of.interface);
    }
    for (index, reduction) in models.iter_mut().flat_map(|model| model.reductions.iter_mut().enumerate()) {
        let moved: Vec<usize> = reduction.inner.iter().copied().filter(|node| shared[index].contains(node)).collect();
        reduction.inner.retain(|node| !moved.contains(node));
        reduction.interface.extend(moved);
        reduction.interface.sort_unstable();
    }
}
