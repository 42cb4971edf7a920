//! Inputs of explanations from files.

use super::args::ExplainArgs;
use crate::failure::Failure;
use crate::input::{self, display_name};
use crate::layer;
use crate::messages::Messages;
use durer::explain::{Figure, Grid, Input};
use durer::geometry::{Geometry, Points};
use durer::math::{DVec2, DVec3};
use durer::scene::{Image, Mesh, Scene, UpAxis};
use durer::view::projection::ViewDirection;
use durer_formats::geo::{self, GeoFormat};
use durer_formats::{Limits, ReadOptions, image, read_model};
use std::collections::BTreeMap;

/// The most faces that can be read in a picture.
const MOST_FACES: usize = 200;
/// The most bytes that a file with so few things has.
const MOST_BYTES: u64 = 16 << 20;

/// First bytes of PNG, JPEG, GIF and BMP files.
const IMAGES: [&[u8]; 4] = [b"\x89PNG", b"\xff\xd8\xff", b"GIF8", b"BM"];

/// Returns the input that the arguments name: a file or an example.
pub fn input(args: &ExplainArgs, messages: &Messages) -> Result<Input, Failure> {
    let Some(path) = &args.input else {
        return Ok(Input::Example(args.example.clone().unwrap_or_default()));
    };
    let name = display_name(path);
    let work = args.running.work.clone();
    let limits = Limits { decoded_bytes: MOST_BYTES, work, ..Limits::default() };
    let bytes = input::bytes_within(path, &limits)?;
    if let Some(format) = layer::format_of(path, &bytes) {
        return figure(args, &bytes, format, &name, messages).map(Input::Figure);
    }
    if args.window.is_some() {
        messages.warning(&name, "--window is for shapes of the plane; here it does nothing");
    }
    if IMAGES.iter().any(|magic| bytes.starts_with(magic)) {
        let image = image::decode(&bytes, &name, &limits);
        let image = image.map_err(|e| Failure::Data(format!("{name}: {e}")))?;
        return grid(args, &image, &name, messages).map(Input::Grid);
    }
    let options = ReadOptions { limits, ..ReadOptions::default() };
    let file = path.file_name().unwrap_or_default().to_string_lossy();
    let folder = input::folder(path);
    let model = read_model(&bytes, &file, &*folder, &options)
        .map_err(|e| Failure::Data(format!("{name}: {e}")))?;
    messages.warnings(&name, &model.warnings);
    faces(&model.scene, &name, messages).map(Input::Faces)
}

/// Reads shapes of the plane.
fn figure(
    args: &ExplainArgs,
    bytes: &[u8],
    format: GeoFormat,
    name: &str,
    messages: &Messages,
) -> Result<Figure, Failure> {
    let fail = |e: durer_formats::Error| Failure::Data(format!("{name}: {}", layer::words(&e)));
    let mut reader = geo::Reader::new(format, bytes).map_err(fail)?;
    let mut figure = Figure { window: args.window, ..Figure::default() };
    while let Some(feature) = reader.next_feature().map_err(fail)? {
        if let Some(geometry) = &feature.geometry {
            add(&mut figure, geometry);
        }
        if figure.points().count() > durer::explain::MAX_POINTS {
            let most = durer::explain::MAX_POINTS;
            return Err(Failure::Data(format!(
                "{name}: it has more than the {most} points that can be explained"
            )));
        }
    }
    messages.warnings(name, reader.warnings());
    Ok(figure)
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
fn grid(
    args: &ExplainArgs,
    image: &Image,
    name: &str,
    messages: &Messages,
) -> Result<Grid, Failure> {
    let (width, height) = (image.width, image.height);
    let pixels = u64::from(width) * u64::from(height);
    if pixels > durer::explain::MAX_POINTS as u64 {
        let most = durer::explain::MAX_POINTS;
        return Err(Failure::Data(format!(
            "{name}: {width}x{height} are more than the {most} pixels that can be explained"
        )));
    }
    let mut colors: BTreeMap<u8, [u8; 4]> = BTreeMap::new();
    let mut alike = false;
    let mut cells = Vec::new();
    for &color in &image.data {
        let grey = grey(color);
        alike |= *colors.entry(grey).or_insert(color) != color;
        cells.push(grey);
    }
    if alike {
        messages.warning(name, "different colours have one grey and are taken as one");
    }
    let at = args.at.floor();
    if !(at.x >= 0.0 && at.y >= 0.0 && at.x < f64::from(width) && at.y < f64::from(height)) {
        return Err(Failure::Usage(format!(
            "--at {},{}: the picture is {width}x{height}",
            at.x, at.y
        )));
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
fn faces(scene: &Scene, name: &str, messages: &Messages) -> Result<Vec<Vec<DVec3>>, Failure> {
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
        return Err(Failure::Data(format!("{name}: there are no faces in it")));
    }
    if left_out > 0 {
        let message =
            format!("only its first {MOST_FACES} faces are explained; {left_out} are left out");
        messages.warning(name, message);
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
fn oblique(up_axis: UpAxis) -> Result<impl Fn(DVec3) -> DVec3, Failure> {
    let view =
        ViewDirection::from_angles(30.0, 25.0, up_axis).map_err(|e| Failure::of_library(&e))?;
    let back = view.to_eye();
    let right = view.up().cross(back).normalize_or_zero();
    let above = back.cross(right);
    Ok(move |p: DVec3| DVec3::new(right.dot(p), above.dot(p), back.dot(p)))
}
