//! Lines, polygons and seed fills in pixels.

use super::{near, p};
use durer::curve::Contours;
use durer::math::{DVec2, DVec3, IVec2};
use durer::raster::line::{LineRasterizer, Options, Step as Pixel, bresenham};
use durer::raster::polygon::edge_table::{self, Step as Row, TableEdge};
use durer::raster::seed_fill::{
    Connectivity, FillRun, Options as How, SeedFill, Step as Filling, boundary_fill,
};
use durer::raster::{interpolate, polygon};
use durer::target::Pixels;
use durer::trace::{NoTrace, Recorder};

fn line(method: LineRasterizer, a: (i32, i32), b: (i32, i32)) -> Vec<Pixel> {
    let mut steps = Recorder::default();
    method.draw(a.into(), b.into(), &Options::default(), |_| {}, &mut steps);
    steps.into_steps()
}

fn places(steps: &[Pixel]) -> Vec<(i32, i32)> {
    steps.iter().map(|step| (step.pixel.x, step.pixel.y)).collect()
}

#[test]
fn bresenhams_e_decides_the_row() {
    let steps = line(LineRasterizer::Bresenham, (0, 0), (5, 3));
    let e: Vec<i64> = steps.iter().map(|step| step.e).collect();
    assert_eq!(e[..5], [1, -3, 3, -1, 5]);
    assert_eq!(places(&steps), [(0, 0), (1, 1), (2, 1), (3, 2), (4, 2), (5, 3)]);
}

#[test]
fn every_slope_follows_its_e_in_all_octants_and_both_directions() {
    for (dx, dy) in (-9..=9).flat_map(|dx| (-9..=9).map(move |dy| (dx, dy))) {
        let steps = line(LineRasterizer::Bresenham, (3, -2), (3 + dx, dy - 2));
        assert_eq!(places(&steps)[0], (3, -2), "from where the caller begins");
        let (long, short) = (i64::from(dx.abs().max(dy.abs())), i64::from(dx.abs().min(dy.abs())));
        for pair in steps.windows(2) {
            let by = pair[1].pixel - pair[0].pixel;
            let across = if dx.abs() >= dy.abs() { by.y } else { by.x };
            let [e, next] = [pair[0].e, pair[1].e];
            assert!(if across == 0 { e <= 0 } else { e >= 0 }, "{dx} {dy}: {e}");
            let added = if across == 0 { 2 * short } else { 2 * short - 2 * long };
            assert_eq!(next, e + added, "{dx} {dy}");
        }
        assert_eq!(steps[0].e, 2 * short - long);
        // The lit pixels are those of the steps.
        let (mut lit, mut reported) = (Vec::new(), places(&steps));
        let (from, to) = (IVec2::new(3, -2), IVec2::new(3 + dx, dy - 2));
        let options = Default::default();
        let plot = |p: IVec2| lit.push((p.x, p.y));
        LineRasterizer::Bresenham.draw(from, to, &options, plot, &mut NoTrace);
        lit.sort_unstable();
        reported.sort_unstable();
        assert_eq!(lit, reported, "{dx} {dy}");
    }
}

#[test]
fn the_analyzer_adds_the_slope_and_rounds() {
    let steps = line(LineRasterizer::Dda, (0, 0), (5, 3));
    for (step, y) in steps.iter().zip([0.0, 0.6, 1.2, 1.8, 2.4, 3.0]) {
        assert!(near(step.across, y));
        assert_eq!(step.pixel.y, (y + 0.5_f64).floor() as i32);
    }
    // For lines steeper than the diagonal, y is stepped and 1/m added.
    let steep = line(LineRasterizer::Dda, (0, 0), (3, 5));
    assert!(near(steep[1].across, 0.6) && steep[1].pixel == IVec2::new(1, 1));
}

