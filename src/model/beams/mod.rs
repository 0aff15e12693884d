//! `[[beams]]`: paths or groups of the mesh → nodes and elements.

pub mod grading;
pub mod mass_nodes;
pub mod paths;
mod released;
mod softening;
pub mod station_file;
mod stations;

use crate::beams::grading::{cuts, gradings};
use crate::beams::paths::{counts, path, segments};
use crate::data::{Beam, BeamElement, Part, PartIndex, PartKind};
use crate::mesh::MeshElement;
use crate::own_damping;
use crate::part_context::PartContext;
use crate::report::Owner;
use crate::sections;
use crate::values::{chosen, flag, keys, vec3};
use base::diagnostic::At;
use base::math::quadrature::lobatto;
use base::math::{Mat3, Vec3};
use deck::Deck;
use deck::beams as words;
use deck::words::Vector;
use mechanics::elements::beam::{DEFAULT_ORDER, FibreModel, IntegrationRule, MOST_POINTS};
use mechanics::elements::heat::Heat;
use mechanics::materials::uniaxial::UniaxialLaw;
use std::collections::HashSet;

/// Sine of the angle between orientation and axis below which they count as parallel.
const PARALLEL: f64 = 1e-6;

/// Least angle between the section axes of deck and file for a note: above the rounding of coordinates of four digits.
const TURNED: f64 = 1e-3;

/// Largest distance of a segment's middle node from the middle, relative to the segment.
const HALF_WAY: f64 = 1e-6;

/// Reads `[[beams]]`: divides each path into elements, or uses those of a group of the mesh.
pub fn beams(cx: &mut PartContext) {
    for (index, beam) in cx.deck.beams.iter().enumerate() {
        let name = beam.name.as_ref().or(beam.group.as_ref());
        let (name, owner) = cx.report.named(("beam", "beams", index), name, &beam.span);
        let at = PartIndex { kind: PartKind::Beam, index };
        cx.parts.begin(at);
        cx.parts.entry_mut(at).contact_radius = half_depth(cx.deck, beam);
        let made = read_beam(at, name, &owner, beam, cx);
        cx.parts.add(at, made.map(Part::from));
    }
}

/// Half the smaller side of a beam's thinnest section; 0 where a section does not say it.
fn half_depth(deck: &Deck, beam: &words::Beam) -> f64 {
    let stations = beam.stations.iter().flat_map(|stations| &stations.value);
    let names = beam.section.iter().chain(stations.filter_map(|station| station.section.as_ref()));
    let indices = names.filter_map(|name| deck.sections.position(name));
    let depths = indices.map(|index| sections::half_depth(&deck.sections.0[index].1));
    depths.reduce(f64::min).unwrap_or(0.0)
}

/// Reads one beam as far as it can, so that all errors of the beam are found; `None` means there were some.
fn read_beam<'d>(
    at: PartIndex,
    name: String,
    owner: &Owner<'d>,
    beam: &'d words::Beam,
    cx: &mut PartContext<'_, 'd>,
) -> Option<Beam> {
    let order = cx.report.count("order", &beam.order, DEFAULT_ORDER);
    if let Some(at) = &beam.order
        && order > 4
    {
        cx.report.error::<()>(&at.span, "`order` can be 1, 2, 3 or 4");
    }
    let mass = chosen(&beam.mass);
    let damping = own_damping::of_part(&beam.damping, cx.report);
    let shear = flag(&beam.shear, true);
    let stations = stations::stations(owner, (at.index, beam), (mass, shear), cx);
    let section = match (&beam.stations, &beam.station_file) {
        (Some(_), _) | (_, Some(_)) => stations.as_ref().and_then(|stations| stations.first()),
        (None, None) => cx.sections.beam_section(owner, [&beam.section, &beam.material], (mass, shear), cx.report),
    };
    let yielding = yielding(owner, beam, order, section.is_some(), cx);
    let orientation = cx.report.require(owner, "orientation", &beam.orientation);
    let line = Line { at, name: &name, owner, beam, order: order.min(4), orientation };
    let elements = match &beam.group {
        Some(group) => line.group_elements(group, cx),
        None if cx.report.is_spoiled(owner.span, "group") => None,
        None => line.path_elements(section.is_some() && yielding.is_some() && order <= 4, cx),
    };
    let (section, yielding, mut elements) = (section?, yielding?, elements?);
    if order > 4 {
        return None;
    }
    elements.iter_mut().for_each(|element| element.section = section);
    if let Some(yielding) = &yielding {
        let materials = [beam.material.as_ref(), beam.section.as_ref().and_then(|name| cx.sections.core(name))];
        softening::check_lengths(owner, (yielding, materials), (&elements, order), cx)?;
    }
    if let Some(stations) = stations {
        stations.lay(&mut elements, beam, (order, shear), cx)?;
    }
    let graded = beam.grading.as_ref().is_some_and(|grading| grading.values.iter().any(|part| part.value < 1.0));
    let rotary_inertia = flag(&beam.rotary_inertia, true);
    Some(Beam { name, order, mass, rotary_inertia, damping, yielding, graded, heat: Heat::NONE, elements })
}

