//! PLY files as various programs write them.

use durer::math::{Vec2, Vec3, Vec4};
use durer::scene::{Mesh, ShadingModel, Topology};
use durer_formats::{Limits, Model, NoResources, ReadOptions, Resources, Result, ply};

/// The corners of a unit cube, x fastest.
const CUBE: &str = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n";
const XYZ: &str = "property float x\nproperty float y\nproperty float z\n";

/// Returns an ASCII file with the corners of a cube, further header lines, and further data.
fn cube(head: &str, data: &str) -> String {
    format!("ply\nformat ascii 1.0\nelement vertex 8\n{XYZ}{head}end_header\n{CUBE}{data}")
}

fn read_with(bytes: &[u8], resources: &dyn Resources) -> Result<Model> {
    ply::read(bytes, resources, &ReadOptions::default())
}

fn read(text: &str) -> Model {
    read_with(text.as_bytes(), &NoResources).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn warnings(model: &Model) -> String {
    model.warnings.iter().map(|w| format!("{w}\n")).collect()
}

fn indices(mesh: &Mesh) -> &[u32] {
    mesh.indices.as_deref().unwrap_or_default()
}

const FACE: &str = "property list uchar int vertex_indices\n";
const RGB: &str = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
const RED: Vec4 = Vec4::new(1.0, 0.0, 0.0, 1.0);
const BLUE: Vec4 = Vec4::new(0.0, 0.0, 1.0, 1.0);

#[test]
fn a_file_that_ends_early_is_read_as_far_as_it_goes() {
    let head = format!("element face 6\n{FACE}");
    let whole = cube(&head, "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n");
    for text in
        [&whole[..], &whole[..whole.len() - 1], &format!("{whole}4 1 2"), &format!("{whole}9")]
    {
        let model = read(text);
        assert_eq!((model.scene.triangle_count(), model.warnings.len()), (6, 1), "{text}");
        let warning = model.warnings[0].to_string();
        assert!(warning.contains("3 of 6 rows of element `face`"), "{warning}");
        assert_eq!(model.scene.meshes[0].faces, [0, 2, 4]);
    }
    let points = read(&cube("", "").replace("0 1 1\n1 1 1\n", ""));
    assert_eq!(points.scene.meshes[0].positions.len(), 6);
    assert!(warnings(&points).contains("6 of 8 rows of element `vertex`"), "{}", warnings(&points));
}

#[test]
fn a_binary_file_that_ends_early_too() {
    let head = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\n{XYZ}element face 2\n{FACE}end_header\n"
    );
    let mut bytes = head.clone().into_bytes();
    bytes.extend(
        [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes).as_flattened(),
    );
    let vertices = bytes.len();
    for _ in 0..2 {
        bytes.push(3);
        bytes.extend([0_i32, 1, 2].map(i32::to_le_bytes).as_flattened());
    }
    for (length, triangles, points) in [
        (bytes.len() - 1, 1, 3),
        (vertices + 13, 1, 3),
        (vertices + 12, 0, 3),
        (vertices, 0, 3),
        (vertices - 1, 0, 2),
        (head.len() + 12, 0, 1),
    ] {
        let model = read_with(&bytes[..length], &NoResources).expect("readable");
        let mesh = &model.scene.meshes[0];
        assert_eq!((mesh.triangle_count(), mesh.positions.len()), (triangles, points), "{length}");
        assert!(warnings(&model).contains("and nothing after them"), "{}", warnings(&model));
    }
    assert!(read_with(&bytes[..head.len() + 11], &NoResources).is_err());
}

#[test]
fn faces_before_vertices_that_are_missing_are_left_out() {
    let text = format!(
        "ply\nformat ascii 1.0\nelement face 1\n{FACE}element vertex 3\n{XYZ}end_header\n3 0 1 2\n0 0 0\n1 0 0\n"
    );
    let model = read(&text);
    assert_eq!(model.scene.meshes[0].topology, Topology::Points);
    assert!(warnings(&model).contains("vertices of theirs are missing"), "{}", warnings(&model));
}

#[test]
fn one_wrong_number_costs_one_face() {
    let head = format!("element face 4\n{FACE}");
    let model = read(&cube(&head, "4 0 2 8 1\n3 4 5 7\n4 -1 1 5 4\n3 0 1 2\n"));
    assert_eq!(indices(&model.scene.meshes[0]), [4, 5, 7, 0, 1, 2]);
    let text = warnings(&model);
    assert!(text.contains("vertex 8 does not exist") && text.contains("2 faces"), "{text}");
    assert_eq!(model.warnings.len(), 1);
}

