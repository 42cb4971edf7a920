//! What a canvas has noted, in order.

use super::color::Space;
use super::outline::Outline;
use super::source::Source;
use super::{FillRule, MaskKind, Paint};
use crate::math::DAffine2;

/// What can be open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Open {
    /// A clip path, or a mask that is finished.
    Clip,
    Group,
    /// A mask that is still painted.
    Mask,
}

impl Open {
    /// What closes it at the end of all commands.
    pub fn closing<'a, P>(&self) -> impl Iterator<Item = Prepared<'a, P>> + use<'a, P> {
        let (first, second) = match self {
            Self::Clip => (Prepared::PopClip, None),
            Self::Group => (Prepared::PopGroup { opacity: 255 }, None),
            Self::Mask => (Prepared::EndMask { kind: MaskKind::Alpha }, Some(Prepared::PopClip)),
        };
        std::iter::once(first).chain(second)
    }
}

/// One thing to do.
#[derive(Debug)]
pub(super) enum Command {
    Fill { outline: Outline, rule: FillRule, paint: Paint, opacity: f64, transform: DAffine2 },
    PushClip { outline: Outline, rule: FillRule },
    PopClip,
    PushGroup,
    PopGroup { opacity: f64 },
    BeginMask,
    EndMask { kind: MaskKind },
}

impl Command {
    pub fn prepared<P: Space>(&self) -> Prepared<'_, P> {
        match self {
            Self::Fill { outline, rule, paint, opacity, transform } => Prepared::Fill {
                outline,
                rule: *rule,
                source: Source::new(paint, *transform, *opacity),
            },
            Self::PushClip { outline, rule } => Prepared::PushClip { outline, rule: *rule },
            Self::PopClip => Prepared::PopClip,
            Self::PushGroup => Prepared::PushGroup,
            Self::PopGroup { opacity } => {
                Prepared::PopGroup { opacity: (opacity.clamp(0.0, 1.0) * 255.0 + 0.5) as u8 }
            }
            Self::BeginMask => Prepared::BeginMask,
            Self::EndMask { kind } => Prepared::EndMask { kind: *kind },
        }
    }
}

/// A command with its paint made ready for one colour space.
pub(super) enum Prepared<'a, P> {
    Fill { outline: &'a Outline, rule: FillRule, source: Source<P> },
    PushClip { outline: &'a Outline, rule: FillRule },
    PopClip,
    PushGroup,
    PopGroup { opacity: u8 },
    BeginMask,
    EndMask { kind: MaskKind },
}

/// For each band of `band_rows` rows the indices of the commands that concern it: fills of their rows,
/// everything else in all bands where there is something between its begin and its end.
pub(super) fn sort_into_bands<P>(
    commands: &[Prepared<'_, P>],
    height: u32,
    band_rows: i32,
) -> Vec<Vec<u32>> {
    let count = height.div_ceil(band_rows.unsigned_abs().max(1)) as usize;
    let mut bands = vec![Band::default(); count];
    for (i, command) in commands.iter().enumerate() {
        let i = i as u32;
        match command {
            Prepared::Fill { outline, .. } => {
                let rows = outline.rows();
                let last = ((rows.1 - 1) / band_rows) as usize + 1;
                let range = (rows.0 / band_rows) as usize..last.min(count);
                let concerned = bands.get_mut(range).into_iter().flatten();
                concerned.for_each(|band| band.commands.push(i));
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
    bands.into_iter().map(|band| band.commands).collect()
}

/// The commands of one band.
#[derive(Debug, Clone, Default)]
struct Band {
    commands: Vec<u32>,
    /// For all that is open: where it begins, and where what it encloses does.
    open: Vec<(usize, usize)>,
}

impl Band {
    fn begin(&mut self, command: u32) {
        let start = self.commands.len();
        self.commands.push(command);
        self.open.push((start, start + 1));
    }

    fn end_mask(&mut self, command: u32) {
        self.commands.push(command);
        if let Some(open) = self.open.last_mut() {
            open.1 = self.commands.len();
        }
    }

    /// What encloses nothing is dropped.
    fn end(&mut self, command: u32) {
        match self.open.pop() {
            Some((start, inside)) if inside == self.commands.len() => self.commands.truncate(start),
            _ => self.commands.push(command),
        }
    }
}
