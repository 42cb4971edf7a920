//! COLLADA documents written by the tests.

use durer::math::{DVec3, Vec2, Vec3, Vec4};
use durer::scene::{AlphaMode, Mesh, ShadingModel, Topology, UpAxis, Wrap};
use durer_formats::{Limits, Model, NoResources, ReadOptions, Resources, Result, read_model};

/// Data of a square with a smaller one inside it, and further attributes of their corners.
const SOURCES: &str = r##"<source id="p"><float_array id="pa" count="24">0 0 0 3 0 0 3 3 0 0 3 0 1 1 0 2 1 0 2 2 0 1 2 0</float_array>
    <technique_common><accessor source="#pa" count="8" stride="3"><param name="X"/><param name="Y"/><param name="Z"/></accessor></technique_common></source>
    <source id="n"><float_array id="na" count="3">0 0 2</float_array>
    <technique_common><accessor source="#na" count="1" stride="3"/></technique_common></source>
    <source id="t"><float_array id="ta" count="7">9 0 0 7 1 0,25 7</float_array>
    <technique_common><accessor source="#ta" count="2" offset="1" stride="3"><param name="S"/><param name="T"/><param/></accessor></technique_common></source>
    <source id="c"><float_array id="ca" count="8">1 0 0 1 0 1 0 0.5</float_array>
    <technique_common><accessor source="#ca" count="2" stride="4"/></technique_common></source>
    <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>"##;
const VERTEX: &str = r##"<input semantic="VERTEX" source="#v" offset="0"/>"##;

/// Returns a document with one geometry of these primitives, shown by a node with this content.
fn document(primitives: &str, libraries: &str, node: &str) -> String {
    format!(
        r##"<?xml version="1.0"?><COLLADA version="1.4.1"><asset><up_axis>Z_UP</up_axis></asset>{libraries}
        <library_geometries><geometry id="g" name="Square"><mesh>{SOURCES}{primitives}</mesh></geometry></library_geometries>
        <library_visual_scenes><visual_scene id="s"><node id="a" name="A">{node}</node></visual_scene></library_visual_scenes>
        <scene><instance_visual_scene url="#s"/></scene></COLLADA>"##
    )
}

const SHOWN: &str = r##"<instance_geometry url="#g"/>"##;

fn read_with(text: &str, resources: &dyn Resources) -> Result<Model> {
    read_model(text.as_bytes(), "x", resources, &ReadOptions::default())
}

fn read(text: &str) -> Model {
    read_with(text, &NoResources).expect("readable")
}

fn warnings(model: &Model) -> Vec<String> {
    model.warnings.iter().map(ToString::to_string).collect()
}

/// Returns the area of all triangles.
fn area(mesh: &Mesh) -> f64 {
    let point = |v: u32| mesh.positions[v as usize].as_dvec3();
    let of = |i: usize| {
        let [a, b, c] = mesh.triangle(i).map(point);
        (b - a).cross(c - a).length() / 2.0
    };
    (0..mesh.triangle_count()).map(of).sum()
}

#[test]
fn all_primitives_have_their_area() {
    for (primitives, triangles, expected) in [
        ("<triangles count=\"2\">V<p>0 1 2 0 2 3</p></triangles>", 2, 9.0),
        ("<polylist count=\"2\">V<vcount>4 3</vcount><p>0 1 2 3 4 5 6</p></polylist>", 3, 9.5),
        ("<polygons count=\"2\">V<p>0 1 2 3</p><p>4 5 6</p></polygons>", 3, 9.5),
        ("<tristrips count=\"1\">V<p>0 1 3 2</p></tristrips>", 2, 9.0),
        ("<trifans count=\"1\">V<p>0 1 2 3</p></trifans>", 2, 9.0),
    ] {
        let text = document(&primitives.replace('V', VERTEX), "", SHOWN);
        let model = read(&text);
        assert_eq!(warnings(&model), [""; 0], "{primitives}");
        let mesh = &model.scene.meshes[0];
        assert_eq!((mesh.triangle_count(), area(mesh)), (triangles, expected), "{primitives}");
        // All face +z.
        for i in 0..mesh.triangle_count() {
            let [a, b, c] = mesh.triangle(i).map(|v| mesh.positions[v as usize]);
            assert!((b - a).cross(c - a).z > 0.0, "{primitives}, {i}");
        }
        assert_eq!((mesh.name.as_str(), mesh.positions.len() < 8), ("Square", true));
    }
}

