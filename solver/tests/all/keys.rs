//! Keys of scenes, in a word.

pub const KAPPA: &str = "bladed_disk.radial_coupling";
pub const MU: &str = "contact.friction";
pub const TAU: &str = "casing.tangential_ratio";
pub const SPEED: &str = "operation.speed_rad_s";
pub const RAMP: &str = "operation.speed_ramp_rad_s2";
pub const PULSE: &str = "operation.pulse_n";
pub const LENGTH: &str = "operation.pulse_s";
pub const DIAMETERS: &str = "operation.nodal_diameters";
pub const STEP: &str = "solver.step_s";
pub const END: &str = "solver.end_s";
pub const MODEL: &str = "solver.model";
pub const LAW: &str = "solver.contact";
pub const KIND: &str = "solver.kind";
pub const ZETA: &str = "casing.damping_ratio";
pub const ZETA_BD: &str = "bladed_disk.damping_ratio";
pub const BLADES: &str = "bladed_disk.blades";
pub const STIFFENING: &str = "bladed_disk.centrifugal_stiffening";
pub const LOSS: &str = "casing.clearance_loss_m_s2";
