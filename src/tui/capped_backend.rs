//! A backend that limits the reported terminal size to [`LARGEST`], and further if memory is short.
//! Frames stay small on any terminal, and cells outside stay blank.

use std::cell::Cell;
use std::io;

use ratatui::backend::{Backend, ClearType, WindowSize};
use ratatui::buffer;
use ratatui::layout::{Position, Size};

/// The largest drawn area.
pub(super) const LARGEST: Size = Size { width: 1000, height: 500 };
/// The smallest drawn area if memory is short.
const SMALLEST: Size = Size { width: 80, height: 24 };
/// Memory that must be free for a frame, in buffers of all its cells: two buffers, twice while they
/// grow, and a reserve for the threads that start later.
const BUFFERS: usize = 12;

/// A backend with the last size of its terminal and the drawn part.
pub(super) struct CappedBackend<B> {
    pub(super) backend: B,
    last: Cell<Option<(Size, Size)>>,
}

impl<B> CappedBackend<B> {
    pub(super) fn new(backend: B) -> CappedBackend<B> {
        CappedBackend { backend, last: Cell::new(None) }
    }
}

/// The drawn part of a terminal of a size: a failed allocation of its cells would end the process.
fn capped(size: Size, has_room: impl Fn(Size) -> bool) -> Size {
    let mut drawn =
        Size { width: size.width.min(LARGEST.width), height: size.height.min(LARGEST.height) };
    while !has_room(drawn) && (drawn.width > SMALLEST.width || drawn.height > SMALLEST.height) {
        drawn = Size {
            width: (drawn.width / 2).max(SMALLEST.width.min(drawn.width)),
            height: (drawn.height / 2).max(SMALLEST.height.min(drawn.height)),
        };
    }
    drawn
}

fn has_memory(size: Size) -> bool {
    let cells = usize::from(size.width) * usize::from(size.height);
    Vec::<buffer::Cell>::new().try_reserve_exact(cells * BUFFERS).is_ok()
}

impl<B: Backend<Error = io::Error>> Backend for CappedBackend<B> {
    type Error = io::Error;

    fn size(&self) -> io::Result<Size> {
        let size = self.backend.size()?;
        let drawn = match self.last.get() {
            Some((last, drawn)) if last == size => drawn,
            _ => capped(size, has_memory),
        };
        self.last.set(Some((size, drawn)));
        Ok(drawn)
    }

    fn draw<'a, I>(&mut self, content: I) -> io::Result<()>
    where
        I: Iterator<Item = (u16, u16, &'a buffer::Cell)>,
    {
        self.backend.draw(content)
    }

    fn append_lines(&mut self, count: u16) -> io::Result<()> {
        self.backend.append_lines(count)
    }

    fn hide_cursor(&mut self) -> io::Result<()> {
        self.backend.hide_cursor()
    }

    fn show_cursor(&mut self) -> io::Result<()> {
        self.backend.show_cursor()
    }

    fn get_cursor_position(&mut self) -> io::Result<Position> {
        self.backend.get_cursor_position()
    }

    fn set_cursor_position<P: Into<Position>>(&mut self, position: P) -> io::Result<()> {
        self.backend.set_cursor_position(position)
    }

    fn clear(&mut self) -> io::Result<()> {
        self.backend.clear()
    }

    fn clear_region(&mut self, region: ClearType) -> io::Result<()> {
        self.backend.clear_region(region)
    }

    fn window_size(&mut self) -> io::Result<WindowSize> {
        self.backend.window_size()
    }

    fn flush(&mut self) -> io::Result<()> {
        self.backend.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_drawn_area_fits_the_terminal_its_cap_and_the_memory() {
        let drawn = |width, height, most: u32| {
            let has_room = |size: Size| u32::from(size.width) * u32::from(size.height) <= most;
            let size = capped(Size { width, height }, has_room);
            (size.width, size.height)
        };
        assert_eq!(drawn(140, 45, u32::MAX), (140, 45));
        assert_eq!(drawn(u16::MAX, u16::MAX, u32::MAX), (1000, 500));
        assert_eq!(drawn(1500, 1500, 200_000), (500, 250));
        assert_eq!(drawn(1500, 10, 1000), (80, 10));
        assert_eq!(drawn(300, 300, 0), (80, 24));
        assert_eq!(drawn(0, 0, 0), (0, 0));
        assert!(has_memory(LARGEST));
    }
}
