//! Numbers and vectors as values of options; every message says what is expected.

use crate::kind::Kind;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use durer::math::{DVec2, DVec3, Rect};
use durer::pipeline::SurfaceMethod;
use durer::simd::{self, Level};
use durer::view::window::PixelRect;
use durer::visibility::wireframe;
use durer_formats::picture::PictureFormat;

/// Width and height of a picture, in pixels, each at least 1 if it is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Size {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

/// Parses `WxH`, e.g. `1920x1080`; a single number makes a square.
pub fn size(text: &str) -> Result<Size, String> {
    let (width, height) = text.split_once(['x', 'X', '×']).unwrap_or((text, text));
    let side = |side: &str| match side.trim().parse::<u32>() {
        Ok(n) if n > 0 => Ok(n),
        _ => Err("a size is WIDTHxHEIGHT in whole pixels from 1, e.g. 1920x1080".to_owned()),
    };
    Ok(Size { width: side(width)?, height: side(height)? })
}

/// Parses `X,Y,WIDTH,HEIGHT`, pixels of a picture.
pub fn tile(text: &str) -> Result<PixelRect, String> {
    let wrong = || {
        "a tile is X,Y,WIDTH,HEIGHT in whole pixels of the picture, X and Y from 0 of the upper left corner, e.g. \
         1024,0,512,512"
            .to_owned()
    };
    let numbers = text.split(',').map(|n| n.trim().parse::<u32>());
    let numbers: Vec<u32> = numbers.collect::<Result<_, _>>().map_err(|_| wrong())?;
    let [x, y, width, height] = numbers[..] else { return Err(wrong()) };
    let end = |start: u32, side: u32| start.checked_add(side).and_then(|v| v.try_into().ok());
    let (Some(x1), Some(y1)) = (end(x, width), end(y, height)) else { return Err(wrong()) };
    let tile = PixelRect::spanning(x.cast_signed(), y.cast_signed(), x1, y1);
    if tile.is_empty() { Err(wrong()) } else { Ok(tile) }
}

/// Value of `--algorithm`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Algorithm {
    /// One that finds visible surfaces.
    Surfaces(SurfaceMethod),
    /// All edges, hidden or not.
    Wireframe,
    /// A contact sheet of all methods for visible surfaces.
    All,
}

/// Returns the name of an algorithm; the help lists all names.
pub fn algorithm() -> impl TypedValueParser<Value = Algorithm> {
    let methods =
        SurfaceMethod::ALL.iter().map(|m| PossibleValue::new(m.name()).help(m.info().title));
    let wireframe = PossibleValue::new(wireframe::INFO.name).help("All edges, hidden ones too");
    let all = PossibleValue::new("all").help(
        "A contact sheet of all but wireframe, and the pixels that differ from the z-buffer's",
    );
    PossibleValuesParser::new(methods.chain([wireframe, all])).try_map(|name| match &*name {
        "all" => Ok(Algorithm::All),
        name if name == wireframe::INFO.name => Ok(Algorithm::Wireframe),
        name => name.parse().map(Algorithm::Surfaces),
    })
}

/// Returns the name of an output format.
pub fn kind() -> impl TypedValueParser<Value = Kind> {
    PossibleValuesParser::new(Kind::names().map(named)).map(|name| Kind::of_name(&name))
}

/// Returns the name of an output format of maps.
pub fn map_kind() -> impl TypedValueParser<Value = Kind> {
    let names = Kind::names().filter(|name| Kind::of_name(name).is_of_maps());
    PossibleValuesParser::new(names.map(named)).map(|name| Kind::of_name(&name))
}

/// Returns the name of a format of pictures.
pub fn picture_format() -> impl TypedValueParser<Value = PictureFormat> {
    PossibleValuesParser::new(PictureFormat::ALL.iter().map(|f| named(f.name())))
        .map(|name| PictureFormat::of_suffix(&name).unwrap_or_default())
}

/// Returns a format's name, with a suffix as an alias for some.
fn named(name: &'static str) -> PossibleValue {
    let value = PossibleValue::new(name);
    if name == PictureFormat::Jpeg.name() { value.alias("jpg") } else { value }
}

