//! The machine: modal masses, stiffnesses, damping and frequencies that follow from the parameters
//! and the nodal diameters (docs/theory.md, section 1), and the coincidence speeds of casing and
//! disk (docs/theory.md, section 4). `spin` contains the dependence on rotor speed.

use std::f64::consts::TAU;
use std::sync::Arc;

use super::spin::Spin;
use super::{BladedDisk, Casing, ContactPolygon, LiningLaw, Tips};

/// A contact force of a held corner has a certain sign if its magnitude exceeds this part of
/// `Machine::push_scale`, the forces of which it is the sum. On the paper's machine, a step of 1e-7 s
/// predicts a gap of 1e-15 of the clearance for such a force: a few roundings. With a smaller value
/// round-off would decide the sign near the limit of a lock, and a longer run could contradict the
/// proof.
pub(crate) const CERTAIN_PUSH: f64 = 1e-8;

/// Model of one machine for one number of nodal diameters, with two casing and two blade
/// coordinates.
///
/// The mode shapes are `p_c(i) = cos(n_d Phi_i)` and `p_s(i) = sin(n_d Phi_i)`. They are not
/// normalised, so the modal mass of the blades is `N m_b/2`, or `N m_b` where `p_s` vanishes and
/// only one blade mode is left.
#[derive(Clone, Debug, PartialEq)]
pub struct Machine {
    /// Phase groups, and the contact polygon in the blade frame.
    pub polygon: ContactPolygon,
    pub(super) clearance: f64,
    /// Nodal diameters `n_d`, as a floating-point number.
    pub nodal_diameters: f64,
    /// Casing modal mass `m_c` \[kg\].
    pub casing_mass: f64,
    /// Casing modal stiffness `k_c` \[N/m\].
    pub casing_stiffness: f64,
    /// Casing modal damping `d_c = 2 m_c omega_c zeta_c` \[N s/m\].
    pub casing_damping: f64,
    /// Casing damping ratio `zeta_c`.
    pub casing_damping_ratio: f64,
    /// Casing frequency `omega_c = sqrt(k_c/m_c)` \[rad/s\].
    pub omega_c: f64,
    /// Inertia of one blade `m_b` \[kg m^2\].
    pub blade_inertia: f64,
    /// Modal mass of each blade mode \[kg m^2\].
    pub blade_modal_mass: f64,
    /// Modal damping of each blade mode \[N m s/rad\].
    pub blade_modal_damping: f64,
    /// Modal stiffness of each blade mode \[N m/rad\].
    pub blade_modal_stiffness: f64,
    /// Damping ratio of the blade modes `zeta_bd`.
    pub blade_damping_ratio: f64,
    /// Blade frequency at `n_d` nodal diameters, `omega_bd` \[rad/s\].
    pub omega_bd: f64,
    /// Largest frequency of the bladed disk over all nodal diameters \[rad/s\].
    pub omega_bd_max: f64,
    /// Whether the sine mode `p_s` of the disk exists; false if `2 n_b` is a multiple of `N`.
    pub has_sine_mode: bool,
    /// Blade length `l_b` \[m\].
    pub blade_length: f64,
    /// Slope `kappa` of the tip path: a blade angle `alpha` moves the tip outward by
    /// `kappa l_b alpha`.
    pub radial_coupling: f64,
    /// Whether the blades are taken as rigid: contact bends none; [`new`](Self::new) sets `false`.
    pub rigid_blades: bool,
    /// Nodal diameters `n_b` of the disk modes, as a floating-point number.
    pub blade_diameters: f64,
    /// Ratio `tau` of tangential to radial amplitude of the casing mode.
    pub tangential_ratio: f64,
    /// Coefficient of friction `mu` for forward rotation; [`new`](Self::new) sets 0.
    pub friction: f64,
    /// Lining of the casing under one blade; [`new`](Self::new) sets `None` (rigid contact).
    pub lining: Option<LiningLaw>,
    /// Dependence on the rotor speed; `None` if nothing changes with it.
    pub(super) spin: Option<Spin>,
    /// Unequal tips and the out-of-round shape; `None` for equal tips in a round casing.
    pub(crate) tips: Option<Arc<Tips>>,
}

/// Factor on stiffness and mass that makes blades rigid. With a larger one squares would overflow.
const STIFF_BLADES: f64 = 1e120;

