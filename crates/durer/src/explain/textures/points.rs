//! The lesson of wrap modes, the nearest texel, and bilinear filtering.

use super::{BILINEAR, DIVIDED, NEAREST, OPAQUE, VALUE, WRAPPED};
use super::{bilinear, divided, grey, image, nearest, number, shade, texel, wrapped};
use crate::explain::frame::{Frames, Numbered, Shown, Want, record};
use crate::explain::grid::NO_HEAD;
use crate::explain::input::{Figure, Input};
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::{DAffine2, DVec2, Rect, Vec2};
use crate::scene::{MipFilter, Sampler, TextureFilter, Wrap};
use crate::shade::PreparedTexture;
use crate::shade::texture::{INFO, Step, Usage, weights};
use crate::trace::PseudocodeLine;
use crate::{Error, Result};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        Example {
            name: "beyond",
            title: Word::new(
                "a point beyond the right border",
                "ein Punkt jenseits des rechten Randes",
            ),
            input: || points(&[(1.3125, 0.5)]),
        },
        Example {
            name: "seam",
            title: Word::new("points beside the seam", "Punkte neben der Naht"),
            input: || points(&[(-0.0625, 0.25), (1.0625, 0.75)]),
        },
        Example {
            name: "center",
            title: Word::new(
                "the centre of a texel: both filters agree",
                "die Mitte eines Texels: beide Filter stimmen überein",
            ),
            input: || points(&[(0.625, 0.375)]),
        },
        Example::new(
            "two-widths",
            "two widths away: where the mirrored image is upright again",
            "zwei Breiten entfernt: wo das gespiegelte Bild wieder aufrecht ist",
            || points(&[(2.3125, -1.5)]),
        ),
        Example::new(
            "corner",
            "beyond a corner: each coordinate by itself",
            "jenseits einer Ecke: jede Koordinate für sich",
            || points(&[(-0.1875, 1.3125)]),
        ),
        Example::new(
            "border",
            "on the border between two texels",
            "auf der Grenze zweier Texel",
            || points(&[(0.5, 0.25)]),
        ),
    ],
    templates: &[&LEVEL, &WRAPPED, &NEAREST, &BILINEAR, &BETWEEN, &DIVIDED],
    unreached: &[("between", "its samplers have no levels"), OPAQUE],
    make: |_, input, _, cap| make(input, cap),
};

const TAKES: Word = Word::new(
    "points (u, v): (0, 0) is the upper left corner of the texture, (1, 1) the lower right one",
    "Punkte (u; v): (0; 0) ist die linke obere Ecke der Textur, (1; 1) die rechte untere",
);

fn points(all: &[(f64, f64)]) -> Input {
    let points = all.iter().copied().map(DVec2::from).collect();
    Input::Figure(Figure { points, ..Figure::default() })
}

static LEVEL: Template = Template::new(
    "detail",
    "{filter}, {mode}: a pixel is smaller than a texel here, so the image itself is sampled, level {level}.",
    "{filter}, {mode}: Ein Pixel ist hier kleiner als ein Texel, also wird das Bild selbst abgetastet, Stufe {level}.",
);
static BETWEEN: Template = Template::new(
    "between",
    "Both levels together, the second with the weight {weight}: {value}.",
    "Beide Stufen zusammen, die zweite mit dem Gewicht {weight}: {value}.",
);

/// Greys of the texture, in fifths of white.
const FIFTHS: [[u8; 4]; 4] = [[0, 1, 2, 3], [4, 5, 4, 3], [1, 0, 5, 2], [3, 2, 1, 0]];

/// Columns and rows of the texture.
const SIDE: i32 = 4;

/// The samplers, in the order of their runs.
const SAMPLERS: [(TextureFilter, Wrap); 6] = [
    (TextureFilter::Nearest, Wrap::Repeat),
    (TextureFilter::Nearest, Wrap::MirroredRepeat),
    (TextureFilter::Nearest, Wrap::ClampToEdge),
    (TextureFilter::Linear, Wrap::Repeat),
    (TextureFilter::Linear, Wrap::MirroredRepeat),
    (TextureFilter::Linear, Wrap::ClampToEdge),
];

const fn filter_name(filter: TextureFilter) -> Word {
    match filter {
        TextureFilter::Nearest => Word::new("Nearest texel", "Nächstes Texel"),
        TextureFilter::Linear => Word::new("Bilinear", "Bilinear"),
    }
}

const fn mode_name(wrap: Wrap) -> Word {
    match wrap {
        Wrap::Repeat => Word::new("repeat", "wiederholen"),
        Wrap::MirroredRepeat => Word::new("mirrored repeat", "gespiegelt wiederholen"),
        Wrap::ClampToEdge => Word::new("clamp to edge", "am Rand festhalten"),
    }
}

/// The points, and the samples so far.
#[derive(Clone)]
struct State {
    points: Vec<DVec2>,
    /// Point and sampler of each value.
    values: Vec<(usize, usize, f64)>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let points = input.figure(TAKES)?.points.clone();
    if points.is_empty() {
        return Err(Error::parameter("input", "without a point", TAKES.en));
    }
    let image = image(&FIFTHS.map(|row| row.map(|fifths| fifths * 51)));
    let textures = SAMPLERS.map(|(filter, wrap)| {
        let (mag, min, mip) = (filter, filter, MipFilter::None);
        PreparedTexture::new(
            &image,
            Sampler { mag, min, mip, wrap_u: wrap, wrap_v: wrap },
            Usage::Data,
        )
    });
    let steps = record(cap, |t| {
        for (k, point) in points.iter().enumerate() {
            for (s, texture) in textures.iter().enumerate() {
                let t = &mut Numbered { number: k * SAMPLERS.len() + s, t };
                texture.sample_traced(point.as_vec2(), Vec2::ZERO, Vec2::ZERO, t);
            }
        }
        Ok(())
    })?;
    let mut state = State { points, values: Vec::new() };
    Ok(Frames::new(steps, move |(run, step), want| state.show(*run, step, want)))
}

