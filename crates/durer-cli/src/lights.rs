//! Lights as `--light` takes them, and exposure as `--exposure` does.

use crate::color::color;
use crate::values::{direction, not_negative, number, vector};
use durer::pipeline::Exposure;
use durer::scene::{Light, LightKind};

/// The help of `--light`.
pub const SYNTAX: &str = "\
A light, in world space; may be repeated. Lights replace the default lights, except for a faint ambient one that \
`ambient:black` removes. COLOR is as for --background, INTENSITY a factor (both optional, default white:1):
  ambient[:COLOR[:INTENSITY]]
  directional:DX,DY,DZ[:COLOR[:INTENSITY]]   shines along the direction
  point:X,Y,Z[:COLOR[:INTENSITY]]            intensity at a distance of 1, falls with its square
  spot:X,Y,Z:DX,DY,DZ:DEGREES[:COLOR[:INTENSITY]]   a cone of that half angle";

/// Reads one light; see [`SYNTAX`].
pub fn light(text: &str) -> Result<Light, String> {
    let mut fields = text.split(':');
    let mut next = |what: &str| fields.next().ok_or_else(|| format!("{what} is missing"));
    let kind = match next("the kind")? {
        "ambient" => LightKind::Ambient,
        "directional" => LightKind::Directional { direction: direction(next("the direction")?)? },
        "point" => LightKind::Point { position: vector(next("the position")?)?, range: None },
        "spot" => LightKind::Spot {
            position: vector(next("the position")?)?,
            direction: direction(next("the direction")?)?,
            range: None,
            inner: 0.0,
            outer: half_angle(next("the angle")?)?,
        },
        other => {
            return Err(format!(
                "`{other}` is not a kind of light; there are ambient, directional, point, spot"
            ));
        }
    };
    let tint = fields.next().map_or(Ok(durer::math::Vec4::ONE), color)?;
    let intensity = fields.next().map_or(Ok(1.0), not_negative)?;
    match fields.next() {
        Some(rest) => Err(format!("`{rest}` is one field too many")),
        None => Ok(Light { kind, color: tint.truncate() * intensity as f32 }),
    }
}

/// Reads `auto`, or a number of EV.
pub fn exposure(text: &str) -> Result<Exposure, String> {
    if text == "auto" {
        return Ok(Exposure::Auto);
    }
    let ev = number(text).map_err(|e| format!("{e}, or `auto`"))?;
    if (-64.0..=64.0).contains(&ev) {
        Ok(Exposure::Ev(ev as f32))
    } else {
        Err("an exposure is between -64 and 64 EV".to_owned())
    }
}

/// Returns half the angle of a cone, from degrees to radians.
fn half_angle(text: &str) -> Result<f64, String> {
    let degrees = number(text)?;
    if degrees > 0.0 && degrees <= 90.0 {
        Ok(degrees.to_radians())
    } else {
        Err("the half angle of a spot is above 0 and at most 90 degrees".to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer::math::{DVec3, Vec3};

    #[test]
    fn every_kind_of_light() {
        let ambient = light("ambient").unwrap();
        assert_eq!(ambient, Light { kind: LightKind::Ambient, color: Vec3::ONE });
        let sun = light("directional:0,-2,0:white:3").unwrap();
        let kind = LightKind::Directional { direction: DVec3::NEG_Y };
        assert_eq!(sun, Light { kind, color: Vec3::splat(3.0) });
        let lamp = light("point:-1,2,3:black").unwrap();
        let kind = LightKind::Point { position: DVec3::new(-1.0, 2.0, 3.0), range: None };
        assert_eq!(lamp, Light { kind, color: Vec3::ZERO });
        let spot = light("spot:0,5,0:0,-1,0:90").unwrap();
        assert!(matches!(spot.kind, LightKind::Spot { outer, .. } if outer == 90f64.to_radians()));
    }

    #[test]
    fn exposures_are_numbers_or_automatic() {
        assert_eq!(exposure("auto"), Ok(Exposure::Auto));
        assert_eq!(exposure("-1.5"), Ok(Exposure::Ev(-1.5)));
        for wrong in ["bright", "65", "-1e9", "nan", ""] {
            assert!(exposure(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn wrong_lights_say_what_is_wrong() {
        for (text, part) in [
            ("sun", "not a kind"),
            ("directional", "direction is missing"),
            ("directional:0,0,0", "other than 0"),
            ("point:1,2", "three numbers"),
            ("ambient:bluish", "colour"),
            ("ambient:white:-1", "below 0"),
            ("ambient:white:1:2", "too many"),
            ("spot:0,0,0:0,1,0:180", "90 degrees"),
        ] {
            let error = light(text).unwrap_err();
            assert!(error.contains(part), "{text}: {error}");
        }
    }
}
