//! Blend modes: the combination of a layer's colours with those of its backdrop.
//!
//! Source: W3C, *Compositing and Blending Level 1*, sections 5.8 (general formula), 10.1 (separable) and
//! 10.2 (non-separable modes).

use super::color::Space;

/// Function B(Cb, Cs) that blends a layer's colour Cs with the backdrop's Cb; all 0 … 1, in the space in which
/// colours are mixed.
///
/// Where the layer or the backdrop is transparent, only the part that both cover is blended:
/// Cs·(1 − αb) + B(Cb, Cs)·αb is composited over the backdrop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum BlendFunction {
    /// Cs.
    #[default]
    Normal,
    /// Cb·Cs.
    Multiply,
    /// Cb + Cs − Cb·Cs.
    Screen,
    /// [`BlendFunction::HardLight`] with layer and backdrop exchanged.
    Overlay,
    /// The darker of both.
    Darken,
    /// The lighter of both.
    Lighten,
    /// Cb / (1 − Cs), at most 1.
    ColorDodge,
    /// 1 − (1 − Cb) / Cs, at least 0.
    ColorBurn,
    /// Multiply by 2·Cs where that is at most 1, else screen by 2·Cs − 1.
    HardLight,
    /// Darkens or lightens the backdrop as a soft spotlight does.
    SoftLight,
    /// |Cb − Cs|.
    Difference,
    /// Cb + Cs − 2·Cb·Cs.
    Exclusion,
    /// The layer's hue, the backdrop's saturation and luminosity.
    Hue,
    /// The layer's saturation, the backdrop's hue and luminosity.
    Saturation,
    /// The layer's hue and saturation, the backdrop's luminosity.
    Color,
    /// The layer's luminosity, the backdrop's hue and saturation.
    Luminosity,
    /// Cb + Cs, each weighted by its alpha, at most 1: the sum of both layers ("plus-lighter" of CSS).
    PlusLighter,
}

impl BlendFunction {
    /// Returns B(Cb, Cs) of straight colours 0 … 1.
    pub(crate) fn mix(self, backdrop: [f32; 3], layer: [f32; 3]) -> [f32; 3] {
        let each = |f: fn(f32, f32) -> f32| std::array::from_fn(|i| f(backdrop[i], layer[i]));
        match self {
            Self::Normal => layer,
            Self::Multiply => each(|b, s| b * s),
            Self::Screen => each(screen),
            Self::Overlay => each(|b, s| hard_light(s, b)),
            Self::Darken => each(f32::min),
            Self::Lighten => each(f32::max),
            Self::ColorDodge => each(color_dodge),
            Self::ColorBurn => each(color_burn),
            Self::HardLight => each(hard_light),
            Self::SoftLight => each(soft_light),
            Self::Difference => each(|b, s| (b - s).abs()),
            Self::Exclusion => each(|b, s| b + s - 2.0 * b * s),
            Self::Hue => {
                let hue = with_saturation(layer, saturation(backdrop));
                with_luminosity(hue, luminosity(backdrop))
            }
            Self::Saturation => {
                let saturated = with_saturation(backdrop, saturation(layer));
                with_luminosity(saturated, luminosity(backdrop))
            }
            Self::Color => with_luminosity(layer, luminosity(backdrop)),
            Self::Luminosity => with_luminosity(backdrop, luminosity(layer)),
            Self::PlusLighter => each(|b, s| (b + s).min(1.0)),
        }
    }

    /// Returns the backdrop's pixel with the layer's over it, where it is `opacity` and `mask` of 255 opaque.
    pub(super) fn over<P: Space>(self, layer: P, opacity: u8, mask: u8, backdrop: P) -> P {
        match self {
            Self::Normal => layer.scaled(opacity).over(mask, backdrop),
            Self::PlusLighter => layer.scaled(opacity).scaled(mask).plus(backdrop),
            _ => self.blended(layer, backdrop).scaled(opacity).over(mask, backdrop),
        }
    }

    /// Returns the layer's pixel in the colour that it has over the backdrop's, premultiplied like both.
    fn blended<P: Space>(self, layer: P, backdrop: P) -> P {
        let ([sr, sg, sb, alpha], [br, bg, bb, below]) = (layer.to_unit(), backdrop.to_unit());
        let (source, under) = ([sr, sg, sb], [br, bg, bb]);
        let mixed = self.mix(under, source);
        let [r, g, b] = std::array::from_fn(|i| source[i] * (1.0 - below) + mixed[i] * below);
        P::from_unit([r, g, b, alpha])
    }
}

fn screen(b: f32, s: f32) -> f32 {
    b + s - b * s
}

fn hard_light(b: f32, s: f32) -> f32 {
    if s <= 0.5 { b * (2.0 * s) } else { screen(b, 2.0 * s - 1.0) }
}

fn color_dodge(b: f32, s: f32) -> f32 {
    if b <= 0.0 {
        0.0
    } else if s >= 1.0 {
        1.0
    } else {
        (b / (1.0 - s)).min(1.0)
    }
}

fn color_burn(b: f32, s: f32) -> f32 {
    if b >= 1.0 {
        1.0
    } else if s <= 0.0 {
        0.0
    } else {
        1.0 - ((1.0 - b) / s).min(1.0)
    }
}

