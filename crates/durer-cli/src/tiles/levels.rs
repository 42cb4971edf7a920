//! The zoom levels of tiles: those of `--zoom`, or those that the data need.

use super::args::TilesArgs;
use durer::clip::tiles::{DetailLevel, Options, Pyramid, Reason, TileFeature};
use serde::Serialize;
use std::ops::RangeInclusive;

/// Largest number of tiles of levels that were not requested: some minutes of work, and a level beyond the one that
/// shows the coasts of the world.
const MANY: u64 = 100_000;

/// The highest level of data at a single place.
const PLACE: u8 = 14;

/// Source of the levels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Chosen {
    /// The option.
    Option,
    /// The distances between vertices.
    Vertices,
    /// The distances between features.
    Distances,
    /// The sizes of features.
    Sizes,
    /// The limit on the number of tiles: the data have more detail.
    Tiles,
    /// The default for data at a single place.
    Place,
    /// None: there are no features.
    Nothing,
}

/// Returns the largest number of tiles of levels that were not requested.
fn most(args: &TilesArgs) -> u64 {
    args.max_tiles.min(MANY)
}

impl Chosen {
    /// Returns a sentence about the choice; `None` if the levels were requested.
    pub fn message(self, zooms: &RangeInclusive<u8>, args: &TilesArgs) -> Option<String> {
        let (last, most) = (zooms.end(), most(args));
        let why = match self {
            Self::Option | Self::Nothing => return None,
            Self::Vertices => format!("level {last} shows the distances between vertices"),
            Self::Distances => format!("level {last} shows the distances between features"),
            Self::Sizes => format!("level {last} shows 99 % of the lines and areas"),
            Self::Tiles => {
                format!("higher levels would show more detail, in more than {most} tiles")
            }
            Self::Place => "all features are at one place".to_owned(),
        };
        let levels = match zooms.start() {
            first if first == last => format!("zoom level {last} is"),
            first => format!("zoom levels {first}-{last} are"),
        };
        Some(format!("{levels} chosen: {why}; --zoom sets others"))
    }
}

/// Returns the features prepared for their levels, and the source of these.
pub fn pyramid(args: &TilesArgs, features: Vec<TileFeature>) -> durer::Result<(Pyramid, Chosen)> {
    let (zooms, chosen) = match &args.zoom {
        Some(zooms) => (zooms.clone(), Chosen::Option),
        None if features.is_empty() => (0..=0, Chosen::Nothing),
        None => of_detail(DetailLevel::of(&features, args.extent)),
    };
    let options = Options {
        zooms: zooms.clone(),
        extent: args.extent,
        buffer: args.buffer,
        method: args.method,
        tolerance: args.tolerance,
        tiny: args.tiny,
    };
    let mut pyramid = Pyramid::new(features, options)?;
    if chosen == Chosen::Option {
        return Ok((pyramid, chosen));
    }
    pyramid.reduce(most(args))?;
    let chosen = if pyramid.zooms() == zooms { chosen } else { Chosen::Tiles };
    Ok((pyramid, chosen))
}

fn of_detail(detail: Option<DetailLevel>) -> (RangeInclusive<u8>, Chosen) {
    let Some(DetailLevel { zoom, reason }) = detail else { return (0..=PLACE, Chosen::Place) };
    let chosen = match reason {
        Reason::Vertices => Chosen::Vertices,
        Reason::Distances => Chosen::Distances,
        Reason::Sizes => Chosen::Sizes,
    };
    (0..=zoom, chosen)
}
