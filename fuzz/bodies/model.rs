//! The laws that hold for any bytes, read as a model: the bodies of the fuzz targets `gltf`, `draco`, `image`,
//! `meshopt`, `obj`, `mtl`, `stl`, `ply`, `threemf`, `collada`, `fbx`, `off`, `las`, `e57` and `xyz`, which the
//! tests call as well.

use arbitrary::{Result, Unstructured};
use durer::scene::Scene;
use durer_formats::{
    Error, Limits, Model, ModelFormat, NoResources, Pieces, Pose, ReadOptions, Resources, collada,
    e57, fbx, gltf, image, las, obj, off, ply, stl, threemf, xyz,
};
use std::io::{Cursor, Write};

/// Returns small enough for many runs a second.
pub fn options() -> ReadOptions {
    let limits = Limits {
        primitives: 10_000,
        instances: 1_000,
        decoded_bytes: 1 << 20,
        image_side: 256,
        depth: 64,
        ..Limits::default()
    };
    let pose = Some(Pose { animation: None, time: 0.5 });
    ReadOptions { limits, pose, ..ReadOptions::default() }
}

/// Every file that a model refers to has the same bytes.
struct Same<'a>(&'a [u8]);

impl Resources for Same<'_> {
    fn read(&self, _path: &str, limit: u64) -> std::result::Result<Vec<u8>, String> {
        let whole = self.0.len() as u64 <= limit;
        whole.then(|| self.0.to_vec()).ok_or_else(|| "too long".to_owned())
    }
}

/// A model that is read can be drawn.
fn check(model: durer_formats::Result<Model>) {
    if let Ok(model) = model {
        let sound = model.scene.check();
        assert!(sound.is_ok(), "{sound:?}");
    }
}

/// Returns the bits of positions and colours of all corners of a scene's first mesh.
fn corners(scene: &Scene) -> Vec<[u32; 7]> {
    let Some(mesh) = scene.meshes.first() else { return Vec::new() };
    let vertex = |i: usize| mesh.indices.as_ref().map_or(i, |indices| indices[i] as usize);
    let bits = |v: usize| {
        let (p, c) = (mesh.positions[v], mesh.colors.get(v).copied().unwrap_or_default());
        [p.x, p.y, p.z, c.x, c.y, c.z, c.w].map(f32::to_bits)
    };
    (0..mesh.index_count()).map(|i| bits(vertex(i))).collect()
}

/// A model in pieces is that of the whole, where it can be read in pieces at all.
fn check_pieces(mut pieces: impl Pieces, whole: durer_formats::Result<Model>) {
    let Ok(whole) = whole else { return };
    let facts = match pieces.facts() {
        Ok(facts) => facts,
        Err(e) => return assert!(matches!(e, Error::Unsupported { .. }), "{e}"),
    };
    assert_eq!(facts.model.warnings, whole.warnings);
    assert_eq!(facts.model.format, whole.format);
    let expected = corners(&whole.scene);
    let mut found = Vec::new();
    let passed = pieces.primitives(&mut |piece| {
        found.extend(corners(piece));
        piece.check()
    });
    assert!(passed.is_ok(), "{passed:?}");
    let place = |corner: &[u32; 7]| [corner[0], corner[1], corner[2]];
    assert!(found.iter().map(place).eq(expected.iter().map(place)));
    let count = facts.triangles + facts.points;
    let all: Vec<u32> = (0..count as u32).collect();
    let (scene, _) = pieces.only(&all).expect("it was read before");
    assert!(scene.check().is_ok() && corners(&scene) == expected);
    let every_third: Vec<u32> = all.iter().copied().step_by(3).collect();
    let (scene, _) = pieces.only(&every_third).expect("it was read before");
    let each = expected.len() / all.len().max(1);
    let third = expected.chunks(each.max(1)).step_by(3).flatten();
    assert!(corners(&scene).iter().eq(third));
    // The box is there for vertices that nothing is drawn with, too.
    assert!(pieces.bounds().is_ok() && pieces.vertices(&mut |piece| piece.check()).is_ok());
}

/// PLY as a whole and in pieces.
fn check_ply(bytes: &[u8], resources: &dyn Resources) {
    let whole = ply::read(bytes, resources, &options());
    let pieces = ply::Pieces::new(Cursor::new(bytes), bytes.len() as u64, 1, &options());
    match pieces {
        Ok(Some(pieces)) => check_pieces(pieces, whole),
        _ => check(whole),
    }
}