/// Checks polygons that a fan from the first corner would get wrong.
#[test]
fn concave_polygons_and_holes() {
    for (primitives, expected) in [
        ("<polylist count=\"1\">V<vcount>5</vcount><p>0 1 5 2 3</p></polylist>", 7.5),
        ("<polygons count=\"1\">V<ph><p>0 1 2 3</p><h>4 7 6 5</h></ph></polygons>", 8.0),
        (
            "<polygons count=\"1\">V<ph><p>3 2 1 0</p><h>4 5 6 7</h></ph><p>4 5 6 7</p></polygons>",
            9.0,
        ),
    ] {
        let model = read(&document(&primitives.replace('V', VERTEX), "", SHOWN));
        assert_eq!(warnings(&model), [""; 0], "{primitives}");
        assert_eq!(area(&model.scene.meshes[0]), expected, "{primitives}");
    }
}

#[test]
fn polygons_say_their_faces() {
    let primitives =
        "<polylist count=\"3\">V<vcount>4 3 4</vcount><p>0 1 2 3 4 5 6 4 5 6 7</p></polylist>";
    let model = read(&document(&primitives.replace('V', VERTEX), "", SHOWN));
    assert_eq!(model.scene.meshes[0].faces, [0, 2, 3]);
}

#[test]
fn lines_are_lines() {
    let primitives = "<lines count=\"1\">V<p>0 1</p></lines><linestrips count=\"1\">V<p>0 1 2</p><p>4 5</p></linestrips>";
    let model = read(&document(&primitives.replace('V', VERTEX), "", SHOWN));
    let mesh = &model.scene.meshes[0];
    assert_eq!((mesh.topology, mesh.primitive_count()), (Topology::Lines, 4));
}

#[test]
fn corners_have_attributes_by_offset_and_stride() {
    let primitives = r##"<triangles count="1" material="m">V
        <input semantic="NORMAL" source="#n" offset="1"/><input semantic="TEXCOORD" source="#t" offset="2" set="0"/>
        <input semantic="COLOR" source="#c" offset="4"/><p>0 0 0 9 0 1 0 1 9 1 2 0 0 9 0</p></triangles>"##;
    let model = read(&document(&primitives.replace('V', VERTEX), "", SHOWN));
    let mesh = &model.scene.meshes[0];
    assert_eq!(mesh.positions, [Vec3::ZERO, Vec3::new(3.0, 0.0, 0.0), Vec3::new(3.0, 3.0, 0.0)]);
    assert_eq!(mesh.normals, [Vec3::Z; 3]);
    // v runs upwards; a comma within a number is read as a decimal point.
    assert_eq!(mesh.tex_coords, [[Vec2::new(0.0, 1.0), Vec2::new(1.0, 0.75), Vec2::new(0.0, 1.0)]]);
    assert_eq!(mesh.colors[1], Vec4::new(0.0, 1.0, 0.0, 0.5));
    let material = &model.scene.materials[mesh.parts[0].material.expect("of colours")];
    assert_eq!(material.name, "vertex colors");
    assert!(warnings(&model)[0].contains("1 instance refers to a missing object"));
}

#[test]
fn nodes_have_transforms_and_instances() {
    let node = r##"<translate>1 0 0</translate><rotate>0 0 1 90</rotate><scale>2 2 2</scale>
        <instance_geometry url="#g"/><node><translate>1 0 0</translate><instance_node url="#b"/></node>"##;
    let library = r##"<library_nodes><node id="b" name="B"><matrix>1 0 0 0 0 1 0 0 0 0 1 5 0 0 0 1</matrix>
        <instance_geometry url="#g"/></node></library_nodes>"##;
    let primitives = format!("<triangles count=\"1\">{VERTEX}<p>0 1 2</p></triangles>");
    let model = read(&document(&primitives, library, node));
    let [first, second] = &model.scene.instances[..] else { panic!("two") };
    assert_eq!((first.name.as_str(), second.name.as_str(), first.mesh), ("A", "B", second.mesh));
    let at = |i: &durer::scene::Instance| i.world_from_mesh.transform_point3(DVec3::X);
    assert!((at(first) - DVec3::new(1.0, 2.0, 0.0)).length() < 1e-12, "{}", at(first));
    assert!((at(second) - DVec3::new(1.0, 4.0, 10.0)).length() < 1e-12, "{}", at(second));
    assert_eq!(model.scene.up_axis, UpAxis::Z);
}

