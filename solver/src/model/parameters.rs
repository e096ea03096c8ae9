//! Input data: bladed disk, casing and operation, as in Table 1 of the paper (docs/theory.md,
//! section 1), with the extensions of sections 10 and 11. Plain data; the allowed values are
//! defined in `scene`.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use serde::{Serialize, Serializer};

/// Mode of the casing or the disk for one number of nodal diameters. A value that is `None` is
/// taken from the structure.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mode {
    /// Number of nodal diameters.
    pub nodal_diameters: u32,
    /// Modal mass of the casing \[kg\], or inertia of a blade \[kg m^2\].
    pub mass: Option<f64>,
    /// Modal stiffness of the casing \[N/m\], or of a blade on the disk \[N m/rad\].
    pub stiffness: Option<f64>,
    /// Frequency \[Hz\]; replaces the stiffness, which then follows from it.
    pub frequency_hz: Option<f64>,
    /// Damping ratio.
    pub damping_ratio: Option<f64>,
    /// Centrifugal stiffening `B` (blades only).
    pub stiffening: Option<f64>,
}

/// Selects a value of a [`Mode`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModePart {
    /// Modal mass, or inertia of a blade.
    Mass,
    /// Modal stiffness.
    Stiffness,
    /// Damping ratio.
    Damping,
    /// Centrifugal stiffening (blades only).
    Stiffening,
}

/// Returns the frequency given for the mode with these nodal diameters, if any \[Hz\].
pub(crate) fn given_frequency(modes: &[Mode], diameters: u32) -> Option<f64> {
    mode_of(modes, diameters)?.frequency_hz
}

impl Mode {
    /// Returns one value, `None` if the mode does not set it.
    #[must_use]
    pub fn part(&self, part: ModePart) -> Option<f64> {
        match part {
            ModePart::Mass => self.mass,
            ModePart::Stiffness => self.stiffness,
            ModePart::Damping => self.damping_ratio,
            ModePart::Stiffening => self.stiffening,
        }
    }

    /// As [`part`](Self::part), mutable.
    pub fn part_mut(&mut self, part: ModePart) -> &mut Option<f64> {
        match part {
            ModePart::Mass => &mut self.mass,
            ModePart::Stiffness => &mut self.stiffness,
            ModePart::Damping => &mut self.damping_ratio,
            ModePart::Stiffening => &mut self.stiffening,
        }
    }
}

fn mode_of(modes: &[Mode], diameters: u32) -> Option<&Mode> {
    modes.iter().find(|mode| mode.nodal_diameters == diameters)
}

/// Returns the value that the mode with these nodal diameters sets itself, if any. Asking for the
/// stiffness replaces a given frequency by a stiffness.
fn own_part(modes: &mut [Mode], diameters: u32, part: ModePart) -> Option<&mut f64> {
    let mode = modes.iter_mut().find(|mode| mode.nodal_diameters == diameters)?;
    if part == ModePart::Stiffness && mode.frequency_hz.take().is_some() {
        mode.stiffness = Some(0.0);
    }
    mode.part_mut(part).as_mut()
}

/// Returns `4 k_bb sin^2(pi n/N)`, the contribution of the blade-to-blade stiffness to `k_b` at `n`
/// nodal diameters \[N m/rad\].
#[must_use]
pub fn neighbour_stiffness(coupling: f64, diameters: u32, blades: u32) -> f64 {
    let sine = (PI * f64::from(diameters) / f64::from(blades)).sin();
    4.0 * coupling * sine * sine
}

/// Serialises the modes under the key names of a scene file.
fn named<S: Serializer>(modes: &[Mode], names: [&str; 2], out: S) -> Result<S::Ok, S::Error> {
    out.collect_seq(modes.iter().map(|mode| {
        let parts = [(names[0], mode.mass), (names[1], mode.stiffness)];
        let mut all = BTreeMap::from([("nodal_diameters", Number::Whole(mode.nodal_diameters))]);
        let more = [
            ("frequency_hz", mode.frequency_hz),
            ("damping_ratio", mode.damping_ratio),
            ("centrifugal_stiffening", mode.stiffening),
        ];
        let known = parts.into_iter().chain(more);
        all.extend(known.filter_map(|(name, value)| Some((name, Number::Real(value?)))));
        all
    }))
}

