//! Slip in the frequency domain: the map from corner to corner, its fixed
//! point, and the balance of power.

use crate::close;
use rubscope_solver::harmonic::{NoSlip, SlipLimit, slip_limits, slip_over};
use rubscope_solver::model::{BladedDisk, Casing, Machine};

pub fn machine(nodal_diameters: u32, zeta_c: f64) -> Machine {
    let casing = Casing { damping_ratio: zeta_c, ..Casing::default() };
    Machine::new(&BladedDisk::default(), &casing, nodal_diameters)
}

/// One step of the map from corner to corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Speed just after the next corner \[m/s\].
    pub speed_after_corner_m_s: f64,
    /// Time it took \[s\].
    pub time_s: f64,
    /// Smallest push on the way \[N\].
    pub least_push_n: f64,
    /// Derivative of `speed_after` with respect to the initial speed.
    pub slope: f64,
}

/// Returns the map from a speed just after one corner \[m/s\], along a side, to that just after
/// the next, in closed form; `None` where the wave turns back.
pub fn slip_map(machine: &Machine, rotor: f64, start: f64) -> Option<Crossing> {
    let (omega, zeta, nu) = (machine.omega_c, machine.casing_damping_ratio, machine.nu(rotor));
    let (end, drag) = (machine.polygon.half_side(), zeta * omega);
    let excess = (nu - omega) * (nu + omega);
    let root = (drag * drag + excess).sqrt();
    let [up, down] = [excess / (root + drag), -root - drag];
    let saddle = -2.0 * drag * nu * machine.clearance() / excess;
    let offset = -end - saddle;
    if start <= (down * offset).max(0.0) {
        return None;
    }
    let grow = (start - down * offset) / (up - down);
    let decay = offset - grow;
    let at = |t: f64| {
        let (grown, decayed) = (grow * (up * t).exp(), decay * (down * t).exp());
        (saddle + grown + decayed, grown * up + decayed * down)
    };
    let (mut low, mut high) = (0.0, 2.0 * end / start);
    while at(high).0 < end {
        (low, high) = (high, 2.0 * high);
    }
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if at(middle).0 < end { low = middle } else { high = middle }
    }
    let push = |t: f64| {
        let (y, speed) = at(t);
        machine.casing_mass * (excess * machine.clearance() - 2.0 * nu * (speed + drag * y))
    };
    // Between the ends it is least where its rate vanishes.
    let ratio = -(decay * down * (down + drag)) / (grow * up * (up + drag));
    let least = Some(ratio.ln() / (up - down)).filter(|t| (0.0..high).contains(t));
    let least_push_n = [0.0, high].into_iter().chain(least).map(push).fold(f64::INFINITY, f64::min);
    let (kept, before) = ((2.0 * machine.polygon.delta).cos(), at(high).1);
    let contraction = (-2.0 * drag * high).exp();
    Some(Crossing {
        speed_after_corner_m_s: kept * before,
        time_s: high,
        least_push_n,
        slope: kept * start / before * contraction,
    })
}

#[test]
fn where_slip_lives() {
    let speeds: Vec<f64> = (0..=200).map(|k| 10.0 * f64::from(k)).collect();
    let limits = slip_limits(&machine(3, 0.01), &speeds).unwrap();
    let [
        SlipLimit { speed_rad_s: from, appears: true },
        SlipLimit { speed_rad_s: to, appears: false },
    ] = limits[..]
    else {
        panic!("{limits:?}")
    };
    // Below, the wave lifts off: the smallest push is zero just there.
    let machine_at = machine(3, 0.01);
    let first = slip_over(&machine_at, &[from]).unwrap()[0].outcome.unwrap();
    assert!(first.least_push_n < 1e-9, "{}", first.least_push_n);
    let below = slip_over(&machine_at, &[from * (1.0 - 1e-9)]).unwrap()[0];
    assert_eq!(below.outcome, Err(NoSlip::Lifts));
    // Above, the wave no longer climbs over the saddle: the speed gained along
    // the unstable manifold, less the corner's part, is that of the stable one.
    let (omega, zeta, nu) = (machine_at.omega_c, 0.01, machine_at.nu(to));
    let root = (zeta * zeta * omega * omega + nu * nu - omega * omega).sqrt();
    let saddle = -2.0 * zeta * omega * nu * machine_at.clearance() / (nu * nu - omega * omega);
    let end = machine_at.polygon.half_side();
    let gained = (root - zeta * omega) * (end - saddle);
    let needed = (root + zeta * omega) * (end + saddle);
    close(gained * (2.0 * machine_at.polygon.delta).cos(), needed, 1e-11);
    let above = slip_over(&machine_at, &[to * (1.0 + 1e-9)]).unwrap()[0];
    assert_eq!(above.outcome, Err(NoSlip::NoDrive));
    // With more damping slip begins later: at the paper's 5 % not below 735 rad/s.
    let damped = slip_limits(&machine(3, 0.05), &speeds).unwrap();
    assert!((735.0..736.0).contains(&damped[0].speed_rad_s));
}
