//! The map of the explorer: two knobs over suitable ranges, under the scene's contact law or the
//! other one. Cells are computed in coarse blocks first, then in finer ones, in a fixed order.

use std::f64::consts::TAU;

use crate::tui::axis::nice_step;
use crate::tui::knobs::{KNOBS, Knob, knob_of};
use crate::tui::views::steady::locked_curves::speed_range;
use rubscope_solver::motion::Verdict;
use rubscope_solver::scene::{Allowed, ContactLaw, Scene, keys};
use rubscope_solver::study::overlay::{Curve, threshold_curves};
use rubscope_solver::study::{Axis, Cell, Map, MapPlan};

/// Largest number of cells on the x and y axis. On the y axis, four decades of pulse have ten cells
/// each.
const CELLS: [u32; 2] = [81, 41];
/// Lowest speed of a map with friction, as a fraction of the highest.
const SLOWEST: f64 = 0.1;
/// Ends of the axis of the pulse \[N\]; the lower end is reduced for a scene with a smaller pulse.
const PULSES: [f64; 2] = [1e3, 1e7];
/// Fraction cut off each end of a knob's range if the scene is invalid there.
const REFUSED: f64 = 0.025;

/// The choices of the user for the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapChoice {
    /// Contact law of the map; `None` is that of the scene.
    pub law: Option<ContactLaw>,
    /// The x axis.
    pub x: MapAxis,
    /// The y axis.
    pub y: MapAxis,
    /// Whether speeds are shown in rpm; the cells are then round values in rpm.
    pub rpm: bool,
}

impl Default for MapChoice {
    fn default() -> Self {
        let axis = |path| MapAxis { path, anchor: 0.0 };
        Self { law: None, x: axis(keys::SPEED), y: axis(keys::PULSE), rpm: false }
    }
}

/// A knob on an axis. Its range does not follow the knob.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapAxis {
    /// Key of the knob in the scene file.
    pub path: &'static str,
    /// Value of the knob when it was put on the axis or the scene was opened, in the unit of its
    /// key; the range is built around it.
    pub anchor: f64,
}

impl MapChoice {
    /// Re-anchors both axes at the values of a newly opened scene.
    pub fn anchored(mut self, scene: &Scene) -> Self {
        for axis in [&mut self.x, &mut self.y] {
            let value = knob_of(axis.path).and_then(|knob| knob.number(scene));
            axis.anchor = value.unwrap_or(axis.anchor);
        }
        self
    }

    /// Builds the plan of the map for a scene.
    ///
    /// # Errors
    /// One line that says why the scene has no such map.
    pub fn plan(&self, scene: &Scene) -> Result<MapPlan, String> {
        let mut scene = scene.clone();
        scene.solver.contact = self.law.unwrap_or(scene.solver.contact);
        // Friction has no direction at standstill.
        let slides = scene.contact.friction != 0.0
            || [self.x, self.y].iter().any(|axis| axis.path == keys::FRICTION);
        let plan = |without: f64| {
            let unit = if self.rpm { TAU / 60.0 } else { 1.0 };
            let x = self.x.over(&scene, CELLS[0], slides, without, unit)?;
            let y = self.y.over(&scene, CELLS[1], slides, without, unit)?;
            let mut scene = scene.clone();
            for axis in [&x, &y] {
                // Independent of the current values of the knobs on the axes, so that turning them
                // keeps the map.
                axis.apply(&mut scene, 0).map_err(|error| error.to_string())?;
            }
            let mut plan = MapPlan { scene, x, y, sensitivity: false };
            let made = plan.make_compatible(|key| self.law.is_some() && key == keys::LAW);
            made.map(|_| plan).map_err(|error| error.to_string())
        };
        plan(0.0).or_else(|_| plan(REFUSED))
    }
}

/// Returns the knobs with numeric values, which can be on an axis.
pub fn numeric() -> impl Iterator<Item = &'static Knob> {
    let is_number = |allowed| matches!(allowed, Allowed::Real { .. } | Allowed::Whole { .. });
    KNOBS.iter().filter(move |knob| is_number(knob.allowed()))
}

