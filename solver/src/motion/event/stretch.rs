//! A stretch of motion with the same rows in contact: casing, blades and contact forces as power
//! series summed to round-off, or free flight in closed form (`flight`).
//!
//! The contact forces follow order by order from the condition that the gaps stay closed. With the
//! faces at the start of the stretch, term `n` of the acceleration of gap `j` is
//! `face_j (free acceleration + what earlier terms push) + sum W_jk Q_k[n] + curvature_j[n]`, where
//! the blade angles in normal and lever of a row add three products of series to what earlier terms
//! push, and the turning of its normal adds `curvature_j`.

use super::flow::{Blades, Face, Flow, pushed};
use super::series::{Gap, STRETCH, TERMS, Terms, ended, gap, value};
use crate::motion::point::Point;
use crate::motion::propagator::Propagator;
use crate::motion::{Plane, dot, size};
use crate::numeric::elimination::{Square, inverse};
use crate::numeric::rounding::ROUND_OFF;

/// Largest number of rows that push at once: casing and blades have four modes, so the forces of more
/// rows would not be unique.
pub(super) const MOST_HELD: usize = 4;

/// Clearances that the casing may cross in one stretch; far off, a tenth of its displacement, which
/// has that round-off anyway. Larger: round-off of the series is a larger part of the clearance, and a
/// casing that leaves the range of the model is seen later.
const FARTHEST: f64 = 1e3;

/// Largest number of halvings of a stretch whose series does not converge; thirty cover ten decades of
/// rates.
const MOST_HALVINGS: usize = 60;

/// Rows in contact.
#[derive(Clone, Debug, Default)]
pub(super) struct Held {
    /// Index of each row.
    pub rows: Vec<usize>,
    /// Their faces at the start of the stretch.
    faces: [Face; MOST_HELD],
    /// Inverse of their contact matrix `W`.
    inverse: Square<MOST_HELD>,
}

impl Held {
    /// Creates the set of rows with these faces; `None` if their contact matrix is singular or there
    /// are too many.
    pub(super) fn new(rows: impl Iterator<Item = (usize, Face)>) -> Option<Self> {
        let mut held = Self::default();
        for (place, (row, face)) in rows.enumerate() {
            *held.faces.get_mut(place)? = face;
            held.rows.push(row);
        }
        held.invert()?;
        Some(held)
    }

    /// Updates the faces to a point; `None` if the contact matrix is singular there.
    pub(super) fn face(&mut self, flow: &Flow, point: &Point) -> Option<()> {
        for (face, &row) in self.faces.iter_mut().zip(&self.rows) {
            *face = flow.face(row, point);
        }
        self.invert()
    }

    fn invert(&mut self) -> Option<()> {
        let mut matrix = [[0.0; MOST_HELD]; MOST_HELD];
        for (line, face) in matrix.iter_mut().zip(self.faces()) {
            for (entry, by) in line.iter_mut().zip(self.faces()) {
                *entry = face.joint(by);
            }
        }
        self.inverse = match self.rows.len() {
            0 => self.inverse,
            count => inverse(&matrix, count)?,
        };
        Some(())
    }

    /// Returns the faces of the rows.
    pub(super) fn faces(&self) -> &[Face] {
        self.faces.get(..self.rows.len()).unwrap_or_default()
    }

    /// Returns the contact forces that compensate these accelerations of the gaps.
    pub(super) fn pushes(&self, openings: &[f64; MOST_HELD]) -> [f64; MOST_HELD] {
        let (mut pushes, held) = ([0.0; MOST_HELD], self.rows.len());
        for (push, row) in pushes.iter_mut().zip(&self.inverse).take(held) {
            *push = -row.iter().zip(openings).take(held).map(|(a, b)| a * b).sum::<f64>();
        }
        pushes
    }

