//! Binary PLY in pieces: points, and meshes of polygons that need no new vertices.
//!
//! The vertices of a piece of a mesh are read from where the file has them; near faces mostly have near vertices.

use super::body::Values;
use super::bounds::Bounds;
use super::faces::Faces;
use super::header::{Element, Encoding, Header};
use super::names::{NORMAL, Plan, RED, ROTATION, Role, SCALE, SPLAT_COLOR, Use};
use super::stream::Stream;
use super::vertices::Vertices;
use super::{finish, header, missing_rows, sniff};
use crate::budget::MODEL;
use crate::facets::{self, Facets};
use crate::model::count_infinite;
use crate::pieces::{Facts, Visit, union};
use crate::{Error, Model, Place, ReadOptions, Result, color, place, polygon};
use durer::math::{DVec3, Vec3};
use durer::pipeline::MOST_ITEMS;
use durer::scene::{Aabb, Instance, Mesh, Scene, Topology, UpAxis};
use durer::view::projection::PIECE;
use durer::work::Charge;
use std::io::{Read, Seek, SeekFrom};
use std::sync::Arc;

/// The most bytes of a header.
const MOST_HEADER: u64 = 64 << 10;

/// Bytes for a vertex or a face while its piece is made.
const IN_PIECE: u64 = 80;

/// Bytes for a triangle on the screen; a point is two.
const ON_SCREEN: u64 = 52;

/// A piece ends early at this many corners of triangles, where polygons are large.
const MOST_CORNERS: usize = 4 << 20;

/// A binary PLY file that is read in pieces.
pub struct Pieces<R> {
    header: Header,
    stream: Stream<R>,
    /// Offset of the vertices, bytes of each, and their number.
    first_vertex: u64,
    row: u64,
    count: u64,
    plan: Plan,
    /// The element of the faces, if there are some.
    faces: Option<Arc<(Element, Plan)>>,
    /// Vertices or faces of a piece.
    at_once: u64,
    options: ReadOptions,
    /// Origin of positions, once it is known.
    origin: Option<DVec3>,
    faces_seen: Option<FacesSeen>,
    vertices_seen: Option<VerticesSeen>,
    _charge: Charge,
}

/// Facts about the faces after the first reading.
struct FacesSeen {
    faces: Faces,
    bounds: Bounds,
    triangles: u64,
    /// Message about the end of the file: missing or extra values.
    end: Option<(Place, String)>,
    /// A bit for each vertex that primitives use.
    used: Vec<u64>,
    _charge: Charge,
}

/// Facts about the vertices after the first reading.
#[derive(Debug, Clone, Copy, Default)]
struct VerticesSeen {
    infinite: usize,
    /// The largest part of a colour.
    brightest: f32,
}

/// Returns the elements of vertices and of faces, of a file that can be read in pieces.
fn elements(header: &Header) -> Option<(&Element, Option<&Element>)> {
    let mut there = header.elements.iter().filter(|element| element.count > 0);
    let (vertex, face) = (there.next()?, there.next());
    let plan = Plan::new(vertex);
    let is_splat =
        [SCALE, ROTATION, SPLAT_COLOR].into_iter().any(|slot| plan.has(Use::Value(slot)));
    let are_points = plan.role == Role::Vertex
        && vertex.properties.iter().all(|p| p.list.is_none())
        && !is_splat;
    let are_faces = |face: &Element| {
        let plan = Plan::new(face);
        let more = [Use::TexCoords, Use::Texture].into_iter().any(|usage| plan.has(usage));
        plan.role == Role::Face && plan.has(Use::Indices) && !plan.colored && !more
    };
    let binary = header.encoding != Encoding::Ascii;
    let suits = binary && are_points && face.is_none_or(are_faces) && header.textures.is_empty();
    (suits && there.next().is_none()).then_some((vertex, face))
}

