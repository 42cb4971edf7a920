//! `--section`: models cut by planes.

use crate::color;
use crate::failure::Failure;
use crate::messages::Messages;
use crate::values;
use clap::Args;
use durer::math::{DVec3, Plane, Vec4};
use durer::scene::Scene;
use durer::view::section::{self, Options, Section};
use durer_formats::wording::agreeing;

/// Words about cuts without a cap, after their number.
pub const UNCAPPED: &str = "{cut through an open mesh has|cuts through open meshes have} no cap";

/// The planes that models are cut by.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Section")]
pub struct SectionArgs {
    /// Cut the model by a plane and keep the side where NX·x + NY·y + NZ·z + D > 0
    ///
    /// The plane is in the units and axes of the model, as in the box that `durer info` prints. If given several times,
    /// the part on the right side of all planes is kept. Closed bodies are closed again by a cap; open ones show their
    /// inside, with a warning. The view is fitted to the part that is kept. E.g. --section 0,0,1,-5 keeps the part
    /// above z = 5.
    ///
    /// With a letter, a --sheet has a view of the kept part, seen from the removed side, and other views show the plane
    /// where it is edge on. E.g. --section A:0,1,0,-5 gives the section A–A.
    #[arg(long, value_name = "[LETTER:]NX,NY,NZ,D", allow_hyphen_values = true, value_parser = section)]
    pub section: Vec<SectionPlane>,
    /// The colour of caps
    #[arg(long, value_name = "COLOR", default_value = "#c83c32", value_parser = color::color, requires = "section")]
    pub cap_color: Vec4,
    /// Leave cut bodies open
    #[arg(long, requires = "section")]
    pub no_caps: bool,
}

/// A plane of `--section`.
#[derive(Debug, Clone, PartialEq)]
pub struct SectionPlane {
    /// Name of its view on a sheet; `None` if it cuts the model itself.
    pub letter: Option<String>,
    /// Cutting plane.
    pub plane: Plane,
}

fn section(text: &str) -> Result<SectionPlane, String> {
    let (letter, text) = match text.split_once(':') {
        Some((name, rest)) => (Some(values::letter(name)?), rest),
        None => (None, text),
    };
    Ok(SectionPlane { letter, plane: plane(text)? })
}

fn plane(text: &str) -> Result<Plane, String> {
    let parts: Vec<f64> = text.split(',').map(values::number).collect::<Result<_, _>>()?;
    let wrong = "a plane is NX,NY,NZ,D, e.g. 0,0,1,-5, with a normal other than zero";
    let &[x, y, z, distance] = &parts[..] else { return Err(wrong.to_owned()) };
    let plane = Plane { normal: DVec3::new(x, y, z), distance };
    plane.normalized().map(|_| plane).ok_or_else(|| wrong.to_owned())
}

impl SectionArgs {
    /// Returns the sections that are views of a sheet, with their names.
    pub fn views(&self) -> impl Iterator<Item = (&str, Plane)> {
        self.section.iter().filter_map(|s| s.letter.as_deref().map(|letter| (letter, s.plane)))
    }

    /// Cuts a scene by planes.
    pub fn cut(&self, scene: &Scene, planes: &[Plane]) -> Result<Section, Failure> {
        let options = Options { caps: !self.no_caps, cap_color: self.cap_color.truncate() };
        section::cut(scene, planes, &options).map_err(|e| Failure::Data(e.to_string()))
    }
}

/// Refuses combinations of options that the parser accepts separately.
pub fn check(args: &SectionArgs, sheet: bool) -> Result<(), Failure> {
    match args.views().next() {
        Some((letter, _)) if !sheet => Err(Failure::Usage(format!(
            "--section {letter}: a section with a letter is a view of a --sheet; give one, or leave the \
             letter out to cut the model itself"
        ))),
        _ => Ok(()),
    }
}

/// Cuts a scene as requested, reports warnings, and returns the material of the caps.
pub fn apply(
    args: &SectionArgs,
    scene: &mut Scene,
    name: &str,
    messages: &Messages,
) -> Result<Option<usize>, Failure> {
    let planes: Vec<Plane> =
        args.section.iter().filter(|s| s.letter.is_none()).map(|s| s.plane).collect();
    if planes.is_empty() {
        return Ok(None);
    }
    let cut = args.cut(scene, &planes)?;
    if cut.scene.triangle_count() == 0 && scene.triangle_count() > 0 {
        messages.warning(name, "--section leaves nothing of the model");
    }
    if cut.open_cuts > 0 {
        messages.warning(name, agreeing(cut.open_cuts, UNCAPPED));
    }
    messages.detail(|| format!("{name}: caps with an area of {} square units", cut.cap_area));
    *scene = cut.scene;
    Ok(Some(cut.cap_material))
}
