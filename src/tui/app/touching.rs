//! What touches, as the blades see it: which of them, and how deep in a lining.

use super::App;
use crate::motion::ActiveSet;
use crate::scene::ContactLaw;
use crate::tui::axis::readable;

/// Gaps below this part of the clearance are contact, where only their number is
/// known.
const CLOSED: f64 = 1e-9;

/// How far the chart of the polygon reaches, in amplitudes of a corner.
const MARGIN: f64 = 1.15;

impl App {
    /// How far the chart of the polygon reaches while the point is inside \[m\].
    pub fn usual_reach(&self) -> f64 {
        let polygon = &self.machine.polygon;
        let corner = if polygon.has_corners() { polygon.delta.cos() } else { 1.0 };
        MARGIN * (polygon.clearance / corner).abs()
    }

    /// Whether the casing has a lining, which gives way.
    pub fn has_lining(&self) -> bool {
        self.scene.solver.contact == ContactLaw::Smooth
    }

    /// Whether the blades rub at rest.
    pub fn is_pressed(&self) -> bool {
        self.machine.clearance() < 0.0
    }

    /// The blades in contact at the instant that is shown, numbered from 1.
    pub fn touching_blades(&self) -> Vec<u32> {
        let Some(moment) = self.shown() else { return Vec::new() };
        let polygon = &self.machine.polygon;
        let within = |most: f64| {
            let gaps = (1..=polygon.blades).zip(&moment.gaps);
            gaps.filter(|(_, gap)| **gap <= most).map(|(blade, _)| blade).collect()
        };
        match moment.active_set {
            _ if self.has_lining() => within(-f64::MIN_POSITIVE),
            ActiveSet::Many => within(CLOSED * polygon.clearance),
            touching => touching.sides().flat_map(|side| polygon.blades_of_side(side)).collect(),
        }
    }

    /// The blade that is deepest in the lining at the instant that is shown, and its
    /// gap \[m\].
    pub fn deepest(&self) -> Option<(u32, f64)> {
        let gaps = (1..).zip(self.shown()?.gaps.iter().copied());
        gaps.filter(|(_, gap)| *gap < 0.0).min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// A gap in words: how far a blade is from the casing, or how deep in its lining.
    pub fn gap_words(&self, gap: f64) -> String {
        match self.has_lining() && gap < 0.0 {
            true => format!("{} into the lining", readable(-gap, "m")),
            false if gap.abs() <= CLOSED * self.machine.polygon.clearance => "touches".into(),
            false => readable(gap, "m"),
        }
    }

    /// The blades in a lining at the instant that is shown, in words.
    pub(super) fn in_the_lining(&self) -> String {
        let touching = self.touching_blades();
        let all = self.machine.polygon.blades as usize;
        let who = match touching.as_slice() {
            [] => return "no contact".into(),
            [blade] => format!("blade {blade}"),
            some if some.len() == all => "all blades".into(),
            some => format!("{} blades", some.len()),
        };
        match self.deepest() {
            Some((_, gap)) if touching.len() == 1 => format!("{who}, {}", self.gap_words(gap)),
            Some((blade, gap)) => {
                format!("{who}, deepest {blade}: {}", readable(-gap, "m"))
            }
            None => who,
        }
    }
}
