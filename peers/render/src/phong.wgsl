// Blinn–Phong per pixel in view space; the constants stand before it, from scene.rs.

struct Matrices {
    clip_from_world: mat4x4<f32>,
    view_from_world: mat4x4<f32>,
}

var<immediate> matrices: Matrices;

struct Seen {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
}

@vertex
fn vertex(@location(0) position: vec3<f32>, @location(1) normal: vec3<f32>) -> Seen {
    let world = vec4<f32>(position, 1.0);
    var seen: Seen;
    seen.clip = matrices.clip_from_world * world;
    seen.position = (matrices.view_from_world * world).xyz;
    seen.normal = (matrices.view_from_world * vec4<f32>(normal, 0.0)).xyz;
    return seen;
}

@fragment
fn fragment(
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
) -> @location(0) vec4<f32> {
    let n = normalize(normal);
    let half = normalize(normalize(-position) + LIGHT);
    let diffuse = max(dot(n, LIGHT), 0.0);
    let specular = pow(max(dot(n, half), 0.0), SHININESS);
    return vec4<f32>(AMBIENT + diffuse * DIFFUSE + specular * SPECULAR, 1.0);
}
