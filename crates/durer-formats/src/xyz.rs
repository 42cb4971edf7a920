//! Point clouds as text: one point per line, of three coordinates and optional further values.
//!
//! There is no standard: the files of scanners and of CloudCompare, MeshLab and Open3D have the suffixes `.xyz`,
//! `.xyzrgb`, `.pts`, `.asc`, `.txt` and `.csv`. Numbers are separated by blanks, commas or semicolons; commas are decimal signs
//! if blanks or semicolons separate three or more numbers with at most one comma each. A first line of
//! one number is the count of points (Leica's PTS, several times if there are several scans); other lines without
//! numbers before the first point are comments, and give the meaning of each column if they name `x`, `y` and `z`.
//! Otherwise columns after the third are recognized by their values: three from 0 to 255 (or to 1, and not beyond) are
//! colours, but unit vectors behind the coordinates are normals, which points are shown without; of seven columns the
//! fourth is the intensity. z is up.
//!
//! Cost: two passes over the text if there are more than three columns. Memory: 24 bytes per point
//! while reading, 16 more with colours.

use crate::cloud::Cloud;
use crate::text::{Tally, quote, utf8, with_decimal_comma};
use crate::{Error, Model, Place, ReadOptions, Resources, Result, number};
use durer::math::{DVec3, Vec4};

/// Columns that are examined.
const COLUMNS: usize = 12;

/// Reads a text of points.
///
/// # Errors
/// [`Error::Decode`] for a text whose first lines hold no point; [`Error::Limit`] for more points than
/// allowed.
pub fn read(bytes: &[u8], _resources: &dyn Resources, options: &ReadOptions) -> Result<Model> {
    let text = utf8(bytes);
    let mut model = Model { format: "point cloud, text".to_owned(), ..Model::default() };
    let mut table = Table::default();
    let mut cloud = Cloud { full: 1.0, ..Cloud::default() };
    let mut odd = Tally::default();
    for (line, words) in lines(&text) {
        match numbers(words) {
            Some((values, count)) if count > table.last_place() => {
                let [x, y, z] = table.place.map(|column| values[column]);
                cloud.points.push(DVec3::new(x, y, z));
                table.note(&values, count);
            }
            Some((_, 1)) => {}
            Some((_, 0)) => table.name(words),
            _ if cloud.points.is_empty() => table.head(line, words)?,
            _ => odd.add(|| Place::Line(line, 0)),
        }
        let count = cloud.points.len() as u64;
        cloud.make_room(count, || Place::Line(line, 0), &options.limits)?;
    }
    model.warn_of(&odd, "{line holds no point and was|lines hold no point and were} skipped");
    if cloud.points.is_empty() {
        return Err(Error::whole("no line holds the three coordinates of a point"));
    }
    table.add_colors(&text, &mut cloud);
    cloud.into_model(model)
}

/// Number of bytes, and of lines with numbers, that tell whether a text holds points.
const PROBE: (usize, usize) = (16 << 10, 20);

/// Returns whether the first lines of a text hold points: as many numbers each, at least three. Comments, lines of one
/// number and names of columns do not count.
pub fn sniff(bytes: &[u8]) -> bool {
    let head = bytes.get(..PROBE.0).unwrap_or(bytes);
    let mut text = utf8(head).into_owned();
    if head.len() < bytes.len() {
        // The last line may be cut.
        let end = text.iter().rposition(|&b| matches!(b, b'\n' | b'\r')).unwrap_or(0);
        text.truncate(end);
    }
    let (mut table, mut columns) = (Table::default(), None);
    let mut found = 0;
    for (_, words) in lines(&text).take(PROBE.1) {
        match numbers(words) {
            Some((_, 0 | 1)) => {}
            Some((_, count @ 3..)) if columns.is_none_or(|columns| columns == count) => {
                (columns, found) = (Some(count), found + 1);
            }
            None if found == 0 => {
                table.name(words);
                if !table.named {
                    return false;
                }
            }
            _ => return false,
        }
    }
    found > 0
}

