//! `rubscope figures`: the paper's Figs. 4 to 10, reproduced as SVG with their
//! data as CSV.

use std::io::Write;
use std::path::PathBuf;

use anyhow::Context;
use clap::Args;

use super::status::{self, Done, Refusal, Status, say};
use super::{output, sign};
use crate::file::Written;
use crate::sheet::{CommandLine, Provenance, figure::table, svg};
use rubscope_solver::scene::Scene;
use rubscope_solver::study::figures::{Figure, Which};

/// Reproduce the paper's Figs. 4 to 10 as SVG, with their data as CSV.
///
/// Each figure uses the built-in scene that reproduces the paper's description of it
/// (paper-figs-4-6, paper-fig-7, paper-fig-8, paper-nd3). Its caption says what agrees with
/// the paper and what differs.
#[derive(Args, Debug)]
pub struct FiguresCommand {
    /// Directory of the files; created if missing
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Only these figures, such as 4,9
    #[arg(long, value_name = "FIGURES", value_delimiter = ',')]
    only: Vec<String>,
}

impl FiguresCommand {
    pub(super) fn run(&self, out: &mut dyn Write) -> Done {
        let which = |word: &String| {
            word.parse().map_err(|()| Refusal::of("--only", word, "numbers from 4 to 10"))
        };
        let only = self.only.iter().map(which).collect::<Result<Vec<Which>, _>>()?;
        let mut asked = Which::of_paper();
        asked.retain(|which| only.is_empty() || only.contains(which));
        let shown = self.out.display();
        std::fs::create_dir_all(&self.out).with_context(|| format!("cannot make {shown}"))?;
        for which in &asked {
            let stem = which.stem();
            // A figure with several panels has one data file per panel: a, b, c, d.
            let data = ["", "a", "b", "c", "d"].map(|letter| format!("{stem}{letter}.csv"));
            for name in data.iter().chain([&format!("{stem}.svg")]) {
                output::try_place(&self.out.join(name))?;
            }
        }
        let bar = sign::bar(asked.len() as u64, "{spinner} {bar:30} {msg} {elapsed}");
        for which in asked {
            bar.set_message(format!("figure {which}"));
            let scene = which.scene()?;
            self.save(which, &which.draw(&scene)?, scene.into_scene(), out)?;
            bar.inc(1);
        }
        Ok(Status::Done)
    }

    fn save(
        &self,
        which: Which,
        figure: &Figure,
        scene: Scene,
        out: &mut dyn Write,
    ) -> anyhow::Result<()> {
        // The recorded command names a fixed directory instead of the user's, so that the same
        // figure gives the same file everywhere.
        let command = CommandLine::without_scene("figures")
            .option("--only", which)
            .option("--out", "figures");
        let origin = Provenance { command, scene };
        let stem = which.stem();
        let mut written: [Vec<String>; 2] = Default::default();
        let mut save = |name: String, content: &dyn Fn(&mut dyn Write) -> std::io::Result<()>| {
            let done = output::replace_or_print(&self.out.join(&name), out, content)?;
            written[usize::from(done == Written::Replaced)].push(name);
            anyhow::Ok(())
        };
        save(format!("{stem}.svg"), &|out| svg::write(figure, &origin, out))?;
        for (panel, letter) in figure.panels.iter().zip('a'..='z') {
            let letter = if figure.panels.len() > 1 { letter.to_string() } else { String::new() };
            save(format!("{stem}{letter}.csv"), &|out| table(panel).write_csv(out))?;
        }
        status::say_noted();
        let shown = self.out.display();
        for (names, [done, place]) in written.iter().zip([["wrote", "to"], ["replaced", "in"]]) {
            if !names.is_empty() {
                say(&format!("rubscope: {done} {} {place} {shown}", names.join(", ")));
            }
        }
        Ok(())
    }
}
