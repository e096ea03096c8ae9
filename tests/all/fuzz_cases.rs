//! The laws of `fuzz_laws` without a fuzzer: on their seeds, on the cases that
//! fuzzing has found (`fuzz/found/TARGET`), and on changes of both that are the
//! same on every machine.

use std::fs;
use std::path::{Path, PathBuf};

use fastrand::Rng;

use crate::fuzz_laws::{TARGETS, Target, words};
use crate::random::{each_case, one_of};

/// The folder of the fuzzer.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz")
}

/// What fuzzing has found, by file name.
fn found(target: &Target) -> Vec<(String, Vec<u8>)> {
    let files = fs::read_dir(folder().join("found").join(target.name)).into_iter().flatten();
    let mut cases: Vec<(String, Vec<u8>)> = files
        .map(|file| file.unwrap().path())
        .map(|path| (path.display().to_string(), fs::read(&path).unwrap()))
        .collect();
    cases.sort();
    cases
}

/// One change of an input; places are parts of its length, in 1/65536.
#[derive(Clone, Debug)]
enum Edit {
    Put(u16, u8),
    Insert(u16, String),
    Remove(u16, u16),
    Repeat(u16, u16, u8),
    Cut(u16),
}

fn any_edit(rng: &mut Rng, words: &[String]) -> Edit {
    let at = rng.u16(..);
    match rng.u8(..5) {
        0 => Edit::Put(at, rng.u8(..)),
        1 => Edit::Insert(at, one_of(rng, words)),
        2 => Edit::Remove(at, rng.u16(..4000)),
        3 => Edit::Repeat(at, rng.u16(..4000), rng.u8(1..4)),
        _ => Edit::Cut(at),
    }
}

fn apply(edit: &Edit, bytes: &mut Vec<u8>) {
    let length = bytes.len();
    let place = |part: u16| length * usize::from(part) / 65536;
    match edit {
        Edit::Put(at, byte) => {
            if let Some(old) = bytes.get_mut(place(*at)) {
                *old = *byte;
            }
        }
        Edit::Insert(at, word) => _ = bytes.splice(place(*at)..place(*at), word.bytes()),
        Edit::Remove(at, part) => {
            bytes.drain(place(*at)..(place(*at) + place(*part)).min(length));
        }
        Edit::Repeat(at, part, times) => {
            let end = (place(*at) + place(*part)).min(length);
            let piece = bytes[place(*at)..end].repeat(usize::from(*times));
            bytes.splice(end..end, piece);
        }
        Edit::Cut(at) => bytes.truncate(place(*at)),
    }
}

/// Runs a law on its seeds, on what was found, and on `cases` changed inputs.
fn holds(name: &str, cases: u64) {
    let target = TARGETS.iter().find(|target| target.name == name).unwrap();
    let seeds = (target.seeds)();
    seeds.iter().for_each(|seed| (target.law)(seed));
    let found = found(target);
    for (file, case) in &found {
        println!("{file}");
        (target.law)(case);
    }
    let starts: Vec<Vec<u8>> =
        seeds.into_iter().chain(found.into_iter().map(|(_, case)| case)).collect();
    let words = words();
    each_case(cases, |rng| {
        let mut bytes = one_of(rng, &starts);
        for _ in 0..rng.u8(1..6) {
            let edit = any_edit(rng, &words);
            println!("{edit:?}");
            apply(&edit, &mut bytes);
        }
        (target.law)(&bytes);
    });
}

#[test]
fn scene_texts() {
    holds("scene", 2000);
}

#[test]
fn values_set_by_text() {
    holds("set", 2500);
}

#[test]
fn ranges_and_axes() {
    holds("range", 4000);
}

#[test]
fn parts_of_maps() {
    holds("part", 500);
}

#[test]
fn changes_of_a_running_motion() {
    holds("at", 2000);
}

#[test]
fn streams_of_keys() {
    holds("keys", 30);
}

/// The seeds and words as files, for a fuzzer.
#[test]
#[ignore = "writes into fuzz/seeds; fuzz/run calls it"]
fn writes_the_seeds() {
    let folder = folder().join("seeds");
    for target in &TARGETS {
        let place = folder.join(target.name);
        fs::create_dir_all(&place).unwrap();
        for (number, seed) in (target.seeds)().iter().enumerate() {
            fs::write(place.join(number.to_string()), seed).unwrap();
        }
    }
    let quoted = |word: &String| {
        let byte = |byte: u8| match byte {
            b'"' | b'\\' => format!("\\{}", char::from(byte)),
            b' '..=b'~' => char::from(byte).to_string(),
            byte => format!("\\x{byte:02X}"),
        };
        format!("\"{}\"\n", word.bytes().map(byte).collect::<String>())
    };
    fs::write(folder.join("words.dict"), words().iter().map(quoted).collect::<String>()).unwrap();
}
