//! Finer and coarser meshes of the parts of a deck, step by step, as overrides.

use deck::Deck;
use model::Model;

/// Up to this order of beams, a higher order is cheaper than more elements: one element of order 4 has five nodes and errs as little as two of
/// order 3 with seven.
const CHEAPEST_ORDER: u64 = 4;
/// The part of the order of convergence that few elements reach.
const SLOPE: f64 = 0.8;
/// Least factor between the errors of orders p and p + 1.
const OF_A_DEGREE: f64 = 4.0;
/// Largest number of groups with separate meshes: each costs a pilot run.
const MOST_GROUPS: usize = 6;
/// Largest number of elements of all parts together.
const MOST_ELEMENTS: u64 = 100_000;

/// The mesh of one part.
#[derive(Debug, Clone, PartialEq)]
struct PartMesh {
    path: String,
    /// Numbers of elements, and whether the deck writes a single one; empty where the deck gives none.
    elements: Vec<u64>,
    single: bool,
    /// `None` where the deck has no say in it.
    order: Option<u64>,
    /// True for a line, whose order is raised before its number of elements.
    raises_order: bool,
    /// True where material yields: hinges limit the order of convergence.
    yields: bool,
}

/// Parts that are refined together.
#[derive(Debug, Clone, PartialEq)]
pub struct RefinableParts {
    parts: Vec<PartMesh>,
}

/// The refinable parts of a deck in groups, and the names of deformable parts with a fixed mesh.
pub fn mesh_groups(deck: &Deck, model: &Model) -> (Vec<RefinableParts>, Vec<String>) {
    let (mut groups, mut shells, mut fixed) = (Vec::new(), Vec::new(), Vec::new());
    for part in deck.parts().filter(|part| part.at.kind.is_deformable() && !part.is_rigid()) {
        let kind = part.at.kind;
        let elements = part.table.elements().filter(|_| part.table.group().is_none());
        let order = part.table.order();
        if part.table.group().is_some() && order.is_none() {
            fixed.push(part.label());
        }
        if elements.is_none() && order.is_none() {
            continue;
        }
        let mesh = PartMesh {
            path: part.table_path(),
            elements: elements.map_or(Vec::new(), |at| at.values.iter().map(|count| count.value).collect()),
            single: elements.is_none_or(|at| at.single),
            order,
            raises_order: order.is_some() && !model.yields(),
            yields: model.yields(),
        };
        // Patches share nodes along their edges.
        if kind.is_surface() { shells.push(mesh) } else { groups.push(RefinableParts { parts: vec![mesh] }) }
    }
    if groups.len() > MOST_GROUPS {
        groups = vec![RefinableParts { parts: groups.into_iter().flat_map(|group| group.parts).collect() }];
    }
    groups.extend((!shells.is_empty()).then_some(RefinableParts { parts: shells }));
    (groups, fixed)
}

impl PartMesh {
    fn finer(&self) -> Option<PartMesh> {
        let raised = self.order.filter(|order| self.raises_order && *order < CHEAPEST_ORDER).map(|order| order + 1);
        match raised {
            Some(_) => Some(PartMesh { order: raised, ..self.clone() }),
            None if self.elements.is_empty() => None,
            None => Some(PartMesh { elements: self.elements.iter().map(|count| 2 * count).collect(), ..self.clone() }),
        }
    }

    fn coarser(&self) -> Option<PartMesh> {
        if self.elements.iter().any(|count| *count > 1) {
            return Some(PartMesh {
                elements: self.elements.iter().map(|count| count.div_ceil(2)).collect(),
                ..self.clone()
            });
        }
        // One straight element is so stiff in bending that its run may take many more steps than that of the deck.
        let lower = self.order.filter(|order| self.raises_order && *order > 2).map(|order| order - 1);
        lower.map(|_| PartMesh { order: lower, ..self.clone() })
    }

    /// The least ratio of the error of this mesh to that of a finer one.
    fn ratio(&self, finer: &PartMesh) -> f64 {
        if self.order != finer.order {
            return OF_A_DEGREE;
        }
        let ratios = self.elements.iter().zip(&finer.elements).filter(|(few, many)| few < many);
        let ratio = ratios.map(|(few, many)| *many as f64 / *few as f64).fold(f64::INFINITY, f64::min);
        if ratio.is_finite() { ratio.powf(self.slope()) } else { 1.0 }
    }

