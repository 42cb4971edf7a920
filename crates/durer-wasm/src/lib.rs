//! The library behind requests: a JSON text in, a JSON text or bytes out. Compiled to WebAssembly it is the engine of
//! the explorer; compiled for this machine it answers with the same bytes, which tests compare.
//!
//! [`Engine::answer`] is all of it. A request is an object whose `do` names what to do:
//!
//! | `do` | members | answer |
//! |---|---|---|
//! | `lessons` | – | families of lessons with facts, pseudocode, examples and sentences |
//! | `run` | `name`, `input`, `operation`, `rule`, `fault`, `cap` | `handle` of the run, and line and template of each step |
//! | `frame` | `handle`, `step`, `language`, `longest` | caption, table, drawing, the place of the input in it, and the marks that the step is about |
//! | `captions` | `handle`, `first`, `count`, `language` | captions of a range of steps |
//! | `tikz` | `handle`, `step`, `language` | the drawing for LaTeX |
//! | `drop` | `handle` | nothing; the run's memory is free again |
//! | `read` | `name`, `window`; the file after a zero byte | the file as an input |
//! | `formula` | `formula`, `columns`, `curves` | curves of a surface y = f(x, z) as an input |
//! | `methods` | – | names and titles of methods for visible surfaces |
//! | `render` | `name`, `method`, `counts`, …; the model after a zero byte | a PNG; before it, with `counts`, the operations of the method in JSON and a zero byte |
//!
//! ```json
//! {"do": "run", "name": "cohen-sutherland", "input": {"example": "line-eh"}, "cap": 1000}
//! ```

mod answer;
mod door;
#[cfg(feature = "files")]
mod files;
mod input;
mod lessons;
mod runs;
mod targets;
mod tikz;

pub use answer::{Answer, Engine};