/// Value of a serialised mode.
#[derive(Serialize)]
#[serde(untagged)]
enum Number {
    Whole(u32),
    Real(f64),
}

fn casing_modes<S: Serializer>(modes: &[Mode], out: S) -> Result<S::Ok, S::Error> {
    named(modes, ["modal_mass_kg", "modal_stiffness_n_per_m"], out)
}

fn disk_modes<S: Serializer>(modes: &[Mode], out: S) -> Result<S::Ok, S::Error> {
    named(modes, ["inertia_kg_m2", "stiffness_nm_per_rad"], out)
}

/// A tuned bladed disk of rigid blades on angular springs, Eqs. (2)-(3).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BladedDisk {
    /// Number of blades `N`.
    pub blades: u32,
    /// Blade length `l_b`, from the axis to the tip \[m\].
    pub blade_length_m: f64,
    /// Moment of inertia of one blade about the axis, the paper's `m_b` \[kg m^2\].
    pub inertia_kg_m2: f64,
    /// Blade-to-disk stiffness `k_b` \[N m/rad\].
    pub stiffness_nm_per_rad: f64,
    /// Blade-to-blade stiffness `k_bb` \[N m/rad\].
    pub coupling_nm_per_rad: f64,
    /// Viscous damping ratio of every blade mode at rest, `zeta_bd`.
    pub damping_ratio: f64,
    /// Centrifugal stiffening `B`: at the speed `Omega` every blade frequency is
    /// `sqrt(omega^2 + B Omega^2)`.
    pub centrifugal_stiffening: f64,
    /// Slope `kappa` of the tip path: a blade angle `alpha` moves the tip outward by
    /// `kappa l_b alpha`; 0 for the paper's tips.
    pub radial_coupling: f64,
    /// Nodal diameters `n_b` of the disk modes; 0 means those of the casing.
    pub nodal_diameters: u32,
    /// Standard deviation of the stiffness `k_b` over the blades, relative to its mean.
    pub mistuning: f64,
    /// Seed of the random stiffnesses.
    pub mistuning_seed: u32,
    /// Excess length of each blade over `blade_length_m`, one value for each blade; empty if not
    /// given \[m\].
    pub tips_m: Vec<f64>,
    /// Standard deviation of a random excess length that is added to `tips_m` \[m\].
    pub tip_scatter_m: f64,
    /// Seed of the random tip lengths.
    pub tip_seed: u32,
    /// Excess length of blade 1, in addition to the two above \[m\].
    pub longest_tip_m: f64,
    /// Distance of the rotor centre from the axis \[m\].
    pub orbit_m: f64,
    /// Direction of that eccentricity in the rotor frame \[rad\].
    pub orbit_angle_rad: f64,
    /// Modes with values of their own, one for each number of nodal diameters.
    #[serde(skip_serializing_if = "Vec::is_empty", serialize_with = "disk_modes")]
    pub modes: Vec<Mode>,
}

impl BladedDisk {
    /// Returns the nodal diameters of the disk modes for a casing with `casing` nodal diameters.
    #[must_use]
    pub fn diameters_beside(&self, casing: u32) -> u32 {
        if self.nodal_diameters == 0 { casing } else { self.nodal_diameters }
    }

    /// Returns whether the blades stiffen with speed in any mode.
    #[must_use]
    pub fn stiffens(&self) -> bool {
        let of_modes = self.modes.iter().filter_map(|mode| mode.stiffening);
        of_modes.chain([self.centrifugal_stiffening]).any(|stiffening| stiffening != 0.0)
    }

