//! Signals end the explorer in every state, with the terminal restored, even
//! if nobody reads what it writes.

use std::time::Duration;

use crate::pty_support::{SHORT, Start, Terminal};

/// An explorer with a large screen. On a line that is said to be full, no frame waits because the
/// one before it was not read at once.
fn large(line: &str) -> Terminal {
    let arguments = [&SHORT[..], &["--line", line]].concat();
    Start::explorer(&arguments).size(200, 50).locked()
}

/// Tests each case in a thread: most of the time is spent waiting.
fn each_in_its_thread<T: Send>(cases: impl Iterator<Item = T>, test: impl Fn(T) + Sync) {
    std::thread::scope(|scope| {
        for case in cases {
            scope.spawn(|| test(case));
        }
    });
}

/// Signals that end a program: name, number on Linux and on most other systems.
const DEADLY: [(&str, u32); 7] =
    [("INT", 2), ("TERM", 15), ("HUP", 1), ("QUIT", 3), ("ABRT", 6), ("ALRM", 14), ("PROF", 27)];

/// Signals with numbers that differ between systems; these are of Linux.
#[cfg(target_os = "linux")]
const MORE: [(&str, u32); 10] = [
    ("USR1", 10),
    ("USR2", 12),
    ("VTALRM", 26),
    ("XCPU", 24),
    ("SYS", 31),
    ("TRAP", 5),
    ("IO", 29),
    ("PWR", 30),
    ("34", 34),
    ("64", 64),
];
#[cfg(not(target_os = "linux"))]
const MORE: [(&str, u32); 0] = [];

#[test]
fn every_signal_ends_it_with_the_terminal_restored() {
    for (name, number) in DEADLY.into_iter().chain(MORE) {
        let mut terminal = Start::explorer(&SHORT).open();
        terminal.wait_for("? help");
        terminal.signal(name);
        assert_eq!(terminal.wait(), 128 + number, "{name}");
    }
}

#[test]
fn a_signal_ends_it_while_nobody_reads_the_terminal() {
    each_in_its_thread(DEADLY.into_iter().chain(MORE), |(name, number)| {
        let mut terminal = large("full");
        terminal.block();
        terminal.signal(name);
        // It ends although it is not read, and leaves what restores the terminal.
        assert_eq!(terminal.ended().exit_code(), 128 + number, "{name}");
        assert_eq!(terminal.wait(), 128 + number);
    });
}

#[test]
fn keys_are_answered_while_nobody_reads_the_terminal() {
    each_in_its_thread([true, false].into_iter(), |again| {
        let mut terminal = large("auto");
        terminal.block();
        if again {
            // The frame before it and the one that shows this view find no reader for half a
            // second each, longer than is waited for.
            terminal.send("2");
            std::thread::sleep(Duration::from_millis(1200));
            terminal.unblock();
            terminal.wait_for("2 gaps");
            terminal.wait_for("? help");
        }
        terminal.quit("q");
    });
}

#[test]
fn a_signal_ends_it_in_every_state_read_or_not() {
    let states = [
        ("\r12", "12_"),
        ("?", "Type to find"),
        ("g", "Enter begins one"),
        ("s", "save the scene as"),
        (" ", "go on"),
        ("c", "bilateral:"),
        ("f5", "5 map"),
    ];
    let cases = states.iter().flat_map(|state| [(*state, true), (*state, false)]);
    each_in_its_thread(cases, |((keys, seen), read)| {
        let mut terminal = large("full");
        terminal.send(keys);
        terminal.wait_for(seen);
        if !read {
            terminal.block();
        }
        terminal.signal("TERM");
        assert_eq!(terminal.ended().exit_code(), 143, "{keys:?} read: {read}");
        assert_eq!(terminal.wait(), 143);
    });
}

#[test]
fn a_signal_ends_it_while_it_starts_and_while_it_ends() {
    for pause in [0, 1, 2, 3, 5, 8, 12, 20, 35] {
        let mut terminal = Start::explorer(&SHORT).open();
        std::thread::sleep(Duration::from_millis(pause));
        terminal.signal("TERM");
        let status = terminal.ended();
        // Before it begins to listen, the signal ends it as any other program.
        assert!(status.signal().is_some() || status.exit_code() == 143, "{status:?}");
        if status.signal().is_none() {
            terminal.wait();
        }
        terminal.assert_restored();
    }
    for pause in [0, 1, 3, 10] {
        let mut terminal = large("full");
        terminal.send("q");
        std::thread::sleep(Duration::from_millis(pause));
        terminal.signal("TERM");
        let status = terminal.wait();
        assert!([0, 143].contains(&status), "{status}");
    }
}

#[test]
fn a_hang_up_ends_it_with_its_own_status_in_every_state() {
    let states = ["", " ", "?", "s", "\r12", "c", "f", "g", "\u{c}\u{c}"];
    let cases = states.map(|keys| (keys, false)).into_iter().chain([("", true)]);
    each_in_its_thread(cases, |(keys, blocked)| {
        let arguments = [&SHORT[..], &["--line", "full"]].concat();
        let mut terminal = Start::explorer(&arguments).leading().locked();
        terminal.send(keys);
        if blocked {
            terminal.block();
        }
        terminal.hang_up();
        let status = terminal.ended();
        assert_eq!((status.exit_code(), status.signal()), (129, None), "{keys:?} {blocked}");
    });
}

