//! From one coordinate system to another: `--from-crs`, `--to-crs`.

use crate::failure::Failure;
use clap::Args;
use durer_formats::geo::crs::{Crs, Transform};
use durer_formats::geo::{Feature, Member, Reader, System};
use durer_formats::wording::counted;
use std::io::Read;

/// The member for the coordinate system in the older version of GeoJSON, as JSON.
pub const CRS: &str = "\"crs\"";

/// Returns what is wrong if a file states its system only after its features, which have been taken to be in another
/// one, and the option that helps.
pub fn late<R: Read>(
    stated: Option<&System>,
    reader: &Reader<R>,
) -> Option<(&'static str, String)> {
    let last = reader.system();
    let is_late = stated.is_some_and(|stated| *stated != last)
        && reader.members().iter().any(|member| member.name == CRS);
    is_late.then(|| {
        let code = last.code.map(|code| format!(" EPSG:{code}")).unwrap_or_default();
        (
            "the member crs follows the features, which have been read as longitudes and latitudes",
            format!("--from-crs{code}"),
        )
    })
}

/// Options for coordinate systems.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Coordinates")]
pub struct SystemArgs {
    /// The coordinate system of IN [default: that of the file; longitude and latitude for GeoJSON]
    ///
    /// EPSG:4326 and other codes, robinson, equal-earth, mercator, or a definition as well-known text. Longitude
    /// comes before latitude, easting before northing.
    #[arg(long, value_name = "CRS", value_parser = Crs::parse)]
    pub from_crs: Option<Crs>,
    /// Convert all coordinates to this system, after clipping; before it for tiles
    #[arg(long, value_name = "CRS", value_parser = Crs::parse)]
    pub to_crs: Option<Crs>,
}

/// Conversion of features to another system.
#[derive(Debug, Clone)]
pub struct Shift {
    to: Crs,
    /// The system of the input that the options give.
    given: Option<Crs>,
    /// The system that the file states.
    stated: System,
    /// The transform from that system, or from the given one, if it is known.
    common: Option<Transform>,
    /// The transform for features with the number of their own system: the last number, and its transform.
    own: Option<(i32, Transform)>,
    /// Reason why the system of the file as a whole is unknown.
    unknown: String,
    /// The system of the output.
    pub system: System,
    /// Features that have no place there.
    pub lost: u64,
}

impl Shift {
    /// Builds the conversion that the options request; `None` if they request none.
    pub fn new(args: &SystemArgs) -> Option<Self> {
        let to = args.to_crs.clone()?;
        let (given, system) = (args.from_crs.clone(), to.system());
        let (stated, common, own, unknown) = Default::default();
        let mut shift = Self { to, given, stated, common, own, unknown, system, lost: 0 };
        shift.begin(System::default());
        Some(shift)
    }

    /// Sets the system that the file states, when it is known: with the first feature.
    pub fn begin(&mut self, stated: System) {
        let from = self.given.clone().map_or_else(|| Crs::of_system(&stated), Ok);
        (self.common, self.unknown) = match from {
            Ok(from) => (Some(Transform::new(&from, &self.to)), String::new()),
            Err(why) => (None, why),
        };
        self.stated = stated;
    }

    /// Returns the transform from a feature's system.
    fn transform(&mut self, srid: Option<i32>) -> Result<&Transform, Failure> {
        // A feature may be in another system than the file.
        let is_own = self.given.is_none() && srid.is_some() && srid != self.stated.code;
        if let (Some(common), false) = (&self.common, is_own) {
            return Ok(common);
        }
        let wrong = |why: &str| {
            Failure::Usage(format!("--to-crs: {why}; --from-crs sets the system of the input"))
        };
        let srid = srid.ok_or_else(|| wrong(&self.unknown))?;
        let known = self.own.take().filter(|(own, _)| *own == srid);
        let own = match known {
            Some(known) => known,
            None => {
                let from = Crs::of_system(&System::of_code(srid)).map_err(|e| wrong(&e))?;
                (srid, Transform::new(&from, &self.to))
            }
        };
        Ok(&self.own.insert(own).1)
    }

    /// Converts a feature to the system; returns whether it has a place there.
    ///
    /// # Errors
    /// If its source system is not known.
    pub fn apply(&mut self, feature: &mut Feature) -> Result<bool, Failure> {
        if let Some(geometry) = feature.geometry.take() {
            feature.geometry = self.transform(feature.srid)?.geometry(&geometry);
            if feature.geometry.is_none() {
                self.lost += 1;
                return Ok(false);
            }
        }
        feature.srid = self.system.code;
        let is_old = |member: &Member| member.name == CRS;
        feature.members.retain(|member| !is_old(member));
        feature.geometry_members.retain(|member| !is_old(member));
        Ok(true)
    }

    /// Returns a warning at the end.
    pub fn warning(&self) -> Option<String> {
        let (lost, system) = (self.lost, self.system.code);
        let name =
            system.map_or_else(|| "the new system".to_owned(), |code| format!("EPSG:{code}"));
        let lost = (lost > 0).then(|| {
            let (one, several) = ("feature reaches", "features reach");
            format!(
                "{} beyond the area of {name}; left out (--window cuts to an area first)",
                counted(lost, one, several)
            )
        });
        let parts: Vec<String> = lost.into_iter().chain(self.shifted()).collect();
        (!parts.is_empty()).then(|| parts.join("; "))
    }

    /// Returns a warning about the accuracy of coordinates transformed from or to an older frame.
    fn shifted(&self) -> Option<String> {
        let way = self.common.as_ref().or_else(|| self.own.as_ref().map(|(_, way)| way))?;
        let (datum, metres) = way.accuracy()?;
        Some(format!(
            "coordinates are shifted between datums by seven parameters: with {datum} they may be off by {metres} m"
        ))
    }
}
