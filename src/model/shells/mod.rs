//! `[[shells]]`: patches or groups of the mesh → nodes, normals and elements.

pub mod chords;
pub mod edges;
pub mod patch;
pub mod surface_map;

use crate::data::{MassKind, Part, PartIndex, PartKind, Shell, ShellElement};
use crate::mesh;
use crate::own_damping;
use crate::part_context::PartContext;
use crate::parts::MOST_IN_PATCH;
use crate::places::nodes::Nodes;
use crate::report::Owner;
use crate::shells::patch::{Edges, Patch};
use crate::shells::surface_map::Map;
use crate::values::{chosen, keys, span};
use base::diagnostic::At;
use base::math::{Vec3, curved_faces};
use deck::shells as words;
use deck::words::OneOrMany;
use mechanics::elements::heat::Heat;
use mechanics::elements::shell::{DRILLING, LayerModel, MOST_LAYERS, MOST_NODES, Plate};
use std::collections::{HashMap, HashSet};

/// Largest number of elements along an edge; more are taken for a typing error, and would exhaust memory.
const MOST_ELEMENTS: u64 = 10_000;
const DEFAULT_LAYERS: usize = 8;

/// Reads `[[shells]]`: divides each patch into elements, or uses those of a group of the mesh.
pub fn shells(cx: &mut PartContext) {
    let mut edges = Edges::default();
    for (index, shell) in cx.deck.shells.iter().enumerate() {
        let name = shell.name.as_ref().or(shell.group.as_ref());
        let (name, owner) = cx.report.named(("shell", "shells", index), name, &shell.span);
        let at = PartIndex { kind: PartKind::Shell, index };
        cx.parts.begin(at);
        let mut made = read_shell(at, name, &owner, shell, &mut edges, cx);
        set_thicknesses(made.iter_mut().flatten(), shell, cx);
        if let (Some(shells), Some(offset)) = (&mut made, shell.offset.as_ref().filter(|offset| offset.value != 0.0)) {
            set_beside(at, shells, offset, cx);
        }
        cx.parts.add(at, made.unwrap_or_default().into_iter().map(Part::from));
    }
}

/// Gives each element the mean thickness of its corners, where the deck gives some.
fn set_thicknesses<'d>(made: impl Iterator<Item = &'d mut Shell>, shell: &'d words::Shell, cx: &mut PartContext) {
    let mut given: HashMap<usize, f64> = HashMap::new();
    for (name, thickness) in &shell.nodal_thickness.0 {
        if thickness.value.is_nan() || thickness.value <= 0.0 {
            cx.report.error::<()>(&thickness.span, format!("the thickness at `{}` must be above zero", name.value));
        }
        let Some(place) = cx.names.find_nodes(name, cx.report) else { continue };
        given.extend(cx.names.nodes_of(place, &cx.parts).into_iter().map(|node| (node, thickness.value)));
    }
    if given.is_empty() {
        return;
    }
    let mut known = HashSet::new();
    for shell in made {
        let thickness = |node: &usize| given.get(node).copied().unwrap_or(shell.plate.thickness);
        let mean = |element: &ShellElement| {
            let corners = &element.nodes[..shell.corners];
            corners.iter().map(thickness).sum::<f64>() / shell.corners as f64
        };
        shell.thicknesses = shell.elements.iter().map(mean).collect();
        known.extend(shell.elements.iter().flat_map(|element| element.nodes));
    }
    for (name, _) in &shell.nodal_thickness.0 {
        let nodes = cx.names.place(name).map_or_else(Vec::new, |place| cx.names.nodes_of(place, &cx.parts));
        if !known.is_empty() && !nodes.is_empty() && !nodes.iter().any(|node| known.contains(node)) {
            let message = format!("`{}` has no node of this shell, so this thickness is of nothing", name.value);
            cx.report.error_with::<()>(&name.span, message, "name nodes of this shell, or remove the entry");
        }
    }
}

