//! Attacks by files of strangers, and systems with few resources: forged messages, overwritten files, runs that end
//! without a message.

use crate::harness::{CUBE, Folder};
use std::fs::{self, File};
use std::time::{Duration, SystemTime};

/// A name that would colour a terminal, end the line, and reverse the writing direction.
const FORGED: &str =
    r#"{"asset":{"version":"2.0"},"extensionsRequired":["\u001b[31mX\n\rdurer: fake \u202eline"]}"#;

/// A triangle under a matrix that makes everything overflow.
const ENDLESS: &str = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"mesh":0,"matrix":[1e308,1e308,1e308,1e308,1e308,1e308,1e308,1e308,1e308,1e308,1e308,1e308,1e308,1e308,1e308,1e308]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;

/// Returns whether a text controls a terminal other than by line breaks.
fn steers(text: &str) -> bool {
    text.chars().any(|c| (c.is_control() && c != '\n') || ('\u{202a}'..='\u{202e}').contains(&c))
}

#[test]
fn no_name_forges_a_message() {
    let folder = Folder::new();
    folder.write("a.gltf", FORGED);
    folder.write("b.obj", format!("mtllib no\x1b[31m.mtl\nusemtl a\x1b]0;pwn\x07\u{202e}\n{CUBE}"));
    let ended = folder.run("render a.gltf -o a.png");
    ended.fails(1, r"\u{1b}[31mX\n\rdurer: fake \u{202e}line");
    assert_eq!(ended.err.lines().count(), 1, "{}", ended.err);
    let ended = folder.must("render b.obj -o b.png --size 16 --json");
    assert!(
        !steers(&ended.err) && ended.err.contains(r"a\u{1b}]0;pwn\u{7}\u{202e}"),
        "{}",
        ended.err
    );
    assert!(!steers(std::str::from_utf8(&ended.out).unwrap()));
    assert!(ended.json()["models"][0]["warnings"][0].as_str().unwrap().contains(r"\u{1b}"));
    let printed = folder.must("info b.obj");
    assert!(!steers(std::str::from_utf8(&printed.out).unwrap()));
    let printed = folder.must("info b.obj --json");
    assert!(!steers(std::str::from_utf8(&printed.out).unwrap()));
    assert_eq!(printed.json()["materials"][0]["name"], "a\x1b]0;pwn\x07\u{202e}");
}

#[test]
fn errors_name_the_file() {
    let folder = Folder::new();
    folder.write("far.gltf", ENDLESS);
    folder.run("render far.gltf -o a.png").fails(1, "far.gltf: coordinates of the model");
}

#[cfg(unix)]
#[test]
fn places_are_reported_by_what_is_there() {
    let folder = Folder::with_models();
    fs::write(folder.path("a.png"), "old").unwrap();
    std::os::unix::fs::symlink("a.png", folder.path("link.png")).unwrap();
    fs::hard_link(folder.path("a.png"), folder.path("hard.png")).unwrap();
    let full = folder.path("new.png").canonicalize().unwrap_or_else(|_| folder.path("new.png"));
    for (one, other) in [
        ("a.png", "./a.png"),
        ("a.png", "link.png"),
        ("a.png", "hard.png"),
        ("new.png", "./new.png"),
        ("new.png", full.to_str().unwrap()),
    ] {
        let arguments = format!("render cube.obj -o {one} --item {other}");
        folder.run(&arguments).fails(2, "two pictures would go there");
    }
    assert_eq!(folder.read("a.png"), b"old");
}

#[test]
fn an_input_may_be_replaced_by_its_result() {
    let folder = Folder::new();
    let bow_tie = r#"{"type":"Polygon","coordinates":[[[0,0],[2,2],[2,0],[0,2],[0,0]]]}"#;
    folder.write("a.geojson", bow_tie);
    folder.must("fix a.geojson -o ./a.geojson");
    let fixed = String::from_utf8(folder.read("a.geojson")).unwrap();
    assert!(fixed.contains("MultiPolygon"), "{fixed}");
    // A failed run leaves the file as it was.
    folder.write("a.geojson", "{");
    assert_eq!(folder.run("fix a.geojson -o ./a.geojson").code, 1);
    assert_eq!(folder.read("a.geojson"), b"{");
}

