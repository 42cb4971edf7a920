//! ASCII files written by the tests.

use crate::{Limits, Model, NoResources, ReadOptions, Resources, Result, read_model};
use durer::math::{DVec3, Vec2, Vec3, Vec4};
use durer::scene::{AlphaMode, LightKind, Mesh, Projection, ShadingModel, UpAxis};

mod pictures;

/// A frame of y up and metres.
const SETTINGS: &str = r#"P: "UpAxis", "int", "Integer", "",1
    P: "UpAxisSign", "int", "Integer", "",1
    P: "FrontAxis", "int", "Integer", "",2
    P: "FrontAxisSign", "int", "Integer", "",1
    P: "CoordAxis", "int", "Integer", "",0
    P: "CoordAxisSign", "int", "Integer", "",1
    P: "UnitScaleFactor", "double", "Number", "",100"#;

/// An arrow of four corners, the second of which is a notch, and a triangle beside it.
const SHAPE: &str = r#"Geometry: 1, "Geometry::shape", "Mesh" {
    Vertices: *21 { a: 0,0,0, 1,0.5,0, 2,0,0, 1,3,0, 3,0,0, 4,0,0, 3,2,0 }
    PolygonVertexIndex: *7 { a: 2,3,0,-2,4,5,-7 }
    LayerElementNormal: 0 { MappingInformationType: "AllSame" ReferenceInformationType: "Direct" Normals: *3 { a: 0,0,2 } }
    LayerElementUV: 0 { Name: "first" MappingInformationType: "ByPolygonVertex" ReferenceInformationType: "IndexToDirect"
        UV: *4 { a: 0,0,0.25,0.75 } UVIndex: *7 { a: 0,1,0,0,1,1,0 } }
    LayerElementUV: 1 { Name: "second" MappingInformationType: "AllSame" ReferenceInformationType: "Direct" UV: *2 { a: 0.5,0 } }
    LayerElementMaterial: 0 { MappingInformationType: "ByPolygon" ReferenceInformationType: "IndexToDirect" Materials: *2 { a: 1,0 } }
    COLORS
    Layer: 0 {
        LayerElement: { Type: "LayerElementNormal" TypedIndex: 0 }
        LayerElement: { Type: "LayerElementUV" TypedIndex: 0 }
        LayerElement: { Type: "LayerElementMaterial" TypedIndex: 0 }
        LayerElement: { Type: "LayerElementColor" TypedIndex: 0 }
    }
    Layer: 1 { LayerElement: { Type: "LayerElementUV" TypedIndex: 1 } }
}
"#;

/// Returns a file with the shape, further objects, and the connections given.
fn file(settings: &str, objects: &str, joined: &[(u32, u32, &str)]) -> String {
    let join = |(from, to, property): &(u32, u32, &str)| match *property {
        "" => format!("C: \"OO\",{from},{to}\n"),
        property => format!("C: \"OP\",{from},{to}, \"{property}\"\n"),
    };
    let joined: String = joined.iter().map(join).collect();
    format!(
        "; FBX 7.4.0 project file\nFBXHeaderExtension: {{ FBXHeaderVersion: 1003\nFBXVersion: 7400\nCREATOR }}\n\
         GlobalSettings: {{ Version: 1000\nProperties70: {{ {settings} }} }}\n\
         Objects: {{ {SHAPE}{objects} }}\nConnections: {{ {joined} }}\n"
    )
    .replace("COLORS", "")
    .replace("CREATOR", "")
}

/// Returns a node of a kind with properties.
fn node(id: u32, kind: &str, properties: &str) -> String {
    format!(
        "Model: {id}, \"Model::node{id}\", \"{kind}\" {{ Version: 232\nProperties70: {{ {properties} }} }}\n"
    )
}

/// Returns properties that consist of three numbers.
fn vectors(all: &[(&str, [f64; 3])]) -> String {
    let one = |(name, [x, y, z]): &(&str, [f64; 3])| {
        format!("P: \"{name}\", \"Vector3D\", \"Vector\", \"\",{x},{y},{z}\n")
    };
    all.iter().map(one).collect()
}

