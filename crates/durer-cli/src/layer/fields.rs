//! The choice of features, of their fields and of the fields' names: `--where`, `--select`, `--rename`.

use clap::Args;
use durer_formats::geo::{Feature, Member};
use serde_json::Value;
use std::collections::BTreeSet;

/// Options for features and their fields.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Fields")]
pub struct FieldArgs {
    /// Keep features whose field satisfies a condition: FIELD=VALUE; also !=, <, <=, >, >= and ~
    /// (contains, ignoring case)
    ///
    /// If there are several, all must hold. Numbers are compared as numbers, texts by their characters. A missing
    /// field is `null`, which only FIELD=null accepts. `id` is also the id of the feature.
    #[arg(long = "where", value_name = "FIELD=VALUE", value_parser = condition)]
    pub conditions: Vec<Condition>,
    /// Keep these fields only, in this order
    #[arg(long, value_name = "FIELD,…", value_delimiter = ',')]
    pub select: Vec<String>,
    /// Rename a field; --where and --select use the old names
    #[arg(long, value_name = "OLD=NEW", value_parser = rename, value_delimiter = ',')]
    pub rename: Vec<(String, String)>,
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
const TESTS: [(&str, Test); 7] = [
    ("!=", Test::Other),
    ("<=", Test::AtMost),
    (">=", Test::AtLeast),
    ("=", Test::Equal),
    ("<", Test::Less),
    (">", Test::More),
    ("~", Test::Contains),
];

fn condition(text: &str) -> Result<Condition, String> {
    let signs = TESTS.iter().filter_map(|(sign, test)| Some((text.find(sign)?, *sign, *test)));
    let first = signs.min_by_key(|(at, sign, _)| (*at, std::cmp::Reverse(sign.len())));
    let Some((at, sign, test)) = first.filter(|(at, ..)| *at > 0) else {
        return Err("a condition is FIELD=VALUE, or with !=, <, <=, >, >= or ~".to_owned());
    };
    let (field, value) = (text[..at].trim().to_owned(), text[at + sign.len()..].trim().to_owned());
    Ok(Condition { field, test, value })
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
            None | Some(Value::Null) => return self.test == Test::Equal && self.value == "null",
            Some(Value::String(text)) => text.clone(),
            Some(other) => other.to_string(),
        };
        let order = match value {
            Some(Value::Number(number)) => {
                let given = self.value.parse::<f64>().ok();
                number.as_f64().zip(given).and_then(|(own, given)| own.partial_cmp(&given))
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
        Self { args: args.clone(), missing, known: BTreeSet::new(), any: false }
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

    /// Returns a warning at the end: fields that no feature has.
    pub fn told(&self) -> Option<String> {
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
        let given = r#"{"n":10,"t":"Bern","b":true,"e":null,"o":{"x":1}}"#;
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
            ("o~\"x\"", true),
        ] {
            let conditions = vec![condition(text).expect(text)];
            let mut fields = Fields::new(&FieldArgs { conditions, ..FieldArgs::default() });
            assert_eq!(fields.apply(&mut feature(given)), expected, "{text}");
        }
        assert!(condition("=3").is_err() && condition("abc").is_err());
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
        assert_eq!(fields.told().as_deref(), Some("no feature has the field z; there are a, b, c"));
    }
}