    /// Evaluates a function for each row and its face.
    pub(super) fn each(&self, opening: impl Fn(usize, &Face) -> f64) -> [f64; MOST_HELD] {
        let mut openings = [0.0; MOST_HELD];
        for (slot, (&row, face)) in openings.iter_mut().zip(self.rows.iter().zip(&self.faces)) {
            *slot = opening(row, face);
        }
        openings
    }

    /// Pairs the face of each row with its contact force.
    pub(super) fn facing(&self, pushes: [f64; MOST_HELD]) -> impl Iterator<Item = (&Face, f64)> {
        self.faces().iter().zip(pushes)
    }

    /// Projects a point near the present faces so that the gaps in contact are closed and at rest to
    /// round-off, and takes the faces of the result. `None` if the contact matrix is singular there.
    pub(super) fn close(&mut self, flow: &Flow, point: &mut Point) -> Option<()> {
        if self.rows.is_empty() {
            return Some(());
        }
        let apart = self.pushes(&self.each(|row, _| flow.gap(row, point)));
        let (z, a) = pushed(self.facing(apart));
        (point.z, point.a) = (point.z + z, point.a + a);
        if flow.diameters() != 0.0 {
            self.face(flow, point)?;
        }
        let rates = self.pushes(&self.each(|_, face| face.along(point.dz, point.da)));
        let (dz, da) = pushed(self.facing(rates));
        (point.dz, point.da) = (point.dz + dz, point.da + da);
        Some(())
    }

    /// Returns whether no motion is left: rigid blades in a corner.
    pub(super) fn is_fixed(&self, flow: &Flow) -> bool {
        flow.blades.is_none() && self.rows.len() == 2
    }
}

/// Series of the real and the imaginary part.
type Wave = [Terms; 2];

/// Returns the magnitude of each complex term, because one part alone may pass through zero.
/// Magnitudes whose squares underflow are round-off.
fn lengths([re, im]: &Wave) -> Terms {
    let mut lengths = [0.0; TERMS];
    for (length, (re, im)) in lengths.iter_mut().zip(re.iter().zip(im)) {
        *length = (re * re + im * im).sqrt();
    }
    lengths
}

/// Returns a term of both parts.
fn term([re, im]: &Wave, n: usize) -> Plane {
    Plane::new(re[n], im[n])
}

/// Sets a term of both parts.
fn put(wave: &mut Wave, n: usize, value: Plane) {
    (wave[0][n], wave[1][n]) = (value.re, value.im);
}

/// A row whose normal turns with its blades.
#[derive(Clone, Copy, Debug, Default)]
struct Turning {
    /// Rate `d alpha'` at which the normal turns.
    rate: Terms,
    normal: Wave,
    /// Position along the side \[m\].
    y: Terms,
    /// The sum of `rate[j] normal[n + 1 - j]` over `j <= n`, of the latest order `n`.
    sum: Plane,
}

/// One stretch of motion.
#[derive(Clone, Debug, Default)]
pub(super) struct Stretch {
    /// Duration; infinite if no event ends it \[s\].
    pub length: f64,
    /// Point at the start.
    pub from: Point,
    /// Casing displacement \[m\].
    z: Wave,
    /// Blade angle \[rad\].
    a: Wave,
    /// Pulse force per unit casing mass, in the blade frame \[m/s^2\].
    force: Wave,
    /// Contact forces of the rows per unit casing mass \[m/s^2\].
    pub pushes: [Terms; MOST_HELD],
    /// Contact forces below this are round-off of the terms that they consist of \[m/s^2\].
    pub noise: f64,
    /// Largest possible closing of any gap during the stretch, and largest displacement of a gap at
    /// its start \[m\].
    pub travel: [f64; 2],
    /// Bound on the third derivative of any gap by the fraction of the stretch \[m\].
    twist: f64,
    /// Largest possible change of a blade angle during the stretch \[rad\].
    pub swing: f64,
    /// Whether the series did not converge for any length.
    pub lost: bool,
    /// Whether the stretch is free flight in closed form.
    pub free: bool,
}

