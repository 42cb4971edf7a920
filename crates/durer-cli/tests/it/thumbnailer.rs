//! The desktop entry contains a command that works.

use crate::harness::{Folder, Picture};

#[test]
fn the_entry_makes_small_pictures() {
    let folder = Folder::with_models();
    folder.must("thumbnailer durer.thumbnailer");
    let text = String::from_utf8(folder.read("durer.thumbnailer")).unwrap();
    assert_eq!(String::from_utf8(folder.must("thumbnailer").out).unwrap(), text);
    assert!(text.starts_with("[Thumbnailer Entry]\nTryExec=durer\nExec=durer render "), "{text}");
    let line = text.lines().find_map(|l| l.strip_prefix("Exec=durer ")).unwrap();
    folder.write("durer.toml", "[render]\nsize = 9\n");
    for out in ["thumb.png", "thumb", ".gnome_desktop_thumbnail.U0SXJ3"] {
        let command = line.replace("%s", "128").replace("%o", out).replace("%i", "cube.obj");
        folder.must(&command);
        let picture = Picture::decode(&folder.read(out));
        assert_eq!((picture.size(), picture.channels), ((128, 128), 4), "{out}");
    }
    let types = text.lines().find_map(|l| l.strip_prefix("MimeType=")).unwrap();
    for name in ["model/gltf-binary", "model/gltf+json", "model/obj", "model/stl", "model/3mf"] {
        assert!(types.split(';').any(|t| t == name), "{name}");
    }
}

#[test]
fn types_that_desktops_do_not_know_can_be_installed() {
    let folder = Folder::new();
    let text = String::from_utf8(folder.must("thumbnailer --types").out).unwrap();
    assert!(text.contains(r#"<glob pattern="*.ply"/>"#) && text.starts_with("<?xml"), "{text}");
    folder.run("thumbnailer nowhere/a.thumbnailer").fails(1, "nowhere");
}
