//! The backend of the screen: crossterm's, but with frames that can be given up
//! and a size within bounds.

use std::io::Error;

use ratatui::backend::{Backend, ClearType, CrosstermBackend, WindowSize};
use ratatui::buffer::Cell;
use ratatui::layout::{Position, Size};

use super::terminal::{self, Frames};

/// Draws on the terminal of the explorer.
#[derive(Debug)]
pub struct ScreenBackend(CrosstermBackend<Frames>);

impl Default for ScreenBackend {
    fn default() -> Self {
        Self(CrosstermBackend::new(Frames::default()))
    }
}

impl Backend for ScreenBackend {
    type Error = Error;

    fn draw<'a, I>(&mut self, content: I) -> Result<(), Error>
    where
        I: Iterator<Item = (u16, u16, &'a Cell)>,
    {
        self.0.draw(content)
    }

    fn hide_cursor(&mut self) -> Result<(), Error> {
        self.0.hide_cursor()
    }

    fn show_cursor(&mut self) -> Result<(), Error> {
        self.0.show_cursor()
    }

    fn get_cursor_position(&mut self) -> Result<Position, Error> {
        self.0.get_cursor_position()
    }

    fn set_cursor_position<P: Into<Position>>(&mut self, position: P) -> Result<(), Error> {
        self.0.set_cursor_position(position)
    }

    fn clear(&mut self) -> Result<(), Error> {
        self.0.clear()
    }

    fn clear_region(&mut self, region: ClearType) -> Result<(), Error> {
        self.0.clear_region(region)
    }

    fn size(&self) -> Result<Size, Error> {
        terminal::size()
    }

    fn window_size(&mut self) -> Result<WindowSize, Error> {
        Ok(WindowSize { columns_rows: self.size()?, pixels: Size::ZERO })
    }

    fn flush(&mut self) -> Result<(), Error> {
        std::io::Write::flush(&mut self.0)
    }
}
