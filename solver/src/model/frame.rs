//! Casing and blade modes in the frame that rotates with the blades: mass, damping and stiffness,
//! contact rows that stay closed or act as springs, and the state matrix (docs/theory.md, sections 8
//! and 10).
//!
//! Coordinates are `w = (x, y, alpha_c, alpha_s)`: the casing `z = x + i y = (u_c + i u_s)
//! exp(-i n_d theta)` \[m\] and the two blade modes \[rad\]. A structure of mass `m`, damping `d` and
//! stiffness `k` at rest in another frame, which turns at `t` against this one, has
//! `d/dt -> d/dt + i t`:
//!
//! `L(l) = m (l + i t)^2 + d (l + i t) + k`, with `t = n_d Omega` for the casing and 0 for blades.
//!
//! A contact row has a gap gradient `g` and a force direction `f`, `M w'' + C w' + K w + sum
//! Lambda f = 0`. Without friction and slope both are the same vector. Blades that bend turn `f`,
//! which adds `Lambda df/dw` to `K` (the curvature of the pushes). A row that is held removes the
//! motions with `g . w != 0`; a row on a spring `k` adds `k f g^T` to `K`.
//!
//! Read [`Frame`], then [`Row`], then [`Frame::motion`].

use nalgebra::{Complex, DMatrix, Matrix2, Matrix4, Vector2, Vector4};

use super::Machine;
use crate::numeric::eigen::{complex_eigenvalues, eigenvalues};
use crate::numeric::rounding::AS_ZERO;

/// Mass, damping and stiffness of one structure, and the rotational rate of its own frame relative to
/// the frame of the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Structure {
    /// Modal mass \[kg\] or inertia \[kg m^2\].
    pub mass: f64,
    /// Modal damping \[N s/m\] or \[N m s/rad\].
    pub damping: f64,
    /// Modal stiffness \[N/m\] or \[N m/rad\].
    pub stiffness: f64,
    /// Turn rate `t` \[rad/s\].
    pub turn: f64,
}

impl Structure {
    /// Returns the undamped natural frequency `sqrt(k/m)` \[rad/s\].
    pub(crate) fn own_frequency(&self) -> f64 {
        (self.stiffness / self.mass).sqrt()
    }

    /// Returns the dynamic stiffness `L` at a frequency in the structure's own frame \[rad/s\],
    /// `k - m omega^2 + i d omega`. The factored difference avoids cancellation at a resonance.
    #[must_use]
    pub fn dynamic_stiffness(&self, omega: f64) -> Complex<f64> {
        let own = self.own_frequency();
        Complex::new(self.mass * (own - omega) * (own + omega), self.damping * omega)
    }

    /// Returns the eigenvalues `l` on a spring, the roots of `L(l) + spring` \[1/s\].
    #[must_use]
    pub fn on_spring(&self, spring: Complex<f64>) -> [Complex<f64>; 2] {
        let [constant, linear, square] = self.powers();
        roots([constant + spring, linear, square])
    }

    /// Returns the coefficients of `L(l)` for powers 0, 1 and 2 of the rate `l`.
    #[must_use]
    pub fn powers(&self) -> [Complex<f64>; 3] {
        let constant = self.dynamic_stiffness(self.turn);
        [
            constant,
            Complex::new(self.damping, 2.0 * self.mass * self.turn),
            Complex::from(self.mass),
        ]
    }
}

/// Casing and blades at one rotor speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The casing mode; its turn rate is `nu = n_d Omega` in the frame of the blades.
    pub casing: Structure,
    /// The blade modes.
    pub blades: Structure,
    /// Friction on the casing mode, `mu_c`; negative for backward rotation.
    pub friction: f64,
    /// Effect of a blade angle on its gap, `kappa l_b` \[m\].
    pub slope: f64,
    /// Lever of a contact force on its blade, `(kappa + mu) l_b` \[m\].
    pub lever: f64,
    /// Nodal diameters `n_d`.
    pub diameters: f64,
    /// Number of coordinates: 4, or 3 if the disk has one blade mode.
    coordinates: usize,
}

