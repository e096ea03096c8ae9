//! The pushes of one step of rigid contact: `g = g* - W lambda` with the contact matrix
//! `W = C A^-1 G^T`, which friction and the slope of the tips make unsymmetric
//! (docs/theory.md, sections 6 and 10).

use super::disk::Disk;
use super::rows::{Row, TipLaw};
use crate::contact::{ContactLaw, Several, complementary_pair, single};
use crate::motion::{FailureReason, Plane};
use crate::tolerances::CLOSED_PART;

/// Returns the entry of `W`: how far a unit multiplier of `b` closes the gap of `a` \[m/N\].
#[inline(always)]
fn influence<B: Disk>(tips: &TipLaw, casing_compliance: f64, blades: &B, a: &Row, b: &Row) -> f64 {
    let push = tips.push_on_casing(b.place.normal);
    let casing = a.place.normal.re * push.re + a.place.normal.im * push.im;
    let levers = (a.place.moment_arm - tips.rise) * (b.place.moment_arm - tips.pushed);
    casing_compliance * casing + levers * blades.compliance(a.index, b.index)
}

/// Corrects the blades of a step by the multipliers of its rows, Eq. (13b); the shift of
/// the casing in their frame \[m\], and a bound on the change of any blade angle \[rad\].
#[inline]
pub(super) fn push<B: Disk>(
    rows: &[Row],
    tips: &TipLaw,
    casing_compliance: f64,
    blades: &mut B,
) -> (Plane, f64) {
    let (mut shift, mut change) = (Plane::default(), 0.0);
    for row in rows.iter().filter(|row| row.lambda != 0.0) {
        shift -= tips.push_on_casing(row.place.normal) * (casing_compliance * row.lambda);
        let torque = tips.torque(row);
        blades.correct(row.index, torque);
        change += blades.compliance(row.index, row.index) * torque.abs();
    }
    (shift, change)
}

/// Solves the rows for their multipliers; `gaps` are their distances to the target.
///
/// # Errors
/// Rows without a unique answer.
#[inline]
pub(super) fn solve<B: Disk>(
    tips: &TipLaw,
    law: ContactLaw,
    casing_compliance: f64,
    blades: &B,
    rows: &mut [Row],
    gaps: &[f64],
    several: &mut Several,
) -> Result<(), FailureReason> {
    let count = rows.len();
    let entry = |a: &Row, b: &Row| influence(tips, casing_compliance, blades, a, b);
    match rows {
        [row] => row.lambda = single(entry(row, row), gaps[0]),
        [a, b] => {
            let across = entry(a, b);
            // Without friction pushes act along the rows, and `W` is symmetric.
            let back = if tips.friction == 0.0 { across } else { entry(b, a) };
            let w = [[entry(a, a), across], [back, entry(b, b)]];
            let lambda = law.pair(w, [gaps[0], gaps[1]]);
            [a.lambda, b.lambda] = lambda.ok_or(FailureReason::Singular { rows: 2 })?;
        }
        _ => {
            let pushes = !law.pulls();
            if !(pushes && close_few(entry, rows, gaps)) {
                several.fill(gaps, |i, j| entry(&rows[i], &rows[j]));
                if let Some(lambda) = law.several(several) {
                    for (row, value) in rows.iter_mut().zip(lambda) {
                        row.lambda = *value;
                    }
                } else if tips.rise != 0.0 || !(pushes && close_pair(entry, rows, gaps)) {
                    return Err(FailureReason::Singular { rows: count });
                }
            }
        }
    }
    // A single row that moves away from its own push has no answer either.
    let good = |row: &Row| row.lambda.is_finite() && (law.pulls() || row.lambda <= 0.0);
    if rows.iter().all(good) { Ok(()) } else { Err(FailureReason::Singular { rows: count }) }
}

