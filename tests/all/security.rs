//! The numbers of SECURITY.md are those of the program.

use crate::cli_support::refusal;

/// The last whole number of a message.
fn last_number(message: &str) -> u64 {
    let mut words = message.rsplit(|c: char| !c.is_ascii_digit());
    words.find(|word| !word.is_empty()).unwrap().parse().unwrap()
}

const HISTORY: &str = "run --gaps --samples 1000000 --set bladed_disk.blades=4096 --out h.csv";

#[test]
fn the_limits_of_the_page_are_those_of_the_program() {
    let page = include_str!("../../SECURITY.md").replace(',', "");
    let files = tempfile::tempdir().unwrap();
    let large = files.path().join("large.toml");
    std::fs::write(&large, "#".repeat((1 << 20) + 1)).unwrap();
    let scene = refusal(&["run", large.to_str().unwrap()]);
    let map = ["map", "--speed", "0:500:5000", "--pulse", "0:1e4:5000"];
    for (message, unit) in [
        (scene.as_str(), " bytes"),
        (&refusal(&map), " cells"),
        (&refusal(&["map", "--x", "operation.speed_rad_s=0:1:100001"]), " values"),
        (&refusal(&HISTORY.split(' ').collect::<Vec<_>>()), " values"),
        (&refusal(&["hbm", "--speed", "0:500:100001"]), ""),
        (&refusal(&["map", "--threads", "1025"]), ""),
    ] {
        let limit = format!("{}{unit}", last_number(message));
        assert!(page.contains(&limit), "{limit} is not in SECURITY.md: {message}");
    }
}
