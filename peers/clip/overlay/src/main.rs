//! durer's overlay beside i_overlay, Clipper2 and geo.
//!
//! `overlay-peers [ROUNDS [dic [NAME…]]]` measures, in CPU milliseconds of one thread (two threads:
//! wall time); the letters choose durer, i_overlay, Clipper2. `overlay-peers wkt FILE` prints durer's
//! results for a file of Clipper2's as WKT, one per line, for another judge of validity.

#[path = "../../../../crates/durer/tests/it/overlay/cases.rs"]
#[allow(dead_code)]
mod cases;
mod shapes;

/// CPU seconds of this thread: on a busy machine wall time would measure the others.
#[derive(Clone, Copy)]
struct Instant(libc::clockid_t, f64);

fn clock(id: libc::clockid_t) -> f64 {
    let mut t = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the pointer is to a live local of the right type.
    unsafe { libc::clock_gettime(id, &mut t) };
    t.tv_sec as f64 + t.tv_nsec as f64 * 1e-9
}

impl Instant {
    fn now() -> Self {
        let two = rayon::current_num_threads() == 2 && rayon::current_thread_index().is_some();
        let id = if two { libc::CLOCK_MONOTONIC } else { libc::CLOCK_THREAD_CPUTIME_ID };
        Self(id, clock(id))
    }

    fn elapsed(&self) -> std::time::Duration {
        std::time::Duration::from_secs_f64(clock(self.0) - self.1)
    }
}

use durer::clip::polygon::overlay::{Options, overlay};
use durer::clip::polygon::{BooleanOp, WindingRule, Shapes};
use durer::math::DVec2;
use durer::trace::NoTrace;
use shapes::{Pair, Rings};

fn ours(rings: &Rings) -> Shapes {
    Shapes::from_rings(rings.iter().map(|r| {
        r.iter().map(|&(x, y)| DVec2::new(f64::from(x), f64::from(y))).collect::<Vec<_>>()
    }))
}

struct Peers {
    ours: (Shapes, Shapes),
    i_overlay: (
        Vec<Vec<i_overlay::i_float::int::point::IntPoint<i32>>>,
        Vec<Vec<i_overlay::i_float::int::point::IntPoint<i32>>>,
    ),
    clipper: (clipper2::Paths<clipper2::One>, clipper2::Paths<clipper2::One>),
    op: BooleanOp,
}

impl Peers {
    fn new((subject, clip): &Pair, op: BooleanOp) -> Self {
        let int = |rings: &Rings| {
            let ring = |r: &Vec<(i32, i32)>| {
                r.iter()
                    .map(|&(x, y)| i_overlay::i_float::int::point::IntPoint::new(x, y))
                    .collect()
            };
            rings.iter().map(ring).collect()
        };
        let paths = |rings: &Rings| {
            let ring = |r: &Vec<(i32, i32)>| {
                clipper2::Path::new(
                    r.iter()
                        .map(|&(x, y)| clipper2::Point::new(f64::from(x), f64::from(y)))
                        .collect(),
                )
            };
            clipper2::Paths::new(rings.iter().map(ring).collect())
        };
        Self {
            ours: (ours(subject), ours(clip)),
            i_overlay: (int(subject), int(clip)),
            clipper: (paths(subject), paths(clip)),
            op,
        }
    }

    fn run_ours(&self) -> (f64, f64) {
        let options = Options::with_rule(WindingRule::NonZero);
        let start = Instant::now();
        let out =
            overlay(&self.ours.0, &self.ours.1, self.op, &options, &mut NoTrace).expect("finite");
        (start.elapsed().as_secs_f64(), out.shapes.area())
    }

    fn run_i_overlay(&self) -> (f64, f64) {
        use i_overlay::core::{fill_rule::WindingRule, overlay::Overlay, overlay_rule::OverlayRule};
        let rule = match self.op {
            BooleanOp::Intersection => OverlayRule::Intersect,
            BooleanOp::Union => OverlayRule::Union,
            BooleanOp::Difference => OverlayRule::Difference,
            BooleanOp::Xor => OverlayRule::Xor,
        };
        let start = Instant::now();
        let out = Overlay::from_subj_and_clip(&self.i_overlay.0, &self.i_overlay.1)
            .overlay(rule, WindingRule::NonZero);
        let time = start.elapsed().as_secs_f64();
        let area = out.iter().flatten().map(|r| {
            let p: Vec<DVec2> =
                r.iter().map(|p| DVec2::new(f64::from(p.x), f64::from(p.y))).collect();
            durer::clip::polygon::signed_area(&p)
        });
        (time, area.sum())
    }

