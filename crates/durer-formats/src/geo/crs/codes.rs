//! The coordinate systems known by number.

use super::datum::{self, Datum};
use super::projection::{Method, Projection, scale_of_parallel};
use super::{Crs, Kind};
use durer::math::DVec2;

/// List of known systems, for messages.
pub const KNOWN: &str = "known are EPSG:4326 and other longitudes and latitudes close to it (4258, 4269, 4171 …), \
3857, UTM (326zz, 327zz, 258zz, 269zz …), 2154, 3942 to 3950, 3034, 3035, 3395, 5070, 3031, 3413, 3995, 2193, 3006, 3067, \
2180, 3577, 3978 and more; on older frames 27700, 31466 to 31469, 230zz, 31370, 31254 to 31256 and 31284 to 31287; robinson, equal-earth, mercator; and definitions as well-known text of such projections";

/// Names on the command line, in capitals.
const NAMES: [(&str, i32); 10] = [
    ("CRS84", 4326),
    ("OGC:CRS84", 4326),
    ("URN:OGC:DEF:CRS:OGC:1.3:CRS84", 4326),
    ("WGS84", 4326),
    ("LONLAT", 4326),
    ("WEB-MERCATOR", 3857),
    ("WEBMERCATOR", 3857),
    ("MERCATOR", 3395),
    ("ROBINSON", 54030),
    ("EQUAL-EARTH", 8857),
];

/// Returns the number behind a name in capitals.
pub fn of_name(name: &str) -> Option<i32> {
    NAMES.iter().find(|(known, _)| *known == name).map(|(_, code)| *code)
}

/// Numbers of longitudes and latitudes.
const WGS84: i32 = 4326;
const ETRS89: i32 = 4258;
const NAD83: i32 = 4269;
const RGF93: i32 = 4171;
const GDA94: i32 = 4283;
const OSGB36: i32 = 4277;
const DHDN: i32 = 4314;
const MGI: i32 = 4312;

