//! From the world to the screen: windows and viewports, projection, culling.

pub mod cull;
pub mod layout;
pub mod projection;
pub mod window;
