//! Cells and portals: the same picture as drawing every wall, without visiting invisible rooms.

use crate::raster_coverage::Random;
use durer::math::{DVec2, DVec3};
use durer::target::NO_ITEM;
use durer::trace::{NoTrace, Recorder};
use durer::visibility::polygons::portals::{
    ConvexRoom, Options, Plan, PlanEye, Portal, Step, Wall, items, replay, visits, walls,
};
use durer::visibility::polygons::{Face, PolygonMethod, Screen};
use durer::work::Work;

const SIDE: usize = 4;
const ROOM: f64 = 4.0;

fn screen() -> Screen {
    Screen { width: 48, height: 12, ..Screen::default() }
}

/// Returns a square of rooms, turned about the origin by an angle, with doors in some of the walls.
fn rooms(random: &mut Random, angle: f64) -> (Vec<Vec<DVec2>>, Vec<[DVec2; 2]>) {
    let turn = DVec2::new(libm::cos(angle), libm::sin(angle));
    let at = |x: f64, y: f64| turn.rotate(DVec2::new(x, y) * ROOM);
    let index = |k: usize| k as f64;
    let mut rooms = Vec::new();
    let mut doors = Vec::new();
    for (row, column) in (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| (row, column))) {
        let (x, y) = (index(column), index(row));
        rooms.push(vec![at(x, y), at(x + 1.0, y), at(x + 1.0, y + 1.0), at(x, y + 1.0)]);
        let mut gap = || {
            let p = random.point(0.0, 1.0);
            (p.x * 0.6, p.x * 0.6 + 0.1 + p.y * 0.3)
        };
        let (up, right) = (gap(), gap());
        if row + 1 < SIDE {
            doors.push([at(x + up.0, y + 1.0), at(x + up.1, y + 1.0)]);
        }
        // Every other room has no door to the right.
        if column + 1 < SIDE && (row + column) % 2 == 0 {
            doors.push([at(x + 1.0, y + right.0), at(x + 1.0, y + right.1)]);
        }
    }
    (rooms, doors)
}

#[test]
fn rooms_through_doors_look_as_when_every_wall_is_drawn() {
    let mut random = Random(5);
    let (mut visited, mut all) = (0, 0);
    for round in 0..60 {
        let angle = f64::from(round) * 0.37;
        let (rooms, doors) = rooms(&mut random, if round % 4 == 0 { 0.0 } else { angle });
        let plan = Plan::of_rooms(&rooms, &doors, 2.0).unwrap();
        let cell = round as usize % rooms.len();
        let [weight, mix] = random.point(0.05, 0.95).to_array();
        let ring = &rooms[cell];
        let place = ring[0].lerp(ring[1], weight).lerp(ring[3].lerp(ring[2], weight), mix);
        let eye = PlanEye { at: DVec3::new(place.x, 0.0, place.y), cell, focal: 24.0 };
        let screen = screen();
        let mut steps = Recorder::default();
        let found = items(&plan, &eye, &screen, &Options::default(), &mut steps).unwrap();
        let seen = visits(&plan, &eye, &screen, &Options::default(), &mut NoTrace).unwrap();
        assert_eq!(replay(steps.steps()), seen);
        let walls: Vec<Wall> =
            (0..rooms.len()).flat_map(|cell| walls(&plan, cell, &eye, &screen).unwrap()).collect();
        let faces: Vec<Face> = walls.iter().map(|wall| wall.face.clone()).collect();
        let expected = PolygonMethod::ZBuffer.items(&faces, &screen).unwrap();
        for (at, (found, index)) in found.data().iter().zip(expected.data()).enumerate() {
            let expected = walls.get(*index as usize).map_or(NO_ITEM, |wall| wall.item);
            assert_eq!(*found, expected, "round {round}, pixel {at}");
        }
        let mut cells: Vec<usize> = seen.iter().map(|visit| visit.cell).collect();
        cells.sort_unstable();
        cells.dedup();
        visited += cells.len();
        all += rooms.len();
    }
    // Most rooms are invisible and are not visited.
    assert!(visited * 3 < all, "{visited} of {all}");
}

