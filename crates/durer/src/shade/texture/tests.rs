//! Filters, wrap modes and levels, compared with the texels.

use super::*;
use crate::shade::color::{decode_rgba8, decode_srgb8};

const WRAPS: [Wrap; 3] = [Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge];

fn ramp(width: u32, height: u32) -> Image {
    let texel = |i: u32| [(i * 37 % 256) as u8, (i * 101 % 256) as u8, (i % 256) as u8, 255];
    let data = (0..width * height).map(texel).collect();
    Image { name: String::new(), width, height, data }
}

fn sampler(filter: TextureFilter, mip: MipFilter, wrap: Wrap) -> Sampler {
    Sampler { mag: filter, min: filter, mip, wrap_u: wrap, wrap_v: wrap }
}

fn at(texture: &PreparedTexture<'_>, u: f32, v: f32) -> Vec4 {
    texture.sample(Vec2::new(u, v), Vec2::ZERO, Vec2::ZERO)
}

#[test]
fn texel_centres_are_exact() {
    for (width, height) in [(8, 4), (5, 7), (1, 3), (300, 2), (2047, 1)] {
        let image = ramp(width, height);
        for (filter, wrap) in
            WRAPS.map(|w| [(TextureFilter::Linear, w), (TextureFilter::Nearest, w)]).concat()
        {
            let texture =
                PreparedTexture::new(&image, sampler(filter, MipFilter::None, wrap), Usage::Color);
            for (i, &code) in image.data.iter().enumerate() {
                let (x, y) = (i as u32 % width, i as u32 / width);
                let u = (x as f32 + 0.5) / width as f32;
                let v = (y as f32 + 0.5) / height as f32;
                assert_eq!(at(&texture, u, v), decode_rgba8(code), "{width}x{height} {x} {y}");
            }
        }
    }
}

#[test]
fn floor_is_the_standard_librarys() {
    for x in [0.0, 0.5, -0.5, -1.0, 1.0, -1e-9, 8_388_607.5, -8_388_607.5, 3e9, -3e9, 1e38] {
        assert_eq!(floor(x), x.floor());
    }
}

#[test]
fn wrap_modes_follow_their_laws() {
    let image = ramp(8, 8);
    for filter in [TextureFilter::Linear, TextureFilter::Nearest] {
        let of = |wrap| {
            PreparedTexture::new(&image, sampler(filter, MipFilter::None, wrap), Usage::Data)
        };
        let [repeat, mirror, clamp] = WRAPS.map(of);
        // Off the texels' borders, where the last bit would decide the side of a sample.
        for i in 0..100 {
            let (u, v) = ((i as f32 + 0.3) / 100.0, (i * 37 % 100) as f32 / 100.0 + 0.003);
            let here = at(&repeat, u, v);
            assert!((at(&repeat, u + 3.0, v - 2.0) - here).abs().max_element() < 2e-3);
            assert!((at(&mirror, -u, v) - at(&mirror, u, v)).abs().max_element() < 2e-3);
            assert!((at(&mirror, u + 2.0, v) - at(&mirror, u, v)).abs().max_element() < 2e-3);
            assert_eq!(at(&clamp, u + 1.0, v), at(&clamp, 1.0, v));
            assert_eq!(at(&clamp, -u, v), at(&clamp, 0.0, v));
        }
    }
}

#[test]
fn repeat_has_no_seam() {
    let image = ramp(4, 1);
    let texture = PreparedTexture::new(
        &image,
        sampler(TextureFilter::Linear, MipFilter::None, Wrap::Repeat),
        Usage::Color,
    );
    let mean = (decode_rgba8(image.data[0]) + decode_rgba8(image.data[3])) * 0.5;
    for u in [0.0, 1.0, -1.0, 7.0, -1e-9, 1.0 - 1e-7] {
        assert!((at(&texture, u, 0.5) - mean).abs().max_element() < 1e-3, "{u}");
    }
}

#[test]
fn minified_checker_is_mean_grey() {
    let texel = |i: u32| if (i / 64 + i).is_multiple_of(2) { [255; 4] } else { [0, 0, 0, 255] };
    let data = (0..64 * 64).map(texel).collect();
    let image = Image { name: String::new(), width: 64, height: 64, data };
    for mip in [MipFilter::Linear, MipFilter::Nearest] {
        let s = sampler(TextureFilter::Linear, mip, Wrap::Repeat);
        let texture = PreparedTexture::new(&image, s, Usage::Color);
        for step in [0.06, 0.3, 1.0, 50.0, f32::INFINITY] {
            for i in 0..20 {
                let uv = Vec2::new(i as f32 * 0.137, i as f32 * 0.71);
                let grey = texture.sample(uv, Vec2::new(step, 0.0), Vec2::ZERO);
                assert!((grey.x - 0.5).abs() < 0.005, "{step}: {grey}");
            }
        }
    }
}

#[test]
fn the_level_follows_the_footprint() {
    for i in 0..40_000 {
        let x = 1.0 + i as f32 * 0.37;
        let exact = 0.5 * f64::from(x).log2();
        assert!((f64::from(half_log2(x)) - exact).abs() < 0.006, "{x}");
    }
    let image = ramp(256, 64);
    let s = sampler(TextureFilter::Nearest, MipFilter::Nearest, Wrap::Repeat);
    let texture = PreparedTexture::new(&image, s, Usage::Data);
    for level in 0..8 {
        let chosen = match texture.detail((1 << (2 * level)) as f32) {
            Detail::Magnified => 0,
            Detail::Level(l) | Detail::Between(l, _) => l,
        };
        assert_eq!(chosen, level);
    }
}

#[test]
fn strange_coordinates_have_a_colour() {
    let image = ramp(3, 5);
    let strange =
        [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, 1e20, -1e9, 1e-40];
    for wrap in WRAPS {
        for filter in [TextureFilter::Linear, TextureFilter::Nearest] {
            for mip in [MipFilter::None, MipFilter::Nearest, MipFilter::Linear] {
                let texture =
                    PreparedTexture::new(&image, sampler(filter, mip, wrap), Usage::Color);
                for (a, b) in strange.iter().flat_map(|a| strange.map(|b| (*a, b))) {
                    let d = Vec2::new(b, a);
                    let c = texture.sample(Vec2::new(a, b), d, Vec2::new(a, 0.1));
                    assert!(c.min_element() >= 0.0 && c.max_element() <= 1.0, "{a} {b} {c}");
                }
                assert_eq!(at(&texture, f32::NAN, f32::NAN), at(&texture, 0.0, 0.0));
            }
        }
    }
    let empty = Image::default();
    let texture = PreparedTexture::new(&empty, Sampler::default(), Usage::Color);
    assert_eq!(at(&texture, 0.3, 0.7), Vec4::ONE);
}

#[test]
fn borders_of_cut_outs_keep_their_colour() {
    let data = vec![[0, 200, 0, 255], [255, 0, 255, 0]];
    let image = Image { name: String::new(), width: 2, height: 1, data };
    let s = sampler(TextureFilter::Linear, MipFilter::Linear, Wrap::ClampToEdge);
    let texture = PreparedTexture::new(&image, s, Usage::ColorWithAlpha);
    let middle = at(&texture, 0.5, 0.5);
    assert!((middle - Vec4::new(0.0, decode_srgb8(200), 0.0, 0.5)).abs().max_element() < 1e-6);
    let far = texture.sample(Vec2::splat(0.5), Vec2::X, Vec2::ZERO);
    assert!((far.w - 0.5).abs() < 0.003 && far.x == 0.0, "{far}");
}
