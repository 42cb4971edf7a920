//! FBX, the format of Autodesk's programs (feature `fbx`).
//!
//! Source: the library ufbx, which reads binary and ASCII files of the versions 3000 to 7700, without the
//! help of Autodesk's. It is written in C, and comes as the source in the crate of that name.
//!
//! The reader takes meshes (polygons of any shape, with normals, colours of vertices, all sets of texture coordinates,
//! and materials by face), the nodes with all their transforms, materials of Phong's kind and physical ones, pictures
//! beside the file or in it, cameras and lights. Lengths become metres. Skins, blend shapes and animations are left
//! out, and so are curves, NURBS and the refinement of subdivision surfaces, with a warning. Colours are sRGB values;
//! colours of physical materials and from Blender are linear.
//!
//! Values that depend on sines and cosines, such as transforms, are computed here and not in the library, which uses
//! the platform's functions, so that pictures are the same everywhere.

#[cfg(not(feature = "fbx"))]
mod no_scene;
#[cfg(feature = "fbx")]
mod scene;
#[cfg(not(feature = "fbx"))]
use no_scene as scene;

#[cfg(feature = "fbx")]
mod eye;
#[cfg(feature = "fbx")]
mod frame;
#[cfg(feature = "fbx")]
mod material;
#[cfg(feature = "fbx")]
mod mesh;
#[cfg(feature = "fbx")]
mod node;
#[cfg(feature = "fbx")]
mod picture;

pub use scene::read;

/// Returns whether the content begins as FBX does: binary, or ASCII with its usual comment.
pub(crate) fn sniff(bytes: &[u8]) -> bool {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
    [&b"Kaydara FBX Binary"[..], b"; FBX", b"FBXHeaderExtension"]
        .iter()
        .any(|head| text.starts_with(head))
}

#[cfg(all(test, feature = "fbx"))]
mod tests;
