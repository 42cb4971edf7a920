//! Pictures as JPEG and WebP, turntables as animations.

use crate::harness::Folder;
use durer_formats::{Limits, image};

/// Returns the width, the height and the middle pixel of a JPEG.
fn jpeg(folder: &Folder, name: &str) -> (u32, u32, [u8; 4]) {
    let bytes = folder.read(name);
    assert!(bytes.starts_with(b"\xff\xd8\xff"), "{name} is a JPEG");
    let image = image::decode(&bytes, name, &Limits::default()).unwrap();
    let middle = image.data[(image.height / 2 * image.width + image.width / 2) as usize];
    (image.width, image.height, middle)
}

/// Returns the width and height of a lossless WebP.
fn webp(bytes: &[u8]) -> (u32, u32) {
    assert!(bytes.starts_with(b"RIFF") && &bytes[8..16] == b"WEBPVP8L");
    let sides = u32::from_le_bytes(bytes[21..25].try_into().unwrap());
    ((sides & 0x3fff) + 1, (sides >> 14 & 0x3fff) + 1)
}

#[test]
fn all_commands_write_jpeg_and_webp() {
    let folder = Folder::with_models();
    folder.must(
        "render cube.obj -o a.png --depth d.png --size 24x16 --eye 0,0,9 --target 0,0,0 --fov 40 \
         --near 1 --far 20",
    );
    folder.write("map.wkt", "POLYGON ((0 0, 3 0, 3 2, 0 2, 0 0))");
    for command in [
        "render cube.obj --size 24x16",
        "render cube.obj --size 24x16 --style hidden-line",
        "fill a.png --at 1,1 --color red",
        "draw map.wkt --size 24x16",
        "warp a.png d.png --eye 0,0,9 --target 0,0,0 --fov 40 --near 1 --far 20 --to-eye 0,1,9",
        "plot --formula x*z --size 24x16",
    ] {
        for name in ["x.jpg", "x.JPEG"] {
            let ended = folder.must(&format!("{command} -o {name}"));
            assert!(ended.err.is_empty(), "{command}: {}", ended.err);
            assert_eq!((jpeg(&folder, name).0, jpeg(&folder, name).1), (24, 16), "{command}");
        }
        folder.must(&format!("{command} -o x.webp"));
        assert_eq!(webp(&folder.read("x.webp")), (24, 16), "{command}");
    }
    folder.must("render cube.obj -o sheet.jpg --algorithm all --size 40x40");
    assert!(jpeg(&folder, "sheet.jpg").0 > 100);
    let stream = folder.must("render cube.obj -o - --format webp --size 9x7");
    assert_eq!(webp(&stream.out), (9, 7));
}

