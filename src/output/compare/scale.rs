//! What a difference in a column is measured against: the column's range, and where a column does not vary, the largest number
//! of its kind in the file.

use super::ahead::Range;

/// Columns of one kind: components of one thing, or things of one unit that exchange with each other.
const KINDS: [&[&str]; 20] = [
    &["x", "y", "z"],
    &["ux", "uy", "uz"],
    &["rx", "ry", "rz"],
    &["qw", "qx", "qy", "qz"],
    &["vx", "vy", "vz"],
    &["wx", "wy", "wz"],
    &["ax", "ay", "az"],
    &["bx", "by", "bz"],
    &[
        "kinetic",
        "strain",
        "plastic",
        "viscous",
        "damping",
        "links",
        "external",
        "numerical",
        "total",
        "contact",
        "friction",
        "impact",
    ],
    &["px", "py", "pz"],
    &["lx", "ly", "lz"],
    &["fx", "fy", "fz", "force"],
    &["mx", "my", "mz"],
    &["N", "Qy", "Qz"],
    &["T", "My", "Mz"],
    &["N11", "N22", "N12"],
    &["M11", "M22", "M12"],
    &["Q1", "Q2"],
    &["von_mises_bottom", "von_mises_top"],
    &["s11", "s22", "s12", "von_mises"],
];

/// A column that varies by less than this part of the largest number of its kind is constant to rounding: steps by the
/// thousand gather that much from the last digits.
const ROUNDING: f64 = 1e-9;

/// The scale of each column, from its range in either table.
pub fn scales(names: &[&str], ranges: [&[Range]; 2]) -> Vec<f64> {
    let both = |i: usize| ranges[0][i].with(ranges[1][i]);
    let magnitude = |name: &str| {
        let kind = KINDS.iter().find(|kind| kind.contains(&name));
        let alike = |other: &str| other == name || kind.is_some_and(|kind| kind.contains(&other));
        let of_kind = (0..names.len()).filter(|&i| alike(names[i]));
        of_kind.map(|i| both(i).magnitude()).fold(0.0, f64::max)
    };
    let scale = |(i, name): (usize, &&str)| {
        let largest = magnitude(name);
        let constant = ranges.iter().all(|side| side[i].width() <= ROUNDING * largest);
        if constant { largest } else { both(i).width() }
    };
    names.iter().enumerate().map(scale).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_counts_and_rounding_does_not() {
        let range = |least, most| Range { least, most };
        let a = [range(-1.0, 1.0), range(-1e-14, 1e-14), range(5.0, 5.0)];
        let b = [range(-1.0, 3.0), range(0.0, 0.0), range(5.5, 5.5)];
        assert_eq!(scales(&["ux", "uy", "gap"], [&a, &b]), [4.0, 3.0, 5.5]);
        // Alone, the noise is all there is.
        assert_eq!(scales(&["uy"], [&a[1..2], &b[1..2]]), [2e-14]);
    }
}
