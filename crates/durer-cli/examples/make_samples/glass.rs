//! Coloured panes and a glass ball among opaque balls: surfaces that must be blended in order.

use crate::glb::Glb;
use crate::solids;
use durer::math::DVec3;
use serde_json::{Value, json};

/// Returns the bytes of a binary glTF file.
pub fn glb() -> Result<Vec<u8>, Box<dyn std::error::Error>> {
    let mut glb = Glb::default();
    floor(&mut glb);
    balls(&mut glb);
    panes(&mut glb);
    Ok(glb.finish()?)
}

fn opaque(name: &str, color: [f64; 3], metallic: f64, roughness: f64) -> Value {
    let [r, g, b] = color;
    json!({"name": name, "pbrMetallicRoughness": {
        "baseColorFactor": [r, g, b, 1.0], "metallicFactor": metallic, "roughnessFactor": roughness,
    }})
}

fn glass(name: &str, color: [f64; 4]) -> Value {
    json!({"name": name, "alphaMode": "BLEND", "doubleSided": true, "pbrMetallicRoughness": {
        "baseColorFactor": color, "metallicFactor": 0.0, "roughnessFactor": 0.1,
    }})
}

fn floor(glb: &mut Glb) {
    let slab = glb.geometry(&solids::cuboid(DVec3::new(4.0, 0.1, 3.0)));
    let stone = glb.material(opaque("stone", [0.7, 0.7, 0.72], 0.0, 0.9));
    let mesh = glb.mesh(slab, stone);
    glb.node("floor", mesh, DVec3::new(0.0, -0.1, 0.0), 0.0, DVec3::ONE);
}

fn balls(glb: &mut Glb) {
    let ball = glb.geometry(&solids::ball(64, 32));
    let balls = [
        ("gold", [1.0, 0.72, 0.30], 1.0, 0.25, [-2.6, 1.4]),
        ("copper", [0.95, 0.55, 0.42], 1.0, 0.45, [-0.9, -1.4]),
        ("red plastic", [0.75, 0.05, 0.04], 0.0, 0.3, [0.9, -1.4]),
        ("chalk", [0.9, 0.9, 0.88], 0.0, 1.0, [2.6, -1.4]),
        ("blue plastic", [0.05, 0.15, 0.7], 0.0, 0.5, [-2.6, -1.4]),
    ];
    for (name, color, metallic, roughness, [x, z]) in balls {
        let material = glb.material(opaque(name, color, metallic, roughness));
        let mesh = glb.mesh(ball, material);
        glb.node(name, mesh, DVec3::new(x, 0.8, z), 0.0, DVec3::splat(0.8));
    }
    let clear = glb.material(glass("clear glass", [0.85, 0.95, 1.0, 0.3]));
    let mesh = glb.mesh(ball, clear);
    glb.node("glass ball", mesh, DVec3::new(2.4, 0.9, 1.5), 0.0, DVec3::splat(0.9));
}

/// Three panes that overlap when seen from the front; one crosses another.
fn panes(glb: &mut Glb) {
    let pane = glb.geometry(&solids::cuboid(DVec3::new(1.0, 1.2, 0.03)));
    let panes = [
        ("red glass", [0.9, 0.1, 0.1, 0.45], [-1.0, 0.3], 10.0),
        ("green glass", [0.1, 0.8, 0.2, 0.45], [0.2, 0.9], -5.0),
        ("blue glass", [0.1, 0.3, 0.95, 0.45], [0.9, 0.5], 40.0),
    ];
    for (name, color, [x, z], degrees) in panes {
        let material = glb.material(glass(name, color));
        let mesh = glb.mesh(pane, material);
        glb.node(name, mesh, DVec3::new(x, 1.2, z), degrees, DVec3::ONE);
    }
}
