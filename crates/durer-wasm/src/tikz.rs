//! Pictures of steps for LaTeX: TikZ in centimetres.

use durer::explain::{Frame, Language, Look, Mark, MarkShape, Picture};
use durer::math::DVec2;

/// Longer side of the drawing in centimetres.
const LONGEST: f64 = 8.0;

/// Returns the picture of a frame as a `tikzpicture`, with the caption as a comment above it.
pub(crate) fn tikz(frame: &Frame, language: Language) -> String {
    let picture = &frame.picture;
    let size = (picture.extent[1] - picture.extent[0]).max_element();
    let scale = if size > 0.0 && size.is_finite() { LONGEST / size } else { 1.0 };
    let mut pen = Pen { picture, scale, language, out: String::new() };
    pen.line(&format!("% {}", frame.text(language).replace(['\r', '\n'], " ")));
    pen.line("% \\usepackage{tikz} \\usetikzlibrary{patterns,arrows.meta}");
    pen.line("\\begin{tikzpicture}[line join=round,every node/.style={font=\\scriptsize}]");
    for look in LOOKS {
        let [r, g, b] = color(look);
        pen.line(&format!("  \\definecolor{{durer-{}}}{{RGB}}{{{r},{g},{b}}}", look.name()));
    }
    // Cells are below everything, then their grid; texts are on top.
    pen.marks(0);
    pen.grid();
    pen.marks(1);
    pen.marks(2);
    pen.line("\\end{tikzpicture}");
    pen.out
}

const LOOKS: [Look; 9] = [
    Look::Pale,
    Look::Thin,
    Look::Grid,
    Look::Window,
    Look::Dashed,
    Look::First,
    Look::Second,
    Look::Result,
    Look::Now,
];

/// Returns the colour of a look, after Okabe and Ito (2008).
const fn color(look: Look) -> [u8; 3] {
    match look {
        Look::Pale => [176, 176, 176],
        Look::Thin | Look::Dashed => [136, 136, 136],
        Look::Grid => [221, 221, 221],
        Look::Window => [0, 0, 0],
        Look::First => [0, 114, 178],
        Look::Second => [213, 94, 0],
        Look::Result => [0, 158, 115],
        Look::Now => [230, 159, 0],
    }
}

/// Returns the options that draw a line of a look.
fn stroke(look: Look) -> String {
    let more = match look {
        Look::Pale => ",semithick",
        Look::Thin | Look::Grid => ",very thin",
        Look::Window => ",thick",
        Look::Dashed => ",thin,dashed",
        Look::First | Look::Second => ",thick",
        Look::Result | Look::Now => ",very thick",
    };
    format!("durer-{}{more}", look.name())
}

/// State of a drawing.
struct Pen<'a> {
    picture: &'a Picture,
    /// Centimetres per unit.
    scale: f64,
    language: Language,
    out: String,
}

