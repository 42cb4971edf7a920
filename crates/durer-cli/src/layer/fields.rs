//! The choice of features, of their fields and of the fields' names: `--where`, `--select`, `--rename`.

use clap::Args;
use durer_formats::geo::{Feature, Member};
use durer_formats::wording::agreeing;
use serde_json::Value;
use std::cmp::Ordering;
use std::collections::BTreeSet;

/// Options for features and their fields.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Fields")]
pub struct FieldArgs {
    /// Keep features whose field satisfies a condition: FIELD=VALUE; also !=, <, <=, >, >= and ~
    /// (contains, ignoring case)
    ///
    /// If there are several, all must hold. Numbers are compared as numbers, texts by their characters; <, <=, > and >=
    /// compare as numbers if both are. A VALUE in quotes is a text. A missing field is `null`, which only FIELD=null
    /// accepts. `id` is also the id of the feature.
    #[arg(long = "where", value_name = "FIELD=VALUE", value_parser = condition)]
    pub conditions: Vec<Condition>,
    /// Keep these fields only, in this order
    #[arg(long, value_name = "FIELD,…", value_delimiter = ',')]
    pub select: Vec<String>,
    /// Rename a field; --where and --select use the old names
    #[arg(long, value_name = "OLD=NEW", value_parser = rename, value_delimiter = ',')]
    pub rename: Vec<(String, String)>,
    /// Leave out features that cannot be read, with a warning that counts them and exit code 3
    ///
    /// Works for GeoJSON, CSV, WKT with a geometry per line, hexadecimal WKB and Shapefiles. In other formats, and in
    /// text that is not JSON, the end of a broken feature cannot be found.
    #[arg(long)]
    pub skip_failures: bool,
}

impl FieldArgs {
    /// Returns whether there is nothing to do.
    pub fn is_idle(&self) -> bool {
        self.conditions.is_empty() && self.select.is_empty() && self.rename.is_empty()
    }
}

/// Condition on a field.
#[derive(Debug, Clone, PartialEq)]
pub struct Condition {
    field: String,
    test: Test,
    value: String,
    /// True if the value is a text, whatever it looks like.
    is_quoted: bool,
}

/// Comparison of a field with a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Test {
    Equal,
    Other,
    Less,
    AtMost,
    More,
    AtLeast,
    Contains,
}

/// Tests by their signs, longer ones before their prefixes.
const TESTS: [(&str, Test); 9] = [
    ("!=", Test::Other),
    ("<>", Test::Other),
    ("==", Test::Equal),
    ("<=", Test::AtMost),
    (">=", Test::AtLeast),
    ("=", Test::Equal),
    ("<", Test::Less),
    (">", Test::More),
    ("~", Test::Contains),
];

/// Returns a warning for files of which no feature meets the conditions.
pub fn none_meets(read: u64) -> String {
    agreeing(
        read,
        "{feature was read, and does not meet|features were read, and none meets} --where",
    )
}

/// Reads a condition.
pub fn condition(text: &str) -> Result<Condition, String> {
    let signs = TESTS.iter().filter_map(|(sign, test)| Some((text.find(sign)?, *sign, *test)));
    let first = signs.min_by_key(|(at, sign, _)| (*at, std::cmp::Reverse(sign.len())));
    let Some((at, sign, test)) = first.filter(|(at, ..)| *at > 0) else {
        return Err("a condition is FIELD=VALUE, or with !=, <, <=, >, >= or ~".to_owned());
    };
    let (field, given) = (text[..at].trim().to_owned(), text[at + sign.len()..].trim());
    let quoted =
        ['\'', '"'].iter().find_map(|quote| given.strip_prefix(*quote)?.strip_suffix(*quote));
    if quoted.is_none() && joins_conditions(given) {
        return Err("one condition for each --where; all of them must hold".to_owned());
    }
    let (value, is_quoted) = (quoted.unwrap_or(given).to_owned(), quoted.is_some());
    Ok(Condition { field, test, value, is_quoted })
}

/// Returns whether a value is followed by another condition, as in `3 and b=4`.
fn joins_conditions(value: &str) -> bool {
    let words = [" and ", " or ", " && ", " || "];
    let lower = value.to_ascii_lowercase();
    let rest =
        words.iter().filter_map(|word| Some(&value[lower.find(word)? + word.len()..])).next();
    rest.is_some_and(|rest| TESTS.iter().any(|(sign, _)| rest.contains(sign)))
}

fn rename(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((old, new)) if !old.is_empty() && !new.is_empty() => {
            Ok((old.to_owned(), new.to_owned()))
        }
        _ => Err("a new name is given as OLD=NEW".to_owned()),
    }
}

