//! Tone maps: how light of any brightness becomes colours that a display can show.
//!
//! All work on linear colours with sRGB's primaries and give such colours within 0…1.

use super::lane::{Lane, Vec3Lane};
use crate::math::Vec3;

/// Mapping from light of any brightness to colours that a display can show.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ToneMap {
    /// Colours within 0…1 stay exactly as they are; brighter ones keep their hue and grow whiter.
    #[default]
    None,
    /// Colours stay nearly as they are up to 0.8, brighter ones are compressed and grow whiter: Khronos
    /// Group, *Khronos PBR Neutral Tone Mapper*, 2024. Made for pictures of goods.
    KhronosNeutral,
    /// The look of film: S. Hill's fit (*BakingLab*, 2016) of the Academy Color Encoding System's
    /// reference and output transforms, with the exposure of 1/0.6 that goes with it.
    Aces,
    /// Soft, with bright colours that grow pale instead of glaring: T. Sobotka, *AgX*, 2022, in the fit of
    /// B. Wrensch, *Minimal AgX Implementation*, 2023.
    Agx,
}

impl ToneMap {
    /// All tone maps.
    pub const ALL: &'static [Self] = &[Self::None, Self::KhronosNeutral, Self::Aces, Self::Agx];

    /// Returns the name used on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::KhronosNeutral => "khronos-neutral",
            Self::Aces => "aces",
            Self::Agx => "agx",
        }
    }
}

/// Rows of a matrix.
type Rows = [Vec3; 3];

#[inline(always)]
fn transformed<L: Lane>([x, y, z]: Rows, c: Vec3Lane<L>) -> Vec3Lane<L> {
    Vec3Lane::new(c.dot_all(x), c.dot_all(y), c.dot_all(z))
}

#[inline(always)]
fn each<L: Lane>(c: Vec3Lane<L>, f: impl Fn(L) -> L) -> Vec3Lane<L> {
    Vec3Lane::new(f(c.x), f(c.y), f(c.z))
}

/// Returns the smaller of two.
#[inline(always)]
fn smaller<L: Lane>(a: L, b: L) -> L {
    (a - b).if_above(0.0, b, a)
}

/// Maps a colour by Khronos PBR Neutral.
#[inline(always)]
pub(super) fn khronos_neutral<L: Lane>(c: Vec3Lane<L>) -> Vec3Lane<L> {
    /// Brightness at which compression begins, less the reflection of 4 % that is taken off.
    const START: f32 = 0.8 - 0.04;
    const DESATURATION: f32 = 0.15;
    let least = smaller(c.x, smaller(c.y, c.z));
    let toe = least - least * least * 6.25;
    let offset = (least - 0.08).if_above(0.0, least.splat(0.04), toe);
    let c = each(c, |channel| channel - offset);
    let peak = c.x.larger(c.y).larger(c.z);
    let rest = 1.0 - START;
    let lower = (peak.splat(rest * rest) / (peak + (rest - START)).at_least(rest)).one_minus();
    let compressed = c.scale(lower / peak.at_least(START));
    let white = (peak.splat(1.0) / ((peak - lower) * DESATURATION + 1.0)).one_minus();
    let mixed = each(compressed, |channel| channel + (lower - channel) * white);
    Vec3Lane::if_above(peak, START, mixed, c)
}

/// Maps a colour by ACES, in Hill's fit.
#[inline(always)]
pub(super) fn aces<L: Lane>(c: Vec3Lane<L>) -> Vec3Lane<L> {
    const EXPOSURE: f32 = 1.0 / 0.6;
    const IN: Rows = [
        Vec3::new(0.59719, 0.35458, 0.04823),
        Vec3::new(0.07600, 0.90834, 0.01566),
        Vec3::new(0.02840, 0.13383, 0.83777),
    ];
    const OUT: Rows = [
        Vec3::new(1.60475, -0.53108, -0.07367),
        Vec3::new(-0.10208, 1.10813, -0.00605),
        Vec3::new(-0.00327, -0.07276, 1.07602),
    ];
    let c = transformed(IN, each(c, |channel| channel * EXPOSURE));
    let c = each(c, |v| {
        ((v + 0.024_578_6) * v - 0.000_090_537) / ((v * 0.983_729 + 0.432_951) * v + 0.238_081)
    });
    transformed(OUT, c)
}