#[test]
fn a_clipped_line_lights_the_pixels_of_the_whole_one() {
    let (a, b) = (IVec2::new(-17, -9), IVec2::new(40, 22));
    let (low, high) = (IVec2::ZERO, IVec2::splat(15));
    let draw = |options: &Options| {
        let mut steps = Recorder::default();
        bresenham::draw(a, b, options, |_| {}, &mut steps);
        steps.into_steps()
    };
    let mut whole = draw(&Options::default());
    whole.retain(|s| s.pixel.cmpge(low).all() && s.pixel.cmple(high).all());
    // The same pixels, entered with the same E.
    assert_eq!(draw(&Options { window: Some((low, high)) }), whole);
    assert!(whole.len() > 10);
}

/// Returns a triangle whose corners are centres of pixels.
fn triangle() -> Contours {
    Contours::polygon([(2.5, 1.5), (10.5, 4.5), (4.5, 6.5)].map(DVec2::from))
}

#[test]
fn edge_tables_have_the_entries_of_the_lecture() {
    let mut steps = Recorder::default();
    let options = polygon::Options::default();
    edge_table::fill(&triangle(), 16, 16, &options, |_| {}, &mut steps);
    // y_min, y_max, x, Δx/Δy as whole pixels and remainder.
    let entry = |edge: &TableEdge| {
        let rest = edge.remainder as f64 / edge.whole as f64;
        (edge.rows, edge.x, edge.step, (rest * 15.0).round() as i32)
    };
    let mut table: Vec<_> = steps
        .steps()
        .iter()
        .filter_map(|step| if let Row::Table(edge) = step { Some(entry(edge)) } else { None })
        .collect();
    table.sort_unstable();
    // 8/3 = 2 + 2/3, 2/5, −6/2 = −3; the remainders in fifteenths.
    assert_eq!(table, [((1, 4), 2, 2, 10), ((1, 6), 2, 0, 6), ((4, 6), 10, -3, 0)]);
    let active = |row| -> Vec<(i32, f64)> {
        let of = |step: &Row| match *step {
            Row::Active { y, edge } if y == row => Some((edge.rows.1, edge.crossing())),
            _ => None,
        };
        steps.steps().iter().filter_map(of).collect()
    };
    let expected = [
        (1, vec![2.0, 2.0]),
        (2, vec![2.4, 2.0 + 8.0 / 3.0]),
        (3, vec![2.8, 2.0 + 16.0 / 3.0]),
        // The long edge ends at its y_max; the one below begins at its y_min.
        (4, vec![3.2, 10.0]),
        (5, vec![3.6, 7.0]),
        (6, vec![]),
    ];
    for (row, crossings) in expected {
        let found = active(row);
        assert_eq!(found.len(), crossings.len(), "{row}: {found:?}");
        let close = found.iter().zip(&crossings).all(|((_, x), y)| (x - y).abs() < 1e-4);
        assert!(close, "{row}: {found:?}");
    }
    assert_eq!(active(4).iter().map(|(y_max, _)| *y_max).collect::<Vec<_>>(), [6, 6]);
}

#[test]
fn accumulators_step_without_dividing() {
    let mut steps = Recorder::default();
    let options = polygon::Options::default();
    edge_table::fill(&triangle(), 16, 16, &options, |_| {}, &mut steps);
    let long: Vec<TableEdge> = steps
        .steps()
        .iter()
        .filter_map(|step| match *step {
            Row::Active { edge, .. } if edge.rows == (1, 4) => Some(edge),
            _ => None,
        })
        .collect();
    for pair in long.windows(2) {
        let sum = pair[0].error + pair[0].remainder;
        let carry = i64::from(sum >= pair[0].whole);
        assert_eq!(pair[1].error, sum - carry * pair[0].whole);
        assert_eq!(pair[1].x, pair[0].x + pair[0].step + carry);
    }
    assert_eq!(long.len(), 3);
}

