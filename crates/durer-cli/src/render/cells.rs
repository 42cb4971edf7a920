//! The cells of a picture: one, or one for each viewport.

use super::RenderArgs;
use crate::camera::Shot;
use crate::failure::Failure;
use crate::values::Size;
use durer::target::Framebuffer;
use durer::view::layout::Layout;

/// A part of the picture and its view.
pub struct Cell {
    x: u32,
    y: u32,
    pub shot: Shot,
}

/// Returns the cells of a picture: one, or one for each viewport.
pub fn shots(args: &RenderArgs, frame: Option<u32>) -> Result<Vec<Cell>, Failure> {
    let size = args.picture.size;
    let Some(layout) = &args.picture.viewports else {
        return Ok(vec![Cell { x: 0, y: 0, shot: Shot::of(&args.picture, frame) }]);
    };
    viewports(layout, size).map_err(|e| Failure::Usage(format!("--viewports: {e}")))
}

fn viewports(layout: &Layout, size: Size) -> Result<Vec<Cell>, String> {
    let viewports = layout.viewports(size.width, size.height).map_err(|e| e.to_string())?;
    let cell = |(name, viewport): (&str, durer::view::window::Viewport)| {
        let view = name.parse().map_err(|e: durer::Error| e.to_string())?;
        let pixels = viewport.pixels();
        let size = Size { width: pixels.width(), height: pixels.height() };
        let (x, y) = (pixels.x0().unsigned_abs(), pixels.y0().unsigned_abs());
        Ok(Cell { x, y, shot: Shot { view: Some(view), size, turn: None } })
    };
    viewports.into_iter().map(cell).collect()
}

/// Puts the viewports into one picture.
pub fn assemble(
    mut cells: Vec<(Cell, Framebuffer)>,
    args: &RenderArgs,
) -> durer::Result<Framebuffer> {
    if let [(_, whole)] = &mut cells[..] {
        return Ok(std::mem::replace(whole, Framebuffer::new(0, 0)));
    }
    let (Size { width, height }, work) = (args.picture.size, &args.running.work);
    let mut all = Framebuffer::within(work, width, height)?;
    let any = |has: fn(&Framebuffer) -> bool| cells.iter().any(|(_, part)| has(part));
    let (depth, item) = (any(|p| p.depth.is_some()), any(|p| p.item.is_some()));
    all.add_planes(work, depth, item, any(|p| p.normal.is_some()))?;
    for (Cell { x, y, .. }, part) in &cells {
        all.color.paste(&part.color, *x, *y);
        paste(&mut all.depth, &part.depth, *x, *y);
        paste(&mut all.item, &part.item, *x, *y);
        paste(&mut all.normal, &part.normal, *x, *y);
    }
    Ok(all)
}

fn paste<T: Copy>(
    all: &mut Option<durer::target::Pixels<T>>,
    part: &Option<durer::target::Pixels<T>>,
    x: u32,
    y: u32,
) {
    if let (Some(all), Some(part)) = (all, part) {
        all.paste(part, x, y);
    }
}
