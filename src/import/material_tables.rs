//! Values of materials by temperature: those at the start are taken, where all nodes of the material begin at one temperature.

use crate::file_content::MaterialCard;
use crate::flat_mesh::FlatMesh;
use crate::importer::Importer;
use crate::keyword_block::KeywordBlock;
use std::collections::{BTreeSet, HashMap};

/// What the rows of a table give.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MaterialValue {
    /// Young's modulus and Poisson's ratio.
    Elastic,
    /// Stress and plastic strain; several rows have one temperature.
    Plastic,
    /// Density.
    Density,
    /// Coefficient of expansion.
    Expansion,
    /// Rate and exponent of an overstress.
    Rate,
}

/// Rows of values of one temperature.
type Rows = Vec<Vec<f64>>;

/// A table of values by temperature.
#[derive(Debug, Clone)]
pub struct MaterialTable {
    line: usize,
    what: MaterialValue,
    /// The rows of each temperature, which increases.
    groups: Vec<(f64, Rows)>,
}

impl MaterialTable {
    /// Reads a table; its temperatures stand behind the values.
    pub fn read(im: &mut Importer, block: &KeywordBlock, what: MaterialValue) -> MaterialTable {
        let (count, missing) = match what {
            MaterialValue::Density | MaterialValue::Expansion => (1, 0.0),
            MaterialValue::Elastic | MaterialValue::Plastic => (2, 0.0),
            MaterialValue::Rate => (2, 1.0),
        };
        let mut groups: Vec<(f64, Rows)> = Vec::new();
        for data in block.data.iter().filter(|data| data.filled() > 0) {
            let mut row = im.numbers(data);
            let heat = row.get(count).copied().unwrap_or(0.0);
            row.resize(count, missing);
            match groups.iter_mut().find(|(known, _)| *known == heat) {
                Some((_, rows)) => rows.push(row),
                None => groups.push((heat, vec![row])),
            }
        }
        MaterialTable { line: block.keyword.line, what, groups }
    }

    /// The rows of the first temperature.
    pub fn first(&self) -> &[Vec<f64>] {
        self.groups.first().map_or(&[], |(_, rows)| rows)
    }

    /// The rows at a temperature, linear between the two beside it; `None` where these have other strains.
    fn at(&self, heat: f64) -> Option<Rows> {
        let mut groups: Vec<&(f64, Rows)> = self.groups.iter().collect();
        groups.sort_by(|a, b| a.0.total_cmp(&b.0));
        let after = groups.partition_point(|group| group.0 <= heat);
        match (after.checked_sub(1).map(|last| groups[last]), groups.get(after)) {
            (Some((low, a)), Some((high, b))) if *low < heat => {
                let share = (heat - low) / (high - low);
                let strains = |rows: &Rows| -> Vec<f64> { rows.iter().map(|row| row[row.len() - 1]).collect() };
                let is_alike = self.what != MaterialValue::Plastic || strains(a) == strains(b);
                let between = |(a, b): (&Vec<f64>, &Vec<f64>)| -> Vec<f64> {
                    a.iter().zip(b).map(|(a, b)| a + share * (b - a)).collect()
                };
                (is_alike && a.len() == b.len()).then(|| a.iter().zip(b).map(between).collect())
            }
            (Some((_, rows)), _) | (None, Some((_, rows))) => Some(rows.clone()),
            (None, None) => None,
        }
    }
}

impl MaterialCard {
    /// Takes a table that has been read: the values of its first temperature, until those at the start are known.
    pub fn take(&mut self, table: MaterialTable) {
        self.set(&table, table.first());
        if table.groups.len() > 1 {
            self.tables.push(table);
        }
    }

    fn set(&mut self, table: &MaterialTable, rows: &[Vec<f64>]) {
        let Some(first) = rows.first() else { return };
        match table.what {
            MaterialValue::Elastic => self.elastic = Some([first[0], first[1]]),
            MaterialValue::Plastic => self.plastic = rows.iter().map(|row| [row[0], row[1]]).collect(),
            MaterialValue::Density => self.density = Some(first[0]),
            MaterialValue::Expansion => self.expansion = Some((first[0], table.line)),
            MaterialValue::Rate => self.rate = Some([first[0], first[1]]),
        }
    }
}

/// Sets the values at the start of all materials. Returns the lines of temperatures that choose some.
pub fn take_start(im: &mut Importer, mesh: &FlatMesh) -> BTreeSet<usize> {
    let mut used = BTreeSet::new();
    if im.materials.list.iter().all(|material| material.tables.is_empty()) {
        return used;
    }
    let mut of_node: HashMap<u64, (f64, usize)> = HashMap::new();
    for line in &im.steps.first_temperatures {
        let nodes = mesh.node_ids(&im.scopes, &line.target).unwrap_or_default();
        of_node.extend(nodes.into_iter().map(|node| (node, (line.values[0], line.line))));
    }
    let is_heated = im.is_heated();
    let mut materials = std::mem::take(&mut im.materials.list);
    for material in materials.iter_mut().filter(|material| !material.tables.is_empty()) {
        let own = im.sections.iter().filter(|section| section.material.to_lowercase() == material.name.to_lowercase());
        let cells = own.flat_map(|section| mesh.cell_indices(&im.scopes, &section.target).unwrap_or_default());
        let nodes: BTreeSet<u64> = cells.flat_map(|cell| mesh.cells[cell].nodes.clone()).filter(|id| *id > 0).collect();
        let given: Vec<Option<&(f64, usize)>> = nodes.iter().map(|node| of_node.get(node)).collect();
        let first = given.first().copied().flatten().map(|(heat, _)| *heat);
        let is_one = given.iter().all(|given| given.map(|(heat, _)| *heat) == first);
        for table in std::mem::take(&mut material.tables) {
            let how = match first.filter(|_| is_one) {
                _ if table.what == MaterialValue::Expansion && !is_heated => continue,
                Some(heat) => {
                    let Some(rows) = table.at(heat) else {
                        im.refuse(table.line, &format!("no rows hold at {heat}, where all begins: give them"));
                        continue;
                    };
                    material.set(&table, &rows);
                    used.extend(given.iter().flatten().map(|(_, line)| *line));
                    format!("those at {heat} are taken, where all begins")
                }
                None if is_one => "those of the first row are taken".to_owned(),
                None => {
                    "those of the first row are taken, for its nodes do not all begin at one temperature".to_owned()
                }
            };
            im.change(table.line, &format!("values that depend on temperature: {how}"));
        }
    }
    im.materials.list = materials;
    used
}
