//! Errors in options: each names its option and ends with code 2.

use crate::harness::Folder;

#[test]
fn wrong_values_name_their_option() {
    let folder = Folder::with_models();
    for (option, part) in [
        ("--size NaNxNaN", "--size"),
        ("--size 0x5", "--size"),
        ("--size -5x5", "--size"),
        ("--size 99999999999x1", "--size"),
        ("--size 20000x20000", "--max-pixels"),
        ("--eye nan,0,0", "--eye"),
        ("--eye 1,2", "--eye"),
        ("--eye 1,1,1 --target 1,1,1", "--target"),
        ("--eye 0,0,5 --target 0,0,0 --up 0,0,1", "--up"),
        ("--eye 0,0,5 --up 0,0,0", "--up"),
        ("--fov 180", "--fov"),
        ("--fov 0", "--fov"),
        ("--ortho -1", "--ortho"),
        ("--ortho inf", "--ortho"),
        ("--near 2 --far 1", "--near"),
        ("--near 0", "--near"),
        ("--far -1", "--far"),
        ("--elevation 91", "--elevation"),
        ("--azimuth inf", "--azimuth"),
        ("--view sideways", "one of iso, front"),
        ("--viewports front,sideways", "one of iso, front"),
        ("--viewports front,top --size 1x1", "--viewports"),
        ("--background purpleish", "--background"),
        ("--light sun", "--light"),
        ("--light directional:0,0,0", "--light"),
        ("--aa 3", "--aa"),
        ("--threads 0", "--threads"),
        ("--turntable 0", "--turntable"),
        ("--time nan", "--time"),
        ("--max-bytes 1x", "--max-bytes"),
        ("--section 1,0,0", "--section"),
        ("--section 0,0,0,1", "--section"),
        ("--cap-color red", "--section"),
        ("--wrong", "--wrong"),
    ] {
        let ended = folder.run(&format!("render cube.obj -o out.png {option}"));
        assert!(ended.code == 2 && ended.err.contains(part), "{option}: {ended:?}");
        assert_eq!(folder.names(), ["broken.obj", "cube.obj"], "{option} left something");
    }
}

#[test]
fn options_that_exclude_each_other_are_refused() {
    let folder = Folder::with_models();
    for options in [
        "--eye 1,2,3 --view front",
        "--eye 1,2,3 --azimuth 5",
        "--eye 1,2,3 --camera a",
        "--fov 30 --ortho 2",
        "--target 1,2,3",
        "--viewports front,top --turntable 3",
        "--viewports front,top --view top",
        "--eye 1,2,3 --ortho fit",
        "--quiet --verbose",
        "--shadow-map 512",
    ] {
        let ended = folder.run(&format!("render cube.obj -o out.png {options}"));
        assert_eq!(ended.code, 2, "{options}: {ended:?}");
    }
    folder.run("render cube.obj").fails(2, "--output");
    folder.run("render -o out.png").fails(2, "MODEL");
    folder.run("render - - -o out").fails(2, "twice");
    folder.run("").fails(2, "Usage");
}

#[test]
fn negative_numbers_are_values() {
    let folder = Folder::with_models();
    folder.must(
        "render cube.obj -o a.png --size 8x8 --eye -3.39,1.2,-1.3 --target -0.5,-0.5,-0.5 \
         --up -1,2,-1 --ortho 3 --near -5 --far 20",
    );
    folder.must("render cube.obj -o b.png --size 8x8 --azimuth -30 --elevation -20.5");
}

#[test]
fn options_that_a_format_has_nothing_for_are_named() {
    let folder = Folder::with_models();
    folder.write("map.csv", "1,2\n3,4\n");
    for (arguments, message) in [
        ("render cube.obj -o a.png --size 8x8 --time 1", "OBJ has no animations"),
        ("plot map.csv -o a.svg --array heights", "CSV has no arrays with names"),
    ] {
        let ended = folder.must(arguments);
        assert!(ended.err.contains(message), "{arguments}: {}", ended.err);
    }
    let quiet = folder.must("render cube.obj -o b.png --size 8x8");
    assert!(!quiet.err.contains("animations"), "{}", quiet.err);
}

