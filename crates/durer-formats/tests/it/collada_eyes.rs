//! Cameras and lights of COLLADA documents written by the tests.

use durer::math::{DVec3, Vec3};
use durer::scene::{LightKind, Projection};
use durer_formats::{Model, NoResources, ReadOptions, read_model};

/// Returns a document in centimetres of a triangle and a node that holds a camera or a light: the element `held` with
/// this content.
fn read(held: &str, content: &str, tool: &str) -> Model {
    let text = format!(
        r##"<?xml version="1.0"?><COLLADA version="1.4.1">
        <asset><contributor><authoring_tool>{tool}</authoring_tool></contributor><unit meter="0.01"/></asset>
        <library_x><{held} id="x" name="it">{content}</{held}></library_x>
        <library_geometries><geometry id="g"><mesh>
        <source id="p"><float_array>-100 0 0 100 0 0 0 100 0</float_array>
        <technique_common><accessor stride="3"/></technique_common></source>
        <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
        <triangles><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>
        <library_visual_scenes><visual_scene id="s">
        <node id="a"><instance_geometry url="#g"/></node>
        <node id="h"><translate>0 0 500</translate><rotate>1 0 0 -90</rotate><scale>3 3 3</scale><instance_{held} url="#x"/></node>
        </visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>"##
    );
    let options = ReadOptions { own_lights: true, ..ReadOptions::default() };
    let shining = read_model(text.as_bytes(), "x", &NoResources, &options).expect("readable");
    let options = ReadOptions::default();
    let plain = read_model(text.as_bytes(), "x", &NoResources, &options).expect("readable");
    assert_eq!(plain.scene.lights, []);
    shining
}

fn optics(kind: &str, content: &str) -> Model {
    let content =
        format!("<optics><technique_common><{kind}>{content}</{kind}></technique_common></optics>");
    read("camera", &content, "")
}

fn near(a: f64, b: f64) {
    assert!((a - b).abs() < 1e-9 * b.abs().max(1.0), "{a} {b}");
}

#[test]
fn cameras_stand_at_their_nodes() {
    let model = optics("perspective", "<yfov>60</yfov><znear>10</znear><zfar>2000</zfar>");
    assert_eq!(model.warnings, []);
    let [found] = &model.scene.cameras[..] else { panic!("one camera") };
    assert_eq!((found.name.as_str(), found.aspect), ("it", None));
    let camera = found.camera;
    assert_eq!(camera.eye, DVec3::new(0.0, 0.0, 5.0));
    // Turned from −z to −y, and up from y to −z.
    assert!((camera.target - camera.eye - DVec3::NEG_Y).length() < 1e-12, "{}", camera.target);
    assert!((camera.up - DVec3::NEG_Z).length() < 1e-12, "{}", camera.up);
    near(camera.near, 0.1);
    near(camera.far, 20.0);
}

#[test]
fn angles_and_sizes_of_view() {
    for (content, fov, aspect) in [
        ("<yfov>60</yfov><aspect_ratio>2</aspect_ratio>", 60.0, Some(2.0)),
        ("<xfov>90</xfov>", 90.0, None),
        ("<xfov>90</xfov><aspect_ratio>2</aspect_ratio>", 53.130_102_354_155_98, Some(2.0)),
        ("<xfov>90</xfov><yfov>53.13010235415598</yfov>", 53.130_102_354_155_98, Some(2.0)),
    ] {
        let found = optics("perspective", content).scene.cameras.remove(0);
        let Projection::Perspective { fov_y } = found.camera.projection else {
            panic!("{content}")
        };
        near(fov_y.to_degrees(), fov);
        assert_eq!(found.aspect.is_some(), aspect.is_some(), "{content}");
        near(found.aspect.unwrap_or(0.0), aspect.unwrap_or(0.0));
        // Without clipping planes nothing is cut off.
        assert!(found.camera.near < 0.01 && found.camera.far > 5.0);
    }
    for (content, size, aspect) in [
        ("<ymag>50</ymag>", 1.0, None),
        ("<xmag>100</xmag><ymag>50</ymag>", 1.0, Some(2.0)),
        ("<xmag>100</xmag><aspect_ratio>4</aspect_ratio>", 0.5, Some(4.0)),
    ] {
        let found = optics("orthographic", content).scene.cameras.remove(0);
        let Projection::Orthographic { height } = found.camera.projection else {
            panic!("{content}")
        };
        near(height, size);
        assert_eq!(found.aspect, aspect);
    }
    for (kind, content, why) in [
        ("perspective", "", "it has no angle of view"),
        ("perspective", "<yfov>200</yfov>", "fov"),
        ("orthographic", "<znear>1</znear>", "it has no size of view"),
        ("other", "", "it has no projection"),
    ] {
        let model = optics(kind, content);
        assert_eq!(model.scene.cameras, []);
        let messages = model.warnings[0].to_string();
        assert!(messages.starts_with("line 3, column ") && messages.contains(why), "{messages}");
        assert!(messages.ends_with("; the camera is left out"), "{messages}");
    }
}

