//! The properties of triangles: groups of colours, of texture coordinates, and of mixes of both.
//!
//! Source: 3MF Consortium, *Materials and Properties Extension* 1.2.1, 2021, chapters 2 to 6.

use durer::math::{Vec2, Vec3, Vec4};
use durer::scene::{Sampler, TextureFilter, Wrap};
use std::collections::HashMap;

/// Look of a point of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Look {
    /// Linear, straight alpha; multiplies the texture.
    pub color: Vec4,
    /// The id of a texture, and where in it the point is.
    pub texture: Option<(u64, Vec2)>,
}

impl Look {
    pub fn plain(color: Vec4) -> Self {
        Self { color, texture: None }
    }
}

/// A group of properties, counted from 0.
#[derive(Debug)]
pub(super) enum Group {
    /// Base materials and colour groups: names and linear colours.
    Colors(Vec<(String, Vec4)>),
    /// Places in the texture of this id; (0, 0) is the upper left corner.
    Coordinates(u64, Vec<Vec2>),
    /// Mixes of base materials: their group, which of them, and for each property how much of each.
    Composites(u64, Vec<u64>, Vec<Vec<f32>>),
    /// Layers, the lowest first: their groups, and for each property one of each group.
    Layers(Vec<Layer>, Vec<Vec<u64>>),
}

/// A layer of multiproperties.
#[derive(Debug, Clone, Copy)]
pub(super) struct Layer {
    pub group: u64,
    /// True if it multiplies the colours below instead of covering them.
    pub multiplies: bool,
}

/// A picture in the package.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct Texture2d {
    pub path: String,
    pub sampler: Sampler,
}

impl Texture2d {
    pub fn new(path: &str, [u, v]: [Option<&str>; 2], filter: Option<&str>) -> Self {
        let wrap = |style: Option<&str>| match style {
            Some("mirror") => Wrap::MirroredRepeat,
            Some("clamp" | "none") => Wrap::ClampToEdge,
            _ => Wrap::Repeat,
        };
        let filter =
            if filter == Some("nearest") { TextureFilter::Nearest } else { TextureFilter::Linear };
        let [wrap_u, wrap_v] = [wrap(u), wrap(v)];
        let sampler = Sampler { mag: filter, min: filter, wrap_u, wrap_v, ..Sampler::default() };
        Self { path: path.trim_start_matches('/').to_owned(), sampler }
    }
}

/// All groups and textures of a part, by id.
#[derive(Debug, Default)]
pub(super) struct Properties {
    pub groups: HashMap<u64, Group>,
    pub textures: HashMap<u64, Texture2d>,
}

impl Properties {
    /// Returns the look of a property; `None` if the part does not have it.
    pub fn look(&self, group: u64, index: u64) -> Option<Look> {
        match self.groups.get(&group)? {
            Group::Layers(layers, members) => {
                let members = members.get(usize::try_from(index).ok()?)?;
                let pairs = layers.iter().zip(members);
                let looks =
                    pairs.filter_map(|(layer, &i)| Some((layer, self.single(layer.group, i)?)));
                looks.fold(None, |below, (layer, look)| Some(over(below, layer, look)))
            }
            _ => self.single(group, index),
        }
    }

    /// Returns the look of a property that is not layering.
    fn single(&self, group: u64, index: u64) -> Option<Look> {
        let at = usize::try_from(index).ok()?;
        match self.groups.get(&group)? {
            Group::Colors(colors) => colors.get(at).map(|(_, color)| Look::plain(*color)),
            Group::Coordinates(texture, places) => {
                let place = *places.get(at)?;
                Some(Look { color: Vec4::ONE, texture: Some((*texture, place)) })
            }
            Group::Composites(materials, indices, mixes) => {
                Some(Look::plain(self.mix(*materials, indices, mixes.get(at)?)?))
            }
            Group::Layers(..) => None,
        }
    }

