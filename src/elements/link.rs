//! Springs and dampers between two points.

/// Force against elongation; positive is tension.
#[derive(Debug, Clone, PartialEq)]
pub enum Law {
    /// k δ + preload.
    Linear { stiffness: f64, preload: f64 },
    /// Straight lines through (elongation, force); the end slopes go on.
    Table { points: Vec<[f64; 2]> },
    /// Acts for δ < −gap.
    CompressionOnly { stiffness: f64, gap: f64 },
    /// Acts for δ > gap.
    TensionOnly { stiffness: f64, gap: f64 },
}
