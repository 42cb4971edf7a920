//! Frames of longitudes and latitudes, and the transformations between them.
//!
//! Current datums differ from WGS 84 by less than two metres plus the drift of continents; coordinates are passed
//! between them unchanged, as other software does without a grid. Datums of old surveys are hundreds of metres off;
//! some are transformed by the seven parameters of the EPSG's list, to within a few metres. Others need grids and are
//! refused.

use super::ellipsoid::Ellipsoid;
use super::shift::Shift;

/// An ellipsoid by the names of definitions.
#[derive(Debug, PartialEq)]
pub struct Spheroid {
    /// Its name in definitions.
    pub name: &'static str,
    /// Half the longer axis, in metres.
    pub a: f64,
    /// The inverse flattening.
    pub inverse: f64,
}

const WGS84: Spheroid = Spheroid { name: "WGS_1984", a: 6_378_137.0, inverse: 298.257_223_563 };
const GRS80: Spheroid = Spheroid { name: "GRS_1980", a: 6_378_137.0, inverse: 298.257_222_101 };
const AIRY: Spheroid = Spheroid { name: "Airy_1830", a: 6_377_563.396, inverse: 299.324_964_6 };
const BESSEL: Spheroid = Spheroid { name: "Bessel_1841", a: 6_377_397.155, inverse: 299.152_812_8 };
const HAYFORD: Spheroid = Spheroid { name: "International_1924", a: 6_378_388.0, inverse: 297.0 };

/// A frame.
#[derive(Debug, PartialEq)]
pub struct Datum {
    /// The number of its longitudes and latitudes.
    pub code: i32,
    /// Its name in definitions, without `D_`.
    pub name: &'static str,
    /// Parts of its names, in lower case, with only letters and digits.
    marks: &'static [&'static str],
    /// Its ellipsoid.
    pub spheroid: Spheroid,
    /// Shift to WGS 84.
    pub shift: Shift,
    /// Largest error of coordinates after the shift, in metres; 0 if it is less than the difference between
    /// today's frames.
    pub accuracy: f64,
}

impl Datum {
    pub fn body(&self) -> Ellipsoid {
        Ellipsoid::flattened(self.spheroid.a, self.spheroid.inverse)
    }

    /// Returns the frame that a definition names.
    pub fn of_name(name: &str) -> Option<&'static Self> {
        let letters = name.chars().filter(char::is_ascii_alphanumeric);
        let name: String = letters.map(|c| c.to_ascii_lowercase()).collect();
        // These datums differ from the ones whose names their names contain.
        if ["mgi1901", "ed77"].iter().any(|other| name.contains(other)) {
            return None;
        }
        DATUMS.iter().find(|datum| datum.marks.iter().any(|mark| name.contains(mark)))
    }
}

/// Numbers of systems on frames that are refused, from the first to the last, and the name of the frame.
const REFUSED: [(i32, i32, &str); 38] = [
    (4267, 4267, "NAD27"),
    (26_701, 26_722, "NAD27"),
    (26_729, 26_799, "NAD27"),
    (32_001, 32_061, "NAD27"),
    (4149, 4150, "CH1903"),
    (2056, 2056, "CH1903+"),
    (21_781, 21_782, "CH1903"),
    (4289, 4289, "Amersfoort"),
    (28_991, 28_992, "Amersfoort"),
    (4301, 4301, "Tokyo"),
    (30_161, 30_179, "Tokyo"),
    (4284, 4284, "Pulkovo 1942"),
    (28_402, 28_432, "Pulkovo 1942"),
    (4178, 4179, "Pulkovo 1942(83/58)"),
    (2166, 2168, "Pulkovo 1942(83)"),
    (3333, 3335, "Pulkovo 1942(58)"),
    (4200, 4200, "Pulkovo 1995"),
    (20_004, 20_032, "Pulkovo 1995"),
    (4272, 4272, "NZGD49"),
    (27_200, 27_200, "NZGD49"),
    (4202, 4203, "AGD66 or AGD84"),
    (20_248, 20_258, "AGD66"),
    (20_348, 20_358, "AGD84"),
    (4275, 4275, "NTF"),
    (4807, 4807, "NTF (Paris)"),
    (27_561, 27_582, "NTF (Paris)"),
    (4156, 4156, "S-JTSK"),
    (5513, 5514, "S-JTSK"),
    (4214, 4214, "Beijing 1954"),
    (21_413, 21_463, "Beijing 1954"),
    (4610, 4610, "Xian 1980"),
    (2327, 2390, "Xian 1980"),
    (4265, 4265, "Monte Mario"),
    (3003, 3004, "Monte Mario"),
    (4299, 4300, "TM65 or TM75"),
    (29_902, 29_903, "TM65 or TM75"),
    (4618, 4618, "SAD69"),
    (29_168, 29_195, "SAD69"),
];

