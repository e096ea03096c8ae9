//! The rotor speeds at which whirl on a rim of many blades begins (docs/theory.md,
//! section 10): folds, where a pair of waves is born, the one that attracts and its
//! threshold.

use serde::Serialize;

use super::joint::Joint;
use super::rim::{RimWave, rim_waves};
use crate::model::{Machine, Number};
use crate::numeric::bisection::bisected;
use crate::tolerances::{BESIDE_A_FOLD, BRANCH_CHANGES, ONSET_FURTHEST, ONSET_STRIDE};

/// A speed where a pair of waves is born or ends.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WhirlOnset {
    /// Rotor speed; negative for a rotor that turns backward \[rad/s\].
    pub speed_rad_s: f64,
    /// Whether the pair exists at larger speeds and not at smaller ones.
    pub appears: bool,
    /// One of the two waves, which are equal there.
    pub wave: RimWave,
}

/// The slowest speed at which whirl begins for a rotor that turns in the sense of
/// `toward`, with its derivatives of the first order; none where there is none up to 20
/// dangerous coincidences, and where a lining is too soft for that wave \[rad/s\].
///
/// At a fold `Im B` is stationary in the frequency, so that its change with a parameter
/// must be undone by the speed alone.
#[must_use]
pub fn whirl_onset<T: Number>(machine: &Machine<T>, toward: f64) -> Option<T> {
    // Pairs of waves need both structures.
    if machine.coupling_product_at(T::from(toward)).re() == 0.0 {
        return None;
    }
    let onset = sought(&machine.plain(), toward, true).into_iter().find(|onset| onset.appears)?;
    // A lining is never stiffer than where blades lift off for half of each turn.
    let softest = machine.lining.map(|lining| lining.stiffness_n_per_m.re());
    let most = softest.map_or(f64::INFINITY, |k| 0.25 * f64::from(machine.polygon.blades) * k);
    if onset.wave.stiffness_n_per_m > most {
        return None;
    }
    let omega = onset.wave.omega_rad_s;
    let s = -machine.nu(T::from(onset.speed_rad_s)) + omega;
    let turned = machine.casing_friction_at(T::from(toward));
    let casing = [
        machine.casing_stiffness - machine.casing_mass * (omega * omega),
        machine.casing_damping * omega,
    ];
    let blades = [
        machine.blade_modal_stiffness - machine.blade_modal_mass * s * s,
        machine.blade_modal_damping * s,
    ];
    let square = |[re, im]: [T; 2]| re * re + im * im;
    let product = machine.coupling_product_at(T::from(toward));
    let imaginary =
        (turned * casing[0] - casing[1]) / square(casing) - product * blades[1] / square(blades);
    // By s, and s falls with the speed.
    let square_by_s = (blades[1] * machine.blade_modal_damping
        - blades[0] * machine.blade_modal_mass * s * 2.0)
        * 2.0;
    let by_s =
        (machine.blade_modal_damping - blades[1] * square_by_s / square(blades)) / square(blades);
    let by_speed = (product * by_s).re() * machine.nodal_diameters;
    Some(-(imaginary - imaginary.re()) / by_speed + onset.speed_rad_s)
}

/// Every fold of whirl on a rim for a rotor that turns in the sense of `toward`, from
/// the slowest.
#[must_use]
pub fn whirl_onsets(machine: &Machine, toward: f64) -> Vec<WhirlOnset> {
    sought(machine, toward, false)
}

