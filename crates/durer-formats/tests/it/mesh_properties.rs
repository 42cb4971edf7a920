//! Random meshes through every encoding, and files damaged by random changes.

use durer::math::Vec3;
use durer::scene::Mesh;
use durer_formats::{Limits, Model, NoResources, ReadOptions, Result, read_model};
use proptest::prelude::*;

fn options() -> ReadOptions {
    let limits = Limits { primitives: 1 << 20, decoded_bytes: 1 << 24, ..Limits::default() };
    ReadOptions { limits, ..ReadOptions::default() }
}

fn read(bytes: &[u8], name: &str) -> Result<Model> {
    read_model(bytes, name, &NoResources, &options())
}

fn only_mesh(bytes: &[u8], name: &str) -> Mesh {
    let model = read(bytes, name).unwrap_or_else(|e| panic!("{e}"));
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    model.scene.meshes.into_iter().next().expect("one mesh")
}

/// Returns vertices and triangles between them.
fn mesh() -> impl Strategy<Value = (Vec<[f32; 3]>, Vec<[u32; 3]>)> {
    (1usize..40).prop_flat_map(|n| {
        let vertices = proptest::collection::vec(proptest::array::uniform3(-1e3..1e3f32), n);
        let corner = 0..n as u32;
        let triangles = proptest::collection::vec((corner.clone(), corner.clone(), corner), 1..60);
        (vertices, triangles.prop_map(|t| t.into_iter().map(|(a, b, c)| [a, b, c]).collect()))
    })
}

fn soup(vertices: &[[f32; 3]], triangles: &[[u32; 3]]) -> Vec<[f32; 3]> {
    triangles.iter().flatten().map(|&v| vertices[v as usize]).collect()
}

