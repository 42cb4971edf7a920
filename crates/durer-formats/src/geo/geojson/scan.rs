//! A scanner that finds the ends of JSON values without parsing them.

use crate::geo::MAX_DEPTH;

/// Effect of a byte on the current value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Progress {
    /// The value continues.
    More,
    /// The value ends with this byte.
    Last,
    /// The value, a number or a word, has ended before this byte.
    Over,
    /// Too many brackets are open.
    TooDeep,
}

/// State of a scan of a value, byte by byte.
#[derive(Debug, Clone, Copy, Default)]
pub struct Scan {
    depth: usize,
    in_string: bool,
    escaped: bool,
    in_word: bool,
}

impl Scan {
    /// Takes the next byte, the first one included. Blanks before the value are not parts of it.
    pub fn feed(&mut self, byte: u8) -> Progress {
        if self.in_string {
            return self.feed_string(byte);
        }
        match byte {
            b'"' if !self.in_word => self.in_string = true,
            b'{' | b'[' if !self.in_word => {
                self.depth += 1;
                if self.depth > MAX_DEPTH {
                    return Progress::TooDeep;
                }
            }
            b'}' | b']' if self.depth > 0 => {
                self.depth -= 1;
                return if self.depth == 0 { Progress::Last } else { Progress::More };
            }
            _ if self.depth > 0 => {}
            b' ' | b'\t' | b'\r' | b'\n' | b',' | b':' | b'}' | b']' | b'{' | b'[' | b'"'
            | 0x1e => {
                return Progress::Over;
            }
            _ => self.in_word = true,
        }
        Progress::More
    }

    fn feed_string(&mut self, byte: u8) -> Progress {
        match byte {
            _ if self.escaped => self.escaped = false,
            b'\\' => self.escaped = true,
            b'"' => {
                self.in_string = false;
                return if self.depth == 0 { Progress::Last } else { Progress::More };
            }
            _ => {}
        }
        Progress::More
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn length(text: &str) -> Option<usize> {
        let mut scan = Scan::default();
        text.bytes().enumerate().find_map(|(i, b)| match scan.feed(b) {
            Progress::Last => Some(i + 1),
            Progress::Over => Some(i),
            _ => None,
        })
    }

    #[test]
    fn values_end_where_they_end() {
        for (text, expected) in [
            (r#"{"a":"}\"]"}x"#, Some(12)),
            ("[[1],[2]],", Some(9)),
            (r#""a\\","#, Some(5)),
            ("-1.5e3,", Some(6)),
            ("null\n", Some(4)),
            ("[1", None),
        ] {
            assert_eq!(length(text), expected, "{text}");
        }
        let mut scan = Scan::default();
        assert!((0..200).any(|_| scan.feed(b'[') == Progress::TooDeep));
    }
}