#[test]
fn a_jpeg_lies_on_white_and_says_so() {
    let folder = Folder::with_models();
    let ended =
        folder.must("render cube.obj -o a.jpg --size 16x16 --background transparent --json");
    assert!(ended.err.contains("a JPEG has no transparency"), "{}", ended.err);
    let warnings = ended.json()["models"][0]["warnings"].to_string();
    assert!(warnings.contains("composed with white"), "{warnings}");
    let image = image::decode(&folder.read("a.jpg"), "a.jpg", &Limits::default()).unwrap();
    assert!(image.data[0][..3].iter().all(|c| *c >= 250), "{:?}", image.data[0]);
    let colored = folder.must("render cube.obj -o b.jpg --size 16x16 --background navy");
    assert!(colored.err.is_empty(), "{}", colored.err);
    folder.write("a.svg", r#"<svg xmlns="http://www.w3.org/2000/svg" width="8" height="8"/>"#);
    let drawn = folder.must("draw a.svg -o c.jpg");
    assert!(drawn.err.contains("c.jpg: a JPEG has no transparency"), "{}", drawn.err);
    assert!(jpeg(&folder, "c.jpg").2[0] >= 250);
    assert!(folder.must("draw a.svg -o c.jpg --background red").err.is_empty());
}

#[test]
fn quality_and_compression_are_for_what_has_them() {
    let folder = Folder::with_models();
    let size = |options: &str| {
        folder.must(&format!("render cube.obj -o a.jpg --size 128x128 {options}"));
        folder.read("a.jpg").len()
    };
    assert!(size("--quality 20") < size("") && size("") < size("--quality 100"));
    assert_eq!(size("--quality 90"), size(""));
    folder.run("render cube.obj -o a.png --quality 50").fails(2, "--quality: only a JPEG");
    folder.run("render cube.obj -o a.svg --quality 50").fails(2, "--quality: only a JPEG");
    let only = "--compression: only a PNG";
    for output in ["a.jpg", "a.webp", "a.gif --turntable 2", "a.jpg --style hidden-line"] {
        folder.run(&format!("render cube.obj -o {output} --compression small")).fails(2, only);
    }
    folder.run("render cube.obj -o a.svg --compression small").fails(2, "it is for .png files");
    folder.run("plot --formula x -o a.svg --compression small").fails(2, only);
    folder.must("render cube.obj -o a.jpg --depth d.png --size 8x8 --compression small");
    folder.must("render cube.obj -o turn.png --turntable 2 --size 8x8 --compression small");
    folder.run("render cube.obj -o a.jpg --quality 0").fails(2, "--quality");
    folder.run("render cube.obj -o a.jpg --quality 101").fails(2, "--quality");
    folder.run("render cube.obj -o a.jpg --size 65536x1").fails(2, "room for 65535 pixels");
    folder.run("render cube.obj -o a.webp --size 1x16385").fails(2, "room for 16384 pixels");
}

#[test]
fn planes_stay_png_and_say_why() {
    let folder = Folder::with_models();
    for option in ["--depth", "--item", "--normal"] {
        let ended = folder.run(&format!("render cube.obj -o a.jpg {option} x.jpg"));
        ended.fails(2, &format!("{option} x.jpg")).fails(2, "only PNG keeps");
    }
    folder.must("render cube.obj -o a.jpg --depth d.png --size 8x8");
    assert!(folder.read("d.png").starts_with(b"\x89PNG"));
}

#[test]
fn an_option_makes_any_name_right_but_one_of_another_format() {
    let folder = Folder::with_models();
    folder.write("thumb", "old");
    for name in ["thumb", "tmp.Xa31Qp", ".hidden"] {
        folder.must(&format!("render cube.obj -o {name} --format png --size 8x8"));
        assert!(folder.read(name).starts_with(b"\x89PNG"), "{name}");
    }
    let ended = folder.run("render cube.obj -o a.png --format jpeg");
    ended.fails(2, "--format says jpeg").fails(2, ".jpg");
    folder.must("render cube.obj -o new/ --format jpg --size 8x8");
    assert_eq!(jpeg(&folder, "new/cube.jpg").0, 8);
    folder.must("render cube.obj -o f/%02d.jpg --turntable 2 --size 8x8");
    assert_eq!(jpeg(&folder, "f/01.jpg").0, 8);
    folder.run("render cube.obj -o f/%02d.bmp --turntable 2").fails(2, "end the name in");
}

/// Returns the number of frames, and their times in milliseconds.
fn png_frames(bytes: &[u8]) -> Vec<u32> {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let count = reader.info().animation_control.unwrap().num_frames;
    let mut data = vec![0; reader.output_buffer_size().unwrap()];
    let mut pictures = Vec::new();
    let mut delays = Vec::new();
    for _ in 0..count {
        reader.next_frame(&mut data).unwrap();
        let frame = reader.info().frame_control.unwrap();
        assert_eq!(frame.delay_den, 1000);
        delays.push(u32::from(frame.delay_num));
        assert!(!pictures.contains(&data), "each frame is another picture");
        pictures.push(data.clone());
    }
    delays
}

/// Returns the number of occurrences of a sequence of bytes.
fn count(bytes: &[u8], part: &[u8]) -> usize {
    bytes.windows(part.len()).filter(|w| *w == part).count()
}

#[test]
fn turntables_go_into_one_animated_file() {
    let folder = Folder::with_models();
    let turn = "render cube.obj --size 16x16 --elevation 20 --turntable";
    folder.must(&format!("{turn} 3 -o t.png --fps 8 --item i%d.png"));
    assert_eq!(png_frames(&folder.read("t.png")), [125; 3]);
    assert!(folder.path("i2.png").is_file());
    folder.must(&format!("{turn} 3 -o t.png"));
    assert_eq!(png_frames(&folder.read("t.png")), [42, 41, 42]);
    folder.must(&format!("{turn} 3 -o t.webp --duration 1.5"));
    assert_eq!(count(&folder.read("t.webp"), b"ANMF"), 3);
    folder.must(&format!("{turn} 3 -o t.gif"));
    assert!(folder.read("t.gif").starts_with(b"GIF89a"));
    assert_eq!(count(&folder.read("t.gif"), b"\x21\xf9\x04"), 3);
    let drawn = folder.must(&format!("{turn} 3 -o d.png --style hidden-line --json"));
    assert_eq!(png_frames(&folder.read("d.png")).len(), 3);
    assert_eq!(drawn.json()["models"][0]["pictures"][1]["files"][0], "d.png");
    folder.write("again.obj", folder.read("cube.obj"));
    folder.must(&format!("{turn} 2 -o gifs/ --format gif again.obj"));
    assert!(folder.path("gifs/cube.gif").is_file() && folder.path("gifs/again.gif").is_file());
}

#[test]
fn an_animation_that_fails_leaves_nothing() {
    let folder = Folder::with_models();
    folder.write("t.webp", "old");
    folder.run("render broken.obj -o t.webp --turntable 2").fails(1, "broken.obj");
    folder.run("render cube.obj -o t.webp --turntable 2 --camera Main").fails(1, "no camera");
    assert_eq!(folder.read("t.webp"), b"old");
    assert_eq!(folder.names(), ["broken.obj", "cube.obj", "t.webp"]);
}

#[test]
fn times_that_have_no_meaning_are_refused() {
    let folder = Folder::with_models();
    let turn = "render cube.obj --size 8x8 --turntable 60";
    folder.run(&format!("{turn} -o t.gif --fps 60")).fails(2, "--fps: 0.016");
    folder.run(&format!("{turn} -o t.gif --duration 1")).fails(2, "--duration");
    folder.run(&format!("{turn} -o t.png --fps 0")).fails(2, "--fps");
    folder
        .run(&format!("{turn} -o t_%d.png --fps 9"))
        .fails(2, "--fps, --duration: frames have times");
    folder.run("render cube.obj -o t.png --fps 9").fails(2, "--turntable");
    folder
        .run("render cube.obj --turntable 60 -o t.svg")
        .fails(2, "several pictures need a folder");
    folder.run(&format!("{turn} -o - --format gif")).fails(2, "an animation is written to a file");
    folder.run(&format!("{turn} cube.obj -o t.gif")).fails(2, "several pictures need a folder");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_reported_of_animations_too() {
    let folder = Folder::with_models();
    let turn = "render cube.obj --size 8x8 --turntable 2 -o /dev/full";
    folder.run(&format!("{turn} --format gif")).fails(1, "/dev/full: No space left on device");
}
