//! Builds a scene file from the data that an engineer has: number of blades, radius, clearance, and
//! the frequencies and modal masses of a modal analysis. Inverts the formulas of `model::machine`.
//!
//! Modal masses refer to mode shapes with amplitude 1 at the casing rim or at the blade tips. A
//! disk mode of the mass `M` gives the blade inertia `m_b = 2 M l_b^2/N`, or half of it if all
//! blades have the same amplitude (`n = 0` or `n = N/2`).

use std::f64::consts::TAU;

use rubscope_solver::model::neighbour_stiffness;
use rubscope_solver::numeric::rounding::rounded;
use rubscope_solver::scene::{Scene, SceneError, keys};

use super::columns::STIFFENING;

/// Mode of a modal analysis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Family {
    /// Number of nodal diameters.
    pub nodal_diameters: u32,
    /// Frequency \[Hz\].
    pub frequency_hz: f64,
    /// Modal mass \[kg\].
    pub modal_mass_kg: f64,
    /// Damping ratio; `None` if the analysis does not give it.
    pub damping_ratio: Option<f64>,
    /// Centrifugal stiffening `B` of a disk mode; `None` if the analysis does not give it.
    pub stiffening: Option<f64>,
}

/// Input data of a scene file.
#[derive(Clone, Debug, PartialEq)]
pub struct ModalData {
    /// Title of the scene, one line.
    pub title: String,
    /// Number of blades.
    pub blades: u32,
    /// Inner radius of the casing \[m\].
    pub radius_m: f64,
    /// Clearance between blade tips and casing \[m\].
    pub clearance_m: f64,
    /// Nodal diameters that the scene starts with.
    pub nodal_diameters: u32,
    /// Casing modes.
    pub casing: Vec<Family>,
    /// Disk modes.
    pub disk: Vec<Family>,
    /// Damping ratios of casing and disk for modes without one.
    pub damping_ratios: [f64; 2],
    /// Speed range of the machine \[rad/s\].
    pub range_rad_s: [f64; 2],
    /// The same range as it was given, with units.
    pub speeds: String,
    /// Speed that the scene starts with \[rad/s\].
    pub speed_rad_s: f64,
    /// Pulse that starts the motion \[N\].
    pub pulse_n: f64,
}

impl ModalData {
    /// Fills in the scene file `assets/machine.toml`, which has a comment on every key.
    ///
    /// # Errors
    /// Names the key whose value no scene can have.
    pub fn to_toml(&self) -> Result<String, SceneError> {
        let own = |modes: &[Family], key: &str| {
            let here = modes.iter().find(|mode| mode.nodal_diameters == self.nodal_diameters);
            let none = || SceneError::refused(key, "none", "at least one mode");
            here.or(modes.first()).copied().ok_or_else(none)
        };
        let casing = own(&self.casing, keys::CASING_MODES)?;
        let disk = own(&self.disk, keys::DISK_MODES)?;
        let length = digits(self.radius_m - self.clearance_m);
        let of_disk = disk.damping_ratio.filter(|_| self.disk.len() == 1);
        let damping = of_disk.unwrap_or(self.damping_ratios[1]);
        let (stiffness, coupling) = self.springs(&disk, length);
        let casing_stiffness = casing.modal_mass_kg * (TAU * casing.frequency_hz).powi(2);
        // A single mode, with the nodal diameters in use, needs no list.
        let is_listed = self.disk.len() > 1 || disk.nodal_diameters != self.nodal_diameters;
        let of_disk = |mode| listed_mode(mode, Some(self.inertia(mode, length)));
        let disk_modes = match is_listed {
            true => OF_DISK.to_string() + &self.disk.iter().map(of_disk).collect::<String>(),
            false => String::new(),
        };
        let text = format!(
            include_str!("../../assets/machine.toml"),
            title = toml::Value::from(self.title.as_str()),
            blades = self.blades,
            length = length,
            inertia = self.inertia(&disk, length),
            stiffness = stiffness,
            coupling = coupling,
            damping = damping,
            stiffening = disk.stiffening.unwrap_or(0.0),
            disk_modes = disk_modes,
            radius_m = self.radius_m,
            casing_mass = casing.modal_mass_kg,
            casing_stiffness = digits(casing_stiffness),
            casing_damping = self.damping_ratios[0],
            casing_modes =
                self.casing.iter().map(|mode| listed_mode(mode, None)).collect::<String>(),
            nodal_diameters = self.nodal_diameters,
            speed = digits(self.speed_rad_s),
            pulse_n = self.pulse_n,
            end = 1e-2 * (4e4 / casing.frequency_hz).ceil(),
            speeds = toml::Value::from(self.speeds.as_str()),
        );
        Scene::from_toml(&text)?;
        Ok(text)
    }

