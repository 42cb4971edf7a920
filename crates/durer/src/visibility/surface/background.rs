//! Background of the picture.

use crate::math::Vec4;
use crate::visibility::surface::Background;

/// Returns the background's colour in each row of a picture of this height.
pub fn background_rows(background: Background, height: u32) -> impl Fn(i32) -> Vec4 + Sync {
    move |y| match background {
        Background::Color(color) => color,
        Background::Gradient(top, bottom) => {
            let t = (y as f32 + 0.5) / height as f32;
            top * (1.0 - t) + bottom * t
        }
    }
}
