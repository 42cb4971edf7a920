//! Pictures in the file or beside it.

use crate::{Found, Resources};
use std::collections::BTreeMap;
use ufbx::{Scene, Texture};

/// Source of pictures: contained in the file, at the paths that it names, or with the same name beside it, because many
/// paths are from the machine that wrote the file.
pub(super) struct Pictures<'s> {
    outside: &'s dyn Resources,
    inside: BTreeMap<String, &'s [u8]>,
}

impl<'s> Pictures<'s> {
    pub fn new(scene: &'s Scene, outside: &'s dyn Resources) -> Self {
        let held = scene.textures.into_iter().filter(|t| t.content.size > 0);
        let inside = held.filter_map(|t| Some((path(t)?, &t.content[..]))).collect();
        Self { outside, inside }
    }
}

impl Resources for Pictures<'_> {
    fn read(&self, path: &str, limit: u64) -> Result<Vec<u8>, String> {
        self.find(path, limit).map(|found| found.bytes)
    }

    fn find(&self, path: &str, limit: u64) -> Result<Found, String> {
        if let Some(bytes) = self.inside.get(path) {
            if bytes.len() as u64 > limit {
                return Err(format!("it has {} bytes, more than are allowed", bytes.len()));
            }
            return Ok(Found { bytes: bytes.to_vec(), note: None });
        }
        let beside = path.rsplit('/').next().filter(|name| *name != path && !name.is_empty());
        self.outside.find(path, limit).or_else(|why| match beside {
            Some(name) => self.outside.find(name, limit).map_err(|_| why),
            None => Err(why),
        })
    }
}

/// Returns the path of a texture's picture, with `/` as separator; `None` if it has none.
pub(super) fn path(texture: &Texture) -> Option<String> {
    let all = [&texture.relative_filename, &texture.filename, &texture.absolute_filename];
    let first = all.into_iter().map(AsRef::as_ref).find(|name: &&str| !name.is_empty());
    let first = match first {
        Some(path) => path.replace('\\', "/"),
        // One that is in the file needs no name.
        None if texture.content.size > 0 => format!("texture {}", texture.element.typed_id),
        None => return None,
    };
    let absolute = first.starts_with('/');
    let path = first.split('/').filter(|p| !matches!(*p, "" | ".")).collect::<Vec<_>>().join("/");
    Some(if absolute { format!("/{path}") } else { path }).filter(|p| !p.is_empty())
}
