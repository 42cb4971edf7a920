//! Formulas y = f(x, z) in text, evaluated with the same bits on every machine.
//!
//! Own code of a few hundred lines: the expression crates to be had call the platform's `sin` and
//! `pow`, whose last bits differ, or are no longer kept up. A formula becomes a list of operations on
//! a stack whose depth is known, so nothing recurses or grows while it is evaluated.

use crate::{Error, Place, Result};

/// Longer formulas are refused.
const LONGEST: usize = 10_000;
/// Deeper nesting of parentheses, signs and powers is refused; parsing recurses so deep.
const DEEPEST: usize = 100;

/// A parsed formula in x and z.
///
/// Numbers; `x`, `z`, and `r` for √(x² + z²); `pi`, `tau`, `e`; `+ - * / %` and `^` (or `**`), which binds
/// tightest and to the right, so −x^2 is −(x²); parentheses; the functions that [`FUNCTIONS`] lists,
/// angles in radians. `y =` may stand before it. A result that is no number is a missing point.
///
/// ```
/// use durer_formats::formula::Formula;
/// let formula = Formula::parse("sin(x)^2 + cos(x)^2 - 2*min(z, 3)")?;
/// assert!((formula.evaluate(0.7, 5.0) + 5.0).abs() < 1e-12);
/// let error = Formula::parse("sin(x) + y").unwrap_err();
/// assert_eq!(error.to_string(), "column 10: `y` is what the formula gives; the ground is x and z");
/// # Ok::<(), durer_formats::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Formula {
    operations: Vec<Operation>,
    /// The deepest the stack gets.
    depth: usize,
}

#[derive(Debug, Clone, Copy)]
enum Operation {
    Push(f64),
    X,
    Z,
    R,
    Negate,
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
    Power,
    One(fn(f64) -> f64),
    Two(fn(f64, f64) -> f64),
    Three(fn(f64, f64, f64) -> f64),
}

/// A function by its number of arguments.
#[derive(Debug, Clone, Copy)]
enum Function {
    One(fn(f64) -> f64),
    Two(fn(f64, f64) -> f64),
    /// Two or more, taken together from the left.
    Fold(fn(f64, f64) -> f64),
    Three(fn(f64, f64, f64) -> f64),
}

/// The names of all functions, as messages and the help list them.
pub const FUNCTIONS: &str = "sin cos tan asin acos atan atan2 sinh cosh tanh exp ln log (natural, like ln) \
log2 log10 sqrt cbrt pow hypot abs sign floor ceil round fract mod min max clamp sinc (sin(x)/x) erf j0 j1";

