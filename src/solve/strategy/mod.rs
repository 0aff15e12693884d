//! Strategies of the iteration: the renewal of the matrix, and changes of a correction before it is added.

pub mod anderson;
pub mod arc_length;
pub mod augmentation;
pub mod beam_trees;
pub mod extrapolation;
pub mod line_search;
pub mod linearized_prediction;
pub mod refresh;
pub mod relaxation;
pub mod rotated_matrix;
pub mod stabilization;
pub mod strained_line;
