//! How round a casing must be to keep a lock (docs/theory.md, section 11).
//!
//! Lobes `e cos(m phi - psi)` move the corner of the lock. Both gaps stay closed, so that
//! `z = z_0 + z_1 exp(i m Omega t) + z_2 exp(-i m Omega t)`, which needs the forces
//! `L_c(nu + m Omega) z_1` and `L_c(nu - m Omega) z_2`. The lock persists as long as no contact
//! force vanishes and no other side reaches the corner.

use nalgebra::Complex;

use super::Corner;
use crate::model::{Frame, Machine};

/// Roundness of usual casings, relative to the clearance: one per cent. A lock that needs a rounder
/// casing is reported.
const ROUND_ENOUGH: f64 = 0.01;

/// Returns the lobe counts for which the roundness of a lock is reported: 1 to 4, and `diameters`.
pub(crate) fn lobes_of(diameters: u32) -> impl Iterator<Item = u32> {
    (1..=4).chain((diameters > 4).then_some(diameters))
}

/// Returns the lobe height up to which the lock of a machine persists at a speed, the smallest over 1
/// to 4 and `n_d` lobes \[m\]. `None` if it is unknown, if usual casings are round enough, or if tips
/// or casing are uneven already.
#[must_use]
pub fn roundness_needed(machine: &Machine, speed: f64) -> Option<f64> {
    let lobes = lobes_of(machine.polygon.nodal_diameters);
    let needed = lobes.map_while(|lobes| roundness(machine, speed, lobes)).reduce(f64::min)?;
    (needed < ROUND_ENOUGH * machine.clearance() && !machine.is_uneven()).then_some(needed)
}

/// Returns the largest height of `lobes` lobes with which the machine stays locked at a speed
/// \[m\]. `None` if there is no lock at that speed, if the height would not be below the locked
/// amplitude, at standstill, and where no closed form exists: several blades on a side, inclined
/// tips, friction on the casing, and a lining.
#[must_use]
pub fn roundness(machine: &Machine, speed: f64, lobes: u32) -> Option<f64> {
    let machine = &*machine.at(speed);
    let polygon = &machine.polygon;
    let known = machine.lining.is_none() && !machine.casing_feels_tips();
    if !known || polygon.blades_per_side != 1 || speed == 0.0 {
        return None;
    }
    let corner = Corner::of(machine, speed, None).ok()?;
    let pushes = machine.locked_multipliers(speed)?.map(|lambda| -lambda);
    let one = |(c, s): (f64, f64)| Complex::new(c, s);
    let normal = |side: u32| one(polygon.direction(side));
    // exp(i m Phi) of a blade, numbered from 1.
    let lobe = |blade: u32| {
        let part = u64::from(lobes) * u64::from(blade - 1) % u64::from(polygon.blades);
        one(crate::model::fraction_of_turn(part as u32, polygon.blades))
    };
    let [a, b] = corner.sides().map(normal);
    let [at_a, at_b] = corner.sides().map(|side| lobe(polygon.blades_of_side(side)[0]));
    // 1/(2 i sin beta), where beta is the angle between both sides.
    let sine = (a.conj() * b).im;
    let over = Complex::new(0.0, -(sine * 2.0).recip());
    // z_1 and conj(z_2) for e = 1: z_1 conj(d) + conj(z_2) d = -exp(i m Phi) on both sides.
    let first = (at_b * a - at_a * b) * over;
    let second = (at_a * b.conj() - at_b * a.conj()) * over;
    let casing = Frame::at(machine, speed).casing;
    let (nu, turn) = (machine.nu(speed), speed * f64::from(lobes));
    let force = casing.dynamic_stiffness(nu + turn) * first * 2.0;
    let back = (casing.dynamic_stiffness(nu - turn) * second.conj()).conj() * 2.0;
    // Contact forces from sum p d = force, sum p conj(d) = back.
    let of_a = (back * b - force * b.conj()) * over;
    let of_b = (force * a.conj() - back * a) * over;
    let by_push =
        pushes.into_iter().zip([of_a, of_b].map(Complex::norm)).map(|(push, by)| push / by);
    let distance = machine.locked_amplitude()?;
    let bisector = place(machine, corner);
    let blades = (1..=polygon.blades).map(|blade| (blade, polygon.side_of_blade(blade)));
    let by_gap = blades.filter(|(_, side)| !corner.sides().contains(side)).map(|(blade, side)| {
        let d = normal(side);
        let open = machine.apothem(side) + (bisector * d.conj()).re;
        open / (first * d.conj() + second * d + lobe(blade)).norm()
    });
    let most = by_push.chain(by_gap).reduce(f64::min)?;
    (most > 0.0 && most < distance).then_some(most)
}

/// Returns the position of the corner between two sides \[m\].
fn place(machine: &Machine, corner: Corner) -> Complex<f64> {
    let [(x, y), (u, v)] = corner.sides().map(|side| machine.polygon.direction(side));
    let [a, b] = corner.sides().map(|side| machine.apothem(side));
    let sine = x * v - y * u;
    Complex::new((b * y - a * v) / sine, (a * u - b * x) / sine)
}
