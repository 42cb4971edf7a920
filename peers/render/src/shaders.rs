//! The shaders of `phong.wgsl` as SPIR-V.

use crate::{Result, scene};
use naga::ShaderStage;
use naga::back::spv;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};

/// Returns the words of the vertex shader, whose entry point is `vertex`, and of the fragment shader,
/// `fragment`.
pub fn phong() -> Result<[Vec<u32>; 2]> {
    let source = constants() + include_str!("phong.wgsl");
    let module = naga::front::wgsl::parse_str(&source).map_err(|e| e.emit_to_string(&source))?;
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::IMMEDIATES);
    let info = validator.validate(&module)?;
    Ok([
        words(&module, &info, ShaderStage::Vertex, "vertex")?,
        words(&module, &info, ShaderStage::Fragment, "fragment")?,
    ])
}

/// Returns the scene's constants in WGSL.
fn constants() -> String {
    let vector = |[x, y, z]: [f64; 3]| format!("vec3<f32>({x:?}, {y:?}, {z:?})");
    let color = |[r, g, b]: [f32; 3]| format!("vec3<f32>({r:?}, {g:?}, {b:?})");
    format!(
        "const LIGHT = {}; const AMBIENT = {}; const DIFFUSE = {}; const SPECULAR = {:?}f; \
         const SHININESS = {:?}f;\n",
        vector(scene::LIGHT),
        color(scene::AMBIENT),
        color(scene::DIFFUSE),
        scene::SPECULAR,
        scene::SHININESS,
    )
}

fn words(
    module: &naga::Module,
    info: &ModuleInfo,
    shader_stage: ShaderStage,
    name: &str,
) -> Result<Vec<u32>> {
    // Nothing is done to coordinates: the viewport turns y, the matrices are Vulkan's.
    let options = spv::Options { flags: spv::WriterFlags::empty(), ..Default::default() };
    let entry = spv::PipelineOptions { shader_stage, entry_point: name.to_owned() };
    Ok(spv::write_vec(module, info, &options, Some(&entry))?)
}
