//! stub
pub mod beam;
pub mod link;
