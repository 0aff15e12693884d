//! contact_pairs.csv: the forces of contacts between every two parts that touch.

use crate::extent::Rows;
use crate::table::{TableKind, WriteRow};
use base::math::Vec3;
use base::quantities::{CONTACT_PAIR, Column};
use model::{Contact, ContactRows, Model, PartKind, TouchedSurface};
use solve::{ContactTouch, Frame, Wanted};
use std::cell::RefCell;
use std::collections::HashMap;
use std::io;

pub static TABLE: TableKind = TableKind {
    file: "contact_pairs.csv",
    about: "One row for each contact and each two of its bodies, parts and points that touch. Forces and moments act on the first of the two, \
            the surface, and sum all points in contact. Among bodies the first is the one that the deck names earlier. Pairs that do not touch \
            have no row, and neither has a part that touches itself. Written with `[output] contacts = { by = \"pairs\" }` or \"both\" if \
            there are contacts.",
    columns: &[
        &[
            Column::key("contact", "name of the contact"),
            Column::key("surface", "the body or part that is touched; `ground` for a surface without a body"),
            Column::key(
                "with",
                "the body, part or point in contact; a node of several parts counts for the first of them",
            ),
        ],
        &CONTACT_PAIR,
    ],
    wanted: |model| {
        model.output.contacts.is_some_and(|rows| rows != ContactRows::Contacts) && model.has(PartKind::Contact)
    },
    needs: Wanted::CONTACT_TOUCHES,
    has_last: |_| true,
    every_step: false,
    extent: |extent| {
        // Nothing touches most of the time.
        Rows::named(extent.model.each::<Contact>().map(|contact| contact.name.as_str()), 0)
    },
    rows: |model| {
        let (owners, contacts) = (NodeOwners::of(model), model.each::<Contact>().map(|it| it.name.clone()).collect());
        let names = PairNames { owners, contacts };
        // Room for the order of touches, kept from time to time.
        let order = RefCell::new(Vec::new());
        Box::new(move |table, frame| write(table, &names, &mut order.borrow_mut(), frame))
    },
    answers: None,
};

/// The owner of each node, a body or a part, for the names in contact pairs.
struct NodeOwners {
    /// Names of bodies, then of parts, then `ground`.
    names: Vec<String>,
    /// The place in `names` for each node; `names.len()` plus the node for a point without an owner.
    of_node: Vec<usize>,
    /// The touched surface of each contact.
    touched: Vec<Touched>,
}

/// The touched surface of a contact.
enum Touched {
    /// A shape; its node gives the owner.
    Shape,
    /// Faces or lines of the part at this place in the names.
    Part(usize),
    /// Each of some bodies, by the others.
    EachOther,
    /// A part by itself.
    Itself,
}

impl NodeOwners {
    fn of(model: &Model) -> NodeOwners {
        let mut names: Vec<String> = model.bodies.iter().map(|body| body.name.clone()).collect();
        let mut of_node: Vec<Option<usize>> = vec![None; model.nodes.len()];
        model.bodies.iter().enumerate().for_each(|(place, body)| of_node[body.node] = Some(place));
        for part in model.parts.iter().filter(|part| part.kind().is_deformable()) {
            // A shell of two shapes of elements is two parts of one name.
            if names.last().is_none_or(|last| last != part.name()) {
                names.push(part.name().to_owned());
            }
            let nodes = (0..part.elements()).flat_map(|element| part.nodes(element));
            nodes.for_each(|&node| _ = of_node[node].get_or_insert(names.len() - 1));
        }
        let ground = names.len();
        names.push("ground".to_owned());
        let masters: HashMap<usize, usize> =
            model.constraints.dependents.iter().map(|dependent| (dependent.node, dependent.master)).collect();
        let mut touched = Vec::new();
        for contact in model.each::<Contact>() {
            touched.push(match &contact.surface {
                TouchedSurface::Shape(carried) => {
                    if !masters.contains_key(&carried.node) {
                        of_node[carried.node].get_or_insert(ground);
                    }
                    Touched::Shape
                }
                TouchedSurface::Facets(faces) => match names.iter().position(|name| *name == faces.part) {
                    Some(part) if faces.has_sides() => Touched::Part(part),
                    Some(_) => Touched::Itself,
                    None => Touched::EachOther,
                },
            });
        }
        let owner = |node: usize| {
            let mut at = node;
            while let (None, Some(&master)) = (of_node[at], masters.get(&at)) {
                at = master;
            }
            of_node[at].unwrap_or(names.len() + node)
        };
        NodeOwners { of_node: (0..of_node.len()).map(owner).collect(), names, touched }
    }

    fn name<'a>(&'a self, owner: usize, model: &'a Model) -> &'a str {
        self.names.get(owner).unwrap_or_else(|| &model.nodes[owner - self.names.len()].label)
    }

    /// The two sides of a touch, the first one the surface, and whether they are exchanged; `None` where a part touches itself.
    fn sides(&self, touch: &ContactTouch) -> Option<([usize; 2], bool)> {
        let [on, by] = touch.nodes.map(|node| self.of_node[node]);
        match self.touched[touch.contact] {
            Touched::Shape => Some(([on, by], false)),
            Touched::Part(part) => Some(([part, by], false)),
            Touched::EachOther if on < by => Some(([on, by], false)),
            Touched::EachOther => Some(([by, on], true)),
            Touched::Itself => None,
        }
    }
}

/// The names in a row.
struct PairNames {
    owners: NodeOwners,
    /// Names of contacts, as touches number them.
    contacts: Vec<String>,
}

/// A touch in the order of rows.
#[derive(Clone, Copy)]
struct OrderedTouch {
    /// The contact, the first of its two parts, and the second.
    pair: (usize, [usize; 2]),
    /// The place among all touches.
    place: usize,
    /// −1 if the touched surface comes second.
    sign: f64,
}

fn write(table: &mut dyn WriteRow, names: &PairNames, order: &mut Vec<OrderedTouch>, frame: &Frame) -> io::Result<()> {
    let touches = &frame.derived.contact_touches;
    order.clear();
    order.extend(touches.iter().enumerate().filter_map(|(place, touch)| {
        let (sides, exchanged) = names.owners.sides(touch)?;
        Some(OrderedTouch { pair: (touch.contact, sides), place, sign: if exchanged { -1.0 } else { 1.0 } })
    }));
    // By places too, so that sums have the same bits whatever the sort.
    order.sort_unstable_by_key(|touch| (touch.pair, touch.place));
    for touching in order.chunk_by(|a, b| a.pair == b.pair) {
        let (contact, [on, by]) = touching[0].pair;
        let (mut f, mut m) = (Vec3::zeros(), Vec3::zeros());
        for &OrderedTouch { place, sign, .. } in touching {
            f += sign * touches[place].f;
            m += sign * touches[place].m;
        }
        let row = table.row(frame.step, frame.state.time).text(&names.contacts[contact]);
        let row = row.text(names.owners.name(on, frame.model)).text(names.owners.name(by, frame.model));
        row.count(touching.len()).numbers(&[f.x, f.y, f.z, m.x, m.y, m.z]).end()?;
    }
    Ok(())
}
