//! Files as inputs of [`durer::explain`]: shapes of the plane, faces of models, small pictures.
//!
//! ```
//! use durer::explain::Input;
//! use durer_formats::lesson::{Options, read};
//!
//! let read = read(b"LINESTRING (0 1, 13 8)", "a.wkt", &durer_formats::NoResources, &Options::default())?;
//! let Input::Figure(figure) = read.input else { panic!("a line is a figure") };
//! assert_eq!(figure.lines[0].len(), 2);
//! # Ok::<(), durer_formats::Error>(())
//! ```

use crate::geo::{GeoFormat, Reader};
use crate::{Error, Limits, Place, ReadOptions, Resources, Result, image, read_model};
use durer::explain::{Figure, Grid, Input, MAX_POINTS};
use durer::geometry::{Geometry, Points};
use durer::math::{DVec2, DVec3, Rect};
use durer::scene::{Image, Mesh, Scene, UpAxis};
use durer::view::projection::ViewDirection;
use std::collections::BTreeMap;

/// The most faces that can be read in a picture.
const MOST_FACES: usize = 200;

/// First bytes of PNG, JPEG, GIF and BMP files.
const IMAGES: [&[u8]; 4] = [b"\x89PNG", b"\xff\xd8\xff", b"GIF8", b"BM"];

/// Choices for reading.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// Limits of sizes.
    pub limits: Limits,
    /// Window to clip to, for shapes of the plane.
    pub window: Option<Rect>,
    /// Column and row of the pixel from which a picture is filled.
    pub seed: DVec2,
}

/// A file as an input.
#[derive(Debug, Clone, PartialEq)]
pub struct Read {
    /// The input.
    pub input: Input,
    /// Faults that were repaired, and parts that were left out.
    pub warnings: Vec<String>,
}

/// Reads map data or an SVG as shapes of the plane, a PNG, JPEG, GIF or BMP as a picture, and any other file as a model
/// that is seen obliquely from above. The first polygon is the subject, further ones are the clip.
///
/// # Errors
/// Those of the readers; [`Error::Limit`] for more points or pixels than can be explained; [`Error::Library`] for a
/// seed outside the picture.
pub fn read(
    bytes: &[u8],
    name: &str,
    resources: &dyn Resources,
    options: &Options,
) -> Result<Read> {
    let mut warnings = Vec::new();
    if let Some(format) = GeoFormat::of_file(name, bytes) {
        let input = figure(bytes, format, options.window, &mut warnings).map(Input::Figure)?;
        return Ok(Read { input, warnings });
    }
    if options.window.is_some() {
        warnings.push("a window is for shapes of the plane; here it does nothing".to_owned());
    }
    if IMAGES.iter().any(|magic| bytes.starts_with(magic)) {
        let image = image::decode(bytes, "", &options.limits)?;
        let input = grid(&image, options.seed, &mut warnings).map(Input::Grid)?;
        return Ok(Read { input, warnings });
    }
    let reading = ReadOptions { limits: options.limits.clone(), ..ReadOptions::default() };
    let model = read_model(bytes, name, resources, &reading)?;
    warnings.extend(model.warnings.iter().map(ToString::to_string));
    let input = faces(&model.scene, &mut warnings).map(Input::Faces)?;
    Ok(Read { input, warnings })
}

/// Reads shapes of the plane.
fn figure(
    bytes: &[u8],
    format: GeoFormat,
    window: Option<Rect>,
    warnings: &mut Vec<String>,
) -> Result<Figure> {
    let mut reader = Reader::new(format, bytes)?;
    let mut figure = Figure { window, ..Figure::default() };
    while let Some(feature) = reader.next_feature()? {
        if let Some(geometry) = &feature.geometry {
            add(&mut figure, geometry);
        }
        check("number of points to be explained", figure.points().count())?;
    }
    warnings.extend(reader.warnings().iter().map(ToString::to_string));
    Ok(figure)
}

/// Checks that a number of points or pixels can be explained.
fn check(what: &'static str, count: usize) -> Result<()> {
    if count <= MAX_POINTS {
        return Ok(());
    }
    let (value, limit) = (count as u64, MAX_POINTS as u64);
    Err(durer::Error::Limit { what, value, limit }.into())
}

/// Adds a geometry: the first polygon to the subject, further ones to the clip.
fn add(figure: &mut Figure, geometry: &Geometry) {
    let xy = |points: &Points| points.xy.clone();
    match geometry {
        Geometry::Point(points) | Geometry::MultiPoint(points) => figure.points.extend(&points.xy),
        Geometry::LineString(line) => figure.lines.push(xy(line)),
        Geometry::MultiLineString(lines) => figure.lines.extend(lines.iter().map(xy)),
        Geometry::Polygon(rings) => polygon(figure, rings.iter().map(xy)),
        Geometry::MultiPolygon(polygons) => polygon(figure, polygons.iter().flatten().map(xy)),
        // Readers give no collections within collections deeper than they may be.
        Geometry::Collection(parts) => parts.iter().for_each(|part| add(figure, part)),
    }
}

