//! Marks that pages and pictures draw beside the fields: supports, loads, joints, and the depth of beams.

use base::math::Vec3;
use mechanics::sections::SectionOutline;
use model::{JointOrigin, Model};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, HashSet};

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
    /// Sections of beams by their names: the least and the largest y and z from the axis, or a radius.
    pub beams: BTreeMap<String, SectionSize>,
}

/// The size of a section about the axis of its beam.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum SectionSize {
    /// A round section, by its outer radius.
    Round {
        /// The radius.
        radius: f64,
    },
    /// Any other, by the box around it.
    Box {
        /// The least and the largest y.
        y: [f64; 2],
        /// The least and the largest z.
        z: [f64; 2],
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
            let range = |axis: usize| {
                let along = || points.iter().map(|point| point.at[axis]);
                [along().fold(f64::INFINITY, f64::min), along().fold(f64::NEG_INFINITY, f64::max)]
            };
            SectionSize::Box { y: range(0), z: range(1) }
        }
    }
}
