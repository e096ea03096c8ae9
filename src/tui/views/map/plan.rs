//! The map of the explorer: two knobs over sensible ranges, under the scene's own contact law,
//! solver and model or under the other law. It is computed in coarse blocks first, then in finer
//! ones in a fixed order.

use std::f64::consts::TAU;

use crate::tui::axis::nice_step;
use crate::tui::knobs::{KNOBS, Knob, knob_of};
use crate::tui::views::locked::curves::speed_range;
use rubscope_solver::motion::Verdict;
use rubscope_solver::scene::{Allowed, ContactLaw, Scene, SolverKind, keys};
use rubscope_solver::study::overlay::{Curve, threshold_curves};
use rubscope_solver::study::{Axis, Cell, Map, MapPlan};

/// Most cells across and up; a tenth of a decade is a cell of four.
const CELLS: [u32; 2] = [81, 41];
/// The key of the torque on the blades.
const TORQUE: &str = keys::EXCITATION;
/// The key of the friction of blades and casing.
const FRICTION: &str = keys::FRICTION;
/// The slowest speed of a map with friction, in parts of the fastest.
const SLOWEST: f64 = 0.1;
/// Pulses of the map \[N\].
const PULSES: [f64; 2] = [1e3, 1e7];
/// The part of a bar that is left out at each end where a scene is refused there.
const REFUSED: f64 = 0.025;

/// Choices for the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapChoice {
    /// The contact law, where it is not the scene's own.
    pub law: Option<ContactLaw>,
    /// The key across.
    pub x: MapAxis,
    /// The key up.
    pub y: MapAxis,
    /// Whether speeds are shown in turns a minute, of which the cells are round values.
    pub rpm: bool,
}

impl Default for MapChoice {
    fn default() -> Self {
        let axis = |path| MapAxis { path, anchor: 0.0 };
        Self { law: None, x: axis(keys::SPEED), y: axis(keys::PULSE), rpm: false }
    }
}

/// A key on an axis. Its range does not change while the knob is turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapAxis {
    /// Dotted path of the key.
    pub path: &'static str,
    /// The value of the key when it was put on the axis.
    pub anchor: f64,
}

impl MapChoice {
    /// Creates the same for another opened scene.
    pub fn anchored(mut self, scene: &Scene) -> Self {
        for axis in [&mut self.x, &mut self.y] {
            let value = knob_of(axis.path).and_then(|knob| knob.number(scene));
            axis.anchor = value.unwrap_or(axis.anchor);
        }
        self
    }

    /// Returns the map of a scene.
    ///
    /// # Errors
    /// The scene has no such map; the reason in one line.
    pub fn plan(&self, scene: &Scene) -> Result<MapPlan, String> {
        let mut scene = scene.clone();
        if let Some(law) = self.law {
            scene.solver.contact = law;
            scene.make_compatible(|key| key == keys::LAW);
        }
        if [self.x, self.y].iter().any(|axis| axis.path == TORQUE) {
            // The event solver knows no torque on the blades.
            scene.solver.kind = SolverKind::Explicit;
        }
        // Friction has no direction while the rotor stands.
        let slides = scene.contact.friction != 0.0
            || [self.x, self.y].iter().any(|axis| axis.path == FRICTION);
        let plan = |without: f64| {
            let unit = if self.rpm { TAU / 60.0 } else { 1.0 };
            let x = self.x.over(&scene, CELLS[0], slides, without, unit)?;
            let y = self.y.over(&scene, CELLS[1], slides, without, unit)?;
            let mut scene = scene.clone();
            for axis in [&x, &y] {
                // The map stays the same while the knobs that it sweeps are turned.
                axis.apply(&mut scene, 0).map_err(|error| error.to_string())?;
            }
            let plan = MapPlan { scene, x, y, sensitivity: false };
            plan.check().map(|()| plan).map_err(|error| error.to_string())
        };
        plan(0.0).or_else(|_| plan(REFUSED))
    }
}

/// Returns the knobs that can be on an axis.
pub fn numeric() -> impl Iterator<Item = &'static Knob> {
    let is_number = |allowed| matches!(allowed, Allowed::Real { .. } | Allowed::Whole { .. });
    KNOBS.iter().filter(move |knob| is_number(knob.allowed()))
}