impl Stretch {
    /// Computes the stretch from a point with these rows in contact and the pulse `force` per unit
    /// casing mass, for at most `most` seconds. The length is halved until the series converge.
    pub(super) fn begin(&mut self, flow: &Flow, held: &Held, from: Point, force: Plane, most: f64) {
        let zero = [0.0; TERMS];
        let spread = held.inverse.iter().flatten().fold(0.0_f64, |sum, entry| sum.max(entry.abs()));
        (self.force, self.pushes) = ([zero; 2], [zero; MOST_HELD]);
        (self.from, self.free) = (from, false);
        let steady = force == Plane::default() && flow.nu_rate == 0.0;
        let still = held.rows.is_empty() && from.a == from.da && from.a == Plane::default();
        self.length = if held.is_fixed(flow) && force == Plane::default() && !steady {
            // The contact forces of a corner at rest are of second degree in time.
            flow.rates() / flow.nu_rate.abs()
        } else if flow.blades.is_none() && held.rows.len() == 1 && steady {
            STRETCH / flow.side_rates()
        } else {
            STRETCH / if still { flow.casing_rates() } else { flow.rates() }
        };
        let far = (0.1 * size(from.z)).max(FARTHEST * flow.clearance());
        let (crossed, driven) = (far / size(from.dz), (far / size(force)).sqrt());
        self.length = self.length.min(most).min(crossed).min(driven);
        self.noise = ROUND_OFF * spread * flow.size_of_free(&from, force);
        for _ in 0..MOST_HALVINGS {
            self.expand(flow, held, force);
            self.lost = !self.summed(flow, held.rows.len());
            if !self.lost {
                break;
            }
            self.length *= 0.5;
        }
    }

    /// Becomes a free flight that cannot end within `length` seconds.
    pub(super) fn fly(&mut self, from: Point, length: f64) {
        (self.from, self.length, self.free, self.lost) = (from, length, true, false);
        (self.travel, self.swing, self.force) = Default::default();
    }

    /// Fixes the motion at its equilibrium, after its changes have fallen to round-off.
    pub(super) fn come_to_rest(&mut self, point: Point) {
        self.from = point;
        let hold = |terms: &mut Terms| terms.iter_mut().skip(1).for_each(|term| *term = 0.0);
        self.z.iter_mut().chain(&mut self.a).chain(&mut self.pushes).for_each(hold);
        self.length = f64::INFINITY;
    }

