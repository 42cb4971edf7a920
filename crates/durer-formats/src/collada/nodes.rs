//! The visual scene: nodes in their places, walked without recursion.

use super::document::Document;
use super::faults::{self, Faults};
use super::geometry::{self, Geometry};
use super::material::Materials;
use crate::budget::Budget;
use crate::piece::Piece;
use crate::text::Tally;
use crate::{Error, Limits, Model, Result, color, place, polygon};
use durer::math::{DMat4, DVec3, DVec4};
use durer::scene::Instance;
use std::collections::{HashMap, HashSet};

/// Placement of the contents of nodes.
pub(super) struct Nodes<'d, 'a> {
    pub document: &'d Document<'a>,
    pub materials: Materials<'d, 'a>,
    pub budget: Budget,
    pub limits: Limits,
    pub faults: Faults,
    geometries: HashMap<usize, Geometry>,
    /// Scene's meshes by geometry and the materials of its symbols.
    made: HashMap<Key, Vec<(usize, DVec3)>>,
    plain: Option<usize>,
    visits: u64,
    missing: Tally,
    cycles: Tally,
    broken: Tally,
    pub cameras: Vec<Placed>,
    pub lights: Vec<Placed>,
}

/// Contents of a node besides geometry.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placed {
    /// The element that is held.
    pub target: usize,
    pub node: usize,
    /// Matrix from the node's frame to the world.
    pub world: DMat4,
}

/// A geometry, and the symbols and targets of an instance's materials.
type Key = (usize, Vec<(String, String)>);

/// Remaining step of the walk.
enum Step {
    Enter(usize, DMat4),
    Leave(usize),
}

impl<'d, 'a> Nodes<'d, 'a> {
    pub fn new(document: &'d Document<'a>, materials: Materials<'d, 'a>, limits: Limits) -> Self {
        Self {
            document,
            materials,
            budget: Budget::new(limits.clone()),
            limits,
            faults: Faults::default(),
            geometries: HashMap::new(),
            made: HashMap::new(),
            plain: None,
            visits: 0,
            missing: Tally::default(),
            cycles: Tally::default(),
            broken: Tally::default(),
            cameras: Vec::new(),
            lights: Vec::new(),
        }
    }

    /// Places the nodes in a visual scene.
    ///
    /// # Errors
    /// [`Error::Limit`].
    pub fn place(&mut self, model: &mut Model, scene: usize, world: DMat4) -> Result<()> {
        let document = self.document;
        let mut inside = HashSet::new();
        let roots: Vec<usize> = document.named(scene, "node").collect();
        let mut steps: Vec<Step> = roots.iter().rev().map(|&n| Step::Enter(n, world)).collect();
        while let Some(step) = steps.pop() {
            let (node, world) = match step {
                Step::Enter(node, world) => (node, world),
                Step::Leave(node) => {
                    inside.remove(&node);
                    continue;
                }
            };
            if !inside.insert(node) {
                self.cycles.add(|| document.place(node));
                continue;
            }
            self.visit(node)?;
            let world = world * self.local(node);
            steps.push(Step::Leave(node));
            let first = steps.len();
            for child in document.children(node) {
                match document.name(child) {
                    "node" => steps.push(Step::Enter(child, world)),
                    "instance_node" => match document.refers(child, "url") {
                        Some(other) => steps.push(Step::Enter(other, world)),
                        None => self.missing.add(|| document.place(child)),
                    },
                    "instance_geometry" | "instance_controller" => {
                        self.instance(model, node, child, world)?;
                    }
                    "instance_camera" | "instance_light" => self.hold(node, child, world)?,
                    _ => {}
                }
            }
            steps[first..].reverse();
        }
        Ok(())
    }

    /// Charges placed nodes to the limits.
    fn visit(&mut self, element: usize) -> Result<()> {
        self.visits += 1;
        let (value, limit) = (self.visits, self.limits.instances);
        if value > limit {
            let place = self.document.place(element);
            return Err(Error::Limit { place, what: "number of placed nodes", value, limit });
        }
        Ok(())
    }

    /// Keeps a camera or a light.
    fn hold(&mut self, node: usize, element: usize, world: DMat4) -> Result<()> {
        self.visit(element)?;
        let document = self.document;
        let placed = |target| Placed { target, node, world };
        match document.refers(element, "url").map(placed) {
            Some(placed) if document.name(element) == "instance_camera" => {
                self.cameras.push(placed);
            }
            Some(placed) => self.lights.push(placed),
            None => self.missing.add(|| document.place(element)),
        }
        Ok(())
    }

    /// Adds warnings about omissions.
    pub fn warn(&self, model: &mut Model) {
        faults::warn(model, &self.faults);
        self.materials.warn(model);
        for (tally, what) in [
            (
                &self.missing,
                "{instance refers to a missing object; it is|instances refer to missing objects; they are} left out",
            ),
            (
                &self.cycles,
                "{node is inside itself; it is|nodes are inside themselves; they are} left out there",
            ),
            (
                &self.broken,
                "{transform does not have the right numbers; it is|transforms do not have the right numbers; they are} left out",
            ),
        ] {
            model.warn_of(tally, what);
        }
    }

