//! Groups of options that several subcommands share.

mod choices;
pub mod drawing;
mod look;
mod picture;
mod planes;
mod reading;
mod running;
mod view;

pub use choices::{Cull, Samples, Shading, Shadows, TileCoordinates, ToneMap, UpAxis};
pub use look::{Environment, LookArgs};
pub use picture::PictureArgs;
pub use planes::PlaneArgs;
pub use reading::ReadingArgs;
pub use running::RunningArgs;
pub use view::{Ortho, ViewArgs};
