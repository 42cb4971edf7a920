//! Binary STL in pieces.

use super::binary::{BINARY, BYTES, Facets, vertices};
use super::palette::Palette;
use super::{HEADER, RECORD, count_in_header};
use crate::budget::MODEL;
use crate::model::count_infinite;
use crate::pieces::{Facts, Visit, union};
use crate::{Error, Model, Place, ReadOptions, Result};
use durer::math::{DMat4, Vec3};
use durer::scene::{Aabb, Instance, Mesh, Part, Scene, UpAxis};
use durer::view::projection::PIECE;
use durer::work::Charge;
use std::io::{Read, Seek, SeekFrom};

/// Bytes for a triangle on the screen.
const ON_SCREEN: u64 = 52;

/// Triangles that are read at a time.
const SKIM: u64 = 1024;

/// A binary STL file that is read in pieces.
pub struct Pieces<R> {
    head: [u8; HEADER],
    source: R,
    /// Triangles of the file, and of a piece.
    count: u64,
    at_once: usize,
    palette: Palette,
    options: ReadOptions,
    looked: Option<Looked>,
    /// Bytes of some triangles, and the positions of a piece.
    bytes: Vec<u8>,
    positions: Vec<Vec3>,
    _charge: Charge,
}

/// Facts about the file after the first reading.
#[derive(Debug, Clone, Copy, Default)]
struct Looked {
    infinite: usize,
    colored: bool,
}

impl<R: Read + Seek> Pieces<R> {
    /// Creates a file that begins with `head`, for which [`super::is_whole_binary`] holds, in pieces of about
    /// this many triangles.
    ///
    /// # Errors
    /// [`Error::Limit`] for too many triangles, [`durer::Error::Memory`] if the budget has no room for a piece.
    pub fn new(
        head: &[u8; HEADER],
        source: R,
        at_once: usize,
        options: &ReadOptions,
    ) -> Result<Self> {
        let count = u64::from(count_in_header(head).unwrap_or(0));
        let limit = options.limits.primitives.min(durer::pipeline::MOST_ITEMS);
        if count > limit {
            let what = "number of triangles";
            return Err(Error::Limit { place: Place::Whole, what, value: count, limit });
        }
        let at_once = at_once.div_ceil(PIECE).max(1) * PIECE;
        let _charge = options.limits.work.charge(MODEL, (at_once as u64).min(count) * BYTES)?;
        let palette = Palette::new(head);
        let (head, options, looked) = (*head, options.clone(), None);
        let (bytes, positions) = (Vec::new(), Vec::new());
        Ok(Self {
            head,
            source,
            count,
            at_once,
            palette,
            options,
            looked,
            bytes,
            positions,
            _charge,
        })
    }

    /// Reads some triangles' bytes.
    fn fill(&mut self, count: u64) -> Result<()> {
        self.options.limits.work.check()?;
        self.bytes.resize(count as usize * RECORD, 0);
        self.source.read_exact(&mut self.bytes).map_err(Error::Io)
    }

    /// Goes to a triangle.
    fn seek(&mut self, triangle: u64) -> Result<()> {
        let place = HEADER as u64 + RECORD as u64 * triangle;
        self.source.seek(SeekFrom::Start(place)).map(drop).map_err(Error::Io)
    }

    /// Makes the next piece, with this many triangles, and describes it.
    fn make_piece(&mut self, count: u64) -> Result<Looked> {
        let mut found = Looked::default();
        let mut positions = std::mem::take(&mut self.positions);
        positions.resize(3 * count as usize, Vec3::ZERO);
        let marking = self.palette.marking_bits();
        // Few at a time stay in the cache.
        for corners in positions.chunks_mut(3 * SKIM as usize) {
            self.fill(corners.len() as u64 / 3)?;
            let records = self.bytes.as_chunks::<RECORD>().0;
            for (to, record) in corners.as_chunks_mut().0.iter_mut().zip(records) {
                *to = vertices(record);
            }
            let marks = |any, r: &[u8; RECORD]| any | u16::from_le_bytes([r[48], r[49]]);
            found.colored |= records.iter().fold(0, marks) & marking != 0;
            found.infinite += count_infinite(corners);
        }
        self.positions = positions;
        Ok(found)
    }

