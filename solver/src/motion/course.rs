//! Where a run was on its way, so that a run with a tiny change need not go to its end: it
//! may stop once it goes beside the motion that the first one keeps, so near that what parts
//! them cannot grow enough by then.
//!
//! A run keeps its motion from where its waves and impacts are those of its end. What parts
//! two runs there is followed over two windows; what it grows by from the first to the
//! second it may grow by in each window to come.

use super::run::{Looker, VerdictReached};
use super::{Motion, Plane, Verdict};
use crate::tolerances::{COURSE_ALIKE, COURSE_APART, COURSE_LOOKS, COURSE_WINDOW};

/// Casing, blades and impacts of one run, at equal intervals from its start to its end.
#[derive(Clone, Debug, PartialEq)]
pub struct Course {
    end: f64,
    seen: Vec<Seen>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Seen {
    /// Waves of casing \[m\] and blades \[rad\].
    waves: [Plane; 2],
    impacts: u64,
}

impl Seen {
    fn of(motion: &Motion) -> Self {
        let state = motion.state();
        let waves = [state.u, state.alpha].map(|[c, s]| Plane::new(c, s));
        Self { waves, impacts: motion.contacts().impact_count }
    }
}

/// When the look of this number is, from 0, in a run to this end \[s\]; infinity after it.
fn instant(look: usize, end: f64) -> f64 {
    if look < COURSE_LOOKS {
        end * ((look + 1) as f64 / COURSE_LOOKS as f64)
    } else {
        f64::INFINITY
    }
}

impl Course {
    /// Of a run from its start to this end \[s\], not yet looked at.
    #[must_use]
    pub fn over(end: f64) -> Self {
        Self { end, seen: Vec::new() }
    }

    /// What each window has seen.
    fn windows(&self) -> Vec<Window> {
        let mut before = 0;
        let window = |seen: &[Seen]| {
            let until = seen.last().map_or(before, |seen| seen.impacts);
            let impacts = (until - before) as f64;
            before = until;
            let sizes = [0, 1].map(|k| {
                let sizes = seen.iter().map(|seen| seen.waves[k].norm());
                sizes
                    .fold([f64::INFINITY, 0.0], |[low, high], size| [size.min(low), size.max(high)])
            });
            Window { sizes, impacts }
        };
        self.seen.chunks(COURSE_WINDOW).map(window).collect()
    }

    /// The look from which on it keeps its motion, and the sizes of its waves.
    fn kept(&self) -> Option<(usize, [f64; 2])> {
        let windows = self.windows();
        let last = *windows.last().filter(|_| self.seen.len() == COURSE_LOOKS)?;
        let alike = windows.iter().rev().take_while(|window| window.is_as(&last)).count();
        Some(((windows.len() - alike) * COURSE_WINDOW, last.sizes.map(|[_, high]| high)))
    }
}

/// The smallest and the largest size of both waves in some looks, and the impacts.
#[derive(Clone, Copy, Debug)]
struct Window {
    sizes: [[f64; 2]; 2],
    impacts: f64,
}

impl Window {
    /// Whether the motion is that of another window. An impact may be of either.
    fn is_as(&self, other: &Self) -> bool {
        let near = |one: f64, other: f64, size: f64| (one - other).abs() <= COURSE_ALIKE * size;
        let same_sizes = self.sizes.iter().zip(&other.sizes).all(|(one, other)| {
            let [_, size] = *other;
            one.iter().zip(other).all(|(one, other)| near(*one, *other, size))
        });
        let apart = (self.impacts - other.impacts).abs();
        same_sizes && (apart <= 1.0 || near(self.impacts, other.impacts, other.impacts))
    }
}

impl Looker for Course {
    fn due(&self) -> f64 {
        instant(self.seen.len(), self.end)
    }

    fn see(&mut self, motion: &Motion) -> bool {
        self.seen.push(Seen::of(motion));
        true
    }
}

/// A run beside the one of a course.
#[derive(Debug)]
pub(super) struct Beside<'a> {
    course: &'a Course,
    from: usize,
    sizes: [f64; 2],
    looks: usize,
    /// How far apart both were at each look since `from`, as parts of their waves.
    apart: Vec<f64>,
    agrees: bool,
    /// Whether the run goes on where it is known to agree.
    goes_on: bool,
}

impl<'a> Beside<'a> {
    /// Beside the run that came to this verdict; none where it keeps no motion in contact.
    pub fn of(course: &'a Course, reached: VerdictReached) -> Option<Self> {
        let slides = matches!(reached.verdict, Verdict::Slip | Verdict::Whirl);
        let (from, sizes) = course.kept().filter(|_| slides)?;
        let (apart, agrees) = (Vec::new(), false);
        Some(Self { course, from, sizes, looks: 0, apart, agrees, goes_on: false })
    }

    /// Lets the run go on where it is known to agree.
    pub fn going_on(self) -> Self {
        Self { goes_on: true, ..self }
    }

    /// Whether it stays beside that run to the end.
    pub fn agrees(&self) -> bool {
        self.agrees
    }

