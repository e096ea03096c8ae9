//! Symbols of parameters as the paper and the documents write them, taken from the descriptions in
//! the key table.

use rubscope_solver::scene::keys;

/// Ending of the description of a key that is an initial value, such as `u_c at t = 0`.
const AT_START: &str = " at t = 0";

/// Returns the symbol of a parameter in ASCII: `zeta_c`, `Omega`, `u_c(0)`. A path that is no key
/// is returned unchanged.
pub fn symbol(path: &str) -> String {
    match path {
        "casing.frequency_hz" => return "f_c".to_string(),
        "bladed_disk.frequency_hz" => return "f_bd".to_string(),
        // The descriptions of these keys contain no symbol.
        keys::PULSE => return "F".to_string(),
        keys::SPEED_RAMP => return "ramp".to_string(),
        keys::STEP => return "h".to_string(),
        _ => {}
    }
    let Ok(key) = keys::find_varied(path) else { return path.to_string() };
    if let Some(start) = key.what.strip_suffix(AT_START) {
        return match start.strip_prefix("rate of ") {
            Some(moving) => format!("{moving}'(0)"),
            None => format!("{start}(0)"),
        };
    }
    key.what.rsplit(' ').next().unwrap_or(path).to_string()
}

/// Replaces the ASCII names of Greek letters in a text by the letters, and `g0` by `g_0`, which
/// pictures show with a subscript.
pub fn greek(text: &str) -> String {
    let letter = |word: &str| {
        match word {
            "Omega" => "Ω",
            "zeta" => "ζ",
            "kappa" => "κ",
            "mu" => "μ",
            "tau" => "τ",
            "eps" => "ε",
            "g0" => "g_0",
            _ => return word.to_string(),
        }
        .to_string()
    };
    let words = text.split_inclusive(|c: char| !c.is_ascii_alphanumeric());
    let parts = words.map(|part| {
        let end = part.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(part.len());
        let (word, rest) = part.split_at(end);
        letter(word) + rest
    });
    parts.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rubscope_solver::study::margins::PARAMETERS;

    #[test]
    fn every_parameter_has_its_own_symbol() {
        let numbers = keys::KEYS.iter().filter(|key| {
            matches!(key.allowed, keys::Allowed::Real { .. } | keys::Allowed::Whole { .. })
        });
        let mut all: Vec<String> = numbers.map(|key| symbol(key.path)).collect();
        let count = all.len();
        all.sort();
        all.dedup();
        assert_eq!(all.len(), count, "{all:?}");
        let parameters = PARAMETERS.iter().filter(|one| !one.path.starts_with("initial."));
        let found: Vec<String> = parameters.map(|one| symbol(one.path)).collect();
        assert!(found.iter().all(|symbol| symbol.len() <= "zeta_bd".len()), "{found:?}");
        assert_eq!(symbol("initial.u_c_m"), "u_c(0)");
        assert_eq!(symbol("initial.v_s_m_s"), "u_s'(0)");
        assert_eq!(symbol("bladed_disk.blades"), "N");
        assert_eq!(symbol("operation.nodal_diameters"), "n_d");
        assert_eq!(greek("speed Omega, mu kappa(tau) eps much"), "speed Ω, μ κ(τ) ε much");
    }
}
