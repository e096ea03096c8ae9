//! What must hold for any bytes that a user, a file or a keyboard can give: one
//! law for each kind of input, with inputs to start from. `fuzz_cases` tests
//! them on a stable compiler, and the targets in `fuzz/` run them under a fuzzer.

use std::fmt::Debug;

use rubscope::cli::range::Range;
use rubscope::cli::script::RequestedScript;
use rubscope::sheet::part::{read_all, write};
use rubscope_solver::scene::{Allowed, BUILTIN, CheckedScene, KEYS, Quantity, Scene, Value, keys};
use rubscope_solver::study::{Axis, Cell, Doubt, Map, MapPlan};

/// A kind of input.
pub struct Target {
    /// Its name, also that of its folders and of its program in `fuzz/`.
    pub name: &'static str,
    /// What must hold for any bytes; panics where it does not.
    pub law: fn(&[u8]),
    /// Inputs to start from.
    pub seeds: fn() -> Vec<Vec<u8>>,
}

/// Every kind of input.
pub const TARGETS: [Target; 6] = [
    Target { name: "scene", law: scene, seeds: scene_seeds },
    Target { name: "set", law: set, seeds: set_seeds },
    Target { name: "range", law: range, seeds: range_seeds },
    Target { name: "part", law: part, seeds: part_seeds },
    Target { name: "at", law: at, seeds: at_seeds },
    Target { name: "keys", law: super::fuzz_keys::keys, seeds: super::fuzz_keys::seeds },
];

/// Words that mean something to one of the readers.
pub fn words() -> Vec<String> {
    let mut words: Vec<String> = KEYS.iter().map(|key| key.path.to_string()).collect();
    for key in KEYS {
        words.extend(key.path.split('.').map(String::from));
        match key.allowed {
            Allowed::OneOf(list) | Allowed::SomeOf(list) => {
                words.extend(list.iter().map(ToString::to_string));
            }
            Allowed::Real { min, max, .. } => words.extend([min, max].map(|x| format!("{x:e}"))),
            Allowed::Whole { min, max } => words.extend([min, max].map(|n| n.to_string())),
            Allowed::Text { .. } | Allowed::Modes(_) | Allowed::Numbers { .. } => {}
        }
    }
    let odd = [
        "schema = 1",
        "[",
        "]",
        "=",
        ":",
        "log:",
        "pulse",
        "nan",
        "inf",
        "-0",
        "1e308",
        "5e-324",
        "-1e308",
        "4294967295",
        "18446744073709551616",
        "1e-400",
        "\n",
        "\r\n",
        "\"",
        "'''",
        "\u{1b}[31m",
        "\u{202e}",
        "\u{2028}",
        "\u{0}",
        "true",
        "1979-05-27",
        "{ a = 1 }",
        "[[",
    ];
    words.extend(odd.map(String::from));
    words.sort_unstable();
    words.dedup();
    words
}

/// A scene that is accepted prints to text that is accepted and gives the same
/// scene; where it may be solved, it has a stable step.
pub fn scene(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let Ok(scene) = Scene::from_toml_unchecked(text) else {
        assert!(Scene::from_toml(text).is_err(), "checked more, refused less");
        return;
    };
    reads_back(&scene);
    if let Ok(checked) = scene.checked() {
        assert_eq!(Scene::from_toml(text).unwrap(), *checked);
        let step = checked.stable_step();
        assert!(step.is_finite() && step > 0.0, "a stable step of {step} s");
    }
}

fn scene_seeds() -> Vec<Vec<u8>> {
    let mut seeds: Vec<Vec<u8>> = BUILTIN.iter().map(|scene| scene.toml.into()).collect();
    seeds.push(Scene::base().to_toml().into());
    seeds
}

/// A scene printed and read is the same scene, and prints to the same text.
fn reads_back(scene: &Scene) {
    let printed = scene.to_toml();
    let read = Scene::from_toml_unchecked(&printed).unwrap();
    assert_eq!(read, *scene, "{printed}");
    assert_eq!(read.to_toml(), printed);
}