fn polygon(figure: &mut Figure, rings: impl Iterator<Item = Vec<DVec2>>) {
    let operand = if figure.rings.is_empty() { &mut figure.rings } else { &mut figure.clip };
    operand.extend(rings);
}

/// Returns a picture as greys, which algorithms take as light or as names of colours.
fn grid(image: &Image, seed: DVec2, warnings: &mut Vec<String>) -> Result<Grid> {
    let (width, height) = (image.width, image.height);
    check("number of pixels to be explained", image.data.len())?;
    let mut colors: BTreeMap<u8, [u8; 4]> = BTreeMap::new();
    let mut alike = false;
    let mut cells = Vec::new();
    for &color in &image.data {
        let grey = grey(color);
        alike |= *colors.entry(grey).or_insert(color) != color;
        cells.push(grey);
    }
    if alike {
        warnings.push("different colours have one grey and are taken as one".to_owned());
    }
    let at = seed.floor();
    if !(at.x >= 0.0 && at.y >= 0.0 && at.x < f64::from(width) && at.y < f64::from(height)) {
        let value = format!("{},{} in a picture of {width}x{height}", at.x, at.y);
        let error = durer::Error::parameter("seed", value, "one of its pixels");
        return Err(error.into());
    }
    Ok(Grid { columns: width, cells, seed: [at.x as u32, at.y as u32] })
}

/// Returns the grey of a colour over white, by the weights of BT.709 on bytes as they are.
fn grey([r, g, b, a]: [u8; 4]) -> u8 {
    let weighted = u32::from(r) * 2126 + u32::from(g) * 7152 + u32::from(b) * 722;
    let light = (weighted + 5000) / 10_000;
    let (light, a) = (light.min(255), u32::from(a));
    ((light * a + 255 * (255 - a) + 127) / 255) as u8
}

/// Returns the faces of a model as they are seen obliquely from above.
fn faces(scene: &Scene, warnings: &mut Vec<String>) -> Result<Vec<Vec<DVec3>>> {
    let view = oblique(scene.up_axis)?;
    let mut faces = Vec::new();
    let mut left_out = 0;
    for instance in &scene.instances {
        let Some(mesh) = scene.meshes.get(instance.mesh) else { continue };
        let place = |index: u32| {
            let p = mesh.positions.get(index as usize).copied().unwrap_or_default();
            view(instance.world_from_mesh.transform_point3(p.as_dvec3()))
        };
        for outline in outlines(mesh) {
            if faces.len() < MOST_FACES {
                faces.push(outline.into_iter().map(place).collect());
            } else {
                left_out += 1;
            }
        }
    }
    if faces.is_empty() {
        return Err(Error::Decode {
            place: Place::Whole,
            message: "there are no faces in it".to_owned(),
        });
    }
    if left_out > 0 {
        let are = if left_out == 1 { "is" } else { "are" };
        let message =
            format!("only its first {MOST_FACES} faces are explained; {left_out} {are} left out");
        warnings.push(message);
    }
    Ok(faces)
}

/// Returns the corners of each face as vertex numbers: of triangles that are a fan their outline, else each triangle.
fn outlines(mesh: &Mesh) -> Vec<Vec<u32>> {
    let count = mesh.triangle_count();
    let starts: Vec<usize> = if mesh.faces.is_empty() {
        (0..count).collect()
    } else {
        mesh.faces.iter().map(|&first| first as usize).collect()
    };
    let ends = starts.iter().skip(1).copied().chain([count]);
    let mut outlines = Vec::new();
    for (start, end) in starts.iter().zip(ends) {
        let triangles: Vec<[u32; 3]> = (*start..end.min(count)).map(|i| mesh.triangle(i)).collect();
        let fan =
            triangles.windows(2).all(|pair| pair[0][0] == pair[1][0] && pair[0][2] == pair[1][1]);
        if let (Some(first), true) = (triangles.first(), fan) {
            let rest = triangles.iter().skip(1).map(|triangle| triangle[2]);
            outlines.push(first.iter().copied().chain(rest).collect());
        } else {
            outlines.extend(triangles.iter().map(|triangle| triangle.to_vec()));
        }
    }
    outlines
}

/// Returns the turn that takes a model to a view obliquely from above: x to the right, y up, z to the eye.
fn oblique(up_axis: UpAxis) -> Result<impl Fn(DVec3) -> DVec3> {
    let view = ViewDirection::from_angles(30.0, 25.0, up_axis)?;
    let back = view.to_eye();
    let right = view.up().cross(back).normalize_or_zero();
    let above = back.cross(right);
    Ok(move |p: DVec3| DVec3::new(right.dot(p), above.dot(p), back.dot(p)))
}
