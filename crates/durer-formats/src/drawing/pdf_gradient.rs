//! Gradients as shadings of PDF: axial and radial ones, whose colours a function gives (ISO 32000-1, 8.7.4.5). Where the
//! opacity changes, a second shading is the luminosity of a soft mask (11.6.5.2).

use super::number::short;
use crate::Result;
use durer::math::{DAffine2, DVec2};
use durer::target::gradient::{Gradient, GradientShape, Spread};
use durer::target::sheet::{PaperMark, Sheet};
use pdf_writer::writers::Resources;
use pdf_writer::{Dict, Name, Obj, Pdf, Rect, Ref};

/// Largest number of colours in a gradient that repeats: more of them are finer than anything that is seen.
const MOST: f64 = 10_000.0;

/// Difference of stops that are at one place: readers of SVG move the later one by as little as they can.
const JUMP: f64 = 1e-6;

/// Digits after the point of a map's numbers.
const DIGITS: usize = 6;

/// The gradients of a page.
#[derive(Default)]
pub(super) struct Gradients {
    shadings: Vec<Shading>,
    /// The shadings of opacities by which soft masks cover, with their maps.
    masks: Vec<(usize, DAffine2)>,
}

/// Colours between two circles, or two points.
struct Shading {
    /// Ends, and the radii of circles.
    ends: [DVec2; 2],
    radii: Option<[f64; 2]>,
    /// Places 0 … 1 in rising order and their colours, or their greys for opacities.
    ramp: Vec<(f64, Vec<f32>)>,
}

/// Objects of gradients.
pub(super) struct Objects {
    shadings: Vec<Ref>,
    forms: Vec<Ref>,
}

/// Refuses gradients that repeat too often on the sheet.
pub(super) fn check(sheet: &Sheet) -> Result<()> {
    let mut marks: Vec<&PaperMark> = sheet.layers.iter().flat_map(|layer| &layer.marks).collect();
    while let Some(mark) = marks.pop() {
        match mark {
            PaperMark::Group(group) => marks.extend(&group.marks),
            PaperMark::Gradient(area) => {
                let [lo, hi] = reach(&area.gradient, sheet.size);
                let colors = (hi - lo) * area.gradient.stops.len() as f64;
                if area.gradient.spread != Spread::Pad && (colors.is_nan() || colors > MOST) {
                    let what = "in PDF, a gradient that repeats more than some thousand times";
                    let instead = "write SVG or PNG";
                    return Err(durer::Error::Unsupported { what, instead }.into());
                }
            }
            _ => {}
        }
    }
    Ok(())
}

impl Gradients {
    /// Returns the operators that fill the clip path with a gradient, and its opacity if that is the same throughout.
    pub fn fill(&mut self, gradient: &Gradient, size: DVec2) -> (String, u8) {
        let range = range(gradient, size);
        let mut text = String::new();
        let first = gradient.stops.first().map_or(255, |stop| stop.1[3]);
        let is_even = gradient.stops.iter().all(|stop| stop.1[3] == first);
        if !is_even {
            let shading = self.add(gradient, range, |[.., a]| vec![a]);
            text += &format!("/G{} gs\n", self.masks.len());
            self.masks.push((shading, gradient.transform));
        }
        let shading = self.add(gradient, range, |[r, g, b, _]| vec![r, g, b]);
        text += &painted(shading, &gradient.transform);
        (text, if is_even { first } else { 255 })
    }

    fn add(
        &mut self,
        gradient: &Gradient,
        range: [f64; 2],
        channels: impl Fn([f32; 4]) -> Vec<f32>,
    ) -> usize {
        let channels = |color: [u8; 4]| channels(color.map(|c| f32::from(c) / 255.0));
        let ramp = ramp(gradient, range);
        let ramp = ramp.into_iter().map(|(t, color)| (t, channels(color))).collect();
        let ([a, b], radii) = match gradient.shape {
            GradientShape::Linear { start, end } => ([start, end], None),
            GradientShape::Radial { center, radius, focus, focus_radius } => {
                let at = |t: f64| (focus_radius + t * (radius - focus_radius)).max(0.0);
                ([focus, center], Some(range.map(at)))
            }
        };
        let ends = range.map(|t| a + (b - a) * t);
        self.shadings.push(Shading { ends, radii, ramp });
        self.shadings.len() - 1
    }

    /// Numbers the objects of gradients.
    pub fn objects(&self, mut number: impl FnMut() -> Ref) -> Objects {
        let shadings = self.shadings.iter().map(|_| number()).collect();
        Objects { shadings, forms: self.masks.iter().map(|_| number()).collect() }
    }

