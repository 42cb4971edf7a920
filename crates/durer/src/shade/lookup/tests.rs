//! Look-ups one by one and sixteen at a time give the same.

use super::*;
use crate::scene::{Image, Sampler};
use crate::simd::dispatch;
use crate::simd::levels;
use crate::testing::Numbers;

#[simd]
fn sixteen<S: Simd>(simd: S, texture: &PreparedTexture<'_>, at: &[[f32; 16]; 6]) -> [[f32; 16]; 4] {
    let lane = |i: usize| f32x16::from_slice(simd, &at[i]);
    let (uv, ddx) = ([lane(0), lane(1)], [lane(2), lane(3)]);
    let colors =
        PreparedTexture::sample_x16(simd, texture, &TexCoords { uv, ddx, ddy: [lane(4), lane(5)] });
    let [r, g, b, a] = colors;
    [r.into(), g.into(), b.into(), a.into()]
}

#[test]
fn sixteen_look_ups_are_sixteen_times_one() {
    let strange =
        [f32::NAN, f32::INFINITY, f32::MIN, -0.0, 1e-40, -1e-9, 1.0, 8_388_609.0, 3e9, -2.5];
    let mut numbers = Numbers(7);
    let mut random = || numbers.unit();
    for (width, height) in [(8, 4), (5, 7), (1, 3), (64, 64)] {
        let data = (0..width * height).map(|_| [0; 4].map(|_: u8| (random() * 255.0) as u8));
        let data = data.collect();
        let image = Image { name: String::new(), width, height, data };
        for wrap in [Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge] {
            for mip in [MipFilter::None, MipFilter::Nearest, MipFilter::Linear] {
                let (mag, min) = (TextureFilter::Linear, TextureFilter::Linear);
                let sampler = Sampler { mag, min, mip, wrap_u: wrap, wrap_v: wrap };
                for usage in [Usage::Color, Usage::ColorWithAlpha, Usage::Data] {
                    let texture = PreparedTexture::new(&image, sampler, usage);
                    for round in 0..40 {
                        let mut at = [[0.0; 16]; 6];
                        for (k, lanes) in at.iter_mut().enumerate() {
                            let scale = if k < 2 { 5.0 } else { 0.3 };
                            *lanes = lanes.map(|_| (random() - 0.4) * scale);
                            lanes[k] = strange[(round + k) % strange.len()];
                        }
                        agrees(&texture, &at);
                        // Near each other, about as far apart as their derivatives.
                        for (k, lanes) in at.iter_mut().enumerate() {
                            let (middle, scale) = (random(), random() * random() * 0.1);
                            let middle = if k < 2 { middle } else { 0.0 };
                            *lanes = lanes.map(|_| middle + (random() - 0.5) * scale);
                        }
                        agrees(&texture, &at);
                    }
                }
            }
        }
    }
}

fn agrees(texture: &PreparedTexture<'_>, at: &[[f32; 16]; 6]) {
    for level in levels() {
        let colors = dispatch!(level, simd => sixteen(simd, texture, at));
        for i in 0..16 {
            let two = |k: usize| Vec2::new(at[k][i], at[k + 1][i]);
            let one = texture.sample(two(0), two(2), two(4)).to_array();
            let ours = [0, 1, 2, 3].map(|c| colors[c][i].to_bits());
            assert_eq!(ours, one.map(f32::to_bits), "{:?}", two(0));
        }
    }
}