#[test]
fn filling_between_bresenhams_borders_is_wrong_at_extrema() {
    let corners = [(2, 1), (10, 4), (4, 6)];
    let mut marked = [0; 8];
    for (a, b) in [(0, 1), (1, 2), (2, 0)] {
        let mut pixels = places(&line(LineRasterizer::Bresenham, corners[a], corners[b]));
        pixels.dedup_by_key(|p| p.1);
        pixels.iter().for_each(|p| marked[p.1 as usize] += usize::from(*p != corners[a]));
    }
    // A single mark in the row of the upper corner would fill everything to its right.
    assert_eq!((marked[1], marked[6]), (1, 1));
    let mut rows = Vec::new();
    let options = polygon::Options::default();
    edge_table::fill(&triangle(), 16, 16, &options, |s| rows.push((s.y, s.x0, s.x1)), &mut NoTrace);
    assert_eq!(rows, [(2, 3, 5), (3, 3, 8), (4, 4, 10), (5, 4, 7)]);
}

#[test]
fn squares_that_share_edges_light_each_pixel_once() {
    let mut lit = vec![0; 16 * 16];
    for (row, column) in (0..4).flat_map(|row| (0..4).map(move |column| (row, column))) {
        // Off the grid by half a pixel: all edges pass through pixel centres.
        let at = |x: i32, y: i32| p(f64::from(x) * 3.0 + 1.5, f64::from(y) * 3.0 + 1.5);
        let (c, r) = (column, row);
        let ring = [at(c, r), at(c + 1, r), at(c + 1, r + 1), at(c, r + 1)];
        let emit = |span: durer::raster::Span| {
            (span.x0..span.x1).for_each(|x| lit[(span.y * 16 + x) as usize] += 1);
        };
        let options = polygon::Options::default();
        edge_table::fill(&Contours::polygon(ring), 16, 16, &options, emit, &mut NoTrace);
    }
    assert!(lit.iter().all(|n| *n <= 1));
    assert_eq!(lit.iter().sum::<i32>(), 144);
    // Left and upper borders belong to a square, right and lower borders do not.
    assert_eq!([lit[16 + 1], lit[13 * 16 + 13]], [1, 0]);
}

#[test]
fn boundary_fill_stops_at_what_is_filled() {
    // 0 0 F 0 0 B 0
    let row = || Pixels::from_data(7, 1, vec![0_u8, 0, 7, 0, 0, 9, 0]).unwrap();
    for method in SeedFill::ALL {
        let how = How { stop_at_value: true, ..How::default() };
        let mut image = row();
        let count =
            boundary_fill(&mut image, (0, 0), 7, 9, 0, *method, &how, &mut NoTrace).unwrap();
        assert_eq!((count, image.data()), (2, &[7, 7, 7, 0, 0, 9, 0][..]), "{method}");
        let mut image = row();
        let all = How::default();
        let count = boundary_fill(&mut image, (0, 0), 7, 9, 0, *method, &all, &mut NoTrace);
        assert_eq!(count, Ok(5));
    }
}

/// The order of the recursive form, written as in textbooks.
fn recursive(image: &mut Pixels<u8>, x: i64, y: i64, order: &mut Vec<(u32, u32)>) {
    let (Ok(column), Ok(row)) = (u32::try_from(x), u32::try_from(y)) else { return };
    let Some(current) = image.get(column, row) else { return };
    if current != 9 && current != 7 {
        image.set(column, row, 7);
        order.push((column, row));
        for (dx, dy) in [(1, 0), (-1, 0), (0, 1), (0, -1)] {
            recursive(image, x + dx, y + dy, order);
        }
    }
}

