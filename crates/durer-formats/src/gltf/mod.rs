//! glTF 2.0, text and binary (Khronos, 2017; ISO/IEC 12113:2022).
//!
//! The reader takes meshes of all seven primitive modes, as one [`durer::scene::Mesh`] per primitive and one instance
//! per node and primitive; the nodes of one scene depth first, around the centre of CESIUM_RTC; sparse, interleaved, normalized and quantized
//! accessors; buffer views compressed by meshopt; primitives compressed by Draco (feature `draco`); materials with
//! their textures, layers and variants; cameras; lights; skins and morph targets, posed at one moment of an animation;
//! instances by attributes. The known extensions are listed in `extension.rs`.
//!
//! Every reference and size of a file is checked before any data are read, also in parts that are not drawn; errors
//! give their path in the JSON. If data themselves are broken or missing, the parts that need them are left out as long
//! as something else remains. Nothing recurses, and memory is charged to [`crate::Limits`] before it is taken.

mod accessor;
mod animation;
mod broken;
mod buffer;
mod bytes;
mod check;
mod choice;
mod container;
mod deform;
mod derived;
#[cfg(feature = "draco")]
mod draco;
#[cfg(not(feature = "draco"))]
#[path = "no_draco.rs"]
mod draco;
mod extension;
mod eye;
mod geometry;
mod instancing;
mod json;
mod material;
mod meshopt;
mod missing;
mod node;
mod normals;
mod old;
mod placing;
mod primitive;
mod specular_glossiness;
mod surface;
mod texture_ref;
mod todo;
mod variant;

use crate::{Error, Model, Place, ReadOptions, Resources, Result};
use broken::Broken;
use buffer::{Budget, Source};
use bytes::Bytes;
use durer::math::DMat4;
use durer::scene::{Instance, Mesh, Part, Scene, UpAxis};
use geometry::Geometry;
use json::{Node, Root, Whole};
use node::Override;
use placing::Placing;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io::{Read, Seek, SeekFrom};

/// Returns whether the bytes look like glTF: the mark of a binary file, or JSON with an `asset`.
pub fn sniff(bytes: &[u8]) -> bool {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
    let holds = |key: &[u8]| text.windows(key.len()).any(|w| w == key);
    is_binary(bytes) || (text.starts_with(b"{") && holds(b"\"asset\""))
}

/// Returns whether the bytes begin as a binary file does.
pub fn is_binary(bytes: &[u8]) -> bool {
    bytes.starts_with(container::MAGIC)
}

/// Reads a model, `.gltf` or `.glb`, posed as `options.pose` says.
///
/// Buffers and images that the file refers to come from `resources`, which decides which references are allowed. An
/// image that is missing or broken is drawn white, and a primitive that is broken, or whose buffer is missing, is left
/// out if something else remains, each with a warning. Linear in the data that are drawn.
///
/// ```
/// use durer_formats::{NoResources, ReadOptions, gltf};
/// let file = br#"{"asset": {"version": "2.0"},
///     "accessors": [{"componentType": 5126, "count": 3, "type": "VEC3"}],
///     "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
///     "nodes": [{"mesh": 0, "name": "all in one point"}]}"#;
/// let model = gltf::read(file, &NoResources, &ReadOptions::default())?;
/// assert_eq!(model.scene.triangle_count(), 1);
/// # Ok::<(), durer_formats::Error>(())
/// ```
///
/// # Errors
/// [`Error::Decode`] with the byte of the container, the line of the JSON or the path in it; [`Error::Unsupported`] for
/// a required extension or a version that is not known; [`Error::Resource`] for a buffer that cannot be read, and
/// [`Error::Decode`] for a broken primitive, if nothing is left to draw without it; [`Error::Limit`].
pub fn read(bytes: &[u8], resources: &dyn Resources, options: &ReadOptions) -> Result<Model> {
    read_parts(&Bytes::Held(bytes), resources, options)
}

