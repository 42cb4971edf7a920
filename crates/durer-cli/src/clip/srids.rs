//! The numbers of coordinate systems given by features.

use durer_formats::geo::crs::{Crs, Transform};
use durer_formats::geo::{GeoFormat, System};

/// SRIDs of a file's features.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Srids {
    /// The first few of them, in order of appearance.
    first: Vec<i32>,
    /// True if there were more.
    more: bool,
}

/// Number of systems that a message lists.
const TOLD: usize = 4;

impl Srids {
    pub fn add(&mut self, srid: Option<i32>) {
        let Some(srid) = srid.filter(|srid| !self.first.contains(srid)) else { return };
        if self.first.len() < TOLD {
            self.first.push(srid);
        } else {
            self.more = true;
        }
    }

    /// Adds the system that a file states for all its features, unless they have their own.
    pub fn of_file(&mut self, stated: &System) {
        if self.first.is_empty() {
            self.add(stated.code);
        }
    }

    /// Returns the number that is common to all features with one.
    pub fn common(&self) -> Option<i32> {
        match self.first[..] {
            [srid] => Some(srid),
            _ => None,
        }
    }

    /// Returns all of them, as a message lists them.
    fn names(&self) -> String {
        let numbers: Vec<String> = self.first.iter().map(i32::to_string).collect();
        let (name, more) = (if numbers.len() > 1 { "SRIDs" } else { "SRID" }, self.more);
        format!("{name} {}{}", numbers.join(", "), if more { " and others" } else { "" })
    }

    /// Returns a warning if the mask is in another coordinate system than the features; `stated` is the system that their
    /// file states for all.
    pub fn other_mask(&self, mask: &Self, stated: &System) -> Option<String> {
        let mut own = self.clone();
        own.of_file(stated);
        if own.first.is_empty() || mask.first.is_empty() {
            return None;
        }
        let is_same = own.common().zip(mask.common()).is_some_and(|(own, mask)| {
            let crs =
                || Some(Transform::new(&Crs::of_code(own)?, &Crs::of_code(mask)?).is_identity());
            own == mask || crs() == Some(true)
        });
        (!is_same).then(|| {
            format!(
                "the mask has another SRID, {} and not {}; coordinates are taken as they are (durer clip MASK --to-crs \
                 converts it)",
                mask.names(),
                own.names()
            )
        })
    }

    /// Returns warnings about coordinate systems that get lost; `is_stated` tells whether the result states the system of
    /// all features.
    pub fn warnings(&self, joined: bool, to: GeoFormat, is_stated: bool) -> Vec<String> {
        let mut warnings = Vec::new();
        if self.first.is_empty() {
            return warnings;
        }
        let several = self.first.len() > 1;
        let is_meant = to.is_lonlat() && self.first == [4326];
        if !to.states_system() && !is_meant && !is_stated {
            let are = if several { "are" } else { "is" };
            warnings.push(format!(
                "{} {are} left out: {} has no place for it",
                self.names(),
                to.name()
            ));
        } else if joined && several {
            warnings.push("features of several SRIDs are joined; the result has none".to_owned());
        }
        warnings
    }
}
