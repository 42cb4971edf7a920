//! Visible regions: what of the faces of a scene can be seen, as exact polygons.
