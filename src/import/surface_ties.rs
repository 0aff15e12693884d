//! `*TIE`: the nodes of one surface are tied to the faces of another.

use crate::build::Build;
use crate::deck_text::DeckTable;
use crate::file_content::TieCard;
use crate::scopes::NamedTarget;
use crate::surfaces::{lines, nodes_of};
use base::math::Vec3;
use base::math::curved_faces::middle_of_eight;
use base::math::face_foot::foot;
use std::collections::BTreeSet;

/// Default distance of ties over the size of a face; the thickness counts if it is larger.
const USUAL: f64 = 0.05;

/// The distance in the deck over the largest one here, which is one from nodes: middle surfaces may lie beside them by the thickness.
const ROOM: f64 = 1.01;

/// Nodes this near to a face, over the default distance, lie on it.
const ASIDE: f64 = 1e-3;

/// Adds the ties.
pub fn surface_ties(build: &mut Build) {
    let mut known: BTreeSet<u64> = BTreeSet::new();
    for card in build.im.constraints.ties.clone() {
        let [slave, master] = &card.surfaces;
        let (Some(nodes), Some(base)) = (nodes_of(build, slave), Base::of(build, master)) else { continue };
        if base.faces.is_empty() {
            build.im.refuse(card.line, &format!("`{}` holds no elements of shells to tie nodes to", master.name));
            continue;
        }
        tie(build, &card, nodes, base, &mut known);
    }
}

/// Adds one tie.
fn tie(build: &mut Build, card: &TieCard, nodes: BTreeSet<u64>, base: Base, known: &mut BTreeSet<u64>) {
    let tolerance = card.tolerance.unwrap_or(base.usual);
    let own: BTreeSet<u64> = base.faces.iter().flat_map(|face| face.nodes.iter().copied()).collect();
    let (mut near, mut beyond, mut farthest) = (BTreeSet::new(), 0, 0.0f64);
    for id in nodes.into_iter().filter(|id| !own.contains(id) && build.mesh.used.contains(id)) {
        let distance = base.distance(&build.mesh.x(id));
        if distance <= tolerance {
            near.insert(id);
            farthest = farthest.max(distance);
        } else {
            beyond += 1;
        }
    }
    let [slave, master] = card.surfaces.each_ref().map(|surface| surface.name.clone());
    if near.is_empty() {
        let why = format!("no node of `{slave}` lies within {tolerance:?} of `{master}`: give a POSITION TOLERANCE");
        return build.im.refuse(card.line, &why);
    }
    if beyond > 0 {
        let how = format!("nodes of `{slave}` that lie farther than {tolerance:?} from `{master}` stay free: {beyond}");
        build.im.change(card.line, &how);
    }
    if card.is_adjusted && farthest > ASIDE * base.usual {
        let how = format!("tied nodes keep their places, up to {farthest:.3e} beside the faces: ADJUST=NO");
        build.im.change(card.line, &how);
    }
    if near.iter().any(|id| !known.insert(*id)) {
        return build.im.refuse(card.line, "a tie before this one ties some of these nodes; each is tied once");
    }
    let name = build.deck.unique(&card.name);
    let table = DeckTable::new("ties", card.line).text("name", &name);
    let table = table.names("nodes", &build.names(&near, &[], &format!("{name}_nodes")));
    let faces = build.deck.unique(&format!("{name}_faces"));
    let table = table.text("to", &faces).number("distance", ROOM * (farthest + base.usual));
    build.tied.faces.insert(faces, base.faces.iter().map(|face| face.id).collect());
    build.deck.add(if card.is_hinge { table.text("dofs", "translations") } else { table });
}

/// The faces that nodes are tied to.
struct Base {
    faces: Vec<Face>,
    /// The default distance of ties.
    usual: f64,
}

struct Face {
    id: u64,
    nodes: Vec<u64>,
    /// Places of the nodes, and of the middle where there are eight.
    x: Vec<Vec3>,
    center: Vec3,
    radius: f64,
}

impl Base {
    /// The faces of shells in a surface.
    fn of(build: &mut Build, surface: &NamedTarget) -> Option<Base> {
        let mut cells = BTreeSet::new();
        for (set, side) in lines(build, surface)? {
            if side != "NODE" {
                cells.extend(build.cells(&set));
            }
        }
        let (mut base, mut size) = (Base { faces: Vec::new(), usual: 0.0 }, 0.0f64);
        for piece in build.pieces.iter().filter(|piece| !piece.is_beam && !piece.is_bar) {
            for &at in piece.cells.iter().filter(|at| cells.contains(at)) {
                let face = Face::new(build, at);
                base.usual = base.usual.max(piece.size);
                size = size.max(face.radius);
                base.faces.push(face);
            }
        }
        base.usual = base.usual.max(USUAL * size);
        Some(base)
    }

    fn distance(&self, x: &Vec3) -> f64 {
        let nearer = |least: f64, face: &Face| match (face.center - x).norm() - face.radius > least {
            true => least,
            false => least.min((foot(&face.x, x).x - x).norm()),
        };
        let from_center = |face: &Face| (face.center - x).norm_squared();
        // The face with the nearest centre comes first, so that most others are seen to be farther.
        let nearest = self.faces.iter().min_by(|a, b| from_center(a).total_cmp(&from_center(b)));
        nearest.into_iter().chain(&self.faces).fold(f64::INFINITY, nearer)
    }
}

impl Face {
    fn new(build: &Build, at: usize) -> Face {
        let cell = &build.mesh.cells[at];
        let nodes = cell.nodes.clone();
        let mut x: Vec<Vec3> = nodes.iter().map(|id| build.mesh.x(*id)).collect();
        if x.len() == 8 {
            x.push(middle_of_eight(|k| x[k]));
        }
        let center = x.iter().sum::<Vec3>() / x.len() as f64;
        let radius = 2.0 * x.iter().map(|x| (x - center).norm()).fold(0.0, f64::max);
        Face { id: cell.id, nodes, x, center, radius }
    }
}
