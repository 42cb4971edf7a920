//! Textures that the scene needs and the file does not have, computed from the file's textures texel by texel.

use super::buffer::Source;
use super::specular_glossiness::Glossy;
use super::todo::{Job, Todo, What};
use crate::{Result, texels};
use durer::math::{Vec3, Vec4};
use durer::scene::{AlphaMode, Image, Material, Scene, Texture, TextureRef};
use durer::shade::color::{decode_rgba8, decode_unorm8, encode_unorm8};
use std::collections::BTreeMap;

/// Share of the light that a clear pane lets through; the rest shows the pane itself.
const CLEAR: f32 = 0.85;

/// Runs all jobs.
///
/// # Errors
/// If the new images are above the limits.
pub fn run(source: &Source<'_>, scene: &mut Scene, todo: &mut Todo) -> Result<()> {
    let jobs = std::mem::take(&mut todo.jobs);
    let mut maker = Maker { source, scene, todo, means: BTreeMap::new(), made: BTreeMap::new() };
    for job in &jobs {
        match job.what {
            What::Mean { srgb, set } => {
                let mean = maker.mean(job.texture, srgb);
                set(&mut maker.scene.materials[job.material], mean);
            }
            What::Glossy(glossy) => maker.glossy(job, glossy)?,
            What::Glass => maker.glass(job)?,
        }
    }
    if !jobs.is_empty() {
        forget_unused(scene);
    }
    Ok(())
}

/// Empties images that no material uses any longer.
fn forget_unused(scene: &mut Scene) {
    let mut used = vec![false; scene.images.len()];
    for texture in scene.materials.iter().flat_map(Material::textures) {
        used[scene.textures[texture.texture].image] = true;
    }
    let unused = scene.images.iter_mut().zip(used).filter(|(_, used)| !used);
    unused.for_each(|(image, _)| *image = Image::default());
}

/// Inputs of a derived texture: two textures, and the factors' bits.
type Key = ([Option<usize>; 2], Vec<u32>);

struct Maker<'a> {
    source: &'a Source<'a>,
    scene: &'a mut Scene,
    todo: &'a mut Todo,
    /// Means of images, as sRGB or not.
    means: BTreeMap<(usize, bool), Vec4>,
    made: BTreeMap<Key, Vec<usize>>,
}

