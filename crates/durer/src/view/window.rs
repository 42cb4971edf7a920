//! Windows in the world and viewports on the screen.
