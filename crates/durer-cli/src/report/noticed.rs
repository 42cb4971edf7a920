//! Observations about a model from its pictures.

use super::PictureReport;
use crate::encoding::FLATTENED;
use crate::messages::Messages;
use durer_formats::wording::agreeing;
use durer_formats::{Model, Place};

/// The notes on all pictures of a model.
#[derive(Debug, Default)]
pub struct Noticed {
    /// Reason why nothing of the model is visible in the first picture, if nothing is; already reported.
    pub unseen: Option<String>,
    /// Triangles of a picture with a vertex that is not a number, which the renderer finds, not the reader.
    non_finite: u64,
    /// The notes on sheets.
    notes: Vec<String>,
    /// Warning about how faces meet.
    loose_faces: Option<String>,
    /// The scale of the drawing on its paper.
    scale: Option<String>,
    /// True if transparent colours had to become opaque.
    flattened: bool,
}

impl Noticed {
    /// Adds the notes of a picture.
    pub fn add(&mut self, picture: &PictureReport) {
        self.non_finite = self.non_finite.max(picture.triangles.non_finite);
        for note in &picture.notes {
            // Frames of a film have the same.
            if !self.notes.contains(note) {
                self.notes.push(note.clone());
            }
        }
        if let Some(drawing) = &picture.drawing {
            self.loose_faces = self.loose_faces.take().or_else(|| drawing.loose_faces());
            self.scale = self.scale.take().or_else(|| drawing.scale_warning.clone());
        }
        self.flattened |= picture.flattened;
    }

    /// Adds warnings to the model, and prints them.
    pub fn warn(self, name: &str, model: &mut Model, messages: &Messages) {
        let words = "{triangle|triangles} with a coordinate that is not finite {is|are} left out";
        let non_finite = (self.non_finite > 0).then(|| agreeing(self.non_finite, words));
        let flattened = format!("{FLATTENED}; --background gives it another colour");
        warn(name, model, messages, non_finite);
        if let Some(why) = self.unseen {
            model.warn(Place::Whole, why);
        }
        warn(name, model, messages, self.notes);
        warn(name, model, messages, self.loose_faces.into_iter().chain(self.scale));
        warn(name, model, messages, self.flattened.then_some(flattened));
    }
}

fn warn(
    name: &str,
    model: &mut Model,
    messages: &Messages,
    texts: impl IntoIterator<Item = String>,
) {
    let known = model.warnings.len();
    texts.into_iter().for_each(|text| model.warn(Place::Whole, text));
    messages.warnings(name, &model.warnings[known..]);
}
