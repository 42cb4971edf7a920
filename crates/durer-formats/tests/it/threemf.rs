//! 3MF archives written by the tests.

use durer::math::{DVec3, Vec2, Vec3, Vec4};
use durer::scene::{AlphaMode, Wrap};
use durer_formats::{Limits, Model, NoResources, ReadOptions, Result, read_model};
use std::io::{Cursor, Write};

const RELATIONSHIPS: &str = r#"<?xml version="1.0"?><Relationships xmlns="x">
<Relationship Target="/3D/thumb.png" Id="a" Type="http://x/thumbnail"/>
<Relationship Target="/3D/part.model" Id="b" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>"#;

const TRIANGLES: &str = r#"<vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/>
<vertex x="0" y="1" z="0"/><vertex x="0" y="0" z="1"/></vertices>"#;

/// Returns an archive of parts.
pub fn archive(parts: &[(&str, &str)]) -> Vec<u8> {
    let parts: Vec<_> = parts.iter().map(|(name, text)| (*name, text.as_bytes())).collect();
    archive_of_bytes(&parts)
}

fn archive_of_bytes(parts: &[(&str, &[u8])]) -> Vec<u8> {
    let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for (name, content) in parts {
        zip.start_file(*name, zip::write::SimpleFileOptions::default()).expect("part");
        zip.write_all(content).expect("content");
    }
    zip.finish().expect("archive").into_inner()
}

/// Returns an archive with one model part of these resources and build items.
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
    // The component turns x into y, then moves; the item moves by 1 more; all in inches.
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
    assert_eq!(material.name, "red");
    assert_eq!(second.colors[0].to_array(), [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(second.colors[3].to_array(), [0.0, 1.0, 0.0, 128.0 / 255.0]);
    assert_eq!(second.colors[4].to_array(), [0.0, 0.0, 1.0, 1.0]);
    // Only the triangle with a translucent corner is blended.
    let modes =
        second.parts.iter().map(|p| model.scene.materials[p.material.expect("one")].alpha_mode);
    assert_eq!(modes.collect::<Vec<_>>(), [AlphaMode::Opaque, AlphaMode::Blend]);
}

/// Checks the case of a cube with a colour per triangle.
#[test]
fn half_transparent_triangles_are_blended() {
    let resources = format!(
        r##"<m:colorgroup id="5"><m:color color="#FF0000FF"/><m:color color="#FFFF0080"/>
        <m:color color="red"/></m:colorgroup><object id="1" pid="5" pindex="1"><mesh>{TRIANGLES}
        <triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh></object>
        <object id="2" pid="5"><mesh>{TRIANGLES}<triangles><triangle v1="0" v2="1" v3="2" p1="2"/>
        <triangle v1="0" v2="1" v3="2" p1="3"/></triangles></mesh></object>"##
    );
    let items = r#"<item objectid="1"/><item objectid="2"/>"#;
    let model = read(&simple("millimeter", &resources, items)).expect("readable");
    let material = &model.scene.materials[model.scene.meshes[0].parts[0].material.expect("one")];
    assert_eq!(material.alpha_mode, AlphaMode::Blend);
    assert_eq!(material.base_color.to_array(), [1.0, 1.0, 0.0, 128.0 / 255.0]);
    let grey = durer::scene::Material::default().base_color;
    assert_eq!(model.scene.meshes[1].colors, [grey; 6]);
    let texts: Vec<String> = model.warnings.iter().map(ToString::to_string).collect();
    let [colors, properties] = &texts[..] else { panic!("{texts:?}") };
    assert!(colors.contains("part.model, byte") && colors.contains("1 color is not"), "{colors}");
    assert!(properties.contains("1 triangle refers to properties"), "{properties}");
}

/// Returns a PNG of 2 × 2 pixels.
fn png() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 2, 2);
    encoder.set_color(png::ColorType::Rgb);
    let pixels = [255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 0];
    encoder.write_header().and_then(|mut w| w.write_image_data(&pixels)).expect("a picture");
    bytes
}

