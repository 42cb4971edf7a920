//! The parts of DXF files: group codes with their values, handles, pens, and text.

use super::number::push;
use durer::math::DVec2;
use durer::target::sheet::{Pen, Sheet};

/// The line weights that the format has, in hundredths of a millimetre.
const WEIGHTS: &[i64] = &[
    0, 5, 9, 13, 15, 18, 20, 25, 30, 35, 40, 50, 53, 60, 70, 80, 90, 100, 106, 120, 140, 158, 200,
    211,
];

/// Handles of objects that others refer to.
pub(super) const BLOCK_RECORDS: u32 = 0x1;
pub(super) const LAYERS: u32 = 0x2;
pub(super) const STYLES: u32 = 0x3;
pub(super) const LTYPES: u32 = 0x5;
pub(super) const VIEWS: u32 = 0x6;
pub(super) const UCSS: u32 = 0x7;
pub(super) const VPORTS: u32 = 0x8;
pub(super) const APPIDS: u32 = 0x9;
pub(super) const DIMSTYLES: u32 = 0xa;
pub(super) const ROOT: u32 = 0xc;
pub(super) const GROUPS: u32 = 0xd;
pub(super) const MODEL: u32 = 0x1f;
pub(super) const PAPER: u32 = 0x1b;
/// First of the handles that are given out in order.
pub(super) const FIRST: u32 = 0x30;

/// Lengths in metres with their numbers in `$INSUNITS`: inches, feet, millimetres, centimetres, metres, kilometres,
/// yards, and feet of the United States' survey.
const UNITS: [(f64, i64); 8] = [
    (0.0254, 1),
    (FOOT, 2),
    (0.001, 4),
    (0.01, 5),
    (1.0, 6),
    (1000.0, 7),
    (0.9144, 10),
    (SURVEY_FOOT, 21),
];

/// The international foot in metres.
const FOOT: f64 = 0.3048;

/// The foot of the United States' survey in metres.
const SURVEY_FOOT: f64 = 1200.0 / 3937.0;

/// Entity type of strokes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum DxfStrokes {
    /// LWPOLYLINE throughout, arcs as bulges; ellipses and cubic curves as arcs within 0.005 mm.
    #[default]
    Polylines,
    /// LINE, ARC, CIRCLE, ELLIPSE and SPLINE, a piece each; several lines in a row are one LWPOLYLINE.
    Pieces,
}

/// Place of a sheet in the coordinates of a DXF file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DxfFrame {
    /// Lower left corner of the sheet in the file.
    pub origin: DVec2,
    /// Units of the file per millimetre of the sheet, > 0. Line weights are millimetres in any frame, and dashes have the
    /// lengths that they have on the sheet.
    pub units_per_millimetre: f64,
    /// Length of a unit of the file in metres; `None` if units are no lengths, such as degrees, or are not known.
    pub unit: Option<f64>,
    /// Number of digits after the point.
    pub digits: usize,
}

impl Default for DxfFrame {
    /// Returns the frame in millimetres from the sheet's corner: micrometres are the last digit.
    fn default() -> Self {
        Self { origin: DVec2::ZERO, units_per_millimetre: 1.0, unit: Some(0.001), digits: 6 }
    }
}

impl DxfFrame {
    /// Returns whether the file's units are millimetres from the sheet's corner.
    pub(super) fn is_sheet(&self) -> bool {
        (self.origin, self.units_per_millimetre) == (DVec2::ZERO, 1.0)
    }

    /// Returns the unit of the file by its number in `$INSUNITS`: 0 if it has none.
    pub(super) fn insertion_units(&self) -> i64 {
        let is = |length: f64| self.unit.is_some_and(|unit| (unit / length - 1.0).abs() < 1e-7);
        UNITS.iter().find(|(length, _)| is(*length)).map_or(0, |(_, number)| *number)
    }

    /// Returns a place that is given in millimetres from the lower left corner of the sheet.
    pub(super) fn place(&self, p: DVec2) -> DVec2 {
        self.origin + p * self.units_per_millimetre
    }
}

/// Group codes and values, a line each.
pub(super) struct Tags {
    pub text: String,
    /// The place of the sheet in the file.
    pub frame: DxfFrame,
    /// The next free handle.
    pub next: u32,
    /// The block record that entities belong to.
    pub owner: u32,
    /// The line type of the layer.
    pub line_type: String,
    /// The colour of the layer; `None` in blocks.
    pub color: Option<[u8; 4]>,
    /// The dashed line types.
    pub dashed: Vec<Dashed>,
}