    /// Returns the blade inertia that gives the modal mass of a disk mode \[kg m^2\].
    fn inertia(&self, mode: &Family, length: f64) -> f64 {
        let alike = (2 * u64::from(mode.nodal_diameters)) % u64::from(self.blades.max(1)) == 0;
        let share = if alike { 1.0 } else { 2.0 };
        digits(share * mode.modal_mass_kg * length * length / f64::from(self.blades))
    }

    /// Returns `k_b` and `k_bb` for nodal diameters without a mode \[N m/rad\].
    ///
    /// `k_bb` is fitted to the given mode and to the mode whose blade-to-blade contribution differs
    /// most. It is 0 with one mode, if the fit is negative, or if `k_bb` alone would exceed the
    /// stiffness of another mode.
    fn springs(&self, mode: &Family, length: f64) -> (f64, f64) {
        let part = |mode: &Family| neighbour_stiffness(1.0, mode.nodal_diameters, self.blades);
        let whole = |mode: &Family| self.inertia(mode, length) * (TAU * mode.frequency_hz).powi(2);
        let far = |other: &&Family| (part(other) - part(mode)).abs();
        let other = self.disk.iter().max_by(|a, b| far(a).total_cmp(&far(b)));
        let coupling = other
            .filter(|other| far(other) > 0.0)
            .map_or(0.0, |other| digits((whole(mode) - whole(other)) / (part(mode) - part(other))));
        let leaves = |mode: &Family| whole(mode) - coupling * part(mode);
        match coupling > 0.0 && self.disk.iter().all(|mode| leaves(mode) > 0.0) {
            true => (digits(leaves(mode)), coupling),
            false => (digits(whole(mode)), 0.0),
        }
    }
}

/// Comment above the modes of the disk.
const OF_DISK: &str = "\n# Modes of the disk: frequency in Hz, inertia of a blade in kg m^2. Nodal\n# \
    diameters without a mode have the values above.\n";

/// Returns a mode as an entry of the list of the casing or, with the inertia of a blade
/// \[kg m^2\], of that of the disk.
fn listed_mode(mode: &Family, inertia: Option<f64>) -> String {
    let part = if inertia.is_some() { "bladed_disk" } else { "casing" };
    let values = [
        ("frequency_hz", Some(mode.frequency_hz)),
        ("modal_mass_kg", Some(mode.modal_mass_kg).filter(|_| inertia.is_none())),
        ("inertia_kg_m2", inertia),
        ("damping_ratio", mode.damping_ratio),
        (STIFFENING, mode.stiffening.filter(|_| inertia.is_some())),
    ];
    let given = values.into_iter().filter_map(|(name, value)| Some((name, value?)));
    let lines = given.map(|(name, value)| format!("{name} = {value:?}\n"));
    let head = format!("[[{part}.modes]]\nnodal_diameters = {}\n", mode.nodal_diameters);
    head + &lines.collect::<String>()
}