    /// A bound on how far apart both will be at the end, if what parts them goes on to grow
    /// as it did.
    fn in_the_end(&self) -> f64 {
        let most =
            |window: Option<&[f64]>| window.map(|all| all.iter().copied().fold(0.0, f64::max));
        let mut windows = self.apart.rchunks(COURSE_WINDOW);
        let [now, before] = [windows.next(), windows.next()].map(most);
        let Some((now, before)) = now.zip(before).filter(|_| self.apart.len() >= 2 * COURSE_WINDOW)
        else {
            return f64::INFINITY;
        };
        let growth = if now > before { now / before } else { 1.0 };
        let left = (COURSE_LOOKS - self.looks) as f64 / COURSE_WINDOW as f64;
        now * growth.powf(left)
    }
}

impl Looker for Beside<'_> {
    fn due(&self) -> f64 {
        if self.agrees { f64::INFINITY } else { instant(self.looks, self.course.end) }
    }

    fn see(&mut self, motion: &Motion) -> bool {
        let there = self.course.seen.get(self.looks).filter(|_| self.looks >= self.from);
        self.looks += 1;
        let Some(there) = there else { return true };
        let here = Seen::of(motion);
        let parts = (0..2).map(|k| {
            let apart = (here.waves[k] - there.waves[k]).norm();
            if apart > 0.0 { apart / self.sizes[k] } else { 0.0 }
        });
        let parts = parts.sum();
        self.apart.push(if here.impacts == there.impacts { parts } else { f64::INFINITY });
        self.agrees = self.in_the_end() < COURSE_APART;
        self.goes_on || !self.agrees
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::{run_to_verdict, to_the_end};
    use crate::scene::Scene;

    /// A course of these sizes of the casing's wave, one for each window.
    fn course(size: impl Fn(usize) -> f64) -> Course {
        let at = |look: usize| {
            let wave = Plane::cis(look as f64) * size(look / COURSE_WINDOW);
            Seen { waves: [wave, Plane::default()], impacts: look as u64 }
        };
        Course { end: 1.0, seen: (0..COURSE_LOOKS).map(at).collect() }
    }

    #[test]
    fn a_motion_is_kept_from_where_its_waves_and_impacts_are_those_of_the_end() {
        let windows = COURSE_LOOKS / COURSE_WINDOW;
        assert_eq!(course(|_| 2.0).kept(), Some((0, [2.0, 0.0])));
        let grown = course(|window| if window < 5 { 1.0 } else { 2.0 });
        assert_eq!(grown.kept(), Some((5 * COURSE_WINDOW, [2.0, 0.0])));
        let late = course(|window| if window == windows - 2 { 1.0 } else { 2.0 });
        assert_eq!(late.kept(), Some((COURSE_LOOKS - COURSE_WINDOW, [2.0, 0.0])));
        let mut busy = course(|_| 2.0);
        busy.seen.iter_mut().skip(3 * COURSE_WINDOW).for_each(|seen| seen.impacts += 2);
        assert_eq!(busy.kept(), Some((4 * COURSE_WINDOW, [2.0, 0.0])));
        let mut short = course(|_| 2.0);
        short.seen.pop();
        assert_eq!(short.kept(), None);
    }

    #[test]
    fn what_grows_by_a_part_in_each_window_is_followed_to_the_end() {
        let course = course(|_| 1.0);
        let beside = |apart: Vec<f64>| {
            let looks = apart.len();
            let (from, sizes) = (0, [1.0, 0.0]);
            Beside { course: &course, from, sizes, looks, apart, agrees: false, goes_on: false }
                .in_the_end()
        };
        let grows = |factor: f64, windows: usize| {
            let at = |look: usize| 1e-9 * factor.powi((look / COURSE_WINDOW) as i32);
            beside((0..windows * COURSE_WINDOW).map(at).collect())
        };
        let all = (COURSE_LOOKS / COURSE_WINDOW) as i32;
        assert_eq!(grows(1.0, 1), f64::INFINITY);
        assert_eq!(grows(1.0, 2), 1e-9);
        assert!((grows(0.5, 4) / (1e-9 * 0.5_f64.powi(3)) - 1.0).abs() < 1e-12);
        for windows in [2, 5] {
            let expected = 1e-9 * 1.5_f64.powi(all - 1);
            assert!((grows(1.5, windows) / expected - 1.0).abs() < 1e-9);
        }
        // Another number of impacts on the way is no agreement.
        let mut other = vec![1e-12; 2 * COURSE_WINDOW];
        other[COURSE_WINDOW] = f64::INFINITY;
        assert_eq!(beside(other), f64::INFINITY);
    }

    #[test]
    fn a_run_is_beside_itself_and_not_beside_another_one() {
        let scene = Scene::builtin("rub").unwrap().with(&[("solver.kind", "event")]).unwrap();
        let end = scene.solver.end_s;
        let mut course = Course::over(end);
        let follow = |looker: &mut dyn Looker, pulse: f64| {
            let scene = scene.perturbed(|scene| scene.operation.pulse_n *= pulse);
            let mut motion = Motion::new(&scene);
            while looker.due() <= end {
                motion.advance(looker.due()).unwrap();
                if !looker.see(&motion) {
                    break;
                }
            }
            motion.t_s()
        };
        assert_eq!(follow(&mut course, 1.0), end);
        let reached = run_to_verdict(&scene, &to_the_end).unwrap();
        for (pulse, agrees) in [(1.0, true), (1.0 + 1e-9, true), (1.2, false)] {
            let mut beside = Beside::of(&course, reached).unwrap();
            let stopped = follow(&mut beside, pulse);
            assert_eq!((beside.agrees(), stopped < 0.5 * end), (agrees, agrees), "{pulse}");
        }
    }
}
