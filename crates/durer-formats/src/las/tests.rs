use super::*;
use crate::{Limits, NoResources};
use durer::scene::{Mesh, Topology, UpAxis};

/// Returns a header of version 1.2, or 1.4 for formats from 6 on; points of format 0 to 10 follow
/// `records`.
fn header(format: u8, length: usize, count: u32, records: &[u8], number: u32) -> Vec<u8> {
    let new = format & 0x3f >= 6;
    let size = if new { 375 } else { HEADER };
    let mut bytes = vec![0; size];
    bytes[..4].copy_from_slice(b"LASF");
    (bytes[24], bytes[25]) = (1, if new { 4 } else { 2 });
    let mut put = |at: usize, value: &[u8]| bytes[at..at + value.len()].copy_from_slice(value);
    put(94, &(size as u16).to_le_bytes());
    put(96, &((size + records.len()) as u32).to_le_bytes());
    put(100, &number.to_le_bytes());
    put(104, &[format]);
    put(105, &(length as u16).to_le_bytes());
    if new {
        put(247, &u64::from(count).to_le_bytes());
    } else {
        put(107, &count.to_le_bytes());
    }
    for (axis, offset) in [4.5e6, 5.1e6, 300.0_f64].into_iter().enumerate() {
        put(131 + 8 * axis, &0.001_f64.to_le_bytes());
        put(155 + 8 * axis, &offset.to_le_bytes());
    }
    bytes.extend(records);
    bytes
}

/// Returns a point of a format.
fn point(format: u8, place: [i32; 3], intensity: u16, color: [u16; 3]) -> Vec<u8> {
    let (length, at) = FORMATS[usize::from(format)];
    let mut bytes = vec![0; length];
    bytes[..12].copy_from_slice(place.map(i32::to_le_bytes).as_flattened());
    bytes[12..14].copy_from_slice(&intensity.to_le_bytes());
    if let Some(at) = at {
        bytes[at..at + 6].copy_from_slice(color.map(u16::to_le_bytes).as_flattened());
    }
    bytes
}

fn points(format: u8, full: u16) -> Vec<Vec<u8>> {
    let one = |i: i32| {
        let mut bytes = point(format, [i, 2 * i, 3 * i], i as u16, [full, 0, 0]);
        let at = match format {
            1 | 3 => 20,
            6.. => 22,
            _ => return bytes,
        };
        bytes[at..at + 8].copy_from_slice(&time(i).to_le_bytes());
        bytes
    };
    (0..1000).map(one).collect()
}

/// Returns a GPS time of one of four sequences, with equal, large and negative steps.
fn time(i: i32) -> f64 {
    let i_squared = i.wrapping_mul(i);
    let start = [1e5, 2e7, -3.0, 5e9][(i_squared % 7 % 4) as usize];
    let jump = if i % 11 == 0 { f64::from(i_squared) } else { 0.0 };
    start + 0.001 * f64::from(i / 4 * 4) - jump
}

fn las(format: u8, full: u16) -> Vec<u8> {
    let points = points(format, full);
    let mut bytes = header(format, points[0].len(), points.len() as u32, &[], 0);
    bytes.extend(points.concat());
    bytes
}

fn read_ok(bytes: &[u8]) -> Model {
    read(bytes, &NoResources, &ReadOptions::default()).unwrap_or_else(|e| panic!("{e}"))
}

fn mesh(model: &Model) -> &Mesh {
    &model.scene.meshes[0]
}

#[test]
fn all_formats_of_points() {
    for format in 0..=10 {
        let model = read_ok(&las(format, 65535));
        assert!(model.warnings.is_empty(), "{:?}", model.warnings);
        assert_eq!((mesh(&model).topology, model.scene.up_axis), (Topology::Points, UpAxis::Z));
        assert_eq!(mesh(&model).positions.len(), 1000);
        let world = model.scene.instances[0].world_from_mesh;
        let p = world.transform_point3(mesh(&model).positions[7].as_dvec3());
        assert!(p.distance(DVec3::new(4.5e6 + 0.007, 5.1e6 + 0.014, 300.021)) < 1e-6, "{p}");
        let colors = &mesh(&model).colors;
        if FORMATS[usize::from(format)].1.is_some() {
            // All points have one colour; intensities distinguish them.
            assert!(colors[0].x < colors[500].x && colors[500].x < 1.0, "{format}");
        }
        assert_eq!(colors[999], Vec4::ONE, "{format}");
    }
}

#[test]
fn colors_of_eight_bits_in_sixteen() {
    for (full, warnings) in [(65535, 0), (255, 1)] {
        let mut bytes = las(2, full);
        let end = bytes.len();
        bytes[end - 6..].copy_from_slice([0, 0, full].map(u16::to_le_bytes).as_flattened());
        let model = read_ok(&bytes);
        assert_eq!(mesh(&model).colors[0], Vec4::new(1.0, 0.0, 0.0, 1.0));
        assert_eq!(mesh(&model).colors[999], Vec4::new(0.0, 0.0, 1.0, 1.0));
        assert_eq!(model.warnings.len(), warnings);
    }
}

