//! From one coordinate system to another: `--from-crs`, `--to-crs`.

use crate::failure::Failure;
use clap::Args;
use durer_formats::geo::crs::{Crs, Transform};
use durer_formats::geo::{Feature, GeoFormat, System};

/// The options.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Coordinates")]
pub struct SystemArgs {
    /// The coordinate system of IN [default: what the file says; longitude and latitude for GeoJSON]
    ///
    /// EPSG:4326 and the like, robinson, equal-earth, mercator, or a definition as well-known text. Longitude comes
    /// before latitude, easting before northing.
    #[arg(long, value_name = "CRS", value_parser = Crs::parse)]
    pub from_crs: Option<Crs>,
    /// Bring all coordinates to this system, after cutting; before it for tiles
    #[arg(long, value_name = "CRS", value_parser = Crs::parse)]
    pub to_crs: Option<Crs>,
}

/// Brings features to another system.
#[derive(Debug, Clone)]
pub struct Shift {
    transform: Transform,
    /// The system of what comes out.
    pub system: System,
    /// Features that have no place there.
    pub lost: u64,
}

impl Shift {
    /// What options ask for, of a file of a format that says it is in a system; nothing where nothing is asked for.
    ///
    /// # Errors
    /// Where the system that coordinates come from is not known.
    pub fn new(
        args: &SystemArgs,
        format: GeoFormat,
        told: &System,
    ) -> Result<Option<Self>, Failure> {
        let Some(to) = &args.to_crs else { return Ok(None) };
        let from = match &args.from_crs {
            Some(from) => Ok(from.clone()),
            None => Crs::of_system(told),
        };
        let from = from.map_err(|e| {
            Failure::Usage(format!(
                "--to-crs: {e} ({}); --from-crs says where coordinates come from",
                format.name()
            ))
        })?;
        Ok(Some(Self { transform: Transform::new(&from, to), system: to.system(), lost: 0 }))
    }

    /// Brings a feature there; false where it has no place there.
    pub fn apply(&mut self, feature: &mut Feature) -> bool {
        feature.srid = self.system.code;
        let Some(geometry) = &feature.geometry else { return true };
        let moved = self.transform.geometry(geometry);
        let is_there = moved.is_some();
        self.lost += u64::from(!is_there);
        feature.geometry = moved;
        is_there
    }

    /// What is to be told at the end.
    pub fn told(&self) -> Option<String> {
        let (lost, system) = (self.lost, self.system.code);
        let name =
            system.map_or_else(|| "the new system".to_owned(), |code| format!("EPSG:{code}"));
        (lost > 0).then(|| {
            format!("{lost} features reach beyond where {name} shows anything; left out (--window cuts them before)")
        })
    }
}