impl Machine {
    /// Returns the scale of the contact forces of two sides that hold the casing in a corner at the
    /// wave frequency `nu` \[rad/s\]: inertia and elastic force divided by `sin 2 delta` \[N\].
    /// Multipliers are compared with round-off of this value.
    #[must_use]
    pub fn push_scale(&self, nu: f64) -> f64 {
        let fastest = self.omega_c.max(nu.abs());
        let spread =
            if self.polygon.has_corners() { (2.0 * self.polygon.delta).sin() } else { 1.0 };
        self.casing_mass * fastest * fastest * self.clearance().abs() / spread
    }

    /// Creates the model of a rotor at rest. The parameters must be valid (see `scene`).
    #[must_use]
    pub fn new(disk: &BladedDisk, casing: &Casing, nodal_diameters: u32) -> Self {
        let clearance = casing.radius_m - disk.blade_length_m;
        let polygon = ContactPolygon::new(disk.blades, nodal_diameters, clearance);
        let blade_diameters = disk.diameters_beside(nodal_diameters);
        let has_sine_mode = (2 * u64::from(blade_diameters)) % u64::from(disk.blades.max(1)) != 0;
        let blades = f64::from(disk.blades);
        let blade_modal_mass = disk.inertia_kg_m2 * blades / if has_sine_mode { 2.0 } else { 1.0 };
        let omega_bd = blade_frequency(disk, blade_diameters);
        let omega_bd_max = blade_frequency(disk, disk.blades / 2);
        let omega_c = (casing.modal_stiffness_n_per_m / casing.modal_mass_kg).sqrt();
        let mut machine = Self {
            polygon,
            clearance,
            nodal_diameters: f64::from(nodal_diameters),
            casing_mass: casing.modal_mass_kg,
            casing_stiffness: casing.modal_stiffness_n_per_m,
            casing_damping: casing.modal_mass_kg * 2.0 * omega_c * casing.damping_ratio,
            casing_damping_ratio: casing.damping_ratio,
            omega_c,
            blade_inertia: disk.inertia_kg_m2,
            blade_modal_mass,
            blade_modal_damping: omega_bd * 2.0 * disk.damping_ratio * blade_modal_mass,
            blade_modal_stiffness: omega_bd * omega_bd * blade_modal_mass,
            blade_damping_ratio: disk.damping_ratio,
            omega_bd,
            omega_bd_max,
            has_sine_mode,
            blade_length: disk.blade_length_m,
            radial_coupling: disk.radial_coupling,
            rigid_blades: false,
            blade_diameters: f64::from(blade_diameters),
            tangential_ratio: casing.tangential_ratio,
            friction: 0.0,
            lining: None,
            spin: None,
            tips: None,
        };
        let (tips, longer) = Tips::new(disk, casing, &machine.polygon);
        machine.clearance -= longer;
        machine.polygon.clearance = machine.clearance;
        machine.tips = tips.map(Arc::new);
        machine.spin = Spin::new(disk, casing, &machine);
        machine
    }

    /// Sets the coefficient of friction `mu` between blades and casing.
    #[must_use]
    pub fn with_friction(self, mu: f64) -> Self {
        Self { friction: mu, ..self }
    }

    /// Sets the lining; `None` for rigid contact.
    #[must_use]
    pub fn with_lining(self, lining: Option<LiningLaw>) -> Self {
        Self { lining, ..self }
    }

    /// Removes the damping of casing and blades.
    #[must_use]
    pub fn undamped(self) -> Self {
        Self {
            casing_damping: 0.0,
            casing_damping_ratio: 0.0,
            blade_modal_damping: 0.0,
            blade_damping_ratio: 0.0,
            spin: self.spin.map(|spin| Spin { blade_damping_ratio: 0.0, ..spin }),
            ..self
        }
    }

    /// Returns the machine whose blades contact forces bend: where they are rigid, with stiff ones,
    /// whose frequency stays.
    #[must_use]
    pub fn under_load(self) -> Self {
        if !self.rigid_blades {
            return self;
        }
        Self {
            blade_inertia: self.blade_inertia * STIFF_BLADES,
            blade_modal_mass: self.blade_modal_mass * STIFF_BLADES,
            blade_modal_damping: self.blade_modal_damping * STIFF_BLADES,
            blade_modal_stiffness: self.blade_modal_stiffness * STIFF_BLADES,
            ..self
        }
    }