/// A line type of dashes.
pub(super) struct Dashed {
    pub name: String,
    /// Lengths of dashes and gaps in turn, in millimetres.
    pub lengths: Vec<f64>,
}

impl Dashed {
    /// Returns whether dashes are long and short by turns.
    pub fn is_center(&self) -> bool {
        self.lengths.len() > 3
    }

    /// Returns the line types of a sheet's pens: HIDDEN and CENTER, and further ones with numbers.
    pub fn of_sheet(sheet: &Sheet) -> Vec<Self> {
        let mut all: Vec<Self> = Vec::new();
        for pen in sheet.pens.iter().filter(|pen| !pen.dashes.is_empty()) {
            if all.iter().any(|known| known.lengths == pen.dashes) {
                continue;
            }
            let mut dashed = Self { name: String::new(), lengths: pen.dashes.clone() };
            let is_center = dashed.is_center();
            let base = if is_center { "CENTER" } else { HIDDEN };
            let number = all.iter().filter(|known| known.is_center() == is_center).count();
            dashed.name =
                if number == 0 { base.to_owned() } else { format!("{base}{}", number + 1) };
            all.push(dashed);
        }
        all
    }
}

impl Tags {
    /// Creates an empty part of a file of a sheet.
    pub fn new(sheet: &Sheet, frame: DxfFrame, next: u32) -> Self {
        let (text, line_type) = (String::new(), CONTINUOUS.to_owned());
        let dashed = Dashed::of_sheet(sheet);
        Self { text, frame, next, owner: MODEL, line_type, color: None, dashed }
    }

    /// Returns the name of a pen's line type.
    pub fn line_type(&self, pen: Option<&Pen>) -> String {
        let dashed = pen.and_then(|pen| self.dashed.iter().find(|d| d.lengths == pen.dashes));
        dashed.map_or(CONTINUOUS, |dashed| &dashed.name).to_owned()
    }

    pub fn tag(&mut self, code: u16, value: &str) -> &mut Self {
        self.text += &format!("{code:>3}\n{value}\n");
        self
    }

    pub fn int(&mut self, code: u16, value: i64) -> &mut Self {
        self.tag(code, &value.to_string())
    }

    pub fn handle(&mut self, code: u16, value: u32) -> &mut Self {
        self.tag(code, &format!("{value:X}"))
    }

    /// Writes a real number with six digits after the point: micrometres are the last.
    pub fn real(&mut self, code: u16, value: f64) -> &mut Self {
        self.precise(code, value, 6)
    }

    /// Writes a real number with this many digits after the point.
    pub fn precise(&mut self, code: u16, value: f64, digits: usize) -> &mut Self {
        let mut text = String::new();
        push(&mut text, value, digits);
        // Readers want the zero before the point, and some the point.
        let text = match (text.strip_prefix('.'), text.strip_prefix("-.")) {
            (Some(rest), _) => format!("0.{rest}"),
            (_, Some(rest)) => format!("-0.{rest}"),
            _ if text.contains('.') => text,
            _ => format!("{text}.0"),
        };
        self.tag(code, &text)
    }

    pub fn point(&mut self, code: u16, p: DVec2) -> &mut Self {
        self.real(code, p.x).real(code + 10, p.y)
    }

    pub fn point3(&mut self, code: u16, p: DVec2) -> &mut Self {
        self.point(code, p).real(code + 20, 0.0)
    }

    /// Writes a vector of the sheet, in millimetres.
    pub fn vector(&mut self, code: u16, v: DVec2) -> &mut Self {
        self.length(code, v.x).length(code + 10, v.y)
    }

    /// Writes a length of the sheet, in millimetres.
    pub fn length(&mut self, code: u16, length: f64) -> &mut Self {
        self.precise(code, length * self.frame.units_per_millimetre, self.frame.digits)
    }

    /// Writes a place of the sheet, in millimetres from its lower left corner.
    pub fn place(&mut self, code: u16, p: DVec2) -> &mut Self {
        let (p, digits) = (self.frame.place(p), self.frame.digits);
        self.precise(code, p.x, digits).precise(code + 10, p.y, digits)
    }

    pub fn place3(&mut self, code: u16, p: DVec2) -> &mut Self {
        self.place(code, p).real(code + 20, 0.0)
    }

    pub fn class(&mut self, name: &str) -> &mut Self {
        self.tag(100, name)
    }

    pub fn section(&mut self, name: &str) -> &mut Self {
        self.tag(0, "SECTION").tag(2, name)
    }

    pub fn fresh(&mut self) -> u32 {
        self.next += 1;
        self.next - 1
    }

