//! The matching of selectors and elements.

use super::selector::{Combinator, Compound, Selector, Simple, Test};
use std::cell::Cell;
use std::collections::HashMap;
use usvg::roxmltree::{Document, Node, NodeId};

/// Limit on the elements examined in all; more would keep a small file busy for ever.
const MAX_STEPS: u64 = 300_000_000;

/// Positions of elements among their siblings, from 1 on: from the start, from the end, and likewise among those of
/// the same type.
type Positions = HashMap<NodeId, [i64; 4]>;

/// Matcher of selectors with elements of a document.
#[derive(Debug, Default)]
pub(super) struct Matcher {
    positions: Positions,
    steps: Cell<u64>,
}

impl Matcher {
    /// Creates a matcher for selectors; counts positions among siblings only if some of them need these.
    pub fn new<'a>(
        document: &Document<'_>,
        mut selectors: impl Iterator<Item = &'a Selector>,
    ) -> Self {
        let positions = if selectors.any(counts) { positions(document) } else { HashMap::new() };
        Self { positions, steps: Cell::new(0) }
    }

    /// Returns whether too much was examined, so that answers are not to be relied on.
    pub fn is_exhausted(&self) -> bool {
        self.steps.get() > MAX_STEPS
    }

    fn step(&self) -> bool {
        self.steps.set(self.steps.get() + 1);
        !self.is_exhausted()
    }

    /// Returns whether an element matches a selector.
    ///
    /// From the last part backwards it keeps the candidate elements; of several nested ones the innermost suffices if
    /// any ancestor may match. Cost: parts times ancestors and siblings.
    pub fn matches(&self, selector: &Selector, node: Node<'_, '_>) -> bool {
        if !self.fits(&selector.last, node) {
            return false;
        }
        let mut meant = vec![node];
        for (combinator, compound) in &selector.before {
            meant = self.step_back(*combinator, compound, &meant);
            if meant.is_empty() {
                return false;
            }
        }
        true
    }

    /// Returns the elements that are `compound` and have one of those in this relation, the
    /// innermost first.
    fn step_back<'a, 'i>(
        &self,
        combinator: Combinator,
        compound: &Compound,
        from: &[Node<'a, 'i>],
    ) -> Vec<Node<'a, 'i>> {
        let mut found: Vec<Node<'a, 'i>> = Vec::new();
        let mut before = None;
        let from =
            if combinator == Combinator::Descendant { &from[..from.len().min(1)] } else { from };
        for node in from {
            let mut add = |other: Node<'a, 'i>| {
                if self.fits(compound, other) && found.last().is_none_or(|last| *last != other) {
                    found.push(other);
                }
            };
            match combinator {
                Combinator::Child => node.parent_element().into_iter().for_each(&mut add),
                Combinator::NextSibling => {
                    node.prev_sibling_element().into_iter().for_each(&mut add)
                }
                Combinator::Descendant => {
                    node.ancestors().skip(1).filter(Node::is_element).for_each(&mut add);
                }
                // An element before an earlier sibling is before this one too.
                Combinator::LaterSibling if before == node.parent() => {}
                Combinator::LaterSibling => {
                    node.prev_siblings().skip(1).filter(Node::is_element).for_each(&mut add);
                }
            }
            before = node.parent();
            if self.is_exhausted() {
                return Vec::new();
            }
        }
        found
    }

    /// Returns whether an element meets all conditions.
    fn fits(&self, compound: &Compound, node: Node<'_, '_>) -> bool {
        self.step() && compound.iter().all(|simple| self.is(simple, node))
    }

    fn is(&self, simple: &Simple, node: Node<'_, '_>) -> bool {
        match simple {
            Simple::Type(name) => node.tag_name().name() == name,
            Simple::Id(id) => node.attribute("id") == Some(id),
            Simple::Class(class) => classes(node).any(|own| own == class),
            Simple::Attribute { name, test, ignore_case } => {
                let mut values = node.attributes().filter(|a| a.name() == name);
                values.any(|a| test.holds(a.value(), *ignore_case))
            }
            Simple::Nth { a, b, from_end, of_type } => {
                let index = usize::from(*from_end) + 2 * usize::from(*of_type);
                let position = self.positions.get(&node.id()).and_then(|all| all.get(index));
                position.is_some_and(|position| is_step(*position, *a, *b))
            }
            Simple::Root => node.parent_element().is_none(),
            Simple::Empty => node.children().all(|c| c.is_comment() || c.is_pi()),
            Simple::Link => {
                node.tag_name().name() == "a" && node.attributes().any(|a| a.name() == "href")
            }
            Simple::Lang(wanted) => is_of_language(node, wanted),
            Simple::Not(selectors) => !selectors.iter().any(|s| self.matches(s, node)),
            Simple::Is(selectors) => selectors.iter().any(|s| self.matches(s, node)),
            Simple::Never => false,
        }
    }
}

/// Returns the classes of an element.
pub(super) fn classes<'a>(node: Node<'a, '_>) -> impl Iterator<Item = &'a str> {
    node.attribute("class").unwrap_or_default().split_ascii_whitespace()
}

/// Returns whether a position is a·n + b for some n from 0 on.
fn is_step(position: i64, a: i64, b: i64) -> bool {
    let over = position.saturating_sub(b);
    if a == 0 {
        over == 0
    } else {
        over.checked_rem(a) == Some(0) && over.signum() * a.signum() >= 0
    }
}

fn is_of_language(node: Node<'_, '_>, wanted: &str) -> bool {
    let mut said = node.ancestors().filter_map(|n| n.attributes().find(|a| a.name() == "lang"));
    said.next().is_some_and(|lang| Test::Dash(wanted.to_owned()).holds(lang.value(), true))
}

