//! Display lists: commands that are recorded once and replayed often, in each other too.

use super::lighting::MAX_LIGHTS;
use super::{Command, MAX_STACK, MaterialFace, Pipeline, bitmap, draw, pixels};
use crate::target::Framebuffer;
use crate::{Error, Result};

/// The name of a display list.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ListId(usize);

/// Lists call each other to this depth; OpenGL demands as much.
pub const MAX_NESTING: usize = 64;

/// Largest number of commands that one call of [`execute`] carries out: lists that each call another one twice would
/// otherwise never end.
pub const MAX_COMMANDS: u64 = 1 << 24;

/// Recorded commands.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DisplayLists {
    lists: Vec<Vec<Command>>,
}

impl DisplayLists {
    /// Keeps commands for later; lists that they call may be recorded or replaced afterwards.
    pub fn record(&mut self, commands: Vec<Command>) -> ListId {
        self.lists.push(commands);
        ListId(self.lists.len() - 1)
    }

    /// Replaces the commands of a list; later calls run the new ones.
    ///
    /// # Errors
    /// [`Error::Dangling`] for a list of another collection.
    pub fn replace(&mut self, list: ListId, commands: Vec<Command>) -> Result<()> {
        let count = self.lists.len();
        let old = self.lists.get_mut(list.0).ok_or_else(|| dangling(list, count))?;
        *old = commands;
        Ok(())
    }

    /// Returns the commands of a list.
    ///
    /// # Errors
    /// [`Error::Dangling`] for a list of another collection.
    pub fn commands(&self, list: ListId) -> Result<&[Command]> {
        let count = self.lists.len();
        self.lists.get(list.0).map(Vec::as_slice).ok_or_else(|| dangling(list, count))
    }
}

fn dangling(list: ListId, count: usize) -> Error {
    Error::Dangling { what: "display list", index: list.0, count }
}

/// Executes commands in their order. The results of commands before an error stay.
///
/// # Errors
/// [`Error::Dangling`] for a list that is not there; [`Error::Limit`] for lists nested deeper than [`MAX_NESTING`],
/// more commands than [`MAX_COMMANDS`], a matrix stack above [`MAX_STACK`]; [`Error::Parameter`] for taking back a
/// matrix that was not kept, a matrix, evaluator, light, material, zoom or bitmap that is not finite or out of its range, and a
/// viewport or rectangle beyond the framebuffer; [`Error::Unsupported`] for copying from a plane that the framebuffer
/// does not have.
pub fn execute(
    commands: &[Command],
    lists: &DisplayLists,
    pipeline: &mut Pipeline,
    target: &mut Framebuffer,
) -> Result<()> {
    let mut waiting = vec![commands.iter()];
    let mut done = 0;
    while let Some(latest) = waiting.last_mut() {
        let Some(command) = latest.next() else {
            waiting.pop();
            continue;
        };
        done += 1;
        if done > MAX_COMMANDS {
            return Err(Error::Limit { what: "commands", value: done, limit: MAX_COMMANDS });
        }
        if let Command::Call(list) = command {
            if waiting.len() > MAX_NESTING {
                let (value, limit) = (waiting.len() as u64, MAX_NESTING as u64);
                return Err(Error::Limit { what: "nesting of display lists", value, limit });
            }
            waiting.push(lists.commands(*list)?.iter());
        } else {
            one(command, pipeline, target)?;
        }
    }
    Ok(())
}