fn number(name: &str, value: f64) -> String {
    format!("P: \"{name}\", \"Number\", \"\", \"A\",{value}\n")
}

fn material(id: u32, properties: &str) -> String {
    format!(
        "Material: {id}, \"Material::m{id}\", \"\" {{ ShadingModel: \"phong\"\nProperties70: {{ {properties} }} }}\n"
    )
}

fn read_with(text: &str, resources: &dyn Resources, limits: Limits) -> Result<Model> {
    read_model(
        text.as_bytes(),
        "x",
        resources,
        &ReadOptions { limits, own_lights: true, ..ReadOptions::default() },
    )
}

fn read(text: &str) -> Model {
    read_with(text, &NoResources, Limits::default()).expect("readable")
}

fn warnings(model: &Model) -> Vec<String> {
    model.warnings.iter().map(ToString::to_string).collect()
}

fn area(mesh: &Mesh) -> f64 {
    let point = |v: u32| mesh.positions[v as usize].as_dvec3();
    let of = |i: usize| {
        let [a, b, c] = mesh.triangle(i).map(point);
        (b - a).cross(c - a).length() / 2.0
    };
    (0..mesh.triangle_count()).map(of).sum()
}

fn near(a: DVec3, b: DVec3) {
    assert!((a - b).length() < 1e-9, "{a} {b}");
}

#[test]
fn polygons_have_attributes_and_materials() {
    let red = material(8, &vectors(&[("DiffuseColor", [1.0, 0.0, 0.0])]));
    let blue = material(9, &vectors(&[("DiffuseColor", [0.0, 0.0, 1.0])]));
    let objects = format!("{}{red}{blue}", node(2, "Mesh", ""));
    let model = read(&file(SETTINGS, &objects, &[(2, 0, ""), (1, 2, ""), (8, 2, ""), (9, 2, "")]));
    assert_eq!((model.format.as_str(), warnings(&model)), ("FBX 7.4 ASCII", vec![]));
    let [mesh] = &model.scene.meshes[..] else { panic!("one mesh") };
    // The arrow has an area of 3 minus a notch of one half; then the other triangle.
    assert!((area(mesh) - 3.5).abs() < 1e-6, "{}", area(mesh));
    assert_eq!((mesh.name.as_str(), mesh.triangle_count(), mesh.faces.len()), ("shape", 3, 2));
    assert!(mesh.normals.iter().all(|n| *n == Vec3::Z));
    assert_eq!(mesh.tex_coords.len(), 2);
    assert_eq!(mesh.tex_coords[0][1], Vec2::new(0.25, 0.25));
    assert!(mesh.tex_coords[1].iter().all(|t| *t == Vec2::new(0.5, 1.0)));
    // Sorted by material: the triangle has the first one.
    let parts: Vec<_> = mesh.parts.iter().map(|p| (p.range.clone(), p.material)).collect();
    let color = |i: usize| model.scene.materials[parts[i].1.expect("a material")].base_color;
    assert_eq!((parts[0].0.clone(), parts[1].0.clone()), (0..1, 1..3));
    assert_eq!(
        (color(0), color(1)),
        (Vec4::new(1.0, 0.0, 0.0, 1.0), Vec4::new(0.0, 0.0, 1.0, 1.0))
    );
}

#[test]
fn colors_of_vertices_are_shown() {
    let colors = "LayerElementColor: 0 { MappingInformationType: \"AllSame\" ReferenceInformationType: \"Direct\"\n\
                  Colors: *4 { a: 1,0,1,0.5 } }";
    let text = file(SETTINGS, &node(2, "Mesh", ""), &[(2, 0, ""), (1, 2, "")]);
    let model = read(&text.replace("    Layer: 0", &format!("{colors}\nLayer: 0")));
    let mesh = &model.scene.meshes[0];
    assert!(mesh.colors.iter().all(|c| *c == Vec4::new(1.0, 0.0, 1.0, 0.5)), "{:?}", mesh.colors);
    let shown = mesh.parts[0].material.map(|m| model.scene.materials[m].base_color);
    assert_eq!(shown, Some(Vec4::ONE));
}

