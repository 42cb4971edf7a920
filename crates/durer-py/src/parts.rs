//! Scenes of arrays: vertices, faces, colours, materials.

use crate::args::contiguous;
use crate::error;
use crate::model::Model;
use durer::math::{DMat3, DMat4, DVec3, Vec2, Vec3, Vec4};
use durer::scene::{
    AlphaMode, Image, Instance, Material, Mesh, Part, Sampler, Scene, ShadingModel, Texture,
    TextureRef, Topology, UpAxis,
};
use numpy::{PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

/// The arrays of one mesh and its place.
#[derive(FromPyObject)]
struct MeshArrays<'py> {
    vertices: PyReadonlyArray2<'py, f64>,
    /// Rows of three vertices for triangles, two for lines, one for points.
    faces: PyReadonlyArray2<'py, i64>,
    normals: Option<PyReadonlyArray2<'py, f32>>,
    /// Linear RGBA of each vertex.
    colors: Option<PyReadonlyArray2<'py, f32>>,
    tex_coords: Option<PyReadonlyArray2<'py, f32>>,
    /// Places of the mesh: matrices from its coordinates to the world's, row by row.
    poses: Vec<PyReadonlyArray2<'py, f64>>,
    material: Option<usize>,
    name: String,
}

/// A metallic-roughness material.
#[derive(FromPyObject)]
struct MaterialNumbers<'py> {
    name: String,
    /// Linear RGBA.
    color: [f32; 4],
    metallic: f32,
    roughness: f32,
    /// False for Phong's formula with the default highlight.
    is_physical: bool,
    double_sided: bool,
    /// True if the alpha of vertices or textures is used, and not only the colour's.
    is_blended: bool,
    texture: Option<PyReadonlyArray3<'py, u8>>,
}

/// Returns rows of `N` numbers as values.
fn rows<T: numpy::Element + Copy, const N: usize>(
    array: &PyReadonlyArray2<'_, T>,
    name: &str,
    count: Option<usize>,
) -> PyResult<Vec<[T; N]>> {
    let shape = array.shape();
    if shape[1] != N || count.is_some_and(|count| count != shape[0]) {
        let rows = count.map_or("n".to_owned(), |count| count.to_string());
        let message = format!("{name} must be ({rows}, {N}), got ({}, {})", shape[0], shape[1]);
        return Err(PyTypeError::new_err(message));
    }
    Ok(contiguous(array, name)?.as_chunks::<N>().0.to_vec())
}

/// Returns vertices in single precision around an offset: zero if that loses nothing, else the middle of their box.
fn centred(vertices: &[[f64; 3]]) -> (Vec<Vec3>, DVec3) {
    let is_exact = |v: &[f64; 3]| v.iter().all(|&x| f64::from(x as f32) == x);
    let offset = if vertices.iter().all(is_exact) {
        DVec3::ZERO
    } else {
        let all = || vertices.iter().map(|&v| DVec3::from(v));
        let low = all().fold(DVec3::INFINITY, DVec3::min);
        let high = all().fold(DVec3::NEG_INFINITY, DVec3::max);
        let middle = low + (high - low) * 0.5;
        // A middle near the origin gains nothing.
        if middle.abs().max_element() > (high - low).max_element() { middle } else { DVec3::ZERO }
    };
    (vertices.iter().map(|&v| (DVec3::from(v) - offset).as_vec3()).collect(), offset)
}

fn indices(faces: &PyReadonlyArray2<'_, i64>, vertices: usize) -> PyResult<(Vec<u32>, Topology)> {
    let sides = faces.shape()[1];
    let topology = match sides {
        1 => Topology::Points,
        2 => Topology::Lines,
        3 => Topology::Triangles,
        _ => {
            let message = format!("faces must be (m, 3), got ({}, {sides})", faces.shape()[0]);
            return Err(PyTypeError::new_err(message));
        }
    };
    let numbers = contiguous(faces, "faces")?;
    let index = |(at, &number): (usize, &i64)| match usize::try_from(number) {
        Ok(number) if number < vertices => Ok(number as u32),
        _ => Err(PyValueError::new_err(format!(
            "faces[{}] = {number} is not a vertex: there are {vertices}",
            at / sides
        ))),
    };
    Ok((numbers.iter().enumerate().map(index).collect::<PyResult<_>>()?, topology))
}

