//! TopoJSON (M. Bostock and C. Metcalf, *The TopoJSON Format Specification*, 2013 to 2017): geometries whose borders
//! are arcs that neighbours share.

mod arcs;
mod read;
mod write;

pub use read::read;
pub use write::write;

/// Returns whether a JSON text begins like a topology.
pub fn sniff(text: &[u8]) -> bool {
    /// Number of bytes searched for the type; members before it are short.
    const PROBE: usize = 4096;
    let head = text.get(..PROBE).unwrap_or(text);
    let at = head.windows(10).position(|w| w == b"\"Topology\"");
    at.is_some_and(|at| {
        let before = head.get(..at).unwrap_or_default().trim_ascii_end();
        let before = before.strip_suffix(b":").unwrap_or_default().trim_ascii_end();
        before.ends_with(b"\"type\"")
    })
}