/// Returns the position of a point of the only mesh.
fn placed(settings: &str, properties: &str, p: DVec3) -> DVec3 {
    let model = read(&file(settings, &node(2, "Mesh", properties), &[(2, 0, ""), (1, 2, "")]));
    model.scene.instances[0].world_from_mesh.transform_point3(p)
}

#[test]
fn nodes_have_all_their_transforms() {
    let p = DVec3::new(1.0, 2.0, 3.0);
    let at = |all: &[(&str, [f64; 3])]| placed(SETTINGS, &vectors(all), p);
    let quarter = [0.0, 0.0, 90.0];
    near(at(&[("Lcl Translation", [1.0, 1.0, 1.0])]), DVec3::new(2.0, 3.0, 4.0));
    near(at(&[("Lcl Scaling", [2.0, 3.0, 4.0])]), DVec3::new(2.0, 6.0, 12.0));
    near(at(&[("Lcl Rotation", quarter)]), DVec3::new(-2.0, 1.0, 3.0));
    // x first, then z.
    near(at(&[("Lcl Rotation", [90.0, 0.0, 90.0])]), DVec3::new(3.0, 1.0, 2.0));
    near(
        at(&[("PreRotation", [90.0, 0.0, 0.0]), ("Lcl Rotation", quarter)]),
        DVec3::new(-2.0, -3.0, 1.0),
    );
    near(at(&[("PostRotation", quarter)]), DVec3::new(2.0, -1.0, 3.0));
    // About (1, 0, 0): (0, 2) becomes (−2, 0).
    near(
        at(&[("RotationPivot", [1.0, 0.0, 0.0]), ("Lcl Rotation", quarter)]),
        DVec3::new(-1.0, 0.0, 3.0),
    );
    near(
        at(&[("ScalingPivot", [0.0, 1.0, 0.0]), ("Lcl Scaling", [1.0, 5.0, 1.0])]),
        DVec3::new(1.0, 6.0, 3.0),
    );
    near(
        at(&[("RotationOffset", [1.0, 0.0, 0.0]), ("ScalingOffset", [0.0, 1.0, 0.0])]),
        DVec3::new(2.0, 3.0, 3.0),
    );
    near(
        at(&[("GeometricTranslation", [5.0, 0.0, 0.0]), ("Lcl Rotation", quarter)]),
        DVec3::new(-2.0, 6.0, 3.0),
    );
    near(
        at(&[("GeometricRotation", quarter), ("GeometricScaling", [1.0, 2.0, 1.0])]),
        DVec3::new(-4.0, 1.0, 3.0),
    );
    let order = format!(
        "{}P: \"RotationOrder\", \"enum\", \"\", \"\",5\n",
        vectors(&[("Lcl Rotation", [90.0, 0.0, 90.0])])
    );
    // z first, then x.
    near(placed(SETTINGS, &order, p), DVec3::new(-2.0, -3.0, 1.0));
}

#[test]
fn children_inherit_by_three_modes() {
    // For a parent that scales and moves, and a child that moves.
    let at = |mode: u32| {
        let parent = vectors(&[
            ("Lcl Translation", [10.0, 0.0, 0.0]),
            ("Lcl Scaling", [2.0, 1.0, 1.0]),
            ("Lcl Rotation", [0.0, 0.0, 90.0]),
        ]);
        let child = format!(
            "{}P: \"InheritType\", \"enum\", \"\", \"\",{mode}\n",
            vectors(&[
                ("Lcl Translation", [1.0, 0.0, 0.0]),
                ("GeometricTranslation", [0.0, 0.0, 4.0])
            ])
        );
        let objects = format!("{}{}", node(2, "Null", &parent), node(3, "Mesh", &child));
        let model = read(&file(SETTINGS, &objects, &[(2, 0, ""), (3, 2, ""), (1, 3, "")]));
        model.scene.instances[0].world_from_mesh.transform_point3(DVec3::X)
    };
    // Mode 1 multiplies matrices; 0 keeps scales apart, which here is the same; 2 leaves the scale out.
    near(at(1), DVec3::new(10.0, 4.0, 4.0));
    near(at(0), DVec3::new(10.0, 4.0, 4.0));
    near(at(2), DVec3::new(10.0, 3.0, 4.0));
}

