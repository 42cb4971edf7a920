//! From front to back over the cells: first the lines of a triangle, then the triangle itself.

use super::horizon::Horizon;
use super::sight::{Picture, Sight, side_of_eye};
use super::{LineFamily, LinePiece, Options, Step, chain};
use crate::math::{DVec2, DVec3};
use crate::scene::height_field::{cut, part_between};
use crate::scene::{Camera, HeightField};
use crate::sorting::CompactSort;
use crate::trace::Tracer;

/// The four sides of a cell: family, and the corners that they join (bit 0 the column, bit 1 the row).
const SIDES: [(LineFamily, [usize; 2]); 4] = [
    (LineFamily::AlongX, [0, 1]),
    (LineFamily::AlongX, [2, 3]),
    (LineFamily::AlongZ, [0, 2]),
    (LineFamily::AlongZ, [1, 3]),
];

/// Returns all pieces of all requested lines, in the order of finding.
pub fn pieces(
    field: &HeightField,
    camera: &Camera,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Vec<LinePiece> {
    let Some(bounds) = field.bounds() else { return Vec::new() };
    let middle = bounds.center();
    let sight = Sight::new(camera, middle);
    let pictures = sight.pictures(field, middle);
    let mut all = Vec::new();
    if pictures.is_empty() || field.columns() == 1 || field.rows() == 1 {
        // Seen along the plumb line, or a surface without area: nothing hides anything.
        everything(field, options, &mut all, t);
        return all;
    }
    for picture in &pictures {
        Walk::new(field, middle, sight, picture, options, &mut all).run(t);
    }
    if let Sight::From(eye) = sight {
        at_the_foot(field, middle, eye, &pictures, options, &mut all, t);
    }
    all
}

/// Returns whether a line is drawn.
fn wanted(field: &HeightField, options: &Options, family: LineFamily, line: usize) -> bool {
    let (every, count) = match family {
        LineFamily::AlongX => (options.every_row, field.rows()),
        LineFamily::AlongZ => (options.every_column, field.columns()),
    };
    every > 0 && (line.is_multiple_of(every) || line + 1 == count)
}

/// A side of a cell as a part of a line.
#[derive(Debug, Clone, Copy)]
struct Place {
    family: LineFamily,
    line: usize,
    segment: usize,
}

impl Place {
    /// Returns the side that begins at a point.
    fn from_point(family: LineFamily, column: usize, row: usize) -> Self {
        match family {
            LineFamily::AlongX => Self { family, line: row, segment: column },
            LineFamily::AlongZ => Self { family, line: column, segment: row },
        }
    }

    /// Returns the column and the row of its first point.
    fn point(self) -> [usize; 2] {
        match self.family {
            LineFamily::AlongX => [self.segment, self.line],
            LineFamily::AlongZ => [self.line, self.segment],
        }
    }

    /// Returns the numbers of its points.
    fn numbers(self, columns: usize) -> [usize; 2] {
        let [column, row] = self.point();
        let first = row * columns + column;
        match self.family {
            LineFamily::AlongX => [first, first + 1],
            LineFamily::AlongZ => [first, first + columns],
        }
    }

    /// Returns a part of it.
    fn piece(self, range: [f64; 2], visible: bool, underside: bool) -> LinePiece {
        let Self { family, line, segment } = self;
        LinePiece { family, line, segment, range, visible, underside }
    }
}

/// Calls `f` with the segments of all lines that the options select and whose ends exist, and with the parts of them
/// between the levels.
fn segments(
    field: &HeightField,
    options: &Options,
    mut f: impl FnMut(Place, [DVec3; 2], [f64; 2]),
) {
    let (columns, rows) = (field.columns(), field.rows());
    for (family, lines, points) in
        [(LineFamily::AlongX, rows, columns), (LineFamily::AlongZ, columns, rows)]
    {
        for line in (0..lines).filter(|&l| wanted(field, options, family, l)) {
            for segment in 0..points - 1 {
                let [Some(a), Some(b)] = chain::ends(field, family, line, segment) else {
                    continue;
                };
                if let Some(part) = part_between([a.y, b.y], field.levels()) {
                    f(Place { family, line, segment }, [a, b], part);
                }
            }
        }
    }
}

/// Reports a piece and keeps it.
fn keep(piece: LinePiece, pieces: &mut Vec<LinePiece>, t: &mut impl Tracer<Step>) {
    t.step(|| Step::Piece(piece));
    pieces.push(piece);
}

fn everything(
    field: &HeightField,
    options: &Options,
    pieces: &mut Vec<LinePiece>,
    t: &mut impl Tracer<Step>,
) {
    segments(field, options, |place, _, part| keep(place.piece(part, true, false), pieces, t));
}

/// Finds the visible pieces right above or below the eye, where upright pictures have no place. There only one cell
/// hides, and not its own sides: everything that no picture held is visible.
fn at_the_foot(
    field: &HeightField,
    middle: DVec3,
    eye: DVec3,
    pictures: &[Picture],
    options: &Options,
    pieces: &mut Vec<LinePiece>,
    t: &mut impl Tracer<Step>,
) {
    let place = |v: f64, [first, last]: [f64; 2], points: usize| {
        (v - first) / (last - first) * (points - 1) as f64
    };
    let column = place(eye.x + middle.x, field.x_range(), field.columns());
    let row = place(eye.z + middle.z, field.z_range(), field.rows());
    // The sides of the cell below the eye, and of its neighbours for what rounding puts next door.
    let near = |i: usize, at: f64| (i as f64 - at).abs() <= 2.0;
    segments(field, options, |place, ends, between| {
        let [c, r] = place.point();
        if !near(c, column) || !near(r, row) {
            return;
        }
        let numbers = place.numbers(field.columns());
        let ends = ends.map(|p| p - middle);
        let parts = pictures.iter().filter_map(|p| p.part(numbers, ends, between));
        let mut held: Vec<[f64; 2]> = parts.map(|p| p.range).collect();
        held.compact_sort_by(|a, b| a[0].total_cmp(&b[0]));
        for [from, to] in gaps(&held) {
            let range = [from.max(between[0]), to.min(between[1])];
            if range[0] < range[1] {
                keep(place.piece(range, true, false), pieces, t);
            }
        }
    });
}

/// Returns the parts of 0 … 1 outside sorted ranges.
fn gaps(ranges: &[[f64; 2]]) -> Vec<[f64; 2]> {
    /// Shorter parts of a segment are rounding.
    const SHORTEST: f64 = 1e-9;
    let (mut gaps, mut at) = (Vec::new(), 0.0);
    for &[from, to] in ranges.iter().chain(&[[1.0, 1.0]]) {
        if from - at > SHORTEST {
            gaps.push([at, from]);
        }
        at = to.max(at);
    }
    gaps
}

/// The pass over the cells for one upright picture.
struct Walk<'a> {
    field: &'a HeightField,
    middle: DVec3,
    /// The levels of the field, relative to the middle.
    levels: Option<[f64; 2]>,
    sight: Sight,
    picture: &'a Picture,
    options: &'a Options,
    pieces: &'a mut Vec<LinePiece>,
    horizon: Horizon,
    /// Bits of the segments that are done, by the number of their first point: bit 0 along x, bit 1
    /// along z.
    done: Vec<u8>,
    hidden: Vec<[f64; 2]>,
    polygon: Vec<DVec2>,
    ring: Vec<DVec3>,
}