#[test]
fn a_camera_that_is_not_there_is_reported_with_those_that_are() {
    let folder = Folder::with_models();
    let ended = folder.run("render cube.obj -o a.png --camera Main");
    ended.fails(1, "cube.obj: ").fails(1, "no camera `Main`").fails(1, "the file has no cameras");
}

#[test]
fn help_and_version_work_without_a_model() {
    let folder = Folder::new();
    let help = String::from_utf8(folder.must("render --help").out).unwrap();
    for option in ["--viewports", "--turntable", "Examples:", "Exit codes:", "directional:DX,DY,DZ"]
    {
        assert!(help.contains(option), "{option} is missing");
    }
    assert!(String::from_utf8(folder.must("--version").out).unwrap().starts_with("durer "));
    folder.must("help render");
}

#[test]
fn completions_and_the_manual_know_all_options() {
    let folder = Folder::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = String::from_utf8(folder.must(&format!("completions {shell}")).out).unwrap();
        assert!(script.contains("turntable"), "{shell}");
    }
    folder.run("completions tcsh").fails(2, "tcsh");
    let manual = String::from_utf8(folder.must("man").out).unwrap();
    for part in [".TH", "turntable", "skip\\-failures", "completions"] {
        assert!(manual.contains(part), "{part} is missing");
    }
}

#[test]
fn options_without_effect_are_reported() {
    let folder = Folder::with_models();
    for (options, printed) in [
        ("a.svg --light ambient:red", "--light: it has no effect: the drawing consists of lines"),
        ("a.svg --style wireframe --exposure 1", "--exposure: it has no effect: the drawing"),
        ("a.svg --style wireframe --hidden dashed", "--hidden: it has no effect: a wireframe"),
        ("a.svg --style regions --lines all", "--lines: it has no effect: the style regions"),
        ("a.geojson --hidden dashed", "--hidden: it has no effect: a .geojson has all lines"),
        ("a.svg --style regions --pen-order", "--pen-order: it has no effect: the style regions"),
        ("a.geojson --page A3", "--page: it has no effect: a .geojson"),
        ("a.dxf --title T --unit mm", "--title: it has no effect: the file has no place for it"),
        ("a.gcode --background red --scale 1:1", "--background: it has no effect: the file"),
        (
            "a.png --algorithm wireframe --shading flat",
            "--shading: it has no effect: the algorithm",
        ),
        ("a.png --algorithm depth-sort --aa 16", "--aa: it has no effect: this algorithm has one"),
        ("a.png --shading unlit --shadows map", "--shadows: it has no effect: --shading unlit"),
        ("a.png --shadows rays --shadow-map 64", "--shadow-map: it has no effect: rays"),
        ("a.png --own-lights", "cube.obj: OBJ has no lights; --own-lights does nothing"),
    ] {
        let size = if options.starts_with("a.png") { " --size 8x8" } else { "" };
        let ended = folder.must(&format!("render cube.obj -o {options}{size}"));
        assert!(
            ended.err.contains(&format!("durer: warning: {printed}")),
            "{options}: {}",
            ended.err
        );
    }
    for options in [
        "a.png --size 8x8 --algorithm depth-sort --aa 1",
        "a.png --size 8x8 --shading unlit --shadows none",
        "a.svg --light ambient:red --style regions",
        "a.svg --light ambient:red --hatch shade",
        "a.svg --light ambient:red --section 1,0,0,0",
        "a.dxf --title T --unit mm --sheet third-angle",
        "a.svg --hidden dashed",
        "a.svg --style regions --hatch shade --pen-order",
        "a.png --size 8x8 --aa 16 --light ambient:red --shading flat --shadows map --shadow-map 8",
    ] {
        let ended = folder.must(&format!("render cube.obj -o {options}"));
        assert!(!ended.err.contains("no effect"), "{options}: {}", ended.err);
    }
}
