//! The run on the screen and its results. Snapshots of the engine are applied here; results of an
//! older run or of other knob values are dropped.

use super::model::{App, Baseline, Ranges, Run};
use super::play::begin_s;
use crate::sheet::line::clean;
use crate::tui::axis::{AutoRange, instant, readable};
use crate::tui::engine::{Moment, Move, Order, PageRecord, Results, Snapshot};
use crate::tui::film::{FilmPlan, other_law};
use crate::tui::history::{Bin, Channel, wider};
use crate::tui::knobs::{KNOBS, Knob, knob_of};
use crate::tui::views::id::ViewId;
use rubscope_solver::model::Machine;
use rubscope_solver::motion::ActiveSet;
use rubscope_solver::scene::CheckedScene;
use rubscope_solver::scene::keys::PULSE;

/// A corner held for this fraction of a page counts as standing still.
const STILL: f64 = 0.2;

impl Baseline {
    /// Describes the pinned run: up to two knobs that differ from the current scene, and the
    /// verdict.
    pub fn what(&self, app: &App) -> String {
        let differs = |knob: &&Knob| knob.get(&self.scene) != knob.get(&app.scene);
        let shown = |knob: &Knob| format!("{} {}", knob.label, knob.text(&self.scene));
        let mut parts: Vec<String> = KNOBS.iter().filter(differs).take(2).map(shown).collect();
        parts.push(self.word.clone());
        parts.join(", ")
    }
}

impl Ranges {
    /// Creates ranges around the clearance \[m\]; it is negative if the blades rub at rest.
    pub fn of(clearance: f64) -> Self {
        let size = clearance.abs();
        let gaps = match clearance < 0.0 {
            true => AutoRange::new(-2.2 * size, 1.2 * size),
            false => AutoRange::new(-0.2 * clearance, 2.2 * clearance),
        };
        Self {
            casing: AutoRange::new(-1.25 * size, 1.25 * size),
            blades: AutoRange::new(-1e-9, 1e-9),
            gaps,
            rim: AutoRange::new(-size, size),
            follow: true,
        }
    }
}

impl Run {
    /// Creates the run of a scene before its first snapshot.
    pub fn of(scene: &CheckedScene, machine: &Machine) -> Self {
        Self {
            film: FilmPlan::new(scene),
            number: 0,
            runs: 0,
            latest: Snapshot::default(),
            compare: false,
            baseline: None,
            ranges: Ranges::of(machine.clearance()),
            answer: None,
        }
    }

    /// Begins a run of a scene. Results of studies stay until new ones arrive.
    pub fn restart(&mut self, scene: &CheckedScene) {
        self.runs += 1;
        self.show(FilmPlan::new(scene));
        let results = std::mem::take(&mut self.latest.results);
        self.latest = Snapshot { results, ..Snapshot::default() };
    }

    /// Shows another film; what was computed of the one before is dropped.
    pub fn show(&mut self, film: FilmPlan) {
        (self.film, self.number) = (film, self.number + 1);
        let Results { found, working, pinned_page, pace, .. } =
            std::mem::take(&mut self.latest.results);
        self.latest.results = Results { found, working, pinned_page, pace, ..Results::default() };
    }

    /// Continues the run past its end. What is known stays until the rest is computed.
    pub fn extend(&mut self) {
        (self.film, self.number) = (self.film.extended(), self.number + 1);
    }

    /// Switches the comparison with the other contact law.
    pub fn set_compare(&mut self, compare: bool) {
        if compare != self.compare {
            self.compare = compare;
            let results = &mut self.latest.results;
            (results.comparison, results.comparison_page) = (None, None);
        }
    }
}