/// Checks a row of rooms: each window is inside the one before, and a door beside it ends the row.
#[test]
fn windows_shrink_from_door_to_door() {
    let room =
        |k: f64| [(0.0, k), (8.0, k), (8.0, k + 4.0), (0.0, k + 4.0)].map(DVec2::from).to_vec();
    let door = |a: f64, b: f64, z: f64| [DVec2::new(a, z), DVec2::new(b, z)];
    let doors = [door(2.0, 4.0, 4.0), door(2.5, 6.0, 8.0), door(6.0, 7.0, 12.0)];
    let plan = Plan::of_rooms(&[0.0, 4.0, 8.0, 12.0].map(room), &doors, 2.0).unwrap();
    let eye = PlanEye { at: DVec3::new(3.0, 0.0, 2.0), cell: 0, focal: 24.0 };
    let mut steps = Recorder::default();
    let seen = visits(&plan, &eye, &screen(), &Options::default(), &mut steps).unwrap();
    // x / z · 24 + 24: from −½ to ½, then from −1/12 to ½, then from 3/10, all cut at ½.
    let columns: Vec<_> =
        seen.iter().map(|v| (v.cell, v.window.low[0], v.window.high[0])).collect();
    assert_eq!(columns, [(0, 0, 48), (1, 12, 36), (2, 22, 36), (3, 31, 34)]);
    let rows: Vec<_> = seen.iter().map(|v| (v.window.low[1], v.window.high[1])).collect();
    assert_eq!(rows, [(0, 12), (0, 12), (2, 10), (3, 9)]);
    let back = steps.steps().iter().filter(|step| matches!(step, Step::Back { .. })).count();
    assert_eq!(back, 3);
    // From the other side of the room the last door is hidden.
    let aside = PlanEye { at: DVec3::new(3.9, 0.0, 2.0), ..eye };
    let seen = visits(&plan, &aside, &screen(), &Options::default(), &mut NoTrace).unwrap();
    assert_eq!(seen.last().map(|visit| visit.cell), Some(2));
    // An eye in the second room that looks away from the first does not see it.
    let second = PlanEye { at: DVec3::new(6.0, 0.0, 7.0), cell: 1, focal: 24.0 };
    let cells = visits(&plan, &second, &screen(), &Options::default(), &mut NoTrace).unwrap();
    assert_eq!(cells.iter().map(|visit| visit.cell).collect::<Vec<_>>(), [1, 2]);
}

/// Two doors in one wall, the right one first and given from right to left: three pieces of wall are left in each room.
#[test]
fn walls_are_left_beside_doors() {
    let room =
        |z: f64| [(0.0, z), (8.0, z), (8.0, z + 4.0), (0.0, z + 4.0)].map(DVec2::from).to_vec();
    let door = |from: f64, to: f64| [DVec2::new(from, 4.0), DVec2::new(to, 4.0)];
    let plan =
        Plan::of_rooms(&[room(0.0), room(4.0)], &[door(7.0, 5.0), door(1.0, 2.0)], 2.0).unwrap();
    for (cell, to) in plan.cells().iter().zip([1, 0]) {
        assert!(cell.portals.iter().all(|portal| portal.to == to) && cell.portals.len() == 2);
        let common = cell.walls.iter().filter(|wall| wall.iter().all(|p| p.z == 4.0));
        let mut pieces: Vec<[f64; 2]> = common.map(|wall| [wall[0].x, wall[1].x]).collect();
        pieces.iter_mut().for_each(|piece| piece.sort_by(f64::total_cmp));
        pieces.sort_by(|a, b| a[0].total_cmp(&b[0]));
        assert_eq!(pieces, [[0.0, 1.0], [2.0, 5.0], [7.0, 8.0]]);
        assert_eq!(cell.walls.len(), 6);
    }
}

#[test]
fn visits_are_charged_to_the_budget() {
    let (rooms, doors) = rooms(&mut Random(5), 0.0);
    let plan = Plan::of_rooms(&rooms, &doors, 2.0).unwrap();
    let eye = PlanEye { at: DVec3::new(1.0, 0.0, 1.0), cell: 0, focal: 24.0 };
    let within = |bytes: u64| Screen { work: Work::with_budget(bytes, "the budget"), ..screen() };
    let visit = |screen: &Screen| visits(&plan, &eye, screen, &Options::default(), &mut NoTrace);
    let refused = visit(&within(100)).unwrap_err();
    assert!(refused.is_of_budget() && refused.to_string().contains("visits of cells"), "{refused}");
    let enough = within(1 << 16);
    assert_eq!(visit(&enough).unwrap(), visit(&screen()).unwrap());
    assert_eq!(enough.work.used(), 0);
}

#[test]
fn wrong_plans_and_too_many_visits_are_errors() {
    let square = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(DVec2::from).to_vec();
    let outer = [DVec2::new(1.0, 0.0), DVec2::new(2.0, 0.0)];
    let error = Plan::of_rooms(std::slice::from_ref(&square), &[outer], 2.0).unwrap_err();
    assert!(error.to_string().contains("door 0, in the walls of 1 rooms"), "{error}");
    let portal = Portal { corners: vec![DVec3::ZERO; 3], to: 7 };
    let cell = ConvexRoom { walls: Vec::new(), portals: vec![portal] };
    assert!(Plan::new(vec![cell]).is_err());
    let bent = [(0.0, 0.0), (4.0, 0.0), (1.0, 1.0), (0.0, 4.0)].map(DVec2::from).to_vec();
    let error = Plan::of_rooms(&[bent], &[], 2.0).unwrap_err().to_string();
    assert!(error.contains("convex"), "{error}");
    let odd = vec![DVec2::new(f64::NAN, 0.0), DVec2::X, DVec2::Y];
    assert!(Plan::of_rooms(&[odd], &[], 2.0).is_err());
    let plan = Plan::of_rooms(&[square], &[], 2.0).unwrap();
    let eye = PlanEye { at: DVec3::new(1.0, 0.0, 1.0), cell: 0, focal: 24.0 };
    let visit = |eye: &PlanEye, max_visits| {
        visits(&plan, eye, &screen(), &Options { max_visits }, &mut NoTrace)
    };
    assert_eq!(visit(&eye, 1).unwrap().len(), 1);
    assert!(visit(&eye, 0).is_err());
    assert!(visit(&PlanEye { cell: 1, ..eye }, 9).is_err());
}
