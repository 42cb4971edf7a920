//! JSON objects as lists of their members, in the order and spelling of the file.

use super::geojson::Text;
use super::{Feature, Member};

impl Member {
    /// Creates a member from a name and a value in JSON.
    pub fn new(key: &str, value: impl Into<String>) -> Self {
        Self { name: quoted(key), value: value.into() }
    }

    /// Returns the name without quotes and escapes.
    pub fn key(&self) -> String {
        serde_json::from_str(&self.name).unwrap_or_else(|_| self.name.clone())
    }

    /// Returns the value if it is a string, without quotes and escapes.
    pub fn text(&self) -> Option<String> {
        serde_json::from_str(&self.value).ok()
    }
}

/// Returns a string in JSON.
pub fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

/// Returns the members of a JSON object, in order; empty for other values. Of several with one name, the last one
/// counts, in the place of the first.
pub fn members(object: &str) -> Vec<Member> {
    let mut list: Vec<Member> = Vec::new();
    let mut places = std::collections::BTreeMap::new();
    for (name, value) in Text::new(object.as_bytes(), (1, 1)).members().unwrap_or_default() {
        let [name, value] =
            [name, value].map(|text| String::from_utf8_lossy(text.as_bytes()).into_owned());
        let place = *places.entry(name.clone()).or_insert(list.len());
        match list.get_mut(place) {
            Some(member) => member.value = value,
            None => list.push(Member { name, value }),
        }
    }
    list
}

/// Returns the JSON object of members.
pub fn object(members: &[Member]) -> String {
    let parts: Vec<String> = members.iter().map(|m| format!("{}:{}", m.name, m.value)).collect();
    format!("{{{}}}", parts.join(","))
}

/// Returns the feature with its id among its fields.
pub(super) fn with_id(feature: &Feature) -> Feature {
    let mut feature = feature.clone();
    let mut fields = feature.fields();
    if let Some(id) = feature.id.take()
        && !fields.iter().any(|field| field.key() == "id")
    {
        fields.insert(0, Member::new("id", id));
        feature.properties = Some(object(&fields));
    }
    feature
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn members_keep_order_and_spelling() {
        let list = members(r#"{ "b" : 1e3, "a\"": {"x": [1, 2]}, "b":2.50 }"#);
        assert_eq!(object(&list), r#"{"b":2.50,"a\"":{"x": [1, 2]}}"#);
        assert_eq!(list[1].key(), "a\"");
        assert_eq!(members("[1]"), []);
        assert_eq!(Member::new("ä\n", "1").name, "\"ä\\n\"");
        assert_eq!(Member::new("a", quoted("x\"")).text().as_deref(), Some("x\""));
    }
}
