//! The numbers of coordinate systems that EWKT and EWKB tell; coordinates are never converted.

use durer_formats::geo::GeoFormat;

/// Those of the features of a file.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Srids {
    /// The first that was told.
    first: Option<i32>,
    /// Whether there was another one.
    several: bool,
}

impl Srids {
    pub fn add(&mut self, srid: Option<i32>) {
        self.several |= self.first.is_some() && srid.is_some() && srid != self.first;
        self.first = self.first.or(srid);
    }

    /// The one of all features that tell one.
    pub fn common(self) -> Option<i32> {
        self.first.filter(|_| !self.several)
    }

    /// What gets lost or does not fit.
    pub fn told(self, mask: &Self, joined: bool, to: GeoFormat) -> Vec<String> {
        let mut told = Vec::new();
        let Some(srid) = self.first else { return told };
        if mask.first.is_some_and(|of_mask| self.several || mask.several || of_mask != srid) {
            told.push("the mask has another SRID; coordinates are taken as they are".to_owned());
        }
        if !matches!(to, GeoFormat::Wkt | GeoFormat::Wkb | GeoFormat::WkbHex) {
            told.push(format!("SRID {srid} is left out: {} has no place for it", to.name()));
        } else if joined && self.several {
            told.push("features of several SRIDs are joined; the result has none".to_owned());
        }
        told
    }
}
