//! The Python of docs/python.md runs on what the program
//! writes. `RUBSCOPE_PYTHON` names a Python with numpy and matplotlib, which
//! then must have both; without the variable, `python3` runs what it can.

use std::path::Path;
use std::process::{Command, Output};

use crate::docs::read;

/// A Python and the modules it has.
struct Python {
    program: String,
    plots: bool,
}

impl Python {
    /// `None`, with a line that says so, if there is no numpy.
    fn find() -> Option<Self> {
        let named = std::env::var("RUBSCOPE_PYTHON").ok();
        let program = named.clone().unwrap_or_else(|| "python3".to_string());
        let has = |module: &str| {
            let import = format!("import {module}");
            let tried = Command::new(&program).args(["-c", &import]).output();
            let has = tried.is_ok_and(|output| output.status.success());
            assert!(has || named.is_none(), "RUBSCOPE_PYTHON={program} has no {module}");
            if !has {
                eprintln!("skipped: {program} has no {module}");
            }
            has
        };
        has("numpy").then(|| Self { plots: has("matplotlib"), program: program.clone() })
    }

    /// Runs a text in a folder, with the program of this build first on the path.
    fn run(&self, text: &str, folder: &Path) -> Output {
        let built = Path::new(env!("CARGO_BIN_EXE_rubscope")).parent().unwrap().to_path_buf();
        let path = std::env::var_os("PATH").unwrap_or_default();
        let path = std::env::join_paths([built].into_iter().chain(std::env::split_paths(&path)));
        let mut command = Command::new(&self.program);
        command.args(["-X", "utf8", "-c", text]).current_dir(folder);
        command.env("PATH", path.unwrap()).env("MPLBACKEND", "Agg").env("MPLCONFIGDIR", folder);
        command.output().unwrap()
    }

    /// Runs the block, unless it plots and this Python cannot.
    fn check(&self, text: &str, shown: Option<&str>, folder: &Path) {
        if text.contains("matplotlib") && !self.plots {
            return;
        }
        let output = self.run(text, folder);
        let (printed, errors) = (output.stdout, String::from_utf8_lossy(&output.stderr));
        assert!(output.status.success(), "{text}\n{errors}");
        if let Some(shown) = shown {
            let printed = String::from_utf8(printed).unwrap().replace("\r\n", "\n");
            assert_eq!(printed, shown, "{text}");
        }
    }
}

#[test]
fn the_python_of_the_documents_runs() {
    let Some(python) = Python::find() else { return };
    let folder = tempfile::tempdir().unwrap();
    let blocks = read("docs/python.md").blocks();
    let mut count = 0;
    for (at, block) in blocks.iter().enumerate() {
        let text = &block.text;
        match block.language.as_str() {
            "sh" => {
                let arguments = text.trim_end().strip_prefix("rubscope ").unwrap().split(' ');
                let run = crate::cli_support::program()
                    .args(arguments)
                    .current_dir(folder.path())
                    .output()
                    .unwrap();
                assert!(run.status.success(), "{text}{}", String::from_utf8_lossy(&run.stderr));
            }
            "python" => {
                let after = blocks.get(at + 1).filter(|block| block.language == "text");
                python.check(text, after.map(|block| block.text.as_str()), folder.path());
                count += 1;
            }
            _ => {}
        }
    }
    assert!(count >= 4, "docs/python.md has {count} blocks of Python");
    if python.plots {
        let picture = std::fs::read(folder.path().join("gaps.png")).unwrap();
        assert!(picture.starts_with(b"\x89PNG") && picture.len() > 10_000, "Fig. 5 is empty");
    }
}
