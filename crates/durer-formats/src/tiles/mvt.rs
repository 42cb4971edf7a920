//! Mapbox Vector Tiles, version 2.1: <https://github.com/mapbox/vector-tile-spec/tree/master/2.1>.

use super::protobuf::{Message, zigzag};
use durer::clip::tiles::GridShape;
use durer::math::I64Vec2;
use std::collections::HashMap;

/// The value of a property.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// Text.
    Text(String),
    /// A number with a fraction, or a large one.
    Number(f64),
    /// A whole number.
    Unsigned(u64),
    /// A whole number below 0.
    Signed(i64),
    /// True or false.
    Bool(bool),
}

impl Value {
    /// Returns a key that is equal for equal values, and for no others.
    fn key(&self) -> (u8, u64, &str) {
        match self {
            Self::Text(text) => (0, 0, text),
            Self::Number(value) => (1, value.to_bits(), ""),
            Self::Unsigned(value) => (2, *value, ""),
            Self::Signed(value) => (3, *value as u64, ""),
            Self::Bool(value) => (4, (*value).into(), ""),
        }
    }

    fn message(&self) -> Message {
        let mut message = Message::default();
        match self {
            Self::Text(text) => message.bytes(1, text.as_bytes()),
            Self::Number(value) => message.double(3, *value),
            Self::Unsigned(value) => message.unsigned(5, *value),
            Self::Signed(value) => message.signed(6, *value),
            Self::Bool(value) => message.unsigned(7, (*value).into()),
        }
        message
    }
}

/// The names and values of properties, each once, in order of appearance.
#[derive(Debug, Clone, Default)]
pub struct Dictionary {
    names: Vec<String>,
    values: Vec<Value>,
    // Nothing depends on their order.
    by_name: HashMap<String, u32>,
    by_value: HashMap<(u8, u64, String), u32>,
}

impl Dictionary {
    /// Returns the number of a name.
    pub fn name(&mut self, name: &str) -> u32 {
        if let Some(&found) = self.by_name.get(name) {
            return found;
        }
        let new = self.names.len() as u32;
        self.names.push(name.to_owned());
        self.by_name.insert(name.to_owned(), new);
        new
    }

    /// Returns the number of a value.
    pub fn value(&mut self, value: Value) -> u32 {
        let (kind, bits, text) = value.key();
        let new = self.values.len() as u32;
        let number = *self.by_value.entry((kind, bits, text.to_owned())).or_insert(new);
        if number == new {
            self.values.push(value);
        }
        number
    }

    /// Returns the names.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Returns the value of a number.
    pub fn get(&self, value: u32) -> Option<&Value> {
        self.values.get(value as usize)
    }
}

/// A layer of a tile.
#[derive(Debug)]
pub struct Layer<'a> {
    name: &'a str,
    extent: u32,
    dictionary: &'a Dictionary,
    names: Numbers,
    values: Numbers,
    features: Vec<Message>,
}

/// Numbers of a whole layer, and their numbers in a tile.
#[derive(Debug, Default)]
struct Numbers {
    all: Vec<u32>,
    here: HashMap<u32, u32>,
}

impl Numbers {
    fn here(&mut self, number: u32) -> u32 {
        let new = self.all.len() as u32;
        let here = *self.here.entry(number).or_insert(new);
        if here == new {
            self.all.push(number);
        }
        here
    }
}

const POINT: u64 = 1;
const LINE: u64 = 2;
const POLYGON: u64 = 3;
const MOVE_TO: u32 = 1;
const LINE_TO: u32 = 2;
const CLOSE: u32 = 7;

impl<'a> Layer<'a> {
    /// Creates a layer without a feature, of this many cells across.
    pub fn new(name: &'a str, extent: u32, dictionary: &'a Dictionary) -> Self {
        let (names, values) = Default::default();
        Self { name, extent, dictionary, names, values, features: Vec::new() }
    }

    /// Adds a feature with its properties, each a name and a value by their numbers in the dictionary. Shapes are on
    /// the grid of the tile, y downwards; the signed areas of outer rings are positive.
    pub fn add(&mut self, id: Option<u64>, properties: &[(u32, u32)], shape: &GridShape) {
        let mut message = Message::default();
        if let Some(id) = id {
            message.unsigned(1, id);
        }
        let tags: Vec<u32> = properties
            .iter()
            .flat_map(|&(name, value)| [self.names.here(name), self.values.here(value)])
            .collect();
        if !tags.is_empty() {
            message.packed(2, &tags);
        }
        let (kind, commands) = commands(shape);
        message.unsigned(3, kind);
        message.packed(4, &commands);
        self.features.push(message);
    }

    /// Returns whether there is no feature in it.
    pub fn is_empty(&self) -> bool {
        self.features.is_empty()
    }