/// Reads a model from an open file whose binary chunk is never in memory as a whole, only the model made of it. The
/// model is that of [`read`] with the file's bytes.
///
/// # Errors
/// As [`read`]; [`Error::Limit`] for a file of more bytes than may be decoded, [`Error::Io`] if it cannot be read.
pub fn read_file(
    mut file: impl Read + Seek,
    resources: &dyn Resources,
    options: &ReadOptions,
) -> Result<Model> {
    let (length, limit) = (file.seek(SeekFrom::End(0))?, options.limits.decoded_bytes);
    if length > limit {
        return Err(Error::Limit { place: Place::Whole, what: "size", value: length, limit });
    }
    read_parts(&Bytes::InFile(&RefCell::new(file), 0..length), resources, options)
}

fn read_parts(file: &Bytes<'_>, resources: &dyn Resources, options: &ReadOptions) -> Result<Model> {
    let mut model = Model::default();
    let container = container::split(file, &mut model.warnings)?;
    let kind = if container.binary { "binary" } else { "text" };
    model.format = format!("glTF 2.0 {kind}");
    let root = json::parse(container.json())?;
    check_version(&root)?;
    extension::check(&root, &mut model)?;
    check::references(&root)?;
    let tree = node::Tree::of(&root, options.limits.instances)?;
    let budget = Budget::new(options.limits.clone());
    let source = Source::load(&root, &container, resources, &budget, &mut model.warnings)?;
    model.animations = animation::names(&root);
    model.variants = variant::names(&root);
    let variant = variant::find(&model.variants, options.variant.as_deref())?;
    model.scenes = choice::names("scene", root.scenes.iter().map(|scene| &scene.name));
    let scene = choice::find("scene", &model.scenes, options.scene.as_deref(), "scenes")?;
    let pose = animation::pose(&source, options.pose.as_ref())?;
    if options.pose.is_some() && root.animations.is_empty() {
        model.warn(Place::Path("animations".into()), "there is none; the rest pose is taken");
    }
    let world = tree.world_matrices(&root, &pose, extension::center(&root));
    let warnings = &mut model.warnings;
    let nodes = tree.scene_nodes(&root, scene, |n| {
        let message = "is in the scene but has a parent; drawn once, below its parent".to_owned();
        warnings.push(crate::Warning { place: Place::Path(format!("nodes[{n}]")), message });
    });
    if scene.is_none() {
        warn_of_missing_scene(&root, &nodes, &mut model);
        warn_of_other_scenes(&root, &nodes, &mut model);
    }
    let visible = tree.visible(&root);
    let mut builder = Builder {
        source: &source,
        world: &world,
        pose: &pose,
        variant,
        made: BTreeMap::new(),
        broken: Broken::default(),
    };
    for &n in nodes.iter().filter(|n| visible[**n]) {
        builder.place(n, &mut model)?;
    }
    builder.broken.warn(source.missing(), &mut model)?;
    model.scene.up_axis = UpAxis::Y;
    material::read(&source, resources, &mut model.scene, &mut model.warnings)?;
    // Hidden cameras can still be used; hidden lights do not shine.
    eye::cameras(&source, &nodes, &world, &mut model.scene, &mut model.warnings);
    let mut shining = nodes;
    shining.retain(|n| visible[*n]);
    model.scene.lights = eye::lights(&source, &shining, &world, &mut model.warnings);
    model.scene.check()?;
    Ok(model)
}

/// Warns where the default scene, or any, is missing.
fn warn_of_missing_scene(root: &Root, nodes: &[usize], model: &mut Model) {
    let scenes = root.scenes.len();
    if scenes == 0 && !nodes.is_empty() {
        model.warn(Place::Path("scenes".into()), "there is none; all root nodes are shown");
    } else if let Some(scene) = root.scene.map(Whole::index).filter(|&s| s >= scenes) {
        let shown = if scenes == 0 { "nothing is shown" } else { "the first one is shown" };
        let message = format!("there is no scene {scene} among {scenes}; {shown}");
        model.warn(Place::Path("scene".into()), message);
    }
}