/// Returns a size on the screen in pixels: above 0, and no larger than a picture.
pub fn pixels(text: &str) -> Result<f64, String> {
    let size = positive(text)?;
    if size <= 16_384.0 { Ok(size) } else { Err("at most 16384 pixels".to_owned()) }
}

/// Returns a finite number.
pub fn number(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(n) if n.is_finite() => Ok(n),
        Ok(_) => Err("the number must be finite".to_owned()),
        Err(_) => Err("a number is needed, e.g. 1.5 or -3e2".to_owned()),
    }
}

/// Returns a finite number above zero.
pub fn positive(text: &str) -> Result<f64, String> {
    number(text).and_then(|n| if n > 0.0 { Ok(n) } else { Err("it must be above 0".to_owned()) })
}

/// Returns a finite number, zero or above.
pub fn not_negative(text: &str) -> Result<f64, String> {
    number(text)
        .and_then(|n| if n >= 0.0 { Ok(n) } else { Err("it must not be below 0".to_owned()) })
}

/// Returns an angle of view in degrees, between 0 and 180.
pub fn angle_of_view(text: &str) -> Result<f64, String> {
    let inside = |n: &f64| (0.001..180.0).contains(n);
    number(text)
        .and_then(|n| Some(n).filter(inside).ok_or("it must be between 0 and 180 degrees".into()))
}

/// Returns an elevation in degrees, straight down to straight up.
pub fn elevation(text: &str) -> Result<f64, String> {
    let inside = |n: &f64| (-90.0..=90.0).contains(n);
    number(text)
        .and_then(|n| Some(n).filter(inside).ok_or("it must be between -90 and 90 degrees".into()))
}

/// Parses `N` finite numbers with commas between them.
fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let numbers: Vec<f64> = text.split(',').map(number).collect::<Result<_, _>>().ok()?;
    numbers.try_into().ok()
}

/// Returns a point of the picture.
pub fn point(text: &str) -> Result<DVec2, String> {
    let wrong = || "a point is X,Y in pixels, e.g. 512.5,300.5".to_owned();
    numbers(text).map(DVec2::from_array).ok_or_else(wrong)
}

/// Returns a rectangle of the picture, by two opposite corners.
pub fn rect(text: &str) -> Result<Rect, String> {
    let rect = numbers(text)
        .and_then(|[x0, y0, x1, y1]| Rect::around([DVec2::new(x0, y0), DVec2::new(x1, y1)]));
    let has_area = |r: &Rect| r.size().x > 0.0 && r.size().y > 0.0;
    let wrong = || "a rectangle is X0,Y0,X1,Y1 in pixels, with width and height".to_owned();
    rect.filter(has_area).ok_or_else(wrong)
}

/// Returns a count of at least 1.
pub fn count(text: &str) -> Result<u64, String> {
    match text.replace('_', "").parse() {
        Ok(n) if n > 0 => Ok(n),
        _ => Err("a whole number from 1 is needed".to_owned()),
    }
}

/// Returns a SIMD level of this machine by its name, or `auto` for its best.
pub fn simd_level(text: &str) -> Result<Level, String> {
    let missing = || match (text, cfg!(feature = "scalar")) {
        ("scalar", false) => {
            "this build has no scalar code; the feature `scalar` builds it".to_owned()
        }
        _ => {
            let names: Vec<_> = simd::levels().into_iter().map(simd::name).collect();
            format!("this machine has auto, {}", names.join(", "))
        }
    };
    simd::by_name(text).ok_or_else(missing)
}

/// Returns a number of bytes, with `k`, `M` or `G` for powers of 1024.
pub fn bytes(text: &str) -> Result<u64, String> {
    let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let factor = match text[digits.len()..].trim_end_matches("iB").trim_end_matches('B') {
        "" => 1,
        "k" | "K" => 1 << 10,
        "M" => 1 << 20,
        "G" => 1 << 30,
        _ => return Err("a size in bytes may end in k, M or G".to_owned()),
    };
    count(digits)?.checked_mul(factor).ok_or_else(|| "the number is too large".to_owned())
}

