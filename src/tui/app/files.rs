//! Writing files: the scene as TOML, the data of the large chart as CSV, the
//! screen as SVG. No file is replaced without a question.

use std::fs::OpenOptions;
use std::io::{ErrorKind, Write};

use super::{App, InputMode, Purpose};
use crate::tui::export;

impl App {
    /// Writes a file, or asks first where one exists.
    pub(super) fn write(&mut self, purpose: Purpose, name: &str, replace: bool) {
        let name = name.trim();
        if name.is_empty() {
            self.status = Some("a file name is needed; Esc leaves".into());
            return;
        }
        self.mode = InputMode::Main;
        let content = match purpose {
            Purpose::Save => Ok(self.scene.to_toml()),
            Purpose::Export if name.ends_with(".svg") => Ok(export::svg(self)),
            Purpose::Export => self.view.panel().csv(self),
        };
        let content = match content {
            Ok(content) => content,
            Err(reason) => {
                self.status = Some(format!("nothing exported: {reason}"));
                return;
            }
        };
        let mut options = OpenOptions::new();
        options.write(true);
        if replace {
            options.create(true).truncate(true);
        } else {
            options.create_new(true);
        }
        match options
            .open(self.directory.join(name))
            .and_then(|mut file| file.write_all(content.as_bytes()))
        {
            Ok(()) => self.status = Some(format!("written: {name}")),
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {
                self.mode = InputMode::Replacing(purpose, name.to_string());
            }
            Err(error) => self.status = Some(format!("cannot write {name}: {error}")),
        }
    }
}
