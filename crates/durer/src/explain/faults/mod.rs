//! Programs with one wrong line, for exercises: each does what a lesson's pseudocode says, line by line, but for the line of a
//! fault. They report steps as the library's own functions do, so a run of theirs is shown by the same frames.
//!
//! Without a fault they run as the library does, which a test compares. Their arithmetic is plain: unlike the library's it
//! may be off by rounding.

mod codes;
mod parameters;
mod pixels;
mod rows;
mod stages;

use super::input::Input;
use super::replay::Frames;
use crate::{Error, Result};

/// A line of a lesson's pseudocode that a program gets wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LessonFault {
    /// Line of the pseudocode, counted from 1.
    pub line: usize,
    /// The line as the program has it.
    pub wrong: &'static str,
}

const fn fault(line: usize, wrong: &'static str) -> LessonFault {
    LessonFault { line, wrong }
}

/// A small program of an algorithm, with the lines that it can get wrong.
struct Program {
    lesson: &'static str,
    faults: &'static [LessonFault],
    /// Makes the frames of a run with a wrong line, 0 for none.
    frames: fn(&Input, usize, usize) -> Result<Frames>,
}

const PROGRAMS: &[Program] =
    &[codes::PROGRAM, parameters::PROGRAM, stages::PROGRAM, pixels::PROGRAM, rows::PROGRAM];

fn program(lesson: &str) -> Option<&'static Program> {
    PROGRAMS.iter().find(|program| program.lesson == lesson)
}

/// Returns the faults that a lesson's program can have; none for lessons without one.
pub fn faults(lesson: &str) -> &'static [LessonFault] {
    program(lesson).map_or(&[], |program| program.faults)
}

/// Runs a lesson's program with a fault, given by its number in [`faults`], and returns at most `cap` frames, and one more
/// that says how many are missing.
///
/// ```
/// use durer::explain::{Language, faults, lesson, record_with_fault};
///
/// let input = lesson("bresenham")?.example("")?;
/// let forgets = faults("bresenham").iter().position(|fault| fault.line == 9).unwrap_or_default();
/// let run = record_with_fault("bresenham", forgets, &input, 100)?;
/// let right = lesson("bresenham")?.record(&input, &Default::default(), 100)?;
/// assert_ne!(run.frame(2).map(|f| f.text(Language::English)), right.frame(2).map(|f| f.text(Language::English)));
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Error::Unknown`] for a lesson without faults or without an example of the input's name, [`Error::Parameter`] for a
/// number beyond the last fault, and those of [`super::Lesson::run`].
pub fn record_with_fault(lesson: &str, fault: usize, input: &Input, cap: usize) -> Result<Frames> {
    let found = program(lesson).ok_or_else(|| {
        let names = PROGRAMS.iter().map(|program| program.lesson);
        super::lesson::unknown("algorithm with faults", lesson, names)
    })?;
    let Some(fault) = found.faults.get(fault) else {
        let right = "the number of one of the lesson's faults, counted from 0";
        return Err(Error::parameter("fault", fault, right));
    };
    record(found, fault.line, input, cap)
}

fn record(program: &Program, line: usize, input: &Input, cap: usize) -> Result<Frames> {
    if let Input::Example(name) = input {
        // Programs are of lessons in the plane: a binary that only has these need not contain the others.
        let lesson = super::find(super::PLANE.iter(), program.lesson)?;
        return (program.frames)(&lesson.example(name)?, line, cap);
    }
    input.check()?;
    (program.frames)(input, line, cap)
}

#[cfg(test)]
mod tests {
    use super::super::{Frame, Language, lesson, picture};
    use super::*;

    /// Returns everything visible in a frame, with numbers as printed.
    fn seen(frame: &Frame) -> (usize, String, String, String) {
        let table = frame.table.rows.iter().map(|row| {
            let cells = row.cells.iter().map(|cell| cell.value.text(Language::English));
            row.name.text(Language::English) + &cells.collect::<Vec<_>>().join("|")
        });
        let table = table.collect::<Vec<_>>().join("\n");
        let drawing = picture(&frame.picture, Language::English);
        (frame.line, frame.text(Language::English), table, drawing)
    }

    fn run(program: &Program, line: usize, example: &str) -> Vec<Frame> {
        let input = Input::Example(example.to_owned());
        record(program, line, &input, 3_000).unwrap().iter().collect()
    }

    #[test]
    fn programs_without_a_fault_run_as_the_library_does() {
        assert!(PROGRAMS.len() >= 5);
        for program in PROGRAMS {
            let lesson = lesson(program.lesson).unwrap();
            for example in lesson.examples {
                let input = Input::Example(example.name.to_owned());
                let right = lesson.run(&input, &Default::default(), 3_000).unwrap();
                let own = run(program, 0, example.name);
                assert_eq!(own.len(), right.len(), "{} {}", lesson.name, example.name);
                for (own, right) in own.iter().zip(&right) {
                    let place = format!("{} {} {}", lesson.name, example.name, right.number);
                    assert_eq!(seen(own), seen(right), "{place}");
                }
            }
        }
    }

    #[test]
    fn every_fault_is_seen_on_an_example_and_ends() {
        for program in PROGRAMS {
            let lesson = lesson(program.lesson).unwrap();
            for LessonFault { line, wrong } in program.faults {
                let place = format!("{} {line}", lesson.name);
                let right = lesson.info.pseudocode.get(line - 1).unwrap();
                assert_ne!(right.trim(), *wrong, "{place}");
                let differs = lesson.examples.iter().filter(|example| {
                    let wrong = run(program, *line, example.name);
                    assert!(wrong.iter().all(|frame| frame.kind != "more"), "{place}: no end");
                    let right = run(program, 0, example.name);
                    wrong.len() != right.len()
                        || wrong.iter().zip(&right).any(|(a, b)| seen(a) != seen(b))
                });
                assert!(differs.count() > 0, "{place} changes no example");
            }
        }
    }
}
