//! The architecture of src, held by reading it: who may import whom, how large things may become, and in how many places a
//! kind is named. `cargo test --test architecture -- --nocapture` prints what was counted.
//!
//! Lists of exceptions stand at the top of each file; they may only become shorter, and a test says when one has.

mod budget;
mod circles;
mod kinds;
mod names;
mod ratchet;
mod rows;
mod sizes;
mod source;
mod step;
