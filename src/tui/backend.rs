//! The backend of the screen: crossterm's, but with frames that can be given up
//! and a size within bounds.

use std::io::Error;

use ratatui::backend::{Backend, ClearType, CrosstermBackend, WindowSize};
use ratatui::buffer::Cell;
use ratatui::layout::{Position, Size};

use super::terminal::{self, Frames};

/// Draws on the terminal of the explorer.
#[derive(Debug)]
pub struct ScreenBackend {
    inner: CrosstermBackend<Frames>,
    hidden: bool,
}

impl Default for ScreenBackend {
    fn default() -> Self {
        Self { inner: CrosstermBackend::new(Frames::default()), hidden: false }
    }
}

impl Backend for ScreenBackend {
    type Error = Error;

    fn draw<'a, I>(&mut self, content: I) -> Result<(), Error>
    where
        I: Iterator<Item = (u16, u16, &'a Cell)>,
    {
        // Without a change nothing is sent, not even the usual reset of colours.
        let mut content = content.peekable();
        if content.peek().is_none() { Ok(()) } else { self.inner.draw(content) }
    }

    fn hide_cursor(&mut self) -> Result<(), Error> {
        // It was hidden when the screen was opened, and nothing shows it.
        if std::mem::replace(&mut self.hidden, true) { Ok(()) } else { self.inner.hide_cursor() }
    }

    fn show_cursor(&mut self) -> Result<(), Error> {
        self.hidden = false;
        self.inner.show_cursor()
    }

    fn get_cursor_position(&mut self) -> Result<Position, Error> {
        self.inner.get_cursor_position()
    }

    fn set_cursor_position<P: Into<Position>>(&mut self, position: P) -> Result<(), Error> {
        self.inner.set_cursor_position(position)
    }

    fn clear(&mut self) -> Result<(), Error> {
        self.inner.clear()
    }

    fn clear_region(&mut self, region: ClearType) -> Result<(), Error> {
        self.inner.clear_region(region)
    }

    fn size(&self) -> Result<Size, Error> {
        terminal::size()
    }

    fn window_size(&mut self) -> Result<WindowSize, Error> {
        Ok(WindowSize { columns_rows: self.size()?, pixels: Size::ZERO })
    }

    fn flush(&mut self) -> Result<(), Error> {
        std::io::Write::flush(&mut self.inner)
    }
}
