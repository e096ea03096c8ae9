//! Options and limits of earlier versions, each with what answers its question now.

use std::ffi::OsString;

use clap::error::{ContextKind, ContextValue, ErrorKind};

/// An input of an earlier version.
struct Gone {
    /// The command that had it.
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
    gone("hbm", "--fold", "hbm --branches says from which speed soft blades have no corner"),
    gone("hbm", "--follow", STATES),
    gone("hbm", "--over", STATES),
    gone("hbm", "--harmonics", "hbm --slip gives the exact orbit of slip, without a series"),
    gone("hbm", "--omegas", "hbm --compliance has the frequencies beyond every resonance"),
    gone("hbm", "--zetas", "hbm --slip --zeta-casing VALUE says where slip exists at one damping"),
    gone("margins", "--tolerance", "margins --json has the sensitivity of every limit"),
    gone("margins", "lasting_pulse", PULSES),
    gone("margins", "lasting_pulse_unilateral", PULSES),
    gone("margins", "lasting_pulse_bilateral", PULSES),
    gone("margins", "blade_angle", "hbm --speed SPEED has the angles of the blades"),
    gone("margins", "lock_energy", "margins has torque and power that the rotor gives to the wave"),
    gone("figures", POSITIONAL, OWN),
    gone("figures", "--set", OWN),
    gone("map", "--adaptive", "map runs every cell; --no-sensitivity and --shard take less time"),
    gone("map", "--resume", "map --shard K/COUNT computes a share; an interrupted one runs again"),
];

/// What answers `hbm --follow`.
const STATES: &str = "hbm --smooth gives the steady states on a lining at each speed";

/// What draws a scene of one's own.
const OWN: &str = "each figure has its own scene; run, hbm and map --out draw any other";

/// What answers which pulses last.
const PULSES: &str = "margins has the nearest pulse with another verdict; map shows which last";

const fn gone(command: &'static str, name: &'static str, instead: &'static str) -> Gone {
    Gone { command, name, instead }
}

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
}
