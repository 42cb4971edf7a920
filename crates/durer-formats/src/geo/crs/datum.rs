//! Frames that longitudes and latitudes are told in, as far as they agree with WGS 84.
//!
//! Those of today differ by less than two metres, and by what continents move; coordinates are taken over between
//! them as they are, as other software does where no grid is at hand.

use super::ellipsoid::Ellipsoid;

/// A frame.
#[derive(Debug, PartialEq)]
pub struct Datum {
    /// The number of its longitudes and latitudes.
    pub code: i32,
    /// Its name in definitions, without `D_`.
    pub name: &'static str,
    /// What its names contain, in lower case and without what is no letter or digit.
    marks: &'static [&'static str],
    /// Whether its ellipsoid is that of WGS 84, and not GRS 1980.
    is_wgs84: bool,
}

impl Datum {
    pub fn body(&self) -> Ellipsoid {
        if self.is_wgs84 { Ellipsoid::WGS84 } else { Ellipsoid::GRS80 }
    }

    /// The name and the inverse flattening of the ellipsoid.
    pub fn spheroid(&self) -> (&'static str, f64) {
        if self.is_wgs84 { ("WGS_1984", 298.257_223_563) } else { ("GRS_1980", 298.257_222_101) }
    }

    /// The frame that a definition names.
    pub fn of_name(name: &str) -> Option<&'static Self> {
        let letters = name.chars().filter(char::is_ascii_alphanumeric);
        let name: String = letters.map(|c| c.to_ascii_lowercase()).collect();
        DATUMS.iter().find(|datum| datum.marks.iter().any(|mark| name.contains(mark)))
    }
}

pub static DATUMS: [Datum; 10] = [
    Datum {
        code: 4326,
        name: "WGS_1984",
        marks: &["wgs1984", "wgs84", "worldgeodeticsystem1984"],
        is_wgs84: true,
    },
    Datum {
        code: 4258,
        name: "ETRS_1989",
        marks: &["etrs1989", "etrs89", "europeanterrestrialreferencesystem1989"],
        is_wgs84: false,
    },
    Datum {
        code: 4269,
        name: "North_American_1983",
        marks: &["northamerican1983", "northamericandatum1983", "nad83", "nad1983"],
        is_wgs84: false,
    },
    Datum {
        code: 4171,
        name: "RGF_1993",
        marks: &["rgf1993", "rgf93", "reseaugeodesiquefrancais1993"],
        is_wgs84: false,
    },
    Datum {
        code: 4283,
        name: "GDA_1994",
        marks: &["gda1994", "gda94", "geocentricdatumofaustralia1994"],
        is_wgs84: false,
    },
    Datum {
        code: 4167,
        name: "NZGD_2000",
        marks: &["nzgd2000", "newzealandgeodeticdatum2000"],
        is_wgs84: false,
    },
    Datum {
        code: 4674,
        name: "SIRGAS_2000",
        marks: &["sirgas2000", "sistemadereferenciageocentricoparalasamericas2000"],
        is_wgs84: false,
    },
    Datum {
        code: 6668,
        name: "JGD_2011",
        marks: &["jgd2011", "japanesegeodeticdatum2011"],
        is_wgs84: false,
    },
    Datum { code: 4619, name: "SWEREF99", marks: &["sweref99"], is_wgs84: false },
    Datum {
        code: 9702,
        name: "ETRF2000_Poland",
        marks: &["etrf2000poland", "etrf2000pl"],
        is_wgs84: false,
    },
];

/// The frame of a number of longitudes and latitudes.
pub fn of_code(code: i32) -> Option<&'static Datum> {
    DATUMS.iter().find(|datum| datum.code == code)
}