impl App {
    /// Builds the order for the engine from the current state.
    pub fn order(&self) -> Order {
        Order {
            scene: self.scene.clone(),
            film: self.run.film.clone(),
            number: self.run.number,
            run: self.run.runs,
            pinned: self.run.baseline.as_ref().map(|baseline| baseline.film.clone()),
            compare: self.run.compare,
            moves: self.play.moves.clone(),
            playing: self.play.playing,
            rate: self.play.rate(),
            slow_at_events: self.play.tempo.slow_at_events,
            page: self.page(),
            cursor_s: self.reading.at_s,
            open: ViewId::all().filter(|view| self.is_open(*view)).collect(),
            map: self.map_choice(),
            cell: self.cell_in(ViewId::Map),
            range: self.layout.range,
            every_law: !self.is_overview(),
        }
    }

    /// Returns whether the large chart shows both contact laws; then it is the only chart.
    pub fn compares(&self) -> bool {
        self.run.compare && self.is_large(ViewId::Response)
    }

    /// Returns the state at the time shown: that of the cursor, or of the playing motion. Until the
    /// engine has computed it, the state shown before. `None` before the first snapshot.
    pub fn shown(&self) -> Option<&Moment> {
        self.run.latest.moment.as_deref()
    }

    /// As [`Self::shown`], but `None` until the engine has computed the requested time.
    pub fn shown_now(&self) -> Option<&Moment> {
        let step = self.scene.solver.step_s;
        self.shown().filter(|moment| (moment.state.t_s - self.now()).abs() <= step)
    }

    /// Returns the rotor speed at the time shown \[rad/s\]; negative if the rotor turns backward.
    pub fn speed(&self) -> f64 {
        let moment = self.shown();
        moment.map_or(self.scene.operation.speed_rad_s, |moment| moment.speed)
    }

    /// Returns why the motion failed before the time shown; `None` if it did not.
    pub fn failure(&self) -> Option<&String> {
        self.shown()?.failure.as_ref()
    }

    /// Returns the results of the current run.
    pub fn results(&self) -> &Results {
        &self.run.latest.results
    }

    /// Replaces the current scene. It restarts the run, or, if `live`, changes the motion at the
    /// time shown, from which it goes on.
    pub fn set_scene(&mut self, scene: CheckedScene, live: bool) {
        if live {
            self.depart();
            let film = self.run.film.changed(self.played_s(), &scene);
            self.show_film(film, scene);
        } else {
            self.use_scene(scene);
            self.restart();
        }
    }

    /// Shows another film of the same run, which goes on at the time played to, at most at its end,
    /// with the values of `scene`.
    pub fn show_film(&mut self, film: FilmPlan, scene: CheckedScene) {
        self.use_scene(scene);
        let end = film.end_s;
        self.run.show(film);
        self.reading.at_s = self.reading.at_s.map(|t| t.min(end));
        if self.played_s() > end {
            self.play.moves.push(Move::To(end));
        }
    }

    fn use_scene(&mut self, scene: CheckedScene) {
        let clearance = self.machine.clearance();
        self.scene = scene;
        self.machine = self.scene.machine();
        self.locks = Default::default();
        self.ranges = Default::default();
        if self.machine.clearance() != clearance {
            let follow = self.run.ranges.follow;
            self.run.ranges = Ranges { follow, ..Ranges::of(self.machine.clearance()) };
        }
    }

    /// Restarts the run. A cursor keeps its time and page.
    pub fn restart(&mut self) {
        self.run.restart(&self.scene);
        self.play.restart(begin_s(&self.scene));
        self.play.middle_s = self.play.middle_s.filter(|_| self.reading.at_s.is_some());
    }

    /// Pins the run, to be drawn behind later ones, or removes the pinned one.
    pub fn pin(&mut self) {
        if self.run.baseline.take().is_some() {
            self.run.latest.results.pinned_page = None;
            self.status = Some("baseline removed".into());
            return;
        }
        if self.full_run().is_none() && !self.is_given_up() {
            self.status = Some("not pinned: the run has no verdict yet".into());
            return;
        }
        let (film, scene) = (self.run.film.clone(), self.scene.clone());
        let word = self.verdict_word();
        let what = format!("{word} at {}", readable(self.speed(), "rad/s"));
        self.run.baseline = Some(Baseline { film, word, scene });
        self.status = Some(format!("pinned behind the next runs: {what}"));
    }