    /// Returns the coefficient of friction, signed by the direction of sliding: negative for
    /// backward rotation, zero at standstill.
    #[must_use]
    pub fn friction_at(&self, speed: f64) -> f64 {
        if speed < 0.0 {
            -self.friction
        } else if speed > 0.0 {
            self.friction
        } else {
            0.0
        }
    }

    /// Returns the friction that acts on the casing mode, `mu_c = mu tau`, signed as in
    /// [`friction_at`](Self::friction_at).
    #[must_use]
    pub fn casing_friction_at(&self, speed: f64) -> f64 {
        self.friction_at(speed) * self.tangential_ratio
    }

    /// Returns the first-order coupling of blades and casing through the contact,
    /// `c2 = kappa (kappa + mu) l_b^2` \[m^2\]. It is zero for the paper's tips.
    #[must_use]
    pub fn coupling_product_at(&self, speed: f64) -> f64 {
        let kappa = self.radial_coupling;
        kappa * (kappa + self.friction_at(speed)) * self.blade_length * self.blade_length
    }

    /// Returns whether inclined tips or friction couple blades and casing at first order; the
    /// paper's model has neither.
    #[must_use]
    pub fn tips_incline_or_rub(&self) -> bool {
        self.radial_coupling != 0.0 || self.friction != 0.0
    }

    /// Returns whether the paper's bilateral law, which pulls, is defined for this machine: radial tips
    /// without friction, and no lining.
    #[must_use]
    pub fn contact_can_pull(&self) -> bool {
        self.lining.is_none() && !self.tips_incline_or_rub()
    }

    /// Returns whether contact forces load the casing mode in another way than in the paper's model.
    /// Friction on a casing without tangential motion loads only the blades.
    #[must_use]
    pub fn casing_feels_tips(&self) -> bool {
        self.radial_coupling != 0.0 || self.casing_friction_at(1.0) != 0.0
    }

    /// Returns whether the disk modes have other nodal diameters than the casing modes.
    #[must_use]
    pub fn has_other_diameters(&self) -> bool {
        self.blade_diameters != self.nodal_diameters
    }

    /// Returns the clearance `g0`, `R_c - l_b` at rest \[m\].
    #[must_use]
    pub fn clearance(&self) -> f64 {
        self.clearance
    }

    /// Returns the wave frequency in the blade frame, `nu = n_d Omega` \[rad/s\].
    #[must_use]
    pub fn nu(&self, speed: f64) -> f64 {
        speed * self.nodal_diameters
    }

    /// Returns the critical speed `Omega_c = omega_c/n_d`, Eq. (17) \[rad/s\]; `None` for
    /// `n_d = 0`.
    #[must_use]
    pub fn critical_speed(&self) -> Option<f64> {
        (self.nodal_diameters > 0.0).then(|| self.omega_c / self.nodal_diameters)
    }

    /// Returns the positive speeds of Eq. (30), `+-omega_c = n_d Omega +- omega_bd`, in increasing
    /// order \[rad/s\]; empty for `n_d = 0`.
    #[must_use]
    pub fn coincidence_speeds(&self) -> Vec<f64> {
        let mut speeds = self.coincidence_differences();
        speeds.extend(self.dangerous_speed());
        speeds.sort_by(f64::total_cmp);
        speeds
    }

    /// Returns the positive speeds at which a casing wave and a blade wave of the same direction
    /// coincide, the differences of Eq. (30), in increasing order \[rad/s\]. With centrifugal
    /// stiffening there are two or none, because the blade wave can overtake the casing wave or
    /// stay ahead of it.
    #[must_use]
    pub fn coincidence_differences(&self) -> Vec<f64> {
        let (mut speeds, _) = self.meetings(self.omega_c, self.omega_bd_at_rest());
        speeds.iter_mut().for_each(|speed| *speed = speed.abs());
        speeds.sort_by(f64::total_cmp);
        speeds
    }

    /// Returns the dangerous coincidence for forward rotation, `Omega = (omega_c + omega_bd)/n_d`,
    /// Eq. (31) \[rad/s\]. `None` for `n_d = 0`, and for `B >= n_d^2`, where the blade frequency
    /// grows faster with speed than the wave frequency.
    #[must_use]
    pub fn dangerous_speed(&self) -> Option<f64> {
        self.meetings(self.omega_c, self.omega_bd_at_rest()).1
    }

