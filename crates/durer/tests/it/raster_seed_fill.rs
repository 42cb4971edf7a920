//! Seed fills, compared with connected regions labelled by union-find.

use crate::raster_coverage::Random;
use durer::Error;
use durer::raster::seed_fill::{Connectivity, Options, SeedFill, Step, boundary_fill, flood_fill};
use durer::target::Pixels;
use durer::trace::{NoTrace, Recorder};
use durer::work::Work;

fn root(parents: &mut [usize], mut i: usize) -> usize {
    while parents[i] != i {
        parents[i] = parents[parents[i]];
        i = parents[i];
    }
    i
}

/// Returns for every pixel the label of its region of equal values.
fn labels(image: &Pixels<u8>, eight: bool) -> Vec<usize> {
    let (w, h) = (image.width() as usize, image.height() as usize);
    let mut parents: Vec<usize> = (0..w * h).collect();
    let data = image.data();
    for i in 0..w * h {
        let (x, y) = (i % w, i / w);
        let mut join = |other: usize| {
            if data[other] == data[i] {
                let (a, b) = (root(&mut parents, i), root(&mut parents, other));
                parents[a] = b;
            }
        };
        if x > 0 {
            join(i - 1);
        }
        if y > 0 {
            join(i - w);
        }
        if eight && y > 0 && x > 0 {
            join(i - w - 1);
        }
        if eight && y > 0 && x + 1 < w {
            join(i - w + 1);
        }
    }
    (0..w * h).map(|i| root(&mut parents, i)).collect()
}

/// Checks that pixels are popped in the reverse order of being pushed, and the seed before all others.
fn check_stack(steps: &[Step]) {
    let mut stack = Vec::new();
    for (i, step) in steps.iter().enumerate() {
        match *step {
            Step::Push(run) => stack.push(run),
            Step::Skip(run) => assert_eq!(stack.pop(), Some(run)),
            Step::Fill { run, waiting } => {
                assert!(i == 0 || stack.pop() == Some(run));
                assert_eq!(stack.len(), waiting);
            }
        }
    }
    assert!(stack.is_empty());
}

#[test]
fn fills_take_exactly_the_connected_region() {
    let mut random = Random(1);
    for round in 0..120 {
        let (w, h) = (1 + (random.next() * 150.0) as u32, 1 + (random.next() * 20.0) as u32);
        // With few closed pixels, runs are long and processed one by one; with many, words are used.
        let density = [0.3, 0.45, 0.6, 0.004][round % 4];
        let data = (0..w * h).map(|_| u8::from(random.next() < density)).collect();
        let image = Pixels::from_data(w, h, data).unwrap();
        let seed = ((random.next() * f64::from(w)) as u32, (random.next() * f64::from(h)) as u32);
        for connectivity in [Connectivity::Four, Connectivity::Eight] {
            let labels = labels(&image, connectivity == Connectivity::Eight);
            let own = labels[(seed.1 * w + seed.0) as usize];
            let options = Options { connectivity, ..Options::default() };
            for method in SeedFill::ALL {
                let mut filled = image.clone();
                let mut recorder: Recorder<Step> = Recorder::default();
                let n =
                    flood_fill(&mut filled, seed, 9, 0, *method, &options, &mut recorder).unwrap();
                let mut quiet = image.clone();
                let m =
                    flood_fill(&mut quiet, seed, 9, 0, *method, &options, &mut NoTrace).unwrap();
                assert_eq!((m, &quiet), (n, &filled), "{method} {connectivity:?}");
                let expected: Vec<u8> = image
                    .data()
                    .iter()
                    .zip(&labels)
                    .map(|(v, l)| if *l == own { 9 } else { *v })
                    .collect();
                assert_eq!(filled.data(), expected, "{method} {connectivity:?}");
                assert_eq!(n as usize, labels.iter().filter(|l| **l == own).count());
                // If the colour is there already, nothing changes, but the pixels count.
                let (mut same, t) = (image.clone(), &mut NoTrace);
                let own = image.get(seed.0, seed.1).unwrap();
                assert_eq!(flood_fill(&mut same, seed, own, 0, *method, &options, t), Ok(n));
                assert_eq!(same, image);
                let mut replayed = image.clone();
                for run in recorder.steps().iter().filter_map(Step::filled) {
                    (run.x0..run.x1).for_each(|x| replayed.set(x as u32, run.y as u32, 9));
                }
                check_stack(recorder.steps());
                assert_eq!(replayed, filled);
            }
        }
    }
}

