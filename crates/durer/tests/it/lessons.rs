//! Numbers shown by lessons, compared with those of the lectures.

use durer::explain::{self, Frame, Input, Language, Options, Value};
use durer::math::DVec2;

fn frames(name: &str, example: &str) -> Vec<Frame> {
    explain::run(name, &Input::Example(example.to_owned()), &Options::default(), 5_000).unwrap()
}

/// Returns one value from every caption that has it.
fn values(frames: &[Frame], name: &str) -> Vec<Value> {
    let all = frames.iter().flat_map(|frame| &frame.caption.values);
    all.filter(|(own, _)| *own == name).map(|(_, value)| value.clone()).collect()
}

fn numbers(frames: &[Frame], name: &str) -> Vec<f64> {
    let number = |value: &Value| if let Value::Number(x) = value { *x } else { f64::NAN };
    values(frames, name).iter().map(number).collect()
}

/// Returns the names of a table's rows and their cells.
fn rows(frame: &Frame) -> Vec<String> {
    let text = |value: &Value| value.text(Language::English);
    let row = |row: &durer::explain::Row| {
        let cells: Vec<String> = row.cells.iter().map(|cell| text(&cell.value)).collect();
        format!("{}: {}", text(&row.name), cells.join(" "))
    };
    frame.table.rows.iter().map(row).collect()
}

#[test]
fn bresenham_shows_the_decision_variable_of_the_lecture() {
    let frames = frames("bresenham", "lecture");
    assert_eq!(numbers(&frames, "e"), [1.0, -3.0, 3.0, -1.0, 5.0]);
    assert_eq!(numbers(&frames, "sum"), [-3.0, 3.0, -1.0, 5.0, 1.0]);
    assert_eq!(frames.last().unwrap().kind, "last");
    let text = frames[1].text(Language::German);
    assert!(text.starts_with("Pixel (1; 1). E = −3: ") && text.ends_with("−3 + 6 = 3."), "{text}");
}

#[test]
fn circles_and_horizons_show_the_numbers_of_the_lecture() {
    let circle = frames("midpoint-circle", "radius-10");
    assert_eq!(numbers(&circle, "d"), [-9.0, -6.0, -1.0, 6.0, -3.0, 8.0, 5.0, 6.0]);
    let horizon = frames("horizon-curves", "lecture");
    let at = [DVec2::new(0.5, 1.0), DVec2::new(1.5, 1.0)].map(Value::Point);
    assert_eq!(values(&horizon, "at"), at);
}

#[test]
fn edges_go_from_one_table_to_the_other() {
    let frames = frames("edge-table", "triangle");
    let kinds: Vec<&str> = frames.iter().take(6).map(|frame| frame.kind).collect();
    assert_eq!(kinds, ["table", "table", "table", "enter", "enter", "active"]);
    assert_eq!(
        rows(&frames[2]),
        ["ET 1: A: 9 2 0.375 0.687", "ET 1: B: 3 4 4 0.5", "ET 3: C: 9 10 −0.833 0.083"]
    );
    assert_eq!(rows(&frames[4])[..2], ["ET 3: C: 9 10 −0.833 0.083", "AET A: 9 2 0.375 0.687"]);
}

#[test]
fn values_of_new_vertices_show_the_error_of_the_screen() {
    let cuts = frames("clip-attributes", "one-to-three");
    let first = |name| numbers(&cuts, name)[0];
    // d = 1 and −3; w = 1 and 3; u = 0 and 1.
    let found = ["t", "value", "s", "wrong", "error"].map(first);
    assert_eq!(found, [0.25, 0.25, 0.5, 0.5, 0.25]);
    let error = numbers(&frames("clip-attributes", "same-w"), "error");
    assert_eq!(error, [0.0; 0]);
    let behind = frames("clip-attributes", "behind-the-eye");
    assert!(behind.iter().any(|frame| frame.text(Language::English).contains("w = −2 ≤ 0")));
}

#[test]
fn points_show_their_square_and_their_area() {
    let squares = frames("points", "odd-and-even");
    let centers = [DVec2::splat(3.5), DVec2::new(9.0, 4.0)].map(Value::Point);
    assert_eq!(
        (numbers(&squares, "n"), values(&squares, "center")),
        (vec![3.0, 4.0], centers.to_vec())
    );
    let outside = frames("points", "clipped");
    assert_eq!(outside.iter().filter(|frame| frame.kind == "lit").count(), 9);
    assert_eq!(outside.last().unwrap().kind, "outside");
    // Sizes as they were meant, not as their ends round.
    assert_eq!(numbers(&frames("points", "rounded"), "n"), [1.0, 1.0, 3.0]);
    let sums = numbers(&frames("smooth-points", "middle"), "sum");
    assert!((sums.last().unwrap() - std::f64::consts::PI * 2.25).abs() < 1e-12, "{sums:?}");
}

