//! How far the yield stress has risen after some plastic strain.

use base::math::number::Number;

/// Yield stress against accumulated plastic strain.
#[derive(Debug, Clone, PartialEq)]
pub enum Hardening {
    /// σ_Y0 + H ε̄ᵖ (15); H = 0 is perfectly plastic.
    Linear {
        /// σ_Y0, before any plastic strain.
        yield_stress: f64,
        /// H, stress per plastic strain.
        modulus: f64,
    },
    /// Straight lines through (plastic strain, yield stress), constant beyond the last; what [`Hardening::table`] accepts.
    Table {
        /// The points, the first at plastic strain 0.
        points: Vec<[f64; 2]>,
    },
}

impl Hardening {
    /// Errors: an empty table, a first plastic strain other than 0, plastic strains not rising, yield stresses falling, not positive or not
    /// finite.
    pub fn table(points: Vec<[f64; 2]>) -> Result<Hardening, String> {
        let Some(first) = points.first() else {
            return Err("the hardening table is empty".into());
        };
        if first[0] != 0.0 {
            return Err(format!(
                "the first plastic strain is {}, but must be 0: pairs are [plastic strain, yield stress]",
                first[0]
            ));
        }
        for [plastic_strain, stress] in &points {
            if !(plastic_strain.is_finite() && stress.is_finite() && *stress > 0.0) {
                return Err(format!(
                    "the yield stress at plastic strain {plastic_strain} is {stress}, but both must be finite and the \
                     stress positive"
                ));
            }
        }
        for pair in points.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            if b[0] <= a[0] {
                return Err(format!("plastic strain {} follows {}, but plastic strains must rise", b[0], a[0]));
            }
            if b[1] < a[1] {
                return Err(format!("yield stress {} follows {}, but yield stresses must not fall", b[1], a[1]));
            }
        }
        Ok(Hardening::Table { points })
    }

    /// σ_Y0.
    #[inline]
    pub fn initial(&self) -> f64 {
        match self {
            Hardening::Linear { yield_stress, .. } => *yield_stress,
            Hardening::Table { points } => points[0][1],
        }
    }

    /// σ_Y − σ_Y0 at an accumulated plastic strain, and its slope; at a kink the slope to the right.
    #[inline(always)]
    pub fn rise<T: Number>(&self, accumulated: T) -> (T, T) {
        match self {
            Hardening::Linear { modulus, .. } => (T::splat(*modulus) * accumulated, T::splat(*modulus)),
            Hardening::Table { points } => accumulated.map_two(|accumulated| {
                let after = points.partition_point(|p| p[0] <= accumulated).max(1);
                let [x, y] = points[after - 1];
                let rise = y - points[0][1];
                match points.get(after) {
                    Some(next) => {
                        let slope = (next[1] - y) / (next[0] - x);
                        (rise + slope * (accumulated - x), slope)
                    }
                    None => (rise, 0.0),
                }
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_straight_between_its_points_and_flat_beyond() {
        let table = Hardening::table(vec![[0.0, 2.0], [0.5, 3.0], [1.0, 3.0], [2.0, 7.0]]).unwrap();
        assert_eq!(table.initial(), 2.0);
        let rises =
            [(0.0, 0.0, 2.0), (0.25, 0.5, 2.0), (0.5, 1.0, 0.0), (1.5, 3.0, 4.0), (2.0, 5.0, 0.0), (9.0, 5.0, 0.0)];
        for (at, rise, slope) in rises {
            assert_eq!(table.rise(at), (rise, slope), "at {at}");
        }
    }

    #[test]
    fn tables_that_are_none_are_refused_in_words() {
        let refused = |points: &[[f64; 2]]| Hardening::table(points.to_vec()).unwrap_err();
        assert!(refused(&[]).contains("empty"));
        assert!(refused(&[[0.1, 1.0]]).contains("must be 0"));
        assert!(refused(&[[0.0, 0.0]]).contains("positive"));
        assert!(refused(&[[0.0, 1.0], [f64::NAN, 1.0]]).contains("finite"));
        assert!(refused(&[[0.0, 1.0], [0.0, 2.0]]).contains("must rise"));
        assert!(refused(&[[0.0, 1.0], [0.1, 0.9]]).contains("must not fall"));
    }
}
