//! What in a scene looks like a slip: a unit or a decimal point that is off. Each doubt is
//! a sentence with the key, its value, and what is usual.

use std::f64::consts::TAU;

use super::{Scene, keys};
use crate::tolerances::{
    DOUBTFUL_CLEARANCE, DOUBTFUL_DAMPING, DOUBTFUL_FREQUENCY, DOUBTFUL_GAP, DOUBTFUL_MASSES,
    DOUBTFUL_TIP_SPEED,
};

impl Scene {
    /// What looks like a slip.
    #[must_use]
    pub fn doubts(&self) -> Vec<String> {
        let doubts =
            [self.clearance_doubt(), self.speed_doubt(), self.mass_doubt(), self.diameters_doubt()];
        let mut all: Vec<String> = doubts.into_iter().flatten().collect();
        all.extend(self.modes_doubts());
        all.extend(self.frequency_doubts());
        all.extend(self.damping_doubts());
        all
    }

    fn clearance_doubt(&self) -> Option<String> {
        let (gap, radius) = (self.clearance(), self.casing.radius_m);
        let given = format!(
            "The clearance ({} less {}) is {:.4} mm",
            keys::CASING_RADIUS,
            keys::BLADE_LENGTH,
            1e3 * gap
        );
        if gap > DOUBTFUL_CLEARANCE * radius {
            let part = 100.0 * gap / radius;
            return Some(format!(
                "{given}, {part:.2} % of the radius; blade tips usually run within 1 %. Are both lengths in m, and to enough digits?"
            ));
        }
        (0.0..DOUBTFUL_GAP).contains(&gap).then(|| {
            format!(
                "{given}, less than a surface is round. Are both lengths given to enough digits?"
            )
        })
    }

    fn speed_doubt(&self) -> Option<String> {
        let speed = self.operation.speed_rad_s.abs();
        let tips = speed * self.casing.radius_m;
        (tips > DOUBTFUL_TIP_SPEED).then(|| {
            format!(
                "{} = {speed} ({:.0} rpm) moves the blade tips at {tips:.0} m/s; metal ones reach some 500. Was it rpm? Then write \"{speed} rpm\".",
                keys::SPEED, speed * 60.0 / TAU
            )
        })
    }

    fn mass_doubt(&self) -> Option<String> {
        let machine = self.machine();
        let disk = machine.blade_modal_mass / (machine.blade_length * machine.blade_length);
        let ratio = machine.casing_mass / disk;
        let far = !(1.0 / DOUBTFUL_MASSES..=DOUBTFUL_MASSES).contains(&ratio);
        far.then(|| {
            format!(
                "{} = {} kg, and the disk's modal mass at the tips ({} with {}) is {disk:.4} kg: they differ by a factor of {:.0}. Was one of them in g?",
                keys::CASING_MASS, machine.casing_mass, keys::BLADE_INERTIA, keys::BLADE_LENGTH, ratio.max(1.0 / ratio)
            )
        })
    }

    fn diameters_doubt(&self) -> Option<String> {
        let (diameters, blades) = (self.operation.nodal_diameters, self.bladed_disk.blades);
        (diameters > blades / 2).then(|| {
            format!("{} = {diameters} is more than half of the {blades} blades, which cannot tell it from {}.", keys::DIAMETERS, diameters.abs_diff(blades * ((diameters + blades / 2) / blades)))
        })
    }

    fn modes_doubts(&self) -> Vec<String> {
        let blades = self.bladed_disk.blades;
        let named =
            [(keys::CASING_MODES, &self.casing.modes), (keys::DISK_MODES, &self.bladed_disk.modes)];
        let all =
            named.into_iter().flat_map(|(key, modes)| modes.iter().map(move |mode| (key, mode)));
        let far = all.filter(|(_, mode)| mode.nodal_diameters > blades / 2);
        far.map(|(key, mode)| {
            format!("{key} has a mode of {} diameters, more than half of the {blades} blades; it is never in use.", mode.nodal_diameters)
        })
        .collect()
    }

    fn frequency_doubts(&self) -> Vec<String> {
        let machine = self.machine();
        let [least, most] = DOUBTFUL_FREQUENCY;
        let named = [
            ("casing", keys::CASING_STIFFNESS, machine.omega_c),
            ("bladed disk", keys::BLADE_STIFFNESS, machine.omega_bd),
        ];
        let far = named.into_iter().filter(|(.., omega)| !(least..=most).contains(&(omega / TAU)));
        far.map(|(name, key, omega)| {
            let hertz = omega / TAU;
            format!("The frequency of the {name} is {hertz:.4} Hz ({key} and the mass beside it); first modes usually have {least} to {most} Hz.")
        })
        .collect()
    }

    fn damping_doubts(&self) -> Vec<String> {
        let [casing, disk] = [self.casing_in_use().damping_ratio, self.disk_in_use().damping_ratio];
        let named = [(keys::CASING_DAMPING, casing), (keys::BLADE_DAMPING, disk)];
        let large = named.into_iter().filter(|(_, ratio)| *ratio > DOUBTFUL_DAMPING);
        large
            .map(|(key, ratio)| {
                format!("{key} = {ratio} is a part of critical damping; structures have thousandths to hundredths. Was it per cent? Then write \"{ratio} %\".")
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::BUILTIN;

    #[test]
    fn slips_of_units_are_asked_about_and_usual_machines_are_not() {
        for builtin in BUILTIN {
            let doubts = Scene::builtin(builtin.name).unwrap().doubts();
            assert!(doubts.is_empty(), "{}: {doubts:?}", builtin.name);
        }
        for (key, value, asked) in [
            (
                "bladed_disk.blade_length_m",
                "0.48",
                "The clearance (casing.radius_m less bladed_disk.blade_length_m) is 20.0000 mm, 4.00 % of",
            ),
            ("bladed_disk.blade_length_m", "0.4999999", "is 0.0001 mm, less than"),
            (
                "casing.modes",
                "[{ nodal_diameters = 12, frequency_hz = 140.0 }]",
                "casing.modes has a mode of 12 diameters, more than half of the 22 blades",
            ),
            (
                "operation.speed_rad_s",
                "9500",
                "operation.speed_rad_s = 9500 (90718 rpm) moves the blade tips at 4750 m/s",
            ),
            (
                "casing.modal_mass_kg",
                "0.002",
                "casing.modal_mass_kg = 0.002 kg, and the disk's modal mass",
            ),
            ("casing.damping_ratio", "5", "casing.damping_ratio = 5 is a part of critical damping"),
            ("casing.modal_stiffness_n_per_m", "15", "The frequency of the casing is 0.4359 Hz"),
            (
                "operation.nodal_diameters",
                "19",
                "is more than half of the 22 blades, which cannot tell it from 3.",
            ),
        ] {
            let mut scene = Scene::base();
            scene.set(key, value).unwrap();
            let doubts = scene.doubts().join("\n");
            assert!(doubts.contains(asked), "{key} = {value}: {doubts}");
        }
    }
}
