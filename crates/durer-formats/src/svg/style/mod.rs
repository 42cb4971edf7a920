//! The values that style sheets and `style` attributes give to the elements of a drawing.
//!
//! Source: *CSS Cascading and Inheritance Level 5*, W3C; *SVG 2*, W3C, § 6.

mod matching;
mod media;
mod properties;
mod selector;
mod sheet;
mod variables;

pub(super) use properties::{IN_STYLE, font, initial, not_drawn, takes};
pub(super) use sheet::shown;

use super::values::Around;
use crate::{Error, Result};
use matching::{Matcher, classes};
use media::Screen;
use selector::{Selector, Simple, Specificity};
use sheet::{Declaration, Rule};
use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;
use usvg::roxmltree::{Document, Node};
use variables::Variables;

/// Limit on the sum of all values given to elements, in bytes: few rules for all elements would fill the
/// memory.
const MAX_APPLIED: usize = 1 << 29;

/// Cost of a declaration for an element, beside its value.
const COST: usize = 64;

/// A warning about a style sheet or attribute, and its place in the document.
pub(super) type Note = (usize, String);

/// The style sheets of a document, and their declarations for elements.
pub(super) struct Styles {
    rules: Vec<Rule>,
    /// Selectors of rules that may match elements, by an id, class or type that the elements must
    /// have.
    by_id: HashMap<String, Vec<(usize, usize)>>,
    by_class: HashMap<String, Vec<(usize, usize)>>,
    by_type: HashMap<String, Vec<(usize, usize)>>,
    by_nothing: Vec<(usize, usize)>,
    matcher: Matcher,
    /// Parsed `style` attributes.
    known: HashMap<String, Rc<Vec<Declaration>>>,
    pub variables: Variables,
    applied: usize,
    pub notes: Vec<Note>,
    /// True if the document has style sheets.
    pub has_sheets: bool,
}

/// The declarations that count for an element, by property. Names of custom properties begin with `--`.
pub(super) type Said = BTreeMap<String, Declared>;

/// A value of a property, and its place in the document if it is from a style sheet.
#[derive(Debug, Clone)]
pub(super) struct Declared {
    pub value: String,
    pub at: Option<usize>,
}

impl Styles {
    /// Creates the style sheets of a document.
    pub fn new(document: &Document<'_>) -> Self {
        let screen = screen(document);
        let (mut rules, mut notes, mut has_sheets) = (Vec::new(), Vec::new(), false);
        for node in document.descendants().filter(|node| node.tag_name().name() == "style") {
            has_sheets = true;
            let is_css = node
                .attribute("type")
                .is_none_or(|kind| kind.trim().is_empty() || kind == "text/css");
            let media = node.attribute("media").unwrap_or_default();
            if !is_css || screen.matches(&crate::css::tokens(media)) == Ok(false) {
                continue;
            }
            for text in node.children().filter(Node::is_text) {
                let content = text.text().unwrap_or_default();
                let start = start_of(document, text, content);
                let sheet = sheet::parse(content, &screen);
                notes.extend(sheet.notes.into_iter().map(|(at, message)| (start + at, message)));
                rules.extend(
                    sheet.rules.into_iter().map(|rule| usable(rule, start, true, &mut notes)),
                );
            }
        }
        let matcher = Matcher::new(document, rules.iter().flat_map(|rule| &rule.selectors));
        let mut styles = Self {
            rules,
            by_id: HashMap::new(),
            by_class: HashMap::new(),
            by_type: HashMap::new(),
            by_nothing: Vec::new(),
            matcher,
            known: HashMap::new(),
            variables: Variables::default(),
            applied: 0,
            notes,
            has_sheets,
        };
        styles.index();
        styles
    }

    /// Sorts selectors by the id, class or type that they require.
    fn index(&mut self) {
        for (i, rule) in self.rules.iter().enumerate() {
            for (j, selector) in rule.selectors.iter().enumerate() {
                let list = match key(selector) {
                    Some(Simple::Id(id)) => self.by_id.entry(id.clone()).or_default(),
                    Some(Simple::Class(class)) => self.by_class.entry(class.clone()).or_default(),
                    Some(Simple::Type(name)) => self.by_type.entry(name.clone()).or_default(),
                    _ => &mut self.by_nothing,
                };
                list.push((i, j));
            }
        }
    }

    /// Returns the rules that match an element, the one that counts most last.
    fn matching(&self, node: Node<'_, '_>) -> Vec<usize> {
        let of_id = node.attribute("id").and_then(|id| self.by_id.get(id));
        let of_classes = classes(node).filter_map(|class| self.by_class.get(class));
        let of_type = self.by_type.get(node.tag_name().name());
        let lists = of_id.into_iter().chain(of_classes).chain(of_type).chain([&self.by_nothing]);
        let mut found: Vec<(Specificity, usize)> = Vec::new();
        for (i, j) in lists.flatten() {
            let selector = self.rules.get(*i).and_then(|rule| rule.selectors.get(*j));
            if let Some(selector) = selector.filter(|selector| self.matcher.matches(selector, node))
            {
                found.push((selector.specificity, *i));
            }
        }
        found.sort_unstable();
        found.into_iter().map(|(_, rule)| rule).collect()
    }