#[test]
fn frames_are_as_the_librarys_own() {
    let v = |seed: u32, scale: f64| {
        [1u32, 2, 3].map(|i| {
            scale
                * (f64::from(seed.wrapping_mul(i.wrapping_mul(2_654_435_761)) >> 20) / 2048.0 - 1.0)
        })
    };
    let names = [
        ("Lcl Translation", 9.0),
        ("Lcl Rotation", 180.0),
        ("PreRotation", 90.0),
        ("PostRotation", 70.0),
        ("RotationPivot", 2.0),
        ("RotationOffset", 3.0),
        ("ScalingPivot", 2.0),
        ("ScalingOffset", 1.0),
        ("GeometricTranslation", 4.0),
        ("GeometricRotation", 180.0),
    ];
    let mut objects = String::new();
    let mut joined = vec![(1, 2, "")];
    for i in 0..12u32 {
        let all: Vec<_> =
            (i + 1..).zip(names).map(|(seed, (name, size))| (name, v(seed * 77, size))).collect();
        let sizes = [
            ("Lcl Scaling", v(i + 5, 1.0).map(|s| s + 1.5)),
            ("GeometricScaling", v(i + 7, 1.0).map(|s| s - 2.0)),
        ];
        let modes = [
            ("InheritType", i % 3),
            ("RotationOrder", i % 6),
            ("RotationActive", u32::from(i != 5)),
        ];
        let modes = modes
            .map(|(name, mode)| format!("P: \"{name}\", \"enum\", \"\", \"\",{mode}\n"))
            .concat();
        objects += &node(i + 2, "Mesh", &(vectors(&all) + &vectors(&sizes) + &modes));
        joined.push((i + 2, i.checked_sub(1).map_or(0, |i| i + 2), ""));
    }
    let text = file(SETTINGS, &objects, &joined);
    let scene = ufbx::load_memory(text.as_bytes(), ufbx::LoadOpts::default()).expect("readable");
    let frames = super::frame::Frames::of(&scene, durer::math::DMat4::IDENTITY);
    assert_eq!(scene.nodes.count, 13);
    for node in &scene.nodes {
        let m = &node.geometry_to_world;
        let (ours, size) = (frames.geometry(node), 1.0 + m.m00.abs().max(m.m03.abs()));
        for (column, [x, y, z]) in [
            [m.m00, m.m10, m.m20],
            [m.m01, m.m11, m.m21],
            [m.m02, m.m12, m.m22],
            [m.m03, m.m13, m.m23],
        ]
        .iter()
        .enumerate()
        {
            let away = ours.col(column).truncate() - DVec3::new(*x, *y, *z);
            assert!(
                away.length() < 1e-9 * size,
                "{}: column {column} by {away}",
                node.element.name
            );
        }
    }
}

