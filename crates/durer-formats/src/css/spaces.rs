//! Spaces that colours are given and mixed in.
//!
//! Source: *CSS Color Module Level 4*, W3C, § 10 and the sample code of § 17; B. Ottosson, *A perceptual color space
//! for image processing*, 2020 (Oklab).

use libm::{atan2, cbrt, hypot, pow, sincos};

/// A colour in sRGB with its transfer function, 0 to 1 within the gamut, and straight alpha.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Color {
    pub rgb: [f64; 3],
    pub alpha: f64,
}

impl Color {
    pub fn of_bytes(bytes: [u8; 4]) -> Self {
        let [r, g, b, a] = bytes.map(|v| f64::from(v) / 255.0);
        Self { rgb: [r, g, b], alpha: a }
    }

    /// Returns the nearest bytes.
    pub fn bytes(self) -> [u8; 4] {
        let [r, g, b] = self.rgb;
        [r, g, b, self.alpha].map(|v| (v.clamp(0.0, 1.0) * 255.0).round() as u8)
    }
}

/// Colour space of three components.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Space {
    /// 0 to 255, as `rgb()` has it.
    Bytes,
    /// 0 to 1.
    Srgb,
    SrgbLinear,
    DisplayP3,
    XyzD65,
    XyzD50,
    Hsl,
    Hwb,
    Lab,
    Lch,
    Oklab,
    Oklch,
}

type Row = [f64; 3];

const XYZ_FROM_SRGB: [Row; 3] = [
    [0.41239079926595934, 0.357584339383878, 0.1804807884018343],
    [0.21263900587151027, 0.715168678767756, 0.07219231536073371],
    [0.01933081871559182, 0.11919477979462598, 0.9505321522496607],
];
const SRGB_FROM_XYZ: [Row; 3] = [
    [3.2409699419045226, -1.537383177570094, -0.4986107602930034],
    [-0.9692436362808796, 1.8759675015077202, 0.04155505740717559],
    [0.05563007969699366, -0.20397695888897652, 1.0569715142428786],
];
const D65_FROM_D50: [Row; 3] = [
    [0.9554734527042182, -0.023098536874261423, 0.0632593086610217],
    [-0.028369706963208136, 1.0099954580058226, 0.021041398966943008],
    [0.012314001688319899, -0.020507696433477912, 1.3303659366080753],
];
const D50_FROM_D65: [Row; 3] = [
    [1.0479298208405488, 0.022946793341019088, -0.05019222954313557],
    [0.029627815688159344, 0.990434484573249, -0.01707382502938514],
    [-0.009243058152591178, 0.015055144896577895, 0.7518742899580008],
];
const XYZ_FROM_P3: [Row; 3] = [
    [0.4865709486482162, 0.26566769316909306, 0.1982172852343625],
    [0.2289745640697488, 0.6917385218365064, 0.079286914093745],
    [0.0, 0.04511338185890264, 1.043944368900976],
];
const P3_FROM_XYZ: [Row; 3] = [
    [2.493496911941425, -0.9313836179191239, -0.40271078445071684],
    [-0.8294889695615747, 1.7626640603183463, 0.023624685841943577],
    [0.03584583024378447, -0.07617238926804182, 0.9568845240076872],
];
const LMS_FROM_OKLAB: [Row; 3] = [
    [1.0, 0.3963377773761749, 0.2158037573099136],
    [1.0, -0.1055613458156586, -0.0638541728258133],
    [1.0, -0.0894841775298119, -1.2914855480194092],
];
const SRGB_FROM_LMS: [Row; 3] = [
    [4.0767416621, -3.3077115913, 0.2309699292],
    [-1.2684380046, 2.6097574011, -0.3413193965],
    [-0.0041960863, -0.7034186147, 1.7076147010],
];
const LMS_FROM_SRGB: [Row; 3] = [
    [0.4122214708, 0.5363325363, 0.0514459929],
    [0.2119034982, 0.6806995451, 0.1073969566],
    [0.0883024619, 0.2817188376, 0.6299787005],
];
const OKLAB_FROM_LMS: [Row; 3] = [
    [0.2104542553, 0.7936177850, -0.0040720468],
    [1.9779984951, -2.4285922050, 0.4505937099],
    [0.0259040371, 0.7827717662, -0.8086757660],
];
/// The white of D50.
const WHITE: Row = [0.9642956764295677, 1.0, 0.8251046025104602];
const KAPPA: f64 = 24389.0 / 27.0;
const EPSILON: f64 = 216.0 / 24389.0;

/// Chroma below which a colour counts as grey: its hue is meaningless.
const NO_CHROMA: f64 = 1e-3;

fn times(matrix: &[Row; 3], v: Row) -> Row {
    matrix.map(|[a, b, c]| a * v[0] + b * v[1] + c * v[2])
}

