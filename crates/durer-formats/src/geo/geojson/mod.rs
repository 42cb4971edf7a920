//! GeoJSON (RFC 7946), read and written as a stream; also feature sets of ArcGIS, only read.

mod coordinates;
mod esri;
mod object;
mod read;
mod scan;
mod stream;
mod write;

pub(super) use coordinates::{finish_line, finish_ring};
pub(super) use object::{Cursor, RawMember, Text, kind};
pub(super) use read::Reader;
pub(super) use write::{Flat, position, write_feature, write_member, write_members};
