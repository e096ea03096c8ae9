//! A sheet: the result of a command. It has sentences, facts, tables and a picture, in the order in
//! which they are shown, and its origin. Text, CSV, JSON and SVG are written from it.

use std::io::{Result, Write};

use serde::ser::{Serialize, SerializeMap, Serializer};
use serde_json::{Value, json};

use super::line::wrapped;
use super::number::{per_speed, speed_unit};
use super::svg;
use super::table::{Table, WIDTH};
use super::{CommandLine, Provenance};
use rubscope_solver::scene::Scene;
use rubscope_solver::study::figures::{Figure, Panel, Quantity, Series, Style};

/// The result of a command.
pub struct Sheet<'a> {
    /// Name of the command, and version of the schema of its JSON.
    schema: (&'static str, u32),
    origin: Provenance,
    parts: Vec<Part<'a>>,
    picture: Picture<'a>,
}

/// One part of a sheet.
enum Part<'a> {
    /// A line of text.
    Line(String),
    /// A field of the JSON report.
    Fact(String, Value),
    /// A list in the JSON report: its name, its length, and the function that makes an entry.
    List(String, usize, Box<dyn Fn(usize) -> Value + 'a>),
    /// A table, with its name in JSON and its title in text; `None` where it is not shown.
    Table { name: Option<&'static str>, title: Option<String>, table: Table<'a> },
}

/// What a sheet draws.
enum Picture<'a> {
    /// Curves of the table for files over its first column; the text of the sheet if there are none.
    Charts(Vec<Chart>),
    Figure(Box<dyn Fn() -> Figure + 'a>),
}

/// A panel of columns: the label of its axis; and name and label of each column, or none for all.
type Chart = (&'static str, Vec<[&'static str; 2]>);

impl<'a> Sheet<'a> {
    /// Creates a sheet of the command `name`, with the schema `rubscope.NAME/VERSION` in JSON.
    /// `command` reproduces the result.
    pub fn new(name: &'static str, version: u32, command: CommandLine, scene: &Scene) -> Self {
        let origin = Provenance { command, scene: scene.clone() };
        let mut sheet = Self {
            schema: (name, version),
            origin,
            parts: Vec::new(),
            picture: Picture::Charts(Vec::new()),
        };
        sheet.fact("scene", scene.reported());
        sheet
    }

    /// Adds a line of text, which is not wrapped.
    pub fn line(&mut self, line: impl Into<String>) {
        self.parts.push(Part::Line(line.into()));
    }

    /// Adds a paragraph of text, which is wrapped to the width of a page.
    pub fn paragraph(&mut self, text: &str) {
        self.parts.extend(wrapped(text, WIDTH).into_iter().map(Part::Line));
    }

    /// Adds a field of the JSON report.
    pub fn fact(&mut self, name: impl Into<String>, value: impl Serialize) {
        self.parts.push(Part::Fact(name.into(), json!(value)));
    }

    /// Adds the fields of `report` to the JSON report. A field of the same name is replaced.
    pub fn facts(&mut self, report: &impl Serialize) {
        let Value::Object(fields) = json!(report) else { return };
        let known = |part: &Part| matches!(part, Part::Fact(name, _) if fields.contains_key(name));
        self.parts.retain(|part| !known(part));
        self.parts.extend(fields.into_iter().map(|(name, value)| Part::Fact(name, value)));
    }

    /// Adds a list of `count` entries to the JSON report.
    pub fn list(
        &mut self,
        name: impl Into<String>,
        count: usize,
        entry: impl Fn(usize) -> Value + 'a,
    ) {
        self.parts.push(Part::List(name.into(), count, Box::new(entry)));
    }

    /// Adds a table that is shown and, if it has a name, is part of the JSON report.
    pub fn table(
        &mut self,
        name: impl Into<Option<&'static str>>,
        title: impl Into<String>,
        table: Table<'a>,
    ) {
        self.parts.push(Part::Table { name: name.into(), title: Some(title.into()), table });
    }

    /// Adds a table for files only; it is part of the JSON report if it has a name.
    pub fn filed(&mut self, name: Option<&'static str>, table: Table<'a>) {
        self.parts.push(Part::Table { name, title: None, table });
    }

