//! Dimensions in DXF: an entity with the measurement, and an anonymous block with its drawing, for readers that do not
//! draw dimensions themselves.

use super::dxf_entity::{block, entity};
use super::dxf_tags::{DIMSTYLES, DxfStrokes, Tags, begin, string, symbol};
use durer::math::DVec2;
use durer::target::dimension::{DimensionText, Measure};
use durer::target::sheet::Dimension;
use durer::target::sheet::{PaperMark, Sheet};

/// The dimensions of a sheet in the order of drawing, with their entries in the file's tables.
pub(super) struct Dimensions<'a> {
    all: Vec<Listed<'a>>,
    /// The distinct values of [`Dimension::units_per_millimetre`], each with a separate style, and the height of its
    /// text.
    styles: Vec<(f64, f64)>,
    strokes: DxfStrokes,
}

struct Listed<'a> {
    layer: String,
    dimension: &'a Dimension,
    /// Its block record.
    record: u32,
}

impl<'a> Dimensions<'a> {
    /// Finds the dimensions of a sheet and gives them handles.
    pub(super) fn of(tags: &mut Tags, sheet: &'a Sheet, strokes: DxfStrokes) -> Self {
        let mut found = Self { all: Vec::new(), styles: Vec::new(), strokes };
        for layer in &sheet.layers {
            for mark in &layer.marks {
                let PaperMark::Dimension(dimension) = mark else { continue };
                let style = (dimension.units_per_millimetre, dimension.text.height);
                if !found.styles.contains(&style) {
                    found.styles.push(style);
                }
                let (layer, record) = (symbol(&layer.name), tags.fresh());
                found.all.push(Listed { layer, dimension, record });
            }
        }
        found
    }

    /// Returns the names and handles of the blocks' records.
    pub(super) fn records(&self) -> impl Iterator<Item = (String, u32)> + '_ {
        self.all.iter().enumerate().map(|(i, d)| (block_name(i), d.record))
    }

    /// Writes the variables that replace a style in programs without styles, such as LibreCAD: those for the scale of
    /// most dimensions.
    pub(super) fn variables(&self, tags: &mut Tags) {
        let count = |style: &(f64, f64)| {
            let own = |d: &Listed| (d.dimension.units_per_millimetre, d.dimension.text.height);
            self.all.iter().filter(|d| own(d) == *style).count()
        };
        // Of equal ones the first.
        let Some((factor, height)) = self.styles.iter().rev().max_by_key(|s| count(s)) else {
            return;
        };
        tags.tag(9, "$DIMLFAC").real(40, *factor).tag(9, "$DIMTXT").real(40, *height);
        tags.tag(9, "$DIMASZ").real(40, height * 6.0 / 7.0);
        tags.tag(9, "$DIMDEC").int(70, 2).tag(9, "$DIMZIN").int(70, 8);
    }

    /// Writes the table of styles: ISO 129, one for each scale.
    pub(super) fn styles(&self, tags: &mut Tags) {
        tags.table("DIMSTYLE", DIMSTYLES, 1 + self.styles.len()).class("AcDbDimStyleTable");
        style(tags, "Standard");
        for (i, (factor, height)) in self.styles.iter().enumerate() {
            style(tags, &style_name(i));
            // Sizes of the arrow, gap and overshoot of extension lines, steps, text and its gap; then the factor.
            let sizes = [(40, 1.0), (41, height * 6.0 / 7.0), (42, 1.0), (43, 8.0), (44, 2.0)];
            let text = [(140, *height), (141, 0.0), (144, *factor), (147, 1.0)];
            sizes.into_iter().chain(text).for_each(|(code, value)| {
                tags.real(code, value);
            });
            // Text is in line with its dimension and above it; no trailing zeros; a decimal point.
            for (code, value) in [(73, 0), (74, 0), (77, 1), (78, 8), (271, 2), (278, 46)] {
                tags.int(code, value);
            }
        }
        tags.tag(0, "ENDTAB");
    }

    /// Writes the blocks that show the dimensions.
    pub(super) fn blocks(&self, tags: &mut Tags, sheet: &Sheet) {
        for (i, listed) in self.all.iter().enumerate() {
            block(tags, &block_name(i), listed.record, |tags| {
                for mark in &listed.dimension.marks {
                    match mark {
                        PaperMark::Fill { rings, .. } => solids(tags, sheet, &listed.layer, rings),
                        _ => entity(tags, sheet, &listed.layer, mark, self.strokes),
                    }
                }
                text(tags, sheet, &listed.layer, &listed.dimension.text);
            });
        }
    }

    /// Writes the entity of the dimension with a number.
    pub(super) fn write(
        &self,
        tags: &mut Tags,
        sheet: &Sheet,
        layer: &str,
        dimension: &Dimension,
        number: usize,
    ) {
        let style = (dimension.units_per_millimetre, dimension.text.height);
        let style = self.styles.iter().position(|s| *s == style).unwrap_or(0);
        let place = |p: DVec2| DVec2::new(p.x, sheet.size.y - p.y);
        let (kind, definition) = match dimension.measure {
            Measure::Linear { line, .. } => (0, line),
            Measure::Diameter { ends } => (3, ends[0]),
            Measure::Radius { center, .. } => (4, center),
            Measure::Angle { arc, .. } => (5, arc),
        };
        begin(tags, "DIMENSION", layer, None);
        tags.class("AcDbDimension").tag(2, &block_name(number));
        tags.point3(10, place(definition)).point3(11, place(middle(&dimension.text)));
        // 32: no other entity uses the block; 128: the text keeps its place.
        tags.int(70, kind | 32 | 128).int(71, 5);
        let words = if dimension.is_plain { String::new() } else { words(&dimension.text.text) };
        tags.tag(1, &words).real(42, dimension.value).tag(3, &style_name(style));
        match dimension.measure {
            Measure::Linear { ends, along, .. } => {
                tags.class("AcDbAlignedDimension");
                tags.point3(13, place(ends[0])).point3(14, place(ends[1]));
                tags.real(50, degrees(along)).class("AcDbRotatedDimension");
            }
            Measure::Diameter { ends } => {
                tags.class("AcDbDiametricDimension").point3(15, place(ends[1])).real(40, 0.0);
            }
            Measure::Radius { at, .. } => {
                tags.class("AcDbRadialDimension").point3(15, place(at)).real(40, 0.0);
            }
            Measure::Angle { vertex, ends, .. } => {
                tags.class("AcDb3PointAngularDimension");
                tags.point3(13, place(ends[0])).point3(14, place(ends[1]));
                tags.point3(15, place(vertex));
            }
        }
    }
}