    /// Fills the terms by the recurrence of the differential equations, with time counted in units
    /// of `length`.
    fn expand(&mut self, flow: &Flow, held: &Held, force: Plane) {
        let h = self.length;
        let square = h * h;
        let [spring, spring_rate, spring_bend] = flow.spring();
        let (spring, drag) = (spring * square, flow.drag()[0] * h);
        let ramps = flow.nu_rate != 0.0;
        let rates = [spring_rate * square * h, spring_bend * square * square];
        let drag_rate = flow.drag()[1] * square;
        let (stiffness, damping) = flow.blades.map_or((0.0, 0.0), |blades| {
            let Propagator { damping, stiffness, .. } = blades.propagator;
            (stiffness * square, 2.0 * damping * h)
        });
        let spin = [Plane::new(0.0, -flow.nu * h), Plane::new(0.0, -flow.nu_rate * square)];
        let moving = flow.blades.is_some();
        let (fixed, pulsed) = (held.is_fixed(flow), force != Plane::default());
        let turning = flow.blades.filter(|blades| blades.diameters != 0.0);
        let mut turned = turning.map(|_| [Turning::default(); MOST_HELD]);
        let mut acting = [force * square, Plane::default()];
        // Terms of this order and of the next.
        let (mut z, mut a) = (self.from.z, self.from.a);
        let (mut dz, mut da) = (self.from.dz * h, self.from.da * h);
        if fixed {
            dz = Plane::default();
        }
        put(&mut self.z, 0, z);
        put(&mut self.z, 1, dz);
        put(&mut self.a, 0, a);
        put(&mut self.a, 1, da);
        for (n, over) in OVER.into_iter().enumerate() {
            let order = n as f64;
            let mut casing = acting[0] - spring * z - drag * dz * (order + 1.0);
            let mut tips = if moving {
                -(a * stiffness + da * (damping * (order + 1.0)))
            } else {
                Plane::default()
            };
            if ramps && n > 0 {
                casing -= rates[0] * term(&self.z, n - 1) + drag_rate * z * order;
                if n > 1 {
                    casing -= rates[1] * term(&self.z, n - 2);
                }
            }
            if !held.rows.is_empty() {
                let mut openings = [0.0; MOST_HELD];
                if let (Some(blades), Some(turned)) = (&turning, &mut turned) {
                    let each = held.faces().iter().zip(turned).zip(&self.pushes);
                    for (((face, turned), pushes), bend) in each.zip(&mut openings) {
                        let rate = blades.diameters * dot(face.base, da) * (order + 1.0);
                        *bend = turned.follow(face, rate, &self.z, n) / over;
                        let [re, im, lever] = turned.left(pushes, n);
                        casing += flow.turn * Plane::new(re, im);
                        tips += face.base * (blades.diameters / blades.mass * lever);
                    }
                }
                for (opening, face) in openings.iter_mut().zip(held.faces()) {
                    *opening += face.along(casing, tips);
                }
                let pushes = held.pushes(&openings);
                for ((face, push), terms) in held.facing(pushes).zip(&mut self.pushes) {
                    (casing, tips) = (casing + face.casing * push, tips + face.blades * push);
                    terms[n] = push;
                }
            }
            if fixed {
                casing = Plane::default();
            }
            (z, dz) = (dz, casing * over);
            put(&mut self.z, n + 2, dz);
            if moving {
                (a, da) = (da, tips * over);
                put(&mut self.a, n + 2, da);
            }
            if pulsed {
                put(&mut self.force, n, acting[0] / square);
                let next = (acting[0] * spin[0] + acting[1] * spin[1]) / (order + 1.0);
                acting = [next, acting[0]];
            }
        }
        for terms in self.pushes.iter_mut().take(held.rows.len()) {
            terms.iter_mut().for_each(|push| *push /= square);
        }
    }

    /// Bounds the motion by the sum of its terms, and returns whether the terms left out are
    /// round-off.
    fn summed(&mut self, flow: &Flow, held: usize) -> bool {
        let z = lengths(&self.z);
        let (arm, d, moving) = (flow.arm().abs(), flow.diameters(), flow.blades.is_some());
        let a = if moving { lengths(&self.a) } else { [0.0; TERMS] };
        let at_z = gap(&z, 1.0);
        let at_a = if moving { gap(&a, 1.0) } else { Gap::default() };
        let moved = [at_z.gap - z[0], at_a.gap - a[0]];
        let turned = d * moved[1];
        self.travel = [moved[0] + arm * moved[1] + turned * at_z.gap, z[0] + arm * a[0]];
        // Bounds on the derivatives of exp(i d alpha).
        let [first, second, third] = [at_a.rate, at_a.bend, at_a.twist].map(|x| d * x);
        let turns = [first, second + first * first, third + first * (3.0 * second + first * first)];
        self.twist = at_z.twist
            + arm * at_a.twist
            + 3.0 * (at_z.bend * turns[0] + at_z.rate * turns[1])
            + at_z.gap * turns[2];
        self.swing = moved[1];
        let moves = |size: &Terms| ended(size) && size.iter().all(|term| term.is_finite());
        for push in self.pushes.iter_mut().take(held) {
            // A contact force that is entirely round-off is none.
            if push.iter().map(|term| term.abs()).sum::<f64>() <= self.noise {
                *push = [0.0; TERMS];
            }
        }
        moves(&z) && (!moving || moves(&a)) && self.pushes.iter().take(held).all(|push| ended(push))
    }