impl MapAxis {
    /// Returns the axis over the bar of the knob, without a part at each end; for speeds, in round
    /// values of a unit.
    fn over(
        &self,
        scene: &Scene,
        most: u32,
        slides: bool,
        without: f64,
        unit: f64,
    ) -> Result<Axis, String> {
        let knob = knob_of(self.path).ok_or_else(|| format!("{} is no knob", self.path))?;
        let bar = knob.range_around(self.anchor, scene, &scene.machine());
        let (mut from, mut to, mut log) =
            bar.ok_or_else(|| format!("{} has no range", knob.label))?.ends(without);
        match self.path {
            keys::SPEED => {
                (from, to) = speeds(scene);
                if slides {
                    (from, to) = if to > 0.0 { (SLOWEST * to, to) } else { (from, SLOWEST * from) };
                }
            }
            // From below the pulse that was opened, if that is a small one.
            keys::PULSE => {
                let below = 10f64.powf((0.5 * self.anchor.abs()).log10().floor());
                from = if self.anchor == 0.0 { PULSES[0] } else { below.min(PULSES[0]) };
                (to, log) = (PULSES[1], true);
            }
            keys::STEP => to = to.min(0.9 * scene.stable_step()),
            _ => {}
        }
        let count = match knob.allowed() {
            // Each whole number once.
            Allowed::Whole { .. } => {
                (from, to) = (from.ceil(), to.floor());
                ((to - from).max(0.0) as u32).saturating_add(1).min(most)
            }
            _ if log => most,
            _ => {
                let is_speed = self.path == keys::SPEED;
                let unit = if is_speed { unit } else { 1.0 };
                let step = nice_step((to - from) / unit, most as usize - 1).unwrap_or(0.0) * unit;
                let [a, b] = [from, to].map(|end| end / step);
                let [first, last] =
                    if is_speed { [a.floor(), b.ceil()] } else { [a.round(), b.round()] };
                // Other ends than round ones are those of what the key allows.
                if is_speed || (a - first).abs() + (b - last).abs() < 1e-6 {
                    (from, to) = (first * step, last * step);
                    (last - first) as u32 + 1
                } else {
                    most
                }
            }
        };
        Axis::new(self.path, from, to, count, log).map_err(|error| error.to_string())
    }
}

/// Returns the range from rest to above every threshold, and to the present speed if it is far
/// outside, in the present direction of rotation.
fn speeds(scene: &Scene) -> (f64, f64) {
    let mut scene = scene.clone();
    let speed = scene.operation.speed_rad_s;
    let machine = scene.machine();
    let thresholds = [machine.lock_speed(), machine.dangerous_speed(), machine.critical_speed()];
    scene.operation.speed_rad_s = 1.3 * thresholds.into_iter().flatten().fold(1.0, f64::max);
    let usual = speed_range(&scene);
    scene.operation.speed_rad_s = speed;
    let fastest = if speed.abs() > usual { speed_range(&scene) } else { usual };
    if speed < 0.0 { (-fastest, 0.0) } else { (0.0, fastest) }
}

/// Sides of the blocks that one cell stands for, coarse to fine.
const BLOCKS: [u32; 4] = [8, 4, 2, 1];

/// A map that is being computed.
#[derive(Clone, Debug, PartialEq)]
pub struct LiveMap {
    /// Its plan and the cells so far.
    pub map: Map,
    /// Cells that were tried: a cell whose run takes too long stays empty.
    pub tried: usize,
    /// The threshold speeds over the map, where one axis is the speed.
    pub lines: Vec<Curve>,
}

impl LiveMap {
    /// Creates a map with nothing computed.
    pub fn of(plan: MapPlan) -> Self {
        let mut lines = threshold_curves(&plan);
        // Without damping two thresholds are one.
        let double = |line: &Curve, of: &[Curve]| {
            line.name == "Omega_lock"
                && of.iter().any(|c| c.name == "Omega_c" && c.points == line.points)
        };
        let all = lines.clone();
        lines.retain(|line| !line.points.is_empty() && !double(line, &all));
        Self { lines, map: Map::empty(plan), tried: 0 }
    }

    /// Returns what to draw at a cell: its own verdict, or that of the smallest block around it.
    pub fn shown(&self, column: u32, row: u32) -> Option<Cell> {
        let (x, y) = (self.map.plan.x.count, self.map.plan.y.count);
        BLOCKS
            .iter()
            .rev()
            .find_map(|&block| self.map.at(centre(column, block, x), centre(row, block, y)))
    }

