//! Sizes with one number, and with one dimension left open.

use crate::harness::{Folder, Picture};

/// A plate of 4 × 1, the longer side along x; 2 deep.
const PLATE: &str = "\
v -2 0 -1\nv 2 0 -1\nv 2 0 1\nv -2 0 1\nv -2 1 -1\nv 2 1 -1\nv 2 1 1\nv -2 1 1
f 1 2 3 4\nf 8 7 6 5\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n";

fn size(folder: &Folder, options: &str) -> (u32, u32) {
    folder.must(&format!("render plate.obj -o a.png {options}"));
    Picture::decode(&folder.read("a.png")).size()
}

fn with_plate() -> Folder {
    let folder = Folder::new();
    folder.write("plate.obj", PLATE);
    folder
}

#[test]
fn an_open_side_follows_the_outline() {
    let folder = with_plate();
    assert_eq!(size(&folder, "--size 33"), (33, 33));
    let front = "--view front --ortho fit";
    assert_eq!(size(&folder, &format!("--size 80x {front}")), (80, 20));
    assert_eq!(size(&folder, &format!("--size x30 {front}")), (120, 30));
    assert_eq!(size(&folder, "--size 80x --view top --ortho fit"), (80, 40));
    assert_eq!(size(&folder, "--size x40 --view right --ortho fit"), (80, 40));
    // Turned, it is as wide as its diagonal.
    let turned = size(&folder, "--size x40 --azimuth 0 --ortho fit --turntable 2");
    assert_eq!(turned, ((20f64.sqrt() * 40.0).round() as u32, 40));
    assert_eq!(size(&folder, "--size 80x --view front --style hidden-line"), (80, 20));
}

#[test]
fn in_perspective_too_the_model_fills_both_ways() {
    let folder = with_plate();
    for view in ["iso", "front", "top"] {
        let (width, height) = size(&folder, &format!("--size 200x --view {view}"));
        let picture = Picture::decode(&folder.read("a.png"));
        let seen = |x: u32, y: u32| picture.pixel(x, y) != [255; 3];
        let columns: Vec<u32> = (0..width).filter(|&x| (0..height).any(|y| seen(x, y))).collect();
        let rows: Vec<u32> = (0..height).filter(|&y| (0..width).any(|x| seen(x, y))).collect();
        let share =
            |some: &[u32], all: u32| f64::from(some[some.len() - 1] - some[0] + 1) / f64::from(all);
        let (across, down) = (share(&columns, width), share(&rows, height));
        assert!(across > 0.9 && down > 0.9, "{view}: {width}x{height}, {across} {down}");
    }
}

#[test]
fn other_shapes_are_those_of_cells_pages_and_cameras() {
    let folder = with_plate();
    assert_eq!(size(&folder, "--size 90x --viewports 3x1:front,right,iso"), (90, 30));
    assert_eq!(size(&folder, "--size x50 --viewports front,top,right,iso"), (50, 50));
    assert_eq!(size(&folder, "--size x50 --eye 3,4,5"), (50, 50));
    assert_eq!(size(&folder, "--size 60x --style hidden-line --page 300x200"), (60, 40));
    folder.write(
        "c.gltf",
        r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"camera":0,
        "translation":[0,0,5]}],"cameras":[{"name":"C","type":"perspective",
        "perspective":{"yfov":1,"znear":0.1,"zfar":9,"aspectRatio":2.5}}]}"#,
    );
    folder.must("render c.gltf --camera C --size 100x -o c.png");
    assert_eq!(Picture::decode(&folder.read("c.png")).size(), (100, 40));
}

#[test]
fn sizes_that_follow_are_limited_too() {
    let folder = with_plate();
    let ended = folder.run("render plate.obj -o a.png --size 800x --max-pixels 100000");
    ended.fails(2, "--max-pixels");
    folder.run("render plate.obj -o a.png --size x").fails(2, "1920x or x1080");
}

#[test]
fn picks_warps_and_plots_know_open_sides() {
    let folder = with_plate();
    // In a square picture the plate takes the middle quarter of the height.
    let picked = |size: &str, at: &str| {
        let pick =
            format!("pick plate.obj --at {at} --size {size} --view front --ortho fit --json");
        folder.must(&pick).json()["triangles"].as_array().unwrap().len()
    };
    assert!(picked("80x", "40,2") > 0 && picked("80x80", "40,42") > 0);
    assert_eq!((picked("80x", "40,22"), picked("80x80", "40,22")), (0, 0));
    let camera = "--eye 0,0,9 --target 0,0,0 --fov 40 --near 1 --far 20";
    folder.must(&format!("render plate.obj -o a.png --depth d.png --size 40x20 {camera}"));
    folder.must(&format!("warp a.png d.png -o w.png {camera} --to-eye 0,1,9 --size x10"));
    assert_eq!(Picture::decode(&folder.read("w.png")).size(), (20, 10));
    folder.must("plot --formula x*z -o p.png --page 30x20 --size 90x");
    assert_eq!(Picture::decode(&folder.read("p.png")).size(), (90, 60));
}

