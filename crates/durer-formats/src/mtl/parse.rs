//! The statements of a material library.

use crate::text::{self, Cursor, quote};
use crate::{Model, Place, Result, number};
use std::collections::HashMap;

/// A picture with its options.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Map {
    /// Path as returned by [`super::relative`].
    pub path: String,
    pub clamp: bool,
    /// `-s`: scale of u and v.
    pub scale: [f64; 2],
    /// `-o`: offset of u and v.
    pub offset: [f64; 2],
    /// `-bm`: strength of a bump or normal map.
    pub strength: f64,
}

/// Values of a material's statements; `None` for missing ones.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Statements {
    pub diffuse: Option<[f32; 3]>,
    pub specular: Option<[f32; 3]>,
    pub emissive: Option<[f32; 3]>,
    pub shininess: Option<f32>,
    /// `d`: 1 is opaque.
    pub dissolve: Option<f32>,
    /// `Tr`: 0 is opaque, or so the manual has it.
    pub transparency: Option<f32>,
    pub roughness: Option<f32>,
    pub metallic: Option<f32>,
    pub illum: Option<f32>,
    pub map_diffuse: Option<Map>,
    pub map_specular: Option<Map>,
    pub map_emissive: Option<Map>,
    pub map_alpha: Option<Map>,
    pub map_normal: Option<Map>,
    pub map_roughness: Option<Map>,
    pub map_metallic: Option<Map>,
    pub map_bump: Option<Map>,
}

/// Materials by name; the first of several with the same name is used.
#[derive(Debug, Default)]
pub(super) struct Library {
    pub materials: HashMap<String, Statements>,
    /// True if `Tr` is the opacity: among materials without `d`, it is never 0 and 1 at least once.
    pub tr_is_opacity: bool,
}

impl Library {
    /// Reads one file; `name` is for messages.
    pub fn read(&mut self, model: &mut Model, name: &str, text: &[u8]) {
        let mut cursor = Cursor::new(text);
        let mut current: Option<(String, Statements)> = None;
        let mut warnings = 0;
        while !cursor.at_end() {
            let line = cursor.line();
            if let Err(e) = self.statement(&mut cursor, &mut current) {
                warnings += 1;
                // One broken file must not bury the rest under its warnings.
                if warnings <= 20 {
                    let message = if let crate::Error::Decode { message, .. } = e {
                        message
                    } else {
                        e.to_string()
                    };
                    model.warn(
                        Place::Path(format!("{}, line {line}", quote(name.as_bytes()))),
                        message,
                    );
                }
            }
            cursor.next_line();
        }
        self.keep(current);
        let alone = |m: &Statements| m.transparency.filter(|_| m.dissolve.is_none());
        let any = |test: fn(f32) -> bool| self.materials.values().filter_map(alone).any(test);
        self.tr_is_opacity = any(|tr| tr >= 1.0) && !any(|tr| tr <= 0.0);
    }

    fn keep(&mut self, material: Option<(String, Statements)>) {
        if let Some((name, statements)) = material {
            self.materials.entry(name).or_insert(statements);
        }
    }

    fn statement(
        &mut self,
        cursor: &mut Cursor<'_>,
        current: &mut Option<(String, Statements)>,
    ) -> Result<()> {
        let Some(word) = cursor.word() else { return Ok(()) };
        let keyword = word.to_ascii_lowercase();
        if keyword == b"newmtl" {
            let name = text::name(cursor.rest()).into_owned();
            self.keep(current.replace((name, Statements::default())));
            return Ok(());
        }
        let Some((_, m)) = current else {
            return Err(cursor.error(format!("`{}` is before any `newmtl`", quote(word))));
        };
        match keyword.as_slice() {
            b"kd" => m.diffuse = Some(color(cursor)?),
            b"ks" => m.specular = Some(color(cursor)?),
            b"ke" => m.emissive = Some(color(cursor)?),
            b"ns" => m.shininess = Some(value(cursor)?),
            b"d" => m.dissolve = Some(dissolve(cursor)?),
            b"tr" => m.transparency = Some(value(cursor)?),
            b"pr" => m.roughness = Some(value(cursor)?),
            b"pm" => m.metallic = Some(value(cursor)?),
            b"illum" => m.illum = Some(value(cursor)?),
            b"map_kd" => m.map_diffuse = Some(map(cursor)?),
            b"map_ks" => m.map_specular = Some(map(cursor)?),
            b"map_ke" => m.map_emissive = Some(map(cursor)?),
            b"map_d" | b"map_opacity" => m.map_alpha = Some(map(cursor)?),
            b"norm" | b"map_norm" | b"map_kn" => m.map_normal = Some(map(cursor)?),
            b"map_pr" => m.map_roughness = Some(map(cursor)?),
            b"map_pm" => m.map_metallic = Some(map(cursor)?),
            b"map_bump" | b"bump" => m.map_bump = Some(map(cursor)?),
            // No counterpart in the scene, and no harm in leaving them out.
            b"ka" | b"ni" | b"tf" | b"map_ka" | b"map_ns" | b"map_tr" | b"map_tf" | b"map_ni"
            | b"refl" | b"map_refl" | b"disp" | b"map_disp" | b"decal" | b"sharpness"
            | b"map_aat" | b"km" | b"ps" | b"pc" | b"pcr" | b"aniso" | b"anisor" | b"map_ps"
            | b"map_pcr" | b"td" | b"tm" => {}
            _ => return Err(cursor.error(format!("`{}` is not known", quote(word)))),
        }
        Ok(())
    }
}