    /// Returns a node's matrix to its parent: its transforms in their order.
    fn local(&mut self, node: usize) -> DMat4 {
        let document = self.document;
        let mut matrix = DMat4::IDENTITY;
        for element in document.children(node) {
            match transform(document, element) {
                None => {}
                Some(Some(m)) => matrix *= m,
                Some(None) => self.broken.add(|| document.place(element)),
            }
        }
        matrix
    }

    fn instance(
        &mut self,
        model: &mut Model,
        node: usize,
        element: usize,
        world: DMat4,
    ) -> Result<()> {
        let document = self.document;
        let target = document.refers(element, "url");
        let Some((geometry, bind)) = target.and_then(|t| self.geometry(t)) else {
            self.missing.add(|| document.place(element));
            return Ok(());
        };
        let meshes = self.meshes(model, geometry, element)?;
        let name = document.attribute(node, "name").or(document.attribute(node, "id"));
        for (mesh, origin) in meshes {
            let world_from_mesh = world * bind * place::matrix(origin);
            let name = name.unwrap_or_default().to_owned();
            model.scene.instances.push(Instance { mesh, world_from_mesh, name });
        }
        Ok(())
    }

    /// Returns the geometry behind an instance, through skins and morphs, and the matrix to its bind pose.
    fn geometry(&self, target: usize) -> Option<(usize, DMat4)> {
        let document = self.document;
        let (mut at, mut bind) = (target, DMat4::IDENTITY);
        // A morph of a skin of a geometry is the longest chain that makes sense.
        for _ in 0..4 {
            if document.name(at) == "geometry" {
                return Some((at, bind));
            }
            let controls = |n: &usize| matches!(document.name(*n), "skin" | "morph");
            let control = document.children(at).find(controls)?;
            let matrix = document.find(control, &["bind_shape_matrix"]);
            if let Some(m) = matrix.and_then(|m| document.vector::<16>(m)) {
                bind *= rows(&m);
            }
            at = document.refers(control, "source")?;
        }
        None
    }

    /// Returns the scene's number of a material that shows colours of vertices.
    fn plain(&mut self, model: &mut Model) -> usize {
        *self.plain.get_or_insert_with(|| {
            model.scene.materials.push(color::vertex_color_material());
            model.scene.materials.len() - 1
        })
    }

    /// Returns the scene's meshes of a geometry in the materials that an instance binds.
    fn meshes(
        &mut self,
        model: &mut Model,
        geometry: usize,
        instance: usize,
    ) -> Result<Vec<(usize, DVec3)>> {
        let document = self.document;
        let common = document.find(instance, &["bind_material", "technique_common"]);
        let bound: Vec<usize> =
            common.into_iter().flat_map(|c| document.named(c, "instance_material")).collect();
        let text = |n, key| document.attribute(n, key).unwrap_or_default().to_owned();
        let key: Vec<_> = bound.iter().map(|&n| (text(n, "symbol"), text(n, "target"))).collect();
        let key = (geometry, key);
        if let Some(made) = self.made.get(&key) {
            return Ok(made.clone());
        }
        if !self.geometries.contains_key(&geometry) {
            let (budget, faults) = (&mut self.budget, &mut self.faults);
            let mut read = geometry::read(document, geometry, budget, faults)?;
            for piece in &mut read.pieces {
                polygon::recut(model, &mut piece.mesh, &self.limits)?;
            }
            self.geometries.insert(geometry, read);
        }
        let symbol = |n: usize| document.attribute(n, "symbol").unwrap_or_default();
        // Of equal ones the first counts.
        let symbols: HashMap<&str, usize> = bound.iter().rev().map(|&n| (symbol(n), n)).collect();
        let Geometry { pieces } = self.geometries.get(&geometry).cloned().unwrap_or_default();
        let mut made = Vec::new();
        for mut piece in pieces {
            let count = piece.mesh.primitive_count() as u64;
            self.budget.copied(count, || document.place(instance))?;
            self.bind(model, &mut piece, &symbols, instance);
            made.push((model.scene.meshes.len(), piece.origin));
            model.scene.meshes.push(piece.mesh);
        }
        self.made.insert(key, made.clone());
        Ok(made)
    }