#[test]
fn a_stack_of_pixels_is_shown_with_its_top_above() {
    let frames = frames("naive", "room");
    assert_eq!(rows(&frames[0]), [""; 0]);
    assert_eq!(rows(&frames[4]), ["4: (3, 1)", "3: (1, 1)", "2: (2, 2)", "1: (2, 0)"]);
    assert_eq!(
        frames[5].text(Language::English),
        "Pixel (3, 1) is popped, belongs to the region and is filled; 3 wait."
    );
}

#[test]
fn spans_are_decided_by_depths_at_their_ends() {
    let frames = frames("watkins", "near-first");
    let first: Vec<f64> = numbers(&frames, "z0");
    assert!(first.iter().all(|z| *z == 1.0 || *z == 3.0), "{first:?}");
    assert!(
        frames
            .iter()
            .any(|frame| frame.text(Language::English).contains("2 in: A is nearest at both ends"))
    );
}

#[test]
fn every_algorithm_has_a_lesson_or_a_reason() {
    let has_lesson = |name: &str, title: &str| {
        explain::lessons().any(|lesson| (lesson.info.name, lesson.info.title) == (name, title))
    };
    for info in explain::ALGORITHMS {
        let reason = explain::WITHOUT_LESSON.iter().find(|(own, _)| own == info);
        let explained = has_lesson(info.name, info.title);
        assert!(explained || reason.is_some(), "{}: neither lesson nor reason", info.title);
        assert!(!explained || reason.is_none(), "{}: take it out of WITHOUT_LESSON", info.title);
    }
    let known = |info: &durer::info::Info| explain::ALGORITHMS.contains(&info);
    assert!(explain::WITHOUT_LESSON.iter().all(|(info, why)| known(info) && !why.is_empty()));
    // The list never grows.
    assert!(explain::WITHOUT_LESSON.len() <= 16);
}

#[test]
fn names_of_algorithms_are_unique() {
    let mut names: Vec<&str> = explain::ALGORITHMS.iter().map(|info| info.name).collect();
    let count = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), count);
}

#[test]
fn cells_show_cover_and_area_of_the_page() {
    let frames = frames("cell-sums", "strip");
    let pieces: Vec<&Frame> = frames.iter().filter(|frame| frame.kind == "piece").collect();
    let pair = |name| numbers(&[pieces[0].clone(), pieces[2].clone()], name);
    assert_eq!((pair("cover"), pair("area")), (vec![1.0, -1.0], vec![0.75, -0.5]));
    let coverage = numbers(&frames, "coverage");
    assert_eq!(coverage, [191.0, 255.0, 128.0, 191.0, 255.0, 128.0]);
}

#[test]
fn areas_of_faces_sum_to_one_where_they_meet() {
    let frames = frames("partition", "fan");
    let sums = numbers(&frames, "sum");
    assert!(sums.iter().all(|sum| (0.0..=1.0).contains(sum)));
    let full = frames.iter().filter(|frame| frame.text(Language::English).contains("exactly 1"));
    assert_eq!(full.count(), 2);
}

#[test]
fn ears_of_the_page_are_cut_off_in_its_order() {
    let frames = frames("triangulate", "arrow");
    assert_eq!(rows(frames.last().unwrap()), ["1: B C D 4", "2: D E A 4", "3: D A B 2"]);
    assert_eq!(numbers(&frames, "sum"), [10.0]);
    // A and B have D in their triangles; D is reflex once C is cut off.
    let kinds: Vec<&str> = frames.iter().skip(5).map(|frame| frame.kind).collect();
    assert_eq!(kinds, ["blocked", "blocked", "triangle", "reflex", "triangle", "triangle"]);
    assert_eq!(numbers(&frames, "cross"), [8.0, -4.0, 8.0]);
}

#[test]
fn patterns_go_on_round_corners() {
    let frames = frames("line-pattern", "corner");
    let bits = numbers(&frames, "bit");
    // Eleven steps to the corner, the last pixel of one line and the first of the other.
    let expected: Vec<f64> = (0..=11).chain(11..=17).map(|step| f64::from(step % 16)).collect();
    assert_eq!(bits, expected);
}

#[test]
fn strokes_show_miters_beyond_the_limit_as_bevels() {
    let joins = |example: &str| {
        let frames = frames("stroke", example);
        numbers(&frames, "distance").len()
    };
    // One point for the miter, two for the bevel.
    assert_eq!(joins("sharp"), 2);
    assert!(joins("joins") > 4);
}

#[test]
fn rows_of_depths_hold_the_nearest_triangle() {
    let frames = frames("scan-line-z", "near-first");
    let depths = numbers(&frames, "z");
    assert!(!depths.is_empty() && depths.iter().all(|z| *z == 1.0 || *z == 3.0), "{depths:?}");
    let last = frames.iter().rfind(|frame| frame.kind == "write").unwrap();
    assert_eq!(last.text(Language::English), "Pixel 3: z = 3 < ∞, so B2 is entered.");
}

#[test]
fn rays_show_origin_direction_and_t() {
    let frames = frames("ray", "shadow");
    // The middle pixel looks straight ahead at the plate, at depth 3.
    let middle = frames.iter().find(|frame| numbers(&[(*frame).clone()], "x") == [3.0]).unwrap();
    let text = middle.text(Language::English);
    assert!(text.starts_with("Pixel 3: D = (0, 0, −1). The nearest face along O + t · D is B"));
    assert!(text.ends_with("t = 11.7, at (6.5, 2.5, −3)."), "{text}");
    let dark =
        frames.iter().filter(|frame| frame.text(Language::English).contains("in the way at"));
    assert_eq!(dark.count(), 1);
}