    /// Returns the disk with the values of its mode at these nodal diameters, and without a list of
    /// modes.
    #[must_use]
    pub fn at(&self, diameters: u32) -> Self {
        let mode = mode_of(&self.modes, diameters);
        let of = |part, own: f64| mode.and_then(|mode| mode.part(part)).unwrap_or(own);
        let inertia_kg_m2 = of(ModePart::Mass, self.inertia_kg_m2);
        let by_frequency = given_frequency(&self.modes, diameters).map(|hertz| {
            let neighbours = neighbour_stiffness(self.coupling_nm_per_rad, diameters, self.blades);
            inertia_kg_m2 * (TAU * hertz).powi(2) - neighbours
        });
        let stiffness = || of(ModePart::Stiffness, self.stiffness_nm_per_rad);
        Self {
            inertia_kg_m2,
            stiffness_nm_per_rad: by_frequency.unwrap_or_else(stiffness),
            damping_ratio: of(ModePart::Damping, self.damping_ratio),
            centrifugal_stiffening: of(ModePart::Stiffening, self.centrifugal_stiffening),
            tips_m: self.tips_m.clone(),
            modes: Vec::new(),
            ..*self
        }
    }

    /// Returns the value that applies at these nodal diameters: that of the mode, or of the disk if
    /// the mode does not set it.
    pub fn part_at(&mut self, diameters: u32, part: ModePart) -> &mut f64 {
        let own = match part {
            ModePart::Mass => &mut self.inertia_kg_m2,
            ModePart::Stiffness => &mut self.stiffness_nm_per_rad,
            ModePart::Damping => &mut self.damping_ratio,
            ModePart::Stiffening => &mut self.centrifugal_stiffening,
        };
        own_part(&mut self.modes, diameters, part).unwrap_or(own)
    }
}

impl Default for BladedDisk {
    /// Table 1, with the moment of inertia that reproduces the printed `omega_bd`.
    fn default() -> Self {
        Self {
            blades: 22,
            blade_length_m: 0.4999,
            inertia_kg_m2: 0.20825,
            stiffness_nm_per_rad: 15_000.0,
            coupling_nm_per_rad: 3_000.0,
            damping_ratio: 0.04,
            centrifugal_stiffening: 0.0,
            radial_coupling: 0.0,
            nodal_diameters: 0,
            mistuning: 0.0,
            mistuning_seed: 1,
            tips_m: Vec::new(),
            tip_scatter_m: 0.0,
            tip_seed: 1,
            longest_tip_m: 0.0,
            orbit_m: 0.0,
            orbit_angle_rad: 0.0,
            modes: Vec::new(),
        }
    }
}

/// The casing, reduced to its two modes with `n_d` nodal diameters, Eqs. (5)-(6).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Casing {
    /// Inner radius `R_c` \[m\].
    pub radius_m: f64,
    /// Modal mass `m_c` \[kg\].
    pub modal_mass_kg: f64,
    /// Modal stiffness `k_c` \[N/m\].
    pub modal_stiffness_n_per_m: f64,
    /// Viscous damping ratio `zeta_c`.
    pub damping_ratio: f64,
    /// Ratio `tau` of tangential to radial amplitude of the mode at the inner face: 0 for the
    /// paper's radial casing, `1/n_d` for an inextensible ring.
    pub tangential_ratio: f64,
    /// Loss of clearance by growth of blades and disk, `c`: at the speed `Omega` the clearance is
    /// `R_c - l_b - c Omega^2` \[m s^2\].
    pub clearance_loss_m_s2: f64,
    /// Number of lobes `m` of an out-of-round casing.
    pub lobes: u32,
    /// Height `e` of the lobes \[m\].
    pub out_of_round_m: f64,
    /// Phase `psi` of the lobes: the shape is `e cos(m phi - psi)` \[rad\].
    pub out_of_round_angle_rad: f64,
    /// Modes with values of their own, one for each number of nodal diameters.
    #[serde(skip_serializing_if = "Vec::is_empty", serialize_with = "casing_modes")]
    pub modes: Vec<Mode>,
}

impl Casing {
    /// Returns the casing with the values of its mode at these nodal diameters, and without a list
    /// of modes.
    #[must_use]
    pub fn at(&self, diameters: u32) -> Self {
        let mode = mode_of(&self.modes, diameters);
        let of = |part, own: f64| mode.and_then(|mode| mode.part(part)).unwrap_or(own);
        let modal_mass_kg = of(ModePart::Mass, self.modal_mass_kg);
        let by_frequency = given_frequency(&self.modes, diameters);
        let stiffness = || of(ModePart::Stiffness, self.modal_stiffness_n_per_m);
        Self {
            modal_mass_kg,
            modal_stiffness_n_per_m: by_frequency
                .map_or_else(stiffness, |hertz| modal_mass_kg * (TAU * hertz).powi(2)),
            damping_ratio: of(ModePart::Damping, self.damping_ratio),
            modes: Vec::new(),
            ..*self
        }
    }