/// Returns the lines that are not empty, with their numbers.
fn lines(text: &[u8]) -> impl Iterator<Item = (u64, &[u8])> {
    let lines = text.split(|&b| b == b'\n').zip(1..);
    // A file of old Macintosh has other line ends, and no other.
    let lines = lines.flat_map(|(line, n)| line.split(|&b| b == b'\r').map(move |l| (n, l)));
    lines.map(|(n, line)| (n, line.trim_ascii())).filter(|(_, line)| !line.is_empty())
}

fn separates(byte: u8) -> bool {
    byte.is_ascii_whitespace() || matches!(byte, b',' | b';')
}

/// Returns the numbers of a line and their count, 0 for a comment; `None` if a word is not a number.
fn numbers(line: &[u8]) -> Option<([f64; COLUMNS], usize)> {
    let (mut values, mut count) = ([0.0; COLUMNS], 0);
    if line.starts_with(b"#") || line.starts_with(b"//") {
        return Some((values, 0));
    }
    if let Some(found) = decimal_commas(line) {
        return Some(found);
    }
    let mut rest = line;
    while let Some(start) = rest.iter().position(|&b| !separates(b)) {
        rest = rest.get(start..)?;
        let (value, length) = number::float(rest)?;
        rest = rest.get(length..)?;
        if rest.first().is_some_and(|&b| !separates(b)) {
            return None;
        }
        if let Some(to) = values.get_mut(count) {
            *to = value;
            count += 1;
        }
    }
    Some((values, count))
}

/// Returns the numbers of a line whose commas are decimal signs, and their count: three words or more, parted by blanks
/// or semicolons, each with at most one comma between digits and without a point.
fn decimal_commas(line: &[u8]) -> Option<([f64; COLUMNS], usize)> {
    if !line.contains(&b',') || line.contains(&b'.') {
        return None;
    }
    let (mut values, mut count) = ([0.0; COLUMNS], 0);
    let words = line.split(|&b| b.is_ascii_whitespace() || b == b';');
    for word in words.filter(|word| !word.is_empty()) {
        let whole =
            || number::float(word).filter(|(_, n)| *n == word.len()).map(|(value, _)| value);
        let value = with_decimal_comma(word).or_else(whole)?;
        if let Some(to) = values.get_mut(count) {
            *to = value;
            count += 1;
        }
    }
    (count >= 3).then_some((values, count))
}

/// Facts about the columns.
struct Table {
    /// The columns of x, y and z.
    place: [usize; 3],
    color: Option<usize>,
    intensity: Option<usize>,
    /// True if a line has named the columns.
    named: bool,
    /// Number of columns in the lines: the fewest.
    count: usize,
    least: [f64; COLUMNS],
    most: [f64; COLUMNS],
    whole: [bool; COLUMNS],
    /// True if the three columns after the coordinates have been a unit vector in all lines.
    unit: bool,
    /// Lines before the first point.
    head: u64,
}

impl Default for Table {
    fn default() -> Self {
        Self {
            place: [0, 1, 2],
            color: None,
            intensity: None,
            named: false,
            count: COLUMNS,
            least: [f64::INFINITY; COLUMNS],
            most: [f64::NEG_INFINITY; COLUMNS],
            whole: [true; COLUMNS],
            unit: true,
            head: 0,
        }
    }
}

impl Table {
    /// Returns the last column of a coordinate.
    fn last_place(&self) -> usize {
        let [x, y, z] = self.place;
        x.max(y).max(z)
    }

    /// Records the properties of a line's values.
    fn note(&mut self, values: &[f64; COLUMNS], count: usize) {
        self.count = self.count.min(count);
        for (column, &value) in values.iter().enumerate().take(count).skip(3) {
            self.least[column] = self.least[column].min(value);
            self.most[column] = self.most[column].max(value);
            self.whole[column] &= value.fract() == 0.0;
        }
        let length = values[3].hypot(values[4]).hypot(values[5]);
        self.unit &= count >= 6 && (length - 1.0).abs() < 0.01;
    }