/// A beam whose nodes and elements are to be made.
struct Line<'b, 'd> {
    at: PartIndex,
    name: &'b str,
    owner: &'b Owner<'d>,
    beam: &'d words::Beam,
    order: usize,
    /// `None` if it is missing; the error is already reported.
    orientation: Option<&'d At<Vector>>,
}

impl<'d> Line<'_, 'd> {
    /// Makes elements along the segments of a group of the mesh, as yet without their sections.
    fn group_elements(&self, group: &'d At<String>, cx: &mut PartContext<'_, 'd>) -> Option<Vec<BeamElement>> {
        let unused = keys!(self.beam; path, elements, grading, offset_start, offset_end);
        cx.report.reject_unused("a beam made of a group of the mesh", &unused);
        let toward = self.orientation.and_then(|orientation| cx.report.unit("orientation", orientation));
        // The group is read also without an orientation, whose lack has been reported.
        let frame = |along: Vec3| frame(&along, &toward.unwrap_or_else(|| Vec3::ith(along.iamin(), 1.0)));
        let segments = cx.groups.take(&self.owner.what, group, false, cx.report)?;
        let first = cx.groups.mesh.first;
        let (inner, _) = lobatto(self.order + 1);
        let (mut made, mut nodes, mut seen) = (Vec::new(), Vec::new(), HashSet::new());
        let (mut inside, mut parallel, mut curved) = (0, 0, 0);
        for segment in &segments {
            let ends = [0, 1].map(|k| first + segment.nodes()[k] as usize);
            for end in ends {
                cx.nodes.connect(end, true);
                if seen.insert(end) {
                    nodes.push(end);
                }
            }
            let [x0, x1] = ends.map(|end| cx.nodes.x(end));
            let Some(frame) = frame(x1 - x0) else {
                parallel += 1;
                continue;
            };
            let mut ids = [ends[1]; 5];
            ids[0] = ends[0];
            if segment.kind.order() == 2 {
                let middle = first + segment.nodes()[2] as usize;
                curved += usize::from(!self.takes_middle(middle, [x0, x1], cx));
                (ids[1], ids[2]) = (middle, ends[1]);
                nodes.extend(seen.insert(middle).then_some(middle));
                made.push(BeamElement::new(ids, frame, 0));
                continue;
            }
            for (i, xi) in inner.iter().enumerate().take(inner.len() - 1).skip(1) {
                inside += 1;
                ids[i] = self.add_node(inside, x0 + (x1 - x0) * (0.5 * (1.0 + xi)), cx);
                nodes.push(ids[i]);
            }
            made.push(BeamElement::new(ids, frame, 0));
        }
        cx.parts.entry_mut(self.at).nodes = nodes;
        if parallel > 0 {
            let place = self.orientation.map_or(self.owner.span, |at| &at.span);
            let message = format!("`orientation` is parallel to {parallel} segments of group `{}`", group.value);
            return cx.report.error_with(place, message, "it must point to the side, where local y is to lie");
        }
        self.takes_segments(group, &segments, curved, cx)?;
        if let Some(release) = &self.beam.release {
            released::release_chains(self.name, group, (release, self.order), &mut made, (self.at, cx))?;
        }
        self.check_directions(group, &segments, toward?, cx);
        Some(made)
    }

    /// Warns where the file turns the sections of some segments otherwise than the deck does.
    fn check_directions(
        &self,
        group: &At<String>,
        segments: &[&MeshElement],
        toward: Vec3,
        cx: &mut PartContext<'_, 'd>,
    ) {
        let (first, nodes) = (cx.groups.mesh.first, &cx.nodes);
        let (mut count, mut most) = (0, (0.0, 0, Vec3::zeros()));
        for segment in segments {
            let Some(directed) = segment.toward else { continue };
            let [a, b] = [0, 1].map(|k| nodes.x(first + segment.nodes()[k] as usize));
            let given = nodes.x(first + directed as usize) - a;
            let [Some(deck), Some(file)] = [toward, given].map(|y| frame(&(b - a), &y)) else { continue };
            let angle = deck.column(1).angle(&file.column(1));
            count += usize::from(angle > TURNED);
            if angle > most.0 {
                most = (angle, segment.id, file.column(1).into());
            }
        }
        if count > 0 {
            let (angle, id, y) = (most.0.to_degrees(), most.1, most.2.map(|x| (x * 1e4).round() / 1e4 + 0.0));
            let place = self.orientation.map_or(&group.span, |at| &at.span);
            let message = format!(
                "`orientation` differs from the direction nodes of {count} elements of group `{}`, by {angle:.1} degrees in element {id}",
                group.value
            );
            let hint = format!(
                "remove `orientation` to follow the file, which has [{:?}, {:?}, {:?}] for element {id}",
                y.x, y.y, y.z
            );
            cx.report.warn(place, message, hint);
        }
    }

    /// Reports segments of three nodes that no element of the beam can take; `curved`: how many are not straight.
    fn takes_segments(
        &self,
        group: &'d At<String>,
        segments: &[&MeshElement],
        curved: usize,
        cx: &mut PartContext<'_, 'd>,
    ) -> Option<()> {
        if curved > 0 {
            let message =
                format!("group `{}` has {curved} curved segments, and elements of beams are straight", group.value);
            let hint = "mesh it with segments of two nodes, or with their nodes between half-way along straight lines";
            return cx.report.error_with(&group.span, message, hint);
        }
        if self.order != 2 && segments.iter().any(|segment| segment.kind.order() == 2) {
            let place = self.beam.order.as_ref().map_or(&group.span, |at| &at.span);
            let message = format!("group `{}` has segments of three nodes", group.value);
            return cx.report.error_with(place, message, "give the beam `order = 2`");
        }
        Some(())
    }

    /// Connects the node of the mesh between the ends of a segment; false where it is not half-way between them.
    fn takes_middle(&self, middle: usize, [x0, x1]: [Vec3; 2], cx: &mut PartContext<'_, 'd>) -> bool {
        cx.nodes.connect(middle, true);
        (cx.nodes.x(middle) - 0.5 * (x0 + x1)).norm() <= HALF_WAY * (x1 - x0).norm()
    }

    /// Makes elements along a path of points, as yet without their sections, where the rest of the beam is `sound`.
    fn path_elements(&self, sound: bool, cx: &mut PartContext<'_, 'd>) -> Option<Vec<BeamElement>> {
        let elements = cx.report.require(self.owner, "elements", &self.beam.elements);
        let mut path = path(self.owner, &self.beam.path, true, cx)?;
        self.offset_ends(&mut path, cx);
        let points = &self.beam.path.as_ref()?.values;
        let lengths = segments(self.owner, points, &path, cx);
        let frames = self.orientation.and_then(|orientation| frames(points, &path, orientation, cx));
        let counts = elements.and_then(|elements| counts(elements, path.len() - 1, cx))?;
        let gradings = gradings(&self.beam.grading, &counts, cx)?;
        lengths?;
        let frames = frames.filter(|_| sound)?;
        self.release_ends(&mut path, &frames, cx);
        let (inner, _) = lobatto(self.order + 1);
        let mut nodes = vec![path[0]];
        let mut made = Vec::new();
        for (segment, (&count, &grading)) in counts.iter().zip(&gradings).enumerate() {
            let cuts = (grading < 1.0).then(|| cuts(count, grading));
            let [start, end] = [path[segment], path[segment + 1]];
            let [x0, x1] = [cx.nodes.x(start), cx.nodes.x(end)];
            for element in 0..count {
                let mut ids = [*nodes.last()?; 5];
                for (i, xi) in inner.iter().enumerate().skip(1) {
                    let last = element + 1 == count && i == self.order;
                    let part = 0.5 * (1.0 + xi);
                    let s = match &cuts {
                        Some(cuts) => cuts[element] + (cuts[element + 1] - cuts[element]) * part,
                        None => (element as f64 + part) / count as f64,
                    };
                    ids[i] = if last { end } else { self.add_node(nodes.len(), x0 + (x1 - x0) * s, cx) };
                    nodes.push(ids[i]);
                }
                made.push(BeamElement::new(ids, frames[segment], 0));
            }
        }
        cx.parts.entry_mut(self.at).nodes = nodes;
        Some(made)
    }

    /// For a beam with offsets, replaces the ends of a path by nodes rigidly attached to them.
    fn offset_ends(&self, path: &mut [usize], cx: &mut PartContext) {
        let last = path.len() - 1;
        let offsets = [(0, "start", &self.beam.offset_start), (last, "end", &self.beam.offset_end)];
        for (at, which, offset) in offsets {
            if let Some(offset) = offset
                && offset.value.0 != [0.0; 3]
            {
                let x = cx.nodes.x(path[at]) + vec3(offset);
                path[at] = cx.nodes.add_dependent(format!("{}.{which}", self.name), x, path[at], &offset.span);
                cx.nodes.connect(path[at], true);
            }
        }
    }

    /// For a beam with releases, replaces the ends of a path by nodes that joints hold to them.
    fn release_ends(&self, path: &mut [usize], frames: &[Mat3], cx: &mut PartContext) {
        let (Some(release), Some(first), Some(last)) = (&self.beam.release, frames.first(), frames.last()) else {
            return;
        };
        let end = path.len() - 1;
        for (at, which, dofs, axes) in [(0, "start", &release.start, first), (end, "end", &release.end, last)] {
            if let Some(held) = released::held(dofs, cx.report) {
                path[at] = released::release(&format!("{}.", self.name), which, path[at], (held, *axes), cx);
            }
        }
    }

    /// A node between the ends, with its number in the beam.
    fn add_node(&self, number: usize, x: Vec3, cx: &mut PartContext) -> usize {
        let node = cx.nodes.add(format!("{}[{number}]", self.name), false, x);
        cx.nodes.connect(node, true);
        node
    }
}