impl MapAxis {
    /// Builds the axis over the knob's range without a fraction `without` at each end. Speeds are
    /// rounded to multiples of `unit`.
    fn over(
        &self,
        scene: &Scene,
        most: u32,
        slides: bool,
        without: f64,
        unit: f64,
    ) -> Result<Axis, String> {
        let knob = knob_of(self.path).ok_or_else(|| format!("{} is no knob", self.path))?;
        let bar = knob.range(self.anchor, scene, &scene.machine());
        let (mut from, mut to, mut log) =
            bar.ok_or_else(|| format!("{} has no range", knob.label))?.ends(without);
        match self.path {
            keys::SPEED => {
                (from, to) = speeds(scene);
                if slides {
                    (from, to) = if to > 0.0 { (SLOWEST * to, to) } else { (from, SLOWEST * from) };
                }
            }
            // The axis starts below a small pulse of the opened scene.
            keys::PULSE => {
                let below = 10f64.powf((0.5 * self.anchor.abs()).log10().floor());
                from = if self.anchor == 0.0 { PULSES[0] } else { below.min(PULSES[0]) };
                (to, log) = (PULSES[1], true);
            }
            keys::STEP => to = to.min(0.9 * scene.stable_step()),
            // Without lobes a casing is round, whatever their height.
            keys::LOBES => from = 1.0,
            _ => {}
        }
        let count = match knob.allowed() {
            // One cell per integer; a cut that leaves a single one is not made.
            Allowed::Whole { .. } => {
                let inside = (from.ceil(), to.floor());
                (from, to) = if inside.0 < inside.1 { inside } else { (from.floor(), to.ceil()) };
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
                // If the ends are not round, they are the key's own bounds: keep them.
                if is_speed || (a - first).abs() + (b - last).abs() < 1e-6 {
                    (from, to) = (first * step, last * step);
                    (last - first) as u32 + 1
                } else {
                    most
                }
            }
        };
        Axis::new(self.path, from, to, count.into(), log).map_err(|error| error.to_string())
    }
}

/// Returns both ends of the speed axis \[rad/s\]: from standstill to above every threshold, or
/// above the current speed if that is outside. The speeds are negative if the rotor turns backward.
fn speeds(scene: &Scene) -> (f64, f64) {
    let (machine, speed) = (scene.machine(), scene.operation.speed_rad_s);
    let thresholds = [machine.lock_speed(), machine.dangerous_speed(), machine.critical_speed()];
    let usual = speed_range(scene, 1.3 * thresholds.into_iter().flatten().fold(1.0, f64::max));
    let fastest = if speed.abs() > usual { speed_range(scene, speed) } else { usual };
    if speed < 0.0 { (-fastest, 0.0) } else { (0.0, fastest) }
}

/// Block sizes of the successive refinements: one computed cell stands for a square block with this
/// many cells on a side.
const BLOCKS: [u32; 4] = [8, 4, 2, 1];

/// A map in progress.
#[derive(Clone, Debug, PartialEq)]
pub struct LiveMap {
    /// The plan, and the cells so far.
    pub map: Map,
    /// Number of cells attempted; a cell whose run takes too long stays empty.
    pub tried: usize,
    /// Threshold speeds over the map; empty if no axis is the speed.
    pub lines: Vec<Curve>,
}

impl LiveMap {
    /// Creates an empty map.
    pub fn of(plan: MapPlan) -> Self {
        let mut lines = threshold_curves(&plan);
        // Without damping, `Omega_lock` coincides with `Omega_c`.
        let double = |line: &Curve, of: &[Curve]| {
            line.name == "Omega_lock"
                && of.iter().any(|c| c.name == "Omega_c" && c.points == line.points)
        };
        let all = lines.clone();
        lines.retain(|line| !line.points.is_empty() && !double(line, &all));
        Self { lines, map: Map::empty(plan), tried: 0 }
    }

    /// Returns what to draw at a cell: its own verdict, or that of the smallest computed block
    /// around it; `None` if no such block is computed.
    pub fn shown(&self, column: u32, row: u32) -> Option<Cell> {
        let (x, y) = (self.map.plan.x.count, self.map.plan.y.count);
        BLOCKS
            .iter()
            .rev()
            .find_map(|&block| self.map.at(centre(column, block, x), centre(row, block, y)))
    }

    /// Returns whether the coarsest blocks cover the whole map.
    pub fn is_covered(&self) -> bool {
        let blocks = |count: u32| count.div_ceil(BLOCKS[0]) as usize;
        self.tried >= blocks(self.map.plan.x.count) * blocks(self.map.plan.y.count)
    }

    /// Returns whether all cells were attempted.
    pub fn is_complete(&self) -> bool {
        self.tried >= self.map.cells.len()
    }
}

/// Returns, along an axis of `count` cells, the index of the cell that stands for the block of
/// `block` cells around `cell`.
fn centre(cell: u32, block: u32, count: u32) -> u32 {
    (cell - cell % block + block / 2).min(count.saturating_sub(1))
}

