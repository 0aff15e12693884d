//! `[[bars]]`: paths → nodes and elements that resist stretching alone.

use super::beams::paths::{counts, path, segments};
use super::data::{Bar, MassKind, Part, PartIndex, PartKind};
use super::own_damping;
use super::part_context::PartContext;
use super::report::Owner;
use super::values::{chosen, flag, keys};
use deck::bars as words;
use mechanics::elements::heat::Heat;

/// Reads `[[bars]]`: makes the nodes of each path and the elements between them.
pub(super) fn bars(cx: &mut PartContext) {
    for (index, bar) in cx.deck.bars.iter().enumerate() {
        let (name, owner) = cx.report.named(("bar", "bars", index), bar.name.as_ref(), &bar.span);
        let at = PartIndex { kind: PartKind::Bar, index };
        cx.parts.begin(at);
        let made = read_bar(at, name, &owner, bar, cx);
        cx.parts.add(at, made.map(Part::from));
    }
}

/// Reads one bar as far as it can, so that all errors of the bar are found; `None` means there were some.
fn read_bar<'d>(
    at: PartIndex,
    name: String,
    owner: &Owner<'d>,
    bar: &'d words::Bar,
    cx: &mut PartContext<'_, 'd>,
) -> Option<Bar> {
    let mass = chosen(&bar.mass);
    let damping = own_damping::of_part(&bar.damping, cx.report);
    let stiffness = bar_stiffness(owner, bar, mass, cx);
    let path = path(owner, &bar.path, false, cx)?;
    let lengths = segments(owner, &bar.path.as_ref()?.values, &path, cx);
    let counts = match &bar.elements {
        Some(elements) => counts(elements, path.len() - 1, cx),
        None if cx.report.is_spoiled(owner.span, "elements") => None,
        None => Some(vec![1; path.len() - 1]),
    };
    let (counts, (axial_stiffness, mass_per_length)) = (counts?, stiffness?);
    lengths?;
    let whole: f64 = path.windows(2).map(|pair| (cx.nodes.x(pair[1]) - cx.nodes.x(pair[0])).norm()).sum();
    let free = cx.report.positive("free_length", &bar.free_length).map_or(1.0, |free| free / whole);
    let mut nodes = vec![path[0]];
    for (segment, &count) in counts.iter().enumerate() {
        let [x0, x1] = [cx.nodes.x(path[segment]), cx.nodes.x(path[segment + 1])];
        for i in 1..count {
            let x = x0 + (x1 - x0) * (i as f64 / count as f64);
            let node = cx.nodes.add(format!("{name}[{}]", nodes.len()), false, x);
            cx.nodes.connect(node, false);
            nodes.push(node);
        }
        nodes.push(path[segment + 1]);
    }
    let elements = nodes.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    cx.parts.entry_mut(at).nodes = nodes;
    let tension_only = flag(&bar.tension_only, false);
    let yielding = cx.materials.yielding_of(&bar.material, &owner.what, cx.report)?;
    Some(Bar {
        name,
        axial_stiffness,
        mass_per_length,
        mass,
        damping,
        tension_only,
        free,
        yielding,
        heat: Heat::NONE,
        elements,
    })
}

/// E A and mass per length.
fn bar_stiffness<'d>(
    owner: &Owner<'d>,
    bar: &'d words::Bar,
    mass: MassKind,
    cx: &mut PartContext<'_, 'd>,
) -> Option<(f64, f64)> {
    if bar.axial_stiffness.is_some() {
        let unused = keys!(bar; material, area);
        cx.report.reject_unused("a bar with `axial_stiffness`", &unused);
        let stiffness = cx.report.positive("axial_stiffness", &bar.axial_stiffness);
        if cx.materials.needs_mass(mass) {
            cx.report.require(owner, "mass_per_length", &bar.mass_per_length)?;
        }
        return Some((stiffness?, cx.report.not_negative("mass_per_length", &bar.mass_per_length, 0.0)));
    }
    if cx.report.is_spoiled(owner.span, "axial_stiffness") {
        return None;
    }
    cx.report.reject_unused("a bar with `material`", &keys!(bar; mass_per_length));
    if bar.material.is_none() && bar.area.is_none() && !cx.report.is_spoiled(owner.span, "material") {
        let message = format!("{} needs `material` and `area`, or `axial_stiffness`", owner.what);
        return cx.report.error(owner.span, message);
    }
    let material = cx.report.require(owner, "material", &bar.material);
    let area = cx.report.require_positive(owner, "area", &bar.area);
    let name = material?;
    let (_, material) = cx.materials.find(name, cx.report)?;
    let density = cx.materials.density(name, material, mass, &owner.what, cx.report)?;
    let modulus = material.youngs_modulus.as_ref()?.value;
    Some((modulus * area?, density * area?))
}