#[test]
fn units_and_axes() {
    let primitives = format!("<triangles count=\"1\">{VERTEX}<p>0 1 2</p></triangles>");
    let text = document(&primitives, "", SHOWN);
    let asset = |content: &str| {
        let model = read(&text.replace("<up_axis>Z_UP</up_axis>", content));
        (
            model.scene.up_axis,
            model.scene.instances[0].world_from_mesh.transform_point3(DVec3::new(1.0, 2.0, 3.0)),
        )
    };
    assert_eq!(asset(""), (UpAxis::Y, DVec3::new(1.0, 2.0, 3.0)));
    assert_eq!(
        asset("<unit meter=\"0,5\"/><up_axis>X_UP</up_axis>"),
        (UpAxis::Y, DVec3::new(-1.0, 0.5, 1.5))
    );
}

/// Returns a material `m` with this shader, in a document that uses it.
fn shaded(shader: &str, parameters: &str) -> String {
    let libraries = format!(
        r##"<library_images><image id="i"><init_from>./a%20b.png</init_from></image></library_images>
        <library_materials><material id="m" name="M"><instance_effect url="#e"/></material></library_materials>
        <library_effects><effect id="e"><profile_COMMON>{parameters}<technique sid="t">{shader}</technique></profile_COMMON>
        </effect></library_effects>"##
    );
    let primitives = r##"<triangles count="1" material="x">V<input semantic="TEXCOORD" source="#t" offset="0" set="3"/>
        <p>0 1 0</p></triangles>"##;
    let node = r##"<instance_geometry url="#g"><bind_material><technique_common><instance_material symbol="x" target="#m">
        <bind_vertex_input semantic="UV" input_semantic="TEXCOORD" input_set="3"/></instance_material></technique_common>
        </bind_material></instance_geometry>"##;
    document(&primitives.replace('V', VERTEX), &libraries, node)
}

#[test]
fn shaders_become_materials() {
    let phong = "<phong><emission><color>0 0 1 1</color></emission><diffuse><color>1 0 0 1</color></diffuse>
        <specular><color>1 1 1 1</color></specular><shininess><float>50</float></shininess></phong>";
    let model = read(&shaded(phong, ""));
    assert_eq!(warnings(&model), [""; 0]);
    let m = &model.scene.materials[0];
    assert_eq!(
        (m.name.as_str(), m.base_color, m.emissive),
        ("M", Vec4::new(1.0, 0.0, 0.0, 1.0), Vec3::Z)
    );
    assert_eq!((m.specular, m.shininess, m.alpha_mode), (Vec3::ONE, 50.0, AlphaMode::Opaque));
    let lambert = "<lambert><diffuse><param ref=\"d\"/></diffuse><specular><color>1 1 1 1</color></specular></lambert>";
    let model = read(&shaded(lambert, "<newparam sid=\"d\"><float3>0 1 0</float3></newparam>"));
    let m = &model.scene.materials[0];
    assert_eq!((m.base_color, m.specular), (Vec4::new(0.0, 1.0, 0.0, 1.0), Vec3::ZERO));
    let model =
        read(&shaded("<constant><emission><color>0 0 1 1</color></emission></constant>", ""));
    let m = &model.scene.materials[0];
    assert_eq!(
        (m.model, m.base_color, m.emissive),
        (ShadingModel::Unlit, Vec4::new(0.0, 0.0, 1.0, 1.0), Vec3::ZERO)
    );
}

#[test]
fn colors_of_new_blenders_are_linear() {
    let text = shaded("<lambert><diffuse><color>0.5 0 0 1</color></diffuse></lambert>", "");
    let red = |tool: &str| {
        let tool =
            format!("<asset><contributor><authoring_tool>{tool}</authoring_tool></contributor>");
        read(&text.replace("<asset>", &tool)).scene.materials[0].base_color.x
    };
    assert_eq!(
        (red("Blender 2.80.75 commit"), red("Blender 4.0.2"), red("Blender 3")),
        (0.5, 0.5, red("x"))
    );
    assert!((red("Blender 2.79.0") - 0.214).abs() < 1e-3);
}