/// Puts elements at a distance from their nodes, on nodes that these carry by rigid arms.
fn set_beside(at: PartIndex, shells: &mut [Shell], offset: &At<f64>, cx: &mut PartContext) {
    if cx.deck.part(at).is_some_and(|part| part.is_rigid()) {
        let message = "`offset` does not apply to a rigid shell";
        cx.report.error_with::<()>(&offset.span, message, "remove it, and place the nodes on the mid-surface");
        return;
    }
    let mut made: HashMap<(usize, [u64; 3]), usize> = HashMap::new();
    let mut carried = HashMap::new();
    for shell in shells {
        let (name, size) = (shell.name.clone(), shell.size());
        for element in &mut shell.elements {
            for k in 0..size {
                let (node, normal) = (element.nodes[k], element.normals[k]);
                // Faces on either side of a fold have nodes of their own.
                let key = (node, <[f64; 3]>::from(normal).map(|part| u64::from((part as f32).to_bits())));
                element.nodes[k] = *made.entry(key).or_insert_with(|| {
                    let label = format!("{name}.{}", cx.nodes.label(node));
                    let x = cx.nodes.x(node) + offset.value * normal;
                    let beside = cx.nodes.add_dependent(label, x, node, &offset.span);
                    cx.nodes.connect(beside, true);
                    carried.insert(beside, node);
                    beside
                });
            }
            let last = element.nodes[size - 1];
            element.nodes[size..].fill(last);
        }
    }
    cx.parts.entry_mut(at).carried = carried;
}

/// Reads one shell as far as it can, so that all errors of the shell are found; `None` means there were some. A shell of triangles and
/// quadrilaterals becomes two.
fn read_shell<'d>(
    at: PartIndex,
    name: String,
    owner: &Owner<'d>,
    shell: &'d words::Shell,
    edges: &mut Edges,
    cx: &mut PartContext<'_, 'd>,
) -> Option<Vec<Shell>> {
    let part = empty(at, &name, owner, shell, cx);
    if let Some(group) = &shell.group {
        let unused = keys!(shell; corners, elements, kind, surface, order);
        cx.report.reject_unused("a shell made of a group of the mesh", &unused);
        return of_group(at, owner, group, part, cx);
    }
    if cx.report.is_spoiled(owner.span, "group") {
        return None;
    }
    let corners = corners(owner, shell, cx);
    let counts = cx.report.require(owner, "elements", &shell.elements).and_then(|counts| read_counts(counts, cx));
    let order = cx.report.count("order", &shell.order, 1);
    if let Some(at) = shell.order.as_ref().filter(|_| !(1..=2).contains(&order)) {
        cx.report.error::<()>(&at.span, "`order` of a shell can be 1 or 2");
    }
    let corners = corners?;
    let triangles = match &shell.kind {
        Some(at) if at.value == words::ElementKind::Quadrilateral && corners.len() == 3 => {
            return cx.report.error_with(&at.span, "a patch of three corners is made of triangles", "remove `kind`");
        }
        Some(at) => at.value == words::ElementKind::Triangle,
        None => corners.len() == 3,
    };
    let map = Map::read(owner, &shell.surface, &corners, cx.nodes, cx.report)?;
    let counts = counts?;
    if corners.len() == 3 && counts[0] != counts[1] {
        let place = span(&shell.elements).unwrap_or(owner.span);
        let message = "a patch of three corners needs the same number of elements along each edge: give one number";
        return cx.report.error(place, message);
    }
    let part = part?;
    // Patches that share its edges would only repeat the error.
    let order = if order == 2 { 2 } else { 1 };
    let counts = counts.map(|count| order * count);
    let patch = Patch { name: &name, owner, map, corners, counts, order, made: 0 };
    let elements = of_patch(at, patch, triangles, edges, cx)?;
    Some(vec![Shell { corners: if triangles { 3 } else { 4 }, order, elements, ..part }])
}

