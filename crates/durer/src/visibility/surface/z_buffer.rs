//! The z-buffer: the production path.
