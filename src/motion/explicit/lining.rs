//! A lining that gives way, as arrays: the gaps of all rows near it and the pushes of the
//! latest step, which act on the next one (docs/theory.md, sections 6 and 10).
//!
//! `near` are the rows that may press, padded to whole lanes by rows of no blade. They
//! are looked for again when the casing has moved by the margin that they were looked for
//! with. What touches is kept by changes: steps in which the same rows press cost no more
//! than their sums.

use wide::f64x4;

use super::Explicit;
use super::disk::{Columns, Disk};
use super::lasting::mark;
use super::record::Record;
use super::rows::TipLaw;
use crate::model::LiningLaw;
use crate::motion::{ActiveSet, Plane};
use crate::tolerances::{LINING_MARGIN, SERIES_PHASE};

/// The lining and the rows near it.
#[derive(Clone, Debug)]
pub(super) struct Lining {
    pub law: LiningLaw,
    near: Columns,
    /// Where the casing was, and below which gap, when `near` was found; see `covers`.
    found_at: Option<Found>,
    /// Of each row near: angle \[rad\], push of its blades \[N\], that of the step before,
    /// torque \[N m\], and its sum of pushes since it was given to the record \[N\].
    angle: Vec<f64x4>,
    push: Vec<f64x4>,
    push_before: Vec<f64x4>,
    torque: Vec<f64x4>,
    impulse: Vec<f64x4>,
    sums: Sums,
    touching: Touching,
}

/// Where the casing was, below which gap rows were looked for, and the clearance \[m\].
#[derive(Clone, Copy, Debug)]
struct Found {
    place: Plane,
    reach: f64,
    clearance: f64,
}

/// Sums over the rows of a step.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    /// Pushes along the normals of their rows, without friction \[N\].
    force: Plane,
    /// Pushes \[N\], and pushes times their levers `A` \[N m\].
    push: f64,
    moment: f64,
    /// Stored in the lining \[J\].
    energy: f64,
    deepest: f64,
}

/// What presses.
#[derive(Clone, Copy, Debug, Default)]
struct Touching {
    sides: ActiveSet,
    /// Sum of `mark` of each row, and whether all rows press.
    set: u64,
    all: bool,
}

impl Lining {
    pub fn new(law: LiningLaw) -> Self {
        Self {
            law,
            near: Columns::default(),
            found_at: None,
            angle: Vec::new(),
            push: Vec::new(),
            push_before: Vec::new(),
            torque: Vec::new(),
            impulse: Vec::new(),
            sums: Sums::default(),
            touching: Touching::default(),
        }
    }

    /// Whether any row presses.
    pub fn presses(&self) -> bool {
        self.touching.sides != ActiveSet::Nothing
    }

    /// The rows that press: index, side, push \[N\] and torque \[N m\].
    fn pressed(&self) -> impl Iterator<Item = (u32, u32, f64, f64)> {
        let rows = self.near.index.iter().zip(&self.near.side);
        rows.zip(each(&self.push).zip(each(&self.torque)))
            .filter(|(_, (push, _))| *push > 0.0)
            .map(|((&index, &side), (push, torque))| (index, side, push, torque))
    }

    /// The multipliers of the rows that press, with their sides \[N\].
    pub fn multipliers(&self) -> Vec<(u32, f64)> {
        self.pressed().map(|(_, side, push, _)| (side, -push)).collect()
    }

    /// Gives the sums of the pushes until now to the record.
    pub fn give_impulses(&mut self, record: &mut Record) {
        for (impulse, &side) in each(&self.impulse).zip(&self.near.side) {
            if impulse != 0.0 {
                record.impulse(side, -impulse);
            }
        }
        self.impulse.fill(f64x4::ZERO);
    }

    /// Nothing presses at step `n`.
    pub fn release(&mut self, record: &mut Record, n: u64) {
        if !self.presses() {
            return;
        }
        for (_, side, ..) in self.pressed() {
            record.keep_touching(n.saturating_sub(1), side);
        }
        self.push.fill(f64x4::ZERO);
        self.torque.fill(f64x4::ZERO);
        (self.sums, self.touching) = (Sums::default(), Touching::default());
    }

    /// Whether the rows near are still all that may press, with the polygon at `w`, below a
    /// gap of `look`: no gap changes by more than the casing moves.
    fn covers(&self, w: Plane, look: f64, clearance: f64) -> bool {
        self.found_at.is_some_and(|found| {
            let moved = w - found.place;
            let closed = (found.clearance - clearance).max(0.0);
            look + moved.re.abs() + moved.im.abs() + closed <= found.reach
        })
    }

