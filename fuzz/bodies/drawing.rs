//! The laws that hold for any bytes, read as a drawing: the body of the fuzz target `drawing`, which
//! the tests call as well.

use arbitrary::{Result, Unstructured};
use durer::math::{DAffine2, DVec2};
use durer::raster::paint::{Canvas, Options};
use durer::target::Pixels;
use durer_formats::svg::{Drawing, ReadOptions};

const ELEMENTS: &[&str] = &[
    "<g",
    "<path d='M0 0C9 0 9 9 0 9Z'",
    "<path d='M1 1L9 9h-5v-3q2 2 3 0t1 1s2 2 3 3A5 3 20 1 0 9 9'",
    "<path",
    "<polygon points='0,0 9,0 4,9'",
    "<polyline points='1,1 1,1 8,3'",
    "<rect width='7' height='5'",
    "<circle r='5'",
    "<ellipse rx='6' ry='3'",
    "<line x1='1' y1='2' x2='9' y2='8'",
    "<use href='#a'",
    "<use href='#b'",
    "<clipPath",
    "<mask",
    "<pattern width='3' height='2' patternUnits='userSpaceOnUse'",
    "<linearGradient",
    "<radialGradient",
    "<stop",
    "<marker",
    "<symbol",
    "<svg",
    "<image href='a.png' width='3' height='3'",
    "<text",
    "<switch",
    "<filter",
];

const ATTRIBUTES: &[&str] = &[
    "id='a'",
    "id='b'",
    "href='#a'",
    "href='#b'",
    "fill='url(#a)'",
    "fill='none'",
    "fill='#c00'",
    "stroke='url(#b)'",
    "stroke='#0a0'",
    "clip-path='url(#a)'",
    "mask='url(#b)'",
    "marker-mid='url(#a)'",
    "filter='url(#b)'",
    "fill-rule='evenodd'",
    "clip-rule='evenodd'",
    "stroke-linecap='round'",
    "stroke-linecap='square'",
    "stroke-linejoin='round'",
    "gradientUnits='userSpaceOnUse'",
    "clipPathUnits='objectBoundingBox'",
    "patternContentUnits='objectBoundingBox'",
    "spreadMethod='reflect'",
    "style='display:none;fill:red'",
    "viewBox='0 0 0 9'",
    "viewBox='0 0 20 9'",
    "shape-rendering='crispEdges'",
];

const NUMBERS: &[&str] = &[
    "stroke-width",
    "stroke-dasharray",
    "stroke-dashoffset",
    "stroke-miterlimit",
    "opacity",
    "fill-opacity",
    "offset",
    "x",
    "y",
    "width",
    "height",
    "r",
    "rx",
    "fx",
    "font-size",
];

const VALUES: &[&str] = &[
    "0", "1", "-1", "0.5", "3", "1e30", "-1e30", "1e-30", "1e999", "nan", "50%", "2em", "7mm",
    "3 0", "1 2 3",
];

const TRANSFORMS: &[&str] = &[
    "rotate(30)",
    "scale(0)",
    "scale(-2 1)",
    "scale(1e20)",
    "matrix(1 2 3 4 5 6)",
    "matrix(1 2 2 4 0 0)",
    "translate(3)",
    "skewX(90)",
    "translate(1e30)",
];

/// The bytes as they are, and as elements and attributes.
pub fn drawing(bytes: &[u8]) {
    draw(bytes);
    if let Ok(text) = text(bytes) {
        draw(text.as_bytes());
    }
}

/// Reads and paints, whatever comes out.
fn draw(bytes: &[u8]) {
    let Ok(drawing) = Drawing::read(bytes, &ReadOptions::default()) else { return };
    let size = drawing.size();
    assert!(size.is_finite() && size.cmpgt(DVec2::ZERO).all(), "{size}");
    let mut canvas = Canvas::new(24, 17, Options::default()).expect("small");
    drawing.draw(&mut canvas, DAffine2::from_scale(DVec2::new(24.0, 17.0) / size));
    canvas.render(&mut Pixels::new(24, 17, [0; 4])).expect("the same size");
}

/// Returns a document that is well-formed.
fn text(bytes: &[u8]) -> Result<String> {
    let mut u = Unstructured::new(bytes);
    let mut text = "<svg xmlns='http://www.w3.org/2000/svg' width='20' height='15'>".to_owned();
    let mut open = vec!["svg"];
    while !u.is_empty() && text.len() < 4096 {
        let element = *u.choose(ELEMENTS)?;
        text += element;
        let mut seen: Vec<&str> = element.split([' ', '=']).collect();
        for _ in 0..u.int_in_range(0..=4)? {
            let (name, value) = match u.int_in_range(0..=3)? {
                0 => (*u.choose(NUMBERS)?, format!("'{}'", u.choose(VALUES)?)),
                1 => (
                    ["transform", "gradientTransform"][usize::from(u.arbitrary::<bool>()?)],
                    format!("'{}'", u.choose(TRANSFORMS)?),
                ),
                _ => {
                    let (name, value) = u.choose(ATTRIBUTES)?.split_once('=').unwrap_or_default();
                    (name, value.to_owned())
                }
            };
            if !seen.contains(&name) {
                seen.push(name);
                text += &format!(" {name}={value}");
            }
        }
        match u.int_in_range(0..=3)? {
            0 | 1 => text += "/>",
            2 => {
                text += ">";
                open.push(element[1..].split(' ').next().unwrap_or_default());
            }
            _ => {
                text += "/>";
                if open.len() > 1 {
                    text += &format!("</{}>", open.pop().unwrap_or_default());
                }
            }
        }
    }
    open.iter().rev().for_each(|name| text += &format!("</{name}>"));
    Ok(text)
}
