//! The placement of nodes: from their properties to matrices.
//!
//! Source: Autodesk, *FBX SDK Programmer's Guide*, "Computing transformation matrices"; the modes of
//! inheritance as in ufbx. Computed here with sines that are the same everywhere.

use crate::{Model, Place};
use durer::math::{DMat3, DMat4, DVec3};
use durer::scene::UpAxis;
use ufbx::{CoordinateAxes, CoordinateAxis, InheritMode, Node, Props, RotationOrder, Scene};

/// The frame of the file in the world, whose lengths are metres.
#[derive(Debug, Clone, Copy)]
pub(super) struct World {
    pub up_axis: UpAxis,
    pub matrix: DMat4,
    /// The length of the file's unit in metres.
    pub unit: f64,
}

impl World {
    /// Returns the frame by a file's settings.
    pub fn of(scene: &Scene, model: &mut Model) -> Self {
        let unit = Some(scene.settings.unit_meters).filter(|m| m.is_finite() && *m > 0.0);
        let scale = DMat4::from_scale(DVec3::splat(unit.unwrap_or(0.01)));
        let (up_axis, turn) = axes(&scene.settings.axes).unwrap_or_else(|| {
            model.warn(Place::Whole, "the axes make no frame; y is taken as up");
            (UpAxis::Y, DMat3::IDENTITY)
        });
        let matrix = scale * DMat4::from_mat3(turn);
        Self { up_axis, matrix, unit: unit.unwrap_or(0.01) }
    }
}

/// Returns the up axis, and the matrix that takes a file's axes to x on the right, and y up or z
/// up.
fn axes(axes: &CoordinateAxes) -> Option<(UpAxis, DMat3)> {
    let unit = |axis| {
        Some(match axis {
            CoordinateAxis::PositiveX => DVec3::X,
            CoordinateAxis::NegativeX => DVec3::NEG_X,
            CoordinateAxis::PositiveY => DVec3::Y,
            CoordinateAxis::NegativeY => DVec3::NEG_Y,
            CoordinateAxis::PositiveZ => DVec3::Z,
            CoordinateAxis::NegativeZ => DVec3::NEG_Z,
            CoordinateAxis::Unknown => return None,
        })
    };
    let (right, up, front) = (unit(axes.right)?, unit(axes.up)?, unit(axes.front)?);
    if right.cross(up).dot(front) == 0.0 {
        return None;
    }
    Some(if (up, front) == (DVec3::Z, DVec3::NEG_Y) {
        // z stays up, and the eye on the side of −y.
        (UpAxis::Z, DMat3::from_cols(right, DVec3::Y, DVec3::Z).transpose())
    } else {
        (UpAxis::Y, DMat3::from_cols(right, up, front).transpose())
    })
}

/// Returns a property that is a vector of finite numbers; `None` if it is not there, `Some(None)` if
/// they are not finite.
fn vector(props: &Props, name: &str) -> Option<Option<DVec3>> {
    let v = props.find_prop(name)?.value_vec4;
    Some(Some(DVec3::new(v.x, v.y, v.z)).filter(|v| v.is_finite()))
}

/// Returns a turn by degrees about the axes, the first letter's first.
fn turn(degrees: DVec3, order: RotationOrder) -> DMat3 {
    if degrees == DVec3::ZERO {
        return DMat3::IDENTITY;
    }
    let about = |degrees: f64| (libm::sin(degrees.to_radians()), libm::cos(degrees.to_radians()));
    let [(sx, cx), (sy, cy), (sz, cz)] = degrees.to_array().map(about);
    let x = DMat3::from_cols(DVec3::X, DVec3::new(0.0, cx, sx), DVec3::new(0.0, -sx, cx));
    let y = DMat3::from_cols(DVec3::new(cy, 0.0, -sy), DVec3::Y, DVec3::new(sy, 0.0, cy));
    let z = DMat3::from_cols(DVec3::new(cz, sz, 0.0), DVec3::new(-sz, cz, 0.0), DVec3::Z);
    match order {
        RotationOrder::Xyz | RotationOrder::Spheric => z * y * x,
        RotationOrder::Xzy => y * z * x,
        RotationOrder::Yzx => x * z * y,
        RotationOrder::Yxz => z * x * y,
        RotationOrder::Zxy => y * x * z,
        RotationOrder::Zyx => x * y * z,
    }
}

/// A translation after a turn after a scaling.
#[derive(Debug, Clone, Copy)]
struct Local {
    translation: DVec3,
    rotation: DMat3,
    scale: DVec3,
}

impl Local {
    fn unscaled(&self) -> DMat4 {
        DMat4::from_translation(self.translation) * DMat4::from_mat3(self.rotation)
    }

    fn matrix(&self) -> DMat4 {
        self.unscaled() * DMat4::from_scale(self.scale)
    }
}

/// Placement of one node.
#[derive(Debug, Clone, Copy)]
struct Frame {
    world: DMat4,
    /// Matrix without the node's own scale.
    unscaled: DMat4,
    /// The scale that nodes below inherit separately, if they do.
    scale: DVec3,
    /// Matrix from the geometry to the node.
    geometry: DMat4,
}

/// Placement of all nodes.
#[derive(Debug, Default)]
pub(super) struct Frames {
    frames: Vec<Frame>,
    /// Number of properties that were not finite.
    pub broken: usize,
}

