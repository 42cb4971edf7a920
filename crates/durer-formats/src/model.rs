//! The types that all readers of models share.

use crate::text::Tally;
use crate::wording::agreeing;
use crate::{Place, Warning};
use durer::math::Vec3;
use durer::scene::Scene;
use durer::work::Work;

/// Source of the files that a file refers to: buffers, images, material libraries.
///
/// The implementation in the command reads only below the model's own folder and never from a network address; data
/// URIs are not passed to it.
pub trait Resources {
    /// Returns the bytes of a file, at most `limit`; `path` is relative, percent-decoded, and has `/` as separator.
    ///
    /// # Errors
    /// A sentence with the reason, which the reader puts into [`crate::Error::Resource`].
    fn read(&self, path: &str, limit: u64) -> std::result::Result<Vec<u8>, String>;

    /// Returns the bytes of a file by its path as written in the model, percent-decoded and with `/` as separator. The
    /// path may be absolute, lead out of the folder by `..`, or be a network address. Readers call this method.
    ///
    /// The provided implementation refuses such paths, so that [`Self::read`] never receives one. Another
    /// implementation decides itself which paths it allows, and may find a file under another spelling.
    ///
    /// # Errors
    /// As [`Self::read`].
    fn find(&self, path: &str, limit: u64) -> std::result::Result<Found, String> {
        check_inside(path)?;
        self.read(path, limit).map(|bytes| Found { bytes, note: None })
    }
}

/// Result of [`Resources::find`].
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Found {
    /// The file's bytes.
    pub bytes: Vec<u8>,
    /// A sentence for a warning, if the file's name differs from the requested one in upper and lower case.
    pub note: Option<String>,
}

/// Refuses paths that are not relative to the model's folder, or lead out of it.
///
/// # Errors
/// A sentence with the reason.
fn check_inside(path: &str) -> std::result::Result<(), &'static str> {
    // A scheme is letters, digits, +, - or . before a colon (RFC 3986); a colon in the first segment of a
    // relative path is not allowed, and on some systems it names a drive or a stream.
    if path.split('/').next().unwrap_or_default().contains(':') {
        return Err("only relative paths are followed, no schemes and no network addresses");
    }
    if path.contains(':') {
        return Err("a colon has no place in a relative path");
    }
    if path.starts_with('/') {
        return Err("absolute paths are not followed");
    }
    if path.split('/').any(|part| part == "..") {
        return Err("paths that leave the model's folder are not followed");
    }
    Ok(())
}

/// Source without any files, for models that must be self-contained.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoResources;

impl Resources for NoResources {
    fn read(&self, _path: &str, _limit: u64) -> std::result::Result<Vec<u8>, String> {
        Err("this source has no folder to look in".to_owned())
    }
}

/// Limits of readers; exceeding one is [`crate::Error::Limit`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Limits {
    /// Number of triangles, lines and points over all meshes, before instancing.
    pub primitives: u64,
    /// Number of instances of meshes, and of nodes of a glTF file.
    pub instances: u64,
    /// Bytes of all decoded buffers and images together, including decompressed ones.
    pub decoded_bytes: u64,
    /// Width and height of one image, in pixels.
    pub image_side: u32,
    /// Depth of a tree of components.
    pub depth: u32,
    /// Memory budget and cancellation of the reading. The memory of the model stays charged as long as this part of the
    /// work exists.
    pub work: Work,
}

impl Default for Limits {
    /// Returns the default: 100 million primitives, a million instances, 4 GiB decoded, images of 16,384², depth 512.
    fn default() -> Self {
        Self {
            primitives: 100_000_000,
            instances: 1_000_000,
            decoded_bytes: 4 << 30,
            image_side: 16_384,
            depth: 512,
            work: Work::default(),
        }
    }
}

impl Limits {
    /// Returns the number of bytes that reading may use, by [`Self::decoded_bytes`] and by the rest of the budget; for
    /// libraries that count by themselves.
    pub fn memory(&self) -> u64 {
        self.decoded_bytes.min(self.work.budget().saturating_sub(self.work.used()))
    }
}

/// Time of an animation at which a model is posed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Pose {
    /// Name or number of the animation; `None` = the first, if there is one.
    pub animation: Option<String>,
    /// Seconds from its start; clamped to its end.
    pub time: f64,
}

