//! The kind of an output file, from the option or from its name.

use crate::failure::Failure;
use durer_formats::drawing::DrawingFormat;
use durer_formats::picture::PictureFormat;
use durer_formats::picture::animation::AnimationFormat;
use std::path::Path;

/// Kind of file that a picture is written to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Pixels.
    Picture(PictureFormat),
    /// Pixels of all frames.
    Gif,
    /// Vectors.
    Drawing(DrawingFormat),
}

impl Kind {
    /// Default kind for pixels.
    pub const PNG: Self = Self::Picture(PictureFormat::Png);

    /// Returns the names of all kinds, as `--format` takes them.
    pub fn names() -> impl Iterator<Item = &'static str> {
        let pictures = PictureFormat::ALL.iter().map(|f| f.name());
        pictures.chain(["gif"]).chain(DrawingFormat::ALL.iter().map(|f| f.name()))
    }

    /// Returns the kind of one of these names; pixels for any other.
    pub fn of_name(name: &str) -> Self {
        let picture = PictureFormat::ALL.iter().find(|f| f.name() == name);
        picture.map(|f| Self::Picture(*f)).or_else(|| Self::of_suffix(name)).unwrap_or(Self::PNG)
    }

    fn of_suffix(suffix: &str) -> Option<Self> {
        if suffix.eq_ignore_ascii_case("gif") {
            return Some(Self::Gif);
        }
        let picture = PictureFormat::of_suffix(suffix).map(Self::Picture);
        picture.or_else(|| DrawingFormat::of_suffix(suffix).map(Self::Drawing))
    }

    /// Returns the kind by a file's name, if it determines one.
    fn of_path(path: &Path) -> Option<Self> {
        Self::of_suffix(&path.extension().unwrap_or_default().to_string_lossy())
    }

    /// Returns whether maps and SVG files can be drawn as it: a single picture, or vectors with colours.
    pub fn is_of_maps(self) -> bool {
        match self {
            Self::Picture(_) => true,
            Self::Gif => false,
            Self::Drawing(DrawingFormat::Svg | DrawingFormat::Pdf | DrawingFormat::Dxf) => true,
            Self::Drawing(_) => false,
        }
    }

    /// Returns whether it has lines and areas instead of pixels.
    pub fn is_vector(self) -> bool {
        matches!(self, Self::Drawing(_))
    }

    /// Returns the format of vectors, if it has any.
    pub fn drawing(self) -> Option<DrawingFormat> {
        match self {
            Self::Drawing(format) => Some(format),
            Self::Picture(_) | Self::Gif => None,
        }
    }

    /// Returns the format of a single picture; PNG if the kind has none.
    pub fn picture(self) -> PictureFormat {
        match self {
            Self::Picture(format) => format,
            Self::Gif | Self::Drawing(_) => PictureFormat::Png,
        }
    }

    /// Returns the format of a file with several pictures, if there is one of this kind.
    pub fn animation(self) -> Option<AnimationFormat> {
        match self {
            Self::Picture(PictureFormat::Png) => Some(AnimationFormat::Png),
            Self::Picture(PictureFormat::WebP) => Some(AnimationFormat::WebP),
            Self::Gif => Some(AnimationFormat::Gif),
            Self::Picture(PictureFormat::Jpeg) | Self::Drawing(_) => None,
        }
    }

    /// Returns the largest width and height in pixels, if there are any.
    pub fn max_side(self) -> u32 {
        match self {
            Self::Picture(format) => format.max_side(),
            Self::Gif => AnimationFormat::Gif.max_side(),
            Self::Drawing(_) => u32::MAX,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Picture(format) => format.name(),
            _ => self.suffix(),
        }
    }

    /// Returns the suffix of its files' names, without a dot.
    pub fn suffix(self) -> &'static str {
        match self {
            Self::Picture(format) => format.suffixes().first().copied().unwrap_or_default(),
            Self::Gif => "gif",
            Self::Drawing(format) => format.name(),
        }
    }
}

/// Kind of the file to write under a name, and the source of that choice.
#[derive(Debug, Clone, Copy)]
pub struct Wanted {
    /// The kind.
    pub kind: Kind,
    /// True if the kind is from an option, not from the name.
    is_given: bool,
    /// Suffixes of its files' names.
    suffixes: &'static str,
}

