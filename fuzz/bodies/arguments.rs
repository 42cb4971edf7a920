//! The laws that hold for any options and any annotations: the bodies of the fuzz targets `arguments` and `annotations`, which the
//! tests call as well.

use super::words::text;
use arbitrary::{Result, Unstructured};
use durer_cli::fuzzing;
use std::sync::LazyLock;

/// The options of all subcommands.
static OPTIONS: LazyLock<Vec<[String; 2]>> = LazyLock::new(fuzzing::options);

/// Pieces of what options take: numbers with their units, names, and what stands between.
const VALUES: &[&str] = &[
    ",",
    ";",
    ":",
    "x",
    "/",
    "=",
    "@",
    "..",
    "-",
    "+",
    "%",
    "*",
    " ",
    "#",
    "(",
    ")",
    "[",
    "]",
    "0",
    "1",
    "-1",
    "1e9",
    "1e400",
    "NaN",
    "inf",
    "0.5",
    "18446744073709551616",
    "mm",
    "in",
    "pt",
    "px",
    "deg",
    "K",
    "M",
    "G",
    "s",
    "auto",
    "fit",
    "none",
    "all",
    "front",
    "top",
    "iso",
    "right",
    "x=",
    "y=",
    "z=",
    "a",
    "view",
    "eye=",
    "target=",
    "up=",
    "fov=",
    "red",
    "#fff",
    "#12345678",
    "gradient",
    "round",
    "dashed",
    "continuous",
    "A4",
    "A3",
    "landscape",
    "1:10",
    "2:1",
    "linear",
    "diameter",
    "radius",
    "angle",
    "note",
    "hole 1",
    "M8",
    "M8x1",
    "visible",
    "hidden",
    "section",
    "center",
    "EPSG:4326",
    "4326",
    "png",
    "svg",
    "dxf",
    "{",
    "}",
    "\"",
    "\\",
    "\n",
    "\t",
    "\0",
    "é",
    "\u{202e}",
];

/// Pieces of the text of annotations.
const ANNOTATIONS: &[&str] = &[
    "[[dimension]]\n",
    "[[thread]]\n",
    "[dimension]\n",
    "kind = ",
    "from = ",
    "to = ",
    "of = ",
    "at = ",
    "along = ",
    "vertex = ",
    "view = ",
    "side = ",
    "text = ",
    "name = ",
    "size = ",
    "\"linear\"\n",
    "\"diameter\"\n",
    "\"radius\"\n",
    "\"angle\"\n",
    "\"note\"\n",
    "\"hole 1\"\n",
    "\"hole 1.center\"\n",
    "\"x\"\n",
    "\"front\"\n",
    "\"above\"\n",
    "\"M8\"\n",
    "\"M8x1\"\n",
    "[",
    "]",
    ",",
    "1",
    "0.5",
    "-1e400",
    "nan",
    "inf",
    "\n",
    "\"",
    "'",
    "=",
    "#",
    "\\",
    "{",
    "}",
    "\"\"\"",
];

/// Parses up to four options with values; an error has a message that is not empty.
pub fn arguments(bytes: &[u8]) {
    let _ = line(bytes);
}

fn line(bytes: &[u8]) -> Result<()> {
    let mut u = Unstructured::new(bytes);
    let [command, _] = u.choose(&OPTIONS[..])?;
    let own: Vec<&[String; 2]> = OPTIONS.iter().filter(|[name, _]| name == command).collect();
    let mut words = vec![command.clone()];
    for _ in 0..u.int_in_range(1..=4)? {
        let [_, option] = u.choose(&own[..])?;
        let length = u.int_in_range(0..=24)?.min(u.len());
        let value = text(u.bytes(length)?, VALUES)?;
        words.push(format!("{option}={}", String::from_utf8_lossy(&value)));
    }
    let reported = fuzzing::command_line(&words);
    assert!(reported.is_none_or(|reported| !reported.trim().is_empty()), "{words:?}");
    Ok(())
}

/// Parses annotations, as the bytes are and of pieces.
pub fn annotations(bytes: &[u8]) {
    let made = text(bytes, ANNOTATIONS).unwrap_or_default();
    for text in [bytes, &made] {
        let reported = fuzzing::annotations(&String::from_utf8_lossy(text));
        assert!(reported.is_none_or(|reported| !reported.trim().is_empty()));
    }
}
