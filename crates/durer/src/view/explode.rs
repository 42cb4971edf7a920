//! Exploded views: the parts of an assembly moved apart, each as a whole.
//!
//! Along an axis every part is moved beyond the parts in its way out: of parts whose boxes overlap across the axis, the
//! one that reaches farther up is above, unless it reaches farthest down and not farthest up. From the middle outwards,
//! all distances grow by the same factor. It takes O(n²) time for n instances.

use super::components;
use crate::math::{DMat4, DVec3, Vec3};
use crate::scene::{Aabb, Instance, Mesh, Scene, Topology};
use crate::sorting::CompactSort;
use crate::{Error, Result};

/// Direction in which parts are moved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ExplodeDirection {
    /// The world's x axis.
    X,
    /// The world's y axis.
    Y,
    /// The world's z axis.
    Z,
    /// Away from the middle.
    Radial,
}

impl std::str::FromStr for ExplodeDirection {
    type Err = Error;

    fn from_str(s: &str) -> Result<Self> {
        match s {
            "x" => Ok(Self::X),
            "y" => Ok(Self::Y),
            "z" => Ok(Self::Z),
            "radial" => Ok(Self::Radial),
            _ => Err(Error::parameter("explode", s, "x, y, z or radial")),
        }
    }
}

/// Default gap, as a part of the scene's extent, or of the largest distance from the middle for [`ExplodeDirection::Radial`].
const GAP: f64 = 0.08;
const RADIAL_GAP: f64 = 0.8;

/// Scenes with more instances are not assemblies with distinguishable parts.
const MOST: usize = 4000;

/// Overlap, as a part of the scene's extent, below which boxes count as beside each other.
const BESIDE: f64 = 1e-6;

/// Moves the instances of a scene apart. `gap` is the free space between neighbours along the axis, in the world's
/// units, or for [`ExplodeDirection::Radial`] how far the outermost part is moved; `None` takes a part of the scene's extent.
///
/// Along an axis the scene gets lines from each part to the one that it was moved away from, in an additional last
/// instance.
///
/// # Errors
/// The errors of [`Scene::check`]; [`Error::Parameter`] for a gap that is not above 0, and for a scene of more than
/// 4,000 instances, or of fewer than two.
pub fn explode(scene: &Scene, way: ExplodeDirection, gap: Option<f64>) -> Result<Scene> {
    scene.check()?;
    if let Some(gap) = gap.filter(|g| !(*g > 0.0 && g.is_finite())) {
        return Err(Error::parameter("explode", gap, "a gap above 0"));
    }
    let parts = parts(scene);
    if !(2..=MOST).contains(&parts.len()) {
        let found = format!("a model of {} parts", parts.len());
        return Err(Error::parameter("explode", found, "a model of 2 to 4000 objects"));
    }
    let whole = parts.iter().skip(1).fold(parts[0].1, |all, p| all.union(&p.1));
    let mut exploded = scene.clone();
    let mut traces = Vec::new();
    let shifts = match way {
        ExplodeDirection::Radial => away(&parts, &whole, gap),
        _ => along(&parts, &whole, way as usize, gap, &mut traces),
    };
    for ((part, _), shift) in parts.iter().zip(shifts) {
        for &index in part {
            let placed = &mut exploded.instances[index];
            placed.world_from_mesh = DMat4::from_translation(shift) * placed.world_from_mesh;
        }
    }
    add_traces(&mut exploded, &traces);
    Ok(exploded)
}

/// The instances of each part that has something to show, with its box in the world.
type Part = (Vec<usize>, Aabb);

fn parts(scene: &Scene) -> Vec<Part> {
    let bounds = |index: &usize| {
        let instance = &scene.instances[*index];
        let mesh = &scene.meshes[instance.mesh];
        let points = mesh.positions.iter().map(|p| p.as_dvec3());
        let world = points.map(|p| instance.world_from_mesh.transform_point3(p));
        Aabb::around(world).filter(|_| mesh.primitive_count() > 0)
    };
    let part = |part: Vec<usize>| {
        let all = part.iter().filter_map(bounds).reduce(|a, b| a.union(&b))?;
        Some((part, all))
    };
    components::parts(scene).into_iter().filter_map(part).collect()
}