/// The same, or only as far as to the first that appears: the rest takes most of the time.
fn sought(machine: &Machine, toward: f64, first: bool) -> Vec<WhirlOnset> {
    let Some(dangerous) = machine.dangerous_speed() else { return Vec::new() };
    let sense = if toward < 0.0 { -1.0 } else { 1.0 };
    let waves = |speed: f64| rim_waves(&Joint::at(machine, sense * speed));
    let mut found: Vec<WhirlOnset> = Vec::new();
    let mut low = dangerous / ONSET_FURTHEST;
    let mut at_low = waves(low);
    while low < dangerous * ONSET_FURTHEST && !(first && found.iter().any(|onset| onset.appears)) {
        let high = low * ONSET_STRIDE;
        let at_high = waves(high);
        for (speed, below, above) in changes((low, at_low), (high, at_high.len()), &waves) {
            // A single wave that comes or goes does so with infinite pushes: no fold.
            let appears = above.len() > below.len();
            let (few, many) = if appears { (below, above) } else { (above, below) };
            if many.len() < few.len() + 2 {
                continue;
            }
            let there = waves(speed);
            let told_apart = if there.len() == many.len() { there } else { many };
            let speed_rad_s = sense * speed;
            found.extend(closest(&told_apart).map(|wave| WhirlOnset {
                speed_rad_s,
                appears,
                wave,
            }));
        }
        (low, at_low) = (high, at_high);
    }
    found
}

/// The speeds between two where the number of waves changes, with the waves a hair
/// below and above: nearer, round-off takes the two of a fold for one or none.
fn changes(
    (low, mut before): (f64, Vec<RimWave>),
    (high, last): (f64, usize),
    waves: &impl Fn(f64) -> Vec<RimWave>,
) -> Vec<(f64, Vec<RimWave>, Vec<RimWave>)> {
    let mut found = Vec::new();
    let mut start = low;
    while before.len() != last && found.len() < BRANCH_CHANGES {
        let [below, above] = bisected([start, high], |speed| waves(speed).len() != before.len());
        start = (above * (1.0 + BESIDE_A_FOLD)).min(high);
        let after = waves(start);
        let less = waves(below * (1.0 - BESIDE_A_FOLD));
        found.push((above, less, after.clone()));
        before = after;
    }
    found
}

/// Of all waves the stiffer of the two that are nearest to each other.
fn closest(waves: &[RimWave]) -> Option<RimWave> {
    let apart = |pair: &[RimWave]| match pair {
        [one, other] => (one.omega_rad_s - other.omega_rad_s).abs(),
        _ => f64::INFINITY,
    };
    let nearest = waves.windows(2).min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
    nearest.last().copied()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{BladedDisk, Casing};
    use num_dual::Dual64;

    /// Table 1 with tips of this slope, which carries the derivative.
    fn inclined(kappa: Dual64) -> Machine<Dual64> {
        let (disk, casing) = (BladedDisk::default(), Casing::default());
        let disk = BladedDisk {
            blades: disk.blades,
            blade_length_m: disk.blade_length_m.into(),
            inertia_kg_m2: disk.inertia_kg_m2.into(),
            stiffness_nm_per_rad: disk.stiffness_nm_per_rad.into(),
            coupling_nm_per_rad: disk.coupling_nm_per_rad.into(),
            damping_ratio: disk.damping_ratio.into(),
            radial_coupling: kappa,
            nodal_diameters: 0,
            mistuning: disk.mistuning.into(),
            mistuning_seed: 1,
        };
        let casing = Casing {
            radius_m: casing.radius_m.into(),
            modal_mass_kg: casing.modal_mass_kg.into(),
            modal_stiffness_n_per_m: casing.modal_stiffness_n_per_m.into(),
            damping_ratio: casing.damping_ratio.into(),
            tangential_ratio: casing.tangential_ratio.into(),
        };
        Machine::new(&disk, &casing, 3).with_friction(Dual64::from(0.05))
    }

    #[test]
    fn the_onset_has_the_derivative_of_its_neighbours() {
        for toward in [1.0, -1.0] {
            let at = |kappa: f64| {
                let found = whirl_onset(&inclined(Dual64::from(kappa)), toward).unwrap();
                found.re
            };
            let derived = whirl_onset(&inclined(Dual64::from(0.3).derivative()), toward).unwrap();
            let measured = (at(0.3 + 1e-4) - at(0.3 - 1e-4)) / 2e-4;
            let error = (derived.eps - measured).abs();
            assert!(error < 1e-5 * measured.abs(), "{} is not {measured}", derived.eps);
        }
    }
}