    /// Takes other rows as those near at step `n`, with the pushes of those that pressed
    /// in the step before; whether one of these is no longer near.
    fn take_rows(&mut self, near: Columns, record: &mut Record, n: u64) -> bool {
        self.give_impulses(record);
        let nothing = || vec![f64x4::ZERO; near.blades.len()];
        let (mut push, mut left) = (nothing(), false);
        for (index, side, pushed, _) in self.pressed() {
            record.keep_touching(n.saturating_sub(1), side);
            match near.index.iter().position(|known| *known == index) {
                Some(place) => push[place / 4].as_mut_array()[place % 4] = pushed,
                None => left = true,
            }
        }
        (self.angle, self.torque) = (nothing(), nothing());
        (self.push_before, self.impulse) = (nothing(), nothing());
        (self.push, self.near) = (push, near);
        left
    }

    /// Pushes of all rows, with the casing at `z` in the frame of the blades and each
    /// row at its `angle`, which none exceeds by its phase `most`.
    fn press(&mut self, z: Plane, tips: &TipLaw, most: f64) {
        std::mem::swap(&mut self.push, &mut self.push_before);
        self.sums = if most < SERIES_PHASE {
            self.press_by(z, tips, |phase| {
                let q = phase * phase;
                let sin = q * (1.0 / 6.0) * (1.0 - q * (1.0 / 20.0) * (1.0 - q * (1.0 / 42.0)));
                let fourth = 1.0 - q * (1.0 / 30.0) * (1.0 - q * (1.0 / 56.0));
                (phase - phase * sin, 1.0 - q * 0.5 * (1.0 - q * (1.0 / 12.0) * fourth))
            })
        } else {
            self.press_by(z, tips, |phase| {
                let both = phase.to_array().map(f64::sin_cos);
                (both.map(|(sin, _)| sin).into(), both.map(|(_, cos)| cos).into())
            })
        };
    }

    /// `press` with this sine and cosine.
    #[inline(always)]
    fn press_by(
        &mut self,
        z: Plane,
        tips: &TipLaw,
        sin_cos: impl Fn(f64x4) -> (f64x4, f64x4),
    ) -> Sums {
        let LiningLaw { stiffness_n_per_m: k, smoothing_m } = self.law;
        let eps = f64x4::splat(smoothing_m);
        let by_depth = if smoothing_m > 0.0 { 0.5 / smoothing_m } else { 0.0 };
        let TipLaw { clearance, diameters, rise, pushed, .. } = *tips;
        let [mut x, mut y, mut pushes, mut moment, mut energy, mut deepest] = [f64x4::ZERO; 6];
        let Self { near, angle, push, torque, .. } = self;
        let rows = near.cosine.iter().zip(&near.sine).zip(&near.blades);
        let rows = rows.zip(angle).zip(push.iter_mut().zip(torque));
        for ((((&c, &s), &blades), &mut angle), (push, torque)) in rows {
            let (sin, cos) = sin_cos(angle * diameters);
            let (inward, across) = (c * z.re + s * z.im, c * z.im - s * z.re);
            let closed = angle * rise - (inward * cos + across * sin + clearance);
            let arm = (across * cos - inward * sin) * diameters;
            let deep = closed.fast_max(f64x4::ZERO);
            let parabola = deep.fast_min(eps);
            let (line, bent) = (deep - parabola, parabola * parabola * by_depth);
            let pressed = blades * ((bent + line) * k);
            *push = pressed;
            *torque = pressed * (arm - pushed);
            x += pressed * (c * cos - s * sin);
            y += pressed * (s * cos + c * sin);
            pushes += pressed;
            moment += pressed * arm;
            energy += blades * (bent * parabola * (1.0 / 3.0) + line * (parabola + line) * 0.5);
            deepest = deepest.fast_max(deep);
        }
        Sums {
            force: Plane::new(x.reduce_add(), y.reduce_add()),
            push: pushes.reduce_add(),
            moment: moment.reduce_add(),
            energy: k * energy.reduce_add(),
            deepest: deepest.to_array().into_iter().fold(0.0, f64::max),
        }
    }

    /// Whether other rows press than in the step before.
    fn has_changed(&self) -> bool {
        let pressing = |push: &f64x4| push.simd_gt(f64x4::ZERO).to_bitmask();
        let both = self.push.iter().zip(&self.push_before);
        both.fold(0, |changed, (now, before)| changed | (pressing(now) ^ pressing(before))) != 0
    }

