//! One test binary for the formats.
