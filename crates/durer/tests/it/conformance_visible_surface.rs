//! Item ids, coverage and depth against VTK's on real models: `reference/visible_surface`.

use crate::data;
use durer::math::DVec3;
use durer::pipeline::{RenderOptions, Samples, SurfaceMethod, render};
use durer::scene::{Camera, Mesh, Projection, Scene};
use durer::target::NO_ITEM;
use durer::view::View;
use serde_json::Value;
use std::path::Path;

fn vector(value: &Value) -> DVec3 {
    let at = |i: usize| value[i].as_f64().expect("number");
    DVec3::new(at(0), at(1), at(2))
}

fn camera(value: &Value) -> Camera {
    let number = |name: &str| value[name].as_f64().expect("number");
    let projection = match value["type"].as_str() {
        Some("perspective") => Projection::Perspective { fov_y: number("fovy_deg").to_radians() },
        _ => Projection::Orthographic { height: 2.0 * number("half_height") },
    };
    Camera {
        eye: vector(&value["eye"]),
        target: vector(&value["target"]),
        up: vector(&value["up"]),
        projection,
        near: number("near"),
        far: number("far"),
    }
}

/// Decodes a PNG to one number per pixel: R<<16|G<<8|B, or the 16-bit grey value.
fn read_png(path: &Path) -> Vec<u32> {
    let file = std::io::BufReader::new(std::fs::File::open(path).expect("reference picture"));
    let mut reader = png::Decoder::new(file).read_info().expect("PNG");
    let mut bytes = vec![0; reader.output_buffer_size().expect("size")];
    let info = reader.next_frame(&mut bytes).expect("PNG frame");
    let channels = info.line_size / info.width as usize;
    bytes[..info.buffer_size()]
        .chunks_exact(channels)
        .map(|p| p.iter().take(3).fold(0, |value, byte| value << 8 | u32::from(*byte)))
        .collect()
}

/// Differences between our picture and the reference.
#[derive(Debug, Default)]
struct Difference {
    covered: usize,
    items: usize,
    coverage: usize,
    worst_depth: u32,
    /// Pixels where the reference, not our picture, is off the triangle's plane by more than the tolerance.
    reference_off: usize,
}

/// For each item of a non-convex quad, the quad's first item. The reference split it at its first corner even where
/// that diagonal is outside, so only the quad as a whole can be compared.
fn concave_quads(scene: &Scene) -> Vec<Option<u32>> {
    let mut quads = Vec::new();
    for mesh in scene.instances.iter().map(|i| &scene.meshes[i.mesh]) {
        let (offset, count) = (quads.len() as u32, mesh.triangle_count() as u32);
        quads.resize(quads.len() + count as usize, None);
        let ends = mesh.faces.iter().skip(1).copied().chain([count]);
        for (&first, end) in mesh.faces.iter().zip(ends) {
            if end - first == 2 && !is_convex(mesh, first as usize) {
                quads[(offset + first) as usize..(offset + end) as usize]
                    .fill(Some(offset + first));
            }
        }
    }
    quads
}

/// Returns whether the quad of two triangles may also be split along its other diagonal.
fn is_convex(mesh: &Mesh, first: usize) -> bool {
    let [one, two] = [mesh.triangle(first), mesh.triangle(first + 1)];
    let apex = |of: [u32; 3], other: [u32; 3]| of.iter().position(|v| !other.contains(v));
    let (Some(i), Some(j)) = (apex(one, two), apex(two, one)) else { return false };
    let at = |v: u32| mesh.positions[v as usize].as_dvec3();
    let outline = [one[i], one[(i + 1) % 3], two[j], one[(i + 2) % 3]].map(at);
    let turn = |k: usize| {
        let [a, b, c] = [k, k + 1, k + 2].map(|k| outline[k % 4]);
        (b - a).cross(c - b)
    };
    let whole = turn(0) + turn(1) + turn(2) + turn(3);
    (0..4).all(|k| turn(k).dot(whole) > 0.0)
}

