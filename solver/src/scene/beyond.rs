//! What a scene has beyond the paper's model (docs/theory.md, section 10), and which
//! combinations of it have no meaning or no unique answer.

use super::check::{down, up};
use super::{ContactLaw, ModelSize, Scene, SceneError, SolverKind, Value, keys};

impl Scene {
    /// Returns whether this scene has more than the paper's model. Others are solved by the
    /// paper's own solvers, bit for bit.
    #[must_use]
    pub fn goes_beyond(&self) -> bool {
        self.has_other_tips() || self.changes_with_speed()
    }

    /// Returns whether tips have lengths of their own, or the casing is out of round.
    #[must_use]
    pub fn is_uneven(&self) -> bool {
        self.unevenness().iter().any(|(_, length)| *length != 0.0)
    }

    /// Returns the keys that give tips lengths of their own, and that of the casing out of round,
    /// which is the last, each with its largest magnitude \[m\].
    #[must_use]
    pub fn unevenness(&self) -> [(&'static str, f64); 5] {
        let disk = &self.bladed_disk;
        [
            (keys::TIPS, disk.tips_m.iter().fold(0.0, |most: f64, tip| most.max(tip.abs()))),
            (keys::TIP_SCATTER, disk.tip_scatter_m),
            (keys::LONGEST_TIP, disk.longest_tip_m),
            (keys::ORBIT, disk.orbit_m),
            (keys::OUT_OF_ROUND, self.casing.out_of_round_m),
        ]
        .map(|(key, length)| (key, length.abs()))
    }

    /// Returns whether the machine changes with the rotor speed in a run.
    #[must_use]
    pub fn changes_with_speed(&self) -> bool {
        let stiffens = self.disk_in_use().centrifugal_stiffening != 0.0;
        let grows = self.casing.clearance_loss_m_s2 != 0.0;
        grows || (stiffens && self.solver.model != ModelSize::Rigid)
    }

    /// Returns whether the contact of tips and casing differs from the paper at any speed.
    #[must_use]
    pub fn has_other_tips(&self) -> bool {
        let (disk, surface) = (&self.bladed_disk, &self.contact);
        let model = self.solver.model;
        let tips = disk.radial_coupling != 0.0 || surface.friction != 0.0;
        self.solver.contact == ContactLaw::Smooth
            || self.is_uneven()
            || surface.restitution != 0.0
            || surface.friction * self.casing.tangential_ratio != 0.0
            || (model != ModelSize::Rigid && tips)
            || (model == ModelSize::Modal && self.has_other_diameters())
            || (model == ModelSize::Full && disk.mistuning != 0.0)
    }

    /// Returns whether the modes of the disk have other diameters than those of the casing.
    #[must_use]
    pub fn has_other_diameters(&self) -> bool {
        let casing = self.operation.nodal_diameters;
        self.bladed_disk.diameters_beside(casing) != casing
    }

    /// Returns what steady states and limits leave out, for scenes whose runs have every blade
    /// alone: they assume equal blades in the modes of one number of diameters.
    #[must_use]
    pub fn tuned_note(&self) -> Option<String> {
        let disk = &self.bladed_disk;
        let diameters = disk.diameters_beside(self.operation.nodal_diameters);
        let mistuned = match disk.mistuning {
            0.0 => String::new(),
            sd => format!(" with stiffnesses that differ by {sd} (standard deviation)"),
        };
        (self.solver.model == ModelSize::Full).then(|| {
            format!(
                "of equal blades in the modes of {diameters} nodal diameters; runs of this \
                 scene (solver.model = \"full\") have every blade alone{mistuned}"
            )
        })
    }

    /// Returns that the contact of this scene can have several answers, of which its runs take
    /// one: with friction, several single blades on a side of radial tips share a push in more
    /// than one way, as the product of their levers `A (A - mu l_b)` is negative for
    /// `0 < A < mu l_b`.
    #[must_use]
    pub fn share_note(&self) -> Option<&'static str> {
        let rubs = self.contact.friction != 0.0 && self.bladed_disk.radial_coupling == 0.0;
        let rigid = self.solver.contact != ContactLaw::Smooth;
        let several = self.machine().polygon.blades_per_side > 1;
        (rubs && rigid && several && self.solver.model == ModelSize::Full).then_some(
            "with friction several blades of a side can share its push in more than one way; \
             this run takes the even share, one answer of several",
        )
    }

    /// Returns the clearance of a rotor at rest, `g0 = R_c - l_b`, which is negative where all
    /// blades interfere with the casing \[m\].
    #[must_use]
    pub fn clearance(&self) -> f64 {
        self.casing.radius_m - self.bladed_disk.blade_length_m
    }

