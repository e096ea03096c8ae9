//! What a film shows: a scene, the live changes on the way, and the end.

use rubscope_solver::motion::{Change, Script};
use rubscope_solver::scene::keys::differences;
use rubscope_solver::scene::{CheckedScene, ContactLaw, Scene, SceneError, SolverKind};

/// Largest number of live changes of a film; a change of the speed counts as two.
const MOST_CHANGES: usize = 5000;

/// A scene, live changes with their times, and the end of the run.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmPlan {
    /// The scene at t = 0.
    pub scene: CheckedScene,
    /// The live changes and pulses.
    pub script: Script,
    /// Start of the last part \[s\]: the latest change, or the end before it was extended.
    pub from_s: f64,
    /// End of the run \[s\].
    pub end_s: f64,
}

impl FilmPlan {
    /// Plans the run of a scene without changes.
    pub fn new(scene: &CheckedScene) -> Self {
        let (script, end_s) = (Script::default(), scene.solver.end_s);
        Self { scene: scene.clone(), script, from_s: 0.0, end_s }
    }

    /// Returns the scene with the changes up to `t` \[s\].
    pub fn scene_at(&self, t: f64) -> &CheckedScene {
        let scenes = self.script.changes().iter().take_while(|(at, _)| *at <= t);
        let scenes = scenes.filter_map(|(_, change)| match change {
            Change::Parameters(scene) => Some(&**scene),
            _ => None,
        });
        scenes.last().unwrap_or(&self.scene)
    }

    /// Returns whether a change at `t` \[s\] still has room.
    pub fn has_room(&self, t: f64) -> bool {
        self.script.changes().iter().filter(|(at, _)| *at <= t).count() + 2 <= MOST_CHANGES
    }

    /// Cuts the film at `t` \[s\], where the scene becomes `now`. An earlier change of the scene at
    /// the same instant is replaced.
    pub fn changed(&self, t: f64, now: &CheckedScene) -> Self {
        let mut cut = self.cut(t);
        let replaced = |(at, change): &&(f64, Change)| *at == t && *change != Change::Pulse;
        let count = cut.script.changes().iter().rev().take_while(replaced).count();
        cut = cut.without_last(count);
        let changes = Change::between(cut.scene_at(t), now);
        cut.with_changes(t, changes, now.solver.end_s)
    }

    /// Cuts the film at `t` \[s\], where the pulse is fired again.
    pub fn fired(&self, t: f64) -> Self {
        let length = self.scene_at(t).solver.end_s;
        self.cut(t).with_changes(t, vec![Change::Pulse], length)
    }

    /// Returns the film without the changes after `t` \[s\].
    fn cut(&self, t: f64) -> Self {
        let later = self.script.changes().iter().filter(|(at, _)| *at > t).count();
        self.without_last(later)
    }

    fn without_last(&self, count: usize) -> Self {
        let kept = self.script.changes().iter().rev().skip(count).rev().cloned().collect();
        Self { script: Script::new(kept), ..self.clone() }
    }

    fn with_changes(self, t: f64, changes: Vec<Change>, length: f64) -> Self {
        let added = changes.into_iter().map(|change| (t, change));
        let all = self.script.changes().iter().cloned().chain(added).collect();
        Self { script: Script::new(all), from_s: t, end_s: t + length, ..self }
    }

    /// Returns the film with its end moved by the length of the run.
    pub fn extended(&self) -> Self {
        let length = self.scene_at(self.end_s).solver.end_s;
        Self { from_s: self.end_s, end_s: self.end_s + length, ..self.clone() }
    }

    /// Returns the changes as arguments of `run --at`: time \[s\] and change.
    pub fn arguments(&self) -> Vec<(f64, String)> {
        let mut before = &self.scene;
        let mut arguments = Vec::new();
        for (t, change) in self.script.changes() {
            match change {
                Change::Pulse => arguments.push((*t, "pulse".into())),
                // The scene that follows has the speed.
                Change::Rotor { .. } => {}
                Change::Parameters(now) => {
                    let keys = differences(before, now);
                    arguments.extend(keys.map(|(path, text)| (*t, format!("{path}={text}"))));
                    before = now;
                }
            }
        }
        arguments
    }

