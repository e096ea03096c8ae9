//! The command line that repeats the run on the screen.

use super::{App, Source};
use crate::report::CommandLine;
use crate::scene::keys::differences;
use crate::scene::{DEFAULT, Scene};

impl App {
    /// The command line as text.
    pub fn command(&self) -> String {
        self.command_line().to_string()
    }

    /// `rubscope run SCENE` with every key that differs from it.
    pub fn command_line(&self) -> CommandLine {
        // Without a source it is the default scene, which is built in.
        let default = || Source {
            name: DEFAULT.into(),
            scene: Scene::builtin(DEFAULT).unwrap_or_else(|_| Scene::base()),
        };
        let Source { name, scene: base } = self.files.source().cloned().unwrap_or_else(default);
        // Live changes come at their instants, after which the forecast is as long
        // as the scene says.
        let mut scene = self.run.scene().clone().into_scene();
        scene.solver.end_s = self.end_s();
        let start = CommandLine::from_base("run", &name, &base, &scene);
        let live = &self.results().applied;
        let at =
            |line: CommandLine, (t, what): &(f64, _)| line.option("--at", format!("{t:?}:{what}"));
        live.iter().fold(start, at)
    }

    /// Keys that differ from a scene, with their values as text.
    pub(super) fn changes_from(&self, base: &Scene) -> Vec<(&'static str, String)> {
        differences(base, &self.scene).collect()
    }

    /// The command to copy; the status line shows it too.
    pub(super) fn copied(&mut self) -> String {
        let command = self.command();
        self.status = Some(format!("copied: {command}"));
        command
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::{Marker, Theme};

    #[test]
    fn the_command_names_what_differs_and_nothing_else() {
        let mut scene = Scene::builtin("paper-nd3").unwrap();
        let app = App::new(scene.checked().unwrap(), Theme::Dark, Marker::Braille);
        assert_eq!(app.command(), "rubscope run paper-nd3");
        scene.set("operation.speed_rad_s", "-430").unwrap();
        scene.set("solver.contact", "unilateral").unwrap();
        scene.set("title", "it's mine").unwrap();
        let app = App::new(scene.checked().unwrap(), Theme::Dark, Marker::Braille);
        assert_eq!(
            app.command(),
            "rubscope run paper-nd3 --set 'title=it'\\''s mine' \
             --set operation.speed_rad_s=-430.0 --set solver.contact=unilateral"
        );
    }
}
