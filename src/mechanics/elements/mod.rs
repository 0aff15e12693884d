//! Deformable parts, links, contacts and pressure. An element sees the motion of its nodes and hands over forces and their
//! derivatives; of bodies, constraints and schemes it knows nothing. One more element is a file here and its line below.

pub mod bar;
pub mod beam;
pub mod bearing;
mod block;
pub mod bouc_wen;
pub mod bushing;
pub mod contact;
pub mod coordinate_law;
pub mod damper;
pub mod deteriorating;
pub mod heat;
pub mod hysteresis;
pub mod hysteretic_link;
pub mod isolator;
pub mod isotropic;
pub mod link;
pub mod link_failure;
pub mod memories;
pub mod path_law;
mod piecewise;
pub mod pinching;
pub mod pressure;
pub mod relative_rotation;
mod results;
pub mod shell;
mod slider;
pub mod slip;
pub mod superelement;
mod wandering;

pub use block::subtract;
pub use block::{Branches, ElementBlock, Elements, FailureCause, Force, Mechanics, Moduli, Results};
pub use results::{IntegrationPoint, LayerStress, ShellResultants};
pub use wandering::{Partners, Wandering};