#[test]
fn boundaries_and_tolerance_on_colours() {
    let rows = ["..#..", ".#a#.", "#abc#", ".#a#."];
    let value = |c: char| match c {
        '#' => [0_u8, 0, 0, 255],
        'a' => [100, 100, 100, 255],
        'b' => [104, 98, 100, 255],
        'c' => [130, 100, 100, 255],
        _ => [255; 4],
    };
    let data = rows.iter().flat_map(|r| r.chars().map(value)).collect();
    let image = Pixels::from_data(5, 4, data).unwrap();
    let red = [255, 0, 0, 255];
    for method in SeedFill::ALL {
        let fill = |tolerance| {
            let mut i = image.clone();
            let four = Options::default();
            flood_fill(&mut i, (2, 1), red, tolerance, *method, &four, &mut NoTrace).unwrap()
        };
        assert_eq!([fill(0), fill(3), fill(4), fill(30)], [1, 1, 4, 5]);
        let mut i = image.clone();
        let black = [0, 0, 0, 255];
        let four = Options::default();
        assert_eq!(
            boundary_fill(&mut i, (2, 2), red, black, 0, *method, &four, &mut NoTrace),
            Ok(5)
        );
        let mut i = image.clone();
        let eight = Options { connectivity: Connectivity::Eight, ..Options::default() };
        assert_eq!(
            boundary_fill(&mut i, (2, 2), red, black, 0, *method, &eight, &mut NoTrace),
            Ok(13)
        );
        assert_eq!(flood_fill(&mut i, (5, 0), red, 0, *method, &eight, &mut NoTrace), Ok(0));
        assert_eq!(
            flood_fill(
                &mut Pixels::new(0, 0, true),
                (0, 0),
                false,
                0,
                *method,
                &eight,
                &mut NoTrace
            ),
            Ok(0)
        );
    }
}

#[test]
fn bits_differ_wholly_and_boundaries_have_their_tolerance() {
    for method in SeedFill::ALL {
        for tolerance in [0, 1, 254] {
            let mut bits = Pixels::from_data(4, 1, vec![false, false, true, false]).unwrap();
            let options = Options::default();
            let n = flood_fill(&mut bits, (0, 0), true, tolerance, *method, &options, &mut NoTrace);
            assert_eq!((n, bits.data()), (Ok(2), &[true, true, true, false][..]), "{method}");
        }
        // The border is the set of values that differ by the tolerance or less.
        for (tolerance, expected) in [(9, 5), (10, 3), (20, 2), (29, 2)] {
            let mut grey = Pixels::from_data(5, 1, vec![90_u8, 80, 70, 60, 50]).unwrap();
            let options = Options::default();
            let border = if tolerance == 9 { 40 } else { 50 };
            let n = boundary_fill(
                &mut grey,
                (0, 0),
                0,
                border,
                tolerance,
                *method,
                &options,
                &mut NoTrace,
            );
            assert_eq!(n, Ok(expected), "{method} {tolerance}");
        }
    }
}

#[test]
fn long_runs_that_meet_at_corners_are_one_region_of_eight() {
    // Stairs down to the right and to the left, with steps longer than a word.
    for mirrored in [false, true] {
        let (width, height) = (400, 4);
        let mut image = Pixels::new(width, height, 0_u8);
        for y in 0..height {
            for x in 100 * y..100 * (y + 1) {
                image.set(if mirrored { width - 1 - x } else { x }, y, 1);
            }
        }
        for (seed_y, method) in
            [0, 1, 3].into_iter().flat_map(|y| SeedFill::ALL.iter().map(move |m| (y, m)))
        {
            let x = 100 * seed_y + 50;
            let seed = (if mirrored { width - 1 - x } else { x }, seed_y);
            for (connectivity, expected) in [(Connectivity::Four, 100), (Connectivity::Eight, 400)]
            {
                let options = Options { connectivity, ..Options::default() };
                let mut filled = image.clone();
                let n = flood_fill(&mut filled, seed, 7, 0, *method, &options, &mut NoTrace);
                assert_eq!(n, Ok(expected), "{method} {connectivity:?} {mirrored} {seed:?}");
            }
        }
    }
}

#[test]
fn stacks_are_charged_to_the_budget_of_the_image() {
    let (width, height) = (256_u32, 200_u32);
    let own = u64::from(width * height);
    let filled = |budget: u64, method: SeedFill| {
        let work = Work::with_budget(budget, "the budget");
        let mut image = Pixels::within((&work, "image"), width, height, 0_u8).unwrap();
        let t = &mut NoTrace;
        let found = flood_fill(&mut image, (9, 9), 7, 0, method, &Options::default(), t);
        // What the fill had is given back.
        assert_eq!(work.used(), own, "{method}");
        (found, image)
    };
    for &method in SeedFill::ALL {
        let (found, image) = filled(64 << 20, method);
        assert_eq!((found, image.data()[0]), (Ok(own), 7), "{method}");
        // Enough for the bits of the pixels, one each, but not for a stack.
        let (refused, image) = filled(own + own / 8 + 100, method);
        let Err(Error::Memory { stage, .. }) = refused else { panic!("{method}: {refused:?}") };
        assert_eq!(stage, "stack of the fill");
        assert!(image.data().iter().all(|p| *p == 0), "{method}");
    }
    // The form that is traced, too.
    let work = Work::with_budget(own + own / 8 + 100, "the budget");
    let mut image = Pixels::within((&work, "image"), width, height, 0_u8).unwrap();
    let mut steps: Recorder<Step> = Recorder::default();
    let (spans, options) = (SeedFill::Spans, Options::default());
    assert!(flood_fill(&mut image, (9, 9), 7, 0, spans, &options, &mut steps).is_err());
}
