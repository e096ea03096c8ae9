//! Reports as JSON: names end in the SI unit, numbers round-trip exactly, and `null` stands for a
//! number that does not exist.

use std::io::Write;

use serde::Serialize;
use serde_json::{Value, json};

use super::sentence::Facts;
use super::{CommandLine, Wall};
use rubscope_solver::motion::RunReport;

/// Writes a report as indented JSON and a newline.
///
/// # Errors
/// The writer failed.
pub fn write(report: &impl Serialize, mut out: &mut dyn Write) -> std::io::Result<()> {
    serde_json::to_writer_pretty(&mut out, report)?;
    writeln!(out)
}

/// Writes a report with the name of its schema, and the program, version and command that reproduce
/// it. The scene must be part of the report.
///
/// # Errors
/// The writer failed.
pub fn write_as(
    schema: &'static str,
    command: &CommandLine,
    report: &impl Serialize,
    out: &mut dyn Write,
) -> std::io::Result<()> {
    #[derive(Serialize)]
    struct Named<'a, T> {
        schema: &'static str,
        program: Value,
        #[serde(flatten)]
        report: &'a T,
    }
    let command = command.clone().flag("--json", true);
    write(&Named { schema, program: command.program(), report }, out)
}

/// Writes a run (`rubscope.run/1`), with its wall times and any changes made during the run.
///
/// # Errors
/// The writer failed.
pub fn write_run(
    report: &RunReport,
    command: &CommandLine,
    wall: Wall,
    changes: Option<&impl Serialize>,
    out: &mut dyn Write,
) -> std::io::Result<()> {
    let mut value = json!(report);
    if let Some(Value::Object(solver)) = value.get_mut("solver") {
        solver.insert("wall_s".to_string(), json!(wall.run_s));
        solver.insert("certainty_s".to_string(), json!(wall.certainty_s));
    }
    if let Some(Value::Object(outcome)) = value.get_mut("outcome") {
        let facts = Facts::of(report);
        let told = facts.sentence(usize::MAX);
        outcome.insert("state".to_string(), json!(told.state()));
        outcome.insert("history".to_string(), json!(told.history));
        if let Some(growth) = facts.growth {
            outcome.insert("growth_1_s".to_string(), json!(growth));
        }
    }
    if let (Some(note), Some(report)) = (report.scene.share_note(), value.as_object_mut()) {
        report.insert("notes".to_string(), json!([note]));
    }
    if let (Some(changes), Some(report)) = (changes, value.as_object_mut()) {
        report.insert("changes".to_string(), json!(changes));
    }
    write_as("rubscope.run/1", command, &value, out)
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
