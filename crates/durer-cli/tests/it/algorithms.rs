//! Algorithms, shadows, mirrors, and pictures from pictures.

use crate::harness::{Folder, Picture};

/// A red pane before a blue one that blends, as OBJ with its materials.
fn write_glass(folder: &Folder) {
    folder.write(
        "glass.obj",
        "mtllib glass.mtl\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nv -1 -1 -1\nv 1 -1 -1\nv 0 1 -1\n\
         usemtl red\nf 1 2 3\nusemtl blue\nf 4 5 6\n",
    );
    folder.write("glass.mtl", "newmtl red\nKd 1 0 0\nd 0.5\nnewmtl blue\nKd 0 0 1\n");
}

#[test]
fn a_sheet_of_all_algorithms_has_no_differences() {
    let folder = Folder::with_models();
    let ended = folder.must("render cube.obj -o all.png --algorithm all --size 80x60 --json");
    let report = &ended.json()["models"][0]["pictures"][0];
    let compared = report["compared"].as_array().unwrap();
    assert_eq!(compared.len(), 7, "{compared:?}");
    for c in compared {
        assert_eq!(c["differing_pixels"], 0, "{c}");
    }
    assert_eq!(
        (&report["algorithm"], &compared[0]["algorithm"]),
        (&"all".into(), &"z-buffer".into())
    );
    let sheet = Picture::decode(&folder.read("all.png"));
    assert!(sheet.width >= 3 * 80 && sheet.height >= 2 * 60, "{:?}", sheet.size());
    assert_eq!(report["width"], sheet.width);
    // Below the first picture there is ink.
    let dark = (8..88).flat_map(|x| (68..110).map(move |y| (x, y)));
    assert!(dark.filter(|&(x, y)| sheet.pixel(x, y)[0] < 80).count() > 60);
}

#[test]
fn the_algorithm_follows_from_the_options() {
    let folder = Folder::with_models();
    write_glass(&folder);
    let algorithm = |options: &str| {
        let ended = folder.must(&format!("render {options} -o a.png --size 32x32 --json"));
        ended.json()["models"][0]["pictures"][0]["algorithm"].as_str().unwrap().to_owned()
    };
    for (options, expected) in [
        ("cube.obj", "z-buffer"),
        ("glass.obj", "z-buffer"),
        ("glass.obj --algorithm a-buffer", "a-buffer"),
        ("cube.obj --aa 64", "a-buffer"),
        ("cube.obj --shadows map", "z-buffer"),
        ("cube.obj --shadows rays", "ray"),
        ("cube.obj --bounces 2", "ray"),
        ("cube.obj --algorithm wireframe", "wireframe"),
    ] {
        assert_eq!(algorithm(options), expected, "{options}");
    }
}

#[test]
fn all_algorithms_show_what_is_behind_glass() {
    let folder = Folder::with_models();
    write_glass(&folder);
    let picture = |algorithm: &str| {
        let options = format!("--algorithm {algorithm} --aa 1 --size 32x32");
        let ended = folder.must(&format!("render glass.obj -o {algorithm}.png {options}"));
        assert!(ended.err.is_empty(), "{algorithm}: {}", ended.err);
        folder.read(&format!("{algorithm}.png"))
    };
    let expected = picture("z-buffer");
    for algorithm in ["scan-line-z", "spanning-scan-line", "depth-sort", "warnock", "ray"] {
        assert!(picture(algorithm) == expected, "{algorithm}");
    }
}

#[test]
fn what_an_algorithm_cannot_do_is_a_usage_error() {
    let folder = Folder::with_models();
    for (options, part) in [
        ("--algorithm warnock --bounces 1", "--bounces"),
        ("--algorithm z-buffer --shadows rays", "--shadows map"),
        ("--algorithm warnock --aa 64", "--aa 64"),
        ("--aa 64 --bounces 1", "--aa 64"),
        ("--algorithm all --viewports front,top", "--viewports"),
        ("--algorithm all --item i.png", "--item"),
        ("--algorithm nonsense", "spanning-scan-line"),
        ("--bounces 33", "33"),
    ] {
        folder.run(&format!("render cube.obj -o a.png {options}")).fails(2, part);
        assert!(!folder.names().contains(&"a.png".to_owned()), "{options}");
    }
}

