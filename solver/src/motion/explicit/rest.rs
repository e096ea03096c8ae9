//! The linear motion about rest of casing and blades that all press a lining, at constant speed
//! (docs/theory.md, section 10).
//!
//! Where every blade presses by more than the smoothing, the pushes are linear in the gaps, and
//! what is beyond a linear step are products with the blade phase `n_d alpha`. In the frame of the
//! blades a step is `x[n+1] = x[n] + D x[n]` with `x = (z, dz, a, da)`: eigenvalues of `D` give the
//! rates at which small waves die or grow. A blade is pressed by no more than the sum of its
//! eigenmodes, so a beat stays linear where that sum does.

use nalgebra::{Complex, DMatrix, DVector};

use super::oscillator::Oscillator;
use super::row::{Tip, TipLaw};
use super::{Explicit, Lining};
use crate::model::LiningLaw;
use crate::motion::Plane;
use crate::motion::point::{Point, Units, one_of};
use crate::numeric::eigen::eigenvalues;

/// Round-off of the growth in one step of a wave on a preloaded lining, in units of the last
/// place. Smaller: an undamped wave counts as growing or decaying.
const REST_ROUNDINGS: f64 = 64.0;

/// Steps of the singular value decomposition that gives an eigenmode of that wave, at most;
/// twenty are usual.
const REST_STEPS: usize = 1000;

/// Numbers of a state: casing, its increment, blades and theirs, each in two directions.
const STATES: usize = 8;

/// A row that presses: its direction, its shape in the two modes, and its blades.
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

/// An eigenmode of the linear step.
#[derive(Clone, Debug)]
struct Eigenmode {
    /// Decay rate, 0 within the round-off of a step \[1/s\].
    rate: f64,
    /// Left eigenvector; its product with a state is the amplitude.
    left: DVector<Complex<f64>>,
    /// Largest indentation of a blade per unit amplitude \[m\].
    pressed: f64,
}

/// The linear motion about rest.
#[derive(Clone, Debug)]
pub(super) struct Rest {
    units: Units,
    /// The eigenmodes that indent the lining.
    modes: Vec<Eigenmode>,
    /// Smallest of their decay rates; negative for growth, 0 within round-off \[1/s\].
    pub rate: f64,
    /// Indentation beyond rest up to which all pushes stay linear in the gaps \[m\].
    room: f64,
}

impl Explicit {
    /// Returns the linear motion about rest, where all blades press a lining at constant speed and
    /// it is known.
    pub(super) fn rest(&self) -> Option<&Rest> {
        self.lining.as_ref().filter(|lining| lining.all_press())?;
        let steady = self.drive.is_steady(self.n) && self.disk.is_pair();
        steady.then(|| self.rest.get_or_init(|| self.pressed_rest()))?.as_ref()
    }

    /// Returns whether the wave leaves all pushes linear from now on, or from `after` seconds on,
    /// extrapolating the linear motion; none where that is not known.
    pub(super) fn stays_linear(&self, after: f64) -> Option<bool> {
        let (rest, back) = (self.rest()?, self.drive.turns_before(self.n, 0).0.conj());
        let [x, y] = self.u;
        let [a, b] = self.disk.coordinates_of_pair();
        let state = Point {
            z: Plane::new(x.x, y.x) * back,
            dz: Plane::new(x.increment, y.increment) * back,
            a: Plane::new(a.x, b.x),
            da: Plane::new(a.increment, b.increment),
        };
        let state = rest.units.states(&state, STATES);
        let pressed = |mode: &Eigenmode| {
            let product = state.iter().zip(mode.left.iter()).map(|(x, left)| left.conj() * *x);
            product.sum::<Complex<f64>>().norm() * mode.pressed * (-mode.rate * after).exp()
        };
        Some(rest.modes.iter().map(pressed).sum::<f64>() < rest.room)
    }

