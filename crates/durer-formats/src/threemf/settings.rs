//! The settings that slicers keep beside the model: colours of filaments, the filament of each
//! part, objects that are not part of the model, and plates.
//!
//! Source: files of Bambu Studio and OrcaSlicer (`project_settings.config`, JSON;
//! `model_settings.config`, XML) and of PrusaSlicer (`Slic3r_PE.config`, lines of `; key = value`;
//! `Slic3r_PE_model.config`, XML).

use super::package::Package;
use crate::foreign;
use crate::xml::{self, attribute};
use crate::{Model, Place, color};
use durer::math::{Vec3, Vec4};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use serde::Deserialize;
use std::collections::HashMap;

const BAMBU: [&str; 2] = ["Metadata/project_settings.config", "Metadata/model_settings.config"];
const PRUSA: [&str; 2] = ["Metadata/Slic3r_PE.config", "Metadata/Slic3r_PE_model.config"];

/// Colours of filaments that the file does not state.
const MADE_UP: [u32; 8] =
    [0xd9d9d9, 0xe4572e, 0x2e86ab, 0x5fad56, 0xf2c14e, 0x8b5fbf, 0x3d405b, 0xf49ac2];

/// Settings in the slicer's files; empty if there are none.
#[derive(Debug, Default)]
pub(super) struct Settings {
    /// Linear colours, the first filament first.
    filaments: Vec<Vec4>,
    objects: HashMap<u64, ObjectSettings>,
    pub plates: Vec<Plate>,
}

/// Settings of an object of the build.
#[derive(Debug, Default)]
pub(super) struct ObjectSettings {
    /// Number of its filament, from 1.
    filament: Option<u32>,
    /// Settings of volumes by the numbers of their first and last triangle, in order (PrusaSlicer).
    pub volumes: Vec<(u64, u64, VolumeSettings)>,
    /// Settings of parts by the ids of the objects that are its components (Bambu Studio).
    parts: HashMap<u64, VolumeSettings>,
}

/// Settings of a part of an object.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
pub(super) struct VolumeSettings {
    pub filament: Option<u32>,
    /// True if it is not a part of the model: a modifier, a hole, a place for supports.
    pub hidden: bool,
}

/// A plate of a project.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Plate {
    pub name: String,
    /// Ids of objects, and which of the build's items of that object.
    pub instances: Vec<(u64, u64)>,
}

impl Settings {
    /// Reads the slicer's files. Unreadable files give a warning, and the model is drawn without them.
    pub fn read(package: &mut Package<'_>, model: &mut Model) -> Self {
        let mut settings = Self::default();
        let mut file = |name: &str, parse: &mut dyn FnMut(&[u8]) -> Result<(), String>| {
            if !package.has(name) {
                return;
            }
            let text = package.read(name).map_err(|e| e.to_string());
            if let Err(why) = text.and_then(|text| parse(&xml::utf8(&text))) {
                let message = format!("is left out, with the slicer's colours or parts: {why}");
                model.warn(Place::Path(name.to_owned()), message);
            }
        };
        file(BAMBU[0], &mut |text| settings.set_filaments(project_filaments(text)?));
        file(PRUSA[0], &mut |text| settings.set_filaments(config_filaments(text)));
        for name in [BAMBU[1], PRUSA[1]] {
            file(name, &mut |text| settings.parse_objects(text));
        }
        settings
    }

    fn set_filaments(&mut self, colors: Vec<String>) -> Result<(), String> {
        for text in colors {
            let color = color::hex(text.trim()).ok_or(format!("`{text}` is not a colour"))?;
            self.filaments.push(Vec3::new(color.x, color.y, color.z).extend(1.0));
        }
        Ok(())
    }

    /// Returns whether the file says how filaments look.
    pub fn has_filaments(&self) -> bool {
        !self.filaments.is_empty()
    }

