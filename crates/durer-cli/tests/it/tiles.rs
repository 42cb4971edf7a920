//! Vector tiles, decoded by a separate reader within the tests.

use crate::harness::Folder;
use serde_json::Value;
use std::io::Read;

/// A field of a Protocol Buffers message.
enum Field<'a> {
    Number(u64),
    Double(f64),
    Bytes(&'a [u8]),
}

fn varint(bytes: &mut &[u8]) -> u64 {
    let (mut value, mut shift) = (0, 0);
    loop {
        let byte = bytes[0];
        *bytes = &bytes[1..];
        value |= u64::from(byte & 0x7f) << shift;
        shift += 7;
        if byte < 0x80 {
            return value;
        }
    }
}

fn fields(mut bytes: &[u8]) -> Vec<(u64, Field<'_>)> {
    let mut found = Vec::new();
    while !bytes.is_empty() {
        let key = varint(&mut bytes);
        let field = match key & 7 {
            0 => Field::Number(varint(&mut bytes)),
            1 => {
                let (value, rest) = bytes.split_first_chunk::<8>().unwrap();
                bytes = rest;
                Field::Double(f64::from_le_bytes(*value))
            }
            2 => {
                let length = varint(&mut bytes) as usize;
                let (value, rest) = bytes.split_at(length);
                bytes = rest;
                Field::Bytes(value)
            }
            other => panic!("wire type {other}"),
        };
        found.push((key >> 3, field));
    }
    found
}

#[derive(Debug, Default, Clone)]
struct Feature {
    layer: String,
    id: Option<u64>,
    kind: u64,
    properties: Vec<(String, Value)>,
    /// Rings, lines, or points.
    runs: Vec<Vec<(i64, i64)>>,
}

impl Feature {
    fn get(&self, name: &str) -> Option<&Value> {
        self.properties.iter().find(|(n, _)| n == name).map(|(_, v)| v)
    }

    /// Returns twice the area of all rings.
    fn area(&self) -> i64 {
        self.runs.iter().map(|ring| area(ring)).sum()
    }
}

/// Returns twice the signed area of a ring by the surveyor's formula.
fn area(ring: &[(i64, i64)]) -> i64 {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(a, b)| a.0 * b.1 - b.0 * a.1).sum()
}

fn value(bytes: &[u8]) -> Value {
    match &fields(bytes)[..] {
        [(1, Field::Bytes(text))] => String::from_utf8(text.to_vec()).unwrap().into(),
        [(3, Field::Double(value))] => (*value).into(),
        [(5, Field::Number(value))] => (*value).into(),
        [(6, Field::Number(value))] => ((value >> 1) as i64 ^ -((value & 1) as i64)).into(),
        [(7, Field::Number(value))] => (*value == 1).into(),
        _ => panic!("value {bytes:?}"),
    }
}

fn packed(mut bytes: &[u8]) -> Vec<u64> {
    let mut found = Vec::new();
    while !bytes.is_empty() {
        found.push(varint(&mut bytes));
    }
    found
}

/// Draws the commands of a geometry, and checks that they follow the grammar.
fn drawn(kind: u64, commands: &[u64]) -> Vec<Vec<(i64, i64)>> {
    let (mut runs, mut at, mut next): (Vec<Vec<_>>, _, _) = (Vec::new(), (0, 0), 0);
    let mut closed = true;
    while next < commands.len() {
        let (command, count) = (commands[next] & 7, commands[next] >> 3);
        next += 1;
        assert!(count > 0);
        if command == 7 {
            assert!(kind == 3 && count == 1 && runs.last().unwrap().len() >= 3);
            closed = true;
            continue;
        }
        for _ in 0..count {
            let delta = |v: u64| (v >> 1) as i64 ^ -((v & 1) as i64);
            let (dx, dy) = (delta(commands[next]), delta(commands[next + 1]));
            next += 2;
            at = (at.0 + dx, at.1 + dy);
            if command == 1 {
                assert!(closed || kind != 3);
                assert!(count == 1 || kind == 1);
                runs.push(vec![at]);
            } else {
                assert!(command == 2 && kind != 1 && (dx, dy) != (0, 0));
                runs.last_mut().unwrap().push(at);
            }
            closed = false;
        }
    }
    assert!(closed || kind != 3);
    runs
}