impl Maker<'_> {
    /// Returns the image of a texture; `None` if there is none, or it could not be read.
    fn image(&self, texture: Option<TextureRef>) -> Option<&Image> {
        let image = &self.scene.images[self.scene.textures[texture?.texture].image];
        Some(image).filter(|image| !image.data.is_empty())
    }

    /// Returns the linear mean of a texture; white if it has no image.
    fn mean(&mut self, texture: Option<TextureRef>, srgb: bool) -> Vec4 {
        let Some(image) = self.image(texture) else { return Vec4::ONE };
        let key = (self.scene.textures[texture.map_or(0, |t| t.texture)].image, srgb);
        if let Some(mean) = self.means.get(&key) {
            return *mean;
        }
        let linear = |texel: &[u8; 4]| {
            if srgb { decode_rgba8(*texel) } else { Vec4::from(texel.map(decode_unorm8)) }
        };
        let sum: durer::math::DVec4 = image.data.iter().map(|t| linear(t).as_dvec4()).sum();
        let mean = (sum / image.data.len() as f64).as_vec4();
        self.means.insert(key, mean);
        mean
    }

    /// Makes N textures of two, laid on as the first of them that is there; each is made once.
    fn make<const N: usize>(
        &mut self,
        job: &Job,
        from: [Option<TextureRef>; 2],
        factors: &[f32],
        texel: impl Fn([Option<[u8; 4]>; 2]) -> [[u8; 4]; N],
    ) -> Result<Option<[TextureRef; N]>> {
        let Some(placed) = from[0].or(from[1]) else { return Ok(None) };
        let textures = from.map(|texture| texture.map(|t| t.texture));
        let key = (textures, factors.iter().map(|f| f.to_bits()).chain([N as u32]).collect());
        if !self.made.contains_key(&key) {
            let images = from.map(|texture| self.image(texture));
            let Some([width, height]) = texels::size(images) else { return Ok(None) };
            let at = format!("materials[{}]", job.material);
            let bytes = u64::from(width) * u64::from(height) * 4 * N as u64;
            // Several textures are computed in one list.
            self.source.budget.bytes(if N > 1 { 2 * bytes } else { bytes }, &at)?;
            let name = images.iter().flatten().map(|i| i.name.as_str()).collect::<Vec<_>>();
            let name = name.join(" + ");
            let mut all = texels::join(images, texel);
            let sampler = self.scene.textures[placed.texture].sampler;
            let mut numbers = Vec::new();
            for i in 0..N {
                let of_all = |texels: [[u8; 4]; N]| texels[i];
                let data = if i + 1 == N {
                    std::mem::take(&mut all).into_iter().map(of_all).collect()
                } else {
                    all.iter().copied().map(of_all).collect()
                };
                let image = self.scene.images.len();
                self.scene.images.push(Image { name: name.clone(), width, height, data });
                numbers.push(self.scene.textures.len());
                self.scene.textures.push(Texture { image, sampler });
            }
            self.made.insert(key.clone(), numbers);
        }
        let made = self.made.get(&key).and_then(|numbers| numbers.as_slice().try_into().ok());
        Ok(made.map(|made: [usize; N]| made.map(|texture| TextureRef { texture, ..placed })))
    }

    /// Returns whether two textures have the same coordinates, so that they can be combined texel by texel.
    fn lie_alike(a: Option<TextureRef>, b: Option<TextureRef>) -> bool {
        let place = |t: TextureRef| (t.tex_coord, t.transform);
        a.zip(b).is_none_or(|(a, b)| place(a) == place(b))
    }

    fn glossy(&mut self, job: &Job, mut glossy: Glossy) -> Result<()> {
        let base = self.scene.materials[job.material].base_color_texture;
        let mut specular = job.texture;
        if !Self::lie_alike(base, specular) {
            let mean = self.mean(specular, true);
            glossy.specular *= mean.truncate();
            glossy.glossiness *= mean.w;
            let name = "KHR_materials_pbrSpecularGlossiness";
            self.todo.leave_out(
                name,
                "has other coordinates than the diffuse one, its mean is used",
                job.material,
            );
            specular = None;
        } else if specular.is_some() && self.image(specular).is_none() {
            // The texture could not be read (with a warning): a plastic is better than the mirror that white would
            // give.
            glossy = Glossy { specular: Vec3::ZERO, glossiness: 0.5, ..glossy };
            specular = None;
        }
        let made = if specular.is_none() && glossy.is_dielectric() {
            None
        } else {
            let Glossy { diffuse, specular: s, glossiness } = glossy;
            let factors = [diffuse.x, diffuse.y, diffuse.z, s.x, s.y, s.z, glossiness];
            self.make(job, [base, specular], &factors, |texels| glossy.texels(texels))?
        };
        let material = &mut self.scene.materials[job.material];
        if let Some([color, rough]) = made {
            material.base_color = Vec3::ONE.extend(glossy.diffuse.w);
            (material.metallic, material.roughness) = (1.0, 1.0);
            material.base_color_texture = Some(color);
            material.metallic_roughness_texture = Some(rough);
        } else {
            let metallic = glossy.metallic();
            material.base_color = metallic.base_color;
            (material.metallic, material.roughness) = (metallic.metallic, metallic.roughness);
        }
        Ok(())
    }

    /// Returns the share of light that passes where colour and mask are white, and the mask, if it can be
    /// applied.
    fn clearness(&mut self, job: &Job) -> (f32, Option<TextureRef>) {
        let material = &self.scene.materials[job.material];
        let base = material.base_color_texture;
        // A texture marks the metal parts, which are rarely everywhere.
        let metal = material.metallic_roughness_texture.map_or(material.metallic, |_| 0.0);
        let through = CLEAR * material.transmission * (1.0 - metal);
        if Self::lie_alike(base, job.texture) {
            return (through, job.texture);
        }
        let what = "has other coordinates than the base colour's, its mean is used";
        self.todo.leave_out("KHR_materials_transmission", what, job.material);
        (through * self.mean(job.texture, false).x, None)
    }

    /// Sets alpha to the share of light that the surface does not transmit: 1 without transmission, otherwise the more
    /// the darker its colour, which stains the transmitted light.
    fn glass(&mut self, job: &Job) -> Result<()> {
        let mean = self.mean(job.texture, false).x;
        let (through, mask) = self.clearness(job);
        let material = &self.scene.materials[job.material];
        let (base, color) = (material.base_color_texture, material.base_color.truncate());
        let opaque = self.scene.materials[job.material].alpha_mode == AlphaMode::Opaque;
        let kept = move |texels: [Option<[u8; 4]>; 2]| {
            let [base, mask] = texels.map(|texel| texel.unwrap_or([255; 4]));
            let stained = color * decode_rgba8(base).truncate();
            let clear = stained.element_sum() / 3.0 * decode_unorm8(mask[0]);
            let alpha = if opaque { 1.0 } else { decode_unorm8(base[3]) };
            [base[0], base[1], base[2], encode_unorm8(alpha * (1.0 - through * clear))]
        };
        let factors = [color.x, color.y, color.z, through, f32::from(u8::from(opaque))];
        let made = self.make(job, [base, mask], &factors, |texels| [kept(texels)])?;
        let material = &mut self.scene.materials[job.material];
        if opaque {
            material.base_color.w = 1.0;
        }
        match made {
            Some([texture]) => material.base_color_texture = Some(texture),
            None => material.base_color.w *= 1.0 - through * color.element_sum() / 3.0,
        }
        material.transmission *= mean;
        material.alpha_mode = AlphaMode::Blend;
        Ok(())
    }
}
