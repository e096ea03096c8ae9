//! Why a wave on a preloaded lining dies for certain (docs/theory.md, section 10).
//!
//! Where every blade presses by more than the smoothing, pushes are linear in the gaps, and
//! all there is beyond a linear step are products with the blade phase `n_d alpha`. In the
//! frame of the blades, at constant speed, a step is `x[n+1] = x[n] + D x[n] + r(x[n])`.
//!
//! A wave is a sum of motions that turn and die each at its rate. However they meet, a blade is
//! pressed by no more than the sum of their sizes: a beat stays linear where this sum does. With
//! `|x|` the sum of the sizes, a linear step shrinks it by a part `s`, and `|r| <= c |x|^2`. A
//! wave of `c |x| < s` shrinks in every step, so it dies, if no blade leaves the linear within it.

use nalgebra::{Complex, DMatrix, DVector};

use super::Explicit;
use super::disk::Disk;
use super::oscillator::Oscillator;
use super::rows::TipLaw;
use crate::model::LiningLaw;
use crate::motion::Plane;
use crate::motion::point::{Point, Units, one_of};
use crate::numeric::eigen::eigenvalues;
use crate::tolerances::{
    DIES_LOOKS, DIES_ROUNDINGS, DIES_SMALLER, DIES_STEPS, LARGEST_BLADE_ANGLE,
};

/// A row that presses: its direction, its shape in the modes of the blades, and its blades.
#[derive(Clone, Copy, Debug)]
struct Pressed {
    normal: Plane,
    shape: Plane,
    blades: f64,
}

/// The step about rest.
struct Step<'a> {
    casing: &'a Oscillator,
    blades: Option<&'a Oscillator>,
    tips: TipLaw,
    law: LiningLaw,
    rows: &'a [Pressed],
    /// Turn of the frame in a step \[rad\].
    turn: f64,
}

impl Step<'_> {
    /// Push of a row at rest \[N\].
    fn preload(&self, row: &Pressed) -> f64 {
        let LiningLaw { stiffness_n_per_m, smoothing_m } = self.law;
        row.blades * stiffness_n_per_m * (-self.tips.clearance - 0.5 * smoothing_m)
    }

    /// How much a row is pressed in beyond rest, to first order \[m\].
    fn pressed(&self, row: &Pressed, state: &Point) -> f64 {
        let angle = (state.a * row.shape.conj()).re;
        self.tips.rise * angle - (state.z * row.normal.conj()).re
    }

    /// Force on the casing and torque on the blades, to first order.
    fn pushes(&self, state: &Point) -> (Plane, Plane) {
        let TipLaw { diameters, pushed, .. } = self.tips;
        let (mut force, mut torque) = (Plane::default(), Plane::default());
        for row in self.rows {
            let rest = self.preload(row);
            let more = row.blades * self.law.stiffness_n_per_m * self.pressed(row, state);
            let phase = diameters * (state.a * row.shape.conj()).re;
            force += row.normal * Plane::new(more, rest * phase);
            let lever = diameters * (state.z * row.normal.conj()).im;
            torque += row.shape * (rest * lever - pushed * more);
        }
        (self.tips.push_on_casing(force), torque)
    }

    /// What one step adds, to first order, without losing digits of a short step.
    fn change(&self, state: &Point) -> Point {
        let (force, torque) = self.pushes(state);
        let half = (0.5 * self.turn).sin();
        // exp(-i turn) - 1
        let back = Plane::new(-2.0 * half * half, -self.turn.sin());
        let casing = self.casing;
        let pulled = force * casing.compliance - state.z * casing.pull - state.dz * casing.loss;
        let dz = back * state.dz + (back + 1.0) * pulled;
        let z = back * state.z + state.dz + dz;
        let da = self.blades.map_or_else(Plane::default, |blades| {
            torque * blades.compliance - state.a * blades.pull - state.da * blades.loss
        });
        let a = if self.blades.is_some() { state.da + da } else { Plane::default() };
        Point { z, dz, a, da }
    }
}