fn mesh(arrays: &MeshArrays<'_>, number: usize) -> PyResult<(Mesh, DVec3)> {
    let vertices = rows::<f64, 3>(&arrays.vertices, "vertices", None)?;
    if let Some(at) = vertices.iter().position(|v| v.iter().any(|x| !x.is_finite())) {
        let of = if number > 0 { format!(" of mesh {number}") } else { String::new() };
        let message = format!("vertices[{at}]{of} = {:?} is not finite", vertices[at]);
        return Err(PyValueError::new_err(message));
    }
    let count = Some(vertices.len());
    let (positions, offset) = centred(&vertices);
    let (indices, topology) = indices(&arrays.faces, vertices.len())?;
    let mut mesh = Mesh {
        name: arrays.name.clone(),
        topology,
        positions,
        indices: Some(indices),
        ..Mesh::default()
    };
    if let Some(normals) = &arrays.normals {
        let normals = rows::<f32, 3>(normals, "normals", count)?;
        mesh.normals = normals.into_iter().map(|n| Vec3::from(n).normalize_or_zero()).collect();
    }
    if let Some(colors) = &arrays.colors {
        mesh.colors =
            rows::<f32, 4>(colors, "colors", count)?.into_iter().map(Vec4::from).collect();
    }
    if let Some(uv) = &arrays.tex_coords {
        let uv = rows::<f32, 2>(uv, "uv", count)?;
        // Rows of images count downwards here.
        mesh.tex_coords = vec![uv.into_iter().map(|[u, v]| Vec2::new(u, 1.0 - v)).collect()];
    }
    let range = 0..mesh.primitive_count() as u32;
    mesh.parts.push(Part { range, material: arrays.material, name: String::new() });
    Ok((mesh, offset))
}

fn pose(matrix: &PyReadonlyArray2<'_, f64>) -> PyResult<DMat4> {
    let rows = rows::<f64, 4>(matrix, "poses", Some(4))?;
    let numbers = rows.as_flattened();
    if numbers.iter().any(|x| !x.is_finite()) {
        return Err(PyValueError::new_err("a pose has a number that is not finite"));
    }
    let mut all = [0.0; 16];
    all.copy_from_slice(numbers);
    Ok(DMat4::from_cols_array(&all).transpose())
}

fn material(numbers: &MaterialNumbers<'_>, scene: &mut Scene) -> PyResult<Material> {
    let color = Vec4::from(numbers.color);
    let base = Material {
        name: numbers.name.clone(),
        base_color: color,
        alpha_mode: if numbers.is_blended || color.w < 1.0 {
            AlphaMode::Blend
        } else {
            AlphaMode::Opaque
        },
        double_sided: numbers.double_sided,
        ..Material::default()
    };
    let base_color_texture = match &numbers.texture {
        None => None,
        Some(texture) => {
            let pixels = crate::args::pixels::<4>(texture, "texture")?;
            let image = scene.images.len();
            let (width, height) = (pixels.width(), pixels.height());
            scene.images.push(Image {
                name: String::new(),
                width,
                height,
                data: pixels.into_data(),
            });
            let texture = scene.textures.len();
            scene.textures.push(Texture { image, sampler: Sampler::default() });
            Some(TextureRef { texture, tex_coord: 0, transform: DMat3::IDENTITY })
        }
    };
    Ok(match numbers.is_physical {
        true => Material {
            model: ShadingModel::MetallicRoughness,
            metallic: numbers.metallic,
            roughness: numbers.roughness,
            base_color_texture,
            ..base
        },
        false => Material { base_color_texture, ..base },
    })
}

/// Creates a model from meshes and materials.
#[pyfunction]
fn scene_of(
    py: Python<'_>,
    meshes: Vec<MeshArrays<'_>>,
    materials: Vec<MaterialNumbers<'_>>,
    up_axis: &str,
    name: String,
) -> PyResult<Model> {
    let axis = UpAxis::ALL.iter().copied().find(|axis| axis.name() == up_axis);
    let wrong = || {
        PyValueError::new_err(format!("up_axis is '{up_axis}'; it must be x, y, z, -x, -y or -z"))
    };
    let mut scene = Scene { up_axis: axis.ok_or_else(wrong)?, ..Scene::default() };
    for numbers in &materials {
        let material = material(numbers, &mut scene)?;
        scene.materials.push(material);
    }
    for (number, arrays) in meshes.iter().enumerate() {
        let (mesh, offset) = mesh(arrays, number)?;
        scene.meshes.push(mesh);
        for matrix in &arrays.poses {
            let world_from_mesh = pose(matrix)? * DMat4::from_translation(offset);
            scene.instances.push(Instance {
                mesh: number,
                world_from_mesh,
                name: arrays.name.clone(),
            });
        }
    }
    scene.check().map_err(|e| error::of_library(py, &e))?;
    Ok(Model::of_scene(scene, name))
}

/// Returns linear values of sRGB colours with straight alpha, 0 to 255.
#[pyfunction]
fn linear_of_srgb<'py>(
    py: Python<'py>,
    colors: PyReadonlyArray1<'py, u8>,
) -> PyResult<Bound<'py, numpy::PyArray1<f32>>> {
    let colors = contiguous(&colors, "colors")?;
    let linear = |(i, &c): (usize, &u8)| match i % 4 {
        3 => f32::from(c) / 255.0,
        _ => durer::shade::color::LINEAR_FROM_SRGB[usize::from(c)],
    };
    Ok(crate::args::flat(py, colors.iter().enumerate().map(linear).collect()))
}

/// Adds the names of this file to the module.
pub fn add(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_function(wrap_pyfunction!(scene_of, m)?)?;
    m.add_function(wrap_pyfunction!(linear_of_srgb, m)?)
}