/// Returns the depth of an item's plane at a pixel's centre, in f64 from the file's own
/// coordinates.
fn exact_depth(scene: &Scene, view: &View, item: u32, x: u32, y: u32) -> f64 {
    let mut first = 0;
    for instance in &scene.instances {
        let mesh = &scene.meshes[instance.mesh];
        let index = item as usize - first;
        first += mesh.triangle_count();
        if index >= mesh.triangle_count() {
            continue;
        }
        let m = view.screen_from_world() * instance.world_from_mesh;
        let [a, b, c] = mesh.triangle(index).map(|v| {
            let h = m * mesh.positions[v as usize].as_dvec3().extend(1.0);
            DVec3::new(h.x, h.y, h.z) / h.w
        });
        let normal = (b - a).cross(c - a);
        let (dx, dy) = (f64::from(x) + 0.5 - a.x, f64::from(y) + 0.5 - a.y);
        return a.z - (normal.x * dx + normal.y * dy) / normal.z;
    }
    panic!("item {item} does not exist")
}

fn compare(view: &Value, folder: &Path, method: SurfaceMethod) -> Difference {
    let mesh = view["mesh"].as_str().expect("mesh");
    let tag = view["tag"].as_str().expect("tag");
    let model = data::read_model(&folder.join(mesh));
    let mut options = RenderOptions::new(camera(&view["camera"]));
    options.width = view["width"].as_u64().expect("width") as u32;
    options.height = view["height"].as_u64().expect("height") as u32;
    (options.algorithm, options.samples) = (method, Samples::One);
    (options.item, options.depth) = (true, true);
    let (framebuffer, _) = render(&model.scene, &options).expect("picture");
    let exact_view = View::new(options.camera, options.width, options.height).expect("view");
    let items = framebuffer.item.expect("items").into_data();
    let depths = framebuffer.depth.expect("depths").into_data();

    let reference = folder.join("reference/visible_surface");
    let their_items = read_png(&reference.join(format!("{tag}_vtk_id.png")));
    let their_depths = read_png(&reference.join(format!("{tag}_vtk_depth16.png")));
    let instanced = model.scene.instances.len() != model.scene.meshes.len();
    let quads = concave_quads(&model.scene);
    let quad = |item: u32| quads.get(item as usize).copied().flatten();
    let mut difference = Difference::default();
    for (i, &item) in items.iter().enumerate() {
        let theirs = their_items[i];
        let (here, there) = (item != NO_ITEM, theirs != 0xff_ffff);
        difference.covered += usize::from(there);
        difference.coverage += usize::from(here != there);
        if here && there && quad(item).is_some() && quad(item) == quad(theirs) {
            continue;
        }
        if here && there {
            difference.items += usize::from(!instanced && item != theirs);
            if instanced || item == theirs {
                let depth = (depths[i] * 65535.0).round() as u32;
                let away = depth.abs_diff(their_depths[i]);
                if away > 2 {
                    let (x, y) = (i as u32 % options.width, i as u32 / options.width);
                    let exact = 65535.0 * exact_depth(&model.scene, &exact_view, item, x, y);
                    if (f64::from(their_depths[i]) - exact).abs() > 2.0 {
                        assert!((f64::from(depth) - exact).abs() <= 1.0, "{tag} {x},{y}");
                        difference.reference_off += 1;
                        continue;
                    }
                }
                difference.worst_depth = difference.worst_depth.max(away);
            }
        }
    }
    difference
}

#[test]
fn items_coverage_and_depth_agree_with_vtk() {
    let Some(folder) = data::folder() else { return };
    let views = std::fs::read_to_string(folder.join("reference/visible_surface/views.json"));
    let views: Value = serde_json::from_str(&views.expect("views.json")).expect("JSON");
    let views = views["views"].as_array().expect("views");
    assert_eq!(views.len(), 22);
    for (view, &method) in views.iter().flat_map(|v| SurfaceMethod::ALL.iter().map(move |m| (v, m)))
    {
        let d = compare(view, &folder, method);
        let tag = format!("{} by {method}", view["tag"]);
        assert!(d.items * 200 <= d.covered, "{tag}: {d:?}");
        assert!(d.coverage <= 3, "{tag}: {d:?}");
        assert!(d.worst_depth <= 2, "{tag}: {d:?}");
        assert!(d.reference_off <= 1, "{tag}: {d:?}");
        println!("{tag}: {d:?}");
    }
}
