//! The groups of actions, under whose headings the help lists their keys.

use strum::{EnumIter, IntoStaticStr};

use super::Action;

/// What an action is about, in the order of the help.
#[derive(Clone, Copy, Debug, PartialEq, Eq, EnumIter, IntoStaticStr)]
pub enum Group {
    /// Selecting and turning knobs.
    Knobs,
    /// How the motion is played, and which part of it is shown.
    Time,
    /// Which charts there are, and reading them.
    #[strum(serialize = "Views and charts")]
    Views,
    /// What to open and to learn.
    #[strum(serialize = "Scenes and lessons")]
    Scenes,
    /// What leaves the program.
    Files,
    /// How it looks.
    Look,
    /// The program itself.
    Program,
}

impl Action {
    /// The group of an action.
    pub fn group(self) -> Group {
        match self {
            Self::KnobAbove
            | Self::KnobBelow
            | Self::Turn { .. }
            | Self::Type
            | Self::Reset
            | Self::Undo
            | Self::Redo
            | Self::Sweep
            | Self::Live
            | Self::Accept
            | Self::DeleteLast => Group::Knobs,
            Self::Pause
            | Self::Step
            | Self::Restart
            | Self::Fire
            | Self::SlowAtEvents
            | Self::Slower
            | Self::Faster
            | Self::Jump
            | Self::GoToEnd
            | Self::PageBack
            | Self::PageForward
            | Self::ZoomIn
            | Self::ZoomOut
            | Self::ZoomReset => Group::Time,
            Self::NextView
            | Self::PreviousView
            | Self::View(_)
            | Self::Heat
            | Self::Charts
            | Self::FullScreen
            | Self::Present
            | Self::Autoscale
            | Self::Pin
            | Self::OtherLaw
            | Self::MapAxis { .. }
            | Self::Read
            | Self::Cursor { .. }
            | Self::OpenPlace => Group::Views,
            Self::Lesson
            | Self::LeaveLesson
            | Self::LessonBack
            | Self::Answer(_)
            | Self::Scenes => Group::Scenes,
            Self::Save | Self::Export | Self::Copy | Self::Yes => Group::Files,
            Self::Marker | Self::Theme | Self::Mouse | Self::Redraw => Group::Look,
            Self::Help | Self::Palette | Self::Quit | Self::Suspend | Self::Close => Group::Program,
        }
    }
}
