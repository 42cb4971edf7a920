//! What a model refers to is read from its own folder only.

use crate::harness::{CUBE, Folder};
use std::fs;

/// A triangle whose positions are in another file.
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

/// A folder with `model/` and a file beside it that must not be read.
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
    folder.write("model/m.gltf", gltf("inner.bin"));
    folder.must("info model/m.gltf");
}

#[test]
fn sizes_are_limited() {
    let folder = Folder::with_models();
    folder.run("info cube.obj --max-bytes 10").fails(1, "cube.obj: ").fails(1, "limit of 10");
    folder.run("info cube.obj --max-triangles 3").fails(1, "limit of 3");
    folder.write("large.obj", CUBE.repeat(1000));
    folder.run("render large.obj -o a.png --max-bytes 100k").fails(1, "large.obj: ");
}