/// From an open file comes the same as from its bytes, which can be drawn.
pub fn check_gltf(bytes: &[u8], resources: &dyn Resources) {
    let model = gltf::read(bytes, resources, &options());
    let opened = gltf::read_file(Cursor::new(bytes), resources, &options());
    // As text, where NaN is NaN.
    assert_eq!(format!("{opened:?}"), format!("{model:?}"));
    check(model);
}

/// glTF as text and as GLB; and a JSON text of the format's words with the rest as buffer.
pub fn gltf(bytes: &[u8]) {
    check_gltf(bytes, &Same(bytes));
    let _ = ModelFormat::of_content(bytes);
    if let Ok((json, buffer)) = document(bytes) {
        check_gltf(&glb(&json, buffer), &Same(buffer));
    }
}

/// Returns a document whose numbers come from the input, so that most of it is well formed.
fn document(bytes: &[u8]) -> Result<(String, &[u8])> {
    let mut u = Unstructured::new(bytes);
    let mut small = |most: u32| u.int_in_range(0..=most);
    let component = [5120, 5121, 5122, 5123, 5125, 5126, 7][small(6)? as usize];
    let kind = ["SCALAR", "VEC2", "VEC3", "VEC4", "MAT4"][small(4)? as usize];
    let (offset, stride, count, length) = (small(9)?, small(16)?, small(9)?, small(99)?);
    let (mode, index, child, skin) = (small(7)?, small(3)?, small(3)?, small(2)?);
    let mut view = format!(r#"{{"buffer":0,"byteLength":{length},"byteOffset":{offset}"#);
    if stride > 3 {
        view += &format!(r#","byteStride":{stride}"#);
    }
    let accessor = format!(
        r#"{{"bufferView":{index},"componentType":{component},"count":{count},"type":"{kind}","normalized":{}}}"#,
        mode % 2 == 0
    );
    let position = r#"{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}"#;
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{}}}],"bufferViews":[{view}}},
        {{"buffer":0,"byteLength":36}}],"accessors":[{position},{accessor}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"COLOR_0":{},"JOINTS_0":1,"WEIGHTS_0":1}},
        "indices":{index},"mode":{mode}}}]}}],"nodes":[{{"mesh":0,"children":[{child}]}},
        {{"mesh":0,"skin":{skin}}}],"skins":[{{"joints":[0],"inverseBindMatrices":1}}],
        "animations":[{{"channels":[{{"sampler":0,"target":{{"node":0,"path":"translation"}}}}],
        "samplers":[{{"input":1,"output":0}}]}}],"images":[{{"bufferView":{index}}}]}}"#,
        u.len(),
        index % 2,
    );
    Ok((json, u.take_rest()))
}

/// Returns a GLB of a JSON text and a buffer.
pub fn glb(json: &str, buffer: &[u8]) -> Vec<u8> {
    let json = format!("{json}{}", " ".repeat(json.len().wrapping_neg() % 4));
    let word = |v: usize| (v as u32).to_le_bytes();
    let mut file = b"glTF\x02\0\0\0".to_vec();
    file.extend(word(28 + json.len() + buffer.len()));
    file.extend(word(json.len()));
    file.extend(b"JSON");
    file.extend(json.bytes());
    file.extend(word(buffer.len()));
    file.extend(b"BIN\0");
    file.extend(buffer);
    file
}

/// The bytes as a Draco bitstream of one primitive.
pub fn draco(bytes: &[u8]) {
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{0}}}],
        "bufferViews":[{{"buffer":0,"byteLength":{0}}}],
        "accessors":[{{"componentType":5126,"count":3,"type":"VEC3"}},
        {{"componentType":5121,"normalized":true,"count":3,"type":"VEC4"}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"COLOR_0":1}},"extensions":
        {{"KHR_draco_mesh_compression":{{"bufferView":0,"attributes":{{"POSITION":0,"COLOR_0":1}}}}}}}}]}}],
        "nodes":[{{"mesh":0}}],"extensionsRequired":["KHR_draco_mesh_compression"],
        "extensionsUsed":["KHR_draco_mesh_compression"]}}"#,
        bytes.len()
    );
    check_gltf(&glb(&json, bytes), &Same(&[]));
}

/// The bytes as a view compressed by meshoptimizer; the first few say how.
pub fn meshopt(bytes: &[u8]) {
    let mut u = Unstructured::new(bytes);
    let Ok((json, data)) = meshopt_document(&mut u) else { return };
    check_gltf(&glb(&json, data), &Same(&[]));
}