fn function(name: &str) -> Option<Function> {
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

impl Formula {
    /// Parses a formula.
    ///
    /// # Errors
    /// [`Error::Decode`] with the column, counted from 1 in characters; [`Error::Limit`] for a formula
    /// of more than 10,000 bytes or 100 levels.
    pub fn parse(text: &str) -> Result<Self> {
        if text.len() > LONGEST {
            return Err(Error::Limit {
                place: Place::Whole,
                what: "length of a formula",
                value: text.len() as u64,
                limit: LONGEST as u64,
            });
        }
        let mut parser = Parser { text, at: 0, level: 0, operations: Vec::new() };
        parser.skip_left_side();
        parser.sum()?;
        parser.blanks();
        if let Some(c) = parser.peek() {
            return Err(parser.error(match c {
                ')' => "there is no `(` for this `)`".to_owned(),
                _ => format!("an operator is needed before `{}`", parser.rest()),
            }));
        }
        let depth = depth(&parser.operations);
        Ok(Self { operations: parser.operations, depth })
    }

    /// The value at a point; NaN or infinite where the formula has none.
    pub fn evaluate(&self, x: f64, z: f64) -> f64 {
        let mut stack = Vec::with_capacity(self.depth);
        self.evaluate_on(&mut stack, x, z)
    }

    /// As [`Self::evaluate`], with memory that is used again.
    pub fn evaluate_on(&self, stack: &mut Vec<f64>, x: f64, z: f64) -> f64 {
        stack.clear();
        for operation in &self.operations {
            let value = match *operation {
                Operation::Push(value) => value,
                Operation::X => x,
                Operation::Z => z,
                Operation::R => libm::hypot(x, z),
                Operation::Negate => -pop(stack),
                Operation::One(f) => f(pop(stack)),
                Operation::Three(f) => {
                    let (c, b, a) = (pop(stack), pop(stack), pop(stack));
                    f(a, b, c)
                }
                two => {
                    let (b, a) = (pop(stack), pop(stack));
                    binary(two, a, b)
                }
            };
            stack.push(value);
        }
        pop(stack)
    }
}

/// The parser leaves as many values as each operation takes.
fn pop(stack: &mut Vec<f64>) -> f64 {
    stack.pop().unwrap_or(f64::NAN)
}

fn binary(operation: Operation, a: f64, b: f64) -> f64 {
    match operation {
        Operation::Add => a + b,
        Operation::Subtract => a - b,
        Operation::Multiply => a * b,
        Operation::Divide => a / b,
        Operation::Remainder => libm::fmod(a, b),
        Operation::Power => power(a, b),
        Operation::Two(f) => f(a, b),
        _ => f64::NAN,
    }
}

/// Small whole powers by multiplication: quicker, and x^2 is x·x.
fn power(a: f64, b: f64) -> f64 {
    match b {
        2.0 => a * a,
        3.0 => a * a * a,
        4.0 => (a * a) * (a * a),
        _ => libm::pow(a, b),
    }
}

fn depth(operations: &[Operation]) -> usize {
    let (mut now, mut most) = (0usize, 0usize);
    for operation in operations {
        now = match operation {
            Operation::Push(_) | Operation::X | Operation::Z | Operation::R => now + 1,
            Operation::Negate | Operation::One(_) => now,
            Operation::Three(_) => now.saturating_sub(2),
            _ => now.saturating_sub(1),
        };
        most = most.max(now);
    }
    most
}

/// Recursive descent: a sum of products of powers of values.
struct Parser<'a> {
    text: &'a str,
    at: usize,
    level: usize,
    operations: Vec<Operation>,
}

