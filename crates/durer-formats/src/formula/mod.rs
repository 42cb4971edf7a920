//! Formulas y = f(x, z) in text, evaluated with the same bits on every machine.
//!
//! A few hundred lines of own code, because the available expression crates call the platform's `sin` and `pow`, whose
//! last bits differ, or are no longer maintained. A formula becomes a list of operations on a stack whose depth is
//! known, so nothing recurses or grows while it is evaluated.

mod function;
mod parser;

pub use function::FUNCTIONS;

use crate::{Error, Place, Result};

/// Longer formulas are refused.
const LONGEST: usize = 10_000;

/// A parsed formula in x and z.
///
/// Numbers; `x`, `z`, and `r` for √(x² + z²); `pi`, `tau`, `e`; `+ - * / %` and `^` (or `**`), which binds tightest and
/// to the right, so −x^2 is −(x²); parentheses; the functions that [`FUNCTIONS`] lists, angles in radians. `y =` may
/// come before it. A result that is not a number is a missing point.
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
    /// Largest depth of the stack.
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
        let operations = parser::parse(text)?;
        let depth = depth(&operations);
        Ok(Self { operations, depth })
    }

    /// Returns the value at a point; NaN or infinite if the formula has none.
    pub fn evaluate(&self, x: f64, z: f64) -> f64 {
        let mut stack = Vec::with_capacity(self.depth);
        self.evaluate_on(&mut stack, x, z)
    }

    /// Evaluates like [`Self::evaluate`], with memory that is used again.
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

/// Pops a value; the parser ensures that each operation finds its operands.
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

/// Returns small whole powers by multiplication: quicker, and x^2 is x·x.
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
            ("x(2)", "column 1: `x` is not a function; write `*` to multiply"),
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
