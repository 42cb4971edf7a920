//! The tree of a drawing, node by node.

use super::painted::{ImageKey, Painted, TileKey};
use super::{image, paint};
use crate::Limits;
use durer::curve::Path;
use durer::math::DAffine2;
use durer::raster::coverage::FillRule;
use durer::raster::line::wide::{Cap, Join, Stroke, has_too_many_dashes};
use durer::raster::paint::{BlendFunction, Canvas, MaskKind, Paint, PaintTarget};
use std::collections::BTreeSet;
use std::sync::Arc;
use usvg::{Group, Node};

/// Largest depth of nested groups, clip paths, masks, patterns and drawings within images, all together.
const MAX_DEPTH: u32 = 200;

/// Painter of nodes onto a canvas or a sheet.
pub(super) struct Painter<'a, T> {
    canvas: &'a mut T,
    limits: &'a Limits,
    /// Nesting depth of the current node.
    depth: u32,
    /// Bytes of images that are still allowed.
    bytes_left: u64,
    /// Images and tiles to use again.
    painted: Painted,
    warnings: BTreeSet<String>,
}

impl<'a, T: PaintTarget> Painter<'a, T> {
    pub fn new(canvas: &'a mut T, limits: &'a Limits) -> Self {
        let bytes_left = limits.decoded_bytes;
        let (painted, warnings) = (Painted::default(), BTreeSet::new());
        Self { canvas, limits, depth: 0, bytes_left, painted, warnings }
    }

    /// Returns the messages about parts that could not be drawn.
    pub fn warnings(self) -> BTreeSet<String> {
        self.warnings
    }

    fn warn(&mut self, message: impl Into<String>) {
        self.warnings.insert(message.into());
    }

    pub fn tree(&mut self, tree: &usvg::Tree, map: DAffine2) {
        self.group(tree.root(), map);
    }

    /// Runs `work` one level deeper, unless that is too deep.
    fn deeper(&mut self, work: impl FnOnce(&mut Self)) {
        if self.depth == MAX_DEPTH {
            return self
                .warn(format!("elements nested more than {MAX_DEPTH} levels deep are left out"));
        }
        self.depth += 1;
        work(self);
        self.depth -= 1;
    }

    fn nodes(&mut self, group: &Group, map: DAffine2) {
        self.deeper(|this| {
            for node in group.children() {
                match node {
                    Node::Group(group) => this.group(group, map),
                    Node::Path(path) => this.path(path, map, 1.0),
                    Node::Image(image) => this.image(image, map),
                    Node::Text(text) => this.group(text.flattened(), map),
                }
            }
        });
    }

    /// Draws a group within its clip path and its mask, with its opacity and blend mode.
    fn group(&mut self, group: &Group, map: DAffine2) {
        let map = map * paint::affine(group.transform());
        if !group.filters().is_empty() {
            self.warn("filters are not drawn; elements are drawn without them");
            self.canvas.leave_out("filters");
        }
        let blend = paint::blend(group.blend_mode());
        let clips = group.clip_path().map_or(0, |clip| self.clip(clip, map))
            + group.mask().map_or(0, |mask| self.mask(mask, map));
        let opacity = f64::from(group.opacity().get());
        match single_path(group) {
            _ if !group.should_isolate() => self.nodes(group, map),
            // Content that paints each pixel once needs no layer.
            Some(path) if blend == BlendFunction::Normal => self.path(path, map, opacity),
            _ => {
                self.canvas.push_group();
                self.nodes(group, map);
                self.canvas.pop_blended(opacity, blend);
            }
        }
        (0..clips).for_each(|_| self.canvas.pop(1.0));
    }

    /// Pushes a clip path; returns how many layers have to be popped.
    fn clip(&mut self, clip: &usvg::ClipPath, map: DAffine2) -> u32 {
        let outer = clip.clip_path().map_or(0, |outer| self.clip(outer, map));
        let map = map * paint::affine(clip.transform());
        let root = clip.root();
        let only = single_path(root).filter(|p| p.is_visible() && p.paint_order() == ORDER);
        match only.and_then(|p| Some((p, p.fill()?))) {
            Some((path, fill)) if plain(root) => {
                let map = map * paint::affine(root.transform());
                self.canvas.set_transform(map);
                self.canvas.set_anti_alias(self.smooth(path));
                self.canvas.push_clip(&paint::path(path.data()), rule(fill.rule()));
            }
            _ if self.united(root, map) => {}
            _ => {
                self.canvas.begin_mask();
                self.deeper(|this| this.group(root, map));
                self.canvas.end_mask(MaskKind::Alpha);
            }
        }
        outer + 1
    }

    /// Pushes a clip path of several shapes, if the canvas can do so; returns whether it is done.
    fn united(&mut self, root: &Group, map: DAffine2) -> bool {
        let mut shapes = Vec::new();
        if !areas(root, map, MAX_DEPTH, &mut shapes) {
            return false;
        }
        self.canvas.set_transform(DAffine2::IDENTITY);
        self.canvas.push_united_clip(&shapes)
    }

