//! Records that both kinds of solvers keep: contacts (which sides touch and since when, the
//! impacts, the steps with a pull), in constant memory except for the first impacts; and the energy
//! account.
//!
//! The explicit scheme has an energy of its own between two steps, which changes by exactly the
//! work of the forces over half of two increments, minus the damping. A contact force `P` on a row
//! does the work `P (dg - A Omega dt) + mu P (dv_t - l_b dalpha)` on casing and blades: the first
//! part is stored in a lining or lost in an impact, the second comes from the rotor. What the rotor
//! does against friction beyond the second part is heat.

use serde::Serialize;

use crate::model::ContactPolygon;
use crate::numeric::is_zero;

/// Impacts kept one by one; later ones are only counted, so that a long slip
/// needs no memory.
const IMPACTS_KEPT: usize = 1000;

/// Phase groups in contact at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ActiveSet {
    /// No blade touches.
    #[default]
    Nothing,
    /// One side of the polygon is in contact.
    Side(u32),
    /// Two sides are in contact; the smaller index comes first.
    Corner(u32, u32),
    /// Three or more sides are in contact, which occurs with very compliant blades or too long a
    /// step.
    Many,
}

impl ActiveSet {
    /// Collects a list of sides, in any order and with repetitions.
    #[must_use]
    pub fn of(sides: &[u32]) -> Self {
        sides.iter().fold(Self::Nothing, |active_set, &side| active_set.with(side))
    }

    /// Adds a side.
    #[must_use]
    pub fn with(self, side: u32) -> Self {
        match self {
            Self::Nothing => Self::Side(side),
            Self::Side(a) if a != side => Self::Corner(a.min(side), a.max(side)),
            Self::Corner(a, b) if a != side && b != side => Self::Many,
            _ => self,
        }
    }

    /// Iterates over the sides in contact; `Many` does not know them and yields none.
    pub fn sides(self) -> impl Iterator<Item = u32> {
        let sides = match self {
            Self::Nothing | Self::Many => [None, None],
            Self::Side(a) => [Some(a), None],
            Self::Corner(a, b) => [Some(a), Some(b)],
        };
        sides.into_iter().flatten()
    }

    /// Returns whether a side may be in contact; `Many` answers yes.
    #[must_use]
    pub fn includes(self, side: u32) -> bool {
        match self {
            Self::Nothing => false,
            Self::Side(a) => a == side,
            Self::Corner(a, b) => a == side || b == side,
            Self::Many => true,
        }
    }
}

/// Sorts the sides in contact in phase order: at a corner `psi_a` before `psi_b = psi_a + 2 delta`,
/// otherwise by index.
pub fn in_phase_order(polygon: &ContactPolygon, sides: &mut [(u32, f64)]) {
    sides.sort_by_key(|&(side, _)| side);
    if let [first, second] = sides
        && polygon.has_corners()
        && polygon.next(first.0) != second.0
        && polygon.next(second.0) == first.0
    {
        std::mem::swap(first, second);
    }
}

/// Impact of a blade group on the casing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// Time \[s\].
    pub t_s: f64,
    /// Side of the polygon.
    pub side: u32,
}

/// A period during which the wave was held in a corner, and which has ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hold {
    /// Sides of the corner.
    pub sides: ActiveSet,
    /// Start \[s\].
    pub from: f64,
    /// Last instant at which contact was observed \[s\].
    pub until: f64,
    /// Instant at which another contact was observed \[s\].
    pub ended: f64,
}

impl Hold {
    /// Returns the duration \[s\].
    #[must_use]
    pub fn length(&self) -> f64 {
        self.until - self.from
    }
}

/// Record of contacts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactLog {
    /// Sides in contact now.
    pub active_set: ActiveSet,
    /// Sides in contact until `since`.
    pub before: ActiveSet,
    /// Start of the present `active_set` \[s\].
    pub since: f64,
    /// Longest hold of a corner before the present contact; `None` if there was none.
    pub longest_hold: Option<Hold>,
    /// Start of the present unbroken contact of any sides; `None` while no blade touches \[s\].
    pub unbroken_since: Option<f64>,
    /// End of the latest contact; now, while in contact; `None` before the first contact \[s\].
    pub last_contact: Option<f64>,
    /// Time of the latest step with a tensile multiplier; `None` if there was none \[s\].
    pub last_tensile: Option<f64>,
    /// Number of steps with a tensile multiplier.
    pub tensile_steps: u64,
    /// The first impacts, up to `IMPACTS_KEPT`, in order of time.
    pub impacts: Vec<Impact>,
    /// Number of all impacts.
    pub impact_count: u64,
    /// First instant at which the event solver saw impacts accumulate; `None` if it did not \[s\].
    pub accumulated: Option<f64>,
}

