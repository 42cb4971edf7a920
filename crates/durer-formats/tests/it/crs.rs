//! Coordinate systems, compared with figures of PROJ 9.5.1 (pyproj, `always_xy=True`).

use durer::math::DVec2;
use durer_formats::geo::crs::{Crs, Transform, code_of_wkt, wkt_of_code};
use durer_formats::geo::{Geometry, Points, System};
use proptest::prelude::*;

/// Number, longitude, latitude, easting, northing.
const FIGURES: &[(i32, f64, f64, f64, f64)] = &[
    (3857, 9.0, 48.0, 1001875.417139, 6106854.834885),
    (3857, -179.9, -85.05, -20026376.393710, -20036051.919337),
    (3857, 0.0, 0.0, 0.000000, 0.000000),
    (3395, 9.0, 48.0, 1001875.417139, 6075085.090058),
    (3395, -120.0, -70.0, -13358338.895193, -11028513.630920),
    (32632, 9.0, 48.0, 500000.000000, 5316300.224451),
    (32632, 11.9, 60.1, 661232.233993, 6666086.421173),
    (32632, 6.0, -10.0, 171071.263941, -1106908.854243),
    (32632, 14.0, 83.0, 567945.973209, 9219403.547332),
    (32733, 15.0, -33.9, 500000.000000, 6248931.733876),
    (32733, 18.4, -33.9, 814420.330951, 6243724.840075),
    (25833, 13.4, 52.5, 391390.731339, 5817855.240693),
    (26910, -122.4, 37.8, 552821.382993, 4183794.498824),
    (28355, 147.0, -37.8, 500000.000000, 5816375.017688),
    (31983, -46.6, -23.5, 336625.131857, 7400218.860255),
    (2154, 2.35, 48.85, 652301.564831, 6861302.725900),
    (2154, -4.5, 48.4, 145709.788950, 6837422.082614),
    (2154, 9.4, 42.2, 1228961.330192, 6143644.945337),
    (3949, 2.0, 49.0, 1626836.573318, 8200481.881330),
    (3034, 10.0, 52.0, 4000000.000000, 2800000.000000),
    (3034, -8.0, 40.0, 2505577.355052, 1688337.094935),
    (3035, 10.0, 52.0, 4321000.000000, 3210000.000000),
    (3035, 13.4, 52.5, 4551801.973288, 3271028.983160),
    (3035, -9.1, 38.7, 2668283.440559, 1943501.023643),
    (3035, 28.0, 65.0, 5164617.766802, 4764445.384987),
    (5070, -96.0, 23.0, 0.000000, 0.000000),
    (5070, -122.4, 37.8, -2273032.787510, 1958176.391293),
    (5070, -71.0, 42.0, 2033016.726015, 2379874.020125),
    (3577, 149.1, -35.3, 1547574.619744, -3959208.329194),
    (3031, 0.0, -75.0, 0.000000, 1638783.238407),
    (3031, 120.0, -68.5, 2046177.733462, -1181361.265224),
    (3031, -60.0, -90.0, 0.000000, 0.000000),
    (3413, -45.0, 80.0, 0.000000, -1085920.297393),
    (3413, 100.0, 72.2, 1114607.678785, 1591824.734756),
    (3995, 25.0, 70.0, 927433.344325, -1988887.225215),
    (6931, 40.0, 60.0, 2127510.997694, -2535468.874786),
    (6931, 0.0, 90.0, 0.000000, 0.000000),
    (6932, 40.0, -60.0, 2127510.997694, 2535468.874786),
    (3574, 10.0, 75.0, 1279485.741570, -1073616.013848),
    (8857, 9.0, 48.0, 723301.342975, 5781753.389038),
    (8857, -150.0, -60.0, -10837692.540866, -6924035.137553),
    (8857, 179.0, 89.0, 10164195.230873, 8391009.942477),
    (2193, 174.8, -41.3, 1750697.521334, 5426376.623168),
    (3006, 18.0, 59.3, 670817.915574, 6577304.567007),
    (3067, 25.0, 60.2, 389130.042088, 6675364.495215),
    (2180, 21.0, 52.2, 636640.467013, 483432.200828),
    (3347, -75.7, 45.4, 7471636.525325, 1188239.545788),
    (3978, -75.7, 45.4, 1511127.635736, -172193.059898),
    (3112, 149.0, -35.0, 1362439.781028, -4021036.590815),
    (54030, 9.0, 48.0, 747980.438267, 5119205.279776),
    (54030, -150.0, -60.0, -11317382.336898, -6336038.681965),
    (54030, 179.0, 89.0, 9119404.223803, 8594066.417178),
    (54030, 10.0, 5.0, 943445.848203, 534759.580497),
    (54030, 0.0, 90.0, 0.000000, 8625154.665100),
];