/// Maps a colour by AgX, in Wrensch's fit, without a look.
#[inline(always)]
pub(super) fn agx<L: Lane>(c: Vec3Lane<L>) -> Vec3Lane<L> {
    const IN: Rows = [
        Vec3::new(0.842_479, 0.078_433_6, 0.079_223_745),
        Vec3::new(0.042_328_242, 0.878_468_6, 0.079_166_13),
        Vec3::new(0.042_375_655, 0.078_433_6, 0.879_143),
    ];
    const OUT: Rows = [
        Vec3::new(1.196_879, -0.098_020_88, -0.099_029_74),
        Vec3::new(-0.052_896_757, 1.151_903_1, -0.098_961_18),
        Vec3::new(-0.052_971_635, -0.098_043_45, 1.151_073_7),
    ];
    /// Exposures around middle grey that are shown, as powers of two.
    const FROM: f32 = -12.473_93;
    const TO: f32 = 4.026_069;
    let c = each(transformed(IN, c), |v| {
        let x = (v.at_least(1e-10).log2() - FROM) * (1.0 / (TO - FROM));
        sigmoid(x.at_least(0.0).at_most(1.0))
    });
    each(transformed(OUT, c), |v| v.at_least(1e-10).power_real(2.2))
}

/// Returns AgX's contrast curve at x.
#[inline(always)]
fn sigmoid<L: Lane>(x: L) -> L {
    let high = ((x * 15.5 - 40.14) * x + 31.96) * x - 6.868;
    ((high * x + 0.4298) * x + 0.1191) * x - 0.00232
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shade::tone::Tone;

    fn mapped(map: ToneMap, c: [f32; 3]) -> Vec3 {
        Tone { map, gain: 1.0 }.of(Vec3Lane::from(Vec3::from_array(c))).into()
    }

    fn is_near(map: ToneMap, c: [f32; 3], expected: [f32; 3]) {
        let found = mapped(map, c);
        assert!((found - Vec3::from_array(expected)).abs().max_element() < 1e-4, "{map:?} {found}");
    }

    #[test]
    fn values_are_those_of_the_published_formulas() {
        // Computed with the published code in double precision.
        is_near(ToneMap::KhronosNeutral, [0.18, 0.18, 0.18], [0.140000, 0.140000, 0.140000]);
        is_near(ToneMap::KhronosNeutral, [0.05, 0.5, 0.02], [0.032500, 0.482500, 0.002500]);
        is_near(ToneMap::KhronosNeutral, [4.0, 1.0, 0.25], [0.983256, 0.468299, 0.339560]);
        is_near(ToneMap::Aces, [0.18, 0.18, 0.18], [0.213105, 0.213105, 0.213103]);
        is_near(ToneMap::Aces, [0.05, 0.5, 0.02], [0.122565, 0.557491, 0.040058]);
        is_near(ToneMap::Aces, [4.0, 1.0, 0.25], [1.014135, 0.796086, 0.504095]);
        is_near(ToneMap::Agx, [0.18, 0.18, 0.18], [0.214467, 0.214533, 0.214537]);
        is_near(ToneMap::Agx, [0.05, 0.5, 0.02], [0.091859, 0.467239, 0.055647]);
        is_near(ToneMap::Agx, [4.0, 1.0, 0.25], [0.917927, 0.615797, 0.374931]);
    }

    #[test]
    fn greys_grow_and_end_below_white() {
        for &map in ToneMap::ALL {
            let mut last = -1.0;
            for i in 0..=60 {
                let grey = mapped(map, [0.001 * 1.25f32.powi(i); 3]);
                assert!((grey.x - grey.z).abs() < 2e-3, "{map:?} {grey}");
                assert!(grey.x >= last, "{map:?} {grey}");
                last = grey.x;
            }
            assert!(map == ToneMap::None || last > 0.9 && last < 1.1, "{map:?}: {last}");
        }
    }

    #[test]
    fn gain_comes_before_the_map() {
        for &map in ToneMap::ALL {
            let light = Vec3::new(0.1, 0.2, 0.3);
            let gained: Vec3 = Tone { map, gain: 4.0 }.of(Vec3Lane::from(light)).into();
            assert_eq!(gained, mapped(map, (light * 4.0).to_array()));
        }
    }
}
