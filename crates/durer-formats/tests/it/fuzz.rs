//! The fuzz targets for map data, drawings, models, height maps, panoramas and formulas, run on their seeds, on changed
//! seeds, and on random bytes.

use proptest::prelude::*;
use std::path::Path;

#[path = "../../../../fuzz/bodies/drawing.rs"]
mod drawing;
#[path = "../../../../fuzz/bodies/geo.rs"]
mod geo;
#[path = "../../../../fuzz/bodies/gltf_made.rs"]
mod gltf_made;
#[path = "../../../../fuzz/bodies/hdr.rs"]
mod hdr;
#[path = "../../../../fuzz/bodies/model.rs"]
mod model;
#[path = "../../../../fuzz/bodies/plot.rs"]
mod plot;
#[path = "../../../../fuzz/bodies/sheets.rs"]
mod sheets;
#[allow(dead_code)]
#[path = "../../../../fuzz/bodies/surfaces.rs"]
mod surfaces;
#[path = "../../../../fuzz/bodies/words.rs"]
mod words;

/// Function of a target, called with bytes.
type Body = fn(&[u8]);

const TARGETS: [(&str, Body); 31] = [
    ("geojson", geo::geojson),
    ("wkt", geo::wkt),
    ("wkb", geo::wkb),
    ("svg", geo::svg),
    ("shapefile", geo::shapefile),
    ("flatgeobuf", geo::flatgeobuf),
    ("geopackage", geo::geopackage),
    ("geoparquet", geo::geoparquet),
    ("topojson", geo::topojson),
    ("csv", geo::csv),
    ("kml", geo::kml),
    ("gpx", geo::gpx),
    ("drawing", drawing::drawing),
    ("gltf", model::gltf),
    ("draco", model::draco),
    ("image", model::image),
    ("meshopt", model::meshopt),
    ("obj", model::obj),
    ("mtl", model::mtl),
    ("stl", model::stl),
    ("ply", model::ply),
    ("threemf", model::threemf),
    ("collada", model::collada),
    ("fbx", model::fbx),
    ("off", model::off),
    ("las", model::las),
    ("e57", model::e57),
    ("xyz", model::xyz),
    ("hdr", hdr::hdr),
    ("height_map", plot::height_map),
    ("formula", plot::formula),
];

/// Targets that also draw their result, and so take longer.
const DRAWN: [(&str, Body); 5] = [
    ("gltf_made", gltf_made::gltf_made),
    ("sheet", sheets::sheet),
    ("marks", sheets::marks),
    ("curves", sheets::curves),
    ("maps", sheets::maps),
];

/// Returns the files of a target's folder of seeds; there must be some.
fn seeds(target: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds").join(target);
    let files = std::fs::read_dir(&folder).expect("seeds are part of the repository");
    let mut paths: Vec<_> = files.map(|f| f.expect("a file").path()).collect();
    paths.sort();
    assert!(!paths.is_empty(), "{}", folder.display());
    paths.iter().map(|path| std::fs::read(path).expect("a seed")).collect()
}

#[test]
fn seeds_and_their_beginnings() {
    for (target, body) in TARGETS.into_iter().chain(DRAWN) {
        for seed in seeds(target) {
            body(&seed);
            (0..8).for_each(|i| body(&seed[..seed.len() * i / 8]));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..256)) {
        TARGETS.iter().for_each(|(_, body)| body(&bytes));
    }

    #[test]
    fn changed_seeds(
        which in any::<prop::sample::Index>(), of in any::<prop::sample::Index>(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let (target, body) = TARGETS[which.index(TARGETS.len())];
        let all = seeds(target);
        let mut seed = all[of.index(all.len())].clone();
        for (at, byte) in changes {
            let at = at.index(seed.len().max(1));
            seed.splice(at..(at + 1).min(seed.len()), [byte]);
        }
        body(&seed);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_bytes_are_drawn(bytes in prop::collection::vec(any::<u8>(), 0..512)) {
        DRAWN.iter().for_each(|(_, body)| body(&bytes));
    }
}