#[test]
fn invisibility_changes_where_faces_begin_and_end() {
    let frames = frames("hidden-line", "strip");
    let strip = frames[1].text(Language::English);
    assert!(strip.ends_with("Q changes at t = 0.2 0.4 0.6 0.8 and is 0 1 2 1 0."), "{strip}");
    let hidden = frames.iter().filter(|f| f.text(Language::English).contains("nothing of it"));
    assert_eq!(hidden.count(), 4);
}

#[test]
fn fragments_are_dropped_by_every_test() {
    let frames = frames("fragment-operations", "all-tests");
    let dropped = |kind: &str| {
        let of_kind = frames.iter().filter(|frame| frame.kind == kind);
        of_kind.filter(|frame| frame.text(Language::English).ends_with("dropped.")).count()
    };
    assert_eq!(["scissor", "alpha", "stencil", "depth"].map(dropped), [1, 3, 2, 2]);
    // Half of the destination, half of the plate, in linear light.
    assert!(frames.iter().any(|frame| frame.kind == "blend"));
}

#[test]
fn simplification_shows_distances_and_triangles() {
    let kept = frames("douglas-peucker", "spike");
    let last = kept.iter().rfind(|frame| frame.kind == "kept").unwrap();
    assert!(last.text(Language::English).contains("so it stays and divides the part"));
    let sides = numbers(&frames("visvalingam", "coast"), "side");
    assert!(sides.windows(2).all(|pair| pair[0] <= pair[1]) && sides.len() > 3, "{sides:?}");
    let shared = numbers(&frames("coverage", "border"), "count");
    assert!(shared.iter().all(|count| *count == 2.0), "{shared:?}");
    let island = values(&frames("coverage", "island"), "at");
    assert!(!island.contains(&Value::Point(DVec2::new(4.2, 3.6))), "{island:?}");
}

#[test]
fn squares_without_room_are_dropped() {
    let found = frames("interior-point", "hook");
    let last = numbers(&found, "distance").last().copied().unwrap();
    // The corner at (0, 0) has the most room: r + r√2/… to the notch's corner, and no less than 1.75.
    assert!((1.75..2.5).contains(&last), "{last}");
    assert!(found.iter().any(|f| f.text(Language::English).contains("can hold no more than")));
}

#[test]
fn points_behind_what_the_light_sees_are_dark() {
    let frames = frames("shadow-map", "plate");
    let shares: Vec<String> = (frames.iter())
        .filter(|frame| frame.kind == "share")
        .map(|frame| frame.text(Language::English))
        .collect();
    let count = |start: &str| shares.iter().filter(|text| text.starts_with(start)).count();
    let kinds = [count("All the light"), count("No light"), count("At the edge")];
    assert!(kinds.iter().all(|count| *count > 0), "{kinds:?}");
    // The depth of a slope within a texel is its own: only the bias keeps it lit.
    let slope = self::frames("shadow-map", "slope");
    let dark = |frame: &&Frame| frame.text(Language::English).starts_with("No light");
    assert!(
        slope
            .iter()
            .take_while(|frame| !frame.text(Language::English).contains("of B"))
            .all(|f| !dark(&f))
    );
}

#[test]
fn patches_are_evaluated_row_by_row() {
    let frames = frames("evaluator", "saddle");
    let third =
        frames.iter().find(|frame| frame.text(Language::English).starts_with("Point 1|1: across"));
    let text = third.unwrap().text(Language::English);
    assert!(text.ends_with("v = 0.333 gives (1.333, 1.333, 0.889)."), "{text}");
}

#[test]
fn picks_are_sorted_by_depth() {
    let frames = frames("pick", "stack");
    let last = frames.last().unwrap().text(Language::English);
    assert!(last.starts_with("3 hits, sorted by depth: B"), "{last}");
    assert!(
        frames.iter().any(|f| f.text(Language::English).starts_with("The box of D is outside"))
    );
}

#[test]
fn near_pixels_move_further_and_open_a_hole() {
    let frames = frames("forward-warp", "hole");
    let moved = |name: &str| -> Vec<f64> {
        let number = |f: &Frame, name| numbers(std::slice::from_ref(f), name)[0];
        let of =
            frames.iter().filter(|f| f.text(Language::English).contains(&format!(", {name}, ")));
        of.map(|f| number(f, "x") - number(f, "to")).collect()
    };
    let (wall, plate) = (moved("A"), moved("B"));
    let largest = |all: &[f64]| all.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    assert!(!wall.is_empty() && !plate.is_empty());
    assert!(plate.iter().all(|shift| *shift > largest(&wall) + 0.5), "{wall:?} {plate:?}");
    let holes = rows(frames.last().unwrap()).iter().filter(|row| row.contains("–")).count();
    assert!(holes > 0);
}