/// Reads the yield model of the beam: `Some(None)` for elastic material, `None` after errors. `section` tells whether its section is sound.
fn yielding<'d>(
    owner: &Owner<'d>,
    beam: &'d words::Beam,
    order: usize,
    section: bool,
    cx: &mut PartContext<'_, 'd>,
) -> Option<Option<FibreModel>> {
    let unused = keys!(beam; integration, points, shear_yields);
    let law = match &beam.material {
        Some(name) => cx.materials.law_of_fibres(name)?,
        None => None,
    };
    let Some(law) = law else {
        cx.report.reject_unused(&format!("{}, whose material is elastic", owner.what), &unused);
        return Some(None);
    };
    if let Some(stations) = &beam.stations {
        let message =
            format!("{} has `stations`, and its material yields: fibres are those of one section", owner.what);
        let hint = "give it an elastic material, or divide it into beams that have one `section` each";
        return cx.report.error_with(&stations.span, message, hint);
    }
    let points = cx.report.count("points", &beam.points, order);
    if let Some(at) = &beam.points
        && order == 1
        && points > 1
    {
        let message = "elements of order 1 take one point: with more they lock in shear";
        return cx.report.error_with(&at.span, message, "take a higher `order`");
    }
    if let Some(at) = &beam.points
        && !(order..=MOST_POINTS).contains(&points)
    {
        let message = format!("`points` must lie between the order of the elements, {order}, and {MOST_POINTS}");
        return cx.report.error(&at.span, message);
    }
    let rule = match &beam.integration {
        Some(at) if at.value == IntegrationRule::Lobatto && points < 3 => {
            let message = "a Lobatto rule needs three points";
            return cx.report.error_with(&at.span, message, "take elements of order 3 or 4");
        }
        rule => chosen(rule),
    };
    let shear = yields_in_shear(owner, beam, &law, cx)?;
    // A wrong section has been reported.
    let (of, made_of) = (beam.section.as_ref()?, beam.material.as_ref()?);
    if !section {
        return None;
    }
    let needs_mass = cx.materials.needs_mass(chosen(&beam.mass));
    let parts = cx.sections.fibres(of, (made_of, law), needs_mass, cx.report)?;
    let groups = parts.into_iter().map(|part| part.group).collect();
    Some(Some(FibreModel { groups, shear, rule, points }))
}