impl<R: Read + Seek> Pieces<R> {
    /// Opens a file of `length` bytes, in pieces of about this many vertices or faces; `None` if it is not such a file.
    ///
    /// # Errors
    /// [`Error::Limit`] for too many vertices, [`Error::Io`], [`durer::Error::Memory`] if the budget has no room for
    /// a piece.
    pub fn new(
        mut source: R,
        length: u64,
        at_once: usize,
        options: &ReadOptions,
    ) -> Result<Option<Self>> {
        let mut head = Vec::new();
        source.seek(SeekFrom::Start(0)).map_err(Error::Io)?;
        source.by_ref().take(MOST_HEADER).read_to_end(&mut head).map_err(Error::Io)?;
        let stripped = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&head);
        let Some(header) = sniff(stripped).then(|| header::parse(stripped).ok()).flatten() else {
            return Ok(None);
        };
        let Some((vertex, face)) = elements(&header) else { return Ok(None) };
        let first_vertex = (head.len() - stripped.len() + header.length) as u64;
        let (row, count) =
            (vertex.properties.iter().map(|p| p.kind.size()).sum::<u64>(), vertex.count);
        let end = row.checked_mul(count).and_then(|bytes| bytes.checked_add(first_vertex));
        if end.is_none_or(|end| end > length)
            || Vertices::default().begin(&Plan::new(vertex), 0).is_err()
        {
            return Ok(None);
        }
        let most = if face.is_some() { u64::from(u32::MAX) } else { MOST_ITEMS };
        check_limit("number of vertices", count, options.limits.primitives.min(most))?;
        let plan = Plan::new(vertex);
        let faces = face.map(|face| Arc::new((face.clone(), Plan::new(face))));
        let at_once = (at_once.div_ceil(PIECE).max(1) * PIECE) as u64;
        let _charge = options.limits.work.charge(MODEL, at_once.min(count) * IN_PIECE)?;
        let stream = Stream::new(source, header.encoding == Encoding::LittleEndian, length);
        let (origin, faces_seen, vertices_seen) = (None, None, None);
        let options = options.clone();
        Ok(Some(Self {
            header,
            stream,
            first_vertex,
            row,
            count,
            plan,
            faces,
            at_once,
            options,
            origin,
            faces_seen,
            vertices_seen,
            _charge,
        }))
    }

    /// Reads the vertices of these numbers.
    fn read(&mut self, numbers: impl ExactSizeIterator<Item = u64>) -> Result<Vertices> {
        self.options.limits.work.check()?;
        let mut vertices = Vertices::default();
        vertices.begin(&self.plan, numbers.len())?;
        for number in numbers {
            self.stream.seek(self.first_vertex + number * self.row)?;
            vertices.row(&self.plan, number, &mut self.stream)?;
        }
        Ok(vertices)
    }

    /// Reads all vertices, some at a time.
    fn for_each_vertices(
        &mut self,
        mut visit: impl FnMut(&mut Self, u64, Vertices) -> Result<()>,
    ) -> Result<()> {
        for start in (0..self.count).step_by(self.at_once as usize) {
            let numbers = start as usize..self.count.min(start + self.at_once) as usize;
            let vertices = self.read(numbers.map(|number| number as u64))?;
            visit(self, start, vertices)?;
        }
        Ok(())
    }

    /// Returns the origin of positions: the middle of wide numbers that are far off.
    fn origin(&mut self) -> Result<DVec3> {
        if let Some(origin) = self.origin {
            return Ok(origin);
        }
        let mut bounds = None;
        if self.read(std::iter::empty())?.wide.is_some() {
            self.for_each_vertices(|_, _, vertices| {
                let own = Aabb::around(vertices.wide.into_iter().flatten());
                bounds = union(bounds, own);
                Ok(())
            })?;
        }
        Ok(*self.origin.insert(place::origin_of(bounds)))
    }

    /// Reads all faces, some at a time, as triangles of numbers of vertices.
    fn for_each_triangles(
        &mut self,
        mut visit: impl FnMut(&mut Self, &[u32]) -> Result<()>,
    ) -> Result<Option<FacesSeen>> {
        let Some(both) = self.faces.clone() else { return Ok(None) };
        let (element, plan) = &*both;
        let limits = &self.options.limits;
        let mut bounds = Bounds::new(&self.header, limits.clone());
        let limit = limits.primitives.min(MOST_ITEMS);
        let (mut faces, mut triangles, mut end, mut row) = (Faces::default(), 0, None, 0);
        let mut place = self.first_vertex + self.row * self.count;
        while row < element.count && end.is_none() {
            self.options.limits.work.check()?;
            self.stream.seek(place)?;
            let last = element.count.min(row + self.at_once);
            faces.begin(plan, (last - row) as usize);
            while row < last && faces.facets.triangles.indices.len() < MOST_CORNERS {
                match faces.row(plan, row, &mut bounds, &mut self.stream) {
                    Ok(()) => row += 1,
                    Err(why) if self.stream.ended() || triangles > 0 || faces.has_any() => {
                        end = Some(missing_rows(element, row, why)?);
                        break;
                    }
                    Err(why) => return Err(why),
                }
            }
            place = self.stream.position();
            let indices = self.cut(std::mem::take(&mut faces.facets))?;
            triangles += indices.len() as u64 / 3;
            check_limit("number of triangles", triangles, limit)?;
            visit(self, &indices)?;
        }
        if end.is_none() {
            self.stream.seek(place)?;
            end = self.stream.left_over();
        }
        let (used, _charge) = (Vec::new(), Charge::default());
        Ok(Some(FacesSeen { faces, bounds, triangles, end, used, _charge }))
    }

    /// Cuts polygons into triangles that cover them.
    fn cut(&mut self, facets: Facets) -> Result<Vec<u32>> {
        let Facets { triangles, starts: faces, .. } = facets;
        if faces.is_empty() {
            return Ok(triangles.indices);
        }
        let (local, numbers) = localized(&triangles.indices);
        let positions = self.positions(&numbers)?;
        let count = positions.len();
        let mut noted = Model::default();
        let mut mesh = Mesh { positions, indices: Some(local), faces, ..Mesh::default() };
        polygon::recut(&mut noted, &mut mesh, &self.options.limits)?;
        if mesh.positions.len() > count || !noted.warnings.is_empty() {
            let what = "a model in pieces with polygons that cross themselves".to_owned();
            let hint = "a larger budget of memory lets all of it be held".to_owned();
            return Err(Error::Unsupported { place: Place::Whole, what, hint });
        }
        let number = |&i: &u32| numbers.get(i as usize).copied().unwrap_or_default();
        Ok(mesh.indices.unwrap_or_default().iter().map(number).collect())
    }

    /// Reads the positions of vertices.
    fn positions(&mut self, numbers: &[u32]) -> Result<Vec<Vec3>> {
        let origin = self.origin()?;
        Ok(self.read(numbers.iter().map(|&n| u64::from(n)))?.into_positions(origin))
    }

    /// Examines all faces, if that has not been done yet.
    fn look_at_faces(&mut self) -> Result<()> {
        if self.faces_seen.is_some() || self.faces.is_none() {
            return Ok(());
        }
        let words = self.count.div_ceil(64);
        let charge = self.options.limits.work.charge_for::<u64>(MODEL, words)?;
        let mut used = vec![0_u64; words as usize];
        let seen = self.for_each_triangles(|_, indices| {
            for &i in indices {
                if let Some(word) = used.get_mut(i as usize / 64) {
                    *word |= 1 << (i % 64);
                }
            }
            Ok(())
        })?;
        self.faces_seen = seen.map(|seen| FacesSeen { used, _charge: charge, ..seen });
        Ok(())
    }

    /// Returns a scene of some vertices and their primitives.
    fn scene(&mut self, mut mesh: Mesh) -> Result<Scene> {
        if self.faces.is_none() {
            mesh.topology = Topology::Points;
        }
        let mut model = Model::default();
        facets::show_colors(&mut model, std::slice::from_mut(&mut mesh));
        let (world_from_mesh, name) = (place::matrix(self.origin()?), String::new());
        model.scene.meshes.push(mesh);
        model.scene.instances.push(Instance { mesh: 0, world_from_mesh, name });
        Ok(model.scene)
    }

    /// Adds vertices, with all that they have, to a mesh.
    fn add(&mut self, numbers: &[u32], mesh: &mut Mesh) -> Result<()> {
        let (origin, seen) = (self.origin()?, self.vertices_seen()?);
        let mut vertices = self.read(numbers.iter().map(|&n| u64::from(n)))?;
        facets::scaled_to_linear(&mut vertices.all.colors, facets::scale_of(seen.brightest));
        mesh.normals.append(&mut vertices.all.normals);
        mesh.colors.append(&mut vertices.all.colors);
        mesh.positions.append(&mut vertices.into_positions(origin));
        Ok(())
    }

    fn vertices_seen(&mut self) -> Result<VerticesSeen> {
        if self.vertices_seen.is_none() {
            crate::Pieces::vertices(self, &mut |_| Ok(()))?;
        }
        Ok(self.vertices_seen.unwrap_or_default())
    }
}

