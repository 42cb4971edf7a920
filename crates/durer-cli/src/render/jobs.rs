//! The pictures of `durer render` and the files that they go into.

use super::check::wanted;
use crate::failure::Failure;
use crate::film::{self, Film};
use crate::kind::Wanted;
use crate::names;
use crate::output::{self, Name, Target};
use crate::render_args::RenderArgs;
use std::path::{Path, PathBuf};

/// A model and the pictures to be made of it.
pub struct Job<'a> {
    pub model: &'a Path,
    /// Its name without folder and suffix.
    pub stem: String,
    /// Plan for all frames in one file, if they go into one.
    pub film: Option<film::Plan>,
    /// Pictures in the order of the frames.
    pub pictures: Vec<Picture>,
}

/// Files of a picture and its further planes.
pub struct Picture {
    /// Frame of a turntable.
    pub frame: Option<u32>,
    /// One place for all frames of a film.
    pub color: Target,
    pub item: Option<Target>,
    pub depth: Option<Target>,
    pub normal: Option<Target>,
}

impl Job<'_> {
    /// Returns the file that all frames go into, if there is one.
    pub fn film(&self) -> Option<Film<'_>> {
        let plan = self.film?;
        match self.pictures.first().map(|p| &p.color) {
            Some(Target::File(path)) => Some(Film::new(path, plan)),
            _ => None,
        }
    }

    fn targets(&self) -> impl Iterator<Item = &Target> {
        let places = if self.film.is_some() { 1 } else { self.pictures.len() };
        let colors = self.pictures.iter().take(places).map(|p| &p.color);
        let planes = self.pictures.iter().flat_map(|p| [&p.item, &p.depth, &p.normal]);
        colors.chain(planes.flatten())
    }
}

/// Determines the place of each picture before anything is read, so that a wrong name is found at once.
pub fn plan(args: &RenderArgs) -> Result<Vec<Job<'_>>, Failure> {
    let frames: Vec<Option<u32>> = match args.picture.turntable {
        Some(count) => (0..count).map(Some).collect(),
        None => vec![None],
    };
    let names: Vec<Name> = args
        .models
        .iter()
        .flat_map(|model| frames.iter().map(|&frame| Name { input: model.clone(), frame }))
        .collect();
    let optional = |option: &str, path: &Option<PathBuf>| match path {
        Some(path) => {
            let targets = output::plan(option, path, &names, &Wanted::plane())?;
            Ok(targets.into_iter().map(Some).collect())
        }
        None => Ok(vec![None; names.len()]),
    };
    let film = film::wanted(args, wanted(args).kind)?;
    let color = match film {
        Some(_) => film::targets(&args.output, &args.models, frames.len(), &wanted(args))?,
        None => output::plan("--output", &args.output, &names, &wanted(args))?,
    };
    let item = optional("--item", &args.planes.item)?;
    let depth = optional("--depth", &args.planes.depth)?;
    let normal = optional("--normal", &args.planes.normal)?;
    let planes = color.into_iter().zip(item).zip(depth).zip(normal);
    let mut pictures = planes.zip(&names).map(|((((color, item), depth), normal), name)| {
        let frame = name.frame;
        Picture { frame, color, item, depth, normal }
    });
    let jobs: Vec<Job> = args
        .models
        .iter()
        .map(|model| Job {
            model,
            stem: names::stem(model),
            film,
            pictures: pictures.by_ref().take(frames.len()).collect(),
        })
        .collect();
    let targets = || jobs.iter().flat_map(Job::targets);
    output::check_distinct(targets()).map_err(|failure| with_advice(args, failure))?;
    if args.json && targets().any(|t| *t == Target::Stdout) {
        let message = "--json: the report goes to standard output, where the picture goes too";
        return Err(Failure::Usage(message.to_owned()));
    }
    Ok(jobs)
}

/// Adds advice on distinguishing pictures of models with the same name.
fn with_advice(args: &RenderArgs, failure: Failure) -> Failure {
    match failure {
        Failure::Usage(message) if args.models.len() > 1 => {
            let suffix = wanted(args).kind.suffix();
            Failure::Usage(format!(
                "{message}; -o 'DIR/{{folder}}/{{name}}.{suffix}' keeps the folders and suffixes of the models"
            ))
        }
        other => other,
    }
}