    /// The power of the length of an element that its error follows.
    fn slope(&self) -> f64 {
        match self.order {
            // Hinges move from point to point of the mesh.
            _ if self.yields => 1.0,
            Some(order) => (SLOPE * 2.0 * order as f64).max(2.0),
            _ => 2.0,
        }
    }

    fn sets(&self, base: &PartMesh) -> Vec<String> {
        let words: Vec<String> = self.elements.iter().map(u64::to_string).collect();
        let value = if self.single { words.concat() } else { format!("[{}]", words.join(", ")) };
        let elements = (self.elements != base.elements).then(|| format!("{}.elements={value}", self.path));
        let order = self.order.filter(|_| self.order != base.order).map(|order| format!("{}.order={order}", self.path));
        elements.into_iter().chain(order).collect()
    }
}

impl RefinableParts {
    /// The next finer mesh, with the least ratio of the error of this one to its error; `None` if no part can be finer.
    pub fn finer(&self) -> Option<(RefinableParts, f64)> {
        let finer = self.changed(PartMesh::finer)?;
        let ratio = self.ratio(&finer);
        Some((finer, ratio))
    }

    /// The next coarser mesh, with the least ratio of its error to that of this one; `None` if no part can be coarser.
    pub fn coarser(&self) -> Option<(RefinableParts, f64)> {
        let coarser = self.changed(PartMesh::coarser)?;
        let ratio = coarser.ratio(self);
        Some((coarser, ratio))
    }

    /// The group with changed meshes; `None` if no mesh changes.
    fn changed(&self, change: fn(&PartMesh) -> Option<PartMesh>) -> Option<RefinableParts> {
        let changed: Vec<Option<PartMesh>> = self.parts.iter().map(change).collect();
        if changed.iter().all(Option::is_none) {
            return None;
        }
        let parts = changed.into_iter().zip(&self.parts).map(|(new, old)| new.unwrap_or_else(|| old.clone()));
        Some(RefinableParts { parts: parts.collect() })
    }

    fn ratio(&self, finer: &RefinableParts) -> f64 {
        let pairs = self.parts.iter().zip(&finer.parts).filter(|(a, b)| a != b);
        pairs.map(|(a, b)| a.ratio(b)).fold(f64::INFINITY, f64::min)
    }

    /// True for lines whose order is to be raised.
    pub fn raises_order(&self) -> bool {
        self.parts.iter().all(|part| part.raises_order && part.order.is_some_and(|order| order < CHEAPEST_ORDER))
    }

    /// The power of the length of an element that the error follows.
    pub fn slope(&self) -> f64 {
        self.parts.iter().map(PartMesh::slope).fold(f64::INFINITY, f64::min)
    }

    /// The overrides that turn the mesh of the deck, `base`, into this one.
    pub fn sets(&self, base: &RefinableParts) -> Vec<String> {
        self.parts.iter().zip(&base.parts).flat_map(|(part, base)| part.sets(base)).collect()
    }

    /// The number of elements of all parts, if elements of two numbers count as a patch.
    fn elements(&self) -> u64 {
        self.parts.iter().map(|part| part.elements.iter().product::<u64>()).sum()
    }
}

/// True where the groups together are still of a size to compute with.
pub fn is_affordable(groups: &[RefinableParts]) -> bool {
    groups.iter().map(RefinableParts::elements).sum::<u64>() <= MOST_ELEMENTS
}

#[cfg(test)]
mod tests {
    use super::*;

    fn beam(elements: u64, order: u64) -> RefinableParts {
        let part = PartMesh {
            path: "beams.0".into(),
            elements: vec![elements],
            single: true,
            order: Some(order),
            raises_order: true,
            yields: false,
        };
        RefinableParts { parts: vec![part] }
    }

    #[test]
    fn beams_gain_order_before_elements() {
        let base = beam(1, 2);
        let (cubic, by_order) = base.finer().expect("a finer mesh");
        let (quartic, _) = cubic.finer().expect("a finer mesh");
        let (halved, by_elements) = quartic.finer().expect("a finer mesh");
        assert_eq!(halved.sets(&base), ["beams.0.elements=2", "beams.0.order=4"]);
        assert_eq!(by_order, OF_A_DEGREE);
        assert!((by_elements - 2f64.powf(6.4)).abs() < 1e-12);
        assert_eq!(cubic.coarser().expect("a coarser mesh").0.sets(&cubic), ["beams.0.order=2"]);
        assert!(base.coarser().is_none());
    }
}
