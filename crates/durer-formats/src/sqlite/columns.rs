//! The columns of a table, from the text that made it.

/// A column of a table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// Its type in capitals, without lengths; empty if it has none.
    pub kind: String,
    /// The value of rows that are older than the column, as a literal.
    pub default: Option<String>,
    /// True if it is the number of the row.
    pub is_number: bool,
    /// True if rows store it: values computed on demand are not stored.
    pub is_stored: bool,
}

/// A word of SQL.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Token {
    /// A word or a number.
    Word(String),
    /// A name in quotes.
    Name(String),
    /// A text.
    Text(String),
    /// Anything else.
    Sign(char),
}

impl Token {
    fn is(&self, word: &str) -> bool {
        matches!(self, Self::Word(own) if own.eq_ignore_ascii_case(word))
    }

    fn name(&self) -> Option<&str> {
        match self {
            Self::Word(text) | Self::Name(text) | Self::Text(text) => Some(text),
            Self::Sign(_) => None,
        }
    }
}

/// Returns the columns of a table with numbered rows, in order; `None` for other statements.
pub fn columns(sql: &str) -> Option<Vec<Column>> {
    let tokens = tokens(sql);
    let start = tokens.iter().position(|t| *t == Token::Sign('('))?;
    let is_table = tokens.get(..start)?.iter().any(|t| t.is("TABLE"));
    let (parts, end) = parts(tokens.get(start + 1..)?)?;
    let after = tokens.get(start + 1 + end..)?;
    if !is_table || after.iter().any(|t| t.is("WITHOUT")) {
        return None;
    }
    let (mut list, mut key) = (Vec::new(), None);
    for part in parts {
        match constraint(part) {
            Some(own) => key = own.or(key),
            None => list.push(column(part)?),
        }
    }
    if let Some(key) = key {
        let is_key = |c: &&mut Column| c.name.eq_ignore_ascii_case(&key) && c.kind == "INTEGER";
        list.iter_mut().filter(is_key).for_each(|c| c.is_number = true);
    }
    Some(list)
}

/// Returns the parts between commas, up to the closing bracket, and the position of that bracket.
fn parts(tokens: &[Token]) -> Option<(Vec<&[Token]>, usize)> {
    let (mut parts, mut from, mut depth) = (Vec::new(), 0, 0_usize);
    for (i, token) in tokens.iter().enumerate() {
        match token {
            Token::Sign('(') => depth += 1,
            Token::Sign(',' | ')') if depth == 0 => {
                parts.push(tokens.get(from..i)?);
                from = i + 1;
                if *token == Token::Sign(')') {
                    return Some((parts, i + 1));
                }
            }
            Token::Sign(')') => depth -= 1,
            _ => {}
        }
    }
    None
}

/// Parses a rule of the table in place of a column: returns the only column of its primary key, if it is
/// one.
fn constraint(part: &[Token]) -> Option<Option<String>> {
    let rules = ["CONSTRAINT", "PRIMARY", "UNIQUE", "CHECK", "FOREIGN"];
    part.first().filter(|first| rules.iter().any(|rule| first.is(rule)))?;
    let at = part.windows(2).position(|two| two[0].is("PRIMARY") && two[1].is("KEY"));
    let key = at.and_then(|at| match part.get(at + 2..)? {
        [Token::Sign('('), name, Token::Sign(')'), ..] => name.name().map(str::to_owned),
        _ => None,
    });
    Some(key)
}

/// Words that end the type of a column.
const ENDS: [&str; 12] = [
    "CONSTRAINT",
    "PRIMARY",
    "NOT",
    "NULL",
    "UNIQUE",
    "CHECK",
    "DEFAULT",
    "COLLATE",
    "REFERENCES",
    "GENERATED",
    "AS",
    "ON",
];

fn column(part: &[Token]) -> Option<Column> {
    let (first, rest) = part.split_first()?;
    let name = first.name()?.to_owned();
    let end = rest.iter().position(|t| ENDS.iter().any(|end| t.is(end))).unwrap_or(rest.len());
    let (kind, rules) = rest.split_at(end);
    let words = kind.iter().map_while(Token::name).map(str::to_ascii_uppercase);
    let kind = words.collect::<Vec<_>>().join(" ");
    let find = |word: &str| rules.iter().position(|t| t.is(word));
    let after = |word: &str, by: usize| rules.get(find(word)? + by..);
    let is_key = after("PRIMARY", 1).is_some_and(|rest| match rest {
        [key, order, ..] => key.is("KEY") && !order.is("DESC"),
        [key] => key.is("KEY"),
        [] => false,
    });
    let is_made = after("AS", 1).is_some_and(|rest| rest.first() == Some(&Token::Sign('(')));
    let is_stored = !is_made || find("STORED").is_some();
    let default = after("DEFAULT", 1).and_then(literal);
    Some(Column { is_number: is_key && kind == "INTEGER", name, kind, default, is_stored })
}

