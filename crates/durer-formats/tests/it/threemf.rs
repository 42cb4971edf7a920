//! 3MF archives written here.

use durer::math::DVec3;
use durer_formats::{Limits, Model, NoResources, ReadOptions, Result, read_model};
use std::io::{Cursor, Write};

const RELATIONSHIPS: &str = r#"<?xml version="1.0"?><Relationships xmlns="x">
<Relationship Target="/3D/thumb.png" Id="a" Type="http://x/thumbnail"/>
<Relationship Target="/3D/part.model" Id="b" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>"#;

const TRIANGLES: &str = r#"<vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/>
<vertex x="0" y="1" z="0"/><vertex x="0" y="0" z="1"/></vertices>"#;

/// An archive of parts.
pub fn archive(parts: &[(&str, &str)]) -> Vec<u8> {
    let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for (name, content) in parts {
        zip.start_file(*name, zip::write::SimpleFileOptions::default()).expect("part");
        zip.write_all(content.as_bytes()).expect("content");
    }
    zip.finish().expect("archive").into_inner()
}

/// An archive with one model part of these resources and build items.
pub fn simple(unit: &str, resources: &str, items: &str) -> Vec<u8> {
    let model = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"{unit}\" xmlns=\"c\" \
         xmlns:m=\"m\" xmlns:p=\"p\"><resources>{resources}</resources><build>{items}</build></model>"
    );
    archive(&[("_rels/.rels", RELATIONSHIPS), ("3D/part.model", &model)])
}

fn read(bytes: &[u8]) -> Result<Model> {
    read_model(bytes, "x", &NoResources, &ReadOptions::default())
}

fn message(bytes: &[u8]) -> String {
    read(bytes).expect_err("broken").to_string()
}

#[test]
fn components_units_and_transforms() {
    let resources = format!(
        r#"<object id="1" name="a &amp; b"><mesh>{TRIANGLES}<triangles><triangle v1="0" v2="1" v3="2"/>
        <triangle v1="0" v2="1" v3="3"/></triangles></mesh></object>
        <object id="2"><components><component objectid="1"/>
        <component objectid="1" transform="0 1 0 -1 0 0 0 0 1 10 20 30"/></components></object>"#
    );
    let item = r#"<item objectid="2" transform="1 0 0 0 1 0 0 0 1 1 0 0"/>"#;
    let model = read(&simple("inch", &resources, item)).expect("readable");
    let scene = &model.scene;
    assert_eq!((scene.meshes.len(), scene.instances.len(), scene.triangle_count()), (1, 2, 4));
    assert_eq!(scene.instances[0].name, "a & b");
    let at = |i: usize, p| scene.instances[i].world_from_mesh.transform_point3(p);
    assert!((at(0, DVec3::X) - DVec3::new(50.8, 0.0, 0.0)).length() < 1e-9);
    // The component turns x to y, then moves; the item moves by 1 more; all in inches.
    let expected = DVec3::new(11.0, 21.0, 30.0) * 25.4;
    assert!((at(1, DVec3::X) - expected).length() < 1e-9, "{}", at(1, DVec3::X));
    assert_eq!(scene.up_axis, durer::scene::UpAxis::Z);
}

#[test]
fn colors_of_objects_and_triangles() {
    let resources = format!(
        r##"<basematerials id="5"><base name="red" displaycolor="#FF0000"/></basematerials>
        <m:colorgroup id="6"><m:color color="#00FF0080"/><m:color color="#0000FF"/></m:colorgroup>
        <object id="1" pid="5" pindex="0"><mesh>{TRIANGLES}<triangles><triangle v1="0" v2="1" v3="2"/>
        </triangles></mesh></object>
        <object id="2" pid="5" pindex="0"><mesh>{TRIANGLES}<triangles><triangle v1="0" v2="1" v3="2"/>
        <triangle v1="0" v2="1" v3="3" pid="6" p1="0" p2="1" p3="1"/></triangles></mesh></object>"##
    );
    let items = r#"<item objectid="1"/><item objectid="2"/>"#;
    let model = read(&simple("millimeter", &resources, items)).expect("readable");
    let [first, second] = &model.scene.meshes[..] else { panic!("two meshes") };
    let material = &model.scene.materials[first.parts[0].material.expect("material")];
    assert_eq!(material.base_color.to_array(), [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(second.colors[0].to_array(), [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(second.colors[3].to_array(), [0.0, 1.0, 0.0, 128.0 / 255.0]);
    assert_eq!(second.colors[4].to_array(), [0.0, 0.0, 1.0, 1.0]);
}

#[test]
fn objects_in_other_parts() {
    let root = r#"<model xmlns:p="p"><resources/><build><item objectid="7" p:path="/3D/o.model"/></build></model>"#;
    let other = format!(
        r#"<model><resources><object id="7"><mesh>{TRIANGLES}<triangles>
        <triangle v1="0" v2="1" v3="2"/></triangles></mesh></object></resources></model>"#
    );
    let parts = [("_rels/.rels", RELATIONSHIPS), ("3D/part.model", root), ("3D/o.model", &other)];
    assert_eq!(read(&archive(&parts)).expect("readable").scene.triangle_count(), 1);
}

#[test]
fn cycles_gaps_and_nonsense_are_errors() {
    let cycle = r#"<object id="1"><components><component objectid="2"/></components></object>
        <object id="2"><components><component objectid="1"/></components></object>"#;
    let item = r#"<item objectid="1"/>"#;
    let mesh = |triangle: &str| {
        format!(
            r#"<object id="1"><mesh>{TRIANGLES}<triangles>{triangle}</triangles></mesh></object>"#
        )
    };
    for (resources, unit, expected) in [
        (cycle.to_owned(), "meter", "contains itself"),
        (String::new(), "meter", "does not exist"),
        (mesh(r#"<triangle v1="0" v2="1" v3="4"/>"#), "meter", "there are 4"),
        (mesh(r#"<triangle v1="0" v2="1"/>"#), "meter", "`v3` is missing"),
        (mesh(r#"<triangle v1="0" v2="1" v3="-2"/>"#), "meter", "`-2`"),
        (String::new(), "parsec", "`parsec` is not a unit"),
        ("<object id=\"1\">".to_owned(), "meter", "part.model, byte"),
    ] {
        let text = message(&simple(unit, &resources, item));
        assert!(text.contains(expected), "{text}");
    }
    assert!(message(b"PK\x03\x04 and no more").contains("ZIP archive is broken"));
    assert!(message(&archive(&[("a", "b")])).contains("3D/3dmodel.model: is not in the archive"));
}

#[test]
fn bombs_are_refused() {
    let options = |limits| ReadOptions { limits, ..ReadOptions::default() };
    // Each object names the one before it ten times: 10^9 placements in a few lines.
    let mut resources = String::from(r#"<object id="0"></object>"#);
    for i in 1..10 {
        let inner = format!(r#"<component objectid="{}"/>"#, i - 1).repeat(10);
        resources += &format!(r#"<object id="{i}"><components>{inner}</components></object>"#);
    }
    let bytes = simple("meter", &resources, r#"<item objectid="9"/>"#);
    assert!(message(&bytes).contains("placed components"), "{}", message(&bytes));

    let blanks = " ".repeat(3_000_000);
    let bytes = simple("meter", &blanks, "");
    assert!(bytes.len() < 30_000, "{}", bytes.len());
    let limits = Limits { decoded_bytes: 1_000_000, ..Limits::default() };
    let e = read_model(&bytes, "x", &NoResources, &options(limits)).expect_err("too large");
    assert!(e.to_string().contains("inflated"), "{e}");
}