    /// Keeps which rows press at step `n`, where these are others than before.
    fn keep_change(&mut self, record: &mut Record, n: u64, rows: usize) {
        for (before, &side) in each(&self.push_before).zip(&self.near.side) {
            if before > 0.0 {
                record.keep_touching(n.saturating_sub(1), side);
            }
        }
        let (mut touching, mut count) = (Touching::default(), 0);
        let both = each(&self.push).zip(each(&self.push_before));
        for ((now, before), (&index, &side)) in
            both.zip(self.near.index.iter().zip(&self.near.side))
        {
            if now > 0.0 {
                touching.sides = touching.sides.with(side);
                touching.set = touching.set.wrapping_add(mark(index));
                count += 1;
                if before <= 0.0 {
                    record.meet(n, side);
                }
            }
        }
        touching.all = count == rows;
        self.touching = touching;
    }
}

/// The numbers one by one.
fn each(lanes: &[f64x4]) -> impl Iterator<Item = f64> {
    lanes.iter().flat_map(|four| four.to_array())
}

impl<B: Disk> Explicit<B> {
    /// Corrects a predicted step by the pushes of its beginning; whether to look at the
    /// blades.
    pub(super) fn push_lining(&mut self) -> bool {
        if !self.lining.as_ref().is_some_and(Lining::presses) {
            return false;
        }
        let n = self.n - 1;
        let tips = self.tips_at(n);
        let (c, s) = self.drive.turn(n);
        let turn = Plane::new(c, s);
        let Some(lining) = &self.lining else { return false };
        let change = self.blades.push(&lining.near, &lining.torque);
        let shift = tips.push_on_casing(lining.sums.force) * self.casing.compliance;
        self.shift_casing(shift, turn);
        if !self.beyond.account.forgone {
            self.count_lining(turn, &tips);
        }
        self.watch.moved(change)
    }

    /// Work of the rotor and heat of the pushes over the last two half steps.
    fn count_lining(&mut self, turn: Plane, tips: &TipLaw) {
        let Some(lining) = &self.lining else { return };
        let Sums { force, push, moment, .. } = lining.sums;
        let rotor =
            self.drive.rotor.speed(self.time_of(self.n) - self.drive.step) * self.drive.step;
        self.beyond.account.sums.rotor_work_j -= moment * rotor;
        self.count_growth(push);
        if tips.friction == 0.0 {
            return;
        }
        let [c, s] = self.moved();
        let moved = Plane::new(0.5 * c, 0.5 * s) * turn.conj();
        let along = moved.im * force.re - moved.re * force.im;
        let turned = |blades: &mut B, row| 0.5 * (blades.angle(row) - blades.angle_before(row));
        let Self { lining: Some(lining), blades, .. } = self else { return };
        let bent: f64 = lining.pressed().map(|(row, _, w, _)| w * turned(blades, row)).sum();
        let slid = push * self.scene.casing.radius_m * rotor;
        let sums = &mut self.beyond.account.sums;
        sums.rotor_work_j += tips.friction * slid;
        sums.friction_heat_j += tips.friction * (slid + self.machine.blade_length * bent)
            - tips.casing_friction * along;
    }

    /// What the pushes of the latest step do to casing and blades of the one after it.
    pub(super) fn push_ahead(&self, tips: &TipLaw, blades: &mut B) -> Plane {
        let Some(lining) = &self.lining else { return Plane::default() };
        blades.push(&lining.near, &lining.torque);
        tips.push_on_casing(lining.sums.force) * self.casing.compliance
    }

    /// The pushes of the lining at the latest step.
    pub(super) fn press(&mut self, tips: &TipLaw, bound: f64) {
        let (z, _) = self.in_blade_frame();
        self.find_pressed(z, tips, bound);
        if !self.keep_pressed() {
            self.part();
            return;
        }
        let swing = self.swing_of_blades();
        let [c, s] = self.blades.modal();
        let rise = Plane::new(c, s) * tips.rise;
        self.beyond.lasting.look(self.time_of(self.n), z, rise, swing);
    }

    /// Nothing is near the lining.
    pub(super) fn leave_lining(&mut self) {
        if let Some(lining) = &mut self.lining {
            lining.release(&mut self.record, self.n);
            self.beyond.account.press(0.0);
        }
    }

