//! `KHR_draco_mesh_compression`: a primitive's triangles and attributes as one Draco bitstream.
//!
//! The bitstream is decoded by the crate `draco-core` (feature `draco`), under the same limits as all other data; a
//! panic of the crate becomes an error.

use super::buffer::Source;
use super::json::{Draco, Whole};
use crate::{Error, Place, Result};

/// Returns the divisor of a normalized integer; `None` for types that are not normalized.
const fn largest(kind: draco_core::DataType) -> Option<f32> {
    match kind {
        draco_core::DataType::Int8 => Some(127.0),
        draco_core::DataType::Uint8 => Some(255.0),
        draco_core::DataType::Int16 => Some(32767.0),
        draco_core::DataType::Uint16 => Some(65535.0),
        _ => None,
    }
}

/// A decoded mesh.
#[derive(Debug)]
pub struct Packed(draco_core::Mesh);

/// One of its attributes.
#[derive(Debug, Clone, Copy)]
pub struct Attribute<'a> {
    attribute: &'a draco_core::PointAttribute,
    points: usize,
}

impl Packed {
    /// Decodes the mesh.
    ///
    /// # Errors
    /// If the bitstream is broken, or its mesh is above the limits.
    pub fn read(source: &Source<'_>, draco: &Draco, at: &str) -> Result<Option<Self>> {
        let at = format!("{at}.extensions.KHR_draco_mesh_compression");
        let bytes = source.view(draco.buffer_view.unwrap_or_default(), &at)?.whole()?;
        let rest = source.budget.rest();
        let limits = draco_core::DecodeLimits::default()
            .with_max_points(rest.primitives.saturating_mul(3))
            .with_max_faces(rest.primitives)
            .with_max_decoded_bytes(rest.decoded_bytes);
        let decode = || {
            let mut mesh = draco_core::Mesh::new();
            let mut buffer = draco_core::DecoderBuffer::new(&bytes).with_limits(limits);
            draco_core::MeshDecoder::new().decode(&mut buffer, &mut mesh).map(|()| mesh)
        };
        let mesh = match std::panic::catch_unwind(decode) {
            Ok(Ok(mesh)) => mesh,
            Ok(Err(why)) if why.kind() == draco_core::ErrorKind::LimitExceeded => {
                let (place, what) = (Place::Path(at), "decoded size of a Draco mesh");
                return Err(Error::Limit {
                    place,
                    what,
                    value: u64::MAX,
                    limit: rest.decoded_bytes,
                });
            }
            Ok(Err(why)) => return Err(Error::path(at, format!("broken Draco data: {why}"))),
            Err(_) => return Err(Error::path(at, "broken Draco data")),
        };
        let points = mesh.num_points();
        if mesh.faces().iter().flatten().any(|p| p.0 as usize >= points) {
            return Err(Error::path(at, "a triangle refers to a vertex that is not there"));
        }
        source.budget.bytes(mesh.num_faces() as u64 * 12, &at)?;
        Ok(Some(Self(mesh)))
    }

    /// Returns the vertex numbers of all triangles.
    pub fn indices(&self) -> Vec<u32> {
        self.0.faces().iter().flatten().map(|p| p.0).collect()
    }

    /// Returns an attribute by the number that the file knows it by.
    pub fn attribute(&self, id: Whole) -> Option<Attribute<'_>> {
        let attribute = self.0.attribute_by_unique_id(u32::try_from(id.0).ok()?)?;
        Some(Attribute { attribute, points: self.0.num_points() })
    }
}

impl Attribute<'_> {
    /// Returns N floats per vertex; integers become −1 … 1 or 0 … 1 where `normalized`.
    ///
    /// # Errors
    /// If the attribute has another number of components.
    pub fn floats<const N: usize>(
        &self,
        normalized: bool,
        source: &Source<'_>,
        at: &str,
    ) -> Result<Vec<[f32; N]>> {
        let components = usize::from(self.attribute.num_components());
        if components != N {
            return Err(Error::path(at, format!("has {components} components, {N} are needed")));
        }
        source.budget.bytes(self.points as u64 * 4 * N as u64, at)?;
        let mut values = self.attribute.read_f32s(self.points, N);
        let scale = largest(self.attribute.data_type()).filter(|_| normalized);
        if let Some(scale) = scale {
            values.iter_mut().for_each(|v| *v = (*v / scale).max(-1.0));
        }
        Ok(values.as_chunks::<N>().0.to_vec())
    }
}
