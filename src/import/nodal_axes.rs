//! `*TRANSFORM`: axes at nodes, along which supports, loads and equations act.

use crate::build::Build;
use crate::importer::Importer;
use crate::keyword_block::KeywordBlock;
use crate::tied_nodes::NodalAxes;
use base::math::Mat3;
use std::collections::HashMap;

/// `*TRANSFORM`.
pub fn transform(im: &mut Importer, block: &KeywordBlock) {
    let (keyword, line) = (&block.keyword, block.keyword.line);
    let Some(set) = keyword.value("NSET") else { return im.refuse(line, "*TRANSFORM needs NSET=") };
    let target = im.set_target(set, line);
    let Some(data) = block.data.first() else {
        return im.refuse(line, "*TRANSFORM needs two points on the line below");
    };
    let points = [im.vector(data, 0), im.vector(data, 3)];
    let kind = keyword.value("TYPE").unwrap_or("R").to_ascii_uppercase();
    let axes = match &kind[..] {
        "R" => NodalAxes::Rectangular(points),
        "C" => NodalAxes::Cylindrical(points),
        "S" => NodalAxes::Spherical(points),
        _ => return im.refuse(line, "TYPE is R, C or S"),
    };
    im.constraints.transforms.push((target, axes));
}

/// The axes of nodes that have their own; refuses those without a direction.
pub fn of_nodes(build: &mut Build) -> HashMap<u64, Mat3> {
    let mut of_nodes = HashMap::new();
    for (target, axes) in build.im.constraints.transforms.clone() {
        for node in build.nodes(&target) {
            match axes.at(&build.mesh.x(node)) {
                Some(axes) => drop(of_nodes.insert(node, axes)),
                None => build.im.refuse(target.line, &format!("the axes have no direction at node {node}")),
            }
        }
    }
    of_nodes.retain(|_, axes| *axes != Mat3::identity());
    of_nodes
}