impl<R: Read + Seek> crate::Pieces for Pieces<R> {
    fn whole(&self) -> u64 {
        let faces = self.faces.as_deref().map(|(element, plan)| (element.count, plan.bytes()));
        let (count, bytes) = faces.unwrap_or((self.count, ON_SCREEN));
        let model = self.count.saturating_mul(self.row + self.plan.bytes());
        model.saturating_add(count.saturating_mul(13 + bytes + ON_SCREEN))
    }

    fn up_axis(&self) -> UpAxis {
        UpAxis::Y
    }

    fn has_normals(&self) -> bool {
        (0..3).all(|i| self.plan.has(Use::Value(NORMAL + i)))
    }

    fn vertices(&mut self, visit: Visit<'_>) -> Result<()> {
        self.look_at_faces()?;
        let origin = self.origin()?;
        let mut seen = VerticesSeen::default();
        self.for_each_vertices(|this, start, vertices| {
            seen.brightest = seen.brightest.max(facets::brightest(&vertices.all.colors));
            let mut positions = vertices.into_positions(origin);
            seen.infinite += count_infinite(&positions);
            if let Some(faces) = &this.faces_seen {
                for (number, position) in (start..).zip(&mut positions) {
                    let word = faces.used.get((number / 64) as usize).copied().unwrap_or(0);
                    if word >> (number % 64) & 1 == 0 {
                        *position = Vec3::NAN;
                    }
                }
            }
            let mut scene = this.scene(Mesh { positions, ..Mesh::default() })?;
            Ok(visit(&mut scene)?)
        })?;
        self.vertices_seen = Some(seen);
        Ok(())
    }

