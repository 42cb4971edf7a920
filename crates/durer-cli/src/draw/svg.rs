//! A drawing in SVG.

use super::args::DxfUnits;
use super::{Given, Job, Surface, fonts, frame, has_folder, sides};
use crate::failure::Failure;
use crate::input::display_name;
use crate::resources::Folder;
use durer::map::Style;
use durer::math::{DAffine2, DVec2, Rect};
use durer::raster::coverage::FillRule;
use durer::view::window::{Aspect, Window, WindowToViewport, YAxis};
use durer_formats::NoResources;
use durer_formats::svg::{Drawing, ReadOptions};
use std::time::Instant;

impl Job<'_> {
    /// Returns everything that the SVG drawing paints.
    pub(super) fn drawing<T: Surface>(&mut self, given: &Given<'_>) -> Result<T, Failure> {
        let name = display_name(&given.layer.input);
        let fail = |what: String| Failure::Data(format!("{name}: {what}"));
        if given.layer.chosen.is_some() {
            return Err(Failure::Usage("--layer is for map data; an SVG has none".to_owned()));
        }
        if !given.layer.conditions.is_empty() {
            return Err(Failure::Usage("--where is for map data; an SVG has no fields".to_owned()));
        }
        if given.layer.from_crs.is_some() || self.args.to_crs.is_some() {
            let message =
                "--from-crs and --to-crs are for map data; an SVG has no places on the earth";
            return Err(Failure::Usage(message.to_owned()));
        }
        if self.args.skip_failures {
            let message = "--skip-failures is for map data; an SVG has no features";
            return Err(Failure::Usage(message.to_owned()));
        }
        if given.layer.styled || given.layer.style != Style::default() {
            let message = "--fill, --stroke and other styles are for map data; an SVG has its own";
            return Err(Failure::Usage(message.to_owned()));
        }
        if self.args.picture.dxf_units == Some(DxfUnits::Map) {
            let message =
                "--dxf-units map: an SVG has no map's coordinates; its .dxf has millimetres";
            return Err(Failure::Usage(message.to_owned()));
        }
        let start = Instant::now();
        let fonts = fonts::load(&self.args.fonts)?;
        let folder = Folder::of(&given.layer.input).ok().filter(|_| has_folder(given.layer));
        let limits = self.limits();
        let mut options = ReadOptions { fonts: &fonts, resources: &NoResources, limits };
        if let Some(folder) = &folder {
            options.resources = folder;
        }
        self.messages.progress.stage(|| format!("reading {name}"));
        let drawing =
            Drawing::read(&given.file.bytes, &options).map_err(|e| fail(e.to_string()))?;
        self.report.read_seconds += start.elapsed().as_secs_f64();
        self.warn(&name, drawing.warnings());

        self.messages.progress.stage(|| format!("drawing {name}"));
        let picture = &self.args.picture;
        let whole = Rect::new(DVec2::ZERO, drawing.size()).map_err(|e| fail(e.to_string()))?;
        let shown = picture.window.unwrap_or(whole);
        let size = sides(picture.size, shown.size());
        // A size that was not given whole is the drawing's own.
        let given = picture.size.is_some_and(|s| s.width.is_some() && s.height.is_some());
        let surface = self.surface(size, [0; 4]);
        let mut canvas: T = surface.map_err(|failure| match failure {
            Failure::Usage(message) if !given => {
                fail(format!("{}{message}, or --size draws it smaller", drawing.place()))
            }
            failure => failure,
        })?;
        let viewport = self.viewport(size)?;
        let (lo, hi) = (shown.min(), shown.max());
        let window =
            Window::new(lo.x, hi.x, lo.y, hi.y).map_err(|e| Failure::Usage(e.to_string()))?;
        // Rows grow with the drawing's y.
        let map = WindowToViewport::new(&window, &viewport, Aspect::Fit, YAxis::Up);
        let [a, b, c, d] = map.coefficients();
        let pixel_from_drawing =
            DAffine2::from_cols(DVec2::new(a, 0.0), DVec2::new(0.0, c), DVec2::new(b, d));
        canvas.push_clip(&frame(&viewport), FillRule::NonZero);
        if picture.window.is_none() {
            // Nothing is seen beyond the drawing's own frame.
            canvas.set_transform(pixel_from_drawing);
            let size = drawing.size();
            let own = durer::curve::Path::rectangle(0.0, 0.0, size.x, size.y);
            canvas.push_clip(&own, FillRule::NonZero);
        }
        let warnings = drawing.draw(&mut canvas, pixel_from_drawing);
        self.warn(&name, &warnings);
        Ok(canvas)
    }
}
