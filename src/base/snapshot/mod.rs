//! A snapshot: the numbers that a run under way needs to go on as if it had never stopped, as bytes.
//!
//! Each structure that changes from step to step lists its kept fields in one function. That function writes the bytes, and reads them back
//! into a structure built from the deck. The function destructures the whole type, so a forgotten new field does not compile. The bytes
//! contain no names and no types. Only the same program with the same deck can read them, and the caller checks both.

mod bytes;
mod shapes;
mod values;

pub use crate::{keep, keep_either};
pub use bytes::{Keep, Snapshot};