    /// Finds the pushes of the lining now.
    fn find_pressed(&mut self, z: Plane, tips: &TipLaw, bound: f64) {
        let left = self.find_near(z, tips, bound);
        let n = self.n;
        let Self { lining: Some(lining), blades, record, beyond, .. } = self else { return };
        blades.angles(&lining.near, &mut lining.angle);
        lining.press(z, tips, tips.diameters * bound);
        if left || lining.has_changed() {
            lining.keep_change(record, n, blades.table().count());
        }
        record.deepest = record.deepest.max(lining.sums.deepest);
        beyond.account.press(lining.sums.energy);
    }

    /// Finds the rows that may press, where they are not known; whether one that pressed
    /// is not among them.
    fn find_near(&mut self, z: Plane, tips: &TipLaw, bound: f64) -> bool {
        let wave = if tips.rise == 0.0 { Some(Plane::default()) } else { self.blades.wave() };
        let wave = wave.filter(|_| self.blades.table().is_by_side());
        let w = wave.map(|wave| z - wave * tips.rise);
        let look = tips.diameters * bound * (z.re.abs() + z.im.abs());
        let Some(lining) = &self.lining else { return false };
        if w.is_some_and(|w| lining.covers(w, look, tips.clearance)) {
            return false;
        }
        let margin = w.map_or(0.0, |w| LINING_MARGIN * (tips.clearance.abs() + w.norm()));
        self.find_candidates(z, tips, bound, margin);
        let Self { lining: Some(lining), blades, record, beyond, machine, n, .. } = self else {
            return false;
        };
        let (reach, clearance) = (look + margin, tips.clearance);
        lining.found_at = w.map(|place| Found { place, reach, clearance });
        let rows = &beyond.candidates;
        if lining.near.index == *rows {
            return false;
        }
        let direction = |side| machine.polygon.direction(side);
        let near = Columns::of(rows, blades.table(), direction, |row| blades.shape_of(row));
        lining.take_rows(near, record, *n)
    }

    /// Keeps the pushes of the lining at the latest step; whether there are any.
    fn keep_pressed(&mut self) -> bool {
        let t = self.time_of(self.n);
        let Self { lining: Some(lining), record, beyond, n, .. } = self else { return false };
        let Touching { sides, set, all } = lining.touching;
        if sides == ActiveSet::Nothing {
            return false;
        }
        for (impulse, &push) in lining.impulse.iter_mut().zip(&lining.push) {
            *impulse += push;
        }
        record.touch(*n, sides, false);
        let since = beyond.lasting.touch(t, set, all);
        if sides == ActiveSet::Many {
            record.log.since = since;
        }
        true
    }

    /// The lining at the start, and in the step before it.
    pub(super) fn press_start(&mut self) {
        let tips = self.tips;
        let bound = self.blades.bound();
        let (z, turn) = self.in_blade_frame();
        self.find_pressed(z, &tips, bound);
        let Self { lining: Some(lining), blades, .. } = self else { return };
        let force = tips.push_on_casing(lining.sums.force) * turn;
        for (row, _, _, torque) in lining.pressed() {
            blades.begin(row, torque);
        }
        self.u =
            [(0, force.re), (1, force.im)].map(|(k, force)| self.casing.begin(self.u[k], force));
        // What the lining held in the step before, from the same rows.
        let back = Plane::cis(tips.diameters * self.drive.speed(0) * self.drive.step);
        let z = Plane::new(self.u[0].x - self.u[0].increment, self.u[1].x - self.u[1].increment);
        let lost = self.beyond.closed[0];
        let Self { lining: Some(lining), blades, machine, .. } = self else { return };
        let each = f64::from(blades.table().blades_per_row);
        let mut energy = 0.0;
        for (row, side, ..) in lining.pressed() {
            let direction = machine.polygon.direction(side);
            let gap = tips.place(direction, z * back, blades.angle_before(row)).gap + lost;
            energy += each * lining.law.energy(gap);
        }
        self.beyond.account.lining_before = energy;
        self.keep_pressed();
    }

    /// The pushes of the lining with other parameters, as if it had been another one for
    /// the half step before, too.
    pub(super) fn press_again(&mut self) {
        let n = self.n;
        if let Some(mut old) = self.lining.take() {
            old.give_impulses(&mut self.record);
            old.release(&mut self.record, n + 1);
        }
        self.lining = self.scene.lining().map(Lining::new);
        if self.lining.is_none() {
            return;
        }
        let held = self.beyond.account;
        let (tips, bound) = (self.tips, self.blades.bound());
        let (z, _) = self.in_blade_frame();
        self.find_pressed(z, &tips, bound);
        let part = if held.lining > 0.0 { held.lining_before / held.lining } else { 1.0 };
        let account = &mut self.beyond.account;
        account.lining_before = part * account.lining;
    }
}