impl Frame {
    /// Creates the frame of the blades at a rotor speed \[rad/s\].
    #[must_use]
    pub fn at(machine: &Machine, speed: f64) -> Self {
        let here = machine.at(speed);
        let structure =
            |mass, damping, stiffness, turn| Structure { mass, damping, stiffness, turn };
        Self {
            casing: structure(
                here.casing_mass,
                here.casing_damping,
                here.casing_stiffness,
                here.nu(speed),
            ),
            blades: structure(
                here.blade_modal_mass,
                here.blade_modal_damping,
                here.blade_modal_stiffness,
                0.0,
            ),
            friction: here.casing_friction_at(speed),
            slope: here.radial_coupling * here.blade_length,
            lever: (here.radial_coupling + here.friction_at(speed)) * here.blade_length,
            diameters: here.nodal_diameters,
            coordinates: if here.has_sine_mode { 4 } else { 3 },
        }
    }

    /// Returns the frame that turns at `s` against the blades \[rad/s\], in which a wave of that
    /// frequency is at rest.
    #[must_use]
    pub fn turning(mut self, s: f64) -> Self {
        self.casing.turn += s;
        self.blades.turn += s;
        self
    }

    /// Returns the coupling product `c2 = kappa (kappa + mu) l_b^2` \[m^2\].
    #[must_use]
    pub fn coupling(&self) -> f64 {
        self.slope * self.lever
    }

    /// Returns the joint compliance `B = (1 + i mu_c)/L_c + c2/L_a` at rest in this frame: the
    /// relative displacement of casing and tips for a wave of contact forces \[m/N\].
    #[must_use]
    pub fn compliance(&self) -> Complex<f64> {
        self.impedance().inv()
    }

    /// Returns `1/B` at rest in this frame \[N/m\], which is finite at a resonance of the casing.
    #[must_use]
    pub fn impedance(&self) -> Complex<f64> {
        let casing = self.casing.dynamic_stiffness(self.casing.turn);
        let turned = Complex::new(1.0, self.friction);
        if self.coupling() == 0.0 {
            return casing / turned;
        }
        let blades = self.blades.dynamic_stiffness(self.blades.turn);
        casing * blades / (blades * turned + casing * self.coupling())
    }

    /// Returns the eigenvalues `l` of waves in which casing and blades stay in contact, `B = 0`: the
    /// roots of `c2 L_c(l) + (1 + i mu_c) L_a(l)` \[1/s\]. They do not depend on the amplitude. Empty
    /// if the tips do not couple casing and blades.
    #[must_use]
    pub fn joined(&self) -> Vec<Complex<f64>> {
        let coupling = self.coupling();
        if coupling == 0.0 {
            return Vec::new();
        }
        let (casing, blades) = (self.casing.powers(), self.blades.powers());
        let turned = Complex::new(1.0, self.friction);
        roots([0, 1, 2].map(|k| casing[k] * coupling + turned * blades[k])).to_vec()
    }

