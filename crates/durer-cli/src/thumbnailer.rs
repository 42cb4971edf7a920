//! `durer thumbnailer`: the file by which a desktop lets durer make thumbnails of models.

use crate::failure::Failure;
use crate::output::{self, Target};
use crate::places::STREAM;
use crate::report;
use clap::{Args, ValueHint};
use std::path::PathBuf;

/// Instructions for installing it.
pub const HELP: &str = "\
To see models in file managers (GNOME, Xfce, MATE, Cinnamon):
  mkdir -p ~/.local/share/thumbnailers
  durer thumbnailer ~/.local/share/thumbnailers/durer.thumbnailer
Desktops know most formats; for the others:
  mkdir -p ~/.local/share/mime/packages
  durer thumbnailer --types ~/.local/share/mime/packages/durer.xml
  update-mime-database ~/.local/share/mime
Then remove the thumbnails that failed before: rm -r ~/.cache/thumbnails/fail";

/// The options of `durer thumbnailer`.
#[derive(Debug, Args)]
pub struct ThumbnailerArgs {
    /// File to write to; `-` for standard output
    #[arg(value_name = "FILE", value_hint = ValueHint::AnyPath, default_value = STREAM, hide_default_value = true)]
    pub output: PathBuf,
    /// Write the types of files that desktops do not know, instead of the thumbnailer
    #[arg(long)]
    pub types: bool,
}

/// Formats by their usual names, with the current and former media types that desktops use.
const TYPES: &[(&str, &[&str])] = &[
    ("glTF", &["model/gltf-binary", "model/gltf+json"]),
    ("OBJ", &["model/obj", "application/prs.wavefront-obj"]),
    ("STL", &["model/stl", "model/x.stl-ascii", "model/x.stl-binary", "application/sla"]),
    ("PLY", &["model/ply", "application/x-ply"]),
    (
        "3MF",
        &[
            "model/3mf",
            "application/vnd.ms-3mfdocument",
            "application/vnd.ms-package.3dmanufacturing-3dmodel+xml",
        ],
    ),
    ("COLLADA", &["model/vnd.collada+xml"]),
    #[cfg(feature = "fbx")]
    ("FBX", &["application/vnd.fbx", "model/fbx"]),
    ("OFF", &["model/off", "application/x-off"]),
    ("LAS", &["application/vnd.las", "application/vnd.laszip"]),
    ("E57", &["model/e57"]),
    // Other lists of numbers have these suffixes too, so only the type for points is listed.
    ("points as text", &["model/x-pts"]),
];

/// Formats that desktops do not know, with the media types used above.
const UNKNOWN: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<mime-info xmlns="http://www.freedesktop.org/standards/shared-mime-info">
  <mime-type type="model/ply">
    <comment>PLY 3D model</comment>
    <alias type="application/x-ply"/>
    <magic priority="50">
      <match type="string" offset="0" value="ply\n"/>
      <match type="string" offset="0" value="ply\r"/>
    </magic>
    <glob pattern="*.ply"/>
  </mime-type>
  <mime-type type="model/off">
    <comment>OFF 3D model</comment>
    <alias type="application/x-off"/>
    <glob pattern="*.off"/>
  </mime-type>
  <mime-type type="application/vnd.fbx">
    <comment>FBX model</comment>
    <alias type="model/fbx"/>
    <magic priority="50"><match type="string" offset="0" value="Kaydara FBX Binary"/></magic>
    <glob pattern="*.fbx"/>
  </mime-type>
  <mime-type type="application/vnd.las">
    <comment>LAS points</comment>
    <magic priority="50"><match type="string" offset="0" value="LASF"/></magic>
    <glob pattern="*.las"/>
  </mime-type>
  <mime-type type="application/vnd.laszip">
    <comment>LAZ points</comment>
    <glob pattern="*.laz"/>
  </mime-type>
  <mime-type type="model/e57">
    <comment>E57 points</comment>
    <magic priority="50"><match type="string" offset="0" value="ASTM-E57"/></magic>
    <glob pattern="*.e57"/>
  </mime-type>
  <mime-type type="model/x-pts">
    <comment>Points as text</comment>
    <glob pattern="*.pts"/>
    <glob pattern="*.xyzrgb"/>
  </mime-type>
</mime-info>
"#;

/// Writes the entry, or the types.
pub fn run(args: &ThumbnailerArgs) -> Result<(), Failure> {
    let text = if args.types { UNKNOWN.to_owned() } else { entry() };
    if crate::places::is_stream(&args.output) {
        return report::print_text(&text);
    }
    let target: Target = output::file_or_stream("FILE", &args.output)?;
    output::deliver_bytes(&target, text.as_bytes())?;
    Ok(())
}

/// Returns the desktop entry; the desktop inserts the size, the new picture's name, which may end in anything, and the
/// model's name.
fn entry() -> String {
    let types = TYPES.iter().flat_map(|(_, types)| *types);
    let types: String = types.map(|name| format!("{name};")).collect();
    format!(
        "[Thumbnailer Entry]\n\
         TryExec=durer\n\
         Exec=durer render --no-config --quiet --format png --background transparent --size %s --output %o %i\n\
         MimeType={types}\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_formats::ModelFormat;

    #[test]
    fn each_format_has_a_type() {
        for format in ModelFormat::ALL {
            let found = TYPES.iter().find(|(name, _)| *name == format.name());
            assert!(found.is_some_and(|(_, types)| !types.is_empty()), "{}", format.name());
        }
        assert_eq!(TYPES.len(), ModelFormat::ALL.len());
    }
}
