//! What a coincidence does against speed, as the library gives it.

use rubscope_solver::harmonic::{coincidence, shifted_coincidence};
use rubscope_solver::scene::Scene;

use crate::close;

#[test]
fn over_a_clearance_it_is_the_whirl_on_the_rim() {
    let mut scene = Scene::base();
    scene.set("bladed_disk.radial_coupling", "0.3").unwrap();
    // The rim formula is that of `hbm_whirl`.
    let point = coincidence(&scene, &[450.0]).unwrap()[0];
    close(point.omega_rad_s.unwrap(), 1088.520, 1e-6);
    close(point.casing_amplitude_m.unwrap(), 2.1659e-4, 5e-5);
    close(point.blade_amplitude_rad.unwrap(), 8.0872e-4, 5e-5);
    assert!(point.bounded && point.growth_1_s.is_none());
    // Below the fold every pulse decays; above the flutter speed nothing bounds it.
    let below = coincidence(&scene, &[405.0]).unwrap()[0];
    assert!(below.blade_amplitude_rad.is_none() && below.bounded);
    assert!(!coincidence(&scene, &[800.0]).unwrap()[0].bounded);
    assert_eq!(shifted_coincidence(&scene, 1.0), None);
    // A very stiff lining is a rim, and the rotor may turn the other way.
    let mut lined = scene.clone();
    lined.set("solver.contact", "smooth").unwrap();
    lined.set("contact.stiffness_n_per_m", "1e13").unwrap();
    lined.set("contact.smoothing_m", "0").unwrap();
    for speed in [450.0, -450.0] {
        let rigid = coincidence(&scene, &[speed]).unwrap()[0];
        let soft = coincidence(&lined, &[speed]).unwrap()[0];
        close(soft.blade_amplitude_rad.unwrap(), rigid.blade_amplitude_rad.unwrap(), 1e-3);
        close(soft.omega_rad_s.unwrap(), rigid.omega_rad_s.unwrap(), 1e-9);
        assert!((rigid.omega_rad_s.unwrap() * speed) > 0.0);
    }
    scene.set("operation.nodal_diameters", "11").unwrap();
    assert!(coincidence(&scene, &[400.0]).is_err());
}