/// A motion of the linear step that turns and dies by itself.
#[derive(Clone, Debug)]
struct Part {
    /// The rate at which it dies, 0 within the round-off of a step \[1/s\].
    rate: f64,
    /// Its size in a state is the size of the product with this.
    of: DVector<Complex<f64>>,
    /// What it presses a blade at most \[m\], and the sizes of `z`, `dz` and `a`, by its own.
    pressed: f64,
    sizes: [f64; 3],
}

impl Part {
    /// Its size in a state.
    fn size(&self, x: &DVector<f64>) -> f64 {
        let (x, of) = (x.iter(), self.of.iter());
        x.zip(of).map(|(x, of)| of.conj() * *x).sum::<Complex<f64>>().norm()
    }
}

/// What is known of the linear motion about rest.
#[derive(Clone, Debug)]
pub(super) struct Rest {
    units: Units,
    /// The motions of which a wave is a sum, and those of them that a lining feels.
    parts: Vec<Part>,
    felt: Vec<Part>,
    /// The largest wave, as a sum of sizes, that dies for certain.
    largest: f64,
    /// The rate at which the slowest wave dies, of those that move the tips in the lining;
    /// negative where it grows, 0 where it does neither beyond round-off \[1/s\].
    pub rate: f64,
    /// A wave up to here leaves all pushes linear in the gaps \[m\].
    room: f64,
}

impl<B: Disk> Explicit<B> {
    /// Whether every wave to come dies: all blades press a lining and stay so.
    pub(super) fn dies(&self) -> bool {
        self.rest().is_some_and(|rest| self.wave(rest).is_some_and(|wave| wave < rest.largest))
    }

    /// Whether the wave leaves all pushes linear from now on, or `after` it went on \[s\] as if
    /// they were; none where the motion about rest is not known.
    pub(super) fn stays_linear(&self, after: f64) -> Option<bool> {
        let (rest, x) = (self.rest()?, self.wave_state()?);
        let x = rest.units.states(&x, UNKNOWNS);
        let part = |part: &Part| part.size(&x) * part.pressed * (-part.rate * after).exp();
        Some(rest.felt.iter().map(part).sum::<f64>() < rest.room)
    }

    /// The wave now, as a sum of sizes.
    fn wave(&self, rest: &Rest) -> Option<f64> {
        let x = rest.units.states(&self.wave_state()?, UNKNOWNS);
        Some(rest.parts.iter().map(|part| part.size(&x)).sum())
    }

    /// The wave now, in the frame of the blades.
    fn wave_state(&self) -> Option<Point> {
        let modes = self.blades.held_modes()?;
        let (c, s) = self.drive.look_at_turn(self.n);
        let back = Plane::new(c, -s);
        let [[x, y], [a, b]] = [self.u, modes.modes];
        Some(Point {
            z: Plane::new(x.x, y.x) * back,
            dz: Plane::new(x.increment, y.increment) * back,
            a: Plane::new(a.x, b.x),
            da: Plane::new(a.increment, b.increment),
        })
    }

    /// The linear motion about rest, where all blades press a lining at constant speed and
    /// it is known.
    pub(super) fn rest(&self) -> Option<&Rest> {
        let lining = self.lining.as_ref().filter(|lining| lining.all_press())?;
        let steady = self.drive.is_steady(self.n) && self.blades.held_modes().is_some();
        steady.then(|| lining.rest.get_or_init(|| self.pressed_rest()))?.as_ref()
    }

    /// None where rest is no equilibrium of one linear step.
    fn pressed_rest(&self) -> Option<Rest> {
        if self.machine.is_uneven() {
            return None;
        }
        let moving = self.blades.held_modes()?.moving;
        let (table, machine) = (self.blades.table(), &self.machine);
        let plane = |(c, s): (f64, f64)| Plane::new(c, s);
        let row = |(row, &side): (usize, &u32)| Pressed {
            normal: plane(machine.polygon.direction(side)),
            shape: moving.map_or_else(Plane::default, |_| plane(self.blades.shape_of(row as u32))),
            blades: f64::from(table.blades_per_row),
        };
        let rows: Vec<Pressed> = table.side.iter().enumerate().map(row).collect();
        let step = Step {
            casing: &self.casing,
            blades: moving.map(|blades| blades.oscillator()),
            tips: self.tips,
            law: self.lining.as_ref()?.law,
            rows: &rows,
            turn: machine.nu(self.drive.speed(self.n)) * self.drive.step,
        };
        let turn = machine.omega_c.max(machine.omega_bd) * self.drive.step;
        let units = Units::of(-self.tips.clearance, machine.blade_length, turn);
        Rest::of(&step, self.drive.step, units, [machine.tangential_ratio, self.tip_speed()])
    }
}