    /// Returns whether all cells were tried.
    pub fn is_complete(&self) -> bool {
        self.tried >= self.map.cells.len()
    }
}

/// Returns the cell that stands for the block around a cell.
fn centre(cell: u32, block: u32, count: u32) -> u32 {
    (cell - cell % block + block / 2).min(count.saturating_sub(1))
}

/// Returns all cells of a map in the order in which they are computed, and how many of them cover
/// the whole map as the coarsest blocks.
pub fn coarse_first(plan: &MapPlan) -> (Vec<usize>, usize) {
    let (x, y) = (plan.x.count, plan.y.count);
    let mut taken = vec![false; plan.len()];
    let mut order = Vec::with_capacity(plan.len());
    let mut first = 0;
    for block in BLOCKS {
        let side = block as usize;
        for row in (0..y).step_by(side) {
            for column in (0..x).step_by(side) {
                let index = plan.index(centre(column, block, x), centre(row, block, y));
                if let Some(taken) = taken.get_mut(index).filter(|taken| !**taken) {
                    *taken = true;
                    order.push(index);
                }
            }
        }
        if first == 0 {
            first = order.len();
        }
    }
    (order, first)
}

/// The run of one cell.
#[derive(Clone, Debug, PartialEq)]
pub struct CellRun {
    /// The map that the cell is of.
    pub plan: MapPlan,
    /// Its column and row.
    pub cell: [u32; 2],
    /// Verdict of the run.
    pub verdict: Verdict,
    /// Start of the final contact \[s\].
    pub since: Option<f64>,
    /// The groups of blades in contact at the end and their multipliers;
    /// negative is a push \[N\].
    pub contacts: Vec<(Vec<u32>, f64)>,
    /// Impacts in all.
    pub impacts: u64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::knobs::Group;
    use rubscope_solver::scene::ModelSize;

    #[test]
    fn the_map_does_not_depend_on_the_knobs_it_sweeps() {
        let mut scene = Scene::base();
        let before = MapChoice::default().plan(&scene).unwrap();
        scene.operation.pulse_n = 5.0;
        scene.operation.speed_rad_s = 100.0;
        assert_eq!(MapChoice::default().plan(&scene).unwrap(), before);
        // The paper's range, in round steps.
        assert_eq!((before.x.from, before.x.to, before.x.count), (0.0, 600.0, 61));
    }

    #[test]
    fn cells_are_round_values_in_the_unit_that_is_shown() {
        let scene = Scene::base();
        let plan = MapChoice::default().plan(&scene).unwrap();
        assert_eq!((plan.x.value(46), plan.x.value(45)), (460.0, 450.0));
        let plan = MapChoice { rpm: true, ..MapChoice::default() }.plan(&scene).unwrap();
        let turns = |at: u32| plan.x.value(at) * 60.0 / TAU;
        for (at, rpm) in [(0, 0.0), (1, 100.0), (45, 4500.0), (plan.x.count - 1, 5800.0)] {
            assert!((turns(at) - rpm).abs() < 1e-9, "{}", turns(at));
        }
        let damping = MapAxis { path: keys::CASING_DAMPING, anchor: 0.05 };
        let plan = MapChoice { y: damping, ..MapChoice::default() }.plan(&scene).unwrap();
        // Steps of 1, 2 or 5 times a power of ten, and so every value.
        let step = format!("{:.1e}", plan.y.value(1) - plan.y.value(0));
        assert!(["1.0", "2.0", "5.0"].contains(&&step[..3]) && plan.y.count > 20, "{step}");
    }

    #[test]
    fn the_pulse_of_an_opened_scene_is_on_its_map() {
        for builtin in rubscope_solver::scene::BUILTIN {
            let scene = Scene::builtin(builtin.name).unwrap();
            let pulse = scene.operation.pulse_n.abs();
            let Ok(plan) = MapChoice::default().anchored(&scene).plan(&scene) else { continue };
            assert!(pulse == 0.0 || (plan.y.from..plan.y.to).contains(&pulse), "{pulse}");
        }
    }

