//! How the explorer turns a key: the label and the steps of its knob, and one sentence on its effect.

/// How a knob steps through its values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Turn {
    /// Equal steps of a real number, fine and coarse, in the unit of the key; steps in rpm are ten
    /// times as many rpm.
    Linear(f64, f64),
    /// Round mantissas in each decade. A step below this magnitude, in the unit of the key, leads
    /// to zero.
    Decades(f64),
    /// Equal steps of a whole number, fine and coarse.
    Whole(u64, u64),
    /// Steps through a list of words, and from its end to its start.
    Words,
}

/// How the explorer turns a key.
#[derive(Clone, Copy, Debug)]
pub struct Handle {
    /// Short name, which usually ends in the symbol.
    pub label: &'static str,
    /// How it steps through its values.
    pub turn: Turn,
    /// Effect of the key, in one sentence.
    pub does: &'static str,
}
