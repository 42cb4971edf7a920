//! Warnings about options of the command line that have no effect together with others.

use crate::messages::Messages;

/// A reason, and the options that have no effect for it.
pub type Rule = (&'static str, &'static [&'static str]);

/// Warns of given options that have no effect by one of the rules.
pub fn warn(given: &[String], rules: impl IntoIterator<Item = Rule>, messages: &Messages) {
    for (reason, idle) in rules {
        for id in given.iter().filter(|id| idle.contains(&&***id)) {
            let option = id.replace('_', "-");
            messages.warning(&format!("--{option}"), format!("it has no effect: {reason}"));
        }
    }
}