    /// Assigns to the parts of a piece the materials that an instance binds to their symbols.
    fn bind(
        &mut self,
        model: &mut Model,
        piece: &mut Piece,
        symbols: &HashMap<&str, usize>,
        instance: usize,
    ) {
        let document = self.document;
        for (part, symbol) in piece.mesh.parts.iter_mut().zip(&piece.symbols) {
            let element = symbols.get(symbol.as_str()).copied();
            let target = element.and_then(|n| document.attribute(n, "target"));
            let is_input =
                |n: usize, channel: &str| document.attribute(n, "semantic") == Some(channel);
            let channels = |channel: &str| {
                let inputs =
                    element.into_iter().flat_map(|n| document.named(n, "bind_vertex_input"));
                let mut inputs = inputs.filter(|&n| is_input(n, channel));
                let set = inputs.find_map(|n| document.whole(n, "input_set"));
                let at = set.and_then(|set| piece.sets.iter().position(|s| *s == set));
                at.unwrap_or(0) as u32
            };
            // In many files without a binding, the symbol is the material's id.
            let id = target.unwrap_or(symbol);
            part.material = self.materials.get(model, id, &channels);
            if part.material.is_none() && !symbol.is_empty() {
                self.missing.add(|| document.place(element.unwrap_or(instance)));
            }
        }
        if !piece.mesh.colors.is_empty() {
            for part in piece.mesh.parts.iter_mut().filter(|p| p.material.is_none()) {
                part.material = Some(self.plain(model));
            }
        }
    }
}

/// Returns a matrix that is written row by row.
fn rows(m: &[f64; 16]) -> DMat4 {
    DMat4::from_cols_array(m).transpose()
}

/// Returns a transform element's matrix: `None` for other elements, `Some(None)` for broken
/// numbers.
fn transform(document: &Document<'_>, element: usize) -> Option<Option<DMat4>> {
    let vector = |v: [f64; 3]| DVec3::from(v);
    Some(match document.name(element) {
        "matrix" => document.vector::<16>(element).map(|m| rows(&m)),
        "translate" => document.vector(element).map(|v| DMat4::from_translation(vector(v))),
        "scale" => document.vector(element).map(|v| DMat4::from_scale(vector(v))),
        "rotate" => {
            document.vector::<4>(element).map(|[x, y, z, angle]| turn(DVec3::new(x, y, z), angle))
        }
        "lookat" => document.vector::<9>(element).map(|v| look_at(&v)),
        "skew" => document.vector::<7>(element).map(|v| skew(&v)),
        _ => return None,
    })
}

/// Returns a turn by degrees about an axis; about none, nothing.
fn turn(axis: DVec3, degrees: f64) -> DMat4 {
    let Some(a) = axis.try_normalize() else { return DMat4::IDENTITY };
    let angle = degrees.to_radians();
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    // Rodrigues: v cos + (a × v) sin + a (a · v) (1 − cos).
    let column = |v: DVec3| (v * cos + a.cross(v) * sin + a * (a.dot(v) * (1.0 - cos))).extend(0.0);
    DMat4::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z), DVec4::W)
}

/// Returns the matrix from the eye's frame, which looks along −z, to its parent's.
fn look_at(v: &[f64; 9]) -> DMat4 {
    let [eye, target, up] = [0, 3, 6].map(|i| DVec3::new(v[i], v[i + 1], v[i + 2]));
    let back = (eye - target).normalize_or_zero();
    let right = up.cross(back).normalize_or_zero();
    let up = back.cross(right);
    DMat4::from_cols(right.extend(0.0), up.extend(0.0), back.extend(0.0), eye.extend(1.0))
}

/// Returns a shear by degrees from one axis towards another (RenderMan's Skew).
fn skew(v: &[f64; 7]) -> DMat4 {
    let angle = v[0].to_radians();
    let along = DVec3::new(v[4], v[5], v[6]).normalize_or_zero();
    let from = DVec3::new(v[1], v[2], v[3]);
    let across = (from - along * from.dot(along)).normalize_or_zero();
    let cos = libm::cos(angle);
    let shift = if cos.abs() < 1e-9 { 0.0 } else { libm::sin(angle) / cos };
    let column = |e: DVec3| (e + along * (across.dot(e) * shift)).extend(0.0);
    DMat4::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z), DVec4::W)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transforms_are_matrices() {
        let of = |text: &str| {
            let document = Document::parse(text, 1 << 16).expect("well formed");
            transform(&document, 0).flatten().expect("a transform")
        };
        let near = |a: DVec3, b: DVec3| assert!((a - b).length() < 1e-12, "{a} {b}");
        let p = DVec3::new(1.0, 2.0, 3.0);
        let at = |text: &str| of(text).transform_point3(p);
        near(at("<matrix>1 0 0 5 0 2 0 6 0 0 1 7 0 0 0 1</matrix>"), DVec3::new(6.0, 10.0, 10.0));
        near(at("<translate>1 0 0</translate>"), DVec3::new(2.0, 2.0, 3.0));
        near(at("<scale>2 3 4</scale>"), DVec3::new(2.0, 6.0, 12.0));
        near(at("<rotate>0 0 2 90</rotate>"), DVec3::new(-2.0, 1.0, 3.0));
        near(at("<lookat>0 0 9 0 0 0 0 1 0</lookat>"), DVec3::new(1.0, 2.0, 12.0));
        near(at("<skew>45 0 1 0 1 0 0</skew>"), DVec3::new(3.0, 2.0, 3.0));
        let broken = Document::parse("<scale>2 3</scale>", 999).expect("well formed");
        assert_eq!(transform(&broken, 0), Some(None));
    }
}