impl ContactLog {
    /// Records that these sides are in contact from `t` on.
    pub fn touch(&mut self, t: f64, active_set: ActiveSet) {
        if active_set != self.active_set {
            if let (ActiveSet::Corner(..), Some(last)) = (self.active_set, self.last_contact)
                && self.longest_hold.is_none_or(|hold| last - self.since > hold.length())
            {
                let sides = self.active_set;
                self.longest_hold = Some(Hold { sides, from: self.since, until: last, ended: t });
            }
            self.before = std::mem::replace(&mut self.active_set, active_set);
            self.since = t;
        }
        if active_set == ActiveSet::Nothing {
            self.unbroken_since = None;
        } else {
            self.unbroken_since.get_or_insert(t);
            self.last_contact = Some(t);
        }
    }

    /// Returns the longest duration for which a corner was held, including the present one \[s\].
    #[must_use]
    pub fn corner_time(&self) -> f64 {
        let before = self.longest_hold.map_or(0.0, |hold| hold.length());
        match (self.active_set, self.last_contact) {
            (ActiveSet::Corner(..), Some(last)) => before.max(last - self.since),
            _ => before,
        }
    }

    /// Records an impact.
    pub fn impact(&mut self, t: f64, side: u32) {
        self.impact_count += 1;
        if self.impacts.len() < IMPACTS_KEPT {
            self.impacts.push(Impact { t_s: t, side });
        }
    }

    /// Records that impacts accumulate.
    pub fn accumulate(&mut self, t: f64) {
        self.accumulated.get_or_insert(t);
    }

    /// Records a step with a pull.
    pub fn tensile(&mut self, t: f64) {
        self.tensile_steps += 1;
        self.last_tensile = Some(t);
    }
}

/// Energies accumulated from the start until half a step before the latest \[J\].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct EnergyAccount {
    /// Work of the pulse and the excitation.
    pub pulse_work_j: f64,
    /// Work of the rotor against contact and friction, and on the stiffness of the blades as the
    /// speed changes.
    pub rotor_work_j: f64,
    /// Work of blades that grow with the speed on the casing they touch.
    #[serde(skip_serializing_if = "is_zero")]
    pub growth_work_j: f64,
    /// Energy dissipated in the casing damping.
    pub casing_loss_j: f64,
    /// Energy dissipated in the blade damping.
    pub blade_loss_j: f64,
    /// Friction heat between tips and casing.
    pub friction_heat_j: f64,
    /// Energy lost in impacts of rigid tips.
    pub impact_loss_j: f64,
    /// Increase of the energy stored in casing, blades and lining.
    pub stored_j: f64,
}

impl EnergyAccount {
    /// Returns the error of the energy balance, which vanishes as the step goes to zero \[J\].
    #[must_use]
    pub fn residual(&self) -> f64 {
        self.supplied()
            - self.stored_j
            - self.casing_loss_j
            - self.blade_loss_j
            - self.friction_heat_j
            - self.impact_loss_j
    }

    /// Returns the work of pulse, excitation, rotor and growth \[J\].
    #[must_use]
    pub fn supplied(&self) -> f64 {
        self.pulse_work_j + self.rotor_work_j + self.growth_work_j
    }
}

/// Energy account of a motion under way.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Ledger {
    /// Flows so far; `stored_j` is not among them.
    pub sums: EnergyAccount,
    /// Energy at the start plus the energy that changes from outside have added \[J\].
    pub start: f64,
    /// Whether the account is kept.
    pub counts: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_break_ends_the_unbroken_contact_and_a_change_of_sides_does_not() {
        let mut log = ContactLog::default();
        log.touch(1.0, ActiveSet::Side(3));
        log.touch(2.0, ActiveSet::Corner(3, 4));
        assert_eq!((log.since, log.unbroken_since), (2.0, Some(1.0)));
        log.touch(3.0, ActiveSet::Nothing);
        assert_eq!((log.unbroken_since, log.last_contact), (None, Some(2.0)));
    }

    #[test]
    fn the_longest_corner_is_remembered() {
        let mut log = ContactLog::default();
        log.touch(1.0, ActiveSet::Corner(3, 4));
        log.touch(3.0, ActiveSet::Corner(3, 4));
        assert_eq!(log.corner_time(), 2.0);
        log.touch(3.5, ActiveSet::Side(4));
        log.touch(4.0, ActiveSet::Corner(4, 5));
        log.touch(4.5, ActiveSet::Corner(4, 5));
        assert_eq!(log.corner_time(), 2.0);
    }
}
