//! Models that are read in pieces, because they would not fit the budget.

use super::{Reading, display_name, is_stream, refused, warn_of_ignored};
use crate::failure::Failure;
use crate::watch;
use durer_formats::{Facts, Pieces, ReadOptions, ply, stl};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Bytes for a triangle, a vertex or a point while its piece is processed.
const IN_PIECE: u64 = 160;

/// The part of the budget that a piece may take.
const SHARE: u64 = 8;

/// The most triangles or points of a piece: more make nothing faster.
const MOST_AT_ONCE: u64 = 1 << 18;

/// Largest memory for a whole model as a factor of its file's size, if that is more than [`FEW`] bytes: a picture of
/// points takes far more than the points themselves.
const BY_FILE: u64 = 6;
const FEW: u64 = 512 << 20;

/// A model that is read in pieces, with its known data.
pub struct InPieces {
    /// The file.
    pub pieces: Box<dyn Pieces>,
    name: String,
    options: ReadOptions,
}

impl InPieces {
    /// Returns a failure of the file.
    pub fn failure(&self, e: &durer_formats::Error) -> Failure {
        refused(&self.name, e, &self.options.limits)
    }

    /// Returns the facts about the model as a whole.
    pub fn facts(&mut self) -> Result<Facts, Failure> {
        let facts = self.pieces.facts();
        let mut facts = facts.map_err(|e| self.failure(&e))?;
        warn_of_ignored(&mut facts.model, &self.options);
        Ok(facts)
    }
}

/// Opens a model that would not fit the budget, or would take far more memory than its file, if its format can be read
/// in pieces; `None` for other models.
pub fn in_pieces(path: &Path, reading: &Reading) -> Option<Result<InPieces, Failure>> {
    let length = std::fs::metadata(path).ok().filter(std::fs::Metadata::is_file)?.len();
    let [most_triangles, most_bytes] = reading.given;
    if is_stream(path) || most_bytes.is_some_and(|most| length > most) {
        return None;
    }
    let mut options = reading.options.clone();
    let work = &options.limits.work;
    let left = work.budget().saturating_sub(work.used());
    let at_once = (left / SHARE / IN_PIECE).min(MOST_AT_ONCE) as usize;
    // The default is there to bound memory.
    options.limits.primitives = most_triangles.unwrap_or(u64::MAX);
    watch::of_file(display_name(path));
    let name = display_name(path);
    let pieces = match opened(File::open(path).ok()?, length, at_once, &options) {
        Ok(pieces) => pieces
            .filter(|pieces| pieces.whole() > left.min(FEW.max(length.saturating_mul(BY_FILE))))?,
        Err(e) => return Some(Err(refused(&name, &e, &options.limits))),
    };
    Some(Ok(InPieces { pieces, name, options }))
}

/// Returns the pieces of a file of this many bytes; `None` if its format has none.
fn opened(
    mut file: File,
    length: u64,
    at_once: usize,
    options: &ReadOptions,
) -> durer_formats::Result<Option<Box<dyn Pieces>>> {
    let mut head = [0; stl::HEADER];
    if file.read_exact(&mut head).is_err() {
        return Ok(None);
    }
    if stl::is_whole_binary(&head, length) {
        let pieces = stl::Pieces::new(&head, file, at_once, options)?;
        return Ok(Some(Box::new(pieces)));
    }
    let pieces = ply::Pieces::new(file, length, at_once, options)?;
    Ok(pieces.map(|pieces| Box::new(pieces) as Box<dyn Pieces>))
}
