//! Scenes of tests that no built-in one has.

use rubscope_solver::scene::Scene;

/// Half as many diameters as blades, which gives two parallel sides and no corner: the
/// options of a command on `paper-nd3`.
pub const HALF_N: &str = "--nd 11 --speed 100 --pulse 20000 --solver event --contact unilateral \
                          --model rigid";

/// The scene of [`HALF_N`].
pub fn half_n() -> Scene {
    let changes = [
        ("operation.nodal_diameters", "11"),
        ("operation.speed_rad_s", "100"),
        ("operation.pulse_n", "20000"),
        ("solver.kind", "event"),
        ("solver.contact", "unilateral"),
        ("solver.model", "rigid"),
        ("solver.end_s", "0.012"),
    ];
    Scene::builtin("paper-nd3").unwrap().with(&changes).unwrap().into_scene()
}

/// Without damping, in the corner of blades 6 and 21 and turning with them, a little faster
/// than the critical speed.
pub fn near_critical() -> Scene {
    let changes = [
        ("operation.speed_rad_s", "293"),
        ("operation.pulse_n", "0"),
        ("initial.u_c_m", "2.8462967654653897e-5"),
        ("initial.u_s_m", "9.693596572237225e-5"),
        ("initial.v_c_m_s", "-0.0852067138699652"),
        ("initial.v_s_m_s", "0.02501894856844077"),
        ("solver.kind", "event"),
        ("solver.model", "rigid"),
    ];
    Scene::builtin("undamped").unwrap().with(&changes).unwrap().into_scene()
}
