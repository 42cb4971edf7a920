//! Buffers and the views into them, charged to the limits.

use super::bytes::Bytes;
use super::container::Container;
use super::json::{BufferView, Root, Whole};
use super::meshopt;
use super::missing::missing;
use crate::budget::MODEL;
use crate::{Error, Found, Limits, Place, Resources, Result, Warning, uri};
use std::cell::Cell;

/// Amounts of the limits that have been used so far.
#[derive(Debug)]
pub struct Budget {
    limits: Limits,
    bytes: Cell<u64>,
    primitives: Cell<u64>,
    instances: Cell<u64>,
}

impl Budget {
    /// Creates an empty count.
    pub fn new(limits: Limits) -> Self {
        Self { limits, bytes: Cell::new(0), primitives: Cell::new(0), instances: Cell::new(0) }
    }

    /// Returns the limits with only the rest of the decoded bytes.
    pub fn rest(&self) -> Limits {
        let decoded_bytes = self.limits.decoded_bytes.saturating_sub(self.bytes.get());
        Limits { decoded_bytes, ..self.limits.clone() }
    }

    /// Charges bytes; called before the memory is allocated.
    pub fn bytes(&self, count: u64, at: &str) -> Result<()> {
        take(&self.bytes, count, self.limits.decoded_bytes, "decoded size", at)?;
        Ok(self.limits.work.keep(MODEL, count)?)
    }

    /// Charges triangles, lines or points.
    pub fn primitives(&self, count: u64, at: &str) -> Result<()> {
        take(&self.primitives, count, self.limits.primitives, "number of primitives", at)
    }

    /// Charges instances.
    pub fn instances(&self, count: u64, at: &str) -> Result<()> {
        take(&self.instances, count, self.limits.instances, "number of instances", at)
    }
}

fn take(used: &Cell<u64>, count: u64, limit: u64, what: &'static str, at: &str) -> Result<()> {
    let value = used.get().saturating_add(count);
    used.set(value);
    if value > limit {
        return Err(Error::Limit { place: Place::Path(at.to_owned()), what, value, limit });
    }
    Ok(())
}

/// The bytes of a buffer.
#[derive(Debug)]
enum Buffer<'a> {
    /// Bytes from a separate file, or from the JSON.
    Loaded(Vec<u8>),
    /// The binary chunk.
    Chunk(Bytes<'a>),
    /// There are no bytes, and the reason, for the error message.
    Missing(Missing),
}

/// A file that could not be had.
#[derive(Debug, Clone)]
struct Missing {
    place: Place,
    uri: String,
    message: String,
}

impl Buffer<'_> {
    fn bytes(&self) -> Result<Bytes<'_>> {
        match self {
            Self::Loaded(bytes) => Ok(Bytes::Held(bytes)),
            Self::Chunk(bytes) => Ok(bytes.clone()),
            Self::Missing(missing) => Err(missing.error()),
        }
    }
}

impl Missing {
    fn error(&self) -> Error {
        let Self { place, uri, message } = self.clone();
        Error::Resource { place, uri, message }
    }
}

/// A file with its buffers.
#[derive(Debug)]
pub struct Source<'a> {
    /// The JSON.
    pub root: &'a Root,
    /// Rest of the limits.
    pub budget: &'a Budget,
    buffers: Vec<Option<Buffer<'a>>>,
    unpacked: Vec<Option<Vec<u8>>>,
}

impl<'a> Source<'a> {
    /// Loads all buffers but the binary chunk, and unpacks compressed views. An element that needs an unavailable
    /// buffer fails later, when it is read.
    ///
    /// # Errors
    /// If a buffer is shorter than it says, or a view does not unpack.
    pub fn load(
        root: &'a Root,
        container: &Container<'a>,
        resources: &dyn Resources,
        budget: &'a Budget,
        warnings: &mut Vec<Warning>,
    ) -> Result<Self> {
        let buffers = (0..root.buffers.len())
            .map(|i| match load_buffer(root, i, container, resources, budget) {
                Ok((buffer, note)) => {
                    let place = Place::Path(format!("buffers[{i}].uri"));
                    warnings.extend(note.map(|message| Warning { place, message }));
                    Ok(buffer)
                }
                Err(Error::Resource { place, uri, message }) => {
                    Ok(Some(Buffer::Missing(Missing { place, uri, message })))
                }
                Err(error) => Err(error),
            })
            .collect::<Result<_>>()?;
        let mut source = Self { root, budget, buffers, unpacked: Vec::new() };
        source.unpacked =
            (0..root.buffer_views.len()).map(|i| source.unpack(i)).collect::<Result<_>>()?;
        Ok(source)
    }

