//! From the build to the scene: the placement of objects, and their components.

use super::mesh::{self, Base, Key, Materials, Repairs, Texture};
use super::package::Package;
use super::part::{self, Faults, Part, Use};
use super::property::Texture2d;
use super::settings::{Settings, VolumeSettings};
use crate::budget::MODEL;
use crate::text::Tally;
use crate::{Error, Limits, Model, Place, Result, image, place};
use durer::math::{DMat4, DVec3};
use durer::scene::{self, Image, Instance, Sampler};
use std::collections::HashSet;
use std::collections::hash_map::{Entry, HashMap};

/// An object of a part, by the part's number and the object's id.
type Id = (usize, u64);

/// Places objects.
pub(super) struct Assembly<'a, 'b> {
    pub model: &'a mut Model,
    pub package: &'a mut Package<'b>,
    pub settings: Settings,
    limits: Limits,
    parts: Vec<Part>,
    /// Names of the parts, and their numbers by name.
    names: Vec<String>,
    numbers: HashMap<String, usize>,
    primitives: u64,
    /// Components and items followed: bounds the work where nested components multiply.
    visits: u64,
    placements: Vec<Placement>,
    hidden: Tally,
    empty: Tally,
    aside: Tally,
    /// Indices of pictures in the scene by path, and whether they have transparent pixels.
    pictures: HashMap<String, Option<(usize, bool)>>,
    /// Scene's numbers of textures.
    samplers: HashMap<(usize, Sampler), usize>,
    /// Textures of parts, by id.
    textures: HashMap<usize, HashMap<u64, Texture>>,
    materials: HashMap<Key, usize>,
}

/// A mesh to be made and shown.
struct Placement {
    object: Id,
    /// The item of the build that it belongs to.
    item: u64,
    filament: Option<u32>,
    world_from_object: DMat4,
}

/// An object whose components are being followed.
struct Frame {
    object: Id,
    next: usize,
    world_from_object: DMat4,
}

/// Bytes of a triangle made from a beam, a ball or paint.
const PER_TRIANGLE: u64 = 36;

/// Indices of an object's meshes in the scene, and the origin of their positions.
type Made = (Vec<usize>, DVec3);

impl<'a, 'b> Assembly<'a, 'b> {
    pub fn new(model: &'a mut Model, package: &'a mut Package<'b>, limits: Limits) -> Self {
        let settings = Settings::read(package, model);
        Self {
            model,
            package,
            settings,
            limits,
            parts: Vec::new(),
            names: Vec::new(),
            numbers: HashMap::new(),
            primitives: 0,
            visits: 0,
            placements: Vec::new(),
            hidden: Tally::default(),
            empty: Tally::default(),
            aside: Tally::default(),
            pictures: HashMap::new(),
            samplers: HashMap::new(),
            textures: HashMap::new(),
            materials: HashMap::new(),
        }
    }

    /// Builds the items of the root part, or of one plate, counted from 1.
    ///
    /// # Errors
    /// Those of [`super::read`].
    pub fn build(&mut self, root: &str, plate: Option<u32>) -> Result<()> {
        let root = self.load(root)?;
        let items = self.parts[root].items.clone();
        let scale = DMat4::from_scale(DVec3::splat(self.parts[root].millimetres));
        for item in self.on_plate(items, plate)? {
            self.place(root, &item, scale)?;
        }
        self.make()?;
        self.warn();
        Ok(())
    }

    /// Returns the items on a plate.
    fn on_plate(&self, items: Vec<Use>, plate: Option<u32>) -> Result<Vec<Use>> {
        let Some(number) = plate else { return Ok(items) };
        let plates = &self.settings.plates;
        let Some(plate) = (number as usize).checked_sub(1).and_then(|i| plates.get(i)) else {
            let known = match plates.len() {
                0 => "it has no plates".to_owned(),
                n => format!("its plates are 1 to {n}"),
            };
            return Err(Error::whole(format!("the file has no plate {number}: {known}")));
        };
        let wanted: HashSet<(u64, u64)> = plate.instances.iter().copied().collect();
        let mut counts: HashMap<u64, u64> = HashMap::new();
        let stands = |item: &Use| {
            let count = counts.entry(item.object).or_default();
            *count += 1;
            wanted.contains(&(item.object, *count - 1))
        };
        Ok(items.into_iter().filter(stands).collect())
    }

    /// Reads a part, once.
    fn load(&mut self, name: &str) -> Result<usize> {
        if let Some(&number) = self.numbers.get(name) {
            return Ok(number);
        }
        let xml = self.package.read_text(name)?;
        let left = self.limits.primitives.saturating_sub(self.primitives);
        let mut part = part::parse(name, &xml, left)?;
        self.primitives += part.triangles;
        warn_of_faults(self.model, std::mem::take(&mut part.faults));
        self.parts.push(part);
        self.names.push(name.to_owned());
        self.numbers.insert(name.to_owned(), self.parts.len() - 1);
        Ok(self.parts.len() - 1)
    }

