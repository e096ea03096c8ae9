//! The one writer of files: what it replaces keeps what it was, what fails leaves
//! the old file and no other.

use std::fs;
use std::io::{Error, ErrorKind, Write};
use std::path::Path;

use rubscope::file::{Written, create, read_text, replace};

/// Writes this text.
fn text(text: &str) -> impl FnOnce(&mut dyn Write) -> std::io::Result<()> {
    move |out| out.write_all(text.as_bytes())
}

/// Writes something, then fails as a full disk does.
fn fails(out: &mut dyn Write) -> std::io::Result<()> {
    out.write_all(&vec![b'x'; 1 << 20])?;
    Err(Error::from(ErrorKind::StorageFull))
}

/// Names in a folder, hidden ones too, in order.
pub fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn a_new_file_and_a_replaced_one_are_told_apart() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.csv");
    assert_eq!(replace(&path, text("one")).unwrap(), Written::New);
    assert_eq!(replace(&path, text("two")).unwrap(), Written::Replaced);
    assert_eq!(fs::read_to_string(&path).unwrap(), "two");
    assert_eq!(names(folder.path()), ["a.csv"]);
}

#[test]
fn a_failure_leaves_the_old_file_and_no_other() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.csv");
    assert_eq!(replace(&path, fails).unwrap_err().kind(), ErrorKind::StorageFull);
    assert_eq!(create(&path, fails).unwrap_err().kind(), ErrorKind::StorageFull);
    assert!(names(folder.path()).is_empty());
    replace(&path, text("old")).unwrap();
    assert_eq!(replace(&path, fails).unwrap_err().kind(), ErrorKind::StorageFull);
    assert_eq!(fs::read_to_string(&path).unwrap(), "old");
    assert_eq!(names(folder.path()), ["a.csv"]);
}

#[test]
fn a_created_file_takes_the_place_of_none() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toml");
    create(&path, text("mine")).unwrap();
    let refused = create(&path, |_| panic!("nothing is to be written")).unwrap_err();
    assert_eq!(refused.kind(), ErrorKind::AlreadyExists);
    assert!(refused.to_string().ends_with("a.toml exists"), "{refused}");
    // Nor of one that comes while it is written.
    let late = folder.path().join("late.toml");
    let refused = create(&late, |out| {
        fs::write(&late, "theirs")?;
        out.write_all(b"mine")
    });
    assert_eq!(refused.unwrap_err().kind(), ErrorKind::AlreadyExists);
    assert_eq!(fs::read_to_string(&late).unwrap(), "theirs");
    assert_eq!(names(folder.path()), ["a.toml", "late.toml"]);
}

#[test]
fn a_file_is_read_up_to_its_limit_and_no_further() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toml");
    fs::write(&path, "12345").unwrap();
    assert_eq!(read_text(&path, 5).unwrap(), "12345");
    assert_eq!(read_text(&path, 4).unwrap_err().to_string(), "allowed are up to 4 bytes");
    fs::write(&path, b"ab\xff").unwrap();
    assert_eq!(read_text(&path, 5).unwrap_err().to_string(), "byte 2 is not UTF-8 text");
    if Path::new("/dev/zero").exists() {
        assert_eq!(
            read_text(Path::new("/dev/zero"), 9).unwrap_err().kind(),
            ErrorKind::FileTooLarge
        );
    }
}

mod unix {
    use super::*;
    use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};

    #[test]
    fn the_mode_stays() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        for mode in [0o600, 0o640, 0o777, 0o4755] {
            fs::write(&path, "old").unwrap();
            fs::set_permissions(&path, fs::Permissions::from_mode(mode)).unwrap();
            replace(&path, text("new")).unwrap();
            assert_eq!(fs::metadata(&path).unwrap().mode() & 0o7777, mode);
            fs::remove_file(&path).unwrap();
        }
    }

    #[test]
    fn links_are_followed_and_stay_links() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("far")).unwrap();
        fs::write(at("far/target.csv"), "old").unwrap();
        symlink("far/target.csv", at("link.csv")).unwrap();
        symlink("link.csv", at("second.csv")).unwrap();
        assert_eq!(replace(&at("second.csv"), text("new")).unwrap(), Written::Replaced);
        assert_eq!(fs::read_to_string(at("far/target.csv")).unwrap(), "new");
        for link in ["link.csv", "second.csv"] {
            assert!(at(link).is_symlink(), "{link}");
        }
        assert_eq!(names(&at("far")), ["target.csv"]);
        symlink("far/none.csv", at("dangling.csv")).unwrap();
        assert_eq!(
            create(&at("dangling.csv"), text("a")).unwrap_err().kind(),
            ErrorKind::AlreadyExists
        );
        let refused = replace(&at("dangling.csv"), text("a")).unwrap_err().to_string();
        assert_eq!(refused, "it is a link to a file that does not exist");
        assert!(rubscope::file::check_place(&at("dangling.csv")).is_err());
        assert!(at("dangling.csv").is_symlink() && names(&at("far")) == ["target.csv"]);
        symlink("loop.csv", at("loop.csv")).unwrap();
        assert!(replace(&at("loop.csv"), text("a")).is_err());
    }

    #[test]
    fn another_hard_link_keeps_the_old_content() {
        let folder = tempfile::tempdir().unwrap();
        let (path, other) = (folder.path().join("a.csv"), folder.path().join("b.csv"));
        fs::write(&path, "old").unwrap();
        fs::hard_link(&path, &other).unwrap();
        assert_eq!(replace(&path, text("new")).unwrap(), Written::Replaced);
        assert_eq!(fs::read_to_string(&path).unwrap(), "new");
        assert_eq!(fs::read_to_string(&other).unwrap(), "old");
        assert_eq!(names(folder.path()), ["a.csv", "b.csv"]);
    }

    #[test]
    fn a_device_is_written_to_and_stays_one() {
        for device in ["/dev/null", "/dev/full"].map(Path::new).iter().filter(|path| path.exists())
        {
            let folder = tempfile::tempdir().unwrap();
            let link = folder.path().join("a.csv");
            symlink(device, &link).unwrap();
            let written = replace(&link, text("bytes"));
            match written {
                Ok(written) => assert_eq!(written, Written::New),
                Err(error) => assert_eq!(error.kind(), ErrorKind::StorageFull),
            }
            assert_eq!(names(folder.path()), ["a.csv"]);
            assert!(!device.metadata().unwrap().is_file() && link.is_symlink());
        }
    }

    /// The rest of the mode of a new file is left to the user's mask.
    #[test]
    fn a_new_file_has_the_mode_of_any_new_file() {
        let folder = tempfile::tempdir().unwrap();
        let (ours, plain) = (folder.path().join("a.csv"), folder.path().join("b.csv"));
        replace(&ours, text("a")).unwrap();
        fs::write(&plain, "a").unwrap();
        assert_eq!(fs::metadata(&ours).unwrap().mode(), fs::metadata(&plain).unwrap().mode());
    }
}