    /// Returns the fraction of the stretch after `s` seconds.
    fn part(&self, s: f64) -> f64 {
        if self.length.is_finite() && self.length > 0.0 { s / self.length } else { 0.0 }
    }

    /// Returns the point after `s` seconds.
    pub(super) fn point(&self, flow: &Flow, s: f64) -> Point {
        if self.free {
            return flow.flown(&self.from, s);
        }
        if self.length == f64::INFINITY {
            return self.from;
        }
        let [point] = self.points(flow, [s]);
        point
    }

    /// Returns the points after these times, of a stretch that is not free.
    pub(super) fn points<const N: usize>(&self, flow: &Flow, times: [f64; N]) -> [Point; N] {
        let (parts, rest) = (times.map(|s| self.part(s)), Plane::default());
        let per = if self.length > 0.0 { 1.0 / self.length } else { 0.0 };
        let at = |[re, im]: &Wave| {
            let mut all = [(rest, rest); N];
            for (re, im) in re.iter().zip(im).rev() {
                for ((value, rate), x) in all.iter_mut().zip(parts) {
                    *rate = *rate * x + *value;
                    *value = *value * x + Plane::new(*re, *im);
                }
            }
            all
        };
        let casing = at(&self.z);
        let blades = if flow.blades.is_some() { at(&self.a) } else { [(rest, rest); N] };
        std::array::from_fn(|k| {
            let ((z, dz), (a, da)) = (casing[k], blades[k]);
            Point { z, dz: dz * per, a, da: da * per }
        })
    }

    /// Returns the contact forces of the rows per unit casing mass after `s` seconds \[m/s^2\].
    pub(super) fn pushes_at(&self, held: &Held, s: f64) -> impl Iterator<Item = (usize, f64)> {
        let x = self.part(s);
        held.rows.iter().zip(&self.pushes).map(move |(row, push)| (*row, value(push, x).max(0.0)))
    }

    /// Returns whether the pulse acts.
    pub(super) fn is_pulsed(&self) -> bool {
        term(&self.force, 0) != Plane::default()
    }

    /// Returns the pulse force per unit casing mass after `s` seconds \[m/s^2\].
    pub(super) fn force_at(&self, s: f64) -> Plane {
        let x = self.part(s);
        Plane::new(value(&self.force[0], x), value(&self.force[1], x))
    }

    /// Returns a lower bound on the gap of a row over the fraction `end` of the stretch \[m\].
    pub(super) fn least_gap(&self, flow: &Flow, row: usize, end: f64) -> f64 {
        let (from, h) = (&self.from, self.length);
        let face = flow.face(row, from);
        let (now, rate) = (flow.gap_at(row, &face, from), h * face.along(from.dz, from.da));
        let second = (term(&self.z, 2), term(&self.a, 2));
        let bend = h
            * h
            * flow.gap_bend(&face, from, (second.0 * (2.0 / (h * h)), second.1 * (2.0 / (h * h))));
        // The least of now + rate x + bend x^2/2 is at an end or between them.
        let mut least = now.min(now + end * (rate + 0.5 * bend * end));
        if rate < 0.0 && bend > 0.0 && -rate < bend * end {
            least = least.min(now - 0.5 * rate * rate / bend);
        }
        least - self.twist * end * end * end / 6.0
    }

