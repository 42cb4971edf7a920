//! Scans of E57 files.
//!
//! Source: ASTM E2807, *Standard Specification for 3D Imaging Data Exchange*, 2011, read by the crate
//! `e57`. All scans of a file are taken, each in its pose: places, cartesian or spherical, and colours;
//! intensities are shown as grey where no scan has colours. Points that the scanner marked as invalid
//! are left out, and so are the pictures of the scanner. z is up.
//!
//! Cost: one pass. Memory: 24 bytes per point while reading, 20 more for colour and intensity.

use crate::cloud::Cloud;
use crate::foreign;
use crate::wording::counted;
use crate::{Error, Limits, Model, Place, ReadOptions, Resources, Result};
use durer::math::{DMat3, DVec3, Vec4};
use e57::{CartesianCoordinate, E57Reader, Point, PointCloud, RecordDataType, SphericalCoordinate};
use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Values that a point may have.
const VALUES: usize = 64;

/// Reads an E57 file.
///
/// A truncated scan is read up to its end, with a warning.
///
/// # Errors
/// [`Error::Decode`] for a file whose header or XML is broken, or without any point;
/// [`Error::Limit`] for more points than allowed.
pub fn read(bytes: &[u8], _resources: &dyn Resources, options: &ReadOptions) -> Result<Model> {
    let mut model = Model { format: "E57".to_owned(), ..Model::default() };
    let mut scans = Scans { limits: options.limits.clone(), ..Scans::default() };
    scans.cloud.full = 1.0;
    // On broken data the crate may panic.
    let all = catch_unwind(AssertUnwindSafe(|| scans.read(bytes, &mut model)));
    match all {
        Ok(Err(why)) => return Err(why),
        Err(_) if scans.cloud.points.is_empty() => return Err(broken("its data make no sense")),
        Err(_) => model.warn(Place::Whole, "the data end early: the part before is shown"),
        Ok(Ok(())) => {}
    }
    let words = "{point is|points are} marked as invalid and left out";
    model.warn_counted(Place::Whole, scans.invalid, words);
    scans.settle();
    scans.cloud.into_model(model)
}

fn broken(why: &str) -> Error {
    Error::whole(format!("broken E57 file: {why}"))
}

/// The points of all scans.
#[derive(Default)]
struct Scans {
    cloud: Cloud,
    limits: Limits,
    /// True if some point has a colour, or an intensity.
    colored: bool,
    measured: bool,
    invalid: u64,
}

impl Scans {
    fn read(&mut self, bytes: &[u8], model: &mut Model) -> Result<()> {
        let reader = E57Reader::new(Cursor::new(bytes));
        let mut reader = reader.map_err(|e| broken(foreign::e57(&e)))?;
        let scans = reader.pointclouds();
        if scans.is_empty() {
            return Err(Error::whole("holds no scan"));
        }
        for (number, scan) in scans.iter().enumerate() {
            let place = || Place::Path(format!("data3D[{number}]"));
            check(scan, place())?;
            let sum = (self.cloud.points.len() as u64).saturating_add(scan.records);
            self.cloud.make_room(sum, place, &self.limits)?;
            let result = self.scan(&mut reader, scan);
            if let Err(why) = result {
                let points = counted(self.cloud.points.len() as u64, "point is", "points are");
                let message = format!("breaks off: {why}; {points} read");
                model.warn(place(), message);
            }
        }
        if self.cloud.points.is_empty() && !model.warnings.is_empty() {
            return Err(broken(&model.warnings.remove(0).to_string()));
        }
        Ok(())
    }

    /// Adds the points of a scan.
    fn scan(
        &mut self,
        reader: &mut E57Reader<Cursor<&[u8]>>,
        scan: &PointCloud,
    ) -> e57::Result<()> {
        let pose = Pose::of(scan);
        let mut points = reader.pointcloud_simple(scan)?;
        // Sines of the platform are not the same everywhere.
        points.spherical_to_cartesian(false);
        points.apply_pose(false);
        points.intensity_to_color(false);
        points.normalize_intensity(false);
        points.try_for_each(|point| {
            match point {
                Ok(point) => self.add(&point, &pose),
                // A packet without a whole point: the next call reads the next packet.
                Err(e57::Error::Internal { .. }) => {}
                Err(why) => return Err(why),
            }
            Ok(())
        })
    }