    /// Returns the value that applies at these nodal diameters: that of the mode, or of the casing
    /// if the mode does not set it.
    pub fn part_at(&mut self, diameters: u32, part: ModePart) -> &mut f64 {
        let own = match part {
            ModePart::Mass => &mut self.modal_mass_kg,
            ModePart::Stiffness => &mut self.modal_stiffness_n_per_m,
            // A casing does not rotate, so it has no key for centrifugal stiffening.
            ModePart::Damping | ModePart::Stiffening => &mut self.damping_ratio,
        };
        own_part(&mut self.modes, diameters, part).unwrap_or(own)
    }
}

impl Default for Casing {
    /// Values of Table 1.
    fn default() -> Self {
        Self {
            radius_m: 0.5,
            modal_mass_kg: 2.0,
            modal_stiffness_n_per_m: 1.544e6,
            damping_ratio: 0.05,
            tangential_ratio: 0.0,
            clearance_loss_m_s2: 0.0,
            lobes: 0,
            out_of_round_m: 0.0,
            out_of_round_angle_rad: 0.0,
            modes: Vec::new(),
        }
    }
}

/// Contact properties beyond the paper: friction, restitution and lining.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ContactSurface {
    /// Coefficient of Coulomb friction `mu`; the direction of sliding is that of the rotor.
    pub friction: f64,
    /// Coefficient of restitution `e` of impacts.
    pub restitution: f64,
    /// Stiffness `k_p` of the lining under one blade, used by the smooth law \[N/m\].
    pub stiffness_n_per_m: f64,
    /// Depth `eps` over which the lining reaches that stiffness \[m\].
    pub smoothing_m: f64,
}

impl Default for ContactSurface {
    /// Frictionless plastic contact as in the paper; the lining values are an estimate for a
    /// sprayed metal lining.
    fn default() -> Self {
        Self { friction: 0.0, restitution: 0.0, stiffness_n_per_m: 1e7, smoothing_m: 1e-6 }
    }
}

/// Operating condition: nodal diameters, rotor speed and pulse.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Operation {
    /// Nodal diameters `n_d` of the retained modes.
    pub nodal_diameters: u32,
    /// Rotor speed `Omega` at t = 0; positive is counter-clockwise \[rad/s\].
    pub speed_rad_s: f64,
    /// Constant angular acceleration of the rotor \[rad/s^2\].
    pub speed_ramp_rad_s2: f64,
    /// Force of the rectangular pulse on the equation of `u_c` \[N\].
    pub pulse_n: f64,
    /// Duration `t_p` of the pulse, which begins at t = 0 \[s\].
    pub pulse_s: f64,
}

impl Default for Operation {
    /// Speed 500 rad/s, three nodal diameters, and a pulse of 20 kN for 50 microseconds.
    fn default() -> Self {
        Self {
            nodal_diameters: 3,
            speed_rad_s: 500.0,
            speed_ramp_rad_s2: 0.0,
            pulse_n: 20_000.0,
            pulse_s: 50e-6,
        }
    }
}

/// Casing state at t = 0; the default is rest.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Initial {
    /// Displacement `u_c` \[m\].
    pub u_c_m: f64,
    /// Displacement `u_s` \[m\].
    pub u_s_m: f64,
    /// Velocity of `u_c` \[m/s\].
    pub v_c_m_s: f64,
    /// Velocity of `u_s` \[m/s\].
    pub v_s_m_s: f64,
}

/// Engine-order excitation: the torque `amplitude cos(order (theta + Phi_i))` on every blade, a
/// load pattern fixed in the stationary frame. An amplitude of zero switches it off.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Excitation {
    /// Torque on each blade \[N m\].
    pub amplitude_nm: f64,
    /// Engine order: number of load cycles per revolution.
    pub order: u32,
}

impl Default for Excitation {
    /// No excitation.
    fn default() -> Self {
        Self { amplitude_nm: 0.0, order: 3 }
    }
}