    /// Fires the pulse into the playing motion; the cursor, which shows another time, goes.
    pub fn fire(&mut self) {
        self.depart();
        let t = self.played_s();
        if !self.run.film.has_room(t) {
            self.status = Some("not fired: the run has too many changes; r restarts".into());
            return;
        }
        self.knobs.remember(self.past());
        self.run.show(self.run.film.fired(t));
        let pulse = knob_of(PULSE).map(|knob| knob.text(&self.scene));
        let at = instant(t);
        self.status = pulse.map(|pulse| format!("pulse of {pulse} fired at {at}"));
    }

    /// Switches the comparison with the other contact law.
    pub fn compare(&mut self) {
        match other_law(&self.scene) {
            Err(why) if !self.run.compare => {
                let law = self.scene.solver.contact.other();
                self.status = Some(clean(&format!("no {law} law beside this: {why}")));
            }
            _ => {
                self.run.set_compare(!self.run.compare);
                if self.run.compare {
                    self.show(ViewId::Response);
                }
            }
        }
    }

    /// Applies a snapshot; returns false if it belongs to an older run.
    pub fn apply_snapshot(&mut self, mut snapshot: Snapshot) -> bool {
        if snapshot.trouble.is_some() {
            self.run.latest.trouble = snapshot.trouble;
            return true;
        }
        // The header shows the latest verdict with its knob value, even if it is outdated.
        self.run.answer = snapshot.results.answer.take().or(self.run.answer.take());
        if snapshot.run != self.run.runs {
            return false;
        }
        let known = std::mem::take(&mut self.run.latest);
        if snapshot.number != self.run.number {
            snapshot.results = known.results;
        }
        self.play.moves.drop_made(snapshot.moved);
        self.run.latest = Snapshot { trouble: known.trouble, ..snapshot };
        self.fit_to_page();
        self.report_moves();
        self.check_lesson();
        true
    }

    /// Grows the ranges to include the page of both contact laws, which share their axes. For a new
    /// film, or a new page of the playing motion, those of casing and blades may also shrink; on the
    /// first page that of the casing not below the clearance.
    fn fit_to_page(&mut self) {
        if !self.run.ranges.follow {
            return;
        }
        let number = self.page_number();
        let is_whole = |page: &PageRecord| page.is_whole && page.page == self.page();
        let fitted = Some((self.run.number, number));
        let is_new = self.results().page.as_deref().is_some_and(is_whole)
            && std::mem::replace(&mut self.play.fitted, fitted) != fitted;
        let pages = [self.record(), self.recorded(self.results().comparison_page.as_deref())];
        let of =
            |channels| pages.into_iter().filter_map(|bins| extremes(bins, channels)).reduce(wider);
        let [casing, blades, rim] = [CASING, BLADES, RIM].map(of);
        // Blades that rub at rest have no clearance to include.
        let clearance = self.machine.clearance().max(0.0);
        let [casing, rim] = [casing, rim].map(|data| match number {
            0 => Some(wider(data?, (-clearance, clearance))),
            _ => data,
        });
        let most = of([Channel::Amplitude; 2]).map(|(_, most)| most);
        let least = of([Channel::Gap; 2]).map(|(least, _)| least).filter(|_| self.has_lining());
        let (roomiest, usual) = (self.roomiest(), self.usual_reach());
        let ranges = &mut self.run.ranges;
        for (range, data) in
            [(&mut ranges.casing, casing), (&mut ranges.blades, blades), (&mut ranges.rim, rim)]
        {
            match data {
                Some((low, high)) if is_new => range.follow(low, high),
                data => grow(range, data),
            }
        }
        // With radial coupling the tips move outward, so the amplitude can exceed the clearance.
        let wide = most.filter(|most| *most > usual).map(|most| (-most, most));
        grow(&mut ranges.rim, wide);
        // The largest gap is about the clearance plus the amplitude. With a lining, gaps can also
        // be negative.
        let low = least.map_or(ranges.gaps.low, |least| least.min(ranges.gaps.low));
        grow(&mut ranges.gaps, most.map(|most| (low, roomiest + most)));
    }