fn lamp(kind: &str, content: &str, tool: &str) -> Model {
    let content = format!("<technique_common><{kind}>{content}</{kind}></technique_common>");
    read("light", &content, tool)
}

#[test]
fn lights_shine_from_their_nodes() {
    let position = DVec3::new(0.0, 0.0, 5.0);
    let light = |kind: &str, content: &str| {
        let model = lamp(kind, content, "");
        assert_eq!(model.warnings, []);
        let [light] = model.scene.lights[..] else { panic!("one light") };
        light
    };
    let sun = light("directional", "<color>1 0.5 0</color>");
    let LightKind::Directional { direction } = sun.kind else { panic!("{sun:?}") };
    assert!((direction - DVec3::NEG_Y).length() < 1e-12);
    assert!((sun.color - Vec3::new(1.0, 0.214_041, 0.0)).length() < 1e-5, "{}", sun.color);
    // Intensity 2 at the middle of the scene, which is half a metre above the origin, and everywhere else.
    let middle = DVec3::new(0.0, 0.5, 0.0);
    let point = light("point", "<color>2 2 2</color>");
    let LightKind::Directional { direction } = point.kind else { panic!("{point:?}") };
    assert!((direction - (middle - position).normalize()).length() < 1e-12);
    near(f64::from(point.color.x), 2.0);
    // Spot lights fall off with the square all the same.
    let spot = light("spot", "<color>2 2 2</color>");
    near(f64::from(spot.color.x), f64::from(2.0 * middle.distance_squared(position) as f32));
    // Distances are those in the file, wherever the scene is; its units are centimetres.
    let square = "<constant_attenuation>0</constant_attenuation><quadratic_attenuation>0.25</quadratic_attenuation>";
    let point = light("point", &format!("<color>1 1 1</color>{square}"));
    assert_eq!(point.kind, LightKind::Point { position, range: None });
    assert!((point.color - Vec3::splat(4e-4)).length() < 1e-9, "{}", point.color);
    for (content, inner, outer) in [
        ("<falloff_angle>60</falloff_angle>", 30.0, 30.0),
        ("<falloff_angle>60</falloff_angle><falloff_exponent>2</falloff_exponent>", 0.0, 30.0),
        ("", 90.0, 90.0),
    ] {
        let found = light("spot", content).kind;
        let LightKind::Spot { inner: i, outer: o, .. } = found else { panic!("{found:?}") };
        near(i.to_degrees(), inner);
        near(o.to_degrees(), outer);
    }
}

#[test]
fn colors_of_lights_are_as_those_of_materials() {
    let color =
        |tool: &str| lamp("directional", "<color>500 1000 0</color>", tool).scene.lights[0].color;
    assert!((color("Blender 2.93.1") - Vec3::new(500.0, 1000.0, 0.0)).length() < 1e-3);
    // The intensity is no part of the falloff curve.
    assert!((color("other") - Vec3::new(214.041, 1000.0, 0.0)).length() < 1e-2);
}

#[test]
fn lights_that_show_nothing_are_left_out() {
    assert_eq!(lamp("ambient", "<color>1 1 1</color>", "").scene.lights, []);
    assert_eq!(lamp("point", "<color>0 0 0</color>", "").scene.lights, []);
    let unknown = lamp("area", "", "");
    assert_eq!(unknown.scene.lights, []);
    let messages = unknown.warnings[0].to_string();
    assert!(messages.contains("1 light is of no known kind"), "{messages}");
}
