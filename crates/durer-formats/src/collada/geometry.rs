//! Geometries: primitives over sources of numbers, to meshes.

use super::document::Document;
use super::faults::Faults;
use super::source::{self, Slots, Slotted, Source, Sources};
use crate::Result;
use crate::budget::Budget;
use crate::piece::{Builder, Corner, NONE, Piece, SETS, Values};
use durer::math::DVec3;
use durer::scene::Topology;
use std::collections::HashMap;
use std::rc::Rc;

/// A geometry, as yet without materials.
#[derive(Debug, Clone, Default)]
pub(super) struct Geometry {
    pub pieces: Vec<Piece>,
}

/// Source of an attribute for the corners of a primitive.
struct Input {
    /// Its place in a [`Corner`].
    slot: usize,
    source: usize,
    /// Position among the indices of a corner.
    offset: usize,
    set: u64,
}

/// Reader of one geometry.
struct Reader<'d, 'a> {
    document: &'d Document<'a>,
    budget: &'d mut Budget,
    faults: &'d mut Faults,
    sources: Sources,
    /// Builders, with the source of each slot.
    builders: Vec<(Slots, Builder)>,
    /// Numbers of builders by their key.
    numbers: HashMap<(Topology, Slots, Vec<u64>), usize>,
}

/// Reads a geometry element.
///
/// # Errors
/// [`crate::Error::Limit`].
pub(super) fn read(
    document: &Document<'_>,
    geometry: usize,
    budget: &mut Budget,
    faults: &mut Faults,
) -> Result<Geometry> {
    let (sources, builders, numbers) = Default::default();
    let mut reader = Reader { document, budget, faults, sources, builders, numbers };
    let mesh =
        document.children(geometry).find(|&n| matches!(document.name(n), "mesh" | "convex_mesh"));
    for element in mesh.into_iter().flat_map(|mesh| document.children(mesh)) {
        reader.primitives(element)?;
    }
    if mesh.is_none() {
        reader.faults.unknown.add(|| document.place(geometry));
    }
    let name = document.attribute(geometry, "name").or(document.attribute(geometry, "id"));
    let name = name.unwrap_or_default().to_owned();
    let builders = std::mem::take(&mut reader.builders);
    let piece = |(slots, b): (Slots, Builder)| b.piece(&Slotted(&reader.sources, slots), &name);
    Ok(Geometry { pieces: builders.into_iter().filter_map(piece).collect() })
}

impl Reader<'_, '_> {
    fn primitives(&mut self, element: usize) -> Result<()> {
        let document = self.document;
        let kind = document.name(element);
        let topology = match kind {
            "triangles" | "polylist" | "polygons" | "tristrips" | "trifans" => Topology::Triangles,
            "lines" | "linestrips" => Topology::Lines,
            _ => return Ok(()),
        };
        let inputs = self.inputs(element)?;
        let stride = inputs.iter().map(|i| i.offset + 1).max().unwrap_or(1);
        if !inputs.iter().any(|i| i.slot == 0) {
            if document.named(element, "p").next().is_some() {
                self.faults.sources.add(|| document.place(element));
            }
            return Ok(());
        }
        let builder = self.builder(topology, &inputs);
        let symbol = document.attribute(element, "material").unwrap_or_default();
        self.builders[builder].1.begin(symbol);
        if kind == "polylist" {
            return self.polylist(element, builder, &inputs, stride);
        }
        for p in document.children(element) {
            match document.name(p) {
                "p" => {
                    let corners = self.corners(p, builder, &inputs, stride)?;
                    self.join(kind, builder, &corners, p)?;
                }
                "ph" => self.with_holes(p, builder, &inputs, stride)?,
                _ => {}
            }
        }
        Ok(())
    }

    /// Returns the inputs that are read; the inputs in `vertices` have the offset of the input that refers to it.
    fn inputs(&mut self, element: usize) -> Result<Vec<Input>> {
        let document = self.document;
        let mut inputs: Vec<Input> = Vec::new();
        for input in document.named(element, "input") {
            let offset = document.whole(input, "offset").unwrap_or(0).min(1 << 16) as usize;
            if document.attribute(input, "semantic") == Some("VERTEX") {
                let vertices = document.refers(input, "source");
                let all = vertices.into_iter().flat_map(|v| document.named(v, "input"));
                for input in all.collect::<Vec<_>>() {
                    self.input(input, offset, &mut inputs)?;
                }
            } else {
                self.input(input, offset, &mut inputs)?;
            }
        }
        Ok(inputs)
    }

