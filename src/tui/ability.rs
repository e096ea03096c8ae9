//! What the terminal can show, as far as its environment says.
//!
//! The background of the terminal, dark or light: what the environment says, or
//! what the terminal answers when it is asked (OSC 11).

use std::time::Duration;

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use terminal_colorsaurus::{Error, QueryOptions, background_color};

use crate::tui::raster::Marker;
use crate::tui::terminal;

/// What the terminal can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ability {
    /// Nothing but ASCII.
    pub ascii_only: bool,
    /// Octants, too: drawn by the terminal itself, in any font.
    pub octants: bool,
}

impl Ability {
    /// By the environment.
    pub fn of(variable: &dyn Fn(&str) -> String) -> Self {
        // Windows has none of these variables, and can show everything but octants.
        Self { ascii_only: cfg!(unix) && only_ascii(variable), octants: draws_octants(variable) }
    }

    /// Whether it can show this marker.
    pub fn shows(&self, marker: Marker) -> bool {
        match marker {
            Marker::Ascii => true,
            Marker::Octant => self.octants && !self.ascii_only,
            _ => !self.ascii_only,
        }
    }

    /// The marker if none was chosen.
    pub fn marker(&self) -> Marker {
        if self.ascii_only { Marker::Ascii } else { Marker::Braille }
    }
}

/// Whether the terminal is reached over SSH.
pub fn is_remote(variable: &dyn Fn(&str) -> String) -> bool {
    ["SSH_CONNECTION", "SSH_TTY"].iter().any(|name| !variable(name).is_empty())
}

/// Whether a kind of terminal is a console or an old terminal with little more
/// than text.
pub fn is_plain(term: &str) -> bool {
    let term = term.to_ascii_lowercase();
    let digital = term.strip_prefix("vt").is_some_and(|model| model.starts_with(char::is_numeric));
    digital || term == "linux" || term.starts_with("linux-") || term == "ansi"
}

/// Whether the terminal is one of those known to draw octants. Others show them
/// in few fonts or leave parts of them behind, and so do tmux and screen.
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

/// Whether only ASCII can be shown: by the kind of terminal, or because the
/// locale is not one of UTF-8.
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

/// How long the terminal may take to answer. Less than what a signal that ends
/// the program waits: the settings of the terminal are back by then.
const LIMIT: Duration = Duration::from_millis(250);

/// How long after an unanswered question its answer is not taken for keys.
pub const LATE: Duration = Duration::from_secs(10);

/// The background.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ground {
    /// Light text is readable on it.
    #[default]
    Dark,
    /// Dark text is.
    Light,
}

/// What is known about the background.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Found {
    /// The background.
    pub ground: Ground,
    /// The terminal was asked, and an answer may still come.
    pub unanswered: bool,
    /// It took longer than the limit.
    pub silent: bool,
}

/// The background as `COLORFGBG` has it, such as `15;0`: the last number is the
/// colour of the ground.
fn named(variable: &str) -> Option<Ground> {
    match variable.rsplit(';').next()?.parse::<u8>().ok()? {
        0..=6 | 8 => Some(Ground::Dark),
        7 | 9..=15 => Some(Ground::Light),
        _ => None,
    }
}

/// Finds the background, before the screen is set up and keys are read. A
/// terminal that is known to be silent is not asked.
pub fn find(variable: &dyn Fn(&str) -> String, is_silent: bool) -> Found {
    if let Some(ground) = named(&variable("COLORFGBG")) {
        return Found { ground, ..Found::default() };
    }
    let term = variable("TERM");
    let never = term.is_empty() || term == "dumb" || is_plain(&term);
    if is_silent || never || !terminal::may_be_asked() {
        return Found::default();
    }
    let mut options = QueryOptions::default();
    options.timeout = LIMIT;
    match background_color(options) {
        Ok(colour) if colour.perceived_lightness() > 0.5 => {
            Found { ground: Ground::Light, ..Found::default() }
        }
        Ok(_) => Found::default(),
        // Without a time limit exceeded: keys that came first, or a terminal
        // that knows no such question.
        Err(error) => Found {
            unanswered: true,
            silent: matches!(error, Error::Timeout(_)),
            ..Found::default()
        },
    }
}

/// The beginning of an answer, after Alt and `]`.
const BEGINNING: &str = "11;rgb";

/// An answer that comes too late arrives as keys: Alt-], `11;rgb:1e1e/1e1e/1e1e`
/// and Ctrl-G, or Alt-\. This takes them out.
#[derive(Debug, Default)]
pub struct LateAnswer {
    /// Characters of the answer so far; none outside one.
    inside: Option<usize>,
    /// An Escape came that may be the first half of its end.
    escaped: bool,
}

/// Whether keys that came together are a piece of an answer whose other pieces
/// went elsewhere: three or more, all of them signs of an answer, and one of them
/// a sign that separates.
pub fn is_part_of_answer(keys: &[KeyEvent]) -> bool {
    let belongs = |key: &KeyEvent| match key.code {
        KeyCode::Esc => true,
        KeyCode::Char(letter) if key.modifiers.contains(KeyModifiers::ALT) => {
            "]\\[".contains(letter)
        }
        KeyCode::Char(letter) if key.modifiers.contains(KeyModifiers::CONTROL) => letter == 'g',
        KeyCode::Char(letter) => letter.is_ascii_hexdigit() || "rgb:/;?]\\[".contains(letter),
        _ => false,
    };
    let separates = |key: &KeyEvent| matches!(key.code, KeyCode::Char('/' | ';' | ':'));
    keys.len() >= 3 && keys.iter().all(belongs) && keys.iter().any(separates)
}

