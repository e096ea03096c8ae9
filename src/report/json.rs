//! Reports as JSON: SI units in the names, numbers that read back as the same
//! value, `null` where a figure does not exist.

use std::io::Write;

use serde::Serialize;

/// Writes a report, indented, with a newline at its end.
///
/// # Errors
/// What the writer refuses.
pub fn write(report: &impl Serialize, mut out: &mut dyn Write) -> std::io::Result<()> {
    serde_json::to_writer_pretty(&mut out, report)?;
    writeln!(out)
}

#[cfg(test)]
mod tests {
    #[test]
    fn what_is_no_number_is_null_and_numbers_keep_every_digit() {
        let mut text = Vec::new();
        super::write(&[0.1 + 0.2, f64::NAN, 5e-324], &mut text).unwrap();
        let text = String::from_utf8(text).unwrap();
        let back: Vec<Option<f64>> = serde_json::from_str(&text).unwrap();
        assert_eq!(back, [Some(0.1 + 0.2), None, Some(5e-324)]);
        assert!(text.ends_with("]\n"));
    }
}
