//! Guards, which refuse steps or warn of them at named points.

pub mod breakage;
pub mod contacts;
pub mod drift;
pub mod guard;
pub mod joints;
pub mod jump;
pub mod links;
pub mod list;
pub mod massless;
pub mod mechanism;
pub mod mechanism_watch;
pub mod mode;
pub mod out_of_plane;
pub mod stability;
pub mod stability_tangent;
pub mod strain;