    fn bounds(&mut self) -> Result<Option<Aabb>> {
        let (origin, mut bounds) = (self.origin()?, None);
        self.for_each_vertices(|this, _, vertices| {
            let positions = vertices.into_positions(origin);
            let piece = this.scene(Mesh { positions, ..Mesh::default() })?;
            bounds = union(bounds, piece.bounds());
            Ok(())
        })?;
        Ok(bounds)
    }

    fn primitives(&mut self, visit: Visit<'_>) -> Result<()> {
        let origin = self.origin()?;
        if self.faces.is_none() {
            return self.for_each_vertices(|this, _, vertices| {
                let positions = vertices.into_positions(origin);
                let mut scene = this.scene(Mesh { positions, ..Mesh::default() })?;
                Ok(visit(&mut scene)?)
            });
        }
        self.for_each_triangles(|this, indices| {
            let (local, numbers) = localized(indices);
            let positions = this.positions(&numbers)?;
            let mesh = Mesh { positions, indices: Some(local), ..Mesh::default() };
            Ok(visit(&mut this.scene(mesh)?)?)
        })?;
        Ok(())
    }

    fn only(&mut self, numbers: &[u32]) -> Result<(Scene, Charge)> {
        let corners = if self.faces.is_some() { 3 } else { 1 };
        // Upper bound: each corner is a separate vertex with an index.
        let bytes = numbers.len() as u64 * corners * (44 + 4);
        let charge = self.options.limits.work.charge(MODEL, bytes)?;
        let mut mesh = Mesh::default();
        if self.faces.is_none() {
            self.add(numbers, &mut mesh)?;
            return Ok((self.scene(mesh)?, charge));
        }
        let (mut left, mut start) = (numbers, 0_u64);
        let mut all = Vec::with_capacity(3 * numbers.len());
        self.vertices_seen()?;
        self.for_each_triangles(|this, indices| {
            let triangles = indices.as_chunks::<3>().0;
            let end = start + triangles.len() as u64;
            let (here, rest) = left.split_at(left.partition_point(|&n| u64::from(n) < end));
            let wanted =
                here.iter().filter_map(|&n| triangles.get((u64::from(n) - start) as usize));
            let wanted: Vec<u32> = wanted.flatten().copied().collect();
            let (local, numbers) = localized(&wanted);
            let first = mesh.positions.len() as u32;
            all.extend(local.iter().map(|i| first + i));
            (left, start) = (rest, end);
            this.add(&numbers, &mut mesh)
        })?;
        mesh.indices = Some(all);
        Ok((self.scene(mesh)?, charge))
    }

