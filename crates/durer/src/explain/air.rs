//! The lesson of depth cueing and fog: posts along a road, by three formulas.

use super::frame::{Frames, Numbered, Shown, Want, record};
use super::input::{Figure, Input};
use super::lesson::{Example, Lesson};
use super::picture::{Look, Picture};
use super::table::Table;
use super::words::{Caption, Template, Value, Word};
use crate::fragment::fog::{Fog, INFO, Step};
use crate::math::{DVec2, Vec4};
use crate::trace::PseudocodeLine;
use crate::{Error, Result};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        Example {
            name: "road",
            title: Word::new("posts along a road", "Pfosten an einer Straße"),
            input: || posts(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0]),
        },
        Example {
            name: "far",
            title: Word::new("near, at the end, and beyond", "nah, am Ende und dahinter"),
            input: || posts(&[10.0, 50.0, 80.0, 100.0]),
        },
        Example::new(
            "near",
            "nearer than the start: linear fog leaves them as they are",
            "näher als der Anfang: Linearer Nebel lässt sie, wie sie sind",
            || posts(&[0.0, 0.5, 1.0, 1.5, 2.0, 8.0]),
        ),
        Example::new(
            "equal-steps",
            "equal steps: exponential fog leaves the same share of each step",
            "gleiche Schritte: Exponentieller Nebel lässt von jedem Schritt denselben Anteil",
            || posts(&[0.0, 2.0, 4.0, 6.0, 8.0, 10.0]),
        ),
        Example::new(
            "pairs",
            "pairs of equal distance: differences far away are smaller",
            "Paare mit gleichem Abstand: In der Ferne sind Unterschiede kleiner",
            || posts(&[1.0, 2.0, 9.0, 10.0]),
        ),
        Example::new(
            "one",
            "a single post at the end of the fog",
            "ein einzelner Pfosten am Ende des Nebels",
            || posts(&[6.0]),
        ),
    ],
    templates: &[&LINEAR, &EXPONENTIAL, &SQUARED, &MIXED],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const TAKES: Word = Word::new(
    "points, whose x is the distance from the eye",
    "Punkte, deren x die Entfernung vom Auge ist",
);

fn posts(distances: &[f64]) -> Input {
    let points = distances.iter().map(|&z| DVec2::new(z, 0.0)).collect();
    Input::Figure(Figure { points, ..Figure::default() })
}

static LINEAR: Template = Template::new(
    "share",
    "z = {z}: by the linear formula from {start} to {end} the share f = {share} of the colour is left, at least {least}.",
    "z = {z}: Nach der linearen Formel von {start} bis {end} bleibt der Anteil f = {share} der Farbe, mindestens {least}.",
);
static EXPONENTIAL: Template = Template::new(
    "share",
    "z = {z}: exponential fog of density ρ = {density} leaves f = e^(−ρz) = {share}.",
    "z = {z}: Exponentieller Nebel der Dichte ρ = {density} lässt f = e^(−ρz) = {share} übrig.",
);
static SQUARED: Template = Template::new(
    "share",
    "z = {z}: squared fog of density ρ = {density} leaves f = e^(−(ρz)²) = {share}.",
    "z = {z}: Quadratischer Nebel der Dichte ρ = {density} lässt f = e^(−(ρz)²) = {share} übrig.",
);
static MIXED: Template = Template::new(
    "mixed",
    "f · {color} + (1 − f) · {air} = {mixed}: the colour of the post, mixed with the air's.",
    "f · {color} + (1 − f) · {air} = {mixed}: die Farbe des Pfostens, gemischt mit der der Luft.",
);

/// Colour of the posts.
const POST: Vec4 = Vec4::new(0.1, 0.2, 0.5, 1.0);
/// Colour of the air.
const AIR: Vec4 = Vec4::new(0.9, 0.9, 0.9, 1.0);

/// Names of the formulas, in the order of the rows.
const NAMES: [Word; 3] = [
    Word::new("linear", "linear"),
    Word::new("exponential", "exponentiell"),
    Word::new("squared", "quadratisch"),
];

