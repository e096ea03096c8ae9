//! An engine without thread and clock: every look moves the motion on by the
//! same amount, and the solver's speed is a fixed figure. For tests and
//! pictures that must come out the same on every machine.

use std::time::Duration;

use super::Player;
use crate::tui::engine::{Engine, Order, Pace, Snapshot};

/// The engine driven by hand.
#[derive(Debug)]
pub struct Stepwise {
    /// Motion between two looks \[s\].
    pub stride: f64,
    order: Option<Order>,
    player: Option<Player>,
    fresh: bool,
}

impl Stepwise {
    /// An engine that plays `stride` seconds of motion between two looks.
    #[must_use]
    pub fn new(stride: f64) -> Self {
        Self { stride, order: None, player: None, fresh: false }
    }
}

impl Engine for Stepwise {
    fn order(&mut self, order: &Order) {
        self.order = Some(order.clone());
        self.fresh = true;
    }

    fn take(&mut self) -> Option<Snapshot> {
        let order = self.order.as_ref()?;
        let player = match &mut self.player {
            Some(player) => {
                player.apply(order);
                player
            }
            None => self.player.insert(Player::patient(order.clone(), Duration::MAX)),
        };
        while player.is_computing() {
            player.compute();
        }
        if order.playing {
            player.play(self.stride);
        } else if !self.fresh {
            return None;
        }
        self.fresh = false;
        let mut snapshot = player.snapshot();
        snapshot.pace = Pace {
            step_s: snapshot.pace.step_s.map(|_| 42e-9),
            run_s: Some(42e-3),
            limited: false,
        };
        Some(snapshot)
    }
}