fn stl_binary(soup: &[[f32; 3]]) -> Vec<u8> {
    let mut bytes = b"solid or not".to_vec();
    bytes.resize(80, 0);
    bytes.extend((soup.len() as u32 / 3).to_le_bytes());
    for triangle in soup.chunks(3) {
        bytes.extend([0; 12]);
        bytes.extend(triangle.iter().flatten().flat_map(|v| v.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

fn stl_ascii(soup: &[[f32; 3]]) -> Vec<u8> {
    let mut text = String::from("solid\n");
    for t in soup.chunks(3) {
        text += "facet normal 0 0 0\n outer loop\n";
        for [x, y, z] in t {
            text += &format!("  vertex {x:e} {y} {z}\n");
        }
        text += " endloop\nendfacet\n";
    }
    (text + "endsolid\n").into_bytes()
}

fn obj(vertices: &[[f32; 3]], triangles: &[[u32; 3]]) -> Vec<u8> {
    let mut text = String::from("mtllib a.mtl\no x\n");
    for [x, y, z] in vertices {
        text += &format!("v {x} {y:e} {z}\n");
    }
    text += "vt 0 0\nusemtl m\n";
    for (i, t) in triangles.iter().enumerate() {
        let relative = |v: u32| i64::from(v) - vertices.len() as i64;
        let [a, b, c] = t.map(|v| v + 1);
        text += &if i % 2 == 0 {
            format!("f {a} {b} {c}\n")
        } else {
            format!("f {} {} \\\n{}\n", relative(t[0]), relative(t[1]), relative(t[2]))
        };
    }
    text.into_bytes()
}

#[derive(Clone, Copy, PartialEq)]
enum Ply {
    Ascii,
    Little,
    Big,
}

fn ply(kind: Ply, vertices: &[[f32; 3]], triangles: &[[u32; 3]]) -> Vec<u8> {
    let name = match kind {
        Ply::Ascii => "ascii",
        Ply::Little => "binary_little_endian",
        Ply::Big => "binary_big_endian",
    };
    let mut bytes = format!(
        "ply\nformat {name} 1.0\nelement vertex {}\nproperty float x\nproperty float y\n\
         property float z\nelement face {}\nproperty list uchar uint vertex_indices\n\
         property short tag\nend_header\n",
        vertices.len(),
        triangles.len()
    )
    .into_bytes();
    let number = |le: [u8; 4]| -> Vec<u8> {
        if kind == Ply::Big { le.iter().rev().copied().collect() } else { le.to_vec() }
    };
    for v in vertices {
        match kind {
            Ply::Ascii => bytes.extend(format!("{} {} {}\n", v[0], v[1], v[2]).bytes()),
            _ => bytes.extend(v.iter().flat_map(|x| number(x.to_le_bytes()))),
        }
    }
    for t in triangles {
        if kind == Ply::Ascii {
            bytes.extend(format!("3 {} {} {} -7\n", t[0], t[1], t[2]).bytes());
        } else {
            bytes.push(3);
            bytes.extend(t.iter().flat_map(|x| number(x.to_le_bytes())));
            bytes.extend([0xff, 0xff]);
        }
    }
    bytes
}

fn vectors(values: &[[f32; 3]]) -> Vec<Vec3> {
    values.iter().copied().map(Vec3::from_array).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn meshes_come_back_from_stl((vertices, triangles) in mesh()) {
        let soup = soup(&vertices, &triangles);
        for bytes in [stl_binary(&soup), stl_ascii(&soup)] {
            let mesh = only_mesh(&bytes, "x");
            prop_assert_eq!(&mesh.indices, &None);
            prop_assert_eq!(&mesh.positions, &vectors(&soup));
        }
    }

    #[test]
    fn meshes_come_back_from_ply((vertices, triangles) in mesh()) {
        for kind in [Ply::Ascii, Ply::Little, Ply::Big] {
            let mesh = only_mesh(&ply(kind, &vertices, &triangles), "x");
            prop_assert_eq!(&mesh.positions, &vectors(&vertices));
            prop_assert_eq!(mesh.indices, Some(triangles.concat()));
        }
    }

    #[test]
    fn meshes_come_back_from_obj((vertices, triangles) in mesh()) {
        let model = read(&obj(&vertices, &triangles), "x").expect("readable");
        prop_assert_eq!(&model.scene.meshes[0].positions, &vectors(&vertices));
        prop_assert_eq!(&model.scene.meshes[0].indices, &Some(triangles.concat()));
    }
}

/// A simple generator of changes: xorshift, Marsaglia 2003.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % n.max(1) as u64) as usize
    }
}

#[test]
fn broken_files_never_panic() {
    let vertices: Vec<[f32; 3]> = (0..12).map(|i| [i as f32, 0.5 * i as f32, -1.0]).collect();
    let triangles: Vec<[u32; 3]> = (0..10).map(|i| [i, i + 1, i + 2]).collect();
    let soup = soup(&vertices, &triangles);
    let full_obj = b"mtllib a\nv 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nvt 0 1\nvn 0 0 1\nusemtl a\n\
                     f 1/1/1 2/1/1 3//1 -1\nl 1 2 3\np 1 2\ng x\ns 1\nf 1 2 \\\n3\n";
    let package = crate::threemf::simple(
        "meter",
        "<object id=\"1\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/></vertices><triangles>\
         <triangle v1=\"0\" v2=\"0\" v3=\"0\"/></triangles></mesh></object>",
        "<item objectid=\"1\"/>",
    );
    let files = [
        ("a.stl", stl_binary(&soup)),
        ("b.stl", stl_ascii(&soup)),
        ("c.obj", obj(&vertices, &triangles)),
        ("d.obj", full_obj.to_vec()),
        ("e.ply", ply(Ply::Ascii, &vertices, &triangles)),
        ("f.ply", ply(Ply::Little, &vertices, &triangles)),
        ("g.ply", ply(Ply::Big, &vertices, &triangles)),
        ("h.3mf", package),
    ];
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let words: [&[u8]; 8] =
        [b"-1", b"4294967296", b"nan", b"1e999", b"\\\n", b"/", b"\xff\xff\xff\xff", b"\0"];
    let mut readable = 0;
    for (name, file) in &files {
        for _ in 0..500 {
            let mut bytes = file.clone();
            for _ in 0..1 + random.below(3) {
                let at = random.below(bytes.len());
                match random.below(4) {
                    0 => bytes.truncate(at),
                    1 => drop(bytes.splice(at..at, words[random.below(8)].iter().copied())),
                    _ if at < bytes.len() => bytes[at] = random.below(256) as u8,
                    _ => {}
                }
            }
            readable += usize::from(read(&bytes, name).is_ok());
        }
    }
    assert!((100..3900).contains(&readable), "{readable} of 4000 were readable");
}

#[test]
fn decimal_commas_are_points() {
    let expected = [[0.5, 0.0, 0.0], [1.25, 0.0, 0.0], [0.0, 2.0, -0.125]];
    let files = [
        ("a.obj", "v 0,5 0,0 0,0\nv 1,25 0 0,0\nv 0,0 2,0 -0,125\nf 1 2 3\n"),
        ("a.off", "OFF\n3 1 0\n0,5 0 0\n1,25 0 0\n0 2 -0,125\n3 0 1 2\n"),
        (
            "a.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0,5 0 0\n1,25 0 0\n0 2 -0,125\n3 0 1 2\n",
        ),
        (
            "a.stl",
            "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0,5 0 0\nvertex 1,25 0 0\nvertex 0 2 -0,125\nendloop\nendfacet\nendsolid\n",
        ),
        ("a.xyz", "0,5 0,0 0,0\n1,25 0 0,0\n0,0 2,0 -0,125\n"),
        ("b.xyz", "0,5;0,0;0,0\n1,25;0;0,0\n0,0;2,0;-0,125\n"),
    ];
    for (name, text) in files {
        let model = read(text.as_bytes(), name).expect(name);
        let scene = &model.scene;
        let at = |p: &Vec3| scene.instances[0].world_from_mesh.transform_point3(p.as_dvec3());
        let found: Vec<_> = scene.meshes[0].positions.iter().map(|p| at(p).to_array()).collect();
        assert_eq!(found, expected, "{name}: {:?}", model.warnings);
        let messages = model.warnings.iter().any(|w| w.message.contains("decimal comma"));
        assert!(messages || name.ends_with("xyz"), "{name}: {:?}", model.warnings);
    }
    let lists = read(b"1,2,3\n4,5,6\n7,8,9\n", "a.xyz").expect("a list");
    assert_eq!(lists.scene.meshes[0].positions[1], Vec3::new(4.0, 5.0, 6.0));
}