#[test]
fn textures_of_the_package() {
    let resources = format!(
        r##"<m:texture2d id="9" path="/3D/Textures/A.png" contenttype="image/png" tilestyleu="mirror"
        tilestylev="clamp"/><m:texture2d id="7" path="/3D/none.png" contenttype="image/png"/>
        <m:texture2dgroup id="10" texid="9"><m:tex2coord u="0" v="0"/><m:tex2coord u="1" v="0.25"/>
        </m:texture2dgroup><m:texture2dgroup id="11" texid="7"><m:tex2coord u="0" v="0"/></m:texture2dgroup>
        <m:colorgroup id="12"><m:color color="#00FF00"/></m:colorgroup>
        <m:multiproperties id="13" pids="12 10" blendmethods="multiply"><m:multi pindices="0 1"/></m:multiproperties>
        <object id="1" pid="10" pindex="0"><mesh>{TRIANGLES}<triangles>
        <triangle v1="0" v2="1" v3="2" p1="0" p2="1" p3="0"/><triangle v1="0" v2="1" v3="3" pid="11" p1="0"/>
        <triangle v1="0" v2="3" v3="2"/><triangle v1="0" v2="3" v3="2" pid="13" p1="0"/>
        </triangles></mesh></object>"##
    );
    let root = format!(
        "<model><resources>{resources}</resources><build><item objectid=\"1\"/></build></model>"
    );
    let bytes = archive_of_bytes(&[
        ("_rels/.rels", RELATIONSHIPS.as_bytes()),
        ("3D/part.model", root.as_bytes()),
        ("3D/textures/a.png", &png()),
    ]);
    let model = read(&bytes).expect("readable");
    let (scene, mesh) = (&model.scene, &model.scene.meshes[0]);
    let parts: Vec<_> = mesh.parts.iter().map(|p| p.range.clone()).collect();
    assert_eq!(parts, [0..3, 3..4]);
    let material = &scene.materials[mesh.parts[0].material.expect("one")];
    let texture = &scene.textures[material.base_color_texture.expect("textured").texture];
    assert_eq!(scene.images[texture.image].data[1], [0, 255, 0, 255]);
    let wraps = (texture.sampler.wrap_u, texture.sampler.wrap_v);
    assert_eq!(wraps, (Wrap::MirroredRepeat, Wrap::ClampToEdge));
    // The file's v runs upwards.
    assert_eq!(
        mesh.tex_coords[0][..3],
        [Vec2::new(0.0, 1.0), Vec2::new(1.0, 0.75), Vec2::new(0.0, 1.0)]
    );
    assert_eq!(mesh.colors[0], Vec4::ONE);
    // Green times the picture; surfaces without a picture are grey.
    assert_eq!(
        (mesh.colors[6], mesh.tex_coords[0][6]),
        (Vec4::new(0.0, 1.0, 0.0, 1.0), Vec2::new(1.0, 0.75))
    );
    assert_eq!(mesh.colors[9], durer::scene::Material::default().base_color);
    let [warning] = &model.warnings[..] else { panic!("{:?}", model.warnings) };
    assert!(warning.to_string().starts_with("3D/none.png: the texture is left out"), "{warning}");
}

