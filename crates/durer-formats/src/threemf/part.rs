//! One model part: its XML as objects, colors and build items.

use crate::{Error, Limits, Place, Result, color, number};
use durer::math::{DMat4, DVec3, DVec4, Vec4};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::collections::HashMap;

/// An object in its place: of a build item or a component.
#[derive(Debug, Clone)]
pub(super) struct Use {
    /// Another part that holds the object.
    pub path: Option<String>,
    pub object: u64,
    pub transform: DMat4,
}

/// A triangle with colors of its own: its number, the group, and an index per corner.
pub(super) type Property = (u32, u64, [u64; 3]);

/// A mesh, or components.
#[derive(Debug, Default)]
pub(super) struct Object {
    pub name: String,
    pub vertices: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
    /// The group and index of the whole object's color.
    pub property: Option<(u64, u64)>,
    pub properties: Vec<Property>,
    pub components: Vec<Use>,
    /// The scene's mesh, once there is one, and what its positions are relative to.
    pub placed: Option<(usize, DVec3)>,
}

/// A part.
#[derive(Debug)]
pub(super) struct Part {
    /// Length of the part's unit.
    pub millimetres: f64,
    pub objects: HashMap<u64, Object>,
    /// Linear colors by group.
    pub colors: HashMap<u64, Vec<Vec4>>,
    pub items: Vec<Use>,
    pub triangles: u64,
    pub unknown_properties: bool,
}

/// Reads a part; at most `limit` triangles.
pub(super) fn parse(name: &str, xml: &[u8], limit: u64) -> Result<Part> {
    let mut reader = Reader::from_reader(xml);
    let mut parser = Parser {
        name,
        limit,
        at: 0,
        part: Part {
            millimetres: 1.0,
            objects: HashMap::new(),
            colors: HashMap::new(),
            items: Vec::new(),
            triangles: 0,
            unknown_properties: false,
        },
        object: None,
        group: None,
    };
    let mut depth = 0u32;
    loop {
        parser.at = reader.buffer_position();
        match reader.read_event().map_err(|e| parser.wrong(e.to_string()))? {
            Event::Start(e) => {
                depth += 1;
                if depth > Limits::default().depth {
                    return Err(parser.wrong("elements are nested too deeply".to_owned()));
                }
                parser.open(&e)?;
            }
            Event::Empty(e) => {
                parser.open(&e)?;
                parser.close(e.local_name().as_ref())?;
            }
            Event::End(e) => {
                depth = depth.saturating_sub(1);
                parser.close(e.local_name().as_ref())?;
            }
            Event::Eof if depth > 0 => {
                return Err(parser.wrong(format!("the file ends inside {depth} open elements")));
            }
            Event::Eof => return Ok(parser.part),
            _ => {}
        }
    }
}

struct Parser<'a> {
    name: &'a str,
    limit: u64,
    at: u64,
    part: Part,
    object: Option<(u64, Object)>,
    group: Option<(u64, Vec<Vec4>)>,
}

/// Attributes of an element by local name, raw.
fn attribute<'e>(e: &'e BytesStart<'_>, key: &str) -> Option<std::borrow::Cow<'e, str>> {
    let mut attributes = e.attributes();
    attributes.with_checks(false);
    attributes.flatten().find(|a| a.key.local_name().as_ref() == key).map(|a| a.value)
}

