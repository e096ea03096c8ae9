//! Options, limits and scenes of earlier versions, each with what answers its question now.

use std::ffi::OsString;

use clap::error::{ContextKind, ContextValue, ErrorKind};

use rubscope_solver::scene::SceneError;

/// An input of an earlier version.
struct Gone {
    /// The command that had it; empty for a scene, which every command had.
    command: &'static str,
    /// The option or the name as typed; [`POSITIONAL`] stands for any argument that is no option.
    name: &'static str,
    /// The end of the sentence "NAME is gone: ...".
    instead: &'static str,
}

/// The name of an argument that is no option.
const POSITIONAL: &str = "SCENE";

/// Every input of an earlier version that is refused with a hint.
const GONE: &[Gone] = &[
    Gone {
        command: "margins",
        name: "--tolerance",
        instead: "a tolerance moves a limit by its sensitivity times that many per cent; rubscope \
                  margins --json has every sensitivity",
    },
    Gone {
        command: "margins",
        name: "--no-search",
        instead: "nothing is searched any more, so leave it out",
    },
    Gone { command: "margins", name: "lasting_pulse", instead: PULSES },
    Gone { command: "margins", name: "lasting_pulse_unilateral", instead: PULSES },
    Gone { command: "margins", name: "lasting_pulse_bilateral", instead: PULSES },
    Gone {
        command: "margins",
        name: "blade_angle",
        instead: "rubscope hbm --speed SPEED shows the angles of the blades",
    },
    Gone {
        command: "margins",
        name: "lock_energy",
        instead: "torque and power are what the rotor gives to hold the wave",
    },
    Gone { command: "figures", name: "SCENE", instead: OWN },
    Gone { command: "figures", name: "--set", instead: OWN },
];

/// What draws a scene of one's own.
const OWN: &str = "each figure has its own scene; rubscope run, hbm and map --out draw any other";

/// What answers which pulses last.
const PULSES: &str = "rubscope map --pulse FROM:TO:COUNT shows which pulses last";

/// Returns the refusal of a command line with an option or an argument of an earlier version.
pub fn argument(error: &clap::Error, arguments: &[OsString]) -> Option<String> {
    if error.kind() != ErrorKind::UnknownArgument {
        return None;
    }
    let Some(ContextValue::String(typed)) = error.get(ContextKind::InvalidArg) else { return None };
    let command = arguments.get(1)?.to_str()?;
    let name = if typed.starts_with('-') { typed } else { POSITIONAL };
    find(GONE, command, name, &format!("{command} {typed}"))
}

/// Returns the refusal of a name, such as that of a limit, that `command` knew in an earlier
/// version.
pub fn name(command: &str, name: &str) -> Option<String> {
    find(GONE, command, name, name)
}

/// Returns the refusal of a built-in scene of an earlier version.
pub fn scene(error: &SceneError) -> Option<String> {
    match error {
        SceneError::UnknownScene { name, .. } => find(GONE, "", name, &format!("scene {name}")),
        _ => None,
    }
}

fn find(known: &[Gone], command: &str, name: &str, shown: &str) -> Option<String> {
    let found = known.iter().find(|gone| gone.command == command && gone.name == name)?;
    Some(format!("{shown} is gone: {}", found.instead))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_named_with_what_to_ask_instead() {
        let known = [Gone { command: "hbm", name: "--old", instead: "ask hbm --new" }];
        let found = find(&known, "hbm", "--old", "hbm --old");
        assert_eq!(found.as_deref(), Some("hbm --old is gone: ask hbm --new"));
        assert_eq!(find(&known, "run", "--old", "run --old"), None);
        assert_eq!(find(&known, "hbm", "--new", "hbm --new"), None);
    }

    #[test]
    fn what_is_gone_is_not_there() {
        for gone in GONE.iter().filter(|gone| gone.command.is_empty()) {
            assert!(rubscope_solver::scene::Scene::builtin(gone.name).is_err(), "{}", gone.name);
        }
    }
}
