//! The contents of pictures.

use crate::harness::{Folder, Picture};

fn render(folder: &Folder, options: &str) -> Picture {
    folder.must(&format!("render cube.obj -o a.png {options}"));
    Picture::decode(&folder.read("a.png"))
}

#[test]
fn a_cube_is_in_the_middle_and_not_at_the_border() {
    let folder = Folder::with_models();
    for view in ["iso", "front", "back", "left", "right", "top", "bottom"] {
        let picture = render(&folder, &format!("--size 64x48 --view {view}"));
        assert_eq!(picture.channels, 3, "white is opaque");
        assert!(picture.pixel(32, 24) != [255; 3], "{view}");
        let border =
            (0..64).flat_map(|x| [(x, 0), (x, 47)]).chain((0..48).flat_map(|y| [(0, y), (63, y)]));
        assert!(border.into_iter().all(|(x, y)| picture.pixel(x, y) == [255; 3]), "{view}");
    }
}

#[test]
fn backgrounds_are_those_requested() {
    let folder = Folder::with_models();
    let corner = |background: &str| {
        let picture = render(&folder, &format!("--size 32x32 --background {background}"));
        (picture.pixel(0, 0).to_vec(), picture.pixel(0, 31).to_vec())
    };
    assert_eq!(corner("#123456"), (vec![0x12, 0x34, 0x56], vec![0x12, 0x34, 0x56]));
    assert_eq!(corner("transparent").0[3], 0);
    let (top, bottom) = corner("white,black");
    assert!(top[0] > 240 && bottom[0] < 60, "{top:?} {bottom:?}");
}

#[test]
fn items_are_triangles_in_file_order() {
    let folder = Folder::with_models();
    // Face 2 is seen from +z: triangles 2 and 3, separated by the diagonal from its first vertex.
    render(&folder, "--size 64x64 --view front --item i.png");
    let items = Picture::decode(&folder.read("i.png"));
    assert_eq!(items.pixel(0, 0), [255; 3]);
    assert_eq!(items.pixel(40, 48), [0, 0, 2], "the first corner's fan: lower right");
    assert_eq!(items.pixel(20, 16), [0, 0, 3], "then upper left");
}

#[test]
fn depths_follow_near_and_far() {
    let folder = Folder::with_models();
    render(
        &folder,
        "--size 33x33 --eye 0,0,5 --target 0,0,0 --ortho 4 --near 2 --far 10 --depth d.png",
    );
    let depth = Picture::decode(&folder.read("d.png"));
    let at = |x, y| u16::from_be_bytes(depth.pixel(x, y).try_into().unwrap());
    assert_eq!(at(0, 0), 65535);
    // The face z = 1 is 4 away: (4 − 2) / (10 − 2) of the range.
    assert!(at(16, 16).abs_diff(16384) <= 1, "{}", at(16, 16));
}

#[test]
fn normals_are_those_of_the_world() {
    let folder = Folder::with_models();
    render(&folder, "--size 32x32 --view top --normal n.png");
    let normals = Picture::decode(&folder.read("n.png"));
    assert_eq!(normals.pixel(16, 16), [128, 255, 128]);
    assert_eq!(normals.pixel(0, 0), [128; 3]);
}

#[test]
fn viewports_are_pasted_side_by_side() {
    let folder = Folder::with_models();
    let sheet = render(&folder, "--size 65x64 --viewports front,top,side,iso --item i.png");
    assert_eq!(sheet.size(), (65, 64));
    let items = Picture::decode(&folder.read("i.png"));
    let item = |x, y| items.pixel(x, y)[2] / 2;
    assert_eq!([item(16, 16), item(48, 16), item(16, 48)], [1, 4, 3], "faces +z, +y, +x");
    let front = render(&folder, "--size 32x32 --view front");
    let same = (0..32).all(|y| (0..32).all(|x| front.pixel(x, y) == sheet.pixel(x, y)));
    assert!(same, "a viewport is the picture of its size");
}

#[test]
fn turntables_turn() {
    let folder = Folder::with_models();
    folder
        .must("render cube.obj -o t%d.png --turntable 4 --view front --size 32x32 --item i%d.png");
    let item = |n: u32| Picture::decode(&folder.read(&format!("i{n}.png"))).pixel(16, 20)[2] / 2;
    // Front +z, right +x, back −z, left −x.
    assert_eq!([item(0), item(1), item(2), item(3)], [1, 3, 0, 5]);
}

#[test]
fn a_given_eye_turns_too() {
    let folder = Folder::with_models();
    folder.must(
        "render cube.obj -o t%d.png --turntable 4 --eye 0,0,6 --target 0,0,0 --size 32x32 --item i%d.png",
    );
    let item = |n: u32| Picture::decode(&folder.read(&format!("i{n}.png"))).pixel(16, 20)[2] / 2;
    assert_eq!([item(0), item(1), item(2), item(3)], [1, 3, 0, 5]);
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let folder = Folder::with_models();
    let options = "render cube.obj --size 300x200 --background gradient --aa 16 --item i.png";
    folder.must(&format!("{options} -o a.png --threads 1"));
    let items = folder.read("i.png");
    for threads in ["--threads 2", "--threads 7", ""] {
        folder.must(&format!("{options} -o b.png {threads}"));
        assert!(folder.read("a.png") == folder.read("b.png") && folder.read("i.png") == items);
    }
}

#[test]
fn every_look_gives_a_picture() {
    let folder = Folder::with_models();
    let mut seen = Vec::new();
    for look in [
        "--shading flat",
        "--shading gouraud",
        "--shading phong",
        "--shading metallic-roughness",
        "--shading unlit",
        "--light ambient:red",
        "--light point:0,0,4:blue:9 --light directional:-1,-1,-1",
        "--light spot:0,0,4:0,0,-1:20:white:16 --view front",
        "--cull back",
        "--aa 1",
        "--ortho fit",
        "--up-axis z",
        "--compression small",
    ] {
        let picture = render(&folder, &format!("--size 32x32 {look}"));
        assert!(picture.shows_something(), "{look}");
        seen.push(picture.data);
    }
    assert_ne!(seen[4], seen[5]);
    let red = render(&folder, "--size 32x32 --light ambient:red");
    let center = red.pixel(16, 16);
    assert!(center[0] > 100 && center[1] == 0 && center[2] == 0, "{center:?}");
}
