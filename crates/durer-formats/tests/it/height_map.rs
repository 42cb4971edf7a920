//! Height maps: the meaning of real and generated files, and the errors for broken ones.

use durer_formats::height_map::{HeightMap, HeightMapOptions, read};
use proptest::prelude::*;
use std::io::Write;

fn map(bytes: &[u8], name: &str) -> HeightMap {
    read(bytes, name, &HeightMapOptions::default()).unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn error(bytes: &[u8]) -> String {
    read(bytes, "", &HeightMapOptions::default()).expect_err("broken").to_string()
}

fn rows(map: &HeightMap) -> Vec<Vec<Option<f64>>> {
    let f = &map.field;
    (0..f.rows()).map(|r| (0..f.columns()).map(|c| f.height(c, r)).collect()).collect()
}

/// Returns an NPY array with the numbers unchanged.
fn npy(kind: &str, fortran: bool, shape: &str, data: &[u8]) -> Vec<u8> {
    let order = if fortran { "True" } else { "False" };
    let header = format!("{{'descr': '{kind}', 'fortran_order': {order}, 'shape': {shape}, }}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(data);
    bytes
}

const TWO_ROWS: [[Option<f64>; 3]; 2] =
    [[Some(1.0), Some(2.0), Some(3.0)], [Some(4.0), None, Some(6.0)]];

#[test]
fn the_same_heights_in_every_format() {
    let floats: Vec<u8> =
        [1.0f32, 2.0, 3.0, 4.0, f32::NAN, 6.0].iter().flat_map(|v| v.to_be_bytes()).collect();
    let by_columns: Vec<u8> =
        [1.0f64, 4.0, 2.0, f64::NAN, 3.0, 6.0].iter().flat_map(|v| v.to_le_bytes()).collect();
    let esri =
        b"NCOLS 3\r\nnrows 2\r\nxllcenter 10\r\nyllcenter 20\r\ncellsize 2\r\nNODATA_value -1\r\n\
                 1 2 3\r\n4 -1 6\r\n";
    for (name, bytes) in [
        ("big-endian f4", npy(">f4", false, "(2, 3)", &floats)),
        ("f8 by columns", npy("<f8", true, "(2, 3)", &by_columns)),
        ("ESRI", esri.to_vec()),
        ("commas", b"1,2,3\n4,,6\n".to_vec()),
        ("semicolons and a heading", b"a;b;c\n1;2;3\n4;NA;6".to_vec()),
        ("blanks", b"# heights\n\n 1 2.0  3\r\n 4 nan 6 \r\n".to_vec()),
        ("JSON rows", b"[[1, 2, 3], [4, null, 6]]".to_vec()),
        (
            "JSON in one row",
            br#"{"width": 3, "height": 2, "values": [1, 2, 3, 4, null, 6]}"#.to_vec(),
        ),
    ] {
        assert_eq!(rows(&map(&bytes, "a.csv")), TWO_ROWS, "{name}");
    }
    let placed = map(esri, "x.asc");
    assert!(placed.on_map);
    assert_eq!((placed.field.x_range(), placed.field.z_range()), ([10.0, 14.0], [-22.0, -20.0]));
}

#[test]
fn points_x_y_z_are_put_on_a_grid() {
    // A grid in any order: y runs north, so the highest is the first row.
    for (name, text) in [
        ("a heading", "x,y,z\n0,10,1\n2,10,2\n4,10,3\n4,8,6\n0,8,4\n2,8,nan\n"),
        ("no heading", "0 8 4\n0 10 1\n2 8 nan\n2 10 2\n4 8 6\n4 10 3\n"),
        ("latitude first", "lat;lon;height\n10;0;1\n10;2;2\n10;4;3\n8;4;6\n8;0;4\n8;2;\n"),
    ] {
        let found = map(text.as_bytes(), "a.csv");
        assert_eq!(rows(&found), TWO_ROWS, "{name}");
        let field = &found.field;
        assert_eq!((field.x_range(), field.z_range()), ([0.0, 4.0], [-10.0, -8.0]), "{name}");
        assert!(found.on_map && found.warnings.is_empty(), "{name}: {:?}", found.warnings);
    }
    // Scattered points: a plane stays a plane, and cells outside the points are missing.
    let mut text = "x,y,z\n".to_owned();
    for i in 0..200 {
        let (x, y) = (f64::from(i % 20) + f64::from(i * 7 % 13) * 0.05, f64::from(i / 20));
        text += &format!("{x},{y},{}\n", 3.0 + 2.0 * x - y);
    }
    let found = map(text.as_bytes(), "a.csv");
    assert!(
        found.warnings[0].message.contains("200 points are put on a grid of 22 × 22"),
        "{found:?}"
    );
    let field = &found.field;
    let mut known = 0;
    for row in 0..field.rows() {
        for column in 0..field.columns() {
            let Some(p) = field.point(column, row) else { continue };
            known += 1;
            assert!((p.y - (3.0 + 2.0 * p.x + p.z)).abs() < 1e-9, "{p}");
        }
    }
    assert!(known > 400, "{known}");
    let line = error(b"x,y,z\n0,0,1\n1,1,2\n2,2,3\n");
    assert!(line.contains("three points x, y, z at least that are not on one line"), "{line}");
}

#[test]
fn coordinates_stand_in_the_first_row_and_column() {
    for text in [",0,2,4\n10,1,2,3\n8,4,,6\n", "y\\x;4;2;0\n8;6;NA;4\n10;3;2;1\n"] {
        let found = map(text.as_bytes(), "a.csv");
        assert_eq!(rows(&found), TWO_ROWS, "{text}");
        assert_eq!(found.field.x_range(), [0.0, 4.0]);
        assert_eq!(found.field.z_range(), [-10.0, -8.0]);
    }
    // Uneven spacings become even.
    let found = map(b",0,1,4\n0,0,10,40\n1,0,10,40\n2,0,10,40\n", "a.csv");
    assert!(found.warnings[0].message.contains("not evenly spaced"), "{:?}", found.warnings);
    assert_eq!(rows(&found)[0], [Some(0.0), Some(20.0), Some(40.0)]);
}

#[test]
fn tables_that_may_be_meant_otherwise_are_reported() {
    let long: String = (0..20).map(|i| format!("{i},{},{}\n", i * i, i % 3)).collect();
    let found = map(long.as_bytes(), "a.csv");
    assert!(found.warnings[0].message.contains("points x, y, z need a heading"), "{found:?}");
    assert!(error(b"5\n").contains("one height is not a surface"));
}

#[test]
fn whole_numbers_of_every_width_are_read() {
    for (kind, data, expected) in [
        ("|i1", vec![0xff, 2], [-1.0, 2.0]),
        ("|u1", vec![0xff, 2], [255.0, 2.0]),
        ("<i2", vec![0xfe, 0xff, 1, 0], [-2.0, 1.0]),
        (">u2", vec![1, 0, 0, 1], [256.0, 1.0]),
        ("<i4", vec![0xff, 0xff, 0xff, 0xff, 7, 0, 0, 0], [-1.0, 7.0]),
        ("<u8", vec![1, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0], [1.0, 256.0]),
    ] {
        let found = rows(&map(&npy(kind, false, "(1, 2)", &data), kind));
        assert_eq!(found, [expected.map(Some)], "{kind}");
    }
}

#[test]
fn archives_say_where_they_lie() {
    let scalar = |v: f64| npy("<f8", false, "()", &v.to_le_bytes());
    let mut archive = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    let options = zip::write::SimpleFileOptions::default();
    let heights = npy("|u1", false, "(2, 2)", &[1, 2, 3, 4]);
    for (name, bytes) in [
        ("elevation.npy", heights),
        ("xmin.npy", scalar(5.0)),
        ("xmax.npy", scalar(6.0)),
        ("ymin.npy", scalar(-1.0)),
        ("ymax.npy", scalar(1.0)),
    ] {
        archive.start_file(name, options).expect("entry");
        archive.write_all(&bytes).expect("bytes");
    }
    let bytes = archive.finish().expect("archive").into_inner();
    let found = map(&bytes, "a.npz");
    assert!(found.on_map);
    assert_eq!((found.field.x_range(), found.field.z_range()), ([5.0, 6.0], [-1.0, 1.0]));
    assert_eq!(rows(&found), [[Some(1.0), Some(2.0)], [Some(3.0), Some(4.0)]]);
    let named = |name: &str| {
        let options = HeightMapOptions { array: Some(name.to_owned()), ..Default::default() };
        read(&bytes, "a.npz", &options).map(|m| m.format).map_err(|e| e.to_string())
    };
    assert_eq!(named("elevation").as_deref(), Ok("NPZ, u1"));
    assert!(named("other").is_err_and(|e| e.contains("there are elevation, xmax")));
    assert!(named("xmin").is_err_and(|e| e.contains("two dimensions")));
}

#[test]
fn grey_pictures_are_heights() {
    let png = |color, depth, data: &[u8]| {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 2, 1);
        encoder.set_color(color);
        encoder.set_depth(depth);
        let mut writer = encoder.write_header().expect("header");
        writer.write_image_data(data).expect("data");
        writer.finish().expect("end");
        bytes
    };
    use png::{BitDepth::*, ColorType::*};
    for (bytes, expected) in [
        (png(Grayscale, Eight, &[7, 255]), [Some(7.0), Some(255.0)]),
        (png(Grayscale, Sixteen, &[1, 0, 255, 255]), [Some(256.0), Some(65535.0)]),
        (png(GrayscaleAlpha, Eight, &[7, 0, 9, 255]), [None, Some(9.0)]),
        (png(Rgb, Eight, &[4, 4, 4, 5, 5, 5]), [Some(4.0), Some(5.0)]),
    ] {
        assert_eq!(rows(&map(&bytes, "a.png")), [expected]);
    }
    assert!(error(&png(Rgb, Eight, &[4, 4, 5, 5, 5, 5])).contains("use a grey picture"));
}

#[test]
fn broken_files_are_reported_where_and_what() {
    for (bytes, expected) in [
        (&b""[..], "the file is empty"),
        (b"hello", "height maps are read from"),
        (b"ncols 2\nnrows 2\n1 2\n3 x\n", "line 4, column 3: `x` is not a number"),
        (b"ncols 2\nnrows 2\n1 2 3 4 5\n", "line 3, column 9: `5` follows the last"),
        (b"ncols 2\nnrows 2\n10 20 30\n", "ends after 3 of 4"),
        (b"ncols 2\n1 2 3 4\n", "`nrows` is missing"),
        (b"ncols 0\nnrows 2\n", "line 1, column 1: `ncols` needs a whole number"),
        (b"ncols 2\nrows 2\n", "to be a key of the format"),
        (b"ncols 100000\nnrows 100000\n1 2", "above the limit"),
        (b"ncols 10000\nnrows 10000\n1 2", "too short for 10000 columns"),
        (b"1 2\n3\n", "line 2: 1 number; the rows before have 2"),
        (b"1,2\n3,4,5\n", "line 2: 3 numbers"),
        (b"1,2\n3,no\n", "line 2, column 3: `no` is not a number"),
        (b"[[1, 2], [3]]", "[1]: 1 number; the first row has 2"),
        (b"[[1, 2], [3, true]]", "[1][1]: a number or null"),
        (b"[1, 2", "line 1, column 5"),
        (br#"{"values": [1, 2]}"#, "need `width` beside them"),
        (br#"{"width": 3, "height": 1, "values": [1, 2]}"#, "2 numbers; 3 × 1 are needed"),
        (br#"{"width": -3, "height": 1, "values": [1, 2]}"#, "width: a whole number"),
        (b"\x93NUMPY\x01\0\xff\xff", "ends in its header"),
        (b"\x93NUMPY\x09\0\x01\0", "version 9 of NPY is not supported"),
        (b"PK\x03\x04 no archive", "ZIP archive is broken"),
        (b"\x89PNG\r\n\x1a\n rubbish", ""),
    ] {
        let found = error(bytes);
        assert!(found.contains(expected), "{:?}: {found}", String::from_utf8_lossy(bytes));
    }
    assert!(error(&npy("<f8", false, "(2, 2)", &[0; 31])).contains("32 bytes; there are 31"));
    assert!(error(&npy("<c8", false, "(2, 2)", &[0; 64])).contains("type `<c8`"));
    assert!(error(&npy("<f8", false, "(4,)", &[0; 64])).contains("two dimensions"));
    assert!(error(&npy("<f8", false, "(99999999999, 99999999999)", &[])).contains("limit"));
}

proptest! {
    #[test]
    fn no_bytes_make_a_reader_panic(
        start in 0..6usize,
        bytes in proptest::collection::vec(any::<u8>(), 0..120),
    ) {
        let starts: [&[u8]; 6] = [
            b"", b"ncols 2\nnrows 2\ncellsize ", b"[[1, 2], [", b"\x93NUMPY\x01\0\x20\0{'descr': '<f8', 'shape': (",
            b"1,2,3\n", b"PK\x03\x04",
        ];
        let bytes = [starts[start], &bytes].concat();
        let _ = read(&bytes, "a.csv", &HeightMapOptions::default());
    }

    #[test]
    fn no_formula_makes_the_parser_panic(text in "[xzr0-9.e+*/^%(), -]{0,40}|\\PC{0,20}") {
        if let Ok(formula) = durer_formats::formula::Formula::parse(&text) {
            formula.evaluate(1.5, -2.0);
        }
    }
}
