//! An elastic lining, as arrays: the gaps of all rows near it and the pushes of the
//! latest step, which act on the next one (docs/theory.md, sections 6 and 10).
//!
//! `near` are the rows that may press, four by four. They are looked for again when the casing has moved by the margin that they were looked for
//! with. One pass over them finds the pushes and all their sums; what touches is kept by
//! changes, and what the lining stores is worked out from the pushes when it is asked for.

use std::sync::OnceLock;

use super::Explicit;
use super::dies::Rest;
use super::disk::{Columns, Disk, Four, Lanes, total};
use super::lasting::mark;
use super::record::Record;
use super::rows::TipLaw;
use super::uneven::Uneven;
use crate::model::LiningLaw;
use crate::motion::{ActiveSet, Plane};
use crate::tolerances::{LINING_MARGIN, SERIES_PHASE, SHORT_SERIES_PHASE};

/// The lining and the rows near it.
#[derive(Clone, Debug)]
pub(super) struct Lining {
    pub law: LiningLaw,
    near: Columns,
    /// The turn of the frame of the blades at the pushes.
    turn: Plane,
    sums: Sums,
    /// Stored at the step before, where that is not what the pushes before say \[J\].
    held_before: Option<f64>,
    touching: Touching,
    /// What waves do at this speed, once asked; none where rest is no equilibrium of one
    /// linear step.
    pub rest: OnceLock<Option<Rest>>,
}