/// Returns the rows of a picture assembled from tiles, which are given by their positions.
fn joined(folder: &Folder, tiles: &[[u32; 4]], [width, height]: [u32; 2]) -> Vec<Vec<u8>> {
    let mut found = vec![Vec::new(); (width * height) as usize];
    for (number, &[x, y, w, h]) in tiles.iter().enumerate() {
        let tile = Picture::decode(&folder.read(&format!("out/{number}.png")));
        assert_eq!(tile.size(), (w, h));
        for (column, row) in (0..h).flat_map(|row| (0..w).map(move |column| (column, row))) {
            found[((y + row) * width + x + column) as usize] = tile.pixel(column, row).to_vec();
        }
    }
    found
}

#[test]
fn tiles_joined_are_the_picture() {
    let folder = with_plate();
    let look = "--size 100x --view iso --background black,white --aa 4 --ground";
    folder.must(&format!("render plate.obj -o whole.png {look}"));
    let whole = Picture::decode(&folder.read("whole.png"));
    let (width, height) = whole.size();
    let tiles = [[70, 0, width - 70, height], [0, 33, 70, height - 33], [0, 0, 70, 33]];
    let row =
        |(i, [x, y, w, h]): (usize, &[u32; 4])| format!("{i},plate.obj,\"{x},{y},{w},{h}\"\n");
    let rows: String = tiles.iter().enumerate().map(row).collect();
    folder.write("rows.csv", format!("id,input,tile\n{rows}"));
    folder.must(&format!("batch rows.csv -o out -q -- render {look}"));
    let found = joined(&folder, &tiles, [width, height]);
    assert!(found.iter().map(Vec::as_slice).eq(whole.pixels()));
    // The first tile again, with its planes.
    let planes = "--tile 70,0,30,8 --item i.png --depth d.png --normal n.png";
    folder.must(&format!("render plate.obj -o a.png {look} {planes}"));
    for name in ["a.png", "i.png", "d.png", "n.png"] {
        assert_eq!(Picture::decode(&folder.read(name)).size(), (30, 8), "{name}");
    }
}

#[test]
fn a_tile_may_be_of_a_picture_that_is_too_large_itself() {
    let folder = with_plate();
    let large = "render plate.obj -o a.png --size 100000 --max-memory 64M";
    folder.run(large).fails(2, "--max-pixels");
    folder.must(&format!("{large} --tile 50000,50000,20,10"));
    assert_eq!(Picture::decode(&folder.read("a.png")).size(), (20, 10));
    // A blank sheet, without a warning that nothing is visible.
    let ended = folder.must(&format!("{large} --tile 0,0,20,10"));
    assert_eq!(ended.err, "");
    for (options, error) in [
        ("--tile 1,2,3", "X,Y,WIDTH,HEIGHT"),
        ("--tile 0,0,0,5", "X,Y,WIDTH,HEIGHT"),
        ("--size 64 --tile 60,0,5,5", "it ends at 65,5, beyond the picture of 64x64 pixels"),
        ("--size 80x --view front --ortho fit --tile 0,0,80,21", "beyond the picture of 80x20"),
        ("--tile 0,0,5,5 --algorithm wireframe", "--tile: the algorithm wireframe"),
        ("--tile 0,0,5,5 --algorithm depth-sort", "--tile: the algorithm depth-sort"),
        ("--tile 0,0,5,5 --algorithm all", "--tile: --algorithm all"),
        ("--tile 0,0,5,5 --edges", "--tile: --edges"),
        ("--tile 0,0,5,5 --look studio", "--tile: --ambient-occlusion"),
        ("--tile 0,0,5,5 --style regions", "--tile"),
        ("--tile 0,0,5,5 --viewports front,top", "cannot be used with"),
        ("--size 140000 --tile 0,0,5,5", "131,072"),
    ] {
        folder.run(&format!("render plate.obj -o b.png {options}")).fails(2, error);
    }
    assert!(!folder.path("b.png").exists());
}

#[test]
fn edges_have_a_largest_picture() {
    let folder = Folder::with_models();
    for options in ["--size 40000x2 --edges", "--size 2x32768 --look technical"] {
        folder
            .run(&format!("render cube.obj -o a.png {options}"))
            .fails(2, "at most 32767 pixels a side");
    }
    assert!(!folder.path("a.png").exists());
}
