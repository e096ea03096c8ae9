//! What the terminal can show, as far as its environment says.

use crate::tui::raster::Marker;

/// Capabilities of the terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ability {
    /// Whether it shows only ASCII.
    pub ascii_only: bool,
    /// Whether it draws octants itself, in any font.
    pub octants: bool,
}

impl Ability {
    /// Reads what the terminal can show from the environment.
    pub fn of(variable: &dyn Fn(&str) -> String) -> Self {
        Self { ascii_only: only_ascii(variable), octants: draws_octants(variable) }
    }

    /// Returns whether it can show this marker.
    pub fn shows(&self, marker: Marker) -> bool {
        match marker {
            Marker::Ascii => true,
            Marker::Octant => self.octants && !self.ascii_only,
            _ => !self.ascii_only,
        }
    }

    /// Returns the marker if none was chosen.
    pub fn marker(&self) -> Marker {
        if self.ascii_only { Marker::Ascii } else { Marker::Braille }
    }
}

/// Returns whether the terminal is reached over SSH.
pub fn is_remote(variable: &dyn Fn(&str) -> String) -> bool {
    ["SSH_CONNECTION", "SSH_TTY"].iter().any(|name| !variable(name).is_empty())
}

/// Returns whether a kind of terminal is a console or an old terminal with little more than text.
pub fn is_plain(term: &str) -> bool {
    let term = term.to_ascii_lowercase();
    let digital = term.strip_prefix("vt").is_some_and(|model| model.starts_with(char::is_numeric));
    digital || term == "linux" || term.starts_with("linux-") || term == "ansi"
}

/// Returns whether the terminal is one of those known to draw octants. Others show them in few
/// fonts or leave parts of them behind, and so do tmux and screen.
fn draws_octants(variable: &dyn Fn(&str) -> String) -> bool {
    let has = |name: &str| !variable(name).is_empty();
    if has("TMUX") || has("STY") {
        return false;
    }
    let (term, program) = (variable("TERM"), variable("TERM_PROGRAM").to_ascii_lowercase());
    let known = ["KITTY_WINDOW_ID", "WEZTERM_PANE", "GHOSTTY_RESOURCES_DIR"].into_iter().any(has);
    let named = ["xterm-kitty", "wezterm", "xterm-ghostty", "foot"].contains(&term.as_str());
    let multiplexed = term.starts_with("tmux") || term.starts_with("screen");
    let by_name =
        named || term.starts_with("foot-") || ["wezterm", "ghostty"].contains(&program.as_str());
    !multiplexed && (known || by_name)
}

/// Returns whether only ASCII can be shown: by the kind of terminal, or because the locale is not
/// one of UTF-8.
fn only_ascii(variable: &dyn Fn(&str) -> String) -> bool {
    if is_plain(&variable("TERM")) {
        return true;
    }
    // The first that is not empty counts; without any, the locale is "C".
    let set = ["LC_ALL", "LC_CTYPE", "LANG"].map(variable);
    let locale = set.into_iter().find(|locale| !locale.is_empty()).unwrap_or_default();
    let named = locale.split('@').next().unwrap_or_default();
    // "en_GB.UTF-8", or on some systems the character set alone.
    let characters = named.rsplit('.').next().unwrap_or_default().to_ascii_lowercase();
    !matches!(characters.as_str(), "utf-8" | "utf8")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn octants_only_where_they_are_known_to_work() {
        let set = |given: &'static [(&'static str, &'static str)]| {
            move |name: &str| {
                let found = given.iter().find(|(known, _)| *known == name);
                found.map(|(_, value)| value.to_string()).unwrap_or_default()
            }
        };
        let yes: [&[(&str, &str)]; 8] = [
            &[("KITTY_WINDOW_ID", "1"), ("TERM", "xterm-kitty")],
            &[("TERM", "xterm-kitty")],
            &[("WEZTERM_PANE", "0"), ("TERM", "xterm-256color")],
            &[("TERM_PROGRAM", "WezTerm")],
            &[("TERM_PROGRAM", "ghostty")],
            &[("TERM", "xterm-ghostty")],
            &[("TERM", "foot")],
            &[("TERM", "foot-direct")],
        ];
        let no: [&[(&str, &str)]; 7] = [
            &[],
            &[("TERM", "xterm-256color")],
            &[("TERM", "footloose")],
            &[("TERM_PROGRAM", "Apple_Terminal")],
            &[("KITTY_WINDOW_ID", "1"), ("TMUX", "/tmp/tmux-0/default,1,0")],
            &[("TERM", "foot"), ("STY", "1.pts-0")],
            &[("KITTY_WINDOW_ID", "1"), ("TERM", "tmux-256color")],
        ];
        for (given, octants) in
            yes.map(|row| (row, true)).into_iter().chain(no.map(|row| (row, false)))
        {
            assert_eq!(draws_octants(&set(given)), octants, "{given:?}");
        }
    }

    #[test]
    fn ascii_by_the_terminal_or_by_the_locale() {
        let utf8 = [
            ("xterm-256color", "", "", "en_GB.UTF-8"),
            ("xterm", "", "", "C.utf8"),
            ("tmux-256color", "", "UTF-8", "C"),
            ("screen", "de_DE.UTF-8@euro", "C", "C"),
            ("vte-256color", "", "", "C.UTF-8"),
            ("", "", "", "C.UTF-8"),
        ];
        let plain = [
            ("linux", "", "", "C.UTF-8"),
            ("linux-16color", "C.UTF-8", "", ""),
            ("vt100", "", "", "C.UTF-8"),
            ("vt220", "", "", "C.UTF-8"),
            ("VT100", "", "", "C.UTF-8"),
            ("xterm", "", "", ""),
            ("xterm", "", "", "C"),
            ("xterm", "", "POSIX", "C.UTF-8"),
            ("xterm", "C", "", "en_GB.UTF-8"),
            ("xterm", "", "", "en_US.ISO-8859-1"),
            ("xterm", "", "", "en_US"),
        ];
        let rows = utf8.map(|row| (row, false)).into_iter().chain(plain.map(|row| (row, true)));
        for ((term, all, ctype, lang), ascii) in rows {
            let variable = |name: &str| {
                let value = match name {
                    "TERM" => term,
                    "LC_ALL" => all,
                    "LC_CTYPE" => ctype,
                    _ => lang,
                };
                value.to_string()
            };
            assert_eq!(only_ascii(&variable), ascii, "{term} {all} {ctype} {lang}");
        }
    }
}
