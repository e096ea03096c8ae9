//! The terms of what goes beyond the paper.

use super::Here::{Knob, Nothing, Of};
use super::Term;
use super::terms::term;
use crate::harmonic::Joint;

/// Symbols of coupled tips, friction and linings.
pub const BEYOND: &[Term] = &[
    term(
        "κ",
        "kappa",
        "slope of the path of a blade tip: above 0 the blade trails, and contact bends it back and in; between -μ and 0 it digs in (d on its bar)",
        "the tip moves outward by κ l_b α",
        Knob("bladed_disk.radial_coupling"),
    ),
    term(
        "μ",
        "mu",
        "Coulomb friction of the blades, which always slide forward over the casing",
        "",
        Knob("contact.friction"),
    ),
    term(
        "τ",
        "tau",
        "tangential over radial motion of the casing mode: 0 in the paper, 1/n_d for a ring that does not stretch (r on its bar)",
        "the casing feels the friction μ_c = μ τ",
        Knob("casing.tangential_ratio"),
    ),
    term(
        "k_p",
        "k_p",
        "stiffness of a lining under one blade, for the smooth law",
        "P = k_p (-g - eps/2) below -eps",
        Knob("contact.stiffness_n_per_m"),
    ),
    term(
        "eps",
        "eps",
        "depth over which that stiffness sets in",
        "P = k_p g²/(2 eps) above -eps",
        Knob("contact.smoothing_m"),
    ),
    term(
        "e",
        "e",
        "coefficient of restitution: part of the speed that an impact gives back",
        "g' after = -e g' before",
        Knob("contact.restitution"),
    ),
    term(
        "n_b",
        "n_b",
        "nodal diameters of the disk, where they are not those of the casing; 0 for the same",
        "",
        Knob("bladed_disk.nodal_diameters"),
    ),
    term(
        "w",
        "w",
        "the casing as the tips of the blades see it, in their frame: the point in the polygon of view 4",
        "w = z - κ l_b a, a = α_c + i α_s",
        Nothing,
    ),
    term(
        "c2",
        "c2",
        "product by which blades and casing are coupled while they touch; its sign decides which coincidence is dangerous",
        "c2 = κ (κ + μ) l_b²",
        Of(|app| Some(app.machine.coupling_product_at(app.speed())), "m²"),
    ),
    term(
        "B(ω)",
        "B(omega)",
        "joint compliance of blades and casing; a wave of pushes lasts where it is real and below zero (view 9)",
        "B = (1 + i μ_c)/(k_c - ω² m_c + i ω d_c) + c2/(k_a - s² m_a + i s d_a), s = ω - n_d Ω",
        Of(|app| Some(Joint::at(&app.machine, app.speed()).compliance(0.0).re), "m/N at ω = 0"),
    ),
    term(
        "S",
        "S",
        "push over amplitude of such a wave, in whole: all blades on a lining have S0 = N k_p/2",
        "S = -1/Re B(ω)",
        Nothing,
    ),
];
