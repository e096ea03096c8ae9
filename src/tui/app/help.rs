//! The open help: what is looked for in it, and how far it is scrolled.

use super::{App, InputMode};
use crate::tui::bindings::Action;
use crate::tui::panels;

/// The open help.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct HelpState {
    /// Only entries with these words are shown.
    pub filter: String,
    /// Lines above the first that is shown.
    pub scroll: u16,
}

impl App {
    /// Scrolls the help, or clears its filter; whether the action did that.
    pub(super) fn scroll_help(&mut self, help: &HelpState, action: Action) -> bool {
        let page = panels::body(self).height.saturating_sub(2).max(1);
        // Further than the end, a key up would do nothing for a while.
        let from = help.scroll.min(panels::help_bottom(self, help));
        let scroll = match action {
            Action::KnobBelow => from.saturating_add(1),
            Action::KnobAbove => from.saturating_sub(1),
            Action::PageForward => from.saturating_add(page),
            Action::PageBack => from.saturating_sub(page),
            Action::Close if !help.filter.is_empty() => {
                self.dialogue.open(InputMode::Help(HelpState::default()));
                return true;
            }
            _ => return false,
        };
        let scroll = scroll.min(panels::help_bottom(self, help));
        self.dialogue.open(InputMode::Help(HelpState { scroll, ..help.clone() }));
        true
    }
}
