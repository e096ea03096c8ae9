//! `rubscope figures`: the paper's Figs. 4 to 10, reproduced as SVG with their
//! data as CSV.

use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::Args;

use super::options::SceneOptions;
use super::status::{self, Refusal, Status, say};
use super::{Done, output};
use crate::file::Written;
use crate::report::{CommandLine, Provenance, figure::table, svg};
use crate::scene::{CheckedScene, Scene};
use crate::study::figures::{Figure, NUMBERS, figure, name_of};

/// Reproduce the paper's Figs. 4 to 10 as SVG, with their data as CSV.
///
/// Without a SCENE, every figure has the built-in scene that gives what the
/// paper says of it (paper-figs-4-6, paper-fig-7, paper-fig-8, paper-nd3), and a
/// caption that says what agrees and what differs. With a SCENE, every figure
/// uses it. Other options change every figure. Fig. 4 has its own time steps,
/// Fig. 8 its own contact laws, pulses and speeds up to that of the scene, and
/// Figs. 9 and 10 range from standstill to the speed of the scene.
#[derive(Args, Debug)]
pub struct FiguresCommand {
    #[command(flatten)]
    options: SceneOptions,
    /// Directory of the files; created if missing
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Only these figures, such as 4,9
    #[arg(long, value_name = "NUMBERS", value_delimiter = ',')]
    only: Vec<u32>,
}

impl FiguresCommand {
    pub(super) fn run(&self, out: &mut dyn Write) -> Done {
        let numbers = self.numbers()?;
        let scenes: Vec<(u32, CheckedScene)> = numbers
            .into_iter()
            .map(|number| Ok((number, self.scene(number)?)))
            .collect::<anyhow::Result<_>>()?;
        // A machine that cannot lock has no Figs. 9 and 10: refused before anything
        // is written. They cost next to nothing.
        for (number, scene) in scenes.iter().filter(|(number, _)| *number >= 9) {
            drawn(*number, scene)?;
        }
        let shown = self.out.display();
        std::fs::create_dir_all(&self.out).with_context(|| format!("cannot make {shown}"))?;
        for (number, _) in &scenes {
            let stem = stem(*number);
            // One letter for each of several panels.
            let data = ["", "a", "b", "c", "d"].map(|letter| format!("{stem}{letter}.csv"));
            for name in data.iter().chain([&format!("{stem}.svg")]) {
                output::try_place(&self.out.join(name))?;
            }
        }
        let bar = output::bar(scenes.len() as u64, "{bar:30} {msg}");
        for (number, scene) in scenes {
            bar.set_message(format!("figure {number}"));
            if let Some(drawn) = drawn(number, &scene)? {
                bar.suspend(|| self.save(number, &drawn, scene.into_scene(), out))?;
            }
            bar.inc(1);
        }
        bar.finish_and_clear();
        Ok(Status::Done)
    }

    fn numbers(&self) -> Result<Vec<u32>, Refusal> {
        if self.only.is_empty() {
            return Ok(NUMBERS.to_vec());
        }
        match self.only.iter().find(|number| !NUMBERS.contains(number)) {
            Some(unknown) => Err(Refusal::of("--only", unknown, "numbers from 4 to 10")),
            None => {
                let asked = |number: &u32| self.only.contains(number);
                Ok(NUMBERS.into_iter().filter(asked).collect())
            }
        }
    }

    fn scene(&self, number: u32) -> anyhow::Result<CheckedScene> {
        let name = self.options.name().unwrap_or_else(|| name_of(number));
        self.options.change(Scene::load_unchecked(name)?)
    }

    fn save(
        &self,
        number: u32,
        figure: &Figure,
        scene: Scene,
        out: &mut dyn Write,
    ) -> anyhow::Result<()> {
        // The folder is the user's; the same figure is the same file in each.
        let command =
            CommandLine::new("figures", &scene).option("--only", number).option("--out", "figures");
        let origin = Provenance { command, scene };
        let stem = stem(number);
        let (mut wrote, mut replaced) = (Vec::new(), Vec::new());
        let mut note = |name: String, written| match written {
            Written::New => wrote.push(name),
            Written::Replaced => replaced.push(name),
        };
        let name = format!("{stem}.svg");
        let written = write(&self.out.join(&name), out, |out| svg::write(figure, &origin, out))?;
        note(name, written);
        for (panel, letter) in figure.panels.iter().zip('a'..='z') {
            let letter = if figure.panels.len() > 1 { letter.to_string() } else { String::new() };
            let name = format!("{stem}{letter}.csv");
            let written = write(&self.out.join(&name), out, |out| table(panel).write_csv(out))?;
            note(name, written);
        }
        status::say_noted();
        let shown = self.out.display();
        for (names, done) in [(wrote, "wrote"), (replaced, "replaced")] {
            if !names.is_empty() {
                let place = if done == "wrote" { "to" } else { "in" };
                say(&format!("rubscope: {done} {} {place} {shown}", names.join(", ")));
            }
        }
        Ok(())
    }
}

/// A figure of a scene.
fn drawn(number: u32, scene: &CheckedScene) -> Result<Option<Figure>, Refusal> {
    figure(number, scene).map_err(|error| Refusal::because(format!("figure {number}: {error}")))
}

/// The name of a figure's files, without their ending.
fn stem(number: u32) -> String {
    format!("fig{number:02}")
}

/// Writes a file; its content goes to standard output if that fails.
fn write(
    path: &Path,
    out: &mut dyn Write,
    content: impl Fn(&mut dyn Write) -> std::io::Result<()>,
) -> anyhow::Result<Written> {
    output::replace_or_print(path, out, &content, &content)
}
