//! From an object to meshes of the scene.

use super::lattice;
use super::paint;
use super::part::Object;
use super::property::{Look, Properties};
use super::settings::{Settings, VolumeSettings};
use crate::{Error, Place, Result, color, place};
use durer::math::{DVec3, Vec2, Vec4};
use durer::scene::{AlphaMode, Material, Mesh, Part as MeshPart, TextureRef};
use std::collections::HashMap;

/// Default material of an object.
pub(super) struct Base<'a> {
    pub settings: &'a Settings,
    /// The number of the filament that it is printed with, from 1.
    pub filament: Option<u32>,
    /// Settings of runs of triangles, by the numbers of the first and the last; in order.
    pub volumes: &'a [(u64, u64, VolumeSettings)],
}

impl Base<'_> {
    /// Returns the colour of a filament, if the file gives it.
    fn color(&self, filament: Option<u32>) -> Option<Vec4> {
        let number = filament.unwrap_or(1);
        self.settings.has_filaments().then(|| self.settings.filament(number))
    }

    fn volume(&self, triangle: usize) -> Option<&VolumeSettings> {
        let number = triangle as u64;
        let after = self.volumes.partition_point(|(first, ..)| *first <= number);
        let (_, last, volume) = self.volumes.get(after.checked_sub(1)?)?;
        (number <= *last).then_some(volume)
    }

    /// Returns whether some triangles differ from others.
    fn differs(&self) -> bool {
        self.volumes.iter().any(|(_, _, v)| v.hidden || v.filament.is_some())
    }
}

/// Repairs of parts that could not be built as given by the file.
#[derive(Debug, Default)]
pub(super) struct Repairs {
    /// Triangles that name properties which the file has not.
    pub unknown: u64,
    /// Triangles whose paint is broken.
    pub paint: u64,
    /// Triangles that are modifiers and similar ones.
    pub hidden: u64,
    /// True if filaments are painted whose colour the file lacks.
    pub made_up: bool,
}

/// Materials of the scene, each found once.
pub(super) struct Materials<'a> {
    pub scene: &'a mut Vec<Material>,
    pub known: &'a mut HashMap<Key, usize>,
}

/// Identity of a material: name, bits of the colour, texture, blending.
pub(super) type Key = (String, [u32; 4], Option<usize>, bool);

impl Materials<'_> {
    fn of(&mut self, name: &str, color: Vec4, texture: Option<Texture>, blends: bool) -> usize {
        let image = texture.map(|t| t.number);
        let key = (name.to_owned(), color.to_array().map(f32::to_bits), image, blends);
        *self.known.entry(key).or_insert_with(|| {
            let reference =
                |texture| TextureRef { texture, tex_coord: 0, transform: Default::default() };
            self.scene.push(Material {
                name: name.to_owned(),
                base_color: color,
                base_color_texture: image.map(reference),
                alpha_mode: if blends { AlphaMode::Blend } else { AlphaMode::Opaque },
                ..Material::default()
            });
            self.scene.len() - 1
        })
    }
}

/// A texture of the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Texture {
    pub number: usize,
    pub blends: bool,
}