#[test]
fn a_warped_picture_is_nearly_the_rendered_one() {
    let folder = Folder::with_models();
    let lens = "--near 4 --far 12";
    let render = |eye: &str, name: &str| {
        folder.must(&format!(
            "render cube.obj -o {name}.png --depth {name}_d.png --eye {eye} {lens} --size 100x80 --aa 1 --shading unlit"
        ));
    };
    render("0,3,7 --target 0,0,0", "a");
    render("0.3,3.1,7 --target 0.3,0.1,0", "b");
    let warp = |more: &str| {
        folder
            .must(&format!(
                "warp a.png a_d.png -o w.png --eye 0,3,7 --target 0,0,0 {lens} --to-eye 0.3,3.1,7 --to-target 0.3,0.1,0 --json {more}"
            ))
            .json()
    };
    let report = warp("");
    assert_eq!((&report["width"], &report["filled"]), (&100.into(), &0.into()));
    let (warped, right) =
        (Picture::decode(&folder.read("w.png")), Picture::decode(&folder.read("b.png")));
    let pairs = warped.pixels().zip(right.pixels());
    let differing = pairs.filter(|(a, b)| a[..3] != b[..3]).count() as u64;
    let holes = report["holes"].as_u64().unwrap();
    // Holes are where surfaces come out from behind the cube. The camera does not turn, so no background enters at the
    // border.
    assert!(holes > 0 && holes < 500, "{holes}");
    assert!(holes <= differing && differing < holes + 100, "{holes} {differing}");
    // Warped from the target camera itself, the second picture leaves no hole.
    let report = warp("--fill b.png b_d.png --fill-eye 0.3,3.1,7 --fill-target 0.3,0.1,0");
    assert_eq!(report["holes"], 0);
    // It also fills pixels along outlines for which the first picture has no surface.
    let filled = report["filled"].as_u64().unwrap();
    assert!(filled >= holes && filled < holes + 20, "{filled} {holes}");
}

#[test]
fn warp_says_what_is_wrong_with_its_input() {
    let folder = Folder::with_models();
    folder.must("render cube.obj -o a.png --depth d.png --size 20x20");
    folder.must("render cube.obj -o b.png --depth e.png --size 21x20");
    let run = |files: &str, options: &str| {
        folder.run(&format!(
            "warp {files} -o w.png --eye 0,0,9 --target 0,0,0 --near 1 --far 20 {options}"
        ))
    };
    run("a.png e.png", "--fov 30 --to-eye 0,0,8").fails(1, "20x20");
    run("a.png b.png", "--fov 30 --to-eye 0,0,8").fails(1, "16-bit");
    run("a.png none.png", "--fov 30 --to-eye 0,0,8").fails(1, "none.png");
    run("a.png d.png", "--fov 30 --to-eye 0,0,0").fails(2, "--to-eye");
    run("a.png d.png", "--fov 30 --ortho 2 --to-eye 0,0,8").fails(2, "--ortho");
    assert!(!folder.names().contains(&"w.png".to_owned()));
}

#[test]
fn algorithms_are_classified_from_their_facts() {
    let folder = Folder::new();
    let names = |arguments: &str| -> Vec<String> {
        let list = folder.must(&format!("algorithms --json {arguments}")).json();
        let name = |printed: &serde_json::Value| printed["name"].as_str().unwrap().to_owned();
        list.as_array().unwrap().iter().map(name).collect()
    };
    let all = names("");
    assert_eq!(all.len(), durer::explain::ALGORITHMS.len());
    let lines = ["spanning-scan-line", "watkins", "csg-scan-line", "horizon-curves"];
    assert_eq!(names("--space image --occluder line"), lines);
    let lists = ["depth-sort", "painter", "depth-sort-polygons", "bsp-tree"];
    assert_eq!(names("--space list-priority"), lists);
    assert_eq!(
        names("--coherence span --coherence scan-line --occluder none Romney"),
        ["edge-table"]
    );
    assert!(names("no-such-algorithm").is_empty());
    let text = String::from_utf8(folder.must("algorithms warnock").out).unwrap();
    let row = ["warnock", "image", "area", "area", "1969", "Warnock's", "area", "subdivision"];
    assert_eq!(text.lines().nth(1).unwrap().split_whitespace().collect::<Vec<_>>(), row);
    folder.run("algorithms --space picture").fails(2, "object, list-priority, image");
}