/// Warns of scenes with objects that the scene that is shown does not have.
fn warn_of_other_scenes(root: &Root, shown: &[usize], model: &mut Model) {
    let mut lost = vec![false; root.nodes.len()];
    for (lost, node) in lost.iter_mut().zip(&root.nodes) {
        *lost = node.mesh.is_some() || !node.children.is_empty();
    }
    for &node in shown {
        lost[node] = false;
    }
    let others = root.scenes.iter().filter(|scene| scene.nodes.iter().any(|n| lost[n.index()]));
    let words = "further {scene has objects that are not shown; --scene chooses it|scenes have objects that are not shown; --scene chooses one}";
    model.warn_counted(Place::Path("scenes".into()), others.count() as u64, words);
}

/// Checks the version: only version 2 is read, and of it 2.0.
fn check_version(root: &Root) -> Result<()> {
    let asset = root.asset.clone().ok_or_else(|| Error::whole("`asset` is missing"))?;
    let version = asset.version.ok_or_else(|| Error::path("asset", "`version` is missing"))?;
    let wanted = asset.min_version.as_deref().unwrap_or(&version);
    let known = match asset.min_version {
        Some(_) => wanted == "2.0",
        None => version.split('.').next() == Some("2"),
    };
    if known {
        return Ok(());
    }
    Err(old::unsupported(Place::Path("asset.version".to_owned()), wanted))
}

/// Builder of the meshes and instances of nodes.
struct Builder<'a> {
    source: &'a Source<'a>,
    world: &'a [DMat4],
    pose: &'a [Override],
    /// The number of the variant that is shown.
    variant: Option<u64>,
    /// Scene meshes of a file's mesh and primitive as in the file, neither morphed nor skinned;
    /// `None` for a primitive that draws nothing.
    made: BTreeMap<(usize, usize), Option<usize>>,
    /// Parts that could not be read.
    broken: Broken,
}