impl Rest {
    /// Of steps this long \[s\], in these units; `outrun` are the casing's way along the tips by
    /// its own, and the speed of these \[m/s\].
    fn of(step: &Step<'_>, length: f64, units: Units, outrun: [f64; 2]) -> Option<Self> {
        let Step { tips, law, rows, .. } = *step;
        let room = -tips.clearance - law.smoothing_m;
        let has_corners = rows.len() >= 3;
        // Where the rotor stands, waves of both senses are one motion.
        if room <= 0.0 || !has_corners || !is_even(rows) || step.turn == 0.0 {
            return None;
        }
        let size = if step.blades.is_some() { UNKNOWNS } else { UNKNOWNS / 2 };
        let column = |k| units.states(&step.change(&units.point(&one_of(size, k))), size);
        let matrix = DMatrix::from_columns(&(0..size).map(column).collect::<Vec<_>>());
        let parts = step.parts(&matrix, &units, length)?;
        // A lining does not feel the blades of tips without a slope, to first order.
        let felt = match tips.rise == 0.0 && size == UNKNOWNS {
            true => step.parts(&matrix.view((0, 0), (4, 4)).into_owned(), &units, length)?,
            false => parts.clone(),
        };
        let largest = step.largest(&parts, &units, length, outrun).unwrap_or(0.0);
        Some(Self { units, parts, largest, rate: slowest(&felt), felt, room })
    }
}

/// The numbers of a state: casing, its increment, blades and theirs, each in two directions.
const UNKNOWNS: usize = 8;

/// The rate at which the slowest of these motions dies \[1/s\].
fn slowest(parts: &[Part]) -> f64 {
    parts.iter().map(|part| part.rate).fold(f64::INFINITY, f64::min)
}