fn one(command: &Command, p: &mut Pipeline, target: &mut Framebuffer) -> Result<()> {
    match command {
        Command::Clear { color, depth, stencil, index } => {
            draw::clear(&p.fragments, *color, *depth, *stencil, *index, target);
        }
        Command::LoadModelView(matrix) => p.model_view = finite(*matrix)?,
        Command::MultiplyModelView(matrix) => p.model_view = finite(p.model_view * *matrix)?,
        Command::PushModelView if p.stack.len() >= MAX_STACK => {
            let (value, limit) = (p.stack.len() as u64 + 1, MAX_STACK as u64);
            return Err(Error::Limit { what: "matrices on the stack", value, limit });
        }
        Command::PushModelView => p.stack.push(p.model_view),
        Command::PopModelView => {
            let kept = p.stack.pop();
            p.model_view = kept
                .ok_or_else(|| Error::parameter("matrix stack", "empty", "pushed before popped"))?;
        }
        Command::LoadProjection(matrix) => p.projection = finite(*matrix)?,
        Command::Viewport(viewport) => {
            draw::check_viewport(*viewport, target)?;
            p.viewport = *viewport;
        }
        Command::Color(color) => p.color = *color,
        Command::Index(index) => p.index = *index,
        Command::Cull(cull) => p.cull = *cull,
        Command::DepthRange(range) => p.depth_range = *range,
        Command::PolygonOffset(offset) => p.polygon_offset = *offset,
        Command::Fragments(state) => p.fragments = *state,
        Command::Draw(primitive, vertices) => draw::draw(p, *primitive, vertices, target),
        Command::EvaluateCurve(curve, steps) => {
            let (primitive, vertices) = curve.vertices(*steps)?;
            draw::draw(p, primitive, &vertices, target);
        }
        Command::EvaluatePatch(patch, steps) => {
            let (primitive, vertices) = patch.vertices(*steps)?;
            draw::draw(p, primitive, &vertices, target);
        }
        Command::Texture(texture) => p.texture.clone_from(texture),
        Command::RasterPosition(vertex) => p.raster = draw::raster_position(p, vertex, target),
        Command::PixelZoom(zoom) if !zoom.is_finite() => {
            return Err(Error::parameter("pixel zoom", zoom, "finite"));
        }
        Command::PixelZoom(zoom) => p.pixel_zoom = *zoom,
        Command::DrawPixels(block) => pixels::draw(p, block, target),
        Command::Bitmap(bitmap) => bitmap::draw(p, bitmap, target)?,
        Command::CopyPixels(rectangle, plane) => {
            let block = pixels::read_pixels(target, *rectangle, *plane)?;
            pixels::draw(p, &block, target);
        }
        // Lists are opened by `execute`.
        Command::Call(_) => {}
        _ => light(command, p)?,
    }
    Ok(())
}

/// Carries out the commands that set normals, lights and materials.
fn light(command: &Command, p: &mut Pipeline) -> Result<()> {
    let lighting = &mut p.lighting;
    match command {
        Command::Normal(normal) => p.normal = *normal,
        Command::TexCoord(at) => p.tex_coord = *at,
        Command::Lighting(enabled) => lighting.enabled = *enabled,
        Command::Light(number, light) => {
            let place = lighting.lights.get_mut(*number).ok_or(Error::Dangling {
                what: "light",
                index: *number,
                count: MAX_LIGHTS,
            })?;
            light.as_ref().map_or(Ok(()), super::Light::check)?;
            *place = light.map(|light| light.transformed(&p.model_view));
        }
        Command::LightModel(model) if !model.ambient.is_finite() => {
            return Err(Error::parameter("ambient light", model.ambient, "finite"));
        }
        Command::LightModel(model) => lighting.model = *model,
        Command::Material(face, material) => {
            material.check()?;
            if *face != MaterialFace::Back {
                lighting.front = *material;
            }
            if *face != MaterialFace::Front {
                lighting.back = *material;
            }
        }
        Command::ColorMaterial(property) => lighting.color_material = *property,
        Command::Normalize(normalize) => lighting.normalize = *normalize,
        Command::ShadeModel(model) => lighting.shade_model = *model,
        _ => {}
    }
    Ok(())
}

fn finite(matrix: crate::math::DMat4) -> Result<crate::math::DMat4> {
    if matrix.is_finite() { Ok(matrix) } else { Err(Error::parameter("matrix", "given", "finite")) }
}