/// Sums over the rows of a step.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    /// Pushes along the normals of their rows, without friction \[N\].
    force: Plane,
    /// Pushes \[N\], and their torques \[N m\].
    push: f64,
    torque: f64,
    /// What two modes feel of the torques \[N m\].
    felt: [f64; 2],
    deepest: f64,
    /// Whether other rows press than in the step before.
    changed: bool,
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
            turn: Plane::default(),
            sums: Sums::default(),
            held_before: None,
            touching: Touching::default(),
            rest: OnceLock::new(),
        }
    }

    /// Returns whether all rows press.
    pub fn all_press(&self) -> bool {
        self.touching.all
    }

    /// Returns whether any row presses.
    pub fn presses(&self) -> bool {
        self.touching.sides != ActiveSet::Nothing
    }

    /// Returns the rows that press: index, side and push \[N\].
    fn pressed(&self) -> impl Iterator<Item = (u32, u32, f64)> {
        self.near.each(|four| four.push).filter(|(_, _, push)| *push > 0.0)
    }

    /// Returns the multipliers of the rows that press, with their sides \[N\].
    pub fn multipliers(&self) -> Vec<(u32, f64)> {
        self.pressed().map(|(_, side, push)| (side, -push)).collect()
    }

    /// Gives the sums of the pushes until now to the record.
    pub fn give_impulses(&mut self, record: &mut Record) {
        for (_, side, impulse) in self.near.each(|four| four.impulse) {
            if impulse != 0.0 {
                record.impulse(side, -impulse);
            }
        }
        self.near.fours.iter_mut().for_each(|four| four.impulse = Lanes::default());
    }

    /// Returns the energy stored between the last two steps \[J\].
    pub fn stored(&self) -> f64 {
        let before = self.held_before.unwrap_or_else(|| self.energy(|four| four.before));
        0.5 * (before + self.energy(|four| four.push))
    }

    /// Returns the energy stored under these pushes of all rows \[J\].
    fn energy(&self, pushes: impl Fn(&Four) -> Lanes) -> f64 {
        let LiningLaw { stiffness_n_per_m: k, smoothing_m } = self.law;
        let of_row = |push: f64, stiffness: f64| {
            // As deep as such a push says of one blade.
            let deep = push / stiffness;
            let on_line = deep >= 0.5 * smoothing_m;
            let depth =
                if on_line { deep + 0.5 * smoothing_m } else { (2.0 * smoothing_m * deep).sqrt() };
            stiffness / k * self.law.energy(-depth)
        };
        let rows =
            self.near.fours.iter().flat_map(|four| pushes(four).into_iter().zip(four.stiffness));
        rows.filter(|(push, _)| *push > 0.0).map(|(push, stiffness)| of_row(push, stiffness)).sum()
    }

    /// Nothing presses at step `n`.
    pub fn release(&mut self, record: &mut Record, n: u64) {
        if !self.presses() {
            self.held_before = Some(0.0);
            return;
        }
        for (_, side, _) in self.pressed() {
            record.keep_touching(n.saturating_sub(1), side);
        }
        self.held_before = Some(self.energy(|four| four.push));
        for four in &mut self.near.fours {
            (four.push, four.before, four.torque) = Default::default();
        }
        (self.sums, self.touching) = (Sums::default(), Touching::default());
    }

    /// Takes other rows as those near at step `n`, with the pushes of those that pressed
    /// in the step before.
    fn take_rows(&mut self, mut near: Columns, record: &mut Record, n: u64) {
        self.give_impulses(record);
        self.held_before = Some(self.energy(|four| four.push));
        let mut places: Vec<(u32, usize)> = near.index.iter().copied().zip(0..).collect();
        places.sort_unstable();
        for (index, side, push) in self.pressed() {
            record.keep_touching(n.saturating_sub(1), side);
            if let Ok(found) = places.binary_search_by_key(&index, |(known, _)| *known) {
                let place = places[found].1;
                near.fours[place / 4].push[place % 4] = push;
            }
        }
        self.near = near;
    }

    /// Computes the pushes of all rows, with the casing at `z` in the frame of the blades and
    /// the modes at these angles; no phase exceeds `most`.
    fn press(
        &mut self,
        z: Plane,
        tips: &TipLaw,
        modes: [f64; 2],
        most: f64,
        uneven: Option<&Uneven>,
    ) {
        if let Some(uneven) = uneven {
            let short = |blade, angle| uneven.short(blade, angle);
            self.sums = self.press_by(z, tips, modes, short, |phase| {
                if tips.diameters == 0.0 { (0.0, 1.0) } else { phase.sin_cos() }
            });
            return;
        }
        // Less zero is the same number.
        let even = |_, _| [0.0; 2];
        // The shortest series of sine and cosine that is exact.
        self.sums = if tips.diameters == 0.0 {
            self.press_by(z, tips, modes, even, |_| (0.0, 1.0))
        } else if most < SHORT_SERIES_PHASE {
            self.press_by(z, tips, modes, even, |phase| {
                let q = phase * phase;
                // Short chains of operations.
                let cos = (1.0 - q * 0.5) + (q * q) * (1.0 / 24.0);
                (phase - (phase * (1.0 / 6.0)) * q, cos)
            })
        } else if most < SERIES_PHASE {
            self.press_by(z, tips, modes, even, |phase| {
                let q = phase * phase;
                let fifth = 1.0 - q * (1.0 / 20.0) * (1.0 - q * (1.0 / 42.0));
                let fourth = 1.0 - q * (1.0 / 30.0) * (1.0 - q * (1.0 / 56.0));
                let cos = 1.0 - q * 0.5 * (1.0 - q * (1.0 / 12.0) * fourth);
                (phase - phase * (q * (1.0 / 6.0) * fifth), cos)
            })
        } else {
            self.press_by(z, tips, modes, even, f64::sin_cos)
        };
    }

    /// Does the same by this sine and cosine, of rows short of the clearance by so much, with
    /// levers that are.
    #[inline(always)]
    fn press_by(
        &mut self,
        z: Plane,
        tips: &TipLaw,
        modes: [f64; 2],
        short: impl Fn(u32, f64) -> [f64; 2],
        sin_cos: impl Fn(f64) -> (f64, f64),
    ) -> Sums {
        let eps = self.law.smoothing_m;
        let by_depth = if eps > 0.0 { 0.5 / eps } else { 0.0 };
        let TipLaw { clearance, diameters, pushed, .. } = *tips;
        // Angles stand for phases where there are no diameters.
        let scale = if diameters == 0.0 { 1.0 } else { diameters };
        let rise = tips.rise / scale;
        let [c, s] = modes.map(|mode| mode * scale);
        let [mut x, mut y, mut pushes, mut turning, mut deepest] = [Lanes::default(); 5];
        let ([mut felt_c, mut felt_s], mut changed) = ([Lanes::default(); 2], [0_u64; 4]);
        let presses = |push: f64| if push > 0.0 { u64::MAX } else { 0 };
        let Columns { index, fours, .. } = &mut self.near;
        for (place, four) in fours.iter_mut().enumerate() {
            // No lane branches or looks at another: one vector instruction takes all.
            for k in 0..4 {
                let phase = four.shape[0][k] * c + four.shape[1][k] * s;
                let (sin, cos) = sin_cos(phase);
                let across = four.cosine[k] * cos - four.sine[k] * sin;
                let along = four.sine[k] * cos + four.cosine[k] * sin;
                let inward = across * z.re + along * z.im;
                let arm = across * z.im - along * z.re;
                let blade = index.get(4 * place + k).copied().unwrap_or(u32::MAX);
                let [short, steep] = short(blade, phase / scale);
                let deep = phase * rise - (inward + clearance - short);
                let deep = if deep > 0.0 { deep } else { 0.0 };
                let parabola = if deep < eps { deep } else { eps };
                let depth = parabola * parabola * by_depth + (deep - parabola);
                let (push, before) = (depth * four.stiffness[k], four.push[k]);
                let torque = push * (arm * diameters - steep - pushed);
                (four.push[k], four.before[k], four.torque[k]) = (push, before, torque);
                four.impulse[k] += push;
                x[k] += push * across;
                y[k] += push * along;
                pushes[k] += push;
                turning[k] += torque;
                felt_c[k] += four.shape[0][k] * torque;
                felt_s[k] += four.shape[1][k] * torque;
                deepest[k] = if deep > deepest[k] { deep } else { deepest[k] };
                changed[k] |= presses(push) ^ presses(before);
            }
        }
        Sums {
            force: Plane::new(total(x), total(y)),
            push: total(pushes),
            torque: total(turning),
            felt: [total(felt_c), total(felt_s)],
            deepest: deepest.into_iter().fold(0.0, f64::max),
            changed: changed != [0; 4],
        }
    }

    /// Keeps which rows press at step `n`, where these are others than before.
    fn keep_change(&mut self, record: &mut Record, n: u64, rows: usize) {
        let both = self.near.each(|four| [0, 1, 2, 3].map(|k| [four.push[k], four.before[k]]));
        for (_, side, [_, before]) in both.clone() {
            if before > 0.0 {
                record.keep_touching(n.saturating_sub(1), side);
            }
        }
        let (mut touching, mut count) = (Touching::default(), 0);
        for (index, side, [now, before]) in both {
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

impl<B: Disk> Explicit<B> {
    /// Corrects a predicted step by the pushes of its beginning; whether to look at the
    /// blades.
    pub(super) fn push_lining(&mut self, tips: &TipLaw) -> bool {
        let Self { lining: Some(lining), blades, casing, .. } = self else { return false };
        if !lining.presses() {
            return false;
        }
        let change = blades.push(&lining.near, lining.sums.felt);
        let (shift, turn) =
            (tips.push_on_casing(lining.sums.force) * casing.compliance, lining.turn);
        self.shift_casing(shift, turn);
        if !self.beyond.account.forgone {
            self.count_lining(tips);
        }
        self.watch.moved(change)
    }

    /// Work of the rotor and heat of the pushes over the last two half steps.
    fn count_lining(&mut self, tips: &TipLaw) {
        let [c, s] = self.moved();
        let turned = self.drive.speed(self.n - 1) * self.drive.step;
        let lost = self.lost_clearance();
        let Self { lining: Some(lining), blades, beyond, .. } = self else { return };
        let Sums { force, push, torque, .. } = lining.sums;
        let sums = &mut beyond.account.sums;
        sums.growth_work_j += 0.5 * push * lost;
        sums.rotor_work_j -= (torque + tips.pushed * push) * turned;
        if tips.friction == 0.0 {
            return;
        }
        let moved = Plane::new(0.5 * c, 0.5 * s) * lining.turn.conj();
        let along = moved.im * force.re - moved.re * force.im;
        let bent = blades.swept(&lining.near);
        let slid = push * self.scene.casing.radius_m * turned;
        sums.rotor_work_j += tips.friction * slid;
        sums.friction_heat_j += tips.friction * (slid + self.machine.blade_length * bent)
            - tips.casing_friction * along;
    }

    /// Applies the pushes of the latest step to the blades of the next one. Returns the shift of
    /// the casing.
    pub(super) fn push_ahead(&self, tips: &TipLaw, blades: &mut B) -> Plane {
        let Some(lining) = &self.lining else { return Plane::default() };
        blades.push(&lining.near, lining.sums.felt);
        tips.push_on_casing(lining.sums.force) * self.casing.compliance
    }

    /// The pushes of the lining at the latest step.
    pub(super) fn press(&mut self, tips: &TipLaw, bound: f64) {
        let (z, turn) = self.in_blade_frame();
        self.find_pressed(z, turn, tips, bound);
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
        }
    }

    /// Finds the pushes of the lining now.
    fn find_pressed(&mut self, z: Plane, turn: Plane, tips: &TipLaw, bound: f64) {
        if let Some(lining) = &mut self.lining {
            (lining.turn, lining.held_before) = (turn, None);
        }
        let anew = self.find_near(z, tips, bound);
        let n = self.n;
        let Self { lining: Some(lining), blades, record, beyond, .. } = self else { return };
        let uneven = beyond.uneven.as_ref();
        let amplitudes = blades.amplitudes(&mut lining.near);
        lining.press(z, tips, amplitudes, tips.diameters * bound, uneven);
        if anew || lining.sums.changed {
            lining.keep_change(record, n, blades.table().count());
        }
        record.deepest = record.deepest.max(lining.sums.deepest);
    }

    /// Finds the rows that may press, where they are not known; whether these are others.
    fn find_near(&mut self, z: Plane, tips: &TipLaw, bound: f64) -> bool {
        if !self.find_candidates(z, tips, bound, 0.0, LINING_MARGIN) {
            return false;
        }
        let Self { lining: Some(lining), blades, record, beyond, machine, n, .. } = self else {
            return false;
        };
        let rows = &beyond.candidates;
        if lining.near.index == *rows {
            return false;
        }
        let direction = |side| machine.polygon.direction(side);
        let k = lining.law.stiffness_n_per_m;
        let near = Columns::of(rows, blades.table(), k, direction, |row| blades.shape_of(row));
        lining.take_rows(near, record, *n);
        true
    }

    /// Keeps the pushes of the lining at the latest step; whether there are any.
    fn keep_pressed(&mut self) -> bool {
        let t = self.time_of(self.n);
        let Self { lining: Some(lining), record, beyond, n, .. } = self else { return false };
        let Touching { sides, set, all } = lining.touching;
        if sides == ActiveSet::Nothing {
            return false;
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
        self.find_pressed(z, turn, &tips, bound);
        let Self { lining: Some(lining), blades, .. } = self else { return };
        let force = tips.push_on_casing(lining.sums.force) * turn;
        blades.begin(&lining.near, lining.sums.felt);
        self.u =
            [(0, force.re), (1, force.im)].map(|(k, force)| self.casing.begin(self.u[k], force));
        // What the lining held in the step before, from the same rows.
        let back = Plane::cis(tips.diameters * self.drive.speed(0) * self.drive.step);
        let z = Plane::new(self.u[0].x - self.u[0].increment, self.u[1].x - self.u[1].increment);
        let lost = self.beyond.closed[0];
        let each = f64::from(self.blades.table().blades_per_row);
        let pressed: Vec<(u32, u32)> = match &self.lining {
            Some(lining) => lining.pressed().map(|(row, side, _)| (row, side)).collect(),
            None => Vec::new(),
        };
        let mut gaps = Vec::with_capacity(pressed.len());
        for (row, side) in pressed {
            let angle = self.blades.angle_before(row);
            gaps.push(self.place_of((row, side), z * back, &tips, angle, 1).gap + lost);
        }
        let Some(lining) = &mut self.lining else { return };
        let energies = gaps.into_iter().map(|gap| each * lining.law.energy(gap));
        lining.held_before = Some(energies.fold(0.0, |sum, energy| sum + energy));
        self.keep_pressed();
    }

    /// The pushes of the lining with other parameters, as if it had been another one for
    /// the half step before, too.
    pub(super) fn press_again(&mut self) {
        let n = self.n;
        let old = self.lining.take();
        self.lining = self.scene.lining().map(Lining::new);
        let part = old.map_or(1.0, |mut old| {
            old.give_impulses(&mut self.record);
            let held = old.energy(|four| four.push);
            let before = 2.0 * old.stored() - held;
            old.release(&mut self.record, n + 1);
            if held > 0.0 { before / held } else { 1.0 }
        });
        let (tips, bound) = (self.tips, self.blades.bound());
        let (z, turn) = self.in_blade_frame();
        self.find_pressed(z, turn, &tips, bound);
        let Some(lining) = &mut self.lining else { return };
        lining.held_before = Some(part * lining.energy(|four| four.push));
        // The record has the pushes of this step.
        lining.near.fours.iter_mut().for_each(|four| four.impulse = Lanes::default());
    }
}
