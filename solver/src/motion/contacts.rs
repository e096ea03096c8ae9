//! The record of contacts that both kinds of solvers keep: which sides touch, since
//! when, the impacts, and the steps that pulled. Constant memory but for the
//! first thousand impacts. And the record of energy.
//!
//! The scheme has an energy of its own between two steps, which changes by exactly the
//! work of the forces over half of two increments, less the damping. A push `P` on a row
//! does the work `P (dg - A Omega dt) + mu P (dv_t - l_b dalpha)` on casing and blades:
//! the first part is stored in a lining or lost in an impact, the second comes from the
//! rotor, and what the rotor gives against friction beyond the third is heat.

use std::ops::AddAssign;

use serde::Serialize;

use crate::model::ContactPolygon;
use crate::numeric::is_zero;
use crate::tolerances::IMPACTS_KEPT;

/// The phase groups in contact at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ActiveSet {
    /// No blade touches.
    #[default]
    Nothing,
    /// One side of the polygon.
    Side(u32),
    /// Two sides, the smaller index first.
    Corner(u32, u32),
    /// Three sides or more: only very compliant blades, or a wrecked step.
    Many,
}

impl ActiveSet {
    /// From the list of sides in contact, in any order and with repeats.
    #[must_use]
    pub fn of(sides: &[u32]) -> Self {
        sides.iter().fold(Self::Nothing, |active_set, &side| active_set.with(side))
    }

    /// With one more side.
    #[must_use]
    pub fn with(self, side: u32) -> Self {
        match self {
            Self::Nothing => Self::Side(side),
            Self::Side(a) if a != side => Self::Corner(a.min(side), a.max(side)),
            Self::Corner(a, b) if a != side && b != side => Self::Many,
            _ => self,
        }
    }

    /// The sides in contact; of many, none is known.
    pub fn sides(self) -> impl Iterator<Item = u32> {
        let sides = match self {
            Self::Nothing | Self::Many => [None, None],
            Self::Side(a) => [Some(a), None],
            Self::Corner(a, b) => [Some(a), Some(b)],
        };
        sides.into_iter().flatten()
    }

    /// Whether this side is among those in contact (unknown counts as yes).
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

/// Puts sides in contact in phase order: at a corner `psi_a` before
/// `psi_b = psi_a + 2 delta`, otherwise by index.
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

/// A blade group meeting the casing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// When \[s\].
    pub t_s: f64,
    /// Which side of the polygon.
    pub side: u32,
}

/// A corner that was held for a while and is not any more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hold {
    /// Its sides.
    pub sides: ActiveSet,
    /// Since when \[s\].
    pub from: f64,
    /// The last time that it was seen in contact \[s\].
    pub until: f64,
    /// When the contact became another \[s\].
    pub ended: f64,
}

impl Hold {
    /// How long it was held \[s\].
    #[must_use]
    pub fn length(&self) -> f64 {
        self.until - self.from
    }
}

/// What touched, when, and how.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactLog {
    /// The sides in contact now.
    pub active_set: ActiveSet,
    /// Since when `active_set` has been what it is \[s\].
    pub since: f64,
    /// The longest that a corner was held, before the contact of now.
    pub longest_hold: Option<Hold>,
    /// Since when something has touched without a break \[s\].
    pub unbroken_since: Option<f64>,
    /// The end of the latest contact, or now while in contact \[s\].
    pub last_contact: Option<f64>,
    /// The latest step with a tensile multiplier \[s\].
    pub last_tensile: Option<f64>,
    /// How many steps had a tensile multiplier.
    pub tensile_steps: u64,
    /// The first impacts, in order of time.
    pub impacts: Vec<Impact>,
    /// How many impacts in all.
    pub impact_count: u64,
}

impl ContactLog {
    /// From `t` on, these sides touch.
    pub fn touch(&mut self, t: f64, active_set: ActiveSet) {
        if active_set != self.active_set {
            if let (ActiveSet::Corner(..), Some(last)) = (self.active_set, self.last_contact)
                && self.longest_hold.is_none_or(|hold| last - self.since > hold.length())
            {
                let sides = self.active_set;
                self.longest_hold = Some(Hold { sides, from: self.since, until: last, ended: t });
            }
            self.active_set = active_set;
            self.since = t;
        }
        if active_set == ActiveSet::Nothing {
            self.unbroken_since = None;
        } else {
            self.unbroken_since.get_or_insert(t);
            self.last_contact = Some(t);
        }
    }

