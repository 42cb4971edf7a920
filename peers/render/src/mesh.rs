//! Displaced spheres of three sizes, and the files that hold them.

use crate::Result;
use std::f64::consts::PI;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

/// Triangles with normals at the vertices.
pub struct Mesh {
    /// Positions of the vertices.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals, the mean of the faces around weighted by area.
    pub normals: Vec<[f32; 3]>,
    /// Counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// Name, meridians and parallels of each mesh: 12,996, 69,168 and 1,000,000 triangles.
pub const SIZES: [(&str, u32, u32); 3] =
    [("sphere13k", 114, 58), ("sphere69k", 264, 132), ("sphere1m", 1000, 501)];

/// Returns the mesh of one of [`SIZES`].
pub fn sphere(name: &str) -> Result<Mesh> {
    let size = SIZES.iter().find(|s| s.0 == name);
    let &(_, around, down) = size.ok_or_else(|| format!("{name}: there is no such mesh"))?;
    Ok(displaced(around, down))
}

/// Returns a displaced sphere with `around` meridians and `down` parallels.
pub fn displaced(around: u32, down: u32) -> Mesh {
    let points: Vec<[f64; 3]> =
        (0..=down).flat_map(|i| (0..around).map(move |j| point(i, j, around, down))).collect();
    let triangles = triangles(around, down);
    let normals = normals(&points, &triangles);
    let positions = points.iter().map(|p| p.map(|x| x as f32)).collect();
    Mesh { positions, normals, triangles }
}

/// Returns the mesh of a name in [`SIZES`], or of an STL file with a normal for each face.
pub fn named(name: &str) -> Result<Mesh> {
    if !name.ends_with(".stl") {
        return sphere(name);
    }
    let scene = crate::methods::read_stl(name.as_ref())?;
    let points: Vec<[f64; 3]> = scene
        .meshes
        .iter()
        .flat_map(|m| &m.positions)
        .map(|p| p.to_array().map(f64::from))
        .collect();
    let triangles: Vec<[u32; 3]> =
        (0..points.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let normals = normals(&points, &triangles);
    let positions = points.iter().map(|p| p.map(|x| x as f32)).collect();
    Ok(Mesh { positions, normals, triangles })
}

fn point(i: u32, j: u32, around: u32, down: u32) -> [f64; 3] {
    let theta = PI * f64::from(i) / f64::from(down);
    let phi = 2.0 * PI * f64::from(j) / f64::from(around);
    let [x, y, z] = [theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin()];
    let radius = 1.0
        + 0.08 * (7.0 * x + 2.0 * y).sin() * (6.0 * y - z).cos()
        + 0.05 * (13.0 * z + 5.0 * x).sin() * (11.0 * y).sin()
        + 0.015 * (41.0 * x).sin() * (37.0 * y).sin() * (43.0 * z).sin();
    [x, y, z].map(|v| v * radius)
}

/// Returns the row by row, two triangles for each cell of the grid, one at the poles.
fn triangles(around: u32, down: u32) -> Vec<[u32; 3]> {
    let mut triangles = Vec::new();
    for (i, j) in (0..down).flat_map(|i| (0..around).map(move |j| (i, j))) {
        let next = (j + 1) % around;
        let (a, b) = (i * around + j, i * around + next);
        let (c, d) = (a + around, b + around);
        if i > 0 {
            triangles.push([a, b, c]);
        }
        if i + 1 < down {
            triangles.push([b, d, c]);
        }
    }
    triangles
}

fn normals(points: &[[f64; 3]], triangles: &[[u32; 3]]) -> Vec<[f32; 3]> {
    let mut sums = vec![[0.0; 3]; points.len()];
    for triangle in triangles {
        let normal = face_normal(triangle.map(|v| points[v as usize]));
        for &v in triangle {
            sums[v as usize] = std::array::from_fn(|k| sums[v as usize][k] + normal[k]);
        }
    }
    sums.into_iter().map(unit).collect()
}

/// Returns twice the area long.
fn face_normal([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let u: [f64; 3] = std::array::from_fn(|k| b[k] - a[k]);
    let v: [f64; 3] = std::array::from_fn(|k| c[k] - a[k]);
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

/// Returns the vector of length one; the poles' spare vertices, which no triangle uses, stay zero.
fn unit(v: [f64; 3]) -> [f32; 3] {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let scale = if length > 0.0 { 1.0 / length } else { 0.0 };
    v.map(|x| (x * scale) as f32)
}

/// Writes all meshes in all formats.
pub fn make(folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder)?;
    for (name, ..) in SIZES {
        let mesh = sphere(name)?;
        write(&folder.join(format!("{name}.stl")), |out| write_stl(out, &mesh))?;
        write(&folder.join(format!("{name}.glb")), |out| write_glb(out, &mesh))?;
        write_bmesh(&folder.join(format!("{name}.bmesh")), &mesh)?;
    }
    // One triangle: its time is the start of the process.
    let mut least = sphere("sphere13k")?;
    least.triangles.truncate(1);
    write(&folder.join("triangle.stl"), |out| write_stl(out, &least))
}

type Out = BufWriter<File>;

fn write(path: &Path, body: impl FnOnce(&mut Out) -> std::io::Result<()>) -> Result<()> {
    let mut out = BufWriter::new(File::create(path)?);
    body(&mut out)?;
    Ok(out.flush()?)
}

fn floats(out: &mut Out, values: &[f32]) -> std::io::Result<()> {
    values.iter().try_for_each(|v| out.write_all(&v.to_le_bytes()))
}

fn words(out: &mut Out, values: &[u32]) -> std::io::Result<()> {
    values.iter().try_for_each(|v| out.write_all(&v.to_le_bytes()))
}

fn write_stl(out: &mut Out, mesh: &Mesh) -> std::io::Result<()> {
    out.write_all(&[b' '; 80])?;
    words(out, &[mesh.triangles.len() as u32])?;
    for triangle in &mesh.triangles {
        let corners = triangle.map(|v| mesh.positions[v as usize]);
        floats(out, &unit(face_normal(corners.map(|c| c.map(f64::from)))))?;
        floats(out, corners.as_flattened())?;
        out.write_all(&[0; 2])?;
    }
    Ok(())
}

/// Positions and indices only, as most converters write a mesh without materials.
fn write_glb(out: &mut Out, mesh: &Mesh) -> std::io::Result<()> {
    let (vertices, indices) = (mesh.positions.len(), mesh.triangles.len() * 3);
    let (vertex_bytes, index_bytes) = (vertices * 12, indices * 4);
    let bound = |f: fn(f32, f32) -> f32| {
        mesh.positions.iter().copied().reduce(|a, b| std::array::from_fn(|k| f(a[k], b[k])))
    };
    let (min, max) = (bound(f32::min).unwrap_or_default(), bound(f32::max).unwrap_or_default());
    let mut json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],"accessors":[{{"bufferView":0,"componentType":5126,"count":{vertices},"type":"VEC3","min":{min:?},"max":{max:?}}},{{"bufferView":1,"componentType":5125,"count":{indices},"type":"SCALAR"}}],"bufferViews":[{{"buffer":0,"byteLength":{vertex_bytes},"target":34962}},{{"buffer":0,"byteOffset":{vertex_bytes},"byteLength":{index_bytes},"target":34963}}],"buffers":[{{"byteLength":{}}}]}}"#,
        vertex_bytes + index_bytes
    );
    while json.len() % 4 != 0 {
        json.push(' ');
    }
    let body = (vertex_bytes + index_bytes) as u32;
    out.write_all(b"glTF")?;
    words(out, &[2, 28 + json.len() as u32 + body, json.len() as u32])?;
    out.write_all(b"JSON")?;
    out.write_all(json.as_bytes())?;
    words(out, &[body])?;
    out.write_all(b"BIN\0")?;
    floats(out, mesh.positions.as_flattened())?;
    words(out, mesh.triangles.as_flattened())
}

/// The format of the llvmpipe harness: `BM01`, counts, positions with normals, indices.
pub fn write_bmesh(path: &Path, mesh: &Mesh) -> Result<()> {
    write(path, |out| {
        out.write_all(b"BM01")?;
        words(out, &[mesh.positions.len() as u32, mesh.triangles.len() as u32 * 3])?;
        for (position, normal) in mesh.positions.iter().zip(&mesh.normals) {
            floats(out, position)?;
            floats(out, normal)?;
        }
        words(out, mesh.triangles.as_flattened())
    })
}