fn transform(from: i32, to: i32) -> Transform {
    let crs = |code| Crs::of_code(code).unwrap_or_else(|| panic!("{code}"));
    Transform::new(&crs(from), &crs(to))
}

#[test]
fn places_lie_where_proj_has_them() {
    for &(code, lon, lat, x, y) in FIGURES {
        let given = DVec2::new(lon, lat);
        let there = transform(4326, code).apply(given).expect("a place");
        // The figures have six decimals.
        assert!((there - DVec2::new(x, y)).length() < 2e-6, "{code}: {lon}, {lat}: {there}");
        let back = transform(code, 4326).apply(DVec2::new(x, y)).expect("a place");
        let off = (back - given).abs();
        // At a pole any longitude is right.
        let off = if lat.abs() == 90.0 { off.y } else { off.max_element() };
        assert!(off < 1e-9, "{code}: {lon}, {lat}: {back}");
    }
}

#[test]
fn what_has_no_place_is_nowhere() {
    for (from, to, p) in [
        (4326, 3857, (0.0, 90.0)),
        (4326, 3395, (0.0, -90.0)),
        (4326, 3031, (0.0, 90.0)),
        (4326, 32632, (100.0, 0.0)),
        (4326, 3035, (-170.0, -52.0)),
        (4326, 2154, (0.0, 91.0)),
        (3035, 4326, (9e7, 0.0)),
        (54030, 4326, (0.0, 9e6)),
        (8857, 4326, (0.0, 9e6)),
        (6931, 4326, (2e7, 0.0)),
        (32632, 4326, (1e9, 0.0)),
    ] {
        assert_eq!(transform(from, to).apply(p.into()), None, "{from} to {to}: {p:?}");
    }
    let line = Geometry::LineString(Points::flat(vec![DVec2::ZERO, DVec2::new(0.0, 90.0)]));
    assert_eq!(transform(4326, 3857).geometry(&line), None);
}

#[test]
fn the_same_system_leaves_coordinates_alone() {
    let p = DVec2::new(0.1, 0.2);
    assert_eq!(transform(4326, 4326).apply(p), Some(p));
    assert_eq!(transform(4326, 4258).apply(p), Some(p));
    assert!(transform(3857, 3857).is_identity());
}

#[test]
fn systems_are_known_by_many_names() {
    for (text, code) in [
        ("EPSG:4326", 4326),
        ("epsg:3857", 3857),
        (" 32632 ", 32632),
        ("urn:ogc:def:crs:EPSG::2154", 2154),
        ("OGC:CRS84", 4326),
        ("ESRI:54030", 54030),
        ("robinson", 54030),
        ("900913", 3857),
    ] {
        assert_eq!(Crs::parse(text).map(|crs| crs.code()), Ok(Some(code)), "{text}");
    }
    for text in ["EPSG:21781", "", "mars", "GEOGCS[\"x\"]"] {
        assert!(Crs::parse(text).is_err(), "{text}");
    }
}

/// Positions on older datums: as in `FIGURES`, with parameters in PROJ's syntax. Longitudes and latitudes have eleven
/// decimals.
const SHIFTED: &[(i32, f64, f64, f64, f64)] = &[
    (27700, -2.5, 53.5, 366930.326448, 400483.401903),
    (4277, 0.1, 51.5, 0.10163207919, 51.49948507059),
    (31467, 9.2, 48.8, 3514768.524742, 5406965.390660),
    (4314, 13.0, 52.5, 13.00168025734, 52.50140851987),
    (23030, -3.7, 40.4, 440699.788324, 4472596.462481),
    (31370, 4.35, 50.85, 148679.447378, 171066.810330),
    (31287, 13.0, 47.8, 375093.943348, 433455.973524),
    (31256, 16.37, 48.2, 2814.771436, 340177.440779),
];

#[test]
fn older_frames_are_shifted_as_proj_does() {
    for &(code, lon, lat, x, y) in SHIFTED {
        let (given, expected) = (DVec2::new(lon, lat), DVec2::new(x, y));
        let there = transform(4326, code).apply(given).expect("a place");
        let most =
            if Crs::of_code(code).is_some_and(|crs| crs.is_geographic()) { 2e-11 } else { 2e-6 };
        assert!((there - expected).length() < most, "{code}: {there}");
        // The way back neglects products of angles: less than a centimetre.
        let back = transform(code, 4326).apply(expected).expect("a place");
        assert!((back - given).length() < 1e-7, "{code}: {back}");
    }
    let (name, metres) = transform(27700, 3857).accuracy().expect("a shift");
    assert_eq!((name, metres), ("OSGB_1936", 5.0));
    assert_eq!(transform(4326, 4258).accuracy(), None);
    assert_eq!(transform(31467, 4314).accuracy(), None);
    assert!(!transform(4326, 4277).is_identity());
    let west = transform(4326, 4277).apply(DVec2::new(-182.0, 50.0)).expect("a place");
    assert!((west.x + 182.0).abs() < 0.01);
}

