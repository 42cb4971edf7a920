//! The value of `--environment`: the light around the model.

use crate::failure::Failure;
use crate::input;
use crate::options::{Environment, LookArgs};
use durer::pipeline::Surroundings;
use durer::shade::Panorama;
use durer::work::Work;
use durer_formats::{Limits, hdr};
use std::sync::Arc;

/// Reads the panorama if one is requested, so that pictures find it.
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
    // It is read once, by the first caller.
    let _ = look.surroundings.set(surroundings);
    Ok(())
}