    /// Returns the gap of a row as a power series \[m\].
    pub(super) fn gap(&self, flow: &Flow, row: usize) -> Terms {
        let base = flow.rows.get(row).copied().unwrap_or_default();
        let part = |wave: &Wave| -> Terms {
            std::array::from_fn(|n| base.re * wave[0][n] + base.im * wave[1][n])
        };
        let turned = flow.diameters();
        let mut gap = part(&self.z);
        if let Some(Blades { arm, .. }) = flow.blades {
            let alpha = part(&self.a);
            if turned != 0.0 && alpha.iter().any(|term| *term != 0.0) {
                let [re, im] = turned_normal(base, turned, &alpha);
                gap = [0.0; TERMS];
                for n in 0..TERMS {
                    add_product(&mut gap, &self.z[0], n, re[n]);
                    add_product(&mut gap, &self.z[1], n, im[n]);
                }
            }
            gap.iter_mut().zip(&alpha).for_each(|(term, alpha)| *term -= arm * alpha);
        }
        gap[0] += flow.apothem(row);
        gap
    }
}

/// Returns the series of `base exp(i d alpha)`, from `n' = i d alpha' n`. Each term is added to all
/// later ones at once, so that the operations can overlap.
fn turned_normal(base: Plane, d: f64, alpha: &Terms) -> Wave {
    let mut rate = [0.0; TERMS];
    for (n, (rate, term)) in rate.iter_mut().zip(alpha.iter().skip(1)).enumerate() {
        *rate = d * (n as f64 + 1.0) * term;
    }
    let (mut normal, mut slope) = ([[0.0; TERMS]; 2], [[0.0; TERMS]; 2]);
    let mut next = base * Plane::cis(d * alpha[0]);
    for n in 0..TERMS {
        put(&mut normal, n, next);
        add_product(&mut slope[0], &rate, n, -next.im);
        add_product(&mut slope[1], &rate, n, next.re);
        next = term(&slope, n) / (n as f64 + 1.0);
    }
    normal
}

/// Adds the product of a series and `value x^n`.
fn add_product(sum: &mut Terms, terms: &Terms, n: usize, value: f64) {
    for (sum, term) in sum.iter_mut().skip(n).zip(terms) {
        *sum += value * term;
    }
}

impl Turning {
    /// Appends term `n` of rate and place and term `n + 1` of the normal; returns the part of term
    /// `n + 2` of `x` without the terms `n + 2` of casing and blades.
    fn follow(&mut self, face: &Face, rate: f64, z: &Wave, n: usize) -> f64 {
        if n == 0 {
            put(&mut self.normal, 0, face.normal);
        }
        let order = n as f64;
        let turned = Plane::i() * (self.sum + face.normal * rate);
        self.rate[n] = rate;
        put(&mut self.normal, n + 1, turned / (order + 1.0));
        let ([re, im], [z_re, z_im]) = (&self.normal, z);
        let (mut sum, mut x, mut y) = (Plane::default(), 0.0, 0.0);
        // All sums at once, so that their operations can overlap.
        for k in 0..=n {
            let j = n - k;
            y += re[k] * z_im[j] - im[k] * z_re[j];
            sum.re += self.rate[k] * re[j + 1];
            sum.im += self.rate[k] * im[j + 1];
            x += re[k + 1] * z_re[j + 1] + im[k + 1] * z_im[j + 1];
        }
        (self.y[n], self.sum) = (y, sum);
        x + dot(Plane::i() * sum / (order + 2.0), term(z, 0))
    }

    /// Returns the contribution of the forces up to term `n - 1` to term `n`, due to the change of normal
    /// and position.
    fn left(&self, pushes: &Terms, n: usize) -> [f64; 3] {
        let mut left = [0.0; 3];
        for (k, push) in pushes.iter().enumerate().take(n) {
            let j = n - k;
            left[0] += push * self.normal[0][j];
            left[1] += push * self.normal[1][j];
            left[2] += push * self.y[j];
        }
        left
    }
}

/// Factors `1/((n + 1)(n + 2))`, by which term `n` of an acceleration gives term `n + 2` of the
/// displacement.
const OVER: [f64; TERMS - 2] = {
    let mut over = [0.0; TERMS - 2];
    let mut n = 0;
    while n < over.len() {
        over[n] = 1.0 / ((n as f64 + 1.0) * (n as f64 + 2.0));
        n += 1;
    }
    over
};