impl<'a> Parser<'a> {
    fn tail(&self) -> &'a str {
        self.text.get(self.at..).unwrap_or_default()
    }

    fn peek(&self) -> Option<char> {
        self.tail().chars().next()
    }

    fn blanks(&mut self) {
        self.at = self.text.len() - self.tail().trim_start().len();
    }

    fn take(&mut self, token: &str) -> bool {
        self.blanks();
        let here = self.tail().starts_with(token);
        self.at += if here { token.len() } else { 0 };
        here
    }

    /// What stands at the place, short enough for a message.
    fn rest(&self) -> String {
        self.tail().chars().take(20).collect()
    }

    fn error(&self, message: impl Into<String>) -> Error {
        self.error_at(self.at, message)
    }

    fn error_at(&self, at: usize, message: impl Into<String>) -> Error {
        let column = self.text.get(..at).map_or(0, |t| t.chars().count()) + 1;
        Error::path(format!("column {column}"), message)
    }

    /// `y =` or `f(x, z) =`.
    fn skip_left_side(&mut self) {
        let Some((left, _)) = self.text.split_once('=') else { return };
        let left_side: String = left.chars().filter(|c| !c.is_whitespace()).collect();
        if matches!(left_side.as_str(), "y" | "f(x,z)" | "y(x,z)") {
            self.at = left.len() + 1;
        }
    }

    /// One level deeper, within the limit.
    fn deeper(&mut self, parse: impl FnOnce(&mut Self) -> Result<()>) -> Result<()> {
        self.level += 1;
        if self.level > DEEPEST {
            return Err(self.error(format!("nested deeper than {DEEPEST} levels")));
        }
        parse(self)?;
        self.level -= 1;
        Ok(())
    }

    fn sum(&mut self) -> Result<()> {
        self.product()?;
        loop {
            let operation = match () {
                () if self.take("+") => Operation::Add,
                () if self.take("-") || self.take("−") => Operation::Subtract,
                () => return Ok(()),
            };
            self.product()?;
            self.operations.push(operation);
        }
    }

    fn product(&mut self) -> Result<()> {
        self.signed()?;
        loop {
            self.blanks();
            let operation = match () {
                () if self.tail().starts_with("**") => return Ok(()),
                () if self.take("*") || self.take("·") || self.take("×") => Operation::Multiply,
                () if self.take("/") => Operation::Divide,
                () if self.take("%") => Operation::Remainder,
                () => return Ok(()),
            };
            self.signed()?;
            self.operations.push(operation);
        }
    }

    fn signed(&mut self) -> Result<()> {
        if self.take("-") || self.take("−") {
            self.deeper(Self::signed)?;
            self.operations.push(Operation::Negate);
            return Ok(());
        }
        if self.take("+") {
            return self.deeper(Self::signed);
        }
        self.value()?;
        if self.take("^") || self.take("**") {
            self.deeper(Self::signed)?;
            self.operations.push(Operation::Power);
        }
        Ok(())
    }

    fn value(&mut self) -> Result<()> {
        self.blanks();
        match self.peek() {
            None => Err(self.error("the formula ends where a value is needed")),
            Some('(') => {
                let open = self.at;
                self.at += 1;
                self.deeper(Self::sum)?;
                self.close(open)
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some('π') => {
                self.at += 'π'.len_utf8();
                self.operations.push(Operation::Push(std::f64::consts::PI));
                Ok(())
            }
            Some(c) if c.is_alphabetic() || c == '_' => self.name(),
            Some(_) => {
                let rest = self.rest();
                Err(self
                    .error(format!("a number, x, z, a function or `(` is needed, not `{rest}`")))
            }
        }
    }

    fn close(&mut self, open: usize) -> Result<()> {
        if self.take(")") {
            return Ok(());
        }
        match self.peek() {
            None => Err(self.error_at(open, "there is no `)` for this `(`")),
            Some(_) => {
                Err(self.error(format!("`)` or an operator is needed, not `{}`", self.rest())))
            }
        }
    }

    fn number(&mut self) -> Result<()> {
        match crate::number::float(self.tail().as_bytes()) {
            Some((value, length)) if value.is_finite() => {
                self.at += length;
                self.operations.push(Operation::Push(value));
                Ok(())
            }
            Some(_) => Err(self.error("the number is too large")),
            None => Err(self.error(format!("`{}` is not a number", self.rest()))),
        }
    }

    fn name(&mut self) -> Result<()> {
        let start = self.at;
        let tail = self.tail();
        let end = tail.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(tail.len());
        let name = &tail[..end];
        self.at += end;
        let plain = match name {
            "x" => Operation::X,
            "z" => Operation::Z,
            "r" => Operation::R,
            "pi" => Operation::Push(std::f64::consts::PI),
            "tau" => Operation::Push(std::f64::consts::TAU),
            "e" => Operation::Push(std::f64::consts::E),
            _ => return self.call(name, start),
        };
        if self.take("(") {
            let message = format!("`{name}` is no function; write `*` to multiply");
            return Err(self.error_at(start, message));
        }
        self.operations.push(plain);
        Ok(())
    }

    fn call(&mut self, name: &str, start: usize) -> Result<()> {
        let Some(function) = function(name) else {
            return Err(self.error_at(start, unknown(name)));
        };
        self.blanks();
        let open = self.at;
        if !self.take("(") {
            return Err(self.error(format!("`{name}` needs its arguments in parentheses")));
        }
        let mut count = 0usize;
        self.deeper(|p| {
            loop {
                p.sum()?;
                count += 1;
                if let (Function::Fold(f), true) = (function, count > 1) {
                    p.operations.push(Operation::Two(f));
                }
                if !p.take(",") {
                    return Ok(());
                }
            }
        })?;
        self.close(open)?;
        let (needed, operation) = match function {
            Function::One(f) => (1, Some(Operation::One(f))),
            Function::Two(f) => (2, Some(Operation::Two(f))),
            Function::Three(f) => (3, Some(Operation::Three(f))),
            Function::Fold(_) => (count.max(2), None),
        };
        if count != needed {
            let message = format!("`{name}` takes {needed} arguments, not {count}");
            return Err(
                self.error_at(start, message.replace("takes 1 arguments", "takes 1 argument"))
            );
        }
        self.operations.extend(operation);
        Ok(())
    }
}

