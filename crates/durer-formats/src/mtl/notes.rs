//! Warnings about materials, one for each kind.

use crate::{Model, Place};

/// Materials that need a warning.
#[derive(Debug, Default)]
pub(super) struct Named {
    count: usize,
    first: String,
}

impl Named {
    /// Adds one more.
    pub fn add(&mut self, name: &str) {
        if self.count == 0 {
            self.first = name.to_owned();
        }
        self.count += 1;
    }
}

/// Observations from building materials.
#[derive(Debug, Default)]
pub(super) struct Notes {
    /// True if `Tr` is the opacity.
    pub tr_is_opacity: bool,
    pub opacity: Named,
    pub invisible: Named,
    pub byte_colors: Named,
    pub bump: Named,
}

impl Notes {
    /// Adds warnings about all faults found.
    pub fn warn(&self, model: &mut Model) {
        for (named, message) in [
            (
                &self.opacity,
                "`Tr` without `d` is taken as opacity (1 is opaque), because the model would be invisible otherwise",
            ),
            (&self.invisible, "wholly transparent (`d 0`): nothing of it is seen"),
            (&self.byte_colors, "colors go up to 255 instead of 1; they were scaled"),
            (&self.bump, "bump maps are not supported; left out (normal maps are read)"),
        ] {
            let (count, first) = (named.count, &named.first);
            match count {
                0 => {}
                1 => model.warn(Place::Whole, format!("material `{first}`: {message}")),
                _ => {
                    let place = format!("{count} materials, the first `{first}`: {message}");
                    model.warn(Place::Whole, place);
                }
            }
        }
    }
}