    /// Returns a scene of the piece that was made.
    fn scene(&mut self) -> Scene {
        let colored = self.looked.is_some_and(|looked| looked.colored);
        let mut mesh = Mesh { positions: std::mem::take(&mut self.positions), ..Mesh::default() };
        let materials: Vec<_> = self.palette.material(colored).into_iter().collect();
        if !materials.is_empty() {
            let range = 0..mesh.triangle_count() as u32;
            mesh.parts.push(Part { range, material: Some(0), name: String::new() });
        }
        let instance = Instance { mesh: 0, world_from_mesh: DMat4::IDENTITY, name: String::new() };
        let (meshes, instances) = (vec![mesh], vec![instance]);
        Scene { meshes, instances, materials, up_axis: UpAxis::Z, ..Scene::default() }
    }

    /// Returns the facts about the whole file.
    fn looked(&mut self) -> Result<Looked> {
        match self.looked {
            Some(looked) => Ok(looked),
            None => {
                crate::Pieces::primitives(self, &mut |_| Ok(()))?;
                Ok(self.looked.unwrap_or_default())
            }
        }
    }
}

impl<R: Read + Seek> crate::Pieces for Pieces<R> {
    fn whole(&self) -> u64 {
        self.count * (BYTES + ON_SCREEN)
    }

    fn up_axis(&self) -> UpAxis {
        UpAxis::Z
    }

    /// Returns `false`: the normals of facets are not used.
    fn has_normals(&self) -> bool {
        false
    }

    fn vertices(&mut self, visit: Visit<'_>) -> Result<()> {
        self.primitives(visit)
    }

    fn bounds(&mut self) -> Result<Option<Aabb>> {
        let mut bounds = None;
        self.primitives(&mut |piece| {
            bounds = union(bounds, piece.bounds());
            Ok(())
        })?;
        Ok(bounds)
    }

    fn primitives(&mut self, visit: Visit<'_>) -> Result<()> {
        self.seek(0)?;
        let (mut left, mut found) = (self.count, Looked::default());
        while left > 0 {
            let count = left.min(self.at_once as u64);
            left -= count;
            let of_piece = self.make_piece(count)?;
            found.infinite += of_piece.infinite;
            found.colored |= of_piece.colored;
            let mut scene = self.scene();
            visit(&mut scene)?;
            // The memory of the next piece.
            self.positions = scene.meshes.pop().map(|mesh| mesh.positions).unwrap_or_default();
        }
        self.looked = Some(found);
        Ok(())
    }

    fn only(&mut self, numbers: &[u32]) -> Result<(Scene, Charge)> {
        let Looked { colored, .. } = self.looked()?;
        let charge = self.options.limits.work.charge(MODEL, numbers.len() as u64 * BYTES)?;
        let mut facets = Facets::new(&self.head, numbers.len());
        let (mut left, mut wanted) = (numbers, Vec::new());
        while let Some(&first) = left.first() {
            let start = u64::from(first);
            self.seek(start)?;
            self.fill(self.count.saturating_sub(start).min(SKIM))?;
            let here = left.partition_point(|&number| u64::from(number) < start + SKIM);
            let (of_here, rest) = left.split_at(here);
            let records = self.bytes.as_chunks::<RECORD>().0;
            wanted.clear();
            let record = |&number: &u32| records.get((number - first) as usize).copied();
            wanted.extend(of_here.iter().filter_map(record));
            facets.add(&wanted);
            left = rest;
        }
        Ok((facets.into_model(Model::default(), colored)?.scene, charge))
    }

    fn facts(&mut self) -> Result<Facts> {
        let Looked { infinite, colored } = self.looked()?;
        let mut model = Model { format: BINARY.to_owned(), ..Model::default() };
        model.scene.up_axis = UpAxis::Z;
        model.scene.materials.extend(self.palette.material(colored));
        model.warn_infinite(infinite);
        let (triangles, vertices) = (self.count, 3 * self.count);
        Ok(Facts { model, triangles, points: 0, vertices })
    }
}