impl Condition {
    /// Returns whether a value passes the test; `None` if there is no such field.
    fn holds(&self, value: Option<&Value>) -> bool {
        let text = match value {
            None | Some(Value::Null) => {
                return self.test == Test::Equal && self.value == "null" && !self.is_quoted;
            }
            Some(Value::String(text)) => text.clone(),
            Some(other) => other.to_string(),
        };
        let orders = matches!(self.test, Test::Less | Test::AtMost | Test::More | Test::AtLeast);
        let as_numbers = || numbers(&text, &self.value).filter(|_| !self.is_quoted);
        let order = match value {
            Some(Value::Number(_)) if !self.is_quoted => as_numbers(),
            Some(Value::String(_)) if orders => {
                as_numbers().or(Some(text.as_str().cmp(&self.value)))
            }
            _ => Some(text.as_str().cmp(&self.value)),
        };
        match (self.test, order) {
            (Test::Contains, _) => text.to_lowercase().contains(&self.value.to_lowercase()),
            (Test::Equal, order) => order.is_some_and(|o| o.is_eq()),
            (Test::Other, order) => order.is_none_or(|o| o.is_ne()),
            (Test::Less, order) => order.is_some_and(|o| o.is_lt()),
            (Test::AtMost, order) => order.is_some_and(|o| o.is_le()),
            (Test::More, order) => order.is_some_and(|o| o.is_gt()),
            (Test::AtLeast, order) => order.is_some_and(|o| o.is_ge()),
        }
    }
}

/// Compares two texts as numbers, whole ones with all their digits; `None` if one is not a number.
fn numbers(own: &str, given: &str) -> Option<Ordering> {
    let [own, given] = [own, given].map(str::trim);
    match (own.parse::<i128>(), given.parse::<i128>()) {
        (Ok(own), Ok(given)) => Some(own.cmp(&given)),
        _ => own.parse::<f64>().ok()?.partial_cmp(&given.parse::<f64>().ok()?),
    }
}

/// Number of fields that a message lists when a name is unknown.
const LISTED: usize = 12;

/// The choices, and which of the fields that they name were found.
#[derive(Debug, Clone, Default)]
pub struct Fields {
    args: FieldArgs,
    /// Names that have not been seen in any feature.
    missing: Vec<String>,
    /// Some of the names that there are.
    known: BTreeSet<String>,
    any: bool,
    /// A name that several fields have after --rename.
    doubled: Option<String>,
}

impl Fields {
    /// Builds the choice from the options.
    pub fn new(args: &FieldArgs) -> Self {
        let conditions = args.conditions.iter().map(|c| &c.field);
        let all = conditions.chain(&args.select).chain(args.rename.iter().map(|(old, _)| old));
        let mut missing: Vec<String> = Vec::new();
        for name in all {
            if !missing.contains(name) {
                missing.push(name.clone());
            }
        }
        Self { args: args.clone(), missing, known: BTreeSet::new(), any: false, doubled: None }
    }

    /// Returns whether a feature is kept, which then has the fields that are requested.
    pub fn apply(&mut self, feature: &mut Feature) -> bool {
        if self.args.is_idle() {
            return true;
        }
        let fields = feature.fields();
        self.note(&fields, feature.id.is_some());
        let value = |name: &str| {
            let own = fields.iter().find(|field| field.key() == name).map(|field| &field.value);
            let id = feature.id.as_ref().filter(|_| name == "id");
            serde_json::from_str::<Value>(own.or(id)?).ok()
        };
        if !self.args.conditions.iter().all(|c| c.holds(value(&c.field).as_ref())) {
            return false;
        }
        if !self.args.select.is_empty() || !self.args.rename.is_empty() {
            let chosen = self.chosen(fields);
            if self.doubled.is_none() && !self.args.rename.is_empty() {
                let is_double =
                    |(i, f): &(usize, &Member)| chosen[..*i].iter().any(|g| g.name == f.name);
                let double = chosen.iter().enumerate().find(is_double);
                self.doubled = double.map(|(_, field)| field.key());
            }
            feature.set_fields(&chosen);
        }
        true
    }

    fn chosen(&self, fields: Vec<Member>) -> Vec<Member> {
        let mut fields = fields;
        if !self.args.select.is_empty() {
            let find = |name: &String| fields.iter().find(|field| field.key() == *name).cloned();
            fields = self.args.select.iter().filter_map(find).collect();
        }
        for field in &mut fields {
            let key = field.key();
            if let Some((_, new)) = self.args.rename.iter().find(|(old, _)| *old == key) {
                *field = Member::new(new, std::mem::take(&mut field.value));
            }
        }
        fields
    }