/// The distances, and the shares and colours so far by formula.
#[derive(Clone)]
struct State {
    distances: Vec<f64>,
    cells: [Vec<(f64, Vec4)>; 3],
    share: f64,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let figure = input.figure(TAKES)?;
    let distances: Vec<f64> = figure.points.iter().map(|p| p.x).collect();
    let Some(&first) = distances.first() else {
        return Err(Error::parameter("input", "without a point", TAKES.en));
    };
    // The formulas are chosen for the farthest point, and agree there but for a few per cent.
    let far = distances.iter().copied().fold(first, f64::max);
    let far = if far > 0.0 { far as f32 } else { 1.0 };
    let laws = [
        Fog::Linear { start: far / 4.0, end: far, least: 0.125 },
        Fog::Exponential { density: 2.0 / far },
        Fog::Squared { density: std::f32::consts::SQRT_2 / far },
    ];
    let steps = record(cap, |t| {
        for &z in &distances {
            for (number, law) in laws.iter().enumerate() {
                law.apply_traced(POST, AIR, z as f32, &mut Numbered { number, t });
            }
        }
        Ok(())
    })?;
    let mut state = State { distances, cells: [const { Vec::new() }; 3], share: 1.0 };
    Ok(Frames::new(steps, move |(law, step), want| state.show(*law, step, want)))
}

impl State {
    fn show(&mut self, law: usize, step: &Step, want: Want) -> Shown {
        let caption = self.take(law, step);
        want.shown(step.line(), caption, || self.table(), || self.picture(law, step))
    }

    fn take(&mut self, law: usize, step: &Step) -> Caption {
        match *step {
            Step::Share { fog, z, left } => {
                self.share = left.into();
                let [z, share] = [("z", number(z)), ("share", number(left))];
                match fog {
                    Fog::Linear { start, end, least } => LINEAR.with([
                        z,
                        share,
                        ("start", number(start)),
                        ("end", number(end)),
                        ("least", number(least)),
                    ]),
                    Fog::Exponential { density } => {
                        EXPONENTIAL.with([z, share, ("density", number(density))])
                    }
                    Fog::Squared { density } => {
                        SQUARED.with([z, share, ("density", number(density))])
                    }
                }
            }
            Step::Mixed(color) => {
                if let Some(cells) = self.cells.get_mut(law) {
                    cells.push((self.share, color));
                }
                let rgb = |color: Vec4| Value::from(color.truncate().as_dvec3());
                MIXED.with([("color", rgb(POST)), ("air", rgb(AIR)), ("mixed", rgb(color))])
            }
        }
    }

    fn table(&self) -> Table {
        let mut table = Table::new([
            Word::new("z", "z"),
            Word::new("f, linear", "f, linear"),
            Word::new("exponential", "exponentiell"),
            Word::new("squared", "quadratisch"),
        ]);
        let done = self.cells[0].len().max(1);
        for (post, z) in self.distances.iter().enumerate().take(done) {
            let share = |cells: &Vec<(f64, Vec4)>| {
                cells.get(post).map_or(Value::from(""), |(share, _)| (*share).into())
            };
            let [a, b, c] = &self.cells;
            table.row(*z, [share(a), share(b), share(c)]);
        }
        table
    }

    /// Draws a row of colours for each formula, a column for each post.
    fn picture(&self, law: usize, step: &Step) -> Picture {
        let columns = self.distances.len() as u32;
        let mut picture = Picture::pixels(columns, 3);
        picture.extent[0].x -= 3.2;
        picture.extent[0].y -= 0.8;
        picture.picture_from_input = None;
        for (column, z) in self.distances.iter().enumerate() {
            picture.label(DVec2::new(column as f64 + 0.5, -0.3), (0.0, 0.0), *z);
        }
        for (row, (name, cells)) in NAMES.into_iter().zip(&self.cells).enumerate() {
            picture.label(DVec2::new(-1.7, row as f64 + 0.5), (0.0, 0.0), name);
            for (column, (_, color)) in cells.iter().enumerate() {
                let color = color.truncate().to_array();
                let color = color.map(|c| (c.clamp(0.0, 1.0) * 255.0 + 0.5) as u8);
                picture.colored([column as i32, row as i32], color, "");
            }
        }
        let done = self.cells.get(law).map_or(0, Vec::len);
        let column = if matches!(step, Step::Mixed(_)) { done.saturating_sub(1) } else { done };
        picture.dot(DVec2::new(column as f64 + 0.5, law as f64 + 0.5), Look::Now);
        picture
    }
}

/// Returns a number of single precision as it is written.
fn number(x: f32) -> Value {
    f64::from(x).into()
}
