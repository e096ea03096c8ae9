//! Blades and casing as one where they touch (docs/theory.md, section 10): the
//! compliance that a travelling wave of pushes meets.

use nalgebra::Complex;

use crate::model::Machine;

/// The joint of blades and casing at one rotor speed.
#[derive(Clone, Copy, Debug)]
pub struct Joint<'a> {
    /// The machine, with its friction.
    pub machine: &'a Machine,
    /// Wave frequency in the frame of the blades, `nu = n_d Omega` \[rad/s\].
    pub nu: f64,
    /// Friction that the casing feels, `mu_c`.
    pub casing_friction: f64,
    /// Coupling product `c2 = kappa (kappa + mu) l_b^2` \[m^2\].
    pub coupling_product: f64,
}

impl<'a> Joint<'a> {
    /// At a rotor speed \[rad/s\].
    #[must_use]
    pub fn at(machine: &'a Machine, speed: f64) -> Self {
        Self {
            machine,
            nu: machine.nu(speed),
            casing_friction: machine.casing_friction_at(speed),
            coupling_product: machine.coupling_product_at(speed),
        }
    }

    /// Whether blades and casing meet in one travelling wave: `N' >= 3`, and the modes of
    /// the disk have the diameters of the casing or an alias of them, `+-n_d` modulo `N`.
    #[must_use]
    pub fn has_one_wave(machine: &Machine) -> bool {
        let blades = f64::from(machine.polygon.blades);
        let (disk, casing) = (machine.blade_diameters, machine.nodal_diameters);
        let meets = |sense: f64| (disk + sense * casing).rem_euclid(blades) == 0.0;
        machine.polygon.has_corners() && (meets(1.0) || meets(-1.0))
    }

    /// Dynamic stiffness of the casing at a frequency in the standing frame,
    /// `k_c - omega^2 m_c + i omega d_c` \[N/m\].
    #[must_use]
    pub fn casing_stiffness(&self, omega: f64) -> Complex<f64> {
        let m = self.machine;
        Complex::new(m.casing_stiffness - omega * omega * m.casing_mass, omega * m.casing_damping)
    }

    /// Dynamic stiffness of the blade modes at a frequency in the frame of the
    /// blades, `k_a - s^2 m_a + i s d_a` \[N m/rad\].
    #[must_use]
    pub fn blade_stiffness(&self, s: f64) -> Complex<f64> {
        let m = self.machine;
        let inertia = s * s * m.blade_modal_mass;
        Complex::new(m.blade_modal_stiffness - inertia, s * m.blade_modal_damping)
    }

    /// The joint compliance `B(omega) = (1 + i mu_c)/(casing) + c2/(blades)`, which a
    /// wave of pushes of casing frequency `omega` meets \[m/N\].
    #[must_use]
    pub fn compliance(&self, omega: f64) -> Complex<f64> {
        let turned = Complex::new(1.0, self.casing_friction);
        let casing = turned / self.casing_stiffness(omega);
        if self.coupling_product == 0.0 {
            return casing;
        }
        casing + self.blade_stiffness(omega - self.nu).inv() * self.coupling_product
    }

    /// Lever of a push at the blades, `|kappa + mu| l_b` \[m\].
    #[must_use]
    pub fn blade_lever(&self) -> f64 {
        let machine = self.machine;
        let friction = machine.friction_at(self.nu);
        (machine.radial_coupling + friction).abs() * machine.blade_length
    }
}
