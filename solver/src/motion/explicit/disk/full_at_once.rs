//! All blades of the full disk at once, by transforms: looks at their angles, and torques on
//! many of them.

use super::Columns;
use super::full::FullBlades;
use crate::tolerances::{FEW_BLADES, FEW_PRESSED};

/// A look at the angles of all rows.
#[derive(Clone, Debug)]
pub(super) struct Seen {
    pub angles: Vec<f64>,
    /// How far they may have turned since \[rad\], and the steps since.
    pub slack: f64,
    pub steps: u32,
    /// Largest of a blade, and the largest about the mean \[rad\].
    pub largest: [f64; 2],
}

impl Seen {
    /// Whether nothing has moved since.
    pub fn are_of_now(&self) -> bool {
        self.steps == 0 && self.slack == 0.0
    }
}

impl FullBlades {
    /// Puts the torques of the extra springs into the room; whether there are any.
    pub(super) fn pull(&mut self) -> bool {
        let Self { ring, rows, x, room, .. } = self;
        if !rows.springs.is_empty() {
            ring.shapes.all_into(x, room);
            room.blades.iter_mut().zip(&rows.springs).for_each(|(angle, spring)| *angle *= -spring);
        }
        !rows.springs.is_empty()
    }

    /// Whether so many rows cost more one by one than all at once.
    pub(super) fn are_many(&self, rows: &Columns) -> bool {
        rows.index.len() * self.rows.members as usize > self.ring.few / FEW_BLADES * FEW_PRESSED
    }

    /// Puts values of rows, shared evenly by their members, into the room.
    pub(super) fn put(&mut self, values: impl Iterator<Item = (u32, u32, f64)>) {
        let (members, count) = (self.rows.members as usize, self.rows.table.count());
        self.room.blades.fill(0.0);
        for (row, _, value) in values {
            for member in 0..members {
                self.room.blades[row as usize + member * count] = value / members as f64;
            }
        }
    }

    /// Corrects the step by the torques in the room; a bound on what it turns.
    pub(super) fn turn_all(&mut self) -> f64 {
        let Self { ring, rows, x, increments, room, .. } = self;
        let most = room.blades.iter().fold(0.0_f64, |most, torque| most.max(torque.abs()));
        ring.shapes.feel(room, |k, felt| {
            let compliance = ring.oscillators[k].compliance;
            for (place, felt) in ring.pair(k).into_iter().zip(felt) {
                x[place] += compliance * felt;
                increments[place] += compliance * felt;
            }
        });
        let change = rows.most_turned * most;
        self.bounds.turn(change);
        self.seen.slack += change;
        change
    }

    /// Looks at all blades, if they may have turned too far since the last look.
    pub(super) fn see(&mut self) {
        let rows = &self.rows;
        if self.seen.slack > rows.most_slack || self.seen.steps >= rows.steps_unseen {
            self.see_all();
        }
    }

    /// Looks at all blades.
    pub(super) fn see_all(&mut self) {
        if self.seen.are_of_now() {
            return;
        }
        let Self { ring, rows, x, room, seen, .. } = self;
        ring.shapes.all_into(x, room);
        let angles = &room.blades;
        let mean = angles.iter().sum::<f64>() / angles.len() as f64;
        let most = |about: f64| {
            let size = |angle: &f64| (angle - about).abs();
            angles.iter().map(size).fold(0.0, |most, at| if at <= most { most } else { at })
        };
        seen.largest = [most(0.0), most(mean)];
        let count = rows.table.count();
        seen.angles.copy_from_slice(&angles[..count]);
        for members in angles[count..].chunks(count) {
            seen.angles.iter_mut().zip(members).for_each(|(sum, angle)| *sum += angle);
        }
        let each = 1.0 / f64::from(rows.members);
        seen.angles.iter_mut().for_each(|sum| *sum *= each);
        (seen.slack, seen.steps) = (0.0, 0);
    }
}