impl Frames {
    /// Returns the frames of all nodes of a scene in the world. Parents come before their children.
    pub fn of(scene: &Scene, world: DMat4) -> Self {
        let geometry = DMat4::IDENTITY;
        let root = Frame { world, unscaled: world, scale: DVec3::ONE, geometry };
        let mut all = Self::default();
        for node in &scene.nodes {
            let frame = if node.is_root { root } else { all.frame(node, root) };
            all.frames.push(frame);
        }
        all
    }

    fn get(&self, node: Option<&Node>) -> Option<Frame> {
        self.frames.get(node?.element.typed_id as usize).copied()
    }

    fn frame(&mut self, node: &Node, root: Frame) -> Frame {
        let parent = self.get(node.parent.as_deref()).unwrap_or(root);
        let (local, geometry) = (self.local(node), self.own(node));
        if node.inherit_mode == InheritMode::Normal {
            let (world, unscaled) =
                (parent.world * local.matrix(), parent.world * local.unscaled());
            return Frame { world, unscaled, scale: local.scale, geometry };
        }
        let inherited =
            self.get(node.inherit_scale_node.as_deref()).map_or(DVec3::ONE, |f| f.scale);
        let local = Local {
            translation: local.translation * parent.scale,
            scale: local.scale * inherited,
            ..local
        };
        let (world, unscaled) =
            (parent.unscaled * local.matrix(), parent.unscaled * local.unscaled());
        Frame { world, unscaled, scale: local.scale, geometry }
    }

    fn vector(&mut self, props: &Props, name: &str, none: DVec3) -> DVec3 {
        match vector(props, name) {
            Some(Some(v)) => v,
            Some(None) => {
                self.broken += 1;
                none
            }
            None => none,
        }
    }

    /// Returns the node's own placement: T · Roff · Rp · Rpre · R · Rpost⁻¹ · Rp⁻¹ · Soff · Sp · S · Sp⁻¹, from right
    /// to left.
    fn local(&mut self, node: &Node) -> Local {
        let props = &node.element.props;
        let mut zero = |name| self.vector(props, name, DVec3::ZERO);
        let (scale_pivot, scale_offset) = (zero("ScalingPivot"), zero("ScalingOffset"));
        let (pivot, offset) = (zero("RotationPivot"), zero("RotationOffset"));
        let (moved, degrees) = (zero("Lcl Translation"), zero("Lcl Rotation"));
        let (before, after) = (zero("PreRotation"), zero("PostRotation"));
        let scale = self.vector(props, "Lcl Scaling", DVec3::ONE);
        let rotation = if node.use_rotation_space {
            let [before, after] = [before, after].map(|v| turn(v, RotationOrder::Xyz));
            before * turn(degrees, node.rotation_order) * after.transpose()
        } else {
            turn(degrees, RotationOrder::Xyz)
        };
        let scaled = scale_pivot - scale_pivot * scale + scale_offset;
        let translation = rotation * (scaled - pivot) + pivot + offset + moved;
        Local { translation, rotation, scale }
    }

    /// Returns the matrix of a node, which applies to everything attached to it except its
    /// geometry.
    pub fn world(&self, node: &Node) -> DMat4 {
        self.get(Some(node)).map_or(DMat4::IDENTITY, |f| f.world)
    }

    /// Returns the matrix of a node's geometry.
    pub fn geometry(&self, node: &Node) -> DMat4 {
        self.get(Some(node)).map_or(DMat4::IDENTITY, |f| f.world * f.geometry)
    }

    /// Returns the matrix that moves a node's geometry, but nothing below the node.
    fn own(&mut self, node: &Node) -> DMat4 {
        let props = &node.element.props;
        let translation = self.vector(props, "GeometricTranslation", DVec3::ZERO);
        let degrees = self.vector(props, "GeometricRotation", DVec3::ZERO);
        let scale = self.vector(props, "GeometricScaling", DVec3::ONE);
        let rotation = turn(degrees, RotationOrder::Xyz);
        Local { translation, rotation, scale }.matrix()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_take_the_first_letter_first() {
        let near = |a: DVec3, b: DVec3| assert!((a - b).length() < 1e-12, "{a} {b}");
        let quarter = DVec3::new(90.0, 0.0, 90.0);
        // About x, y becomes z, which a turn about z leaves unchanged.
        near(turn(quarter, RotationOrder::Xyz) * DVec3::Y, DVec3::Z);
        // About z first, y becomes −x, which a turn about x leaves unchanged.
        near(turn(quarter, RotationOrder::Zyx) * DVec3::Y, DVec3::NEG_X);
        near(turn(DVec3::new(0.0, 90.0, 0.0), RotationOrder::Xyz) * DVec3::X, DVec3::NEG_Z);
        near(turn(DVec3::new(0.0, 0.0, 90.0), RotationOrder::Xyz) * DVec3::X, DVec3::Y);
    }

    #[test]
    fn axes_become_right_and_up() {
        use CoordinateAxis::{NegativeY, PositiveX, PositiveY, PositiveZ, Unknown};
        let of = |right, up, front| axes(&CoordinateAxes { right, up, front });
        assert_eq!(of(PositiveX, PositiveY, PositiveZ), Some((UpAxis::Y, DMat3::IDENTITY)));
        assert_eq!(of(PositiveX, PositiveZ, NegativeY), Some((UpAxis::Z, DMat3::IDENTITY)));
        let Some((UpAxis::Y, turn)) = of(PositiveY, PositiveX, PositiveZ) else {
            panic!("a frame")
        };
        assert_eq!((turn * DVec3::X, turn * DVec3::Y), (DVec3::Y, DVec3::X));
        assert_eq!(of(PositiveX, PositiveX, PositiveZ), None);
        assert_eq!(of(PositiveX, PositiveY, Unknown), None);
    }
}
