//! The quantities a user gives: bladed disk, casing and operation, as Table 1
//! of the paper lists them (docs/theory.md, section 1). Plain data; `scene` defines
//! the allowed values. Each number is one of a type `T`: `f64`, or one that carries
//! its derivative along (`Number`).

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use serde::{Serialize, Serializer};

/// A mode of casing or disk by its number of diameters. What it leaves out is the
/// structure's own value.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mode {
    /// Its nodal diameters.
    pub nodal_diameters: u32,
    /// Modal mass of the casing \[kg\], or inertia of a blade \[kg m^2\].
    pub mass: Option<f64>,
    /// Modal stiffness of the casing \[N/m\], or of a blade on the disk \[N m/rad\].
    pub stiffness: Option<f64>,
    /// Frequency \[Hz\], which stands for the stiffness that gives it.
    pub frequency_hz: Option<f64>,
    /// Damping ratio.
    pub damping_ratio: Option<f64>,
    /// Centrifugal stiffening of blades, `B`.
    pub stiffening: Option<f64>,
}

/// A value of a mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModePart {
    /// Mass, or inertia.
    Mass,
    /// Stiffness.
    Stiffness,
    /// Damping ratio.
    Damping,
    /// Centrifugal stiffening, of blades alone.
    Stiffening,
}

/// Returns the frequency that the mode of so many diameters has instead of a stiffness \[Hz\].
pub(crate) fn frequency_of(modes: &[Mode], diameters: u32) -> Option<f64> {
    mode_of(modes, diameters)?.frequency_hz
}

impl Mode {
    /// Returns one of its values.
    #[must_use]
    pub fn part(&self, part: ModePart) -> Option<f64> {
        match part {
            ModePart::Mass => self.mass,
            ModePart::Stiffness => self.stiffness,
            ModePart::Damping => self.damping_ratio,
            ModePart::Stiffening => self.stiffening,
        }
    }

    /// Returns the same, to be changed.
    pub fn part_mut(&mut self, part: ModePart) -> &mut Option<f64> {
        match part {
            ModePart::Mass => &mut self.mass,
            ModePart::Stiffness => &mut self.stiffness,
            ModePart::Damping => &mut self.damping_ratio,
            ModePart::Stiffening => &mut self.stiffening,
        }
    }
}

/// Returns the mode of so many diameters, if it is known.
fn mode_of(modes: &[Mode], diameters: u32) -> Option<&Mode> {
    modes.iter().find(|mode| mode.nodal_diameters == diameters)
}

/// Returns a value that the mode of so many diameters has of its own. A stiffness that is set
/// replaces a frequency.
fn own_part(modes: &mut [Mode], diameters: u32, part: ModePart) -> Option<&mut f64> {
    let mode = modes.iter_mut().find(|mode| mode.nodal_diameters == diameters)?;
    if part == ModePart::Stiffness && mode.frequency_hz.take().is_some() {
        mode.stiffness = Some(0.0);
    }
    mode.part_mut(part).as_mut()
}

/// Returns `4 k_bb sin^2(pi n/N)`, what the stiffness between blades adds to `k_b` \[N m/rad\].
#[must_use]
pub(crate) fn of_neighbours(coupling: f64, diameters: u32, blades: u32) -> f64 {
    let sine = (PI * f64::from(diameters) / f64::from(blades)).sin();
    4.0 * coupling * sine * sine
}

/// Returns the modes with the names that their values have in a scene file.
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

/// A number of a mode.
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
pub struct BladedDisk<T = f64> {
    /// Number of blades `N`.
    pub blades: u32,
    /// Blade length `l_b`, from the axis to the tip \[m\].
    pub blade_length_m: T,
    /// Moment of inertia of one blade about the axis, the paper's `m_b` \[kg m^2\].
    pub inertia_kg_m2: T,
    /// Blade-to-disk stiffness `k_b` \[N m/rad\].
    pub stiffness_nm_per_rad: T,
    /// Blade-to-blade stiffness `k_bb` \[N m/rad\].
    pub coupling_nm_per_rad: T,
    /// Viscous damping ratio of every blade mode at rest, `zeta_bd`.
    pub damping_ratio: T,
    /// Centrifugal stiffening `B`: every blade frequency becomes
    /// `sqrt(omega^2 + B Omega^2)`.
    pub centrifugal_stiffening: T,
    /// Slope of the path of a blade tip, `kappa`: it moves outward by
    /// `kappa l_b alpha`; 0 for the paper's tips.
    pub radial_coupling: T,
    /// Nodal diameters `n_b` of the modes of the disk; 0 for those of the casing.
    pub nodal_diameters: u32,
    /// Standard deviation of the stiffness `k_b` of single blades, a part of it.
    pub mistuning: T,
    /// Number of the draw of the stiffnesses.
    pub mistuning_seed: u32,
    /// How much longer the tip of each blade is, one number a blade or none \[m\].
    pub tips_m: Vec<f64>,
    /// Standard deviation of the lengths of single blades \[m\].
    pub tip_scatter_m: T,
    /// Number of the draw of those lengths.
    pub tip_seed: u32,
    /// How much longer blade 1 is \[m\].
    pub longest_tip_m: T,
    /// How far the rotor is off its centre \[m\].
    pub orbit_m: T,
    /// The direction of the orbit in the frame of the rotor \[rad\].
    pub orbit_angle_rad: T,
    /// Modes with values of their own, by their diameters.
    #[serde(skip_serializing_if = "Vec::is_empty", serialize_with = "disk_modes")]
    pub modes: Vec<Mode>,
}