/// Makes an object's meshes, of triangles and of beams, and returns the origins of their positions; at most `limit`
/// triangles more than the object has.
///
/// # Errors
/// [`Error::Limit`].
pub(super) fn meshes(
    object: &mut Object,
    properties: &Properties,
    textures: &HashMap<u64, Texture>,
    base: &Base<'_>,
    materials: &mut Materials<'_>,
    repairs: &mut Repairs,
    limit: u64,
) -> Result<(Vec<Mesh>, DVec3)> {
    let origin = place::origin(&object.vertices);
    let mut meshes = Vec::new();
    let own = object.property.and_then(|(group, index)| properties.look(group, index));
    let plain = own.filter(|look| look.texture.is_none()).map(|look| look.color);
    let color = plain.or(base.color(base.filament));
    if let Some(lattice) = object.lattice.take() {
        let of = lattice.property.or(object.property);
        let own = of.and_then(|(group, index)| properties.look(group, index));
        let color = own.map(|l| l.color).or(color).unwrap_or(Material::default().base_color);
        let mut mesh =
            lattice::mesh(&lattice, &object.vertices, origin, (properties, color), limit)?;
        mesh.name.clone_from(&object.name);
        if mesh.primitive_count() > 0 {
            let blends = mesh.colors.iter().any(|c| c.w < 1.0);
            let material = materials.of(color::VERTEX_COLORS, Vec4::ONE, None, blends);
            whole(&mut mesh, Some(material));
            meshes.push(mesh);
        }
    }
    if object.triangles.is_empty() {
        return Ok((meshes, origin));
    }
    let textured = own.is_some_and(|look| look.texture.is_some());
    if object.properties.is_empty() && object.paint.is_empty() && !textured && !base.differs() {
        let name = object.property.map_or("", |(group, index)| properties.name(group, index));
        let material = color.map(|c| materials.of(name, c, None, c.w < 1.0));
        meshes.push(shared(object, origin, material));
    } else {
        let mut soup = Soup {
            properties,
            textures,
            base,
            own,
            repairs,
            buckets: Vec::new(),
            known: HashMap::new(),
            left: limit,
        };
        soup.fill(object)?;
        meshes.extend(soup.mesh(&object.name, origin, materials));
    }
    Ok((meshes, origin))
}

/// Assigns one material to a mesh.
fn whole(mesh: &mut Mesh, material: Option<usize>) {
    if material.is_some() {
        let range = 0..mesh.primitive_count() as u32;
        mesh.parts.push(MeshPart { range, material, name: String::new() });
    }
}

/// Takes the geometry of an object of one colour.
fn shared(object: &mut Object, origin: DVec3, material: Option<usize>) -> Mesh {
    let vertices = std::mem::take(&mut object.vertices);
    let triangles = std::mem::take(&mut object.triangles);
    let mut mesh = Mesh {
        name: object.name.clone(),
        positions: place::narrow(&vertices, origin),
        indices: Some(triangles.into_iter().flatten().collect()),
        ..Mesh::default()
    };
    whole(&mut mesh, material);
    mesh
}

/// Triangles whose corners share no vertex, because they look different.
struct Soup<'a> {
    properties: &'a Properties,
    textures: &'a HashMap<u64, Texture>,
    base: &'a Base<'a>,
    /// Look of the object as a whole.
    own: Option<Look>,
    repairs: &'a mut Repairs,
    buckets: Vec<Bucket>,
    /// Numbers of buckets by texture and blending.
    known: HashMap<(Option<usize>, bool), usize>,
    /// Triangles that paint may still add.
    left: u64,
}

/// Corners of triangles of one material.
struct Bucket {
    texture: Option<Texture>,
    blends: bool,
    corners: Vec<DVec3>,
    colors: Vec<Vec4>,
    places: Vec<Vec2>,
}

