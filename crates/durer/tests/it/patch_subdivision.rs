//! Catmull's subdivision of patches, compared with fine meshes of the same patches.

use crate::line_scenes::Random;
use durer::math::DVec3;
use durer::target::NO_ITEM;
use durer::trace::{NoTrace, Recorder};
use durer::visibility::polygons::Screen;
use durer::visibility::polygons::patch_subdivision::{
    BicubicPatch, Options, PatchPicture, Step, render, replay,
};
use durer::work::Work;

const WIDTH: u32 = 20;
const HEIGHT: u32 = 16;

fn screen() -> Screen {
    Screen { width: WIDTH, height: HEIGHT, ..Screen::default() }
}

fn patch(mut point: impl FnMut(usize, usize) -> DVec3) -> BicubicPatch {
    let mut rows = [[DVec3::ZERO; 4]; 4];
    for (j, row) in rows.iter_mut().enumerate() {
        for (i, place) in row.iter_mut().enumerate() {
            *place = point(i, j);
        }
    }
    BicubicPatch::new(rows).unwrap()
}

/// Returns a patch in any position; parts of it hide others, and parts are outside the screen.
fn wild(random: &mut Random) -> BicubicPatch {
    let mut number = |low: f64, high: f64| low + random.next() * (high - low);
    let (dx, dy) = (number(2.0, 7.0), number(2.0, 6.0));
    let (x, y) = (number(-3.0, 6.0), number(-3.0, 5.0));
    patch(|i, j| {
        let shake = DVec3::new(number(-4.0, 4.0), number(-4.0, 4.0), number(-9.0, 9.0));
        DVec3::new(x + dx * i as f64, y + dy * j as f64, 20.0) + shake
    })
}

fn rendered(patches: &[BicubicPatch], options: &Options) -> PatchPicture {
    let mut steps = Recorder::default();
    let found = render(patches, &screen(), options, &mut steps).unwrap();
    assert_eq!(render(patches, &screen(), options, &mut NoTrace).unwrap(), found);
    assert_eq!(replay(&screen(), steps.steps()).unwrap(), found);
    found
}

/// Returns the nearest patch and depth at each pixel, at an offset from its centre, of a fine mesh.
fn of_mesh(patches: &[BicubicPatch], steps: usize, offset: [f64; 2]) -> Vec<(u32, f64)> {
    let mut found = vec![(NO_ITEM, f64::INFINITY); (WIDTH * HEIGHT) as usize];
    for (number, patch) in (0..).zip(patches) {
        let at = |k: usize| k as f64 / steps as f64;
        let points: Vec<DVec3> = (0..(steps + 1) * (steps + 1))
            .map(|k| patch.point([at(k % (steps + 1)), at(k / (steps + 1))]))
            .collect();
        for k in (0..steps * (steps + 1)).filter(|k| k % (steps + 1) < steps) {
            let [a, b, c, d] = [k, k + 1, k + steps + 2, k + steps + 1].map(|k| points[k]);
            for [a, b, c] in [[a, b, c], [a, c, d]] {
                let low = a.min(b).min(c).truncate() - 0.5;
                let high = a.max(b).max(c).truncate() - 0.5;
                let range = |low: f64, high: f64, shift: f64, size: u32| {
                    let [low, high] = [(low - shift).ceil(), (high - shift).floor() + 1.0];
                    (low as u32).min(size)..(high as u32).min(size)
                };
                for y in range(low.y, high.y, offset[1], HEIGHT) {
                    for x in range(low.x, high.x, offset[0], WIDTH) {
                        let p = DVec3::new(
                            f64::from(x) + 0.5 + offset[0],
                            f64::from(y) + 0.5 + offset[1],
                            0.0,
                        );
                        let area = |a: DVec3, b: DVec3, c: DVec3| {
                            (b - a).truncate().perp_dot((c - a).truncate())
                        };
                        let whole = area(a, b, c);
                        let parts = [area(p, b, c), area(p, c, a), area(p, a, b)];
                        if whole == 0.0 || parts.iter().any(|part| part * whole < 0.0) {
                            continue;
                        }
                        let z = (parts[0] * a.z + parts[1] * b.z + parts[2] * c.z) / whole;
                        let place = &mut found[(y * WIDTH + x) as usize];
                        if z < place.1 {
                            *place = (number, z);
                        }
                    }
                }
            }
        }
    }
    found
}

