//! The lines of a label.

use crate::curve::Path;
use crate::curve::text::{Font, TextLine};
use crate::math::{DAffine2, DVec2, Rect};

/// The em square's share that letters take between a label's top and bottom line.
pub const LETTERS: f64 = 0.73;

/// The halo reaches so far around letters, as a share of their size.
pub const HALO: f64 = 0.16;

/// Distance of the lines of a block, as a share of the letters' size.
const LEADING: f64 = 1.05;

/// One line or more, centred one below another. Its corner is the start of the first base line, if that line were as
/// long as the longest.
#[derive(Debug)]
pub struct Block {
    texts: Vec<String>,
    lines: Vec<TextLine>,
    width: f64,
    size: f64,
}

impl Block {
    /// Creates a block of lines of letters of a size, pixels.
    pub fn new(texts: Vec<String>, font: &Font<'_>, size: f64) -> Self {
        let lines: Vec<TextLine> = texts.iter().map(|text| font.line(text, size)).collect();
        let width = lines.iter().map(|line| line.advance).fold(1.0, f64::max);
        Self { texts, lines, width, size }
    }

    /// Drops the outlines of its letters, and keeps its place and size.
    pub fn forget_outlines(&mut self) {
        self.lines.iter_mut().for_each(|line| line.path = Path::new());
    }

    /// Returns the block with the outlines of its text.
    pub fn with_outlines(&self, font: &Font<'_>) -> Self {
        Self::new(self.texts.clone(), font, self.size)
    }

    /// Returns about how many bytes it takes.
    pub fn bytes(&self) -> u64 {
        let of = |line: &TextLine| {
            let path = size_of_val(line.path.elements());
            path + size_of_val(&line.glyphs[..]) + size_of::<TextLine>()
        };
        self.lines.iter().map(of).sum::<usize>() as u64
    }

    /// Sets a text in two lines, broken at the blank that makes it narrowest; `None` for a single word.
    pub fn stacked(text: &str, font: &Font<'_>, size: f64) -> Option<Self> {
        let halves = text.match_indices(' ').map(|(at, _)| [text[..at].trim(), text[at..].trim()]);
        let full = halves.filter(|halves| halves.iter().all(|half| !half.is_empty()));
        let blocks = full.map(|h| Self::new(h.map(str::to_owned).to_vec(), font, size));
        blocks.min_by(|a, b| a.width.total_cmp(&b.width))
    }

    /// Returns the only line, if there is just one.
    pub fn line(&self) -> Option<&TextLine> {
        self.lines.first().filter(|_| self.lines.len() == 1)
    }

    /// Returns the size of the block: from the left to the right and from the top of the first to the bottom of the
    /// last line's letters.
    pub fn extent(&self) -> DVec2 {
        let down = LEADING * self.lines.len().saturating_sub(1) as f64;
        DVec2::new(self.width, (LETTERS + down) * self.size)
    }

    /// Returns the corner of a block whose middle is given.
    pub fn corner(&self, middle: DVec2) -> DVec2 {
        middle + DVec2::new(-self.width * 0.5, LETTERS * self.size - self.extent().y * 0.5)
    }

    /// Returns each line with the start of its base line.
    fn placed(&self, corner: DVec2) -> impl Iterator<Item = (&TextLine, DVec2)> {
        self.lines.iter().enumerate().map(move |(i, line)| {
            let (aside, down) = ((self.width - line.advance) * 0.5, LEADING * self.size * i as f64);
            (line, corner + DVec2::new(aside, down))
        })
    }

    /// Returns its boxes at a corner, with halos.
    pub fn taken(&self, corner: DVec2) -> Vec<Rect> {
        let halo = HALO * self.size;
        let taken = |(line, start): (&TextLine, DVec2)| {
            let min = start - DVec2::new(halo, LETTERS * self.size + halo);
            let max = start + DVec2::new(line.advance + halo, line.descent + halo);
            Rect::new(min, max).ok()
        };
        self.placed(corner).filter_map(taken).collect()
    }

    /// Returns its outlines at a corner.
    pub fn outlines(&self, corner: DVec2) -> Path {
        let mut path = Path::new();
        for (line, start) in self.placed(corner) {
            path.extend(&line.path.transformed(DAffine2::from_translation(start)));
        }
        path
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_broken_where_they_get_narrowest() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../durer-cli/fonts/DejaVuSans.ttf");
        let Ok(bytes) = std::fs::read(path) else {
            eprintln!("skipped: {path} is missing");
            return;
        };
        let font = Font::new(&bytes, 0).expect("font");
        let whole = Block::new(vec!["United Arab Emirates".to_owned()], &font, 12.0);
        let stacked = Block::stacked("United Arab Emirates", &font, 12.0).expect("blanks");
        let halves = ["United Arab", "Emirates"].map(|half| font.line(half, 12.0).advance);
        assert_eq!(stacked.extent().x, halves[0].max(halves[1]));
        assert!(stacked.extent().y > 2.0 * whole.extent().y);
        // Both lines are centred on the middle of the block.
        let middle = DVec2::new(50.0, 40.0);
        let boxes = stacked.taken(stacked.corner(middle));
        for own in &boxes {
            assert!(((own.min().x + own.max().x) / 2.0 - middle.x).abs() < 1e-9);
        }
        assert!(boxes[0].max().y < 50.0 && boxes[1].min().y > 30.0 && boxes.len() == 2);
        assert!(Block::stacked("Emirates", &font, 12.0).is_none());
        assert!(Block::stacked(" Emirates ", &font, 12.0).is_none());
    }
}
