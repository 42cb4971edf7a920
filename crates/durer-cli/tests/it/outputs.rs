//! Output files: complete or none, several files, additional planes.

use crate::harness::{Folder, Picture};
use std::fs;

#[test]
fn a_failed_run_leaves_the_old_file_and_nothing_else() {
    let folder = Folder::with_models();
    folder.write("out.png", "old");
    folder.run("render broken.obj -o out.png").fails(1, "broken.obj: line 3");
    folder.run("render missing.obj -o out.png").fails(1, "missing.obj: No such file");
    folder.run("render . -o out.png").fails(1, "folder");
    assert_eq!(folder.read("out.png"), b"old");
    assert_eq!(folder.names(), ["broken.obj", "cube.obj", "out.png"]);
}

#[test]
fn a_new_picture_replaces_the_old_one() {
    let folder = Folder::with_models();
    folder.write("out.png", "old");
    let ended = folder.must("render cube.obj -o out.png --size 20x10");
    assert!(ended.err.is_empty() && ended.out.is_empty(), "{ended:?}");
    assert_eq!(Picture::decode(&folder.read("out.png")).size(), (20, 10));
    assert_eq!(folder.names(), ["broken.obj", "cube.obj", "out.png"]);
}

#[test]
fn places_that_cannot_be_written_are_reported_before_the_work() {
    let folder = Folder::with_models();
    folder.run("render cube.obj -o nowhere/out.png").fails(1, "nowhere");
    folder.run("render cube.obj -o cube.obj/out.png").fails(1, "not a folder");
    folder.run("render cube.obj -o out.bmp").fails(2, "--output out.bmp").fails(2, ".png");
    folder.run("render cube.obj -o cube.obj").fails(2, ".png");
    folder.run("render cube.obj -o a.png --depth a.png").fails(2, "a.png: two pictures");
    folder.run("render cube.obj cube.obj -o a.png").fails(2, "folder");
    folder.run("render cube.obj -o a.jpg --turntable 2").fails(2, "frame_%04d.png");
    assert_eq!(folder.read("cube.obj"), crate::harness::CUBE.as_bytes());
}

#[test]
fn commands_name_the_suffixes_that_they_can_write() {
    let folder = Folder::with_models();
    folder.must("render cube.obj -o a.png --depth d.png --size 8x8");
    folder.write("map.wkt", "POINT (1 2)");
    let camera = "--eye 0,0,9 --target 0,0,0 --fov 40 --near 1 --far 20 --to-eye 0,1,9";
    for command in
        ["fill a.png --at 1,1 --color red".to_owned(), format!("warp a.png d.png {camera}")]
    {
        for wrong in ["x.gif", "x.svg"] {
            let ended = folder.run(&format!("{command} -o {wrong}"));
            ended.fails(2, &format!("--output {wrong}: pictures are written as PNG"));
            assert!(!ended.err.contains(".pdf"), "{}", ended.err);
        }
    }
    for wrong in ["x.gif", "x.hpgl"] {
        let printed = format!("--output {wrong}: drawings and maps are written as PNG");
        let ended = folder.run(&format!("draw map.wkt -o {wrong}"));
        ended.fails(2, &printed).fails(2, ".webp, .svg, .pdf or .dxf");
    }
    folder.run("render cube.obj -o x.bmp").fails(2, ".svg, .pdf, .dxf, .hpgl, .gcode, .geojson");
    folder.run("render cube.obj -o x.gif").fails(2, "a GIF is for a --turntable");
    let plane = folder.run("render cube.obj -o a.png --depth x.gif");
    assert!(
        plane.fails(2, "end the name in .png").err.trim_end().ends_with(".png"),
        "{}",
        plane.err
    );
    folder
        .run("plot --formula x*z -o x.gif")
        .fails(2, "a plot is svg, pdf, dxf, hpgl, gcode, geojson, png, jpg or webp");
}

#[cfg(unix)]
#[test]
fn read_only_files_and_links_are_kept() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = Folder::with_models();
    folder.write("kept.png", "old");
    fs::set_permissions(folder.path("kept.png"), fs::Permissions::from_mode(0o444)).unwrap();
    folder
        .run("render cube.obj -o kept.png --size 8x8")
        .fails(1, "kept.png: the file is read-only");
    assert_eq!(folder.read("kept.png"), b"old");

    folder.write("true.png", "old");
    fs::set_permissions(folder.path("true.png"), fs::Permissions::from_mode(0o640)).unwrap();
    symlink("true.png", folder.path("link.png")).unwrap();
    folder.must("render cube.obj -o link.png --size 8x8");
    assert!(fs::symlink_metadata(folder.path("link.png")).unwrap().is_symlink());
    let metadata = fs::metadata(folder.path("true.png")).unwrap();
    assert_eq!(metadata.permissions().mode() & 0o777, 0o640);
    assert!(folder.read("true.png").starts_with(b"\x89PNG"));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_reported() {
    let folder = Folder::with_models();
    let ended = folder.run("render cube.obj -o /dev/full --size 8x8");
    ended.fails(1, "/dev/full: No space left on device");
    folder.must("render cube.obj -o /dev/null --size 8x8");
    assert!(!fs::metadata("/dev/null").unwrap().is_file(), "a device is not replaced");
}

#[test]
fn several_models_make_one_picture_each() {
    let folder = Folder::with_models();
    fs::create_dir(folder.path("sub")).unwrap();
    fs::copy(folder.path("cube.obj"), folder.path("sub/cube.obj")).unwrap();
    fs::copy(folder.path("cube.obj"), folder.path("b.obj")).unwrap();
    folder.must("render cube.obj b.obj -o new/pictures --size 8x8");
    assert!(folder.path("new/pictures/cube.png").is_file());
    assert!(folder.path("new/pictures/b.png").is_file());
    folder.must("render cube.obj -o new --size 8x8");
    assert!(folder.path("new/cube.png").is_file());
}