/// A conic projection: its number, its geographic system's number, name, origin, parallels and offset.
type Conic = (i32, i32, &'static str, [f64; 2], [f64; 2], [f64; 2]);

/// Lambert's conformal conic.
const CONFORMAL: [Conic; 7] = [
    (2154, RGF93, "RGF_1993_Lambert_93", [3.0, 46.5], [49.0, 44.0], [700_000.0, 6_600_000.0]),
    (3034, ETRS89, "ETRS_1989_LCC", [10.0, 52.0], [35.0, 65.0], [4_000_000.0, 2_800_000.0]),
    (
        3347,
        NAD83,
        "NAD_1983_Statistics_Canada_Lambert",
        [-91.866_666_666_666_67, 63.390_675],
        [49.0, 77.0],
        [6_200_000.0, 3_000_000.0],
    ),
    (3978, NAD83, "NAD_1983_Canada_Atlas_Lambert", [-95.0, 49.0], [49.0, 77.0], [0.0, 0.0]),
    (
        3112,
        GDA94,
        "GDA_1994_Geoscience_Australia_Lambert",
        [134.0, 0.0],
        [-18.0, -36.0],
        [0.0, 0.0],
    ),
    (31287, MGI, "MGI_Austria_Lambert", [13.0 + 1.0 / 3.0, 47.5], [49.0, 46.0], [4e5, 4e5]),
    (
        31370,
        4313,
        "Belge_Lambert_1972",
        [4.367_486_666_666_666, 90.0],
        [51.166_667_233_333_33, 49.833_333_9],
        [150_000.013, 5_400_088.438],
    ),
];

/// Albers' conic.
const ALBERS: [Conic; 3] = [
    (5070, NAD83, "NAD_1983_Contiguous_USA_Albers", [-96.0, 23.0], [29.5, 45.5], [0.0, 0.0]),
    (3577, GDA94, "GDA_1994_Australia_Albers", [132.0, 0.0], [-18.0, -36.0], [0.0, 0.0]),
    (3338, NAD83, "NAD_1983_Alaska_Albers", [-154.0, 50.0], [55.0, 65.0], [0.0, 0.0]),
];

/// A cylindrical projection: its number, its geographic system's number, name, meridian, scale and offset.
type Cylinder = (i32, i32, &'static str, f64, f64, [f64; 2]);

/// Transverse Mercator.
const TRANSVERSE: [Cylinder; 14] = [
    (
        2193,
        4167,
        "NZGD_2000_New_Zealand_Transverse_Mercator",
        173.0,
        0.9996,
        [1_600_000.0, 10_000_000.0],
    ),
    (3006, 4619, "SWEREF99_TM", 15.0, 0.9996, [500_000.0, 0.0]),
    (3067, ETRS89, "ETRS_1989_TM35FIN", 27.0, 0.9996, [500_000.0, 0.0]),
    (2180, 9702, "ETRF2000-PL_CS92", 19.0, 0.9993, [500_000.0, -5_300_000.0]),
    (31466, DHDN, "DHDN_3_Degree_Gauss_Zone_2", 6.0, 1.0, [2_500_000.0, 0.0]),
    (31467, DHDN, "DHDN_3_Degree_Gauss_Zone_3", 9.0, 1.0, [3_500_000.0, 0.0]),
    (31468, DHDN, "DHDN_3_Degree_Gauss_Zone_4", 12.0, 1.0, [4_500_000.0, 0.0]),
    (31469, DHDN, "DHDN_3_Degree_Gauss_Zone_5", 15.0, 1.0, [5_500_000.0, 0.0]),
    (31254, MGI, "MGI_Austria_GK_West", 10.0 + 1.0 / 3.0, 1.0, [0.0, -5e6]),
    (31255, MGI, "MGI_Austria_GK_Central", 13.0 + 1.0 / 3.0, 1.0, [0.0, -5e6]),
    (31256, MGI, "MGI_Austria_GK_East", 16.0 + 1.0 / 3.0, 1.0, [0.0, -5e6]),
    (31284, MGI, "MGI_Austria_GK_M28", 10.0 + 1.0 / 3.0, 1.0, [150_000.0, 0.0]),
    (31285, MGI, "MGI_Austria_GK_M31", 13.0 + 1.0 / 3.0, 1.0, [450_000.0, 0.0]),
    (31286, MGI, "MGI_Austria_GK_M34", 16.0 + 1.0 / 3.0, 1.0, [750_000.0, 0.0]),
];

/// An azimuthal projection: its number, its geographic system's number, name, origin and offset.
type Plane = (i32, i32, &'static str, [f64; 2], [f64; 2]);

/// Lambert's azimuthal.
const AZIMUTHAL: [Plane; 9] = [
    (3035, ETRS89, "ETRS_1989_LAEA", [10.0, 52.0], [4_321_000.0, 3_210_000.0]),
    (6931, WGS84, "WGS_1984_NSIDC_EASE_Grid_2_North", [0.0, 90.0], [0.0, 0.0]),
    (6932, WGS84, "WGS_1984_NSIDC_EASE_Grid_2_South", [0.0, -90.0], [0.0, 0.0]),
    (3571, WGS84, "WGS_1984_North_Pole_LAEA_Bering_Sea", [180.0, 90.0], [0.0, 0.0]),
    (3572, WGS84, "WGS_1984_North_Pole_LAEA_Alaska", [-150.0, 90.0], [0.0, 0.0]),
    (3573, WGS84, "WGS_1984_North_Pole_LAEA_Canada", [-100.0, 90.0], [0.0, 0.0]),
    (3574, WGS84, "WGS_1984_North_Pole_LAEA_Atlantic", [-40.0, 90.0], [0.0, 0.0]),
    (3575, WGS84, "WGS_1984_North_Pole_LAEA_Europe", [10.0, 90.0], [0.0, 0.0]),
    (3576, WGS84, "WGS_1984_North_Pole_LAEA_Russia", [90.0, 90.0], [0.0, 0.0]),
];

/// Stereographic around the poles: number, name, meridian, true parallel.
const POLAR: [(i32, &str, f64, f64); 4] = [
    (3031, "WGS_1984_Antarctic_Polar_Stereographic", 0.0, -71.0),
    (3413, "WGS_1984_NSIDC_Sea_Ice_Polar_Stereographic_North", -45.0, 70.0),
    (3976, "WGS_1984_NSIDC_Sea_Ice_Polar_Stereographic_South", 0.0, -70.0),
    (3995, "WGS_1984_Arctic_Polar_Stereographic", 0.0, 71.0),
];

/// UTM: the number of zone 0, the first and last zone, whether it is the southern half, the geographic system's number,
/// and the name.
const UTM: [(i32, i32, i32, bool, i32, &str); 8] = [
    (32600, 1, 60, false, WGS84, "WGS_1984_UTM_Zone_"),
    (32700, 1, 60, true, WGS84, "WGS_1984_UTM_Zone_"),
    (25800, 28, 38, false, ETRS89, "ETRS_1989_UTM_Zone_"),
    (26900, 1, 23, false, NAD83, "NAD_1983_UTM_Zone_"),
    (23000, 28, 38, false, 4230, "ED_1950_UTM_Zone_"),
    (28300, 48, 58, true, GDA94, "GDA_1994_MGA_Zone_"),
    (31954, 11, 22, false, 4674, "SIRGAS_2000_UTM_Zone_"),
    (31960, 17, 25, true, 4674, "SIRGAS_2000_UTM_Zone_"),
];

/// Returns a system of the list: its name in definitions, its datum and its kind.
fn entry(code: i32) -> Option<(String, &'static Datum, Kind)> {
    if let Some(datum) = datum::of_code(code) {
        return Some((format!("GCS_{}", datum.name), datum, Kind::Geographic));
    }
    let (name, base, method, lon, offset) = projected(code)?;
    let datum = datum::of_code(base)?;
    let body = if is_web(code) { datum.body().sphere() } else { datum.body() };
    let (meridian, offset) = (lon.to_radians(), DVec2::from_array(offset));
    let projection = Projection { method, body, meridian, offset };
    Some((name, datum, Kind::Projected { projection, unit: 1.0 }))
}

/// Returns whether it is the sphere that web maps use.
fn is_web(code: i32) -> bool {
    code == WEB
}

/// The number of web maps' system.
const WEB: i32 = 3857;

/// The number of Great Britain's grid.
const BRITISH: i32 = 27700;

/// Name, longitudes and latitudes, method, meridian, offset.
type Projected = (String, i32, Method, f64, [f64; 2]);

fn projected(code: i32) -> Option<Projected> {
    let named =
        |name: &str, base, method, lon, offset| Some((name.to_owned(), base, method, lon, offset));
    let world = |name: &str, method| named(name, WGS84, method, 0.0, [0.0, 0.0]);
    match code {
        WEB => {
            return world(
                "WGS_1984_Web_Mercator_Auxiliary_Sphere",
                Method::Mercator { scale: 1.0 },
            );
        }
        3395 => return world("WGS_1984_World_Mercator", Method::Mercator { scale: 1.0 }),
        8857 => return world("WGS_1984_Equal_Earth_Greenwich", Method::EqualEarth),
        54030 => return world("World_Robinson", Method::Robinson),
        BRITISH => {
            let method = Method::Transverse { lat: 49_f64.to_radians(), scale: 0.999_601_271_7 };
            return named("British_National_Grid", OSGB36, method, -2.0, [400_000.0, -100_000.0]);
        }
        3942..=3950 => {
            let lat = f64::from(code - 3900);
            let parallels = [lat - 0.75, lat + 0.75].map(f64::to_radians);
            let method = Method::Conformal { lat: lat.to_radians(), parallels, scale: 1.0 };
            let north = f64::from(code - 3941) * 1e6 + 200_000.0;
            return named(
                &format!("RGF_1993_CC{}", code - 3900),
                RGF93,
                method,
                3.0,
                [1_700_000.0, north],
            );
        }
        _ => {}
    }
    if let Some(&(_, base, name, [lon, lat], two, offset)) = CONFORMAL.iter().find(|c| c.0 == code)
    {
        let method = Method::Conformal {
            lat: lat.to_radians(),
            parallels: two.map(f64::to_radians),
            scale: 1.0,
        };
        return named(name, base, method, lon, offset);
    }
    if let Some(&(_, base, name, [lon, lat], two, offset)) = ALBERS.iter().find(|c| c.0 == code) {
        let method = Method::Albers { lat: lat.to_radians(), parallels: two.map(f64::to_radians) };
        return named(name, base, method, lon, offset);
    }
    if let Some(&(_, base, name, lon, scale, offset)) = TRANSVERSE.iter().find(|c| c.0 == code) {
        return named(name, base, Method::Transverse { lat: 0.0, scale }, lon, offset);
    }
    if let Some(&(_, base, name, [lon, lat], offset)) = AZIMUTHAL.iter().find(|c| c.0 == code) {
        return named(name, base, Method::Azimuthal { lat: lat.to_radians() }, lon, offset);
    }
    if let Some(&(_, name, lon, parallel)) = POLAR.iter().find(|c| c.0 == code) {
        let body = datum::of_code(WGS84)?.body();
        let scale = scale_of_parallel(body, parallel.to_radians());
        let method = Method::Stereographic { pole: 1_f64.copysign(parallel), scale };
        return named(name, WGS84, method, lon, [0.0, 0.0]);
    }
    utm(code)
}

fn utm(code: i32) -> Option<Projected> {
    let &(start, _, _, south, base, name) = UTM.iter().find(|(start, first, last, ..)| {
        code.checked_sub(*start).is_some_and(|zone| (*first..=*last).contains(&zone))
    })?;
    let zone = code - start;
    let half = match (south, base) {
        (true, GDA94) => "",
        (true, _) => "S",
        (false, _) => "N",
    };
    let method = Method::Transverse { lat: 0.0, scale: 0.9996 };
    let offset = [500_000.0, if south { 1e7 } else { 0.0 }];
    Some((format!("{name}{zone}{half}"), base, method, f64::from(6 * zone - 183), offset))
}

/// Other numbers of the same systems.
const ALIASES: [(i32, i32); 7] = [
    (4979, 4326),
    (900_913, WEB),
    (102_100, WEB),
    (102_113, WEB),
    (3785, WEB),
    (54004, 3395),
    (54035, 8857),
];

/// Returns a system by its number.
pub fn crs(code: i32) -> Option<Crs> {
    let code = ALIASES.iter().find(|(alias, _)| *alias == code).map_or(code, |(_, own)| *own);
    let (_, datum, kind) = entry(code)?;
    Some(Crs { code: Some(code), datum, kind })
}

/// Returns the name of a system in definitions.
pub fn name(code: i32) -> String {
    entry(code).map_or_else(String::new, |(name, ..)| name)
}

/// Returns all numbers, without aliases.
fn all() -> impl Iterator<Item = i32> {
    let utm = UTM.iter().flat_map(|(start, first, last, ..)| start + first..=start + last);
    let conic = CONFORMAL.iter().chain(&ALBERS).map(|c| c.0);
    let other = TRANSVERSE.iter().map(|c| c.0).chain(AZIMUTHAL.iter().map(|c| c.0));
    let polar = POLAR.iter().map(|c| c.0);
    let geographic = datum::DATUMS.iter().map(|datum| datum.code);
    geographic
        .chain(utm)
        .chain([WEB, 3395, 8857, 54030, BRITISH])
        .chain(3942..=3950)
        .chain(conic)
        .chain(other)
        .chain(polar)
}

/// Returns the number of a listed system that equals the given one up to rounding.
pub fn of_crs(crs: &Crs) -> Option<i32> {
    all().find(|&code| {
        entry(code).is_some_and(|(_, datum, kind)| datum == crs.datum && is_close(&kind, &crs.kind))
    })
}

fn is_close(one: &Kind, other: &Kind) -> bool {
    match (one, other) {
        (Kind::Geographic, Kind::Geographic) => true,
        (
            Kind::Projected { projection: a, unit: u },
            Kind::Projected { projection: b, unit: v },
        ) => {
            let (p, q) = (numbers(a), numbers(b));
            let same = std::mem::discriminant(&a.method) == std::mem::discriminant(&b.method);
            let close =
                |(x, y): (&f64, &f64)| (x - y).abs() <= 1e-9 * x.abs().max(y.abs()).max(1e-3);
            same && u == v && p.iter().zip(&q).all(close)
        }
        _ => false,
    }
}

/// Returns all numbers of a projection; parallels in one order, because it says nothing.
fn numbers(projection: &Projection) -> [f64; 8] {
    let two = |[a, b]: [f64; 2]| [a.min(b), a.max(b)];
    let [p, q, r, s] = match projection.method {
        Method::Mercator { scale } => [scale, 0.0, 0.0, 0.0],
        Method::Transverse { lat, scale } => [lat, scale, 0.0, 0.0],
        Method::Conformal { lat, parallels, scale } => {
            let [a, b] = two(parallels);
            [lat, a, b, scale]
        }
        Method::Albers { lat, parallels } => {
            let [a, b] = two(parallels);
            [lat, a, b, 0.0]
        }
        Method::Azimuthal { lat } => [lat, 0.0, 0.0, 0.0],
        Method::Stereographic { pole, scale } => [pole, scale, 0.0, 0.0],
        Method::Robinson | Method::EqualEarth => [0.0; 4],
    };
    let Projection { meridian, offset, body, .. } = projection;
    [p, q, r, s, *meridian, offset.x, offset.y, body.e2]
}

#[cfg(test)]
mod tests {
    use super::super::{code_of_wkt, wkt_of_code};
    use super::*;

    #[test]
    fn all_systems_are_known_by_their_definitions() {
        for code in all() {
            let text = wkt_of_code(code).expect("a definition");
            let found = code_of_wkt(&text).expect("a number");
            // TM35FIN is zone 35 of ETRS89 by another name.
            assert_eq!(found, if code == 3067 { 25835 } else { code }, "{text}");
        }
        assert_eq!(crs(900_913), crs(3857));
        assert_eq!((crs(4267), crs(32661), crs(i32::MIN)), (None, None, None));
    }
}