fn block_name(index: usize) -> String {
    format!("*D{}", index + 1)
}

fn style_name(index: usize) -> String {
    format!("ISO-129-{}", index + 1)
}

fn style(tags: &mut Tags, name: &str) {
    let handle = tags.fresh();
    tags.tag(0, "DIMSTYLE").handle(105, handle).handle(330, DIMSTYLES);
    tags.class("AcDbSymbolTableRecord").class("AcDbDimStyleTableRecord");
    tags.tag(2, name).int(70, 0);
}

/// Returns the text of a dimension. Not all readers know how the format escapes a sign of times.
fn words(text: &str) -> String {
    string(&text.replace('×', "x"))
}

/// Returns the angle of a direction on the sheet, y up, degrees.
fn degrees(along: DVec2) -> f64 {
    // Adding 0 makes a plain 0 of −0.
    libm::atan2(-along.y, along.x).to_degrees() + 0.0
}

/// Returns the middle of a text, between its base line and the top of its capitals.
fn middle(text: &DimensionText) -> DVec2 {
    text.at + DVec2::new(text.along.y, -text.along.x) * (text.height * 0.5)
}

fn text(tags: &mut Tags, sheet: &Sheet, layer: &str, text: &DimensionText) {
    begin(tags, "TEXT", layer, sheet.pens.get(text.pen));
    let at = DVec2::new(text.at.x, sheet.size.y - text.at.y);
    tags.class("AcDbText").point3(10, at).real(40, text.height).tag(1, &words(&text.text));
    tags.real(50, degrees(text.along)).int(72, 1).point3(11, at).class("AcDbText");
}

/// Writes filled triangles.
fn solids(tags: &mut Tags, sheet: &Sheet, layer: &str, rings: &[Vec<DVec2>]) {
    for ring in rings {
        let [a, b, c] = ring[..] else { continue };
        begin(tags, "SOLID", layer, None);
        tags.class("AcDbTrace");
        // The last corner twice: four are requested.
        for (code, p) in [(10, a), (11, b), (12, c), (13, c)] {
            tags.point3(code, DVec2::new(p.x, sheet.size.y - p.y));
        }
    }
}
