//! Tips of their own and a casing out of round, row by row (docs/theory.md, section 11): what a
//! gap has beside the clearance, `s(phi_i) - b_i`, and the lever that gains `s'(phi_i)`. A row
//! is one blade there. The shape turns against the rotor by one rotation a step.

use std::sync::Arc;

use super::Explicit;
use super::disk::Disk;
use super::drive::Phasor;
use super::rows::{Place, TipLaw, turned};
use crate::model::{Machine, Tips};
use crate::motion::{Plane, Rotor};
use crate::tolerances::GIVE_WAY;

/// What rows have beside the clearance.
#[derive(Clone, Debug)]
pub(super) struct Uneven {
    tips: Arc<Tips>,
    /// `e exp(i (m Phi_i - psi))` of each blade; none of a round casing \[m\].
    shape: Vec<(f64, f64)>,
    lobes: f64,
    /// `exp(i m theta)`, and its value at the latest step looked at.
    phasor: Phasor,
    turn: Plane,
}

impl Uneven {
    /// Of a machine from now on; none where tips are equal and the casing is round.
    pub fn of(machine: &Machine, rotor: &Rotor, step: f64) -> Option<Self> {
        let tips = machine.tips.clone()?;
        let lobes = f64::from(tips.lobes);
        let count = if tips.out_of_round == 0.0 { 0 } else { machine.polygon.blades };
        let shape = |blade: u32| {
            let turns = u64::from(tips.lobes) * u64::from(blade) % u64::from(count);
            let phi = std::f64::consts::TAU * turns as f64 / f64::from(count);
            let at = Plane::cis(phi - tips.angle) * tips.out_of_round;
            (at.re, at.im)
        };
        let shape = (0..count).map(shape).collect();
        let phasor = Phasor::new(rotor, lobes, step);
        Some(Self { shape, lobes, phasor, turn: Plane::new(1.0, 0.0), tips })
    }

    /// Whether sides move.
    pub fn moves(&self) -> bool {
        !self.shape.is_empty()
    }

    /// Turns the shape to step `n`.
    pub fn turn_to(&mut self, n: u64, rotor: &Rotor, step: f64) {
        if self.moves() {
            let (c, s) = self.phasor.at(n, rotor, self.lobes, step);
            self.turn = Plane::new(c, s);
        }
    }

    /// The same turn so many steps before step `n`.
    pub fn turn_before(&self, n: u64, back: u64, rotor: &Rotor, step: f64) -> Plane {
        if let Some(n) = n.checked_sub(back) {
            let (c, s) = self.phasor.look(n, rotor, self.lobes, step);
            return Plane::new(c, s);
        }
        Plane::cis(self.lobes * rotor.angle(-((back - n) as f64) * step))
    }

    /// What the gap of a blade is short of that of the clearance, and what its lever is, both
    /// where the shape is now \[m\].
    #[inline(always)]
    pub fn short(&self, blade: u32, angle: f64) -> [f64; 2] {
        self.short_at(blade, angle, self.turn)
    }

    /// The same with the shape at another turn.
    #[inline(always)]
    fn short_at(&self, blade: u32, angle: f64, turn: Plane) -> [f64; 2] {
        let longer = self.tips.longer(blade);
        let Some(&shape) = self.shape.get(blade as usize) else { return [longer, 0.0] };
        let at = turned(shape, self.lobes * angle) * turn;
        [longer - at.re, self.lobes * at.im]
    }
}

impl<B: Disk> Explicit<B> {
    /// The place of a row, for the casing at `z` in the frame of the blades, with its blades
    /// at this angle, now or two steps before.
    #[inline(always)]
    pub(super) fn place_of(
        &self,
        (index, side): (u32, u32),
        z: Plane,
        tips: &TipLaw,
        angle: f64,
        back: u64,
    ) -> Place {
        let mut place = tips.place(self.machine.polygon.direction(side), z, angle);
        if let Some(uneven) = &self.beyond.uneven {
            let turn = match back {
                0 => uneven.turn,
                _ => uneven.turn_before(self.n, back, &self.drive.rotor, self.drive.step),
            };
            let [short, steep] = uneven.short_at(index, angle, turn);
            place.gap -= short;
            place.moment_arm -= steep;
        }
        place
    }

    /// Takes tips and shape of the machine, from the latest step on.
    pub(super) fn take_shape(&mut self) {
        let (rotor, step) = (&self.drive.rotor, self.drive.step);
        self.beyond.uneven = Uneven::of(&self.machine, rotor, step);
        self.beyond.found = None;
        if let Some(uneven) = &mut self.beyond.uneven {
            uneven.turn_to(self.n, rotor, step);
        }
    }

    /// Whether the sides of rigid contact move.
    pub(super) fn sides_move(&self) -> bool {
        self.beyond.uneven.as_ref().is_some_and(Uneven::moves)
    }

    /// Where tips leave the centre outside, the casing is moved to the nearest place that is
    /// open.
    pub(super) fn move_from_tips(&mut self) {
        let theta = self.drive.rotor.angle(self.time_of(self.n));
        for _ in 0..GIVE_WAY {
            let (z, turn) = self.in_blade_frame();
            let rises: Vec<f64> = (0..self.machine.polygon.blades)
                .map(|blade| self.tips.rise * self.blades.angle(blade))
                .collect();
            let open = self.machine.nearest_open((z.re, z.im), theta, |blade| {
                rises.get(blade as usize).copied().unwrap_or(0.0)
            });
            let Some((x, y)) = open else { return };
            let moved = (Plane::new(x, y) - z) * turn;
            self.u[0].x += moved.re;
            self.u[1].x += moved.im;
        }
    }
}