    /// The longest that a corner was held without a break, until now \[s\].
    #[must_use]
    pub fn corner_time(&self) -> f64 {
        let before = self.longest_hold.map_or(0.0, |hold| hold.length());
        match (self.active_set, self.last_contact) {
            (ActiveSet::Corner(..), Some(last)) => before.max(last - self.since),
            _ => before,
        }
    }

    /// A blade group meets the casing at `t`.
    pub fn impact(&mut self, t: f64, side: u32) {
        self.impact_count += 1;
        if self.impacts.len() < IMPACTS_KEPT {
            self.impacts.push(Impact { t_s: t, side });
        }
    }

    /// A step at `t` pulled.
    pub fn tensile(&mut self, t: f64) {
        self.tensile_steps += 1;
        self.last_tensile = Some(t);
    }
}

/// Sums from the start until half a step before the latest \[J\].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct EnergyAccount {
    /// Work of the pulse and of the excitation.
    pub pulse_work_j: f64,
    /// Work that keeps the rotor turning against contact and friction, and that stiffens
    /// the blades as its speed changes.
    pub rotor_work_j: f64,
    /// Work of blades that grow with the speed, on what they touch.
    #[serde(skip_serializing_if = "is_zero")]
    pub growth_work_j: f64,
    /// Dissipated in the damping of the casing.
    pub casing_loss_j: f64,
    /// Dissipated in the damping of the blades.
    pub blade_loss_j: f64,
    /// Heat of friction between tips and casing.
    pub friction_heat_j: f64,
    /// Lost where rigid tips meet the casing.
    pub impact_loss_j: f64,
    /// Gained since the start: in casing, blades and lining.
    pub stored_j: f64,
}

impl AddAssign for EnergyAccount {
    fn add_assign(&mut self, other: Self) {
        self.pulse_work_j += other.pulse_work_j;
        self.rotor_work_j += other.rotor_work_j;
        self.growth_work_j += other.growth_work_j;
        self.casing_loss_j += other.casing_loss_j;
        self.blade_loss_j += other.blade_loss_j;
        self.friction_heat_j += other.friction_heat_j;
        self.impact_loss_j += other.impact_loss_j;
        self.stored_j += other.stored_j;
    }
}

impl EnergyAccount {
    /// What is not accounted for; it goes to zero with the step \[J\].
    #[must_use]
    pub fn residual(&self) -> f64 {
        self.supplied()
            - self.stored_j
            - self.casing_loss_j
            - self.blade_loss_j
            - self.friction_heat_j
            - self.impact_loss_j
    }

    /// Work of pulse, excitation, rotor and growth \[J\].
    #[must_use]
    pub fn supplied(&self) -> f64 {
        self.pulse_work_j + self.rotor_work_j + self.growth_work_j
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn touching_is_the_set_of_sides() {
        assert_eq!(ActiveSet::of(&[]), ActiveSet::Nothing);
        assert_eq!(ActiveSet::of(&[4, 4]), ActiveSet::Side(4));
        assert_eq!(ActiveSet::of(&[16, 15, 16]), ActiveSet::Corner(15, 16));
        assert_eq!(ActiveSet::of(&[1, 2, 3]), ActiveSet::Many);
        for sides in [&[][..], &[4], &[15, 16]] {
            assert_eq!(ActiveSet::of(sides).sides().collect::<Vec<_>>(), sides);
        }
        assert_eq!(ActiveSet::Many.sides().count(), 0);
    }

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

    #[test]
    fn only_the_first_thousand_impacts_are_kept() {
        let mut log = ContactLog::default();
        (0..1500).for_each(|n| log.impact(f64::from(n), 0));
        assert_eq!((log.impacts.len(), log.impact_count), (1000, 1500));
    }
}
