//! `--annotations`: dimensions, notes and threads from a TOML file.

use crate::failure::Failure;
use crate::input;
use crate::options::drawing::thread;
use crate::toml_words::fault;
use durer::annotate::{Along, FeaturePlace, Request, Thread, ViewSide, What};
use durer::math::DVec3;
use std::path::Path;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// More than anybody writes.
const MOST_BYTES: u64 = 1 << 20;

/// The contents of the file.
#[derive(Debug, Default, PartialEq)]
pub struct Listed {
    pub dimensions: Vec<Request>,
    pub threads: Vec<Thread>,
}

/// Reads the file.
pub fn read(path: &Path) -> Result<Listed, Failure> {
    let bytes = input::bytes(path, MOST_BYTES)?;
    let wrong = |what: String| Failure::Usage(format!("--annotations {}: {what}", path.display()));
    let text = String::from_utf8(bytes).map_err(|_| wrong("it is not a UTF-8 text".to_owned()))?;
    parse(&text).map_err(|(offset, what)| {
        let line = text.bytes().take(offset).filter(|b| *b == b'\n').count() + 1;
        wrong(format!("line {line}: {what}"))
    })
}

/// Offset of an error in the file and its message.
pub type Wrong = (usize, String);

/// Parses the text of the file.
pub fn parse(text: &str) -> Result<Listed, Wrong> {
    let table = DeTable::parse(text)
        .map_err(|e| (e.span().map_or(0, |s| s.start), fault(e.message()).to_owned()))?;
    let mut listed = Listed::default();
    for (key, value) in table.get_ref() {
        let start = key.span().start;
        let name = key.get_ref().as_ref();
        if !matches!(name, "dimension" | "thread") {
            return Err((start, format!("`{name}`: there are [[dimension]] and [[thread]]")));
        }
        let DeValue::Array(entries) = value.get_ref() else {
            return Err((start, format!("`{name}` needs double brackets: [[{name}]]")));
        };
        for entry in entries.iter() {
            let DeValue::Table(keys) = entry.get_ref() else {
                return Err((start, format!("`{name}` needs double brackets: [[{name}]]")));
            };
            let entry = Entry { keys, start: entry.span().start };
            match name {
                "thread" => listed.threads.push(entry.thread()?),
                _ => listed.dimensions.push(entry.request()?),
            }
        }
    }
    Ok(listed)
}

/// One table.
struct Entry<'a> {
    keys: &'a DeTable<'a>,
    start: usize,
}