    /// Writes the objects.
    pub fn write(&self, pdf: &mut Pdf, objects: &Objects, sheet: &Sheet) {
        for (shading, id) in self.shadings.iter().zip(&objects.shadings) {
            shading.write(pdf.indirect(*id).dict());
        }
        for ((shading, map), id) in self.masks.iter().zip(&objects.forms) {
            let content = painted(*shading, map);
            let mut form = pdf.form_xobject(*id, content.as_bytes());
            form.bbox(Rect::new(0.0, 0.0, sheet.size.x as f32, sheet.size.y as f32));
            form.group().transparency().isolated(true).color_space().device_gray();
            objects.list_shadings(&mut form.resources());
        }
    }
}

impl Objects {
    /// Lists the shadings.
    pub fn list_shadings(&self, resources: &mut Resources<'_>) {
        if self.shadings.is_empty() {
            return;
        }
        let mut shadings = resources.shadings();
        for (i, id) in self.shadings.iter().enumerate() {
            shadings.pair(Name(format!("S{i}").as_bytes()), *id);
        }
    }

    /// Lists the soft masks.
    pub fn list_masks(&self, states: &mut Dict<'_>) {
        for (i, id) in self.forms.iter().enumerate() {
            let mut state = states.insert(Name(format!("G{i}").as_bytes())).dict();
            let mut mask = state.insert(Name(b"SMask")).dict();
            mask.pair(Name(b"Type"), Name(b"Mask")).pair(Name(b"S"), Name(b"Luminosity"));
            mask.pair(Name(b"G"), *id);
        }
    }
}

impl Shading {
    fn write(&self, mut dict: Dict<'_>) {
        let channels = self.ramp.first().map_or(0, |(_, color)| color.len());
        let space = if channels == 1 { Name(b"DeviceGray") } else { Name(b"DeviceRGB") };
        dict.pair(Name(b"ShadingType"), if self.radii.is_some() { 3 } else { 2 });
        dict.pair(Name(b"ColorSpace"), space);
        let mut coords: Vec<f32> = Vec::new();
        for (i, end) in self.ends.iter().enumerate() {
            coords.extend([end.x as f32, end.y as f32]);
            coords.extend(self.radii.map(|radii| radii[i] as f32));
        }
        dict.insert(Name(b"Coords")).array().items(coords);
        dict.insert(Name(b"Extend")).array().items([true, true]);
        self.function(dict.insert(Name(b"Function")));
    }

    /// Writes the function from places to colours: one that interpolates between two of them, or several stitched.
    fn function(&self, object: Obj<'_>) {
        let pairs: Vec<_> =
            self.ramp.windows(2).filter(|pair| pair[1].0 - pair[0].0 > JUMP).collect();
        let between = |object: Obj<'_>, pair: &[(f64, Vec<f32>)]| {
            let mut function = object.dict();
            function.pair(Name(b"FunctionType"), 2).pair(Name(b"N"), 1);
            function.insert(Name(b"Domain")).array().items([0, 1]);
            function.insert(Name(b"C0")).array().items(pair[0].1.iter().copied());
            function.insert(Name(b"C1")).array().items(pair[1].1.iter().copied());
        };
        if let [pair] = &pairs[..] {
            return between(object, pair);
        }
        let mut function = object.dict();
        function.pair(Name(b"FunctionType"), 3);
        function.insert(Name(b"Domain")).array().items([0, 1]);
        let mut functions = function.insert(Name(b"Functions")).array();
        pairs.iter().for_each(|pair| between(functions.push(), pair));
        drop(functions);
        let bounds = pairs.iter().skip(1).map(|pair| pair[0].0 as f32);
        function.insert(Name(b"Bounds")).array().items(bounds);
        let encode = pairs.iter().flat_map(|_| [0, 1]);
        function.insert(Name(b"Encode")).array().items(encode);
    }
}

/// Returns the operators that paint a shading everywhere.
fn painted(shading: usize, map: &DAffine2) -> String {
    let numbers = map.to_cols_array().map(|v| short(v, DIGITS)).join(" ");
    let map = if *map == DAffine2::IDENTITY { String::new() } else { format!("{numbers} cm\n") };
    format!("{map}/S{shading} sh\n")
}