/// Returns a value in JSON; `None` if it is an expression or null.
fn literal(tokens: &[Token]) -> Option<String> {
    let (sign, tokens) = match tokens {
        [Token::Sign('-'), rest @ ..] => ("-", rest),
        [Token::Sign('+'), rest @ ..] => ("", rest),
        all => ("", all),
    };
    match tokens.first()? {
        Token::Text(text) | Token::Name(text) => {
            Some(serde_json::Value::from(&text[..]).to_string())
        }
        Token::Word(word) if word.eq_ignore_ascii_case("true") => Some("1".to_owned()),
        Token::Word(word) if word.eq_ignore_ascii_case("false") => Some("0".to_owned()),
        Token::Word(word) => {
            let text = format!("{sign}{word}");
            serde_json::from_str::<serde_json::Number>(&text).is_ok().then_some(text)
        }
        Token::Sign(_) => None,
    }
}

fn tokens(sql: &str) -> Vec<Token> {
    let (mut tokens, mut rest) = (Vec::new(), sql);
    while let Some(first) = rest.chars().next() {
        let (token, after) = match first {
            _ if rest.starts_with("--") => (None, rest.find('\n').map_or("", |end| &rest[end..])),
            _ if rest.starts_with("/*") => {
                (None, rest.find("*/").map_or("", |end| &rest[end + 2..]))
            }
            '\'' => quoted(rest, '\'').map_token(Token::Text),
            '"' | '`' => quoted(rest, first).map_token(Token::Name),
            '[' => quoted(rest, ']').map_token(Token::Name),
            c if is_letter(c) => {
                let end = rest.find(|c| !is_letter(c)).unwrap_or(rest.len());
                (Some(Token::Word(rest[..end].to_owned())), &rest[end..])
            }
            c => (Some(Token::Sign(c)).filter(|_| !c.is_whitespace()), &rest[c.len_utf8()..]),
        };
        tokens.extend(token);
        rest = after;
    }
    tokens
}

fn is_letter(c: char) -> bool {
    c.is_alphanumeric() || matches!(c, '_' | '$' | '.') || !c.is_ascii() && !c.is_whitespace()
}

/// A text in quotes, and the rest after it.
struct Quoted<'a>(String, &'a str);

impl<'a> Quoted<'a> {
    fn map_token(self, token: fn(String) -> Token) -> (Option<Token>, &'a str) {
        (Some(token(self.0)), self.1)
    }
}

/// Reads a text up to its end; a doubled ending character stands for one.
fn quoted(text: &str, end: char) -> Quoted<'_> {
    let (mut own, mut rest) = (String::new(), text.get(1..).unwrap_or_default());
    while let Some(at) = rest.find(end) {
        own.push_str(&rest[..at]);
        rest = &rest[at + 1..];
        if !(rest.starts_with(end) && end != ']') {
            return Quoted(own, rest);
        }
        own.push(end);
        rest = &rest[1..];
    }
    Quoted(own, "")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_found_with_types_and_keys() {
        let sql = r#"CREATE TABLE "a(b" ( -- (
            fid INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, "my ""geom""" POINT,
            [x y] MEDIUMINT DEFAULT -5, `t` TEXT(20) NOT NULL DEFAULT 'it''s, (so)', n, d DATETIME DEFAULT (now()),
            /* , */ v REAL GENERATED ALWAYS AS (n * 2), w DOUBLE PRECISION AS (n) STORED, FOREIGN KEY (n) REFERENCES o(p))"#;
        let list = columns(sql).expect("a table");
        let parts_read: Vec<(&str, &str, Option<&str>)> =
            list.iter().map(|c| (&c.name[..], &c.kind[..], c.default.as_deref())).collect();
        assert_eq!(
            parts_read,
            [
                ("fid", "INTEGER", None),
                ("my \"geom\"", "POINT", None),
                ("x y", "MEDIUMINT", Some("-5")),
                ("t", "TEXT", Some("\"it's, (so)\"")),
                ("n", "", None),
                ("d", "DATETIME", None),
                ("v", "REAL", None),
                ("w", "DOUBLE PRECISION", None)
            ]
        );
        let marks: Vec<(bool, bool)> = list.iter().map(|c| (c.is_number, c.is_stored)).collect();
        assert_eq!((marks[0], marks[6], marks[7]), ((true, true), (false, false), (false, true)));
        let list = columns("create table t(a integer, b, constraint k primary key (A))");
        assert!(list.expect("a table")[0].is_number);
        for other in [
            "CREATE TABLE t(a INT PRIMARY KEY) WITHOUT ROWID",
            "CREATE VIEW v AS SELECT (1)",
            "CREATE TABLE t(a",
            "",
            "(",
            "CREATE TABLE t(a,,b)",
        ] {
            assert_eq!(columns(other), None, "{other}");
        }
    }
}
