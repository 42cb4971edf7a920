//! Same input, same bytes: every command that writes a file, on one, two and four threads and at each SIMD level; some
//! of them also on the processor that valgrind emulates.

use crate::harness::{Ended, Folder};
use std::path::Path;
use std::process::Command;

/// Arguments after `durer`, and the file that they write; later commands read the files of earlier
/// ones.
const COMMANDS: &[(&str, &str)] = &[
    ("render teapot.obj --item items.png --depth depth.png --normal normals.png", "a.png"),
    (
        "render teapot.obj --eye 6,3,8 --target 0,1,0 --fov 30 --near 2 --far 30 --depth depth.png",
        "front.png",
    ),
    ("render teapot.obj --aa 1 --background transparent --shadows map", "shadows.png"),
    ("render teapot.obj --aa 64", "masks.png"),
    ("render crate.glb --aa 16 --shading phong", "textured.png"),
    ("render glass.glb", "glass.png"),
    ("render glass.glb --algorithm z-buffer", "sorted.png"),
    ("render glass.glb --algorithm depth-sort", "depth_sort.png"),
    ("render glass.glb --bounces 3", "bounces.png"),
    ("render bracket.stl --algorithm scan-line-z", "scan_line_z.png"),
    ("render bracket.stl --algorithm spanning-scan-line", "spans.png"),
    ("render bracket.stl --algorithm depth-sort", "sort.png"),
    ("render bracket.stl --algorithm warnock", "warnock.png"),
    ("render bracket.stl --algorithm ray --shadows rays", "rays.png"),
    ("render bracket.stl --algorithm wireframe", "wires.png"),
    ("render bracket.stl --section 1,0,0,0", "section.png"),
    ("render bracket.stl --hidden dashed", "lines.svg"),
    ("render bracket.stl --hidden layer", "lines.pdf"),
    ("render bracket.stl --sheet third-angle", "sheet.dxf"),
    ("render bracket.stl --style wireframe", "wires.hpgl"),
    ("render bracket.stl --style shadows --hidden dashed", "shadows.gcode"),
    ("render bracket.stl --hatch shade --pen-order", "ordered.svg"),
    ("render bracket.stl --style regions", "regions.geojson"),
    ("render teapot.obj --style regions+lines", "regions.svg"),
    ("render bracket.stl --style shadows --hatch shade", "shadows.pdf"),
    ("render bracket.stl --style regions+lines", "drawn.png"),
    ("render teapot.obj --quality 80", "a.jpg"),
    ("render crate.glb --compression small", "small.png"),
    ("render glass.glb --background transparent", "a.webp"),
    ("render bracket.stl --turntable 3", "turn.png"),
    ("render glass.glb --turntable 3 --background transparent", "turn.webp"),
    ("render crate.glb --turntable 3 --fps 10", "turn.gif"),
    ("clip countries.geojson --window -10,35,30,60", "window.geojson"),
    ("clip countries.geojson --by window.geojson --op difference", "rest.geojson"),
    ("clip countries.geojson --window -10,35,30,60 --grid 0.5", "coarse.wkt"),
    ("clip countries.geojson --tiles 3", "tiles.geojsonl"),
    ("simplify countries.geojson --keep 20%", "light.geojson"),
    ("tiles countries.geojson --zoom 0-4", "map.pmtiles"),
    ("tiles countries.geojson --zoom 3 --short-way", "map.mbtiles"),
    ("draw perspective.svg", "drawn_svg.png"),
    ("draw countries.geojson --label name --fill #dde6cc --stroke #335533", "map.png"),
    ("fill map.png --at 3,3 --color red --tolerance 4", "filled.png"),
    ("plot --formula sin(x)*cos(z) --samples 61x40", "plot.svg"),
    ("plot --formula sin(x)*cos(z) --samples 61x40", "plot.png"),
    (
        "warp front.png depth.png --eye 6,3,8 --target 0,1,0 --fov 30 --near 2 --far 30 --to-eye 6.2,3,8",
        "warp.png",
    ),
];

/// Commands that also run under valgrind, which takes about fifty times as long.
const UNDER_VALGRIND: &[&str] =
    &["textured.png", "a.jpg", "turn.gif", "lines.svg", "window.geojson", "drawn_svg.png"];

/// Runs all commands; returns the bytes of all files in the folder, by name.
fn written(how: &str) -> Vec<(String, Vec<u8>)> {
    let folder = samples();
    for (command, out) in COMMANDS {
        folder.must(&format!("{} {how}", with_output(command, out)));
        assert!(folder.path(out).exists(), "{command}");
    }
    let names = folder.names().into_iter();
    names.map(|name| (name.clone(), folder.read(&name))).collect()
}

/// Returns a folder with all samples.
fn samples() -> Folder {
    let folder = Folder::new();
    let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples");
    for entry in std::fs::read_dir(samples).expect("samples are part of the repository") {
        let path = entry.expect("a file").path();
        let name = path.file_name().expect("a name").to_string_lossy();
        folder.write(&name, std::fs::read(&path).expect("a sample"));
    }
    folder
}

/// Returns a command that writes a file; pictures of models are small.
fn with_output(command: &str, out: &str) -> String {
    let painted = [".png", ".jpg", ".webp", ".gif"].iter().any(|suffix| out.ends_with(suffix));
    let pixels = command.starts_with("render") && painted;
    let size = if pixels { "--size 96x80" } else { "" };
    format!("{command} {size} -o {out}")
}

fn are_the_same_bytes(how: impl Iterator<Item = String>) {
    let expected = written("--threads 1");
    assert!(expected.len() > COMMANDS.len());
    for how in how {
        for (found, expected) in written(&how).into_iter().zip(&expected) {
            assert!(found == *expected, "{} with {how}", expected.0);
        }
    }
}

#[test]
fn all_commands_write_the_same_bytes_on_any_number_of_threads() {
    are_the_same_bytes([2, 4].map(|threads| format!("--threads {threads}")).into_iter());
}

#[test]
fn all_commands_write_the_same_bytes_at_any_simd_level() {
    let levels = durer::simd::levels();
    assert!(!levels.is_empty());
    are_the_same_bytes(levels.iter().map(|&level| format!("--simd {}", durer::simd::name(level))));
}

/// Runs commands under valgrind, which has no AVX-512, counts cycles itself, runs one thread at a time, and reports
/// reads and writes out of bounds.
#[test]
fn commands_write_the_same_bytes_under_valgrind() {
    if Command::new("valgrind").arg("--version").output().is_err() {
        println!("skipped: there is no valgrind");
        return;
    }
    let folder = samples();
    let chosen = COMMANDS.iter().filter(|(_, out)| UNDER_VALGRIND.contains(out));
    assert_eq!(chosen.clone().count(), UNDER_VALGRIND.len());
    for (command, out) in chosen {
        let arguments = with_output(command, out);
        folder.must(&arguments);
        let expected = folder.read(out);
        std::fs::remove_file(folder.path(out)).expect("was there");
        let direct = folder.command(&format!("{arguments} --threads 2"));
        // Reports of uninitialized values are false if both sides of a branch are evaluated in advance.
        let valgrind = ["-q", "--undef-value-errors=no", "--error-exitcode=99"];
        let ended = Command::new("valgrind")
            .args(valgrind)
            .arg(direct.get_program())
            .args(direct.get_args())
            .current_dir(folder.path(""))
            .output()
            .map(Ended::of)
            .expect("valgrind is there");
        assert_eq!(ended.code, 0, "{arguments}: {}", ended.err);
        assert!(folder.read(out) == expected, "{out}");
    }
}
