//! File formats of durer: bytes to scenes and shapes, pictures and drawings to bytes.
//!
//! The library opens no file: readers take bytes and a [`Resources`] that finds referenced files, writers take a
//! `Write`. So the library and its tests need no files.

#![forbid(unsafe_code)]

mod arc;
pub mod archive;
mod budget;
mod cloud;
pub mod collada;
mod color;
pub mod css;
pub mod drawing;
pub mod e57;
mod error;
mod eye;
mod facets;
pub mod fbx;
mod foreign;
pub mod formula;
pub mod geo;
pub mod gltf;
pub mod gzip;
pub mod hdr;
pub mod height_map;
pub mod image;
pub mod las;
mod last_digit;
pub mod lesson;
mod model;
mod mtl;
mod number;
pub mod obj;
pub mod off;
pub mod picture;
mod piece;
mod pieces;
mod place;
pub mod ply;
pub mod png;
mod polygon;
mod sniff;
mod sqlite;
pub mod stl;
pub mod svg;
mod texels;
mod text;
pub mod threemf;
pub mod tiles;
mod unread;
mod uri;
pub mod wording;
mod xml;
pub mod xyz;

pub use error::{Error, Place, Result, Warning};
pub use model::{Found, Limits, Model, NoResources, Pose, ReadOptions, Resources};
pub use pieces::{Facts, Pieces, Visit};
pub use sniff::{ModelFormat, is_name_of_model, read_model};
pub use uri::data_uri;
