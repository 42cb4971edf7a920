//! `durer pick`.

use crate::harness::Folder;

fn json(folder: &Folder, arguments: &str) -> serde_json::Value {
    folder.must(&format!("pick cube.obj --view front --size 100x100 --json {arguments}")).json()
}

#[test]
fn pick_tells_what_lies_behind_a_point_and_a_rectangle() {
    let folder = Folder::with_models();
    let picked = json(&folder, "--at 50.25,49.5");
    let triangles = picked["triangles"].as_array().expect("triangles");
    // The front and the back; the other faces are seen edge-on or not at all.
    assert_eq!(triangles.len(), 2);
    assert!(triangles[0]["depth"].as_f64() < triangles[1]["depth"].as_f64());
    assert_eq!(triangles[0]["position"][2].as_f64().map(f64::round), Some(1.0));
    assert_eq!(picked["objects"][0]["triangles"], 2);
    let all = json(&folder, "--rect 0,0,100,100");
    assert_eq!(all["triangles"].as_array().map(Vec::len), Some(12));
    let none = json(&folder, "--rect 1,1,0,0");
    assert_eq!(none["objects"].as_array().map(Vec::len), Some(0));
}

#[test]
fn pick_needs_one_area() {
    let folder = Folder::with_models();
    for arguments in ["", "--at 1,2 --rect 1,2,3,4", "--at 1", "--rect 1,2,1,4", "--rect 1,2,3"] {
        assert_eq!(folder.run(&format!("pick cube.obj {arguments}")).code, 2, "{arguments}");
    }
    let text = folder.run("pick cube.obj --view front --size 100 --at 3,3");
    assert_eq!((text.code, &text.out[..]), (0, &b"nothing\n"[..]));
}
