//! The commands recorded by a canvas, in order.

use super::color::{Space, premultiply};
use super::outline::{Drawn, Lists, Outline};
use super::source::{self, Source};
use super::{BlendFunction, Color, MaskKind, Paint};
use crate::math::DAffine2;
use crate::raster::coverage::{self, convex::Strip};

/// A thin straight line of one colour.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    pub strip: Strip,
    pub color: Color,
    /// Opacity, 0 … 1.
    pub opacity: f32,
}

/// The bit that distinguishes the number of a line from that of a command.
const LINE: u32 = 1 << 31;

/// Something to do in a band.
#[derive(Debug, Clone, Copy)]
pub(super) struct Item(u32);

impl Item {
    /// Returns the number of a line, if it is one.
    #[inline(always)]
    pub fn line(self) -> Option<usize> {
        (self.0 & LINE != 0).then_some((self.0 & !LINE) as usize)
    }

    /// Returns the number of the command, if it is none.
    pub fn command(self) -> usize {
        self.0 as usize
    }
}

/// Kind of an open group or clip.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Open {
    /// A clip path, or a mask that is finished.
    Clip,
    /// A clip path that holds the whole picture, for which there is no command.
    Everything,
    Group,
    /// A mask that is still painted.
    Mask,
}

impl Open {
    /// Returns the commands that close everything at the end.
    pub fn closing<'a, P>(&self) -> impl Iterator<Item = Prepared<'a, P>> + use<'a, P> {
        let (first, second) = match self {
            Self::Clip => (Some(Prepared::PopClip), None),
            Self::Everything => (None, None),
            Self::Group => {
                (Some(Prepared::PopGroup { opacity: 255, blend: BlendFunction::Normal }), None)
            }
            Self::Mask => {
                (Some(Prepared::EndMask { kind: MaskKind::Alpha }), Some(Prepared::PopClip))
            }
        };
        first.into_iter().chain(second)
    }
}

/// Paint of an outline; mostly small.
#[derive(Debug)]
pub(super) enum Brush {
    /// One colour and its opacity 0 … 1.
    Color(Color, f32),
    /// Any paint, the map from its path's space to pixels, and its opacity.
    Any(Box<(Paint, DAffine2, f64)>),
}

impl Brush {
    pub fn new(paint: &Paint, pixel_from_path: DAffine2, opacity: f64) -> Self {
        match paint {
            Paint::Color(color) => Self::Color(*color, source::opacity(opacity) as f32),
            _ => Self::Any(Box::new((paint.clone(), pixel_from_path, opacity))),
        }
    }

    fn source<P: Space>(&self) -> Source<P> {
        match self {
            Self::Color(color, opacity) => Source::Solid(premultiply(*color, *opacity)),
            Self::Any(any) => Source::new(&any.0, any.1, any.2),
        }
    }
}

/// A painting command.
#[derive(Debug)]
pub(super) enum Command {
    Fill {
        outline: Outline,
        how: coverage::Options,
        brush: Brush,
    },
    /// Lines of the canvas, from the first to before the last.
    Lines {
        first: u32,
        last: u32,
    },
    PushClip {
        outline: Outline,
        how: coverage::Options,
    },
    PopClip,
    PushGroup,
    PopGroup {
        opacity: f64,
        blend: BlendFunction,
    },
    BeginMask,
    EndMask {
        kind: MaskKind,
    },
}

impl Command {
    pub fn prepared<'a, P: Space>(&'a self, lists: &'a Lists) -> Prepared<'a, P> {
        match self {
            Self::Fill { outline, how, brush } => {
                let outline = outline.with(lists);
                Prepared::Fill { outline, how: *how, source: brush.source() }
            }
            Self::Lines { first, last } => Prepared::Lines { first: *first, last: *last },
            Self::PushClip { outline, how } => {
                Prepared::PushClip { outline: outline.with(lists), how: *how }
            }
            Self::PopClip => Prepared::PopClip,
            Self::PushGroup => Prepared::PushGroup,
            Self::PopGroup { opacity, blend } => {
                let opacity = (opacity.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
                Prepared::PopGroup { opacity, blend: *blend }
            }
            Self::BeginMask => Prepared::BeginMask,
            Self::EndMask { kind } => Prepared::EndMask { kind: *kind },
        }
    }
}

/// A command with its paint prepared for one colour space.
pub(super) enum Prepared<'a, P> {
    Fill { outline: Drawn<'a>, how: coverage::Options, source: Source<P> },
    Lines { first: u32, last: u32 },
    PushClip { outline: Drawn<'a>, how: coverage::Options },
    PopClip,
    PushGroup,
    PopGroup { opacity: u8, blend: BlendFunction },
    BeginMask,
    EndMask { kind: MaskKind },
}

/// Sorts the commands and lines into bands of `band_rows` rows: fills and lines into the bands of their rows,
/// everything else into all bands that have something between its begin and its end.
pub(super) fn sort_into_bands<P>(
    commands: &[Prepared<'_, P>],
    lines: &[Line],
    height: u32,
    band_rows: i32,
) -> Vec<Vec<Item>> {
    let count = height.div_ceil(band_rows.unsigned_abs().max(1)) as usize;
    let mut bands = vec![Band::default(); count];
    let put = |bands: &mut [Band], rows: (i32, i32), item| {
        let last = ((rows.1 - 1) / band_rows) as usize + 1;
        let range = (rows.0 / band_rows) as usize..last.min(count);
        let concerned = bands.get_mut(range).into_iter().flatten();
        concerned.for_each(|band| band.items.push(item));
    };
    for (i, command) in commands.iter().enumerate() {
        let i = Item(i as u32);
        match command {
            Prepared::Fill { outline, .. } => put(&mut bands, outline.rows(), i),
            Prepared::Lines { first, last } => {
                let lines = lines.get(*first as usize..*last as usize).unwrap_or_default();
                for (i, line) in (*first..).zip(lines) {
                    put(&mut bands, line.strip.rows(), Item(i | LINE));
                }
            }
            Prepared::PushClip { .. } | Prepared::PushGroup | Prepared::BeginMask => {
                bands.iter_mut().for_each(|band| band.begin(i));
            }
            Prepared::EndMask { .. } => bands.iter_mut().for_each(|band| band.end_mask(i)),
            Prepared::PopClip | Prepared::PopGroup { .. } => {
                bands.iter_mut().for_each(|band| band.end(i));
            }
        }
    }
    bands.into_iter().map(|band| band.items).collect()
}

/// The commands of one band.
#[derive(Debug, Clone, Default)]
struct Band {
    items: Vec<Item>,
    /// Start of each open command, and start of its contents.
    open: Vec<(usize, usize)>,
}

impl Band {
    fn begin(&mut self, command: Item) {
        let start = self.items.len();
        self.items.push(command);
        self.open.push((start, start + 1));
    }

    fn end_mask(&mut self, command: Item) {
        self.items.push(command);
        if let Some(open) = self.open.last_mut() {
            open.1 = self.items.len();
        }
    }

    /// Ends the clip path, mask or group opened last; one that encloses nothing is dropped.
    fn end(&mut self, command: Item) {
        match self.open.pop() {
            Some((start, inside)) if inside == self.items.len() => self.items.truncate(start),
            _ => self.items.push(command),
        }
    }
}