    #[test]
    fn the_map_has_the_solver_of_its_scene_and_another_law_the_one_that_knows_it() {
        let mut scene = Scene::builtin("paper-nd3").unwrap();
        let mut choice = MapChoice::default();
        assert_eq!(choice.plan(&scene).unwrap().scene.solver, scene.solver);
        choice.law = Some(ContactLaw::Unilateral);
        let solver = choice.plan(&scene).unwrap().scene.solver;
        assert_eq!((solver.kind, solver.contact), (SolverKind::Explicit, ContactLaw::Unilateral));
        scene = scene.as_reference();
        assert_eq!(choice.plan(&scene).unwrap().scene.solver.kind, SolverKind::Event);
        choice.law = Some(ContactLaw::Bilateral);
        let solver = choice.plan(&scene).unwrap().scene.solver;
        assert_eq!((solver.kind, solver.contact), (SolverKind::Explicit, ContactLaw::Bilateral));
    }

    #[test]
    fn every_numeric_knob_can_be_on_either_axis_of_every_scene() {
        for builtin in rubscope_solver::scene::BUILTIN {
            let scene = Scene::builtin(builtin.name).unwrap();
            for knob in numeric() {
                let usual = MapChoice::default();
                let anchor = knob.number(&scene).unwrap();
                let axis = MapAxis { path: knob.path, anchor };
                let across = MapChoice { x: axis, ..usual };
                let up = MapChoice { y: axis, ..usual };
                let plans = [(across, usual.y.path), (up, usual.x.path)];
                for (choice, other) in plans.into_iter().filter(|(_, path)| *path != knob.path) {
                    let plan = choice.plan(&scene);
                    let rigid = knob.path == TORQUE && scene.solver.model == ModelSize::Rigid;
                    let plan = match plan {
                        Ok(plan) => plan,
                        // Rigid blades do not move under a torque, and the start of a
                        // scene can be too far out for some cells: it says so.
                        Err(why) if rigid && why.contains("do not move") => continue,
                        Err(why) if why.starts_with("initial.") => {
                            let given = scene.initial != Scene::base().initial;
                            assert!(given || scene.is_uneven(), "{why}");
                            continue;
                        }
                        // Each law and model leaves out some of what goes beyond the
                        // paper, and the event solver its ramps.
                        // Tips and lobes must leave the casing a place, and lobes have a
                        // number.
                        Err(why) if why.contains("leaves every gap open") => continue,
                        Err(why) if why.starts_with("casing.lobes = 0") => continue,
                        Err(why) if [Group::Beyond, Group::Tips].contains(&knob.group) => {
                            assert!(why.contains("solver."), "{} {why}", knob.path);
                            continue;
                        }
                        // The direction of friction is fixed.
                        Err(why) if why.contains("where a ramp stops the rotor") => continue,
                        Err(why) if why.starts_with("operation.speed_ramp") => {
                            assert!(scene.goes_beyond(), "{why}");
                            continue;
                        }
                        Err(why) => panic!("{} {other}: {why}", knob.path),
                    };
                    assert!(plan.x.to > plan.x.from && plan.y.to > plan.y.from, "{plan:?}");
                    let whole = plan.x.path == "operation.nodal_diameters";
                    assert!(!whole || plan.x.values().iter().all(|n| n.fract() == 0.0));
                }
            }
        }
    }

    #[test]
    fn a_rotor_that_turns_the_other_way_has_a_map_of_its_own() {
        let mut scene = Scene::base();
        scene.operation.speed_rad_s = -430.0;
        let plan = MapChoice::default().plan(&scene).unwrap();
        assert_eq!((plan.x.from, plan.x.to), (-600.0, 0.0));
    }

    #[test]
    fn coarse_cells_come_first_and_every_cell_once() {
        let mut plan = MapChoice::default().plan(&Scene::base()).unwrap();
        for (x, y) in [(81, 41), (11, 41), (1, 1), (8, 3)] {
            (plan.x.count, plan.y.count) = (x, y);
            let (mut order, first) = coarse_first(&plan);
            let mut live = LiveMap::of(plan.clone());
            let cell = Some(Cell::of(Verdict::Decay));
            order.iter().take(first).for_each(|&index| live.map.cells.set(index, cell));
            live.tried = first;
            // They cover the whole map.
            assert!((0..x).all(|column| (0..y).all(|row| live.shown(column, row) == cell)));
            assert!(first <= (x as usize).div_ceil(8) * (y as usize).div_ceil(8));
            order.sort_unstable();
            assert!(order.into_iter().eq(0..plan.len()), "{x} {y}");
        }
    }
}
