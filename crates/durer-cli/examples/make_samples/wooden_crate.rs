//! Three wooden crates, one on two, with a texture made by code.

use crate::glb::Glb;
use crate::solids;
use durer::math::DVec3;
use durer::target::Pixels;
use durer_formats::png::{self, Compression};
use serde_json::json;

/// Side of the texture in pixels.
const SIDE: u32 = 256;
/// Width of the frame around the planks.
const FRAME: f64 = 0.13;

/// Returns the bytes of a binary glTF file.
pub fn glb() -> Result<Vec<u8>, Box<dyn std::error::Error>> {
    let mut image = Vec::new();
    png::write_color(&mut image, &texture(), Compression::Small)?;
    let mut glb = Glb::default();
    let texture = glb.texture(&image);
    let wood = glb.material(json!({
        "name": "wood",
        "pbrMetallicRoughness":
            {"baseColorTexture": {"index": texture}, "metallicFactor": 0.0, "roughnessFactor": 0.8},
    }));
    let cube = glb.geometry(&solids::cuboid(DVec3::ONE));
    let mesh = glb.mesh(cube, wood);
    glb.node("left", mesh, DVec3::new(-1.15, 1.0, 0.0), 8.0, DVec3::ONE);
    glb.node("right", mesh, DVec3::new(1.2, 1.0, -0.2), -12.0, DVec3::ONE);
    glb.node("upper", mesh, DVec3::new(0.1, 2.75, -0.1), 30.0, DVec3::splat(0.75));
    Ok(glb.finish()?)
}

fn texture() -> Pixels<[u8; 4]> {
    let mut pixels = Pixels::new(SIDE, SIDE, [0; 4]);
    for y in 0..SIDE {
        for x in 0..SIDE {
            let center = |i: u32| (f64::from(i) + 0.5) / f64::from(SIDE);
            let light = brightness(center(x), center(y));
            let wood = [191.0, 140.0, 84.0].map(|c: f64| (c * light).clamp(0.0, 255.0) as u8);
            pixels.set(x, y, [wood[0], wood[1], wood[2], 255]);
        }
    }
    pixels
}

/// Returns the colour of upright planks, a frame around them, and a diagonal board.
fn brightness(u: f64, v: f64) -> f64 {
    let to_border = u.min(1.0 - u).min(v.min(1.0 - v));
    let to_diagonal = (u + v - 1.0).abs() * 0.707;
    if to_border < FRAME {
        let upright = u.min(1.0 - u) < v.min(1.0 - v);
        let (along, across) = if upright { (v, u) } else { (u, v) };
        board(along, across, 7) * edge(FRAME - to_border) * edge(to_border)
    } else if to_diagonal < 0.08 {
        board((u - v) * 0.707, u + v, 11) * 0.97 * edge(0.08 - to_diagonal)
    } else {
        let plank = (u * 6.0).floor();
        let inside = u * 6.0 - plank;
        let shadow = ((to_border - FRAME) / 0.03).min((to_diagonal - 0.08) / 0.03).clamp(0.0, 1.0);
        let tone = 0.78 + 0.12 * noise(plank as i64, 3, 5);
        board(v, u, plank as u32)
            * tone
            * edge(inside.min(1.0 - inside) / 6.0)
            * (0.6 + 0.4 * shadow)
    }
}

/// Dark within a hundredth of a board's edge.
fn edge(distance: f64) -> f64 {
    0.45 + 0.55 * (distance / 0.012).clamp(0.0, 1.0)
}

/// Grain along a board: noise stretched along it.
fn board(along: f64, across: f64, seed: u32) -> f64 {
    let coarse = smooth(along * 4.0, across * 40.0, seed);
    let fine = smooth(along * 9.0, across * 120.0, seed + 100);
    0.78 + 0.2 * coarse + 0.12 * fine
}

/// Value noise between 0 and 1, bilinear with smooth steps.
fn smooth(x: f64, y: f64, seed: u32) -> f64 {
    let (i, j) = (x.floor(), y.floor());
    let step = |t: f64| t * t * (3.0 - 2.0 * t);
    let (s, t) = (step(x - i), step(y - j));
    let at = |di: i64, dj: i64| noise(i as i64 + di, j as i64 + dj, seed);
    let row = |dj: i64| at(0, dj) * (1.0 - s) + at(1, dj) * s;
    row(0) * (1.0 - t) + row(1) * t
}

/// Returns a pseudo-random number between 0 and 1.
fn noise(x: i64, y: i64, seed: u32) -> f64 {
    let mut h = (x as u64)
        .wrapping_mul(0x9e37_79b9_7f4a_7c15)
        .wrapping_add((y as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f))
        .wrapping_add(u64::from(seed).wrapping_mul(0x1656_67b1_9e37_79f9));
    h = (h ^ h >> 32).wrapping_mul(0xd6e8_feb8_6659_fd93);
    h = (h ^ h >> 32).wrapping_mul(0xd6e8_feb8_6659_fd93);
    (h >> 40) as f64 / (1u64 << 24) as f64
}