    /// Pushes a mask; returns how many layers have to be popped.
    fn mask(&mut self, mask: &usvg::Mask, map: DAffine2) -> u32 {
        let outer = mask.mask().map_or(0, |outer| self.mask(outer, map));
        self.canvas.begin_mask();
        self.canvas.set_transform(map);
        self.canvas.push_clip(&paint::rectangle(mask.rect()), FillRule::NonZero);
        self.deeper(|this| this.group(mask.root(), map));
        self.canvas.pop(1.0);
        self.canvas.end_mask(match mask.kind() {
            usvg::MaskType::Alpha => MaskKind::Alpha,
            usvg::MaskType::Luminance => MaskKind::Luminance,
        });
        outer + 1
    }

    /// Returns whether the edges of a path are to be smoothed.
    fn smooth(&self, path: &usvg::Path) -> bool {
        self.canvas.options().anti_alias && path.rendering_mode().use_shape_antialiasing()
    }

    fn path(&mut self, path: &usvg::Path, map: DAffine2, opacity: f64) {
        if !path.is_visible() {
            return;
        }
        let outline = paint::path(path.data());
        let smooth = self.smooth(path);
        let fill = |this: &mut Self| {
            if let Some(fill) = path.fill() {
                let opacity = opacity * f64::from(fill.opacity().get());
                let Some(paint) = this.paint(fill.paint(), map) else { return };
                this.set(map, smooth);
                this.canvas.fill(&outline, rule(fill.rule()), &paint, opacity);
            }
        };
        let stroke = |this: &mut Self| {
            if let Some(stroke) = path.stroke() {
                let opacity = opacity * f64::from(stroke.opacity().get());
                let Some(paint) = this.paint(stroke.paint(), map) else { return };
                this.set(map, smooth);
                let style = this.style(stroke);
                if has_too_many_dashes(&outline, &style) {
                    this.warn("a path with more than 100,000 dashes and gaps is drawn solid");
                }
                if let Err(error) = this.canvas.stroke(&outline, &style, &paint, opacity) {
                    this.warn(format!("a stroke is left out: {error}"));
                }
            }
        };
        match path.paint_order() {
            usvg::PaintOrder::FillAndStroke => {
                fill(self);
                stroke(self);
            }
            usvg::PaintOrder::StrokeAndFill => {
                stroke(self);
                fill(self);
            }
        }
    }

    fn set(&mut self, map: DAffine2, smooth: bool) {
        self.canvas.set_transform(map);
        self.canvas.set_anti_alias(smooth);
    }

    fn style(&mut self, stroke: &usvg::Stroke) -> Stroke {
        Stroke {
            width: f64::from(stroke.width().get()),
            cap: match stroke.linecap() {
                usvg::LineCap::Butt => Cap::Butt,
                usvg::LineCap::Round => Cap::Round,
                usvg::LineCap::Square => Cap::Square,
            },
            join: match stroke.linejoin() {
                usvg::LineJoin::Miter => Join::Miter,
                usvg::LineJoin::MiterClip => {
                    self.warn("line join `miter-clip` is not drawn; `miter` is used in its place");
                    Join::Miter
                }
                usvg::LineJoin::Round => Join::Round,
                usvg::LineJoin::Bevel => Join::Bevel,
            },
            miter_limit: f64::from(stroke.miterlimit().get()),
            dashes: stroke.dasharray().unwrap_or_default().iter().map(|d| (*d).into()).collect(),
            dash_offset: f64::from(stroke.dashoffset()),
        }
    }

    fn paint(&mut self, paint: &usvg::Paint, map: DAffine2) -> Option<Paint> {
        match paint {
            usvg::Paint::Pattern(pattern) => self.pattern(pattern, map),
            other => paint::plain(other),
        }
    }

    /// Returns a pattern's tile, painted at the size at which it will be seen.
    fn pattern(&mut self, pattern: &Arc<usvg::Pattern>, map: DAffine2) -> Option<Paint> {
        let tile = paint::Tile::new(pattern, map)?;
        let key = TileKey::new(pattern, &tile);
        if let Some(painted) = self.painted.tiles.get(&key) {
            return Some(painted.clone());
        }
        let painted = self.painted_tile(pattern, &tile)?;
        self.painted.tiles.insert(key, painted.clone());
        Some(painted)
    }

    fn painted_tile(&mut self, pattern: &usvg::Pattern, tile: &paint::Tile) -> Option<Paint> {
        let mut canvas = Canvas::new(tile.width, tile.height, *self.canvas.options()).ok()?;
        canvas.set_work(self.canvas.work());
        let mut painter = Painter::new(&mut canvas, self.limits);
        painter.depth = self.depth;
        painter.bytes_left = self.bytes_left;
        painter.painted = std::mem::take(&mut self.painted);
        painter.deeper(|this| this.group(pattern.root(), tile.pixel_from_content));
        self.bytes_left = painter.bytes_left;
        self.painted = std::mem::take(&mut painter.painted);
        let warnings = painter.warnings();
        self.warnings.extend(warnings);
        tile.paint(&canvas)
    }