/// Returns linear light from a value of sRGB; negative ones mirrored.
fn linear(v: f64) -> f64 {
    let a = v.abs();
    if a <= 0.04045 { v / 12.92 } else { pow((a + 0.055) / 1.055, 2.4).copysign(v) }
}

fn encoded(v: f64) -> f64 {
    let a = v.abs();
    if a <= 0.0031308 { v * 12.92 } else { (1.055 * pow(a, 1.0 / 2.4) - 0.055).copysign(v) }
}

/// Converts lightness, chroma and hue in degrees to lightness and two axes.
fn from_polar([l, c, h]: Row) -> Row {
    let (sin, cos) = sincos(h.to_radians());
    [l, c * cos, c * sin]
}

/// Converts lightness and two axes to lightness, chroma and hue in degrees; without chroma the hue is not a number.
fn to_polar([l, a, b]: Row, none: f64) -> Row {
    let chroma = hypot(a, b);
    let hue = if chroma < none { f64::NAN } else { atan2(b, a).to_degrees() };
    [l, chroma, hue]
}

fn lab_to_xyz([l, a, b]: Row) -> Row {
    let y = (l + 16.0) / 116.0;
    let cube = |f: f64| if f * f * f > EPSILON { f * f * f } else { (116.0 * f - 16.0) / KAPPA };
    let middle = if l > KAPPA * EPSILON { y * y * y } else { l / KAPPA };
    [cube(a / 500.0 + y) * WHITE[0], middle * WHITE[1], cube(y - b / 200.0) * WHITE[2]]
}

