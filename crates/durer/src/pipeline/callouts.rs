//! The visible points of parts in a view: the places that leaders from their numbers point at.

use super::{Background, RenderOptions, Samples, SurfaceMethod, render};
use crate::Result;
use crate::math::{DVec2, Vec4};
use crate::scene::{Camera, Scene};
use crate::target::{NO_ITEM, Pixels};
use crate::view::components::Component;
use crate::view::picture_plane::PicturePlane;
use crate::visibility::surface::setup::runs;

/// Rows of the picture in which parts are searched: parts narrower than a thousandth of it are not found.
const ROWS: u32 = 1000;

/// Marks triangles that belong to no part.
const NONE: u32 = u32::MAX;

/// Finds for each kind of part a point at which a part of that kind is visible, as far from its surroundings as
/// possible, in plane units of a [`crate::target::drawing::Drawing`] of the camera; `None` if it is not seen. `aspect`
/// is width over height of the camera's field of view, 1/8 … 8.
///
/// Cost: a picture of a thousand rows.
///
/// # Errors
/// As [`render`].
pub fn seen_at(
    scene: &Scene,
    components: &[Component],
    camera: Camera,
    aspect: f64,
) -> Result<Vec<Option<DVec2>>> {
    let width = (f64::from(ROWS) * aspect.clamp(0.125, 8.0)).round() as u32;
    let options = RenderOptions {
        algorithm: SurfaceMethod::ZBuffer,
        width,
        height: ROWS,
        samples: Samples::One,
        background: Background::Color(Vec4::ZERO),
        item: true,
        ..RenderOptions::new(camera)
    };
    let (picture, _) = render(scene, &options)?;
    let Some(items) = picture.item else { return Ok(vec![None; components.len()]) };
    let kinds = kinds(scene, components, &items)?;
    let size = DVec2::new(f64::from(width), f64::from(ROWS));
    let plane = PicturePlane::of_camera(&camera, size.x / size.y)?;
    let half = plane.window().map_or(DVec2::ONE, |w| w.max());
    let place = |pixel: usize| {
        let (x, y) = (pixel % width as usize, pixel / width as usize);
        let at = (DVec2::new(x as f64, y as f64) + 0.5) / size;
        DVec2::new(at.x * 2.0 - 1.0, 1.0 - at.y * 2.0) * half
    };
    let found = innermost(&kinds, width as usize, components.len());
    Ok(found.into_iter().map(|pixel| pixel.map(place)).collect())
}

/// Returns the kind of part that each pixel shows, or [`NONE`].
fn kinds(scene: &Scene, components: &[Component], items: &Pixels<u32>) -> Result<Vec<u32>> {
    let mut of_instance = vec![NONE; scene.instances.len()];
    for (kind, component) in (0..).zip(components) {
        for &instance in &component.instances {
            if let Some(slot) = of_instance.get_mut(instance) {
                *slot = kind;
            }
        }
    }
    let runs = runs(scene)?;
    let kind = |&item: &u32| {
        let after = runs.partition_point(|run| run.first_item <= item);
        let run = after.checked_sub(1).and_then(|i| runs.get(i)).filter(|_| item != NO_ITEM);
        run.and_then(|run| of_instance.get(run.instance)).copied().unwrap_or(NONE)
    };
    Ok(items.data().iter().map(kind).collect())
}

/// Returns, for each of `count` kinds, the pixel farthest, in steps to neighbours, from pixels of other kinds and from
/// the border of the picture; the first of equals.
fn innermost(kinds: &[u32], width: usize, count: usize) -> Vec<Option<usize>> {
    let mut steps = vec![0u32; kinds.len()];
    let step = |steps: &[u32], at: usize, other: Option<usize>| match other {
        Some(other) if kinds.get(other) == kinds.get(at) => steps.get(other).map_or(1, |s| s + 1),
        _ => 1,
    };
    for at in 0..kinds.len() {
        let left = (at % width > 0).then(|| at - 1);
        let up = at.checked_sub(width);
        steps[at] = step(&steps, at, left).min(step(&steps, at, up));
    }
    let mut best: Vec<Option<(u32, usize)>> = vec![None; count];
    for at in (0..kinds.len()).rev() {
        let right = ((at + 1) % width > 0).then_some(at + 1);
        let down = Some(at + width).filter(|d| *d < kinds.len());
        let nearest = step(&steps, at, right).min(step(&steps, at, down)).min(steps[at]);
        steps[at] = nearest;
        if let Some(best) = best.get_mut(kinds[at] as usize)
            && best.is_none_or(|(most, _)| nearest >= most)
        {
            *best = Some((nearest, at));
        }
    }
    best.into_iter().map(|b| b.map(|(_, at)| at)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_innermost_pixel_of_each_kind_is_found() {
        let rows = ["1111111", "1000001", "1000001", "1000001", "1111112"];
        let kinds: Vec<u32> = rows.concat().bytes().map(|b| u32::from(b - b'0')).collect();
        // The centre of kind 0; kind 1 is one pixel wide; kind 2 is one pixel; kind 3 is missing.
        assert_eq!(innermost(&kinds, 7, 4), [Some(2 * 7 + 2), Some(0), Some(34), None]);
    }
}