/// Returns the name of the frame of a system that is refused for it.
pub fn refused(code: i32) -> Option<&'static str> {
    REFUSED.iter().find(|(from, to, _)| (*from..=*to).contains(&code)).map(|(.., name)| *name)
}

pub static DATUMS: [Datum; 15] = [
    Datum {
        code: 4326,
        name: "WGS_1984",
        marks: &["wgs1984", "wgs84", "worldgeodeticsystem1984"],
        spheroid: WGS84,
        shift: Shift::NONE,
        accuracy: 0.0,
    },
    Datum {
        code: 4258,
        name: "ETRS_1989",
        marks: &["etrs1989", "etrs89", "europeanterrestrialreferencesystem1989"],
        spheroid: GRS80,
        shift: Shift::NONE,
        accuracy: 0.0,
    },
    Datum {
        code: 4269,
        name: "North_American_1983",
        marks: &["northamerican1983", "northamericandatum1983", "nad83", "nad1983"],
        spheroid: GRS80,
        shift: Shift::NONE,
        accuracy: 0.0,
    },
    Datum {
        code: 4171,
        name: "RGF_1993",
        marks: &["rgf1993", "rgf93", "reseaugeodesiquefrancais1993"],
        spheroid: GRS80,
        shift: Shift::NONE,
        accuracy: 0.0,
    },
    Datum {
        code: 4283,
        name: "GDA_1994",
        marks: &["gda1994", "gda94", "geocentricdatumofaustralia1994"],
        spheroid: GRS80,
        shift: Shift::NONE,
        accuracy: 0.0,
    },
    Datum {
        code: 4167,
        name: "NZGD_2000",
        marks: &["nzgd2000", "newzealandgeodeticdatum2000"],
        spheroid: GRS80,
        shift: Shift::NONE,
        accuracy: 0.0,
    },
    Datum {
        code: 4674,
        name: "SIRGAS_2000",
        marks: &["sirgas2000", "sistemadereferenciageocentricoparalasamericas2000"],
        spheroid: GRS80,
        shift: Shift::NONE,
        accuracy: 0.0,
    },
    Datum {
        code: 6668,
        name: "JGD_2011",
        marks: &["jgd2011", "japanesegeodeticdatum2011"],
        spheroid: GRS80,
        shift: Shift::NONE,
        accuracy: 0.0,
    },
    Datum {
        code: 4619,
        name: "SWEREF99",
        marks: &["sweref99"],
        spheroid: GRS80,
        shift: Shift::NONE,
        accuracy: 0.0,
    },
    Datum {
        code: 9702,
        name: "ETRF2000_Poland",
        marks: &["etrf2000poland", "etrf2000pl"],
        spheroid: GRS80,
        shift: Shift::NONE,
        accuracy: 0.0,
    },
    // Transformation 1314 of the EPSG's list.
    Datum {
        code: 4277,
        name: "OSGB_1936",
        marks: &["osgb1936", "osgb36", "ordnancesurveyofgreatbritain1936"],
        spheroid: AIRY,
        shift: Shift::new([446.448, -125.157, 542.06], [0.15, 0.247, 0.842], -20.489),
        accuracy: 5.0,
    },
    // 1777.
    Datum {
        code: 4314,
        name: "Deutsches_Hauptdreiecksnetz",
        marks: &["deutscheshauptdreiecksnetz", "dhdn"],
        spheroid: BESSEL,
        shift: Shift::new([598.1, 73.7, 418.2], [0.202, 0.045, -2.455], 6.7),
        accuracy: 3.0,
    },
    // 1133.
    Datum {
        code: 4230,
        name: "European_1950",
        marks: &["european1950", "europeandatum1950", "ed50"],
        spheroid: HAYFORD,
        shift: Shift::new([-87.0, -98.0, -121.0], [0.0; 3], 0.0),
        accuracy: 10.0,
    },
    // 1618.
    Datum {
        code: 4312,
        name: "MGI",
        marks: &["militargeographischeinstitut", "militargeographischesinstitut", "mgi"],
        spheroid: BESSEL,
        shift: Shift::new([577.326, 90.129, 463.919], [5.137, 1.474, 5.297], 2.4232),
        accuracy: 2.0,
    },
    // 15929.
    Datum {
        code: 4313,
        name: "Belge_1972",
        marks: &["belge1972", "reseaunationalbelge1972"],
        spheroid: HAYFORD,
        shift: Shift::new([-106.8686, 52.2978, -103.7239], [0.3366, -0.457, 1.8422], -1.2747),
        accuracy: 1.0,
    },
];

/// Returns the frame of a number of longitudes and latitudes.
pub fn of_code(code: i32) -> Option<&'static Datum> {
    DATUMS.iter().find(|datum| datum.code == code)
}