    fn add(&mut self, point: &Point, pose: &Pose) {
        let Some(place) = place(point) else {
            self.invalid += 1;
            return;
        };
        self.cloud.points.push(pose.rotation * place + pose.translation);
        let color = point.color.as_ref();
        self.colored |= color.is_some();
        self.measured |= point.intensity.is_some();
        let color = color.map_or(Vec4::W, |c| Vec4::new(c.red, c.green, c.blue, 1.0));
        self.cloud.colors.push(color);
        self.cloud.intensities.push(point.intensity.unwrap_or(f32::NAN));
    }

    /// Drops attributes that no point has.
    fn settle(&mut self) {
        if !self.colored {
            self.cloud.colors = Vec::new();
        }
        if !self.measured {
            self.cloud.intensities = Vec::new();
        }
    }
}

/// Refuses scans whose values would fill the memory out of nothing.
fn check(scan: &PointCloud, place: Place) -> Result<()> {
    let takes_bits = |kind: &RecordDataType| match kind {
        RecordDataType::Single { .. } | RecordDataType::Double { .. } => true,
        RecordDataType::ScaledInteger { min, max, .. } | RecordDataType::Integer { min, max } => {
            min < max
        }
    };
    let values = &scan.prototype;
    if values.len() <= VALUES && values.iter().any(|v| takes_bits(&v.data_type)) {
        return Ok(());
    }
    let message =
        format!("points have {} values, none of which takes a bit, or too many", values.len());
    Err(Error::Decode { place, message })
}

/// Returns the place of a point in its scan.
fn place(point: &Point) -> Option<DVec3> {
    match (&point.cartesian, &point.spherical) {
        (&CartesianCoordinate::Valid { x, y, z }, _) => Some(DVec3::new(x, y, z)),
        (_, &SphericalCoordinate::Valid { range, azimuth, elevation }) => {
            let (across, up) = (range * libm::cos(elevation), range * libm::sin(elevation));
            Some(DVec3::new(across * libm::cos(azimuth), across * libm::sin(azimuth), up))
        }
        _ => None,
    }
}

/// Transformation from a scan's coordinates to the file's.
struct Pose {
    rotation: DMat3,
    translation: DVec3,
}

impl Pose {
    fn of(scan: &PointCloud) -> Self {
        let Some(pose) = &scan.transform else {
            return Self { rotation: DMat3::IDENTITY, translation: DVec3::ZERO };
        };
        let (q, t) = (&pose.rotation, &pose.translation);
        let (w, x, y, z) = (q.w, q.x, q.y, q.z);
        let rotation = DMat3::from_cols(
            DVec3::new(w * w + x * x - y * y - z * z, 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)),
            DVec3::new(2.0 * (x * y - w * z), w * w + y * y - x * x - z * z, 2.0 * (y * z + w * x)),
            DVec3::new(2.0 * (x * z + w * y), 2.0 * (y * z - w * x), w * w + z * z - x * x - y * y),
        );
        Self { rotation, translation: DVec3::new(t.x, t.y, t.z) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::NoResources;
    use durer::scene::UpAxis;
    use e57::{E57Writer, Quaternion, Record, RecordName, RecordValue, Transform, Translation};

    fn record(name: RecordName, data_type: RecordDataType) -> Record {
        Record { name, data_type }
    }

    const DOUBLE: RecordDataType = RecordDataType::Double { min: None, max: None };
    const BYTE: RecordDataType = RecordDataType::Integer { min: 0, max: 255 };

    /// Returns a file with one scan, rotated by a quarter turn about z and moved by 100 along x.
    fn file(prototype: Vec<Record>, points: &[Vec<RecordValue>]) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        let mut writer = E57Writer::new(&mut bytes, "a").expect("new");
        let mut scan = writer.add_pointcloud("b", prototype).expect("scan");
        let h = 0.5_f64.sqrt();
        let rotation = Quaternion { w: h, x: 0.0, y: 0.0, z: h };
        let translation = Translation { x: 100.0, y: 0.0, z: 0.0 };
        scan.set_transform(Some(Transform { rotation, translation }));
        for point in points {
            scan.add_point(point.clone()).expect("point");
        }
        scan.finalize().expect("scan");
        writer.finalize().expect("file");
        drop(writer);
        bytes.into_inner()
    }

    fn read_ok(bytes: &[u8]) -> Model {
        read(bytes, &NoResources, &ReadOptions::default()).unwrap_or_else(|e| panic!("{e}"))
    }

