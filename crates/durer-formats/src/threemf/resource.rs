//! Groups of properties and beam lattices, element by element.

use super::lattice::{Ball, Beam, Lattice};
use super::part::Parser;
use super::property::{Group, Layer, Texture2d};
use crate::xml::{self, attribute};
use crate::{Result, color};
use durer::math::Vec2;
use durer::scene::Material;
use quick_xml::events::BytesStart;

/// Groups of properties.
impl Parser<'_> {
    pub fn group(&mut self, e: &BytesStart<'_>) -> Result<()> {
        let id = self.here.needed(e, "id")?;
        let list = |key| whole_numbers(&attribute(e, key).unwrap_or_default());
        let group = match e.local_name().as_ref() {
            "texture2d" => {
                let path = attribute(e, "path").unwrap_or_default();
                let [u, v, filter] = ["tilestyleu", "tilestylev", "filter"].map(|k| xml::raw(e, k));
                let texture =
                    Texture2d::new(&path, [u.as_deref(), v.as_deref()], filter.as_deref());
                self.part.properties.textures.insert(id, texture);
                return Ok(());
            }
            "texture2dgroup" => Group::Coordinates(self.here.needed(e, "texid")?, Vec::new()),
            "compositematerials" => {
                Group::Composites(self.here.needed(e, "matid")?, list("matindices"), Vec::new())
            }
            "multiproperties" => {
                let methods = attribute(e, "blendmethods").unwrap_or_default();
                let mut methods = methods.split_ascii_whitespace();
                let layers = list("pids").into_iter().enumerate().map(|(i, group)| Layer {
                    group,
                    multiplies: i > 0 && methods.next() == Some("multiply"),
                });
                let layers: Vec<_> = layers.collect();
                if self.part.properties.is_simplified(&layers) {
                    let here = self.here;
                    self.part.faults.layers.add(|| here.place());
                }
                Group::Layers(layers, Vec::new())
            }
            _ => Group::Colors(Vec::new()),
        };
        self.group = Some((id, group));
        Ok(())
    }

    pub fn property(&mut self, e: &BytesStart<'_>) -> Result<()> {
        let Some((_, group)) = &mut self.group else { return Ok(()) };
        match group {
            Group::Colors(colors) => {
                let key = if e.local_name().as_ref() == "base" { "displaycolor" } else { "color" };
                let color = color::hex(attribute(e, key).unwrap_or_default().trim());
                if color.is_none() {
                    let here = self.here;
                    self.part.faults.colors.add(|| here.place());
                }
                let color = color.unwrap_or(Material::default().base_color);
                colors.push((attribute(e, "name").unwrap_or_default(), color));
            }
            Group::Coordinates(_, places) => {
                let [u, v] = ["u", "v"].map(|key| self.here.float(e, key));
                // The format's v runs upwards.
                places.push(Vec2::new(u?.unwrap_or(0.0) as f32, (1.0 - v?.unwrap_or(0.0)) as f32));
            }
            Group::Composites(_, _, mixes) => {
                let text = attribute(e, "values").unwrap_or_default();
                let values = text.split_ascii_whitespace();
                mixes.push(values.map(|v| v.parse().unwrap_or(0.0)).collect());
            }
            Group::Layers(_, members) => {
                members.push(whole_numbers(&attribute(e, "pindices").unwrap_or_default()));
            }
        }
        Ok(())
    }
}

/// Beam lattices.
impl Parser<'_> {
    pub fn lattice(&mut self, e: &BytesStart<'_>) -> Result<()> {
        let group =
            self.here.index(e, "pid")?.zip(Some(self.here.index(e, "pindex")?.unwrap_or(0)));
        let number = |key| self.here.float(e, key);
        let clipped = xml::raw(e, "clippingmode").is_some_and(|mode| mode != "none");
        let all_balls = xml::raw(e, "ballmode").is_some_and(|mode| mode == "all");
        let lattice = Lattice {
            radius: number("radius")?.unwrap_or(0.0),
            shortest: number("minlength")?.unwrap_or(0.0),
            butt: xml::raw(e, "cap").is_some_and(|cap| cap == "butt"),
            ball_radius: number("ballradius")?.unwrap_or(0.0),
            all_balls,
            shown_by: self.here.index(e, "representationmesh")?,
            property: group,
            ..Lattice::default()
        };
        if clipped && lattice.shown_by.is_none() {
            let here = self.here;
            self.part.faults.clipped.add(|| here.place());
        }
        if let Some((_, object)) = &mut self.object {
            object.lattice = Some(lattice);
        }
        Ok(())
    }

    pub fn beam(&mut self, e: &BytesStart<'_>) -> Result<()> {
        let here = self.here;
        let small = |v: u64| u32::try_from(v).unwrap_or(u32::MAX);
        let ends = [small(here.needed(e, "v1")?), small(here.needed(e, "v2")?)];
        let [r1, r2] = ["r1", "r2"].map(|key| here.float(e, key));
        let (r1, r2) = (r1?, r2?);
        let cap = |key| xml::raw(e, key).map(|cap| cap == "butt");
        let butts = [cap("cap1"), cap("cap2")];
        let group = here.index(e, "pid")?;
        let [p1, p2] = ["p1", "p2"].map(|key| here.index(e, key));
        let (p1, p2) = (p1?, p2?);
        self.charge(1)?;
        let Some(lattice) = self.object.as_mut().and_then(|(_, o)| o.lattice.as_mut()) else {
            return Ok(());
        };
        let r1 = r1.unwrap_or(lattice.radius);
        let group = group.or(lattice.property.map(|p| p.0));
        let property = group.zip(p1).map(|(group, p1)| (group, [p1, p2.unwrap_or(p1)]));
        let butts = butts.map(|b| b.unwrap_or(lattice.butt));
        lattice.beams.push(Beam { ends, radii: [r1, r2.unwrap_or(r1)], butts, property });
        Ok(())
    }

    pub fn ball(&mut self, e: &BytesStart<'_>) -> Result<()> {
        let center = u32::try_from(self.here.needed(e, "vindex")?).unwrap_or(u32::MAX);
        let radius = self.here.float(e, "r")?;
        self.charge(1)?;
        if let Some(lattice) = self.object.as_mut().and_then(|(_, o)| o.lattice.as_mut()) {
            let radius = radius.unwrap_or(lattice.ball_radius);
            lattice.balls.push(Ball { center, radius });
        }
        Ok(())
    }
}

/// Parses whole numbers separated by blanks; other words count as a very large number.
fn whole_numbers(text: &str) -> Vec<u64> {
    text.split_ascii_whitespace().map(|w| w.parse().unwrap_or(u64::MAX)).collect()
}
