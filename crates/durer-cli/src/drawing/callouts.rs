//! `--callouts`: numbers of parts around a view, and the list of parts.

use super::{Shown, Subject};
use crate::failure::Failure;
use durer::paper::{Callout, PartsListRow, ViewKind};
use durer::pipeline;
use durer::view::projection::NamedView;
use durer_formats::wording::agreeing;

/// Number of hidden parts that a message lists.
const NAMED: usize = 5;

/// Numbers and names of parts.
#[derive(Debug, Default)]
pub struct Callouts {
    /// Callouts at the isometric view, or at the first view.
    pub callouts: Vec<Callout>,
    /// The list.
    pub parts: Vec<PartsListRow>,
}

impl Callouts {
    /// Numbers a model's parts and finds their places in the views, whose aspect ratio is `aspect`. Notes the parts
    /// that are not visible.
    pub fn find(
        subject: &Subject,
        shown: &[Shown],
        aspect: f64,
        notes: &mut Vec<String>,
    ) -> Result<Self, Failure> {
        let is_iso = |s: &Shown| s.kind == Some(ViewKind::Principal(NamedView::Iso));
        let view = shown.iter().position(is_iso).unwrap_or(0);
        let Some(seen) = shown.get(view) else { return Ok(Self::default()) };
        let components = &subject.components;
        if components.is_empty() {
            notes.push("--callouts: the model has no parts to number".to_owned());
        }
        let places = pipeline::seen_at(subject.scene, components, seen.camera, aspect)
            .map_err(super::usage)?;
        let mut found = Self::default();
        let mut unseen = Vec::new();
        for (i, (component, at)) in components.iter().zip(places).enumerate() {
            let (number, name) = ((i + 1).to_string(), component.name.clone());
            match at {
                Some(at) => {
                    let at = seen.breaks.drawn_at(at);
                    found.callouts.push(Callout { view, number: number.clone(), at });
                }
                None => unseen.push(format!("{number} ({name})")),
            }
            let quantity = component.count;
            found.parts.push(PartsListRow { number, name, quantity });
        }
        if !unseen.is_empty() {
            let words = "{part is in the list only, as the view does not show it|parts are in the list only, as the view does not show them}";
            let parts = agreeing(unseen.len() as u64, words);
            let more = if unseen.len() > NAMED { ", …" } else { "" };
            unseen.truncate(NAMED);
            notes.push(format!("--callouts: {parts}: {}{more}", unseen.join(", ")));
        }
        Ok(found)
    }
}