impl Builder<'_> {
    /// Adds the instances of a node's mesh. Primitives that are broken, or whose data are missing, are left out.
    ///
    /// # Errors
    /// A limit; [`Error::Io`].
    fn place(&mut self, n: usize, model: &mut Model) -> Result<()> {
        let Some(mesh) = self.source.root.nodes[n].mesh.map(Whole::index) else { return Ok(()) };
        let placing = match Placing::of(self.source, self.world, self.weights(n, mesh), n, model) {
            Ok(placing) => placing,
            Err(error) => return self.broken.take(error, path(mesh, 0)),
        };
        let primitives = self.source.root.meshes[mesh].primitives.len();
        let name = name(&self.source.root.nodes[n]);
        self.charge(placing.places.len() as u64, primitives as u64, name.len(), n)?;
        for p in 0..primitives {
            match self.mesh(mesh, p, &placing, model) {
                Ok(Some((mesh, skinned))) => placing.add(mesh, skinned, &name, model),
                Ok(None) => {}
                Err(error) => self.broken.take(error, path(mesh, p))?,
            }
        }
        Ok(())
    }

    /// Charges the instances of this many primitives at this many places.
    fn charge(&self, places: u64, primitives: u64, name: usize, n: usize) -> Result<()> {
        let (count, at) = (places.saturating_mul(primitives), format!("nodes[{n}]"));
        self.source.budget.instances(count, &at)?;
        let bytes = (size_of::<Instance>() as u64).saturating_add(name as u64);
        self.source.budget.bytes(count.saturating_mul(bytes), &at)
    }

    /// Returns the scene mesh of a primitive, and whether it is skinned; `None` if it draws
    /// nothing.
    fn mesh(
        &mut self,
        mesh: usize,
        p: usize,
        placing: &Placing,
        model: &mut Model,
    ) -> Result<Option<(usize, bool)>> {
        let (made, skinned) = match &placing.joints {
            None if placing.weights.iter().all(|w| *w == 0.0) => {
                (self.unposed(mesh, p, model)?, false)
            }
            joints => self.posed(mesh, p, &placing.weights, joints.as_deref(), model)?,
        };
        Ok(made.map(|mesh| (mesh, skinned)))
    }

    /// Returns the weights of a node's morph targets: of the animation, else the node's, else the
    /// mesh's.
    fn weights(&self, n: usize, mesh: usize) -> Vec<f32> {
        let node = &self.source.root.nodes[n];
        let rest = node.weights.as_ref().unwrap_or(&self.source.root.meshes[mesh].weights);
        self.pose[n].weights.as_ref().unwrap_or(rest).clone()
    }

    /// Returns the scene mesh of a primitive as in the file, made once.
    fn unposed(&mut self, mesh: usize, p: usize, model: &mut Model) -> Result<Option<usize>> {
        if let Some(made) = self.made.get(&(mesh, p)) {
            return Ok(*made);
        }
        let geometry = self.geometry(mesh, p, model).inspect_err(|_| {
            // It is left out everywhere and reported once.
            self.made.insert((mesh, p), None);
        })?;
        let made = geometry.map(|g| self.add(g, mesh, p, &mut model.scene));
        self.made.insert((mesh, p), made);
        Ok(made)
    }

    /// Returns a scene mesh of a primitive, morphed and skinned, and whether it was skinned.
    fn posed(
        &self,
        mesh: usize,
        p: usize,
        weights: &[f32],
        joints: Option<&[DMat4]>,
        model: &mut Model,
    ) -> Result<(Option<usize>, bool)> {
        let at = path(mesh, p);
        let primitive = &self.source.root.meshes[mesh].primitives[p];
        let Some(mut g) = self.geometry(mesh, p, model)? else { return Ok((None, false)) };
        deform::morph(self.source, &mut g, primitive, weights, &at)?;
        let joints = joints.filter(|_| !g.influences.is_empty());
        if let Some(joints) = joints {
            deform::skin(&mut g, joints, &at)?;
        }
        normals::repair(&mut g);
        Ok((Some(self.add(g, mesh, p, &mut model.scene)), joints.is_some()))
    }

    /// Reads a primitive; each kind of repair gives one warning.
    fn geometry(&self, mesh: usize, p: usize, model: &mut Model) -> Result<Option<Geometry>> {
        let at = path(mesh, p);
        let primitive = &self.source.root.meshes[mesh].primitives[p];
        let mut geometry = primitive::read(self.source, primitive, &at)?;
        let notes = match &mut geometry {
            Some(g) => std::mem::take(&mut g.notes),
            None => vec!["has no positions; left out".to_owned()],
        };
        for message in notes {
            let warning = crate::Warning { place: Place::Path(at.clone()), message };
            if !model.warnings.contains(&warning) {
                model.warnings.push(warning);
            }
        }
        Ok(geometry)
    }

    /// Adds a mesh to the scene.
    fn add(&self, g: Geometry, mesh: usize, p: usize, scene: &mut Scene) -> usize {
        let file_mesh = &self.source.root.meshes[mesh];
        let material = variant::material(&file_mesh.primitives[p], self.variant).map(Whole::index);
        let mut made = Mesh { name: file_mesh.name.clone().unwrap_or_default(), ..g.mesh };
        // Below 2³²: the limit on primitives and the width of indices see to it.
        let range = 0..u32::try_from(made.primitive_count()).unwrap_or(u32::MAX);
        made.parts = vec![Part { range, material, name: String::new() }];
        scene.meshes.push(made);
        scene.meshes.len() - 1
    }
}

fn path(mesh: usize, primitive: usize) -> String {
    format!("meshes[{mesh}].primitives[{primitive}]")
}

fn name(node: &Node) -> String {
    node.name.clone().unwrap_or_default()
}
