//! Files are opened in a thread of their own: a pipe without a reader or a
//! network that does not answer blocks that thread, not the screen.

use std::io::{ErrorKind, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::mpsc::{Sender, channel};
use std::thread;
use std::time::Duration;

use super::events::ScreenEvent;
use super::scenes::FoundScenes;
use crate::file;

/// Name of the thread: the panic hook leaves the screen alone for it.
pub const FILES_NAME: &str = "rubscope-files";

/// How long the end of the program waits for files.
const MOMENT: Duration = Duration::from_millis(500);

/// A file to write.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileJob {
    /// Where.
    pub path: PathBuf,
    /// What.
    pub content: String,
    /// Whether a file that exists may be replaced.
    pub replace: bool,
}

/// How it went.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FileResult {
    /// The file is complete.
    Written,
    /// There is a file already; nothing was written.
    Exists,
    /// The reason; nothing was written.
    Failed(String),
}

impl FileJob {
    /// Writes the file, completely or not at all. Only a regular file is
    /// replaced; anything else is not even opened.
    pub fn run(&self) -> FileResult {
        let kind = std::fs::metadata(&self.path);
        match kind {
            Ok(kind) if kind.is_dir() => return FileResult::Failed("it is a directory".into()),
            Ok(kind) if !kind.is_file() => {
                return FileResult::Failed("it is a pipe or a device, not a file".into());
            }
            Ok(_) if !self.replace => return FileResult::Exists,
            _ => {}
        }
        let write = |out: &mut dyn Write| out.write_all(self.content.as_bytes());
        let written = if self.replace {
            file::replace(&self.path, write).map(|_| ())
        } else {
            file::create(&self.path, write)
        };
        match written {
            Ok(()) => FileResult::Written,
            Err(error) if error.kind() == ErrorKind::AlreadyExists => FileResult::Exists,
            Err(error) => FileResult::Failed(error.to_string()),
        }
    }
}

/// Starts the thread that writes a file; its result comes as an event, unless
/// there is no thread.
pub fn write_aside(job: FileJob, events: Sender<ScreenEvent>) -> Option<FileResult> {
    let work = move || {
        let result = catch_unwind(AssertUnwindSafe(|| job.run()))
            .unwrap_or_else(|_| FileResult::Failed("the program has an error".into()));
        // Without a receiver the program is about to end.
        let _ = events.send(ScreenEvent::Written(result));
    };
    let started = thread::Builder::new().name(FILES_NAME.into()).spawn(work);
    started.err().map(|error| FileResult::Failed(error.to_string()))
}

/// Starts the thread that reads the scenes of a directory; they come as an event,
/// unless there is no thread.
pub fn find_aside(directory: PathBuf, events: Sender<ScreenEvent>) -> Option<FoundScenes> {
    let failed = |reason: String| FoundScenes { missing: Some(reason), ..FoundScenes::default() };
    let work = move || {
        let found = catch_unwind(AssertUnwindSafe(|| FoundScenes::of(&directory)))
            .unwrap_or_else(|_| failed("the program has an error".into()));
        // Without a receiver the program is about to end.
        let _ = events.send(ScreenEvent::Scenes(found));
    };
    let started = thread::Builder::new().name(FILES_NAME.into()).spawn(work);
    started.err().map(|error| failed(error.to_string()))
}

/// Finishes the change of a file that is under way, and removes what an
/// unfinished one would leave behind; waits only a moment for a disk or a network
/// that does not answer.
pub fn tidy_up() {
    let (done, wait) = channel();
    let work = move || {
        file::settle(MOMENT);
        // Without a receiver the moment is over.
        let _ = done.send(());
    };
    if thread::Builder::new().name(FILES_NAME.into()).spawn(work).is_ok() {
        let _ = wait.recv_timeout(MOMENT);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_regular_files_are_replaced_and_only_if_asked() {
        let folder = tempfile::tempdir().unwrap();
        let job = |name: &str, replace| FileJob {
            path: folder.path().join(name),
            content: "new".into(),
            replace,
        };
        assert_eq!(job("a.toml", false).run(), FileResult::Written);
        std::fs::write(folder.path().join("a.toml"), "old").unwrap();
        assert_eq!(job("a.toml", false).run(), FileResult::Exists);
        assert_eq!(std::fs::read(folder.path().join("a.toml")).unwrap(), b"old");
        assert_eq!(job("a.toml", true).run(), FileResult::Written);
        assert_eq!(std::fs::read(folder.path().join("a.toml")).unwrap(), b"new");
        for replace in [false, true] {
            let FileResult::Failed(reason) = job("", replace).run() else { panic!() };
            assert_eq!(reason, "it is a directory");
            let device = FileJob { path: "/dev/null".into(), ..job("", replace) };
            let FileResult::Failed(reason) = device.run() else { panic!() };
            assert_eq!(reason, "it is a pipe or a device, not a file");
        }
        assert!(matches!(job("none/a.toml", false).run(), FileResult::Failed(_)));
    }
}
