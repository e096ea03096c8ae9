//! Command lines for the clipboard: that of the run with its live changes, and that of the large
//! view.

use super::model::{App, Source};
use crate::sheet::CommandLine;
use crate::sheet::number::in_shown_unit;
use crate::tui::views::id::ViewId;
use rubscope_solver::scene::{DEFAULT, Scene};

impl App {
    /// Builds `rubscope run SCENE` with an option for every key that differs from the scene, and
    /// `--at` for every live change.
    pub fn command_line(&self) -> CommandLine {
        let Source { name, scene: base } = self.base();
        // Live changes are applied at their own instants, so the command starts from the first
        // scene of the film, with the extended end of the run.
        let film = &self.run.film;
        let mut scene = film.scene.clone().into_scene();
        scene.solver.end_s = film.end_s;
        let start = CommandLine::from_base("run", &name, &base, &scene);
        let at = |line: CommandLine, (t, what)| line.option("--at", format!("{t:?}:{what}"));
        film.arguments().into_iter().fold(start, at).flag("--plain", scene.solver.plain)
    }

    /// Builds the command line that computes what the large view shows.
    pub fn view_command(&self) -> CommandLine {
        let Source { name, scene: base } = self.base();
        let of = |command: &str| CommandLine::from_base(command, &name, &base, &self.scene);
        let line = match (self.view(), self.map_plan()) {
            (ViewId::Map, Ok(plan)) => CommandLine::from_base("map", &name, &base, &plan.scene)
                .option("--x", &plan.x)
                .option("--y", &plan.y)
                .flag("--no-sensitivity", !plan.sensitivity),
            (ViewId::Locked, _) => of("hbm"),
            (ViewId::Coincidence, _) => of("hbm").flag("--coincidence", true),
            (ViewId::Precision, _) => of("precision"),
            (ViewId::Margins, _) if self.layout.survey => {
                let end = |speed| {
                    let (value, unit) = in_shown_unit(speed, "rad/s");
                    format!("{value}{unit}")
                };
                let range = self.layout.range.map(|range| range.map(end).join(":"));
                of("survey").optional("--range", range)
            }
            (ViewId::Margins, _) => of("margins"),
            _ => self.command_line(),
        };
        line.flag("--rpm", self.appearance.rpm)
    }

    /// Returns the scene that a command line starts from: the open one, or the built-in default.
    fn base(&self) -> Source {
        self.files.source.clone().unwrap_or_else(|| Source {
            name: DEFAULT.into(),
            scene: Scene::builtin(DEFAULT).unwrap_or_else(|_| Scene::base()),
        })
    }

    /// Returns the command line for the clipboard, and shows it in the status line: whether the
    /// terminal takes it is not known.
    pub fn copied(&mut self) -> String {
        let command = self.view_command().to_string();
        self.status = Some(format!("sent to the terminal to copy: {command}"));
        command
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::command::Command;
    use crate::tui::{Marker, Theme};

    #[test]
    fn the_command_to_copy_is_that_of_the_large_view() {
        let mut app = App::new(
            Scene::builtin("paper-nd3").unwrap().checked().unwrap(),
            Theme::Dark,
            Marker::Braille,
        );
        app.update(Command::Set(0, "450".into())).unwrap();
        for (view, command) in [
            (ViewId::Response, "run paper-nd3 --set operation.speed_rad_s=450.0"),
            (ViewId::Locked, "hbm paper-nd3 --set operation.speed_rad_s=450.0"),
            (ViewId::Precision, "precision paper-nd3 --set operation.speed_rad_s=450.0"),
            (ViewId::Margins, "margins paper-nd3 --set operation.speed_rad_s=450.0"),
        ] {
            app.update(Command::View(view)).unwrap();
            assert_eq!(app.view_command().to_string(), format!("rubscope {command}"));
        }
        let range = Command::Range { ends: Some([200.0, 600.0]), doubt: None };
        app.update(range).unwrap();
        let survey = app.view_command().to_string();
        assert!(survey.ends_with("450.0 --range 200rad/s:600rad/s"), "{survey}");
        app.update(Command::View(ViewId::Map)).unwrap();
        let map = app.view_command().to_string();
        assert!(map.starts_with("rubscope map paper-nd3 --set"), "{map}");
        assert!(map.contains(" --x operation.speed_rad_s="), "{map}");
        app.update(Command::SpeedUnit).unwrap();
        assert!(app.view_command().to_string().ends_with(" --rpm"));
        app.update(Command::SpeedUnit).unwrap();
    }
}
