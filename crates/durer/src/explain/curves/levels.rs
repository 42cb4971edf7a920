//! The lessons of levels of points: de Casteljau, de Boor, knot insertion.

use super::{EXAMPLES, TAKES};
use crate::curve::b_spline::{self, BSpline, de_boor};
use crate::curve::bezier::{self, de_casteljau};
use crate::curve::knot_insertion::{self, insert, refine};
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::input::Input;
use crate::explain::lesson::Lesson;
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Template, Value, Word};
use crate::math::DVec2;
use crate::trace::{NoTrace, PseudocodeLine};
use crate::{Error, Result};

pub(super) const DE_CASTELJAU: Lesson = Lesson {
    name: bezier::INFO.name,
    info: &bezier::INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&MIXED, &FOUND],
    unreached: &[],
    make: |_, input, _, cap| bezier(input, cap),
};

pub(super) const DE_BOOR: Lesson = Lesson {
    name: b_spline::INFO.name,
    info: &b_spline::INFO,
    templates: &[&SHARED, &REACHED],
    make: |_, input, _, cap| b_spline(input, cap),
    ..DE_CASTELJAU
};

pub(super) const BOEHM: Lesson = Lesson {
    name: knot_insertion::INFO.name,
    info: &knot_insertion::INFO,
    templates: &[&INSERTED],
    make: |_, input, _, cap| boehm(input, cap),
    ..DE_CASTELJAU
};

pub(super) const OSLO: Lesson = Lesson {
    name: knot_insertion::OSLO.name,
    info: &knot_insertion::OSLO,
    templates: &[&REFINED, &PLACED],
    make: |_, input, _, cap| oslo(input, cap),
    ..DE_CASTELJAU
};

/// Knots that are inserted, the first one by Boehm's algorithm.
const NEW: [f64; 2] = [0.4, 0.7];

/// Parameter of the point that is shown.
const PARAMETER: f64 = 0.4;

/// Degree of the spline that is shown.
const DEGREE: usize = 3;

/// The most control points whose levels can be read.
const MOST: usize = 12;

static MIXED: Template = Template::new(
    "point",
    "Level {level}: {t} of the way from {from} to {to} lies {point}.",
    "Stufe {level}: Auf {t} des Wegs von {from} nach {to} liegt {point}.",
);
static FOUND: Template = Template::new(
    "point",
    "Level {level}: {t} of the way from {from} to {to} lies {point}. It is the point of the curve.",
    "Stufe {level}: Auf {t} des Wegs von {from} nach {to} liegt {point}. Das ist der Punkt der Kurve.",
);
static SHARED: Template = Template::new(
    "point",
    "Level {level}: the knots give a share of {t}: between {from} and {to} lies {point}.",
    "Stufe {level}: Die Knoten geben einen Anteil von {t}: Zwischen {from} und {to} liegt {point}.",
);
static REACHED: Template = Template::new(
    "point",
    "Level {level}: the share is {t}: between {from} and {to} lies {point}, the point of the curve.",
    "Stufe {level}: Der Anteil ist {t}: Zwischen {from} und {to} liegt {point}, der Punkt der Kurve.",
);

static INSERTED: Template = Template::new(
    "point",
    "New control point {index}: the knots give a share of {t}: between {from} and {to} lies {point}.",
    "Neuer Kontrollpunkt {index}: Die Knoten geben einen Anteil von {t}: Zwischen {from} und {to} liegt {point}.",
);
static REFINED: Template = Template::new(
    "point",
    "For new control point {index}, level {level}: a share of {t} between {from} and {to} gives {point}.",
    "Für den neuen Kontrollpunkt {index}, Stufe {level}: Ein Anteil von {t} zwischen {from} und {to} gibt {point}.",
);
static PLACED: Template = Template::new(
    "point",
    "Level {level}: a share of {t} between {from} and {to} gives {point}: it is new control point {index}.",
    "Stufe {level}: Ein Anteil von {t} zwischen {from} und {to} gibt {point}: Das ist der neue Kontrollpunkt {index}.",
);

/// Control points, the points of all levels, and the curve itself.
#[derive(Clone)]
struct State {
    levels: Vec<Vec<Option<DVec2>>>,
    curve: Vec<DVec2>,
}

/// A point of a level: mixed from two of the level below.
struct Mix {
    level: usize,
    /// Its place, and those of the two.
    index: usize,
    from: [usize; 2],
    share: f64,
    point: DVec2,
}

fn control(input: &Input) -> Result<&[DVec2]> {
    let line = input.figure(TAKES)?.lines.first().filter(|line| line.len() > 1);
    let line = line.ok_or_else(|| Error::parameter("input", "without a line", TAKES.en))?;
    if line.len() > MOST {
        let (value, limit) = (line.len() as u64, MOST as u64);
        return Err(Error::Limit {
            what: "number of control points to be explained",
            value,
            limit,
        });
    }
    Ok(line)
}

fn bezier(input: &Input, cap: usize) -> Result<Frames> {
    let control = control(input)?;
    let count = control.len();
    let at = |t: f64| de_casteljau(control, t, &mut NoTrace).unwrap_or_default();
    let mut state = State::new(control, samples(at));
    let steps = record(cap, |t| {
        de_casteljau(control, PARAMETER, t);
        Ok(())
    })?;
    Ok(Frames::new(steps, move |step, want| {
        let bezier::Step { level, index, point } = *step;
        let mix = Mix { level, index, from: [index, index + 1], share: PARAMETER, point };
        let is_last = level + 1 == count;
        state.show(&mix, if is_last { &FOUND } else { &MIXED }, step.line(), want)
    }))
}