    pub fn table(&mut self, name: &str, handle: u32, count: usize) -> &mut Self {
        self.tag(0, "TABLE").tag(2, name).handle(5, handle).handle(330, 0);
        self.class("AcDbSymbolTable").int(70, count as i64)
    }

    /// Writes the common start of a table's entry.
    pub fn record(&mut self, kind: &str, table: u32, class: &str) -> &mut Self {
        let handle = self.fresh();
        self.tag(0, kind).handle(5, handle).handle(330, table);
        self.class("AcDbSymbolTableRecord").class(class)
    }
}

/// The names of the solid and of the first dashed line type.
pub(super) const CONTINUOUS: &str = "CONTINUOUS";
pub(super) const HIDDEN: &str = "HIDDEN";

/// Returns the nearest line weight of the format.
pub(super) fn weight(pen: &Pen) -> i64 {
    let wanted = (pen.width * 100.0).round() as i64;
    WEIGHTS.iter().copied().min_by_key(|w| (w - wanted).abs()).unwrap_or(25)
}

/// Returns the nearest of the palette's first colours and greys; 7 is black on white and white on
/// black.
pub(super) fn palette([r, g, b, _]: [u8; 4]) -> i64 {
    const COLORS: [([u8; 3], i64); 12] = [
        ([0, 0, 0], 7),
        ([255, 0, 0], 1),
        ([255, 255, 0], 2),
        ([0, 255, 0], 3),
        ([0, 255, 255], 4),
        ([0, 0, 255], 5),
        ([255, 0, 255], 6),
        ([128, 128, 128], 8),
        ([51, 51, 51], 250),
        ([173, 173, 173], 253),
        ([214, 214, 214], 254),
        ([255, 255, 255], 255),
    ];
    let apart = |c: &[u8; 3]| -> i64 {
        c.iter().zip([r, g, b]).map(|(a, b)| (i64::from(*a) - i64::from(b)).pow(2)).sum()
    };
    COLORS.iter().min_by_key(|(c, _)| apart(c)).map_or(7, |(_, index)| *index)
}

/// Writes the exact colour unless it is black, which follows the background.
pub(super) fn true_color(tags: &mut Tags, [r, g, b, _]: [u8; 4]) {
    if [r, g, b] != [0; 3] {
        tags.int(420, (i64::from(r) << 16) | (i64::from(g) << 8) | i64::from(b));
    }
}

/// Layer of an entity, and its colour and width.
pub(super) struct Target<'a> {
    pub layer: &'a str,
    pub pen: Option<&'a Pen>,
}

/// Writes the opacity of a colour that has one.
pub(super) fn transparency(tags: &mut Tags, [.., alpha]: [u8; 4]) {
    if alpha < 255 {
        tags.int(440, (2 << 24) | i64::from(alpha));
    }
}

/// Writes the common start of an entity. Colour, line type and weight are the layer's; they are written here where a
/// layer has marks of several pens.
pub(super) fn begin(tags: &mut Tags, kind: &str, layer: &str, pen: Option<&Pen>) {
    let (handle, owner) = (tags.fresh(), tags.owner);
    tags.tag(0, kind).handle(5, handle).handle(330, owner).class("AcDbEntity").tag(8, layer);
    if let Some(pen) = pen {
        let line_type = tags.line_type(Some(pen));
        if line_type != tags.line_type {
            tags.tag(6, &line_type);
        }
        let is_own = |layer: [u8; 4]| layer[..3] != pen.color[..3];
        let has_own = tags.color.is_some_and(is_own);
        if has_own {
            tags.int(62, palette(pen.color));
        }
        tags.int(370, weight(pen));
        if has_own {
            true_color(tags, pen.color);
        }
        transparency(tags, pen.color);
    }
}

/// Returns a name of a table's entry: the format forbids a few characters.
pub(super) fn symbol(name: &str) -> String {
    string(&name.replace(['<', '>', '/', '\\', '"', ':', ';', '?', '*', '|', ',', '=', '`'], "_"))
}

/// Returns text on one line; `^` and characters beyond ASCII are escaped as the format requires.
pub(super) fn string(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '°' => out += "%%d",
            '±' => out += "%%p",
            'Ø' | '⌀' => out += "%%c",
            // Stroke fonts lack it.
            '–' => out.push('-'),
            '^' => out += "^ ",
            c if c.is_control() => out.push(' '),
            c if c.is_ascii() => out.push(c),
            c => c.encode_utf16(&mut [0; 2]).iter().for_each(|u| out += &format!("\\U+{u:04X}")),
        }
    }
    out
}