    /// Returns the declarations for an element, of rules and its own `style`.
    ///
    /// # Errors
    /// If there are too many rules and elements.
    pub fn said(&mut self, document: &Document<'_>, node: Node<'_, '_>) -> Result<Said> {
        let own = node.attribute("style").map(|text| self.own(node, text));
        let matching = self.matching(node);
        let mut said = Said::new();
        for is_important in [false, true] {
            let of_rules = matching.iter().filter_map(|rule| self.rules.get(*rule));
            let of_rules = of_rules.flat_map(|rule| &rule.declarations).map(|d| (d, Some(d.at)));
            let own = own.iter().flat_map(|own| own.iter()).map(|d| (d, None));
            for (declaration, at) in of_rules.chain(own) {
                self.applied += COST + declaration.value.len();
                if declaration.is_important == is_important {
                    let declared = Declared { value: declaration.value.clone(), at };
                    said.insert(declaration.name.clone(), declared);
                }
            }
        }
        if self.matcher.is_exhausted() || self.applied > MAX_APPLIED {
            let message =
                "the style rules and the elements are too many to find out which go together";
            let at = document.text_pos_at(node.range().start);
            return Err(Error::line(at.row.into(), at.col.into(), message));
        }
        Ok(said)
    }

    /// Returns the declarations of a `style` attribute.
    fn own(&mut self, node: Node<'_, '_>, text: &str) -> Rc<Vec<Declaration>> {
        if let Some(known) = self.known.get(text) {
            return known.clone();
        }
        let place = node.attribute_node("style").map_or(0, |style| style.range().start);
        let (declarations, notes) = sheet::declarations(text);
        self.notes.extend(notes.into_iter().map(|(_, message)| (place, message)));
        let rule = Rule { selectors: Vec::new(), declarations };
        let mut notes = Vec::new();
        let rule = usable(rule, 0, false, &mut notes);
        let element = format!("of `{}`", node.tag_name().name());
        let notes = notes
            .into_iter()
            .map(|(_, message)| (place, message.replacen("of `style`", &element, 1)));
        self.notes.extend(notes);
        let own = Rc::new(rule.declarations);
        self.known.insert(text.to_owned(), own.clone());
        own
    }
}

/// Returns the part of a selector that an element must have.
fn key(selector: &Selector) -> Option<&Simple> {
    let of = |fits: fn(&Simple) -> bool| selector.last.iter().find(|simple| fits(simple));
    of(|s| matches!(s, Simple::Id(_)))
        .or_else(|| of(|s| matches!(s, Simple::Class(_))))
        .or_else(|| of(|s| matches!(s, Simple::Type(_))))
}

/// Returns a rule with shorthands divided; values that cannot be used are removed, with a warning.
fn usable(rule: Rule, start: usize, is_sheet: bool, notes: &mut Vec<Note>) -> Rule {
    let mut declarations = Vec::new();
    for mut declaration in rule.declarations {
        declaration.at += start;
        match properties::usable(&declaration, is_sheet) {
            Ok(parts) => declarations.extend(parts),
            Err(message) => notes.push((declaration.at, message)),
        }
    }
    Rule { declarations, ..rule }
}

/// Returns the offset in a document at which the content of a text begins.
fn start_of(document: &Document<'_>, text: Node<'_, '_>, content: &str) -> usize {
    let range = text.range();
    let raw = document.input_text().get(range.clone()).unwrap_or_default();
    // Within `CDATA` it is later; with entities it cannot be determined exactly.
    range.start + raw.find(content).unwrap_or_default()
}

/// Returns the screen that a drawing is for: its own size, as far as it says it.
fn screen(document: &Document<'_>) -> Screen {
    let [width, height] = viewport(document.root_element()).unwrap_or([100.0; 2]);
    Screen { width, height }
}

/// Returns the width and height to which percentages within an `svg` element refer, if it gives them.
pub(super) fn viewport(svg: Node<'_, '_>) -> Option<[f64; 2]> {
    let view_box = svg.attribute("viewBox").and_then(|text| text.parse::<svgtypes::ViewBox>().ok());
    if let Some(view_box) = view_box {
        return Some([view_box.w, view_box.h]);
    }
    let side = |name| {
        let units = Around::default().units;
        units.parse(svg.attribute(name)?, None)?.length().filter(|v| *v > 0.0)
    };
    Some([side("width")?, side("height")?])
}