/// Returns all cells in order of computation: those of the coarsest blocks first.
pub fn coarse_first(plan: &MapPlan) -> Vec<usize> {
    let (x, y) = (plan.x.count, plan.y.count);
    let block_of = |index: &usize| {
        let (column, row) = (*index as u32 % x, *index as u32 / x);
        let stands = |block| centre(column, block, x) == column && centre(row, block, y) == row;
        BLOCKS.into_iter().position(stands)
    };
    let mut cells: Vec<usize> = (0..plan.len()).collect();
    cells.sort_by_key(block_of);
    cells
}

/// The run of one map cell.
#[derive(Clone, Debug, PartialEq)]
pub struct CellRun {
    /// Plan of the map.
    pub plan: MapPlan,
    /// Column and row of the cell.
    pub cell: [u32; 2],
    /// Verdict of the run.
    pub verdict: Verdict,
    /// Start of the contact that lasts to the end of the run \[s\]; `None` if none does.
    pub since: Option<f64>,
    /// Blade groups in contact at the end of the run, and their multipliers \[N\]; negative pushes.
    pub contacts: Vec<(Vec<u32>, f64)>,
    /// Number of impacts in the run.
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
        // The speed range of the paper, in round steps.
        assert_eq!((before.x.from, before.x.to, before.x.count), (0.0, 600.0, 61));
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
    fn every_numeric_knob_can_be_on_either_axis_of_a_scene_that_takes_it() {
        let (mut drawn, mut refused) = (0, 0);
        for builtin in rubscope_solver::scene::BUILTIN {
            let scene = Scene::builtin(builtin.name).unwrap();
            for knob in numeric() {
                let usual = MapChoice::default();
                let axis = MapAxis { path: knob.path, anchor: knob.number(&scene).unwrap() };
                let across = MapChoice { x: axis, ..usual };
                let up = MapChoice { y: axis, ..usual };
                let plans = [(across, usual.y.path), (up, usual.x.path)];
                for (choice, _) in plans.into_iter().filter(|(_, path)| *path != knob.path) {
                    let plan = match choice.plan(&scene) {
                        Ok(plan) => plan,
                        // Rigid blades do not move under a torque, the start can be too far out, tips
                        // and lobes must leave the casing a place, laws and models exclude keys.
                        Err(why) => {
                            let given = scene.initial != Scene::base().initial;
                            let beyond = [Group::Beyond, Group::Tips].contains(&knob.group);
                            let still = scene.solver.model == ModelSize::Rigid;
                            let expected = why.contains("leaves every gap open")
                                || why.contains("where a ramp stops the rotor")
                                || why.starts_with("casing.lobes = 0")
                                || beyond && why.contains("solver.")
                                || knob.path == keys::EXCITATION && still
                                || why.starts_with("initial.") && (given || scene.is_uneven())
                                || why.starts_with("operation.speed_ramp") && scene.goes_beyond();
                            assert!(expected, "{} {why}", knob.path);
                            refused += 1;
                            continue;
                        }
                    };
                    drawn += 1;
                    assert!(plan.x.to > plan.x.from && plan.y.to > plan.y.from, "{plan:?}");
                    let whole = plan.x.path == "operation.nodal_diameters";
                    assert!(!whole || plan.x.values().iter().all(|n| n.fract() == 0.0));
                }
            }
        }
        assert!(drawn > 5 * refused, "{drawn} {refused}");
    }

    #[test]
    fn coarse_cells_come_first_and_every_cell_once() {
        let mut plan = MapChoice::default().plan(&Scene::base()).unwrap();
        for (x, y) in [(81, 41), (11, 41), (1, 1), (8, 3)] {
            (plan.x.count, plan.y.count) = (x, y);
            let mut order = coarse_first(&plan);
            let mut live = LiveMap::of(plan.clone());
            let cell = Some(Cell::of(Verdict::Decay));
            let cover = |live: &LiveMap| {
                (0..x).all(|column| (0..y).all(|row| live.shown(column, row) == cell))
            };
            for &index in &order {
                if live.is_covered() {
                    break;
                }
                assert!(!cover(&live), "{x} {y} {}", live.tried);
                live.map.cells[index] = cell;
                live.tried += 1;
            }
            assert!(cover(&live));
            order.sort_unstable();
            assert!(order.into_iter().eq(0..plan.len()), "{x} {y}");
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
        // Steps of 1, 2 or 5 times a power of ten give round values everywhere.
        let step = format!("{:.1e}", plan.y.value(1) - plan.y.value(0));
        assert!(["1.0", "2.0", "5.0"].contains(&&step[..3]) && plan.y.count > 20, "{step}");
    }
}
