//! Cameras chosen by name, by angles, and fitted to a scene.