/// Closes the one or two rows that penetrate by a law that only pushes, if that leaves all
/// others open: it is then the answer of all rows, which is nearly always so.
fn close_few(entry: impl Fn(&Row, &Row) -> f64, rows: &mut [Row], gaps: &[f64]) -> bool {
    let mut closed = (0..rows.len()).filter(|&row| gaps[row] < 0.0);
    let (Some(a), b, None) = (closed.next(), closed.next(), closed.next()) else { return false };
    close(entry, rows, gaps, [a, b.unwrap_or(a)], |k, left| gaps[k] < 0.0 || left >= 0.0)
}

/// Closes two rows, or one, by a law that only pushes so that all others are open: where three
/// sides that have no slope meet, the casing alone does not tell their pushes apart.
fn close_pair(entry: impl Fn(&Row, &Row) -> f64, rows: &mut [Row], gaps: &[f64]) -> bool {
    let deepest = gaps.iter().fold(0.0_f64, |deepest, gap| deepest.max(-gap));
    let open = |_: usize, left: f64| left >= -CLOSED_PART * deepest;
    let mut pairs = (0..rows.len()).flat_map(|b| (0..=b).map(move |a| [a, b]));
    pairs.any(|pair| close(&entry, rows, gaps, pair, open))
}

/// Closes two rows, or twice the same one, by a law that only pushes, where the gaps that this
/// leaves are all `open`.
fn close(
    entry: impl Fn(&Row, &Row) -> f64,
    rows: &mut [Row],
    gaps: &[f64],
    [a, b]: [usize; 2],
    open: impl Fn(usize, f64) -> bool,
) -> bool {
    let across = |i: usize, j: usize| entry(&rows[i], &rows[j]);
    let found = if a == b {
        Some([single(across(a, a), gaps[a]), 0.0])
    } else {
        let w = [[across(a, a), across(a, b)], [across(b, a), across(b, b)]];
        complementary_pair(w, [gaps[a], gaps[b]])
    };
    let pushes = |lambda: &[f64; 2]| lambda.iter().all(|value| *value <= 0.0);
    let Some(lambda) = found.filter(pushes) else { return false };
    let left = |k: usize| gaps[k] - across(k, a) * lambda[0] - across(k, b) * lambda[1];
    let answer = (0..rows.len()).all(|k| open(k, left(k)));
    if answer {
        rows.iter_mut().for_each(|row| row.lambda = 0.0);
        (rows[b].lambda, rows[a].lambda) = (lambda[1], lambda[0]);
    }
    answer
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::explicit::Oscillator;
    use crate::motion::explicit::disk::{FullBlades, ModalBlades, RigidBlades};
    use crate::scene::Scene;

    /// Rows beside the wave at some place, and the change of each gap by a unit
    /// multiplier of another: as it is moved, and as `W` says.
    fn compare<B: Disk>(scene: &Scene) {
        let machine = scene.machine();
        let tips = TipLaw::at(&machine, 450.0);
        let mut blades = B::at_rest(scene, &machine, None);
        let m = &machine;
        let casing = Oscillator::new(m.casing_mass, m.casing_damping, m.casing_stiffness, 1e-6);
        let z = Plane::new(-0.9e-4, 0.5e-4);
        let count = blades.table().count().min(5) as u32;
        let rows: Vec<Row> = (0..count)
            .map(|index| {
                let side = blades.table().side[index as usize];
                let angle = 1e-3 * f64::from(index);
                let place = tips.place(machine.polygon.direction(side), z, angle);
                Row { index, side, angle, place, lambda: 0.0 }
            })
            .collect();
        for b in &rows {
            let mut pushed = blades.clone();
            let unit = Row { lambda: 1.0, ..*b };
            let (shift, _) = push(&[unit], &tips, casing.compliance, &mut pushed);
            for a in &rows {
                let turned = pushed.angle(a.index) - blades.angle(a.index);
                let normal = a.place.normal;
                let opened = shift.re * normal.re
                    + shift.im * normal.im
                    + (a.place.moment_arm - tips.rise) * turned;
                let entry = influence(&tips, casing.compliance, &blades, a, b);
                let size = casing.compliance;
                assert!((opened + entry).abs() < 1e-12 * size, "{opened:e} {entry:e}");
            }
        }
    }

    #[test]
    fn the_matrix_is_that_of_the_step() {
        for (blades, diameters, of_disk, kappa) in
            [(22, 3, 0, 0.3), (22, 4, 0, 0.3), (22, 4, 0, 0.0), (22, 3, 6, 0.2), (12, 4, 2, 0.2)]
        {
            let mut scene = Scene::base();
            scene.bladed_disk.blades = blades;
            scene.operation.nodal_diameters = diameters;
            scene.bladed_disk.nodal_diameters = of_disk;
            scene.bladed_disk.radial_coupling = kappa;
            scene.contact.friction = 0.15;
            scene.casing.tangential_ratio = 0.3;
            scene.solver.step_s = 1e-6;
            compare::<RigidBlades>(&scene);
            compare::<ModalBlades>(&scene);
            compare::<FullBlades>(&scene);
        }
    }

    #[test]
    fn few_rows_that_leave_the_others_open_are_the_answer_of_all() {
        let mut scene = Scene::base();
        (scene.bladed_disk.blades, scene.operation.nodal_diameters) = (60, 20);
        // Stiff blades leave the third side open, and soft ones push it in.
        let (mut alone, mut all) = (0, 0);
        for inertia in [1.0, 1e-8, 1e-10, 1e-12] {
            scene.bladed_disk.inertia_kg_m2 = inertia;
            let machine = scene.machine();
            let tips = TipLaw::at(&machine, 450.0);
            let blades = ModalBlades::at_rest(&scene, &machine, None);
            for turn in 0..60 {
                let z = Plane::cis(0.1 * f64::from(turn)) * (2.0004 * machine.clearance());
                let row = |side: u32| {
                    let place = tips.place(machine.polygon.direction(side), z, 0.0);
                    Row { index: side, side, place, ..Row::default() }
                };
                let mut rows = [row(0), row(1), row(2)];
                let gaps = rows.map(|row| row.place.gap);
                let compliance = 5e-13;
                let entry = |a: &Row, b: &Row| influence(&tips, compliance, &blades, a, b);
                let mut several = Several::default();
                several.fill(&gaps, |a, b| entry(&rows[a], &rows[b]));
                let Some(expected) = several.complementary().map(<[f64]>::to_vec) else { continue };
                all += 1;
                if !close_few(entry, &mut rows, &gaps) {
                    continue;
                }
                alone += 1;
                let most = expected.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
                for (row, value) in rows.iter().zip(&expected) {
                    assert!((row.lambda - value).abs() < 1e-10 * most, "{inertia} {expected:?}");
                }
            }
        }
        assert!(0 < alone && alone < all, "{alone} of {all}");
    }

    #[test]
    fn a_row_that_gives_way_to_its_own_push_is_refused() {
        let mut scene = Scene::base();
        // 1 + c2 m_c/m_a < 0.
        (scene.bladed_disk.radial_coupling, scene.contact.friction) = (-2.4, 5.0);
        scene.bladed_disk.inertia_kg_m2 *= 0.5;
        let machine = scene.machine();
        let tips = TipLaw::at(&machine, 450.0);
        let blades = ModalBlades::at_rest(&scene, &machine, None);
        let mut row =
            Row { place: tips.place((1.0, 0.0), Plane::default(), 0.0), ..Row::default() };
        row.place.moment_arm = 0.0;
        let mut rows = [row];
        let law = ContactLaw::Unilateral;
        let compliance = 1e-14 / machine.casing_mass;
        let solved =
            solve(&tips, law, compliance, &blades, &mut rows, &[-1e-9], &mut Several::default());
        assert_eq!(solved, Err(FailureReason::Singular { rows: 1 }));
    }
}
