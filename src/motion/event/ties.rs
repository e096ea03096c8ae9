//! How near a run comes to a tie: the value that decides at an event, against how
//! far a tiny change of the run moves it (docs/theory.md, section 9).

use crate::motion::Suspect;
use crate::tolerances::{PERTURBATION, TIE};

/// The ties of one run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ties {
    /// Once a tie was found: the changes of the run, the one that it is a tie of
    /// first.
    suspects: Option<[Suspect; 3]>,
    /// Instants at which contact or none decides the verdict \[s\].
    instants: [f64; 2],
}

impl Ties {
    /// Of a run to `end`, judged from `window` on \[s\].
    pub(super) fn new(window: f64, end: f64) -> Self {
        Self { suspects: None, instants: [window, end] }
    }

    /// The changes to be tried, if there was a tie.
    pub(super) fn suspects(&self) -> Option<[Suspect; 3]> {
        self.suspects
    }

    /// Whether no tie was found so far.
    pub(super) fn none(&self) -> bool {
        self.suspects.is_none()
    }

    /// A decision by the sign of `value`, whose derivatives by the logarithm of the
    /// pulse and by the noise are `shifts`; up to `floor` a value decides nothing.
    pub(super) fn tell(&mut self, value: f64, [pulse, noise]: [f64; 2], floor: f64) {
        let shift = TIE * PERTURBATION * pulse.abs().max(noise.abs());
        // Said so that a value that is no number is a tie.
        let clear = value.abs() - shift > floor;
        if self.none() && !clear {
            let [more, less] = if pulse * value < 0.0 {
                [Suspect::Stronger, Suspect::Weaker]
            } else {
                [Suspect::Weaker, Suspect::Stronger]
            };
            self.suspects = Some(if noise.abs() > pulse.abs() {
                [Suspect::Noise, more, less]
            } else {
                [more, less, Suspect::Noise]
            });
        }
    }

    /// A case that is not followed.
    pub(super) fn give_up(&mut self) {
        self.suspects.get_or_insert(Suspect::ALL);
    }

    /// A contact begins or ends at `t`, with these delays.
    pub(super) fn date(&mut self, t: f64, delays: [f64; 2], floor: f64) {
        for instant in self.instants {
            self.tell(t - instant, delays, floor);
        }
    }

    /// A value that has come to zero with `rate`, and `bend` against it where above
    /// zero: how far beyond zero it would go. It may not turn back before.
    pub(super) fn transversal(&mut self, rate: f64, bend: f64, shifts: [f64; 2], floor: f64) {
        if bend > 0.0 {
            self.tell(-0.5 * rate * rate / bend, shifts, floor);
        }
    }
}
