//! glTF from open files: the same models as from bytes, without the whole file in memory.

use crate::shared;
use durer::math::Vec3;
use durer_formats::{Error, Limits, Model, NoResources, ReadOptions, Resources, Result, gltf};
use std::io::{self, Cursor, Read, Seek, SeekFrom};

/// Vertices of 20 bytes each: a position, two unused bytes, a normalized colour, and an index.
const VERTICES: u32 = 30_000;
const STRIDE: u32 = 20;

fn position(i: u32) -> Vec3 {
    Vec3::new(i as f32, (i * 7 % 1000) as f32, -0.5 * i as f32)
}

/// Returns the vertices, and after them twice as many indices of four bytes.
fn buffer() -> Vec<u8> {
    let mut bytes = Vec::new();
    for i in 0..VERTICES {
        bytes.extend(position(i).to_array().iter().flat_map(|v| v.to_le_bytes()));
        bytes.extend([9, 9, i as u8, 128, 255, 0]);
        bytes.extend((i as u16).to_le_bytes());
    }
    bytes.extend((0..2 * VERTICES).flat_map(|i| (i / 2).to_le_bytes()));
    bytes
}

fn glb(json: &str, buffer: &[u8]) -> Vec<u8> {
    let json = format!("{json}{}", " ".repeat(json.len().wrapping_neg() % 4));
    let word = |v: usize| (v as u32).to_le_bytes();
    let chunk = |kind: &[u8], data: &[u8]| [&word(data.len()), kind, data].concat();
    let chunks = [chunk(b"JSON", json.as_bytes()), chunk(b"BIN\0", buffer)].concat();
    [b"glTF\x02\0\0\0", &word(12 + chunks.len())[..], &chunks].concat()
}

/// Returns a file of points with colours, whose indices are of `index_bytes` bytes.
fn points(index_bytes: u32) -> Vec<u8> {
    let vertices = VERTICES * STRIDE;
    let indices = match index_bytes {
        2 => format!(
            r#"{{"bufferView":0,"byteOffset":18,"componentType":5123,"count":{VERTICES},"type":"SCALAR"}}"#
        ),
        _ => format!(
            r#"{{"bufferView":1,"componentType":5125,"count":{},"type":"SCALAR"}}"#,
            2 * VERTICES
        ),
    };
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0}}],"buffers":[{{"byteLength":{}}}],
        "bufferViews":[{{"buffer":0,"byteLength":{vertices},"byteStride":{STRIDE}}},
        {{"buffer":0,"byteOffset":{vertices},"byteLength":{}}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":{VERTICES},"type":"VEC3"}},
        {{"bufferView":0,"byteOffset":14,"componentType":5121,"normalized":true,"count":{VERTICES},"type":"VEC3"}},
        {indices}],"meshes":[{{"primitives":[{{"mode":0,"attributes":{{"POSITION":0,"COLOR_0":1}},"indices":2}}]}}]}}"#,
        vertices + 8 * VERTICES,
        8 * VERTICES
    );
    glb(&json, &buffer())
}

/// A file that remembers the largest piece requested.
struct Watched<'a> {
    file: Cursor<&'a [u8]>,
    largest: &'a mut usize,
}

impl Read for Watched<'_> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        *self.largest = to.len().max(*self.largest);
        self.file.read(to)
    }
}

impl Seek for Watched<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

#[test]
fn accessors_are_read_in_pieces() {
    for index_bytes in [2, 4] {
        let file = points(index_bytes);
        let mut largest = 0;
        let watched = Watched { file: Cursor::new(&file), largest: &mut largest };
        let model = gltf::read_file(watched, &NoResources, &ReadOptions::default()).unwrap();
        assert_eq!(model, gltf::read(&file, &NoResources, &ReadOptions::default()).unwrap());
        let mesh = &model.scene.meshes[0];
        assert!(mesh.positions.iter().zip(0..VERTICES).all(|(p, i)| *p == position(i)));
        let color = |i: u32| [f32::from(i as u8) / 255.0, 128.0 / 255.0, 1.0, 1.0];
        assert!(mesh.colors.iter().zip(0..VERTICES).all(|(c, i)| c.to_array() == color(i)));
        let (each, count) = if index_bytes == 2 { (1, VERTICES) } else { (2, 2 * VERTICES) };
        let indices = mesh.indices.as_ref().unwrap();
        assert!(indices.iter().zip(0..count).all(|(index, i)| *index == i / each));
        assert_eq!((mesh.positions.len(), indices.len()), (VERTICES as usize, count as usize));
        assert!((1000..100_000).contains(&largest), "{largest} bytes at a time");
    }
}

/// Reads the same bytes from memory and from an open file; both must give the same result.
fn both(bytes: &[u8], resources: &dyn Resources, options: &ReadOptions) -> Result<Model> {
    let model = gltf::read(bytes, resources, options);
    let opened = gltf::read_file(Cursor::new(bytes), resources, options);
    match (&model, &opened) {
        (Ok(model), Ok(opened)) => assert!(model == opened),
        _ => assert_eq!(format!("{opened:?}"), format!("{model:?}")),
    }
    model
}

#[test]
fn cut_and_damaged_files_fail_alike() {
    let file = points(4);
    let options = ReadOptions::default();
    assert!(both(&file, &NoResources, &options).is_ok());
    for cut in (0..1200).chain([file.len() / 2, file.len() - 1]) {
        assert!(both(&file[..cut], &NoResources, &options).is_err(), "{cut}");
    }
    let mut refused = 0;
    for at in 0..1200 {
        let mut damaged = file.clone();
        damaged[at] ^= 1;
        refused += u32::from(both(&damaged, &NoResources, &options).is_err());
    }
    assert!(refused > 100, "{refused}");
    let mut dangling = file.clone();
    dangling[file.len() - 2] = 1;
    let model = both(&dangling, &NoResources, &options).unwrap();
    let messages = model.warnings.last().unwrap().to_string();
    assert!(messages.contains("1 point with a corner that is not a vertex"), "{messages}");
    assert!(messages.contains("index 59999 is vertex"), "{messages}");
}

#[test]
fn real_files_give_the_same_models() {
    let Some(data) = shared::data() else { return };
    let files = shared::files(&data.join("gltf"), &["glb", "gltf"]);
    for path in &files {
        let folder = shared::Folder(path.parent().unwrap().to_owned());
        // Without the feature, files that need Draco are refused in both cases.
        let _ = both(&std::fs::read(path).unwrap(), &folder, &ReadOptions::default());
    }
    assert!(files.len() > 30);
}

#[test]
fn files_are_limited_and_may_end_too_early() {
    let file = points(4);
    let limits = Limits { decoded_bytes: file.len() as u64 - 1, ..Limits::default() };
    let options = ReadOptions { limits, ..ReadOptions::default() };
    let refused = gltf::read_file(Cursor::new(&file), &NoResources, &options);
    assert!(matches!(refused, Err(Error::Limit { value, .. }) if value == file.len() as u64));

    /// A file that claims to be longer than it is.
    struct Longer(Cursor<Vec<u8>>);
    impl Read for Longer {
        fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
            self.0.read(to)
        }
    }
    impl Seek for Longer {
        fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
            let more = if matches!(to, SeekFrom::End(_)) { 1000 } else { 0 };
            self.0.seek(to).map(|place| place + more)
        }
    }
    let short = Longer(Cursor::new(file[..file.len() - 1000].to_vec()));
    let error = gltf::read_file(short, &NoResources, &ReadOptions::default());
    assert!(matches!(error, Err(Error::Io(e)) if e.kind() == io::ErrorKind::UnexpectedEof));
}
