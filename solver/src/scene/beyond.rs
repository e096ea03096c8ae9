//! Features of a scene beyond the paper's model (docs/theory.md, sections 10 and 11), and the
//! combinations of them that are meaningless or have no unique solution.

use super::check::{down, up};
use super::error::refuse_if;
use super::{ContactLaw, ModelSize, Scene, SceneError, SolverKind, Value, keys};

impl Scene {
    /// Returns whether the scene uses any feature beyond the paper's model. Such a run keeps an
    /// energy balance and computes the steps of held tips one by one.
    #[must_use]
    pub fn goes_beyond(&self) -> bool {
        self.has_other_tips() || self.changes_with_speed()
    }

    /// Returns whether tips differ in length, or the casing is out of round.
    #[must_use]
    pub fn is_uneven(&self) -> bool {
        self.unevenness().iter().any(|(_, length)| *length != 0.0)
    }

    /// Returns the keys of unequal tips, then that of the out-of-round casing, each with its
    /// largest magnitude \[m\].
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

    /// Returns whether the machine properties change with the rotor speed in this model size.
    #[must_use]
    pub fn changes_with_speed(&self) -> bool {
        let stiffens = self.disk_in_use().centrifugal_stiffening != 0.0;
        let grows = self.casing.clearance_loss_m_s2 != 0.0;
        grows || (stiffens && self.solver.model != ModelSize::Rigid)
    }

    /// Returns whether blades move and a contact force bends them by the slope or the friction of
    /// their tips. The event solver then neglects the blade angles in the phases of the gaps.
    #[must_use]
    pub fn has_slope_or_friction(&self) -> bool {
        let tips = self.bladed_disk.radial_coupling != 0.0 || self.contact.friction != 0.0;
        self.solver.model != ModelSize::Rigid && tips
    }

    /// Returns whether the contact of tips and casing differs from the paper's.
    #[must_use]
    pub fn has_other_tips(&self) -> bool {
        let (disk, surface) = (&self.bladed_disk, &self.contact);
        let model = self.solver.model;
        self.solver.contact == ContactLaw::Smooth
            || self.is_uneven()
            || surface.restitution != 0.0
            || surface.friction * self.casing.tangential_ratio != 0.0
            || self.has_slope_or_friction()
            || (model == ModelSize::Modal && self.has_other_diameters())
            || (model == ModelSize::Full && disk.mistuning != 0.0)
    }

    /// Returns whether the disk modes have other nodal diameters than the casing modes.
    #[must_use]
    pub fn has_other_diameters(&self) -> bool {
        let casing = self.operation.nodal_diameters;
        self.bladed_disk.diameters_beside(casing) != casing
    }

    /// Returns, for the full model, the note that steady states and limits are computed for equal
    /// blades in the modes of one number of nodal diameters, while runs compute every blade;
    /// `None` for the other models.
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
                "for equal blades in the modes of {diameters} nodal diameters; runs of this \
                 scene (solver.model = \"full\") compute every blade{mistuned}"
            )
        })
    }

    /// Returns the note that the contact forces of this scene are not unique; `None` if they are.
    /// They are not with friction, radial tips and several blades on a side, each with its own angle:
    /// the product of the blade levers `A (A - mu l_b)` is negative for `0 < A < mu l_b`, so the
    /// blades can share a contact force in more than one way.
    #[must_use]
    pub fn share_note(&self) -> Option<&'static str> {
        let rubs = self.contact.friction != 0.0 && self.bladed_disk.radial_coupling == 0.0;
        let rigid = self.solver.contact != ContactLaw::Smooth;
        let several = self.machine().polygon.blades_per_side > 1;
        (rubs && rigid && several && self.solver.model == ModelSize::Full).then_some(
            "with friction several blades of a side can share its push in more than one way; \
             this run shares it evenly, which is one solution of several",
        )
    }

    /// Returns the clearance at rest, `g0 = R_c - l_b`; negative if all blades interfere with the
    /// casing \[m\].
    #[must_use]
    pub fn clearance(&self) -> f64 {
        self.casing.radius_m - self.bladed_disk.blade_length_m
    }

    /// Sets the clearance by changing the casing radius \[m\]. The scene is not checked.
    ///
    /// # Errors
    /// The clearance is out of bounds.
    pub fn set_clearance(&mut self, g0: f64) -> Result<(), SceneError> {
        self.set_value(&keys::CLEARANCE_KEY, Value::Real(g0))
    }
}

impl Scene {
    /// Rejects friction on a rotor at standstill, where the direction of sliding is undefined. Not
    /// part of [`checked`](Self::checked), because a sweep may begin there.
    ///
    /// # Errors
    /// States the coefficient of friction and what is allowed.
    pub fn slides(&self) -> Result<(), SceneError> {
        let mu = self.contact.friction;
        let allowed = "0 with operation.speed_rad_s = 0: Coulomb's law, mu times the push against \
                       the sliding, has no direction there";
        refuse_if(mu != 0.0 && self.operation.speed_rad_s == 0.0, keys::FRICTION, mu, allowed)
    }
}