impl Parser<'_> {
    fn wrong(&self, message: String) -> Error {
        Error::path(format!("{}, byte {}", self.name, self.at), message)
    }

    fn text(e: &BytesStart<'_>, key: &str) -> Option<String> {
        let value = attribute(e, key)?;
        Some(quick_xml::escape::unescape(&value).map_or(value.to_string(), |t| t.into_owned()))
    }

    fn index(&self, e: &BytesStart<'_>, key: &str) -> Result<Option<u64>> {
        let Some(value) = attribute(e, key) else { return Ok(None) };
        let value = value.trim_ascii();
        match number::integer(value.as_bytes()) {
            Some((n, length)) if length == value.len() && n >= 0 => Ok(Some(n as u64)),
            _ => {
                Err(self.wrong(format!("`{key}` is `{value}`; a whole number from 0 on is needed")))
            }
        }
    }

    fn needed(&self, e: &BytesStart<'_>, key: &str) -> Result<u64> {
        self.index(e, key)?.ok_or_else(|| self.wrong(format!("the attribute `{key}` is missing")))
    }

    fn coordinate(&self, e: &BytesStart<'_>, key: &str) -> Result<f64> {
        let value = attribute(e, key).unwrap_or_default();
        let value = value.trim_ascii();
        match number::float(value.as_bytes()) {
            Some((n, length)) if length == value.len() => Ok(n),
            _ => Err(self.wrong(format!("`{key}` is `{value}`; a number is needed"))),
        }
    }

    fn open(&mut self, e: &BytesStart<'_>) -> Result<()> {
        match e.local_name().as_ref() {
            "model" => self.part.millimetres = self.unit(e)?,
            "object" => {
                let property =
                    self.index(e, "pid")?.zip(Some(self.index(e, "pindex")?.unwrap_or(0)));
                let name = Self::text(e, "name").unwrap_or_default();
                let object = Object { name, property, ..Object::default() };
                self.object = Some((self.needed(e, "id")?, object));
            }
            "vertex" => {
                let [x, y, z] = ["x", "y", "z"].map(|key| self.coordinate(e, key));
                let vertex = DVec3::new(x?, y?, z?);
                if let Some((_, object)) = &mut self.object {
                    object.vertices.push(vertex);
                }
            }
            "triangle" => self.triangle(e)?,
            "component" => {
                let component = self.used(e)?;
                if let Some((_, object)) = &mut self.object {
                    object.components.push(component);
                }
            }
            "item" => {
                let item = self.used(e)?;
                self.part.items.push(item);
            }
            "basematerials" | "colorgroup" => {
                self.group = Some((self.needed(e, "id")?, Vec::new()));
            }
            "base" => self.color(e, "displaycolor")?,
            "color" => self.color(e, "color")?,
            "texture2dgroup" | "compositematerials" | "multiproperties" => {
                self.part.unknown_properties = true;
            }
            _ => {}
        }
        Ok(())
    }

    fn close(&mut self, element: &str) -> Result<()> {
        match element {
            "object" => {
                if let Some((id, object)) = self.object.take() {
                    self.check_indices(id, &object)?;
                    if self.part.objects.insert(id, object).is_some() {
                        return Err(self.wrong(format!("a second object has the id {id}")));
                    }
                }
            }
            "basematerials" | "colorgroup" => {
                if let Some((id, colors)) = self.group.take() {
                    self.part.colors.insert(id, colors);
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn check_indices(&self, id: u64, object: &Object) -> Result<()> {
        let count = object.vertices.len();
        let wrong = |t: &&[u32; 3]| t.iter().any(|&v| v as usize >= count);
        let Some(triangle) = object.triangles.iter().find(wrong) else { return Ok(()) };
        Err(self.wrong(format!(
            "object {id}: a triangle has the vertices {triangle:?}, but there are {count}, counted from 0"
        )))
    }

    fn unit(&self, e: &BytesStart<'_>) -> Result<f64> {
        let unit = Self::text(e, "unit").unwrap_or_else(|| "millimeter".to_owned());
        Ok(match unit.as_str() {
            "micron" => 0.001,
            "millimeter" => 1.0,
            "centimeter" => 10.0,
            "inch" => 25.4,
            "foot" => 304.8,
            "meter" => 1000.0,
            _ => return Err(self.wrong(format!("`{unit}` is not a unit of 3MF, as millimeter is"))),
        })
    }

    fn triangle(&mut self, e: &BytesStart<'_>) -> Result<()> {
        let [a, b, c] = ["v1", "v2", "v3"].map(|key| self.needed(e, key));
        let small = |v: u64| u32::try_from(v).unwrap_or(u32::MAX);
        let triangle = [small(a?), small(b?), small(c?)];
        let group = self.index(e, "pid")?;
        let [p1, p2, p3] = ["p1", "p2", "p3"].map(|key| self.index(e, key));
        let (p1, p2, p3) = (p1?, p2?, p3?);
        self.part.triangles += 1;
        let (value, limit) = (self.part.triangles, self.limit.min(u64::from(u32::MAX / 3)));
        if value > limit {
            let place = Place::Path(self.name.to_owned());
            return Err(Error::Limit { place, what: "number of triangles", value, limit });
        }
        let Some((_, object)) = &mut self.object else { return Ok(()) };
        let group = group.or(object.property.map(|(group, _)| group));
        if let (Some(group), Some(p1)) = (group, p1) {
            let corners = [p1, p2.unwrap_or(p1), p3.unwrap_or(p1)];
            object.properties.push((object.triangles.len() as u32, group, corners));
        }
        object.triangles.push(triangle);
        Ok(())
    }

    fn used(&self, e: &BytesStart<'_>) -> Result<Use> {
        let path = Self::text(e, "path").map(|p| p.trim_start_matches('/').to_owned());
        let transform = Self::text(e, "transform").map(|t| self.transform(&t)).transpose()?;
        let object = self.needed(e, "objectid")?;
        Ok(Use { path, object, transform: transform.unwrap_or(DMat4::IDENTITY) })
    }

    /// Twelve numbers: the rows of a matrix that row vectors are multiplied by, so its columns here.
    fn transform(&self, text: &str) -> Result<DMat4> {
        let words = text.split_ascii_whitespace();
        let numbers: Vec<f64> = words.filter_map(|w| w.parse().ok()).collect();
        let finite = numbers.iter().all(|n: &f64| n.is_finite());
        let (&[a, b, c, d, e, f, g, h, i, x, y, z], true) = (numbers.as_slice(), finite) else {
            let message = format!("the transform `{text}` has not 12 finite numbers");
            return Err(self.wrong(message));
        };
        Ok(DMat4::from_cols(
            DVec4::new(a, b, c, 0.0),
            DVec4::new(d, e, f, 0.0),
            DVec4::new(g, h, i, 0.0),
            DVec4::new(x, y, z, 1.0),
        ))
    }

    /// `#RRGGBB` or `#RRGGBBAA`, sRGB.
    fn color(&mut self, e: &BytesStart<'_>, key: &str) -> Result<()> {
        let text = Self::text(e, key).unwrap_or_default();
        let digits = text.strip_prefix('#').filter(|d| matches!(d.len(), 6 | 8));
        let Some(bits) = digits.and_then(|d| u32::from_str_radix(d, 16).ok()) else {
            return Err(self.wrong(format!("the color `{text}` is not #RRGGBB or #RRGGBBAA")));
        };
        let bits = if text.len() == 7 { bits << 8 | 0xff } else { bits };
        let [r, g, b, a] = bits.to_be_bytes().map(|v| f32::from(v) / 255.0);
        if let Some((_, colors)) = &mut self.group {
            colors.push(color::linear3([r, g, b]).extend(a));
        }
        Ok(())
    }
}
