//! `--explode`: assemblies with their parts moved apart.

use crate::failure::Failure;
use crate::values;
use clap::Args;
use durer::scene::Scene;
use durer::view::explode::{self, ExplodeDirection};

/// Options that move the parts of assemblies apart.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Section")]
pub struct ExplodeArgs {
    /// Move the parts of an assembly apart along x, y or z, or radially from the middle
    ///
    /// Parts are the objects of the file. GAP is the free space between neighbours along the axis, or how far the
    /// outermost part moves away from the middle, in the model's units. Along an axis, lines connect the parts.
    /// Sections without a letter are cut before, those with one after.
    #[arg(long, value_name = "AXIS[:GAP]", allow_hyphen_values = true, value_parser = exploded)]
    pub explode: Option<Explode>,
}

/// `--explode`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Explode {
    way: ExplodeDirection,
    gap: Option<f64>,
}

fn exploded(text: &str) -> Result<Explode, String> {
    let (way, gap) = text.split_once(':').map_or((text, None), |(way, gap)| (way, Some(gap)));
    let way = way.parse().map_err(|e: durer::Error| e.to_string())?;
    Ok(Explode { way, gap: gap.map(values::positive).transpose()? })
}

/// Moves the parts of a scene apart, if requested.
pub fn apply(args: &ExplodeArgs, scene: &mut Scene) -> Result<(), Failure> {
    if let Some(Explode { way, gap }) = args.explode {
        *scene = explode::explode(scene, way, gap).map_err(|e| Failure::Data(format!("--{e}")))?;
    }
    Ok(())
}