/// Strips per row and column of the field, so that one cell meets few of them.
const STRIPS: usize = 2;

impl<'a> Walk<'a> {
    fn new(
        field: &'a HeightField,
        middle: DVec3,
        sight: Sight,
        picture: &'a Picture,
        options: &'a Options,
        pieces: &'a mut Vec<LinePiece>,
    ) -> Self {
        let [min, max] = picture.corners();
        let buckets = (field.columns() + field.rows()).saturating_mul(STRIPS).min(1 << 16);
        Self {
            field,
            middle,
            levels: field.levels().map(|levels| levels.map(|y| y - middle.y)),
            sight,
            picture,
            options,
            pieces,
            horizon: Horizon::new(min, max, buckets),
            done: vec![0; field.columns() * field.rows()],
            hidden: Vec::new(),
            polygon: Vec::new(),
            ring: Vec::new(),
        }
    }

    fn run(mut self, t: &mut impl Tracer<Step>) {
        let columns = self.sight.order(self.field, 0, self.middle.x);
        for row in self.sight.order(self.field, 2, self.middle.z) {
            for &column in &columns {
                match self.field.cell(column, row) {
                    Some(_) => self.cell(column, row, t),
                    None => self.hole(column, row, t),
                }
            }
        }
    }

    /// Returns the number of a cell's corner, and its place relative to the middle.
    fn corner(&self, column: usize, row: usize, k: usize) -> (usize, DVec3) {
        let (column, row) = (column + (k & 1), row + (k >> 1));
        // Only requested where it is there.
        let point = self.field.point(column, row).unwrap_or(self.middle);
        (row * self.field.columns() + column, point - self.middle)
    }

    fn cell(&mut self, column: usize, row: usize, t: &mut impl Tracer<Step>) {
        let Some(diagonal) = self.field.cell(column, row) else { return };
        let corners: [(usize, DVec3); 4] = std::array::from_fn(|k| self.corner(column, row, k));
        let [first, second] = diagonal.triangles();
        // The diagonal is the side that both have; the first triangle's other corner tells its side.
        let ends = shared(first, second);
        let [from, to] = ends.map(|k| corners[k].1);
        let apex = first.into_iter().find(|k| !ends.contains(k)).unwrap_or(0);
        let line = DVec2::new(to.x - from.x, to.z - from.z);
        let p = corners[apex].1 - from;
        let first_is_near =
            line.perp_dot(DVec2::new(p.x, p.z)) * side_of_eye(self.sight, from, to) >= 0.0;
        let order = if first_is_near { [first, second] } else { [second, first] };
        for triangle in order {
            self.triangle(column, row, triangle, &corners, t);
        }
    }