impl Pen<'_> {
    fn line(&mut self, text: &str) {
        self.out += text;
        self.out.push('\n');
    }

    /// Returns the place of a point in centimetres.
    fn at(&self, p: DVec2) -> String {
        let [min, max] = self.picture.extent;
        let y = if self.picture.down { max.y - p.y } else { p.y - min.y };
        format!("({:.3},{:.3})", (p.x - min.x) * self.scale, y * self.scale)
    }

    fn path(&self, points: &[DVec2]) -> String {
        points.iter().map(|&p| self.at(p)).collect::<Vec<_>>().join(" -- ")
    }

    fn grid(&mut self) {
        let Some([columns, rows]) = self.picture.grid else { return };
        let (w, h) = (f64::from(columns), f64::from(rows));
        let lines = (0..=columns).map(|x| [(x.into(), 0.0), (x.into(), h)]);
        let lines = lines.chain((0..=rows).map(|y| [(0.0, y.into()), (w, y.into())]));
        let paths: Vec<String> =
            lines.map(|ends| self.path(&ends.map(|(x, y): (f64, f64)| DVec2::new(x, y)))).collect();
        self.line(&format!("  \\draw[{}] {};", stroke(Look::Grid), paths.join(" ")));
    }

    /// Draws the marks of one layer.
    fn marks(&mut self, layer: usize) {
        let picture = self.picture;
        picture
            .marks
            .iter()
            .filter(|mark| layer_of(&mark.shape) == layer)
            .for_each(|m| self.mark(m));
    }

    fn mark(&mut self, Mark { shape, look }: &Mark) {
        let text = match shape {
            MarkShape::Chain(points) if points.len() < 2 => return,
            MarkShape::Chain(points) => format!("\\draw[{}] {};", stroke(*look), self.path(points)),
            MarkShape::Rings(rings) => self.area(rings, *look),
            MarkShape::Dot(p) => {
                format!("\\fill[durer-{}] {} circle (1.5pt);", look.name(), self.at(*p))
            }
            MarkShape::Arrow(ends) => {
                format!("\\draw[{},-{{Stealth}}] {};", stroke(*look), self.path(ends))
            }
            MarkShape::Label { at, by, text } => {
                let text = escaped(&text.text(self.language));
                let (x, y) = (by.x, -by.y);
                format!("\\node[shift={{({x}pt,{y}pt)}}] at {} {{{text}}};", self.at(*at))
            }
            MarkShape::Cell { at, color, text } => {
                self.cell(*at, *color, *look, &text.text(self.language))
            }
        };
        self.line(&format!("  {text}"));
    }

    fn area(&self, rings: &[Vec<DVec2>], look: Look) -> String {
        let path: Vec<String> = rings.iter().map(|ring| self.path(ring) + " -- cycle").collect();
        let name = look.name();
        let fill = match look {
            Look::First => format!("pattern=north east lines,pattern color=durer-{name}!60,"),
            Look::Second => format!("pattern=north west lines,pattern color=durer-{name}!60,"),
            Look::Result => format!("fill=durer-{name}!25,"),
            _ => String::new(),
        };
        format!("\\draw[{fill}even odd rule,{}] {};", stroke(look), path.join(" "))
    }

    fn cell(&self, at: [i32; 2], color: Option<[u8; 3]>, look: Look, text: &str) -> String {
        let low = DVec2::new(at[0].into(), at[1].into());
        let (a, b, middle) = (self.at(low), self.at(low + 1.0), self.at(low + 0.5));
        let fill = match color {
            Some([r, g, b]) => format!("fill={{rgb,255:red,{r};green,{g};blue,{b}}}"),
            None => format!("fill=durer-{}!40", look.name()),
        };
        let text = if text.is_empty() {
            String::new()
        } else {
            format!(" \\node at {middle} {{{}}};", escaped(text))
        };
        format!("\\fill[{fill}] {a} rectangle {b};{text}")
    }
}

/// Returns the layer that a shape is drawn in, counted from the lowest.
const fn layer_of(shape: &MarkShape) -> usize {
    match shape {
        MarkShape::Cell { .. } => 0,
        MarkShape::Label { .. } => 2,
        MarkShape::Chain(_) | MarkShape::Rings(_) | MarkShape::Dot(_) | MarkShape::Arrow(_) => 1,
    }
}

/// Returns text as LaTeX has it.
fn escaped(text: &str) -> String {
    let mut out = String::new();
    for letter in text.chars() {
        match letter {
            '\\' => out.push_str("\\textbackslash{}"),
            '{' | '}' | '$' | '&' | '#' | '%' | '_' => {
                out.push('\\');
                out.push(letter);
            }
            '~' => out.push_str("\\textasciitilde{}"),
            '^' => out.push_str("\\textasciicircum{}"),
            '−' => out.push_str("$-$"),
            '∞' => out.push_str("$\\infty$"),
            _ => out.push(letter),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer::explain::{Input, run};

    #[test]
    fn pictures_become_tikz() {
        for name in ["cohen-sutherland", "bresenham", "weiler-atherton"] {
            let frames = run(name, &Input::Example(String::new()), &Default::default(), 5).unwrap();
            let text = tikz(&frames[3], Language::English);
            assert!(text.starts_with("% ") && text.ends_with("\\end{tikzpicture}\n"), "{text}");
            assert!(
                !text.contains("NaN") && text.matches('{').count() == text.matches('}').count()
            );
        }
        assert_eq!(escaped("50 % of {x}_1 −2"), "50 \\% of \\{x\\}\\_1 $-$2");
    }
}
