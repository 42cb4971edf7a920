//! Faces turned inwards or against their neighbours: `info` reports them, `render --orient` turns them.

use crate::harness::Folder;

/// A cube of edge 2 around the origin, all faces turned outwards.
const CUBE: &str = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n\
                    f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

/// The same cube with its first faces turned inwards.
fn turned(count: usize) -> String {
    let mut left = count;
    let line = |line: &str| {
        let Some(face) = line.strip_prefix("f ").filter(|_| left > 0) else {
            return line.to_owned();
        };
        left -= 1;
        let corners: Vec<&str> = face.split(' ').rev().collect();
        format!("f {}", corners.join(" "))
    };
    let lines: Vec<String> = CUBE.lines().map(line).collect();
    lines.join("\n") + "\n"
}

#[test]
fn info_reports_bodies_inside_out_and_flipped_faces() {
    let folder = Folder::new();
    for (name, faces, inside_out, flipped, words) in [
        ("right.obj", 0, 0, 0, ""),
        ("one.obj", 1, 0, 1, "1 face flipped"),
        ("three.obj", 3, 0, 3, "3 faces flipped"),
        ("four.obj", 4, 1, 2, "inside out, 2 faces flipped"),
        ("all.obj", 6, 1, 0, "inside out"),
    ] {
        folder.write(name, turned(faces));
        let json = folder.must(&format!("info {name} --json")).json();
        assert_eq!(
            (&json["inside_out"], &json["flipped"]),
            (&inside_out.into(), &flipped.into()),
            "{name}"
        );
        let text = String::from_utf8(folder.must(&format!("info {name}")).out).expect("text");
        let printed = text.lines().find(|line| line.trim_start().starts_with("faces "));
        assert_eq!(printed.map_or("", |line| line.trim_start()[5..].trim()), words, "{name}");
    }
}

#[test]
fn orient_makes_the_picture_of_the_right_body() {
    let folder = Folder::new();
    let picture = |name: &str, options: &str| {
        folder
            .must(&format!("render {name} -o o.png --size 60x60 --view iso --cull back {options}"));
        folder.read("o.png")
    };
    folder.write("right.obj", CUBE);
    let expected = picture("right.obj", "");
    assert_eq!(picture("right.obj", "--orient"), expected);
    for faces in [2, 3, 4, 6] {
        folder.write("wrong.obj", turned(faces));
        assert_ne!(picture("wrong.obj", ""), expected, "{faces}");
        assert_eq!(picture("wrong.obj", "--orient"), expected, "{faces}");
    }
}