fn meshopt_document<'a>(u: &mut Unstructured<'a>) -> Result<(String, &'a [u8])> {
    let mode = *u.choose(&["ATTRIBUTES", "TRIANGLES", "INDICES"])?;
    let filter = *u.choose(&["NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"])?;
    let stride = *u.choose(&[2u64, 4, 8, 12, 16, 256, 260])?;
    let count = u.int_in_range(0u64..=300)?;
    let data = u.peek_bytes(u.len()).unwrap_or_default();
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{0}}},{{"byteLength":{1}}}],
        "bufferViews":[{{"buffer":1,"byteLength":{1},"extensions":{{"EXT_meshopt_compression":
        {{"buffer":0,"byteLength":{0},"byteStride":{stride},"count":{count},"mode":"{mode}",
        "filter":"{filter}"}}}}}}],"accessors":[{{"bufferView":0,"componentType":5126,"count":3,
        "type":"VEC3"}},{{"bufferView":0,"componentType":5123,"count":3,"type":"SCALAR"}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}},
        {{"attributes":{{"POSITION":0}},"indices":1}}]}}],"nodes":[{{"mesh":0}}],
        "extensionsRequired":["EXT_meshopt_compression"],"extensionsUsed":["EXT_meshopt_compression"]}}"#,
        data.len(),
        stride * count,
    );
    Ok((json, data))
}

/// Returns a text of the format's words, with numbers and bytes between.
fn text(bytes: &[u8], words: &[&str]) -> Result<Vec<u8>> {
    let mut u = Unstructured::new(bytes);
    let mut text = Vec::new();
    while !u.is_empty() {
        match u.arbitrary::<u8>()? {
            0 => text.push(u.arbitrary()?),
            1 => text.extend(format!(" {}", u.arbitrary::<i8>()?).bytes()),
            2 => text.extend(format!(" {}", f32::from_bits(u.arbitrary()?)).bytes()),
            word => text.extend(words[usize::from(word) % words.len()].bytes()),
        }
    }
    Ok(text)
}

const OBJ: &[&str] = &[
    "v 0 0 0\nv 1 0 0\nv 0 1 0\n",
    "f 1 2 3\n",
    "f 1/1/1 2/1/1 3/1/1\n",
    "f -1 -2 -3\n",
    "vt 0 0\n",
    "vn 0 0 1\n",
    "\n",
    "f",
    "v",
    "vp",
    "l 1 2\n",
    "p 1\n",
    "/",
    "//",
    "usemtl m\n",
    "mtllib a.mtl\n",
    "g a b\n",
    "o n\n",
    "s 1\n",
    "\\\n",
    "#",
    "deg 3\n",
    "curv 0 1 1 2\n",
    "end\n",
    " 1",
    " 0",
    " 99999999999",
];

/// OBJ.
pub fn obj(bytes: &[u8]) {
    check(obj::read(bytes, &Same(bytes), &options()));
    if let Ok(text) = text(bytes, OBJ) {
        check(obj::read(&text, &Same(bytes), &options()));
    }
    check(obj::read(&outline(bytes), &NoResources, &options()));
}

/// Returns one face, with a corner for each byte, on a grid so small that outlines touch and cross
/// everywhere.
fn outline(bytes: &[u8]) -> Vec<u8> {
    let mut text = Vec::new();
    for byte in bytes.iter().take(64) {
        let _ = writeln!(text, "v {} {} 0\nvt {} 0", byte & 7, byte >> 3 & 7, byte >> 6);
    }
    text.push(b'f');
    (1..=bytes.len().min(64)).for_each(|i| {
        let _ = write!(text, " {i}/{i}");
    });
    text
}

/// Pictures are as large as they say.
pub fn image(bytes: &[u8]) {
    if let Ok(image) = image::decode(bytes, "x", &options().limits) {
        assert_eq!(image.data.len() as u64, u64::from(image.width) * u64::from(image.height));
        assert!(image.width.max(image.height) <= 256);
    }
}

const MTL: &[&str] = &[
    "newmtl m\n",
    "Kd",
    "Ka",
    "Ks",
    "Ke",
    "Ns",
    "d",
    "Tr",
    "illum",
    "map_Kd",
    "map_Bump",
    " -s",
    " -o",
    " -bm",
    " -clamp on",
    " a.png",
    "\n",
    " 1 1 1\n",
    " spectral",
    " xyz",
    "Pr",
    "Pm",
    "aniso",
    "refl",
    "norm",
    "#",
];

