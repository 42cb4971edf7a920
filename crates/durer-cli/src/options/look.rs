//! The options of light and surfaces.

use super::{Cull, Shading, Shadows, ToneMap};
use crate::{color, lights, values};
use clap::{Args, ValueHint};
use durer::pipeline::{self, Exposure};
use durer::scene::Light;
use std::path::PathBuf;

/// `--environment`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Environment {
    /// The studio.
    Studio,
    /// Sky and ground alone.
    None,
    /// A panorama in a file.
    File(PathBuf),
}

/// Parses a name or the name of a file.
fn environment(text: &str) -> Result<Environment, String> {
    match text {
        "studio" => Ok(Environment::Studio),
        "none" => Ok(Environment::None),
        "" => Err("it is empty; use `studio`, `none` or the name of a .hdr file".to_owned()),
        file => Ok(Environment::File(PathBuf::from(file))),
    }
}

/// Light and surfaces.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Look")]
pub struct LookArgs {
    /// Shading of surfaces [default: by the material]
    #[arg(long, value_name = "MODEL")]
    pub shading: Option<Shading>,
    /// A light; replaces the default three-point light or the file's own
    #[arg(long, value_name = "LIGHT", allow_hyphen_values = true, long_help = lights::SYNTAX, value_parser = lights::light)]
    pub light: Vec<Light>,
    /// Faces to leave out
    #[arg(long, value_name = "WHICH", default_value = "material")]
    pub cull: Cull,
    /// Turn faces to the outside before anything is left out or lit
    ///
    /// Closed bodies that are inside out are turned as a whole, and faces that run against their neighbours one by one;
    /// cavities stay. `durer info` reports both. Surfaces that cannot be oriented stay as they are.
    #[arg(long)]
    pub orient: bool,
    /// Width of a model's lines in pixels
    #[arg(long, value_name = "PIXELS", allow_hyphen_values = true, default_value = "1.5", value_parser = values::pixels)]
    pub line_width: f64,
    /// Side of a model's points in pixels
    #[arg(long, value_name = "PIXELS", allow_hyphen_values = true, default_value = "3", value_parser = values::pixels)]
    pub point_size: f64,
    /// The colour of objects without a material [default: light grey; lines and points contrast
    /// with the background]
    #[arg(long, value_name = "COLOR", value_parser = color::color)]
    pub color: Option<durer::math::Vec4>,
    /// Method that computes shadows
    #[arg(long, value_name = "HOW", default_value = "none")]
    pub shadows: Shadows,
    /// Texels along the side of a shadow map
    #[arg(long, value_name = "N", allow_hyphen_values = true, default_value = "2048", value_parser = clap::value_parser!(u32).range(1..=16384), requires = "shadows")]
    pub shadow_map: u32,
    /// Number of times that rays are reflected by mirrors and refracted by transparent surfaces
    #[arg(long, value_name = "N", allow_hyphen_values = true, default_value = "0", value_parser = clap::value_parser!(u32).range(0..=32))]
    pub bounces: u32,
    /// Exposure of the light: `auto`, or a number of EV
    ///
    /// `auto` scales all lights by one factor so that well-lit white matte surfaces become nearly white. A
    /// number multiplies the light of the file or of --light, and of emissive surfaces, by two to this
    /// power; at 0, a light of strength 1, or of pi lux, makes white. Default: auto for the file's own
    /// lights and for --environment FILE, else 0.
    #[arg(long, value_name = "EV", allow_hyphen_values = true, value_parser = lights::exposure)]
    pub exposure: Option<Exposure>,
    /// Surroundings that mirrors show: `studio`, `none`, or a panorama in a Radiance file (.hdr)
    ///
    /// The studio has bright screens, which metals and smooth surfaces reflect; `none` leaves only a sky over
    /// the ground. A panorama (equirectangular) also lights the model: instead of the default light, and in
    /// addition to lights of the file or of --light.
    #[arg(long, value_name = "WHAT", default_value = "studio", value_hint = ValueHint::FilePath, value_parser = environment)]
    pub environment: Environment,
    /// Tone map that brings bright light into the range of the picture
    #[arg(long, value_name = "MAP", default_value = "none")]
    pub tone_map: ToneMap,
    /// The surroundings that were read for --environment.
    #[arg(skip)]
    pub surroundings: std::sync::OnceLock<pipeline::Surroundings>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_known_and_all_else_is_a_file() {
        assert_eq!(environment("studio"), Ok(Environment::Studio));
        assert_eq!(environment("none"), Ok(Environment::None));
        assert_eq!(environment("a/b.hdr"), Ok(Environment::File("a/b.hdr".into())));
        assert!(environment("").is_err());
    }
}
