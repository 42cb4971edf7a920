//! The last steps of every formula: exposure, a tone map if requested, and clamping to the display's range, 0…1.

use super::lane::{Lane, Vec3Lane};
use super::tone_map::{self, ToneMap};

/// Changes to light before it is shown. Surfaces without light, which are shown as they are, are not
/// changed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Tone {
    /// Factor of all light, 1 = as it is.
    pub gain: f32,
    /// Mapping from the range of brightness to that of a display.
    pub map: ToneMap,
}

impl Default for Tone {
    /// Returns the default: light as it is.
    fn default() -> Self {
        Self { gain: 1.0, map: ToneMap::None }
    }
}

impl Tone {
    /// Returns the changed light; by default exactly the light itself.
    #[inline(always)]
    pub(super) fn of<L: Lane>(self, light: Vec3Lane<L>) -> Vec3Lane<L> {
        if self == Self::default() {
            light
        } else {
            light.x.apart(
                #[inline(always)]
                || self.changed(light),
            )
        }
    }

    #[inline(always)]
    fn changed<L: Lane>(self, light: Vec3Lane<L>) -> Vec3Lane<L> {
        let gain = light.x.splat(self.gain);
        let light = light.scale(gain);
        let held = Vec3Lane::new(held(light.x), held(light.y), held(light.z));
        match self.map {
            ToneMap::None => light,
            ToneMap::KhronosNeutral => tone_map::khronos_neutral(held),
            ToneMap::Aces => tone_map::aces(held),
            ToneMap::Agx => tone_map::agx(held),
        }
    }
}

/// Share of white that an infinitely bright colour gets.
const BLEACH: f32 = 0.5;
/// Brighter counts as this bright, so that infinity stays calculable.
const BRIGHTEST: f32 = 1e6;

/// Fits colours into 0…1. Those within are kept exactly; NaN and negative channels become 0. A brighter colour is
/// scaled until its largest channel is 1, so that it keeps its hue where cutting each channel would turn orange into
/// yellow, and drawn towards white by how much too bright it was.
#[inline(always)]
pub(super) fn display<L: Lane>(color: Vec3Lane<L>) -> Vec3Lane<L> {
    let c = Vec3Lane::new(held(color.x), held(color.y), held(color.z));
    let brightest = c.x.larger(c.y).larger(c.z);
    if brightest.all_at_most(1.0) {
        return c;
    }
    let scale = c.x.splat(1.0) / brightest.at_least(1.0);
    let white = scale.one_minus() * BLEACH;
    Vec3Lane::new(
        bleached(c.x * scale, white),
        bleached(c.y * scale, white),
        bleached(c.z * scale, white),
    )
}

#[inline(always)]
fn held<L: Lane>(channel: L) -> L {
    channel.at_least(0.0).at_most(BRIGHTEST)
}

/// Moves a channel towards 1; exactly the channel itself where `white` is 0.
#[inline(always)]
fn bleached<L: Lane>(channel: L, white: L) -> L {
    (channel + channel.one_minus() * white).at_most(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;

    fn shown(c: Vec3) -> Vec3 {
        display(Vec3Lane::from(c)).into()
    }

    #[test]
    fn what_a_display_can_show_is_kept_bit_for_bit() {
        for i in 0..=100 {
            let c = Vec3::new(i as f32 / 100.0, 0.123, 1.0 - i as f32 / 100.0);
            assert_eq!(shown(c), c);
        }
    }

    #[test]
    fn too_bright_colours_keep_their_order_and_grow_whiter() {
        let mut last = shown(Vec3::new(1.0, 0.5, 0.1));
        for i in 1..50 {
            let now = shown(Vec3::new(1.0, 0.5, 0.1) * (1.0 + i as f32 * 0.2));
            let ordered = now.y > last.y && now.z > last.z && now.y > now.z;
            assert!(now.x > 0.999_999 && ordered, "{now}");
            last = now;
        }
        assert!(last.z < 0.6);
    }

    #[test]
    fn every_input_gives_a_colour() {
        let strange = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, 1e38, 0.5];
        for (r, g) in strange.iter().flat_map(|r| strange.map(|g| (*r, g))) {
            let c = shown(Vec3::new(r, g, f32::NAN));
            assert!(c.min_element() >= 0.0 && c.max_element() <= 1.0, "{r} {g}: {c}");
        }
    }
}
