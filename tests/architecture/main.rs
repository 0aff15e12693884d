//! The architecture of src, held by reading it.

mod rows;
