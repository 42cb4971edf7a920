//! A moment of an animation: its effect on nodes and morph weights.

use super::buffer::Source;
use super::choice;
use super::json::{Animation, AnimationSampler, Channel, Root};
use super::node::{Override, unit};
use crate::{Error, Pose, Result};
use durer::math::{DQuat, DVec3};

/// Returns the names of the animations; unnamed ones are `animation0`, `animation1` …
pub fn names(root: &Root) -> Vec<String> {
    choice::names("animation", root.animations.iter().map(|animation| &animation.name))
}

/// Returns the values that the animation sets for each node at the requested time; nothing for the
/// rest pose.
///
/// # Errors
/// If there is no such animation, or its data are broken.
pub fn pose(source: &Source<'_>, pose: Option<&Pose>) -> Result<Vec<Override>> {
    let root = source.root;
    let mut overrides = vec![Override::default(); root.nodes.len()];
    let Some(pose) = pose else { return Ok(overrides) };
    if !pose.time.is_finite() {
        return Err(durer::Error::parameter("time", pose.time, "a finite number of seconds").into());
    }
    let Some(number) = find(root, pose)? else { return Ok(overrides) };
    let animation = &root.animations[number];
    for (c, channel) in animation.channels.iter().enumerate() {
        let at = format!("animations[{number}].channels[{c}]");
        if let Some(node) = channel.target.node.and_then(|n| overrides.get_mut(n.index())) {
            apply(source, animation, channel, pose.time, node, &at)?;
        }
    }
    Ok(overrides)
}

/// Returns the index of the requested animation; `None` if none is named and the file has none.
fn find(root: &Root, pose: &Pose) -> Result<Option<usize>> {
    if pose.animation.is_none() {
        return Ok((!root.animations.is_empty()).then_some(0));
    }
    choice::find("animation", &names(root), pose.animation.as_deref(), "animations")
}

/// Applies one channel.
fn apply(
    source: &Source<'_>,
    animation: &Animation,
    channel: &Channel,
    time: f64,
    node: &mut Override,
    at: &str,
) -> Result<()> {
    let Some(sampler) = channel.sampler.and_then(|s| animation.samplers.get(s.index())) else {
        return Ok(());
    };
    match channel.target.path.as_str() {
        "translation" => {
            let [x, y, z] = sample_lanes::<3>(source, sampler, time, false, at)?;
            node.translation = Some(DVec3::new(x, y, z));
        }
        "rotation" => {
            let [x, y, z, w] = sample_lanes::<4>(source, sampler, time, true, at)?;
            node.rotation = Some(DQuat::from_xyzw(x, y, z, w));
        }
        "scale" => {
            let [x, y, z] = sample_lanes::<3>(source, sampler, time, false, at)?;
            node.scale = Some(DVec3::new(x, y, z));
        }
        "weights" => {
            let track = Track::read::<1>(source, sampler, at)?;
            let weights = track.at(time, false);
            node.weights = Some(weights.into_iter().map(|w| w as f32).collect());
        }
        // Other paths belong to extensions, which are warned about by their names.
        _ => {}
    }
    Ok(())
}

fn sample_lanes<const N: usize>(
    source: &Source<'_>,
    sampler: &AnimationSampler,
    time: f64,
    rotation: bool,
    at: &str,
) -> Result<[f64; N]> {
    let value = Track::read::<N>(source, sampler, at)?.at(time, rotation);
    <[f64; N]>::try_from(value)
        .map_err(|v| Error::path(at, format!("has {} numbers per key, {N} are needed", v.len())))
}

/// Interpolation between keys.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Interpolation {
    Step,
    Linear,
    CubicSpline,
}

/// Keys and values of a sampler.
#[derive(Debug)]
struct Track {
    /// Seconds, rising; never empty.
    times: Vec<f32>,
    /// Per key `lanes` values, or with splines as many in-tangents, values and out-tangents.
    values: Vec<f32>,
    lanes: usize,
    interpolation: Interpolation,
}

impl Track {
    /// Reads values of N numbers per element; one key may have several elements (weights).
    fn read<const N: usize>(
        source: &Source<'_>,
        sampler: &AnimationSampler,
        at: &str,
    ) -> Result<Self> {
        let interpolation = match sampler.interpolation.as_deref() {
            None | Some("LINEAR") => Interpolation::Linear,
            Some("STEP") => Interpolation::Step,
            Some("CUBICSPLINE") => Interpolation::CubicSpline,
            Some(other) => return Err(Error::path(at, format!("unknown interpolation `{other}`"))),
        };
        let (input, output) =
            (sampler.input.unwrap_or_default(), sampler.output.unwrap_or_default());
        let times = source.floats::<1>(input, &format!("{at}.input"))?.into_flattened();
        let values = source.floats::<N>(output, &format!("{at}.output"))?.into_flattened();
        if times.is_empty() || times.iter().any(|t| !t.is_finite()) {
            return Err(Error::path(at, "its times must be finite numbers, at least one"));
        }
        if times.windows(2).any(|pair| pair[0] > pair[1]) {
            return Err(Error::path(at, "its times do not rise"));
        }
        let per_key = times.len() * if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let lanes = values.len() / per_key;
        if lanes * per_key != values.len() || lanes == 0 {
            let message = format!("{} values do not go with {} keys", values.len(), times.len());
            return Err(Error::path(at, message));
        }
        Ok(Self { times, values, lanes, interpolation })
    }

