//! Colours of binary STL.

use crate::color;
use durer::math::Vec4;
use durer::scene::Material;

/// The bit of a facet's attributes that says which color it has.
pub(super) const PAINTED: u16 = 1 << 15;

/// Colors of facets.
///
/// Magics writes `COLOR=` and the body's RGBA into the header, and per facet 5 bits of red, green
/// and blue from the lowest bit on, with bit 15 set where the facet has the body's color. VisCAM
/// has no mark in the header, blue lowest, and bit 15 set where the facet has a color of its own.
/// Programs that write only the header leave all attributes 0: then all facets have the body's color.
pub(super) struct Palette {
    /// Linear values of sRGB bytes.
    table: [f32; 256],
    /// The body's color, where the file is Magics'.
    body: Option<Vec4>,
    /// Colour of highlights, from `MATERIAL=`.
    highlight: Option<Vec4>,
}

impl Palette {
    /// Creates the palette of a file that begins so.
    pub fn new(head: &[u8]) -> Self {
        let text = head.get(..80).unwrap_or_default();
        let mut palette = Self { table: color::linear_bytes(), body: None, highlight: None };
        let [diffuse, highlight] = match after(text, b"MATERIAL=") {
            Some([a, b, c, d, e, f, g, h]) => [Some([a, b, c, d]), Some([e, f, g, h])],
            None => [None; 2],
        };
        let body = after(text, b"COLOR=").or(diffuse);
        palette.body = body.map(|bytes| palette.of_bytes(bytes));
        palette.highlight = highlight.map(|bytes| palette.of_bytes(bytes));
        palette
    }

    fn of_bytes(&self, [r, g, b, a]: [u8; 4]) -> Vec4 {
        let linear = |v: u8| self.table[usize::from(v)];
        Vec4::new(linear(r), linear(g), linear(b), f32::from(a) / 255.0)
    }

    /// Returns the attribute bits that mark facets with their own colours; one of them suffices.
    pub fn marking_bits(&self) -> u16 {
        if self.body.is_some() { u16::MAX } else { PAINTED }
    }

    /// Returns the color of a facet with these attributes.
    pub fn color(&self, attribute: u16) -> Vec4 {
        let five = |bits: u16| ((bits & 31) * 255 / 31) as u8;
        let [low, middle, high] = [attribute, attribute >> 5, attribute >> 10].map(five);
        match (self.body, attribute & PAINTED != 0) {
            (Some(body), true) => body,
            (Some(_), false) => self.of_bytes([low, middle, high, 255]),
            (None, true) => self.of_bytes([high, middle, low, 255]),
            (None, false) => Material::default().base_color,
        }
    }

    /// Returns the material of all facets; `None` for the default material.
    pub fn material(&self, colored: bool) -> Option<Material> {
        let mut material = match (colored, self.body) {
            (true, _) => color::vertex_color_material(),
            (false, Some(body)) => {
                let name = "header color".to_owned();
                Material { name, base_color: body.truncate().extend(1.0), ..Material::default() }
            }
            (false, None) => return None,
        };
        if let Some(highlight) = self.highlight {
            material.specular = highlight.truncate();
        }
        Some(material)
    }
}

/// Returns the bytes after a mark.
fn after<const N: usize>(text: &[u8], mark: &[u8]) -> Option<[u8; N]> {
    let at = text.windows(mark.len()).position(|w| w == mark)?;
    text.get(at + mark.len()..)?.first_chunk().copied()
}