#[test]
fn empty_and_small_faces_are_counted() {
    let model = read(&cube(&format!("element face 4\n{FACE}"), "0\n1 5\n3 0 1 2\n2 1 2\n"));
    assert_eq!(model.scene.triangle_count(), 1);
    assert!(warnings(&model).contains("3 faces have fewer than three"), "{}", warnings(&model));
}

#[test]
fn names_in_capitals_and_wide_integers() {
    let model = read(
        "ply\nformat ascii 1.0\nelement Vertex 3\nproperty int64 X\nproperty uint64 Y\nproperty float Z\n\
         property uchar Red\nproperty uchar Green\nproperty uchar Blue\nelement FACE 1\n\
         property list int64 uint64 Vertex_Indices\nend_header\n\
         9007199254740992 0 0 255 0 0\n9007199254740994 0 0 255 0 0\n9007199254740992 2 0 255 0 0\n3 0 1 2\n",
    );
    assert!(model.warnings.is_empty(), "{}", warnings(&model));
    let mesh = &model.scene.meshes[0];
    assert_eq!(mesh.colors, [RED; 3]);
    assert_eq!(mesh.positions[1] - mesh.positions[0], 2.0 * Vec3::X);
}

#[test]
fn faces_keep_their_colours_and_share_vertices_where_they_agree() {
    let head = format!("element face 3\n{FACE}{RGB}");
    let model = read(&cube(&head, "4 0 2 3 1 255 0 0\n3 0 1 5 255 0 0\n3 0 5 4 0 0 255\n"));
    assert!(model.warnings.is_empty(), "{}", warnings(&model));
    let mesh = &model.scene.meshes[0];
    let color = |face: usize| {
        let corners = mesh.triangle(mesh.faces[face] as usize);
        corners.map(|v| mesh.colors[v as usize])
    };
    assert_eq!((color(0), color(1), color(2)), ([RED; 3], [RED; 3], [BLUE; 3]));
    // Four corners and one more are red, three are blue.
    assert_eq!(mesh.positions.len(), 8);
    assert_eq!(indices(mesh), [0, 1, 2, 0, 2, 3, 0, 3, 4, 5, 6, 7]);
    assert_eq!(
        (mesh.positions[4], mesh.positions[6]),
        (Vec3::new(1.0, 0.0, 1.0), mesh.positions[4])
    );
    assert_eq!((mesh.faces.as_slice(), mesh.parts[0].material), (&[0, 2, 3][..], Some(0)));
}

#[test]
fn colours_of_vertices_that_differ_go_before_those_of_faces() {
    let file = |third: &str| {
        read(&format!(
            "ply\nformat ascii 1.0\nelement vertex 3\n{XYZ}{RGB}element face 1\n{FACE}{RGB}end_header\n\
             0 0 0 9 9 9\n1 0 0 9 9 9\n0 1 0 {third}\n3 0 1 2 255 0 0\n"
        ))
    };
    let same = file("9 9 9");
    assert_eq!((same.scene.meshes[0].colors[0], same.warnings.len()), (RED, 0));
    let differ = file("0 0 255");
    assert_eq!(differ.scene.meshes[0].colors[2], BLUE);
    assert!(warnings(&differ).contains("those of vertices are shown"), "{}", warnings(&differ));
}

#[test]
fn edges_keep_their_colours() {
    let head = format!("element edge 3\nproperty int vertex1\nproperty int vertex2\n{RGB}");
    let model = read(&cube(&head, "0 1 255 0 0\n1 3 255 0 0\n3 2 0 0 255\n"));
    assert!(model.warnings.is_empty(), "{}", warnings(&model));
    let mesh = &model.scene.meshes[0];
    assert_eq!(mesh.topology, Topology::Lines);
    assert_eq!(indices(mesh), [0, 1, 1, 2, 3, 4]);
    assert_eq!(mesh.colors, [RED, RED, RED, BLUE, BLUE]);
}

/// Finds one picture of four texels, by either of two names.
struct Pictures;

impl Resources for Pictures {
    fn read(&self, path: &str, _limit: u64) -> std::result::Result<Vec<u8>, String> {
        if !["quad.png", "other one.png"].contains(&path) {
            return Err("no such file".to_owned());
        }
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 2, 2);
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header().expect("header");
        writer.write_image_data(&[100; 12]).expect("data");
        writer.finish().expect("end");
        Ok(bytes)
    }
}