#[test]
fn pictures_are_those_of_fine_meshes() {
    let mut random = Random(31);
    let mut checked = 0;
    for round in 0..6 {
        let patches: Vec<BicubicPatch> = (0..1 + round / 2).map(|_| wild(&mut random)).collect();
        let found = rendered(&patches, &Options::default());
        let mesh = of_mesh(&patches, 60, [0.0; 2]);
        // Where all neighbours agree, no outline passes, and the surface is not too steep to compare.
        let around: Vec<_> = [[0.06, 0.0], [-0.06, 0.0], [0.0, 0.06], [0.0, -0.06]]
            .map(|offset| of_mesh(&patches, 60, offset))
            .into();
        for (place, &(item, depth)) in mesh.iter().enumerate() {
            let depths = || around.iter().map(|mesh| mesh[place]);
            let is_alike = depths()
                .all(|(other, z)| other == item && ((z - depth).abs() < 0.8 || item == NO_ITEM));
            if !is_alike {
                continue;
            }
            let [x, y] = [place as u32 % WIDTH, place as u32 / WIDTH];
            let (own, z) = (found.items.get(x, y).unwrap(), found.depths.get(x, y).unwrap());
            assert_eq!(own, item, "round {round}: {x},{y}");
            let most = depths().map(|(_, z)| (z - depth).abs()).fold(0.02, f64::max);
            assert!(
                item == NO_ITEM || (z - depth).abs() <= most,
                "round {round}: {x},{y} {z} {depth}"
            );
            checked += 1;
        }
    }
    assert!(checked > 1_500, "{checked}");
}

/// Checks that a flat square has exact borders, however it is divided.
#[test]
fn a_square_covers_its_pixels() {
    let square = |x: f64, side: f64, z: f64| {
        patch(|i, j| DVec3::new(x + side * i as f64 / 3.0, 2.0 + side * j as f64 / 3.0, z))
    };
    let patches = [square(3.1, 8.0, 4.0), square(7.0, 6.0, 3.0), square(7.0, 6.0, 3.0)];
    let found = rendered(&patches, &Options::default());
    for y in 0..HEIGHT {
        for x in 0..WIDTH {
            let expected = match (x, y) {
                // Of equally near ones the first wins.
                (7..13, 2..8) => (1, 3.0),
                (3..11, 2..10) => (0, 4.0),
                _ => (NO_ITEM, f64::INFINITY),
            };
            let (item, depth) = (found.items.get(x, y).unwrap(), found.depths.get(x, y).unwrap());
            assert_eq!(item, expected.0, "{x},{y}");
            assert!(depth == expected.1 || (depth - expected.1).abs() < 1e-12);
        }
    }
}

#[test]
fn pieces_that_are_compared_have_one_centre() {
    let mut random = Random(7);
    let patches = [wild(&mut random), wild(&mut random)];
    let mut steps = Recorder::default();
    render(&patches, &screen(), &Options::default(), &mut steps).unwrap();
    let mut compared = 0;
    for step in steps.steps() {
        let Step::Compare { patch, part: [[u0, u1], [v0, v1]], pixel, .. } = *step else {
            continue;
        };
        compared += 1;
        for [u, v] in [[u0, v0], [u1, v0], [u0, v1], [u1, v1]] {
            let point = patches[patch as usize].point([u, v]);
            let center = [f64::from(pixel[0]) + 0.5, f64::from(pixel[1]) + 0.5];
            // The next centres are no nearer than 1.
            assert!((point.x - center[0]).abs() < 1.0 && (point.y - center[1]).abs() < 1.0);
        }
    }
    assert!(compared > 200, "{compared}");
}

#[test]
fn limits_and_budgets_are_kept() {
    let mut random = Random(3);
    let patches = [wild(&mut random)];
    let reported = |screen: &Screen, options: Options| {
        render(&patches, screen, &options, &mut NoTrace).unwrap_err().to_string()
    };
    let few = Options { max_pieces: 10, ..Options::default() };
    assert!(reported(&screen(), few).contains("pieces"));
    let shallow = Options { max_depth: 1, ..Options::default() };
    assert!(reported(&screen(), shallow).contains("divisions"));
    for flatness in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(
            reported(&screen(), Options { flatness, ..Options::default() }).contains("flatness")
        );
    }
    let small = Screen { work: Work::with_budget(1_000, "the budget"), ..screen() };
    assert!(reported(&small, Options::default()).contains("memory"));
    let mut rows = *patches[0].rows();
    rows[1][2].z = f64::NAN;
    assert!(BicubicPatch::new(rows).is_err());
    rows[1][2].z = 1e200;
    assert!(BicubicPatch::new(rows).is_err());
    // At the largest sizes: a result or a limit, and quickly.
    let huge = patch(|i, j| DVec3::new(i as f64 - 1.5, j as f64 - 1.5, 1.0) * 6e99);
    assert!(render(&[huge], &screen(), &Options::default(), &mut NoTrace).is_err());
}