/// Lines `PATH=VALUE`, as of `--set`: a value that is accepted is allowed, and
/// reads back; one that is refused leaves the scene as it was.
pub fn set(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let mut scene = Scene::base();
    for (path, value) in text.lines().filter_map(|line| line.split_once('=')) {
        let before = scene.clone();
        let path = path.trim();
        if scene.set(path, value).is_err() {
            assert_eq!(scene, before, "{path} = {value} was refused and taken");
            continue;
        }
        let key = keys::find(path).unwrap();
        let held = (key.get)(&scene);
        key.check(&held).unwrap();
        // The text of a value as the program shows it in files and messages.
        let shown = match &held {
            Value::Text(text) => text.clone(),
            Value::Words(words) => words.join(","),
            number => number.to_string(),
        };
        assert_eq!(key.parse(&shown).unwrap(), held, "{path} = {value}");
    }
    reads_back(&scene);
}

fn set_seeds() -> Vec<Vec<u8>> {
    let scene = Scene::base();
    let line = |key: &keys::Key| format!("{}={}\n", key.path, (key.get)(&scene));
    let mut seeds: Vec<String> = KEYS.iter().map(line).collect();
    seeds.push(seeds.concat());
    seeds.push("operation.speed_rad_s=-430\nview.charts=gaps, map\nsolver.kind = event\n".into());
    seeds.into_iter().map(Into::into).collect()
}

/// Text of a range and of an axis: if it is accepted, its values are finite, as
/// many as asked for, in order, and begin and end as given.
pub fn range(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    if let Ok(range) = Range::parse("--speed", text, Quantity::Speed)
        && range.count <= 10_000
    {
        in_order(&range.values(), range.from, range.to, range.count, &range);
    }
    if let Ok(axis) = Axis::parse(text)
        && axis.count <= 10_000
    {
        in_order(&axis.values(), axis.from, axis.to, axis.count as usize, &axis);
        let mut scene = Scene::base();
        for index in 0..axis.count {
            axis.apply(&mut scene, index).unwrap();
        }
    }
}

/// Round-off may move a value by some units of the larger end.
fn in_order(values: &[f64], from: f64, to: f64, count: usize, of: &dyn Debug) {
    assert_eq!(values.len(), count, "{of:?}");
    assert_eq!(values.first(), Some(&from), "{of:?}");
    assert!(count == 1 || values.last() == Some(&to), "{of:?}");
    let unit = 4.0 * f64::EPSILON * from.abs().max(to.abs());
    let (low, high) = (from.min(to) - unit, from.max(to) + unit);
    let odd = values.iter().find(|x| !(x.is_finite() && (low..=high).contains(*x)));
    assert_eq!(odd, None, "{of:?}");
    let falls = |pair: &&[f64]| (pair[1] - pair[0]) * (to - from).signum() < -unit;
    assert_eq!(values.windows(2).find(falls), None, "{of:?}");
}

fn range_seeds() -> Vec<Vec<u8>> {
    let texts = [
        "0:500:501",
        "-10:1e2:3",
        "500:-500:3",
        "7:9:1",
        "operation.speed_rad_s=0:500:51",
        "operation.pulse_n=log:1e3:1e6:4",
        "operation.nodal_diameters=2:6:5",
        "bladed_disk.blades = 24:20:5",
        "casing.damping_ratio=0:0.05:11",
    ];
    texts.map(Into::into).to_vec()
}

/// A part of a map that is accepted, written again, gives the same map. Bytes that are no
/// part are tried once more with the version of this program, which chance does not find.
pub fn part(data: &[u8]) {
    part_reads_back(data);
    if let Some(mended) = mended(data) {
        part_reads_back(&mended);
    }
}

