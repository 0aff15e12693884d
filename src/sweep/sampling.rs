//! Points of the unit cube that are spread evenly. They depend on nothing but their arguments, on any machine.

/// Primitive polynomials and first direction numbers of S. Joe & F. Y. Kuo, SIAM J. Sci. Comput. 30 (2008), 2635-2654: degree, inner
/// coefficients as bits, m₁, m₂, ...; from the second dimension on.
const DIRECTIONS: [(u32, u32, &[u32]); 15] = [
    (1, 0, &[1]),
    (2, 1, &[1, 3]),
    (3, 1, &[1, 3, 1]),
    (3, 2, &[1, 1, 1]),
    (4, 1, &[1, 1, 3, 3]),
    (4, 4, &[1, 3, 5, 13]),
    (5, 2, &[1, 1, 5, 5, 17]),
    (5, 4, &[1, 1, 5, 5, 5]),
    (5, 7, &[1, 1, 7, 11, 19]),
    (5, 11, &[1, 1, 5, 1, 1]),
    (5, 13, &[1, 1, 1, 3, 11]),
    (5, 14, &[1, 3, 5, 5, 31]),
    (6, 1, &[1, 3, 3, 9, 7, 49]),
    (6, 13, &[1, 1, 1, 15, 21, 21]),
    (6, 16, &[1, 3, 1, 13, 27, 49]),
];

/// The largest number of dimensions of Sobol's sequence here.
pub const MOST_DIMENSIONS: usize = DIRECTIONS.len() + 1;

/// The coordinate of a point of Sobol's sequence, 0 or more and below 1. A seed other than 0 shifts all points of a dimension, digit by
/// digit, which preserves their uniformity.
pub fn sobol(point: u32, dimension: usize, seed: u64) -> f64 {
    let directions = directions(dimension);
    let gray = point ^ (point >> 1);
    let bits = (0..32).filter(|bit| gray >> bit & 1 == 1).fold(0, |sum, bit| sum ^ directions[bit as usize]);
    let shift = if seed == 0 { 0 } else { (mixed(seed ^ mixed(dimension as u64)) >> 32) as u32 };
    f64::from(bits ^ shift) / 4_294_967_296.0
}

/// The 32 direction numbers of a dimension.
fn directions(dimension: usize) -> [u32; 32] {
    let Some(&(degree, inner, first)) = dimension.checked_sub(1).and_then(|index| DIRECTIONS.get(index)) else {
        return std::array::from_fn(|k| 1 << (31 - k));
    };
    let degree = degree as usize;
    let mut v = [0_u32; 32];
    for k in 0..32 {
        v[k] = match first.get(k) {
            Some(m) => m << (31 - k),
            None => {
                let recurrence = v[k - degree] ^ (v[k - degree] >> degree);
                (1..degree).filter(|j| inner >> (degree - 1 - j) & 1 == 1).fold(recurrence, |sum, j| sum ^ v[k - j])
            }
        };
    }
    v
}

/// The coordinates in one dimension of all points of a Latin hypercube: one in each of as many equal parts as there are points.
pub fn latin_hypercube(points: usize, dimension: usize, seed: u64) -> Vec<f64> {
    let mut state = mixed(seed ^ mixed(dimension as u64 + 1));
    let mut next = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        mixed(state)
    };
    let mut parts: Vec<usize> = (0..points).collect();
    for k in (1..points).rev() {
        parts.swap(k, (next() % (k as u64 + 1)) as usize);
    }
    let unit = |bits: u64| (bits >> 11) as f64 / (1_u64 << 53) as f64;
    parts.into_iter().map(|part| (part as f64 + unit(next())) / points as f64).collect()
}

/// The finaliser of SplitMix64 (G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014): all bits of a number depend on all of another.
fn mixed(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one_in_each(values: impl Iterator<Item = f64>, parts: usize) -> bool {
        let mut seen = vec![false; parts];
        values.for_each(|value| seen[(value * parts as f64) as usize] = true);
        seen.iter().all(|seen| *seen)
    }

    #[test]
    fn first_points_of_sobol_are_those_of_the_paper() {
        // Joe & Kuo's program prints these for three dimensions.
        let points = [[0.0; 3], [0.5; 3], [0.75, 0.25, 0.25], [0.25, 0.75, 0.75], [0.375, 0.375, 0.625]];
        for (k, point) in points.iter().enumerate() {
            for (dimension, value) in point.iter().enumerate() {
                assert_eq!(sobol(k as u32, dimension, 0), *value, "{k} {dimension}");
            }
        }
    }

    #[test]
    fn each_dimension_has_one_point_in_each_part() {
        for seed in [0, 7] {
            for dimension in 0..MOST_DIMENSIONS {
                assert!(one_in_each((0..256).map(|k| sobol(k, dimension, seed)), 256), "{dimension}");
                assert!(one_in_each(latin_hypercube(100, dimension, seed).into_iter(), 100), "{dimension}");
            }
        }
    }

    #[test]
    fn pairs_of_the_first_dimensions_are_even_too() {
        // A (0, m, 2)-net: one point in each of 16 x 16 squares.
        let squares: std::collections::HashSet<(u32, u32)> =
            (0..256).map(|k| ((sobol(k, 0, 3) * 16.0) as u32, (sobol(k, 1, 3) * 16.0) as u32)).collect();
        assert_eq!(squares.len(), 256);
    }

    #[test]
    fn seeds_and_dimensions_differ() {
        assert_ne!(latin_hypercube(10, 0, 1), latin_hypercube(10, 0, 2));
        assert_ne!(latin_hypercube(10, 0, 1), latin_hypercube(10, 1, 1));
        assert_ne!(sobol(3, 1, 1), sobol(3, 1, 2));
    }
}
