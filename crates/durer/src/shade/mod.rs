//! Light on surfaces.
