//! Numbers and texts as cells of tables.

pub use base::row_text::shortest as float;

/// Seconds to three digits.
pub fn seconds(seconds: f64) -> String {
    match seconds {
        s if s < 0.0995 => format!("{s:.4}"),
        s if s < 9.95 => format!("{s:.3}"),
        s => format!("{s:.1}"),
    }
}

/// The text of a number; empty where there is none, or it is not finite.
pub fn maybe(number: Option<f64>) -> String {
    number.filter(|number| number.is_finite()).map_or(String::new(), float)
}

/// A text as a field, quoted where it must be (RFC 4180).
pub fn field(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}