    /// Reads a line before the first point that is not a comment.
    fn head(&mut self, line: u64, words: &[u8]) -> Result<()> {
        self.head += 1;
        self.name(words);
        // Chemistry has the same ending: a count, a title, and lines of a symbol and three numbers.
        let symbol = words.iter().position(|&b| separates(b)).and_then(|end| {
            numbers(words.get(end..)?).filter(|(_, count)| *count == 3 && self.head > 1)
        });
        if symbol.is_some() {
            let message = "a word and three coordinates: molecules are not read, only points";
            return Err(Error::line(line, 0, message));
        }
        if self.head > 20 {
            let message =
                format!("`{}` is not a point; a line holds three coordinates", quote(words));
            return Err(Error::line(line, 0, message));
        }
        Ok(())
    }

    /// Reads the names of columns from a line, if it names the coordinates.
    fn name(&mut self, line: &[u8]) {
        let line = line.to_ascii_lowercase();
        let words = line.split(|&b| separates(b) || matches!(b, b'/' | b'#' | b'"'));
        let words: Vec<&[u8]> = words.filter(|w| !w.is_empty()).take(COLUMNS).collect();
        let of = |names: &[&[u8]]| words.iter().position(|w| names.contains(w));
        let place = [of(&[b"x"]), of(&[b"y"]), of(&[b"z"])];
        let [Some(x), Some(y), Some(z)] = place else { return };
        self.place = [x, y, z];
        self.named = true;
        self.color = of(&[b"r", b"red"]);
        self.intensity = of(&[b"i", b"intensity", b"scalar_intensity", b"reflectance"]);
    }

    /// Returns the range of three columns if they hold colours.
    fn full_scale(&self, first: usize) -> Option<f32> {
        let columns = first..first + 3;
        if columns.end > self.count {
            return None;
        }
        let least = columns.clone().all(|c| self.least[c] >= 0.0);
        let most = columns.clone().map(|c| self.most[c]).fold(0.0, f64::max);
        let whole = columns.clone().all(|c| self.whole[c]);
        match (least, whole) {
            (true, _) if most <= 1.0 => Some(1.0),
            (true, true) if most <= 255.0 => Some(255.0),
            (true, true) if most <= 65535.0 => Some(65535.0),
            _ => None,
        }
    }

    /// Determines the meaning of the columns after the third.
    fn guess(&mut self) {
        if self.named {
            return;
        }
        let candidates: &[usize] = match self.count {
            0..=5 => &[],
            // x y z i r g b, as Leica's; x y z r g b with a value behind, as CloudCompare's.
            7 if self.full_scale(4).is_some() => &[4],
            // MeshLab's x y z and a normal.
            _ if self.unit => &[6, 7],
            _ => &[3, 4, 6, 7],
        };
        self.color = candidates.iter().copied().find(|&c| self.full_scale(c).is_some());
        self.intensity = (self.count == 4 || self.color == Some(4)).then_some(3);
    }