    /// Sets the clearance \[m\] by the radius of the casing, without a check of the scene.
    ///
    /// # Errors
    /// A radius that its key does not allow.
    pub fn set_clearance(&mut self, g0: f64) -> Result<(), SceneError> {
        let radius = self.bladed_disk.blade_length_m + g0;
        self.set_value(keys::find("casing.radius_m")?, Value::Real(radius))
    }
}

impl Scene {
    /// Refuses friction on a rotor that stands still: one motion needs a direction in
    /// which the blades slide. A sweep may begin there.
    ///
    /// # Errors
    /// The friction, and what is allowed.
    pub fn slides(&self) -> Result<(), SceneError> {
        let (mu, operation) = (self.contact.friction, &self.operation);
        if mu == 0.0 || operation.speed_rad_s != 0.0 {
            return Ok(());
        }
        let allowed = "0 with operation.speed_rad_s = 0: Coulomb's law, mu times the push against \
                       the sliding, has no direction there";
        Err(SceneError::refused(keys::FRICTION, mu, allowed))
    }
}

/// Rejects combinations beyond the paper's model that have no meaning or no unique answer.
///
/// # Errors
/// The first such combination, named by its key.
pub(super) fn check(scene: &Scene) -> Result<(), SceneError> {
    diameters(scene)?;
    slope(scene)?;
    friction(scene)?;
    restitution(scene)?;
    mistuning(scene)?;
    digging_in(scene)?;
    opening(scene)?;
    by_events(scene)
}

/// Refuses a list that is not of all blades, and tips or lobes that leave rigid contact no
/// room.
pub(super) fn tips(scene: &Scene) -> Result<(), SceneError> {
    let (disk, casing) = (&scene.bladed_disk, &scene.casing);
    let (given, blades) = (disk.tips_m.len(), disk.blades as usize);
    if given != 0 && given != blades {
        let allowed = format!("none, or one for each of bladed_disk.blades = {blades}");
        return Err(SceneError::refused(keys::TIPS, format!("{given} numbers"), allowed));
    }
    let e = casing.out_of_round_m;
    if e != 0.0 && casing.lobes == 0 {
        let allowed = "1 or more with casing.out_of_round_m; another clearance is that of \
                       casing.radius_m";
        return Err(SceneError::refused(keys::LOBES, 0, allowed));
    }
    if e != 0.0 && scene.solver.kind == SolverKind::Event {
        let allowed = "0 with solver.kind = \"event\": a side that moves has no closed form";
        return Err(SceneError::refused(keys::OUT_OF_ROUND, format!("{e:e}"), allowed));
    }
    let machine = scene.machine();
    let rigid = scene.solver.contact != ContactLaw::Smooth;
    if !(rigid && scene.is_uneven()) || machine.at(scene.fastest_rad_s()).has_room() {
        return Ok(());
    }
    let allowed = "less: no place of the casing leaves every gap open; solver.contact = \
                   \"smooth\" takes it";
    let all = scene.unevenness().into_iter();
    let (key, value) = all.fold(("", 0.0), |most, next| if next.1 > most.1 { next } else { most });
    Err(SceneError::refused(key, format!("{value:e}"), allowed))
}

/// Refuses rigid contact of blades in other diameters than those of the casing.
fn diameters(scene: &Scene) -> Result<(), SceneError> {
    if scene.solver.contact == ContactLaw::Smooth || !scene.has_other_diameters() {
        return Ok(());
    }
    let casing = scene.operation.nodal_diameters;
    let allowed = format!(
        "0 or that of the casing, {casing}, with rigid contact; solver.contact = \"smooth\" takes \
         others"
    );
    Err(SceneError::refused(keys::DISK_DIAMETERS, scene.bladed_disk.nodal_diameters, allowed))
}

/// Refuses inclined tips under the paper's law, whose gaps the blade angles do not close.
fn slope(scene: &Scene) -> Result<(), SceneError> {
    let kappa = scene.bladed_disk.radial_coupling;
    if kappa == 0.0 || scene.solver.contact != ContactLaw::Bilateral {
        return Ok(());
    }
    let allowed = "0 with solver.contact = \"bilateral\", the paper's law; \"unilateral\" and \
                   \"smooth\" take inclined tips";
    Err(SceneError::refused(keys::RADIAL_COUPLING, kappa, allowed))
}