#[test]
fn axes_and_units_become_the_worlds() {
    let z_up = SETTINGS
        .replace(
            "\"UpAxis\", \"int\", \"Integer\", \"\",1",
            "\"UpAxis\", \"int\", \"Integer\", \"\",2",
        )
        .replace(
            "\"FrontAxis\", \"int\", \"Integer\", \"\",2",
            "\"FrontAxis\", \"int\", \"Integer\", \"\",1",
        )
        .replace(
            "\"FrontAxisSign\", \"int\", \"Integer\", \"\",1",
            "\"FrontAxisSign\", \"int\", \"Integer\", \"\",-1",
        )
        .replace("Number\", \"\",100", "Number\", \"\",1");
    let model = read(&file(&z_up, &node(2, "Mesh", ""), &[(2, 0, ""), (1, 2, "")]));
    assert_eq!(model.scene.up_axis, UpAxis::Z);
    let p = DVec3::new(1.0, 2.0, 3.0);
    near(model.scene.instances[0].world_from_mesh.transform_point3(p), p / 100.0);
    // x up, as seen from z: −y is to the right.
    let x_up = SETTINGS
        .replace(
            "\"UpAxis\", \"int\", \"Integer\", \"\",1",
            "\"UpAxis\", \"int\", \"Integer\", \"\",0",
        )
        .replace(
            "\"CoordAxis\", \"int\", \"Integer\", \"\",0",
            "\"CoordAxis\", \"int\", \"Integer\", \"\",1",
        )
        .replace(
            "\"CoordAxisSign\", \"int\", \"Integer\", \"\",1",
            "\"CoordAxisSign\", \"int\", \"Integer\", \"\",-1",
        );
    near(placed(&x_up, "", p), DVec3::new(-2.0, 1.0, 3.0));
}

#[test]
fn cameras_and_lights_stand_at_their_nodes() {
    let held = |kind: &str, properties: &str| {
        let held = format!(
            "NodeAttribute: 5, \"NodeAttribute::x\", \"{kind}\" {{ Properties70: {{ {properties} }} }}\n"
        );
        let turned =
            vectors(&[("Lcl Translation", [0.0, 1.0, 7.0]), ("Lcl Rotation", [0.0, 0.0, 90.0])]);
        let objects = [node(2, "Mesh", ""), node(3, kind, &turned), held].concat();
        read(&file(SETTINGS, &objects, &[(2, 0, ""), (1, 2, ""), (3, 0, ""), (5, 3, "")]))
    };
    let lens = number("ApertureMode", 3.0)
        + &number("FilmHeight", 1.0)
        + &number("FilmWidth", 2.0)
        + &number("FocalLength", 12.7)
        + &number("NearPlane", 0.5)
        + &number("FarPlane", 90.0);
    let model =
        held("Camera", &lens.replace("\"ApertureMode\", \"Number\"", "\"ApertureMode\", \"enum\""));
    let found = &model.scene.cameras[0];
    let camera = found.camera;
    assert_eq!((found.name.as_str(), found.aspect), ("node3", Some(2.0)));
    // It faces along x, which is rotated to y.
    near(camera.eye, DVec3::new(0.0, 1.0, 7.0));
    near(camera.target - camera.eye, DVec3::Y);
    near(camera.up, DVec3::NEG_X);
    assert_eq!((camera.near, camera.far), (0.5, 90.0));
    let Projection::Perspective { fov_y } = camera.projection else { panic!("{camera:?}") };
    assert!((fov_y.to_degrees() - 90.0).abs() < 1e-9, "{}", fov_y.to_degrees());
    let kind = |n: u32| format!("P: \"LightType\", \"enum\", \"\", \"\",{n}\n");
    let light = |properties: &str| held("Light", properties).scene.lights[0];
    let sun = light(&(kind(1) + &number("Intensity", 200.0)));
    // It shines along −y, which is rotated to x.
    let LightKind::Directional { direction } = sun.kind else { panic!("{sun:?}") };
    near(direction, DVec3::X);
    assert_eq!(sun.color, Vec3::splat(2.0));
    let square = kind(0) + "P: \"DecayType\", \"enum\", \"\", \"\",2\n";
    let lamp = light(&square);
    assert_eq!(
        (lamp.kind, lamp.color),
        (LightKind::Point { position: camera.eye, range: None }, Vec3::ONE)
    );
    let spot = light(&(kind(2) + &number("InnerAngle", 20.0) + &number("OuterAngle", 60.0)));
    let LightKind::Spot { inner, outer, .. } = spot.kind else { panic!("{spot:?}") };
    assert!((inner.to_degrees() - 10.0).abs() < 1e-9 && (outer.to_degrees() - 30.0).abs() < 1e-9);
    let off = held("Light", "P: \"CastLight\", \"bool\", \"\", \"\",0\n");
    assert_eq!(off.scene.lights, []);
}

