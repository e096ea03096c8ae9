//! The README shows what the program prints: every command of its `console`
//! blocks is run, and its output is compared line by line.

use std::path::Path;

/// A command of the README and the lines it shows below it.
struct Shown {
    command: String,
    lines: Vec<String>,
}

fn readme() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md");
    std::fs::read_to_string(path).unwrap()
}

fn shown() -> Vec<Shown> {
    let mut found: Vec<Shown> = Vec::new();
    let mut inside = false;
    for line in readme().lines() {
        if line.starts_with("```") {
            inside = line == "```console";
        } else if let Some(command) = line.strip_prefix("$ ").filter(|_| inside) {
            found.push(Shown { command: command.to_string(), lines: Vec::new() });
        } else if inside {
            found.last_mut().unwrap().lines.push(line.to_string());
        }
    }
    found
}

/// A line of a map: nine of ten characters must agree, for the same reason.
fn same_picture(shown: &str, printed: &str) -> bool {
    let (shown, printed): (Vec<char>, Vec<char>) =
        (shown.chars().collect(), printed.chars().collect());
    let equal = shown.iter().zip(&printed).filter(|(a, b)| a == b).count();
    shown.len() == printed.len() && 10 * equal >= 9 * shown.len()
}

/// The same words, and numbers within a thousandth: other processors round
/// sines differently, and no statement of the README depends on a fourth digit.
fn same(shown: &str, printed: &str) -> bool {
    if shown.ends_with('|') {
        return same_picture(shown, printed);
    }
    let words = |line: &str| -> Vec<String> {
        let separate = |c: char| c.is_whitespace() || "(),;:=".contains(c);
        line.split(separate).map(|word| word.trim_end_matches('.').to_string()).collect()
    };
    let (shown, printed) = (words(shown), words(printed));
    shown.len() == printed.len()
        && shown.iter().zip(&printed).all(|(a, b)| match (a.parse::<f64>(), b.parse::<f64>()) {
            (Ok(x), Ok(y)) => (x - y).abs() <= 1e-3 * x.abs(),
            _ => a == b,
        })
}

/// Compares line by line; "..." matches any lines, and costs may differ.
fn matches(shown: &[String], printed: &[&str]) -> bool {
    match (shown.first().map(String::as_str), printed.first()) {
        (None, None) => true,
        (Some("..."), _) => (0..=printed.len()).any(|skip| matches(&shown[1..], &printed[skip..])),
        (Some(line), Some(found)) => {
            let cost = line.starts_with("Cost: ") && found.starts_with("Cost: ");
            (cost || same(line, found)) && matches(&shown[1..], &printed[1..])
        }
        _ => false,
    }
}

#[test]
fn every_command_of_the_readme_prints_what_the_readme_shows() {
    let all = shown();
    assert!(all.len() >= 3, "the README shows how to use the program");
    for Shown { command, lines } in all {
        let arguments: Vec<&str> = command.strip_prefix("rubscope ").unwrap().split(' ').collect();
        let output =
            assert_cmd::cargo::cargo_bin_cmd!("rubscope").args(&arguments).output().unwrap();
        let printed = [output.stdout, output.stderr].concat();
        let printed = String::from_utf8(printed).unwrap();
        let printed: Vec<&str> = printed.lines().collect();
        let ends_well = output.status.success() || lines.iter().any(|l| l.starts_with("rubscope:"));
        assert!(ends_well, "{command}: {}\n{}", output.status, printed.join("\n"));
        assert!(matches(&lines, &printed), "{command} printed\n{}", printed.join("\n"));
    }
}

#[test]
fn every_key_and_option_is_in_the_readme() {
    let readme = readme();
    for key in rubscope::scene::KEYS {
        let Some((table, leaf)) = key.path.split_once('.') else { continue };
        let told = readme.contains(&format!("`{table}.`")) && readme.contains(&format!("`{leaf}`"));
        assert!(told, "{}", key.path);
    }
    let command = |name: &str| readme.contains(&format!("rubscope {name}"));
    for name in ["run", "hbm", "map", "precision", "figures", "scenes", "completions", "man"] {
        assert!(command(name), "{name}");
    }
}