#[test]
fn transparency_by_all_modes() {
    let alpha = |transparent: &str, amount: &str| {
        let amount = if amount.is_empty() {
            String::new()
        } else {
            format!("<transparency><float>{amount}</float></transparency>")
        };
        let model = read(&shaded(&format!("<phong>{transparent}{amount}</phong>"), ""));
        let m = &model.scene.materials[0];
        assert_eq!(m.alpha_mode == AlphaMode::Blend, m.base_color.w < 1.0);
        (m.base_color.w, warnings(&model).len())
    };
    let color =
        |mode: &str, c: &str| format!("<transparent{mode}><color>{c}</color></transparent>");
    assert_eq!(alpha("", ""), (1.0, 0));
    assert_eq!(alpha("", "0.25"), (0.25, 0));
    assert_eq!(alpha(&color("", "1 1 1 1"), "0.25"), (0.25, 0));
    assert_eq!(alpha(&color(" opaque=\"A_ONE\"", "1 1 1 0.5"), ""), (0.5, 0));
    assert_eq!(alpha(&color(" opaque=\"RGB_ZERO\"", "0 0 0 1"), "1"), (1.0, 0));
    let (w, _) = alpha(&color(" opaque=\"RGB_ZERO\"", "1 1 1 1"), "0.75");
    assert!((w - 0.25).abs() < 1e-5, "{w}");
    assert_eq!(alpha(&color(" opaque=\"A_ZERO\"", "1 1 1 0.25"), "1"), (0.75, 0));
    // Nobody writes an invisible material: 0 is taken as opaque.
    assert_eq!(alpha(&color("", "1 1 1 1"), "0.0"), (1.0, 1));
    assert_eq!(alpha("", "0,000000"), (1.0, 1));
}

/// Finds a single picture.
struct Picture;

impl Resources for Picture {
    fn read(&self, path: &str, _limit: u64) -> std::result::Result<Vec<u8>, String> {
        if path != "a b.png" {
            return Err("there is no such file".to_owned());
        }
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 1, 1);
        encoder.set_color(png::ColorType::Rgb);
        encoder
            .write_header()
            .and_then(|mut w| w.write_image_data(&[255, 0, 0]))
            .expect("a picture");
        Ok(bytes)
    }
}

#[test]
fn textures_by_surface_instance_and_name() {
    let surface = r##"<newparam sid="u"><surface type="2D"><init_from>i</init_from></surface></newparam>
        <newparam sid="w"><sampler2D><source>u</source><wrap_s>MIRROR</wrap_s><wrap_t>CLAMP</wrap_t></sampler2D></newparam>"##;
    let instance =
        r##"<newparam sid="w"><sampler2D><instance_image url="#i"/></sampler2D></newparam>"##;
    let textured = |name: &str| {
        format!(
            "<lambert><diffuse><texture texture=\"{name}\" texcoord=\"UV\"/></diffuse></lambert>"
        )
    };
    for (name, parameters, wrap) in [
        ("w", surface, Wrap::MirroredRepeat),
        ("w", instance, Wrap::Repeat),
        ("i", "", Wrap::Repeat),
    ] {
        let model = read_with(&shaded(&textured(name), parameters), &Picture).expect("readable");
        assert_eq!(warnings(&model), [""; 0], "{name}");
        let m = &model.scene.materials[0];
        let texture = &model.scene.textures[m.base_color_texture.expect("textured").texture];
        assert_eq!((m.base_color, texture.sampler.wrap_u), (Vec4::ONE, wrap));
        assert_eq!(model.scene.images[texture.image].data, [[255, 0, 0, 255]]);
    }
    let model = read(&shaded(&textured("w"), surface));
    assert!(
        warnings(&model)[0].contains("texture `a b.png` is left out"),
        "{:?}",
        warnings(&model)
    );
    let model = read(&shaded(&textured("none"), ""));
    assert!(warnings(&model)[0].contains("1 texture names no picture"), "{:?}", warnings(&model));
}

#[test]
fn sides_are_as_programs_say() {
    let extra = |v: &str| {
        format!(
            "</technique><extra><technique profile=\"GOOGLEEARTH\"><double_sided>{v}</double_sided></technique></extra><technique>"
        )
    };
    let sides = |v: &str| read(&shaded(&extra(v), "")).scene.materials[0].double_sided;
    assert_eq!((sides("1"), sides("0")), (true, false));
    assert!(read(&shaded("<phong/>", "")).scene.materials[0].double_sided);
}

