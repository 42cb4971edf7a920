//! The coordinate systems of input, mask and output.

use super::Job;
use crate::failure::Failure;
use crate::layer::{CRS, Shift, SystemArgs, late};
use crate::options::TileCoordinates;
use durer::math::DVec2;
use durer_formats::geo::crs::Crs;
use durer_formats::geo::{Feature, GeoFormat, Geometry, Member, System};
use durer_formats::wording::counted;

/// Largest longitude that data may mean: lines that are not cut at the 180th meridian go on beyond it.
const LONGITUDE: f64 = 360.0;

/// Largest latitude.
const LATITUDE: f64 = 90.0;

impl Job<'_> {
    /// Notes the system that the file states, with the first feature.
    pub(super) fn begin(&mut self) {
        if self.stated.is_none() {
            let stated = self.reader.system();
            if self.shift.is_none() && self.args.region.tiles.is_some() {
                self.shift = self.to_tiles(&stated);
            }
            self.shift.iter_mut().for_each(|shift| shift.begin(stated.clone()));
            self.stated = Some(stated);
        }
    }

    /// Returns the conversion to the coordinates of tiles, if the file states another system.
    fn to_tiles(&self, stated: &System) -> Option<Shift> {
        let code =
            if self.args.region.tile_coordinates == TileCoordinates::Lonlat { 4326 } else { 3857 };
        let given = self.args.systems.from_crs.is_some();
        // GeoJSON without a member crs is taken as the option says.
        let is_meant =
            *stated == System::LONLAT || stated.is_unknown() || stated.code == Some(code);
        let to = Crs::of_code(code).filter(|_| given || !is_meant)?;
        Shift::new(&SystemArgs { to_crs: Some(to), ..self.args.systems.clone() })
    }

    /// Counts a feature whose coordinates cannot be longitudes and latitudes although the output demands them.
    pub(super) fn check_degrees(&mut self, feature: &Feature) {
        let from = GeoFormat::ALL.into_iter().find(|from| from.name() == self.report.from);
        let is_stated = from.is_none_or(|from| from.is_lonlat() || from == GeoFormat::Svg)
            || self.shift.is_some()
            || self.args.systems.from_crs.is_some()
            || feature.srid.is_some()
            || self.stated.as_ref().is_some_and(|stated| !stated.is_unknown());
        if is_stated || !self.to.is_lonlat() {
            return;
        }
        let bounds = feature.geometry.as_ref().and_then(Geometry::bounds);
        let farthest = bounds.map_or(DVec2::ZERO, |b| b.min().abs().max(b.max().abs()));
        self.report.far_degrees += u64::from(farthest.x > LONGITUDE || farthest.y > LATITUDE);
    }

    /// Returns a warning about features whose coordinates are no longitudes and latitudes.
    pub(super) fn no_degrees(&self) -> Option<String> {
        let count = self.report.far_degrees;
        (count > 0).then(|| {
            let features = counted(count, "feature has", "features have");
            format!(
                "{features} coordinates beyond 90 degrees of latitude or 360 of longitude, but {} has longitudes and \
                 latitudes (RFC 7946); --from-crs gives the system of the file, and --to-crs EPSG:4326 converts to them",
                self.to
            )
        })
    }

    /// Refuses a system that the file states after its features, if they would have been treated otherwise.
    pub(super) fn check_system(&self) -> Result<(), Failure> {
        let matters =
            self.shift.is_some() || self.args.region.tiles.is_some() || self.to.states_system();
        match late(self.stated.as_ref(), self.reader) {
            Some((why, option)) if matters && self.args.systems.from_crs.is_none() => {
                Err(self.fail(format!("{why}; {option} sets their system")))
            }
            _ => Ok(()),
        }
    }

    /// Returns the coordinate system of the output.
    pub(super) fn system(&self) -> System {
        match (&self.shift, &self.args.systems.from_crs) {
            (Some(shift), _) => shift.system.clone(),
            (None, Some(from)) => from.system(),
            (None, None) => {
                let stated = self.reader.system();
                let common = self.report.srids.common().filter(|_| stated.is_unknown());
                common.map_or(stated, System::of_code)
            }
        }
    }

    /// Returns the members of the collection, with the one for the coordinate system if GeoJSON needs it.
    pub(super) fn members(&self) -> Vec<Member> {
        let mut members = self.reader.members().to_vec();
        if !matches!(self.to, GeoFormat::GeoJson | GeoFormat::TopoJson) {
            return members;
        }
        let is_new = self.shift.is_some() || self.args.systems.from_crs.is_some();
        members.retain(|member| !is_new || member.name != CRS);
        let stated = members.iter().any(|member| member.name == CRS);
        let stated_by_file = is_new || !self.reader.system().is_unknown();
        members.extend(self.system().member().filter(|_| !stated && stated_by_file));
        members
    }

    /// Returns a warning if GeoJSON has coordinates other than longitude and latitude.
    pub(super) fn unfit(&self) -> Option<String> {
        let code = self.system().code.filter(|code| *code != 4326 && self.to.is_lonlat())?;
        let stated = self.members().iter().any(|member| member.name == CRS);
        let own = self.reader.members().iter().any(|member| member.name == CRS);
        (stated && (self.shift.is_some() || !own)).then(|| {
            format!(
                "{} should have longitudes and latitudes (RFC 7946); coordinates in EPSG:{code} are marked \
                 by the older member crs, which some programs ignore",
                self.to
            )
        })
    }

    /// Moves a feature to the requested system; returns whether it has a place there.
    pub(super) fn shifted(&mut self, feature: &mut Feature) -> Result<bool, Failure> {
        match &mut self.shift {
            Some(shift) => shift.apply(feature),
            None => {
                let from = self.args.systems.from_crs.as_ref();
                feature.srid = from.map_or(feature.srid, |from| from.code());
                Ok(true)
            }
        }
    }
}
