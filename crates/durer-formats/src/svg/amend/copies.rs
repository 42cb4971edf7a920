//! The copies of elements shown by `use` that differ because of custom properties around them.

use super::Walk;
use super::scope::Scope;
use crate::Result;
use crate::svg::write::{self, Changes, attributes};
use std::borrow::Cow;
use usvg::roxmltree::{Node, NodeId};

/// Limit on the elements copied because of custom properties.
const MAX_COPIED: usize = 100_000;

impl<'a, 'i> Walk<'a, 'i> {
    /// Copies the targets of `use` elements if custom properties around these make them look different there.
    pub(super) fn copy_shown(&mut self) -> Result<()> {
        let mut left = MAX_COPIED;
        for (node, scope) in std::mem::take(&mut self.uses) {
            let link = node.attributes().find(|a| a.name() == "href");
            let link = link.and_then(|link| link.value().trim().strip_prefix('#'));
            let Some(shown) = link.and_then(|id| self.ids.get(id)).copied() else { continue };
            let is_alike =
                self.around.get(&shown.id()).is_none_or(|around| *around == scope.variables);
            let is_varied = |node: Node<'_, '_>| self.varied.contains(&node.id());
            if is_alike
                || !shown.descendants().any(is_varied)
                || node.ancestors().any(|above| above == shown)
            {
                continue;
            }
            let count = shown.descendants().count();
            if count > left {
                let what = "custom properties change too many copied elements";
                self.notes.push((node.range().start, what.to_owned()));
                break;
            }
            left -= count;
            let id = self.copy(shown, scope)?;
            let all = self
                .changes
                .attributes
                .entry(node.id())
                .or_insert_with(|| attributes(node).collect());
            all.retain(|(name, _)| name != "href" && name != "xlink:href");
            all.push((Cow::Borrowed("href"), Cow::Owned(format!("#{id}"))));
        }
        Ok(())
    }

    /// Adds a copy of an element, with the effects of a scope, to the definitions; returns its id.
    fn copy(&mut self, shown: Node<'a, 'i>, scope: Scope) -> Result<String> {
        let number = self.changes.definitions.len();
        let id = (number..)
            .map(|n| format!("shown-{n}"))
            .find(|id| !self.ids.contains_key(id.as_str()))
            .unwrap_or_default();
        let own = std::mem::take(&mut self.changes);
        let pending = std::mem::take(&mut self.pending);
        let mut stack: Vec<(NodeId, Scope)> = Vec::new();
        for node in shown.descendants().filter(Node::is_element) {
            let parent = node.parent_element().map(|parent| parent.id());
            while stack.last().is_some_and(|(id, _)| Some(*id) != parent) {
                stack.pop();
            }
            let around = stack.last().map_or(scope, |(_, scope)| *scope);
            stack.push((node.id(), self.element(node, around)?));
            let all = self
                .changes
                .attributes
                .entry(node.id())
                .or_insert_with(|| attributes(node).collect());
            all.retain(|(name, _)| name != "id");
            if node == shown {
                all.push((Cow::Borrowed("id"), Cow::Owned(id.clone())));
            }
        }
        self.changes.definitions = own.definitions;
        for pending in std::mem::replace(&mut self.pending, pending).into_iter().rev() {
            pending.finish(&mut self.changes, &self.ids, &mut self.notes);
        }
        let mut written = write::Written::default();
        let definitions = std::mem::take(&mut self.changes.definitions);
        write::element(shown, &self.changes, &mut written);
        self.changes = Changes { definitions: definitions + &written.text, ..own };
        Ok(id)
    }
}
