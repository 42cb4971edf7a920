//! The output of features: one file, several beside each other, or standard output.

use super::sink::{Sink, failure};
use crate::failure::Failure;
use crate::messages::Messages;
use crate::output::{self, Target};
use crate::places::is_stream;
use durer_formats::geo::{GeoFormat, Member, System, Writer};
use std::io::IsTerminal;
use std::path::Path;

/// Returns the format of the result: the given one, or the suffix's, or for a stream the input's.
pub fn named_format(
    output: &Path,
    to: Option<GeoFormat>,
    from: Option<GeoFormat>,
) -> Result<GeoFormat, Failure> {
    let fail = |message| Err(Failure::Usage(format!("--output {}: {message}", output.display())));
    let named = GeoFormat::of_name(&output.to_string_lossy());
    let stream = is_stream(output) || output::is_special(output);
    let from = from.filter(|from| stream && from.is_written());
    let Some(format) = to.or(named).or(from) else {
        let written = GeoFormat::ALL.into_iter().filter(|f| f.is_written());
        let suffixes = written.map(|f| f.suffixes()[0]).collect::<Vec<_>>().join(", .");
        return fail(format!("the suffix does not name a format; use one of .{suffixes}, or --to"));
    };
    if let Some(feature) = format.missing_feature() {
        let what = format!("this build of durer does not write {format}");
        return fail(format!(
            "{what}; one with --features {feature} does; write .geojson or .gpkg"
        ));
    }
    if !format.is_written() {
        return fail(format!("{format} is only read; write .geojson, .fgb or another format"));
    }
    if format == GeoFormat::Shapefile && stream {
        return fail("a Shapefile is several files; name the .shp among them".to_owned());
    }
    Ok(format)
}

/// Returns a writer of features that has written the beginning of the file.
pub fn writer(
    output: &Path,
    to: GeoFormat,
    members: &[Member],
    system: System,
) -> Result<Writer<Sink>, Failure> {
    let place = place(output, to)?;
    let mut writer =
        if place.is_seekable() { Writer::seekable(to, place) } else { Writer::new(to, place) };
    if let Some(name) = output.file_stem().filter(|_| !is_stream(output)) {
        writer.set_layer(&name.to_string_lossy());
    }
    writer.head(members);
    writer.set_system(system);
    Ok(writer)
}

/// Returns a place for one file.
fn place(output: &Path, to: GeoFormat) -> Result<Sink, Failure> {
    if !is_stream(output) {
        return Sink::file(output);
    }
    if to.is_binary() && std::io::stdout().is_terminal() {
        let message = format!("--output -: {to} is not text for a terminal; use a pipe or a file");
        return Err(Failure::Usage(message));
    }
    Ok(Sink::stdout())
}

/// Writes the end of the file and the files beside it; returns the warnings.
pub fn finish(
    writer: Writer<Sink>,
    output: &Path,
    members: &[Member],
    messages: &Messages,
) -> Result<Vec<String>, Failure> {
    let done = writer.finish_all(members).map_err(|e| failure(output, &e))?;
    for (suffix, bytes) in done.beside {
        let target = Target::File(output.with_extension(suffix));
        output::deliver_bytes(&target, &bytes)?;
    }
    messages.warnings(&output.display().to_string(), &done.warnings);
    done.out.commit()?;
    Ok(done.warnings.iter().map(ToString::to_string).collect())
}
