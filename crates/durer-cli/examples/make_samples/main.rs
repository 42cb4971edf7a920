//! Makes the models in `samples/`: `cargo run -p durer-cli --example make_samples [FOLDER]`.
//!
//! The bytes are the same on every run and every machine.

mod bracket;
mod glass;
mod glb;
mod solids;
mod teapot;
mod teapot_data;
mod wooden_crate;

use std::path::PathBuf;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "samples".to_owned()));
    std::fs::create_dir_all(&folder)?;
    std::fs::write(folder.join("teapot.obj"), teapot::obj())?;
    std::fs::write(folder.join("bracket.stl"), bracket::stl())?;
    std::fs::write(folder.join("crate.glb"), wooden_crate::glb()?)?;
    std::fs::write(folder.join("glass.glb"), glass::glb()?)?;
    Ok(())
}