    /// Returns the speeds at which a casing wave and a blade wave coincide,
    /// `casing = n Omega +- blades`, for the frequencies `casing` and `blades` (at rest) \[rad/s\]:
    /// first the differences, negative if the blades are faster, then the sum; `None` if it does
    /// not exist.
    ///
    /// With stiffening `B` the speeds are the roots of
    /// `(n^2 - B) Omega^2 - 2 n casing Omega + casing^2 - blades^2 = 0`; the sum is the root with
    /// `n Omega > casing`.
    #[must_use]
    pub fn meetings(&self, casing: f64, blades: f64) -> (Vec<f64>, Option<f64>) {
        let (n, stiffening) = (self.nodal_diameters, self.stiffening());
        if n == 0.0 {
            return (Vec::new(), None);
        }
        if stiffening == 0.0 {
            return (vec![(casing - blades) / n], Some((casing + blades) / n));
        }
        let apart = (casing - blades) * (casing + blades);
        let lead = n * n - stiffening;
        // Quarter of the discriminant, in a form without cancellation.
        let square = stiffening * apart + blades * blades * (n * n);
        if square < 0.0 {
            return (Vec::new(), None);
        }
        // First the root without cancellation, then the other from the product of both.
        let far = casing * n + square.sqrt();
        let [near, far] = [apart / far, far / lead];
        let is_sum = |root: f64| root * n > casing;
        let found = [near, far].into_iter().filter(|root| root.is_finite());
        let (sums, differences): (Vec<f64>, Vec<f64>) = found.partition(|root| is_sum(*root));
        (differences, sums.first().copied())
    }

    /// Returns the coincidence that is dangerous for the tips of this machine \[rad/s\]: the sum,
    /// Eq. (31), or the difference of Eq. (30) if the friction is self-locking,
    /// `kappa (kappa + mu) < 0`. The sign is that of `speed`. `None` if it does not exist.
    #[must_use]
    pub fn coincidence_felt_at(&self, speed: f64) -> Option<f64> {
        let digs_in = self.coupling_product_at(speed) < 0.0;
        let first = || self.coincidence_differences().first().copied();
        let felt = if digs_in { first() } else { self.dangerous_speed() }?;
        Some(if speed < 0.0 { -felt } else { felt })
    }

    /// Returns the dangerous coincidence for a rotor that turns in the direction of the sign of
    /// `speed` \[rad/s\]. Backward rotation exchanges the two directions of every wave, so it is
    /// `-(omega_c + omega_bd)/n_d`. `None` as in [`dangerous_speed`](Self::dangerous_speed).
    #[must_use]
    pub fn dangerous_speed_toward(&self, speed: f64) -> Option<f64> {
        self.dangerous_speed().map(|forward| if speed < 0.0 { -forward } else { forward })
    }
}

/// Returns the blade frequency at rest for `nodal_diameters`, from
/// `omega_bd^2 = (k_b + 2 k_bb (1 - cos(2 pi n_d/N)))/m_b` \[rad/s\].
#[must_use]
pub fn blade_frequency(disk: &BladedDisk, nodal_diameters: u32) -> f64 {
    let angle = TAU * f64::from(nodal_diameters % disk.blades.max(1)) / f64::from(disk.blades);
    let stiffness =
        disk.stiffness_nm_per_rad + disk.coupling_nm_per_rad * 2.0 * (1.0 - angle.cos());
    (stiffness / disk.inertia_kg_m2).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paper(nodal_diameters: u32, zeta_c: f64) -> Machine {
        let casing = Casing { damping_ratio: zeta_c, ..Casing::default() };
        Machine::new(&BladedDisk::default(), &casing, nodal_diameters)
    }

    fn close(value: f64, expected: f64, tolerance: f64) {
        assert!((value - expected).abs() <= tolerance, "{value} is not {expected}");
    }

    #[test]
    fn modes_without_a_sine_partner() {
        assert!(!paper(0, 0.05).has_sine_mode);
        assert!(!paper(11, 0.05).has_sine_mode);
        close(paper(11, 0.05).blade_modal_mass, 22.0 * 0.20825, 1e-12);
        close(paper(3, 0.05).blade_modal_mass, 11.0 * 0.20825, 1e-12);
        assert_eq!(paper(0, 0.05).critical_speed(), None);
        assert_eq!(paper(11, 0.05).lock_speed(), None);
    }
}
