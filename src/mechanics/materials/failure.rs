//! When a point of the material fails.
//!
//! Without more a point fails where its accumulated plastic strain ε̄ᵖ reaches the failure strain. Where this depends on the stress or on
//! the rate, damage is summed,
//!
//! ```text
//!  D = ∫ dε̄ᵖ / (ε_f f(η) g(ε̄̇ᵖ)),   η = σ_m/σ_eq,
//! ```
//!
//! and the point fails where D reaches 1 (Johnson & Cook 1985). σ_m is a third of the sum of the normal stresses: η is 1/3 in tension, 0 in
//! shear, −1/3 in compression, 2/3 in equibiaxial tension. D uses η at the end of the step and the mean rate over the step.

/// The failure of a material.
#[derive(Debug, Clone, PartialEq)]
pub struct FailureCriterion {
    /// ε_f, above 0.
    pub strain: f64,
    /// f by the stress triaxiality η; `None` for 1.
    pub triaxiality: Option<FactorTable>,
    /// g by the rate of accumulated plastic strain, per time; `None` for 1.
    pub rate: Option<FactorTable>,
}

impl FailureCriterion {
    /// Failure at an accumulated plastic strain, above 0, whatever the stress and the rate.
    pub fn at(strain: f64) -> FailureCriterion {
        FailureCriterion { strain, triaxiality: None, rate: None }
    }

    /// True where the history holds damage as a separate number.
    #[inline(always)]
    pub fn sums_damage(&self) -> bool {
        self.triaxiality.is_some() || self.rate.is_some()
    }

    /// The damage that a plastic strain adds, at a triaxiality and a rate.
    pub fn damage(&self, plastic_strain: f64, triaxiality: f64, rate: f64) -> f64 {
        let factor = |table: &Option<FactorTable>, at: f64| table.as_ref().map_or(1.0, |table| table.at(at));
        plastic_strain / (self.strain * factor(&self.triaxiality, triaxiality) * factor(&self.rate, rate))
    }
}

/// A factor on straight lines between points, constant before the first and after the last.
#[derive(Debug, Clone, PartialEq)]
pub struct FactorTable {
    points: Vec<[f64; 2]>,
}

impl FactorTable {
    /// A table of points (argument, factor).
    ///
    /// # Errors
    /// A message where the table is empty, an argument does not rise, or a factor is not above zero.
    pub fn new(points: Vec<[f64; 2]>) -> Result<FactorTable, String> {
        if points.is_empty() {
            return Err("the table is empty".to_owned());
        }
        if let Some([at, factor]) = points.iter().find(|[_, factor]| *factor <= 0.0) {
            return Err(format!("the factor at {at} is {factor}, but must be above zero"));
        }
        if let Some(pair) = points.windows(2).find(|pair| pair[1][0] <= pair[0][0]) {
            return Err(format!("{} follows {}, but the first numbers of the pairs must rise", pair[1][0], pair[0][0]));
        }
        Ok(FactorTable { points })
    }

    /// The factor at an argument.
    pub fn at(&self, x: f64) -> f64 {
        let after = self.points.partition_point(|point| point[0] <= x);
        match (after.checked_sub(1).map(|before| self.points[before]), self.points.get(after)) {
            (Some([a, f]), Some(&[b, g])) => f + (g - f) * (x - a) / (b - a),
            (Some([_, f]), None) | (None, Some(&[_, f])) => f,
            (None, None) => 1.0,
        }
    }

    /// The first argument.
    pub fn first(&self) -> f64 {
        self.points[0][0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_straight_between_its_points_and_flat_beyond() {
        let table = FactorTable::new(vec![[-0.5, 4.0], [0.0, 2.0], [1.0, 1.0]]).expect("a table");
        for (x, factor) in [(-1.0, 4.0), (-0.5, 4.0), (-0.25, 3.0), (0.0, 2.0), (0.75, 1.25), (1.0, 1.0), (9.0, 1.0)] {
            assert_eq!(table.at(x), factor, "at {x}");
        }
    }

    #[test]
    fn damage_follows_stress_and_rate() {
        let table = |points: &[[f64; 2]]| FactorTable::new(points.to_vec()).ok();
        let failure = FailureCriterion {
            strain: 0.2,
            triaxiality: table(&[[0.0, 2.0], [1.0 / 3.0, 1.0]]),
            rate: table(&[[0.0, 1.0], [100.0, 1.5]]),
        };
        // In tension at rest, in shear at rest, in tension at half of the last rate.
        assert!((failure.damage(0.2, 1.0 / 3.0, 0.0) - 1.0).abs() < 1e-15);
        assert!((failure.damage(0.2, 0.0, 0.0) - 0.5).abs() < 1e-15);
        assert!((failure.damage(0.2, 1.0 / 3.0, 50.0) - 0.8).abs() < 1e-15);
    }

    #[test]
    fn tables_that_are_none_are_refused_in_words() {
        let refused = |points: &[[f64; 2]]| FactorTable::new(points.to_vec()).expect_err("no table");
        assert!(refused(&[]).contains("empty"));
        assert!(refused(&[[0.0, 0.0]]).contains("above zero"));
        assert!(refused(&[[0.0, 1.0], [0.0, 2.0]]).contains("must rise"));
    }
}