/// Rejects combinations beyond the paper's model that are meaningless or have no unique solution.
///
/// # Errors
/// Names the key of the first such combination.
pub(super) fn check(scene: &Scene) -> Result<(), SceneError> {
    let (disk, surface, operation) = (&scene.bladed_disk, &scene.contact, &scene.operation);
    let law = scene.solver.contact;
    let (rigid, full) = (law != ContactLaw::Smooth, scene.solver.model == ModelSize::Full);
    let casing = operation.nodal_diameters;
    let allowed = format!(
        "0 or that of the casing, {casing}, with rigid contact; solver.contact = \"smooth\" takes \
         others"
    );
    let is_other = rigid && scene.has_other_diameters();
    refuse_if(is_other, keys::DISK_DIAMETERS, disk.nodal_diameters, &allowed)?;
    // The bilateral law of the paper does not include the gap change by blade angles.
    let (kappa, bilateral) = (disk.radial_coupling, law == ContactLaw::Bilateral);
    let allowed = "0 with solver.contact = \"bilateral\", the paper's law; \"unilateral\" and \
                   \"smooth\" take inclined tips";
    refuse_if(bilateral && kappa != 0.0, keys::RADIAL_COUPLING, kappa, allowed)?;
    let mu = surface.friction;
    let allowed = "0 with solver.contact = \"bilateral\": a pull has no friction";
    refuse_if(bilateral && mu != 0.0, keys::FRICTION, mu, allowed)?;
    let first = operation.speed_rad_s;
    let last = first + operation.speed_ramp_rad_s2 * scene.solver.end_s;
    let allowed =
        "0 where a ramp stops the rotor or turns it back: the direction of sliding is fixed";
    let turns = first != last && first * last <= 0.0;
    refuse_if(turns && mu != 0.0, keys::FRICTION, mu, allowed)?;
    let e = surface.restitution;
    let allowed = "0, or solver.contact = \"unilateral\": only rigid push-only contact rebounds";
    refuse_if(e != 0.0 && law != ContactLaw::Unilateral, keys::RESTITUTION, e, allowed)?;
    let sd = disk.mistuning;
    let allowed =
        "0, or solver.model = \"full\": only there does each blade have its own stiffness";
    refuse_if(sd != 0.0 && !full, keys::MISTUNING, sd, allowed)?;
    // Self-locking friction has no unique contact forces once three blades touch.
    let forward = if first < 0.0 { -mu } else { mu };
    let locks_itself = rigid && full && kappa * (kappa + forward) < 0.0;
    let allowed = format!(
        "not between 0 and {} with solver.model = \"full\" and rigid contact, whose pushes are \
         not unique there; they are with solver.model = \"modal\" or solver.contact = \"smooth\"",
        -forward
    );
    refuse_if(locks_itself, keys::RADIAL_COUPLING, kappa, &allowed)?;
    opening(scene)?;
    by_events(scene)
}

/// Rejects a list of tip lengths that does not match the number of blades, a lobe height with a
/// lobe count of zero, and tips or lobes that leave no room in rigid contact.
pub(super) fn tips(scene: &Scene) -> Result<(), SceneError> {
    let (disk, casing) = (&scene.bladed_disk, &scene.casing);
    let (given, blades) = (disk.tips_m.len(), disk.blades as usize);
    let allowed = format!("none, or one for each of bladed_disk.blades = {blades}");
    let is_part = given != 0 && given != blades;
    refuse_if(is_part, keys::TIPS, format!("{given} numbers"), &allowed)?;
    let e = casing.out_of_round_m;
    let allowed = "1 or more with casing.out_of_round_m; casing.radius_m changes the clearance";
    refuse_if(e != 0.0 && casing.lobes == 0, keys::LOBES, 0, allowed)?;
    let allowed = "0 with solver.kind = \"event\": a side that moves has no closed form; \
                   solver.kind = \"explicit\" takes it";
    let has_events = scene.solver.kind == SolverKind::Event;
    refuse_if(e != 0.0 && has_events, keys::OUT_OF_ROUND, format!("{e:e}"), allowed)?;
    let is_tight = scene.solver.contact != ContactLaw::Smooth
        && !scene.machine().at(scene.fastest_rad_s()).has_room();
    let allowed = "less: no casing position leaves every gap open; solver.contact = \
                   \"smooth\" allows it";
    let all = scene.unevenness().into_iter();
    let (key, value) = all.fold(("", 0.0), |most, next| if next.1 > most.1 { next } else { most });
    refuse_if(is_tight, key, format!("{value:e}"), allowed)
}

/// Rejects tips whose contact force closes its own gap.
///
/// A contact force opens its gap only if `1/m_c + c2/m_a > 0`, and in a time step also with
/// `m + d h/2` in place of `m`. Otherwise no contact force, or more than one, closes the gap.
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
    // Not allowed: the range between the roots of kappa (kappa + mu) = -m_a/(m_c l_b^2).
    let (kappa, mu) = (scene.bladed_disk.radial_coupling, scene.contact.friction);
    let least = 1.0 / (ratio * machine.blade_length * machine.blade_length);
    let half = (0.25 * mu * mu - least).max(0.0).sqrt();
    let [far, near] = [up(0.5 * mu + half), down(0.5 * mu - half)].map(|end| end.copysign(kappa));
    let allowed = format!(
        "not from {} to {} with contact.friction = {mu} and rigid contact: there \
         kappa (kappa + mu) l_b^2/m_a is below -1/m_c, and a push closes the gap that it should \
         open; solver.contact = \"smooth\" takes it",
        far.min(near),
        far.max(near)
    );
    Err(SceneError::refused(keys::RADIAL_COUPLING, kappa, allowed))
}

/// Rejects a speed ramp in the event solver if the coefficients of the equations then change in the
/// blade frame.
fn by_events(scene: &Scene) -> Result<(), SceneError> {
    let ramp = scene.operation.speed_ramp_rad_s2;
    let has_events = scene.solver.kind == SolverKind::Event;
    let allowed = if scene.has_other_tips() {
        "0 with solver.kind = \"event\" beyond the paper's model"
    } else {
        "0 with solver.kind = \"event\" where the machine changes with the speed \
         (bladed_disk.centrifugal_stiffening, casing.clearance_loss_m_s2)"
    };
    let is_wrong = has_events && ramp != 0.0 && scene.goes_beyond();
    refuse_if(is_wrong, keys::SPEED_RAMP, ramp, allowed)
}