    /// Returns the eigenvalues `l` of the four waves about an axisymmetric state in which contact acts
    /// as a spring in every direction \[1/s\]; `stiffness` is that of all blades together \[N/m\].
    /// `None` if they overflow. With `w = z - kappa l_b a` and `p = -stiffness w`:
    /// `L_c z = (1 + i mu_c) p`, `L_a a = -(kappa + mu) l_b p`.
    #[must_use]
    pub fn round(&self, stiffness: f64) -> Option<Vec<Complex<f64>>> {
        // Blade coordinates are scaled so that both masses are equal.
        let unit = (self.casing.mass / self.blades.mass).sqrt();
        let [slope, lever] = [self.slope * unit, self.lever * unit];
        let pushed = Complex::new(1.0, self.friction) * stiffness;
        let spring = Matrix2::new(
            pushed,
            -pushed * slope,
            Complex::from(-stiffness * lever),
            Complex::from(stiffness * lever * slope),
        );
        let own = |k: usize| {
            let [casing, blades] =
                [self.casing.powers()[k], self.blades.powers()[k] * (unit * unit)];
            Matrix2::from_diagonal(&Vector2::new(casing, blades))
        };
        let mass = Complex::from(self.casing.mass);
        let (damping, stiffness) = (own(1) / mass, (own(0) + spring) / mass);
        state_rates(
            stiffness.map(|x| x.norm()).max().sqrt().max(damping.map(|x| x.norm()).max()),
            |rate| {
                let mut state = DMatrix::zeros(4, 4);
                state.view_mut((0, 2), (2, 2)).fill_with_identity();
                state
                    .view_mut((2, 0), (2, 2))
                    .copy_from(&(stiffness / Complex::from(-rate * rate)));
                state.view_mut((2, 2), (2, 2)).copy_from(&(damping / Complex::from(-rate)));
                complex_eigenvalues(state)
            },
        )
    }

    /// Returns `M`, `C` and `K` about a state with `held` rows, which stay closed, and `springs`, rows
    /// that act as springs of a stiffness \[N/m\].
    #[must_use]
    pub fn matrices(&self, held: &[Row], springs: &[(Row, f64)]) -> [Matrix4<f64>; 3] {
        let mut matrices = [Matrix4::zeros(); 3];
        for (at, structure) in [(0, &self.casing), (2, &self.blades)] {
            let [constant, linear, square] = structure.powers();
            for (matrix, of) in matrices.iter_mut().zip([square, linear, constant]) {
                // Multiplication by a complex number.
                let turned = Matrix2::new(of.re, -of.im, of.im, of.re);
                matrix.fixed_view_mut::<2, 2>(at, at).copy_from(&turned);
            }
        }
        let [.., stiffness] = &mut matrices;
        held.iter().for_each(|row| *stiffness += row.turned);
        springs.iter().for_each(|(row, k)| *stiffness += row.force * row.gap.transpose() * *k);
        matrices
    }

    /// Returns the small motions about a state, with `held` and `springs` as in
    /// [`matrices`](Self::matrices).
    #[must_use]
    pub fn motion(&self, held: &[Row], springs: &[(Row, f64)]) -> Motion {
        let [mass, damping, stiffness] = self.matrices(held, springs);
        // In coordinates of unit mass.
        let weights = mass.diagonal().map(f64::sqrt);
        let vector = |of: &Vector4<f64>| of.component_div(&weights);
        let free = across(held.iter().map(|row| vector(&row.gap)));
        let along = across(held.iter().map(|row| vector(&row.force)));
        let scale = Matrix4::from_diagonal(&weights.map(f64::recip));
        let (first, count) = (held.len(), self.coordinates.saturating_sub(held.len()));
        let project = |matrix: Matrix4<f64>, beyond: f64| {
            let projected = along.tr_mul(&(matrix * free));
            let mut moved = Matrix4::from_diagonal_element(beyond);
            let block = projected.view((first, first), (count, count));
            moved.view_mut((0, 0), (count, count)).copy_from(&block);
            moved
        };
        Motion {
            count,
            mass: project(Matrix4::identity(), 1.0),
            damping: project(scale * damping * scale, 0.0),
            stiffness: project(scale * stiffness * scale, FIRM),
        }
    }
}

/// Returns the roots of a polynomial, given by its coefficients from power 0 on. The larger root comes
/// first; the other follows from the product of both, which avoids cancellation.
fn roots([constant, linear, square]: [Complex<f64>; 3]) -> [Complex<f64>; 2] {
    let half = linear / (square * 2.0);
    let root = (half * half - constant / square).sqrt();
    let far = if (half + root).norm_sqr() >= (half - root).norm_sqr() {
        -half - root
    } else {
        root - half
    };
    [far, if far.norm() > 0.0 { constant / square / far } else { far }]
}

