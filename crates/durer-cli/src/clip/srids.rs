//! The numbers of coordinate systems given by features.

use durer_formats::geo::GeoFormat;

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

    /// Returns warnings about coordinate systems that get lost or do not match; `is_told` tells whether the result
    /// states the system of all features.
    pub fn told(&self, mask: &Self, joined: bool, to: GeoFormat, is_told: bool) -> Vec<String> {
        let mut told = Vec::new();
        if self.first.is_empty() {
            return told;
        }
        let several = self.first.len() > 1;
        let is_other = several || mask.first.len() > 1 || mask.first != self.first;
        if is_other && !mask.first.is_empty() {
            let [own, its] = [self.names(), mask.names()];
            let message = format!("the mask has another SRID, {its} and not {own}");
            told.push(format!("{message}; coordinates are taken as they are"));
        }
        let is_meant = to.is_lonlat() && self.first == [4326];
        if !to.tells_system() && !is_meant && !is_told {
            let are = if several { "are" } else { "is" };
            told.push(format!(
                "{} {are} left out: {} has no place for it",
                self.names(),
                to.name()
            ));
        } else if joined && several {
            told.push("features of several SRIDs are joined; the result has none".to_owned());
        }
        told
    }
}