    /// Sets the status message when a jump is complete or the run has ended.
    fn report_moves(&mut self) {
        let (number, met) = self.run.latest.met;
        if self.play.jump.take_if(|jump| *jump == number).is_some() {
            self.status = Some(match met {
                Some(mark) => format!("{}: {}", instant(mark.t_s), self.happening(mark.what)),
                None => "no change of contact comes soon".into(),
            });
        }
        if self.play.playing && self.is_at_end() {
            (self.play.playing, self.play.stopped_by_end) = (false, true);
            // Do not cover the message about a key, or a question.
            if self.dialogue.is_closed() {
                self.status.get_or_insert("the end of the run; Space goes on".into());
            }
        }
    }

    /// Returns whether the wave stands still in the frame of the blades: playback is paused, or a
    /// corner has been held for a while.
    pub fn is_still(&self) -> bool {
        !self.play.playing
            || self.shown().is_some_and(|moment| {
                let held = moment.state.t_s - moment.since;
                matches!(moment.active_set, ActiveSet::Corner(..)) && held > self.page_s() * STILL
            })
    }
}

const CASING: [Channel; 2] = [Channel::UC, Channel::US];
const RIM: [Channel; 2] = [Channel::RimX, Channel::RimY];
const BLADES: [Channel; 2] = [Channel::AlphaC, Channel::AlphaS];

/// Returns the lowest and highest value of some channels; `None` if no bin has finite values.
fn extremes(bins: &[Bin], channels: [Channel; 2]) -> Option<(f64, f64)> {
    let is_finite = |(low, high): &(f64, f64)| low.is_finite() && high.is_finite();
    let of = |channel| bins.iter().map(move |bin| bin.span(channel)).filter(is_finite);
    channels.into_iter().filter_map(|channel| of(channel).reduce(wider)).reduce(wider)
}

/// Extends a range if the data exceed it.
fn grow(range: &mut AutoRange, data: Option<(f64, f64)>) {
    if let Some((low, high)) = data
        && (low < range.low || high > range.high)
    {
        range.follow(low.min(range.low), high.max(range.high));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::engine::{FullRunState, Sensitive};
    use crate::tui::views::spectrum::lines::Spectrum;
    use rubscope_solver::scene::Scene;

    #[test]
    fn a_run_without_a_verdict_is_not_pinned() {
        let mut app = crate::tui::app::tests::on_screen();
        app.pin();
        assert_eq!(app.status.as_deref(), Some("not pinned: the run has no verdict yet"));
        assert!(app.run.baseline.is_none());
        app.run.latest.results.full_run = Some(FullRunState::GivenUp(0.2));
        app.pin();
        assert_eq!(app.run.baseline.as_ref().unwrap().word, "NO FORECAST");
        // A pinned run can be removed at any time.
        app.run.latest.results.full_run = None;
        app.pin();
        assert!(app.run.baseline.is_none());
    }

    #[test]
    fn what_was_computed_of_a_motion_is_forgotten_with_it_and_its_studies_stay() {
        let scene = Scene::base().checked().unwrap();
        let mut run = Run::of(&scene, &scene.machine());
        run.latest.results.found.spectrum =
            Some(Spectrum::of(&scene, (0.0, 1.0, Vec::new())).into());
        for begins in [false, true] {
            run.latest.results.sensitive = Sensitive::GivenUp;
            if begins {
                run.restart(&scene)
            } else {
                run.show(run.film.fired(1e-3))
            }
            assert_eq!(run.latest.results.sensitive, Sensitive::Unknown);
            assert!(run.latest.results.found.spectrum.is_some());
        }
        assert_eq!((run.number, run.runs), (2, 1));
        run.set_compare(true);
        assert!(run.compare);
    }
}