fn part_reads_back(data: &[u8]) {
    let read = |bytes: &[u8]| read_all([("part".to_string(), bytes)]);
    let Ok(map) = read(data) else { return };
    assert!(map.is_complete() && !map.cells.is_empty());
    assert_eq!(map.cells.len(), map.plan.len());
    let mut written = Vec::new();
    write(&map, &mut written).unwrap();
    assert!(read(&written).unwrap() == map, "written, it reads otherwise");
    let twice = read_all([("one".to_string(), data), ("two".to_string(), &written[..])]);
    assert!(twice.is_err(), "every cell is there twice");
    for index in [0, map.plan.len() / 2, map.plan.len() - 1] {
        // A scene may be refused there, but its values are numbers.
        let _ = map.plan.scene_of(index);
    }
}

/// A part with the version of this program.
fn mended(data: &[u8]) -> Option<Vec<u8>> {
    let seed = part_seeds().swap_remove(0);
    let (program, _) = std::str::from_utf8(&seed).ok()?.split_once(" map ")?;
    let (_, origin) = std::str::from_utf8(data).ok()?.split_once(" map ")?;
    Some(format!("{program} map {origin}").into_bytes())
}

fn part_seeds() -> Vec<Vec<u8>> {
    let plan = |x: &str, y: &str, sensitivity| MapPlan {
        scene: Scene::base(),
        x: Axis::parse(x).unwrap(),
        y: Axis::parse(y).unwrap(),
        sensitivity,
    };
    let plain = plan("operation.speed_rad_s=300:500:3", "operation.pulse_n=0:4e4:2", false);
    let other = plan("bladed_disk.blades=20:24:2", "operation.pulse_n=log:1e3:1e6:4", true);
    let mut seeds = Vec::new();
    for (plan, step) in [(&plain, 1), (&plain, 2), (&plain, 100), (&other, 1), (&other, 3)] {
        let mut map = Map::empty(plan.clone());
        // Invented cells: a run is not what is tested.
        for index in (0..map.cells.len()).step_by(step) {
            let verdict = rubscope_solver::motion::Verdict::ALL[index % 6];
            let doubt = match index % 4 {
                1 | 3 if plan.sensitivity => Doubt::Sensitive,
                2 if plan.sensitivity => Doubt::Step,
                _ => Doubt::None,
            };
            map.cells[index] = Some(Cell { verdict, doubt });
        }
        let mut bytes = Vec::new();
        write(&map, &mut bytes).unwrap();
        seeds.push(bytes);
    }
    seeds
}

/// Lines of `--at`: changes that are accepted lie in the run, in order of time.
pub fn at(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let options: Vec<String> = text.lines().map(String::from).collect();
    for scene in scripted_scenes() {
        let Ok(script) = RequestedScript::of(&options, &scene) else { continue };
        let times: Vec<f64> = script.changes.changes().iter().map(|(t, _)| *t).collect();
        assert!(times.iter().all(|t| (0.0..=scene.solver.end_s).contains(t)));
        assert!(times.is_sorted(), "not in order of time");
        assert_eq!([script.words.len(), script.json.len()], [options.len(); 2]);
        let told = serde_json::to_string(&script.json).unwrap();
        assert!(!told.contains("null"), "a number was lost: {told}");
    }
}

/// One scene of each solver.
fn scripted_scenes() -> [CheckedScene; 2] {
    ["explicit", "event"].map(|kind| Scene::base().with(&[("solver.kind", kind)]).unwrap())
}

fn at_seeds() -> Vec<Vec<u8>> {
    let texts = [
        "0.01:pulse\n0:operation.speed_rad_s=300\n",
        "0.05:casing.damping_ratio=0.1\n",
        "1e-2:operation.pulse_n = 5e4\n1e-2:pulse\n-0:pulse\n",
        "0.1:solver.contact=bilateral\n",
        "0.02:operation.speed_ramp_rad_s2=-100\n0.03:excitation.amplitude_nm=1\n",
    ];
    texts.map(Into::into).to_vec()
}
