//! The properties of every corner branch, for any machine.

use std::f64::consts::FRAC_PI_2;

use rubscope_solver::harmonic::{CornerBranch, Equilibrium, GroupContact};
use rubscope_solver::model::Machine;

/// The widest corner angle: a right angle less a small margin \[rad\].
const WIDEST: f64 = FRAC_PI_2 - 1e-3;
/// Most points of one branch.
const MOST_POINTS: usize = 20_000;

/// Checks a branch that was followed from `from` to `to` \[rad/s\] with points
/// an arc of `step` apart; says what is wrong.
pub fn keeps_to_its_laws(
    machine: &Machine,
    branch: &CornerBranch,
    [from, to]: [f64; 2],
    step: f64,
) -> Result<(), String> {
    let must = |holds: bool, what: &str| if holds { Ok(()) } else { Err(what.to_string()) };
    let points = &branch.points;
    let fold = branch.fold.map_or(f64::INFINITY, |fold| fold.speed_rad_s);
    if from > fold {
        return must(points.is_empty(), "no corner state beyond the fold");
    }
    let [(_, first), .., (widest, last)] = points.as_slice() else {
        return must(points.len() == 1 && from == fold, "only the fold itself is a single point");
    };
    must(first.speed_rad_s == from, "starts at the requested speed")?;
    let rising = |pair: &[(f64, Equilibrium)]| pair[0].1.speed_rad_s < pair[1].1.speed_rad_s;
    let falling = |pair: &[(f64, Equilibrium)]| pair[0].1.speed_rad_s > pair[1].1.speed_rad_s;
    if to <= fold {
        must(last.speed_rad_s == to, "ends at the requested speed")?;
        must(points.windows(2).all(rising), "speeds rise up to the end")?;
    } else {
        let folded = branch.fold.map(|fold| (fold.speed_rad_s, fold.opening_rad));
        let top = points
            .iter()
            .position(|(opening, state)| Some((state.speed_rad_s, *opening)) == folded);
        let top = top.ok_or("the fold is a point of the branch")?;
        must(points[..=top].windows(2).all(rising), "speeds rise up to the fold")?;
        must(points[top..].windows(2).all(falling), "speeds fall behind the fold")?;
        let open = (widest - WIDEST).abs() <= 4.0 * f64::EPSILON;
        must(last.speed_rad_s == from || open, "ends where it started or wide open")?;
        must(last.speed_rad_s >= from, "does not go below its start")?;
    }
    let widens = |pair: &[(f64, Equilibrium)]| pair[0].0 <= pair[1].0;
    must(points.windows(2).all(widens), "the corner only widens")?;
    must(*widest <= WIDEST + 4.0 * f64::EPSILON, "the corner stays below a right angle")?;
    spacing(machine, points, step)?;
    points.iter().try_for_each(|(opening, state)| {
        must(state.speed_rad_s <= fold, "no state beyond the fold")?;
        balance(machine, *opening, state)
    })
}

/// Neighbours an arc of `step` apart, or as far as so many points must be.
fn spacing(machine: &Machine, points: &[(f64, Equilibrium)], step: f64) -> Result<(), String> {
    let critical = machine.critical_speed().unwrap_or(f64::NAN);
    let arcs: Vec<f64> = points
        .windows(2)
        .map(|pair| {
            ((pair[1].1.speed_rad_s - pair[0].1.speed_rad_s) / critical)
                .hypot(pair[1].0 - pair[0].0)
        })
        .collect();
    // Both coordinates go one way on each side of the fold, so that the sum of
    // their ways bounds the arc.
    let ways = points.windows(2).map(|pair| {
        ((pair[1].1.speed_rad_s - pair[0].1.speed_rad_s) / critical).abs()
            + (pair[1].0 - pair[0].0).abs()
    });
    let whole: f64 = ways.sum();
    if points.len() > MOST_POINTS || points.len() as f64 > 1.2 * whole / step + 4.0 {
        return Err(format!("{} points for {} steps", points.len(), whole / step));
    }
    let longest = arcs.iter().copied().fold(0.0, f64::max);
    let allowed = 1.6 * step.max(1.2 * whole / MOST_POINTS as f64);
    if longest > allowed {
        return Err(format!("points {longest} apart, allowed is {allowed}"));
    }
    Ok(())
}

/// Both gaps closed, forces in balance, the amplitude that of the opening, and
/// the power that of the damper.
fn balance(machine: &Machine, opening: f64, state: &Equilibrium) -> Result<(), String> {
    let failed = |what: &str, by: f64| {
        Err(format!("{what} by {by:e} at {} rad/s, open to {opening}", state.speed_rad_s))
    };
    let amplitude = state.amplitude_m;
    let expected = machine.clearance() / opening.cos();
    let off = (amplitude / expected - 1.0).abs();
    if off > 1e-11 || off.is_nan() {
        return failed("amplitude is off", off);
    }
    let nu = machine.nu(state.speed_rad_s);
    let ratio = nu / machine.omega_c;
    let k = machine.casing_stiffness * (1.0 - ratio) * (1.0 + ratio);
    let d = machine.casing_damping * nu;
    let z = state.z_m;
    let mut force = [k * z[0] - d * z[1], k * z[1] + d * z[0]];
    // The forces are computed from the multipliers: their rounding is the limit.
    let mut scale = force[0].hypot(force[1]);
    // The speed is rounded, and with it the difference of stiffness and inertia;
    // and blades that turn by many radians have few digits left for the rest.
    let mut loads = 0.0;
    let inertia = machine.casing_stiffness * amplitude * ratio.max(1.0).powi(2);
    for &GroupContact { side, multiplier_n: multiplier, .. } in &state.contacts {
        let (cos, sin) = machine.polygon.direction(side);
        let turn = machine.nodal_diameters * (cos * state.alpha_c_rad + sin * state.alpha_s_rad);
        let (sin_turn, cos_turn) = turn.sin_cos();
        let (cos, sin) = (cos * cos_turn - sin * sin_turn, sin * cos_turn + cos * sin_turn);
        let gap = 1.0 + (z[0] * cos + z[1] * sin) / machine.clearance();
        // Rounding of the turn, and of the six cosines between an opening and the
        // turn it asks for, which count the more the nearer to a right angle.
        let reach = amplitude / machine.clearance();
        let exact = f64::EPSILON * reach * (45.0 * (1.0 + turn.abs()) + 12.0 * reach);
        if gap.abs() > exact {
            return failed("a contact stands open", gap);
        }
        force = [force[0] + multiplier * cos, force[1] + multiplier * sin];
        scale = scale.max(multiplier.abs());
        loads += multiplier.abs() * (1.0 + turn.abs());
    }
    let left = force[0].hypot(force[1]);
    if left > 1e-11 * scale + 8.0 * f64::EPSILON * (inertia + loads) {
        return failed("forces are out of balance", left / scale);
    }
    let dissipated = d * nu * amplitude * amplitude;
    // The moment arms of the two contacts cancel but for their difference.
    let size = dissipated + (k * nu).abs() * amplitude * amplitude;
    let round = 16.0 * f64::EPSILON * loads * amplitude * nu;
    let off = (state.power_w - dissipated).abs();
    if off > 1e-11 * size + round || off.is_nan() {
        return failed("the power is not that of the damper", off / size);
    }
    Ok(())
}