    /// Returns the path of an object, for messages.
    fn at(&self, (part, id): Id) -> String {
        format!("{}, object {id}", self.names[part])
    }

    /// Records the positions of an item's object and its components.
    fn place(&mut self, root: usize, item: &Use, world: DMat4) -> Result<()> {
        let mut inside: HashSet<Id> = HashSet::new();
        let mut stack = Vec::new();
        stack.extend(self.enter(root, item, item.object, world, &mut inside)?);
        while let Some(frame) = stack.last_mut() {
            let (part, id) = frame.object;
            let world = frame.world_from_object;
            let components = self.parts[part].objects.get(&id).map_or(&[][..], |o| &o.components);
            let Some(component) = components.get(frame.next).cloned() else {
                inside.remove(&frame.object);
                stack.pop();
                continue;
            };
            frame.next += 1;
            stack.extend(self.enter(part, &component, item.object, world, &mut inside)?);
        }
        Ok(())
    }

    /// Records the place of an object; the frame is for its components.
    fn enter(
        &mut self,
        from: usize,
        used: &Use,
        item: u64,
        world: DMat4,
        inside: &mut HashSet<Id>,
    ) -> Result<Option<Frame>> {
        let part = used.path.as_deref().map_or(Ok(from), |path| self.load(path))?;
        let object = (part, used.object);
        self.visits += 1;
        let (value, limit) = (self.visits, self.limits.instances);
        if value > limit {
            let place = Place::Path(self.names[part].clone());
            return Err(Error::Limit { place, what: "number of placed components", value, limit });
        }
        if !inside.insert(object) {
            let message = "contains itself; components must not form a cycle";
            return Err(Error::path(self.at(object), message));
        }
        let Some(found) = self.parts[part].objects.get(&used.object) else {
            let message = "does not exist, but an item or component names it";
            return Err(Error::path(self.at(object), message));
        };
        let root_item = inside.len() == 1;
        let settings = self.settings.object(item);
        let component = Some(used.object).filter(|_| !root_item);
        let VolumeSettings { filament, hidden } =
            settings.map(|s| s.of_component(component)).unwrap_or_default();
        let world_from_object = world * used.transform;
        let skipped = if hidden {
            Some(&mut self.hidden)
        } else if found.aside && root_item {
            Some(&mut self.aside)
        } else {
            None
        };
        if let Some(tally) = skipped {
            tally.add(|| Place::Path(format!("{}, object {}", self.names[part], used.object)));
            inside.remove(&object);
            return Ok(None);
        }
        if !found.triangles.is_empty() || found.lattice.is_some() {
            self.placements.push(Placement { object, item, filament, world_from_object });
        } else if found.components.is_empty() {
            self.empty.add(|| Place::Path(format!("{}, object {}", self.names[part], used.object)));
        }
        Ok(Some(Frame { object, next: 0, world_from_object }))
    }

    /// Makes the meshes and instances that are noted.
    fn make(&mut self) -> Result<()> {
        let mut made: HashMap<(Id, Option<u32>, Option<u64>), Made> = HashMap::new();
        let mut repairs = Repairs::default();
        let mut items: Vec<u64> = Vec::new();
        for p in std::mem::take(&mut self.placements) {
            if items.last() != Some(&p.item) {
                items.push(p.item);
            }
            // Only runs of triangles make a mesh depend on the item.
            let volumes = self.settings.object(p.item).is_some_and(|s| !s.volumes.is_empty());
            let key = (p.object, p.filament, volumes.then_some(p.item));
            let (meshes, origin) = match made.entry(key) {
                Entry::Occupied(known) => known.into_mut(),
                Entry::Vacant(new) => new.insert(self.meshes(&p, &mut repairs)?),
            };
            let object = self.parts[p.object.0].objects.get(&p.object.1);
            let name = object.map_or("", |o| &o.name);
            let world_from_mesh = p.world_from_object * place::matrix(*origin);
            let instance = |&mesh| Instance { mesh, world_from_mesh, name: name.to_owned() };
            let scene = &mut self.model.scene;
            scene.instances.extend(meshes.iter().map(instance));
            scene.trees.resize(scene.instances.len(), items.len() as u32);
        }
        warn_of_repairs(self.model, &repairs);
        Ok(())
    }

    fn meshes(&mut self, p: &Placement, repairs: &mut Repairs) -> Result<Made> {
        let (part, id) = p.object;
        self.load_textures(p.object);
        let none = HashMap::new();
        let textures = self.textures.get(&part).unwrap_or(&none);
        let left = self.limits.primitives.saturating_sub(self.primitives);
        let Part { objects, properties, .. } = &mut self.parts[part];
        let Some(object) = objects.get_mut(&id) else { return Ok(Made::default()) };
        let settings = self.settings.object(p.item);
        let base = Base {
            settings: &self.settings,
            filament: p.filament,
            volumes: settings.map_or(&[], |s| &s.volumes),
        };
        let scene = &mut self.model.scene;
        let known = &mut self.materials;
        let mut materials = Materials { scene: &mut scene.materials, known };
        let triangles = object.triangles.len() as u64;
        let (meshes, origin) =
            mesh::meshes(object, properties, textures, &base, &mut materials, repairs, left)?;
        let first = scene.meshes.len();
        let count: u64 = meshes.iter().map(|m| m.primitive_count() as u64).sum();
        let more = count.saturating_sub(triangles);
        self.primitives += more;
        self.limits.work.keep(MODEL, more.saturating_mul(PER_TRIANGLE))?;
        scene.meshes.extend(meshes);
        Ok(((first..scene.meshes.len()).collect(), origin))
    }

