//! The output of a model's frames: a file for each, or one file written as they come.

use crate::beside::Beside;
use crate::encoding::EncodingArgs;
use crate::failure::{Failure, in_words};
use crate::kind::{Kind, Wanted};
use crate::output::{self, Name, Target};
use crate::render_args::RenderArgs;
use durer::pipeline::Background;
use durer::target::Pixels;
use durer_formats::picture::PictureFormat;
use durer_formats::picture::animation::{Animation, AnimationFormat, Options};
use std::fs::{File, OpenOptions};
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

/// Frames per second by default.
const FRAMES_PER_SECOND: f64 = 24.0;

/// Timing and format of frames in one file.
#[derive(Debug, Clone, Copy)]
pub struct Plan {
    format: AnimationFormat,
    /// Everything but the size, which the first frame gives.
    options: Options,
}

/// An animation that grows, beside its place.
pub struct Film<'a> {
    path: &'a Path,
    plan: Plan,
    growing: Option<(Animation<BufWriter<File>>, Option<Beside>)>,
}

impl<'a> Film<'a> {
    /// Creates an animation with nothing in it; no file is touched yet.
    pub fn new(path: &'a Path, plan: Plan) -> Self {
        Self { path, plan, growing: None }
    }

    fn push(&mut self, pixels: &Pixels<[u8; 4]>) -> Result<(), Failure> {
        if self.growing.is_none() {
            let options = Options { size: (pixels.width(), pixels.height()), ..self.plan.options };
            let (file, beside) =
                open(self.path).map_err(|e| Failure::of_file(self.path, in_words(&e)))?;
            let animation = Animation::new(BufWriter::new(file), self.plan.format, &options);
            self.growing = Some((animation.map_err(|e| Failure::of_file(self.path, e))?, beside));
        }
        let Some((animation, _)) = &mut self.growing else { return Ok(()) };
        animation.push(pixels).map_err(|e| Failure::of_file(self.path, e))
    }

    /// Ends the file and renames it to its final name.
    pub fn finish(self) -> Result<(), Failure> {
        let Some((animation, beside)) = self.growing else { return Ok(()) };
        animation.finish().map_err(|e| Failure::of_file(self.path, e))?;
        let committed = beside.map_or(Ok(()), Beside::commit);
        committed.map_err(|e| Failure::of_file(self.path, in_words(&e)))
    }
}

/// Returns a file beside the final place, or the special file there itself.
fn open(path: &Path) -> io::Result<(File, Option<Beside>)> {
    if output::is_special(path) {
        return Ok((OpenOptions::new().write(true).open(path)?, None));
    }
    let beside = Beside::create(path)?;
    Ok((beside.file()?, Some(beside)))
}

/// Returns the plan for all frames of a turntable in one file, if the options request that.
pub fn wanted(args: &RenderArgs, kind: Kind) -> Result<Option<Plan>, Failure> {
    let picture = &args.picture;
    let (gif, one) = (kind == Kind::Gif, output::is_one_file(&args.output));
    let (frames, format) = match (picture.turntable, kind.animation()) {
        (None, _) if gif => {
            let message = "--output: a GIF is for a --turntable; end the name of a picture in .png, .jpg or \
                           .webp";
            return Err(Failure::Usage(message.to_owned()));
        }
        (Some(frames), Some(format)) if gif || one => (frames, format),
        _ if args.given.iter().any(|g| g == "fps" || g == "duration") => {
            let message = "--fps, --duration: frames have times in one file only; end its name in .png, \
                           .webp or .gif, with no place for a number";
            return Err(Failure::Usage(message.to_owned()));
        }
        _ => return Ok(None),
    };
    let options = Options {
        size: (picture.rendered_size().width, picture.rendered_size().height),
        frames,
        seconds: seconds(format, frames, picture.fps, picture.duration)?,
        alpha: !is_opaque(&picture.background),
        compression: picture.encoding.compression.into(),
    };
    Ok(Some(Plan { format, options }))
}

fn is_opaque(background: &Background) -> bool {
    match background {
        Background::Color(color) => color.w >= 1.0,
        Background::Gradient(top, bottom) => top.w.min(bottom.w) >= 1.0,
    }
}

/// Returns the time that all frames take, in seconds; refuses times that the format cannot store.
fn seconds(
    format: AnimationFormat,
    frames: u32,
    rate: Option<f64>,
    duration: Option<f64>,
) -> Result<f64, Failure> {
    let count = f64::from(frames);
    let seconds = duration.unwrap_or(count / rate.unwrap_or(FRAMES_PER_SECOND));
    let (least, most) = format.times();
    let each = seconds / count;
    if each >= least * (1.0 - 1e-9) && each <= most {
        return Ok(seconds);
    }
    let option = if duration.is_some() { "--duration" } else { "--fps" };
    Err(Failure::Usage(format!(
        "{option}: {each} s for each frame; this format shows one for {least} to {most} s"
    )))
}

/// Returns one target for each model, as often as it has frames.
pub fn targets(
    path: &Path,
    models: &[PathBuf],
    frames: usize,
    wanted: &Wanted,
) -> Result<Vec<Target>, Failure> {
    let name = |model: &PathBuf| Name { input: model.clone(), frame: None };
    let names: Vec<Name> = models.iter().map(name).collect();
    let targets = output::plan("--output", path, &names, wanted)?;
    if targets.contains(&Target::Stdout) {
        let message = "--output -: an animation is written to a file; name one";
        return Err(Failure::Usage(message.to_owned()));
    }
    Ok(targets.into_iter().flat_map(|target| vec![target; frames]).collect())
}

/// Destination of a frame.
pub enum Sink<'a, 'f> {
    /// A separate file.
    File(&'a Target),
    /// The film with the other frames.
    Film(&'a mut Film<'f>),
}

impl Sink<'_, '_> {
    /// Returns the name of the file.
    pub fn name(&self) -> String {
        match self {
            Self::File(target) => target.to_string(),
            Self::Film(film) => film.path.display().to_string(),
        }
    }

    /// Writes a picture; returns whether it had to be composed with white.
    pub fn put(
        &mut self,
        pixels: &Pixels<[u8; 4]>,
        format: PictureFormat,
        encoding: &EncodingArgs,
    ) -> Result<bool, Failure> {
        match self {
            Self::File(target) => encoding.deliver(target, format, pixels),
            Self::Film(film) => film.push(pixels).map(|()| false),
        }
    }
}
