//! Budgets and stops, tested alone.

use crate::scenes;
use durer::Error;
use durer::pipeline::{DrawOptions, SurfaceMethod, draw, render};
use durer::work::{Progress, Work};

#[test]
fn charges_are_given_back() {
    let work = Work::with_budget(100, "--max-memory");
    let mut first = work.charge("a", 60).unwrap();
    assert!(work.charge("b", 41).is_err());
    let second = work.clone().charge("b", 40).unwrap();
    assert_eq!(work.used(), 100);
    assert!(first.grow(1).is_err());
    drop(second);
    first.grow_to(70).unwrap();
    first.grow_to(50).unwrap();
    assert_eq!(work.used(), 70);
    drop(first);
    assert_eq!(work.used(), 0);
}

#[test]
fn what_is_kept_goes_with_its_part() {
    let work = Work::with_budget(100, "--max-memory");
    let part = work.part();
    part.clone().keep("model", 90).unwrap();
    assert!(work.charge("b", 20).is_err());
    drop(part);
    assert!(work.charge("b", 20).is_ok());
}

#[test]
fn errors_name_stage_need_and_option() {
    let work = Work::with_budget(64 << 20, "--max-memory");
    let error = work.charge_for::<u64>("planes", 1 << 60).unwrap_err();
    let (stage, need) = ("planes", 1 << 63);
    assert_eq!(error, Error::Memory { stage, need, budget: 64 << 20, option: "--max-memory" });
    let message = "planes: 8 EB of memory are needed, --max-memory allows 64 MB";
    assert_eq!(error.to_string(), message);
    assert!(work.charge("planes", u64::MAX).is_err());
    assert!(work.keep("planes", u64::MAX).is_err());
    assert_eq!((work.stage(), work.used()), ("planes", 0));
}

#[test]
fn what_is_stopped_says_why() {
    let work = Work::with_budget(100, "--max-memory");
    let other = work.part();
    assert!(other.check().is_ok());
    work.enter("hidden lines");
    work.stop_at(200);
    work.stop(Error::Cancelled);
    let (stage, option) = ("hidden lines", "--max-memory");
    let memory = Error::Memory { stage, need: 200, budget: 100, option };
    assert_eq!(other.check(), Err(memory.clone()));
    assert_eq!(other.charge("a", 0).map(drop), Err(memory));
    assert!(other.is_stopped() && other.go_on() && other.check().is_ok());
    work.stop(Error::Cancelled);
    assert!(!work.go_on());
    assert_eq!(other.check(), Err(Error::Cancelled));
}

#[test]
fn the_default_has_no_bound() {
    let work = Work::default();
    work.stop(Error::Cancelled);
    assert!(work.check().is_ok() && work.keep("a", u64::MAX).is_ok());
    assert!(work.charge("a", u64::MAX).is_ok() && work == work.part());
    assert_ne!(work, Work::stoppable());
}

#[test]
fn buffers_that_cannot_be_had_are_errors() {
    let error = Work::default().room_for::<[u8; 4]>("planes", u64::MAX >> 3).unwrap_err();
    assert!(error.to_string().starts_with("planes: the system has no "), "{error}");
    assert!(Work::default().room_for::<u8>("planes", 32 << 20).is_ok());
}

#[test]
fn work_tells_how_far_it_has_come() {
    assert_eq!(Work::default().progress(), Progress::default());
    let work = Work::stoppable();
    assert_eq!(work.progress().share(), None);
    work.begin("rows", 8);
    work.part().advance(2);
    assert_eq!(work.progress(), Progress { stage: "rows", done: 2, of: 8 });
    assert_eq!(work.progress().share(), Some(0.25));
    work.advance(100);
    assert_eq!(work.progress().done, 8);
    work.begin("lines", 3);
    assert_eq!(work.progress(), Progress { stage: "lines", done: 0, of: 3 });
}

#[test]
fn pictures_and_drawings_count_all_of_their_steps() {
    let (_, scene) = scenes::all().remove(0);
    for &algorithm in SurfaceMethod::ALL {
        let work = Work::stoppable();
        let mut options = scenes::options(&scene, 130, 90);
        (options.algorithm, options.work) = (algorithm, work.clone());
        render(&scene, &options).expect("picture");
        let Progress { stage, done, of } = work.progress();
        // A painter does not know the number of rows done.
        let counts = algorithm != SurfaceMethod::DepthSort;
        assert!(
            stage.starts_with("rows") && of > 0 && (done == of || !counts),
            "{algorithm} {done}/{of}"
        );
    }
    let work = Work::stoppable();
    let mut options = DrawOptions::new(scenes::options(&scene, 1, 1).camera);
    options.work = work.clone();
    draw(&scene, &options).expect("drawing");
    let Progress { stage, done, of } = work.progress();
    assert!(stage == "lines" && of > 0 && done == of, "{stage}: {done}/{of}");
}

#[test]
fn every_method_charges_its_lists_and_gives_them_back() {
    for &method in SurfaceMethod::ALL {
        let scene = scenes::soup(300, 7);
        let mut options = scenes::options(&scene, 20, 15);
        options.algorithm = method;
        options.work = Work::with_budget(1 << 30, "--max-memory");
        let (expected, _) = render(&scene, &options).expect("room for all");
        drop(expected);
        assert_eq!(options.work.used(), 0, "{method}");
        // With each budget some stage is the first to exceed it; the method is among these stages.
        let mut stages = std::collections::BTreeSet::new();
        for budget in (0..60).map(|i| i * 2000) {
            options.work = Work::with_budget(budget, "--max-memory");
            match render(&scene, &options) {
                Err(Error::Memory { stage, .. }) => drop(stages.insert(stage)),
                other => drop(other.expect("no other error")),
            }
            assert_eq!(options.work.used(), 0, "{method} at {budget}");
        }
        // The production path has no lists other than those that it charges itself.
        let own = method != SurfaceMethod::ZBuffer;
        assert_eq!(stages.contains("lists of the method"), own, "{method}: {stages:?}");
    }
}

#[test]
fn what_grows_beyond_the_budget_stops_the_work() {
    let work = Work::with_budget(100, "--max-memory");
    let mut charge = work.charge("a", 50).unwrap();
    assert!(charge.grow_to_or_stop(100) && !work.is_stopped());
    assert!(!charge.grow_to_or_stop(101) && work.is_stopped());
    let error = Error::Memory { stage: "a", need: 101, budget: 100, option: "--max-memory" };
    assert_eq!(work.check(), Err(error));
    assert_eq!(charge.work(), work);
}