/// What is wrong with a name that is none.
fn unknown(name: &str) -> String {
    match name {
        "y" => "`y` is what the formula gives; the ground is x and z".to_owned(),
        "X" | "Z" => format!("`{name}` is not known; write it small"),
        _ => format!("`{name}` is not known; there are x, z, r, pi, tau, e and {FUNCTIONS}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> f64 {
        Formula::parse(text).unwrap_or_else(|e| panic!("{text}: {e}")).evaluate(3.0, -2.0)
    }

    #[test]
    fn precedence_is_that_of_mathematics() {
        for (text, expected) in [
            ("1 + 2 * 3", 7.0),
            ("8 / 4 / 2", 1.0),
            ("7 - 2 - 1", 4.0),
            ("-x^2", -9.0),
            ("2^3^2", 512.0),
            ("2 ** -1", 0.5),
            ("(1 + 2) * -(x)", -9.0),
            ("- -x", 3.0),
            ("x*z%4", -2.0),
            ("mod(z, 3)", 1.0),
            ("min(4, x, z) + max(4, x)", 2.0),
            ("hypot(2, 3, 6)", 7.0),
            ("clamp(z, -1, 1)", -1.0),
            ("y = r*r", 13.0),
            ("f(x, z) = 1e2 + .5", 100.5),
            ("sign(0) + abs(z) + floor(-0.5) + sinc(0)", 2.0),
            ("ln(e) + log(e) + log10(100) + log2(8)", 7.0),
        ] {
            assert!((value(text) - expected).abs() < 1e-12, "{text}: {}", value(text));
        }
        assert!(value("sqrt(z)").is_nan());
        assert_eq!(value("1 / (x - 3)"), f64::INFINITY);
    }

    #[test]
    fn errors_tell_the_column_and_what_would_be_right() {
        for (text, expected) in [
            ("", "column 1: the formula ends where a value is needed"),
            ("x +", "column 4: the formula ends where a value is needed"),
            ("2x", "column 2: an operator is needed before `x`"),
            ("(x + 1", "column 1: there is no `)` for this `(`"),
            ("x)", "column 2: there is no `(` for this `)`"),
            ("sin x", "column 5: `sin` needs its arguments in parentheses"),
            ("1 + sin(x, z)", "column 5: `sin` takes 1 argument, not 2"),
            ("min(x)", "column 1: `min` takes 2 arguments, not 1"),
            ("x(2)", "column 1: `x` is no function; write `*` to multiply"),
            ("π + ü", "column 5: `ü` is not known"),
            ("x $ z", "column 3: an operator is needed before `$ z`"),
            ("x * $", "column 5: a number, x, z, a function or `(` is needed, not `$`"),
            ("1e999", "column 1: the number is too large"),
        ] {
            let error = Formula::parse(text).expect_err(text).to_string();
            assert!(error.starts_with(expected), "{text}: {error}");
        }
    }

    #[test]
    fn depth_and_length_are_limited() {
        for deep in ["(".repeat(5000), "-".repeat(5000), "2^".repeat(4000), "sin(".repeat(2000)] {
            let error = Formula::parse(&deep).expect_err("deep").to_string();
            assert!(error.contains("deeper than 100"), "{error}");
        }
        assert!(matches!(Formula::parse(&"1+".repeat(6000)), Err(Error::Limit { .. })));
        assert_eq!(value(&format!("{}1", "1+".repeat(4000))), 4001.0);
    }
}
