//! The pictures of a drawing: in it, beside it, drawings themselves.

use super::{Notes, ReadOptions, fonts, prepared, resolved, source};
use crate::image::Orientation;
use crate::{Found, Limits, Place, Result, png, uri};
use durer::target::Pixels;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;
use usvg::{ImageHrefResolver, ImageKind};

/// Prefix of the addresses of pictures in the list.
pub(super) const LISTED: &str = "picture:";

/// Limit on bytes below which pictures are decoded while reading, so that warnings of broken ones have their place.
const SMALL: usize = 1 << 16;

/// A picture that a drawing refers to.
#[derive(Debug, Clone)]
pub(super) struct Picture {
    pub href: String,
    pub place: Place,
    /// True within a drawing that is a picture itself, and so may not refer to files.
    pub is_within: bool,
}

/// An address, whether it is in a drawing that is a picture itself, and the number of enclosing elements: a drawing
/// that is a picture there may be too deep.
pub(super) type Key = (String, bool, usize);

/// Pictures that have been read.
pub(super) type Read = BTreeMap<Key, ImageKind>;

/// Returns the resolver of pictures, which looks them up in the drawing's list.
pub(super) fn resolver<'a>(options: &ReadOptions<'a>, notes: &'a Notes) -> ImageHrefResolver<'a> {
    let options = options.clone();
    ImageHrefResolver {
        resolve_data: Box::new(|_, _, _| None),
        resolve_string: Box::new(move |key, usvg_options| {
            let number = key.strip_prefix(LISTED)?.parse().ok()?;
            let picture = notes.picture(number)?;
            let key = (picture.href.clone(), picture.is_within, notes.levels());
            if let Some(found) = notes.read_before(&key) {
                return Some(found);
            }
            let found = kind(&picture, &options, usvg_options, notes);
            found
                .inspect(|kind| notes.keep_read(key, kind.clone()))
                .map_err(|why| {
                    notes.add(
                        picture.place.clone(),
                        format!("image `{}` is left out: {why}", name(&picture.href)),
                    )
                })
                .ok()
        }),
    }
}

/// Returns the beginning of an address.
fn name(href: &str) -> Cow<'_, str> {
    const SHOWN: usize = 60;
    match href.trim().char_indices().nth(SHOWN) {
        Some((at, _)) => Cow::Owned(format!("{}…", href.trim().get(..at).unwrap_or_default())),
        None => Cow::Borrowed(href.trim()),
    }
}

/// Returns a picture in terms of usvg, or the reason why it cannot be shown.
fn kind(
    picture: &Picture,
    options: &ReadOptions<'_>,
    usvg_options: &usvg::Options<'_>,
    notes: &Notes,
) -> std::result::Result<ImageKind, String> {
    let bytes = bytes(picture, options, notes)?;
    let limits = Limits { decoded_bytes: notes.bytes_left(), ..options.limits.clone() };
    match bytes.as_slice() {
        // A text, perhaps with a mark or in two bytes a letter, or compressed.
        [b'<' | b' ' | b'\n' | b'\r' | b'\t', ..]
        | [0xef, 0xbb, ..]
        | [0xfe, 0xff, ..]
        | [0xff, 0xfe, ..]
        | [0, b'<', ..]
        | [0x1f, 0x8b, ..] => {
            within(&bytes, picture, options, usvg_options, notes).map(ImageKind::SVG)
        }
        [b'\x89', b'P', b'N', b'G', ..] => {
            check(&bytes, &limits)?;
            Ok(ImageKind::PNG(Arc::new(bytes)))
        }
        [0xff, 0xd8, ..] if Orientation::of(&bytes) == Orientation::Upright => {
            check(&bytes, &limits)?;
            Ok(ImageKind::JPEG(Arc::new(bytes)))
        }
        _ => as_png(&bytes, &limits, notes)
            .map(|png| ImageKind::PNG(Arc::new(png)))
            .map_err(|e| e.to_string()),
    }
}

fn check(bytes: &[u8], limits: &Limits) -> std::result::Result<(), String> {
    if bytes.len() < SMALL {
        crate::image::decode(bytes, "", limits).map_err(|e| e.to_string())?;
    }
    Ok(())
}

