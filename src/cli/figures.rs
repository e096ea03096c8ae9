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
use crate::report::{figure::table, svg};
use crate::scene::{CheckedScene, Scene};
use crate::study::figures::{Figure, NUMBERS, Scenes, figure};

/// Reproduce the paper's Figs. 4 to 10 as SVG, with their data as CSV.
///
/// Without a SCENE, Figs. 4 to 7 show a motion that locks late, as in the
/// paper: without casing damping, with unilateral contact, and with a pulse
/// that the paper does not give. With a SCENE, every figure uses it, with four
/// nodal diameters in Fig. 7. Other options change every figure. Fig. 4 has its
/// own time steps, Fig. 8 its own contact laws and pulses, and Figs. 8 to 10
/// range from standstill to the speed of the scene.
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
        let scenes = self.scenes()?;
        let shown = self.out.display();
        std::fs::create_dir_all(&self.out).with_context(|| format!("cannot make {shown}"))?;
        for number in &numbers {
            let stem = stem(*number);
            // One letter for each of several panels.
            let data = ["", "a", "b"].map(|letter| format!("{stem}{letter}.csv"));
            for name in data.iter().chain([&format!("{stem}.svg")]) {
                output::try_place(&self.out.join(name))?;
            }
        }
        for number in numbers {
            // A machine that cannot lock has no Figs. 9 and 10: refused input.
            let drawn = figure(number, &scenes)
                .map_err(|error| Refusal::because(format!("figure {number}: {error}")))?;
            if let Some(drawn) = drawn {
                self.save(number, &drawn, out)?;
            }
        }
        Ok(Status::Done)
    }

    fn numbers(&self) -> Result<Vec<u32>, Refusal> {
        if self.only.is_empty() {
            return Ok(NUMBERS.to_vec());
        }
        match self.only.iter().find(|number| !NUMBERS.contains(number)) {
            Some(unknown) => Err(Refusal::of("--only", unknown, "numbers from 4 to 10")),
            None => Ok(self.only.clone()),
        }
    }

    fn scenes(&self) -> anyhow::Result<Scenes> {
        let scenes = match self.options.name() {
            None => {
                let Scenes { three, four, machine } = Scenes::paper()?;
                [three, four, machine].map(CheckedScene::into_scene)
            }
            Some(name) => {
                let scene = Scene::load_unchecked(name)?;
                let mut four = scene.clone();
                four.set("operation.nodal_diameters", "4")?;
                [scene.clone(), four, scene]
            }
        };
        let [three, four, machine] = scenes;
        Ok(Scenes {
            three: self.options.change(three)?,
            four: self.options.change(four)?,
            machine: self.options.change(machine)?,
        })
    }

    fn save(&self, number: u32, figure: &Figure, out: &mut dyn Write) -> anyhow::Result<()> {
        let stem = stem(number);
        let (mut wrote, mut replaced) = (Vec::new(), Vec::new());
        let mut note = |name: String, written| match written {
            Written::New => wrote.push(name),
            Written::Replaced => replaced.push(name),
        };
        let name = format!("{stem}.svg");
        let written = write(&self.out.join(&name), out, |out| svg::write(figure, out))?;
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