#[test]
fn names_of_pictures_depend_on_their_own_model_alone() {
    let folder = Folder::with_models();
    fs::create_dir(folder.path("sub")).unwrap();
    fs::copy(folder.path("cube.obj"), folder.path("sub/cube.obj")).unwrap();
    let run = |output: &str| {
        folder.run(&format!("render cube.obj sub/cube.obj ./sub/../b.obj {output} --size 8x8"))
    };
    fs::copy(folder.path("cube.obj"), folder.path("b.obj")).unwrap();
    run("-o out").fails(2, "two pictures would go there; -o 'DIR/{folder}/{name}.png' keeps");
    run("-o out/{stem}.jpg").fails(2, "{name}.jpg' keeps");
    assert!(!folder.path("out/b.png").exists(), "nothing was rendered");
    let ended = run("-o out/{folder}/{name}.png --depth out/d-{folder}/{stem}.png");
    assert_eq!(ended.code, 0, "{}", ended.err);
    for name in ["cube.obj.png", "sub/cube.obj.png", "sub/b.obj.png", "d-/b.png", "d-sub/cube.png"]
    {
        assert!(folder.path("out").join(name).is_file() == (name != "d-/b.png"), "{name}");
    }
    run("-o out/{folder}/{stem}.jpg --turntable 2").fails(2, "such as {stem}_%04d.png");
    assert_eq!(run("-o f/{folder}/{stem}_%d.png --turntable 2").code, 0);
    assert!(folder.path("f/sub/cube_1.png").is_file() && folder.path("f/cube_0.png").is_file());
}

#[test]
fn failures_are_skipped_when_that_is_requested() {
    let folder = Folder::with_models();
    let run = |options: &str| folder.run(&format!("render {options} -o out/ --size 8x8"));
    run("broken.obj cube.obj").fails(1, "broken.obj: line 3");
    assert!(!folder.path("out/cube.png").exists(), "it stops at the first failure");
    let ended = run("broken.obj cube.obj --skip-failures --json");
    ended.fails(3, "durer: broken.obj: line 3");
    let report = ended.json();
    assert_eq!(report["failed"][0]["model"], "broken.obj");
    assert_eq!(report["models"][0]["model"], "cube.obj");
    assert!(folder.path("out/cube.png").is_file());
    run("broken.obj missing.obj --skip-failures").fails(1, "no model could be rendered");
    assert_eq!(run("cube.obj --skip-failures").code, 0);
}

/// Two points, one in the west of the world and one in the east.
const POINTS: &str = r#"{"type":"MultiPoint","coordinates":[[-90,45],[90,45]]}"#;

#[test]
fn reports_after_failures_say_which_files_are_written() {
    let folder = Folder::new();
    folder.write("points.geojson", POINTS);
    for name in ["tiles", "cut"] {
        std::fs::create_dir_all(folder.path(name).join("1")).unwrap();
        // A file at a path that must be a folder.
        folder.write(&format!("{name}/1/1"), "");
    }
    for (command, written) in [
        ("tiles points.geojson --zoom 0-2 -o tiles", vec!["0/0/0.mvt", "1/0/0.mvt"]),
        ("clip points.geojson --tiles 1 -o cut", vec!["1/0/0.geojson"]),
    ] {
        let ended = folder.run(&format!("{command} --json"));
        assert_eq!(ended.code, 1, "{command}: {}", ended.err);
        let report = ended.json();
        assert_eq!(report["written"], serde_json::json!(written), "{command}");
        assert_eq!(report["tiles"], written.len(), "{command}");
        let error = report["error"].as_str().unwrap();
        assert!(ended.err.contains(error), "{command}: {error}");
    }
    // Each file is either complete or absent.
    std::fs::create_dir(folder.path("a.pmtiles")).unwrap();
    assert_eq!(folder.run("tiles points.geojson --zoom 0-2 -o a.pmtiles --json").code, 1);
}

#[test]
fn info_tells_of_files_before_one_that_is_broken() {
    let folder = Folder::with_models();
    let ended = folder.run("info cube.obj broken.obj --json");
    ended.fails(1, "broken.obj: line 3");
    assert_eq!(ended.json()[0]["triangles"], 12);
    let ended = folder.run("info cube.obj broken.obj");
    assert!(ended.code == 1 && String::from_utf8_lossy(&ended.out).contains("cube.obj"));
}

#[test]
fn turntables_are_numbered() {
    let folder = Folder::with_models();
    folder.must(
        "render cube.obj -o frames/f_%02d.png --turntable 3 --size 16x16 --item frames/i%d.png",
    );
    for name in ["f_00.png", "f_01.png", "f_02.png", "i0.png", "i1.png", "i2.png"] {
        let picture = Picture::decode(&folder.read(&format!("frames/{name}")));
        assert_eq!(picture.size(), (16, 16));
    }
    folder.must("render cube.obj -o dir/ --turntable 2 --size 16x16");
    assert!(folder.path("dir/cube_0001.png").is_file());
}

#[cfg(unix)]
#[test]
fn links_stay_links_even_to_files_that_are_missing() {
    let folder = Folder::new();
    folder.write("map.wkt", "POINT (1 2)");
    std::fs::create_dir(folder.path("far")).expect("folder");
    std::os::unix::fs::symlink("far/a.png", folder.path("a.png")).expect("link");
    for _ in 0..2 {
        folder.must("draw map.wkt -o a.png --size 9x9");
        assert!(folder.path("a.png").is_symlink() && folder.path("far/a.png").is_file());
    }
    assert_eq!(std::fs::read_dir(folder.path("far")).expect("folder").count(), 1);
}