    fn at(model: &Model, i: usize) -> DVec3 {
        let p = model.scene.meshes[0].positions[i].as_dvec3();
        model.scene.instances[0].world_from_mesh.transform_point3(p)
    }

    fn colored() -> Vec<u8> {
        let prototype = vec![
            record(RecordName::CartesianX, DOUBLE),
            record(RecordName::CartesianY, DOUBLE),
            record(RecordName::CartesianZ, DOUBLE),
            record(RecordName::CartesianInvalidState, RecordDataType::Integer { min: 0, max: 2 }),
            record(RecordName::ColorRed, BYTE),
            record(RecordName::ColorGreen, BYTE),
            record(RecordName::ColorBlue, BYTE),
        ];
        let point = |x: f64, invalid: i64, red: i64| {
            let place = [x, 0.0, 1.0].map(RecordValue::Double);
            let rest = [invalid, red, 0, 255 - red].map(RecordValue::Integer);
            place.into_iter().chain(rest).collect()
        };
        file(prototype, &[point(1.0, 0, 255), point(2.0, 2, 0), point(3.0, 0, 0)])
    }

    #[test]
    fn points_with_colors_in_their_pose() {
        let model = read_ok(&colored());
        let mesh = &model.scene.meshes[0];
        assert_eq!((mesh.positions.len(), model.scene.up_axis), (2, UpAxis::Z));
        assert!(at(&model, 1).distance(DVec3::new(100.0, 3.0, 1.0)) < 1e-6, "{}", at(&model, 1));
        assert_eq!(mesh.colors, [Vec4::new(1.0, 0.0, 0.0, 1.0), Vec4::new(0.0, 0.0, 1.0, 1.0)]);
        assert_eq!(model.warnings[0].to_string(), "1 point is marked as invalid and left out");
    }

    #[test]
    fn spheres_and_intensities() {
        let prototype = vec![
            record(RecordName::SphericalRange, DOUBLE),
            record(RecordName::SphericalAzimuth, DOUBLE),
            record(RecordName::SphericalElevation, DOUBLE),
            record(RecordName::Intensity, BYTE),
        ];
        let quarter = std::f64::consts::FRAC_PI_2;
        let point = |a: f64, e: f64, i: i64| {
            let mut values: Vec<_> = [2.0, a, e].map(RecordValue::Double).to_vec();
            values.push(RecordValue::Integer(i));
            values
        };
        let model = read_ok(&file(prototype, &[point(quarter, 0.0, 10), point(0.0, quarter, 200)]));
        assert!(at(&model, 0).distance(DVec3::new(98.0, 0.0, 0.0)) < 1e-5, "{}", at(&model, 0));
        assert!(at(&model, 1).distance(DVec3::new(100.0, 0.0, 2.0)) < 1e-5, "{}", at(&model, 1));
        let colors = &model.scene.meshes[0].colors;
        assert!(colors[0].x < 0.02 && colors[1] == Vec4::ONE, "{colors:?}");
    }

    #[test]
    fn broken_files_are_reported() {
        let bytes = colored();
        let message = |bytes: &[u8]| {
            read(bytes, &NoResources, &ReadOptions::default()).expect_err("broken").to_string()
        };
        assert!(message(&bytes[..1000]).starts_with("broken E57 file"));
        let limits = Limits { primitives: 2, ..Limits::default() };
        let options = ReadOptions { limits, ..ReadOptions::default() };
        assert!(matches!(read(&bytes, &NoResources, &options), Err(Error::Limit { .. })));
        let mut empty = Cursor::new(Vec::new());
        let mut writer = E57Writer::new(&mut empty, "a").expect("new");
        writer.finalize().expect("file");
        drop(writer);
        assert!(message(&empty.into_inner()).contains("holds no scan"));
        for at in 0..bytes.len() {
            let mut bytes = bytes.clone();
            bytes[at] = !bytes[at];
            drop(read(&bytes, &NoResources, &ReadOptions::default()));
        }
    }

    #[test]
    fn values_without_bits_are_refused() {
        let same = |name| record(name, RecordDataType::Integer { min: 7, max: 7 });
        let prototype = vec![
            same(RecordName::CartesianX),
            same(RecordName::CartesianY),
            same(RecordName::CartesianZ),
        ];
        let mut scan = PointCloud::default();
        scan.prototype = prototype;
        assert!(check(&scan, Place::Whole).is_err());
    }
}