    fn input(&mut self, input: usize, offset: usize, inputs: &mut Vec<Input>) -> Result<()> {
        let document = self.document;
        let sets = inputs.iter().filter(|i| i.slot >= 3).count();
        let slot = match document.attribute(input, "semantic") {
            Some("POSITION") => 0,
            Some("NORMAL") => 1,
            Some("COLOR") => 2,
            Some("TEXCOORD") if sets < SETS => 3 + sets,
            // Tangents and similar inputs; their indices occupy places nevertheless.
            _ => {
                inputs.push(Input { slot: usize::MAX, source: 0, offset, set: 0 });
                return Ok(());
            }
        };
        let set = document.whole(input, "set").unwrap_or(sets as u64);
        let source = document.refers(input, "source");
        let taken = inputs.iter().any(|i| i.slot == slot);
        match source {
            Some(source) if !taken && self.source(source)?.is_some() => {
                inputs.push(Input { slot, source, offset, set });
            }
            _ => {
                if !taken {
                    self.faults.sources.add(|| document.place(input));
                }
                inputs.push(Input { slot: usize::MAX, source: 0, offset, set });
            }
        }
        Ok(())
    }

    /// Returns a source, read once.
    fn source(&mut self, element: usize) -> Result<Option<Rc<Source>>> {
        if let Some(known) = self.sources.get(&element) {
            return Ok(known.clone());
        }
        let source = source::read(self.document, element, self.budget, &mut self.faults.numbers)?;
        let source = source.map(Rc::new);
        self.sources.insert(element, source.clone());
        Ok(source)
    }

    /// Returns the builder of primitives with these sources.
    fn builder(&mut self, topology: Topology, inputs: &[Input]) -> usize {
        let mut slots = [None; 3 + SETS];
        let mut sets = Vec::new();
        for input in inputs.iter().filter(|i| i.slot < 3 + SETS) {
            slots[input.slot] = Some(input.source);
            if input.slot >= 3 {
                sets.push(input.set);
            }
        }
        let key = (topology, slots, sets);
        if let Some(&at) = self.numbers.get(&key) {
            return at;
        }
        let at = self.builders.len();
        self.builders.push((slots, Builder::new(topology, key.2.clone())));
        self.numbers.insert(key, at);
        at
    }

    /// Returns the vertices of the corners that a list of indices names; `None` for one that has
    /// not all.
    fn corners(
        &mut self,
        p: usize,
        builder: usize,
        inputs: &[Input],
        stride: usize,
    ) -> Result<Vec<Option<u32>>> {
        let document = self.document;
        let sources: Vec<_> =
            inputs.iter().map(|i| self.sources.get(&i.source).cloned().flatten()).collect();
        let mut vertices = Vec::new();
        let mut corner: Vec<Option<u32>> = Vec::with_capacity(stride);
        for word in document.raw(p).split_ascii_whitespace() {
            corner.push(word.parse().ok());
            if corner.len() < stride {
                continue;
            }
            let key = key(inputs, &sources, &corner);
            let vertex = key.map(|(key, _)| self.builders[builder].1.vertex(key));
            match key {
                None => self.faults.indices.add(|| document.place(p)),
                Some((_, false)) => self.faults.attributes.add(|| document.place(p)),
                Some(_) => {}
            }
            vertices.push(vertex);
            corner.clear();
        }
        if !corner.is_empty() {
            self.faults.short.add(|| document.place(p));
        }
        self.budget.bytes(8 * vertices.len() as u64, || document.place(p))?;
        Ok(vertices)
    }

    fn polylist(
        &mut self,
        element: usize,
        builder: usize,
        inputs: &[Input],
        stride: usize,
    ) -> Result<()> {
        let document = self.document;
        let counts = document.find(element, &["vcount"]);
        let Some(p) = document.find(element, &["p"]) else { return Ok(()) };
        let corners = self.corners(p, builder, inputs, stride)?;
        let mut rest = &corners[..];
        let words = counts.map_or("", |c| document.raw(c)).split_ascii_whitespace();
        for count in words.map(|w| w.parse::<usize>().unwrap_or(usize::MAX)) {
            let Some((polygon, after)) = rest.split_at_checked(count) else {
                self.faults.short.add(|| document.place(element));
                break;
            };
            rest = after;
            self.polygon(builder, polygon, element)?;
        }
        Ok(())
    }

    /// Reads a polygon with holes, each joined to it by a bridge there and back.
    fn with_holes(
        &mut self,
        ph: usize,
        builder: usize,
        inputs: &[Input],
        stride: usize,
    ) -> Result<()> {
        let document = self.document;
        let Some(p) = document.find(ph, &["p"]) else { return Ok(()) };
        let mut outline = self.corners(p, builder, inputs, stride)?;
        for hole in document.named(ph, "h").collect::<Vec<_>>() {
            let hole = self.corners(hole, builder, inputs, stride)?;
            if !self.bridge(&mut outline, &hole, builder) {
                self.faults.holes.add(|| document.place(ph));
            }
        }
        self.polygon(builder, &outline, ph)
    }

