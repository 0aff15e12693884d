//! Marks that pages and pictures draw beside the fields: supports, loads, joints, and the depth of beams.

use base::math::Vec3;
use mechanics::sections::SectionOutline;
use model::{FieldFormat, JointOrigin, Model};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet, HashSet};

/// The largest number of marks of a kind: a page with more is a page of arrows.
const MOST: usize = 2000;

/// A direction counts as fixed everywhere from this part of the nodes on.
const EVERYWHERE: f64 = 0.6;

/// The marks of a scene at t = 0, of all stages together.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct SceneMarks {
    /// Places of supports, and a number whose bits are the restrained directions, from ux on.
    pub supports: Vec<([f64; 3], u8)>,
    /// Places of loads at full size, with force and moment, global components.
    pub loads: Vec<([f64; 3], [f64; 6])>,
    /// Places of joints.
    pub joints: Vec<[f64; 3]>,
    /// Named points that follow each other along beams and bars, for pages of runs without VTU files.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub members: Vec<[String; 2]>,
    /// Sections of beams by their names: the least and the largest y and z from the axis, or a radius.
    pub beams: BTreeMap<String, SectionSize>,
}

/// The size of a section about the axis of its beam.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum SectionSize {
    /// A round section, by its outer radius.
    Round {
        /// The radius.
        radius: f64,
    },
    /// A rectangle, full or hollow.
    Box {
        /// The least and the largest y.
        y: [f64; 2],
        /// The least and the largest z.
        z: [f64; 2],
    },
    /// Open walls.
    Walls {
        /// The least y, the largest y, the least z and the largest z of each.
        walls: Vec<[f64; 4]>,
    },
}

impl SceneMarks {
    /// The marks of the stages of a deck.
    pub fn of(models: &[&Model]) -> SceneMarks {
        let mut supports: BTreeMap<[u64; 3], ([f64; 3], u8)> = BTreeMap::new();
        let mut loads: BTreeMap<[u64; 3], ([f64; 3], [f64; 6])> = BTreeMap::new();
        let (mut joints, mut seen) = (Vec::new(), HashSet::new());
        let mut marks = SceneMarks::default();
        for model in models {
            let place = |node: usize| -> [f64; 3] { model.nodes[node].x.into() };
            for (node, dof) in held(model) {
                supports.entry(place(node).map(f64::to_bits)).or_insert((place(node), 0)).1 |= 1 << dof;
            }
            for (node, sum) in loaded(model) {
                // The largest of all stages.
                let entry = loads.entry(place(node).map(f64::to_bits)).or_insert((place(node), sum));
                if size(&sum) > size(&entry.1) {
                    entry.1 = sum;
                }
            }
            let listed = model.constraints.joints.iter().filter(|joint| joint.origin == JointOrigin::Deck);
            let places = listed.map(|joint| place(joint.ends[0]));
            joints.extend(places.filter(|place| seen.insert(place.map(f64::to_bits))));
            for part in model.parts.iter().filter(|part| part.elements() > 0) {
                let stresses = part.section(0).and_then(|section| model.stresses[section].as_ref());
                let size = stresses.map(|stresses| section_size(stresses.outline()));
                marks.beams.extend(size.map(|size| (part.name().to_owned(), size)));
            }
        }
        let without_fields = models.iter().filter(|model| !has_grids(model));
        marks.members = without_fields.flat_map(|model| members(model)).collect::<BTreeSet<_>>().into_iter().collect();
        marks.members.truncate(MOST);
        let all = models.first().map_or(0, |model| model.nodes.len());
        let everywhere = (0..6).filter(|dof| {
            let count = supports.values().filter(|(_, dofs)| dofs & 1 << dof != 0).count();
            count as f64 > EVERYWHERE * all as f64
        });
        // Directions fixed at all nodes, as out of a plane model, are not drawn as supports.
        let plane: u8 = everywhere.map(|dof| 1 << dof).sum();
        marks.supports = supports.into_values().filter(|(_, dofs)| dofs & !plane != 0).take(MOST).collect();
        marks.loads = loads.into_values().filter(|(_, sum)| size(sum) > 0.0).take(MOST).collect();
        joints.truncate(MOST);
        SceneMarks { joints, ..marks }
    }
}

/// True for a run with VTU files.
fn has_grids(model: &Model) -> bool {
    model.output.fields.as_ref().is_some_and(|files| files.format == FieldFormat::Vtu)
}

/// The labels of named nodes that follow each other along beams and bars.
fn members(model: &Model) -> Vec<[String; 2]> {
    let mut members = Vec::new();
    for part in model.parts.iter().filter(|part| part.kind().is_line()) {
        let (mut from, mut end) = (None, None);
        for element in 0..part.elements() {
            let nodes = part.nodes(element);
            from = from.filter(|_| end == nodes.first().copied());
            for &node in nodes.iter().filter(|node| model.nodes[**node].named) {
                let pair = from.replace(node).filter(|from| *from != node).map(|from| [from, node]);
                members.extend(pair.map(|ends| ends.map(|node| model.nodes[node].label.clone())));
            }
            end = nodes.last().copied();
        }
    }
    members
}