fn soft_light(b: f32, s: f32) -> f32 {
    if s <= 0.5 {
        return b - (1.0 - 2.0 * s) * b * (1.0 - b);
    }
    let d = if b <= 0.25 { ((16.0 * b - 12.0) * b + 4.0) * b } else { b.sqrt() };
    b + (2.0 * s - 1.0) * (d - b)
}

/// Returns the luminosity as the specification defines it, which differs from ITU-R BT.709.
fn luminosity([r, g, b]: [f32; 3]) -> f32 {
    0.3 * r + 0.59 * g + 0.11 * b
}

fn saturation([r, g, b]: [f32; 3]) -> f32 {
    r.max(g).max(b) - r.min(g).min(b)
}

/// Moves a colour to a luminosity, and towards grey where it would leave 0 … 1 ("SetLum", "ClipColor").
fn with_luminosity(color: [f32; 3], wanted: f32) -> [f32; 3] {
    let by = wanted - luminosity(color);
    let mut color = color.map(|c| c + by);
    let grey = luminosity(color);
    let [r, g, b] = color;
    let (least, most) = (r.min(g).min(b), r.max(g).max(b));
    if least < 0.0 {
        color = color.map(|c| grey + (c - grey) * grey / (grey - least));
    }
    if most > 1.0 {
        color = color.map(|c| grey + (c - grey) * (1.0 - grey) / (most - grey));
    }
    color
}

/// Spreads a colour from 0 to the given saturation ("SetSat"); greys become black.
fn with_saturation(color: [f32; 3], wanted: f32) -> [f32; 3] {
    let [r, g, b] = color;
    let (least, range) = (r.min(g).min(b), saturation(color));
    if range <= 0.0 { [0.0; 3] } else { color.map(|c| (c - least) * wanted / range) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [BlendFunction; 17] = [
        BlendFunction::Normal,
        BlendFunction::Multiply,
        BlendFunction::Screen,
        BlendFunction::Overlay,
        BlendFunction::Darken,
        BlendFunction::Lighten,
        BlendFunction::ColorDodge,
        BlendFunction::ColorBurn,
        BlendFunction::HardLight,
        BlendFunction::SoftLight,
        BlendFunction::Difference,
        BlendFunction::Exclusion,
        BlendFunction::Hue,
        BlendFunction::Saturation,
        BlendFunction::Color,
        BlendFunction::Luminosity,
        BlendFunction::PlusLighter,
    ];

    /// Results for both colours, worked out by hand from the specification.
    #[test]
    fn two_colors_blend_as_the_specification_says() {
        let (backdrop, layer) = ([0.2, 0.4, 0.8], [0.6, 0.5, 0.1]);
        let wanted = [
            (BlendFunction::Multiply, [0.12, 0.2, 0.08]),
            (BlendFunction::Screen, [0.68, 0.7, 0.82]),
            (BlendFunction::Overlay, [0.24, 0.4, 0.64]),
            (BlendFunction::Darken, [0.2, 0.4, 0.1]),
            (BlendFunction::Lighten, [0.6, 0.5, 0.8]),
            (BlendFunction::ColorDodge, [0.5, 0.8, 0.888_889]),
            (BlendFunction::ColorBurn, [0.0, 0.0, 0.0]),
            (BlendFunction::HardLight, [0.36, 0.4, 0.16]),
            (BlendFunction::SoftLight, [0.249_6, 0.4, 0.672]),
            (BlendFunction::Difference, [0.4, 0.1, 0.7]),
            (BlendFunction::Exclusion, [0.56, 0.5, 0.74]),
            (BlendFunction::Luminosity, [0.302, 0.502, 0.902]),
        ];
        for (blend, wanted) in wanted {
            let found = blend.mix(backdrop, layer);
            let off = found.iter().zip(wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(off < 1e-5, "{blend:?}: {found:?}, not {wanted:?}");
        }
    }

    #[test]
    fn results_stay_within_0_and_1() {
        let steps = [0.0, 0.1, 0.25, 0.5, 0.75, 1.0];
        for blend in ALL {
            for b in steps {
                for s in steps {
                    for mixed in blend.mix([b, 1.0 - b, 0.3], [s, 0.7, 1.0 - s]) {
                        assert!((-1e-6..=1.000_001).contains(&mixed), "{blend:?}: {mixed}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_four_of_hue_keep_what_they_promise() {
        let (backdrop, layer) = ([0.3, 0.45, 0.6], [0.55, 0.4, 0.35]);
        for blend in [BlendFunction::Hue, BlendFunction::Saturation, BlendFunction::Color] {
            let kept = luminosity(blend.mix(backdrop, layer)) - luminosity(backdrop);
            assert!(kept.abs() < 1e-6, "{blend:?}");
        }
        let mixed = BlendFunction::Luminosity.mix(backdrop, layer);
        assert!((luminosity(mixed) - luminosity(layer)).abs() < 1e-6);
        assert!(
            (saturation(BlendFunction::Hue.mix(backdrop, layer)) - saturation(backdrop)).abs()
                < 1e-6
        );
        assert!(
            (saturation(BlendFunction::Color.mix(backdrop, layer)) - saturation(layer)).abs()
                < 1e-6
        );
    }

    #[test]
    fn greys_have_no_saturation_to_give() {
        let backdrop = [0.2, 0.4, 0.9];
        let grey = BlendFunction::Saturation.mix(backdrop, [0.5; 3]);
        assert_eq!(grey, [luminosity(backdrop); 3]);
    }
}
