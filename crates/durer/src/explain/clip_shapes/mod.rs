//! Lessons of clipping circles and text.

mod circle;
mod text;

use super::lesson::Lesson;

pub(super) const LESSONS: &[Lesson] =
    &[circle::LESSON, text::STRING, text::CHARACTER, text::OUTLINE];
