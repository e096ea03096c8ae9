//! Which figure: one of the paper by its number, or one that the paper only promises.

use std::fmt::{Display, Formatter};
use std::str::FromStr;

use super::{Figure, NUMBERS, coincidence, figure, name_of};
use crate::harmonic::HarmonicError;
use crate::scene::{CheckedScene, Scene, SceneError};

/// A figure that can be drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which {
    /// Of the paper, by its number.
    Paper(u32),
    /// Blade amplitude against speed about the dangerous coincidence: not of the paper.
    Coincidence,
}

impl Which {
    /// The figures of the paper.
    #[must_use]
    pub fn of_paper() -> Vec<Self> {
        NUMBERS.into_iter().map(Self::Paper).collect()
    }

    /// Whether it costs next to nothing and can be refused.
    #[must_use]
    pub fn is_quick(self) -> bool {
        matches!(self, Self::Paper(9 | 10))
    }

    /// The name of its files, without their ending.
    #[must_use]
    pub fn stem(self) -> String {
        match self {
            Self::Paper(number) => format!("fig{number:02}"),
            Self::Coincidence => self.to_string(),
        }
    }

    /// Its own scene, not yet checked.
    ///
    /// # Errors
    /// None, as these scenes exist.
    pub fn scene(self) -> Result<Scene, SceneError> {
        match self {
            Self::Paper(number) => Scene::builtin(name_of(number)),
            Self::Coincidence => coincidence::own_scene(),
        }
    }

    /// The figure of a scene; none for a number that the paper has not.
    ///
    /// # Errors
    /// A machine without what it shows.
    pub fn of(self, scene: &CheckedScene) -> Result<Option<Figure>, HarmonicError> {
        match self {
            Self::Paper(number) => figure(number, scene),
            Self::Coincidence => coincidence::peaks(scene).map(Some),
        }
    }
}

impl Display for Which {
    fn fmt(&self, out: &mut Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Paper(number) => write!(out, "{number}"),
            Self::Coincidence => out.write_str("coincidence"),
        }
    }
}

impl FromStr for Which {
    type Err = ();

    fn from_str(text: &str) -> Result<Self, ()> {
        if text == Self::Coincidence.to_string() {
            return Ok(Self::Coincidence);
        }
        let number = text.parse().map_err(|_| ())?;
        NUMBERS.contains(&number).then_some(Self::Paper(number)).ok_or(())
    }
}