    /// None where rest is no equilibrium of one linear step.
    fn pressed_rest(&self) -> Option<Rest> {
        let machine = &self.machine;
        if machine.is_uneven() {
            return None;
        }
        let blades = self.disk.modes_of_pair().first();
        let per_row = f64::from(self.disk.rows().1);
        let row = |(row, tip): (usize, &Tip)| {
            let [p, q] = self.disk.shape_of(row);
            Pressed { normal: tip.normal, shape: Plane::new(p, q), blades: per_row }
        };
        let rows: Vec<Pressed> = self.tips_of_rows.rows.iter().enumerate().map(row).collect();
        let law = self.lining.as_ref().map(|lining: &Lining| lining.law)?;
        let turn = machine.nu(self.drive.speed(self.n)) * self.drive.step;
        let step = Step { casing: &self.casing, blades, tips: self.tips, law, rows: &rows, turn };
        let rate = machine.omega_c.max(machine.omega_bd) * self.drive.step;
        let units = Units::of(-self.tips.clearance, machine.blade_length, rate);
        let room = -self.tips.clearance - law.smoothing_m;
        // Equal pushes must leave casing and blades alone, and waves of both senses be two.
        let has_corners = rows.len() >= 3;
        if room <= 0.0 || !has_corners || !is_even(&rows) || turn == 0.0 {
            return None;
        }
        // To first order, blades with radial tips do not indent the lining.
        let feels_blades = blades.is_some() && self.tips.rise != 0.0;
        let size = if feels_blades { STATES } else { STATES / 2 };
        let column = |k| units.states(&step.change(&units.point(&one_of(size, k))), size);
        let matrix = DMatrix::from_columns(&(0..size).map(column).collect::<Vec<_>>());
        let modes = step.eigenmodes(&matrix, &units, self.drive.step)?;
        let rate = modes.iter().map(|mode| mode.rate).fold(f64::INFINITY, f64::min);
        Some(Rest { units, modes, rate, room })
    }
}

impl Step<'_> {
    /// Returns the indentation of a row beyond that at rest, to first order \[m\].
    fn pressed(&self, row: &Pressed, state: &Point) -> f64 {
        let angle = (state.a * row.shape.conj()).re;
        self.tips.rise * angle - (state.z * row.normal.conj()).re
    }

    /// Returns the force on the casing and the torque on the blades, to first order.
    fn pushes(&self, state: &Point) -> (Plane, Plane) {
        let TipLaw { diameters, pushed, clearance, .. } = self.tips;
        let LiningLaw { stiffness_n_per_m, smoothing_m } = self.law;
        let (mut force, mut torque) = (Plane::default(), Plane::default());
        for row in self.rows {
            let stiffness = row.blades * stiffness_n_per_m;
            let rest = stiffness * (-clearance - 0.5 * smoothing_m);
            let more = stiffness * self.pressed(row, state);
            let phase = diameters * (state.a * row.shape.conj()).re;
            force += row.normal * Plane::new(more, rest * phase);
            let arm = diameters * (state.z * row.normal.conj()).im;
            torque += row.shape * (rest * arm - pushed * more);
        }
        (self.tips.push_on_casing(force), torque)
    }

    /// Returns what one step adds, to first order, without losing digits of a short step.
    fn change(&self, state: &Point) -> Point {
        let (force, torque) = self.pushes(state);
        let half = (0.5 * self.turn).sin();
        // exp(-i turn) - 1
        let back = Plane::new(-2.0 * half * half, -self.turn.sin());
        let casing = self.casing;
        let pulled = force * casing.compliance - state.z * casing.pull - state.dz * casing.loss;
        let dz = back * state.dz + (back + 1.0) * pulled;
        let z = back * state.z + state.dz + dz;
        let Some(blades) = self.blades else { return Point { z, dz, ..Point::default() } };
        let da = torque * blades.compliance - state.a * blades.pull - state.da * blades.loss;
        Point { z, dz, a: state.da + da, da }
    }

    /// Returns the eigenmodes of a step `1 + change` of this length \[s\].
    fn eigenmodes(
        &self,
        change: &DMatrix<f64>,
        units: &Units,
        length: f64,
    ) -> Option<Vec<Eigenmode>> {
        let size = change.nrows();
        let mode = |root: Complex<f64>| {
            let grows = 2.0 * root.re + root.norm_sqr();
            let beyond = grows.abs() > REST_ROUNDINGS * f64::EPSILON;
            let from = change.map(Complex::from) - DMatrix::identity(size, size) * root;
            let svd = from.try_svd(true, true, f64::EPSILON, REST_STEPS)?;
            let left = svd.u?.column(size - 1).into_owned();
            let shape = svd.v_t?.row(size - 1).adjoint();
            let [re, im] = [shape.map(|x| x.re), shape.map(|x| x.im)].map(|x| units.point(&x));
            let pressed = |row| self.pressed(row, &re).hypot(self.pressed(row, &im));
            Some(Eigenmode {
                rate: if beyond { -0.5 * grows.ln_1p() / length } else { 0.0 },
                pressed: self.rows.iter().map(pressed).fold(0.0, f64::max),
                left: &left / Complex::from(left.dotc(&shape).norm()),
            })
        };
        eigenvalues(change.clone())?.into_iter().map(mode).collect()
    }
}

/// Returns whether equal pushes of all rows exert no modal force on casing and blades.
fn is_even(rows: &[Pressed]) -> bool {
    let sum = |of: fn(&Pressed) -> Plane| rows.iter().map(of).sum::<Plane>().norm();
    let round_off = f64::EPSILON * rows.len() as f64;
    sum(|row| row.normal) <= round_off && sum(|row| row.shape) <= round_off
}
