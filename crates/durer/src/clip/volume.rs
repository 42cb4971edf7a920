//! Clipping in homogeneous coordinates against −w ≤ x, y, z ≤ w.