fn away(parts: &[Part], whole: &Aabb, gap: Option<f64>) -> Vec<DVec3> {
    let way = |p: &Part| p.1.center() - whole.center();
    let farthest = parts.iter().map(|p| way(p).length()).fold(0.0, f64::max);
    let share = gap.map_or(RADIAL_GAP, |gap| if farthest > 0.0 { gap / farthest } else { 0.0 });
    parts.iter().map(|p| way(p) * share).collect()
}

/// Shifts along an axis; adds the lines from each part to the one below it.
fn along(
    parts: &[Part],
    whole: &Aabb,
    axis: usize,
    gap: Option<f64>,
    traces: &mut Vec<[DVec3; 2]>,
) -> Vec<DVec3> {
    let extent = (whole.max - whole.min).max_element();
    let gap = gap.unwrap_or(extent * GAP);
    let mut up = DVec3::ZERO;
    up[axis] = 1.0;
    let above = Stacks { parts, axis, beside: extent * BESIDE };
    let mut shifts = vec![0.0; parts.len()];
    let order = above.order();
    for (place, &i) in order.iter().enumerate() {
        let (_, own) = &parts[i];
        let below = order[..place].iter().filter(|j| above.overlap(i, **j));
        // As far as the highest of those below it wants.
        let tops = below.map(|j| parts[*j].1.max[axis] + shifts[*j]);
        let Some(top) = tops.max_by(f64::total_cmp) else { continue };
        shifts[i] = top + gap - own.min[axis];
        let foot = own.center().reject_from_normalized(up);
        traces.push([top, top + gap].map(|height| foot + up * height));
    }
    // The middle stays where it is.
    let ends = parts.iter().zip(&shifts).map(|((_, b), s)| (b.min[axis] + s, b.max[axis] + s));
    let (low, high) =
        ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), e| (a.min(e.0), b.max(e.1)));
    let back = whole.center()[axis] - (low + high) * 0.5;
    traces.iter_mut().flatten().for_each(|p| *p += up * back);
    shifts.into_iter().map(|s| up * (s + back)).collect()
}

/// Order of parts along an axis.
struct Stacks<'a> {
    parts: &'a [Part],
    axis: usize,
    beside: f64,
}

impl Stacks<'_> {
    /// Returns whether two parts overlap across the axis.
    fn overlap(&self, i: usize, j: usize) -> bool {
        let (a, b) = (&self.parts[i].1, &self.parts[j].1);
        (0..3).filter(|k| *k != self.axis).all(|k| {
            let common = a.max[k].min(b.max[k]) - a.min[k].max(b.min[k]);
            // Flat parts have no extent to overlap by.
            let least = (a.max[k] - a.min[k]).min(b.max[k] - b.min[k]).min(self.beside);
            common >= least
        })
    }

    /// Sorts from below upwards: first the boxes that reach farther down than all that they overlap, and not farther up
    /// than all of them, then the rest by upper end.
    fn order(&self) -> Vec<usize> {
        let ends = |i: usize| (self.parts[i].1.min[self.axis], self.parts[i].1.max[self.axis]);
        let is_base = |i: usize| {
            let (low, high) = ends(i);
            let others = (0..self.parts.len()).filter(|j| *j != i && self.overlap(i, *j));
            let others: Vec<(f64, f64)> = others.map(ends).collect();
            others.iter().all(|other| low < other.0 - self.beside)
                && (others.is_empty() || others.iter().any(|o| high <= o.1 + self.beside))
        };
        let key = |i: usize| {
            let base = is_base(i);
            (!base, if base { ends(i).0 } else { ends(i).1 })
        };
        let mut order: Vec<((bool, f64), usize)> =
            (0..self.parts.len()).map(|i| (key(i), i)).collect();
        order.compact_sort_by(|(a, i), (b, j)| {
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(i.cmp(j))
        });
        order.into_iter().map(|o| o.1).collect()
    }
}

