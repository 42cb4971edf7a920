//! A file of options.

use crate::harness::{Ended, Folder, Picture};

fn with_file(text: &str) -> Folder {
    let folder = Folder::with_models();
    folder.write("durer.toml", text);
    folder
}

fn size(folder: &Folder, options: &str) -> (u32, u32) {
    folder.must(&format!("render cube.obj -o a.png {options}"));
    Picture::decode(&folder.read("a.png")).size()
}

#[test]
fn its_options_hold_where_the_command_line_says_nothing() {
    let folder = with_file("[render]\nsize = \"20x10\"\nbackground = \"navy\"\nsamples = 1\n");
    assert_eq!(size(&folder, ""), (20, 10));
    assert_eq!(Picture::decode(&folder.read("a.png")).pixel(0, 0), [0, 0, 128]);
    assert_eq!(size(&folder, "--size 8x8"), (8, 8));
    assert_eq!(Picture::decode(&folder.read("a.png")).pixel(0, 0), [0, 0, 128]);
    assert_eq!(size(&folder, "--no-config"), (1024, 1024));
    folder.write("other.toml", "[render]\nsize = 12\n[draw]\nsize = \"30x\"\n");
    assert_eq!(size(&folder, "--config other.toml"), (12, 12));
    folder.must("--config other.toml render cube.obj -o a.png");
    assert_eq!(Picture::decode(&folder.read("a.png")).size(), (12, 12));
    folder.run("render cube.obj -o a.png --config missing.toml").fails(1, "missing.toml");
    folder.write("rays.toml", "[render]\nbounces = 2\n");
    let rays = folder.run("render cube.obj -o a.png --config rays.toml --algorithm z-buffer");
    rays.fails(2, "--bounces").fails(2, "(with the options of rays.toml)");
    folder.run("render cube.obj -o a.png --config other.toml --no-config").fails(2, "--no-config");
}

#[test]
fn values_are_strings_numbers_flags_and_arrays() {
    let folder = with_file(
        "[render]\neye = [3, 2.5, 9]\ntarget = [0, 0, 0]\nfov = 20.5\njson = true\nquiet = false\n\
         light = [\"ambient:white:0.2\", \"directional:-1,-2,-1\"]\nsize = 8\noutput = \"o.png\"\n",
    );
    let report = folder.must("render cube.obj").json();
    let camera = &report["models"][0]["pictures"][0]["cameras"][0];
    assert_eq!(camera["eye"].to_string(), "[3.0,2.5,9.0]");
    assert!((camera["fov"].as_f64().unwrap() - 20.5).abs() < 1e-9);
    assert!(folder.path("o.png").is_file());
}

#[test]
fn what_is_given_takes_the_place_of_what_it_excludes() {
    let folder = with_file("[render]\nsize = 8\njson = true\neye = [3, 4, 5]\nquiet = true\n");
    let eye = |options: &str| {
        let ended = folder.must(&format!("render cube.obj -o a.png {options}"));
        ended.json()["models"][0]["pictures"][0]["cameras"][0]["eye"][0].as_f64().unwrap()
    };
    assert_eq!(eye(""), 3.0);
    assert_eq!(eye("--view front"), 0.0);
    assert_eq!(eye("--view front --verbose"), 0.0);
    folder.write("durer.toml", "[render]\nsize = 8\njson = true\nazimuth = 90\n");
    assert!(eye("") > 1.0);
    assert_eq!(eye("--view front"), 0.0);
}

#[test]
fn paths_are_relative_to_the_file() {
    let folder = with_file("");
    std::fs::create_dir(folder.path("sub")).unwrap();
    folder.write("sub/my.toml", "[render]\noutput = \"a.png\"\ndepth = \"d.png\"\nsize = 8\n");
    folder.must("render cube.obj --config sub/my.toml");
    assert!(folder.path("sub/a.png").is_file() && folder.path("sub/d.png").is_file());
    folder.write("sub/my.toml", "[render]\noutput = \"-\"\nsize = 8\n");
    assert!(folder.must("render cube.obj --config sub/my.toml").out.starts_with(b"\x89PNG"));
}

fn refused(text: &str) -> Ended {
    with_file(text).run("render cube.obj -o a.png")
}