/// The nodes and directions that supports hold or move. Nodes that drive joints are none of the scene's.
fn held(model: &Model) -> impl Iterator<Item = (usize, usize)> {
    let own: HashSet<usize> = model
        .constraints
        .joints
        .iter()
        .flat_map(|joint| {
            let drive = joint.coordinate.as_ref().and_then(|coordinate| coordinate.drive);
            let ground = (joint.origin == JointOrigin::Deck).then_some(joint.ends).into_iter().flatten();
            ground.filter(|&node| !model.nodes[node].named).chain(drive.map(|drive| drive.node))
        })
        .collect();
    let restraints = model.constraints.restraints.iter();
    let shown = move |node: usize| !own.contains(&node) && !model.nodes[node].is_number;
    restraints.filter(move |restraint| shown(restraint.node)).map(|restraint| (restraint.node, restraint.dof))
}

/// The sums of forces and moments of loads on nodes and of pressures, node by node, each at its full size.
fn loaded(model: &Model) -> BTreeMap<usize, [f64; 6]> {
    let mut sums: BTreeMap<usize, [f64; 6]> = BTreeMap::new();
    let mut add = |node: usize, force: &Vec3, moment: &Vec3| {
        let sum = sums.entry(node).or_default();
        for i in 0..3 {
            sum[i] += force[i];
            sum[3 + i] += moment[i];
        }
    };
    let zero = Vec3::zeros();
    for load in model.loading.nodal.iter().filter(|load| load.coordinate().is_none()) {
        add(load.node, &load.force, if load.moment_counts { &load.moment } else { &zero });
    }
    for load in &model.loading.pressures {
        for face in &load.faces {
            let areas = face.areas(|node| model.nodes[node].x);
            face.nodes().iter().zip(areas).for_each(|(&node, area)| add(node, &(area * -load.pressure), &zero));
        }
    }
    sums
}

/// The size of a force and of a moment together, for comparisons of loads on one node.
fn size(sum: &[f64; 6]) -> f64 {
    sum.iter().map(|x| x * x).sum()
}

fn section_size(outline: &SectionOutline) -> SectionSize {
    match outline {
        SectionOutline::Circle { outer, .. } => SectionSize::Round { radius: *outer },
        SectionOutline::Points(points) => {
            let mut walls: Vec<[f64; 4]> = Vec::new();
            for wall in points.chunk_by(|a, b| a.wall == b.wall) {
                let [[y0, y1], [z0, z1]] = [0, 1].map(|axis| range(wall.iter().map(|point| point.at[axis])));
                let is_same = |a: f64, b: f64| (a - b).abs() <= SAME * (y1 - y0).max(z1 - z0);
                match walls.last_mut() {
                    // The halves of a flange are one.
                    Some([_, y, low, high]) if is_same(*y, y0) && is_same(*low, z0) && is_same(*high, z1) => *y = y1,
                    _ => walls.push([y0, y1, z0, z1]),
                }
            }
            let [y, z] = box_of(&walls);
            // A side is closed where walls cover it.
            let is_closed = |side: f64, place: usize| {
                let is_there = |wall: &&[f64; 4]| (wall[place] - side).abs() <= SAME * (y[1] - y[0]);
                let along = walls.iter().filter(is_there).map(|[.., low, high]| high - low);
                along.sum::<f64>() >= CLOSED * (z[1] - z[0])
            };
            match is_closed(y[0], 0) && is_closed(y[1], 1) {
                true => SectionSize::Box { y, z },
                false => SectionSize::Walls { walls },
            }
        }
    }
}

/// Part of the size of a section within which two of its coordinates are one, against rounding.
const SAME: f64 = 1e-9;

/// Part of the height of a box that its webs cover.
const CLOSED: f64 = 0.999;

/// The least and the largest y and z of walls.
pub fn box_of(walls: &[[f64; 4]]) -> [[f64; 2]; 2] {
    [0, 2].map(|axis| range(walls.iter().flat_map(|wall| [wall[axis], wall[axis + 1]])))
}

fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use mechanics::sections::SectionShape;
    use mechanics::sections::hollow_box::HollowBox;
    use mechanics::sections::i::I;
    use mechanics::sections::rectangle::Rectangle;

    /// An I section is its web between two flanges, and boxes, full and hollow, are drawn by their sides.
    #[test]
    fn sections_are_drawn_by_their_walls() {
        let size = |shape: &dyn SectionShape| {
            let section = shape.section(0.3).unwrap();
            section_size(&shape.outline(0.3, &section).unwrap())
        };
        let i = I { height: 0.3, top_width: 0.2, bottom_width: 0.2, web: 0.01, top_flange: 0.02, bottom_flange: 0.02 };
        let SectionSize::Walls { walls } = size(&i) else { panic!("an I section has walls") };
        let wanted = [[-0.1, 0.1, 0.13, 0.15], [-0.005, 0.005, -0.13, 0.13], [-0.1, 0.1, -0.15, -0.13]];
        assert_eq!(walls.len(), wanted.len());
        for (found, wanted) in walls.iter().flatten().zip(wanted.iter().flatten()) {
            assert!((found - wanted).abs() < 1e-12, "{walls:?}");
        }
        let full: Box<dyn SectionShape> = Box::new(Rectangle { width: 0.1, height: 0.2 });
        let hollow: Box<dyn SectionShape> = Box::new(HollowBox { width: 0.1, height: 0.2, web: 0.01, flange: 0.005 });
        for shape in [full, hollow] {
            let SectionSize::Box { y, z } = size(&*shape) else { panic!("{shape:?} is a box") };
            let sides = [y[0] + 0.05, y[1] - 0.05, z[0] + 0.1, z[1] - 0.1];
            assert!(sides.iter().all(|side| side.abs() < 1e-12), "{sides:?}");
        }
    }
}