/// The shell without elements.
fn empty<'d>(
    at: PartIndex,
    name: &str,
    owner: &Owner<'d>,
    shell: &'d words::Shell,
    cx: &mut PartContext<'_, 'd>,
) -> Option<Shell> {
    let mass = chosen(&shell.mass);
    let damping = own_damping::of_part(&shell.damping, cx.report);
    let (plate, density, yielding, axis) = plate(owner, shell, mass, cx)?;
    cx.parts.entry_mut(at).contact_radius = 0.5 * plate.thickness;
    let (elements, numbers, thicknesses) = (Vec::new(), Vec::new(), Vec::new());
    let name = name.to_owned();
    Some(Shell {
        heat: Heat::NONE,
        name,
        plate,
        density,
        mass,
        damping,
        yielding,
        axis,
        corners: 0,
        order: 1,
        elements,
        numbers,
        thicknesses,
    })
}

/// The elements of a patch; its nodes are noted in its entry.
fn of_patch<'d>(
    at: PartIndex,
    mut patch: Patch<'_, 'd>,
    triangles: bool,
    edges: &mut Edges,
    cx: &mut PartContext<'_, 'd>,
) -> Option<Vec<ShellElement>> {
    let mut grid = patch.grid(cx.report)?;
    let sound = patch.make_nodes(&mut grid, edges, cx.nodes, cx.report);
    let entry = cx.parts.entry_mut(at);
    entry.edges = std::mem::take(&mut grid.edges);
    sound?;
    entry.nodes = grid.nodes.iter().copied().flatten().collect();
    let elements = patch.elements(&grid, triangles);
    let corners = if triangles { 3 } else { 4 };
    if elements.iter().any(|element| folds(element, corners, cx.nodes)) {
        let message = format!("{} folds back on itself", patch.owner.what);
        let hint = "list the corners in order round the patch, at different places";
        return cx.report.error_with(patch.owner.span, message, hint);
    }
    Some(elements)
}

/// The faces of a group, each shape apart, in copies of a shell without elements.
fn of_group<'d>(
    at: PartIndex,
    owner: &Owner<'d>,
    name: &'d At<String>,
    shell: Option<Shell>,
    cx: &mut PartContext<'_, 'd>,
) -> Option<Vec<Shell>> {
    let faces = cx.groups.take(&owner.what, name, true, cx.report)?;
    let first = cx.groups.mesh.first;
    let (own, local) = cx.groups.own_nodes(&faces)?;
    for &node in &own {
        cx.nodes.connect(first + node as usize, true);
        cx.parts.entry_mut(at).nodes.push(first + node as usize);
    }
    let shell = shell?;
    let mesh = &cx.groups.mesh.input?.mesh;
    let x: Vec<Vec3> = own.iter().map(|&node| mesh.nodes[node as usize].x).collect();
    let sizes = faces.iter().map(|face| face.nodes().len());
    let all = local.iter().zip(sizes).map(|(nodes, size)| &nodes[..size]);
    let (shells, against) = if faces.iter().all(|face| face.kind.order() == 1) {
        let (normals, against) = mesh::normals::<4>(&x, all);
        (of_faces(&faces, &normals, &shell, first), against)
    } else {
        let apart = edges_of_two_orders(&faces);
        if apart > 0 {
            cx.report.lose_connections();
            let message = format!("{} has elements of order 1 beside those of order 2: at {apart} edges", owner.what);
            return cx.report.error_with(&name.span, message, "mesh it with elements of one order");
        }
        let (normals, against) = mesh::normals::<MOST_NODES>(&x, all);
        let mut shells = of_faces(&faces, &normals, &shell, first);
        add_middles(at, &mut shells, &faces, cx);
        (shells, against)
    };
    if against > 0 {
        let message = format!("neighbouring elements of {} have opposite normals: at {against} edges", owner.what);
        cx.report.warn(
            &name.span,
            message,
            "reverse the order of nodes of one side in the mesh; pressure acts against the normal of each element",
        );
    }
    Some(shells)
}

