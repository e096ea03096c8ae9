//! All equilibria in the blade frame at a constant speed: rest, contact on one side, and contact in
//! a corner; their branches over speed, and the speeds at which a branch appears, vanishes, becomes
//! tensile or changes its stability (docs/theory.md, section 8). By symmetry one side and one
//! corner represent all `N'`.

use std::borrow::Cow;

use nalgebra::Complex;
use strum::AsRefStr;

use super::corner::Configuration;
use super::equations::{Equations, Scales, Unknowns, Wave};
use super::stability::{at_rest, grows, largest_growth};
use super::{Corner, Form, HarmonicError, error};
use crate::model::Machine;
use crate::numeric::search::try_bisected;

/// Largest number of changes of character that are located between two neighbouring speeds.
const BRANCH_CHANGES: usize = 16;

/// Kind of equilibrium by its contacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, AsRefStr)]
#[strum(serialize_all = "lowercase")]
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, AsRefStr)]
#[strum(serialize_all = "lowercase")]
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
    /// Classifies a steady state by its multipliers, by whether the equality algorithm would hold it
    /// with pulls, by its smallest other gap, and by whether a motion about it grows.
    pub(super) fn of(
        pushes: bool,
        held_by_pulls: bool,
        smallest_gap: f64,
        grows: impl FnOnce() -> bool,
    ) -> Self {
        if !pushes {
            if held_by_pulls { Self::Adhesive } else { Self::Pulls }
        } else if smallest_gap < 0.0 {
            Self::Penetrates
        } else if grows() {
            Self::Unstable
        } else {
            Self::Stable
        }
    }

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
) -> Result<Vec<Equilibrium>, HarmonicError> {
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
) -> Result<Option<Equilibrium>, HarmonicError> {
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
    let wave = Wave::at(machine, speed, true);
    let scales = Scales::new(machine);
    let loads = match kind {
        Kind::Rest => Some(((0.0, 0.0), Vec::new())),
        Kind::Side => on_side(machine, &scales, wave, side),
        Kind::Corner => in_corner(machine, wave, speed, side),
    };
    let Some((z, loads)) = loads else { return Ok(None) };
    let compliance = scales.softness * scales.share;
    let configuration = Configuration::bent(&machine.polygon, z, compliance, &loads);
    judged(machine, kind, speed, &configuration, &loads).map(Some)
}

/// Scaled `z` and contact forces (side, multiplier, lever) of an equilibrium.
type Loaded = ((f64, f64), Vec<(u32, f64, f64)>);

/// Returns the state with contact on one side; `None` with damping at the critical speed, where its
/// contact force is infinite. `(stiffness + i drag) z = -Lambda exp(i phi)` and
/// the closed gap give `Lambda = (stiffness^2 + drag^2)/stiffness` and the lever `drag/stiffness`;
/// the blade angle only turns the direction.
fn on_side(machine: &Machine, scales: &Scales, wave: Wave, side: u32) -> Option<Loaded> {
    let (stiffness, drag) = (wave.stiffness, wave.drag);
    let (multiplier, arm) = if drag == 0.0 {
        (stiffness, 0.0)
    } else {
        (stiffness + drag * drag / stiffness, drag / stiffness)
    };
    if !(multiplier.is_finite() && arm.is_finite()) {
        return None;
    }
    let loads = vec![(side, multiplier, arm)];
    let still =
        Configuration::bent(&machine.polygon, (0.0, 0.0), scales.softness * scales.share, &loads);
    let (c, s) = still.direction(&machine.polygon, side);
    // From z exp(-i phi) = -1 + i arm.
    Some(((-c - arm * s, -s + arm * c), loads))
}

fn in_corner(machine: &Machine, wave: Wave, speed: f64, side: u32) -> Option<Loaded> {
    let corner = Corner::after(&machine.polygon, side).ok()?;
    let equations = Equations::new(machine, corner, Form::Modal, wave, speed);
    let unknowns = equations.locked()?;
    let configuration = equations.configuration(&unknowns);
    Some((configuration.z, loads_of(machine, corner, &configuration, &unknowns)))
}

/// Returns the contact forces of a solution of the corner's equations.
pub(super) fn loads_of(
    machine: &Machine,
    corner: Corner,
    configuration: &Configuration,
    &[.., push_a, push_b, _, _]: &Unknowns,
) -> Vec<(u32, f64, f64)> {
    let load = |side: u32, push: f64| (side, -push, configuration.across(&machine.polygon, side));
    vec![load(corner.a, push_a), load(corner.b, push_b)]
}

