//! The visible surfaces along rays from the eye: an opaque one, and blended ones before it.

use super::bvh::Test;
use super::primary::ScreenHit;
use super::{Caster, Step, Tests};
use crate::target::NO_ITEM;
use crate::trace::{NoTrace, Tracer};
use crate::visibility::surface::layers::{Layer, sort_layers};
use crate::visibility::surface::visible::{Masks, nearer};

/// One thread's rays.
pub struct Eye<'a> {
    caster: &'a Caster<'a>,
    masks: Masks<'a>,
    stack: Vec<(u32, f32)>,
    /// Blended surfaces along the latest ray, far ones first.
    layers: Vec<Layer>,
}

impl<'a> Eye<'a> {
    pub fn new(caster: &'a Caster<'a>) -> Self {
        let masks = Masks::new(caster.input, caster.lighting);
        Self { caster, masks, stack: Vec::new(), layers: Vec::new() }
    }

    /// Casts a ray through a point `offset` (1/256 pixel) from a pixel's centre and returns the first opaque hit;
    /// blended hits before it are kept until the next ray.
    pub fn cast(
        &mut self,
        [x, y]: [i32; 2],
        offset: [i32; 2],
        steps: &mut Vec<Step>,
    ) -> Option<ScreenHit> {
        let mut tests = Tests::default();
        let opaque = match self.caster.report {
            None => self.first_opaque([x, y], offset, &mut NoTrace),
            Some(_) => self.first_opaque([x, y], offset, &mut tests),
        };
        let Self { caster, layers, .. } = self;
        if let Some(o) = opaque {
            layers.retain(|l| nearer((l.depth, l.item), (o.depth, o.item)));
        }
        sort_layers(layers);
        if let Some(report) = &caster.report {
            steps.push(report.primary([x, y], offset, self.nearest(opaque), tests));
        }
        opaque
    }

    /// Returns the first opaque hit of a ray, and puts the blended ones that are found on the way into the layers.
    fn first_opaque(
        &mut self,
        [x, y]: [i32; 2],
        offset: [i32; 2],
        tests: &mut impl Tracer<Test>,
    ) -> Option<ScreenHit> {
        let Self { caster, masks, stack, layers } = self;
        layers.clear();
        let hides = |hit: &ScreenHit| {
            let triangle = hit.triangle as usize;
            if !masks.passes(triangle, hit.item, x, y) {
                return false;
            }
            let blends = caster.blended.as_ref().is_some_and(|b| b.contains(triangle));
            if blends {
                layers.push(Layer { place: 0, item: hit.item, depth: hit.depth });
            }
            !blends
        };
        caster.rays.cast([x, y], offset, stack, hides, tests)
    }

    /// Returns the depth and item of the first hit of the latest ray, which found `opaque`.
    pub fn nearest(&self, opaque: Option<ScreenHit>) -> Option<(f32, u32)> {
        let blended = self.layers.last().map(|l| (l.depth, l.item));
        blended.or(opaque.map(|o| (o.depth, o.item)))
    }

    /// Returns the items of all hits of the latest ray, which found `opaque`: first the opaque one, or [`NO_ITEM`],
    /// then the blended ones, far ones first.
    pub fn items(&self, opaque: Option<ScreenHit>) -> Vec<u32> {
        let opaque = opaque.map_or(NO_ITEM, |o| o.item);
        std::iter::once(opaque).chain(self.layers.iter().map(|l| l.item)).collect()
    }
}