/// Parses `FROM,TO`, both finite, the first the smaller.
pub fn range(text: &str) -> Result<[f64; 2], String> {
    let wrong = || "a range is FROM,TO, the first the smaller, e.g. -4,4".to_owned();
    numbers(text).filter(|[from, to]| from < to).ok_or_else(wrong)
}

/// Parses `x,y,z`, all finite.
pub fn vector(text: &str) -> Result<DVec3, String> {
    let parts: Vec<f64> = text.split(',').map(number).collect::<Result<_, _>>()?;
    match parts[..] {
        [x, y, z] => Ok(DVec3::new(x, y, z)),
        _ => Err("three numbers joined by commas are needed, e.g. 0,-2.5,1".to_owned()),
    }
}

/// Parses `x,y,z`, finite and not all zero; returns a vector of unit length.
pub fn direction(text: &str) -> Result<DVec3, String> {
    vector(text)?
        .try_normalize()
        .ok_or_else(|| "a direction needs a component other than 0".to_owned())
}

/// The longest name of a section or a detail.
const MOST_LETTERS: usize = 3;

/// Returns the name of a section or a detail: a letter, or a few with figures.
pub fn letter(text: &str) -> Result<String, String> {
    let right = text.chars().count() <= MOST_LETTERS
        && text.starts_with(char::is_alphabetic)
        && text.chars().all(char::is_alphanumeric);
    let wrong = || format!("`{text}` is not a letter; write one before the colon, e.g. A or B1");
    if right { Ok(text.to_owned()) } else { Err(wrong()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        assert_eq!(size("1920x1080"), Ok(Size { width: 1920, height: 1080 }));
        assert_eq!(size("64"), Ok(Size { width: 64, height: 64 }));
        for wrong in ["", "x", "0x5", "5x0", "NaNxNaN", "1e3x2", "-1x2", "4294967296x1", "1x2x3"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn tiles_have_places_and_sizes() {
        assert_eq!(tile("64,0,32,16"), Ok(PixelRect::spanning(64, 0, 96, 16)));
        let most = "0,0,2147483647,1";
        assert_eq!(tile(most), Ok(PixelRect::spanning(0, 0, i32::MAX, 1)));
        for wrong in
            ["", "1,2,3", "1,2,3,4,5", "-1,0,1,1", "0,0,0,1", "0,0,1,0", "1,0,2147483647,1"]
        {
            assert!(tile(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn simd_levels_have_names() {
        let weakest = simd::name(simd::levels()[0]);
        assert!(simd_level("auto").is_ok() && simd_level(weakest).is_ok());
        assert_eq!(simd_level("scalar").is_ok(), cfg!(feature = "scalar"));
        let refusal = simd_level("mmx").expect_err("no level");
        assert!(refusal.starts_with(&format!("this machine has auto, {weakest}")), "{refusal}");
    }

    #[test]
    fn vectors_may_be_negative_but_must_be_finite() {
        assert_eq!(vector("-3.39,1.2,-1.3"), Ok(DVec3::new(-3.39, 1.2, -1.3)));
        for wrong in ["", "1,2", "1,2,3,4", "nan,0,0", "inf,0,0", "a,b,c", "1;2;3"] {
            assert!(vector(wrong).is_err(), "{wrong}");
        }
        assert!(direction("0,0,0").is_err());
        assert_eq!(direction("0,0,-5"), Ok(DVec3::NEG_Z));
    }

    #[test]
    fn bytes_have_suffixes() {
        assert_eq!(bytes("10"), Ok(10));
        assert_eq!(bytes("2k"), Ok(2048));
        assert_eq!(bytes("3MiB"), Ok(3 << 20));
        assert_eq!(bytes("4GB"), Ok(4 << 30));
        for wrong in ["", "k", "0", "-1", "5q", "99999999999G"] {
            assert!(bytes(wrong).is_err(), "{wrong}");
        }
    }
}