/// Rejects friction without one direction in which the blades slide.
fn friction(scene: &Scene) -> Result<(), SceneError> {
    let (mu, operation) = (scene.contact.friction, &scene.operation);
    if mu == 0.0 {
        return Ok(());
    }
    let refused = |allowed: &str| Err(SceneError::refused(keys::FRICTION, mu, allowed));
    if scene.solver.contact == ContactLaw::Bilateral {
        return refused("0 with solver.contact = \"bilateral\": a pull has no friction");
    }
    let first = operation.speed_rad_s;
    let last = first + operation.speed_ramp_rad_s2 * scene.solver.end_s;
    if first * last > 0.0 || first == last {
        return Ok(());
    }
    refused("0 where a ramp stops the rotor or turns it back: the direction of sliding is fixed")
}

fn restitution(scene: &Scene) -> Result<(), SceneError> {
    let e = scene.contact.restitution;
    if e == 0.0 || scene.solver.contact == ContactLaw::Unilateral {
        return Ok(());
    }
    let allowed = "0, or solver.contact = \"unilateral\": only rigid pushes rebound";
    Err(SceneError::refused(keys::RESTITUTION, e, allowed))
}

fn mistuning(scene: &Scene) -> Result<(), SceneError> {
    let sd = scene.bladed_disk.mistuning;
    if sd == 0.0 || scene.solver.model == ModelSize::Full {
        return Ok(());
    }
    let allowed = "0, or solver.model = \"full\": only there has each blade its own stiffness";
    Err(SceneError::refused(keys::MISTUNING, sd, allowed))
}

/// Rejects rigid contact of single blades with self-locking friction, which has no unique
/// contact forces once three blades touch.
fn digging_in(scene: &Scene) -> Result<(), SceneError> {
    let (kappa, mu) = (scene.bladed_disk.radial_coupling, scene.contact.friction);
    let forward = if scene.operation.speed_rad_s < 0.0 { -mu } else { mu };
    let rigid = scene.solver.contact != ContactLaw::Smooth;
    if !(rigid && scene.solver.model == ModelSize::Full && kappa * (kappa + forward) < 0.0) {
        return Ok(());
    }
    let allowed = format!(
        "not between 0 and {} with solver.model = \"full\" and rigid contact, whose pushes are \
         not unique there; solver.model = \"modal\" or solver.contact = \"smooth\" have them",
        -forward
    );
    Err(SceneError::refused(keys::RADIAL_COUPLING, kappa, allowed))
}

/// Rejects tips whose contact force closes its own gap: it must open it, `1/m_c + c2/m_a > 0`, and in a time step with `m/h^2 +
/// d/2h` in place of `m` too: otherwise no push, or more than one, closes the gap.
fn opening(scene: &Scene) -> Result<(), SceneError> {
    let machine = scene.machine();
    let step = match scene.solver.kind {
        SolverKind::Explicit => scene.solver.step_s,
        SolverKind::Event => 0.0,
    };
    let [casing, blades] = [
        machine.casing_mass + 0.5 * step * machine.casing_damping,
        machine.blade_modal_mass + 0.5 * step * machine.blade_modal_damping,
    ];
    let of_masses = machine.casing_mass / machine.blade_modal_mass;
    let ratio = of_masses.max(casing / blades);
    let product = machine.coupling_product_at(scene.operation.speed_rad_s);
    if scene.solver.contact == ContactLaw::Smooth || product * ratio > -1.0 {
        return Ok(());
    }
    // Between the roots of kappa (kappa + mu) = -m_a/(m_c l_b^2).
    let (kappa, mu) = (scene.bladed_disk.radial_coupling, scene.contact.friction);
    let least = 1.0 / (ratio * machine.blade_length * machine.blade_length);
    let half = (0.25 * mu * mu - least).max(0.0).sqrt();
    let [far, near] = [up(0.5 * mu + half), down(0.5 * mu - half)].map(|end| end.copysign(kappa));
    let allowed = format!(
        "not from {} to {} with contact.friction = {mu} and rigid contact: there \
         kappa (kappa + mu) l_b^2/m_a is below -1/m_c, and a push closes the gap that it is to \
         open; solver.contact = \"smooth\" takes it",
        far.min(near),
        far.max(near)
    );
    Err(SceneError::refused(keys::RADIAL_COUPLING, kappa, allowed))
}

/// Rejects events of equations whose coefficients change in the frame of the blades.
fn by_events(scene: &Scene) -> Result<(), SceneError> {
    let ramp = scene.operation.speed_ramp_rad_s2;
    if scene.solver.kind != SolverKind::Event || ramp == 0.0 || !scene.goes_beyond() {
        return Ok(());
    }
    let allowed = if scene.has_other_tips() {
        "0 with solver.kind = \"event\" beyond the paper's model"
    } else {
        "0 with solver.kind = \"event\" where the machine changes with the speed \
         (bladed_disk.centrifugal_stiffening, casing.clearance_loss_m_s2)"
    };
    Err(SceneError::refused(keys::SPEED_RAMP, ramp, allowed))
}