impl LateAnswer {
    /// Most characters of an answer.
    const MOST: usize = 40;

    /// Whether a key belongs to an answer, and must not act.
    pub fn takes(&mut self, key: &KeyEvent) -> bool {
        let (KeyCode::Char(letter), Some(count)) = (key.code, self.inside) else {
            return self.takes_edge(key);
        };
        let plain = !key.modifiers.intersects(KeyModifiers::ALT | KeyModifiers::CONTROL);
        let fits = match BEGINNING.chars().nth(count) {
            Some(wanted) => letter == wanted,
            None => letter.is_ascii_hexdigit() || matches!(letter, ':' | '/'),
        };
        if plain && !self.escaped && fits && count < Self::MOST {
            self.inside = Some(count + 1);
            return true;
        }
        let (escaped, modifiers) = (std::mem::take(&mut self.escaped), key.modifiers);
        self.inside = None;
        match letter {
            'g' => modifiers.contains(KeyModifiers::CONTROL),
            '\\' => modifiers.contains(KeyModifiers::ALT) || escaped,
            _ => self.takes_edge(key),
        }
    }

    /// The first key of an answer, and an Escape at its end.
    fn takes_edge(&mut self, key: &KeyEvent) -> bool {
        if key.code == KeyCode::Char(']') && key.modifiers.contains(KeyModifiers::ALT) {
            (self.inside, self.escaped) = (Some(0), false);
            return true;
        }
        self.escaped = key.code == KeyCode::Esc && self.inside.is_some() && !self.escaped;
        if !self.escaped {
            self.inside = None;
        }
        self.escaped
    }
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

    #[test]
    fn the_environment_names_the_ground() {
        for (text, ground) in [
            ("15;0", Some(Ground::Dark)),
            ("0;15", Some(Ground::Light)),
            ("0;default;15", Some(Ground::Light)),
            ("12;8", Some(Ground::Dark)),
            ("0;7", Some(Ground::Light)),
            ("15;default", None),
            ("", None),
            ("0;256", None),
        ] {
            assert_eq!(named(text), ground, "{text}");
        }
    }

    const NONE: KeyModifiers = KeyModifiers::NONE;
    const ALT: KeyModifiers = KeyModifiers::ALT;

    fn typed(text: &str) -> Vec<KeyEvent> {
        text.chars().map(|letter| KeyEvent::new(KeyCode::Char(letter), NONE)).collect()
    }

    fn alt(letter: char) -> Vec<KeyEvent> {
        vec![KeyEvent::new(KeyCode::Char(letter), ALT)]
    }

    fn escape() -> Vec<KeyEvent> {
        vec![KeyEvent::new(KeyCode::Esc, NONE)]
    }

    /// The keys that are left.
    fn left(keys: Vec<KeyEvent>) -> Vec<KeyEvent> {
        let mut answer = LateAnswer::default();
        keys.into_iter().filter(|key| !answer.takes(key)).collect()
    }

    #[test]
    fn a_late_answer_never_acts_as_keys() {
        let bell = vec![KeyEvent::new(KeyCode::Char('g'), KeyModifiers::CONTROL)];
        let halves = [escape(), typed("\\")].concat();
        for end in [bell, alt('\\'), halves] {
            for colour in ["rgb:1e1e/1e1e/1e1e", "rgb:FFFF/FFFF/dddd", "rgb:0/0/0", "rgba:0/0/0/f"]
            {
                let answer = [alt(']'), typed("11;"), typed(colour), end.clone()].concat();
                let keys = [typed("ab"), answer.clone(), typed("q?"), answer, typed("\\")];
                let kept = left(keys.concat());
                assert_eq!(kept, [typed("abq?"), typed("\\")].concat(), "{colour}");
            }
        }
    }

    #[test]
    fn a_piece_of_an_answer_is_none_of_the_users_keys() {
        let bell = vec![KeyEvent::new(KeyCode::Char('g'), KeyModifiers::CONTROL)];
        let whole = [alt(']'), typed("11;rgb:1e1e/1e1e/1e1e"), bell.clone()].concat();
        for from in 0..12 {
            assert!(is_part_of_answer(&whole[from..]), "{from}");
        }
        assert!(is_part_of_answer(&[escape(), typed("]11;rgb:0/0/0"), bell].concat()));
        assert!(is_part_of_answer(&typed("[?62;22c")));
        for keys in ["g", "lll", "hhhh", ":", "430", "ab", ":speed", "5f?"] {
            assert!(!is_part_of_answer(&typed(keys)), "{keys}");
        }
    }

    #[test]
    fn what_only_begins_like_an_answer_acts() {
        assert_eq!(left([alt(']'), typed("q")].concat()), typed("q"));
        assert_eq!(left([alt(']'), typed("11;q")].concat()), typed("q"));
        assert_eq!(left([escape(), typed("]11")].concat()), [escape(), typed("]11")].concat());
        // A second Escape is the user's.
        let keys = [alt(']'), typed("11;rgb:0"), escape(), escape(), typed("\\")].concat();
        assert_eq!(left(keys), [escape(), typed("\\")].concat());
        // An answer without an end takes only so much.
        let endless = [alt(']'), typed("11;rgb:"), typed(&"0".repeat(100))].concat();
        assert!(left(endless).len() > 60);
        assert!(left(alt('\\')).len() == 1);
    }
}