    /// Reads a part's textures, once, where an object may have some.
    fn load_textures(&mut self, (part, id): Id) {
        let Part { objects, properties, .. } = &self.parts[part];
        let some =
            objects.get(&id).is_some_and(|o| o.property.is_some() || !o.properties.is_empty());
        if !some || self.textures.contains_key(&part) {
            return;
        }
        let all = properties.textures.iter();
        let mut wanted: Vec<_> = all.map(|(id, t)| (*id, t.clone())).collect();
        wanted.sort_by_key(|(id, _)| *id);
        let mut textures = HashMap::new();
        for (id, Texture2d { path, sampler }) in wanted {
            let Some((image, blends)) = self.picture(&path) else { continue };
            let scene = &mut self.model.scene.textures;
            let number = *self.samplers.entry((image, sampler)).or_insert_with(|| {
                scene.push(scene::Texture { image, sampler });
                scene.len() - 1
            });
            textures.insert(id, Texture { number, blends });
        }
        self.textures.insert(part, textures);
    }

    /// Returns the index of a picture in the scene, read once, and whether it has transparent pixels.
    fn picture(&mut self, path: &str) -> Option<(usize, bool)> {
        if let Some(known) = self.pictures.get(path) {
            return *known;
        }
        let found = self.decode(path).map_err(|why| {
            self.model
                .warn(Place::Path(path.to_owned()), format!("the texture is left out: {why}"));
        });
        let found = found.ok().map(|image| {
            let images = &mut self.model.scene.images;
            let blends = image.data.iter().any(|p| p[3] < 255);
            images.push(image);
            (images.len() - 1, blends)
        });
        self.pictures.insert(path.to_owned(), found);
        found
    }

    fn decode(&mut self, path: &str) -> std::result::Result<Image, String> {
        let bytes = self.package.read(path).map_err(|e| e.to_string())?;
        let limits = Limits { decoded_bytes: self.package.left(), ..self.limits.clone() };
        let image = image::decode(&bytes, path, &limits).map_err(|e| e.to_string())?;
        self.package.charge(4 * image.data.len() as u64);
        Ok(image)
    }

    fn warn(&mut self) {
        for (tally, what) in [
            (
                &self.hidden,
                "{part is a modifier, hole or place for supports; it is|parts are modifiers, holes or places for supports; they are} left out",
            ),
            (
                &self.aside,
                "{item is an object of the type `other`, which is|items are objects of the type `other`, which are} not to be built; left out",
            ),
            (
                &self.empty,
                "{object has|objects have} neither triangles nor beams; nothing else is read",
            ),
        ] {
            self.model.warn_of(tally, what);
        }
    }
}

fn warn_of_faults(model: &mut Model, faults: Faults) {
    for (tally, what) in [
        (
            faults.colors,
            "{color is not #RRGGBB or #RRGGBBAA; it is|colors are not #RRGGBB or #RRGGBBAA; they are} grey",
        ),
        (
            faults.vertices,
            "{triangle refers to vertices that the object does not have; it is|triangles refer to vertices that the object does not have; they are} left out",
        ),
        (
            faults.beams,
            "{beam or ball refers to vertices that the object does not have; it is|beams or balls refer to vertices that the object does not have; they are} left out",
        ),
        (
            faults.clipped,
            "beam {lattice is|lattices are} to be cut at another mesh; {it is|they are} shown whole",
        ),
        (
            faults.layers,
            "{multiproperty lays|multiproperties lay} pictures and colors over each other; of these one is shown",
        ),
    ] {
        model.warn_of(&tally, what);
    }
}

fn warn_of_repairs(model: &mut Model, repairs: &Repairs) {
    for (count, what) in [
        (
            repairs.unknown,
            "{triangle refers to properties that the file does not have; there it is|triangles refer to properties that the file does not have; there they are} grey",
        ),
        (
            repairs.paint,
            "{triangle has|triangles have} an invalid paint code; the rest of the code is ignored",
        ),
        (
            repairs.hidden,
            "{triangle is a modifier, hole or place for supports; it is|triangles are modifiers, holes or places for supports; they are} left out",
        ),
    ] {
        model.warn_counted(Place::Whole, count, what);
    }
    if repairs.made_up {
        let message = "painted for filaments whose colors the file does not say; they are made up";
        model.warn(Place::Whole, message);
    }
}
