//! stub, replaced at merge
#[derive(Debug, Clone, PartialEq)]
pub enum Amplitude { Table { points: Vec<[f64; 2]> }, Sine { angular_frequency: f64, phase: f64, start: f64, end: f64 }, SineSquared { angular_frequency: f64, start: f64, end: f64 }, Ramp { start: f64, end: f64 }, Step { start: f64, end: f64 }, Constant }
impl Amplitude {
    pub fn value(&self, t: f64) -> f64 {
        match self {
            Amplitude::Table { points } => {
                if t <= points[0][0] { return points[0][1]; }
                for w in points.windows(2) { if t <= w[1][0] { return w[0][1] + (w[1][1]-w[0][1])*(t-w[0][0])/(w[1][0]-w[0][0]); } }
                points[points.len()-1][1]
            }
            Amplitude::Sine { angular_frequency, phase, start, end } => if t < *start || t > *end { 0.0 } else { (angular_frequency*(t-start)+phase).sin() },
            Amplitude::SineSquared { angular_frequency, start, end } => if t < *start || t > *end { 0.0 } else { (angular_frequency*(t-start)).sin().powi(2) },
            Amplitude::Ramp { start, end } => ((t-start)/(end-start)).clamp(0.0,1.0),
            Amplitude::Step { start, end } => if t >= *start && t < *end { 1.0 } else { 0.0 },
            Amplitude::Constant => 1.0,
        }
    }
    pub fn rate(&self, t: f64) -> f64 { match self { Amplitude::Sine { angular_frequency, phase, start, .. } => angular_frequency*(angular_frequency*(t-start)+phase).cos(), _ => 0.0 } }
    pub fn second_rate(&self, t: f64) -> f64 { match self { Amplitude::Sine { angular_frequency, phase, start, .. } => -angular_frequency*angular_frequency*(angular_frequency*(t-start)+phase).sin(), _ => 0.0 } }
    pub fn integral(&self, t: f64) -> f64 { t }
    pub fn double_integral(&self, t: f64) -> f64 { 0.5*t*t }
}
