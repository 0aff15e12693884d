//! A table of values of a material by temperature.

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
pub type MaterialRows = Vec<Vec<f64>>;

/// A table of values by temperature.
#[derive(Debug, Clone)]
pub struct MaterialTable {
    /// The line of its keyword.
    pub line: usize,
    /// What its rows give.
    pub what: MaterialValue,
    /// The rows of each temperature, which increases.
    pub groups: Vec<(f64, MaterialRows)>,
}

impl MaterialTable {
    /// A table with these rows, whose temperatures stand behind the values.
    pub fn new(line: usize, what: MaterialValue, all: impl Iterator<Item = Vec<f64>>) -> MaterialTable {
        let (count, missing) = match what {
            MaterialValue::Density | MaterialValue::Expansion => (1, 0.0),
            MaterialValue::Elastic | MaterialValue::Plastic => (2, 0.0),
            MaterialValue::Rate => (2, 1.0),
        };
        let mut groups: Vec<(f64, MaterialRows)> = Vec::new();
        for mut row in all {
            let heat = row.get(count).copied().unwrap_or(0.0);
            row.resize(count, missing);
            match groups.iter_mut().find(|(known, _)| *known == heat) {
                Some((_, rows)) => rows.push(row),
                None => groups.push((heat, vec![row])),
            }
        }
        MaterialTable { line, what, groups }
    }

    /// The rows of the first temperature.
    pub fn first(&self) -> &[Vec<f64>] {
        self.groups.first().map_or(&[], |(_, rows)| rows)
    }

    /// The rows at a temperature, linear between the two beside it; `None` where these have other strains.
    pub fn at(&self, heat: f64) -> Option<MaterialRows> {
        let mut groups: Vec<&(f64, MaterialRows)> = self.groups.iter().collect();
        groups.sort_by(|a, b| a.0.total_cmp(&b.0));
        let after = groups.partition_point(|group| group.0 <= heat);
        match (after.checked_sub(1).map(|last| groups[last]), groups.get(after)) {
            (Some((low, a)), Some((high, b))) if *low < heat => {
                let share = (heat - low) / (high - low);
                let strains = |rows: &MaterialRows| -> Vec<f64> { rows.iter().map(|row| row[row.len() - 1]).collect() };
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
