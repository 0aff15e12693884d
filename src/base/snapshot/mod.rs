//! A snapshot: the numbers that a run under way needs to go on as if it had never stopped, as bytes.
//!
//! What changes from step to step says, in one function, what of it is kept; the same function writes the bytes and reads them
//! back into what was built anew from the deck. A structure is taken apart whole there, so that a field that is added to it and
//! forgotten does not compile. The bytes hold no names and no types: they are of use to the very program that wrote them only,
//! with the same deck, which whoever keeps them has to make sure of.

mod bytes;
mod shapes;
mod values;

pub use crate::{keep, keep_either};
pub use bytes::{Keep, Snapshot};