    /// Draws columns of the table for files over its first column, in a panel: name and label of
    /// each, or all columns if none is given.
    pub fn chart(&mut self, label: &'static str, columns: &[[&'static str; 2]]) {
        if let Picture::Charts(charts) = &mut self.picture {
            charts.push((label, columns.to_vec()));
        }
    }

    /// Draws a figure.
    pub fn picture(&mut self, figure: impl Fn() -> Figure + 'a) {
        self.picture = Picture::Figure(Box::new(figure));
    }

    /// Returns the table for files: the last one that has columns for them.
    pub fn file(&self) -> Option<&Table<'a>> {
        self.parts.iter().rev().find_map(|part| match part {
            Part::Table { table, .. } if table.names().next().is_some() => Some(table),
            _ => None,
        })
    }

    /// Writes the sheet as a file in the format of its ending, `csv`, `json` or `svg`. The same
    /// result gives the same file: a file has no wall time.
    ///
    /// # Errors
    /// The writer failed.
    pub fn write_file(&self, ending: &str, out: &mut dyn Write) -> Result<()> {
        match ending {
            "csv" => self.file().map_or(Ok(()), |table| table.write_csv(out)),
            "json" => self.write_json(false, out),
            _ => self.write_svg(out),
        }
    }

    /// Writes the sentences and tables as text.
    ///
    /// # Errors
    /// The writer failed.
    pub fn write_text(&self, out: &mut dyn Write) -> Result<()> {
        let mut after_table = false;
        for part in &self.parts {
            match part {
                Part::Line(line) => {
                    if std::mem::take(&mut after_table) {
                        writeln!(out)?;
                    }
                    writeln!(out, "{line}")?;
                }
                Part::Table { title: Some(title), table, .. } => {
                    writeln!(out)?;
                    if !title.is_empty() {
                        writeln!(out, "{title}")?;
                    }
                    table.write_text(out)?;
                    after_table = true;
                }
                Part::Fact(..) | Part::List(..) | Part::Table { .. } => {}
            }
        }
        Ok(())
    }

    /// Writes the sheet as indented JSON. Without `with_time` the wall time is `null`.
    ///
    /// # Errors
    /// The writer failed.
    pub fn write_json(&self, with_time: bool, mut out: &mut dyn Write) -> Result<()> {
        let mut json = serde_json::Serializer::pretty(&mut out);
        let mut object = json.serialize_map(None)?;
        let (name, version) = self.schema;
        object.serialize_entry("schema", &format!("rubscope.{name}/{version}"))?;
        let command = self.origin.command.clone().flag("--json", true);
        object.serialize_entry("program", &command.program())?;
        for part in &self.parts {
            match part {
                Part::Fact(name, _) if name == "wall_s" && !with_time => {
                    object.serialize_entry(name, &Value::Null)?;
                }
                Part::Fact(name, value) => object.serialize_entry(name, value)?,
                Part::List(name, count, entry) => {
                    object.serialize_entry(name, &Entries(*count, entry))?;
                }
                Part::Table { name: Some(name), table, .. } => {
                    object.serialize_entry(name, table)?;
                }
                Part::Line(_) | Part::Table { name: None, .. } => {}
            }
        }
        object.end()?;
        writeln!(out)
    }

    fn write_svg(&self, out: &mut dyn Write) -> Result<()> {
        let file = format!("{}.svg", self.schema.0);
        let command = self.origin.command.clone().option("--out", file);
        let origin = Provenance { command, ..self.origin.clone() };
        match &self.picture {
            Picture::Figure(figure) => svg::write(&figure(), &origin, out),
            Picture::Charts(charts) if !charts.is_empty() => {
                let panels = self.panels();
                // Where a curve is missing, the title of the table says why.
                let why = self.parts.iter().rev().find_map(|part| match part {
                    Part::Table { title, .. } if panels.iter().any(Panel::is_bare) => title.clone(),
                    _ => None,
                });
                let title = origin.scene.title.clone();
                svg::write(&Figure::new(title, why.unwrap_or_default(), panels), &origin, out)
            }
            Picture::Charts(_) => {
                let mut text = Vec::new();
                self.write_text(&mut text)?;
                writeln!(text, "\n{}", origin.line())?;
                svg::write_text(&String::from_utf8_lossy(&text), &origin, out)
            }
        }
    }

    /// Returns what the sheet draws.
    pub fn panels(&self) -> Vec<Panel> {
        match &self.picture {
            Picture::Figure(figure) => figure().panels,
            Picture::Charts(charts) => {
                charts.iter().filter_map(|chart| self.panel(chart)).collect()
            }
        }
    }

    /// Returns curves of the table for files.
    fn panel(&self, (label, columns): &Chart) -> Option<Panel> {
        let table = self.file()?;
        let mut names = table.names();
        let first = names.next()?;
        let columns: Vec<[&str; 2]> = match columns.is_empty() {
            true => names.map(|name| [name; 2]).collect(),
            false => columns.clone(),
        };
        let x = match first {
            "t_s" => Quantity::TIME,
            "speed_rad_s" => Quantity {
                label: format!("rotor speed Ω [{}]", speed_unit()).into(),
                factor: per_speed(1.0),
                ..Quantity::SPEED
            },
            _ => Quantity::new("x", "frequency ω [rad/s]", 1.0),
        };
        let mut series: Vec<Series> = Vec::new();
        for (number, [name, label]) in columns.iter().enumerate() {
            let points = table.numbers([first, *name]);
            series.push(Series { points, ..Series::new(*label, Style::Line(number), []) });
        }
        let y = Quantity::new("y", label, 1.0);
        Some(Panel::new("", x, y, series))
    }
}

/// A list of a number of entries, each created when it is written.
struct Entries<'a>(usize, &'a dyn Fn(usize) -> Value);

impl Serialize for Entries<'_> {
    fn serialize<S: Serializer>(&self, out: S) -> std::result::Result<S::Ok, S::Error> {
        out.collect_seq((0..self.0).map(self.1))
    }
}