/// Returns an orthonormal basis whose columns, from the number of `rows` on, are orthogonal to all of
/// them.
fn across(rows: impl Iterator<Item = Vector4<f64>>) -> Matrix4<f64> {
    let mut basis = Matrix4::identity();
    for (k, row) in rows.enumerate().take(4) {
        // Householder reflection of the remaining vectors, after which only the first one has a
        // component along the row.
        let mut seen = basis.tr_mul(&row);
        seen.rows_mut(0, k).fill(0.0);
        seen[k] += seen.norm().copysign(seen[k]);
        let square = seen.norm_squared();
        if square > 0.0 {
            let shares = basis * seen * (2.0 / square);
            basis -= shares * seen.transpose();
        }
    }
    basis
}

/// A contact row: the side with the phase `psi`, whose blades have turned by `alpha`.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Gap less the apothem, `Re[z exp(-i b)] - kappa l_b alpha` \[m\].
    pub opening: f64,
    /// Gradient of the gap.
    pub gap: Vector4<f64>,
    /// Force per unit of the multiplier.
    pub force: Vector4<f64>,
    /// Derivative of `Lambda f` with respect to the coordinates.
    pub turned: Matrix4<f64>,
}

impl Row {
    /// Creates the row of a side with the direction `(cos psi, sin psi)` in a state, with a multiplier
    /// (negative is a push) \[N\].
    ///
    /// With `b = psi + n_d alpha` the gap is `h + Re[z exp(-i b)] - kappa l_b alpha`, and the force
    /// `(1 + i mu_c) exp(i b)` on the casing and `n_d Im[z exp(-i b)] - (kappa + mu) l_b` on the
    /// blade.
    #[must_use]
    pub fn new(frame: &Frame, direction: (f64, f64), at: &Vector4<f64>, multiplier: f64) -> Self {
        Self::bent(frame, direction, direction, false, at, multiplier)
    }

    /// As [`new`](Self::new), with blade coordinates that have another `shape` on this side. With
    /// `first_order` the factor `exp(i b)` is expanded to first order in `alpha`, Eq. (26).
    pub(crate) fn bent(
        frame: &Frame,
        (cos, sin): (f64, f64),
        shape: (f64, f64),
        first_order: bool,
        at: &Vector4<f64>,
        multiplier: f64,
    ) -> Self {
        let [x, y, blade_c, blade_s]: [f64; 4] = (*at).into();
        let (n, alpha) = (frame.diameters, blade_c * shape.0 + blade_s * shape.1);
        let (sin_turn, cos_turn) =
            if first_order { (n * alpha, 1.0) } else { (n * alpha).sin_cos() };
        let (c, s) = (cos * cos_turn - sin * sin_turn, sin * cos_turn + cos * sin_turn);
        // Change of the direction by a turn.
        let (c_turned, s_turned) = if first_order { (-sin, cos) } else { (-s, c) };
        let (along, across) = (x * c + y * s, y * c - x * s);
        let push = |c: f64, s: f64| [c - frame.friction * s, s + frame.friction * c];
        let row =
            |[a, b]: [f64; 2], blade: f64| Vector4::new(a, b, blade * shape.0, blade * shape.1);
        let by_blade = row(push(n * c_turned, n * s_turned), n * n * (y * c_turned - x * s_turned));
        let by_casing = [-n * s, n * c];
        let mut turned = Matrix4::zeros();
        for (i, shape) in [(2, shape.0), (3, shape.1)] {
            turned.set_column(i, &(by_blade * (multiplier * shape)));
            for (j, part) in by_casing.into_iter().enumerate() {
                turned[(i, j)] = multiplier * part * shape;
            }
        }
        Self {
            opening: along - frame.slope * alpha,
            gap: row([c, s], n * (x * c_turned + y * s_turned) - frame.slope),
            force: row(push(c, s), n * across - frame.lever),
            turned,
        }
    }