/// Options for reading a model.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReadOptions {
    /// Limits of sizes.
    pub limits: Limits,
    /// Time of an animation to pose the model at; `None` = the rest pose of the file.
    pub pose: Option<Pose>,
    /// Name or number of the variant whose materials are shown (KHR_materials_variants); `None` = the default materials
    /// of the file.
    pub variant: Option<String>,
    /// Name or number, from 0, of the scene that is read, of a file with several (glTF); `None` = the default scene of
    /// the file.
    pub scene: Option<String>,
    /// Number, from 1, of the plate whose objects are read, in a project that has plates; `None` = all.
    pub plate: Option<u32>,
    /// True if lights of COLLADA and FBX shine. Most are leftovers of the exporter, in units that hardly any program
    /// respects, so that models look worse with them than without. Lights of glTF always shine.
    pub own_lights: bool,
}

/// A model as read.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Model {
    /// Scene to draw, which passes [`Scene::check`].
    pub scene: Scene,
    /// The format, e.g. `"glTF 2.0 binary"` or `"STL, ascii"`.
    pub format: String,
    /// Extensions that the file uses, by name.
    pub extensions: Vec<String>,
    /// Names of the animations.
    pub animations: Vec<String>,
    /// Names of the variants of the model's materials.
    pub variants: Vec<String>,
    /// Names of the scenes of a file that may have several (glTF).
    pub scenes: Vec<String>,
    /// Names of the plates of a slicer's project, empty if they have none.
    pub plates: Vec<String>,
    /// Repairs and omissions.
    pub warnings: Vec<Warning>,
}

impl Model {
    /// Adds a warning.
    pub fn warn(&mut self, place: Place, message: impl Into<String>) {
        self.warnings.push(Warning { place, message: message.into() });
    }

    /// Adds a warning about several things, if there are any, in words for [`agreeing`].
    pub(crate) fn warn_counted(&mut self, place: Place, count: u64, words: &str) {
        if count > 0 {
            self.warn(place, agreeing(count, words));
        }
    }

    /// Adds a warning about what was counted, at its first place, in words for [`agreeing`].
    pub(crate) fn warn_of(&mut self, tally: &Tally, words: &str) {
        self.warn_counted(tally.first.clone(), tally.count, words);
    }

    /// Adds a warning about vertices that are not finite.
    pub(crate) fn warn_infinite(&mut self, count: usize) {
        let words = "{vertex has|vertices have} a coordinate that is NaN or infinite";
        self.warn_counted(Place::Whole, count as u64, words);
    }
}

/// Returns the number of points with a coordinate that is NaN or infinite.
pub(crate) fn count_infinite(points: &[Vec3]) -> usize {
    // There is hardly ever one, and testing many together is faster than testing each.
    let count = |some: &[Vec3]| some.iter().filter(|p| !p.is_finite()).count();
    points.chunks(256).filter(|some| any_infinite(some)).map(count).sum()
}

fn any_infinite(points: &[Vec3]) -> bool {
    // Only an exponent of all ones carries into the sign bit. Four points are three registers.
    let carry = |v: f32| (v.to_bits() & 0x7fff_ffff) + 0x0080_0000;
    let (fours, rest) = points.as_chunks::<4>();
    let mut any = [0; 12];
    for four in fours {
        let numbers = four.map(|p| p.to_array());
        for (any, &v) in any.iter_mut().zip(numbers.as_flattened()) {
            *any |= carry(v);
        }
    }
    let rest = rest.iter().flat_map(|p| p.to_array());
    any.into_iter().chain(rest.map(carry)).fold(0, |any, bits| any | bits) >> 31 != 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_finite_is_counted_wherever_it_is() {
        for length in [0, 1, 3, 4, 5, 12, 255, 256, 257, 600] {
            let mut points = vec![Vec3::new(f32::MAX, f32::MIN, -0.0); length];
            assert_eq!(count_infinite(&points), 0);
            for (i, bad) in (0..length).step_by(7).zip([f32::NAN, f32::INFINITY].iter().cycle()) {
                points[i][i % 3] = if i % 2 == 0 { *bad } else { -*bad };
                assert_eq!(count_infinite(&points), i / 7 + 1, "{length}");
            }
        }
    }
}
