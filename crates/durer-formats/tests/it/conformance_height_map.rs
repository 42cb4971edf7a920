//! Real height maps.

use crate::shared;
use durer_formats::height_map::{HeightMap, HeightMapOptions, read};

fn height_map(name: &str) -> Option<HeightMap> {
    let path = shared::data()?.join("heightfields").join(name);
    let bytes = std::fs::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    Some(read(&bytes, name, &HeightMapOptions::default()).unwrap_or_else(|e| panic!("{name}: {e}")))
}

#[test]
fn the_volcano_has_its_height() {
    let Some(map) = height_map("volcano.json") else { return };
    assert_eq!((map.field.columns(), map.field.rows()), (87, 61));
    assert_eq!((map.field.range(), map.field.missing()), (Some([94.0, 195.0]), 0));
    assert_eq!(map.field.height(3, 0), Some(105.0));
}

#[test]
fn one_terrain_in_two_formats_is_one() {
    let (Some(text), Some(array)) =
        (height_map("jacksboro_fault_dem.asc"), height_map("jacksboro_fault_dem.npz"))
    else {
        return;
    };
    assert_eq!((text.field.columns(), text.field.rows()), (403, 344));
    assert_eq!(text.field.range(), Some([236.0, 1076.0]));
    assert!(text.on_map && array.on_map);
    for row in 0..344 {
        for column in 0..403 {
            assert_eq!(text.field.height(column, row), array.field.height(column, row));
        }
    }
    // The text format gives the positions of cells, the array format their outermost borders.
    for (a, b) in text.field.x_range().into_iter().zip(array.field.x_range()) {
        assert!((a - b).abs() < 0.001, "{a} {b}");
    }
}