#[test]
fn frames_that_need_grids_are_refused_by_name() {
    for (code, name) in
        [(4267, "NAD27"), (21781, "CH1903"), (28992, "Amersfoort"), (26715, "NAD27")]
    {
        let messages = Crs::parse(&format!("EPSG:{code}")).expect_err("refused");
        assert!(messages.contains(&format!("is on the datum {name}, and its shift")), "{messages}");
    }
    let definition = |datum: &str, more: &str| {
        format!(
            "GEOGCS[\"x\",DATUM[\"{datum}\",SPHEROID[\"y\",6377563.396,299.3249646]{more}],\
             PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]]"
        )
    };
    for datum in ["North_American_1927", "MGI_1901", "European_1950_ED77", "D_CH1903"] {
        let messages = Crs::parse(&definition(datum, "")).expect_err("refused");
        assert!(
            messages.contains(&format!("the position of its datum {datum} is not known")),
            "{messages}"
        );
    }
    let shifted = definition("WGS_1984", ",TOWGS84[1,2,3,0,0,0,0]");
    assert!(Crs::parse(&shifted).is_err_and(|e| e.contains("WGS_1984")));
    for more in ["", ",TOWGS84[446.448,-125.157,542.06,0.15,0.247,0.842,-20.489]"] {
        let crs = Crs::parse(&definition("OSGB_1936", more)).expect("known");
        assert_eq!(code_of_wkt(&definition("OSGB_1936", more)), Some(4277));
        assert!(Transform::new(&crs, &Crs::of_code(4326).expect("known")).accuracy().is_some());
    }
}

#[test]
fn definitions_of_other_software_are_understood() {
    // As GDAL writes them: for web maps, and with its own method names.
    let web = "PROJCS[\"WGS 84 / Pseudo-Mercator\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,\
        298.257223563]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],PROJECTION[\"Mercator_1SP\"],\
        PARAMETER[\"central_meridian\",0],PARAMETER[\"scale_factor\",1],PARAMETER[\"false_easting\",0],\
        PARAMETER[\"false_northing\",0],UNIT[\"metre\",1],EXTENSION[\"PROJ4\",\"+proj=merc +a=6378137 +b=6378137\"]]";
    assert_eq!(code_of_wkt(web), Some(3857));
    let france = "PROJCS[\"RGF93 v1 / Lambert-93\",GEOGCS[\"RGF93 v1\",DATUM[\"Reseau_Geodesique_Francais_1993_v1\",\
        SPHEROID[\"GRS 1980\",6378137,298.257222101]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],\
        PROJECTION[\"Lambert_Conformal_Conic_2SP\"],PARAMETER[\"latitude_of_origin\",46.5],\
        PARAMETER[\"central_meridian\",3],PARAMETER[\"standard_parallel_1\",49],PARAMETER[\"standard_parallel_2\",44],\
        PARAMETER[\"false_easting\",700000],PARAMETER[\"false_northing\",6600000],UNIT[\"metre\",1]]";
    assert_eq!(code_of_wkt(france), Some(2154));
    // Feet, and a system without a number.
    let feet =
        france.replace("UNIT[\"metre\",1]", "UNIT[\"foot\",0.3048]").replace("700000]", "0]");
    let crs = Crs::parse(&feet).expect("known");
    let p = Transform::new(&Crs::of_code(4326).expect("known"), &crs).apply(DVec2::new(3.0, 46.5));
    assert!((p.expect("a place") - DVec2::new(0.0, 6_600_000.0)).length() < 1e-6);
    assert_eq!(crs.code(), None);
    let system = System::of_wkt(&wkt_of_code(32632).expect("known"));
    assert_eq!(system.code, Some(32632));
}

proptest! {
    #[test]
    fn places_come_back(lon in -180.0..180.0f64, lat in -84.0..84.0f64, which in any::<prop::sample::Index>()) {
        let (code, ..) = FIGURES[which.index(FIGURES.len())];
        let given = DVec2::new(lon, lat);
        if let Some(there) = transform(4326, code).apply(given) {
            let back = transform(code, 4326).apply(there);
            // A quarter of the Earth from their central meridian, transverse cylindrical projections lose digits.
            let least = if there.x.abs() > 1e7 { 1e-4 } else { 1e-7 };
            let close = |back: DVec2| {
                let turn = (back.x - lon).abs();
                turn.min(360.0 - turn).max((back.y - lat).abs()) < least
            };
            prop_assert!(back.is_some_and(close), "{} {} {} {:?}", code, given, there, back);
        }
    }
}
