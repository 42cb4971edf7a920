//! Files that a model refers to are read only from its own folder.

use crate::harness::{CUBE, Ended, Folder};
use std::fs;
use std::process::Stdio;

/// Returns a triangle whose positions are in a separate file.
fn gltf(uri: &str) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}}],
        "buffers":[{{"byteLength":36,"uri":"{uri}"}}]}}"#
    )
}

fn positions() -> Vec<u8> {
    [0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().flat_map(|v| v.to_le_bytes()).collect()
}

/// Returns a folder with `model/` and a file beside it that must not be read.
fn folder() -> Folder {
    let folder = Folder::new();
    fs::create_dir_all(folder.path("model/sub")).unwrap();
    folder.write("secret.bin", positions());
    folder.write("model/ok.bin", positions());
    folder.write("model/sub/a b.bin", positions());
    folder
}

#[test]
fn files_in_the_folder_are_found() {
    let folder = folder();
    for uri in ["ok.bin", "sub/a%20b.bin", "./ok.bin"] {
        folder.write("model/m.gltf", gltf(uri));
        folder.must("info model/m.gltf");
        assert!(folder.must("render model/m.gltf -o a.png --size 8x8").err.is_empty(), "{uri}");
    }
}

#[test]
fn files_outside_of_the_folder_are_not() {
    let folder = folder();
    let absolute = folder.path("secret.bin").display().to_string();
    let uris = ["../secret.bin", "..%2Fsecret.bin", "sub/../../secret.bin", &absolute];
    for uri in uris {
        folder.write("model/m.gltf", gltf(uri));
        let ended = folder.run("info model/m.gltf");
        assert!(ended.code == 1 && ended.err.contains("secret.bin"), "{uri}: {ended:?}");
    }
    for uri in ["https://example.org/a.bin", "file:///etc/hostname", "missing.bin", "sub"] {
        folder.write("model/m.gltf", gltf(uri));
        let ended = folder.run("info model/m.gltf");
        assert!(ended.code == 1 && ended.err.contains(uri), "{uri}: {ended:?}");
    }
}

#[cfg(unix)]
#[test]
fn links_do_not_lead_out_of_the_folder() {
    let folder = folder();
    std::os::unix::fs::symlink("../secret.bin", folder.path("model/link.bin")).unwrap();
    std::os::unix::fs::symlink("ok.bin", folder.path("model/inner.bin")).unwrap();
    folder.write("model/m.gltf", gltf("link.bin"));
    folder.run("info model/m.gltf").fails(1, "outside the model's folder");
    folder.run("info model/m.gltf").fails(1, "--root allows a wider one");
    folder.must("info model/m.gltf --root .");
    folder.write("model/m.gltf", gltf("inner.bin"));
    folder.must("info model/m.gltf");
}

/// Returns a triangle whose picture has the given address.
fn pictured(uri: &str) -> String {
    gltf("ok.bin").replacen(
        '{',
        &format!(
            r#"{{"images":[{{"uri":"{uri}"}}],"textures":[{{"source":0}}],
            "materials":[{{"emissiveTexture":{{"index":0}}}}],"#
        ),
        1,
    )
}

/// A PNG of one texel.
fn png(folder: &Folder, name: &str) {
    folder.write("one.obj", CUBE);
    folder.must("render one.obj -o one.png --size 1x1");
    folder.write(name, folder.read("one.png"));
}

#[test]
fn a_picture_outside_of_the_folder_is_left_out() {
    let folder = folder();
    png(&folder, "secret.png");
    for uri in [
        "../secret.png",
        "..\\\\secret.png",
        "/secret.png",
        "http://h/secret.png",
        "C:\\\\secret.png",
    ] {
        folder.write("model/m.gltf", pictured(uri));
        let ended = folder.must("info model/m.gltf --json");
        let warnings = ended.json()["warnings"].to_string();
        assert!(
            warnings.contains("secret.png") && warnings.contains("drawn white"),
            "{uri}: {warnings}"
        );
    }
}

#[test]
fn the_root_widens_where_references_lead() {
    let folder = folder();
    png(&folder, "secret.png");
    let absolute = folder.path("secret.bin").display().to_string();
    for uri in
        ["../secret.bin", "..%2Fsecret.bin", "..\\\\secret.bin", "sub/../../secret.bin", &absolute]
    {
        folder.write("model/m.gltf", gltf(uri));
        folder.run("info model/m.gltf").fails(1, "secret.bin");
        folder.run("info model/m.gltf --root model").fails(1, "secret.bin");
        folder.must("info model/m.gltf --root .");
    }
    folder.write("model/m.gltf", pictured("../secret.png"));
    assert!(folder.must("render model/m.gltf -o a.png --size 8x8 --root .").err.is_empty());
    folder.write("model/m.gltf", gltf("../../../../../../etc/hostname"));
    folder.run("info model/m.gltf --root .").fails(1, "hostname");
    folder.run("info model/m.gltf --root nowhere").fails(1, "--root nowhere: ");
    folder.run("info model/m.gltf --root secret.bin").fails(1, "it is not a folder");
    // The model's own folder remains allowed.
    folder.write("model/m.gltf", gltf("ok.bin"));
    fs::create_dir_all(folder.path("other")).unwrap();
    folder.must("info model/m.gltf --root other");
}

#[test]
fn what_a_model_from_standard_input_refers_to_is_below_the_root() {
    use std::io::Write;
    let folder = folder();
    for (options, code) in [("", 1), (" --root model", 0), (" --root other", 1)] {
        let mut command = folder.command(&format!("info -{options}"));
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        // Only on systems whose root is a folder.
        let _ = child.stdin.take().unwrap().write_all(gltf("sub/a%20b.bin").as_bytes());
        let ended = Ended::of(child.wait_with_output().unwrap());
        assert_eq!(ended.code, code, "{options}: {ended:?}");
    }
}

// Only on systems with case-sensitive names.
#[cfg(target_os = "linux")]
#[test]
fn names_in_another_case_are_found_and_reported() {
    let folder = folder();
    fs::create_dir_all(folder.path("model/Tex/Sub")).unwrap();
    for name in ["Tex/Sub/B.Bin", "Tex/Sub/b.bIN", "exact.BIN", "exact.bin"] {
        folder.write(&format!("model/{name}"), positions());
    }
    for (uri, found) in [
        ("tex/SUB/b.bin", Some("Tex/Sub/B.Bin")),
        ("sub/../TEX/sub/B.BIN", Some("Tex/Sub/B.Bin")),
        ("EXACT.BIN", Some("exact.BIN")),
        ("exact.bin", None),
    ] {
        folder.write("model/m.gltf", gltf(uri));
        let warnings = folder.must("info model/m.gltf --json").json()["warnings"].clone();
        let printed = warnings.to_string();
        let wanted = uri.trim_start_matches("sub/../");
        let note = |found| format!("there is no `{wanted}`; `{found}` is taken");
        assert_eq!(warnings.as_array().unwrap().len(), usize::from(found.is_some()), "{printed}");
        assert!(found.is_none_or(|found| printed.contains(&note(found))), "{uri}: {printed}");
    }
    folder.write("model/m.gltf", gltf("tex/sub/c.bin"));
    folder.run("info model/m.gltf").fails(1, "tex/sub/c.bin");
    folder.write("model/m.gltf", gltf("../SECRET.bin"));
    folder.run("info model/m.gltf").fails(1, "SECRET.bin");
    folder.must("info model/m.gltf --root .");
    png(&folder, "model/quad.PNG");
    folder.write("model/LIB.mtl", "newmtl m\nmap_Kd Quad.png\n");
    folder.write("model/m.obj", format!("mtllib lib.mtl\nusemtl m\n{CUBE}"));
    let printed = folder.must("info model/m.obj --json").json()["warnings"].to_string();
    assert!(
        printed.contains("`LIB.mtl` is taken") && printed.contains("`quad.PNG` is taken"),
        "{printed}"
    );
}

#[test]
fn variants_are_listed_and_chosen() {
    let folder = folder();
    let file = gltf("ok.bin").replacen(
        '{',
        r#"{"extensions":{"KHR_materials_variants":{"variants":[{"name":"hot"},{"name":"cold"}]}},"#,
        1,
    );
    folder.write("model/m.gltf", file);
    let info = folder.must("info model/m.gltf --json").json();
    assert_eq!(info["variants"].to_string(), r#"["hot","cold"]"#);
    folder.must("render model/m.gltf -o a.png --size 8x8 --variant cold");
    folder
        .run("pick model/m.gltf --at 1,1 --variant warm")
        .fails(1, "no variant `warm`; there are hot, cold");
    folder.write("cube.obj", CUBE);
    let ended = folder.must("render cube.obj -o a.png --size 8x8 --variant cold");
    assert!(ended.err.contains("OBJ has no variants; --variant does nothing"), "{}", ended.err);
}

#[test]
fn sizes_are_limited() {
    let folder = Folder::with_models();
    folder.run("info cube.obj --max-bytes 10").fails(1, "cube.obj: ").fails(1, "limit of 10");
    folder.run("info cube.obj --max-triangles 3").fails(1, "limit of 3");
    folder.write("large.obj", CUBE.repeat(1000));
    folder.run("render large.obj -o a.png --max-bytes 100k").fails(1, "large.obj: ");
}
