//! The branches of equilibria over speed, and the speeds where a branch
//! appears, vanishes, becomes tensile or changes its stability.
//! (docs/theory.md, section 8.)

use serde::Serialize;

use super::equilibria::equilibrium;
use super::{Character, Corner, Equilibrium, HarmonicError, Kind};
use crate::model::Machine;
use crate::numeric::bisection::try_bisected;
use crate::tolerances::BRANCH_CHANGES;

/// A speed at which a branch changes its character.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Threshold {
    /// Where, to the last digit \[rad/s\].
    pub speed_rad_s: f64,
    /// Which branch.
    pub kind: Kind,
    /// What it is below.
    pub below: Character,
    /// What it is above.
    pub above: Character,
}

/// Equilibria over a list of speeds. They are found where they are asked for: all of
/// them at once are a thousand bytes for each speed.
#[derive(Clone, Debug, PartialEq)]
pub struct Branches {
    machine: Machine,
    speeds: Vec<f64>,
    damped: bool,
    /// Where branches change between the smallest and the largest speed, in
    /// order of speed.
    pub thresholds: Vec<Threshold>,
    /// How many equilibria there are at all speeds.
    pub count: usize,
}

impl Branches {
    /// Over these speeds \[rad/s\]; changes are found between neighbouring
    /// ones and then bisected.
    ///
    /// # Errors
    /// A speed that is not finite, or eigenvalues that cannot be computed.
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

    /// How many speeds there are.
    #[must_use]
    pub fn speeds(&self) -> usize {
        self.speeds.len()
    }

    /// Every equilibrium at the speed at a place of the list.
    ///
    /// # Errors
    /// None for what `over` gave.
    pub fn states_at(&self, place: usize) -> Result<Vec<Equilibrium>, HarmonicError> {
        let mut states = Vec::new();
        if let Some(&speed) = self.speeds.get(place) {
            for kind in Kind::ALL {
                states.extend(self.at(kind, speed)?);
            }
        }
        Ok(states)
    }

    /// Every equilibrium at every speed, in the order of the speeds.
    ///
    /// # Errors
    /// None for what `over` gave.
    pub fn states(&self) -> Result<Vec<Equilibrium>, HarmonicError> {
        let mut all = Vec::with_capacity(self.count);
        for place in 0..self.speeds() {
            all.append(&mut self.states_at(place)?);
        }
        Ok(all)
    }

    fn at(&self, kind: Kind, speed: f64) -> Result<Option<Equilibrium>, HarmonicError> {
        let side = Corner::paper(&self.machine.polygon).map_or(0, |corner| corner.a);
        equilibrium(&self.machine, kind, side, speed, self.damped)
    }
}

/// The changes of `what` between two speeds, as far as bisection finds them:
/// the speed, and the values below and above.
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
            // A state at a single speed is not a branch, such as the side at
            // the critical speed, where its push is infinite.
            Some(last) if above - last.0 <= 4.0 * f64::EPSILON * above.abs() => last.2 = after,
            _ => found.push((above, before, after)),
        }
        (start, before) = (above, after);
    }
    Ok(found)
}
