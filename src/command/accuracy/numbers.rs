//! Numbers in decks and for readers.

/// A number with three digits that is not larger.
pub fn rounded_down(value: f64) -> String {
    let unit = 10f64.powf(value.log10().floor() - 2.0);
    // The quotient of a number with three digits may be a little less than whole.
    number(unit * (value / unit + 1e-9).floor())
}

/// A number as decks write it, with three digits.
pub fn number(value: f64) -> String {
    format!("{value:.2e}")
}

/// A number for readers, with two digits.
pub fn two_digits(value: f64) -> String {
    format!("{value:.1e}")
}