#[test]
fn a_hang_up_while_it_starts_is_never_a_failure() {
    each_in_its_thread(0..4, |first| {
        for moment in (first..40).step_by(4).map(Duration::from_millis) {
            let status = Start::explorer(&SHORT).leading().abandoned(moment);
            // Before it begins to listen, the hang-up ends it as any other program.
            assert!(status.signal().is_some() || status.exit_code() == 129, "{status:?}");
        }
    });
}

/// Runs the explorer as a job of a shell that goes on when the job stops.
fn job(then: &str) -> Terminal {
    let script = format!("set -m; \"$@\"; echo is stopped; {then}");
    let arguments = [&SHORT[..], &["--line", "full"]].concat();
    Start::shell(&script, &arguments).size(100, 30).locked()
}

#[test]
fn it_can_be_stopped_and_continued_in_every_dialog() {
    for (keys, seen) in [
        ("", "? help"),
        ("\r12", "12_"),
        ("s", "save the scene as"),
        ("?", "Type to find"),
        ("g", "Enter begins one"),
    ] {
        let mut terminal = job("read answer; fg; echo ended with $?");
        terminal.wait_for(" LOCKED ");
        terminal.send(keys);
        terminal.wait_for(seen);
        terminal.send("\u{1a}");
        terminal.wait_for("is stopped");
        assert!(!terminal.parser.screen().alternate_screen(), "{keys:?}");
        assert!(!terminal.parser.screen().bracketed_paste(), "{keys:?}");
        // The shell gets no clicks while the job is stopped.
        assert!([1000, 1002, 1003, 1006].into_iter().all(|mode| !terminal.has_mode(mode)));
        terminal.send("\r");
        terminal.wait_for(seen);
        assert!(terminal.parser.screen().alternate_screen(), "{keys:?}");
        assert!(terminal.has_mode(1000) && terminal.has_mode(1006), "{keys:?}");
        terminal.send("\u{3}");
        terminal.wait_for("ended with 0");
        terminal.assert_restored();
    }
}

/// Ends the job and waits for its end; a status above that of TERM says that the
/// job is stopped.
const END: &str = "kill %1; kill -CONT %1; \
                   while wait %1; s=$?; [ $s -gt 143 ]; do sleep 0.1; done; echo ended with $s";

#[test]
fn a_job_in_the_background_can_be_ended() {
    // It stops by itself, once nobody has brought it to the foreground for a second.
    let script = format!("set -m; \"$@\" & wait %1; {END}");
    let mut terminal = Start::shell(&script, &SHORT).open();
    terminal.wait_for("ended with 143");
    terminal.assert_restored();
}

#[test]
fn a_stopped_job_can_be_ended() {
    let mut terminal = job(END);
    terminal.send("\u{1a}");
    terminal.wait_for("ended with 143");
    terminal.assert_restored();
}

#[cfg(target_os = "linux")]
#[test]
fn a_signal_to_stop_is_heard_while_nobody_reads_and_the_screen_comes_back() {
    let mut terminal = job("read answer; fg; echo ended with $?");
    terminal.wait_for(" LOCKED ");
    terminal.follow_the_job();
    terminal.block();
    terminal.signal("TSTP");
    terminal.wait_for_state('T');
    terminal.unblock();
    terminal.wait_for("is stopped");
    terminal.send("\r");
    terminal.wait_for(" LOCKED ");
    terminal.block();
    terminal.signal("TERM");
    terminal.unblock();
    terminal.wait_for("ended with 143");
    terminal.assert_restored();
}

#[cfg(target_os = "linux")]
#[test]
fn a_signal_that_comes_while_it_stops_is_not_lost() {
    // A job that was told to stop, to end and to go on, in this order, ends.
    each_in_its_thread([0, 20, 50, 150].into_iter(), |pause| {
        let script = "set -m; \"$@\"; echo ended with $?; read answer";
        let mut terminal = Start::shell(script, &SHORT).size(100, 30).locked();
        terminal.follow_the_job();
        terminal.block();
        terminal.signal("TSTP");
        std::thread::sleep(Duration::from_millis(pause));
        terminal.signal("TERM");
        terminal.signal("CONT");
        terminal.unblock();
        terminal.wait_for("ended with 14");
        // On a busy machine the shell may have seen it stop, with 148 for 143, before it was told
        // to end, or even after it was told to go on: it ends when it goes on.
        if terminal.state() == Some('T') {
            terminal.signal("CONT");
        }
        terminal.wait_for_state('Z');
    });
}

#[test]
fn without_a_shell_it_is_not_stopped() {
    for leading in [false, true] {
        let start = Start::explorer(&SHORT);
        let mut terminal = if leading { start.leading() } else { start }.locked();
        terminal.send("\u{1a}");
        terminal.wait_for("not suspended: there is no shell to continue it");
        terminal.signal("TSTP");
        terminal.send("?");
        terminal.wait_for("Type to find");
        terminal.signal("TERM");
        assert_eq!(terminal.wait(), 143);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn in_a_container_the_groups_outside_have_no_number() {
    let script =
        "unshare --user --map-root-user --pid --fork true || { echo not allowed; read answer; }
        exec unshare --user --map-root-user --pid --fork \"$@\"";
    let mut terminal = Start::shell(script, &SHORT).open();
    terminal.wait_until("a screen", |screen| {
        ["LOCKED", "not allowed"].iter().any(|text| screen.contents().contains(text))
    });
    // Some machines let nobody but root make a container.
    if terminal.text().contains("not allowed") {
        return;
    }
    terminal.send("\u{1a}");
    terminal.wait_for("not suspended: there is no shell to continue it");
    terminal.quit("q");
}
