//! Pictures of a material library: each read once, single channels joined where the scene wants
//! them in one picture.

use crate::{Found, Limits, Model, Place, Resources, image, texels};
use durer::scene::Image;
use std::collections::HashMap;

/// Pictures by their sources, as indices into the scene's images.
pub(crate) struct Images<'a> {
    resources: &'a dyn Resources,
    /// Rest of the limit for decoded pictures.
    left: Limits,
    decoded: HashMap<String, Option<Image>>,
    numbers: HashMap<Vec<Option<String>>, usize>,
}

impl<'a> Images<'a> {
    pub fn new(resources: &'a dyn Resources, limits: Limits) -> Self {
        Self { resources, left: limits, decoded: HashMap::new(), numbers: HashMap::new() }
    }

    /// Returns the picture behind `path`; `None` after a warning.
    fn decode(&mut self, model: &mut Model, path: &str) -> Option<&Image> {
        if !self.decoded.contains_key(path) {
            let found = self.resources.find(path, self.left.decoded_bytes);
            let image = found.and_then(|Found { bytes, note }| {
                if let Some(note) = note {
                    model.warn(Place::Whole, format!("texture `{path}`: {note}"));
                }
                image::decode(&bytes, path, &self.left).map_err(|e| e.to_string())
            });
            let image = image
                .map_err(|why| {
                    model.warn(Place::Whole, format!("texture `{path}` is left out: {why}"));
                })
                .ok();
            if let Some(image) = &image {
                let bytes = 4 * image.data.len() as u64;
                self.left.decoded_bytes = self.left.decoded_bytes.saturating_sub(bytes);
            }
            self.decoded.insert(path.to_owned(), image);
        }
        self.decoded.get(path)?.as_ref()
    }

    /// Returns whether a picture has any pixel that is not opaque.
    pub fn has_alpha(&mut self, model: &mut Model, path: &str) -> bool {
        let image = self.decode(model, path);
        image.is_some_and(|image| image.data.iter().any(|pixel| pixel[3] < 255))
    }

    /// Returns whether a picture shows normals rather than heights; `None` if it cannot be read, after a warning.
    /// Pictures that are grey, or named after heights, are not decoded for it.
    pub fn shows_normals(&mut self, model: &mut Model, path: &str) -> Option<bool> {
        let name = path.to_ascii_lowercase();
        if ["bump", "height", "disp"].iter().any(|word| name.contains(word)) {
            return Some(false);
        }
        let is_new = !self.decoded.contains_key(path);
        let bytes = self.resources.read(path, self.left.decoded_bytes);
        if is_new && bytes.is_ok_and(|bytes| image::is_grey(&bytes)) {
            return Some(false);
        }
        self.decode(model, path).map(is_normal_map)
    }

    /// Returns the scene's number of an unchanged picture.
    pub fn whole(&mut self, model: &mut Model, path: &str) -> Option<usize> {
        let key = vec![Some(path.to_owned())];
        if let Some(&number) = self.numbers.get(&key) {
            return Some(number);
        }
        let image = self.decode(model, path)?.clone();
        Some(self.add(model, key, image))
    }

    /// Returns the scene's number of a picture joined from others by `join`, which is given a pixel
    /// of each where it could be read. Smaller pictures are enlarged by repeating texels.
    pub fn joined<const N: usize>(
        &mut self,
        model: &mut Model,
        paths: [Option<&str>; N],
        join: impl Fn([Option<[u8; 4]>; N]) -> [u8; 4],
    ) -> Option<usize> {
        let key: Vec<_> = paths.iter().map(|p| p.map(str::to_owned)).chain([None]).collect();
        if let Some(&number) = self.numbers.get(&key) {
            return Some(number);
        }
        for path in paths.into_iter().flatten() {
            self.decode(model, path);
        }
        let found = paths.map(|p| self.decoded.get(p?)?.as_ref());
        let [width, height] = texels::size(found)?;
        let name = paths.into_iter().flatten().collect::<Vec<_>>().join(" + ");
        let image = Image { name, width, height, data: texels::join(found, join) };
        Some(self.add(model, key, image))
    }

    fn add(&mut self, model: &mut Model, key: Vec<Option<String>>, image: Image) -> usize {
        let number = model.scene.images.len();
        model.scene.images.push(image);
        self.numbers.insert(key, number);
        number
    }
}

/// Returns whether a picture is blue on the whole, with red and green in the middle, as normals are
/// that look away from their surface.
fn is_normal_map(image: &Image) -> bool {
    let sum = |channel: usize| image.data.iter().map(|p| u64::from(p[channel])).sum::<u64>();
    let count = (image.data.len() as u64).max(1);
    let [red, green, blue] = [0, 1, 2].map(|channel| sum(channel) / count);
    let middle = 80..=176;
    middle.contains(&red) && middle.contains(&green) && blue >= 160 && blue > red.max(green) + 30
}

/// Returns a pixel as one grey value: Rec. 709 luma of its stored values.
pub(crate) fn grey([r, g, b, _]: [u8; 4]) -> u8 {
    ((u32::from(r) * 54 + u32::from(g) * 183 + u32::from(b) * 19) >> 8) as u8
}
