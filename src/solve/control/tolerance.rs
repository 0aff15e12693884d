//! Controllers whose steps follow a tolerance.

/// A controller that can run again with another tolerance.
pub trait FollowTolerance {
    /// Prepares for a run with this tolerance of the error of its steps, none of which is longer than `longest`; `None`: as long as the
    /// controller allows.
    fn follow(&mut self, tolerance: f64, longest: Option<f64>);
}