/// MTL: the library of an OBJ of one triangle.
pub fn mtl(bytes: &[u8]) {
    let model = b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n";
    check(obj::read(model, &Same(bytes), &options()));
    if let Ok(text) = text(bytes, MTL) {
        check(obj::read(model, &Same(&text), &options()));
    }
}

const STL: &[&str] = &[
    "solid",
    "endsolid",
    "facet normal 0 0 1\n",
    "outer loop\n",
    "vertex 0 0 0\n",
    "vertex 1 0 0\n",
    "vertex 0 1 0\n",
    "endloop\n",
    "endfacet\n",
    "vertex",
    "\n",
    " ",
];

/// STL: as it is, as words, and as a binary file with the right count.
pub fn stl(bytes: &[u8]) {
    check(stl::read(bytes, &NoResources, &options()));
    if let Ok(text) = text(bytes, STL) {
        check(stl::read(&text, &NoResources, &options()));
    }
    let mut binary = vec![0; 80];
    binary.extend(((bytes.len() / 50) as u32).to_le_bytes());
    binary.extend(bytes);
    check(stl::read(&binary, &NoResources, &options()));
    binary.truncate(stl::HEADER + bytes.len() / stl::RECORD * stl::RECORD);
    let whole = stl::read(&binary, &NoResources, &options());
    if let Some(head) = binary.first_chunk().filter(|_| bytes.len() >= stl::RECORD) {
        let pieces = stl::Pieces::new(head, Cursor::new(&binary), 1, &options());
        check_pieces(pieces.expect("few triangles"), whole);
    }
}

const PLY: &[&str] = &[
    "ply\n",
    "format ascii 1.0\n",
    "format binary_little_endian 1.0\n",
    "format binary_big_endian 1.0\n",
    "element vertex 3\n",
    "element face 1\n",
    "element",
    "property float x\n",
    "property float y\n",
    "property float z\n",
    "property uchar red\n",
    "property list uchar int vertex_indices\n",
    "property list float double vertex_index\n",
    "property",
    "property list uchar float texcoord\n",
    "property uchar green\n",
    "property uchar blue\n",
    "property int texnumber\n",
    "element edge 1\n",
    "property int vertex1\n",
    "property int vertex2\n",
    "comment TextureFile a.png\n",
    "comment\n",
    "end_header\n",
    "0 0 0\n",
    "1 0 0\n",
    "0 1 0\n",
    "3 0 1 2\n",
    " ",
    "\n",
];

/// PLY.
pub fn ply(bytes: &[u8]) {
    check_ply(bytes, &Same(bytes));
    if let Ok(text) = text(bytes, PLY) {
        check_ply(&text, &NoResources);
    }
    let vertices = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    let colors = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    let faces = "element face 3\nproperty list uchar uchar vertex_indices\n";
    for (order, elements) in [
        ("little", [vertices, faces, ""]),
        ("big", [vertices, "", ""]),
        ("little", [vertices, colors, faces]),
    ] {
        let elements = elements.concat();
        let head = format!("ply\nformat binary_{order}_endian 1.0\n{elements}end_header\n");
        check_ply(&[head.as_bytes(), bytes].concat(), &NoResources);
    }
}

const OFF: &[&str] = &[
    "OFF\n",
    "COFF\n",
    "STCN4OFF\n",
    "4 2 0\n",
    "0 0 0\n",
    "1 0 0\n",
    "1 1 0 1 0 0\n",
    "0.4 0.2 0\n",
    "3 0 1 2\n",
    "4 0 1 2 3\n",
    "4 0 1 2 3 255 0 0\n",
    "2 0 1\n",
    "#",
    " 1",
    "\n",
];

/// FBX: if it is not read, there is a word.
pub fn fbx(bytes: &[u8]) {
    check(fbx::read(bytes, &Same(bytes), &options()));
}

/// OFF.
pub fn off(bytes: &[u8]) {
    check(off::read(bytes, &NoResources, &options()));
    if let Ok(text) = text(bytes, OFF) {
        check(off::read(&text, &NoResources, &options()));
        check(off::read(&[b"OFF\n", &text[..]].concat(), &NoResources, &options()));
    }
}

const XYZ: &[&str] = &[
    "0 0 0\n",
    "1,2,3,255,0,0\n",
    "1 2 3 -20 255 0 0\n",
    "// x y z r g b\n",
    "z;y;x;intensity\n",
    "2\n",
    " 1",
    ",",
    "\r",
    "\n",
    "nan",
];

