//! Text from outside (file names, titles, refused values) made safe to print on one line of a
//! terminal.

use unicode_width::UnicodeWidthChar;

use rubscope_solver::scene::keys::is_plain;

/// A message of more than twice this many characters keeps only this many at each end.
const SHOWN: usize = 800;

/// Makes a message safe to print: replaces control characters, line breaks and direction marks, and
/// shortens a very long text in the middle.
pub fn clean(text: &str) -> String {
    let count = text.chars().count();
    if count <= 2 * SHOWN {
        return text.chars().map(harmless).collect();
    }
    let head = text.chars().take(SHOWN).map(harmless);
    let tail = text.chars().skip(count - SHOWN).map(harmless);
    head.chain(" ... ".chars()).chain(tail).collect()
}

/// Capitalises the first letter of a text if it is an ASCII letter.
pub fn capital(text: &str) -> String {
    let mut text = text.to_string();
    if let Some(first) = text.get_mut(..1) {
        first.make_ascii_uppercase();
    }
    text
}

/// Joins items to a list, `last` before the last one: `1`, `1 and 2`, `1, 2 and 3`.
pub fn listed(items: &[impl ToString], last: &str) -> String {
    let items: Vec<String> = items.iter().map(ToString::to_string).collect();
    match items.split_last() {
        Some((end, start)) if !start.is_empty() => format!("{} {last} {end}", start.join(", ")),
        _ => items.concat(),
    }
}

/// Names up to four blades, or the first three and the count of the others: `blade 6`,
/// `blades 6 and 17`, `blades 1, 3, 5 and 8 more`.
pub fn blades(numbers: &[u32]) -> String {
    let mut numbers = numbers.to_vec();
    numbers.sort_unstable();
    let mut names: Vec<String> = numbers.iter().map(u32::to_string).collect();
    if names.len() > 4 {
        names.truncate(3);
        names.push(format!("{} more", numbers.len() - 3));
    }
    match numbers.len() {
        0 => "some blades".to_string(),
        1 => format!("blade {}", names.concat()),
        _ => format!("blades {}", listed(&names, "and")),
    }
}

/// Replaces a character that is not plain text, such as a control character, by a space.
pub fn harmless(c: char) -> char {
    if is_plain(c) { c } else { ' ' }
}

/// Stands for the space before a per cent sign while a text is wrapped, so that no line breaks
/// there.
const HELD: char = '\u{a0}';

/// Wraps a text to lines of at most `most` columns of the screen. Lines break at spaces, though not
/// before a per cent sign, and inside words longer than a line. An empty text has no lines.
pub fn wrapped(text: &str, most: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    let mut used = 0;
    let text = text.replace(" %", "\u{a0}%");
    for word in text.split(|c: char| c.is_whitespace() && c != HELD).filter(|w| !w.is_empty()) {
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
                line.push(if c == HELD { ' ' } else { c });
            }
            used += columns(c);
        }
    }
    lines
}

/// Returns the number of columns that a character takes on the screen. A letter of no width counts
/// as one, so that a heap of them cannot fill one cell.
fn columns(c: char) -> usize {
    c.width().unwrap_or(1).max(1)
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
    fn a_few_blades_are_named_and_many_are_counted() {
        let told = [&[][..], &[6], &[17, 6], &[1, 3, 5, 7, 9]].map(blades).join(", ");
        assert_eq!(told, "some blades, blade 6, blades 6 and 17, blades 1, 3, 5 and 2 more");
    }

    #[test]
    fn lines_are_no_longer_than_asked() {
        assert_eq!(wrapped("one two  three", 7), ["one two", "three"]);
        assert_eq!(wrapped("a sesquipedalian b", 6), ["a", "sesqui", "pedali", "an b"]);
        assert_eq!(wrapped("a 叶叶叶叶 b", 6), ["a", "叶叶叶", "叶 b"]);
        assert_eq!(wrapped("ab", 0), ["a", "b"]);
        assert_eq!(wrapped("found at 516 (+20.0 %) now", 19), ["found at 516", "(+20.0 %) now"]);
        assert!(wrapped("  ", 7).is_empty());
    }
}