/// Evaluates gaps, stability, torque and character of a configuration under its contact forces.
///
/// # Errors
/// The eigenvalues cannot be computed.
pub(super) fn judged(
    machine: &Machine,
    kind: Kind,
    speed: f64,
    configuration: &Configuration,
    loads: &[(u32, f64, f64)],
) -> Result<Equilibrium, HarmonicError> {
    let (polygon, scales) = (&machine.polygon, Scales::new(machine));
    let sides: Vec<u32> = loads.iter().map(|load| load.0).collect();
    let held: Vec<_> = loads.iter().map(|load| (load.0, load.1)).collect();
    let motion = configuration.kept(machine, speed, &held);
    let eigenvalues = match kind {
        Kind::Rest => at_rest(machine, speed),
        _ => motion.eigenvalues().ok_or(HarmonicError::Unsettled { speed })?,
    };
    let open = configuration.smallest_gap(polygon, &sides);
    let pushes = loads.iter().all(|load| load.1 <= 0.0);
    let held_by_pulls = kind == Kind::Corner && machine.contact_can_pull() && motion.closes();
    let character =
        Character::of(pushes, held_by_pulls, open, || grows(&eigenvalues, machine.omega_c));
    let (x, y) = configuration.z;
    // Torque `sum Lambda A`, which is zero at rest.
    let moment_arm = Wave::at(machine, speed, true).drag * (x * x + y * y);
    let torque = machine.nodal_diameters * scales.force * scales.length * moment_arm;
    let angle = if scales.softness > 0.0 { scales.angle / scales.softness } else { 0.0 };
    let contact = |&(side, multiplier, _): &(u32, f64, f64)| GroupContact {
        side,
        blades: polygon.blades_of_side(side),
        multiplier_n: multiplier * scales.force,
    };
    let z_m = [configuration.z.0 * scales.length, configuration.z.1 * scales.length];
    Ok(Equilibrium {
        speed_rad_s: speed,
        kind,
        character,
        admissible: character.is_admissible(),
        stable: character == Character::Stable,
        contacts: loads.iter().map(contact).collect(),
        z_m,
        amplitude_m: z_m[0].hypot(z_m[1]),
        alpha_c_rad: configuration.turn.0 * angle,
        alpha_s_rad: configuration.turn.1 * angle,
        smallest_gap_m: open * scales.length,
        torque_nm: torque,
        power_w: torque * speed,
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

/// Equilibria for a list of speeds. Only the thresholds are stored; states are computed on demand,
/// because they take about a thousand bytes for each speed.
#[derive(Clone, Debug, PartialEq)]
pub struct Branches {
    machine: Machine,
    speeds: Vec<f64>,
    damped: bool,
    /// Thresholds between the smallest and the largest speed, in increasing order of speed.
    pub thresholds: Vec<Threshold>,
    /// Number of equilibria over all speeds.
    pub count: usize,
}

impl Branches {
    /// Computes the branches for a list of speeds \[rad/s\]. Changes between neighbouring speeds
    /// are located by bisection.
    ///
    /// # Errors
    /// As [`equilibria`].
    pub fn over(machine: &Machine, speeds: &[f64], damped: bool) -> Result<Self, HarmonicError> {
        let (machine, thresholds) = (machine.clone(), Vec::new());
        let mut found = Self { machine, speeds: speeds.to_vec(), damped, thresholds, count: 0 };
        for place in 0..speeds.len() {
            found.count += found.states_at(place)?.len();
        }
        let mut sorted = speeds.to_vec();
        sorted.sort_by(f64::total_cmp);
        let mut thresholds = Vec::new();
        for kind in Kind::ALL {
            let character = |speed| -> Result<Character, HarmonicError> {
                Ok(found.at(kind, speed)?.map_or(Character::Absent, |state| state.character))
            };
            for pair in sorted.windows(2) {
                if let [low, high] = *pair {
                    let here = changes(low, high, &character)?.into_iter();
                    thresholds.extend(here.map(|(speed_rad_s, below, above)| Threshold {
                        speed_rad_s,
                        kind,
                        below,
                        above,
                    }));
                }
            }
        }
        thresholds.sort_by(|a, b| a.speed_rad_s.total_cmp(&b.speed_rad_s));
        Ok(Self { thresholds, ..found })
    }

    /// Returns the number of speeds.
    #[must_use]
    pub fn speeds(&self) -> usize {
        self.speeds.len()
    }

    /// Returns every equilibrium at a speed, given by its index in the list.
    ///
    /// # Errors
    /// None, because [`over`](Self::over) has computed these states before.
    pub fn states_at(&self, place: usize) -> Result<Vec<Equilibrium>, HarmonicError> {
        let mut states = Vec::new();
        if let Some(&speed) = self.speeds.get(place) {
            for kind in Kind::ALL {
                states.extend(self.at(kind, speed)?);
            }
        }
        Ok(states)
    }

    fn at(&self, kind: Kind, speed: f64) -> Result<Option<Equilibrium>, HarmonicError> {
        let side = Corner::paper(&self.machine.polygon).map_or(0, |corner| corner.a);
        equilibrium(&self.machine, kind, side, speed, self.damped)
    }
}

/// Returns the changes of `what` between two speeds as far as bisection finds them: the speed, and
/// the values below and above.
pub(super) fn changes<T: Copy + PartialEq>(
    low: f64,
    high: f64,
    what: &impl Fn(f64) -> Result<T, HarmonicError>,
) -> Result<Vec<(f64, T, T)>, HarmonicError> {
    let mut found: Vec<(f64, T, T)> = Vec::new();
    let (mut start, mut before, last) = (low, what(low)?, what(high)?);
    while before != last && found.len() < BRANCH_CHANGES {
        let mut after = last;
        let [_, above] = try_bisected([start, high], 0.0, |speed| {
            let here = what(speed)?;
            let changed = here != before;
            if changed {
                after = here;
            }
            Ok(changed)
        })?;
        match found.last_mut() {
            // A state that exists only at a single speed is not a branch; for example the side at
            // the critical speed, where its contact force is infinite.
            Some(last) if above - last.0 <= 4.0 * f64::EPSILON * above.abs() => last.2 = after,
            _ => found.push((above, before, after)),
        }
        (start, before) = (above, after);
    }
    Ok(found)
}