/// Returns three sRGB values, or one for all three.
fn color(cursor: &mut Cursor<'_>) -> Result<[f32; 3]> {
    let mut values = [0.0; 3];
    let count = cursor.floats(&mut values)?;
    let [r, g, b] = values.map(|v| v as f32);
    match count {
        1 => Ok([r; 3]),
        3 => Ok([r, g, b]),
        _ => Err(cursor.error(format!("a color has 3 numbers, here are {count}"))),
    }
    .and_then(|c| {
        let fine = c.iter().all(|v| v.is_finite() && *v >= 0.0);
        if fine { Ok(c) } else { Err(cursor.error("a color has finite numbers from 0 on")) }
    })
}

/// Returns one finite number.
fn value(cursor: &mut Cursor<'_>) -> Result<f32> {
    match cursor.float()? {
        Some(v) if v.is_finite() => Ok(v as f32),
        Some(v) => Err(cursor.error(format!("{v} is not finite"))),
        None => Err(cursor.error("a number is missing")),
    }
}

/// Reads `d alpha` or `d -halo alpha`.
fn dissolve(cursor: &mut Cursor<'_>) -> Result<f32> {
    let mut ahead = cursor.clone();
    if ahead.word() == Some(b"-halo") {
        *cursor = ahead;
    }
    value(cursor)
}

/// Reads options and the name of a picture, which may hold blanks.
fn map(cursor: &mut Cursor<'_>) -> Result<Map> {
    let mut map =
        Map { path: String::new(), clamp: false, scale: [1.0; 2], offset: [0.0; 2], strength: 1.0 };
    loop {
        let mut ahead = cursor.clone();
        let word = ahead.word().unwrap_or_default();
        match word {
            b"-blendu" | b"-blendv" | b"-cc" | b"-imfchan" | b"-type" | b"-texres" | b"-boost" => {
                ahead.word();
            }
            b"-clamp" => map.clamp = ahead.word().is_some_and(|w| w.eq_ignore_ascii_case(b"on")),
            b"-mm" => drop(numbers(&mut ahead, 2)),
            b"-t" => drop(numbers(&mut ahead, 3)),
            b"-bm" => map.strength = numbers(&mut ahead, 1).first().copied().unwrap_or(1.0),
            b"-s" => set(&mut map.scale, &numbers(&mut ahead, 3)),
            b"-o" => set(&mut map.offset, &numbers(&mut ahead, 3)),
            _ => break,
        }
        *cursor = ahead;
    }
    map.path = super::relative(&text::name(cursor.rest()));
    if map.path.is_empty() {
        Err(cursor.error("the name of a picture is missing"))
    } else {
        Ok(map)
    }
}

fn set(pair: &mut [f64; 2], values: &[f64]) {
    for (to, from) in pair.iter_mut().zip(values) {
        *to = *from;
    }
}

/// Reads up to `most` words that are finite numbers.
fn numbers(cursor: &mut Cursor<'_>, most: usize) -> Vec<f64> {
    let mut found = Vec::new();
    while found.len() < most {
        let mut ahead = cursor.clone();
        let word = ahead.word().unwrap_or_default();
        match number::float(word) {
            Some((v, n)) if n == word.len() && v.is_finite() => found.push(v),
            _ => break,
        }
        *cursor = ahead;
    }
    found
}
