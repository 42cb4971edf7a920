//! Display lists: commands that are recorded once and replayed often, in each other too.

use super::lighting::MAX_LIGHTS;
use super::{Command, MAX_STACK, MaterialFace, Pipeline, bitmap, draw, pixels};
use crate::info::{Class, Info, Occluder};
use crate::math::DMat4;
use crate::raster::point::MAX_SIZE;
use crate::target::Framebuffer;
use crate::trace::{NoTrace, PseudocodeLine, Tracer};
use crate::{Error, Result};

/// The facts of display lists.
pub const INFO: Info = Info {
    name: "display-lists",
    title: "Display lists",
    authors: "J. D. Foley, A. van Dam; M. Segal, K. Akeley",
    year: 1982,
    source: "Fundamentals of Interactive Computer Graphics; The OpenGL Graphics System, 1992",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(commands), those of a list for each call",
    limits: "64 lists in each other, 32 matrices on the stack, 2^24 commands",
    pseudocode: &[
        "record(commands): keep them under a new number; nothing is executed, the state stays",
        "execute(commands): begin with the first",
        "while commands or calls are left:",
        "    at the end of a list: go on behind its call",
        "    take the next command:",
        "    call, as many lists in each other as the limit: error; what was drawn stays",
        "    call: keep the place behind it; begin the list with the state as it is",
        "    matrix: replace the model-view matrix, or multiply it from the right",
        "    push: put a copy of the matrix onto its stack; pop: take it back from there",
        "    colour, light, material, texture, test …: set it; it stays after the end of the list",
        "    draw, evaluate: vertices go through the matrix as it is now, then to the pixels",
    ],
};

/// The name of a display list.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ListId(usize);

impl ListId {
    /// Returns the number of the list in its collection, counted from 0.
    pub(crate) const fn number(self) -> usize {
        self.0
    }
}

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

    /// Keeps commands as [`Self::record`] does, and reports it.
    pub fn record_traced(&mut self, commands: Vec<Command>, t: &mut impl Tracer<Step>) -> ListId {
        let list = self.record(commands);
        t.step(|| {
            let commands = self.lists.last().cloned().unwrap_or_default();
            Step::Recorded { list, commands }
        });
        list
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
    pub(crate) fn commands(&self, list: ListId) -> Result<&[Command]> {
        let count = self.lists.len();
        self.lists.get(list.0).map(Vec::as_slice).ok_or_else(|| dangling(list, count))
    }
}

/// Step of recording or executing commands.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// Commands were kept as a list.
    Recorded {
        /// The new list.
        list: ListId,
        /// Its commands.
        commands: Vec<Command>,
    },
    /// A list was called.
    Called {
        /// The list.
        list: ListId,
        /// Number of lists in each other from now on.
        depth: usize,
    },
    /// A call went beyond [`MAX_NESTING`].
    Refused {
        /// The list.
        list: ListId,
        /// Number of lists in each other before the call.
        depth: usize,
    },
    /// A list came to its end.
    Returned {
        /// Number of lists in each other from now on.
        depth: usize,
    },
    /// A command other than a call was executed.
    Executed {
        /// The command.
        command: Box<Command>,
        /// Number of lists in each other; 0 for commands outside of lists.
        depth: usize,
        /// Model-view matrix after it.
        model_view: DMat4,
        /// Number of matrices on the stack after it.
        kept: usize,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Recorded { .. } => 1,
            Self::Returned { .. } => 4,
            Self::Refused { .. } => 6,
            Self::Called { .. } => 7,
            Self::Executed { command, .. } => match &**command {
                Command::LoadModelView(_) | Command::MultiplyModelView(_) => 8,
                Command::PushModelView | Command::PopModelView => 9,
                command if command.draws() => 11,
                _ => 10,
            },
        }
    }
}

/// Returns the commands that a list of steps executes: without calls, they draw and set the same.
pub fn replay(steps: &[Step]) -> Vec<Command> {
    let executed = |step: &Step| match step {
        Step::Executed { command, .. } => Some((**command).clone()),
        Step::Recorded { .. } | Step::Called { .. } => None,
        Step::Refused { .. } | Step::Returned { .. } => None,
    };
    steps.iter().filter_map(executed).collect()
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
    execute_traced(commands, lists, pipeline, target, &mut NoTrace)
}

/// Executes commands as [`execute`] does, and reports the steps.
///
/// # Errors
/// Those of [`execute`].
pub fn execute_traced(
    commands: &[Command],
    lists: &DisplayLists,
    pipeline: &mut Pipeline,
    target: &mut Framebuffer,
    t: &mut impl Tracer<Step>,
) -> Result<()> {
    let mut waiting = vec![commands.iter()];
    let mut done = 0;
    while let Some(latest) = waiting.last_mut() {
        let Some(command) = latest.next() else {
            waiting.pop();
            if let Some(depth) = waiting.len().checked_sub(1) {
                t.step(|| Step::Returned { depth });
            }
            continue;
        };
        done += 1;
        if done > MAX_COMMANDS {
            return Err(Error::Limit {
                what: "number of commands",
                value: done,
                limit: MAX_COMMANDS,
            });
        }
        let depth = waiting.len() - 1;
        let &Command::Call(list) = command else {
            one(command, pipeline, target)?;
            t.step(|| {
                let (model_view, kept) = (pipeline.model_view, pipeline.stack.len());
                Step::Executed { command: Box::new(command.clone()), depth, model_view, kept }
            });
            continue;
        };
        if depth >= MAX_NESTING {
            t.step(|| Step::Refused { list, depth });
            let (value, limit) = (waiting.len() as u64, MAX_NESTING as u64);
            return Err(Error::Limit {
                what: "depth of display lists in each other",
                value,
                limit,
            });
        }
        waiting.push(lists.commands(list)?.iter());
        t.step(|| Step::Called { list, depth: depth + 1 });
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
            return Err(Error::Limit { what: "number of matrices on the stack", value, limit });
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
        Command::PointSize(size) if !(*size > 0.0 && *size <= MAX_SIZE) => {
            return Err(Error::parameter("point size", size, "above 0, at most 256"));
        }
        Command::PointSize(size) => p.point_size = *size,
        Command::PointSmooth(smooth) => p.point_smooth = *smooth,
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
            light.as_ref().map_or(Ok(()), super::LightSource::check)?;
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
