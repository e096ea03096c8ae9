//! A machine that changes with the rotor speed (docs/theory.md, section 10): blades stiffen,
//! `omega^2 + B Omega^2` (Southwell), and grow, `g0 - c Omega^2`. Damping coefficients,
//! arms and friction stay. All that asks for the machine at a speed asks `Machine::at`.

use std::borrow::Cow;

use super::{BladedDisk, Casing, Machine, Number};

/// How a machine changes with the speed, and what it is at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spin<T> {
    /// `B`.
    pub stiffening: T,
    /// `c` \[m s^2\].
    pub clearance_loss: T,
    /// Clearance \[m\], frequencies \[rad/s\] and damping ratio at rest.
    pub clearance: T,
    pub omega_bd: T,
    pub omega_bd_max: T,
    pub blade_damping_ratio: T,
    /// `B Omega^2` at the speed that the machine is taken at \[rad^2/s^2\].
    pub added: T,
}

impl<T: Number> Spin<T> {
    /// Of a machine at rest; none where nothing changes.
    pub fn of(disk: &BladedDisk<T>, casing: &Casing<T>, machine: &Machine<T>) -> Option<Self> {
        let (stiffening, clearance_loss) =
            (disk.centrifugal_stiffening, casing.clearance_loss_m_s2);
        (stiffening.re() != 0.0 || clearance_loss.re() != 0.0).then(|| Self {
            stiffening,
            clearance_loss,
            clearance: machine.clearance,
            omega_bd: machine.omega_bd,
            omega_bd_max: machine.omega_bd_max,
            blade_damping_ratio: machine.blade_damping_ratio,
            added: T::zero(),
        })
    }

    /// Each number by a function.
    pub fn map<U>(self, of: impl Fn(T) -> U) -> Spin<U> {
        Spin {
            stiffening: of(self.stiffening),
            clearance_loss: of(self.clearance_loss),
            clearance: of(self.clearance),
            omega_bd: of(self.omega_bd),
            omega_bd_max: of(self.omega_bd_max),
            blade_damping_ratio: of(self.blade_damping_ratio),
            added: of(self.added),
        }
    }
}

