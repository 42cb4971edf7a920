//! Steps of texture sampling: recording them changes nothing, and they rebuild the sample.

use crate::raster_coverage::Random;
use durer::math::{Vec2, Vec4};
use durer::scene::{Image, MipFilter, Sampler, TextureFilter, Wrap};
use durer::shade::texture::{PreparedTexture, Step, Usage, replay, weights};
use durer::trace::{PseudocodeLine, Recorder};

const FILTERS: [TextureFilter; 2] = [TextureFilter::Nearest, TextureFilter::Linear];
const MIPS: [MipFilter; 3] = [MipFilter::None, MipFilter::Nearest, MipFilter::Linear];
const WRAPS: [Wrap; 3] = [Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge];

/// Returns an image of any texels, half of them transparent.
fn noise(width: u32, height: u32) -> Image {
    let texel = |i: u32| {
        let [r, g, b, a] = i.wrapping_mul(2_654_435_761).to_le_bytes();
        [r, g, b, if i.is_multiple_of(2) { 255 } else { a }]
    };
    let data = (0..width * height).map(texel).collect();
    Image { width, height, data, ..Image::default() }
}

fn samplers() -> impl Iterator<Item = Sampler> {
    let all = FILTERS.into_iter().flat_map(|f| MIPS.map(|m| WRAPS.map(|w| (f, m, w)))).flatten();
    all.map(|(mag, mip, wrap_u)| Sampler { mag, min: mag, mip, wrap_u, wrap_v: Wrap::Repeat })
}

fn bits(color: Vec4) -> [u32; 4] {
    color.to_array().map(f32::to_bits)
}

#[test]
fn steps_lead_to_the_sample_and_change_nothing() {
    let mut random = Random(11);
    let image = noise(13, 6);
    for sampler in samplers() {
        for usage in [Usage::Color, Usage::ColorWithAlpha, Usage::Data] {
            let texture = PreparedTexture::new(&image, sampler, usage);
            for _ in 0..60 {
                let uv = random.point(-3.0, 3.0).as_vec2();
                let (ddx, ddy) = (random.point(-0.5, 0.5), random.point(-0.5, 0.5));
                let (ddx, ddy) = (ddx.as_vec2() * uv.x.abs(), ddy.as_vec2() * uv.y.abs());
                let mut steps = Recorder::default();
                let traced = texture.sample_traced(uv, ddx, ddy, &mut steps);
                assert_eq!(bits(traced), bits(texture.sample(uv, ddx, ddy)), "{sampler:?}");
                assert_eq!(bits(replay(steps.steps())), bits(traced), "{sampler:?} {usage:?}");
            }
        }
    }
}

#[test]
fn strange_coordinates_lead_to_a_sample_too() {
    let image = noise(4, 4);
    for sampler in samplers() {
        let texture = PreparedTexture::new(&image, sampler, Usage::Data);
        for u in [f32::NAN, f32::INFINITY, f32::MAX, -1e9, 0.0] {
            let (uv, way) = (Vec2::new(u, -u), Vec2::splat(u));
            let mut steps = Recorder::default();
            let traced = texture.sample_traced(uv, way, Vec2::ZERO, &mut steps);
            assert_eq!(bits(replay(steps.steps())), bits(traced), "{sampler:?} {u}");
            assert!(steps.steps().iter().all(|step| (1..=13).contains(&step.line())));
        }
    }
}

/// Returns the texture of the page on textures, in fifths of white.
fn fifths() -> Image {
    let rows = [[0, 1, 2, 3], [4, 5, 4, 3], [1, 0, 5, 2], [3, 2, 1, 0_u8]];
    let data = rows.iter().flatten().map(|fifth| [fifth * 51, fifth * 51, fifth * 51, 255]);
    Image { width: 4, height: 4, data: data.collect(), ..Image::default() }
}

#[test]
fn the_worked_example_of_the_page() {
    let image = fifths();
    let sample = |wrap| {
        let (mag, min, mip) = (TextureFilter::Linear, TextureFilter::Linear, MipFilter::None);
        let sampler = Sampler { mag, min, mip, wrap_u: wrap, wrap_v: wrap };
        let texture = PreparedTexture::new(&image, sampler, Usage::Data);
        let mut steps = Recorder::default();
        let uv = Vec2::new(1.3125, 0.5);
        texture.sample_traced(uv, Vec2::ZERO, Vec2::ZERO, &mut steps);
        steps.into_steps()
    };
    let [repeat, mirror, clamp] = WRAPS.map(sample);
    let expected = |steps: &[Step], u: f32, columns: [u32; 2], a: f32, sum: f32| {
        let Some(Step::Wrapped { to, size: [4, 4], .. }) = steps.get(1) else {
            panic!("{steps:?}")
        };
        assert_eq!(*to, Vec2::new(u, 0.5));
        let Some(Step::Bilinear { texels, fractions, values, value, .. }) = steps.get(2) else {
            panic!("{steps:?}")
        };
        let [left, right] = columns;
        assert_eq!(*texels, [[left, 1], [right, 1], [left, 2], [right, 2]]);
        assert_eq!(*fractions, [a, 0.5]);
        let own: f32 = weights(*fractions).iter().zip(values).map(|(w, v)| w * v.x).sum();
        assert!((own - sum).abs() < 1e-6 && (value.x - sum).abs() < 1e-6, "{own} {value}");
    };
    expected(&repeat, 0.3125, [0, 1], 0.75, 0.5);
    expected(&mirror, 0.6875, [2, 3], 0.25, 0.8);
    expected(&clamp, 1.0, [3, 3], 0.5, 0.5);
}

#[test]
fn a_pixel_of_six_texels_is_between_levels_two_and_three() {
    let image = noise(64, 64);
    let (mip, filter) = (MipFilter::Linear, TextureFilter::Linear);
    let sampler = Sampler { mag: filter, min: filter, mip, ..Sampler::default() };
    let texture = PreparedTexture::new(&image, sampler, Usage::Data);
    let mut steps = Recorder::default();
    let (right, down) = (Vec2::new(6.0, 0.0) / 64.0, Vec2::new(0.0, 3.0) / 64.0);
    texture.sample_traced(Vec2::splat(0.3), right, down, &mut steps);
    let Some(Step::Detail { lod, level, weight: Some(weight), .. }) = steps.steps().first() else {
        panic!("{:?}", steps.steps())
    };
    // log2 6 = 2.585.
    assert!((lod - 2.585).abs() < 0.006 && (weight - 0.585).abs() < 0.006, "{lod} {weight}");
    let levels = steps.steps().iter().filter_map(|step| match step {
        Step::Bilinear { level, .. } => Some(*level),
        _ => None,
    });
    assert_eq!((*level, levels.collect::<Vec<_>>()), (2, vec![2, 3]));
}