impl Test {
    fn holds(&self, value: &str, ignore_case: bool) -> bool {
        if ignore_case {
            let lower = str::to_ascii_lowercase;
            let test = match self {
                Self::Present => Self::Present,
                Self::Equals(wanted) => Self::Equals(lower(wanted)),
                Self::Includes(wanted) => Self::Includes(lower(wanted)),
                Self::Dash(wanted) => Self::Dash(lower(wanted)),
                Self::Starts(wanted) => Self::Starts(lower(wanted)),
                Self::Ends(wanted) => Self::Ends(lower(wanted)),
                Self::Contains(wanted) => Self::Contains(lower(wanted)),
            };
            return test.holds(&lower(value), false);
        }
        let part = |wanted: &str, found: bool| !wanted.is_empty() && found;
        match self {
            Self::Present => true,
            Self::Equals(wanted) => value == wanted,
            Self::Includes(wanted) => value.split_ascii_whitespace().any(|word| word == wanted),
            Self::Dash(wanted) => value
                .strip_prefix(wanted.as_str())
                .is_some_and(|rest| rest.is_empty() || rest.starts_with('-')),
            Self::Starts(wanted) => part(wanted, value.starts_with(wanted.as_str())),
            Self::Ends(wanted) => part(wanted, value.ends_with(wanted.as_str())),
            Self::Contains(wanted) => part(wanted, value.contains(wanted.as_str())),
        }
    }
}

/// Returns whether a selector depends on positions among siblings.
fn counts(selector: &Selector) -> bool {
    let mut parts =
        std::iter::once(&selector.last).chain(selector.before.iter().map(|(_, part)| part));
    parts.any(|part| {
        part.iter().any(|simple| match simple {
            Simple::Nth { .. } => true,
            Simple::Not(inside) | Simple::Is(inside) => inside.iter().any(counts),
            _ => false,
        })
    })
}

fn positions(document: &Document<'_>) -> Positions {
    let mut found = HashMap::new();
    for parent in document.descendants() {
        let children: Vec<_> = parent.children().filter(Node::is_element).collect();
        for from_end in [false, true] {
            let mut of_type: HashMap<&str, i64> = HashMap::new();
            for i in 0..children.len() {
                let at = if from_end { children.len() - 1 - i } else { i };
                let child = children[at];
                let alike = of_type.entry(child.tag_name().name()).or_default();
                *alike += 1;
                let of_child: &mut [i64; 4] = found.entry(child.id()).or_default();
                of_child[usize::from(from_end)] = i as i64 + 1;
                of_child[usize::from(from_end) + 2] = *alike;
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::css::tokens;
    use crate::svg::style::selector;

    /// Returns the ids of all elements that a selector matches.
    fn found(selector: &str) -> String {
        let text = "<svg id='0' xml:lang='de-AT'><g id='1' class='a b'><rect id='2' class='b'/><circle id='3' data-x='One Two'/>
            <rect id='4'/></g><g id='5'><g id='6' class='c'><rect id='7' href='x-y'/></g></g><a href='#' id='8'/></svg>";
        let document = Document::parse(text).unwrap();
        let selectors = selector::list(&tokens(selector)).unwrap_or_else(|| panic!("{selector}"));
        let matcher = Matcher::new(&document, selectors.iter());
        let nodes = document.descendants().filter(Node::is_element);
        let matching = nodes.filter(|node| selectors.iter().any(|s| matcher.matches(s, *node)));
        matching.filter_map(|node| node.attribute("id")).collect()
    }

    #[test]
    fn selectors_match_as_in_browsers() {
        for (selector, expected) in [
            ("*", "012345678"),
            ("rect", "247"),
            (".b", "12"),
            ("g.a.b, #7", "17"),
            ("g rect", "247"),
            ("svg > g > rect", "24"),
            ("g g rect", "7"),
            ("svg > g rect", "247"),
            ("rect + circle", "3"),
            ("rect ~ rect", "4"),
            ("g ~ g .c > rect", "7"),
            ("[data-x~=Two]", "3"),
            ("[data-x~=two i]", "3"),
            ("[href|=x]", "7"),
            ("[href^='x'], [href$='#']", "78"),
            ("[data-x*='e T']", "3"),
            (":root", "0"),
            ("rect:nth-child(3)", "4"),
            ("g > :nth-child(odd)", "2467"),
            ("rect:nth-of-type(2)", "4"),
            (":nth-last-child(-n+2)", "0345678"),
            ("rect:first-child:last-child", "7"),
            (":only-child", "067"),
            ("rect:not(.b):not(g > g > rect)", "4"),
            (":is(circle, .c) + *, :is(g .c)", "46"),
            ("g:hover, rect::before", ""),
            ("rect:empty:lang(de)", "247"),
            (":lang(en)", ""),
            (":link", "8"),
        ] {
            assert_eq!(found(selector), expected, "{selector}");
        }
    }

    #[test]
    fn long_chains_take_no_time() {
        let depth = 500;
        let text = format!("<svg>{}{}</svg>", "<g>".repeat(depth), "</g>".repeat(depth));
        let document = Document::parse(&text).unwrap();
        let selectors = selector::list(&tokens(&format!("x {}", "g ".repeat(60)))).unwrap();
        let matcher = Matcher::new(&document, selectors.iter());
        assert!(!document.descendants().any(|node| matcher.matches(&selectors[0], node)));
        assert!(!matcher.is_exhausted());
    }
}