    /// Returns the same film under the other contact law; `None` if a scene of it does not allow
    /// the other law.
    pub fn under_other_law(&self) -> Option<Self> {
        let other = |(t, change): &(f64, Change)| {
            let change = match change {
                Change::Parameters(scene) => Change::Parameters(other_law(scene).ok()?.into()),
                change => change.clone(),
            };
            Some((*t, change))
        };
        let changes: Option<_> = self.script.changes().iter().map(other).collect();
        let scene = other_law(&self.scene).ok()?;
        Some(Self { scene, script: Script::new(changes?), ..self.clone() })
    }

    /// Returns the scene of the reference: that of the event solver, whose contact only pushes. `None` if the scene uses
    /// the event solver already, has an elastic lining, which is a different machine, or has
    /// something else that the event solver does not support, and for a film with changes.
    pub fn reference(&self) -> Option<CheckedScene> {
        let solver = &self.scene.solver;
        if solver.kind == SolverKind::Event
            || solver.contact == ContactLaw::Smooth
            || !self.script.changes().is_empty()
        {
            return None;
        }
        self.scene.as_reference().checked().ok()
    }
}

/// Returns the scene under the other contact law, with the explicit solver, which supports both.
///
/// # Errors
/// Says in one line why the scene does not allow the other law.
pub fn other_law(scene: &Scene) -> Result<CheckedScene, SceneError> {
    let mut scene = scene.clone();
    scene.solver.kind = SolverKind::Explicit;
    scene.solver.contact = scene.solver.contact.other();
    scene.checked()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The paper's scene at a rotor speed.
    fn at(speed: f64) -> CheckedScene {
        let mut scene = Scene::base();
        scene.operation.speed_rad_s = speed;
        scene.checked().unwrap()
    }

    #[test]
    fn a_change_cuts_what_is_later_and_replaces_one_at_the_same_instant() {
        let film = FilmPlan::new(&at(500.0)).changed(2e-3, &at(450.0)).fired(3e-3);
        let said = |film: &FilmPlan| {
            let all = film.arguments().into_iter();
            all.map(|(t, what)| format!("{t:?}:{what}")).collect::<Vec<_>>()
        };
        assert_eq!([1e-3, 2e-3].map(|t| film.scene_at(t).operation.speed_rad_s), [500.0, 450.0]);
        assert_eq!(said(&film), ["0.002:operation.speed_rad_s=450.0", "0.003:pulse"]);
        assert_eq!((film.from_s, film.end_s), (3e-3, 3e-3 + film.scene.solver.end_s));
        let turned = film.changed(3e-3, &at(440.0)).changed(3e-3, &at(430.0));
        assert_eq!(said(&turned)[2..], ["0.003:operation.speed_rad_s=430.0"]);
        assert_eq!(said(&turned.changed(2e-3, &at(400.0))), ["0.002:operation.speed_rad_s=400.0"]);
        // Turned back to what it was: nothing is left to say.
        assert!(said(&turned.changed(2e-3, &at(500.0))).is_empty());
        assert_eq!(said(&turned.under_other_law().unwrap()), said(&turned));
        assert!(film.reference().is_none() && FilmPlan::new(&at(500.0)).reference().is_some());
    }

    #[test]
    fn a_film_has_room_for_so_many_changes() {
        let changes = (0..MOST_CHANGES).map(|k| (1e-6 * k as f64, Change::Pulse)).collect();
        let film = FilmPlan { script: Script::new(changes), ..FilmPlan::new(&at(500.0)) };
        assert!(!film.has_room(1.0) && film.has_room(1e-3));
    }
}