    /// Reads colours and intensities, in a second pass.
    fn add_colors(&mut self, text: &[u8], cloud: &mut Cloud) {
        self.guess();
        let scale = self.color.and_then(|c| Some((c, self.full_scale(c)?)));
        let intensity = self.intensity.filter(|&i| i < self.count);
        if scale.is_none() && intensity.is_none() {
            return;
        }
        for (_, words) in lines(text) {
            let Some((values, count)) = numbers(words) else { continue };
            if count <= self.last_place() {
                continue;
            }
            if let Some((c, full)) = scale {
                let [r, g, b] = [values[c], values[c + 1], values[c + 2]].map(|v| v as f32);
                cloud.full = full;
                cloud.colors.push(Vec4::new(r, g, b, 1.0));
            }
            cloud.intensities.extend(intensity.map(|i| values[i] as f32));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::NoResources;
    use durer::math::Vec3;
    use durer::scene::{Mesh, Topology, UpAxis};

    fn read_ok(text: &str) -> Model {
        read(text.as_bytes(), &NoResources, &ReadOptions::default()).expect("readable")
    }

    fn mesh(text: &str) -> Mesh {
        let mut model = read_ok(text);
        assert!(model.warnings.is_empty(), "{:?}", model.warnings);
        assert_eq!(model.scene.up_axis, UpAxis::Z);
        model.scene.meshes.remove(0)
    }

    #[test]
    fn coordinates_alone() {
        for text in [
            "1 2 3\n4 5 6\n",
            "2\r\n1,2,3\r\n4;5; 6",
            "# x\n\n1 2 3\r4 5 6\r",
            "\u{feff}1\t2\t3\n 4 5 6",
        ] {
            let mesh = mesh(text);
            assert_eq!(mesh.positions, [Vec3::new(1.0, 2.0, 3.0), Vec3::new(4.0, 5.0, 6.0)]);
            assert_eq!((mesh.topology, mesh.colors.len()), (Topology::Points, 0));
        }
    }

    #[test]
    fn columns_are_reported_by_their_values() {
        let red = Vec4::new(1.0, 0.0, 0.0, 1.0);
        for text in [
            "0 0 0 255 0 0\n1 1 1 0 0 255",
            "0 0 0 1.0 0 0\n1 1 1 0 0 0.5",
            "2\n0 0 0 -1204 255 0 0\n1 1 1 7 0 0 255",
            "0 0 0 255 0 0 0.25\n1 1 1 0 255 0 -3",
            "0 0 0 0.6 -0.8 0 255 0 0\n1 1 1 1 0 0 0 9 0",
            "//X Y Z R G B\n0 0 0 255 0 0\n1 1 1 0 0 255",
            "label;x;y;z;intensity;red;green;blue\n7;0;0;0;3;255;0;0\n9;1;1;1;4;0;0;255",
            "0 0 0 65535 0 0\n1 1 1 0 0 65535",
            "0 0 0 1 0 0\n1 1 1 1 1 0",
            "0 0 0 0 0 1 255 0 0\n1 1 1 0 0.6 0.8 9 0 0",
        ] {
            assert_eq!(mesh(text).colors[0], red, "{text}");
            assert_eq!(mesh(text).positions[1], Vec3::ONE, "{text}");
        }
        for normals in ["0 0 0 0.6 -0.8 0\n1 1 1 1 0 0", "0 0 0 0 0 1\n1 1 1 0 0.6 0.8"] {
            assert!(mesh(normals).colors.is_empty());
        }
        let greys = mesh("0 0 0 -1204\n1 1 1 2000").colors;
        assert!(greys[0].x < 0.02 && greys[1].x == 1.0, "{greys:?}");
    }

    #[test]
    fn lines_of_numbers_are_points() {
        for (text, expected) in [
            ("1 2 3\n", true),
            ("2\n1,2,3,4\n5,6,7,8", true),
            ("//X Y Z R G B\n0 0 0 255 0 0\n", true),
            ("x;y;z\r\n1;2;3\r\n", true),
            ("1 2 3\n1 2\n", false),
            ("1 2 3\nend\n", false),
            ("id;name;z\n1;2;3\n", false),
            ("1 2\n3 4\n", false),
            ("7\n", false),
            ("", false),
        ] {
            assert_eq!(sniff(text.as_bytes()), expected, "{text}");
        }
        let cut = "1 2 3\n".repeat(PROBE.0 / 6) + "1 2 3 4";
        assert!(sniff(&cut.as_bytes()[..cut.len() - 2]));
    }

    #[test]
    fn what_is_no_point_is_reported() {
        let model = read_ok("0 0 0\n1 1\nend of scan\n1 1 1\n");
        assert_eq!(model.scene.meshes[0].positions.len(), 2);
        assert_eq!(model.warnings[0].to_string(), "line 2: 2 lines hold no point and were skipped");
        for (text, expected) in [
            ("", "no line holds"),
            ("5\n", "no line holds"),
            (
                "3\nwater\nO 0 0 0\nH 0 0 1\nH 0 1 0\n",
                "line 3: a word and three coordinates: molecules",
            ),
            (&"word\n".repeat(30), "line 21: `word` is not a point"),
        ] {
            let e = read(text.as_bytes(), &NoResources, &ReadOptions::default());
            let found = e.expect_err("broken").to_string();
            assert!(found.contains(expected), "{found}");
        }
    }

    #[test]
    fn far_off_points_keep_their_detail() {
        let model =
            read_ok("4500000.001 5100000 300\n4500000.002 5100000 300\n4500001 5100001 301");
        let at = |i: usize| model.scene.meshes[0].positions[i].x;
        assert!((at(1) - at(0) - 0.001).abs() < 1e-6);
    }
}