#[test]
fn short_files_and_false_headers() {
    let bytes = las(0, 0);
    let model = read_ok(&bytes[..HEADER + 20 * 3 + 7]);
    assert_eq!(mesh(&model).positions.len(), 3);
    assert!(model.warnings[0].to_string().contains("3 of 1000 points"));
    let message = |bytes: &[u8]| {
        read(bytes, &NoResources, &ReadOptions::default()).expect_err("broken").to_string()
    };
    assert!(message(&bytes[..HEADER + 7]).contains("0 of 1000 points"));
    assert!(message(&bytes[..200]).contains("ends within its header"));
    assert!(message(b"LASX").contains("begins with `LASF`"));
    let mut other = bytes.clone();
    other[104] = 11;
    assert!(message(&other).contains("LAS point format 11 is not supported"));
    other[104] = 3;
    assert!(message(&other).contains("points have 20 bytes; of format 3 they need 34"));
    let limits = Limits { primitives: 999, ..Limits::default() };
    let options = ReadOptions { limits, ..ReadOptions::default() };
    assert!(matches!(read(&bytes, &NoResources, &options), Err(Error::Limit { .. })));
}

#[cfg(feature = "laz")]
mod compressed {
    use super::super::laz::RECORD_HEADER;
    use super::*;
    use ::laz::{LasZipCompressor, LazVlr, LazVlrBuilder};

    /// Returns the points of a format, compressed in chunks of 300.
    fn laz(format: u8) -> Vec<u8> {
        let points = points(format, 65535);
        let vlr = LazVlrBuilder::default().with_point_format(format, 0).expect("known");
        let vlr = vlr.with_fixed_chunk_size(300).build();
        let mut record = vec![0; RECORD_HEADER];
        record[2..16].copy_from_slice(LazVlr::USER_ID.as_bytes());
        record[18..20].copy_from_slice(&LazVlr::RECORD_ID.to_le_bytes());
        vlr.write_to(&mut record).expect("written");
        let length = (record.len() - RECORD_HEADER) as u16;
        record[20..22].copy_from_slice(&length.to_le_bytes());
        let head = header(format | 0x80, points[0].len(), points.len() as u32, &record, 1);
        let mut file = std::io::Cursor::new(head);
        file.set_position(file.get_ref().len() as u64);
        let mut compressor = LasZipCompressor::new(file, vlr).expect("known");
        compressor.compress_many(&points.concat()).expect("compressed");
        compressor.done().expect("done");
        compressor.into_inner().into_inner()
    }

    #[test]
    fn compressed_points_are_the_same() {
        for format in [0, 1, 2, 3, 6, 7, 8] {
            let (packed, plain) = (read_ok(&laz(format)), read_ok(&las(format, 65535)));
            assert!(packed.format.starts_with("LAZ 1."), "{}", packed.format);
            assert!(packed.warnings.is_empty(), "{:?}", packed.warnings);
            assert_eq!(mesh(&packed), mesh(&plain), "{format}");
        }
    }

    #[test]
    fn broken_data_are_read_as_far_as_they_go() {
        for format in [2, 7] {
            let bytes = laz(format);
            let data = u32::from_le_bytes(take(&bytes, 96).expect("there")) as usize;
            let cut = read_ok(&bytes[..data + (bytes.len() - data) / 2]);
            let count = mesh(&cut).positions.len();
            assert!((100..900).contains(&count), "{count}");
            assert!(cut.warnings[0].to_string().contains("ends too early"));
            // Without the table of chunks, or with a part of it, all points are still read.
            let table = i64::from_le_bytes(take(&bytes, data).expect("there")) as usize;
            for length in [table, table + 10] {
                assert_eq!(mesh(&read_ok(&bytes[..length])).positions.len(), 1000);
            }
            for at in (0..bytes.len() - 4).step_by(3) {
                let mut bytes = bytes.clone();
                bytes[at..at + 4].copy_from_slice(&[0xff; 4]);
                let options = ReadOptions {
                    limits: Limits { primitives: 5000, ..Limits::default() },
                    ..ReadOptions::default()
                };
                drop(read(&bytes, &NoResources, &options));
            }
        }
    }

    #[test]
    fn layers_longer_than_the_file_are_refused() {
        let bytes = laz(7);
        let data = u32::from_le_bytes(take(&bytes, 96).expect("there")) as usize;
        // After the table's offset: a point of 36 bytes and the count.
        let mut long = bytes.clone();
        long[data + 8 + 36 + 4..][..4].copy_from_slice(&[0xff; 4]);
        let e = read(&long, &NoResources, &ReadOptions::default()).expect_err("broken");
        assert!(e.to_string().contains("0 of 1000"), "{e}");
        let mut table = bytes.clone();
        let at = i64::from_le_bytes(take(&bytes, data).expect("there")) as usize;
        table[at + 4..at + 8].copy_from_slice(&[0xff; 4]);
        let e = read(&table, &NoResources, &ReadOptions::default()).expect_err("broken");
        assert!(e.to_string().contains("table of chunks"), "{e}");
    }
}
