//! NumPy's NPZ: a ZIP of NPY arrays. Scalars `xmin`, `xmax`, `ymin` and `ymax` beside the heights give their extent,
//! with the first row in the north.

use super::npy::{self, Array};
use super::{Grid, HeightMapOptions};
use crate::foreign;
use crate::{Error, Limits, Place, Result};
use std::io::{Cursor, Read};
use zip::ZipArchive;

type Archive<'a> = ZipArchive<Cursor<&'a [u8]>>;

pub fn read(bytes: &[u8], options: &HeightMapOptions) -> Result<Grid> {
    let mut archive = ZipArchive::new(Cursor::new(bytes))
        .map_err(|e| Error::whole(format!("the ZIP archive is broken: {}", foreign::zip(&e))))?;
    let names = archive.file_names().filter_map(Result::ok).map(|n| n.into_owned());
    let mut names: Vec<String> = names.collect();
    names.sort();
    let names: Vec<&str> = names.iter().filter_map(|n| n.strip_suffix(".npy")).collect();
    let array = heights(&mut archive, &names, options)?;
    let mut grid = array.grid("NPZ")?;
    let mut scalar = |name: &str| -> Result<Option<f64>> {
        if !names.contains(&name) {
            return Ok(None);
        }
        let array = entry(&mut archive, name, &options.limits)?;
        let first = array.values.first().copied();
        Ok(first.filter(|v| array.values.len() == 1 && v.is_finite()))
    };
    if let [Some(west), Some(east), Some(south), Some(north)] =
        [scalar("xmin")?, scalar("xmax")?, scalar("ymin")?, scalar("ymax")?]
    {
        // Some writers count downwards and call the north `ymin`.
        grid.place = Some([west.min(east), west.max(east), south.min(north), south.max(north)]);
    }
    Ok(grid)
}

/// Returns the array that was requested, or the first of two dimensions.
fn heights(archive: &mut Archive, names: &[&str], options: &HeightMapOptions) -> Result<Array> {
    if let Some(name) = options.array.as_deref() {
        if !names.contains(&name) {
            let there = names.join(", ");
            return Err(Error::whole(format!("there is no array `{name}`; there are {there}")));
        }
        return entry(archive, name, &options.limits);
    }
    for name in names {
        let array = entry(archive, name, &options.limits)?;
        if array.shape.len() == 2 {
            return Ok(array);
        }
    }
    let there = if names.is_empty() { "no arrays".to_owned() } else { names.join(", ") };
    Err(Error::whole(format!("an array of two dimensions is needed; there are {there}")))
}

fn entry(archive: &mut Archive, name: &str, limits: &Limits) -> Result<Array> {
    let file = archive.by_name(&format!("{name}.npy"));
    let file = file.map_err(|e| Error::path(name, foreign::zip(&e)))?;
    let mut bytes = Vec::new();
    let limit = limits.decoded_bytes;
    file.take(limit.saturating_add(1))
        .read_to_end(&mut bytes)
        .map_err(|e| Error::path(name, foreign::inflating(&e)))?;
    if bytes.len() as u64 > limit {
        let (place, what) = (Place::Path(name.to_owned()), "decoded size");
        return Err(Error::Limit { place, what, value: bytes.len() as u64, limit });
    }
    npy::array(&bytes, limits).map_err(|e| match e {
        Error::Decode { place, message } => Error::path(name, format!("{place}{message}")),
        other => other,
    })
}
