//! The round parts of a model by name: `hole 1`, `boss 2`, `fillet 3`, or the name of an object that has only one.

use crate::math::DVec3;
use crate::scene::Scene;
use crate::visibility::object::{Cylinder, Faces, cylinders};
use crate::{Error, Result};
use std::f64::consts::PI;

/// Parts that cover at least this angle have a centre to be drawn and a diameter: 170°.
const HALF: f64 = 170.0 / 180.0 * PI;

/// Number of names that an error lists.
const TOLD: usize = 12;

/// Kind of a round part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FeatureKind {
    /// The inside of a half cylinder or more.
    Hole,
    /// The outside of a half cylinder or more.
    Boss,
    /// Less than half a cylinder, from inside or outside.
    Fillet,
}

impl FeatureKind {
    /// Returns its name, as in the names of features.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Hole => "hole",
            Self::Boss => "boss",
            Self::Fillet => "fillet",
        }
    }

    /// Returns the kind of a cylinder.
    pub(crate) fn of(cylinder: &Cylinder) -> Self {
        match (cylinder.angle >= HALF, cylinder.hollow) {
            (false, _) => Self::Fillet,
            (true, true) => Self::Hole,
            (true, false) => Self::Boss,
        }
    }
}

/// A round part with its name.
#[derive(Debug, Clone, PartialEq)]
pub struct RoundFeature {
    /// `hole 1`, …: each kind is counted on its own, from 1, in the order of the file.
    pub name: String,
    /// The name of its object; may be empty.
    pub object: String,
    /// Kind of the feature.
    pub kind: FeatureKind,
    /// Surface of the feature.
    pub cylinder: Cylinder,
}

impl RoundFeature {
    /// Returns the middle of its axis.
    pub(crate) fn middle(&self) -> DVec3 {
        (self.cylinder.ends[0] + self.cylinder.ends[1]) * 0.5
    }
}

/// Finds the round parts of a scene by its faces, and names them. O(n).
pub fn features(scene: &Scene, faces: &Faces) -> Vec<RoundFeature> {
    let mut counts = [0usize; 3];
    let named = |cylinder: Cylinder| {
        let kind = FeatureKind::of(&cylinder);
        let count = &mut counts[kind as usize];
        *count += 1;
        let name = format!("{} {count}", kind.name());
        let object = object(scene, faces, cylinder.item).to_owned();
        RoundFeature { name, object, kind, cylinder }
    };
    cylinders(faces).into_iter().map(named).collect()
}

/// Returns the name of the object that a triangle belongs to: its group's name, else its instance's or its mesh's.
fn object<'a>(scene: &'a Scene, faces: &Faces, item: u32) -> &'a str {
    let Some(run) = faces.run_of(item) else { return "" };
    let mesh = &scene.meshes[run.mesh];
    let triangle = run.first + item - run.items.start;
    let part = mesh.parts.iter().find(|p| p.range.contains(&triangle));
    let names = [
        part.map_or("", |p| p.name.as_str()),
        scene.instances[run.instance].name.as_str(),
        mesh.name.as_str(),
    ];
    names.into_iter().find(|n| !n.is_empty()).unwrap_or("")
}

/// Returns the features of a name: one by its own, all of an object.
///
/// # Errors
/// [`Error::Parameter`], with some of the existing names.
pub(super) fn named<'a>(features: &'a [RoundFeature], name: &str) -> Result<Vec<&'a RoundFeature>> {
    let name = name.trim();
    let own = features.iter().filter(|f| f.name == name);
    let found: Vec<&RoundFeature> =
        own.chain(features.iter().filter(|f| f.object == name)).collect();
    if found.is_empty() {
        return Err(unknown(features, name));
    }
    Ok(found)
}

/// Returns the one feature of a name.
///
/// # Errors
/// [`Error::Parameter`] if there is none, or several.
pub(super) fn one<'a>(features: &'a [RoundFeature], name: &str) -> Result<&'a RoundFeature> {
    match named(features, name)?[..] {
        [only] => Ok(only),
        ref several => {
            let names: Vec<&str> = several.iter().take(TOLD).map(|f| f.name.as_str()).collect();
            let value = format!("`{name}`, which has {}", names.join(", "));
            Err(Error::parameter("feature", value, "one of these"))
        }
    }
}

fn unknown(features: &[RoundFeature], name: &str) -> Error {
    let mut names: Vec<&str> = features.iter().take(TOLD).map(|f| f.name.as_str()).collect();
    let mut objects: Vec<&str> = features.iter().map(|f| f.object.as_str()).collect();
    objects.retain(|o| !o.is_empty());
    objects.dedup();
    names.extend(objects.into_iter().take(TOLD));
    let value = match names[..] {
        [] => format!("`{name}`, and the model has no round parts"),
        _ => format!("`{name}`, and there are {}", names.join(", ")),
    };
    Error::parameter("feature", value, "the name of a round part, or of an object that has some")
}