impl Step<'_> {
    /// The motions of a step `1 + change` of this length \[s\].
    fn parts(&self, change: &DMatrix<f64>, units: &Units, length: f64) -> Option<Vec<Part>> {
        let size = change.nrows();
        let part = |root: Complex<f64>| {
            let grows = 2.0 * root.re + root.norm_sqr();
            let beyond = grows.abs() > DIES_ROUNDINGS * f64::EPSILON;
            let from = change.map(Complex::from) - DMatrix::identity(size, size) * root;
            let svd = from.try_svd(true, true, f64::EPSILON, DIES_STEPS)?;
            let of = svd.u?.column(size - 1).into_owned();
            let shape = svd.v_t?.row(size - 1).adjoint();
            let [re, im] = [shape.map(|x| x.re), shape.map(|x| x.im)].map(|x| units.point(&x));
            let pressed = |row| self.pressed(row, &re).hypot(self.pressed(row, &im));
            let sizes = [(re.z, im.z), (re.dz, im.dz), (re.a, im.a)];
            Some(Part {
                rate: if beyond { -0.5 * grows.ln_1p() / length } else { 0.0 },
                pressed: self.rows.iter().map(pressed).fold(0.0, f64::max),
                sizes: sizes.map(|(re, im)| re.norm().hypot(im.norm())),
                of: &of / Complex::from(of.dotc(&shape).norm()),
            })
        };
        eigenvalues(change.clone())?.into_iter().map(part).collect()
    }

    /// The largest sum of sizes of these motions that dies for certain, of steps of this length
    /// \[s\]; `outrun` as in `Rest::of`.
    fn largest(&self, parts: &[Part], units: &Units, length: f64, outrun: [f64; 2]) -> Option<f64> {
        let Step { tips, law, rows, .. } = *self;
        let room = -tips.clearance - law.smoothing_m;
        let shrinks = -(-slowest(parts) * length).exp_m1();
        // Without damping the step keeps a wave, but for the round-off of its map.
        let uneven: f64 = parts.iter().map(|part| part.of.norm()).sum();
        if shrinks.is_nan() || shrinks <= DIES_ROUNDINGS * f64::EPSILON * uneven {
            return None;
        }
        let most = |of: fn(&Part) -> f64| parts.iter().map(of).fold(0.0, f64::max);
        let [z, dz, a, pressed] = [
            most(|part| part.sizes[0]),
            most(|part| part.sizes[1]),
            most(|part| part.sizes[2]),
            most(|part| part.pressed),
        ];
        // What a unit of force, or of torque, adds to the sum.
        let added = |state: fn(Plane) -> Point, compliance: f64| -> f64 {
            let along = [Plane::new(compliance, 0.0), Plane::i() * compliance]
                .map(|one| units.states(&state(one), UNKNOWNS));
            parts.iter().map(|part| part.size(&along[0]).hypot(part.size(&along[1]))).sum()
        };
        let casing = |one| Point { z: one, dz: one, ..Point::default() };
        let blades = |one| Point { a: one, da: one, ..Point::default() };
        let felt = [
            added(casing, self.casing.compliance) * Plane::new(1.0, tips.casing_friction).norm(),
            self.blades.map_or(0.0, |of| added(blades, of.compliance)),
        ];
        let rest: f64 = rows.iter().map(|row| self.preload(row)).sum();
        let stiffness: f64 = rows.iter().map(|row| row.blades * law.stiffness_n_per_m).sum();
        // What is left out of the pushes of a wave of this size, and whether all of it holds.
        let holds = |wave: f64| {
            let (z, a, pressed) = (z * wave, a * wave, pressed * wave);
            let phase = tips.diameters * a;
            let lever = tips.diameters * z;
            let force = 0.5 * rest * phase * phase + stiffness * (pressed + z) * phase;
            let torque = rest * lever * phase
                + stiffness * ((pressed + z * phase) * lever + tips.pushed.abs() * z * phase);
            let outran = tips.casing_friction != 0.0 && outrun[0] * dz * wave / length >= outrun[1];
            pressed + z * phase < room
                && a < LARGEST_BLADE_ANGLE
                && !outran
                && felt[0] * force + felt[1] * torque < shrinks * wave
        };
        let mut sizes = (0..DIES_LOOKS).map(|k| room / pressed * DIES_SMALLER.powi(k));
        sizes.find(|&wave| holds(wave))
    }
}

