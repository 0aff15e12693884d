//! Values of materials by temperature: those at the start are taken, where all nodes of the material begin at one temperature.

use crate::file_content::MaterialCard;
use crate::flat_mesh::FlatMesh;
use crate::importer::Importer;
use crate::material_table::{MaterialTable, MaterialValue};
use std::collections::{BTreeSet, HashMap};

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