    fn facts(&mut self) -> Result<Facts> {
        let VerticesSeen { infinite, brightest } = self.vertices_seen()?;
        let mut model =
            Model { format: finish::format(&self.header).to_owned(), ..Model::default() };
        if (0..3).all(|i| self.plan.has(Use::Value(RED + i))) {
            model.scene.materials.push(color::vertex_color_material());
        }
        let mut triangles = 0;
        if let Some(seen) = &self.faces_seen {
            triangles = seen.triangles;
            finish::check_dangling(&mut model, &seen.bounds, triangles == 0)?;
        }
        model.warn_infinite(infinite);
        if let Some(seen) = &self.faces_seen {
            finish::warn_of_faces(&mut model, &seen.faces);
        }
        facets::warn_of_scale(&mut model, facets::scale_of(brightest));
        let end = self.end();
        super::warn_of_end(&mut model, &self.header, end);
        if self.faces.is_some() && triangles == 0 {
            let what = "a model in pieces of which no face can be shown".to_owned();
            let hint = "a larger budget of memory lets all of it be held".to_owned();
            return Err(Error::Unsupported { place: Place::Whole, what, hint });
        }
        let points = if self.faces.is_none() { self.count } else { 0 };
        Ok(Facts { model, triangles, points, vertices: self.count })
    }
}

impl<R: Read + Seek> Pieces<R> {
    /// Returns the message about missing or extra values at the end of the file.
    fn end(&mut self) -> Option<(Place, String)> {
        match &self.faces_seen {
            Some(seen) => seen.end.clone(),
            None => {
                let end = self.first_vertex + self.row * self.count;
                self.stream.seek(end).ok()?;
                self.stream.left_over()
            }
        }
    }
}

fn check_limit(what: &'static str, value: u64, limit: u64) -> Result<()> {
    if value <= limit {
        return Ok(());
    }
    Err(Error::Limit { place: Place::Whole, what, value, limit })
}

/// Returns indices renumbered from 0, in their order, and the old index of each new one.
fn localized(indices: &[u32]) -> (Vec<u32>, Vec<u32>) {
    let (Some(&least), Some(&most)) = (indices.iter().min(), indices.iter().max()) else {
        return (Vec::new(), Vec::new());
    };
    let span = (most - least) as usize + 1;
    if span > 16 * indices.len() {
        let mut numbers = indices.to_vec();
        numbers.sort_unstable();
        numbers.dedup();
        let place = |i: &u32| numbers.binary_search(i).unwrap_or_default() as u32;
        return (indices.iter().map(place).collect(), numbers);
    }
    let mut places = vec![0_u32; span];
    let at = |i: u32| (i - least) as usize;
    indices.iter().for_each(|&i| places[at(i)] = 1);
    let mut numbers = Vec::new();
    for (place, number) in places.iter_mut().zip(least..) {
        if *place > 0 {
            *place = numbers.len() as u32;
            numbers.push(number);
        }
    }
    (indices.iter().map(|&i| places[at(i)]).collect(), numbers)
}