impl<T: Number> Machine<T> {
    /// The machine at a rotor speed, whatever speed it was taken at before \[rad/s\].
    #[must_use]
    pub fn at(&self, speed: T) -> Cow<'_, Self> {
        if self.spin.is_none() {
            return Cow::Borrowed(self);
        }
        let mut here = self.clone();
        here.turn_at(speed);
        Cow::Owned(here)
    }

    /// Becomes the machine at a rotor speed \[rad/s\].
    pub fn turn_at(&mut self, speed: T) {
        let Some(spin) = &mut self.spin else { return };
        let square = speed * speed;
        spin.added = spin.stiffening * square;
        let stiffer = |omega: T| (omega * omega + spin.added).sqrt();
        self.omega_bd = stiffer(spin.omega_bd);
        self.omega_bd_max = stiffer(spin.omega_bd_max);
        self.blade_modal_stiffness = self.omega_bd * self.omega_bd * self.blade_modal_mass;
        // Of the damping coefficient at rest.
        self.blade_damping_ratio = spin.blade_damping_ratio * spin.omega_bd / self.omega_bd;
        self.clearance = spin.clearance - spin.clearance_loss * square;
        self.polygon.clearance = self.clearance.re();
    }

    /// Whether it changes with the speed.
    #[must_use]
    pub fn changes_with_speed(&self) -> bool {
        self.spin.is_some()
    }

    /// What every blade frequency squared has more than at rest, `B Omega^2`
    /// \[rad^2/s^2\].
    #[must_use]
    pub fn stiffened_by(&self) -> T {
        self.spin.map_or_else(T::zero, |spin| spin.added)
    }

    /// `B`.
    #[must_use]
    pub fn stiffening(&self) -> T {
        self.spin.map_or_else(T::zero, |spin| spin.stiffening)
    }

    /// `c` \[m s^2\].
    #[must_use]
    pub fn clearance_loss(&self) -> T {
        self.spin.map_or_else(T::zero, |spin| spin.clearance_loss)
    }

    /// `omega_bd` of the disk at rest \[rad/s\].
    #[must_use]
    pub fn omega_bd_at_rest(&self) -> T {
        self.spin.map_or(self.omega_bd, |spin| spin.omega_bd)
    }

    /// Modal stiffness of the blades at rest \[N m/rad\].
    #[must_use]
    pub fn blade_stiffness_at_rest(&self) -> T {
        let omega = self.omega_bd_at_rest();
        omega * omega * self.blade_modal_mass
    }

    /// Clearance of the rotor at rest, `R_c - l_b` \[m\].
    #[must_use]
    pub fn clearance_at_rest(&self) -> T {
        self.spin.map_or(self.clearance, |spin| spin.clearance)
    }

    /// The speed at which the longest blade that grows reaches the innermost place of a casing at
    /// rest, `sqrt((g0 - e - max b)/c)`; none where it never does, or does at rest \[rad/s\].
    #[must_use]
    pub fn touching_speed(&self) -> Option<T> {
        let left = self.clearance_at_rest() - self.most_uneven();
        let loss = self.clearance_loss();
        (left.re() > 0.0 && loss.re() > 0.0).then(|| (left / loss).sqrt())
    }

    /// The speed at which the clearance is lost, as a magnitude; none where it never is,
    /// or is not there at rest \[rad/s\].
    #[must_use]
    pub fn closing_speed(&self) -> Option<T> {
        let spin = self.spin.filter(|spin| spin.clearance.re() > 0.0)?;
        (spin.clearance_loss.re() > 0.0).then(|| (spin.clearance / spin.clearance_loss).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn machine(stiffening: f64, loss: f64) -> Machine {
        let disk = BladedDisk { centrifugal_stiffening: stiffening, ..BladedDisk::default() };
        let casing = Casing { clearance_loss_m_s2: loss, ..Casing::default() };
        Machine::new(&disk, &casing, 3)
    }

    #[test]
    fn a_machine_that_stays_the_same_is_borrowed() {
        let still = machine(0.0, 0.0);
        assert!(matches!(still.at(500.0), Cow::Borrowed(_)));
        assert!(!still.changes_with_speed() && still.closing_speed().is_none());
    }

    #[test]
    fn blades_stiffen_and_their_damping_coefficient_stays() {
        let (still, machine) = (machine(0.0, 0.0), machine(1.5, 0.0));
        let fast = machine.at(500.0);
        let square = still.omega_bd * still.omega_bd + 1.5 * 500.0 * 500.0;
        assert!((fast.omega_bd / square.sqrt() - 1.0).abs() < 1e-15);
        let stiffness = square * still.blade_modal_mass;
        assert!((fast.blade_modal_stiffness / stiffness - 1.0).abs() < 1e-15);
        assert_eq!(fast.blade_modal_damping, still.blade_modal_damping);
        let coefficient = 2.0 * fast.blade_damping_ratio * fast.omega_bd * fast.blade_modal_mass;
        assert!((coefficient / still.blade_modal_damping - 1.0).abs() < 1e-15);
        assert_eq!(fast.stiffened_by(), 375e3);
    }

    #[test]
    fn the_clearance_closes_with_the_square_of_the_speed() {
        let machine = machine(0.0, 1e-10);
        assert!((machine.at(-500.0).clearance() - 75e-6).abs() < 1e-16);
        assert_eq!(machine.at(500.0).polygon.clearance, machine.at(500.0).clearance());
        assert!((machine.closing_speed().unwrap() - 1e3).abs() < 1e-9);
        // As often as one likes, and back.
        assert_eq!(*machine.at(500.0).at(0.0), *machine.at(0.0));
        assert_eq!(machine.at(400.0).at(500.0), machine.at(500.0));
    }
}