/// Adds lines to a scene, relative to the middle of the first, because coordinates of meshes have few digits.
fn add_traces(scene: &mut Scene, traces: &[[DVec3; 2]]) {
    let Some(origin) = traces.first().map(|t| t[0]) else { return };
    let positions: Vec<Vec3> = traces.iter().flatten().map(|p| (*p - origin).as_vec3()).collect();
    let mesh = Mesh { positions, topology: Topology::Lines, ..Mesh::default() };
    scene.instances.push(Instance {
        mesh: scene.meshes.len(),
        world_from_mesh: DMat4::from_translation(origin),
        name: "traces".to_owned(),
    });
    scene.meshes.push(mesh);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a scene of boxes; each is given by the ends of its diagonal and has two triangles between them.
    fn boxes(corners: &[[[f32; 3]; 2]]) -> Scene {
        let mesh = |[a, b]: &[[f32; 3]; 2]| Mesh {
            positions: vec![Vec3::from(*a), Vec3::from(*b), Vec3::new(a[0], b[1], a[2])],
            ..Mesh::default()
        };
        let instance =
            |mesh| Instance { mesh, world_from_mesh: DMat4::IDENTITY, name: String::new() };
        Scene {
            meshes: corners.iter().map(mesh).collect(),
            instances: (0..corners.len()).map(instance).collect(),
            ..Scene::default()
        }
    }

    fn heights(scene: &Scene) -> Vec<f64> {
        scene.instances.iter().map(|i| i.world_from_mesh.w_axis.z).collect()
    }

    #[test]
    fn parts_are_stacked_with_gaps_and_those_beside_each_other_go_together() {
        // A plate, a lid on it, two bolts through both from above, and one from below.
        let scene = boxes(&[
            [[0.0, 0.0, 10.0], [50.0, 20.0, 20.0]],
            [[0.0, 0.0, 0.0], [50.0, 20.0, 10.0]],
            [[5.0, 5.0, 0.0], [9.0, 9.0, 24.0]],
            [[35.0, 5.0, 0.0], [39.0, 9.0, 24.0]],
            [[20.0, 5.0, -4.0], [24.0, 9.0, 20.0]],
        ]);
        let found = explode(&scene, ExplodeDirection::Z, Some(5.0)).unwrap();
        let z = heights(&found);
        let places = |i: usize, low: f64, high: f64| (low + z[i], high + z[i]);
        let (lid, plate) = (places(0, 10.0, 20.0), places(1, 0.0, 10.0));
        let (bolt, low) = (places(2, 0.0, 24.0), places(4, -4.0, 20.0));
        assert_eq!(z[2], z[3]);
        assert!((plate.0 - low.1 - 5.0).abs() < 1e-9, "{plate:?} {low:?}");
        assert!((lid.0 - plate.1 - 5.0).abs() < 1e-9 && (bolt.0 - lid.1 - 5.0).abs() < 1e-9);
        // The middle part stays, and lines fill the gaps.
        assert!((low.0 + bolt.1 - (-4.0 + 24.0)).abs() < 1e-9);
        let traces = found.meshes.last().unwrap();
        assert_eq!((traces.topology, traces.positions.len()), (Topology::Lines, 8));
        assert!(traces.positions.chunks(2).all(|t| (t[1] - t[0]).abs_diff_eq(Vec3::Z * 5.0, 1e-4)));
    }

    #[test]
    fn parts_move_away_from_the_middle() {
        let scene = boxes(&[[[0.0; 3], [1.0; 3]], [[3.0, 0.0, 0.0], [4.0, 1.0, 1.0]]]);
        let found = explode(&scene, ExplodeDirection::Radial, Some(3.0)).unwrap();
        let x: Vec<f64> = found.instances.iter().map(|i| i.world_from_mesh.w_axis.x).collect();
        assert_eq!(x, [-3.0, 3.0]);
        assert!(explode(&scene, ExplodeDirection::X, Some(0.0)).is_err());
        assert!(explode(&boxes(&[[[0.0; 3], [1.0; 3]]]), ExplodeDirection::X, None).is_err());
    }
}