/// Returns the features of a tile and checks each: rings have areas, outer ones come first, and their directions are
/// right.
fn decode(bytes: &[u8], extent: u64) -> Vec<Feature> {
    let mut found = Vec::new();
    for (number, layer) in fields(bytes) {
        let (3, Field::Bytes(layer)) = (number, layer) else { panic!("field {number} of a tile") };
        let (mut names, mut values, mut features) = (Vec::new(), Vec::new(), Vec::new());
        let (mut name, mut version, mut side) = (String::new(), 0, 4096);
        for field in fields(layer) {
            match field {
                (1, Field::Bytes(text)) => name = String::from_utf8(text.to_vec()).unwrap(),
                (2, Field::Bytes(feature)) => features.push(feature),
                (3, Field::Bytes(text)) => names.push(String::from_utf8(text.to_vec()).unwrap()),
                (4, Field::Bytes(bytes)) => values.push(value(bytes)),
                (5, Field::Number(extent)) => side = extent,
                (15, Field::Number(number)) => version = number,
                (number, _) => panic!("field {number} of a layer"),
            }
        }
        assert_eq!((version, side, features.is_empty()), (2, extent, false));
        for feature in features {
            let mut new = Feature { layer: name.clone(), ..Feature::default() };
            let mut commands = Vec::new();
            for field in fields(feature) {
                match field {
                    (1, Field::Number(id)) => new.id = Some(id),
                    (2, Field::Bytes(tags)) => {
                        let pair = |p: &[u64]| {
                            (names[p[0] as usize].clone(), values[p[1] as usize].clone())
                        };
                        new.properties = packed(tags).chunks(2).map(pair).collect();
                    }
                    (3, Field::Number(kind)) => new.kind = kind,
                    (4, Field::Bytes(bytes)) => commands = packed(bytes),
                    (number, _) => panic!("field {number} of a feature"),
                }
            }
            new.runs = drawn(new.kind, &commands);
            assert!(!new.runs.is_empty());
            if new.kind == 3 {
                assert!(area(&new.runs[0]) > 0);
                assert!(new.runs.iter().all(|ring| area(ring) != 0));
            }
            found.push(new);
        }
    }
    found
}

fn unpacked(bytes: &[u8]) -> Vec<u8> {
    let mut out = Vec::new();
    flate2::read::GzDecoder::new(bytes).read_to_end(&mut out).unwrap();
    out
}

/// Returns the tiles of a PMTiles file by their numbers.
fn pmtiles(bytes: &[u8]) -> Vec<(u64, Vec<u8>)> {
    assert_eq!(&bytes[..8], b"PMTiles\x03");
    let long = |at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize;
    let part = |offset: usize, length: usize| &bytes[offset..offset + length];
    let mut tiles = Vec::new();
    let mut open = vec![part(long(8), long(16))];
    assert!(long(8) + long(16) <= 16384);
    while let Some(directory) = open.pop() {
        let directory = unpacked(directory);
        let mut rest = &directory[..];
        let count = varint(&mut rest) as usize;
        let mut column = || (0..count).map(|_| varint(&mut rest)).collect::<Vec<_>>();
        let [ids, runs, lengths, offsets] = [(); 4].map(|()| column());
        assert!(rest.is_empty());
        let (mut id, mut next) = (0, 0);
        for i in 0..count {
            id += ids[i];
            let offset = if offsets[i] == 0 { next } else { offsets[i] as usize - 1 };
            next = offset + lengths[i] as usize;
            if runs[i] == 0 {
                open.push(part(long(40) + offset, lengths[i] as usize));
                continue;
            }
            let tile = unpacked(part(long(56) + offset, lengths[i] as usize));
            tiles.extend((0..runs[i]).map(|k| (id + k, tile.clone())));
        }
    }
    tiles.sort();
    assert_eq!(tiles.len(), long(72));
    let metadata: Value = serde_json::from_slice(&unpacked(part(long(24), long(32)))).unwrap();
    assert!(metadata["vector_layers"].is_array());
    tiles
}

