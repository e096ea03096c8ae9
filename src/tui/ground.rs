//! The background of the terminal, dark or light: what the environment says, or what the terminal
//! reports on request (OSC 11). Nothing waits for the report, which arrives among the keys.

/// The background of the terminal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ground {
    /// Dark: light text is readable on it.
    #[default]
    Dark,
    /// Light: dark text is readable on it.
    Light,
}

/// Escape sequence that asks the terminal for the colour of its background.
pub const QUESTION: &[u8] = b"\x1b]11;?\x07";

/// Relative luminance (0 black, 1 white) above which a background counts as light: that of the grey
/// which looks half-way between black and white.
const MIDDLE: f64 = 0.184;

impl Ground {
    /// Returns the background that a value of `COLORFGBG` names, such as `15;0`: its last number is
    /// the colour. `None` unless that is 0 to 15.
    pub fn named(variable: &str) -> Option<Self> {
        match variable.rsplit(';').next()?.parse::<u8>().ok()? {
            0..=6 | 8 => Some(Self::Dark),
            7 | 9..=15 => Some(Self::Light),
            _ => None,
        }
    }

    /// Parses the colour of a report, such as `rgb:ffff/ffff/ffff`; `None` if it has another form.
    pub fn reported(colour: &[u8]) -> Option<Self> {
        let text = std::str::from_utf8(colour.strip_prefix(b"rgb")?).ok()?;
        let (_, colours) = text.split_once(':')?;
        let mut parts = colours.split('/').map(|digits| {
            let most = 16_f64.powi(i32::try_from(digits.len()).ok()?) - 1.0;
            Some(f64::from(u32::from_str_radix(digits, 16).ok()?) / most)
        });
        let mut weighted = |weight: f64| Some(weight * parts.next()??.powf(2.2));
        let luminance = weighted(0.2126)? + weighted(0.7152)? + weighted(0.0722)?;
        Some(if luminance > MIDDLE { Self::Light } else { Self::Dark })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
            assert_eq!(Ground::named(text), ground, "{text}");
        }
    }

    #[test]
    fn a_report_has_one_to_four_digits_of_each_colour() {
        for (report, ground) in [
            ("rgb:ffff/ffff/ffff", Some(Ground::Light)),
            ("rgb:1e1e/1e1e/1e1e", Some(Ground::Dark)),
            ("rgba:f/f/d/0", Some(Ground::Light)),
            ("rgb:fd/f6/e3", Some(Ground::Light)),
            ("rgb:0000/0000/ffff", Some(Ground::Dark)),
            ("rgb:7f/7f/7f", Some(Ground::Light)),
            ("rgb:70/70/70", Some(Ground::Dark)),
            ("rgb:ffff/ffff", None),
            ("rgb:", None),
            ("", None),
        ] {
            assert_eq!(Ground::reported(report.as_bytes()), ground, "{report}");
        }
    }
}