impl<T> BladedDisk<T> {
    /// Returns the nodal diameters of its modes, beside a casing of `n_d`.
    #[must_use]
    pub fn diameters_beside(&self, casing: u32) -> u32 {
        if self.nodal_diameters == 0 { casing } else { self.nodal_diameters }
    }
}

impl BladedDisk {
    /// Returns whether its blades stiffen with the speed, in any mode.
    #[must_use]
    pub fn stiffens(&self) -> bool {
        let of_modes = self.modes.iter().filter_map(|mode| mode.stiffening);
        of_modes.chain([self.centrifugal_stiffening]).any(|stiffening| stiffening != 0.0)
    }

    /// Returns it with the values of its mode of these diameters, and without other modes.
    #[must_use]
    pub fn at(&self, diameters: u32) -> Self {
        let mode = mode_of(&self.modes, diameters);
        let of = |part, own: f64| mode.and_then(|mode| mode.part(part)).unwrap_or(own);
        let inertia_kg_m2 = of(ModePart::Mass, self.inertia_kg_m2);
        let by_frequency = frequency_of(&self.modes, diameters).map(|hertz| {
            let neighbours = of_neighbours(self.coupling_nm_per_rad, diameters, self.blades);
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

    /// Returns it in other numbers, without its modes.
    #[must_use]
    pub fn to<T: From<f64>>(&self) -> BladedDisk<T> {
        BladedDisk {
            blades: self.blades,
            blade_length_m: self.blade_length_m.into(),
            inertia_kg_m2: self.inertia_kg_m2.into(),
            stiffness_nm_per_rad: self.stiffness_nm_per_rad.into(),
            coupling_nm_per_rad: self.coupling_nm_per_rad.into(),
            damping_ratio: self.damping_ratio.into(),
            centrifugal_stiffening: self.centrifugal_stiffening.into(),
            radial_coupling: self.radial_coupling.into(),
            nodal_diameters: self.nodal_diameters,
            mistuning: self.mistuning.into(),
            mistuning_seed: self.mistuning_seed,
            tips_m: self.tips_m.clone(),
            tip_scatter_m: self.tip_scatter_m.into(),
            tip_seed: self.tip_seed,
            longest_tip_m: self.longest_tip_m.into(),
            orbit_m: self.orbit_m.into(),
            orbit_angle_rad: self.orbit_angle_rad.into(),
            modes: Vec::new(),
        }
    }

    /// Returns a value of that mode, or its own where the mode has none.
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
    /// Table 1, with the moment of inertia that gives the printed `omega_bd`.
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

/// The casing, reduced to its two `n_d`-diameter modes, Eqs. (5)-(6).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Casing<T = f64> {
    /// Inner radius `R_c` \[m\].
    pub radius_m: T,
    /// Modal mass `m_c` \[kg\].
    pub modal_mass_kg: T,
    /// Modal stiffness `k_c` \[N/m\].
    pub modal_stiffness_n_per_m: T,
    /// Viscous damping ratio `zeta_c`.
    pub damping_ratio: T,
    /// Tangential over radial amplitude of the mode at the inner face, `tau`: 0 for
    /// the paper's radial casing, `1/n_d` for a ring that does not stretch.
    pub tangential_ratio: T,
    /// What blades and disk lose of the clearance as they grow, `c`: at a speed it is
    /// `R_c - l_b - c Omega^2` \[m s^2\].
    pub clearance_loss_m_s2: T,
    /// Number of lobes `m` of a casing that is out of round.
    pub lobes: u32,
    /// Height `e` of the lobes \[m\].
    pub out_of_round_m: T,
    /// Phase `psi` of the lobes: the shape is `e cos(m phi - psi)` \[rad\].
    pub out_of_round_angle_rad: T,
    /// Modes with values of their own, by their diameters.
    #[serde(skip_serializing_if = "Vec::is_empty", serialize_with = "casing_modes")]
    pub modes: Vec<Mode>,
}

impl Casing {
    /// Returns it with the values of its mode of these diameters, and without other modes.
    #[must_use]
    pub fn at(&self, diameters: u32) -> Self {
        let mode = mode_of(&self.modes, diameters);
        let of = |part, own: f64| mode.and_then(|mode| mode.part(part)).unwrap_or(own);
        let modal_mass_kg = of(ModePart::Mass, self.modal_mass_kg);
        let by_frequency = frequency_of(&self.modes, diameters);
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

    /// Returns it in other numbers, without its modes.
    #[must_use]
    pub fn to<T: From<f64>>(&self) -> Casing<T> {
        Casing {
            radius_m: self.radius_m.into(),
            modal_mass_kg: self.modal_mass_kg.into(),
            modal_stiffness_n_per_m: self.modal_stiffness_n_per_m.into(),
            damping_ratio: self.damping_ratio.into(),
            tangential_ratio: self.tangential_ratio.into(),
            clearance_loss_m_s2: self.clearance_loss_m_s2.into(),
            lobes: self.lobes,
            out_of_round_m: self.out_of_round_m.into(),
            out_of_round_angle_rad: self.out_of_round_angle_rad.into(),
            modes: Vec::new(),
        }
    }

    /// Returns a value of that mode, or its own where the mode has none.
    pub fn part_at(&mut self, diameters: u32, part: ModePart) -> &mut f64 {
        let own = match part {
            ModePart::Mass => &mut self.modal_mass_kg,
            ModePart::Stiffness => &mut self.modal_stiffness_n_per_m,
            // A casing does not turn: no key asks for its stiffening.
            ModePart::Damping | ModePart::Stiffening => &mut self.damping_ratio,
        };
        own_part(&mut self.modes, diameters, part).unwrap_or(own)
    }
}

impl Default for Casing {
    /// Table 1.
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

/// What blade tips and casing do to each other where they touch, beyond the paper.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ContactSurface<T = f64> {
    /// Coulomb friction coefficient `mu`; the blades always slide forward.
    pub friction: T,
    /// Coefficient of restitution `e` of an impact.
    pub restitution: T,
    /// Stiffness `k_p` of a lining under one blade, for the smooth law \[N/m\].
    pub stiffness_n_per_m: T,
    /// Depth `eps` over which that stiffness sets in \[m\].
    pub smoothing_m: T,
}

impl Default for ContactSurface {
    /// Creates the paper's contact, and the estimate of a sprayed metal lining.
    fn default() -> Self {
        Self { friction: 0.0, restitution: 0.0, stiffness_n_per_m: 1e7, smoothing_m: 1e-6 }
    }
}

/// The operation of the machine: the mode pair, the rotor and the pulse.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Operation<T = f64> {
    /// Nodal diameters `n_d` of the retained modes.
    pub nodal_diameters: u32,
    /// Rotor speed `Omega` at the start; positive turns counter-clockwise \[rad/s\].
    pub speed_rad_s: T,
    /// Constant angular acceleration of the rotor \[rad/s^2\].
    pub speed_ramp_rad_s2: T,
    /// Force of the rectangular pulse on the `u_c` equation \[N\].
    pub pulse_n: T,
    /// Duration `t_p` of the pulse, from t = 0 \[s\].
    pub pulse_s: T,
}

impl Default for Operation {
    /// Full speed, three nodal diameters, and a 20 kN pulse of 50 microseconds.
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

/// Casing state at t = 0; at rest by default.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Initial<T = f64> {
    /// `u_c` \[m\].
    pub u_c_m: T,
    /// `u_s` \[m\].
    pub u_s_m: T,
    /// Rate of `u_c` \[m/s\].
    pub v_c_m_s: T,
    /// Rate of `u_s` \[m/s\].
    pub v_s_m_s: T,
}

/// An engine-order excitation: a torque `amplitude * cos(order (theta + Phi_i))`
/// on every blade, fixed in the standing frame; off at amplitude zero.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Excitation {
    /// Torque on each blade \[N m\].
    pub amplitude_nm: f64,
    /// Engine order: number of load cycles per turn.
    pub order: u32,
}

impl Default for Excitation {
    /// Off.
    fn default() -> Self {
        Self { amplitude_nm: 0.0, order: 3 }
    }
}