/// Points as text.
pub fn xyz(bytes: &[u8]) {
    check(xyz::read(bytes, &NoResources, &options()));
    if let Ok(text) = text(bytes, XYZ) {
        check(xyz::read(&text, &NoResources, &options()));
    }
}

/// LAS and LAZ: as it is, and behind the format's first word.
pub fn las(bytes: &[u8]) {
    check(las::read(bytes, &NoResources, &options()));
    check(las::read(&[b"LASF", bytes].concat(), &NoResources, &options()));
}

/// E57.
pub fn e57(bytes: &[u8]) {
    check(e57::read(bytes, &NoResources, &options()));
}

const THREEMF: &[&str] = &[
    "<model unit=\"inch\">",
    "</model>",
    "<resources>",
    "</resources>",
    "<object id=\"1\">",
    "<object id=\"2\">",
    "</object>",
    "<mesh>",
    "</mesh>",
    "<vertices>",
    "</vertices>",
    "<vertex x=\"0\" y=\"1\" z=\"0\"/>",
    "<vertex x=\"1\" y=\"1e39\" z=\"0\"/>",
    "<triangles>",
    "</triangles>",
    "<triangle v1=\"0\" v2=\"1\" v3=\"2\"/>",
    "<triangle v1=\"0\" v2=\"1\" v3=\"2\" pid=\"3\" p1=\"0\"/>",
    "<components>",
    "</components>",
    "<component objectid=\"1\"/>",
    "<component objectid=\"2\" transform=\"1 0 0 0 1 0 0 0 1 1 2 3\"/>",
    "<build>",
    "</build>",
    "<item objectid=\"1\"/>",
    "<item objectid=\"2\"/>",
    "<basematerials id=\"3\">",
    "<base name=\"a\" displaycolor=\"#102030\"/>",
    "</basematerials>",
    "<m:colorgroup id=\"3\">",
    "<m:color color=\"#10203040\"/>",
    "</m:colorgroup>",
    "<triangle v1=\"0\" v2=\"1\" v3=\"2\" paint_color=\"48403\"/>",
    "<triangle v1=\"2\" v2=\"1\" v3=\"0\" pid=\"4\" p1=\"0\" p2=\"1\" p3=\"0\" mmu_segmentation=\"0C5\"/>",
    "<texture2d id=\"5\" path=\"/a.png\"/>",
    "<texture2dgroup id=\"4\" texid=\"5\">",
    "<tex2coord u=\"0.5\" v=\"1e9\"/>",
    "</texture2dgroup>",
    "<compositematerials id=\"4\" matid=\"3\" matindices=\"0 1\">",
    "<composite values=\"0.5 0.5\"/>",
    "</compositematerials>",
    "<multiproperties id=\"4\" pids=\"3 4\" blendmethods=\"multiply\">",
    "<multi pindices=\"0 0\"/>",
    "</multiproperties>",
    "<beamlattice radius=\"0.5\" minlength=\"0.01\" cap=\"butt\">",
    "<beam v1=\"0\" v2=\"1\" r1=\"2\" cap1=\"sphere\"/>",
    "<ball vindex=\"1\" r=\"1\"/>",
    "</beamlattice>",
    "<",
    ">",
    "\"",
    "&amp;",
];

/// 3MF: the archive as it is, and one whose model is words of the format.
pub fn threemf(bytes: &[u8]) {
    check(threemf::read(bytes, &NoResources, &options()));
    if let Some(archive) = text(bytes, THREEMF).ok().and_then(|model| archive(&model)) {
        check(threemf::read(&archive, &NoResources, &options()));
    }
}

fn archive(model: &[u8]) -> Option<Vec<u8>> {
    let root: &[u8] = br#"<Relationships><Relationship Target="/a.model" Id="b" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>"#;
    let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let stored =
        zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
    let project: &[u8] = br##"{"filament_colour":["#ff0000"]}"##;
    let settings: &[u8] = br#"<config><object id="1"><metadata key="extruder" value="2"/><volume firstid="1" lastid="1"><metadata key="modifier" value="1"/></volume></object></config>"#;
    for (name, content) in [
        ("_rels/.rels", root),
        ("a.model", model),
        ("Metadata/project_settings.config", project),
        ("Metadata/model_settings.config", settings),
    ] {
        zip.start_file(name, stored).ok()?;
        zip.write_all(content).ok()?;
    }
    Some(zip.finish().ok()?.into_inner())
}

