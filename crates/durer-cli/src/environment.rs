//! What surrounds the model, as `--environment` takes it.

use crate::failure::Failure;
use crate::input;
use crate::options::LookArgs;
use durer::pipeline::Surroundings;
use durer::shade::Panorama;
use durer::work::Work;
use durer_formats::{Limits, hdr};
use std::path::PathBuf;
use std::sync::Arc;

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

/// Reads a name or the name of a file.
pub fn environment(text: &str) -> Result<Environment, String> {
    match text {
        "studio" => Ok(Environment::Studio),
        "none" => Ok(Environment::None),
        "" => Err("it is empty; there are `studio`, `none` and names of .hdr files".to_owned()),
        file => Ok(Environment::File(PathBuf::from(file))),
    }
}

/// Reads the panorama if one is asked for, so that pictures find it.
pub fn read(look: &LookArgs, work: &Work) -> Result<(), Failure> {
    let surroundings = match &look.environment {
        Environment::Studio => Surroundings::Studio,
        Environment::None => Surroundings::None,
        Environment::File(path) => {
            let limits = Limits { work: work.clone(), ..Limits::default() };
            let failure = |e: durer_formats::Error| {
                Failure::Data(format!("--environment {}: {e}", path.display()))
            };
            let bytes = input::bytes_within(path, &limits)?;
            let picture = hdr::read(&bytes, &limits).map_err(failure)?;
            let panorama = Panorama::new(picture.width, picture.height, &picture.pixels)
                .map_err(|e| failure(e.into()))?;
            Surroundings::Panorama(Arc::new(panorama))
        }
    };
    // It is read once, whoever comes first.
    let _ = look.surroundings.set(surroundings);
    Ok(())
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