    fn image(&mut self, node: &usvg::Image, map: DAffine2) {
        if !node.is_visible() {
            return;
        }
        let size = node.size();
        if let usvg::ImageKind::SVG(tree) = node.kind() {
            self.set(map, true);
            let (width, height) = (f64::from(size.width()), f64::from(size.height()));
            let frame = Path::rectangle(0.0, 0.0, width, height);
            self.canvas.push_clip(&frame, FillRule::NonZero);
            self.deeper(|this| this.tree(tree, map));
            return self.canvas.pop(1.0);
        }
        match self.pixels(node, map) {
            Ok((paint, frame)) => {
                self.set(map, self.canvas.options().anti_alias);
                self.canvas.fill(&frame, FillRule::NonZero, &paint, 1.0);
            }
            Err(why) => self.warn(format!("an image is left out: {why}")),
        }
    }

    /// Returns an image as a paint and its frame; the reason where it cannot be shown.
    fn pixels(&mut self, node: &usvg::Image, map: DAffine2) -> Result<(Paint, Path), String> {
        let key = ImageKey::new(node, map);
        if let Some(found) = key.as_ref().and_then(|key| self.painted.images.get(key)) {
            return found.clone();
        }
        let limits = Limits { decoded_bytes: self.bytes_left, ..self.limits.clone() };
        let found = image::paint(node, map, &limits).map_err(|error| error.to_string());
        let found = found.map(|(paint, frame, bytes)| {
            self.bytes_left = self.bytes_left.saturating_sub(bytes);
            (paint, frame)
        });
        if let Some(key) = key {
            self.painted.images.insert(key, found.clone());
        }
        found
    }
}

const ORDER: usvg::PaintOrder = usvg::PaintOrder::FillAndStroke;

fn rule(rule: usvg::FillRule) -> FillRule {
    match rule {
        usvg::FillRule::NonZero => FillRule::NonZero,
        usvg::FillRule::EvenOdd => FillRule::EvenOdd,
    }
}

/// Returns the only element of a group, if it is a path that is filled or stroked but not both.
fn single_path(group: &Group) -> Option<&usvg::Path> {
    match group.children() {
        [Node::Path(path)] if path.fill().is_none() || path.stroke().is_none() => Some(path),
        _ => None,
    }
}

/// Collects the filled paths of a group, in pixels; returns whether there is nothing else in it.
fn areas(group: &Group, map: DAffine2, depth: u32, found: &mut Vec<(Path, FillRule)>) -> bool {
    let map = map * paint::affine(group.transform());
    plain(group)
        && depth > 0
        && group.children().iter().all(|node| match node {
            Node::Group(group) => areas(group, map, depth - 1, found),
            Node::Text(text) => areas(text.flattened(), map, depth - 1, found),
            Node::Image(_) => false,
            Node::Path(path) if !path.is_visible() => true,
            Node::Path(path) => match (path.fill(), path.stroke()) {
                (Some(fill), None) => {
                    found.push((paint::path(path.data()).transformed(map), rule(fill.rule())));
                    true
                }
                (None, None) => true,
                (_, Some(_)) => false,
            },
        })
}

/// Returns whether a group only transforms its content.
fn plain(group: &Group) -> bool {
    !group.should_isolate()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::svg::{Drawing, ReadOptions};

    /// Returns the numbers of tiles and images that are painted for a drawing.
    fn painted(content: &str) -> [usize; 2] {
        let text = format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="60" height="60">{content}</svg>"#
        );
        let (options, limits) = (ReadOptions::default(), Limits::default());
        let drawing = Drawing::read(text.as_bytes(), &options).unwrap();
        let mut canvas = Canvas::new(60, 60, Default::default()).unwrap();
        let mut painter = Painter::new(&mut canvas, &limits);
        painter.tree(&drawing.tree, DAffine2::IDENTITY);
        [painter.painted.tiles.len(), painter.painted.images.len()]
    }

    #[test]
    fn a_tile_is_painted_once_for_each_size_that_it_is_seen_at() {
        let pattern = r##"<pattern id="p" width="8" height="8" patternUnits="userSpaceOnUse">
            <circle cx="4" cy="4" r="3"/></pattern>
            <rect id="r" width="9" height="9" fill="url(#p)"/>"##;
        let moved = r##"<use href="#r" x="16"/><use href="#r" y="24"/>"##;
        assert_eq!(painted(&format!("{pattern}{moved}")), [1, 0]);
        let larger = r##"<use href="#r" transform="scale(2)"/>"##;
        assert_eq!(painted(&format!("{pattern}{moved}{larger}{larger}")), [2, 0]);
    }

    #[test]
    fn an_image_is_decoded_once_wherever_it_stands() {
        let png = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==";
        let image = format!(r#"<image id="i" width="9" height="9" href="{png}"/>"#);
        let moved = r##"<use href="#i" x="16"/><use href="#i" y="24"/>"##;
        assert_eq!(painted(&format!("{image}{moved}")), [0, 1]);
        let other = image.replace(r#"id="i""#, r#"x="30""#);
        assert_eq!(painted(&format!("{image}{moved}{other}")), [0, 1]);
        assert_eq!(painted(&format!("{image}{}", image.replace("\"9\"", "\"5\""))), [0, 2]);
    }
}
