//! Formulas from text to operations.

use super::Operation;
use super::function::{Function, function, unknown};
use crate::wording::counted;
use crate::{Error, Result};

/// Deeper nesting of parentheses, signs and powers is refused; parsing recurses so deep.
const DEEPEST: usize = 100;

/// Returns the operations of a formula, in the order of a stack machine.
pub fn parse(text: &str) -> Result<Vec<Operation>> {
    let mut parser = Parser { text, at: 0, level: 0, operations: Vec::new() };
    parser.skip_left_side();
    parser.sum()?;
    parser.blanks();
    match parser.peek() {
        None => Ok(parser.operations),
        Some(')') => Err(parser.error("there is no `(` for this `)`")),
        Some(_) => {
            let message = format!("an operator is needed before `{}`", parser.rest());
            Err(parser.error(message))
        }
    }
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

    /// Returns the rest of the text from this place, short enough for a message.
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

    /// Skips `y =`, `f(x, z) =` or `y(x, z) =`.
    fn skip_left_side(&mut self) {
        let Some((left, _)) = self.text.split_once('=') else { return };
        let left_side: String = left.chars().filter(|c| !c.is_whitespace()).collect();
        if matches!(left_side.as_str(), "y" | "f(x,z)" | "y(x,z)") {
            self.at = left.len() + 1;
        }
    }

    /// Runs `parse` one level deeper, within the limit.
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
            let message = format!("`{name}` is not a function; write `*` to multiply");
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
            let arguments = counted(needed as u64, "argument", "arguments");
            let message = format!("`{name}` takes {arguments}, not {count}");
            return Err(self.error_at(start, message));
        }
        self.operations.extend(operation);
        Ok(())
    }
}
