//! Selects a figure of the paper by its number.

use std::fmt::{Display, Formatter};
use std::str::FromStr;

use super::{Figure, harmonic, time, zone};
use crate::scene::{CheckedScene, Scene, SceneError};

/// Numbers of the figures.
const NUMBERS: [u32; 7] = [4, 5, 6, 7, 8, 9, 10];

/// A figure of the paper, given by its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Which(u32);

impl Which {
    /// Returns all figures of the paper.
    #[must_use]
    pub fn of_paper() -> Vec<Self> {
        NUMBERS.into_iter().map(Self).collect()
    }

    /// Returns the name of its files, without extension.
    #[must_use]
    pub fn stem(self) -> String {
        format!("fig{:02}", self.0)
    }

    /// Returns the scene of the figure.
    ///
    /// # Errors
    /// None, because these scenes are built in.
    pub fn scene(self) -> Result<CheckedScene, SceneError> {
        let name = match self.0 {
            4..=6 => "paper-figs-4-6",
            7 => "paper-fig-7",
            8 => "paper-fig-8",
            _ => "paper-nd3",
        };
        Scene::builtin(name)?.checked()
    }

    /// Draws the figure for a scene.
    ///
    /// # Errors
    /// None for the figure's own scene.
    pub fn draw(self, scene: &CheckedScene) -> Result<Figure, SceneError> {
        let mut figure = match self.0 {
            4 => time::steps(scene),
            5 => time::gaps(scene),
            6 => time::response(scene),
            7 => time::four_diameters(scene),
            8 => zone::zone(scene)?,
            9 => harmonic::multipliers(scene)?,
            _ => harmonic::amplitudes(scene)?,
        };
        figure.title = format!("Figure {self}. {}", figure.title);
        Ok(figure)
    }
}

impl Display for Which {
    fn fmt(&self, out: &mut Formatter<'_>) -> std::fmt::Result {
        write!(out, "{}", self.0)
    }
}

impl FromStr for Which {
    type Err = ();

    fn from_str(text: &str) -> Result<Self, ()> {
        let number = text.parse().map_err(|_| ())?;
        NUMBERS.contains(&number).then_some(Self(number)).ok_or(())
    }
}
