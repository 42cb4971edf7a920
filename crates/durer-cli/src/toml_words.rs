//! Faults of TOML in durer's words, because the parser's messages describe its internals.

/// Describes a fault of TOML, without its place.
pub fn fault(message: &str) -> &'static str {
    let any = |words: &[&str]| words.iter().any(|word| message.contains(word));
    if any(&["duplicate key"]) {
        "a key appears twice"
    } else if any(&["recurs"]) {
        "arrays and tables are nested too deep"
    } else if any(&["must be quoted"]) {
        "a text must be in quotes, as in \"text\""
    } else if any(&["escape", "unicode"]) {
        "after `\\` no known letter follows; `\\` itself is written `\\\\`"
    } else if any(&["unclosed", "quote", "basic string", "literal string", "opening", "open"]) {
        "a bracket or a quote is missing"
    } else if any(&["comma", "in array"]) {
        "one comma is needed between values"
    } else if any(&["radix", "digit", "zero", "sign", "integer", "float", "date", "time"]) {
        "this is not a number"
    } else if any(&["assignment", "value", "extra `=`", "key"]) {
        "`key = value` is needed"
    } else {
        "`key = value`, `[table]` or a comment after `#` is expected here"
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toml::de::DeTable;

    #[test]
    fn faults_are_reported_plainly() {
        for (text, expected) in [
            ("a = 1\na = 2", "a key appears twice"),
            ("a = [1, 2", "a bracket or a quote is missing"),
            ("a = \"b", "a bracket or a quote is missing"),
            ("[a", "a bracket or a quote is missing"),
            ("a = b", "a text must be in quotes"),
            ("a", "`key = value` is needed"),
            ("a = \"\\q\"", "after `\\` no known letter follows"),
        ] {
            let error = DeTable::parse(text).unwrap_err();
            let shown = fault(error.message());
            assert!(shown.starts_with(expected), "{text}: {shown} ({})", error.message());
        }
        let deep = format!("a = {}", "[".repeat(10_000));
        let shown = DeTable::parse(&deep).map(|_| ()).map_err(|e| fault(e.message()));
        assert_eq!(shown, Err("arrays and tables are nested too deep"));
    }
}