/// Whether equal pushes of all rows leave casing and blades alone.
fn is_even(rows: &[Pressed]) -> bool {
    let sum = |of: fn(&Pressed) -> Plane| rows.iter().map(of).sum::<Plane>().norm();
    let round_off = f64::EPSILON * rows.len() as f64;
    sum(|row| row.normal) <= round_off && sum(|row| row.shape) <= round_off
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::explicit::{ModalBlades, RigidBlades};
    use crate::motion::{Solver, Verdict};
    use crate::scene::{CheckedScene, Scene};

    /// A scene whose blades all press, from these numbers between 0 and 1.
    fn preloaded(mut random: impl FnMut() -> f64, model: &str) -> Option<CheckedScene> {
        let mut between = |low: f64, high: f64| low * (high / low).powf(random());
        let mut scene = Scene::builtin("coincidence").ok()?;
        let keys = [
            ("casing.radius_m", 0.4999 - between(2e-6, 1e-4)),
            ("casing.damping_ratio", between(1e-3, 0.3)),
            ("casing.modal_mass_kg", between(0.5, 10.0)),
            ("bladed_disk.damping_ratio", between(1e-3, 0.3)),
            ("bladed_disk.radial_coupling", between(0.05, 2.0) - 0.3),
            ("contact.stiffness_n_per_m", between(1e3, 1e6)),
            ("contact.smoothing_m", between(1e-8, 5e-5)),
            ("contact.friction", (between(0.02, 0.5) - 0.1).max(0.0)),
            ("operation.speed_rad_s", between(20.0, 900.0)),
            ("operation.pulse_n", between(1.0, 3e4)),
            ("solver.step_s", between(2e-6, 2e-5)),
            ("solver.end_s", 0.25),
        ];
        for (key, value) in keys {
            scene.set(key, &value.to_string()).ok()?;
        }
        let blades = between(3.0, 40.0) as u32;
        scene.set("bladed_disk.blades", &blades.to_string()).ok()?;
        scene.set("operation.nodal_diameters", &(between(1.0, 9.0) as u32).to_string()).ok()?;
        scene.set("solver.model", model).ok()?;
        scene.checked().ok()
    }

    /// Runs scenes to the end, past the proof that their waves die; how many were proved.
    fn proved<B: Disk>(scenes: u32, model: &str) -> usize {
        let mut random = fastrand::Rng::with_seed(5);
        let mut proved = 0;
        for _ in 0..scenes {
            let Some(scene) = preloaded(|| random.f64(), model) else { continue };
            let end = scene.solver.end_s;
            let mut motion = Explicit::<B>::new(&scene);
            let mut told: Option<(f64, f64, u64)> = None;
            let mut size = f64::INFINITY;
            for look in 1..=100 {
                let advanced = motion.advance(end * f64::from(look) / 100.0);
                let told_now = motion.final_verdict() == Some(Verdict::Decay);
                if let Some((.., impacts)) = told {
                    let all = motion.lining.as_ref().unwrap().all_press();
                    assert!(advanced.is_ok() && all && told_now, "{scene:?}");
                    assert_eq!(motion.contacts().impact_count, impacts, "{scene:?}");
                    let now = motion.size_of_wave().unwrap();
                    // Below, it is round-off.
                    assert!(now < size.max(1e-9), "{now} {size} {scene:?}");
                    size = now;
                } else if told_now {
                    size = motion.size_of_wave().unwrap();
                    told = Some((motion.t_s(), size, motion.contacts().impact_count));
                }
            }
            if let Some((since, first, _)) = told {
                proved += 1;
                // What was seen of a short or slow fall is no verdict.
                let window = 0.1 * end;
                if since < 0.5 * end && size < 1e-3 * first {
                    assert_eq!(motion.lasting(window), Verdict::Decay, "{scene:?}");
                }
            }
        }
        proved
    }

    impl<B: Disk> Explicit<B> {
        /// The wave now, as a part of the largest that dies.
        fn size_of_wave(&self) -> Option<f64> {
            let rest = self.rest()?;
            Some(self.wave(rest)? / rest.largest)
        }
    }

    #[test]
    fn what_is_proved_to_die_dies() {
        let (modal, rigid) =
            (proved::<ModalBlades>(500, "modal"), proved::<RigidBlades>(60, "rigid"));
        assert!(modal > 120 && rigid > 15, "{modal} {rigid}");
    }

    #[test]
    fn no_beat_of_a_linear_motion_is_above_the_sum_of_its_parts() {
        for (blades, disk, friction) in [("12", "1e-7", "0"), ("22", "1e-3", "0.2")] {
            let scene = Scene::builtin("coincidence").unwrap().with(&[
                ("bladed_disk.blades", blades),
                ("bladed_disk.damping_ratio", disk),
                ("casing.damping_ratio", "1e-7"),
                ("casing.radius_m", "0.499898"),
                ("contact.smoothing_m", "1e-8"),
                ("contact.friction", friction),
                ("operation.speed_rad_s", "300"),
                ("operation.pulse_n", "20"),
            ]);
            let mut motion = after::<ModalBlades>(&scene.unwrap(), 1e-3);
            let rest = motion.rest().unwrap().clone();
            let x = rest.units.states(&motion.wave_state().unwrap(), UNKNOWNS);
            let sum: f64 = rest.felt.iter().map(|part| part.size(&x) * part.pressed).sum();
            let clearance = motion.machine.clearance();
            let mut largest = 0.0_f64;
            for k in 0..100_000 {
                motion.advance(1e-3 + 5e-6 * f64::from(k)).unwrap();
                let gaps = motion.blade_gaps();
                largest = gaps.iter().fold(largest, |most, gap| most.max((gap - clearance).abs()));
            }
            let part = largest / sum;
            assert!(0.9 < part && part < 1.002, "{blades} {part}");
        }
    }

    /// The motion of a scene at an instant.
    fn after<B: Disk>(scene: &CheckedScene, t: f64) -> Explicit<B> {
        let mut motion = Explicit::new(scene);
        motion.advance(t).unwrap();
        motion
    }

    #[test]
    fn a_wave_that_nothing_damps_is_not_proved_to_die() {
        for (friction, damping) in [("0", "0"), ("0.15", "0"), ("0", "1e-5")] {
            for (model, speed) in [("rigid", "517.3"), ("rigid", "351.5"), ("modal", "300")] {
                let scene = Scene::base().with(&[
                    ("casing.radius_m", "0.49988"),
                    ("casing.damping_ratio", damping),
                    ("bladed_disk.damping_ratio", if model == "rigid" { "0.3" } else { damping }),
                    ("contact.stiffness_n_per_m", "3e7"),
                    ("contact.friction", friction),
                    ("solver.contact", "smooth"),
                    ("solver.model", model),
                    ("solver.step_s", "1e-6"),
                    ("operation.pulse_n", "8e3"),
                    ("operation.speed_rad_s", speed),
                ]);
                let scene = scene.unwrap();
                let proved = match model {
                    "rigid" => after::<RigidBlades>(&scene, 2e-3).final_verdict(),
                    _ => after::<ModalBlades>(&scene, 2e-3).final_verdict(),
                };
                let dies = damping != "0" && model == "rigid";
                assert_eq!(proved, dies.then_some(Verdict::Decay), "{model} {friction} {damping}");
            }
        }
    }

    #[test]
    fn what_nothing_damps_or_what_grows_is_no_decay_whenever_it_is_looked_at() {
        let still = [("casing.damping_ratio", "0"), ("bladed_disk.damping_ratio", "0")];
        let rigid = [("solver.model", "rigid"), ("bladed_disk.radial_coupling", "0")];
        let shared = [("operation.speed_rad_s", "193.5"), ("operation.pulse_n", "189.1")];
        let coincidence = Scene::builtin("coincidence").unwrap();
        let neutral = coincidence.clone().with(&[still, rigid, shared].concat()).unwrap();
        let growing = coincidence.with(&[("operation.pulse_n", "0.1")]).unwrap();
        for end in [0.05, 0.15, 0.18, 0.19, 0.2, 0.22, 0.3] {
            for (scene, of) in [(&neutral, "neutral"), (&growing, "growing")] {
                let end = end.to_string();
                let scene = scene.clone().into_scene().with(&[("solver.end_s", &end)]).unwrap();
                let end = scene.solver.end_s;
                let verdict = match of {
                    "neutral" => after::<RigidBlades>(&scene, end).lasting(0.1 * end),
                    _ => after::<ModalBlades>(&scene, end).lasting(0.1 * end),
                };
                assert_eq!(verdict, Verdict::Slip, "{of} {end}");
            }
        }
        // Rest itself is no wave.
        let rest =
            neutral.into_scene().with(&[("operation.pulse_n", "0"), ("solver.end_s", "0.02")]);
        let rested = after::<RigidBlades>(&rest.unwrap(), 0.02).lasting(2e-3);
        assert_eq!(rested, Verdict::Decay);
    }

    #[test]
    fn a_wave_that_grows_is_not_proved_to_die() {
        let scene =
            Scene::builtin("coincidence").unwrap().with(&[("solver.end_s", "0.3")]).unwrap();
        let mut motion = Explicit::<ModalBlades>::new(&scene);
        motion.advance(0.3).unwrap();
        assert_eq!(motion.final_verdict(), None);
        let calm = scene.clone().into_scene().with(&[("operation.speed_rad_s", "390")]).unwrap();
        let mut motion = Explicit::<ModalBlades>::new(&calm);
        motion.advance(0.3).unwrap();
        assert_eq!(motion.final_verdict(), Some(Verdict::Decay));
        // Not of another speed, and not while a pulse is to come.
        let mut turned = motion.clone();
        turned.set_speed(406.0, 0.0);
        assert_eq!(turned.final_verdict(), None);
        motion.fire();
        assert_eq!(motion.final_verdict(), None);
    }
}
