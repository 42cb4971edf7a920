//! Pictures that show all steps of a lesson's example.

use durer::explain::{self, Input, Language, Options};

/// A picture: the lesson, by which the file is named, and its example.
pub const SHEETS: &[(&str, &str)] = &[
    ("cohen-sutherland", "all-borders"),
    ("midpoint", "both-ends"),
    ("cyrus-beck", "pentagon"),
    ("nicholl-lee-nicholl", "from-corner"),
    ("sutherland-hodgman", "triangle"),
    ("weiler-atherton", "lecture"),
];

/// Draws the picture.
pub fn sheet((lesson, example): (&str, &str)) -> durer::Result<String> {
    let input = Input::Example(example.to_owned());
    let frames = explain::run(lesson, &input, &Options::default(), 100)?;
    Ok(explain::sheet(&frames, 4, Language::English))
}