#[test]
fn skins_are_shown_as_they_were_bound() {
    let controller = r##"<library_controllers><controller id="k"><skin source="#g">
        <bind_shape_matrix>2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1</bind_shape_matrix></skin></controller>
        <controller id="l"><morph source="#k"/></controller></library_controllers>"##;
    let node = r##"<translate>1 0 0</translate><instance_controller url="#l"/>"##;
    let primitives = format!("<triangles count=\"1\">{VERTEX}<p>0 1 2</p></triangles>");
    let model = read(&document(&primitives, controller, node));
    let world = model.scene.instances[0].world_from_mesh;
    assert_eq!(world.transform_point3(DVec3::ONE), DVec3::new(3.0, 2.0, 2.0));
}

#[test]
fn what_is_wrong_is_left_out_with_a_word() {
    for (primitives, expected) in [
        ("<triangles>V<p>0 1 2 0 2 9</p></triangles>", "line 1, column"),
        ("<triangles>V<p>0 1 2 0 2 9</p></triangles>", "1 corner has an index beyond"),
        ("<triangles>V<p>0 1 2 0 2</p></triangles>", "1 face or list has too few"),
        ("<polylist>V<vcount>3 4</vcount><p>0 1 2 3</p></polylist>", "1 face or list has too few"),
        (
            "<triangles>V<input semantic=\"NORMAL\" source=\"#zz\" offset=\"0\"/><p>0 1 2</p></triangles>",
            "1 input names a source",
        ),
        (
            "<triangles>V<input semantic=\"NORMAL\" source=\"#n\" offset=\"0\"/><p>0 1 2</p></triangles>",
            "2 corners refer to a normal, color or texture coordinate",
        ),
    ] {
        let model = read(&document(&primitives.replace('V', VERTEX), "", SHOWN).replace('\n', " "));
        assert_eq!(model.scene.triangle_count(), 1, "{primitives}");
        assert!(warnings(&model)[0].contains(expected), "{:?}", warnings(&model));
    }
    let empty = read(&document(
        "",
        "",
        "<instance_geometry url=\"#q\"/><instance_light url=\"#x\"/><scale>1</scale>",
    ));
    for expected in ["2 instances refer to missing", "1 transform does not", "no nodes with a mesh"]
    {
        assert!(
            warnings(&empty).iter().any(|w| w.contains(expected)),
            "{expected}: {:?}",
            warnings(&empty)
        );
    }
    let message = |text: &str| read_with(text, &NoResources).expect_err("broken").to_string();
    assert!(
        message("<?xml version=\"1.0\"?>\n<COLLADA>\n<asset>")
            .starts_with("line 3, column 8: the file ends inside <asset>")
    );
    assert!(message("<x><COLLADA/></x>").contains("is not <COLLADA>"));
}

#[test]
fn trees_end_and_have_limits() {
    let library = r##"<library_nodes><node id="b"><instance_node url="#b"/><instance_node url="#c"/></node><node id="c">
        <instance_node url="#b"/><instance_geometry url="#g"/></node></library_nodes>"##;
    let primitives = format!("<triangles count=\"1\">{VERTEX}<p>0 1 2</p></triangles>");
    let model = read(&document(&primitives, library, "<instance_node url=\"#b\"/>"));
    assert_eq!(model.scene.instances.len(), 1);
    assert!(
        warnings(&model)[0].contains("2 nodes are inside themselves"),
        "{:?}",
        warnings(&model)
    );
    let text = document(&primitives, "", &SHOWN.repeat(3).replace("/>", "></instance_geometry>"));
    let with = |limits| {
        read_model(
            text.as_bytes(),
            "x",
            &NoResources,
            &ReadOptions { limits, ..ReadOptions::default() },
        )
    };
    assert!(with(Limits { primitives: 1, ..Limits::default() }).is_ok());
    assert!(with(Limits { primitives: 0, ..Limits::default() }).is_err());
    assert!(with(Limits { instances: 0, ..Limits::default() }).is_err());
    assert!(with(Limits { decoded_bytes: 500, ..Limits::default() }).is_err());
}