    /// Returns the colour of a filament, counted from 1; made up where the file does not say.
    pub fn filament(&self, number: u32) -> Vec4 {
        let at = number.saturating_sub(1) as usize;
        let made_up = || {
            let [_, bytes @ ..] = MADE_UP[at % MADE_UP.len()].to_be_bytes();
            color::linear3(bytes.map(|b| f32::from(b) / 255.0)).extend(1.0)
        };
        self.filaments.get(at).copied().unwrap_or_else(made_up)
    }

    /// Returns the settings of an object of the build.
    pub fn object(&self, id: u64) -> Option<&ObjectSettings> {
        self.objects.get(&id)
    }

    fn parse_objects(&mut self, text: &[u8]) -> Result<(), String> {
        let mut reader = Reader::from_reader(text);
        let mut parser = ObjectParser { settings: self, object: None, volume: None, plate: None };
        loop {
            match reader.read_event().map_err(|e| foreign::xml(&e))? {
                Event::Start(e) => parser.open(&e),
                Event::Empty(e) => {
                    parser.open(&e);
                    parser.close(e.local_name().as_ref());
                }
                Event::End(e) => parser.close(e.local_name().as_ref()),
                Event::Eof => return Ok(()),
                _ => {}
            }
        }
    }
}

impl ObjectSettings {
    /// Returns the filament of the object, or of a component, and whether the component is hidden.
    pub fn of_component(&self, id: Option<u64>) -> VolumeSettings {
        let part = id.and_then(|id| self.parts.get(&id)).copied().unwrap_or_default();
        VolumeSettings { filament: part.filament.or(self.filament), ..part }
    }
}

/// Returns the colours in a JSON of Bambu Studio.
fn project_filaments(text: &[u8]) -> Result<Vec<String>, String> {
    #[derive(Deserialize)]
    struct Project {
        #[serde(default)]
        filament_colour: Vec<String>,
    }
    let project: Project = serde_json::from_slice(text).map_err(|e| foreign::json(&e))?;
    Ok(project.filament_colour)
}

/// Returns the colours in a configuration of PrusaSlicer: the extruders' if all have one, else the filaments'.
fn config_filaments(text: &[u8]) -> Vec<String> {
    let text = String::from_utf8_lossy(text);
    let value = |key: &str| {
        let mut pairs =
            text.lines().filter_map(|l| l.trim_start_matches([';', ' ']).split_once('='));
        let (_, value) = pairs.find(|(k, _)| k.trim() == key)?;
        Some(value.split(';').map(|c| c.trim().trim_matches('"').to_owned()).collect::<Vec<_>>())
    };
    let whole = |key| value(key).filter(|colors| colors.iter().all(|c| !c.is_empty()));
    whole("extruder_colour").or_else(|| whole("filament_colour")).unwrap_or_default()
}

/// Parser of the settings of objects and plates, element by element.
struct ObjectParser<'a> {
    settings: &'a mut Settings,
    object: Option<(u64, ObjectSettings)>,
    /// The first and last triangle, or twice the id of a component.
    volume: Option<(u64, u64, VolumeSettings)>,
    plate: Option<Plate>,
}

