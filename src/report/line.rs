//! Text from outside (names, titles, refused values) made safe to show in one
//! line of a terminal.

use rubscope_solver::scene::keys::is_plain;

/// Characters of a message that are shown at each end of a very long one.
const SHOWN: usize = 800;

/// Returns a message without what quoted input must not do to a terminal: no control characters, no
/// breaks of lines or of their direction, no endless text.
pub fn clean(text: &str) -> String {
    let count = text.chars().count();
    if count <= 2 * SHOWN {
        return text.chars().map(harmless).collect();
    }
    let head = text.chars().take(SHOWN).map(harmless);
    let tail = text.chars().skip(count - SHOWN).map(harmless);
    head.chain(" ... ".chars()).chain(tail).collect()
}

/// Returns a text with its first letter in upper case.
pub fn capital(text: &str) -> String {
    let mut text = text.to_string();
    if let Some(first) = text.get_mut(..1) {
        first.make_ascii_uppercase();
    }
    text
}

/// Returns a plain character; a space in place of any other.
pub fn harmless(c: char) -> char {
    if is_plain(c) { c } else { ' ' }
}

/// Returns a text in lines of at most so many columns, broken at spaces, and within words that are
/// longer than a line.
pub fn wrapped(text: &str, most: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    let mut used = 0;
    for word in text.split_whitespace() {
        let long: usize = word.chars().map(columns).sum();
        match lines.last_mut() {
            Some(line) if used + 1 + long <= most => {
                line.push(' ');
                used += 1;
            }
            _ => {
                lines.push(String::new());
                used = 0;
            }
        }
        for c in word.chars() {
            if used > 0 && used + columns(c) > most {
                lines.push(String::new());
                used = 0;
            }
            if let Some(line) = lines.last_mut() {
                line.push(c);
            }
            used += columns(c);
        }
    }
    lines
}

/// Returns the columns that a character takes: two in the scripts of East Asia, and of pictures.
fn columns(c: char) -> usize {
    let wide = matches!(
        c,
        '\u{1100}'..='\u{115f}' | '\u{2e80}'..='\u{a4cf}' | '\u{ac00}'..='\u{d7a3}'
            | '\u{f900}'..='\u{faff}' | '\u{fe30}'..='\u{fe6f}' | '\u{ff00}'..='\u{ff60}'
            | '\u{1f300}'..='\u{1faff}' | '\u{20000}'..='\u{3fffd}'
    );
    if wide { 2 } else { 1 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quoted_input_cannot_break_a_line_or_fill_the_screen() {
        let tricky = "a\u{1b}[31m\u{202e}b\u{2028}c\u{2066}d\u{9b}e\u{feff}f";
        assert_eq!(clean(tricky), "a [31m b c d e f");
        // An Arabic mark, a space without width, joiners, tags.
        assert_eq!(clean("a\u{61c}b\u{200b}c\u{2060}d\u{e0041}e\u{ad}f"), "a b c d e f");
        assert_eq!(clean("Ω_lock, 50 µs, e\u{301}, 叶"), "Ω_lock, 50 µs, e\u{301}, 叶");
        let long = clean(&format!("key = {}: allowed is 1", "x".repeat(1 << 20)));
        assert!(long.starts_with("key = xxx") && long.ends_with("xxx: allowed is 1"));
        assert!(long.contains(" ... ") && long.chars().count() < 1700);
    }
    #[test]
    fn lines_are_no_longer_than_asked() {
        assert_eq!(wrapped("one two  three", 7), ["one two", "three"]);
        assert_eq!(wrapped("a sesquipedalian b", 6), ["a", "sesqui", "pedali", "an b"]);
        assert_eq!(wrapped("a 叶叶叶叶 b", 6), ["a", "叶叶叶", "叶 b"]);
        assert_eq!(wrapped("ab", 0), ["a", "b"]);
        assert!(wrapped("  ", 7).is_empty());
    }
}
