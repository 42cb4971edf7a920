//! Samples of a material with textures: looked up one by one, lit eight at a time.

use super::Shading;
use super::formula::{self, Inputs};
use super::lane::Vec3Lane;
use super::light::PreparedLights;
use super::metallic_roughness::Substance;
use super::normal::Frame;
use super::phong::Shininess;
use fearless_simd::{f32x8, prelude::*};
use fearless_simd_macros::simd;

/// A point of a surface with everything that its material's textures say of it, ready to be lit.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    pub(super) frame: Frame<f32>,
    pub(super) position: Vec3Lane<f32>,
    pub(super) inputs: Inputs<f32>,
}

/// Numbers of a sample.
const NUMBERS: usize = 27;

/// Up to eight samples of one material; those not set hold what was there before.
#[derive(Debug, Clone, Copy, Default)]
pub struct Samples {
    numbers: [[f32; 8]; NUMBERS],
    /// The same for all of them.
    shininess: Shininess,
}

impl Samples {
    /// Sets the sample `lane`, 0 … 7, whose material must
    /// [be lit together](super::PreparedMaterial::is_lit_together).
    #[inline(always)]
    pub fn set(&mut self, lane: usize, sample: &Sample) {
        let Sample { frame, position: p, inputs } = sample;
        let (v, f, n) = (&frame.view, &frame.face, &frame.normal);
        let s = &inputs.substance;
        let (b, d, r, e) = (&s.base, &inputs.diffuse, &inputs.specular, &inputs.emission);
        let numbers: [f32; NUMBERS] = [
            v.x,
            v.y,
            v.z,
            f.x,
            f.y,
            f.z,
            n.x,
            n.y,
            n.z,
            p.x,
            p.y,
            p.z,
            b.x,
            b.y,
            b.z,
            s.metallic,
            s.roughness,
            s.occlusion,
            d.x,
            d.y,
            d.z,
            r.x,
            r.y,
            r.z,
            e.x,
            e.y,
            e.z,
        ];
        for (to, number) in self.numbers.iter_mut().zip(numbers) {
            to[lane % 8] = number;
        }
        self.shininess = inputs.shininess;
    }

    /// Linear red, green and blue, each bit for bit what [`super::shade`] gives. Cost: O(lights).
    #[simd]
    pub fn shade<S: Simd>(
        simd: S,
        this: &Self,
        lights: &PreparedLights,
        shading: Shading,
    ) -> [[f32; 8]; 3] {
        let frame = Frame {
            view: this.vector(simd, 0),
            face: this.vector(simd, 3),
            normal: this.vector(simd, 6),
        };
        let position = this.vector(simd, 9);
        let substance = Substance {
            base: this.vector(simd, 12),
            metallic: f32x8::from_slice(simd, &this.numbers[15]),
            roughness: f32x8::from_slice(simd, &this.numbers[16]),
            occlusion: f32x8::from_slice(simd, &this.numbers[17]),
        };
        let inputs = Inputs {
            substance,
            diffuse: this.vector(simd, 18),
            specular: this.vector(simd, 21),
            shininess: this.shininess,
            emission: this.vector(simd, 24),
        };
        let color = formula::display(&frame, position, &inputs, None, lights, shading);
        [color.x.into(), color.y.into(), color.z.into()]
    }

    /// Three numbers of all samples.
    #[inline(always)]
    fn vector<S: Simd>(&self, simd: S, first: usize) -> Vec3Lane<f32x8<S>> {
        let x = f32x8::from_slice(simd, &self.numbers[first]);
        let y = f32x8::from_slice(simd, &self.numbers[first + 1]);
        Vec3Lane::new(x, y, f32x8::from_slice(simd, &self.numbers[first + 2]))
    }
}
