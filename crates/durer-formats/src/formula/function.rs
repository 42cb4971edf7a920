//! The functions of formulas.

/// A function by its number of arguments.
#[derive(Debug, Clone, Copy)]
pub enum Function {
    One(fn(f64) -> f64),
    Two(fn(f64, f64) -> f64),
    /// Two or more, combined from the left.
    Fold(fn(f64, f64) -> f64),
    Three(fn(f64, f64, f64) -> f64),
}

/// The names of all functions, as messages and the help list them.
pub const FUNCTIONS: &str = "sin cos tan asin acos atan atan2 sinh cosh tanh exp ln log (natural, like ln) \
log2 log10 sqrt cbrt pow hypot abs sign floor ceil round fract mod min max clamp sinc (sin(x)/x) erf j0 j1";

/// Returns the function of a name, if it has one.
pub fn function(name: &str) -> Option<Function> {
    use Function::{Fold, One, Three, Two};
    Some(match name {
        "sin" => One(libm::sin),
        "cos" => One(libm::cos),
        "tan" => One(libm::tan),
        "asin" => One(libm::asin),
        "acos" => One(libm::acos),
        "atan" => One(libm::atan),
        "atan2" => Two(libm::atan2),
        "sinh" => One(libm::sinh),
        "cosh" => One(libm::cosh),
        "tanh" => One(libm::tanh),
        "exp" => One(libm::exp),
        "ln" | "log" => One(libm::log),
        "log2" => One(libm::log2),
        "log10" => One(libm::log10),
        "sqrt" => One(libm::sqrt),
        "cbrt" => One(libm::cbrt),
        "pow" => Two(libm::pow),
        "hypot" => Fold(libm::hypot),
        "abs" => One(f64::abs),
        "sign" => One(|v| if v == 0.0 { 0.0 } else { v.signum() }),
        "floor" => One(libm::floor),
        "ceil" => One(libm::ceil),
        "round" => One(libm::round),
        "fract" => One(|v| v - libm::floor(v)),
        "mod" => Two(|a, b| a - b * libm::floor(a / b)),
        "min" => Fold(f64::min),
        "max" => Fold(f64::max),
        "clamp" => Three(|v, low, high| v.max(low).min(high)),
        "sinc" => One(|v| if v == 0.0 { 1.0 } else { libm::sin(v) / v }),
        "erf" => One(libm::erf),
        "j0" => One(libm::j0),
        "j1" => One(libm::j1),
        _ => return None,
    })
}

/// Returns the message for an unknown name.
pub fn unknown(name: &str) -> String {
    match name {
        "y" => "`y` is what the formula gives; the ground is x and z".to_owned(),
        "X" | "Z" => format!("`{name}` is not known; write it small"),
        _ => format!("`{name}` is not known; there are x, z, r, pi, tau, e and {FUNCTIONS}"),
    }
}