    fn triangle(
        &mut self,
        column: usize,
        row: usize,
        triangle: [usize; 3],
        corners: &[(usize, DVec3); 4],
        t: &mut impl Tracer<Step>,
    ) {
        let numbers = triangle.map(|k| corners[k].0);
        let points = triangle.map(|k| corners[k].1);
        let mut polygon = std::mem::take(&mut self.polygon);
        if !self.picture.triangle(numbers, &mut polygon) {
            self.ring.clear();
            self.ring.extend(points);
            cut(&mut self.ring, self.levels);
            self.picture.polygon(&self.ring, &mut polygon);
        }
        let underside = double_area(&polygon) < 0.0;
        for (family, ends) in SIDES {
            if ends.iter().all(|k| triangle.contains(k)) {
                self.side(column, row, family, ends, underside, t);
            }
        }
        if polygon.len() > 2 {
            self.horizon.cover(&polygon);
            t.step(|| Step::Cover(points.map(|p| p + self.middle)));
        }
        self.polygon = polygon;
    }

    /// Draws the sides of a missing cell that belong to no other cell, except for those that would be attached to the
    /// surface by one end only.
    fn hole(&mut self, column: usize, row: usize, t: &mut impl Tracer<Step>) {
        let cell = |c: Option<usize>, r: Option<usize>| self.field.cell(c?, r?);
        let (c, r) = (Some(column), Some(row));
        let beyond = [
            cell(c, row.checked_sub(1)),
            cell(c, Some(row + 1)),
            cell(column.checked_sub(1), r),
            cell(Some(column + 1), r),
        ];
        for ((family, ends), beyond) in SIDES.into_iter().zip(beyond) {
            let there = |k: &usize| self.field.height(column + (k & 1), row + (k >> 1)).is_some();
            let hangs = || ends.iter().any(|k| self.holds(column + (k & 1), row + (k >> 1)));
            if beyond.is_none() && ends.iter().all(there) && !hangs() {
                self.side(column, row, family, ends, false, t);
            }
        }
    }

    /// Returns whether a point is a corner of a cell that is there.
    fn holds(&self, column: usize, row: usize) -> bool {
        let cell =
            |c: usize, r: usize| self.field.cell(column.checked_sub(c)?, row.checked_sub(r)?);
        (0..4).any(|k| cell(k & 1, k >> 1).is_some())
    }

    /// Draws a side of a cell, unless that is done.
    fn side(
        &mut self,
        column: usize,
        row: usize,
        family: LineFamily,
        ends: [usize; 2],
        underside: bool,
        t: &mut impl Tracer<Step>,
    ) {
        let [(a, p), (b, q)] = ends.map(|k| self.corner(column, row, k));
        let place = Place::from_point(family, column + (ends[0] & 1), row + (ends[0] >> 1));
        let bit = if family == LineFamily::AlongX { 1 } else { 2 };
        if self.done[a] & bit != 0 || !wanted(self.field, self.options, family, place.line) {
            return;
        }
        self.done[a] |= bit;
        let between = part_between([p.y, q.y], self.levels);
        let part = between.and_then(|between| self.picture.part([a, b], [p, q], between));
        let Some(part) = part else { return };
        let mut hidden = std::mem::take(&mut self.hidden);
        self.horizon.hidden(part.ends[0], part.ends[1], &mut hidden);
        let piece_of = |range: [f64; 2], visible: bool| {
            place.piece(range.map(|s| part.along(s)), visible, underside)
        };
        let seen = gaps(&hidden).into_iter().map(|r| piece_of(r, true));
        let unseen = hidden.iter().filter(|_| self.options.hidden).map(|&r| piece_of(r, false));
        for piece in seen.chain(unseen) {
            keep(piece, self.pieces, t);
        }
        self.hidden = hidden;
    }
}

/// Returns the two corners that both triangles have.
fn shared(first: [usize; 3], second: [usize; 3]) -> [usize; 2] {
    let mut both = first.into_iter().filter(|k| second.contains(k));
    [both.next().unwrap_or(0), both.next().unwrap_or(0)]
}

/// Returns twice the area, positive where the corners run counter-clockwise (y up).
fn double_area(polygon: &[DVec2]) -> f64 {
    let Some((&origin, rest)) = polygon.split_first() else { return 0.0 };
    rest.windows(2).map(|w| (w[0] - origin).perp_dot(w[1] - origin)).sum()
}