impl ObjectParser<'_> {
    fn open(&mut self, e: &BytesStart<'_>) {
        let number = |key| attribute(e, key).and_then(|v| v.trim().parse::<u64>().ok());
        match e.local_name().as_ref() {
            "object" => self.object = number("id").map(|id| (id, ObjectSettings::default())),
            "volume" => {
                let range = number("firstid").zip(number("lastid"));
                self.volume = range.map(|(first, last)| (first, last, VolumeSettings::default()));
            }
            "part" => {
                let kind = attribute(e, "subtype").unwrap_or_default();
                let hidden = !matches!(kind.as_str(), "" | "normal_part");
                let settings = VolumeSettings { filament: None, hidden };
                self.volume = number("id").map(|id| (id, id, settings));
            }
            "plate" => self.plate = Some(Plate::default()),
            "model_instance" => {
                if let Some(plate) = &mut self.plate {
                    plate.instances.push((0, 0));
                }
            }
            "metadata" => {
                let [key, value] = ["key", "value"].map(|k| attribute(e, k).unwrap_or_default());
                self.value(&key, value.trim());
            }
            _ => {}
        }
    }

    fn value(&mut self, key: &str, value: &str) {
        if let Some(plate) = &mut self.plate {
            let number = value.parse().unwrap_or_default();
            match (key, plate.instances.last_mut()) {
                ("plater_name", _) => value.clone_into(&mut plate.name),
                ("object_id", Some(last)) => last.0 = number,
                ("instance_id", Some(last)) => last.1 = number,
                _ => {}
            }
            return;
        }
        // Filament 0 means that of the whole object.
        let filament = value.parse().ok().filter(|f| *f > 0);
        match (key, &mut self.volume, &mut self.object) {
            ("extruder", Some(volume), _) => volume.2.filament = filament,
            ("extruder", None, Some(object)) => object.1.filament = filament,
            ("volume_type", Some(volume), _) => volume.2.hidden = value != "ModelPart",
            ("modifier", Some(volume), _) => volume.2.hidden |= value == "1",
            _ => {}
        }
    }

    fn close(&mut self, element: &str) {
        match element {
            "object" => {
                if let Some((id, mut object)) = self.object.take() {
                    object.volumes.sort_by_key(|(first, ..)| *first);
                    self.settings.objects.insert(id, object);
                }
            }
            "volume" => {
                if let (Some(volume), Some((_, object))) = (self.volume.take(), &mut self.object) {
                    object.volumes.push(volume);
                }
            }
            "part" => {
                if let (Some((id, _, part)), Some((_, object))) =
                    (self.volume.take(), &mut self.object)
                {
                    object.parts.insert(id, part);
                }
            }
            "plate" => self.settings.plates.extend(self.plate.take()),
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extruders_go_before_filaments_where_all_have_a_colour() {
        let text =
            b"; filament_colour = #FF8000;#00FF00\n; extruder_colour = #112233;\"#445566\"\n";
        assert_eq!(config_filaments(text), ["#112233", "#445566"]);
        let text = b"; extruder_colour = \"\";\"\"\n; filament_colour = #FF8000;#00FF00\n";
        assert_eq!(config_filaments(text), ["#FF8000", "#00FF00"]);
        assert!(config_filaments(b"; layer_height = 0.2\n").is_empty());
    }

    #[test]
    fn parts_volumes_and_plates() {
        let text = br#"<config><object id="8"><metadata key="extruder" value="2"/>
            <part id="5" subtype="normal_part"><metadata key="extruder" value="3"/></part>
            <part id="6" subtype="negative_part"/></object>
            <object id="1"><volume firstid="0" lastid="11"><metadata key="volume_type" value="ModelPart"/>
            <metadata key="extruder" value="0"/></volume><volume firstid="12" lastid="20">
            <metadata key="volume_type" value="ParameterModifier"/></volume></object>
            <plate><metadata key="plater_name" value="left"/><model_instance>
            <metadata key="object_id" value="8"/><metadata key="instance_id" value="1"/></model_instance>
            </plate></config>"#;
        let mut settings = Settings::default();
        settings.parse_objects(text).expect("well formed");
        let eight = settings.object(8).expect("object");
        let volume = |filament, hidden| VolumeSettings { filament, hidden };
        assert_eq!(eight.of_component(None), volume(Some(2), false));
        assert_eq!(eight.of_component(Some(5)), volume(Some(3), false));
        assert_eq!(eight.of_component(Some(6)), volume(Some(2), true));
        let one = settings.object(1).expect("object");
        assert_eq!(one.volumes, [(0, 11, volume(None, false)), (12, 20, volume(None, true))]);
        let plate = Plate { name: "left".to_owned(), instances: vec![(8, 1)] };
        assert_eq!(settings.plates, [plate]);
    }
}
