//! All equilibria in the blade frame at a constant speed: rest, contact on one side, and contact in
//! a corner; their branches over speed, and the speeds at which a branch appears, vanishes, becomes
//! tensile or changes its stability (docs/theory.md, section 8). By symmetry one side and one
//! corner represent all `N'`.

use std::borrow::Cow;

use nalgebra::Complex;
use serde::Serialize;

use super::held::{Held, at_rest, grows, largest_growth};
use super::{Corner, Form, error};
use crate::model::Machine;
use crate::numeric::search::try_bisected;
use crate::scene::SceneError;

/// Largest number of changes of character that are located between two neighbouring speeds.
const BRANCH_CHANGES: usize = 16;

/// Kind of equilibrium by its contacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// No contact; the casing is undeformed.
    Rest,
    /// Contact of one phase group.
    Side,
    /// Contact of two neighbouring phase groups.
    Corner,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 3] = [Self::Rest, Self::Side, Self::Corner];
}

/// Whether real contact can hold an equilibrium, or the reason why not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Character {
    /// No such equilibrium exists.
    Absent,
    /// A multiplier is tensile, so real contact cannot hold the state.
    Pulls,
    /// A multiplier is tensile, but both predicted gaps close, so the paper's equality algorithm
    /// holds the state.
    Adhesive,
    /// Another blade would penetrate the casing.
    Penetrates,
    /// Admissible, but a motion that keeps the contacts grows.
    Unstable,
    /// Admissible, and no motion that keeps the contacts grows.
    Stable,
}

impl Character {
    /// Returns whether pushes can hold the state with all other gaps open.
    #[must_use]
    pub fn is_admissible(self) -> bool {
        matches!(self, Self::Unstable | Self::Stable)
    }
}

/// A phase group in contact.
#[derive(Clone, Debug, PartialEq)]
pub struct GroupContact {
    /// Side of the contact polygon.
    pub side: u32,
    /// Blades of the group, numbered from 1.
    pub blades: Vec<u32>,
    /// Sum of the group's multipliers; negative is a push \[N\].
    pub multiplier_n: f64,
}

/// A steady state in the blade frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Equilibrium {
    /// Rotor speed \[rad/s\].
    pub speed_rad_s: f64,
    /// Contacts of the state.
    pub kind: Kind,
    /// Whether real contact can hold the state.
    pub character: Character,
    /// Whether no multiplier is tensile and all other gaps are open.
    pub admissible: bool,
    /// Whether the state is admissible and no motion that keeps the contacts grows.
    pub stable: bool,
    /// Groups in contact.
    pub contacts: Vec<GroupContact>,
    /// Casing displacement in the blade frame, `z = (u_c + i u_s) exp(-i n_d theta)` \[m\].
    pub z_m: [f64; 2],
    /// Amplitude `|z|` of the casing wave \[m\].
    pub amplitude_m: f64,
    /// Cosine coordinate of the blades, `alpha_c` \[rad\].
    pub alpha_c_rad: f64,
    /// Sine coordinate of the blades, `alpha_s` \[rad\].
    pub alpha_s_rad: f64,
    /// Smallest gap of the groups that are not in contact; negative if one penetrates, infinite if
    /// there are none \[m\].
    pub smallest_gap_m: f64,
    /// Torque of the rotor, `sum Lambda A` \[N m\].
    pub torque_nm: f64,
    /// Power of the rotor, equal to that of the casing damping, `d_c nu^2 |z|^2` \[W\].
    pub power_w: f64,
    /// Largest real part of the eigenvalues; negative if every motion that keeps the contacts
    /// decays \[1/s\].
    pub growth_per_s: f64,
    /// Eigenvalues of the motion that keeps the contacts \[1/s\]; written as `[real, imaginary]` in
    /// reports.
    pub eigenvalues_per_s: Vec<Complex<f64>>,
}

/// Returns all existing equilibria at one speed \[rad/s\], rest first. The side is the first one of
/// the default corner.
///
/// ```
/// use rubscope_solver::harmonic::{Character, Kind, equilibria};
/// use rubscope_solver::scene::Scene;
///
/// let machine = Scene::builtin("paper-nd3")?.machine();
/// let states = equilibria(&machine, 500.0, true)?;
/// let found: Vec<_> = states.iter().map(|state| (state.kind, state.character)).collect();
/// assert_eq!(found, [
///     (Kind::Rest, Character::Stable),
///     (Kind::Side, Character::Unstable), // a saddle: the wave slides to a corner
///     (Kind::Corner, Character::Stable),
/// ]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// The speed is not finite, the tips are inclined or rub, the disk modes have other nodal
/// diameters, or eigenvalues cannot be computed.
pub fn equilibria(
    machine: &Machine,
    speed: f64,
    damped: bool,
) -> Result<Vec<Equilibrium>, SceneError> {
    let corner = Corner::paper(&machine.polygon).ok();
    let side = corner.map_or(0, |corner| corner.a);
    let all = Kind::ALL.map(|kind| equilibrium(machine, kind, side, speed, damped));
    let mut found = Vec::new();
    for state in all {
        found.extend(state?);
    }
    Ok(found)
}

