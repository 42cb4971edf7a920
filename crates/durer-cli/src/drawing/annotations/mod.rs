//! Annotations of drawings, from the options.

mod file;

use crate::failure::Failure;
use crate::options::drawing::{AnnotationArgs, Dimensioned};
use durer::annotate::{self, Annotations, RoundFeature, Shown};
use durer::paper::LaidOut;
use durer::scene::Scene;
use durer::target::drawing::Drawing;
use durer::visibility::object::{Faces, Weld};

/// Parses the text of `--annotations`, for fuzzing.
///
/// # Errors
/// Description of the fault.
pub fn parse(text: &str) -> Result<(), String> {
    file::parse(text).map(drop).map_err(|(_, what)| what)
}

/// The annotations requested, and the round parts of the model.
pub struct Annotated {
    annotations: Annotations,
    pub features: Vec<RoundFeature>,
}

impl Annotated {
    /// Reads the options, and finds the round parts of a scene once for all its views and frames; `None` if they
    /// request none.
    pub fn new(args: &AnnotationArgs, scene: &Scene, weld: Weld) -> Result<Option<Self>, Failure> {
        let annotations = annotations(args)?;
        if annotations.is_empty() {
            return Ok(None);
        }
        let faces = Faces::welded(scene, weld).map_err(|e| Failure::Usage(e.to_string()))?;
        let features = annotate::features(scene, &faces);
        Ok(Some(Self { annotations, features }))
    }

    /// Returns the room around views, in millimetres.
    pub fn room(&self) -> f64 {
        annotate::room(&self.annotations)
    }

    /// Puts the annotations on a sheet; notes name those without room.
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