    /// Returns the buffers that could not be had.
    pub fn missing(&self) -> impl Iterator<Item = Error> + '_ {
        self.buffers.iter().flatten().filter_map(|buffer| match buffer {
            Buffer::Missing(missing) => Some(missing.error()),
            Buffer::Loaded(_) | Buffer::Chunk(_) => None,
        })
    }

    /// Returns the bytes of a view, as long as its `byteLength`.
    ///
    /// # Errors
    /// If the view does not exist or its buffer has no data.
    pub fn view(&self, index: Whole, at: &str) -> Result<Bytes<'_>> {
        let i = index.index();
        let views = &self.root.buffer_views;
        let view = views.get(i).ok_or_else(|| missing("buffer view", index, views.len(), at))?;
        match self.unpacked.get(i) {
            Some(Some(bytes)) => Ok(Bytes::Held(bytes)),
            _ => {
                let at = format!("bufferViews[{i}]");
                if let Some(packing) = &view.extensions.meshopt {
                    // It was not unpacked, so its buffer is missing: this returns the reason.
                    self.slice(packing.buffer, packing.byte_offset, packing.byte_length, &at)?;
                }
                self.slice(view.buffer, view.byte_offset, length(view), &at)
            }
        }
    }

    fn slice(
        &self,
        buffer: Option<Whole>,
        offset: Whole,
        length: Whole,
        at: &str,
    ) -> Result<Bytes<'_>> {
        let i = buffer.map_or(usize::MAX, Whole::index);
        let buffer = self.buffers.get(i).ok_or_else(|| Error::path(at, "its buffer is missing"))?;
        let bytes = buffer.as_ref().map(Buffer::bytes).transpose()?.ok_or_else(|| {
            Error::path(format!("buffers[{i}]"), "it has neither a URI nor a binary chunk")
        })?;
        let end = offset.0.saturating_add(length.0);
        bytes.part(offset.0..end).ok_or_else(|| {
            Error::path(at, format!("ends at byte {end} of a buffer of {} bytes", bytes.len()))
        })
    }

    /// Returns the plain bytes of a compressed view; `None` for a plain one, and for one whose buffer is
    /// missing.
    fn unpack(&self, index: usize) -> Result<Option<Vec<u8>>> {
        match self.unpack_there(index) {
            Err(Error::Resource { .. }) => Ok(None),
            result => result,
        }
    }

    fn unpack_there(&self, index: usize) -> Result<Option<Vec<u8>>> {
        let view = &self.root.buffer_views[index];
        let Some(packing) = &view.extensions.meshopt else { return Ok(None) };
        let at = format!("bufferViews[{index}].extensions.EXT_meshopt_compression");
        let size = packing.count.0.saturating_mul(packing.byte_stride.0);
        if size < length(view).0 {
            let message = format!("unpacks to {size} bytes where {} are needed", length(view).0);
            return Err(Error::path(at, message));
        }
        let data = self.slice(packing.buffer, packing.byte_offset, packing.byte_length, &at)?;
        let data = data.whole()?;
        self.budget.bytes(size, &at)?;
        let packing = meshopt::Packing {
            count: packing.count.index(),
            stride: packing.byte_stride.index(),
            mode: &packing.mode,
            filter: packing.filter.as_deref().unwrap_or("NONE"),
        };
        let mut bytes = meshopt::decode(&data, packing).map_err(|why| Error::path(at, why))?;
        bytes.truncate(length(view).index());
        Ok(Some(bytes))
    }
}

/// Returns the view's length; one that is missing was refused by the check of references.
fn length(view: &BufferView) -> Whole {
    view.byte_length.unwrap_or_default()
}

/// Returns a buffer, if it has bytes, and the warning about its file.
fn load_buffer<'a>(
    root: &'a Root,
    index: usize,
    container: &Container<'a>,
    resources: &dyn Resources,
    budget: &Budget,
) -> Result<(Option<Buffer<'a>>, Option<String>)> {
    let buffer = &root.buffers[index];
    let at = format!("buffers[{index}]");
    let fallback = buffer.extensions.meshopt.as_ref().is_some_and(|m| m.fallback);
    let wanted = buffer.byte_length.unwrap_or_default();
    let too_few = |there: u64| {
        Error::path(&at, format!("byteLength is {} but there are {there} bytes", wanted.0))
    };
    match (&buffer.uri, &container.bin) {
        _ if fallback => Ok((None, None)),
        (Some(uri), _) => {
            budget.bytes(wanted.0, &at)?;
            // Files may be longer than the part that is used.
            let most = budget.rest().decoded_bytes.saturating_add(wanted.0);
            let Found { mut bytes, note } = uri::load(uri, &format!("{at}.uri"), resources, most)?;
            if (bytes.len() as u64) < wanted.0 {
                return Err(too_few(bytes.len() as u64));
            }
            bytes.truncate(wanted.index());
            Ok((Some(Buffer::Loaded(bytes)), note))
        }
        (None, Some(bin)) if index == 0 => {
            let bytes = bin.part(0..wanted.0).ok_or_else(|| too_few(bin.len()))?;
            Ok((Some(Buffer::Chunk(bytes)), None))
        }
        (None, _) => Ok((None, None)),
    }
}