    /// Returns the value at a time, clamped to the first and last key. Rotations go along the
    /// shorter arc.
    fn at(&self, time: f64, rotation: bool) -> Vec<f64> {
        let after = self.times.partition_point(|&t| f64::from(t) <= time);
        let last = self.times.len() - 1;
        if after == 0 || after > last {
            return self.key(after.min(last), 1);
        }
        let (t0, t1) = (f64::from(self.times[after - 1]), f64::from(self.times[after]));
        let (span, t) = (t1 - t0, (time - t0) / (t1 - t0));
        let (from, to) = (self.key(after - 1, 1), self.key(after, 1));
        match self.interpolation {
            Interpolation::Step => from,
            Interpolation::Linear if rotation => slerp(&from, &to, t),
            Interpolation::Linear => zip(&from, &to, |a, b| a + (b - a) * t),
            Interpolation::CubicSpline => {
                let (out, into) = (self.key(after - 1, 2), self.key(after, 0));
                let (t2, t3) = (t * t, t * t * t);
                let values = zip(&from, &to, |a, b| {
                    (2.0 * t3 - 3.0 * t2 + 1.0) * a + (3.0 * t2 - 2.0 * t3) * b
                });
                let tangents =
                    zip(&out, &into, |a, b| span * ((t3 - 2.0 * t2 + t) * a + (t3 - t2) * b));
                zip(&values, &tangents, |v, d| v + d)
            }
        }
    }

    /// Returns the values of a key; `part` of a spline: 0 in-tangent, 1 value, 2 out-tangent.
    fn key(&self, key: usize, part: usize) -> Vec<f64> {
        let spline = self.interpolation == Interpolation::CubicSpline;
        let block = if spline { 3 * key + part } else { key };
        self.values[block * self.lanes..][..self.lanes].iter().map(|&v| f64::from(v)).collect()
    }
}

fn zip(a: &[f64], b: &[f64], f: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    a.iter().zip(b).map(|(&a, &b)| f(a, b)).collect()
}

/// Interpolates spherically along the shorter arc (Shoemake 1985); linearly if the two are so close that the sine of
/// their angle is useless.
fn slerp(a: &[f64], b: &[f64], t: f64) -> Vec<f64> {
    let quaternion = |v: &[f64]| match *v {
        [x, y, z, w] => unit(DQuat::from_xyzw(x, y, z, w)),
        _ => DQuat::IDENTITY,
    };
    let (a, b) = (quaternion(a), quaternion(b));
    let cosine = a.dot(b);
    let (cosine, sign) = if cosine < 0.0 { (-cosine, -1.0) } else { (cosine, 1.0) };
    let (from, to) = if cosine > 0.999_999 {
        (1.0 - t, t)
    } else {
        let angle = libm::acos(cosine);
        let s = libm::sin(angle);
        (libm::sin((1.0 - t) * angle) / s, libm::sin(t * angle) / s)
    };
    unit(a * from + b * (sign * to)).to_array().to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn track(interpolation: Interpolation, values: &[f32]) -> Track {
        Track { times: vec![1.0, 3.0], values: values.to_vec(), lanes: 1, interpolation }
    }

    #[test]
    fn times_are_clamped_and_values_interpolated() {
        let linear = track(Interpolation::Linear, &[10.0, 20.0]);
        let at = |t: f64| linear.at(t, false)[0];
        assert_eq!([at(-5.0), at(1.0), at(1.5), at(3.0), at(9.0)], [10.0, 10.0, 12.5, 20.0, 20.0]);
        let step = track(Interpolation::Step, &[10.0, 20.0]);
        assert_eq!([step.at(2.9, false)[0], step.at(3.0, false)[0]], [10.0, 20.0]);
        // Flat values with an out-tangent of 1 per second: at the middle 2·(1/8)·1 = 0.25 more.
        let spline = track(Interpolation::CubicSpline, &[0.0, 5.0, 1.0, 0.0, 5.0, 0.0]);
        assert_eq!(spline.at(2.0, false), [5.25]);
    }

    #[test]
    fn rotations_take_the_shorter_arc() {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let quarter = slerp(&[0.0, 0.0, 0.0, 1.0], &[0.0, 0.0, -half, -half], 0.5);
        let expected = [
            0.0,
            0.0,
            libm::sin(std::f64::consts::PI / 8.0),
            libm::cos(std::f64::consts::PI / 8.0),
        ];
        for (a, b) in quarter.iter().zip(expected) {
            assert!((a - b).abs() < 1e-15, "{quarter:?}");
        }
    }
}