    /// Mixes base materials by their shares.
    fn mix(&self, materials: u64, indices: &[u64], shares: &[f32]) -> Option<Vec4> {
        let color = |i: u64| match self.groups.get(&materials)? {
            Group::Colors(colors) => colors.get(usize::try_from(i).ok()?).map(|c| c.1),
            _ => None,
        };
        let parts = indices.iter().zip(shares).filter(|(_, share)| **share > 0.0);
        let parts = parts.filter_map(|(&i, &share)| Some((color(i)?, share)));
        let (sum, whole) = parts
            .fold((Vec4::ZERO, 0.0), |(sum, whole), (c, share)| (sum + c * share, whole + share));
        (whole > 0.0 && whole.is_finite()).then(|| sum / whole)
    }

    /// Returns the name of a property, empty if it has none.
    pub fn name(&self, group: u64, index: u64) -> &str {
        let Some(Group::Colors(colors)) = self.groups.get(&group) else { return "" };
        let found = usize::try_from(index).ok().and_then(|i| colors.get(i));
        found.map_or("", |(name, _)| name)
    }

    /// Returns whether a layering has a picture on or under a layer that it cannot be joined with: another picture, or
    /// a colour that covers or shines through in part.
    pub fn is_simplified(&self, layers: &[Layer]) -> bool {
        let pictures = layers
            .iter()
            .filter(|l| matches!(self.groups.get(&l.group), Some(Group::Coordinates(..))));
        let covers = layers.iter().skip(1).any(|l| !l.multiplies);
        pictures.clone().count() > 1 || (pictures.count() == 1 && covers)
    }
}

/// Lays a look over the look below it.
fn over(below: Option<Look>, layer: &Layer, look: Look) -> Look {
    let Some(below) = below else { return look };
    if layer.multiplies {
        return Look { color: below.color * look.color, texture: look.texture.or(below.texture) };
    }
    if look.texture.is_some() {
        return look;
    }
    let alpha = look.color.w;
    let through = below.color.w * (1.0 - alpha);
    let sum = alpha + through;
    let rgb = |c: Vec4| Vec3::new(c.x, c.y, c.z);
    if alpha >= 1.0 || sum <= 0.0 {
        return look;
    }
    let mixed = (rgb(look.color) * alpha + rgb(below.color) * through) / sum;
    Look { color: mixed.extend(sum), texture: below.texture }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mixes_and_layers() {
        let colors =
            |c: [[f32; 4]; 2]| Group::Colors(c.map(|c| (String::new(), Vec4::from(c))).into());
        let base = colors([[1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]]);
        let glaze = colors([[0.0, 1.0, 0.0, 0.25], [0.5, 0.5, 0.5, 1.0]]);
        let layer = |group, multiplies| Layer { group, multiplies };
        let groups = [
            (1, base),
            (2, glaze),
            (3, Group::Composites(1, vec![0, 1], vec![vec![1.0, 3.0], vec![0.0, 0.0]])),
            (4, Group::Layers(vec![layer(1, false), layer(2, false)], vec![vec![1, 0]])),
            (5, Group::Layers(vec![layer(1, false), layer(2, true)], vec![vec![0, 1], vec![0]])),
            (6, Group::Layers(vec![layer(6, false)], vec![vec![0]])),
        ];
        let properties =
            Properties { groups: groups.into_iter().collect(), ..Properties::default() };
        let color = |group, index| properties.look(group, index).map(|l| l.color.to_array());
        assert_eq!(color(3, 0), Some([0.25, 0.0, 0.75, 1.0]));
        assert_eq!(color(3, 1), None);
        assert_eq!(color(4, 0), Some([0.0, 0.25, 0.75, 1.0]));
        assert_eq!(color(5, 0), Some([0.5, 0.0, 0.0, 1.0]));
        assert_eq!(color(5, 1), Some([1.0, 0.0, 0.0, 1.0]));
        assert_eq!((color(6, 0), color(1, 2), color(9, 0)), (None, None, None));
    }
}