const COLLADA: &[&str] = &[
    "<COLLADA version=\"1.4.1\">",
    "</COLLADA>",
    "<asset><unit meter=\"0,01\"/><up_axis>X_UP</up_axis></asset>",
    "<library_geometries>",
    "</library_geometries>",
    "<geometry id=\"g\"><mesh>",
    "</mesh></geometry>",
    "<source id=\"p\"><float_array>0 0 0 1 0 0 0 1 0 1e39 nan 2</float_array>",
    "<technique_common><accessor count=\"4\" stride=\"3\" offset=\"1\"><param name=\"X\"/><param/></accessor></technique_common>",
    "</source>",
    "<vertices id=\"v\">",
    "</vertices>",
    "<input semantic=\"POSITION\" source=\"#p\"/>",
    "<input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>",
    "<input semantic=\"NORMAL\" source=\"#p\" offset=\"1\"/>",
    "<input semantic=\"TEXCOORD\" source=\"#p\" offset=\"1\" set=\"1\"/>",
    "<input semantic=\"COLOR\" source=\"#p\" offset=\"0\"/>",
    "<triangles material=\"m\">",
    "</triangles>",
    "<polylist><vcount>4 3</vcount>",
    "</polylist>",
    "<polygons>",
    "</polygons>",
    "<ph><p>0 1 2 3</p><h>1 2 0</h></ph>",
    "<tristrips>",
    "</tristrips>",
    "<trifans>",
    "</trifans>",
    "<linestrips>",
    "</linestrips>",
    "<p>0 1 2 3 1 2 0</p>",
    "<p>0 0 1 1 2 2</p>",
    "<library_images><image id=\"i\"><init_from>a.png</init_from></image></library_images>",
    "<library_effects><effect id=\"e\"><profile_COMMON>",
    "</profile_COMMON></effect></library_effects>",
    "<newparam sid=\"w\"><sampler2D><source>u</source><wrap_s>CLAMP</wrap_s></sampler2D></newparam>",
    "<newparam sid=\"u\"><surface><init_from>i</init_from></surface></newparam>",
    "<technique><phong>",
    "</phong></technique>",
    "<diffuse><texture texture=\"w\" texcoord=\"c\"/></diffuse>",
    "<diffuse><color>1 0 0 1</color></diffuse>",
    "<transparent><color>1 1 1 0.5</color></transparent>",
    "<transparency><float>0</float></transparency>",
    "<library_materials><material id=\"m\"><instance_effect url=\"#e\"/></material></library_materials>",
    "<library_controllers><controller id=\"k\"><skin source=\"#g\"/></controller></library_controllers>",
    "<library_visual_scenes><visual_scene id=\"s\">",
    "</visual_scene></library_visual_scenes>",
    "<node id=\"n\">",
    "</node>",
    "<rotate>0 0 1 90</rotate>",
    "<skew>45 0 1 0 1 0 0</skew>",
    "<lookat>0 0 9 0 0 0 0 1 0</lookat>",
    "<instance_node url=\"#n\"/>",
    "<instance_geometry url=\"#g\"/>",
    "<instance_controller url=\"#k\"/>",
    "<scene><instance_visual_scene url=\"#s\"/></scene>",
    "<",
    ">",
    "&lt;",
    "\"",
];

/// Scene that shows a mesh of words.
const SHOWN: &str = "<library_visual_scenes><visual_scene><node><instance_geometry url=\"#g\"/></node>\
    </visual_scene></library_visual_scenes></COLLADA>";

/// COLLADA: as it is, as words, and as words within a mesh that is shown.
pub fn collada(bytes: &[u8]) {
    check(collada::read(bytes, &Same(bytes), &options()));
    let Ok(words) = text(bytes, COLLADA) else { return };
    check(collada::read(&words, &Same(bytes), &options()));
    let mesh: &[&str] = &[
        &COLLADA[0..1],
        &COLLADA[3..4],
        &COLLADA[5..6],
        &COLLADA[7..11],
        &COLLADA[12..13],
        &COLLADA[11..12],
    ]
    .concat();
    let start: Vec<u8> = mesh.iter().flat_map(|w| w.bytes()).collect();
    let end = format!("</mesh></geometry></library_geometries>{SHOWN}");
    check(collada::read(&[&start[..], &words, end.as_bytes()].concat(), &Same(bytes), &options()));
}