    /// Creates the row of a side whose direction does not depend on the blade angle: its gap changes
    /// by `Re[w exp(-i psi)]`, with `w = z - kappa l_b a`.
    #[must_use]
    pub fn fixed(frame: &Frame, direction: (f64, f64)) -> Self {
        Self::new(frame, direction, &Vector4::zeros(), 0.0)
    }
}

/// Small motions about a state, `M q'' + C q' + K q = 0`.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// Number of coordinates. The rest of each matrix belongs to a coordinate that does not move.
    count: usize,
    mass: Matrix4<f64>,
    damping: Matrix4<f64>,
    stiffness: Matrix4<f64>,
}

/// Stiffness of a coordinate that does not move \[1/s^2\].
const FIRM: f64 = 1e150;

impl Motion {
    /// Returns whether the energy `(q'^T q' + q^T K q)/2` shows that no motion grows faster than
    /// `rate` \[1/s\]: damping takes energy, and the skew part `N` of the stiffness adds at most
    /// `|N| |q| |q'|`. Needs unit masses, which contact without friction leaves.
    #[must_use]
    pub fn is_bounded(&self, rate: f64) -> bool {
        let unit = Matrix4::identity();
        let even = |of: &Matrix4<f64>| (of + of.transpose()) * 0.5;
        let skew = (self.stiffness - self.stiffness.transpose()) * 0.5;
        let softest = (skew.norm() / rate).powi(2);
        (self.mass - unit).amax() <= AS_ZERO
            && (even(&self.stiffness) - unit * softest).cholesky().is_some()
            && (even(&self.damping) + unit * (0.5 * rate)).cholesky().is_some()
    }

    /// Returns the eigenvalues \[1/s\]; `None` if they overflow or cannot be computed, or if the mass
    /// matrix of the motions that the held rows allow is singular.
    #[must_use]
    pub fn eigenvalues(&self) -> Option<Vec<Complex<f64>>> {
        let n = self.count;
        let block = |of: &Matrix4<f64>| of.view((0, 0), (n, n)).into_owned();
        let mass = block(&self.mass).lu();
        let (stiffness, damping) =
            (mass.solve(&block(&self.stiffness))?, mass.solve(&block(&self.damping))?);
        state_rates(stiffness.amax().sqrt().max(damping.amax()), |rate| {
            let mut state = DMatrix::zeros(2 * n, 2 * n);
            state.view_mut((0, n), (n, n)).fill_with_identity();
            state.view_mut((n, 0), (n, n)).copy_from(&(&stiffness / (-rate * rate)));
            state.view_mut((n, n), (n, n)).copy_from(&(&damping / -rate));
            eigenvalues(state)
        })
    }
}

/// Returns the largest growth rate of motions about a wave that is a state of rest at any phase
/// \[1/s\]: its shift in time, which has the eigenvalue 0, is left out. `None` as in
/// [`Motion::eigenvalues`].
pub(crate) fn growth_about_wave(motion: &Motion) -> Option<f64> {
    let mut rates = motion.eigenvalues()?;
    rates.sort_by(|a, b| a.norm_sqr().total_cmp(&b.norm_sqr()));
    Some(rates.iter().skip(1).map(|rate| rate.re).fold(f64::NEG_INFINITY, f64::max))
}

/// Returns the eigenvalues that `of` computes for a state matrix with rates in units of `fastest`
/// \[1/s\].
fn state_rates(
    fastest: f64,
    of: impl FnOnce(f64) -> Option<Vec<Complex<f64>>>,
) -> Option<Vec<Complex<f64>>> {
    let rate = if fastest > 0.0 { fastest } else { 1.0 };
    Some(of(rate)?.into_iter().map(|value| value * rate).collect())
}
