//! Files that remain when the command is killed.

use crate::harness::{Folder, Picture};
use std::io::{Read, Write};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

fn signal(child: &Child, name: &str) {
    let kill = Command::new("kill").args(["-s", name, &child.id().to_string()]).status();
    assert!(kill.unwrap().success());
}

/// Checks that the command, killed at any moment, leaves either the old picture or the new one.
#[test]
fn killed_half_way_leaves_the_old_picture_or_the_new_one() {
    let folder = Folder::with_models();
    folder.write("out.png", "old");
    for milliseconds in [0, 5, 10, 20, 40, 60, 80, 120, 160, 320] {
        let mut child =
            folder.command("render cube.obj -o out.png --size 1500x1500").spawn().unwrap();
        std::thread::sleep(Duration::from_millis(milliseconds));
        signal(&child, "KILL");
        child.wait().unwrap();
        let bytes = folder.read("out.png");
        if bytes != b"old" {
            assert_eq!(Picture::decode(&bytes).size(), (1500, 1500), "after {milliseconds} ms");
        }
    }
}

/// Checks that a reader of lines removes its unfinished file when it is interrupted while waiting for input.
#[test]
fn interrupted_leaves_nothing_behind() {
    for (name, code) in [("INT", 130), ("TERM", 143)] {
        let folder = Folder::new();
        folder.write("out.geojsonl", "old");
        let command = "clip - --from geojsonl --to geojsonl --window 0,0,9,9 -o out.geojsonl";
        let mut child = folder.command(command).stdin(Stdio::piped()).spawn().unwrap();
        let mut input = child.stdin.take().unwrap();
        let feature =
            r#"{"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[1,2]}}"#;
        // More features than are read before the first is written.
        input.write_all(format!("{feature}\n").repeat(10_000).as_bytes()).unwrap();
        let begun = || folder.names().iter().any(|n| n.ends_with(".tmp"));
        let waited = (0..500).any(|_| {
            std::thread::sleep(Duration::from_millis(10));
            begun()
        });
        assert!(waited, "no file was begun: {:?}", folder.names());
        signal(&child, name);
        assert_eq!(child.wait().unwrap().code(), Some(code), "{name}");
        assert_eq!(folder.names(), ["out.geojsonl"], "{name}");
        assert_eq!(folder.read("out.geojsonl"), b"old");
    }
}

/// Checks that the reader of the picture may stop in its middle.
#[test]
fn a_reader_that_leaves_is_no_error() {
    let folder = Folder::with_models();
    let command = "render cube.obj -o - --size 1500x1500 --background #010203,#f0e0d0";
    let mut child =
        folder.command(command).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut out = child.stdout.take().unwrap();
    out.read_exact(&mut [0; 100]).unwrap();
    drop(out);
    let mut printed = String::new();
    child.stderr.take().unwrap().read_to_string(&mut printed).unwrap();
    assert_eq!((child.wait().unwrap().code(), printed.as_str()), (Some(0), ""));
}