/// Returns two parcels with a jagged border between them, a third far away, a path and two trees.
fn land() -> Folder {
    let folder = Folder::new();
    let border: Vec<(f64, f64)> =
        (0..=40).map(|i| (11.0 + f64::from(i % 3) * 0.01, f64::from(i) * 0.05)).collect();
    let ring = |points: Vec<(f64, f64)>| {
        let first = points.first().copied();
        let text: Vec<String> =
            points.into_iter().chain(first).map(|(x, y)| format!("[{x},{y}]")).collect();
        format!("[[{}]]", text.join(","))
    };
    let left = border.iter().rev().copied().chain([(10.0, 0.0), (10.0, 2.0)]).collect::<Vec<_>>();
    let right = border.iter().copied().chain([(12.0, 2.0), (12.0, 0.0)]).collect::<Vec<_>>();
    let feature = |id: &str, properties: &str, ring: String| {
        format!(
            r#"{{"type":"Feature","id":{id},"properties":{properties},"geometry":{{"type":"Polygon","coordinates":{ring}}}}}"#
        )
    };
    let parcels = [
        feature("7", r#"{"use":"wood","size":2.5,"owner":{"name":"A"},"built":null}"#, ring(left)),
        feature(r#""8""#, r#"{"use":"field","size":-3,"public":true}"#, ring(right)),
        feature(r#""nine""#, "null", ring(vec![(-100.0, 40.0), (-99.0, 40.0), (-99.0, 41.0)])),
    ];
    folder.write("parcels.geojsonl", parcels.join("\n"));
    folder.write("way.wkt", "LINESTRING (9 1, 13 1.3)\nMULTIPOINT ((11.5 1), (11.5 1.0000001))\n");
    folder
}

#[test]
fn tiles_have_what_their_features_have() {
    let folder = land();
    let ended = folder.must("tiles parcels.geojsonl way.wkt --zoom 0-6 -o map.pmtiles --json");
    assert!(ended.err.contains("feature 3 has an id that is not"), "{}", ended.err);
    let report = ended.json();
    let tiles = pmtiles(&folder.read("map.pmtiles"));
    assert_eq!(report["tiles"], tiles.len());
    assert_eq!(report["lost"], 0);
    let all: Vec<(u64, Vec<Feature>)> =
        tiles.iter().map(|(id, tile)| (*id, decode(tile, 4096))).collect();
    let world = &all[0].1;
    assert_eq!(all[0].0, 0);
    let layers: Vec<&str> = world.iter().map(|f| &f.layer[..]).collect();
    assert_eq!(layers, ["parcels", "parcels", "parcels", "way", "way"]);
    assert_eq!((world[0].id, world[1].id, world[2].id), (Some(7), Some(8), None));
    assert_eq!(world[0].get("use"), Some(&"wood".into()));
    assert_eq!(world[0].get("size"), Some(&2.5.into()));
    assert_eq!(world[0].get("owner"), Some(&r#"{"name":"A"}"#.into()));
    assert_eq!((world[0].get("built"), world[0].get("public")), (None, None));
    assert_eq!(
        (world[1].get("size"), world[1].get("public")),
        (Some(&(-3).into()), Some(&true.into()))
    );
    // Two trees in one cell become one, except on the last level.
    assert_eq!(world[4].runs.len(), 1);
    let points = |tile: &(u64, Vec<Feature>)| {
        tile.1.iter().filter(|f| f.kind == 1).map(|f| f.runs.len()).max()
    };
    assert_eq!(all.iter().filter_map(points).max(), Some(2));
}

#[test]
fn neighbours_keep_their_border_on_all_levels() {
    let folder = land();
    folder.must("tiles parcels.geojsonl --zoom 0-9 -o map.pmtiles");
    let mut kept = Vec::new();
    for (id, tile) in pmtiles(&folder.read("map.pmtiles")) {
        let found = decode(&tile, 4096);
        let [left, right] = [Some(7), Some(8)].map(|id| found.iter().find(|f| f.id == id));
        let (Some(left), Some(right)) = (left, right) else { continue };
        // A vertex of one polygon on the inner border is a vertex of the other.
        let shared = |f: &Feature, g: &Feature| {
            let points: Vec<_> = g.runs.concat();
            f.runs.concat().into_iter().filter(|p| points.contains(p)).count()
        };
        let count = shared(left, right);
        assert!(count >= 2, "{id}");
        kept.push((id, count, left.area() + right.area()));
    }
    // Coarse levels keep two points of it, fine ones more.
    assert_eq!(kept[0].1, 2);
    assert!(kept.iter().any(|(_, count, _)| *count > 10), "{kept:?}");
}

#[test]
fn what_lies_beyond_the_date_line_comes_from_the_other_side() {
    let folder = Folder::new();
    folder.write(
        "over.wkt",
        "POLYGON ((170 -10, 190 -10, 190 10, 170 10, 170 -10))\nPOINT (185 5)\n",
    );
    folder.must("tiles over.wkt --zoom 2 --buffer 0 -o map.pmtiles");
    let tiles = pmtiles(&folder.read("map.pmtiles"));
    let found: Vec<(u64, i64)> = tiles
        .iter()
        .map(|(id, tile)| (*id, decode(tile, 4096).iter().map(Feature::area).sum()))
        .collect();
    // The four tiles around the equator, on both sides, with a quarter each.
    assert_eq!(found.len(), 4);
    assert!(found.iter().all(|(_, area)| *area == found[0].1 && *area > 0), "{found:?}");
    let point = |tile: &(u64, Vec<u8>)| decode(&tile.1, 4096).iter().any(|f| f.kind == 1);
    assert_eq!(tiles.iter().filter(|tile| point(tile)).count(), 1);

    folder.write(
        "cross.wkt",
        "LINESTRING (170 5, -170 5)\nPOLYGON ((-180 -80, -90 -70, 0 -75, 90 -70, -180 -80))\n",
    );
    let long = folder.must("tiles cross.wkt --zoom 0 --buffer 0 -o long.pmtiles").err;
    let printed = "2 features (the first is feature 1) have edges of more than 180 degrees";
    assert!(long.contains(printed), "{long}");
    let ended = folder.must("tiles cross.wkt --zoom 0 --buffer 0 --short-way -o short.pmtiles");
    assert!(!ended.err.contains("180 degrees"), "{}", ended.err);
    assert!(ended.err.contains("feature 2 goes around a pole"), "{}", ended.err);
    let lines = |name: &str| {
        let tiles = pmtiles(&folder.read(name));
        decode(&tiles[0].1, 4096)
            .iter()
            .filter(|f| f.kind == 2)
            .map(|f| f.runs.len())
            .sum::<usize>()
    };
    assert_eq!((lines("long.pmtiles"), lines("short.pmtiles")), (1, 2));
}

#[test]
fn borders_are_straight_in_mercator_and_met_exactly() {
    let folder = Folder::new();
    folder.write("a.wkt", "POLYGON ((-170 -60, 160 -70, 100 80))\n");
    folder.must("tiles a.wkt --zoom 0-4 --tolerance 0 --buffer 0 -o map.pmtiles");
    let side = |zoom: u64| 4096.0 * (1 << zoom) as f64;
    let mut areas = [0.0; 5];
    for (id, tile) in pmtiles(&folder.read("map.pmtiles")) {
        let zoom = (0..5).rfind(|z| id >= ((1u64 << (2 * z)) - 1) / 3).unwrap();
        for feature in decode(&tile, 4096) {
            let inside = |v: i64| (0..=4096).contains(&v);
            assert!(feature.runs.concat().iter().all(|p| inside(p.0) && inside(p.1)));
            areas[zoom as usize] += feature.area() as f64 / side(zoom) / side(zoom);
        }
    }
    let all: f64 = areas.iter().sum();
    assert!(areas.iter().all(|area| (area - all / 5.0).abs() < 1e-3), "{areas:?}");
}

#[test]
fn tiny_polygons_are_joined_to_squares() {
    let folder = Folder::new();
    let boxes: Vec<String> = (0..4000)
        .map(|i| {
            let (x, y) = (f64::from(i % 100) * 0.01, f64::from(i / 100) * 0.01);
            format!(
                "POLYGON (({x} {y}, {} {y}, {} {}, {x} {}, {x} {y}))",
                x + 0.01,
                x + 0.01,
                y + 0.01,
                y + 0.01
            )
        })
        .collect();
    folder.write("a.wkt", boxes.join("\n"));
    folder.must("tiles a.wkt --zoom 0-5 -o map.pmtiles");
    let tiles = pmtiles(&folder.read("map.pmtiles"));
    let area = |tile: &[u8]| decode(tile, 4096).iter().map(Feature::area).sum::<i64>() as f64 * 0.5;
    let expected = 0.4 * (4096.0 / 360.0) * (4096.0 / 360.0);
    assert!(
        (area(&tiles[0].1) - expected).abs() < expected * 0.7,
        "{} {expected}",
        area(&tiles[0].1)
    );
    assert!(decode(&tiles[0].1, 4096).len() < 10);
}

#[test]
fn folders_have_a_file_per_tile() {
    let folder = land();
    folder.must("tiles parcels.geojsonl way.wkt --zoom 0-2 --layer land --select use -o tiles");
    let document: Value = serde_json::from_slice(&folder.read("tiles/tiles.json")).unwrap();
    assert_eq!(document["tiles"][0], "{z}/{x}/{y}.mvt");
    assert_eq!(document["vector_layers"][0]["fields"], serde_json::json!({ "use": "String" }));
    assert_eq!((&document["minzoom"], &document["maxzoom"]), (&0.into(), &2.into()));
    let found = decode(&folder.read("tiles/0/0/0.mvt"), 4096);
    assert!(found.iter().all(|f| f.layer == "land" && f.properties.len() < 2));
    folder.must(
        "tiles parcels.geojsonl --zoom 1 --extent 256 --buffer 4 --tiny 0 -o t/{z}/{x}/{y}.geojson",
    );
    let tile: Value = serde_json::from_slice(&folder.read("t/1/1/0.geojson")).unwrap();
    let feature = &tile["features"][0];
    assert_eq!(
        (&feature["layer"], &feature["properties"]["use"]),
        (&"parcels".into(), &"wood".into())
    );
    let corner = &feature["geometry"]["coordinates"][0][0];
    assert!((corner[0].as_f64().unwrap() - 10.0).abs() < 1.0, "{corner}");
    folder.must("tiles parcels.geojsonl --zoom 1 --extent 256 --buffer 4 --tiny 0 --to mvt -o u");
    assert!(!decode(&folder.read("u/1/1/0.mvt"), 256).is_empty());
}

#[test]
fn features_and_fields_are_chosen_as_by_other_commands() {
    let folder = land();
    let ended = folder.must(
        "tiles parcels.geojsonl --zoom 0 --where size>0 --select use,size --rename use=kind -o t --json",
    );
    let found = decode(&folder.read("t/0/0/0.mvt"), 4096);
    assert_eq!(found.len(), 1);
    let expected = [("kind".to_owned(), "wood".into()), ("size".to_owned(), 2.5.into())];
    assert_eq!(found[0].properties, expected);
    assert_eq!((&ended.json()["features"], &ended.json()["lost"]), (&3.into(), &0.into()));
    let document: Value = serde_json::from_slice(&folder.read("t/tiles.json")).unwrap();
    let fields = serde_json::json!({ "kind": "String", "size": "Number" });
    assert_eq!(document["vector_layers"][0]["fields"], fields);
    // Positions in the file count all features, including those left out.
    let ended = folder.must("tiles parcels.geojsonl --zoom 0 --where id=nine --select roof -o u");
    assert!(ended.err.contains("feature 3 has an id that is not"), "{}", ended.err);
    assert!(ended.err.contains("no feature has the field roof; there are"), "{}", ended.err);
    let ended =
        folder.must("tiles parcels.geojsonl way.wkt --zoom 0 --where use=wood --exclude size -o v");
    assert!(
        ended.err.contains("way.wkt: 2 features were read, and none meets --where"),
        "{}",
        ended.err
    );
    let found = decode(&folder.read("v/0/0/0.mvt"), 4096);
    assert_eq!((found.len(), found[0].properties.len()), (1, 2));
}

#[test]
fn databases_begin_as_those_of_sqlite() {
    let folder = land();
    folder.must("tiles parcels.geojsonl --zoom 0-3 -o map.mbtiles");
    let bytes = folder.read("map.mbtiles");
    assert_eq!(&bytes[..16], b"SQLite format 3\0");
    assert_eq!(&bytes[68..72], b"MPBX");
    assert_eq!(bytes.len() % 4096, 0);
}

#[test]
fn too_many_tiles_are_counted_and_not_made() {
    let folder = Folder::new();
    folder.write("world.wkt", "POLYGON ((-180 -89, 180 -89, 180 89, -180 89, -180 -89))\n");
    folder
        .run("tiles world.wkt --zoom 14 -o map.pmtiles")
        .fails(1, "there would be at least 268435456 tiles, more than the limit of 1000000");
    folder
        .run("clip world.wkt --tiles 14 -o d")
        .fails(1, "there would be at least 268435456 tiles");
    folder.run("clip world.wkt --tiles 14 -o d.geojsonl").fails(1, "at least 268435456 tiles");
    folder.run("clip world.wkt --tiles 3 --max-tiles 63 -o d").fails(1, "at least 64 tiles");
    assert_eq!(folder.names(), ["world.wkt"], "nothing is begun");
    let report = folder.must("clip world.wkt --tiles 3 -o d --json");
    assert!(report.err.contains("1 feature reaches beyond the latitudes"), "{}", report.err);
    assert_eq!(report.json()["tiles"], 64);
    // A slanted line meets few of the tiles in its bounding box.
    folder.write("line.wkt", "LINESTRING (-170 -80, 170 80)\n");
    let report =
        folder.must("tiles line.wkt --zoom 12 --max-tiles 12000 -o line.pmtiles --json").json();
    assert!(report["tiles"].as_u64().unwrap() < 12_000);
}

#[test]
fn each_layer_of_a_file_becomes_a_layer() {
    let folder = Folder::new();
    let object = |x: u32| format!(r#"{{"type":"Point","coordinates":[{x},2]}}"#);
    let objects = format!(r#""a":{},"b c":{}"#, object(1), object(5));
    folder.write("t.json", format!(r#"{{"type":"Topology","arcs":[],"objects":{{{objects}}}}}"#));
    let names = |options: &str| {
        let ended = folder.must(&format!("tiles t.json --zoom 0 {options} -o map.pmtiles"));
        assert_eq!(ended.err, "");
        let features = decode(&pmtiles(&folder.read("map.pmtiles"))[0].1, 4096);
        features.into_iter().map(|f| f.layer).collect::<Vec<_>>()
    };
    assert_eq!(names(""), ["a", "b c"]);
    assert_eq!(names("--layer all"), ["all", "all"]);
    let printed = folder.must("info t.json --json").json();
    assert_eq!(
        (&printed[0]["name"], &printed[1]["name"]),
        (&"a".into(), &"b c".into()),
        "{printed}"
    );
    assert_eq!(printed[0]["warnings"], serde_json::json!([]));
}

#[test]
fn levels_follow_from_the_data() {
    let folder = land();
    let ended = folder.must("tiles parcels.geojsonl -o map.pmtiles --json");
    let report = ended.json();
    // Vertices are some 5.6 km apart, and eight cells of level 3 are 9.8.
    assert_eq!(report["zoom_by"], "vertices");
    let levels = report["levels"].as_array().unwrap();
    assert_eq!(levels.len(), 5);
    let message =
        "map.pmtiles: zoom levels 0-4 are chosen: level 4 shows the distances between vertices";
    assert!(ended.err.contains(message), "{}", ended.err);
    assert_eq!(pmtiles(&folder.read("map.pmtiles")).len() as u64, report["tiles"]);
    // The tiles are those of the same levels by the option.
    let ended = folder.must("tiles parcels.geojsonl --zoom 0-4 -o same.pmtiles --name map");
    assert!(!ended.err.contains("chosen"), "{}", ended.err);
    assert_eq!(folder.read("map.pmtiles"), folder.read("same.pmtiles"));
    // The path and the trees are near the parcels.
    let report = folder.must("tiles parcels.geojsonl way.wkt -o near.pmtiles --json").json();
    assert_eq!(report["zoom_by"], "distances");
    assert!(!folder.must("tiles parcels.geojsonl -o q.pmtiles --quiet").err.contains("chosen"));
    // A million tiles would not show all detail of a world with small triangles.
    let triangle = |x: i32| {
        let (x, y) = (f64::from(x), f64::from(x % 7));
        format!("POLYGON (({x} {y}, {} {y}, {x} {}, {x} {y}))", x + 1e-7, y + 1e-7)
    };
    let world = "POLYGON ((-180 -80, 180 -80, 180 80, -180 80, -180 -80))";
    let rows: Vec<String> = (0..30).map(triangle).chain([world.to_owned()]).collect();
    folder.write("world.wkt", rows.join("\n"));
    let ended = folder.must("tiles world.wkt -o world.pmtiles --json --max-tiles 300");
    assert_eq!(ended.json()["zoom_by"], "tiles");
    let message =
        "zoom levels 0-3 are chosen: higher levels would show more detail, in more than 300";
    assert!(ended.err.contains(message), "{}", ended.err);
    folder.write("place.wkt", "POINT (7 47)");
    let report = folder.must("tiles place.wkt -o place.pmtiles --json").json();
    assert_eq!((&report["zoom_by"], &report["tiles"]), (&"place".into(), &15.into()));
}

#[test]
fn clipped_tiles_wrap_around_the_world() {
    let folder = Folder::new();
    folder.write("over.geojsonl", r#"{"type":"Feature","properties":null,"geometry":{"type":"Polygon","coordinates":[[[170,-10],[190,-10],[190,10],[170,10],[170,-10]]]}}
{"type":"Feature","properties":null,"geometry":{"type":"Point","coordinates":[185,5]}}
{"type":"Feature","properties":null,"geometry":{"type":"Polygon","coordinates":[[[-180,80],[180,80],[180,90],[-180,90],[-180,80]]]}}
{"type":"Feature","properties":null,"geometry":{"type":"Point","coordinates":[1e9,5]}}"#);
    let ended = folder.must("clip over.geojsonl --tiles 2 -o t.geojsonl --json");
    assert!(ended.err.contains("1 feature reaches beyond the latitudes"), "{}", ended.err);
    assert!(ended.err.contains("1 feature lies more than four worlds"), "{}", ended.err);
    let text = String::from_utf8(folder.read("t.geojsonl")).unwrap();
    assert_eq!(ended.json()["tiles"], 8);
    let point = text.lines().find(|line| line.contains("\"Point\"")).unwrap();
    assert!(point.contains("[-175,5]") && point.contains("\"tile\":\"2/0/1\""), "{point}");
    let wrapped = text.lines().find(|line| line.contains("\"tile\":\"2/0/2\"")).unwrap();
    assert!(wrapped.contains("[-180,-10]") && wrapped.contains("[-170,0]"), "{wrapped}");
}

#[test]
fn wrong_use_is_reported() {
    let folder = land();
    for (options, part) in [
        ("-o -", "tiles are many files"),
        ("-o a.geojson", "there is a file for each tile"),
        ("-o a/{z}/{y}.mvt", "tiles are named {z}/{x}/{y}.mvt"),
        ("-o a.pmtiles --to mvt", "different formats"),
        ("-o a.pmtiles --zoom 3-1", "the lower level comes first"),
        ("-o a.pmtiles --zoom 25", "0 to 24"),
        ("-o a.pmtiles --layer a --layer b", "2 names for 1 file;"),
        ("-o a.pmtiles --extent 16", "less than the extent"),
    ] {
        folder.run(&format!("tiles parcels.geojsonl {options}")).fails(2, part);
    }
    folder.write("a.svg", "<svg xmlns='http://www.w3.org/2000/svg'/>");
    folder.run("tiles a.svg -o a.pmtiles").fails(1, "an SVG has no places on the earth");
    folder.write("swapped.wkt", "POINT (5 95)\n");
    let ended = folder.must("tiles swapped.wkt --zoom 0 -o a.pmtiles");
    assert!(ended.err.contains("has latitudes beyond 90"), "{}", ended.err);
    assert!(ended.err.contains("there is no tile"), "{}", ended.err);
}