    /// Joins a hole to an outline where they are nearest to each other; returns `false` if that would take too long or
    /// there is nothing to join.
    fn bridge(&self, outline: &mut Vec<Option<u32>>, hole: &[Option<u32>], builder: usize) -> bool {
        let (slots, builder) = &self.builders[builder];
        let values = Slotted(&self.sources, *slots);
        let point = |v: Option<u32>| {
            let corner = builder.corners.get(v? as usize)?;
            let [x, y, z, _] = values.get(0, corner[0], 0.0)?;
            Some(DVec3::new(x, y, z))
        };
        if outline.len().saturating_mul(hole.len()) > 4_000_000 {
            return false;
        }
        let inner: Vec<Option<DVec3>> = hole.iter().map(|&v| point(v)).collect();
        let mut best: Option<(f64, usize, usize)> = None;
        for (i, p) in outline.iter().enumerate().filter_map(|(i, &v)| Some((i, point(v)?))) {
            for (j, q) in inner.iter().enumerate().filter_map(|(j, q)| Some((j, (*q)?))) {
                let distance = p.distance_squared(q);
                if best.is_none_or(|(least, ..)| distance < least) {
                    best = Some((distance, i, j));
                }
            }
        }
        let Some((_, i, j)) = best else { return false };
        let around = hole[j..].iter().chain(&hole[..=j]).copied();
        let way: Vec<_> = around.chain([outline[i]]).collect();
        outline.splice(i + 1..i + 1, way);
        true
    }

    /// Makes primitives of a list of corners.
    fn join(&mut self, kind: &str, builder: usize, c: &[Option<u32>], at: usize) -> Result<()> {
        match kind {
            "polygons" => return self.polygon(builder, c, at),
            "triangles" => {
                for corners in c.as_chunks::<3>().0 {
                    self.polygon(builder, corners, at)?;
                }
            }
            "tristrips" => {
                for (i, w) in c.windows(3).enumerate() {
                    let odd = i % 2;
                    self.polygon(builder, &[w[odd], w[1 - odd], w[2]], at)?;
                }
            }
            "trifans" => {
                for w in c.get(1..).unwrap_or_default().windows(2) {
                    self.polygon(builder, &[c[0], w[0], w[1]], at)?;
                }
            }
            "lines" => {
                for ends in c.as_chunks::<2>().0 {
                    self.line(builder, *ends, at)?;
                }
            }
            _ => {
                for w in c.windows(2) {
                    self.line(builder, [w[0], w[1]], at)?;
                }
            }
        }
        let rest = match kind {
            "triangles" => c.len() % 3,
            "lines" => c.len() % 2,
            _ => 0,
        };
        if rest > 0 {
            self.faults.short.add(|| self.document.place(at));
        }
        Ok(())
    }

    fn line(&mut self, builder: usize, ends: [Option<u32>; 2], at: usize) -> Result<()> {
        let [Some(a), Some(b)] = ends else { return Ok(()) };
        self.budget.primitives(1, || self.document.place(at))?;
        self.builders[builder].1.line([a, b]);
        Ok(())
    }

    /// Adds a polygon as a fan; one that has not all its corners is left out.
    fn polygon(&mut self, builder: usize, corners: &[Option<u32>], at: usize) -> Result<()> {
        let document = self.document;
        let whole: Option<Vec<u32>> = corners.iter().copied().collect();
        let Some(vertices) = whole.filter(|v| !v.is_empty()) else { return Ok(()) };
        if vertices.len() < 3 {
            self.faults.short.add(|| document.place(at));
            return Ok(());
        }
        self.budget.primitives(vertices.len() as u64 - 2, || document.place(at))?;
        self.builders[builder].1.polygon(&vertices);
        Ok(())
    }
}

/// Returns the indices of a corner in its sources, and whether all of them exist; `None` if its position's does not.
fn key(
    inputs: &[Input],
    sources: &[Option<Rc<Source>>],
    corner: &[Option<u32>],
) -> Option<(Corner, bool)> {
    let mut key = [NONE; 3 + SETS];
    let mut whole = true;
    for (input, source) in inputs.iter().zip(sources).filter(|(i, _)| i.slot < 3 + SETS) {
        let index = corner.get(input.offset).copied().flatten();
        let has = |i: u32| source.as_ref().is_some_and(|s| s.get::<1>(i, 0.0).is_some());
        let there = index.filter(|&i| has(i));
        whole &= there.is_some();
        key[input.slot] = if input.slot == 0 { there? } else { there.unwrap_or(NONE) };
    }
    Some((key, whole))
}