/// The number of edges between faces with straight sides and faces with sides of second degree.
fn edges_of_two_orders(faces: &[&mesh::MeshElement]) -> usize {
    let edges = |order: usize| {
        let of = faces.iter().filter(move |face| face.kind.order() == order);
        of.flat_map(|face| {
            let (nodes, n) = (face.nodes(), face.kind.corners());
            (0..n).map(move |k| {
                let (a, b) = (nodes[k], nodes[(k + 1) % n]);
                [a.min(b), a.max(b)]
            })
        })
    };
    let straight: HashSet<[u32; 2]> = edges(1).collect();
    edges(2).filter(|edge| straight.contains(edge)).count()
}

/// The faces of a group by their shapes, in copies of a shell without elements. The middles of those of eight nodes are still missing.
fn of_faces<const N: usize>(
    faces: &[&mesh::MeshElement],
    normals: &[[Vec3; N]],
    shell: &Shell,
    first: usize,
) -> Vec<Shell> {
    let mut shells = Vec::new();
    for (corners, order) in [(4, 1), (3, 1), (4, 2), (3, 2)] {
        let of = |(number, (face, normals)): (usize, (&&mesh::MeshElement, &[Vec3; N]))| {
            let element = || {
                let nodes: Vec<usize> = face.nodes().iter().map(|&node| first + node as usize).collect();
                let size = if nodes.len() == 8 { MOST_NODES } else { nodes.len() };
                ShellElement::new(&nodes, &normals[..size])
            };
            ((face.kind.corners(), face.kind.order()) == (corners, order)).then(|| (number as u32, element()))
        };
        let of = faces.iter().zip(normals).enumerate().filter_map(of);
        let (numbers, elements): (Vec<u32>, Vec<ShellElement>) = of.unzip();
        if !elements.is_empty() {
            let numbers = if elements.len() < faces.len() { numbers } else { Vec::new() };
            shells.push(Shell { corners, order, elements, numbers, ..shell.clone() });
        }
    }
    shells
}

/// Gives elements of eight nodes one in the middle, by their shape functions.
fn add_middles(at: PartIndex, shells: &mut [Shell], faces: &[&mesh::MeshElement], cx: &mut PartContext) {
    for shell in shells.iter_mut().filter(|shell| shell.size() == MOST_NODES) {
        for number in 0..shell.elements.len() {
            let face = faces[shell.number(number)];
            let element = &mut shell.elements[number];
            if face.nodes().len() == 8 {
                let x = curved_faces::middle_of_eight(|a| cx.nodes.x(element.nodes[a]));
                let node = cx.nodes.add(format!("{}[{}]", shell.name, face.id), false, x);
                cx.nodes.connect(node, true);
                cx.parts.entry_mut(at).nodes.push(node);
                element.nodes[8] = node;
            }
        }
    }
}

/// True for an element that is not seen the same way round from each of its corners.
fn folds(element: &ShellElement, corners: usize, nodes: &Nodes) -> bool {
    let x = |k: usize| nodes.x(element.nodes[k % corners]);
    (0..corners).any(|k| {
        let normal = (x(k + 1) - x(k)).cross(&(x(k + corners - 1) - x(k)));
        normal.dot(&element.normals[k]) <= 0.0 || element.normals[k].dot(&element.normals[0]) <= 0.0
    })
}