    fn run_clipper(&self) -> (f64, f64) {
        use clipper2::WindingRule::NonZero;
        let start = Instant::now();
        let c = clipper2::Clipper::new()
            .add_subject(self.clipper.0.clone())
            .add_clip(self.clipper.1.clone());
        let out = match self.op {
            BooleanOp::Intersection => c.intersect(NonZero),
            BooleanOp::Union => c.union(NonZero),
            BooleanOp::Difference => c.difference(NonZero),
            BooleanOp::Xor => c.xor(NonZero),
        }
        .expect("result");
        let time = start.elapsed().as_secs_f64();
        (time, out.signed_area())
    }
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2] * 1e3
}

fn bench(name: &str, rounds: usize, peers: &str) {
    let pair = shapes::named(name).unwrap_or_else(|| panic!("no shapes {name}"));
    let op = if name.starts_with("board") { BooleanOp::Xor } else { BooleanOp::Union };
    let edges: usize = pair.0.iter().chain(&pair.1).map(Vec::len).sum();
    let all = Peers::new(&pair, op);
    let pools: Vec<rayon::ThreadPool> = [1, 2]
        .map(|n| rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("pool"))
        .into();
    let mut times = vec![Vec::new(); 4];
    let mut areas = [0.0; 4];
    for _ in 0..rounds {
        for (k, time) in times.iter_mut().enumerate() {
            let wanted = ["d", "d", "i", "c"][k];
            if !peers.contains(wanted) {
                continue;
            }
            let (t, area) = match k {
                0 | 1 => pools[k].install(|| all.run_ours()),
                2 => pools[0].install(|| all.run_i_overlay()),
                _ => all.run_clipper(),
            };
            time.push(t);
            areas[k] = area;
        }
    }
    print!("{name:12} {edges:8} edges ");
    for (k, title) in ["durer", "durer 2T", "i_overlay", "Clipper2"].iter().enumerate() {
        if !times[k].is_empty() {
            print!(" {title} {:9.2} ms", median(times[k].clone()));
            if (areas[k] - areas[0]).abs() > 1e-6 * areas[0].abs() {
                print!(" (area {:e} of {:e})", areas[k], areas[0]);
            }
        }
    }
    println!();
}

fn wkt(path: &str) {
    let text = std::fs::read_to_string(path).expect("file");
    for case in cases::ClipperCase::all(&text) {
        let options = Options::with_rule(case.rule);
        let out =
            overlay(&case.subject, &case.clip, case.op, &options, &mut NoTrace).expect("finite");
        let ring = |r: &[DVec2]| {
            let points: Vec<String> =
                r.iter().chain(r.first()).map(|p| format!("{} {}", p.x, p.y)).collect();
            format!("({})", points.join(","))
        };
        let polygons: Vec<String> = out
            .shapes
            .polygons()
            .map(|p| format!("({})", p.rings().map(ring).collect::<Vec<_>>().join(",")))
            .collect();
        let body = polygons.join(",");
        println!(
            "MULTIPOLYGON {}",
            if body.is_empty() { "EMPTY".into() } else { format!("({body})") }
        );
    }
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    if let [command, path] = &args[..]
        && command == "wkt"
    {
        return wkt(path);
    }
    let rounds = args.first().and_then(|a| a.parse().ok()).unwrap_or(7);
    let peers = args.get(1).map_or("dic", |s| s.as_str());
    let names: Vec<&str> = args.iter().skip(2).map(String::as_str).collect();
    let all =
        ["coast-1k", "coast-10k", "coast-100k", "star-1k", "star-10k", "blobs-10k", "board-10k"];
    for name in if names.is_empty() { &all[..] } else { &names[..] } {
        bench(name, rounds, peers);
    }
}