/// True where shear stress enters the yield condition.
fn yields_in_shear<'d>(
    owner: &Owner<'d>,
    beam: &'d words::Beam,
    law: &UniaxialLaw,
    cx: &mut PartContext<'_, 'd>,
) -> Option<bool> {
    let deforms = flag(&beam.shear, true);
    if let Some(yields) = beam.shear_yields.as_ref().filter(|yields| yields.value && !deforms) {
        let message =
            "`shear_yields = true` contradicts `shear = false`: a beam without shear deformation cannot yield in shear";
        return cx.report.error_with(&yields.span, message, "leave one of the two out");
    }
    let has_shear = matches!(law, UniaxialLaw::Plastic(_));
    if let Some(yields) = beam.shear_yields.as_ref().filter(|yields| yields.value && !has_shear) {
        let message =
            format!("{} is of a material under normal stress alone: shear and torsion stay elastic", owner.what);
        return cx.report.error_with(&yields.span, message, "leave `shear_yields` out");
    }
    Some(has_shear && deforms && flag(&beam.shear_yields, true))
}

/// Section frame of each segment: x along it, y towards the orientation, z = x × y.
fn frames<'d>(
    points: &'d [At<String>],
    path: &[usize],
    orientation: &At<Vector>,
    cx: &mut PartContext<'_, 'd>,
) -> Option<Vec<Mat3>> {
    let toward = cx.report.unit("orientation", orientation)?;
    let mut frames = Vec::new();
    for (i, pair) in path.windows(2).enumerate() {
        let along = cx.nodes.x(pair[1]) - cx.nodes.x(pair[0]);
        if along.try_normalize(0.0).is_none() {
            continue;
        }
        let Some(frame) = frame(&along, &toward) else {
            let message =
                format!("`orientation` is parallel to segment `{}` - `{}`", points[i].value, points[i + 1].value);
            let hint = "it must point to the side, where local y is to lie";
            cx.report.error_with::<()>(&orientation.span, message, hint);
            continue;
        };
        frames.push(frame);
    }
    (frames.len() + 1 == path.len()).then_some(frames)
}

/// Section axes: x along a segment, y towards the orientation, z = x × y. `None` where the two are parallel.
fn frame(along: &Vec3, toward: &Vec3) -> Option<Mat3> {
    let x = along.try_normalize(0.0)?;
    let z = x.cross(toward).try_normalize(PARALLEL)?;
    Some(Mat3::from_columns(&[x, z.cross(&x), z]))
}
