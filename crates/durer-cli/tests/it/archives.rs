//! Models and map data in ZIP archives.

use crate::harness::Folder;
use std::io::{Cursor, Write};
use zip::write::{SimpleFileOptions, ZipWriter};

/// Writes an archive of these files, which are not compressed.
fn pack(folder: &Folder, archive: &str, files: &[(&str, &[u8])]) {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    let stored = SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
    for (name, bytes) in files {
        writer.start_file(*name, stored).expect("memory");
        writer.write_all(bytes).expect("memory");
    }
    folder.write(archive, writer.finish().expect("memory").into_inner());
}

const KML: &str = r#"<?xml version="1.0"?><kml xmlns="http://www.opengis.net/kml/2.2"><Placemark><name>Bern</name>
    <Point><coordinates>7.44,46.95</coordinates></Point></Placemark></kml>"#;

#[test]
fn map_data_in_archives_are_read_with_the_files_beside_them() {
    let folder = Folder::new();
    folder.write(
        "areas.geojson",
        r#"{"type":"Feature","properties":{"n":"Ä"},"geometry":{"type":"Point","coordinates":[2,1]}}"#,
    );
    folder.must("clip areas.geojson -o a.shp");
    let part = |suffix: &str| folder.read(&format!("a.{suffix}"));
    let (shp, dbf, prj, cpg) = (part("shp"), part("dbf"), part("prj"), part("cpg"));
    let whole: [(&str, &[u8]); 5] = [
        ("README.txt", b"read me"),
        ("x/a.shp", &shp),
        ("x/a.dbf", &dbf),
        ("x/a.prj", &prj),
        ("x/a.cpg", &cpg),
    ];
    pack(&folder, "shp.zip", &whole);
    let clip = "clip shp.zip --window 0,0,9,9 -o o.geojson";
    folder.must(clip);
    let plain = "clip a.shp --window 0,0,9,9 -o p.geojson";
    folder.must(plain);
    assert_eq!(folder.read("o.geojson"), folder.read("p.geojson"));
    assert!(String::from_utf8_lossy(&folder.read("o.geojson")).contains("Ä"), "fields are read");
    let printed = folder.must("info shp.zip --json").json();
    assert_eq!(
        (&printed["format"], &printed["features"]),
        (&"shapefile".into(), &1.into()),
        "{printed}"
    );
    folder.must("draw shp.zip --label n -o o.png --size 64x64");
    folder.must("draw a.shp --label n -o p.png --size 64x64");
    assert_eq!(folder.read("o.png"), folder.read("p.png"));

    pack(&folder, "bern.kmz", &[("doc.kml", KML.as_bytes()), ("files/a.png", b"")]);
    folder.must("clip bern.kmz --window 7,46,8,47 -o o.wkt");
    assert_eq!(folder.read("o.wkt"), b"SRID=4326;POINT (7.44 46.95)\n");

    pack(&folder, "two.zip", &[("b.kml", KML.as_bytes()), ("a.shp", &shp)]);
    let several = "two.zip: a ZIP archive with 2 files of map data (b.kml, a.shp) is not supported";
    folder.run("clip two.zip --window 0,0,9,9 -o o.wkt").fails(1, several);
    folder.must("clip two.zip --layer b --window 0,0,90,90 -o o.wkt");
    assert_eq!(folder.read("o.wkt"), b"SRID=4326;POINT (7.44 46.95)\n");
    folder.run("draw two.zip -o o.png").fails(1, several);
    folder.run("draw two.zip -o o.png").fails(1, "unpack it, or name one with --layer");
    let printed = folder.must("draw two.zip --layer b two.zip --layer a -o o.png --json").json();
    let format = |i: usize| printed["layers"][i]["format"].clone();
    assert_eq!((format(0), format(1)), ("kml".into(), "shapefile".into()), "{printed}");
    let printed = folder.must("info two.zip --json").json();
    assert_eq!(
        (&printed[0]["name"], &printed[1]["name"]),
        (&"b.kml".into(), &"a.shp".into()),
        "{printed}"
    );
    let printed = folder.must("info two.zip --layer b --json").json();
    assert_eq!((&printed["format"], &printed["features"]), (&"kml".into(), &1.into()));
    pack(&folder, "none.zip", &[("a.txt", b"")]);
    folder
        .run("clip none.zip --window 0,0,9,9 -o o.wkt")
        .fails(1, "none.zip: not a known format: the ZIP archive holds no files of map data");
    pack(&folder, "broken.zip", &[("broken.geojson", b"{")]);
    folder.run("clip broken.zip --window 0,0,9,9 -o o.wkt").fails(1, "broken.zip: ");
}

