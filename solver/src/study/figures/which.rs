//! Names a figure: one of the paper by its number, or one that the paper only promises.

use std::fmt::{Display, Formatter};
use std::str::FromStr;

use super::{Figure, coincidence, harmonic, time, zone};
use crate::harmonic::HarmonicError;
use crate::scene::{CheckedScene, Scene, SceneError};

/// The numbers of the figures of the paper.
const NUMBERS: [u32; 7] = [4, 5, 6, 7, 8, 9, 10];

/// A figure that can be drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which {
    /// A figure of the paper, by its number.
    Paper(u32),
    /// Blade amplitude against speed about the dangerous coincidence: not of the paper.
    Coincidence,
}

impl Which {
    /// Returns the figures of the paper.
    #[must_use]
    pub fn of_paper() -> Vec<Self> {
        NUMBERS.into_iter().map(Self::Paper).collect()
    }

    /// Returns the name of its files, without their ending.
    #[must_use]
    pub fn stem(self) -> String {
        match self {
            Self::Paper(number) => format!("fig{number:02}"),
            Self::Coincidence => self.to_string(),
        }
    }

    /// Returns its scene.
    ///
    /// # Errors
    /// None, as these scenes exist.
    pub fn scene(self) -> Result<CheckedScene, SceneError> {
        let name = match self {
            Self::Paper(4..=6) => "paper-figs-4-6",
            Self::Paper(7) => "paper-fig-7",
            Self::Paper(8) => "paper-fig-8",
            Self::Paper(_) => "paper-nd3",
            Self::Coincidence => return coincidence::own_scene()?.checked(),
        };
        Scene::builtin(name)?.checked()
    }

    /// Draws the figure of its scene.
    ///
    /// # Errors
    /// None, as these scenes have what their figures show.
    pub fn draw(self, scene: &CheckedScene) -> Result<Figure, HarmonicError> {
        let mut figure = match self {
            Self::Paper(4) => time::steps(scene),
            Self::Paper(5) => time::gaps(scene),
            Self::Paper(6) => time::response(scene),
            Self::Paper(7) => time::four_diameters(scene),
            Self::Paper(8) => zone::zone(scene),
            Self::Paper(9) => harmonic::multipliers(scene)?,
            Self::Paper(_) => harmonic::amplitudes(scene)?,
            Self::Coincidence => coincidence::peaks(scene)?,
        };
        if let Self::Paper(number) = self {
            figure.title = format!("Figure {number}. {}", figure.title);
        }
        Ok(figure)
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