/// Reads the properties of a shell: plate, density, yield model, and axis 1 of its results.
fn plate<'d>(
    owner: &Owner<'d>,
    shell: &'d words::Shell,
    mass: MassKind,
    cx: &mut PartContext<'_, 'd>,
) -> Option<(Plate, f64, Option<LayerModel>, Vec3)> {
    let thickness = cx.report.require_positive(owner, "thickness", &shell.thickness);
    let name = cx.report.require(owner, "material", &shell.material)?;
    let (_, material) = cx.materials.find(name, cx.report)?;
    let density = cx.materials.density(name, material, mass, &owner.what, cx.report);
    let what = format!("material `{}`, of which {} is made,", name.value, owner.what);
    let nu = cx.report.require(&Owner::new(what, &material.span), "poisson_ratio", &material.poisson_ratio);
    let yielding = layers(owner, shell, cx);
    let axis = shell.axis.as_ref().map_or(Some(Vec3::x()), |axis| cx.report.unit("axis", axis));
    let E = material.youngs_modulus.as_ref()?.value;
    let plate = Plate { thickness: thickness?, E, nu: nu?.value, drilling: DRILLING };
    Some((plate, density?, yielding?, axis?))
}

/// Finds the nodes of three or four corners and connects them.
fn corners<'d>(owner: &Owner<'d>, shell: &'d words::Shell, cx: &mut PartContext<'_, 'd>) -> Option<Vec<usize>> {
    let corners = cx.report.require_nodes(owner, "corners", &shell.corners)?;
    if !(3..=4).contains(&corners.values.len()) {
        cx.report.lose_connections();
        cx.report.error_with::<()>(
            &corners.span,
            "a patch has three or four corners",
            "such as [\"a\", \"b\", \"c\", \"d\"]",
        );
    }
    let nodes: Vec<Option<usize>> =
        corners.values.iter().map(|point| cx.names.point("corners", point, &cx.parts, cx.report)).collect();
    // They are connected even if the rest of the shell has errors.
    nodes.iter().flatten().for_each(|&node| cx.nodes.connect(node, true));
    nodes.into_iter().collect::<Option<Vec<usize>>>().filter(|nodes| (3..=4).contains(&nodes.len()))
}

fn read_counts<'d>(counts: &At<OneOrMany<u64>>, cx: &mut PartContext<'_, 'd>) -> Option<[usize; 2]> {
    let values = &counts.values;
    if values.is_empty() || values.len() > 2 {
        return cx.report.error_with(
            &counts.span,
            "`elements` must be one or two numbers here",
            "along edge1 and along edge2",
        );
    }
    for count in values {
        if count.value == 0 || count.value > MOST_ELEMENTS {
            return cx.report.error(&count.span, format!("`elements` must lie between 1 and {MOST_ELEMENTS}"));
        }
    }
    let [n, m] = [values.first()?.value as usize, values.last()?.value as usize];
    if n * m > MOST_IN_PATCH {
        let message = format!("{n} x {m} elements: at most {MOST_IN_PATCH} are allowed in a patch");
        return cx.report.error(&counts.span, message);
    }
    cx.parts.require_room()?;
    Some([n, m])
}

/// Reads the yield model of the shell: `Some(None)` for elastic material, `None` after errors.
fn layers<'d>(owner: &Owner<'d>, shell: &'d words::Shell, cx: &mut PartContext<'_, 'd>) -> Option<Option<LayerModel>> {
    // Errors of the material have been reported.
    let Some(law) = cx.materials.yielding_of(&shell.material, &owner.what, cx.report)? else {
        cx.report.reject_unused(&format!("{}, whose material is elastic", owner.what), &keys!(shell; layers, strain));
        return Some(None);
    };
    let layers = cx.report.count("layers", &shell.layers, DEFAULT_LAYERS);
    let logarithmic = shell.strain.as_ref().is_some_and(|at| at.value == words::StrainMeasure::Logarithmic);
    match &shell.layers {
        Some(at) if !(2..=MOST_LAYERS).contains(&layers) => {
            cx.report.error(&at.span, format!("`layers` must lie between 2 and {MOST_LAYERS}"))
        }
        Some(at) if layers > 10 && layers % 2 == 1 => {
            let message = format!("`layers` is {layers}, but above 10 it must be even: those points lie in pairs");
            cx.report.error_with(&at.span, message, format!("take {}", layers + 1))
        }
        _ => Some(Some(LayerModel { law, layers, logarithmic })),
    }
}
