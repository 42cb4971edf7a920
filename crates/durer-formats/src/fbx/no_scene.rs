//! A replacement for FBX without the feature `fbx`.

use crate::{Error, Model, Place, ReadOptions, Resources, Result};

/// Reads nothing.
///
/// # Errors
/// Always: [`Error::Unsupported`].
pub fn read(_: &[u8], _: &dyn Resources, _: &ReadOptions) -> Result<Model> {
    Err(Error::Unsupported {
        place: Place::Whole,
        what: "FBX, the format of Autodesk's programs, in this build".to_owned(),
        hint: "one with `--features fbx` reads it, or convert the model to glTF".to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{NoResources, read_model};

    #[test]
    fn what_it_is_and_what_reads_it() {
        for text in
            ["Kaydara FBX Binary  \0\x1a\0", "; FBX 7.3.0 project file\n", " FBXHeaderExtension: {"]
        {
            let read = read_model(text.as_bytes(), "x", &NoResources, &ReadOptions::default());
            let message = read.expect_err("not in this build").to_string();
            assert!(message.starts_with("FBX, the format of"), "{message}");
            assert!(message.contains("--features fbx"), "{message}");
        }
    }
}
