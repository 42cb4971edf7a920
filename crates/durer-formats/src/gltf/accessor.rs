//! Accessors: typed arrays in buffer views, interleaved, sparse, normalized.

use super::buffer::Source;
use super::bytes::Bytes;
use super::json::{Accessor, Root, Whole};
use super::missing::missing;
use crate::{Error, Result};

/// The type of one number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Component {
    /// Signed byte.
    I8,
    /// Unsigned byte.
    U8,
    /// Signed 16 bits.
    I16,
    /// Unsigned 16 bits.
    U16,
    /// Unsigned 32 bits.
    U32,
    /// 32-bit float.
    F32,
}

impl Component {
    /// Returns the component type for its number in the file, which is OpenGL's.
    pub fn of(number: Whole) -> Option<Self> {
        Some(match number.0 {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    /// Returns the size in bytes.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// Returns the value as a float; normalized integers become −1 … 1 or 0 … 1.
    fn float(self, bytes: &[u8], normalized: bool) -> f32 {
        let (value, max) = match (self, bytes) {
            (Self::I8, &[a]) => (f32::from(a as i8), 127.0),
            (Self::U8, &[a]) => (f32::from(a), 255.0),
            (Self::I16, &[a, b]) => (f32::from(i16::from_le_bytes([a, b])), 32767.0),
            (Self::U16, &[a, b]) => (f32::from(u16::from_le_bytes([a, b])), 65535.0),
            (Self::U32, &[a, b, c, d]) => {
                (u32::from_le_bytes([a, b, c, d]) as f32, 4_294_967_295.0)
            }
            (_, &[a, b, c, d]) => return f32::from_le_bytes([a, b, c, d]),
            _ => return 0.0,
        };
        if normalized { (value / max).max(-1.0) } else { value }
    }

    /// Returns the value as an unsigned number; `None` for signed and floating ones.
    fn unsigned(self, bytes: &[u8]) -> Option<u32> {
        match (self, bytes) {
            (Self::U8, &[a]) => Some(u32::from(a)),
            (Self::U16, &[a, b]) => Some(u32::from(u16::from_le_bytes([a, b]))),
            (Self::U32, &[a, b, c, d]) => Some(u32::from_le_bytes([a, b, c, d])),
            _ => None,
        }
    }
}

/// Shape, place and size of an accessor's data; checked against its view.
#[derive(Debug, Clone, Copy)]
pub struct Layout {
    /// The type of a number.
    pub component: Component,
    /// Numbers per element.
    pub lanes: usize,
    /// Elements.
    pub count: usize,
    /// Bytes from one element to the next.
    stride: usize,
    /// First byte in the view.
    offset: usize,
}

/// Returns the number of columns and of rows of a shape.
fn shape(name: &str) -> Option<(usize, usize)> {
    Some(match name {
        "SCALAR" => (1, 1),
        "VEC2" => (1, 2),
        "VEC3" => (1, 3),
        "VEC4" => (1, 4),
        "MAT2" => (2, 2),
        "MAT3" => (3, 3),
        "MAT4" => (4, 4),
        _ => return None,
    })
}

impl Layout {
    /// Returns the size of an element without gaps, in bytes.
    pub fn element(&self) -> usize {
        self.component.size() * self.lanes
    }

    /// Returns the layout of accessor `index`.
    ///
    /// # Errors
    /// If the type is unknown or the elements do not fit into the view.
    pub fn of(root: &Root, index: usize) -> Result<Self> {
        let at = || format!("accessors[{index}]");
        let accessor = root
            .accessors
            .get(index)
            .ok_or_else(|| missing("accessor", Whole(index as u64), root.accessors.len(), at()))?;
        let component = Component::of(accessor.component_type).ok_or_else(|| {
            Error::path(at() + ".componentType", "must be 5120, 5121, 5122, 5123, 5125 or 5126")
        })?;
        let (columns, rows) = shape(&accessor.shape).ok_or_else(|| {
            Error::path(at() + ".type", "must be SCALAR, VEC2 … VEC4, MAT2 … MAT4")
        })?;
        let count = accessor.count.ok_or_else(|| Error::path(at(), "`count` is missing"))?.index();
        let lanes = columns * rows;
        let mut layout =
            Self { component, lanes, count, stride: 0, offset: accessor.byte_offset.index() };
        layout.stride = layout.element();
        if let Some(view) = accessor.buffer_view {
            // Columns of small matrices begin at multiples of four bytes; no such matrix is read.
            let padded = columns * (rows * component.size()).next_multiple_of(4);
            layout.stride = if columns > 1 { padded } else { layout.element() };
            layout.fit(root, view, &at())?;
        }
        if let Some(sparse) = &accessor.sparse {
            check_sparse(root, accessor, &layout, &at())?;
            debug_assert!(sparse.count.index() <= count);
        }
        Ok(layout)
    }

    /// Applies the view's stride and checks that all elements are inside the view.
    fn fit(&mut self, root: &Root, view: Whole, at: &str) -> Result<()> {
        let view = root
            .buffer_views
            .get(view.index())
            .ok_or_else(|| missing("buffer view", view, root.buffer_views.len(), at))?;
        // A stride of zero is not allowed, but some programs write it for "tightly packed".
        if let Some(stride) = view.byte_stride.filter(|s| s.0 != 0) {
            if stride.index() < self.stride {
                let message = format!("a stride of {} for elements of {}", stride.0, self.stride);
                return Err(Error::path(at, message));
            }
            self.stride = stride.index();
        }
        let length = view.byte_length.unwrap_or_default().0;
        let end = self.end();
        if end > u128::from(length) {
            return Err(Error::path(at, format!("ends at byte {end} of a view of {length}")));
        }
        Ok(())
    }

    /// Returns the byte after the last element, counted from the start of the view.
    fn end(&self) -> u128 {
        match self.count as u128 {
            0 => 0,
            n => self.offset as u128 + (n - 1) * self.stride as u128 + self.element() as u128,
        }
    }
}

/// Returns the layouts of a sparse accessor's indices and values.
fn sparse_layouts(
    root: &Root,
    accessor: &Accessor,
    whole: &Layout,
    at: &str,
) -> Result<[Layout; 2]> {
    let sparse = accessor.sparse.clone().unwrap_or_default();
    let component = Component::of(sparse.indices.component_type)
        .filter(|c| matches!(c, Component::U8 | Component::U16 | Component::U32))
        .ok_or_else(|| Error::path(format!("{at}.sparse.indices"), "must be unsigned integers"))?;
    let layout = |component: Component, lanes: usize, offset: Whole| Layout {
        component,
        lanes,
        count: sparse.count.index(),
        stride: component.size() * lanes,
        offset: offset.index(),
    };
    let mut indices = layout(component, 1, sparse.indices.byte_offset);
    let mut values = layout(whole.component, whole.lanes, sparse.values.byte_offset);
    let view = |view: Option<Whole>| view.unwrap_or(Whole(u64::MAX));
    indices.fit(root, view(sparse.indices.buffer_view), &format!("{at}.sparse.indices"))?;
    values.fit(root, view(sparse.values.buffer_view), &format!("{at}.sparse.values"))?;
    Ok([indices, values])
}

fn check_sparse(root: &Root, accessor: &Accessor, whole: &Layout, at: &str) -> Result<()> {
    let count = accessor.sparse.as_ref().map_or(0, |s| s.count.index());
    if count > whole.count {
        let message = format!("{count} values replaced of {}", whole.count);
        return Err(Error::path(format!("{at}.sparse.count"), message));
    }
    sparse_layouts(root, accessor, whole, at).map(|_| ())
}

/// Number of elements without data that are always accepted.
const MOST_BARE: usize = 1 << 20;

impl Source<'_> {
    /// Returns the layout of an accessor.
    fn layout(&self, index: Whole, at: &str) -> Result<Layout> {
        let count = self.root.accessors.len();
        if index.index() >= count {
            return Err(missing("accessor", index, count, at));
        }
        Layout::of(self.root, index.index())
    }

    /// Passes on an accessor's elements in order, in pieces, with the bytes from one element to the next.
    fn elements(
        &self,
        index: Whole,
        layout: &Layout,
        at: &str,
        mut take: impl FnMut(&[u8], usize),
    ) -> Result<()> {
        let accessor = &self.root.accessors[index.index()];
        match accessor.buffer_view {
            Some(view) if accessor.sparse.is_none() => {
                let bytes = occupied(&self.view(view, at)?, layout, at)?;
                bytes.pieces(layout.stride, |piece| take(piece, layout.stride))
            }
            _ => {
                take(&self.packed(index, layout, at)?, layout.element());
                Ok(())
            }
        }
    }

    /// Refuses more elements without data than the largest accessor with data has: sparse deformations give data only
    /// for the vertices that move, but nothing else needs zeros.
    fn check_bare(&self, count: usize, at: &str) -> Result<()> {
        let with_data = self.root.accessors.iter().filter(|a| a.buffer_view.is_some());
        let has_reason = count <= MOST_BARE
            || with_data.filter_map(|a| a.count).any(|of_data| of_data.index() >= count);
        if has_reason {
            return Ok(());
        }
        let message = format!(
            "an accessor of {count} elements has no `bufferView`, and so no data; \
             accessors with data have fewer"
        );
        Err(Error::path(at, message))
    }

    /// Returns the elements without gaps, with sparse values inserted.
    fn packed(&self, index: Whole, layout: &Layout, at: &str) -> Result<Vec<u8>> {
        let accessor = &self.root.accessors[index.index()];
        let mut bytes = match accessor.buffer_view {
            Some(view) => gather(&self.view(view, at)?, layout, at)?,
            None => {
                self.check_bare(layout.count, at)?;
                let size = (layout.count as u64).saturating_mul(layout.element() as u64);
                self.budget.bytes(size, at)?;
                vec![0; layout.count * layout.element()]
            }
        };
        if let Some(sparse) = &accessor.sparse {
            let at = format!("accessors[{}]", index.0);
            let [places, values] = sparse_layouts(self.root, accessor, layout, &at)?;
            let view = |view: Option<Whole>| self.view(view.unwrap_or_default(), &at);
            let places_bytes = gather(&view(sparse.indices.buffer_view)?, &places, &at)?;
            let values = gather(&view(sparse.values.buffer_view)?, &values, &at)?;
            let places = places_bytes
                .chunks_exact(places.component.size())
                .map(|b| places.component.unsigned(b));
            for (place, value) in places.zip(values.chunks_exact(layout.element())) {
                let place = place.map_or(usize::MAX, |p| p as usize);
                let element =
                    bytes.chunks_exact_mut(layout.element()).nth(place).ok_or_else(|| {
                        let message = format!("element {place} of {} is replaced", layout.count);
                        Error::path(format!("{at}.sparse.indices"), message)
                    })?;
                element.copy_from_slice(value);
            }
        }
        Ok(bytes)
    }

    /// Returns elements of N floats; integers are converted, and normalized if the accessor requires it.
    ///
    /// # Errors
    /// If the accessor has another shape, or its data are missing.
    pub fn floats<const N: usize>(&self, index: Whole, at: &str) -> Result<Vec<[f32; N]>> {
        self.vectors(index, at)
    }

    /// Returns [`Self::floats`] as vectors.
    ///
    /// # Errors
    /// As [`Self::floats`].
    pub fn vectors<T: From<[f32; N]>, const N: usize>(
        &self,
        index: Whole,
        at: &str,
    ) -> Result<Vec<T>> {
        let layout = self.layout(index, at)?;
        if layout.lanes != N {
            let message = format!("has {} numbers per element, {N} are needed", layout.lanes);
            return Err(Error::path(at, message));
        }
        let normalized = self.root.accessors[index.index()].normalized;
        self.budget.bytes((layout.count as u64).saturating_mul(4 * N as u64), at)?;
        let (component, mut all) = (layout.component, Vec::new());
        self.elements(index, &layout, at, |bytes, stride| {
            all.reserve_exact(layout.count - all.len());
            match component.size() {
                1 => decode(bytes, stride, |b: [u8; 1]| component.float(&b, normalized), &mut all),
                2 => decode(bytes, stride, |b: [u8; 2]| component.float(&b, normalized), &mut all),
                _ if component == Component::F32 => {
                    decode(bytes, stride, f32::from_le_bytes, &mut all);
                }
                _ => decode(bytes, stride, |b: [u8; 4]| component.float(&b, normalized), &mut all),
            }
        })?;
        Ok(all)
    }

    /// Returns elements of N unsigned integers.
    ///
    /// # Errors
    /// As [`Self::floats`], and for signed or floating numbers.
    pub fn integers<const N: usize>(&self, index: Whole, at: &str) -> Result<Vec<[u32; N]>> {
        let layout = self.layout(index, at)?;
        if layout.lanes != N
            || matches!(layout.component, Component::I8 | Component::I16 | Component::F32)
        {
            return Err(Error::path(at, format!("must have {N} unsigned integers per element")));
        }
        self.budget.bytes((layout.count as u64).saturating_mul(4 * N as u64), at)?;
        let mut all = Vec::new();
        self.elements(index, &layout, at, |bytes, stride| {
            all.reserve_exact(layout.count - all.len());
            match layout.component.size() {
                1 => decode(bytes, stride, |[a]: [u8; 1]| u32::from(a), &mut all),
                2 => decode(bytes, stride, |b| u32::from(u16::from_le_bytes(b)), &mut all),
                _ => decode(bytes, stride, u32::from_le_bytes, &mut all),
            }
        })?;
        Ok(all)
    }
}

/// Adds elements of N numbers of SIZE bytes each; there may be other bytes between them.
fn decode<const SIZE: usize, const N: usize, V, T: From<[V; N]>>(
    bytes: &[u8],
    stride: usize,
    number: impl Fn([u8; SIZE]) -> V,
    to: &mut Vec<T>,
) {
    let element = |numbers: &[[u8; SIZE]; N]| T::from(numbers.map(&number));
    if stride == SIZE * N {
        to.extend(bytes.as_chunks::<SIZE>().0.as_chunks::<N>().0.iter().map(element));
    } else {
        let strides = bytes.chunks(stride);
        to.extend(strides.filter_map(|b| b.as_chunks::<SIZE>().0.first_chunk().map(element)));
    }
}

/// Returns the bytes of a view from an accessor's first element to its last.
fn occupied<'a>(view: &Bytes<'a>, layout: &Layout, at: &str) -> Result<Bytes<'a>> {
    let offset = if layout.count == 0 { 0 } else { layout.offset as u64 };
    let part = u64::try_from(layout.end()).ok().and_then(|end| view.part(offset..end));
    part.ok_or_else(|| Error::path(at, "its elements are outside of their view"))
}

/// Returns the elements one after the other, without the bytes between them.
fn gather(view: &Bytes<'_>, layout: &Layout, at: &str) -> Result<Vec<u8>> {
    let (element, stride) = (layout.element(), layout.stride);
    let bytes = occupied(view, layout, at)?.whole()?;
    if stride == element {
        return Ok(bytes.into_owned());
    }
    Ok(bytes.chunks(stride).flat_map(|e| &e[..element]).copied().collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normalized_numbers_reach_their_ends() {
        let float = |c: Component, bytes: &[u8]| c.float(bytes, true);
        assert_eq!(float(Component::U8, &[255]), 1.0);
        assert_eq!(float(Component::I8, &[0x80]), -1.0);
        assert_eq!(float(Component::I8, &[0x81]), -1.0);
        assert_eq!(float(Component::U16, &[0xff, 0xff]), 1.0);
        assert_eq!(float(Component::I16, &[0x00, 0x80]), -1.0);
        assert_eq!(float(Component::I16, &[0x00, 0x40]), 16384.0 / 32767.0);
        assert_eq!(Component::U16.float(&[1, 2], false), 513.0);
    }
}