/// Returns the bytes of a picture.
fn bytes(
    picture: &Picture,
    options: &ReadOptions<'_>,
    notes: &Notes,
) -> std::result::Result<Vec<u8>, String> {
    let href = picture.href.trim();
    let limit = options.limits.decoded_bytes;
    if uri::is_data(href) {
        let plain = plain_data(href);
        return uri::load(&plain, "", options.resources, limit)
            .map(|found| found.bytes)
            .map_err(|e| e.to_string());
    }
    if picture.is_within {
        return Err("a drawing that is an image may not refer to files".to_owned());
    }
    let path = uri::path(href)?;
    let Found { bytes, note } = options.resources.find(&path, limit)?;
    if let Some(note) = note {
        notes.add(picture.place.clone(), format!("image `{}`: {note}", name(href)));
    }
    Ok(bytes)
}

/// Returns a data URI as [`uri::load`] reads it: without blanks in base64, without a fragment, and each `%`
/// that encodes nothing encoded.
fn plain_data(href: &str) -> String {
    let href = href.split('#').next().unwrap_or_default();
    let (head, payload) = href.split_at(href.find(',').unwrap_or(href.len()));
    if head.trim_end().to_ascii_lowercase().ends_with("base64") {
        let mut plain: String = payload.chars().filter(|c| !c.is_ascii_whitespace()).collect();
        for blank in ["%0A", "%0a", "%0D", "%0d", "%20", "%09"] {
            if plain.contains(blank) {
                plain = plain.replace(blank, "");
            }
        }
        return head.trim_end().to_owned() + &plain;
    }
    let mut plain = head.to_owned();
    let mut rest = payload;
    while let Some((before, after)) = rest.split_once('%') {
        plain.push_str(before);
        let encodes =
            after.as_bytes().get(..2).is_some_and(|two| two.iter().all(u8::is_ascii_hexdigit));
        plain.push_str(if encodes { "%" } else { "%25" });
        rest = after;
    }
    plain + rest
}

/// Returns a picture upright, as a PNG: usvg measures only some kinds of files, and these as they are
/// stored.
fn as_png(bytes: &[u8], limits: &Limits, notes: &Notes) -> Result<Vec<u8>> {
    let image = crate::image::decode(bytes, "", limits)?;
    notes.take_bytes(image.data.len() as u64 * 4);
    let pixels =
        Orientation::of(bytes).turned(Pixels::from_data(image.width, image.height, image.data)?);
    let mut out = Vec::new();
    png::write_color(&mut out, &pixels, png::Compression::Fast)?;
    Ok(out)
}

/// Returns a drawing that is a picture of the drawing, checked with the same care before usvg reads it.
fn within(
    bytes: &[u8],
    picture: &Picture,
    options: &ReadOptions<'_>,
    usvg_options: &usvg::Options<'_>,
    notes: &Notes,
) -> std::result::Result<usvg::Tree, String> {
    let around = notes.levels();
    let tree = || {
        let text = source::text(bytes, &options.limits)?;
        let levels = around + super::references::IMAGE;
        let document = super::parse(&text)?;
        let prepared = prepared(&document, levels, notes, true)?;
        for warning in &prepared.warnings {
            notes.add(picture.place.clone(), format!("image `{}`: {warning}", name(&picture.href)));
        }
        let inner = usvg::Options {
            font_family: usvg_options.font_family.clone(),
            font_size: usvg_options.font_size,
            fontdb: options.fonts.database(),
            font_resolver: fonts::resolver(notes),
            image_href_resolver: resolver(options, notes),
            ..usvg::Options::default()
        };
        let amended = prepared.document()?;
        resolved(|| usvg::Tree::from_xmltree(amended.as_ref().unwrap_or(&document), &inner))
    };
    let tree = tree();
    notes.set_levels(around);
    tree.map_err(|why| format!("it is a drawing: {why}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_uris_are_read_as_browsers_read_them() {
        for (uri, expected) in [
            ("data:image/png;base64, AA \n BB", "data:image/png;base64,AABB"),
            ("data:image/png;base64,AA%0ABB==", "data:image/png;base64,AABB=="),
            (
                "data:image/svg+xml;utf8,<svg width='100%'/>#a",
                "data:image/svg+xml;utf8,<svg width='100%25'/>",
            ),
            ("data:,a%20b%é", "data:,a%20b%25é"),
            ("data:", "data:"),
        ] {
            assert_eq!(plain_data(uri), expected);
        }
    }
}