impl Soup<'_> {
    fn fill(&mut self, object: &Object) -> Result<()> {
        let mut properties = object.properties.iter().peekable();
        let mut painted = object.paint.iter().peekable();
        for (i, &triangle) in object.triangles.iter().enumerate() {
            let property = properties.next_if(|(t, ..)| *t as usize == i);
            let code = painted.next_if(|(t, _)| *t as usize == i).map(|(_, code)| &**code);
            let volume = self.base.volume(i);
            if volume.is_some_and(|v| v.hidden) {
                self.repairs.hidden += 1;
                continue;
            }
            let filament = volume.and_then(|v| v.filament);
            let looks = self.looks(property.map(|(_, group, p)| (*group, *p)), filament);
            let point = |v: u32| object.vertices.get(v as usize).copied().unwrap_or_default();
            let corners = triangle.map(point);
            match code {
                Some(code) => self.paint(code, corners, looks)?,
                None => self.add(corners, looks),
            }
        }
        Ok(())
    }

    /// Returns the looks of a triangle's corners: its own properties, its filament, or the
    /// object's.
    fn looks(&mut self, property: Option<(u64, [u64; 3])>, filament: Option<u32>) -> [Look; 3] {
        let grey = || Look::plain(Material::default().base_color);
        if let Some((group, corners)) = property {
            let looks = corners.map(|p| self.properties.look(group, p));
            self.repairs.unknown += u64::from(looks.contains(&None));
            return looks.map(|look| look.unwrap_or_else(grey));
        }
        let colored = self.base.color(filament.or(self.base.filament)).map(Look::plain);
        let own = if filament.is_some() { colored.or(self.own) } else { self.own.or(colored) };
        [own.unwrap_or_else(grey); 3]
    }

    fn paint(&mut self, code: &str, corners: [DVec3; 3], looks: [Look; 3]) -> Result<()> {
        let mut pieces = Vec::new();
        let whole =
            paint::divide(code, corners, |corners, filament| pieces.push((corners, filament)));
        self.repairs.paint += u64::from(!whole);
        let more = pieces.len() as u64 - 1;
        let Some(left) = self.left.checked_sub(more) else {
            let (what, value, limit) = ("number of painted pieces", more, self.left);
            return Err(Error::Limit { place: Place::Whole, what, value, limit });
        };
        self.left = left;
        if let [(_, 0)] = pieces[..] {
            self.add(corners, looks);
            return Ok(());
        }
        for (corners, filament) in pieces {
            let look = if filament == 0 {
                looks[0]
            } else {
                self.repairs.made_up |= !self.base.settings.has_filaments();
                Look::plain(self.base.settings.filament(filament))
            };
            self.add(corners, [look; 3]);
        }
        Ok(())
    }

    fn add(&mut self, corners: [DVec3; 3], looks: [Look; 3]) {
        let textured = looks.iter().find_map(|look| look.texture);
        let texture = textured.and_then(|(id, _)| self.textures.get(&id)).copied();
        let blends = looks.iter().any(|l| l.color.w < 1.0) || texture.is_some_and(|t| t.blends);
        let key = (texture.map(|t| t.number), blends);
        let at = *self.known.entry(key).or_insert_with(|| {
            let (corners, colors, places) = Default::default();
            self.buckets.push(Bucket { texture, blends, corners, colors, places });
            self.buckets.len() - 1
        });
        let bucket = &mut self.buckets[at];
        bucket.corners.extend(corners);
        if texture.is_some() {
            bucket.places.extend(looks.map(|l| l.texture.map_or(Vec2::ZERO, |(_, place)| place)));
        }
        // Triangles with a missing texture are grey.
        let lost = textured.is_some() && texture.is_none();
        let grey = Material::default().base_color;
        bucket.colors.extend(looks.map(|l| if lost { l.color * grey } else { l.color }));
    }

    /// Puts the corners of all materials one behind the other.
    fn mesh(self, name: &str, origin: DVec3, materials: &mut Materials<'_>) -> Option<Mesh> {
        let mut mesh = Mesh { name: name.to_owned(), ..Mesh::default() };
        let textured = self.buckets.iter().any(|b| b.texture.is_some());
        let mut places = Vec::new();
        for mut bucket in self.buckets {
            let first = (mesh.positions.len() / 3) as u32;
            mesh.positions.extend(bucket.corners.iter().map(|p| (*p - origin).as_vec3()));
            mesh.colors.append(&mut bucket.colors);
            places.append(&mut bucket.places);
            if textured {
                places.resize(mesh.positions.len(), Vec2::ZERO);
            }
            let material =
                materials.of(color::VERTEX_COLORS, Vec4::ONE, bucket.texture, bucket.blends);
            let range = first..(mesh.positions.len() / 3) as u32;
            mesh.parts.push(MeshPart { range, material: Some(material), name: String::new() });
        }
        if textured {
            mesh.tex_coords.push(places);
        }
        (!mesh.positions.is_empty()).then_some(mesh)
    }
}
