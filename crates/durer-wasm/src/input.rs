//! Inputs of lessons as JSON.

use crate::answer::Failure;
use durer::explain::{Figure, Grid, Input};
use durer::math::{DVec2, DVec3, DVec4, Rect};
use serde::{Deserialize, Serialize};

/// An input: an object with one member that names its kind.
#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum InputData {
    /// Name of an example; the first one if empty.
    Example(String),
    /// Shapes of the plane.
    Figure(FigureData),
    /// Rings of points in space.
    Faces(Vec<Vec<[f64; 3]>>),
    /// Homogeneous points.
    Clip(Vec<[f64; 4]>),
    /// A picture.
    Grid(GridData),
}

/// Shapes of the plane.
#[derive(Debug, Clone, Default, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct FigureData {
    /// Smallest x and y, largest x and y.
    #[serde(skip_serializing_if = "Option::is_none")]
    window: Option<[f64; 4]>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    lines: Vec<Vec<[f64; 2]>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    rings: Vec<Vec<[f64; 2]>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    clip: Vec<Vec<[f64; 2]>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    points: Vec<[f64; 2]>,
}

/// A picture with few colours.
#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct GridData {
    columns: u32,
    cells: Vec<u8>,
    seed: [u32; 2],
}

fn to_lists(lists: Vec<Vec<[f64; 2]>>) -> Vec<Vec<DVec2>> {
    lists.into_iter().map(|list| list.into_iter().map(DVec2::from).collect()).collect()
}

fn of_lists(lists: &[Vec<DVec2>]) -> Vec<Vec<[f64; 2]>> {
    lists.iter().map(|list| list.iter().map(DVec2::to_array).collect()).collect()
}

impl InputData {
    /// Returns the input as the library takes it.
    pub fn into_input(self) -> Result<Input, Failure> {
        Ok(match self {
            Self::Example(name) => Input::Example(name),
            Self::Figure(figure) => {
                let rect = |[x0, y0, x1, y1]: [f64; 4]| {
                    Rect::new(
                        DVec2::new(x0.min(x1), y0.min(y1)),
                        DVec2::new(x0.max(x1), y0.max(y1)),
                    )
                };
                let window = figure.window.map(rect).transpose().map_err(|e| e.to_string())?;
                let [lines, rings, clip] = [figure.lines, figure.rings, figure.clip].map(to_lists);
                let points = figure.points.into_iter().map(DVec2::from).collect();
                Input::Figure(Figure { window, lines, rings, clip, points })
            }
            Self::Faces(faces) => {
                let ring = |ring: Vec<[f64; 3]>| ring.into_iter().map(DVec3::from).collect();
                Input::Faces(faces.into_iter().map(ring).collect())
            }
            Self::Clip(points) => Input::ClipSpace(points.into_iter().map(DVec4::from).collect()),
            Self::Grid(GridData { columns, cells, seed }) => {
                Input::Grid(Grid { columns, cells, seed })
            }
        })
    }

    /// Returns an input of the library as JSON has it.
    pub fn of_input(input: &Input) -> Self {
        match input {
            Input::Example(name) => Self::Example(name.clone()),
            Input::Figure(figure) => {
                let [lines, rings, clip] =
                    [&figure.lines, &figure.rings, &figure.clip].map(|lists| of_lists(lists));
                let window = figure.window.map(|w| {
                    let (low, high) = (w.min(), w.max());
                    [low.x, low.y, high.x, high.y]
                });
                let points = figure.points.iter().map(DVec2::to_array).collect();
                Self::Figure(FigureData { window, lines, rings, clip, points })
            }
            Input::Faces(faces) => {
                let ring = |ring: &Vec<DVec3>| ring.iter().map(DVec3::to_array).collect();
                Self::Faces(faces.iter().map(ring).collect())
            }
            Input::ClipSpace(points) => Self::Clip(points.iter().map(DVec4::to_array).collect()),
            Input::Grid(Grid { columns, cells, seed }) => {
                Self::Grid(GridData { columns: *columns, cells: cells.clone(), seed: *seed })
            }
        }
    }
}