/// A TopoJSON with layers of a point each.
fn layers(names: &[&str]) -> String {
    let object = |name: &&str| format!(r#""{name}":{{"type":"Point","coordinates":[1,2]}}"#);
    let objects: Vec<String> = names.iter().map(object).collect();
    format!(r#"{{"type":"Topology","arcs":[],"objects":{{{}}}}}"#, objects.join(","))
}

#[test]
fn layers_of_files_in_archives_are_chosen_and_become_layers_of_tiles() {
    let folder = Folder::new();
    let topology = layers(&["roads", "rivers"]);
    let files = [("x/b.kml", KML.as_bytes()), ("x/t.topojson", topology.as_bytes())];
    pack(&folder, "two.zip", &files);
    pack(&folder, "one.zip", &files[1..]);
    for (archive, expected) in
        [("two.zip", &["b", "rivers", "roads"][..]), ("one.zip", &["rivers", "roads"])]
    {
        folder.must(&format!("tiles {archive} --zoom 0 -o t --to geojson"));
        let metadata: serde_json::Value =
            serde_json::from_slice(&folder.read("t/tiles.json")).expect("JSON");
        let layers = metadata["vector_layers"].as_array().expect("layers");
        let mut names: Vec<&str> = layers.iter().filter_map(|l| l["id"].as_str()).collect();
        names.sort_unstable();
        assert_eq!(names, expected, "{archive}");
    }
    let clip = "--window 0,0,9,9 -o o.wkt";
    for choice in ["t/roads", "t.topojson/roads", "x/t/roads", "x/t.topojson/roads"] {
        folder.must(&format!("clip two.zip --layer {choice} {clip}"));
        assert_eq!(folder.read("o.wkt"), b"POINT (1 2)\n", "{choice}");
        folder.must(&format!("draw two.zip --layer {choice} -o o.png --size 9x9"));
        let printed = folder.must(&format!("info two.zip --layer {choice} --json")).json();
        assert_eq!(printed["features"], 1, "{choice}");
    }
    for command in ["fix", "check", "buffer --distance 1", "dissolve"] {
        let out = if command == "check" { "" } else { "-o o.geojson" };
        let ended = folder.must(&format!("{command} two.zip --layer t/roads {out}"));
        assert!(!ended.err.contains("become one"), "{command}: {}", ended.err);
        let ended = folder.run(&format!("{command} one.zip {out}"));
        assert!(ended.err.contains("its 2 layers, roads, rivers, become one"), "{}", ended.err);
    }
    folder.run(&format!("clip two.zip --layer t/lakes {clip}")).fails(1, "there is no layer lakes");
    folder.run(&format!("clip two.zip --layer u/roads {clip}")).fails(1, "name one with --layer");
}

#[test]
fn models_in_archives_are_read_with_the_files_beside_them() {
    let folder = Folder::new();
    let obj = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n";
    let mtl = "newmtl red\nKd 1 0 0\n";
    folder.write("a.obj", obj);
    folder.write("a.mtl", mtl);
    let read = ("README.TXT", &b"1 2 3"[..]);
    pack(&folder, "a.zip", &[read, ("x/a.obj", obj.as_bytes()), ("x/a.mtl", mtl.as_bytes())]);
    let printed = folder.must("render a.zip -o o.png --size 32x32");
    assert_eq!(printed.err, "");
    folder.must("render a.obj -o p.png --size 32x32");
    assert_eq!(folder.read("o.png"), folder.read("p.png"));
    let printed = folder.must("info a.zip --json").json();
    assert_eq!((&printed["format"], &printed["triangles"]), (&"OBJ".into(), &1.into()));

    pack(&folder, "two.zip", &[("a.obj", obj.as_bytes()), ("b.stl", b"solid b\nendsolid b\n")]);
    folder.run("render two.zip -o o.png").fails(1, "a ZIP archive with 2 models (a.obj, b.stl)");
    pack(&folder, "none.zip", &[read]);
    folder.run("render none.zip -o o.png").fails(1, "the ZIP archive holds no models");
    pack(&folder, "bad.zip", &[("x/a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")]);
    folder
        .run("render bad.zip -o o.png")
        .fails(1, "bad.zip: x/a.obj, line 4, column 7: vertex 9 does not exist");
}
