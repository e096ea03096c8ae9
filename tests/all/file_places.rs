//! Places where no file can be written are found without leaving anything there.

use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use rubscope::file::{check_place, replace};

use crate::file_writer::names;

/// Both the trial and the writer refuse; returns the reason.
fn refused(path: &Path) -> std::io::Error {
    let error = check_place(path).unwrap_err();
    let written = replace(path, |out| out.write_all(b"new")).unwrap_err();
    assert_eq!((error.kind(), error.to_string()), (written.kind(), written.to_string()));
    error
}

#[test]
fn a_place_is_tried_and_left_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    assert!(check_place(&at("new.csv")).is_ok() && names(folder.path()).is_empty());
    fs::write(at("old.csv"), "old").unwrap();
    assert!(check_place(&at("old.csv")).is_ok());
    assert_eq!(fs::read_to_string(at("old.csv")).unwrap(), "old");
    assert_eq!(names(folder.path()), ["old.csv"]);
}

#[test]
fn places_that_take_no_file_have_a_reason() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("file"), "").unwrap();
    assert_eq!(refused(&at("none/a.csv")).kind(), ErrorKind::NotFound);
    assert_eq!(refused(&at("file/a.csv")).kind(), ErrorKind::NotADirectory);
    assert_eq!(refused(folder.path()).kind(), ErrorKind::IsADirectory);
    assert_eq!(refused(&at("new/")).kind(), ErrorKind::IsADirectory);
    assert_eq!(refused(Path::new("..")).kind(), ErrorKind::IsADirectory);
    assert_eq!(refused(Path::new("")).to_string(), "the name is empty");
    assert_eq!(refused(&at(&"long".repeat(100))).kind(), ErrorKind::InvalidFilename);
    assert_eq!(names(folder.path()), ["file"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_folder_that_takes_no_file_is_found_by_trying() {
    // A superuser is refused by this one too.
    assert!(check_place(Path::new("/proc/a.csv")).is_err());
    let folder = tempfile::tempdir().unwrap();
    let closed = folder.path().join("closed");
    fs::create_dir(&closed).unwrap();
    fs::write(closed.join("open.csv"), "old").unwrap();
    fs::set_permissions(&closed, std::os::unix::fs::PermissionsExt::from_mode(0o555)).unwrap();
    if fs::write(closed.join("probe"), "").is_ok() {
        println!("skipped: a superuser writes into any folder");
        return;
    }
    assert_eq!(refused(&closed.join("a.csv")).kind(), ErrorKind::PermissionDenied);
    // Nor is a file replaced that is there and could be written.
    assert_eq!(refused(&closed.join("open.csv")).kind(), ErrorKind::PermissionDenied);
    assert_eq!(fs::read(closed.join("open.csv")).unwrap(), b"old");
    assert_eq!(names(&closed), ["open.csv"]);
}