#[test]
fn what_is_wrong_in_it_is_reported_with_line_and_key() {
    for (text, line, parts) in [
        ("[render]\nsize = 8\nsizze = 9\n", 3, ["`sizze`", "no such option"]),
        ("[render]\n\nsize = \"big\"\n", 3, ["`size`", "1920x1080"]),
        ("[render]\naa = 3\n", 2, ["`aa`", "16"]),
        ("[render]\nquiet = \"yes\"\n", 2, ["`quiet`", "true or false"]),
        ("[render]\nsize = true\n", 2, ["`size`", "string, a number"]),
        ("[render]\nlight = []\n", 2, ["`light`", "empty"]),
        ("[render]\nquality = 400\n", 2, ["`quality`", "1..=100"]),
        ("[render]\nview = \"top\"\neye = [1, 2, 3]\n", 3, ["`eye`", "`view`"]),
        ("[render]\naa = 4\nsamples = 4\n", 3, ["`samples`", "another name"]),
        ("[render]\nconfig = \"x.toml\"\n", 2, ["`config`", "no such option"]),
        ("[rendr]\n", 1, ["[rendr]", "no such command"]),
        ("size = 8\n", 1, ["`size`", "under their command"]),
        ("[draw]\nstroke = \"reddish\"\n", 2, ["`stroke`", "reddish"]),
        ("[render]\nsize = \n", 2, ["durer.toml", "line"]),
    ] {
        let ended = refused(text);
        let place = format!("durer.toml: line {line}: ");
        assert!(ended.code == 2 && ended.err.contains(&place), "{text}: {ended:?}");
        assert!(parts.iter().all(|p| ended.err.contains(p)), "{text}: {}", ended.err);
    }
    let folder = with_file("");
    folder.write("durer.toml", [0x5b, 0xff]);
    folder.run("render cube.obj -o a.png").fails(1, "UTF-8");
}

#[test]
fn settings_that_fit_no_output_are_no_fault() {
    let folder = with_file("[render]\nquality = 40\nfps = 9\nhidden = \"dashed\"\nsize = 8\n");
    folder.must("render cube.obj -o a.png");
    folder.must("render cube.obj -o a.jpg");
    folder.must("render cube.obj -o a.svg");
    folder.must("render cube.obj -o a.gif --turntable 2");
    folder.must("render cube.obj -o a_%d.png --turntable 2");
}

#[test]
fn styles_of_maps_are_for_all_layers_that_have_none() {
    let folder = with_file("[draw]\nfill = \"red\"\nsize = 16\nstroke = \"none\"\n");
    folder.write("a.wkt", "POLYGON ((0 0, 2 0, 2 2, 0 2, 0 0))");
    folder.write("b.wkt", "POLYGON ((1 0, 2 0, 2 2, 1 2, 1 0))");
    folder.must("draw a.wkt b.wkt --fill blue -o m.png");
    let picture = Picture::decode(&folder.read("m.png"));
    assert_eq!(picture.pixel(4, 8), [255, 0, 0]);
    assert_eq!(picture.pixel(11, 8), [0, 0, 255]);
}

#[test]
fn required_options_may_stand_in_it() {
    let folder =
        with_file("[warp]\nfov = 40\nnear = 1\nfar = 20\neye = [0, 0, 9]\ntarget = [0, 0, 0]\n");
    let camera = "--eye 0,0,9 --target 0,0,0 --fov 40 --near 1 --far 20";
    folder.must(&format!("render cube.obj -o a.png --depth d.png --size 9 {camera}"));
    folder.must("warp a.png d.png -o w.png --to-eye 0,1,9");
    assert!(folder.path("w.png").is_file());
}

#[test]
fn verbose_runs_say_which_file_was_used() {
    let folder = with_file("[render]\nsize = 8\n");
    let ended = folder.must("render cube.obj -o a.png --verbose");
    assert!(ended.err.contains("options are taken from durer.toml"), "{}", ended.err);
    assert!(folder.must("render cube.obj -o a.png").err.is_empty());
    let help = String::from_utf8(folder.must("--help").out).unwrap();
    assert!(help.contains("[render]") && help.contains("--no-config"), "{help}");
}
