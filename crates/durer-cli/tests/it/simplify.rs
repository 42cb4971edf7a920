//! `durer simplify`.

use crate::harness::Folder;

/// Two parcels with a slightly crooked border, and a hole with its filling.
fn folder() -> Folder {
    let folder = Folder::new();
    folder.write(
        "parcels.wkt",
        "POLYGON Z ((0 0 1, 4 0 2, 4.1 2 3, 4 4 4, 0 4 5, 0 0 1))\n\
         POLYGON ((4 0, 8 0, 8 4, 4 4, 4.1 2, 4 0), (5 1, 6 1, 6.1 1.5, 6 2, 5 2, 5 1))\n\
         POLYGON ((5 1, 6 1, 6.1 1.5, 6 2, 5 2, 5 1))\n\
         LINESTRING (0 9, 3 9.05, 6 9)\n",
    );
    folder
}

fn text(folder: &Folder, name: &str) -> String {
    String::from_utf8(folder.read(name)).unwrap()
}

#[test]
fn borders_stay_shared() {
    for method in ["visvalingam", "douglas-peucker"] {
        let folder = folder();
        let line =
            format!("simplify parcels.wkt --tolerance 0.5 --method {method} -o a.wkt --json");
        let report = folder.must(&line).json();
        assert_eq!(
            text(&folder, "a.wkt"),
            "POLYGON Z ((0 0 1, 4 0 2, 4 4 4, 0 4 5, 0 0 1))\n\
             POLYGON ((4 0, 8 0, 8 4, 4 4, 4 0), (5 1, 6 1, 6 2, 5 2, 5 1))\n\
             POLYGON ((5 1, 6 1, 6 2, 5 2, 5 1))\n\
             LINESTRING (0 9, 6 9)\n",
            "{method}"
        );
        assert_eq!(
            (&report["in"]["vertices"], &report["out"]["vertices"]),
            (&23.into(), &18.into())
        );
        folder.must("simplify a.wkt --keep 100% -o b.wkt");
        assert_eq!(folder.read("a.wkt"), folder.read("b.wkt"));
    }
}

#[test]
fn shares_streams_and_drops() {
    let folder = folder();
    folder.must("simplify parcels.wkt --keep 0% -o none.wkt");
    let none = text(&folder, "none.wkt");
    assert!(none.lines().next().is_some_and(|line| line.matches(',').count() == 3), "{none}");
    assert!(none.ends_with("LINESTRING (0 9, 6 9)\n"), "{none}");
    let ended =
        folder.must("simplify parcels.wkt --tolerance 0.5 --drop-below 2 -o big.wkt --json");
    assert!(ended.err.contains("1 feature has nothing left"), "{}", ended.err);
    assert_eq!(ended.json()["dropped"]["small_rings"], 2);
    assert!(!text(&folder, "big.wkt").contains("5 1"));
    folder.must("simplify parcels.wkt --each --tolerance 0.5 -o each.wkt");
    folder.must("simplify parcels.wkt --tolerance 0.5 -o all.wkt");
    folder.must("simplify parcels.wkt --where a=1 --tolerance 0.5 -o chosen.wkt");
    assert_eq!(text(&folder, "chosen.wkt"), "");
    assert_eq!(folder.read("each.wkt"), folder.read("all.wkt"));
    folder.write("empty.wkt", "");
    let ended = folder.must("simplify empty.wkt --from wkt --keep 5 -o empty.geojson");
    assert!(ended.err.contains("there is no feature in it"), "{}", ended.err);
    assert!(text(&folder, "empty.geojson").contains("FeatureCollection"));
}

#[test]
fn what_is_no_ring_is_reported() {
    let folder = Folder::new();
    folder.write(
        "a.wkt",
        "MULTIPOLYGON (((0 0, 1 0, 0 0, 0 0)), ((2 0, 3 0, 2 1, 2 0), (5 5, 5 5, 5 5, 5 5)))\n\
         LINESTRING (7 7, 7 7)\nPOLYGON EMPTY\n",
    );
    let ended = folder.must("simplify a.wkt --tolerance 0.1 -o b.wkt --json");
    assert!(ended.err.contains("3 rings of fewer than three different points"), "{}", ended.err);
    assert!(ended.err.contains("1 feature has nothing left"), "{}", ended.err);
    let text = text(&folder, "b.wkt");
    assert_eq!(text, "MULTIPOLYGON (((2 0, 3 0, 2 1, 2 0)))\nPOLYGON EMPTY\n");
}

#[test]
fn wrong_use_is_reported() {
    let folder = folder();
    for (options, part) in [
        ("-o a.wkt", "--tolerance"),
        ("--keep 10% --tolerance 1 -o a.wkt", "cannot be used with"),
        ("--keep 101% -o a.wkt", "at most 100%"),
        ("--tolerance -1 -o a.wkt", "--tolerance"),
        ("--keep 10% --method clever -o a.wkt", "clever"),
        ("--keep 10% -o a.what", "the suffix does not name a format"),
        ("--keep 10% -o - --json", "--json"),
    ] {
        folder.run(&format!("simplify parcels.wkt {options}")).fails(2, part);
    }
}