fn xyz_to_lab(xyz: Row) -> Row {
    let f = |v: f64| if v > EPSILON { cbrt(v) } else { (KAPPA * v + 16.0) / 116.0 };
    let [x, y, z] = [f(xyz[0] / WHITE[0]), f(xyz[1] / WHITE[1]), f(xyz[2] / WHITE[2])];
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Converts hue in degrees, saturation and lightness in percent to sRGB.
fn hsl_to_rgb([h, s, l]: Row) -> Row {
    let (s, l) = (s / 100.0, l / 100.0);
    [0.0, 8.0, 4.0].map(|n| {
        let k = (n + h / 30.0).rem_euclid(12.0);
        l - s * l.min(1.0 - l) * (k - 3.0).min(9.0 - k).clamp(-1.0, 1.0)
    })
}

/// Converts sRGB to hue in degrees, saturation and lightness in percent.
fn rgb_to_hsl(rgb: Row) -> Row {
    let [hue, low, high] = hue_and_range(rgb);
    let (l, d) = ((low + high) / 2.0, high - low);
    let s = if d == 0.0 || l <= 0.0 || l >= 1.0 { 0.0 } else { (high - l) / l.min(1.0 - l) };
    [hue, s * 100.0, l * 100.0]
}

/// Returns the hue in degrees, the least and the greatest component.
fn hue_and_range([r, g, b]: Row) -> Row {
    let (high, low) = (r.max(g).max(b), r.min(g).min(b));
    let d = high - low;
    let sixth = if d < 1e-9 {
        f64::NAN
    } else if high == r {
        (g - b) / d
    } else if high == g {
        (b - r) / d + 2.0
    } else {
        (r - g) / d + 4.0
    };
    [(sixth * 60.0).rem_euclid(360.0), low, high]
}

fn hwb_to_rgb([h, w, b]: Row) -> Row {
    let (w, b) = (w / 100.0, b / 100.0);
    if w + b >= 1.0 {
        return [w / (w + b); 3];
    }
    hsl_to_rgb([h, 100.0, 50.0]).map(|v| v * (1.0 - w - b) + w)
}

impl Space {
    /// Returns the space of a function of that name.
    pub fn of_function(name: &str) -> Option<Self> {
        Some(match name {
            "rgb" | "rgba" => Self::Bytes,
            "hsl" | "hsla" => Self::Hsl,
            "hwb" => Self::Hwb,
            "lab" => Self::Lab,
            "lch" => Self::Lch,
            "oklab" => Self::Oklab,
            "oklch" => Self::Oklch,
            _ => return None,
        })
    }

    /// Returns the space that `color()` and `color-mix()` know by that name.
    pub fn of_color(name: &str) -> Option<Self> {
        Some(match name {
            "srgb" => Self::Srgb,
            "srgb-linear" => Self::SrgbLinear,
            "display-p3" => Self::DisplayP3,
            "xyz" | "xyz-d65" => Self::XyzD65,
            "xyz-d50" => Self::XyzD50,
            _ => return None,
        })
    }

    /// Returns whether the component of that index is a hue.
    pub fn is_hue(self, index: usize) -> bool {
        self.hue() == Some(index)
    }

    fn hue(self) -> Option<usize> {
        match self {
            Self::Hsl | Self::Hwb => Some(0),
            Self::Lch | Self::Oklch => Some(2),
            _ => None,
        }
    }

    /// Returns the value of 100 % for the component with this index.
    pub fn whole(self, index: usize) -> f64 {
        match (self, index) {
            (Self::Bytes, _) => 255.0,
            (Self::Hsl | Self::Hwb, _) | (Self::Lab | Self::Lch, 0) => 100.0,
            (Self::Lab, _) => 125.0,
            (Self::Lch, _) => 150.0,
            (Self::Oklab | Self::Oklch, 1 | 2) => 0.4,
            _ => 1.0,
        }
    }

    /// Returns the colour of components; values beyond their range are kept, except lightness and chroma.
    pub fn color(self, mut components: Row, alpha: f64) -> Color {
        let [first, second, _] = &mut components;
        match self {
            Self::Lab | Self::Lch => *first = first.clamp(0.0, 100.0),
            Self::Oklab | Self::Oklch => *first = first.clamp(0.0, 1.0),
            // As in browsers.
            Self::Hsl => *second = second.min(100.0),
            _ => {}
        }
        if matches!(self, Self::Lch | Self::Oklch | Self::Hsl) {
            *second = second.max(0.0);
        }
        Color { rgb: self.to_srgb(components), alpha }
    }

    fn to_srgb(self, v: Row) -> Row {
        let of_xyz = |xyz| times(&SRGB_FROM_XYZ, xyz).map(encoded);
        match self {
            Self::Bytes => v.map(|v| (v / 255.0).clamp(0.0, 1.0)),
            Self::Srgb => v,
            Self::SrgbLinear => v.map(encoded),
            Self::DisplayP3 => of_xyz(times(&XYZ_FROM_P3, v.map(linear))),
            Self::XyzD65 => of_xyz(v),
            Self::XyzD50 => of_xyz(times(&D65_FROM_D50, v)),
            Self::Hsl => hsl_to_rgb(v),
            Self::Hwb => hwb_to_rgb(v),
            Self::Lab => of_xyz(times(&D65_FROM_D50, lab_to_xyz(v))),
            Self::Lch => Self::Lab.to_srgb(from_polar(v)),
            Self::Oklab => {
                let lms = times(&LMS_FROM_OKLAB, v).map(|v| v * v * v);
                times(&SRGB_FROM_LMS, lms).map(encoded)
            }
            Self::Oklch => Self::Oklab.to_srgb(from_polar(v)),
        }
    }

    fn of_srgb(self, rgb: Row) -> Row {
        let xyz = || times(&XYZ_FROM_SRGB, rgb.map(linear));
        match self {
            Self::Bytes => rgb.map(|v| v * 255.0),
            Self::Srgb => rgb,
            Self::SrgbLinear => rgb.map(linear),
            Self::DisplayP3 => times(&P3_FROM_XYZ, xyz()).map(encoded),
            Self::XyzD65 => xyz(),
            Self::XyzD50 => times(&D50_FROM_D65, xyz()),
            Self::Hsl => rgb_to_hsl(rgb),
            Self::Hwb => {
                let [hue, low, high] = hue_and_range(rgb);
                [hue, low * 100.0, (1.0 - high) * 100.0]
            }
            Self::Lab => xyz_to_lab(times(&D50_FROM_D65, xyz())),
            Self::Lch => to_polar(Self::Lab.of_srgb(rgb), 100.0 * NO_CHROMA),
            Self::Oklab => {
                let lms = times(&LMS_FROM_SRGB, rgb.map(linear)).map(cbrt);
                times(&OKLAB_FROM_LMS, lms)
            }
            Self::Oklch => to_polar(Self::Oklab.of_srgb(rgb), NO_CHROMA),
        }
    }

    /// Returns the mixture of two colours with so much of the second one, components weighted by
    /// alpha.
    pub fn mix(self, a: Color, b: Color, share: f64) -> Color {
        let (mut x, mut y) = (self.of_srgb(a.rgb), self.of_srgb(b.rgb));
        let alpha = a.alpha * (1.0 - share) + b.alpha * share;
        let hue = self.hue();
        if let Some(hue) = hue {
            // A powerless hue is replaced by the other colour's.
            if x[hue].is_nan() {
                x[hue] = if y[hue].is_nan() { 0.0 } else { y[hue] };
            }
            if y[hue].is_nan() {
                y[hue] = x[hue];
            }
            let turn = (y[hue] - x[hue] + 180.0).rem_euclid(360.0) - 180.0;
            y[hue] = x[hue] + turn;
        }
        let mut mixed = [0.0; 3];
        for (i, mixed) in mixed.iter_mut().enumerate() {
            let (wa, wb) = if Some(i) == hue || alpha <= 0.0 {
                (1.0 - share, share)
            } else {
                (a.alpha * (1.0 - share) / alpha, b.alpha * share / alpha)
            };
            *mixed = x[i] * wa + y[i] * wb;
        }
        Color { rgb: self.to_srgb(mixed), alpha }
    }
}
