//! Exposure, environments and tone maps.

use crate::harness::{Folder, Picture};

/// Returns a white square under one sun of this many lux.
fn lit_square(lux: &str) -> String {
    let floats: [f32; 12] = [-1.0, -1.0, 0.0, 1.0, -1.0, 0.0, 1.0, 1.0, 0.0, -1.0, 1.0, 0.0];
    let indices: [u16; 6] = [0, 1, 2, 0, 2, 3];
    let bytes = floats.iter().flat_map(|f| f.to_le_bytes());
    let bytes = bytes.chain(indices.iter().flat_map(|i| i.to_le_bytes()));
    let hex: String = bytes.map(|byte| format!("%{byte:02x}")).collect();
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0, 1]}}],
        "nodes": [{{"mesh": 0}}, {{"extensions": {{"KHR_lights_punctual": {{"light": 0}}}}}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1, "material": 0}}]}}],
        "materials": [{{"pbrMetallicRoughness": {{"metallicFactor": 0}}}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
            "min": [-1, -1, 0], "max": [1, 1, 0]}},
            {{"bufferView": 0, "byteOffset": 48, "componentType": 5123, "count": 6, "type": "SCALAR"}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 60}}],
        "buffers": [{{"byteLength": 60, "uri": "data:application/octet-stream,{hex}"}}],
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {{"KHR_lights_punctual": {{"lights": [{{"type": "directional", "intensity": {lux}}}]}}}}}}"#
    )
}

/// Returns the green channel of a picture's middle pixel, rendered with these options.
fn middle(folder: &Folder, model: &str, options: &str) -> u8 {
    folder.must(&format!("render {model} -o o.png --size 33x33 --view front {options}"));
    let picture = Picture::decode(&folder.read("o.png"));
    picture.data[(16 * 33 + 16) * picture.channels + 1]
}

#[test]
fn suns_of_any_strength_light_a_model_alike() {
    let folder = Folder::new();
    let found = ["0.01", "10", "1000", "100000"].map(|lux| {
        folder.write("s.gltf", lit_square(lux));
        middle(&folder, "s.gltf", "")
    });
    assert!(found[0] > 230 && found[0] < 255, "{found:?}");
    assert!(found.iter().all(|green| green.abs_diff(found[0]) <= 1), "{found:?}");
}

#[test]
fn exposure_in_ev_shows_the_file_as_it_is() {
    let folder = Folder::new();
    folder.write("s.gltf", lit_square("1"));
    let [dark, bright] =
        ["-1", "1"].map(|ev| middle(&folder, "s.gltf", &format!("--exposure {ev}")));
    assert!(dark < 150 && bright > 200, "{dark} {bright}");
    let automatic =
        middle(&folder, "s.gltf", "--light directional:0,0,-1:white:0.1 --exposure auto");
    assert!(automatic > 230, "{automatic}");
    folder.run("render s.gltf -o o.png --exposure bright").fails(2, "auto");
}

#[test]
fn a_panorama_lights_the_model() {
    let folder = Folder::with_models();
    // An environment of 4 × 4 pixels without run-length encoding: green all around.
    let header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 4\n";
    folder.write("green.hdr", [header.as_bytes(), &[10, 200, 10, 129].repeat(16)].concat());
    let options = "--size 33x33 --view front --environment green.hdr";
    folder.must(&format!("render cube.obj -o o.png {options}"));
    let picture = Picture::decode(&folder.read("o.png"));
    let pixel = &picture.data[(16 * 33 + 16) * picture.channels..][..3];
    assert!(pixel[1] > 200 && pixel[0] < 90, "{pixel:?}");
    folder.write("short.hdr", header);
    folder.run("render cube.obj -o p.png --environment short.hdr").fails(1, "short.hdr: byte");
    folder.run("render cube.obj -o p.png --environment no.hdr").fails(1, "no.hdr");
    assert!(!folder.names().contains(&"p.png".to_owned()));
}

#[test]
fn tone_maps_change_what_is_lit() {
    let folder = Folder::with_models();
    let greens = ["none", "khronos-neutral", "aces", "agx"]
        .map(|map| middle(&folder, "cube.obj", &format!("--tone-map {map}")));
    let distinct: std::collections::BTreeSet<u8> = greens.into_iter().collect();
    assert!(distinct.len() == 4, "{greens:?}");
}

#[test]
fn drawings_know_exposure_but_no_mirrors() {
    let folder = Folder::with_models();
    folder.must("render cube.obj -o o.svg --style regions --exposure 1");
    for option in ["--environment none", "--tone-map aces"] {
        folder.run(&format!("render cube.obj -o p.svg {option}")).fails(2, "drawing");
    }
}
