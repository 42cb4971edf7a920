//! Triangles, three ways, with 8 sub-pixel bits and the top-left rule.