    fn message(&self) -> Message {
        let mut message = Message::default();
        message.unsigned(15, 2);
        message.bytes(1, self.name.as_bytes());
        self.features.iter().for_each(|feature| message.bytes(2, &feature.0));
        let name = |&i: &u32| self.dictionary.names.get(i as usize).map_or("", String::as_str);
        self.names.all.iter().for_each(|i| message.bytes(3, name(i).as_bytes()));
        for &i in &self.values.all {
            let value = self.dictionary.get(i).map(Value::message).unwrap_or_default();
            message.bytes(4, &value.0);
        }
        message.unsigned(5, self.extent.into());
        message
    }
}

/// Returns the bytes of a tile: its layers, without empty ones.
pub fn encode(layers: &[Layer<'_>]) -> Vec<u8> {
    let mut tile = Message::default();
    let full = layers.iter().filter(|layer| !layer.is_empty());
    full.for_each(|layer| tile.bytes(3, &layer.message().0));
    tile.0
}

/// Moves of a pen that has not been anywhere but at zero.
#[derive(Default)]
struct Pen {
    commands: Vec<u32>,
    at: I64Vec2,
}

impl Pen {
    fn command(&mut self, command: u32, count: usize) {
        self.commands.push((count as u32) << 3 | command);
    }

    fn go(&mut self, to: I64Vec2) {
        let by = to - self.at;
        self.commands.extend([by.x, by.y].map(|d| zigzag(d) as u32));
        self.at = to;
    }

    /// Moves to the first point and draws lines to the others.
    fn run(&mut self, points: &[I64Vec2]) {
        let Some((&first, rest)) = points.split_first() else { return };
        self.command(MOVE_TO, 1);
        self.go(first);
        self.command(LINE_TO, rest.len());
        rest.iter().for_each(|&p| self.go(p));
    }
}

/// Returns the kind of a shape, and how it is drawn.
fn commands(shape: &GridShape) -> (u64, Vec<u32>) {
    let mut pen = Pen::default();
    let kind = match shape {
        GridShape::Points(points) => {
            pen.command(MOVE_TO, points.len());
            points.iter().for_each(|&p| pen.go(p));
            POINT
        }
        GridShape::Lines(lines) => {
            lines.iter().for_each(|line| pen.run(line));
            LINE
        }
        GridShape::Areas(shapes) => {
            for ring in shapes.rings() {
                pen.run(ring);
                pen.command(CLOSE, 1);
            }
            POLYGON
        }
    };
    (kind, pen.commands)
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer::clip::polygon::Shapes;

    fn p(x: i64, y: i64) -> I64Vec2 {
        I64Vec2::new(x, y)
    }

    #[test]
    fn geometries_are_those_of_the_specification() {
        // The examples of section 4.3.5.
        assert_eq!(commands(&GridShape::Points(vec![p(25, 17)])), (1, vec![9, 50, 34]));
        assert_eq!(
            commands(&GridShape::Points(vec![p(5, 7), p(3, 2)])),
            (1, vec![17, 10, 14, 3, 9])
        );
        let line = vec![p(2, 2), p(2, 10), p(10, 10)];
        assert_eq!(commands(&GridShape::Lines(vec![line.clone()])).1, [9, 4, 4, 18, 0, 16, 16, 0]);
        let two = GridShape::Lines(vec![line, vec![p(1, 1), p(3, 5)]]);
        let drawn = [9, 4, 4, 18, 0, 16, 16, 0, 9, 17, 17, 10, 4, 8];
        assert_eq!(commands(&two), (2, drawn.to_vec()));
        let mut areas = Shapes::new();
        areas.push_ring([p(3, 6), p(8, 12), p(20, 34)]);
        assert_eq!(commands(&GridShape::Areas(areas)), (3, vec![9, 6, 12, 18, 10, 12, 24, 44, 15]));
    }

    #[test]
    fn names_and_values_are_numbered_in_each_tile() {
        let mut all = Dictionary::default();
        let tags: Vec<(u32, u32)> =
            [("a", Value::Bool(true)), ("b", Value::Signed(-1)), ("b", Value::Bool(true))]
                .map(|(name, value)| (all.name(name), all.value(value)))
                .to_vec();
        assert_eq!(tags, [(0, 0), (1, 1), (1, 0)]);
        let mut layer = Layer::new("l", 4096, &all);
        assert_eq!(encode(&[Layer::new("none", 4096, &all)]), b"");
        layer.add(Some(7), &tags[1..2], &GridShape::Points(vec![p(1, 1)]));
        let feature = b"\x08\x07\x12\x02\0\0\x18\x01\x22\x03\x09\x02\x02";
        let mut expected = b"\x1a\x21\x78\x02\x0a\x01l\x12\x0d".to_vec();
        expected.extend(feature);
        expected.extend(b"\x1a\x01b\x22\x02\x30\x01\x28\x80\x20");
        expected[1] = expected.len() as u8 - 2;
        assert_eq!(encode(&[layer]), expected);
    }
}
