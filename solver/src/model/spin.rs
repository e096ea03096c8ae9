//! Machine properties that change with the rotor speed (docs/theory.md, section 10).
//!
//! Blade frequencies rise by centrifugal stiffening, `omega^2 + B Omega^2` (Southwell), and the
//! clearance falls by blade growth, `g0 - c Omega^2`. Damping coefficients, levers and friction do
//! not change. [`Machine::at`] evaluates the machine at a speed.

use std::borrow::Cow;

use super::{BladedDisk, Casing, Machine};

/// Speed dependence of a machine, together with its values at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spin {
    /// Centrifugal stiffening `B`.
    pub stiffening: f64,
    /// Loss of clearance `c` \[m s^2\].
    pub clearance_loss: f64,
    /// Values at rest: clearance \[m\], frequencies \[rad/s\] and damping ratio.
    pub clearance: f64,
    pub omega_bd: f64,
    pub omega_bd_max: f64,
    pub blade_damping_ratio: f64,
    /// `B Omega^2` at the speed of the last evaluation \[rad^2/s^2\].
    pub added: f64,
}

impl Spin {
    /// Stores the values of a machine at rest; `None` if nothing changes with speed.
    pub fn new(disk: &BladedDisk, casing: &Casing, machine: &Machine) -> Option<Self> {
        let (stiffening, clearance_loss) =
            (disk.centrifugal_stiffening, casing.clearance_loss_m_s2);
        (stiffening != 0.0 || clearance_loss != 0.0).then_some(Self {
            stiffening,
            clearance_loss,
            clearance: machine.clearance,
            omega_bd: machine.omega_bd,
            omega_bd_max: machine.omega_bd_max,
            blade_damping_ratio: machine.blade_damping_ratio,
            added: 0.0,
        })
    }
}

impl Machine {
    /// Returns the machine at a rotor speed \[rad/s\]. The result does not depend on earlier
    /// evaluations, because values at rest are kept.
    #[must_use]
    pub fn at(&self, speed: f64) -> Cow<'_, Self> {
        if self.spin.is_none() {
            return Cow::Borrowed(self);
        }
        let mut here = self.clone();
        here.turn_at(speed);
        Cow::Owned(here)
    }

    /// Sets the machine to a rotor speed \[rad/s\].
    pub fn turn_at(&mut self, speed: f64) {
        let Some(spin) = &mut self.spin else { return };
        let square = speed * speed;
        spin.added = spin.stiffening * square;
        let stiffer = |omega: f64| (omega * omega + spin.added).sqrt();
        self.omega_bd = stiffer(spin.omega_bd);
        self.omega_bd_max = stiffer(spin.omega_bd_max);
        self.blade_modal_stiffness = self.omega_bd * self.omega_bd * self.blade_modal_mass;
        // The damping coefficient stays that at rest, so the ratio falls as the frequency rises.
        self.blade_damping_ratio = spin.blade_damping_ratio * spin.omega_bd / self.omega_bd;
        self.clearance = spin.clearance - spin.clearance_loss * square;
        self.polygon.clearance = self.clearance;
    }

    /// Returns whether anything changes with the rotor speed.
    #[must_use]
    pub fn changes_with_speed(&self) -> bool {
        self.spin.is_some()
    }

    /// Returns the increase of every squared blade frequency over rest, `B Omega^2` \[rad^2/s^2\].
    #[must_use]
    pub fn stiffened_by(&self) -> f64 {
        self.spin.map_or(0.0, |spin| spin.added)
    }

    /// Returns the centrifugal stiffening `B`.
    #[must_use]
    pub fn stiffening(&self) -> f64 {
        self.spin.map_or(0.0, |spin| spin.stiffening)
    }

    /// Returns the loss of clearance `c` \[m s^2\].
    #[must_use]
    pub fn clearance_loss(&self) -> f64 {
        self.spin.map_or(0.0, |spin| spin.clearance_loss)
    }

    /// Returns the blade frequency `omega_bd` at rest \[rad/s\].
    #[must_use]
    pub fn omega_bd_at_rest(&self) -> f64 {
        self.spin.map_or(self.omega_bd, |spin| spin.omega_bd)
    }

    /// Returns the modal stiffness of the blades at rest \[N m/rad\].
    #[must_use]
    pub fn blade_stiffness_at_rest(&self) -> f64 {
        let omega = self.omega_bd_at_rest();
        omega * omega * self.blade_modal_mass
    }

    /// Returns the clearance at rest, `R_c - l_b` \[m\].
    #[must_use]
    pub fn clearance_at_rest(&self) -> f64 {
        self.spin.map_or(self.clearance, |spin| spin.clearance)
    }

    /// Returns the speed at which the longest blade reaches the innermost point of the undeformed
    /// casing, `sqrt((g0 - e - max b)/c)` \[rad/s\]. `None` if it never does, or already does at
    /// rest.
    #[must_use]
    pub fn touching_speed(&self) -> Option<f64> {
        let left = self.clearance_at_rest() - self.most_uneven();
        let loss = self.clearance_loss();
        (left > 0.0 && loss > 0.0).then(|| (left / loss).sqrt())
    }

    /// Returns the speed at which the clearance closes, as a magnitude \[rad/s\]. `None` if it
    /// never does, or is closed at rest.
    #[must_use]
    pub fn closing_speed(&self) -> Option<f64> {
        let spin = self.spin.filter(|spin| spin.clearance > 0.0)?;
        (spin.clearance_loss > 0.0).then(|| (spin.clearance / spin.clearance_loss).sqrt())
    }
}
