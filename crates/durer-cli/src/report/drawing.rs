//! The report of a drawing in `--json`.

use durer::annotate::RoundFeature;
use durer::math::DVec3;
use durer::paper::{LaidOut, scale_text};
use durer::target::drawing::{Drawing, Line, LineClass};
use durer_formats::wording::counted;
use serde::Serialize;

/// Number of borders below which they are taken for the edges of sheets.
const LOOSE: u64 = 12;

/// A drawing's counts and lengths.
#[derive(Debug, Serialize)]
pub struct DrawingReport {
    /// Style of the drawing.
    pub style: &'static str,
    /// Width and height of the paper, millimetres.
    pub page: [f64; 2],
    /// Length on paper over true length, as a ratio and as a text.
    pub scale: f64,
    /// E.g. `1:10`.
    pub scale_text: String,
    /// Filled areas.
    pub regions: usize,
    /// Their area, squared model units on the picture plane.
    pub region_area: f64,
    /// Edges of the model's faces, over all views, where lines are drawn.
    pub edges: u64,
    /// Number of edges of one face only.
    pub border_edges: u64,
    /// Number of lines by class, for classes with lines.
    pub lines: Vec<ClassReport>,
    /// Round parts, if requested.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub features: Vec<FeatureReport>,
    /// Warning about the scale.
    #[serde(skip)]
    pub scale_warning: Option<String>,
}

/// The lines of one class.
#[derive(Debug, Serialize)]
pub struct ClassReport {
    /// Its name.
    pub class: &'static str,
    /// Lines with nothing in front of them.
    pub visible: LineReport,
    /// Lines with something in front of them.
    pub hidden: LineReport,
}

/// Lines of a kind.
#[derive(Debug, Default, Serialize)]
pub struct LineReport {
    /// Chains.
    pub polylines: usize,
    /// Their points.
    pub points: usize,
    /// Their length, model units on the picture plane.
    pub length: f64,
}

/// A round part, as `--json` lists it.
#[derive(Debug, Serialize)]
pub struct FeatureReport {
    /// `hole 1`, …
    pub name: String,
    /// The name of its object; left out if it has none.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub object: String,
    /// Diameter in units of the model.
    pub diameter: f64,
    /// Ends of its axis.
    pub ends: [[f64; 3]; 2],
    /// The angle of the arc that is there, degrees.
    pub angle: f64,
}

impl From<&RoundFeature> for FeatureReport {
    fn from(feature: &RoundFeature) -> Self {
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

impl DrawingReport {
    /// Creates the report on a drawing, over all views.
    pub fn new(
        style: &'static str,
        drawings: &[&Drawing],
        laid: &LaidOut,
        features: Vec<FeatureReport>,
    ) -> Self {
        let regions = || drawings.iter().flat_map(|d| &d.regions);
        // Views of a sheet show the same model, and sections other edges of it.
        let edges = drawings.iter().map(|d| d.edges).max_by_key(|e| e.edges).unwrap_or_default();
        let lines = |class: LineClass, visible: bool| {
            let all = drawings.iter().flat_map(|d| &d.lines);
            of(all.filter(|l| l.class == class && l.is_visible() == visible))
        };
        let class = |&class: &LineClass| {
            let (visible, hidden) = (lines(class, true), lines(class, false));
            let some = visible.polylines + hidden.polylines > 0;
            some.then_some(ClassReport { class: class.name(), visible, hidden })
        };
        Self {
            style,
            page: laid.sheet.size.to_array(),
            scale: laid.scale,
            scale_text: scale_text(laid.scale),
            regions: regions().count(),
            // The sum of no numbers is −0.
            region_area: regions().map(|r| r.area()).sum::<f64>() + 0.0,
            edges: edges.edges,
            border_edges: edges.borders,
            lines: LineClass::ALL.iter().filter_map(class).collect(),
            features,
            scale_warning: None,
        }
    }

    /// Warns if so many edges are borders that most faces meet no others: two of three edges, as those of hexagons that
    /// are separate. Open surfaces have fewer, even strips of faces in one row.
    pub fn loose_faces(&self) -> Option<String> {
        let Self { edges, border_edges, .. } = *self;
        (border_edges >= LOOSE && border_edges * 3 >= edges * 2).then(|| {
            format!(
                "{border_edges} of {edges} edges belong to a single face: most faces do not meet others; \
                 --weld LENGTH joins corners of faces that are that close to each other"
            )
        })
    }

    /// Returns a summary in a few words, for `--verbose`.
    pub fn summary(&self) -> String {
        let polylines: usize =
            self.lines.iter().map(|c| c.visible.polylines + c.hidden.polylines).sum();
        let polylines = counted(polylines as u64, "polyline", "polylines");
        let regions = counted(self.regions as u64, "region", "regions");
        format!("{polylines}, {regions}, scale {}", self.scale_text)
    }
}

fn of<'a>(lines: impl Iterator<Item = &'a Line>) -> LineReport {
    lines.fold(LineReport::default(), |sum, line| LineReport {
        polylines: sum.polylines + 1,
        points: sum.points + line.points.len(),
        length: sum.length + line.length(),
    })
}
