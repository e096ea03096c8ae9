//! Evaluates every limit of a scene: closed forms of the model and of `harmonic`, and the search for
//! the touching pulse.

use std::cell::OnceCell;

use strum::IntoEnumIterator;

use super::limit::{LimitName, Quantity};
use super::sensitivity::{CHANGE, sensitivities};
use super::touching::{self, FirstTouch};
use crate::harmonic::{LockLoads, SpeedRanges, lobes_of, lock_loads, roundness};
use crate::model::{LockWindow, Machine};
use crate::scene::{Key, Scene};

/// Limits that do not depend on contact. The others assume rigid contact, or a lining that is not
/// compressed at rest; a compressed lining has other limits (`LiningState`).
const OF_NO_CONTACT: [LimitName; 3] =
    [LimitName::OmegaC, LimitName::Coincidence, LimitName::CoincidenceDifference];

/// A scene at which limits are evaluated. What several limits need is computed once.
pub(super) struct Evaluated<'a> {
    pub scene: &'a Scene,
    /// Ranges of speed in the direction of rotation of the scene.
    pub ranges: SpeedRanges,
    touch: OnceCell<Option<FirstTouch>>,
    loads: OnceCell<Option<LockLoads>>,
}

impl<'a> Evaluated<'a> {
    pub fn of(scene: &'a Scene) -> Self {
        Self {
            scene,
            ranges: SpeedRanges::new(&scene.machine(), scene.operation.speed_rad_s),
            touch: OnceCell::new(),
            loads: OnceCell::new(),
        }
    }

    /// Evaluates a scene that differs little from this one, with the rotor in the same direction. Its
    /// touching pulse is computed for the same side and instant: the gap has no rate there, so a
    /// shift in time does not contribute to first order.
    fn beside<'b>(&self, scene: &'b Scene) -> Evaluated<'b> {
        let there = Evaluated { touch: self.touch.clone(), ..Evaluated::of(scene) };
        // Parameters of the operation do not change the machine.
        let same = there.machine() == self.machine();
        if same { Evaluated { ranges: self.ranges.clone(), ..there } } else { there }
    }

    fn toward(&self) -> f64 {
        self.scene.operation.speed_rad_s
    }

    /// Returns the machine at the speed of the scene.
    pub fn machine(&self) -> &Machine {
        self.ranges.machine()
    }

    /// Returns the ranges of speeds in which the lock flutters on rigid contact.
    pub fn flutters(&self) -> &[LockWindow] {
        if self.machine().lining.is_some() { &[] } else { self.ranges.flutters() }
    }

    /// Returns one load of the lock at the speed of the scene; empty without a lock.
    fn load(&self, of: fn(&LockLoads) -> f64) -> Vec<f64> {
        let machine = || self.machine().clone().under_load();
        let loads = self.loads.get_or_init(|| lock_loads(&machine(), self.toward()));
        loads.iter().map(of).collect()
    }

    /// Returns the values of a limit, speeds as magnitudes: none if the machine has no such limit,
    /// several if it changes with speed, and one for each number of lobes of the casing.
    pub fn values(&self, name: LimitName) -> Vec<f64> {
        if self.scene.clearance() <= 0.0 && !OF_NO_CONTACT.contains(&name) {
            return Vec::new();
        }
        let (machine, toward) = (self.machine(), self.toward());
        let one = |value: Option<f64>| value.into_iter().collect::<Vec<f64>>();
        let found = match name {
            LimitName::OmegaC => one(machine.critical_speed()),
            LimitName::OmegaAdhesive => one(machine.adhesive_speed()),
            LimitName::OmegaLock => self.ranges.locks().iter().map(|lock| lock.from).collect(),
            LimitName::LockEnds => self.ranges.locks().iter().filter_map(|lock| lock.to).collect(),
            LimitName::Coincidence => one(machine.dangerous_speed()),
            LimitName::CoincidenceDifference => machine.coincidence_differences(),
            LimitName::WhirlOnset => self.ranges.whirls().iter().map(|span| span.from).collect(),
            LimitName::FlutterSpeed => self.flutters().iter().map(|range| range.from).collect(),
            LimitName::FirstTouch => one(machine.touching_speed()),
            LimitName::TouchingPulse => {
                let touch = self.touch.get_or_init(|| touching::smallest(self.scene));
                one(touch.map(|touch| touch.force_in(self.scene)))
            }
            LimitName::PushA => self.load(|loads| loads.pushes_n[0]),
            LimitName::PushB => self.load(|loads| loads.pushes_n[1]),
            LimitName::Torque => self.load(|loads| loads.torque_nm),
            LimitName::Power => self.load(|loads| loads.power_w),
            LimitName::Roundness => lobes_of(self.scene.operation.nodal_diameters)
                .map_while(|lobes| roundness(machine, toward, lobes))
                .collect(),
        };
        found.into_iter().filter(|value| value.is_finite()).collect()
    }

    /// Returns the values of every limit, or of those that are speeds.
    pub fn all(&self, speeds: bool) -> Vec<(LimitName, Vec<f64>)> {
        let names = LimitName::iter().filter(|name| !speeds || name.quantity() == Quantity::Speed);
        names.map(|name| (name, self.values(name))).collect()
    }

    /// Returns the sensitivities of all these values to one parameter, in one list.
    pub fn sensitivities(&self, all: &[(LimitName, Vec<f64>)], by: &Key) -> Vec<Option<f64>> {
        let touch = self.touch.get().copied().flatten();
        let change = touch.map_or(CHANGE, |touch| touch.change(self.scene));
        sensitivities(self.scene, by, change, |changed| {
            let there = self.beside(changed);
            let mut values = Vec::new();
            for (name, here) in all.iter().filter(|(_, here)| !here.is_empty()) {
                let found = there.values(*name).into_iter().chain(std::iter::repeat(f64::NAN));
                values.extend(found.take(here.len()));
            }
            values
        })
    }
}

/// Returns the limits of a scene that are speeds, with their sensitivities to one parameter, and the
/// ranges of speed from which they follow.
pub(in crate::study) fn speeds(
    scene: &Scene,
    by: Option<&Key>,
) -> (Vec<(LimitName, f64, Option<f64>)>, SpeedRanges) {
    let here = Evaluated::of(scene);
    let all = here.all(true);
    let by = by.map_or(Vec::new(), |by| here.sensitivities(&all, by)).into_iter();
    let values = all.iter().flat_map(|(name, values)| values.iter().map(|value| (*name, *value)));
    let found = values.zip(by.chain(std::iter::repeat(None)));
    (found.map(|((name, value), by)| (name, value, by)).collect(), here.ranges)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tips_that_just_touch_at_rest_have_no_limit_of_a_contact() {
        let known = |clearance: f64| {
            let mut scene = Scene::builtin("soft-lining").unwrap();
            scene.bladed_disk.radial_coupling = 0.3;
            scene.bladed_disk.blade_length_m = scene.casing.radius_m - clearance;
            let found = speeds(&scene, None).0.into_iter().map(|(name, ..)| name);
            found.filter(|name| !OF_NO_CONTACT.contains(name)).count()
        };
        assert!(known(1e-4) > 0);
        assert_eq!([known(0.0), known(-1e-5)], [0, 0]);
    }
}
