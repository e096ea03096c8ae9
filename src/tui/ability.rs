//! What the terminal can show, as far as its environment says.

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

/// Returns whether only ASCII can be shown: by the kind of terminal, or because the locale is not
/// one of UTF-8.
pub fn only_ascii(variable: &dyn Fn(&str) -> String) -> bool {
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
