//! Annotations of drawings, as the options ask for them.

pub mod args;
mod file;

use crate::failure::Failure;
use args::{AnnotationArgs, Dimensioned};
use durer::annotate::{self, Annotations, Feature, Shown};
use durer::math::DVec3;
use durer::paper::LaidOut;
use durer::scene::Scene;
use durer::target::drawing::Drawing;
use durer::visibility::object::{Faces, Weld};
use serde::Serialize;

/// The annotations asked for, and the round parts of the model.
pub struct Annotated {
    annotations: Annotations,
    pub features: Vec<Feature>,
}

/// A round part, as `--json` lists it.
#[derive(Debug, Serialize)]
pub struct FeatureReport {
    /// `hole 1`, …
    pub name: String,
    /// The name of its object; left out where it has none.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub object: String,
    /// In units of the model.
    pub diameter: f64,
    /// Ends of its axis.
    pub ends: [[f64; 3]; 2],
    /// The angle of the arc that is there, degrees.
    pub angle: f64,
}

impl From<&Feature> for FeatureReport {
    fn from(feature: &Feature) -> Self {
        let c = &feature.cylinder;
        Self {
            name: feature.name.clone(),
            object: feature.object.clone(),
            diameter: 2.0 * c.radius,
            ends: c.ends.map(|p: DVec3| p.to_array()),
            angle: c.angle.to_degrees(),
        }
    }
}

impl Annotated {
    /// Reads the options, and finds the round parts of a scene once for all its views and frames; `None` where they ask for
    /// nothing.
    pub fn new(args: &AnnotationArgs, scene: &Scene, weld: Weld) -> Result<Option<Self>, Failure> {
        let annotations = annotations(args)?;
        if annotations.is_empty() {
            return Ok(None);
        }
        let faces = Faces::welded(scene, weld).map_err(|e| Failure::Usage(e.to_string()))?;
        let features = annotate::features(scene, &faces);
        Ok(Some(Self { annotations, features }))
    }

    /// Room around views, millimetres.
    pub fn room(&self) -> f64 {
        annotate::room(&self.annotations)
    }

    /// Puts the annotations on a sheet; its notes tell what has no place.
    pub fn put(
        &self,
        laid: &mut LaidOut,
        shown: &[super::Shown],
        look: &Look,
    ) -> Result<(), Failure> {
        for (view, own) in laid.views.iter_mut().zip(shown) {
            view.camera.get_or_insert(own.camera);
            view.breaks = own.breaks.clone();
        }
        let drawings: Vec<&Drawing> = shown.iter().map(|s| &s.drawing).collect();
        let shown = Shown {
            views: &laid.views,
            drawings: &drawings,
            features: &self.features,
            unit: look.unit,
            hidden: look.hidden,
            color: look.color,
        };
        let notes = annotate::annotate(&mut laid.sheet, &self.annotations, &shown);
        let wrong = |e: durer::Error| Failure::Usage(format!("--annotations, --thread: {e}"));
        laid.notes.extend(notes.map_err(wrong)?);
        Ok(())
    }
}

/// The properties of a drawing that its annotations follow.
pub struct Look {
    /// Millimetres per unit of the model.
    pub unit: f64,
    /// True if hidden lines are drawn.
    pub hidden: bool,
    /// The colour of pens.
    pub color: [u8; 4],
}

fn annotations(args: &AnnotationArgs) -> Result<Annotations, Failure> {
    let listed = args.annotations.as_deref().map(file::read).transpose()?.unwrap_or_default();
    let has = |which| args.dimension.contains(&which);
    Ok(Annotations {
        center_lines: args.center_lines,
        sizes: has(Dimensioned::Size),
        holes: has(Dimensioned::Holes),
        bosses: has(Dimensioned::Bosses),
        dimensions: listed.dimensions,
        threads: args.thread.iter().cloned().chain(listed.threads).collect(),
    })
}