    fn note(&mut self, fields: &[Member], has_id: bool) {
        self.any = true;
        if self.missing.is_empty() {
            return;
        }
        let keys: Vec<String> = fields.iter().map(Member::key).collect();
        self.missing.retain(|name| !(keys.contains(name) || has_id && name == "id"));
        let room = LISTED.saturating_sub(self.known.len());
        self.known.extend(keys.into_iter().take(room));
    }

    /// Returns a warning at the end: fields that no feature has, and names that several fields have.
    pub fn warning(&self) -> Option<String> {
        let doubled = self.doubled.as_ref().map(|name| {
            format!(
                "after --rename, features have several fields {name}; programs read one of them"
            )
        });
        let all: Vec<String> = self.unknown().into_iter().chain(doubled).collect();
        (!all.is_empty()).then(|| all.join("; "))
    }

    fn unknown(&self) -> Option<String> {
        if self.missing.is_empty() || !self.any {
            return None;
        }
        let known: Vec<&str> = self.known.iter().map(String::as_str).collect();
        let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
        Some(format!("no feature has the field {}; there are {known}", self.missing.join(", ")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn feature(properties: &str) -> Feature {
        Feature { properties: Some(properties.to_owned()), ..Feature::default() }
    }

    #[test]
    fn conditions_compare_numbers_and_texts() {
        let given =
            r#"{"n":10,"t":"Bern","b":true,"e":null,"o":{"x":1},"s":"07","big":9007199254740993}"#;
        for (text, expected) in [
            ("n=10", true),
            ("n=1e1", true),
            ("n>9", true),
            ("n<9", false),
            ("n<=10", true),
            ("n>=10.5", false),
            ("n!=9", true),
            ("n=ten", false),
            ("n!=ten", true),
            ("t = Bern", true),
            ("t=bern", false),
            ("t~ER", true),
            ("t~z", false),
            ("t<C", true),
            ("t!=Basel", true),
            ("b=true", true),
            ("e=null", true),
            ("e!=null", false),
            ("x=null", true),
            ("x!=1", false),
            ("o~x", true),
            ("n==10", true),
            ("n<>10", false),
            ("n='10'", true),
            ("t='Bern'", true),
            ("t=\"Bern\"", true),
            ("e='null'", false),
            ("s=7", false),
            ("s=07", true),
            ("s>6", true),
            ("s<10", true),
            ("s<'10'", true),
            ("s>'1'", false),
            ("t>5", true),
            ("big=9007199254740993", true),
            ("big=9007199254740992", false),
            ("big>9007199254740992", true),
        ] {
            let conditions = vec![condition(text).expect(text)];
            let mut fields = Fields::new(&FieldArgs { conditions, ..FieldArgs::default() });
            assert_eq!(fields.apply(&mut feature(given)), expected, "{text}");
        }
        assert!(condition("=3").is_err() && condition("abc").is_err());
        for several in ["a=3 and b=4", "a>3 AND b<4", "a=1 || b=2"] {
            assert!(condition(several).expect_err(several).contains("each --where"), "{several}");
        }
        assert!(
            condition("a=Bosnia and Herzegovina").is_ok() && condition("a='b and c=d'").is_ok()
        );
        assert_eq!(condition("a<=b").expect("a condition").test, Test::AtMost);
        assert_eq!(condition("a=b<c").expect("a condition").value, "b<c");
    }

    #[test]
    fn fields_are_chosen_ordered_and_renamed() {
        let args = FieldArgs {
            select: ["c", "a", "z"].map(str::to_owned).to_vec(),
            rename: vec![("a".to_owned(), "ä".to_owned())],
            ..FieldArgs::default()
        };
        let mut fields = Fields::new(&args);
        let mut given = feature(r#"{"a":1.50,"b":2,"c":"x"}"#);
        assert!(fields.apply(&mut given));
        assert_eq!(given.properties.as_deref(), Some(r#"{"c":"x","ä":1.50}"#));
        assert_eq!(
            fields.warning().as_deref(),
            Some("no feature has the field z; there are a, b, c")
        );
        let rename = vec![("a".to_owned(), "b".to_owned())];
        let mut fields = Fields::new(&FieldArgs { rename, ..FieldArgs::default() });
        assert!(fields.apply(&mut feature(r#"{"a":1,"b":2}"#)));
        assert!(fields.warning().is_some_and(|warning| warning.contains("several fields b")));
    }
}
