//! The options of machines with pens, for all commands that write drawings.

use crate::failure::Failure;
use crate::values;
use clap::Args;
use durer_formats::drawing::{DrawingFormat, MachineOptions};

/// The order of strokes, and how machines draw.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Machines with pens")]
pub struct MachineArgs {
    /// Order strokes so that the pen moves little between them [always on for .hpgl and .gcode]
    ///
    /// Strokes may be reversed, closed ones may start at any point, and strokes that meet are joined. Each layer is
    /// ordered separately; in .hpgl and .gcode, each pen.
    #[arg(long)]
    pub pen_order: bool,
    /// Number of pens in the plotter, for .hpgl and .gcode [default: one for each width and colour]
    ///
    /// With fewer pens than the drawing has, strokes go to the most similar pen; with 1 the pen is never changed.
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = values::count)]
    pub pens: Option<u64>,
    /// Speed of the pen while it draws, in millimetres per minute, for .gcode [default: 1500]
    #[arg(long, value_name = "MM/MIN", allow_hyphen_values = true, value_parser = values::positive)]
    pub feed: Option<f64>,
    /// Speed of the raised pen, in millimetres per minute, for .gcode [default: as fast as the machine
    /// moves]
    ///
    /// Such moves are then G1 with this speed, because GRBL takes no speed for G0.
    #[arg(long, value_name = "MM/MIN", allow_hyphen_values = true, value_parser = values::positive)]
    pub travel: Option<f64>,
    /// Write arcs to .gcode as chords, for machines without G2 and G3
    #[arg(long)]
    pub gcode_lines: bool,
    /// The G-code that puts the pen down; \n begins a line [default: 'M3 S1000\nG4 P0.2']
    ///
    /// The default is for a servo on the spindle's output of GRBL, with 0.2 seconds to turn. Machines that
    /// lift the pen along Z take e.g. --pen-down 'G1 Z0 F600' --pen-up 'G0 Z5'; lasers need less power than S1000.
    #[arg(long, value_name = "CODE", value_parser = lines)]
    pub pen_down: Option<String>,
    /// The G-code that lifts the pen [default: 'M5\nG4 P0.2']
    #[arg(long, value_name = "CODE", value_parser = lines)]
    pub pen_up: Option<String>,
}

fn lines(text: &str) -> Result<String, String> {
    let lines = text.replace("\\n", "\n");
    let machine = MachineOptions { pen_down: lines.clone(), ..MachineOptions::default() };
    let plain = "it must be printable ASCII without ! ? ~, which stop and start machines";
    machine.check().map(|()| lines).map_err(|_| plain.to_owned())
}

impl MachineArgs {
    /// Returns the options in the form that writers take.
    pub fn options(&self) -> MachineOptions {
        let default = MachineOptions::default();
        MachineOptions {
            pens: self.pens.map(|n| usize::try_from(n).unwrap_or(usize::MAX)),
            feed: self.feed.unwrap_or(default.feed),
            travel: self.travel,
            arcs: !self.gcode_lines,
            pen_down: self.pen_down.clone().unwrap_or(default.pen_down),
            pen_up: self.pen_up.clone().unwrap_or(default.pen_up),
        }
    }

    /// Refuses options that have no meaning in a format; `None` stands for pixels.
    pub fn check(&self, format: Option<DrawingFormat>) -> Result<(), Failure> {
        let wrong = |message: String| Err(Failure::Usage(message));
        let of_gcode = [
            ("feed", self.feed.is_some()),
            ("travel", self.travel.is_some()),
            ("gcode-lines", self.gcode_lines),
            ("pen-down", self.pen_down.is_some()),
            ("pen-up", self.pen_up.is_some()),
        ];
        match of_gcode.iter().find(|(_, given)| *given) {
            Some((name, _)) if format != Some(DrawingFormat::Gcode) => {
                return wrong(format!("--{name}: it is for G-code; write a .gcode, .nc or .ngc"));
            }
            _ => {}
        }
        if self.pens.is_some() && !format.is_some_and(DrawingFormat::is_for_pens) {
            return wrong("--pens: it is for plotters; write a .hpgl or .gcode".to_owned());
        }
        if self.pen_order && format == Some(DrawingFormat::GeoJson) {
            return wrong("--pen-order: GeoJSON has no pens; leave it out".to_owned());
        }
        Ok(())
    }

    /// Returns whether strokes are to be ordered before they are written.
    pub fn orders(&self, format: Option<DrawingFormat>) -> bool {
        self.pen_order && !format.is_some_and(DrawingFormat::is_for_pens)
    }
}