#[test]
fn required_extensions_are_looked_at() {
    let part = |attributes: &str| {
        let model = format!(
            r#"<model {attributes}><resources><object id="1"><mesh>{TRIANGLES}<triangles>
            <triangle v1="0" v2="1" v3="2"/></triangles></mesh></object></resources>
            <build><item objectid="1"/></build></model>"#
        );
        read(&archive(&[("_rels/.rels", RELATIONSHIPS), ("3D/part.model", &model)]))
    };
    let known = r#"xmlns:q="http://schemas.microsoft.com/3dmanufacturing/material/2015/02"
        xmlns:b="http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02" requiredextensions="q b""#;
    assert!(part(known).is_ok());
    for (attributes, expected) in [
        (
            r#"xmlns:s="http://schemas.microsoft.com/3dmanufacturing/slice/2015/07" requiredextensions="s""#,
            "the slice extension `http://schemas.microsoft.com/3dmanufacturing/slice/2015/07`",
        ),
        (
            r#"xmlns:z="urn:z" requiredextensions="z""#,
            "`urn:z`, which the file requires (prefix `z`), is not supported; save",
        ),
        (r#"requiredextensions="z""#, "no `xmlns:z` explains"),
    ] {
        let text = part(attributes).expect_err("unknown").to_string();
        assert!(text.starts_with("3D/part.model, byte 0: ") && text.contains(expected), "{text}");
    }
}

#[test]
fn parts_in_utf16() {
    let text = format!(
        r#"<?xml version="1.0" encoding="UTF-16"?><model><resources><object id="1" name="Würfel"><mesh>{TRIANGLES}
        <triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh></object></resources>
        <build><item objectid="1"/></build></model>"#
    );
    for unit in [u16::to_le_bytes, u16::to_be_bytes] {
        let mark = [0xfeff].into_iter().flat_map(unit);
        let part: Vec<u8> = mark.chain(text.encode_utf16().flat_map(unit)).collect();
        let parts: [(&str, &[u8]); 2] =
            [("_rels/.rels", RELATIONSHIPS.as_bytes()), ("3D/part.model", &part)];
        let model = read(&archive_of_bytes(&parts)).expect("readable");
        assert_eq!(model.scene.instances[0].name, "Würfel");
    }
}

#[test]
fn triangles_of_missing_vertices_are_left_out() {
    let resources = format!(
        r#"<object id="1"><mesh>{TRIANGLES}<triangles><triangle v1="0" v2="1" v3="4"/>
        <triangle v1="0" v2="1" v3="3"/></triangles></mesh></object>"#
    );
    let model = read(&simple("meter", &resources, r#"<item objectid="1"/>"#)).expect("readable");
    assert_eq!(model.scene.meshes[0].indices, Some(vec![0, 0, 0, 0, 1, 3]));
    let text = model.warnings[0].to_string();
    assert!(text.starts_with("3D/part.model, object 1: 1 triangle refers to vertices"), "{text}");
}

/// Checks a project on plates whose second part is a hole.
#[test]
fn paint_filaments_and_plates() {
    let root = format!(
        r#"<model><resources><object id="1"><mesh>{TRIANGLES}<triangles>
        <triangle v1="0" v2="1" v3="2" paint_color="48403"/><triangle v1="0" v2="1" v3="3"/>
        <triangle v1="0" v2="1" v3="3" paint_color="0C"/></triangles></mesh></object>
        <object id="2"><mesh>{TRIANGLES}<triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh></object>
        <object id="3"><components><component objectid="1"/><component objectid="2"/></components></object>
        </resources><build><item objectid="3"/><item objectid="2"/><item objectid="3"/></build></model>"#
    );
    let project = r##"{"filament_colour": ["#FF0000", "#00FF00", "#0000FFFF"], "x": [1, {}]}"##;
    let settings = r#"<config><object id="3"><metadata key="extruder" value="2"/>
        <part id="2" subtype="negative_part"/></object>
        <plate><metadata key="plater_name" value=""/><model_instance><metadata key="object_id" value="3"/>
        <metadata key="instance_id" value="1"/></model_instance></plate>
        <plate><metadata key="plater_name" value="small"/><model_instance>
        <metadata key="object_id" value="2"/><metadata key="instance_id" value="0"/></model_instance></plate></config>"#;
    let bytes = archive(&[
        ("_rels/.rels", RELATIONSHIPS),
        ("3D/part.model", &root),
        ("Metadata/project_settings.config", project),
        ("Metadata/model_settings.config", settings),
    ]);
    let on = |plate| {
        let options = ReadOptions { plate, ..ReadOptions::default() };
        read_model(&bytes, "x", &NoResources, &options)
    };
    let model = on(None).expect("readable");
    assert_eq!(model.plates, ["", "small"]);
    assert_eq!((model.scene.instances.len(), model.scene.meshes.len()), (3, 2));
    let [red, green, blue] = [Vec3::X, Vec3::Y, Vec3::Z].map(|c| c.extend(1.0));
    let mesh = &model.scene.meshes[0];
    let colors: Vec<Vec4> = mesh.colors.chunks(3).map(|c| c[0]).collect();
    assert_eq!(colors, [green, red, green, red, green, blue]);
    // Half of each side, in the triangle's own place.
    assert_eq!(
        mesh.positions[..3],
        [Vec3::new(0.5, 0.0, 0.0), Vec3::new(0.5, 0.5, 0.0), Vec3::new(0.0, 0.5, 0.0)]
    );
    let text = model.warnings[0].to_string();
    assert!(text.contains("part.model, object 2: 2 parts are modifiers"), "{text}");
    let first = on(Some(1)).expect("readable");
    assert_eq!((first.scene.instances.len(), first.scene.triangle_count()), (1, 6));
    assert_eq!(on(Some(2)).expect("readable").scene.triangle_count(), 1);
    assert!(on(Some(3)).expect_err("no plate").to_string().contains("plates are 1 to 2"));
}

#[test]
fn volumes_of_prusaslicer() {
    let root = format!(
        r#"<model><resources><object id="1"><mesh>{TRIANGLES}<triangles>
        <triangle v1="0" v2="1" v3="2" slic3rpe:mmu_segmentation="8"/><triangle v1="0" v2="1" v3="3"/>
        <triangle v1="0" v2="1" v3="3"/><triangle v1="0" v2="2" v3="3"/></triangles></mesh></object></resources>
        <build><item objectid="1"/></build></model>"#
    );
    let settings = r#"<config><object id="1"><volume firstid="2" lastid="2"><metadata type="volume" key="extruder" value="2"/>
        </volume><volume firstid="3" lastid="3"><metadata key="modifier" value="1"/></volume></object></config>"#;
    let colors =
        "; generated\n; filament_colour = #FF0000;#0000FF\n; extruder_colour = \"\";\"\"\n";
    let parts = [
        ("_rels/.rels", RELATIONSHIPS),
        ("3D/part.model", &*root),
        ("Metadata/Slic3r_PE_model.config", settings),
    ];
    let bytes = archive(&[&parts[..], &[("Metadata/Slic3r_PE.config", colors)]].concat());
    let model = read(&bytes).expect("readable");
    let colors =
        |model: &Model| model.scene.meshes[0].colors.chunks(3).map(|c| c[0]).collect::<Vec<_>>();
    let [red, blue] = [Vec3::X, Vec3::Z].map(|c| c.extend(1.0));
    assert_eq!(colors(&model), [blue, red, blue]);
    assert!(
        model.warnings[0].message.starts_with("1 triangle is a modifier"),
        "{:?}",
        model.warnings
    );
    // Without filament colours, default ones are used, and everything else stays grey.
    let model = read(&archive(&parts)).expect("readable");
    let [painted, first, second] = colors(&model)[..] else { panic!("three triangles") };
    let grey = durer::scene::Material::default().base_color;
    assert!((first, second) == (grey, grey) && painted != grey);
    assert!(model.warnings.iter().any(|w| w.message.contains("made up")), "{:?}", model.warnings);
}

#[test]
fn beams_are_shown() {
    let beams = r#"<b:beamlattice radius="0.5" minlength="0.1"><b:beams><b:beam v1="0" v2="1"/>
        <b:beam v1="0" v2="2" r1="0.25" cap1="butt"/><b:beam v1="0" v2="9"/></b:beams></b:beamlattice>"#;
    let resources =
        format!(r#"<object id="1"><mesh>{TRIANGLES}<triangles/>{beams}</mesh></object>"#);
    let model =
        read(&simple("millimeter", &resources, r#"<item objectid="1"/>"#)).expect("readable");
    // Two prisms of 44 triangles, balls of 120 at three vertices.
    assert_eq!(model.scene.triangle_count(), 2 * 44 + 3 * 120);
    let bounds = model.scene.bounds().expect("not empty");
    assert!((bounds.min - DVec3::splat(-0.5)).abs().max_element() < 1e-6, "{bounds:?}");
    assert!((bounds.max - DVec3::new(1.5, 1.25, 0.5)).abs().max_element() < 1e-6, "{bounds:?}");
    let [warning] = &model.warnings[..] else { panic!("{:?}", model.warnings) };
    assert!(warning.message.starts_with("1 beam or ball refers to vertices"), "{warning}");
    let limits = Limits { primitives: 447, ..Limits::default() };
    let bytes = simple("millimeter", &resources, r#"<item objectid="1"/>"#);
    let options = ReadOptions { limits, ..ReadOptions::default() };
    assert!(read_model(&bytes, "x", &NoResources, &options).is_err());
}

#[test]
fn components_may_be_nested_deeply() {
    let mut resources = format!(
        r#"<object id="0"><mesh>{TRIANGLES}<triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh></object>"#
    );
    for i in 1..5000 {
        let inner = i - 1;
        resources += &format!(
            r#"<object id="{i}"><components><component objectid="{inner}"/></components></object>"#
        );
    }
    let model = read(&simple("meter", &resources, r#"<item objectid="4999"/>"#)).expect("readable");
    assert_eq!(model.scene.instances.len(), 1);
}

#[test]
fn what_is_not_read_is_reported() {
    let resources = format!(
        r#"<object id="1" type="other"><mesh>{TRIANGLES}<triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh></object>
        <object id="2"><bo:booleanshape objectid="1"/></object>"#
    );
    let items = r#"<item objectid="1"/><item objectid="2"/>"#;
    let model = read(&simple("meter", &resources, items)).expect("readable");
    let texts: Vec<_> = model.warnings.iter().map(ToString::to_string).collect();
    assert!(texts[0].contains("object 1: 1 item is an object of the type `other`"), "{texts:?}");
    assert!(texts[1].contains("object 2: 1 object has neither triangles nor beams"), "{texts:?}");
    assert!(texts[2].contains("no items with triangles or beams"), "{texts:?}");
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
        (mesh(r#"<triangle v1="0" v2="1"/>"#), "meter", "`v3` is missing"),
        (mesh(r#"<triangle v1="0" v2="1" v3="-2"/>"#), "meter", "`-2`"),
        (String::new(), "parsec", "`parsec` is not a unit"),
        ("<object id=\"1\">".to_owned(), "meter", "part.model, byte"),
    ] {
        let text = message(&simple(unit, &resources, item));
        assert!(text.contains(expected), "{text}");
    }
    assert!(message(b"PK\x03\x04 and no more").contains("ZIP archive is broken"));
    let without_model = message(&archive(&[("[Content_Types].xml", "b")]));
    assert!(without_model.contains("3D/3dmodel.model: is not in the archive"), "{without_model}");
    assert!(message(&archive(&[("a", "b")])).contains("the ZIP archive holds no models"));
}

#[test]
fn bombs_are_refused() {
    let options = |limits| ReadOptions { limits, ..ReadOptions::default() };
    // Each object refers to the one before it ten times: 10^9 placements in a few lines.
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
