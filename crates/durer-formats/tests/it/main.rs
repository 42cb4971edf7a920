//! One test binary for the formats.

mod collada;
mod collada_eyes;
mod conformance_geo;
mod conformance_gltf;
mod conformance_height_map;
mod conformance_meshes;
mod conformance_svg;
mod crs;
mod drawing;
mod drawing_marks;
mod fuzz;
mod geo;
mod geo_curves;
mod geo_formats;
mod geo_package;
mod geo_shapefile;
mod gltf;
mod gltf_extensions;
mod gltf_file;
mod gltf_references;
mod height_map;
mod mesh_properties;
mod ply;
mod shared;
mod svg;
mod threemf;
