//! `durer fill`: seed fills on pictures.

use crate::harness::{Folder, Picture};

/// A white 8 × 8 picture with a black cross, white in its middle, one field of it
/// with a pixel that is a little darker.
fn folder() -> Folder {
    let folder = Folder::new();
    folder.write(
        "a.svg",
        r##"<svg xmlns="http://www.w3.org/2000/svg" width="8" height="8">
<rect width="8" height="8" fill="#fff"/><rect x="4" width="1" height="8"/>
<rect y="4" width="8" height="1"/><rect x="4" y="4" width="1" height="1" fill="#fff"/>
<rect x="6" y="6" width="1" height="1" fill="#f0f0f0"/></svg>"##,
    );
    folder.must("draw a.svg -o a.png");
    folder
}

fn pixels(folder: &Folder, arguments: &str) -> Vec<u64> {
    let report = folder.must(&format!("fill a.png -o b.png --json {arguments}")).json();
    let fills = report["fills"].as_array().unwrap();
    fills.iter().map(|f| f["pixels"].as_u64().unwrap()).collect()
}

#[test]
fn a_fill_stays_within_what_is_alike() {
    let folder = folder();
    assert_eq!(pixels(&folder, "--at 0,0 --color #00f"), [16]);
    let found = Picture::decode(&folder.read("b.png"));
    assert_eq!((found.pixel(3, 3), found.pixel(4, 4)), (&[0, 0, 255][..], &[255, 255, 255][..]));
    // Through the corners all four fields and the middle are one; one pixel is a little darker.
    assert_eq!(pixels(&folder, "--at 0,0 --color #00f --connectivity 8"), [16 + 12 + 12 + 8 + 1]);
}

#[test]
fn tolerance_boundary_and_several_seeds() {
    let folder = folder();
    assert_eq!(pixels(&folder, "--at 7.9,7.9 --color lime"), [8]);
    assert_eq!(pixels(&folder, "--at 7.9,7.9 --color lime --tolerance 15"), [9]);
    assert_eq!(pixels(&folder, "--at 7,7 --color lime --boundary black"), [9]);
    // Black is like the boundary that is asked for only within the tolerance.
    let nearly = "--at 7,7 --color lime --boundary #0f0f0f --tolerance";
    assert_eq!(pixels(&folder, &format!("{nearly} 15")), [9]);
    assert_eq!(pixels(&folder, &format!("{nearly} 14")), [64]);
    assert_eq!(pixels(&folder, "--at 0,0 --at 7,0 --color #0000"), [16, 12]);
    assert_eq!(Picture::decode(&folder.read("b.png")).pixel(0, 0), [0, 0, 0, 0]);
    for algorithm in ["naive", "spans"] {
        let all = "--at 0,0 --color red --connectivity 8 --tolerance 15";
        assert_eq!(pixels(&folder, &format!("{all} --algorithm {algorithm}")), [50]);
    }
}

#[test]
fn pictures_stand_as_viewers_show_them_and_lost_bits_are_told() {
    let folder = Folder::new();
    let png = |depth: png::BitDepth, exif: Option<Vec<u8>>, data: &[u8]| {
        let mut info = png::Info::with_size(3, 1);
        (info.color_type, info.bit_depth) = (png::ColorType::Grayscale, depth);
        info.exif_metadata = exif.map(Into::into);
        let mut bytes = Vec::new();
        let mut writer = png::Encoder::with_info(&mut bytes, info).unwrap().write_header().unwrap();
        writer.write_image_data(data).unwrap();
        writer.finish().unwrap();
        bytes
    };
    // One entry: the orientation, "to be turned by a quarter to the right".
    let exif = b"MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0".to_vec();
    folder.write("a.png", png(png::BitDepth::Eight, Some(exif), &[10, 20, 30]));
    let told = folder.must("fill a.png -o b.png --at 0,2 --color red").err;
    let turned = Picture::decode(&folder.read("b.png"));
    assert_eq!((turned.width, turned.height), (1, 3));
    assert_eq!([0, 1, 2].map(|y| turned.pixel(0, y)[0]), [10, 20, 255]);
    assert_eq!(told, "");
    folder.write("c.png", png(png::BitDepth::Sixteen, None, &[0, 9, 1, 0, 2, 0]));
    let told = folder.must("fill c.png -o d.png --at 0,0 --color red").err;
    assert!(told.contains("its 16 bits per channel are rounded to 8"), "{told}");
}

#[test]
fn wrong_use_is_told() {
    let folder = folder();
    folder.write("no.png", "not a picture");
    for (arguments, code, part) in [
        ("fill a.png -o b.png --at 8,0 --color red", 2, "--at 8,0: outside the image of 8x8"),
        ("fill a.png -o b.png --at -1,0 --color red", 2, "outside the image"),
        ("fill a.png -o b.png --color red", 2, "--at"),
        ("fill a.png -o b.png --at 1,1 --color reddish", 2, "a colour is"),
        ("fill a.png -o b.png --at 1,1 --color red --tolerance 256", 2, "256"),
        ("fill no.png -o b.png --at 1,1 --color red", 1, "neither PNG nor JPEG"),
        ("fill none.png -o b.png --at 1,1 --color red", 1, "none.png"),
    ] {
        folder.run(arguments).fails(code, part);
    }
    assert!(!folder.path("b.png").exists());
}