/// Returns the parameters between which a gradient's colours are written: beyond 0 and 1 if it repeats, or if its colour
/// changes there at once.
fn range(gradient: &Gradient, size: DVec2) -> [f64; 2] {
    let [lo, hi] = match gradient.spread {
        Spread::Pad => {
            let jumps = |[a, b]: [Option<&(f64, [u8; 4])>; 2], end: f64| {
                [a, b].iter().all(|stop| stop.is_some_and(|stop| (stop.0 - end).abs() <= JUMP))
            };
            let stops = &gradient.stops;
            let (first, last) = (jumps([stops.first(), stops.get(1)], 0.0), {
                let mut back = stops.iter().rev();
                jumps([back.next(), back.next()], 1.0)
            });
            [if first { -1.0 } else { 0.0 }, if last { 2.0 } else { 1.0 }]
        }
        Spread::Repeat | Spread::Reflect => {
            let [lo, hi] = reach(gradient, size);
            // `check` refuses more.
            let most = MOST / gradient.stops.len().max(1) as f64;
            [lo.floor().max(-most), hi.ceil().min(most).max(1.0)]
        }
    };
    // No circle has a radius below 0.
    match gradient.shape {
        GradientShape::Radial { radius, focus_radius, .. } if radius != focus_radius => {
            let apex = focus_radius / (focus_radius - radius);
            if radius > focus_radius { [lo.max(apex), hi] } else { [lo, hi.min(apex)] }
        }
        _ => [lo, hi],
    }
}

/// Returns parameters between which those of all points of a sheet lie.
fn reach(gradient: &Gradient, size: DVec2) -> [f64; 2] {
    let back = gradient.transform.inverse();
    let corners = [DVec2::ZERO, DVec2::new(size.x, 0.0), size, DVec2::new(0.0, size.y)];
    let corners = corners.map(|corner| back.transform_point2(corner));
    match gradient.shape {
        GradientShape::Linear { start, end } => {
            let way = end - start;
            let along = corners.map(|p| (p - start).dot(way) / way.length_squared());
            let (lo, hi) = (f64::INFINITY, f64::NEG_INFINITY);
            along.iter().fold([lo, hi], |[lo, hi], t| [lo.min(*t), hi.max(*t)])
        }
        GradientShape::Radial { center, radius, focus, focus_radius } => {
            let far = corners.iter().map(|p| p.distance(focus)).fold(0.0, f64::max);
            // The side of a circle towards a point moves at least so far for each step of the parameter.
            let step = (center.distance(focus) - (radius - focus_radius).abs()).abs();
            let most = (far + focus_radius) / step;
            [-most, most]
        }
    }
}

/// Returns the colours of a gradient at places 0 … 1 between two parameters.
fn ramp(gradient: &Gradient, [lo, hi]: [f64; 2]) -> Vec<(f64, [u8; 4])> {
    let stops = &gradient.stops;
    let [Some((_, first)), Some((_, last))] = [stops.first(), stops.last()] else {
        return Vec::new();
    };
    let mut all: Vec<(f64, [u8; 4])> = Vec::new();
    if gradient.spread == Spread::Pad {
        all.push((lo.min(0.0), *first));
        all.extend(stops);
        all.push((hi.max(1.0), *last));
    } else {
        let whole = |turn: f64, is_back: bool| {
            let mut all = vec![(0.0, *first)];
            all.extend(stops);
            all.push((1.0, *last));
            if is_back {
                all.reverse();
                all.iter_mut().for_each(|stop| stop.0 = 1.0 - stop.0);
            }
            all.into_iter().map(move |(t, color)| (turn + t, color))
        };
        let mut turn = lo.floor();
        while turn < hi {
            let is_back = gradient.spread == Spread::Reflect && turn.rem_euclid(2.0) == 1.0;
            all.extend(whole(turn, is_back));
            turn += 1.0;
        }
    }
    within(&all, [lo, hi]).into_iter().map(|(t, color)| ((t - lo) / (hi - lo), color)).collect()
}

/// Returns the part of a ramp between two parameters.
fn within(ramp: &[(f64, [u8; 4])], [lo, hi]: [f64; 2]) -> Vec<(f64, [u8; 4])> {
    let mut part = Vec::new();
    for pair in ramp.windows(2) {
        let ((t0, c0), (t1, c1)) = (pair[0], pair[1]);
        if t1 < lo || t0 > hi {
            continue;
        }
        let at = |t: f64| {
            let share = if t1 > t0 { ((t - t0) / (t1 - t0)).clamp(0.0, 1.0) } else { 0.0 };
            let mixed = |i: usize| {
                let (a, b) = (f64::from(c0[i]), f64::from(c1[i]));
                (a + (b - a) * share).round() as u8
            };
            (t, std::array::from_fn(mixed))
        };
        let ends = if t1 > t0 { [at(t0.max(lo)), at(t1.min(hi))] } else { [(t0, c0), (t1, c1)] };
        part.extend(ends);
    }
    part
}
