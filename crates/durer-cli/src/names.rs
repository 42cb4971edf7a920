//! Patterns for the names of outputs. A name follows from its own input alone, never from the others of the run, so
//! that inputs may be added or divided among machines and no name changes.

use crate::places::is_stream;
use std::path::{Component, Path};

/// Explanation of the placeholders, for messages.
pub const PLACEHOLDERS: &str =
    "{stem} (the input's name without its suffix), {name} (with it) and {folder} (its folder)";

/// Returns whether a path has a placeholder for a part of the input's path.
pub fn is_pattern(path: &Path) -> bool {
    let text = path.to_string_lossy();
    ["{stem}", "{name}", "{folder}"].iter().any(|known| text.contains(known))
}

/// Returns the path with the placeholders replaced by parts of the input's path. The folder has neither a root nor
/// `..`, so that the result stays below the pattern's part before it.
pub fn expand(pattern: &str, input: &Path) -> String {
    let lossy =
        |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    let mut folder = match input.parent() {
        Some(parent) if !is_stream(input) => plain(parent),
        _ => String::new(),
    };
    if !folder.is_empty() {
        folder.push('/');
    }
    let name = if is_stream(input) { "stdin".to_owned() } else { lossy(input.file_name()) };
    // One after the other, so that braces in a name are not placeholders.
    let (mut result, mut rest) = (String::new(), pattern);
    while let Some(at) = rest.find('{') {
        result.push_str(&rest[..at]);
        rest = &rest[at..];
        let known =
            [("{stem}", stem(input)), ("{name}", name.clone()), ("{folder}/", folder.clone())];
        let folder = ("{folder}", folder.trim_end_matches('/').to_owned());
        let found = known.into_iter().chain([folder]).find(|(known, _)| rest.starts_with(known));
        let (known, value) = found.unwrap_or(("{", "{".to_owned()));
        result.push_str(&value);
        rest = &rest[known.len()..];
    }
    result + rest
}

/// Returns the name of an input without folder and suffix.
pub fn stem(input: &Path) -> String {
    if is_stream(input) {
        return "stdin".to_owned();
    }
    input.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// Returns the folders of a path, without its root, `.` and `..`.
fn plain(folder: &Path) -> String {
    let parts = folder.components().filter_map(|part| match part {
        Component::Normal(name) => Some(name.to_string_lossy()),
        _ => None,
    });
    parts.collect::<Vec<_>>().join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_made_of_parts_of_the_input() {
        for (pattern, input, name) in [
            ("out/{stem}.png", "x/a.b.obj", "out/a.b.png"),
            ("out/{folder}/{name}.png", "x/y/a.obj", "out/x/y/a.obj.png"),
            ("out/{folder}/{stem}.png", "a.obj", "out/a.png"),
            ("out/{folder}/{stem}.png", "/srv/../x/a.obj", "out/srv/x/a.png"),
            ("{folder}-{stem}.png", "../a.obj", "-a.png"),
            ("{stem}.png", "-", "stdin.png"),
            ("{other}{stem}{", "{name}.obj", "{other}{name}{"),
        ] {
            assert_eq!(expand(pattern, Path::new(input)), name, "{pattern}");
        }
        assert!(is_pattern(Path::new("a/{folder}/b")) && !is_pattern(Path::new("{1}.png")));
    }
}