/// Rounds a number for the file, so that round-off does not show.
pub(super) fn digits(x: f64) -> f64 {
    rounded(x, 14)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::read_modes;

    fn family(nodal_diameters: u32, frequency_hz: f64, modal_mass_kg: f64) -> Family {
        let (damping_ratio, stiffening) = (None, None);
        Family { nodal_diameters, frequency_hz, modal_mass_kg, damping_ratio, stiffening }
    }

    fn data() -> ModalData {
        ModalData {
            title: "A \"quoted\" machine".into(),
            blades: 36,
            radius_m: 0.42,
            clearance_m: 0.3e-3,
            nodal_diameters: 5,
            casing: vec![family(4, 310.7, 3.1), family(5, 420.3, 2.9), family(6, 533.9, 2.8)],
            disk: vec![family(4, 151.3, 5.5), family(5, 155.9, 5.4), family(6, 159.7, 5.3)],
            damping_ratios: [0.01, 0.002],
            range_rad_s: [TAU * 100.0, TAU * 180.0],
            speeds: "6000rpm:10800rpm".into(),
            speed_rad_s: TAU * 140.0,
            pulse_n: 2e4,
        }
    }

    #[test]
    fn a_single_mode_of_the_disk_keeps_its_damping_and_is_not_that_of_other_diameters() {
        let mut data = data();
        data.disk.truncate(1);
        data.disk[0].damping_ratio = Some(0.03);
        data.nodal_diameters = data.disk[0].nodal_diameters;
        let here = Scene::from_toml(&data.to_toml().unwrap()).unwrap();
        assert_eq!(here.disk_in_use().damping_ratio, 0.03);
        assert!(!here.modes_note().unwrap_or_default().contains("of the disk"));
        data.nodal_diameters += 1;
        let other = Scene::from_toml(&data.to_toml().unwrap()).unwrap();
        assert!(other.modes_note().unwrap().contains("of the disk"));
    }

    #[test]
    fn frequencies_and_masses_come_back_to_twelve_digits() {
        let data = data();
        let mut scene = Scene::from_toml(&data.to_toml().unwrap()).unwrap();
        assert_eq!(scene.title, data.title);
        close(scene.clearance(), data.clearance_m);
        for (casing, disk) in data.casing.iter().zip(&data.disk) {
            scene.operation.nodal_diameters = casing.nodal_diameters;
            let machine = scene.machine();
            close(machine.omega_c, TAU * casing.frequency_hz);
            close(machine.casing_mass, casing.modal_mass_kg);
            close(machine.omega_bd, TAU * disk.frequency_hz);
            let tip = machine.blade_length * machine.blade_length;
            close(machine.blade_modal_mass / tip, disk.modal_mass_kg);
        }
        assert_eq!(scene.modes_note(), None);
    }

    #[test]
    fn two_families_of_the_disk_give_the_stiffness_between_blades() {
        // Modes of a disk with known springs.
        let base = Scene::base();
        let mass = 11.0 * 0.20825 / (0.4999 * 0.4999);
        let of = |diameters: u32| {
            let omega = rubscope_solver::model::blade_frequency(&base.bladed_disk, diameters);
            family(diameters, omega / TAU, mass)
        };
        let two = ModalData {
            blades: 22,
            radius_m: 0.5,
            clearance_m: 1e-4,
            nodal_diameters: 3,
            disk: vec![of(3), of(8)],
            ..data()
        };
        let scene = Scene::from_toml(&two.to_toml().unwrap()).unwrap();
        close(scene.bladed_disk.stiffness_nm_per_rad, 15_000.0);
        close(scene.bladed_disk.coupling_nm_per_rad, 3_000.0);
        close(scene.bladed_disk.inertia_kg_m2, 0.20825);
    }

    #[test]
    fn frequencies_at_two_speeds_give_those_at_rest_and_the_stiffening() {
        let (rest, stiffening) = (352.0_f64, 1.6);
        let at = |rpm: f64| (rest * rest + stiffening * (rpm / 60.0).powi(2)).sqrt();
        let head = "Structure;Nodal diameters;Frequency [Hz];Modal mass [kg];Speed [rpm]";
        for rpm in [0.0, 6000.0] {
            let table = format!(
                "{head};Centrifugal stiffening\ncasing;2;145;9,8;;\ndisk;2;{};3,9;{rpm};\n\
                 disk;2;{};4,1;9500 rpm;\ndisk;3;{};3,7;157.0796326794896 rad/s;1,6\ndisk;4;386;3;;",
                at(rpm),
                at(9500.0),
                at(1500.0)
            )
            .replace('.', ",");
            let [casing, disk] = read_modes(table.as_bytes()).unwrap().modes;
            assert_eq!((casing[0].frequency_hz, casing[0].stiffening), (145.0, None));
            for mode in &disk[..2] {
                close(mode.frequency_hz, rest);
                close(mode.stiffening.unwrap(), stiffening);
            }
            assert_eq!((disk[0].modal_mass_kg, disk.len()), (3.9, 3));
            assert_eq!((disk[2].frequency_hz, disk[2].stiffening), (386.0, None));
        }
        // The scene reproduces the frequencies at any speed.
        let [_, disk] = read_modes(
            format!("{head}\ndisk;5;352;3,9;0\ndisk;5;{};3,9;9500\ndisk;4;300;3;", at(9500.0))
                .replace('.', ",")
                .as_bytes(),
        )
        .unwrap()
        .modes;
        let scene = Scene::from_toml(&ModalData { disk, ..data() }.to_toml().unwrap()).unwrap();
        let machine = scene.machine();
        close(machine.at(TAU * 7000.0 / 60.0).omega_bd, TAU * at(7000.0));
    }

    fn close(value: f64, expected: f64) {
        assert!((value / expected - 1.0).abs() < 1e-12, "{value} is not {expected}");
    }
}