fn b_spline(input: &Input, cap: usize) -> Result<Frames> {
    let (control, spline) = spline(input)?;
    let degree = spline.degree();
    let mut state = State::new(control, samples(|t| spline.point(t)));
    let steps = record(cap, |t| {
        de_boor(&spline, PARAMETER, t);
        Ok(())
    })?;
    Ok(Frames::new(steps, move |step, want| {
        let b_spline::Step { level, index, share, point } = *step;
        let mix = Mix { level, index, from: [index.saturating_sub(1), index], share, point };
        state.show(&mix, if level == degree { &REACHED } else { &SHARED }, step.line(), want)
    }))
}

fn boehm(input: &Input, cap: usize) -> Result<Frames> {
    let (control, spline) = spline(input)?;
    let mut state = State::new(control, samples(|t| spline.point(t)));
    let steps = record(cap, |t| insert(&spline, NEW[0], t))?;
    Ok(Frames::new(steps, move |step, want| {
        let knot_insertion::Step { index, share, point } = *step;
        let mix = Mix { level: 1, index, from: [index.saturating_sub(1), index], share, point };
        let mut shown = state.show(&mix, &INSERTED, step.line(), want);
        shown.caption.values.push(("index", index.into()));
        shown
    }))
}

fn oslo(input: &Input, cap: usize) -> Result<Frames> {
    let (control, spline) = spline(input)?;
    let curve = samples(|t| spline.point(t));
    let mut state = State::new(control, curve);
    let steps = record(cap, |t| refine(&spline, &NEW, t))?;
    let (degree, mut of_before) = (spline.degree(), 0);
    Ok(Frames::new(steps, move |step, want| {
        let knot_insertion::OsloStep { of, level, index, share, point } = *step;
        if std::mem::replace(&mut of_before, of) != of {
            // The levels begin anew for each new control point.
            state.levels.truncate(1);
        }
        let mix = Mix { level, index, from: [index.saturating_sub(1), index], share, point };
        let is_last = level == degree;
        let mut shown =
            state.show(&mix, if is_last { &PLACED } else { &REFINED }, step.line(), want);
        shown.caption.values.push(("index", of.into()));
        shown
    }))
}

/// Returns the control points of an input, and a curve with them.
fn spline(input: &Input) -> Result<(&[DVec2], BSpline<DVec2>)> {
    let control = control(input)?;
    let degree = DEGREE.min(control.len() - 1);
    Ok((control, BSpline::clamped(degree, control.to_vec())?))
}

/// Returns points of a curve over 0 … 1.
fn samples(at: impl Fn(f64) -> DVec2) -> Vec<DVec2> {
    (0..=60).map(|k| at(f64::from(k) / 60.0)).collect()
}

impl State {
    fn new(control: &[DVec2], curve: Vec<DVec2>) -> Self {
        Self { levels: vec![control.iter().copied().map(Some).collect()], curve }
    }

    fn at(&self, level: usize, index: usize) -> Option<DVec2> {
        self.levels.get(level)?.get(index).copied().flatten()
    }

    fn show(&mut self, mix: &Mix, template: &'static Template, line: usize, want: Want) -> Shown {
        let count = self.levels.first().map_or(0, Vec::len);
        if self.levels.len() <= mix.level {
            self.levels.push(vec![None; count]);
        }
        if let Some(place) = self.levels.get_mut(mix.level).and_then(|l| l.get_mut(mix.index)) {
            *place = Some(mix.point);
        }
        let [from, to] = mix.from.map(|index| self.at(mix.level - 1, index).unwrap_or_default());
        let caption = template.with([
            ("level", mix.level.into()),
            ("t", mix.share.into()),
            ("from", from.into()),
            ("to", to.into()),
            ("point", mix.point.into()),
        ]);
        want.shown(line, caption, || self.table(), || self.picture(mix, [from, to]))
    }

    /// Returns the triangle of points, a column for each level.
    fn table(&self) -> Table {
        let mut table = Table::new([]);
        table.heads.push(Word::new("index", "Index"));
        const LEVELS: [Word; 4] = [
            Word::new("level 0", "Stufe 0"),
            Word::new("level 1", "Stufe 1"),
            Word::new("level 2", "Stufe 2"),
            Word::new("level 3", "Stufe 3"),
        ];
        let more = Word::new("level", "Stufe");
        let heads = (0..self.levels.len()).map(|k| LEVELS.get(k).copied().unwrap_or(more));
        table.heads.extend(heads);
        let count = self.levels.first().map_or(0, Vec::len);
        for index in 0..count {
            let value = |level| self.at(level, index).map_or_else(|| "".into(), Value::from);
            table.row(index, (0..self.levels.len()).map(value));
        }
        table
    }

    fn picture(&self, mix: &Mix, ends: [DVec2; 2]) -> Picture {
        let control = self.levels.iter().take(1).flatten().flatten().copied();
        let mut picture = Picture::around(control.clone(), 0.12);
        picture.chain(self.curve.clone(), Look::Pale);
        for (number, p) in control.enumerate() {
            picture.named(p, format!("P{number}"), Look::Window);
        }
        for (number, level) in self.levels.iter().enumerate() {
            let look = if number == 0 { Look::Window } else { Look::First };
            picture.chain(level.iter().copied().flatten().collect::<Vec<_>>(), look);
        }
        for p in self.levels.iter().skip(1).flatten().flatten() {
            picture.dot(*p, Look::First);
        }
        picture.chain(ends, Look::Second);
        picture.dot(mix.point, Look::Now);
        picture
    }
}
