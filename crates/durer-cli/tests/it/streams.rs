//! Standard input and output, reports, messages.

use crate::harness::{BROKEN, CUBE, Ended, Folder, Picture};
use std::io::Write;
use std::process::Stdio;

fn piped(folder: &Folder, arguments: &str, input: &str) -> Ended {
    let mut command = folder.command(arguments);
    let mut child = command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // The command may end before it has read everything.
    let _ = child.stdin.take().unwrap().write_all(input.as_bytes());
    Ended::of(child.wait_with_output().unwrap())
}

#[test]
fn a_model_comes_in_and_a_picture_goes_out() {
    let folder = Folder::new();
    let ended = piped(&folder, "render - -o - --size 12x9", CUBE);
    assert_eq!((ended.code, ended.err.as_str()), (0, ""));
    assert_eq!(Picture::decode(&ended.out).size(), (12, 9));
    piped(&folder, "render - -o -", BROKEN).fails(1, "standard input: line 3");
    piped(&folder, "info -", "").fails(1, "standard input: ");
    assert!(folder.names().is_empty());
}

#[test]
fn a_closed_pipe_ends_quietly() {
    let folder = Folder::with_models();
    for arguments in [
        "render cube.obj -o - --size 512x512 --background gradient",
        "man",
        "info cube.obj",
        "--help",
        "--version",
    ] {
        let mut command = folder.command(arguments);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let ended = Ended::of(child.wait_with_output().unwrap());
        assert_eq!((ended.code, ended.err.as_str()), (0, ""), "{arguments}");
    }
}

#[test]
fn a_full_standard_output_is_reported() {
    let full = || std::fs::OpenOptions::new().write(true).open("/dev/full");
    let folder = Folder::with_models();
    for arguments in
        ["--help", "-h", "--version", "help", "help fill", "render --help", "man", "info cube.obj"]
    {
        let Ok(full) = full() else { return };
        let ended = Ended::of(folder.command(arguments).stdout(full).output().unwrap());
        assert_eq!(ended.code, 1, "{arguments}");
        assert_eq!(ended.err, "durer: standard output: No space left on device\n", "{arguments}");
    }
    assert!(folder.must("--version").out.starts_with(b"durer "));
    folder.run("--nonsense").fails(2, "--nonsense");
}

#[test]
fn the_report_is_json() {
    let folder = Folder::with_models();
    let report = folder.must("render cube.obj -o a.png --size 8x8 --depth d.png --json").json();
    let picture = &report["models"][0]["pictures"][0];
    assert_eq!(picture["triangles"]["in"], 12);
    assert_eq!(picture["files"].as_array().unwrap().len(), 2);
    for time in ["geometry_seconds", "raster_seconds", "encode_seconds"] {
        assert!(picture[time].as_f64().unwrap() >= 0.0, "{time}");
    }
    assert!(report["models"][0]["read_seconds"].is_f64());
    folder.run("render cube.obj -o - --json").fails(2, "--json");
}

#[test]
fn info_tells_the_same_in_words_and_in_json() {
    let folder = Folder::with_models();
    let info = folder.must("info cube.obj --json").json();
    assert_eq!((&info["triangles"], &info["vertices"]), (&12.into(), &8.into()));
    assert_eq!(info["bounds"]["min"], serde_json::json!([-1.0, -1.0, -1.0]));
    assert_eq!((&info["area"], &info["closed"]), (&24.0.into(), &true.into()));
    let text = String::from_utf8(folder.must("info cube.obj").out).unwrap();
    for part in ["cube.obj", "triangles   12", "(-1, -1, -1)", "area        24", "closed      yes"]
    {
        assert!(text.contains(part), "{part} is missing in {text}");
    }
    let both = folder.must("info cube.obj cube.obj --json").json();
    assert_eq!(both.as_array().unwrap().len(), 2);
    folder.run("info broken.obj").fails(1, "broken.obj: line 3");
}

#[test]
fn warnings_are_few_unless_all_are_wanted() {
    let folder = Folder::with_models();
    // Each of these faces uses a missing material, so that there are many warnings.
    let many: String = (0..20).map(|i| format!("usemtl none{i}\nf 1 2 3\n")).collect();
    folder.write("many.obj", format!("mtllib none.mtl\n{CUBE}{many}"));
    let lines = |options: &str| {
        let ended = folder.must(&format!("render many.obj -o a.png --size 8x8 {options}"));
        ended.err.lines().filter(|l| l.starts_with("durer: warning: many.obj: ")).count()
    };
    let (few, all, none) = (lines(""), lines("-v"), lines("-q"));
    assert!((1..=6).contains(&few) && all >= few && none == 0, "{few}, {all}, {none}");
}

#[test]
fn bodies_with_divided_edges_are_closed() {
    let folder = Folder::with_models();
    // Only one side of the front's lower edge is divided.
    let divided = CUBE.replace("f 4 3 2 1\n", "v 0 -1 -1\nf 4 3 2 9\nf 4 9 1\n");
    folder.write("divided.obj", &divided);
    folder.write("open.obj", divided.replace("f 4 9 1\n", ""));
    let closed = |name: &str| folder.must(&format!("info {name} --json")).json()["closed"].clone();
    assert_eq!((closed("divided.obj"), closed("open.obj")), (true.into(), false.into()));
}