#[test]
fn a_stack_of_pixels_keeps_the_order_of_the_recursion() {
    let rows = ["..#..", ".....", ".###.", "....."];
    let data = rows.iter().flat_map(|r| r.bytes().map(|b| if b == b'#' { 9 } else { 0 })).collect();
    let image = Pixels::from_data(5, 4, data).unwrap();
    let how = How { connectivity: Connectivity::Four, stop_at_value: true };
    let mut steps: Recorder<Filling> = Recorder::default();
    let seed = (1, 1);
    boundary_fill(&mut image.clone(), seed, 7, 9, 0, SeedFill::Naive, &how, &mut steps).unwrap();
    let mut order = Vec::new();
    recursive(&mut image.clone(), 1, 1, &mut order);
    let runs = |steps: &[Filling]| steps.iter().filter_map(Filling::filled).collect::<Vec<_>>();
    let pixel = |run: &FillRun| (run.x0 as u32, run.y as u32);
    let found: Vec<(u32, u32)> = runs(steps.steps()).iter().map(pixel).collect();
    assert_eq!(found, order);
    assert_eq!(order[..3], [(1, 1), (2, 1), (3, 1)]);
    // Spans take fewer iterations and less memory.
    let mut spans: Recorder<Filling> = Recorder::default();
    boundary_fill(&mut image.clone(), seed, 7, 9, 0, SeedFill::Spans, &how, &mut spans).unwrap();
    let deepest = |steps: &[Filling]| {
        let waiting =
            |s: &Filling| if let Filling::Fill { waiting, .. } = s { *waiting } else { 0 };
        steps.iter().map(waiting).max().unwrap_or(0)
    };
    assert!(runs(spans.steps()).len() * 2 < found.len());
    assert!(deepest(spans.steps()) * 3 < deepest(steps.steps()));
}

#[test]
fn barycentric_coordinates_have_three_forms() {
    let corners = [(0.0, 0.0, 0.0), (4.0, 0.0, 1.0), (0.0, 3.0, 2.0)].map(DVec3::from);
    let weights = [0.2, 0.3, 0.5];
    let point = interpolate::blend(weights, corners);
    assert!((point - DVec3::new(1.2, 1.5, 1.3)).length() < 1e-15);
    let flat = corners.map(|c| p(c.x, c.y));
    let area = interpolate::barycentric_2d(flat, p(point.x, point.y)).unwrap();
    let space = interpolate::barycentric_3d(corners, point).unwrap();
    // The 2 × 2 system: β (b − a) + γ (c − a) = P − a, by Cramer's rule.
    let [u, v, w] = [flat[1] - flat[0], flat[2] - flat[0], p(point.x, point.y) - flat[0]];
    let (beta, gamma) = (w.perp_dot(v) / u.perp_dot(v), u.perp_dot(w) / u.perp_dot(v));
    let system = [1.0 - beta - gamma, beta, gamma];
    for form in [area, space, system] {
        assert!(form.iter().zip(weights).all(|(a, b)| near(*a, b)), "{form:?}");
    }
    assert_eq!(interpolate::doubled_area(flat) / 2.0, 6.0);
}

#[test]
fn picture_memory_wraps_around_where_nothing_clips() {
    // Rows follow each other in memory: the next row begins beyond the right border.
    let (width, height) = (8, 4);
    let mut memory = vec![0_u8; width * height];
    for step in line(LineRasterizer::Bresenham, (5, 1), (10, 1)) {
        memory[step.pixel.y as usize * width + step.pixel.x as usize] = 1;
    }
    assert_eq!(memory[width + 5..2 * width], [1, 1, 1]);
    assert_eq!(memory[2 * width..2 * width + 4], [1, 1, 1, 0], "what should not be seen");
    let mut image = Pixels::new(8, 4, 0_u8);
    let window = Some((IVec2::ZERO, IVec2::new(7, 3)));
    let plot = |pixel: IVec2| image.set(pixel.x as u32, pixel.y as u32, 1);
    bresenham::draw((5, 1).into(), (10, 1).into(), &Options { window }, plot, &mut NoTrace);
    assert_eq!(image.data().iter().filter(|v| **v == 1).count(), 3);
}