impl Entry<'_> {
    fn thread(&self) -> Result<Thread, Wrong> {
        self.only(&["name", "size"])?;
        let name = self.needed("name", Self::text)?;
        let (at, size) = match self.text("size")? {
            Some(size) => (self.at("size"), format!("{name}={size}")),
            // A name may have an equals sign in it.
            None => return Ok(Thread { name, size: None }),
        };
        thread(&size).map_err(|e| (at, e))
    }

    fn request(&self) -> Result<Request, Wrong> {
        let kind = self.needed("kind", Self::text)?;
        let own: &[&str] = match kind.as_str() {
            "linear" => &["from", "to", "along"],
            "diameter" | "radius" => &["of"],
            "angle" => &["vertex", "from", "to"],
            "note" => &["at"],
            _ => {
                let what =
                    format!("kind `{kind}`: there are linear, diameter, radius, angle, note");
                return Err((self.at("kind"), what));
            }
        };
        self.only(&[own, &["kind", "view", "side", "text"]].concat())?;
        let what = match kind.as_str() {
            "linear" => What::Linear {
                from: self.needed("from", Self::place)?,
                to: self.needed("to", Self::place)?,
                along: self.along()?,
            },
            "diameter" => What::Diameter(self.needed("of", Self::text)?),
            "radius" => What::Radius(self.needed("of", Self::text)?),
            "angle" => What::Angle {
                vertex: self.needed("vertex", Self::place)?,
                from: self.needed("from", Self::place)?,
                to: self.needed("to", Self::place)?,
            },
            _ => What::Note(self.needed("at", Self::place)?),
        };
        let text = match kind.as_str() {
            "note" => Some(self.needed("text", Self::text)?),
            _ => self.text("text")?,
        };
        Ok(Request { what, view: self.text("view")?, side: self.side()?, text })
    }

    fn get(&self, name: &str) -> Option<&Spanned<DeValue<'_>>> {
        self.keys.iter().find(|(key, _)| key.get_ref().as_ref() == name).map(|(_, value)| value)
    }

    /// Returns the offset of a key's value, or of the table if the key is missing.
    fn at(&self, name: &str) -> usize {
        self.get(name).map_or(self.start, |value| value.span().start)
    }

    /// Makes sure that there are no keys but these.
    fn only(&self, names: &[&str]) -> Result<(), Wrong> {
        let other = self.keys.iter().find(|(key, _)| !names.contains(&key.get_ref().as_ref()));
        other.map_or(Ok(()), |(key, _)| {
            let what = format!("`{}`: here are {}", key.get_ref(), names.join(", "));
            Err((key.span().start, what))
        })
    }

    fn needed<T>(
        &self,
        name: &str,
        read: impl Fn(&Self, &str) -> Result<Option<T>, Wrong>,
    ) -> Result<T, Wrong> {
        read(self, name)?.ok_or_else(|| (self.start, format!("`{name}` is missing")))
    }

    fn text(&self, name: &str) -> Result<Option<String>, Wrong> {
        match self.get(name).map(|value| value.get_ref()) {
            None => Ok(None),
            Some(DeValue::String(text)) => Ok(Some(text.clone().into_owned())),
            Some(_) => Err((self.at(name), format!("`{name}` is a text, in quotes"))),
        }
    }

    fn place(&self, name: &str) -> Result<Option<FeaturePlace>, Wrong> {
        let Some(value) = self.get(name) else { return Ok(None) };
        let number = |value: &Spanned<DeValue>| -> Option<f64> {
            let text = match value.get_ref() {
                DeValue::Integer(n) => n.to_string(),
                DeValue::Float(n) => n.to_string(),
                _ => return None,
            };
            text.replace('_', "").parse().ok().filter(|n: &f64| n.is_finite())
        };
        let found = match value.get_ref() {
            DeValue::String(text) => Some(FeaturePlace::Feature(text.clone().into_owned())),
            DeValue::Array(array) => match &array.iter().map(number).collect::<Vec<_>>()[..] {
                &[Some(x), Some(y), Some(z)] => Some(FeaturePlace::Point(DVec3::new(x, y, z))),
                _ => None,
            },
            _ => None,
        };
        let what = || format!("`{name}` is a point, [x, y, z], or the name of a round part");
        found.map(Some).ok_or_else(|| (value.span().start, what()))
    }

    fn along(&self) -> Result<Along, Wrong> {
        match self.text("along")?.as_deref() {
            None | Some("straight") => Ok(Along::Straight),
            Some("x") => Ok(Along::X),
            Some("y") => Ok(Along::Y),
            Some("z") => Ok(Along::Z),
            Some(other) => {
                Err((self.at("along"), format!("along `{other}`: there are x, y, z, straight")))
            }
        }
    }

    fn side(&self) -> Result<Option<ViewSide>, Wrong> {
        let side = match self.text("side")?.as_deref() {
            None => return Ok(None),
            Some("above") => ViewSide::Above,
            Some("below") => ViewSide::Below,
            Some("left") => ViewSide::Left,
            Some("right") => ViewSide::Right,
            Some(other) => {
                let what = format!("side `{other}`: there are above, below, left, right");
                return Err((self.at("side"), what));
            }
        };
        Ok(Some(side))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_has_dimensions_and_threads() {
        let text = "[[dimension]]\nkind = 'linear'\nfrom = [0, 1.5, -2e1]\nto = 'hole 1'\nalong = 'x'\nside = \
                    'above'\n[[thread]]\nname = 'bolt'\nsize = 'M8'\n[[dimension]]\nkind = 'note'\nat = 'boss \
                    1'\ntext = 'ground'\nview = 'top'";
        let listed = parse(text).expect("file");
        let from = FeaturePlace::Point(DVec3::new(0.0, 1.5, -20.0));
        let to = FeaturePlace::Feature("hole 1".to_owned());
        assert_eq!(listed.dimensions[0].what, What::Linear { from, to, along: Along::X });
        assert_eq!(listed.dimensions[0].side, Some(ViewSide::Above));
        assert_eq!(listed.dimensions[1].view.as_deref(), Some("top"));
        assert_eq!(listed.threads[0].size.as_ref().map(|s| s.pitch), Some(1.25));
    }

    #[test]
    fn what_is_wrong_is_reported_with_its_place() {
        let cases = [
            ("[dimension]\nkind = 'note'", 1, "double brackets"),
            ("[[dimension]]\nkind = 'lineal'", 29, "linear, diameter"),
            ("[[dimension]]\nkind = 'linear'\nfrom = [0, 0]", 37, "[x, y, z]"),
            ("[[dimension]]\nkind = 'diameter'\nto = 'x'", 32, "of"),
            ("[[thread]]\nname = 'a'\nsize = 'W1'", 29, "ISO 261"),
            ("[[dimension]]\nkind = 'note'\nat = [0, 0, 0]", 0, "`text` is missing"),
            ("a = 1", 0, "[[dimension]]"),
        ];
        for (text, _, part) in cases {
            let (_, what) = parse(text).expect_err(text);
            assert!(what.contains(part), "{text}: {what}");
        }
    }
}
