//! `durer fill`: seed fills on pictures.

use crate::harness::{Folder, Picture};

/// Returns a white 8 × 8 picture with a black cross whose middle is white; one pixel of one quadrant is a little
/// darker.
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
    // Through diagonal neighbours all four quadrants and the middle are connected; one pixel is a little darker.
    assert_eq!(pixels(&folder, "--at 0,0 --color #00f --connectivity 8"), [16 + 12 + 12 + 8 + 1]);
}

#[test]
fn tolerance_boundary_and_several_seeds() {
    let folder = folder();
    assert_eq!(pixels(&folder, "--at 7.9,7.9 --color lime"), [8]);
    assert_eq!(pixels(&folder, "--at 7.9,7.9 --color lime --tolerance 15"), [9]);
    assert_eq!(pixels(&folder, "--at 7,7 --color lime --boundary black"), [9]);
    // Black equals the given boundary colour only within the tolerance.
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
fn wholly_transparent_pixels_are_one_colour() {
    let folder = Folder::new();
    let colors = [[255, 0, 0, 0], [0, 0, 255, 0], [9, 9, 9, 0], [9, 9, 9, 1], [0, 0, 0, 0]];
    let (rgba, eight) = (png::ColorType::Rgba, png::BitDepth::Eight);
    folder.write("a.png", row(rgba, eight, None, &colors.concat(), 5));
    assert_eq!(pixels(&folder, "--at 0,0 --color red"), [3]);
    let found = Picture::decode(&folder.read("b.png"));
    assert_eq!((found.pixel(2, 0), found.pixel(3, 0)), (&[255, 0, 0, 255][..], &[9, 9, 9, 1][..]));
    assert_eq!(pixels(&folder, "--at 4,0 --color red --tolerance 9"), [5]);
}

/// Returns a PNG of one row.
fn row(
    color: png::ColorType,
    depth: png::BitDepth,
    exif: Option<Vec<u8>>,
    data: &[u8],
    width: u32,
) -> Vec<u8> {
    let mut info = png::Info::with_size(width, 1);
    (info.color_type, info.bit_depth) = (color, depth);
    info.exif_metadata = exif.map(Into::into);
    let mut bytes = Vec::new();
    let mut writer = png::Encoder::with_info(&mut bytes, info).unwrap().write_header().unwrap();
    writer.write_image_data(data).unwrap();
    writer.finish().unwrap();
    bytes
}

#[test]
fn pictures_stand_as_viewers_show_them() {
    let folder = Folder::new();
    // One entry: the orientation, "to be turned by a quarter to the right".
    let exif = b"MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0".to_vec();
    for (depth, data) in [
        (png::BitDepth::Eight, &[10, 20, 30][..]),
        (png::BitDepth::Sixteen, &[10, 1, 20, 2, 30, 3][..]),
    ] {
        let turned = row(png::ColorType::Grayscale, depth, Some(exif.clone()), data, 3);
        folder.write("a.png", turned);
        let printed = folder.must("fill a.png -o b.png --at 0,2 --color red").err;
        let turned = Picture::decode(&folder.read("b.png"));
        assert_eq!((turned.width, turned.height), (1, 3));
        assert_eq!([0, 1, 2].map(|y| turned.pixel(0, y)[0]), [10, 20, 255]);
        assert_eq!(printed, "");
    }
}

/// Fills from the first pixel of a row with 16 bits per channel, given pixel by pixel.
fn deep<const N: usize>(
    folder: &Folder,
    color: png::ColorType,
    pixels: &[[u16; N]],
    how: &str,
) -> (png::ColorType, Vec<Vec<u16>>) {
    let data: Vec<u8> = pixels.as_flattened().iter().flat_map(|s| s.to_be_bytes()).collect();
    let width = pixels.len() as u32;
    folder.write("deep.png", row(color, png::BitDepth::Sixteen, None, &data, width));
    let printed = folder.must(&format!("fill deep.png -o filled.png --at 0,0 {how}")).err;
    assert_eq!(printed, "");
    let bytes = folder.read("filled.png");
    let reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
    let (color, depth) = reader.output_color_type();
    assert_eq!(depth, png::BitDepth::Sixteen, "{color:?}");
    let samples = |p: &[u8]| p.chunks_exact(2).map(|s| u16::from_be_bytes([s[0], s[1]])).collect();
    (color, Picture::decode(&bytes).pixels().map(samples).collect())
}

#[test]
fn sixteen_bits_stay_sixteen_bits() {
    use png::ColorType::{Grayscale, GrayscaleAlpha, Rgb, Rgba};
    let folder = Folder::new();
    // In 8 bits the first three pixels are equal.
    let grey = [[0x1000], [0x1001], [0x1002], [0xfffe]];
    let opaque = grey.map(|[g]| [g, 0xffff]);
    let pale = grey.map(|[g]| [g, 0x8001]);
    let rgb = grey.map(|[g]| [0x1234, g, 0xabcd]);
    let rgba = grey.map(|[g]| [0x1234, 0xabcd, 0x4321, g]);
    /// Returns the pixels with another value for the first.
    fn with<const N: usize>(first: [u16; N], pixels: &[[u16; N]]) -> Vec<Vec<u16>> {
        std::iter::once(&first).chain(&pixels[1..]).map(|p| p.to_vec()).collect()
    }
    let half = "--color #808080";
    let found = deep(&folder, Grayscale, &grey, half);
    assert_eq!(found, (Grayscale, with([0x8080], &grey)));
    let found = deep(&folder, GrayscaleAlpha, &pale, half);
    assert_eq!(found, (GrayscaleAlpha, with([0x8080, 0xffff], &pale)));
    let found = deep(&folder, Rgb, &rgb, half);
    assert_eq!(found, (Rgb, with([0x8080; 3], &rgb)));
    let found = deep(&folder, Rgba, &rgba, "--color #01020304");
    assert_eq!(found, (Rgba, with([0x0101, 0x0202, 0x0303, 0x0404], &rgba)));
    // Channels that the file lacks are added.
    let found = deep(&folder, Grayscale, &grey, "--color #80808001");
    assert_eq!(found, (GrayscaleAlpha, with([0x8080, 0x0101], &opaque)));
    let found = deep(&folder, Grayscale, &grey, "--color #ff0001");
    let in_color = grey.map(|[g]| [g; 3]);
    assert_eq!(found, (Rgb, with([0xffff, 0, 0x0101], &in_color)));
    let found = deep(&folder, GrayscaleAlpha, &pale, "--color #ff0001");
    let in_color = pale.map(|[g, a]| [g, g, g, a]);
    assert_eq!(found, (Rgba, with([0xffff, 0, 0x0101, 0xffff], &in_color)));
    let found = deep(&folder, Rgb, &rgb, "--color transparent");
    let transparent = rgb.map(|[r, g, b]| [r, g, b, 0xffff]);
    assert_eq!(found, (Rgba, with([0; 4], &transparent)));
}

#[test]
fn tolerances_of_sixteen_bits_are_steps_of_eight() {
    let folder = Folder::new();
    let filled = |pixels: &[[u16; 1]], how: &str| {
        let (_, found) = deep(&folder, png::ColorType::Grayscale, pixels, how);
        found.iter().take_while(|p| p[0] == 0xffff).count()
    };
    let ramp = [[0x1000], [0x1000 + 1], [0x1000 + 257], [0x1000 + 258], [0x1000 + 514]];
    for (tolerance, count) in [(0, 1), (1, 3), (2, 5)] {
        let how = format!("--color white --tolerance {tolerance}");
        assert_eq!(filled(&ramp, &how), count, "{tolerance}");
    }
    let reversed = [[0], [0x8080 - 258], [0x8080 - 257], [0x8080]];
    for (tolerance, count) in [(0, 3), (1, 2), (2, 1)] {
        let how = format!("--color white --boundary #808080 --tolerance {tolerance}");
        assert_eq!(filled(&reversed, &how), count, "{tolerance}");
    }
    assert_eq!(filled(&[[0], [0xffff - 1], [5]], "--color white --tolerance 255"), 3);
}

#[test]
fn wrong_use_is_reported() {
    let folder = folder();
    folder.write("no.png", "not a picture");
    for (arguments, code, part) in [
        ("fill a.png -o b.png --at 8,0 --color red", 2, "--at 8,0: outside the image of 8x8"),
        ("fill a.png -o b.png --at -1,0 --color red", 2, "outside the image"),
        ("fill a.png -o b.png --color red", 2, "--at"),
        ("fill a.png -o b.png --at 1,1 --color reddish", 2, "a colour is"),
        ("fill a.png -o b.png --at 1,1 --color red --tolerance 256", 2, "256"),
        (
            "fill no.png -o b.png --at 1,1 --color red",
            1,
            "durer: no.png: it is neither PNG nor JPEG",
        ),
        ("fill none.png -o b.png --at 1,1 --color red", 1, "none.png"),
    ] {
        folder.run(arguments).fails(code, part);
    }
    assert!(!folder.path("b.png").exists());
}