impl State {
    fn show(&mut self, run: usize, step: &Step, want: Want) -> Shown {
        let (point, sampler) = (run / SAMPLERS.len(), run % SAMPLERS.len());
        let caption = self.take(point, sampler, step);
        want.shown(
            step.line(),
            caption,
            || self.table(point, step),
            || self.picture(point, sampler, step),
        )
    }

    fn take(&mut self, point: usize, sampler: usize, step: &Step) -> Caption {
        let (filter, wrap) = SAMPLERS[sampler];
        let mode = ("mode", mode_name(wrap).into());
        match *step {
            Step::Detail { level, .. } => {
                LEVEL.with([("filter", filter_name(filter).into()), mode, ("level", level.into())])
            }
            Step::Wrapped { level, size, from, to } => {
                wrapped(mode_name(wrap), level, size, [from, to])
            }
            Step::Nearest { texel, value, .. } => {
                self.values.push((point, sampler, grey(value)));
                nearest(texel, value)
            }
            Step::Bilinear { fractions, values, value, .. } => {
                self.values.push((point, sampler, grey(value)));
                bilinear(fractions, values, value)
            }
            Step::Between { weight, value } => {
                BETWEEN.with([("weight", number(weight)), ("value", number(value.x))])
            }
            Step::Divided(value) => divided(value),
        }
    }

    /// Returns the texels with their weights, and the samples of the point so far.
    fn table(&self, point: usize, step: &Step) -> Table {
        let mut table = Table::new([NO_HEAD, Word::new("weight", "Gewicht"), VALUE]);
        if let Step::Bilinear { texels, fractions, values, .. } = *step {
            for ((at, weight), value) in texels.into_iter().zip(weights(fractions)).zip(values) {
                table.row(texel(at), [number(weight), number(value.x)]);
            }
        }
        for &(_, sampler, value) in self.values.iter().filter(|(k, ..)| *k == point) {
            let (filter, wrap) = SAMPLERS[sampler];
            let names = [filter_name(filter), mode_name(wrap)];
            table.row(Value::from(names.to_vec()), ["".into(), value.into()]);
        }
        table
    }

    /// Draws the texture as it is repeated around itself, with the point, and its place in the texture.
    fn picture(&self, point: usize, sampler: usize, step: &Step) -> Picture {
        let side = f64::from(SIDE);
        let (filter, wrap) = SAMPLERS[sampler];
        let extent = [DVec2::splat(-side - 0.2), DVec2::splat(2.0 * side + 0.2)];
        let mut picture = Picture { down: true, ..Picture::new(extent) };
        picture.picture_from_input = Some(DAffine2::from_scale(DVec2::splat(side)));
        for y in -SIDE..2 * SIDE {
            for x in -SIDE..2 * SIDE {
                let value = f64::from(FIFTHS[source(y, wrap)][source(x, wrap)]) / 5.0;
                let own = (0..SIDE).contains(&x) && (0..SIDE).contains(&y);
                let text = if own { Value::from(value) } else { "".into() };
                picture.colored([x, y], shade(value), text);
            }
        }
        if let Ok(border) = Rect::new(DVec2::ZERO, DVec2::splat(side)) {
            picture.frame(&border, Look::Window);
        }
        match *step {
            Step::Nearest { texel, .. } => add_texel(&mut picture, texel),
            Step::Bilinear { texels, .. } => {
                texels.into_iter().for_each(|texel| add_texel(&mut picture, texel));
            }
            Step::Detail { .. }
            | Step::Wrapped { .. }
            | Step::Between { .. }
            | Step::Divided(_) => {}
        }
        let Some(uv) = self.points.get(point) else { return picture };
        let seen = |p: DVec2| p.clamp(DVec2::splat(-side), DVec2::splat(2.0 * side));
        let at = seen(*uv * side);
        if let Step::Wrapped { to, .. } = *step {
            let to = to.as_dvec2() * side;
            if to != at {
                picture.arrow(at, to, Look::Second);
            }
        }
        let look = if filter == TextureFilter::Nearest { Look::First } else { Look::Second };
        picture.dot(at, look);
        picture
    }
}

/// Returns the column or row of the texture that is seen at a column or row around it.
fn source(i: i32, wrap: Wrap) -> usize {
    let folded = match wrap {
        Wrap::Repeat => i.rem_euclid(SIDE),
        Wrap::MirroredRepeat => {
            let twice = i.rem_euclid(2 * SIDE);
            twice.min(2 * SIDE - 1 - twice)
        }
        Wrap::ClampToEdge => i.clamp(0, SIDE - 1),
    };
    folded as usize
}

fn add_texel(picture: &mut Picture, texel: [u32; 2]) {
    let low = DVec2::from(texel.map(f64::from));
    if let Ok(cell) = Rect::new(low, low + 1.0) {
        picture.frame(&cell, Look::Now);
    }
}