#[test]
fn what_killed_runs_have_left_goes_after_a_day() {
    let folder = Folder::with_models();
    let two_days_ago = SystemTime::now() - Duration::from_secs(2 * 86_400);
    for (name, old) in [
        (".durer-1-0.tmp", true),
        (".durer-1-1.tmp", false),
        (".durer-x-1.tmp", true),
        ("durer-1-1.tmp", true),
    ] {
        let file = File::create(folder.path(name)).unwrap();
        if old {
            file.set_modified(two_days_ago).unwrap();
        }
    }
    folder.must("render cube.obj -o a.png --size 16");
    let left =
        [".durer-1-1.tmp", ".durer-x-1.tmp", "a.png", "broken.obj", "cube.obj", "durer-1-1.tmp"];
    assert_eq!(folder.names(), left);
}

#[test]
fn a_report_tells_what_was_written_before_a_failure() {
    let folder = Folder::with_models();
    let ended = folder.run("render cube.obj broken.obj -o out --size 16 --json");
    ended.fails(1, "broken.obj: line 3");
    let report = ended.json();
    assert_eq!(report["models"][0]["pictures"][0]["files"][0], "out/cube.png");
    assert_eq!(report["failed"][0]["model"], "broken.obj");
    assert_eq!(report["failed"][0]["pictures"].as_array().unwrap().len(), 0);
    // The third frame cannot be written.
    fs::create_dir_all(folder.path("t/cube_0002.png")).unwrap();
    let ended = folder.run("render cube.obj -o t --turntable 5 --size 16 --json");
    assert_eq!(ended.code, 1, "{}", ended.err);
    let pictures = ended.json()["failed"][0]["pictures"].as_array().unwrap().clone();
    let files: Vec<_> = pictures.iter().map(|p| p["files"][0].as_str().unwrap()).collect();
    assert_eq!(files, ["t/cube_0000.png", "t/cube_0001.png"]);
}

#[cfg(unix)]
#[test]
fn files_that_have_no_room_are_errors() {
    let folder = Folder::with_models();
    let durer = env!("CARGO_BIN_EXE_durer");
    let line = format!("ulimit -f 4; exec '{durer}' render cube.obj -o a.png --size 512");
    let output =
        std::process::Command::new("sh").args(["-c", &line]).current_dir(folder.path("")).output();
    let ended = crate::harness::Ended::of(output.unwrap());
    ended.fails(1, "a.png: File too large");
    if fs::metadata("/dev/full").is_ok() {
        folder
            .run("render cube.obj -o /dev/full --format png")
            .fails(1, "/dev/full: No space left");
    }
    assert_eq!(folder.names(), ["broken.obj", "cube.obj"]);
}

#[test]
fn a_confined_run_makes_the_same() {
    let folder = Folder::with_models();
    ["in", "out"].iter().for_each(|name| fs::create_dir(folder.path(name)).unwrap());
    folder.write("in/cube.obj", CUBE);
    folder.must("render cube.obj -o a.png --size 64");
    folder.must("render in/cube.obj -o out/b.png --size 64 --sandbox=best-effort -q");
    assert_eq!(folder.read("a.png"), folder.read("out/b.png"));
    let strict = folder.run("render in/cube.obj -o out/c.png --size 64 --sandbox");
    if strict.code != 0 {
        strict.fails(2, "--sandbox=best-effort");
        println!("skipped: the system does not confine processes");
        return;
    }
    assert_eq!(folder.read("a.png"), folder.read("out/c.png"));
}

#[test]
fn one_thread_and_many_make_the_same() {
    let folder = Folder::with_models();
    for threads in [1, 3, 40] {
        folder.must(&format!("render cube.obj -o {threads}.png --size 64 --threads {threads}"));
        assert_eq!(folder.read("1.png"), folder.read(&format!("{threads}.png")));
    }
}
