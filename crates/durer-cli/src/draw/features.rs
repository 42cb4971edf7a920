//! The features of a map's layers, and their coordinate systems.

use super::{Given, Job};
use crate::failure::Failure;
use crate::input::display_name;
use crate::layer::{FieldArgs, Fields, Shift, SystemArgs, late, none_meets};
use durer_formats::geo::crs::{Crs, Transform};
use durer_formats::geo::{Beside, Feature, Reader, System};

impl Job<'_> {
    /// Returns the features of a layer that meet its conditions, in the coordinate system of the map.
    pub(super) fn features(&mut self, given: &Given<'_>) -> Result<Vec<Feature>, Failure> {
        let name = display_name(&given.layer.input);
        let fail = |e: durer_formats::Error| Failure::Data(format!("{name}: {e}"));
        self.messages.progress.stage(|| format!("reading {name}"));
        let beside = Beside {
            name: &given.file.name,
            resources: &*given.file.beside,
            layer: given.file.layer.as_deref(),
        };
        let reader = Reader::with(given.format, &given.file.bytes[..], &beside);
        let mut reader = reader.map_err(fail)?;
        if self.args.skip_failures {
            reader.skip_failures();
        }
        let (mut features, mut all, mut lost) = (Vec::new(), 0_u64, 0_u64);
        let conditions = given.layer.conditions.clone();
        let mut fields = Fields::new(&FieldArgs { conditions, ..FieldArgs::default() });
        let (from_crs, to_crs) = (given.layer.from_crs.clone(), self.args.to_crs.clone());
        let mut shift = Shift::new(&SystemArgs { from_crs, to_crs });
        let mut stated = None;
        while let Some(mut feature) = reader.next_feature().map_err(fail)? {
            all += 1;
            if let Some(shift) = &mut shift
                && stated.is_none()
            {
                shift.begin(reader.system());
                stated = Some(reader.system());
            }
            if !fields.apply(&mut feature) {
                continue;
            }
            if let Some(shift) = &mut shift
                && !shift.apply(&mut feature).map_err(|failure| failure.of_input(&name))?
            {
                lost += 1;
                continue;
            }
            crate::layer::keep(&feature, &self.args.running.work).map_err(|e| fail(e.into()))?;
            features.push(feature);
        }
        if let Some((why, option)) = late(stated.as_ref(), &reader)
            && given.layer.from_crs.is_none()
        {
            return Err(Failure::Data(format!("{name}: {why}; {option} sets their system")));
        }
        let none = (features.is_empty() && all > lost).then(|| none_meets(all - lost));
        let shifted = shift.as_ref().and_then(Shift::warning);
        for message in fields.warning().into_iter().chain(none).chain(shifted) {
            self.messages.warning(&name, &message);
            self.report.warnings.push(message);
        }
        match (&self.args.to_crs, &given.layer.from_crs) {
            (Some(to), _) => self.systems.add(&features, &to.system(), &name),
            (None, Some(from)) => self.systems.add(&features, &from.system(), &name),
            (None, None) => self.systems.add(&features, &reader.system(), &name),
        }
        self.warn(&name, reader.warnings());
        self.skipped += reader.skipped();
        let more = reader.further_warnings();
        if more > 0 {
            self.report.warnings.push(format!("and {more} more"));
        }
        Ok(features)
    }
}

/// Coordinate systems of the layers.
#[derive(Debug, Default)]
pub(super) struct Systems {
    /// The first one that is known, and a layer that is in it.
    first: Option<(Crs, String)>,
    /// A layer in another one.
    other: Option<(Crs, String)>,
}

impl Systems {
    /// Adds a layer with the system that its file, or else its first feature, states.
    fn add(&mut self, features: &[Feature], stated: &System, name: &str) {
        let own = || features.first().and_then(|f| f.srid).map(System::of_code);
        let stated = if stated.is_unknown() { own() } else { Some(stated.clone()) };
        let Some(crs) = stated.and_then(|stated| Crs::of_system(&stated).ok()) else { return };
        match &self.first {
            None => self.first = Some((crs, name.to_owned())),
            Some((first, _)) if !Transform::new(first, &crs).is_identity() => {
                self.other.get_or_insert((crs, name.to_owned()));
            }
            Some(_) => {}
        }
    }

    /// Returns the length of a unit of the coordinates in metres, if all layers that state a system have lengths in it.
    pub(super) fn unit(&self) -> Option<f64> {
        let (first, _) = self.first.as_ref()?;
        first.unit().filter(|_| self.other.is_none())
    }

    /// Returns a warning about layers of several systems.
    pub(super) fn warning(&self) -> Option<String> {
        let ((first, name), (other, its)) = (self.first.as_ref()?, self.other.as_ref()?);
        let shown = |crs: &Crs| match crs.code() {
            Some(code) => format!("EPSG:{code}"),
            None => "a system without a number".to_owned(),
        };
        let [first, other] = [shown(first), shown(other)];
        Some(format!(
            "the layers are in several coordinate systems, {name} in {first} and {its} in {other}, and are drawn as they \
             are; --to-crs converts them"
        ))
    }
}