/// Returns the equilibrium of one kind at a speed \[rad/s\], on `side` or in the corner between it
/// and the next one; `None` if there is none, or if the blades have grown into the casing.
///
/// # Errors
/// As [`equilibria`].
pub fn equilibrium(
    machine: &Machine,
    kind: Kind,
    side: u32,
    speed: f64,
    damped: bool,
) -> Result<Option<Equilibrium>, SceneError> {
    error::refuse_endless(&[speed])?;
    error::refuse_other_diameters(machine)?;
    error::refuse_tips(machine, "0 where every equilibrium is asked; the lock takes it")?;
    let machine = machine.at(speed);
    let machine = if damped { machine } else { Cow::Owned(machine.into_owned().undamped()) };
    let machine = &*machine;
    if machine.changes_with_speed() && machine.clearance() <= 0.0 {
        // The blades have grown into the casing.
        return Ok(None);
    }
    let corner = || Corner::after(&machine.polygon, side).ok();
    let held = match kind {
        Kind::Rest => Some(Held::rest(machine, speed)),
        Kind::Side => Held::on_side(machine, speed, side),
        Kind::Corner => {
            corner().and_then(|corner| Held::in_corner(machine, speed, corner, Form::Modal))
        }
    };
    held.map(|held| judged(machine, kind, speed, &held)).transpose()
}

/// Evaluates gaps, stability, torque and character of a state.
///
/// # Errors
/// The eigenvalues cannot be computed.
pub(super) fn judged(
    machine: &Machine,
    kind: Kind,
    speed: f64,
    held: &Held,
) -> Result<Equilibrium, SceneError> {
    let eigenvalues = match kind {
        Kind::Rest => at_rest(machine, speed),
        _ => held.eigenvalues().ok_or_else(|| error::unsettled(speed))?,
    };
    let open = held.smallest_gap(machine);
    let character = held.character(machine, open, || grows(&eigenvalues, machine.omega_c));
    let contact = |(&side, &multiplier_n): (&u32, &f64)| GroupContact {
        side,
        blades: machine.polygon.blades_of_side(side),
        multiplier_n,
    };
    let [x, y, alpha_c_rad, alpha_s_rad]: [f64; 4] = held.at.into();
    let torque_nm = held.torque();
    Ok(Equilibrium {
        speed_rad_s: speed,
        kind,
        character,
        admissible: character.is_admissible(),
        stable: character == Character::Stable,
        contacts: held.sides.iter().zip(&held.multipliers).map(contact).collect(),
        z_m: [x, y],
        amplitude_m: held.amplitude(),
        alpha_c_rad,
        alpha_s_rad,
        smallest_gap_m: open,
        torque_nm,
        power_w: torque_nm * speed,
        growth_per_s: largest_growth(&eigenvalues),
        eigenvalues_per_s: eigenvalues,
    })
}

/// A speed at which a branch changes its character.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Threshold {
    /// Rotor speed, to the last digit \[rad/s\].
    pub speed_rad_s: f64,
    /// Kind of the equilibria on the branch.
    pub kind: Kind,
    /// Character below this speed.
    pub below: Character,
    /// Character above this speed.
    pub above: Character,
}

/// Equilibria for a list of speeds, and where they change.
#[derive(Clone, Debug, PartialEq)]
pub struct Branches {
    /// Every equilibrium at each speed.
    pub states: Vec<Equilibrium>,
    /// Thresholds between the smallest and the largest speed, in increasing order of speed.
    pub thresholds: Vec<Threshold>,
}

impl Branches {
    /// Computes the branches for a list of speeds \[rad/s\]. Changes between neighbouring speeds
    /// are located by bisection.
    ///
    /// # Errors
    /// As [`equilibria`].
    pub fn over(machine: &Machine, speeds: &[f64], damped: bool) -> Result<Self, SceneError> {
        let mut states = Vec::new();
        for &speed in speeds {
            states.extend(equilibria(machine, speed, damped)?);
        }
        let side = Corner::paper(&machine.polygon).map_or(0, |corner| corner.a);
        let mut thresholds = Vec::new();
        for kind in Kind::ALL {
            let character = |speed| -> Result<Character, SceneError> {
                let state = equilibrium(machine, kind, side, speed, damped)?;
                Ok(state.map_or(Character::Absent, |state| state.character))
            };
            let found = changes(speeds, &character)?.into_iter();
            thresholds.extend(found.map(|(speed_rad_s, below, above)| Threshold {
                speed_rad_s,
                kind,
                below,
                above,
            }));
        }
        thresholds.sort_by(|a, b| a.speed_rad_s.total_cmp(&b.speed_rad_s));
        Ok(Self { states, thresholds })
    }
}

/// Returns the changes of `what` between neighbours of a list of speeds, as far as bisection finds
/// them: the speed, and the values below and above.
pub(super) fn changes<T: Copy + PartialEq>(
    speeds: &[f64],
    what: &impl Fn(f64) -> Result<T, SceneError>,
) -> Result<Vec<(f64, T, T)>, SceneError> {
    let mut sorted = speeds.to_vec();
    sorted.sort_by(f64::total_cmp);
    let known = sorted.iter().map(|&speed| Ok((speed, what(speed)?)));
    let known = known.collect::<Result<Vec<(f64, T)>, SceneError>>()?;
    let mut all = Vec::new();
    for pair in known.windows(2) {
        let ([(mut start, mut before), (high, last)], first) = ([pair[0], pair[1]], all.len());
        while before != last && all.len() - first < BRANCH_CHANGES {
            let mut after = last;
            let [_, above] = try_bisected([start, high], 0.0, |speed| {
                let here = what(speed)?;
                let changed = here != before;
                if changed {
                    after = here;
                }
                Ok(changed)
            })?;
            match all[first..].last_mut() {
                // A state that exists only at a single speed is not a branch; for example the side
                // at the critical speed, where its contact force is infinite.
                Some((at, _, now)) if above - *at <= 4.0 * f64::EPSILON * above.abs() => {
                    *now = after;
                }
                _ => all.push((above, before, after)),
            }
            (start, before) = (above, after);
        }
    }
    Ok(all)
}
