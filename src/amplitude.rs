//! stub
#[derive(Debug, Clone, PartialEq)]
pub enum Amplitude {
    Table { points: Vec<[f64; 2]> },
    Sine { angular_frequency: f64, phase: f64, start: f64, end: f64 },
    SineSquared { angular_frequency: f64, start: f64, end: f64 },
    Ramp { start: f64, end: f64 },
    Step { start: f64, end: f64 },
    Constant,
}
