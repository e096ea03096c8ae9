//! The head: the one instant of a film that the screen shows.

use std::sync::Arc;

use super::run::Film;
use crate::tui::engine::Moment;
use rubscope_solver::motion::{GoOn, Scripted};

/// A motion at the instant shown.
#[derive(Debug)]
pub struct Head {
    /// The motion with the changes to come.
    pub at: Scripted,
    /// The instant shown.
    pub moment: Arc<Moment>,
}

impl Head {
    /// Puts the head on the start of a film.
    pub fn of(film: &Film) -> Self {
        let at = film.before(0.0).unwrap_or(&film.ahead).clone();
        Self { moment: Arc::new(Moment::of(&at.motion)), at }
    }

    /// Moves to the instant `t` \[s\] of a film, forward or back; returns false if `go_on` stopped
    /// it on the way. A motion that fails on the way stays where it failed.
    pub fn seek(&mut self, film: &Film, t: f64, go_on: GoOn<'_>) -> bool {
        let now = self.at.motion.t_s();
        if let Some(copy) = film.before(t).filter(|copy| now > t || copy.motion.t_s() > now) {
            self.at = copy.clone();
        }
        if self.at.advance_while(t, go_on) == Ok(false) {
            return false;
        }
        // The next mean begins here.
        self.at.motion.take_mean_forces();
        self.moment = Arc::new(Moment::of(&self.at.motion));
        true
    }

    /// Plays on to `t` \[s\]; returns false if it did not get there, because `go_on` stopped it or
    /// the motion failed. Call [`Self::show`] afterwards.
    pub fn play(&mut self, t: f64, go_on: GoOn<'_>) -> bool {
        self.at.advance_while(t, go_on) == Ok(true)
    }

    /// Shows the instant that was played to. Its forces are the means since the last instant shown,
    /// because an impact of one step would be missed or seem too strong.
    pub fn show(&mut self) {
        let multipliers = self.at.motion.take_mean_forces();
        self.moment = Arc::new(Moment { multipliers, ..Moment::of(&self.at.motion) });
    }
}