fn textured(text: &str) -> Model {
    read_with(text.as_bytes(), &Pictures).expect("readable")
}

#[test]
fn corners_have_the_texture_coordinates_of_their_face() {
    let head = format!(
        "comment TextureFile quad.png\nelement face 2\n{FACE}property list uchar float texcoord\n"
    );
    let data = "4 0 2 3 1 8 0 0 1 0 1 1 0 1\n4 4 5 7 6 8 0 0 1 0 1 1 0 1\n";
    let model = textured(&cube(&head, data));
    assert!(model.warnings.is_empty(), "{}", warnings(&model));
    let mesh = &model.scene.meshes[0];
    let coords: Vec<Vec2> = indices(mesh).iter().map(|&i| mesh.tex_coords[0][i as usize]).collect();
    let [a, b, c, d] =
        [(0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (0.0, 0.0)].map(|(u, v)| Vec2::new(u, v));
    assert_eq!(coords, [a, b, c, a, c, d, a, b, c, a, c, d]);
    assert_eq!((mesh.positions.len(), &mesh.faces[..]), (8, &[0, 2][..]));
    let material = &model.scene.materials[mesh.parts[0].material.expect("material")];
    assert_eq!((material.base_color, material.base_color_texture.is_some()), (Vec4::ONE, true));
    assert_eq!(model.scene.images[0].width, 2);
}

#[test]
fn a_missing_picture_and_missing_coordinates_are_reported() {
    let coords = format!("element face 1\n{FACE}property list uchar float texcoord\n");
    let data = "3 0 1 2 6 0 0 1 0 1 1\n";
    let gone = textured(&cube(&format!("comment TextureFile gone.png\n{coords}"), data));
    assert!(
        warnings(&gone).contains("`gone.png` is left out: no such file"),
        "{}",
        warnings(&gone)
    );
    assert!(gone.scene.materials.is_empty() && gone.scene.meshes[0].parts.is_empty());
    let head = format!("comment TextureFile quad.png\nelement face 1\n{FACE}");
    let none = textured(&cube(&head, "3 0 1 2\n"));
    assert!(warnings(&none).contains("no texture coordinates"), "{}", warnings(&none));
    let odd =
        textured(&cube(&format!("comment TextureFile quad.png\n{coords}"), "3 0 1 2 4 0 0 1 0\n"));
    assert!(warnings(&odd).contains("1 face has different numbers"), "{}", warnings(&odd));
}

#[test]
fn several_pictures_by_their_numbers() {
    let head = format!(
        "comment TextureFile quad.png\ncomment TextureFile other one.png\nelement face 5\n{FACE}\
         property list uchar float texcoord\nproperty int texnumber\n"
    );
    let data = "4 0 2 3 1 8 0 0 1 0 1 1 0 1 1\n3 4 5 7 6 0 0 1 0 1 1 0\n3 4 5 6 6 0 0 1 0 1 1 0\n\
                3 0 1 2 0 -1\n3 0 1 2 0 7\n";
    let model = textured(&cube(&head, data));
    let parts: Vec<_> =
        model.scene.meshes[0].parts.iter().map(|p| (p.range.clone(), p.material)).collect();
    assert_eq!(parts, [(0..2, Some(1)), (2..4, Some(0)), (4..6, None)]);
    assert_eq!(model.scene.materials[1].name, "other one.png");
    assert!(warnings(&model).contains("1 face names a picture"), "{}", warnings(&model));
    assert_eq!(model.warnings.len(), 1, "{}", warnings(&model));
}

#[test]
fn what_is_not_drawn_is_reported() {
    let head = "element polyline 2\nproperty list uchar int vertex_indices\nelement face 1\n\
                property list uchar int polygon\nelement edge 1\nproperty int from\nelement camera 1\n\
                property float view_px\nelement material 1\nproperty uchar diffuse_red\n";
    let model = read(&cube(head, "2 0 1\n2 1 2\n3 0 1 2\n7\n1\n1\n"));
    let text = warnings(&model);
    assert_eq!(model.warnings.len(), 3, "{text}");
    for name in ["`polyline` has a name", "`face` has no list", "`edge` has no properties"] {
        assert!(text.contains(name), "{text}");
    }
}

/// Returns a file of splats with one row each.
fn splats(rows: &[&str]) -> Vec<u8> {
    let names = "x y z nx ny nz f_dc_0 f_dc_1 f_dc_2 f_rest_0 opacity scale_0 scale_1 scale_2 rot_0 \
                 rot_1 rot_2 rot_3";
    let properties: String =
        names.split_whitespace().map(|n| format!("property float {n}\n")).collect();
    let count = rows.len();
    let rows = rows.join("\n");
    format!("ply\nformat ascii 1.0\nelement vertex {count}\n{properties}end_header\n{rows}\n")
        .into()
}

#[test]
fn splats_are_discs_of_their_first_colour() {
    let bytes = splats(&[
        "5 0 0 0 0 0 1.7724538509 -1.7724538509 9 0 5 0 0 -9 1 0 0 0",
        "1 0 0 0 0 0 1 1 1 0 -5 0 0 -9 1 0 0 0",
        "1 0 0 0 0 0 1 1 1 0 5 0 0 -9 0 0 0 0",
    ]);
    let model = read_with(&bytes, &NoResources).expect("readable");
    let text = warnings(&model);
    assert!(
        text.contains("1 splat of an opacity") && text.contains("1 splat has no finite"),
        "{text}"
    );
    let mesh = &model.scene.meshes[0];
    assert_eq!((mesh.triangle_count(), mesh.positions.len()), (4, 6));
    for (p, c) in mesh.positions.iter().zip(&mesh.colors) {
        assert!((p.distance(5.0 * Vec3::X) - 1.5).abs() < 1e-5 && p.z.abs() < 1e-5, "{p}");
        assert!(c.distance(Vec4::new(1.0, 0.0, 1.0, 1.0)) < 1e-6, "{c}");
    }
    let area: f32 = (0..4)
        .map(|t| mesh.triangle(t).map(|v| mesh.positions[v as usize]))
        .map(|[a, b, c]| (b - a).cross(c - a).z / 2.0)
        .sum();
    assert!((area - 1.5 * 1.5 * 2.598_076).abs() < 1e-4, "{area}");
    assert_eq!(model.scene.materials[0].model, ShadingModel::Unlit);

    // The same from all sides if the radii are equal.
    let round = splats(&["5 0 0 0 0 0 1 1 1 0 5 0 0 -0.5 1 0 0 0"]);
    let solid = read_with(&round, &NoResources).expect("readable");
    assert_eq!((solid.scene.triangle_count(), solid.scene.meshes[0].positions.len()), (8, 6));

    let limits = Limits { primitives: 3, ..Limits::default() };
    assert!(
        ply::read(&bytes, &NoResources, &ReadOptions { limits, ..ReadOptions::default() }).is_err()
    );
}

#[test]
fn packed_splats_are_not_taken_for_something_else() {
    let text = "ply\nformat binary_little_endian 1.0\nelement chunk 1\nproperty float min_x\n\
                element vertex 1\nproperty uint packed_position\nend_header\n12345678";
    let message = read_with(text.as_bytes(), &NoResources).expect_err("packed").to_string();
    assert!(message.contains("packed splats"), "{message}");
}

#[test]
fn a_concave_face_is_the_polygon() {
    let model = read(
        "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n\
         element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n3 0 0\n3 3 0\n2 3 0\n\
         2 1 0\n1 1 0\n1 3 0\n0 3 0\n8 0 1 2 3 4 5 6 7\n",
    );
    let mesh = &model.scene.meshes[0];
    let area: f32 = (0..mesh.triangle_count())
        .map(|t| mesh.triangle(t).map(|v| mesh.positions[v as usize]))
        .map(|[a, b, c]| (b - a).cross(c - a).length() / 2.0)
        .sum();
    assert_eq!((area, &mesh.faces[..]), (7.0, &[0][..]));
}

#[test]
fn nonsense_after_some_faces_costs_the_rest() {
    let head = format!("element face 4\n{FACE}");
    let model = read(&cube(&head, "3 0 1 2\n3 1 2 3\n-3 what\n3 0 1 2\n"));
    assert_eq!(model.scene.triangle_count(), 2);
    let text = warnings(&model);
    assert!(
        text.contains("line 20, column 1: `-3` is not a length") && text.contains("2 of 4 rows"),
        "{text}"
    );
}

#[test]
fn lines_of_a_header_that_are_no_words_of_it_are_skipped() {
    let text = cube("Created by a program that forgot the word\n", "");
    let model = read(&text);
    assert_eq!(model.scene.meshes[0].positions.len(), 8);
    assert!(
        warnings(&model).contains("line 7: 1 line is not of a PLY header"),
        "{}",
        warnings(&model)
    );
}