#[test]
fn what_is_left_out_is_reported() {
    let hidden = "P: \"Visibility\", \"Visibility\", \"\", \"A\",0\n";
    let model = read(&file(SETTINGS, &node(2, "Mesh", hidden), &[(2, 0, ""), (1, 2, "")]));
    assert_eq!(
        warnings(&model)[0],
        "node2: 1 node is hidden; it and the nodes below it are left out"
    );
    assert!(warnings(&model)[1].contains("no nodes with a mesh"));
    let curve = "AnimationCurve: 40, \"AnimCurve::\", \"\" { KeyVer: 4008 }\nDeformer: 41, \"Deformer::\", \"Skin\" { Version: 101 }\n";
    let objects = node(2, "Mesh", "") + curve;
    let model = read(&file(SETTINGS, &objects, &[(2, 0, ""), (1, 2, ""), (41, 1, "")]));
    assert!(warnings(&model)[0].starts_with("1 skin is not bent"), "{:?}", warnings(&model));
    assert!(warnings(&model)[1].starts_with("1 curve of an animation"), "{:?}", warnings(&model));
    let text = file(
        SETTINGS,
        &node(2, "Mesh", &vectors(&[("Lcl Scaling", [f64::INFINITY, 1.0, 1.0])])),
        &[(2, 0, ""), (1, 2, "")],
    );
    let model = read(&text.replace("inf,", "1e999,"));
    assert!(
        warnings(&model)[0].contains("1 transform has numbers that are not finite"),
        "{:?}",
        warnings(&model)
    );
    let beyond = file(SETTINGS, &node(2, "Mesh", ""), &[(2, 0, ""), (1, 2, "")]);
    let model = read(&beyond.replace("0,1,0,0,1,1,0 }", "0,1,0,0,1,9,0 }"));
    assert!(
        warnings(&model)[0]
            .starts_with("shape: 1 corner refers to a missing normal, color or texture coordinate"),
        "{:?}",
        warnings(&model)
    );
    assert_eq!(model.scene.triangle_count(), 3);
}

#[test]
fn broken_and_large_files_are_refused() {
    let text = file(SETTINGS, &node(2, "Mesh", ""), &[(2, 0, ""), (1, 2, "")]);
    let with = |limits| read_with(&text, &NoResources, limits);
    assert!(with(Limits { primitives: 3, ..Limits::default() }).is_ok());
    let message = |limits| with(limits).expect_err("too much").to_string();
    assert!(message(Limits { primitives: 2, ..Limits::default() }).contains("number of triangles"));
    assert!(message(Limits { instances: 1, ..Limits::default() }).contains("number of nodes"));
    assert!(
        message(Limits { decoded_bytes: 1000, ..Limits::default() })
            .contains("above the limit of 1000")
    );
    let cut = read(&text[..text.find("Model: 2").expect("a node")]);
    assert!(warnings(&cut)[0].starts_with("the file ends before its last"), "{:?}", warnings(&cut));
    let binary = read_with("Kaydara FBX Binary  \0\x1a\0\x16", &NoResources, Limits::default());
    let messages = binary.expect_err("broken").to_string();
    assert!(messages.starts_with("the FBX file cannot be read: "), "{messages}");
    let beyond = read_with(&text.replace("4,5,-7", "4,50,-7"), &NoResources, Limits::default());
    assert!(beyond.expect_err("broken").to_string().contains("an index beyond its list"));
    for end in (0..text.len()).step_by(97) {
        let _ = read_with(&text[..end], &NoResources, Limits::default());
    }
}
