//! Where the energy of a motion beyond the paper comes from and goes to
//! (docs/theory.md, section 10).
//!
//! The scheme has an energy of its own between two steps, which changes by exactly the
//! work of the forces over half of two increments, less the damping. A push `P` on a row
//! does the work `P (dg - A Omega dt) + mu P (dv_t - l_b dalpha)` on casing and blades:
//! the first part is stored in a lining or lost in an impact, the second comes from the
//! rotor, and what the rotor gives against friction beyond the third is heat.

use serde::Serialize;

/// Sums from the start until half a step before the latest \[J\].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct EnergyAccount {
    /// Work of the pulse and of the excitation.
    pub pulse_work_j: f64,
    /// Work that keeps the rotor turning against contact and friction.
    pub rotor_work_j: f64,
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

    /// Work of pulse, excitation and rotor \[J\].
    #[must_use]
    pub fn supplied(&self) -> f64 {
        self.pulse_work_j + self.rotor_work_j
    }
}