impl Wanted {
    /// Creates an output of a command that writes pictures and drawings.
    pub fn any(path: &Path, given: Option<Kind>) -> Self {
        let kind = given.or_else(|| Kind::of_path(path)).unwrap_or(Kind::PNG);
        Self { kind, is_given: given.is_some(), suffixes: ANY }
    }

    /// Creates an output of a command that writes pictures only.
    pub fn picture(path: &Path, given: Option<PictureFormat>) -> Self {
        let of_name = || match Kind::of_path(path) {
            Some(Kind::Picture(format)) => Some(format),
            _ => None,
        };
        let kind = given.or_else(of_name).map_or(Kind::PNG, Kind::Picture);
        Self { kind, is_given: given.is_some(), suffixes: PICTURES }
    }

    /// Creates an output of a command that writes pictures and, as vectors, SVG, PDF and DXF.
    pub fn map(path: &Path, given: Option<Kind>) -> Self {
        let of_name = || Kind::of_path(path).filter(|kind| kind.is_of_maps());
        let kind = given.or_else(of_name).unwrap_or(Kind::PNG);
        Self { kind, is_given: given.is_some(), suffixes: MAPS }
    }

    /// Creates a picture whose pixels are numbers that must not change.
    pub fn plane() -> Self {
        Self { kind: Kind::PNG, is_given: false, suffixes: PLANES }
    }

    /// Refuses a name with the suffix of another kind.
    pub fn check_name(&self, option: &str, path: &Path) -> Result<(), Failure> {
        let what = match Kind::of_path(path) {
            Some(kind) if kind == self.kind => return Ok(()),
            None if self.is_given => return Ok(()),
            Some(_) if self.is_given => format!(
                "--format says {}, but the name has another suffix; end it in .{}",
                self.kind.name(),
                self.kind.suffix()
            ),
            _ => self.suffixes.to_owned(),
        };
        Err(Failure::Usage(format!("{option} {}: {what}", path.display())))
    }
}

const PICTURES: &str =
    "pictures are written as PNG, JPEG or WebP; end the name in .png, .jpg or .webp";
const MAPS: &str = "drawings and maps are written as PNG, JPEG or WebP, or as vectors in SVG, PDF or DXF; end the \
                    name in .png, .jpg, .webp, .svg, .pdf or .dxf";
const ANY: &str = "pictures are written as PNG, JPEG or WebP; end the name in .png, .jpg or .webp \
                   (a --turntable in one file: .png, .webp, .gif; drawings: .svg, .pdf, .dxf, .hpgl, \
                   .gcode, .geojson)";
const PLANES: &str =
    "its pixels are numbers, which only PNG keeps in all programs; end the name in .png";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_options_say_what_is_wanted() {
        let jpeg = Kind::Picture(PictureFormat::Jpeg);
        let any = |path: &str, given| Wanted::any(Path::new(path), given).kind;
        assert_eq!(any("a.JPEG", None), jpeg);
        assert_eq!(any("a.svg", None), Kind::Drawing(DrawingFormat::Svg));
        assert_eq!(any("folder", None), Kind::PNG);
        assert_eq!(any("folder", Some(jpeg)), jpeg);
        assert_eq!(Wanted::picture(Path::new("a.svg"), None).kind, Kind::PNG);
        for name in Kind::names() {
            assert_eq!(Kind::of_name(name).name(), name);
        }
    }

    #[test]
    fn names_must_fit_what_is_written() {
        let check = |path: &str, given: Option<&str>| {
            let given = given.map(Kind::of_name);
            let checked = Wanted::any(Path::new(path), given).check_name("-o", Path::new(path));
            checked.map_err(|e| e.to_string())
        };
        for (path, given) in [
            ("a.png", None),
            ("a.jpg", Some("jpeg")),
            ("a.plt", Some("hpgl")),
            ("a.NC", None),
            ("a.ngc", Some("gcode")),
            ("tmp.Xa41", Some("png")),
            ("tmp", Some("webp")),
        ] {
            assert_eq!(check(path, given), Ok(()), "{path}");
        }
        for (path, given, part) in [
            ("a.bmp", None, "pictures are written as PNG"),
            ("a", None, ".png"),
            (
                "a.png",
                Some("jpeg"),
                "--format says jpeg, but the name has another suffix; end it in .jpg",
            ),
            ("a.svg", Some("png"), "end it in .png"),
        ] {
            assert!(check(path, given).unwrap_err().contains(part), "{path}");
        }
    }
}
