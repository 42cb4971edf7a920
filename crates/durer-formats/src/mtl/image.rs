//! Pictures of a material library: each read once, single channels joined where the scene wants
//! them in one picture.

use crate::{Limits, Model, Place, Resources, image};
use durer::scene::Image;
use std::collections::HashMap;

/// Pictures by what they were made of, as indices into the scene's images.
pub(crate) struct Images<'a> {
    resources: &'a dyn Resources,
    /// What may still be decoded.
    left: Limits,
    decoded: HashMap<String, Option<Image>>,
    numbers: HashMap<Vec<Option<String>>, usize>,
}

impl<'a> Images<'a> {
    pub fn new(resources: &'a dyn Resources, limits: Limits) -> Self {
        Self { resources, left: limits, decoded: HashMap::new(), numbers: HashMap::new() }
    }

    /// The picture behind `path`; `None` after a warning.
    fn decode(&mut self, model: &mut Model, path: &str) -> Option<&Image> {
        if !self.decoded.contains_key(path) {
            let read = self.resources.read(path, self.left.decoded_bytes);
            let image = read.and_then(|bytes| {
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

    /// The scene's number of a picture as it is.
    pub fn whole(&mut self, model: &mut Model, path: &str) -> Option<usize> {
        let key = vec![Some(path.to_owned())];
        if let Some(&number) = self.numbers.get(&key) {
            return Some(number);
        }
        let image = self.decode(model, path)?.clone();
        Some(self.add(model, key, image))
    }

    /// The scene's number of a picture joined from others by `join`, which is given a pixel of
    /// each where it could be read. Smaller pictures are enlarged by repeating texels.
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
        let width = found.iter().flatten().map(|i| i.width).max()?;
        let height = found.iter().flatten().map(|i| i.height).max()?;
        let pixel = |image: &Image, x: u32, y: u32| {
            let scale =
                |at: u32, to: u32, from: u32| u64::from(at) * u64::from(to) / u64::from(from);
            let (x, y) = (scale(x, image.width, width), scale(y, image.height, height));
            image.data.get((y * u64::from(image.width) + x) as usize).copied()
        };
        let at = |x, y| join(found.map(|image| image.and_then(|i| pixel(i, x, y))));
        let data = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| at(x, y));
        let name = paths.into_iter().flatten().collect::<Vec<_>>().join(" + ");
        let image = Image { name, width, height, data: data.collect() };
        Some(self.add(model, key, image))
    }

    fn add(&mut self, model: &mut Model, key: Vec<Option<String>>, image: Image) -> usize {
        let number = model.scene.images.len();
        model.scene.images.push(image);
        self.numbers.insert(key, number);
        number
    }
}

/// A pixel as one grey value: Rec. 709 luma of its stored values.
pub(super) fn grey([r, g, b, _]: [u8; 4]) -> u8 {
    ((u32::from(r) * 54 + u32::from(g) * 183 + u32::from(b) * 19) >> 8) as u8
}
