//! Extensions that a part requires: the namespaces of the ones that are read, and names of others.

use crate::xml::{self, Here};
use crate::{Error, Result};
use quick_xml::events::BytesStart;

/// Namespaces of extensions that are read or do not change the picture.
const READ: &[&str] = &[
    "http://schemas.microsoft.com/3dmanufacturing/core/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06",
    "http://schemas.3mf.io/3dmanufacturing/production/alternatives/2021/04",
    "http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02",
    "http://schemas.microsoft.com/3dmanufacturing/beamlattice/balls/2020/07",
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07",
    "http://schemas.slic3r.org/3mf/2017/06",
    "http://schemas.bambulab.com/package/2021",
];

/// Extensions that are known by name, by a word of their namespaces.
const KNOWN: &[(&str, &str)] = &[
    ("/slice/", "slice extension"),
    ("/securecontent/", "secure content extension (encrypted parts)"),
    ("/volumetric/", "volumetric extension"),
    ("/implicit/", "implicit extension"),
    ("/displacement/", "displacement extension"),
    ("/booleanoperations/", "boolean operations extension"),
];

/// Checks that all that the model element requires is read.
///
/// # Errors
/// [`Error::Unsupported`] for the first that is not; an undefined prefix.
pub(super) fn check(model: &BytesStart<'_>, here: &Here<'_>) -> Result<()> {
    let required = xml::attribute(model, "requiredextensions").unwrap_or_default();
    for prefix in required.split_ascii_whitespace() {
        let Some(namespace) = namespace(model, prefix) else {
            let message = format!(
                "`requiredextensions` names the prefix `{prefix}`, which no `xmlns:{prefix}` explains"
            );
            return Err(here.wrong(message));
        };
        if !READ.contains(&namespace.as_str()) {
            return Err(unsupported(prefix, &namespace, here));
        }
    }
    Ok(())
}

fn namespace(model: &BytesStart<'_>, prefix: &str) -> Option<String> {
    let wanted = |key: &str| key.strip_prefix("xmlns:") == Some(prefix);
    let mut attributes = model.attributes();
    let found = attributes.with_checks(false).flatten().find(|a| wanted(a.key.as_ref()))?;
    Some(found.value.into_owned())
}

fn unsupported(prefix: &str, namespace: &str, here: &Here<'_>) -> Error {
    let known = KNOWN.iter().find(|(word, _)| namespace.contains(word));
    let name = known.map_or("extension", |(_, name)| *name);
    Error::Unsupported {
        place: here.place(),
        what: format!("the {name} `{namespace}`, which the file requires (prefix `{prefix}`),"),
        hint: "save the model without it, or where meshes show all of it, without the prefix in \
               `requiredextensions`"
            .to_owned(),
    }
}
