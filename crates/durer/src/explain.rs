//! Steps of algorithms as captions and small drawings.
