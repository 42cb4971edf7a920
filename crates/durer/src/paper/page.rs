//! Sizes of paper and scales.

use crate::math::DVec2;
use crate::{Error, Result};
use std::str::FromStr;

/// The paper that a drawing is laid onto.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Page {
    /// Page as large as the drawing needs.
    #[default]
    Fit,
    /// A size that may be turned: the orientation that gives the larger scale is used.
    Either(DVec2),
    /// Width and height in millimetres.
    Exact(DVec2),
}

/// Names and sizes in millimetres, upright: ISO 216, and the American ones of ANSI/ASME Y14.1.
const SIZES: &[(&str, f64, f64)] = &[
    ("a0", 841.0, 1189.0),
    ("a1", 594.0, 841.0),
    ("a2", 420.0, 594.0),
    ("a3", 297.0, 420.0),
    ("a4", 210.0, 297.0),
    ("a5", 148.0, 210.0),
    ("a6", 105.0, 148.0),
    ("letter", 215.9, 279.4),
    ("legal", 215.9, 355.6),
    ("tabloid", 279.4, 431.8),
];

/// The longest side of a page, in millimetres: rolls of paper are shorter.
const LONGEST: f64 = 100_000.0;

impl FromStr for Page {
    type Err = Error;

    /// Parses `A4`, `letter`, … (in either orientation), `A4-landscape`, `A4-portrait`, `WxH` in millimetres, or `fit`.
    fn from_str(text: &str) -> Result<Self> {
        let expected = "fit, A0 … A6, letter, legal, tabloid (also with -portrait or -landscape), or \
                        WIDTHxHEIGHT in millimetres, e.g. 300x200";
        let wrong = || Error::parameter("page", text, expected);
        let lower = text.trim().to_ascii_lowercase();
        if lower == "fit" {
            return Ok(Self::Fit);
        }
        let (name, way) = lower.split_once('-').unwrap_or((lower.as_str(), ""));
        if let Some(&(_, width, height)) = SIZES.iter().find(|s| s.0 == name) {
            return match way {
                "" => Ok(Self::Either(DVec2::new(width, height))),
                "portrait" => Ok(Self::Exact(DVec2::new(width, height))),
                "landscape" => Ok(Self::Exact(DVec2::new(height, width))),
                _ => Err(wrong()),
            };
        }
        let sides = lower.strip_suffix("mm").unwrap_or(&lower);
        let (width, height) = sides.split_once(['x', '×']).ok_or_else(wrong)?;
        let side = |s: &str| s.trim().parse().ok().filter(|s| (1.0..=LONGEST).contains(s));
        let size: Option<(f64, f64)> = side(width).zip(side(height));
        size.map(|(w, h)| Self::Exact(DVec2::new(w, h))).ok_or_else(wrong)
    }
}

/// Scale on the paper.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Scale {
    /// The largest that fits.
    #[default]
    Fit,
    /// The largest of 1:1, 1:2, 1:5, 1:10 … and 2:1, 5:1, 10:1 … (ISO 5455) that fits.
    Standard,
    /// Length on paper over true length, > 0.
    Given(f64),
}

impl FromStr for Scale {
    type Err = Error;

    /// Parses `1:10`, `2:1`, a factor such as `0.5`, or `auto` for [`Scale::Standard`].
    fn from_str(text: &str) -> Result<Self> {
        if text.trim() == "auto" {
            return Ok(Self::Standard);
        }
        let number = |s: &str| s.trim().parse::<f64>().ok();
        let (paper, truth) = text.split_once(':').unwrap_or((text, "1"));
        let ratio = number(paper).zip(number(truth)).map(|(p, t)| p / t);
        match ratio.filter(|r| (1e-9..=1e9).contains(r)) {
            Some(ratio) => Ok(Self::Given(ratio)),
            None => {
                Err(Error::parameter("scale", text, "auto, or a scale such as 1:10, 2:1 or 0.5"))
            }
        }
    }
}

/// Returns the largest standard scale that is no larger than the given one.
pub fn standard_scale(largest: f64) -> f64 {
    if !(largest > 1e-9 && largest < 1e9) {
        return largest;
    }
    // A scale that equals a standard one up to rounding stays.
    let largest = largest * (1.0 + 1e-9);
    // From the small end up: k reads 1:10^9 at first, and 10^9:1 at last.
    let decades = (-9..=9).map(|k: i32| libm::exp10(f64::from(k)));
    let steps = decades.flat_map(|d| [d, 2.0 * d, 5.0 * d]);
    steps.take_while(|s| *s <= largest).last().unwrap_or(largest)
}

/// Returns a scale as written on drawings: `1:10`, `2:1`, `1:3.27`.
pub fn scale_text(scale: f64) -> String {
    let short = |n: f64| {
        let digits = if n >= 100.0 { 0 } else { 2 };
        let text = format!("{n:.digits$}");
        if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        } else {
            text
        }
    };
    if scale >= 1.0 { format!("{}:1", short(scale)) } else { format!("1:{}", short(1.0 / scale)) }
}
